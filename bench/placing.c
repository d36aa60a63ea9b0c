/* SPDX-License-Identifier: MIT
 *
 * placing.c - bodies and pairs: one by one, in stacks of squares.
 */
#include "scene.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "random.h"

enum { PARTNERS = 4 };

/* In FORM_GENERAL first bodies have the shapes of even, second ones those of odd index. */
static size_t random_shape(const struct scene *scene, uint64_t *random, size_t odd) {
    const size_t shape = random_below(random, scene->shape_count);
    return scene->family->form == FORM_GENERAL ? (shape & ~(size_t)1) + odd : shape;
}

/* Puts B anywhere where the boxes of both overlap, with `colliding` as wanted. */
static void put_in_overlap(const struct scene *scene, const struct body *a, struct body *b, bool colliding,
                           uint64_t *random) {
    for (int trial = 0; trial < 1000; trial++) { /* two upright rectangles can't be apart there */
        struct vector normal;
        put_in_boxes(scene->shapes, a, b, random);
        if ((exact_gap(scene->outlines, a, b, &normal) < 0) == colliding)
            return;
    }
}

/* One first body for 4 pairs, each with a second body of its own. */
void make_pairs(struct scene *scene) {
    uint64_t random = 1000 + scene->family->edges;
    const size_t pair_count = scaled(scene->kind->size), first_count = (pair_count + PARTNERS - 1) / PARTNERS;
    scene->pair_count = pair_count;
    scene->body_count = first_count + pair_count;
    scene->pairs = allocate(pair_count, sizeof *scene->pairs);
    scene->bodies = allocate(scene->body_count, sizeof *scene->bodies);
    /* Second bodies are in no particular order: pairs sorted by the first body jump among them. */
    uint32_t *second = allocate(pair_count, sizeof *second);
    for (size_t k = 0; k < pair_count; k++) {
        const size_t other = random_below(&random, k + 1);
        second[k] = second[other];
        second[other] = (uint32_t)(first_count + k);
    }
    for (size_t k = 0; k < first_count; k++)
        scene->bodies[k] = random_body(&random, random_shape(scene, &random, 0), HALF_SQUARE);
    struct body *both = allocate(2 * pair_count, sizeof *both); /* pair by pair */
    for (size_t k = 0; k < pair_count; k++) {
        both[2 * k] = scene->bodies[k / PARTNERS];
        both[2 * k + 1] = random_body(&random, random_shape(scene, &random, 1), 0);
        put_in_overlap(scene, &both[2 * k], &both[2 * k + 1], random_unit(&random) < 0.5, &random);
    }
    for (size_t k = 0; k < pair_count; k++) {
        scene->bodies[second[k]] = both[2 * k + 1];
        scene->pairs[k] = (struct pair){(uint32_t)(k / PARTNERS), second[k]};
    }
    free(both);
    free(second);
}

/* Adds a pair of the bodies at two positions of a stack, if there are such: row y has `width` - y * shrink. */
static void add_neighbours(struct scene *scene, size_t width, size_t shrink, size_t a, size_t x, size_t y) {
    size_t first = 0;
    for (size_t k = 0; k < y; k++)
        first += width - k * shrink;
    if (y < width && x < width - y * shrink)
        scene->pairs[scene->pair_count++] = (struct pair){(uint32_t)a, (uint32_t)(first + x)};
}

/* Squares in rows, each pair of neighbours. */
void make_stack(struct scene *scene) {
    const size_t shrink = scene->kind->layout == LAYOUT_PYRAMID, most = scaled(scene->kind->size);
    const size_t width = (size_t)sqrt((double)most / (shrink ? 1.5 : 4));
    const double step = shrink ? 1.05 : 1, height = shrink ? 0.9995 : 1;
    scene->pairs = allocate(4 * width * width, sizeof *scene->pairs);
    scene->bodies = allocate(width * width, sizeof *scene->bodies);
    scene->body_count = scene->pair_count = 0;
    for (size_t y = 0; y < width; y++) {
        for (size_t x = 0; x < width - y * shrink; x++) {
            const size_t body = scene->body_count++;
            scene->bodies[body] = (struct body){.x = (float)(step * ((double)x + 0.5 * (double)(y * shrink))),
                                                .y = (float)(height * (double)y),
                                                .cosine = 1,
                                                .shape = (uint32_t)(body % scene->shape_count)};
            add_neighbours(scene, width, shrink, body, x + 1, y);
            add_neighbours(scene, width, shrink, body, x - 1, y + 1);
            add_neighbours(scene, width, shrink, body, x, y + 1);
            if (!shrink)
                add_neighbours(scene, width, shrink, body, x + 1, y + 1);
        }
    }
}
