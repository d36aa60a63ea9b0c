/* SPDX-License-Identifier: MIT
 *
 * index.c - the tree of an index: which boxes its slots hold, after building and after updates; memory and errors.
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

/* The union of boxes, and of masks, of what is below a slot. */
struct holding {
    narc_box box;
    uint64_t mask;
    uint32_t count;
    narc_world_range worlds;
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
                                 const uint64_t *category, const uint32_t *world, unsigned char *seen) {
    const size_t at = index->first_node[level] + k;
    struct holding all = {{INFINITY, INFINITY, -INFINITY, -INFINITY}, 0, 0, {INT32_MAX, INT32_MIN}};
    for (size_t slot = 0; slot < NARC_NODE_SLOTS; slot++) {
        const size_t below = NARC_NODE_SLOTS * k + slot;
        struct holding held = {{INFINITY, INFINITY, -INFINITY, -INFINITY}, 0, 0, {INT32_MAX, INT32_MIN}};
        if (level > 0 && below < index->node_count[level - 1]) {
            held = check_node(index, level - 1, below, boxes, category, world, seen);
        } else if (level == 0 && index->body[below] != UINT32_MAX) {
            const uint32_t body = index->body[below];
            assert_true(body < index->count);
            assert_int_equal(index->place[body], below);
            seen[body]++;
            all.count++;
            hold(&held, &boxes[body], category ? category[body] : 0);
            held.worlds.lowest = held.worlds.highest = narc_order_world(world ? world[body] : 0);
        }
        const narc_box box = narc_get_node_box(&index->nodes[at], slot);
        assert_true(box.min_x == held.box.min_x && box.min_y == held.box.min_y);
        assert_true(box.max_x == held.box.max_x && box.max_y == held.box.max_y);
        if (index->masks)
            assert_true((index->masks[NARC_NODE_SLOTS * at + slot] & held.mask) == held.mask);
        if (index->worlds)
            assert_true(index->worlds[at].lowest[slot] == held.worlds.lowest &&
                        index->worlds[at].highest[slot] == held.worlds.highest);
        if (held.worlds.lowest < all.worlds.lowest)
            all.worlds.lowest = held.worlds.lowest;
        if (held.worlds.highest > all.worlds.highest)
            all.worlds.highest = held.worlds.highest;
        hold(&all, &held.box, held.mask);
        all.count += held.count;
    }
    assert_int_equal(index->filled[at], all.count);
    assert_int_equal(index->touched[at], 0);
    return all;
}

static void check_index(const narc_index *index, const narc_box *boxes, size_t count, const uint64_t *category,
                        const uint32_t *world) {
    AUTO(free_at) unsigned char *const seen = calloc(count + 1, 1);
    assert_int_equal(index->count, count);
    if (count > 0) {
        assert_int_equal(index->masks != NULL, category != NULL);
        assert_int_equal(index->node_count[index->level_count - 1], 1);
        assert_int_equal((uintptr_t)index->nodes % 64, 0);
        assert_int_equal(index->worlds != NULL, world != NULL);
        check_node(index, index->level_count - 1, 0, boxes, category, world, seen);
    }
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(seen[k], !is_empty(&boxes[k]));
        assert_int_equal(index->place[k] == NARC_NO_PLACE, is_empty(&boxes[k]));
    }
}

static const size_t counts[] = {0, 1, 2, 7, 8, 9, 63, 64, 65, 511, 512, 513, 3000, 30000};
enum { COUNTS = sizeof counts / sizeof counts[0] };

TEST(holds_every_box_once) {
    struct test_random random = test_random_named("boxes of an index");
    AUTO(narc_destroy_index_at) narc_index *index;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    for (uint32_t trial = 0; trial < 4 * COUNTS; trial++) {
        const size_t count = counts[trial / 4];
        AUTO(free_at) narc_box *const boxes = malloc((count + 1) * sizeof *boxes);
        AUTO(free_at) uint64_t *const category = malloc((count + 1) * sizeof *category);
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
        check_index(index, boxes, count, masks ? category : NULL, NULL);
        for (size_t k = 0; k < count; k++) {
            boxes[k] = random_box(&random, 100, 0, 3);
            category[k] = (uint64_t)1 << random_below(&random, 64);
        }
        const narc_index_options other = {.category = {masks ? NULL : category, sizeof *category}};
        guarded = guard_copy(boxes, count * sizeof *boxes);
        assert_int_equal(narc_update_index(index, guarded, count, NULL, 0, &other, NULL), NARC_OK);
        guard_release(guarded);
        check_index(index, boxes, count, masks ? NULL : category, NULL);
    }
}

