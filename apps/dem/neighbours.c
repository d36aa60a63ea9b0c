/* SPDX-License-Identifier: MIT
 *
 * neighbours.c - which pairs may touch before the next list, and what the last list knew of them.
 *
 * Boxes are half the skin larger than bodies. Two bodies whose boxes are apart are at least the skin apart, so they
 * cannot touch before one of them has moved half of it (step.c watches that, rotation included).
 *
 * Borders: for pairs across one some bodies get images, which are boxes a cell's width away, and only take part in
 * finding pairs. A pair then has a shift, which narc adds to B's position. Of the eight neighbours of a cell, four are
 * enough for pairs of grains: what is missing is found from the other grain's side. Walls have all eight, for two bodies
 * that are marked "still" form no pair, and images are so marked. A pair of bodies must stand in the list once, so that
 * its history can find it: two images of B that both are near A would be two. This cannot be if the cell is as wide as
 * the boxes of the two together, which find_widths() demands.
 *
 * Plates: a plate is a half plane, and its body a block whose upper side is the plate. A pair of a grain and the plate
 * has a shift along the plate that brings the block under the grain: so the plate has no ends, and narc sees two bodies
 * of similar size, whose separation is precise.
 */
#include <math.h>
#include <stdlib.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ images */

static void make_room_for_boxes(dem *d, size_t count) {
    dem_grow(&d->boxes, count, sizeof *d->boxes);
    dem_grow(&d->images, count, sizeof *d->images);
}

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
    make_room_for_boxes(d, k + 1);
    d->boxes[k] = image;
    d->images[k] = (dem_image){part, d->images[part].group, x, y, 1};
    d->image_count++;
}

static void add_images(dem *d) {
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

/* ------------------------------------------------------------------------------------------------ plates */

static void add_extra_pair(dem *d, dem_pair pair) {
    dem_grow(&d->extra, d->extra_count + 1, sizeof *d->extra);
    d->extra[d->extra_count++] = pair;
}

/* Every grain that is closer to the plate than the skin. (A box pair would be found a little further.) One whose centre
 * is deeper than that of the block would be pushed out behind it. */
static void add_pairs_of_plate(dem *d, const dem_body *block, const dem_wall *plate) {
    const vec n = plate->normal;
    for (uint32_t part = 0; part < d->bodies[d->grain_count].first_part; part++) { /* those of grains */
        const dem_body *b = &d->bodies[d->parts[part].body];
        const vec way = minus(b->position, block->position);
        const double height = dot(way, n) - plate->half, along = cross(n, way);
        const dem_pair pair = {part, block->first_part, (float)(-n.y * along), (float)(n.x * along), 0};
        if (height < -plate->half)
            dem_fail(d, "step %llu: grain %zu is behind wall '%s'. %s", (unsigned long long)d->step,
                     (size_t)(b - d->bodies), plate->name, dem_explain_depth(d));
        if (height - b->reach <= d->settings.skin * 1.001)
            add_extra_pair(d, pair);
    }
}

/* A plate of a periodic cell must run along the border, or it would end there. */
static void add_plate_pairs(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_wall *plate = &d->walls[w];
        const vec n = plate->normal;
        if (plate->kind != DEM_PLATE)
            continue;
        if ((d->settings.periodic_x && fabs(n.x) > 1e-12) || (d->settings.periodic_y && fabs(n.y) > 1e-12))
            dem_fail(d, "wall '%s': a plate with normal %g, %g crosses a periodic border", plate->name, n.x, n.y);
        add_pairs_of_plate(d, &d->bodies[d->grain_count + w], plate);
    }
}

/* ------------------------------------------------------------------------------------------------ the list */

static void find_boxes(dem *d) {
    const narc_bodies bodies = dem_make_poses(d);
    size_t skipped = 0;
    const narc_box_options options = {
        .margin = (float)(0.5 * d->settings.skin), .workers = &d->workers, .out_skipped = &skipped};
    narc_error error;
    make_room_for_boxes(d, d->part_count);
    for (uint32_t i = 0; i < d->part_count; i++) {
        const uint32_t k = d->parts[i].body;
        d->images[i] = (dem_image){.part = i, .group = k + 1, .still = k >= d->grain_count};
    }
    dem_demand(d, narc_compute_boxes(d->store, &bodies, &options, d->boxes, &error), "boxes", &error);
    if (skipped > 0)
        dem_fail_lost(d);
    for (size_t w = 0; w < d->wall_count; w++) /* plates have pairs of their own */
        if (d->walls[w].kind == DEM_PLATE)
            d->boxes[d->bodies[d->grain_count + w].first_part] = (narc_box){1, 1, -1, -1};
    add_images(d);
}

