/* SPDX-License-Identifier: MIT
 *
 * boxes.c - the boxes of bodies against the support function in double precision: never too small, and at most
 * NARC_BOX_ROOM too large; motion, sub-ranges, pieces of chains.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"
#include "placements.h"
#include "scene.h"
#include "store.h"
#include "turtle.h"

enum { SIDES = 4 };

/* A box's reach to the right, up, to the left and down. */
static void unfold(const narc_box *box, double reach[SIDES]) {
    reach[0] = (double)box->max_x;
    reach[1] = (double)box->max_y;
    reach[2] = -(double)box->min_x;
    reach[3] = -(double)box->min_y;
}

/* The furthest point of a list of arcs along a unit vector: of all ends of arcs, and where an arc holds the vector. */
static double find_support(const struct reference_body *body, double x, double y) {
    double furthest = -INFINITY;
    for (size_t k = 0; k < body->count; k++) {
        const narc_arc *const arc = &body->arcs[k];
        const double sweep = fmod(arc->end - arc->start + 8 * PI, 2 * PI);
        const double beyond = fmod(atan2(y, x) - arc->start + 16 * PI, 2 * PI);
        const double middle = arc->center_x * x + arc->center_y * y;
        const double along_start = cos(arc->start) * x + sin(arc->start) * y;
        const double along_end = cos(arc->end) * x + sin(arc->end) * y;
        const bool holds = body->count == 1 || beyond <= sweep;
        furthest = fmax(furthest, middle + arc->radius * (holds ? 1 : fmax(along_start, along_end)));
    }
    return furthest;
}

/* What the body reaches from its position, its rotation made a unit vector. */
static void find_reaches(const struct reference_body *body, double reach[SIDES]) {
    const double length = hypot(body->cosine, body->sine), c = body->cosine / length, s = body->sine / length;
    const double x[SIDES] = {c, s, -c, -s}, y[SIDES] = {-s, c, s, -c};
    for (int k = 0; k < SIDES; k++)
        reach[k] = body->scale * find_support(body, x[k], y[k]);
}

struct question {
    double margin, motion_x, motion_y;
    narc_point origin;
};

/* Differences of doubles are exact enough: their roundings are 2^-29 of those that are allowed. */
static void check_box(const struct reference_body *body, const struct question *asked, const narc_box *box) {
    double reach[SIDES], found[SIDES];
    const double x = body->x - asked->origin.x, y = body->y - asked->origin.y, at[SIDES] = {x, y, -x, -y};
    const double motion[SIDES] = {asked->motion_x, asked->motion_y, -asked->motion_x, -asked->motion_y};
    find_reaches(body, reach);
    unfold(box, found);
    for (int k = 0; k < SIDES; k++) {
        const double size = fabs(at[k]) + fabs(motion[k]) + asked->margin + reference_extent(body);
        const double excess = found[k] - at[k] - fmax(0, motion[k]) - (reach[k] + asked->margin);
        if (!(excess >= -0x1p-48 * size && excess <= NARC_BOX_ROOM * size))
            fail_msg("side %d of a body at (%.17g, %.17g), rotation (%.9g, %.9g), scale %.9g: %.9g, which is %g of "
                     "the room too large; %zu arcs",
                     k, body->x, body->y, body->cosine, body->sine, body->scale, found[k],
                     excess / (NARC_BOX_ROOM * size), body->count);
    }
}

static narc_box *compute(const struct scene *scene, const narc_box_options *options, unsigned threads) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_workers workers = openmp_workers(threads);
    narc_box_options all = options ? *options : (narc_box_options){0};
    narc_box *boxes = guard_allocate(bodies.count * sizeof *boxes);
    narc_error error;
    all.workers = &workers;
    expect_ok(narc_compute_boxes(scene->store, &bodies, &all, boxes, &error), &error);
    return boxes;
}

