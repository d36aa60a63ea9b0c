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
static vec find_velocity(const world_body *a, const world_body *b, const world_point *p) {
    return subtract(add(b->velocity, scale(b->spin, quarter_turn(p->anchor_b))),
                    add(a->velocity, scale(a->spin, quarter_turn(p->anchor_a))));
}

/* How far it has moved relative to A's since the contacts were found. */
static vec find_movement(const world_body *a, const world_body *b, const world_point *p) {
    return subtract(add(b->moved, scale(b->turned, quarter_turn(p->anchor_b))),
                    add(a->moved, scale(a->turned, quarter_turn(p->anchor_a))));
}

/* The impulse that changes the speed along a direction by 1. */
static float find_mass(const world_body *a, const world_body *b, const world_point *p, vec direction) {
    const float turn_a = cross(p->anchor_a, direction), turn_b = cross(p->anchor_b, direction);
    return 1 / (a->inverse_mass + b->inverse_mass + a->inverse_inertia * turn_a * turn_a +
                b->inverse_inertia * turn_b * turn_b);
}

static void apply(world_body *a, world_body *b, const world_point *p, vec impulse) {
    a->velocity = subtract(a->velocity, scale(a->inverse_mass, impulse));
    a->spin -= a->inverse_inertia * cross(p->anchor_a, impulse);
    b->velocity = add(b->velocity, scale(b->inverse_mass, impulse));
    b->spin += b->inverse_inertia * cross(p->anchor_b, impulse);
}

static void apply_rotation(world_body *a, world_body *b, float impulse) {
    a->spin -= a->inverse_inertia * impulse;
    b->spin += b->inverse_inertia * impulse;
}

static void prepare(world *w) {
    for (size_t k = 0; k < w->active_count; k++) {
        world_contact *c = &w->contacts[w->active[k]];
        const world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
        for (unsigned i = 0; i < c->point_count; i++) {
            world_point *p = &c->points[i];
            p->normal_mass = find_mass(a, b, p, c->normal);
            p->tangent_mass = find_mass(a, b, p, quarter_turn(c->normal));
            p->approach = -dot(find_velocity(a, b, p), c->normal);
            p->greatest_impulse = 0;
        }
    }
}

/* Does a normal stay in the fan of an arc's normals when the body of that arc has it turned from `first` to `normal`?
 * Reaches are rounded down. */
static bool is_in_fan(vec first, vec normal, const uint16_t reach[2]) {
    const float sine = cross(first, normal) * (float)NARC_REACH_ONE;
    return dot(first, normal) > 0 && -sine <= (float)reach[0] + 1 && sine <= (float)reach[1] + 1;
}

/* While bodies roll, the point where two arcs touch walks along them, and the normal is that of their centres; on an
 * edge it is the edge's. Where one of the arcs ends, the contact stays with the bodies until the next step. Fast bodies
 * stay where they are, too: next touches what nobody knows before that, and they could turn right through each other.
 * They lose time, and no momentum. */
static void walk(world_body *a, world_body *b, world_contact *c) {
    const vec between = subtract(b->position, a->position);
    const vec center_a = to_world(a, c->center_a), center_b = to_world(b, c->center_b);
    const vec way = add(between, subtract(center_b, center_a));
    const bool edge_a = isinf(c->row.radius_a), edge_b = isinf(c->row.radius_b);
    const float radius_a = edge_a ? 0 : c->row.radius_a, radius_b = edge_b ? 0 : c->row.radius_b;
    const float distance = copysignf(length(way), dot(way, c->normal));
    const vec normal = edge_a   ? to_world(a, c->normal_in_a)
                       : edge_b ? to_world(b, c->normal_in_b)
                                : scale(1 / distance, way);
    if (!is_in_fan(c->normal_in_a, to_local(a, normal), c->row.reach_a) ||
        !is_in_fan(c->normal_in_b, to_local(b, normal), c->row.reach_b)) {
        if (c->fast && c->points[0].greatest_impulse > 0)
            a->stopped = b->stopped = true;
        return;
    }
    world_point *p = &c->points[0];
    const float separation = dot(way, normal) - radius_a - radius_b;
    c->normal = normal;
    if (!edge_a) {
        p->anchor_a = add(center_a, scale(radius_a + 0.5f * separation, normal));
        p->anchor_b = subtract(p->anchor_a, between);
    } else {
        p->anchor_b = subtract(center_b, scale(radius_b + 0.5f * separation, normal));
        p->anchor_a = add(p->anchor_b, between);
    }
    p->separation = separation - dot(find_movement(a, b, p), normal);
    p->normal_mass = find_mass(a, b, p, normal);
    p->tangent_mass = find_mass(a, b, p, quarter_turn(normal));
}

/* The impulses of the last sub-step again, where the points are now. */
static void warm_start(world *w) {
    for (size_t k = 0; k < w->active_count; k++) {
        world_contact *c = &w->contacts[w->active[k]];
        world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
        if (c->walks)
            walk(a, b, c);
        apply_rotation(a, b, c->rolling_impulse);
        for (unsigned i = 0; i < c->point_count; i++) {
            const world_point *p = &c->points[i];
            const vec along = scale(p->normal_impulse, c->normal);
            apply(a, b, p, add(along, scale(p->tangent_impulse, quarter_turn(c->normal))));
        }
    }
}

