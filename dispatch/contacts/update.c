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
        narc_zero_row(c, slot); /* it may have been no sensor's */
        c->more_of[slot].count = 0;
        narc_mark_slot(c, slot, NARC_ASKED);
        narc_set_touching(c, slot, touches);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ lists */

static uint64_t id_of(const narc_contact_step *s, uint32_t body) {
    return s->step->id.base ? narc_word_at(s->step->id, body) : body;
}

/* What begins is listed from the front of the memory, what ends from its end, and then turned round. */
static void add_event(narc_contacts *c, bool begins, narc_touch_event event) {
    narc_step_result *const r = &c->result;
    c->events[begins ? r->began_count++ : c->event_capacity - ++r->ended_count] = event;
}

static void gather_events(narc_contacts *c) {
    narc_step_result *const r = &c->result;
    if (r->ended_count > 0) {
        narc_touch_event *const ended = c->events + c->event_capacity - r->ended_count;
        for (size_t k = 0, last = r->ended_count - 1; k < last; k++, last--) {
            const narc_touch_event moved = ended[k];
            ended[k] = ended[last];
            ended[last] = moved;
        }
        memmove(c->events + r->began_count, ended, r->ended_count * sizeof *ended);
    }
}

static void list_parted(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    for (size_t k = 0; k < s->list->lost_count; k++) {
        const narc_lost_pair *const lost = &s->list->lost[k];
        const uint32_t slot = c->parted[k];
        if (c->state[slot] & NARC_TOUCHING)
            add_event(c, false, (narc_touch_event){slot, (uint8_t)lost->marks, 1, 0, lost->id_a, lost->id_b});
    }
}

/* Does one slot's pair come before another's? */
static bool is_before(const narc_contacts *c, uint32_t one, uint32_t other) {
    return c->a[one] < c->a[other] || (c->a[one] == c->a[other] && c->b[one] < c->b[other]);
}

/* Puts a slot into a list in the order of pairs, or takes it out. */
static void mend_list(const narc_contacts *c, uint32_t *list, size_t *count, uint32_t slot, bool is_in) {
    size_t low = 0, high = *count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (is_before(c, list[middle], slot))
            low = middle + 1;
        else
            high = middle;
    }
    const bool was_in = low < *count && list[low] == slot;
    if (is_in && !was_in)
        memmove(list + low + 1, list + low, ((*count)++ - low) * sizeof *list);
    if (is_in)
        list[low] = slot;
    else if (was_in)
        memmove(list + low, list + low + 1, (--*count - low) * sizeof *list);
}

/* The event of a slot, if it began or ended to touch. */
static void note_crossing(const narc_contact_step *s, uint32_t slot) {
    narc_contacts *const c = s->contacts;
    if (!(c->flags[slot] & NARC_SLOT_CROSSED))
        return;
    c->flags[slot] &= (uint8_t)~NARC_SLOT_CROSSED;
    const narc_touch_event event = {
        slot, (uint8_t)(c->marks[slot] & NARC_KINDS), 0, 0, id_of(s, c->a[slot]), id_of(s, c->b[slot])};
    add_event(c, c->state[slot] & NARC_TOUCHING, event);
}

/* So few crossings change lists that are right but for these. */
enum { FEW_CROSSINGS = 16 };

static void mend_lists(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    narc_step_result *const r = &c->result;
    const uint8_t *const flags = c->flags;
    uint32_t crossed[FEW_CROSSINGS];
    size_t count = 0;
    for (size_t slot = 0; slot < c->slot_count && count < c->crossed_count; slot++) {
        if (!(flags[slot] & NARC_SLOT_CROSSED))
            continue;
        size_t at = count++;
        for (; at > 0 && is_before(c, (uint32_t)slot, crossed[at - 1]); at--)
            crossed[at] = crossed[at - 1];
        crossed[at] = (uint32_t)slot;
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = crossed[i], marks = c->marks[slot];
        const bool touches = c->state[slot] & NARC_TOUCHING, is_sensor = marks & NARC_SENSOR;
        note_crossing(s, slot);
        if (is_sensor)
            mend_list(c, c->sensors, &r->sensor_count, slot, touches);
        else if (!(marks & NARC_RESTS))
            mend_list(c, c->touching, &r->touching_count, slot, touches);
    }
    c->crossed_count = 0;
}

