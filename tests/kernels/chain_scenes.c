/* SPDX-License-Identifier: MIT
 *
 * chain_scenes.c - what a scene is asked besides contacts, of ground: times of impact and distances of points, against
 * the definition: a place of a body's outline, sampled densely, is beyond a concave arc if it is further from the centre
 * than its radius, in its sector.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "check.h"
#include "expect.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "scene.h"

enum { SAMPLES = 1000, TIMES = 50 };

#define EXPECT(found, expected, tolerance) assert_true(fabs((double)(found) - (expected)) <= (tolerance))

/* A bowl of one arc about the origin, from the angle `low` to `high` as seen from its centre. */
struct bowl {
    double radius, low, high;
    narc_chain_entry entry;
};

static struct bowl add_bowl(narc_shapes *store, double radius, double low, double high) {
    struct bowl bowl = {.radius = radius, .low = low, .high = high};
    const narc_arc arc = {0, 0, -radius, high + PI, low + PI}; /* clockwise */
    size_t count = 0;
    narc_error error;
    expect_ok(narc_add_chain(store, &arc, 1, NULL, &bowl.entry, 1, &count, &error), &error);
    assert_int_equal(count, 1);
    return bowl;
}

/* A body at a time of its motion. */
struct way {
    const struct shape *shape;
    struct body body;
    float motion_x, motion_y, angle;
};

static struct reference_body place(const struct way *way, double time) {
    struct reference_body placed = pose_shape(way->shape, &way->body);
    const double c = cos(time * (double)way->angle), s = sin(time * (double)way->angle), cosine = placed.cosine;
    placed.x += time * (double)way->motion_x;
    placed.y += time * (double)way->motion_y;
    placed.cosine = c * cosine - s * placed.sine;
    placed.sine = c * placed.sine + s * cosine;
    return placed;
}

/* The place of the outline that is furthest in a direction of the body's own axes, in the world. */
static narc_point find_support(const struct reference_body *body, double angle) {
    double x = 0, y = 0;
    for (size_t k = 0; k < body->count; k++) {
        const narc_arc *const arc = &body->arcs[k];
        if (body->count > 1 && fmod(angle - arc->start + 8 * PI, 2 * PI) > fmod(arc->end - arc->start + 8 * PI, 2 * PI))
            continue;
        x = body->scale * (arc->center_x + arc->radius * cos(angle));
        y = body->scale * (arc->center_y + arc->radius * sin(angle));
    }
    return (narc_point){body->x + body->cosine * x - body->sine * y, body->y + body->sine * x + body->cosine * y};
}

static bool holds(const struct bowl *bowl, double x, double y) {
    const double angle = atan2(y, x);
    return remainder(angle - bowl->low, 2 * PI) >= 0 && remainder(bowl->high - angle, 2 * PI) >= 0;
}

/* How far the outline is beyond the bowl, at most, in its sector or not; -infinity if none of it is there. */
static double find_depth_of(const struct reference_body *body, const struct bowl *bowl, bool in_sector) {
    double most = -INFINITY;
    for (int k = 0; k < SAMPLES; k++) {
        const narc_point p = find_support(body, 2 * PI * k / SAMPLES);
        if (holds(bowl, p.x, p.y) == in_sector)
            most = fmax(most, hypot(p.x, p.y) - bowl->radius);
    }
    return most;
}

static double find_depth(const struct reference_body *body, const struct bowl *bowl) {
    return find_depth_of(body, bowl, true);
}

/* How near the ends of the bowl are to a body, at least; negative within it. */
static double find_ends(const struct reference_body *body, const struct bowl *bowl) {
    double least = INFINITY;
    for (int end = 0; end < 2; end++) {
        const double angle = end ? bowl->high : bowl->low;
        least = fmin(least, reference_point_distance(body, bowl->radius * cos(angle) - body->x,
                                                     bowl->radius * sin(angle) - body->y));
    }
    return least;
}

/* ------------------------------------------------------------------------------------------------ casts */

static struct way make_way(struct test_random *random, const struct shape *shape, bool turns) {
    struct way way = {.shape = shape,
                      .body = turned_body(random_between(random, -3, 3), random_between(random, 0.3, 1.5))};
    way.body.x = random_between(random, -1.5, 1.5);
    way.body.y = random_between(random, -1.5, 1.5);
    round_position(&way.body, NARC_FLOAT64);
    way.motion_x = (float)random_between(random, -9, 9);
    way.motion_y = (float)random_between(random, -9, 9);
    way.angle = turns ? (float)random_between(random, -2, 2) : 0;
    return way;
}

