/* SPDX-License-Identifier: MIT
 *
 * narc.h - how the kernels are called: batches of pairs of bodies in, collisions and contacts out.
 *
 * The mental model
 *
 *   narc_shapes.h says what shapes are, narc_pairs.h what bodies, pairs, queries and rows are. A batch call takes all
 *   three, and answers for every pair, exactly: the shapes collide when no direction separates them, and the separation
 *   is the largest gap over all directions. There is no approximation and no iteration tolerance. Four forms of answer:
 *
 *       narc_find_overlaps()     one bit per pair
 *       narc_find_separations()  one float per pair, for force laws, tolerances and distance fields
 *       narc_find_contacts()     a row for each pair that collides: separation, normal, point, features and curvatures
 *       narc_find_manifolds()    the same for solvers: one or two points a pair, with ids that carry impulses over
 *
 *   They share one narc_query, of which all may be left out. Two bodies alone are asked by narc_find_contact() and
 *   narc_find_manifold(), which leave out what only batches need.
 *
 *   Other algorithms, such as GJK and the paper's own, and filters by circles and boxes: narc_methods.h, a library of
 *   its own.
 *
 *   Which instruction set runs is chosen at the first call: the best that this build and this processor have. The
 *   environment variable NARC_ISA or narc_set_isa() choose another. The answer is the same to the last bit on
 *   every instruction set, with any number of threads and for any split of a batch.
 *
 * Broken bodies
 *
 *   A body with a NaN, or with cosine and sine that are no rotation, collides with nothing (see narc_bodies): it would
 *   fall through the floor without a word. Two checks find it:
 *     - narc_validate_bodies() when a scene is loaded, and in debug builds each step: names the body and the number
 *     - narc_query.out_skipped each step: how many pairs the query had no answer for, at no cost. Normally 0; if not,
 *       let narc_validate_bodies() say why.
 *
 * Precision
 *
 *   Positions are subtracted first, in double precision if they are double; everything else is single precision. With
 *   the extent E of a body = its largest |centre| + radius over its arcs, times its scale, and D the distance between
 *   the two positions, a separation is within NARC_ERROR_BOUND * (D + E_a + E_b) of the exact one, and `overlap` can be
 *   wrong only for pairs whose exact separation is closer to 0 than that. (Where a shape's arcs were given a little
 *   apart, see NARC_TOLERANCE, that much more is uncertain. Kernels expect the processor's usual state: rounding to
 *   nearest, denormal numbers not flushed to zero.)
 *
 *   E counts from the body's position, so of a shape that lies far from its own origin the bound leaves little: 1e5
 *   times its bounding radius away it is 0.4 of that radius, and at 2e7 times single precision knows no form any more.
 *   What does not depend on that: whatever a store accepts, `overlap` and `contact` agree on every pair, and the bits
 *   are the same everywhere.
 *
 * Example
 *
 *     struct body { float x, y, c, s; uint32_t shape; } body[1000];     (the engine's own)
 *     struct pair { uint32_t a, b; } pair[5000];
 *     narc_contact contact[5000];
 *     size_t found;
 *
 *     narc_bodies bodies = {.count = 1000,
 *         .x = NARC_POSITION_COLUMN(body, x), .y = NARC_POSITION_COLUMN(body, y),
 *         .cosine = NARC_COLUMN(body, c), .sine = NARC_COLUMN(body, s), .shape = NARC_COLUMN(body, shape)};
 *     narc_pairs pairs = {.count = 5000, .a = NARC_COLUMN(pair, a), .b = NARC_COLUMN(pair, b)};
 *     narc_find_contacts(shapes, &bodies, &pairs, NULL, contact, 5000, &found, NULL);
 *
 * Two bodies:
 *
 *     narc_body a = {.cosine = 1, .scale = 1, .shape = box}, b = {.x = 1.5, .cosine = 1, .scale = 1, .shape = lens};
 *     narc_contact contact;
 *     if (narc_find_contact(shapes, &a, &b, NULL, &contact, NULL) == NARC_OK && contact.count > 0) ...
 *
 * Every function here may be called from any number of threads at once, with NARC_STACK_SIZE bytes of stack.
 */
#ifndef NARC_H
#define NARC_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NARC_VERSION_MAJOR 0
#define NARC_VERSION_MINOR 3
#define NARC_VERSION_PATCH 0

/* "0.3.0". */
NARC_API const char *narc_version(void);

/* The number of 64-bit words that hold `count` bits. */
#define NARC_BIT_WORDS(count) (((count) + 63) / 64)

/* See "Precision" above; derived in kernels/sat/normal_fan.inl. */
#define NARC_ERROR_BOUND (32.0 / 16777216.0)

/* ------------------------------------------------------------------------------------------------ queries */

/* Which pairs collide? Bit k % 64 of out_bits[k / 64] is set if pair k does; the bits behind the last pair are 0.
 *   query      NULL: defaults
 *   out_bits   NARC_BIT_WORDS(pairs->count) words (of a selection, of its count), overlapping none of the inputs
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, too many pairs, a query
 * out of range), NARC_ERROR_NOT_FINITE (of a query), NARC_ERROR_INDEX (`error` names the pair and the body or the
 * shape), NARC_ERROR_ISA_UNKNOWN, NARC_ERROR_ISA_UNSUPPORTED (NARC_ISA is set to something that can't be had). No
 * pairs: NARC_OK. Allocates nothing. */
