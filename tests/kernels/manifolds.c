/* SPDX-License-Identifier: MIT
 *
 * manifolds.c - ids and points of bodies that move a little, margins, flat angles, corners and edges that are hardly one.
 * pairs.c has all families in all placements.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "placements.h"

/* ------------------------------------------------------------------------------------------------ small motions */

/* Two bodies, one pair, and room for another. */
static struct scene make_duo(const struct shape *a, const struct shape *b) {
    struct scene scene = create_scene(NARC_FLOAT32, 2, 2, 2);
    for (uint32_t k = 0; k < 2; k++) {
        struct body body = turned_body(0, 1);
        body.shape = scene_add_shape(&scene, k == 0 ? a : b);
        scene_add_body(&scene, body);
    }
    scene_add_pair(&scene, 0, 1);
    return scene;
}

static void put(struct scene *scene, uint32_t index, double x, double y, double angle) {
    struct body body = turned_body(angle, 1);
    body.shape = scene->bodies[index].shape;
    body.x = x;
    body.y = y;
    round_position(&body, scene->precision);
    scene->bodies[index] = body;
}

/* The manifold of a scene's only pair. */
static narc_manifold find_one(const struct scene *scene, float margin) {
    AUTO(free_at) struct manifolds list = scene_manifolds(scene, margin);
    assert_int_equal(list.count, 1);
    return list.rows[0];
}

static size_t find_deeper(const narc_manifold *m) {
    return m->count == 2 && m->point[1].separation < m->point[0].separation;
}

/* The edge of a box whose normal points up, and the one whose normal points down. */
static unsigned find_edge_with(const struct shape *shape, double normal) {
    for (size_t i = 0; i < shape->count; i++)
        if (fabs(remainder(shape->arcs[i].start - normal, 2 * PI)) < 1e-9)
            return (unsigned)i | NARC_FEATURE_EDGE;
    fail_msg("no edge with the normal %g", normal);
    return 0;
}

/* A box on a box, tilted and moved a little to either side, rounded or not, equal or not: always the same two ids, and
 * points that move no more than the box does, but where they are cut off. Of equal sharp boxes either corner may end the
 * stretch. */
TEST(test_box_on_box) {
    struct test_random random = test_random_named("box on box");
    for (size_t round = 0; round < 4; round++) {
        const double rounding = round % 2 ? 0.1 : 0, width = round < 2 ? 2 : 1;
        const struct shape below = box_of(2, 1, 0), above = box_of(width, 1, rounding);
        AUTO(destroy_scene) struct scene scene = make_duo(&below, &above);
        const unsigned up = find_edge_with(&below, PI / 2), down = find_edge_with(&above, -PI / 2);
        const unsigned up_arc = up & 0x3f, down_arc = down & 0x3f; /* counter-clockwise behind these edges */
        const unsigned first = (round == 0 ? (up_arc + 3) % 4 : up) | down_arc << 8;
        const unsigned second = (round == 0 ? up_arc : up) | (down_arc + 3) % 4 << 8;
        for (size_t step = 0; step < 2000; step++) {
            const double tilt =
                step == 0 ? 0 : random_between(&random, -1, 1) * pow(10, -random_between(&random, 1.5, 8));
            const double x = step == 0 ? 0 : random_between(&random, -0.02, 0.02);
            put(&scene, 1, x, 0.99, tilt);
            const narc_manifold m = find_one(&scene, 0.05f);
            assert_int_equal(m.count, 2);
            assert_int_equal(m.point[0].feature, first);
            assert_int_equal(m.point[1].feature, second);
            /* The tangent of a normal that points up points left. The rounded box touches with its arcs' ends. */
            const double half = width / 2, reach = 0.05;
            assert_true(m.normal_y > 0.999f);
            assert_true(fabs((double)m.point[0].x - half) < reach + rounding);
            assert_true(fabs((double)m.point[1].x + half) < reach + rounding);
            assert_true(fabs((double)m.point[0].y - 0.495) < 0.06);
        }
    }
}

