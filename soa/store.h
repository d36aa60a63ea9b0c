/* SPDX-License-Identifier: MIT
 *
 * store.h - the layout of a shape store, as the kernels read it. Internal.
 *
 * Each shape has a HEADER, half a cache line with all that the comparison of circles needs, and a run of RECORDS, half
 * a cache line each: first its junction angles, 16 to a record, then its arcs, one record with all that is known of
 * each. A batch meets shapes in any order. It touches one line for a shape that the circles settle,
 * and two more for most others, however many arcs they have. The headers lie together, so that thousands stay in the
 * cache.
 *
 * Arcs lie in the order of the angles of the junctions where they start, counter-clockwise from +x; the header's
 * `first_arc` says which of the caller's arcs is the first one here. A direction belongs to the arc before the first
 * junction with a larger angle, and to the last arc if that junction is the first one.
 *
 * Angles are diamond angles: monotonic in the true angle, 0 along +x, 1 along +y, at most 4. The junction angles are
 * rounded to 16 bits, in the order of signed numbers.
 *
 * A full circle is stored as two half circles, because the kernels want sweeps of at most half a turn;
 * NARC_SHAPE_CIRCLE tells them to report arc 0 for both.
 */
#ifndef NARC_STORE_H
#define NARC_STORE_H

#include "narc_pairs.h"

/* Is this the small module for WebAssembly, which leaves some kernels out, and all that is for pieces of chains? */
#ifndef NARC_SMALL
#define NARC_SMALL 0
#endif

/* Are there pieces of chains? */
#define NARC_PIECES (!NARC_SMALL)

enum { NARC_CACHE_LINE = 64, NARC_RECORD_ANGLES = 16 };

/* A diamond angle in 16 bits is (int)(angle * NARC_ANGLE_SCALE - NARC_ANGLE_OFFSET). NARC_ANGLE_NONE, which no
 * direction exceeds, fills up the last record. */
#define NARC_ANGLE_SCALE  16383.75f
#define NARC_ANGLE_OFFSET 32768.0f
#define NARC_ANGLE_NONE   INT16_MAX

typedef struct narc_shape_header {
    uint32_t first_record; /* index into narc_shapes.records */
    /* Four bytes that the kernels read as one number, `count` its lowest byte:
     *   count          arcs as stored, 2 .. NARC_MAX_ARCS; 1 of a concave arc
     *   first_arc      the caller's arc that is stored first, and NARC_PIECE_... for pieces of chains
     *   flags          NARC_SHAPE_..., and in the upper half the size class
     *   extent_ratio   The extent (the largest |centre| + radius) is at most this many bounding radii. 255: it is more,
     *                  or the arcs join worse than NARC_MAX_MISFIT; then the kernels prove nothing and go by the
     *                  deciding formula. */
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    uint8_t extent_ratio, flags, first_arc, count;
#else
    uint8_t count, first_arc, flags, extent_ratio;
#endif
    /* A circle around the shape and one inside it. Both leave room (NARC_ROUNDING_ROOM times the extent) for the
     * rounding of the kernels, so that a filter that uses them never contradicts the deciding formula. The inner radius
     * is negative where the room is larger than the circle, of shapes far from their own origin: what is missing must
     * come off the other body's radius.
     *   A removed shape has the bounding radius 0, which is not in range: kernels take no body of that shape. */
    float bound_x, bound_y, bound_radius;
    float inner_x, inner_y, inner_radius;
} narc_shape_header;

