/* SPDX-License-Identifier: MIT
 *
 * narc_scene.h - what a scene is asked: what lies in a region, what a ray meets, when moving bodies meet, what is
 * nearest.
 *
 * The mental model
 *
 *   Bodies and shapes are those of narc.h. An INDEX is a tree over the boxes of bodies. It is built once, and
 *   updated with what moves, comes and goes. Questions go through it and answer in rows, exactly: boxes only
 *   say which bodies need not be asked.
 *
 *       narc_query_index()    which boxes meet these boxes?            pairs (query, body)
 *       narc_cast_rays()      what does each ray hit first?            narc_ray_hit
 *       narc_cast_shapes()    what does each moving body hit first?    narc_impact
 *       narc_find_nearest()   which bodies are nearest to a point?     narc_distance
 *
 *   Others ask of pairs, and need no index:
 *
 *       narc_cast_ray_pairs() does a ray hit a body, and where?        narc_ray_hit
 *       narc_cast_pairs()     when do two moving bodies meet?          narc_impact
 *       narc_cast_pair()      the same of two bodies by themselves     narc_impact
 *       narc_find_distances() how far is a point from a body?          narc_distance
 *       narc_find_inside()    is a point within a body?                bits
 *
 *   Rows are dense: what asks has a number, and its rows stand at that number; count 0 says that there is nothing.
 *   Answers are the same to the last bit on every instruction set, with any number of workers, and whatever the index
 *   looks like: of equal fractions or distances the body with the lower number counts. Equal is what is equal as a float:
 *   so of motions so long that fractions underflow a body further away may count.
 *
 * Example
 *
 *     narc_box box[1000];                                          (bodies as in narc.h)
 *     narc_compute_boxes(shapes, &bodies, NULL, box, NULL);
 *     narc_index *index;
 *     narc_create_index(NULL, &index);
 *     narc_build_index(index, box, 1000, NULL, NULL);
 *
 *     float dx[1080], dy[1080];                                    (a laser scanner's rays, each as long as it sees)
 *     double x = 3, y = 4;
 *     narc_ray_hit hit[1080];
 *     narc_rays rays = {.count = 1080, .x = {&x, 0, NARC_FLOAT64}, .y = {&y, 0, NARC_FLOAT64},
 *                       .motion_x = NARC_ARRAY(dx), .motion_y = NARC_ARRAY(dy)};
 *     narc_cast_rays(index, shapes, &bodies, &rays, NULL, hit, 1080, NULL);
 *
 * Functions that take a const index, and those that need none, may be called from any number of threads at once, with
 * NARC_STACK_SIZE bytes of stack.
 */
#ifndef NARC_SCENE_H
#define NARC_SCENE_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ index */

/* A tree over boxes: nodes of eight. Memory grows to what the largest build wants and stays. */
typedef struct narc_index narc_index;

/* One of no boxes. `allocator` NULL: malloc and free. NARC_ERROR_MEMORY, NARC_ERROR_ARGUMENT. */
NARC_API narc_status narc_create_index(const narc_allocator *allocator, narc_index **out_index);

/* Frees it; NULL is fine. */
NARC_API void narc_destroy_index(narc_index *index);

/* What is 0 or NULL is left out, as all is for {0}.
 *   category   64 bits for each box, which questions compare with their masks; left out: all bits set
 *   fast       1: in the order of a curve, in a fraction of the time; questions then take up to twice as long
 *   workers    threads to use; NULL: the calling one. The index does not depend on them
 *   origin     that of the boxes (narc_box_options), finite; NULL: (0, 0). Rays, points, movers are in the world as ever, and
 *              boxes that ask are relative to it, too
 *   world      the world of each box, any number; left out: there is one. Worlds are apart in the tree: who asks one goes
 *              through it alone */
typedef struct narc_index_options {
    narc_word_column category;
    uint32_t fast;
    const narc_workers *workers;
    const narc_point *origin;
    narc_index_column world;
    void *reserved[1]; /* NULL */
} narc_index_options;

