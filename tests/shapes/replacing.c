/* SPDX-License-Identifier: MIT
 *
 * replacing.c - shapes that come and go: the store holds what was put there last, indices are used again, memory does
 * not grow, and a body without a shape has no answer.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "families.h"
#include "ledger.h"
#include "narc.h"
#include "store.h"
#include "support.h"
#include "tests.h"

/* A shape that was added to a store of its own has the same bits wherever it is. */
static void expect_same_shape(const narc_shapes *shapes, uint32_t index, const struct shape *shape) {
    AUTO(narc_destroy_shapes_at) narc_shapes *fresh = empty_store();
    store_shape(fresh, *shape);
    narc_shape_header header = shapes->headers[index];
    assert_true(header.first_record + narc_count_records(&header) <= shapes->record_count);
    assert_memory_equal(&shapes->records[header.first_record], &fresh->records[fresh->headers[0].first_record],
                        narc_count_records(&header) * sizeof(narc_record));
    header.first_record = fresh->headers[0].first_record;
    assert_memory_equal(&header, fresh->headers, sizeof header);
    assert_memory_equal(&shapes->boxes[index], fresh->boxes, sizeof *fresh->boxes);
}

enum { MODEL_SHAPES = 40 };

/* What the store should hold. */
struct model {
    struct shape shape[MODEL_SHAPES];
    bool exists[MODEL_SHAPES];
    uint32_t uses[MODEL_SHAPES];
    size_t count; /* indices given out */
    uint32_t removed[MODEL_SHAPES];
    size_t removed_count;
};

static void expect_model(const narc_shapes *shapes, const struct model *model) {
    size_t used = narc_count_records(&(narc_shape_header){.count = 2}); /* the circle that removed shapes have */
    size_t boxes = 0;
    assert_int_equal(narc_count_shapes(shapes), model->count);
    for (uint32_t k = 0; k < model->count; k++) {
        assert_int_equal(narc_count_uses(shapes, k), model->uses[k]);
        if (model->exists[k]) {
            used += narc_count_records(&shapes->headers[k]);
            assert_int_equal(narc_get_arcs(shapes, k, NULL), model->shape[k].count);
            expect_same_shape(shapes, k, &model->shape[k]);
            boxes += narc_has_form(&shapes->boxes[k]);
        } else {
            assert_int_equal(shapes->boxes[k].info, 0);
            narc_aabb box;
            assert_int_equal(narc_get_arcs(shapes, k, NULL), 0);
            assert_int_equal(narc_shape_flags(shapes, k), 0);
            assert_false(narc_get_aabb(shapes, k, 1, 0, 1, &box));
        }
    }
    assert_int_equal(shapes->used_records, used);
    assert_int_equal(shapes->box_count, boxes);
}

