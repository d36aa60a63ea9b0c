/* SPDX-License-Identifier: MIT
 *
 * slots.c - the memory of contacts, and which slot belongs to which pair.
 *
 * A pair's slot stays where it is while the pair lives. Slots of pairs that parted are free from the next step on, so that
 * their last row and bytes can be read until then.
 */
#include "contacts.h"
#include "dispatch.h"
#include "error.h"
#include "memory.h"

#include <string.h>

/* An eighth more than is needed, so that a scene that grows slowly does not allocate at every step. */
static size_t with_room(size_t needed) { return needed + (needed / 8 < SIZE_MAX - needed ? needed / 8 : 0) + 256; }

/* Makes room for `needed` items in all arrays that grow together, what is in them stays: in all or in none. */
static narc_status grow(const narc_contacts *c, const narc_array *arrays, size_t array_count, narc_growth growth,
                        size_t *capacity, size_t needed) {
    void *fresh[NARC_ARRAYS] = {NULL};
    const size_t n = with_room(needed);
    bool whole = true;
    if (needed <= *capacity)
        return NARC_OK;
    for (size_t k = 0; k < array_count && whole; k++)
        if (arrays[k].growth == growth && arrays[k].size > 0) {
            fresh[k] =
                n > SIZE_MAX / arrays[k].size ? NULL : c->allocator.allocate(n * arrays[k].size, c->allocator.context);
            whole = fresh[k] != NULL;
        }
    for (size_t k = 0; k < array_count; k++) {
        const narc_array *const array = &arrays[k];
        const size_t old = *capacity * array->size;
        if (!fresh[k])
            continue;
        if (!whole) {
            c->allocator.release(fresh[k], c->allocator.context);
            continue;
        }
        if (*array->memory) {
            memcpy(fresh[k], *array->memory, old);
            c->allocator.release(*array->memory, c->allocator.context);
        }
        memset((char *)fresh[k] + old, 0, n * array->size - old);
        *array->memory = fresh[k];
    }
    if (!whole)
        return NARC_ERROR_MEMORY;
    *capacity = n;
    return NARC_OK;
}

size_t narc_list_arrays(narc_contacts *c, narc_array out[NARC_ARRAYS]) {
    narc_step_result *const r = &c->result;
    size_t *const none = NULL;
    c->event_count = r->began_count + r->ended_count;
    const size_t row_size = c->rows_in_user ? 0 : c->row_size;
#define ARRAY(growth, pointer, size, count)                                                                            \
    { growth, (void **)(void *)&(pointer), size, count }
    const narc_array arrays[] = {ARRAY(NARC_OF_SLOTS, c->a, sizeof *c->a, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->b, sizeof *c->b, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->state, 1, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->flags, 1, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->marks, 1, none),
                                 ARRAY(NARC_OF_SLOTS_AHEAD, c->margins, sizeof *c->margins, none),
                                 ARRAY(NARC_OF_SLOTS, c->own_rows, row_size, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->user, c->user_size, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->entries, sizeof *c->entries, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->ends, c->contact_rows ? 0 : sizeof *c->ends, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->more_of, sizeof *c->more_of, &c->slot_count),
                                 ARRAY(NARC_OF_SLOTS, c->free, sizeof *c->free, &c->free_count),
                                 ARRAY(NARC_OF_SLOTS, c->parted, sizeof *c->parted, &c->parted_count),
                                 ARRAY(NARC_OF_PAIRS, c->order, sizeof *c->order, &r->count),
                                 ARRAY(NARC_OF_PAIRS, c->touching, sizeof *c->touching, &r->touching_count),
                                 ARRAY(NARC_OF_FILTERED_PAIRS, c->sensors, sizeof *c->sensors, &r->sensor_count),
                                 ARRAY(NARC_OF_EVENTS, c->events, sizeof *c->events, &c->event_count),
                                 ARRAY(NARC_OF_BODIES, c->room, sizeof *c->room, none),
                                 ARRAY(NARC_OF_BODIES, c->grounds, 1, none),
                                 ARRAY(NARC_OF_MORE, c->more.rows, c->row_size, &c->more.count),
                                 ARRAY(NARC_OF_MORE, c->more.kept, sizeof *c->more.kept, &c->more.count),
                                 ARRAY(NARC_OF_NEXT_MORE, c->next_more.rows, c->row_size, none),
                                 ARRAY(NARC_OF_NEXT_MORE, c->next_more.kept, sizeof *c->next_more.kept, none),
                                 ARRAY(NARC_OF_GROUND, c->ground.rows, c->row_size, none),
                                 ARRAY(NARC_OF_GROUND, c->ground.kept, sizeof *c->ground.kept, none),
                                 ARRAY(NARC_OF_PAIRS, c->next_order, sizeof *c->next_order, none),
                                 ARRAY(NARC_OF_GROUND_PAIRS, c->work, sizeof *c->work, none),
                                 ARRAY(NARC_OF_PAIRS, c->asked, sizeof *c->asked, none),
                                 ARRAY(NARC_OF_PAIRS, c->known, sizeof *c->known, none),
                                 ARRAY(NARC_OF_PAIRS, c->candidates, sizeof *c->candidates, none),
                                 ARRAY(NARC_OF_PAIRS, c->left, sizeof *c->left, none),
                                 ARRAY(NARC_OF_FILTERED_PAIRS, c->sensors_asked, sizeof *c->sensors_asked, none),
                                 ARRAY(NARC_OF_GROUND_PAIRS, c->ground_asked, sizeof *c->ground_asked, none),
                                 ARRAY(NARC_OF_GROUND_PAIRS, c->ground_pairs, sizeof *c->ground_pairs, none),
                                 ARRAY(NARC_OF_GROUND_PAIRS, c->ground_margins, sizeof *c->ground_margins, none),
                                 ARRAY(NARC_OF_FILTERED_PAIRS, c->bits, 1, none),
                                 ARRAY(NARC_OF_PARTNERS, c->partners, sizeof *c->partners, none),
                                 ARRAY(NARC_OF_PARTNER_ENDS, c->partner_ends, sizeof *c->partner_ends, none)};
#undef ARRAY
    _Static_assert(sizeof arrays / sizeof *arrays == NARC_ARRAYS, "their number");
    memcpy(out, arrays, sizeof arrays);
    return NARC_ARRAYS;
}

