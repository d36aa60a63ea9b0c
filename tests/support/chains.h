/* SPDX-License-Identifier: MIT
 *
 * chains.h - random ground of every kind, and bodies put on it where contacts go wrong.
 */
#ifndef NARC_TEST_CHAINS_H
#define NARC_TEST_CHAINS_H

#include "ground_reference.h"
#include "scene.h"

enum chain_family {
    CHAIN_HILLS,  /* convex and concave arcs with common tangents, edges between some */
    CHAIN_MIXED,  /* corners and valleys, too */
    CHAIN_BOWLS,  /* concave arcs in several pieces of one circle, and flat bottoms */
    CHAIN_TIGHT,  /* the same, and bodies of nearly the arcs' radius */
    CHAIN_FINE,   /* pieces smaller than bodies */
    CHAIN_STEPS,  /* edges alone, many in line */
    CHAIN_LONG,   /* 60 .. 150 pieces whose sizes span three orders of magnitude */
    CHAIN_CLOSED, /* a closed outline, arcs at its corners */
    CHAIN_ENDS,   /* one to four pieces, bare ends or capped ones */
    CHAIN_SLAB,   /* closed from here on, and thin, 0.02 to 1: a straight sheet */
    CHAIN_ARCH,   /* a sheet that bends one way, by corners or arcs */
    CHAIN_ZIGZAG, /* a sheet that bends both ways, by corners */
    CHAIN_SHEET,  /* the same by arcs: corrugated */
    CHAIN_ANGLE,  /* L: bent once */
    CHAIN_CUP,    /* bent twice the same way */
    CHAIN_PIPE,   /* all around, but for a slit */
    CHAIN_WALLS,  /* walls that stand on a slab */
    CHAIN_GEAR,
    CHAIN_FAMILIES
};

enum { CHAIN_ARCS = 512 };

const char *chain_family_name(enum chain_family family);

/* A random chain; `arcs` has room for CHAIN_ARCS. */
struct chain make_chain(struct test_random *random, enum chain_family family, narc_arc *arcs);

/* The mean length of its pieces. */
double chain_side(const struct chain *chain);

/* A shape, and a body of it on the chain, at its origin and not turned: a feature of the body over a place of the
 * chain, junctions preferred on both sides, at a distance of up to `margin`, or as deep. */
struct shape make_rider(struct test_random *random, const struct chain *chain, enum chain_family family);
struct body ride_chain(struct test_random *random, const struct chain *chain, const struct shape *shape, double margin);

/* A body that comes out of the air near the chain, any way, until it is `gap` away; or, below 0, goes on by as much from
 * where it would touch. If there is no room for it, it is where it is. */
struct body approach_chain(struct test_random *random, const struct chain *chain, struct ground *ground,
                           const struct shape *shape, double gap);

#endif
