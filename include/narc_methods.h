/* SPDX-License-Identifier: MIT
 *
 * narc_methods.h - other ways to answer: published algorithms for comparison, and simple shapes as filters.
 *
 * The mental model
 *
 *   narc.h answers exactly, by the method "sat". The methods here work on the same bodies and pairs, and give answers
 *   of the same form; each has limits, which are part of its description. They run on the instruction set that narc
 *   uses and on any number of threads, with the same bits, as those of narc.h do. None of them looks at circles first:
 *   what is measured is the algorithm.
 *
 *   They are a library of their own, narc_methods, which goes with the narc of exactly its version. What they need of
 *   shapes beside their arcs, boxes and centroids, is in an object that is made from a store.
 *
 *   "The paper" is "Using Piecewise Circular Curves as a 2D Collision Primitive".
 *
 * Example
 *
 *     narc_methods *methods;
 *     narc_create_methods(shapes, NULL, &methods, NULL);
 *     narc_method_options gjk = {.method = NARC_METHOD_GJK, .tolerance = 1e-3f};
 *     narc_find_contacts_by(methods, &bodies, &pairs, &gjk, NULL, rows, capacity, &found, NULL);
 *
 *   Options of zeros mean the exact method: the calls of narc.h.
 *
 * Every function here may be called from any number of threads at once, with NARC_METHODS_STACK_SIZE bytes of stack,
 * but for narc_refresh_methods() and narc_destroy_methods(), which need the object for themselves.
 */
#ifndef NARC_METHODS_H
#define NARC_METHODS_H

#include "narc.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of stack that a thread needs for a call of this library: GJK searches in many pairs at a time. */
#define NARC_METHODS_STACK_SIZE (320 * 1024)

/* A copy of a store's shapes, each with a box around it and its centroid: as much memory as the store has, and 32 bytes
 * for each shape more. */
typedef struct narc_methods narc_methods;

/* Makes one of a store, which must outlive it and not change meanwhile. `allocator` NULL: malloc and free. Errors:
 * NARC_ERROR_VERSION (this library and narc are not of the same version), NARC_ERROR_ARGUMENT (NULL; a store with pieces
 * of chains, which these methods do not know), NARC_ERROR_MEMORY, NARC_ERROR_COUNT (more arcs than the copy has room
 * for). `out_methods` is untouched then. */
NARC_API narc_status narc_create_methods(const narc_shapes *shapes, const narc_allocator *allocator,
                                         narc_methods **out_methods, narc_error *error);

/* Takes the store as it is now. After shapes were added, replaced or removed, queries are refused until then. On an
 * error (as narc_create_methods()) they still are. */
NARC_API narc_status narc_refresh_methods(narc_methods *methods, narc_error *error);

/* Frees it; NULL is fine. */
NARC_API void narc_destroy_methods(narc_methods *methods);

typedef enum narc_method {
    /* Exact: what narc.h does. The largest gap over all directions (separating axis theorem for arcs), found by a
     * directed search with proofs, and by walking both normal fans where there is none. No known failures. `tolerance`
     * and `iterations` mean nothing to it. */
    NARC_METHOD_SAT = 0,

    /* The paper's Algorithm 2 as its text reads: for all pairs of arcs in their order, is each centre in the cone of
     * the other arc, and does the vector between them point along the vector between the centroids (dot product)? The
     * first pair that passes decides: separation |u| - (r_i + r_j), normal u / |u|. O(m n).
     *   Wrong where several pairs pass, or none: separated shapes are called colliding (mostly flat and thin ones with
     *   centres far outside), depths are not the smallest, and a normal on a junction can fall between all cones. If no
     *   pair passes it answers "not colliding", separation +INFINITY, outcome NARC_OUTCOME_NONE. Straight edges have no
     *   arcs, so shapes with edges often end there. */
    NARC_METHOD_SAT_FIRST = 1,

    /* Polygons only (NARC_SHAPE_POLYGON): the separating axis test over the edge normals of both (the paper's Algorithm
     * 3, its indices put right), each against all vertices of the other, with early exit at the first gap that is
     * large enough (0 for overlaps, the margin for contacts). O(m n). Depth and normal are exact up to rounding. Of
     * polygons that are apart the separation is the largest gap along an edge normal: less than the distance where two
     * vertices are closest, and only a bound if the search ended early. A pair with another shape is an error. */
    NARC_METHOD_POLYGON_SAT = 2,

    /* Gilbert, Johnson and Keerthi's algorithm on support functions (the paper's Algorithm 4), for any two shapes:
     * boolean for overlaps; distance and closest points for contacts, and where bodies collide the expanding polytope
     * algorithm (EPA, van den Bergen 2001) after it for depth, normal and point. Ends when the separation is known
     * within `tolerance`; the separation told is the gap along the normal told, never more than the exact one. The
     * normal of curved shapes is within about the root of the tolerance, in radians. The closest points, half the
     * separation from the contact point along the normal, lie within the tolerance of both outlines.
     *   Pairs within some roundings of touching can go either way. Where `iterations` run out (NARC_OUTCOME_LIMIT) the
     *   depth may be too large: EPA needs many for shapes that are round and in one place. If they run out, or rounding
     *   ends the search, before a gap is found or a collision is known, the answer is "not colliding", separation 0. */
    NARC_METHOD_GJK = 3,

    /* Do the shapes' bounding circles, axis-aligned boxes, or oriented boxes overlap (the paper's figure 2; boxes by
     * their separating axes, Gottschalk, Lin and Manocha 1996)? As filters: they never say no where the shapes collide.
     * The oriented box is the smallest of those along a junction's normal; the axis-aligned one is the box around that
     * one as the body is turned, in world axes. It is wider than the shape's own, and only worth its price where shapes
     * are long and mostly lie along the axes. Circles and boxes have room for rounding, a few millionths of their size.
     * Overlaps only. */
    NARC_METHOD_CIRCLE = 4,
    NARC_METHOD_AABB = 5,
    NARC_METHOD_OBB = 6
} narc_method;

