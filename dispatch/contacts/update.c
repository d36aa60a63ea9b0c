/* SPDX-License-Identifier: MIT
 *
 * update.c - narc_update_contacts(): the pairs of this step, what is to be done with them, rows, and what began and ended.
 *
 * Whatever may fail comes before anything is changed that the last result shows.
 */
#include "broad_phase/steps.h"
#include "column.h"
#include "contacts.h"
#include "dispatch.h"
#include "error.h"
#include "memory.h"
#include "narc.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------------ rows */

static narc_status ask_sensors(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    if (c->sensor_count == 0)
        return NARC_OK;
    const narc_query query = {.selection = {c->sensors_asked, sizeof *c->sensors_asked},
                              .selection_count = c->sensor_count,
                              .front_only = s->step->front_only,
                              .workers = s->step->workers};
    const narc_status status = narc_find_overlaps(s->shapes, s->step->bodies, pairs, &query, c->bits, s->error);
    for (size_t i = 0; i < c->sensor_count && status == NARC_OK; i++) {
        const uint32_t slot = c->sensors_asked[i];
        const bool touches = c->bits[i / 64] >> i % 64 & 1;
        narc_clear_row(c, slot);
        narc_mark_slot(c, slot, NARC_ASKED);
        narc_set_touching(c, slot, touches);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ lists */

static uint64_t id_of(const narc_contact_step *s, uint32_t body) {
    return s->step->id.base ? narc_word_at(s->step->id, body) : body;
}

static void list_parted(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    for (size_t k = 0; k < s->list->lost_count; k++) {
        const narc_lost_pair *const lost = &s->list->lost[k];
        const uint32_t slot = c->parted[k];
        if (c->state[slot] & NARC_TOUCHING)
            c->ended[c->result.ended_count++] =
                (narc_touch_event){slot, (uint8_t)lost->marks, 1, 0, lost->id_a, lost->id_b};
    }
}

/* What touches, began and ended, in the order of pairs. */
static void make_lists(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    narc_step_result *const r = &c->result;
    const uint32_t *const order = c->order;
    const uint8_t *const state = c->state, *const all_marks = s->list->marks;
    uint8_t *const flags = c->flags;
    uint32_t *const touching = c->touching;
    const size_t count = s->list->pairs.count;
    size_t touching_count = 0, sensor_count = 0;
    for (size_t k = 0; k < count; k++) {
        const uint32_t slot = order[k];
        const unsigned marks = all_marks[k];
        unsigned touches = state[slot] & NARC_TOUCHING;
        if (flags[slot] & NARC_SLOT_CROSSED) {
            flags[slot] &= (uint8_t)~NARC_SLOT_CROSSED;
            const narc_touch_event event = {slot, (uint8_t)(marks & NARC_KINDS), 0,
                                            0,    id_of(s, c->a[slot]),          id_of(s, c->b[slot])};
            if (touches)
                c->began[r->began_count++] = event;
            else
                c->ended[r->ended_count++] = event;
        }
        if (touches && marks & NARC_SENSOR) {
            c->sensors[sensor_count++] = slot;
            touches = 0;
        } else if (touches && marks & NARC_AT_REST) {
            touches = narc_is_tested(s, c->a[slot], c->b[slot]);
        }
        touching[touching_count] = slot; /* as chance has it: without a branch */
        touching_count += touches;
    }
    r->touching_count = touching_count;
    r->sensor_count = sensor_count;
    c->crossed_count = 0;
}

/* ------------------------------------------------------------------------------------------------ the step */

/* Are rows of pairs that have not moved another answer now? */
static bool is_asked_differently(const narc_contacts *c, const narc_step *step) {
    const narc_step *const last = &c->last_step;
    return step->margin != last->margin || step->second_margin != last->second_margin ||
           step->flat_angle != last->flat_angle || step->front_only != last->front_only ||
           step->recycling != last->recycling || !step->ahead.base != !last->ahead.base ||
           !step->run.base != !last->run.base;
}

/* Checks what nothing else does before something is changed. */
static narc_status check_step(const narc_contacts *c, const narc_shapes *shapes, const narc_step *step,
                              const narc_step_result **out_result, narc_error *error) {
    if (!c || !shapes || !step || !out_result || !step->bodies)
        return narc_fail_missing(error, !c            ? "contacts"
                                        : !shapes     ? "shapes"
                                        : !step       ? "step"
                                        : !out_result ? "out_result"
                                                      : "step.bodies");
    const struct {
        float value;
        const char *name;
    } lengths[] = {{step->margin, "margin"}, {step->skin, "skin"}, {step->recycling, "recycling"}};
    for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
        const narc_status status = narc_check_length(lengths[k].value, "step", lengths[k].name, error);
        if (status != NARC_OK)
            return status;
    }
    if (!step->moved.base && step->moved_count > 0)
        return narc_fail_missing(error, "step.moved");
    const narc_query query = {
        .margin = step->margin, .second_margin = step->second_margin, .flat_angle = step->flat_angle};
    const narc_status status = narc_check_numbers(&query, "step", error);
    if (status != NARC_OK)
        return status;
    return narc_check_reserved(step->reserved, 4, "step", error) == NARC_OK ? narc_check_set(step->bodies, error)
                                                                            : NARC_ERROR_ARGUMENT;
}

/* Pairs, room, rows of ground: what may fail. */
static narc_status prepare(narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_step *const step = s->step;
    const narc_pair_options options = {.margin = step->margin,
                                       .skin = step->skin,
                                       .motion_x = step->motion_x,
                                       .motion_y = step->motion_y,
                                       .reach = step->reach,
                                       .id = step->id,
                                       .filter = step->filter,
                                       .workers = step->workers};
    const narc_moved_bodies listed = {step->moved, step->moved_count, step->moved.base || step->moved.stride,
                                      step->ahead, step->run};
    narc_status status =
        narc_update_moved_pairs(c->broad, s->shapes, step->bodies, &options, &listed, &s->list, s->error);
    if (status != NARC_OK)
        return status;
    if (narc_reserve_slots(c, s->list, step->bodies->count) != NARC_OK)
        status = narc_fail(s->error, NARC_ERROR_MEMORY, 0, (double)s->list->pairs.count,
                           "not enough memory for %zu contacts", s->list->pairs.count);
    if (status != NARC_OK)
        return status;
    narc_plan_ground(s);
    status = narc_ask_ground(s);
    return status == NARC_ERROR_MEMORY ? narc_fail(s->error, status, 0, (double)c->ground_count,
                                                   "not enough memory for %zu contacts with ground", c->ground_count)
                                       : status;
}

/* What follows from the plan: nothing here fails. */
static narc_status carry_out(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    narc_step_result *const r = &c->result;
    uint8_t *const state = c->state;
    const size_t marked_count = c->marked ? c->slot_count : 0;
    for (size_t k = 0; k < marked_count; k++)
        state[k] &= NARC_TOUCHING;
    c->marked = false;
    narc_take_slots(c, s->list);
    const narc_pairs pairs = narc_view_slots(c);
    narc_sort_pairs(s);
    narc_status status = narc_ask_contacts(s, &pairs);
    if (status == NARC_OK)
        status = ask_sensors(s, &pairs);
    if (status != NARC_OK)
        return status;
    narc_take_ground(s);
    r->pairs = pairs;
    r->order = c->order;
    r->count = s->list->pairs.count;
    r->more = c->more.rows;
    r->more_count = c->more.count;
    r->began_count = r->ended_count = 0;
    if (!s->list->kept)
        list_parted(s);
    if (c->crossed_count > 0 || c->broad->marked)
        make_lists(s);
    r->skipped = s->list->skipped;
    r->asked_count = c->asked_count + c->known_count + c->sensor_count + c->ground_count;
    return NARC_OK;
}

narc_status narc_update_contacts(narc_contacts *contacts, const narc_shapes *shapes, const narc_step *step,
                                 const narc_step_result **out_result, narc_error *error) {
    narc_status status = check_step(contacts, shapes, step, out_result, error);
    if (status != NARC_OK)
        return status;
    narc_contact_step s = {contacts, shapes, step, NULL, error, shapes->piece_count > 0 || step->run.base};
    contacts->again = is_asked_differently(contacts, step);
    status = prepare(&s);
    if (status != NARC_OK) {
        narc_take_back_pairs(contacts->broad, s.list && !s.list->kept);
        contacts->marks_known = false;
        return status;
    }
    status = carry_out(&s);
    if (status != NARC_OK)
        return status;
    if (step->bodies->count > 0)
        memset(contacts->broad->known.changed, 0, step->bodies->count);
    contacts->last_step = *step;
    *out_result = &contacts->result;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ the object */

narc_status narc_create_contacts(const narc_contacts_settings *settings, narc_contacts **out_contacts,
                                 narc_error *error) {
    static const narc_contacts_settings defaults = {0};
    const narc_contacts_settings *const o = settings ? settings : &defaults;
    const narc_allocator chosen = narc_choose_allocator(o->allocator);
    if (!out_contacts)
        return narc_fail_missing(error, "out_contacts");
    if (o->rows > NARC_CONTACT_ROWS)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, o->rows, "settings.rows is %lu, not one of both kinds",
                         (unsigned long)o->rows);
    narc_status status = narc_check_reserved(o->reserved, 4, "settings", error);
    if (status != NARC_OK)
        return status;
    if (!chosen.allocate || !chosen.release)
        return narc_fail_missing(error, "settings.allocator's function");
    narc_contacts *c = chosen.allocate(sizeof *c, chosen.context);
    if (!c)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)sizeof *c, "not enough memory for contacts");
    *c = (narc_contacts){.allocator = chosen,
                         .contact_rows = o->rows == NARC_CONTACT_ROWS,
                         .row_size = o->rows == NARC_CONTACT_ROWS ? sizeof(narc_contact) : sizeof(narc_manifold),
                         .user_size = o->user_size};
    status = narc_create_broad_phase(o->allocator, &c->broad);
    if (status != NARC_OK) {
        chosen.release(c, chosen.context);
        return narc_fail(error, status, 0, 0, "not enough memory for contacts");
    }
    *out_contacts = c;
    return NARC_OK;
}

void narc_destroy_contacts(narc_contacts *contacts) {
    if (!contacts)
        return;
    narc_destroy_broad_phase(contacts->broad);
    narc_free_slots(contacts);
    contacts->allocator.release(contacts, contacts->allocator.context);
}

void narc_forget_contacts(narc_contacts *c) {
    if (!c)
        return;
    narc_forget_pairs(c->broad);
    narc_forget_poses(c->broad);
    c->slot_count = c->free_count = c->parted_count = c->crossed_count = c->more.count = 0;
    c->result.count = c->result.touching_count = c->result.sensor_count = c->result.began_count =
        c->result.ended_count = 0;
    c->result.more_count = 0;
}
