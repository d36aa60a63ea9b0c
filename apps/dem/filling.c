/* SPDX-License-Identifier: MIT
 *
 * filling.c - where grains start. A random filling puts grain after grain at a random position with a random angle, and
 * tries again while it would touch: narc_find_contacts() decides, of grains whose circles touch, and of walls.
 */
#include <math.h>

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

/* All but the position. */
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

static narc_body make_body(uint32_t shape, vec position, vec turn, double scale) {
    return (narc_body){position.x, position.y, (float)turn.x, (float)turn.y, (float)scale, shape};
}

static vec find_turn(double angle) { return (vec){cos(angle), sin(angle)}; }

/* Is the grain further than the gap from a body? Their shapes are those of the world: all outlines of both. */
static bool is_clear_of(const dem *d, narc_body grain, narc_body other, double gap) {
    const dem_shape *own = &d->shapes[grain.shape], *its = &d->shapes[other.shape];
    for (uint32_t i = 0; i < own->outline_count * its->outline_count; i++) {
        narc_body two[2] = {grain, other};
        const dem_outline *mine = &d->outlines[own->first_outline + i / its->outline_count];
        const dem_outline *theirs = &d->outlines[its->first_outline + i % its->outline_count];
        const vec arm = rotate((vec){(double)other.cosine, (double)other.sine}, theirs->at);
        two[0].shape = mine->stored;
        two[1].shape = theirs->stored;
        two[1].x += arm.x;
        two[1].y += arm.y;
        narc_bodies bodies;
        narc_view_bodies(two, 2, &bodies);
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

/* By the supports of its outlines. */
static bool is_clear_of_plate(const dem *d, const dem_grain *grain, const dem_wall *wall, double gap) {
    const dem_shape *shape = &d->shapes[grain->shape];
    const vec down = times(-1, wall->normal), back = {cos(grain->angle), -sin(grain->angle)};
    const vec direction = rotate(back, down); /* as the shape has it */
    for (uint32_t i = 0; i < shape->outline_count; i++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, d->outlines[shape->first_outline + i].stored, arcs);
        narc_point lowest;
        narc_find_support(arcs, count, direction.x, direction.y, &lowest, NULL);
        const double depth = grain->scale * dot((vec){lowest.x, lowest.y}, direction);
        if (dot(minus(grain->position, wall->position), wall->normal) - depth <= gap)
            return false;
    }
    return true;
}

/* Where the image of a position is that is nearest to a grain: no other can touch it. */
static vec find_nearest(const dem *d, const dem_grain *grain, vec position) {
    const vec size = dem_cell_size(d), way = minus(position, grain->position);
    return (vec){position.x - (d->settings.periodic_x ? size.x * nearbyint(way.x / size.x) : 0),
                 position.y - (d->settings.periodic_y ? size.y * nearbyint(way.y / size.y) : 0)};
}

/* Every grain and wall is looked at. */
static bool is_free(const dem *d, double gap, const dem_grain *grain) {
    const narc_body body = make_body(grain->shape, grain->position, find_turn(grain->angle), grain->scale);
    const double far = grain->scale * d->shapes[grain->shape].reach + gap;
    for (const dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++) {
        const vec position = find_nearest(d, grain, b->position), way = minus(position, grain->position);
        const double most = far + b->reach;
        if (dot(way, way) <= most * most &&
            !is_clear_of(d, body, make_body(b->shape, position, b->turn, (double)b->scale), gap))
            return false;
    }
    for (const dem_wall *w = d->walls; w < d->walls + d->wall_count; w++) {
        const vec position = find_nearest(d, grain, w->position);
        if (!(w->kind == DEM_PLATE
                  ? is_clear_of_plate(d, grain, w, gap)
                  : is_clear_of(d, body, make_body(w->shape, position, find_turn(w->angle), w->scale), gap)))
            return false;
    }
    return true;
}

void dem_fill_randomly(dem *d, const dem_filling *f, uint64_t *random) {
    const vec low = f->region.low, high = f->region.high;
    for (uint64_t i = 0; i < f->count; i++) {
        dem_grain grain = draw_grain(d, f, random);
        uint64_t tries = 0;
        do {
            if (tries++ == f->tries)
                dem_fail(d, "grain %zu of %zu found no free place in %zu tries: the region is full", (size_t)i,
                         (size_t)f->count, (size_t)f->tries);
            grain.position.x = draw_between(random, low.x, high.x);
            grain.position.y = draw_between(random, low.y, high.y);
            grain.angle = f->upright ? 0 : draw_between(random, -DEM_PI, DEM_PI);
        } while (!is_free(d, f->gap, &grain));
        dem_add_grain(d, grain);
    }
}

/* ------------------------------------------------------------------------------------------------ lattice */

void dem_fill_lattice(dem *d, const dem_filling *f, uint64_t *random) {
    const vec low = f->region.low, size = minus(f->region.high, low), spacing = f->spacing;
    const double columns = floor(size.x / spacing.x + 1e-9), rows = floor(size.y / spacing.y + 1e-9);
    if (columns * rows > 1e8)
        dem_fail(d, "a lattice of %g by %g places is too large", columns, rows);
    if (columns * rows < (double)f->count || columns * rows < 1)
        dem_fail(d, "a lattice of %g by %g places has no room for %zu grains", columns, rows, f->count);
    const size_t count = f->count > 0 ? f->count : (size_t)(columns * rows);
    for (size_t k = 0; k < count; k++) {
        const size_t row = k / (size_t)columns, column = k % (size_t)columns;
        dem_grain grain = draw_grain(d, f, random);
        const double off_x = 0.5 * f->jitter * draw_between(random, -1, 1);
        const double off_y = 0.5 * f->jitter * draw_between(random, -1, 1);
        grain.position =
            (vec){low.x + spacing.x * ((double)column + 0.5 + off_x), low.y + spacing.y * ((double)row + 0.5 + off_y)};
        dem_add_grain(d, grain);
    }
}
