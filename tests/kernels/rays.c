/* SPDX-License-Identifier: MIT
 *
 * rays.c - where rays meet one body, against a reference in long double: shapes of all families, rays that graze, pass
 * through junctions and corners and along edges, come from 1e6 sizes away or start inside.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "hard.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "ray_reference.h"

enum { RAYS = 64 };

/* A body in some place: mostly at rest near the origin, or turned, far away, large or small. */
static struct body place_body(struct test_random *random, narc_precision precision) {
    const double angle =
        random_below(random, 4) ? random_between(random, -4, 4) : 1.5707963267948966 * (double)random_below(random, 4);
    struct body body = turned_body(angle, random_below(random, 2) ? 1 : random_log_between(random, 1e-4, 1e4));
    if (random_below(random, 4) == 0) {
        const float factor = (float)(1 + 0.49 * NARC_ROTATION_TOLERANCE * random_between(random, -1, 1));
        body.cosine *= factor;
        body.sine *= factor;
    }
    const double far = random_below(random, 2) ? 0 : (double)body.scale * (precision == NARC_FLOAT64 ? 1e7 : 1e2);
    body.x = far * random_between(random, -1, 1);
    body.y = far * random_between(random, -1, 1);
    round_position(&body, precision);
    return body;
}

struct statistics {
    size_t rays, hits, inside;
    struct ray_errors worst;
};

static void check_body(struct test_random *random, narc_index *index, const struct scene *scene, enum ray_kind kind,
                       struct statistics *statistics) {
    const struct shape *const shape = &scene->shapes[0];
    const struct outline_reference outline = make_outline_reference(shape);
    const struct body *const body = &scene->bodies[0];
    const narc_bodies bodies = scene_bodies(scene);
    const narc_inside inside = (narc_inside)random_below(random, 3);
    struct test_ray rays[RAYS];
    narc_ray_hit hits[RAYS];
    narc_box box;
    narc_error error;
    for (size_t k = 0; k < RAYS; k++)
        rays[k] = make_ray(random, shape, body, scene->precision, kind);
    const narc_rays view = view_rays(rays, RAYS);
    const narc_ray_options options = {.inside = inside};
    expect_ok(narc_compute_boxes(scene->store, &bodies, NULL, &box, &error), &error);
    expect_ok(narc_build_index(index, &box, 1, NULL, &error), &error);
    expect_ok(narc_cast_rays(index, scene->store, &bodies, &view, &options, hits, RAYS, &error), &error);
    for (size_t k = 0; k < RAYS; k++) {
        const char *const wrong = check_ray_hit(&outline, body, &rays[k], inside, &hits[k], &statistics->worst);
        const struct ray_truth truth = find_ray_truth(&outline, body, &rays[k]);
        statistics->rays++;
        statistics->hits += hits[k].count;
        statistics->inside += truth.start < 0;
        if (wrong || hits[k].ray != k || hits[k].body != 0)
            fail_msg(
                "%s: ray %s, from (%.17g, %.17g) by (%.9g, %.9g) up to %.9g, option %d; starts %Lg bounds outside, "
                "least %Lg; fraction %.9g, normal (%.9g, %.9g), point (%.9g, %.9g), feature %u, count %u; %zu arcs, "
                "body at (%.17g, %.17g), rotation (%.9g, %.9g), scale %.9g",
                wrong ? wrong : "numbers", ray_kind_name(kind), rays[k].x, rays[k].y, (double)rays[k].motion_x,
                (double)rays[k].motion_y, (double)rays[k].fraction, (int)inside, truth.start / truth.bound,
                truth.least / truth.bound, (double)hits[k].fraction, (double)hits[k].normal_x, (double)hits[k].normal_y,
                (double)hits[k].point_x, (double)hits[k].point_y, hits[k].feature, hits[k].count, shape->count, body->x,
                body->y, (double)body->cosine, (double)body->sine, (double)body->scale);
    }
}

static void check_family(const char *name, bool hard, int family, size_t trials) {
    struct test_random random = test_random_named(name);
    struct statistics all = {0};
    narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (size_t trial = 0; trial < trials; trial++) {
        struct scene scene = create_scene((narc_precision)(trial % 2), 1, 1, 1);
        const struct shape shape =
            hard ? make_hard_shape(&random, (enum hard_family)family) : make_shape(&random, (enum family)family);
        scene_add_shape(&scene, &shape);
        scene_add_body(&scene, place_body(&random, scene.precision));
        for (enum ray_kind kind = 0; kind < RAY_KINDS; kind++)
            check_body(&random, index, &scene, kind, &all);
        destroy_scene(&scene);
    }
    narc_destroy_index(index);
    printf("  %-9s %zu rays, %.0f %% hit, %.0f %% from inside; worst, of the bound: outline %.3f, ray %.3f, early "
           "%.3f, normal %.3f\n",
           name, all.rays, 100.0 * (double)all.hits / (double)all.rays, 100.0 * (double)all.inside / (double)all.rays,
           all.worst.outline, all.worst.ray, all.worst.early, all.worst.normal);
    assert_true(all.hits > all.rays / 10);
}

