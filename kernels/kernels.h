/* SPDX-License-Identifier: MIT
 *
 * kernels.h - what the dispatcher sees of the kernels: one constant table for each instruction set. Internal.
 *
 * Kernels check nothing: arguments, indices and capacities are the caller's business (dispatch/api.c).
 */
#ifndef NARC_KERNELS_H
#define NARC_KERNELS_H

#include <stdbool.h>
#include <stddef.h>

#include "broad_phase.h"
#include "column.h"
#include "index.h"
#include "store.h"

/* Are pairs settled before they reach the deciding formula, and do rays share their way? Without shortcuts every pair goes
 * to it, every ray alone: the tests compare the two, bit for bit. */
#ifndef NARC_SHORTCUTS
#define NARC_SHORTCUTS 1
#endif

/* Are pairs with a circle answered by its form (box/circles.inl)? Not in modules for WebAssembly, which have to be small. */
#ifdef __wasm__
#define NARC_CIRCLE_FORMS 0
#else
#define NARC_CIRCLE_FORMS NARC_SHORTCUTS
#endif

/* What a batch call works on: pairs of a body of `a` and one of `b`, by their indices or, without, by the pair's own.
 * Asked of are pairs first .. first + count - 1 of the query's selection, or of all. */
typedef struct narc_batch {
    const narc_shapes *shapes;
    const narc_bodies *a, *b; /* the caller's, or `filled`: all columns are there but perhaps `scale` */
    const narc_pairs *pairs;
    const narc_query *query;
    size_t first, count;
    size_t asked;    /* how many pairs are selected */
    size_t row_size; /* of answers that are rows */
    size_t more_at;  /* of rows that are listed: NARC_MORE_AT() */
    bool of_casts;   /* does scene/casts.c ask? Then all columns are arrays of whole vectors, pair k has body k of both
                        sets, and runs of chains are whole shapes, of which what lies behind touches, too */
    float flat_sine; /* of manifolds: the sine of the flat angle; below 0: no second points */
    narc_bodies filled[2];
} narc_batch;

typedef struct narc_row_list {
    uint32_t first, room, count;
} narc_row_list;

/* Where a call's rows go: `base` is the place of its first one; of dense rows, of that of the batch's first pair.
 *   more        Pairs with a concave arc can have several rows. The kernel writes the deepest one, and unless rows are
 *               dense adds how many there are besides to `more`, and writes it to the row, into the byte at `more_at`.
 *   lists       NULL, or it is asked of pairs with concave arcs alone, and lists all rows of each, at most NARC_MAX_ARCS, in
 *               the places that are that pair's. */
typedef struct narc_rows {
    char *base;
    ptrdiff_t stride;
    size_t *more;
    narc_row_list *lists;
} narc_rows;

/* That byte, of the member that counts: it adds NARC_MORE_ROW for each. */
enum { NARC_MORE_ROW = 256 };
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define NARC_MORE_AT(row, member) (offsetof(row, member) + sizeof(((row *)0)->member) - 2)
#else
#define NARC_MORE_AT(row, member) (offsetof(row, member) + 1)
#endif

/* What is kept of a pair of smooth shapes (NARC_SHAPE_SMOOTH), so that it is answered again without them, as long as the
 * shapes, their scales and the pair's order stay: two circles, at world scale but for the centre of B's, and when they
 * stand for the bodies (kernels/sat/follow.c). All zeros: nothing is known.
 *   spare     `only` needs it; -INFINITY: these circles hold the bodies, and say no more than that they are apart
 *   slack     what the shapes' extents add to it
 *   feature   the two features as in a row, and NARC_ENTRY_KNOWN
 *   normal    The normals at the ends of the arcs, start and end of A, then of B, in their shape's frame, turned inwards:
 *             x in the lower 16 bits and y in the upper ones. 0 where there are no ends. */
typedef struct narc_entry {
    float center_a[2], center_b[2];
    float radius_a, radius_b;
    float scale_b;
    float spare;
    float slack;
    uint32_t feature;
    uint32_t unused[2]; /* 0 */
    uint32_t normal[4];
} narc_entry;

#define NARC_ENTRY_KNOWN (1u << 16)

/* Of a manifold besides: the same normals as they are stored; zeros of circles. */
typedef struct narc_entry_ends {
    float start_a[2], end_a[2], start_b[2], end_b[2];
} narc_entry_ends;

