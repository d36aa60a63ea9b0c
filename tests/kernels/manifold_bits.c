/* SPDX-License-Identifier: MIT
 *
 * manifold_bits.c - manifolds are the same bits however they are asked for: by every instruction set, without
 * shortcuts, with any hints, any number of threads, in sub-ranges.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "plain.h"

static const float margins[] = {0, 0.3f, -0.1f, INFINITY};
enum { MARGINS = sizeof margins / sizeof *margins, BODIES = 200, PAIRS = 3000 };

static struct scene make_scene(const char *name, narc_precision precision) {
    struct test_random random = test_random_named(name);
    return make_random_scene(&random, precision, BODIES, PAIRS);
}

/* Finds into rows that end where a forbidden page begins. */
static void find_and_check(const struct scene *scene, const narc_query *query, const struct manifolds *right) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    struct manifolds found = {guard_allocate(right->count * sizeof *found.rows), 0};
    narc_error error;
    expect_ok(narc_find_manifolds(scene->store, &bodies, &pairs, query, found.rows, right->count, &found.count, &error),
              &error);
    assert_int_equal(found.count, right->count);
    assert_memory_equal(found.rows, right->rows, right->count * sizeof *right->rows);
    guard_release(found.rows);
}

/* Those found without shortcuts are right, some of two points. */
static void check_threads_and_hints(struct test_random *random, const struct scene *scene, float margin) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    static uint32_t hints[PAIRS], right_hints[PAIRS];
    struct manifolds right = find_plain_manifolds(scene->store, &bodies, &pairs, &(narc_query){.margin = margin});
    size_t two = 0;
    for (size_t k = 0; k < right.count; k++)
        two += right.rows[k].count == 2;
    assert_true(two > right.count / 20 && two < right.count / 2);
    for (unsigned threads = 0; threads < 4; threads++) {
        const narc_workers workers = narc_openmp_workers(threads);
        const narc_query query = {.margin = margin, .hints = NARC_HINT_ARRAY(hints), .workers = &workers};
        find_and_check(scene, &(narc_query){.margin = margin, .workers = &workers}, &right);
        /* Hints made up; those that are left are those of contacts. */
        for (size_t k = 0; k < PAIRS; k++)
            hints[k] = right_hints[k] = threads == 0 ? 0 : (uint32_t)random_bits(random) & 0x0f0f;
        find_and_check(scene, &query, &right);
        const narc_query own = {.margin = margin, .hints = NARC_HINT_ARRAY(right_hints)};
        free(find_contacts(scene->store, &bodies, &pairs, &own).rows);
        assert_memory_equal(hints, right_hints, sizeof hints);
        find_and_check(scene, &query, &right);
    }
    free(right.rows);
}

TEST(test_threads_and_hints) {
    struct test_random random = test_random_named("manifold hints");
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene("manifold hints", (narc_precision)precision);
        for (size_t m = 0; m < MARGINS; m++)
            check_threads_and_hints(&random, &scene, margins[m]);
        destroy_scene(&scene);
    }
}

/* Sub-ranges of all lengths. */
TEST(test_ranges) {
    struct test_random random = test_random_named("manifold ranges");
    struct scene scene = make_scene("manifold ranges", NARC_FLOAT32);
    struct manifolds all = scene_manifolds(&scene, 0);
    size_t first = 0, listed = 0;
    for (size_t round = 0; first < PAIRS; round++) {
        const size_t wanted = round < 140 ? round + 1 : 1 + random_below(&random, 2000), left = PAIRS - first;
        const size_t count = wanted < left ? wanted : left;
        size_t found = 0;
        while (listed + found < all.count && all.rows[listed + found].pair < first + count)
            found++;
        find_and_check(&scene, &(narc_query){.first = first, .count = count},
                       &(struct manifolds){all.rows + listed, found});
        listed += found;
        first += round % 2 ? 0 : count; /* every other one is asked for again, longer */
        listed -= round % 2 ? found : 0;
    }
    free(all.rows);
    destroy_scene(&scene);
}

/* Pairs with a broken body are counted, and listed with an infinite margin: infinitely far, without a point. */
TEST(test_broken_bodies) {
    struct scene scene = make_scene("manifolds of broken bodies", NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    size_t broken = 0, skipped = 0;
    for (size_t k = 0; k < BODIES; k += 7)
        *(k % 2 ? &scene.bodies[k].x_single : &scene.bodies[k].sine) = k % 3 ? NAN : INFINITY;
    for (size_t k = 0; k < PAIRS; k++)
        broken += scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
    for (unsigned threads = 1; threads < 3; threads++) {
        const narc_workers workers = narc_openmp_workers(threads);
        narc_query query = {.margin = INFINITY, .workers = &workers, .out_skipped = &skipped};
        struct manifolds all = find_manifolds(scene.store, &bodies, &pairs, &query);
        size_t none = 0;
        assert_int_equal(skipped, broken);
        assert_int_equal(all.count, PAIRS);
        for (size_t k = 0; k < PAIRS; k++) {
            const bool is_broken = scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
            const narc_manifold no_answer = {.pair = (uint32_t)k, .point = {{.separation = INFINITY}}};
            assert_int_equal(all.rows[k].count == 0, is_broken);
            if (is_broken)
                assert_memory_equal(&all.rows[k], &no_answer, sizeof no_answer);
            none += is_broken;
        }
        assert_int_equal(none, broken);
        free(all.rows);
        query.margin = 0.1f;
        all = find_manifolds(scene.store, &bodies, &pairs, &query);
        assert_int_equal(skipped, broken);
        for (size_t k = 0; k < all.count; k++)
            assert_true(all.rows[k].count > 0);
        free(all.rows);
    }
    destroy_scene(&scene);
}

TEST_MAIN("manifold_bits")
