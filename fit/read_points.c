/* SPDX-License-Identifier: MIT
 *
 * read_points.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_read_csv(const void *data, size_t size, narc_path *path, narc_error *error) { (void)data; (void)size; (void)path;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
narc_status narc_read_json(const void *data, size_t size, narc_path *path, narc_error *error) { (void)data; (void)size; (void)path;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
