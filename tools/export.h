/* SPDX-License-Identifier: MIT
 *
 * export.h - shapes as other programs take them: bodies of a few kinds of pieces, in the target's coordinates.
 */
#ifndef NARC_TOOL_EXPORT_H
#define NARC_TOOL_EXPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "narc_files.h"

/* A corner of an outline. From it to the next one goes a straight edge, bulge 0, or an arc that turns by 4 atan(bulge):
 * above 0 counter-clockwise. */
typedef struct corner {
    double x, y, bulge;
} corner;

/* Outlines and loops are closed; outlines are convex and counter-clockwise, as their numbers tell: where y points down
 * that looks clockwise. The bits of a set. */
typedef enum piece_kind { CIRCLE = 1, CAPSULE = 2, BOX = 4, OUTLINE = 8, LOOP = 16, LINE = 32, ARCS = 64 } piece_kind;

typedef struct piece {
    piece_kind kind;
    const char *name; /* of its shape */
    corner *corners;  /* of every kind */
    size_t count;
    narc_point center, low;       /* of circles, capsules and boxes; the corner of their least coordinates */
    double radius, width, height; /* a capsule's width is its whole length */
    double angle;                 /* of a capsule's axis */
} piece;

typedef struct export_body {
    const char *name; /* of a compound: what its parts' names begin with */
    piece *pieces;
    size_t count, capacity;
    narc_point origin; /* of its first shape, in the coordinates of the input */
    narc_aabb box;
    const char *image; /* of a tile; on a sheet NULL */
    unsigned tile, width, height;
} export_body;

typedef struct exported {
    export_body *bodies;
    size_t count, capacity;
    narc_aabb box;
    const char *sheet; /* of tiles: one image of all; NULL: each has its own */
    unsigned sheet_width, sheet_height;
} exported;

typedef struct export_format {
    const char *name;
    bool y_down;
    unsigned keeps;      /* kinds of pieces; ARCS: arcs in outlines, loops and lines */
    size_t most_corners; /* of an outline; 0: any number */
    bool one, tiles;     /* a file holds one piece; bodies are tiles of images */
    void (*write)(FILE *file, const exported *what);
} export_format;

/* Shapes NAME/1, NAME/2 ... of a file are one body NAME. Lists the shapes of the body that begins with shape k, at most
 * shapes->count; 0: it is a part of one that begins elsewhere. Free the name. */
size_t list_parts(const narc_shape_list *shapes, size_t k, size_t *out_parts, char **out_name);

/* How far an arc turns, counter-clockwise if it is convex. Its angles are whole turns away from any others. */
double find_turn(const narc_arc *arc);

/* Ends with one without a name. */
extern const export_format export_formats[];

/* The circle of an arc between two corners. */
typedef struct bent {
    narc_point center;
    double radius, start, turn; /* the first corner is at angle `start` */
} bent;
bent bend(const corner *from, const corner *to);

#endif