/* Two sharp corners that face each other: both boxes' edges end there, which is no stretch. */
TEST(test_corner_on_corner) {
    struct test_random random = test_random_named("corner on corner");
    const struct shape box = box_of(2, 1, 0);
    AUTO(destroy_scene) struct scene scene = make_duo(&box, &box);
    scene_add_pair(&scene, 1, 0);
    size_t one = 0, two = 0;
    for (size_t trial = 0; trial < test_trials(2000); trial++) {
        const double reach = hypot(1, 0.5), gap = random_between(&random, 0.05, 0.4);
        const double tilt = random_between(&random, -0.4, 0.4), along = random_between(&random, -1.5, 1.5);
        /* The normal that is halfway between the corners' diagonals, give or take. */
        const double angle_a = 0.3 * along, corner = angle_a + atan2(0.5, 1), angle_b = angle_a + tilt;
        const double other = angle_b + atan2(0.5, 1), normal = (corner + other) / 2 + 0.2 * tilt;
        put(&scene, 0, 0, 0, angle_a);
        put(&scene, 1, reach * cos(corner) + gap * cos(normal) + reach * cos(other),
            reach * sin(corner) + gap * sin(normal) + reach * sin(other), angle_b);
        if (trial == 0) { /* one that was found to have two points in one place */
            put(&scene, 0, 0, 0, 0.24253352);
            put(&scene, 1, 2.1308323354012582, 1.2974483469287876, -0.0399784483);
        }
        struct manifolds list = scene_manifolds(&scene, 0.5f);
        assert_int_equal(list.count, 2);
        assert_true(trial > 0 || list.rows[0].count == 1);
        assert_int_equal(list.rows[0].count, list.rows[1].count);
        if (list.rows[0].count == 2) { /* two edges on the same side of the corners */
            assert_true(hypot((double)list.rows[0].point[0].x - (double)list.rows[0].point[1].x,
                              (double)list.rows[0].point[0].y - (double)list.rows[0].point[1].y) > 1e-5);
            two++;
            free(list.rows);
            continue;
        }
        one++;
        assert_int_equal(list.rows[0].point[0].feature & 0xff, list.rows[1].point[0].feature >> 8);
        assert_int_equal(list.rows[0].point[0].feature >> 8, list.rows[1].point[0].feature & 0xff);
        free(list.rows);
    }
    assert_true(one > two / 100);
}

/* A rounded box that rocks through a tilt of zero: ids stay, and both points and separations are continuous. */
TEST(test_rocking) {
    const struct shape ground = box_of(20, 1, 0), rocker = box_of(2, 1, 0.2);
    AUTO(destroy_scene) struct scene scene = make_duo(&ground, &rocker);
    const double step = 1e-4, largest = 0.1;
    float last[2][3] = {{0}};
    unsigned id[2] = {0};
    size_t frames = 0;
    for (double tilt = -largest; tilt <= largest; tilt += step, frames++) {
        put(&scene, 1, 0, 1, tilt);
        const narc_manifold m = find_one(&scene, 0.5f);
        assert_int_equal(m.count, 2);
        for (size_t i = 0; i < 2; i++) {
            const float now[3] = {m.point[i].x, m.point[i].y, m.point[i].separation};
            for (size_t c = 0; c < 3 && frames > 0; c++)
                assert_true(fabs((double)(now[c] - last[i][c])) < 3 * step);
            if (frames > 0)
                assert_int_equal(m.point[i].feature, id[i]);
            memcpy(last[i], now, sizeof now);
            id[i] = m.point[i].feature;
        }
    }
    assert_true(frames > 1000);
}