/* ------------------------------------------------------------------------------------------------ histories */

enum { MOST = 3000 };

/* A scene that lives, and what has changed in it since the index heard of it. */
struct history {
    narc_box boxes[MOST];
    uint64_t category[MOST];
    uint32_t world[MOST], changed[2 * MOST];
    size_t count, changed_count;
};

static narc_box move_box(struct test_random *random, const narc_box *box) {
    const float x = (float)random_between(random, -0.3, 0.3), y = (float)random_between(random, -0.3, 0.3);
    switch (random_below(random, 16)) {
    case 0:
        return make_box(random, BOXES_MIXED, random_below(random, MOST), MOST);
    case 1:
        return (narc_box){NAN, 0, 1, 1};
    case 2:
        return (narc_box){2, 2, 1, 1};
    case 3:
        return (narc_box){1e24f, -1e24f, 1e24f, -1e24f};
    case 4:
    case 5:
    case 6:
        return random_box(random, 100, 0, 3);
    default:
        return (narc_box){box->min_x + x, box->min_y + y, box->max_x + x, box->max_y + y};
    }
}

/* Some move, come and go, get another category or world; all of them are listed, some twice, some that are as they were. */
static void live(struct test_random *random, struct history *h, bool quiet) {
    h->changed_count = 0;
    if (random_below(random, 8) == 0) { /* others come, or the last ones go */
        const size_t count = random_below(random, quiet ? 40 : MOST + 1);
        for (size_t k = h->count; k < count; k++)
            h->boxes[k] = random_box(random, 100, 0, 3);
        h->count = count;
    }
    const size_t changes = h->count > 0 ? random_below(random, random_below(random, 3) ? 20 : h->count + 1) : 0;
    for (size_t i = 0; i < changes; i++) {
        const size_t k = random_below(random, h->count);
        if (random_below(random, 10))
            h->boxes[k] = quiet ? random_box(random, 100, 0, 3) : move_box(random, &h->boxes[k]);
        if (random_below(random, 10) == 0)
            h->category[k] = random_bits(random);
        if (random_below(random, 10) == 0)
            h->world[k] = (uint32_t)random_below(random, 9) * (uint32_t)(k % 3 ? 1 : 0x10000000);
        h->changed[h->changed_count++] = (uint32_t)k;
        if (random_below(random, 10) == 0)
            h->changed[h->changed_count++] = (uint32_t)random_below(random, h->count);
    }
}

