/* SPDX-License-Identifier: MIT
 *
 * narc_chains.h - ground: chains of arcs and edges with the solid on one side, open or closed, convex and concave.
 *
 * The mental model
 *
 *   A CHAIN is a list of arcs, walked with the solid on the left, as a shape is: normals point right, out of the solid.
 *   Straight edges join consecutive arcs where the end point of one is not the start point of the next; an edge has the
 *   normal of both. So there is one tangent everywhere, and a corner is an arc of radius 0. Of each arc a point is
 *   centre + radius * normal, with the sign of the radius:
 *
 *       radius > 0     convex: normals turn counter-clockwise from `start` to `end`, by at most half a turn
 *       radius 0       a convex corner; or with `start` and `end` equal a plain point: an end of an edge
 *       radius < 0     concave, solid outside the circle: normals turn clockwise from `start` to `end`
 *       radius -0.0    the bottom of a valley, a concave corner; so is 0 where normals turn clockwise
 *
 *   A level ground from x = 0 to x = 9 with the solid below is walked from its right end:
 *
 *       {{9, 0, 0, pi/2, pi/2}, {0, 0, 0, pi/2, pi/2}}
 *
 *   narc_add_chain() divides a chain into ENTRIES, which are shapes of a store: concave arcs, and pieces of convex RUNS,
 *   the maximal stretches between concave arcs. Each entry becomes a body of the caller's, with its shape, placed where
 *   the entry says. A run's shape is closed far behind, but only its front touches, never that closure. Answers are
 *   right for bodies that are less deep in the ground than half the entry's front is long, and where the ground is
 *   thicker than bodies are deep; faster ones want smaller steps or casts. An open end just ends: what lies beyond it
 *   touches nothing, and its solid ends straight behind it. A corner of a quarter turn there caps it. Behind thin ground, such as under a bridge, a body in the
 *   air is within the closure, or beyond a concave arc: there is no contact with what it does not touch. Each entry knows
 *   how thick its chain's solid is behind it, and how far other surfaces are from its ends, and a contact is never deeper
 *   than the body is wide along the normal, but for 2^-10 of its bounding radius; of two entries, as a gear in a ring, none
 *   is deeper than the smaller one's front is large, or an eighth of the larger one's. Rods and other bodies deeper than
 *   their inscribed circle is wide may lose contacts earlier: docs/terrain.md has the rule.
 *   Entries overlap by next to nothing, so that no body falls between two; what both tell of one body is merged
 *   by narc_update_contacts() (narc_contacts.h), which is told their runs. Queries of a batch give each entry's own rows.
 *
 *   Of an entry's shape narc_shape_flags() has NARC_SHAPE_RUN or NARC_SHAPE_CONCAVE. narc_get_arcs() gives a concave arc
 *   as it is in a chain, and of a run all arcs of the closed shape: its front is what lies between edge 1 and edge
 *   count - 5, arcs 1 .. count - 6 (edge i is the one before arc i). Features of rows are numbered so. narc_get_aabb()
 *   and the boxes of bodies hold the front, and behind it all places down to which it may have contacts.
 */
#ifndef NARC_CHAINS_H
#define NARC_CHAINS_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The run of entries that are concave arcs, which are of none, and of bodies that are no entries. */
#define NARC_NO_RUN UINT32_MAX

/* How a chain is divided; zero-initialised options are all defaults.
 *   closed         not 0: an edge, or a common point, joins the last arc to the first one
 *   first_run      the number of the first run, so that chains of one scene have runs of their own
 *   weld           the longest straight part of an entry; 0: 32 times the mean of the edges as given
 *   least_radius   concave arcs with a smaller radius, valleys too, are refused: those too tight for bodies
 *   thickness      of a solid that other chains bound, too: how thick it is where it is thinnest; 0: the chain bounds it
 *                  all, or it is as thick as can be
 *   both_sides     not 0: the chain is a line, and the air is on both of its sides: each has entries, and runs, of its
 *                  own, those of the left side behind the others. Ends are round, of radius 0 */
typedef struct narc_chain_options {
    uint32_t closed;
    uint32_t first_run;
    double weld;
    double least_radius;
    float thickness;
    uint32_t both_sides;
    void *reserved[1 + sizeof(void *) / 4]; /* NULL */
} narc_chain_options;

/* A part of a chain, a shape about its own middle. */
typedef struct narc_chain_entry {
    uint32_t shape;     /* in the store: equal parts may share it */
    uint32_t run;       /* the same for all entries of one convex run; NARC_NO_RUN for a concave arc */
    double x, y;        /* where the shape's origin lies in the chain's coordinates; it is not turned */
    uint32_t first_arc; /* of a run the chain's arc that is the shape's arc 1, or the one behind its edge if it has no
                           other feature; plain points do not count; a corner where the front's edge meets a
                           concave arc is of that arc. Of a concave arc its own number */
    uint32_t arc_count; /* of a run how many of the chain's arcs its front has, of a concave arc 1 */
} narc_chain_entry;

/* Adds a chain of `count` arcs (1 .. 2^30), in their order, to a store. The entries, in the order of the chain (of a
 * closed one from any place), go to `out_entries`, which has room for `capacity`, their number to `out_count`. Each
 * entry is a use of its shape, which narc_remove_shape() gives back. With `both_sides` those of the left side follow,
 * walked back: along them the numbers of arcs fall.
 *   Plain points within a straight line vanish. Straight lines longer than `weld` are divided into parts of one length,
 * of which two that follow each other have a quarter of `weld` in common. So a body that touches no wider a stretch of
 * the line has all of its contact, both points, on one part. Of a wider one that lies across such a stretch, tilted by
 * 1e-6 rad or more, the deeper side's contact alone is told.
 *   Errors, with the arc's number in error->index: NARC_ERROR_ARGUMENT (NULL; options that are negative or no numbers),
 * NARC_ERROR_COUNT, NARC_ERROR_NOT_FINITE, NARC_ERROR_RADIUS (a concave arc tighter than `least_radius`; an arc flatter
 * than NARC_MAX_RADIUS_RATIO allows, of a concave one relative to four times half of its chord),
 * NARC_ERROR_SWEEP (an arc turns by nothing, backwards, by more than half a turn; a closed chain of plain points),
 * NARC_ERROR_NOT_CLOSED (arcs that do not meet, or whose normals differ by more than NARC_TOLERANCE),
 * NARC_ERROR_NOT_CONVEX (an edge runs backwards), NARC_ERROR_NOT_SIMPLE (the chain crosses or touches itself),
 * NARC_ERROR_SIZE (a part is too small or too large), NARC_ERROR_MEMORY, and NARC_ERROR_CAPACITY, where `out_count`
 * alone is set, to what is needed (`out_entries` may be NULL if the capacity is 0). On error the store is as it was.
 *   Takes exclusive access to the store, and time in proportion to n log n, for a chain that does not come near itself
 * often. Pure otherwise; the same bits on every machine. */
NARC_API narc_status narc_add_chain(narc_shapes *shapes, const narc_arc *arcs, size_t count,
                                    const narc_chain_options *options, narc_chain_entry *out_entries, size_t capacity,
                                    size_t *out_count, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