/* How many points a query tells of, 0 without a row; they are those of a query without a margin, and one is the deeper. */
static void expect_points(const struct scene *scene, const narc_query *query, size_t points) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_manifold all = find_one(scene, INFINITY);
    AUTO(free_at) struct manifolds found = find_manifolds(scene->store, &bodies, &pairs, query);
    assert_int_equal(found.count, points > 0);
    if (points > 0)
        assert_int_equal(found.rows[0].count, points);
    if (points == 1 && query->flat_angle == 0) {
        const narc_manifold_point *const point = found.rows[0].point, none = {0};
        assert_memory_equal(&point[0], &all.point[find_deeper(&all)], sizeof *point);
        assert_memory_equal(&point[1], &none, sizeof none);
    }
    if (points == 2)
        assert_memory_equal(found.rows, &all, sizeof all);
}

/* Points are listed exactly if their separations are below their margins, of which a second one may be larger; and the flat angle decides which edges face each other. */
TEST(test_second_margin_and_flat_angle) {
    const struct shape ground = box_of(20, 1, 0), box = box_of(2, 1, 0);
    AUTO(destroy_scene) struct scene scene = make_duo(&ground, &box);
    for (int side = -1; side <= 1; side += 2) {
        put(&scene, 1, 0, 1.02, side * 0.05);
        const narc_manifold all = find_one(&scene, INFINITY);
        const size_t deep = find_deeper(&all);
        assert_int_equal(all.count, 2);
        assert_int_equal(deep, side < 0 ? 0 : 1);
        const float first = all.point[deep].separation, second = all.point[1 - deep].separation;
        const struct {
            float margin, second_margin;
            size_t points;
        } margins[] = {{nextafterf(second, 1), 0, 2},
                       {second, 0, 1},
                       {nextafterf(first, 1), 0, 1},
                       {first, 0, 0},
                       {first + 0.01f, second, 1},
                       {first + 0.01f, nextafterf(second, 1), 2},
                       {first, 2 * second, 0},
                       {INFINITY, first, 2},
                       {first + 0.01f, INFINITY, 2},
                       {first + 0.01f, -0.01f, 1},
                       {-1, 0, 0}};
        for (size_t k = 0; k < sizeof margins / sizeof *margins; k++)
            expect_points(&scene, &(narc_query){.margin = margins[k].margin, .second_margin = margins[k].second_margin},
                          margins[k].points);
    }
    put(&scene, 1, 0, 1.2, 0.2);
    static const float angles[] = {0, 0.21f, 0.19f, -1, NARC_MAX_FLAT_ANGLE, -INFINITY};
    static const size_t points[] = {2, 2, 1, 1, 2, 1};
    for (size_t k = 0; k < 6; k++)
        expect_points(&scene, &(narc_query){.margin = INFINITY, .flat_angle = angles[k]}, points[k]);
}

/* ------------------------------------------------------------------------------------------------ ids */

/* Manifold k of a list in one word: its ids, or its deepest point's alone. */
static unsigned find_ids(const struct manifolds *list, size_t k) {
    return list->rows[k].point[0].feature | (unsigned)list->rows[k].point[1].feature << 16;
}

static unsigned swap_bytes(unsigned id) { return (id >> 8 & 0x00ff00ff) | (id & 0x00ff00ff) << 8; }

static struct shape doubled_corner(double x, double y, double gap, double normal) {
    struct shape shape = {{{x, y, 0, -PI / 2, normal},
                           {x - gap * sin(normal), y + gap * cos(normal), 0, normal, 0},
                           {x, y + 1, 0, 0, PI / 2},
                           {x - 2, y + 1, 0, PI / 2, PI},
                           {x - 2, y, 0, PI, 1.5 * PI}},
                          5};
    return shape;
}

/* A corner of two arcs of radius 0, a hair apart, on the shape's own origin: the hair is no edge, whatever the shape's
 * coordinates are there. Manifolds are those of the same corner elsewhere, and of the swapped pair. */
