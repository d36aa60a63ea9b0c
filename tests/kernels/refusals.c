/* SPDX-License-Identifier: MIT
 *
 * refusals.c - wrong arguments of what scenes are asked: each has its status and a message that names the culprit, and no
 * output is touched. tests/api/errors.c has those of pairs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "ledger.h"
#include "ray_room.h"

enum { BODIES = 30, ITEMS = 10, ROWS = 2 * BODIES };

/* What nothing is wrong with, and outputs of all calls. */
static struct room room;
static narc_shapes *store;
static narc_bodies bodies;
static narc_rays rays;
static narc_points points;
static narc_motions motions;
static narc_error error;
static struct test_ray *items;
static const narc_motion still[BODIES];
static const uint32_t first_body[BODIES];
static union {
    narc_ray_hit hits[ROWS];
    narc_distance distances[ROWS];
    narc_impact impacts[ROWS];
    narc_box boxes[ROWS];
    narc_body parts[ROWS];
    narc_refined_contact fine[ROWS];
    float separations[ROWS];
    uint32_t numbers[2][ROWS];
} out;
static size_t count_out;

static int set_up(void **state) {
    struct test_random random = test_random_named("refusals");
    (void)state;
    room = create_room(&random, NARC_FLOAT32, BODIES, 10);
    items = make_rays(&random, &room, ITEMS, 10);
    store = room.scene.store;
    bodies = scene_bodies(&room.scene);
    rays = view_rays(items, ITEMS);
    points = (narc_points){.count = ITEMS, .x = rays.x, .y = rays.y};
    motions = view_motions(still);
    memset(&out, GUARD_JUNK, sizeof out);
    count_out = 12345;
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    free(items);
    destroy_room(&room);
    return 0;
}

#define REFUSED(STATUS, words, ...) expect_error(__VA_ARGS__, NARC_ERROR_##STATUS, &error, words)

/* With one change to a copy of an argument, which is called `wrong` in the call. */
#define CHANGED(argument, change, STATUS, words, ...)                                                                  \
    do {                                                                                                               \
        __typeof__(argument) wrong = argument;                                                                         \
        wrong.change;                                                                                                  \
        REFUSED(STATUS, words, __VA_ARGS__);                                                                           \
    } while (0)

static void expect_untouched(void) { assert_true(is_junk(&out, sizeof out) && count_out == 12345); }

/* ------------------------------------------------------------------------------------------------ through an index */

TEST(refuses_rays) {
#define CAST(index, shapes, bodies, rays, options, rows, capacity)                                                     \
    narc_cast_rays(index, shapes, bodies, rays, options, rows, capacity, &error)
    REFUSED(ARGUMENT, "index", CAST(NULL, store, &bodies, &rays, NULL, out.hits, ROWS));
    REFUSED(ARGUMENT, "shapes", CAST(room.index, NULL, &bodies, &rays, NULL, out.hits, ROWS));
    REFUSED(ARGUMENT, "bodies", CAST(room.index, store, NULL, &rays, NULL, out.hits, ROWS));
    REFUSED(ARGUMENT, "rays", CAST(room.index, store, &bodies, NULL, NULL, out.hits, ROWS));
    REFUSED(ARGUMENT, "out_rows", CAST(room.index, store, &bodies, &rays, NULL, NULL, ROWS));
    REFUSED(CAPACITY, "10 rays", CAST(room.index, store, &bodies, &rays, NULL, out.hits, ITEMS - 1));
#define WRONG_RAYS(change, words)                                                                                      \
    CHANGED(rays, change, ARGUMENT, words, CAST(room.index, store, &bodies, &wrong, NULL, out.hits, ROWS))
    WRONG_RAYS(x.base = NULL, "rays.x");
    WRONG_RAYS(y.base = NULL, "rays.y");
    WRONG_RAYS(motion_x.base = NULL, "rays.motion_x");
    WRONG_RAYS(motion_y.base = NULL, "rays.motion_y");
    WRONG_RAYS(y.precision = NARC_FLOAT32, "precision");
    WRONG_RAYS(reserved[1] = &out, "rays.reserved[1]");
#if SIZE_MAX > UINT32_MAX
    WRONG_RAYS(count = (size_t)UINT32_MAX + 1, "at most");
#endif
#define WRONG_OPTIONS(STATUS, words, ...)                                                                              \
    REFUSED(STATUS, words,                                                                                             \
            CAST(room.index, store, &bodies, &rays, (&(narc_ray_options){.out_skipped = &count_out, __VA_ARGS__}),     \
                 out.hits, 2 * ITEMS))
    WRONG_OPTIONS(ARGUMENT, "options.inside", .inside = (narc_inside)3);
    WRONG_OPTIONS(ARGUMENT, "options.reserved[0]", .reserved = {&out});
    WRONG_OPTIONS(ARGUMENT, "options.search.reserved[0]", .search.reserved = {&out});
    WRONG_OPTIONS(CAPACITY, "3 rows", .most = 3);
    WRONG_OPTIONS(CAPACITY, "room for 20", .most = SIZE_MAX);
#define WRONG_BODIES(change, words)                                                                                    \
    CHANGED(bodies, change, ARGUMENT, words, CAST(room.index, store, &wrong, &rays, NULL, out.hits, ROWS))
    WRONG_BODIES(count--, "29 bodies");
    WRONG_BODIES(sine.base = NULL, "sine");
    WRONG_BODIES(reserved[0] = &out, "bodies.reserved[0]");
    expect_untouched();
    expect_ok(CAST(room.index, store, &bodies, &(narc_rays){0}, NULL, NULL, 0), &error);
#undef CAST
}

