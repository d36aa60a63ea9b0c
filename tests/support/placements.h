/* SPDX-License-Identifier: MIT
 *
 * placements.h - two bodies put where collision tests go wrong.
 */
#ifndef NARC_TEST_PLACEMENTS_H
#define NARC_TEST_PLACEMENTS_H

#include "scene.h"

enum placement {
    PLACE_NEAR,       /* a separation of -0.5 .. 0.5 */
    PLACE_DEEP,       /* anywhere close: mostly deep, with several local maxima of the gap */
    PLACE_TOUCH,      /* a separation of a few float roundings */
    PLACE_JUNCTION,   /* the normal on a junction of one shape or of both */
    PLACE_COINCIDENT, /* the same position, and mostly the same angle */
    PLACE_INSIDE,     /* one body small and inside the other */
    PLACE_LATTICE,    /* right angles, positions in sixteenths: exact touch, shared edges */
    PLACE_PARALLEL,   /* nearly right angles: edges that are parallel but for a rounding or some */
    PLACE_SCALED,     /* scales of 1e-3 .. 1e3 */
    PLACE_EXTREME,    /* scales near the limits of what is accepted */
    PLACE_FAR,        /* 1e4 sizes from the origin in single precision, 1e7 in double precision */
    PLACE_COUNT
};

const char *placement_name(enum placement placement);

/* Poses for two shapes, with positions rounded to `precision`; the members `shape` are left 0. */
void place_pair(struct test_random *random, enum placement placement, narc_precision precision, const struct shape *a,
                const struct shape *b, struct body *out_a, struct body *out_b);

/* Two bodies of a scene's shapes, so placed, and their pair. */
void scene_add_placed(struct test_random *random, struct scene *scene, enum placement placement, uint32_t shape_a,
                      uint32_t shape_b);

/* Two shapes of either family, and `count` pairs of them in all placements in turn; within a family, now and then, a
 * shape against itself. */
struct scene make_placed_scene(struct test_random *random, narc_precision precision, enum family a, enum family b,
                               size_t count);

/* Moves B along a direction through A's position until the separation is `target`, or as near to it as it gets. */
void place_at_gap(const struct shape *a, const struct shape *b, double direction, double target,
                  const struct body *body_a, struct body *body_b);

#endif
