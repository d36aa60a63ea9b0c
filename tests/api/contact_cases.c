/* SPDX-License-Identifier: MIT
 *
 * contact_cases.c - contacts that stay, in scenes of a few bodies: one for each fault that there was.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "families.h"
#include "few_bodies.h"
#include "guard.h"
#include "narc.h"
#include "narc_chains.h"
#include "step_world.h"

/* All slots that there is room for are asked, and new. */
TEST(slots_have_room) {
    allowed = SIZE_MAX;
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 600, &watched);
    few->bodies.count = 8;
    assert_int_equal(step_few(few)->count, 4);
    for (size_t count = 500; count <= 600; count += 2) {
        few->bodies.count = count;
        for (size_t k = 0; k < count; k++)
            few->body[k].y += 1e-4;
        assert_int_equal(step_few(few)->count, count / 2);
    }
}

/* Two that sleep change their order: the row is that of (a, b) all the same. */
TEST(rows_at_rest_are_turned) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 3, NULL);
    few->body[0].x = 50;
    few->body[1].x = 0;
    few->body[2].x = 0.9;
    const narc_step_result *r = step_few(few);
    assert_true(r->manifolds[r->order[0]].normal_x > 0.9f);
    few->kind[1] = few->kind[2] = NARC_ASLEEP;
    step_few(few);
    few->body[0] = few->body[2]; /* the first goes, and the last one takes its place */
    few->id[0] = few->id[2];
    few->kind[0] = NARC_ASLEEP;
    few->bodies.count = 2;
    r = step_few(few);
    assert_int_equal(r->state[r->order[0]] & (NARC_TURNED | NARC_TOUCHING), NARC_TURNED | NARC_TOUCHING);
    assert_true(r->manifolds[r->order[0]].normal_x < -0.9f);
    assert_int_equal(r->began_count + r->ended_count, 0);
}

/* A step that failed has not been: the list of what moved is that since the step before it. */
TEST(goes_on_from_the_last_good_step) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 3, NULL);
    const uint32_t none = 0;
    const narc_step_result *r = step_few(few);
    narc_error error;
    assert_int_equal(r->touching_count, 1);
    few->body[1].x = 1.1; /* apart */
    few->id[2] = 1;
    assert_int_equal(narc_update_contacts(few->contacts, few->store, &few->step, &r, &error), NARC_ERROR_ARGUMENT);
    few->body[1].x = 0.9;
    few->id[2] = 3;
    few->step.moved = (narc_index_column){&none, sizeof none};
    r = step_few(few);
    assert_int_equal(r->touching_count, 1);
    assert_int_equal(r->ended_count, 0);
}

/* Two change their numbers, and each stands where the other one stood; and so do all, which leaves none that is known to have
 * moved. */
TEST(bodies_are_known_by_their_ids) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 3, NULL);
    few->body[1].x = 0.05;
    few->body[2].x = 0.9;
    check_with_fresh(few);
    static const uint64_t ids[][3] = {{2, 1, 3}, {1, 3, 2}};
    for (size_t k = 0; k < 2; k++) {
        memcpy(few->id, ids[k], sizeof ids[k]);
        check_with_fresh(few);
    }
}

/* What was kept of a row goes with it, whatever recycling is meanwhile. */
TEST(kept_rows_are_those_of_now) {
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 1, 0), 2, NULL);
    const double places[] = {0.7, 0.9, 2, 2, 0.7, 0.7005};
    for (size_t k = 0; k < 6; k++) {
        for (size_t i = 0; i < 2; i++) {
            few->body[i].cosine = few->body[i].sine = 0.70710678f;
            few->body[i].x = few->body[i].y = i == 0 ? 0 : places[k];
        }
        few->step.recycling = k == 1 || k == 2 ? 0 : 0.01f;
        assert_int_equal(step_few(few)->touching_count, places[k] < 0.8);
    }
}

