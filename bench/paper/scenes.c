/* SPDX-License-Identifier: MIT
 *
 * scenes.c - templates of one n, and the two scenes of the paper: pairs that never collide, pairs that always do.
 *
 * Both bodies of a pair have random shapes and rotations; the second stands in a random direction from the first. How
 * far depends on the distance t at which the two touch, which Newton's method finds with the exact separations of all
 * pairs at once: along the line the gap is convex, and so it comes down to the touching place from outside.
 */
#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../random.h"
#include "outlines.h"

static const double pi = 3.14159265358979323846;

/* First bodies lie in a square of this half width. */
static const double half_square = 8;

/* A gap, or the room for one, that is less than this is too close to rounding to be counted on. */
static const double least_gap = 1e-3;

/* Colliding pairs: t - distance is from this part of t to all of it, equally likely on a logarithmic scale. */
static const double least_part = 1e-3;

/* Newton's method ends when no gap is above this, or after so many steps. */
static const double touching = 3e-6;
enum { NEWTON_STEPS = 40, ROUNDS = 100 };

/* ------------------------------------------------------------------------------------------------ templates */

struct bound bound_of(const narc_arc *arcs, size_t count) {
    narc_circle circle = {0};
    struct bound bound;
    if (!narc_compute_bounding_circle(arcs, count, &circle))
        fail("a shape without a bounding circle");
    bound = (struct bound){circle.x, circle.y, circle.radius, 0};
    for (size_t k = 0; k < count; k++)
        bound.extent = fmax(bound.extent, hypot(arcs[k].center_x, arcs[k].center_y) + arcs[k].radius);
    return bound;
}

static void add_template(struct templates *templates, size_t index, const narc_arc *arcs) {
    narc_error error;
    must(narc_add_shape(templates->shapes, arcs, templates->n, NULL, &error), &error);
    templates->bounds[index] = bound_of(arcs, templates->n);
}

struct templates make_templates(size_t n, size_t count, uint64_t *random) {
    struct templates templates = {.n = n, .count = count, .bounds = allocate(KINDS * count, sizeof(struct bound))};
    narc_arc(*polygons)[NARC_MAX_ARCS] = allocate(count, sizeof *polygons);
    if (narc_create_shapes(NULL, &templates.shapes) != NARC_OK)
        fail("out of memory");
    for (size_t k = 0; k < count; k++) {
        const struct smooth outline = random_smooth(random);
        double junctions[NARC_MAX_ARCS + 1];
        narc_arc arcs[NARC_MAX_ARCS];
        do
            random_junctions(random, n, junctions);
        while (!fit_n_arc(&outline, junctions, n, arcs));
        fit_n_gon(&outline, junctions, n, polygons[k]);
        add_template(&templates, k, arcs);
    }
    for (size_t k = 0; k < count; k++)
        add_template(&templates, count + k, polygons[k]);
    free(polygons);
    return templates;
}

/* ------------------------------------------------------------------------------------------------ poses and pairs */

narc_bodies bodies_of(const struct pose *poses, size_t count, enum kind kind) {
    return (narc_bodies){.count = count,
                         .x = NARC_COLUMN(poses, x),
                         .y = NARC_COLUMN(poses, y),
                         .cosine = NARC_COLUMN(poses, cosine),
                         .sine = NARC_COLUMN(poses, sine),
                         .shape = NARC_COLUMN(poses, shape[kind])};
}

narc_pairs neighbours(size_t pair_count) {
    static uint32_t *list;
    static size_t room;
    if (pair_count > room) {
        free(list);
        list = allocate(2 * pair_count, sizeof *list);
        room = pair_count;
        for (size_t k = 0; k < 2 * pair_count; k++)
            list[k] = (uint32_t)k;
    }
    return (narc_pairs){pair_count, {list, 2 * sizeof *list}, {list + 1, 2 * sizeof *list}};
}