/* The ground is the only body of its set, and A or B of the pair. */
static narc_impact cast(narc_shapes *store, const struct bowl *bowl, const struct way *way, bool ground_first) {
    const float one = 1, nothing = 0;
    const narc_bodies ground = {.count = 1,
                                .x = {&bowl->entry.x, 0, NARC_FLOAT64},
                                .y = {&bowl->entry.y, 0, NARC_FLOAT64},
                                .cosine = {&one, 0},
                                .sine = {&nothing, 0},
                                .shape = {&bowl->entry.shape, 0}};
    const narc_bodies body = {.count = 1,
                              .x = {&way->body.x, 0, NARC_FLOAT64},
                              .y = {&way->body.y, 0, NARC_FLOAT64},
                              .cosine = {&way->body.cosine, 0},
                              .sine = {&way->body.sine, 0},
                              .scale = {&way->body.scale, 0},
                              .shape = {&way->body.shape, 0}};
    const narc_motions motion = {.x = {&way->motion_x, 0}, .y = {&way->motion_y, 0}, .angle = {&way->angle, 0}};
    const narc_pairs pairs = {.count = 1, .other_bodies = ground_first ? &body : &ground};
    narc_impact row;
    narc_error error;
    expect_ok(narc_cast_pairs(store, ground_first ? &ground : &body, ground_first ? NULL : &motion, &pairs,
                              ground_first ? &motion : NULL, NULL, &row, 1, &error),
              &error);
    return row;
}

/* How much of a body may be beyond what it is told to touch: the tolerance of what turns, and samples that miss. */
static double find_room(const struct way *way) { return (double)way->body.scale * (way->angle == 0 ? 3e-4 : 4e-3); }

static bool is_free(const struct way *way, const struct bowl *bowl, double time, double room) {
    const struct reference_body body = place(way, time);
    return find_depth(&body, bowl) <= room && find_ends(&body, bowl) >= -room;
}

/* When does a body come to lie beyond the bowl, or an end of the bowl in the body, before `end`? Else infinity. In
 * *out_round: was it beyond the circle before, outside the sector? From there it can come to lie behind the arc. */
static double find_first_touch(const struct way *way, const struct bowl *bowl, double end, double room,
                               bool *out_round) {
    *out_round = false;
    for (int k = 0; k <= TIMES; k++) {
        const struct reference_body body = place(way, end * k / TIMES);
        *out_round = *out_round || find_depth_of(&body, bowl, false) > 0;
        if (is_free(way, bowl, end * k / TIMES, room))
            continue;
        double low = end * (k > 0 ? k - 1 : 0) / TIMES, high = end * k / TIMES;
        for (int halving = 0; halving < 30; halving++) {
            const double middle = (low + high) / 2;
            *(is_free(way, bowl, middle, room) ? &low : &high) = middle;
        }
        return high;
    }
    return INFINITY;
}

/* A hit touches, and nothing did before. An end is not told of: the piece beside it has it. */
static void check_cast(const struct way *way, const struct bowl *bowl, const narc_impact *row, bool ground_first) {
    const double room = find_room(way), time = row->count == NARC_CAST_MISS ? 1 : (double)row->fraction;
    const struct reference_body then = place(way, time);
    bool round;
    const double first = find_first_touch(way, bowl, time, room, &round);
    if (round)
        return;
    if (first < INFINITY) {
        const struct reference_body touching = place(way, first);
        assert_true(find_ends(&touching, bowl) <= room);
        return;
    }
    if (row->count != NARC_CAST_HIT)
        return;
    const double depth = find_depth(&then, bowl);
    assert_true(fabs(depth) <= room);
    const double x = (double)row->point_x + (ground_first ? bowl->entry.x : then.x);
    const double y = (double)row->point_y + (ground_first ? bowl->entry.y : then.y);
    EXPECT(hypot(x, y), bowl->radius, 2 * room + 1e-5);
    const double sign = ground_first ? -1 : 1;
    EXPECT(sign * (double)row->normal_x, x / bowl->radius, 1e-3);
    EXPECT(sign * (double)row->normal_y, y / bowl->radius, 1e-3);
}

