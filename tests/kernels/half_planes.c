/* SPDX-License-Identifier: MIT
 *
 * half_planes.c - bodies at half-planes: contacts, manifolds, separations, overlaps, casts, rays, points, boxes, pairs, regions
 * and steps, against what follows from the support function of the other body, in double precision; and what a store says of
 * one.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "expect.h"
#include "families.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "narc_scene.h"
#include "store.h"

/* How far a shape reaches along a unit vector of its own axes. */
static double support(const struct shape *shape, double x, double y) {
    double most = -INFINITY;
    for (size_t k = 0; k < shape->count; k++) {
        const narc_arc *const a = &shape->arcs[k];
        const double sweep = a->end > a->start ? a->end - a->start : a->end - a->start + 2 * PI, half = sweep / 2;
        const double turn = remainder(atan2(y, x) - (a->start + half), 2 * PI);
        const double start = cos(a->start) * x + sin(a->start) * y, end = cos(a->end) * x + sin(a->end) * y;
        const double along = fabs(turn) <= half ? 1 : fmax(start, end);
        most = fmax(most, a->center_x * x + a->center_y * y + a->radius * along);
    }
    return most;
}

/* The largest |centre| + radius. */
static double extent(const struct shape *shape) {
    double most = 0;
    for (size_t k = 0; k < shape->count; k++)
        most = fmax(most, hypot(shape->arcs[k].center_x, shape->arcs[k].center_y) + shape->arcs[k].radius);
    return most;
}

struct turn {
    double c, s;
};

static struct turn turn_of(const narc_body *body) {
    const double c = (double)body->cosine, s = (double)body->sine, length = hypot(c, s);
    return (struct turn){c / length, s / length};
}

/* How high a point is above a half-plane's boundary. */
static double height_of(const narc_body *plane, double x, double y) {
    const struct turn t = turn_of(plane);
    return -t.s * (x - plane->x) + t.c * (y - plane->y);
}

/* How far a body is from a half-plane. */
static double find_gap(const narc_body *plane, const narc_body *body, const struct shape *shape) {
    const struct turn p = turn_of(plane), b = turn_of(body);
    const double x = p.s, y = -p.c; /* down */
    const double reach = support(shape, b.c * x + b.s * y, b.c * y - b.s * x);
    return height_of(plane, body->x, body->y) - (double)body->scale * reach;
}

/* What a separation may be off by: the error bound of a pair with a box that is 4 (R + |height|) wide to each side and high
 * (kernels/base/planes.inl), R at most 1.5 extents. */
static double find_bound(const narc_body *plane, const narc_body *body, const struct shape *shape) {
    const double own = (double)body->scale * extent(shape), h = height_of(plane, body->x, body->y);
    return NARC_ERROR_BOUND * (fabs(h) + own + 6 * (1.5 * own + fabs(h)));
}

/* A store with a half-plane and a shape of each family, and two bodies: a half-plane, and another so high above it. */
struct site {
    narc_shapes *shapes;
    struct shape shape[FAMILY_COUNT];
    uint32_t plane, number[FAMILY_COUNT];
};

static struct site make_site(struct test_random *random) {
    struct site site = {.shapes = empty_store()};
    narc_error error;
    expect_ok(narc_add_half_plane(site.shapes, &site.plane, &error), &error);
    for (int k = 0; k < FAMILY_COUNT; k++) {
        site.shape[k] = make_shape(random, (enum family)k);
        site.number[k] = store_shape(site.shapes, site.shape[k]);
    }
    return site;
}

static const double distances[] = {0, 3, 1e4, 1e9};

static void place(struct test_random *random, const struct site *site, size_t family, double above, narc_body out[2]) {
    static const double angles[] = {0, PI / 2, PI, -PI / 2};
    const size_t which = random_below(random, 8);
    const double angle = which < 4 ? angles[which] : random_between(random, -PI, PI);
    const double turn = random_below(random, 2) ? angle : random_between(random, -PI, PI);
    const double away = distances[random_below(random, 4)], side = random_below(random, 2) ? away : -away;
    out[0] = (narc_body){random_between(random, -5, 5),
                         random_between(random, -5, 5),
                         (float)cos(angle),
                         (float)sin(angle),
                         (float)random_log_between(random, 1e-3, 1e3),
                         site->plane};
    const struct turn t = turn_of(&out[0]);
    out[1] = (narc_body){out[0].x + t.c * side - t.s * above,
                         out[0].y + t.s * side + t.c * above,
                         (float)cos(turn),
                         (float)sin(turn),
                         (float)random_log_between(random, 1e-2, 1e2),
                         site->number[family]};
}