/* Makes the index one of these boxes; box k is that of body k, as narc_compute_boxes() gives them. An empty box is
 * found by no question.
 *   count     at most 2^31
 *   options   NULL: defaults
 * Errors: NARC_ERROR_ARGUMENT, NARC_ERROR_NOT_FINITE (origin), NARC_ERROR_MEMORY, and those for NARC_ISA; the index is as it
 * was then.
 * Fast: of boxes whose centres lie closer together than 1/65,536 of all of them are apart, no order is made.
 * Source: k-d splits at medians (Bentley 1975); sorting by Morton's curve (Morton 1966) if fast. */
NARC_API narc_status narc_build_index(narc_index *index, const narc_box *boxes, size_t count,
                                      const narc_index_options *options, narc_error *error);

/* Brings the index up to date with boxes of which some have changed, in proportion to how many: afterwards it answers as one
 * that was built from these boxes. Where bodies go far, parts of the tree are built anew, now and then all of it, so that it
 * stays good. Bodies keep their numbers; one that is gone has an empty box, one that comes a number of its own.
 *   boxes, count    all of them. Those with numbers from the last count on have come, if there were fewer, and those from
 *                   `count` on are gone, if there were more
 *   changed         the numbers of all other boxes that are not as they were, or whose category or world is not,
 *                   `changed_count` of them, in any order. NULL: all may have changed
 *   options         as when building, the columns those of all boxes. With a column where it was built without, or the other
 *                   way around, it is built anew; with another origin all boxes have changed
 * Errors: those of narc_build_index(), NARC_ERROR_INDEX (no such box); the index is as it was then. */
NARC_API narc_status narc_update_index(narc_index *index, const narc_box *boxes, size_t count,
                                       const narc_index_column *changed, size_t changed_count,
                                       const narc_index_options *options, narc_error *error);

/* How a tree is, for who tunes.
 *   boxes, bodies    numbers; those whose boxes are not empty
 *   nodes, leaves    all nodes; those of the lowest level
 *   depth            levels
 *   bytes            of all memory that the index has
 *   mean_perimeter   of the nodes' boxes
 *   slack            their perimeters together, as a multiple of what they were when the whole tree was built */
typedef struct narc_index_statistics {
    size_t boxes, bodies, nodes, leaves, depth, bytes;
    double mean_perimeter, slack;
} narc_index_statistics;

/* Looks at all nodes. Errors: NARC_ERROR_ARGUMENT (NULL). */
NARC_API narc_status narc_describe_index(const narc_index *index, narc_index_statistics *out_statistics,
                                         narc_error *error);

/* The boxes of a level's nodes, to draw a tree: level 0 are the leaves, the last one is the box around all. Node k holds nodes 8 k
 * to 8 k + 7 of the level below, as many as there are.
 *   out_boxes   relative to the index's origin; empty where nothing is below a node
 *   stride      bytes from a box to the next, a multiple of 4; 0: no gaps
 *   capacity    boxes that there is room for
 *   out_count   how many nodes the level has, 0 from narc_index_statistics.depth on; set with NARC_ERROR_CAPACITY, too
 * Errors, found before anything else is written: NARC_ERROR_ARGUMENT (NULL, stride), NARC_ERROR_CAPACITY. */
NARC_API narc_status narc_copy_nodes(const narc_index *index, size_t level, narc_box *out_boxes, ptrdiff_t stride,
                                     size_t capacity, size_t *out_count, narc_error *error);

/* Which bodies are parts of one thing: those with the same owner, as narc_place_parts() has them. A ray or a point has
 * one row of a thing at most, and what is inside of it is inside of all its parts together, not at a seam between two.
 *   owner     of each body of the index, any number; UINT32_MAX: the body is a thing by itself
 *   ignored   for each query an owner whose bodies are not found; UINT32_MAX: none; left out: none */
typedef struct narc_owners {
    narc_index_column owner;
    narc_index_column ignored;
    void *reserved[4]; /* NULL */
} narc_owners;

/* How a question goes through an index; NULL or {0}: all bodies, in the calling thread.
 *   mask      64 bits for each query: only bodies with category & mask not 0 are found; left out: all bits set
 *   ignored   for each query a body that is not found, such as the one that asks; UINT32_MAX: none; left out: none
 *   workers   threads to use; NULL: the calling one
 *   owners    NULL: each body is a thing by itself. What is not found counts for no thing either
 *   world     for each query a world of the index (narc_index_options): only its bodies are found; left out: those of all. Of
 *             an index without worlds none may be asked: NARC_ERROR_ARGUMENT */
