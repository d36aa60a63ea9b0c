/* SPDX-License-Identifier: MIT
 *
 * cut.h - a region cut into pieces that are convex, but for bays within a limit. Internal.
 */
#ifndef NARC_FIT_CUT_H
#define NARC_FIT_CUT_H

#include "parts/region.h"

/* A piece's hull, counter-clockwise; 1 or 2 corners if it is flat. */
typedef struct narc_piece {
    narc_point *corners;
    size_t count;
} narc_piece;

typedef struct narc_pieces {
    narc_piece *items;
    size_t count, capacity;
} narc_pieces;

/* The hull of points, which are sorted in place; `out_corners` has room for count + 1. Returns how many there are. */
size_t narc_wrap_points(narc_point *points, size_t count, narc_point *out_corners);

/* Pieces that hold all of the region; their hulls are within the region's limit of it, as far as cuts can make them. Of
 * `most` pieces or more NARC_ERROR_CAPACITY; NARC_ERROR_MEMORY. */
narc_status narc_cut_region(const narc_region *region, size_t most, narc_pieces *out_pieces);

/* Joins pieces whose common hull stays within the limit, those first that cover least empty ground; across others only while
 * there are more than `most`. */
narc_status narc_join_pieces(const narc_region *region, size_t most, narc_pieces *pieces);

void narc_release_pieces(narc_pieces *pieces);

#endif
