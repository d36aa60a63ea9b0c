/* SPDX-License-Identifier: MIT
 *
 * regions.c - narc_query_index() against all pairs of a query and a box: sizes, places, masks, memory, errors.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "expect.h"
#include "guard.h"
#include "index.h"
#include "ledger.h"
#include "narc.h"
#include "support.h"

/* Boxes and queries, and what they are asked by; what is NULL is left out. */
struct question {
    const narc_box *boxes, *queries;
    size_t box_count, query_count;
    const uint64_t *category, *mask;
    const uint32_t *ignored, *owner, *ignored_owner, *world, *asked_world;
};

static bool is_found(const struct question *q, size_t query, size_t body) {
    const uint64_t mask = q->mask ? q->mask[query] : UINT64_MAX,
                   category = q->category ? q->category[body] : UINT64_MAX;
    return (!q->asked_world || q->world[body] == q->asked_world[query]) &&
           overlap(&q->queries[query], &q->boxes[body]) && (!q->ignored || q->ignored[query] != body) &&
           (!q->owner || q->ignored_owner[query] == UINT32_MAX || q->owner[body] != q->ignored_owner[query]) &&
           (mask & category) != 0;
}

/* Every query with every body, in the order that is promised. */
static struct pair_list find_all(const struct question *q) {
    struct pair_list rows = {0};
    for (size_t query = 0; query < q->query_count; query++)
        for (size_t body = 0; body < q->box_count; body++)
            if (is_found(q, query, body))
                list_pair(&rows, query, body);
    return rows;
}

static void check_rows(const struct pair_list *expected, const narc_pairs *pairs) {
    assert_int_equal(pairs->count, expected->count);
    assert_int_equal(pairs->a.stride, sizeof(uint32_t));
    assert_int_equal(pairs->b.stride, sizeof(uint32_t));
    if (expected->count > 0) {
        assert_memory_equal(pairs->a.base, expected->a, expected->count * sizeof(uint32_t));
        assert_memory_equal(pairs->b.base, expected->b, expected->count * sizeof(uint32_t));
    }
}

static void ask(narc_index *index, const struct question *q, unsigned workers, narc_pairs *out_pairs) {
    const narc_workers some = openmp_workers(workers);
    const narc_owners owners = {.owner = {q->owner, sizeof *q->owner},
                                .ignored = {q->ignored_owner, sizeof *q->ignored_owner}};
    const narc_index_query query = {.mask = {q->mask, sizeof *q->mask},
                                    .owners = q->owner ? &owners : NULL,
                                    .ignored = {q->ignored, sizeof *q->ignored},
                                    .world = {q->asked_world, sizeof *q->asked_world},
                                    .workers = workers > 1 ? &some : NULL};
    narc_box *const guarded = guard_copy(q->queries, q->query_count * sizeof *q->queries);
    narc_error error;
    if (narc_query_index(index, guarded, q->query_count, &query, out_pairs, &error) != NARC_OK)
        fail_msg("%s", error.message);
    guard_release(guarded);
}

/* Builds, fast and well, asks, and asks again after an update from other boxes. */
static void check_question(narc_index *index, const struct question *q) {
    static const unsigned workers[] = {1, 2, 3, 7};
    struct pair_list expected = find_all(q);
    for (unsigned way = 0; way < 3; way++) {
        const narc_index_options options = {
            .category = {q->category, sizeof *q->category}, .fast = way == 1, .world = {q->world, sizeof *q->world}};
        AUTO(free_at) narc_box *other = NULL;
        if (way == 2) {
            other = malloc((q->box_count + 1) * sizeof *other);
            for (size_t k = 0; k < q->box_count; k++)
                other[k] = q->boxes[q->box_count - 1 - k];
        }
        assert_int_equal(narc_build_index(index, other ? other : q->boxes, q->box_count, &options, NULL), NARC_OK);
        if (other)
            assert_int_equal(narc_update_index(index, q->boxes, q->box_count, NULL, 0, &options, NULL), NARC_OK);
        for (unsigned w = 0; w < 4; w++) {
            narc_pairs pairs;
            ask(index, q, workers[w], &pairs);
            check_rows(&expected, &pairs);
        }
    }
    free_list(&expected);
}

