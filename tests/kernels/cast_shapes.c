/* SPDX-License-Identifier: MIT
 *
 * cast_shapes.c - casts whose answers are known, targets of pairs, broken movers. searches.c has casts through an index
 * against casts of all pairs.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "everything.h"
#include "expect.h"
#include "narc_broad_phase.h"

/* One target for each pair: the rows of casts with that target alone, whatever the pair's bodies. */
TEST(test_targets_of_pairs) {
    enum { BODIES = 100, PAIRS = 2000 };
    struct test_random random = test_random_named("targets of pairs");
    AUTO(destroy_world)
    struct world world = make_world(&random, make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS), BODIES, 0);
    world.shifted = false;
    struct everything e = view_world(&world);
    static float targets[PAIRS][2]; /* a column with a stride */
    static narc_impact rows[PAIRS];
    size_t hits = 0;
    narc_error error;
    for (int k = 0; k < PAIRS; k++)
        targets[k][0] = random_below(&random, 4) ? (float)random_between(&random, -0.2, 1) : 0;
    const narc_cast_options options = {.target = 100, .targets = {targets[0], sizeof targets[0]}};
    expect_ok(narc_cast_pairs(e.shapes, &e.bodies, &e.motions, &e.pairs, NULL, &options, rows, PAIRS, &error), &error);
    e.pairs.count = 1;
    for (uint32_t k = 0; k < PAIRS; k++) {
        const narc_cast_options one = {.target = targets[k][0]};
        narc_impact alone;
        e.pairs.a.base = &world.scene.pairs[k].a;
        e.pairs.b.base = &world.scene.pairs[k].b;
        expect_ok(narc_cast_pairs(e.shapes, &e.bodies, &e.motions, &e.pairs, NULL, &one, &alone, 1, &error), &error);
        alone.pair = k;
        assert_memory_equal(&rows[k], &alone, sizeof alone);
        hits += alone.count == NARC_CAST_HIT && alone.fraction > 0;
    }
    assert_true(hits > PAIRS / 100);
}

/* Movers that are broken, or whose motion is, hit nothing and are counted. */
TEST(test_broken_movers) {
    enum { BODIES = 100 };
    static const uint32_t broken[] = {3, 10, 11, 20, 21, 22, 23};
    struct test_random random = test_random_named("broken movers");
    AUTO(destroy_world)
    struct world world = make_world(&random, make_random_scene(&random, NARC_FLOAT32, BODIES, BODIES), BODIES, 0);
    struct body movers[BODIES];
    narc_box boxes[BODIES];
    narc_impact rows[2][BODIES];
    const struct everything e = view_world(&world);
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(e.shapes, &e.bodies, NULL, boxes);
    struct scene moving = world.scene;
    size_t skipped = 0, next = 0;
    moving.bodies = memcpy(movers, world.scene.bodies, sizeof movers);
    const narc_bodies all = scene_bodies(&moving);
    const narc_cast_options options = {.out_skipped = &skipped};
    narc_error error;
    for (int spoilt = 0; spoilt < 2; spoilt++) {
        expect_ok(narc_cast_shapes(index, e.shapes, &e.bodies, &all, &e.motions, NULL, &options, rows[spoilt], BODIES,
                                   &error),
                  &error);
        assert_int_equal(skipped, spoilt ? 7 : 0);
        movers[3].x_single = NAN;
        movers[10].cosine = 2;
        movers[11].scale = -1;
        world.motion[20].x = NAN;
        world.motion[21].y = INFINITY;
        world.motion[22].angle = NAN;
        world.motion[23].angle = -INFINITY;
    }
    for (uint32_t k = 0; k < BODIES; k++) {
        const narc_impact none = {.pair = k};
        const bool is_broken = next < 7 && broken[next] == k;
        next += is_broken;
        assert_memory_equal(&rows[1][k], is_broken ? &none : &rows[0][k], sizeof none);
    }
}

/* ------------------------------------------------------------------------------------------------ known */

