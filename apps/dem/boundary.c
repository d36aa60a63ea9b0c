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

/* Where a coordinate is in [low, low + width): by steps of whole widths. What is lost stays so. */
static double wrap(double value, double low, double width, int32_t *cell) {
    const double turns = floor((value - low) / width);
    if (!(fabs(turns) < 1e9))
        return INFINITY;
    *cell += (int32_t)turns;
    return value - turns * width;
}

double dem_find_drift(const dem *d) { return d->settings.shear * dem_cell_height(d); }

/* Changes a grain's velocity, and counts the work. */
static void push_grain(dem *d, size_t k, double by) {
    const double old = d->bodies.vx[k];
    d->bodies.vx[k] += by;
    d->shear_work += 0.5 * d->bodies.mass[k] * (d->bodies.vx[k] * d->bodies.vx[k] - old * old);
}

void dem_set_shear(dem *d, double rate) {
    const double middle = 0.5 * (d->settings.low_y + d->settings.high_y);
    for (size_t k = 0; k < d->grain_count; k++)
        push_grain(d, k, (rate - d->settings.shear) * (d->bodies.y[k] - middle));
    d->settings.shear = rate;
}

/* The x shift of a pair across the upper or lower border: whole widths, and the offset. */
static double find_shear_shift(const dem *d, size_t p, double old_offset) {
    const double lift = dem_find_lift(d, p), width = dem_cell_width(d);
    return width * nearbyint(((double)d->pairs.shift_x[p] - lift * old_offset) / width) + lift * d->offset;
}

dem_vec dem_find_shift(const dem *d, size_t p) {
    const dem_vec shift = {(double)d->pairs.shift_x[p], (double)d->pairs.shift_y[p]};
    return d->settings.sheared && shift.y != 0 ? (dem_vec){find_shear_shift(d, p, d->offset), shift.y} : shift;
}

void dem_shear_cell(dem *d) {
    const double old = d->offset;
    d->offset += d->settings.time_step * dem_find_drift(d);
    for (size_t p = 0; d->settings.sheared && p < d->pairs.count; p++)
        if (d->pairs.shift_y[p] != 0)
            d->pairs.shift_x[p] = (float)find_shear_shift(d, p, old);
}

void dem_count_shear_work(dem *d) { d->shear_work -= 0.5 * d->settings.time_step * dem_find_drift(d) * d->pull; }

/* Grains cross the lower or upper border of a sheared cell. */
static void wrap_height(dem *d, size_t k) {
    const int32_t before = d->bodies.cell_y[k];
    d->bodies.y[k] = wrap(d->bodies.y[k], d->settings.low_y, dem_cell_height(d), &d->bodies.cell_y[k]);
    const double turns = d->bodies.cell_y[k] - before;
    if (turns == 0 || !d->settings.sheared)
        return;
    d->bodies.x[k] -= turns * d->offset;
    push_grain(d, k, -turns * dem_find_drift(d));
}

void dem_wrap_bodies(dem *d) {
    const dem_settings *s = &d->settings;
    dem_bodies *b = &d->bodies;
    if (!s->periodic_x && !s->periodic_y)
        return;
    if (s->sheared)
        d->offset -= dem_cell_width(d) * nearbyint(d->offset / dem_cell_width(d));
    d->list_offset = d->offset;
    for (size_t k = 0; k < b->count; k++) {
        const double old_x = b->x[k], old_y = b->y[k];
        dem_wall *wall = k < d->grain_count ? NULL : &d->walls[k - d->grain_count];
        if (wall && wall->kind == DEM_PLATE)
            continue;
        if (s->periodic_y)
            wrap_height(d, k);
        if (s->periodic_x)
            b->x[k] = wrap(b->x[k], s->low_x, dem_cell_width(d), &b->cell_x[k]);
        if (wall)
            wall->pivot = (dem_vec){wall->pivot.x + (b->x[k] - old_x), wall->pivot.y + (b->y[k] - old_y)};
    }
}

static bool is_empty(narc_box box) { return !(box.min_x <= box.max_x); }

/* Of a part's box; of a body of several, what its whole may take at most. */
static narc_point find_size(const dem *d, size_t part) {
    const narc_box box = d->scratch->boxes[part];
    const size_t k = d->parts.body[part];
    const double whole = 2 * d->bodies.reach[k] + d->settings.skin;
    return d->shapes[d->bodies.shape[k]].outline_count == 1
               ? (narc_point){(double)(box.max_x - box.min_x), (double)(box.max_y - box.min_y)}
               : (narc_point){whole, whole};
}

