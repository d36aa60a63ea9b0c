/* SPDX-License-Identifier: MIT
 *
 * scene.h - shapes, bodies and pairs as a test makes them, in double precision and as a batch call wants them.
 */
#ifndef NARC_TEST_SCENE_H
#define NARC_TEST_SCENE_H

#include "families.h"
#include "narc.h"
#include "reference.h"

/* A position has both precisions, so that one array serves both kinds of batch. In a scene with single-precision
 * positions the doubles hold the same rounded values. */
struct body {
    double x, y;
    float x_single, y_single;
    float cosine, sine;
    float scale;
    uint32_t shape;
};

struct pair {
    uint32_t a, b;
};

struct scene {
    narc_shapes *store;
    struct shape *shapes;
    size_t shape_count;
    struct body *bodies;
    size_t body_count;
    struct pair *pairs;
    size_t pair_count;
    narc_precision precision;
};

/* An empty scene with room for that much; destroy_scene() frees it. */
struct scene create_scene(narc_precision precision, size_t shapes, size_t bodies, size_t pairs);
void destroy_scene(struct scene *scene);

/* Each returns the new item's index. A body's position is rounded to the scene's precision. */
uint32_t scene_add_shape(struct scene *scene, const struct shape *shape);
uint32_t scene_add_body(struct scene *scene, struct body body);
uint32_t scene_add_pair(struct scene *scene, uint32_t a, uint32_t b);

narc_bodies scene_bodies(const struct scene *scene);
narc_pairs scene_pairs(const struct scene *scene);

/* A body for the reference. */
struct reference_body scene_reference(const struct scene *scene, uint32_t body);
struct reference_body pose_shape(const struct shape *shape, const struct body *body);

/* A pose turned by `angle`, its cosine and sine rounded. */
struct body turned_body(double angle, double scale);

/* A copy of a position in single precision, in both members. */
void round_position(struct body *body, narc_precision precision);

/* Arrays for `capacity` contacts, filled with junk. */
struct contacts {
    narc_contacts view;
    size_t count;
};
struct contacts create_contacts(size_t capacity);
void destroy_contacts(struct contacts *contacts);

/* The batch calls with one thread; any error fails the test. scene_overlaps() allocates the words. */
uint64_t *scene_overlaps(const struct scene *scene);
struct contacts scene_contacts(const struct scene *scene, float margin);

/* Pairs of random bodies of random families, about half of which collide; no special placements, so it is fast. */
struct scene make_random_scene(struct test_random *random, narc_precision precision, size_t bodies, size_t pairs);

static inline bool bit_is_set(const uint64_t *bits, size_t k) { return bits[k / 64] >> (k % 64) & 1; }

#endif
