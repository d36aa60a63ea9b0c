/* SPDX-License-Identifier: MIT
 *
 * index.c - the tree of an index: which boxes its slots hold, after building and after fitting; memory and errors.
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

static narc_box slot_box(const narc_index_node *node, size_t slot) {
    return (narc_box){node->min_x[slot], node->min_y[slot], node->max_x[slot], node->max_y[slot]};
}

/* The union of boxes, and of masks, of what is below a slot. */
struct holding {
    narc_box box;
    uint64_t mask;
};

static void hold(struct holding *all, const narc_box *box, uint64_t mask) {
    if (is_empty(box))
        return;
    all->box.min_x = fminf(all->box.min_x, box->min_x);
    all->box.min_y = fminf(all->box.min_y, box->min_y);
    all->box.max_x = fmaxf(all->box.max_x, box->max_x);
    all->box.max_y = fmaxf(all->box.max_y, box->max_y);
    all->mask |= mask;
}

/* Checks a node and all below it, and counts how often each body stands in a leaf. */
static struct holding check_node(const narc_index *index, unsigned level, size_t k, const narc_box *boxes,
                                 const uint64_t *category, unsigned char *seen) {
    const size_t at = index->first_node[level] + k;
    struct holding all = {{INFINITY, INFINITY, -INFINITY, -INFINITY}, 0};
    for (size_t slot = 0; slot < NARC_NODE_SLOTS; slot++) {
        const size_t below = NARC_NODE_SLOTS * k + slot;
        struct holding held = {{INFINITY, INFINITY, -INFINITY, -INFINITY}, 0};
        if (level > 0 && below < index->node_count[level - 1]) {
            held = check_node(index, level - 1, below, boxes, category, seen);
        } else if (level == 0 && index->body[below] != UINT32_MAX) {
            const uint32_t body = index->body[below];
            assert_true(body < index->count);
            seen[body]++;
            hold(&held, &boxes[body], category ? category[body] : 0);
        }
        const narc_box box = slot_box(&index->nodes[at], slot);
        assert_memory_equal(&box, &held.box, sizeof box);
        if (index->masks)
            assert_true((index->masks[NARC_NODE_SLOTS * at + slot] & held.mask) == held.mask);
        hold(&all, &held.box, held.mask);
    }
    return all;
}

static void check_index(const narc_index *index, const narc_box *boxes, size_t count, const uint64_t *category) {
    unsigned char *const seen = calloc(count + 1, 1);
    assert_int_equal(index->count, count);
    if (count > 0) {
        assert_int_equal(index->masks != NULL, category != NULL);
        assert_int_equal(index->node_count[index->level_count - 1], 1);
        assert_int_equal((uintptr_t)index->nodes % 64, 0);
        check_node(index, index->level_count - 1, 0, boxes, category, seen);
    }
    for (size_t k = 0; k < count; k++)
        assert_int_equal(seen[k], 1);
    free(seen);
}

static const size_t counts[] = {0, 1, 2, 7, 8, 9, 63, 64, 65, 511, 512, 513, 3000, 30000};
enum { COUNTS = sizeof counts / sizeof counts[0] };

TEST(holds_every_box_once) {
    struct test_random random = test_random_named("boxes of an index");
    narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (uint32_t trial = 0; trial < 4 * COUNTS; trial++) {
        const size_t count = counts[trial / 4];
        narc_box *const boxes = malloc((count + 1) * sizeof *boxes);
        uint64_t *const category = malloc((count + 1) * sizeof *category);
        for (size_t k = 0; k < count; k++) {
            boxes[k] = random_box(&random, 100, 0, 3);
            category[k] = (uint64_t)1 << random_below(&random, 64);
            if (random_below(&random, 20) == 0)
                boxes[k].max_y = NAN;
        }
        const bool masks = trial & 2;
        const narc_index_options options = {.category = {masks ? category : NULL, sizeof *category}, .fast = trial & 1};
        narc_box *guarded = guard_copy(boxes, count * sizeof *boxes);
        assert_int_equal(narc_build_index(index, guarded, count, &options, NULL), NARC_OK);
        guard_release(guarded);
        check_index(index, boxes, count, masks ? category : NULL);
        for (size_t k = 0; k < count; k++) {
            boxes[k] = random_box(&random, 100, 0, 3);
            category[k] = (uint64_t)1 << random_below(&random, 64);
        }
        const narc_index_options other = {.category = {masks ? NULL : category, sizeof *category}};
        float slack = -1;
        guarded = guard_copy(boxes, count * sizeof *boxes);
        assert_int_equal(narc_refit_index(index, guarded, count, &other, &slack, NULL), NARC_OK);
        guard_release(guarded);
        check_index(index, boxes, count, masks ? NULL : category);
        assert_true(slack > (count > 20 ? 0.5f : 0) || count < 2);
        free(boxes);
        free(category);
    }
    narc_destroy_index(index);
}

