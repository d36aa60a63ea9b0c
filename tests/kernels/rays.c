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

/* What rays meet of a scene. `hits`: `most` for each, or one. */
static void meet(const struct scene *scene, const narc_rays *rays, const narc_ray_options *options,
                 narc_ray_hit *hits) {
    const narc_bodies bodies = scene_bodies(scene);
    narc_box boxes[2];
    narc_error error;
    assert_true(bodies.count <= 2);
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene->store, &bodies, NULL, boxes);
    expect_ok(narc_cast_rays(index, scene->store, &bodies, rays, options, hits,
                             rays->count * (options->most ? options->most : 1), &error),
              &error);
}

static void check_body(struct test_random *random, const struct scene *scene, enum ray_kind kind,
                       struct statistics *statistics) {
    const struct shape *const shape = &scene->shapes[0];
    const struct outline_reference outline = make_outline_reference(shape);
    const struct body *const body = &scene->bodies[0];
    const narc_inside inside = (narc_inside)random_below(random, 3);
    struct test_ray rays[RAYS];
    narc_ray_hit hits[RAYS];
    for (size_t k = 0; k < RAYS; k++)
        rays[k] = make_ray(random, shape, body, scene->precision, kind);
    const narc_rays view = view_rays(rays, RAYS);
    const narc_ray_options options = {.inside = inside};
    meet(scene, &view, &options, hits);
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
    for (size_t trial = 0; trial < trials; trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene((narc_precision)(trial % 2), 1, 1, 1);
        const struct shape shape =
            hard ? make_hard_shape(&random, (enum hard_family)family) : make_shape(&random, (enum family)family);
        scene_add_shape(&scene, &shape);
        scene_add_body(&scene, place_body(&random, scene.precision));
        for (enum ray_kind kind = 0; kind < RAY_KINDS; kind++)
            check_body(&random, &scene, kind, &all);
    }
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

/* Where rays meet two bodies with exact numbers, one at the origin and one at (2, 0), both 2 wide and high. */
static narc_ray_hit *meet_two(double radius, const struct test_ray *rays, size_t count, narc_ray_options options) {
    static narc_ray_hit hits[32];
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 1, 2, 1);
    const struct shape box = box_of(2, 2, radius);
    const narc_rays view = view_rays(rays, count);
    assert_true(count * (options.most ? options.most : 1) <= sizeof hits / sizeof *hits);
    scene_add_shape(&scene, &box);
    scene_add_body(&scene, turned_body(0, 1));
    scene_add_body(&scene, turned_body(0, 1));
    scene.bodies[1].x = scene.bodies[1].x_single = 2;
    meet(&scene, &view, &options, hits);
    return hits;
}

/* A line exactly through a junction enters by what begins there, counter-clockwise. One along the common side of two boxes
 * touches both, whichever way it goes. */
TEST(junctions_are_of_what_begins_there) {
    const struct test_ray up[] = {{-0.75, -5, 0, 8, 1}, {0.75, -5, 0, 8, 1}};
    const narc_ray_hit *hits = meet_two(0.25, up, 2, (narc_ray_options){0});
    assert_int_equal(hits[0].feature, NARC_FEATURE_EDGE + 3);
    assert_int_equal(hits[1].feature, 3);
    for (size_t k = 0; k < 2; k++)
        assert_true(hits[k].count && hits[k].fraction == 0.5f && hits[k].normal_x == 0 && hits[k].normal_y == -1 &&
                    hits[k].point_y == -1);
    const struct test_ray between[] = {{1, -5, 0, 8, 1}, {1, 5, 0, -8, 1}};
    hits = meet_two(0, between, 2, (narc_ray_options){.most = 2});
    for (size_t k = 0; k < 4; k += 2)
        assert_true(hits[k].count && hits[k + 1].count && hits[k].fraction == 0.5f && hits[k + 1].fraction == 0.5f);
}

/* A start on the outline, or within, counts at fraction 0, though the ray goes no further; one outside does not. */
TEST(rays_may_end_where_they_start) {
    const struct test_ray rays[] = {
        {-1, 0, 3, 0, 0}, {0.5, 0.5, 0, 1, 0}, {-1.5, 0, 3, 0, 0}, {-2.5, 0, 3, 0, 0.5f}, {-2.5, 0, 3, 0, 0.4999999f}};
    const narc_ray_hit *const hits = meet_two(0, rays, 5, (narc_ray_options){0});
    assert_true(hits[0].count && hits[0].fraction == 0 && hits[1].count && hits[1].fraction == 0);
    for (size_t k = 0; k < 2; k++) /* what a body stops within itself has no normal */
        assert_true(hits[k].normal_x == 0 && hits[k].normal_y == 0 && hits[k].point_x == (float)rays[k].x);
    assert_true(!hits[2].count && hits[3].count && hits[3].fraction == 0.5f && !hits[4].count);
}

