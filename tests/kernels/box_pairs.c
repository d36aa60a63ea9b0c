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

#include "check.h"
#include "layouts.h"
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

static struct shape make_form(struct test_random *random, enum sizes sizes, double unit, bool capsule) {
    const double spread = sizes == THIN ? 1e3 : 4;
    double width = random_log_between(random, 1 / spread, spread),
           height = random_log_between(random, 1 / spread, spread);
    if (sizes == LATTICE || sizes == ALIKE) {
        width = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
        height = sizes == ALIKE ? 1 : 0.25 * (double)(1 + random_below(random, 6));
    }
    if (capsule)
        return make_capsule(random, width * unit, height * unit);
    const double least = fmin(width, height);
    const double radii[] = {0, 0, 0.0625, least * random_unit(random) / 2, least * 1e-7, least * 0.4999999};
    const double radius = fmin(radii[random_below(random, 6)], least / 4 * (1 + random_unit(random)));
    return box_of(width * unit, height * unit, radius * unit);
}

/* One that starts with another arc, or a shape that has no such form: turned, elsewhere, or something else. */
static struct shape make_other(struct test_random *random, double unit) {
    struct shape shape = make_form(random, USUAL, unit, random_below(random, 2));
    const size_t kind = random_below(random, 5);
    const double turns[] = {0.5, PI / 2}, turn = kind == 2 || kind == 4 ? turns[kind == 4] : 0;
    const double move = kind == 1 ? unit * random_between(random, -1, 1) : 0;
    struct shape other = {.count = shape.count};
    if (kind == 3)
        return random_below(random, 2) ? circle_of(unit) : capsule_of(unit * 1e-7, unit);
    for (size_t i = 0; i < shape.count; i++) {
        const narc_arc arc = shape.arcs[(i + 1) % shape.count];
        other.arcs[i] = (narc_arc){cos(turn) * arc.center_x - sin(turn) * arc.center_y + move,
                                   sin(turn) * arc.center_x + cos(turn) * arc.center_y, arc.radius, arc.start + turn,
                                   arc.end + turn};
    }
    return other;
}

/* A multiple of 45 degrees exactly, or beside it by a few units in the last place, or by any small angle. */
static void turn_nearly(struct test_random *random, struct body *body, size_t steps) {
    const double turn = PI / (double)steps * (double)random_below(random, 2 * steps);
    const double beside = (random_below(random, 2) ? 1 : -1) * random_log_between(random, 1e-10, 1e-2);
    const size_t kind = random_below(random, 4);
    body->cosine = (float)cos(turn + (kind == 3 ? beside : 0));
    body->sine = (float)sin(turn + (kind == 3 ? beside : 0));
    body->cosine = fabsf(body->cosine) < 1e-9f ? 0 : body->cosine;
    body->sine = fabsf(body->sine) < 1e-9f ? 0 : body->sine;
    if (kind == 1) {
        body->cosine += (float)random_between(random, -3, 3) * 0x1p-24f;
        body->sine += (float)random_between(random, -3, 3) * 0x1p-24f;
    }
    if (random_below(random, 8) == 0) { /* zeros of either sign */
        body->cosine = body->cosine == 0 ? -0.0f : body->cosine;
        body->sine = body->sine == 0 ? -0.0f : body->sine;
    }
}

static void turn(struct test_random *random, struct body *body) {
    const double angle = random_between(random, -PI, PI);
    const float drift = random_below(random, 3) ? 1 : (float)(1 + 2e-4 * random_between(random, -1, 1));
    body->cosine = (float)cos(angle);
    body->sine = (float)sin(angle);
    if (random_below(random, 2))
        turn_nearly(random, body, random_below(random, 2) ? 4 : 2);
    body->cosine *= drift;
    body->sine *= drift;
}

/* The rotation of a body times a nearly exact multiple of 90 or 45 degrees, or the same. */
static void turn_like(struct test_random *random, struct body *body, const struct body *other) {
    struct body by = {.cosine = 1};
    if (random_below(random, 4))
        turn_nearly(random, &by, random_below(random, 4) ? 2 : 4);
    body->cosine = other->cosine * by.cosine - other->sine * by.sine;
    body->sine = other->sine * by.cosine + other->cosine * by.sine;
}

/* How far a box or a capsule reaches along its own axes, turned by an angle of which these are cosine and sine. */
static double reach(const struct shape *box, double c, double s) {
    const narc_arc *arc = &box->arcs[0];
    return fabs(c) * fabs(arc->center_x) + fabs(s) * fabs(arc->center_y) + arc->radius;
}

