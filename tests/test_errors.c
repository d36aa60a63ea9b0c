/* SPDX-License-Identifier: MIT
 *
 * test_errors.c - wrong arguments: each has its status and a message that names the culprit, and no output is touched.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene.h"

enum { PAIRS = 200, BODIES = 30 };

/* Outputs of all calls, and a copy of what they held. */
struct outputs {
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    struct contacts contacts;
    narc_error error;
};

static struct scene make_scene(void) {
    struct test_random random = test_random_named("errors");
    return make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
}

static void check_outputs_untouched(const struct outputs *outputs) {
    uint64_t junk[NARC_BIT_WORDS(PAIRS)];
    memset(junk, 0xa5, sizeof(junk));
    assert_memory_equal(outputs->bits, junk, sizeof(junk));
    assert_int_equal(outputs->contacts.count, 12345);
    struct contacts fresh = create_contacts(PAIRS);
    const narc_contacts *c = &outputs->contacts.view, *f = &fresh.view;
    assert_memory_equal(c->pair, f->pair, PAIRS * sizeof(uint32_t));
    assert_memory_equal(c->separation, f->separation, PAIRS * sizeof(float));
    assert_memory_equal(c->normal_x, f->normal_x, PAIRS * sizeof(float));
    assert_memory_equal(c->normal_y, f->normal_y, PAIRS * sizeof(float));
    assert_memory_equal(c->point_x, f->point_x, PAIRS * sizeof(float));
    assert_memory_equal(c->point_y, f->point_y, PAIRS * sizeof(float));
    assert_memory_equal(c->arc_a, f->arc_a, PAIRS);
    assert_memory_equal(c->arc_b, f->arc_b, PAIRS);
    destroy_contacts(&fresh);
}

/* All four calls on a batch that is wrong, with and without an error to fill; `texts` must all stand in the message. */
static void check_batch_error(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                              narc_status expected, const char *const texts[], size_t text_count) {
    struct outputs out = {.contacts = create_contacts(PAIRS)};
    memset(out.bits, 0xa5, sizeof(out.bits));
    out.contacts.count = 12345;
    size_t count = pairs && pairs->count <= PAIRS ? pairs->count : 64;
    for (int call = 0; call < 8; call++) {
        narc_error *error = call < 4 ? &out.error : NULL;
        narc_status status;
        memset(&out.error, 0, sizeof(out.error));
        switch (call % 4) {
        case 0:
            status = narc_find_overlaps(shapes, bodies, pairs, (unsigned)call, out.bits, error);
            break;
        case 1:
            status = narc_find_overlaps_range(shapes, bodies, pairs, 0, count, out.bits, error);
            break;
        case 2:
            status = narc_find_contacts(shapes, bodies, pairs, INFINITY, (unsigned)call, &out.contacts.view,
                                        &out.contacts.count, error);
            break;
        default:
            status = narc_find_contacts_range(shapes, bodies, pairs, 0, count, INFINITY, &out.contacts.view,
                                              &out.contacts.count, error);
            break;
        }
        assert_int_equal(status, expected);
        check_outputs_untouched(&out);
        if (error) {
            assert_int_equal(error->status, expected);
            for (size_t k = 0; k < text_count; k++) {
                if (!strstr(error->message, texts[k])) {
                    fail_msg("'%s' does not name '%s'", error->message, texts[k]);
                }
            }
        }
    }
    destroy_contacts(&out.contacts);
}

static void test_null_arguments(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    check_batch_error(NULL, &bodies, &pairs, NARC_ERROR_ARGUMENT, (const char *[]){"shapes"}, 1);
    check_batch_error(scene.store, NULL, &pairs, NARC_ERROR_ARGUMENT, (const char *[]){"bodies"}, 1);
    check_batch_error(scene.store, &bodies, NULL, NARC_ERROR_ARGUMENT, (const char *[]){"pairs"}, 1);
    for (int k = 0; k < 7; k++) {
        static const char *const names[] = {"x", "y", "cosine", "sine", "shape", "a", "b"};
        narc_bodies b = bodies;
        narc_pairs p = pairs;
        narc_column *columns[] = {&b.x, &b.y, &b.cosine, &b.sine, &b.shape, &p.a, &p.b};
        columns[k]->base = NULL;
        check_batch_error(scene.store, &b, &p, NARC_ERROR_ARGUMENT, &names[k], 1);
    }
    narc_bodies b = bodies;
    b.position_precision = (narc_precision)7;
    check_batch_error(scene.store, &b, &pairs, NARC_ERROR_ARGUMENT, NULL, 0);
    destroy_scene(&scene);
}

