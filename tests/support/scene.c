/* SPDX-License-Identifier: MIT
 *
 * scene.c - shapes, bodies and pairs of the tests.
 */
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    assert_non_null(memory);
    return memory;
}

struct scene create_scene(narc_precision precision, size_t shapes, size_t bodies, size_t pairs) {
    struct scene scene = {.precision = precision,
                          .shapes = allocate(shapes, sizeof(struct shape)),
                          .bodies = allocate(bodies, sizeof(struct body)),
                          .pairs = allocate(pairs, sizeof(struct pair))};
    assert_int_equal(narc_create_shapes(NULL, &scene.store), NARC_OK);
    return scene;
}

void destroy_scene(struct scene *scene) {
    narc_destroy_shapes(scene->store);
    free(scene->shapes);
    free(scene->bodies);
    free(scene->pairs);
}

uint32_t scene_add_shape(struct scene *scene, const struct shape *shape) {
    const uint32_t index = (uint32_t)scene->shape_count;
    narc_error error;
    if (narc_add_shape_at(scene->store, index, shape->arcs, shape->count, &error) != NARC_OK)
        fail_msg("a valid shape was refused: %s", error.message);
    scene->shapes[scene->shape_count++] = *shape;
    return index;
}

uint32_t scene_add_body(struct scene *scene, struct body body) {
    round_position(&body, scene->precision);
    scene->bodies[scene->body_count] = body;
    return (uint32_t)scene->body_count++;
}

uint32_t scene_add_pair(struct scene *scene, uint32_t a, uint32_t b) {
    scene->pairs[scene->pair_count] = (struct pair){a, b};
    return (uint32_t)scene->pair_count++;
}

void scene_add_two(struct scene *scene, struct body a, struct body b) {
    const uint32_t first = scene_add_body(scene, a);
    scene_add_pair(scene, first, scene_add_body(scene, b));
}

narc_bodies scene_bodies(const struct scene *scene) {
    const struct body *body = scene->bodies;
    narc_bodies bodies = {.count = scene->body_count,
                          .cosine = NARC_COLUMN(body, cosine),
                          .sine = NARC_COLUMN(body, sine),
                          .scale = NARC_COLUMN(body, scale),
                          .shape = NARC_COLUMN(body, shape)};
    bool single = scene->precision == NARC_FLOAT32;
    bodies.x = single ? NARC_POSITION_COLUMN(body, x_single) : NARC_POSITION_COLUMN(body, x);
    bodies.y = single ? NARC_POSITION_COLUMN(body, y_single) : NARC_POSITION_COLUMN(body, y);
    return bodies;
}

narc_body scene_body(const struct scene *scene, uint32_t index) {
    const struct body *body = &scene->bodies[index];
    return (narc_body){body->x, body->y, body->cosine, body->sine, body->scale, body->shape};
}

narc_pairs scene_pairs(const struct scene *scene) {
    return (narc_pairs){
        .count = scene->pair_count, .a = NARC_COLUMN(scene->pairs, a), .b = NARC_COLUMN(scene->pairs, b)};
}

narc_motions view_motions(const narc_motion *motion) {
    return (narc_motions){
        .x = NARC_COLUMN(motion, x), .y = NARC_COLUMN(motion, y), .angle = NARC_COLUMN(motion, angle)};
}

struct reference_body pose_shape(const struct shape *shape, const struct body *body) {
    return (struct reference_body){shape->arcs,        shape->count,       body->x, body->y, (double)body->cosine,
                                   (double)body->sine, (double)body->scale};
}

struct reference_body scene_reference(const struct scene *scene, uint32_t body) {
    struct reference_body placed = pose_shape(&scene->shapes[scene->bodies[body].shape], &scene->bodies[body]);
    const double length = hypot(placed.cosine, placed.sine);
    placed.cosine /= length;
    placed.sine /= length;
    return placed;
}

struct body turned_body(double angle, double scale) {
    return (struct body){.cosine = (float)cos(angle), .sine = (float)sin(angle), .scale = (float)scale};
}

/* volatile: GCC 12 takes (double)(float) of two neighbours for nothing to do when it vectorises them. */
static float round_single(double value) {
    volatile float rounded = (float)value;
    return rounded;
}

void round_position(struct body *body, narc_precision precision) {
    body->x_single = round_single(body->x);
    body->y_single = round_single(body->y);
    if (precision == NARC_FLOAT32) {
        body->x = (double)body->x_single;
        body->y = (double)body->y_single;
    }
}