NARC_API narc_status narc_find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                        const narc_query *query, uint64_t *out_bits, narc_error *error);

/* How far apart are they? out_separations[k] is the separation of pair k, to the last bit that of its contact, of several
 * the deepest's; +INFINITY where narc_find_contacts() has none: a pair further apart than the margin, or without an answer.
 *   query            NULL: defaults, so only pairs that collide; margin = INFINITY: all. row_stride: from a float to the
 *                    next; `dense` and what is of manifolds do nothing
 *   out_separations  room up to the last pair that is asked of (of a selection, up to the batch's last), overlapping none
 *                    of the inputs; floats of pairs that are not asked of are untouched
 * Errors as narc_find_overlaps(). Allocates nothing. */
NARC_API narc_status narc_find_separations(const narc_shapes *shapes, const narc_bodies *bodies,
                                           const narc_pairs *pairs, const narc_query *query, float *out_separations,
                                           narc_error *error);

/* The contacts of all pairs whose separation is less than the margin, in the order of the pairs.
 *   query      NULL: defaults
 *   out_rows   room for `capacity` rows, overlapping none of the inputs. What lies behind the last one may be used,
 *              too, as far as there is room
 *   out_count  the number of contacts found, which may be more than the capacity: then the first `capacity` of them are
 *              written and NARC_ERROR_CAPACITY is returned. Dense rows: how many are contacts; a capacity that ends
 *              before the last pair is NARC_ERROR_CAPACITY with nothing written. No pair has more than one, but for
 *              those with a concave arc of a chain (narc_contact), which this thread lists after all others.
 * Fastest where there is room for a row for each pair that is asked of. Other errors as narc_find_overlaps(). With
 * margin 0 a pair is reported exactly if its bit there is set. Allocates nothing. */
NARC_API narc_status narc_find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                        const narc_query *query, narc_contact *out_rows, size_t capacity,
                                        size_t *out_count, narc_error *error);

/* The contact manifolds of all pairs whose separation is less than the margin, in the order of the pairs: what a solver
 * wants. One point is the deepest: its normal and separation are those of narc_find_contacts() to the last bit, and so
 * is its place unless two edges touch along a stretch. There is a second point where both bodies have a straight edge
 * that faces the other one, next to the arc that touches or itself touching: at the other end of the edges' common
 * stretch, with its own separation along the normal, if that is less than its margin. Swapping A and B turns the
 * normal, the order of the points, and the bytes of a feature id, and nothing else but roundings.
 *   query, out_rows, capacity, out_count   as in narc_find_contacts()
 * Feature ids tell which features lie at a point, and nothing of who is larger or was found first, of the flat angle or
 * of the other point; so of the same pair at the next step, the same id means the same point (a solver's warm start),
 * and a point keeps its id as long as the same features touch there. docs/algorithm.md, section 11, derives all this. */
NARC_API narc_status narc_find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                         const narc_query *query, narc_manifold *out_rows, size_t capacity,
                                         size_t *out_count, narc_error *error);

/* The contact or the manifold of two bodies, which is row 0, dense, of a batch of that pair, to the last bit: for engines'
 * own loops, editors and whatever asks one pair after the other, at a fraction of a batch's price.
 *   query     NULL: defaults. What counts of it is margin, second_margin, flat_angle, front_only and out_skipped
 *   out_row   is written in any case: count 0 where they are not closer than the margin (see narc_query.dense)
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, a query out of range),
 * NARC_ERROR_NOT_FINITE (of a query), NARC_ERROR_INDEX (a shape that is not there), and those for NARC_ISA. Allocates
 * nothing. */
NARC_API narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                                       const narc_query *query, narc_contact *out_row, narc_error *error);
NARC_API narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                                        const narc_query *query, narc_manifold *out_row, narc_error *error);

/* ------------------------------------------------------------------------------------------------ rows again */

/* A contact in double precision: separation, normal and point as in narc_contact. */
typedef struct narc_refined_contact {
    double separation;
    double normal_x, normal_y;
    double point_x, point_y;
} narc_refined_contact;

/* What a batch leaves out and rows are refined with. All of it may be left out: rotations, shifts and shapes are then as
 * the batch has them.
 *   arcs                       of each shape of the store (an array of narc_count_shapes() pointers) those that it was
 *                              made of, as many and in their order; NULL, or NULL of a shape: as the store has them, which
 *                              keeps the digits of a float
 *   cosine, sine               of bodies: columns as those of positions, which may be double
 *   other_cosine, other_sine   of pairs->other_bodies
 *   shift_x, shift_y           of pairs
 *   workers                    threads to use; NULL: the calling one */
typedef struct narc_refinement {
    const narc_arc *const *arcs;
    narc_position_column cosine, sine;
    narc_position_column other_cosine, other_sine;
    narc_position_column shift_x, shift_y;
    const narc_workers *workers;
    void *reserved[2]; /* NULL */
} narc_refinement;

