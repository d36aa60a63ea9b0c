/* SPDX-License-Identifier: MIT
 *
 * contacts.h - what a narc_contacts keeps, and the steps of narc_update_contacts(). Internal.
 *
 *     update.c   the call: pairs, what of them is to be asked, rows, lists
 *     slots.c    memory, and which slot belongs to which pair
 *     plan.c     what is to be done with each pair
 *     ask.c      rows of pairs that follow or are asked; entries.c makes what answers smooth ones again
 *     ground.c   bodies on pieces of chains, whose rows are asked for and merged together
 *     recycle.c  single rows that are kept, and follow their bodies
 *     save.c     all of it as bytes
 */
#ifndef NARC_CONTACTS_INTERNAL_H
#define NARC_CONTACTS_INTERNAL_H

#include "broad_phase.h"
#include "kernels.h"
#include "narc_contacts.h"

#include <string.h>

/* What one slot is, beside its state: bits. */
enum {
    NARC_SLOT_STALE = 1,
    NARC_SLOT_CROSSED = 2, /* began or ended to touch in this step */
    NARC_SLOT_SENSOR = NARC_SENSOR,
    NARC_SLOT_KEPT = 8,   /* `kept` counts */
    NARC_SLOT_ENTRY = 16, /* `entries` does, which answers the pair again */
    NARC_SLOT_SEEN = 32,  /* it was asked before */
    NARC_SLOT_PLAIN = 64  /* not both are smooth: it has no entry, but may have a kept row */
};

/* Rows beyond the first of a slot: a range of `more`. */
typedef struct narc_more_rows {
    uint32_t first, count;
} narc_more_rows;

/* What a step does with a pair of the list whose bodies are others than in the last step. REST: nothing, as neither moves;
 * it is asked when one does. ASK_GROUND: of all ground that one body is near; NO_GROUND: so, and it has no row by itself.
 * APART: there is no row, by the boxes. */
enum { NARC_NOTHING, NARC_REST, NARC_ASK, NARC_ASK_GROUND, NARC_NO_GROUND, NARC_ASK_SENSOR, NARC_FOLLOW, NARC_APART };

/* Slots that a thread takes at a time: some 10 microseconds of work. */
enum { NARC_SLOT_PART = 1024 };

typedef struct narc_pair_work {
    uint32_t pair; /* of the list */
    uint32_t slot; /* NARC_NO_MATCH while a new pair has none */
    uint32_t what;
} narc_pair_work;

/* Rows that several pairs of one body have. */
typedef struct narc_row_array {
    void *rows;
    narc_kept_row *kept;
    size_t count, capacity;
} narc_row_array;

/* Which arrays grow together, to hold one item for each of something. */
typedef enum narc_growth {
    NARC_OF_SLOTS,
    NARC_OF_SLOTS_AHEAD, /* of steps with margins of their own */
    NARC_OF_PAIRS,
    NARC_OF_FILTERED_PAIRS, /* of steps with a filter */
    NARC_OF_GROUND_PAIRS,   /* of steps with ground */
    NARC_OF_EVENTS,         /* one for each pair that there is or was, as it begins or ends at most once in a step */
    NARC_OF_BODIES,
    NARC_OF_MORE,
    NARC_OF_NEXT_MORE,
    NARC_OF_GROUND,
    NARC_OF_PARTNERS,    /* two for each pair */
    NARC_OF_PARTNER_ENDS /* one more than bodies */
} narc_growth;

/* An array of a narc_contacts. */
typedef struct narc_array {
    narc_growth growth;
    void **memory;
    size_t size;   /* of an item; 0: there is none */
    size_t *count; /* how many items a step leaves to the next; NULL: none */
} narc_array;

enum { NARC_ARRAYS = 38 };

/* How a step asks. */
typedef struct narc_asked {
    float margin, second_margin, flat_angle, recycling;
    uint32_t front_only, has_run;
} narc_asked;