static void check_scene(const struct scene *scene, struct test_random *random) {
    const size_t count = scene->body_count;
    float(*const motion)[2] = malloc(count * sizeof *motion);
    assert_non_null(motion);
    for (size_t k = 0; k < count; k++) {
        const struct reference_body body = scene_reference(scene, (uint32_t)k);
        const double size = reference_extent(&body);
        for (int i = 0; i < 2; i++)
            motion[k][i] = (float)(random_below(random, 4) ? random_between(random, -2, 2) * size : 0);
    }
    AUTO(guard_release_at) narc_box *const still = compute(scene, NULL, 1);
    for (int round = 0; round < 8; round++) {
        size_t skipped = 7;
        const struct body *const near = &scene->bodies[random_below(random, count)];
        const bool away = random_below(random, 2);
        const narc_point origin = {near->x + (away ? random_between(random, -9, 9) : 0), near->y};
        narc_box_options options = {
            .origin = round & 4 ? &origin : NULL, .margin = round & 1 ? 0.125f : 0, .out_skipped = &skipped};
        if (round & 2)
            options.motion_x = (narc_float_column){&motion[0][0], sizeof motion[0]};
        if ((round & 3) == 2) /* either may be alone */
            options.motion_y = (narc_float_column){&motion[0][1], sizeof motion[0]};
        AUTO(guard_release_at) narc_box *const boxes = compute(scene, &options, 1 + (unsigned)round);
        assert_int_equal(skipped, 0);
        for (size_t k = 0; k < count; k++) {
            const struct reference_body body = scene_reference(scene, (uint32_t)k);
            const struct question asked = {(double)options.margin, round & 2 ? (double)motion[k][0] : 0,
                                           (round & 3) == 2 ? (double)motion[k][1] : 0,
                                           round & 4 ? origin : (narc_point){0, 0}};
            check_box(&body, &asked, &boxes[k]);
        }
        if (round == 0)
            assert_memory_equal(boxes, still, count * sizeof *boxes);
    }
    free(motion);
}

/* Every family, in every placement: right angles, nearly right ones, far away, tiny and huge scales. */
TEST(holds_every_shape) {
    struct test_random random = test_random_named("boxes");
    enum { PLACES = 8 };
    for (int precision = 0; precision < 2; precision++) {
        for (enum family family = 0; family < FAMILY_COUNT; family++) {
            const size_t trials = test_trials(12);
            AUTO(destroy_scene)
            struct scene scene = create_scene((narc_precision)precision, trials, 2 * PLACES * trials, 1);
            for (size_t trial = 0; trial < trials; trial++) {
                const struct shape shape = make_shape(&random, family);
                const uint32_t index = scene_add_shape(&scene, &shape);
                for (size_t k = 0; k < PLACES; k++) {
                    struct body a, b;
                    place_pair(&random, (enum placement)random_below(&random, PLACE_COUNT), scene.precision, &shape,
                               &shape, &a, &b);
                    a.shape = b.shape = index;
                    scene_add_body(&scene, a);
                    scene_add_body(&scene, b);
                }
            }
            check_scene(&scene, &random);
        }
    }
}