/* After each update the index holds what it would if it were new. */
TEST(lives_as_its_boxes_do) {
    struct test_random random = test_random_named("histories of an index");
    AUTO(free_at) struct history *const h = calloc(1, sizeof *h);
    for (uint32_t trial = 0; trial < 8; trial++) {
        AUTO(narc_destroy_index_at) narc_index *index = NULL;
        assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
        h->count = 0;
        for (uint32_t step = 0; step < 150; step++) {
            const bool worlds = trial & 2;
            const bool lists = random_below(&random, 10) > 0, masks = trial & 1 ? true : random_below(&random, 20) == 0;
            const narc_index_options options = {.category = {masks ? h->category : NULL, 8},
                                                .fast = trial >> 1 & 1,
                                                .world = {worlds ? h->world : NULL, sizeof *h->world}};
            live(&random, h, trial & 4);
            narc_box *const boxes = guard_copy(h->boxes, h->count * sizeof *h->boxes);
            AUTO(guard_release_at)
            uint32_t *const changed = guard_copy(h->changed, h->changed_count * sizeof *h->changed);
            const narc_index_column column = {changed, sizeof *changed};
            assert_int_equal(narc_update_index(index, boxes, h->count, lists ? &column : NULL,
                                               lists ? h->changed_count : 0, &options, NULL),
                             NARC_OK);
            guard_release(boxes);
            check_index(index, h->boxes, h->count, masks ? h->category : NULL, worlds ? h->world : NULL);
        }
    }
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
    if (nodes == 0)
        return;
    assert_memory_equal(one->body, other->body, one->node_count[0] * NARC_NODE_SLOTS * sizeof *one->body);
    assert_memory_equal(one->home, other->home, one->node_count[0] * sizeof *one->home);
    assert_memory_equal(one->changes, other->changes, nodes * sizeof *one->changes);
    assert_memory_equal(&one->perimeter, &other->perimeter, sizeof one->perimeter);
    assert_int_equal(one->masks != NULL, other->masks != NULL);
    assert_int_equal(one->worlds != NULL, other->worlds != NULL);
    if (one->worlds)
        assert_memory_equal(one->worlds, other->worlds, nodes * sizeof *one->worlds);
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
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes), *const moved = malloc(COUNT * sizeof *moved);
    AUTO(free_at) uint64_t *const category = malloc(COUNT * sizeof *category);
    AUTO(free_at) uint32_t *const changed = malloc(COUNT * sizeof *changed);
    AUTO(free_at) uint32_t *const world = malloc(COUNT * sizeof *world);
    AUTO(narc_destroy_index_at) narc_index *const expected = create_index(NULL), *const index = create_index(NULL);
    fill_boxes(&random, boxes, COUNT);
    fill_boxes(&random, moved, COUNT);
    for (size_t k = 0; k < COUNT; k++)
        category[k] = random_bits(&random);
    for (size_t k = 0; k < COUNT; k++)
        world[k] = (uint32_t)random_below(&random, 300);
    for (uint32_t trial = 0; trial < 4; trial++)
        for (unsigned workers = 1; workers <= 17; workers += workers < 3 ? 2 : 14) {
            const size_t count = COUNT - 17 * trial;
            const narc_workers some = openmp_workers(workers);
            narc_index_options options = {.category = {trial & 2 ? category : NULL, 8},
                                          .fast = trial & 1,
                                          .world = {trial & 2 ? world : NULL, 4}};
            test_use_isa("scalar");
            assert_int_equal(narc_build_index(expected, boxes, count, &options, NULL), NARC_OK);
            test_use_isa(test_isa());
            options.workers = &some;
            assert_int_equal(narc_build_index(index, boxes, count, &options, NULL), NARC_OK);
            expect_same_index(expected, index);
            for (size_t changes = 100; changes <= COUNT; changes *= 400) {
                const narc_index_column column = NARC_ARRAY(changed), *const list = changes < COUNT ? &column : NULL;
                const size_t listed = list ? changes : 0;
                for (size_t k = 0; k < listed; k++)
                    changed[k] = (uint32_t)(k * 7 % count);
                assert_int_equal(narc_update_index(index, moved, count, list, listed, &options, NULL), NARC_OK);
                test_use_isa("scalar");
                options.workers = NULL;
                assert_int_equal(narc_update_index(expected, moved, count, list, listed, &options, NULL), NARC_OK);
                options.workers = &some;
                test_use_isa(test_isa());
                expect_same_index(expected, index);
            }
        }
}

/* ------------------------------------------------------------------------------------------------ what it is worth */

/* Of the slots with a bit and of those without. A slot without anything lies where that is which has its highest bit less. */
static void check_order(const narc_index_node *node, unsigned order) {
    for (unsigned b = 0; b < 3; b++) {
        double x = 0, y = 0, size = 0;
        for (unsigned k = 0; k < NARC_NODE_SLOTS; k++) {
            const double sign = k >> b & 1 ? 1 : -1;
            unsigned at = k;
            for (unsigned bit = 4; bit && !(node->min_x[at] <= node->max_x[at]); bit /= 2)
                at &= ~bit;
            x += sign * ((double)node->min_x[at] + (double)node->max_x[at]);
            y += sign * ((double)node->min_y[at] + (double)node->max_y[at]);
            size += fabs((double)node->max_x[at]) + fabs((double)node->max_y[at]);
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
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    for (uint32_t fast = 0; fast < 2; fast++) {
        for (size_t k = 0; k < COUNT; k++)
            boxes[k] = random_box(&random, 100, 0, 1);
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = fast}, NULL), NARC_OK);
        for (size_t k = 0; k < narc_count_nodes(index); k++)
            if (index->nodes[k].min_x[0] <= index->nodes[k].max_x[0])
                check_order(&index->nodes[k], index->order[k]);
    }
    assert_int_equal(narc_find_flips(0, 0, 7), 0);
    assert_int_equal(narc_find_flips(0, 7, 7), 7);
    assert_int_equal(narc_find_flips(NARC_ORDER_ALONG_Y(1) | NARC_ORDER_DOWNWARD(2), 0, 7), 6);
}