void separate(const narc_shapes *shapes, const struct pose *poses, size_t pair_count, enum kind kind,
              narc_contacts *out) {
    const narc_bodies bodies = bodies_of(poses, 2 * pair_count, kind);
    const narc_pairs pairs = neighbours(pair_count);
    narc_error error;
    size_t found = 0;
    must(narc_find_contacts(shapes, &bodies, &pairs, INFINITY, 0, out, &found, &error), &error);
}

/* ------------------------------------------------------------------------------------------------ placing */

/* A pair that is being placed: the direction from A to B, and for either kind the distance at which the two touch and
 * the one at which their bounding circles do. */
struct place {
    double x, y;
    double touch[KINDS], circles[KINDS];
};

static struct pose random_pose(uint64_t *random, size_t template_count, double half_width) {
    const double angle = random_between(random, -pi, pi), x = random_between(random, -half_width, half_width);
    const double y = random_between(random, -half_width, half_width);
    const uint32_t shape = (uint32_t)random_below(random, template_count);
    return (struct pose){
        (float)x, (float)y, (float)cos(angle), (float)sin(angle), {shape, shape + (uint32_t)template_count}};
}

/* With c the vector between the circles' centres when both bodies are in one place: |c + t d| = sum of the radii. */
static double circles_touch(const struct templates *templates, const struct pose *poses, const struct place *place,
                            enum kind kind) {
    const struct bound *a = &templates->bounds[poses[0].shape[kind]], *b = &templates->bounds[poses[1].shape[kind]];
    const double x = (double)poses[1].cosine * b->x - (double)poses[1].sine * b->y - (double)poses[0].cosine * a->x +
                     (double)poses[0].sine * a->y;
    const double y = (double)poses[1].sine * b->x + (double)poses[1].cosine * b->y - (double)poses[0].sine * a->x -
                     (double)poses[0].cosine * a->y;
    const double along = x * place->x + y * place->y, across = x * place->y - y * place->x;
    const double sum = a->radius + b->radius;
    return sqrt(sum * sum - across * across) - along;
}

static void put_second(struct pose *poses, const struct place *place, double distance) {
    poses[1].x = (float)(poses[0].x + distance * place->x);
    poses[1].y = (float)(poses[0].y + distance * place->y);
}

static void draw(const struct templates *templates, uint64_t *random, struct pose *poses, struct place *place) {
    const double direction = random_between(random, -pi, pi);
    place->x = cos(direction);
    place->y = sin(direction);
    poses[0] = random_pose(random, templates->count, half_square);
    poses[1] = random_pose(random, templates->count, 0);
    for (enum kind kind = 0; kind < KINDS; kind++)
        place->circles[kind] = circles_touch(templates, poses, place, kind);
}

/* The distances at which the pairs touch, as one kind. */
static void find_touching(const struct templates *templates, struct pose *poses, struct place *places, size_t count,
                          enum kind kind, narc_contacts *contacts) {
    for (size_t k = 0; k < count; k++)
        places[k].touch[kind] = places[k].circles[kind] * 1.001;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        double most = 0;
        for (size_t k = 0; k < count; k++)
            put_second(&poses[2 * k], &places[k], places[k].touch[kind]);
        separate(templates->shapes, poses, count, kind, contacts);
        for (size_t k = 0; k < count; k++) {
            const double gap = contacts->separation[k];
            const double slope = contacts->normal_x[k] * places[k].x + contacts->normal_y[k] * places[k].y;
            places[k].touch[kind] -= gap / slope;
            most = fmax(most, gap);
        }
        if (most < touching)
            return;
    }
}

/* Pairs that are apart: anywhere, equally likely, between where they touch and where the circles of either kind come
 * apart. False where there is no room for it. */
static bool put_apart(struct pose *poses, const struct place *place, uint64_t *random) {
    const double from = fmax(place->touch[KIND_ARC], place->touch[KIND_GON]) + least_gap;
    const double to = fmin(place->circles[KIND_ARC], place->circles[KIND_GON]);
    if (to < from + least_gap)
        return false;
    put_second(poses, place, random_between(random, from, to));
    return true;
}

