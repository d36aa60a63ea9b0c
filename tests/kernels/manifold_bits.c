/* SPDX-License-Identifier: MIT
 *
 * manifold_bits.c - manifolds are the same bits however they are asked for: by every instruction set, without
 * shortcuts, with any hints, any number of threads, in sub-ranges, into some of the arrays or into too few items. And
 * what is an error.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plain_kernels.h"

static const float margins[] = {0, 0.3f, -0.1f, INFINITY};
enum { MARGINS = sizeof margins / sizeof *margins, BODIES = 200, PAIRS = 3000 };

/* What the deciding formula and the edges give, without shortcuts, in scalar code. */
static struct manifolds find_plain(const struct scene *scene, float margin) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_batch batch = {.shapes = scene->store,
                              .bodies = &bodies,
                              .pairs = &pairs,
                              .second_margin = -INFINITY,
                              .flat_sine = (float)sin((double)NARC_FLAT_ANGLE)};
    struct manifolds all = create_manifolds(pairs.count, false), part = create_manifolds(NARC_CONTACT_GROUP, false);
    for (size_t first = 0; first < pairs.count; first += NARC_CONTACT_GROUP) {
        const size_t left = pairs.count - first, count = left < NARC_CONTACT_GROUP ? left : NARC_CONTACT_GROUP;
        part.count = narc_kernels_plain.manifold(&batch, first, count, margin, &part.view);
        for (size_t k = 0; k < MANIFOLD_ARRAYS; k++)
            memcpy((char *)manifold_array(&all.rows[k]) + all.count * manifold_item[k], manifold_array(&part.rows[k]),
                   part.count * manifold_item[k]);
        all.count += part.count;
    }
    free(part.rows);
    return all;
}

static void check_all(const struct manifolds *right, const struct manifolds *found) {
    assert_int_equal(found->count, right->count);
    check_same_manifolds(right, 0, found, 0);
}

static struct scene make_scene(const char *name, narc_precision precision) {
    struct test_random random = test_random_named(name);
    return make_random_scene(&random, precision, BODIES, PAIRS);
}

static void find(const struct scene *scene, const narc_manifold_options *options, unsigned threads,
                 struct manifolds *out) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    if (narc_find_manifolds(scene->store, &bodies, &pairs, options, threads, &out->view, &out->count, &error))
        fail_msg("narc_find_manifolds: %s", error.message);
}

static void test_plain(void **state) {
    (void)state;
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene("plain manifolds", (narc_precision)precision);
        for (size_t m = 0; m < MARGINS; m++) {
            struct manifolds right = find_plain(&scene, margins[m]), found = scene_manifolds(&scene, margins[m]);
            size_t two = 0;
            check_all(&right, &found);
            for (size_t k = 0; k < right.count; k++)
                two += right.rows[k].count == 2;
            assert_true(two > right.count / 20 && two < right.count / 2);
            free(right.rows);
            free(found.rows);
        }
        destroy_scene(&scene);
    }
}