/* The method's name, as "sat", "sat-first", "polygon-sat", "gjk", "circle", "aabb", "obb"; NULL for any other value. */
NARC_API const char *narc_method_name(narc_method method);

/* How a method came to a pair's answer; the exact one always ends well. */
typedef enum narc_outcome {
    NARC_OUTCOME_DONE = 0,     /* the method ended as it should */
    NARC_OUTCOME_LIMIT = 1,    /* gjk: iterations ran out; the best that was found, "not colliding" if nothing was */
    NARC_OUTCOME_ROUNDING = 2, /* gjk: rounding left no way on before the tolerance was reached; the best found */
    NARC_OUTCOME_NONE = 3      /* sat-first: no pair of arcs passes the test */
} narc_outcome;

/* Most support points in one phase of gjk. */
#define NARC_MAX_ITERATIONS 128

#define NARC_DEFAULT_TOLERANCE 1e-4f

/* Which method, and how; {0}: the exact one.
 *   tolerance     gjk: the largest error of a separation, relative to the sum of both bounding radii, but for rounding,
 *                 which is up to 2 * NARC_ERROR_BOUND * (D + E_a + E_b) (narc.h); for EPA the paper's termination
 *                 threshold. 0: NARC_DEFAULT_TOLERANCE
 *   iterations    gjk: most support points of each phase, GJK and EPA; 0, or more than that: NARC_MAX_ITERATIONS. A
 *                 search that a cached simplex has led astray begins again without it
 *   out_outcomes  one narc_outcome for each pair of the batch; or NULL
 *   simplexes     gjk: a cache of one number for each pair of the batch, in and out, zeros at first: the simplex that a
 *                 pair's search ended with, which the next one starts from (a warm start). Its answers differ from a cold
 *                 start's, within the tolerance. Any value is safe. Pairs that are not asked of keep theirs, other
 *                 methods leave all alone, and so does an error other than NARC_ERROR_CAPACITY. Or NULL */
typedef struct narc_method_options {
    narc_method method;
    float tolerance;
    unsigned iterations;
    uint8_t *out_outcomes;
    uint32_t *simplexes;
    void *reserved[3]; /* NULL */
} narc_method_options;

/* narc_find_overlaps() by a method of choice; `query` as there.
 * Further errors: NARC_ERROR_ARGUMENT (no such method, a negative tolerance, the store has changed, polygon-sat and a
 * pair whose shape is not a polygon: `error` names them), NARC_ERROR_NOT_FINITE (tolerance). */
NARC_API narc_status narc_find_overlaps_by(const narc_methods *methods, const narc_bodies *bodies,
                                           const narc_pairs *pairs, const narc_method_options *options,
                                           const narc_query *query, uint64_t *out_bits, narc_error *error);

/* narc_find_contacts() by a method of choice: the contacts of all pairs whose separation, as the method finds it, is
 * less than the margin. Features and radii are those of the arcs that the method ended at. Further errors as
 * narc_find_overlaps_by(), and NARC_ERROR_ARGUMENT for a method that answers overlaps only. With margin 0, a pair is
 * reported exactly if narc_find_overlaps_by() with the same options, cached simplexes among them, sets its bit. */
NARC_API narc_status narc_find_contacts_by(const narc_methods *methods, const narc_bodies *bodies,
                                           const narc_pairs *pairs, const narc_method_options *options,
                                           const narc_query *query, narc_contact *out_rows, size_t capacity,
                                           size_t *out_count, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