narc_status narc_reserve_arrays(narc_contacts *c, narc_growth growth, size_t *capacity, size_t count) {
    narc_array arrays[NARC_ARRAYS];
    if (count <= *capacity)
        return NARC_OK;
    return grow(c, arrays, narc_list_arrays(c, arrays), growth, capacity, count);
}

void narc_show_arrays(narc_contacts *c) {
    narc_step_result *const r = &c->result;
    void *const rows = c->rows_in_user ? NULL : c->own_rows;
    c->rows = c->rows_in_user && c->user ? (char *)c->user + c->row_offset : c->own_rows;
    r->pairs = narc_view_slots(c);
    r->order = c->order;
    r->state = c->state;
    r->manifolds = c->contact_rows ? NULL : rows;
    r->contacts = c->contact_rows ? rows : NULL;
    r->user = c->user;
    r->more = c->more.rows;
    r->touching = c->touching;
    r->sensors = c->sensors;
    r->began = c->events;
    r->ended = c->events ? c->events + r->began_count : NULL;
    c->kept = (narc_kept_row *)(void *)c->entries;
}

narc_status narc_reserve_slots(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_pair_list *const list = s->list;
    const size_t free_count = c->free_count + c->parted_count, fresh = list->kept ? 0 : list->added_count;
    const size_t slots = c->slot_count + (fresh > free_count ? fresh - free_count : 0), pairs = list->pairs.count;
    const struct {
        narc_growth growth;
        size_t *capacity, count;
    } needed[] = {/* what is listed without a branch may be written behind the last */
                  {NARC_OF_SLOTS, &c->slot_capacity, slots + 1},
                  {NARC_OF_SLOTS_AHEAD, &c->ahead_capacity, s->step->ahead.base ? slots : 0},
                  {NARC_OF_PAIRS, &c->order_capacity, pairs + 1},
                  {NARC_OF_FILTERED_PAIRS, &c->filtered_capacity, c->broad->has_filter ? pairs : 0},
                  {NARC_OF_GROUND_PAIRS, &c->ground_capacity, s->has_ground ? pairs : 0},
                  {NARC_OF_EVENTS, &c->event_capacity, pairs + (list->kept ? 0 : list->lost_count)},
                  {NARC_OF_BODIES, &c->body_capacity, s->step->bodies->count}};
    narc_status status = NARC_OK;
    for (size_t k = 0; k < sizeof needed / sizeof *needed && status == NARC_OK; k++)
        status = narc_reserve_arrays(c, needed[k].growth, needed[k].capacity, needed[k].count);
    narc_show_arrays(c); /* the result of the last step shows arrays that moved */
    return status;
}

/* A slot for a new pair: a free one, or one that was never in use. There is room. */
static uint32_t open_slot(narc_contacts *c) {
    const uint32_t slot = c->free_count > 0 ? c->free[--c->free_count] : (uint32_t)c->slot_count++;
    if (c->user_size > 0)
        memset((char *)c->user + slot * c->user_size, 0, c->user_size);
    narc_zero_row(c, slot);
    memset(&c->entries[slot], 0, sizeof *c->entries); /* it is saved, of use or not */
    if (!c->contact_rows)
        memset(&c->ends[slot], 0, sizeof *c->ends);
    c->more_of[slot] = (narc_more_rows){0, 0};
    c->flags[slot] = NARC_SLOT_STALE;
    c->state[slot] = 0;
    narc_mark_slot(c, slot, NARC_NEW);
    return slot;
}

