/* SPDX-License-Identifier: MIT
 *
 * manifolds.c - the list of manifolds that rows write.
 */
#include "manifolds.h"

#include <stdlib.h>

#include "common.h"

static void grow(narc_manifolds *list, size_t count) {
    free(list->pair), free(list->point_count), free(list->normal_x), free(list->normal_y);
    list->capacity = count;
    list->pair = allocate(count, sizeof *list->pair);
    list->point_count = allocate(count, sizeof *list->point_count);
    list->normal_x = allocate(count, sizeof *list->normal_x);
    list->normal_y = allocate(count, sizeof *list->normal_y);
    for (int point = 0; point < 2; point++) {
        free(list->separation[point]), free(list->point_x[point]), free(list->point_y[point]);
        free(list->feature[point]), free(list->radius_a[point]), free(list->radius_b[point]);
        list->separation[point] = allocate(count, sizeof *list->separation[point]);
        list->point_x[point] = allocate(count, sizeof *list->point_x[point]);
        list->point_y[point] = allocate(count, sizeof *list->point_y[point]);
        list->feature[point] = allocate(count, sizeof *list->feature[point]);
        list->radius_a[point] = allocate(count, sizeof *list->radius_a[point]);
        list->radius_b[point] = allocate(count, sizeof *list->radius_b[point]);
    }
}

const narc_manifolds *share_manifolds(size_t count) {
    static narc_manifolds list;
    if (count > list.capacity)
        grow(&list, count);
    return &list;
}

float deepest_separation(const narc_manifolds *manifolds, size_t k) {
    const float first = manifolds->separation[0][k], second = manifolds->separation[1][k];
    return manifolds->point_count[k] == 2 && second < first ? second : first;
}