static const size_t counts[] = {0, 1, 7, 8, 9, 64, 65, 513, 5000};
enum { COUNTS = sizeof counts / sizeof counts[0], QUERIES = 200, MOST = 5000 };

TEST(finds_what_all_pairs_find) {
    enum { KINDS = BOXES_MIXED + 1 };
    struct test_random random = test_random_named("regions");
    static narc_box boxes[MOST], queries[QUERIES];
    static uint64_t category[MOST], mask[QUERIES];
    static uint32_t ignored[QUERIES], owner[MOST], ignored_owner[QUERIES], world[MOST], asked_world[QUERIES];
    AUTO(narc_destroy_index_at) narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (size_t trial = 0; trial < KINDS * COUNTS * 2; trial++) {
        const size_t kind = trial % KINDS, count = counts[trial / KINDS % COUNTS], options = trial % 4;
        for (size_t k = 0; k < count; k++)
            owner[k] = (uint32_t)random_below(&random, count / 4 + 1);
        const double side = kind == BOXES_CROWD ? 3 : sqrt((double)count) * 2;
        for (size_t k = 0; k < count; k++) {
            boxes[k] = make_box(&random, (enum box_kind)kind, k, count);
            category[k] = (uint64_t)random_below(&random, 8) << 31;
            world[k] = (uint32_t)(k * k % 5 * 0x30000000);
        }
        for (size_t k = 0; k < QUERIES; k++) {
            asked_world[k] = (uint32_t)(k % 6 * 0x30000000);
            queries[k] = random_box(&random, side, 0, k % 20 == 0 ? side : 4);
            if (k % 10 == 1 && count > 0)
                queries[k] = boxes[random_below(&random, count)];
            if (k % 50 == 2)
                queries[k] = (narc_box){-FLT_MAX, -FLT_MAX, FLT_MAX, FLT_MAX};
            if (k % 10 == 3)
                (&queries[k].min_x)[random_below(&random, 4)] = random_below(&random, 2) ? NAN : -INFINITY;
            mask[k] = (uint64_t)random_below(&random, 8) << 31;
            ignored[k] = random_below(&random, 4) ? (uint32_t)random_below(&random, count + 1) : UINT32_MAX;
            ignored_owner[k] = random_below(&random, 4) ? (uint32_t)random_below(&random, count / 4 + 1) : UINT32_MAX;
        }
        check_question(index,
                       &(struct question){boxes, queries, count, QUERIES - trial % 3, options & 1 ? category : NULL,
                                          options == 1 || options == 2 ? mask : NULL, options & 2 ? ignored : NULL,
                                          options > 0 && trial / KINDS % 2 ? owner : NULL, ignored_owner,
                                          trial % 3 ? NULL : world, trial % 3 ? NULL : asked_world});
    }
}

/* One query that finds all, between others: more than a chunk, and sorted by digits. The order of rows does not depend
 * on memory that is there already. */
TEST(finds_more_than_there_was_room_for) {
    enum { COUNT = 20000, ASKED = 300 };
    struct test_random random = test_random_named("many in a region");
    narc_box *const boxes = malloc(COUNT * sizeof *boxes), queries[ASKED];
    AUTO(narc_destroy_index_at) narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = random_box(&random, 1, 0, 1);
    for (size_t k = 0; k < ASKED; k++) {
        queries[k] = (narc_box){3, 3, 4, 4};
        if (k % 37 == 5)
            queries[k] = (narc_box){-1, -1, k % 2 ? 0.5f : 2, 2};
    }
    check_question(index,
                   &(struct question){.boxes = boxes, .queries = queries, .box_count = COUNT, .query_count = ASKED});
    free(boxes);
}

/* 131, 129, 128, 127 ... boxes above one another. */
TEST(orders_any_number_of_bodies) {
    enum { COUNT = 300 };
    struct test_random random = test_random_named("order of regions");
    narc_box boxes[COUNT], queries[COUNT];
    AUTO(narc_destroy_index_at) narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (size_t k = 0; k < COUNT; k++) {
        const float x = (float)(k * 7 % COUNT);
        boxes[k] = (narc_box){x, 0, x, 0};
        queries[k] = (narc_box){-1, 0, (float)k - 0.5f, 1};
    }
    check_question(index,
                   &(struct question){.boxes = boxes, .queries = queries, .box_count = COUNT, .query_count = COUNT});
    for (size_t k = 0; k < COUNT; k++)
        boxes[k].min_x = (float)random_below(&random, COUNT);
    check_question(index,
                   &(struct question){.boxes = boxes, .queries = queries, .box_count = COUNT, .query_count = COUNT});
}

