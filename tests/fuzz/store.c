/* SPDX-License-Identifier: MIT
 *
 * store.c - a store of shapes beside a model of it, through any calls; and stores loaded from damaged bytes.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

enum { MOST = 48, CALLS = 64 };

/* What index k should have: the arcs as they were given and stored, and how often they were added. */
struct model {
    struct shape given[MOST], shapes[MOST];
    uint32_t uses[MOST];
};

static struct shape stored_shape(const narc_shapes *store, uint32_t shape) {
    struct shape stored = {.count = 0};
    stored.count = narc_get_arcs(store, shape, stored.arcs);
    return stored;
}

static bool is_equal(const struct shape *a, const struct shape *b) {
    return a->count == b->count && memcmp(a->arcs, b->arcs, a->count * sizeof *a->arcs) == 0;
}

/* Arcs that were rounded where they lie, far from the shape's own origin, miss each other by that rounding more. */
static void check_outline(const narc_shapes *store, uint32_t index, const struct shape *stored) {
    narc_error error;
    narc_aabb box;
    double extent = 0;
    const narc_status status = narc_validate_arcs(stored->arcs, stored->count, &error);
    if (status == NARC_OK)
        return;
    assert_true(status == NARC_ERROR_NOT_CLOSED || status == NARC_ERROR_NOT_CONVEX);
    assert_true(narc_get_aabb(store, index, 1, 0, 1, &box));
    for (size_t i = 0; i < stored->count; i++)
        extent = fmax(extent, hypot(stored->arcs[i].center_x, stored->arcs[i].center_y) + stored->arcs[i].radius);
    const double size = hypot(box.max_x - box.min_x, box.max_y - box.min_y) / 2;
    assert_true(fabs(error.value) <= NARC_TOLERANCE * size + 0x1p-21 * extent);
}

static void compare(const struct model *model, const narc_shapes *store) {
    assert_true(narc_count_shapes(store) <= MOST);
    for (uint32_t k = 0; k < MOST; k++) {
        const struct shape now = stored_shape(store, k);
        assert_int_equal(narc_count_uses(store, k), model->uses[k]);
        assert_true(model->uses[k] ? is_equal(&now, &model->shapes[k]) : now.count == 0);
        if (now.count)
            check_outline(store, k, &now);
    }
}

static void add(struct model *model, narc_shapes *store, const struct shape *shape) {
    uint32_t index = MOST;
    assert_int_equal(narc_add_shape(store, shape->arcs, shape->count, &index, NULL), NARC_OK);
    assert_true(index < MOST);
    const struct shape now = stored_shape(store, index);
    if (model->uses[index]++ > 0) {
        assert_true(is_equal(&now, &model->shapes[index]));
        assert_int_equal(now.count, shape->count);
        return;
    }
    model->shapes[index] = now;
    model->given[index] = *shape;
    for (uint32_t k = 0; k < MOST; k++)
        assert_false(k != index && model->uses[k] && is_equal(shape, &model->given[k])); /* it should be found */
}

/* Is what is stored the shape that was given, but for the rounding to single precision? */
static void check_rounding(const struct shape *given, const struct shape *stored) {
    double size = 0;
    assert_int_equal(given->count, stored->count);
    for (size_t i = 0; i < given->count; i++)
        size = fmax(size, hypot(given->arcs[i].center_x, given->arcs[i].center_y) + given->arcs[i].radius);
    for (size_t i = 0; i < given->count; i++) {
        assert_true(fabs(given->arcs[i].center_x - stored->arcs[i].center_x) <= 0x1p-24 * size);
        assert_true(fabs(given->arcs[i].center_y - stored->arcs[i].center_y) <= 0x1p-24 * size);
        assert_true(fabs(given->arcs[i].radius - stored->arcs[i].radius) <= 0x1p-24 * size);
    }
}