/* Rows that might follow do not where another question is asked, nor where ground comes that was not asked. */
TEST(rows_that_follow_are_answers) {
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 1, 0), 100, NULL);
    const narc_arc line[] = {{2, 0, 0, PI / 2, PI / 2}, {-2, 0, 0, PI / 2, PI / 2}};
    static uint32_t run[600];
    static uint64_t mask[600];
    few->step.recycling = 0.01f;
    for (size_t k = 0; k < 8; k++) {
        few->body[1].x += k < 4 ? 1e-5 : 0;
        few->body[2].x += k < 6 ? 0 : 3; /* so that there is another list */
        few->step.second_margin = k < 4 ? 0 : 0.03f;
        few->step.flat_angle = k < 5 ? 0 : 0.1f;
        few->step.front_only = k > 5;
        few->step.recycling = k < 7 ? 0.01f : 0.02f;
        const narc_step_result *const r = step_few(few);
        if (k > 2)
            assert_int_equal(r->state[0] & (NARC_ASKED | NARC_FOLLOWED), k == 3 ? NARC_FOLLOWED : NARC_ASKED);
    }
    const size_t wall = lay_entries(few, line, 2, 0, run) + 1;
    few->bodies.count = wall + 1;
    few->id[wall] = wall + 1;
    few->kind[wall] = NARC_STATIC;
    run[wall] = run[1] + 1;
    memset(mask, 0xff, sizeof mask);
    mask[wall] = 0;
    few->filter.mask = NARC_ARRAY(mask);
    few->step.run = NARC_ARRAY(run);
    few->body[0] = (narc_body){few->body[1].x, few->body[1].y + 0.5, 1, 0, 1, 0};
    few->body[wall] = (narc_body){few->body[0].x + 0.5, few->body[0].y, 0, 1, 1, few->body[1].shape};
    for (size_t k = 0; k < 6; k++) {
        few->body[0].x -= 1e-6;
        mask[wall] = k < 4 ? 0 : UINT64_MAX;
        assert_int_equal(step_few(few)->touching_count, k < 4 ? 1 : 2);
    }
    few->kind[0] = NARC_SENSOR;
    for (uint32_t k = 0; k < 4; k++) { /* its middle lies behind the line */
        few->body[0].y = few->body[1].y - 0.1 - 1e-3 * k;
        few->step.front_only = k % 2;
        assert_int_equal(step_few(few)->sensor_count, !(k % 2));
    }
}

/* A box turns about the first point of its contact: that stays, and the second one does not. */
TEST(a_turn_is_a_way) {
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 1, 0), 2, NULL);
    few->body[0].x = few->body[1].x = 0;
    few->body[1].y = 0.995;
    few->step.recycling = 0.01f;
    const narc_manifold row = step_few(few)->manifolds[0];
    assert_int_equal(row.count, 2);
    for (int sign = -1; sign <= 1; sign += 2) {
        const narc_body was = few->body[1];
        few->body[1] = turn_about(was, (double)row.point[0].x, (double)row.point[0].y, 0.015 * sign);
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->state[0] & (NARC_ASKED | NARC_FOLLOWED), NARC_ASKED);
        few->body[1] = was;
        step_few(few);
    }
}

/* Rows are as deep as they are to be, but for what recycling lets them be off by. */
static void check_separations(const struct few *few, const narc_step_result *r) {
    const narc_query query = {
        .margin = INFINITY, .selection = {r->order, sizeof *r->order}, .selection_count = r->count};
    narc_error error;
    assert_true(r->pairs.count <= PAIRS);
    expect_ok(narc_find_separations(few->store, &few->bodies, &r->pairs, &query, margins, &error), &error);
    for (size_t k = 0; k < r->touching_count; k++) {
        const narc_manifold *const row = &r->manifolds[r->touching[k]];
        const float deepest =
            row->count > 1 ? fminf(row->point[0].separation, row->point[1].separation) : row->point[0].separation;
        assert_true(fabsf(deepest - margins[r->touching[k]]) <= few->step.recycling);
    }
}

