/* SPDX-License-Identifier: MIT
 *
 * narc.h - how the kernels are called: batches of pairs of bodies in, collisions and contacts out.
 *
 * The mental model
 *
 *   narc_shapes.h says what shapes, bodies and pairs are. A batch call takes all three, and answers for every pair,
 *   exactly: the shapes collide when no direction separates them, and the separation is the largest gap over all
 *   directions. There is no approximation and no iteration tolerance. Three forms of answer:
 *
 *       narc_find_overlaps()   one bit per pair
 *       narc_find_contacts()   a compacted list: separation, normal, point and arcs of the pairs that collide
 *       narc_find_manifolds()  the same for solvers: one or two points a pair, with ids that carry impulses over
 *
 *   narc_find_contact() is for one pair, without a batch.
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
 *       let narc_validate_bodies() say why. (narc_query_contacts() with query {.out_skipped = &skipped} is
 *       narc_find_contacts(); for a sub-range move the bases of the pairs' columns.)
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
 *     uint64_t hits[NARC_BIT_WORDS(5000)];
 *
 *     narc_bodies bodies = {.count = 1000,
 *         .x = NARC_POSITION_COLUMN(body, x), .y = NARC_POSITION_COLUMN(body, y),
 *         .cosine = NARC_COLUMN(body, c), .sine = NARC_COLUMN(body, s), .shape = NARC_COLUMN(body, shape)};
 *     narc_pairs pairs = {.count = 5000, .a = NARC_COLUMN(pair, a), .b = NARC_COLUMN(pair, b)};
 *     narc_find_overlaps(shapes, &bodies, &pairs, 0, hits, NULL);
 *
 * Every function here may be called from any number of threads at once, with NARC_STACK_SIZE bytes of stack.
 */
#ifndef NARC_H
#define NARC_H

#include "narc_shapes.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NARC_VERSION_MAJOR 0
#define NARC_VERSION_MINOR 2
#define NARC_VERSION_PATCH 0

/* "0.2.0". */
NARC_API const char *narc_version(void);

/* The number of 64-bit words that hold `count` bits. */
#define NARC_BIT_WORDS(count) (((count) + 63) / 64)

/* See "Precision" above; derived in kernels/sat/normal_fan.inl. */
#define NARC_ERROR_BOUND (32.0 / 16777216.0)

/* ------------------------------------------------------------------------------------------------ batches */

/* Which pairs collide? Bit k % 64 of out_bits[k / 64] is set if pair k does; the bits behind the last pair are 0.
 *   out_bits   NARC_BIT_WORDS(pairs->count) words, overlapping none of the inputs
 *   threads    how many to use at most; 0: as OpenMP would; 1: the calling thread, without OpenMP. Never more than 256,
 *              and a build without OpenMP always uses one.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, too many pairs),
 * NARC_ERROR_INDEX (`error` names the pair and the body or the shape), NARC_ERROR_ISA_UNKNOWN,
 * NARC_ERROR_ISA_UNSUPPORTED (NARC_ISA is set to something that can't be had). No pairs: NARC_OK. Allocates nothing. */
NARC_API narc_status narc_find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                        unsigned threads, uint64_t *out_bits, narc_error *error);

/* The same for pairs first .. first + count - 1, in the calling thread, for callers that have their own job system:
 * `first` is a multiple of 64, and so is `count` unless the sub-range is the last. `out_bits` is that of the whole
 * batch; only the words of the sub-range are written. */
NARC_API narc_status narc_find_overlaps_range(const narc_shapes *shapes, const narc_bodies *bodies,
                                              const narc_pairs *pairs, size_t first, size_t count, uint64_t *out_bits,
                                              narc_error *error);

/* The contacts of all pairs whose separation is less than `margin`, in the order of the pairs.
 *   margin        0: the pairs that collide. Above 0: also those that are closer than that (speculative contacts).
 *                 Below 0: only those that are deeper. +INFINITY: every pair, so that contact k is that of pair k; one
 *                 that has no answer (see narc_bodies) has separation +INFINITY and all else 0. NaN is an error.
 *   out_contacts  arrays of out_contacts->capacity items, overlapping none of the inputs
 *   out_count     the number of contacts found, which may be more than the capacity: then the first `capacity` of
 *                 them are written and NARC_ERROR_CAPACITY is returned.
 * Other errors and `threads` as narc_find_overlaps(). With margin 0 a pair is reported exactly if its bit there is
 * set. */
