/* SPDX-License-Identifier: MIT
 *
 * update.c - narc_update_index(): bodies that have moved, come or gone, and the nodes above them.
 *
 * A body that stays within its leaf's home gets its new box there. All others leave their slots and wait; then each goes
 * down the tree to the leaf whose box grows least, in its world, or to another one of the same node if that is full. Where
 * none has room, the bodies of the lowest node above that is not too full are spread over its slots anew, as a build does
 * it; and so they are where as many have come as a node holds. That bounds how far the tree is from a new one, and the work:
 * a body that goes to another leaf pays on each level for one that is spread. Last, the nodes above all leaves of which
 * something has changed are fitted.
 */
#include "column.h"
#include "compiler.h"
#include "dispatch.h"
#include "error.h"
#include "leaves.h"

#include <math.h>

typedef struct updating {
    narc_making making;
    narc_index *index;
    const narc_box *boxes;
    size_t waiting;
    bool all; /* may have changed: all nodes are fitted */
} updating;

/* ------------------------------------------------------------------------------------------------ leaves */

/* Marks a node of which something has changed, for all nodes above it: unless all are fitted anyway. */
static void touch(const updating *u, unsigned level, size_t node) {
    narc_index *const index = u->index;
    if (u->all)
        return;
    while (++level < index->level_count) {
        uint8_t *const touched = &index->touched[index->first_node[level] + node / NARC_NODE_SLOTS];
        const bool known = *touched != 0;
        *touched |= (uint8_t)(1u << node % NARC_NODE_SLOTS);
        if (known)
            return;
        node /= NARC_NODE_SLOTS;
    }
}

static void put_box(narc_index_node *node, size_t slot, const narc_box *box) {
    node->min_x[slot] = box->min_x;
    node->min_y[slot] = box->min_y;
    node->max_x[slot] = box->max_x;
    node->max_y[slot] = box->max_y;
}

static bool has_box(const narc_index_node *node, size_t slot, const narc_box *box) {
    return node->min_x[slot] == box->min_x && node->min_y[slot] == box->min_y && node->max_x[slot] == box->max_x &&
           node->max_y[slot] == box->max_y;
}

static uint64_t find_category(const updating *u, uint32_t body) {
    return narc_word_at(u->making.options->category, body);
}

/* Of a body, as one that a slot has. */
static narc_world_range find_world(const updating *u, uint32_t body) {
    const int32_t world = narc_order_world(narc_index_at(u->making.options->world, body));
    return (narc_world_range){world, world};
}

/* Puts a body into a slot of a leaf. */
static void put_body(updating *u, size_t place, uint32_t body) {
    narc_index *const index = u->index;
    put_box(&index->nodes[place / NARC_NODE_SLOTS], place % NARC_NODE_SLOTS, &u->boxes[body]);
    index->body[place] = body;
    index->place[body] = (uint32_t)place;
    if (index->masks)
        index->masks[place] = find_category(u, body);
    if (index->worlds)
        narc_put_worlds(&index->worlds[place / NARC_NODE_SLOTS], place % NARC_NODE_SLOTS, find_world(u, body));
    touch(u, 0, place / NARC_NODE_SLOTS);
}

static void take_out(updating *u, uint32_t body) {
    static const narc_box empty = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    narc_index *const index = u->index;
    const size_t place = index->place[body];
    size_t node = place / NARC_NODE_SLOTS;
    put_box(&index->nodes[node], place % NARC_NODE_SLOTS, &empty);
    index->body[place] = UINT32_MAX;
    index->place[body] = NARC_NO_PLACE;
    if (index->masks)
        index->masks[place] = 0;
    if (index->worlds)
        narc_put_worlds(&index->worlds[node], place % NARC_NODE_SLOTS, narc_no_worlds);
    touch(u, 0, node);
    for (unsigned level = 0; level < index->level_count; level++, node /= NARC_NODE_SLOTS)
        index->filled[index->first_node[level] + node]--;
}

static bool holds(const narc_box *outer, const narc_box *box) {
    return outer->min_x <= box->min_x && outer->min_y <= box->min_y && box->max_x <= outer->max_x &&
           box->max_y <= outer->max_y;
}