/* Owners that are none, wherever they are told. */
TEST(refuses_owners) {
    const narc_owners unnamed = {.ignored = NARC_ARRAY(first_body)},
                      taken = {.owner = NARC_ARRAY(first_body), .reserved = {NULL, &out}};
    const narc_ray_options by_rays = {.search.owners = &unnamed};
    const narc_nearest_options by_points = {.search.owners = &unnamed};
    const narc_index_query by_movers = {.owners = &taken}, by_regions = {.owners = &unnamed};
    narc_pairs pairs;
    REFUSED(ARGUMENT, "options.search.owners->owner is NULL",
            narc_cast_rays(room.index, store, &bodies, &rays, &by_rays, out.hits, ROWS, &error));
    REFUSED(ARGUMENT, "options.search.owners->owner is NULL",
            narc_find_nearest(room.index, store, &bodies, &points, &by_points, out.distances, ROWS, &error));
    REFUSED(ARGUMENT, "query.owners->owner is NULL",
            narc_query_index(room.index, room.boxes, BODIES, &by_regions, &pairs, &error));
    REFUSED(ARGUMENT, "search.owners->reserved[1]",
            narc_cast_shapes(room.index, store, &bodies, &bodies, NULL, &by_movers, NULL, out.impacts, ROWS, &error));
    expect_untouched();
}

/* A world that an index without worlds has not: it would find bodies of all. */
TEST(refuses_worlds_that_are_none) {
    const narc_index_query search = {.world = NARC_ARRAY(first_body)};
    const narc_ray_options by_rays = {.search = search};
    const narc_nearest_options by_points = {.search = search};
    narc_pairs pairs;
    REFUSED(ARGUMENT, "options.search.world is asked for",
            narc_cast_rays(room.index, store, &bodies, &rays, &by_rays, out.hits, ROWS, &error));
    REFUSED(ARGUMENT, "options.search.world is asked for",
            narc_find_nearest(room.index, store, &bodies, &points, &by_points, out.distances, ROWS, &error));
    REFUSED(ARGUMENT, "query.world is asked for",
            narc_query_index(room.index, room.boxes, BODIES, &search, &pairs, &error));
    REFUSED(ARGUMENT, "search.world is asked for",
            narc_cast_shapes(room.index, store, &bodies, &bodies, NULL, &search, NULL, out.impacts, ROWS, &error));
    expect_untouched();
}

