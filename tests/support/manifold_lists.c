/* SPDX-License-Identifier: MIT
 *
 * manifold_lists.c - lists of manifolds of the tests.
 */
#include "manifold_lists.h"

#include <stdlib.h>
#include <string.h>

#include "guard.h"

const size_t manifold_item[MANIFOLD_ARRAYS] = {4, 1, 4, 4, 4, 4, 4, 4, 4, 4, 2, 2, 4, 4, 4, 4};

void *manifold_array(const narc_manifolds *list, size_t array) {
    void *const arrays[MANIFOLD_ARRAYS] = {
        list->pair,          list->point_count,   list->normal_x,    list->normal_y,
        list->separation[0], list->separation[1], list->point_x[0],  list->point_x[1],
        list->point_y[0],    list->point_y[1],    list->feature[0],  list->feature[1],
        list->radius_a[0],   list->radius_a[1],   list->radius_b[0], list->radius_b[1]};
    return arrays[array];
}

static void *allocate(size_t size, bool guarded) {
    void *memory = guarded ? guard_allocate(size) : malloc(size + 1);
    assert_non_null(memory);
    memset(memory, GUARD_JUNK, size);
    return memory;
}

struct manifolds create_manifolds(size_t capacity, bool guarded) {
    struct manifolds list = {.view = {.capacity = capacity,
                                      .pair = allocate(capacity * sizeof(uint32_t), guarded),
                                      .point_count = allocate(capacity, guarded),
                                      .normal_x = allocate(capacity * sizeof(float), guarded),
                                      .normal_y = allocate(capacity * sizeof(float), guarded)}};
    for (size_t i = 0; i < 2; i++) {
        list.view.separation[i] = allocate(capacity * sizeof(float), guarded);
        list.view.point_x[i] = allocate(capacity * sizeof(float), guarded);
        list.view.point_y[i] = allocate(capacity * sizeof(float), guarded);
        list.view.feature[i] = allocate(capacity * sizeof(uint16_t), guarded);
        list.view.radius_a[i] = allocate(capacity * sizeof(float), guarded);
        list.view.radius_b[i] = allocate(capacity * sizeof(float), guarded);
    }
    return list;
}

void destroy_manifolds(struct manifolds *list, bool guarded) {
    for (size_t k = 0; k < MANIFOLD_ARRAYS; k++) {
        void *memory = manifold_array(&list->view, k);
        if (guarded)
            guard_release(memory);
        else
            free(memory);
    }
}

struct manifolds scene_manifolds(const struct scene *scene, float margin) {
    struct manifolds list = create_manifolds(scene->pair_count, false);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_manifold_options options = {.margin = margin};
    narc_error error;
    if (narc_find_manifolds(scene->store, &bodies, &pairs, &options, 1, &list.view, &list.count, &error) != NARC_OK)
        fail_msg("narc_find_manifolds: %s", error.message);
    return list;
}

void check_same_manifolds(const struct manifolds *all, size_t first, const struct manifolds *part, size_t moved) {
    assert_true(first + part->count <= all->count);
    for (size_t k = 0; k < part->count; k++)
        assert_int_equal(part->view.pair[k] + moved, all->view.pair[first + k]);
    for (size_t k = 1; k < MANIFOLD_ARRAYS && part->count > 0; k++) {
        const char *expected = (const char *)manifold_array(&all->view, k) + first * manifold_item[k];
        assert_memory_equal(manifold_array(&part->view, k), expected, part->count * manifold_item[k]);
    }
}