static double any_height(struct test_random *random, double scale) {
    switch (random_below(random, 4)) {
    case 0:
        return random_between(random, -2, 2) * scale;
    case 1:
        return -random_log_between(random, 1, 1e9);
    case 2:
        return random_log_between(random, 1, 1e9);
    default:
        return random_between(random, 0.5, 1.2) * scale;
    }
}

static bool is_near(double a, double b, double bound) { return fabs(a - b) <= bound; }

/* Is a row's point, of a given separation there, halfway between the boundary and the body? `error`: what it may be off. */
static void check_point(const narc_body *a, const narc_body *plane, double x, double y, double separation,
                        double error) {
    assert_true(is_near(height_of(plane, a->x + x, a->y + y), separation / 2, error));
}

enum { PAIRS = 40 };

TEST(contacts_are_those_of_a_boundary_without_end) {
    struct test_random random = test_random_named("half-planes");
    size_t touching = 0, two_points = 0;
    for (size_t trial = 0; trial < test_trials(150); trial++) {
        struct site site = make_site(&random);
        narc_body bodies[2 * PAIRS];
        uint32_t a[PAIRS], b[PAIRS];
        size_t family[PAIRS], count, skipped = 0;
        narc_contact rows[PAIRS];
        narc_manifold manifolds[PAIRS];
        narc_refined_contact refined[PAIRS];
        float separations[PAIRS];
        uint64_t bits = 0;
        narc_bodies view;
        narc_error error;
        for (uint32_t k = 0; k < PAIRS; k++) {
            family[k] = random_below(&random, FAMILY_COUNT);
            place(&random, &site, family[k], 0, bodies + 2 * k);
            place(&random, &site, family[k], any_height(&random, (double)bodies[2 * k + 1].scale), bodies + 2 * k);
            a[k] = 2 * k + (k & 1);
            b[k] = 2 * k + 1 - (k & 1);
        }
        narc_view_bodies(bodies, (size_t)2 * PAIRS, &view);
        const narc_pairs pairs = {.count = PAIRS, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
        const narc_query all = {.margin = INFINITY, .out_skipped = &skipped};
        expect_ok(narc_find_contacts(site.shapes, &view, &pairs, &all, rows, PAIRS, &count, &error), &error);
        assert_int_equal(count, PAIRS);
        assert_int_equal(skipped, 0);
        expect_ok(narc_find_manifolds(site.shapes, &view, &pairs, &all, manifolds, PAIRS, &count, &error), &error);
        assert_int_equal(count, PAIRS);
        expect_ok(narc_find_separations(site.shapes, &view, &pairs, &all, separations, &error), &error);
        expect_ok(narc_find_overlaps(site.shapes, &view, &pairs, NULL, &bits, &error), &error);
        expect_ok(narc_refine_contacts(site.shapes, &view, &pairs, NULL, rows, PAIRS, refined, &error), &error);
        for (uint32_t k = 0; k < PAIRS; k++) {
            const narc_body *const plane = bodies + 2 * k, *const body = plane + 1, *const first = bodies + a[k];
            const struct shape *const shape = &site.shape[family[k]];
            const struct turn t = turn_of(plane);
            const double gap = find_gap(plane, body, shape), bound = find_bound(plane, body, shape);
            const double sign = k & 1 ? -1 : 1, away = fabs(plane->x - body->x) + fabs(plane->y - body->y);
            const narc_contact *const row = &rows[k];
            const narc_manifold *const m = &manifolds[k];
            const unsigned feature = k & 1 ? row->feature >> 8 : row->feature & 0xff;
            const float radius = k & 1 ? row->radius_b : row->radius_a;
            narc_contact alone;
            narc_manifold manifold_alone;
            assert_int_equal(row->pair, k);
            assert_int_equal(row->count, 1);
            assert_true(is_near((double)row->separation, gap, bound));
            assert_true(is_near(sign * (double)row->normal_x, -t.s, 1e-6) &&
                        is_near(sign * (double)row->normal_y, t.c, 1e-6));
            assert_int_equal(feature, NARC_FEATURE_EDGE);
            assert_true(isinf(radius) && radius > 0);
            const double size = (double)body->scale * extent(shape),
                         point_error = bound + 1e-6 * (size + (k & 1 ? 0 : away));
            check_point(first, plane, (double)row->point_x, (double)row->point_y, (double)row->separation,
                        point_error + 2e-7 * (k & 1 ? fabs(gap) + size : 0));
            assert_true(hypot(first->x + (double)row->point_x - body->x, first->y + (double)row->point_y - body->y) <=
                        size + fabs(gap) + 2 * point_error);
            assert_memory_equal(&separations[k], &row->separation, sizeof separations[k]);
            assert_int_equal(bits >> k & 1, row->separation < 0);
            const double deepest =
                (double)fminf(m->point[0].separation, m->count > 1 ? m->point[1].separation : INFINITY);
            assert_true(deepest == (double)row->separation);
            for (uint32_t i = 0; i < m->count; i++)
                check_point(first, plane, (double)m->point[i].x, (double)m->point[i].y, (double)m->point[i].separation,
                            2 * point_error + 2e-7 * (k & 1 ? fabs(gap) + size : 0));
            assert_true(is_near(refined[k].separation, gap, 1e-6 * (size + 1) + 1e-12 * (fabs(gap) + away)));
            check_point(first, plane, refined[k].point_x, refined[k].point_y, refined[k].separation,
                        1e-6 * size + 1e-12 * (fabs(gap) + away));
            expect_ok(narc_find_contact(site.shapes, first, bodies + b[k], &all, &alone, &error), &error);
            alone.pair = k;
            assert_memory_equal(&alone, row, sizeof alone);
            expect_ok(narc_find_manifold(site.shapes, first, bodies + b[k], &all, &manifold_alone, &error), &error);
            manifold_alone.pair = k;
            assert_memory_equal(&manifold_alone, m, sizeof manifold_alone);
            touching += row->separation < 0;
            two_points += m->count == 2;
        }
        narc_destroy_shapes(site.shapes);
    }
    assert_true(touching > 0 && (test_trials(150) < 10 || two_points > test_trials(150)));
}

/* Boxes, circles and capsules beside each other and at half-planes, in any order: what a list has of a pair is its answer alone. */
TEST(lists_of_all_kinds_have_the_answers_of_each_pair) {
    enum { BODIES = 64, LISTED = 300 };
    struct test_random random = test_random_named("half-planes among others");
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    narc_error error;
    uint32_t shape[4];
    expect_ok(narc_add_half_plane(shapes, &shape[0], &error), &error);
    shape[1] = store_shape(shapes, box_of(2, 1, 0.1));
    shape[2] = store_shape(shapes, circle_of(1));
    shape[3] = store_shape(shapes, capsule_of(2, 0.5));
    assert_int_equal(shapes->boxes[shape[0]].info & (NARC_IS_PLANE | NARC_IS_BOX | NARC_IS_CIRCLE), NARC_IS_PLANE);
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        const size_t kinds = 2 + trial % 3;
        narc_body bodies[BODIES];
        uint32_t a[LISTED], b[LISTED];
        narc_manifold rows[LISTED];
        size_t count, kept = 0;
        narc_bodies view;
        for (size_t k = 0; k < BODIES; k++) {
            const double angle = random_between(&random, -PI, PI);
            bodies[k] = (narc_body){random_between(&random, -2, 2),
                                    random_between(&random, -2, 2),
                                    (float)cos(angle),
                                    (float)sin(angle),
                                    1,
                                    shape[random_below(&random, kinds)]};
        }
        for (size_t k = 0; k < LISTED; k++) {
            a[k] = (uint32_t)random_below(&random, BODIES);
            b[k] = (uint32_t)random_below(&random, BODIES);
        }
        narc_view_bodies(bodies, BODIES, &view);
        const narc_pairs pairs = {.count = LISTED, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
        expect_ok(narc_find_manifolds(shapes, &view, &pairs, &(narc_query){.margin = 1}, rows, LISTED, &count, &error),
                  &error);
        for (uint32_t k = 0; k < LISTED; k++) {
            const narc_query one = {.margin = 1, .selection = {&k, sizeof k}, .selection_count = 1};
            narc_manifold row;
            size_t found;
            expect_ok(narc_find_manifolds(shapes, &view, &pairs, &one, &row, 1, &found, &error), &error);
            if (found)
                assert_memory_equal(&row, &rows[kept++], sizeof row);
        }
        assert_int_equal(count, kept);
    }
}

/* Deeper than 1e12 there is no answer, and none of broken numbers; two half-planes have no contact. */
TEST(what_has_no_answer) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    narc_error error;
    uint32_t plane;
    expect_ok(narc_add_half_plane(shapes, &plane, &error), &error);
    const uint32_t box = store_shape(shapes, box_of(1, 1, 0));
    narc_body bodies[] = {{0, 0, 1, 0, 1, plane},     {0, -2e12, 1, 0, 1, box}, {0, -1e11, 1, 0, 1, box},
                          {5, 5, 1, 0, 1, plane},     {0, 0.5, 1, 0, 1, box},   {0, 0, 1, 0, 1e10f, plane},
                          {0, 0, 2, 0, 1, plane},     {NAN, 0, 1, 0, 1, plane}, {1e16, 1e16, 1, 0, 1, box},
                          {2e17, 0.25, 1, 0, 1, box}, {1e24, 0, 1, 0, 1, box}};
    const size_t last = sizeof bodies / sizeof *bodies;
    const bool answered[] = {false, false, true, false, true, false, false, false, true, false, false};
    narc_bodies view;
    narc_view_bodies(bodies, last, &view);
    for (uint32_t k = 1; k < last; k++) {
        const bool is_plane = bodies[k].shape == plane;
        const uint32_t a = is_plane ? 4 : 0;
        size_t skipped = 0, count;
        narc_contact row;
        const narc_pairs pair = {.count = 1, .a = {&a, 4}, .b = {&k, 4}};
        const narc_query query = {.margin = 1e30f, .out_skipped = &skipped};
        expect_ok(narc_find_contacts(shapes, &view, &pair, &query, &row, 1, &count, &error), &error);
        assert_int_equal(count, answered[k] || k == 3);
        assert_int_equal(skipped, !(answered[k] || k == 3));
    }
    const uint32_t a[] = {0}, b[] = {3};
    const narc_pairs planes = {.count = 1, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    size_t count = 7, skipped = 7;
    narc_contact row;
    uint64_t bits = 7;
    const narc_query query = {.margin = INFINITY, .out_skipped = &skipped};
    expect_ok(narc_find_contacts(shapes, &view, &planes, &query, &row, 1, &count, &error), &error);
    assert_int_equal(count, 0);
    assert_int_equal(skipped, 0);
    expect_ok(narc_find_overlaps(shapes, &view, &planes, NULL, &bits, &error), &error);
    assert_int_equal(bits, 0);
}

/* ------------------------------------------------------------------------------------------------ casts */

static narc_body move_body(const narc_body *body, double x, double y, double angle, double time) {
    narc_body out = *body;
    const struct turn t = turn_of(body);
    const double c = cos(angle * time), s = sin(angle * time);
    out.x += x * time;
    out.y += y * time;
    if (angle != 0) { /* or far along a boundary a rounding counts */
        out.cosine = (float)(c * t.c - s * t.s);
        out.sine = (float)(s * t.c + c * t.s);
    }
    return out;
}

TEST(casts_meet_the_boundary) {
    struct test_random random = test_random_named("casts at half-planes");
    size_t hits = 0, misses = 0;
    for (size_t trial = 0; trial < test_trials(60); trial++) {
        struct site site = make_site(&random);
        for (size_t k = 0; k < 40; k++) {
            const size_t family = random_below(&random, FAMILY_COUNT);
            narc_body bodies[2];
            place(&random, &site, family, 0, bodies);
            const double size = (double)bodies[1].scale * extent(&site.shape[family]);
            place(&random, &site, family, size * random_between(&random, 1, 4), bodies);
            bodies[1].scale = (float)(size / extent(&site.shape[family]));
            const bool turns = random_below(&random, 2), plane_is_b = random_below(&random, 2);
            const float motion_x[2] = {(float)(size * random_between(&random, -1, 1)),
                                       (float)(size * random_between(&random, -4, 4))};
            const float motion_y[2] = {(float)(size * random_between(&random, -1, 1)),
                                       (float)(size * random_between(&random, -4, 4))};
            const float angle[2] = {0, turns ? (float)random_between(&random, -3, 3) : 0};
            const float target = random_below(&random, 2) ? (float)(0.05 * size) : 0;
            const narc_motion motions[] = {{motion_x[0], motion_y[0], 0}, {motion_x[1], motion_y[1], angle[1]}};
            const uint32_t a = plane_is_b ? 1 : 0, b = 1 - a;
            const narc_cast_options options = {.target = target, .tolerance = turns ? (float)(1e-3 * size) : 0};
            narc_impact row;
            narc_error error;
            expect_ok(
                narc_cast_pair(site.shapes, &bodies[a], &motions[a], &bodies[b], &motions[b], &options, &row, &error),
                &error);
            double first = INFINITY, least = INFINITY;
            for (int step = 0; step <= 4000; step++) {
                const double time = step / 4000.0;
                const narc_body p = move_body(&bodies[0], (double)motion_x[0], (double)motion_y[0], 0, time);
                const narc_body q =
                    move_body(&bodies[1], (double)motion_x[1], (double)motion_y[1], (double)angle[1], time);
                const double gap = find_gap(&p, &q, &site.shape[family]) - (double)target;
                least = fmin(least, gap);
                if (gap <= 0 && first == INFINITY)
                    first = time;
            }
            const double room = (turns ? 1.1e-3 : 2e-6) * size +
                                (double)NARC_ERROR_BOUND * 20 * size; /* and a sample is not the minimum */
            if (row.count == NARC_CAST_MISS) {
                assert_true(least > -room - 1e-3 * size);
                misses++;
                continue;
            }
            assert_int_equal(row.count, NARC_CAST_HIT);
            const double time = (double)row.fraction;
            const narc_body p = move_body(&bodies[0], (double)motion_x[0], (double)motion_y[0], 0, time);
            const narc_body q = move_body(&bodies[1], (double)motion_x[1], (double)motion_y[1], (double)angle[1], time);
            const double gap = find_gap(&p, &q, &site.shape[family]), speed = 12 * size;
            assert_true(time <= first + 2e-3);
            assert_true(time == 0 || fabs(gap - (double)target) <= room + 1e-6 * speed);
            assert_true(is_near((double)row.separation, gap, room + 1e-6 * speed));
            const narc_body *const at = plane_is_b ? &q : &p;
            const double away = plane_is_b ? 0 : fabs(p.x - q.x) + fabs(p.y - q.y);
            check_point(at, &p, (double)row.point_x, (double)row.point_y, (double)row.separation,
                        room + 2e-6 * (speed + away));
            assert_true(hypot(at->x + (double)row.point_x - q.x, at->y + (double)row.point_y - q.y) <=
                        size + fabs(gap) + room + 1e-6 * (speed + away));
            hits++;
        }
        narc_destroy_shapes(site.shapes);
    }
    assert_true(hits > 0 && misses > 0);
}

/* One that turns has no answer. Casts over an index meet it, and a body that rests on one goes along it. */
TEST(casts_of_movers_over_ground_without_end) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    narc_error error;
    uint32_t plane;
    expect_ok(narc_add_half_plane(shapes, &plane, &error), &error);
    const uint32_t box = store_shape(shapes, box_of(1, 1, 0));
    const narc_body ground[] = {{0, 0, 1, 0, 1, plane}, {1e24, 1e24, 1, 0, 1, box}, {3e5, 0.5, 1, 0, 1, box}};
    const narc_body movers[] = {{7e6, 3.5, 1, 0, 1, box}, {0, 0.5, 1, 0, 1, box}, {0, 5, 1, 0, 1, box}};
    const float x[] = {100, 400000, 1}, y[] = {-6, 0, -1}, spin[] = {1, 0};
    narc_bodies bodies, moved;
    narc_box boxes[3];
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_impact rows[3];
    narc_view_bodies(ground, 3, &bodies);
    narc_view_bodies(movers, 3, &moved);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(shapes, &bodies, NULL, boxes, &error), &error);
    assert_true(boxes[0].max_y >= 0 && boxes[0].max_y < 1e-4f && boxes[0].min_y == -FLT_MAX);
    assert_true(boxes[0].min_x == -FLT_MAX && boxes[0].max_x == FLT_MAX);
    expect_ok(narc_build_index(index, boxes, 3, NULL, &error), &error);
    const narc_motions motions = {.x = NARC_ARRAY(x), .y = NARC_ARRAY(y)};
    const narc_cast_options lets_go = {.parting = 0.01f};
    expect_ok(narc_cast_shapes(index, shapes, &bodies, &moved, &motions, NULL, &lets_go, rows, 3, &error), &error);
    assert_int_equal(rows[0].count, NARC_CAST_HIT);
    assert_int_equal(rows[0].body, 0);
    assert_true(is_near((double)rows[0].fraction, 0.5, 1e-6));
    assert_int_equal(rows[1].count, NARC_CAST_HIT);
    assert_int_equal(rows[1].body, 2);
    assert_true(is_near((double)rows[1].fraction, (3e5 - 1) / 4e5, 1e-5));
    assert_int_equal(rows[2].count, NARC_CAST_MISS);
    const uint32_t a[] = {0}, b[] = {2};
    const narc_pairs pair = {.count = 1, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &moved};
    const narc_motions turning = {.angle = {spin, 0}};
    size_t skipped = 0;
    const narc_cast_options counts = {.out_skipped = &skipped};
    expect_ok(narc_cast_pairs(shapes, &bodies, &turning, &pair, &motions, &counts, rows, 1, &error), &error);
    assert_int_equal(rows[0].count, NARC_CAST_MISS);
    assert_int_equal(skipped, 1);
}