TEST(refuses_movers) {
#define CAST(index, shapes, bodies, movers, motions, search, options, rows, capacity)                                  \
    narc_cast_shapes(index, shapes, bodies, movers, motions, search, options, rows, capacity, &error)
    REFUSED(ARGUMENT, "index is NULL", CAST(NULL, store, &bodies, &bodies, &motions, NULL, NULL, out.impacts, ROWS));
    REFUSED(ARGUMENT, "shapes is NULL",
            CAST(room.index, NULL, &bodies, &bodies, &motions, NULL, NULL, out.impacts, ROWS));
    REFUSED(ARGUMENT, "movers is NULL",
            CAST(room.index, store, &bodies, NULL, &motions, NULL, NULL, out.impacts, ROWS));
    REFUSED(ARGUMENT, "out_rows is NULL", CAST(room.index, store, &bodies, &bodies, &motions, NULL, NULL, NULL, ROWS));
    REFUSED(CAPACITY, "30 rows",
            CAST(room.index, store, &bodies, &bodies, &motions, NULL, NULL, out.impacts, BODIES - 1));
    CHANGED(bodies, count--, ARGUMENT, "29 bodies, but the index was built from 30 boxes",
            CAST(room.index, store, &wrong, &bodies, &motions, NULL, NULL, out.impacts, ROWS));
    CHANGED(bodies, reserved[1] = &out, ARGUMENT, "bodies.reserved[1]",
            CAST(room.index, store, &bodies, &wrong, &motions, NULL, NULL, out.impacts, ROWS));
    CHANGED(motions, reserved[0] = &out, ARGUMENT, "motions.reserved[0]",
            CAST(room.index, store, &bodies, &bodies, &wrong, NULL, NULL, out.impacts, ROWS));
    const narc_index_query taken = {.reserved = {&out}};
    REFUSED(ARGUMENT, "search.reserved[0]",
            CAST(room.index, store, &bodies, &bodies, &motions, &taken, NULL, out.impacts, ROWS));
    const float targets[BODIES] = {[7] = NAN};
#define WRONG_CASTS(STATUS, words, ...)                                                                                \
    REFUSED(STATUS, words,                                                                                             \
            CAST(room.index, store, &bodies, &bodies, &motions, NULL, (&(narc_cast_options){__VA_ARGS__}),             \
                 out.impacts, ROWS))
    WRONG_CASTS(ARGUMENT, "tolerance", .tolerance = -1);
    WRONG_CASTS(NOT_FINITE, "target", .target = NAN);
    WRONG_CASTS(NOT_FINITE, "tolerance", .tolerance = INFINITY);
    WRONG_CASTS(ARGUMENT, "options.reserved[0]", .reserved = {&out});
    WRONG_CASTS(NOT_FINITE, "options.targets[7] is nan", .targets = NARC_ARRAY(targets));
    const uint32_t shape = room.scene.bodies[5].shape;
    room.scene.bodies[5].shape = 1000000;
    REFUSED(INDEX, "body 5: shape is 1000000",
            CAST(room.index, store, &bodies, &bodies, &motions, NULL, NULL, out.impacts, ROWS));
    room.scene.bodies[5].shape = shape;
    struct ledger ledger = {0};
    const narc_allocator allocator = ledger_allocator(&ledger);
    narc_index *poor = NULL;
    expect_ok(narc_create_index(&allocator, &poor), &error);
    expect_ok(narc_build_index(poor, room.boxes, BODIES, NULL, &error), &error);
    ledger.limited = true;
    REFUSED(MEMORY, "no memory for 30 movers",
            CAST(poor, store, &bodies, &bodies, &motions, NULL, NULL, out.impacts, ROWS));
    narc_destroy_index(poor);
    expect_untouched();
#undef CAST
}

TEST(refuses_points) {
#define NEAREST(index, shapes, bodies, options, rows, capacity)                                                        \
    narc_find_nearest(index, shapes, bodies, &points, options, rows, capacity, &error)
#define WRONG_NEAREST(STATUS, words, ...)                                                                              \
    REFUSED(STATUS, words,                                                                                             \
            NEAREST(room.index, store, &bodies, (&(narc_nearest_options){__VA_ARGS__}), out.distances, 2 * ITEMS - 1))
    REFUSED(ARGUMENT, "index", NEAREST(NULL, store, &bodies, NULL, out.distances, ROWS));
    REFUSED(ARGUMENT, "shapes", NEAREST(room.index, NULL, &bodies, NULL, out.distances, ROWS));
    REFUSED(ARGUMENT, "out_rows", NEAREST(room.index, store, &bodies, NULL, NULL, ROWS));
    REFUSED(CAPACITY, "10 points", NEAREST(room.index, store, &bodies, NULL, out.distances, ITEMS - 1));
    WRONG_NEAREST(CAPACITY, "19 rows", .most = 2);
    WRONG_NEAREST(CAPACITY, "rows", .most = SIZE_MAX);
    WRONG_NEAREST(NOT_FINITE, "distance", .distance = NAN);
    WRONG_NEAREST(ARGUMENT, "options.reserved[2]", .reserved = {NULL, NULL, &out});
    WRONG_NEAREST(ARGUMENT, "options.search.reserved[0]", .search.reserved = {&out});
    CHANGED(bodies, count--, ARGUMENT, "29 bodies", NEAREST(room.index, store, &wrong, NULL, out.distances, ROWS));
    const narc_index_column own = {NULL, 0};
#define DISTANCES(shapes, bodies, points, body, rows)                                                                  \
    narc_find_distances(shapes, bodies, points, &body, NULL, rows, &error)
    REFUSED(ARGUMENT, "shapes", DISTANCES(NULL, &bodies, &points, own, out.distances));
    REFUSED(ARGUMENT, "bodies", DISTANCES(store, NULL, &points, own, out.distances));
    REFUSED(ARGUMENT, "points", DISTANCES(store, &bodies, NULL, own, out.distances));
    REFUSED(ARGUMENT, "out_rows", DISTANCES(store, &bodies, &points, own, NULL));
    CHANGED(bodies, sine.base = NULL, ARGUMENT, "bodies.sine", DISTANCES(store, &wrong, &points, own, out.distances));
#define WRONG_POINTS(change, STATUS, words)                                                                            \
    CHANGED(points, change, STATUS, words, DISTANCES(store, &bodies, &wrong, own, out.distances))
    WRONG_POINTS(x.base = NULL, ARGUMENT, "points.x");
    WRONG_POINTS(y.base = NULL, ARGUMENT, "points.y");
    WRONG_POINTS(y.precision = NARC_FLOAT32, ARGUMENT, "precision");
    WRONG_POINTS(reserved[1] = &out, ARGUMENT, "reserved[1]");
    WRONG_POINTS(count = BODIES + 1, INDEX, "point 30");
#if SIZE_MAX > UINT32_MAX
    WRONG_POINTS(count = (size_t)UINT32_MAX + 1, ARGUMENT, "at most");
#endif
    const uint32_t wrong_bodies[ITEMS] = {0, 1, 2, 3, 4, BODIES, 6, 40, 8, 9}, but_three[ITEMS] = {0, 1, 2};
    REFUSED(INDEX, "point 5: the body is 30",
            DISTANCES(store, &bodies, &points, NARC_ARRAY(wrong_bodies), out.distances));
    const uint32_t shape = room.scene.bodies[3].shape;
    room.scene.bodies[3].shape = FAMILY_COUNT;
    REFUSED(INDEX, "body 3 has shape 15", DISTANCES(store, &bodies, &points, own, out.distances));
    expect_untouched();
    /* What is not asked of may be wrong, and through an index is not looked at beforehand, nor found. */
    expect_ok(DISTANCES(store, &bodies, &(narc_points){0}, own, NULL), &error);
    expect_ok(DISTANCES(store, &bodies, &points, NARC_ARRAY(but_three), out.distances), &error);
    expect_ok(NEAREST(room.index, store, &bodies, NULL, out.distances, ROWS), &error);
    for (size_t k = 0; k < ITEMS; k++)
        assert_true(out.distances[k].count == 1 && out.distances[k].body != 3);
    room.scene.bodies[3].shape = shape;
    memset(&out, GUARD_JUNK, sizeof out);
}

