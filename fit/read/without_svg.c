/* SPDX-License-Identifier: MIT
 *
 * without_svg.c - in place of svg.c in a build without librsvg.
 */
#include "error.h"
#include "read/trace.h"

narc_status narc_read_svg(const void *data, size_t size, const narc_image_request *request, narc_path *path,
                          narc_error *error) {
    (void)size;
    const narc_image_request usual = {0};
    const narc_status status = narc_check_image_request(data, request ? request : &usual, path, error);
    return status ? status : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "this build of narc reads no SVG files");
}
