/* SPDX-License-Identifier: MIT
 *
 * chain_scenes.c - what a scene is asked besides contacts, of ground: times of impact and distances of points, against
 * the definition: a place of a body's outline, sampled densely, is beyond a concave arc if it is further from the centre
 * than its radius, in its sector.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "expect.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "scene.h"

enum { SAMPLES = 4000, TIMES = 200 };

/* A bowl of one arc about the origin, from the angle `low` to `high` as seen from its centre. */
struct bowl {
    double radius, low, high;
    narc_chain_entry entry;
};

static struct bowl add_bowl(narc_shapes *store, double radius, double low, double high) {
    struct bowl bowl = {.radius = radius, .low = low, .high = high};
    const narc_arc arc = {0, 0, -radius, high + NARC_PI, low + NARC_PI}; /* clockwise */
    size_t count = 0;
    narc_error error;
    expect_ok(narc_add_chain(store, &arc, 1, NULL, &bowl.entry, 1, &count, &error), &error);
    assert_int_equal(count, 1);
    return bowl;
}

/* A body at a time of its motion. */
struct way {
    const struct shape *shape;
    struct body body;
    float motion_x, motion_y, angle;
};

static struct reference_body place(const struct way *way, double time) {
    struct reference_body placed = pose_shape(way->shape, &way->body);
    const double c = cos(time * (double)way->angle), s = sin(time * (double)way->angle), cosine = placed.cosine;
    placed.x += time * (double)way->motion_x;
    placed.y += time * (double)way->motion_y;
    placed.cosine = c * cosine - s * placed.sine;
    placed.sine = c * placed.sine + s * cosine;
    return placed;
}

/* The place of the outline that is furthest in a direction of the body's own axes, in the world. */
static narc_point find_support(const struct reference_body *body, double angle) {
    const double n_x = cos(angle), n_y = sin(angle);
    double most = -INFINITY, x = 0, y = 0;
    for (size_t k = 0; k < body->count; k++) {
        const narc_arc *const arc = &body->arcs[k];
        const double reach = arc->center_x * n_x + arc->center_y * n_y + arc->radius;
        if (reach > most) {
            most = reach;
            x = body->scale * (arc->center_x + arc->radius * n_x);
            y = body->scale * (arc->center_y + arc->radius * n_y);
        }
    }
    return (narc_point){body->x + body->cosine * x - body->sine * y, body->y + body->sine * x + body->cosine * y};
}

static bool holds(const struct bowl *bowl, double x, double y) {
    const double angle = atan2(y, x);
    return remainder(angle - bowl->low, 2 * NARC_PI) >= 0 && remainder(bowl->high - angle, 2 * NARC_PI) >= 0;
}

/* How far the outline is beyond the bowl, at most; -infinity if none of it is in the sector. */
static double find_depth(const struct reference_body *body, const struct bowl *bowl) {
    double most = -INFINITY;
    for (int k = 0; k < SAMPLES; k++) {
        const narc_point p = find_support(body, 2 * NARC_PI * k / SAMPLES);
        if (holds(bowl, p.x, p.y))
            most = fmax(most, hypot(p.x, p.y) - bowl->radius);
    }
    return most;
}

/* How near the ends of the bowl are to a body, at least; negative within it. */
static double find_ends(const struct reference_body *body, const struct bowl *bowl) {
    double least = INFINITY;
    for (int end = 0; end < 2; end++) {
        const double angle = end ? bowl->high : bowl->low;
        least = fmin(least, reference_point_distance(body, bowl->radius * cos(angle) - body->x,
                                                     bowl->radius * sin(angle) - body->y));
    }
    return least;
}

/* ------------------------------------------------------------------------------------------------ casts */

static struct way make_way(struct test_random *random, const struct shape *shape, bool turns) {
    struct way way = {.shape = shape, .body = turned_body(random_between(random, -3, 3), random_between(random, 0.3, 1.5))};
    way.body.x = random_between(random, -1.5, 1.5);
    way.body.y = random_between(random, -1.5, 1.5);
    round_position(&way.body, NARC_FLOAT64);
    way.motion_x = (float)random_between(random, -9, 9);
    way.motion_y = (float)random_between(random, -9, 9);
    way.angle = turns ? (float)random_between(random, -2, 2) : 0;
    return way;
}

/* The ground is the only body of its set, and A or B of the pair. */
static narc_impact cast(narc_shapes *store, const struct bowl *bowl, const struct way *way, bool ground_first) {
    const double zero = 0;
    const float one = 1, nothing = 0;
    const narc_bodies ground = {.count = 1,
                                .x = NARC_POSITIONS(&bowl->entry.x, 0),
                                .y = NARC_POSITIONS(&bowl->entry.y, 0),
                                .cosine = {&one, 0},
                                .sine = {&nothing, 0},
                                .shape = {&bowl->entry.shape, 0}};
    (void)zero;
    const narc_bodies body = narc_view_bodies(&way->body, 1);
    const narc_motions motion = {.x = {&way->motion_x, 0}, .y = {&way->motion_y, 0}, .angle = {&way->angle, 0}};
    const narc_pairs pairs = {.count = 1, .other_bodies = ground_first ? &body : &ground};
    narc_impact row;
    narc_error error;
    expect_ok(narc_cast_pairs(store, ground_first ? &ground : &body, ground_first ? NULL : &motion, &pairs,
                              ground_first ? &motion : NULL, NULL, &row, 1, &error),
              &error);
    return row;
}
