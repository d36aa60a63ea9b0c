/* SPDX-License-Identifier: MIT
 *
 * narc_pairs.h - what a question is about and how it is answered: bodies, pairs, a query, rows; boxes and lists of pairs.
 *
 * Input structs end in reserved pointers, which must be NULL: later versions may give them a meaning, so that a program
 * that was compiled before goes on to work.
 */
#ifndef NARC_PAIRS_H
#define NARC_PAIRS_H

#include "narc_shapes.h"
#include "narc_workers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ bodies and pairs */

/* How far cosine^2 + sine^2 may be from 1. */
#define NARC_ROTATION_TOLERANCE (1.0 / 2048)

/* Bodies: `count` of each column. The place of a shape's point p is (x, y) + scale * [cosine -sine; sine cosine] p.
 * cosine^2 + sine^2 must be 1 within NARC_ROTATION_TOLERANCE; the kernels remove the rest, so that a rotation may
 * drift a little. A body with a NaN or an infinity, with another cosine and sine, with a scale that is not positive or
 * takes the shape out of NARC_MIN_SIZE .. NARC_MAX_SIZE, or with a shape that was removed, collides with nothing: it is
 * broken. At the limits roundings of single precision decide, in all calls alike. A pair with such a body, or with two
 * bodies further apart than NARC_MAX_DISTANCE, has no answer; queries count these (narc_query.out_skipped).
 * narc_compute_boxes() gives a broken body an empty box, so that it is in no pair that is found from boxes: there it is
 * narc_box_options.out_skipped that counts.
 *
 * Columns may lie anywhere. Batches of pairs are read fastest where what belongs to a body lies in a row: x, y, cosine
 * and sine, all float; or as in narc_body. */
typedef struct narc_bodies {
    size_t count;
    narc_position_column x, y; /* both float or both double */
    narc_float_column cosine, sine;
    narc_float_column scale; /* base NULL: all 1 */
    narc_index_column shape; /* in the store */
    void *reserved[2];       /* NULL */
} narc_bodies;

/* A body as a row in the form that is read fastest; bodies may as well lie in any other. */
typedef struct narc_body {
    double x, y;
    float cosine, sine; /* not turned: 1, 0 */
    float scale;        /* 1 */
    uint32_t shape;
} narc_body;

/* Columns of such rows, whose memory the caller keeps; without rows (NULL) all is 0. `out_bodies` NULL: nothing happens. */
NARC_API void narc_view_bodies(const narc_body *rows, size_t count, narc_bodies *out_bodies);

/* Are all bodies what the kernels expect? Batch calls check indices only; this checks every number: shapes that exist,
 * no NaN or infinity, rotations within NARC_ROTATION_TOLERANCE, and sizes in range. The message names the body
 * and the quantity, and error->index is the first such body. Errors: NARC_ERROR_ARGUMENT (NULL, not a rotation),
 * NARC_ERROR_INDEX, NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE. Thread-safe. */
NARC_API narc_status narc_validate_bodies(const narc_shapes *shapes, const narc_bodies *bodies, narc_error *error);

/* The outline of a shape, or of a chain (narc_chains.h), as a polyline: for drawing, and for programs that know no arcs. Points are
 * in the order of the arcs, edges join them, and neither is further from the other than `tolerance`, but for the rounding of
 * doubles.
 *   arcs         of a shape, as narc_get_arcs() has them, or a chain's, with the signs of their radii; angles as there
 *   closed       a shape, or a closed chain: the last point is not the first one again; the caller joins them
 *   body         where points are wanted, its shape means nothing; NULL: in the arcs' own axes
 *   tolerance    above 0, in the points' unit
 *   out_points   room for `capacity`. Points that are one up to 1/1024 of the tolerance are there once
 *   out_count    how many; on NARC_ERROR_CAPACITY so many as surely are enough, and no points are written
 * So an arc with the radius r and the sweep s has some s * sqrt(r / (8 * tolerance)) chords. Other errors, with nothing written:
 * NARC_ERROR_ARGUMENT (NULL, a tolerance of 0 or less, a broken body), NARC_ERROR_NOT_FINITE, NARC_ERROR_SWEEP. Thread-safe; the
 * same bits on every machine. */
