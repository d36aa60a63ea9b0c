/* SPDX-License-Identifier: MIT
 *
 * world_contacts.c - from bodies to contacts: pairs, what the last step knew of them, manifolds; and bullets.
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

/* One call: pairs, with what is known of them, and the rows of those that have moved. */
narc_status world_update_contacts(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_pair_filter filter = {.kind = NARC_COLUMN(w->bodies, kind), .owner = NARC_COLUMN(w->bodies, owner)};
    const narc_step step = {.bodies = &bodies,
                            .margin = w->settings.margin,
                            .flat_angle = w->settings.flat_angle,
                            .skin = w->settings.skin,
                            .recycling = w->settings.recycling,
                            .motion_x = NARC_COLUMN(w->bodies, motion.x),
                            .motion_y = NARC_COLUMN(w->bodies, motion.y),
                            .reach = NARC_COLUMN(w->bodies, turn_reach),
                            .ahead = NARC_COLUMN(w->bodies, ahead),
                            .id = NARC_COLUMN(w->bodies, id),
                            .run = NARC_COLUMN(w->bodies, run),
                            .filter = &filter,
                            .front_only = w->platform_count > 0,
                            .workers = &w->settings.workers};
    const narc_status status = narc_update_contacts(w->contacts, w->store, &step, &w->result, &w->error);
    w->event_count = 0;
    if (status != NARC_OK)
        return status;
    world_end_lost_pairs(w);
    return w->result->count > w->pair_room ? world_fail(w, NARC_ERROR_CAPACITY, "too many pairs")
           : w->result->skipped > 0        ? find_broken_body(w)
                                           : NARC_OK;
}

/* How deep a pair may get that in this step moves by much of the thinner body: into a quarter of it. Others: 0. Where
 * such a pair could meet in this step it has a contact now. */
