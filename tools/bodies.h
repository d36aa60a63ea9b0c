/* SPDX-License-Identifier: MIT
 *
 * bodies.h - the bodies and pairs files.
 */
#ifndef NARC_TOOL_BODIES_H
#define NARC_TOOL_BODIES_H

#include "narc_files.h"
#include "narc_pairs.h"

typedef struct body {
    double x, y;
    float cosine, sine, scale;
    uint32_t shape, item; /* its place in the store, and in the file of shapes */
} body;

typedef struct body_list {
    body *items;
    size_t count, capacity;
} body_list;

typedef struct pair {
    uint32_t a, b;
} pair;

typedef struct pair_list {
    pair *items;
    size_t count, capacity;
} pair_list;

/* Reads a CSV file with the columns shape, x, y, angle and perhaps scale. */
void read_bodies(const char *path, const narc_shape_list *shapes, body_list *out_bodies);

/* Reads a CSV file with the columns a and b: indices of bodies. */
void read_pairs(const char *path, size_t body_count, pair_list *out_pairs);

/* The bodies' bounding boxes in the world, to be freed. */
narc_aabb *bound_bodies(const narc_shapes *store, const body_list *bodies);

/* Both as the library wants them. */
narc_bodies view_bodies(const body_list *bodies);
narc_pairs view_pairs(const pair_list *pairs);

#endif
