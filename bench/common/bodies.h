/* SPDX-License-Identifier: MIT
 *
 * bodies.h - bodies at random, pairs that touch, pairs whose boxes overlap.
 */
#ifndef NARC_BENCH_BODIES_H
#define NARC_BENCH_BODIES_H

#include <stddef.h>
#include <stdint.h>

#include "narc.h"

/* A body's pose; its shape is an index into a store. */
struct body {
    float x, y, cosine, sine;
    uint32_t shape;
};

/* First bodies of pairs lie in a square of this half width: so near the origin that single precision costs nothing. */
#define HALF_SQUARE 8.0

/* Rotated at random, its centre in a square around the origin. */
struct body random_body(uint64_t *random, size_t shape, double half_width);

narc_bodies bodies_of(const struct body *bodies, size_t count);

/* Pairs (0, 1), (2, 3) ...: one list that serves all scenes whose pairs lie next to each other. */
narc_pairs neighbours(size_t pair_count);

/* The exact separations and normals of such pairs: contact k is that of pair k. */
void separate(const narc_shapes *shapes, const struct body *bodies, size_t pair_count, narc_contact *out);

/* Where the second body of a pair stands from the first: a unit vector. */
struct direction {
    double x, y;
};
struct direction random_direction(uint64_t *random);

void put_second(struct body *pair, struct direction direction, double distance);

/* For each of the pairs the distance at which the second body touches the first in its direction; `distances` holds
 * ones at which they are apart. Moves the second bodies. */
void find_touching(const narc_shapes *shapes, struct body *bodies, const struct direction *directions,
                   size_t pair_count, double *distances);

/* The box of a body around its position, in world axes. */
narc_aabb box_of(const narc_shapes *shapes, const struct body *body);

/* Puts B anywhere where the boxes of both overlap, all positions equally likely. */
void put_in_boxes(const narc_shapes *shapes, const struct body *a, struct body *b, uint64_t *random);

#endif