/* A body that may have changed, and its place. */
static inline void look_at(updating *u, uint32_t body, uint32_t place) {
    narc_index *const index = u->index;
    const narc_box *const box = &u->boxes[body];
    const size_t leaf = place / NARC_NODE_SLOTS, slot = place % NARC_NODE_SLOTS;
    if (place == NARC_WAITING_PLACE)
        return;
    const bool is_full = narc_is_full_box(box);
    if (place != NARC_NO_PLACE && is_full && holds(&index->home[leaf], box) &&
        (!index->worlds || index->worlds[leaf].lowest[slot] == find_world(u, body).lowest)) {
        const bool is_other = index->masks && index->masks[place] != find_category(u, body);
        if (is_other)
            index->masks[place] = find_category(u, body);
        else if (has_box(&index->nodes[leaf], slot, box))
            return;
        put_box(&index->nodes[leaf], slot, box);
        touch(u, 0, leaf);
        return;
    }
    if (place != NARC_NO_PLACE)
        take_out(u, body);
    if (is_full) {
        index->place[body] = NARC_WAITING_PLACE;
        index->waiting[u->waiting++] = body;
    }
}

/* ------------------------------------------------------------------------------------------------ to a leaf */

static inline float find_lower(float a, float b) { return a < b ? a : b; }

static inline float find_least(const float number[NARC_NODE_SLOTS]) {
    float least[NARC_NODE_SLOTS / 2];
    for (size_t k = 0; k < NARC_NODE_SLOTS / 2; k++)
        least[k] = find_lower(number[k], number[k + NARC_NODE_SLOTS / 2]);
    return find_lower(find_lower(least[0], least[1]), find_lower(least[2], least[3]));
}

/* Of some slots the one whose box grows least, of several the smallest one; quarters, so that all are finite. The first of them
 * if they are all empty. Which it is can't be foreseen: without a branch. */
static size_t choose_slot(const narc_index_node *node, const narc_box *given, unsigned slots) {
    const narc_box box = *given;
    float growth[NARC_NODE_SLOTS], size[NARC_NODE_SLOTS];
    for (size_t k = 0; k < NARC_NODE_SLOTS; k++) {
        const float low_x = node->min_x[k], low_y = node->min_y[k], high_x = node->max_x[k], high_y = node->max_y[k];
        const float min_x = find_lower(box.min_x, low_x), max_x = box.max_x > high_x ? box.max_x : high_x;
        const float min_y = find_lower(box.min_y, low_y), max_y = box.max_y > high_y ? box.max_y : high_y;
        const float old = (high_x * 0.25f - low_x * 0.25f) + (high_y * 0.25f - low_y * 0.25f);
        size[k] = (max_x * 0.25f - min_x * 0.25f) + (max_y * 0.25f - min_y * 0.25f);
        growth[k] = size[k] - old;
    }
    for (size_t k = 0; k < NARC_NODE_SLOTS && slots != UINT8_MAX; k++)
        growth[k] = slots >> k & 1 ? growth[k] : INFINITY;
    const float least = find_least(growth);
    for (size_t k = 0; k < NARC_NODE_SLOTS; k++)
        size[k] = growth[k] <= least ? size[k] : INFINITY;
    const float smallest = find_least(size);
    uint32_t chosen = 0;
    for (size_t k = 0; k < NARC_NODE_SLOTS; k++)
        chosen |= (uint32_t)(size[k] <= smallest) << k;
    return (size_t)FIND_LOWEST(least < INFINITY ? chosen : slots > 0 ? slots : 1);
}

static void grow(narc_box *box, const narc_box *by) {
    box->min_x = by->min_x < box->min_x ? by->min_x : box->min_x;
    box->min_y = by->min_y < box->min_y ? by->min_y : box->min_y;
    box->max_x = by->max_x > box->max_x ? by->max_x : box->max_x;
    box->max_y = by->max_y > box->max_y ? by->max_y : box->max_y;
}

/* Slots below a node. */
static size_t find_slots(const narc_index *index, unsigned level, size_t node, size_t *out_end) {
    const uint64_t size = (uint64_t)NARC_NODE_SLOTS << (3 * level), first = size * node;
    *out_end = (size_t)(first + size < index->slots ? first + size : index->slots);
    return (size_t)first;
}

/* Is a node so full that spreading its bodies leaves too little room? On higher levels there is more, so that a node that
 * was just spread does not come next. */
static bool is_too_full(const narc_index *index, unsigned level, size_t node) {
    size_t end;
    const size_t first = find_slots(index, level, node, &end);
    return index->filled[index->first_node[level] + node] > (uint64_t)(end - first) * (60 - level) / 64;
}

