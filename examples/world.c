/* SPDX-License-Identifier: MIT
 *
 * world.c - from bodies to contacts: pairs, what the last step knew of them, manifolds.
 */
#include "world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const world_settings world_defaults = {
    .gravity = {0, -9.81f},
    .time_step = 1 / 60.0f,
    .substeps = 8,
    .rolling_arm = 0.005f,
    .margin = 0.02f,
    .skin = 0.02f,
    .flat_angle = NARC_FLAT_ANGLE,
    .threads = 1,
};

/* ------------------------------------------------------------------------------------------------ memory */

static narc_status fail(world *w, narc_status status, const char *message) {
    w->error = (narc_error){.status = status};
    strncpy(w->error.message, message, sizeof w->error.message - 1);
    return status;
}

narc_status world_create(world *w, world_settings settings, size_t capacity) {
    *w = (world){.settings = settings, .capacity = capacity};
    w->shapes = calloc(capacity, sizeof *w->shapes);
    w->bodies = calloc(capacity, sizeof *w->bodies);
    if (!w->shapes || !w->bodies || narc_create_shapes(NULL, &w->store) != NARC_OK ||
        narc_create_broad_phase(NULL, &w->broad_phase) != NARC_OK)
        return fail(w, NARC_ERROR_MEMORY, "no memory for a world");
    return NARC_OK;
}

/* An array of zeros in place of an old one. */
static void *renew(void *array, size_t count, size_t size) {
    free(array);
    return count > 0 ? calloc(count, size) : NULL;
}

static bool resize_pairs(world_pairs *p, size_t capacity) {
    p->capacity = capacity;
    p->margin = renew(p->margin, capacity, sizeof *p->margin);
    p->hints = renew(p->hints, capacity, sizeof *p->hints);
    p->impulses = renew(p->impulses, capacity, sizeof *p->impulses);
    return p->margin && p->hints && p->impulses;
}

/* Manifolds, and the contacts that are made of them. */
static bool resize_manifolds(world *w, size_t capacity) {
    narc_manifolds *m = &w->manifolds;
    m->capacity = capacity;
    m->pair = renew(m->pair, capacity, sizeof *m->pair);
    m->point_count = renew(m->point_count, capacity, sizeof *m->point_count);
    m->normal_x = renew(m->normal_x, capacity, sizeof *m->normal_x);
    m->normal_y = renew(m->normal_y, capacity, sizeof *m->normal_y);
    bool enough = m->pair && m->point_count && m->normal_x && m->normal_y;
    for (int i = 0; i < 2; i++) {
        m->separation[i] = renew(m->separation[i], capacity, sizeof *m->separation[i]);
        m->point_x[i] = renew(m->point_x[i], capacity, sizeof *m->point_x[i]);
        m->point_y[i] = renew(m->point_y[i], capacity, sizeof *m->point_y[i]);
        m->feature[i] = renew(m->feature[i], capacity, sizeof *m->feature[i]);
        enough = enough && m->separation[i] && m->point_x[i] && m->point_y[i] && m->feature[i];
    }
    w->contacts = renew(w->contacts, capacity, sizeof *w->contacts);
    return enough && w->contacts;
}

void world_destroy(world *w) {
    resize_pairs(&w->pairs, 0);
    resize_pairs(&w->last_pairs, 0);
    resize_manifolds(w, 0);
    narc_destroy_broad_phase(w->broad_phase);
    narc_destroy_shapes(w->store);
    free(w->bodies);
    free(w->shapes);
    *w = (world){.body_count = 0};
}

/* ------------------------------------------------------------------------------------------------ shapes and bodies */

narc_status world_add_shape(world *w, const narc_arc *arcs, size_t count, uint32_t *out_shape) {
    narc_arc centered[NARC_MAX_ARCS];
    narc_mass mass;
    narc_circle circle;
    uint32_t shape;
    narc_status status = narc_center_arcs(arcs, count, centered, NULL, &w->error);
    if (status == NARC_OK)
        status = narc_add_shape(w->store, centered, count, &shape, &w->error);
    if (status != NARC_OK)
        return status;
    if (shape >= w->capacity) {
        narc_remove_shape(w->store, shape, NULL);
        return fail(w, NARC_ERROR_CAPACITY, "too many shapes");
    }
    narc_compute_mass(centered, count, &mass);
    narc_compute_bounding_circle(centered, count, &circle);
    /* Of a shape that the store has already, the same numbers once more. */
    w->shapes[shape] =
        (world_shape){(float)mass.area, (float)mass.second_moment, (float)(hypot(circle.x, circle.y) + circle.radius)};
    if (out_shape)
        *out_shape = shape;
    return NARC_OK;
}