typedef struct narc_index_query {
    narc_word_column mask;
    narc_index_column ignored;
    const narc_workers *workers;
    const narc_owners *owners;
    narc_index_column world;
    void *reserved[1]; /* NULL */
} narc_index_query;

/* All pairs of a query box and a body whose boxes overlap or touch, in the order of (query, body).
 *   boxes       `count` query boxes, at most 2^32 - 2, from the index' origin; an empty one finds nothing
 *   query       NULL: defaults
 *   out_pairs   columns a (the query's number) and b (the body), which belong to the index until its next call of this
 *               function or of narc_cast_shapes(), or its end. With other_bodies set to the index's bodies it is what narc_find_contacts() takes:
 *               what moves against what stands still, or a sensor against all.
 * One call at a time for each index. Errors: NARC_ERROR_ARGUMENT, NARC_ERROR_COUNT (2^32 pairs or more),
 * NARC_ERROR_MEMORY, and those for NARC_ISA; `*out_pairs` is untouched then. */
NARC_API narc_status narc_query_index(narc_index *index, const narc_box *boxes, size_t count,
                                      const narc_index_query *query, narc_pairs *out_pairs, narc_error *error);

/* ------------------------------------------------------------------------------------------------ rays */

/* Rays: `count` of each column. A ray goes from (x, y) to (x, y) + fraction * motion; its largest fraction is 1 unless
 * `fraction` says another, INFINITY for one without end. One that has no length, or a number that is not finite (but
 * that fraction) or a fraction below 0 or NaN, has no answer; see narc_ray_options.out_skipped. */
typedef struct narc_rays {
    size_t count;
    narc_position_column x, y;            /* both float or both double */
    narc_float_column motion_x, motion_y; /* world axes */
    narc_float_column fraction;           /* base NULL: all 1 */
    void *reserved[2];                    /* NULL */
} narc_rays;

/* What a ray meets that starts within a body, or on its outline. With owners: within any part of a thing. */
typedef enum narc_inside {
    NARC_INSIDE_STOPS = 0,  /* the body, at fraction 0: count 1, the point is the start, normal, feature, radius 0 */
    NARC_INSIDE_LEAVES = 1, /* the body, where the ray leaves it, with the normal outwards. A thing: where it leaves the
                                last of the parts that follow each other without a gap; the row names that part. Parts
                                are connected where they come within twice NARC_ERROR_BOUND * (the latter's extent) */
    NARC_INSIDE_IGNORES = 2, /* not that body; no part of that thing */
} narc_inside;

/* What is 0 or NULL has its default, as all has for {0}.
 *   search        mask, ignored, workers, owners: of each thing the first row counts
 *   inside        see narc_inside
 *   any           1: whether anything is hit is all that matters. A row with count 1 tells of some body that is hit
 *                 (the same one for the same index)
 *   most          hits that each ray has room for, nearest first; 0: 1, the closest. Row i of ray k is row
 *                 k * most + i; the rows behind its last hit have count 0
 *   out_skipped   how many rays have no answer; NULL: nobody asks
 *   out_order     rays->count numbers. Rays whose starts are in no order are asked in one, world by world, neighbours
 *                 after each other: their numbers in this order are written here. Rows are the same. NULL: rays are asked
 *                 in the order that they come in, as is best for few, and where neighbours follow each other anyway */
typedef struct narc_ray_options {
    narc_index_query search;
    narc_inside inside;
    uint32_t any;
    size_t most;
    size_t *out_skipped;
    uint32_t *out_order;
    void *reserved[3]; /* NULL */
} narc_ray_options;

/* Where a ray enters a body, 36 bytes.
 *   ray       its number
 *   body      its number in the index
 *   feature   the arc or edge that is hit, in the caller's numbering (see narc_contact.feature): one byte
 *   count     1; 0: nothing is hit, and all else but `ray` is 0
 *   fraction  of the ray's motion, at least 0
 *   normal    unit, outwards, world axes
 *   point     where the outline is hit, world axes, relative to the position of the body
 *   radius    of curvature there, scaled: 0 at a corner, INFINITY on an edge */