/* The slots of pairs that were there; the bodies of some may have other numbers now. */
static void take_old_slots(narc_contacts *c, const narc_pair_list *list) {
    const uint32_t *const previous = list->previous, *const order = c->order;
    uint32_t *const next = c->next_order;
    const size_t count = list->pairs.count, last_count = c->result.count;
    for (size_t k = 0; k < count; k++)
        next[k] = previous[k] < last_count ? order[previous[k]] : 0;
    for (size_t k = 0; k < count && list->renumbered; k++) {
        if (previous[k] == NARC_NO_MATCH)
            continue;
        const uint32_t slot = next[k];
        c->a[slot] = list->pairs.a.base[k];
        c->b[slot] = list->pairs.b.base[k];
        if (list->marks[k] & NARC_FLIPPED) {
            c->flags[slot] |= NARC_SLOT_STALE;
            c->flags[slot] &= (uint8_t) ~(NARC_SLOT_KEPT | NARC_SLOT_ENTRY);
            narc_mark_slot(c, slot, NARC_TURNED);
        }
    }
}

void narc_take_slots(narc_contacts *c, const narc_pair_list *list) {
    for (size_t k = 0; k < c->parted_count; k++)
        c->free[c->free_count++] = c->parted[k];
    c->parted_count = 0;
    if (list->kept)
        return;
    for (size_t k = 0; k < list->lost_count; k++) {
        const uint32_t slot = c->order[list->lost[k].pair];
        c->parted[c->parted_count++] = slot;
        c->a[slot] = c->b[slot] = 0;
    }
    take_old_slots(c, list);
    for (size_t i = 0; i < list->added_count; i++) {
        const uint32_t k = list->added[i], slot = open_slot(c);
        c->next_order[k] = slot;
        c->a[slot] = list->pairs.a.base[k];
        c->b[slot] = list->pairs.b.base[k];
    }
    uint32_t *const made = c->next_order;
    c->next_order = c->order;
    c->order = made;
}

void narc_free_slots(narc_contacts *c) {
    narc_array arrays[NARC_ARRAYS];
    const size_t count = narc_list_arrays(c, arrays);
    for (size_t k = 0; k < count; k++)
        if (*arrays[k].memory)
            c->allocator.release(*arrays[k].memory, c->allocator.context);
}

/* ------------------------------------------------------------------------------------------------ a body's slots */

/* Slots by body, by counting: each stands with both of its bodies, in the order of pairs. */
static void list_partners(narc_contacts *c, size_t bodies) {
    const size_t count = c->result.count;
    uint32_t *const ends = c->partner_ends;
    uint32_t sum = 0;
    memset(ends, 0, (bodies + 1) * sizeof *ends);
    for (size_t k = 0; k < count; k++) {
        ends[c->a[c->order[k]] + 1]++;
        ends[c->b[c->order[k]] + 1]++;
    }
    for (size_t k = 1; k <= bodies; k++) {
        const uint32_t first = sum;
        sum += ends[k];
        ends[k] = first; /* where the next slot of body k - 1 goes, and its end when all are there */
    }
    for (size_t k = 0; k < count; k++) {
        const uint32_t slot = c->order[k];
        c->partners[ends[c->a[slot] + 1]++] = slot;
        c->partners[ends[c->b[slot] + 1]++] = slot;
    }
    c->partners_listed = true;
}

narc_status narc_find_body_slots(narc_contacts *c, uint32_t body, const uint32_t **out_slots, size_t *out_count,
                                 narc_error *error) {
    if (!c || !out_slots || !out_count)
        return narc_fail_missing(error, !c ? "contacts" : !out_slots ? "out_slots" : "out_count");
    const size_t bodies = c->broad->lists[c->broad->last].body_count;
    if (body >= bodies)
        return narc_fail(error, NARC_ERROR_INDEX, 0, body, "body %lu, but the last step had %zu bodies",
                         (unsigned long)body, bodies);
    if (!c->partners_listed) {
        narc_status status = c->result.count > UINT32_MAX / 2 ? NARC_ERROR_MEMORY : NARC_OK;
        if (status == NARC_OK)
            status = narc_reserve_arrays(c, NARC_OF_PARTNERS, &c->partner_capacity, 2 * c->result.count);
        if (status == NARC_OK)
            status = narc_reserve_arrays(c, NARC_OF_PARTNER_ENDS, &c->partner_end_capacity, bodies + 1);
        if (status != NARC_OK)
            return narc_fail(error, status, 0, (double)c->result.count, "not enough memory for the slots of %zu bodies",
                             bodies);
        list_partners(c, bodies);
    }
    *out_count = c->partner_ends[body + 1] - c->partner_ends[body];
    *out_slots = *out_count > 0 ? c->partners + c->partner_ends[body] : c->partners; /* without pairs there are none */
    return NARC_OK;
}
