/* SPDX-License-Identifier: MIT
 *
 * walker.c - a character on stairs, in corners, under a slope, on slopes, on a moving platform: it gets where it can get,
 * stays out of what is in its way, and does not creep into it.
 */
#include "walker.h"

#include <math.h>
#include <stdlib.h>

#include <narc_broad_phase.h>

#include "support.h"

enum { MOST = 32 };
static const double height = 1.2, radius = 0.3; /* of the capsule that walks */

typedef struct stage {
    walker_scene scene;
    narc_shapes *store;
    narc_body bodies[MOST];
    size_t count;
    narc_bodies view;
    walker who;
} stage;

static uint32_t store_of(stage *s, const narc_arc *arcs, size_t count) {
    uint32_t shape;
    assert_int_equal(narc_add_shape(s->store, arcs, count, &shape, NULL), NARC_OK);
    return shape;
}

static void add_box(stage *s, double width, double tall, double x, double y, double angle) {
    narc_arc arcs[4];
    size_t count;
    assert_int_equal(narc_build_box(width, tall, 0, arcs, &count, NULL), NARC_OK);
    s->bodies[s->count++] = (narc_body){x, y, (float)cos(angle), (float)sin(angle), 1, store_of(s, arcs, count)};
}

/* A floor, and who stands above it. */
static stage *begin_stage(double x, double y) {
    stage *const s = calloc(1, sizeof *s);
    narc_arc arcs[4];
    size_t count;
    assert_non_null(s);
    assert_int_equal(narc_create_shapes(NULL, &s->store), NARC_OK);
    assert_int_equal(narc_create_index(NULL, &s->scene.index), NARC_OK);
    add_box(s, 100, 2, 0, -1, 0);
    assert_int_equal(narc_build_capsule(height - 2 * radius, radius, arcs, &count, NULL), NARC_OK);
    s->who = (walker){{x, y, 0, 1, 1, store_of(s, arcs, count)}, 0.01f, 0.2f, 0.7f, UINT32_MAX};
    return s;
}

static void end_stage(stage *s) {
    narc_destroy_index(s->scene.index);
    narc_destroy_shapes(s->store);
    free(s);
}

/* The index of where the bodies are now. */
static void place(stage *s) {
    narc_box boxes[MOST];
    narc_view_bodies(s->bodies, s->count, &s->view);
    const narc_box_options from = {.origin = s->scene.origin};
    assert_int_equal(narc_compute_boxes(s->store, &s->view, &from, boxes, NULL), NARC_OK);
    const narc_index_options options = {.origin = s->scene.origin};
    assert_int_equal(narc_build_index(s->scene.index, boxes, s->count, &options, NULL), NARC_OK);
    s->scene.shapes = s->store;
    s->scene.bodies = &s->view;
}

/* How far it is from the nearest body. */
static double find_distance(const stage *s) {
    double least = INFINITY;
    for (size_t k = 0; k < s->count; k++) {
        narc_contact row;
        narc_error error;
        assert_int_equal(
            narc_find_contact(s->store, &s->who.body, &s->bodies[k], &(narc_query){.margin = INFINITY}, &row, &error),
            NARC_OK);
        least = fmin(least, (double)row.separation);
    }
    return least;
}

/* So many steps; it falls where it does not stand. */
static void walk(stage *s, int steps, double x) {
    for (int k = 0; k < steps; k++) {
        assert_int_equal(s->who.stands_on == UINT32_MAX ? walker_move(&s->who, &s->scene, x, 0, NULL)
                                                        : walker_step(&s->who, &s->scene, x, NULL),
                         NARC_OK);
        if (s->who.stands_on == UINT32_MAX)
            assert_int_equal(walker_fall(&s->who, &s->scene, 0.1, NULL), NARC_OK);
        if (!(find_distance(s) > 0.5 * (double)s->who.skin))
            fail_msg("step %d: at %g %g, %g from something", k, s->who.body.x, s->who.body.y, find_distance(s));
    }
}

