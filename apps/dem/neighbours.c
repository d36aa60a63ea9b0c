/* SPDX-License-Identifier: MIT
 *
 * neighbours.c - images across borders and of plates, which pairs are near each other, and which of them may touch.
 *
 * narc keeps each pair's history in its slot (narc_contacts.h). A pair is known by its two bodies, and there are no borders:
 * so who is near another one across a border, or near a plate, meets an image, a body that has an id of its own. Images and
 * pairs are made with boxes half the skin larger, and serve until something has moved half of it (step.c watches that,
 * rotation included).
 *
 * Borders: an image is a cell's width away. A pair across a border is found from both sides, and counts where the image is
 * that of the larger part. Images stand behind their part, so pairs are in the order of parts; images and walls have one
 * owner, and form none. A pair of parts must be found once, so that its history can be, and not with two images of B: so a
 * cell is wider than the boxes of any two together (find_widths()). Where a grain is wrapped another image of it, or of its
 * neighbour, takes over: the pair parts and begins in the same step, and its history goes along.
 *
 * Plates: a plate is a half plane, and its body a block whose upper side is the plate. Each grain that is near has an image
 * of the block of its own, right under it: so the plate has no ends, and narc sees two bodies of similar size, whose
 * separation is precise.
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ images */

static void add_image(dem *d, dem_image image) {
    dem_grow(&d->images, d->image_count + 1, sizeof *d->images);
    d->images[d->image_count++] = image;
}

static bool is_plate(const dem *d, uint32_t part) {
    const size_t body = d->parts[part].body;
    return body >= d->grain_count && d->walls[body - d->grain_count].kind == DEM_PLATE;
}

/* A plate itself meets no grain, but its images do. */
static void add_part(dem *d, uint32_t part) {
    const uint32_t body = d->parts[part].body, only = is_plate(d, part) ? part : UINT32_MAX;
    const uint32_t owner = body < d->grain_count ? body : (uint32_t)d->grain_count;
    add_image(d, (dem_image){.id = part, .part = part, .only = only, .owner = owner});
}

/* Of all images, where bodies were when the images were made. */
static void find_boxes(dem *d) {
    const narc_bodies bodies = dem_make_poses(d, true);
    size_t skipped = 0;
    const narc_box_options options = {
        .margin = (float)(0.5 * (d->settings.skin + d->margin)), .workers = &d->workers, .out_skipped = &skipped};
    narc_error error;
    dem_grow(&d->boxes, d->image_count, sizeof *d->boxes);
    dem_demand(d, narc_compute_boxes(d->store, &bodies, &options, d->boxes, &error), "boxes", &error);
    if (skipped > 0)
        dem_fail_lost(d);
}

/* Of a part's box; of a body of several, what its whole may take at most. */
static vec find_size(const dem *d, size_t part) {
    const narc_box box = d->boxes[part];
    const dem_body *b = &d->bodies[d->parts[part].body];
    const double whole = 2 * b->reach + d->settings.skin;
    return d->shapes[b->shape].outline_count == 1 || d->shapes[b->shape].is_chain
               ? (vec){(double)(box.max_x - box.min_x), (double)(box.max_y - box.min_y)}
               : (vec){whole, whole};
}

/* With parts alone: the box around the boxes of all grains; and is the cell wide enough for each body and the largest grain? */
static narc_box find_widths(dem *d) {
    const vec size = dem_cell_size(d);
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    vec grain = {0, 0}; /* the largest */
    find_boxes(d);
    for (size_t i = 0; i < d->part_count && d->parts[i].body < d->grain_count; i++) {
        const narc_box box = d->boxes[i];
        all = (narc_box){fminf(all.min_x, box.min_x), fminf(all.min_y, box.min_y), fmaxf(all.max_x, box.max_x),
                         fmaxf(all.max_y, box.max_y)};
        grain = (vec){fmax(grain.x, find_size(d, i).x), fmax(grain.y, find_size(d, i).y)};
    }
    for (size_t i = 0; i < d->part_count; i++) {
        const size_t k = d->parts[i].body;
        const vec both = plus(find_size(d, i), grain);
        if (!is_plate(d, (uint32_t)i) &&
            ((d->settings.periodic_x && both.x >= size.x) || (d->settings.periodic_y && both.y >= size.y)))
            dem_fail(d,
                     "the periodic cell is too small: %s %zu and the largest grain, with the skin, are %g by %g "
                     "together",
                     dem_name_kind(d, k), dem_number(d, k), both.x, both.y);
    }
    return all;
}

/* Those of a part that are near some grain. */
static void add_images_across_borders(dem *d, uint32_t part, narc_box all) {
    const narc_box box = d->boxes[part];
    for (int i = 0; i < 9; i++) {
        dem_image image = {
            .id = (uint64_t)(i + 1) << 32 | part, .part = part, .only = UINT32_MAX, .owner = (uint32_t)d->grain_count};
        image.right = (int16_t)(i % 3 - 1);
        image.up = (int16_t)(i / 3 - 1);
        image.shift = dem_find_shift(d, &image, true);
        const double x = image.shift.x, y = image.shift.y;
        if ((image.right || image.up) && (!image.right || d->settings.periodic_x) &&
            (!image.up || d->settings.periodic_y) && (double)box.min_x + x <= (double)all.max_x &&
            (double)all.min_x <= (double)box.max_x + x && (double)box.min_y + y <= (double)all.max_y &&
            (double)all.min_y <= (double)box.max_y + y)
            add_image(d, image);
    }
}

