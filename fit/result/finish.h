/* SPDX-License-Identifier: MIT
 *
 * finish.h - from a chain to the arcs of a result: merged, rounded to single precision, certified, measured. Internal.
 */
#ifndef NARC_FIT_FINISH_H
#define NARC_FIT_FINISH_H

#include "model/chain.h"
#include "model/profile.h"
#include "outline/hull.h"

/* Where the hull that fits work on is in the outline: point = middle + radius * (the hull's point, turned by
 * `angle`). */
typedef struct narc_frame {
    narc_point middle;
    double radius, angle;
    bool keep_origin; /* of results: arcs have the outline's coordinates, rounded as far from 0 as they are */
    const narc_contours *outline; /* its own points, with the flatness of its curves: what a fit must hold */
} narc_frame;

/* Fills in arcs, origin and every measure but `flatness` and `seconds`. `hull` is scaled, as the chain is. With
 * `bound`, the stored shape is made to contain the outline's points: its outline moves out as far as that takes.
 * Errors: those of narc_add_shape(); NARC_ERROR_NO_SOLUTION if that takes more than the shape's own size. */
narc_status narc_finish_fit(const narc_chain *chain, const narc_hull *hull, const narc_frame *frame, bool bound,
                            narc_fit_result *out_result, narc_error *error);

/* The same from arcs, in the scaled hull's coordinates. */
narc_status narc_finish_arcs(const narc_arc *arcs, size_t count, const narc_hull *hull, const narc_frame *frame,
                             bool bound, narc_fit_result *out_result, narc_error *error);

/* Its parts, for arcs as seen from the shape's origin, which are taken as they are. How far they reach beyond a hull
 * without its inflation; false without memory. */
bool narc_compare_arcs(const narc_arc *arcs, size_t count, const narc_hull *hull, narc_difference_range *out_range);

/* The clearance of what the store makes of arcs; `origin` is theirs in the outline. Errors: those of narc_add_shape(). */
narc_status narc_certify_arcs(const narc_arc *arcs, size_t count, const narc_frame *frame, narc_point origin,
                              double *out_clearance, narc_error *error);

/* Fills in arcs and measures; result->arc_count is set. NARC_ERROR_MEMORY. */
narc_status narc_measure_arcs(const narc_hull *hull, const narc_arc *arcs, narc_fit_result *result, narc_error *error);

double narc_to_single(double x);

#endif
