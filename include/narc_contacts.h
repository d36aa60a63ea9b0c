/* SPDX-License-Identifier: MIT
 *
 * narc_contacts.h - contacts that stay: from bodies to all that touches, one call a step, with work only for what changed.
 *
 * The mental model
 *
 *   Each pair of bodies that are near each other has a SLOT, from the step in which they come near until they part: a
 *   row, as narc_find_manifolds() or narc_find_contacts() answers it, and bytes of the caller's own (impulses, friction
 *   history). A slot stays where it is. A step finds out which bodies have moved, which pairs came and went, and asks
 *   those pairs again whose bodies are not where they were; all else is left as it is, rows and bytes.
 *
 *   Lists tell what a solver goes through and what a game wants to know: what touches, what began and ended. They come
 *   in the order of the pairs: by the number of one body, and then of the other.
 *
 * Example
 *
 *     narc_create_contacts(&(narc_contacts_settings){.user_size = sizeof(impulses)}, &contacts, &error);
 *
 *     narc_step step = {.bodies = &bodies, .margin = 0.02f, .skin = 0.05f, .recycling = 0.005f,
 *                       .filter = &filter, .id = NARC_COLUMN(body, id), .workers = &workers};
 *     const narc_step_result *r;
 *     narc_update_contacts(contacts, shapes, &step, &r, &error);
 *     impulses *kept = r->user;
 *     for (size_t k = 0; k < r->touching_count; k++)
 *         solve(&r->manifolds[r->touching[k]], &kept[r->touching[k]]);
 *
 * Bodies come and go, and change their numbers, as long as each has its id; shapes and filters may be others in each step.
 */
#ifndef NARC_CONTACTS_H
#define NARC_CONTACTS_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pairs and what is known of them. One object serves one call at a time. */
typedef struct narc_contacts narc_contacts;

/* What slots hold: the rows of narc_find_manifolds(), or those of narc_find_contacts(); and where: in arrays of their own, or
 * within the caller's bytes. */
enum { NARC_MANIFOLD_ROWS = 0, NARC_CONTACT_ROWS = 1, NARC_ROWS_IN_USER = 2 };

/* What is 0 or NULL is left out.
 *   rows        NARC_MANIFOLD_ROWS or NARC_CONTACT_ROWS, and NARC_ROWS_IN_USER
 *   user_size   bytes that each slot has for the caller: all 0 in a new slot, aligned as malloc() aligns the first
 *   row_offset  with NARC_ROWS_IN_USER: where the row lies in these bytes, such as a member of an engine's contact, so that
 *               this is all that a solver reads. Both sizes are multiples of 4. Else 0
 *   allocator   NULL: malloc and free */
typedef struct narc_contacts_settings {
    uint32_t rows;
    size_t user_size, row_offset;
    const narc_allocator *allocator;
    void *reserved[4]; /* NULL */
} narc_contacts_settings;

/* An object without contacts. `settings` NULL: {0}. NARC_ERROR_MEMORY, NARC_ERROR_ARGUMENT. */
NARC_API narc_status narc_create_contacts(const narc_contacts_settings *settings, narc_contacts **out_contacts,
                                          narc_error *error);

/* Frees it; NULL is fine. */
NARC_API void narc_destroy_contacts(narc_contacts *contacts);