NARC_API narc_status narc_flatten_arcs(const narc_arc *arcs, size_t count, bool closed, const narc_body *body,
                                       double tolerance, narc_point *out_points, size_t capacity, size_t *out_count,
                                       narc_error *error);

/* Pairs of bodies, by index. Both may name the same body (it collides with itself).
 *   a, b              bodies. Both left out (base NULL): a pair brings its own poses, pair k is bodies 2k and 2k + 1.
 *                     Of two sets one may be left out, too: pair k has body k of it
 *   other_bodies      the set that `b` names bodies of, such as those that never move; NULL: that of `a`, the call's
 *   shift_x, shift_y  world axes; added to the position of B, in double precision: for periodic images; left out: 0
 * A set of which x, y, cosine and sine are all left out stands at the origin, not turned (to queries only): so the
 * poses of B in the frames of A, and shapes by pair, are a set of B's poses, and one for A that has shapes only. A pair
 * with a NaN in its shift, or an infinity, has no answer, as one with a broken body. */
typedef struct narc_pairs {
    size_t count; /* at most UINT32_MAX */
    narc_index_column a, b;
    const narc_bodies *other_bodies;
    narc_float_column shift_x, shift_y;
    void *reserved[2]; /* NULL */
} narc_pairs;

/* Copies the bodies of pairs to the caller's arrays, of lists above all that belong to the library: those of
 * narc_query_index(), and narc_step_result.pairs by its `order`, `touching` and the like.
 *   selection     which pairs, `count` indices of them, in this order; NULL: the first `count`
 *   out_a, out_b  `count` items each, overlapping none of the inputs; out_b may be NULL: nobody asks
 *   stride        bytes from an item to the next, of both, as in narc_find_pairs(); 0: no gaps
 * Errors, found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer or column is NULL, a stride that is no
 * multiple of 4), NARC_ERROR_INDEX (an index, or `count`, beyond the pairs). */
NARC_API narc_status narc_copy_pairs(const narc_pairs *pairs, const uint32_t *selection, size_t count, uint32_t *out_a,
                                     uint32_t *out_b, ptrdiff_t stride, narc_error *error);

/* ------------------------------------------------------------------------------------------------ queries */

/* The flat angle, in radians, if a query names none: 26 degrees. With it piles of boxes and rounded boxes come to rest,
 * and with less than a degree they do not. */
#define NARC_FLAT_ANGLE 0.45f

/* The largest flat angle, in radians. An edge that is nearly along the normal has no height across it. */
#define NARC_MAX_FLAT_ANGLE 1.5f