/* ------------------------------------------------------------------------------------------------ what all agree on */

static narc_index *create_index(const narc_allocator *allocator) {
    narc_index *index = NULL;
    assert_int_equal(narc_create_index(allocator, &index), NARC_OK);
    return index;
}

static void expect_same_index(const narc_index *one, const narc_index *other) {
    const size_t nodes = narc_count_nodes(one);
    assert_int_equal(narc_count_nodes(other), nodes);
    assert_memory_equal(one->nodes, other->nodes, nodes * sizeof *one->nodes);
    assert_memory_equal(one->order, other->order, nodes);
    assert_memory_equal(one->body, other->body, one->node_count[0] * NARC_NODE_SLOTS * sizeof *one->body);
    assert_memory_equal(&one->perimeter, &other->perimeter, sizeof one->perimeter);
    assert_int_equal(one->masks != NULL, other->masks != NULL);
    if (one->masks)
        assert_memory_equal(one->masks, other->masks, nodes * NARC_NODE_SLOTS * sizeof *one->masks);
}

static void fill_boxes(struct test_random *random, narc_box *boxes, size_t count) {
    for (size_t k = 0; k < count; k++)
        boxes[k] = make_box(random, BOXES_MIXED, k, count);
}

TEST(is_the_same_for_all_workers_and_instruction_sets) {
    enum { COUNT = 40000 };
    struct test_random random = test_random_named("workers of an index");
    narc_box *const boxes = malloc(COUNT * sizeof *boxes), *const moved = malloc(COUNT * sizeof *moved);
    uint64_t *const category = malloc(COUNT * sizeof *category);
    narc_index *const expected = create_index(NULL), *const index = create_index(NULL);
    fill_boxes(&random, boxes, COUNT);
    fill_boxes(&random, moved, COUNT);
    for (size_t k = 0; k < COUNT; k++)
        category[k] = random_bits(&random);
    for (uint32_t trial = 0; trial < 4; trial++)
        for (unsigned workers = 1; workers <= 17; workers += workers < 3 ? 1 : 7) {
            const size_t count = COUNT - 17 * trial;
            narc_workers some;
            narc_openmp_workers(workers, &some);
            narc_index_options options = {.category = {trial & 2 ? category : NULL, 8}, .fast = trial & 1};
            float slack, expected_slack;
            test_use_isa("scalar");
            assert_int_equal(narc_build_index(expected, boxes, count, &options, NULL), NARC_OK);
            test_use_isa(test_isa());
            options.workers = &some;
            assert_int_equal(narc_build_index(index, boxes, count, &options, NULL), NARC_OK);
            expect_same_index(expected, index);
            assert_int_equal(narc_refit_index(index, moved, count, &options, &slack, NULL), NARC_OK);
            test_use_isa("scalar");
            options.workers = NULL;
            assert_int_equal(narc_refit_index(expected, moved, count, &options, &expected_slack, NULL), NARC_OK);
            test_use_isa(test_isa());
            expect_same_index(expected, index);
            assert_memory_equal(&slack, &expected_slack, sizeof slack);
        }
    narc_destroy_index(expected);
    narc_destroy_index(index);
    free(boxes);
    free(moved);
    free(category);
}

/* ------------------------------------------------------------------------------------------------ what it is worth */