TEST(test_casts) {
    struct test_random random = test_random_named("bowls");
    const size_t trials = test_trials(300);
    size_t hits = 0, misses = 0;
    for (size_t k = 0; k < trials; k++) {
        narc_shapes *const store = empty_store();
        const enum family family = (enum family)random_below(&random, FAMILY_COUNT);
        struct shape shape = make_shape(&random, family);
        const double low = random_between(&random, -3, 3);
        const struct bowl bowl =
            add_bowl(store, random_between(&random, 4, 6), low, low + random_between(&random, 0.2, 1.9));
        struct way way = make_way(&random, &shape, k % 2 == 1);
        way.body.shape = store_shape(store, shape);
        const struct reference_body start = place(&way, 0);
        if (find_depth(&start, &bowl) < -0.01 && find_ends(&start, &bowl) > 0.01) {
            const bool ground_first = k % 4 < 2;
            const narc_impact row = cast(store, &bowl, &way, ground_first);
            check_cast(&way, &bowl, &row, ground_first);
            hits += row.count == NARC_CAST_HIT;
            misses += row.count == NARC_CAST_MISS;
        }
        narc_destroy_shapes(store);
    }
    assert_true(hits > trials / 16 && misses > trials / 16);
}

/* ------------------------------------------------------------------------------------------------ points */

TEST(test_points) {
    struct test_random random = test_random_named("points and bowls");
    const size_t trials = test_trials(5000);
    size_t found = 0;
    for (size_t k = 0; k < trials; k++) {
        narc_shapes *const store = empty_store();
        const double low = random_between(&random, -3, 3), high = low + random_between(&random, 0.2, 1.9);
        const struct bowl bowl = add_bowl(store, random_between(&random, 1, 6), low, high);
        const float one = 1, nothing = 0;
        const narc_bodies ground = {.count = 1,
                                    .x = {&bowl.entry.x, 0, NARC_FLOAT64},
                                    .y = {&bowl.entry.y, 0, NARC_FLOAT64},
                                    .cosine = {&one, 0},
                                    .sine = {&nothing, 0},
                                    .shape = {&bowl.entry.shape, 0}};
        const double x = random_between(&random, -8, 8), y = random_between(&random, -8, 8);
        const narc_points points = {.count = 1, .x = {&x, 0, NARC_FLOAT64}, .y = {&y, 0, NARC_FLOAT64}};
        narc_distance row;
        narc_error error;
        expect_ok(narc_find_distances(store, &ground, &points, (narc_index_column){0}, NULL, &row, &error), &error);
        if (holds(&bowl, x, y)) {
            const double away = hypot(x, y);
            found++;
            assert_int_equal(row.count, 1);
            EXPECT(row.separation, bowl.radius - away, 4e-6 * (away + bowl.radius));
            EXPECT(row.normal_x, -x / away, 4e-6 * (1 + bowl.radius / away));
            EXPECT((double)row.place_x + bowl.entry.x, x / away * bowl.radius,
                   1e-5 * bowl.radius * (1 + bowl.radius / away));
            EXPECT(row.radius, -bowl.radius, 1e-6 * bowl.radius);
        } else if (!holds(&(struct bowl){.low = low - 0.001, .high = high + 0.001}, x, y)) {
            assert_int_equal(row.count, 0);
        }
        narc_destroy_shapes(store);
    }
    assert_true(found > trials / 8);
}

/* ------------------------------------------------------------------------------------------------ runs */

