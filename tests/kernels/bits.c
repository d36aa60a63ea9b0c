/* SPDX-License-Identifier: MIT
 *
 * bits.c - every question: one instruction set against scalar, to the last bit, with all counts, layouts, numbers of
 * threads and margins; guard pages on all sides.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "corpus.h"
#include "guard.h"
#include "layouts.h"
#include "questions.h"
#include "store.h"

/* Around a block of 128, and more than any vector is wide. */
enum { SMALL_COUNTS = 132, BODIES = 67 };

static const float margins[] = {0.0f, 0.25f, -0.1f, INFINITY};
enum { MARGINS = sizeof(margins) / sizeof(margins[0]) };

/* Bits have no margin. */
static size_t margins_of(const struct question *question) { return question->row_size ? MARGINS : 1; }

/* ------------------------------------------------------------------------------------------------ what is right */

/* What scalar says of all pairs of a scene, one thread. */
struct expected {
    const struct question *question;
    struct answer answers[MARGINS];
};

static struct expected expect(const struct scene *scene, const struct question *question) {
    struct expected expected = {.question = question};
    test_use_isa("scalar");
    for (size_t m = 0; m < margins_of(question); m++)
        expected.answers[m] = ask_scene(question, scene, (narc_query){.margin = margins[m]});
    test_use_isa(test_isa());
    return expected;
}

static void destroy_expected(struct expected *expected) {
    for (size_t m = 0; m < margins_of(expected->question); m++)
        destroy_answer(&expected->answers[m]);
}

/* How many rows of an answer are of pairs before this one. */
static size_t rows_before(const struct question *question, const struct answer *answer, size_t pair) {
    size_t count = 0;
    while (count < answer->count && *answer_pair(question, answer->rows, count) < pair)
        count++;
    return count;
}

/* ------------------------------------------------------------------------------------------------ a call */

/* A part of a scene, in some layout. */
struct part {
    const void *shapes; /* in guarded memory */
    struct columns columns;
    size_t first;
    narc_workers workers;
};

static void check_bits(const struct answer *all, const struct part *part, const uint64_t *bits, const char *name) {
    const size_t count = part->columns.pairs.count;
    for (size_t k = 0; k < 64 * NARC_BIT_WORDS(count); k++) {
        const bool right = k < count && bit_is_set(all->rows, part->first + k);
        if (bit_is_set(bits, k) != right)
            fail_msg("%s: %zu pairs from %zu, %u workers: bit %zu is not %d", name, count, part->first,
                     part->workers.count, k, right);
    }
}

static void check_answer(const struct expected *expected, const struct part *part, size_t m) {
    const struct question *question = expected->question;
    const struct answer *all = &expected->answers[m];
    const size_t count = part->columns.pairs.count, from = rows_before(question, all, part->first),
                 found = rows_before(question, all, part->first + count) - from;
    /* No longer than what is found: the guard then lies right behind the last row. */
    AUTO(guard_release_at) void *const rows = guard_allocate(answer_size(question, question->row_size ? found : count));
    AUTO(guard_release_at) uint8_t *const outcomes = guard_allocate(count);
    size_t told = found;
    const narc_query query = {.margin = margins[m], .workers = &part->workers};
    const struct asked asked = {part->shapes, &part->columns.bodies, &part->columns.pairs, &query, rows, found, &told,
                                outcomes};
    assert_int_equal(question->ask(question, &asked, NULL), NARC_OK);
    assert_int_equal(told, found);
    if (!question->row_size)
        check_bits(all, part, rows, question->name);
    for (size_t k = 0; k < found; k++) {
        *answer_pair(question, rows, k) += (uint32_t)part->first;
        if (memcmp(answer_row(question, rows, k), answer_row(question, all->rows, from + k), question->row_size) != 0)
            fail_msg("%s, margin %g: %zu pairs from %zu, %u workers: row %zu differs", question->name,
                     (double)margins[m], count, part->first, part->workers.count, k);
    }
    assert_memory_equal(outcomes, all->outcomes + part->first, count);
}