/* ------------------------------------------------------------------------------------------------ rays and points */

TEST(rays_and_points_meet_the_boundary) {
    struct test_random random = test_random_named("rays at half-planes");
    size_t hits = 0;
    for (size_t k = 0; k < test_trials(3000); k++) {
        struct site site = {.shapes = empty_store()};
        narc_error error;
        narc_body pair[2];
        expect_ok(narc_add_half_plane(site.shapes, &site.plane, &error), &error);
        place(&random, &site, 0, any_height(&random, 1), pair);
        const narc_body *const plane = pair;
        const double x = pair[1].x, y = pair[1].y, h = height_of(plane, x, y);
        const float m_x = (float)random_between(&random, -1e3, 1e3), m_y = (float)random_between(&random, -1e3, 1e3);
        const struct turn t = turn_of(plane);
        const double falls = -(-t.s * (double)m_x + t.c * (double)m_y), time = h / falls;
        narc_bodies view;
        narc_box box;
        narc_index *index;
        narc_view_bodies(pair, 1, &view);
        const narc_rays rays = {.count = 1,
                                .x = {&x, 8, NARC_FLOAT64},
                                .y = {&y, 8, NARC_FLOAT64},
                                .motion_x = {&m_x, 4},
                                .motion_y = {&m_y, 4}};
        const narc_points points = {.count = 1, .x = {&x, 8, NARC_FLOAT64}, .y = {&y, 8, NARC_FLOAT64}};
        assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
        expect_ok(narc_compute_boxes(site.shapes, &view, NULL, &box, &error), &error);
        expect_ok(narc_build_index(index, &box, 1, NULL, &error), &error);
        if (fabs(h) <= 1e-9 || fabs(time - 1) <= 1e-6)
            goto next;
        for (int inside = 0; inside < 3; inside++) {
            narc_ray_hit row, same;
            const narc_ray_options options = {.inside = (narc_inside)inside};
            expect_ok(narc_cast_ray_pairs(site.shapes, &view, &rays, NULL, &options, &row, 1, &error), &error);
            expect_ok(narc_cast_rays(index, site.shapes, &view, &rays, &options, &same, 1, &error), &error);
            assert_memory_equal(&row, &same, sizeof row);
            const bool comes = time >= 0 && time <= 1;
            const bool hit = h > 0 ? comes : inside == NARC_INSIDE_STOPS || (inside == NARC_INSIDE_LEAVES && comes);
            assert_int_equal(row.count, hit);
            if (!hit)
                continue;
            hits++;
            if (h < 0 && inside == NARC_INSIDE_STOPS) {
                assert_true(row.fraction == 0 && row.feature == 0);
                continue;
            }
            assert_true(is_near((double)row.fraction, time, 1e-6));
            assert_int_equal(row.feature, NARC_FEATURE_EDGE);
            assert_true(isinf(row.radius));
            assert_true(is_near((double)row.normal_x, -t.s, 1e-6) && is_near((double)row.normal_y, t.c, 1e-6));
            /* Numbers of a row are rounded to float: a point far along the boundary is off it by its distance's rounding. */
            assert_true(is_near(height_of(plane, plane->x + (double)row.point_x, plane->y + (double)row.point_y), 0,
                                1e-6 * (1 + hypot(x - plane->x, y - plane->y)) +
                                    0x1p-24 * hypot((double)row.point_x, (double)row.point_y)));
        }
        narc_distance row, nearest;
        uint64_t bit = 0;
        expect_ok(narc_find_distances(site.shapes, &view, &points, NULL, NULL, &row, &error), &error);
        assert_int_equal(row.count, 1);
        assert_true(is_near((double)row.separation, h, 1e-7 * fabs(h) + 1e-12 * (fabs(x) + fabs(y))));
        assert_true(is_near((double)row.normal_x, -t.s, 1e-6) && is_near((double)row.normal_y, t.c, 1e-6));
        assert_true(is_near(height_of(plane, plane->x + (double)row.place_x, plane->y + (double)row.place_y), 0,
                            1e-6 * (1 + hypot(x - plane->x, y - plane->y))));
        expect_ok(narc_find_inside(site.shapes, &view, &points, NULL, NULL, &bit, &error), &error);
        assert_int_equal(bit, h < 0);
        expect_ok(narc_find_nearest(index, site.shapes, &view, &points, NULL, &nearest, 1, &error), &error);
        assert_memory_equal(&nearest, &row, sizeof row);
        const narc_box touch = {(float)x, (float)y, (float)x, (float)y};
        narc_pairs found;
        expect_ok(narc_query_index(index, &touch, 1, NULL, &found, &error), &error);
        assert_true(found.count == 1 || h > 0);
    next:
        narc_destroy_index(index);
        narc_destroy_shapes(site.shapes);
    }
    assert_true(hits > 0);
}