/* Spreads the bodies of a node, and one more if it is not UINT32_MAX. */
static void spread(updating *u, unsigned level, size_t node, uint32_t body) {
    narc_index *const index = u->index;
    uint32_t *const list = index->build_memory;
    size_t end, count = 0;
    for (size_t k = find_slots(index, level, node, &end); k < end; k++)
        if (index->body[k] != UINT32_MAX)
            list[count++] = index->body[k];
    if (body != UINT32_MAX)
        list[count++] = body;
    narc_spread_bodies(&u->making, level, node, count);
    touch(u, level, node);
}

/* So many bodies that came count one that did not find room in the leaf that it belongs to. */
enum { MISPLACED = 4 };

/* Of some of a node's slots those that are nearest to a world, such as those that have it. */
static unsigned find_nearest(const narc_node_worlds *worlds, int32_t world, unsigned slots) {
    unsigned nearest = 0;
    uint32_t least = UINT32_MAX;
    for (unsigned k = 0; k < NARC_NODE_SLOTS; k++) {
        const int32_t low = worlds->lowest[k], high = worlds->highest[k];
        const uint32_t below = world < low ? (uint32_t)low - (uint32_t)world : 0;
        const uint32_t distance = world > high ? (uint32_t)world - (uint32_t)high : below;
        if (!(slots >> k & 1) || low > high || distance > least)
            continue;
        nearest = (distance < least ? 0 : nearest) | 1u << k;
        least = distance;
    }
    return nearest;
}

/* The leaves below a node of level 1 that have room. */
static unsigned find_room(const narc_index *index, size_t node) {
    const size_t first = node * NARC_NODE_SLOTS;
    unsigned leaves = 0;
    for (size_t k = 0; k < NARC_NODE_SLOTS && first + k < index->node_count[0]; k++)
        leaves |= (unsigned)(index->filled[first + k] < NARC_NODE_SLOTS) << k;
    return leaves;
}

/* Puts a body into a leaf. False: there is no room. */
static bool insert(updating *u, uint32_t body) {
    narc_index *const index = u->index;
    const narc_box *const box = &u->boxes[body];
    unsigned level = index->level_count - 1, worn = 0, cost = 1;
    size_t node[NARC_INDEX_LEVELS] = {0};
    for (; level > 0; level--) {
        const size_t at = index->first_node[level] + node[level];
        narc_index_node *const boxes = &index->nodes[at];
        narc_node_worlds *const worlds = index->worlds ? &index->worlds[at] : NULL;
        size_t slot =
            choose_slot(boxes, box, worlds ? find_nearest(worlds, find_world(u, body).lowest, UINT8_MAX) : UINT8_MAX);
        if (level == 1 && index->filled[NARC_NODE_SLOTS * node[1] + slot] == NARC_NODE_SLOTS) {
            const unsigned leaves = find_room(index, node[1]);
            const unsigned near = worlds ? find_nearest(worlds, find_world(u, body).lowest, leaves) : leaves;
            slot = near ? choose_slot(boxes, box, near) : slot;
            cost = MISPLACED;
        }
        if (worlds)
            narc_put_worlds(worlds, slot, narc_join_worlds(narc_get_worlds(worlds, slot), find_world(u, body)));
        narc_box grown = narc_get_node_box(boxes, slot);
        grow(&grown, box);
        put_box(boxes, slot, &grown);
        node[level - 1] = NARC_NODE_SLOTS * node[level] + slot;
    }
    const bool is_full = index->filled[node[0]] == NARC_NODE_SLOTS;
    for (; level < index->level_count; level++) {
        const size_t at = index->first_node[level] + node[level];
        index->filled[at]++;
        index->changes[at] += level == 1 ? cost : 1;
        if (level > 0 && index->changes[at] > index->filled[at] + NARC_NODE_SLOTS)
            worn = level;
    }
    size_t place = node[0] * NARC_NODE_SLOTS;
    while (!is_full && index->body[place] != UINT32_MAX)
        place++;
    if (!is_full) {
        put_body(u, place, body);
        if (index->level_count > 1)
            grow(&index->home[node[0]], box);
    }
    if (is_full)
        for (worn = worn > 1 ? worn : 1; worn < index->level_count && is_too_full(index, worn, node[worn]);)
            worn++;
    if (worn > 0 && worn + 1 >= index->level_count)
        return false;
    if (worn > 0)
        spread(u, worn, node[worn], is_full ? body : UINT32_MAX);
    return true;
}

