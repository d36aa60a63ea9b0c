/* SPDX-License-Identifier: MIT
 *
 * ask.c - rows of slots: from what was kept of pairs of smooth shapes, or by the plain calls, after which something is kept.
 */
#include "column.h"
#include "contacts.h"
#include "dispatch.h"
#include "entries.h"
#include "narc.h"

/* If more than one in FEW of the entries decided nothing, bodies move too far for them: none is made for a while, and then
 * for twice as long each time, up to MOST_STEPS. */
enum { FEW = 5, MOST_STEPS = 16 };

static narc_query make_query(const narc_contact_step *s, const float *margins, const uint32_t *selection,
                             size_t count) {
    const narc_step *const step = s->step;
    return (narc_query){.margin = step->margin,
                        .second_margin = step->second_margin,
                        .flat_angle = step->flat_angle,
                        .front_only = step->front_only,
                        .margins = {step->ahead.base ? margins : NULL, sizeof *margins},
                        .selection = {selection, sizeof *selection},
                        .selection_count = count,
                        .workers = step->workers};
}

narc_status narc_ask_pairs(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *selection, size_t count,
                           bool slots, void *rows, size_t capacity, size_t *out_count) {
    const narc_contacts *const c = s->contacts;
    const narc_bodies *const bodies = s->step->bodies;
    narc_query query = make_query(s, slots ? c->margins : c->ground_margins, selection, count);
    query.dense = slots;
    return c->contact_rows ? narc_find_contacts(s->shapes, bodies, pairs, &query, rows, capacity, out_count, s->error)
                           : narc_find_manifolds(s->shapes, bodies, pairs, &query, rows, capacity, out_count, s->error);
}

/* ------------------------------------------------------------------------------------------------ entries */

typedef struct known_job {
    const narc_contacts *contacts;
    const narc_batch *batch;
    const narc_kernel_table *kernels;
} known_job;

/* Behind the pairs that are left of a part there is one that is none. */
static void follow_part(void *argument, size_t part, size_t first, size_t end) {
    const known_job *const job = argument;
    const narc_contacts *const c = job->contacts;
    const narc_rows rows = {.base = c->rows, .stride = (ptrdiff_t)c->row_size};
    (void)part;
    const size_t left = job->kernels->follow(job->batch, first, end - first, c->entries,
                                             c->contact_rows ? NULL : c->ends, &rows, c->left + first);
    if (left < end - first)
        c->left[first + left] = UINT32_MAX;
}

/* Answers pairs whose entries are known; those that are left join `asked`. Returns how many these are. */
static size_t follow_known(const narc_contact_step *s, const narc_batch *batch) {
    narc_contacts *const c = s->contacts;
    narc_status status = NARC_OK;
    known_job job = {c, batch, narc_kernels(&status, NULL)};
    const size_t before = c->asked_count;
    narc_run_ranges(s->step->workers, c->known_count, NARC_SLOT_PART, follow_part, &job);
    for (size_t first = 0; first < c->known_count; first += NARC_SLOT_PART)
        for (size_t k = first; k < first + NARC_SLOT_PART && k < c->known_count && c->left[k] != UINT32_MAX; k++)
            c->asked[c->asked_count++] = c->left[k];
    return c->asked_count - before;
}

/* Makes entries of pairs that were asked: of smooth ones that are asked for the second time, as a pair that goes soon is not
 * worth it, and of those that their entries left, which stand behind the first `plain_count`. */
