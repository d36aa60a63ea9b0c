/* SPDX-License-Identifier: MIT
 *
 * manifold_lists.h - lists of manifolds: made, filled, compared.
 */
#ifndef NARC_TEST_MANIFOLD_LISTS_H
#define NARC_TEST_MANIFOLD_LISTS_H

#include "scene.h"

struct manifolds {
    narc_manifolds view;
    size_t count;
};

/* The arrays of a list, in the order of its members, and the bytes of an item of each. */
enum { MANIFOLD_ARRAYS = 16 };
extern const size_t manifold_item[MANIFOLD_ARRAYS];
void *manifold_array(const narc_manifolds *list, size_t array);

/* Room for `capacity` manifolds, full of junk; with `guarded`, exactly as much, and a forbidden page behind. */
struct manifolds create_manifolds(size_t capacity, bool guarded);
void destroy_manifolds(struct manifolds *list, bool guarded);

/* The manifolds of all pairs of a scene, in one thread; any error fails the test. */
struct manifolds scene_manifolds(const struct scene *scene, float margin);

/* Fails unless items `first` ... of `all` are the items of `part`, in every bit. `moved`: by how much the numbers of
 * the pairs in `part` are less. */
void check_same_manifolds(const struct manifolds *all, size_t first, const struct manifolds *part, size_t moved);

#endif
