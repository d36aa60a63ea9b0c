/* SPDX-License-Identifier: MIT
 *
 * contacts.c - contacts that stay, beside the plain calls on every step of random worlds: rows to the last bit, slots and the
 * caller's bytes that stay where they are, what touches, begins and ends. Bodies that moved listed or not, workers or none,
 * pairs found or given, saved and loaded: one answer. And rows that follow their bodies: how far they may be off.
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "merge.h"
#include "narc.h"
#include "step_world.h"

/* Contacts whose rows lie in the caller's bytes. */
struct within {
    struct mark mark;
    narc_manifold row;
    float more;
};

static narc_contacts *make_within(void) {
    narc_contacts *contacts;
    narc_error error;
    const narc_contacts_settings settings = {.rows = NARC_MANIFOLD_ROWS | NARC_ROWS_IN_USER,
                                             .user_size = sizeof(struct within),
                                             .row_offset = offsetof(struct within, row)};
    expect_ok(narc_create_contacts(&settings, &contacts, &error), &error);
    return contacts;
}

static void check_within(const narc_step_result *r, const narc_step_result *within) {
    const struct within *const user = within->user;
    check_same(r, within);
    assert_null(within->manifolds);
    for (size_t k = 0; k < r->count; k++)
        assert_memory_equal(&user[r->order[k]].row, &r->manifolds[r->order[k]], sizeof *r->manifolds);
}

/* The pairs of a result as a broad phase of the caller's might give them: in any order, their bodies too. */
struct given {
    uint32_t a[PAIRS], b[PAIRS], last_a[PAIRS], last_b[PAIRS];
    narc_pairs pairs;
    bool same;
};

static void give_pairs(struct test_random *random, size_t count, struct given *out) {
    out->same = out->pairs.count == count && memcmp(pair_a, out->last_a, count * sizeof *pair_a) == 0 &&
                memcmp(pair_b, out->last_b, count * sizeof *pair_b) == 0;
    memcpy(out->last_a, pair_a, count * sizeof *pair_a);
    memcpy(out->last_b, pair_b, count * sizeof *pair_b);
    out->pairs = (narc_pairs){.count = count, .a = NARC_ARRAY(out->a), .b = NARC_ARRAY(out->b)};
    for (size_t k = 0; k < count; k++) {
        const size_t other = random_below(random, k + 1);
        const bool swap = random_below(random, 2);
        out->a[k] = out->a[other];
        out->b[k] = out->b[other];
        out->a[other] = swap ? pair_b[k] : pair_a[k];
        out->b[other] = swap ? pair_a[k] : pair_b[k];
    }
}

/* Of each body the slots that are its pairs'. */
static void check_body_slots(narc_contacts *contacts, const narc_step_result *r, uint32_t body) {
    const uint32_t *slots;
    size_t count, at = 0;
    narc_error error;
    expect_ok(narc_find_body_slots(contacts, body, &slots, &count, &error), &error);
    for (size_t k = 0; k < r->count; k++)
        if (pair_a[k] == body || pair_b[k] == body)
            assert_int_equal(at < count ? slots[at++] : UINT32_MAX, r->order[k]);
    assert_int_equal(at, count);
}

