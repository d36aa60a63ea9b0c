/* SPDX-License-Identifier: MIT
 *
 * pair.c - one pair without a batch: the bits of a batch, right by the reference with both witness points, defaults and
 * errors.
 */
#include <math.h>
#include <string.h>

#include "check.h"
#include "expect.h"

enum { BODIES = 60, PAIRS = 600 };

static narc_body find_body(const struct scene *scene, uint32_t index) {
    const struct body *body = &scene->bodies[index];
    return (narc_body){.x = body->x,
                       .y = body->y,
                       .shape = body->shape,
                       .cosine = body->cosine,
                       .sine = body->sine,
                       .scale = body->scale};
}

/* The contact of every pair by itself and in a batch, on every instruction set. */
static void contact_has_the_bits_of_a_batch(void **state) {
    (void)state;
    struct test_random random = test_random_named("one contact");
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_random_scene(&random, precision ? NARC_FLOAT64 : NARC_FLOAT32, BODIES, PAIRS);
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            if (!narc_isa_supported(narc_isa_name(isa)))
                continue;
            test_use_isa(narc_isa_name(isa));
            struct contacts batch = scene_contacts(&scene, INFINITY);
            const narc_contacts *c = &batch.view;
            assert_int_equal(batch.count, PAIRS);
            for (size_t k = 0; k < PAIRS; k++) {
                const narc_body a = find_body(&scene, scene.pairs[k].a), b = find_body(&scene, scene.pairs[k].b);
                narc_contact contact;
                narc_error error;
                expect_ok(narc_find_contact(scene.store, &a, &b, &contact, &error), &error);
                const float one[] = {contact.separation, contact.normal_x, contact.normal_y, contact.point_x,
                                     contact.point_y};
                const float many[] = {c->separation[k], c->normal_x[k], c->normal_y[k], c->point_x[k], c->point_y[k]};
                assert_memory_equal(one, many, sizeof one);
                assert_int_equal(contact.arc_a, c->arc_a[k]);
                assert_int_equal(contact.arc_b, c->arc_b[k]);
            }
            destroy_contacts(&batch);
        }
        test_use_isa(test_isa());
        destroy_scene(&scene);
    }
}

/* The point less half the separation along the normal lies on A, and plus that on B, near and far: check_contact(). */
static void contact_is_right(void **state) {
    (void)state;
    struct test_random random = test_random_named("one contact, reference");
    struct fractions worst = {0};
    struct scene scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    size_t apart = 0;
    for (size_t k = 0; k < PAIRS; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a);
        const struct reference_body b = scene_reference(&scene, scene.pairs[k].b);
        const narc_body body_a = find_body(&scene, scene.pairs[k].a), body_b = find_body(&scene, scene.pairs[k].b);
        narc_contact c;
        assert_int_equal(narc_find_contact(scene.store, &body_a, &body_b, &c, NULL), NARC_OK);
        const narc_contacts view = {1,          NULL,       &c.separation, &c.normal_x, &c.normal_y,
                                    &c.point_x, &c.point_y, &c.arc_a,      &c.arc_b};
        const char *wrong = check_contact(&a, &b, reference_find_gap(&a, &b).gap, &view, 0, &worst);
        if (wrong) {
            print_pair(&a, &b);
            fail_msg("%s", wrong);
        }
        apart += c.separation > 0;
    }
    assert_true(apart > PAIRS / 10 && apart < PAIRS * 9 / 10);
    destroy_scene(&scene);
}

