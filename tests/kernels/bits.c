/* SPDX-License-Identifier: MIT
 *
 * bits.c - every method: one instruction set against scalar, to the last bit, with all counts, layouts, numbers of
 * threads and hints; guard pages on all sides. The calls of narc.h have the bits of the method sat: see methods.c.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "layouts.h"
#include "methods.h"

/* Around a block of 128, and more than any vector is wide. */
enum { SMALL_COUNTS = 132, BODIES = 67 };

static const float margins[] = {0.0f, 0.25f, -0.1f, INFINITY};
enum { MARGINS = sizeof(margins) / sizeof(margins[0]) };

static const narc_method_query queries[] = {
    {.method = NARC_METHOD_SAT},
    {.method = NARC_METHOD_SAT_FIRST},
    {.method = NARC_METHOD_POLYGON_SAT},
    {.method = NARC_METHOD_GJK},
    {.method = NARC_METHOD_GJK, .tolerance = 1e-6f},
    {.method = NARC_METHOD_GJK, .tolerance = 1e-2f, .iterations = 3},
    {.method = NARC_METHOD_CIRCLE},
    {.method = NARC_METHOD_AABB},
    {.method = NARC_METHOD_OBB},
};
enum { QUERIES = sizeof(queries) / sizeof(queries[0]) };

static bool has_contacts(const narc_method_query *query) { return query->method < NARC_METHOD_CIRCLE; }

/* Polygon-sat takes nothing else: gives every body a polygon of the scene's. */
static void keep_polygons(struct scene *scene) {
    uint32_t polygon[4 * FAMILY_COUNT], count = 0;
    assert_true(scene->shape_count <= 4 * FAMILY_COUNT);
    for (uint32_t k = 0; k < scene->shape_count; k++)
        if (narc_shape_flags(scene->store, k) & NARC_SHAPE_POLYGON)
            polygon[count++] = k;
    assert_true(count > 3);
    for (size_t k = 0; k < scene->body_count; k++)
        scene->bodies[k].shape = polygon[k % count];
}

static struct scene make_query_scene(struct test_random *random, const narc_method_query *query,
                                     narc_precision precision, size_t bodies, size_t pairs) {
    struct scene scene = make_random_scene(random, precision, bodies, pairs);
    if (query->method == NARC_METHOD_POLYGON_SAT)
        keep_polygons(&scene);
    return scene;
}

/* ------------------------------------------------------------------------------------------------ what is right */

/* What a call leaves behind. */
struct left {
    uint32_t *hints;
    uint8_t *outcomes;
};

/* What scalar says of all pairs of a scene, one thread. */
struct expected {
    const narc_method_query *query;
    uint32_t *hints_before; /* NULL: a call without */
    uint64_t *bits;
    struct left of_bits;
    struct contacts contacts[MARGINS];
    struct left of_contacts[MARGINS];
};

static narc_method_query prepare(const struct expected *expected, size_t count, struct left *left) {
    narc_method_query query = *expected->query;
    left->outcomes = query.out_outcomes = create_outcomes(count);
    left->hints = NULL;
    if (expected->hints_before) {
        left->hints = query.hints = create_hints(count);
        memcpy(left->hints, expected->hints_before, count * sizeof(uint32_t));
    }
    return query;
}

static struct expected expect(const struct scene *scene, const narc_method_query *query, uint32_t *hints) {
    struct expected expected = {.query = query, .hints_before = hints};
    test_use_isa("scalar");
    narc_method_query prepared = prepare(&expected, scene->pair_count, &expected.of_bits);
    expected.bits = query_overlaps(scene, &prepared, 1);
    for (int m = 0; has_contacts(query) && m < MARGINS; m++) {
        prepared = prepare(&expected, scene->pair_count, &expected.of_contacts[m]);
        expected.contacts[m] = query_contacts(scene, &prepared, margins[m], 1);
    }
    test_use_isa(test_isa());
    return expected;
}

static void destroy_left(struct left *left) {
    free(left->hints);
    free(left->outcomes);
}