/* ------------------------------------------------------------------------------------------------ scenes */

enum { BODIES = 60 };

static void make_scene(struct test_random *random, const struct site *site, narc_body *bodies) {
    for (size_t k = 0; k < BODIES; k++) {
        const double turn = random_between(random, -PI, PI);
        bodies[k] = (narc_body){random_between(random, -12, 12),
                                random_between(random, -1, 6),
                                (float)cos(turn),
                                (float)sin(turn),
                                1,
                                site->number[random_below(random, FAMILY_COUNT)]};
    }
    bodies[BODIES / 2] = (narc_body){-1e7, 0, 1, 0, 1, site->plane}; /* in the middle of all lists */
    bodies[BODIES / 3] = (narc_body){5, 2, (float)cos(0.7), (float)sin(0.7), 1, site->plane};
    bodies[BODIES / 4] = (narc_body){1e24, -1e24, 1, 0, 1, site->number[FAMILY_BOX]};
}

/* Each step has the rows of its pairs asked anew, whatever is kept; pairs are those of boxes that overlap, a body at 1e24 or not;
 * so has an index of them. */
TEST(steps_and_regions_over_ground_without_end) {
    struct test_random random = test_random_named("steps at half-planes");
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        struct site site = make_site(&random);
        narc_body bodies[BODIES];
        narc_bodies view;
        AUTO(narc_destroy_contacts_at) narc_contacts *contacts;
        AUTO(narc_destroy_index_at) narc_index *index;
        AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad;
        narc_error error;
        size_t touching = 0;
        make_scene(&random, &site, bodies);
        narc_view_bodies(bodies, BODIES, &view);
        assert_int_equal(narc_create_contacts(NULL, &contacts, NULL), NARC_OK);
        assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
        assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
        for (int round = 0; round < 8; round++) {
            const narc_step step = {.bodies = &view, .skin = 0.2f, .recycling = trial % 2 ? 0.05f : 0, .margin = 0.02f};
            const narc_step_result *r;
            narc_box boxes[BODIES];
            uint32_t a[BODIES * BODIES], b[BODIES * BODIES];
            size_t count, expected = 0;
            narc_pairs found;
            expect_ok(narc_update_contacts(contacts, site.shapes, &step, &r, &error), &error);
            for (size_t i = 0; i < r->touching_count; i++) {
                const uint32_t slot = r->touching[i], of_a = r->pairs.a.base[slot], of_b = r->pairs.b.base[slot];
                narc_manifold asked;
                if (bodies[of_a].shape != site.plane && bodies[of_b].shape != site.plane)
                    continue;
                const narc_query query = {.margin = step.margin};
                expect_ok(narc_find_manifold(site.shapes, &bodies[of_a], &bodies[of_b], &query, &asked, &error),
                          &error);
                asked.pair = r->manifolds[slot].pair;
                assert_memory_equal(&asked, &r->manifolds[slot], sizeof asked);
                touching++;
            }
            expect_ok(narc_compute_boxes(site.shapes, &view, NULL, boxes, &error), &error);
            expect_ok(
                narc_find_pairs(broad, boxes, BODIES, NULL, NULL, a, b, 0, (size_t)BODIES * BODIES, &count, &error),
                &error);
            expect_ok(narc_build_index(index, boxes, BODIES, &(narc_index_options){.fast = round % 2 == 1}, &error),
                      &error);
            expect_ok(narc_query_index(index, boxes, BODIES, NULL, &found, &error), &error);
            for (uint32_t i = 0; i < BODIES; i++)
                for (uint32_t j = i + 1; j < BODIES; j++)
                    if (overlap(&boxes[i], &boxes[j])) {
                        assert_true(expected < count && a[expected] == i && b[expected] == j);
                        expected++;
                    }
            assert_int_equal(count, expected);
            assert_int_equal(found.count, 2 * expected + BODIES);
            for (size_t k = 0; k < BODIES; k++)
                if (bodies[k].shape != site.plane && random_below(&random, 2)) {
                    bodies[k].x += random_between(&random, -0.1, 0.1);
                    bodies[k].y += random_between(&random, -0.1, 0.1);
                }
        }
        assert_true(touching > 0);
        narc_destroy_shapes(site.shapes);
    }
}

