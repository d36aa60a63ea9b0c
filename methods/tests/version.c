/* SPDX-License-Identifier: MIT
 *
 * version.c - the library of other methods refuses to work with another version of narc. A program's own narc_version()
 * stands in for that of an older library.
 */
#include <stdio.h>
#include <string.h>

#include "narc_methods.h"

const char *narc_version(void) { return "0.0.7"; }

int main(void) {
    narc_shapes *shapes = NULL;
    narc_methods *methods = NULL;
    narc_error error = {NARC_OK, 0, 0, ""};
    if (narc_create_shapes(NULL, &shapes) != NARC_OK)
        return 1;
    const narc_status status = narc_create_methods(shapes, NULL, &methods, &error);
    printf("%s: %s\n", narc_status_name(status), error.message);
    narc_destroy_shapes(shapes);
    return status == NARC_ERROR_VERSION && !methods && strstr(error.message, "0.0.7") ? 0 : 1;
}