struct narc_contacts {
    narc_allocator allocator;
    bool contact_rows, rows_in_user;
    size_t row_size, row_stride, row_offset, user_size;
    narc_broad_phase *broad;
    narc_step_result result;
    narc_asked last;
    bool again;        /* all pairs are to be asked: they are asked differently */
    bool marked;       /* `state` has marks of the last step */
    bool changed;      /* something is to be done with pairs */
    bool marks_known;  /* `marks` are those of the list, */
    bool ground_known; /* and those of ground are in `ground_pairs` */
    bool lists_known;  /* `touching`, `sensors` are right but for what crosses, or has parted, in this step */

    size_t slot_capacity, slot_count; /* slots that were ever in use are the first slot_count */
    uint32_t *a, *b;                  /* the pair's bodies; 0 without a pair */
    uint8_t *state, *flags, *marks;   /* `marks`: those of the list's pair, or NARC_GONE */
    uint32_t *free, *parted;          /* `free`, `parted`: lists of slots */
    float *margins;                   /* that it is asked with, if there are several */
    void *own_rows, *user;            /* own_rows: NULL if rows lie in `user` */
    void *rows;                       /* where they lie, `row_stride` bytes each */
    narc_entry *entries;              /* NARC_SLOT_ENTRY: of smooth shapes, not of ground */
    narc_kept_row *kept;              /* NARC_SLOT_KEPT: of all others, in the same memory */
    narc_entry_ends *ends;            /* of entries of manifolds */
    narc_more_rows *more_of;
    size_t free_count, ahead_capacity;

    size_t order_capacity, filtered_capacity, ground_capacity, event_capacity; /* of pairs: */
    uint32_t *order, *next_order;
    narc_pair_work *ground_pairs;   /* pairs of ground: all of the list, in its order; */
    narc_pair_work *work;           /* and what is to be done with some */
    uint32_t *asked, *known, *left; /* slots: asked plainly, by their entries, and what these do not decide; before,
                                       `known`: of ground_asked, `left`: what has moved of that */
    uint32_t *candidates;           /* slots whose rows may follow, and then those whose rows are to be kept */
    uint32_t *sensors_asked, *ground_asked, *touching, *sensors;
    float *ground_margins;
    uint64_t *bits;
    narc_touch_event *events; /* what began, and then what ended */
    size_t work_count, asked_count, known_count, candidate_count, sensor_count, ground_count, ground_pair_count,
        parted_count, crossed_count, event_count;

    unsigned wait, waits; /* so many steps no entry is made; so many it was the last time */

    size_t body_capacity;
    float *room;      /* of each body: what its separations may be off by, */
    uint8_t *grounds; /* and whether it is ground: NARC_IS_PIECE, NARC_IS_OF_RUN */

    narc_row_array more, next_more, ground; /* `ground`: as they were answered */

