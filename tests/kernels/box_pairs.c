/* SPDX-License-Identifier: MIT
 *
 * box_pairs.c - pairs of boxes, and pairs of capsules, have a way of their own: rows are those of the deciding formula,
 * byte by byte, where they are aligned, equal, tie, touch in corners, are thin, and where rotations and sizes are almost
 * something else.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hard.h"
#include "placements.h"
#include "plain.h"

enum { SHAPES = 24, PAIRS = 4000 };

/* How boxes of a scene differ. */
enum sizes { LATTICE, ALIKE, USUAL, THIN, SIZES };

/* What a scene is made of. */
enum kinds { BOXES, CAPSULES, BOTH, OTHERS /* both, and what is neither */ };

/* A capsule, or a segment, whose arcs are listed from either end: that turns the zeros in its normals. */
static struct shape make_capsule(struct test_random *random, double length, double width) {
    const double radii[] = {0, width, width, width * 1e-7, 0.0625, length};
    const double radius = radii[random_below(random, 6)], x = random_below(random, 2) ? length / 2 : -length / 2;
    struct shape shape = {.count = 0};
    if (x > 0 && radius > 0 && random_below(random, 2))
        return capsule_of(length, radius);
    assert_int_equal(
        narc_build_segment((narc_point){-x, 0}, (narc_point){x, 0}, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

static struct shape make_form(struct test_random *random, enum sizes sizes, bool capsule) {
    const double spread = sizes == THIN ? 1e3 : 4;
    double width = random_log_between(random, 1 / spread, spread),
           height = random_log_between(random, 1 / spread, spread);
    if (sizes == LATTICE || sizes == ALIKE) {
        width = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
        height = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
    }
    if (capsule)
        return make_capsule(random, width, height);
    const double least = fmin(width, height);
    const double radii[] = {0, 0, 0.0625, least * random_unit(random) / 2, least * 1e-7, least * 0.4999999};
    const double radius = fmin(radii[random_below(random, 6)], least / 4 * (1 + random_unit(random)));
    return box_of(width, height, radius);
}

/* One that starts with another arc, or a shape that has no such form: turned, elsewhere, or something else. */
static struct shape make_other(struct test_random *random) {
    struct shape shape = make_form(random, USUAL, random_below(random, 2));
    const size_t kind = random_below(random, 5);
    const double turns[] = {0.5, PI / 2}, turn = kind == 2 || kind == 4 ? turns[kind == 4] : 0;
    const double move = kind == 1 ? random_between(random, -1, 1) : 0;
    struct shape other = {.count = shape.count};
    if (kind == 3)
        return random_below(random, 2) ? circle_of(1) : capsule_of(1e-7, 1);
    for (size_t i = 0; i < shape.count; i++) {
        const narc_arc arc = shape.arcs[(i + 1) % shape.count];
        other.arcs[i] = (narc_arc){cos(turn) * arc.center_x - sin(turn) * arc.center_y + move,
                                   sin(turn) * arc.center_x + cos(turn) * arc.center_y, arc.radius, arc.start + turn,
                                   arc.end + turn};
    }
    return other;
}

static struct scene make_boxes(struct test_random *random, enum sizes sizes, enum kinds kinds) {
    static const enum placement exact[] = {PLACE_LATTICE,    PLACE_LATTICE, PLACE_PARALLEL, PLACE_PARALLEL,
                                           PLACE_COINCIDENT, PLACE_TOUCH,   PLACE_DEEP,     PLACE_NEAR};
    const bool mixed = kinds == OTHERS;
    const narc_precision precision = random_below(random, 2) ? NARC_FLOAT64 : NARC_FLOAT32;
    struct scene scene = create_scene(precision, SHAPES, 2 * PAIRS, PAIRS);
    for (size_t k = 0; k < SHAPES; k++) {
        const bool capsule = kinds == CAPSULES || (kinds != BOXES && random_below(random, 2));
        const struct shape shape = mixed && k % 4 == 0 ? make_other(random) : make_form(random, sizes, capsule);
        scene_add_shape(&scene, &shape);
    }
    while (scene.pair_count + HARD_BODIES / 2 + 8 <= PAIRS) {
        const uint32_t a = (uint32_t)random_below(random, SHAPES);
        const uint32_t b = random_below(random, 4) ? (uint32_t)random_below(random, SHAPES) : a;
        if (random_below(random, 3) == 0)
            add_hard_pairs(random, &scene, (enum hard_placement)random_below(random, HARD_PLACES), a, b);
        for (int k = 0; k < 8; k++)
            scene_add_placed(random, &scene, exact[random_below(random, sizeof exact / sizeof *exact)], a, b);
    }
    for (size_t k = 0; k < scene.pair_count; k++) {
        if (mixed && random_below(random, 40) == 0)
            scene.bodies[scene.pairs[k].b].sine = NAN;
        if (random_below(random, 64) == 0)
            scene.pairs[k].b = scene.pairs[k].a;
        else if (random_below(random, 2))
            scene.pairs[k] = (struct pair){scene.pairs[k].b, scene.pairs[k].a};
    }
    return scene;
}

static void check_sizes(enum sizes sizes, enum kinds kinds, const char *name) {
    struct test_random random = test_random_named(name);
    for (size_t round = 0; round < test_trials(8); round++) {
        struct scene scene = make_boxes(&random, sizes, kinds);
        check_plain_scene(&random, &scene, name);
        destroy_scene(&scene);
    }
}

TEST(test_lattice) { check_sizes(LATTICE, BOXES, "boxes of a lattice"); }

TEST(test_alike) { check_sizes(ALIKE, BOXES, "squares"); }

TEST(test_usual) { check_sizes(USUAL, BOXES, "boxes"); }

TEST(test_thin) { check_sizes(THIN, BOXES, "thin boxes"); }

TEST(test_capsule_lattice) { check_sizes(LATTICE, CAPSULES, "capsules of a lattice"); }

TEST(test_alike_capsules) { check_sizes(ALIKE, CAPSULES, "equal capsules"); }

TEST(test_capsules) { check_sizes(USUAL, CAPSULES, "capsules"); }

TEST(test_thin_capsules) { check_sizes(THIN, CAPSULES, "thin capsules"); }

TEST(test_both) { check_sizes(LATTICE, BOTH, "boxes and capsules"); }

TEST(test_mixed) { check_sizes(USUAL, OTHERS, "boxes and capsules among others"); }

/* A box waits while capsules are answered, and pairs that are neither are far apart: rows stay in the order of pairs. */
TEST(test_order_of_rows) {
    struct scene scene = create_scene(NARC_FLOAT32, 2, 400, 200);
    const struct shape box = box_of(2, 2, 0), capsule = capsule_of(2, 1);
    scene_add_shape(&scene, &box);
    scene_add_shape(&scene, &capsule);
    for (uint32_t k = 0; k < 200; k++) {
        struct body a = {.cosine = 1, .scale = 1, .shape = k > 0}, b = a;
        b.shape = k % 2 ? 0 : a.shape;
        b.x = k % 2 ? 100 : 0.5;
        scene_add_two(&scene, a, b);
    }
    struct test_random random = test_random_named("order");
    check_plain_scene(&random, &scene, "a box before capsules");
    destroy_scene(&scene);
}

/* Capsules and boxes come seldom, among circles, and then all at once. */
TEST(test_seldom) {
    struct scene scene = create_scene(NARC_FLOAT32, 3, 3000, 1500);
    const struct shape circle = circle_of(1), box = box_of(2, 1, 0.25), capsule = capsule_of(2, 0.5);
    scene_add_shape(&scene, &circle);
    scene_add_shape(&scene, &box);
    scene_add_shape(&scene, &capsule);
    struct test_random random = test_random_named("seldom");
    for (uint32_t k = 0; k < 1500; k++) {
        struct body a = {.cosine = 1, .scale = 1}, b = a;
        a.shape = b.shape = k % 41 == 0 || k > 1200 ? 1 + k % 2 : 0;
        b.x = random_between(&random, -2, 2);
        b.y = random_between(&random, -1, 1);
        scene_add_two(&scene, a, b);
    }
    check_plain_scene(&random, &scene, "seldom");
    destroy_scene(&scene);
}

TEST_MAIN("box_pairs")
