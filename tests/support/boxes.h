/* SPDX-License-Identifier: MIT
 *
 * boxes.h - boxes and pairs of them by definition: what a broad phase and an index are compared with.
 */
#ifndef NARC_TEST_BOXES_H
#define NARC_TEST_BOXES_H

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "narc.h"
#include "support.h"

static inline bool is_empty(const narc_box *box) {
    const bool finite = isfinite(box->min_x) && isfinite(box->min_y) && isfinite(box->max_x) && isfinite(box->max_y);
    return !finite || box->min_x > box->max_x || box->min_y > box->max_y;
}

static inline bool overlap(const narc_box *a, const narc_box *b) {
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y && b->min_y <= a->max_y &&
           !is_empty(a) && !is_empty(b);
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

/* Scenes that a broad phase or an index may go wrong on. */
enum box_kind {
    BOXES_SPREAD,  /* each beside some others */
    BOXES_CROWD,   /* each over many others */
    BOXES_EQUAL,   /* all the same */
    BOXES_ROW,     /* none over another */
    BOXES_COLUMN,  /* points above one another */
    BOXES_EVEN,    /* along x, in an order of chance */
    BOXES_BROKEN,  /* a third with a NaN or an infinity, some with their sides exchanged */
    BOXES_SIZES,   /* 1 : 100,000 */
    BOXES_HUGE,    /* a third is as large as floats are */
    BOXES_LATTICE, /* in small integers: borders that touch, no width or height */
    BOXES_EXTREME, /* places and sizes from the least floats to the largest ones */
    BOXES_POWERS,  /* along x over many powers of two, both ways */
    BOXES_CROWDS,  /* two crowds far apart, one box further away */
    BOXES_SPECKS,  /* too near each other for the inverse of a distance */
    BOXES_FLOOR,   /* one is below all others */
    BOX_KINDS,
    BOXES_MIXED = BOX_KINDS /* of all kinds */
};

/* Box k of so many. */
static inline narc_box make_box(struct test_random *random, enum box_kind kind, size_t k, size_t count) {
    static const float places[] = {0,     -0.0f, 1,      -1,      1e-40f,   -1e-40f, 1e9f,
                                   -1e9f, 1e30f, -1e30f, FLT_MAX, -FLT_MAX, 1e-20f};
    static const float sizes[] = {0, 1e-45f, 1e-38f, 1e-9f, 1, 100, 1e9f, 1e30f, FLT_MAX};
    const double side = sqrt((double)count) * 2, part = random_unit(random);
    const float at = 2 * (float)k, up = (float)part, along = (float)(part * (double)count);
    narc_box box = random_box(random, side, 0, 2);
    float x, y;
    switch (kind) {
    case BOXES_SPREAD:
        return random_below(random, 100) ? box : far_box(random);
    case BOXES_CROWD:
        return random_box(random, 3, 0, 2);
    case BOXES_EQUAL:
        return (narc_box){1, 1, 2, 2};
    case BOXES_ROW:
        return (narc_box){at, 1, at + 1, 2};
    case BOXES_COLUMN:
        return (narc_box){1, at, 1, at};
    case BOXES_EVEN:
        return (narc_box){along, up, along + 0.5f, up + 1};
    case BOXES_BROKEN:
        if (random_below(random, 3) == 0)
            (&box.min_x)[random_below(random, 4)] = random_below(random, 2)   ? NAN
                                                    : random_below(random, 2) ? INFINITY
                                                                              : -INFINITY;
        else if (random_below(random, 3) == 0)
            *(random_below(random, 2) ? &box.max_x : &box.max_y) -= 4;
        return box;
    case BOXES_SIZES:
        return random_box(random, side, 0, random_log_between(random, 1e-3, 1e2));
    case BOXES_HUGE:
        return random_below(random, 3) ? box : (narc_box){-FLT_MAX, at, random_below(random, 2) ? FLT_MAX : 1, FLT_MAX};
    case BOXES_LATTICE:
        x = (float)random_below(random, 30);
        y = (float)random_below(random, 30) - 15;
        return (narc_box){x, y, x + (float)random_below(random, 4), y + (float)random_below(random, 9)};
    case BOXES_EXTREME:
        x = places[random_below(random, 13)];
        y = places[random_below(random, 13)];
        return (narc_box){x, y, x + sizes[random_below(random, 9)], y + sizes[random_below(random, 9)]};
    case BOXES_POWERS:
        x = (float)random_log_between(random, 1e-30, 1e6) * (random_below(random, 2) ? 1 : -1);
        return (narc_box){x, up, x + 0.5f, up + 1};
    case BOXES_CROWDS:
        x = k == 0 ? -3e38f : k % 2 ? along + 1e20f : along;
        return (narc_box){x, up, x + 0.5f, up + 1};
    case BOXES_SPECKS:
        return (narc_box){1e-41f * up, up, 1e-41f, up + 1};
    case BOXES_FLOOR:
        return k == 0 ? (narc_box){-1, -1, (float)side + 2, (float)side + 2} : box;
    default:
        return make_box(random, (enum box_kind)random_below(random, BOX_KINDS), k, count);
    }
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
