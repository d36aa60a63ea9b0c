/* SPDX-License-Identifier: MIT
 *
 * simple.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_check_simple(const narc_path *path, narc_error *error) { (void)path;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
