/* SPDX-License-Identifier: MIT
 *
 * slots.c - the memory of contacts, and which slot belongs to which pair.
 *
 * A pair's slot stays where it is while the pair lives. Slots of pairs that parted are free from the next step on, so that
 * their last row and bytes can be read until then.
 */
#include "contacts.h"
#include "memory.h"

#include <string.h>

/* A quarter more than is needed, so that a scene that grows slowly does not allocate at every step. */
static size_t with_room(size_t needed) { return needed + (needed / 4 < SIZE_MAX - needed ? needed / 4 : 0) + 256; }

enum { MOST_ARRAYS = 16 };

/* One array of several that grow together. */
typedef struct array {
    void **memory;
    size_t size;
} array;

/* Makes all arrays longer, what is in them stays: all of them or none. */
static narc_status grow(const narc_allocator *allocator, const array *arrays, size_t array_count, size_t *capacity,
                        size_t needed) {
    void *fresh[MOST_ARRAYS];
    size_t made = 0;
    if (needed <= *capacity)
        return NARC_OK;
    const size_t n = with_room(needed);
    for (; made < array_count; made++) {
        const size_t size = arrays[made].size ? arrays[made].size : 1;
        fresh[made] = n > SIZE_MAX / size ? NULL : allocator->allocate(n * size, allocator->context);
        if (!fresh[made])
            break;
    }
    if (made < array_count) {
        while (made-- > 0)
            allocator->release(fresh[made], allocator->context);
        return NARC_ERROR_MEMORY;
    }
    for (size_t k = 0; k < array_count; k++) {
        const size_t old = *capacity * arrays[k].size;
        if (*arrays[k].memory) {
            memcpy(fresh[k], *arrays[k].memory, old);
            allocator->release(*arrays[k].memory, allocator->context);
        }
        memset((char *)fresh[k] + old, 0, n * arrays[k].size - old);
        *arrays[k].memory = fresh[k];
    }
    *capacity = n;
    return NARC_OK;
}

#define ARRAY(pointer, size)                                                                                           \
    { (void **)(void *)&(pointer), size }
#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

narc_status narc_reserve_row_array(narc_contacts *c, narc_row_array *rows, size_t count) {
    const array arrays[] = {ARRAY(rows->rows, c->row_size), ARRAY(rows->kept, sizeof *rows->kept)};
    return grow(&c->allocator, arrays, COUNT_OF(arrays), &rows->capacity, count);
}

narc_status narc_reserve_slots(narc_contacts *c, const narc_pair_list *list, size_t bodies) {
    const size_t free_count = c->free_count + c->parted_count, fresh = list->kept ? 0 : list->added_count;
    const size_t slots = c->slot_count + (fresh > free_count ? fresh - free_count : 0), pairs = list->pairs.count;
    const array of_slots[] = {ARRAY(c->a, sizeof *c->a),
                              ARRAY(c->b, sizeof *c->b),
                              ARRAY(c->state, 1),
                              ARRAY(c->flags, 1),
                              ARRAY(c->marks, 1),
                              ARRAY(c->hints, sizeof *c->hints),
                              ARRAY(c->free, sizeof *c->free),
                              ARRAY(c->margins, sizeof *c->margins),
                              ARRAY(c->rows, c->row_size),
                              ARRAY(c->user, c->user_size),
                              ARRAY(c->kept, sizeof *c->kept),
                              ARRAY(c->entries, sizeof *c->entries),
                              ARRAY(c->ends, c->contact_rows ? 0 : sizeof *c->ends),
                              ARRAY(c->more_of, sizeof *c->more_of),
                              ARRAY(c->parted, sizeof *c->parted)};
    const array of_pairs[] = {ARRAY(c->order, sizeof *c->order),
                              ARRAY(c->next_order, sizeof *c->next_order),
                              ARRAY(c->work, sizeof *c->work),
                              ARRAY(c->asked, sizeof *c->asked),
                              ARRAY(c->known, sizeof *c->known),
                              ARRAY(c->candidates, sizeof *c->candidates),
                              ARRAY(c->left, sizeof *c->left),
                              ARRAY(c->sensors_asked, sizeof *c->sensors_asked),
                              ARRAY(c->ground_asked, sizeof *c->ground_asked),
                              ARRAY(c->ground_margins, sizeof *c->ground_margins),
                              ARRAY(c->touching, sizeof *c->touching),
                              ARRAY(c->sensors, sizeof *c->sensors),
                              ARRAY(c->bits, 1),
                              ARRAY(c->began, sizeof *c->began)};
    _Static_assert(COUNT_OF(of_slots) <= MOST_ARRAYS && COUNT_OF(of_pairs) <= MOST_ARRAYS, "too many");
    const array of_bodies[] = {ARRAY(c->room, sizeof *c->room)};
    /* One more than slots: what is listed without a branch may write behind the last one. */
    narc_status status = grow(&c->allocator, of_slots, COUNT_OF(of_slots), &c->slot_capacity, slots + 1);
    if (status == NARC_OK)
        status = grow(&c->allocator, of_pairs, COUNT_OF(of_pairs), &c->order_capacity, pairs);
    if (status == NARC_OK)
        status = grow(&c->allocator, of_bodies, COUNT_OF(of_bodies), &c->body_capacity, bodies);
    if (status == NARC_OK) { /* what ended: at most all pairs that are, and all that were */
        const array of_ends[] = {ARRAY(c->ended, sizeof *c->ended)};
        status = grow(&c->allocator, of_ends, COUNT_OF(of_ends), &c->end_capacity, pairs + list->lost_count);
    }
    /* the result of the last step shows arrays that moved */
    c->result.pairs = narc_view_slots(c);
    c->result.order = c->order;
    c->result.state = c->state;
    c->result.manifolds = c->contact_rows ? NULL : c->rows;
    c->result.contacts = c->contact_rows ? c->rows : NULL;
    c->result.user = c->user;
    c->result.touching = c->touching;
    c->result.sensors = c->sensors;
    c->result.began = c->began;
    c->result.ended = c->ended;
    return status;
}

