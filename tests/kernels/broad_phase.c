/* SPDX-License-Identifier: MIT
 *
 * broad_phase.c - pairs of boxes against all pairs: sizes, places, filters, workers, memory, errors.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "broad_phase.h"
#include "expect.h"
#include "guard.h"
#include "ledger.h"

static uint32_t word(narc_index_column column, size_t k, uint32_t none) {
    const char *const base = (const char *)column.base;
    return base ? *(const uint32_t *)(const void *)(base + (ptrdiff_t)k * column.stride) : none;
}

static uint64_t long_word(narc_word_column column, size_t k) {
    const char *const base = (const char *)column.base;
    return base ? *(const uint64_t *)(const void *)(base + (ptrdiff_t)k * column.stride) : ~(uint64_t)0;
}

static bool lets(const narc_pair_filter *f, size_t a, size_t b) {
    if (!f)
        return true;
    const unsigned char *kind = f->kind.base;
    if (kind &&
        (kind[(ptrdiff_t)a * f->kind.stride] & kind[(ptrdiff_t)b * f->kind.stride] & (NARC_STATIC | NARC_SENSOR)) != 0)
        return false;
    if (word(f->owner, a, UINT32_MAX) != UINT32_MAX && word(f->owner, a, 0) == word(f->owner, b, 0))
        return false;
    if (word(f->world, a, 0) != word(f->world, b, 0))
        return false;
    return (long_word(f->category, a) & long_word(f->mask, b)) && (long_word(f->category, b) & long_word(f->mask, a));
}

/* Every pair, one after the other: in the order that is promised. */
static struct pair_list all_pairs(const narc_box *boxes, size_t count, const narc_pair_filter *filter) {
    struct pair_list list = {0};
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count; b++)
            if (overlap(&boxes[a], &boxes[b]) && lets(filter, a, b))
                list_pair(&list, a, b);
    return list;
}

static void check_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count, const narc_pair_filter *filter) {
    static const unsigned counts[] = {1, 2, 3, 7};
    struct pair_list expected = all_pairs(boxes, count, filter);
    AUTO(guard_release_at) narc_box *guarded = guard_copy(boxes, count * sizeof *boxes);
    for (size_t t = 0; t < sizeof counts / sizeof counts[0]; t++) {
        const narc_workers workers = openmp_workers(counts[t]);
        AUTO(guard_release_at) uint32_t *a = guard_allocate(expected.count * sizeof *a);
        AUTO(guard_release_at) uint32_t *b = guard_allocate(expected.count * sizeof *b);
        size_t found = 12345;
        narc_error error;
        assert_int_equal(
            narc_find_pairs(broad, guarded, count, filter, &workers, a, b, 0, expected.count, &found, &error), NARC_OK);
        assert_int_equal(found, expected.count);
        assert_memory_equal(a, expected.a, found * sizeof *a);
        assert_memory_equal(b, expected.b, found * sizeof *b);
    }
    free_list(&expected);
}

/* Anywhere around the origin, sizes of all orders. */
static narc_box spread_box(struct test_random *random, double side, double smallest, double largest) {
    const double x = random_between(random, -side, side), y = random_between(random, -side, side);
    const double w = random_log_between(random, smallest, largest), h = random_log_between(random, smallest, largest);
    return (narc_box){(float)(x - w), (float)(y - h), (float)(x + w), (float)(y + h)};
}

static narc_box *allocate_boxes(size_t count) {
    narc_box *boxes = malloc(count * sizeof *boxes);
    assert_non_null(boxes);
    return boxes;
}

static narc_box box_at(double x, double y, double width, double height) {
    return (narc_box){(float)x, (float)y, (float)(x + width), (float)(y + height)};
}

/* Boxes that all overlap. */
static void fill_one_place(narc_box *boxes, size_t count) {
    for (size_t k = 0; k < count; k++)
        boxes[k] = box_at(0, 0, 1, 1);
}