typedef struct narc_ray_hit {
    uint32_t ray, body;
    uint16_t feature;
    uint16_t count;
    float fraction;
    float normal_x, normal_y;
    float point_x, point_y;
    float radius;
} narc_ray_hit;

/* What each ray hits: the least (fraction, body), or the first `most` of them in this order.
 *   index      built from boxes of these bodies
 *   bodies     as many as the index has boxes
 *   rays       at most UINT32_MAX
 *   options    NULL: defaults
 *   out_rows   room for `capacity` rows, at least rays->count * most
 * The point is within NARC_ERROR_BOUND * (the body's extent) of the outline and of the ray, however far the ray has come
 * (from more than 1e9 extents away, the digits of doubles are lost too). A ray that passes a body by no more than that
 * may hit or miss it, but one that touches it on its way, if only at a corner or along a side, hits it. So through a point that
 * two bodies hold, such as tiles' common corner, no ray passes unless it hits both (of shapes less than 250 of their radii
 * from their own origin). A touch has a fraction and a normal as any hit: against the ray, or across it. A corner is
 * hit as the end of an edge, a segment along the ray at its end, against the normal. Boxes only have to hold their bodies:
 * larger ones change no bit. Pieces of chains (narc_chains.h) are hit from the air: a
 * ray that starts in the ground does not hit it, whatever `inside` says; a concave arc's radius is below 0. Broken
 * bodies, and those whose shape does not exist, are not hit: so that a single ray takes no longer where there are many
 * bodies, they are not looked at beforehand. Rays that start at the same place, ask of the same bodies and follow each other in
 * the order of their directions, such as a scanner's, share their way.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT, NARC_ERROR_CAPACITY, and those for NARC_ISA.
 * Allocates nothing. Thread-safe.
 * Source: docs/algorithm.md, section 15. */
NARC_API narc_status narc_cast_rays(const narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                                    const narc_rays *rays, const narc_ray_options *options, narc_ray_hit *out_rows,
                                    size_t capacity, narc_error *error);

/* Whether each ray hits one body, and where: row k is that of ray k and body k of the column, or without one of body k itself.
 *   body       numbers of bodies, one for each ray; with a stride of 0 all rays ask of the same one; NULL: ray k and body k
 *   options    NULL: defaults. What counts of it is inside, out_skipped and search.workers
 *   out_rows   room for `capacity` rows, at least rays->count
 * Rows are those of narc_cast_rays() with an index of that body alone, to the last bit, whatever the bodies' boxes.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT, NARC_ERROR_INDEX (a body or a shape that does not
 * exist), NARC_ERROR_CAPACITY, and those for NARC_ISA. Allocates nothing. Thread-safe. */
NARC_API narc_status narc_cast_ray_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_rays *rays,
                                         const narc_index_column *body, const narc_ray_options *options,
                                         narc_ray_hit *out_rows, size_t capacity, narc_error *error);

/* ------------------------------------------------------------------------------------------------ casts */

/* How bodies move during a step, `count` as the bodies: from their place to their place + (x, y), while they turn at a
 * constant rate about their position by `angle`, in radians, counter-clockwise. What is left out is 0. (So a part of a
 * compound that turns is to have its owner's position: narc_move_arcs() makes its shape one of the owner's frame.) */
typedef struct narc_motions {
    narc_float_column x, y;
    narc_float_column angle;
    void *reserved[2]; /* NULL */
} narc_motions;

/* How one body moves during a step, as a row of narc_motions: by (x, y), turning by `angle`, in radians. */
typedef struct narc_motion {
    float x, y;
    float angle;
} narc_motion;

