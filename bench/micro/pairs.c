/* SPDX-License-Identifier: MIT
 *
 * pairs.c - bodies and pairs for the shapes of a workload.
 */
#include "pairs.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "random.h"

enum { PARTNERS = 4, PAIRS_PER_BODY = 10 };

/* A broad phase keeps its boxes a little larger, so that they serve for some frames. With this much between two boxes,
 * half of a packing's pairs collide. */
static const double box_margin = 0.4;

/* In FAMILY_GENERAL first bodies have the shapes of even, second ones those of odd index. */
static size_t random_shape(const struct workload *workload, uint64_t *random, size_t second) {
    const size_t shape = random_below(random, workload->shape_count);
    return workload->key.family == FAMILY_GENERAL ? (shape & ~(size_t)1) + second : shape;
}

/* Puts B anywhere where the boxes of both overlap, with `colliding` as wanted. */
static void place_in_boxes(const struct workload *workload, const struct body *a, struct body *b, bool colliding,
                           uint64_t *random) {
    for (int trial = 0; trial < 1000; trial++) { /* two upright rectangles can't be apart there */
        struct vector normal;
        put_in_boxes(workload->shapes, a, b, random);
        if ((exact_gap(workload->outlines, a, b, &normal) < 0) == colliding)
            return;
    }
}

/* Puts each second body at `factor` times the distance at which it touches the first, in a random direction. */
static void place_at_distance(const narc_shapes *shapes, struct body *bodies, const struct direction *directions,
                              size_t count, double factor) {
    double *distances = allocate(count, sizeof *distances);
    for (size_t k = 0; k < count; k++) {
        const narc_aabb a = box_of(shapes, &bodies[2 * k]), b = box_of(shapes, &bodies[2 * k + 1]);
        distances[k] = hypot(a.max_x - a.min_x, a.max_y - a.min_y) + hypot(b.max_x - b.min_x, b.max_y - b.min_y);
    }
    find_touching(shapes, bodies, directions, count, distances);
    for (size_t k = 0; k < count; k++)
        put_second(&bodies[2 * k], directions[k], factor * distances[k]);
    free(distances);
}

void make_pairs(struct workload *workload) {
    uint64_t random = 1000 + workload->key.edges;
    const enum scene scene = workload->key.scene;
    const size_t pair_count = workload->key.pair_count, first_count = (pair_count + PARTNERS - 1) / PARTNERS;
    workload->pair_count = pair_count;
    workload->body_count = first_count + pair_count;
    workload->pairs = allocate(pair_count, sizeof *workload->pairs);
    workload->bodies = allocate(workload->body_count, sizeof *workload->bodies);
    /* Second bodies are in no particular order: pairs sorted by the first body jump among them. */
    uint32_t *place = allocate(pair_count, sizeof *place);
    for (size_t k = 0; k < pair_count; k++) {
        const size_t other = random_below(&random, k + 1);
        place[k] = place[other];
        place[other] = (uint32_t)(first_count + k);
    }
    for (size_t k = 0; k < first_count; k++)
        workload->bodies[k] = random_body(&random, random_shape(workload, &random, 0), HALF_SQUARE);
    struct body *both = allocate(2 * pair_count, sizeof *both); /* pair by pair */
    struct direction *directions = allocate(pair_count, sizeof *directions);
    for (size_t k = 0; k < pair_count; k++) {
        both[2 * k] = workload->bodies[k / PARTNERS];
        both[2 * k + 1] = random_body(&random, random_shape(workload, &random, 1), 0);
        if (scene == SCENE_MIXED)
            place_in_boxes(workload, &both[2 * k], &both[2 * k + 1], random_unit(&random) < 0.5, &random);
        else
            directions[k] = random_direction(&random);
    }
    if (scene != SCENE_MIXED)
        place_at_distance(workload->shapes, both, directions, pair_count, scene == SCENE_DISJOINT ? 1.05 : 0.7);
    for (size_t k = 0; k < pair_count; k++) {
        workload->bodies[place[k]] = both[2 * k + 1];
        workload->pairs[k] = (struct pair){(uint32_t)(k / PARTNERS), place[k]};
    }
    free(directions);
    free(both);
    free(place);
}

/* ------------------------------------------------------------------------------------------------ packing */

static bool overlap(const narc_aabb *a, const narc_aabb *b) {
    return a->min_x < b->max_x && b->min_x < a->max_x && a->min_y < b->max_y && b->min_y < a->max_y;
}

