/* SPDX-License-Identifier: MIT
 *
 * narc_shapes.h - what the data is: arc shapes and their store.
 *
 * The mental model
 *
 *   An ARC SHAPE is a closed convex outline made of circular arcs, listed counter-clockwise. Arc i has a centre,
 *   a radius >= 0 and covers the outward normals from angle `start` to angle `end`. The end normal of an arc is the
 *   start normal of the next, so that all sweeps together make one full turn. Where the end point of one arc is not the
 *   start point of the next, a straight edge joins them. Everything convex and piecewise circular is an arc shape:
 *
 *       n-arc            arcs that follow each other without edges: the tangent is continuous
 *       circle           one arc, a full turn                 capsule          two half circles, two edges
 *       polygon          one arc of radius 0 at each vertex   rounded polygon  one arc at each vertex
 *
 *   Shapes live in a STORE (`narc_shapes`), laid out for the kernels. A BODY is a shape in a place: position, rotation
 *   and scale. Bodies and PAIRS of bodies stay in the caller's memory, in whatever layout they have there: every
 *   property is a column, a base pointer with a byte stride (narc_columns.h). Nothing is copied.
 *
 * Conventions, said once
 *
 *   Lengths are in the caller's unit; angles are in radians; everything is counter-clockwise, x right and y up.
 *   Normals are unit vectors and point from A to B. Separation is negative when two bodies penetrate; then its absolute
 *   value is the length of the smallest translation that separates them. Separation 0, touching, is not colliding.
 *   Functions return `narc_status`; outputs come last and are untouched on error. `narc_error *error` may be NULL.
 *   The library prints nothing, aborts nothing and keeps no errors in globals.
 *
 * Example
 *
 *     narc_shapes *shapes = NULL;
 *     narc_arc arcs[NARC_MAX_ARCS];
 *     size_t arc_count;
 *     uint32_t lens;
 *     narc_create_shapes(NULL, &shapes);
 *     narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &arc_count, NULL);
 *     narc_add_shape(shapes, arcs, arc_count, &lens, NULL);
 *     ...                                                          (see narc.h for collision queries)
 *     narc_destroy_shapes(shapes);
 */
#ifndef NARC_SHAPES_H
#define NARC_SHAPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "narc_columns.h"
#include "narc_export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ limits */

/* Most arcs in one shape. */
#define NARC_MAX_ARCS 64

/* Most shapes in one store (fewer if their arcs would not fit in 2^31 floats). */
#define NARC_MAX_SHAPES 0x7fffffffu

/* A shape's bounding radius, times a body's scale, must lie in this range (with the room for rounding that the kernels
 * add to it, 6e-6 of the largest |centre| + radius of its arcs): then every product in the kernels stays far from
 * overflow and underflow in single precision. Shapes outside it are refused, and those that reach further than
 * NARC_MAX_SIZE from their own origin; a body whose scale takes it outside never collides. */
#define NARC_MIN_SIZE 1e-9
#define NARC_MAX_SIZE 1e9

/* Two bodies further apart than this in x or y never collide, and their separation is +infinity. */
#define NARC_MAX_DISTANCE 1e17

/* An arc's radius may be at most this many times the shape's bounding radius. The error of a separation grows in
 * proportion to the largest radius, so an arc that is flatter than this is better given as a straight edge. */
#define NARC_MAX_RADIUS_RATIO 64.0

/* How far, relative to the bounding radius, a list of arcs may be from closed and convex before it is refused
 * (lengths), and how far apart two normals that should be one may be (radians). Arcs must turn by more than that.
 * Files with 7 digits pass, but for arcs with a radius above some 10 times the bounding radius, which need more. */
#define NARC_TOLERANCE 1e-5

/* Bytes of stack. A thread that has this much, for itself too, may call every function of narc_shapes.h, narc.h,
 * narc_chains.h, narc_scene.h and narc_broad_phase.h, and tasks of these calls run in it; OpenMP's own threads need as
 * much (OMP_STACKSIZE). Of a library that was compiled with optimisation and without sanitizers, by GCC or clang, which
 * leave some 4 KB of it.
 * (Other methods: NARC_METHODS_STACK_SIZE. narc_fit.h calls other libraries and needs what they need.) */