TEST(meets_bodies_of_all_families) {
    for (enum family family = 0; family < FAMILY_COUNT; family++)
        check_family(family_name(family), false, (int)family, test_trials(20));
}

TEST(meets_hard_shapes) {
    for (enum hard_family family = 0; family < HARD_COUNT; family++)
        check_family(hard_family_name(family), true, (int)family, test_trials(10));
}

/* Where rays meet two bodies with exact numbers, one at the origin and one at (2, 0), both 2 wide and high; `first`: what
 * the index takes for the box of the first one. */
static narc_ray_hit *meet_two(double radius, const narc_box *first, const struct test_ray *rays, size_t count,
                              narc_ray_options options) {
    static narc_ray_hit hits[32];
    struct scene scene = create_scene(NARC_FLOAT32, 1, 2, 1);
    struct shape box;
    narc_index *index;
    narc_box boxes[2];
    narc_error error;
    const size_t most = options.most ? options.most : 1;
    assert_true(count * most <= sizeof hits / sizeof *hits);
    expect_ok(narc_build_box(2, 2, radius, box.arcs, &box.count, &error), &error);
    scene_add_shape(&scene, &box);
    scene_add_body(&scene, turned_body(0, 1));
    scene_add_body(&scene, turned_body(0, 1));
    scene.bodies[1].x = scene.bodies[1].x_single = 2;
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_rays view = view_rays(rays, count);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(scene.store, &bodies, NULL, boxes, &error), &error);
    boxes[0] = first ? *first : boxes[0];
    boxes[1] = first ? (narc_box){1e6f, 1e6f, 2e6f, 2e6f} : boxes[1]; /* which makes the room for rounding large */
    expect_ok(narc_build_index(index, boxes, 2, NULL, &error), &error);
    expect_ok(narc_cast_rays(index, scene.store, &bodies, &view, &options, hits, count * most, &error), &error);
    narc_destroy_index(index);
    destroy_scene(&scene);
    return hits;
}

/* A line exactly through a junction enters by what begins there, counter-clockwise; so one along the common side of two
 * boxes enters one of them, whichever way it goes. */
TEST(junctions_are_of_what_begins_there) {
    const struct test_ray up[] = {{-0.75, -5, 0, 8, 1}, {0.75, -5, 0, 8, 1}};
    const narc_ray_hit *hits = meet_two(0.25, NULL, up, 2, (narc_ray_options){0});
    assert_int_equal(hits[0].feature, NARC_FEATURE_EDGE + 3);
    assert_int_equal(hits[1].feature, 3);
    for (size_t k = 0; k < 2; k++)
        assert_true(hits[k].count && hits[k].fraction == 0.5f && hits[k].normal_x == 0 && hits[k].normal_y == -1 &&
                    hits[k].point_y == -1);
    const struct test_ray between[] = {{1, -5, 0, 8, 1}, {1, 5, 0, -8, 1}};
    hits = meet_two(0, NULL, between, 2, (narc_ray_options){.most = 2});
    for (size_t k = 0; k < 4; k += 2)
        assert_true(hits[k].count && !hits[k + 1].count && hits[k].fraction == 0.5f);
}

/* A start on the outline, or within, counts at fraction 0, though the ray goes no further; one outside does not. */
TEST(rays_may_end_where_they_start) {
    const struct test_ray rays[] = {
        {-1, 0, 3, 0, 0}, {0.5, 0.5, 0, 1, 0}, {-1.5, 0, 3, 0, 0}, {-2.5, 0, 3, 0, 0.5f}, {-2.5, 0, 3, 0, 0.4999999f}};
    const narc_ray_hit *const hits = meet_two(0, NULL, rays, 5, (narc_ray_options){0});
    assert_true(hits[0].count && hits[0].fraction == 0 && hits[1].count && hits[1].fraction == 0);
    for (size_t k = 0; k < 2; k++) /* what a body stops within itself has no normal */
        assert_true(hits[k].normal_x == 0 && hits[k].normal_y == 0 && hits[k].point_x == (float)rays[k].x);
    assert_true(!hits[2].count && hits[3].count && hits[3].fraction == 0.5f && !hits[4].count);
}

