/* SPDX-License-Identifier: MIT
 *
 * scenes.c - stores of shapes; templates of one n, and the two scenes of the paper: pairs that never collide, pairs that
 * always do.
 *
 * Both bodies of a pair have random shapes and rotations; the second stands in a random direction from the first. How
 * far depends on the distance at which the two touch.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "paper.h"
#include "random.h"

/* A gap, or the room for one, that is less than this is too close to rounding to be counted on. */
static const double least_gap = 1e-3;

/* Colliding pairs: t - distance is from this part of t to all of it, equally likely on a logarithmic scale. */
static const double least_part = 1e-3;

enum { ROUNDS = 100 };

const char *const situation_names[SITUATIONS] = {"apart", "colliding"};

/* ------------------------------------------------------------------------------------------------ templates */

struct shapes make_store(size_t capacity) {
    struct shapes shapes = {.bounds = allocate(capacity, sizeof *shapes.bounds)};
    must(narc_create_shapes(NULL, &shapes.shapes), NULL);
    return shapes;
}

void add_arcs(struct shapes *shapes, const narc_arc *arcs, size_t count) {
    narc_circle circle = {0};
    narc_error error;
    must(narc_add_shape_at(shapes->shapes, (uint32_t)shapes->count, arcs, count, &error), &error);
    if (!narc_compute_bounding_circle(arcs, count, &circle))
        fail("a shape without a bounding circle");
    struct bound *bound = &shapes->bounds[shapes->count++];
    *bound = (struct bound){circle.x, circle.y, circle.radius, 0};
    for (size_t k = 0; k < count; k++)
        bound->extent = fmax(bound->extent, hypot(arcs[k].center_x, arcs[k].center_y) + arcs[k].radius);
}

void finish_store(struct shapes *shapes) {
    narc_error error;
    must(narc_create_methods(shapes->shapes, NULL, &shapes->methods, &error), &error);
}