/* Of the slots with a bit and of those without, where all boxes are full. */
static void check_order(const narc_index_node *node, unsigned order) {
    for (unsigned b = 0; b < 3; b++) {
        double x = 0, y = 0, size = 0;
        for (unsigned k = 0; k < NARC_NODE_SLOTS; k++) {
            const double sign = k >> b & 1 ? 1 : -1;
            x += sign * ((double)node->min_x[k] + (double)node->max_x[k]);
            y += sign * ((double)node->min_y[k] + (double)node->max_y[k]);
            size += fabs((double)node->max_x[k]) + fabs((double)node->max_y[k]);
        }
        const bool along_y = order & NARC_ORDER_ALONG_Y(b), downward = order & NARC_ORDER_DOWNWARD(b);
        if (fabs(fabs(x) - fabs(y)) < 1e-5 * size)
            continue;
        assert_int_equal(along_y, fabs(y) > fabs(x));
        assert_int_equal(downward, (along_y ? y : x) < 0);
    }
}

/* Flips of a direction's quadrant bring the slots that it meets first to the front. */
TEST(knows_how_halves_lie) {
    enum { COUNT = 4096 };
    struct test_random random = test_random_named("order of an index");
    narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    narc_index *const index = create_index(NULL);
    for (uint32_t fast = 0; fast < 2; fast++) {
        for (size_t k = 0; k < COUNT; k++)
            boxes[k] = random_box(&random, 100, 0, 1);
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = fast}, NULL), NARC_OK);
        for (size_t k = 0; k < narc_count_nodes(index); k++)
            check_order(&index->nodes[k], index->order[k]);
    }
    assert_int_equal(narc_find_flips(0, false, true), 0);
    assert_int_equal(narc_find_flips(0, true, false), 7);
    assert_int_equal(narc_find_flips(NARC_ORDER_ALONG_Y(1) | NARC_ORDER_DOWNWARD(2), false, true), 6);
    narc_destroy_index(index);
    free(boxes);
}

/* A square lattice: the nodes of a good tree are nearly squares. Half of their perimeters together, per box: leaves of
 * eight are 2 by 4, or 3 by 3 where halves are not full, and all levels above add less than as much again. */
TEST(has_tight_nodes) {
    enum { SIDE = 64, COUNT = SIDE * SIDE };
    narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    narc_index *const index = create_index(NULL);
    float slack = 0;
    for (size_t k = 0; k < COUNT; k++) {
        const float x = (float)(k * 37 % COUNT % SIDE), y = (float)(k * 37 % COUNT / SIDE);
        boxes[k] = (narc_box){x, y, x + 1, y + 1};
    }
    for (uint32_t fast = 0; fast < 2; fast++) {
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = fast}, NULL), NARC_OK);
        const double leaves = COUNT / 8.0 * 6, above = COUNT / 64.0 * 16 + COUNT / 512.0 * 48 + 128;
        assert_true(index->perimeter <= (leaves + above) * 1.001);
        assert_true(index->perimeter >= COUNT / 8.0 * 2 * sqrt(8)); /* of leaves that were squares, alone */
    }
    assert_int_equal(narc_refit_index(index, boxes, COUNT, NULL, &slack, NULL), NARC_OK);
    assert_true(slack == 1);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = (narc_box){boxes[k].min_x * 2, boxes[k].min_y * 2, boxes[k].max_x * 2, boxes[k].max_y * 2};
    assert_int_equal(narc_refit_index(index, boxes, COUNT, NULL, &slack, NULL), NARC_OK);
    assert_true(slack == 2);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = (narc_box){1, 1, 1, 1};
    assert_int_equal(narc_build_index(index, boxes, COUNT, NULL, NULL), NARC_OK);
    assert_int_equal(narc_refit_index(index, boxes, COUNT, NULL, &slack, NULL), NARC_OK);
    assert_true(slack == 1);
    boxes[7].max_x = 2;
    assert_int_equal(narc_refit_index(index, boxes, COUNT, NULL, &slack, NULL), NARC_OK);
    assert_true(isinf(slack));
    narc_destroy_index(index);
    free(boxes);
}