static void manifold_has_the_bits_of_a_batch(void **state) {
    (void)state;
    struct test_random random = test_random_named("one manifold");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    for (int k = 0; k < PAIRS; k++) {
        const narc_manifold_options options = {.margin = k % 3 ? INFINITY : 0, .flat_angle = k % 4 ? 0 : 1.0f};
        const narc_pairs pairs = {.count = 1, .a = {&scene.pairs[k].a, 0}, .b = {&scene.pairs[k].b, 0}};
        const narc_body a = find_body(&scene, scene.pairs[k].a), b = find_body(&scene, scene.pairs[k].b);
        narc_manifold one, many;
        narc_error error;
        size_t found;
        memset(&one, 0, sizeof one);
        memset(&many, 0, sizeof many);
        const narc_manifolds list = {.capacity = 1,
                                     .point_count = &many.point_count,
                                     .normal_x = &many.normal_x,
                                     .normal_y = &many.normal_y,
                                     .separation = {&many.separation[0], &many.separation[1]},
                                     .point_x = {&many.point_x[0], &many.point_x[1]},
                                     .point_y = {&many.point_y[0], &many.point_y[1]},
                                     .feature = {&many.feature[0], &many.feature[1]},
                                     .radius_a = {&many.radius_a[0], &many.radius_a[1]},
                                     .radius_b = {&many.radius_b[0], &many.radius_b[1]}};
        expect_ok(narc_find_manifolds(scene.store, &bodies, &pairs, &options, 1, &list, &found, &error), &error);
        expect_ok(narc_find_manifold(scene.store, &a, &b, &options, &one, &error), &error);
        assert_int_equal(one.point_count > 0, found);
        assert_int_equal(one.point_count, many.point_count);
        const size_t floats = offsetof(narc_manifold, feature) - offsetof(narc_manifold, normal_x);
        assert_memory_equal(&one.normal_x, &many.normal_x, floats);
        assert_memory_equal(one.feature, many.feature, sizeof one.feature);
        assert_memory_equal(one.radius_a, many.radius_a, sizeof one.radius_a);
        assert_memory_equal(one.radius_b, many.radius_b, sizeof one.radius_b);
    }
    destroy_scene(&scene);
}

