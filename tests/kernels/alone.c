/* SPDX-License-Identifier: MIT
 *
 * alone.c - rays and points that ask of one body each, beside an index of that body alone, distances, and the reference.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "narc_chains.h"
#include "placements.h"
#include "ray_room.h"
#include "turtle.h"

enum { BODIES = 60, RAYS = 600 };

/* ------------------------------------------------------------------------------------------------ rays */

/* The row of a ray by an index of one body. */
static narc_ray_hit cast_at(const struct room *room, const narc_bodies *bodies, const struct test_ray *ray,
                            uint32_t number, uint32_t body, narc_inside inside, size_t *skipped) {
    narc_bodies one = *bodies;
    const narc_rays rays = view_rays(ray, 1);
    const narc_ray_options options = {.inside = inside, .out_skipped = skipped};
    narc_ray_hit hit;
    narc_error error;
    narc_box box;
    one.count = 1;
    one.x.base = (const char *)one.x.base + (ptrdiff_t)body * one.x.stride;
    one.y.base = (const char *)one.y.base + (ptrdiff_t)body * one.y.stride;
    one.cosine.base =
        (const float *)(const void *)((const char *)one.cosine.base + (ptrdiff_t)body * one.cosine.stride);
    one.sine.base = (const float *)(const void *)((const char *)one.sine.base + (ptrdiff_t)body * one.sine.stride);
    one.scale.base = (const float *)(const void *)((const char *)one.scale.base + (ptrdiff_t)body * one.scale.stride);
    one.shape.base =
        (const uint32_t *)(const void *)((const char *)one.shape.base + (ptrdiff_t)body * one.shape.stride);
    narc_index *const index = index_bodies(room->scene.store, &one, NULL, &box);
    expect_ok(narc_cast_rays(index, room->scene.store, &one, &rays, &options, &hit, 1, &error), &error);
    narc_destroy_index(index);
    hit.ray = number;
    hit.body = hit.count ? body : 0;
    return hit;
}

/* A call of one ray has the row of a batch. */
static void check_one_ray(const struct room *room, const narc_bodies *bodies, const struct test_ray *ray,
                          uint32_t number, uint32_t body, const narc_ray_options *options, narc_ray_hit right) {
    const narc_rays one = view_rays(ray, 1);
    const narc_index_column named = {&body, 0};
    size_t skipped = 99;
    narc_ray_options own = *options;
    narc_ray_hit hit;
    narc_error error;
    own.out_skipped = &skipped;
    expect_ok(narc_cast_ray_pairs(room->scene.store, bodies, &one, &named, &own, &hit, 1, &error), &error);
    assert_true(skipped <= (right.count == 0));
    hit.ray = number;
    assert_memory_equal(&hit, &right, sizeof right);
}

/* Any bodies, broken ones among them, any rays, also those without an answer: the rows are those of an index, and of each
 * ray by itself. */
TEST(rays_hit_one_body_as_by_an_index) {
    struct test_random random = test_random_named("rays alone");
    size_t hits = 0;
    for (size_t trial = 0; trial < test_trials(8); trial++) {
        const narc_precision precision = (narc_precision)(trial % 2);
        AUTO(destroy_room) struct room room = create_room(&random, precision, BODIES, 6);
        AUTO(free_at) struct test_ray *const rays = make_rays(&random, &room, RAYS, 6);
        const narc_bodies bodies = scene_bodies(&room.scene);
        const narc_workers workers = openmp_workers(3);
        uint32_t body[RAYS];
        rays[5].motion_x = NAN;
        rays[6].motion_x = rays[6].motion_y = 0;
        rays[7].fraction = -1;
        rays[8].fraction = INFINITY;
        for (size_t k = 0; k < RAYS; k++)
            body[k] = (uint32_t)random_below(&random, BODIES);
        for (int inside = 0; inside < 3; inside++) {
            const narc_rays view = view_rays(rays, RAYS);
            size_t skipped = 99, expected = 0;
            const narc_index_column column = NARC_ARRAY(body);
            const narc_ray_options options = {
                .search.workers = &workers, .inside = (narc_inside)inside, .out_skipped = &skipped};
            AUTO(guard_release_at) narc_ray_hit *const rows = guard_allocate(RAYS * sizeof *rows);
            narc_error error;
            expect_ok(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, &options, rows, RAYS, &error),
                      &error);
            for (uint32_t k = 0; k < RAYS; k++) {
                size_t own = 0;
                const narc_ray_hit right = cast_at(&room, &bodies, &rays[k], k, body[k], (narc_inside)inside, &own);
                assert_memory_equal(&rows[k], &right, sizeof right);
                check_one_ray(&room, &bodies, &rays[k], k, body[k], &options, right);
                expected += own;
                hits += right.count;
            }
            assert_int_equal(skipped, expected);
        }
    }
    assert_true(hits > test_trials(8) * RAYS / 20);
}

