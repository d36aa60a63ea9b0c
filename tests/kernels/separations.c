/* SPDX-License-Identifier: MIT
 *
 * separations.c - one float a pair: to the last bit what contacts tell, also of pieces of ground; strides, ranges, selections
 * and workers.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "expect.h"
#include "guard.h"
#include "narc.h"
#include "narc_chains.h"
#include "scene.h"

/* What dense contacts tell, as floats. */
static float *find_expected(const narc_shapes *store, const narc_bodies *bodies, const narc_pairs *pairs,
                            const narc_query *query) {
    narc_query dense = *query;
    dense.dense = 1;
    AUTO(free_at) struct contacts contacts = find_contacts(store, bodies, pairs, &dense);
    float *out = malloc(pairs->count * sizeof *out);
    for (size_t k = 0; k < pairs->count; k++)
        out[k] = contacts.rows[k].count ? contacts.rows[k].separation : INFINITY;
    return out;
}

/* Asks with a query in a stride, and without; both by several workers. Returns how many are told. */
static size_t check_separations(const narc_shapes *store, const narc_bodies *bodies, const narc_pairs *pairs,
                                narc_query query) {
    enum { STRIDE = 3 };
    AUTO(free_at) float *const expected = find_expected(store, bodies, pairs, &query);
    AUTO(guard_release_at) float *const strided = guard_allocate(pairs->count * STRIDE * sizeof *strided);
    size_t told = 0, skipped = 0, contacts_skipped = 0;
    for (unsigned threads = 1; threads <= 3; threads++) {
        const narc_workers workers = openmp_workers(threads);
        AUTO(guard_release_at) float *const found = guard_allocate(pairs->count * sizeof *found);
        query.workers = &workers;
        query.row_stride = 0;
        query.out_skipped = &skipped;
        assert_int_equal(narc_find_separations(store, bodies, pairs, &query, found, NULL), NARC_OK);
        assert_memory_equal(found, expected, pairs->count * sizeof *found);
        query.row_stride = -STRIDE * (ptrdiff_t)sizeof *strided;
        memset(strided, GUARD_JUNK, pairs->count * STRIDE * sizeof *strided);
        assert_int_equal(
            narc_find_separations(store, bodies, pairs, &query, strided + STRIDE * (pairs->count - 1), NULL), NARC_OK);
        for (size_t k = 0; k < pairs->count; k++) {
            const float *const place = strided + STRIDE * (pairs->count - 1 - k);
            assert_memory_equal(place, &expected[k], sizeof *place);
            assert_true(is_junk(place + 1, (STRIDE - 1) * sizeof *place));
        }
    }
    query.workers = NULL;
    query.row_stride = 0;
    query.out_skipped = &contacts_skipped;
    free(find_expected(store, bodies, pairs, &query));
    assert_int_equal(skipped, contacts_skipped);
    for (size_t k = 0; k < pairs->count; k++)
        told += expected[k] < INFINITY;
    return told;
}

TEST(test_contacts) {
    static const float margins[] = {0, 0.25f, INFINITY, -0.25f};
    struct test_random random = test_random_named("separations of contacts");
    for (size_t trial = 0; trial < test_trials(8); trial++) {
        AUTO(destroy_scene)
        struct scene scene = make_random_scene(&random, (narc_precision)(trial % 2), 300, trial % 5 ? 500 : 3000);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        AUTO(free_at) float *const own = malloc(pairs.count * sizeof *own);
        for (size_t k = 0; k < scene.body_count; k += 17) /* broken ones */
            *(k % 2 ? &scene.bodies[k].sine : &scene.bodies[k].scale) = NAN;
        for (size_t k = 0; k < pairs.count; k++)
            own[k] = k % 11 ? (float)random_between(&random, -1, 1) : k % 2 ? NAN : INFINITY;
        for (size_t m = 0; m < sizeof margins / sizeof margins[0]; m++)
            check_separations(scene.store, &bodies, &pairs, (narc_query){.margin = margins[m]});
        check_separations(scene.store, &bodies, &pairs, (narc_query){.margins = {own, sizeof *own}});
    }
}