static int compare_pairs(const void *left, const void *right) {
    const dem_pair *l = left, *r = right;
    const uint64_t first = (uint64_t)l->a << 32 | l->b, second = (uint64_t)r->a << 32 | r->b;
    return (first > second) - (first < second);
}

/* The pairs that narc finds, and extra ones, in the order of (a, b). Those with images are extra ones, too. */
static void find_pairs(dem *d, dem_list *list) {
    narc_pair_filter filter = {.kind = NARC_COLUMN(d->images, still)};
    const narc_pair_options options = {.filter = &filter, .workers = &d->workers};
    const narc_pair_list *found;
    narc_error error;
    if (d->part_count > d->body_count)
        filter.group = NARC_COLUMN(d->images, group);
    narc_forget_pairs(d->broad); /* pairs are matched when those of images have become those of bodies */
    dem_demand(d, narc_update_box_pairs(d->broad, d->boxes, d->part_count + d->image_count, &options, &found, &error),
               "pairs", &error);
    const uint32_t *a = found->pairs.a.base, *b = found->pairs.b.base;
    d->extra_count = 0;
    for (size_t i = 0; i < found->pairs.count && d->image_count > 0; i++) {
        const dem_image *of = &d->images[b[i]];
        const dem_pair pair = {a[i], of->part, of->x, of->y, 0}, turned = {of->part, a[i], -of->x, -of->y, 0};
        if (b[i] >= d->part_count)
            add_extra_pair(d, pair.a < pair.b ? pair : turned);
    }
    add_plate_pairs(d);
    dem_grow(&list->pairs, found->pairs.count + d->extra_count, sizeof *list->pairs);
    if (d->extra_count > 0)
        qsort(d->extra, d->extra_count, sizeof *d->extra, compare_pairs);
    list->count = 0;
    size_t j = 0;
    for (size_t i = 0; i < found->pairs.count; i++) {
        const dem_pair next = {.a = a[i], .b = b[i]};
        if (next.b >= d->part_count)
            continue;
        while (j < d->extra_count && compare_pairs(&d->extra[j], &next) < 0)
            list->pairs[list->count++] = d->extra[j++];
        list->pairs[list->count++] = next;
    }
    while (j < d->extra_count)
        list->pairs[list->count++] = d->extra[j++];
}

/* Hints and histories of the pairs that were in the last list; zeros for the others. */
static void carry_over(dem *d, const dem_list *last, dem_list *list) {
    const dem_pair *p = list->pairs, *q = last->pairs;
    const narc_pairs now = {.count = list->count, .a = NARC_COLUMN(p, a), .b = NARC_COLUMN(p, b)};
    const narc_pairs before = {.count = last->count, .a = NARC_COLUMN(q, a), .b = NARC_COLUMN(q, b)};
    narc_error error;
    dem_grow(&d->match, list->count, sizeof *d->match);
    dem_grow(&list->memory, list->count, sizeof *list->memory);
    dem_demand(d, narc_match_pairs(d->broad, &before, &now, &d->workers, d->match, &error), "pairs", &error);
    narc_gather(d->match, list->count, sizeof *list->memory, last->memory, list->memory);
    for (size_t k = 0; k < list->count; k++)
        list->pairs[k].hint = d->match[k] != NARC_NO_MATCH ? q[d->match[k]].hint : 0;
}

void dem_renew_lists(dem *d) {
    dem_wrap_bodies(d);
    find_boxes(d);
    find_pairs(d, &d->other_list);
    carry_over(d, &d->list, &d->other_list);
    const dem_list last = d->list;
    d->list = d->other_list;
    d->other_list = last;
    for (size_t k = 0; k < d->body_count; k++) { /* from where bodies move */
        d->bodies[k].list_position = d->bodies[k].position;
        d->bodies[k].list_turn = d->bodies[k].turn;
    }
    d->list_builds++;
}