/* What is kept of a row, so that it follows its bodies (kernels/sat/recycle.c): all in the frames of both bodies, without
 * their scale. Where an arc touches in one point the arc's centre is kept, so that the body may roll.
 *   rotation   of B in A's frame, as it was
 *   normal     in A's frame
 *   point      x, y on A, then on B; of the second point anything where there is none
 *   radius_a   what lies between these and the surface of A; and of B
 *   apart      the distance of the first point's two places, as it was
 *   lever      the smaller body's diameter
 * Of a pair without a row (normal 0): A's position, and which place of B lay there; apart is how far the bodies may move
 * against each other before there can be a row, and lever, below 0, less how far from A's position they may touch. */
typedef struct narc_kept_row {
    float rotation[2], normal[2];
    float point[2][4];
    float radius_a, radius_b, apart, lever;
} narc_kept_row;

/* One pair by itself. Of the batch the shapes are read and, of manifolds, the flat sine and the query's second margin. An
 * answer is a dense row, which is there without a contact, too. */
typedef struct narc_one_pair {
    const narc_batch *batch;
    const narc_body *a, *b;
    void *out_row;
    float margin;
    uint32_t number; /* in its batch */
    bool manifold;
} narc_one_pair;

/* The batch's number of the pair that is asked of at `place`. */
static inline size_t narc_pair_at(const narc_batch *batch, size_t place) {
    return batch->query->selection.base ? narc_index_at(batch->query->selection, place) : place;
}

/* Do pairs bring their own bodies, 2 k and 2 k + 1? In the sets of a batch those are k (dispatch/check.c). */
static inline bool narc_have_own_bodies(const narc_pairs *pairs) {
    return !pairs->a.base && !pairs->b.base && !pairs->other_bodies;
}

/* The caller's number of a pair's A or B, side 0 or 1. */
static inline size_t narc_body_at(const narc_pairs *pairs, int side, size_t pair) {
    const narc_index_column column = side == 0 ? pairs->a : pairs->b;
    return narc_have_own_bodies(pairs) ? 2 * pair + (size_t)side : column.base ? narc_index_at(column, pair) : pair;
}

/* What the box kernel works on. */
typedef struct narc_box_batch {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    float margin;
    narc_float_column motion_x, motion_y; /* base NULL: none */
    const narc_point *origin;             /* NULL: (0, 0) */
} narc_box_batch;

/* What the kernel of parts works on. */
typedef struct narc_part_batch {
    narc_bodies owners, parts;
    narc_index_column owner;
    narc_body *out;
} narc_part_batch;

/* What the kernels of points work on. */
typedef struct narc_point_batch {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_points *points;
    narc_index_column body;         /* of distances: the body of each point; base NULL: point k has body k */
    const narc_index *index;        /* of the nearest bodies: where they are looked for, */
    const narc_index_query *search; /* which of them, */
    float distance;                 /* how near they must be, */
    size_t most;                    /* and rows of each point, at least 1 */
    narc_distance *out;
} narc_point_batch;

/* What the kernel of rays works on. */
typedef struct narc_ray_batch {
    const narc_index *index;
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_rays *rays;
    const narc_ray_options *options;
    size_t most; /* rows of each ray, at least 1 */
    narc_ray_hit *out;
    narc_index_column body; /* of pairs: the body of each ray; base NULL: ray k has body k */
} narc_ray_batch;

/* What the kernel of regions works on. */
typedef struct narc_region_batch {
    const narc_index *index;
    const narc_box *boxes;
    const narc_index_query *query;
} narc_region_batch;

/* Where that kernel puts what it finds: the bodies of each query, in any order, behind those of the query before it. */
typedef struct narc_found_bodies {
    uint32_t *body;                                   /* those of this query */
    size_t count, room;                               /* how many there are, and room for them */
    void (*get_room)(struct narc_found_bodies *out);  /* for another NARC_REGION_ROOM at least */
    void (*end_query)(struct narc_found_bodies *out); /* `count` is all of this query; the next one begins */
} narc_found_bodies;

/* What a kernel may find in one go, with the lanes behind the last one. */
enum { NARC_REGION_ROOM = 16 * NARC_NODE_SLOTS + 16 };

/* So many bodies of a query, at most, the kernel puts into order. NARC_FOUND_PADDING more may be read. */
enum { NARC_ORDER_BODIES = 128 };