static void check_world(struct test_random random, bool ground, size_t steps) {
    static struct memory memory;
    static struct given given;
    AUTO(destroy_step_world_at) struct step_world *const w = make_step_world(random, ground);
    const narc_workers workers = openmp_workers(3);
    narc_contacts *const all = make_contacts(NARC_MANIFOLD_ROWS, NULL), *const listed = make_contacts(0, NULL),
                         *const shared = make_contacts(0, NULL), *const own = make_contacts(0, NULL),
                         *const loaded = make_contacts(0, NULL), *const within = make_within(),
                         *const contacts = make_contacts(NARC_CONTACT_ROWS, NULL);
    struct bytes saved = {0};
    const narc_step_result *r, *other;
    narc_error error;
    memory.now_count = given.pairs.count = 0;
    for (size_t k = 0; k < steps; k++) {
        narc_bodies bodies;
        narc_view_bodies(w->body, w->count + w->ground, &bodies);
        const narc_pair_filter filter = {.kind = NARC_ARRAY(w->kind),
                                         .category = NARC_ARRAY(w->category),
                                         .mask = NARC_ARRAY(w->mask),
                                         .owner = NARC_ARRAY(w->owner)};
        narc_step step = make_step(w, &bodies, &filter);
        expect_ok(narc_update_contacts(all, w->store, &step, &r, &error), &error);
        check_pairs(w, &step, r);
        check_rows(w, &step, r);
        assert_true(r->asked_count <= r->count);
        for (uint32_t body = 0; body < 20; body++)
            check_body_slots(all, r, body * 7);
        step.workers = &workers;
        expect_ok(narc_update_contacts(shared, w->store, &step, &other, &error), &error);
        check_same(r, other);
        step.workers = NULL;
        expect_ok(narc_update_contacts(within, w->store, &step, &other, &error), &error);
        check_within(r, other);
        expect_ok(narc_update_contacts(contacts, w->store, &step, &other, &error), &error);
        if (!ground)
            check_contact_rows(r, other);
        if (k > 0 && k % 2) {
            step.moved = NARC_ARRAY(w->moved);
            step.moved_count = w->moved_count;
        }
        if (k > 0)
            expect_ok(narc_load_contacts(loaded, w->store, saved.all, saved.count, NULL, &error), &error);
        expect_ok(narc_update_contacts(loaded, w->store, &step, &other, &error), &error);
        check_same(r, other);
        check_saved_alike(all, loaded);
        if (k > 0) {
            step.moved = NARC_ARRAY(w->moved);
            step.moved_count = w->moved_count;
        }
        expect_ok(narc_update_contacts(listed, w->store, &step, &other, &error), &error);
        check_same(r, other);
        give_pairs(&w->random, r->count, &given);
        step.pairs = &given.pairs;
        step.same_pairs = k > 0 && given.same;
        expect_ok(narc_update_contacts(own, w->store, &step, &other, &error), &error);
        check_own(r, other);
        check_events(w, r, &memory);
        save(all, &saved);
        move_step_world(w);
    }
    narc_contacts *const objects[] = {all, listed, shared, own, loaded, within, contacts};
    for (size_t k = 0; k < sizeof objects / sizeof *objects; k++)
        narc_destroy_contacts(objects[k]);
    free(saved.all);
}

TEST(rows_are_those_of_the_plain_calls) {
    struct test_random random = test_random_named("contacts");
    for (size_t k = 0; k < test_trials(20); k++)
        check_world((struct test_random){random_bits(&random)}, false, 60);
}

TEST(rows_of_ground_are_those_of_the_plain_calls) {
    struct test_random random = test_random_named("contacts of ground");
    for (size_t k = 0; k < test_trials(20); k++)
        check_world((struct test_random){random_bits(&random)}, true, 60);
}

/* Bodies creep over ground, each as far as it likes: pairs without a row are asked when they may have one. */
TEST(pairs_with_ground_are_asked_before_they_touch) {
    struct test_random random = test_random_named("creeping over ground");
    size_t asked = 0, pairs = 0, began = 0;
    for (size_t trial = 0; trial < 4 + test_trials(36); trial++) {
        AUTO(destroy_step_world_at)
        struct step_world *const w = make_step_world((struct test_random){random_bits(&random)}, true);
        AUTO(narc_destroy_contacts_at) narc_contacts *const contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
        w->has_filter = w->has_motion = false;
        for (size_t k = 0; k < 60; k++) {
            narc_bodies bodies;
            narc_view_bodies(w->body, w->count + w->ground, &bodies);
            const narc_step step = make_step(w, &bodies, NULL);
            const narc_step_result *r;
            narc_error error;
            expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
            check_pairs(w, &step, r);
            check_rows(w, &step, r);
            asked += k > 3 ? r->asked_count : 0;
            pairs += k > 3 ? r->count : 0;
            began += k > 3 ? r->began_count : 0;
            for (size_t i = 0; i < w->count; i++) {
                const double most = pow(10, random_between(&w->random, -5, -1)),
                             turn = random_between(&w->random, -most, most);
                const double cosine = (double)w->body[i].cosine, sine = (double)w->body[i].sine;
                w->body[i].x += random_between(&w->random, -most, most);
                w->body[i].y += random_between(&w->random, -most, most);
                w->body[i].cosine = (float)(cos(turn) * cosine - sin(turn) * sine);
                w->body[i].sine = (float)(sin(turn) * cosine + cos(turn) * sine);
            }
        }
    }
    assert_true(began > 100 && asked < 3 * pairs / 4);
}

