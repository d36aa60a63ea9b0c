/* SPDX-License-Identifier: MIT
 *
 * plan.c - what a step does with each pair whose bodies are others than in the last one: ask, follow, or nothing.
 */
#include "column.h"
#include "contacts.h"
#include "store.h"

#include <math.h>
#include <string.h>

static uint8_t kind_of(const narc_contact_step *s, uint32_t body) {
    const narc_byte_column kind = s->step->filter ? s->step->filter->kind : (narc_byte_column){NULL, 0};
    return kind.base ? narc_byte_at(kind, body) & NARC_KINDS : 0;
}

bool narc_is_tested(const narc_contact_step *s, uint32_t a, uint32_t b) {
    enum { AT_REST = NARC_STATIC | NARC_ASLEEP };
    return !(kind_of(s, a) & AT_REST && kind_of(s, b) & AT_REST);
}

static const narc_shape_header *header_of(const narc_contact_step *s, uint32_t body) {
    return &s->shapes->headers[narc_index_at(s->step->bodies->shape, body)];
}

bool narc_is_ground_pair(const narc_contact_step *s, uint32_t a, uint32_t b) {
    return s->has_ground && (narc_is_piece(header_of(s, a)) || narc_is_piece(header_of(s, b)));
}

bool narc_are_smooth(const narc_contact_step *s, uint32_t a, uint32_t b) {
    return header_of(s, a)->flags & header_of(s, b)->flags & NARC_SHAPE_SMOOTH;
}

/* Is there no row, as the boxes of both, which have half of the margin each, are further apart than a separation may be
 * off? Its error bound is 2^-19 of the distance of the positions and both extents (narc.h); the distance is the gap between
 * the boxes, the margin and both extents at most. */
static inline bool are_apart(const narc_contact_step *s, uint32_t a, uint32_t b) {
    const narc_contacts *const c = s->contacts;
    const narc_box *const p = &c->broad->boxes_now[a], *const q = &c->broad->boxes_now[b];
    const float left = p->min_x - q->max_x, right = q->min_x - p->max_x;
    const float below = p->min_y - q->max_y, above = q->min_y - p->max_y;
    const float x = left > right ? left : right, y = below > above ? below : above, gap = x > y ? x : y;
    return (!s->step->ahead.base) & (gap * (1 - 0x1p-18f) > c->room[a] + c->room[b] + 0x1p-18f * s->step->margin);
}

/* Twice 2^-18 of a body's extent; infinite where it is not known. */
static float find_room(const narc_contact_step *s, uint32_t body) {
    const narc_shape_header *const header = header_of(s, body);
    const float scale = narc_float_or(s->step->bodies->scale, body, 1);
    return header->extent_ratio == UINT8_MAX ? INFINITY
                                             : 0x1p-17f * (float)header->extent_ratio * header->bound_radius * scale;
}

static bool has_changed(const narc_contact_step *s, uint32_t a, uint32_t b) {
    const uint8_t *const changed = s->contacts->broad->known.changed;
    return changed[a] | changed[b];
}

static bool is_reshaped(const narc_contact_step *s, uint32_t a, uint32_t b) {
    const uint8_t *const changed = s->contacts->broad->known.changed;
    return (changed[a] | changed[b]) & NARC_RESHAPED;
}

float narc_find_margin(const narc_contact_step *s, uint32_t a, uint32_t b) {
    const narc_float_column ahead = s->step->ahead;
    return s->step->margin + (ahead.base ? narc_float_at(ahead, a) + narc_float_at(ahead, b) : 0);
}

/* Must a pair be asked, whatever has moved: is it new, turned, a sensor's for the first time, was it at rest while
 * something changed? */
static bool is_stale(const narc_contact_step *s, size_t k, uint32_t slot) {
    const narc_contacts *const c = s->contacts;
    if (slot == UINT32_MAX || c->again)
        return true;
    const bool sensor = s->list->marks[k] & NARC_SENSOR, was_sensor = c->flags[slot] & NARC_SLOT_SENSOR;
    return c->flags[slot] & NARC_SLOT_STALE || sensor != was_sensor || s->list->marks[k] & NARC_FLIPPED;
}

static void add_work(narc_contacts *c, size_t k, unsigned what) {
    c->work[c->work_count++] = (narc_pair_work){(uint32_t)k, what};
}

static void plan_pair(const narc_contact_step *s, size_t k, uint32_t a, uint32_t b) {
    narc_contacts *const c = s->contacts;
    const uint32_t slot = narc_old_slot(c, s->list, k);
    const bool stale = is_stale(s, k, slot);
    if (!stale && !has_changed(s, a, b))
        return;
    unsigned what = are_apart(s, a, b) ? NARC_APART : NARC_ASK; /* as chance has it: without a branch */
    if (s->step->filter && !narc_is_tested(s, a, b))
        what = NARC_REST;
    else if (s->list->marks[k] & NARC_SENSOR)
        what = NARC_ASK_SENSOR;
    else if (s->step->recycling > 0 && what == NARC_ASK && !stale && !is_reshaped(s, a, b) &&
             c->flags[slot] & NARC_SLOT_KEPT && narc_may_follow(s, a, b, &c->kept[slot]))
        what = NARC_FOLLOW;
    add_work(c, k, what);
}