/* Junctions along the world's axes, within some units of the look-up's 16 bits, and arcs that are no wider than one. */
TEST(holds_shapes_with_junctions_along_the_axes) {
    struct test_random random = test_random_named("junctions along axes");
    const double quarter = 1.57079632679489661923;
    const size_t trials = test_trials(400);
    struct scene scene = create_scene(NARC_FLOAT32, trials, 8 * trials, 1);
    for (size_t trial = 0; trial < trials; trial++) {
        const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        const uint32_t index = scene_add_shape(&scene, &shape);
        for (int k = 0; k < 8; k++) {
            const narc_arc *const arc = &shape.arcs[random_below(&random, shape.count)];
            const double off = k < 2 ? 0 : random_between(&random, -1, 1) * (k < 5 ? 1e-7 : 3e-4);
            struct body body =
                turned_body((double)random_below(&random, 4) * quarter - arc->start + off, k % 2 ? 1 : 0.37);
            body.x = random_between(&random, -2, 2);
            body.shape = index;
            scene_add_body(&scene, body);
        }
    }
    check_scene(&scene, &random);
    destroy_scene(&scene);
    /* Corners that are nearly straight: many junctions within a unit of one another, with edges between them. */
    scene = create_scene(NARC_FLOAT32, trials, 8 * trials, 1);
    for (size_t trial = 0; trial < trials; trial++) {
        struct shape shape;
        const double step = random_log_between(&random, 2e-5, 4e-4), from = (double)random_below(&random, 4) * quarter;
        narc_point points[12];
        double angle = from - 4.5 * step, x = 0, y = 0;
        for (size_t k = 0; k < 10; k++) {
            points[k] = (narc_point){x, y};
            x -= sin(angle);
            y += cos(angle);
            angle += step;
        }
        points[10] = (narc_point){x, y};
        points[11] = (narc_point){-4 * cos(from) - 5 * sin(from), -4 * sin(from) + 5 * cos(from)};
        assert_int_equal(narc_build_polygon(points, 12, 0, shape.arcs, &shape.count, NULL), NARC_OK);
        const uint32_t index = scene_add_shape(&scene, &shape);
        for (int k = 0; k < 8; k++) {
            struct body body = turned_body((double)(k % 4) * quarter + random_between(&random, -3, 3) * step, 1);
            body.shape = index;
            scene_add_body(&scene, body);
        }
    }
    check_scene(&scene, &random);
    destroy_scene(&scene);
}

/* Positions at which a body is less than a rounding, and positions that cancel its extent. */
TEST(rounds_outwards_wherever_a_body_is) {
    struct test_random random = test_random_named("rounding");
    for (int precision = 0; precision < 2; precision++) {
        const size_t trials = test_trials(200);
        AUTO(destroy_scene)
        struct scene scene = create_scene((narc_precision)precision, FAMILY_COUNT, FAMILY_COUNT * trials, 1);
        for (enum family family = 0; family < FAMILY_COUNT; family++) {
            const struct shape shape = make_shape(&random, family);
            const uint32_t index = scene_add_shape(&scene, &shape);
            for (size_t trial = 0; trial < trials; trial++) {
                struct body body =
                    turned_body(random_between(&random, -10, 10), random_log_between(&random, 1e-5, 1e5));
                const struct reference_body reference = pose_shape(&shape, &body);
                double reach[SIDES];
                find_reaches(&reference, reach);
                const bool cancels = trial % 2;
                const double far = random_log_between(&random, 1e-30, 1e30);
                body.x = cancels ? -reach[0] * (1 + random_between(&random, -1, 1) * 1e-7) : far;
                body.y = cancels ? reach[3] * (1 + random_between(&random, -1, 1) * 1e-9) : -far;
                body.shape = index;
                round_position(&body, scene.precision);
                scene_add_body(&scene, body);
            }
        }
        check_scene(&scene, &random);
    }
}

/* ------------------------------------------------------------------------------------------------ pieces of chains */

/* What a body of a front reaches, seen at many of its points: of the stored arcs, all of a concave one, of a run arcs
 * 1 .. count - 6 and the points of the corners beside them; and as far behind these, against all of their normals, as
 * contacts may be told of (thin_ground.c shows that this is far enough). */
static void find_front_reaches(const narc_shapes *shapes, const narc_body *body, double reach[SIDES],
                               double *out_extent) {
    enum { STEPS = 1000 };
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(shapes, body->shape, arcs);
    const double length = hypot((double)body->cosine, (double)body->sine), scale = (double)body->scale;
    const double c = (double)body->cosine / length, s = (double)body->sine / length;
    const narc_shape_header *const header = &shapes->headers[body->shape];
    const double depth = (double)narc_arcs_of(shapes, header)[count].solid.depth;
    *out_extent = 0;
    for (int side = 0; side < SIDES; side++)
        reach[side] = -INFINITY;
    for (size_t k = 0; k < (count > 1 ? count - 4 : 1); k++) {
        const double turn = remainder(arcs[k].end - arcs[k].start, 2 * PI);
        *out_extent =
            fmax(*out_extent, scale * (hypot(arcs[k].center_x, arcs[k].center_y) + fabs(arcs[k].radius) + depth));
        for (int step = 0; step <= 2 * STEPS + 1; step++) {
            const double angle = arcs[k].start + turn * (step / 2) / STEPS;
            const double radius = arcs[k].radius - (step % 2 ? depth : 0);
            const double x = scale * (arcs[k].center_x + radius * cos(angle));
            const double y = scale * (arcs[k].center_y + radius * sin(angle));
            const double own[SIDES] = {c * x - s * y, s * x + c * y, s * y - c * x, -s * x - c * y};
            for (int side = 0; side < SIDES; side++)
                reach[side] = fmax(reach[side], own[side]);
        }
    }
}

