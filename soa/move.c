/* SPDX-License-Identifier: MIT
 *
 * move.c - a list of arcs elsewhere: its centroid at the origin, or mirrored.
 */
#include <string.h>

#include "error.h"
#include "outline.h"

static narc_status check_list(const narc_arc *arcs, size_t count, const narc_arc *out_arcs, narc_error *error) {
    return out_arcs ? narc_validate_arcs(arcs, count, error)
                    : narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "out_arcs is NULL");
}

narc_status narc_center_arcs(const narc_arc *arcs, size_t count, narc_arc *out_arcs, narc_point *out_centroid,
                             narc_error *error) {
    narc_mass mass;
    const narc_status status = check_list(arcs, count, out_arcs, error);
    if (status != NARC_OK)
        return status;
    narc_compute_mass(arcs, count, &mass);
    for (size_t i = 0; i < count; i++) {
        out_arcs[i] = arcs[i];
        out_arcs[i].center_x -= mass.centroid_x;
        out_arcs[i].center_y -= mass.centroid_y;
    }
    if (out_centroid)
        *out_centroid = (narc_point){mass.centroid_x, mass.centroid_y};
    return NARC_OK;
}

/* A normal at the angle t goes to pi - t, and what came first counter-clockwise comes last. */
narc_status narc_mirror_arcs(const narc_arc *arcs, size_t count, narc_arc *out_arcs, narc_error *error) {
    narc_arc mirrored[NARC_MAX_ARCS];
    const narc_status status = check_list(arcs, count, out_arcs, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[count - 1 - i];
        mirrored[i] = (narc_arc){-arc->center_x, arc->center_y, arc->radius, NARC_PI - arc->end, NARC_PI - arc->start};
    }
    memcpy(out_arcs, mirrored, count * sizeof *mirrored);
    return NARC_OK;
}