/* Pairs with a concave arc have several contacts: the deepest one's separation is told. */
TEST(test_ground) {
    enum { RIDERS = 40 };
    struct test_random random = test_random_named("separations on ground");
    for (size_t trial = 0; trial < test_trials(CHAIN_FAMILIES); trial++) {
        const enum chain_family family = (enum chain_family)(trial % CHAIN_FAMILIES);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_random_ground(&random, family);
        const size_t count = s->count;
        size_t told = 0;
        narc_error error;
        AUTO(free_at) uint32_t *const a = malloc(RIDERS * count * sizeof *a);
        AUTO(free_at) uint32_t *const b = malloc(RIDERS * count * sizeof *b);
        narc_body riders[RIDERS];
        for (uint32_t k = 0; k < RIDERS; k++) {
            const struct shape shape = make_rider(&random, &s->chain, family);
            const struct body body = ride_chain(&random, &s->chain, &shape, 0.1);
            riders[k] = (narc_body){body.x, body.y, body.cosine, body.sine, body.scale, 0};
            expect_ok(narc_add_shape(s->store, shape.arcs, shape.count, &riders[k].shape, &error), &error);
            for (uint32_t i = 0; i < count; i++) {
                a[k * count + i] = k;
                b[k * count + i] = i;
            }
        }
        narc_bodies bodies;
        narc_view_bodies(riders, RIDERS, &bodies);
        const narc_bodies ground = view_columns(s->bodies, count);
        const narc_pairs pairs = {
            .count = RIDERS * count, .a = {a, sizeof *a}, .b = {b, sizeof *b}, .other_bodies = &ground};
        told += check_separations(s->store, &bodies, &pairs, (narc_query){.margin = 0.125f});
        told += check_separations(s->store, &bodies, &pairs, (narc_query){.margin = INFINITY, .front_only = 1});
        assert_true(told > 0);
    }
}

TEST(test_some_of_a_batch) {
    enum { CHOSEN = 300 };
    struct test_random random = test_random_named("separations of some");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, 100, 3000);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    AUTO(free_at) float *const all = find_expected(scene.store, &bodies, &pairs, &(narc_query){.margin = INFINITY});
    AUTO(free_at) float *const found = make_junk(pairs.count * sizeof *found);
    AUTO(free_at) float *const junk = make_junk(pairs.count * sizeof *junk);
    uint32_t chosen[CHOSEN];
    for (uint32_t k = 0; k < CHOSEN; k++)
        chosen[k] = 7 * (CHOSEN - 1 - k) + 1;
    narc_query query = {
        .margin = INFINITY, .selection = NARC_ARRAY(chosen), .selection_count = CHOSEN, .first = 10, .count = 250};
    assert_int_equal(narc_find_separations(scene.store, &bodies, &pairs, &query, found, NULL), NARC_OK);
    for (size_t k = 0; k < 250; k++) {
        const uint32_t pair = chosen[10 + k];
        assert_memory_equal(&found[pair], &all[pair], sizeof *all);
        found[pair] = junk[pair];
    }
    assert_memory_equal(found, junk, pairs.count * sizeof *found);
    query = (narc_query){.margin = INFINITY, .first = 1000, .count = 1500};
    assert_int_equal(narc_find_separations(scene.store, &bodies, &pairs, &query, found, NULL), NARC_OK);
    assert_memory_equal(found, junk, 1000 * sizeof *found);
    assert_memory_equal(found + 1000, all + 1000, 1500 * sizeof *found);
    assert_memory_equal(found + 2500, junk + 2500, 500 * sizeof *found);
    for (uint32_t k = 0; k < 100; k++) { /* one alone */
        const narc_query one = {.margin = INFINITY, .first = 10 * k, .count = 1};
        assert_int_equal(narc_find_separations(scene.store, &bodies, &pairs, &one, found, NULL), NARC_OK);
        assert_memory_equal(&found[10 * k], &all[10 * k], sizeof *all);
    }
}

TEST_MAIN("separations")