static bool is_at(const stage *s, double x, double y) {
    return fabs(s->who.body.x - x) < 0.02 && fabs(s->who.body.y - y) < 0.02;
}

static const double standing = 0.6 + 0.01; /* the height of its middle above what it stands on */

/* The nearest place that planes leave: no sample is nearer. */
TEST(test_clip) {
    struct test_random random = test_random_named("clipped motions");
    size_t clipped = 0;
    for (size_t trial = 0; trial < test_trials(2000); trial++) {
        walker_plane planes[6];
        const size_t count = 1 + random_below(&random, 6);
        const double wanted_x = random_between(&random, -2, 2), wanted_y = random_between(&random, -2, 2);
        double x = wanted_x, y = wanted_y;
        for (size_t k = 0; k < count; k++) {
            const double angle = random_between(&random, -4, 4);
            planes[k] = (walker_plane){cos(angle), sin(angle), random_between(&random, 0, 1)};
        }
        walker_clip(planes, count, &x, &y);
        const double away = hypot(x - wanted_x, y - wanted_y);
        clipped += away > 0;
        for (size_t k = 0; k < count; k++)
            assert_true(planes[k].x * x + planes[k].y * y <= planes[k].room + 1e-6);
        for (int sample = 0; sample < 200; sample++) {
            const double at_x = wanted_x + random_between(&random, -away, away),
                         at_y = wanted_y + random_between(&random, -away, away);
            bool free = true;
            for (size_t k = 0; k < count; k++)
                free = free && planes[k].x * at_x + planes[k].y * at_y <= planes[k].room;
            assert_true(!free || hypot(at_x - wanted_x, at_y - wanted_y) >= away - 1e-6);
        }
    }
    assert_true(clipped > 0);
}

/* Up ten stairs, and down again. */
TEST(test_stairs) {
    stage *const s = begin_stage(-2, standing);
    for (int k = 0; k < 10; k++)
        add_box(s, 0.5, 4, 0.5 * k + 0.25, 0.15 * (k + 1) - 2, 0);
    add_box(s, 10, 4, 10, 1.5 - 2, 0);
    place(s);
    walk(s, 200, 0.05);
    if (!(s->who.body.x > 5.5 && fabs(s->who.body.y - 1.5 - standing) < 0.02))
        fail_msg("it got to %g %g", s->who.body.x, s->who.body.y);
    walk(s, 300, -0.05);
    assert_true(s->who.body.x < -1 && fabs(s->who.body.y - standing) < 0.02 && s->who.stands_on == 0);
    end_stage(s);
}

/* Against a wall, in a corner, and away from there. A step that is too high is a wall. */
TEST(test_corner) {
    stage *const s = begin_stage(0, standing);
    add_box(s, 2, 10, 3, 5, 0);
    add_box(s, 2, 0.8, -3, 0.4, 0);
    place(s);
    walk(s, 1000, 0.05);
    assert_true(is_at(s, 2 - radius - 0.01, standing));
    walk(s, 1000, -0.05);
    assert_true(is_at(s, -2 + radius + 0.01, standing));
    walk(s, 10, 0.05);
    assert_true(is_at(s, -2 + radius + 0.01 + 0.5, standing));
    end_stage(s);
}

/* So many walls in one place, and far from (0, 0): each is met, none ends the walk. */
TEST(test_many_walls_far_away) {
    const narc_point origin = {1e8, 3e8};
    stage *const s = begin_stage(0, standing);
    for (int k = 0; k < 25; k++)
        add_box(s, 2, 10, 3, 5, 0);
    add_box(s, 2, 10, -3, 5, 0);
    s->scene.origin = &origin;
    s->who.body.x += origin.x, s->who.body.y += origin.y;
    for (size_t k = 0; k < s->count; k++)
        s->bodies[k].x += origin.x, s->bodies[k].y += origin.y;
    place(s);
    walk(s, 60, 0.05);
    assert_true(is_at(s, origin.x + 2 - radius - 0.01, origin.y + standing));
    walk(s, 100, -0.05);
    assert_true(is_at(s, origin.x - 2 + radius + 0.01, origin.y + standing));
    end_stage(s);
}