static void destroy_expected(struct expected *expected) {
    free(expected->bits);
    destroy_left(&expected->of_bits);
    for (int m = 0; has_contacts(expected->query) && m < MARGINS; m++) {
        destroy_contacts(&expected->contacts[m]);
        destroy_left(&expected->of_contacts[m]);
    }
}

/* ------------------------------------------------------------------------------------------------ a call */

/* A part of a scene, in some layout. */
struct part {
    const narc_shapes *store;
    struct columns columns;
    size_t first;
    unsigned threads;
};

/* Hints and outcomes of a part between guard pages. */
static narc_method_query guard_query(const struct expected *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count;
    narc_method_query query = *expected->query;
    query.out_outcomes = guard_allocate(count);
    if (expected->hints_before)
        query.hints = guard_copy(expected->hints_before + part->first, count * sizeof(uint32_t));
    return query;
}

static void check_left(const narc_method_query *query, const struct left *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count;
    assert_memory_equal(query->out_outcomes, expected->outcomes + part->first, count);
    guard_release(query->out_outcomes);
    if (query->hints) {
        assert_memory_equal(query->hints, expected->hints + part->first, count * sizeof(uint32_t));
        guard_release(query->hints);
    }
}

static void check_overlaps(const struct expected *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count, words = NARC_BIT_WORDS(count);
    const narc_method_query query = guard_query(expected, part);
    uint64_t *out = guard_allocate(words * sizeof(uint64_t));
    assert_int_equal(
        overlaps_by_method(part->store, &part->columns.bodies, &part->columns.pairs, &query, part->threads, out, NULL),
        NARC_OK);
    for (size_t k = 0; k < 64 * words; k++) {
        const bool right = k < count && bit_is_set(expected->bits, part->first + k);
        if (bit_is_set(out, k) != right) {
            fail_msg("%s: %zu pairs from %zu, %u threads: bit %zu is not %d", narc_method_name(query.method), count,
                     part->first, part->threads, k, right);
        }
    }
    check_left(&query, &expected->of_bits, part);
    guard_release(out);
}

static void check_contacts(const struct expected *expected, const struct part *part, int m) {
    const struct contacts *all = &expected->contacts[m];
    const size_t count = part->columns.pairs.count;
    size_t from = 0, found = 0;
    while (from < all->count && all->view.pair[from] < part->first)
        from++;
    while (from + found < all->count && all->view.pair[from + found] < part->first + count)
        found++;
    const narc_method_query query = guard_query(expected, part);
    /* No longer than what is found: the guards then lie right behind the last contact. */
    struct contacts out = {.view = create_guarded_contacts(found), .count = SIZE_MAX};
    assert_int_equal(contacts_by_method(part->store, &part->columns.bodies, &part->columns.pairs, &query, margins[m],
                                        part->threads, &out.view, &out.count, NULL),
                     NARC_OK);
    assert_int_equal(out.count, found);
    for (size_t k = 0; k < found; k++)
        out.view.pair[k] += (uint32_t)part->first;
    const narc_contacts *all_view = &all->view;
    const struct contacts right = {.view = {found, all_view->pair + from, all_view->separation + from,
                                            all_view->normal_x + from, all_view->normal_y + from,
                                            all_view->point_x + from, all_view->point_y + from, all_view->arc_a + from,
                                            all_view->arc_b + from},
                                   .count = found};
    check_same_contacts(&out, &right, narc_method_name(query.method));
    check_left(&query, &expected->of_contacts[m], part);
    destroy_guarded_contacts(&out.view);
}

static void check_part(const struct scene *scene, const narc_shapes *store, const struct expected *expected,
                       enum layout layout, size_t first, size_t count, unsigned threads) {
    struct part part = {store, create_columns(scene, layout, first, count), first, threads};
    check_overlaps(expected, &part);
    for (int m = 0; has_contacts(expected->query) && m < MARGINS; m++)
        check_contacts(expected, &part, m);
    destroy_columns(&part.columns);
}

/* ------------------------------------------------------------------------------------------------ tests */

