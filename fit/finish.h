/* SPDX-License-Identifier: MIT
 *
 * finish.h - from a chain to the arcs of a result: merged, rounded to single precision, certified, measured. Internal.
 */
#ifndef NARC_FIT_FINISH_H
#define NARC_FIT_FINISH_H

#include "chain.h"
#include "hull.h"

/* Where the hull that fits work on is in the outline: point = middle + radius * (the hull's point, turned by
 * `angle`). */
typedef struct scale {
    narc_point middle;
    double radius, angle;
} scale;

/* Fills in arcs, origin and every measure but `flatness` and `seconds`. `around` is scaled, as the chain. With `bound`,
 * the shape that the store makes of the arcs is made to contain the hull, inflation included. Errors: those of
 * narc_add_shape(), NARC_ERROR_NO_SOLUTION if rounding cannot be made up for (an outline hundreds of thousand times as
 * long as wide). */
narc_status narc_finish_fit(const chain *of, const hull *around, const scale *at, bool bound,
                            narc_fit_result *out_result, narc_error *error);

/* The same from arcs, in the scaled hull's coordinates. */
narc_status narc_finish_arcs(const narc_arc *arcs, size_t count, const hull *around, const scale *at, bool bound,
                             narc_fit_result *out_result, narc_error *error);

#endif