TEST(refuses_indices_and_regions) {
    const narc_box boxes[2] = {{0, 0, 1, 1}, {2, 2, 3, 3}};
    const narc_allocator half = {.release = ledger_allocator(NULL).release};
    const narc_index_options taken = {.reserved = {&out}};
    const narc_index_query query = {.reserved = {&out}};
    narc_pairs pairs = {.count = 7};
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    const narc_index_column none = {0};
    static const uint32_t listed[] = {1, 2};
    const narc_index_column changed = NARC_ARRAY(listed);
    narc_index_statistics statistics = {.slack = 9};
    assert_int_equal(narc_create_index(NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_create_index(&half, &index), NARC_ERROR_ARGUMENT);
    assert_null(index);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, boxes, 2, NULL, NULL), NARC_OK);
    REFUSED(ARGUMENT, "index is NULL", narc_build_index(NULL, boxes, 2, NULL, &error));
    REFUSED(ARGUMENT, "boxes is NULL", narc_build_index(index, NULL, 2, NULL, &error));
    REFUSED(ARGUMENT, "boxes in one index", narc_build_index(index, boxes, (size_t)1 << 31 | 1, NULL, &error));
    REFUSED(ARGUMENT, "options.reserved[0]", narc_build_index(index, boxes, 2, &taken, &error));
    REFUSED(ARGUMENT, "index is NULL", narc_update_index(NULL, boxes, 2, NULL, 0, NULL, &error));
    REFUSED(ARGUMENT, "boxes is NULL", narc_update_index(index, NULL, 2, NULL, 0, NULL, &error));
    REFUSED(ARGUMENT, "changed is NULL", narc_update_index(index, boxes, 2, &none, 1, NULL, &error));
    REFUSED(INDEX, "changed[1] is 2", narc_update_index(index, boxes, 2, &changed, 2, NULL, &error));
    assert_int_equal(error.index, 1);
    REFUSED(ARGUMENT, "options.reserved[0]", narc_update_index(index, boxes, 2, NULL, 0, &taken, &error));
    REFUSED(ARGUMENT, "index is NULL", narc_describe_index(NULL, &statistics, &error));
    REFUSED(ARGUMENT, "out_statistics is NULL", narc_describe_index(index, NULL, &error));
    narc_box nodes[1];
    size_t count = 9;
    REFUSED(ARGUMENT, "index is NULL", narc_copy_nodes(NULL, 0, nodes, 0, 1, &count, &error));
    REFUSED(ARGUMENT, "out_boxes is NULL", narc_copy_nodes(index, 0, NULL, 0, 1, &count, &error));
    REFUSED(ARGUMENT, "out_count is NULL", narc_copy_nodes(index, 0, nodes, 0, 1, NULL, &error));
    REFUSED(ARGUMENT, "stride is 17", narc_copy_nodes(index, 0, nodes, 17, 1, &count, &error));
    assert_int_equal(count, 9);
    REFUSED(CAPACITY, "1 boxes", narc_copy_nodes(index, 0, NULL, 0, 0, &count, &error));
    assert_int_equal(count, 1);
    REFUSED(ARGUMENT, "index is NULL", narc_query_index(NULL, boxes, 1, NULL, &pairs, &error));
    REFUSED(ARGUMENT, "boxes is NULL", narc_query_index(index, NULL, 1, NULL, &pairs, &error));
    REFUSED(ARGUMENT, "out_pairs is NULL", narc_query_index(index, boxes, 1, NULL, NULL, &error));
    REFUSED(ARGUMENT, "queries in one call", narc_query_index(index, boxes, UINT32_MAX, NULL, &pairs, &error));
    REFUSED(ARGUMENT, "query.reserved[0]", narc_query_index(index, boxes, 1, &query, &pairs, &error));
    assert_true(statistics.slack == 9 && pairs.count == 7);
    expect_ok(narc_query_index(index, NULL, 0, NULL, &pairs, &error), &error);
    assert_int_equal(pairs.count, 0);
    expect_ok(narc_query_index(index, boxes, 2, NULL, &pairs, &error), &error); /* it is as it was */
    assert_int_equal(pairs.count, 2);
}

