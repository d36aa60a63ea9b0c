/* SPDX-License-Identifier: MIT
 *
 * sharing.c - equal shapes are stored once, their uses are counted, and callers may choose indices.
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

TEST(equal_shapes_are_stored_once) {
    struct test_random random = test_random_named("sharing");
    struct ledger ledger = {0};
    narc_shapes *shapes = ledger_store(&ledger);
    for (size_t k = 0; k < 20 * FAMILY_COUNT; k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        const uint32_t index = store_shape(shapes, shape), uses = narc_count_uses(shapes, index);
        const size_t count = narc_count_shapes(shapes), records = shapes->record_count,
                     allocations = ledger.allocations;
        for (uint32_t again = 1; again <= 3; again++) {
            assert_int_equal(store_shape(shapes, shape), index);
            assert_int_equal(narc_count_uses(shapes, index), uses + again);
        }
        assert_int_equal(narc_count_shapes(shapes), count);
        assert_int_equal(shapes->record_count, records);
        assert_int_equal(ledger.allocations, allocations);
    }
    assert_int_equal(narc_count_uses(shapes, (uint32_t)narc_count_shapes(shapes)), 0);
    assert_int_equal(narc_count_uses(NULL, 0), 0);
    narc_destroy_shapes(shapes);
    assert_int_equal(ledger.live, 0);
}

/* What answers tell apart is another shape: the place, the numbers of arcs, one bit of one number. */
TEST(other_bits_are_another_shape) {
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape box = box_of(2, 1, 0);
    struct shape other = box;
    assert_int_equal(store_shape(shapes, box), 0);
    for (size_t i = 0; i < 4; i++)
        other.arcs[i] = box.arcs[(i + 1) % 4];
    assert_int_equal(store_shape(shapes, other), 1);
    narc_arc arcs[NARC_MAX_ARCS];
    assert_int_equal(narc_get_arcs(shapes, 1, arcs), 4);
    for (size_t i = 0; i < 4; i++)
        assert_true(arcs[i].center_x == other.arcs[i].center_x && arcs[i].center_y == other.arcs[i].center_y);
    other = box;
    for (size_t i = 0; i < 4; i++)
        other.arcs[i].center_x += 0.5;
    assert_int_equal(store_shape(shapes, other), 2);
    other = box;
    other.arcs[0].center_x = other.arcs[3].center_x = (double)nextafterf(1, 2);
    assert_int_equal(store_shape(shapes, other), 3);
    for (uint32_t k = 0; k < 2; k++) {
        const struct shape circle = {{{k, 0, 1, -PI, PI}}, 1};
        assert_int_equal(store_shape(shapes, circle), 4 + k);
    }
}

TEST(shared_shapes_are_not_replaced) {
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape box = box_of(2, 1, 0), other = box_of(3, 1, 0);
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    for (int k = 0; k < 3; k++)
        assert_int_equal(store_shape(shapes, box), 0);
    expect_error(narc_replace_shape(shapes, 0, other.arcs, 4, &error), NARC_ERROR_IN_USE, &error,
                 "shape 0 is used 3 times");
    assert_true(error.value == 3 && error.index == 0);
    assert_int_equal(narc_get_arcs(shapes, 0, arcs), 4);
    assert_true(arcs[0].center_x == 1);
    assert_int_equal(narc_remove_shape(shapes, 0, NULL), NARC_OK);
    assert_int_equal(narc_remove_shape(shapes, 0, NULL), NARC_OK);
    expect_ok(narc_replace_shape(shapes, 0, other.arcs, 4, &error), &error);
    assert_int_equal(store_shape(shapes, other), 0); /* what came in its place is found, */
    assert_int_equal(store_shape(shapes, box), 1);   /* what was there is not */
    /* A third one that becomes equal keeps its index; and one of the two is found. */
    expect_ok(narc_replace_shape(shapes, 1, other.arcs, 4, &error), &error);
    assert_in_range(store_shape(shapes, other), 0, 1);
    assert_int_equal(narc_count_uses(shapes, 0) + narc_count_uses(shapes, 1), 4);
}