/* Rows of narc_find_contacts() again, in double precision: for force laws, to which the roundings of single precision
 * are a noise. Row k of the answer is of row k, of the same bodies and pairs.
 *   refinement   NULL: {0}
 *   rows         `count` of them, in any order. A row without a contact (count 0) keeps its separation, and all else is 0
 *   out_rows     `count` rows, overlapping none of the inputs
 * What the features of a row touch is taken as it is: separation, normal and point are theirs, within some roundings of
 * double precision of both extents and the distance. Single precision chose the features: where others are as deep but for
 * NARC_ERROR_BOUND these may have been, so that the separation is within twice that bound of the exact one, and mostly
 * within 1e-14. Where the centres of two arcs, or two corners, lie in one place up to rounding, the normal stays the row's.
 * What is not finite is a row with separation +INFINITY and all else 0.
 * Errors, all found before anything is written: as narc_find_contacts() for bodies and pairs, NARC_ERROR_ARGUMENT (a row
 * or output is NULL, a reserved member is not, one column of a rotation without the other), NARC_ERROR_INDEX (`error` names the
 * row, and the pair, arc or edge that is not there). No rows: NARC_OK. Allocates nothing. */
NARC_API narc_status narc_refine_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                          const narc_refinement *refinement, const narc_contact *rows, size_t count,
                                          narc_refined_contact *out_rows, narc_error *error);

/* ------------------------------------------------------------------------------------------------ poses */

/* Cosines and sines of `count` angles, in radians, within 1 ulp of exact, in the calling thread. Outputs may be
 * the input's array, not otherwise overlap it or each other. An angle that is not finite gives NaN, and so a body that
 * collides with nothing. Uses SLEEF's deterministic functions: the bits are the same in all builds with
 * the same version of it. In builds without SLEEF they are always the same. */
NARC_API narc_status narc_compute_poses(const float *angles, size_t count, float *out_cosines, float *out_sines,
                                        narc_error *error);

/* ------------------------------------------------------------------------------------------------ compounds */

/* Where the parts of bodies are: a body of several shapes is an owner, which has a place, and a part for each shape,
 * which has one in its owner. A part's place in the world is its owner's position + scale * rotation * its own position;
 * rotations and scales are multiplied. The rows that come out are bodies, one for each part, and narc_view_bodies() of
 * them serve every question: a row of an answer names parts, and owner[part] is the body.
 *   owners      positions, cosines, sines, and scales if there are any; shapes are not looked at
 *   parts       in the same form, within their owners: positions, shapes; cosines and sines, both left out: not turned;
 *               scales, left out: 1. A body of one shape is a part at (0, 0) of its own
 *   owner       of each part the number of its owner
 *   workers     threads to use; NULL: the calling one
 *   out_bodies  parts->count rows, overlapping none of the inputs
 * Positions are computed in double precision, and rotations too, made to have length 1 first: then they are rounded. A
 * part that is not turned (sine 0, cosine above 0) has its owner's rotation to the bit. A broken part, or one of a broken
 * owner (see narc_bodies), is a row of zeros but for its shape, and so is one whose place or scale is out of range:
 * broken bodies, which queries skip and count as ever.
 *   Parts of one owner form no pair with this column in narc_pair_filter.owner, and are one thing to questions with it in
 * narc_owners. Parts come and go as bodies do: the last one into the gap, and narc_step.id tells which is which.
 * docs/questions.md has more.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (NULL, too many), NARC_ERROR_INDEX (`error` names
 * the part and the owner), and those for NARC_ISA. No parts: NARC_OK. Allocates nothing. Not in narc_small.wasm. */
NARC_API narc_status narc_place_parts(const narc_bodies *owners, const narc_bodies *parts,
                                      const narc_index_column *owner, const narc_workers *workers,
                                      narc_body *out_bodies, narc_error *error);

/* ------------------------------------------------------------------------------------------------ instruction sets */

/* Chooses the instruction set for all later calls in the process by its narc_isa_name(), such as "avx2" or "scalar";
 * NULL: the best one. NARC_ERROR_ISA_UNKNOWN, NARC_ERROR_ISA_UNSUPPORTED; the choice is unchanged then. */
NARC_API narc_status narc_set_isa(const char *name, narc_error *error);

/* The name of the instruction set in use (chosen now if it was not yet); NULL if NARC_ISA names one that can't be
 * had. */
NARC_API const char *narc_get_isa(void);

/* The instruction sets this library knows, best first: name number `index`, NULL behind the last. */
NARC_API const char *narc_isa_name(size_t index);

/* Can this build and this processor run it? False for a name that is not known. */
NARC_API bool narc_isa_supported(const char *name);

/* The kernels, which every instruction set has: name number `index`, NULL behind the last. */
NARC_API const char *narc_kernel_name(size_t index);

/* What the processor and the operating system offer, as far as this library asks: name number `index`, such as "avx2"
 * or "neon", NULL behind the last. */
NARC_API const char *narc_cpu_feature(size_t index);

#ifdef __cplusplus
}
#endif

#endif