/* What is 0 or NULL has its default, as all has for {0}.
 *   target        the separation that is looked for: 0: touch; above 0: closer than that; below 0: so deep
 *   tolerance     where turning moves a body's outline, a hit has a separation within target .. target + tolerance; 0:
 *                 the least of 1/1024 of the smaller body's bounding radius, 1/64 of the thinner one's inscribed radius,
 *                 and 1/16 of what turning moves the outlines, but no less than rounding: so a turn of next to nothing
 *                 is as none. Bodies that do not turn need none: they meet up to rounding
 *   workers       threads to use; NULL: the calling one
 *   out_skipped   how many pairs have no answer: a broken body, a motion that is not finite, more than
 *                 NARC_MAX_DISTANCE from A to B at the start. Of movers: those that are broken or whose motion is not
 *                 finite, and such pairs on the way of the others. NULL: nobody asks
 *   targets       a target for each pair instead, of narc_cast_shapes() for each mover; `target` then means nothing
 *   front_only    not 0: pieces of chains are hit from the front alone, as in narc_query: a body with the centre of its
 *                 bounding circle behind a piece where they touch at the start passes it, and so does one that comes
 *                 from behind
 *   parting       above 0: bodies that are no further apart than the target at the start (a hit at fraction 0) are let go,
 *                 to part or to slide. One that comes deeper than it was then, by `parting` (and up to twice the tolerance
 *                 more), hits at fraction 0, with the contact at the start, so that no body creeps into another one from
 *                 cast to cast. Once it is clear, further away than the target by the tolerance, the target counts again */
typedef struct narc_cast_options {
    float target;
    float tolerance;
    const narc_workers *workers;
    size_t *out_skipped;
    narc_float_column targets;
    uint32_t front_only;
    float parting;
    void *reserved[1]; /* NULL */
} narc_cast_options;

/* What became of a cast. */
enum {
    NARC_CAST_MISS = 0,       /* the bodies stay further apart than the target */
    NARC_CAST_HIT = 1,        /* they come so close at `fraction`, and were not closer before */
    NARC_CAST_UNFINISHED = 2, /* they were not so close up to `fraction`; what comes then was not found out */
};

/* Where two moving bodies meet, 44 bytes: the time, and the contact of the bodies as they are placed then.
 *   pair       the number of the pair, or of the mover
 *   body       the other body: B
 *   feature    as in narc_contact, and so are the separation, normal and point (relative to A's position at that time); all
 *              0 of an unfinished cast where there is no contact, beside or behind a piece of a chain
 *   count      NARC_CAST_...; 0: all else but `pair` is 0
 *   fraction   of the step, 0 .. 1 */
typedef struct narc_impact {
    uint32_t pair, body;
    uint16_t feature;
    uint16_t count;
    float fraction;
    float separation;
    float normal_x, normal_y;
    float point_x, point_y;
    float radius_a, radius_b;
} narc_impact;

/* When do two moving bodies meet? For each pair the first time in 0 .. 1 at which their separation is the target.
 *   motions         of `bodies`; NULL: they stand still
 *   other_motions   of pairs->other_bodies; NULL: they stand still. Without other bodies: NULL
 *   options         NULL: defaults
 *   out_rows        room for `capacity` rows, at least pairs->count
 * Fractions are rounded down: positions at one are x + fraction * motion, computed in double precision. Bodies that are
 * no further than the target at the start hit at fraction 0, parting or not; with `parting` only if they come deeper.
 * Without turning, the time is exact up to rounding: the row's separation is within NARC_ERROR_BOUND * (D + E_a + E_b) of the target, and what a fraction that is
 * a float may differ by, 2^-24 of the motion. With turning: a hit has a separation within target .. target + tolerance
 * and none below the target earlier; a miss has none below the target (up to the same rounding, but three times that of
 * what turning moves). Where the least separation lies within target .. target + tolerance both are lawful. Turning
 * counts for what it moves: a circle about its position is cast as if it did not turn, to the bit.
 * Let go, what does not turn never comes back to a body, as separations are convex in time, but for concave arcs. There, and
 * with turning, a body is clear where the cast sees it so at one of the times that it looks at: one that is clear for a
 * short time only and comes back hits at 0, or not at all if it comes no deeper than it was.
 * Pieces of chains (narc_chains.h) are hit from the air, within their ends, where another piece goes on: at the first time
 * at which narc_find_contacts() has a row whose separation is the target (or within the tolerance), or less where the
 * body comes past an open end; not by a body that comes from behind, before it has left the piece.
 * Errors as narc_find_contacts(); NARC_ERROR_ARGUMENT (a tolerance or parting below 0), NARC_ERROR_NOT_FINITE (target,
 * tolerance, parting, or one of `targets`, whose number is the error's index), NARC_ERROR_CAPACITY. Allocates nothing.
 * Source: conservative advancement (Mirtich 1996) by bounds of their own: docs/algorithm.md, section 13. */
