/* SPDX-License-Identifier: MIT
 *
 * known.c - cases that are known to be hard, and published ones, each with an answer that is known by heart: every
 * method that can must give it, either way round.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "methods.h"

/* ------------------------------------------------------------------------------------------------ shapes */

static struct shape polygon(const narc_point *point, size_t count) {
    struct shape shape;
    assert_int_equal(narc_build_polygon(point, count, 0, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* Two arcs of radius 5 that meet in round tips; 2 high, a little less than 6 wide. */
static struct shape lens(void) {
    struct shape shape;
    const narc_four_arc form = {5, 5, 8, 0.25, 0.25};
    assert_int_equal(narc_build_four_arc(form, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* ------------------------------------------------------------------------------------------------ one case */

struct known {
    struct shape a, b;
    double x, y, angle;               /* of B; A is at the origin, unless: */
    double angle_a, scale_a, scale_b; /* scales of 0 mean 1 */
    double gap;
    double normal_x, normal_y; /* 0, 0: there are several */
};

/* Both rotated so far that nothing lies along an axis, and moved there, or not. */
struct frame {
    double x, y, angle;
};
static const struct frame frames[] = {{0, 0, 0}, {3, -7, 0.5}, {-100, 250, 3.7}};
enum { FRAMES = sizeof frames / sizeof *frames };

static struct body place(const struct frame *frame, double x, double y, double angle, double scale) {
    struct body body = turned_body(angle + frame->angle, scale == 0 ? 1 : scale);
    body.x = frame->x + cos(frame->angle) * x - sin(frame->angle) * y;
    body.y = frame->y + sin(frame->angle) * x + cos(frame->angle) * y;
    return body;
}

/* The pairs A - B and B - A in all frames. */
static struct scene make_known_scene(const struct known *known) {
    struct scene scene = create_scene(NARC_FLOAT64, 2, 2 * FRAMES, 2 * FRAMES);
    const uint32_t shape_a = scene_add_shape(&scene, &known->a), shape_b = scene_add_shape(&scene, &known->b);
    for (size_t f = 0; f < FRAMES; f++) {
        struct body a = place(&frames[f], 0, 0, known->angle_a, known->scale_a);
        struct body b = place(&frames[f], known->x, known->y, known->angle, known->scale_b);
        a.shape = shape_a;
        b.shape = shape_b;
        const uint32_t first = scene_add_body(&scene, a), second = scene_add_body(&scene, b);
        scene_add_pair(&scene, first, second);
        scene_add_pair(&scene, second, first);
    }
    return scene;
}

/* How far the bodies of a frame are from where they should be: their rotations are rounded, which moves what lies at an
 * extent of 1 by e; the documented bound covers that many times over, so one more bound of the exact gap does. */
static double case_bound(const struct reference_body *a, const struct reference_body *b) {
    return 2 * NARC_ERROR_BOUND * reference_reach(a, b);
}

/* How far from 1 the product of the normal told and the right one may be. The distance d of two bodies is the length of
 * a vector v between them, the gap along n is at most v.n = d cos, so one that is less than d by `allowed` at most has
 * 1 - cos <= allowed / d. Where an edge lies across the normal, the gap falls at once, and the exact methods have its
 * normal to some roundings. Of others that collide, the gap says all. */
static double allowed_turn(const struct known *known, bool edge, bool exact, double allowed) {
    if (edge && exact)
        return 1e-5;
    return known->gap > 0 ? allowed / known->gap + 1e-6 : 2;
}

static void check_known_contacts(const char *name, const struct scene *scene, const struct known *known, bool edge,
                                 const narc_method_options *options) {
    uint8_t outcomes[2 * FRAMES];
    narc_method_options with_outcomes = *options;
    with_outcomes.out_outcomes = outcomes;
    uint64_t *bits = query_overlaps(scene, options, NULL);
    struct contacts all = query_contacts(scene, &with_outcomes, &(narc_query){.margin = INFINITY});
    for (size_t k = 0; k < all.count; k++) {
        const struct reference_body a = scene_reference(scene, scene->pairs[k].a),
                                    b = scene_reference(scene, scene->pairs[k].b);
        const double bound = case_bound(&a, &b), separation = (double)all.rows[k].separation;
        const double gjk = options->method == NARC_METHOD_GJK ? (double)options->tolerance : 0;
        /* All sizes are the extents, or less. */
        const double allowed = bound + gjk * (reference_extent(&a) + reference_extent(&b));
        const double angle = frames[k / 2].angle, sign = k % 2 ? -1 : 1;
        const double x = sign * (cos(angle) * known->normal_x - sin(angle) * known->normal_y),
                     y = sign * (sin(angle) * known->normal_x + cos(angle) * known->normal_y);
        const double along = (double)all.rows[k].normal_x * x + (double)all.rows[k].normal_y * y;
        const bool wrong_normal = (x != 0 || y != 0) && along < 1 - allowed_turn(known, edge, gjk == 0, allowed);
        const bool wrong_bit = fabs(known->gap) > bound && bit_is_set(bits, k) != (known->gap < 0);
        if (outcomes[k] != NARC_OUTCOME_DONE || separation > known->gap + bound || separation < known->gap - allowed ||
            wrong_normal || wrong_bit) {
            fail_msg("%s, %s, tolerance %g, pair %zu: outcome %u, bit %d, separation %.9g, not %.9g; normal (%.7g, "
                     "%.7g), not (%.7g, %.7g)",
                     name, narc_method_name(options->method), (double)options->tolerance, k, outcomes[k],
                     bit_is_set(bits, k), separation, known->gap, (double)all.rows[k].normal_x,
                     (double)all.rows[k].normal_y, x, y);
        }
    }
    free(bits);
    free(all.rows);
}

static bool is_polygon(const struct shape *shape) {
    bool polygon = true;
    for (size_t i = 0; i < shape->count; i++)
        polygon = polygon && shape->arcs[i].radius == 0;
    return polygon;
}

/* The reference, every method, and the filters where bodies collide. `edge`: the separation is along an edge's normal,
 * so that polygon-sat has it, too. */
static void check_known(const char *name, const struct known *known, bool edge) {
    struct scene scene = make_known_scene(known);
    for (size_t k = 0; k < scene.pair_count; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                                    b = scene_reference(&scene, scene.pairs[k].b);
        const double gap = reference_find_gap(&a, &b).gap;
        if (fabs(gap - known->gap) > case_bound(&a, &b))
            fail_msg("%s: the reference says %.12g, not %.12g", name, gap, known->gap);
    }
    check_known_contacts(name, &scene, known, edge, &(narc_method_options){.method = NARC_METHOD_SAT});
    static const float tolerances[] = {1e-3f, 1e-4f, 1e-5f, 1e-6f};
    for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
        check_known_contacts(name, &scene, known, edge,
                             &(narc_method_options){.method = NARC_METHOD_GJK, .tolerance = tolerances[t]});
    }
    if (edge && is_polygon(&known->a) && is_polygon(&known->b))
        check_known_contacts(name, &scene, known, edge, &(narc_method_options){.method = NARC_METHOD_POLYGON_SAT});
    for (int f = NARC_METHOD_CIRCLE; known->gap < 0 && f <= NARC_METHOD_OBB; f++) {
        uint64_t *bits = query_overlaps(&scene, &(narc_method_options){.method = (narc_method)f}, NULL);
        for (size_t k = 0; k < scene.pair_count; k++)
            assert_true(bit_is_set(bits, k));
        free(bits);
    }
    destroy_scene(&scene);
}

/* ------------------------------------------------------------------------------------------------ hard ones */

static const double tiny_gaps[] = {1e-3, 1e-4, 1e-5, 1e-6, -1e-6, -1e-5, -1e-4, -1e-3};
enum { TINY_GAPS = sizeof tiny_gaps / sizeof *tiny_gaps };

TEST(test_nearly_touching) {
    for (int k = 0; k < TINY_GAPS; k++) {
        const double gap = tiny_gaps[k];
        check_known("circles", &(struct known){circle_of(1), circle_of(0.5), 1.5 + gap, 0, .gap = gap, .normal_x = 1},
                    false);
        check_known("boxes",
                    &(struct known){box_of(2, 2, 0), box_of(1, 1, 0), 0.25, 1.5 + gap, .gap = gap, .normal_y = 1},
                    true);
        check_known("box and circle",
                    &(struct known){box_of(2, 2, 0), circle_of(1), -2 - gap, 0.3, .gap = gap, .normal_x = -1}, false);
        check_known("lenses", &(struct known){lens(), lens(), 0, -2 - gap, .gap = gap, .normal_y = -1}, false);
        check_known("lens and box",
                    &(struct known){lens(), box_of(1, 1, 0.25), 0, 1.5 + gap, .gap = gap, .normal_y = 1}, false);
        check_known("capsules crosswise",
                    &(struct known){capsule_of(2, 0.25), capsule_of(2, 0.25), 0.5, 1.5 + gap, PI / 2, .gap = gap,
                                    .normal_y = 1},
                    false);
    }
}

/* The corner of a box turned by 45 degrees over the middle of another one's side, and over its corner. */
TEST(test_vertices) {
    const double corner = sqrt(0.5);
    for (int k = 0; k < TINY_GAPS; k++) {
        const double gap = tiny_gaps[k];
        check_known(
            "vertex to edge",
            &(struct known){box_of(2, 2, 0), box_of(1, 1, 0), 0.4, 1 + corner + gap, PI / 4, .gap = gap, .normal_y = 1},
            true);
        check_known("edge to vertex",
                    &(struct known){box_of(2, 2, 0), box_of(1, 1, 0), 1 + corner * (0.5 + gap),
                                    1 + corner * (0.5 + gap), PI / 4, .gap = gap, .normal_x = corner,
                                    .normal_y = corner},
                    true);
        if (gap > 0) {
            check_known("vertex to vertex",
                        &(struct known){box_of(2, 2, 0), box_of(1, 1, 0), 1.5 + 0.6 * gap, 1.5 + 0.8 * gap, .gap = gap,
                                        .normal_x = 0.6, .normal_y = 0.8},
                        false);
        }
    }
    /* Apart by 3 and 4: corner to corner is 5, along an edge's normal it is 4. */
    const struct known far = {box_of(2, 2, 0), box_of(2, 2, 0), 2 + 3,          2 + 4,
                              .gap = 5,        .normal_x = 0.6, .normal_y = 0.8};
    check_known("corner to corner", &far, false);
    struct scene scene = make_known_scene(&far);
    struct contacts found = query_contacts(&scene, &(narc_method_options){.method = NARC_METHOD_POLYGON_SAT},
                                           &(narc_query){.margin = INFINITY});
    for (size_t k = 0; k < found.count; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                                    b = scene_reference(&scene, scene.pairs[k].b);
        assert_true(fabs((double)found.rows[k].separation - 4) <= case_bound(&a, &b));
    }
    free(found.rows);
    destroy_scene(&scene);
}

/* Deep in each other. Of two convex shapes with a middle of symmetry each, at one place, the depth is the least of the
 * widths together, halved. */
TEST(test_deep) {
    check_known("small box deep in a large one",
                &(struct known){box_of(10, 8, 0), box_of(1, 1, 0), 2, 1.5, .gap = -(4 - 1.5 + 0.5), .normal_y = 1},
                true);
    check_known("small circle deep in a box",
                &(struct known){box_of(10, 8, 0), circle_of(0.5), -4, 0.25, .gap = -1.5, .normal_x = -1}, false);
    check_known("circle in a circle",
                &(struct known){circle_of(4), circle_of(1), 1, 1, .gap = sqrt(2) - 5, .normal_x = sqrt(0.5),
                                .normal_y = sqrt(0.5)},
                false);
    check_known("box across a box", &(struct known){box_of(4, 1, 0), box_of(1, 4, 0), .gap = -2.5}, true);
    check_known("capsule across a capsule",
                &(struct known){capsule_of(4, 0.5), capsule_of(4, 0.5), 0, 0, PI / 2, .gap = -3}, false);
}

/* One in the same place as the other. */
TEST(test_equal_places) {
    check_known("square in its place", &(struct known){box_of(2, 2, 0), box_of(2, 2, 0), .gap = -2}, true);
    check_known("square in its place, turned",
                &(struct known){box_of(2, 2, 0), box_of(2, 2, 0), 0, 0, PI / 4, .gap = -(1 + sqrt(2))}, true);
    check_known("rounded box in its place", &(struct known){box_of(4, 2, 0.5), box_of(4, 2, 0.5), .gap = -2}, false);
    check_known("lens in its place", &(struct known){lens(), lens(), .gap = -2}, false);
    check_known("capsule in its place", &(struct known){capsule_of(2, 0.5), capsule_of(2, 0.5), .gap = -1}, false);
}

/* Circles in one place: every direction is as good. EPA's polygon with n corners comes as near as 1 - cos(pi / n) of
 * the sum of radii, so that a tolerance of 1e-2 takes 23 of them, and one of 1e-6 more than there may be: it ends with
 * LIMIT then, though what it has found is right. */
TEST(test_circles_in_one_place) {
    const struct known known = {circle_of(1), circle_of(1), .gap = -2};
    struct scene scene = make_known_scene(&known);
    check_known_contacts("circles in one place", &scene, &known, false,
                         &(narc_method_options){.method = NARC_METHOD_SAT});
    check_known_contacts("circles in one place", &scene, &known, false,
                         &(narc_method_options){.method = NARC_METHOD_GJK, .tolerance = 1e-2f});
    uint8_t outcomes[2 * FRAMES];
    /* 8 points and the triangle's 3 are too few. */
    const narc_method_options few = {
        .method = NARC_METHOD_GJK, .tolerance = 1e-2f, .iterations = 8, .out_outcomes = outcomes};
    struct contacts rough = query_contacts(&scene, &few, &(narc_query){.margin = INFINITY});
    for (size_t k = 0; k < rough.count; k++)
        assert_int_equal(outcomes[k], NARC_OUTCOME_LIMIT);
    free(rough.rows);
    const narc_method_options options = {.method = NARC_METHOD_GJK, .tolerance = 1e-6f, .out_outcomes = outcomes};
    struct contacts found = query_contacts(&scene, &options, &(narc_query){.margin = INFINITY});
    for (size_t k = 0; k < found.count; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                                    b = scene_reference(&scene, scene.pairs[k].b);
        assert_int_equal(outcomes[k], NARC_OUTCOME_LIMIT);
        assert_true(fabs((double)found.rows[k].separation + 2) <= case_bound(&a, &b));
    }
    free(found.rows);
    uint64_t *bits = query_overlaps(&scene, &options, NULL);
    for (size_t k = 0; k < scene.pair_count; k++) {
        assert_true(bit_is_set(bits, k));
        assert_int_equal(outcomes[k], NARC_OUTCOME_DONE);
    }
    free(bits);
    /* The first of Algorithm 2's arcs has no direction to look along. */
    bits =
        query_overlaps(&scene, &(narc_method_options){.method = NARC_METHOD_SAT_FIRST, .out_outcomes = outcomes}, NULL);
    for (size_t k = 0; k < scene.pair_count; k++) {
        assert_false(bit_is_set(bits, k));
        assert_int_equal(outcomes[k], NARC_OUTCOME_NONE);
    }
    free(bits);
    destroy_scene(&scene);
}

/* Side to side, shifted along it. */
TEST(test_parallel_edges) {
    static const double shifts[] = {0, 0.5, 1.25, 1.49};
    for (size_t s = 0; s < sizeof shifts / sizeof *shifts; s++) {
        for (int k = 0; k < TINY_GAPS; k++) {
            const double gap = tiny_gaps[k], shift = shifts[s];
            check_known("face to face",
                        &(struct known){box_of(2, 2, 0), box_of(1, 1, 0), shift, 1.5 + gap, .gap = gap, .normal_y = 1},
                        true);
            check_known("capsule on a box",
                        &(struct known){capsule_of(2, 0.5), box_of(2, 1, 0), shift, 1 + gap, .gap = gap, .normal_y = 1},
                        true);
        }
    }
    check_known("face to face, half inside",
                &(struct known){box_of(2, 2, 0), box_of(2, 2, 0), 0.5, 1.5, .gap = -0.5, .normal_y = 1}, true);
}

/* 1 : 1000, lengthwise, crosswise, and tip to side. */
TEST(test_needles) {
    for (int k = 0; k < TINY_GAPS; k++) {
        const double gap = tiny_gaps[k] / 1000;
        check_known(
            "needles side by side",
            &(struct known){capsule_of(2, 1e-3), capsule_of(2, 1e-3), 0.3, 2e-3 + gap, .gap = gap, .normal_y = 1},
            false);
        check_known(
            "thin boxes side by side",
            &(struct known){box_of(2, 2e-3, 0), box_of(2, 2e-3, 0), -0.7, 2e-3 + gap, .gap = gap, .normal_y = 1}, true);
        check_known("needle's tip to a needle's side",
                    &(struct known){capsule_of(2, 1e-3), capsule_of(2, 1e-3), 0.2, 1 + 2e-3 + gap, PI / 2, .gap = gap,
                                    .normal_y = 1},
                    false);
        check_known("thin box's end to a side",
                    &(struct known){box_of(2, 2e-3, 0), box_of(2, 2e-3, 0), 0.2, 1 + 1e-3 + gap, PI / 2, .gap = gap,
                                    .normal_y = 1},
                    true);
    }
    check_known("needles crosswise",
                &(struct known){capsule_of(2, 1e-3), capsule_of(2, 1e-3), 0, 0, PI / 2, .gap = -1.002}, false);
    check_known("needles far apart",
                &(struct known){capsule_of(2, 1e-3), capsule_of(2, 1e-3), 5, 3, .gap = hypot(3, 3) - 2e-3,
                                .normal_x = sqrt(0.5), .normal_y = sqrt(0.5)},
                false);
}

/* A small body at, on and in a large one. */
TEST(test_size_ratios) {
    const double ratio = 1e4;
    for (int k = 0; k < TINY_GAPS; k++) {
        const double gap = tiny_gaps[k] * 100;
        const struct known on_circle = {circle_of(1), circle_of(1), 0, ratio + 1 + gap, .scale_a = ratio,
                                        .gap = gap,   .normal_y = 1};
        const struct known on_box = {box_of(2, 2, 0),  box_of(2, 2, 0), 17,           ratio + 1 + gap,
                                     .scale_a = ratio, .gap = gap,      .normal_y = 1};
        check_known("on a large circle", &on_circle, false);
        check_known("on a large box", &on_box, true);
    }
    check_known("deep in a large box",
                &(struct known){box_of(2, 2, 0), lens(), -ratio / 2, 0, .scale_a = ratio, .angle = PI / 2,
                                .gap = -ratio / 2 - 1, .normal_x = -1},
                false);
}

/* ------------------------------------------------------------------------------------------------ published ones */

/* The two polygons of dyn4j's tutorials on GJK and EPA: a triangle and a quadrilateral that collide. Along the
 * triangle's edge from (4, 5) to (9, 9), with the normal (4, -5), the quadrilateral's (5, 7) lies 6 / sqrt(41) inside;
 * along all other edges, more: 2 next. */
TEST(test_dyn4j) {
    static const narc_point triangle[] = {{4, 11}, {4, 5}, {9, 9}}, other[] = {{5, 7}, {7, 3}, {10, 2}, {12, 7}};
    check_known("dyn4j",
                &(struct known){polygon(triangle, 3), polygon(other, 4), .gap = -6 / sqrt(41), .normal_x = 4 / sqrt(41),
                                .normal_y = -5 / sqrt(41)},
                true);
}

/* Box2D's unit test of the distance of shapes: a square and a segment beside it, at a distance of 1. A segment is a
 * capsule here: with a radius of 1/8, 7/8 are left. */
TEST(test_box2d) {
    check_known("Box2D",
                &(struct known){box_of(2, 2, 0), capsule_of(2, 0.125), 2, 0, PI / 2, .gap = 0.875, .normal_x = 1},
                false);
}

/* libccd's test suite, boxes along x: one of 1 x 2 is led through one of 2 x 1, in steps of a tenth from -5 on. They
 * touch at steps 35 and 65. */
TEST(test_libccd) {
    for (int step = 0; step < 100; step++) {
        const double x = -5 + 0.1 * step, apart = fabs(x) - 1.5;
        struct known known = {box_of(2, 1, 0), box_of(1, 2, 0), x, 0, .gap = fmax(apart, -1.5)};
        known.normal_x = apart > -1.5 + 1e-9 ? (x > 0 ? 1 : -1) : 0;
        check_known("libccd", &known, true);
    }
}

/* The tests of distances in Unreal's Chaos (circles of radius 5 and 2, centres 8 apart: 1; of radius 2, centres 3 and 3
 * apart), of Parry (a box of 2 x 2 and a circle of radius 1, 3 above: 1; 1 above: colliding). */
TEST(test_distances) {
    check_known("circles, 8 apart", &(struct known){circle_of(5), circle_of(2), -8, 0, .gap = 1, .normal_x = -1},
                false);
    check_known("circles, 3 and 3 apart",
                &(struct known){circle_of(2), circle_of(2), 3, 3, .gap = sqrt(18) - 4, .normal_x = sqrt(0.5),
                                .normal_y = sqrt(0.5)},
                false);
    check_known("circle over a box", &(struct known){box_of(2, 2, 0), circle_of(1), 0, 3, .gap = 1, .normal_y = 1},
                false);
    check_known("circle in a box's side",
                &(struct known){box_of(2, 2, 0), circle_of(1), 0, 1, .gap = -1, .normal_y = 1}, false);
}

/* A circle is two cones of half a turn, and the vector between the centres lies on the line where they meet: sat-first
 * must find it in one of them. */
TEST(test_first_at_the_seam) {
    static const float turns[][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0.6f, 0.8f}};
    const struct shape disc = circle_of(1);
    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
        for (int side = -1; side <= 1; side += 2) {
            struct scene scene = create_scene(NARC_FLOAT64, 1, 2, 1);
            scene_add_shape(&scene, &disc);
            struct body a = {.cosine = turns[k][0], .sine = turns[k][1], .scale = 1}, b = a;
            b.x = side * (double)a.cosine;
            b.y = side * (double)a.sine;
            scene_add_two(&scene, a, b);
            uint8_t outcome = 0xa5;
            const narc_method_options options = {.method = NARC_METHOD_SAT_FIRST, .out_outcomes = &outcome};
            struct contacts found = query_contacts(&scene, &options, &(narc_query){.margin = INFINITY});
            assert_int_equal(outcome, NARC_OUTCOME_DONE);
            assert_true(fabs((double)found.rows[0].separation + 1) < 1e-6);
            assert_true(fabs((double)found.rows[0].normal_x - b.x) < 1e-6);
            assert_true(fabs((double)found.rows[0].normal_y - b.y) < 1e-6);
            free(found.rows);
            destroy_scene(&scene);
        }
    }
}

TEST_MAIN("known")
