/* SPDX-License-Identifier: MIT
 *
 * shapes.c - outlines, and shapes of one or several.
 */
#include <math.h>

#include "dem.h"

/* Moves an outline by -centroid, and adds it to the store: one index for each, also of equal ones. */
static void add_outline(dem *d, const char *name, const narc_arc *arcs, size_t count, const narc_mass *mass,
                        double *reach) {
    narc_arc moved[NARC_MAX_ARCS];
    narc_error error;
    const size_t k = d->outline_count;
    dem_grow(&d->outlines, k + 1, sizeof *d->outlines);
    dem_demand(d, narc_move_arcs(arcs, count, -mass->centroid_x, -mass->centroid_y, 0, 1, moved, &error), name, &error);
    dem_demand(d, narc_add_shape_at(d->store, (uint32_t)k, moved, count, &error), name, &error);
    d->outlines[k].side_count = count;
    make_touch_sides(moved, count, d->outlines[k].sides);
    d->outline_count++;
    *reach = fmax(*reach, find_outline_reach(moved, count));
}

uint32_t dem_add_compound(dem *d, const char *name, const narc_arc *arcs, const size_t *counts, size_t part_count) {
    narc_error error;
    narc_mass mass;
    dem_shape shape = {.first_outline = (uint32_t)d->outline_count, .outline_count = (uint32_t)part_count};
    dem_demand(d, narc_compute_union_mass(arcs, counts, part_count, NULL, &mass, &error), name, &error);
    if (!(mass.area > 0))
        dem_fail(d, "%s: the shape encloses no area", name);
    if (part_count == 1) /* simpler sums, of fewer roundings */
        narc_compute_mass(arcs, counts[0], &mass);
    for (size_t part = 0; part < part_count; arcs += counts[part++])
        add_outline(d, name, arcs, counts[part], &mass, &shape.reach);
    shape.area = mass.area;
    shape.second_moment = mass.second_moment;
    shape.extent = 2 * sqrt(mass.area / DEM_PI);
    snprintf(shape.name, sizeof shape.name, "%s", name);
    dem_grow(&d->shapes, d->shape_count + 1, sizeof *d->shapes);
    d->shapes[d->shape_count] = shape;
    return (uint32_t)d->shape_count++;
}

uint32_t dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count) {
    return dem_add_compound(d, name, arcs, &count, 1);
}
