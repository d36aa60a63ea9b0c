/* SPDX-License-Identifier: MIT
 *
 * match.c - narc_match_pairs(), by which bodies are known by their ids, against a search. Internal.
 */
#include <stdlib.h>

#include "broad_phase/steps.h"
#include "guard.h"
#include "ledger.h"
#include "support.h"

typedef uint32_t halves[2];

static int compare_pairs(const void *one, const void *other) {
    const uint32_t *p = one, *q = other;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return p[1] == q[1] ? 0 : p[1] < q[1] ? -1 : 1;
}

static narc_pairs view(halves *pairs, size_t count) {
    return (narc_pairs){.count = count, .a = {&pairs[0][0], sizeof *pairs}, .b = {&pairs[0][1], sizeof *pairs}};
}

static void match(narc_broad_phase *broad, const narc_pairs *olds, const narc_pairs *news, unsigned threads,
                  uint32_t *out) {
    const narc_workers workers = openmp_workers(threads);
    assert_int_equal(narc_match_pairs(broad, olds, news, &workers, out), NARC_OK);
}

/* Lists in order and not, with pairs that stand twice, and their reverses. */
TEST(matches_as_a_search_does) {
    enum { MOST = 400 };
    struct test_random random = test_random_named("matches");
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    static halves pairs[2][MOST];
    for (size_t trial = 0; trial < test_trials(80); trial++) {
        const size_t count[2] = {random_below(&random, MOST), random_below(&random, MOST)};
        const size_t bodies = 2 + random_below(&random, 40), order = random_below(&random, 4);
        for (size_t list = 0; list < 2; list++) {
            for (size_t k = 0; k < 2 * count[list]; k++)
                pairs[list][k / 2][k % 2] = (uint32_t)random_below(&random, bodies);
            if (order >> list & 1)
                qsort(pairs[list], count[list], sizeof(halves), compare_pairs);
        }
        AUTO(guard_release_at) uint32_t *const found = guard_allocate(count[1] * sizeof *found);
        const narc_pairs olds = view(pairs[0], count[0]), news = view(pairs[1], count[1]);
        match(broad, &olds, &news, 1 + (unsigned)trial % 3, found);
        for (size_t k = 0; k < count[1]; k++) {
            uint32_t expected = NARC_NO_MATCH;
            for (size_t i = 0; i < count[0] && expected == NARC_NO_MATCH; i++)
                if (compare_pairs(pairs[0][i], pairs[1][k]) == 0)
                    expected = (uint32_t)i;
            assert_int_equal(found[k], expected);
        }
    }
}

enum { MANY = 100000, SKIPPED = 5, PART = 16384 };
static halves list[MANY];
static uint32_t found[MANY];

/* Lists whose only disorder is anywhere, where parts for threads meet among others. */
TEST(matches_lists_with_one_disorder) {
    enum { COUNT = 40000 };
    static const uint32_t places[] = {1, PART - 1, PART, PART + 1, 2 * PART, COUNT - 1};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t p = 0; p < sizeof places / sizeof places[0]; p++) {
        for (uint32_t k = 0; k < COUNT; k++) {
            const uint32_t at = k == places[p] ? k - 1 : k == places[p] - 1 ? k + 1 : k; /* two change places */
            list[k][0] = at;
            list[k][1] = at + 1;
        }
        const narc_pairs pairs = view(list, COUNT);
        for (unsigned threads = 1; threads <= 3; threads++) {
            match(broad, &pairs, &pairs, threads, found);
            for (uint32_t k = 0; k < COUNT; k++)
                assert_int_equal(found[k], k);
        }
    }
}

/* Pairs of which a fixed hash makes little; none stands twice. By the usual multiplier's inverse: the upper bits of a product
 * are 0; or 25 bits of its upper half are those 25 places below, so that both with an exclusive or are 0; or the second of two
 * products is small. */
static uint64_t choose_grid(uint64_t k) { return k << 44 | k << 12; }
static const uint64_t inverse = 0xf1de83e19937733du;
static uint64_t choose_small_products(uint64_t k) { return k * inverse; }
static uint64_t choose_folded_products(uint64_t k) {
    const uint64_t low = k << 7, mixed = (low << 25 | low) * inverse;
    return mixed ^ mixed >> 32;
}
static uint64_t choose_small_second_products(uint64_t k) {
    const uint64_t mixed = k * inverse;
    return (mixed ^ mixed >> 32) * inverse;
}

/* Whoever chooses ids, matching does not look at all old ones for each, which would not end here. */
TEST(matches_lists_that_were_chosen_badly) {
    static uint64_t (*const choose[])(uint64_t) = {choose_grid, choose_small_products, choose_folded_products,
                                                   choose_small_second_products};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    assert_true(inverse * UINT64_C(0x9e3779b97f4a7c15) == 1);
    for (size_t way = 0; way < sizeof choose / sizeof choose[0]; way++) {
        for (size_t k = 0; k < MANY; k++) { /* each once, in disorder; and one twice */
            const uint64_t pair = choose[way]((k < MANY - 1 ? k : SKIPPED) * 7 % (MANY - 1));
            list[k][0] = (uint32_t)(pair >> 32);
            list[k][1] = (uint32_t)pair;
        }
        const narc_pairs olds = view(list, MANY), news = view(list + SKIPPED + 1, MANY - SKIPPED - 1);
        for (unsigned threads = 1; threads <= 3; threads += 2) {
            match(broad, &olds, &news, threads, found);
            for (size_t k = 0; k < news.count - 1; k++)
                assert_int_equal(found[k], k + SKIPPED + 1);
            assert_int_equal(found[news.count - 1], SKIPPED);
        }
    }
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
    static halves falling[] = {{1, 1}, {0, 0}};
    static const uint32_t zero = 0;
    const narc_allocator allocator = {refuse_large, release, NULL};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = NULL;
    assert_int_equal(narc_create_broad_phase(&allocator, &broad), NARC_OK);
    const narc_pairs olds = {.count = ((size_t)1 << 30) + 1, .a = {&zero, 0}, .b = {&zero, 0}}, news = view(falling, 2);
    found[0] = 7;
    assert_int_equal(narc_match_pairs(broad, &olds, &news, NULL, found), NARC_ERROR_MEMORY);
    assert_int_equal(found[0], 7);
    match(broad, &news, &news, 0, found);
}

TEST_MAIN("match")