static void make_entries(const narc_contact_step *s, const narc_batch *batch, size_t plain_count) {
    narc_contacts *const c = s->contacts;
    size_t count = 0;
    for (size_t i = 0; i < c->asked_count; i++) {
        const uint32_t slot = c->asked[i];
        const unsigned flags = c->flags[slot];
        const bool again = i < plain_count && (flags & (NARC_SLOT_SEEN | NARC_SLOT_PLAIN)) == NARC_SLOT_SEEN;
        c->flags[slot] |= NARC_SLOT_SEEN;
        if (i < plain_count && !again)
            continue;
        const bool smooth = !again || narc_are_smooth(s, c->a[slot], c->b[slot]);
        c->flags[slot] |= smooth ? NARC_SLOT_ENTRY : NARC_SLOT_PLAIN;
        c->left[count] = slot;
        count += smooth;
    }
    if (count > 0)
        narc_make_entries(batch, 0, count, c->left, c->rows, (ptrdiff_t)c->row_size, c->entries,
                          c->contact_rows ? NULL : c->ends);
}

/* ------------------------------------------------------------------------------------------------ rows */

/* Some slots have been answered: what touches now? */
static void mark_answered(narc_contacts *c, const uint32_t *slots, size_t count) {
    const size_t row_size = c->row_size;
    const bool contact_rows = c->contact_rows;
    const char *const rows = c->rows;
    uint8_t *const state = c->state, *const flags = c->flags;
    uint32_t *const marked = c->marked;
    size_t crossed = 0, marked_count = c->marked_count;
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = slots[i];
        const unsigned was = state[slot];
        const unsigned now = narc_count_points(contact_rows, rows + slot * row_size) > 0 ? NARC_TOUCHING : 0;
        const unsigned crosses = (was ^ now) & NARC_TOUCHING;
        marked[marked_count] = slot;
        marked_count += !(was & ~(unsigned)NARC_TOUCHING);
        state[slot] = (uint8_t)((was ^ crosses) | NARC_ASKED);
        flags[slot] = (uint8_t)(flags[slot] ^ crosses * NARC_SLOT_CROSSED);
        crossed += crosses;
    }
    c->marked_count = marked_count;
    c->crossed_count += crossed;
}

/* Rows with an edge that were asked for are kept to follow their bodies. */
static void keep_rows(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    for (size_t i = 0; i < c->asked_count; i++) {
        const uint32_t slot = c->asked[i];
        const uint32_t a = c->a[slot], b = c->b[slot];
        c->flags[slot] &= (uint8_t)~NARC_SLOT_KEPT;
        if (!(c->state[slot] & NARC_TOUCHING) || narc_are_smooth(s, a, b))
            continue;
        narc_keep_row(s, a, b, narc_row_at(c, c->rows, slot), &c->kept[slot]);
        c->flags[slot] |= NARC_SLOT_KEPT;
    }
}

narc_status narc_ask_contacts(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    const size_t plain_count = c->asked_count;
    const narc_query query = make_query(s, c->margins, c->known_count ? c->known : c->asked,
                                        c->known_count ? c->known_count : c->asked_count);
    narc_batch batch;
    size_t found = 0, left = 0;
    if (plain_count + c->known_count == 0)
        return NARC_OK;
    narc_status status = narc_begin_batch(s->shapes, s->step->bodies, pairs, &query, &batch, s->error);
    if (status != NARC_OK)
        return status;
    batch.row_size = c->row_size;
    if (c->known_count > 0)
        left = follow_known(s, &batch);
    if (c->asked_count > 0)
        status = narc_ask_pairs(s, pairs, c->asked, c->asked_count, true, c->rows, c->slot_capacity, &found);
    if (status != NARC_OK)
        return status;
    const bool fails = left > c->known_count / FEW;
    c->waits = !fails ? 0 : c->waits == 0 ? 1 : c->waits < MOST_STEPS ? 2 * c->waits : MOST_STEPS;
    c->wait = fails ? c->waits : c->wait > 0 ? c->wait - 1 : 0;
    if (c->wait == 0)
        make_entries(s, &batch, plain_count);
    mark_answered(c, c->known, c->known_count);
    mark_answered(c, c->asked, plain_count);
    if (s->step->recycling > 0)
        keep_rows(s);
    c->asked_count = plain_count; /* the others are among the known ones */
    return NARC_OK;
}