/* A level ground from x = -4 to x = 4, solid below. What lies beyond its ends is closed off, and does not touch. */
TEST(test_runs) {
    const narc_arc line[2] = {{4, 0, 0, PI / 2, PI / 2}, {-4, 0, 0, PI / 2, PI / 2}};
    narc_shapes *const store = empty_store();
    struct bowl ground = {.radius = 0};
    const struct shape ball = circle_of(0.5), box = box_of(2, 1, 0);
    const uint32_t ball_index = store_shape(store, ball), box_index = store_shape(store, box);
    size_t count = 0;
    narc_error error;
    expect_ok(narc_add_chain(store, line, 2, NULL, &ground.entry, 1, &count, &error), &error);
    for (int first = 0; first < 2; first++) {
        struct way fall = {&ball, turned_body(0, 1), 0, -4, 0};
        fall.body.y = 2.5;
        fall.body.shape = ball_index;
        narc_impact row = cast(store, &ground, &fall, first);
        assert_true(row.count == NARC_CAST_HIT && row.fraction == 0.5f);
        EXPECT(row.normal_y, first ? 1 : -1, 1e-6);
        fall.body.x = 4.25; /* over the end: its middle falls past it */
        assert_int_equal(cast(store, &ground, &fall, first).count, NARC_CAST_MISS);
        fall.body.x = 12;
        assert_int_equal(cast(store, &ground, &fall, first).count, NARC_CAST_MISS);
        fall.shape = &box; /* turning by a quarter turn brings a corner down first */
        fall.body.x = 0;
        fall.body.shape = box_index;
        fall.angle = (float)PI / 2;
        row = cast(store, &ground, &fall, first);
        assert_int_equal(row.count, NARC_CAST_HIT);
        const struct reference_body then = place(&fall, (double)row.fraction);
        double lowest = INFINITY;
        for (int k = 0; k < SAMPLES; k++)
            lowest = fmin(lowest, find_support(&then, 2 * PI * k / SAMPLES).y);
        EXPECT(lowest, 0, 2e-3);
    }
    const double x[3] = {1, 5, -1}, y[3] = {2, 2, -0.25};
    const float one = 1, nothing = 0;
    const narc_bodies bodies = {.count = 1,
                                .x = {&ground.entry.x, 0, NARC_FLOAT64},
                                .y = {&ground.entry.y, 0, NARC_FLOAT64},
                                .cosine = {&one, 0},
                                .sine = {&nothing, 0},
                                .shape = {&ground.entry.shape, 0}};
    const narc_points points = {3, NARC_POSITION_ARRAY(x), NARC_POSITION_ARRAY(y), {NULL}};
    const uint32_t body = 0;
    narc_distance row[3];
    expect_ok(narc_find_distances(store, &bodies, &points, (narc_index_column){&body, 0}, NULL, row, &error), &error);
    assert_true(row[0].count == 1 && row[1].count == 0 && row[2].count == 1);
    EXPECT(row[0].separation, 2, 1e-6);
    EXPECT(row[2].separation, -0.25, 1e-6);
    narc_destroy_shapes(store);
}

/* ------------------------------------------------------------------------------------------------ nearest */

