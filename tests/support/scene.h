/* SPDX-License-Identifier: MIT
 *
 * scene.h - shapes, bodies and pairs as a test makes them, in double precision and as a batch call wants them.
 */
#ifndef NARC_TEST_SCENE_H
#define NARC_TEST_SCENE_H

#include "families.h"
#include "narc.h"
#include "narc_scene.h"
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

/* Two bodies and their pair. */
void scene_add_two(struct scene *scene, struct body a, struct body b);

narc_bodies scene_bodies(const struct scene *scene);
narc_body scene_body(const struct scene *scene, uint32_t index);
narc_pairs scene_pairs(const struct scene *scene);

/* Motions of bodies, as columns. */
narc_motions view_motions(const narc_motion *motion);

/* A body for the reference, its rotation made of length 1, as the library does. */
struct reference_body scene_reference(const struct scene *scene, uint32_t body);
struct reference_body pose_shape(const struct shape *shape, const struct body *body);

/* A pose turned by `angle`, its cosine and sine rounded. */
struct body turned_body(double angle, double scale);

/* A copy of a position in single precision, in both members. */
void round_position(struct body *body, narc_precision precision);

/* The body after it has flown away: 1e20, 1e24, 1e30 or 1e38 along an axis or between both, another way for each k below
 * 24. It is sound, and has a box. */
struct body fly_away(struct body body, size_t k, narc_precision precision);

/* A step of all bodies, small or not. */
void scene_move_bodies(struct scene *scene, struct test_random *random, double step);

/* Rows and how many of them are used; whoever gets such a list frees its rows. */
struct contacts {
    narc_contact *rows;
    size_t count;
};
struct manifolds {
    narc_manifold *rows;
    size_t count;
};

/* `size` bytes of junk. */
void *make_junk(size_t size);
bool is_junk(const void *memory, size_t size);

/* The batch calls into new memory, with room for a row for each pair; any error fails the test. The words and rows are
 * junk before. */
uint64_t *find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                        const narc_query *query);
struct contacts find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                              const narc_query *query);
struct manifolds find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query);

/* The same for all pairs of a scene, into memory of the caller's. */
narc_status ask_overlaps(const struct scene *scene, const narc_query *query, uint64_t *out_bits, narc_error *error);
narc_status ask_contacts(const struct scene *scene, const narc_query *query, narc_contact *out_rows, size_t capacity,
                         size_t *out_count, narc_error *error);

/* The same into new memory, in the calling thread. */
uint64_t *scene_overlaps(const struct scene *scene);
struct contacts scene_contacts(const struct scene *scene, float margin);
struct manifolds scene_manifolds(const struct scene *scene, float margin);

/* Pairs of random bodies of random families, about half of which collide; no special placements, so it is fast. */
struct scene make_random_scene(struct test_random *random, narc_precision precision, size_t bodies, size_t pairs);

/* The arcs of a feature, whether they touch or the edges before them. */
static inline unsigned arc_of_a(unsigned feature) { return feature & 0x3f; }
static inline unsigned arc_of_b(unsigned feature) { return feature >> 8 & 0x3f; }

static inline bool bit_is_set(const uint64_t *bits, size_t k) { return bits[k / 64] >> (k % 64) & 1; }

/* An index of the boxes of bodies, which come to `out_boxes`; options may be NULL. */
narc_index *index_bodies(const narc_shapes *shapes, const narc_bodies *bodies, const narc_index_options *options,
                         narc_box *out_boxes);

#endif