NARC_API narc_status narc_cast_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                                     const narc_pairs *pairs, const narc_motions *other_motions,
                                     const narc_cast_options *options, narc_impact *out_rows, size_t capacity,
                                     narc_error *error);

/* The cast of two bodies, which is row 0 of a batch of that pair, to the last bit (body 1 is B): for whoever casts one by one.
 *   motion_a, motion_b   NULL: it stands still
 *   options              NULL: defaults. What counts of it is target, tolerance, parting, front_only and out_skipped
 * Errors, all found before anything is written: as narc_cast_pairs(), and NARC_ERROR_INDEX (a shape that is not there).
 * Allocates nothing. */
NARC_API narc_status narc_cast_pair(const narc_shapes *shapes, const narc_body *a, const narc_motion *motion_a,
                                    const narc_body *b, const narc_motion *motion_b, const narc_cast_options *options,
                                    narc_impact *out_row, narc_error *error);

/* What each mover hits first: the least (fraction, body).
 *   index, bodies    what stands still while movers move, as in narc_cast_rays()
 *   movers, motions  any bodies, and how each moves
 *   search           mask, ignored and the owner ignored by mover, workers (those of `options` are not used); NULL: defaults.
 *                    With owners and `parting` a thing lets go as one: what is at its target from any part of it at the
 *                    start may go as deep into all its parts as it is in that one, and by `parting` deeper, so that
 *                    it slides from tile to tile. (Pieces of chains are let go one by one.)
 *   out_rows         room for `capacity` rows, at least movers->count; A is the mover
 * Otherwise as narc_cast_pairs(), but the index allocates: NARC_ERROR_MEMORY, NARC_ERROR_COUNT (2^32 pairs of a mover and
 * a box on its way). That bodies' shapes exist is only looked at where a mover comes near. One call at a time for each
 * index, as narc_query_index(). */
NARC_API narc_status narc_cast_shapes(narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                                      const narc_bodies *movers, const narc_motions *motions,
                                      const narc_index_query *search, const narc_cast_options *options,
                                      narc_impact *out_rows, size_t capacity, narc_error *error);

/* ------------------------------------------------------------------------------------------------ points */

/* Points in the world: `count` of each column. One that is not finite has no answer, and none further than
 * NARC_MAX_DISTANCE from a body's position, in x or y, has one with that body. */
typedef struct narc_points {
    size_t count;              /* at most UINT32_MAX */
    narc_position_column x, y; /* both float or both double */
    void *reserved[2];         /* NULL */
} narc_points;

/* How far a point is from a body, 36 bytes.
 *   point       its number
 *   body        its number
 *   feature     the nearest arc or edge, in the caller's numbering (see narc_contact.feature): one byte
 *   count       1; 0: there is no such body, or no answer, and all else but `point` is 0
 *   separation  the distance to the outline, negative within the body
 *   normal      unit, outwards, world axes, of the outline at the nearest place; at a corner, away from it
 *   place       the nearest place of the outline, world axes, relative to the position of the body. Where several are
 *               as near, one of them
 *   radius      of curvature there, scaled: 0 at a corner, INFINITY on an edge */
typedef struct narc_distance {
    uint32_t point, body;
    uint16_t feature;
    uint16_t count;
    float separation;
    float normal_x, normal_y;
    float place_x, place_y;
    float radius;
} narc_distance;

/* The distance of each point to one body: of point k to body k of the column, or without one to body k itself.
 *   body       numbers of bodies, one for each point; with a stride of 0 all points ask of the same one; NULL, or
 *              without a base: point k and body k
 *   workers    threads to use; NULL: the calling one
 *   out_rows   room for points->count rows
 * With D the distance between point and position, E the body's extent: the separation is within
 * NARC_ERROR_BOUND * (D + E) of the exact one, the place so near to the outline, and no other is nearer by more than
 * that. Where arcs were given NARC_TOLERANCE apart, the place is within that of the outline, and another may be nearer by
 * some 1e-3 of the bounding radius. Broken bodies have no answer, and a piece of a chain has one only where the place lies on it.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT, NARC_ERROR_INDEX (a body or a shape that does not
 * exist), and those for NARC_ISA. Allocates nothing. Thread-safe.
 * Source: docs/algorithm.md, section 14. */