#define NARC_STACK_SIZE (64 * 1024)

/* ------------------------------------------------------------------------------------------------ status */

typedef enum narc_status {
    NARC_OK = 0,
    NARC_ERROR_ARGUMENT = 1,         /* a NULL pointer, a sub-range that does not fit, a negative count */
    NARC_ERROR_MEMORY = 2,           /* the allocator returned NULL */
    NARC_ERROR_INDEX = 3,            /* a body or shape index out of range */
    NARC_ERROR_CAPACITY = 4,         /* the output list is too short; the needed size is told */
    NARC_ERROR_COUNT = 5,            /* too few or too many points, arcs or shapes */
    NARC_ERROR_NOT_FINITE = 6,       /* NaN or infinity */
    NARC_ERROR_SIZE = 7,             /* a length is zero or negative, or outside NARC_MIN_SIZE .. NARC_MAX_SIZE */
    NARC_ERROR_RADIUS = 8,           /* a radius is negative, too large for its shape, or not feasible */
    NARC_ERROR_SWEEP = 9,            /* an arc turns by nothing or by more than half a turn; not one turn in all */
    NARC_ERROR_NOT_CLOSED = 10,      /* neighbouring arcs do not meet */
    NARC_ERROR_NOT_CONVEX = 11,      /* an edge runs backwards; points are not convex and counter-clockwise */
    NARC_ERROR_NOT_SIMPLE = 12,      /* a polygon crosses itself or encloses no area */
    NARC_ERROR_NO_SOLUTION = 13,     /* no n-arc has these junctions */
    NARC_ERROR_ISA_UNKNOWN = 14,     /* no instruction set has that name */
    NARC_ERROR_ISA_UNSUPPORTED = 15, /* known, but this build or this processor does not have it */
    NARC_ERROR_FORMAT = 16,          /* data that is not in the format it should be in, or damaged */
    NARC_ERROR_CANCELLED = 17,       /* the caller's progress function ended the work */
    NARC_ERROR_VERSION = 18,         /* libraries of narc that are of different versions */
    NARC_ERROR_IN_USE = 19           /* a shape that is used more than once, an index that has a shape */
} narc_status;

/* The name of a status, such as "NARC_ERROR_INDEX"; "unknown status" for any other value. Static storage. */
NARC_API const char *narc_status_name(narc_status status);

/* What went wrong, for a person to read. Filled only when a function returns an error. */
typedef struct narc_error {
    narc_status status;
    size_t index;      /* which arc, point, pair or body; 0 where that means nothing */
    double value;      /* the offending value; 0 where there is none */
    char message[192]; /* one line, no full stop, names the item and the quantity */
} narc_error;

/* ------------------------------------------------------------------------------------------------ arcs and builders */

typedef struct narc_point {
    double x, y;
} narc_point;

/* One arc: it covers the outward normals from angle `start` counter-clockwise to angle `end`. The sweep, end - start,
 * is more than NARC_TOLERANCE and at most pi; a circle alone is one arc with a sweep of 2 pi. A whole number of turns
 * may be added to both; `end` below `start` means that the arc passes the angle +-pi. Radius 0 is a vertex. */
typedef struct narc_arc {
    double center_x, center_y;
    double radius;
    double start, end;
} narc_arc;

/* Is a list of arcs a valid arc shape? Checks, in this order: the count (1 .. NARC_MAX_ARCS), that all is finite, that
 * no radius is negative, each sweep, that normals join and make one turn, that edges run forwards and have their
 * normal (closed, convex), the size, and the largest radius. A shape encloses some area, or is a segment: two arcs of
 * radius 0. The message names the arc and the quantity. Thread-safe. */
NARC_API narc_status narc_validate_arcs(const narc_arc *arcs, size_t count, narc_error *error);

/* Every builder below writes at most NARC_MAX_ARCS arcs to `out_arcs` (the caller's array of that size) and their
 * number to `out_count`; its arcs pass narc_validate_arcs(). On error both are untouched. All are pure and thread-safe.
 * Common errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE (lengths not positive), and
 * whatever narc_validate_arcs() finds, a radius above NARC_MAX_RADIUS_RATIO above all. */

