/* SPDX-License-Identifier: MIT
 *
 * ray_numbers.c - rays and bodies of any numbers: what has no answer, garbage, any size and distance; and errors.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "ray_room.h"

/* ------------------------------------------------------------------------------------------------ broken numbers */

TEST(skips_rays_without_an_answer) {
    struct test_random random = test_random_named("skipped rays");
    enum { COUNT = 50, RAYS = 12 };
    struct room room = create_room(&random, NARC_FLOAT64, COUNT, 10);
    for (size_t k = 0; k < RAYS; k++) {
        struct test_ray rays[RAYS];
        size_t skipped = 99;
        for (size_t i = 0; i < RAYS; i++)
            rays[i] = (struct test_ray){room.scene.bodies[0].x - 5, room.scene.bodies[0].y, 10, 0, 1};
        switch (k) {
        case 0:
            rays[k].x = NAN;
            break;
        case 1:
            rays[k].y = -INFINITY;
            break;
        case 2:
            rays[k].motion_x = NAN;
            break;
        case 3:
            rays[k].motion_y = INFINITY;
            break;
        case 4:
            rays[k].motion_x = 0;
            break;
        case 5:
            rays[k].fraction = NAN;
            break;
        case 6:
            rays[k].fraction = -1e-30f;
            break;
        case 7:
            rays[k].x = INFINITY;
            break;
        default:
            rays[k].fraction = INFINITY;
            break;
        }
        const narc_rays view = view_rays(rays, RAYS);
        narc_ray_hit *const hits = cast_in_room(&room, &view, &(narc_ray_options){.out_skipped = &skipped});
        assert_int_equal(skipped, k < 8);
        for (size_t i = 0; i < RAYS; i++) {
            const narc_ray_hit none = {.ray = (uint32_t)i};
            if (i == k && k < 8)
                assert_memory_equal(&hits[i], &none, sizeof none);
            else
                assert_int_equal(hits[i].count, 1);
        }
        guard_release(hits);
    }
    destroy_room(&room);
}

static float any_float(struct test_random *random) {
    const uint32_t bits = (uint32_t)random_bits(random);
    float number;
    memcpy(&number, &bits, sizeof number);
    return random_below(random, 2) ? number : (float)random_between(random, -10, 10);
}

/* Random bits as every number of every ray and body: nothing hangs or crashes, no row has a NaN or is out of range. */
TEST(survives_garbage) {
    struct test_random random = test_random_named("garbage rays");
    enum { COUNT = 100, RAYS = 200, MOST = 4 };
    for (size_t trial = 0; trial < test_trials(60); trial++) {
        struct room room = create_room(&random, (narc_precision)(trial % 2), COUNT, 10);
        struct test_ray *const rays = make_rays(&random, &room, RAYS, 10);
        for (size_t k = 0; k < RAYS; k++) {
            const uint64_t words[2] = {random_bits(&random), random_bits(&random)};
            if (random_below(&random, 2))
                memcpy(&rays[k].x, words, sizeof words);
            float *const numbers[] = {&rays[k].motion_x, &rays[k].motion_y, &rays[k].fraction};
            for (size_t i = 0; i < 3; i++)
                *numbers[i] = random_below(&random, 2) ? any_float(&random) : *numbers[i];
        }
        /* Boxes are of bodies as they were, or are anything. */
        for (size_t k = 0; k < COUNT; k++) {
            struct body *const body = &room.scene.bodies[k];
            float *const numbers[] = {&body->cosine, &body->sine, &body->scale, &body->x_single, &body->y_single};
            if (random_below(&random, 2))
                *numbers[random_below(&random, 5)] = any_float(&random);
            if (random_below(&random, 4) == 0)
                body->x = (double)any_float(&random) * (double)any_float(&random);
            if (random_below(&random, 8) == 0)
                body->shape = (uint32_t)random_bits(&random);
            if (random_below(&random, 2))
                room.boxes[k] =
                    (narc_box){any_float(&random), any_float(&random), any_float(&random), any_float(&random)};
        }
        narc_error error;
        expect_ok(narc_build_index(room.index, room.boxes, COUNT, NULL, &error), &error);
        const narc_rays view = view_rays(rays, RAYS);
        const narc_ray_options options = {.most = MOST, .inside = (narc_inside)(trial % 3)};
        narc_ray_hit *const hits = cast_in_room(&room, &view, &options);
        for (size_t k = 0; k < RAYS * MOST; k++) {
            const narc_ray_hit *const hit = &hits[k];
            assert_true(hit->ray == k / MOST && hit->count <= 1 && hit->body < COUNT);
            assert_true(hit->fraction >= 0 && hit->fraction <= FLT_MAX);
            assert_true(fabsf(hit->normal_x) <= 1.000001f && fabsf(hit->normal_y) <= 1.000001f && hit->radius >= 0);
            assert_true(!isnan(hit->point_x) && !isnan(hit->point_y));
        }
        guard_release(hits);
        free(rays);
        destroy_room(&room);
    }
}