static narc_index_statistics describe(const narc_index *index) {
    narc_index_statistics s;
    assert_int_equal(narc_describe_index(index, &s, NULL), NARC_OK);
    return s;
}

/* A square lattice: the nodes of a good tree are nearly squares. Half of their perimeters together, per box: fast built
 * leaves of eight are 2 by 4, others of six 2 by 3, or 3 by 3 where parts are not full, and all levels above add less than
 * as much again. */
TEST(has_tight_nodes) {
    enum { SIDE = 64, COUNT = SIDE * SIDE };
    static const double expected[] = {COUNT / 6.0 * 5 + COUNT / 48.0 * 14 + COUNT / 384.0 * 40 + 192 + 128,
                                      COUNT / 8.0 * 6 + COUNT / 64.0 * 16 + COUNT / 512.0 * 48 + 128};
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    const uint32_t seven = 7;
    for (size_t k = 0; k < COUNT; k++) {
        const float x = (float)(k * 37 % COUNT % SIDE), y = (float)(k * 37 % COUNT / SIDE);
        boxes[k] = (narc_box){x, y, x + 1, y + 1};
    }
    for (uint32_t fast = 0; fast < 2; fast++) {
        const double squares = 2 * sqrt(fast ? 8 : 6) / (fast ? 8 : 6) * COUNT; /* leaves that were squares, alone */
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = fast}, NULL), NARC_OK);
        assert_true(index->perimeter <= expected[fast] * (fast ? 1.001 : 1.03) && index->perimeter >= squares);
        const narc_index_statistics s = describe(index);
        assert_true(s.slack == 1 && s.boxes == COUNT && s.bodies == COUNT && s.depth == (fast ? 4 : 5));
        assert_true(s.leaves == (fast ? 512 : 683) && s.nodes == narc_count_nodes(index));
        assert_true(s.mean_perimeter * (double)s.nodes > index->perimeter &&
                    s.bytes > s.nodes * sizeof(narc_index_node));
    }
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = (narc_box){1, 1, 1, 1};
    assert_int_equal(narc_build_index(index, boxes, COUNT, NULL, NULL), NARC_OK);
    assert_true(describe(index).slack == 1);
    boxes[7].max_x = 2;
    assert_int_equal(narc_update_index(index, boxes, COUNT, &(narc_index_column){&seven, 4}, 1, NULL, NULL), NARC_OK);
    assert_true(isinf(describe(index).slack));
}