/* A body counts within its box alone: or what is hit would depend on the order in which boxes are met. */
TEST(bodies_count_within_their_boxes) {
    const struct test_ray ray = {-5, 0.5, 8, 0, 1}, rising = {-5, -1, 8, 2, 1}, within = {0, 0.5, 8, 0, 1};
    const narc_ray_options leaves = {.inside = NARC_INSIDE_LEAVES};
    const narc_box late = {-0.5f, -1, 1, 1}, early = {-1, -1, 0.5f, 1}, beside = {-1, 0.625f, 1, 1},
                   other = {3, -1, 4, 1}, front = {-1, -1, -1, 1};
    const narc_ray_hit *hit = meet_two(0, &late, &ray, 1, (narc_ray_options){0});
    assert_true(hit->count && hit->fraction == 0.5625f && hit->point_x == -0.5f);
    hit = meet_two(0, &early, &within, 1, leaves);
    assert_true(hit->count && hit->fraction == 0.0625f && hit->point_x == 0.5f);
    hit = meet_two(0, &front, &ray, 1, (narc_ray_options){0}); /* no wider than the edge that is met */
    assert_true(hit->count && hit->fraction == 0.5f && hit->point_x == -1);
    assert_int_equal(meet_two(0, &beside, &rising, 1, (narc_ray_options){0})->count, 0);
    assert_int_equal(meet_two(0, &other, &ray, 1, (narc_ray_options){0})->count, 0);
}

/* Fractions up to the largest float, of motions down to the smallest one. */
TEST(moves_by_the_least_and_the_most) {
    const float least = 0x1p-149f;
    const struct test_ray rays[] = {{-1 - 0x1p-20, 0, 4 * least, 0, INFINITY},
                                    {-1 - 0x1p-20, 0, least, 0, INFINITY}, /* beyond the largest fraction */
                                    {-5, 0, FLT_MAX, 0, INFINITY},
                                    {-5, 0.5, FLT_MAX, -least, 1},
                                    {-5, -5, FLT_MAX, FLT_MAX, INFINITY}};
    const narc_ray_hit *const hits = meet_two(0, NULL, rays, 5, (narc_ray_options){0});
    assert_true(hits[0].count && hits[0].fraction == 0x1p127f && !hits[1].count);
    for (size_t k = 2; k < 4; k++)
        assert_true(hits[k].count && hits[k].normal_x == -1 &&
                    fabs((double)hits[k].fraction * (double)FLT_MAX - 4) < 1e-6);
    assert_true(hits[4].count && hits[4].body == 0 && fabsf(hits[4].point_x + 1) < 1e-6f);
}

/* Rays past the corners of a box, as near as numbers allow, from up to 2^50 away; the box stands at the origin or where floats
 * are up to 2 apart. A body that is ignored changes nothing, though it is so far away that the room for rounding is
 * large. */
TEST(finds_the_same_beside_a_far_body) {
    struct test_random random = test_random_named("corners from afar");
    enum { COUNT = 4000 };
    static struct test_ray rays[COUNT];
    static narc_ray_hit alone[COUNT], beside[COUNT];
    const uint32_t other = 1;
    const narc_ray_options options = {.search.ignored = {&other, 0}};
    const narc_rays view = view_rays(rays, COUNT);
    narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (int trial = 0; trial < 16; trial++) {
        struct scene scene = create_scene(NARC_FLOAT64, 1, 2, 1);
        struct body body = turned_body(0, 1);
        struct shape box;
        narc_error error;
        size_t hits = 0;
        body.x = trial < 8 ? 0 : ldexp(1, 10 + 2 * (trial - 8)) + 1;
        expect_ok(narc_build_box(2, 2, 0, box.arcs, &box.count, &error), &error);
        scene_add_shape(&scene, &box);
        scene_add_body(&scene, body);
        scene_add_body(&scene, body);
        for (size_t k = 0; k < COUNT; k++) {
            const float angle = (float)random_between(&random, -4, 4);
            const double away = random_log_between(&random, 1, 0x1p50);
            struct test_ray *const ray = &rays[k];
            ray->motion_x = cosf(angle);
            ray->motion_y = sinf(angle);
            ray->fraction = INFINITY;
            const double along = (double)ray->motion_x, up = (double)ray->motion_y;
            const double off = random_between(&random, -4, 4) * 0x1p-53 * (away + fabs(body.x));
            const double x = body.x + (random_below(&random, 2) ? 1 : -1), y = random_below(&random, 2) ? 1 : -1;
            ray->x = x - off * up - away * along;
            ray->y = y + off * along - away * up;
        }
        const float left = (float)(body.x - 1), right = (float)(body.x + 1);
        const narc_box boxes[2] = {{left, -1, right, 1}, {-0x1p50f, -0x1p50f, 0x1p50f, 0x1p50f}};
        for (size_t count = 1; count <= 2; count++) {
            scene.body_count = count;
            const narc_bodies bodies = scene_bodies(&scene);
            expect_ok(narc_build_index(index, boxes, count, NULL, &error), &error);
            expect_ok(narc_cast_rays(index, scene.store, &bodies, &view, &options, count == 1 ? alone : beside, COUNT,
                                     &error),
                      &error);
        }
        for (size_t k = 0; k < COUNT; k++)
            hits += beside[k].count;
        assert_memory_equal(alone, beside, sizeof alone);
        assert_true(hits > COUNT / 8);
        destroy_scene(&scene);
    }
    narc_destroy_index(index);
}

TEST_MAIN("rays")
