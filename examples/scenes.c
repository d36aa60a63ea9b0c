/* SPDX-License-Identifier: MIT
 *
 * scenes.c - stacks, pyramids, piles, bullets, rain.
 */
#include "scenes.h"

#include <string.h>

#include "glyphs.h"

/* SplitMix64; in [low, high). */
static float random_between(uint64_t *state, float low, float high) {
    uint64_t bits = *state += 0x9e3779b97f4a7c15;
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
    bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
    bits ^= bits >> 31;
    return low + (high - low) * (float)(bits >> 40) * 0x1p-24f;
}

static world_body make_body(uint32_t shape, float x, float y, float angle) {
    return (world_body){
        .position = {x, y}, .cosine = cosf(angle), .sine = sinf(angle), .shape = shape, .friction = 0.6f};
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
        narc_build_four_arc(lens, arcs, &count, &w->error);
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

/* ------------------------------------------------------------------------------------------------ the list */

const scene scenes[] = {
    {"stack", "30 boxes stand on each other", 60, 32, build_stack, NULL},
    {"pyramid", "210 boxes", 30, 256, build_pyramid, NULL},
    {"rounded", "210 boxes with round corners", 30, 256, build_rounded_pyramid, NULL},
    {"heap", "200 bodies of 30 shapes fall into a box", 15, 256, build_heap, NULL},
    {"pile", "600 bodies", 20, 1024, build_pile, NULL},
    {"bullets", "120 m/s against a thin wall", 3, 16, build_bullets, NULL},
    {"rain", "bodies come, pile up on a table, fall off, and go", 60, 256, build_rain, act_rain},
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
    for (size_t k = 0; k < w->list->pairs.count; k++)
        for (unsigned i = 0; i < w->contacts[k].point_count; i++, state.points++)
            state.overlap = fmax(state.overlap, -(double)w->contacts[k].points[i].separation);
    return state;
}
