/* SPDX-License-Identifier: MIT
 *
 * frames.c - what files for ParaView and tables have in common.
 */
#include "frames.h"

#include <math.h>
#include <stdlib.h>

#include "internal.h"

static void add_load(dem_load *load, dem_vec force, dem_vec arm) {
    load->contacts++;
    load->stress_xx -= force.x * arm.x;
    load->stress_xy -= force.x * arm.y;
    load->stress_yx -= force.y * arm.x;
    load->stress_yy -= force.y * arm.y;
}

static void scale_load(dem_load *load, double by) {
    load->stress_xx *= by;
    load->stress_xy *= by;
    load->stress_yx *= by;
    load->stress_yy *= by;
}

static uint32_t find_least_contacts(const dem *d) {
    for (size_t a = 0; a < d->material_count; a++)
        for (size_t b = 0; b < d->material_count; b++)
            if (d->laws[a][b].friction > 0)
                return 2;
    return 3;
}

/* Counts, takes away who is not held, counts again, until all are. */
static void find_bearing(const dem *d, dem_load *loads) {
    const uint32_t least = find_least_contacts(d);
    for (size_t k = 0; k < d->bodies.count; k++)
        loads[k].bearing = least;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t k = 0; k < d->bodies.count; k++)
            loads[k].count = 0;
        for (size_t k = 0; k < d->contacts.count; k++) {
            const size_t p = d->contacts.rows[k].pair;
            dem_load *a = &loads[dem_body_a(d, p)], *b = &loads[dem_body_b(d, p)];
            const bool bears = a->bearing > 0 && b->bearing > 0 && dem_normal_force(d, k) > 0;
            a->count += bears;
            b->count += bears;
        }
        for (size_t k = 0; k < d->bodies.count; k++) {
            const uint32_t now = loads[k].bearing == 0 || (loads[k].count < least && k < d->grain_count)
                                     ? 0
                                     : (k < d->grain_count ? loads[k].count : least);
            changed |= (now == 0) != (loads[k].bearing == 0);
            loads[k].bearing = now;
        }
    }
}

dem_load *dem_find_loads(const dem *d, char *error) {
    const dem_contacts *c = &d->contacts;
    const dem_bodies *b = &d->bodies;
    dem_load *loads = calloc(b->count, sizeof *loads);
    if (!loads) {
        snprintf(error, 512, "not enough memory for a frame of %zu bodies", b->count);
        return NULL;
    }
    for (size_t k = 0; k < c->count; k++) {
        const size_t p = c->rows[k].pair, i = dem_body_a(d, p), j = dem_body_b(d, p);
        const dem_force f = c->rows[k].force;
        const dem_vec arm_i = c->rows[k].point;
        const dem_vec arm_j = {arm_i.x + (b->x[i] - b->x[j] - (double)d->pairs.shift_x[p]),
                               arm_i.y + (b->y[i] - b->y[j] - (double)d->pairs.shift_y[p])};
        add_load(&loads[i], (dem_vec){-f.x, -f.y}, arm_i);
        add_load(&loads[j], (dem_vec){f.x, f.y}, arm_j);
    }
    find_bearing(d, loads);
    for (size_t k = 0; k < b->count; k++) {
        const double area = 0.78539816339744831 * b->extent[k] * b->extent[k]; /* pi / 4 */
        scale_load(&loads[k], k < d->grain_count ? 1 / (area * d->settings.thickness) : 0);
    }
    return loads;
}

double dem_normal_force(const dem *d, size_t k) {
    const dem_contact *row = &d->contacts.rows[k];
    return row->force.x * row->normal.x + row->force.y * row->normal.y;
}

double dem_tangential_force(const dem *d, size_t k) {
    const dem_contact *row = &d->contacts.rows[k];
    return row->force.y * row->normal.x - row->force.x * row->normal.y;
}

/* ------------------------------------------------------------------------------------------------ places */

static void add_box(dem_region *r, double low_x, double low_y, double high_x, double high_y) {
    r->low_x = fmin(r->low_x, low_x);
    r->low_y = fmin(r->low_y, low_y);
    r->high_x = fmax(r->high_x, high_x);
    r->high_y = fmax(r->high_y, high_y);
}

dem_region dem_bound_all(const dem *d) {
    const dem_bodies *b = &d->bodies;
    dem_region r = dem_bound_grains(d);
    for (size_t w = 0; w < d->wall_count; w++) {
        const size_t k = d->grain_count + w;
        narc_arc arcs[NARC_MAX_ARCS];
        narc_aabb box;
        const size_t first = b->first_part[k], parts = d->shapes[b->shape[k]].outline_count;
        for (size_t i = first; i < first + parts && d->walls[w].kind != DEM_PLATE; i++) {
            const size_t count = narc_get_arcs(d->store, d->parts.outline[i], arcs);
            const double scale = (double)b->scale[k];
            if (narc_compute_aabb(arcs, count, atan2(b->sine[k], b->cosine[k]), &box))
                add_box(&r, b->x[k] + scale * box.min_x, b->y[k] + scale * box.min_y, b->x[k] + scale * box.max_x,
                        b->y[k] + scale * box.max_y);
        }
    }
    return r;
}

void dem_outline_plate(const dem *d, size_t wall, const dem_region *along, dem_vec out_corners[4]) {
    const dem_bodies *b = &d->bodies;
    const dem_wall *w = &d->walls[wall];
    const size_t k = d->grain_count + wall;
    const double half = dem_half_block(d, w);
    const dem_vec n = w->normal, t = {-n.y, n.x};
    const dem_vec middle = {0.5 * (along->low_x + along->high_x) - b->x[k] - half * n.x,
                            0.5 * (along->low_y + along->high_y) - b->y[k] - half * n.y};
    /* How far the region reaches from its middle along the plate. */
    const double reach =
        0.5 * (fabs(t.x) * (along->high_x - along->low_x) + fabs(t.y) * (along->high_y - along->low_y));
    const double foot = middle.x * t.x + middle.y * t.y, thick = d->grain_extent;
    const dem_vec face = {b->x[k] + half * n.x + foot * t.x, b->y[k] + half * n.y + foot * t.y};
    for (int i = 0; i < 4; i++) { /* the tangent is a quarter turn from the normal: the face comes first */
        const double side = i == 0 || i == 3 ? -reach : reach, depth = i < 2 ? 0 : thick;
        out_corners[i] = (dem_vec){face.x + side * t.x - depth * n.x, face.y + side * t.y - depth * n.y};
    }
}
