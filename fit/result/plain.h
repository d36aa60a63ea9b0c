/* SPDX-License-Identifier: MIT
 *
 * plain.h - circles, capsules, boxes, boxes with round corners and regular polygons seen in a hull. Internal.
 */
#ifndef NARC_FIT_PLAIN_H
#define NARC_FIT_PLAIN_H

#include "result/finish.h"

/* The first of these shapes that comes within `tolerance` of a scaled hull, with arcs as narc_build_circle() and its
 * neighbours make them where it lies along the axes. Errors: NARC_ERROR_NO_SOLUTION (none does), NARC_ERROR_MEMORY. */
narc_status narc_see_plain(const narc_hull *hull, const narc_frame *frame, bool bound, double tolerance,
                           double min_radius, narc_fit_result *out_result, narc_error *error);

#endif