/* A circle of `radius` around the origin. */
NARC_API narc_status narc_build_circle(double radius, narc_arc *out_arcs, size_t *out_count, narc_error *error);

/* A capsule along x around the origin: all points within `radius` of a segment of `length` >= 0. */
NARC_API narc_status narc_build_capsule(double length, double radius, narc_arc *out_arcs, size_t *out_count,
                                        narc_error *error);

/* All points within `radius` of the segment between two points: with radius 0 the segment itself, a shape without area
 * (two arcs of radius 0, each half a turn, and two edges); else a capsule between the points, which may be one. Arc 0
 * is at `to`, arc 1 at `from`. NARC_ERROR_SIZE: radius 0, and the points are one (or too near, NARC_MIN_SIZE). */
NARC_API narc_status narc_build_segment(const narc_point *from, const narc_point *to, double radius, narc_arc *out_arcs,
                                        size_t *out_count, narc_error *error);

/* A box around the origin, `width` by `height` outside measure, its corners rounded with `radius` >= 0 inside that box.
 * NARC_ERROR_RADIUS: the radius is more than half the shorter side. */
NARC_API narc_status narc_build_box(double width, double height, double radius, narc_arc *out_arcs, size_t *out_count,
                                    narc_error *error);

/* A convex polygon, `points[0 .. count-1]` counter-clockwise, each corner rounded inside the polygon with `radius`
 * >= 0: the shape never leaves the polygon and its sides lie on the polygon's. Corner i is arc i. (Box2D's radius is a
 * skin around the polygon: narc_build_skin_polygon().)
 * NARC_ERROR_COUNT: fewer than 3 or more than NARC_MAX_ARCS points. NARC_ERROR_NOT_CONVEX: a corner does not turn
 * left, or the polygon turns more than once. NARC_ERROR_RADIUS: two rounded corners do not fit on the side between
 * them (the message names the side and the largest radius that fits it). */
NARC_API narc_status narc_build_polygon(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                                        size_t *out_count, narc_error *error);

/* A convex polygon with a skin: all points within `radius` >= 0 of the polygon `points[0 .. count-1]`. Its sides are
 * those of the polygon, moved outwards by the radius, its corners arcs of that radius outside the polygon. Corner i is
 * arc i. (Box2D's polygons with a radius.) Errors as narc_build_polygon(), but that every radius fits. */
NARC_API narc_status narc_build_skin_polygon(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                                             size_t *out_count, narc_error *error);

/* Leaves out the corners of a polygon that hardly matter, such as those that nearly lie on another corner or on the
 * line between their neighbours, for the builders above, which refuse them: one after the other the corner with which
 * the polygon loses least, as long as every corner that was left out is within `tolerance` >= 0 of the side that came
 * in its place. The rest stay where they are, in their order. 3 .. NARC_MAX_ARCS `points`; `out_points` has room for
 * `count` and may be `points`; `out_count` is how many corners are left. NARC_ERROR_COUNT: another count, or all of the
 * polygon is within the tolerance of a segment, so that fewer than 3 would be left. Thread-safe. */
NARC_API narc_status narc_weld_polygon(const narc_point *points, size_t count, double tolerance, narc_point *out_points,
                                       size_t *out_count, narc_error *error);

/* The convex hull of `points[0 .. count-1]`, in any order, with a skin of `radius` >= 0, as narc_build_skin_polygon() makes it;
 * the arcs' centres are its corners, all among the points.
 *   tolerance   so far points may stay outside, and corners are left out; below 2^-17 of the extent, the furthest distance from
 *               one of the points, it is that: what turns by less is no corner of a shape
 * Takes time in proportion to the points and the corners. NARC_ERROR_COUNT: fewer than 3 points, or a hull of more than
 * NARC_MAX_ARCS corners: error->value is a tolerance with which it has as many at most. NARC_ERROR_NOT_CONVEX: all points lie within
 * the tolerance of a segment.
 * Source: quickhull's step (Eddy 1977), always at the side with the furthest point outside. */
