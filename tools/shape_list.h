/* SPDX-License-Identifier: MIT
 *
 * shape_list.h - named shapes: their arcs in double precision, and the library's store of the same shapes.
 */
#ifndef NARC_TOOL_SHAPE_LIST_H
#define NARC_TOOL_SHAPE_LIST_H

#include "narc_shapes.h"

typedef struct shape {
    char *name;
    narc_arc *arcs;
    size_t arc_count;
    narc_point origin; /* of a fit: where the shape's origin is in the outline's coordinates */
    double bound;      /* radius of the smallest circle around it */
    double area;
} shape;

typedef struct name_entry {
    const char *name;
    uint32_t index;
} name_entry;

typedef struct shape_list {
    shape *items;
    size_t count, capacity;
    name_entry *by_name; /* sorted by name, then index */
    narc_shapes *store;  /* shape k of the store is item k */
} shape_list;

/* Adds a shape with origin 0, copying name and arcs; errors are those of narc_add_shape(). */
narc_status add_shape(shape_list *shapes, const char *name, const narc_arc *arcs, size_t arc_count, narc_error *error);

/* Sorts the names, after the last shape was added. Returns the index of a shape whose name another one before it has,
 * or `count` if all names differ. */
size_t index_shapes(shape_list *shapes);

/* The shape that `text` names: by its name, otherwise by its index. Returns `count` if there is none. */
size_t find_shape(const shape_list *shapes, const char *text);

void free_shapes(shape_list *shapes);

/* A name is valid UTF-8 that can stand as a field of a CSV file: not empty, no comma, quote or control character, no
 * blank at either end. */
bool is_shape_name(const char *name);

/* A name made of the first `length` bytes of any text: what cannot be in a name becomes '_', blanks at the ends go, and
 * digits alone, which would be an index, get "shape-" in front; of nothing it makes "shape". To be freed. */
char *make_shape_name(const char *text, size_t length);

#endif