/* Boxes in a row, far from the origin, stand in leaves in the order of the row. */
TEST(keeps_a_row_in_order) {
    enum { COUNT = 32768, OFFSET = 2 * COUNT };
    narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    narc_index *const index = create_index(NULL);
    for (uint32_t way = 0; way < 4; way++) {
        for (size_t k = 0; k < COUNT; k++) {
            const float place = (float)(k * 4097 % COUNT + OFFSET), x = way & 2 ? 0 : place, y = way & 2 ? place : 0;
            boxes[k] = (narc_box){x, y, x, y};
        }
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = way & 1}, NULL), NARC_OK);
        for (size_t k = 0; k < COUNT; k++)
            assert_int_equal((size_t)index->body[k] * 4097 % COUNT, k);
    }
    narc_destroy_index(index);
    free(boxes);
}

/* What was built before it has no part in how slack an index of no boxes is. */
TEST(has_no_slack_when_emptied) {
    const narc_box boxes[2] = {{0, 0, 1, 1}, {2, 2, 3, 3}};
    narc_index *const index = create_index(NULL);
    float slack = -1;
    assert_int_equal(narc_build_index(index, boxes, 2, NULL, NULL), NARC_OK);
    assert_int_equal(narc_build_index(index, NULL, 0, NULL, NULL), NARC_OK);
    assert_int_equal(narc_refit_index(index, NULL, 0, NULL, &slack, NULL), NARC_OK);
    assert_true(slack == 1);
    narc_destroy_index(index);
}

/* ------------------------------------------------------------------------------------------------ memory and errors */

TEST(survives_failing_allocations) {
    static const size_t steps[] = {10, 10, 1000, 900, 5000};
    struct test_random random = test_random_named("memory of an index");
    struct ledger ledger = {.limited = true};
    const narc_allocator allocator = ledger_allocator(&ledger);
    narc_box *const boxes = malloc(5000 * sizeof *boxes);
    uint64_t *const category = malloc(5000 * sizeof *category);
    narc_index *index = NULL, *const same = create_index(NULL);
    narc_error error;
    size_t failures = 0;
    assert_int_equal(narc_create_index(&allocator, &index), NARC_ERROR_MEMORY);
    assert_null(index);
    ledger.left = 1;
    assert_int_equal(narc_create_index(&allocator, &index), NARC_OK);
    assert_int_equal(narc_build_index(index, NULL, 0, NULL, NULL), NARC_OK);
    assert_int_equal(narc_build_index(same, NULL, 0, NULL, NULL), NARC_OK);
    for (size_t step = 0; step < 5; step++) {
        const narc_index_options options = {.category = {step == 1 || step == 4 ? category : NULL, 8}};
        narc_status status;
        fill_boxes(&random, boxes, 5000);
        memset(category, (int)step, 5000 * sizeof *category);
        for (ledger.left = 0;; failures++) { /* one more each time */
            const size_t left = ledger.left;
            status = narc_build_index(index, boxes, steps[step], &options, &error);
            if (status == NARC_OK)
                break;
            expect_error(status, NARC_ERROR_MEMORY, &error, "no memory");
            expect_same_index(same, index);
            ledger.left = left + 1;
        }
        ledger.left = 0;
        assert_int_equal(narc_build_index(same, boxes, steps[step], &options, NULL), NARC_OK);
        expect_same_index(same, index);
        const narc_index_options other = {.category = {category, 8}};
        const size_t fitted = index->mask_capacity;
        status = narc_refit_index(index, boxes, steps[step], &other, NULL, &error);
        if (fitted < steps[step])
            expect_error(status, NARC_ERROR_MEMORY, &error, "no memory for the masks");
        else
            assert_int_equal(status, NARC_OK);
        if (status != NARC_OK)
            expect_same_index(same, index);
        else
            assert_int_equal(narc_build_index(index, boxes, steps[step], &options, NULL), NARC_OK);
    }
    assert_true(failures >= 7);
    const size_t allocations = ledger.allocations;
    for (uint32_t k = 0; k < 5; k++)
        assert_int_equal(narc_build_index(index, boxes, 5000 - k, &(narc_index_options){.fast = k & 1}, NULL), NARC_OK);
    assert_int_equal(ledger.allocations, allocations);
    narc_destroy_index(index);
    narc_destroy_index(same);
    narc_destroy_index(NULL);
    assert_int_equal(ledger.live, 0);
    free(boxes);
    free(category);
}

TEST_MAIN("index")
