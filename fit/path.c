/* SPDX-License-Identifier: MIT
 *
 * path.c - stub
 */
#include "narc_fit.h"
#include "error.h"

typedef int stub_path;
narc_status narc_create_path(narc_path **out_path) { (void)out_path; return NARC_ERROR_MEMORY; }
void narc_destroy_path(narc_path *path) { (void)path; }
narc_status narc_move_to(narc_path *path, narc_point to, narc_error *error) { (void)path; (void)to;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
narc_status narc_line_to(narc_path *path, narc_point to, narc_error *error) { (void)path; (void)to;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
narc_status narc_quadratic_to(narc_path *path, narc_point control, narc_point to, narc_error *error) { (void)path; (void)to; (void)control;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
narc_status narc_cubic_to(narc_path *path, narc_point control_1, narc_point control_2, narc_point to, narc_error *error) { (void)path; (void)to; (void)control_1; (void)control_2;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