/* Fits a node to all below it that has changed. */
static void fit_touched(updating *u, unsigned level, size_t node) {
    narc_index *const index = u->index;
    uint8_t *const touched = &index->touched[index->first_node[level] + node];
    for (uint32_t bits = level > 1 ? *touched : 0, slot = 0; bits; bits >>= 1, slot++)
        if (bits & 1)
            fit_touched(u, level - 1, node * NARC_NODE_SLOTS + slot);
    *touched = 0;
    narc_fit_nodes(&u->making, level, node, node + 1);
}

/* Fits all nodes, a level after the other: cheaper than to look for them where most have changed. */
static void fit_all(updating *u) {
    narc_index *const index = u->index;
    for (unsigned level = 1; level < index->level_count; level++)
        narc_fit_nodes(&u->making, level, 0, index->node_count[level]);
}

/* ------------------------------------------------------------------------------------------------ the call */

/* All bodies, in the order of leaves; then those that are in none. */
static void look_at_all(updating *u) {
    narc_index *const index = u->index;
    for (size_t k = 0; k < index->slots; k++)
        if (index->body[k] != UINT32_MAX)
            look_at(u, index->body[k], (uint32_t)k);
    for (size_t k = 0; k < index->count; k++)
        if (index->place[k] == NARC_NO_PLACE)
            look_at(u, (uint32_t)k, NARC_NO_PLACE);
}

/* Puts all that waits into leaves. False if the tree is to be made anew. */
static bool insert_all(updating *u) {
    narc_index *const index = u->index;
    const size_t count = index->filled[narc_count_nodes(index) - 1] + u->waiting;
    if (u->waiting > count / 4 + NARC_NODE_SLOTS || count > index->slots ||
        narc_count_index_slots(2 * count, false) < index->slots)
        return false;
    for (size_t k = 0; k < u->waiting; k++)
        if (!insert(u, index->waiting[k]))
            return false;
    return true;
}

narc_status narc_update_index(narc_index *index, const narc_box *boxes, size_t count, const narc_index_column *changed,
                              size_t changed_count, const narc_index_options *options, narc_error *error) {
    static const narc_index_options defaults = {0};
    const narc_index_options *const o = options ? options : &defaults;
    narc_status status = narc_check_making(index, boxes, count, o, error);
    if (status != NARC_OK)
        return status;
    const narc_index_column list = changed ? *changed : (narc_index_column){NULL, 0};
    if (changed_count > 0 && !list.base)
        return narc_fail_missing(error, "changed");
    const size_t bad = narc_find_bad_index(list, 0, changed_count, count, NULL);
    if (bad < changed_count) {
        const unsigned long body = narc_index_at(list, bad);
        return narc_fail(error, NARC_ERROR_INDEX, bad, (double)body, "changed[%zu] is %lu, but there are %zu boxes",
                         bad, body, count);
    }
    if (index->level_count == 0 || count == 0 || !index->masks != !o->category.base ||
        !index->worlds != !o->world.base || !narc_has_index_room(index, count, o->category.base, o->world.base))
        return narc_build_index(index, boxes, count, o, error);
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    const narc_point origin = o->origin ? *o->origin : (narc_point){0, 0};
    const bool all = !changed || origin.x != index->origin.x || origin.y != index->origin.y;
    updating u = {{index, kernels, boxes, o}, index, boxes, 0, all};
    index->origin = origin;
    for (size_t k = index->count; k > count; k--)
        if (index->place[k - 1] != NARC_NO_PLACE)
            take_out(&u, (uint32_t)(k - 1));
    for (size_t k = index->count; k < count; k++)
        index->place[k] = NARC_NO_PLACE;
    const size_t old_count = index->count;
    index->count = count;
    if (all)
        look_at_all(&u);
    for (size_t k = 0; k < changed_count && !all; k++) {
        const uint32_t body = narc_index_at(list, k);
        look_at(&u, body, index->place[body]);
    }
    for (size_t k = old_count; k < count && !all; k++)
        look_at(&u, (uint32_t)k, index->place[k]);
    if (!insert_all(&u)) {
        narc_make_index(&u.making, false);
        return NARC_OK;
    }
    const unsigned top = index->level_count - 1;
    if (top > 0 && all)
        fit_all(&u);
    else if (top > 0 && index->touched[index->first_node[top]] != 0)
        fit_touched(&u, top, 0);
    narc_fit_root(&u.making);
    return NARC_OK;
}