/* Pieces of chains, bits of first_arc:
 *   NARC_PIECE_RUN      A convex run of a chain, closed far behind: of the caller's arcs 0 ... count - 1 the last four are
 *                       corners of that closure, and arc 0 and arc count - 5 corners that turn by next to nothing, where
 *                       the run ends. What touches lies on arcs 1 ... count - 6 or edges 1 ... count - 5; all else is
 *                       no contact. All of the header is that of the closed shape, which is a shape like any other.
 *   NARC_PIECE_CONCAVE  One record: an arc with the solid outside its circle. Its radius is negative, or -0 for the
 *                       bottom of a valley; `start` and `end` are the outward normals (they point to the centre) at its
 *                       ends, so that end lies counter-clockwise of start by less than half a turn, and so a point of
 *                       the arc is centre + radius * normal. The circle around it is that of the arc alone, the inner
 *                       radius is -infinity, the extent ratio that of centre and radius.
 *   NARC_PIECE_PLANE    Both marks, of no chain: a half-plane, all that is not above its own x axis. What is stored is the
 *                       box below that from -1 to 1 whose side edge 0 is; of a half-plane it is a part as good as one of
 *                       any other size, or further along (kernels/base/planes.inl). */
#define NARC_PIECE_RUN     0x40u
#define NARC_PIECE_CONCAVE 0x80u
#define NARC_PIECE_PLANE   0xc0u
#define NARC_PIECE_MARKS   0xc0u
#define NARC_FIRST_ARC     0x3fu

/* Is a feature, as rows have it, one that may touch? Of a run those of its closure may not. */
static inline bool narc_touches(const narc_shape_header *header, unsigned feature) {
    const unsigned number = feature & (NARC_FEATURE_EDGE - 1), behind = feature & NARC_FEATURE_EDGE ? 5 : 6;
    return (header->first_arc & NARC_PIECE_MARKS) != NARC_PIECE_RUN || (number > 0 && number + behind <= header->count);
}

/* A half-plane is one, too. */
static inline bool narc_is_piece(const narc_shape_header *header) {
    return NARC_PIECES && (header->first_arc & NARC_PIECE_MARKS) != 0;
}

static inline bool narc_is_concave(const narc_shape_header *header) {
    return NARC_PIECES && (header->first_arc & NARC_PIECE_MARKS) == NARC_PIECE_CONCAVE;
}

static inline bool narc_is_plane(const narc_shape_header *header) {
    return NARC_PIECES && (header->first_arc & NARC_PIECE_MARKS) == NARC_PIECE_PLANE;
}

static inline bool narc_is_of_chain(const narc_shape_header *header) {
    return narc_is_piece(header) && !narc_is_plane(header);
}

/* The upper half of a shape's flags is the class of its extent, from 2^(5 class - 32) up to 32 times that, the last one
 * open: up to 2^48 all that NARC_MAX_BOUND_RADIUS lets through. A straight part shorter than 2^(5 class - 47), between
 * 2^-20 and 2^-15 of the extent, is no edge: it is what centres and radii lost when they were stored, 2^-22 of the
 * extent, or arcs that were given a little apart. */
#define NARC_SIZE_CLASS_SHIFT 4

/* An arc: its circle, and the unit outward normals where it starts and ends, counter-clockwise. `inner_radii` is two
 * radii that tell how much shape there is behind the arc, each rounded down to the upper half of a float:
 *   inner, the upper half   A circle of that radius that touches the arc from inside, anywhere on it, lies in the
 *                           shape; and no arc with a direction within NARC_INNER_WINDOW of one of this arc's has a
 *                           smaller radius.
 *   near, the lower half    No arc with a direction within NARC_NEAR_WINDOW has a smaller radius. */
#define NARC_INNER_WINDOW 0.1
#define NARC_NEAR_WINDOW  1.0471975511965976 /* 60 degrees */

/* The end of an arc and the start of the next have the same bits: a junction has one normal. */
typedef struct narc_stored_arc {
    float center_x, center_y, radius;
    uint32_t inner_radii;
    float start_x, start_y, end_x, end_y;
} narc_stored_arc;

/* Behind the arcs of a piece of a chain, what is known of the solid there, in the unit of the shape (soa/piece.h):
 *   thickness   So far, at least, the solid goes on behind every place of the front, against its normals there; 0 if
 *               it does not along some, as at a corner that turns by more than a right angle; -0 of a line in the air.
 *   clearance   Of both ends of the front, in the order of the arcs: so far, at least, all is that is not the surface
 *               around them.
 *   depth       No contact that reaches the front is deeper behind it. Boxes hold all of that. */