/* ------------------------------------------------------------------------------------------------ points */

/* A call of one point has the row of a batch. */
static void check_one_point(const struct room *room, const narc_bodies *bodies, const struct test_ray *at,
                            uint32_t number, uint32_t body, const narc_distance *right) {
    const narc_rays view = view_rays(at, 1);
    const narc_points one = {.count = 1, .x = view.x, .y = view.y};
    const narc_index_column named = {&body, 0};
    narc_distance row;
    uint64_t bits;
    narc_error error;
    expect_ok(narc_find_distances(room->scene.store, bodies, &one, &named, NULL, &row, &error), &error);
    expect_ok(narc_find_inside(room->scene.store, bodies, &one, &named, NULL, &bits, &error), &error);
    row.point = number;
    assert_memory_equal(&row, right, sizeof row);
    assert_true(bits == (right->separation < 0));
}

/* Points near and far, on outlines, of bodies in any order and runs: each bit is that of a separation, and where that is not near 0
 * that of the reference. */
TEST(points_are_within_where_separations_are_below_0) {
    struct test_random random = test_random_named("points alone");
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        AUTO(destroy_room) struct room room = create_room(&random, (narc_precision)(trial % 2), BODIES, 6);
        const narc_bodies bodies = scene_bodies(&room.scene);
        const size_t count = 1 + random_below(&random, RAYS);
        uint32_t body[RAYS];
        struct test_ray at[RAYS];
        size_t within = 0;
        for (size_t k = 0, run = 0; k < count; k++, run--) {
            run = run == 0 ? 1 + random_below(&random, trial % 3 ? 40 : 2) : run;
            body[k] = k > 0 && run > 1 ? body[k - 1] : (uint32_t)random_below(&random, BODIES);
            const struct body *const b = &room.scene.bodies[body[k]];
            const double far = (double)b->scale * random_log_between(&random, 1e-3, 4),
                         angle = random_between(&random, -4, 4);
            at[k] = (struct test_ray){.x = b->x + far * cos(angle), .y = b->y + far * sin(angle)};
            if (trial % 2 == 0)
                at[k].x = (double)(float)at[k].x, at[k].y = (double)(float)at[k].y;
        }
        at[0].x = random_below(&random, 2) ? NAN : at[0].x;
        const narc_rays view = view_rays(at, count);
        const narc_points points = {.count = count, .x = view.x, .y = view.y};
        const narc_index_column column = {trial % 5 ? body : &body[count - 1], trial % 5 ? sizeof *body : 0};
        const narc_workers workers = openmp_workers(3);
        AUTO(guard_release_at) narc_distance *const rows = guard_allocate(count * sizeof *rows);
        AUTO(guard_release_at) uint64_t *const bits = guard_allocate(NARC_BIT_WORDS(count) * sizeof *bits);
        narc_error error;
        expect_ok(narc_find_inside(room.scene.store, &bodies, &points, &column, &workers, bits, &error), &error);
        expect_ok(narc_find_distances(room.scene.store, &bodies, &points, &column, NULL, rows, &error), &error);
        for (size_t k = 0; k < count; k++) {
            const bool is_in = bit_is_set(bits, k);
            assert_int_equal(is_in, rows[k].separation < 0);
            check_one_point(&room, &bodies, &at[k], (uint32_t)k, trial % 5 ? body[k] : body[count - 1], &rows[k]);
            within += is_in;
            if (rows[k].count == 0)
                continue;
            const struct reference_body reference = scene_reference(&room.scene, rows[k].body);
            const double x = at[k].x - reference.x, y = at[k].y - reference.y;
            const double right = reference_point_distance(&reference, x, y);
            assert_true(fabs(right) <= NARC_ERROR_BOUND * (hypot(x, y) + reference_extent(&reference)) ||
                        is_in == (right < 0));
        }
        for (size_t k = count; k < 64 * NARC_BIT_WORDS(count); k++)
            assert_false(bit_is_set(bits, k));
        assert_true(count < 50 || trial % 5 == 0 || within > 0);
    }
}

