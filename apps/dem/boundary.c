/* SPDX-License-Identifier: MIT
 *
 * boundary.c - periodic borders. Bodies are wrapped into the cell when pairs are found, and only then. For pairs across
 * a border some bodies get images: boxes, a cell's width away, which only take part in finding pairs. A pair then has a
 * shift, which narc adds to B's position.
 *
 * Of the eight neighbours of a cell, four are enough for pairs of grains: what is missing is found from the other
 * grain's side. Walls have all eight, for two bodies that are marked "still" form no pair, and images are so marked.
 *
 * A sheared cell (Lees and Edwards 1972): the cell above moves to the right, by the rate of shear times the height. Who
 * is in it is `offset` further right than its image here, and faster by that speed; who crosses the border gets both.
 * Shifts of pairs across it change in each step. A float is enough for narc; forces take them anew in double precision.
 *
 * A pair of bodies must stand in the list once, so that its history can find it: two images of B that both are near A
 * would be two. This cannot be if the cell is as wide as the boxes of the two together, which find_widths() demands.
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ shear */

double dem_find_drift(const dem *d) { return d->settings.shear * dem_cell_size(d).y; }

/* Changes a grain's velocity, and counts the work. */
static void push_grain(dem *d, dem_body *b, double by) {
    const double old = b->velocity.x;
    b->velocity.x += by;
    d->shear_work += 0.5 * b->mass * (b->velocity.x * b->velocity.x - old * old);
}

void dem_set_shear(dem *d, double rate) {
    const double middle = 0.5 * (d->settings.low.y + d->settings.high.y);
    for (dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++)
        push_grain(d, b, (rate - d->settings.shear) * (b->place.y - middle));
    d->settings.shear = rate;
}

/* The x shift of a pair across the upper or lower border: whole widths, and the offset. */
static double find_shear_shift(const dem *d, const dem_pair *pair, double old_offset) {
    const double lift = dem_find_lift(pair), width = dem_cell_size(d).x;
    return width * nearbyint(((double)pair->shift_x - lift * old_offset) / width) + lift * d->offset;
}

vec dem_find_shift(const dem *d, const dem_pair *pair) {
    const bool sheared = d->settings.sheared && pair->shift_y != 0;
    return (vec){sheared ? find_shear_shift(d, pair, d->offset) : (double)pair->shift_x, (double)pair->shift_y};
}

void dem_shear_cell(dem *d) {
    const double old = d->offset;
    d->offset += d->settings.time_step * dem_find_drift(d);
    for (dem_pair *p = d->list.pairs; d->settings.sheared && p < d->list.pairs + d->list.count; p++)
        if (p->shift_y != 0)
            p->shift_x = (float)find_shear_shift(d, p, old);
}

/* ------------------------------------------------------------------------------------------------ wrapping */

/* Where a coordinate is in [low, low + width): by steps of whole widths. What is lost stays so. */
static double wrap(double value, double low, double width, int32_t *cell) {
    const double turns = floor((value - low) / width);
    if (!(fabs(turns) < 1e9))
        return INFINITY;
    *cell += (int32_t)turns;
    return value - turns * width;
}

void dem_wrap_bodies(dem *d) {
    const dem_settings *s = &d->settings;
    const vec size = dem_cell_size(d);
    if (!s->periodic_x && !s->periodic_y)
        return;
    if (s->sheared)
        d->offset -= size.x * nearbyint(d->offset / size.x);
    d->list_offset = d->offset;
    for (size_t k = 0; k < d->body_count; k++) {
        dem_body *b = &d->bodies[k];
        dem_wall *wall = k < d->grain_count ? NULL : &d->walls[k - d->grain_count];
        const vec old = b->place;
        const int32_t before = b->cell_y;
        if (wall && wall->kind == DEM_PLATE)
            continue;
        if (s->periodic_y)
            b->place.y = wrap(b->place.y, s->low.y, size.y, &b->cell_y);
        if (s->sheared && b->cell_y != before) {
            b->place.x -= (b->cell_y - before) * d->offset;
            push_grain(d, b, -(b->cell_y - before) * dem_find_drift(d));
        }
        if (s->periodic_x)
            b->place.x = wrap(b->place.x, s->low.x, size.x, &b->cell_x);
        if (wall)
            wall->pivot = plus(wall->pivot, minus(b->place, old));
    }
}

