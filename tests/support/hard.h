/* SPDX-License-Identifier: MIT
 *
 * hard.h - shapes and places that shortcuts go wrong on: much that nearly ties, and much that is nearly nothing.
 */
#ifndef NARC_TEST_HARD_H
#define NARC_TEST_HARD_H

#include "scene.h"

enum hard_family {
    HARD_CORNERS, /* polygons with 3 .. 64 corners */
    HARD_REGULAR, /* regular polygons and n-arcs, 3 .. 64: local maxima of the gap that tie */
    HARD_STACK,   /* boxes and capsules with sides in eighths */
    HARD_TIPS,    /* lenses with tips down to 1e-5 of their size */
    HARD_LONG,    /* capsules and boxes, down to 1 : 1000 */
    HARD_MANY,    /* n-arcs with 17 .. 64 arcs */
    HARD_SPLIT,   /* an arc is several, with the same circle and sweeps down to the least that is accepted */
    HARD_SUM,     /* one shape rolled around another, mostly with junctions as close as is accepted */
    HARD_SPECK,   /* the same with one of the two a speck: radii and edges of very different size */
    HARD_AWAY,    /* any shape, up to 1e4 sizes from its own origin */
    HARD_COUNT
};

const char *hard_family_name(enum hard_family family);

/* A random shape with a bounding radius of about 1. */
struct shape make_hard_shape(struct test_random *random, enum hard_family family);

/* The ordinary families first, then the hard ones. */
enum { ALL_FAMILIES = FAMILY_COUNT + HARD_COUNT };
struct shape make_any_shape(struct test_random *random, size_t family);
const char *any_family_name(size_t family);

enum hard_placement {
    HARD_TOUCH,      /* exact separations of 0 and +-1e-8 .. +-1e-2 of the size, from a random touch */
    HARD_JUNCTION,   /* the contact's normal 0 or 1e-8 .. 1e-3 beside a junction, mostly one of each shape, those 0.05
                      * apart at most */
    HARD_ALIGNED,    /* somewhere deep, a junction of A and one of B opposite but for 0 or 1e-8 .. 1e-3 */
    HARD_CONCENTRIC, /* one middle, or nearly one */
    HARD_PLACES
};

const char *hard_placement_name(enum hard_placement placement);

/* The most bodies that add_hard_pairs() adds; half as many pairs. */
enum { HARD_BODIES = 64 };

/* Adds pairs of two shapes of a scene in related places. Sizes are the same, very different, or far from 1; rotations
 * now and then drifted. */
void add_hard_pairs(struct test_random *random, struct scene *scene, enum hard_placement placement, uint32_t shape_a,
                    uint32_t shape_b);

/* Pairs of shapes, half of which lie 10^decade times their radius from their own origin: up to 1e18 times, the smallest
 * radius and the largest shift that a store takes. From 2e5 on the room for rounding is larger than the shape, and from 2e7
 * on single precision leaves nothing of it but a speck. From 1e10 on only circles still join up. */
enum { FIRST_FAR = 3, LAST_FAR = 18 };
struct scene make_far_scene(struct test_random *random, int decade);

#endif
