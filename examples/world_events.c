/* SPDX-License-Identifier: MIT
 *
 * world_events.c - what begins and ends, what sleeps and wakes.
 */
#include "world.h"

/* ------------------------------------------------------------------------------------------------ events */

static void add_event(world *w, uint64_t id_a, uint64_t id_b, bool begins, bool sensor) {
    w->events[w->event_count++] = (world_event){id_a, id_b, begins, sensor};
}

/* Bodies of a lost pair may be gone. What lay on one that is gone wakes. */
void world_end_lost_pairs(world *w) {
    for (size_t k = 0; k < w->list->lost_count; k++) {
        const narc_lost_pair *lost = &w->list->lost[k];
        if (!w->contacts[lost->pair].touching)
            continue;
        add_event(w, lost->id_a, lost->id_b, false, (lost->marks & NARC_SENSOR) != 0);
        const size_t a = world_find_body(w, lost->id_a), b = world_find_body(w, lost->id_b);
        if (a != SIZE_MAX)
            world_wake_body(&w->bodies[a]);
        if (b != SIZE_MAX)
            world_wake_body(&w->bodies[b]);
    }
}

static void set_touching(world *w, world_contact *c, bool touching, bool sensor) {
    if (touching != c->touching)
        add_event(w, w->bodies[c->a].id, w->bodies[c->b].id, touching, sensor);
    c->touching = touching;
}

/* A touch begins where bodies overlap or press, and ends where they are further apart than the margin: what hardly
 * touches does not begin and end in turns. Sleepers are not asked: between them nothing changes. */
void world_list_events(world *w) {
    for (size_t k = 0; k < w->list->contact_count; k++) {
        world_contact *c = &w->contacts[w->list->contacts[k]];
        float nearest = INFINITY, pressed = 0;
        for (unsigned i = 0; i < c->point_count; i++) {
            nearest = fminf(nearest, c->points[i].separation);
            pressed = fmaxf(pressed, c->points[i].greatest_impulse);
        }
        set_touching(w, c, pressed > 0 || nearest < (c->touching ? w->settings.margin : 0), false);
    }
    for (size_t k = 0; k < w->list->sensor_count; k++)
        set_touching(w, &w->contacts[w->list->sensors[k]], w->overlaps[k / 64] >> k % 64 & 1, true);
}

/* ------------------------------------------------------------------------------------------------ sleep */

void world_wake_body(world_body *body) {
    body->kind &= (uint8_t)~NARC_ASLEEP;
    body->rest = 0;
}

/* The island's root: the body with the lowest number that was found to belong to it. */
static uint32_t find_root(world_body *bodies, uint32_t k) {
    while (bodies[k].island != k)
        k = bodies[k].island = bodies[bodies[k].island].island;
    return k;
}

/* Bodies that touch, directly or through others that move, are an island. It sleeps when all of its bodies have been
 * slow for a while, and is awake as long as one has not. */
void world_sleep(world *w) {
    for (uint32_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        body->island = k;
        body->rest = world_speed(w, body) > w->settings.sleep_speed ? 0 : body->rest + w->settings.time_step;
    }
    for (size_t k = 0; k < w->list->pairs.count; k++) {
        const world_contact *c = &w->contacts[k];
        if ((c->point_count == 0 && !c->touching) || (w->list->marks[k] & (NARC_STATIC | NARC_SENSOR)))
            continue;
        const uint32_t a = find_root(w->bodies, c->a), b = find_root(w->bodies, c->b);
        w->bodies[a > b ? a : b].island = a > b ? b : a;
    }
    for (uint32_t k = 0; k < w->body_count; k++) { /* a root's rest is that of its island's least quiet body */
        world_body *root = &w->bodies[find_root(w->bodies, k)];
        root->rest = fminf(root->rest, w->bodies[k].rest);
    }
    for (uint32_t k = 0; k < w->body_count; k++) {
        world_body *body = &w->bodies[k];
        if (body->inverse_mass == 0)
            continue;
        const bool asleep = w->bodies[find_root(w->bodies, k)].rest >= w->settings.sleep_time;
        if (asleep) {
            body->kind |= NARC_ASLEEP;
            body->velocity = (vec){0, 0};
            body->spin = 0;
        } else if (body->kind & NARC_ASLEEP)
            world_wake_body(body);
    }
    w->active_count = 0;
    for (uint32_t k = 0; k < w->list->pairs.count; k++) {
        const world_contact *c = &w->contacts[k];
        const bool still = w->bodies[c->a].kind != 0 && w->bodies[c->b].kind != 0;
        if (c->point_count > 0 && !still)
            w->active[w->active_count++] = k;
    }
}