/* ------------------------------------------------------------------------------------------------ images */

static bool is_empty(narc_box box) { return !(box.min_x <= box.max_x); }

/* Of a part's box; of a body of several, what its whole may take at most. */
static vec find_size(const dem *d, size_t part) {
    const narc_box box = d->boxes[part];
    const dem_body *b = &d->bodies[d->parts[part].body];
    const double whole = 2 * b->reach + d->settings.skin;
    return d->shapes[b->shape].outline_count == 1
               ? (vec){(double)(box.max_x - box.min_x), (double)(box.max_y - box.min_y)}
               : (vec){whole, whole};
}

/* The box around the boxes of all grains; and is the cell wide enough for each body and the largest grain? */
static narc_box find_widths(dem *d) {
    const vec size = dem_cell_size(d);
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    vec grain = {0, 0}; /* the largest */
    for (size_t i = 0; i < d->part_count && d->parts[i].body < d->grain_count; i++) {
        const narc_box box = d->boxes[i];
        all = (narc_box){fminf(all.min_x, box.min_x), fminf(all.min_y, box.min_y), fmaxf(all.max_x, box.max_x),
                         fmaxf(all.max_y, box.max_y)};
        grain = (vec){fmax(grain.x, find_size(d, i).x), fmax(grain.y, find_size(d, i).y)};
    }
    for (size_t i = 0; i < d->part_count; i++) {
        const size_t k = d->parts[i].body;
        const vec both = plus(find_size(d, i), grain);
        if (!is_empty(d->boxes[i]) &&
            ((d->settings.periodic_x && both.x >= size.x) || (d->settings.periodic_y && both.y >= size.y)))
            dem_fail(d,
                     "the periodic cell is too small: %s %zu and the largest grain, with the skin, are %g by %g "
                     "together",
                     dem_name_kind(d, k), dem_number(d, k), both.x, both.y);
    }
    return all;
}

static bool overlap(narc_box a, narc_box b) {
    return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

static void add_image(dem *d, uint32_t part, float x, float y, narc_box all) {
    const narc_box box = d->boxes[part];
    const narc_box moved = {box.min_x + x, box.min_y + y, box.max_x + x, box.max_y + y};
    /* Rounding of the sums may take away what it is of a coordinate: give it back. */
    const float room = 4e-7f * (fabsf(x) + fabsf(y) + fabsf(moved.max_x) + fabsf(moved.max_y) + fabsf(moved.min_x) +
                                fabsf(moved.min_y));
    const narc_box image = {moved.min_x - room, moved.min_y - room, moved.max_x + room, moved.max_y + room};
    const size_t k = d->part_count + d->image_count;
    if (!overlap(image, all))
        return;
    dem_make_room_for_boxes(d, k + 1);
    d->boxes[k] = image;
    d->images[k] = (dem_image){part, d->images[part].group, x, y, 1};
    d->image_count++;
}

void dem_add_images(dem *d) {
    static const struct { int x, y; } steps[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {-1, 0}, {0, -1}, {-1, -1}, {-1, 1}};
    const dem_settings *s = &d->settings;
    const vec size = dem_cell_size(d);
    d->image_count = 0;
    if (!s->periodic_x && !s->periodic_y)
        return;
    const narc_box all = find_widths(d);
    for (uint32_t k = 0; k < d->part_count; k++) {
        const int count = d->parts[k].body < d->grain_count ? 4 : 8;
        for (int i = 0; i < count && !is_empty(d->boxes[k]); i++) {
            if ((steps[i].x != 0 && !s->periodic_x) || (steps[i].y != 0 && !s->periodic_y))
                continue;
            const double x = steps[i].x * size.x + steps[i].y * d->offset, y = steps[i].y * size.y;
            add_image(d, k, (float)x, (float)y, all);
        }
    }
}
