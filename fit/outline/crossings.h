/* SPDX-License-Identifier: MIT
 *
 * crossings.h - where the lines of contours cross, touch or lie on each other. Internal.
 */
#ifndef NARC_FIT_CROSSINGS_H
#define NARC_FIT_CROSSINGS_H

#include "narc_fit.h"

/* A point of a line, between its ends, that another line has too. Of two that cross there is one for each; of two that
 * are one there is one at the beginning. */
typedef struct narc_crossing {
    size_t line, other; /* numbers of the points where they begin */
    double part;        /* of the line, up to the point: from 0, below 1 */
    narc_point at;
    bool crosses; /* rather than touches, or lies on the other one */
} narc_crossing;

typedef struct narc_crossings {
    narc_crossing *items;
    size_t count, capacity;
} narc_crossings;

/* All crossings, sorted by line and part. A last line closes contours that are closed; what is no further than `near` from
 * a line, or by roundings, touches it. To be freed. NARC_ERROR_MEMORY; NARC_ERROR_NOT_SIMPLE: there are millions. */
narc_status narc_find_crossings(const narc_contours *contours, bool closed, double near, narc_crossings *out_crossings,
                                narc_error *error);

/* The contour that a point belongs to. */
size_t narc_find_contour(const size_t *ends, size_t count, size_t point);

#endif
