/* SPDX-License-Identifier: MIT
 *
 * families.h - random shapes of every kind that the library promises to handle.
 */
#ifndef NARC_TEST_FAMILIES_H
#define NARC_TEST_FAMILIES_H

#include "narc_shapes.h"
#include "support.h"

enum family {
    FAMILY_SMOOTH,  /* n-arcs, n = 3 .. 16, radii of one order of magnitude */
    FAMILY_UNEQUAL, /* n-arcs whose radii span three orders of magnitude */
    FAMILY_THIN,    /* long thin n-arcs, capsules and boxes, down to 1 : 100 */
    FAMILY_LENS,    /* two flat arcs, sharp or rounded tips, down to 1 : 50 */
    FAMILY_POLYGON, /* straight edges, 3 .. 12 corners */
    FAMILY_BOX,     /* boxes, sharp and rounded, mostly with sides in eighths */
    FAMILY_CAPSULE,
    FAMILY_ROUNDED, /* polygons with rounded corners, each its own radius */
    FAMILY_CIRCLE,
    FAMILY_HALF,    /* half discs and thicker slices: a large arc closed by an edge */
    FAMILY_MIXED,   /* arcs and edges, some of either, sharp corners too */
    FAMILY_FITTED,  /* what the builders make of a random, mostly not convex polygon */
    FAMILY_MANY,    /* 17 .. 64 arcs */
    FAMILY_SEGMENT, /* two points and what lies between them: no area */
    FAMILY_OFFSET,  /* any of the above, away from its own origin */
    FAMILY_COUNT
};

struct shape {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
};

const char *family_name(enum family family);

/* What the builders make. Whole width and height, the corners' radius; a capsule is as long as its segment. */
struct shape circle_of(double radius);
struct shape box_of(double width, double height, double radius);
struct shape capsule_of(double length, double radius);

/* A store, and a shape that it must take; its index. */
narc_shapes *empty_store(void);
uint32_t store_shape(narc_shapes *store, struct shape shape);

/* A random shape with a bounding radius of about 1. */
struct shape make_shape(struct test_random *random, enum family family);

#endif