/* Where a slope comes down it can't go on, nor is it pressed into floor or slope. */
TEST(test_under_a_slope) {
    for (double angle = 0.1; angle < 1.3; angle += 0.1) {
        stage *const s = begin_stage(-3, standing);
        add_box(s, 60, 2, sin(angle), 2 + cos(angle), -angle);
        place(s);
        walk(s, 1000, 0.05);
        const double stopped = s->who.body.x;
        walk(s, 1000, 0.05);
        if (!(fabs(s->who.body.x - stopped) < 1e-3 && fabs(s->who.body.y - standing) < 0.02))
            fail_msg("%g: from %g to %g %g", angle, stopped, s->who.body.x, s->who.body.y);
        assert_true(find_distance(s) < 0.02);
        walk(s, 10, -0.05);
        assert_true(fabs(s->who.body.x - (stopped - 0.5)) < 0.01);
        end_stage(s);
    }
}

/* It walks up slopes and stands on them, and slides from those that are too steep. */
TEST(test_slopes) {
    for (double angle = 0.1; angle < 1.3; angle += 0.2) {
        stage *const s = begin_stage(0, 4);
        add_box(s, 20, 2, 0, 0, angle);
        place(s);
        const bool steep = cos(angle) < 0.7;
        walk(s, 200, 0);
        const double from = s->who.body.x;
        walk(s, 100, 0);
        if (steep ? s->who.stands_on == 1 : fabs(s->who.body.x - from) > 1e-6 || s->who.stands_on != 1)
            fail_msg("%g: from %g to %g %g, on %u", angle, from, s->who.body.x, s->who.body.y, s->who.stands_on);
        walk(s, 40, 0.02);
        assert_true(steep || s->who.body.x > from + 0.3);
        end_stage(s);
    }
}

/* On a platform it goes where that goes, and is held by a wall there. */
TEST(test_moving_platform) {
    stage *const s = begin_stage(0, 1.5 + standing);
    add_box(s, 4, 0.5, 0, 1.25, 0);
    add_box(s, 1, 10, 4, 5, 0);
    place(s);
    walk(s, 10, 0);
    assert_int_equal(s->who.stands_on, 1);
    for (int k = 0; k < 85; k++) {
        const double x = k < 50 ? 0.05 : 0.06, y = k < 50 ? 0.02 : -0.03;
        narc_body *const platform = &s->bodies[s->who.stands_on];
        assert_int_equal(s->who.stands_on, 1);
        platform->x += x;
        platform->y += y;
        s->who.body.y += y > 0 ? y : 0; /* what it stands on has moved into it */
        place(s);
        walk(s, 1, x);
        const double expected = fmin(k < 50 ? 0.05 * (k + 1) : 2.5 + 0.06 * (k - 49), 3.5 - radius - 0.01);
        if (!is_at(s, expected, platform->y + 0.25 + standing))
            fail_msg("step %d: at %g %g", k, s->who.body.x, s->who.body.y);
    }
    end_stage(s);
}

/* What is a little in the floor and the wall comes out of both as it walks. */
TEST(test_comes_out) {
    stage *const s = begin_stage(2 - radius + 0.003, 0.6 - 0.004);
    add_box(s, 2, 10, 3, 5, 0);
    place(s);
    assert_int_equal(walker_move(&s->who, &s->scene, -0.1, 0, NULL), NARC_OK);
    walk(s, 10, -0.05);
    assert_true(is_at(s, 2 - radius + 0.003 - 0.6, standing));
    end_stage(s);
}

TEST_MAIN("walker")