static void put(struct model *model, narc_shapes *store, uint32_t index, const struct shape *shape, bool replace) {
    const narc_status status = replace ? narc_replace_shape(store, index, shape->arcs, shape->count, NULL)
                                       : narc_add_shape_at(store, index, shape->arcs, shape->count, NULL);
    const uint32_t uses = model->uses[index];
    const narc_status expected = replace ? (uses == 0  ? NARC_ERROR_INDEX
                                            : uses > 1 ? NARC_ERROR_IN_USE
                                                       : NARC_OK)
                                         : (uses > 0 ? NARC_ERROR_IN_USE : NARC_OK);
    assert_int_equal(status, expected);
    if (status == NARC_OK) {
        model->shapes[index] = stored_shape(store, index);
        model->given[index] = *shape;
        check_rounding(shape, &model->shapes[index]);
        model->uses[index] = 1;
    }
}

/* Saves it and loads it again, and from damaged bytes with a checksum that fits. */
static narc_shapes *save_and_load(struct bytes *from, narc_shapes *store) {
    enum { AT_CHECKSUM = 32, START = 40 };
    const size_t size = narc_count_saved_bytes(store);
    AUTO(free_at) uint8_t *const saved = malloc(size);
    narc_shapes *loaded = NULL, *damaged = NULL;
    uint64_t hash = TEST_HASH_START;
    assert_non_null(saved);
    assert_int_equal(narc_save_shapes(store, saved, size, NULL), NARC_OK);
    assert_int_equal(narc_load_shapes(NULL, saved, size, &loaded, NULL), NARC_OK);
    for (unsigned changes = take_below(from, 4); changes > 0; changes--)
        saved[take_word(from) % size] ^= (uint8_t)take_byte(from);
    for (size_t k = 0; k < size; k++)
        hash = k < AT_CHECKSUM || k >= START ? test_hash(hash, saved + k, 1) : hash;
    for (int k = 0; k < 8; k++)
        saved[AT_CHECKSUM + k] = (uint8_t)(hash >> 8 * k);
    const narc_status status = narc_load_shapes(NULL, saved, size, &damaged, NULL);
    assert_true(status == NARC_ERROR_FORMAT || status == NARC_OK);
    for (uint32_t k = 0; status == NARC_OK && k < MOST && k < narc_count_shapes(damaged); k++) {
        const struct shape shape = stored_shape(damaged, k);
        (void)narc_add_shape(damaged, shape.arcs, shape.count, NULL,
                             NULL); /* rounding may have taken it out of bounds */
    }
    narc_destroy_shapes(damaged);
    narc_destroy_shapes(store);
    return loaded;
}

/* A hull, if there is one, is a shape, and any shape a polyline. */
static void build_hull(struct bytes *from) {
    enum { POINTS = 80, ROOM = 4096 };
    static narc_point points[POINTS], line[ROOM];
    narc_arc arcs[NARC_MAX_ARCS];
    size_t corners, count = take_below(from, POINTS + 1), found;
    for (size_t k = 0; k < count; k++)
        points[k] = (narc_point){take_number(from, 4), take_number(from, 4)};
    const double tolerance = take_number(from, 1), size = take_number(from, 2);
    const narc_status status = narc_build_hull(points, count, tolerance, fabs(size), arcs, &corners, NULL);
    if (status != NARC_OK)
        return;
    assert_int_equal(narc_validate_arcs(arcs, corners, NULL), NARC_OK);
    const narc_status flat = narc_flatten_arcs(arcs, corners, true, NULL, tolerance, line, ROOM, &found, NULL);
    assert_true(flat == NARC_OK ? found >= 3 || fabs(size) > 0 || tolerance > 0 : flat != NARC_ERROR_SWEEP);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct model model = {.uses = {0}};
    narc_shapes *store = empty_store();
    for (int call = 0; call < CALLS && from.left > 0; call++) {
        const unsigned kind = take_below(&from, 8);
        const uint32_t index = take_below(&from, MOST);
        const struct shape shape = kind < 5 ? take_shape(&from) : circle_of(1);
        /* Fewer than half of the indices are put by number, so that there is room to add. */
        if (kind < 3 && call < MOST / 2)
            add(&model, store, &shape);
        else if (kind < 5)
            put(&model, store, index / 2, &shape, kind == 4);
        else if (kind < 7)
            model.uses[index] -= narc_remove_shape(store, index, NULL) == NARC_OK;
        else
            store = save_and_load(&from, store);
        compare(&model, store);
    }
    narc_destroy_shapes(store);
    build_hull(&from);
    return 0;
}