/* What touches, began and ended, in the order of pairs. */
static void make_lists(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    narc_step_result *const r = &c->result;
    const uint32_t *const order = c->order;
    const uint8_t *const state = c->state, *const all_marks = c->marks;
    const uint8_t *const flags = c->flags;
    uint32_t *const touching = c->touching;
    const size_t count = s->list->pairs.count;
    size_t touching_count = 0, sensor_count = 0;
    for (size_t k = 0; k < count; k++) {
        const uint32_t slot = order[k];
        const unsigned marks = all_marks[slot];
        const unsigned touches = state[slot] & NARC_TOUCHING;
        if (flags[slot] & NARC_SLOT_CROSSED)
            note_crossing(s, slot);
        if (touches & (marks / NARC_SENSOR)) /* one is rare, the other one not */
            c->sensors[sensor_count++] = slot;
        touching[touching_count] = slot; /* as chance has it: without a branch */
        touching_count += touches & !(marks & (NARC_SENSOR | NARC_RESTS));
    }
    r->touching_count = touching_count;
    r->sensor_count = sensor_count;
    c->crossed_count = 0;
}

/* How many that touch each world has. */
static void count_worlds(const narc_contact_step *s) {
    const narc_contacts *const c = s->contacts;
    uint32_t *const counts = s->step->out_world_count;
    for (size_t k = 0; k < s->step->world_count; k++)
        counts[k] = 0;
    for (size_t k = 0; k < c->result.touching_count && s->step->world_count > 0; k++) {
        const uint32_t world = narc_read_world(s->step->filter, c->a[c->touching[k]]);
        if (world < s->step->world_count)
            counts[world]++;
    }
}

/* ------------------------------------------------------------------------------------------------ the step */

/* Rows of pairs that have not moved are another answer if this is another. */
static narc_asked describe_asking(const narc_step *step) {
    return (narc_asked){step->margin,    step->second_margin, step->flat_angle,
                        step->recycling, step->front_only,    step->run.base != NULL};
}

static bool are_asked_alike(const narc_asked *one, const narc_asked *other) {
    return one->margin == other->margin && one->second_margin == other->second_margin &&
           one->flat_angle == other->flat_angle && one->recycling == other->recycling &&
           one->front_only == other->front_only && one->has_run == other->has_run;
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
    if (!step->out_world_count && step->world_count > 0)
        return narc_fail_missing(error, "step.out_world_count");
    const narc_query query = {
        .margin = step->margin, .second_margin = step->second_margin, .flat_angle = step->flat_angle};
    const narc_status status = narc_check_numbers(&query, "step", error);
    if (status != NARC_OK)
        return status;
    const narc_status origin = narc_check_origin(step->origin, "step", error);
    if (origin != NARC_OK)
        return origin;
    return narc_check_reserved(step->reserved, 1, "step", error) == NARC_OK ? narc_check_set(step->bodies, error)
                                                                            : NARC_ERROR_ARGUMENT;
}

/* Pairs, room, rows of ground: what may fail. */
static narc_status prepare(narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_step *const step = s->step;
    narc_status status = narc_update_pairs(c->broad, s->shapes, step, &s->list, s->error);
    if (status != NARC_OK)
        return status;
    if (narc_reserve_slots(s) != NARC_OK)
        status = narc_fail(s->error, NARC_ERROR_MEMORY, 0, (double)s->list->pairs.count,
                           "not enough memory for %zu contacts", s->list->pairs.count);
    if (status != NARC_OK)
        return status;
    narc_plan_ground(s);
    status = NARC_PIECES ? narc_ask_ground(s) : NARC_OK;
    return status == NARC_ERROR_MEMORY ? narc_fail(s->error, status, 0, (double)c->ground_count,
                                                   "not enough memory for %zu contacts with ground", c->ground_count)
                                       : status;
}