/* ------------------------------------------------------------------------------------------------ without one */

TEST(refuses_casts_of_pairs) {
    const narc_pairs pairs = {.count = 2}, others = {.count = 2, .other_bodies = &bodies};
    const float targets[] = {0, -INFINITY};
#define CAST(shapes, pairs, other_motions, options, rows, capacity)                                                    \
    narc_cast_pairs(shapes, &bodies, &motions, pairs, other_motions, options, rows, capacity, &error)
    REFUSED(ARGUMENT, "shapes is NULL", CAST(NULL, &pairs, NULL, NULL, out.impacts, 2));
    REFUSED(ARGUMENT, "pairs is NULL", CAST(store, NULL, NULL, NULL, out.impacts, 2));
    REFUSED(ARGUMENT, "other_motions", CAST(store, &pairs, &motions, NULL, out.impacts, 2));
    CHANGED(motions, reserved[1] = &out, ARGUMENT, "other_motions.reserved[1]",
            CAST(store, &others, &wrong, NULL, out.impacts, 2));
    REFUSED(NOT_FINITE, "options.targets[1] is -inf",
            CAST(store, &pairs, NULL, (&(narc_cast_options){.targets = NARC_ARRAY(targets)}), out.impacts, 2));
    REFUSED(ARGUMENT, "tolerance is -2",
            CAST(store, &pairs, NULL, (&(narc_cast_options){.tolerance = -2}), out.impacts, 2));
    REFUSED(ARGUMENT, "parting is -1",
            CAST(store, &pairs, NULL, (&(narc_cast_options){.parting = -1}), out.impacts, 2));
    REFUSED(NOT_FINITE, "parting is",
            CAST(store, &pairs, NULL, (&(narc_cast_options){.parting = INFINITY}), out.impacts, 2));
    REFUSED(CAPACITY, "2 rows", CAST(store, &pairs, NULL, NULL, out.impacts, 1));
    REFUSED(ARGUMENT, "out_rows is NULL", CAST(store, &pairs, NULL, NULL, NULL, 2));
    expect_untouched();
    expect_ok(CAST(store, &(narc_pairs){0}, NULL, NULL, NULL, 0), &error);
#undef CAST
}