/* A step; what is 0 or NULL is left out.
 *   bodies              at most 2^32 - 2. Those of ground (entries of chains) behind all that may meet them
 *   margin, second_margin, flat_angle, front_only   as in narc_query, the margin at least 0 and finite
 *   pairs               the pairs that there are, if a broad phase of the caller's finds them: of bodies, in any order, each
 *                       once, without shifts; those that the filter does not let are left out. No boxes are computed then,
 *                       and nothing depends on skin, motion, reach. NULL: all pairs of bodies that are closer than the
 *                       margin, and perhaps others, none further apart than margin + 3 * skin and the motion when their
 *                       boxes were made
 *   same_pairs          not 0: these are the pairs of the last step that did not fail, and are not looked at. (Bodies that
 *                       have other numbers make others of them)
 *   skin                at least 0: bodies may move by seven eighths of this until pairs are looked for again. A larger
 *                       one makes that rarer, and more pairs
 *   recycling           at least 0, a length. 0: rows are, to the last bit, what narc_find_manifolds() (or contacts)
 *                       says of these bodies; those of pairs of which neither moves (narc_pair_filter), what it said
 *                       when one did. Above 0: a row with an edge, or of ground, is kept while its points have
 *                       moved less than that against each other since it was asked for, turns counted by the smaller
 *                       body's diameter, and the first of them is within the margin: features and the normal in A
 *                       stay, points and separations follow the bodies. So a separation is off by less than
 *                       `recycling`, and a contact that should have come at another place of the two may come late by
 *                       as much. Rows of a half-plane are always asked for
 *   motion_x, motion_y  world axes: what each body moves in this step; pairs that come close on the way are there, too
 *   reach               at least 0: how far beyond that a body may reach, such as by rotation
 *   ahead               at least 0: how much further than the margin contacts of a body are told, a fast one's; of two
 *                       bodies the sum. Motion and reach must hold it. A body with a broken one is in no pair
 *   id                  what a body is known by, whatever its number; no two have the same. Left out: its number
 *   run                 of bodies that are entries of chains, their entry's run, and NARC_NO_RUN for all others: what
 *                       several entries tell of one body is merged: one normal of a run is one row, and a seam that both
 *                       entries tell of is told once (docs/terrain.md)
 *   filter              which bodies may form a pair; which are static, asleep, sensors
 *   moved               the numbers of all bodies that may have another pose, scale, shape, filter, id, run, motion, reach
 *                       or ahead than in the last step that did not fail, each once, `moved_count` of them; others are
 *                       not looked at. Left out ({0}, base and stride): all may. An empty list is one, as NARC_ARRAY()
 *                       makes it
 *   workers             threads to use; NULL: the calling one
 *   origin              a place near the bodies, finite, such as where the camera is; NULL: (0, 0). Boxes are float, and
 *                       relative to it: further away than 100,000 times the skin they grow by roundings, and there are more
 *                       pairs (narc_box_options). It may be another one in each step: pairs, rows and the caller's bytes stay
 *   out_world_count     how many of result.touching are of bodies of world 0, 1, 2 ... (narc_pair_filter.world), `world_count`
 *                       numbers. Where bodies stand in the order of their worlds, those of a world follow each other in
 *                       `touching`, behind those of the worlds before. NULL: nobody asks
 * Columns have one item for each body. */
typedef struct narc_step {
    const narc_bodies *bodies;
    float margin, second_margin, flat_angle;
    uint32_t front_only;
    float skin, recycling;
    const narc_pairs *pairs;
    uint32_t same_pairs;
    narc_float_column motion_x, motion_y, reach, ahead;
    narc_word_column id;
    narc_index_column run;
    const narc_pair_filter *filter;
    narc_index_column moved;
    size_t moved_count;
    const narc_workers *workers;
    const narc_point *origin;
    uint32_t *out_world_count;
    size_t world_count;
    void *reserved[1]; /* NULL */
} narc_step;

/* Something that began or ended to touch: a pair with a row, or with a sensor an overlap.
 *   slot        that of the pair, whose row and bytes are there until the next step even if the pair is not
 *   id_a, id_b  of its bodies; their numbers if there are no ids
 *   marks       kinds of both: NARC_SENSOR tells of sensors
 *   parted      1: the bodies are no longer near each other, or one of them is gone; the slot goes to another pair */
typedef struct narc_touch_event {
    uint32_t slot;
    uint8_t marks, parted;
    uint16_t unused;
    uint64_t id_a, id_b;
} narc_touch_event;

/* What slots are, bits of narc_step_result.state.
 *   NARC_TOUCHING  there is a row; of a sensor's pair: both overlap
 *   NARC_NEW       the pair came in this step
 *   NARC_ASKED     the row is new in this step: it was asked for
 *   NARC_FOLLOWED  the row was kept, and follows its bodies (narc_step.recycling)
 *   NARC_TURNED    new bytes are wanted: the bodies stand in the other order (a is b) since the last step, and what the
 *                  caller keeps is that of the pair (b, a). Its row is asked for, even if neither moves
 * A row with neither ASKED nor FOLLOWED has the bytes of the last step. */
enum { NARC_TOUCHING = 1, NARC_NEW = 2, NARC_ASKED = 4, NARC_FOLLOWED = 8, NARC_TURNED = 16 };

/* After a step; all arrays belong to the contacts, and are valid until the next call.
 *   pairs         by slot: its bodies a < b, plain arrays. Only slots that are listed in `order` are pairs
 *   order         the slots of all pairs, in the order of a and then b
 *   state         by slot, see above
 *   manifolds     by slot, or `contacts`: rows, with count 0 where nothing touches; their `pair` is the slot. NULL where rows
 *                 lie in `user`
 *   more          further rows of pairs with concave arcs, `more_count` of them in the order of pairs, of the same type
 *   user          by slot: user_size bytes each, the caller's to write
 *   touching      slots with a row of which one body moves (narc_pair_filter): what a solver goes through
 *   sensors       slots of sensors' pairs whose bodies overlap
 *   began, ended  since the last step, sensors among them; of those that ended the parted ones first. What falls asleep
 *                 ends nothing
 *   skipped       how many bodies are in no pair because they are broken (narc_validate_bodies() says which); 0 with pairs of
 *                 the caller's, which have no row then
 *   asked_count   how many pairs were asked */