NARC_API narc_status narc_build_hull(const narc_point *points, size_t count, double tolerance, double radius,
                                     narc_arc *out_arcs, size_t *out_count, narc_error *error);

/* A regular polygon around the origin with 3 .. NARC_MAX_ARCS corners, corner 0 at (circumradius, 0), each rounded
 * inside the polygon with `radius` >= 0. Errors as narc_build_polygon(). */
NARC_API narc_status narc_build_regular_polygon(size_t corners, double circumradius, double radius, narc_arc *out_arcs,
                                                size_t *out_count, narc_error *error);

/* The n-arc nearest to the ellipse x^2 / half_x^2 + y^2 / half_y^2 = 1, of all that are symmetric to both axes: the one
 * with the least Hausdorff distance, which goes to `out_distance` (or NULL). (Of ellipses thinner than 12:1, with more
 * than 16 arcs, it is sometimes another one, up to 1.7 times as far.) It lies partly inside and partly outside the
 * ellipse. `arc_count` is 4, 8, 12 ... NARC_MAX_ARCS. Twice as many arcs are 4.2 to 7.3 times as near, the more there
 * are the more (eight times would be the limit). Where the half axes are equal (their difference below 2 *
 * NARC_TOLERANCE times the larger), it is a circle of one arc.
 * NARC_ERROR_COUNT: another arc_count. NARC_ERROR_RADIUS: an arc is flatter than narc_validate_arcs() allows; the
 * flattest has a radius of about the larger half axis squared over the smaller.
 * Source: equal extreme errors (Chebyshev) of the support function, by the Remez exchange; soa/ellipse.c. */
NARC_API narc_status narc_build_ellipse(double half_x, double half_y, size_t arc_count, narc_arc *out_arcs,
                                        size_t *out_count, double *out_distance, narc_error *error);

/* Figure 3 of "Using Piecewise Circular Curves as a 2D Collision Primitive": two large circles that overlap,
 * `distance` between their centres, and two small circles inscribed where they meet. The large centres are (0,
 * distance / 2), radius `radius_low` (its arc bounds the shape below), and (0, -distance / 2), radius `radius_high`;
 * `radius_left` and `radius_right` are those of the tips (0: a sharp tip). Arcs, in order: right, upper, left, lower.
 * With equal large radii R the lens is 2 R - distance thick. NARC_ERROR_SIZE: the large circles do not overlap, or
 * one contains the other. NARC_ERROR_RADIUS: a small circle does not fit between them. */
typedef struct narc_four_arc {
    double radius_low, radius_high;
    double distance;
    double radius_left, radius_right;
} narc_four_arc;
NARC_API narc_status narc_build_four_arc(const narc_four_arc *form, narc_arc *out_arcs, size_t *out_count,
                                         narc_error *error);

/* The n-arc whose junctions are `points[0 .. count-1]`, counter-clockwise; arc i runs from point i to point i + 1.
 * Joining all chords with a common tangent asks that the half central angles satisfy alpha[i-1] + alpha[i] = the
 * exterior angle at point i; then radius[i] = chord[i] / (2 sin alpha[i]).
 *   Even count: `radius`, that of arc 0, fixes all others; 0 chooses the feasible one that makes the radii most alike
 *   (least variance of their logarithms). The exterior angles at the even points must add up to pi (as must the odd
 *   ones). Odd count: there is exactly one solution, `radius` must be 0 or that of the solution.
 * NARC_ERROR_COUNT: fewer than 3 or more than NARC_MAX_ARCS points. NARC_ERROR_NOT_CONVEX: a point where the
 * outline does not turn left. NARC_ERROR_NO_SOLUTION: the angle sums differ, or some alpha cannot be positive and at
 * most pi / 2; the message says which condition fails and where. NARC_ERROR_RADIUS: `radius` is outside the feasible
 * range (the message tells the range), or an odd count was given another. */
NARC_API narc_status narc_build_points(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                                       size_t *out_count, narc_error *error);