/* For every grain that is closer to the plate than the skin. One whose centre is deeper than that of the block would be
 * pushed out behind it. A plate of a periodic cell must run along the border, or it would end there. */
static void add_images_of_plate(dem *d, uint32_t part) {
    const dem_body *block = &d->bodies[d->parts[part].body];
    const dem_wall *plate = &d->walls[d->parts[part].body - d->grain_count];
    const vec n = plate->normal;
    if ((d->settings.periodic_x && fabs(n.x) > 1e-12) || (d->settings.periodic_y && fabs(n.y) > 1e-12))
        dem_fail(d, "wall '%s': a plate with normal %g, %g crosses a periodic border", plate->name, n.x, n.y);
    for (uint32_t k = 0; k < d->bodies[d->grain_count].first_part; k++) { /* those of grains */
        const dem_body *b = &d->bodies[d->parts[k].body];
        const vec way = minus(b->last_position, block->last_position);
        const double height = dot(way, n) - plate->half, along = cross(n, way);
        if (height < -plate->half)
            dem_fail(d, "step %llu: grain %zu is behind wall '%s'. %s", (unsigned long long)d->step,
                     (size_t)(b - d->bodies), plate->name, dem_explain_depth(d));
        if (height - b->reach > d->settings.skin * 1.001 + d->range)
            continue;
        dem_image image = {
            .id = (uint64_t)(k + 10) << 32 | part, .part = part, .only = k, .owner = (uint32_t)d->grain_count};
        image.shift = (vec){(double)(float)(-n.y * along), (double)(float)(n.x * along)};
        add_image(d, image);
    }
}

/* Of pairs the first is no image. */
void dem_find_images(dem *d) {
    const bool periodic = d->settings.periodic_x || d->settings.periodic_y;
    narc_status status = NARC_OK;
    narc_error error;
    d->image_count = 0;
    for (uint32_t k = 0; k < d->part_count; k++)
        add_part(d, k);
    const narc_box all = periodic ? find_widths(d) : (narc_box){0, 0, 0, 0};
    d->image_count = 0;
    for (uint32_t k = 0; k < d->part_count; k++) {
        add_part(d, k);
        if (is_plate(d, k))
            add_images_of_plate(d, k);
        else if (periodic)
            add_images_across_borders(d, k, all);
    }
    find_boxes(d);
    const narc_pair_filter filter = {.owner = NARC_COLUMN(d->images, owner)};
    size_t count = 8 * d->image_count;
    for (size_t room = 0; room < count;) {
        room = count;
        dem_grow(&d->near_a, room, sizeof *d->near_a);
        dem_grow(&d->near_b, room, sizeof *d->near_b);
        status = narc_find_pairs(d->broad, d->boxes, d->image_count, &filter, &d->workers, d->near_a, d->near_b, 0,
                                 room, &count, &error);
    }
    dem_demand(d, status, "pairs", &error);
    d->near_count = 0;
    for (size_t i = 0; i < count; i++) {
        const dem_image *a = &d->images[d->near_a[i]], *b = &d->images[d->near_b[i]];
        d->near_a[d->near_count] = d->near_a[i];
        d->near_b[d->near_count] = d->near_b[i];
        d->near_count += a->id < d->part_count && (b->only == UINT32_MAX || b->only == a->part);
    }
}

void dem_renew_images(dem *d) {
    dem_wrap_bodies(d);
    for (size_t k = 0; k < d->body_count; k++) { /* from where bodies move */
        d->bodies[k].last_position = d->bodies[k].position;
        d->bodies[k].last_turn = d->bodies[k].turn;
    }
    dem_find_images(d);
    d->renewals++;
}

/* Where another image takes over, a pair of the same parts begins. */
static void carry_over(const dem *d) {
    const narc_step_result *r = d->found;
    dem_memory *memory = r->user;
    for (const narc_touch_event *old = r->ended; old < r->ended + r->ended_count; old++)
        for (const narc_touch_event *now = r->began; old->parted && now < r->began + r->began_count; now++)
            if (old->id_a == now->id_a && (uint32_t)old->id_b == (uint32_t)now->id_b)
                memory[now->slot] = memory[old->slot];
}

void dem_find_pairs(dem *d, bool renewed) {
    const narc_bodies bodies = dem_make_poses(d, false);
    const narc_pairs pairs = {.count = d->near_count, .a = NARC_ARRAY(d->near_a), .b = NARC_ARRAY(d->near_b)};
    const narc_step step = {.bodies = &bodies,
                            .margin = (float)d->margin,
                            .pairs = &pairs,
                            .same_pairs = !renewed,
                            .id = NARC_COLUMN(d->images, id),
                            .workers = &d->workers};
    narc_error error;
    dem_demand(d, narc_update_contacts(d->near, d->store, &step, &d->found, &error), "contacts", &error);
    const uint32_t *a = d->found->pairs.a.base, *b = d->found->pairs.b.base;
    carry_over(d);
    d->pair_count = d->found->touching_count;
    dem_grow(&d->pairs, d->pair_count, sizeof *d->pairs);
    dem_grow(&d->contacts, d->pair_count, sizeof *d->contacts);
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1)
    for (size_t k = 0; k < d->pair_count; k++) {
        const uint32_t slot = d->found->touching[k];
        d->pairs[k] = (dem_pair){d->images[a[slot]].part, d->images[b[slot]].part, b[slot], slot};
    }
}
