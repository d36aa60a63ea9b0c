/* SPDX-License-Identifier: MIT
 *
 * world_solver.c - from contacts to velocities and positions: sequential impulses in sub-steps, with soft contacts.
 *
 * A sub-step turns forces into velocities, corrects these by impulses at the contacts, and moves the bodies. An overlap
 * is pushed out as by a damped spring; then the bodies have moved, and the speed of pushing is taken out again
 * ("relaxing"). This is the solver of Box2D 3 ("Solver2D", E. Catto 2024; soft constraints: Catto 2011; sub-steps:
 * Macklin and others 2019). Contacts are found once a step: between sub-steps a contact's points stay with the bodies.
 */
#include "world.h"

static const float pi = 3.14159265f;
static const float spring_damping = 3;    /* of contacts: above critical, 1 */
static const float greatest_turn = 1.57f; /* radians in a step, for which contacts are found once */
static const float greatest_push = 3;     /* m/s: what overlaps deeply parts slowly */
static const float least_bounce = 1;      /* m/s: what meets more slowly does not bounce */

/* A damped spring that is stable with any time step: how much of the error is removed as velocity, which part of the
 * impulse counts, and how much of the impulse so far is given up. */
typedef struct spring {
    float rate, strength, loss;
} spring;

static const spring rigid = {0, 1, 0};

static spring make_spring(float hertz, float time) {
    const float omega = 2 * pi * hertz, a = 2 * spring_damping + time * omega, b = time * omega * a;
    return (spring){omega / a, b / (1 + b), 1 / (1 + b)};
}

/* The speed of B's point relative to A's. */
static vec find_velocity(const world_contact *c, const world_point *p) {
    return subtract(add(c->b->velocity, scale(c->b->spin, quarter_turn(p->anchor_b))),
                    add(c->a->velocity, scale(c->a->spin, quarter_turn(p->anchor_a))));
}

static float find_separation(const world_contact *c, const world_point *p) {
    return dot(find_span(c, p), p->normal) - (p->radius_a + p->radius_b);
}

/* The impulse that changes the speed along a direction by 1. */
static float find_mass(const world_contact *c, const world_point *p, vec direction) {
    const float turn_a = cross(p->anchor_a, direction), turn_b = cross(p->anchor_b, direction);
    return 1 / (c->a->inverse_mass + c->b->inverse_mass + c->a->inverse_inertia * turn_a * turn_a +
                c->b->inverse_inertia * turn_b * turn_b);
}

static void apply(const world_contact *c, const world_point *p, vec impulse) {
    c->a->velocity = subtract(c->a->velocity, scale(c->a->inverse_mass, impulse));
    c->a->spin -= c->a->inverse_inertia * cross(p->anchor_a, impulse);
    c->b->velocity = add(c->b->velocity, scale(c->b->inverse_mass, impulse));
    c->b->spin += c->b->inverse_inertia * cross(p->anchor_b, impulse);
}

static void apply_rotation(const world_contact *c, float impulse) {
    c->a->spin -= c->a->inverse_inertia * impulse;
    c->b->spin += c->b->inverse_inertia * impulse;
}

/* The impulse along the normal becomes another one, which pushes or is 0. */
static void change_normal_impulse(const world_contact *c, world_point *p, float change) {
    const float impulse = larger(0, p->normal_impulse + change);
    apply(c, p, scale(impulse - p->normal_impulse, p->normal));
    p->normal_impulse = impulse;
    p->greatest_impulse = larger(p->greatest_impulse, impulse);
}

static void prepare(world_contact *c) {
    for (unsigned i = 0; i < c->point_count; i++) {
        world_point *p = &c->points[i];
        p->normal_mass = find_mass(c, p, p->normal);
        p->tangent_mass = find_mass(c, p, quarter_turn(p->normal));
        p->separation = find_separation(c, p);
        p->approach = -dot(find_velocity(c, p), p->normal);
        p->greatest_impulse = 0;
    }
}