/* Casts one pair of boxes, the first of which moves. */
static narc_impact cast_boxes(struct body a, struct body b, narc_motion motion, const narc_cast_options *options) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
    store_shape(store, box_of(2, 2, 0));
    store_shape(store, box_of(8, 0.125, 0));
    const narc_body of_a = {a.x, a.y, a.cosine, a.sine, a.scale, a.shape},
                    of_b = {b.x, b.y, b.cosine, b.sine, b.scale, b.shape};
    narc_impact impact;
    narc_error error;
    expect_ok(narc_cast_pair(store, &of_a, &motion, &of_b, NULL, options, &impact, &error), &error);
    return impact;
}

static struct body at(double x, double y, double angle, uint32_t shape) {
    struct body body = turned_body(angle, 1);
    body.x = x;
    body.y = y;
    body.shape = shape;
    return body;
}

#define EXPECT(found, expected, tolerance) assert_true(fabs((double)(found) - (expected)) <= (tolerance))

/* Whether bounding circles that touch overlap is a matter of rounding: what goes through the other body hits it. */
TEST(test_circles_that_touch) {
    struct test_random random = test_random_named("circles that touch");
    struct body a = at(0, 0, 0, 0), b = at(1.4142217590853303, 0.00011313774096818694, 0, 0);
    a.scale = b.scale = 0.5f;
    for (size_t k = 0; k < test_trials(20000); k++) {
        const narc_motion motion = {(float)(2 * b.x), (float)(2 * b.y), k % 3 == 2 ? 0.1f : 0};
        const narc_impact impact = cast_boxes(a, b, motion, NULL);
        assert_true(impact.count == NARC_CAST_HIT && impact.fraction < 0.5f);
        const double angle = random_between(&random, 0, 6.3);
        b.x = 1.4142217590853303 * cos(angle) * (1 + 1e-16 * random_between(&random, -4, 4));
        b.y = 1.4142217590853303 * sin(angle);
    }
}

/* A body that turns hits what is as near as the tolerance says: whatever boxes the index has. */
TEST(test_loose_boxes) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
    store_shape(store, box_of(1, 1, 0));
    const narc_body body = {0, 0, 1, 0, 1, 0}, mover = {-5, 1.3, 1, 0, 1, 0};
    narc_bodies bodies, movers;
    narc_view_bodies(&body, 1, &bodies);
    narc_view_bodies(&mover, 1, &movers);
    const float x = 10, angle = 0.001f;
    const narc_motions motions = {.x = {&x, 0}, .angle = {&angle, 0}};
    const narc_cast_options options = {.tolerance = 0.5f};
    narc_box box;
    narc_impact impact[2];
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_error error;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(store, &bodies, NULL, &box, &error), &error);
    for (int k = 0; k < 2; k++) {
        box.max_y += (float)k;
        expect_ok(narc_build_index(index, &box, 1, NULL, &error), &error);
        expect_ok(narc_cast_shapes(index, store, &bodies, &movers, &motions, NULL, &options, &impact[k], 1, &error),
                  &error);
        assert_int_equal(impact[k].count, NARC_CAST_HIT);
    }
    assert_memory_equal(&impact[0], &impact[1], sizeof impact[0]);
}

