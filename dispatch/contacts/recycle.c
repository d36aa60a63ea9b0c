/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that are kept while their bodies have hardly moved against each other, and follow them
 * (kernels/sat/recycle.c).
 */
#include "column.h"
#include "contacts.h"
#include "dispatch.h"
#include "piece.h"
#include "vec2.h"

#include <math.h>
#include <stddef.h>

void narc_keep_rows(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, const uint32_t *item,
                    size_t count, void *to, narc_kept_row *kept) {
    const narc_query query = {.selection = {slots, sizeof *slots}, .selection_count = count};
    const narc_rows rows = narc_view_rows(s->contacts, to);
    narc_batch batch;
    if (count == 0)
        return;
    const narc_kernel_table *const kernels = narc_fill_slots(s, pairs, &query, &batch);
    if (kernels)
        kernels->keep(&batch, 0, count, item, &rows, kept);
}

void narc_keep_bare(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, size_t count) {
    narc_contacts *const c = s->contacts;
    const narc_query query = {
        .margin = INFINITY, .dense = 1, .selection = {slots, sizeof *slots}, .selection_count = count};
    const narc_rows out = {.base = (char *)c->kept + offsetof(narc_kept_row, apart), .stride = sizeof *c->kept};
    narc_batch batch;
    size_t skipped = 0;
    const narc_kernel_table *const kernels = count > 0 ? narc_fill_slots(s, pairs, &query, &batch) : NULL;
    if (!kernels)
        return;
    narc_keep_rows(s, pairs, slots, NULL, count, c->rows, c->kept);
    kernels->separation(&batch, 0, count, &skipped, &out);
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = slots[i], a = c->a[slot], b = c->b[slot];
        narc_kept_row *const kept = &c->kept[slot];
        const float margin = narc_find_margin(s, a, b), apart = kept->apart;
        /* as are_apart() has it, before and after */
        kept->apart = apart - margin - 0x1p-16f * (apart + margin) - 2 * (c->room[a] + c->room[b]);
        kept->lever = -(0x1p17f * c->room[a] + apart);
        if (kept->apart > 0 && kept->apart < INFINITY)
            c->flags[slot] |= NARC_SLOT_KEPT;
        else
            *kept = (narc_kept_row){.lever = 0}; /* it is saved, of use or not */
    }
}

/* One of two bodies, with the world's x axis as the direction. */
static narc_contact_side find_side(const narc_contact_step *s, uint32_t body, narc_point way) {
    const narc_bodies *const bodies = s->step->bodies;
    const narc_shape_header *const header = &s->shapes->headers[narc_index_at(bodies->shape, body)];
    const double x = (double)narc_float_at(bodies->cosine, body), y = (double)narc_float_at(bodies->sine, body);
    const double length = sqrt(x * x + y * y), c = x / length, d = y / length;
    return (narc_contact_side){.header = header,
                               .arcs = narc_arcs_of(s->shapes, header),
                               .scale = (double)narc_float_or(bodies->scale, body, 1),
                               .x = c,
                               .y = -d,
                               .other_x = c * way.x + d * way.y,
                               .other_y = c * way.y - d * way.x};
}

void narc_keep_bare_ground(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, size_t count) {
    narc_contacts *const c = s->contacts;
    const narc_bodies *const bodies = s->step->bodies;
    narc_keep_rows(s, pairs, slots, NULL, count, c->rows, c->kept);
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = slots[i], a = c->a[slot], b = c->b[slot];
        const narc_point way = {narc_position_at(bodies->x, b) - narc_position_at(bodies->x, a),
                                narc_position_at(bodies->y, b) - narc_position_at(bodies->y, a)};
        const narc_contact_side of_a = find_side(s, a, way), of_b = find_side(s, b, (narc_point){-way.x, -way.y});
        const bool is_b = narc_is_piece(of_b.header);
        const double extent_a = 0x1p17 * (double)c->room[a], extent_b = 0x1p17 * (double)c->room[b];
        const double distance = sqrt(narc_dot(way, way)), lever = is_b ? extent_a : distance + extent_b;
        const double margin = (double)narc_find_margin(s, a, b);
        const double free =
            narc_find_free_way(is_b ? &of_b : &of_a, is_b ? &of_a : &of_b, margin, distance + extent_a + extent_b);
        narc_kept_row *const kept = &c->kept[slot];
        if (free > 0 && free < (double)INFINITY) {
            kept->apart = (float)free;
            kept->lever = -(float)lever;
            c->flags[slot] |= NARC_SLOT_KEPT;
        } else {
            *kept = (narc_kept_row){.lever = 0}; /* it is saved, of use or not */
        }
    }
}

/* Does the row of a pair that was kept in kept[item] follow its bodies? `to`: rows; NULL: may it? */
static bool follow_row(const narc_contact_step *s, const narc_pairs *pairs, uint32_t pair, uint32_t item, void *to,
                       const narc_kept_row *kept) {
    const float margin = narc_find_margin(s, narc_index_at(pairs->a, pair), narc_index_at(pairs->b, pair));
    const narc_query query = {.margin = margin, .selection = {&pair, sizeof pair}, .selection_count = 1};
    const narc_rows rows = narc_view_rows(s->contacts, to);
    narc_batch batch;
    uint32_t left;
    const narc_kernel_table *const kernels = narc_fill_slots(s, pairs, &query, &batch);
    return kernels && kernels->recycle(&batch, 0, 1, &item, kept, s->step->recycling, to ? &rows : NULL, &left) == 0;
}

bool narc_may_follow(const narc_contact_step *s, uint32_t pair, uint32_t item, const narc_kept_row *kept) {
    return follow_row(s, &s->list->pairs, pair, item, NULL, kept);
}

void narc_follow_more(const narc_contact_step *s, const narc_pairs *pairs, uint32_t slot) {
    const narc_contacts *const c = s->contacts;
    const narc_more_rows more = c->more_of[slot];
    for (uint32_t i = more.first; i < more.first + more.count; i++)
        follow_row(s, pairs, slot, i, c->more.rows, c->more.kept);
}