struct templates make_templates(size_t n, size_t count, uint64_t *random) {
    struct templates templates = {n, {make_store(count), make_store(count)}};
    for (size_t k = 0; k < count; k++) {
        narc_arc arcs[NARC_MAX_ARCS], gon[NARC_MAX_ARCS];
        make_twins(random, n, arcs, gon);
        add_arcs(&templates.kinds[KIND_ARC], arcs, n);
        add_arcs(&templates.kinds[KIND_GON], gon, n);
    }
    finish_store(&templates.kinds[KIND_ARC]);
    finish_store(&templates.kinds[KIND_GON]);
    return templates;
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* Of a pair the direction from A to B, and for either kind the distance at which the two touch and
 * the one at which their bounding circles do. */
struct spacing {
    struct direction direction;
    double touch[KINDS], circles[KINDS];
};

/* With c the vector between the circles' centres when both bodies are at one position: |c + t d| = sum of the radii. */
static double circles_touch(const struct bound *bounds, const struct body *pair, struct direction d) {
    const struct bound *a = &bounds[pair[0].shape], *b = &bounds[pair[1].shape];
    const double x = (double)pair[1].cosine * b->x - (double)pair[1].sine * b->y - (double)pair[0].cosine * a->x +
                     (double)pair[0].sine * a->y;
    const double y = (double)pair[1].sine * b->x + (double)pair[1].cosine * b->y - (double)pair[0].sine * a->x -
                     (double)pair[0].cosine * a->y;
    const double along = x * d.x + y * d.y, across = x * d.y - y * d.x;
    const double sum = a->radius + b->radius;
    return sqrt(sum * sum - across * across) - along;
}

static void draw(const struct templates *templates, uint64_t *random, struct body *pair, struct spacing *spacing) {
    spacing->direction = random_direction(random);
    pair[0] = random_body(random, random_below(random, templates->kinds[0].count), HALF_SQUARE);
    pair[1] = random_body(random, random_below(random, templates->kinds[0].count), 0);
    for (enum kind kind = 0; kind < KINDS; kind++)
        spacing->circles[kind] = circles_touch(templates->kinds[kind].bounds, pair, spacing->direction);
}

/* The distances at which the pairs touch, as either kind. */
static void find_spacings(const struct templates *templates, struct body *bodies, struct spacing *spacings,
                          size_t count) {
    struct direction *directions = allocate(count, sizeof *directions);
    double *distances = allocate(count, sizeof *distances);
    for (enum kind kind = 0; kind < KINDS; kind++) {
        for (size_t k = 0; k < count; k++) {
            directions[k] = spacings[k].direction;
            distances[k] = spacings[k].circles[kind] * 1.001;
        }
        find_touching(templates->kinds[kind].shapes, bodies, directions, count, distances);
        for (size_t k = 0; k < count; k++)
            spacings[k].touch[kind] = distances[k];
    }
    free(directions);
    free(distances);
}

/* Pairs that are apart: anywhere, equally likely, between where they touch and where the circles of either kind come
 * apart. False where there is no room for it. */
static bool put_apart(struct body *pair, const struct spacing *spacing, uint64_t *random) {
    const double from = fmax(spacing->touch[KIND_ARC], spacing->touch[KIND_GON]) + least_gap;
    const double to = fmin(spacing->circles[KIND_ARC], spacing->circles[KIND_GON]);
    if (to < from + least_gap)
        return false;
    put_second(pair, spacing->direction, random_between(random, from, to));
    return true;
}

static bool put_colliding(struct body *pair, const struct spacing *spacing, uint64_t *random) {
    const double touch = fmin(spacing->touch[KIND_ARC], spacing->touch[KIND_GON]);
    put_second(pair, spacing->direction, touch * (1 - pow(least_part, random_unit(random))));
    return true;
}

/* Marks in `bad` which of the pairs are not what the scene claims. */
static void check_claims(const struct scene *scene, const struct body *bodies, size_t count, narc_contact *contacts,
                         bool *bad) {
    for (enum kind kind = 0; kind < KINDS; kind++) {
        separate(scene->templates->kinds[kind].shapes, bodies, count, contacts);
        for (size_t k = 0; k < count; k++)
            bad[k] |= (contacts[k].separation < 0) != (scene->situation == COLLIDING);
    }
}

/* Draws `count` pairs, puts them, and keeps those that are good, at the front; how many is returned. */
static size_t fill_round(struct scene *scene, struct body *bodies, size_t count, uint64_t *random) {
    struct spacing *spacings = allocate(count, sizeof *spacings);
    bool *bad = allocate(count, sizeof *bad);
    narc_contact *contacts = allocate(count, sizeof *contacts);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++)
        draw(scene->templates, random, &bodies[2 * k], &spacings[k]);
    find_spacings(scene->templates, bodies, spacings, count);
    for (size_t k = 0; k < count; k++) {
        struct body *pair = &bodies[2 * k];
        if (scene->situation == APART ? put_apart(pair, &spacings[k], random)
                                      : put_colliding(pair, &spacings[k], random)) {
            memmove(&bodies[2 * kept], pair, 2 * sizeof *pair);
            kept++;
        }
    }
    count = kept;
    check_claims(scene, bodies, count, contacts, bad);
    kept = 0;
    for (size_t k = 0; k < count; k++)
        if (!bad[k])
            memmove(&bodies[2 * kept++], &bodies[2 * k], 2 * sizeof *bodies);
    free(contacts);
    free(bad);
    free(spacings);
    return kept;
}

struct scene make_scene(const struct templates *templates, enum situation situation, size_t pair_count,
                        uint64_t *random) {
    struct scene scene = {templates, situation, pair_count, allocate(2 * pair_count, sizeof(struct body))};
    size_t count = 0;
    for (int round = 0; round < ROUNDS && count < pair_count; round++)
        count += fill_round(&scene, &scene.bodies[2 * count], pair_count - count, random);
    if (count < pair_count)
        fail("a scene of n = %zu did not fill up", templates->n);
    return scene;
}

double rounding_of(const struct bound *bounds, const struct body *pair) {
    const double distance = hypot((double)pair[1].x - (double)pair[0].x, (double)pair[1].y - (double)pair[0].y);
    return NARC_ERROR_BOUND * (distance + bounds[pair[0].shape].extent + bounds[pair[1].shape].extent);
}

double size_of(const struct bound *bounds, const struct body *pair) {
    return bounds[pair[0].shape].radius + bounds[pair[1].shape].radius;
}
