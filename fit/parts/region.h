/* SPDX-License-Identifier: MIT
 *
 * region.h - the inside of an outline, holes left out, and how far points are from it. Internal.
 */
#ifndef NARC_FIT_REGION_H
#define NARC_FIT_REGION_H

#include "narc_fit.h"

/* A cell of the grid has one of these. */
typedef struct narc_cell_sums {
    double emptiness; /* how much there is to cut away, of this row's cells before this one */
    uint32_t far, unsure, inside;
} narc_cell_sums;

typedef struct narc_line {
    narc_point a, b;
} narc_line;

/* Contours with the inside on the left: outer ones counter-clockwise, holes clockwise. Long lines have points between
 * their ends. All numbers of contours are those of the outline. */
typedef struct narc_region {
    narc_point *points;
    size_t point_count, point_capacity;
    size_t *ends; /* contour k: points[ends[k - 1] .. ends[k] - 1] */
    size_t count;
    size_t *parents; /* of a hole: the contour around it; SIZE_MAX: an outer one */
    uint32_t *kept;  /* the points that are left of simpler contours; no contour is further than `slack` from its own */
    size_t *kept_ends;
    double slack;
    narc_point corner; /* of the grid */
    double extent, cell;
    size_t columns, rows;
    float *distances;     /* of each cell's centre, right to two thirds of a cell */
    narc_cell_sums *sums; /* rows of columns + 1 */
    narc_line *lines;     /* of the simpler contours */
    uint32_t *bucket_ends, *bucket_items, *row_ends, *row_items; /* lines that meet a bucket, or a row of them */
    double limit;                                                /* what the sums are for */
} narc_region;

/* Contours as loops that do not cross themselves, but may touch. `out_crosses`: are there lines that cross, touch or lie on
 * each other? NARC_ERROR_MEMORY; NARC_ERROR_NOT_SIMPLE: millions. */
narc_status narc_split_contours(const narc_contours *contours, narc_contours *out_loops, bool *out_crosses,
                                narc_error *error);

/* Holes that cross as loops that do not; none where no two holes cross. Errors as above. */
narc_status narc_split_holes(const narc_region *region, narc_contours *out_loops, narc_error *error);

/* Makes the contours; `slack` > 0. NARC_ERROR_COUNT: no points; NARC_ERROR_SIZE: all in one place; NARC_ERROR_MEMORY. */
narc_status narc_make_region(const narc_contours *contours, double slack, narc_region *out_region, narc_error *error);

/* Makes the grid. NARC_ERROR_MEMORY. */
narc_status narc_survey_region(narc_region *region, narc_error *error);

/* Makes the sums for this limit. */
void narc_limit_region(narc_region *region, double limit);

/* How much empty ground, with half the limit taken off, a convex polygon covers; and of the region, in cells, unless
 * `out_ground` is NULL. Cheap. */
double narc_measure_emptiness(const narc_region *region, const narc_point *corners, size_t count, double *out_ground);

/* Is no point of the polygon further than the limit from the (simpler) region? */
bool narc_is_within_limit(const narc_region *region, const narc_point *corners, size_t count);

/* Without looking closely: false means no. */
bool narc_may_be_within_limit(const narc_region *region, const narc_point *corners, size_t count);

/* The largest distance of its points, or up to a 2048th of the extent more. */
double narc_measure_gap(const narc_region *region, const narc_point *corners, size_t count);

/* The area inside, of contours that do not cross; of others that of their union. NARC_ERROR_MEMORY. */
double narc_measure_region(const narc_region *region);
narc_status narc_measure_crossing(const narc_region *region, double *out_area, narc_error *error);

void narc_release_region(narc_region *region);

#endif