narc_status world_add_body(world *w, world_body body) {
    if (w->body_count == w->capacity)
        return fail(w, NARC_ERROR_CAPACITY, "too many bodies");
    if (body.shape >= narc_count_shapes(w->store))
        return fail(w, NARC_ERROR_INDEX, "a body's shape does not exist");
    if (!body.still && !(w->shapes[body.shape].mass > 0))
        return fail(w, NARC_ERROR_SIZE, "a segment has no mass, only what is still may have that shape");
    body.inverse_mass = body.still ? 0 : 1 / w->shapes[body.shape].mass;
    body.inverse_inertia = body.still ? 0 : 1 / w->shapes[body.shape].inertia;
    w->bodies[w->body_count++] = body;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ collisions */

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
    return status == NARC_OK ? fail(w, NARC_ERROR_NOT_FINITE, "a velocity is out of range") : status;
}

/* All pairs of bodies that come closer than the margin in this step, rotation of bullets included. Where the list is
 * another one, hints and impulses of the pairs that were in the last are carried over; zeros for the others. */
static narc_status update_pairs(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_pair_filter filter = {.kind = NARC_COLUMN(w->bodies, still)};
    const narc_pair_options options = {.margin = w->settings.margin,
                                       .skin = w->settings.skin,
                                       .motion_x = NARC_COLUMN(w->bodies, motion.x),
                                       .motion_y = NARC_COLUMN(w->bodies, motion.y),
                                       .reach = NARC_COLUMN(w->bodies, turn_reach),
                                       .filter = &filter};
    for (size_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        body->motion = scale(w->settings.time_step, body->velocity);
        body->turn_reach = body->bullet ? w->settings.time_step * fabsf(body->spin) * w->shapes[body->shape].reach : 0;
    }
    const narc_status status =
        narc_update_pairs(w->broad_phase, w->store, &bodies, &options, w->settings.threads, &w->list, &w->error);
    if (status != NARC_OK || w->list->skipped > 0)
        return status != NARC_OK ? status : find_broken_body(w);
    if (w->list->kept)
        return NARC_OK;
    const size_t count = w->list->pairs.count;
    const world_pairs last = w->pairs;
    w->pairs = w->last_pairs;
    w->last_pairs = last;
    if (w->pairs.capacity < count && !resize_pairs(&w->pairs, count + count / 2))
        return fail(w, NARC_ERROR_MEMORY, "no memory for pairs");
    narc_gather(w->list->previous, count, sizeof *last.hints, last.hints, w->pairs.hints);
    narc_gather(w->list->previous, count, sizeof *last.impulses, last.impulses, w->pairs.impulses);
    return NARC_OK;
}

/* The bodies of a pair. */
static const world_body *body_a(const world *w, size_t pair) {
    return &w->bodies[((const uint32_t *)w->list->pairs.a.base)[pair]];
}

static const world_body *body_b(const world *w, size_t pair) {
    return &w->bodies[((const uint32_t *)w->list->pairs.b.base)[pair]];
}

/* A pair with a bullet has a contact if the two could meet within this step. So the solver stops the bullet where it
 * would touch. For all pairs that would be too much: a contact at a distance is a guess at the normal of the touch. */
static void find_margins(world *w) {
    for (size_t k = 0; k < w->list->pairs.count; k++) {
        const world_body *a = body_a(w, k), *b = body_b(w, k);
        const vec way = subtract(b->motion, a->motion);
        const float reach = a->bullet || b->bullet ? sqrtf(dot(way, way)) + a->turn_reach + b->turn_reach : 0;
        w->pairs.margin[k] = w->settings.margin + reach;
    }
}

static narc_status find_manifolds(world *w, size_t *out_count) {
    const narc_bodies bodies = view_bodies(w);
    narc_pairs pairs = w->list->pairs;
    pairs.margin = NARC_ARRAY(w->pairs.margin);
    size_t skipped = 0;
    const narc_manifold_options options = {
        .flat_angle = w->settings.flat_angle, .hints = w->pairs.hints, .out_skipped = &skipped};
    if (w->manifolds.capacity < pairs.count && !resize_manifolds(w, w->pairs.capacity))
        return fail(w, NARC_ERROR_MEMORY, "no memory for contacts");
    const narc_status status = narc_find_manifolds(w->store, &bodies, &pairs, &options, w->settings.threads,
                                                   &w->manifolds, out_count, &w->error);
    return status == NARC_OK && skipped > 0 ? find_broken_body(w) : status;
}

