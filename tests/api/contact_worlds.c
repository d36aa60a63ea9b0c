/* SPDX-License-Identifier: MIT
 *
 * contact_worlds.c - contacts that stay, of crowds: far away, while their origin moves, and in worlds that do not meet.
 */
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "families.h"
#include "few_bodies.h"
#include "narc.h"
#include "step_world.h"

/* A crowd of boxes, 20 in a row, that nearly touch. */
static struct few *make_crowd(double x, double y) {
    struct few *const few = make_few(box_of(1, 1, 0), 600, NULL);
    for (size_t k = 0; k < 600; k++) {
        few->body[k].x = x + (double)(k % 20) * 1.0001;
        few->body[k].y = y + (double)(k / 20) * 1.0001;
    }
    few->step.skin = 0.03f;
    return few;
}

/* However far away a crowd is, it has the pairs that it has at home: eight neighbours each. */
TEST(worlds_far_away_have_the_pairs_of_near_ones) {
    static const double far[] = {0, 1e6, 1e7, 1e8, 1e9};
    size_t here = 0;
    for (size_t k = 0; k < sizeof far / sizeof *far; k++) {
        const narc_point origin = {far[k], -far[k]};
        AUTO(destroy_few_at) struct few *const few = make_crowd(far[k], -far[k]);
        few->step.origin = k > 0 ? &origin : NULL;
        const narc_step_result *const r = step_few(few);
        here = k > 0 ? here : r->count;
        assert_int_equal(r->count, here);
        assert_true(r->count < 4 * 600);
    }
}

/* Nothing begins, ends, comes, goes or is asked where nothing moves but the origin, near or far; and those who move then are
 * found. */
TEST(an_origin_that_moves_keeps_everything) {
    static const double ways[] = {0.5, 20, 300, 4e3, 1e6, -1e6, 7};
    for (int recycling = 0; recycling < 2; recycling++) {
        AUTO(destroy_few_at) struct few *const few = make_crowd(3e5, 2e5);
        narc_point origin = {3e5, 2e5};
        narc_manifold rows[600 * 8];
        uint32_t order[600 * 8];
        few->step.origin = &origin;
        few->step.recycling = recycling ? 0.01f : 0;
        const narc_step_result *r = step_few(few);
        few->body[7].x += 1e-4; /* within its box, so that it follows */
        r = step_few(few);
        const size_t count = r->count;
        assert_true(count < 600 * 4);
        memcpy(order, r->order, count * sizeof *order);
        memcpy(rows, r->manifolds, count * sizeof *rows);
        for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
            origin.x += ways[k];
            origin.y -= ways[k];
            r = step_few(few);
            assert_int_equal(r->began_count + r->ended_count + r->asked_count, 0);
            assert_int_equal(r->count, count);
            assert_memory_equal(r->order, order, count * sizeof *order);
            assert_memory_equal(r->manifolds, rows, count * sizeof *rows);
            for (size_t i = 0; i < count; i++)
                assert_false(r->state[order[i]] & (NARC_NEW | NARC_ASKED | NARC_FOLLOWED));
        }
        few->body[0].x += 1.5; /* over the next one */
        r = step_few(few);
        assert_true(r->began_count > 0);
    }
}

/* A step that is refused while its origin moves: the next one finds what comes, though all others stand where they stood. */
TEST(a_step_that_is_refused_forgets_no_origin) {
    AUTO(destroy_few_at) struct few *const few = make_crowd(0, 0);
    narc_point origin = {0, 0};
    few->step.origin = &origin;
    step_few(few);
    for (int k = 1; k < 4; k++) {
        const narc_step_result *r;
        narc_error error;
        origin.x = 1e6 * k;
        few->body[599].shape = 7;
        expect_error(narc_update_contacts(few->contacts, few->store, &few->step, &r, &error), NARC_ERROR_INDEX, &error,
                     "body 599: shape is 7");
        few->body[599].shape = few->body[0].shape;
        few->body[20 * k].x += 1.5; /* over the next one */
        assert_true(step_few(few)->began_count > 0);
    }
}