TEST(refuses_casts_of_two_bodies) {
    const narc_body a = {.cosine = 1, .scale = 1}, b = {.x = 4, .cosine = 1, .scale = 1};
    const narc_body nowhere = {.cosine = 1, .scale = 1, .shape = 1000}, broken = {.cosine = 1};
    const narc_motion motion = {.x = 4};
    const float target = NAN;
    size_t skipped = 9;
    narc_impact row;
#define CAST(shapes, a, b, options, row) narc_cast_pair(shapes, a, &motion, b, NULL, options, row, &error)
    REFUSED(ARGUMENT, "shapes is NULL", CAST(NULL, &a, &b, NULL, out.impacts));
    REFUSED(ARGUMENT, "a is NULL", CAST(store, NULL, &b, NULL, out.impacts));
    REFUSED(ARGUMENT, "b is NULL", CAST(store, &a, NULL, NULL, out.impacts));
    REFUSED(ARGUMENT, "out_row is NULL", CAST(store, &a, &b, NULL, NULL));
    REFUSED(INDEX, "shape 1000", CAST(store, &a, &nowhere, NULL, out.impacts));
    REFUSED(INDEX, "shape 1000", CAST(store, &nowhere, &b, NULL, out.impacts));
    REFUSED(NOT_FINITE, "options.target is", CAST(store, &a, &b, (&(narc_cast_options){.target = NAN}), out.impacts));
    REFUSED(ARGUMENT, "parting is -1", CAST(store, &a, &b, (&(narc_cast_options){.parting = -1}), out.impacts));
    expect_untouched();
    narc_cast_options options = {.targets = {&target, 0}, .out_skipped = &skipped}; /* those of a batch do not count */
    expect_ok(CAST(store, &a, &b, &options, &row), &error);
    assert_true(row.count == NARC_CAST_HIT && row.body == 1 && skipped == 0);
    expect_ok(CAST(store, &a, &broken, &options, &row), &error);
    assert_true(row.count == NARC_CAST_MISS && row.pair == 0 && skipped == 1);
#undef CAST
}

TEST(refuses_separations) {
    const narc_pairs pairs = {.count = BODIES / 2};
    const narc_query wrong[] = {
        {.margin = NAN},
        {.first = BODIES},
        {.first = 10, .count = 11},
        {.selection = NARC_ARRAY(((const uint32_t[]){0, 20})), .selection_count = 2},
        {.selection = NARC_ARRAY(((const uint32_t[]){0})), .selection_count = SIZE_MAX},
        {.reserved = {&error}},
    };
    const uint32_t far[BODIES / 2] = {[14] = 40};
    const narc_pairs indices = {.count = BODIES / 2, .a = NARC_ARRAY(far), .b = NARC_ARRAY(far)};
#define FIND(shapes, pairs, query, rows) narc_find_separations(shapes, &bodies, pairs, query, rows, &error)
    REFUSED(ARGUMENT, "out_separations", FIND(store, &pairs, NULL, NULL));
    REFUSED(ARGUMENT, "row_stride", FIND(store, &pairs, &(narc_query){.row_stride = 6}, out.separations));
    REFUSED(ARGUMENT, "shapes", FIND(NULL, &pairs, NULL, out.separations));
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_int_not_equal(FIND(store, &pairs, &wrong[k], out.separations), NARC_OK);
    REFUSED(INDEX, "40", FIND(store, &indices, NULL, out.separations));
    expect_untouched();
    expect_ok(FIND(store, &(narc_pairs){0}, NULL, NULL), &error);
#undef FIND
}

TEST(refuses_boxes) {
#define FIND(shapes, bodies, options, rows) narc_compute_boxes(shapes, bodies, options, rows, &error)
#define WRONG_BOXES(STATUS, words, ...)                                                                                \
    REFUSED(STATUS, words,                                                                                             \
            FIND(store, &bodies, (&(narc_box_options){.out_skipped = &count_out, __VA_ARGS__}), out.boxes))
    REFUSED(ARGUMENT, "shapes", FIND(NULL, &bodies, NULL, out.boxes));
    REFUSED(ARGUMENT, "bodies", FIND(store, NULL, NULL, out.boxes));
    REFUSED(ARGUMENT, "out_boxes", FIND(store, &bodies, NULL, NULL));
    CHANGED(bodies, sine.base = NULL, ARGUMENT, "sine", FIND(store, &wrong, NULL, out.boxes));
#if SIZE_MAX > UINT32_MAX
    CHANGED(bodies, count = (size_t)UINT32_MAX + 1, ARGUMENT, "at most", FIND(store, &wrong, NULL, out.boxes));
#endif
    WRONG_BOXES(ARGUMENT, "bodies 20 and the 11", .first = 20, .count = 11);
    WRONG_BOXES(ARGUMENT, "bodies 31 and the 0", .first = 31);
    WRONG_BOXES(ARGUMENT, "options.reserved[0] is not NULL", .reserved = {&out});
    WRONG_BOXES(ARGUMENT, "margin", .margin = -1);
    WRONG_BOXES(NOT_FINITE, "margin", .margin = NAN);
    WRONG_BOXES(NOT_FINITE, "margin", .margin = INFINITY);
    expect_untouched();
    const narc_box_options options = {.out_skipped = &count_out};
    expect_ok(FIND(store, &(narc_bodies){0}, &options, NULL), &error);
    assert_int_equal(count_out, 0);
    count_out = 12345;
}

/* The bodies of many parts: the first of several wrong shapes is named, whatever thread finds it; one that is not asked of
 * is no matter. */