/* ------------------------------------------------------------------------------------------------ recycling */

/* Rows that were kept are off by less than the tolerance, and so is what is not told yet. */
static size_t check_followed(const struct step_world *w, const narc_step *step, const narc_step_result *r) {
    const narc_pairs pairs = {.count = r->count, .a = NARC_ARRAY(pair_a), .b = NARC_ARRAY(pair_b)};
    const narc_query query = {.margin = INFINITY};
    size_t followed = 0;
    narc_error error;
    check_pairs(w, step, r);
    expect_ok(narc_find_separations(w->store, step->bodies, &pairs, &query, margins, &error), &error);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        const narc_manifold *const row = &r->manifolds[slot];
        const float deepest =
            row->count > 1 ? fminf(row->point[0].separation, row->point[1].separation) : row->point[0].separation;
        followed += r->state[slot] & NARC_FOLLOWED ? 1 : 0;
        if (row->count == 0)
            assert_true(margins[k] >= step->margin);
        else
            assert_true(fabsf(deepest - margins[k]) < step->recycling && row->point[0].separation < step->margin);
        assert_true(!(r->state[slot] & NARC_FOLLOWED) || fabsf(hypotf(row->normal_x, row->normal_y) - 1) < 1e-5f);
    }
    return followed;
}

TEST(rows_follow_their_bodies) {
    AUTO(destroy_step_world_at) struct step_world *const w = make_step_world(test_random_named("followers"), false);
    AUTO(narc_destroy_contacts_at) narc_contacts *const contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const narc_step_result *r;
    narc_error error;
    size_t followed = 0, asked = 0, pairs = 0;
    w->has_filter = w->has_ahead = w->has_motion = false;
    w->body[3].x = 0;
    for (size_t k = 0; k < 100; k++) {
        narc_bodies bodies;
        narc_view_bodies(w->body, w->count, &bodies);
        narc_step step = make_step(w, &bodies, NULL);
        step.recycling = 0.01f;
        expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
        followed += check_followed(w, &step, r);
        asked += r->asked_count;
        pairs += r->touching_count;
        for (size_t i = 0; i < w->count; i++) { /* the way that has been gone grows, and the tolerance is used up */
            const double turn = 3e-4 * random_between(&w->random, 0, 1), sine = (double)w->body[i].sine;
            w->body[i].x += random_between(&w->random, 0, 5e-4);
            w->body[i].y -= random_between(&w->random, 0, 5e-4);
            w->body[i].sine += (float)(turn * (double)w->body[i].cosine);
            w->body[i].cosine -= (float)(turn * sine);
        }
    }
    assert_true(pairs > 1000 && followed > pairs / 5 && asked > 0);
}

/* ------------------------------------------------------------------------------------------------ what fails */

/* What a result shows, in one number. */
static uint64_t hash_result(const narc_step_result *r) {
    uint64_t hash = test_hash_items(TEST_HASH_START, r->order, r->count, sizeof *r->order);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        hash = test_hash(hash, &r->state[slot], 1);
        hash = test_hash(hash, &r->manifolds[slot], sizeof *r->manifolds);
        hash = test_hash(hash, (const struct mark *)r->user + slot, sizeof(struct mark));
    }
    hash = test_hash_items(hash, r->touching, r->touching_count, sizeof *r->touching);
    hash = test_hash(hash, r->began, r->began_count * sizeof *r->began);
    return test_hash(hash, r->more, r->more_count * sizeof(narc_manifold));
}

