/* SPDX-License-Identifier: MIT
 *
 * fit_inputs.h - from files of any kind to named outlines.
 */
#ifndef NARC_TOOL_FIT_INPUTS_H
#define NARC_TOOL_FIT_INPUTS_H

#include <stdio.h>

#include "narc_fit.h"
#include "options.h"
#include "sheets.h"

typedef struct outline {
    char *name;    /* a shape name, other than all before it */
    size_t copies; /* the last number that was put behind it for another one */
    const char *file;
    uint32_t character; /* of a glyph; 0: the outline of a whole file */
    narc_path *path;
    char *image; /* what a PNG or SVG drawing holds, if that is kept; of a frame its own */
    size_t image_size;
    size_t open_count;       /* strokes of a DXF drawing that do not close */
    double unit;             /* of a DXF drawing, in metres; 0: unknown */
    bool is_svg, is_picture; /* it was traced: all PNG, some SVG */
    bool is_object;          /* of many in a file: errors have its name */
} outline;

typedef struct outline_list {
    outline *items;
    size_t count, capacity;
    char **files; /* paths of all that were read, which outlines have */
    size_t file_count, file_capacity;
} outline_list;

typedef struct reading {
    const char *characters; /* which glyphs of fonts; NULL: none */
    const char *silhouette; /* of images and drawings: alpha, dark, light; NULL: the usual one */
    const char *ids;        /* of elements of SVG, with commas between; NULL: what all draw together */
    bool trace;             /* SVG files are drawn and traced even if they are plain */
    grid cells;             /* of PNG images that are sheets */
    double threshold;       /* of images and drawings, as in narc_image_request; 0: the usual one */
    bool keep_images;       /* in outlines */
    bool open;              /* lines of DXF that do not close are meant */
} reading;

/* The options that tell it, which stand one after the other. */
enum { CHARACTERS_OPTION, IDS_OPTION, SILHOUETTE_OPTION, THRESHOLD_OPTION, TRACE_OPTION, GRID_OPTION, READING_OPTIONS };
void name_reading_options(option *first);
reading take_reading(const option *first);

/* Reads files, and those folders that are named; of these the pictures: each font gives an outline for each character (once, without variation selectors), SVG one for each
 * id, each other file one. What a file is, its first bytes tell, and its suffix where they do not. It is an error if a setting has no file
 * to apply to. A command that keeps going leaves out what cannot be read. */
void read_outlines(const char *const *files, size_t count, const reading *how, outline_list *out_outlines);

/* An error in an outline; returns if the command keeps going. */
void report_outline(const outline *at, const char *message);

/* Leave some outlines out: outline `from` takes the place of one before it (or stays), and at the end the first `count`
 * are kept. */
void keep_outline(outline_list *outlines, size_t from, size_t to);
void cut_outlines(outline_list *outlines, size_t count);

/* Prints a cell of a table's first column, `width` characters wide; 0: as wide as the longest name and the word itself.
 * Returns the width. */
int print_name(FILE *file, const outline_list *outlines, const char *name, int width);

/* Tells which SVG drawings were read by their geometry, and which were drawn and traced. */
void print_ways(FILE *file, const outline_list *outlines);

/* The name of part `index` of `count`: that of the outline if there is one part, else NAME/1, NAME/2 ... To be freed. */
char *name_part(const outline *of, size_t index, size_t count);

void free_outlines(outline_list *outlines);

#endif
