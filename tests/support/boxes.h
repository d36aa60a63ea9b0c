/* SPDX-License-Identifier: MIT
 *
 * boxes.h - boxes and pairs of them by definition: what a broad phase and an index are compared with.
 */
#ifndef NARC_TEST_BOXES_H
#define NARC_TEST_BOXES_H

#include <math.h>
#include <stdlib.h>

#include "narc.h"
#include "support.h"

static inline bool is_empty(const narc_box *box) {
    const bool finite = isfinite(box->min_x) && isfinite(box->min_y) && isfinite(box->max_x) && isfinite(box->max_y);
    return !finite || box->min_x > box->max_x || box->min_y > box->max_y;
}

static inline bool overlap(const narc_box *a, const narc_box *b) {
    return !is_empty(a) && !is_empty(b) && a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y &&
           b->min_y <= a->max_y;
}

/* In a square from the origin. */
static inline narc_box random_box(struct test_random *random, double side, double least, double most) {
    const double x = random_between(random, 0, side), y = random_between(random, 0, side);
    const double width = random_between(random, least, most), height = random_between(random, least, most);
    return (narc_box){(float)x, (float)y, (float)(x + width), (float)(y + height)};
}

/* Around what has flown away. */
static inline narc_box far_box(struct test_random *random) {
    static const float away[] = {1e20f, 1e24f, 1e30f, 1e38f, 0, -1e20f, -1e24f, -1e30f, -1e38f};
    const float x = away[random_below(random, 9)], y = away[random_below(random, 9)];
    return (narc_box){x, y, x + 1, y + 1};
}

/* A list of pairs that grows. */
struct pair_list {
    uint32_t *a, *b;
    size_t count, capacity;
};

static inline void list_pair(struct pair_list *list, size_t a, size_t b) {
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 1024;
        list->a = realloc(list->a, list->capacity * sizeof *list->a);
        list->b = realloc(list->b, list->capacity * sizeof *list->b);
    }
    list->a[list->count] = (uint32_t)a;
    list->b[list->count++] = (uint32_t)b;
}

static inline void free_list(struct pair_list *list) {
    free(list->a);
    free(list->b);
}

#endif