typedef struct narc_solid {
    float thickness, clearance[2], depth;
    float unused[4]; /* 0 */
} narc_solid;

typedef union narc_record {
    int16_t angles[NARC_RECORD_ANGLES];
    narc_stored_arc arc;
    narc_solid solid;
} narc_record;

/* A box about its own origin with sides along its axes, sharp or with equally rounded corners, beside its header: half
 * the sides of the rectangle of the corners' centres. Or a capsule along the x axis about its own origin, as a box
 * without height, or a circle about it, as one without sides. Batches of these read nothing else of a shape (kernels/box/).
 *   half_y of a capsule   A zero: x of the normal of its edge at +y, with its sign, which makes a bit of an answer. The
 *                         normal at -y is the opposite one.
 *   info   0: the shape is none of these; else NARC_IS_..., and in its lowest bits, but for a circle, the first_arc of
 *          its header. NARC_IS_POLYGON alone, which makes it less than 0: none of these either, but a polygon of 3 to
 *          NARC_FORM_CORNERS corners of one radius, which one pair by itself is told by. With it, and so less than 0 too:
 *          NARC_IS_PLANE, a half-plane, of which half_x is 1, and all else 0; NARC_HAS_FRONT, a piece of a chain, whose
 *          radius is the bounding radius, and half_x and half_y the centre of the caller's arc 3 (narc_piece_form).
 * The corners of a box are the records in their order, the one at +x, +y first; those of a capsule the ends at -x and
 * +x. Half sizes, but for a capsule's height, are longer than what counts as no edge. */
typedef struct narc_box_form {
    float half_x, half_y, radius;
    uint32_t info;
} narc_box_form;

#define NARC_IS_BOX     4u
#define NARC_IS_CAPSULE 8u
#define NARC_IS_CIRCLE  16u
#define NARC_IS_POLYGON 0x80000000u
#define NARC_IS_PLANE   0x40000000u
#define NARC_HAS_FRONT  0x20000000u
enum { NARC_FORM_CORNERS = 8 };

static inline bool narc_has_form(const narc_box_form *box) {
    return (box->info & ~(NARC_IS_POLYGON | NARC_HAS_FRONT)) != 0;
}

/* What a circle touches of a piece of a chain, in one line of the cache: of a run the caller's arcs 0, 1 and 2, where the
 * normals 1 to 3 lie between them and behind; all of the shortest fronts, and the begin of others. Of a concave arc, as of
 * arc 1, centre, radius, and the normals 1 and 2 at its ends. `thickness` is that of the solid, and `info` is the second
 * word of the header, less the number of the arc that is stored first. Of all other shapes all is 0. */
typedef struct narc_piece_form {
    float center_0[2], normal_1[2];
    float center_1[2], radius_1;
    uint32_t info;
    float normal_2[2], center_2[2];
    float normal_3[2], radius_2, thickness;
} narc_piece_form;

/* Records that there is memory for behind the last one. Kernels read the angles of 64 arcs, four records, of shapes with
 * fewer, and a concave arc has two. */
enum { NARC_READ_AHEAD = 2 };

/* How many records the junction angles of a shape take: its first arc lies behind them. */
static inline size_t narc_angle_records(size_t count) { return (count + NARC_RECORD_ANGLES - 1) / NARC_RECORD_ANGLES; }

/* All records of a shape: its angles, its arcs and, of a piece, its solid. */
static inline size_t narc_count_records(const narc_shape_header *header) {
    return narc_angle_records(header->count) + header->count + narc_is_piece(header);
}

/* 96 roundings, so that the circles stay clear of the deciding formula's error. That error is 32 roundings
 * (NARC_ERROR_BOUND) of the distance between the positions plus both extents, and that distance exceeds the distance
 * between the circles' centres by at most the sum of the extents. See kernels/base/pair_setup.inl. */
