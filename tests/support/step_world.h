/* SPDX-License-Identifier: MIT
 *
 * step_world.h - random worlds for contacts that stay, and what these are to say of each step.
 */
#ifndef NARC_STEP_WORLD_H
#define NARC_STEP_WORLD_H

#include "narc_contacts.h"
#include "support.h"

enum { BODIES = 160, ROOM = 1024, SHAPES = 24, PAIRS = 40000 };

struct step_world {
    struct test_random random;
    narc_shapes *store;
    narc_body body[ROOM];
    uint64_t id[ROOM], category[ROOM], mask[ROOM];
    uint8_t kind[ROOM];
    uint32_t owner[ROOM], run[ROOM], moved[ROOM];
    float motion_x[ROOM], motion_y[ROOM], ahead[ROOM];
    size_t count, ground, moved_count;
    uint64_t last_id;
    bool has_filter, has_motion, has_ahead, shuffled;
    float margin, skin;
    narc_point origin;
};

/* What a caller keeps in a slot, and what the test remembers of the last step. */
struct mark {
    uint64_t low, high;
};

struct memory {
    struct mark was[PAIRS], now[PAIRS];
    size_t was_count, now_count;
};

/* With an open chain as ground, whose entries stand behind all bodies, or without. */
struct step_world *make_step_world(struct test_random random, bool ground);
void destroy_step_world(struct step_world *w);
RELEASE_AT(destroy_step_world)

/* What happens between two steps: who may be another one is listed in w->moved. */
void move_step_world(struct step_world *w);

/* A step of the world; its filter is `filter` if the world has one. */
narc_step make_step(const struct step_world *w, const narc_bodies *bodies, const narc_pair_filter *filter);

/* Contacts as they are saved; `all` is to be freed. */
struct bytes {
    size_t count;
    char *all;
};

void save(const narc_contacts *contacts, struct bytes *out);
void check_saved_alike(const narc_contacts *one, const narc_contacts *other);

narc_contacts *make_contacts(uint32_t row_kind, const narc_allocator *allocator); /* with a struct mark in each slot */
struct mark mark_of(uint64_t a, uint64_t b);

/* The pairs of the result that was checked last, and margins or separations. */
extern uint32_t pair_a[PAIRS], pair_b[PAIRS];
extern float margins[PAIRS];

/* All pairs that are closer than the margin are listed, in order. */
void check_pairs(const struct step_world *w, const narc_step *step, const narc_step_result *r);

/* Each row, list and overlap is that of the plain calls, and the touching slots' are listed. After check_pairs(). */
void check_rows(const struct step_world *w, const narc_step *step, const narc_step_result *r);

/* A slot's row, or that behind it, is this one but for its number. */
void check_row(const narc_manifold *row, narc_manifold expected, uint32_t slot);

/* What a slot keeps stays, and what began and ended is told; after check_pairs(). */
void check_events(const struct step_world *w, const narc_step_result *r, struct memory *m);

/* Both results are the same. */
void check_same(const narc_step_result *one, const narc_step_result *other);

/* The same of contacts with pairs of the caller's, which have no boxes: more of them are asked. */
void check_own(const narc_step_result *found, const narc_step_result *own);

/* Rows of contacts touch where manifolds do. */
void check_contact_rows(const narc_step_result *manifolds, const narc_step_result *contacts);

/* An allocator that lets so many allocations be until one fails, SIZE_MAX: none does; and finds who writes behind memory. */
extern size_t allowed;
extern const narc_allocator watched;

#endif
