/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that are kept while their bodies have hardly moved against each other, and follow them
 * (kernels/sat/recycle.c).
 */
#include "contacts.h"

/* Rows of kept[...] and rows[...] that pairs have: item[i] is that of the pair that is listed at i; `item` NULL: the
 * pair's own. */
typedef struct row_job {
    narc_slot_job job;
    const narc_contact_step *step;
    const uint32_t *item;
    void *rows;
    narc_kept_row *kept;
} row_job;

static size_t keep_part(const narc_slot_job *job, size_t first, size_t count, uint32_t *left) {
    const row_job *const r = (const row_job *)job;
    const narc_rows rows = {.base = r->rows, .stride = (ptrdiff_t)job->batch->row_size};
    (void)left;
    job->kernels->keep(job->batch, first, count, r->item ? r->item + first : NULL, &rows, r->kept);
    return 0;
}

static size_t recycle_part(const narc_slot_job *job, size_t first, size_t count, uint32_t *left) {
    const row_job *const r = (const row_job *)job;
    const narc_rows rows = {.base = r->rows, .stride = (ptrdiff_t)job->batch->row_size};
    return job->kernels->recycle(job->batch, first, count, r->item ? r->item + first : NULL, r->kept,
                                 r->step->step->recycling, r->rows ? &rows : NULL, left);
}

static narc_status run_rows(const narc_contact_step *s, narc_slot_work *work, const narc_pairs *pairs,
                            const uint32_t *list, const uint32_t *item, size_t count, void *rows, narc_kept_row *kept,
                            size_t *out_left) {
    const narc_query query = {.selection = {list, sizeof *list}, .selection_count = count};
    row_job job = {{.work = work}, s, item, rows, kept};
    return narc_run_slots(s, pairs, &query, &job.job, out_left);
}

narc_status narc_keep_rows(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots,
                           const uint32_t *item, size_t count, void *rows, narc_kept_row *kept) {
    size_t left;
    return run_rows(s, keep_part, pairs, slots, item, s->step->recycling > 0 ? count : 0, rows, kept, &left);
}

bool narc_may_follow(const narc_contact_step *s, uint32_t pair, uint32_t item, narc_kept_row *kept) {
    size_t left;
    return run_rows(s, recycle_part, &s->list->pairs, &pair, &item, 1, NULL, kept, &left) == NARC_OK && left == 0;
}

narc_status narc_follow_rows(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    const uint32_t *const candidates = c->candidates, *const left = c->left;
    uint32_t *asked = c->asked + c->asked_count;
    uint8_t *const state = c->state;
    const size_t count = c->candidate_count;
    size_t left_count, at = 0;
    narc_status status = run_rows(s, recycle_part, pairs, candidates, NULL, count, c->rows, c->kept, &left_count);
    for (size_t k = 0; k < count && status == NARC_OK; k++) {
        const uint32_t slot = candidates[k];
        const unsigned is_left = at < left_count && left[at] == slot;
        *asked = slot; /* as chance has it: without a branch */
        asked += is_left;
        at += is_left;
        state[slot] |= (uint8_t)(is_left ? 0 : NARC_FOLLOWED);
    }
    c->asked_count = (size_t)(asked - c->asked);
    c->marked = c->marked || count > 0;
    /* The further rows of pairs of ground may follow, too, as it was found out before. */
    for (size_t k = 0; k < count && c->more.count > 0 && status == NARC_OK; k++) {
        const uint32_t slot = candidates[k];
        const narc_more_rows more = c->more_of[slot];
        for (uint32_t i = more.first; i < more.first + more.count && state[slot] & NARC_FOLLOWED; i++)
            status = run_rows(s, recycle_part, pairs, &slot, &i, 1, c->more.rows, c->more.kept, &left_count);
    }
    return status;
}
