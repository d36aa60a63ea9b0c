/* SPDX-License-Identifier: MIT
 *
 * page.c - the example engine for a page: a scene of scenes.c, what the pointer does in it, and what is drawn of it.
 */
#include <stddef.h>
#include <string.h>

#include <narc_broad_phase.h>

#include "scenes.h"

#define EXPORT(type, name, parameters)                                                                                 \
    __attribute__((export_name(#name))) type page_##name parameters;                                                   \
    type page_##name parameters

enum { ROOM = 4096, POINTS = 4096, TRACK = 1024 };

/* What is drawn of a body, and of a point where two touch. */
typedef struct page_body {
    float x, y, cosine, sine;
    uint32_t shape;
    uint32_t flags; /* 1: it sleeps, 2: static, 4: ground, 8: sensor */
} page_body;

typedef struct page_point {
    float x, y, normal_x, normal_y;
} page_point;

typedef struct page_node {
    narc_box box;
    uint32_t level;
} page_node;

static world w;
static const scene *chosen;
static long step_number;
static page_body drawn[ROOM];
static page_point points[2 * ROOM];
static page_node nodes[ROOM];
static narc_arc arcs[NARC_MAX_ARCS];
static narc_point outline[POINTS];
static uint64_t held; /* the id of the body in hand, 0: none */
static vec hand, hold;
static narc_index *tree;
static narc_arc drawn_track[TRACK]; /* the ground that is driven, from right to left */
static size_t track_count;
static vec track_begin, track_end; /* the car starts and is set back at the left one */

/* ------------------------------------------------------------------------------------------------ scenes of the page */

static void add_flat(world *own, double left, double right) {
    track t = {.x = right, .normal = 1.5707963267948966};
    put_edge(&t, right - left);
    const narc_arc ends[] = {{right, 0, 0, t.normal, t.normal}, {left, 0, 0, t.normal, t.normal}};
    if (own->error.status == NARC_OK)
        world_add_ground(own, ends, 2, false, 0.6f);
}

/* Nothing but a floor: what is drawn falls on it. */
static void build_sheet(world *own, uint64_t seed) {
    add_flat(own, -9, 9);
    (void)seed;
}

/* A car on the ground that was drawn. */
static void build_drive(world *own, uint64_t seed) {
    if (track_count > 0 && own->error.status == NARC_OK)
        world_add_ground(own, drawn_track, track_count, false, 0.8f);
    add_car(own, (double)track_begin.x + 1.6, (double)track_begin.y);
    (void)seed;
}

/* Past its end, or upside down, it starts again. */
static narc_status act_drive(world *own, long step) {
    const world_body *const hull = &own->bodies[0];
    if (hull->position.y < track_end.y - 30 || hull->position.x > track_end.x + 12 ||
        (hull->cosine < -0.5f && step % 120 == 0))
        for (int k = 0; k < 3; k++) {
            world_body *const body = &own->bodies[k];
            body->position = body->start;
            body->velocity = (vec){5, 0};
            body->spin = 0;
            body->cosine = 1;
            body->sine = 0;
            world_wake_body(body);
        }
    return act_car(own, step);
}

static const scene own_scenes[] = {
    {"draw", "Draw an outline: n-arcs follow it, beside polygons of as many corners, and one falls", 60, 512,
     build_sheet, NULL},
    {"ground", "Draw a line from one side to the other: the car drives it", 60, 512, build_drive, act_drive},
};
enum { OWN = sizeof own_scenes / sizeof own_scenes[0] };

/* Scenes by number, those of the page first; "" behind the last. */
static const scene *scene_of(unsigned number) { return number < OWN ? &own_scenes[number] : &scenes[number - OWN]; }
EXPORT(const char *, scene_name, (unsigned number)) { return scene_of(number)->name ? scene_of(number)->name : ""; }
EXPORT(const char *, scene_purpose, (unsigned number)) { return scene_of(number)->purpose; }

/* The ground of the next scene that is driven: `count` arcs in track(), from its right end to its left one. */
EXPORT(narc_arc *, track, (void)) { return drawn_track; }
EXPORT(unsigned, track_room, (void)) { return TRACK; }
EXPORT(void, set_track, (unsigned count, float left, float left_y, float right, float right_y)) {
    track_count = count <= TRACK ? count : 0;
    track_begin = (vec){left, left_y};
    track_end = (vec){right, right_y};
}

/* ------------------------------------------------------------------------------------------------ time */

/* With room for what the pointer drops. */
EXPORT(int, start, (unsigned number, unsigned seed)) {
    static scene grown;
    world_destroy(&w);
    grown = *scene_of(number);
    grown.capacity = grown.capacity < 1024 ? grown.capacity + 256 : grown.capacity;
    chosen = &grown;
    step_number = 0;
    held = 0;
    return (int)build_scene(chosen, world_defaults, seed, &w);
}

/* The body in hand follows the pointer like by a spring: no force, but a speed towards it. */
static void pull(void) {
    world_body *const body = held ? world_find_body(&w, held) : NULL;
    if (!body)
        return;
    const vec arm = to_world(body, hold), way = subtract(hand, add(body->position, arm));
    vec velocity = scale(12, way);
    const float speed = length(velocity), most = 60;
    if (speed > most)
        velocity = scale(most / speed, velocity);
    world_wake_body(body);
    body->velocity = velocity;
    body->spin *= 0.9f;
}

/* For benchmarks: a world without bodies, in which nothing falls asleep; shapes of arc_list(), and bodies of them. */
EXPORT(int, begin, (unsigned capacity)) {
    static const scene none = {.name = "none"};
    world_settings settings = world_defaults;
    settings.sleep_time = INFINITY;
    world_destroy(&w);
    chosen = &none;
    step_number = 0;
    held = 0;
    return (int)world_create(&w, settings, capacity);
}
EXPORT(int, add_shape, (unsigned count)) {
    uint32_t shape = 0;
    const narc_status status = world_add_shape(&w, arcs, count, &shape);
    return status == NARC_OK ? (int)shape : -(int)status;
}
EXPORT(int, add_body, (unsigned shape, float x, float y, float cosine, float sine, int still)) {
    return (int)world_add_body(&w, (world_body){.position = {x, y},
                                                .cosine = cosine,
                                                .sine = sine,
                                                .shape = shape,
                                                .kind = still ? NARC_STATIC : 0,
                                                .friction = 0.6f});
}
EXPORT(const world_body *, bodies, (void)) { return w.bodies; }
EXPORT(unsigned, body_size, (void)) { return sizeof(world_body); }
EXPORT(unsigned, velocity_offset, (void)) { return offsetof(world_body, velocity); }

EXPORT(int, step, (void)) {
    pull();
    return (int)step_scene(chosen, &w, ++step_number);
}

EXPORT(const char *, error, (void)) { return w.error.message; }
EXPORT(int, error_status, (void)) { return (int)w.error.status; }

EXPORT(uint32_t, hash_low, (void)) { return (uint32_t)world_hash(&w); }
EXPORT(uint32_t, hash_high, (void)) { return (uint32_t)(world_hash(&w) >> 32); }
EXPORT(unsigned, body_count, (void)) { return (unsigned)w.body_count; }
EXPORT(unsigned, pair_count, (void)) { return w.result ? (unsigned)w.result->count : 0; }

EXPORT(float, speed, (unsigned k)) { return k < w.body_count ? length(w.bodies[k].velocity) : 0; }

EXPORT(unsigned, moving_count, (void)) {
    unsigned count = 0;
    for (size_t k = 0; k < w.body_count; k++)
        count += w.bodies[k].kind == 0;
    return count;
}

/* All bodies, those of ground behind the others; returns how many there are. */
EXPORT(unsigned, draw, (void)) {
    unsigned count = 0;
    for (size_t k = 0; k < w.body_count + w.ground_count && count < ROOM; k++) {
        const world_body *const body = &w.bodies[k];
        const uint32_t flags = (body->kind & NARC_ASLEEP ? 1u : 0) | (body->kind & NARC_STATIC ? 2u : 0) |
                               (k >= w.body_count ? 4u : 0) | (body->kind & NARC_SENSOR ? 8u : 0);
        drawn[count++] = (page_body){body->position.x, body->position.y, body->cosine, body->sine, body->shape, flags};
    }
    return count;
}
EXPORT(page_body *, drawn, (void)) { return drawn; }

EXPORT(unsigned, touch, (void)) {
    unsigned count = 0;
    for (size_t k = 0; w.result && k < w.result->count; k++) {
        const world_contact *const c = world_contact_of(&w, k);
        for (unsigned i = 0; c->touching && i < c->point_count && count < 2 * ROOM; i++) {
            const vec at = add(c->a->position, to_world(c->a, c->points[i].local_a)), normal = c->points[i].normal;
            points[count++] = (page_point){at.x + c->points[i].radius_a * normal.x,
                                           at.y + c->points[i].radius_a * normal.y, normal.x, normal.y};
        }
    }
    return count;
}
EXPORT(page_point *, points, (void)) { return points; }

/* All bodies, and the tree over their boxes as they are now. */
static bool plant(narc_bodies *out_bodies) {
    static narc_box boxes[ROOM];
    *out_bodies = (narc_bodies){.count = w.body_count + w.ground_count,
                                .x = NARC_POSITION_COLUMN(w.bodies, position.x),
                                .y = NARC_POSITION_COLUMN(w.bodies, position.y),
                                .cosine = NARC_COLUMN(w.bodies, cosine),
                                .sine = NARC_COLUMN(w.bodies, sine),
                                .shape = NARC_COLUMN(w.bodies, shape)};
    return out_bodies->count <= ROOM && (tree || !narc_create_index(NULL, &tree)) &&
           !narc_compute_boxes(w.store, out_bodies, NULL, boxes, NULL) &&
           !narc_build_index(tree, boxes, out_bodies->count, NULL, NULL);
}

/* Where the rays of a scanner end, all around from a point: RAYS points, normals 0 where nothing is hit. Each ray is as long as
 * the reach. */
EXPORT(unsigned, scan, (float x, float y, float reach)) {
    enum { RAYS = 1080 };
    static float motion_x[RAYS], motion_y[RAYS];
    static narc_ray_hit hits[RAYS];
    const double turn = 2 * 3.14159265358979 / RAYS;
    narc_bodies bodies;
    for (int k = 0; k < RAYS; k++) {
        motion_x[k] = reach * (float)cos(turn * k);
        motion_y[k] = reach * (float)sin(turn * k);
    }
    const narc_rays rays = {.count = RAYS,
                            .x = {&x, 0, NARC_FLOAT32},
                            .y = {&y, 0, NARC_FLOAT32},
                            .motion_x = NARC_ARRAY(motion_x),
                            .motion_y = NARC_ARRAY(motion_y)};
    if (!plant(&bodies) || narc_cast_rays(tree, w.store, &bodies, &rays, NULL, hits, RAYS, NULL))
        return 0;
    for (int k = 0; k < RAYS; k++) {
        const float fraction = hits[k].count ? hits[k].fraction : 1;
        points[k] =
            (page_point){x + fraction * motion_x[k], y + fraction * motion_y[k], hits[k].normal_x, hits[k].normal_y};
    }
    return RAYS;
}

/* The tree's nodes, level by level from the leaves up; returns how many. */
EXPORT(unsigned, grow, (void)) {
    narc_bodies bodies;
    unsigned count = 0;
    size_t added = plant(&bodies);
    for (size_t level = 0; added > 0; level++) {
        if (narc_copy_nodes(tree, level, &nodes[count].box, sizeof *nodes, ROOM - count, &added, NULL))
            return 0;
        for (size_t k = 0; k < added; k++)
            nodes[count++].level = (uint32_t)level;
    }
    return count;
}
EXPORT(page_node *, nodes, (void)) { return nodes; }

/* The arcs of a shape; of ground those of its front alone. */
EXPORT(unsigned, arcs, (unsigned shape)) {
    const size_t count = narc_get_arcs(w.store, shape, arcs);
    return (unsigned)(narc_shape_flags(w.store, shape) & NARC_SHAPE_RUN ? count - 4 : count);
}
EXPORT(narc_arc *, arc_list, (void)) { return arcs; }

/* Takes the body at a point in hand: the one that it is deepest within, if any is nearer than the reach. */
EXPORT(int, grab, (float x, float y, float reach)) {
    double best = (double)reach;
    held = 0;
    for (size_t k = 0; k < w.body_count; k++) {
        const world_body *const body = &w.bodies[k];
        if (body->kind & (NARC_STATIC | NARC_SENSOR))
            continue;
        const vec local = to_local(body, subtract((vec){x, y}, body->position));
        const narc_point at = {(double)local.x, (double)local.y};
        double distance;
        if (length(local) < w.shapes[body->shape].reach + reach &&
            narc_compute_distance(arcs, narc_get_arcs(w.store, body->shape, arcs), &at, &distance) && distance < best) {
            best = distance;
            held = body->id;
            hold = local;
        }
    }
    hand = (vec){x, y};
    return held != 0;
}
EXPORT(void, move, (float x, float y)) { hand = (vec){x, y}; }
EXPORT(void, release, (void)) { held = 0; }

/* A body of a shape that there is. */
EXPORT(int, drop, (unsigned shape, float x, float y)) {
    const world_body body = {.position = {x, y}, .cosine = 1, .shape = shape, .friction = 0.6f};
    return (int)world_add_body(&w, body);
}

/* The n-arc through a ring of points becomes a body, and stays in arc_list(), in the world's axes: how many arcs, or minus the status. */
EXPORT(narc_point *, outline, (void)) { return outline; }
EXPORT(int, add_outline, (unsigned count)) {
    narc_arc built[NARC_MAX_ARCS];
    narc_point centroid;
    size_t arc_count;
    uint32_t shape;
    narc_status status = narc_build_ring(outline, count, built, &arc_count, &w.error);
    if (status == NARC_OK)
        status = narc_center_arcs(built, arc_count, arcs, &centroid, &w.error);
    if (status == NARC_OK)
        status = world_add_shape(&w, built, arc_count, &shape);
    if (status == NARC_OK)
        status = (narc_status)page_drop(shape, (float)centroid.x, (float)centroid.y);
    if (status == NARC_OK)
        memcpy(arcs, built, arc_count * sizeof *built);
    w.error.status = NARC_OK;
    return status == NARC_OK ? (int)arc_count : -(int)status;
}
