/* SPDX-License-Identifier: MIT
 *
 * world_contacts.c - from bodies to contacts: pairs, what the last step knew of them, manifolds.
 */
#include "world.h"

#include <stdlib.h>

/* The bodies as narc sees them: nothing is copied. */
static narc_bodies view_bodies(const world *w) {
    return (narc_bodies){.count = w->body_count,
                         .x = NARC_POSITION_COLUMN(w->bodies, position.x),
                         .y = NARC_POSITION_COLUMN(w->bodies, position.y),
                         .cosine = NARC_COLUMN(w->bodies, cosine),
                         .sine = NARC_COLUMN(w->bodies, sine),
                         .shape = NARC_COLUMN(w->bodies, shape)};
}

/* narc left out bodies or pairs, because a body is broken: which one? Unnoticed it would fall through the floor. */
static narc_status find_broken_body(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_status status = narc_validate_bodies(w->store, &bodies, &w->error);
    return status == NARC_OK ? world_fail(w, NARC_ERROR_NOT_FINITE, "a velocity is out of range") : status;
}

/* ------------------------------------------------------------------------------------------------ pairs */

static void *resize(void *array, size_t count, size_t size) {
    void *const resized = realloc(array, count * size);
    if (!resized)
        free(array);
    return resized;
}

static narc_status resize_pairs(world *w, size_t room) {
    w->pair_room = room;
    w->contacts = resize(w->contacts, room, sizeof *w->contacts);
    w->next_contacts = resize(w->next_contacts, room, sizeof *w->next_contacts);
    w->manifolds = resize(w->manifolds, room, sizeof *w->manifolds);
    w->overlaps = resize(w->overlaps, NARC_BIT_WORDS(room), sizeof *w->overlaps);
    w->asked = resize(w->asked, room, sizeof *w->asked);
    w->active = resize(w->active, room, sizeof *w->active);
    w->events = resize(w->events, 2 * room, sizeof *w->events); /* of each pair one, of this list and of the last */
    if (w->contacts && w->next_contacts && w->manifolds && w->overlaps && w->asked && w->active && w->events)
        return NARC_OK;
    w->pair_room = 0;
    return world_fail(w, NARC_ERROR_MEMORY, "no memory for pairs");
}

/* All pairs of bodies that come closer than the margin in this step, rotation included. Where the list is another one,
 * what is known of the pairs that were in the last is carried over; zeros for the others. */
