/* SPDX-License-Identifier: MIT
 *
 * measures.c - energies, stress, counts, each grain's share of the contacts. All of them are sums over bodies or
 * contacts in their order, by one thread.
 */
#include <math.h>
#include <stdlib.h>

#include "dem.h"

static dem_energies measure_energies(const dem *d, double *out_fastest) {
    const dem_bodies *b = &d->bodies;
    const dem_vec g = d->settings.gravity;
    dem_energies e = {.elastic = d->normal_energy + d->tangential_energy + d->rolling_energy,
                      .damping = d->damping,
                      .friction = d->friction};
    double fastest = 0;
    for (size_t k = 0; k < d->grain_count; k++) {
        const double speed = b->vx[k] * b->vx[k] + b->vy[k] * b->vy[k];
        double x = b->x[k], y = b->y[k]; /* as if there were no border */
        x += d->settings.periodic_x ? b->cell_x[k] * dem_cell_width(d) : 0;
        y += d->settings.periodic_y ? b->cell_y[k] * dem_cell_height(d) : 0;
        e.kinetic += 0.5 * (b->mass[k] * speed + b->inertia[k] * b->spin[k] * b->spin[k]);
        e.potential -= b->mass[k] * (g.x * x + g.y * y);
        fastest = fmax(fastest, speed);
    }
    e.walls = d->shear_work;
    for (size_t w = 0; w < d->wall_count; w++)
        e.walls += d->walls[w].work;
    *out_fastest = sqrt(fastest);
    return e;
}

/* Across a periodic border: the image that is at `low` or the next one above. */
static double find_image(bool periodic, double value, double low, double width) {
    return periodic ? value - width * floor((value - low) / width) : value;
}

static bool is_inside(const dem *d, const dem_region *r, size_t contact, size_t a) {
    const dem_settings *s = &d->settings;
    const double point_x = d->bodies.x[a] + d->contacts.rows[contact].point.x;
    const double point_y = d->bodies.y[a] + d->contacts.rows[contact].point.y;
    const double y = find_image(s->periodic_y, point_y, r->low_y, dem_cell_height(d));
    const double aside = s->sheared ? d->offset * nearbyint((point_y - y) / dem_cell_height(d)) : 0;
    const double x = find_image(s->periodic_x, point_x - aside, r->low_x, dem_cell_width(d));
    return !r->given || (x >= r->low_x && x < r->high_x && y >= r->low_y && y < r->high_y);
}

/* The area that stresses refer to: the region's, else the periodic cell's, else that of the box around all grains'
 * centres, a reach larger. */
static double find_area(const dem *d, const dem_region *r) {
    const dem_settings *s = &d->settings;
    if (r->given)
        return (r->high_x - r->low_x) * (r->high_y - r->low_y);
    const dem_region all = dem_bound_grains(d);
    return (s->periodic_x ? dem_cell_width(d) : all.high_x - all.low_x) *
           (s->periodic_y ? dem_cell_height(d) : all.high_y - all.low_y);
}

void dem_measure(const dem *d, const dem_region *region, dem_measures *out_measures) {
    const dem_region all = {.given = false};
    const dem_region *r = region ? region : &all;
    const dem_contacts *c = &d->contacts;
    const dem_bodies *b = &d->bodies;
    dem_measures m = {.contacts = c->count};
    m.energy = measure_energies(d, &m.fastest);
    double ends = 0;
    for (size_t k = 0; k < c->count; k++) {
        const dem_contact *row = &c->rows[k];
        const dem_force *f = &row->force;
        const size_t p = row->pair, i = dem_body_a(d, p), j = dem_body_b(d, p);
        const bool is_wall = j >= d->grain_count;
        const double smaller = is_wall ? b->extent[i] : fmin(b->extent[i], b->extent[j]);
        ends += is_wall ? 1 : 2;
        m.deepest = fmax(m.deepest, row->depth / smaller);
        if (!is_inside(d, r, k, i))
            continue;
        /* From the centre of A to that of B; of a wall, to the contact. */
        const double x = is_wall ? row->point.x : b->x[j] - b->x[i] + (double)d->pairs.shift_x[p];
        const double y = is_wall ? row->point.y : b->y[j] - b->y[i] + (double)d->pairs.shift_y[p];
        m.stress_xx += f->x * x;
        m.stress_xy += f->x * y;
        m.stress_yx += f->y * x;
        m.stress_yy += f->y * y;
    }
    const double volume = find_area(d, r) * d->settings.thickness;
    m.coordination = ends / (double)d->grain_count;
    m.stress_xx /= volume;
    m.stress_xy /= volume;
    m.stress_yx /= volume;
    m.stress_yy /= volume;
    *out_measures = m;
}

