/* SPDX-License-Identifier: MIT
 *
 * ground_points.c - rays at ground, and the nearest places on it, beside its curve in double precision.
 */
#include <math.h>
#include <stdlib.h>

#include "chains.h"
#include "expect.h"

TEST(test_rays) {
    enum { RAYS = 400 };
    struct test_random random = test_random_named("rays");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ground_scene *g = lay_random_ground(&random, round % 2 ? CHAIN_MIXED : CHAIN_HILLS);
        if (g->chain.count < 3) {
            destroy_ground_scene(g);
            continue;
        }
        const narc_bodies bodies = view_columns(g->bodies, g->count);
        AUTO(free_at) narc_box *boxes = malloc(g->count * sizeof *boxes);
        AUTO(narc_destroy_index_at) narc_index *index = index_bodies(g->store, &bodies, NULL, boxes);
        double x[RAYS], y[RAYS];
        float motion_x[RAYS], motion_y[RAYS];
        for (size_t k = 0; k < RAYS; k++) {
            const narc_arc *arc = &g->chain.arcs[1 + random_below(&random, g->chain.count - 2)];
            const bool in_ground = fabs(arc->radius) > 0 &&
                                   !random_below(&random, 4); /* not at seams, which reach a little into the ground */
            const bool at_seam = !in_ground && !random_below(&random, 3);
            const double angle = at_seam ? arc->start : random_between(&random, arc->start, arc->end);
            narc_point p = chain_point(arc, angle);
            if (!(fabs(arc->radius) > 0)) /* beside a corner */
                p.x += random_between(&random, -0.1, 0.1);
            const double air = fabs(arc->radius) > 0 ? angle : (arc->start + arc->end) / 2;
            const double way = air + random_between(&random, -1.2, 1.2), away = random_log_between(&random, 1e-3, 30);
            const double sign = in_ground ? -1 : 1;
            x[k] = p.x + sign * away * cos(way);
            y[k] = p.y + sign * away * sin(way);
            motion_x[k] = (float)((p.x - x[k]) * 3);
            motion_y[k] = (float)((p.y - y[k]) * 3);
        }
        const narc_rays rays = {.count = RAYS,
                                .x = NARC_POSITION_ARRAY(x),
                                .y = NARC_POSITION_ARRAY(y),
                                .motion_x = NARC_ARRAY(motion_x),
                                .motion_y = NARC_ARRAY(motion_y)};
        narc_ray_hit hits[RAYS], others[RAYS];
        size_t hit_count = 0, doubts = 0;
        for (int inside = NARC_INSIDE_STOPS; inside <= NARC_INSIDE_IGNORES; inside++) {
            const narc_ray_options options = {.inside = (narc_inside)inside};
            assert_int_equal(
                narc_cast_rays(index, g->store, &bodies, &rays, &options, inside ? others : hits, RAYS, NULL), NARC_OK);
            if (inside)
                assert_memory_equal(hits, others, sizeof hits);
        }
        test_use_isa("scalar");
        assert_int_equal(narc_cast_rays(index, g->store, &bodies, &rays, NULL, others, RAYS, NULL), NARC_OK);
        test_use_isa(test_isa());
        assert_memory_equal(hits, others, sizeof hits);
        for (size_t k = 0; k < RAYS; k++) {
            const double length = hypot((double)motion_x[k], (double)motion_y[k]), room = 2e-5;
            const narc_point o = {x[k], y[k]}, v = {(double)motion_x[k] / length, (double)motion_y[k] / length};
            const narc_point left = {o.x - room * v.y, o.y + room * v.x}, right = {o.x + room * v.y, o.y - room * v.x};
            const struct ground_crossing here = ground_cross(ground_of(g), o, v),
                                         beside = ground_cross(ground_of(g), left, v),
                                         other = ground_cross(ground_of(g), right, v);
            const double along = hits[k].count ? (double)hits[k].fraction * length : INFINITY;
            const bool found = here.along < length;
            /* Rays that graze, meet a corner, or begin by next to nothing in the ground. */
            const bool is_free = !isfinite(here.along) && !isfinite(beside.along) && !isfinite(other.along);
            const bool is_doubtful =
                !is_free && (!(fabs(beside.along - here.along) < 0.01) || !(fabs(other.along - here.along) < 0.01) ||
                             !(hypot(beside.normal.x - other.normal.x, beside.normal.y - other.normal.y) < 1e-2) ||
                             here.along < 1e-4 || fabs(here.along - length) < 1e-3);
            doubts += is_doubtful;
            if (is_doubtful)
                continue;
            hit_count += found;
            const double slope = fabs(here.normal.x * v.x + here.normal.y * v.y);
            if (found != (hits[k].count > 0) || (found && !(fabs(along - here.along) * slope <= 1e-5)))
                fail_msg("ray %zu from (%.9g, %.9g) along (%g, %g): %g, not %g", k, o.x, o.y, v.x, v.y, along,
                         here.along);
            const double turned =
                hypot((double)hits[k].normal_x - here.normal.x, (double)hits[k].normal_y - here.normal.y);
            /* Within a seam it is the neighbour's: 1e-4 of the largest radius, as an angle of the smallest. */
            if (found && !(turned < 1e-4 * (1 + 6 / 0.2) + 2e-4 / slope))
                fail_msg("ray %zu from (%.9g, %.9g) along (%g, %g): at %g the normal is off by %g", k, o.x, o.y, v.x,
                         v.y, along, turned);
        }
        if (!(hit_count > RAYS / 4 && doubts < RAYS / 5))
            fail_msg("of %d rays %zu hit, and %zu are doubtful", RAYS, hit_count, doubts);
        destroy_ground_scene(g);
    }
}