/* How a batch is asked. What is 0 or NULL has its default, as all has for {0}; a query that is NULL is {0}.
 *
 *   margin            which pairs have a contact: those whose separation is less. 0: the pairs that collide. Above 0:
 *                     also those that are closer than that (speculative contacts). Below 0: only those that are deeper.
 *                     +INFINITY: every pair, also those without an answer (see narc_bodies), which have count 0 and
 *                     separation +INFINITY. Overlaps have no margin.
 *   margins           one for each pair instead. A pair with a NaN there has no answer
 *   second_margin     manifolds: the margin of the point that is not the deepest, where it is larger: a box that tips
 *                     meets its second point in time; 0: that of all
 *   flat_angle        manifolds: how far an edge's normal may be from the contact's for the edge to count as facing the
 *                     other body; 0: NARC_FLAT_ANGLE; below 0: never a second point; at most NARC_MAX_FLAT_ANGLE
 *   selection         the pairs to ask of, `selection_count` indices of pairs, each at most once, so no more than there
 *                     are pairs (NARC_ERROR_ARGUMENT); left out ({0}, base and stride): all. So what NARC_ARRAY() makes
 *                     of an empty container asks of none. Margins, rows' numbers and dense rows stay those of the
 *                     whole batch; rows are listed in the order of the selection, and bit k of overlaps is that of pair
 *                     selection[k]
 *   first, count      a sub-range of the pairs, or of the selection; count 0: to the end. Of overlaps `first` is a
 *                     multiple of 64, and so is `count` unless it reaches to the end; only its words are written
 *   dense             contacts and manifolds: row k is that of pair k, with count 0 where there is nothing, and there
 *                     must be room up to the last pair that is asked of (of a selection, up to the batch's last). Rows
 *                     of pairs that are not asked of are untouched
 *   row_stride        bytes from a row to the next, for rows within larger structures: a multiple of 4, with room for a
 *                     row; below 0 they go backwards, from the one at out_rows; 0: no gaps
 *   workers           threads to use; NULL: the calling one. Lists are made by several only as far as they have room
 *                     for a row for each pair
 *   out_skipped       how many pairs have no answer (see narc_bodies); NULL: nobody asks. Set where answers are
 *   front_only        not 0: a body deeper in a piece of a chain than the centre of its bounding circle, which is then
 *                     behind the piece, has no contact with it: so it jumps up through a platform, and lands on it */
typedef struct narc_query {
    float margin;
    float second_margin;
    float flat_angle;
    uint32_t dense;
    narc_float_column margins;
    narc_index_column selection;
    size_t selection_count;
    size_t first, count;
    ptrdiff_t row_stride;
    const narc_workers *workers;
    size_t *out_skipped;
    uint32_t front_only;
    void *reserved[5]; /* NULL */
} narc_query;

/* ------------------------------------------------------------------------------------------------ rows */

/* What a query answers, one row for each pair. Rows have the same bytes on every platform but for the order of bytes in
 * a number. */

/* A contact.
 *   pair        the index of the pair in the batch
 *   feature     what touches: of A in the low byte, of B in the high one. Bits 0 to 5: an arc in the caller's
 *               numbering, or, with NARC_FEATURE_EDGE, an edge: number i is the one before arc i
 *   count       1; 0: none, and all else but `pair` 0 (see narc_query.dense); or with a margin of +INFINITY no answer,
 *               and separation +INFINITY
 *   separation  signed distance between the bodies, negative: penetration depth
 *   normal      unit, from A to B, world axes. Where corners, or the centres of round ones, lie in one place up to
 *               rounding, the normal of an edge beside them, if one's gap is as large but for the error bound
 *   point       halfway between the two surfaces where they are closest (or deepest), in world axes, relative to the
 *               position of body A, so that it is precise in a large world; where two edges touch along a stretch,
 *               the middle of that stretch. The point less half the separation along the normal lies on A, and plus
 *               that on B: the closest points, or the deepest. They are within 1.5 times the separation's error bound.
 *   radius_a    radius of curvature of A where it touches, scaled: 0 at a corner, INFINITY on an edge. And of B
 * A concave arc of a chain (narc_chains.h) has its radius below 0, so that 1/radius_a + 1/radius_b is how much the
 * two outlines are curved against each other; the bottom of a valley has -0. With such an arc a pair has a contact
 * for each arc of the other body that touches: rows that follow each other, counter-clockwise by the outward normal
 * of the concave arc. Dense rows know only the deepest, or nothing. Pairs with a piece have a row only
 * where they touch within the margin, also an infinite one. */
typedef struct narc_contact {
    uint32_t pair;
    uint16_t feature;
    uint16_t count;
    float separation;
    float normal_x, normal_y;
    float point_x, point_y;
    float radius_a, radius_b;
} narc_contact;

/* A point of a manifold.
 *   x, y        halfway between both surfaces along the normal, in world axes, relative to the position of body A
 *   separation  along the normal
 *   feature     what lies there, as in narc_contact. Where corners of both bodies lie side by side, up to 1/32 of an
 *               edge apart, both are named. The radius tells whether an edge, an arc or a corner touches. */
