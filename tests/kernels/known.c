/* SPDX-License-Identifier: MIT
 *
 * known.c - cases that are known to be hard, and published ones, each with an answer that is known by heart, either way
 * round.
 */
#include <math.h>
#include <stdlib.h>

#include "scene.h"

/* What lies across the normal: an edge, or corners alone, so that the normal is this one only while they are apart. */
enum kind { ROUND, EDGE, CORNERS };

/* A at the origin, B somewhere. */
struct known {
    const char *name;
    struct shape a, b;
    double x, y, angle;
    double gap, normal_x, normal_y; /* normal 0, 0: there are several */
    enum kind kind;
    double unit;    /* not 0: with each tiny gap besides, times this */
    double scale_a; /* 0: 1 */
};

/* All frames but the first are rotated so far that nothing lies along an axis, and moved. */
static const struct frame { double x, y, angle; } frames[] = {{0, 0, 0}, {3, -7, 0.5}, {-100, 250, 3.7}};
enum { FRAMES = sizeof frames / sizeof *frames };

static const double tiny_gaps[] = {1e-3, 1e-4, 1e-5, 1e-6, -1e-6, -1e-5, -1e-4, -1e-3};
enum { TINY_GAPS = sizeof tiny_gaps / sizeof *tiny_gaps };