#define EXPECT(found, expected, tolerance) assert_true(fabs((double)(found) - (expected)) <= (tolerance))

/* Is a row that of the nearest place of the ground? `size`: what the chain's numbers are in proportion to. Pieces go on beyond
 * their ends, into the solid by up to 2^-16 of a line or a radius (chain_pieces.c): half of the room. */
static void check_nearest(struct ground_scene *scene, narc_point p, const narc_distance *row, double size) {
    const struct body *const body = &scene->bodies[row->body];
    struct ground *const ground = ground_of(scene);
    const narc_point at = rotate_to_ground(scene, body->x + (double)row->place_x, body->y + (double)row->place_y);
    const narc_point n = rotate_to_ground(scene, (double)row->normal_x, (double)row->normal_y);
    const double distance = ground_outline_distance(ground, p), room = 3e-5 * (size + distance);
    assert_int_equal(row->count, 1);
    EXPECT(fabsf(row->separation), distance, room);
    EXPECT(ground_outline_distance(ground, at), 0, room);
    EXPECT(hypot(p.x - at.x, p.y - at.y), distance, room);
    if (distance > 100 * room) {
        EXPECT(n.x, (p.x - at.x) / (double)row->separation, 0.05);
        EXPECT(n.y, (p.y - at.y) / (double)row->separation, 0.05);
    }
    const struct ground_foot foot = ground_distance(ground, p);
    if (isfinite(foot.distance) && distance > 2 * room) /* else an open end is nearer */
        assert_true((row->separation < 0) == (foot.distance < 0));
}

TEST(test_nearest) {
    enum { POINTS = 50 };
    struct test_random random = test_random_named("points and ground");
    const size_t trials = test_trials(100);
    size_t behind = 0, all = 0, alone = 0;
    for (size_t k = 0; k < trials; k++) {
        const enum chain_family family = (enum chain_family)(k % CHAIN_SLAB);
        struct ground_scene *scene = create_ground_scene();
        double x[POINTS], y[POINTS], size = 1;
        narc_point point[POINTS];
        narc_distance rows[2 * POINTS], others[2 * POINTS];
        narc_error error;
        scene->place = turned_body(random_between(&random, -PI, PI), 1);
        if (add_ground(scene, make_chain(&random, family), (narc_chain_options){0}, &error) != NARC_OK) {
            destroy_ground_scene(scene);
            continue;
        }
        const struct chain *chain = &scene->chain;
        for (size_t i = 0; i < chain->count; i++) {
            const narc_point at = chain_point(&chain->arcs[i], chain->arcs[i].start);
            size = fmax(size, fmax(fabs(chain->arcs[i].radius), fabs(at.x) + fabs(at.y)));
        }
        for (int i = 0; i < POINTS; i++) {
            const narc_arc *arc = &chain->arcs[random_below(&random, chain->count)];
            const narc_point at = chain_point(arc, arc->start + random_unit(&random) * (arc->end - arc->start));
            const double away = random_log_between(&random, 1e-3, 10);
            struct body there = turned_body(0, 1);
            point[i] =
                (narc_point){at.x + random_between(&random, -away, away), at.y + random_between(&random, -away, away)};
            there.x = point[i].x;
            there.y = point[i].y;
            there = ground_to_world(scene, there);
            x[i] = there.x;
            y[i] = there.y;
        }
        AUTO(free_at) narc_box *boxes = malloc(scene->count * sizeof *boxes);
        const narc_bodies bodies = view_columns(scene->bodies, scene->count);
        AUTO(narc_destroy_index_at) narc_index *index = index_bodies(scene->store, &bodies, NULL, boxes);
        const narc_points points = {POINTS, NARC_POSITION_ARRAY(x), NARC_POSITION_ARRAY(y), {NULL}};
        const narc_nearest_options two = {.most = 2};
        expect_ok(narc_find_nearest(index, scene->store, &bodies, &points, &two, rows, 2 * POINTS, &error), &error);
        for (int i = 0; i < POINTS; i++, all++) {
            check_nearest(scene, point[i], &rows[2 * i], size);
            behind += rows[2 * i].separation < 0;
            if (rows[2 * i + 1].count == 1)
                assert_true(fabs((double)rows[2 * i].separation) <=
                            fabs((double)rows[2 * i + 1].separation) + 4e-5 * size);
        }
        test_use_isa("scalar");
        expect_ok(narc_find_nearest(index, scene->store, &bodies, &points, &two, others, 2 * POINTS, &error), &error);
        assert_memory_equal(rows, others, sizeof rows);
        test_use_isa(test_isa());
        /* The same rows of points each with its nearest piece. */
        uint32_t near[POINTS];
        for (int i = 0; i < POINTS; i++)
            near[i] = rows[2 * i].body;
        expect_ok(narc_find_distances(scene->store, &bodies, &points, &NARC_ARRAY(near), NULL, others, &error), &error);
        for (int i = 0; i < POINTS; i++) {
            alone += others[i].count;
            const double off = hypot((double)(others[i].place_x - rows[2 * i].place_x),
                                     (double)(others[i].place_y - rows[2 * i].place_y));
            if (others[i].count == 1) { /* else an end is nearest */
                EXPECT(off, 0, 3e-5 * size);
                EXPECT(fabsf(others[i].separation), fabs((double)rows[2 * i].separation), 4e-6 * size);
            }
        }
        destroy_ground_scene(scene);
    }
    assert_true(behind > all / 8 && behind < all && alone > all / 2);
}

