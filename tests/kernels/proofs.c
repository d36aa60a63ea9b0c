/* SPDX-License-Identifier: MIT
 *
 * proofs.c - where proofs once claimed too much: pairs with a distance whose square vanishes, and arcs that hardly
 * join.
 */
#include <math.h>
#include <stdlib.h>

#include "plain.h"

static void add_pair(struct scene *scene, struct body a, struct body b) {
    round_position(&a, scene->precision);
    round_position(&b, scene->precision);
    scene_add_two(scene, a, b);
}

/* The square of a short direction is 0 or has lost its digits, and then its length does not scale anything. */
TEST(test_vanishing_axes) {
    struct test_random random = test_random_named("vanishing axes");
    enum { SHAPES = 24, PAIRS = 4000 };
    struct scene scene = create_scene(NARC_FLOAT32, SHAPES, 2 * PAIRS, PAIRS);
    for (size_t k = 0; k < SHAPES; k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        if (k % 3 == 0) {
            const narc_four_arc lens = {1, 1, random_between(&random, 1.5, 1.95), 0, 0};
            assert_int_equal(narc_build_four_arc(lens, shape.arcs, &shape.count, NULL), NARC_OK);
        }
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < PAIRS; k++) {
        struct body a = turned_body(random_between(&random, -4, 4), 1), b = a;
        if (random_below(&random, 2))
            b = turned_body(random_between(&random, -4, 4), 1);
        const double distance = random_log_between(&random, 1e-40, 1e-12), angle = random_between(&random, -4, 4);
        a.shape = b.shape = (uint32_t)random_below(&random, SHAPES);
        if (random_below(&random, 4) == 0)
            b.shape = (uint32_t)random_below(&random, SHAPES);
        b.x = random_below(&random, 4) ? distance * cos(angle) : 0;
        b.y = random_below(&random, 4) ? distance * sin(angle) : 0;
        add_pair(&scene, a, b);
    }
    check_plain_scene(&random, &scene, "vanishing axes");
    destroy_scene(&scene);
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
    enum { PAIRS = 1000 };
    for (size_t round = 0; round < test_trials(40); round++) {
        struct scene scene = create_scene(NARC_FLOAT32, 2, 2 * PAIRS, PAIRS);
        const double slope = random_between(&random, 0.03, 0.35), radius = random_between(&random, 0.015, 0.055);
        const double small = random_between(&random, 0.005, 0.015);
        const struct shape rhombus = make_loose_rhombus(slope, radius, random_between(&random, 0.2e-5, 0.99e-5));
        const struct shape circle = {.arcs = {{0, 0, small, -PI, PI}}, .count = 1};
        const uint32_t first = scene_add_shape(&scene, &rhombus), second = scene_add_shape(&scene, &circle);
        for (size_t k = 0; k < PAIRS; k++) {
            const double angle = random_between(&random, -6e-4, 6e-4);
            const double distance = (radius + small) * random_between(&random, 0.6, 1);
            const double x = distance * sin(angle), y = (1 - radius) * tan(slope) + distance * cos(angle);
            struct body a = turned_body(random_between(&random, -4, 4), 1), b = turned_body(0, 1);
            b.x = (double)a.cosine * x - (double)a.sine * y;
            b.y = (double)a.sine * x + (double)a.cosine * y;
            a.shape = first;
            b.shape = second;
            add_pair(&scene, a, b);
        }
        check_plain_scene(&random, &scene, "loose joins");
        destroy_scene(&scene);
    }
}

TEST_MAIN("proofs")
