/* SPDX-License-Identifier: MIT
 *
 * scenes.c - stacks, pyramids, piles, bullets, rain; and on ground a car, marbles, a box and dominoes.
 */
#include "scenes.h"

#include <string.h>

#include "glyphs.h"

static const double pi = 3.14159265358979;

/* SplitMix64; in [low, high). */
static float random_between(uint64_t *state, float low, float high) {
    uint64_t bits = *state += 0x9e3779b97f4a7c15;
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
    bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
    bits ^= bits >> 31;
    return low + (high - low) * (float)(bits >> 40) * 0x1p-24f;
}

/* Rounded from doubles a rotation is the same with every C library, or nearly always. */
static world_body make_body(uint32_t shape, float x, float y, float angle) {
    return (world_body){.position = {x, y},
                        .cosine = (float)cos((double)angle),
                        .sine = (float)sin((double)angle),
                        .shape = shape,
                        .friction = 0.6f};
}

/* What goes wrong stays in w->error, and build_scene() returns it. */
static uint32_t add_shape(world *w, const narc_arc *arcs, size_t count) {
    uint32_t shape = 0;
    if (w->error.status == NARC_OK)
        world_add_shape(w, arcs, count, &shape);
    return shape;
}

static void add_body(world *w, world_body body) {
    if (w->error.status == NARC_OK)
        world_add_body(w, body);
}

static uint32_t add_box(world *w, double width, double height, double radius) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count = 0;
    narc_build_box(width, height, radius, arcs, &count, &w->error);
    return add_shape(w, arcs, count);
}

/* A box that never moves. */
static void add_block(world *w, double width, double height, float x, float y) {
    world_body block = make_body(add_box(w, width, height, 0), x, y, 0);
    block.kind = NARC_STATIC;
    add_body(w, block);
}

/* ------------------------------------------------------------------------------------------------ boxes */

/* Rows of boxes on the ground, each of one less than that below it, and at least one. */
static void build_rows(world *w, uint64_t seed, int rows, int lowest, double radius) {
    const float apart = 1.1f;
    add_block(w, 40, 2, 0, -1);
    const uint32_t box = add_box(w, 1, 1, radius);
    for (int row = 0; row < rows; row++) {
        const int count = row < lowest ? lowest - row : 1;
        for (int k = 0; k < count; k++) {
            const float x = apart * ((float)k - 0.5f * (float)(count - 1));
            const float offset = random_between(&seed, -0.02f, 0.02f), tilt = random_between(&seed, -0.001f, 0.001f);
            add_body(w, make_body(box, x + offset, 0.5f + (float)row, tilt));
        }
    }
}

static void build_stack(world *w, uint64_t seed) { build_rows(w, seed, 30, 1, 0); }

static void build_pyramid(world *w, uint64_t seed) { build_rows(w, seed, 20, 20, 0); }

static void build_rounded_pyramid(world *w, uint64_t seed) { build_rows(w, seed, 20, 20, 0.1); }

/* ------------------------------------------------------------------------------------------------ a pile */

enum { KINDS = 6 + GLYPH_COUNT, SIZES = 3 };

/* Shape number `kind` of the pile. */
static uint32_t add_kind(world *w, int kind, double size) {
    const narc_point hexagon[] = {{0.5, 0}, {0.3, 0.4}, {-0.2, 0.4}, {-0.5, 0.1}, {-0.3, -0.4}, {0.2, -0.4}};
    const narc_four_arc lens = {0.8, 0.8, 1, 0.1, 0.1}; /* with round tips */
    narc_arc arcs[NARC_MAX_ARCS] = {{0}};
    size_t count = GLYPH_ARCS;
    if (kind == 0)
        narc_build_circle(0.4, arcs, &count, &w->error);
    else if (kind == 1)
        narc_build_capsule(0.6, 0.25, arcs, &count, &w->error);
    else if (kind == 2)
        narc_build_box(1, 0.7, 0, arcs, &count, &w->error);
    else if (kind == 3)
        narc_build_box(0.9, 0.6, 0.15, arcs, &count, &w->error);
    else if (kind == 4)
        narc_build_polygon(hexagon, 6, 0, arcs, &count, &w->error);
    else if (kind == 5)
        narc_build_four_arc(&lens, arcs, &count, &w->error);
    else
        memcpy(arcs, glyphs[kind - 6], sizeof glyphs[0]);
    for (size_t i = 0; i < count; i++)
        arcs[i] = (narc_arc){size * arcs[i].center_x, size * arcs[i].center_y, size * arcs[i].radius, arcs[i].start,
                             arcs[i].end};
    return add_shape(w, arcs, count);
}