TEST(test_doubled_corner) {
    struct test_random random = test_random_named("doubled corner");
    const double gaps[] = {0, 1e-17, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 3e-7};
    const struct shape ground = box_of(10, 1, 0);
    size_t two = 0, near_joint = 0;
    for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++) {
        const double normal = -random_between(&random, 0.3, 1.3);
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 3, 2, 2);
        scene_add_shape(&scene, &ground);
        for (int moved = 0; moved < 2; moved++) {
            const struct shape shape = doubled_corner(moved, moved, gaps[g], normal);
            scene_add_shape(&scene, &shape);
        }
        scene_add_body(&scene, turned_body(0, 1));
        scene_add_body(&scene, turned_body(0, 1));
        scene_add_pair(&scene, 0, 1);
        scene_add_pair(&scene, 1, 0);
        for (size_t trial = 0; trial < test_trials(400); trial++) {
            /* The corner is 0.01 deep in the ground's top, which is looked at from the joint's side. */
            const double tilt = -random_between(&random, 0.02, PI / 2 - 0.02), c = cos(tilt), s = sin(tilt);
            const double place = random_between(&random, -2, 2);
            unsigned ids[2];
            for (uint32_t moved = 0; moved < 2; moved++) {
                const double x = moved, y = moved;
                scene.bodies[1].shape = 1 + moved;
                put(&scene, 1, place - c * x + s * y, 0.49 - s * x - c * y, tilt);
                AUTO(free_at) struct manifolds list = scene_manifolds(&scene, 1);
                assert_int_equal(list.count, 2);
                assert_int_equal(list.rows[0].count, list.rows[1].count);
                ids[moved] = find_ids(&list, 0);
                const unsigned turned = swap_bytes(find_ids(&list, 1));
                const bool both = list.rows[0].count == 2;
                assert_int_equal(ids[moved], both ? turned >> 16 | turned << 16 : turned);
                two += both;
                const narc_manifold_point *point = list.rows[0].point;
                for (size_t i = 0; i < list.rows[0].count; i++)
                    assert_true(point[i].feature >> 8 != (1 | NARC_FEATURE_EDGE));
                const size_t deep = both && point[1].separation < point[0].separation;
                assert_true(!isinf(list.rows[0].radius_b) || point[deep].feature >> 8 & NARC_FEATURE_EDGE);
            }
            assert_int_equal(ids[0], ids[1]);
            near_joint += fabs(-PI / 2 - normal - tilt) < 0.4;
        }
    }
    assert_true(two > test_trials(400) / 4 && near_joint > test_trials(400) / 4);
}

/* A wedge that stands on its edge: with two points from the length on that is an edge for a shape of its size class, of
 * extents from 2^(5 class - 32) on. (In the upper part of a class a pair's own rounding is more than that.) */
TEST(test_least_edge) {
    for (int step = 0; step < 60; step++) {
        const int size_class = 1 + step / 6; /* of 2^-27 and more */
        const double extent = exp2(5 * size_class - 32 + step % 6 * 0.5 + 0.1), h = extent / sqrt(2);
        for (unsigned longer = 0; longer < 2; longer++) {
            const double half = (longer ? 0.505 : 0.495) * exp2(5 * size_class - 47), right = atan2(half - h, h);
            const struct shape wedge = {{{-half, 0, 0, PI - right, 1.5 * PI},
                                         {half, 0, 0, -0.5 * PI, right},
                                         {h, h, 0, right, 0.5 * PI},
                                         {-h, h, 0, 0.5 * PI, PI - right}},
                                        4};
            const struct shape ground = box_of(8 * h, 2 * h, 0);
            AUTO(destroy_scene) struct scene scene = make_duo(&ground, &wedge);
            put(&scene, 0, 0, -h, 0);
            put(&scene, 1, 0, 0.25 * h, 0);
            const narc_manifold m = find_one(&scene, INFINITY);
            assert_int_equal(m.count, 1 + longer);
        }
    }
}