static uint32_t *random_hints(struct test_random *random, size_t count) {
    uint32_t *hints = create_hints(count);
    for (size_t k = 0; k < count; k++)
        hints[k] = random_below(random, 4) ? (uint32_t)random_bits(random) : 0;
    return hints;
}

/* Every count, each in the next layout; of the exact test, which more kernels answer, each in all of them. */
static void check_all_counts(const narc_method_query *query, narc_precision precision, bool hinted) {
    struct test_random random = test_random_named(narc_method_name(query->method));
    struct scene scene = make_query_scene(&random, query, precision, BODIES, 2 * SMALL_COUNTS);
    narc_shapes *store = guard_store(&scene);
    uint32_t *hints = hinted ? random_hints(&random, scene.pair_count) : NULL;
    struct expected expected = expect(&scene, query, hints);
    static const enum layout layouts[] = {LAYOUT_ARRAYS, LAYOUT_STRUCTURES, LAYOUT_REVERSED};
    const size_t each = query->method == NARC_METHOD_SAT ? 3 : 1;
    for (size_t k = 0; k < each * SMALL_COUNTS; k++) {
        const size_t count = k / each;
        check_part(&scene, store, &expected, layouts[k % 3], random_below(&random, SMALL_COUNTS), count, 1);
    }
    destroy_expected(&expected);
    free(hints);
    narc_destroy_shapes(store);
    destroy_scene(&scene);
}

static void test_all_counts(void **state) {
    (void)state;
    for (size_t q = 0; q < QUERIES; q++) {
        check_all_counts(&queries[q], NARC_FLOAT32, q % 2);
        check_all_counts(&queries[q], NARC_FLOAT64, q % 2 == 0);
    }
}

/* Values that are one for all bodies, and no scales. */
static void test_shared_values(void **state) {
    (void)state;
    for (size_t q = 0; q < QUERIES; q++) {
        for (enum layout layout = LAYOUT_SHARED; layout <= LAYOUT_UNSCALED; layout++) {
            struct test_random random = test_random_named("shared");
            const narc_precision precision = (q + (size_t)layout) % 2 ? NARC_FLOAT64 : NARC_FLOAT32;
            struct scene scene = make_query_scene(&random, &queries[q], precision, BODIES, 2 * SMALL_COUNTS);
            if (layout == LAYOUT_SHARED)
                share_values(&scene);
            else
                unit_scales(&scene);
            narc_shapes *store = guard_store(&scene);
            struct expected expected = expect(&scene, &queries[q], NULL);
            for (size_t count = 1; count < SMALL_COUNTS; count += 1 + count / 4)
                check_part(&scene, store, &expected, layout, random_below(&random, SMALL_COUNTS), count, 1);
            destroy_expected(&expected);
            narc_destroy_shapes(store);
            destroy_scene(&scene);
        }
    }
}

/* Several threads, each with several chunks. */
static void test_threads(void **state) {
    (void)state;
    static const size_t counts[] = {1000, 1025, 5003, 20000};
    struct test_random random = test_random_named("threads of methods");
    for (size_t q = 0; q < QUERIES; q++) {
        const size_t sizes = queries[q].method == NARC_METHOD_SAT ? 4 : 3;
        for (size_t k = 0; k < sizes; k++) {
            const size_t count = counts[k];
            struct scene scene =
                make_query_scene(&random, &queries[q], k % 2 ? NARC_FLOAT64 : NARC_FLOAT32, 300, count);
            narc_shapes *store = guard_store(&scene);
            uint32_t *hints = k % 2 ? NULL : random_hints(&random, count);
            struct expected expected = expect(&scene, &queries[q], hints);
            for (unsigned threads = 0; threads <= 3; threads++)
                check_part(&scene, store, &expected, LAYOUT_STRUCTURES, 0, count, threads);
            destroy_expected(&expected);
            free(hints);
            narc_destroy_shapes(store);
            destroy_scene(&scene);
        }
    }
}