/* ------------------------------------------------------------------------------------------------ the store */

TEST(a_store_has_one_half_plane) {
    narc_shapes *const shapes = empty_store(), *loaded;
    narc_error error;
    narc_arc arcs[NARC_MAX_ARCS];
    narc_aabb box;
    uint32_t plane, again, small;
    expect_error(narc_add_half_plane(NULL, &plane, &error), NARC_ERROR_ARGUMENT, &error, "shapes");
    small = store_shape(shapes, box_of(2, 1, 0));
    expect_ok(narc_add_half_plane(shapes, &plane, &error), &error);
    expect_ok(narc_add_half_plane(shapes, &again, &error), &error);
    assert_true(plane == again && plane != small);
    assert_int_equal(narc_count_uses(shapes, plane), 2);
    assert_int_equal(narc_get_arcs(shapes, plane, arcs), 0);
    assert_int_equal(narc_shape_flags(shapes, plane), NARC_SHAPE_HALF_PLANE);
    assert_false(narc_get_aabb(shapes, plane, 1, 0, 1, &box));
    assert_int_equal(shapes->plane_count, 1);
    const size_t size = narc_count_saved_bytes(shapes);
    AUTO(free_at) unsigned char *const bytes = malloc(size), *const others = malloc(size);
    expect_ok(narc_save_shapes(shapes, bytes, size, &error), &error);
    expect_ok(narc_load_shapes(NULL, bytes, size, &loaded, &error), &error);
    assert_int_equal(loaded->plane_count, 1);
    expect_ok(narc_save_shapes(loaded, others, size, &error), &error);
    assert_memory_equal(bytes, others, size);
    narc_destroy_shapes(loaded);
    expect_ok(narc_remove_shape(shapes, plane, &error), &error);
    expect_ok(narc_remove_shape(shapes, plane, &error), &error);
    assert_int_equal(shapes->plane_count + shapes->piece_count, 0);
    narc_destroy_shapes(shapes);
}

TEST_MAIN("half_planes")
