/* SPDX-License-Identifier: MIT
 *
 * flatten.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_flatten_path(const narc_path *path, double flatness, narc_contours *out_contours, narc_error *error) { (void)path; (void)flatness; (void)out_contours;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
void narc_release_contours(narc_contours *contours) { (void)contours; }
