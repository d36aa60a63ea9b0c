/* SPDX-License-Identifier: MIT
 *
 * neighbours.c - which pairs may touch before the next list, and what the last list knew of them.
 *
 * Boxes are half the skin larger than bodies. Two bodies whose boxes are apart are at least the skin apart, so they
 * cannot touch before one of them has moved half of it (step.c watches that, rotation included).
 */
#include <stdlib.h>

#include "dem.h"

void dem_make_room_for_boxes(dem *d, size_t count) {
    dem_grow(&d->boxes, count, sizeof *d->boxes);
    dem_grow(&d->images, count, sizeof *d->images);
}

void dem_add_extra_pair(dem *d, dem_pair pair) {
    dem_grow(&d->extra, d->extra_count + 1, sizeof *d->extra);
    d->extra[d->extra_count++] = pair;
}

static void find_boxes(dem *d) {
    const narc_bodies bodies = dem_make_poses(d);
    size_t skipped = 0;
    const narc_box_options options = {
        .margin = (float)(0.5 * d->settings.skin), .workers = &d->workers, .out_skipped = &skipped};
    narc_error error;
    dem_make_room_for_boxes(d, d->part_count);
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
    dem_add_images(d);
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
            dem_add_extra_pair(d, pair.a < pair.b ? pair : turned);
    }
    dem_add_plate_pairs(d);
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
        d->bodies[k].list_place = d->bodies[k].place;
        d->bodies[k].list_turn = d->bodies[k].turn;
    }
    d->list_builds++;
}
