/* SPDX-License-Identifier: MIT
 *
 * routes.c - pairs of discs have a short way where a vector has no others, and pairs with edges skip stages
 * where most of those before them rest on each other: answers must not depend on the company of a pair.
 * And where proofs once claimed too much.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plain.h"

enum { BODIES = 300, PAIRS = 2600 };

/* Gives all bodies a disc but every `other`-th one (0: all), and breaks every `broken`-th (0: none). */
static struct scene make_discs(struct test_random *random, size_t pairs, size_t other, size_t broken) {
    struct scene scene = make_random_scene(random, NARC_FLOAT32, BODIES, pairs);
    uint32_t disc[4 * FAMILY_COUNT], count = 0;
    for (uint32_t k = 0; k < scene.shape_count; k++)
        if (narc_shape_flags(scene.store, k) & NARC_SHAPE_CIRCLE)
            disc[count++] = k;
    assert_true(count > 3);
    for (size_t k = 0; k < BODIES; k++) {
        if (other == 0 || k % other != 0)
            scene.bodies[k].shape = disc[k % count];
        if (broken > 0 && k % broken == 0)
            scene.bodies[k].sine = NAN;
    }
    return scene;
}

static struct contacts find_part(const struct scene *scene, size_t first, size_t count, float margin) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_query query = {.margin = margin, .first = first, .count = count};
    return find_contacts(scene->store, &bodies, &pairs, &query);
}

/* All answers; and contacts of the whole batch against those of parts of all lengths. */
static void check_all(struct test_random *random, const struct scene *scene, const char *name) {
    static const float margins[] = {0, 0.3f, -0.1f, INFINITY};
    check_plain_scene(random, scene, name);
    for (size_t m = 0; m < sizeof margins / sizeof *margins; m++) {
        AUTO(free_at) struct contacts whole = find_part(scene, 0, scene->pair_count, margins[m]);
        size_t found = 0;
        for (size_t first = 0, count; first < scene->pair_count; first += count) {
            count = 1 + random_below(random, 40);
            count = count < scene->pair_count - first ? count : scene->pair_count - first;
            AUTO(free_at) struct contacts part = find_part(scene, first, count, margins[m]);
            assert_true(found + part.count <= whole.count);
            assert_memory_equal(part.rows, whole.rows + found, part.count * sizeof *part.rows);
            found += part.count;
        }
        assert_int_equal(found, whole.count);
    }
}

/* Discs alone, with few others, with many; with broken bodies between them; around the ends of vectors and calls. */
TEST(test_discs) {
    static const struct {
        size_t other, broken, pairs;
    } mixes[] = {{0, 0, PAIRS}, {0, 0, 1024},    {0, 0, 1025},    {0, 0, 17},   {0, 97, PAIRS},
                 {0, 5, PAIRS}, {150, 0, PAIRS}, {40, 50, PAIRS}, {3, 0, PAIRS}};
    struct test_random random = test_random_named("discs");
    for (size_t k = 0; k < sizeof mixes / sizeof *mixes; k++) {
        AUTO(destroy_scene) struct scene scene = make_discs(&random, mixes[k].pairs, mixes[k].other, mixes[k].broken);
        check_all(&random, &scene, "discs");
    }
}

/* One other pair, or one of a broken body, in each lane of each of the first vectors; and discs in one place. */
TEST(test_one_other) {
    enum { FEW = 50 };
    struct test_random random = test_random_named("one other");
    AUTO(destroy_scene)
    struct scene scene = make_discs(&random, FEW, BODIES - 1, 0); /* bodies 0 and BODIES - 1 are others */
    for (size_t k = 0; k < FEW; k++)
        scene.pairs[k] = (struct pair){1 + (uint32_t)k, 2 + (uint32_t)k};
    scene.pairs[20].b = scene.pairs[20].a; /* in one place */
    for (size_t round = 0; round < 2; round++) {
        for (size_t k = 0; k < FEW; k++) {
            const uint32_t kept = scene.pairs[k].a;
            scene.pairs[k].a = 0;
            check_all(&random, &scene, round ? "one broken" : "one other");
            scene.pairs[k].a = kept;
        }
        scene.bodies[0].sine = NAN;
    }
}

/* Discs whose gap is about what the first proofs that they are apart need. Circles that lie off their origins: of
 * others the bounding circles know. */
TEST(test_discs_at_the_limit) {
    struct test_random random = test_random_named("limit");
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 3, 2 * PAIRS, PAIRS);
    const struct shape left = {{{-0.6, -0.8, 1, -PI, PI}}, 1}, right = {{{0.6, 0.8, 1, -PI, PI}}, 1};
    const struct shape box = box_of(2, 2, 0.2);
    scene_add_shape(&scene, &left);
    scene_add_shape(&scene, &right);
    scene_add_shape(&scene, &box);
    for (uint32_t k = 0; k < PAIRS; k++) {
        const double turn = random_between(&random, -5e-4, 5e-4), gap = 0x1p-15 * random_between(&random, 0.98, 1.02);
        struct body a = turned_body(0, 1), b = turned_body(turn, 1);
        b.x = 0.6 * (gap + 1 - cos(turn)) + 0.8 * sin(turn);
        b.y = 0.8 * (gap + 1 - cos(turn)) - 0.6 * sin(turn);
        b.shape = k % 16 == 15 ? 2 : 1;
        scene_add_two(&scene, a, b);
    }
    check_all(&random, &scene, "limit");
}

