/* SPDX-License-Identifier: MIT
 *
 * chain.h - a chain as it is read, before it is divided. Internal.
 */
#ifndef NARC_CHAIN_H
#define NARC_CHAIN_H

#include <stdbool.h>

#include "narc_chains.h"

/* How far, in radians, parts of a cut arc reach beyond the cut, and concave arcs and runs beyond where they meet: an edge
 * of a body that lies along the tangent there has its normal on either side, by rounding. */
#define NARC_CHAIN_SEAM 2e-5

/* So far where a corner is cut: the nearer a point is to another one, the less is known of its direction from there. */
#define NARC_CORNER_SEAM 0.05

/* Where a corner is cut each part goes on along its tangent there, by this part of its size: of a corner that touches it the
 * direction is that of rounding, and of two parts each might leave it to the other. */
#define NARC_FIN 0x1p-16

/* The far corners lie this many times the front's size away. */
#define NARC_FAR 4.0

/* What the corners at the ends of a run turn by. */
#define NARC_END_TURN 0x1p-10

/* An arc of a chain. `turn` is signed: above 0 of a convex arc or corner, below 0 of a concave one, 0 for the open end
 * of an edge. The point at an angle is centre + radius * normal, with the radius's sign. */
typedef struct narc_chain_arc {
    double x, y, radius, start, turn;
    uint32_t number; /* the caller's */
    double turned;   /* what the chain turns by before it */
    size_t curve;    /* its number there, or of a corner that of the next one */
} narc_chain_arc;

/* A chain without plain points but for open ends. If it is closed, the last arc is the first one again if that is
 * concave, else the first part of an arc that was cut, whose second part is the first one. */
typedef struct narc_chain {
    narc_chain_arc *arcs;
    size_t count;
    bool closed;
    double weld;
    double thickness;      /* none of its solid is thicker */
    ptrdiff_t number, way; /* the caller's number of arc 0 that was read, and what is added for each after it */
    size_t most;           /* no number is greater */
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

/* ------------------------------------------------------------------------------------------------ its curves */

/* A line from `from` to `to`, or with a radius above 0 an arc, counter-clockwise from the normal u to the normal v of
 * its circle, with its ends. */
typedef struct narc_curve {
    narc_point from, to, center, u, v;
    double radius;
    double turned, turn; /* what the chain turns by before it, and it itself */
    uint32_t number;
} narc_curve;

/* Of the curves below a node: the box around them, and the most and the least that the chain has turned by there. */
typedef struct narc_curve_node {
    narc_aabb box;
    double most, least;
} narc_curve_node;

/* The lines and arcs of a chain, leaves of a binary tree over its order: what follows each other lies together. */
typedef struct narc_curves {
    narc_curve *curves;
    narc_curve_node *nodes; /* node k has the nodes 2 k + 1 and 2 k + 2 below */
    size_t count;
    bool closed;
    double turn;             /* of all of it */
    narc_curve end_sides[2]; /* of an open chain's solid */
} narc_curves;

/* The curves from `first` to before `end`, those below a node. */
typedef struct narc_span {
    size_t node, first, end;
} narc_span;

static inline narc_span narc_get_half(narc_span s, int half) {
    const size_t middle = s.first + (s.end - s.first) / 2;
    return half ? (narc_span){2 * s.node + 2, middle, s.end} : (narc_span){2 * s.node + 1, s.first, middle};
}

/* Notes in a chain's arcs which curve each is. NARC_ERROR_MEMORY. */
narc_status narc_build_curves(narc_chain *chain, const narc_allocator *allocator, narc_curves *out_curves,
                              narc_error *error);

static inline bool narc_curve_holds(const narc_curve *c, narc_point direction) {
    return c->u.x * direction.y - c->u.y * direction.x >= 0 && direction.x * c->v.y - direction.y * c->v.x >= 0;
}

/* What its coordinates are off by, and a box around it with that much room. */
double narc_find_curve_room(const narc_curve *curve);
narc_aabb narc_find_curve_box(const narc_curve *curve);

/* Does a chain meet itself elsewhere than where its parts join? NARC_ERROR_NOT_SIMPLE. */
narc_status narc_check_crossings(const narc_curves *curves, narc_error *error);

/* ------------------------------------------------------------------------------------------------ its solid */

/* Where the chain goes on from a point: in an arc, so far from its start, or on the line that leads there. */
typedef struct narc_chain_place {
    const narc_chain_arc *arc;
    double turned;
} narc_chain_place;

/* Finds where an open chain's solid ends: straight back from its ends, up to what is in the way of the chain. */
void narc_find_end_sides(const narc_chain *chain, narc_curves *curves);

/* How thick the solid is behind the front of a piece, convex arcs and the edges that join them from `begin` to `end`, or
 * one concave arc: along its normals, up to `most`. Coordinates are relative to `origin`. */
double narc_find_thickness(const narc_curves *curves, const narc_arc *arcs, size_t count, narc_point begin,
                           narc_point end, narc_point origin, double most);

/* How far a point of the chain is from all of it that is not the surface around it, up to `most`. */
double narc_find_clearance(const narc_curves *curves, narc_point point, narc_chain_place at, double most);

/* Divides a chain. Without a store it only counts: entries, and the records that their shapes need. Returns the first
 * error. */
typedef struct narc_chain_division {
    narc_shapes *shapes;       /* or NULL */
    narc_chain_entry *entries; /* if there is a store */
    size_t count, records;
    uint32_t run; /* the next one's number */
} narc_chain_division;
narc_status narc_divide_chain(const narc_chain *chain, const narc_curves *curves, narc_chain_division *division,
                              narc_error *error);

#endif