static void check_part(const struct scene *scene, const void *shapes, const struct expected *expected,
                       enum layout layout, size_t first, size_t count, unsigned threads) {
    struct part part = {shapes, create_columns(scene, layout, first, count), first, {0}};
    narc_openmp_workers(threads, &part.workers);
    for (size_t m = 0; m < margins_of(expected->question); m++)
        check_answer(expected, &part, m);
    destroy_columns(&part.columns);
}

/* A scene's shapes in guarded memory, and what the questions want of them. */
struct guarded {
    narc_shapes *store;
    const void *shapes;
};

static struct guarded guard_shapes(const struct scene *scene) {
    narc_shapes *const store = guard_store(scene);
    return (struct guarded){store, take_shapes(store, &guard_allocator)};
}

static void release_guarded(struct guarded *guarded) {
    release_shapes(guarded->shapes);
    narc_destroy_shapes(guarded->store);
}

/* ------------------------------------------------------------------------------------------------ tests */

/* Numbers of pairs from 0 on, each in the next of some layouts or in all of them. */
static void check_counts(const struct question *question, narc_precision precision, enum layout layout, size_t layouts,
                         size_t grow) {
    struct test_random random = test_random_named(question->name);
    AUTO(destroy_scene)
    struct scene scene = make_question_scene(&random, question, precision, BODIES, 2 * SMALL_COUNTS);
    suit_layout(&scene, layout);
    AUTO(release_guarded) struct guarded guarded = guard_shapes(&scene);
    AUTO(destroy_expected) struct expected expected = expect(&scene, question);
    const size_t each = question->every_layout ? layouts : 1;
    for (size_t count = 0; count < SMALL_COUNTS; count += 1 + count / grow)
        for (size_t k = 0; k < each; k++)
            check_part(&scene, guarded.shapes, &expected, layout + (enum layout)((count + k) % layouts),
                       random_below(&random, SMALL_COUNTS), count, 1);
}

TEST(test_all_counts) {
    for (size_t q = 0; q < 2 * question_count; q++)
        check_counts(&questions[q / 2], q % 2 ? NARC_FLOAT64 : NARC_FLOAT32, LAYOUT_ARRAYS, 3, SMALL_COUNTS);
}

/* Values that are one for all bodies, and no scales. */
TEST(test_shared_values) {
    for (size_t q = 0; q < 2 * question_count; q++)
        check_counts(&questions[q / 2], (q + 1) % 4 / 2 ? NARC_FLOAT64 : NARC_FLOAT32,
                     q % 2 ? LAYOUT_SHARED : LAYOUT_UNSCALED, 1, 4);
}

/* Several threads, each with several chunks. */
TEST(test_threads) {
    static const size_t counts[] = {1000, 1025, 5003, 20000};
    struct test_random random = test_random_named("threads");
    for (size_t q = 0; q < question_count; q++) {
        for (size_t k = 0; k < (questions[q].every_layout ? 4 : 3); k++) {
            const narc_precision precision = k % 2 ? NARC_FLOAT64 : NARC_FLOAT32;
            AUTO(destroy_scene)
            struct scene scene = make_question_scene(&random, &questions[q], precision, 300, counts[k]);
            AUTO(release_guarded) struct guarded guarded = guard_shapes(&scene);
            AUTO(destroy_expected) struct expected expected = expect(&scene, &questions[q]);
            for (unsigned threads = 0; threads <= 3; threads++)
                check_part(&scene, guarded.shapes, &expected, LAYOUT_STRUCTURES, 0, counts[k], threads);
        }
    }
}

/* Everything there is, in the hardest places. */
static void check_corpus(const char *name, narc_precision precision, bool polygons) {
    AUTO(destroy_corpus) struct corpus corpus = make_corpus(name, precision, 0.5, polygons);
    const struct scene *scene = &corpus.scene;
    AUTO(release_guarded) struct guarded guarded = guard_shapes(scene);
    for (size_t q = 0; q < question_count; q++) {
        if (questions[q].polygons && !polygons)
            continue;
        AUTO(destroy_expected) struct expected expected = expect(scene, &questions[q]);
        check_part(scene, guarded.shapes, &expected, LAYOUT_STRUCTURES, 0, scene->pair_count, 2);
        check_part(scene, guarded.shapes, &expected, LAYOUT_ARRAYS, 0, scene->pair_count, 1);
    }
}