/* Enough for several parts of each kind: asked plainly, by entries, and rows that follow. */
TEST(workers_share_a_step) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 600, NULL);
    struct test_random random = test_random_named("shared steps");
    const narc_workers workers = openmp_workers(3);
    narc_contacts *const alone = few->contacts, *const shared = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const uint32_t box = store_shape(few->store, box_of(0.9, 0.9, 0));
    size_t pairs = 0;
    for (size_t k = 0; k < 600; k++)
        few->body[k] = (narc_body){0.45 * (double)(k % 30), 0.45 * (double)(k / 30), 1, 0, 1, k % 2 ? box : 0};
    few->step.skin = 0.02f;
    for (size_t step = 0; step < 12; step++) {
        few->step.recycling = step < 6 ? 0 : 0.01f;
        few->contacts = alone;
        few->step.workers = NULL;
        const narc_step_result *const r = step_few(few);
        few->contacts = shared;
        few->step.workers = &workers;
        check_same(r, step_few(few));
        check_separations(few, r);
        pairs = r->count;
        for (size_t k = 0; k < 600; k++) {
            const double by = k % 7 == step % 7 ? 0.05 : 1e-3; /* some leave what was kept of them */
            few->body[k].x += random_between(&random, -by, by);
            few->body[k].y += random_between(&random, -by, by);
        }
    }
    assert_true(pairs > 4 * 1024);
    narc_destroy_contacts(alone);
}

/* A body that is taken out and is there still is another one: what was known of its pairs is gone. */
TEST(bodies_that_are_taken_out_are_others) {
    for (int way = 0; way < 3; way++) {
        AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
        const uint64_t gone[] = {way ? 3 : 2, 77};
        const uint32_t none = 0;
        narc_error error;
        if (!way)
            few->step.id.base = NULL; /* ids are numbers */
        const narc_step_result *r = step_few(few);
        struct mark *const marks = r->user;
        for (size_t k = 0; k < r->count; k++)
            marks[r->order[k]].low = 7 + k;
        expect_ok(narc_forget_bodies(few->contacts, gone, 2, &error), &error);
        if (way == 2) /* and nothing has moved */
            few->step.moved = (narc_index_column){&none, sizeof none};
        r = step_few(few);
        assert_int_equal(r->count, 3);
        assert_int_equal(r->touching_count, 3);
        assert_int_equal(r->ended_count, 1);
        assert_int_equal(r->ended[0].parted, 1);
        assert_int_equal(r->began_count, 1);
        for (size_t k = 0; k < 3; k++) {
            const uint32_t slot = r->order[k];
            assert_int_equal(!!(r->state[slot] & NARC_NEW), k == 1);
            assert_int_equal(((struct mark *)r->user)[slot].low, k == 1 ? 0 : 7 + k);
        }
        r = step_few(few);
        assert_int_equal(r->began_count + r->ended_count + r->asked_count, 0);
    }
}

/* Pairs of the caller's that are none, and what was there before stays. */
TEST(own_pairs_are_checked) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    uint32_t a[] = {0, 2, 4}, b[] = {1, 3, 5};
    float shift[3] = {0};
    narc_pairs pairs = {.count = 3, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    narc_error error;
    const narc_step_result *r = step_few(few);
    const uint32_t slot = r->touching[1];
    const struct {
        narc_pairs pairs;
        uint32_t *where, value;
        narc_status status;
        const char *words;
    } bad[] = {{pairs, &a[1], 3, NARC_ERROR_ARGUMENT, "pair 1: both are body 3"},
               {pairs, &b[2], 6, NARC_ERROR_INDEX, "pair 2: body 6, but there are 6 bodies"},
               {pairs, &b[2], 0, NARC_OK, ""},
               {{.count = 3, .b = pairs.b}, &a[0], 0, NARC_ERROR_ARGUMENT, "step.pairs.a"},
               {{.count = 3, .a = pairs.a, .b = pairs.b, .shift_x = NARC_ARRAY(shift)},
                &a[0],
                0,
                NARC_ERROR_ARGUMENT,
                "step.pairs with shifts"},
               {{.count = 3, .a = pairs.a, .b = {b, 0}}, &a[1], 0, NARC_ERROR_ARGUMENT, "bodies 0 and 1 twice"}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const uint32_t was = *bad[k].where;
        *bad[k].where = bad[k].value;
        few->step.pairs = &bad[k].pairs;
        const narc_status status = narc_update_contacts(few->contacts, few->store, &few->step, &r, &error);
        if (bad[k].status != NARC_OK)
            expect_error(status, bad[k].status, &error, bad[k].words);
        else
            assert_int_equal(r->ended_count, 1); /* of bodies 4 and 5, which are no pair now */
        *bad[k].where = was;
    }
    few->step.pairs = &pairs;
    r = step_few(few);
    assert_int_equal(r->touching_count, 3);
    assert_int_equal(r->touching[1], slot);
    few->step.same_pairs = 1;
    few->body[3].x += 50; /* which no box tells of */
    r = step_few(few);
    assert_int_equal(r->count, 3);
    assert_int_equal(r->touching_count, 2);
    few->step.pairs = NULL;
    r = step_few(few);
    assert_int_equal(r->count, 2);
}