static bool put_colliding(struct pose *poses, const struct place *place, uint64_t *random) {
    const double touch = fmin(place->touch[KIND_ARC], place->touch[KIND_GON]);
    put_second(poses, place, touch * (1 - pow(least_part, random_unit(random))));
    return true;
}

/* Marks in `bad` which of the pairs are not what the scene claims. */
static void check_claims(const struct scene *scene, const struct pose *poses, size_t count, narc_contacts *contacts,
                         bool *bad) {
    for (enum kind kind = 0; kind < KINDS; kind++) {
        separate(scene->templates->shapes, poses, count, kind, contacts);
        for (size_t k = 0; k < count; k++)
            bad[k] |= (contacts->separation[k] < 0) != (scene->situation == COLLIDING);
    }
}

/* Draws `count` pairs, places them, and keeps those that are good, at the front; how many is returned. */
static size_t place_round(struct scene *scene, struct pose *poses, size_t count, uint64_t *random) {
    struct place *places = allocate(count, sizeof *places);
    bool *bad = allocate(count, sizeof *bad);
    narc_contacts contacts = allocate_contacts(count);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++)
        draw(scene->templates, random, &poses[2 * k], &places[k]);
    for (enum kind kind = 0; kind < KINDS; kind++)
        find_touching(scene->templates, poses, places, count, kind, &contacts);
    for (size_t k = 0; k < count; k++) {
        struct pose *pair = &poses[2 * k];
        if (scene->situation == APART ? put_apart(pair, &places[k], random) : put_colliding(pair, &places[k], random)) {
            memmove(&poses[2 * kept], pair, 2 * sizeof *pair);
            kept++;
        }
    }
    scene->drawn_again += count - kept;
    count = kept;
    check_claims(scene, poses, count, &contacts, bad);
    kept = 0;
    for (size_t k = 0; k < count; k++)
        if (!bad[k])
            memmove(&poses[2 * kept++], &poses[2 * k], 2 * sizeof *poses);
    scene->left_out += count - kept;
    free_contacts(&contacts);
    free(bad);
    free(places);
    return kept;
}

struct scene make_scene(const struct templates *templates, enum situation situation, size_t pair_count,
                        uint64_t *random) {
    struct scene scene = {templates, situation, pair_count, allocate(2 * pair_count, sizeof(struct pose)), 0, 0};
    size_t count = 0;
    for (int round = 0; round < ROUNDS && count < pair_count; round++)
        count += place_round(&scene, &scene.poses[2 * count], pair_count - count, random);
    if (count < pair_count)
        fail("a scene of n = %zu did not fill up", templates->n);
    return scene;
}

double rounding_of(const struct bound *bounds, const struct pose *pair, enum kind kind) {
    const double distance = hypot((double)pair[1].x - (double)pair[0].x, (double)pair[1].y - (double)pair[0].y);
    return NARC_ERROR_BOUND * (distance + bounds[pair[0].shape[kind]].extent + bounds[pair[1].shape[kind]].extent);
}

double size_of(const struct bound *bounds, const struct pose *pair, enum kind kind) {
    return bounds[pair[0].shape[kind]].radius + bounds[pair[1].shape[kind]].radius;
}

struct spread spread_of(const struct scene *scene) {
    const size_t count = scene->pair_count;
    narc_contacts contacts = allocate_contacts(count);
    double *sizes = allocate(count, sizeof *sizes);
    separate(scene->templates->shapes, scene->poses, count, KIND_ARC, &contacts);
    for (size_t k = 0; k < count; k++) {
        sizes[k] =
            fabs((double)contacts.separation[k]) / size_of(scene->templates->bounds, &scene->poses[2 * k], KIND_ARC);
    }
    const struct spread spread = {quantile(sizes, count, 0), quantile(sizes, count, 0.25), quantile(sizes, count, 0.5),
                                  quantile(sizes, count, 0.75), quantile(sizes, count, 1)};
    free(sizes);
    free_contacts(&contacts);
    return spread;
}
