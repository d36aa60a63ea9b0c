/* SPDX-License-Identifier: MIT
 *
 * garbage.c - bodies made of NaN, infinity, huge, tiny and random numbers: nothing crashes, nothing hangs, no
 * NaN comes out, and what has no answer does not collide.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { BODIES = 200 };

/* Every number is one, and both answers agree. */
static void check_sane(const struct scene *scene, const uint64_t *bits, const struct contacts *all) {
    assert_int_equal(all->count, scene->pair_count);
    for (size_t k = 0; k < all->count; k++) {
        const narc_contact *c = &all->rows[k];
        if (isnan(c->separation) || isnan(c->normal_x) || isnan(c->normal_y) || isnan(c->point_x) ||
            isnan(c->point_y) || isnan(c->radius_a) || isnan(c->radius_b)) {
            struct reference_body a = scene_reference(scene, scene->pairs[k].a),
                                  b = scene_reference(scene, scene->pairs[k].b);
            print_pair(&a, &b);
            fail_msg("NaN: separation %g, normal (%g, %g), point (%g, %g), radii %g and %g", (double)c->separation,
                     (double)c->normal_x, (double)c->normal_y, (double)c->point_x, (double)c->point_y,
                     (double)c->radius_a, (double)c->radius_b);
        }
        assert_int_equal(bit_is_set(bits, k), c->separation < 0);
        size_t count_a = scene->shapes[scene->bodies[scene->pairs[k].a].shape].count;
        size_t count_b = scene->shapes[scene->bodies[scene->pairs[k].b].shape].count;
        assert_true(arc_of_a(c->feature) < count_a && arc_of_b(c->feature) < count_b);
    }
}

static void check_same_as_scalar(const struct scene *scene, const uint64_t *bits, const struct contacts *all) {
    test_use_isa("scalar");
    uint64_t *scalar_bits = scene_overlaps(scene);
    struct contacts scalar = scene_contacts(scene, INFINITY);
    test_use_isa(test_isa());
    assert_memory_equal(bits, scalar_bits, NARC_BIT_WORDS(scene->pair_count) * sizeof(uint64_t));
    assert_memory_equal(all->rows, scalar.rows, all->count * sizeof *all->rows);
    free(scalar.rows);
    free(scalar_bits);
}

/* What the header names: such a body collides with nothing, and has separation +infinity and all else 0. */
static void check_no_answer(const struct contacts *all, const uint64_t *bits, size_t k) {
    const narc_contact none = {.pair = (uint32_t)k, .separation = INFINITY};
    assert_false(bit_is_set(bits, k));
    assert_memory_equal(&all->rows[k], &none, sizeof none);
}

/* Good bodies, on half of which one number is spoilt. Pairs of two good ones keep their answer to the last bit. */
static void check_spoilt(const char *name, narc_precision precision,
                         void (*spoil)(struct test_random *, struct body *)) {
    struct test_random random = test_random_named(name);
    struct scene scene = make_random_scene(&random, precision, BODIES, test_trials(5000));
    struct contacts before = scene_contacts(&scene, INFINITY);
    uint64_t *bits_before = scene_overlaps(&scene);
    for (size_t k = 0; k < BODIES; k += 2) {
        spoil(&random, &scene.bodies[k]);
        scene.bodies[k].x_single = (float)scene.bodies[k].x;
        scene.bodies[k].y_single = (float)scene.bodies[k].y;
    }
    uint64_t *bits = scene_overlaps(&scene);
    struct contacts all = scene_contacts(&scene, INFINITY), colliding = scene_contacts(&scene, 0);
    check_sane(&scene, bits, &all);
    check_same_as_scalar(&scene, bits, &all);
    size_t found = 0;
    for (size_t k = 0; k < all.count; k++) {
        if (scene.pairs[k].a % 2 == 0 || scene.pairs[k].b % 2 == 0) {
            check_no_answer(&all, bits, k);
        } else {
            assert_int_equal(bit_is_set(bits, k), bit_is_set(bits_before, k));
            assert_memory_equal(&all.rows[k], &before.rows[k], sizeof all.rows[k]);
        }
        found += bit_is_set(bits, k);
    }
    assert_int_equal(found, colliding.count);
    free(all.rows);
    free(colliding.rows);
    free(before.rows);
    free(bits);
    free(bits_before);
    destroy_scene(&scene);
}

static float not_finite(struct test_random *random) {
    static const uint32_t patterns[] = {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0xffffffffu, 0x7f800000u, 0xff800000u};
    float value;
    memcpy(&value, &patterns[random_below(random, 6)], sizeof(value));
    return value;
}

static void spoil_with_not_finite(struct test_random *random, struct body *body) {
    float value = not_finite(random);
    switch (random_below(random, 5)) {
    case 0:
        body->x = (double)value;
        break;
    case 1:
        body->y = (double)value;
        break;
    case 2:
        body->cosine = value;
        break;
    case 3:
        body->sine = value;
        break;
    default:
        body->scale = value;
        break;
    }
}

