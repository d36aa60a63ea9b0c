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

static narc_status add_box(world *w, double width, double height, double radius, uint32_t *out_shape) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const narc_status status = narc_build_box(width, height, radius, arcs, &count, &w->error);
    return status == NARC_OK ? world_add_shape(w, arcs, count, out_shape) : status;
}

/* A box that never moves. */
static narc_status add_block(world *w, float width, float height, float x, float y) {
    uint32_t shape = 0;
    const narc_status status = add_box(w, (double)width, (double)height, 0, &shape);
    world_body block = make_body(shape, x, y, 0);
    block.kind = NARC_STATIC;
    return status == NARC_OK ? world_add_body(w, block) : status;
}

/* ------------------------------------------------------------------------------------------------ stacks */

static narc_status build_stack(world *w, uint64_t seed) {
    uint32_t box = 0;
    narc_status status = add_block(w, 20, 2, 0, -1);
    if (status == NARC_OK)
        status = add_box(w, 1, 1, 0, &box);
    for (int row = 0; row < 30 && status == NARC_OK; row++) {
        const float offset = random_between(&seed, -0.02f, 0.02f), tilt = random_between(&seed, -0.001f, 0.001f);
        status = world_add_body(w, make_body(box, offset, 0.5f + (float)row, tilt));
    }
    return status;
}

/* 20 boxes, 19 on them, and so on. */
static narc_status build_pyramid_of(world *w, uint64_t seed, double radius) {
    const float apart = 1.1f;
    uint32_t box = 0;
    narc_status status = add_block(w, 40, 2, 0, -1);
    if (status == NARC_OK)
        status = add_box(w, 1, 1, radius, &box);
    for (int row = 0; row < 20; row++)
        for (int k = 0; k < 20 - row && status == NARC_OK; k++) {
            const float x = apart * ((float)k - 0.5f * (float)(19 - row));
            const float offset = random_between(&seed, -0.02f, 0.02f), tilt = random_between(&seed, -0.001f, 0.001f);
            status = world_add_body(w, make_body(box, x + offset, 0.5f + (float)row, tilt));
        }
    return status;
}

static narc_status build_pyramid(world *w, uint64_t seed) { return build_pyramid_of(w, seed, 0); }

static narc_status build_rounded_pyramid(world *w, uint64_t seed) { return build_pyramid_of(w, seed, 0.1); }

/* ------------------------------------------------------------------------------------------------ a pile */

/* Shape number `kind` of the pile in a size; its arcs are counted. */
enum { KINDS = 6 + GLYPH_COUNT, SIZES = 3 };

static narc_status build_kind(int kind, double size, narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    const narc_point hexagon[] = {{0.5, 0}, {0.3, 0.4}, {-0.2, 0.4}, {-0.5, 0.1}, {-0.3, -0.4}, {0.2, -0.4}};
    narc_point points[6];
    switch (kind) {
    case 0:
        return narc_build_circle(0.4 * size, out_arcs, out_count, error);
    case 1:
        return narc_build_capsule(0.6 * size, 0.25 * size, out_arcs, out_count, error);
    case 2:
        return narc_build_box(size, 0.7 * size, 0, out_arcs, out_count, error);
    case 3:
        return narc_build_box(0.9 * size, 0.6 * size, 0.15 * size, out_arcs, out_count, error);
    case 4:
        for (int i = 0; i < 6; i++)
            points[i] = (narc_point){size * hexagon[i].x, size * hexagon[i].y};
        return narc_build_polygon(points, 6, 0, out_arcs, out_count, error);
    case 5: /* an n-arc: a lens with round tips */
        return narc_build_four_arc((narc_four_arc){0.8 * size, 0.8 * size, size, 0.1 * size, 0.1 * size}, out_arcs,
                                   out_count, error);
    default:
        for (int i = 0; i < GLYPH_ARCS; i++) {
            out_arcs[i] = glyphs[kind - 6][i];
            out_arcs[i].center_x *= size;
            out_arcs[i].center_y *= size;
            out_arcs[i].radius *= size;
        }
        *out_count = GLYPH_ARCS;
        return NARC_OK;
    }
}

/* Bodies fall into a box without a lid. */
static narc_status build_pile_of(world *w, uint64_t seed, float width, int bodies) {
    const float spacing = 1.3f;
    uint32_t shapes[KINDS * SIZES] = {0};
    narc_status status = add_block(w, width + 4, 4, 0, -2);
    for (int side = -1; side <= 1 && status == NARC_OK; side += 2)
        status = add_block(w, 4, 60, (float)side * (0.5f * width + 2), 26);
    for (int i = 0; i < KINDS * SIZES && status == NARC_OK; i++) {
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count;
        status = build_kind(i / SIZES, 0.7 + 0.3 * (i % SIZES), arcs, &count, &w->error);
        if (status == NARC_OK)
            status = world_add_shape(w, arcs, count, &shapes[i]);
    }
    const int columns = (int)(width / spacing) - 1;
    for (int k = 0; k < bodies && status == NARC_OK; k++) {
        const uint32_t kind = (uint32_t)random_between(&seed, 0, KINDS * SIZES);
        const float x = spacing * ((float)(k % columns) - 0.5f * (float)(columns - 1));
        const float y = spacing * (1 + (float)(k / columns));
        status = world_add_body(w, make_body(shapes[kind], x, y, random_between(&seed, -3, 3)));
    }
    return status;
}

