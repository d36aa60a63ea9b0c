/* SPDX-License-Identifier: MIT
 *
 * narc_files.h - named shapes in files: the shapes files of the narc command (docs/formats.md), from memory to memory.
 *
 * Opening, reading and writing files is the caller's part. The library keeps no globals and prints nothing; all
 * functions may be called from several threads, each with lists and stores of its own. Numbers are the same in every
 * locale. On an error the outputs are untouched.
 *
 * Example
 *
 *     narc_shape_list *list = NULL;
 *     narc_shapes *shapes = NULL;
 *     narc_error error;
 *     if (narc_create_shapes(NULL, &shapes) || narc_read_shapes(data, size, NULL, shapes, &list, &error))
 *         return print(error.message);                      (line 3: shape 'lens', arc 2: radius is missing)
 *     size_t k = narc_find_named_shape(list, "lens");
 *     if (k < list->count)
 *         body.shape = list->items[k].index;
 *     narc_destroy_shape_list(list);                        (the store keeps the shapes)
 */
#ifndef NARC_FILES_H
#define NARC_FILES_H

#include "narc_shapes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a named shape is: convex and closed; a chain of pieces, such as ground, open or closed; or ground without end, the
 * half-plane of narc_add_half_plane(), which has no arcs. A chain's arcs go with
 * the solid on their left, like those of shapes. One with a radius below 0 is concave: the solid is outside of its circle,
 * its normals turn clockwise from `start` to `end`, and its points are center + radius * normal too. Radius -0 is the
 * bottom of a valley, and so is 0 where normals turn clockwise. An arc of radius 0 whose start is its end is a plain
 * point, such as the free end of an edge. */
typedef enum narc_form {
    NARC_FORM_SHAPE = 0,
    NARC_FORM_OPEN_CHAIN = 1,
    NARC_FORM_CLOSED_CHAIN = 2,
    NARC_FORM_HALF_PLANE = 3
} narc_form;

typedef struct narc_named_shape {
    /* UTF-8, NUL-terminated, and fit to be a field of a CSV file: not empty, no comma, quote or control character, no
     * blank at either end. Digits alone may only be the shape's own number in its file. */
    const char *name;
    const narc_arc *arcs; /* 1 .. NARC_MAX_ARCS; of chains any number, of half-planes none */
    size_t arc_count;
    narc_point origin; /* of a fit: where the shape's origin is in the coordinates of its outline; else 0 */
    uint32_t index;    /* in the store it was added to; 0 without a store and of chains, and not written */
    narc_form form;
} narc_named_shape;

/* The shapes of a file, in its order, with names that differ. The list owns all of it. */
typedef struct narc_shape_list {
    size_t count;
    const narc_named_shape *items;
} narc_shape_list;

/* Reads a shapes file of `size` bytes, and adds each shape, but no chain, to `store` unless that is NULL. What a store
 * would not take is an error, of chains too, also if `store` is NULL. What stands under a key "user" is not looked at;
 * "$schema" is any text. The list's memory comes from `allocator`, NULL: malloc() and free(); cJSON, which parses, uses
 * malloc(). The list may outlive the data and the store.
 * Errors: NARC_ERROR_ARGUMENT (NULL, an allocator without a function), NARC_ERROR_MEMORY; NARC_ERROR_FORMAT (no JSON, a
 * key that is unknown, missing or there twice, a value of another kind, a name that cannot be one or is another
 * shape's), NARC_ERROR_COUNT (no shape, too many arcs or points), NARC_ERROR_NOT_FINITE; and those of the
 * builders, narc_add_shape() and narc_add_chain().
 * error->index is the line, 0 where none is known; the message begins with it, "line 3: ", and names the shape, its arc
 * or point, and the value. Shapes that were added to the store before an error are removed again. */
NARC_API narc_status narc_read_shapes(const void *data, size_t size, const narc_allocator *allocator,
                                      narc_shapes *store, narc_shape_list **out_shapes, narc_error *error);

/* The place in the list of the shape with this name; shapes->count if there is none. */
NARC_API size_t narc_find_named_shape(const narc_shape_list *shapes, const char *name);

/* Frees a list; NULL is fine. */
NARC_API void narc_destroy_shape_list(narc_shape_list *shapes);

/* Writes `shapes[0 .. count-1]`, count > 0, as a shapes file: arcs and origin of each, with 17 significant digits, so that
 * reading gives the same bits; circles, capsules, boxes and polygons by their few numbers where these give them, too. The text, of *out_size bytes and a NUL behind them, is the caller's: memory of `allocator`,
 * NULL: of malloc(). Equal shapes give equal bytes.
 * Errors: NARC_ERROR_ARGUMENT (NULL, an allocator without a function), NARC_ERROR_MEMORY, NARC_ERROR_COUNT (no shape), NARC_ERROR_FORMAT (a name that
 * cannot be one or is another shape's), NARC_ERROR_NOT_FINITE (an origin), and those of narc_add_shape() and
 * narc_add_chain(), which are asked about all that is written.
 * error->index is the shape's place. */
NARC_API narc_status narc_write_shapes(const narc_named_shape *shapes, size_t count, const narc_allocator *allocator,
                                       char **out_text, size_t *out_size, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