typedef struct narc_manifold_point {
    float x, y;
    float separation;
    uint32_t feature;
} narc_manifold_point;

/* A contact manifold, one cache line.
 *   pair      the index of the pair in the batch
 *   count     how many points it has, 1 or 2; 0: none, and all else but `pair` 0 (see narc_query.dense); or with a
 *             margin of +INFINITY no answer, and point[0].separation +INFINITY
 *   normal    unit, from A to B, world axes
 *   radius_a  radius of curvature of A, scaled, at the deepest point: 0 at a corner, INFINITY on an edge; at an edge's
 *             end that of the arc next to it; below 0 on a concave arc (see narc_contact). And of B
 *   reach_a   how far the normal may turn clockwise [0] and counter-clockwise [1] until it leaves the arc of A that it
 *             touches, where both stay in touch by rolling: the sine of that angle, of a quarter turn at most, times
 *             NARC_REACH_ONE, rounded down. An edge has none. And of B
 *   point     in the order along the normal turned a quarter turn counter-clockwise. One is the deepest: its separation
 *             is that of the contact. What is not there is 0. */
typedef struct narc_manifold {
    uint32_t pair;
    uint32_t count;
    float normal_x, normal_y;
    float radius_a, radius_b;
    uint16_t reach_a[2], reach_b[2];
    narc_manifold_point point[2];
} narc_manifold;

#define NARC_REACH_ONE 65535

#define NARC_FEATURE_EDGE 0x40

/* ------------------------------------------------------------------------------------------------ boxes */

/* An axis-aligned box, borders included. One with a NaN or an infinity in it, or with a minimum above its maximum, is
 * empty: it overlaps nothing. */
typedef struct narc_box {
    float min_x, min_y, max_x, max_y;
} narc_box;

/* Kinds of bodies, bits that may be combined; a body without them moves. What they mean for the pairs of two bodies:
 *
 *                                 a pair   tested
 *     moving and any              yes      yes
 *     asleep and asleep           yes      no: nothing changes between them
 *     asleep and static           yes      no
 *     static and static           never
 *     sensor and sensor           never
 *     sensor and any other        as above; whether they overlap
 *
 * Which pairs there are does not depend on sleep. So a pair keeps its place and what the caller knows of it while its
 * bodies sleep, and one that falls asleep or wakes begins and ends nothing. */
enum { NARC_STATIC = 1, NARC_ASLEEP = 2, NARC_SENSOR = 4 };

/* Which boxes may form a pair. Every column may be left out (base NULL); a NULL filter lets all boxes.
 *   kind             see the table above; left out: all move
 *   category, mask   a and b form a pair only if category a & mask b and category b & mask a are not 0. Left
 *                    out: all bits set.
 *   owner            two boxes of one owner form no pair: they are one thing, such as a machine, or a body of several
 *                    parts (narc_place_parts()). UINT32_MAX: a thing by itself; left out: all are. The same column tells
 *                    other questions what one thing is (narc_owners)
 *   world            any number: two boxes of different worlds form no pair, wherever they are, and take no time either; left
 *                    out: there is one world */
typedef struct narc_pair_filter {
    narc_byte_column kind;
    narc_word_column category, mask;
    narc_index_column owner;
    narc_index_column world;
} narc_pair_filter;

/* What finding pairs needs: memory, which grows to what the largest step wants and stays, so that after some steps nothing is
 * allocated. One object serves one call at a time. */
typedef struct narc_broad_phase narc_broad_phase;

/* One without memory yet. `allocator` NULL: malloc and free. NARC_ERROR_MEMORY, NARC_ERROR_ARGUMENT. */
NARC_API narc_status narc_create_broad_phase(const narc_allocator *allocator, narc_broad_phase **out_broad);

/* Frees it; NULL is fine. */
NARC_API void narc_destroy_broad_phase(narc_broad_phase *broad);

#ifdef __cplusplus
}
#endif

#endif
