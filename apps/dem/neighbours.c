/* SPDX-License-Identifier: MIT
 *
 * neighbours.c - images across borders and of plates, and which pairs may touch.
 *
 * narc keeps pairs, and each one's history in its slot (narc_contacts.h). A pair is known by its two bodies, and there are
 * no borders: so who is near another one across a border, or near a plate, meets an image, a body that has an id of its own.
 * Images are made with boxes half the skin larger, and serve until something has moved half of it (step.c watches that,
 * rotation included).
 *
 * Borders: an image is a cell's width away. A pair across a border is found from both sides, and counts where the image is
 * that of the larger part. Images and walls are of one group, and form no pair. A pair of parts must be found once, so that
 * its history can be: two images of B that both are near A would be two. This cannot be if the cell is as wide as the boxes
 * of the two together, which find_widths() demands. Where a grain is wrapped into the cell another image of it, or of its
 * neighbour, takes over: the pair parts and begins in the same step, and its history goes along.
 *
 * Plates: a plate is a half plane, and its body a block whose upper side is the plate. Each grain that is near has an image
 * of the block of its own, right under it: so the plate has no ends, and narc sees two bodies of similar size, whose
 * separation is precise. Parts have 63 colours (categories), so that few others meet that image.
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ images */

static void add_image(dem *d, dem_image image) {
    dem_grow(&d->images, d->image_count + 1, sizeof *d->images);
    d->images[d->image_count++] = image;
}

static uint64_t find_category(uint32_t part) { return UINT64_C(1) << part % 63; }

/* A plate itself meets no grain, but its images do. */
static void add_parts(dem *d) {
    d->image_count = 0;
    for (uint32_t k = 0; k < d->part_count; k++) {
        const size_t body = d->parts[k].body;
        const bool wall = body >= d->grain_count, plate = wall && d->walls[body - d->grain_count].kind == DEM_PLATE;
        add_image(d, (dem_image){.id = k,
                                 .category = find_category(k),
                                 .mask = plate ? 0 : UINT64_MAX,
                                 .part = k,
                                 .owner = UINT32_MAX,
                                 .group = wall ? 1 : (uint32_t)body + 2});
    }
}

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
        if (d->images[i].mask != 0 &&
            ((d->settings.periodic_x && both.x >= size.x) || (d->settings.periodic_y && both.y >= size.y)))
            dem_fail(d,
                     "the periodic cell is too small: %s %zu and the largest grain, with the skin, are %g by %g "
                     "together",
                     dem_name_kind(d, k), dem_number(d, k), both.x, both.y);
    }
    return all;
}

/* Is a box, moved, near some grain? */
static bool is_near(narc_box box, vec shift, narc_box all) {
    return (double)box.min_x + shift.x <= (double)all.max_x && (double)all.min_x <= (double)box.max_x + shift.x &&
           (double)box.min_y + shift.y <= (double)all.max_y && (double)all.min_y <= (double)box.max_y + shift.y;
}

static void add_images_across_borders(dem *d) {
    const dem_settings *s = &d->settings;
    if (!s->periodic_x && !s->periodic_y)
        return;
    const narc_bodies bodies = dem_make_poses(d);
    const narc_box_options options = {.margin = (float)(0.5 * s->skin), .workers = &d->workers};
    narc_error error;
    dem_grow(&d->boxes, d->part_count, sizeof *d->boxes);
    dem_demand(d, narc_compute_boxes(d->store, &bodies, &options, d->boxes, &error), "boxes", &error);
    const narc_box all = find_widths(d);
    for (uint32_t k = 0; k < d->part_count; k++)
        for (int i = 0; i < 9 && d->images[k].mask != 0; i++) {
            dem_image image = d->images[k];
            image.id |= (uint64_t)(i + 1) << 32;
            image.group = 1;
            image.right = (int16_t)(i % 3 - 1);
            image.up = (int16_t)(i / 3 - 1);
            image.shift = dem_find_shift(d, &image);
            if ((image.right || image.up) && (!image.right || s->periodic_x) && (!image.up || s->periodic_y) &&
                is_near(d->boxes[k], image.shift, all))
                add_image(d, image);
        }
}

/* For every grain that is closer to the plate than the skin. One whose centre is deeper than that of the block would be
 * pushed out behind it. */