/* May all rows of a pair of ground follow? A pair without one may, too. */
static bool may_follow_ground(const narc_contact_step *s, uint32_t slot, uint32_t a, uint32_t b) {
    const narc_contacts *const c = s->contacts;
    const narc_more_rows more = c->more_of[slot];
    bool may = !(c->state[slot] & NARC_TOUCHING) ||
               (c->flags[slot] & NARC_SLOT_KEPT && narc_may_follow(s, a, b, &c->kept[slot]));
    for (uint32_t i = 0; i < more.count; i++)
        may = may && narc_may_follow(s, a, b, &c->more.kept[more.first + i]);
    return may;
}

/* The pairs first .. end - 1 of one body, some with ground: all of these are asked together, as their rows are merged. */
static void plan_ground(const narc_contact_step *s, size_t first, size_t end) {
    narc_contacts *const c = s->contacts;
    const uint32_t a = s->list->pairs.a.base[first], *const b = s->list->pairs.b.base;
    bool changed = false, stale = false, apart = true, touches = false, follows = s->step->recycling > 0;
    for (size_t k = first; k < end; k++) {
        const uint32_t slot = narc_old_slot(c, s->list, k);
        if (!narc_is_ground_pair(s, a, b[k]) || s->list->marks[k] & NARC_SENSOR)
            continue;
        const bool old = is_stale(s, k, slot);
        stale |= old;
        changed |= old || has_changed(s, a, b[k]);
        apart = apart && are_apart(s, a, b[k]);
        touches |= slot != UINT32_MAX && c->state[slot] & NARC_TOUCHING;
        follows = follows && !old && !is_reshaped(s, a, b[k]) && may_follow_ground(s, slot, a, b[k]);
    }
    const unsigned what = apart ? NARC_APART : follows && touches && !stale ? NARC_FOLLOW : NARC_ASK_GROUND;
    for (size_t k = first; k < end; k++)
        if (!narc_is_ground_pair(s, a, b[k]) || s->list->marks[k] & NARC_SENSOR)
            plan_pair(s, k, a, b[k]);
        else if (changed)
            add_work(c, k, narc_is_tested(s, a, b[k]) ? what : NARC_REST);
}

/* The first pair from `k` on with a body that has changed. Four at a time, as most of them have none. */
static size_t find_changed(const narc_pairs *pairs, const uint8_t *changed, size_t k) {
    const uint32_t *const a = pairs->a.base, *const b = pairs->b.base;
    const size_t count = pairs->count;
    while (count - k >= 4 && !(changed[a[k]] | changed[b[k]] | changed[a[k + 1]] | changed[b[k + 1]] |
                               changed[a[k + 2]] | changed[b[k + 2]] | changed[a[k + 3]] | changed[b[k + 3]]))
        k += 4;
    while (k < count && !(changed[a[k]] | changed[b[k]]))
        k++;
    return k;
}

/* Are all pairs those of the last step, asked in the same way, with the same kinds, so that only moves count? */
static bool is_list_kept(const narc_contact_step *s) {
    return s->list->kept && !s->contacts->broad->marked && !s->contacts->again;
}

static bool has_any_changed(const uint8_t *changed, size_t count) {
    uint64_t any = 0;
    size_t k = 0;
    for (; k + sizeof any <= count; k += sizeof any) {
        uint64_t some;
        memcpy(&some, changed + k, sizeof some);
        any |= some;
    }
    for (; k < count; k++)
        any |= changed[k];
    return any;
}

void narc_plan_step(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_pairs *const pairs = &s->list->pairs;
    const uint32_t *const a = pairs->a.base, *const b = pairs->b.base;
    const uint8_t *const changed = c->broad->known.changed;
    const bool kept = is_list_kept(s);
    c->work_count = 0;
    if (kept && !has_any_changed(changed, s->step->bodies->count))
        return;
    for (size_t k = 0; k < s->step->bodies->count; k++)
        if (changed[k] & NARC_RESHAPED)
            c->room[k] = find_room(s, (uint32_t)k);
    if (!s->has_ground) {
        for (size_t k = 0; (k = kept ? find_changed(pairs, changed, k) : k) < pairs->count; k++)
            plan_pair(s, k, a[k], b[k]);
        return;
    }
    for (size_t k = 0, end; k < pairs->count; k = end) {
        bool ground = false;
        for (end = k; end < pairs->count && a[end] == a[k]; end++)
            ground = ground || narc_is_ground_pair(s, a[end], b[end]);
        if (ground)
            plan_ground(s, k, end);
        else
            for (size_t i = k; i < end; i++)
                plan_pair(s, i, a[i], b[i]);
    }
}
