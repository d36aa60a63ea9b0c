/* SPDX-License-Identifier: MIT
 *
 * read_svg.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_read_svg(const void *data, size_t size, narc_path *path, narc_error *error) { (void)data; (void)size; (void)path;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