/* Blocks of boxes that rest on each other, and blocks that lie anywhere. */
TEST(test_resting_edges) {
    struct test_random random = test_random_named("resting");
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 3, 2 * PAIRS, PAIRS);
    const struct shape sharp = box_of(2, 1, 0), round = box_of(2, 1, 0.2);
    struct shape ellipse;
    assert_int_equal(narc_build_ellipse(1, 0.5, 8, ellipse.arcs, &ellipse.count, NULL, NULL), NARC_OK);
    scene_add_shape(&scene, &sharp);
    scene_add_shape(&scene, &round);
    scene_add_shape(&scene, &ellipse);
    for (uint32_t k = 0; k < PAIRS; k++) {
        const bool rests = k / 100 % 3 < 2;
        const double angle = random_between(&random, -PI, PI), along = random_between(&random, -1.5, 1.5);
        const double across = rests ? 1 + 1e-4 * random_between(&random, -1, 1) : random_between(&random, 0, 2);
        struct body a = turned_body(angle, 1), b = turned_body(rests ? angle : 3 * angle, 1);
        a.shape = (uint32_t)random_below(&random, k % 7 ? 2 : 3);
        b.shape = (uint32_t)random_below(&random, k % 5 ? 2 : 3);
        b.x = cos(angle) * along - sin(angle) * across;
        b.y = sin(angle) * along + cos(angle) * across;
        scene_add_two(&scene, a, b);
    }
    check_all(&random, &scene, "resting");
}

/* ------------------------------------------------------------------------------------------------ early proofs */

/* The square of a short direction is 0 or has lost its digits, and then its length does not scale anything. */
TEST(test_vanishing_axes) {
    struct test_random random = test_random_named("vanishing axes");
    enum { SHAPES = 24, CLOSE = 4000 };
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, SHAPES, 2 * CLOSE, CLOSE);
    for (size_t k = 0; k < SHAPES; k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        if (k % 3 == 0) {
            const narc_four_arc lens = {1, 1, random_between(&random, 1.5, 1.95), 0, 0};
            assert_int_equal(narc_build_four_arc(&lens, shape.arcs, &shape.count, NULL), NARC_OK);
        }
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < CLOSE; k++) {
        struct body a = turned_body(random_between(&random, -4, 4), 1), b = a;
        if (random_below(&random, 2))
            b = turned_body(random_between(&random, -4, 4), 1);
        const double distance = random_log_between(&random, 1e-40, 1e-12), angle = random_between(&random, -4, 4);
        a.shape = b.shape = (uint32_t)random_below(&random, SHAPES);
        if (random_below(&random, 4) == 0)
            b.shape = (uint32_t)random_below(&random, SHAPES);
        b.x = random_below(&random, 4) ? distance * cos(angle) : 0;
        b.y = random_below(&random, 4) ? distance * sin(angle) : 0;
        scene_add_two(&scene, a, b);
    }
    check_plain_scene(&random, &scene, "vanishing axes");
}

/* A flat rhombus with rounded corners; its upper corner is two arcs whose centres are `overlap` too far to their own
 * side, so that a tiny edge between them runs backwards. */
static struct shape make_loose_rhombus(double slope, double radius, double overlap) {
    const double top = (1 - radius) * tan(slope), up = PI / 2, down = 3 * PI / 2;
    return (struct shape){.arcs = {{1 - radius, 0, radius, slope - up, up - slope},
                                   {-overlap / 2, top, radius, up - slope, up},
                                   {overlap / 2, top, radius, up, up + slope},
                                   {radius - 1, 0, radius, up + slope, down - slope},
                                   {0, -top, radius, down - slope, down + slope}},
                          .count = 5};
}

/* Arcs may be given with joins that are off by NARC_TOLERANCE: two maxima of one value, next to each other. */
TEST(test_loose_joins) {
    struct test_random random = test_random_named("loose joins");
    enum { CLOSE = 1000 };
    for (size_t round = 0; round < test_trials(40); round++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 2, 2 * CLOSE, CLOSE);
        const double slope = random_between(&random, 0.03, 0.35), radius = random_between(&random, 0.015, 0.055);
        const double small = random_between(&random, 0.005, 0.015);
        const struct shape rhombus = make_loose_rhombus(slope, radius, random_between(&random, 0.2e-5, 0.99e-5));
        const struct shape circle = {.arcs = {{0, 0, small, -PI, PI}}, .count = 1};
        const uint32_t first = scene_add_shape(&scene, &rhombus), second = scene_add_shape(&scene, &circle);
        for (size_t k = 0; k < CLOSE; k++) {
            const double angle = random_between(&random, -6e-4, 6e-4);
            const double distance = (radius + small) * random_between(&random, 0.6, 1);
            const double x = distance * sin(angle), y = (1 - radius) * tan(slope) + distance * cos(angle);
            struct body a = turned_body(random_between(&random, -4, 4), 1), b = turned_body(0, 1);
            b.x = (double)a.cosine * x - (double)a.sine * y;
            b.y = (double)a.sine * x + (double)a.cosine * y;
            a.shape = first;
            b.shape = second;
            scene_add_two(&scene, a, b);
        }
        check_plain_scene(&random, &scene, "loose joins");
    }
}

TEST_MAIN("routes")
