/* SPDX-License-Identifier: MIT
 *
 * contacts.h - what a narc_contacts keeps, and the steps of narc_update_contacts(). Internal.
 *
 *     update.c   the call: pairs, what of them is to be asked, rows, lists
 *     slots.c    memory, and which slot belongs to which pair
 *     plan.c     what is to be done with each pair
 *     ask.c      rows of pairs that are asked; entries.c makes what answers smooth ones again
 *     ground.c   bodies on pieces of chains, whose rows are asked for and merged together
 *     recycle.c  rows that follow their bodies
 */
#ifndef NARC_CONTACTS_INTERNAL_H
#define NARC_CONTACTS_INTERNAL_H

#include "broad_phase.h"
#include "kernels.h"
#include "narc_contacts.h"

/* What one slot is, beside its state: bits. */
enum {
    NARC_SLOT_STALE = 1,
    NARC_SLOT_SENSOR = 2,
    NARC_SLOT_CROSSED = 4, /* began or ended to touch in this step */
    NARC_SLOT_KEPT = 8,    /* `kept` counts */
    NARC_SLOT_ENTRY = 16,  /* `entries` does, which answers the pair again */
    NARC_SLOT_SEEN = 32,   /* it was asked before */
    NARC_SLOT_PLAIN = 64   /* not both are smooth: it has no entry */
};

/* Rows beyond the first of a slot: a range of `more`. */
typedef struct narc_more_rows {
    uint32_t first, count;
} narc_more_rows;

/* What a step does with a pair of the list whose bodies are others than in the last step. REST: nothing, as neither moves;
 * it is asked when one does. ASK_GROUND: of all ground that one body is near. APART: there is no row, by the boxes. */
enum { NARC_REST, NARC_ASK, NARC_ASK_GROUND, NARC_ASK_SENSOR, NARC_FOLLOW, NARC_APART, NARC_WHAT = 7 };

/* Slots that a thread takes at a time: some 10 microseconds of work. */
enum { NARC_SLOT_PART = 1024 };

/* Besides: a body has another shape or scale, so that nothing that was kept of the pair counts. */
enum { NARC_OTHER_SHAPE = 8 };

typedef struct narc_pair_work {
    uint32_t pair; /* of the list */
    uint32_t what;
} narc_pair_work;

/* Rows that several pairs of one body have. */
typedef struct narc_row_array {
    void *rows;
    narc_kept_row *kept;
    size_t count, capacity;
} narc_row_array;

struct narc_contacts {
    narc_allocator allocator;
    bool contact_rows;
    size_t row_size, user_size;
    narc_broad_phase *broad;
    narc_step_result result;
    narc_step last_step; /* its numbers alone count */
    bool again;          /* all pairs are to be asked: they are asked differently */

    size_t slot_capacity, slot_count; /* slots that were ever in use are the first slot_count */
    uint32_t *a, *b;                  /* the pair's bodies */
    uint8_t *state, *flags;
    uint32_t *free, *marked, *parted; /* `free` and so on: lists of slots */
    float *margins;                   /* that it was asked with */
    void *rows, *user;
    narc_kept_row *kept;
    narc_entry *entries;
    narc_entry_ends *ends; /* of manifolds */
    narc_more_rows *more_of;
    size_t free_count, end_capacity;

    size_t order_capacity; /* of pairs: */
    uint32_t *order, *next_order;
    narc_pair_work *work;           /* what is to be done in this step, in the order of pairs */
    uint32_t *asked, *known, *left; /* slots: asked plainly, by their entries, and what these do not decide */
    uint32_t *candidates;           /* slots whose rows may follow */
    uint32_t *sensors_asked, *ground_asked, *touching, *sensors;
    float *ground_margins;
    uint64_t *bits;
    narc_touch_event *began, *ended;
    size_t work_count, asked_count, known_count, candidate_count, sensor_count, ground_count, marked_count,
        parted_count, crossed_count;

    unsigned wait, waits; /* so many steps no entry is made; so many it was the last time */

    size_t body_capacity;
    float *room; /* of each body: what its separations may be off by */

    narc_row_array more, next_more, ground; /* `ground`: as they were answered */
};

/* What a step works with. */
typedef struct narc_contact_step {
    narc_contacts *contacts;
    const narc_shapes *shapes;
    const narc_step *step;
    const narc_pair_list *list;
    narc_error *error;
    bool has_ground;
} narc_contact_step;