/* Everything there is, in the hardest places. */
static void check_corpus(const char *name, narc_precision precision, bool polygons) {
    struct test_random random = test_random_named(name);
    struct corpus corpus = make_corpus(name, precision, 0.5, polygons);
    struct scene *scene = &corpus.scene;
    narc_shapes *store = guard_store(scene);
    for (size_t q = 0; q < QUERIES; q++) {
        if (queries[q].method == NARC_METHOD_POLYGON_SAT && !polygons)
            continue;
        uint32_t *hints = random_hints(&random, scene->pair_count);
        for (int hinted = 0; hinted < 2; hinted++) {
            struct expected expected = expect(scene, &queries[q], hinted ? hints : NULL);
            check_part(scene, store, &expected, LAYOUT_STRUCTURES, 0, scene->pair_count, 1 + (unsigned)hinted);
            if (hinted) { /* and with what that leaves */
                memcpy(hints, expected.of_bits.hints, scene->pair_count * sizeof *hints);
                struct expected next = expect(scene, &queries[q], hints);
                check_part(scene, store, &next, LAYOUT_ARRAYS, 0, scene->pair_count, 1);
                destroy_expected(&next);
            }
            destroy_expected(&expected);
        }
        free(hints);
    }
    narc_destroy_shapes(store);
    destroy_corpus(&corpus);
}

static void test_hard_places(void **state) {
    (void)state;
    check_corpus("bits", NARC_FLOAT32, false);
    check_corpus("bits, polygons", NARC_FLOAT64, true);
}

/* A pair's answer depends on that pair alone: not on those in the other lanes, nor on how many there are. */
static void test_neighbours(void **state) {
    (void)state;
    struct test_random random = test_random_named("neighbours of methods");
    for (size_t q = 0; q < QUERIES; q++) {
        if (!has_contacts(&queries[q]))
            continue;
        struct scene scene = make_query_scene(&random, &queries[q], NARC_FLOAT32, BODIES, 60);
        uint8_t *outcomes = create_outcomes(60), *again = create_outcomes(40);
        narc_method_query query = queries[q], repeat = queries[q];
        query.out_outcomes = outcomes;
        repeat.out_outcomes = again;
        struct contacts all = query_contacts(&scene, &query, INFINITY, 1);
        for (uint32_t k = 0; k < 60; k++) {
            struct pair pairs[40];
            struct scene repeated = scene;
            for (size_t i = 0; i < 40; i++)
                pairs[i] = scene.pairs[k];
            repeated.pairs = pairs;
            repeated.pair_count = 1 + k % 40;
            struct contacts same = query_contacts(&repeated, &repeat, INFINITY, 1);
            assert_int_equal(same.count, repeated.pair_count);
            for (size_t i = 0; i < same.count; i++) {
                assert_int_equal(again[i], outcomes[k]);
                assert_memory_equal(&same.view.separation[i], &all.view.separation[k], sizeof(float));
                assert_memory_equal(&same.view.normal_x[i], &all.view.normal_x[k], sizeof(float));
                assert_memory_equal(&same.view.point_y[i], &all.view.point_y[k], sizeof(float));
                assert_int_equal(same.view.arc_b[i], all.view.arc_b[k]);
            }
            destroy_contacts(&same);
        }
        free(outcomes);
        free(again);
        destroy_contacts(&all);
        destroy_scene(&scene);
    }
}