NARC_API narc_status narc_find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                        float margin, unsigned threads, const narc_contacts *out_contacts,
                                        size_t *out_count, narc_error *error);

/* The same, faster where bodies have moved little since the last call: each pair leaves a hint that the next call
 * starts from.
 *   hints      pairs->count values, hint k that of pair k, in and out, overlapping nothing else; zeros at first. What
 *              they mean is the library's business. Any value is safe: a hint that is stale, or made up, or another
 *              pair's, costs time and changes no bit of the answer.
 * On an error other than NARC_ERROR_CAPACITY hints are untouched. */
NARC_API narc_status narc_find_contacts_hinted(const narc_shapes *shapes, const narc_bodies *bodies,
                                               const narc_pairs *pairs, float margin, unsigned threads, uint32_t *hints,
                                               const narc_contacts *out_contacts, size_t *out_count, narc_error *error);

/* narc_find_contacts() for pairs first .. first + count - 1 (any first and count), in the calling thread. The list
 * starts at item 0 of out_contacts; `pair` still counts from the start of the batch. */
NARC_API narc_status narc_find_contacts_range(const narc_shapes *shapes, const narc_bodies *bodies,
                                              const narc_pairs *pairs, size_t first, size_t count, float margin,
                                              const narc_contacts *out_contacts, size_t *out_count, narc_error *error);

/* narc_find_contacts_hinted() for a sub-range, as narc_find_contacts_range(). `hints` is that of the whole batch; only
 * those of the sub-range are read and written. */
NARC_API narc_status narc_find_contacts_hinted_range(const narc_shapes *shapes, const narc_bodies *bodies,
                                                     const narc_pairs *pairs, size_t first, size_t count, float margin,
                                                     uint32_t *hints, const narc_contacts *out_contacts,
                                                     size_t *out_count, narc_error *error);

/* What a batch call may take and tell beside its answers; {0}: nothing.
 *   hints        as in narc_find_contacts_hinted(), of contacts only; NULL: none
 *   out_skipped  how many pairs have no answer (see narc_bodies), set where out_bits or out_count are; NULL: nobody
 *                asks */
typedef struct narc_query {
    uint32_t *hints;
    size_t *out_skipped;
} narc_query;

/* narc_find_overlaps() and narc_find_contacts() with a query. */
NARC_API narc_status narc_query_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                         const narc_query *query, unsigned threads, uint64_t *out_bits,
                                         narc_error *error);
NARC_API narc_status narc_query_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                         const narc_query *query, float margin, unsigned threads,
                                         const narc_contacts *out_contacts, size_t *out_count, narc_error *error);

/* ------------------------------------------------------------------------------------------------ manifolds */

/* The flat angle, in radians, if a call names none: 26 degrees. With it piles of boxes and rounded boxes come to rest,
 * and with less than a degree they do not. */
#define NARC_FLAT_ANGLE 0.45f

/* The largest flat angle, in radians. An edge that is nearly along the normal has no height across it. */
#define NARC_MAX_FLAT_ANGLE 1.5f

/* How narc_find_manifolds() answers; what is 0 or NULL has its default, as all has for {0}.
 *   margin         as in narc_find_contacts(), of the deepest point
 *   second_margin  that of the other point, where it is larger: a box that tips meets its second point in time; 0: none
 *   flat_angle     how far an edge's normal may be from the contact's for the edge to count as facing the other body; 0:
 *                  NARC_FLAT_ANGLE; below 0: never a second point; at most NARC_MAX_FLAT_ANGLE
 *   hints          as in narc_find_contacts_hinted(), which may take them from here and the other way round; NULL: none
 *   out_skipped    how many pairs had no answer; NULL: nobody asks */
typedef struct narc_manifold_options {
    float margin;
    float second_margin;
    float flat_angle;
    uint32_t *hints;
    size_t *out_skipped;
} narc_manifold_options;