TEST(test_hard_places) {
    check_corpus("bits", NARC_FLOAT32, false);
    check_corpus("bits, polygons", NARC_FLOAT64, true);
}

/* Pairs with margins of their own against calls with one margin. Pairs with a NaN there are skipped. */
TEST(test_margins_of_pairs) {
    enum { PAIRS = 2000 };
    struct test_random random = test_random_named("margins");
    narc_workers workers;
    narc_openmp_workers(2, &workers); /* so that chunks meet */
    for (size_t q = 0; q < question_count; q++) {
        const struct question *question = &questions[q];
        if (!question->row_size)
            continue;
        AUTO(destroy_scene) struct scene scene = make_question_scene(&random, question, NARC_FLOAT32, 150, PAIRS);
        struct answer each[MARGINS];
        float margin[PAIRS];
        size_t skipped = 0;
        for (size_t m = 0; m < MARGINS; m++)
            each[m] = ask_scene(question, &scene, (narc_query){.margin = margins[m], .workers = &workers});
        for (size_t k = 0; k < PAIRS; k++) {
            const size_t m = (k * k + k / 3) % (MARGINS + 1);
            margin[k] = m < MARGINS ? margins[m] : NAN;
            skipped += m == MARGINS;
        }
        size_t at = 0, next[MARGINS + 1] = {0};
        const narc_query query = {.margin = -1000, .margins = NARC_ARRAY(margin), .workers = &workers};
        struct answer found = ask_scene(question, &scene, query);
        assert_int_equal(found.skipped, skipped);
        for (size_t k = 0; k < PAIRS; k++) {
            for (size_t m = 0; m < MARGINS; m++)
                next[m] += next[m] < each[m].count && *answer_pair(question, each[m].rows, next[m]) < k;
            const size_t m = (k * k + k / 3) % (MARGINS + 1);
            const bool wanted =
                m < MARGINS && next[m] < each[m].count && *answer_pair(question, each[m].rows, next[m]) == k;
            const bool there = at < found.count && *answer_pair(question, found.rows, at) == k;
            assert_int_equal(there, wanted);
            if (there)
                assert_memory_equal(answer_row(question, found.rows, at), answer_row(question, each[m].rows, next[m]),
                                    question->row_size);
            at += there;
        }
        assert_int_equal(at, found.count);
        destroy_answer(&found);
        for (size_t m = 0; m < MARGINS; m++)
            destroy_answer(&each[m]);
    }
}

/* ------------------------------------------------------------------------------------------- bodies that are none */

/* The ways to spoil a body, so that no pair with it has an answer. */
enum { WAYS = 20 };
static void spoil(struct body *body, size_t way) {
    static const float spoilt[] = {NAN, INFINITY, -INFINITY};
    float *const values[] = {&body->x_single, &body->y_single, &body->cosine, &body->sine, &body->scale};
    if (way < 15) {
        *values[way / 3] = spoilt[way % 3];
    } else if (way < 18) {
        body->scale = (const float[]){0, -1, 1e12f}[way - 15];
    } else if (way == 18) {
        body->cosine = body->sine = 0;
    } else { /* off by 0.03 % */
        body->cosine *= 1.0003f;
        body->sine *= 1.0003f;
    }
    body->x = (double)body->x_single;
    body->y = (double)body->y_single;
}

/* Has the pair no answer? Rows with an infinite margin, and bits. */
static bool has_none(const struct question *question, const struct answer *answer, uint32_t pair) {
    const narc_contact contact = {.pair = pair, .separation = INFINITY};
    const narc_manifold manifold = {.pair = pair, .point = {{.separation = INFINITY}}};
    if (!question->row_size)
        return !bit_is_set(answer->rows, pair);
    return memcmp(answer_row(question, answer->rows, pair),
                  question->row_size == sizeof contact ? (const void *)&contact : &manifold, question->row_size) == 0;
}

