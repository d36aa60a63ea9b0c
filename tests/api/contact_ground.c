/* SPDX-License-Identifier: MIT
 *
 * contact_ground.c - contacts that stay, of a few bodies and ground: one scene for each fault that there was.
 */
#include <math.h>
#include <string.h>

#include "expect.h"
#include "few_bodies.h"
#include "narc.h"
#include "narc_chains.h"

/* A ball lies where two entries meet, and one row is merged away. The piece that has the other goes, or is no ground any
 * more: what was merged away is told. */
TEST(ground_that_goes_leaves_what_it_was_merged_with) {
    const narc_arc line[] = {{2, 0, 0, PI / 2, PI / 2}, {-2, 0, 0, PI / 2, PI / 2}};
    for (int way = 0; way < 20; way++) {
        AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 2, NULL);
        static uint32_t run[600];
        static uint64_t mask[600];
        const uint32_t small = store_shape(few->store, circle_of(0.01));
        const size_t wall = lay_entries(few, line, 2, 0.5, run) + 1, gone = 1 + (size_t)way / 5 % 2;
        memset(mask, 0xff, sizeof mask);
        few->step.run = NARC_ARRAY(run);
        few->filter.mask = NARC_ARRAY(mask);
        few->step.skin = 0.05f;
        few->step.recycling = way < 10 ? 0 : 0.01f;
        few->body[0] = (narc_body){(few->body[1].x + few->body[2].x) / 2, 0.5, 1, 0, 1, 0};
        few->body[wall] = (narc_body){few->body[0].x + 0.5, 0.5, 0, 1, 1, few->body[1].shape};
        few->id[wall] = wall + 1;
        few->kind[wall] = NARC_STATIC;
        run[wall] = run[1] + 1;
        few->bodies.count++;
        check_with_fresh(few);
        assert_int_equal(step_few(few)->touching_count, 2);
        switch (way % 5) {
        case 0:
            mask[gone] = 0;
            break;
        case 1:
            few->kind[gone] |= NARC_SENSOR;
            break;
        case 2:
            few->body[gone].shape = small;
            run[gone] = NARC_NO_RUN;
            break;
        case 3: /* and the last one takes its place */
            few->body[gone] = few->body[wall];
            few->id[gone] = wall + 1;
            run[gone] = run[wall];
            few->bodies.count--;
            break;
        default:
            few->body[gone].y = -50;
            break;
        }
        check_with_fresh(few);
        assert_int_equal(step_few(few)->touching_count, 2);
    }
}

/* A box touches a bowl in two places, turns about the first one, is a sensor for a while, and then the bowl is a circle; another
 * one, in a bowl that stands before it, rests. */
TEST(second_rows_go_with_their_ground) {
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 0.2, 0), 4, NULL);
    const narc_arc bowl = {0, 0, -1, PI / 2 + 0.65, PI / 2 - 0.65};
    static uint32_t run[600];
    const uint32_t circle = store_shape(few->store, circle_of(1));
    const narc_body box = {-0.026, -0.76, 1, 0, 1, 0}; /* the second place is nearly a margin away */
    assert_int_equal(lay_entries(few, &bowl, 1, 0, run), 1);
    few->step.run = NARC_ARRAY(run);
    few->bodies.count = 4;
    few->body[0] = few->body[3] = box;
    few->body[2] = few->body[1];
    few->body[2].x = few->body[3].x = 10;
    run[2] = run[1];
    run[3] = NARC_NO_RUN;
    few->step.recycling = 0.01f;
    const narc_step_result *r = step_few(few);
    const narc_manifold_point at = r->manifolds[r->order[0]].point[0];
    for (int k = 0; k < 2; k++) { /* the first place may follow */
        few->body[0] = turn_about(box, box.x + (double)at.x, box.y + (double)at.y, k ? 0.003 : 0.001);
        r = step_few(few);
        assert_int_equal(r->state[r->order[0]] & (NARC_ASKED | NARC_FOLLOWED), k ? NARC_ASKED : NARC_FOLLOWED);
    }
    few->body[0] = box;
    few->step.recycling = 0;
    check_with_fresh(few);
    few->body[3].x += 1e-3;
    assert_int_equal(step_few(few)->more_count, 2);
    few->kind[0] = NARC_SENSOR;
    assert_int_equal(step_few(few)->more_count, 1);
    few->kind[0] = 0;
    check_with_fresh(few);
    few->body[1].shape = circle;
    check_with_fresh(few);
    assert_int_equal(step_few(few)->more_count, 1);
}