/* Bodies of pieces among others have the box of their front and what is behind it. */
TEST(holds_fronts_of_chains) {
    struct test_random random = test_random_named("fronts");
    enum { BODIES = 300, ENTRIES = 200 };
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        AUTO(free_at) struct turtle t = walk_ground(&random, 1 + random_below(&random, 30), 1.2);
        narc_chain_entry entries[ENTRIES];
        narc_body rows[BODIES];
        size_t count;
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
        uint32_t plain;
        assert_int_equal(narc_create_shapes(&guard_allocator, &shapes), NARC_OK);
        const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        assert_int_equal(narc_add_shape(shapes, shape.arcs, shape.count, &plain, NULL), NARC_OK);
        AUTO(guard_release_at) narc_box *const without = guard_allocate(BODIES * sizeof *without);
        AUTO(guard_release_at) narc_box *const boxes = guard_allocate(BODIES * sizeof *boxes);
        for (size_t k = 0; k < BODIES; k++)
            rows[k] = (narc_body){random_between(&random, -9, 9),
                                  random_between(&random, -9, 9),
                                  0,
                                  0,
                                  (float)random_log_between(&random, 0.1, 10),
                                  plain};
        for (size_t k = 0; k < BODIES; k++) {
            const double angle = random_below(&random, 4) ? random_between(&random, 0, 7) : 0;
            rows[k].cosine = (float)cos(angle);
            rows[k].sine = (float)sin(angle);
        }
        narc_bodies bodies;
        narc_view_bodies(rows, BODIES, &bodies);
        assert_int_equal(narc_compute_boxes(shapes, &bodies, NULL, without, NULL), NARC_OK);
        assert_int_equal(narc_add_chain(shapes, t.arcs, t.count, NULL, entries, ENTRIES, &count, NULL), NARC_OK);
        for (size_t k = 0; k < BODIES; k++)
            if (random_below(&random, 3))
                rows[k].shape = entries[random_below(&random, count)].shape;
        test_use_isa("scalar");
        AUTO(guard_release_at) narc_box *const scalar = guard_allocate(BODIES * sizeof *scalar);
        assert_int_equal(narc_compute_boxes(shapes, &bodies, NULL, scalar, NULL), NARC_OK);
        test_use_isa(test_isa());
        assert_int_equal(narc_compute_boxes(shapes, &bodies, NULL, boxes, NULL), NARC_OK);
        assert_memory_equal(boxes, scalar, BODIES * sizeof *boxes);
        for (size_t k = 0; k < BODIES; k++) {
            double reach[SIDES], found[SIDES], extent;
            if (rows[k].shape == plain) {
                assert_memory_equal(&boxes[k], &without[k], sizeof *boxes);
                continue;
            }
            find_front_reaches(shapes, &rows[k], reach, &extent);
            unfold(&boxes[k], found);
            const double at[SIDES] = {rows[k].x, rows[k].y, -rows[k].x, -rows[k].y};
            for (int side = 0; side < SIDES; side++) {
                const double excess = found[side] - at[side] - reach[side];
                const double unseen = 0x1p-20 * extent; /* 3 rad in 1000 steps: a sagitta of 1e-6, of depths */
                if (!(excess >= -0x1p-40 * extent &&
                      excess <= NARC_BOX_ROOM * (fabs(at[side]) + extent) + unseen + 0x1p-70))
                    fail_msg("side %d of a front: %g too large, of %g", side, excess, extent);
            }
        }
    }
}

