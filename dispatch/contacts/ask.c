/* SPDX-License-Identifier: MIT
 *
 * ask.c - rows of slots: those that follow their bodies, from what was kept of pairs of smooth shapes, or by the plain
 * calls, after which something is kept. Workers take parts of slots, whose rows stay in the cache meanwhile.
 */
#include "column.h"
#include "contacts.h"
#include "dispatch.h"
#include "entries.h"
#include "narc.h"

#include <stdatomic.h>

/* If more than one in FEW of the entries decided nothing, bodies move too far for them: none is made for a while, and then
 * for twice as long each time, up to MOST_STEPS. */
enum { FEW = 5, MOST_STEPS = 16 };

/* What is asked of the first `count` pairs of a list, as the step says; `margins`: of each pair. */
static narc_query make_query(const narc_contact_step *s, const float *margins, const uint32_t *list, size_t count) {
    const narc_step *const step = s->step;
    return (narc_query){.margin = step->margin,
                        .second_margin = step->second_margin,
                        .flat_angle = step->flat_angle,
                        .front_only = step->front_only,
                        .margins = {step->ahead.base ? margins : NULL, sizeof *margins},
                        .selection = {list, sizeof *list},
                        .selection_count = count,
                        .workers = step->workers};
}

static narc_status answer(const narc_contact_step *s, narc_batch *batch, void *rows, size_t capacity,
                          size_t *out_count) {
    return s->contacts->contact_rows ? narc_answer_contacts(batch, rows, capacity, out_count, s->error)
                                     : narc_answer_manifolds(batch, rows, capacity, out_count, s->error);
}

/* One thread takes a group of pairs at a time, so that what is checked is in the cache when it is asked. */
narc_status narc_ask_pairs(const narc_contact_step *s, const uint32_t *list, size_t count, void *rows, size_t capacity,
                           size_t *out_count) {
    narc_query query = make_query(s, s->contacts->ground_margins, list, count);
    const size_t part = narc_count_workers(query.workers, 2) > 1 ? count : NARC_ROW_GROUP;
    narc_status status = NARC_OK;
    size_t found = 0;
    for (; query.first < count && (status == NARC_OK || status == NARC_ERROR_CAPACITY); query.first += part) {
        const size_t listed = found < capacity ? found : capacity;
        size_t own = 0;
        narc_batch batch;
        query.count = count - query.first < part ? count - query.first : part;
        status = narc_begin_batch(s->shapes, s->step->bodies, &s->list->pairs, &query, &batch, s->error);
        if (status == NARC_OK)
            status = answer(s, &batch, narc_row_at(s->contacts, rows, listed), capacity - listed, &own);
        found += own;
    }
    *out_count = found;
    return status == NARC_OK && found > capacity ? NARC_ERROR_CAPACITY : status;
}

const narc_kernel_table *narc_fill_slots(const narc_contact_step *s, const narc_pairs *pairs, const narc_query *query,
                                         narc_batch *out) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    if (!kernels || narc_fill_batch(s->shapes, s->step->bodies, pairs, query, out, NULL) != NARC_OK)
        return NULL;
    out->row_size = s->contacts->row_size;
    return NARC_KERNELS_FOR(query->selection_count, kernels);
}

/* ------------------------------------------------------------------------------------------------ parts */

/* What is done with the slots of a list, part by part. Of each it lists the slots that it leaves, and returns how many. */
typedef struct slot_job slot_job;
struct slot_job {
    size_t (*run)(slot_job *job, const uint32_t *list, size_t count, uint32_t *left);
    const narc_contact_step *step;
    const narc_pairs *pairs;
    const uint32_t *list;
    atomic_size_t crossed; /* so many began or ended to touch */
};

/* Behind the slots that are left of a part there is one that is none. */
static void run_part(void *argument, size_t part, size_t first, size_t end) {
    slot_job *const job = argument;
    uint32_t *const out = job->step->contacts->left + first;
    (void)part;
    const size_t left = job->run(job, job->list + first, end - first, out);
    if (left < end - first)
        out[left] = UINT32_MAX;
}

/* All slots of a list; gathers those that are left in contacts->left, in their order, and returns how many these are. */
static size_t run_slots(slot_job *job, const uint32_t *list, size_t count) {
    narc_contacts *const c = job->step->contacts;
    size_t left = 0;
    job->list = list;
    atomic_init(&job->crossed, 0);
    narc_run_ranges(job->step->step->workers, count, NARC_SLOT_PART, run_part, job);
    for (size_t first = 0; first < count; first += NARC_SLOT_PART)
        for (size_t k = first; k < first + NARC_SLOT_PART && k < count && c->left[k] != UINT32_MAX; k++)
            c->left[left++] = c->left[k];
    c->crossed_count += atomic_load(&job->crossed);
    c->marked = c->marked || count > 0;
    return left;
}