/* ------------------------------------------------------------------------------------------------ touching */

/* Two bodies that hold the origin, turned about it: with a corner each, or a place of a disc, or an end of a segment. */
static struct scene make_neighbours(struct test_random *random) {
    struct scene scene = create_scene(NARC_FLOAT64, 2, 2, 1);
    struct shape segment;
    narc_error error;
    expect_ok(
        narc_build_segment(&(narc_point){-0.5, 0}, &(narc_point){0.5, 0}, 0, segment.arcs, &segment.count, &error),
        &error);
    const double angle = random_below(random, 4) ? random_between(random, -4, 4) : 0;
    for (int k = 0; k < 2; k++) {
        const size_t kind = random_below(random, 3);
        const double size = random_below(random, 2) ? 1 : random_log_between(random, 0.1, 10);
        const struct shape shape = kind == 0 ? box_of(1, 1, 0) : kind == 1 ? circle_of(0.5) : segment;
        struct body body = turned_body(angle, size);
        const double reach = (double)body.scale * (k ? 0.5 : -0.5), rise = kind == 0 ? reach : 0;
        const double length = hypot((double)body.cosine, (double)body.sine);
        body.x = ((double)body.cosine * reach - (double)body.sine * rise) / length;
        body.y = ((double)body.sine * reach + (double)body.cosine * rise) / length;
        body.shape = scene_add_shape(&scene, &shape);
        scene_add_body(&scene, body);
    }
    return scene;
}

/* Whatever goes through a point that both hold hits both, also along a segment; normals do not point along the ray. */
TEST(nothing_slips_between_bodies_that_touch) {
    struct test_random random = test_random_named("between neighbours");
    for (size_t trial = 0; trial < test_trials(400); trial++) {
        AUTO(destroy_scene) struct scene scene = make_neighbours(&random);
        struct test_ray rays[RAYS];
        narc_ray_hit hits[2 * RAYS];
        for (size_t k = 0; k < RAYS; k++) { /* exactly through the origin: the double of a float is the motion */
            const double along = atan2((double)scene.bodies[0].sine, (double)scene.bodies[0].cosine);
            const double angle =
                k % 4 ? random_between(&random, -4, 4) : along + PI / 4 * (double)random_below(&random, 8);
            const double away = random_log_between(&random, 30, 1e4);
            const float x = (float)(away * cos(angle)), y = (float)(away * sin(angle));
            rays[k] = (struct test_ray){-(double)x, -(double)y, x, y, 2};
        }
        const narc_rays view = view_rays(rays, RAYS);
        const narc_ray_options options = {.most = 2, .inside = (narc_inside)random_below(&random, 3)};
        meet(&scene, &view, &options, hits);
        for (size_t k = 0; k < 2 * RAYS; k++) {
            const narc_ray_hit *const hit = &hits[k];
            const double motion_x = (double)rays[hit->ray].motion_x, motion_y = (double)rays[hit->ray].motion_y;
            const double nx = (double)hit->normal_x, ny = (double)hit->normal_y;
            if (!hit->count)
                fail_msg("trial %zu: a ray by (%a, %a) passes one", trial, motion_x, motion_y);
            assert_true(hit->fraction >= 0 && hit->fraction <= 2 && fabs(hypot(nx, ny) - 1) < 1e-6);
            assert_true(nx * motion_x + ny * motion_y < 1e-6 * hypot(motion_x, motion_y));
        }
    }
}

static int compare_directions(const void *a, const void *b) {
    const struct test_ray *const p = a, *const q = b;
    const double left = atan2((double)p->motion_y, (double)p->motion_x),
                 right = atan2((double)q->motion_y, (double)q->motion_x);
    return (left > right) - (left < right);
}

