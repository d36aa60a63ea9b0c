/* SPDX-License-Identifier: MIT
 *
 * ground.c - bodies on pieces of chains: all pieces that a body is near are asked at once, as what they tell of it is merged,
 * and a pair with a concave arc may have several rows. The first one is its slot's, the others lie apart.
 */
#include "column.h"
#include "contacts.h"
#include "merge.h"

#include <string.h>

static uint32_t pair_of(const void *row) {
    uint32_t pair;
    memcpy(&pair, row, sizeof pair);
    return pair;
}

narc_status narc_ask_ground(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_pairs *const pairs = &s->list->pairs;
    narc_status status = NARC_OK;
    c->ground_count = c->ground.count = 0;
    for (size_t i = 0; i < c->work_count; i++)
        if (c->work[i].what == NARC_ASK_GROUND) {
            const uint32_t k = c->work[i].pair;
            c->ground_margins[k] = narc_find_margin(s, pairs->a.base[k], pairs->b.base[k]);
            c->ground_asked[c->ground_count++] = k;
        }
    if (c->ground_count > 0)
        status = narc_reserve_arrays(c, NARC_OF_GROUND, &c->ground.capacity, 2 * c->ground_count);
    while (status == NARC_OK && c->ground_count > 0) {
        status =
            narc_ask_pairs(s, c->ground_asked, c->ground_count, c->ground.rows, c->ground.capacity, &c->ground.count);
        if (status != NARC_ERROR_CAPACITY)
            break;
        status = narc_reserve_arrays(c, NARC_OF_GROUND, &c->ground.capacity, c->ground.count);
    }
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_NEXT_MORE, &c->next_more.capacity, c->more.count + c->ground.count);
    if (status == NARC_OK && s->step->run.base)
        c->ground.count = c->contact_rows ? narc_merge_contacts(pairs, s->step->run, c->ground.rows, c->ground.count)
                                          : narc_merge_manifolds(pairs, s->step->run, c->ground.rows, c->ground.count);
    return status;
}

/* A row of a slot to place `item` of an array. */
static void put_row(const narc_contact_step *s, uint32_t slot, const void *from, void *rows, narc_kept_row *kept,
                    uint32_t item) {
    const narc_contacts *const c = s->contacts;
    const narc_pairs pairs = narc_view_slots(c);
    const narc_rows view = narc_view_rows(c, rows);
    void *const row = (char *)view.base + (ptrdiff_t)item * view.stride;
    memcpy(row, from, c->row_size);
    memcpy(row, &slot, sizeof slot);
    memset(&kept[item], 0, sizeof *kept); /* it is saved, of use or not */
    if (s->step->recycling > 0)
        narc_keep_rows(s, &pairs, &slot, &item, 1, rows, kept);
}

/* The further rows of a pair that was not asked stay. */
static void keep_more(narc_contacts *c, uint32_t slot) {
    narc_more_rows *const more = &c->more_of[slot];
    memcpy(narc_row_at(c, c->next_more.rows, c->next_more.count), narc_row_at(c, c->more.rows, more->first),
           more->count * c->row_size);
    memcpy(c->next_more.kept + c->next_more.count, c->more.kept + more->first, more->count * sizeof *c->more.kept);
    more->first = (uint32_t)c->next_more.count;
    c->next_more.count += more->count;
}

/* The rows of pair k of the list, from number `at` of those asked for on; returns the number behind them. */
static size_t take_rows(const narc_contact_step *s, size_t k, size_t at) {
    narc_contacts *const c = s->contacts;
    const uint32_t slot = c->order[k];
    size_t end = at;
    while (end < c->ground.count && pair_of(narc_row_at(c, c->ground.rows, end)) == k)
        end++;
    narc_zero_row(c, slot);
    c->flags[slot] =
        (uint8_t)((c->flags[slot] & ~(NARC_SLOT_KEPT | NARC_SLOT_ENTRY)) | (end > at ? NARC_SLOT_KEPT : 0));
    if (end > at)
        put_row(s, slot, narc_row_at(c, c->ground.rows, at), c->rows, c->kept, slot);
    const size_t more = end > at ? end - at - 1 : 0;
    c->more_of[slot] = (narc_more_rows){(uint32_t)c->next_more.count, (uint32_t)more};
    for (size_t i = 0; i < more; i++) {
        const uint32_t to = (uint32_t)c->next_more.count++;
        put_row(s, slot, narc_row_at(c, c->ground.rows, at + 1 + i), c->next_more.rows, c->next_more.kept, to);
    }
    narc_mark_slot(c, slot, NARC_ASKED);
    narc_set_touching(c, slot, end > at);
    return end;
}

void narc_take_ground(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    size_t at = 0, next = 0;
    if (c->ground_count == 0 && (c->more.count == 0 || !c->changed))
        return;
    c->next_more.count = 0;
    for (size_t k = 0; k < s->list->pairs.count; k++)
        if (next < c->ground_count && c->ground_asked[next] == k) {
            next++;
            at = take_rows(s, k, at);
        } else if (c->more_of[c->order[k]].count > 0)
            keep_more(c, c->order[k]);
    const narc_row_array made = c->next_more;
    c->next_more = c->more;
    c->more = made;
}