/* Memory ends anywhere in any step: the last result is whole, and the next call goes on from there. */
TEST(goes_on_without_memory) {
    struct test_random random = test_random_named("memory of contacts");
    size_t failures = 0;
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        AUTO(destroy_step_world_at)
        struct step_world *const w = make_step_world((struct test_random){random_bits(&random)}, trial % 2);
        const narc_step_result *r = NULL;
        AUTO(narc_destroy_contacts_at) narc_contacts *contacts;
        narc_error error;
        allowed = SIZE_MAX;
        contacts = make_contacts(NARC_MANIFOLD_ROWS, &watched);
        for (size_t k = 0; k < 12; k++) {
            narc_bodies bodies;
            narc_view_bodies(w->body, w->count + w->ground, &bodies);
            const narc_pair_filter filter = {.kind = NARC_ARRAY(w->kind)};
            const narc_step step = make_step(w, &bodies, &filter);
            const uint64_t before = r ? hash_result(r) : 0;
            w->has_filter = step.filter;
            allowed = random_below(&random, k < 2 ? 60 : 3);
            narc_status status = narc_update_contacts(contacts, w->store, &step, &r, &error);
            if (status != NARC_OK) {
                assert_int_equal(status, NARC_ERROR_MEMORY);
                assert_true(!r || hash_result(r) == before);
                failures++;
                allowed = SIZE_MAX;
                if (random_below(&random, 2))
                    move_step_world(w);
                else
                    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
            }
            if (status == NARC_OK || allowed == SIZE_MAX) {
                narc_bodies now;
                narc_view_bodies(w->body, w->count + w->ground, &now);
                const narc_step again = make_step(w, &now, &filter);
                allowed = SIZE_MAX;
                expect_ok(narc_update_contacts(contacts, w->store, &again, &r, &error), &error);
                check_pairs(w, &again, r);
                check_rows(w, &again, r);
                for (size_t i = 0; i < r->count; i++)
                    ((struct mark *)r->user)[r->order[i]] = mark_of(w->id[pair_a[i]], w->id[pair_b[i]]);
            }
            move_step_world(w);
        }
    }
    assert_true(failures > test_trials(40));
}

static void expect_refused(narc_contacts *contacts, const narc_shapes *store, const narc_step *step, narc_status status,
                           const char *words) {
    const narc_step_result *r;
    narc_error error = {0};
    expect_error(narc_update_contacts(contacts, store, step, &r, &error), status, &error, words);
}

TEST(says_what_is_wrong) {
    AUTO(destroy_step_world_at) struct step_world *const w = make_step_world(test_random_named("wrong"), false);
    AUTO(narc_destroy_contacts_at) narc_contacts *const contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    narc_bodies bodies;
    narc_view_bodies(w->body, w->count, &bodies);
    const uint32_t moved[] = {1, BODIES};
    const narc_step_result *r;
    narc_contacts *none;
    narc_error error;
    narc_step step = {.bodies = &bodies};
    assert_int_equal(narc_create_contacts(&(narc_contacts_settings){.rows = 4}, &none, &error), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_create_contacts(NULL, NULL, &error), NARC_ERROR_ARGUMENT);
    expect_refused(NULL, w->store, &step, NARC_ERROR_ARGUMENT, "contacts is NULL");
    expect_refused(contacts, NULL, &step, NARC_ERROR_ARGUMENT, "shapes is NULL");
    expect_refused(contacts, w->store, NULL, NARC_ERROR_ARGUMENT, "step is NULL");
    expect_refused(contacts, w->store, &(narc_step){.bodies = NULL}, NARC_ERROR_ARGUMENT, "step.bodies is NULL");
    step.margin = -1;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.margin is -1");
    step.margin = NAN;
    expect_refused(contacts, w->store, &step, NARC_ERROR_NOT_FINITE, "step.margin");
    step.margin = 0;
    step.recycling = INFINITY;
    expect_refused(contacts, w->store, &step, NARC_ERROR_NOT_FINITE, "step.recycling");
    step.recycling = 0;
    step.flat_angle = 2;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.flat_angle is 2");
    step.flat_angle = 0;
    step.reserved[0] = w;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.reserved[0]");
    step.reserved[0] = NULL;
    step.moved_count = 1;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.moved is NULL");
    step.moved_count = 0;
    narc_forget_contacts(contacts);
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    step.moved = NARC_ARRAY(moved);
    step.moved_count = 2;
    expect_refused(contacts, w->store, &step, NARC_ERROR_INDEX, "step.moved 1: the body is 160");
    w->body[1].shape = 9999;
    expect_refused(contacts, w->store, &step, NARC_ERROR_INDEX, "body 1: shape is 9999");
    w->body[1].shape = 0;
    step.moved_count = 1;
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    w->body[1].shape = 9999;
    expect_refused(contacts, w->store, &step, NARC_ERROR_INDEX, "step.moved 0: body 1 has shape 9999");
    w->body[1].shape = 0;
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    const size_t count = r->count;
    step.moved_count = 0;
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    assert_int_equal(r->count, count);
    assert_int_equal(r->asked_count + r->began_count + r->ended_count, 0);
    narc_forget_contacts(contacts);
    narc_forget_contacts(NULL);
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    for (size_t k = 0; k < r->count; k++)
        assert_true(r->state[r->order[k]] & NARC_NEW);
    assert_int_equal(r->ended_count, 0);
    narc_destroy_contacts(NULL);
}