NARC_API narc_status narc_find_distances(const narc_shapes *shapes, const narc_bodies *bodies,
                                         const narc_points *points, const narc_index_column *body,
                                         const narc_workers *workers, narc_distance *out_rows, narc_error *error);

/* Is each point within one body? Bit k % 64 of out_bits[k / 64] is that of point k; the bits behind the last are 0.
 *   body       as in narc_find_distances(); NULL: point k and body k. Fastest where points of one body follow each other
 *   workers    threads to use; NULL: the calling one
 *   out_bits   NARC_BIT_WORDS(points->count) words
 * The bit is set exactly if the separation that narc_find_distances() tells is below 0, so a point on the outline is not
 * within; of a piece of a chain, and where there is no answer, never. Errors and the rest as there. */
NARC_API narc_status narc_find_inside(const narc_shapes *shapes, const narc_bodies *bodies, const narc_points *points,
                                      const narc_index_column *body, const narc_workers *workers, uint64_t *out_bits,
                                      narc_error *error);

/* What is 0 or NULL has its default, as all has for {0}.
 *   search     mask, ignored, workers, owners: of each thing the nearest part counts. A point is within a thing (`inside`) if
 *              it is within a part. Its separation then is minus the distance to the outside of all parts together, and
 *              the row that of the part on whose outline the nearest such place lies. Where the outlines of two parts
 *              cross there, it is the part with the lower number, the normal leads from the point to the place, and
 *              the radius is 0. Parts are connected as for rays (NARC_INSIDE_LEAVES), but within four times as much
 *              of the larger extent. Time within a thing grows with the square of how many of its parts overlap in one
 *              place: half a millisecond a point of 25, some 40 of 200
 *   distance   only bodies whose separation is less; a negative one: those that the point is so deep within; 0: any
 *   inside     1: only bodies that the point is within
 *   most       bodies that each point has room for, nearest first; 0: 1. Row i of point k is row k * most + i; the rows
 *              behind its last body have count 0 */
typedef struct narc_nearest_options {
    narc_index_query search;
    float distance;
    uint32_t inside;
    size_t most;
    void *reserved[4]; /* NULL */
} narc_nearest_options;

/* The bodies nearest to each point: the least (separation, body), or the first `most` of them in this order. Rows are
 * those of narc_find_distances(), but for pieces of chains (narc_chains.h). Of these the nearest place of the ground's own
 * curve counts, ends among it, from either side: its distance takes the place of the separation in that order and in
 * `distance`, so that a piece of ground that is far in front of a point, such as the other side of a wall, comes behind
 * one that is near. The row's separation is above 0 in the air, and below 0 behind the tangent at the place: of the
 * nearest piece, where the point is in the ground. Beyond an open end that is what its tangent says, and the normal leads
 * from the end to the point, or from the point to the end. No point is within a piece (`inside`).
 *   index, bodies   as in narc_cast_rays(); a body whose box does not hold it may not be found
 *   options         NULL: defaults, which are the nearest body at any distance
 *   out_rows        room for `capacity` rows, at least points->count * most
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT, NARC_ERROR_NOT_FINITE (a distance that is NaN),
 * NARC_ERROR_CAPACITY, and those for NARC_ISA. Allocates nothing. Thread-safe.
 *
 * What is near to a body, not to a point, is found with its box, made larger by the distance, and the contacts of that
 * margin:
 *
 *     narc_box_options around = {.first = 7, .count = 1, .margin = 0.5f};           (body 7, and all within 0.5 of it)
 *     uint32_t seven = 7;
 *     narc_index_query others = {.ignored = {&seven, 0}};
 *     narc_compute_boxes(shapes, &bodies, &around, box, NULL);                      (writes box[7] alone)
 *     narc_query_index(index, box + 7, 1, &others, &pairs, NULL);
 *     pairs.a = (narc_index_column){&seven, 0};                                     (the query's body)
 *     narc_find_contacts(shapes, &bodies, &pairs, &(narc_query){.margin = 0.5f}, contact, capacity, &found, NULL);
 */
NARC_API narc_status narc_find_nearest(const narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                                       const narc_points *points, const narc_nearest_options *options,
                                       narc_distance *out_rows, size_t capacity, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
