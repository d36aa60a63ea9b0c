/* SPDX-License-Identifier: MIT
 *
 * polyline.h - chains of lines, such as traced outlines, as arcs. Internal.
 */
#ifndef NARC_POLYLINE_H
#define NARC_POLYLINE_H

#include "biarc/biarc.h"

/* Lines from each of `points[0 .. count-1]` to the next; if `closed` the last is the first. No two successive ones are
 * the same. `slack` is how far the points may be from what they were traced in. */
typedef struct narc_polyline {
    const narc_point *points;
    size_t count;
    bool closed;
    double slack;
} narc_polyline;

/* Adds arcs and lines from the first point to the last, which join with a common tangent but at corners of the chain,
 * and no point of either further than `tolerance` from the other. NARC_ERROR_MEMORY; then the spline may have some. */
narc_status narc_fit_polyline(const narc_polyline *line, double tolerance, narc_spline *spline, narc_error *error);

#endif
