/* SPDX-License-Identifier: MIT
 *
 * world.c - shapes and bodies, which come and go, and the step.
 */
#include "world.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

const world_settings world_defaults = {
    .gravity = {0, -9.81f},
    .time_step = 1 / 60.0f,
    .substeps = 4,
    .spring_rate = 1 / 6.0f,
    .rolling_arm = 0.005f,
    .margin = 0.02f,
    .skin = 0.02f,
    .flat_angle = NARC_FLAT_ANGLE,
    .recycling = 0.01f,
    .sleep_speed = 0.05f,
    .sleep_time = 0.5f,
};

narc_status world_fail(world *w, narc_status status, const char *message) {
    w->error = (narc_error){.status = status};
    strncpy(w->error.message, message, sizeof w->error.message - 1);
    return status;
}

narc_status world_create(world *w, world_settings settings, size_t capacity) {
    const size_t pairs = 16 * capacity;
    *w = (world){.settings = settings, .capacity = capacity, .pair_room = pairs};
    w->shapes = calloc(2 * capacity, sizeof *w->shapes);
    w->bodies = calloc(capacity, sizeof *w->bodies);
    w->active = calloc(pairs, sizeof *w->active);
    w->joints = calloc(capacity, sizeof *w->joints);
    w->events = calloc(2 * pairs, sizeof *w->events); /* of each pair one, of this step and of the last */
    const narc_contacts_settings contacts = {.user_size = sizeof(world_contact)};
    if (!w->shapes || !w->bodies || !w->active || !w->joints || !w->events ||
        narc_create_shapes(NULL, &w->store) != NARC_OK ||
        narc_create_contacts(&contacts, &w->contacts, &w->error) != NARC_OK)
        return world_fail(w, NARC_ERROR_MEMORY, "no memory for a world");
    return NARC_OK;
}

void world_destroy(world *w) {
    narc_destroy_contacts(w->contacts);
    narc_destroy_shapes(w->store);
    free(w->bodies);
    free(w->shapes);
    free(w->active);
    free(w->joints);
    free(w->events);
    *w = (world){.body_count = 0};
}

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
        return world_fail(w, NARC_ERROR_CAPACITY, "too many shapes");
    }
    narc_compute_mass(centered, count, &mass);
    narc_compute_bounding_circle(centered, count, &circle);
    const double reach = hypot(circle.x, circle.y) + circle.radius;
    /* Of a shape that the store has already, the same numbers once more. A convex shape of width w and diameter d has
     * an area from w d / 2 to w d, and its reach is from d / 2 to d. What is fast against a segment, which has no area, or
     * what is thinner than rounding of its reach, is so by its own thickness alone, as against ground. */
    const double mean = mass.area / (2 * reach), thickness = mean > 0x1p-24 * reach ? mean : (double)FLT_MAX;
    w->shapes[shape] = (world_shape){(float)mass.area, (float)mass.second_moment, (float)reach, (float)thickness};
    if (out_shape)
        *out_shape = shape;
    return NARC_OK;
}

narc_status world_add_body(world *w, world_body body) {
    const bool moved_by_contacts = (body.kind & (NARC_STATIC | NARC_SENSOR)) == 0;
    if (w->body_count + w->ground_count == w->capacity)
        return world_fail(w, NARC_ERROR_CAPACITY, "too many bodies");
    if (body.shape >= narc_count_shapes(w->store))
        return world_fail(w, NARC_ERROR_INDEX, "a body's shape does not exist");
    if (moved_by_contacts && !(w->shapes[body.shape].mass > 0))
        return world_fail(w, NARC_ERROR_SIZE, "a body without mass may be static or a sensor, and no other");
    body.inverse_mass = moved_by_contacts ? 1 / w->shapes[body.shape].mass : 0;
    body.inverse_inertia = moved_by_contacts ? 1 / w->shapes[body.shape].inertia : 0;
    body.id = ++w->last_id;
    body.owner = UINT32_MAX;
    body.run = NARC_NO_RUN;
    body.start = body.position;
    world_wake_body(&body);
    w->bodies[w->body_count + w->ground_count] = w->bodies[w->body_count]; /* the ground stays behind all bodies */
    w->bodies[w->body_count++] = body;
    return NARC_OK;
}

void world_remove_body(world *w, world_body *body) {
    *body = w->bodies[--w->body_count];
    w->bodies[w->body_count] = w->bodies[w->body_count + w->ground_count];
}