/* Slots as pairs of a batch. */
static inline narc_pairs narc_view_slots(const narc_contacts *c) {
    return (narc_pairs){.count = c->slot_count, .a = {c->a, sizeof *c->a}, .b = {c->b, sizeof *c->b}};
}

/* ------------------------------------------------------------------------------------------------ slots.c */

/* Room for a list of pairs and its slots, and for bodies; what is known of slots stays. NARC_ERROR_MEMORY: all is as it
 * was. */
narc_status narc_reserve_slots(narc_contacts *contacts, const narc_pair_list *list, size_t bodies);

/* Room for so many rows in an array; those there are stay. */
narc_status narc_reserve_row_array(narc_contacts *contacts, narc_row_array *rows, size_t count);

/* Gives each pair of a new list its slot, and those that are gone back at the next call. */
void narc_take_slots(narc_contacts *contacts, const narc_pair_list *list);

void narc_free_slots(narc_contacts *contacts);

/* Gives a slot a mark of this step: any bit of `state` but NARC_TOUCHING. */
static inline void narc_mark_slot(narc_contacts *c, uint32_t slot, unsigned mark) {
    if (!(c->state[slot] & ~NARC_TOUCHING))
        c->marked[c->marked_count++] = slot;
    c->state[slot] |= (uint8_t)mark;
}

/* Tells whether a slot touches now. A sensor's row may go, and it touches still. */
static inline void narc_set_touching(narc_contacts *c, uint32_t slot, bool touches) {
    if (touches == (c->state[slot] & NARC_TOUCHING))
        return;
    c->state[slot] ^= NARC_TOUCHING;
    c->flags[slot] ^= NARC_SLOT_CROSSED;
    c->crossed_count++;
}

/* How many points a row has. */
static inline uint32_t narc_count_points(bool contact_rows, const void *row) {
    return contact_rows ? ((const narc_contact *)row)->count : ((const narc_manifold *)row)->count;
}

static inline void *narc_row_at(const narc_contacts *c, void *rows, size_t k) { return (char *)rows + k * c->row_size; }

/* ------------------------------------------------------------------------------------------------ recycle.c */

/* Keeps a row with `count` points of two bodies. */
void narc_keep_row(const narc_contact_step *s, uint32_t a, uint32_t b, const void *row, narc_kept_row *kept);

/* May `count` rows of pairs `pair` of the list follow their bodies? Row i is that of kept[item[i]]. */
bool narc_may_follow(const narc_contact_step *s, const uint32_t *pair, const uint32_t *item, size_t count,
                     const narc_kept_row *kept);

/* Lets the rows of slots that are listed in `candidates` follow, and all that they have in `more`; those that may not join
 * `asked`. */
narc_status narc_follow_rows(const narc_contact_step *s, const narc_pairs *pairs);

/* ------------------------------------------------------------------------------------------------ plan.c */

/* Lists what is to be done, as far as pairs are concerned; changes nothing that a result shows. */
void narc_plan_step(const narc_contact_step *s);

/* The margin of a pair. */
float narc_find_margin(const narc_contact_step *s, uint32_t a, uint32_t b);

/* Both n-arcs: to ask anew costs no more than to follow. */
bool narc_are_smooth(const narc_contact_step *s, uint32_t a, uint32_t b);

/* Does one of both move? */
bool narc_is_tested(const narc_contact_step *s, uint32_t a, uint32_t b);

/* Is one of two bodies a piece of a chain, or B said to be of a run? */
bool narc_is_ground_pair(const narc_contact_step *s, uint32_t a, uint32_t b);

/* ------------------------------------------------------------------------------------------------ ground.c */

/* Asks what is planned of ground, into contacts->ground, merged; changes nothing that a result shows. */
narc_status narc_ask_ground(const narc_contact_step *s);

/* Puts these rows into their slots, and those that are further ones of their pairs into contacts->more, with all that stay
 * from before. */
void narc_take_ground(const narc_contact_step *s);

/* ------------------------------------------------------------------------------------------------ ask.c */

/* Rows of the slots in `asked` and `known`; which are written then, and what touches. */
narc_status narc_ask_contacts(const narc_contact_step *s, const narc_pairs *pairs);

/* Asks some pairs as the step says. `slots`: rows are dense, those of slots. */
narc_status narc_ask_pairs(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *selection, size_t count,
                           bool slots, void *rows, size_t capacity, size_t *out_count);

#endif
