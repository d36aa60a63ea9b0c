/* SPDX-License-Identifier: MIT
 *
 * bezier.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_fit_bezier(const narc_point *controls, size_t degree, double tolerance, narc_curve_arc *out_arcs, size_t capacity, size_t *out_count, double *out_distance, narc_error *error) { (void)controls; (void)degree; (void)tolerance; (void)out_arcs; (void)capacity; (void)out_count; (void)out_distance;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
