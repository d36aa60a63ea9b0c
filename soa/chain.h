/* SPDX-License-Identifier: MIT
 *
 * chain.h - a chain as it is read, before it is divided. Internal.
 */
#ifndef NARC_CHAIN_H
#define NARC_CHAIN_H

#include "narc_chains.h"

/* How far, in radians, parts of a cut arc reach beyond the cut, and concave arcs and runs beyond where they meet: an edge
 * of a body that lies along the tangent there has its normal on either side, by rounding. */
#define NARC_CHAIN_SEAM 2e-5

/* So far where a corner is cut: the nearer a point is to another one, the less is known of its direction from there. */
#define NARC_CORNER_SEAM 0.05

/* An arc of a chain. `turn` is signed: above 0 of a convex arc or corner, below 0 of a concave one, 0 for the open end
 * of an edge. The point at an angle is centre + radius * normal, with the radius's sign. */
typedef struct narc_chain_arc {
    double x, y, radius, start, turn;
    uint32_t number; /* the caller's */
} narc_chain_arc;

/* A chain without plain points but for open ends. If it is closed, the last arc is the first one again if that is
 * concave, else the first part of an arc that was cut, whose second part is the first one. */
typedef struct narc_chain {
    narc_chain_arc *arcs;
    size_t count;
    bool closed;
    double weld;
} narc_chain;

static inline double narc_find_seam(const narc_chain_arc *convex) {
    return convex->radius > 0 ? NARC_CHAIN_SEAM : NARC_CORNER_SEAM;
}

/* The point of an arc, `turned` radians counter-clockwise from its start. */
narc_point narc_find_chain_point(const narc_chain_arc *arc, double turned);

static inline narc_point narc_find_chain_start(const narc_chain_arc *arc) { return narc_find_chain_point(arc, 0); }
static inline narc_point narc_find_chain_end(const narc_chain_arc *arc) {
    return narc_find_chain_point(arc, arc->turn);
}

/* A straight part between two arcs is none if it is not longer than this: what the arcs miss each other by. */
double narc_find_chain_room(const narc_chain_arc *before, const narc_chain_arc *after);

/* Does a chain meet itself elsewhere than where its parts join? NARC_ERROR_NOT_SIMPLE, NARC_ERROR_MEMORY. */
narc_status narc_check_crossings(const narc_chain *chain, const narc_allocator *allocator, narc_error *error);

/* Divides a chain. Without a store it only counts: entries, and the records that their shapes need. Returns the first
 * error. */
typedef struct narc_chain_division {
    narc_shapes *shapes;       /* or NULL */
    narc_chain_entry *entries; /* if there is a store */
    size_t count, records;
    uint32_t run; /* the next one's number */
} narc_chain_division;
narc_status narc_divide_chain(const narc_chain *chain, narc_chain_division *division, narc_error *error);

#endif