/* Bodies fall into a box without a lid. */
static void build_pile_of(world *w, uint64_t seed, float width, int bodies) {
    const float spacing = 1.3f;
    uint32_t shapes[KINDS * SIZES];
    add_block(w, (double)width + 4, 4, 0, -2);
    add_block(w, 4, 60, -0.5f * width - 2, 26);
    add_block(w, 4, 60, 0.5f * width + 2, 26);
    for (int i = 0; i < KINDS * SIZES; i++)
        shapes[i] = add_kind(w, i / SIZES, 0.7 + 0.3 * (i % SIZES));
    const int columns = (int)(width / spacing) - 1;
    for (int k = 0; k < bodies; k++) {
        const uint32_t kind = (uint32_t)random_between(&seed, 0, KINDS * SIZES);
        const float x = spacing * ((float)(k % columns) - 0.5f * (float)(columns - 1));
        const float y = spacing * (1 + (float)(k / columns));
        add_body(w, make_body(shapes[kind], x, y, random_between(&seed, -3, 3)));
    }
}

static void build_pile(world *w, uint64_t seed) { build_pile_of(w, seed, 40, 600); }

static void build_heap(world *w, uint64_t seed) { build_pile_of(w, seed, 16, 200); }

/* ------------------------------------------------------------------------------------------------ bullets */

/* Bullets of several shapes, 120 m/s, against a wall that is a fortieth of what they fly in one step. */
static void build_bullets(world *w, uint64_t seed) {
    add_block(w, 40, 2, 0, -1);
    add_block(w, 0.05, 40, 0, 20);
    for (int k = 0; k < 8; k++) {
        const uint32_t shape = add_kind(w, k, 0.3);
        world_body body = make_body(shape, random_between(&seed, -11, -9), 1 + (float)k, 0);
        body.velocity = (vec){120, random_between(&seed, -1, 1)};
        body.spin = random_between(&seed, -30, 30);
        add_body(w, body);
    }
}

/* A plate of 1 cm, and eight shots of 400 m/s from either side, that fly on, and would hit each other, if one passed. */
static void build_plates(world *w, uint64_t seed) {
    add_block(w, 24, 1, 0, -0.5f);
    add_block(w, 0.01, 7, 0, 3.5f);
    for (int k = 0; k < 16; k++) {
        const float side = k % 2 ? 1 : -1;
        world_body body = make_body(add_kind(w, k % 8, 0.4), 10 * side, 0.6f + 0.8f * (float)(k / 2), 0);
        body.velocity = (vec){-400 * side, random_between(&seed, -1, 1)};
        body.spin = random_between(&seed, -30, 30);
        body.restitution = 0.02f;
        add_body(w, body);
    }
}

