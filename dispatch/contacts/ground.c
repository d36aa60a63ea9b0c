/* SPDX-License-Identifier: MIT
 *
 * ground.c - bodies on pieces of chains: all pieces that a body is near are asked at once, as what they tell of it is merged,
 * and a pair with a concave arc may have several rows. The first one is its slot's, the others lie apart.
 */
#include "column.h"
#include "compiler.h"
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
    narc_status status = NARC_OK;
    c->ground.count = 0;
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
    return status;
}

/* A row of a slot to its place. */
static void put_row(const narc_contacts *c, uint32_t slot, const void *from, void *to) {
    if (c->contact_rows) /* sizes that the compiler knows */
        memcpy(to, from, sizeof(narc_contact));
    else
        memcpy(to, from, sizeof(narc_manifold));
    memcpy(to, &slot, sizeof slot);
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

/* The rows of pair k of the list, from number `at` to before `last` of those asked for on; returns the number behind them. The
 * first one is not kept yet. */
static size_t take_rows(const narc_contact_step *s, const narc_pairs *pairs, size_t k, uint32_t slot, size_t at,
                        size_t last) {
    narc_contacts *const c = s->contacts;
    narc_row_array *const more = &c->next_more;
    const bool keeps = s->step->recycling > 0;
    size_t end = at;
    while (end < last && pair_of(narc_row_at(c, c->ground.rows, end)) == k)
        end++;
    if (end == at && c->state[slot] & NARC_TOUCHING)
        narc_zero_row(c, slot);
    c->flags[slot] = (uint8_t)((c->flags[slot] & ~(NARC_SLOT_KEPT | NARC_SLOT_ENTRY)) | NARC_SLOT_SEEN |
                               (end > at && keeps ? NARC_SLOT_KEPT : 0));
    if (end > at)
        put_row(c, slot, narc_row_at(c, c->ground.rows, at), narc_slot_row(c, slot));
    if (end > at && !(c->marks[slot] & NARC_KEEPS_NOTHING)) /* it is saved, of use or not */
        memset(&c->kept[slot], 0, sizeof *c->kept);
    c->marks[slot] = (uint8_t)((c->marks[slot] & ~NARC_KEEPS_NOTHING) | (end > at && !keeps ? NARC_KEEPS_NOTHING : 0));
    c->more_of[slot] = (narc_more_rows){(uint32_t)more->count, (uint32_t)(end > at ? end - at - 1 : 0)};
    for (size_t i = at + 1; i < end; i++) {
        const uint32_t to = (uint32_t)more->count++;
        put_row(c, slot, narc_row_at(c, c->ground.rows, i), narc_row_at(c, more->rows, to));
        memset(&more->kept[to], 0, sizeof *more->kept);
        if (keeps)
            narc_keep_rows(s, pairs, &slot, &to, 1, more->rows, more->kept);
    }
    narc_mark_slot(c, slot, NARC_ASKED);
    narc_set_touching(c, slot, end > at);
    return end;
}

/* Asks the cache for what take_rows() writes. */
static void fetch_slot(const narc_contacts *c, uint32_t slot) {
    const char *const row = narc_slot_row(c, slot), *const kept = (const char *)&c->kept[slot];
    FETCH_TO_WRITE(row);
    FETCH_TO_WRITE(row + c->row_size - 1);
    FETCH_TO_WRITE(&c->more_of[slot]);
    if (c->marks[slot] & NARC_KEEPS_NOTHING)
        return;
    FETCH_TO_WRITE(kept);
    FETCH_TO_WRITE(kept + sizeof *c->kept - 1);
}

/* Rows that were answered for pairs of a body. */
typedef struct body_rows {
    uint32_t body;
    size_t at, last, end; /* the next one, the end of those that are left of it, and of all */
} body_rows;

/* Merges the rows of the body of the planned pair `first`. What was asked and has no row before that is told so. */
static void merge_rows(const narc_contact_step *s, const narc_merging *rows, size_t first, body_rows *out) {
    narc_contacts *const c = s->contacts;
    const uint32_t *const bodies = s->list->pairs.a.base, body = bodies[c->work[first].pair];
    size_t at = out->end;
    for (size_t i = first; i < c->work_count && bodies[c->work[i].pair] == body; i++) {
        narc_pair_work *const work = &c->work[i];
        const size_t own = at;
        while (at < c->ground.count && pair_of(narc_row_at(c, c->ground.rows, at)) == work->pair)
            at++;
        if (work->what == NARC_ASK_GROUND && at == own)
            work->what = NARC_NO_GROUND;
    }
    out->body = body;
    out->at = out->end;
    out->last = rows->run.base && at > out->end + 1 ? narc_merge_body(rows, out->end, at) : at;
    out->end = at;
}

void narc_take_ground(const narc_contact_step *s) {
    enum { AHEAD = 8 };
    narc_contacts *const c = s->contacts;
    const narc_pairs pairs = narc_view_slots(c);
    const uint32_t *const bodies = s->list->pairs.a.base;
    const narc_merging merging = {.pairs = &s->list->pairs,
                                  .run = s->step->run,
                                  .shapes = s->shapes,
                                  .bodies = s->step->bodies,
                                  .contacts = c->contact_rows ? c->ground.rows : NULL,
                                  .manifolds = c->contact_rows ? NULL : c->ground.rows};
    const bool has_more = c->more.count > 0;
    body_rows rows = {UINT32_MAX, 0, 0, 0};
    size_t next = 0, bare_count = 0, keep_count = 0;
    uint32_t *const bare = c->left, *const keep = c->candidates; /* these have been seen to */
    if (c->ground_count == 0 && (!has_more || !c->changed))
        return;
    c->next_more.count = 0;
    for (size_t i = 0; i < c->work_count; i++) {
        const uint32_t k = c->work[i].pair, slot = c->work[i].slot;
        if (FETCHES && c->work_count - i > AHEAD)
            fetch_slot(c, c->work[i + AHEAD].slot);
        if (c->work[i].what != NARC_ASK_GROUND && c->work[i].what != NARC_NO_GROUND)
            continue;
        if (bodies[k] != rows.body)
            merge_rows(s, &merging, i, &rows);
        for (; has_more && next < k; next++)
            if (c->more_of[c->order[next]].count > 0)
                keep_more(c, c->order[next]);
        next = (size_t)k + 1;
        bare[bare_count] = slot;
        bare_count += c->work[i].what == NARC_NO_GROUND && c->flags[slot] & NARC_SLOT_SEEN;
        const size_t first = rows.at;
        rows.at = take_rows(s, &pairs, k, slot, first, rows.last);
        keep[keep_count] = slot;
        keep_count += rows.at > first;
    }
    for (; has_more && next < s->list->pairs.count; next++)
        if (c->more_of[c->order[next]].count > 0)
            keep_more(c, c->order[next]);
    const narc_row_array made = c->next_more;
    c->next_more = c->more;
    c->more = made;
    if (s->step->recycling > 0)
        narc_keep_rows(s, &pairs, keep, NULL, keep_count, c->rows, c->kept);
    narc_keep_bare_ground(s, &pairs, bare, bare_count);
}