TEST(names_the_first_wrong_shape) {
    enum { COUNT = 200000 };
    AUTO(free_at) uint32_t *const shape = calloc(COUNT, sizeof *shape);
    AUTO(free_at) narc_box *const boxes = make_junk(COUNT * sizeof *boxes);
    narc_bodies many = bodies;
    many.count = COUNT;
    many.x.stride = many.y.stride = many.cosine.stride = many.sine.stride = many.scale.stride = 0;
    many.shape = NARC_ARRAY(shape);
    shape[70000] = shape[70001] = shape[150000] = 12345;
    for (unsigned threads = 1; threads < 5; threads++) {
        const narc_workers workers = openmp_workers(threads);
        narc_box_options options = {.workers = &workers};
        REFUSED(INDEX, "body 70000", FIND(store, &many, &options, boxes));
        assert_int_equal(error.index, 70000);
        options.first = 70001, options.count = 100000;
        REFUSED(INDEX, "body 70001", FIND(store, &many, &options, boxes));
        assert_true(is_junk(boxes, COUNT * sizeof *boxes));
    }
    expect_ok(FIND(store, &many, &(narc_box_options){.count = 70000}, boxes), &error);
#undef FIND
}

TEST(refuses_parts) {
    enum { PARTS = 90000 };
    AUTO(free_at) uint32_t *const owners = calloc(PARTS, sizeof *owners);
    const narc_index_column owner = NARC_ARRAY(first_body), of_many = {owners, sizeof *owners};
    narc_bodies many = bodies;
#define PLACE(owners, parts, owner, rows) narc_place_parts(owners, parts, &owner, NULL, rows, &error)
    REFUSED(ARGUMENT, "owners is NULL", PLACE(NULL, &bodies, owner, out.parts));
    REFUSED(ARGUMENT, "parts is NULL", PLACE(&bodies, NULL, owner, out.parts));
    REFUSED(ARGUMENT, "out_bodies is NULL", PLACE(&bodies, &bodies, owner, NULL));
    REFUSED(ARGUMENT, "owner is NULL", PLACE(&bodies, &bodies, (narc_index_column){0}, out.parts));
#define WRONG_OWNERS(change, words) CHANGED(bodies, change, ARGUMENT, words, PLACE(&wrong, &bodies, owner, out.parts))
#define WRONG_PARTS(change, words)  CHANGED(bodies, change, ARGUMENT, words, PLACE(&bodies, &wrong, owner, out.parts))
    WRONG_OWNERS(x.base = NULL, "owners.x");
    WRONG_OWNERS(cosine.base = NULL, "owners.cosine");
    WRONG_OWNERS(sine.base = NULL, "owners.sine");
    WRONG_OWNERS(y.precision = (narc_precision)7, "precision");
    WRONG_OWNERS(reserved[1] = &out, "owners.reserved[1]");
    WRONG_PARTS(y.base = NULL, "parts.y");
    WRONG_PARTS(cosine.base = NULL, "parts.cosine");
    WRONG_PARTS(sine.base = NULL, "parts.sine");
    WRONG_PARTS(shape.base = NULL, "parts.shape");
    WRONG_PARTS(reserved[0] = &out, "parts.reserved[0]");
#if SIZE_MAX > UINT32_MAX
    WRONG_OWNERS(count = (size_t)UINT32_MAX + 1, "at most");
    WRONG_PARTS(count = (size_t)UINT32_MAX + 1, "at most");
#endif
    expect_untouched();
    expect_ok(PLACE(&(narc_bodies){0}, &(narc_bodies){0}, (narc_index_column){0}, NULL), &error);
    AUTO(free_at) narc_body *const rows = make_junk(PARTS * sizeof *rows);
    many.count = PARTS;
    many.x.stride = many.y.stride = many.cosine.stride = many.sine.stride = many.scale.stride = many.shape.stride = 0;
    owners[80000] = UINT32_MAX;
    owners[70000] = BODIES;
    for (unsigned threads = 1; threads < 4; threads++) {
        const narc_workers workers = openmp_workers(threads);
        REFUSED(INDEX, "part 70000: the owner is 30, but there are 30",
                narc_place_parts(&bodies, &many, &of_many, &workers, rows, &error));
        assert_int_equal(error.index, 70000);
    }
    assert_true(is_junk(rows, PARTS * sizeof *rows));
#undef PLACE
}