/* Does a normal stay in the fan of an arc's normals when the body of that arc has it turned from `first` to `normal`?
 * Reaches are rounded down. */
static bool is_in_fan(vec first, vec normal, const uint16_t reach[2]) {
    const float sine = cross(first, normal) * (float)NARC_REACH_ONE;
    return dot(first, normal) > 0 && -sine <= (float)reach[0] + 1 && sine <= (float)reach[1] + 1;
}

/* While bodies roll, the point where two arcs touch walks along them, and the normal is that of their centres; on an
 * edge it is the edge's. Where one of the arcs ends, the contact stays with the bodies until the next step. */
static void walk(const world_contact *c, world_point *p) {
    const vec to_b = subtract(c->b->position, c->a->position), way = find_span(c, p);
    const vec normal = p->edge_a   ? to_world(c->a, p->normal_in_a)
                       : p->edge_b ? to_world(c->b, p->normal_in_b)
                                   : scale(1 / copysignf(length(way), dot(way, p->normal)), way);
    if (!is_in_fan(p->normal_in_a, to_local(c->a, normal), p->reach_a) ||
        !is_in_fan(p->normal_in_b, to_local(c->b, normal), p->reach_b))
        return;
    p->normal = normal;
    const float half = 0.5f * find_separation(c, p);
    p->anchor_a = p->edge_a ? subtract(add(to_b, to_world(c->b, p->local_b)), scale(p->radius_b + half, normal))
                            : add(to_world(c->a, p->local_a), scale(p->radius_a + half, normal));
    p->anchor_b = subtract(p->anchor_a, to_b);
    p->normal_mass = find_mass(c, p, normal);
    p->tangent_mass = find_mass(c, p, quarter_turn(normal));
}

/* The impulses of the last sub-step again. */
static void warm_start(const world_contact *c) {
    apply_rotation(c, c->rolling_impulse);
    for (unsigned i = 0; i < c->point_count; i++) {
        const world_point *p = &c->points[i];
        const vec along = scale(p->normal_impulse, p->normal);
        apply(c, p, add(along, scale(p->tangent_impulse, quarter_turn(p->normal))));
    }
}

/* A pin pulls along both axes, as the spring says. */
static void pull(const world_contact *joint, world_point *p, vec axis, const spring *soft, float *impulse) {
    const float wanted = dot(find_velocity(joint, p), axis) + soft->rate * dot(find_span(joint, p), axis);
    const float change = -find_mass(joint, p, axis) * soft->strength * wanted - soft->loss * *impulse;
    apply(joint, p, scale(change, axis));
    *impulse += change;
}

static void solve_joints(world *w, const spring *soft) {
    for (world_contact *joint = w->joints; joint < w->joints + w->joint_count; joint++) {
        world_point *p = joint->points;
        p->anchor_a = to_world(joint->a, p->local_a);
        p->anchor_b = to_world(joint->b, p->local_b);
        pull(joint, p, p->normal, soft, &p->normal_impulse);
        pull(joint, p, quarter_turn(p->normal), soft, &p->tangent_impulse);
    }
}

/* As friction, but against rotation. Without it what rolls or rocks would do so for ever. */
static void solve_rolling(world_contact *c, float arm) {
    const float limit = arm * (c->points[0].normal_impulse + c->points[1].normal_impulse);
    const float spin = c->b->spin - c->a->spin, inverse_inertia = c->a->inverse_inertia + c->b->inverse_inertia;
    const float impulse = larger(-limit, smaller(c->rolling_impulse - spin / inverse_inertia, limit));
    apply_rotation(c, impulse - c->rolling_impulse);
    c->rolling_impulse = impulse;
}

/* Coulomb: no more than friction times the normal impulse. */
static void solve_friction(const world_contact *c, world_point *p) {
    const vec tangent = quarter_turn(p->normal);
    const float limit = c->friction * p->normal_impulse;
    const float wanted = p->tangent_impulse - p->tangent_mass * dot(find_velocity(c, p), tangent);
    const float impulse = larger(-limit, smaller(wanted, limit));
    apply(c, p, scale(impulse - p->tangent_impulse, tangent));
    p->tangent_impulse = impulse;
}