/* The open range of radii of arc 0 for which an n-arc with these junctions exists, and the choice of
 * narc_build_points(), which accepts nothing outside that range; inside, near its ends, it refuses arcs that are too
 * flat (NARC_MAX_RADIUS_RATIO). For an odd count all three are the one solution. `*out_max` may be +infinity. Errors
 * as narc_build_points(). */
NARC_API narc_status narc_find_radius_range(const narc_point *points, size_t count, double *out_min, double *out_max,
                                            double *out_chosen, narc_error *error);

/* Algorithm 1 of "Using Piecewise Circular Curves as a 2D Collision Primitive", corrected: from any simple polygon
 * (either orientation, convex or not, odd or even count, 3 .. NARC_MAX_ARCS vertices) to the junctions of a valid
 * n-arc near it, as many as the polygon has vertices, counter-clockwise, ready for narc_build_points(). The exterior
 * angles are replaced by the nearest ones (least squares) for which an n-arc exists; lines with those directions go
 * through the midpoints of the sides, moved only as far as needed to keep every side's length positive; the junctions
 * are where they meet. The n-arc follows the polygon, it does not bound it. NARC_ERROR_NOT_SIMPLE: the polygon
 * crosses or touches itself, repeats a vertex, or has no area. */
NARC_API narc_status narc_adjust_polygon(const narc_point *polygon, size_t count, narc_point *out_points,
                                         narc_error *error);

/* An n-arc near any ring of points in one call: narc_build_points() with the junctions that narc_adjust_polygon()
 * finds. Every simple polygon has one, in either orientation, convex or not; where it is not convex the n-arc cuts
 * across its dents and corners. It has as many arcs as there are points. Errors: those of narc_adjust_polygon(). */
NARC_API narc_status narc_build_ring(const narc_point *points, size_t count, narc_arc *out_arcs, size_t *out_count,
                                     narc_error *error);

/* The same shape with its centroid at the origin. `out_centroid` (or NULL) is where it was: what the position of a body
 * must be moved by, turned and scaled as the body is, for the body to stay where it is. `out_arcs`, `count` of them,
 * may be `arcs`. Errors: NARC_ERROR_ARGUMENT (NULL), those of narc_validate_arcs(). Thread-safe. */
NARC_API narc_status narc_center_arcs(const narc_arc *arcs, size_t count, narc_arc *out_arcs, narc_point *out_centroid,
                                      narc_error *error);

/* The mirror image of a shape at the y axis: x becomes -x. Arc i becomes arc count - 1 - i, so that the list stays
 * counter-clockwise. `out_arcs` and errors as narc_center_arcs(). Thread-safe. */
NARC_API narc_status narc_mirror_arcs(const narc_arc *arcs, size_t count, narc_arc *out_arcs, narc_error *error);

/* The same shape elsewhere: its points p go to (x, y) + scale * p, turned by `angle`: a part of a compound in the frame
 * of its owner. `out_arcs` and errors as narc_center_arcs(), of both lists; NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE (a
 * scale that is not positive). Thread-safe. */
NARC_API narc_status narc_move_arcs(const narc_arc *arcs, size_t count, double x, double y, double angle, double scale,
                                    narc_arc *out_arcs, narc_error *error);

/* ----------------------------------------------------------------------------------------- derived quantities */

/* All of these take a valid list of arcs (see narc_validate_arcs()), compute in double precision from closed forms, and
 * are pure and thread-safe. They return false, outputs untouched, for NULL, a count of 0 or more than NARC_MAX_ARCS, or a
 * place, direction or angle that is not finite. */

/* Area, its centroid and its second moment about the centroid (times a density: mass and moment of inertia). Green's
 * theorem, arc by arc. A segment has area and second moment 0, and its middle is its centroid: a body of that shape is
 * one that does not move, or has a mass of its own. (Its perimeter is twice its length.) */
typedef struct narc_mass {
    double area;
    double centroid_x, centroid_y;
    double second_moment;
} narc_mass;
NARC_API bool narc_compute_mass(const narc_arc *arcs, size_t count, narc_mass *out_mass);

typedef struct narc_circle {
    double x, y, radius;
} narc_circle;

