/* SPDX-License-Identifier: MIT
 *
 * place.c - where grains start. A random filling puts grain after grain at a random place with a random angle, and
 * tries again while it would touch: narc_find_contacts() decides, a grid of cells tells whom to ask about.
 */
#include <math.h>
#include <stdlib.h>

#include "dem.h"

/* SplitMix64: the state counts, its mixture is the number, 0 <= x < 1. */
static double draw_unit(uint64_t *state) {
    uint64_t bits = *state += 0x9e3779b97f4a7c15;
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
    bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
    bits ^= bits >> 31;
    return (double)(bits >> 11) * 0x1p-53;
}

static double draw_between(uint64_t *random, double low, double high) { return low + (high - low) * draw_unit(random); }

/* Box and Muller 1958. */
static double draw_normal(uint64_t *random) {
    const double u = 1 - draw_unit(random), angle = 2 * DEM_PI * draw_unit(random);
    return sqrt(-2 * log(u)) * cos(angle);
}

double dem_draw_size(const dem_sizes *sizes, uint64_t *random) {
    if (sizes->kind == DEM_FIXED)
        return sizes->mean;
    if (sizes->kind == DEM_UNIFORM)
        return draw_between(random, sizes->low, sizes->high);
    for (;;) {
        const double normal = sizes->deviation * draw_normal(random);
        const double size = sizes->kind == DEM_NORMAL ? sizes->mean + normal : sizes->mean * exp(normal);
        if (size >= sizes->low && size <= sizes->high)
            return size;
    }
}

/* All but the place. */
static dem_grain draw_grain(const dem *d, const dem_filling *f, uint64_t *random) {
    const size_t choice = (size_t)(draw_unit(random) * (double)f->shape_count);
    dem_grain grain = {.shape = f->shapes[choice], .material = f->material};
    grain.scale = (double)(float)(dem_draw_size(&f->sizes, random) / d->shapes[grain.shape].extent);
    grain.angle = f->upright ? 0 : draw_between(random, -DEM_PI, DEM_PI);
    grain.velocity.x = draw_between(random, -f->speed, f->speed);
    grain.velocity.y = draw_between(random, -f->speed, f->speed);
    grain.spin = draw_between(random, -f->spin, f->spin);
    return grain;
}

/* ------------------------------------------------------------------------------------------------ random */

/* Cells as wide as two of the largest grains reach, so that who touches is in a neighbouring one: the last grain of
 * those whose cells share a place in the table, and of each grain the one before. */
typedef struct grid {
    double width;
    uint64_t mask;
    uint32_t *last, *before;
} grid;

static const uint32_t NOBODY = UINT32_MAX;

/* The place of the cell that is so many to the right and up. */
static uint32_t *find_cell(const grid *g, vec place, int right, int up) {
    const double most = 1e15; /* cells that are further away are one */
    const int64_t column = (int64_t)fmax(fmin(floor(place.x / g->width), most), -most) + right;
    const int64_t row = (int64_t)fmax(fmin(floor(place.y / g->width), most), -most) + up;
    const uint64_t mixed = ((uint64_t)column * 0x9e3779b97f4a7c15 ^ (uint64_t)row) * 0xbf58476d1ce4e5b9;
    return &g->last[mixed >> 32 & g->mask];
}

static void add_to_grid(const dem *d, grid *g, uint32_t body) {
    uint32_t *last = find_cell(g, d->bodies[body].place, 0, 0);
    g->before[body] = *last;
    *last = body;
}

static bool open_grid(dem *d, const dem_filling *f, grid *g) {
    const double largest = f->sizes.kind == DEM_FIXED ? f->sizes.mean : f->sizes.high;
    const size_t count = d->grain_count + (size_t)f->count;
    double reach = d->grain_reach;
    for (size_t i = 0; i < f->shape_count; i++)
        reach = fmax(reach, d->shapes[f->shapes[i]].reach * largest / d->shapes[f->shapes[i]].extent);
    g->width = 2 * reach + f->gap;
    for (g->mask = 255; g->mask < count;)
        g->mask = 2 * g->mask + 1;
    if (!dem_grow(d, &g->last, (size_t)g->mask + 1, sizeof *g->last) ||
        !dem_grow(d, &g->before, count, sizeof *g->before))
        return false;
    for (size_t i = 0; i <= g->mask; i++)
        g->last[i] = NOBODY;
    for (size_t k = 0; k < d->grain_count; k++)
        add_to_grid(d, g, (uint32_t)k);
    return true;
}

static narc_body make_body(uint32_t shape, vec place, double angle, double scale) {
    narc_body body = {.x = place.x, .y = place.y, .scale = (float)scale, .shape = shape};
    const float turn = (float)angle;
    narc_compute_poses(&turn, 1, &body.cosine, &body.sine, NULL);
    return body;
}

/* Is the grain further than the gap from a body? Their shapes are those of the world: all outlines of both. */
static bool is_clear_of(const dem *d, narc_body grain, narc_body other, double gap) {
    const dem_shape *own = &d->shapes[grain.shape], *its = &d->shapes[other.shape];
    for (uint32_t i = 0; i < own->outline_count * its->outline_count; i++) {
        narc_body two[2] = {grain, other};
        two[0].shape = own->first_outline + i / its->outline_count;
        two[1].shape = its->first_outline + i % its->outline_count;
        const narc_bodies bodies = narc_view_bodies(two, 2);
        const narc_pairs pair = {.count = 1};
        const narc_query query = {.margin = INFINITY};
        narc_contact contact;
        size_t found;
        if (narc_find_contacts(d->store, &bodies, &pair, &query, &contact, 1, &found, NULL) != NARC_OK ||
            contact.count == 0 || !((double)contact.separation > gap))
            return false;
    }
    return true;
}

