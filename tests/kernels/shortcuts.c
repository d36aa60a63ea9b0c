/* SPDX-License-Identifier: MIT
 *
 * shortcuts.c - shortcuts change no bit: all answers are those of the deciding formula, on shapes and in places
 * that are meant to mislead them.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "corpus.h"
#include "plain.h"

/* All answers of a scene in one layout: with the usual margins, and with margins beside the separation of one pair,
 * which the others must not mind. */
static void check_scene(struct test_random *random, const struct scene *scene, enum layout layout, const char *name) {
    AUTO(destroy_columns) struct columns columns = create_columns(scene, layout, 0, scene->pair_count);
    const struct plain_batch batch = make_plain_batch(scene, &columns.bodies, &columns.pairs, name);
    const float some = batch.right[random_below(random, columns.pairs.count)].separation;
    const float margins[] = {0, INFINITY, 0.25f, 1e-4f, -1e-4f, -0.25f, some, nextafterf(some, INFINITY), -FLT_MAX};
    check_plain_overlaps(&batch, NULL);
    for (size_t k = 0; k < sizeof margins / sizeof *margins; k++)
        check_plain_contacts(&batch, &(narc_query){.margin = margins[k]});
    free(batch.right);
}

/* Every family against every other, in all kinds of places. */
TEST(test_all_places) {
    struct test_random random = test_random_named("all places");
    for (int round = 0; round < 20; round++) {
        char name[32];
        snprintf(name, sizeof name, "all places, round %d", round);
        AUTO(destroy_corpus) struct corpus corpus = make_corpus(name, (narc_precision)(round % 2), 2, false);
        check_scene(&random, &corpus.scene, any_layout(&random), name);
    }
}