static void add_images_of_plate(dem *d, const dem_body *block, const dem_wall *plate) {
    const vec n = plate->normal;
    for (uint32_t k = 0; k < d->bodies[d->grain_count].first_part; k++) { /* those of grains */
        const dem_body *b = &d->bodies[d->parts[k].body];
        const vec way = minus(b->position, block->position);
        const double height = dot(way, n) - plate->half, along = cross(n, way);
        if (height < -plate->half)
            dem_fail(d, "step %llu: grain %zu is behind wall '%s'. %s", (unsigned long long)d->step,
                     (size_t)(b - d->bodies), plate->name, dem_explain_depth(d));
        if (height - b->reach <= d->settings.skin * 1.001)
            add_image(d, (dem_image){.id = (uint64_t)(k + 10) << 32 | block->first_part,
                                     .category = UINT64_C(1) << 63,
                                     .mask = find_category(k),
                                     .part = block->first_part,
                                     .owner = k,
                                     .group = 1,
                                     .shift = {(double)(float)(-n.y * along), (double)(float)(n.x * along)}});
    }
}

/* A plate of a periodic cell must run along the border, or it would end there. */
static void add_images_of_plates(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_wall *plate = &d->walls[w];
        const vec n = plate->normal;
        if (plate->kind != DEM_PLATE)
            continue;
        if ((d->settings.periodic_x && fabs(n.x) > 1e-12) || (d->settings.periodic_y && fabs(n.y) > 1e-12))
            dem_fail(d, "wall '%s': a plate with normal %g, %g crosses a periodic border", plate->name, n.x, n.y);
        add_images_of_plate(d, &d->bodies[d->grain_count + w], plate);
    }
}

void dem_renew_images(dem *d) {
    dem_wrap_bodies(d);
    add_parts(d);
    add_images_across_borders(d);
    add_images_of_plates(d);
    for (size_t k = 0; k < d->body_count; k++) { /* from where bodies move */
        d->bodies[k].last_position = d->bodies[k].position;
        d->bodies[k].last_turn = d->bodies[k].turn;
    }
    d->renewals++;
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* Where another image takes over, a pair of the same parts begins. */
static void carry_over(const dem *d) {
    const narc_step_result *r = d->found;
    dem_memory *memory = r->user;
    for (const narc_touch_event *old = r->ended; old < r->ended + r->ended_count; old++)
        for (const narc_touch_event *now = r->began; old->parted && now < r->began + r->began_count; now++)
            if (old->id_a == now->id_a && (uint32_t)old->id_b == (uint32_t)now->id_b)
                memory[now->slot] = memory[old->slot];
}

/* In narc's order images stand behind parts. */
static void list_pairs(dem *d) {
    const narc_step_result *r = d->found;
    const uint32_t *a = r->pairs.a.base, *b = r->pairs.b.base;
    dem_grow(&d->pairs, r->touching_count, sizeof *d->pairs);
    d->pair_count = 0;
    for (size_t i = 0; i < r->touching_count; i++) {
        const uint32_t slot = r->touching[i];
        const dem_image *image = &d->images[b[slot]];
        const dem_pair pair = {a[slot], image->part, b[slot], slot};
        size_t k = d->pair_count;
        if (pair.a >= pair.b || (image->owner != UINT32_MAX && image->owner != pair.a))
            continue;
        for (; k > 0 && d->pairs[k - 1].a == pair.a && d->pairs[k - 1].b > pair.b; k--)
            d->pairs[k] = d->pairs[k - 1];
        d->pairs[k] = pair;
        d->pair_count++;
    }
}

void dem_find_pairs(dem *d) {
    const narc_bodies bodies = dem_make_poses(d);
    const narc_pair_filter filter = {.category = NARC_COLUMN(d->images, category),
                                     .mask = NARC_COLUMN(d->images, mask),
                                     .group = NARC_COLUMN(d->images, group)};
    /* touch.h decides. Shifts along plates are rounded. */
    const double rounding = d->wall_count > 0 ? 2e-7 * d->diagonal : 0;
    const narc_step step = {.bodies = &bodies,
                            .margin = (float)(4 * NARC_ERROR_BOUND * d->grain_reach + rounding),
                            .skin = (float)(0.25 * d->settings.skin),
                            .id = NARC_COLUMN(d->images, id),
                            .filter = &filter,
                            .workers = &d->workers};
    narc_error error;
    dem_demand(d, narc_update_contacts(d->near, d->store, &step, &d->found, &error), "contacts", &error);
    if (d->found->skipped > 0)
        dem_fail_lost(d);
    carry_over(d);
    list_pairs(d);
    dem_grow(&d->contacts, d->pair_count, sizeof *d->contacts);
}
