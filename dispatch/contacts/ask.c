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

/* Of bodies that were looked at in this step it is known that their shapes are there. */
narc_status narc_ask_pairs(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *selection, size_t count,
                           bool slots, void *rows, size_t capacity, size_t *out_count) {
    const narc_contacts *const c = s->contacts;
    const narc_bodies *const bodies = s->step->bodies;
    const bool all = !s->step->moved.base;
    narc_query query = make_query(s, slots ? c->margins : c->ground_margins, selection, count);
    narc_batch batch;
    query.dense = slots;
    query.hints = (narc_hint_column){slots ? c->hints : NULL, sizeof *c->hints};
    const narc_status status = all ? narc_fill_batch(s->shapes, bodies, pairs, &query, &batch, s->error)
                                   : narc_begin_batch(s->shapes, bodies, pairs, &query, &batch, s->error);
    return status != NARC_OK ? status
           : c->contact_rows ? narc_answer_contacts(&batch, rows, capacity, out_count, s->error)
                             : narc_answer_manifolds(&batch, rows, capacity, out_count, s->error);
}

/* ------------------------------------------------------------------------------------------------ parts */

/* Behind the pairs that are left of a part there is one that is none. */
static void run_part(void *argument, size_t part, size_t first, size_t end) {
    const narc_slot_job *const job = argument;
    uint32_t *const out = job->contacts->left + first;
    (void)part;
    const size_t left = job->work(job, first, end - first, out);
    if (left < end - first)
        out[left] = UINT32_MAX;
}

narc_status narc_run_slots(const narc_contact_step *s, const narc_pairs *pairs, const narc_query *query,
                           narc_slot_job *job, size_t *out_left) {
    narc_contacts *const c = s->contacts;
    const size_t count = query->selection_count;
    narc_batch batch;
    size_t left = 0;
    *out_left = 0;
    if (count == 0)
        return NARC_OK;
    narc_status status = narc_fill_batch(s->shapes, s->step->bodies, pairs, query, &batch, s->error);
    const narc_kernel_table *const kernels = narc_kernels(&status, s->error);
    if (status != NARC_OK)
        return status;
    batch.row_size = c->row_size;
    job->contacts = c;
    job->batch = &batch;
    job->kernels = NARC_KERNELS_FOR(count, kernels);
    narc_run_ranges(s->step->workers, count, NARC_SLOT_PART, run_part, job);
    for (size_t first = 0; first < count; first += NARC_SLOT_PART)
        for (size_t k = first; k < first + NARC_SLOT_PART && k < count && c->left[k] != UINT32_MAX; k++)
            c->left[left++] = c->left[k];
    *out_left = left;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ entries */

static size_t follow_part(const narc_slot_job *job, size_t first, size_t count, uint32_t *left) {
    const narc_contacts *const c = job->contacts;
    const narc_rows rows = {.base = c->rows, .stride = (ptrdiff_t)c->row_size};
    return job->kernels->follow(job->batch, first, count, c->entries, c->contact_rows ? NULL : c->ends, &rows, left);
}

/* ------------------------------------------------------------------------------------------------ rows */

/* Makes entries of the first slots in `left`. */
static void make_entries(const narc_contact_step *s, const narc_pairs *pairs, size_t count) {
    narc_contacts *const c = s->contacts;
    const narc_query query = make_query(s, c->margins, c->left, count);
    narc_batch batch;
    if (narc_fill_batch(s->shapes, s->step->bodies, pairs, &query, &batch, NULL) != NARC_OK)
        return;
    batch.row_size = c->row_size;
    for (size_t i = 0; i < count; i++)
        c->flags[c->left[i]] |= NARC_SLOT_ENTRY;
    narc_make_entries(&batch, 0, count, c->left, c->rows, (ptrdiff_t)c->row_size, c->entries,
                      c->contact_rows ? NULL : c->ends);
}

/* Some slots have been answered, most of which are of the kind `usual`: what touches now? Lists those of smooth shapes that
 * were asked before, as a pair that goes soon is not worth an entry, in `left`, and those whose row may be kept. Returns how
 * many the first are. */
static size_t note_answers(const narc_contact_step *s, const uint32_t *slots, size_t count, unsigned usual) {
    narc_contacts *const c = s->contacts;
    const size_t row_size = c->row_size;
    const bool contact_rows = c->contact_rows;
    const unsigned recycles = s->step->recycling > 0;
    const char *const rows = c->rows;
    uint8_t *const state = c->state, *const flags = c->flags;
    uint32_t *const candidates = c->candidates;
    size_t crossed = 0, again_count = 0, candidate_count = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = slots[i];
        const unsigned was = state[slot], touches = narc_count_points(contact_rows, rows + slot * row_size) > 0;
        const unsigned crosses = (was ^ touches) & NARC_TOUCHING;
        unsigned own = flags[slot] & ~(unsigned)NARC_SLOT_KEPT;
        state[slot] = (uint8_t)((was ^ crosses) | NARC_ASKED);
        if ((own & (NARC_SLOT_SEEN | NARC_SLOT_PLAIN | NARC_SLOT_ENTRY)) != usual) {
            if (own & NARC_SLOT_SEEN)
                c->left[again_count++] = slot;
            else if (!narc_are_smooth(s, c->a[slot], c->b[slot]))
                own |= NARC_SLOT_PLAIN;
            own |= NARC_SLOT_SEEN;
        }
        const unsigned keeps = touches & own / NARC_SLOT_PLAIN & recycles;
        flags[slot] = (uint8_t)((own ^ crosses * NARC_SLOT_CROSSED) | keeps * NARC_SLOT_KEPT);
        crossed += crosses;
        candidates[candidate_count] = slot; /* as chance has it: without a branch */
        candidate_count += keeps;
    }
    c->marked = c->marked || count > 0;
    c->crossed_count += crossed;
    c->candidate_count = candidate_count;
    return again_count;
}

narc_status narc_ask_contacts(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    const size_t plain_count = c->asked_count;
    const narc_query query = make_query(s, c->margins, c->known, c->known_count);
    narc_slot_job job = {.work = follow_part};
    size_t found = 0, left = 0;
    narc_status status = narc_run_slots(s, pairs, &query, &job, &left);
    for (size_t k = 0; k < left; k++)
        c->asked[c->asked_count++] = c->left[k];
    if (status == NARC_OK && c->asked_count > 0)
        status = narc_ask_pairs(s, pairs, c->asked, c->asked_count, true, c->rows, c->slot_capacity, &found);
    if (status != NARC_OK)
        return status;
    const bool fails = left > c->known_count / FEW;
    c->waits = !fails ? 0 : c->waits == 0 ? 1 : c->waits < MOST_STEPS ? 2 * c->waits : MOST_STEPS;
    c->wait = fails ? c->waits : c->wait > 0 ? c->wait - 1 : 0;
    note_answers(s, c->known, c->known_count, NARC_SLOT_SEEN | NARC_SLOT_ENTRY);
    size_t count = note_answers(s, c->asked, plain_count, NARC_SLOT_SEEN | NARC_SLOT_PLAIN);
    for (size_t i = plain_count; i < c->asked_count; i++)
        c->left[count++] = c->asked[i];
    c->asked_count = plain_count; /* the others are among the known ones */
    if (count > 0 && c->wait == 0)
        make_entries(s, pairs, count);
    return narc_keep_rows(s, pairs, c->candidates, NULL, c->candidate_count, c->rows, c->kept);
}