/* The same bytes on every instruction set. */
TEST(saves_the_same_bytes_everywhere) {
    const char *const chosen = narc_get_isa();
    struct bytes first = {0}, bytes = {0};
    narc_error error;
    for (size_t isa = 0; narc_isa_name(isa); isa++) {
        if (narc_set_isa(narc_isa_name(isa), NULL) != NARC_OK)
            continue;
        AUTO(destroy_step_world_at)
        struct step_world *const w = make_step_world(test_random_named("saved everywhere"), true);
        AUTO(narc_destroy_contacts_at) narc_contacts *const contacts = make_contacts(0, NULL);
        for (size_t k = 0; k < 12; k++) {
            narc_bodies bodies;
            narc_view_bodies(w->body, w->count + w->ground, &bodies);
            const narc_pair_filter filter = {.kind = NARC_ARRAY(w->kind)};
            narc_step step = make_step(w, &bodies, &filter);
            const narc_step_result *r;
            step.recycling = k < 6 ? 0.01f : 0;
            expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
            move_step_world(w);
        }
        save(contacts, first.all ? &bytes : &first);
        assert_true(!bytes.all || (bytes.count == first.count && memcmp(bytes.all, first.all, first.count) == 0));
    }
    narc_set_isa(chosen, NULL);
    free(first.all);
    free(bytes.all);
}

/* Other bytes, other settings, no memory: contacts are as they were. */
TEST(loads_what_was_saved_alone) {
    AUTO(destroy_step_world_at) struct step_world *const w = make_step_world(test_random_named("damage"), true);
    allowed = SIZE_MAX;
    narc_contacts *const contacts = make_contacts(0, &watched), *const other = make_contacts(NARC_CONTACT_ROWS, NULL);
    narc_bodies bodies, few;
    narc_view_bodies(w->body, w->count + w->ground, &bodies);
    narc_view_bodies(w->body, 4, &few);
    narc_step step = make_step(w, &bodies, NULL);
    const narc_step_result *r;
    struct bytes saved = {0};
    narc_error error;
    size_t failures = 0;
    step.filter = NULL;
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    save(contacts, &saved);
    step.bodies = &few;
    narc_destroy_contacts(contacts);
    AUTO(narc_destroy_contacts_at) narc_contacts *const small = make_contacts(0, &watched);
    expect_ok(narc_update_contacts(small, w->store, &step, &r, &error), &error);
    const uint64_t before = hash_result(r);
    for (size_t k = 0; k < 200; k++) {
        const size_t at = k < 8 ? k : random_below(&w->random, saved.count), bit = random_below(&w->random, 8);
        saved.all[at] ^= (char)(1 << bit);
        assert_int_equal(narc_load_contacts(small, w->store, saved.all, saved.count, NULL, &error), NARC_ERROR_FORMAT);
        saved.all[at] ^= (char)(1 << bit);
        assert_int_equal(narc_load_contacts(small, w->store, saved.all, at, NULL, &error), NARC_ERROR_FORMAT);
    }
    expect_error(narc_load_contacts(other, w->store, saved.all, saved.count, NULL, &error), NARC_ERROR_ARGUMENT, &error,
                 "other settings");
    expect_error(narc_save_contacts(small, saved.all, 7, &error), NARC_ERROR_CAPACITY, &error, "room for 7");
    assert_int_equal(hash_result(r), before);
    for (narc_status status = NARC_ERROR_MEMORY; status != NARC_OK; failures++) {
        allowed = failures;
        status = narc_load_contacts(small, w->store, saved.all, saved.count, &r, &error);
        assert_true(status == NARC_OK || (status == NARC_ERROR_MEMORY && hash_result(r) == before));
    }
    assert_true(failures > 0 && hash_result(r) != before);
    allowed = SIZE_MAX;
    step.bodies = &bodies;
    expect_ok(narc_update_contacts(small, w->store, &step, &r, &error), &error);
    assert_int_equal(r->asked_count, 0);
    narc_destroy_contacts(other);
    free(saved.all);
}

TEST_MAIN("contacts")