/* Shapes with two arcs, or one, beside one with most: their angles are read as if they had as many. Nothing behind the
 * store's memory is. */
TEST(reads_no_further_than_the_store) {
    for (int concave = 0; concave < 2; concave++) {
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
        narc_arc arcs[NARC_MAX_ARCS];
        narc_body rows[32];
        narc_box boxes[32];
        size_t count;
        assert_int_equal(narc_create_shapes(&guard_allocator, &shapes), NARC_OK);
        assert_int_equal(narc_build_regular_polygon(64, 1, 0, arcs, &count, NULL), NARC_OK);
        assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
        uint32_t last = 0;
        for (int k = 0; shapes->record_count < 2 * 71 - 3 * (size_t)concave; k++) { /* doubled when it was full */
            assert_int_equal(narc_build_box(2, 3 + k, 0, arcs, &count, NULL), NARC_OK);
            if (k > 0)
                assert_int_equal(narc_build_circle(k, arcs, &count, NULL), NARC_OK);
            assert_int_equal(narc_add_shape(shapes, arcs, count, &last, NULL), NARC_OK);
        }
        if (concave) {
            const narc_arc valley = {0, 0, -1, 1, 0};
            narc_chain_entry entry;
            assert_int_equal(narc_add_chain(shapes, &valley, 1, NULL, &entry, 1, &count, NULL), NARC_OK);
            last = entry.shape;
        }
        assert_int_equal(shapes->record_count, shapes->record_capacity);
        for (size_t k = 0; k < 32; k++)
            rows[k] = (narc_body){0, 0, 1, 0, 1, k % 2 ? last : 0};
        narc_bodies bodies;
        narc_view_bodies(rows, 32, &bodies);
        assert_int_equal(narc_compute_boxes(shapes, &bodies, NULL, boxes, NULL), NARC_OK);
    }
}

/* ------------------------------------------------------------------------------------------------ splits */

/* Sub-ranges touch nothing but their own and count what is broken there; scalar in one call decides. */
TEST(same_bits_whatever_the_split) {
    enum { MOST = 2200 };
    struct test_random random = test_random_named("splits");
    for (int precision = 0; precision < 2; precision++) {
        AUTO(destroy_scene) struct scene scene = make_random_scene(&random, (narc_precision)precision, MOST, 1);
        scene.bodies[1].sine = 3;
        test_use_isa("scalar");
        AUTO(guard_release_at) narc_box *const right = compute(&scene, &(narc_box_options){.margin = 0.01f}, 1);
        test_use_isa(test_isa());
        for (size_t count = 1; count <= MOST; count += count < 70 ? 1 : 71) {
            AUTO(guard_release_at) narc_box *const boxes = guard_allocate(count * sizeof *boxes);
            const size_t first = random_below(&random, count), rest = count - first;
            const narc_workers workers = openmp_workers((unsigned)random_below(&random, 5));
            size_t skipped = 99;
            const narc_box_options options = {.margin = 0.01f,
                                              .out_skipped = &skipped,
                                              .first = first,
                                              .count = random_below(&random, rest + 1),
                                              .workers = &workers};
            const size_t part = options.count ? options.count : rest;
            scene.body_count = count;
            const narc_bodies bodies = scene_bodies(&scene);
            expect_ok(narc_compute_boxes(scene.store, &bodies, &options, boxes, NULL), NULL);
            assert_int_equal(skipped, first <= 1 && first + part > 1);
            assert_true(is_junk(boxes, first * sizeof *boxes));
            assert_memory_equal(boxes + first, right + first, part * sizeof *boxes);
            assert_true(is_junk(boxes + first + part, (count - first - part) * sizeof *boxes));
        }
        scene.body_count = MOST;
    }
}

TEST_MAIN("boxes")