/* Scenes of any size, far from anything, with rays from beyond and of any length. */
TEST(finds_bodies_of_any_size_from_anywhere) {
    struct test_random random = test_random_named("any size");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        struct scene scene = create_scene(NARC_FLOAT64, 1, 1, 1);
        const struct shape disc = circle_of(1);
        const double size = random_log_between(&random, 1e-8, 1e8), away = size * random_log_between(&random, 1, 1e9);
        const double angle = trial % 4 ? random_between(&random, -4, 4) : 1.5707963267948966 * (double)(trial / 4 % 4);
        scene_add_shape(&scene, &disc);
        struct body body = turned_body(0, size);
        body.x = trial % 3 ? 0 : random_log_between(&random, 1e-6, 1e6) * size;
        scene_add_body(&scene, body);
        struct room room = {.scene = scene};
        narc_box box;
        room.boxes = &box;
        assert_int_equal(narc_create_index(NULL, &room.index), NARC_OK);
        index_room(&room, false, false);
        const double length = random_log_between(&random, 1e-30, 1e30);
        struct test_ray ray = {
            .motion_x = (float)(length * cos(angle)), .motion_y = (float)(length * sin(angle)), .fraction = INFINITY};
        const double unit = hypot((double)ray.motion_x, (double)ray.motion_y);
        ray.x = scene.bodies[0].x - away * ((double)ray.motion_x / unit);
        ray.y = -away * ((double)ray.motion_y / unit);
        const narc_rays view = view_rays(&ray, 1);
        narc_ray_hit *const hit = cast_in_room(&room, &view, &(narc_ray_options){.inside = NARC_INSIDE_LEAVES});
        if (away > 1.001 * size && away / unit < 1e38) {
            assert_int_equal(hit->count, 1);
            assert_true(fabs((double)hit->fraction * unit - (away - size)) <= 1e-6 * away);
            assert_true(fabs(hypot((double)hit->point_x, (double)hit->point_y) - size) <= 1e-6 * size);
        }
        guard_release(hit);
        narc_destroy_index(room.index);
        destroy_scene(&scene);
    }
}

/* ------------------------------------------------------------------------------------------------ errors */