/* Fewer and more than the sort has buckets, the first without any memory. */
TEST(finds_all_pairs) {
    static const size_t counts[] = {0, 1, 2, 31, 32, 33, 150, 500, 2000, 17000};
    struct test_random random = test_random_named("boxes");
    for (size_t round = 0; round < test_trials(5); round++)
        for (enum box_kind kind = 0; kind <= BOXES_MIXED; kind++) {
            AUTO(narc_destroy_broad_phase_at) narc_broad_phase *const broad = create_broad_phase(NULL);
            const bool crowded = kind == BOXES_CROWD || kind == BOXES_EQUAL || kind == BOXES_SPECKS;
            for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
                if (counts[c] > 500 && (crowded || round > 0))
                    continue;
                if (counts[c] > 2000 && kind != BOXES_EVEN) /* they are checked one by one */
                    continue;
                AUTO(free_at) narc_box *const boxes = malloc((counts[c] + 1) * sizeof *boxes);
                for (size_t k = 0; k < counts[c]; k++)
                    boxes[k] = make_box(&random, kind, k, counts[c]);
                check_pairs(broad, boxes, counts[c], NULL);
            }
        }
}

TEST(filters_pairs) {
    struct test_random random = test_random_named("filters");
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    struct body {
        uint64_t category, mask;
        uint32_t owner, world;
        uint8_t kind;
    };
    for (size_t trial = 0; trial < test_trials(30); trial++) {
        narc_box boxes[200];
        struct body bodies[200];
        for (size_t k = 0; k < 200; k++) {
            boxes[k] = spread_box(&random, 10, 0.5, 2);
            bodies[k] = (struct body){(uint64_t)random_below(&random, 8) << 31,
                                      (uint64_t)random_below(&random, 8) << 31, (uint32_t)random_below(&random, 4) - 1,
                                      random_below(&random, 9) ? 2 * (uint32_t)random_below(&random, 3) : UINT32_MAX,
                                      (uint8_t)random_below(&random, 256)};
        }
        const narc_byte_column kind = NARC_COLUMN(bodies, kind);
        const narc_word_column category = NARC_COLUMN(bodies, category), mask = NARC_COLUMN(bodies, mask);
        const narc_index_column owner = NARC_COLUMN(bodies, owner), world = NARC_COLUMN(bodies, world);
        const narc_pair_filter filters[] = {
            {.kind = kind, .category = category, .mask = mask, .owner = owner, .world = world},
            {.world = world},
            {.kind = kind},
            {.category = category},
            {.mask = mask},
            {.owner = owner},
            {.kind = {0}}};
        for (size_t f = 0; f < sizeof filters / sizeof *filters; f++)
            check_pairs(broad, boxes, 200, &filters[f]);
    }
}

/* In many worlds, sparse ones among them, boxes of all sizes and places. */
TEST(keeps_worlds_apart) {
    static const uint32_t apart[] = {1, 1000, 0x01010101, UINT32_MAX / 40};
    enum { COUNT = 1500 };
    struct test_random random = test_random_named("worlds");
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(free_at) uint32_t *const world = malloc(COUNT * sizeof *world);
    for (enum box_kind kind = 0; kind <= BOXES_MIXED; kind++)
        for (size_t trial = 0; trial < 4; trial++) {
            for (size_t k = 0; k < COUNT; k++) {
                boxes[k] = make_box(&random, kind, k, COUNT);
                world[k] = (uint32_t)random_below(&random, 40) * apart[trial];
            }
            check_pairs(broad, boxes, COUNT, &(narc_pair_filter){.world = NARC_ARRAY(world)});
        }
}

/* ------------------------------------------------------------------------------------------------ growth */

/* Finds the pairs of boxes in memory that it frees. Checks that it takes no more steps than `for_box` for each box and
 * `for_pair` for each pair. */
static void check_steps(const char *name, narc_box *boxes, size_t count, double for_box, double for_pair) {
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    size_t found = 0;
    const narc_status status = narc_find_pairs(broad, boxes, count, NULL, NULL, NULL, NULL, 0, 0, &found, NULL);
    const double most = for_box * (double)count + for_pair * (double)found;
    assert_int_equal(status, found > 0 ? NARC_ERROR_CAPACITY : NARC_OK);
    printf("  %s: %.2f steps a box, %.2f pairs\n", name, (double)broad->steps / (double)count,
           (double)found / (double)count);
    if (!((double)broad->steps <= most))
        fail_msg("%s: %zu boxes with %zu pairs took %.0f steps", name, count, found, (double)broad->steps);
    free(boxes);
}