/* Any bits at all as bodies, scales and margins: equal bits, no crash, and no endless loop. */
static void test_garbage_bodies(void **state) {
    (void)state;
    struct test_random random = test_random_named("garbage of methods");
    for (size_t q = 0; q < QUERIES; q++) {
        struct scene scene = make_query_scene(&random, &queries[q], NARC_FLOAT32, 200, 1000);
        for (size_t k = 0; k < scene.body_count; k++) {
            struct body *body = &scene.bodies[k];
            float *const values[] = {&body->x_single, &body->y_single, &body->cosine, &body->sine, &body->scale};
            const uint32_t bits = (uint32_t)random_bits(&random);
            static const float special[] = {NAN, INFINITY, -INFINITY, 0, -0.0f, 1e-38f, 1e-45f, 3e38f, -1, 1e17f};
            if (k % 3 == 0)
                memcpy(values[k / 3 % 5], &bits, sizeof bits);
            else if (k % 3 == 1)
                *values[k / 3 % 5] = special[bits % 10];
        }
        narc_shapes *store = guard_store(&scene);
        uint32_t *hints = random_hints(&random, scene.pair_count);
        struct expected expected = expect(&scene, &queries[q], q % 2 ? hints : NULL);
        check_part(&scene, store, &expected, LAYOUT_STRUCTURES, 0, scene.pair_count, 1);
        destroy_expected(&expected);
        free(hints);
        narc_destroy_shapes(store);
        destroy_scene(&scene);
    }
}

/* Spoils a body so that no pair with it has an answer. */
static void break_body(struct body *body, size_t way) {
    switch (way % 5) {
    case 0: /* off by 0.03 % */
        body->cosine *= 1.0003f;
        body->sine *= 1.0003f;
        break;
    case 1:
        body->sine = NAN;
        break;
    case 2:
        body->x = body->x_single = -INFINITY;
        break;
    case 3:
        body->scale = 1e12f;
        break;
    default:
        body->scale = 0;
    }
}

static void check_skipped(const struct scene *scene, const narc_method_query *asked, size_t expected,
                          unsigned threads) {
    size_t skipped = 12345;
    narc_method_query query = *asked;
    query.out_skipped = &skipped;
    free(query_overlaps(scene, &query, threads));
    assert_int_equal(skipped, expected);
    for (int m = 0; m < MARGINS && has_contacts(asked); m++) {
        skipped = 12345;
        struct contacts found = query_contacts(scene, &query, margins[m], threads);
        assert_int_equal(skipped, expected);
        destroy_contacts(&found);
    }
}

/* A body off by a little collides with nothing: every method counts the pairs that it is in, whatever the number of
 * threads and the split. */
static void test_skipped_pairs(void **state) {
    (void)state;
    enum { MANY = 6001 };
    struct test_random random = test_random_named("skipped pairs");
    for (size_t q = 0; q < QUERIES; q++) {
        struct scene scene = make_query_scene(&random, &queries[q], q % 2 ? NARC_FLOAT64 : NARC_FLOAT32, BODIES, MANY);
        check_skipped(&scene, &queries[q], 0, 2);
        for (size_t k = 0; k < BODIES; k += 7)
            break_body(&scene.bodies[k], k / 7);
        size_t expected = 0, sum = 0;
        for (size_t k = 0; k < MANY; k++)
            expected += scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
        assert_true(0 < expected && expected < MANY);
        for (unsigned threads = 1; threads <= 3; threads++)
            check_skipped(&scene, &queries[q], expected, threads);
        const narc_bodies bodies = scene_bodies(&scene);
        for (size_t first = 0, count; first < MANY; first += count) {
            count = 1 + random_below(&random, MANY / 4);
            count = count < MANY - first ? count : MANY - first;
            const struct pair *from = scene.pairs + first;
            const narc_pairs pairs = {.count = count, .a = NARC_COLUMN(from, a), .b = NARC_COLUMN(from, b)};
            uint64_t bits[NARC_BIT_WORDS(MANY)];
            size_t skipped;
            narc_method_query query = queries[q];
            query.out_skipped = &skipped;
            assert_int_equal(overlaps_by_method(scene.store, &bodies, &pairs, &query, 1, bits, NULL), NARC_OK);
            sum += skipped;
        }
        assert_int_equal(sum, expected);
        destroy_scene(&scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_counts),    cmocka_unit_test(test_shared_values),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_hard_places),
        cmocka_unit_test(test_neighbours),    cmocka_unit_test(test_garbage_bodies),
        cmocka_unit_test(test_skipped_pairs),
    };
    return test_begin() ? cmocka_run_group_tests_name("bits", tests, NULL, NULL) : TEST_SKIPPED;
}