/* A corner that is cut off by little more than rounding, far from its shape's origin: as many points for (A, B) as for
 * (B, A), but where roundings decide. */
TEST(test_short_edges_swapped) {
    struct test_random random = test_random_named("short edges swapped");
    const struct shape ground = box_of(4, 1, 0);
    const size_t trials = test_trials(2000);
    size_t differ = 0, two = 0;
    for (size_t trial = 0; trial < trials; trial++) {
        const double cut = random_between(&random, 0.8e-5, 2e-5), normal = -PI / 4;
        struct shape shape = doubled_corner(1, 1, 0, normal);
        shape.arcs[0].center_x -= cut;
        shape.arcs[1].center_y += cut;
        AUTO(destroy_scene) struct scene scene = make_duo(&ground, &shape);
        scene_add_pair(&scene, 1, 0);
        const double tilt = -PI / 2 - normal + random_between(&random, -0.4, 0.4), c = cos(tilt), s = sin(tilt);
        put(&scene, 1, random_between(&random, -0.2, 0.2) - c + s, 0.49 - s - c, tilt);
        AUTO(free_at) struct manifolds list = scene_manifolds(&scene, 1);
        assert_int_equal(list.count, 2);
        differ += list.rows[0].count != list.rows[1].count;
        two += list.rows[0].count == 2;
    }
    printf("  %zu of %zu differ, %zu with two points\n", differ, trials, two);
    assert_true(differ <= trials / 100 && two > trials / 20);
}

/* A corner that is rounded by two arcs has no edge between them, however far from the shape its origin is: what the
 * arcs' centres lose there is rounding. */
TEST(test_far_origin) {
    struct test_random random = test_random_named("far origin");
    const struct shape ball = circle_of(0.5), flat = box_of(2, 2, 0);
    for (double far = 1; far < 2e6; far *= 10) {
        for (size_t trial = 0; trial < test_trials(100); trial++) {
            const double x = far * random_between(&random, -1, 1), y = far * random_between(&random, -1, 1);
            const double joint = random_between(&random, 0.2, 1.3), first = 0.3,
                         second = random_between(&random, 0.1, 0.5);
            /* The second arc goes on from where the first one ends. */
            const double moved_x = (first - second) * cos(joint), moved_y = (first - second) * sin(joint);
            struct shape shape = {{{x + 0.7, y + 0.7, first, 0, joint},
                                   {x + 0.7 + moved_x, y + 0.7 + moved_y, second, joint, PI / 2},
                                   {x - 1, y + 0.7 + moved_y + second, 0, PI / 2, PI},
                                   {x - 1, y - 1, 0, PI, 1.5 * PI},
                                   {x + 1, y - 1, 0, 1.5 * PI, 2 * PI}},
                                  5};
            const double out_x = cos(joint), out_y = sin(joint), top_x = x + 0.7 + first * out_x;
            const double top_y = y + 0.7 + first * out_y;
            for (int edged = 0; edged < 2; edged++) {
                AUTO(destroy_scene) struct scene scene = make_duo(edged ? &flat : &ball, &shape);
                /* The other body's right side, turned round to the joint. */
                const double reach = edged ? 1 : 0.5;
                put(&scene, 0, 0, 0, joint + PI);
                put(&scene, 1, -top_x - reach * out_x, -top_y - reach * out_y, 0);
                scene_add_pair(&scene, 1, 0);
                AUTO(free_at) struct manifolds list = scene_manifolds(&scene, INFINITY);
                for (size_t i = 0; i < list.rows[0].count; i++)
                    assert_true(list.rows[0].point[i].feature >> 8 != (1 | NARC_FEATURE_EDGE));
                for (size_t i = 0; i < list.rows[1].count; i++)
                    assert_true((list.rows[1].point[i].feature & 0xff) != (1 | NARC_FEATURE_EDGE));
            }
        }
    }
}