/* How many shapes a search looks at, on average of all shapes, and at most. Shapes like those of a level: boxes with
 * sides in steps. */
TEST(searches_are_short) {
    enum { STEPS = 150 };
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    for (int w = 1; w <= STEPS; w++)
        for (int h = 1; h <= STEPS; h++)
            assert_int_equal(store_shape(shapes, box_of(0.125 * w, 0.125 * h, 0)), (w - 1) * STEPS + h - 1);
    size_t looks = 0, longest = 0, all = 0;
    for (size_t bucket = 0; bucket < shapes->capacity; bucket++) {
        size_t length = 0;
        for (uint32_t k = shapes->buckets[bucket]; k != NARC_NO_SHAPE; k = shapes->entries[k].next)
            looks += ++length;
        all += length;
        longest = length > longest ? length : longest;
    }
    assert_int_equal(all, STEPS * STEPS);
    /* Of random lists at most as many as shapes: half of one more than its own. The longest of 22,500 is 8 or so. */
    assert_true(looks < 2 * all);
    assert_true(longest < 16);
}

TEST(added_at_an_index) {
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    const struct shape box = box_of(2, 1, 0), other = box_of(3, 1, 0);
    narc_error error;
    expect_ok(narc_add_shape_at(shapes, 5, box.arcs, 4, &error), &error); /* extends */
    assert_int_equal(narc_count_shapes(shapes), 6);
    for (uint32_t k = 0; k < 5; k++) {
        narc_aabb aabb;
        assert_int_equal(narc_count_uses(shapes, k), 0);
        assert_int_equal(narc_get_arcs(shapes, k, NULL), 0);
        assert_false(narc_get_aabb(shapes, k, 1, 0, 1, &aabb));
        expect_error(narc_remove_shape(shapes, k, &error), NARC_ERROR_INDEX, &error, "was removed");
    }
    expect_ok(narc_add_shape_at(shapes, 2, box.arcs, 4, &error), &error); /* fills; an equal one is no matter */
    expect_error(narc_add_shape_at(shapes, 2, other.arcs, 4, &error), NARC_ERROR_IN_USE, &error,
                 "there is a shape 2 already");
    expect_error(narc_add_shape_at(shapes, UINT32_MAX, box.arcs, 4, &error), NARC_ERROR_INDEX, &error, "4294967295");
    expect_error(narc_add_shape_at(NULL, 0, box.arcs, 4, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_add_shape_at(shapes, 0, NULL, 4, &error), NARC_ERROR_ARGUMENT, &error, "arcs is NULL");
    assert_int_equal(narc_count_shapes(shapes), 6);
    assert_int_equal(store_shape(shapes, other), 0);
    const uint32_t found = store_shape(shapes, box);
    assert_true((found == 2 || found == 5) && narc_count_uses(shapes, found) == 2);
    static const uint32_t free_ones[] = {1, 3, 4, 6};
    for (uint32_t k = 0; k < 4; k++)
        assert_int_equal(store_shape(shapes, box_of(4 + k, 1, 0)), free_ones[k]);
}

/* Any order of indices, each in a time that does not depend on how many there are. */
TEST(fills_indices_in_any_order) {
    enum { COUNT = 5000 };
    struct ledger ledger = {0};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
    for (uint32_t k = COUNT; k-- > 0;) {
        const struct shape box = box_of(1 + k, 1, 0);
        assert_int_equal(narc_add_shape_at(shapes, k, box.arcs, 4, NULL), NARC_OK);
    }
    assert_int_equal(shapes->removed_count, 0);
    for (uint32_t k = 0; k < COUNT; k++)
        assert_int_equal(store_shape(shapes, box_of(1 + k, 1, 0)), k);
    assert_int_equal(narc_count_shapes(shapes), COUNT);
}