/* Solid however deep: what is fast against it is so by its own measure. */
static narc_status add_entries(world *w, const narc_arc *arcs, size_t count, bool closed, float friction,
                               uint32_t platform) {
    const size_t room = w->capacity - w->body_count - w->ground_count;
    const narc_chain_options options = {.closed = closed, .first_run = w->run_count};
    narc_chain_entry *const entries = calloc(room + 1, sizeof *entries);
    size_t added = 0;
    const narc_status status = entries
                                   ? narc_add_chain(w->store, arcs, count, &options, entries, room, &added, &w->error)
                                   : world_fail(w, NARC_ERROR_MEMORY, "no memory for ground");
    for (const narc_chain_entry *entry = entries; status == NARC_OK && entry < entries + added; entry++) {
        w->shapes[entry->shape] = (world_shape){.reach = FLT_MAX, .thickness = FLT_MAX};
        w->run_count = entry->run == NARC_NO_RUN ? w->run_count : entry->run + 1;
        w->bodies[w->body_count + w->ground_count++] = (world_body){.position = {(float)entry->x, (float)entry->y},
                                                                    .cosine = 1,
                                                                    .shape = entry->shape,
                                                                    .kind = NARC_STATIC,
                                                                    .friction = friction,
                                                                    .id = ++w->last_id,
                                                                    .owner = UINT32_MAX,
                                                                    .run = entry->run,
                                                                    .platform = platform,
                                                                    .stop = 1};
    }
    free(entries);
    return status;
}

narc_status world_add_ground(world *w, const narc_arc *arcs, size_t count, bool closed, float friction) {
    return add_entries(w, arcs, count, closed, friction, 0);
}

narc_status world_add_platform(world *w, const narc_arc *arcs, size_t count, float friction) {
    const narc_status status = add_entries(w, arcs, count, false, friction, w->platform_count + 1);
    w->platform_count += status == NARC_OK;
    return status;
}

void world_move_platform(world *w, uint32_t platform, vec velocity) {
    world_body *const ground = w->bodies + w->body_count;
    for (size_t k = 0; k < w->ground_count; k++)
        if (ground[k].platform == platform)
            ground[k].velocity = velocity;
    for (size_t k = 0; w->result && k < w->result->count; k++) { /* bodies stand before ground in a pair */
        const world_contact *const c = world_contact_of(w, k);
        if (c->touching && c->b->platform == platform)
            world_wake_body(c->a);
    }
}

narc_status world_pin(world *w, world_body *a, world_body *b, vec point) {
    if (w->joint_count == w->capacity)
        return world_fail(w, NARC_ERROR_CAPACITY, "too many joints");
    world_contact *const joint = &w->joints[w->joint_count++];
    *joint = (world_contact){.a = a, .b = b};
    joint->points[0] = (world_point){.normal = {1, 0},
                                     .local_a = to_local(a, subtract(point, a->position)),
                                     .local_b = to_local(b, subtract(point, b->position))};
    return NARC_OK;
}

world_body *world_find_body(const world *w, uint64_t id) {
    for (size_t k = 0; k < w->body_count; k++)
        if (w->bodies[k].id == id)
            return &w->bodies[k];
    return NULL;
}

/* What each body will move, so that pairs that meet on the way are found; nothing has moved so far. */
static void predict_motion(world *w) {
    const float time = w->settings.time_step;
    for (size_t k = 0; k < w->body_count + w->ground_count; k++) {
        world_body *body = &w->bodies[k];
        const bool falls = body->inverse_mass > 0 && body->kind == 0;
        body->motion = scale(time, falls ? add(body->velocity, scale(time, w->settings.gravity)) : body->velocity);
        body->turn_reach = time * fabsf(body->spin) * w->shapes[body->shape].reach;
        const float ahead = length(body->motion) + body->turn_reach - 0.5f * w->settings.margin;
        body->ahead = ahead > 0 ? ahead : 0; /* so two find each other that could meet in this step */
        body->from = body->position;
        body->from_rotation = (vec){body->cosine, body->sine};
        body->turn = 0;
        body->stop = 1;
    }
}

narc_status world_step(world *w) {
    predict_motion(w);
    narc_status status = world_update_contacts(w);
    if (status != NARC_OK)
        return status;
    world_make_contacts(w);
    world_sleep(w);
    world_solve(w);
    status = world_stop_bullets(w);
    world_list_events(w);
    return status;
}

float world_speed(const world *w, const world_body *body) {
    return length(body->velocity) + fabsf(body->spin) * w->shapes[body->shape].reach;
}

double world_energy(const world *w) {
    double energy = 0;
    for (const world_body *body = w->bodies; body < w->bodies + w->body_count; body++)
        if (body->inverse_mass > 0) {
            const world_shape *shape = &w->shapes[body->shape];
            const float per_mass =
                0.5f * dot(body->velocity, body->velocity) - dot(w->settings.gravity, body->position);
            energy += (double)shape->mass * (double)per_mass + 0.5 * (double)(shape->inertia * body->spin * body->spin);
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
