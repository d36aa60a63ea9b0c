/* SPDX-License-Identifier: MIT
 *
 * box_pairs.c - pairs of boxes, pairs of capsules, and circles with either and with each other have a way of their own: rows
 * are those of the deciding formula, byte by byte, where they are aligned, equal, tie, touch in corners, are thin, and where
 * rotations and sizes are almost something else.
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
enum kinds { BOXES, CAPSULES, BOTH, OTHERS /* both, and what is neither */, CIRCLES /* half of them, and both */ };

/* A capsule, or a segment, whose arcs are listed from either end: that turns the zeros in its normals. */
static struct shape make_capsule(struct test_random *random, double length, double width) {
    const double radii[] = {0, width, width, width * 1e-7, 0.0625, length};
    const double radius = radii[random_below(random, 6)], x = random_below(random, 2) ? length / 2 : -length / 2;
    struct shape shape = {.count = 0};
    if (x > 0 && radius > 0 && random_below(random, 2))
        return capsule_of(length, radius);
    assert_int_equal(
        narc_build_segment(&(narc_point){-x, 0}, &(narc_point){x, 0}, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

static struct shape make_circle(struct test_random *random, double width) {
    const double radii[] = {width, width / 2, 0.0625, width * 1e-5, 1e-9};
    return circle_of(radii[random_below(random, 5)]);
}

static struct shape make_form(struct test_random *random, enum sizes sizes, bool capsule, bool circle) {
    const double spread = sizes == THIN ? 1e3 : 4;
    double width = random_log_between(random, 1 / spread, spread),
           height = random_log_between(random, 1 / spread, spread);
    if (sizes == LATTICE || sizes == ALIKE) {
        width = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
        height = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
    }
    if (circle)
        return make_circle(random, width);
    if (capsule)
        return make_capsule(random, width, height);
    const double least = fmin(width, height);
    const double radii[] = {0, 0, 0.0625, least * random_unit(random) / 2, least * 1e-7, least * 0.4999999};
    const double radius = fmin(radii[random_below(random, 6)], least / 4 * (1 + random_unit(random)));
    return box_of(width, height, radius);
}

/* One that starts with another arc, or a shape that has no such form: turned, elsewhere, or something else. */
static struct shape make_other(struct test_random *random) {
    struct shape shape = make_form(random, USUAL, random_below(random, 2), false);
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
        const bool circle = kinds == CIRCLES && random_below(random, 2);
        const struct shape shape = mixed && k % 4 == 0 ? make_other(random) : make_form(random, sizes, capsule, circle);
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
        AUTO(destroy_scene) struct scene scene = make_boxes(&random, sizes, kinds);
        check_plain_scene(&random, &scene, name);
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

TEST(test_circle_lattice) { check_sizes(LATTICE, CIRCLES, "circles of a lattice"); }

TEST(test_alike_circles) { check_sizes(ALIKE, CIRCLES, "equal circles"); }

TEST(test_circles) { check_sizes(USUAL, CIRCLES, "circles"); }

TEST(test_thin_circles) { check_sizes(THIN, CIRCLES, "small circles"); }

static double random_sign(struct test_random *random) { return random_below(random, 2) ? 1 : -1; }

/* A circle's centre in the frame of a box with these half sides, or of a capsule: on the diagonals, on the lines of the
 * edges, in corners and in the middle, off by nothing, by roundings, by slacks or by much. */
static narc_point find_circle_place(struct test_random *random, double half_x, double half_y) {
    const double unit = 0x1p-24 * (half_x + half_y) * pow(2, (double)random_below(random, 12));
    const double steps[] = {0, 0, 1, 2, 0.5}, least = fmin(half_x, half_y);
    const double in_x = steps[random_below(random, 5)] * unit * random_sign(random),
                 in_y = steps[random_below(random, 5)] * unit * random_sign(random);
    const double along = random_between(random, -1.2, 1.2) * random_log_between(random, 1e-6, 1);
    const narc_point places[] = {{0, 0},
                                 {half_x, half_y},
                                 {half_x, along * half_y},
                                 {along * half_x, half_y},
                                 {half_x - least * fabs(along), half_y - least * fabs(along)},
                                 {0, along * half_y},
                                 {along * half_x, 0},
                                 {half_x * 2, half_y},
                                 {half_x, half_y * 2}};
    const narc_point place = places[random_below(random, sizeof places / sizeof *places)];
    return (narc_point){random_sign(random) * place.x + in_x, random_sign(random) * place.y + in_y};
}

/* Circles anywhere near a box's, a capsule's or a circle's lines, in any order, scale and place of the world. */
TEST(test_circle_places) {
    static const double turns[] = {0, 0, PI / 2, PI, -PI / 2, 1e-7};
    struct test_random random = test_random_named("places of circles");
    for (size_t round = 0; round < test_trials(6); round++) {
        AUTO(destroy_scene) struct scene scene = create_scene((narc_precision)(round % 2), SHAPES, 2 * PAIRS, PAIRS);
        double half_x[SHAPES], half_y[SHAPES];
        for (size_t k = 0; k < SHAPES; k++) {
            const double width = random_log_between(&random, 0.1, 10), height = random_log_between(&random, 0.1, 10);
            const double radius = random_below(&random, 2) ? 0 : 0.4 * fmin(width, height) * random_unit(&random);
            const struct shape shape = k % 3 == 0   ? circle_of(k % 2 ? width : 1e-9)
                                       : k % 3 == 1 ? make_capsule(&random, width, height)
                                                    : box_of(width, height, radius);
            half_x[k] = k % 3 == 0 ? 0 : k % 3 == 1 ? width / 2 : width / 2 - radius;
            half_y[k] = k % 3 == 2 ? height / 2 - radius : 0;
            scene_add_shape(&scene, &shape);
        }
        while (scene.pair_count < PAIRS) {
            const uint32_t shape = (uint32_t)random_below(&random, SHAPES);
            const double scale = random_below(&random, 2) ? 1 : random_log_between(&random, 1e-3, 1e3);
            const double turn =
                random_below(&random, 2) ? turns[random_below(&random, 6)] : random_between(&random, -PI, PI);
            const narc_point p = find_circle_place(&random, scale * half_x[shape], scale * half_y[shape]);
            struct body a = turned_body(turn, scale), b = turned_body(random_between(&random, -PI, PI), 1);
            if (random_below(&random, 2))
                b = turned_body(turns[random_below(&random, 6)], random_log_between(&random, 1e-2, 10));
            a.shape = shape;
            b.shape = 3 * (uint32_t)random_below(&random, SHAPES / 3);
            a.x = random_below(&random, 2) ? 0 : random_between(&random, -1, 1) * random_log_between(&random, 1, 1e15);
            a.y = random_below(&random, 2) ? 0 : a.x;
            b.x = a.x + cos(turn) * p.x - sin(turn) * p.y;
            b.y = a.y + sin(turn) * p.x + cos(turn) * p.y;
            if (random_below(&random, 200) == 0)
                b = fly_away(b, random_below(&random, 24), scene.precision);
            if (random_below(&random, 2))
                scene_add_two(&scene, a, b);
            else
                scene_add_two(&scene, b, a);
        }
        check_plain_scene(&random, &scene, "places of circles");
    }
}

/* A box waits while capsules are answered, and pairs that are neither are far apart: rows stay in the order of pairs. */
TEST(test_order_of_rows) {
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 2, 400, 200);
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
}

/* Capsules and boxes come seldom, among circles, and then all at once. */
TEST(test_seldom) {
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 3, 3000, 1500);
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
}

TEST_MAIN("box_pairs")