static narc_point find_arc_point(const narc_arc *arc, double part) {
    const double angle = arc->start + part * (arc->end - arc->start);
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

/* The entries of a chain that is turned, and an index of them. */
enum { ENTRIES = 4 * CHAIN_ARCS, POINTS = 50 };

struct ground_scene {
    narc_shapes *store;
    narc_index *index;
    narc_body bodies[ENTRIES];
    narc_box boxes[ENTRIES];
    size_t count;
    float cosine, sine;
};

static bool lay_ground(struct ground_scene *scene, const struct chain *chain, double angle) {
    static narc_chain_entry entries[ENTRIES];
    const narc_chain_options options = {.closed = chain->closed};
    scene->store = empty_store();
    if (narc_add_chain(scene->store, chain->arcs, chain->count, &options, entries, ENTRIES, &scene->count, NULL) !=
        NARC_OK) {
        narc_destroy_shapes(scene->store);
        return false;
    }
    scene->cosine = (float)cos(angle);
    scene->sine = (float)sin(angle);
    const double length = hypot((double)scene->cosine, (double)scene->sine);
    const double c = (double)scene->cosine / length, s = (double)scene->sine / length;
    for (size_t k = 0; k < scene->count; k++)
        scene->bodies[k] = (narc_body){.x = c * entries[k].x - s * entries[k].y,
                                       .y = s * entries[k].x + c * entries[k].y,
                                       .cosine = scene->cosine,
                                       .sine = scene->sine,
                                       .scale = 1,
                                       .shape = entries[k].shape};
    const narc_bodies bodies = narc_view_bodies(scene->bodies, scene->count);
    scene->index = index_bodies(scene->store, &bodies, NULL, scene->boxes);
    return true;
}

/* Is a row that of the nearest place of the ground? `size`: what the chain's numbers are in proportion to. */
static void check_nearest(const struct ground_scene *scene, struct ground *ground, narc_point p,
                          const narc_distance *row, double size) {
    const double length = hypot((double)scene->cosine, (double)scene->sine);
    const double c = (double)scene->cosine / length, s = (double)scene->sine / length;
    const narc_body *const body = &scene->bodies[row->body];
    const double x = body->x + (double)row->place_x, y = body->y + (double)row->place_y;
    const narc_point at = {c * x + s * y, c * y - s * x};
    const double distance = ground_outline_distance(ground, p), room = 3e-5 * (size + distance);
    assert_int_equal(row->count, 1);
    EXPECT(fabsf(row->separation), distance, room);
    EXPECT(ground_outline_distance(ground, at), 0, room);
    EXPECT(hypot(p.x - at.x, p.y - at.y), distance, room);
    if (distance > 100 * room) {
        const double n_x = (c * (p.x - at.x) - s * (p.y - at.y)) / (double)row->separation;
        const double n_y = (s * (p.x - at.x) + c * (p.y - at.y)) / (double)row->separation;
        EXPECT(row->normal_x, n_x, 0.05);
        EXPECT(row->normal_y, n_y, 0.05);
    }
    const struct ground_foot foot = ground_distance(ground, p);
    if (isfinite(foot.distance) && distance > 2 * room) /* else an open end is nearer */
        assert_true((row->separation < 0) == (foot.distance < 0));
}

TEST(test_nearest) {
    struct test_random random = test_random_named("points and ground");
    static narc_arc arcs[CHAIN_ARCS];
    static struct ground_scene scene;
    const size_t trials = test_trials(100);
    size_t behind = 0, all = 0;
    for (size_t k = 0; k < trials; k++) {
        const struct chain chain = make_chain(&random, (enum chain_family)(k % CHAIN_SLAB), arcs);
        const double angle = random_between(&random, -PI, PI);
        double x[POINTS], y[POINTS], size = 1;
        narc_point point[POINTS];
        narc_distance rows[2 * POINTS], others[2 * POINTS];
        if (!lay_ground(&scene, &chain, angle))
            continue;
        struct ground *const ground = make_ground(&chain);
        const double length = hypot((double)scene.cosine, (double)scene.sine);
        for (size_t i = 0; i < chain.count; i++) {
            const narc_point at = find_arc_point(&arcs[i], 0);
            size = fmax(size, fmax(fabs(arcs[i].radius), fabs(at.x) + fabs(at.y)));
        }
        for (int i = 0; i < POINTS; i++) {
            const narc_point at =
                find_arc_point(&arcs[random_below(&random, chain.count)], random_between(&random, 0, 1));
            const double away = random_log_between(&random, 1e-3, 10);
            point[i] =
                (narc_point){at.x + random_between(&random, -away, away), at.y + random_between(&random, -away, away)};
            x[i] = ((double)scene.cosine * point[i].x - (double)scene.sine * point[i].y) / length;
            y[i] = ((double)scene.sine * point[i].x + (double)scene.cosine * point[i].y) / length;
        }
        const narc_bodies bodies = narc_view_bodies(scene.bodies, scene.count);
        const narc_points points = {POINTS, NARC_POSITION_ARRAY(x), NARC_POSITION_ARRAY(y), {NULL}};
        const narc_nearest_options two = {.most = 2};
        narc_error error;
        expect_ok(narc_find_nearest(scene.index, scene.store, &bodies, &points, &two, rows, 2 * POINTS, &error),
                  &error);
        for (int i = 0; i < POINTS; i++, all++) {
            check_nearest(&scene, ground, point[i], &rows[2 * i], size);
            behind += rows[2 * i].separation < 0;
            if (rows[2 * i + 1].count == 1)
                assert_true(fabs((double)rows[2 * i].separation) <=
                            fabs((double)rows[2 * i + 1].separation) + 4e-5 * size);
        }
        test_use_isa("scalar");
        expect_ok(narc_find_nearest(scene.index, scene.store, &bodies, &points, &two, others, 2 * POINTS, &error),
                  &error);
        assert_memory_equal(rows, others, sizeof rows);
        test_use_isa(test_isa());
        destroy_ground(ground);
        narc_destroy_index(scene.index);
        narc_destroy_shapes(scene.store);
    }
    assert_true(behind > all / 8 && behind < all);
}

TEST_MAIN("chain_scenes")
