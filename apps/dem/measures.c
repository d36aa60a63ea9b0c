/* SPDX-License-Identifier: MIT
 *
 * measures.c - energies, stress, counts, each grain's share of the contacts. All of them are sums over bodies or
 * contacts in their order, by one thread.
 */
#include <math.h>
#include <string.h>

#include "dem.h"

static dem_energies measure_energies(const dem *d, double *out_fastest) {
    const dem_account *a = &d->account;
    const vec size = dem_cell_size(d);
    dem_energies e = {.elastic = a->normal + a->tangential + a->rolling,
                      .damping = a->damping,
                      .friction = a->friction,
                      .walls = d->shear_work};
    double fastest = 0;
    for (const dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++) {
        const double speed = dot(b->velocity, b->velocity);
        const vec cells = {d->settings.periodic_x ? b->cell_x * size.x : 0,
                           d->settings.periodic_y ? b->cell_y * size.y : 0};
        e.kinetic += 0.5 * (b->mass * speed + b->inertia * b->spin * b->spin);
        e.potential -= b->mass * dot(d->settings.gravity, plus(b->position, cells)); /* as if there were no border */
        fastest = fmax(fastest, speed);
    }
    for (size_t w = 0; w < d->wall_count; w++)
        e.walls += d->walls[w].work;
    *out_fastest = sqrt(fastest);
    return e;
}

/* Across a periodic border: the image that is at `low` or the next one above. */
static double find_image(bool periodic, double value, double low, double width) {
    return periodic ? value - width * floor((value - low) / width) : value;
}

static bool is_inside(const dem *d, const dem_region *r, vec point) {
    const dem_settings *s = &d->settings;
    const vec size = dem_cell_size(d);
    const double y = find_image(s->periodic_y, point.y, r->low.y, size.y);
    const double aside = d->drifts ? d->offset * nearbyint((point.y - y) / size.y) : 0;
    const double x = find_image(s->periodic_x, point.x - aside, r->low.x, size.x);
    return !r->given || (x >= r->low.x && x < r->high.x && y >= r->low.y && y < r->high.y);
}

/* The area that stresses refer to: the region's, else the periodic cell's, else that of the box around all grains'
 * centres, a reach larger. */
static double find_area(const dem *d, const dem_region *r) {
    const dem_region all = dem_bound(d, false);
    const vec given = minus(r->high, r->low), cell = dem_cell_size(d), box = minus(all.high, all.low);
    if (r->given)
        return given.x * given.y;
    return (d->settings.periodic_x ? cell.x : box.x) * (d->settings.periodic_y ? cell.y : box.y);
}

static void add_stress(dem_stress *s, vec force, vec arm) {
    *s = (dem_stress){s->xx + force.x * arm.x, s->xy + force.x * arm.y, s->yx + force.y * arm.x,
                      s->yy + force.y * arm.y};
}

void dem_measure(const dem *d, const dem_region *region, dem_measures *out_measures) {
    const dem_region all = {.given = false}, *r = region ? region : &all;
    dem_measures m = {.contacts = d->contact_count};
    m.energy = measure_energies(d, &m.fastest);
    double ends = 0;
    for (const dem_contact *c = d->contacts; c < d->contacts + d->contact_count; c++) {
        const dem_body *a = dem_body_a(d, c->pair), *b = dem_body_b(d, c->pair);
        const bool is_wall = dem_is_wall(b);
        ends += is_wall ? 1 : 2;
        m.deepest = fmax(m.deepest, c->depth / (is_wall ? a->extent : fmin(a->extent, b->extent)));
        /* From the centre of A to that of B; of a wall, to the contact. */
        const vec shift = dem_image_b(d, c->pair)->shift;
        if (is_inside(d, r, plus(a->position, c->point)))
            add_stress(&m.stress, c->on.force, is_wall ? c->point : plus(minus(b->position, a->position), shift));
    }
    const double volume = find_area(d, r) * d->settings.thickness;
    m.coordination = ends / (double)d->grain_count;
    m.stress = (dem_stress){m.stress.xx / volume, m.stress.xy / volume, m.stress.yx / volume, m.stress.yy / volume};
    *out_measures = m;
}

/* ------------------------------------------------------------------------------------------------ loads */

/* Counts, takes away who is not held, counts again, until all are. */
static void find_bearing(const dem *d, dem_load *loads) {
    uint32_t least = 3;
    for (size_t i = 0; i < d->material_count * d->material_count; i++)
        if (d->laws[i / d->material_count][i % d->material_count].friction > 0)
            least = 2;
    for (size_t k = 0; k < d->body_count; k++)
        loads[k].bearing = least;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t k = 0; k < d->body_count; k++)
            loads[k].count = 0;
        for (const dem_contact *c = d->contacts; c < d->contacts + d->contact_count; c++) {
            dem_load *a = &loads[dem_body_a(d, c->pair) - d->bodies], *b = &loads[dem_body_b(d, c->pair) - d->bodies];
            const bool bears = a->bearing > 0 && b->bearing > 0 && dot(c->on.force, c->normal) > 0;
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

static void add_load(const dem *d, dem_load *loads, const dem_body *b, vec force, vec arm) {
    const double share = dem_is_wall(b) ? 0 : 1 / (DEM_PI / 4 * b->extent * b->extent * d->settings.thickness);
    dem_load *load = &loads[b - d->bodies];
    load->contacts++;
    add_stress(&load->stress, times(-share, force), arm);
}

dem_load *dem_find_loads(const dem *d) {
    dem_load *loads = NULL;
    dem_grow(&loads, d->body_count, sizeof *loads);
    memset(loads, 0, d->body_count * sizeof *loads);
    for (const dem_contact *c = d->contacts; c < d->contacts + d->contact_count; c++) {
        const dem_body *a = dem_body_a(d, c->pair), *b = dem_body_b(d, c->pair);
        const vec shift = dem_image_b(d, c->pair)->shift;
        add_load(d, loads, a, times(-1, c->on.force), c->point);
        add_load(d, loads, b, c->on.force, plus(c->point, minus(minus(a->position, b->position), shift)));
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
    const dem_account *a = &d->account;
    const dem_settings *s = &d->settings;
    const double sums[] = {(double)d->step, d->time,    a->damping, a->friction,   a->normal,
                           a->tangential,   a->rolling, d->offset,  d->shear_work, s->low.x,
                           s->low.y,        s->high.x,  s->high.y,  a->power};
    uint64_t hash = dem_hash_bytes(DEM_HASH_START, d->bodies, d->body_count * sizeof *d->bodies);
    for (size_t k = 0; k < d->contact_count; k++)
        hash = dem_hash_bytes(hash, dem_memory_of(d, d->contacts[k].pair), sizeof(dem_memory));
    for (size_t w = 0; w < d->wall_count; w++)
        hash = dem_hash_bytes(hash, &d->walls[w].work, sizeof d->walls[w].work);
    return dem_hash_bytes(hash, sums, sizeof sums);
}