/* Some slots have been answered, most of which are of the kind `usual`: what touches now? Lists those that touch and may be
 * kept, and in `again` those that are to have an entry: of smooth shapes, if they were asked before, as a pair that goes
 * soon is not worth one. Returns how many these are. Those of others that were asked before and have no row are listed at
 * the end of `keep`, which has room for all. */
static size_t note_answers(slot_job *job, const uint32_t *slots, size_t count, unsigned usual, uint32_t *again,
                           uint32_t *keep, size_t *out_keep_count, size_t *out_bare_count) {
    const narc_contact_step *const s = job->step;
    const narc_contacts *const c = s->contacts;
    const size_t row_stride = c->row_stride;
    const bool contact_rows = c->contact_rows;
    const unsigned plain = usual & NARC_SLOT_PLAIN ? 1 : 0, recycles = s->step->recycling > 0;
    const char *const rows = c->rows;
    uint8_t *const state = c->state, *const flags = c->flags;
    uint32_t *const kept = keep, *bare = keep + count;
    size_t crossed = 0, again_count = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = slots[i];
        const unsigned was = state[slot], touches = narc_count_points(contact_rows, rows + slot * row_stride) > 0;
        const unsigned crosses = (was ^ touches) & NARC_TOUCHING;
        const unsigned before = flags[slot], kind = NARC_SLOT_SEEN | NARC_SLOT_PLAIN | NARC_SLOT_ENTRY;
        state[slot] = (uint8_t)((was ^ crosses) | NARC_ASKED);
        if ((before & (kind | NARC_SLOT_KEPT)) == usual && !(crosses | (plain & (recycles | !touches))))
            continue;
        unsigned own = before & (0xffu - NARC_SLOT_KEPT);
        if ((own & kind) != usual) {
            if (own & NARC_SLOT_SEEN)
                again[again_count++] = slot;
            else if (!narc_are_smooth(s, c->a[slot], c->b[slot]))
                own |= NARC_SLOT_PLAIN;
            own |= NARC_SLOT_SEEN;
        }
        const unsigned keeps = touches & own / NARC_SLOT_PLAIN & recycles;
        if (!touches && own & NARC_SLOT_PLAIN && before & NARC_SLOT_SEEN)
            *--bare = slot;
        flags[slot] = (uint8_t)((own ^ crosses * NARC_SLOT_CROSSED) | keeps * NARC_SLOT_KEPT);
        crossed += crosses;
        *keep = slot; /* as chance has it: without a branch */
        keep += keeps;
    }
    *out_keep_count = (size_t)(keep - kept);
    *out_bare_count = (size_t)(kept + count - bare);
    atomic_fetch_add_explicit(&job->crossed, crossed, memory_order_relaxed);
    return again_count;
}

/* ------------------------------------------------------------------------------------------------ what is done */

/* Lets the rows of slots follow their bodies. */
static size_t recycle_slots(slot_job *job, const uint32_t *list, size_t count, uint32_t *left) {
    const narc_contact_step *const s = job->step;
    const narc_contacts *const c = s->contacts;
    const narc_query query = make_query(s, c->margins, list, count);
    const narc_rows rows = narc_view_rows(c, c->rows);
    uint8_t *const state = c->state;
    narc_batch batch;
    const narc_kernel_table *const kernels = narc_fill_slots(s, job->pairs, &query, &batch);
    if (!kernels)
        return 0;
    const size_t left_count = kernels->recycle(&batch, 0, count, NULL, c->kept, s->step->recycling, &rows, left);
    for (size_t i = 0; i < count; i++)
        state[list[i]] |= (uint8_t)(state[list[i]] & NARC_TOUCHING) * NARC_FOLLOWED;
    for (size_t i = 0; i < left_count; i++)
        state[left[i]] &= (uint8_t)~NARC_FOLLOWED;
    return left_count;
}

/* Pairs of the list, whose slots are listed in `known`: which have moved too far for what is kept of them? */
static size_t find_moved(slot_job *job, const uint32_t *list, size_t count, uint32_t *left) {
    const narc_contact_step *const s = job->step;
    const narc_contacts *const c = s->contacts;
    const narc_query query = make_query(s, c->ground_margins, list, count);
    const uint32_t *const slots = c->known + (list - c->ground_asked);
    narc_batch batch;
    const narc_kernel_table *const kernels = narc_fill_slots(s, job->pairs, &query, &batch);
    return kernels ? kernels->recycle(&batch, 0, count, slots, c->kept, s->step->recycling, NULL, left) : 0;
}