/* ------------------------------------------------------------------------------------------------ memory and errors */

TEST(survives_failing_allocations) {
    enum { COUNT = 3000, ASKED = 500 };
    struct test_random random = test_random_named("memory of regions");
    struct ledger ledger = {0};
    const narc_allocator allocator = ledger_allocator(&ledger);
    static narc_box boxes[COUNT], queries[ASKED];
    narc_index *index;
    narc_error error;
    size_t failures = 0;
    assert_int_equal(narc_create_index(&allocator, &index), NARC_OK);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = random_box(&random, 10, 0, 2);
    for (size_t k = 0; k < ASKED; k++)
        queries[k] = random_box(&random, 10, 0, 2);
    const struct question q = {.boxes = boxes, .queries = queries, .box_count = COUNT, .query_count = ASKED};
    assert_int_equal(narc_build_index(index, boxes, COUNT, NULL, NULL), NARC_OK);
    ledger.limited = true;
    narc_pairs pairs = {.count = 7};
    for (size_t left = 0;; left++, failures++) {
        ledger.left = left;
        const narc_status status = narc_query_index(index, queries, ASKED, NULL, &pairs, &error);
        if (status == NARC_OK)
            break;
        expect_error(status, NARC_ERROR_MEMORY, &error, "no memory for");
        assert_int_equal(pairs.count, 7);
    }
    struct pair_list expected = find_all(&q);
    check_rows(&expected, &pairs);
    assert_true(failures >= 3); /* queries, bodies, rows */
    const size_t allocations = ledger.allocations;
    for (size_t k = 0; k < 5; k++) {
        assert_int_equal(narc_query_index(index, queries, ASKED, NULL, &pairs, NULL), NARC_OK);
        check_rows(&expected, &pairs);
    }
    assert_int_equal(ledger.allocations, allocations);
    free_list(&expected);
    narc_destroy_index(index);
    assert_int_equal(ledger.live, 0);
}

TEST(reads_columns_with_any_stride) {
    enum { COUNT = 40, ASKED = 30 };
    struct test_random random = test_random_named("columns of regions");
    struct row {
        uint64_t word;
        uint32_t index, other;
    };
    static narc_box boxes[COUNT], queries[ASKED];
    static uint64_t category[COUNT], mask[ASKED];
    static uint32_t ignored[ASKED];
    AUTO(guard_release_at) struct row *const bodies = guard_allocate(COUNT * sizeof *bodies);
    AUTO(guard_release_at) struct row *const asked = guard_allocate(ASKED * sizeof *asked);
    for (size_t k = 0; k < COUNT; k++) {
        boxes[k] = random_box(&random, 3, 0, 2);
        bodies[COUNT - 1 - k].word = category[k] = (uint64_t)1 << random_below(&random, 3) * 21;
    }
    for (size_t k = 0; k < ASKED; k++) {
        queries[k] = random_box(&random, 3, 0, 2);
        asked[k].word = mask[k] = (uint64_t)random_below(&random, 2) << 42 | random_below(&random, 2) << 21;
        asked[k].index = ignored[k] = (uint32_t)random_below(&random, COUNT);
    }
    const struct question q = {boxes, queries, COUNT, ASKED, category, mask, ignored, NULL, NULL, NULL, NULL};
    const narc_index_options options = {.category = {&bodies[COUNT - 1].word, -(ptrdiff_t)sizeof *bodies}};
    const narc_index_query query = {.mask = NARC_COLUMN(asked, word), .ignored = NARC_COLUMN(asked, index)};
    struct pair_list expected = find_all(&q);
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_pairs pairs;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, boxes, COUNT, &options, NULL), NARC_OK);
    assert_int_equal(narc_query_index(index, queries, ASKED, &query, &pairs, NULL), NARC_OK);
    assert_true(expected.count > 50);
    check_rows(&expected, &pairs);
    free_list(&expected);
}

TEST_MAIN("regions")