/* The smallest circle around the shape; relative error below 1e-9. */
NARC_API bool narc_compute_bounding_circle(const narc_arc *arcs, size_t count, narc_circle *out_circle);

/* A largest circle inside the shape; relative error below 1e-9. (For a stadium there are many: it is one of them; for a
 * segment its middle.) */
NARC_API bool narc_compute_inscribed_circle(const narc_arc *arcs, size_t count, narc_circle *out_circle);

typedef struct narc_aabb {
    double min_x, min_y, max_x, max_y;
} narc_aabb;

/* The axis-aligned bounding box of the shape turned by `angle` about its origin. */
NARC_API bool narc_compute_aabb(const narc_arc *arcs, size_t count, double angle, narc_aabb *out_aabb);

/* The perimeter: arcs and edges. */
NARC_API bool narc_compute_perimeter(const narc_arc *arcs, size_t count, double *out_perimeter);

/* The point of the shape that lies furthest in a direction (any length > 0), and the arc it lies on; where a straight
 * edge is furthest, the edge's counter-clockwise end. Either output may be NULL. */
NARC_API bool narc_find_support(const narc_arc *arcs, size_t count, double direction_x, double direction_y,
                                narc_point *out_point, size_t *out_arc);

/* Signed distance from a point to the outline: negative inside. */
NARC_API bool narc_compute_distance(const narc_arc *arcs, size_t count, const narc_point *point, double *out_distance);

/* Is the point inside the shape or on its outline? */
NARC_API bool narc_contains_point(const narc_arc *arcs, size_t count, const narc_point *point);

/* Memory: `allocate` returns `size` bytes aligned to 16 or NULL; `release` gets what it returned. Without an allocator it is
 * malloc() and free(); on Linux what has 2 MB or more is asked to lie in large pages, and may take up to one of them more. */
typedef struct narc_allocator {
    void *(*allocate)(size_t size, void *context);
    void (*release)(void *memory, void *context);
    void *context;
} narc_allocator;

/* The mass of a compound: of all that any of its parts covers. Where several lie over each other they count once,
 * exactly, wherever they touch or cross. (The sum of the parts, each for itself: narc_compute_mass() of each, and
 * second_moment + area * the square of its centroid's distance from the common one.) It allocates, and checks what it
 * is given.
 *   arcs        those of all parts in one frame (narc_move_arcs()), part after part
 *   counts      how many arcs each part has
 *   allocator   of some 400 bytes for each arc, for this call; NULL: malloc and free
 *   out_mass    without any area (segments alone) the centroid is that of the first part
 * Errors are some roundings of the compound's size, and so is the difference that the smallest motion of a part makes.
 * Time grows with the square of how many parts lie side by side, times how often their outlines end or cross.
 * Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_COUNT (no parts), NARC_ERROR_MEMORY, those of narc_validate_arcs()
 * (error->index is the part). Thread-safe. Not in narc_small.wasm. */
NARC_API narc_status narc_compute_union_mass(const narc_arc *arcs, const size_t *counts, size_t part_count,
                                             const narc_allocator *allocator, narc_mass *out_mass, narc_error *error);

/* ------------------------------------------------------------------------------------------------ the store */

/* A list of arc shapes, each known by its index 0, 1, 2 ... The store keeps single-precision copies in a layout that
 * belongs to the kernels. Adding, replacing, removing and reserving need exclusive access; all else, queries above all,
 * may share it between threads. A shape's index stays its own until it is removed.
 *
 * Equal shapes are stored once: bodies with the same shape make queries faster than bodies with copies of it. Shapes
 * are equal if all that the store keeps of them is, so that every answer is the same: arcs with the same numbers, and
 * the same place. (A circle around another centre is another shape.) Each narc_add_shape() is a use, which
 * narc_remove_shape() gives back; a shape goes with its last use.
 *
 * Whatever comes and goes, a store has at most four times the memory that its shapes needed when they needed most (or
 * room was reserved for), also while it moves them; and some KB. A shape needs some 40 bytes for each arc and 90 more;
 * a removed one needs nothing, an index that narc_add_shape_at() has left out 52 bytes. From the first piece of a chain on
 * (narc_chains.h) each index takes 64 more. */
