/* SPDX-License-Identifier: MIT
 *
 * layouts.h - the same bodies and pairs in the layouts that callers have, each array with a guard page behind it.
 */
#ifndef NARC_TEST_LAYOUTS_H
#define NARC_TEST_LAYOUTS_H

#include "scene.h"

enum layout {
    LAYOUT_ARRAYS,     /* one packed array per property */
    LAYOUT_STRUCTURES, /* an engine's bodies, position first; pairs as structures */
    LAYOUT_REVERSED,   /* the same the other way round, so that positions too end where the guard begins */
    LAYOUT_BACKWARDS,  /* packed arrays from the last item to the first, with strides below 0 */
    LAYOUT_SHARED,     /* angle, scale and shape are one value for all, with a stride of 0; needs suit_layout() */
    LAYOUT_UNSCALED,   /* no scales; needs suit_layout() */
    LAYOUT_COUNT
};

/* The columns of a scene's bodies and its pairs first .. first + count - 1, and the arrays behind them. */
struct columns {
    narc_bodies bodies;
    narc_pairs pairs;
    void *memory[24]; /* a caller's, too */
    size_t memory_count;
};

struct columns create_columns(const struct scene *scene, enum layout layout, size_t first, size_t count);
void destroy_columns(struct columns *columns);

/* Makes a scene fit for a layout: for LAYOUT_SHARED every body like the first, but for its position, for LAYOUT_UNSCALED
 * all of a scale of 1. */
void suit_layout(struct scene *scene, enum layout layout);

/* A copy of a scene's store in guarded memory, no larger than needed. */
narc_shapes *guard_store(const struct scene *scene);

#endif
