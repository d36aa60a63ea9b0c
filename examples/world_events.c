/* SPDX-License-Identifier: MIT
 *
 * world_events.c - what begins and ends, what sleeps and wakes.
 */
#include "world.h"

/* Bodies of a pair that parted may be gone. What lay on one that is gone wakes. */
void world_end_lost_pairs(world *w) {
    const world_contact *const contacts = w->result->user;
    for (size_t k = 0; k < w->result->ended_count; k++) {
        const narc_touch_event *const ended = &w->result->ended[k];
        if (!ended->parted || !contacts[ended->slot].touching)
            continue;
        w->events[w->event_count++] = (world_event){ended->id_a, ended->id_b, false, (ended->marks & NARC_SENSOR) != 0};
        world_body *const a = world_find_body(w, ended->id_a), *const b = world_find_body(w, ended->id_b);
        if (a)
            world_wake_body(a);
        if (b)
            world_wake_body(b);
    }
}

static void set_touching(world *w, world_contact *c, bool touching, bool sensor) {
    if (touching != c->touching)
        w->events[w->event_count++] = (world_event){c->a->id, c->b->id, touching, sensor};
    c->touching = touching;
}

/* A touch begins where bodies overlap or press, and ends where they are further apart than the margin: what hardly
 * touches does not begin and end in turns. Sleepers are not asked: between them nothing changes. */
void world_list_events(world *w) {
    for (size_t k = 0; k < w->result->count; k++) {
        world_contact *const c = world_contact_of(w, k);
        const unsigned kinds = c->a->kind | c->b->kind;
        float nearest = INFINITY, pressed = 0;
        for (unsigned i = 0; i < c->point_count; i++) {
            nearest = smaller(nearest, c->points[i].separation);
            pressed = larger(pressed, c->points[i].greatest_impulse);
        }
        if (kinds & NARC_SENSOR)
            set_touching(w, c, w->result->state[w->result->order[k]] & NARC_TOUCHING, true);
        else
            set_touching(w, c, pressed > 0 || nearest < (c->touching ? w->settings.margin : 0), false);
    }
}

void world_wake_body(world_body *body) {
    body->kind &= (uint8_t)~NARC_ASLEEP;
    body->rest = 0;
}

/* The island's root: the first body of it. */
static world_body *find_root(world_body *body) {
    while (body->island != body)
        body = body->island = body->island->island;
    return body;
}

static void join(world_body *a, world_body *b) {
    a = find_root(a);
    b = find_root(b);
    if (a < b)
        b->island = a;
    else
        a->island = b;
}

/* Bodies that touch or are joined, directly or through others that move, are an island. It sleeps when all of its bodies
 * have been slow for a while, and is awake as long as one has not. */
void world_sleep(world *w) {
    world_body *const end = w->bodies + w->body_count;
    for (world_body *body = w->bodies; body < end; body++) {
        body->island = body;
        body->rest = world_speed(w, body) > w->settings.sleep_speed ? 0 : body->rest + w->settings.time_step;
    }
    for (size_t k = 0; k < w->result->count; k++) {
        const world_contact *const c = world_contact_of(w, k);
        if ((c->point_count > 0 || c->touching) && !((c->a->kind | c->b->kind) & (NARC_STATIC | NARC_SENSOR)))
            join(c->a, c->b);
    }
    for (size_t k = 0; k < w->joint_count; k++)
        join(w->joints[k].a, w->joints[k].b);
    for (world_body *body = w->bodies; body < end; body++) { /* a root's rest: that of its island's least quiet body */
        world_body *const root = find_root(body);
        root->rest = smaller(root->rest, body->rest);
    }
    for (world_body *body = w->bodies; body < end; body++) {
        if (body->inverse_mass == 0)
            continue;
        if (find_root(body)->rest >= w->settings.sleep_time) {
            body->kind |= NARC_ASLEEP;
            body->velocity = (vec){0, 0};
            body->spin = 0;
        } else if (body->kind & NARC_ASLEEP)
            world_wake_body(body);
    }
    w->active_count = 0;
    for (size_t k = 0; k < w->result->count; k++) {
        world_contact *const c = world_contact_of(w, k);
        if (c->point_count > 0 && (c->a->kind == 0 || c->b->kind == 0))
            w->active[w->active_count++] = c;
    }
}