/* Contacts that were saved go on from their boxes' origin. */
TEST(the_origin_is_saved) {
    AUTO(destroy_few_at) struct few *const few = make_crowd(1e7, 1e7);
    narc_contacts *const saved = few->contacts, *const loaded = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    narc_point origin = {1e7, 1e7};
    struct bytes from = {0};
    few->step.origin = &origin;
    step_few(few);
    save(saved, &from);
    expect_ok(narc_load_contacts(loaded, few->store, from.all, from.count, NULL, NULL), NULL);
    for (int k = 0; k < 3; k++) {
        origin.x += 5;
        few->body[k].x += 0.02;
        few->contacts = loaded;
        step_few(few);
        few->contacts = saved;
        step_few(few);
        check_saved_alike(saved, loaded);
    }
    free(from.all);
    narc_destroy_contacts(loaded);
}

/* ------------------------------------------------------------------------------------------------ worlds */

enum { WORLDS = 6, EACH = 100 };

/* A crowd of bodies in each world, all at the same place. */
static struct few *make_worlds(uint32_t *world, uint32_t *counts, narc_pair_filter *filter) {
    struct few *const few = make_few(circle_of(0.5), WORLDS * EACH, NULL);
    for (size_t k = 0; k < WORLDS * EACH; k++) {
        few->body[k].x = 0.9 * (double)(k % 10) + 0.01 * (double)(k / EACH);
        few->body[k].y = 0.95 * (double)(k / 10 % 10);
        world[k] = (uint32_t)(k / EACH);
    }
    *filter = (narc_pair_filter){.kind = NARC_ARRAY(few->kind), .world = {world, sizeof *world}};
    few->step.filter = filter;
    few->step.skin = 0.05f;
    few->step.out_world_count = counts;
    few->step.world_count = WORLDS;
    return few;
}

/* Rows of each world are those of a step of its bodies alone, a range of `touching`; and so they stay where all move, where
 * a world is reset, where bodies go to another one. */
TEST(worlds_do_not_meet) {
    struct test_random random = test_random_named("worlds of contacts");
    static uint32_t world[WORLDS * EACH], counts[WORLDS];
    narc_pair_filter filter;
    AUTO(destroy_few_at) struct few *const few = make_worlds(world, counts, &filter);
    for (size_t step = 0; step < 30; step++) {
        if (step % 5 == 4) { /* world 2 begins again */
            uint64_t *const gone = few->id + (size_t)2 * EACH;
            narc_error error;
            expect_ok(narc_forget_bodies(few->contacts, gone, EACH, &error), &error);
            for (size_t k = 2 * EACH; k < (size_t)3 * EACH; k++)
                few->body[k].x = 0.9 * (double)(k % 10);
        }
        const narc_step_result *const r = step_few(few);
        size_t first = 0;
        for (uint32_t w = 0; w < WORLDS; w++) {
            AUTO(narc_destroy_contacts_at) narc_contacts *const alone = make_contacts(NARC_MANIFOLD_ROWS, NULL);
            narc_bodies bodies;
            narc_view_bodies(few->body + (size_t)w * EACH, EACH, &bodies);
            const narc_step own = {.bodies = &bodies, .margin = few->step.margin, .skin = few->step.skin};
            const narc_step_result *s;
            assert_int_equal(narc_update_contacts(alone, few->store, &own, &s, NULL), NARC_OK);
            assert_int_equal(s->touching_count, counts[w]);
            assert_true(counts[w] > EACH);
            for (size_t k = 0; k < counts[w]; k++) {
                narc_manifold row = r->manifolds[r->touching[first + k]], other = s->manifolds[s->touching[k]];
                row.pair = other.pair;
                assert_memory_equal(&row, &other, sizeof row);
            }
            first += counts[w];
        }
        assert_int_equal(first, r->touching_count);
        for (size_t k = 0; k < r->ended_count && step % 5 == 4; k++)
            if (r->ended[k].parted && r->ended[k].id_a > (size_t)2 * EACH && r->ended[k].id_a <= (size_t)3 * EACH)
                first = 0;
        assert_int_equal(first == 0, step % 5 == 4);
        for (size_t k = 0; k < WORLDS * EACH; k++) {
            few->body[k].x += random_between(&random, -0.04, 0.04);
            few->body[k].y += random_between(&random, -0.04, 0.04);
        }
    }
    world[7] = 3;
    step_few(few);
    const uint32_t before = counts[0];
    world[7] = 0;
    step_few(few);
    assert_true(counts[0] > before);
    few->step.world_count = 2;
    counts[2] = 77;
    step_few(few);
    assert_int_equal(counts[2], 77);
}

TEST_MAIN("contacts of worlds")
