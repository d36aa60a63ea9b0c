/* SPDX-License-Identifier: MIT
 *
 * metamorphic.c - the same pair seen otherwise: turned, scaled. The answer must follow. everything.c has it moved, pairs.c
 * swapped.
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

/* Answers before and after a change of the scene. Pair k is pair k in both. */
struct change {
    struct scene scene;
    struct contacts before, after;
    uint64_t *bits_before, *bits_after;
};

static struct change begin_change(const char *name) {
    struct change change = {.scene = make_scene(name)};
    change.before = scene_contacts(&change.scene, INFINITY);
    change.bits_before = scene_overlaps(&change.scene);
    return change;
}

static void apply_change(struct change *change) {
    change->after = scene_contacts(&change->scene, INFINITY);
    change->bits_after = scene_overlaps(&change->scene);
    assert_int_equal(change->before.count, change->after.count);
}

static void end_change(struct change *change) {
    free(change->before.rows);
    free(change->after.rows);
    free(change->bits_before);
    free(change->bits_after);
    destroy_scene(&change->scene);
}

static double bound_of(const struct scene *scene, size_t k) {
    struct reference_body a = scene_reference(scene, scene->pairs[k].a), b = scene_reference(scene, scene->pairs[k].b);
    return separation_bound(&a, &b);
}

/* Both answers are within one bound of the same exact value. */
static void check_separations(const struct change *change, size_t k) {
    double before = (double)change->before.rows[k].separation, after = (double)change->after.rows[k].separation;
    double bound = 2 * bound_of(&change->scene, k);
    assert_true(fabs(before - after) <= bound);
    if (fabs(before) > bound)
        assert_int_equal(bit_is_set(change->bits_before, k), bit_is_set(change->bits_after, k));
}

static void check_same_bits(const struct change *change) {
    size_t count = change->before.count;
    assert_memory_equal(change->bits_before, change->bits_after, 8 * NARC_BIT_WORDS(count));
    assert_memory_equal(change->before.rows, change->after.rows, count * sizeof(narc_contact));
}

/* By any angle. Turning the rounded positions rounds them again, hence doubles. */
TEST(test_rotate) {
    struct change change = begin_change("rotate");
    struct test_random random = test_random_named("angle");
    double angle = random_between(&random, -PI, PI), c = cos(angle), s = sin(angle);
    change.scene.precision = NARC_FLOAT64;
    for (size_t k = 0; k < change.scene.body_count; k++) {
        struct body *body = &change.scene.bodies[k];
        double x = body->x, y = body->y, cosine = (double)body->cosine, sine = (double)body->sine;
        body->x = c * x - s * y;
        body->y = s * x + c * y;
        body->cosine = (float)(c * cosine - s * sine);
        body->sine = (float)(s * cosine + c * sine);
    }
    apply_change(&change);
    for (size_t k = 0; k < change.scene.pair_count; k++)
        check_separations(&change, k);
    end_change(&change);
}

/* A power of two changes exponents only: lengths follow, directions stay to the last bit. */
static void scale_world(const char *name, float factor) {
    struct change change = begin_change(name);
    for (size_t k = 0; k < change.scene.body_count; k++) {
        struct body *body = &change.scene.bodies[k];
        body->x *= (double)factor;
        body->y *= (double)factor;
        body->scale *= factor;
        round_position(body, NARC_FLOAT32);
    }
    apply_change(&change);
    for (size_t k = 0; k < change.after.count; k++) {
        narc_contact *row = &change.after.rows[k];
        row->separation /= factor;
        row->point_x /= factor;
        row->point_y /= factor;
        row->radius_a /= factor;
        row->radius_b /= factor;
    }
    check_same_bits(&change);
    end_change(&change);
}

TEST(test_scale_up) { scale_world("scale up", 0x1p10f); }

TEST(test_scale_down) { scale_world("scale down", 0x1p-10f); }

/* A scale of 2 says the same as a shape twice as large. */
TEST(test_scaled_shapes) {
    struct change change = begin_change("scaled shapes");
    narc_shapes *larger = empty_store();
    for (size_t k = 0; k < change.scene.shape_count; k++) {
        struct shape shape = change.scene.shapes[k];
        for (size_t i = 0; i < shape.count; i++) {
            shape.arcs[i].center_x *= 2;
            shape.arcs[i].center_y *= 2;
            shape.arcs[i].radius *= 2;
        }
        assert_int_equal(narc_add_shape_at(larger, (uint32_t)k, shape.arcs, shape.count, NULL), NARC_OK);
    }
    narc_destroy_shapes(change.scene.store);
    change.scene.store = larger;
    for (size_t k = 0; k < change.scene.body_count; k++)
        change.scene.bodies[k].scale /= 2;
    apply_change(&change);
    check_same_bits(&change);
    end_change(&change);
}

TEST_MAIN("metamorphic")