/* Of bodies that turn, by default: the part of the smaller bounding radius that a hit may be away from the target, at
 * most (scene/casts.c). */
#define NARC_TURNING_TOLERANCE 0x1p-10

/* What the kernel of casts works on: pairs of a batch, and the motions of A's and of B's bodies. Any pairs; of `nearest`
 * those of a mover follow each other, its row is the one with the number of A, and says whom it hits first; all such
 * rows are misses before. */
typedef struct narc_cast_batch {
    const struct narc_kernel_table *kernels; /* in use; few casts go to others, which ask its pair kernel */
    const narc_batch *batch;
    const narc_motions *motions[2];
    float target, tolerance, parting;
    narc_float_column targets; /* in place of `target`: one for each pair, or of `nearest` for each A, */
    narc_float_column depths;  /* unless these are there: of each pair, how deep at most it counts as at the start */
    bool nearest, front_only;
    narc_impact *out;
} narc_cast_batch;

/* One cast by itself, of shapes that are no pieces of chains. The row is that of `pair`, or of its mover (`nearest`), who may hit
 * `body`. */
typedef struct narc_one_cast {
    const narc_shapes *shapes;
    const narc_body *bodies[2];
    const narc_motion *motions[2];
    float target, tolerance;
    uint32_t pair, body;
    bool nearest;
    narc_impact *out_row;
} narc_one_cast;

/* The most pairs that one call for rows takes. */
enum { NARC_ROW_GROUP = 1024 };

typedef struct narc_kernel_table {
    const char *isa;
#define NARC_KERNEL(type, name, parameters) type(*name) parameters;
#include "kernels.def"
} narc_kernel_table;

/* Overlaps; contacts, manifolds and separations. */
typedef void narc_overlap_kernel(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                                 uint64_t *out_bits);
typedef size_t narc_row_kernel(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                               const narc_rows *out);

#define NARC_ISA(name, needs, processors, flags) extern const narc_kernel_table narc_kernels_##name;
#include "isa.def"

/* Within the kernels of an instruction set, what it calls its own: of avx2, NARC_NAMED(contact) is narc_contact_avx2. The
 * pair kernel's vectors are others, so that its functions have names of their own, too. */
#ifdef NARC_ONE_PAIR
#define NARC_NAMED(name) NARC_ISA_SYMBOL(narc_##name##_of_one_, NARC_ISA_NAME)
#else
#define NARC_NAMED(name) NARC_ISA_SYMBOL(narc_##name##_, NARC_ISA_NAME)
#endif
#define NARC_ISA_SYMBOL(prefix, isa) NARC_ISA_JOIN(prefix, isa)
#define NARC_ISA_JOIN(prefix, isa)   prefix##isa
#define NARC_ISA_TEXT(isa)           NARC_ISA_QUOTE(isa)
#define NARC_ISA_QUOTE(isa)          #isa

#ifdef NARC_ISA_NAME
#define NARC_KERNEL(type, name, parameters) type NARC_ISA_SYMBOL(narc_##name##_, NARC_ISA_NAME) parameters;
#include "kernels.def"
#endif

/* A table of an instruction set, NULL if this build does not have it: cmake/isa.cmake defines NARC_BUILT_<name> as 1 or
 * 0 for each. */
#define NARC_ISA_TABLE(built, table)  NARC_ISA_TABLE_(built, table)
#define NARC_ISA_TABLE_(built, table) NARC_ISA_TABLE_##built(table)
#define NARC_ISA_TABLE_1(table)       &table
#define NARC_ISA_TABLE_0(table)       NULL

/* The kernels for so many items. A few are asked one by one, by plain C, or where that is not built, those in use: with one
 * lane in use a vector takes twice to three times as long. The bits are the same. */
enum { NARC_FEW = 2 };
#define NARC_KERNELS_FOR_FEW_(built, kernels) NARC_KERNELS_FOR_FEW_##built(kernels)
#define NARC_KERNELS_FOR_FEW(built, kernels)  NARC_KERNELS_FOR_FEW_(built, kernels)
#define NARC_KERNELS_FOR_FEW_1(kernels)       (&narc_kernels_scalar)
#define NARC_KERNELS_FOR_FEW_0(kernels)       (kernels)
#define NARC_KERNELS_FOR(count, kernels)                                                                               \
    ((count) <= NARC_FEW ? NARC_KERNELS_FOR_FEW(NARC_BUILT_scalar, kernels) : (kernels))

#endif