/* A ball where two arcs meet: what both tell is one row where runs are given, whatever was before. */
TEST(runs_are_given_or_not) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 2, NULL);
    const narc_arc bowl[] = {{0, 0, -1, PI / 2 + 0.65, PI / 2}, {0, 0, -1, PI / 2, PI / 2 - 0.65}};
    const uint32_t run = 0;
    const float reach = 0;
    static uint32_t runs[600];
    lay_entries(few, bowl, 2, 0.5, runs);
    few->body[0] = (narc_body){0, -0.5, 1, 0, 1, 0};
    few->step.reach = (narc_float_column){&reach, 0};
    for (size_t k = 0; k < 4; k++) {
        few->step.run = k % 2 ? (narc_index_column){NULL, 0} : (narc_index_column){&run, 0};
        assert_int_equal(step_few(few)->touching_count, 1 + k % 2);
    }
}

/* Ground stands before a body that turns about it: the body's middle, far from its place, goes further than the ground reaches. */
TEST(ground_may_come_first) {
    const narc_arc bowl = {0, 10, -10, PI / 2 + 0.05, PI / 2 - 0.05};
    struct shape circle = circle_of(5);
    circle.arcs[0].center_y = 4.98;
    AUTO(destroy_few_at) struct few *const few = make_few(circle, 2, NULL);
    static uint32_t run[600];
    assert_int_equal(lay_entries(few, &bowl, 1, 0, run), 1);
    const narc_body ground = few->body[1], ball = {0.4, 0, 1, 0, 1, 0};
    few->body[0] = ground;
    for (int k = 0; k < 4; k++) { /* beside the arc, and over it */
        few->body[1] = turn_about(ball, ground.x, ground.y, k < 3 ? 1e-6 * k : 0.06);
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->touching_count, k == 3);
        assert_int_equal(r->asked_count, k != 2);
    }
}

/* A box rides on a piece of ground to another one, and meets it. */
TEST(ground_that_carries_is_not_all) {
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(0.2, 0.2, 0), 2, NULL);
    const narc_arc line[] = {{2, 0, 0, PI / 2, PI / 2}, {-2, 0, 0, PI / 2, PI / 2}};
    static uint32_t run[600];
    assert_int_equal(lay_entries(few, line, 2, 0, run), 1);
    few->bodies.count = 3;
    few->id[2] = 3;
    few->kind[1] = 0;
    few->kind[2] = NARC_STATIC;
    run[2] = run[1] + 1;
    few->step.run = NARC_ARRAY(run);
    few->step.recycling = 0.01f;
    few->body[0] = (narc_body){few->body[1].x, few->body[1].y + 0.1, 1, 0, 1, 0};
    few->body[2] = (narc_body){few->body[0].x + 0.205, few->body[0].y, 0, 1, 1, few->body[1].shape};
    for (size_t step = 0; step < 20; step++) {
        assert_int_equal(step_few(few)->touching_count, 1 + (step > 8));
        few->body[0].x += 0.01;
        few->body[1].x += 0.01;
    }
    few->kind[0] = NARC_ASLEEP;
    few->body[1].y -= 1; /* which takes no notice of its sleep */
    assert_int_equal(step_few(few)->touching_count, 0);
}

/* A ball is asked where it may touch: not above all ground that it is near, nor the pieces beside those it rests on. */
TEST(ground_is_asked_where_it_may_touch) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 2, NULL);
    const narc_arc line[] = {{2, 0, 0, PI / 2, PI / 2}, {-2, 0, 0, PI / 2, PI / 2}};
    const double y[] = {1, 0.9, 0.5, 0.5001, 0.5002, 0.9}; /* the first two: boxes are apart */
    const size_t asked[] = {0, 0, 11, 11, 2, 11};
    static uint32_t run[600];
    lay_entries(few, line, 2, 0.5, run);
    few->step.run = NARC_ARRAY(run);
    for (size_t k = 0; k < sizeof y / sizeof *y; k++) {
        few->body[0] = (narc_body){(few->body[4].x + few->body[5].x) / 2, y[k], 1, 0, 1, 0};
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->asked_count, asked[k]);
        assert_int_equal(r->touching_count, y[k] < 0.6);
    }
}

/* A box sinks into ground that becomes a plain body, while there is no ground any more: the list stays, the pair is asked. */
TEST(ground_that_goes_away) {
    const narc_arc line[] = {{10, 0, 0, PI / 4, PI / 2}, {-10, 0, 0, PI / 2, 3 * PI / 4}};
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 1, 0), 2, NULL);
    static uint32_t run[600];
    const uint32_t slab = store_shape(few->store, box_of(20, 2, 0.5));
    narc_error error;
    assert_int_equal(lay_entries(few, line, 2, 100, run), 1);
    few->step.skin = 0.3f;
    few->body[0].y = 0.505;
    assert_int_equal(step_few(few)->touching_count, 1);
    expect_ok(narc_remove_shape(few->store, few->body[1].shape, &error), &error);
    few->body[1] = (narc_body){0, -1, 1, 0, 1, slab};
    for (int k = 0; k < 4; k++) {
        few->body[0].y -= 0.002;
        check_with_fresh(few);
    }
}

TEST_MAIN("contact ground")
