/* SPDX-License-Identifier: MIT
 *
 * bodies.h - the bodies and pairs files.
 */
#ifndef NARC_TOOL_BODIES_H
#define NARC_TOOL_BODIES_H

#include <stdbool.h>
#include <stdio.h>

#include "narc_chains.h"
#include "narc_files.h"

typedef struct body {
    double x, y;
    float cosine, sine, scale;
    uint32_t shape, item; /* its place in the store, and in the file of shapes */
    uint32_t row, part;   /* of a body in parts, each of which is a body here: its row in the file, the part's number */
} body;

typedef struct body_list {
    body *items;
    size_t count, capacity;
    size_t row_count; /* of the file: fewer if bodies have several parts */
} body_list;

/* The entries of a chain in the store; none of other shapes. */
typedef struct chain_entries {
    narc_chain_entry *items;
    size_t count;
} chain_entries;

typedef struct pair {
    uint32_t a, b;
} pair;

typedef struct pair_list {
    pair *items;
    size_t count, capacity;
} pair_list;

/* Reads a CSV file with the columns shape, x, y, angle and perhaps scale. A shape that is no name, but is with /1 behind
 * it, is one in parts: that and /2, /3 ... as they lie about the centroid of all. The parts of a chain are its entries;
 * chains that bodies name are added to the store. `shapes_path` is for errors of theirs. */
void read_bodies(const char *path, const char *shapes_path, const narc_shape_list *shapes, narc_shapes *store,
                 body_list *out_bodies);

/* Reads a CSV file with the columns a and b: rows of bodies. Of bodies in parts all pairs of parts are listed. */
void read_pairs(const char *path, const body_list *bodies, pair_list *out_pairs);

/* Has a body several parts? Drops the pairs of parts of one body. */
bool has_parts(const body_list *bodies);
void drop_own_pairs(const body_list *bodies, pair_list *pairs);

/* The bodies' bounding boxes in the world, to be freed. */
narc_aabb *bound_bodies(const narc_shapes *store, const body_list *bodies);

/* How many rows of the file have none in single precision, as narc_compute_boxes() says: they are too far out.
 * print_unboxed() tells of them in a report, if there are any. */
size_t count_unboxed(const narc_shapes *store, const body_list *bodies);
void print_unboxed(FILE *file, size_t count);

/* Both as the library wants them. */
narc_bodies view_bodies(const body_list *bodies);
narc_pairs view_pairs(const pair_list *pairs);

#endif