/* Where there is no filter any more nothing is a sensor, or sleeps. */
TEST(kinds_go_with_the_filter) {
    for (int way = 0; way < 2; way++) {
        AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 600, NULL);
        few->kind[0] = NARC_SENSOR;
        few->kind[2] = few->kind[3] = way ? NARC_ASLEEP : 0;
        assert_int_equal(step_few(few)->sensor_count, 1);
        few->step.filter = NULL;
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->sensor_count, 0);
        assert_int_equal(r->touching_count, 300);
        assert_int_equal(r->manifolds[r->order[0]].count, 1);
    }
}

/* Bytes of contacts, to be freed. */
static char *save_few(const struct few *few, size_t *out_size) {
    narc_error error;
    *out_size = narc_count_contact_bytes(few->contacts);
    char *const bytes = malloc(*out_size);
    assert_non_null(bytes);
    expect_ok(narc_save_contacts(few->contacts, bytes, *out_size, &error), &error);
    return bytes;
}

/* What was saved is loaded, of contacts that were forgotten, too. */
TEST(forgotten_contacts_are_saved) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    size_t size;
    narc_error error;
    assert_int_equal(step_few(few)->began_count, 3);
    narc_forget_contacts(few->contacts);
    AUTO(free_at) char *const bytes = save_few(few, &size);
    expect_ok(narc_load_contacts(few->contacts, few->store, bytes, size, NULL, &error), &error);
    assert_int_equal(step_few(few)->began_count, 3);
}

/* Back to where there were fewer slots, and on again: the same bytes, whatever lay in those that came meanwhile. */
TEST(saved_bytes_are_those_of_the_same_steps) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 40, NULL);
    size_t size, first_size, second_size;
    narc_error error;
    few->bodies.count = 20;
    step_few(few);
    AUTO(free_at) char *const start = save_few(few, &size);
    few->bodies.count = 40;
    step_few(few);
    AUTO(free_at) char *const first = save_few(few, &first_size);
    for (size_t step = 0; step < 3; step++) { /* pairs that are asked again have entries */
        for (size_t k = 0; k < 40; k++)
            few->body[k].x += step < 2 ? 0x1p-10 : -0x1p-9;
        step_few(few);
    }
    expect_ok(narc_load_contacts(few->contacts, few->store, start, size, NULL, &error), &error);
    step_few(few);
    AUTO(free_at) char *const second = save_few(few, &second_size);
    assert_int_equal(first_size, second_size);
    assert_memory_equal(first, second, first_size);
}

/* Pairs that are the same are not looked at, whoever moves. */
TEST(same_pairs_are_not_looked_at) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    uint32_t a[] = {0, 2, 4}, b[] = {1, 3, 5};
    const narc_pairs pairs = {.count = 3, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    few->step.pairs = &pairs;
    step_few(few);
    few->step.same_pairs = 1;
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    for (size_t step = 0; step < 3; step++) {
        few->body[3].x += 0.05;
        few->step.margin += 0.01f;
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->count, 3);
        assert_int_equal(r->touching_count, 3);
    }
}