/* As friction, but against rotation. Without it what rolls or rocks would do so for ever. */
static void solve_rolling(world_contact *c, world_body *a, world_body *b, float arm) {
    const float limit = arm * (c->points[0].normal_impulse + c->points[1].normal_impulse);
    const float wanted = c->rolling_impulse - (b->spin - a->spin) / (a->inverse_inertia + b->inverse_inertia);
    const float impulse = fmaxf(-limit, fminf(wanted, limit));
    apply_rotation(a, b, impulse - c->rolling_impulse);
    c->rolling_impulse = impulse;
}

/* Coulomb: no more than friction times the normal impulse. */
static void solve_friction(world_contact *c, world_body *a, world_body *b, world_point *p) {
    const vec tangent = quarter_turn(c->normal);
    const float limit = c->friction * p->normal_impulse;
    const float wanted = p->tangent_impulse - p->tangent_mass * dot(find_velocity(a, b, p), tangent);
    const float impulse = fmaxf(-limit, fminf(wanted, limit));
    apply(a, b, p, scale(impulse - p->tangent_impulse, tangent));
    p->tangent_impulse = impulse;
}

/* Points that are apart may come together within the sub-step, and no further. Those that overlap are pushed apart as
 * the spring says. */
static void solve_normal(world_contact *c, world_body *a, world_body *b, world_point *p, const spring *soft,
                         float time) {
    const float separation = p->separation + dot(find_movement(a, b, p), c->normal);
    const float speed = dot(find_velocity(a, b, p), c->normal);
    float change;
    if (separation > 0)
        change = -p->normal_mass * (speed + separation / time);
    else
        change = -p->normal_mass * soft->strength * (speed + fmaxf(soft->rate * separation, -greatest_push)) -
                 soft->loss * p->normal_impulse;
    const float impulse = fmaxf(0, p->normal_impulse + change);
    apply(a, b, p, scale(impulse - p->normal_impulse, c->normal));
    p->normal_impulse = impulse;
    p->greatest_impulse = fmaxf(p->greatest_impulse, impulse);
}

/* One round over all contacts, in the order of the pairs: the same bits however narc spread its work. */
static void solve_contacts(world *w, const spring *soft, float time, bool friction) {
    for (size_t k = 0; k < w->active_count; k++) {
        world_contact *c = &w->contacts[w->active[k]];
        world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
        if (friction)
            solve_rolling(c, a, b, w->settings.rolling_arm);
        for (unsigned i = 0; i < c->point_count && friction; i++)
            solve_friction(c, a, b, &c->points[i]);
        for (unsigned i = 0; i < c->point_count; i++)
            solve_normal(c, a, b, &c->points[i], soft, time);
    }
}

static void integrate_velocities(world *w, float time) {
    const float limit = greatest_turn / w->settings.time_step;
    for (size_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        if (body->inverse_mass == 0 || body->kind & NARC_ASLEEP)
            continue;
        body->velocity = add(body->velocity, scale(time, w->settings.gravity));
        body->spin = fmaxf(-limit, fminf(body->spin, limit));
    }
}

static void integrate_positions(world *w, float time) {
    for (size_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        if (body->kind & (NARC_STATIC | NARC_ASLEEP) || body->stopped)
            continue;
        const vec way = scale(time, body->velocity);
        const float turn = time * body->spin;
        const float cosine = body->cosine - turn * body->sine, sine = body->sine + turn * body->cosine;
        const float size = length((vec){cosine, sine});
        body->position = add(body->position, way);
        body->moved = add(body->moved, way);
        body->turned += turn;
        body->cosine = cosine / size;
        body->sine = sine / size;
    }
}

/* What met fast enough and was pressed goes apart again. */
static void bounce(world *w) {
    for (size_t k = 0; k < w->active_count; k++) {
        world_contact *c = &w->contacts[w->active[k]];
        world_body *a = &w->bodies[c->a], *b = &w->bodies[c->b];
        for (unsigned i = 0; i < c->point_count; i++) {
            world_point *p = &c->points[i];
            if (c->restitution == 0 || p->approach < least_bounce || p->greatest_impulse == 0)
                continue;
            const float speed = dot(find_velocity(a, b, p), c->normal);
            const float change = -p->normal_mass * (speed - c->restitution * p->approach);
            const float impulse = fmaxf(0, p->normal_impulse + change);
            apply(a, b, p, scale(impulse - p->normal_impulse, c->normal));
            p->normal_impulse = impulse;
        }
    }
}

void world_solve(world *w) {
    const float time = w->settings.time_step / (float)w->settings.substeps;
    const spring soft = make_spring(w->settings.spring_rate / time, time);
    prepare(w);
    for (unsigned step = 0; step < w->settings.substeps; step++) {
        integrate_velocities(w, time);
        warm_start(w);
        solve_contacts(w, &soft, time, false);
        integrate_positions(w, time);
        solve_contacts(w, &rigid, time, true);
    }
    bounce(w);
}