/* What follows from the plan: nothing here fails, if bodies that are not listed have shapes. */
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
    if (NARC_PIECES)
        narc_take_ground(s);
    r->count = s->list->pairs.count;
    r->more_count = c->more.count;
    r->began_count = r->ended_count = 0;
    if (!s->list->kept)
        list_parted(s);
    if (c->crossed_count > FEW_CROSSINGS || r->ended_count > 0 || !c->lists_known)
        make_lists(s);
    else if (c->crossed_count > 0)
        mend_lists(s);
    gather_events(c);
    narc_show_arrays(c);
    r->skipped = s->list->skipped;
    r->asked_count = c->asked_count + c->known_count + c->sensor_count + c->ground_count;
    return NARC_OK;
}

narc_status narc_update_contacts(narc_contacts *contacts, const narc_shapes *shapes, const narc_step *step,
                                 const narc_step_result **out_result, narc_error *error) {
    narc_status status = check_step(contacts, shapes, step, out_result, error);
    if (status != NARC_OK)
        return status;
    const bool has_ground = NARC_PIECES && (shapes->piece_count > shapes->plane_count || step->run.base);
    narc_contact_step s = {contacts, shapes, step, NULL, error, has_ground};
    const narc_asked asked = describe_asking(step);
    contacts->again = !are_asked_alike(&asked, &contacts->last);
    contacts->partners_listed = false;
    status = prepare(&s);
    if (status != NARC_OK) {
        narc_take_back_pairs(contacts->broad, s.list && !s.list->kept);
        contacts->marks_known = false;
        return status;
    }
    status = carry_out(&s);
    if (status != NARC_OK) { /* a body that was not listed has no shape: rows, and slots, are others already */
        narc_forget_contacts(contacts);
        return status;
    }
    if (step->bodies->count > 0)
        memset(contacts->broad->known.changed, 0, step->bodies->count);
    contacts->last = asked;
    count_worlds(&s);
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
    const bool contact_rows = o->rows & NARC_CONTACT_ROWS, in_user = o->rows & NARC_ROWS_IN_USER;
    const size_t row_size = contact_rows ? sizeof(narc_contact) : sizeof(narc_manifold);
    if (o->rows > (NARC_CONTACT_ROWS | NARC_ROWS_IN_USER))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, o->rows, "settings.rows is %lu, not one of both kinds",
                         (unsigned long)o->rows);
    if (in_user && (o->user_size % 4 || o->row_offset % 4 || o->user_size < row_size ||
                    o->row_offset > o->user_size - row_size || o->user_size > PTRDIFF_MAX))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)o->row_offset,
                         "settings.user_size is %zu: no room for rows of %zu bytes at %zu, in multiples of 4",
                         o->user_size, row_size, o->row_offset);
    if (!in_user && o->row_offset)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)o->row_offset,
                         "settings.row_offset is %zu, without NARC_ROWS_IN_USER", o->row_offset);
    narc_status status = narc_check_reserved(o->reserved, 4, "settings", error);
    if (status != NARC_OK)
        return status;
    if (!chosen.allocate || !chosen.release)
        return narc_fail_missing(error, "settings.allocator's function");
    narc_contacts *c = chosen.allocate(sizeof *c, chosen.context);
    if (!c)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)sizeof *c, "not enough memory for contacts");
    *c = (narc_contacts){.allocator = chosen,
                         .contact_rows = contact_rows,
                         .rows_in_user = in_user,
                         .row_size = row_size,
                         .row_stride = in_user ? o->user_size : row_size,
                         .row_offset = o->row_offset,
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
    c->partners_listed = false;
    c->slot_count = c->free_count = c->parted_count = c->crossed_count = c->more.count = 0;
    c->result.count = c->result.touching_count = c->result.sensor_count = c->result.began_count =
        c->result.ended_count = 0;
    c->result.more_count = 0;
}

narc_status narc_forget_bodies(narc_contacts *c, const uint64_t *ids, size_t count, narc_error *error) {
    if (!c || (count > 0 && !ids))
        return narc_fail_missing(error, c ? "ids" : "contacts");
    const narc_status status = narc_check_count(count, UINT32_MAX - 1, "ids", error);
    return status == NARC_OK ? narc_forget_ids(c->broad, ids, count, error) : status;
}