/* To take bodies out does not make all others be looked at from then on. */
TEST(bodies_are_listed_after_some_were_taken_out) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    const uint64_t gone = 1;
    const uint32_t none = 0;
    narc_error error;
    few->step.id.base = NULL;
    step_few(few);
    expect_ok(narc_forget_bodies(few->contacts, &gone, 1, &error), &error);
    step_few(few);
    step_few(few);
    few->step.moved = (narc_index_column){&none, sizeof none};
    few->body[3].x += 0.05; /* but it is not listed */
    assert_int_equal(step_few(few)->asked_count, 0);
}

/* Whatever bit is another one, and the sum is right: no step reads or writes where it must not. Where trials are few,
 * one bit or two of each byte. */
TEST(damaged_bytes_do_no_harm) {
    const size_t stride = test_trials(10) < 10 ? 7 : 1;
    for (int way = 0; way < 3; way++) {
        AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
        const narc_pair_filter *const filter = few->step.filter;
        size_t size, loads = 0;
        few->step.filter = way ? filter : NULL;
        few->kind[3] = way > 1 ? NARC_SENSOR : 0;
        step_few(few);
        AUTO(free_at) char *const bytes = save_few(few, &size);
        narc_destroy_contacts(few->contacts);
        for (size_t bit = 0; bit < 8 * size; bit += stride) {
            const uint32_t *slots;
            const narc_step_result *r;
            size_t count;
            narc_error error;
            allowed = SIZE_MAX;
            few->contacts = make_contacts(NARC_MANIFOLD_ROWS, &watched);
            bytes[bit / 8] ^= (char)(1 << bit % 8);
            sum_up_contacts(bytes, size);
            if (narc_load_contacts(few->contacts, few->store, bytes, size, NULL, &error) == NARC_OK) {
                loads++;
                few->step.filter = bit % 16 < 8 ? NULL : filter;
                for (int step = 0; step < 2; step++) {
                    few->body[bit % 6].x += step ? -0.01 : 0.01;
                    narc_update_contacts(few->contacts, few->store, &few->step, &r, &error);
                    for (uint32_t body = 0; body < 6; body++)
                        narc_find_body_slots(few->contacts, body, &slots, &count, &error);
                }
            }
            bytes[bit / 8] ^= (char)(1 << bit % 8);
            narc_destroy_contacts(few->contacts);
        }
        assert_true(loads > size / stride);
        few->contacts = NULL;
    }
}

/* A body that is not listed has no shape, which is found out when pairs have their slots: the next step begins anew. */
TEST(unlisted_bodies_without_a_shape_are_an_error) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    const uint32_t moved = 0;
    narc_error error;
    const narc_step_result *r = step_few(few);
    few->body[0].x = 10.3;
    few->body[3].shape = 99;
    few->step.moved = (narc_index_column){&moved, sizeof moved};
    few->step.moved_count = 1;
    assert_int_equal(narc_update_contacts(few->contacts, few->store, &few->step, &r, &error), NARC_ERROR_INDEX);
    few->body[3].shape = 0;
    few->step.moved = (narc_index_column){NULL, 0};
    few->step.moved_count = 0;
    few->body[1].x = 10.5;
    check_with_fresh(few);
}

/* Saves contacts and loads them into others, which know something else. */
static void save_and_load(const struct few *from, narc_contacts *to) {
    narc_error error;
    const size_t size = narc_count_contact_bytes(from->contacts);
    AUTO(free_at) char *const bytes = malloc(size);
    assert_non_null(bytes);
    expect_ok(narc_save_contacts(from->contacts, bytes, size, &error), &error);
    expect_ok(narc_load_contacts(to, from->store, bytes, size, NULL, &error), &error);
}

