/* SPDX-License-Identifier: MIT
 *
 * batch.c - workers, sub-ranges, selections, margins, capacities and places of rows: however a batch is cut and wherever its
 * answers go, the bytes are the same.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "guard.h"
#include "questions.h"

/* Enough for every thread to get several chunks. */
enum { PAIRS = 20011 };

static struct scene make_scene(const char *name, size_t pairs) {
    struct test_random random = test_random_named(name);
    return make_random_scene(&random, NARC_FLOAT32, 500, pairs);
}

/* Rows from .. from + count - 1 of `expected` are rows 0 .. count - 1 of `rows`. */
static void check_same_rows(const struct contacts *expected, size_t from, const narc_contact *rows, size_t count) {
    assert_true(from + count <= expected->count);
    assert_memory_equal(expected->rows + from, rows, count * sizeof *rows);
}

/* Sub-ranges of 64, 128 ... pairs, in any order, write their own words only and together say what the whole call
 * says. */
TEST(test_overlap_ranges) {
    struct test_random random = test_random_named("overlap ranges");
    for (size_t round = 0; round < test_trials(40); round++) {
        size_t count = 1 + random_below(&random, 3000), words = NARC_BIT_WORDS(count);
        AUTO(destroy_scene) struct scene scene = make_scene("ranges", count);
        AUTO(free_at) uint64_t *whole = scene_overlaps(&scene), *glued = malloc(words * sizeof(uint64_t));
        memset(glued, 0xa5, words * sizeof(uint64_t));
        for (size_t first = 0; first < words;) {
            size_t step = 1 + random_below(&random, 5), last = first + step < words ? first + step : words;
            size_t from = first * 64, pair_count = last == words ? count - from : step * 64;
            const narc_query query = {.first = from, .count = pair_count};
            assert_int_equal(ask_overlaps(&scene, &query, glued, NULL), NARC_OK);
            assert_memory_equal(glued, whole, last * sizeof(uint64_t));
            assert_true(is_junk(glued + last, (words - last) * sizeof(uint64_t)));
            first = last;
        }
        /* A sub-range in the middle leaves both sides alone. */
        if (words > 2) {
            memset(glued, 0xa5, words * sizeof(uint64_t));
            const narc_query query = {.first = 64, .count = 64};
            assert_int_equal(ask_overlaps(&scene, &query, glued, NULL), NARC_OK);
            assert_true(is_junk(glued, 8) && glued[1] == whole[1] && is_junk(glued + 2, (words - 2) * 8));
        }
        /* A count of 0 goes to the end. */
        memset(glued, 0xa5, words * sizeof(uint64_t));
        const narc_query rest = {.first = words / 2 * 64};
        if (rest.first < count) {
            assert_int_equal(ask_overlaps(&scene, &rest, glued, NULL), NARC_OK);
            assert_true(is_junk(glued, words / 2 * 8));
            assert_memory_equal(glued + words / 2, whole + words / 2, (words - words / 2) * 8);
        }
    }
}

/* A margin keeps exactly the contacts below it out of the list of all, unchanged. */
TEST(test_margins) {
    const float margins[] = {0.0f,   -0.0f,  1e-6f, 0.05f,   0.7f,   100.0f,   3e38f,
                             -1e-6f, -0.05f, -0.7f, -100.0f, -3e38f, -INFINITY};
    AUTO(destroy_scene) struct scene scene = make_scene("margins", 5000);
    AUTO(free_at) struct contacts all = scene_contacts(&scene, INFINITY);
    AUTO(free_at) uint64_t *bits = scene_overlaps(&scene);
    for (size_t m = 0; m < sizeof(margins) / sizeof(margins[0]); m++) {
        AUTO(free_at) struct contacts some = scene_contacts(&scene, margins[m]);
        size_t next = 0;
        for (size_t k = 0; k < all.count; k++) {
            if (all.rows[k].separation < margins[m]) {
                assert_true(next < some.count);
                check_same_rows(&all, k, &some.rows[next], 1);
                next++;
            }
            if (margins[m] == 0)
                assert_int_equal(bit_is_set(bits, k), all.rows[k].separation < 0);
        }
        assert_int_equal(next, some.count);
    }
}

