/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that are kept while their bodies have hardly moved against each other, and follow them
 * (kernels/sat/recycle.c).
 */
#include "contacts.h"
#include "dispatch.h"

void narc_keep_rows(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, const uint32_t *item,
                    size_t count, void *to, narc_kept_row *kept) {
    const narc_query query = {.selection = {slots, sizeof *slots}, .selection_count = count};
    const narc_rows rows = narc_view_rows(s->contacts, to);
    narc_batch batch;
    if (count == 0 || !(s->step->recycling > 0))
        return;
    const narc_kernel_table *const kernels = narc_fill_slots(s, pairs, &query, &batch);
    if (kernels)
        kernels->keep(&batch, 0, count, item, &rows, kept);
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