/* The same of the answer to one point. */
static void check_nearest_to(struct ground_scene *scene, narc_point point) {
    AUTO(free_at) narc_box *boxes = malloc(scene->count * sizeof *boxes);
    const narc_bodies bodies = view_columns(scene->bodies, scene->count);
    AUTO(narc_destroy_index_at) narc_index *index = index_bodies(scene->store, &bodies, NULL, boxes);
    const struct body there =
        ground_to_world(scene, (struct body){.x = point.x, .y = point.y, .cosine = 1, .scale = 1});
    const narc_points points = {1, {&there.x, 0, NARC_FLOAT64}, {&there.y, 0, NARC_FLOAT64}, {NULL}};
    narc_distance row;
    narc_error error;
    expect_ok(narc_find_nearest(index, scene->store, &bodies, &points, NULL, &row, 1, &error), &error);
    check_nearest(scene, point, &row, 1);
}

/* A corner that is cut: its parts go on beyond it, by so little that a point in the air may be behind the other part. */
TEST(test_nearest_to_cut_corners) {
    enum { POINTS = 64 };
    for (int sides = 3; sides <= 5; sides++) {
        AUTO(destroy_ground_scene_at) struct ground_scene *scene = create_ground_scene();
        struct turtle t = create_turtle(0, 0, PI / 2);
        narc_error error;
        for (int k = 0; k < sides; k++) {
            walk_arc(&t, 0, 2 * PI / sides);
            walk_line(&t, 1);
        }
        scene->place = turned_body(0.3, 1);
        expect_ok(add_ground(scene, end_walk(&t, true), (narc_chain_options){0}, &error), &error);
        const narc_point corner = chain_point(&scene->chain.arcs[0], 0);
        for (double away = 1e-3; away < 4; away *= 2)
            for (int i = 0; i < POINTS; i++) {
                const double angle = 2 * PI * (i + 0.3) / POINTS;
                check_nearest_to(scene, (narc_point){corner.x + away * cos(angle), corner.y + away * sin(angle)});
            }
    }
}

/* The bottom of a valley between arcs, which go on beyond it, into the solid: from below none of that is nearest. */
TEST(test_nearest_to_valleys) {
    struct turtle t = create_turtle(0, 0, PI / 2 - 0.5);
    walk_arc(&t, 2, 0.7);
    walk_arc(&t, 0, -0.4);
    walk_arc(&t, 3, 0.7);
    AUTO(destroy_ground_scene_at) struct ground_scene *scene = lay_ground(end_walk(&t, false), (narc_chain_options){0});
    const narc_point bottom = chain_point(&scene->chain.arcs[1], 0);
    for (int k = -12; k <= 12; k++) { /* across all its normals, and beyond */
        const double angle = PI / 2 + 0.025 * k;
        check_nearest_to(scene, (narc_point){bottom.x - cos(angle), bottom.y - sin(angle)});
    }
}

TEST_MAIN("ground points")