static void find_depth(const world *w, world_contact *c) {
    const float way = length(subtract(c->b->motion, c->a->motion)) + c->a->turn_reach + c->b->turn_reach;
    const float depth = 0.25f * smaller(w->shapes[c->a->shape].thickness, w->shapes[c->b->shape].thickness);
    c->depth = way > depth ? depth : 0;
    c->margin = w->settings.margin + (way > depth ? way : 0);
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
 * deepest two, each with its own normal. What is further away than the two may move in this step is left out. A pair without
 * a point keeps nothing. */
static void make_contact(world_contact *c, const narc_manifold *row, const narc_manifold *more, size_t more_count) {
    const world_point last[2] = {c->points[0], c->points[1]};
    c->friction = sqrtf(c->a->friction * c->b->friction);
    c->restitution = larger(c->a->restitution, c->b->restitution);
    c->point_count = 0;
    for (size_t k = 0; k <= more_count; k++, row = more++)
        for (unsigned i = 0; i < row->count; i++) {
            const bool full = c->point_count == 2;
            const size_t place = full ? c->points[1].separation > c->points[0].separation : c->point_count;
            if (row->point[i].separation < (full ? c->points[place].separation : c->margin)) {
                make_point(c, row, i, last, &c->points[place]);
                c->point_count += !full;
            }
        }
    for (unsigned i = c->point_count; i < 2; i++) {
        c->points[i].separation = INFINITY;
        c->points[i].normal_impulse = 0;
    }
    c->rolling_impulse = c->point_count > 0 ? c->rolling_impulse : 0;
}

/* Does a body pass the other one, a platform? It drops; or it was not there before, and rises, or is deeper by now than it may
 * have come from the front: narc tells of what comes from behind when its middle is in front (front_only). It passes until it
 * is clear. */
static bool passes(const world *w, const world_contact *c, const narc_manifold *row, const narc_manifold *more,
                   size_t more_count) {
    const vec motion = subtract(c->b->motion, c->a->motion), normal = {row->normal_x, row->normal_y};
    const float way = length(motion) + c->a->turn_reach + c->b->turn_reach;
    float nearest = INFINITY;
    if (c->a->platform + c->b->platform == 0 || row->count == 0)
        return false;
    for (size_t k = 0; k <= more_count; k++, row = more++)
        for (unsigned i = 0; i < row->count; i++)
            nearest = smaller(nearest, row->point[i].separation);
    const bool is_new = c->point_count == 0 && (dot(motion, normal) > 0 || nearest < -w->settings.margin - way);
    return c->a->drops || c->b->drops || ((c->passes || is_new) && nearest < 0);
}

/* Has the normal of a row that followed its bodies turned? They turned together, as in a column that falls over. */
static bool has_turned(const world *w, const world_contact *c, const narc_manifold *row) {
    const vec turned = subtract((vec){row->normal_x, row->normal_y}, c->points[0].normal);
    return length(turned) * smaller(w->shapes[c->a->shape].reach, w->shapes[c->b->shape].reach) >=
           w->settings.recycling;
}

/* A contact whose row was kept, or followed its bodies, serves again: normal and anchors stay as they are in world axes, and
 * the solver finds its separations. So lever arms do not grow while a column leans a little, and the normal is not now that
 * of one body's edge and now that of the other's. A point that walks goes on from there. */
void world_make_contacts(world *w) {
    const narc_step_result *const r = w->result;
    const narc_manifold *more = r->more, *const end = more + r->more_count;
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        world_contact *const c = world_contact_of(w, k);
        const narc_manifold *const first = more;
        c->a = &w->bodies[r->pairs.a.base[slot]];
        c->b = &w->bodies[r->pairs.b.base[slot]];
        while (more < end && more->pair == slot)
            more++;
        if (r->state[slot] & NARC_TURNED) /* what is known is that of (b, a) */
            *c = (world_contact){.a = c->a, .b = c->b, .touching = c->touching, .passes = c->passes};
        find_depth(w, c);
        const narc_manifold *const row = &r->manifolds[slot];
        const size_t more_count = (size_t)(more - first);
        const bool passed = c->passes;
        c->passes = passes(w, c, row, first, more_count);
        if (c->passes)
            make_contact(c, &(narc_manifold){.count = 0}, NULL, 0);
        else if (passed || r->state[slot] & NARC_ASKED || (r->state[slot] & NARC_FOLLOWED && has_turned(w, c, row)))
            make_contact(c, row, first, more_count);
    }
}

static narc_body before(const world_body *body) {
    return (narc_body){(double)body->from.x, (double)body->from.y, body->from_rotation.x, body->from_rotation.y, 1,
                       body->shape};
}

/* Bodies that were deeper before may get hardly deeper; else the solver sees to them. */
narc_status world_stop_bullets(world *w) {
    const world_body *const end = w->bodies + w->body_count;
    for (world_body *body = w->bodies; body < end + w->ground_count; body++)
        body->motion = subtract(body->position, body->from);
    for (size_t k = 0; k < w->result->count; k++) {
        const world_contact *const c = world_contact_of(w, k);
        const float deepest = smaller(c->points[0].separation, c->points[1].separation);
        const narc_body a = before(c->a), b = before(c->b);
        const narc_motion motion_a = {c->a->motion.x, c->a->motion.y, c->a->turn},
                          motion_b = {c->b->motion.x, c->b->motion.y, c->b->turn};
        const narc_cast_options options = {.target = -larger(c->depth, 0.03f * c->depth - deepest),
                                           .tolerance = 0.01f * c->depth,
                                           .front_only = w->platform_count > 0};
        narc_impact hit = {.count = 0};
        if (c->depth > 0 && !c->passes &&
            narc_cast_pair(w->store, &a, &motion_a, &b, &motion_b, &options, &hit, &w->error) != NARC_OK)
            return w->error.status;
        if (hit.count > 0)
            c->a->stop = c->b->stop = smaller(hit.fraction, smaller(c->a->stop, c->b->stop));
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
