/* SPDX-License-Identifier: MIT
 *
 * everything.h - all that a scene can be asked, by one call: what must be the same in two ways of asking is compared
 * whole.
 */
#ifndef NARC_TEST_EVERYTHING_H
#define NARC_TEST_EVERYTHING_H

#include "ray_reference.h"
#include "scene.h"

/* Bodies that move, and what is asked of them. */
struct everything {
    const narc_shapes *shapes;
    narc_bodies bodies;
    size_t indexed; /* the first so many bodies make an index for rays, points, regions, */
    size_t movers;  /* and for so many of them that move */
    narc_motions motions;
    narc_pairs pairs;
    narc_rays rays;
    narc_points points; /* as many as pairs: distances are those of each from its pair's first body */
    narc_query query;   /* with dense rows */
    narc_cast_options cast;
    narc_inside inside;
    const narc_box *boxes; /* the index's, if they are not those of its bodies */
    size_t near;           /* of pairs of boxes those of the first so many bodies count; 0: all */
};

enum answer_kind {
    ANSWER_BOXES,
    ANSWER_PARTS, /* each body as a part of another one */
    ANSWER_OVERLAPS,
    ANSWER_SEPARATIONS,
    ANSWER_CONTACTS,
    ANSWER_MANIFOLDS,
    ANSWER_CASTS,
    ANSWER_DISTANCES,
    ANSWER_INSIDE,    /* words, of the points of the distances */
    ANSWER_RAY_PAIRS, /* each ray at the first body */
    ANSWER_RAYS,
    ANSWER_NEAREST,
    ANSWER_MOVERS,
    ANSWER_LISTS,  /* regions and pairs of boxes, in one number each */
    ANSWER_COUNTS, /* of what was skipped, and of rows */
    ANSWERS
};

/* Rows in guarded memory, no more than there are. */
struct answers {
    void *rows[ANSWERS];
    size_t count[ANSWERS];
};
struct answers ask_everything(const struct everything *e, const narc_workers *workers);
void destroy_answers(struct answers *answers);

/* Fails with the first row that differs. `but`: without the kinds that have a bit here. */
void expect_same_answers(const struct answers *right, const struct answers *found, unsigned but, const char *how);

/* Rows of one pair, ray and point, the k-th of others: fails unless these have the same. */
void expect_same_row(const struct answers *all, size_t k, const struct answers *one);

/* Fails unless no number is a NaN, features are there, and overlaps, separations and contacts agree. */
void expect_sane_answers(const struct everything *e, const struct answers *answers);

/* ------------------------------------------------------------------------------------------------ worlds */

/* A scene with what it is asked: casts that come as far as the other body of a pair, points near outlines, where contacts
 * are, rays at the first bodies. */
struct world {
    struct scene scene;
    narc_motion *motion;
    struct test_ray *rays, *points;
    size_t ray_count;
    float *shift, *margins; /* of each pair, of every other world */
    bool shifted;
    narc_query query;
    narc_cast_options cast;
    narc_inside inside;
};
struct world make_world(struct test_random *random, struct scene scene, size_t bodies_with_rays, size_t rays);
void destroy_world(struct world *world);

/* An index has as many bodies as all, or as have rays. */
struct everything view_world(const struct world *world);

#endif