struct body fly_away(struct body body, size_t k, narc_precision precision) {
    static const double away[] = {1e20, 1e24, 1e30, 1e38};
    static const int way_x[] = {1, -1, 0, 0, 1, -1}, way_y[] = {0, 0, 1, -1, 1, -1};
    body.x += away[k % 4] * way_x[k / 4 % 6];
    body.y += away[k % 4] * way_y[k / 4 % 6];
    round_position(&body, precision);
    return body;
}

void scene_move_bodies(struct scene *scene, struct test_random *random, double step) {
    for (size_t k = 0; k < scene->body_count; k++) {
        struct body *body = &scene->bodies[k];
        const double angle = atan2((double)body->sine, (double)body->cosine) + step * random_between(random, -1, 1);
        body->cosine = (float)cos(angle);
        body->sine = (float)sin(angle);
        body->x += (double)body->scale * step * random_between(random, -1, 1);
        body->y += (double)body->scale * step * random_between(random, -1, 1);
        round_position(body, scene->precision);
    }
}

void *make_junk(size_t size) { return memset(allocate(size, 1), GUARD_JUNK, size); }

bool is_junk(const void *memory, size_t size) {
    const unsigned char *byte = memory;
    for (size_t k = 0; k < size; k++)
        if (byte[k] != GUARD_JUNK)
            return false;
    return true;
}

uint64_t *find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                        const narc_query *query) {
    uint64_t *bits = make_junk(NARC_BIT_WORDS(pairs->count) * sizeof *bits);
    narc_error error;
    expect_ok(narc_find_overlaps(shapes, bodies, pairs, query, bits, &error), &error);
    return bits;
}

struct contacts find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                              const narc_query *query) {
    struct contacts list = {make_junk(pairs->count * sizeof *list.rows), 0};
    narc_error error;
    expect_ok(narc_find_contacts(shapes, bodies, pairs, query, list.rows, pairs->count, &list.count, &error), &error);
    return list;
}

struct manifolds find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query) {
    struct manifolds list = {make_junk(pairs->count * sizeof *list.rows), 0};
    narc_error error;
    expect_ok(narc_find_manifolds(shapes, bodies, pairs, query, list.rows, pairs->count, &list.count, &error), &error);
    return list;
}

narc_status ask_overlaps(const struct scene *scene, const narc_query *query, uint64_t *out_bits, narc_error *error) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    return narc_find_overlaps(scene->store, &bodies, &pairs, query, out_bits, error);
}

narc_status ask_contacts(const struct scene *scene, const narc_query *query, narc_contact *out_rows, size_t capacity,
                         size_t *out_count, narc_error *error) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    return narc_find_contacts(scene->store, &bodies, &pairs, query, out_rows, capacity, out_count, error);
}

uint64_t *scene_overlaps(const struct scene *scene) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    return find_overlaps(scene->store, &bodies, &pairs, NULL);
}

struct contacts scene_contacts(const struct scene *scene, float margin) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    return find_contacts(scene->store, &bodies, &pairs, &(narc_query){.margin = margin});
}

struct manifolds scene_manifolds(const struct scene *scene, float margin) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    return find_manifolds(scene->store, &bodies, &pairs, &(narc_query){.margin = margin});
}

struct scene make_random_scene(struct test_random *random, narc_precision precision, size_t bodies, size_t pairs) {
    const size_t shapes_per_family = 4;
    /* Bodies are about 2 wide: on a square of this width about half of the pairs collide. */
    const double world = 2.5;
    struct scene scene = create_scene(precision, shapes_per_family * FAMILY_COUNT, bodies, pairs);
    for (size_t k = 0; k < shapes_per_family * FAMILY_COUNT; k++) {
        struct shape shape = make_shape(random, (enum family)(k % FAMILY_COUNT));
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < bodies; k++) {
        bool lattice = random_below(random, 8) == 0;
        double angle = lattice ? PI / 2 * (double)random_below(random, 4) : random_between(random, -PI, PI);
        struct body body = turned_body(angle, lattice ? 1 : random_log_between(random, 0.25, 2));
        body.x = random_between(random, 0, world);
        body.y = random_between(random, 0, world);
        body.shape = (uint32_t)random_below(random, scene.shape_count);
        scene_add_body(&scene, body);
    }
    for (size_t k = 0; k < pairs; k++) {
        uint32_t a = (uint32_t)random_below(random, bodies);
        scene_add_pair(&scene, a, (uint32_t)random_below(random, bodies));
    }
    return scene;
}

narc_index *index_bodies(const narc_shapes *shapes, const narc_bodies *bodies, const narc_index_options *options,
                         narc_box *out_boxes) {
    narc_index *index = NULL;
    assert_int_equal(narc_compute_boxes(shapes, bodies, NULL, out_boxes, NULL), NARC_OK);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, out_boxes, bodies->count, options, NULL), NARC_OK);
    return index;
}
