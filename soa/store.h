/* SPDX-License-Identifier: MIT
 *
 * store.h - the layout of a shape store, as the kernels read it. Internal.
 *
 * Each shape has a HEAD, half a cache line with all that the comparison of circles needs, and a BLOCK of RECORDS, also
 * half a cache line each: the angles of its junctions (TURNS), 16 to a record, its ARCS, one record with all that is
 * known of each, and last its BOX. A batch meets shapes in any order, and so touches one line for a shape that the
 * circles settle, and two more for most others, however many arcs they have; heads of their own lie so densely that
 * thousands stay in the cache.
 *
 * Arcs lie in the order of their junctions' angle, the first junction counter-clockwise from +x first; the caller's
 * first arc is somewhere among them (`first` says where). So a direction belongs to the arc before the first whose
 * junction has a larger angle, to the last arc if that is the first.
 *
 * Angles are diamond angles: monotonic in the true one, 0 along +x, 1 along +y, at most 4. In the list they are rounded
 * to 16 bits, in the order of signed numbers.
 *
 * A full circle is stored as two half circles, because the kernels want sweeps of at most half a turn;
 * NARC_SHAPE_CIRCLE tells them to report arc 0 for both.
 */
#ifndef NARC_STORE_H
#define NARC_STORE_H

#include "narc_shapes.h"

enum { NARC_CACHE_LINE = 64, NARC_TURNS = 16 };

/* A diamond angle in 16 bits: (int)(angle * NARC_TURN_SCALE - NARC_TURN_OFFSET), and what fills up the list: no
 * direction is beyond it. */
#define NARC_TURN_SCALE  16383.75f
#define NARC_TURN_OFFSET 32768.0f
#define NARC_TURN_NONE   INT16_MAX

typedef struct narc_head {
    uint32_t block; /* the block's first record, counted from narc_shapes.records */
    uint8_t count;  /* arcs as stored, 2 .. NARC_MAX_ARCS */
    uint8_t first;  /* the caller's arc that is arc 0 here */
    uint8_t flags;  /* NARC_SHAPE_... */
    uint8_t reach;  /* extent (the largest |centre| + radius) at most this times bound_radius; 255: more than that, or
                     * arcs join worse than NARC_HEAD_MISFIT: kernels prove nothing then, but go by their formula */
    /* A circle around the shape and one inside it. Both leave room (NARC_HEAD_SLACK times the extent) for the rounding
     * of the kernels, so that a filter that uses them never contradicts the deciding formula. The inner radius is 0
     * where that leaves nothing. */
    float bound_x, bound_y, bound_radius;
    float inner_x, inner_y, inner_radius;
} narc_head;

/* An arc: its circle, and the unit outward normals where it starts and ends, counter-clockwise. `rolls` is two radii
 * that tell how much shape there is behind the arc, rounded down to the upper halves of floats:
 *   inner, the upper half   A circle of that radius that touches the arc from inside, anywhere on it, lies in the
 *   shape;
 *                           and no arc with a direction within NARC_INNER_WINDOW of one of this arc's has a smaller
 *                           radius.
 *   near, the lower half    No arc with a direction within NARC_NEAR_WINDOW has a smaller radius. */
#define NARC_INNER_WINDOW 0.1
#define NARC_NEAR_WINDOW  1.0471975511965976 /* 60 degrees */

/* The end of an arc and the start of the next have the same bits: a junction has one normal. */
typedef struct narc_stored_arc {
    float center_x, center_y, radius;
    uint32_t rolls;
    float start_x, start_y, end_x, end_y;
} narc_stored_arc;

/* What only methods other than the exact one ask of a shape, behind its arcs: a box around it and its centroid. The
 * half sides have room for the kernels' rounding, NARC_HEAD_SLACK times the extent. */
typedef struct narc_box {
    float center_x, center_y, half_x, half_y;
    float axis_x, axis_y; /* the direction of the side half_x, unit */
    float centroid_x, centroid_y;
} narc_box;

typedef union narc_record {
    int16_t turns[NARC_TURNS];
    narc_stored_arc arc;
    narc_box box;
} narc_record;

/* Where the arcs begin in a block: how many records the turns take. */
static inline size_t narc_first_arc(size_t count) { return (count + NARC_TURNS - 1) / NARC_TURNS; }

/* 96 roundings, so that the circles stay clear of the deciding formula's error: that is 32 roundings (NARC_ERROR_BOUND)
 * of the distance between the positions plus both extents, and that distance is at most the sum of the extents more
 * than the distance between the circles' centres. See kernels/relative.inl. */
#define NARC_HEAD_SLACK (96.0 / 16777216.0)

/* What the joins of all arcs together may be off by, relative to the extent, for the kernels' proofs to hold: what
 * their slack has to spare (kernels/proof.inl). Coordinates with 7 digits pass, where they are of the extent's size. */
#define NARC_HEAD_MISFIT (32.0 / 16777216.0)

/* The largest bound_radius, scaled: a centred shape of NARC_MAX_SIZE passes with its room for rounding. */
#define NARC_HEAD_MAX_RADIUS (NARC_MAX_SIZE * (1 + NARC_TOLERANCE))

struct narc_shapes {
    narc_head *heads;
    narc_record *records;
    size_t count, capacity;               /* heads */
    size_t polygon_count;                 /* of them, those with NARC_SHAPE_POLYGON */
    size_t record_count, record_capacity; /* records */
    narc_allocator allocator;
    void *heads_memory, *records_memory; /* what the allocator returned; heads and records begin at cache lines in it */
};

/* The arcs of a shape, narc_head.count of them. */
static inline const narc_record *narc_arcs_of(const narc_shapes *shapes, const narc_head *head) {
    return &shapes->records[head->block + narc_first_arc(head->count)];
}

#endif