/* ------------------------------------------------------------------------------------------------ loads */

double dem_normal_force(const dem_contact *c) { return c->force.x * c->normal.x + c->force.y * c->normal.y; }

/* Counts, takes away who is not held, counts again, until all are. */
static void find_bearing(const dem *d, dem_load *loads) {
    uint32_t least = 3;
    for (size_t i = 0; i < d->material_count * d->material_count; i++)
        if (d->laws[i / d->material_count][i % d->material_count].friction > 0)
            least = 2;
    for (size_t k = 0; k < d->bodies.count; k++)
        loads[k].bearing = least;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t k = 0; k < d->bodies.count; k++)
            loads[k].count = 0;
        for (size_t k = 0; k < d->contacts.count; k++) {
            const dem_contact *c = &d->contacts.rows[k];
            dem_load *a = &loads[dem_body_a(d, c->pair)], *b = &loads[dem_body_b(d, c->pair)];
            const bool bears = a->bearing > 0 && b->bearing > 0 && dem_normal_force(c) > 0;
            a->count += bears;
            b->count += bears;
        }
        for (size_t k = 0; k < d->grain_count; k++) {
            const uint32_t now = loads[k].bearing > 0 && loads[k].count >= least ? loads[k].count : 0;
            changed |= (now == 0) != (loads[k].bearing == 0);
            loads[k].bearing = now;
        }
    }
}

static void add_load(const dem *d, dem_load *loads, size_t k, double fx, double fy, double x, double y) {
    const double area = DEM_PI / 4 * d->bodies.extent[k] * d->bodies.extent[k];
    const double share = k < d->grain_count ? 1 / (area * d->settings.thickness) : 0;
    loads[k].contacts++;
    loads[k].stress_xx -= share * fx * x;
    loads[k].stress_xy -= share * fx * y;
    loads[k].stress_yx -= share * fy * x;
    loads[k].stress_yy -= share * fy * y;
}

dem_load *dem_find_loads(dem *d) {
    const dem_bodies *b = &d->bodies;
    dem_load *loads = calloc(b->count, sizeof *loads);
    if (!loads) {
        dem_fail(d, "not enough memory for a frame of %zu bodies", b->count);
        return NULL;
    }
    for (size_t k = 0; k < d->contacts.count; k++) {
        const dem_contact *c = &d->contacts.rows[k];
        const size_t p = c->pair, i = dem_body_a(d, p), j = dem_body_b(d, p);
        add_load(d, loads, i, -c->force.x, -c->force.y, c->point.x, c->point.y);
        add_load(d, loads, j, c->force.x, c->force.y, c->point.x + (b->x[i] - b->x[j] - (double)d->pairs.shift_x[p]),
                 c->point.y + (b->y[i] - b->y[j] - (double)d->pairs.shift_y[p]));
    }
    find_bearing(d, loads);
    return loads;
}

/* ------------------------------------------------------------------------------------------------ the hash */

/* FNV-1a, 64 bits, continued. */
uint64_t dem_hash_bytes(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

uint64_t dem_hash(const dem *d) {
    uint64_t hash = DEM_HASH_START;
    const void *column;
    size_t size;
    for (size_t i = 0; (column = dem_body_column(d, i, &size)) != NULL; i++)
        hash = dem_hash_bytes(hash, column, d->bodies.count * size);
    for (size_t k = 0; k < d->pairs.count; k++)
        if (d->pairs.memory[k].step == d->step)
            hash = dem_hash_bytes(hash, &d->pairs.memory[k], sizeof d->pairs.memory[k]);
    const double sums[] = {d->time,       d->damping,       d->friction,          d->offset,
                           d->shear_work, d->normal_energy, d->tangential_energy, d->rolling_energy};
    for (size_t w = 0; w < d->wall_count; w++)
        hash = dem_hash_bytes(hash, &d->walls[w].work, sizeof d->walls[w].work);
    hash = dem_hash_bytes(hash, &d->step, sizeof d->step);
    return dem_hash_bytes(hash, sums, sizeof sums);
}
