/* SPDX-License-Identifier: MIT
 *
 * shapes.c - outlines, and shapes of one or several; chains.
 */
#include <math.h>

#include "dem.h"

#include <narc_chains.h>

/* Moves an outline by -centroid, and adds it to the store. */
static void add_outline(dem *d, const char *name, const narc_arc *arcs, size_t count, const narc_mass *mass,
                        double *reach) {
    narc_arc moved[NARC_MAX_ARCS];
    narc_error error;
    const size_t k = d->outline_count;
    dem_outline *outline;
    dem_grow(&d->outlines, k + 1, sizeof *d->outlines);
    dem_demand(d, narc_move_arcs(arcs, count, -mass->centroid_x, -mass->centroid_y, 0, 1, moved, &error), name, &error);
    outline = &d->outlines[k];
    *outline = (dem_outline){.side_count = count};
    dem_demand(d, narc_add_shape(d->store, moved, count, &outline->stored, &error), name, &error);
    make_touch_sides(moved, count, outline->sides);
    d->outline_count++;
    *reach = fmax(*reach, find_outline_reach(moved, count));
}

static uint32_t put_shape(dem *d, const char *name, dem_shape *shape) {
    snprintf(shape->name, sizeof shape->name, "%s", name);
    dem_grow(&d->shapes, d->shape_count + 1, sizeof *d->shapes);
    d->shapes[d->shape_count] = *shape;
    return (uint32_t)d->shape_count++;
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
    return put_shape(d, name, &shape);
}

uint32_t dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count) {
    return dem_add_compound(d, name, arcs, &count, 1);
}

/* Its entries, as touch.h has them. Their own coordinates are floats: a place of theirs is known to the rounding of those. */
uint32_t dem_add_chain(dem *d, const char *name, const narc_arc *arcs, size_t count, bool closed) {
    const narc_chain_options options = {.closed = closed};
    narc_chain_entry *entries = NULL;
    narc_error error;
    size_t entry_count = 8 * count + 64, room = 0;
    narc_status status = NARC_ERROR_CAPACITY;
    while (status == NARC_ERROR_CAPACITY && room < entry_count) {
        room = entry_count;
        dem_grow(&entries, room, sizeof *entries);
        status = narc_add_chain(d->store, arcs, count, &options, entries, room, &entry_count, &error);
    }
    dem_demand(d, status, name, &error);
    dem_shape shape = {
        .first_outline = (uint32_t)d->outline_count, .outline_count = (uint32_t)entry_count, .is_chain = true};
    dem_grow(&d->outlines, d->outline_count + entry_count, sizeof *d->outlines);
    for (const narc_chain_entry *e = entries; e < entries + entry_count; e++) {
        narc_arc piece[NARC_MAX_ARCS];
        dem_outline *outline = &d->outlines[d->outline_count++];
        *outline = (dem_outline){.stored = e->shape, .at = {e->x, e->y}};
        outline->side_count = narc_get_arcs(d->store, e->shape, piece);
        make_touch_sides(piece, outline->side_count, outline->sides);
        for (size_t i = 0; i < outline->side_count; i++) {
            touch_side *side = &outline->sides[i];
            side->x += e->x;
            side->y += e->y;
        }
    }
    for (const narc_arc *arc = arcs; arc < arcs + count; arc++)
        shape.reach = fmax(shape.reach, hypot(arc->center_x, arc->center_y) + fabs(arc->radius));
    dem_release(entries);
    return put_shape(d, name, &shape);
}
