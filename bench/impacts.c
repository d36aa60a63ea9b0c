/* SPDX-License-Identifier: MIT
 *
 * impacts.c - casts: pairs of bodies that fly at each other, with and without turning, in batches and one by one.
 */
#include <math.h>
#include <string.h>

#include "common.h"
#include "random.h"
#include "rows.h"

enum { PAIRS = 10000, POINTS = 8 };

struct flights {
    narc_shapes *shapes;
    struct outline polygon; /* stands for the shape in Box2D */
    narc_body *bodies;
    narc_motion *motions;
    narc_impact *impacts;
    float *fractions;
    size_t count;
    bool turning;
};

/* "squares", "slabs", "gons8", "n8". */
static void add_shape(struct flights *f, const char *name) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const bool boxes = name[0] == 's', slabs = boxes && name[1] == 'l', gons = name[0] == 'g';
    const double width = slabs ? 2 : 1.4, height = slabs ? 0.25 : 1.4;
    f->polygon.count = boxes ? 4 : POINTS;
    for (int k = 0; k < (int)f->polygon.count; k++) {
        struct arc *at = &f->polygon.arcs[k];
        at->x = !boxes ? cos(2 * pi * k / POINTS) : k == 0 || k == 3 ? -width / 2 : width / 2;
        at->y = !boxes ? (gons ? 1 : 0.6) * sin(2 * pi * k / POINTS) : k < 2 ? -height / 2 : height / 2;
    }
    must(boxes  ? narc_build_box(width, height, 0, arcs, &count, NULL)
         : gons ? narc_build_regular_polygon(POINTS, 1, 0, arcs, &count, NULL)
                : narc_build_ellipse(1, 0.6, POINTS, arcs, &count, NULL, NULL),
         NULL);
    must(narc_create_shapes(NULL, &f->shapes), NULL);
    must(narc_add_shape(f->shapes, arcs, count, NULL, NULL), NULL);
}

/* B is 2 to 4 away from A; both fly up to 4 roughly at each other. */
static void make_flights(struct flights *f, double turning) {
    uint64_t random = 99;
    double direction = 0, distance = 0;
    f->turning = turning > 0;
    for (size_t k = 0; k < 2 * f->count; k++) {
        const bool is_b = k % 2;
        if (!is_b) {
            direction = random_between(&random, -pi, pi);
            distance = random_between(&random, 2, 4);
        }
        const double angle = random_between(&random, -pi, pi), way = random_between(&random, 0, 4);
        const double to = direction + (is_b ? pi : 0) + random_between(&random, -0.6, 0.6);
        f->bodies[k] = (narc_body){is_b ? distance * cos(direction) : 0,
                                   is_b ? distance * sin(direction) : 0,
                                   (float)cos(angle),
                                   (float)sin(angle),
                                   1,
                                   0};
        f->motions[k] = (narc_motion){(float)(way * cos(to)), (float)(way * sin(to)),
                                      (float)(turning * random_between(&random, -1, 1))};
    }
}

static void cast(const struct flights *f, narc_impact *out) {
    const narc_motion *const motion = f->motions;
    narc_bodies bodies;
    narc_view_bodies(f->bodies, 2 * f->count, &bodies);
    narc_motions motions = {.x = NARC_COLUMN(motion, x), .y = NARC_COLUMN(motion, y)};
    const narc_pairs pairs = {.count = f->count};
    narc_error error;
    if (f->turning)
        motions.angle = NARC_COLUMN(motion, angle);
    must(narc_cast_pairs(f->shapes, &bodies, &motions, &pairs, NULL, NULL, out, f->count, &error), &error);
}

static void run(struct row *row) {
    struct flights *f = row->state;
    if (row->peer) {
        const struct asked asked = {.count = f->count,
                                    .polygon = &f->polygon,
                                    .bodies = f->bodies,
                                    .motions = f->motions,
                                    .straight = !f->turning};
        row->peer->ask(row->peer_state, &asked, f->fractions);
    } else if (row->alone) {
        const narc_motion *motion = f->motions;
        narc_error error;
        for (size_t k = 0; k < f->count; k++, motion += 2)
            must(narc_cast_pair(f->shapes, &f->bodies[2 * k], motion, &f->bodies[2 * k + 1], motion + 1, NULL,
                                &f->impacts[k], &error),
                 &error);
    } else {
        cast(f, f->impacts);
    }
}

/* A peer has polygons in the place of n-arcs, a skin and an end to its search: where its hits are others, they count. */
static void prepare(struct row *row) {
    struct flights *f = row->state = allocate(1, sizeof *f);
    f->count = row->bench.count = scaled(PAIRS);
    f->bodies = allocate(2 * f->count, sizeof *f->bodies);
    f->motions = allocate(2 * f->count, sizeof *f->motions);
    f->impacts = allocate(f->count, sizeof *f->impacts);
    f->fractions = allocate(f->count, sizeof *f->fractions);
    add_shape(f, strchr(row->bench.name, '/') + 1);
    make_flights(f, row->question->what);
    narc_impact *expected = allocate(f->count, sizeof *expected);
    cast(f, expected);
    run(row);
    for (size_t k = 0; k < f->count; k++) {
        const bool hit = expected[k].count == NARC_CAST_HIT;
        row->bench.hits += hit / (double)f->count;
        if (row->peer)
            row->bench.wrong += hit != (f->fractions[k] <= 1);
        else
            row->bench.wrong +=
                f->impacts[k].count != expected[k].count || (hit && f->impacts[k].fraction != expected[k].fraction);
    }
}

/* Bodies turn by up to so many radians. */
const struct question impact_questions[] = {{"impact-straight", prepare, run, 0, false},
                                            {"impact-turning", prepare, run, 1, false},
                                            {"impact-turning-6", prepare, run, 6, false},
                                            {.name = NULL}};
