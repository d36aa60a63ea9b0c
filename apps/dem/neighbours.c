/* SPDX-License-Identifier: MIT
 *
 * neighbours.c - which pairs may touch before the next list, and what the last list knew of them.
 *
 * Boxes are half the skin larger than bodies. Two bodies whose boxes are apart are at least the skin apart, so they
 * cannot touch before one of them has moved half of it (step.c watches that, rotation included).
 */
#include <stdlib.h>
#include <string.h>

#include "dem.h"

bool dem_make_room_for_boxes(dem *d, size_t count) {
    dem_scratch *s = d->scratch;
    return dem_reserve(d, &s->boxes, &s->box_capacity, count, sizeof *s->boxes) &&
           dem_reserve(d, &s->images, &s->image_capacity, count, sizeof *s->images);
}

static bool find_boxes(dem *d) {
    narc_bodies bodies;
    size_t skipped = 0;
    const narc_workers workers = dem_workers(d);
    const narc_box_options options = {
        .margin = (float)(0.5 * d->settings.skin), .workers = &workers, .out_skipped = &skipped};
    narc_error error;
    if (!dem_make_room_for_boxes(d, d->parts.count) || !dem_make_poses(d, &bodies))
        return false;
    for (uint32_t i = 0; i < d->parts.count; i++) {
        const uint32_t k = d->parts.body[i];
        d->scratch->images[i] = (dem_image){.part = i, .group = k + 1, .still = d->bodies.still[k]};
    }
    if (narc_compute_boxes(d->store, &bodies, &options, d->scratch->boxes, &error) != NARC_OK)
        return dem_fail_narc(d, "boxes", &error);
    if (skipped > 0)
        return dem_find_broken_body(d);
    for (size_t w = 0; w < d->wall_count; w++) /* plates have pairs of their own */
        if (d->walls[w].kind == DEM_PLATE)
            d->scratch->boxes[d->bodies.first_part[d->grain_count + w]] = (narc_box){1, 1, -1, -1};
    return dem_add_images(d);
}

static bool find_pairs(dem *d) {
    dem_scratch *s = d->scratch;
    narc_pair_filter filter = {.kind = NARC_COLUMN(s->images, still)};
    const narc_workers workers = dem_workers(d);
    const narc_pair_options options = {.filter = &filter, .workers = &workers};
    const narc_pair_list *list;
    narc_error error;
    if (d->parts.count > d->bodies.count)
        filter.group = NARC_COLUMN(s->images, group);
    narc_forget_pairs(d->broad); /* pairs are matched when those of images have become those of bodies */
    if (narc_update_box_pairs(d->broad, s->boxes, d->parts.count + s->image_count, &options, &list, &error) != NARC_OK)
        return dem_fail_narc(d, "pairs", &error);
    s->found_a = list->pairs.a.base;
    s->found_b = list->pairs.b.base;
    s->found_count = list->pairs.count;
    s->extra_count = 0;
    return (s->image_count == 0 || dem_take_image_pairs(d)) && dem_add_plate_pairs(d);
}

static int compare_pairs(const void *left, const void *right) {
    const dem_extra *l = left, *r = right;
    const uint64_t first = (uint64_t)l->a << 32 | l->b, second = (uint64_t)r->a << 32 | r->b;
    return (first > second) - (first < second);
}

/* Merges found and extra pairs in the order of (a, b). */
static bool merge_pairs(dem *d) {
    dem_scratch *s = d->scratch;
    dem_pairs *p = &d->pairs;
    if (!dem_grow_pairs(d, p, s->found_count + s->extra_count))
        return false;
    if (s->extra_count > 0)
        qsort(s->extra, s->extra_count, sizeof *s->extra, compare_pairs);
    size_t i = 0, j = 0;
    for (p->count = 0;; p->count++) {
        while (i < s->found_count && s->found_b[i] >= d->parts.count) /* of an image, among the extra ones too */
            i++;
        if (i == s->found_count && j == s->extra_count)
            return true;
        dem_extra next = {.a = UINT32_MAX};
        if (i < s->found_count)
            next = (dem_extra){.a = s->found_a[i], .b = s->found_b[i]};
        const bool is_found = j == s->extra_count || compare_pairs(&next, &s->extra[j]) < 0;
        next = is_found ? next : s->extra[j];
        i += is_found;
        j += !is_found;
        p->a[p->count] = next.a;
        p->b[p->count] = next.b;
        p->shift_x[p->count] = next.shift_x;
        p->shift_y[p->count] = next.shift_y;
    }
}

/* Hints and histories of the pairs that were in the last list; zeros for the others. */
static bool carry_over(dem *d) {
    dem_pairs *p = &d->pairs, *last = &d->last_pairs;
    dem_scratch *s = d->scratch;
    const narc_pairs now = {.count = p->count, .a = NARC_ARRAY(p->a), .b = NARC_ARRAY(p->b)};
    const narc_pairs before = {.count = last->count, .a = NARC_ARRAY(last->a), .b = NARC_ARRAY(last->b)};
    const narc_workers workers = dem_workers(d);
    narc_error error;
    if (!dem_resize(d, &s->match, p->capacity, sizeof *s->match))
        return false;
    if (narc_match_pairs(d->broad, &before, &now, &workers, s->match, &error) != NARC_OK)
        return dem_fail_narc(d, "pairs", &error);
    narc_gather(s->match, p->count, sizeof *p->hints, last->hints, p->hints);
    narc_gather(s->match, p->count, sizeof *p->memory, last->memory, p->memory);
    narc_gather(s->match, p->count, sizeof *p->rolling, last->rolling, p->rolling);
    return true;
}

/* From where bodies move. */
static void remember_places(dem *d) {
    dem_bodies *b = &d->bodies;
    const size_t size = b->count * sizeof *b->x;
    memcpy(b->list_x, b->x, size);
    memcpy(b->list_y, b->y, size);
    memcpy(b->list_cosine, b->cosine, size);
    memcpy(b->list_sine, b->sine, size);
}

bool dem_renew_lists(dem *d) {
    const dem_pairs last = d->pairs;
    dem_wrap_bodies(d);
    if (!find_boxes(d) || !find_pairs(d))
        return false;
    d->pairs = d->last_pairs;
    d->last_pairs = last;
    if (!merge_pairs(d) || !carry_over(d))
        return false;
    remember_places(d);
    d->list_builds++;
    return true;
}
