/* SPDX-License-Identifier: MIT
 *
 * match.c - narc_match_pairs() against a search, and narc_gather(): which pair of the last step each pair was.
 */
#include <stdlib.h>

#include "guard.h"
#include "ledger.h"
#include "support.h"

static int compare_pairs(const void *one, const void *other) {
    const uint32_t *p = one, *q = other;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return p[1] == q[1] ? 0 : p[1] < q[1] ? -1 : 1;
}

/* Lists in order and not, with pairs that stand twice, and their reverses. */
TEST(matches_as_a_search_does) {
    struct test_random random = test_random_named("matches");
    narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t trial = 0; trial < test_trials(80); trial++) {
        const size_t old_count = random_below(&random, 400), new_count = random_below(&random, 400);
        const size_t bodies = 2 + random_below(&random, 40), order = random_below(&random, 4);
        uint32_t(*const old_pairs)[2] = malloc((old_count + 1) * sizeof *old_pairs);
        uint32_t(*const new_pairs)[2] = guard_allocate(new_count * sizeof *new_pairs);
        for (size_t k = 0; k < 2 * old_count; k++)
            old_pairs[k / 2][k % 2] = (uint32_t)random_below(&random, bodies);
        for (size_t k = 0; k < 2 * new_count; k++)
            new_pairs[k / 2][k % 2] = (uint32_t)random_below(&random, bodies);
        if (order & 1)
            qsort(old_pairs, old_count, sizeof *old_pairs, compare_pairs);
        if (order & 2)
            qsort(new_pairs, new_count, sizeof *new_pairs, compare_pairs);
        uint32_t *match = guard_allocate(new_count * sizeof *match);
        const narc_pairs olds = {.count = old_count, .a = {&old_pairs[0][0], 8}, .b = {&old_pairs[0][1], 8}};
        const narc_pairs news = {.count = new_count, .a = {&new_pairs[0][0], 8}, .b = {&new_pairs[0][1], 8}};
        const narc_workers workers = narc_openmp_workers(1 + (unsigned)trial % 3);
        assert_int_equal(narc_match_pairs(broad, &olds, &news, &workers, match, NULL), NARC_OK);
        for (size_t k = 0; k < new_count; k++) {
            uint32_t expected = NARC_NO_MATCH;
            for (size_t i = 0; i < old_count && expected == NARC_NO_MATCH; i++)
                if (compare_pairs(old_pairs[i], new_pairs[k]) == 0)
                    expected = (uint32_t)i;
            assert_int_equal(match[k], expected);
        }
        guard_release(match);
        guard_release(new_pairs);
        free(old_pairs);
    }
    narc_destroy_broad_phase(broad);
}

/* Lists whose only disorder is anywhere, where parts for threads meet among others. */
TEST(matches_lists_with_one_disorder) {
    enum { COUNT = 40000, PART = 16384 };
    static uint32_t a[COUNT], b[COUNT], match[COUNT];
    static const size_t places[] = {1, PART - 1, PART, PART + 1, 2 * PART, COUNT - 1};
    narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t p = 0; p < sizeof places / sizeof places[0]; p++) {
        for (uint32_t k = 0; k < COUNT; k++) {
            a[k] = k;
            b[k] = k + 1;
        }
        a[places[p]] = (uint32_t)places[p] - 1; /* two that change places */
        b[places[p]] = (uint32_t)places[p];
        a[places[p] - 1] = (uint32_t)places[p];
        b[places[p] - 1] = (uint32_t)places[p] + 1;
        const narc_pairs pairs = {.count = COUNT, .a = {a, sizeof *a}, .b = {b, sizeof *b}};
        for (unsigned threads = 1; threads <= 3; threads++) {
            const narc_workers workers = narc_openmp_workers(threads);
            assert_int_equal(narc_match_pairs(broad, &pairs, &pairs, &workers, match, NULL), NARC_OK);
            for (uint32_t k = 0; k < COUNT; k++)
                assert_int_equal(match[k], k);
        }
    }
    narc_destroy_broad_phase(broad);
}

enum { MANY = 400000, SKIPPED = 5 };

/* Pairs of which a fixed hash makes little. None stands twice. */
static uint64_t choose_regular(uint64_t k) { return k * 4096; }

static uint64_t choose_far_apart(uint64_t k) { return (k % 1000 * 4096) << 32 | k / 1000 * 4096; }

static uint64_t choose_grid(uint64_t k) { return k << 44 | k << 12; }

static const uint64_t golden = 0x9e3779b97f4a7c15u; /* the usual multiplier */

/* Modulo 2^64; Newton's steps double the number of bits that are right. */
static uint64_t invert(uint64_t odd) {
    uint64_t inverse = odd;
    for (int step = 0; step < 6; step++)
        inverse *= 2 - odd * inverse;
    return inverse;
}

/* The product's upper bits are 0. */
static uint64_t choose_small_products(uint64_t k) { return k * invert(golden); }

/* 25 bits of its upper half are those 25 places below, so that both with an exclusive or are 0. The pair's halves were
 * mixed before. */
