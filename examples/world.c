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

static void *resize(void *array, size_t count, size_t size) {
    void *const resized = count > 0 ? realloc(array, count * size) : NULL;
    if (!resized)
        free(array);
    return resized;
}

/* Room for pairs, and for a contact of each. */
static bool resize_pairs(world *w, size_t room) {
    w->pair_room = room;
    w->pairs = resize(w->pairs, room, sizeof *w->pairs);
    w->next_pairs = resize(w->next_pairs, room, sizeof *w->next_pairs);
    w->manifolds = resize(w->manifolds, room, sizeof *w->manifolds);
    w->contacts = resize(w->contacts, room, sizeof *w->contacts);
    return w->pairs && w->next_pairs && w->manifolds && w->contacts;
}

void world_destroy(world *w) {
    resize_pairs(w, 0);
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
 * another one, what is known of the pairs that were in the last is carried over; zeros for the others. */
static narc_status update_pairs(world *w) {
    const narc_bodies bodies = view_bodies(w);
    const narc_pair_filter filter = {.kind = NARC_COLUMN(w->bodies, still)};
    const narc_pair_options options = {.margin = w->settings.margin,
                                       .skin = w->settings.skin,
                                       .motion_x = NARC_COLUMN(w->bodies, motion.x),
                                       .motion_y = NARC_COLUMN(w->bodies, motion.y),
                                       .reach = NARC_COLUMN(w->bodies, turn_reach),
                                       .filter = &filter,
                                       .workers = &w->settings.workers};
    for (size_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        body->motion = scale(w->settings.time_step, body->velocity);
        body->turn_reach = body->bullet ? w->settings.time_step * fabsf(body->spin) * w->shapes[body->shape].reach : 0;
    }
    const narc_status status = narc_update_pairs(w->broad_phase, w->store, &bodies, &options, &w->list, &w->error);
    if (status != NARC_OK || w->list->skipped > 0)
        return status != NARC_OK ? status : find_broken_body(w);
    if (w->list->kept)
        return NARC_OK;
    const size_t count = w->list->pairs.count;
    if (w->pair_room <= count && !resize_pairs(w, count + count / 2 + 1))
        return fail(w, NARC_ERROR_MEMORY, "no memory for pairs");
    world_pair *const last = w->pairs;
    narc_gather(w->list->previous, count, sizeof *last, last, w->next_pairs);
    w->pairs = w->next_pairs;
    w->next_pairs = last;
    return NARC_OK;
}

/* The bodies of a pair. */
static const world_body *body_a(const world *w, size_t pair) { return &w->bodies[w->list->pairs.a.base[pair]]; }

static const world_body *body_b(const world *w, size_t pair) { return &w->bodies[w->list->pairs.b.base[pair]]; }

/* A pair with a bullet has a contact if the two could meet within this step. So the solver stops the bullet where it
 * would touch. For all pairs that would be too much: a contact at a distance is a guess at the normal of the touch. */
static void find_margins(world *w) {
    for (size_t k = 0; k < w->list->pairs.count; k++) {
        const world_body *a = body_a(w, k), *b = body_b(w, k);
        const vec way = subtract(b->motion, a->motion);
        const float reach = a->bullet || b->bullet ? sqrtf(dot(way, way)) + a->turn_reach + b->turn_reach : 0;
        w->pairs[k].margin = w->settings.margin + reach;
    }
}

narc_status world_find_manifolds(world *w, size_t *out_count) {
    const narc_bodies bodies = view_bodies(w);
    size_t skipped = 0;
    const narc_query query = {.margins = NARC_COLUMN(w->pairs, margin),
                              .flat_angle = w->settings.flat_angle,
                              .hints = NARC_HINT_COLUMN(w->pairs, hint),
                              .workers = &w->settings.workers,
                              .out_skipped = &skipped};
    const narc_status status = narc_find_manifolds(w->store, &bodies, &w->list->pairs, &query, w->manifolds,
                                                   w->pair_room, out_count, &w->error);
    return status == NARC_OK && skipped > 0 ? find_broken_body(w) : status;
}

/* ------------------------------------------------------------------------------------------------ contacts */

/* A point starts with the impulses of the point of the last step where the same features touched. */
static void start_warm(world_point *point, uint32_t feature, const world_impulses *last) {
    const int i = last->feature[0] == feature ? 0 : 1;
    const bool known = last->feature[i] == feature && last->normal[i] > 0;
    point->normal_impulse = known ? last->normal[i] : 0;
    point->tangent_impulse = known ? last->tangent[i] : 0;
}

/* What the solver finds out itself is left as it is. */
void world_make_contacts(world *w, size_t count) {
    for (size_t k = 0; k < count; k++) {
        const narc_manifold *m = &w->manifolds[k];
        const world_impulses *last = &w->pairs[m->pair].impulses;
        const world_body *a = body_a(w, m->pair), *b = body_b(w, m->pair);
        const vec to_a = subtract(a->position, b->position);
        world_contact *c = &w->contacts[k];
        c->pair = m->pair;
        c->a = (uint32_t)(a - w->bodies);
        c->b = (uint32_t)(b - w->bodies);
        c->normal = (vec){m->normal_x, m->normal_y};
        c->friction = sqrtf(a->friction * b->friction);
        c->restitution = a->restitution > b->restitution ? a->restitution : b->restitution;
        c->rolling_impulse = last->rolling;
        c->point_count = m->count;
        c->points[1].normal_impulse = 0; /* where there is one point */
        for (unsigned i = 0; i < m->count; i++) {
            world_point *point = &c->points[i];
            point->anchor_a = (vec){m->point[i].x, m->point[i].y}; /* narc's points count from A's position */
            point->anchor_b = add(point->anchor_a, to_a);
            point->separation = m->point[i].separation;
            start_warm(point, m->point[i].feature, last);
        }
    }
    w->contact_count = count;
}

/* The impulses for the next step. A pair without a contact has none. */
static void keep_impulses(world *w) {
    for (size_t k = 0; k < w->list->pairs.count; k++)
        w->pairs[k].impulses = (world_impulses){.rolling = 0};
    for (size_t k = 0; k < w->contact_count; k++) {
        const world_contact *c = &w->contacts[k];
        world_impulses *kept = &w->pairs[c->pair].impulses;
        kept->rolling = c->rolling_impulse;
        for (unsigned i = 0; i < c->point_count; i++) {
            kept->feature[i] = w->manifolds[k].point[i].feature;
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
    if ((status = world_find_manifolds(w, &count)) != NARC_OK)
        return status;
    world_make_contacts(w, count);
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