static void test_threads_and_hints(void **state) {
    (void)state;
    struct test_random random = test_random_named("manifold hints");
    struct scene scene = make_scene("manifold hints", NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts contacts = create_contacts(PAIRS);
    static uint32_t hints[PAIRS], right_hints[PAIRS];
    for (size_t m = 0; m < MARGINS; m++) {
        struct manifolds right = find_plain(&scene, margins[m]);
        for (unsigned threads = 0; threads < 4; threads++) {
            struct manifolds found = create_manifolds(PAIRS, true);
            find(&scene, &(narc_manifold_options){.margin = margins[m]}, threads, &found);
            check_all(&right, &found);
            /* Hints made up; those that are left are those of contacts. */
            for (size_t k = 0; k < PAIRS; k++)
                hints[k] = right_hints[k] = threads == 0 ? 0 : (uint32_t)random_bits(&random) & 0x0f0f;
            find(&scene, &(narc_manifold_options){.margin = margins[m], .hints = hints}, threads, &found);
            check_all(&right, &found);
            assert_int_equal(narc_find_contacts_hinted(scene.store, &bodies, &pairs, margins[m], 1, right_hints,
                                                       &contacts.view, &contacts.count, NULL),
                             NARC_OK);
            assert_memory_equal(hints, right_hints, sizeof hints);
            find(&scene, &(narc_manifold_options){.margin = margins[m], .hints = hints}, threads, &found);
            check_all(&right, &found);
            destroy_manifolds(&found, true);
        }
        free(right.rows);
    }
    free(contacts.rows);
    destroy_scene(&scene);
}

/* Sub-ranges of all lengths, into lists that end where a forbidden page begins. */
static void test_ranges(void **state) {
    (void)state;
    struct test_random random = test_random_named("manifold ranges");
    struct scene scene = make_scene("manifold ranges", NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct manifolds all = scene_manifolds(&scene, 0);
    size_t first = 0, listed = 0;
    for (size_t round = 0; first < PAIRS; round++) {
        const size_t wanted = round < 140 ? round : random_below(&random, 2000), left = PAIRS - first;
        const size_t count = wanted < left ? wanted : left;
        size_t found = 0;
        while (listed + found < all.count && all.rows[listed + found].pair < first + count)
            found++;
        struct manifolds part = create_manifolds(found, true);
        assert_int_equal(
            narc_find_manifolds_range(scene.store, &bodies, &pairs, first, count, NULL, &part.view, &part.count, NULL),
            NARC_OK);
        assert_int_equal(part.count, found);
        check_same_manifolds(&all, listed, &part, 0);
        destroy_manifolds(&part, true);
        listed += found;
        first += round % 2 ? 0 : count; /* every other one is asked for again, longer */
        listed -= round % 2 ? found : 0;
    }
    free(all.rows);
    destroy_scene(&scene);
}

/* The same list without array k. */
static narc_manifolds leave_out(narc_manifolds list, size_t k) {
    void *array[MANIFOLD_ARRAYS];
    for (size_t i = 0; i < MANIFOLD_ARRAYS; i++)
        array[i] = i == k ? NULL : manifold_array(&list, i);
    return (narc_manifolds){.capacity = list.capacity,
                            .pair = array[0],
                            .point_count = array[1],
                            .normal_x = array[2],
                            .normal_y = array[3],
                            .separation = {array[4], array[5]},
                            .point_x = {array[6], array[7]},
                            .point_y = {array[8], array[9]},
                            .feature = {array[10], array[11]},
                            .radius_a = {array[12], array[13]},
                            .radius_b = {array[14], array[15]}};
}

static void test_arrays_left_out(void **state) {
    (void)state;
    struct scene scene = make_scene("manifolds left out", NARC_FLOAT32);
    struct manifolds all = scene_manifolds(&scene, 0);
    for (unsigned threads = 1; threads < 3; threads++) {
        for (size_t k = 0; k < MANIFOLD_ARRAYS; k++) {
            struct manifolds found = create_manifolds(PAIRS, false);
            struct manifolds some = {.view = leave_out(found.view, k)};
            find(&scene, NULL, threads, &some);
            assert_int_equal(some.count, all.count);
            for (size_t i = 0; i < MANIFOLD_ARRAYS; i++) {
                const unsigned char *bytes = manifold_array(&found.view, i);
                if (i != k)
                    assert_memory_equal(bytes, manifold_array(&all.view, i), all.count * manifold_item[i]);
                else
                    assert_int_equal(bytes[0], 0xa5);
            }
            free(found.rows);
        }
    }
    free(all.rows);
    destroy_scene(&scene);
}

static void test_capacity(void **state) {
    (void)state;
    struct test_random random = test_random_named("manifold capacity");
    struct scene scene = make_scene("manifold capacity", NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct manifolds all = scene_manifolds(&scene, 0);
    for (size_t round = 0; round < 40; round++) {
        const size_t capacity = round == 0 ? 0 : random_below(&random, all.count);
        struct manifolds part = create_manifolds(capacity, true);
        size_t found = 0;
        narc_error error;
        assert_int_equal(narc_find_manifolds(scene.store, &bodies, &pairs, NULL, 1 + (unsigned)round % 3, &part.view,
                                             &found, &error),
                         NARC_ERROR_CAPACITY);
        assert_int_equal(found, all.count);
        assert_non_null(strstr(error.message, "manifolds"));
        part.count = capacity;
        check_same_manifolds(&all, 0, &part, 0);
        destroy_manifolds(&part, true);
    }
    free(all.rows);
    destroy_scene(&scene);
}

static void test_errors(void **state) {
    (void)state;
    struct scene scene = make_scene("manifold errors", NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    struct manifolds list = create_manifolds(PAIRS, false), untouched = create_manifolds(PAIRS, false);
    size_t found = 12345, skipped = 54321;
    narc_error error;
#define OPTIONS(...)                                                                                                   \
    &(narc_manifold_options) { .out_skipped = &skipped, __VA_ARGS__ }
#define EXPECT(status, words, ...)                                                                                     \
    do {                                                                                                               \
        assert_int_equal(narc_find_manifolds(__VA_ARGS__, &error), status);                                            \
        assert_non_null(strstr(error.message, words));                                                                 \
        assert_int_equal(found, 12345);                                                                                \
        assert_int_equal(skipped, 54321);                                                                              \
        for (size_t k = 0; k < MANIFOLD_ARRAYS; k++)                                                                   \
            assert_memory_equal(manifold_array(&list.rows[k]), manifold_array(&untouched.rows[k]),                     \
                                PAIRS *manifold_item[k]);                                                              \
    } while (0)
    const narc_shapes *store = scene.store;
    const narc_manifold_options *none = OPTIONS(.margin = 0);
    EXPECT(NARC_ERROR_ARGUMENT, "shapes", NULL, &bodies, &pairs, none, 1, &list.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "bodies", store, NULL, &pairs, none, 1, &list.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "pairs", store, &bodies, NULL, none, 1, &list.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "out_manifolds", store, &bodies, &pairs, none, 1, NULL, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "out_count", store, &bodies, &pairs, none, 1, &list.view, NULL);
    EXPECT(NARC_ERROR_NOT_FINITE, "margin", store, &bodies, &pairs, OPTIONS(.margin = NAN), 1, &list.view, &found);
    EXPECT(NARC_ERROR_NOT_FINITE, "flat_angle", store, &bodies, &pairs, OPTIONS(.flat_angle = NAN), 1, &list.view,
           &found);
    EXPECT(NARC_ERROR_ARGUMENT, "flat_angle is 1.6", store, &bodies, &pairs, OPTIONS(.flat_angle = 1.6f), 1, &list.view,
           &found);
    scene.pairs[PAIRS - 1].a = BODIES;
    EXPECT(NARC_ERROR_INDEX, "2999", store, &bodies, &pairs, none, 1, &list.view, &found);
#undef EXPECT
    assert_int_equal(narc_find_manifolds_range(store, &bodies, &pairs, PAIRS - 5, 6, NULL, &list.view, &found, &error),
                     NARC_ERROR_ARGUMENT);
    pairs.count = 0;
    assert_int_equal(narc_find_manifolds(store, &bodies, &pairs, none, 1, &list.view, &found, NULL), NARC_OK);
    assert_int_equal(found, 0);
    assert_int_equal(skipped, 0);
    free(list.rows);
    free(untouched.rows);
    destroy_scene(&scene);
}

/* Pairs with a broken body are counted, and listed with an infinite margin: infinitely far, without a point. */
static void test_broken_bodies(void **state) {
    (void)state;
    struct scene scene = make_scene("manifolds of broken bodies", NARC_FLOAT32);
    size_t broken = 0, skipped = 0;
    for (size_t k = 0; k < BODIES; k += 7)
        *(k % 2 ? &scene.bodies[k].x_single : &scene.bodies[k].sine) = k % 3 ? NAN : INFINITY;
    for (size_t k = 0; k < PAIRS; k++)
        broken += scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
    for (unsigned threads = 1; threads < 3; threads++) {
        struct manifolds all = create_manifolds(PAIRS, false);
        size_t none = 0;
        find(&scene, &(narc_manifold_options){.margin = INFINITY, .out_skipped = &skipped}, threads, &all);
        assert_int_equal(skipped, broken);
        assert_int_equal(all.count, PAIRS);
        for (size_t k = 0; k < PAIRS; k++) {
            const bool is_broken = scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
            assert_int_equal(all.rows[k].count == 0, is_broken);
            none += is_broken;
            for (size_t i = 2; i < MANIFOLD_ARRAYS && is_broken; i++) {
                const char *item = (const char *)manifold_array(&all.view, i) + k * manifold_item[i];
                const float infinite = INFINITY;
                assert_memory_equal(item, i == 4 ? (const char *)&infinite : "\0\0\0", manifold_item[i]);
            }
        }
        assert_int_equal(none, broken);
        find(&scene, &(narc_manifold_options){.margin = 0.1f, .out_skipped = &skipped}, threads, &all);
        assert_int_equal(skipped, broken);
        for (size_t k = 0; k < all.count; k++)
            assert_true(all.rows[k].count > 0);
        free(all.rows);
    }
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plain),         cmocka_unit_test(test_threads_and_hints), cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_capacity),      cmocka_unit_test(test_arrays_left_out),   cmocka_unit_test(test_errors),
        cmocka_unit_test(test_broken_bodies),
    };
    return test_begin() ? cmocka_run_group_tests_name("manifold_bits", tests, NULL, NULL) : TEST_SKIPPED;
}