/* The contact manifolds of all pairs whose separation is less than the margin, in the order of the pairs: what a solver
 * wants. One point is the deepest: its normal and separation are those of narc_find_contacts() to the last bit, and so
 * is its place unless two edges touch along a stretch. There is a second point where both bodies have a straight edge
 * that faces the other one, next to the arc that touches or itself touching: at the other end of the edges' common
 * stretch, with its own separation along the normal, if that is less than its margin. Swapping A and B turns the
 * normal, the order of the points, and the bytes of a feature id, and nothing else but roundings.
 *   options         NULL: defaults
 *   out_manifolds   arrays of out_manifolds->capacity items, overlapping none of the inputs
 *   out_count       as in narc_find_contacts()
 * Feature ids tell which features lie at a point, and nothing of who is larger or was found first, of the flat angle or
 * of the other point; so of the same pair at the next step, the same id means the same point (a solver's warm start),
 * and a point keeps its id as long as the same features touch there. docs/algorithm.md, section 11, derives all this.
 * Errors and `threads` as narc_find_contacts(), and NARC_ERROR_ARGUMENT and NARC_ERROR_NOT_FINITE for options out of
 * range. Allocates nothing. Thread-safe. */
NARC_API narc_status narc_find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                         const narc_manifold_options *options, unsigned threads,
                                         const narc_manifolds *out_manifolds, size_t *out_count, narc_error *error);

/* The same for pairs first .. first + count - 1 (any first and count), in the calling thread, as
 * narc_find_contacts_range(); options->hints is that of the whole batch. */
NARC_API narc_status narc_find_manifolds_range(const narc_shapes *shapes, const narc_bodies *bodies,
                                               const narc_pairs *pairs, size_t first, size_t count,
                                               const narc_manifold_options *options,
                                               const narc_manifolds *out_manifolds, size_t *out_count,
                                               narc_error *error);

/* ------------------------------------------------------------------------------------------------ one pair */

/* The contact of two bodies, near or far: whether they collide (separation below 0), how far apart they are, and where.
 *
 *     narc_contact contact;
 *     narc_body a = {.shape = box}, b = {.x = 1.5, .angle = 0.5f, .shape = capsule};
 *     narc_find_contact(shapes, &a, &b, &contact, &error);
 *
 * It has the bits that narc_find_contacts() finds with margin +INFINITY, and costs some hundred nanoseconds on any
 * instruction set; of many pairs in one batch each costs a tenth of that. Bodies further apart than NARC_MAX_DISTANCE
 * have separation +INFINITY, and all else 0. Errors: NARC_ERROR_ARGUMENT (NULL), those of narc_validate_bodies() (A is
 * body 0, B body 1), with an angle those of narc_compute_poses(). Outputs are untouched then. Allocates nothing.
 * Thread-safe. */
NARC_API narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                                       narc_contact *out_contact, narc_error *error);

/* The contact manifold of two bodies, with the bits that narc_find_manifolds() finds; without points, and all 0, if the
 * separation is not less than the margin. With margin +INFINITY that of bodies further apart than NARC_MAX_DISTANCE has
 * separation[0] +INFINITY, no points, and all else 0. `options` as there; options->hints is one value. Errors as
 * narc_find_contact(), and those of the options. */
NARC_API narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                                        const narc_manifold_options *options, narc_manifold *out_manifold,
                                        narc_error *error);

/* ------------------------------------------------------------------------------------------------ poses */

/* Cosines and sines of `count` angles, in radians, within 1 ulp of exact, in the calling thread. Outputs may be
 * the input's array, not otherwise overlap it or each other. An angle that is not finite gives NaN, and so a body that
 * collides with nothing. Uses SLEEF's deterministic functions: the bits are the same in all builds with
 * the same version of it. In builds without SLEEF they are always the same. */
NARC_API narc_status narc_compute_poses(const float *angles, size_t count, float *out_cosines, float *out_sines,
                                        narc_error *error);

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

/* How many threads `threads` = 0 means now; 1 in a build without OpenMP. */
NARC_API unsigned narc_default_threads(void);

#ifdef __cplusplus
}
#endif

#endif