static uint64_t choose_folded_products(uint64_t k) {
    const uint64_t low = k << 7, mixed = (low << 25 | low) * invert(golden);
    return mixed ^ mixed >> 32;
}

/* Two products, the first with its upper half mixed into the lower; the second's upper bits are 0. */
static uint64_t choose_small_second_products(uint64_t k) {
    const uint64_t mixed = k * invert(golden);
    return (mixed ^ mixed >> 32) * invert(golden);
}

/* Whoever chooses the pairs of a list, matching does not look at all old pairs for each, which would not end here. */
TEST(matches_lists_that_were_chosen_badly) {
    static uint64_t (*const choose[])(uint64_t) = {
        choose_regular,        choose_far_apart,       choose_grid,
        choose_small_products, choose_folded_products, choose_small_second_products};
    static uint32_t a[MANY], b[MANY], match[MANY];
    narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t way = 0; way < sizeof choose / sizeof choose[0]; way++) {
        for (size_t k = 0; k < MANY - 1; k++) { /* each once, in disorder */
            const uint64_t pair = choose[way](k * 7 % (MANY - 1));
            a[k] = (uint32_t)(pair >> 32);
            b[k] = (uint32_t)pair;
        }
        a[MANY - 1] = a[SKIPPED]; /* and one twice */
        b[MANY - 1] = b[SKIPPED];
        const narc_pairs olds = {.count = MANY, .a = {a, sizeof *a}, .b = {b, sizeof *b}};
        const narc_pairs news = {
            .count = MANY - SKIPPED - 1, .a = {a + SKIPPED + 1, sizeof *a}, .b = {b + SKIPPED + 1, sizeof *b}};
        for (unsigned threads = 1; threads <= 3; threads += 2) {
            const narc_workers workers = narc_openmp_workers(threads);
            assert_int_equal(narc_match_pairs(broad, &olds, &news, &workers, match, NULL), NARC_OK);
            for (size_t k = 0; k < news.count - 1; k++)
                assert_int_equal(match[k], k + SKIPPED + 1);
            assert_int_equal(match[news.count - 1], SKIPPED);
        }
    }
    narc_destroy_broad_phase(broad);
}

static void *refuse_large(size_t size, void *context) {
    (void)context;
    return size < 1 << 20 ? malloc(size) : NULL;
}

static void release(void *memory, void *context) {
    (void)context;
    free(memory);
}

/* A list for which a 32-bit machine has no memory, nor room to count its bytes. */
TEST(tells_that_there_is_no_memory) {
    static const uint32_t zero = 0, falling[] = {1, 0};
    const narc_allocator allocator = {refuse_large, release, NULL};
    narc_broad_phase *broad = NULL;
    uint32_t match[2] = {7, 7};
    narc_error error;
    const narc_workers workers = narc_openmp_workers(0);
    assert_int_equal(narc_create_broad_phase(&allocator, &broad), NARC_OK);
    const narc_pairs olds = {.count = ((size_t)1 << 30) + 1, .a = {&zero, 0}, .b = {&zero, 0}};
    const narc_pairs news = {.count = 2, .a = {falling, sizeof *falling}, .b = {falling, sizeof *falling}};
    assert_int_equal(narc_match_pairs(broad, &olds, &news, &workers, match, &error), NARC_ERROR_MEMORY);
    assert_string_equal(error.message, "not enough memory for 1073741825 pairs");
    const narc_pairs most = {.count = UINT32_MAX, .a = {&zero, 0}, .b = {&zero, 0}};
    assert_int_equal(narc_match_pairs(broad, &most, &news, &workers, match, &error), NARC_ERROR_ARGUMENT);
    assert_string_equal(error.message, "old_pairs: 4294967295 pairs, at most 4294967294");
    const narc_pairs allowed = {.count = UINT32_MAX - 1};
    assert_int_equal(narc_match_pairs(broad, &allowed, &news, &workers, match, &error), NARC_ERROR_ARGUMENT);
    assert_string_equal(error.message, "old_pairs.a is NULL");
    assert_int_equal(match[0], 7);
    assert_int_equal(narc_match_pairs(broad, &news, &news, &workers, match, &error), NARC_OK);
    narc_destroy_broad_phase(broad);
}

TEST(gathers_columns) {
    const uint32_t match[] = {2, NARC_NO_MATCH, 0, 2};
    const uint32_t values[] = {10, 11, 12};
    const struct { float normal, tangent[2]; } impulses[] = {{1, {2, 3}}, {4, {5, 6}}, {7, {8, 9}}};
    uint32_t *out_values = guard_allocate(sizeof match);
    float(*const out_impulses)[3] = guard_allocate(4 * sizeof impulses[0]);
    narc_gather(match, 4, sizeof *values, values, out_values);
    narc_gather(match, 4, sizeof impulses[0], impulses, out_impulses);
    assert_memory_equal(out_values, ((const uint32_t[]){12, 0, 10, 12}), sizeof match);
    assert_memory_equal(out_impulses, ((const float[4][3]){{7, 8, 9}, {0, 0, 0}, {1, 2, 3}, {7, 8, 9}}),
                        4 * sizeof impulses[0]);
    guard_release(out_values);
    guard_release(out_impulses);
}

TEST_MAIN("match")