narc_status world_update_pairs(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_pair_filter filter = {.kind = NARC_COLUMN(w->bodies, kind)};
    const narc_pair_options options = {.margin = w->settings.margin,
                                       .skin = w->settings.skin,
                                       .motion_x = NARC_COLUMN(w->bodies, motion.x),
                                       .motion_y = NARC_COLUMN(w->bodies, motion.y),
                                       .reach = NARC_COLUMN(w->bodies, turn_reach),
                                       .id = NARC_COLUMN(w->bodies, id),
                                       .filter = &filter,
                                       .workers = &w->settings.workers};
    narc_status status = narc_update_pairs(w->broad_phase, w->store, &bodies, &options, &w->list, &w->error);
    w->event_count = 0;
    if (status != NARC_OK || w->list->kept)
        return status == NARC_OK && w->list->skipped > 0 ? find_broken_body(w) : status;
    const size_t count = w->list->pairs.count;
    if (w->pair_room <= count && (status = resize_pairs(w, count + count / 2 + 1)) != NARC_OK)
        return status;
    world_end_lost_pairs(w);
    world_contact *const last = w->contacts;
    narc_gather(w->list->previous, count, sizeof *last, last, w->next_contacts);
    w->contacts = w->next_contacts;
    w->next_contacts = last;
    for (size_t k = 0; k < count; k++) {
        world_contact *c = &w->contacts[k];
        if (w->list->marks[k] & NARC_FLIPPED) /* what is known is that of (b, a) */
            *c = (world_contact){.touching = c->touching};
        c->a = w->list->pairs.a.base[k];
        c->b = w->list->pairs.b.base[k];
    }
    return w->list->skipped > 0 ? find_broken_body(w) : NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ which to ask of */

/* A pair that in this step moves by much of a body's thickness has a contact if the two could meet within it. So the
 * solver stops them where they would touch. For all pairs that would be too much: a contact at a distance is a guess at
 * the normal of the touch. */
static void find_margin(const world *w, world_contact *c) {
    const world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
    const float way = length(subtract(b->motion, a->motion)) + a->turn_reach + b->turn_reach;
    const float thickness = fminf(w->shapes[a->shape].thickness, w->shapes[b->shape].thickness);
    c->fast = way > 0.25f * thickness;
    c->margin = w->settings.margin + (c->fast ? way : 0);
}

/* Where B's point of a contact is from A's. */
static vec find_drift(const world_body *a, const world_body *b, const world_point *p) {
    return add(subtract(b->position, a->position), subtract(to_world(b, p->local_b), to_world(a, p->local_a)));
}

/* By how much have a contact's bodies moved since it was found? */
static float find_change(const world *w, const world_contact *c) {
    const world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
    const float turn_a = fabsf(cross(c->normal_in_a, to_local(a, c->normal)));
    const float turn_b = fabsf(cross(c->normal_in_b, to_local(b, c->normal)));
    const float reach = fminf(w->shapes[a->shape].reach, w->shapes[b->shape].reach);
    return length(find_drift(a, b, &c->points[0])) + fmaxf(turn_a, turn_b) * reach;
}

/* A contact of bodies that have hardly moved since it was found serves again: normal and anchors stay as they are in
 * world axes, and only its separations are new. So lever arms do not grow while a column leans a little, and the normal
 * is not now that of one body's edge and now that of the other's. A point that walks goes on from there. */
void world_recycle_contacts(world *w) {
    w->asked_count = 0;
    for (size_t k = 0; k < w->list->contact_count; k++) {
        world_contact *c = &w->contacts[w->list->contacts[k]];
        find_margin(w, c);
        if (c->point_count > 0 && !c->fast && find_change(w, c) < w->settings.recycling)
            for (unsigned i = 0; i < c->point_count; i++) {
                world_point *p = &c->points[i];
                p->separation = p->gap + dot(find_drift(&w->bodies[c->a], &w->bodies[c->b], p), c->normal);
            }
        else {
            c->point_count = 0;
            w->asked[w->asked_count++] = w->list->contacts[k];
        }
    }
}

narc_status world_find_manifolds(world *w, size_t *out_count) {
    const narc_bodies bodies = view_bodies(w);
    size_t skipped = 0;
    const narc_query query = {.margins = NARC_COLUMN(w->contacts, margin),
                              .flat_angle = w->settings.flat_angle,
                              .hints = NARC_HINT_COLUMN(w->contacts, hint),
                              .selection = NARC_ARRAY(w->asked),
                              .selection_count = w->asked_count,
                              .workers = &w->settings.workers,
                              .out_skipped = &skipped};
    const narc_status status = narc_find_manifolds(w->store, &bodies, &w->list->pairs, &query, w->manifolds,
                                                   w->pair_room, out_count, &w->error);
    return status == NARC_OK && skipped > 0 ? find_broken_body(w) : status;
}

narc_status world_find_overlaps(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_query query = {.selection = {w->list->sensors, sizeof *w->list->sensors},
                              .selection_count = w->list->sensor_count,
                              .workers = &w->settings.workers};
    return narc_find_overlaps(w->store, &bodies, &w->list->pairs, &query, w->overlaps, &w->error);
}

/* ------------------------------------------------------------------------------------------------ contacts */

/* A point starts with the impulses of the point of the last step where the same features touched. */
static void start_warm(world_point *point, const world_point last[2]) {
    const int i = last[0].feature == point->feature ? 0 : 1;
    const bool known = last[i].feature == point->feature && last[i].normal_impulse > 0;
    point->normal_impulse = known ? last[i].normal_impulse : 0;
    point->tangent_impulse = known ? last[i].tangent_impulse : 0;
}

/* The centre of the arc that touches, from the point between both surfaces; on an edge a point of it. `side` is -1 for
 * A and 1 for B. */
static vec find_center(vec anchor, float separation, float radius, float side, vec normal) {
    return add(anchor, scale(side * (0.5f * separation + (isinf(radius) ? 0 : radius)), normal));
}

static void make_contact(const world *w, world_contact *c, const narc_manifold *m) {
    const world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
    const vec to_a = subtract(a->position, b->position);
    const world_point last[2] = {c->points[0], c->points[1]};
    c->row = *m;
    c->normal = (vec){m->normal_x, m->normal_y};
    c->normal_in_a = to_local(a, c->normal);
    c->normal_in_b = to_local(b, c->normal);
    c->friction = sqrtf(a->friction * b->friction);
    c->restitution = fmaxf(a->restitution, b->restitution);
    c->point_count = m->count;
    c->points[1] = (world_point){.feature = 0}; /* where there is one point */
    for (unsigned i = 0; i < m->count; i++) {
        world_point *p = &c->points[i];
        *p = (world_point){.feature = m->point[i].feature, .gap = m->point[i].separation};
        p->anchor_a = (vec){m->point[i].x, m->point[i].y}; /* narc's points count from A's position */
        p->anchor_b = add(p->anchor_a, to_a);
        p->local_a = to_local(a, p->anchor_a);
        p->local_b = to_local(b, p->anchor_b);
        p->separation = p->gap;
        start_warm(p, last);
    }
    const world_point *p = &c->points[0];
    c->walks = m->count == 1 && !(isinf(m->radius_a) && isinf(m->radius_b));
    c->center_a = to_local(a, find_center(p->anchor_a, p->gap, m->radius_a, -1, c->normal));
    c->center_b = to_local(b, find_center(p->anchor_b, p->gap, m->radius_b, 1, c->normal));
}

/* A pair that was asked and has no manifold keeps nothing. */
void world_make_contacts(world *w, size_t count) {
    for (size_t k = 0, row = 0; k < w->asked_count; k++) {
        world_contact *c = &w->contacts[w->asked[k]];
        if (row < count && w->manifolds[row].pair == w->asked[k])
            make_contact(w, c, &w->manifolds[row++]);
        else {
            c->points[0] = c->points[1] = (world_point){.feature = 0};
            c->rolling_impulse = 0;
        }
    }
}