/* Every two seconds they fly again. */
static narc_status act_plates(world *w, long step) {
    for (size_t k = 2; k < w->body_count && step % 120 == 0; k++) {
        world_body *const body = &w->bodies[k];
        const uint32_t shape = body->shape;
        if (body->id > 18) /* what somebody has added */
            continue;
        body->position = body->start;
        body->velocity = (vec){body->start.x > 0 ? -400 : 400, 0};
        body->spin = 20 - 5 * (float)(shape % 8);
        world_wake_body(body);
    }
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ rain */

/* A sensor below a table, and the shapes that fall on it. */
static void build_rain(world *w, uint64_t seed) {
    add_block(w, 60, 2, random_between(&seed, -1, 1), -20);
    w->bodies[0].kind |= NARC_SENSOR;
    add_block(w, 8, 1, 0, 0);
    for (int kind = 0; kind < KINDS; kind++)
        add_kind(w, kind, 1);
}

/* What has reached the sensor goes, and another body comes. */
static narc_status act_rain(world *w, long step) {
    uint64_t seed = (uint64_t)step;
    for (size_t k = 0; k < w->event_count; k++) {
        const world_event *event = &w->events[k];
        world_body *body = world_find_body(w, event->id_a == w->bodies[0].id ? event->id_b : event->id_a);
        if (event->sensor && event->begins && body)
            world_remove_body(w, body);
    }
    if (step % 10 != 0 || w->body_count == w->capacity)
        return NARC_OK;
    const uint32_t shape = (uint32_t)random_between(&seed, 2, 2 + KINDS);
    const float x = random_between(&seed, -3, 3), angle = random_between(&seed, -3, 3);
    world_body body = make_body(shape, x, 12, angle);
    body.velocity.y = -8; /* out of the way of the next one */
    return world_add_body(w, body);
}

/* ------------------------------------------------------------------------------------------------ ground */

void put_arc(track *t, double radius, double sweep) {
    const double x = t->x - radius * cos(t->normal), y = t->y - radius * sin(t->normal);
    t->arcs[t->count++] = (narc_arc){x, y, radius, t->normal, t->normal + sweep};
    t->normal += sweep;
    t->x = x + radius * cos(t->normal);
    t->y = y + radius * sin(t->normal);
}

void put_edge(track *t, double length) {
    t->x -= length * sin(t->normal);
    t->y += length * cos(t->normal);
}

static void add_ground(world *w, const track *t) {
    if (w->error.status == NARC_OK)
        world_add_ground(w, t->arcs, t->count, false, 0.6f);
}

static world_body *add_ball(world *w, double radius, double x, double y, float friction) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_build_circle(radius, arcs, &count, &w->error);
    world_body ball = make_body(add_shape(w, arcs, count), (float)x, (float)y, 0);
    ball.friction = friction;
    add_body(w, ball);
    return &w->bodies[w->body_count - 1];
}

