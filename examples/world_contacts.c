/* SPDX-License-Identifier: MIT
 *
 * world_contacts.c - from bodies to contacts: pairs, what the last step knew of them, manifolds.
 */
#include <string.h>

#include "world.h"

/* The bodies as narc sees them: nothing is copied. */
static narc_bodies view_bodies(const world *w) {
    return (narc_bodies){.count = w->body_count + w->ground_count,
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

/* All pairs of bodies that come closer than the margin in this step, rotation included. Where the list is another one,
 * what is known of the pairs that were in the last is carried over; zeros for the others. */
narc_status world_update_pairs(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_pair_filter filter = {.kind = NARC_COLUMN(w->bodies, kind), .group = NARC_COLUMN(w->bodies, group)};
    const narc_pair_options options = {.margin = w->settings.margin,
                                       .skin = w->settings.skin,
                                       .motion_x = NARC_COLUMN(w->bodies, motion.x),
                                       .motion_y = NARC_COLUMN(w->bodies, motion.y),
                                       .reach = NARC_COLUMN(w->bodies, turn_reach),
                                       .id = NARC_COLUMN(w->bodies, id),
                                       .filter = &filter,
                                       .workers = &w->settings.workers};
    const narc_status status = narc_update_pairs(w->broad_phase, w->store, &bodies, &options, &w->list, &w->error);
    w->event_count = 0;
    if (status != NARC_OK || w->list->kept)
        return status == NARC_OK && w->list->skipped > 0 ? find_broken_body(w) : status;
    const size_t count = w->list->pairs.count;
    if (count > w->pair_room)
        return world_fail(w, NARC_ERROR_CAPACITY, "too many pairs");
    world_end_lost_pairs(w);
    world_contact *const last = w->contacts;
    narc_gather(w->list->previous, count, sizeof *last, last, w->next_contacts);
    w->contacts = w->next_contacts;
    w->next_contacts = last;
    for (size_t k = 0; k < count; k++) {
        world_contact *c = &w->contacts[k];
        if (w->list->marks[k] & NARC_FLIPPED) /* what is known is that of (b, a) */
            *c = (world_contact){.touching = c->touching};
        c->a = &w->bodies[w->list->pairs.a.base[k]];
        c->b = &w->bodies[w->list->pairs.b.base[k]];
        if (w->list->previous[k] == NARC_NO_MATCH)
            c->a->stood.x = INFINITY; /* its contacts with the ground are found anew */
    }
    return w->list->skipped > 0 ? find_broken_body(w) : NARC_OK;
}

/* How deep a pair may get that in this step moves by much of the thinner body: into a quarter of it. Others: 0. Where
 * such a pair could meet in this step it has a contact now. */
static void find_depth(const world *w, world_contact *c) {
    const float way = length(subtract(c->b->motion, c->a->motion)) + c->a->turn_reach + c->b->turn_reach;
    const float depth = 0.25f * fminf(w->shapes[c->a->shape].thickness, w->shapes[c->b->shape].thickness);
    c->depth = way > depth ? depth : 0;
    c->margin = w->settings.margin + (way > depth ? way : 0);
}

/* By how much have a contact's bodies moved since it was found? */
static float find_change(const world *w, const world_contact *c) {
    const world_point *p = &c->points[0];
    const float turn_a = fabsf(cross(p->normal_in_a, to_local(c->a, p->normal)));
    const float turn_b = fabsf(cross(p->normal_in_b, to_local(c->b, p->normal)));
    const float reach = fminf(w->shapes[c->a->shape].reach, w->shapes[c->b->shape].reach);
    return length(subtract(find_span(c, p), c->span)) + fmaxf(turn_a, turn_b) * reach;
}

/* By how much has a body moved since its contacts with the ground were found? They are found or serve again together:
 * what several entries tell of a body is merged. */
static float find_way(const world *w, const world_body *body) {
    const float turn = fabsf(cross(body->stood_rotation, (vec){body->cosine, body->sine}));
    return length(subtract(body->position, body->stood)) + turn * w->shapes[body->shape].reach;
}

/* A contact of bodies that have hardly moved since it was found serves again: normal and anchors stay as they are in
 * world axes, and only its separations are new. So lever arms do not grow while a column leans a little, and the normal
 * is not now that of one body's edge and now that of the other's. A point that walks goes on from there. */
void world_recycle_contacts(world *w) {
    w->asked_count = 0;
    for (size_t k = 0; k < w->list->contact_count; k++) {
        world_contact *c = &w->contacts[w->list->contacts[k]];
        find_depth(w, c);
        const bool on_ground = c->b >= w->bodies + w->body_count;
        if (c->depth == 0 && (on_ground || c->point_count > 0) &&
            (on_ground ? find_way(w, c->a) : find_change(w, c)) < w->settings.recycling)
            continue;
        w->asked[w->asked_count++] = w->list->contacts[k];
    }
}

narc_status world_find_manifolds(world *w) {
    const narc_bodies bodies = view_bodies(w);
    size_t skipped = 0;
    const narc_query query = {.margins = NARC_COLUMN(w->contacts, margin),
                              .flat_angle = w->settings.flat_angle,
                              .hints = NARC_HINT_COLUMN(w->contacts, hint),
                              .selection = NARC_ARRAY(w->asked),
                              .selection_count = w->asked_count,
                              .workers = &w->settings.workers,
                              .out_skipped = &skipped};
    const narc_status status = narc_find_manifolds(w->store, &bodies, &w->list->pairs, &query, w->rows,
                                                   2 * w->pair_room, &w->row_count, &w->error);
    if (status == NARC_OK && w->ground_count > 0)
        w->row_count = narc_merge_manifolds(&w->list->pairs, NARC_COLUMN(w->bodies, run), w->rows, w->row_count);
    return status == NARC_OK && skipped > 0 ? find_broken_body(w) : status;
}

narc_status world_find_overlaps(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_query query = {.selection = {w->list->sensors, sizeof *w->list->sensors},
                              .selection_count = w->list->sensor_count,
                              .workers = &w->settings.workers};
    return narc_find_overlaps(w->store, &bodies, &w->list->pairs, &query, w->overlaps, &w->error);
}

/* What the solver wants of a point of narc's row. A point starts with the impulses of that of the last step where the
 * same features touched. */
static void make_point(const world_contact *c, const narc_manifold *m, unsigned i, const world_point last[2],
                       world_point *p) {
    const world_body *a = c->a, *b = c->b;
    const float half = 0.5f * m->point[i].separation;
    p->feature = m->point[i].feature;
    p->edge_a = isinf(m->radius_a);
    p->edge_b = isinf(m->radius_b);
    p->walks = m->count == 1 && !(p->edge_a && p->edge_b);
    p->normal = (vec){m->normal_x, m->normal_y};
    p->normal_in_a = to_local(a, p->normal);
    p->normal_in_b = to_local(b, p->normal);
    p->radius_a = p->walks && !p->edge_a ? m->radius_a : 0;
    p->radius_b = p->walks && !p->edge_b ? m->radius_b : 0;
    memcpy(p->reach_a, m->reach_a, sizeof p->reach_a);
    memcpy(p->reach_b, m->reach_b, sizeof p->reach_b);
    p->separation = m->point[i].separation;
    p->anchor_a = (vec){m->point[i].x, m->point[i].y}; /* narc's points count from A's position */
    p->anchor_b = add(p->anchor_a, subtract(a->position, b->position));
    p->local_a = to_local(a, subtract(p->anchor_a, scale(half + p->radius_a, p->normal)));
    p->local_b = to_local(b, add(p->anchor_b, scale(half + p->radius_b, p->normal)));
    const world_point *const same = &last[last[0].feature == p->feature ? 0 : 1];
    const bool warm = same->feature == p->feature && same->normal_impulse > 0;
    p->normal_impulse = warm ? same->normal_impulse : 0;
    p->tangent_impulse = warm ? same->tangent_impulse : 0;
}

/* A contact of all rows of its pair: two points of one row, or of what touches a concave arc in several places the
 * deepest two, each with its own normal. A pair without a point keeps nothing. */
static void make_contact(world_contact *c, const narc_manifold *rows, size_t count) {
    const world_point last[2] = {c->points[0], c->points[1]};
    c->friction = sqrtf(c->a->friction * c->b->friction);
    c->restitution = fmaxf(c->a->restitution, c->b->restitution);
    c->point_count = 0;
    for (const narc_manifold *row = rows; row < rows + count; row++)
        for (unsigned i = 0; i < row->count; i++) {
            const bool full = c->point_count == 2;
            const size_t place = full ? c->points[1].separation > c->points[0].separation : c->point_count++;
            if (!full || row->point[i].separation < c->points[place].separation)
                make_point(c, row, i, last, &c->points[place]);
        }
    for (unsigned i = c->point_count; i < 2; i++) {
        c->points[i].separation = INFINITY;
        c->points[i].normal_impulse = 0;
    }
    c->rolling_impulse = count > 0 ? c->rolling_impulse : 0;
    c->span = find_span(c, &c->points[0]);
    c->a->stood = c->a->position;
    c->a->stood_rotation = (vec){c->a->cosine, c->a->sine};
}

void world_make_contacts(world *w) {
    const narc_manifold *row = w->rows, *const end = row + w->row_count;
    for (size_t k = 0; k < w->asked_count; k++) {
        const narc_manifold *const first = row;
        while (row < end && row->pair == w->asked[k])
            row++;
        make_contact(&w->contacts[w->asked[k]], first, (size_t)(row - first));
    }
}

/* Bodies that were deeper before may get hardly deeper; else the solver sees to them. */
narc_status world_stop_bullets(world *w) {
    const world_body *all = w->bodies, *end = all + w->body_count;
    const narc_motions motions = {
        NARC_COLUMN(all, motion.x), NARC_COLUMN(all, motion.y), NARC_COLUMN(all, turn), {NULL}};
    narc_bodies before = view_bodies(w);
    before.x = NARC_POSITION_COLUMN(all, from.x);
    before.y = NARC_POSITION_COLUMN(all, from.y);
    before.cosine = NARC_COLUMN(all, from_rotation.x);
    before.sine = NARC_COLUMN(all, from_rotation.y);
    for (world_body *body = w->bodies; body < end; body++)
        body->motion = subtract(body->position, body->from);
    for (size_t k = 0; k < w->list->contact_count; k++) {
        const uint32_t pair = w->list->contacts[k];
        const world_contact *c = &w->contacts[pair];
        const float deepest = fminf(c->points[0].separation, c->points[1].separation);
        const narc_pairs one = {
            .count = 1, .a = {w->list->pairs.a.base + pair, 0}, .b = {w->list->pairs.b.base + pair, 0}};
        const narc_cast_options options = {.target = -fmaxf(c->depth, 0.03f * c->depth - deepest),
                                           .tolerance = 0.01f * c->depth};
        narc_impact hit = {.count = 0};
        if (c->depth > 0 &&
            narc_cast_pairs(w->store, &before, &motions, &one, NULL, &options, &hit, 1, &w->error) != NARC_OK)
            return w->error.status;
        if (hit.count > 0)
            c->a->stop = c->b->stop = fminf(hit.fraction, fminf(c->a->stop, c->b->stop));
    }
    for (world_body *body = w->bodies; body < end; body++)
        if (body->stop < 1) {
            const float turn = body->stop * body->turn;
            body->position = add(body->from, scale(body->stop, body->motion));
            narc_compute_poses(&turn, 1, &body->cosine, &body->sine, NULL);
            const vec rotation = to_world(body, body->from_rotation);
            body->cosine = rotation.x;
            body->sine = rotation.y;
        }
    return NARC_OK;
}