TEST(test_not_finite) {
    check_spoilt("not finite", NARC_FLOAT32, spoil_with_not_finite);
    check_spoilt("not finite, double", NARC_FLOAT64, spoil_with_not_finite);
}

static void spoil_scale(struct test_random *random, struct body *body) {
    static const float scales[] = {0.0f,   -0.0f, -1.0f,   FLT_TRUE_MIN, FLT_MIN,
                                   1e-12f, 1e12f, FLT_MAX, -FLT_MAX,     -1e-30f};
    body->scale = scales[random_below(random, sizeof(scales) / sizeof(scales[0]))];
}

TEST(test_scales) {
    check_spoilt("scales", NARC_FLOAT32, spoil_scale);
    check_spoilt("scales, double", NARC_FLOAT64, spoil_scale);
}

/* Finite, so there may be an answer; but far from all others, so nothing collides, and no number gets out of hand. */
TEST(test_huge_positions) {
    static const double distances[] = {1e6, 1e9, 1e12, 1e15, 1e18, 1e19, 1e25, 1e38, (double)FLT_MAX, 1e60, 1e300};
    struct test_random random = test_random_named("huge positions");
    for (size_t d = 0; d < sizeof(distances) / sizeof(distances[0]); d++) {
        narc_precision precision = distances[d] > (double)FLT_MAX ? NARC_FLOAT64 : NARC_FLOAT32;
        struct scene scene = make_random_scene(&random, precision, BODIES, 2000);
        for (size_t k = 0; k < BODIES; k++) {
            double angle = 2 * PI * (double)k / BODIES;
            struct body *body = &scene.bodies[k];
            body->x = distances[d] * cos(angle);
            body->y = distances[d] * sin(angle);
            round_position(body, precision);
        }
        uint64_t *bits = scene_overlaps(&scene);
        struct contacts all = scene_contacts(&scene, INFINITY);
        check_sane(&scene, bits, &all);
        check_same_as_scalar(&scene, bits, &all);
        for (size_t k = 0; k < scene.pair_count; k++)
            assert_true(scene.pairs[k].a == scene.pairs[k].b || all.rows[k].separation > 0);
        free(all.rows);
        free(bits);
        destroy_scene(&scene);
    }
}

/* Denormals and both zeros are numbers like others: the answer is that of 0. */
TEST(test_denormals) {
    static const float tiny[] = {0.0f, -0.0f, FLT_TRUE_MIN, -FLT_TRUE_MIN, FLT_MIN / 2, -FLT_MIN};
    struct test_random random = test_random_named("denormals");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 5000);
    for (size_t k = 0; k < BODIES; k++) {
        struct body *body = &scene.bodies[k];
        *(random_below(&random, 2) ? &body->x : &body->y) = (double)tiny[random_below(&random, 6)];
        *body = (struct body){
            body->x, body->y,    0, 0, random_below(&random, 2) ? 1.0f : -1.0f, tiny[random_below(&random, 6)],
            1,       body->shape};
        round_position(body, NARC_FLOAT32);
    }
    uint64_t *bits = scene_overlaps(&scene);
    struct contacts all = scene_contacts(&scene, INFINITY);
    check_sane(&scene, bits, &all);
    check_same_as_scalar(&scene, bits, &all);
    for (size_t k = 0; k < scene.pair_count; k++) {
        struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                              b = scene_reference(&scene, scene.pairs[k].b);
        struct fractions errors = {0};
        assert_null(check_contact(&a, &b, reference_find_gap(&a, &b).gap, &all.rows[k], &errors));
    }
    free(all.rows);
    free(bits);
    destroy_scene(&scene);
}

static float random_pattern(struct test_random *random) {
    uint32_t bits = (uint32_t)random_bits(random);
    float value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

/* Any bits anywhere. There is no right answer, but there is one, and it is a number. */
TEST(test_random_bits) {
    struct test_random random = test_random_named("random bits");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 1000);
        for (size_t k = 0; k < BODIES; k++) {
            struct body *body = &scene.bodies[k];
            /* All of it, or one number of it: then the rest of the sums stays finite longer. */
            unsigned spoilt = random_below(&random, 2) ? 31u : 1u << random_below(&random, 5);
            body->x_single = spoilt & 1 ? random_pattern(&random) : body->x_single;
            body->y_single = spoilt & 2 ? random_pattern(&random) : body->y_single;
            body->cosine = spoilt & 4 ? random_pattern(&random) : body->cosine;
            body->sine = spoilt & 8 ? random_pattern(&random) : body->sine;
            body->scale = spoilt & 16 ? random_pattern(&random) : body->scale;
        }
        uint64_t *bits = scene_overlaps(&scene);
        struct contacts all = scene_contacts(&scene, INFINITY);
        check_sane(&scene, bits, &all);
        check_same_as_scalar(&scene, bits, &all);
        free(all.rows);
        free(bits);
        destroy_scene(&scene);
    }
}

TEST_MAIN("garbage")