/* The boxes of nodes are those of what is below them, level by level, after building and after updates. */
TEST(copies_boxes_of_nodes) {
    enum { ROOM = 600, STRIDE = 24 };
    struct test_random random = test_random_named("boxes of nodes");
    narc_box boxes[ROOM], below[ROOM];
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    size_t count, below_count = 0;
    assert_int_equal(narc_copy_nodes(index, 0, NULL, 0, 0, &count, NULL), NARC_OK);
    assert_int_equal(count, 0);
    for (unsigned round = 0; round < 8; round++) {
        const size_t bodies = round == 7 ? 3 : 1 + random_below(&random, ROOM);
        for (size_t k = 0; k < bodies; k++)
            boxes[k] = random_box(&random, 100, 0.1, 1);
        assert_int_equal(narc_update_index(index, boxes, bodies, NULL, 0, NULL, NULL), NARC_OK);
        const narc_index_statistics s = describe(index);
        size_t nodes = 0;
        for (size_t level = 0; level < s.depth; level++) {
            const size_t held = index->node_count[level], size = (held - 1) * STRIDE + sizeof *boxes;
            AUTO(guard_release_at) unsigned char *const out = guard_allocate(size);
            assert_int_equal(narc_copy_nodes(index, level, (narc_box *)(void *)out, STRIDE, held, &count, NULL),
                             NARC_OK);
            nodes += count;
            assert_int_equal(count, held);
            for (size_t k = 0; k < count; k++) {
                struct holding all = {{INFINITY, INFINITY, -INFINITY, -INFINITY}, 0, 0, {0, 0}};
                narc_box box;
                memcpy(&box, out + k * STRIDE, sizeof box);
                for (size_t i = 8 * k; i < 8 * k + 8; i++)
                    if (level == 0 ? index->body[i] != UINT32_MAX : i < below_count)
                        hold(&all, level == 0 ? &boxes[index->body[i]] : &below[i], 0);
                assert_memory_equal(&box, &all.box, sizeof box);
                assert_true(k + 1 == count ||
                            (out[k * STRIDE + sizeof box] == GUARD_JUNK && out[(k + 1) * STRIDE - 1] == GUARD_JUNK));
            }
            size_t again = 0;
            assert_int_equal(narc_copy_nodes(index, level, below, 0, count - 1, &again, NULL), NARC_ERROR_CAPACITY);
            assert_int_equal(again, count);
            assert_int_equal(narc_copy_nodes(index, level, below, 0, ROOM, &below_count, NULL), NARC_OK);
        }
        assert_true(nodes == s.nodes && narc_copy_nodes(index, s.depth, NULL, 0, 0, &count, NULL) == NARC_OK &&
                    count == 0);
    }
}

/* Bodies that go anywhere, one after the other, until each has gone a hundred times: then nodes are hardly larger than
 * those of a new tree. So they are where all creep. */
TEST(stays_tight) {
    enum { SIDE = 50, COUNT = SIDE * SIDE, STEPS = 2500, LISTED = 100 };
    struct test_random random = test_random_named("wear of an index");
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL), *const new = create_index(NULL);
    uint32_t changed[LISTED];
    const narc_index_column list = NARC_ARRAY(changed);
    for (uint32_t creeps = 0; creeps < 2; creeps++) {
        for (size_t k = 0; k < COUNT; k++)
            boxes[k] = random_box(&random, SIDE, 1, 1);
        assert_int_equal(narc_build_index(index, boxes, COUNT, NULL, NULL), NARC_OK);
        for (size_t step = 0; step < STEPS; step++) {
            for (size_t i = 0; i < LISTED; i++) {
                narc_box *const box = &boxes[changed[i] = (uint32_t)random_below(&random, COUNT)];
                const float x = (float)random_between(&random, -0.2, 0.2),
                            y = (float)random_between(&random, -0.2, 0.2);
                *box = creeps ? (narc_box){box->min_x + x, box->min_y + y, box->max_x + x, box->max_y + y}
                              : random_box(&random, SIDE, 1, 1);
            }
            assert_int_equal(narc_update_index(index, boxes, COUNT, &list, LISTED, NULL, NULL), NARC_OK);
        }
        assert_int_equal(narc_build_index(new, boxes, COUNT, NULL, NULL), NARC_OK);
        const narc_index_statistics worn = describe(index), fresh = describe(new);
        assert_true(worn.mean_perimeter * (double)worn.nodes <= 1.15 * fresh.mean_perimeter * (double)fresh.nodes);
        check_index(index, boxes, COUNT, NULL, NULL);
    }
}