size_t narc_find_moved(const narc_contact_step *s, size_t count) {
    slot_job job = {.run = find_moved, .step = s, .pairs = &s->list->pairs};
    return run_slots(&job, s->contacts->ground_asked, count);
}

/* Answers slots from their entries. */
static size_t follow_slots(slot_job *job, const uint32_t *list, size_t count, uint32_t *left) {
    const narc_contact_step *const s = job->step;
    const narc_contacts *const c = s->contacts;
    const narc_query query = make_query(s, c->margins, list, count);
    const narc_rows rows = narc_view_rows(c, c->rows);
    narc_batch batch;
    size_t kept, bare;
    const narc_kernel_table *const kernels = narc_fill_slots(s, job->pairs, &query, &batch);
    if (!kernels)
        return 0;
    const size_t left_count =
        kernels->follow(&batch, 0, count, c->entries, c->contact_rows ? NULL : c->ends, &rows, left);
    note_answers(job, list, count, NARC_SLOT_SEEN | NARC_SLOT_ENTRY, left, c->candidates + (list - c->known), &kept,
                 &bare);
    return left_count;
}

/* Asks slots, and keeps their rows. What is left is to have an entry. */
static size_t ask_slots(slot_job *job, const uint32_t *list, size_t count, uint32_t *again) {
    const narc_contact_step *const s = job->step;
    const narc_contacts *const c = s->contacts;
    uint32_t *const keep = c->candidates + (list - c->asked); /* these have been seen to */
    narc_query query = make_query(s, c->margins, list, count);
    narc_batch batch;
    size_t found, keep_count, bare_count;
    query.dense = 1;
    query.row_stride = (ptrdiff_t)c->row_stride;
    if (!narc_fill_slots(s, job->pairs, &query, &batch) ||
        answer(s, &batch, c->rows, c->slot_capacity, &found) != NARC_OK)
        return 0;
    const size_t left =
        note_answers(job, list, count, NARC_SLOT_SEEN | NARC_SLOT_PLAIN, again, keep, &keep_count, &bare_count);
    narc_keep_rows(s, job->pairs, keep, NULL, keep_count, c->rows, c->kept);
    narc_keep_bare(s, job->pairs, keep + count - bare_count, bare_count);
    return left;
}

/* Makes entries of the first slots in `left`. */
static void make_entries(const narc_contact_step *s, const narc_pairs *pairs, size_t count) {
    narc_contacts *const c = s->contacts;
    const narc_query query = make_query(s, c->margins, c->left, count);
    narc_batch batch;
    if (count == 0 || !narc_fill_slots(s, pairs, &query, &batch))
        return;
    for (size_t i = 0; i < count; i++)
        c->flags[c->left[i]] |= NARC_SLOT_ENTRY;
    narc_make_entries(&batch, 0, count, c->left, c->rows, (ptrdiff_t)c->row_stride, c->entries,
                      c->contact_rows ? NULL : c->ends);
}

/* Slots that are left are asked. */
static size_t ask_left(narc_contacts *c, size_t left) {
    for (size_t k = 0; k < left; k++)
        c->asked[c->asked_count++] = c->left[k];
    return left;
}

narc_status narc_ask_contacts(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    narc_status status = NARC_OK;
    slot_job job = {.run = recycle_slots, .step = s, .pairs = pairs};
    ask_left(c, run_slots(&job, c->candidates, c->candidate_count));
    for (size_t k = 0; k < c->candidate_count && c->more.count > 0; k++)
        if (c->state[c->candidates[k]] & NARC_FOLLOWED)
            narc_follow_more(s, pairs, c->candidates[k]);
    const size_t plain_count = c->asked_count;
    job.run = follow_slots;
    const size_t left = ask_left(c, run_slots(&job, c->known, c->known_count));
    const narc_query query = make_query(s, c->margins, c->asked, c->asked_count);
    narc_batch batch;
    if (s->step->moved.base || s->step->moved.stride) /* bodies that were not looked at may have any shape */
        status = narc_begin_batch(s->shapes, s->step->bodies, pairs, &query, &batch, s->error);
    if (status != NARC_OK)
        return status;
    job.run = ask_slots;
    const size_t again = run_slots(&job, c->asked, c->asked_count);
    const bool fails = left > c->known_count / FEW;
    c->waits = !fails ? 0 : c->waits == 0 ? 1 : c->waits < MOST_STEPS ? 2 * c->waits : MOST_STEPS;
    c->wait = fails ? c->waits : c->wait > 0 ? c->wait - 1 : 0;
    if (c->wait == 0)
        make_entries(s, pairs, again);
    c->asked_count = plain_count; /* the others are among the known ones */
    return NARC_OK;
}