/* A slot for a new pair: a free one, or one that was never in use. There is room. */
static uint32_t open_slot(narc_contacts *c) {
    const uint32_t slot = c->free_count > 0 ? c->free[--c->free_count] : (uint32_t)c->slot_count++;
    char *const row = narc_row_at(c, c->rows, slot);
    memset(row, 0, c->row_size);
    memcpy(row, &slot, sizeof slot); /* the row's `pair` */
    if (c->user_size > 0)
        memset((char *)c->user + slot * c->user_size, 0, c->user_size);
    c->hints[slot] = 0;
    c->more_of[slot] = (narc_more_rows){0, 0};
    c->flags[slot] = NARC_SLOT_STALE;
    c->state[slot] = 0;
    narc_mark_slot(c, slot, NARC_NEW);
    return slot;
}

void narc_take_slots(narc_contacts *c, const narc_pair_list *list) {
    for (size_t k = 0; k < c->parted_count; k++)
        c->free[c->free_count++] = c->parted[k];
    c->parted_count = 0;
    if (list->kept)
        return;
    for (size_t k = 0; k < list->lost_count; k++)
        c->parted[c->parted_count++] = c->order[list->lost[k].pair];
    for (size_t k = 0; k < list->pairs.count; k++) {
        const uint32_t last = list->previous[k], slot = last == UINT32_MAX ? open_slot(c) : c->order[last];
        c->next_order[k] = slot;
        c->a[slot] = list->pairs.a.base[k];
        c->b[slot] = list->pairs.b.base[k];
        if (list->marks[k] & NARC_FLIPPED) {
            c->flags[slot] |= NARC_SLOT_STALE;
            c->flags[slot] &= (uint8_t) ~(NARC_SLOT_KEPT | NARC_SLOT_ENTRY);
            c->hints[slot] = 0;
            narc_mark_slot(c, slot, NARC_TURNED);
        }
    }
    uint32_t *const made = c->next_order;
    c->next_order = c->order;
    c->order = made;
}

static void release(narc_contacts *c, void *memory) {
    if (memory)
        c->allocator.release(memory, c->allocator.context);
}

void narc_free_slots(narc_contacts *c) {
    void *const memory[] = {
        c->marks,      c->candidates, c->entries,   c->ends,           c->known,          c->left,
        c->a,          c->b,          c->state,     c->flags,          c->hints,          c->free,
        c->margins,    c->rows,       c->user,      c->kept,           c->more_of,        c->order,
        c->next_order, c->work,       c->asked,     c->sensors_asked,  c->parted,         c->ground_asked,
        c->touching,   c->sensors,    c->bits,      c->ground_margins, c->began,          c->ended,
        c->room,       c->more.rows,  c->more.kept, c->next_more.rows, c->next_more.kept, c->ground.rows,
        c->ground.kept};
    for (size_t k = 0; k < COUNT_OF(memory); k++)
        release(c, memory[k]);
}
