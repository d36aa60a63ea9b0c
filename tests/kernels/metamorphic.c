/* SPDX-License-Identifier: MIT
 *
 * metamorphic.c - the same pair scaled: the answer must follow. everything.c has it moved, pairs.c swapped.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "placements.h"

/* Positions in multiples of this much stay exact in single precision when moved by up to 2^12. */
static const double grid = 0x1p-10;

enum { PAIRS = 2000 };

static double snap(double value) { return round(value / grid) * grid; }

static struct scene make_scene(const char *name) {
    struct test_random random = test_random_named(name);
    size_t pairs = test_trials(PAIRS);
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 400, pairs);
    for (size_t k = 0; k < scene.body_count; k++) {
        scene.bodies[k].x = snap(scene.bodies[k].x);
        scene.bodies[k].y = snap(scene.bodies[k].y);
        round_position(&scene.bodies[k], NARC_FLOAT32);
    }
    return scene;
}

/* A power of two changes exponents only: lengths follow, directions stay to the last bit. `world`: of all; else a scale says
 * the same as a shape that is so much larger. */
static void check_scaled(const char *name, float factor, bool world) {
    AUTO(destroy_scene) struct scene scene = make_scene(name);
    AUTO(free_at) struct contacts before = scene_contacts(&scene, INFINITY);
    AUTO(free_at) uint64_t *const bits = scene_overlaps(&scene);
    narc_shapes *const larger = empty_store(), *const usual = scene.store;
    for (uint32_t k = 0; k < scene.shape_count; k++) {
        struct shape shape = scene.shapes[k];
        for (size_t i = 0; i < shape.count && !world; i++) {
            shape.arcs[i].center_x /= (double)factor;
            shape.arcs[i].center_y /= (double)factor;
            shape.arcs[i].radius /= (double)factor;
        }
        assert_int_equal(narc_add_shape_at(larger, k, shape.arcs, shape.count, NULL), NARC_OK);
    }
    scene.store = larger;
    for (size_t k = 0; k < scene.body_count; k++) {
        struct body *const body = &scene.bodies[k];
        body->x *= world ? (double)factor : 1;
        body->y *= world ? (double)factor : 1;
        body->scale *= factor;
        round_position(body, NARC_FLOAT32);
    }
    AUTO(free_at) struct contacts after = scene_contacts(&scene, INFINITY);
    AUTO(free_at) uint64_t *const scaled = scene_overlaps(&scene);
    assert_int_equal(before.count, after.count);
    for (size_t k = 0; k < after.count && world; k++) {
        narc_contact *const row = &after.rows[k];
        row->separation /= factor;
        row->point_x /= factor;
        row->point_y /= factor;
        row->radius_a /= factor;
        row->radius_b /= factor;
    }
    assert_memory_equal(bits, scaled, 8 * NARC_BIT_WORDS(after.count));
    assert_memory_equal(before.rows, after.rows, after.count * sizeof *after.rows);
    narc_destroy_shapes(usual);
}

TEST(test_scale) {
    check_scaled("scale up", 0x1p10f, true);
    check_scaled("scale down", 0x1p-10f, true);
    check_scaled("scaled shapes", 0.5f, false);
}

TEST_MAIN("metamorphic")