TEST(holds_what_was_put_last) {
    struct test_random random = test_random_named("replacing");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ledger ledger = {0};
        AUTO(free_at) struct model *model = calloc(1, sizeof *model);
        narc_shapes *shapes = ledger_store(&ledger);
        assert_non_null(model);
        for (int step = 0; step < 300; step++) {
            const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
            const uint32_t index = (uint32_t)random_below(&random, MODEL_SHAPES);
            const bool exists = index < model->count && model->exists[index];
            uint32_t added = UINT32_MAX;
            narc_error error;
            uint32_t equal = MODEL_SHAPES;
            for (uint32_t k = 0; k < model->count; k++)
                if (model->exists[k] && model->shape[k].count == shape.count &&
                    memcmp(model->shape[k].arcs, shape.arcs, shape.count * sizeof *shape.arcs) == 0)
                    equal = k;
            if (!exists && equal < MODEL_SHAPES) { /* one more use */
                added = store_shape(shapes, shape);
                assert_true(model->exists[added]);
                expect_same_shape(shapes, added, &shape);
                model->uses[added]++;
            } else if (!exists) { /* add */
                if (model->removed_count == 0 && model->count == MODEL_SHAPES)
                    continue;
                added = store_shape(shapes, shape);
                if (model->removed_count > 0)
                    assert_int_equal(added, model->removed[--model->removed_count]);
                else
                    assert_int_equal(added, model->count++);
                model->shape[added] = shape;
                model->exists[added] = true;
                model->uses[added] = 1;
            } else if (model->uses[index] > 1) {
                expect_error(narc_replace_shape(shapes, index, shape.arcs, shape.count, &error), NARC_ERROR_IN_USE,
                             &error, "is used");
                expect_ok(narc_remove_shape(shapes, index, &error), &error);
                model->uses[index]--;
            } else if (random_below(&random, 3) == 0) {
                expect_ok(narc_remove_shape(shapes, index, &error), &error);
                model->uses[index] = 0;
                model->exists[index] = false;
                model->removed[model->removed_count++] = index;
                expect_error(narc_remove_shape(shapes, index, &error), NARC_ERROR_INDEX, &error, "was removed");
                expect_error(narc_replace_shape(shapes, index, shape.arcs, shape.count, &error), NARC_ERROR_INDEX,
                             &error, "was removed");
            } else {
                expect_ok(narc_replace_shape(shapes, index, shape.arcs, shape.count, &error), &error);
                model->shape[index] = shape;
            }
            if (step % 10 == 0)
                expect_model(shapes, model);
        }
        expect_model(shapes, model);
        narc_destroy_shapes(shapes);
        assert_int_equal(ledger.live, 0);
    }
}