static struct shape polygon(const narc_point *points, size_t count) {
    struct shape shape;
    assert_int_equal(narc_build_polygon(points, count, 0, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* Two arcs of radius 5 that meet in round tips: 2 high, a little less than 6 wide. */
static struct shape make_lens(void) {
    struct shape shape;
    const narc_four_arc form = {5, 5, 8, 0.25, 0.25};
    assert_int_equal(narc_build_four_arc(&form, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

static struct body into_frame(const struct frame *frame, double x, double y, double angle, double scale) {
    struct body body = turned_body(angle + frame->angle, scale);
    body.x = frame->x + cos(frame->angle) * x - sin(frame->angle) * y;
    body.y = frame->y + sin(frame->angle) * x + cos(frame->angle) * y;
    return body;
}

/* How far the bodies of a frame are from where they should be: their rotations are rounded, which moves what lies at an
 * extent of 1 by e; the documented bound covers that many times over, so one more bound of the exact gap does. */
static double case_bound(const struct scene *scene, size_t k) {
    const struct reference_body a = scene_reference(scene, scene->pairs[k].a),
                                b = scene_reference(scene, scene->pairs[k].b);
    return 2 * NARC_ERROR_BOUND * reference_reach(&a, &b);
}

/* Where an edge lies across the normal, the gap falls at once, and its normal is told to some roundings. Else the gap
 * along n is at most the distance d times the cosine between both: one that is less than d by the bound at most has
 * 1 - cos <= bound / d. Of others that collide, the gap says all. */
static void check_answers(const struct known *known, const struct scene *scene) {
    AUTO(free_at) uint64_t *bits = scene_overlaps(scene);
    AUTO(free_at) struct contacts all = scene_contacts(scene, INFINITY);
    assert_int_equal(all.count, scene->pair_count);
    for (size_t k = 0; k < all.count; k++) {
        const narc_contact *c = &all.rows[k];
        const double angle = frames[k / 2].angle, sign = k % 2 ? -1 : 1;
        const double x = sign * (cos(angle) * known->normal_x - sin(angle) * known->normal_y),
                     y = sign * (sin(angle) * known->normal_x + cos(angle) * known->normal_y);
        const double bound = case_bound(scene, k), along = (double)c->normal_x * x + (double)c->normal_y * y;
        const double turn = known->kind == EDGE ? 1e-5 : known->gap > 0 ? bound / known->gap + 1e-6 : 2;
        const bool has_normal = x != 0 || y != 0;
        if (fabs((double)c->separation - known->gap) > bound || (has_normal && along < 1 - turn) ||
            (fabs(known->gap) > bound && bit_is_set(bits, k) != (known->gap < 0)))
            fail_msg("%s, pair %zu: bit %d, separation %.9g, not %.9g; normal (%.7g, %.7g), not (%.7g, %.7g)",
                     known->name, k, bit_is_set(bits, k), (double)c->separation, known->gap, (double)c->normal_x,
                     (double)c->normal_y, x, y);
    }
}

/* The pairs A - B and B - A in all frames; the reference has its say first. */
static void check_known(const struct known *known) {
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2, 2 * FRAMES, 2 * FRAMES);
    const uint32_t shape_a = scene_add_shape(&scene, &known->a), shape_b = scene_add_shape(&scene, &known->b);
    for (size_t f = 0; f < FRAMES; f++) {
        struct body a = into_frame(&frames[f], 0, 0, 0, known->scale_a == 0 ? 1 : known->scale_a);
        struct body b = into_frame(&frames[f], known->x, known->y, known->angle, 1);
        a.shape = shape_a;
        b.shape = shape_b;
        const uint32_t first = scene_add_body(&scene, a), second = scene_add_body(&scene, b);
        scene_add_pair(&scene, first, second);
        scene_add_pair(&scene, second, first);
    }
    for (size_t k = 0; k < scene.pair_count; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                                    b = scene_reference(&scene, scene.pairs[k].b);
        const double gap = reference_find_gap(&a, &b).gap;
        if (fabs(gap - known->gap) > case_bound(&scene, k))
            fail_msg("%s: the reference says %.12g, not %.12g", known->name, gap, known->gap);
    }
    check_answers(known, &scene);
}

/* Of two convex shapes with a middle of symmetry each, at one place, the depth is the least of the widths together,
 * halved. dyn4j: the two polygons of its tutorials on GJK and EPA; along the triangle's edge from (4, 5) to (9, 9), with
 * the normal (4, -5), the quadrilateral's (5, 7) lies 6 / sqrt(41) inside; along all other edges, more: 2 next. Box2D: its
 * unit test of distances, a square and a segment beside it, 1 apart; a segment is a capsule here, and 7/8 are left. Chaos,
 * Parry: their tests of distances. */
TEST(test_table) {
    static const narc_point three[] = {{4, 11}, {4, 5}, {9, 9}}, four[] = {{5, 7}, {7, 3}, {10, 2}, {12, 7}};
    const struct shape disc = circle_of(1), two = box_of(2, 2, 0), one = box_of(1, 1, 0), lens = make_lens(),
                       pin = capsule_of(2, 1e-3), thin = box_of(2, 2e-3, 0), pill = capsule_of(2, 0.5);
    const double d = sqrt(0.5), q = PI / 2, o = PI / 4, r = 1 / sqrt(41);
    const struct known rows[] = {
        {"circles", disc, circle_of(0.5), 1.5, 0, 0, 0, 1, 0, ROUND, 1, 0},
        {"boxes", two, one, 0.25, 1.5, 0, 0, 0, 1, EDGE, 1, 0},
        {"box and circle", two, disc, -2, 0.3, 0, 0, -1, 0, ROUND, 1, 0},
        {"lenses", lens, lens, 0, -2, 0, 0, 0, -1, ROUND, 1, 0},
        {"lens and box", lens, box_of(1, 1, 0.25), 0, 1.5, 0, 0, 0, 1, ROUND, 1, 0},
        {"capsules crosswise", capsule_of(2, 0.25), capsule_of(2, 0.25), 0.5, 1.5, q, 0, 0, 1, ROUND, 1, 0},
        {"vertex to edge", two, one, 0.4, 1 + d, o, 0, 0, 1, EDGE, 1, 0},
        {"edge to vertex", two, one, 1 + d / 2, 1 + d / 2, o, 0, d, d, EDGE, 1, 0},
        {"vertex to vertex", two, one, 1.5, 1.5, 0, 0, 0.6, 0.8, CORNERS, 1, 0},
        {"corner to corner", two, two, 5, 6, 0, 5, 0.6, 0.8, CORNERS, 0, 0},
        {"deep in a box", box_of(10, 8, 0), one, 2, 1.5, 0, -3, 0, 1, EDGE, 0, 0},
        {"circle deep in a box", box_of(10, 8, 0), circle_of(0.5), -4, 0.25, 0, -1.5, -1, 0, ROUND, 0, 0},
        {"circle in a circle", circle_of(4), disc, 1, 1, 0, 2 * d - 5, d, d, ROUND, 0, 0},
        {"circle in its place", disc, disc, 0, 0, 0, -2, 0, 0, ROUND, 0, 0},
        {"box across a box", box_of(4, 1, 0), box_of(1, 4, 0), 0, 0, 0, -2.5, 0, 0, EDGE, 0, 0},
        {"capsule across a capsule", capsule_of(4, 0.5), capsule_of(4, 0.5), 0, 0, q, -3, 0, 0, ROUND, 0, 0},
        {"square in its place", two, two, 0, 0, 0, -2, 0, 0, EDGE, 0, 0},
        {"square in its place, turned", two, two, 0, 0, o, -1 - 2 * d, 0, 0, EDGE, 0, 0},
        {"rounded box in its place", box_of(4, 2, 0.5), box_of(4, 2, 0.5), 0, 0, 0, -2, 0, 0, ROUND, 0, 0},
        {"lens in its place", lens, lens, 0, 0, 0, -2, 0, 0, ROUND, 0, 0},
        {"capsule in its place", pill, pill, 0, 0, 0, -1, 0, 0, ROUND, 0, 0},
        {"face to face", two, one, 0, 1.5, 0, 0, 0, 1, EDGE, 1, 0},
        {"face to face", two, one, 0.5, 1.5, 0, 0, 0, 1, EDGE, 1, 0},
        {"face to face, hanging over", two, one, 1.25, 1.5, 0, 0, 0, 1, EDGE, 1, 0},
        {"face to face, at the end", two, one, 1.49, 1.5, 0, 0, 0, 1, EDGE, 1, 0},
        {"face to face, half inside", two, two, 0.5, 1.5, 0, -0.5, 0, 1, EDGE, 0, 0},
        {"capsule on a box", pill, box_of(2, 1, 0), 0, 1, 0, 0, 0, 1, EDGE, 1, 0},
        {"capsule on a box", pill, box_of(2, 1, 0), 0.5, 1, 0, 0, 0, 1, EDGE, 1, 0},
        {"capsule on a box's end", pill, box_of(2, 1, 0), 1.49, 1, 0, 0, 0, 1, EDGE, 1, 0},
        {"needles side by side", pin, pin, 0.3, 2e-3, 0, 0, 0, 1, ROUND, 1e-3, 0},
        {"thin boxes side by side", thin, thin, -0.7, 2e-3, 0, 0, 0, 1, EDGE, 1e-3, 0},
        {"needle's tip to a side", pin, pin, 0.2, 1.002, q, 0, 0, 1, ROUND, 1e-3, 0},
        {"thin box's end to a side", thin, thin, 0.2, 1.001, q, 0, 0, 1, EDGE, 1e-3, 0},
        {"needles crosswise", pin, pin, 0, 0, q, -1.002, 0, 0, ROUND, 0, 0},
        {"needles far apart", pin, pin, 5, 3, 0, 6 * d - 2e-3, d, d, ROUND, 0, 0},
        {"on a large circle", disc, disc, 0, 10001, 0, 0, 0, 1, ROUND, 100, 1e4},
        {"on a large box", two, two, 17, 10001, 0, 0, 0, 1, EDGE, 100, 1e4},
        {"deep in a large box", two, lens, -5e3, 0, q, -5001, -1, 0, ROUND, 0, 1e4},
        {"dyn4j", polygon(three, 3), polygon(four, 4), 0, 0, 0, -6 * r, 4 * r, -5 * r, EDGE, 0, 0},
        {"Box2D", two, capsule_of(2, 0.125), 2, 0, q, 0.875, 1, 0, ROUND, 0, 0},
        {"Chaos", circle_of(5), circle_of(2), -8, 0, 0, 1, -1, 0, ROUND, 0, 0},
        {"Chaos", circle_of(2), circle_of(2), 3, 3, 0, 6 * d - 4, d, d, ROUND, 0, 0},
        {"Parry", two, disc, 0, 3, 0, 1, 0, 1, ROUND, 0, 0},
        {"Parry", two, disc, 0, 1, 0, -1, 0, 1, ROUND, 0, 0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct known known = rows[k];
        const size_t gaps = known.unit == 0 ? 1 : known.kind == CORNERS ? TINY_GAPS / 2 : TINY_GAPS;
        for (size_t g = 0; g < gaps; g++) {
            const double more = known.unit * tiny_gaps[g];
            known.x = rows[k].x + more * known.normal_x;
            known.y = rows[k].y + more * known.normal_y;
            known.gap = rows[k].gap + more;
            check_known(&known);
        }
    }
}

/* libccd's test suite, boxes along x: one of 1 x 2 is led through one of 2 x 1, in steps of a tenth from -5 on. They touch
 * at steps 35 and 65. */
TEST(test_libccd) {
    struct known known = {.name = "libccd", .a = box_of(2, 1, 0), .b = box_of(1, 2, 0), .kind = EDGE};
    for (int step = 0; step < 100; step++) {
        known.x = -5 + 0.1 * step;
        known.gap = fmax(fabs(known.x) - 1.5, -1.5);
        known.normal_x = known.gap > -1.5 + 1e-9 ? (known.x > 0 ? 1 : -1) : 0;
        check_known(&known);
    }
}

TEST_MAIN("known")
