/* SPDX-License-Identifier: MIT
 *
 * sheets.h - images that hold many: frames by a grid, or by the JSON of TexturePacker or Aseprite.
 */
#ifndef NARC_TOOL_SHEETS_H
#define NARC_TOOL_SHEETS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Takes one frame, as it was before it was packed: a PNG file in memory. */
typedef void take_frame(const char *name, const char *png, size_t size, void *context);

/* Cells of a PNG image from left to right, row by row, named `name`-0, `name`-1 and so on. Those without any ink are left out. */
typedef struct grid {
    uint64_t width, height; /* of a cell, in pixels; 0: there is no grid */
} grid;
grid parse_grid(const char *text);
void read_grid(const char *file, const char *bytes, size_t size, grid cells, const char *name, take_frame *take,
               void *context);

/* The frames that JSON tells, each with its name, in its own size: trimmed ones get their border back, rotated ones are
 * turned back. The image is looked for beside the file. False: it is no such JSON, and nothing is told. */
bool read_sheet(const char *file, const char *bytes, size_t size, take_frame *take, void *context);

#endif
