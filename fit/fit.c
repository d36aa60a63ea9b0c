/* SPDX-License-Identifier: MIT
 *
 * fit.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_fit_path(const narc_path *path, const narc_fit_request *request, narc_fit_result *out_result, narc_error *error) { (void)path; (void)request; (void)out_result;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