    bool partners_listed; /* since the last step */
    size_t partner_capacity, partner_end_capacity;
    uint32_t *partners, *partner_ends; /* slots of each body: partners[partner_ends[k]] .. [partner_ends[k + 1]] */
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

/* Room for the pairs of a step, their slots, and bodies; what is known of slots stays. NARC_ERROR_MEMORY: all is as it
 * was. */
narc_status narc_reserve_slots(const narc_contact_step *s);

/* All arrays; returns NARC_ARRAYS. */
size_t narc_list_arrays(narc_contacts *contacts, narc_array out[NARC_ARRAYS]);

/* Room for so many items in arrays that grow together; those there are stay. NARC_ERROR_MEMORY: in none. */
narc_status narc_reserve_arrays(narc_contacts *contacts, narc_growth growth, size_t *capacity, size_t count);

/* Lets the result show the arrays as they lie now. */
void narc_show_arrays(narc_contacts *contacts);

/* Gives each pair of a new list its slot, and those that are gone back at the next call. */
void narc_take_slots(narc_contacts *contacts, const narc_pair_list *list);

void narc_free_slots(narc_contacts *contacts);

/* Gives a slot a mark of this step: any bit of `state` but NARC_TOUCHING. */
static inline void narc_mark_slot(narc_contacts *c, uint32_t slot, unsigned mark) {
    c->marked = true;
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

/* Row k of an array, and that of a slot. */
static inline void *narc_row_at(const narc_contacts *c, void *rows, size_t k) { return (char *)rows + k * c->row_size; }
static inline void *narc_slot_row(const narc_contacts *c, size_t slot) {
    return (char *)c->rows + slot * c->row_stride;
}

/* Rows as kernels take them. */
static inline narc_rows narc_view_rows(const narc_contacts *c, void *rows) {
    return (narc_rows){.base = rows, .stride = (ptrdiff_t)(rows == c->rows ? c->row_stride : c->row_size)};
}

static inline void narc_zero_row(const narc_contacts *c, uint32_t slot) {
    memset(narc_slot_row(c, slot), 0, c->row_size);
    memcpy(narc_slot_row(c, slot), &slot, sizeof slot); /* the row's `pair` */
}

/* ------------------------------------------------------------------------------------------------ recycle.c */

/* Keeps the rows of slots that lie at `to`: number item[i] of slots[i] in kept[item[i]]; `item` NULL: at the slot's number. */
void narc_keep_rows(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, const uint32_t *item,
                    size_t count, void *to, narc_kept_row *kept);

/* Keeps how far the bodies of slots without a row may move against each other until there may be one. */
void narc_keep_bare(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, size_t count);

/* The same of a body and a piece of a chain. */
void narc_keep_bare_ground(const narc_contact_step *s, const narc_pairs *pairs, const uint32_t *slots, size_t count);

/* Of the first `count` pairs of the list in `ground_asked`, with their slots in `known`, those whose bodies have moved too
 * far for what is kept of them: in `left`, in their order. Returns how many. */
size_t narc_find_moved(const narc_contact_step *s, size_t count);

/* May the row of pair `pair` of the list that was kept in kept[item] follow its bodies? */
bool narc_may_follow(const narc_contact_step *s, uint32_t pair, uint32_t item, const narc_kept_row *kept);

/* The further rows of a slot, whose first row does, follow their bodies, as it was found out that they may. */
void narc_follow_more(const narc_contact_step *s, const narc_pairs *pairs, uint32_t slot);

/* ------------------------------------------------------------------------------------------------ plan.c */

/* Lists what is to be done with pairs of ground; changes nothing that a result shows. */
void narc_plan_ground(const narc_contact_step *s);

/* Lists the slots that are to be asked, and those whose rows may follow. */
void narc_sort_pairs(const narc_contact_step *s);

/* The margin of a pair. */
float narc_find_margin(const narc_contact_step *s, uint32_t a, uint32_t b);

/* Both n-arcs: to ask anew costs no more than to follow. */
bool narc_are_smooth(const narc_contact_step *s, uint32_t a, uint32_t b);

/* A body is a piece of a chain; it is said to be of a run. A pair is of ground if one of both is the one, or B is the other. */
enum { NARC_IS_PIECE = 1, NARC_IS_OF_RUN = 2 };

/* Marks of slots beside those of pairs: nothing but 0 is in `kept`; it is of ground; neither body moves; there is no pair. */
enum { NARC_KEEPS_NOTHING = 8, NARC_WITH_GROUND = 16, NARC_RESTS = 32, NARC_GONE = 64 };

/* ------------------------------------------------------------------------------------------------ ground.c */

/* Asks what is planned of ground, into contacts->ground, merged; changes nothing that a result shows. */
narc_status narc_ask_ground(const narc_contact_step *s);

/* Puts these rows into their slots, and those that are further ones of their pairs into contacts->more, with all that stay
 * from before. */
void narc_take_ground(const narc_contact_step *s);

/* ------------------------------------------------------------------------------------------------ ask.c */

/* A batch of pairs that are known to be there, and the kernels for so many. NULL: there are none. */
const narc_kernel_table *narc_fill_slots(const narc_contact_step *s, const narc_pairs *pairs, const narc_query *query,
                                         narc_batch *out);

/* Lets the rows of slots in `candidates` follow, and all that they have in `more`; those that may not join `asked`. Then rows
 * of the slots in `asked` and `known`, which are written now, and what touches. */
narc_status narc_ask_contacts(const narc_contact_step *s, const narc_pairs *pairs);

/* Asks pairs of the list, of ground, as the step says. */
narc_status narc_ask_pairs(const narc_contact_step *s, const uint32_t *list, size_t count, void *rows, size_t capacity,
                           size_t *out_count);

#endif