/* Scenes that a sweep could take the square of the boxes for. `turn`: width for height. */
TEST(grows_no_faster_than_boxes_and_pairs) {
    enum { COUNT = 20000, CROWD = 2000 };
    struct test_random random = test_random_named("growth");
    for (int turn = 0; turn < 2; turn++) {
        narc_box *const row = allocate_boxes(COUNT), *const walls = allocate_boxes(COUNT),
                        *const large = allocate_boxes(COUNT), *const lines = allocate_boxes(COUNT),
                        *const crosses = allocate_boxes(COUNT);
        for (size_t k = 0; k < COUNT; k++) {
            const double at = (double)k, half = (double)(k / 2);
            row[k] = box_at(2 * at, 0, 1, 1);
            /* Long walls, each between rows of 39 small bodies. */
            walls[k] = k % 40 == 0 ? box_at(0, half / 10, 1000, 0.5)
                                   : box_at(25 * (double)(k % 40), half / 10 + 0.7, 0.5, 0.5);
            /* A row of boxes that are as high as a column of small ones in its middle. */
            large[k] = k % 2 ? box_at(4 * half, 0, 1, 2 * COUNT) : box_at(COUNT + 0.25 + 1, 2 * half, 0.5, 1);
            /* Without height, above one another. */
            lines[k] = box_at(0, 1 + at / 65536, 1000, 0);
            /* Wide ones above one another, far from high ones beside one another. */
            crosses[k] = k % 2 ? box_at(4 * half, 0, 1, 1000) : box_at(-2000, 4 * half, 1000, 1);
        }
        narc_box *const scenes[] = {row, walls, large, lines, crosses};
        for (size_t s = 0; turn && s < 5; s++)
            for (size_t k = 0; k < COUNT; k++)
                scenes[s][k] =
                    (narc_box){scenes[s][k].min_y, scenes[s][k].min_x, scenes[s][k].max_y, scenes[s][k].max_x};
        check_steps(turn ? "column" : "row", row, COUNT, 2, 0);
        check_steps("walls", walls, COUNT, 20, 0);
        check_steps("large around small", large, COUNT, 40, 0);
        check_steps("lines", lines, COUNT, 2, 0);
        check_steps("crosses", crosses, COUNT, 4, 0);
        for (double ratio = 100; ratio <= 10000; ratio *= 100) {
            narc_box *const mixed = allocate_boxes(COUNT), *const slim = allocate_boxes(COUNT);
            for (size_t k = 0; k < COUNT; k++) {
                const double width = random_log_between(&random, 1, ratio),
                             height = random_log_between(&random, 1, ratio);
                const double x = random_unit(&random), y = random_unit(&random), side = 0.5 * sqrt(COUNT) * ratio;
                mixed[k] = k % 100 ? box_at(side * x, side * y, 1, 1) : box_at(side * x, side * y, ratio, ratio);
                slim[k] = turn ? box_at(side * x, side * y, height, 1) : box_at(side * x, side * y, width, height);
            }
            check_steps("few large ones", mixed, COUNT, 20, 4);
            check_steps("all sizes", slim, COUNT, 100, 20);
        }
        narc_box *const crowd = allocate_boxes(CROWD);
        fill_one_place(crowd, CROWD);
        check_steps("one place", crowd, CROWD, 2, 1);
    }
}

/* ------------------------------------------------------------------------------------------------ memory and errors */

TEST(allocates_nothing_once_it_has_grown) {
    struct test_random random = test_random_named("steady state");
    struct ledger ledger = {0};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(&ledger);
    const narc_workers workers = openmp_workers(2);
    enum { COUNT = 5000, CAPACITY = 100000 };
    AUTO(free_at) narc_box *boxes = malloc(COUNT * sizeof *boxes);
    AUTO(free_at) uint32_t *a = malloc(CAPACITY * sizeof *a), *b = malloc(CAPACITY * sizeof *b);
    size_t after_first = 0;
    for (int step = 0; step < 5; step++) {
        for (size_t k = 0; k < COUNT; k++)
            boxes[k] = spread_box(&random, 60, 0.5, 1);
        size_t found;
        assert_int_equal(narc_find_pairs(broad, boxes, COUNT, NULL, &workers, a, b, 0, CAPACITY, &found, NULL),
                         NARC_OK);
        assert_true(found > 1000);
        if (step == 0)
            after_first = ledger.allocations;
    }
    assert_int_equal(ledger.allocations, after_first);
}