/* What is not saved is found out again: who sleeps, which pairs are known, for how long no entry is made. */
TEST(goes_on_from_what_was_loaded) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 6, NULL);
    const uint64_t gone = 3;
    narc_error error;
    narc_contacts *const awake = make_contacts(NARC_MANIFOLD_ROWS, NULL), *const kept = few->contacts;
    few->contacts = awake;
    step_few(few);
    few->contacts = kept;
    memset(few->kind, NARC_ASLEEP, 6);
    step_few(few);
    memset(few->kind, 0, 6);
    few->contacts = awake;
    save_and_load(few, kept);
    few->contacts = kept;
    few->body[1].x = 0.8;
    const narc_step_result *r = step_few(few);
    assert_int_equal(r->asked_count, 1);
    assert_int_equal(r->touching_count, 3);
    expect_ok(narc_forget_bodies(kept, &gone, 1, &error), &error);
    save_and_load(few, awake);
    few->contacts = awake;
    r = step_few(few);
    assert_int_equal(r->ended_count, 1);
    assert_int_equal(r->began_count, 1);
    narc_destroy_contacts(kept);
}

TEST(saves_how_long_no_entry_is_made) {
    struct test_random random = test_random_named("wild turns");
    AUTO(destroy_few_at) struct few *const few = make_few(make_shape(&random, FAMILY_SMOOTH), 100, NULL);
    narc_contacts *const kept = few->contacts;
    for (size_t step = 0; step < 12; step++) {
        AUTO(narc_destroy_contacts_at)
        narc_contacts *const loaded = make_contacts(NARC_MANIFOLD_ROWS, NULL); /* it knows nothing else */
        few->contacts = kept;
        save_and_load(few, loaded);
        for (size_t k = 0; k < 100; k++) {
            const double angle =
                step % 6 < 3 ? 0 : random_between(&random, -PI, PI); /* wild, and back where entries are */
            few->body[k].x += 1e-6;
            few->body[k].cosine = (float)cos(angle);
            few->body[k].sine = (float)sin(angle);
        }
        step_few(few);
        few->contacts = loaded;
        step_few(few);
        const size_t size = narc_count_contact_bytes(kept);
        AUTO(free_at) char *const one = malloc(size), *const other = malloc(size);
        assert_true(one && other && narc_count_contact_bytes(loaded) == size);
        assert_int_equal(narc_save_contacts(kept, one, size, NULL), NARC_OK);
        assert_int_equal(narc_save_contacts(loaded, other, size, NULL), NARC_OK);
        assert_memory_equal(one, other, size);
        few->contacts = kept;
    }
}

/* A pair that only the filter makes is asked, though nobody moves. */
TEST(a_filter_makes_pairs) {
    static uint64_t mask[600];
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 600, NULL);
    memset(mask, 0xff, sizeof mask);
    mask[101] = 0;
    few->filter.mask = NARC_ARRAY(mask);
    assert_int_equal(step_few(few)->touching_count, 299);
    assert_int_equal(step_few(few)->asked_count, 0);
    mask[101] = UINT64_MAX;
    const narc_step_result *const r = step_few(few);
    assert_int_equal(r->touching_count, 300);
    assert_int_equal(r->asked_count, 1);
}

/* As many pairs as there is room for, and behind their slots one that had a pair: nothing is written behind the lists. */
TEST(lists_have_room_behind_slots_that_are_free) {
    enum { FIRST = 4, ALL = 260 /* as many as there is room for after FIRST */ };
    allowed = SIZE_MAX;
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(1, 1, 0), 2 * ALL + 4, &watched);
    uint32_t a[ALL], b[ALL];
    narc_pairs pairs = {.a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    few->step.pairs = &pairs;
    few->step.recycling = 0.05f;
    for (uint32_t step = 0; step < 10; step++) {
        pairs.count = step == 0 ? FIRST : ALL;
        for (uint32_t k = 0; k < ALL; k++) {
            const uint32_t pair = k > 0 || step < 2 ? k : step < 4 ? ALL : ALL + 1;
            a[k] = 2 * pair;
            b[k] = 2 * pair + 1;
        }
        for (size_t k = 1; k < few->bodies.count; k += 2)
            few->body[k].x += 1e-4;
        assert_int_equal(step_few(few)->touching_count, pairs.count);
    }
}

