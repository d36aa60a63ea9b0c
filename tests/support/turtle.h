/* SPDX-License-Identifier: MIT
 *
 * turtle.h - chains by walking: each step goes on where the last one ended, with its normal.
 */
#ifndef NARC_TEST_TURTLE_H
#define NARC_TEST_TURTLE_H

#include <math.h>
#include <stdlib.h>

#include "narc_chains.h"
#include "support.h"

#define TEST_PI PI

struct turtle {
    narc_arc *arcs;
    size_t count, capacity;
    double x, y, normal; /* where it is, and the angle of the normal, to the right of its way */
};

/* An open chain or a closed one: the caller's arcs. */
struct chain {
    narc_arc *arcs;
    size_t count;
    bool closed;
};

static inline struct turtle create_turtle(double x, double y, double normal) {
    return (struct turtle){.x = x, .y = y, .normal = normal};
}

/* An arc that turns by `turn`, clockwise and concave if that is below 0; radius 0: a corner or a valley's bottom, and
 * with turn 0 a plain point. */
static inline void walk_arc(struct turtle *t, double radius, double turn) {
    if (t->count == t->capacity) {
        t->capacity = 2 * t->capacity + 64;
        t->arcs = realloc(t->arcs, t->capacity * sizeof *t->arcs);
        assert_non_null(t->arcs);
    }
    const double own = turn < 0 ? -radius : radius;
    const double x = t->x - own * cos(t->normal), y = t->y - own * sin(t->normal);
    t->arcs[t->count++] = (narc_arc){x, y, own, t->normal, t->normal + turn};
    t->normal += turn;
    t->x = x + own * cos(t->normal);
    t->y = y + own * sin(t->normal);
}

static inline void walk_line(struct turtle *t, double length) {
    t->x -= length * sin(t->normal);
    t->y += length * cos(t->normal);
}

/* The arcs are the caller's to free. */
static inline struct chain end_walk(const struct turtle *t, bool closed) {
    return (struct chain){t->arcs, t->count, closed};
}

/* Ground from right to left that never crosses itself: normals stay within `steep` of +y. Arcs and corners both ways,
 * with and without edges between them, and plain points. */
static inline struct turtle walk_ground(struct test_random *random, size_t steps, double steep) {
    struct turtle t = create_turtle(random_between(random, -5, 5), random_between(random, -5, 5),
                                    TEST_PI / 2 + random_between(random, -steep, steep));
    if (random_below(random, 2)) {
        walk_arc(&t, 0, 0);
        walk_line(&t, 1);
    }
    for (size_t k = 0; k < steps; k++) {
        const double to = TEST_PI / 2 + random_between(random, -steep, steep), turn = to - t.normal;
        const size_t kind = random_below(random, 6);
        if (kind == 0 && k > 0)
            walk_arc(&t, 0, 0);
        else if (fabs(turn) > 0.05)
            walk_arc(&t, kind < 3 ? 0 : random_log_between(random, 0.1, 4), turn);
        if (random_below(random, 4) || kind < 3) /* corners have edges beside them */
            walk_line(&t, random_log_between(random, 0.1, 9));
    }
    walk_line(&t, 0.5);
    walk_arc(&t, 0, 0);
    return t;
}

/* A closed ring of rounded teeth, each turned by an equal share of the whole turn: so it closes. */
static inline struct turtle walk_gear(size_t teeth, double depth) {
    struct turtle t = create_turtle(1, 0, 0);
    const double share = 2 * TEST_PI / (double)teeth;
    for (size_t k = 0; k < teeth; k++) {
        walk_arc(&t, 0.5, 0.7 + share);
        walk_line(&t, depth);
        walk_arc(&t, 0.25, -1.4);
        walk_line(&t, depth);
        walk_arc(&t, 0.5, 0.7);
    }
    return t;
}

#endif