/* A box that stands a little deep in a floor: what it hits when it is let go. */
TEST(test_movers_that_touch) {
    enum { FLOOR, WALL, BODIES };
    static const struct {
        float x, y, angle;
        uint32_t count, body;
        double fraction;
    } casts[] = {
        {16, 0, 0, NARC_CAST_HIT, WALL, 0.5},       /* along the floor to the wall */
        {16, -0.004f, 0, NARC_CAST_HIT, WALL, 0.5}, /* hardly deeper */
        {16, -1, 0, NARC_CAST_HIT, FLOOR, 0},
        {0, -0.25f, 0, NARC_CAST_HIT, FLOOR, 0},
        {0, 4, 0, NARC_CAST_MISS, 0, 0},
        {-4, 4, 1, NARC_CAST_MISS, 0, 0},
        {4, 0.25f, 1, NARC_CAST_HIT, FLOOR, 0}, /* its corner turns into it */
    };
    AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
    const uint32_t box = store_shape(store, box_of(2, 2, 0)), floor = store_shape(store, box_of(80, 2, 0));
    const narc_body rows[BODIES] = {{0, -2, 1, 0, 1, floor}, {10, 0, 1, 0, 1, box}}, mover = {0, -0.001, 1, 0, 1, box};
    narc_bodies bodies, movers;
    narc_view_bodies(rows, BODIES, &bodies);
    narc_view_bodies(&mover, 1, &movers);
    narc_box boxes[BODIES];
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(store, &bodies, NULL, boxes);
    const uint32_t owner[BODIES] = {7, 3}, own = 3;
    const narc_owners owners = {.owner = NARC_ARRAY(owner), .ignored = {&own, 0}};
    const narc_index_query of_wall = {.owners = &owners};
    narc_error error;
    for (size_t k = 0; k < sizeof casts / sizeof casts[0]; k++)
        for (int way = 0; way < 3; way++) { /* held; let go; let go by one that belongs to the wall */
            const narc_motions motions = {{&casts[k].x, 0}, {&casts[k].y, 0}, {&casts[k].angle, 0}, {NULL}};
            const narc_cast_options options = {.tolerance = 0.001f, .parting = way > 0 ? 0.005f : 0};
            const bool held = way == 0, passes = way == 2 && casts[k].body == WALL;
            narc_impact hit;
            expect_ok(narc_cast_shapes(index, store, &bodies, &movers, &motions, way == 2 ? &of_wall : NULL, &options,
                                       &hit, 1, &error),
                      &error);
            assert_int_equal(hit.count, held ? NARC_CAST_HIT : passes ? NARC_CAST_MISS : casts[k].count);
            assert_int_equal(hit.body, held ? FLOOR : passes ? 0 : casts[k].body);
            EXPECT(hit.fraction, held || passes ? 0 : casts[k].fraction, 1e-6);
        }
}