static void check_skipped(const struct scene *scene, const struct question *question, const bool *broken,
                          size_t expected, unsigned threads) {
    const narc_workers workers = openmp_workers(threads);
    for (size_t m = 0; m < margins_of(question); m++) {
        AUTO(destroy_answer)
        struct answer answer = ask_scene(question, scene, (narc_query){.margin = margins[m], .workers = &workers});
        assert_int_equal(answer.skipped, expected);
        for (uint32_t k = 0; k < scene->pair_count && (!question->row_size || isinf(margins[m])); k++)
            assert_true(has_none(question, &answer, k) || !(broken[scene->pairs[k].a] || broken[scene->pairs[k].b]));
    }
}

/* Every question counts the pairs with a spoilt body, whatever the number of threads and the split. */
TEST(test_skipped_pairs) {
    enum { MANY = 6001 };
    struct test_random random = test_random_named("skipped pairs");
    for (size_t q = 0; q < question_count; q++) {
        const narc_precision precision = q % 2 ? NARC_FLOAT64 : NARC_FLOAT32;
        struct scene scene = make_question_scene(&random, &questions[q], precision, BODIES, MANY), part = scene;
        bool broken[BODIES] = {false};
        check_skipped(&scene, &questions[q], broken, 0, 2);
        for (size_t k = 0; k < BODIES; k += 3) {
            spoil(&scene.bodies[k], k / 3 % WAYS);
            broken[k] = true;
        }
        size_t expected = 0, sum = 0;
        for (size_t k = 0; k < MANY; k++)
            expected += broken[scene.pairs[k].a] || broken[scene.pairs[k].b];
        assert_true(0 < expected && expected < MANY);
        for (unsigned threads = 1; threads <= 3; threads++)
            check_skipped(&scene, &questions[q], broken, expected, threads);
        for (size_t first = 0; first < MANY; first += part.pair_count) {
            const size_t left = MANY - first, count = 1 + random_below(&random, MANY / 4);
            part.pairs = scene.pairs + first;
            part.pair_count = count < left ? count : left;
            AUTO(destroy_answer) struct answer answer = ask_scene(&questions[q], &part, (narc_query){0});
            sum += answer.skipped;
        }
        assert_int_equal(sum, expected);
        destroy_scene(&scene);
    }
}

/* Asks of three bodies in one place; `removed`: of the pairs with the second one there is no answer. */
static void ask_of_three(const struct question *question, const struct scene *scene, bool removed) {
    AUTO(destroy_answer) struct answer answer = ask_scene(question, scene, (narc_query){.margin = INFINITY});
    assert_int_equal(answer.skipped, removed ? 3 : 0);
    assert_int_equal(answer.count, question->row_size ? 4 : 0);
    for (uint32_t k = 0; k < 4 && removed; k++)
        assert_true(k == 2 || has_none(question, &answer, k));
}

/* The shape of the second is removed, its block is overwritten, and it comes back. */
TEST(test_removed_shapes) {
    static const struct pair pairs[] = {{0, 1}, {1, 2}, {0, 2}, {1, 2}};
    const struct shape box = box_of(1, 1, 0);
    struct shape large;
    assert_int_equal(narc_build_regular_polygon(64, 1, 0, large.arcs, &large.count, NULL), NARC_OK);
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 3, 3, 4);
    narc_shapes *const store = scene.store;
    for (uint32_t k = 0; k < 3; k++) {
        struct body body = turned_body(0, 1);
        body.shape = scene_add_shape(&scene, &box);
        scene_add_body(&scene, body);
    }
    for (size_t k = 0; k < 4; k++)
        scene_add_pair(&scene, pairs[k].a, pairs[k].b);
    for (size_t q = 0; q < question_count; q++) {
        ask_of_three(&questions[q], &scene, false);
        assert_int_equal(narc_remove_shape(store, 1, NULL), NARC_OK);
        ask_of_three(&questions[q], &scene, true);
        while (store->headers[1].first_record > 0) { /* until its block is gone */
            assert_int_equal(narc_replace_shape(store, 2, large.arcs, large.count, NULL), NARC_OK);
            assert_int_equal(narc_replace_shape(store, 2, box.arcs, box.count, NULL), NARC_OK);
        }
        ask_of_three(&questions[q], &scene, true);
        assert_int_equal(narc_add_shape_at(store, 1, box.arcs, box.count, NULL), NARC_OK);
    }
}

TEST_MAIN("bits")
