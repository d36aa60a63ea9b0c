/* SPDX-License-Identifier: MIT
 *
 * read_png.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_read_png(const void *data, size_t size, double threshold, narc_path *path, narc_error *error) { (void)data; (void)size; (void)path; (void)threshold;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