#define NARC_ROUNDING_ROOM (96.0 / 16777216.0)

/* What the joins of all arcs together may be off by, relative to the extent, for the kernels' certificates to hold:
 * their slack covers that much (kernels/sat/certificates.inl). Coordinates with 7 digits pass if they are of the
 * extent's size. */
#define NARC_MAX_MISFIT (32.0 / 16777216.0)

/* The largest bound_radius, scaled: a centred shape of NARC_MAX_SIZE passes with its room for rounding. */
#define NARC_MAX_BOUND_RADIUS (NARC_MAX_SIZE * (1 + NARC_TOLERANCE))

/* No shape. */
#define NARC_NO_SHAPE UINT32_MAX

/* What kernels do not read of a shape: how often it is used, and its place in a list, which is doubly linked so that
 * any shape leaves it at once. Shapes with the same bucket of their hashes are in one list; removed ones, which have no
 * use, are in another, the last one first. */
typedef struct narc_shape_entry {
    uint32_t uses;
    uint32_t hash; /* of the stored bits */
    uint32_t next, before;
} narc_shape_entry;

struct narc_shapes {
    narc_shape_header *headers;
    narc_record *records;
    narc_box_form *boxes;                 /* one for each header */
    narc_piece_form *fronts;              /* one for each header, or NULL if there never was a piece of a chain */
    narc_shape_entry *entries;            /* one for each header */
    uint32_t *buckets;                    /* the first shape in each list, as many lists as there is room for headers */
    size_t count, capacity;               /* headers, those of removed shapes among them */
    size_t removed_count;                 /* removed shapes */
    size_t box_count;                     /* shapes with a form but for polygons */
    size_t piece_count, plane_count;      /* shapes that are pieces of chains or half-planes, and the latter */
    uint8_t largest_ratio;                /* the largest extent_ratio that a shape has had */
    uint32_t last_removed;                /* the last of them, or NARC_NO_SHAPE */
    uint64_t change_count;                /* how often shapes came, changed or went */
    uint64_t history;                     /* a hash of which shapes did so, one after the other */
    size_t record_count, record_capacity; /* records, with the gaps between blocks */
    size_t used_records;                  /* records in blocks of shapes, and of the circle that removed ones have */
    narc_allocator allocator;
    /* What the allocator returned: fronts, boxes, entries, buckets and headers; and records. Fronts, headers and records begin
     * at cache lines, and end with the memory but for less than one, and records but for what may be read ahead (store.c). */
    void *headers_memory, *records_memory;
};

/* Is there such a shape, and was it not removed? `shapes` may be NULL. */
static inline bool narc_has_shape(const narc_shapes *shapes, uint32_t shape) {
    return shape < narc_count_shapes(shapes) && shapes->headers[shape].bound_radius > 0;
}

/* narc_add_shape_at() for a shape that is encoded. */
struct narc_encoded_shape;
narc_status narc_put_encoded_shape(narc_shapes *shapes, uint32_t shape, struct narc_encoded_shape *encoded,
                                   narc_error *error);

/* narc_add_shape() for a shape that is encoded. */
narc_status narc_share_encoded_shape(narc_shapes *shapes, struct narc_encoded_shape *encoded, uint32_t *out_shape,
                                     narc_error *error);

/* Room for so many shapes in all, with so many more records; `fronts`: and for pieces of chains among them. */
narc_status narc_make_room(narc_shapes *shapes, size_t count, size_t records, bool fronts);

/* Makes indices that were never given out, from narc_count_shapes() to below `count`, those of removed shapes; there is
 * room for them. The lowest is the one that was removed last. */
void narc_open_indices(narc_shapes *shapes, size_t count);

/* The arcs of a shape, header->count of them. */
static inline const narc_record *narc_arcs_of(const narc_shapes *shapes, const narc_shape_header *header) {
    return &shapes->records[header->first_record + narc_angle_records(header->count)];
}

#endif