static narc_status build_pile(world *w, uint64_t seed) { return build_pile_of(w, seed, 40, 600); }

static narc_status build_heap(world *w, uint64_t seed) { return build_pile_of(w, seed, 16, 200); }

/* ------------------------------------------------------------------------------------------------ bullets */

/* Bullets of several shapes, 60 m/s, against a wall that is a twentieth of what they fly in one step. */
static narc_status build_bullets(world *w, uint64_t seed) {
    narc_status status = add_block(w, 40, 2, 0, -1);
    if (status == NARC_OK)
        status = add_block(w, 0.05f, 40, 0, 20);
    for (int k = 0; k < 8 && status == NARC_OK; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count;
        uint32_t shape = 0;
        status = build_kind(k, 0.3, arcs, &count, &w->error);
        if (status == NARC_OK)
            status = world_add_shape(w, arcs, count, &shape);
        world_body body = make_body(shape, random_between(&seed, -11, -10), 1 + (float)k, 0);
        body.velocity = (vec){60, random_between(&seed, -1, 1)};
        body.spin = random_between(&seed, -30, 30);
        if (status == NARC_OK)
            status = world_add_body(w, body);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ rain */

/* A sensor below a table, and the shapes that fall on it. */
static narc_status build_rain(world *w, uint64_t seed) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_status status = add_block(w, 60, 2, random_between(&seed, -1, 1), -20);
    w->bodies[0].kind |= NARC_SENSOR;
    if (status == NARC_OK)
        status = add_block(w, 8, 1, 0, 0);
    for (int kind = 0; kind < KINDS && status == NARC_OK; kind++) {
        status = build_kind(kind, 1, arcs, &count, &w->error);
        if (status == NARC_OK)
            status = world_add_shape(w, arcs, count, NULL);
    }
    return status;
}

/* What has reached the sensor goes, and another body comes. */
static narc_status act_rain(world *w, long step) {
    uint64_t seed = (uint64_t)step;
    for (size_t k = 0; k < w->event_count; k++) {
        const world_event *event = &w->events[k];
        const size_t body = world_find_body(w, event->id_a == w->bodies[0].id ? event->id_b : event->id_a);
        if (event->sensor && event->begins && body != SIZE_MAX)
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

static const scene scenes[] = {
    {"stack", "30 boxes stand on each other", 60, 32, build_stack, NULL},
    {"pyramid", "210 boxes", 30, 256, build_pyramid, NULL},
    {"rounded", "210 boxes with round corners", 30, 256, build_rounded_pyramid, NULL},
    {"heap", "200 bodies of 30 shapes fall into a box", 15, 256, build_heap, NULL},
    {"pile", "600 bodies", 20, 1024, build_pile, NULL},
    {"bullets", "60 m/s against a thin wall", 3, 16, build_bullets, NULL},
    {"rain", "bodies come, pile up on a table, fall off, and go", 60, 256, build_rain, act_rain},
};

const scene *get_scene(size_t index) { return index < sizeof scenes / sizeof scenes[0] ? &scenes[index] : NULL; }

const scene *find_scene(const char *name) {
    for (size_t i = 0; get_scene(i); i++)
        if (strcmp(scenes[i].name, name) == 0)
            return &scenes[i];
    return NULL;
}

narc_status build_scene(const scene *chosen, world_settings settings, uint64_t seed, world *out_world) {
    const narc_status status = world_create(out_world, settings, chosen->capacity);
    return status == NARC_OK ? chosen->build(out_world, seed) : status;
}

narc_status step_scene(const scene *chosen, world *w, long step) {
    const narc_status status = chosen->act ? chosen->act(w, step) : NARC_OK;
    return status == NARC_OK ? world_step(w) : status;
}

scene_state measure_scene(const world *w, const world_body *start) {
    scene_state state = {.energy = world_energy(w)};
    for (size_t k = 0; k < w->body_count; k++) {
        const world_body *body = &w->bodies[k];
        const vec way = body->id == start[k].id ? subtract(body->position, start[k].position) : (vec){0, 0};
        state.displacement = fmax(state.displacement, (double)length(way));
        state.sideways = fmax(state.sideways, (double)fabsf(way.x));
        state.moving += !(world_speed(w, body) <= SCENE_MOVING);
        state.awake += body->kind == 0;
    }
    for (size_t k = 0; k < w->list->pairs.count; k++)
        for (unsigned i = 0; i < w->contacts[k].point_count; i++) {
            state.overlap = fmax(state.overlap, -(double)w->contacts[k].points[i].separation);
            state.points++;
            state.contacts += i == 0;
        }
    return state;
}