TEST(refuses_bad_arguments) {
    struct test_random random = test_random_named("errors of rays");
    enum { COUNT = 30, RAYS = 10 };
    struct room room = create_room(&random, NARC_FLOAT32, COUNT, 10);
    struct test_ray *const ray = make_rays(&random, &room, RAYS, 10);
    const narc_bodies bodies = scene_bodies(&room.scene);
    const narc_rays rays = view_rays(ray, RAYS);
    narc_shapes *const shapes = room.scene.store;
    narc_ray_hit hits[2 * RAYS];
    narc_error error;
    size_t skipped = 5;
    memset(hits, GUARD_JUNK, sizeof hits);
#define EXPECT(index, shapes, bodies, rays, options, hits, capacity, status, words)                                    \
    expect_error(narc_cast_rays(index, shapes, bodies, rays, options, hits, capacity, &error), status, &error, words)
    EXPECT(NULL, shapes, &bodies, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "index");
    EXPECT(room.index, NULL, &bodies, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "shapes");
    EXPECT(room.index, shapes, NULL, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "bodies");
    EXPECT(room.index, shapes, &bodies, NULL, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "rays");
    EXPECT(room.index, shapes, &bodies, &rays, NULL, NULL, RAYS, NARC_ERROR_ARGUMENT, "out_rows");
    EXPECT(room.index, shapes, &bodies, &rays, NULL, hits, RAYS - 1, NARC_ERROR_CAPACITY, "10 rays");
#define WRONG_RAYS(change, status, words)                                                                              \
    do {                                                                                                               \
        narc_rays wrong = rays;                                                                                        \
        wrong.count = 1;                                                                                               \
        wrong.change;                                                                                                  \
        EXPECT(room.index, shapes, &bodies, &wrong, NULL, hits, RAYS, status, words);                                  \
    } while (0)
    WRONG_RAYS(x.base = NULL, NARC_ERROR_ARGUMENT, "rays.x");
    WRONG_RAYS(y.base = NULL, NARC_ERROR_ARGUMENT, "rays.y");
    WRONG_RAYS(motion_x.base = NULL, NARC_ERROR_ARGUMENT, "rays.motion_x");
    WRONG_RAYS(motion_y.base = NULL, NARC_ERROR_ARGUMENT, "rays.motion_y");
    WRONG_RAYS(y.precision = NARC_FLOAT32, NARC_ERROR_ARGUMENT, "precision");
    WRONG_RAYS(reserved[1] = hits, NARC_ERROR_ARGUMENT, "rays.reserved[1]");
#if SIZE_MAX > UINT32_MAX
    WRONG_RAYS(count = (size_t)UINT32_MAX + 1, NARC_ERROR_ARGUMENT, "at most");
#endif
#define WRONG_OPTIONS(status, words, ...)                                                                              \
    EXPECT(room.index, shapes, &bodies, &rays, (&(narc_ray_options){.out_skipped = &skipped, __VA_ARGS__}), hits,      \
           2 * RAYS, status, words)
    WRONG_OPTIONS(NARC_ERROR_ARGUMENT, "options.inside", .inside = (narc_inside)3);
    WRONG_OPTIONS(NARC_ERROR_ARGUMENT, "options.reserved[0]", .reserved = {hits});
    WRONG_OPTIONS(NARC_ERROR_ARGUMENT, "options.search.reserved[2]", .search.reserved = {NULL, NULL, hits});
    static const uint32_t owner[COUNT];
    const narc_owners none_named = {.ignored = NARC_ARRAY(owner)},
                      reserved = {.owner = NARC_ARRAY(owner), .reserved = {NULL, hits}};
    WRONG_OPTIONS(NARC_ERROR_ARGUMENT, "options.search.owners->owner is NULL", .search.owners = &none_named);
    WRONG_OPTIONS(NARC_ERROR_ARGUMENT, "options.search.owners->reserved[1]", .search.owners = &reserved);
    const narc_points points = {.count = RAYS, .x = rays.x, .y = rays.y};
    narc_distance near[RAYS];
    expect_error(narc_find_nearest(room.index, shapes, &bodies, &points,
                                   &(narc_nearest_options){.search.owners = &none_named}, near, RAYS, &error),
                 NARC_ERROR_ARGUMENT, &error, "options.search.owners->owner is NULL");
    narc_pairs pairs;
    expect_error(
        narc_query_index(room.index, room.boxes, COUNT, &(narc_index_query){.owners = &none_named}, &pairs, &error),
        NARC_ERROR_ARGUMENT, &error, "query.owners->owner is NULL");
    narc_impact impacts[COUNT];
    expect_error(narc_cast_shapes(room.index, shapes, &bodies, &bodies, NULL, &(narc_index_query){.owners = &reserved},
                                  NULL, impacts, COUNT, &error),
                 NARC_ERROR_ARGUMENT, &error, "search.owners->reserved[1]");
    WRONG_OPTIONS(NARC_ERROR_CAPACITY, "3 rows", .most = 3);
    WRONG_OPTIONS(NARC_ERROR_CAPACITY, "room for 20", .most = SIZE_MAX);
    narc_bodies wrong = bodies;
    wrong.count--;
    EXPECT(room.index, shapes, &wrong, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "29 bodies");
    wrong = bodies;
    wrong.sine.base = NULL;
    EXPECT(room.index, shapes, &wrong, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "sine");
    wrong = bodies;
    wrong.reserved[0] = hits;
    EXPECT(room.index, shapes, &wrong, &rays, NULL, hits, RAYS, NARC_ERROR_ARGUMENT, "bodies.reserved[0]");
    assert_true(is_junk(hits, sizeof hits));
    assert_int_equal(skipped, 5);
    const narc_rays none = {0};
    expect_ok(narc_cast_rays(room.index, shapes, &bodies, &none, NULL, NULL, 0, &error), &error);
    /* Nothing to hit. */
    const narc_bodies nobody = {0};
    expect_ok(narc_build_index(room.index, NULL, 0, NULL, &error), &error);
    expect_ok(narc_cast_rays(room.index, shapes, &nobody, &rays, NULL, hits, RAYS, &error), &error);
    for (size_t k = 0; k < RAYS; k++)
        assert_true(hits[k].ray == k && hits[k].count == 0);
    free(ray);
    destroy_room(&room);
}

TEST_MAIN("ray_numbers")