static bool is_clear_of_grains(const dem *d, const grid *g, double gap, narc_body grain) {
    const vec place = {grain.x, grain.y};
    const double far = (double)grain.scale * d->shapes[grain.shape].reach + gap;
    for (int i = 0; i < 9; i++)
        for (uint32_t k = *find_cell(g, place, i % 3 - 1, i / 3 - 1); k != NOBODY; k = g->before[k]) {
            const dem_body *b = &d->bodies[k];
            const vec way = minus(b->place, place);
            const double most = far + b->reach;
            const narc_body other = {b->place.x, b->place.y, (float)b->turn.x, (float)b->turn.y, b->scale, b->shape};
            if (dot(way, way) <= most * most && !is_clear_of(d, grain, other, gap))
                return false;
        }
    return true;
}

/* By the supports of its outlines. */
static bool is_clear_of_plate(const dem *d, const dem_grain *grain, const dem_wall *wall, double gap) {
    const dem_shape *shape = &d->shapes[grain->shape];
    const vec down = times(-1, wall->normal), back = {cos(grain->angle), -sin(grain->angle)};
    const vec direction = rotate(back, down); /* as the shape has it */
    for (uint32_t i = 0; i < shape->outline_count; i++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, shape->first_outline + i, arcs);
        narc_point lowest;
        narc_find_support(arcs, count, direction.x, direction.y, &lowest, NULL);
        const double depth = grain->scale * dot((vec){lowest.x, lowest.y}, direction);
        if (dot(minus(grain->place, wall->place), wall->normal) - depth <= gap)
            return false;
    }
    return true;
}

static bool is_clear_of_walls(const dem *d, const dem_grain *grain, narc_body body, double gap) {
    for (const dem_wall *w = d->walls; w < d->walls + d->wall_count; w++)
        if (!(w->kind == DEM_PLATE ? is_clear_of_plate(d, grain, w, gap)
                                   : is_clear_of(d, body, make_body(w->shape, w->place, w->angle, w->scale), gap)))
            return false;
    return true;
}

/* Also of images, and of walls. */
static bool is_free(const dem *d, const grid *g, double gap, const dem_grain *grain) {
    const int across = d->settings.periodic_x, up = d->settings.periodic_y;
    const vec size = dem_cell_size(d);
    for (int i = -across; i <= across; i++)
        for (int j = -up; j <= up; j++) {
            const vec place = {grain->place.x + i * size.x, grain->place.y + j * size.y};
            const narc_body body = make_body(grain->shape, place, grain->angle, grain->scale);
            if (!is_clear_of_grains(d, g, gap, body) || !is_clear_of_walls(d, grain, body, gap))
                return false;
        }
    return true;
}

bool dem_fill_randomly(dem *d, const dem_filling *f, uint64_t *random) {
    grid g = {.last = NULL};
    bool ok = open_grid(d, f, &g);
    for (size_t i = 0; i < f->count && ok; i++) {
        dem_grain grain = draw_grain(d, f, random);
        uint64_t tries = 0;
        do {
            grain.place.x = draw_between(random, f->region.low.x, f->region.high.x);
            grain.place.y = draw_between(random, f->region.low.y, f->region.high.y);
            grain.angle = f->upright ? 0 : draw_between(random, -DEM_PI, DEM_PI);
            ok = is_free(d, &g, f->gap, &grain);
        } while (!ok && ++tries < f->tries);
        if (!ok)
            dem_fail(d, "grain %zu of %zu found no free place in %zu tries: the region is full", i, (size_t)f->count,
                     (size_t)f->tries);
        else if ((ok = dem_add_grain(d, grain)))
            add_to_grid(d, &g, (uint32_t)(d->grain_count - 1));
    }
    dem_release(g.last);
    dem_release(g.before);
    return ok;
}

/* ------------------------------------------------------------------------------------------------ lattice */

bool dem_fill_lattice(dem *d, const dem_filling *f, uint64_t *random) {
    const vec low = f->region.low, size = minus(f->region.high, low), spacing = f->spacing;
    const double columns = floor(size.x / spacing.x + 1e-9), rows = floor(size.y / spacing.y + 1e-9);
    if (columns * rows > 1e8)
        return dem_fail(d, "a lattice of %g by %g places is too large", columns, rows);
    if (columns * rows < (double)f->count || columns * rows < 1)
        return dem_fail(d, "a lattice of %g by %g places has no room for %zu grains", columns, rows, f->count);
    const size_t count = f->count > 0 ? f->count : (size_t)(columns * rows);
    for (size_t k = 0; k < count; k++) {
        const size_t row = k / (size_t)columns, column = k % (size_t)columns;
        dem_grain grain = draw_grain(d, f, random);
        const double off_x = 0.5 * f->jitter * draw_between(random, -1, 1);
        const double off_y = 0.5 * f->jitter * draw_between(random, -1, 1);
        grain.place =
            (vec){low.x + spacing.x * ((double)column + 0.5 + off_x), low.y + spacing.y * ((double)row + 0.5 + off_y)};
        if (!dem_add_grain(d, grain))
            return false;
    }
    return true;
}
