/* SPDX-License-Identifier: MIT
 *
 * without_dxf.c - in place of dxf.c in a build without dxflib.
 */
#include "error.h"
#include "narc_fit.h"

static narc_status refuse(const void *data, const void *out, narc_error *error) {
    return data && out ? narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "this build of narc reads no DXF files")
                       : narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an argument is NULL");
}

narc_status narc_read_dxf(const void *data, size_t size, const narc_dxf_request *request, narc_path *path,
                          narc_error *error) {
    (void)size, (void)request;
    return refuse(data, path, error);
}

narc_status narc_list_dxf_layers(const void *data, size_t size, char **out_names, narc_error *error) {
    (void)size;
    return refuse(data, out_names, error);
}