/* Rays of one origin past a corner, by next to nothing: as each of them alone. */
TEST(a_touch_counts_in_a_fan_as_alone) {
    struct test_random random = test_random_named("touches in fans");
    size_t hits = 0, misses = 0;
    for (size_t trial = 0; trial < test_trials(400); trial++) {
        AUTO(destroy_scene) struct scene scene = make_neighbours(&random);
        struct test_ray rays[RAYS];
        narc_ray_hit together[RAYS], alone;
        const double x = random_between(&random, -5, 5), y = random_between(&random, -5, 5);
        const struct body *const body = &scene.bodies[0];
        const double length = hypot((double)body->cosine, (double)body->sine),
                     reach = 0.5 * (double)body->scale / length;
        for (size_t k = 0; k < RAYS; k++) {
            const double along = k % 2 ? reach : -reach, up = k % 4 < 2 ? reach : -reach, off = 2e-7 / length;
            const double left = body->x + (double)body->cosine * along - (double)body->sine * up - x;
            const double high = body->y + (double)body->sine * along + (double)body->cosine * up - y;
            rays[k] = (struct test_ray){x, y, (float)(left + off * random_between(&random, -4, 4) * fabs(high)),
                                        (float)(high + off * random_between(&random, -4, 4) * fabs(left)), INFINITY};
        }
        qsort(rays, RAYS, sizeof *rays, compare_directions);
        const narc_ray_options options = {.inside = (narc_inside)random_below(&random, 3)};
        const narc_rays all = view_rays(rays, RAYS);
        meet(&scene, &all, &options, together);
        for (size_t k = 0; k < RAYS; k++) {
            const narc_rays one = view_rays(rays + k, 1);
            meet(&scene, &one, &options, &alone);
            alone.ray = (uint32_t)k;
            assert_memory_equal(&alone, &together[k], sizeof alone);
            hits += alone.count;
            misses += !alone.count;
        }
    }
    assert_true(hits > 0 && misses > 0);
}

/* Along a segment, in it or beside it by far less than the bound, a ray meets the end that comes first, against its
 * normal; from within it leaves by the other. */
TEST(meets_the_ends_of_segments) {
    struct test_random random = test_random_named("along segments");
    for (size_t trial = 0; trial < test_trials(1000); trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 1, 1, 1);
        const double angle = random_between(&random, -4, 4), turn = random_between(&random, -4, 4);
        const double half = random_log_between(&random, 0.1, 10), c = half * cos(turn), s = half * sin(turn);
        const double bound = NARC_ERROR_BOUND * half;
        const float x = (float)cos(angle + turn), y = (float)sin(angle + turn);
        const bool inside = trial % 3 == 0;
        const double start =
            inside ? random_between(&random, -0.9, 0.9) * half : -half - random_log_between(&random, 0.1, 10);
        const double beside = random_between(&random, -0.2, 0.2) * bound;
        const struct test_ray ray = {start * (double)x - beside * (double)y, start * (double)y + beside * (double)x, x,
                                     y, 100};
        const narc_rays view = view_rays(&ray, 1);
        struct shape shape;
        narc_ray_hit hit;
        narc_error error;
        expect_ok(narc_build_segment(&(narc_point){-c, -s}, &(narc_point){c, s}, 0, shape.arcs, &shape.count, &error),
                  &error);
        scene_add_shape(&scene, &shape);
        scene_add_body(&scene, turned_body(angle, 1));
        meet(&scene, &view, &(narc_ray_options){.inside = NARC_INSIDE_LEAVES}, &hit);
        const double side = inside ? 1 : -1;
        assert_int_equal(hit.count, 1);
        assert_true(fabs((double)hit.fraction - (side * half - start)) < 4 * bound);
        assert_true(fabs((double)hit.point_x - side * half * (double)x) < 4 * bound && hit.radius == 0);
        assert_true(side * (double)(hit.normal_x * x + hit.normal_y * y) > 1 - 1e-6);
    }
}

/* Fractions up to the largest float, of motions down to the smallest one. */
TEST(moves_by_the_least_and_the_most) {
    const float least = 0x1p-149f;
    const struct test_ray rays[] = {{-1 - 0x1p-20, 0, 4 * least, 0, INFINITY},
                                    {-1 - 0x1p-20, 0, least, 0, INFINITY}, /* beyond the largest fraction */
                                    {-5, 0, FLT_MAX, 0, INFINITY},
                                    {-5, 0.5, FLT_MAX, -least, 1},
                                    {-5, -5, FLT_MAX, FLT_MAX, INFINITY}};
    const narc_ray_hit *const hits = meet_two(0, rays, 5, (narc_ray_options){0});
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
    AUTO(narc_destroy_index_at) narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (int trial = 0; trial < 16; trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 1, 2, 1);
        struct body body = turned_body(0, 1);
        const struct shape box = box_of(2, 2, 0);
        narc_error error;
        size_t hits = 0;
        body.x = trial < 8 ? 0 : ldexp(1, 10 + 2 * (trial - 8)) + 1;
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
    }
}

TEST_MAIN("rays")