/* Steps after loading are those after saving: pairs without a row, whose boxes part later, too. */
TEST(bare_pairs_are_loaded_as_they_were) {
    const double x[] = {1.9, 1.901, 1.902, 1.903, 1.904, 2.1, 1.9, 1.901, 4, 1.9};
    AUTO(destroy_few_at) struct few *const few = make_few(box_of(sqrt(2), sqrt(2), 0), 2, NULL);
    narc_contacts *const saved = few->contacts, *const loaded = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    struct bytes from = {0};
    narc_error error;
    few->step.skin = 0.5f;
    for (int k = 0; k < 2; k++)
        few->body[k].cosine = few->body[k].sine = 0.70710678f;
    for (size_t k = 0; k < sizeof x / sizeof *x; k++) {
        few->body[1].x = few->body[1].y = x[k];
        const narc_step_result *const r = step_few(few);
        const size_t asked = r->asked_count;
        assert_int_equal(r->touching_count, 0);
        if (k == 4) {
            save(saved, &from);
            expect_ok(narc_load_contacts(loaded, few->store, from.all, from.count, NULL, &error), &error);
        }
        if (k <= 4)
            continue;
        few->contacts = loaded;
        assert_int_equal(step_few(few)->asked_count, asked);
        few->contacts = saved;
        check_saved_alike(saved, loaded);
    }
    free(from.all);
    narc_destroy_contacts(loaded);
}

/* Two that creep or turn towards each other, by so little in a step that most keep their boxes, are listed when they are near,
 * though they were not when they began, and have a row as soon as there is one. */
TEST(bodies_that_creep_are_found) {
    struct test_random random = test_random_named("creeping");
    for (size_t trial = 0; trial < test_trials(60); trial++) {
        AUTO(destroy_few_at) struct few *const few = make_few(capsule_of(4, 0.25), 2, NULL);
        const float ahead[] = {0.3f, 0.3f}, more = trial % 4 < 2 ? 0.6f : 0;
        const double gap = 0.02 + (double)more + 2 * random_between(&random, 0.85, 1.01);
        const double step = random_between(&random, 0.002, 0.05);
        const bool turns = trial % 2;
        size_t found = 0, listed = 0;
        if (more > 0)
            few->step.ahead = few->step.reach = NARC_ARRAY(ahead);
        few->body[1].x = 0;
        few->body[1].y = 0.5 + gap;
        assert_int_equal(step_few(few)->count, gap - (double)more < (more > 0 ? 2.02 : 1.895));
        for (double way = 0; way < 1.1; way += step) {
            const double angle = turns ? asin(way / 2) : 0;
            for (int k = 0; k < 2; k++) {
                few->body[k].cosine = (float)cos(angle);
                few->body[k].sine = (float)(k == 0 ? sin(angle) : -sin(angle));
                few->body[k].y = (k == 0 ? 0 : 0.5 + gap) + (turns ? 0 : k == 0 ? way : -way);
            }
            const narc_step_result *const r = step_few(few);
            const narc_pairs pair = {.count = 1};
            const narc_query query = {.margin = few->step.margin + more};
            narc_manifold row;
            size_t count;
            expect_ok(narc_find_manifolds(few->store, &few->bodies, &pair, &query, &row, 1, &count, NULL), NULL);
            assert_int_equal(r->touching_count, count);
            found += count;
            listed += r->count;
        }
        assert_true(found > 0 && listed > 0);
    }
}

/* Two that move away from each other have boxes that are further apart than what they look ahead, and a row. */
TEST(rows_ahead_are_beyond_boxes) {
    AUTO(destroy_few_at) struct few *const few = make_few(circle_of(0.5), 2, NULL);
    const float ahead[] = {0.3f, 0.3f}, motion[] = {-0.3f, 0.3f};
    few->step.ahead = NARC_ARRAY(ahead);
    few->step.motion_x = few->step.motion_y = NARC_ARRAY(motion);
    few->body[1].x = 1.5;
    assert_int_equal(step_few(few)->touching_count, 1);
}

TEST_MAIN("contact cases")
