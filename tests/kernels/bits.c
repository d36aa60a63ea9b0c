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

static const narc_method_options settings[] = {
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
enum { SETTINGS = sizeof(settings) / sizeof(settings[0]) };

static bool has_contacts(const narc_method_options *options) { return options->method < NARC_METHOD_CIRCLE; }

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

static struct scene make_query_scene(struct test_random *random, const narc_method_options *options,
                                     narc_precision precision, size_t bodies, size_t pairs) {
    struct scene scene = make_random_scene(random, precision, bodies, pairs);
    if (options->method == NARC_METHOD_POLYGON_SAT)
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
    const narc_method_options *options;
    uint32_t *hints_before; /* NULL: a call without */
    uint64_t *bits;
    struct left of_bits;
    struct contacts contacts[MARGINS];
    struct left of_contacts[MARGINS];
};

static narc_method_options set_outcomes(const narc_method_options *options, uint8_t *outcomes) {
    narc_method_options set = *options;
    set.out_outcomes = outcomes;
    return set;
}

static struct left prepare(const struct expected *expected, size_t count) {
    struct left left = {.outcomes = create_outcomes(count)};
    if (expected->hints_before) {
        left.hints = create_hints(count);
        memcpy(left.hints, expected->hints_before, count * sizeof(uint32_t));
    }
    return left;
}

static struct expected expect(const struct scene *scene, const narc_method_options *options, uint32_t *hints) {
    struct expected expected = {.options = options, .hints_before = hints};
    test_use_isa("scalar");
    expected.of_bits = prepare(&expected, scene->pair_count);
    narc_method_options set = set_outcomes(options, expected.of_bits.outcomes);
    expected.bits = query_overlaps(scene, &set, &(narc_query){.hints = hint_column(expected.of_bits.hints)});
    for (int m = 0; has_contacts(options) && m < MARGINS; m++) {
        expected.of_contacts[m] = prepare(&expected, scene->pair_count);
        set.out_outcomes = expected.of_contacts[m].outcomes;
        const narc_query query = {.margin = margins[m], .hints = hint_column(expected.of_contacts[m].hints)};
        expected.contacts[m] = query_contacts(scene, &set, &query);
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
    for (int m = 0; has_contacts(expected->options) && m < MARGINS; m++) {
        free(expected->contacts[m].rows);
        destroy_left(&expected->of_contacts[m]);
    }
}

/* ------------------------------------------------------------------------------------------------ a call */

/* A scene's shapes in guarded memory, and what the methods make of them. */
struct guarded {
    narc_shapes *store;
    narc_methods *methods;
};

static struct guarded guard_shapes(const struct scene *scene) {
    struct guarded guarded = {.store = guard_store(scene)};
    assert_int_equal(narc_create_methods(guarded.store, &guard_allocator, &guarded.methods, NULL), NARC_OK);
    return guarded;
}

static void release_shapes(struct guarded *guarded) {
    narc_destroy_methods(guarded->methods);
    narc_destroy_shapes(guarded->store);
}

/* A part of a scene, in some layout. */
struct part {
    const narc_methods *methods;
    struct columns columns;
    size_t first;
    narc_workers workers;
};

/* Hints and outcomes of a part between guard pages. */
static struct left guard_left(const struct expected *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count;
    struct left left = {.outcomes = guard_allocate(count)};
    if (expected->hints_before)
        left.hints = guard_copy(expected->hints_before + part->first, count * sizeof(uint32_t));
    return left;
}

static void check_left(const struct left *left, const struct left *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count;
    assert_memory_equal(left->outcomes, expected->outcomes + part->first, count);
    guard_release(left->outcomes);
    if (left->hints) {
        assert_memory_equal(left->hints, expected->hints + part->first, count * sizeof(uint32_t));
        guard_release(left->hints);
    }
}

static void check_overlaps(const struct expected *expected, const struct part *part) {
    const size_t count = part->columns.pairs.count, words = NARC_BIT_WORDS(count);
    const struct left left = guard_left(expected, part);
    const narc_method_options options = set_outcomes(expected->options, left.outcomes);
    const narc_query query = {.hints = hint_column(left.hints), .workers = &part->workers};
    uint64_t *out = guard_allocate(words * sizeof(uint64_t));
    assert_int_equal(
        narc_find_overlaps_by(part->methods, &part->columns.bodies, &part->columns.pairs, &options, &query, out, NULL),
        NARC_OK);
    for (size_t k = 0; k < 64 * words; k++) {
        const bool right = k < count && bit_is_set(expected->bits, part->first + k);
        if (bit_is_set(out, k) != right) {
            fail_msg("%s: %zu pairs from %zu, %u workers: bit %zu is not %d", narc_method_name(options.method), count,
                     part->first, part->workers.count, k, right);
        }
    }
    check_left(&left, &expected->of_bits, part);
    guard_release(out);
}

static void check_contacts(const struct expected *expected, const struct part *part, int m) {
    const struct contacts *all = &expected->contacts[m];
    const size_t count = part->columns.pairs.count;
    size_t from = 0, found = 0;
    while (from < all->count && all->rows[from].pair < part->first)
        from++;
    while (from + found < all->count && all->rows[from + found].pair < part->first + count)
        found++;
    const struct left left = guard_left(expected, part);
    const narc_method_options options = set_outcomes(expected->options, left.outcomes);
    const narc_query query = {.margin = margins[m], .hints = hint_column(left.hints), .workers = &part->workers};
    /* No longer than what is found: the guard then lies right behind the last contact. */
    struct contacts out = {guard_allocate(found * sizeof *out.rows), SIZE_MAX};
    assert_int_equal(narc_find_contacts_by(part->methods, &part->columns.bodies, &part->columns.pairs, &options, &query,
                                           out.rows, found, &out.count, NULL),
                     NARC_OK);
    assert_int_equal(out.count, found);
    for (size_t k = 0; k < found; k++)
        out.rows[k].pair += (uint32_t)part->first;
    check_same_contacts(&out, &(struct contacts){all->rows + from, found}, narc_method_name(options.method));
    check_left(&left, &expected->of_contacts[m], part);
    guard_release(out.rows);
}

static void check_part(const struct scene *scene, const struct guarded *guarded, const struct expected *expected,
                       enum layout layout, size_t first, size_t count, unsigned threads) {
    struct part part = {guarded->methods, create_columns(scene, layout, first, count), first,
                        narc_openmp_workers(threads)};
    check_overlaps(expected, &part);
    for (int m = 0; has_contacts(expected->options) && m < MARGINS; m++)
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
static void check_all_counts(const narc_method_options *options, narc_precision precision, bool hinted) {
    struct test_random random = test_random_named(narc_method_name(options->method));
    struct scene scene = make_query_scene(&random, options, precision, BODIES, 2 * SMALL_COUNTS);
    struct guarded guarded = guard_shapes(&scene);
    uint32_t *hints = hinted ? random_hints(&random, scene.pair_count) : NULL;
    struct expected expected = expect(&scene, options, hints);
    static const enum layout layouts[] = {LAYOUT_ARRAYS, LAYOUT_STRUCTURES, LAYOUT_REVERSED};
    const size_t each = options->method == NARC_METHOD_SAT ? 3 : 1;
    for (size_t k = 0; k < each * SMALL_COUNTS; k++) {
        const size_t count = k / each;
        check_part(&scene, &guarded, &expected, layouts[k % 3], random_below(&random, SMALL_COUNTS), count, 1);
    }
    destroy_expected(&expected);
    free(hints);
    release_shapes(&guarded);
    destroy_scene(&scene);
}

TEST(test_all_counts) {
    for (size_t q = 0; q < SETTINGS; q++) {
        check_all_counts(&settings[q], NARC_FLOAT32, q % 2);
        check_all_counts(&settings[q], NARC_FLOAT64, q % 2 == 0);
    }
}

/* Values that are one for all bodies, and no scales. */
TEST(test_shared_values) {
    for (size_t q = 0; q < SETTINGS; q++) {
        for (enum layout layout = LAYOUT_SHARED; layout <= LAYOUT_UNSCALED; layout++) {
            struct test_random random = test_random_named("shared");
            const narc_precision precision = (q + (size_t)layout) % 2 ? NARC_FLOAT64 : NARC_FLOAT32;
            struct scene scene = make_query_scene(&random, &settings[q], precision, BODIES, 2 * SMALL_COUNTS);
            suit_layout(&scene, layout);
            struct guarded guarded = guard_shapes(&scene);
            struct expected expected = expect(&scene, &settings[q], NULL);
            for (size_t count = 1; count < SMALL_COUNTS; count += 1 + count / 4)
                check_part(&scene, &guarded, &expected, layout, random_below(&random, SMALL_COUNTS), count, 1);
            destroy_expected(&expected);
            release_shapes(&guarded);
            destroy_scene(&scene);
        }
    }
}

/* Several threads, each with several chunks. */
TEST(test_threads) {
    static const size_t counts[] = {1000, 1025, 5003, 20000};
    struct test_random random = test_random_named("threads of methods");
    for (size_t q = 0; q < SETTINGS; q++) {
        const size_t sizes = settings[q].method == NARC_METHOD_SAT ? 4 : 3;
        for (size_t k = 0; k < sizes; k++) {
            const size_t count = counts[k];
            struct scene scene =
                make_query_scene(&random, &settings[q], k % 2 ? NARC_FLOAT64 : NARC_FLOAT32, 300, count);
            struct guarded guarded = guard_shapes(&scene);
            uint32_t *hints = k % 2 ? NULL : random_hints(&random, count);
            struct expected expected = expect(&scene, &settings[q], hints);
            for (unsigned threads = 0; threads <= 3; threads++)
                check_part(&scene, &guarded, &expected, LAYOUT_STRUCTURES, 0, count, threads);
            destroy_expected(&expected);
            free(hints);
            release_shapes(&guarded);
            destroy_scene(&scene);
        }
    }
}

/* Everything there is, in the hardest places. */
static void check_corpus(const char *name, narc_precision precision, bool polygons) {
    struct test_random random = test_random_named(name);
    struct corpus corpus = make_corpus(name, precision, 0.5, polygons);
    struct scene *scene = &corpus.scene;
    struct guarded guarded = guard_shapes(scene);
    for (size_t q = 0; q < SETTINGS; q++) {
        if (settings[q].method == NARC_METHOD_POLYGON_SAT && !polygons)
            continue;
        uint32_t *hints = random_hints(&random, scene->pair_count);
        for (int hinted = 0; hinted < 2; hinted++) {
            struct expected expected = expect(scene, &settings[q], hinted ? hints : NULL);
            check_part(scene, &guarded, &expected, LAYOUT_STRUCTURES, 0, scene->pair_count, 1 + (unsigned)hinted);
            if (hinted) { /* and with what that leaves */
                memcpy(hints, expected.of_bits.hints, scene->pair_count * sizeof *hints);
                struct expected next = expect(scene, &settings[q], hints);
                check_part(scene, &guarded, &next, LAYOUT_ARRAYS, 0, scene->pair_count, 1);
                destroy_expected(&next);
            }
            destroy_expected(&expected);
        }
        free(hints);
    }
    release_shapes(&guarded);
    destroy_corpus(&corpus);
}

TEST(test_hard_places) {
    check_corpus("bits", NARC_FLOAT32, false);
    check_corpus("bits, polygons", NARC_FLOAT64, true);
}

/* A pair's answer depends on that pair alone: not on those in the other lanes, nor on how many there are. */
TEST(test_neighbours) {
    struct test_random random = test_random_named("neighbours of methods");
    for (size_t q = 0; q < SETTINGS; q++) {
        if (!has_contacts(&settings[q]))
            continue;
        struct scene scene = make_query_scene(&random, &settings[q], NARC_FLOAT32, BODIES, 60);
        uint8_t *outcomes = create_outcomes(60), *again = create_outcomes(40);
        const narc_method_options once = set_outcomes(&settings[q], outcomes);
        const narc_method_options repeat = set_outcomes(&settings[q], again);
        struct contacts all = query_contacts(&scene, &once, &(narc_query){.margin = INFINITY});
        for (uint32_t k = 0; k < 60; k++) {
            struct pair pairs[40];
            struct scene repeated = scene;
            for (size_t i = 0; i < 40; i++)
                pairs[i] = scene.pairs[k];
            repeated.pairs = pairs;
            repeated.pair_count = 1 + k % 40;
            struct contacts same = query_contacts(&repeated, &repeat, &(narc_query){.margin = INFINITY});
            assert_int_equal(same.count, repeated.pair_count);
            for (size_t i = 0; i < same.count; i++) {
                assert_int_equal(again[i], outcomes[k]);
                same.rows[i].pair = k;
                assert_memory_equal(&same.rows[i], &all.rows[k], sizeof same.rows[i]);
            }
            free(same.rows);
        }
        free(outcomes);
        free(again);
        free(all.rows);
        destroy_scene(&scene);
    }
}

/* Any bits at all as bodies, scales and margins: equal bits, no crash, and no endless loop. */
TEST(test_garbage_bodies) {
    struct test_random random = test_random_named("garbage of methods");
    for (size_t q = 0; q < SETTINGS; q++) {
        struct scene scene = make_query_scene(&random, &settings[q], NARC_FLOAT32, 200, 1000);
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
        struct guarded guarded = guard_shapes(&scene);
        uint32_t *hints = random_hints(&random, scene.pair_count);
        struct expected expected = expect(&scene, &settings[q], q % 2 ? hints : NULL);
        check_part(&scene, &guarded, &expected, LAYOUT_STRUCTURES, 0, scene.pair_count, 1);
        destroy_expected(&expected);
        free(hints);
        release_shapes(&guarded);
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

static void check_skipped(const struct scene *scene, const narc_method_options *options, size_t expected,
                          unsigned threads) {
    const narc_workers workers = narc_openmp_workers(threads);
    size_t skipped = 12345;
    narc_query query = {.workers = &workers, .out_skipped = &skipped};
    free(query_overlaps(scene, options, &query));
    assert_int_equal(skipped, expected);
    for (int m = 0; m < MARGINS && has_contacts(options); m++) {
        skipped = 12345;
        query.margin = margins[m];
        struct contacts found = query_contacts(scene, options, &query);
        assert_int_equal(skipped, expected);
        free(found.rows);
    }
}

/* A body off by a little collides with nothing: every method counts the pairs that it is in, whatever the number of
 * threads and the split. */
TEST(test_skipped_pairs) {
    enum { MANY = 6001 };
    struct test_random random = test_random_named("skipped pairs");
    for (size_t q = 0; q < SETTINGS; q++) {
        struct scene scene = make_query_scene(&random, &settings[q], q % 2 ? NARC_FLOAT64 : NARC_FLOAT32, BODIES, MANY);
        check_skipped(&scene, &settings[q], 0, 2);
        for (size_t k = 0; k < BODIES; k += 7)
            break_body(&scene.bodies[k], k / 7);
        size_t expected = 0, sum = 0;
        for (size_t k = 0; k < MANY; k++)
            expected += scene.pairs[k].a % 7 == 0 || scene.pairs[k].b % 7 == 0;
        assert_true(0 < expected && expected < MANY);
        for (unsigned threads = 1; threads <= 3; threads++)
            check_skipped(&scene, &settings[q], expected, threads);
        const narc_bodies bodies = scene_bodies(&scene);
        for (size_t first = 0, count; first < MANY; first += count) {
            count = 1 + random_below(&random, MANY / 4);
            count = count < MANY - first ? count : MANY - first;
            const struct pair *from = scene.pairs + first;
            const narc_pairs pairs = {.count = count, .a = NARC_COLUMN(from, a), .b = NARC_COLUMN(from, b)};
            uint64_t bits[NARC_BIT_WORDS(MANY)];
            size_t skipped;
            assert_int_equal(narc_find_overlaps_by(scene_methods(&scene), &bodies, &pairs, &settings[q],
                                                   &(narc_query){.out_skipped = &skipped}, bits, NULL),
                             NARC_OK);
            sum += skipped;
        }
        assert_int_equal(sum, expected);
        destroy_scene(&scene);
    }
}

TEST_MAIN("bits")
