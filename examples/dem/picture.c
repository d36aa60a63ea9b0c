/* SPDX-License-Identifier: MIT
 *
 * picture.c - pictures of grains and walls.
 */
#include "dem.h"

bool dem_draw_picture(const dem *d, const dem_region *region, const char *path, double width, char *error) {
    (void)d;
    (void)region;
    (void)width;
    snprintf(error, 512, "%s: this build draws no pictures", path);
    return false;
}