/* Points that are apart may come together within the sub-step, and no further. Those that overlap are pushed apart as
 * the spring says. */
static void solve_normal(const world_contact *c, world_point *p, const spring *soft, float time) {
    const float separation = find_separation(c, p), speed = dot(find_velocity(c, p), p->normal);
    if (separation > 0)
        change_normal_impulse(c, p, -p->normal_mass * (speed + separation / time));
    else {
        const float wanted = speed + larger(soft->rate * separation, -greatest_push);
        change_normal_impulse(c, p, -p->normal_mass * soft->strength * wanted - soft->loss * p->normal_impulse);
    }
}

/* One round over all contacts, in the order of the pairs: the same bits however narc spread its work. */
static void solve_contacts(world *w, const spring *soft, float time, bool relax) {
    solve_joints(w, soft);
    for (size_t k = 0; k < w->active_count; k++) {
        world_contact *c = w->active[k];
        if (relax)
            solve_rolling(c, w->settings.rolling_arm);
        for (unsigned i = 0; i < c->point_count && relax; i++) {
            if (c->points[i].walks) /* the bodies have moved */
                walk(c, &c->points[i]);
            solve_friction(c, &c->points[i]);
        }
        for (unsigned i = 0; i < c->point_count; i++)
            solve_normal(c, &c->points[i], soft, time);
    }
}

static void integrate_velocities(world *w, float time) {
    const float limit = greatest_turn / w->settings.time_step;
    for (size_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        if (body->inverse_mass == 0 || body->kind & NARC_ASLEEP)
            continue;
        body->velocity = add(body->velocity, scale(time, w->settings.gravity));
        body->spin = larger(-limit, smaller(body->spin, limit));
    }
}

static void integrate_positions(world *w, float time) {
    for (size_t k = 0; k < w->body_count + w->ground_count; k++) {
        world_body *body = &w->bodies[k];
        const bool rests = body->velocity.x == 0 && body->velocity.y == 0;
        if (body->kind & NARC_ASLEEP || (body->kind & NARC_STATIC && (rests || body->platform == 0)))
            continue;
        const float turn = time * body->spin;
        const float cosine = body->cosine - turn * body->sine, sine = body->sine + turn * body->cosine;
        const float size = length((vec){cosine, sine});
        body->turn += turn;
        body->position = add(body->position, scale(time, body->velocity));
        body->cosine = cosine / size;
        body->sine = sine / size;
    }
}

/* What met fast enough and was pressed goes apart again. */
static void bounce(const world_contact *c, world_point *p) {
    if (c->restitution > 0 && p->approach > least_bounce && p->greatest_impulse > 0)
        change_normal_impulse(c, p,
                              -p->normal_mass * (dot(find_velocity(c, p), p->normal) - c->restitution * p->approach));
}

void world_solve(world *w) {
    const float time = w->settings.time_step / (float)w->settings.substeps;
    const spring soft = make_spring(w->settings.spring_rate / time, time);
    for (size_t k = 0; k < w->active_count; k++)
        prepare(w->active[k]);
    for (unsigned step = 0; step < w->settings.substeps; step++) {
        integrate_velocities(w, time);
        for (size_t k = 0; k < w->joint_count; k++)
            warm_start(&w->joints[k]);
        for (size_t k = 0; k < w->active_count; k++)
            warm_start(w->active[k]);
        solve_contacts(w, &soft, time, false);
        integrate_positions(w, time);
        solve_contacts(w, &rigid, time, true);
    }
    for (size_t k = 0; k < w->active_count; k++)
        for (unsigned i = 0; i < w->active[k]->point_count; i++)
            bounce(w->active[k], &w->active[k]->points[i]);
}