typedef struct narc_shapes narc_shapes;

/* What a store knows of a shape, bits of narc_shape_flags(). */
enum {
    NARC_SHAPE_SMOOTH = 1,         /* no edges: an n-arc */
    NARC_SHAPE_CIRCLE = 2,         /* one arc, a full turn */
    NARC_SHAPE_POLYGON = 4,        /* every radius is 0 */
    NARC_SHAPE_CENTERS_INSIDE = 8, /* every arc's centre lies in the shape */
    NARC_SHAPE_RUN = 16,           /* a part of a convex run of a chain (narc_chains.h) */
    NARC_SHAPE_CONCAVE = 32,       /* a concave arc of a chain */
    NARC_SHAPE_HALF_PLANE = 64,    /* narc_add_half_plane(); no other flag */
};

/* An empty store. `allocator` NULL: malloc and free. NARC_ERROR_MEMORY. */
NARC_API narc_status narc_create_shapes(const narc_allocator *allocator, narc_shapes **out_shapes);

/* Frees a store; NULL is fine. */
NARC_API void narc_destroy_shapes(narc_shapes *shapes);

/* Room for `shape_count` more shapes with `arc_count` arcs in all, so that adding them allocates nothing. Optional. (So
 * does replacing a shape by one of more arcs, as if it were added.) */
NARC_API narc_status narc_reserve_shapes(narc_shapes *shapes, size_t shape_count, size_t arc_count);

/* Validates a shape and adds it. `out_shape` (or NULL) is the index of an equal one that is there, which gets one more
 * use; else the index that narc_remove_shape() freed last; else the next higher one. So an index is not a count of
 * calls: who keeps something for each shape keeps it at the index that is returned, and who wants one index for each
 * call chooses it, with narc_add_shape_at(). How long it takes does not depend on how many shapes there are.
 *   A shape's coordinates are kept as they are: a body's position is the place of the shape's origin. It should be in
 * the shape, or near it: errors grow with the distance (see "Precision" in narc.h). Errors: those of
 * narc_validate_arcs(), NARC_ERROR_MEMORY, NARC_ERROR_COUNT (the store is full; 2^32 - 1 uses of one shape); the store
 * is unchanged then. */
NARC_API narc_status narc_add_shape(narc_shapes *shapes, const narc_arc *arcs, size_t count, uint32_t *out_shape,
                                    narc_error *error);

/* Adds a half-plane: all that is not above its own x axis, ground without end. A body's position and rotation place it, its
 * scale says nothing, but must be in range. Contacts, manifolds, separations, overlaps, casts, rays, points, boxes and
 * indices take it as any other body. It touches with edge 0, along its normal (0, 1); what is 1e12 deep or deeper has no
 * answer. Errors count from the nearest place of the boundary, wherever its position is. Its boxes reach as far as floats
 * do, but where its sides are those of the axes. It has no arcs (narc_get_arcs() returns 0), no box about its origin and no
 * mass; with another half-plane or a piece of a chain it has no contact; in a cast it may move, but not turn; no method of
 * narc_methods.h takes it. There is one in a store, as equal shapes are one. Errors: those of narc_add_shape(). */
NARC_API narc_status narc_add_half_plane(narc_shapes *shapes, uint32_t *out_shape, narc_error *error);

/* Validates a shape and puts it at an index of the caller's choice, below NARC_MAX_SHAPES, where there is none: also if
 * the store has an equal one, which keeps its own index. (narc_add_shape() of one more returns one of the two.) Indices
 * below it that were never given out are free then, as those of removed shapes; narc_add_shape() begins with the lowest
 * of them. For engines with numbers of their own. Errors: those of narc_add_shape(), NARC_ERROR_INDEX (out of range),
 * NARC_ERROR_IN_USE (there is a shape); the store is unchanged then. */
NARC_API narc_status narc_add_shape_at(narc_shapes *shapes, uint32_t shape, const narc_arc *arcs, size_t count,
                                       narc_error *error);