static void test_null_outputs(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts contacts = create_contacts(PAIRS);
    size_t count = 12345;
    assert_int_equal(narc_find_overlaps(scene.store, &bodies, &pairs, 1, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, 0, 64, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 1, NULL, &count, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(count, 12345);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 1, &contacts.view, NULL, NULL),
                     NARC_ERROR_ARGUMENT);
    float angle = 0, cosine = 7, sine = 7;
    assert_int_equal(narc_compute_poses(NULL, 1, &cosine, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, NULL, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, &cosine, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_true(cosine == 7 && sine == 7);
    destroy_contacts(&contacts);
    destroy_scene(&scene);
}

/* A pair that names a body there is not; the first such pair is the one that is told. */
static void test_body_index(void **state) {
    (void)state;
    static const uint32_t wrong[] = {BODIES, 99991, 0x80000000u, UINT32_MAX};
    for (int k = 0; k < 8; k++) {
        struct scene scene = make_scene();
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        *(k % 2 ? &scene.pairs[137].a : &scene.pairs[137].b) = wrong[k / 2];
        scene.pairs[188].a = 77777;
        char body[16];
        snprintf(body, sizeof(body), "%lu", (unsigned long)wrong[k / 2]);
        check_batch_error(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, (const char *[]){"137", body}, 2);
        destroy_scene(&scene);
    }
}

/* Several threads look; the first wrong pair of all is still the one that is told. */
static void test_first_wrong_pair(void **state) {
    (void)state;
    struct test_random random = test_random_named("first wrong pair");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 9000);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts contacts = create_contacts(9000);
    scene.pairs[8111].a = scene.pairs[4055].b = scene.pairs[4056].a = 5005;
    for (unsigned threads = 0; threads < 6; threads++) {
        narc_error error = {0};
        assert_int_equal(
            narc_find_contacts(scene.store, &bodies, &pairs, 0, threads, &contacts.view, &contacts.count, &error),
            NARC_ERROR_INDEX);
        assert_non_null(strstr(error.message, "4055"));
        assert_non_null(strstr(error.message, "5005"));
    }
    destroy_contacts(&contacts);
    destroy_scene(&scene);
}

static void test_shape_index(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    for (size_t k = 0; k < PAIRS; k++) {
        scene.pairs[k] = (struct pair){(uint32_t)(k % 20), (uint32_t)(k / 20)};
    }
    scene.pairs[141].b = 23;
    scene.bodies[23].shape = 4711;
    check_batch_error(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, (const char *[]){"141", "23", "4711"}, 3);
    scene.bodies[23].shape = (uint32_t)narc_count_shapes(scene.store);
    check_batch_error(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, (const char *[]){"141", "23"}, 2);
    destroy_scene(&scene);
}

/* No body at all, and no shape at all. */
static void test_empty_tables(void **state) {
    (void)state;
    struct scene scene = make_scene();
    narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    narc_shapes *empty;
    assert_int_equal(narc_create_shapes(NULL, &empty), NARC_OK);
    check_batch_error(empty, &bodies, &pairs, NARC_ERROR_INDEX, (const char *[]){"pair 0"}, 1);
    bodies = (narc_bodies){0};
    check_batch_error(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, (const char *[]){"pair 0"}, 1);
    narc_destroy_shapes(empty);
    destroy_scene(&scene);
}

static void test_too_many_pairs(void **state) {
    (void)state;
#if SIZE_MAX > UINT32_MAX
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    /* With a stride of 0 there really are that many. */
    static const uint32_t first_body = 0;
    const narc_pairs pairs = {(size_t)UINT32_MAX + 1, {&first_body, 0}, {&first_body, 0}};
    check_batch_error(scene.store, &bodies, &pairs, NARC_ERROR_ARGUMENT, NULL, 0);
    destroy_scene(&scene);
#endif
}

static void test_ranges(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    static const size_t bad_anywhere[][2] = {{PAIRS, 1},          {0, PAIRS + 1},       {192, 9}, {SIZE_MAX - 63, 64},
                                             {64, SIZE_MAX - 63}, {SIZE_MAX, SIZE_MAX}, {256, 0}};
    static const size_t bad_for_bits[][2] = {{1, 64}, {32, PAIRS - 32}, {0, 63}, {64, 65}, {63, 1}};
    struct outputs out = {.contacts = create_contacts(PAIRS)};
    memset(out.bits, 0xa5, sizeof(out.bits));
    out.contacts.count = 12345;
    for (size_t k = 0; k < sizeof(bad_anywhere) / sizeof(bad_anywhere[0]); k++) {
        size_t first = bad_anywhere[k][0], count = bad_anywhere[k][1];
        assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, first, count, out.bits, &out.error),
                         NARC_ERROR_ARGUMENT);
        assert_int_equal(narc_find_contacts_range(scene.store, &bodies, &pairs, first, count, 0, &out.contacts.view,
                                                  &out.contacts.count, &out.error),
                         NARC_ERROR_ARGUMENT);
        check_outputs_untouched(&out);
    }
    for (size_t k = 0; k < sizeof(bad_for_bits) / sizeof(bad_for_bits[0]); k++) {
        size_t first = bad_for_bits[k][0], count = bad_for_bits[k][1];
        assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, first, count, out.bits, &out.error),
                         NARC_ERROR_ARGUMENT);
        check_outputs_untouched(&out);
    }
    destroy_contacts(&out.contacts);
    destroy_scene(&scene);
}

static void test_margin_not_a_number(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct outputs out = {.contacts = create_contacts(PAIRS)};
    memset(out.bits, 0xa5, sizeof(out.bits));
    out.contacts.count = 12345;
    narc_contacts *view = &out.contacts.view;
    narc_status status =
        narc_find_contacts(scene.store, &bodies, &pairs, NAN, 1, view, &out.contacts.count, &out.error);
    assert_true(status == NARC_ERROR_NOT_FINITE || status == NARC_ERROR_ARGUMENT);
    assert_int_equal(out.error.status, status);
    assert_non_null(strstr(out.error.message, "margin"));
    check_outputs_untouched(&out);
    assert_int_equal(
        narc_find_contacts_range(scene.store, &bodies, &pairs, 0, 10, NAN, view, &out.contacts.count, NULL), status);
    check_outputs_untouched(&out);
    destroy_contacts(&out.contacts);
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_null_arguments),      cmocka_unit_test(test_null_outputs),
        cmocka_unit_test(test_body_index),          cmocka_unit_test(test_first_wrong_pair),
        cmocka_unit_test(test_shape_index),         cmocka_unit_test(test_empty_tables),
        cmocka_unit_test(test_too_many_pairs),      cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_margin_not_a_number),
    };
    return test_begin() ? cmocka_run_group_tests_name("errors", tests, NULL, NULL) : TEST_SKIPPED;
}