/* A corner that leans on an edge's middle, sharp or rounded, from lying nearly flat on one side through standing on it
 * to lying on the other: the deepest point keeps its id, which names the corner's arc and the edge. */
TEST(test_leaning) {
    const struct shape ground = box_of(20, 1, 0);
    const unsigned top = find_edge_with(&ground, PI / 2);
    for (int rounded = 0; rounded < 2; rounded++) {
        const double radius = rounded ? 0.2 : 0;
        const struct shape box = box_of(2, 1, radius);
        AUTO(destroy_scene) struct scene scene = make_duo(&ground, &box);
        size_t one = 0, two = 0;
        const unsigned corner = (find_edge_with(&box, 0) & 0x3f) - 1 + (unsigned)box.count; /* the lower right arc */
        for (double tilt = -89; tilt < -1; tilt += 0.01) {
            const double c = cos(tilt * PI / 180), s = sin(tilt * PI / 180), right = 1 - radius, low = radius - 0.5;
            put(&scene, 1, 0.3 - (c * right - s * low), 0.5 + radius - 0.01 - (s * right + c * low), tilt * PI / 180);
            const narc_manifold m = find_one(&scene, 0.5f);
            const size_t count = m.count, deep = find_deeper(&m);
            assert_int_equal(m.point[deep].feature, top | corner % (unsigned)box.count << 8);
            one += count == 1;
            two += count == 2;
        }
        assert_true(one > 1000 && two > 1000);
    }
}

/* The point of a list that has the place and the separation of the contact, or point_count if neither has. */
static size_t find_deepest(const struct manifolds *list, const struct contacts *contacts, size_t k) {
    for (size_t i = 0; i < list->rows[k].count; i++)
        if (list->rows[k].point[i].separation == contacts->rows[k].separation &&
            list->rows[k].point[i].x == contacts->rows[k].point_x &&
            list->rows[k].point[i].y == contacts->rows[k].point_y)
            return i;
    return list->rows[k].count;
}

/* The flat angle decides whether there is a second point, and nothing of the deepest one's id. */
TEST(test_ids_at_all_flat_angles) {
    enum { ANGLES = 6 };
    const size_t count = test_trials(400);
    const float angles[ANGLES] = {0.45f, -1.0f, 0.001f, 0.1f, 0.8f, 1.5f};
    struct test_random random = test_random_named("ids at all flat angles");
    size_t compared = 0, come_and_go = 0;
    for (int family = 0; family < FAMILY_COUNT * FAMILY_COUNT; family++) {
        AUTO(destroy_scene)
        struct scene scene = make_placed_scene(&random, NARC_FLOAT32, (enum family)(family / FAMILY_COUNT),
                                               (enum family)(family % FAMILY_COUNT), count);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        AUTO(free_at) struct contacts contacts = scene_contacts(&scene, INFINITY);
        AUTO(free_at) struct manifolds usual = scene_manifolds(&scene, INFINITY);
        for (size_t a = 1; a < ANGLES; a++) {
            const narc_query query = {.margin = INFINITY, .flat_angle = angles[a]};
            AUTO(free_at) struct manifolds list = find_manifolds(scene.store, &bodies, &pairs, &query);
            for (size_t k = 0; k < count; k++) {
                const size_t i = find_deepest(&usual, &contacts, k), j = find_deepest(&list, &contacts, k);
                if (i == usual.rows[k].count || j == list.rows[k].count)
                    continue;
                assert_int_equal(usual.rows[k].point[i].feature, list.rows[k].point[j].feature);
                compared++;
                come_and_go += usual.rows[k].count != list.rows[k].count;
            }
        }
    }
    printf("  %zu points compared, %zu where the second one comes or goes\n", compared, come_and_go);
    assert_true(compared > 25 * count && come_and_go > 2 * count);
}

TEST_MAIN("manifolds")