/* A regular polygon with so many corners. */
static struct shape make_polygon(size_t corners) {
    struct shape shape = {.count = 0};
    narc_point points[NARC_MAX_ARCS];
    for (size_t i = 0; i < corners; i++) {
        const double angle = 2 * PI * (double)i / (double)corners;
        points[i] = (narc_point){cos(angle), sin(angle)};
    }
    assert_int_equal(narc_build_polygon(points, corners, 0, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* What a polygon with so many corners needs. */
static size_t need_of(size_t corners) {
    return narc_count_records(&(narc_shape_header){.count = (uint8_t)corners}) * sizeof(narc_record) +
           sizeof(narc_shape_header);
}

/* A store never has more memory than four times what its shapes needed when they needed most, not even while it moves
 * them; besides the least that a store has. */
static void expect_little_memory(const struct ledger *ledger, size_t most_needed) {
    assert_in_range(ledger->most, 1, 4 * most_needed + 8192);
}

/* Replacing for ever, with any number of arcs, takes no more memory than is promised. */
TEST(memory_does_not_grow) {
    enum { SHAPES = 50, STEPS = 8000 };
    struct test_random random = test_random_named("no growth");
    for (int way = 0; way < 2; way++) { /* replace; remove and add */
        struct ledger ledger = {0};
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
        struct shape polygons[NARC_MAX_ARCS + 1];
        size_t corners[SHAPES], need = SHAPES * need_of(3), most_needed = need;
        for (size_t n = 3; n <= NARC_MAX_ARCS; n++)
            polygons[n] = make_polygon(n);
        for (uint32_t k = 0; k < SHAPES; k++) {
            assert_int_equal(narc_add_shape_at(shapes, k, polygons[3].arcs, 3, NULL), NARC_OK);
            corners[k] = 3;
        }
        for (int step = 0; step < STEPS; step++) {
            const size_t n = 3 + random_below(&random, NARC_MAX_ARCS - 2);
            const uint32_t index = (uint32_t)random_below(&random, SHAPES);
            if (way == 0) {
                assert_int_equal(narc_replace_shape(shapes, index, polygons[n].arcs, n, NULL), NARC_OK);
            } else {
                assert_int_equal(narc_remove_shape(shapes, index, NULL), NARC_OK);
                assert_int_equal(narc_add_shape_at(shapes, index, polygons[n].arcs, n, NULL), NARC_OK);
            }
            assert_int_equal(narc_get_arcs(shapes, index, NULL), n);
            need += need_of(n) - need_of(corners[index]);
            most_needed = need > most_needed ? need : most_needed;
            corners[index] = n;
        }
        assert_int_equal(narc_count_shapes(shapes), SHAPES);
        expect_little_memory(&ledger, most_needed);
    }
}

/* A triangle after the other becomes a polygon of 64 corners, which is removed. Then triangles come back, in their
 * places. */
TEST(removed_shapes_need_no_memory) {
    enum { SHAPES = 3000 };
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape small = make_polygon(3), large = make_polygon(64);
    const size_t most_needed = (SHAPES - 1) * need_of(3) + need_of(64);
    for (uint32_t k = 0; k < SHAPES; k++)
        assert_int_equal(narc_add_shape_at(shapes, k, small.arcs, 3, NULL), NARC_OK);
    for (uint32_t k = 0; k < SHAPES; k++) {
        assert_int_equal(narc_replace_shape(shapes, k, large.arcs, 64, NULL), NARC_OK);
        expect_same_shape(shapes, k, &large);
        assert_int_equal(narc_remove_shape(shapes, k, NULL), NARC_OK);
    }
    expect_little_memory(&ledger, most_needed);
    for (uint32_t k = SHAPES; k-- > 0;) {
        struct shape own = small; /* all different: each a shape of its own, at the index that was freed last */
        uint32_t added;
        own.arcs[0].radius = own.arcs[1].radius = own.arcs[2].radius = 0.5 + k;
        assert_int_equal(narc_add_shape(shapes, own.arcs, 3, &added, NULL), NARC_OK);
        assert_int_equal(added, k);
        if (k % 97 == 0)
            expect_same_shape(shapes, k, &own);
    }
    expect_little_memory(&ledger, most_needed);
}

/* A shape that changes and keeps its number of arcs, or has fewer, allocates nothing. */
TEST(same_size_allocates_nothing) {
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape eight = make_polygon(8), five = make_polygon(5);
    assert_int_equal(narc_add_shape(shapes, eight.arcs, 8, NULL, NULL), NARC_OK);
    const size_t before = ledger.allocations;
    for (int k = 0; k < 1000; k++)
        assert_int_equal(narc_replace_shape(shapes, 0, eight.arcs, 8, NULL), NARC_OK);
    assert_int_equal(narc_replace_shape(shapes, 0, five.arcs, 5, NULL), NARC_OK);
    assert_int_equal(ledger.allocations, before);
    expect_same_shape(shapes, 0, &five);
}

/* Whatever is wrong, the store stays as it was. */
TEST(refused_replacement_changes_nothing) {
    struct ledger ledger = {0};
    AUTO(free_at) struct model *model = calloc(1, sizeof *model);
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape small = make_polygon(3), large = make_polygon(64);
    narc_arc broken = {0, 0, -1, -PI, PI};
    narc_error error;
    assert_non_null(model);
    for (uint32_t k = 0; k < 20; k++) {
        assert_int_equal(narc_add_shape_at(shapes, k, small.arcs, 3, NULL), NARC_OK);
        model->uses[k] = 1;
        model->shape[k] = small;
        model->exists[k] = true;
    }
    model->count = 20;
    ledger.limited = true;
    expect_error(narc_replace_shape(NULL, 0, small.arcs, 3, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_remove_shape(NULL, 0, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_replace_shape(shapes, 20, small.arcs, 3, &error), NARC_ERROR_INDEX, &error,
                 "shape is 20, but there are 20 shapes");
    expect_error(narc_remove_shape(shapes, UINT32_MAX, &error), NARC_ERROR_INDEX, &error, "there are 20 shapes");
    expect_error(narc_replace_shape(shapes, 7, NULL, 1, &error), NARC_ERROR_ARGUMENT, &error, "arcs is NULL");
    expect_error(narc_replace_shape(shapes, 7, &broken, 1, &error), NARC_ERROR_RADIUS, &error, "arc 0: radius is -1");
    expect_error(narc_replace_shape(shapes, 7, large.arcs, 64, &error), NARC_ERROR_MEMORY, &error, "no memory");
    expect_model(shapes, model);
    ledger.limited = false;
    expect_ok(narc_replace_shape(shapes, 7, large.arcs, 64, &error), &error);
    model->shape[7] = large;
    expect_model(shapes, model);
}
