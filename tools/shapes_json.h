/* SPDX-License-Identifier: MIT
 *
 * shapes_json.h - the shapes file: {"shapes": [{"name": ..., "arcs" or "points" or "polygon" ...: ...}, ...]}.
 */
#ifndef NARC_TOOL_SHAPES_JSON_H
#define NARC_TOOL_SHAPES_JSON_H

#include <stdio.h>

#include "shape_list.h"

/* Reads a file with at least one shape, and indexes its names. Errors name shape and arc. */
void read_shapes(const char *path, shape_list *out_shapes);

/* Writes every shape in the "arcs" form and its origin, with 17 significant digits, so that reading gives the same numbers. */
void write_shapes(FILE *file, const shape_list *shapes);

/* Writes a name as a JSON string. */
void write_name(FILE *file, const char *name);

#endif