static narc_aabb world_box(const narc_shapes *shapes, const struct body *body) {
    const narc_aabb box = box_of(shapes, body);
    const double room = box_margin / 2;
    return (narc_aabb){body->x + box.min_x - room, body->y + box.min_y - room, body->x + box.max_x + room,
                       body->y + box.max_y + room};
}

struct by_left {
    narc_aabb box;
    uint32_t body;
};

static int compare_left(const void *left, const void *right) {
    const struct by_left *l = left, *r = right;
    return (l->box.min_x > r->box.min_x) - (l->box.min_x < r->box.min_x);
}

/* Sort and sweep; a pair behind the first `capacity` may replace an earlier one, so that all have the same chance. */
static size_t sweep(struct by_left *boxes, size_t count, struct pair *pairs, size_t capacity, uint64_t *random) {
    size_t found = 0;
    qsort(boxes, count, sizeof *boxes, compare_left);
    for (size_t k = 0; k < count; k++) {
        for (size_t next = k + 1; next < count && boxes[next].box.min_x < boxes[k].box.max_x; next++) {
            if (!overlap(&boxes[k].box, &boxes[next].box))
                continue;
            const uint32_t a = boxes[k].body, b = boxes[next].body;
            const size_t place = found < capacity ? found : random_below(random, found + 1);
            if (place < capacity)
                pairs[place] = a < b ? (struct pair){a, b} : (struct pair){b, a};
            found++;
        }
    }
    return found;
}

void make_packing(struct workload *workload) {
    uint64_t random = 2000 + workload->key.edges;
    const size_t pair_count = workload->key.pair_count, body_count = pair_count / PAIRS_PER_BODY + 1;
    struct by_left *boxes = allocate(body_count, sizeof *boxes);
    workload->pair_count = pair_count;
    workload->body_count = body_count;
    workload->pairs = allocate(pair_count, sizeof *workload->pairs);
    workload->bodies = allocate(body_count, sizeof *workload->bodies);
    /* Boxes some 2.5 wide with their margin; the square shrinks until there are enough pairs. */
    double half_width = 2.5 * sqrt((double)body_count / (2 * PAIRS_PER_BODY));
    size_t found = 0;
    for (; found < pair_count; half_width *= 0.98) {
        uint64_t bodies_random = 3000;
        for (size_t k = 0; k < body_count; k++) {
            workload->bodies[k] = random_body(&bodies_random, random_shape(workload, &bodies_random, 0), half_width);
            boxes[k] = (struct by_left){world_box(workload->shapes, &workload->bodies[k]), (uint32_t)k};
        }
        found = sweep(boxes, body_count, workload->pairs, pair_count, &random);
    }
    free(boxes);
}

/* Adds a pair of the bodies at two places of a stack, if there are such places: row y has `width` - y * shrink. */
static void add_neighbours(struct workload *workload, size_t width, size_t shrink, size_t a, size_t x, size_t y) {
    size_t first = 0;
    for (size_t k = 0; k < y; k++)
        first += width - k * shrink;
    if (y < width && x < width - y * shrink)
        workload->pairs[workload->pair_count++] = (struct pair){(uint32_t)a, (uint32_t)(first + x)};
}

void make_stack(struct workload *workload) {
    const size_t shrink = workload->key.scene == SCENE_PYRAMID, most = workload->key.pair_count;
    const size_t width = (size_t)sqrt((double)most / (shrink ? 1.5 : 4));
    const double step = shrink ? 1.05 : 1, height = shrink ? 0.9995 : 1;
    workload->pairs = allocate(4 * width * width, sizeof *workload->pairs);
    workload->bodies = allocate(width * width, sizeof *workload->bodies);
    workload->body_count = workload->pair_count = 0;
    for (size_t y = 0; y < width; y++) {
        for (size_t x = 0; x < width - y * shrink; x++) {
            const size_t body = workload->body_count++;
            workload->bodies[body] = (struct body){.x = (float)(step * ((double)x + 0.5 * (double)(y * shrink))),
                                                   .y = (float)(height * (double)y),
                                                   .cosine = 1,
                                                   .shape = (uint32_t)(body % workload->shape_count)};
            add_neighbours(workload, width, shrink, body, x + 1, y);
            add_neighbours(workload, width, shrink, body, x - 1, y + 1);
            add_neighbours(workload, width, shrink, body, x, y + 1);
            if (!shrink)
                add_neighbours(workload, width, shrink, body, x + 1, y + 1);
        }
    }
}