/* Puts another shape in the place of one: all bodies with that index have it from now on. If it has as many arcs as the
 * old one, or fewer, it takes the old one's memory. It may be equal to a third one; both keep their indices. Errors:
 * those of narc_add_shape(), NARC_ERROR_INDEX (there is no such shape, or it was removed), NARC_ERROR_IN_USE (it is
 * used more than once; the message and error->value tell how often: remove this use and add the other shape); the store
 * is unchanged then. */
NARC_API narc_status narc_replace_shape(narc_shapes *shapes, uint32_t shape, const narc_arc *arcs, size_t count,
                                        narc_error *error);

/* Gives back one use of a shape, and with the last one removes it. The others keep their indices, and narc_add_shape()
 * will use this one again. Until then a body that still has it collides with nothing, as a broken one (see
 * narc_bodies). Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_INDEX (there is no such shape, or it was removed
 * before). */
NARC_API narc_status narc_remove_shape(narc_shapes *shapes, uint32_t shape, narc_error *error);

/* How often a shape is used: how many narc_add_shape() and narc_add_shape_at() returned its index, less those that were
 * removed. 0 if there is no such shape. */
NARC_API uint32_t narc_count_uses(const narc_shapes *shapes, uint32_t shape);

/* The number of indices that were given out, those of removed shapes included: all are below it. 0 for NULL. */
NARC_API size_t narc_count_shapes(const narc_shapes *shapes);

/* The arcs of a shape as the kernels see them (single precision, widened): their number, at most NARC_MAX_ARCS, is
 * returned; 0 if there is no such shape, or it was removed. `out_arcs` may be NULL. They miss each other by what was
 * rounded: of a shape further than some 20 times its size from its own origin narc_validate_arcs() may refuse them. */
NARC_API size_t narc_get_arcs(const narc_shapes *shapes, uint32_t shape, narc_arc *out_arcs);

/* The flags of a shape, 0 if there is no such shape. */
NARC_API unsigned narc_shape_flags(const narc_shapes *shapes, uint32_t shape);

/* The axis-aligned bounding box of a stored shape rotated by (cosine, sine) and then scaled, around its origin; a
 * little larger than exact so that rounding never makes it too small. False if there is no such shape, or cosine and
 * sine are 0 or not finite; their length does not matter. Meant for broad phases. */
NARC_API bool narc_get_aabb(const narc_shapes *shapes, uint32_t shape, float cosine, float sine, float scale,
                            narc_aabb *out_aabb);

/* ------------------------------------------------------------------------------------------------ saving */

/* A store as bytes, the same on every platform: what is stored of its shapes, their indices and uses, and which index
 * comes next; a version and a checksum. */

/* How many bytes narc_save_shapes() writes. Some 32 for each arc and 32 more for each shape, 8 for a removed one. */
NARC_API size_t narc_count_saved_bytes(const narc_shapes *shapes);

/* Writes a store to the caller's `out_bytes`, of which there are `size`. Errors: NARC_ERROR_ARGUMENT (NULL),
 * NARC_ERROR_CAPACITY (size is less than narc_count_saved_bytes()); nothing is written then. May share the store with
 * other threads. */
NARC_API narc_status narc_save_shapes(const narc_shapes *shapes, void *out_bytes, size_t size, narc_error *error);

/* A store from the `size` bytes that narc_save_shapes() wrote; they may lie anywhere and may come from anyone. Every
 * answer is that of the store that was saved, to the last bit (but for methods that use boxes or centroids, see
 * narc_methods.h: these are computed anew), and a shape that is equal to a saved one is found.
 *   Nothing in the bytes is believed: size and checksum first, then each shape is checked as narc_add_shape() checks
 * it, with room for the rounding of what was stored, and so is what the store keeps of it. NARC_ERROR_FORMAT: other
 * bytes, an unknown version, or damage; the message names the shape. NARC_ERROR_ARGUMENT, NARC_ERROR_MEMORY.
 * `allocator` as in narc_create_shapes(). On error there is no store. */
NARC_API narc_status narc_load_shapes(const narc_allocator *allocator, const void *bytes, size_t size,
                                      narc_shapes **out_shapes, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