/* Of many worlds that lie over each other, who asks for one goes through few nodes: those with slots that have it. */
TEST(keeps_worlds_apart) {
    enum { WORLDS = 512, EACH = 32, COUNT = WORLDS * EACH };
    struct test_random random = test_random_named("worlds of an index");
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(free_at) uint32_t *const world = malloc(COUNT * sizeof *world), *const all = malloc(COUNT * sizeof *all);
    const narc_index_column changed = NARC_ARRAY(all);
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    for (size_t k = 0; k < COUNT; k++) {
        all[k] = (uint32_t)k;
        boxes[k] = random_box(&random, 6, 1, 1);
        world[k] = (uint32_t)random_below(&random, WORLDS);
    }
    for (uint32_t way = 0; way < 3; way++) {
        const narc_index_options options = {.fast = way == 1, .world = NARC_ARRAY(world)};
        size_t slots = 0;
        if (way < 2)
            assert_int_equal(narc_build_index(index, boxes, COUNT, &options, NULL), NARC_OK);
        for (size_t first = 0; way == 2 && first < COUNT; first += EACH) { /* all move, some at a time */
            for (size_t k = first; k < first + EACH; k++) {
                boxes[k] = random_box(&random, 6, 1, 1);
                world[k] = (uint32_t)random_below(&random, WORLDS);
            }
            const narc_index_column some = {all + first, sizeof *all};
            assert_int_equal(narc_update_index(index, boxes, COUNT, &some, EACH, &options, NULL), NARC_OK);
        }
        for (size_t k = 0; k < narc_count_nodes(index) * NARC_NODE_SLOTS; k++) {
            const narc_world_range own = narc_get_worlds(&index->worlds[k / NARC_NODE_SLOTS], k % NARC_NODE_SLOTS);
            if (own.lowest <= own.highest)
                slots += (size_t)(own.highest - own.lowest) + 1;
        }
        assert_true(slots <= 2 * COUNT); /* a world's own bodies, and as many above */
    }
    assert_int_equal(narc_update_index(index, boxes, COUNT, &changed, COUNT, NULL, NULL), NARC_OK);
    assert_null(index->worlds);
}

/* Boxes in a row, far from the origin, stand in leaves in the order of the row. */
TEST(keeps_a_row_in_order) {
    enum { COUNT = 32768, OFFSET = 2 * COUNT };
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    for (uint32_t way = 0; way < 4; way++) {
        for (size_t k = 0; k < COUNT; k++) {
            const float place = (float)(k * 4097 % COUNT + OFFSET), x = way & 2 ? 0 : place, y = way & 2 ? place : 0;
            boxes[k] = (narc_box){x, y, x, y};
        }
        assert_int_equal(narc_build_index(index, boxes, COUNT, &(narc_index_options){.fast = way & 1}, NULL), NARC_OK);
        size_t next = 0;
        for (size_t k = 0; k < index->slots; k++)
            if (index->body[k] != UINT32_MAX)
                assert_int_equal((size_t)index->body[k] * 4097 % COUNT, next++);
        assert_int_equal(next, COUNT);
    }
}

/* What was built before it has no part in how slack an index of no boxes is. */
TEST(has_no_slack_when_emptied) {
    const narc_box boxes[2] = {{0, 0, 1, 1}, {2, 2, 3, 3}};
    AUTO(narc_destroy_index_at) narc_index *const index = create_index(NULL);
    assert_int_equal(narc_build_index(index, boxes, 2, NULL, NULL), NARC_OK);
    assert_int_equal(narc_update_index(index, NULL, 0, NULL, 0, NULL, NULL), NARC_OK);
    const narc_index_statistics s = describe(index);
    assert_true(s.slack == 1 && s.boxes == 0 && s.bodies == 0 && s.nodes == 0 && s.depth == 0 && s.mean_perimeter == 0);
}

/* ------------------------------------------------------------------------------------------------ memory and errors */

TEST(survives_failing_allocations) {
    static const size_t steps[] = {10, 10, 1000, 900, 5000};
    struct test_random random = test_random_named("memory of an index");
    struct ledger ledger = {.limited = true};
    const narc_allocator allocator = ledger_allocator(&ledger);
    AUTO(free_at) narc_box *const boxes = malloc(5000 * sizeof *boxes);
    AUTO(free_at) uint64_t *const category = malloc(5000 * sizeof *category);
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
        const bool fits = index->mask_capacity >= steps[step];
        status = narc_update_index(index, boxes, steps[step], NULL, 0, &other, &error);
        assert_int_equal(status, fits ? NARC_OK : NARC_ERROR_MEMORY);
        if (fits)
            assert_int_equal(narc_build_index(index, boxes, steps[step], &options, NULL), NARC_OK);
        expect_same_index(same, index);
        status = narc_update_index(index, boxes, 5000, NULL, 0, &options, &error);
        if (steps[step] < 3000)
            expect_error(status, NARC_ERROR_MEMORY, &error, "no memory");
        expect_same_index(same, index);
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
}

TEST_MAIN("index")