/* No point is within a piece of a chain; nothing asks of no points. */
TEST(points_are_never_within_ground) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    const narc_arc hill = {0, 0, 4, PI / 4, PI * 3 / 4};
    narc_chain_entry entry;
    size_t count;
    uint64_t bits = UINT64_MAX;
    const float x = 0, y = 3.9f;
    assert_int_equal(narc_add_chain(shapes, &hill, 1, NULL, &entry, 1, &count, NULL), NARC_OK);
    const narc_body ground = {entry.x, entry.y, 1, 0, 1, entry.shape};
    narc_bodies bodies;
    narc_view_bodies(&ground, 1, &bodies);
    const narc_points point = {.count = 1, .x = {&x, 0, NARC_FLOAT32}, .y = {&y, 0, NARC_FLOAT32}};
    assert_int_equal(narc_find_inside(shapes, &bodies, &point, NULL, NULL, &bits, NULL), NARC_OK);
    assert_true(bits == 0);
    assert_int_equal(narc_find_inside(shapes, &bodies, &(narc_points){0}, NULL, NULL, NULL, NULL), NARC_OK);
}

/* ------------------------------------------------------------------------------------------------ errors */

TEST(what_is_wrong_is_said) {
    struct test_random random = test_random_named("errors alone");
    AUTO(destroy_room) struct room room = create_room(&random, NARC_FLOAT64, BODIES, 6);
    AUTO(free_at) struct test_ray *const rays = make_rays(&random, &room, 4, 6);
    const narc_bodies bodies = scene_bodies(&room.scene);
    const narc_rays view = view_rays(rays, 4);
    const narc_points points = {.count = 4, .x = view.x, .y = view.y};
    uint32_t body[4] = {0, 1, 2, BODIES};
    const narc_index_column column = NARC_ARRAY(body);
    narc_ray_hit rows[4];
    uint64_t bits;
    narc_error error;
    memset(rows, 7, sizeof rows);
    assert_int_equal(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, NULL, rows, 4, &error),
                     NARC_ERROR_INDEX);
    assert_int_equal(error.index, 3);
    assert_non_null(strstr(error.message, "ray 3: the body is 60"));
    assert_int_equal(narc_find_inside(room.scene.store, &bodies, &points, &column, NULL, &bits, &error),
                     NARC_ERROR_INDEX);
    assert_non_null(strstr(error.message, "point 3: the body is 60"));
    body[3] = 8;
    room.scene.bodies[8].shape = 999;
    assert_int_equal(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, NULL, rows, 4, &error),
                     NARC_ERROR_INDEX);
    assert_non_null(strstr(error.message, "ray 3: body 8 has shape 999"));
    body[3] = 9;
    assert_int_equal(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, NULL, rows, 3, &error),
                     NARC_ERROR_CAPACITY);
    const narc_ray_options wrong = {.inside = (narc_inside)3};
    assert_int_equal(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, &wrong, rows, 4, &error),
                     NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_cast_ray_pairs(room.scene.store, &bodies, &view, &column, NULL, NULL, 4, &error),
                     NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_cast_ray_pairs(NULL, &bodies, &view, &column, NULL, rows, 4, &error), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_inside(room.scene.store, &bodies, &points, &column, NULL, NULL, &error),
                     NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_inside(room.scene.store, NULL, &points, &column, NULL, &bits, &error),
                     NARC_ERROR_ARGUMENT);
    for (size_t k = 0; k < sizeof rows; k++)
        assert_int_equal(((const char *)rows)[k], 7);
}

TEST_MAIN("alone")