static narc_shapes *make_box_store(void) {
    narc_shapes *shapes = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    assert_int_equal(narc_build_box(2, 2, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(narc_add_shape_at(shapes, 0, arcs, count, NULL), NARC_OK);
    assert_int_equal(narc_add_shape_at(shapes, 1, arcs, count, NULL), NARC_OK);
    return shapes;
}

static void zeros_are_defaults(void **state) {
    (void)state;
    narc_shapes *shapes = make_box_store();
    const narc_body a = {.shape = 0}, right = {.x = 2.5}, turned = {.x = 3, .angle = 0.7853982f},
                    large = {.x = 2.5, .scale = 2};
    narc_contact c;
    narc_manifold m;
    assert_int_equal(narc_find_contact(shapes, &a, &right, &c, NULL), NARC_OK);
    assert_true(c.separation == 0.5f && c.normal_x == 1 && c.normal_y == 0 && c.point_x == 1.25f && c.point_y == 0);
    assert_int_equal(narc_find_contact(shapes, &a, &turned, &c, NULL), NARC_OK);
    assert_true(fabs((double)c.separation - (2 - sqrt(2))) < 1e-5);
    assert_int_equal(narc_find_contact(shapes, &a, &large, &c, NULL), NARC_OK);
    assert_true(c.separation == -0.5f);
    assert_int_equal(narc_find_manifold(shapes, &a, &large, NULL, &m, NULL), NARC_OK);
    assert_int_equal(m.point_count, 2);
    assert_true(m.separation[0] == -0.5f && m.separation[1] == -0.5f);
    assert_int_equal(narc_find_manifold(shapes, &a, &right, NULL, &m, NULL), NARC_OK);
    assert_int_equal(m.point_count, 0);
    const narc_body far = {.x = 1e18};
    assert_int_equal(narc_find_contact(shapes, &a, &far, &c, NULL), NARC_OK);
    assert_true(isinf(c.separation) && c.separation > 0 && c.normal_x == 0 && c.point_x == 0);
    const size_t floats = sizeof m - offsetof(narc_manifold, normal_x);
    const narc_manifold none = {0}, no_answer = {.separation = {INFINITY, 0}};
    assert_int_equal(narc_find_manifold(shapes, &a, &far, NULL, &m, NULL), NARC_OK);
    assert_true(m.point_count == 0 && memcmp(&m.normal_x, &none.normal_x, floats) == 0);
    assert_int_equal(narc_find_manifold(shapes, &a, &far, &(narc_manifold_options){.margin = INFINITY}, &m, NULL), 0);
    assert_true(m.point_count == 0 && memcmp(&m.normal_x, &no_answer.normal_x, floats) == 0);
    narc_destroy_shapes(shapes);
}

static void bad_bodies_are_errors(void **state) {
    (void)state;
    narc_shapes *shapes = make_box_store();
    const narc_body fine = {.shape = 0};
    const struct {
        narc_body body;
        narc_status status;
        const char *words;
    } cases[] = {{{.x = NAN}, NARC_ERROR_NOT_FINITE, "x is nan"},
                 {{.y = INFINITY}, NARC_ERROR_NOT_FINITE, "y is inf"},
                 {{.shape = 2}, NARC_ERROR_INDEX, "shape is 2, but there are 2 shapes"},
                 {{.shape = 1}, NARC_ERROR_INDEX, "shape 1 was removed"},
                 {{.angle = NAN}, NARC_ERROR_NOT_FINITE, "cosine is nan"},
                 {{.cosine = 2}, NARC_ERROR_ARGUMENT, "vector of length 2"},
                 {{.scale = -1}, NARC_ERROR_SIZE, "scale is -1"},
                 {{.scale = NAN}, NARC_ERROR_SIZE, "scale is "}};
    narc_error error;
    narc_contact contact, junk;
    narc_manifold manifold, junk_manifold;
    memset(&junk, 0xa5, sizeof junk);
    memset(&junk_manifold, 0xa5, sizeof junk_manifold);
    contact = junk;
    manifold = junk_manifold;
    assert_int_equal(narc_remove_shape(shapes, 1, NULL), NARC_OK);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        for (int second = 0; second < 2; second++) {
            const narc_body *a = second ? &fine : &cases[k].body, *b = second ? &cases[k].body : &fine;
            expect_error(narc_find_contact(shapes, a, b, &contact, &error), cases[k].status, &error, cases[k].words);
            assert_int_equal(error.index, second);
            expect_error(narc_find_manifold(shapes, a, b, NULL, &manifold, &error), cases[k].status, &error,
                         cases[k].words);
        }
    }
    const narc_body *a = &fine;
    const narc_manifold_options bad = {.margin = NAN};
    expect_error(narc_find_contact(NULL, a, a, &contact, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_find_contact(shapes, NULL, a, &contact, &error), NARC_ERROR_ARGUMENT, &error, "a is NULL");
    expect_error(narc_find_contact(shapes, a, NULL, &contact, &error), NARC_ERROR_ARGUMENT, &error, "b is NULL");
    expect_error(narc_find_contact(shapes, a, a, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_contact is NULL");
    expect_error(narc_find_manifold(shapes, a, a, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_manifold");
    expect_error(narc_find_manifold(shapes, a, a, &bad, &manifold, &error), NARC_ERROR_NOT_FINITE, &error, "margin");
    assert_memory_equal(&contact, &junk, sizeof junk);
    assert_memory_equal(&manifold, &junk_manifold, sizeof junk_manifold);
    narc_destroy_shapes(shapes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contact_has_the_bits_of_a_batch),
        cmocka_unit_test(contact_is_right),
        cmocka_unit_test(manifold_has_the_bits_of_a_batch),
        cmocka_unit_test(zeros_are_defaults),
        cmocka_unit_test(bad_bodies_are_errors),
    };
    if (!test_begin())
        return TEST_SKIPPED;
    return cmocka_run_group_tests_name("pair", tests, NULL, NULL);
}