/* A shape with a face whose normal is its own +x, at x = 0. */
static struct shape make_faced(struct test_random *random) {
    const double t = sqrt(2.0) - 1, radius = random_below(random, 2) ? 0 : 0.0625;
    const narc_point octagon[] = {{0, -t}, {0, t},   {t - 1, 1},   {-1 - t, 1},
                                  {-2, t}, {-2, -t}, {-1 - t, -1}, {t - 1, -1}};
    const narc_point pentagon[] = {{0, -0.5}, {0, 0.75}, {-1, 1}, {-1.75, 0.125}, {-0.75, -1}};
    const narc_point triangle[] = {{0, -1}, {0, 0.75}, {-1.5, 0}};
    const narc_point *const corners[] = {octagon, pentagon, triangle};
    const size_t counts[] = {8, 5, 3}, kind = random_below(random, 4);
    struct shape shape = {.count = 3,
                          .arcs = {{0, -1, 0, -PI / 2, 0}, {0, 1, 0, 0, PI / 2}, {0, 0, 1, PI / 2, 1.5 * PI}}};
    if (kind == 3)
        return shape; /* half a disc */
    shape.count = NARC_MAX_ARCS;
    assert_int_equal(narc_build_polygon(corners[kind], counts[kind], radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* Faces on faces, where the fan begins and ends: A's normal lies along its own +x, B's a little beside it. Gaps at both
 * are equal to the last bit, or nearly. */
TEST(test_faces_at_x) {
    struct test_random random = test_random_named("faces at x");
    enum { SHAPES = 40 };
    const size_t count = test_trials(20000);
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, SHAPES, 2 * count, count);
    for (size_t k = 0; k < SHAPES; k++) {
        const struct shape shape = make_faced(&random);
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < count; k++) {
        const double beside = random_log_between(&random, 1e-10, random_below(&random, 4) ? 1e-4 : 0.03);
        const double turned = random_below(&random, 2) ? 0 : random_between(&random, -PI, PI);
        struct body a = turned_body(turned, 1),
                    b = turned_body(turned + PI + (random_below(&random, 3) ? -beside : beside), 1);
        const double gap = random_below(&random, 2)
                               ? -random_between(&random, 0, 0.4)
                               : random_log_between(&random, 1e-8, 0.1) * (random_below(&random, 2) ? 1 : -1);
        const bool corners = random_below(&random, 4) != 0; /* mostly corners beside corners */
        const double shift =
            corners ? ((double)random_below(&random, 29) - 14) / 8 : random_between(&random, -0.5, 0.5);
        a.shape = (uint32_t)random_below(&random, SHAPES);
        b.shape = (uint32_t)random_below(&random, SHAPES);
        b.x = gap * cos(turned) - shift * sin(turned);
        b.y = gap * sin(turned) + shift * cos(turned);
        scene_add_two(&scene, a, b);
    }
    check_scene(&random, &scene, LAYOUT_STRUCTURES, "faces at x");
}

/* Many random pairs of few shapes, packed, so that every answer of a batch is spread over all stages and vectors. */
TEST(test_crowds) {
    struct test_random random = test_random_named("crowds");
    enum { BODIES = 2000, PAIRS = 40000 };
    const enum layout layouts[] = {LAYOUT_STRUCTURES, LAYOUT_ARRAYS, LAYOUT_SHARED, LAYOUT_UNSCALED};
    for (size_t round = 0; round < test_trials(4); round++) {
        AUTO(destroy_scene)
        struct scene scene = make_random_scene(&random, round % 3 ? NARC_FLOAT32 : NARC_FLOAT64, BODIES, PAIRS);
        for (size_t k = 1; k < BODIES; k += 1 + random_below(&random, 100)) /* some with no answer */
            *(k % 2 ? &scene.bodies[k].sine : &scene.bodies[k].scale) = k % 2 ? NAN : 1e12f;
        suit_layout(&scene, layouts[round % 4]);
        check_scene(&random, &scene, layouts[round % 4], "crowd");
    }
}

/* Runs of one pair after the other: whatever stage settles it, between stages as many wait as ever can. */
TEST(test_runs) {
    struct test_random random = test_random_named("runs");
    enum { KINDS = 16, PAIRS = 12000, LONGEST = 320 };
    for (size_t round = 0; round < test_trials(24); round++) {
        AUTO(destroy_scene)
        struct scene scene =
            create_scene(NARC_FLOAT32, 2 * KINDS, HARD_BODIES * KINDS, HARD_BODIES / 2 * KINDS + PAIRS);
        for (size_t k = 0; k < KINDS; k++) {
            const struct shape shape_a = make_any_shape(&random, random_below(&random, ALL_FAMILIES));
            const struct shape shape_b = make_any_shape(&random, random_below(&random, ALL_FAMILIES));
            const uint32_t index = scene_add_shape(&scene, &shape_a);
            add_hard_pairs(&random, &scene, (enum hard_placement)(k % HARD_PLACES), index,
                           scene_add_shape(&scene, &shape_b));
        }
        const size_t kinds = scene.pair_count;
        size_t left = 0;
        struct pair pair = scene.pairs[0];
        for (size_t k = 0; k < PAIRS; k++, left--) {
            if (left == 0) {
                left = 1 + random_below(&random, random_below(&random, 2) ? LONGEST : LONGEST / 16);
                pair = scene.pairs[random_below(&random, kinds)];
            }
            scene_add_pair(&scene, pair.a, pair.b);
        }
        check_scene(&random, &scene, LAYOUT_STRUCTURES, "runs");
    }
}

/* B's way from one pose to another, relative to A; the answer changes somewhere between `low` and `high`. */
struct way {
    double x[2], y[2], angle[2];
    double low, high;
    bool changes;
};

static void walk(struct scene *scene, size_t pair, const struct way *way, double at) {
    struct body *body = &scene->bodies[2 * pair + 1];
    const double angle = way->angle[0] + at * (way->angle[1] - way->angle[0]);
    body->x = way->x[0] + at * (way->x[1] - way->x[0]);
    body->y = way->y[0] + at * (way->y[1] - way->y[0]);
    body->cosine = (float)cos(angle);
    body->sine = (float)sin(angle);
}

/* What changes: whether the bodies collide, the arcs that touch, or the side. */
enum change { CHANGE_VERDICT, CHANGE_ARCS, CHANGE_SIDE, CHANGES };

static bool is_change(enum change change, const narc_contact *a, const narc_contact *b) {
    switch (change) {
    case CHANGE_VERDICT:
        return (a->separation < 0) != (b->separation < 0);
    case CHANGE_ARCS:
        return arc_of_a(a->feature) != arc_of_a(b->feature) || arc_of_b(a->feature) != arc_of_b(b->feature);
    default:
        return a->normal_x * b->normal_x + a->normal_y * b->normal_y < 0.9f;
    }
}

/* Two bodies somewhere near each other and a way for the second. */
static struct way add_way(struct test_random *random, struct scene *scene) {
    const struct shape shape_a = make_any_shape(random, random_below(random, ALL_FAMILIES));
    const struct shape shape_b = make_any_shape(random, random_below(random, ALL_FAMILIES));
    const double ratio = random_below(random, 2) ? 1 : random_log_between(random, 1e-4, 1e4);
    struct body a = turned_body(random_between(random, -4, 4), 1), b = turned_body(0, ratio);
    narc_circle inner_a, inner_b;
    a.shape = scene_add_shape(scene, &shape_a);
    b.shape = scene_add_shape(scene, &shape_b);
    narc_compute_inscribed_circle(shape_a.arcs, shape_a.count, &inner_a);
    narc_compute_inscribed_circle(shape_b.arcs, shape_b.count, &inner_b);
    struct way way = {.high = 1};
    const double reach = fmax(1, ratio) * random_log_between(random, 0.02, 2);
    const double c_a = (double)a.cosine, s_a = (double)a.sine, start = random_between(random, -4, 4);
    const double c_b = ratio * cos(start), s_b = ratio * sin(start);
    for (int end = 0; end < 2; end++) {
        way.angle[end] = end && random_below(random, 2) ? start + random_log_between(random, 1e-3, 3) : start;
        way.x[end] = c_a * inner_a.x - s_a * inner_a.y - c_b * inner_b.x + s_b * inner_b.y +
                     reach * random_between(random, -1, 1);
        way.y[end] = s_a * inner_a.x + c_a * inner_a.y - s_b * inner_b.x - c_b * inner_b.y +
                     reach * random_between(random, -1, 1);
    }
    scene_add_two(scene, a, b);
    return way;
}

/* Where the deciding formula changes its mind, two answers are equally good: whoever settles such a pair early must be
 * right about the last bit. Bisection finds these places, checks are made around them. */
static void check_changes(struct test_random *random, enum change change) {
    enum { PAIRS = 500, STEPS = 44, POINTS = 20 };
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2 * PAIRS, 2 * PAIRS, PAIRS);
    struct way ways[PAIRS];
    for (size_t k = 0; k < PAIRS; k++) {
        ways[k] = add_way(random, &scene);
        walk(&scene, k, &ways[k], 0);
    }
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    AUTO(free_at) struct contacts first = find_plain_contacts(scene.store, &bodies, &pairs);
    for (int step = 0; step <= STEPS; step++) { /* at first the other end, to see if there is a change at all */
        for (size_t k = 0; k < PAIRS; k++)
            walk(&scene, k, &ways[k], step ? (ways[k].low + ways[k].high) / 2 : 1);
        AUTO(free_at) struct contacts there = find_plain_contacts(scene.store, &bodies, &pairs);
        for (size_t k = 0; k < PAIRS; k++) {
            const bool changed = is_change(change, &first.rows[k], &there.rows[k]);
            if (step == 0)
                ways[k].changes = changed;
            else if (ways[k].changes)
                *(changed ? &ways[k].high : &ways[k].low) = (ways[k].low + ways[k].high) / 2;
        }
    }
    for (size_t point = 0; point < POINTS; point++) {
        const double beside = point ? (point % 2 ? 1 : -1) * 1e-13 * pow(4, (double)point) : 0;
        for (size_t k = 0; k < PAIRS; k++)
            walk(&scene, k, &ways[k], ways[k].changes ? ways[k].low + beside : random_unit(random));
        const struct plain_batch batch = make_plain_batch(&scene, &bodies, &pairs, "change");
        check_plain_overlaps(&batch, NULL);
        check_plain_contacts(&batch, &(narc_query){.margin = 0});
        check_plain_contacts(&batch, &(narc_query){.margin = INFINITY});
        free(batch.right);
    }
}

TEST(test_changes) {
    struct test_random random = test_random_named("changes");
    for (size_t round = 0; round < test_trials(12); round++)
        check_changes(&random, (enum change)(round % CHANGES));
}

/* Specks at the flat side of a half disc, near a corner. Seen along that side the far corner is where the large arc
 * begins: a hair beside it, a point of the arc's circle is no longer one of the shape. */
TEST(test_specks) {
    enum { PAIRS = 6000, SHAPES = 60 };
    struct test_random random = test_random_named("specks");
    for (size_t round = 0; round < test_trials(2); round++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, SHAPES, 2 * PAIRS, PAIRS);
        const struct shape half = {
            .count = 3, .arcs = {{0, -1, 0, -PI / 2, 0}, {0, 1, 0, 0, PI / 2}, {0, 0, 1, PI / 2, 3 * PI / 2}}};
        const uint32_t disc = scene_add_shape(&scene, &half);
        for (size_t k = 1; k < SHAPES; k++) {
            const struct shape speck = k % 2 ? make_hard_shape(&random, k % 4 == 1 ? HARD_LONG : HARD_CORNERS)
                                             : make_any_shape(&random, random_below(&random, ALL_FAMILIES - 1));
            scene_add_shape(&scene, &speck);
        }
        for (size_t k = 0; k < PAIRS; k++) {
            const double size = random_log_between(&random, 1e3, 1e4), angle = random_between(&random, -PI, PI);
            struct body a = turned_body(random_between(&random, -PI, PI), 1), b = turned_body(angle, size);
            a.shape = 1 + (uint32_t)random_below(&random, SHAPES - 1);
            b.shape = disc;
            /* The speck's point furthest towards the side, a way from the corner along it, a little in or out. */
            const struct shape *speck = &scene.shapes[a.shape];
            const double x = cos(angle), y = sin(angle), c = (double)a.cosine, s = (double)a.sine;
            const double way = (random_below(&random, 2) ? 1 : -1) * (size - random_log_between(&random, 0.1, 30));
            const double gap = size * random_log_between(&random, 1e-8, 1e-5) * (random_below(&random, 4) ? 1 : -1);
            narc_point p;
            assert_true(narc_find_support(speck->arcs, speck->count, -c * x - s * y, s * x - c * y, &p, NULL));
            b.x = c * p.x - s * p.y - gap * x + way * y;
            b.y = s * p.x + c * p.y - gap * y - way * x;
            scene_add_two(&scene, a, b);
        }
        check_scene(&random, &scene, LAYOUT_STRUCTURES, "specks");
    }
}

TEST(test_far_from_origin) {
    struct test_random random = test_random_named("far from origin");
    for (int decade = FIRST_FAR; decade <= LAST_FAR; decade++) {
        AUTO(destroy_scene) struct scene scene = make_far_scene(&random, decade);
        check_scene(&random, &scene, LAYOUT_STRUCTURES, "far from origin");
    }
}

TEST_MAIN("shortcuts")
