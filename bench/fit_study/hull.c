/* SPDX-License-Identifier: MIT
 *
 * hull.c - an outline's convex hull with what the study asks of it.
 */
#include "hull.h"

#include <stdlib.h>

#include "fail.h"

hull make_hull(const char *name, const narc_point *points, size_t count) {
    hull made = {.corners = allocate(count, sizeof *made.corners), .normals = allocate(count, sizeof *made.normals)};
    narc_error error;
    if (narc_compute_hull(points, count, made.corners, &made.count, &error) != NARC_OK)
        fail("%s: %s", name, error.message);
    for (size_t k = 0; k < made.count; k++) {
        const narc_point from = made.corners[k], to = made.corners[(k + 1) % made.count], side = minus(to, from);
        made.normals[k] = (narc_point){side.y / length(side), -side.x / length(side)};
        made.perimeter += length(side);
        made.area += 0.5 * cross(minus(from, made.corners[0]), side);
    }
    return made;
}

void free_hull(hull *of) {
    free(of->corners);
    free(of->normals);
}
