/* SPDX-License-Identifier: MIT
 *
 * manifolds.c - the list of manifolds that rows write.
 */
#include "manifolds.h"

#include <stdlib.h>

#include "common.h"

narc_manifold *share_manifolds(size_t count) {
    static narc_manifold *list;
    static size_t room;
    if (count > room) {
        free(list);
        list = allocate(count, sizeof *list);
        room = count;
    }
    return list;
}

float deepest_separation(const narc_manifold *manifold) {
    const float first = manifold->point[0].separation, second = manifold->point[1].separation;
    return manifold->count == 2 && second < first ? second : first;
}