typedef struct narc_step_result {
    narc_pairs pairs;
    const uint32_t *order;
    size_t count;
    const uint8_t *state;
    const narc_manifold *manifolds;
    const narc_contact *contacts;
    const void *more;
    size_t more_count;
    void *user;
    const uint32_t *touching, *sensors;
    size_t touching_count, sensor_count;
    const narc_touch_event *began, *ended;
    size_t began_count, ended_count;
    size_t skipped, asked_count;
} narc_step_result;

/* A step: boxes, pairs, rows, events. For the same calls the same bits, for any workers and on every instruction set.
 *   Time: a look at each body, or at those that are listed; boxes of those that have moved; and of all pairs only those of
 * bodies that have changed. Where one has left its box by more than the skin, a walk through all pairs, too. Memory: some
 * 410 bytes for each pair, where a body has four, and the caller's; kept from step to step.
 * Errors: NARC_ERROR_ARGUMENT, NARC_ERROR_NOT_FINITE, NARC_ERROR_INDEX, NARC_ERROR_COUNT (2^32 pairs), NARC_ERROR_MEMORY,
 * those for NARC_ISA. On an error the last step's result is as it was, though its arrays may have moved, and the next call
 * goes on from there; but where a body that is not listed in `moved` has a shape that there is not, all pairs are forgotten. */
NARC_API narc_status narc_update_contacts(narc_contacts *contacts, const narc_shapes *shapes, const narc_step *step,
                                          const narc_step_result **out_result, narc_error *error);

/* The slots of all pairs of a body, by its number in the last step, in the order of pairs; valid until the next call but this
 * one. The first call after a step takes a walk through all pairs. Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_INDEX,
 * NARC_ERROR_MEMORY. */
NARC_API narc_status narc_find_body_slots(narc_contacts *contacts, uint32_t body, const uint32_t **out_slots,
                                          size_t *out_count, narc_error *error);

/* Takes bodies out, by their ids (without ids, their numbers): their pairs part in the next step, and a body that has such an
 * id there is another one, of which nothing is known. So an id may serve again at once, and a body that was moved to another
 * place may lose its history. Unknown ids count for nothing. Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_MEMORY: nothing
 * is taken out. */
NARC_API narc_status narc_forget_bodies(narc_contacts *contacts, const uint64_t *ids, size_t count, narc_error *error);

/* Forgets all pairs, and keeps the memory: for another level. All pairs of the next step are new, and none has ended. NULL:
 * nothing happens. */
NARC_API void narc_forget_contacts(narc_contacts *contacts);

/* Contacts as bytes, all of them with the caller's, for games that go back some steps and play them again: whatever steps
 * follow after they are loaded, each bit is that of the steps that followed when they were saved. The bytes are the same for
 * the same calls, on every instruction set and for any workers; they serve this version of the library, on machines with the
 * same order of bytes. */

/* How many bytes narc_save_contacts() writes: some 190 for each pair, and the caller's; 80 to 130 for each body. */
NARC_API size_t narc_count_contact_bytes(const narc_contacts *contacts);

/* Writes to the caller's `out_bytes`, of which there are `size`. Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_CAPACITY (size
 * is less than narc_count_contact_bytes()); nothing is written then. */
NARC_API narc_status narc_save_contacts(const narc_contacts *contacts, void *out_bytes, size_t size, narc_error *error);

/* Makes contacts what they were when the `size` bytes were saved, from an object with the same settings.
 *   shapes      a store that holds what it held then; what it says otherwise is found out when a pair is asked again
 *   out_result  that of the last step before; NULL: nobody asks
 * The bytes may lie anywhere and may come from anyone: whatever is in them is checked before anything is changed, so far that
 * no later call reads or writes where it must not. NARC_ERROR_FORMAT: other bytes, another version, or damage;
 * NARC_ERROR_ARGUMENT: NULL, other settings; NARC_ERROR_MEMORY. On an error contacts are as they were. */
NARC_API narc_status narc_load_contacts(narc_contacts *contacts, const narc_shapes *shapes, const void *bytes,
                                        size_t size, const narc_step_result **out_result, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