TEST(refuses_lists_of_pairs) {
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *const broad = create_broad_phase(NULL);
    const narc_box box = {0, 0, 1, 1};
    uint32_t *const a = out.numbers[0], *const b = out.numbers[1];
#define FIND(broad, boxes, count, a, b, found)                                                                         \
    narc_find_pairs(broad, boxes, count, NULL, NULL, a, b, 0, 1, found, &error)
    REFUSED(ARGUMENT, "broad", FIND(NULL, &box, 1, a, b, &count_out));
    REFUSED(ARGUMENT, "boxes", FIND(broad, NULL, 1, a, b, &count_out));
    REFUSED(ARGUMENT, "out_a", FIND(broad, &box, 1, NULL, b, &count_out));
    REFUSED(ARGUMENT, "out_b", FIND(broad, &box, 1, a, NULL, &count_out));
    REFUSED(ARGUMENT, "out_count", FIND(broad, &box, 1, a, b, NULL));
    REFUSED(ARGUMENT, "4294967295 boxes", FIND(broad, &box, UINT32_MAX, a, b, &count_out));
    REFUSED(ARGUMENT, "stride is 6", narc_find_pairs(broad, &box, 1, NULL, NULL, a, b, 6, 1, &count_out, &error));
    const uint32_t zero = 0, one = 1;
    const narc_pairs pair = {.count = 1, .a = {&zero, 0}, .b = {&zero, 0}}, own = {.count = 1};
    REFUSED(ARGUMENT, "pairs", narc_copy_pairs(NULL, NULL, 1, a, b, 0, &error));
    REFUSED(ARGUMENT, "pairs.a", narc_copy_pairs(&own, NULL, 1, a, b, 0, &error));
    REFUSED(ARGUMENT, "out_a", narc_copy_pairs(&pair, NULL, 1, NULL, b, 0, &error));
    REFUSED(ARGUMENT, "stride is -2", narc_copy_pairs(&pair, NULL, 1, a, b, -2, &error));
    REFUSED(INDEX, "2 pairs", narc_copy_pairs(&pair, NULL, 2, a, b, 0, &error));
    REFUSED(INDEX, "item 0: pair 1", narc_copy_pairs(&pair, &one, 1, a, b, 0, &error));
    assert_int_equal(narc_copy_pairs(&own, NULL, 0, NULL, NULL, 0, &error), NARC_OK);
    assert_int_equal(narc_create_broad_phase(NULL, NULL), NARC_ERROR_ARGUMENT);
    expect_untouched();
    narc_destroy_broad_phase(NULL);
}

TEST(refuses_rows_to_refine) {
    const uint32_t box = store_shape(store, box_of(2, 1, 0));
    const narc_body two[2] = {{0, 0, 1, 0, 1, box}, {1.5, 0, 1, 0, 1, box}};
    narc_bodies of_boxes;
    narc_view_bodies(two, 2, &of_boxes);
    const narc_pairs pairs = {.count = 1};
    const double number = 1;
    const narc_contact row = {.count = 1, .feature = 3, .normal_x = 1}, far = {.pair = 1},
                       odd = {.count = 1, .feature = 4 << 8};
    const narc_refinement half = {.shift_x = {&number, 0, NARC_FLOAT64}}, taken = {.reserved = {&out}};
#define REFINE(shapes, bodies, pairs, with, rows, fine)                                                                \
    narc_refine_contacts(shapes, bodies, pairs, with, rows, 1, fine, &error)
    REFUSED(ARGUMENT, "shapes", REFINE(NULL, &of_boxes, &pairs, NULL, &row, out.fine));
    REFUSED(ARGUMENT, "bodies", REFINE(store, NULL, &pairs, NULL, &row, out.fine));
    REFUSED(ARGUMENT, "pairs", REFINE(store, &of_boxes, NULL, NULL, &row, out.fine));
    REFUSED(ARGUMENT, "rows", REFINE(store, &of_boxes, &pairs, NULL, NULL, out.fine));
    REFUSED(ARGUMENT, "out_rows", REFINE(store, &of_boxes, &pairs, NULL, &row, NULL));
    REFUSED(ARGUMENT, "refinement.shift.y is NULL", REFINE(store, &of_boxes, &pairs, &half, &row, out.fine));
    REFUSED(ARGUMENT, "reserved", REFINE(store, &of_boxes, &pairs, &taken, &row, out.fine));
    REFUSED(INDEX, "row 0: pair is 1, but there are 1 pairs", REFINE(store, &of_boxes, &pairs, NULL, &far, out.fine));
    REFUSED(INDEX, "body b touches with arc or edge 4, but its shape",
            REFINE(store, &of_boxes, &pairs, NULL, &odd, out.fine));
    expect_untouched();
    expect_ok(narc_refine_contacts(store, &of_boxes, &pairs, NULL, NULL, 0, NULL, &error), &error);
}

int main(void) { return test_begin() ? test_run("refusals", set_up, tear_down) : TEST_SKIPPED; }