/* Puts B somewhere at A: side against side, corner against corner, one inside the other, or anywhere near. */
static void place(struct test_random *random, const struct scene *scene, const struct body *a, struct body *b,
                  bool grid) {
    const struct shape *of_a = &scene->shapes[a->shape], *of_b = &scene->shapes[b->shape];
    const size_t side = random_below(random, 4);
    const double c_a = (double)a->cosine, s_a = (double)a->sine;
    const double x = side % 2 ? -s_a : c_a, y = side % 2 ? c_a : s_a, sign = side / 2 ? -1 : 1;
    const double c = x * (double)b->cosine + y * (double)b->sine, s = x * (double)b->sine - y * (double)b->cosine;
    const double up_a = (double)a->scale * reach(of_a, side % 2 ? 0 : 1, side % 2 ? 1 : 0);
    const double wide_a = (double)a->scale * reach(of_a, side % 2 ? 1 : 0, side % 2 ? 0 : 1);
    const double up_b = (double)b->scale * reach(of_b, c, s), wide_b = (double)b->scale * reach(of_b, s, c);
    const double tiny = random_between(random, -1, 1) * random_log_between(random, 1e-8, 0.1);
    const double ups[] = {up_a + up_b,
                          (up_a + up_b) * (1 + tiny),
                          up_a + up_b - random_unit(random) * fmin(up_a, up_b),
                          up_a + up_b + tiny * fmin(up_a, up_b),
                          0,
                          2 * random_unit(random) * (up_a + up_b)};
    const double alongs[] = {0,
                             wide_a + wide_b,
                             wide_a - wide_b,
                             (wide_a + wide_b) * (1 + tiny),
                             (wide_a + wide_b) * random_unit(random),
                             (wide_a + wide_b) * random_unit(random)};
    double up = sign * ups[random_below(random, 6)], along = alongs[random_below(random, 6)];
    along = random_below(random, 2) ? -along : along;
    if (grid) {
        up = 0.125 * nearbyint(8 * up);
        along = 0.125 * nearbyint(8 * along);
    }
    b->x = a->x + x * up - y * along;
    b->y = a->y + y * up + x * along;
}

/* Puts a corner of B straight before a corner of A, or behind it, along the normal of an edge of either. */
static void place_corner(struct test_random *random, const struct scene *scene, const struct body *a, struct body *b) {
    const struct shape *const shapes[2] = {&scene->shapes[a->shape], &scene->shapes[b->shape]};
    const struct body *const bodies[2] = {a, b};
    const size_t of = random_below(random, 2), edge = random_below(random, shapes[of]->count);
    const double angle = shapes[of]->arcs[edge].start, x = round(cos(angle)), y = round(sin(angle));
    const double c = (double)bodies[of]->cosine, s = (double)bodies[of]->sine;
    double at[2][2], radii = 0;
    for (int side = 0; side < 2; side++) {
        const narc_arc *arc = &shapes[side]->arcs[random_below(random, shapes[side]->count)];
        const double scale = (double)bodies[side]->scale;
        const double turned_c = scale * (double)bodies[side]->cosine, turned_s = scale * (double)bodies[side]->sine;
        at[side][0] = turned_c * arc->center_x - turned_s * arc->center_y;
        at[side][1] = turned_s * arc->center_x + turned_c * arc->center_y;
        radii += scale * arc->radius;
    }
    const double beside = radii + random_log_between(random, 1e-7, 1) * (double)a->scale * shapes[0]->arcs[0].center_x;
    b->x = a->x + at[0][0] - at[1][0] + beside * (c * x - s * y);
    b->y = a->y + at[0][1] - at[1][1] + beside * (s * x + c * y);
}

static struct scene make_boxes(struct test_random *random, enum sizes sizes, enum kinds kinds) {
    const bool mixed = kinds == OTHERS;
    const narc_precision precision = random_below(random, 2) ? NARC_FLOAT64 : NARC_FLOAT32;
    struct scene scene = create_scene(precision, SHAPES, 2 * PAIRS, PAIRS);
    const double units[] = {1, 1, 1e-5, 3e4}, unit = sizes == LATTICE ? 1 : units[random_below(random, 4)];
    const double far = random_below(random, 3) ? unit : unit * random_log_between(random, 1, 1e4);
    for (size_t k = 0; k < SHAPES; k++) {
        const bool capsule = kinds == CAPSULES || (kinds != BOXES && random_below(random, 2));
        const struct shape shape =
            mixed && k % 4 == 0 ? make_other(random, unit) : make_form(random, sizes, unit, capsule);
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < PAIRS; k++) {
        const bool grid = sizes == LATTICE && random_below(random, 4);
        struct body a = {.cosine = 1, .scale = 1}, b = {.scale = 1};
        a.shape = (uint32_t)random_below(random, SHAPES);
        b.shape = random_below(random, 4) ? (uint32_t)random_below(random, SHAPES) : a.shape;
        if (random_below(random, 4) == 0 && sizes != LATTICE) {
            a.scale = (float)random_log_between(random, 0.01, 100);
            b.scale = random_below(random, 2) ? a.scale : (float)random_log_between(random, 0.01, 100);
        }
        a.x = far * random_between(random, -1, 1);
        a.y = far * random_between(random, -1, 1);
        if (grid) {
            a.x = nearbyint(a.x);
            a.y = nearbyint(a.y);
            turn_nearly(random, &a, 2);
        } else {
            turn(random, &a);
        }
        turn_like(random, &b, &a);
        if (random_below(random, 4) == 0)
            turn(random, &b);
        if (mixed && random_below(random, 40) == 0)
            b.sine = NAN;
        if (random_below(random, 4))
            place(random, &scene, &a, &b, grid);
        else
            place_corner(random, &scene, &a, &b);
        scene_add_two(&scene, a, b);
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

/* Hints are those of contacts: overlaps leave them alone. */
TEST(test_overlaps_without_hints) {
    struct test_random random = test_random_named("hints");
    struct scene scene = make_boxes(&random, USUAL, OTHERS);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    uint32_t *hints = malloc(pairs.count * sizeof *hints);
    for (size_t k = 0; k < pairs.count; k++)
        hints[k] = 0xdead0000u + (uint32_t)k;
    free(find_overlaps(scene.store, &bodies, &pairs, &(narc_query){.hints = NARC_HINT_ARRAY(hints)}));
    for (size_t k = 0; k < pairs.count; k++)
        assert_int_equal(hints[k], 0xdead0000u + (uint32_t)k);
    free(hints);
    destroy_scene(&scene);
}

TEST_MAIN("box_pairs")