/* A car at rest on the ground at (x, y): its hull, then its wheels. The scene's first bodies. */
void add_car(world *w, double x, double y) {
    const narc_point hull[] = {{-1.2, -0.3}, {1.2, -0.3}, {1.3, 0}, {0.5, 0.5}, {-0.7, 0.5}, {-1.3, 0.1}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_build_polygon(hull, sizeof hull / sizeof hull[0], 0.1, arcs, &count, &w->error);
    add_body(w, make_body(add_shape(w, arcs, count), (float)x, (float)y + 0.9f, 0));
    for (int k = 0; k < 2; k++)
        add_ball(w, 0.4, x + (k ? 0.85 : -0.85), y + 0.4, 1);
    for (int k = 0; k < 3; k++) {
        w->bodies[k].owner = 0;
        w->bodies[k].velocity.x = 5;
    }
    for (int k = 1; k < 3 && w->error.status == NARC_OK; k++)
        world_pin(w, &w->bodies[0], &w->bodies[k], w->bodies[k].position);
}

/* Hills as {angle of the slopes, radius of the valleys, radius of the crest}, and a car. */
static void build_car(world *w, uint64_t seed) {
    static const double hills[][3] = {{0.5, 4, 7}, {0.7, 3, 2.5}, {0.5, 4, 4}};
    track t = {.x = 0, .normal = pi / 2};
    put_arc(&t, 0, 0);
    put_edge(&t, 3);
    for (size_t k = 0; k < sizeof hills / sizeof hills[0]; k++) {
        put_arc(&t, -hills[k][1], -hills[k][0]);
        put_arc(&t, hills[k][2], 2 * hills[k][0]);
        put_arc(&t, -hills[k][1], -hills[k][0]);
        put_edge(&t, 1);
    }
    put_edge(&t, 4);
    put_arc(&t, 0, 0);
    add_ground(w, &t);
    add_car(w, (double)((float)t.x + 2 + random_between(&seed, 0, 0.1f)), 0);
}

/* The motor turns the wheels against the car, with at most 6 N m each, towards 6 m/s. */
narc_status act_car(world *w, long step) {
    const float most = 6 * w->settings.time_step, wanted = -6 / 0.4f;
    for (int k = 1; k < 3; k++) {
        world_body *wheel = &w->bodies[k];
        const float push = fmaxf(-most, fminf((wanted - wheel->spin) / wheel->inverse_inertia, most));
        wheel->spin += wheel->inverse_inertia * push;
        w->bodies[0].spin -= w->bodies[0].inverse_inertia * push;
        world_wake_body(wheel);
    }
    (void)step;
    return NARC_OK;
}

void add_looping(world *w, double x, double height) {
    const double radius = 2, marble = 0.25, slope = 0.8, gap = 0.8, valley = 3;
    track t = {.normal = 2.5 * pi - gap};
    t.x = x + radius * cos(t.normal + pi);
    t.y = radius + radius * sin(t.normal + pi);
    put_arc(&t, -radius, gap / 2 - pi);
    put_arc(&t, -radius, gap / 2 - pi);
    put_edge(&t, 3);
    put_arc(&t, -valley, -slope);
    put_edge(&t, 6);
    put_arc(&t, 0, 0);
    add_ground(w, &t);
    const double rise = height + marble * (1 - cos(slope)) - valley * (1 - cos(slope)); /* along the slope */
    add_ball(w, marble, x - 3 - valley * sin(slope) - rise / tan(slope) + marble * sin(slope), height + marble, 0);
}

/* What slides without friction comes through a looping if it starts 2.5 times as high as its centre's circle is wide. */
static void build_looping(world *w, uint64_t seed) {
    const double radius = 2 - 0.25;
    add_looping(w, 0, (2.6 + (double)random_between(&seed, 0, 0.02f)) * radius);
    add_looping(w, 12, 2.2 * radius);
}

/* A box slides to and fro in a bowl of radius 5, and comes to rest on two corners. */
static void build_bowl(world *w, uint64_t seed) {
    track t = {.x = 5 * sin(1.3), .y = 5 - 5 * cos(1.3), .normal = pi / 2 + 1.3};
    put_arc(&t, -5, -2.6);
    add_ground(w, &t);
    const float angle = -1 + random_between(&seed, -0.01f, 0.01f);
    world_body box = make_body(add_box(w, 2, 1, 0), 4.3f * sinf(angle), 5 - 4.3f * cosf(angle), angle);
    box.friction = 0.02f;
    add_body(w, box);
}

/* A gear of six teeth: three bars, and a hub that holds each by two pins. */
static void add_gear(world *w, float x, float y, float angle) {
    enum { BARS = 3 };
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_build_box(1.3, 0.26, 0.08, arcs, &count, &w->error);
    const uint32_t bar = add_shape(w, arcs, count);
    narc_build_circle(0.4, arcs, &count, &w->error);
    const uint32_t hub = add_shape(w, arcs, count);
    for (int k = 0; k <= BARS; k++) {
        add_body(w, make_body(k < BARS ? bar : hub, x, y, angle + (float)(pi / BARS) * (float)k));
        if (w->error.status != NARC_OK)
            return;
        w->bodies[w->body_count - 1].owner = (uint32_t)w->joint_count; /* a number of its own */
    }
    world_body *const last = &w->bodies[w->body_count - 1];
    for (world_body *body = last - BARS; body < last; body++)
        for (float side = -0.3f; side < 0.5f; side += 0.6f)
            world_pin(w, last, body, add(body->position, to_world(body, (vec){side, 0})));
}

/* A well whose bottom is half of a circle, and above it a thousand bodies, gears among them. */
static void build_well(world *w, uint64_t seed) {
    enum { COLUMNS = 25, BODIES = 1000 };
    const double radius = 20, wall = 14;
    track t = {.x = radius, .y = radius + wall, .normal = pi};
    uint32_t shapes[KINDS * SIZES];
    put_arc(&t, 0, 0);
    put_edge(&t, wall);
    put_arc(&t, -radius, -pi / 2);
    put_arc(&t, -radius, -pi / 2);
    put_edge(&t, wall);
    put_arc(&t, 0, 0);
    add_ground(w, &t);
    for (int i = 0; i < KINDS * SIZES; i++)
        shapes[i] = add_kind(w, i / SIZES, 0.7 + 0.3 * (i % SIZES));
    for (int k = 0; w->body_count < BODIES && w->error.status == NARC_OK; k++) {
        const uint32_t kind = (uint32_t)random_between(&seed, 0, KINDS * SIZES);
        const float x = 1.4f * ((float)(k % COLUMNS) - 0.5f * (float)(COLUMNS - 1)),
                    y = 18 + 1.4f * (float)(k / COLUMNS), angle = random_between(&seed, -3, 3);
        if (k % 33 == 16)
            add_gear(w, x, y, angle);
        else
            add_body(w, make_body(shapes[kind], x, y, angle));
    }
}

/* An n-arc of eight arcs, and a polygon of its junctions, on two equal slopes. */
static void build_wheels(world *w, uint64_t seed) {
    enum { CORNERS = 8 };
    const double slope = 0.12, size = 1, length = 30, along = length - 2 - (double)random_between(&seed, 0, 0.1f);
    narc_point corners[CORNERS];
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count = 0;
    for (int k = 0; k < CORNERS; k++)
        corners[k] = (narc_point){size * cos(pi / 4 * k), size * sin(pi / 4 * k)};
    for (int k = 0; k < 2; k++) {
        track t = {.x = 14, .y = 6 * (double)(1 - k), .normal = pi / 2 - slope};
        const double x = t.x - along * cos(slope) + size * sin(slope), y = t.y + along * sin(slope) + size * cos(slope);
        put_arc(&t, 0, 0);
        put_edge(&t, length);
        put_arc(&t, 0, 0);
        add_ground(w, &t);
        if (k == 0)
            narc_build_ring(corners, CORNERS, arcs, &count, &w->error);
        else
            narc_build_polygon(corners, CORNERS, 0, arcs, &count, &w->error);
        add_body(w, make_body(add_shape(w, arcs, count), (float)x, (float)y, 0));
        w->bodies[w->body_count - 1].velocity.x = 1;
    }
}

/* A ball rolls down a hill and into dominoes, which stand on a slope. */
static void build_dominoes(world *w, uint64_t seed) {
    const double slope = 0.12, apart = 0.55;
    track t = {.x = 3, .normal = pi / 2};
    put_arc(&t, 0, 0);
    put_edge(&t, 3);
    put_arc(&t, -4, -slope);
    const double x = t.x, y = t.y;
    put_edge(&t, 20 * apart + 1);
    put_arc(&t, -5, -0.5);
    put_edge(&t, 2);
    put_arc(&t, 2, 0.5 + slope);
    put_edge(&t, 1);
    put_arc(&t, 0, 0);
    add_ground(w, &t);
    const uint32_t domino = add_box(w, 0.2, 1, 0);
    for (int k = 1; k <= 20; k++) {
        const double along = apart * k, up = 0.5;
        add_body(w, make_body(domino, (float)(x - along * cos(slope) + up * sin(slope)),
                              (float)(y + along * sin(slope) + up * cos(slope)),
                              random_between(&seed, -0.001f, 0.001f) - (float)slope));
    }
    add_ball(w, 0.4, t.x + 1.6, t.y + 0.4, 0.6f)->velocity.x = 1;
}

/* ------------------------------------------------------------------------------------------------ platforms */

void add_platform(world *w, double left, double right, double height) {
    track t = {.x = right, .y = height, .normal = pi / 2};
    put_arc(&t, 0, 0);
    put_edge(&t, right - left);
    put_arc(&t, 0, 0);
    if (w->error.status == NARC_OK)
        world_add_platform(w, t.arcs, t.count, 0.6f);
}

/* A floor, and above it platforms, the second of which goes to and fro, and the third up and down. */
static void build_platforms(world *w, uint64_t seed) {
    add_block(w, 40, 2, 0, -1);
    add_platform(w, -6, 6, 2);
    add_platform(w, -4, 4, 4);
    add_platform(w, -5, 5, 6);
    for (int k = 0; k < KINDS; k++)
        add_body(w, make_body(add_kind(w, k, 0.8), random_between(&seed, -3, 3), 1 + (float)k, 0));
}

/* In turns a body jumps, and the next one drops for a quarter of a second. */
static narc_status act_platforms(world *w, long step) {
    const float turn = (float)(step % 240) < 120 ? 1 : -1;
    world_move_platform(w, 2, (vec){turn, 0});
    world_move_platform(w, 3, (vec){0, 0.5f * turn});
    for (size_t k = 1; k < w->body_count; k++)
        w->bodies[k].drops = w->bodies[k].drops && step % 15 != 0;
    if (step % 30 != 0)
        return NARC_OK;
    world_body *const body = &w->bodies[1 + (size_t)(step / 30) % (w->body_count - 1)];
    world_wake_body(body);
    if (step % 60 == 0)
        body->velocity.y = 8;
    else
        body->drops = true;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ the list */

const scene scenes[] = {
    {"stack", "30 boxes stand on each other", 60, 32, build_stack, NULL},
    {"pyramid", "210 boxes", 30, 256, build_pyramid, NULL},
    {"rounded", "210 boxes with round corners", 30, 256, build_rounded_pyramid, NULL},
    {"heap", "200 bodies of 30 shapes fall into a box", 15, 256, build_heap, NULL},
    {"pile", "600 bodies", 20, 1024, build_pile, NULL},
    {"well", "1,000 bodies fall into a half circle", 20, 2048, build_well, NULL},
    {"wheels", "an n-arc of eight arcs and a polygon of eight corners roll", 6, 64, build_wheels, NULL},
    {"bullets", "120 m/s against a thin wall", 3, 16, build_bullets, NULL},
    {"plates", "400 m/s against a plate of 1 cm", 6, 32, build_plates, act_plates},
    {"rain", "bodies come, pile up on a table, fall off, and go", 60, 256, build_rain, act_rain},
    {"car", "drives over hills", 6, 128, build_car, act_car},
    {"looping", "a marble comes through it, another one does not", 3.2f, 64, build_looping, NULL},
    {"bowl", "a box slides in it, and rests on two corners", 20, 32, build_bowl, NULL},
    {"dominoes", "fall on a slope", 8, 128, build_dominoes, NULL},
    {"platforms", "bodies jump and drop through them", 20, 64, build_platforms, act_platforms},
    {0},
};

const scene *find_scene(const char *name) {
    for (const scene *s = scenes; s->name; s++)
        if (strcmp(s->name, name) == 0)
            return s;
    return NULL;
}

narc_status build_scene(const scene *chosen, world_settings settings, uint64_t seed, world *out_world) {
    if (world_create(out_world, settings, chosen->capacity) == NARC_OK)
        chosen->build(out_world, seed);
    return out_world->error.status;
}

narc_status step_scene(const scene *chosen, world *w, long step) {
    const narc_status status = chosen->act ? chosen->act(w, step) : NARC_OK;
    return status == NARC_OK ? world_step(w) : status;
}

scene_state measure_scene(const world *w) {
    scene_state state = {.energy = world_energy(w)};
    for (size_t k = 0; k < w->body_count; k++) {
        const world_body *body = &w->bodies[k];
        const vec way = subtract(body->position, body->start);
        state.displacement = fmax(state.displacement, (double)length(way));
        state.sideways = fmax(state.sideways, (double)fabsf(way.x));
        state.moving += !(world_speed(w, body) <= 0.01f);
        state.awake += body->kind == 0;
    }
    for (size_t k = 0; k < w->result->count; k++) {
        const world_contact *const c = world_contact_of(w, k);
        for (unsigned i = 0; i < c->point_count; i++, state.points++)
            state.overlap = fmax(state.overlap, -(double)c->points[i].separation);
    }
    return state;
}