/* ------------------------------------------------------------------------------------------------ contacts */

/* A point starts with the impulses of the point of the last step where the same features touched. */
static void start_warm(world_point *point, uint16_t feature, const world_impulses *last) {
    for (int i = 0; i < 2; i++)
        if (last->feature[i] == feature && last->normal[i] > 0) {
            point->normal_impulse = last->normal[i];
            point->tangent_impulse = last->tangent[i];
        }
}

/* Manifolds, with what a solver wants to know. */
static void make_contacts(world *w, size_t count) {
    const narc_manifolds *m = &w->manifolds;
    for (size_t k = 0; k < count; k++) {
        const uint32_t pair = m->pair[k];
        const world_body *a = body_a(w, pair), *b = body_b(w, pair);
        world_contact *c = &w->contacts[k];
        *c = (world_contact){.pair = pair,
                             .a = (uint32_t)(a - w->bodies),
                             .b = (uint32_t)(b - w->bodies),
                             .normal = {m->normal_x[k], m->normal_y[k]},
                             .friction = sqrtf(a->friction * b->friction),
                             .restitution = fmaxf(a->restitution, b->restitution),
                             .rolling_impulse = w->pairs.impulses[pair].rolling,
                             .point_count = m->point_count[k]};
        for (unsigned i = 0; i < c->point_count; i++) {
            world_point *point = &c->points[i];
            point->anchor_a = (vec){m->point_x[i][k], m->point_y[i][k]}; /* narc's points count from A's position */
            point->anchor_b = add(point->anchor_a, subtract(a->position, b->position));
            point->separation = m->separation[i][k];
            start_warm(point, m->feature[i][k], &w->pairs.impulses[pair]);
        }
    }
    w->contact_count = count;
}

/* The impulses for the next step. A pair without a contact has none. */
static void keep_impulses(world *w) {
    for (size_t k = 0; k < w->list->pairs.count; k++)
        w->pairs.impulses[k] = (world_impulses){.rolling = 0};
    for (size_t k = 0; k < w->contact_count; k++) {
        const world_contact *c = &w->contacts[k];
        world_impulses *kept = &w->pairs.impulses[c->pair];
        kept->rolling = c->rolling_impulse;
        for (unsigned i = 0; i < c->point_count; i++) {
            kept->feature[i] = w->manifolds.feature[i][k];
            kept->normal[i] = c->points[i].normal_impulse;
            kept->tangent[i] = c->points[i].tangent_impulse;
        }
    }
}

narc_status world_step(world *w) {
    size_t count = 0;
    narc_status status;
    if ((status = update_pairs(w)) != NARC_OK)
        return status;
    find_margins(w);
    if ((status = find_manifolds(w, &count)) != NARC_OK)
        return status;
    make_contacts(w, count);
    world_solve(w);
    keep_impulses(w);
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ measures */

double world_energy(const world *w) {
    double energy = 0;
    for (size_t k = 0; k < w->body_count; k++) {
        const world_body *body = &w->bodies[k];
        if (body->still)
            continue;
        const world_shape *shape = &w->shapes[body->shape];
        energy += 0.5 * (double)shape->mass * (double)dot(body->velocity, body->velocity);
        energy += 0.5 * (double)shape->inertia * (double)(body->spin * body->spin);
        energy -= (double)shape->mass * (double)dot(w->settings.gravity, body->position);
    }
    return energy;
}

/* FNV-1a. */
uint64_t world_hash(const world *w) {
    uint64_t hash = 0xcbf29ce484222325;
    for (size_t k = 0; k < w->body_count; k++) {
        const world_body *body = &w->bodies[k];
        const float state[] = {body->position.x, body->position.y, body->cosine, body->sine,
                               body->velocity.x, body->velocity.y, body->spin};
        const unsigned char *bytes = (const unsigned char *)state;
        for (size_t i = 0; i < sizeof state; i++)
            hash = (hash ^ bytes[i]) * 0x100000001b3;
    }
    return hash;
}