TEST(test_known) {
    const struct body left = at(0, 0, 0, 0), right = at(10, 0, 0, 0);
    narc_impact i = cast_boxes(left, right, (narc_motion){16, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    assert_true(i.fraction == 0.5f && i.separation == 0 && i.normal_x == 1 && i.normal_y == 0);
    assert_true(i.point_x == 1 && i.point_y == 0 && i.body == 1 && i.pair == 0);
    i = cast_boxes(left, right, (narc_motion){7.5f, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, right, (narc_motion){8, 0, 0}, NULL); /* they touch as the step ends */
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 1);
    i = cast_boxes(left, right, (narc_motion){16, 0, 0}, &(narc_cast_options){.target = 4});
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0.25f && i.separation == 4);
    i = cast_boxes(left, right, (narc_motion){16, 0, 0}, &(narc_cast_options){.target = -1});
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0.5625f && i.separation == -1);
    i = cast_boxes(left, right, (narc_motion){16, 0, 0}, &(narc_cast_options){.target = -2.5f});
    assert_int_equal(i.count, NARC_CAST_MISS); /* never so deep */
    /* At the start: touching and parting, apart and parting, deeper and parting. */
    i = cast_boxes(left, at(2, 0, 0, 0), (narc_motion){-1, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0);
    i = cast_boxes(left, at(2.0625, 0, 0, 0), (narc_motion){-1, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(1.5, 0, 0, 0), (narc_motion){-1, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0 && i.separation == -0.5f);
    /* No motion. */
    i = cast_boxes(left, right, (narc_motion){0, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(1, 0, 0, 0), (narc_motion){0, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0 && i.separation == -1);
    /* It slides past, closer than half a rounding of its way, but apart. */
    i = cast_boxes(left, at(5, 2 + 1e-5, 0, 0), (narc_motion){100, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(5, 2 - 1e-5, 0, 0), (narc_motion){100, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    EXPECT(i.fraction, 0.03, 1e-6);
    /* A bar of 8 x 1/8 turns by a quarter turn, until a corner of its end, at (4, -1/16) before, is 2 lower. */
    i = cast_boxes(at(0, 3, 0, 1), at(3.5, 0, 0, 0), (narc_motion){0, 0, -1.5707963f}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    assert_true(i.separation >= 0 && i.separation <= 2.0f / 1024);
    EXPECT(i.fraction, (asin(2 / hypot(4, 0.0625)) - atan2(0.0625, 4)) / 1.57079632679, 1e-3);
    /* A whole turn beside it: the bar comes back to where it was, and was in between. */
    i = cast_boxes(at(0, 3, 0, 1), at(3.5, 0, 0, 0), (narc_motion){0, 0, 6.2831853f}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    i = cast_boxes(at(0, 3, 0, 1), at(8.5, 0, 0, 0), (narc_motion){0, 0, 6.2831853f}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    /* What turns in touch and parts by that. */
    i = cast_boxes(at(0, 1.0625 + 1e-4, 0, 1), at(3.5, 0, 0, 0), (narc_motion){0, 1, 0.01f}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
}

/* A box that is 1 mm deep in a floor of tiles slides over their seams if they are one thing, and is stopped by a wall of the
 * same thing, no deeper than it is in the floor but for `parting`; step by step it does not creep. Tiles that are things by
 * themselves stop it at the next one. */
TEST(a_thing_lets_go_as_one) {
    enum { TILES = 20 };
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    const uint32_t box = store_shape(shapes, box_of(1, 1, 0));
    const float depth = 1e-3f, parting = 1e-4f;
    narc_body tiles[TILES + 1], mover = {0.3, 1 - (double)depth, 1, 0, 1, box};
    uint32_t owner[TILES + 1];
    narc_box boxes[TILES + 1];
    narc_bodies ground, movers;
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_error error;
    narc_impact row;
    for (uint32_t k = 0; k <= TILES; k++) {
        tiles[k] = (narc_body){k, 0, 1, 0, 1, box};
        owner[k] = 7;
    }
    tiles[TILES] = (narc_body){10, 1, 1, 0, 1, box}; /* the wall */
    narc_view_bodies(tiles, TILES + 1, &ground);
    narc_view_bodies(&mover, 1, &movers);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(shapes, &ground, NULL, boxes, &error), &error);
    expect_ok(narc_build_index(index, boxes, TILES + 1, NULL, &error), &error);
    const float right = 8, down = -0.5f, none = 0, far = 12;
    const narc_owners owners = {.owner = NARC_ARRAY(owner)};
    const narc_index_query things = {.owners = &owners};
    const narc_cast_options lets_go = {.parting = parting};
    const narc_motions slides = {.x = {&right, 0}}, sinks = {.x = {&right, 0}, .y = {&down, 0}},
                       goes_far = {.x = {&far, 0}, .y = {&none, 0}};
    expect_ok(narc_cast_shapes(index, shapes, &ground, &movers, &slides, NULL, &lets_go, &row, 1, &error), &error);
    assert_int_equal(row.count, NARC_CAST_HIT); /* the side of a tile */
    assert_true(row.fraction < 0.2f);
    expect_ok(narc_cast_shapes(index, shapes, &ground, &movers, &slides, &things, &lets_go, &row, 1, &error), &error);
    assert_int_equal(row.count, NARC_CAST_MISS);
    expect_ok(narc_cast_shapes(index, shapes, &ground, &movers, &sinks, &things, &lets_go, &row, 1, &error), &error);
    assert_int_equal(row.count, NARC_CAST_HIT);
    assert_true(row.fraction == 0 && row.normal_y == -1);
    for (int step = 0; step < 20; step++) {
        expect_ok(narc_cast_shapes(index, shapes, &ground, &movers, &goes_far, &things, &lets_go, &row, 1, &error),
                  &error);
        assert_int_equal(row.count, NARC_CAST_HIT);
        assert_int_equal(row.body, TILES);
        mover.x += (double)row.fraction * (double)far;
        assert_true(mover.x <= 9 + (double)depth + (double)parting + 1e-5);
    }
    assert_true(mover.x >= 9 - 1e-5);
    for (uint32_t k = 0; k <= TILES; k++) /* all things by themselves, but that they have owners */
        owner[k] = UINT32_MAX;
    mover.x = 0.3;
    expect_ok(narc_cast_shapes(index, shapes, &ground, &movers, &slides, &things, &lets_go, &row, 1, &error), &error);
    assert_int_equal(row.count, NARC_CAST_HIT);
}

/* A sheet that is a little in each of a crowd of bodies slides under others of the same few things: they let it go as deep as it
 * is in the deepest of their thing. It stops where casts of pairs with those targets say. */
TEST(a_crowd_of_few_things_lets_go) {
    enum { BODIES = 600, HERE = 300, THINGS = 7 };
    struct test_random random = test_random_named("a crowd of few things");
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    const uint32_t box = store_shape(shapes, box_of(1, 1, 0)), sheet = store_shape(shapes, box_of(40, 2, 0));
    narc_body crowd[BODIES], mover = {0, 0, 1, 0, 1, sheet};
    uint32_t owner[BODIES], zero[BODIES] = {0}, number[BODIES];
    narc_box boxes[BODIES];
    narc_bodies bodies, movers;
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_error error;
    narc_impact row, rows[BODIES];
    float target[BODIES], separation[BODIES], deepest[THINGS] = {0};
    for (uint32_t k = 0; k < BODIES; k++) {
        const double x = k < HERE ? random_between(&random, -20, 19) : random_between(&random, 21, 50),
                     depth = random_between(&random, 1e-5, k < HERE ? 1e-3 : 1.2e-3);
        crowd[k] = (narc_body){x, 1.5 - depth, 1, 0, 1, box};
        owner[k] = k % 11 == 0 && k < HERE ? UINT32_MAX : (uint32_t)random_below(&random, THINGS);
        number[k] = k;
    }
    narc_view_bodies(crowd, BODIES, &bodies);
    narc_view_bodies(&mover, 1, &movers);
    const narc_pairs pairs = {.count = BODIES, .a = NARC_ARRAY(zero), .b = NARC_ARRAY(number), .other_bodies = &bodies};
    expect_ok(narc_find_separations(shapes, &movers, &pairs, &(narc_query){.margin = INFINITY}, separation, &error),
              &error);
    for (size_t k = 0; k < BODIES; k++)
        if (owner[k] != UINT32_MAX && separation[k] <= 0)
            deepest[owner[k]] = fminf(deepest[owner[k]], separation[k]);
    const float right = 30, parting = 1e-5f;
    for (size_t k = 0; k < BODIES; k++)
        target[k] = separation[k] <= 0 ? 0 : fminf(0, deepest[owner[k]] - parting);
    const narc_motions slides = {.x = {&right, 0}};
    const narc_owners owners = {.owner = NARC_ARRAY(owner)};
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(shapes, &bodies, NULL, boxes, &error), &error);
    expect_ok(narc_build_index(index, boxes, BODIES, NULL, &error), &error);
    expect_ok(narc_cast_shapes(index, shapes, &bodies, &movers, &slides, &(narc_index_query){.owners = &owners},
                               &(narc_cast_options){.parting = parting}, &row, 1, &error),
              &error);
    expect_ok(narc_cast_pairs(shapes, &movers, &slides, &pairs, NULL,
                              &(narc_cast_options){.targets = NARC_ARRAY(target), .parting = parting}, rows, BODIES,
                              &error),
              &error);
    size_t first = BODIES, let_go = 0;
    for (size_t k = HERE; k < BODIES; k++) {
        assert_true(separation[k] > 0);
        let_go += rows[k].count != NARC_CAST_HIT;
        if (rows[k].count == NARC_CAST_HIT && (first == BODIES || rows[k].fraction < rows[first].fraction))
            first = k;
    }
    assert_true(first < BODIES && let_go > HERE / 2);
    assert_int_equal(row.count, NARC_CAST_HIT);
    assert_int_equal(row.body, number[first]);
    assert_true(row.fraction == rows[first].fraction);
}

TEST_MAIN("cast_shapes")