/* Boxes in a row, none of which overlap: memory is for boxes and pairs, and not for questions without an answer. */
TEST(takes_memory_for_pairs_alone) {
    enum { COUNT = 4000 };
    struct ledger ledger = {0};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(&ledger);
    size_t found = 9;
    AUTO(free_at) narc_box *boxes = malloc(COUNT * sizeof *boxes);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = (narc_box){2 * (float)k, 0, 2 * (float)k + 1, 1};
    assert_int_equal(narc_find_pairs(broad, boxes, COUNT, NULL, NULL, NULL, NULL, 0, 0, &found, NULL), NARC_OK);
    assert_int_equal(found, 0);
    assert_true(ledger.most < (size_t)1 << 20); /* 128 bytes for a box, and a few blocks of 32 KB */
}

TEST(survives_failing_allocations) {
    narc_box boxes[300];
    uint32_t a[45000], b[45000];
    fill_one_place(boxes, 300);
    bool succeeded = false;
    for (size_t left = 0; !succeeded; left++) {
        struct ledger ledger = {.limited = true, .left = left};
        AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(&ledger);
        if (broad) {
            size_t found = 77;
            const narc_status status = narc_find_pairs(broad, boxes, 300, NULL, NULL, a, b, 0, 45000, &found, NULL);
            succeeded = status == NARC_OK;
            assert_true(succeeded || status == NARC_ERROR_MEMORY);
            assert_int_equal(found, succeeded ? 300 * 299 / 2 : 77);
        }
    }
}

/* Into an array of pairs, backwards, and from a list of the library's: what lies between is untouched. */
TEST(writes_pairs_with_gaps) {
    enum { COUNT = 60, MOST = COUNT * COUNT / 2 };
    narc_box boxes[COUNT];
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    fill_one_place(boxes, COUNT);
    uint32_t a[MOST], b[MOST], order[MOST];
    struct {
        uint32_t b, gap, a;
    } rows[MOST];
    size_t count = 0, found = 0;
    assert_int_equal(narc_find_pairs(broad, boxes, COUNT, NULL, NULL, a, b, sizeof *a, MOST, &count, NULL), NARC_OK);
    assert_int_equal(count, COUNT * (COUNT - 1) / 2);
    for (int way = 0; way < 4; way++) { /* found, copied; forwards, backwards */
        memset(rows, 0x55, sizeof rows);
        const ptrdiff_t size = sizeof *rows, stride = way % 2 ? -size : size;
        const size_t start = way % 2 ? count - 1 : 0;
        const narc_pairs listed = {.count = count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
        assert_int_equal(way < 2 ? narc_find_pairs(broad, boxes, COUNT, NULL, NULL, &rows[start].a, &rows[start].b,
                                                   stride, count, &found, NULL)
                                 : narc_copy_pairs(&listed, NULL, count, &rows[start].a, &rows[start].b, stride, NULL),
                         NARC_OK);
        assert_int_equal(found, count);
        for (size_t k = 0; k < count; k++) {
            const size_t row = way % 2 ? count - 1 - k : k;
            assert_true(rows[row].a == a[k] && rows[row].b == b[k] && rows[row].gap == 0x55555555);
        }
        assert_int_equal(rows[count].a, 0x55555555);
    }
    const narc_pairs listed = {.count = count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    for (size_t k = 0; k < count; k++)
        order[k] = (uint32_t)(count - 1 - k);
    uint32_t chosen[MOST] = {0}, other[MOST];
    assert_int_equal(narc_copy_pairs(&listed, order, count, chosen, other, 0, NULL), NARC_OK);
    for (size_t k = 0; k < count; k++)
        assert_true(chosen[k] == a[count - 1 - k] && other[k] == b[count - 1 - k]);
}

TEST(tells_how_much_room_is_needed) {
    narc_box boxes[100];
    uint32_t a[10] = {7}, b[10] = {7};
    size_t found = 0;
    narc_error error;
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    fill_one_place(boxes, 100);
    assert_int_equal(narc_find_pairs(broad, boxes, 100, NULL, NULL, a, b, 0, 10, &found, &error), NARC_ERROR_CAPACITY);
    assert_int_equal(found, 4950);
    assert_int_equal(a[0], 7);
    assert_int_equal(narc_find_pairs(broad, boxes, 100, NULL, NULL, NULL, NULL, 0, 0, &found, NULL),
                     NARC_ERROR_CAPACITY);
    assert_int_equal(found, 4950);
}

TEST_MAIN("broad_phase")