/* The box around the boxes of all grains; and is the cell wide enough for each body and the largest grain? */
static bool find_widths(dem *d, narc_box *out_all) {
    const narc_box *boxes = d->scratch->boxes;
    const dem_settings *s = &d->settings;
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    narc_point grain = {0, 0}; /* the largest */
    for (size_t i = 0; i < d->parts.count && d->parts.body[i] < d->grain_count; i++) {
        all = (narc_box){fminf(all.min_x, boxes[i].min_x), fminf(all.min_y, boxes[i].min_y),
                         fmaxf(all.max_x, boxes[i].max_x), fmaxf(all.max_y, boxes[i].max_y)};
        grain = (narc_point){fmax(grain.x, find_size(d, i).x), fmax(grain.y, find_size(d, i).y)};
    }
    for (size_t i = 0; i < d->parts.count; i++) {
        const size_t k = d->parts.body[i];
        const narc_point both = {find_size(d, i).x + grain.x, find_size(d, i).y + grain.y};
        if (!is_empty(boxes[i]) &&
            ((s->periodic_x && both.x >= dem_cell_width(d)) || (s->periodic_y && both.y >= dem_cell_height(d))))
            return dem_fail(d,
                            "the periodic cell is too small: %s %zu and the largest grain, with the skin, are %g by %g "
                            "together",
                            k < d->grain_count ? "grain" : "wall", k < d->grain_count ? k : k - d->grain_count, both.x,
                            both.y);
    }
    *out_all = all;
    return true;
}

static bool overlap(narc_box a, narc_box b) {
    return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

static bool add_image(dem *d, uint32_t part, float x, float y, narc_box all) {
    dem_scratch *s = d->scratch;
    const narc_box box = s->boxes[part];
    const narc_box moved = {box.min_x + x, box.min_y + y, box.max_x + x, box.max_y + y};
    /* Rounding of the sums may take away what it is of a coordinate: give it back. */
    const float room = 4e-7f * (fabsf(x) + fabsf(y) + fabsf(moved.max_x) + fabsf(moved.max_y) + fabsf(moved.min_x) +
                                fabsf(moved.min_y));
    const narc_box image = {moved.min_x - room, moved.min_y - room, moved.max_x + room, moved.max_y + room};
    const size_t k = d->parts.count + s->image_count;
    if (!overlap(image, all))
        return true;
    if (!dem_make_room_for_boxes(d, k + 1))
        return false;
    s->boxes[k] = image;
    s->images[k] = (dem_image){part, s->images[part].group, x, y, 1};
    s->image_count++;
    return true;
}

bool dem_add_images(dem *d) {
    static const struct { int x, y; } steps[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {-1, 0}, {0, -1}, {-1, -1}, {-1, 1}};
    const dem_settings *s = &d->settings;
    narc_box all = {0};
    d->scratch->image_count = 0;
    if (!s->periodic_x && !s->periodic_y)
        return true;
    if (!find_widths(d, &all))
        return false;
    for (uint32_t k = 0; k < d->parts.count; k++) {
        const int count = d->parts.body[k] < d->grain_count ? 4 : 8;
        for (int i = 0; i < count && !is_empty(d->scratch->boxes[k]); i++) {
            if ((steps[i].x != 0 && !s->periodic_x) || (steps[i].y != 0 && !s->periodic_y))
                continue;
            const double x = steps[i].x * (s->periodic_x ? dem_cell_width(d) : 0) + steps[i].y * d->offset;
            const float y = steps[i].y != 0 ? (float)steps[i].y * (float)dem_cell_height(d) : 0;
            if (!add_image(d, k, (float)x, y, all))
                return false;
        }
    }
    return true;
}

bool dem_take_image_pairs(dem *d) {
    dem_scratch *s = d->scratch;
    for (size_t k = 0; k < s->found_count; k++) {
        if (s->found_b[k] < d->parts.count)
            continue;
        if (!dem_reserve(d, &s->extra, &s->extra_capacity, s->extra_count + 1, sizeof *s->extra))
            return false;
        const dem_image of = s->images[s->found_b[k]];
        const uint32_t a = s->found_a[k], b = of.part;
        s->extra[s->extra_count++] = a < b ? (dem_extra){a, b, of.x, of.y} : (dem_extra){b, a, -of.x, -of.y};
    }
    return true;
}