/* A body and itself: as deep as it gets, and still an answer. (Only a segment has no depth, it touches itself.) */
TEST(test_pairs_with_itself) {
    AUTO(destroy_scene) struct scene scene = make_scene("itself", 500);
    for (uint32_t k = 0; k < 500; k++)
        scene.pairs[k] = (struct pair){k, k};
    AUTO(free_at) struct contacts all = scene_contacts(&scene, INFINITY);
    AUTO(free_at) uint64_t *bits = scene_overlaps(&scene);
    for (uint32_t k = 0; k < 500; k++) {
        struct reference_body body = scene_reference(&scene, k);
        struct fractions errors = {0};
        const double gap = reference_solve_gap(&body, &body).gap;
        assert_true(bit_is_set(bits, k) || (body.count == 2 && gap >= -separation_bound(&body, &body)));
        const char *wrong = check_contact(&body, &body, gap, &all.rows[k], &errors);
        if (wrong) {
            print_pair(&body, &body);
            fail_msg("%s", wrong);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ places of rows */

/* Rows within larger structures. */
struct place {
    uint32_t before[3];
    union {
        narc_contact contact;
        narc_manifold manifold;
    } row;
    unsigned char after[20];
};

/* A question of a scene. */
struct batch {
    const struct scene *scene;
    const struct question *question;
};

static narc_status ask(const struct batch *batch, const narc_query *query, void *rows, size_t capacity,
                       size_t *out_count, narc_error *error) {
    const narc_bodies bodies = scene_bodies(batch->scene);
    const narc_pairs pairs = scene_pairs(batch->scene);
    const struct asked asked = {batch->scene->store, &bodies, &pairs, query, rows, capacity, out_count, NULL};
    return batch->question->ask(batch->question, &asked, error);
}

/* Has a row a point, or is it that of a pair that has no answer? */
static bool has_point(const struct batch *batch, const unsigned char *row) {
    narc_contact contact;
    narc_manifold manifold;
    memcpy(&contact, row, sizeof contact);
    memcpy(&manifold, row, batch->question->row_size);
    return batch->question->row_size == sizeof manifold ? manifold.count > 0 : contact.count > 0;
}

/* The answers of a whole batch as dense rows must be: `listed` in their pairs' rows, and zeros but for the pair. */
static unsigned char *make_dense(const struct batch *batch, const unsigned char *listed, size_t count) {
    const size_t size = batch->question->row_size;
    unsigned char *dense = calloc(batch->scene->pair_count, size);
    assert_non_null(dense);
    for (uint32_t k = 0; k < batch->scene->pair_count; k++)
        memcpy(dense + k * size, &k, sizeof k);
    for (size_t k = 0; k < count; k++) {
        uint32_t pair;
        memcpy(&pair, listed + k * size, sizeof pair);
        memcpy(dense + pair * size, listed + k * size, size);
    }
    return dense;
}

/* A selection of some pairs in any order, one at least. */
static size_t select_pairs(struct test_random *random, size_t count, uint32_t *selection) {
    size_t selected = 0;
    for (uint32_t k = 0; k < count; k++)
        if (random_below(random, 3) || k + 1 == count)
            selection[selected++] = k;
    for (size_t k = selected; k > 1; k--) {
        const size_t i = random_below(random, k);
        const uint32_t last = selection[k - 1];
        selection[k - 1] = selection[i];
        selection[i] = last;
    }
    return selected;
}

/* Are `count` rows of a size, each some bytes behind the other, those, and is all that lies between them junk? */
static void check_places(const struct place *places, const unsigned char *right, size_t count, size_t size) {
    for (size_t k = 0; k < count; k++) {
        const struct place *place = &places[k];
        assert_memory_equal(&place->row, right + k * size, size);
        assert_true(is_junk(place->before, sizeof place->before));
        assert_true(
            is_junk((const unsigned char *)&place->row + size, sizeof *place - offsetof(struct place, row) - size));
    }
}

/* Dense rows and listed ones, without gaps and within larger structures, of all pairs, of some of them, of a sub-range;
 * with one margin and with margins of the pairs. */
static void check_rows(struct test_random *random, const struct batch *batch, float margin, unsigned threads) {
    const size_t count = batch->scene->pair_count, size = batch->question->row_size;
    const narc_workers workers = openmp_workers(threads);
    const narc_query plain = {.margin = margin};
    AUTO(free_at) unsigned char *listed = make_junk(count * size);
    AUTO(free_at) uint32_t *selection = make_junk(count * sizeof *selection);
    size_t found = 0, again = 0, points = 0, part_points = 0;
    assert_int_equal(ask(batch, &plain, listed, count, &found, NULL), NARC_OK);
    AUTO(free_at) unsigned char *dense = make_dense(batch, listed, found);
    for (size_t k = 0; k < found; k++)
        points += has_point(batch, listed + k * size);
    AUTO(free_at) struct place *places = make_junk(count * sizeof *places);

    narc_query query = {.margin = margin, .row_stride = sizeof *places, .workers = &workers};
    assert_int_equal(ask(batch, &query, &places->row, found, &again, NULL), NARC_OK);
    assert_int_equal(again, found);
    check_places(places, listed, found, size);
    assert_true(is_junk(places + found, (count - found) * sizeof *places));
    query.dense = 1;
    assert_int_equal(ask(batch, &query, &places->row, count, &again, NULL), NARC_OK);
    assert_int_equal(again, points);
    check_places(places, dense, count, size);
    query.row_stride = 0;
    AUTO(guard_release_at) unsigned char *rows = guard_allocate(count * size);
    assert_int_equal(ask(batch, &query, rows, count, &again, NULL), NARC_OK);
    assert_int_equal(again, points);
    assert_memory_equal(rows, dense, count * size);

    /* From the last one in memory backwards. */
    AUTO(free_at) struct place *backwards = make_junk(count * sizeof *backwards);
    query.row_stride = -(ptrdiff_t)sizeof *places;
    assert_int_equal(ask(batch, &query, &backwards[count - 1].row, count, &again, NULL), NARC_OK);
    for (size_t k = 0; k < count; k++)
        assert_memory_equal(&backwards[k], &places[count - 1 - k], sizeof *places);
    query.row_stride = 0;

    /* Some pairs, in any order, and a sub-range of these: listed in that order, dense in the rows of the batch. */
    const size_t selected = select_pairs(random, count, selection), first = random_below(random, selected);
    const size_t part = 1 + random_below(random, selected - first);
    query.selection = (narc_index_column){selection, sizeof *selection};
    query.selection_count = selected;
    query.first = first;
    query.count = first + part < selected ? part : 0;
    memset(rows, 0xa5, count * size);
    assert_int_equal(ask(batch, &query, rows, count, &again, NULL), NARC_OK);
    AUTO(free_at) bool *is_asked = calloc(count, sizeof *is_asked);
    assert_non_null(is_asked);
    for (size_t k = first; k < first + part; k++) {
        is_asked[selection[k]] = true;
        part_points += has_point(batch, dense + selection[k] * size);
    }
    assert_int_equal(again, part_points);
    for (size_t k = 0; k < count; k++)
        if (is_asked[k])
            assert_memory_equal(rows + k * size, dense + k * size, size);
        else
            assert_true(is_junk(rows + k * size, size));
    query.dense = 0;
    assert_int_equal(ask(batch, &query, rows, count, &again, NULL), NARC_OK);
    AUTO(free_at) bool *is_listed = calloc(count, sizeof *is_listed);
    assert_non_null(is_listed);
    for (size_t k = 0; k < found; k++) {
        uint32_t pair;
        memcpy(&pair, listed + k * size, sizeof pair);
        is_listed[pair] = true;
    }
    size_t at = 0;
    for (size_t k = first; k < first + part; k++)
        if (is_listed[selection[k]])
            assert_memory_equal(rows + size * at++, dense + selection[k] * size, size);
    assert_int_equal(at, again);
}

TEST(test_places_of_rows) {
    struct test_random random = test_random_named("places of rows");
    static const size_t counts[] = {1, 2, 17, 64, 1000, 1025, 5003};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        AUTO(destroy_scene) struct scene scene = make_scene("places of rows", counts[c]);
        for (size_t k = 0; k < scene.body_count; k += 50)
            scene.bodies[k].sine = NAN;
        for (size_t q = 0; q < question_count; q++) {
            const struct batch batch = {&scene, &questions[q]};
            if (!questions[q].row_size)
                continue;
            for (unsigned threads = 1; threads < 4; threads++) {
                check_rows(&random, &batch, 0, threads);
                check_rows(&random, &batch, 0.2f, threads);
                check_rows(&random, &batch, INFINITY, threads);
            }
        }
    }
}

/* Dense rows need room up to the last pair, of a selection that of the batch: less is an error, and nothing is
 * written. */
TEST(test_dense_capacity) {
    AUTO(destroy_scene) struct scene scene = make_scene("dense capacity", 1500);
    for (size_t q = 0; q < question_count; q++) {
        const struct batch batch = {&scene, &questions[q]};
        if (!questions[q].row_size)
            continue;
        AUTO(free_at) unsigned char *rows = make_junk(1500 * batch.question->row_size);
        const uint32_t selection[] = {700, 1200, 3};
        size_t found = 12345;
        assert_int_equal(ask(&batch, &(narc_query){.dense = 1}, rows, 1499, &found, NULL), NARC_ERROR_CAPACITY);
        assert_true(is_junk(rows, 1500 * batch.question->row_size));
        const narc_query range = {.dense = 1, .first = 100, .count = 200};
        assert_int_equal(ask(&batch, &range, rows, 299, &found, NULL), NARC_ERROR_CAPACITY);
        assert_true(is_junk(rows, 1500 * batch.question->row_size));
        assert_int_equal(ask(&batch, &range, rows, 300, &found, NULL), NARC_OK);
        assert_true(is_junk(rows, 100 * batch.question->row_size));
        assert_true(is_junk(rows + 300 * batch.question->row_size, 1200 * batch.question->row_size));
        memset(rows, 0xa5, 300 * batch.question->row_size);
        const narc_query some = {.dense = 1, .selection = NARC_ARRAY(selection), .selection_count = 3};
        assert_int_equal(ask(&batch, &some, rows, 1499, &found, NULL), NARC_ERROR_CAPACITY);
        assert_true(is_junk(rows, 1500 * batch.question->row_size));
        assert_int_equal(ask(&batch, &some, rows, 1500, &found, NULL), NARC_OK);
        assert_false(is_junk(rows + 1200 * batch.question->row_size, batch.question->row_size));
    }
}

/* Bit k of a selection is that of pair selection[k]; the bits behind the last are 0. */
TEST(test_selected_bits) {
    struct test_random random = test_random_named("selected bits");
    for (size_t round = 0; round < test_trials(20); round++) {
        const size_t count = 1 + random_below(&random, 5000);
        AUTO(destroy_scene) struct scene scene = make_scene("selected bits", count);
        const narc_workers workers = openmp_workers((unsigned)(round % 4));
        AUTO(free_at) uint32_t *selection = make_junk(count * sizeof *selection);
        const size_t selected = select_pairs(&random, count, selection), words = NARC_BIT_WORDS(selected);
        uint64_t *all = scene_overlaps(&scene), *bits = guard_allocate(words * sizeof *bits);
        narc_query query = {
            .selection = {selection, sizeof *selection}, .selection_count = selected, .workers = &workers};
        assert_int_equal(ask_overlaps(&scene, &query, bits, NULL), NARC_OK);
        for (size_t k = 0; k < 64 * words; k++)
            assert_int_equal(bit_is_set(bits, k), k < selected && bit_is_set(all, selection[k]));
        if (words > 2) { /* a sub-range of the selection */
            AUTO(free_at) uint64_t *part = make_junk(words * sizeof *part);
            query.first = 64;
            query.count = 64;
            assert_int_equal(ask_overlaps(&scene, &query, part, NULL), NARC_OK);
            assert_true(is_junk(part, 8) && part[1] == bits[1] && is_junk(part + 2, (words - 2) * 8));
        }
        query = (narc_query){.selection = query.selection}; /* of none */
        assert_int_equal(ask_overlaps(&scene, &query, NULL, NULL), NARC_OK);
        guard_release(bits);
        free(all);
    }
}

TEST_MAIN("batch")
