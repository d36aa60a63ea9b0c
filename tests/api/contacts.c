/* SPDX-License-Identifier: MIT
 *
 * contacts.c - contacts that stay, beside the plain calls on every step: rows to the last bit, slots and the caller's bytes
 * that stay where they are, what touches, begins and ends; in scenes where bodies come, go, change places, sleep, fall
 * asleep, jump, become sensors, and shapes are replaced. Bodies that moved listed or not, workers or none, one answer. And
 * rows that follow their bodies: how far they may be off.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "expect.h"
#include "families.h"
#include "guard.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_contacts.h"
#include "support.h"

enum { BODIES = 160, ROOM = 1024, SHAPES = 24, PAIRS = 40000 };

struct world {
    struct test_random random;
    narc_shapes *store;
    narc_body body[ROOM];
    uint64_t id[ROOM], category[ROOM], mask[ROOM];
    uint8_t kind[ROOM];
    uint32_t group[ROOM], run[ROOM], moved[ROOM];
    float motion_x[ROOM], motion_y[ROOM], ahead[ROOM];
    size_t count, ground, moved_count;
    uint64_t last_id;
    bool has_filter, has_motion, has_ahead, shuffled;
    float margin, skin;
};

static double size_of_world(const struct world *w) { return 1.2 * sqrt((double)w->count); }

static void put_body(struct world *w, size_t k) {
    struct test_random *const random = &w->random;
    const double angle = random_between(random, -PI, PI), size = size_of_world(w);
    w->body[k].x = random_between(random, -size, size);
    w->body[k].y = random_between(random, w->ground ? 0 : -size, size);
    w->body[k].cosine = (float)cos(angle);
    w->body[k].sine = (float)sin(angle);
}

static void make_body(struct world *w, size_t k) {
    struct test_random *const random = &w->random;
    w->body[k] =
        (narc_body){.scale = (float)random_between(random, 0.4, 1.1), .shape = (uint32_t)random_below(random, SHAPES)};
    put_body(w, k);
    w->id[k] = ++w->last_id;
    w->kind[k] = random_below(random, 6) ? 0 : (uint8_t)random_below(random, 8);
    w->category[k] = 1u << random_below(random, 3);
    w->mask[k] = random_below(random, 4) ? UINT64_MAX : 3;
    w->group[k] = random_below(random, 9) ? 0 : 1 + (uint32_t)random_below(random, 3);
    w->run[k] = NARC_NO_RUN;
    w->motion_x[k] = w->motion_y[k] = w->ahead[k] = 0;
}

/* Ground's entries stand behind all bodies. */
static void copy_body(struct world *w, size_t to, size_t from) {
    w->body[to] = w->body[from];
    w->id[to] = w->id[from];
    w->kind[to] = w->kind[from];
    w->category[to] = w->category[from];
    w->mask[to] = w->mask[from];
    w->group[to] = w->group[from];
    w->run[to] = w->run[from];
    w->motion_x[to] = w->motion_x[from];
    w->motion_y[to] = w->motion_y[from];
    w->ahead[to] = w->ahead[from];
}

static void lay_world(struct world *w) {
    narc_chain_entry entries[ROOM / 2];
    narc_error error;
    const enum chain_family families[] = {CHAIN_HILLS, CHAIN_BOWLS, CHAIN_MIXED, CHAIN_STEPS};
    const struct chain chain = make_chain(&w->random, families[random_below(&w->random, 4)]);
    expect_ok(narc_add_chain(w->store, chain.arcs, chain.count, NULL, entries, ROOM / 2, &w->ground, &error), &error);
    free(chain.arcs);
    for (size_t k = 0; k < w->ground; k++) {
        make_body(w, w->count + k);
        w->body[w->count + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        w->kind[w->count + k] = NARC_STATIC;
        w->group[w->count + k] = 0;
        w->run[w->count + k] = entries[k].run;
    }
}

static struct world *make_world(struct test_random random, bool ground) {
    struct world *const w = calloc(1, sizeof *w);
    assert_non_null(w);
    w->random = random;
    w->store = empty_store();
    while (narc_count_shapes(w->store) < SHAPES) { /* equal ones are shared */
        const size_t k = random_below(&w->random, 3);
        const enum family any = (enum family)random_below(&w->random, FAMILY_OFFSET);
        store_shape(w->store, make_shape(&w->random, k == 0 ? FAMILY_SMOOTH : k == 1 ? FAMILY_BOX : any));
    }
    w->count = BODIES;
    w->has_filter = random_below(&w->random, 3);
    w->has_motion = random_below(&w->random, 2);
    w->has_ahead = w->has_motion && random_below(&w->random, 2);
    w->margin = (float)random_between(&w->random, 0, 0.1);
    w->skin = random_below(&w->random, 4) ? (float)random_between(&w->random, 0, 0.2) : 0;
    if (ground)
        lay_world(w);
    for (size_t k = 0; k < w->count; k++)
        make_body(w, k);
    if (random_below(&w->random, 2))
        w->body[3].x = 1e24; /* far from all others, and no reason to be less exact */
    return w;
}

static void destroy_world(struct world *w) {
    narc_destroy_shapes(w->store);
    free(w);
}

static void note_moved(struct world *w, size_t k) {
    for (size_t i = 0; i < w->moved_count; i++)
        if (w->moved[i] == k)
            return;
    w->moved[w->moved_count++] = (uint32_t)k;
}

/* What happens between two steps. */
static void move_world(struct world *w) {
    struct test_random *const random = &w->random;
    const size_t way = random_below(random, 12), moving = way == 0 ? 0 : way < 7 ? w->count / 20 : w->count;
    const double by = random_log_between(random, 1e-6, 0.1);
    w->moved_count = 0;
    for (size_t i = 0; i < moving; i++) {
        const size_t k = moving == w->count ? i : random_below(random, w->count);
        narc_body *const body = &w->body[k];
        const double angle = random_between(random, -by, by);
        const float cosine = body->cosine;
        body->x += random_between(random, -by, by);
        body->y += random_between(random, -by, by);
        body->cosine = (float)(cos(angle) * (double)cosine - sin(angle) * (double)body->sine);
        body->sine = (float)(sin(angle) * (double)cosine + cos(angle) * (double)body->sine);
        const float length = hypotf(body->cosine, body->sine);
        body->cosine /= length;
        body->sine /= length;
        w->motion_x[k] = random_below(random, 3) ? 0 : (float)random_between(random, -0.3, 0.3);
        w->motion_y[k] = random_below(random, 3) ? 0 : (float)random_between(random, -0.3, 0.3);
        w->ahead[k] = random_below(random, 3) ? 0 : (float)random_between(random, 0, 0.2);
        note_moved(w, k);
    }
    for (size_t i = random_below(random, 3); i > 0; i--) { /* a jump, another kind, another shape, another scale */
        const size_t k = random_below(random, w->count);
        switch (random_below(random, 6)) {
        case 0:
            put_body(w, k);
            break;
        case 1:
            w->kind[k] = (uint8_t)random_below(random, 8);
            break;
        case 2:
            w->kind[k] ^= NARC_ASLEEP;
            break;
        case 3:
            w->body[k].shape = (uint32_t)random_below(random, SHAPES);
            break;
        case 4:
            w->body[k].scale = (float)random_between(random, 0.4, 1.1);
            break;
        default:
            w->body[k].x = random_below(random, 4) ? w->body[k].x : (double)NAN;
            break;
        }
        note_moved(w, k);
    }
    if (random_below(random, 4) == 0) { /* one goes, and the last one takes its place; another comes */
        const size_t k = random_below(random, w->count);
        copy_body(w, k, w->count - 1);
        make_body(w, w->count - 1);
        note_moved(w, k);
        note_moved(w, w->count - 1);
    }
    if (random_below(random, 12) == 0) { /* two change places */
        const size_t j = random_below(random, w->count), k = random_below(random, w->count);
        copy_body(w, ROOM - 1, j);
        copy_body(w, j, k);
        copy_body(w, k, ROOM - 1);
        note_moved(w, j);
        note_moved(w, k);
    }
    if (random_below(random, 20) == 0 && w->count > BODIES / 2) { /* fewer bodies, ground moves up */
        for (size_t k = w->count - 1; k < w->count + w->ground - 1; k++)
            copy_body(w, k, k + 1);
        w->count--;
    }
    if (w->ground > 0 && random_below(random, 3) == 0) { /* ground is others', or elsewhere, and back again */
        const size_t k = w->count + random_below(random, w->ground);
        switch (random_below(random, 5)) {
        case 0:
            w->kind[k] ^= NARC_SENSOR;
            break;
        case 1:
            w->mask[k] = ~w->mask[k];
            break;
        case 2:
            w->body[k].y += w->body[k].y < -50 ? 100 : -100;
            break;
        case 3:
            w->run[k] = w->run[k] == NARC_NO_RUN ? w->run[w->count] : NARC_NO_RUN;
            break;
        default:
            w->body[k].shape = (uint32_t)random_below(random, SHAPES);
            break;
        }
        note_moved(w, k);
    }
    if (random_below(random, 25) == 0) {
        const uint32_t shape = (uint32_t)random_below(random, SHAPES);
        const struct shape other = make_shape(random, FAMILY_SMOOTH);
        narc_replace_shape(w->store, shape, other.arcs, other.count, NULL);
    }
    if (random_below(random, 25) == 0)
        w->margin = (float)random_between(random, 0, 0.1);
}

static narc_step make_step(const struct world *w, const narc_bodies *bodies, const narc_pair_filter *filter) {
    narc_step step = {.bodies = bodies, .margin = w->margin, .skin = w->skin, .id = NARC_ARRAY(w->id)};
    if (w->has_filter)
        step.filter = filter;
    if (w->has_motion) {
        step.motion_x = NARC_ARRAY(w->motion_x);
        step.motion_y = NARC_ARRAY(w->motion_y);
        step.reach = NARC_ARRAY(w->ahead);
    }
    if (w->has_ahead)
        step.ahead = NARC_ARRAY(w->ahead);
    if (w->ground > 0)
        step.run = NARC_ARRAY(w->run);
    return step;
}

/* ------------------------------------------------------------------------------------------------ what is right */

static uint32_t pair_a[PAIRS], pair_b[PAIRS], near_a[PAIRS], near_b[PAIRS], tested[PAIRS];
static float margins[PAIRS];
static narc_manifold rows[PAIRS];
static uint64_t bits[PAIRS / 64 + 1];
static narc_box boxes[ROOM];

static unsigned kind_of(const struct world *w, uint32_t body) { return w->has_filter ? w->kind[body] & 7u : 0; }

static bool moves(const struct world *w, uint32_t a, uint32_t b) { return !(kind_of(w, a) & 3 && kind_of(w, b) & 3); }

/* All pairs that are closer than the margin are listed. */
static void check_pairs(const struct world *w, const narc_step *step, const narc_step_result *r) {
    narc_broad_phase *broad;
    narc_error error;
    size_t found = 0, at = 0;
    const narc_box_options options = {
        .margin = step->margin / 2, .motion_x = step->motion_x, .motion_y = step->motion_y};
    expect_ok(narc_compute_boxes(w->store, step->bodies, &options, boxes, &error), &error);
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    expect_ok(
        narc_find_pairs(broad, boxes, step->bodies->count, step->filter, NULL, near_a, near_b, PAIRS, &found, &error),
        &error);
    narc_destroy_broad_phase(broad);
    assert_true(r->count < PAIRS);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        pair_a[k] = r->pairs.a.base[slot];
        pair_b[k] = r->pairs.b.base[slot];
        assert_true(pair_a[k] < pair_b[k]);
        assert_true(k == 0 || pair_a[k - 1] < pair_a[k] || (pair_a[k - 1] == pair_a[k] && pair_b[k - 1] < pair_b[k]));
        at += at < found && near_a[at] == pair_a[k] && near_b[at] == pair_b[k];
    }
    assert_int_equal(at, found);
}

/* A slot's row, or that behind it, is this one but for its number. */
static void check_row(const narc_manifold *row, narc_manifold expected, uint32_t slot) {
    expected.pair = slot;
    assert_memory_equal(row, &expected, sizeof expected);
}

static void check_rows(const struct world *w, const narc_step *step, const narc_step_result *r) {
    const narc_pairs pairs = {.count = r->count, .a = NARC_ARRAY(pair_a), .b = NARC_ARRAY(pair_b)};
    const narc_manifold *const more = r->more;
    size_t asked = 0, found = 0, row = 0, next = 0, touching = 0, sensors = 0;
    narc_error error;
    for (size_t k = 0; k < r->count; k++) {
        margins[k] = step->margin + (w->has_ahead ? w->ahead[pair_a[k]] + w->ahead[pair_b[k]] : 0);
        if (moves(w, pair_a[k], pair_b[k]) && !((kind_of(w, pair_a[k]) | kind_of(w, pair_b[k])) & NARC_SENSOR))
            tested[asked++] = (uint32_t)k;
    }
    const narc_query query = {
        .margins = NARC_ARRAY(margins), .selection = {tested, sizeof *tested}, .selection_count = asked};
    expect_ok(narc_find_manifolds(w->store, step->bodies, &pairs, &query, rows, PAIRS, &found, &error), &error);
    if (step->run.base)
        found = narc_merge_manifolds(&pairs, step->run, rows, found);
    expect_ok(narc_find_overlaps(w->store, step->bodies, &pairs, NULL, bits, &error), &error);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        const bool sensor = (kind_of(w, pair_a[k]) | kind_of(w, pair_b[k])) & NARC_SENSOR;
        const bool now = r->state[slot] & NARC_TOUCHING;
        if (sensor && moves(w, pair_a[k], pair_b[k]))
            assert_int_equal(now, bits[k / 64] >> k % 64 & 1);
        if (sensor && now)
            assert_int_equal(r->sensors[sensors++], slot);
        if (sensor || !moves(w, pair_a[k], pair_b[k])) {
            while (next < r->more_count && more[next].pair == slot)
                next++;
            continue;
        }
        assert_int_equal(now, row < found && rows[row].pair == k);
        check_row(&r->manifolds[slot], now ? rows[row] : (narc_manifold){0}, slot);
        if (now)
            assert_int_equal(r->touching[touching++], slot);
        for (row += now; row < found && rows[row].pair == k; row++)
            check_row(&more[next++], rows[row], slot);
    }
    assert_int_equal(row, found);
    assert_int_equal(next, r->more_count);
    assert_int_equal(touching, r->touching_count);
    assert_int_equal(sensors, r->sensor_count);
}

/* ------------------------------------------------------------------------------------------------ what stays */

/* What a caller keeps in a slot, and what the test remembers of the last step. */
struct mark {
    uint64_t low, high;
};

struct memory {
    struct mark was[PAIRS], now[PAIRS];
    size_t was_count, now_count;
};

static int compare_marks(const void *one, const void *other) { return memcmp(one, other, sizeof(struct mark)); }

static bool has(const struct mark *marks, size_t count, struct mark mark) {
    return bsearch(&mark, marks, count, sizeof mark, compare_marks);
}

static struct mark mark_of(uint64_t a, uint64_t b) { return (struct mark){a < b ? a : b, a < b ? b : a}; }

static void check_events(const struct world *w, const narc_step_result *r, struct memory *m) {
    struct mark *const marks = r->user;
    size_t began = 0, ended = 0;
    m->was_count = m->now_count;
    memcpy(m->was, m->now, m->now_count * sizeof *m->now);
    m->now_count = 0;
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        const struct mark mark = mark_of(w->id[pair_a[k]], w->id[pair_b[k]]), none = {0, 0};
        if (r->state[slot] & NARC_NEW) {
            assert_memory_equal(&marks[slot], &none, sizeof none);
            marks[slot] = mark;
        }
        assert_memory_equal(&marks[slot], &mark, sizeof mark);
        if (r->state[slot] & NARC_TOUCHING)
            m->now[m->now_count++] = mark;
    }
    qsort(m->now, m->now_count, sizeof *m->now, compare_marks);
    for (size_t k = 0; k < m->now_count; k++)
        began += !has(m->was, m->was_count, m->now[k]);
    for (size_t k = 0; k < m->was_count; k++)
        ended += !has(m->now, m->now_count, m->was[k]);
    assert_int_equal(began, r->began_count);
    assert_int_equal(ended, r->ended_count);
    for (size_t k = 0; k < began; k++) {
        const struct mark mark = mark_of(r->began[k].id_a, r->began[k].id_b);
        assert_true(has(m->now, m->now_count, mark) && !has(m->was, m->was_count, mark));
        assert_memory_equal(&marks[r->began[k].slot], &mark, sizeof mark);
    }
    for (size_t k = 0; k < ended; k++) {
        const struct mark mark = mark_of(r->ended[k].id_a, r->ended[k].id_b);
        assert_true(!has(m->now, m->now_count, mark) && has(m->was, m->was_count, mark));
        assert_memory_equal(&marks[r->ended[k].slot], &mark, sizeof mark);
    }
}

static void check_same(const narc_step_result *one, const narc_step_result *other) {
    assert_int_equal(one->count, other->count);
    assert_memory_equal(one->order, other->order, one->count * sizeof *one->order);
    assert_memory_equal(one->state, other->state, one->pairs.count);
    assert_int_equal(one->touching_count, other->touching_count);
    assert_int_equal(one->began_count, other->began_count);
    assert_int_equal(one->ended_count, other->ended_count);
    assert_int_equal(one->asked_count, other->asked_count);
    assert_int_equal(one->skipped, other->skipped);
    assert_memory_equal(one->ended, other->ended, one->ended_count * sizeof *one->ended);
    if (one->manifolds && other->manifolds) {
        assert_memory_equal(one->manifolds, other->manifolds, one->pairs.count * sizeof *one->manifolds);
        assert_memory_equal(one->more, other->more, one->more_count * sizeof *one->manifolds);
    }
}

/* Rows of contacts touch where manifolds do, and are as deep. */
static void check_contact_rows(const narc_step_result *manifolds, const narc_step_result *contacts) {
    check_same(manifolds, contacts);
    for (size_t k = 0; k < manifolds->count; k++) {
        const uint32_t slot = manifolds->order[k];
        const narc_manifold *const m = &manifolds->manifolds[slot];
        const narc_contact *const c = &contacts->contacts[slot];
        assert_int_equal(m->count > 0, c->count > 0);
    }
}

static narc_contacts *make_contacts(uint32_t row_kind, const narc_allocator *allocator) {
    narc_contacts *contacts;
    narc_error error;
    const narc_contacts_settings settings = {
        .rows = row_kind, .user_size = sizeof(struct mark), .allocator = allocator};
    expect_ok(narc_create_contacts(&settings, &contacts, &error), &error);
    return contacts;
}

static void check_world(struct test_random random, bool ground, size_t steps) {
    static struct memory memory;
    struct world *const w = make_world(random, ground);
    const narc_workers workers = narc_openmp_workers(3);
    narc_contacts *const all = make_contacts(NARC_MANIFOLD_ROWS, NULL), *const listed = make_contacts(0, NULL),
                         *const shared = make_contacts(0, NULL),
                         *const contacts = make_contacts(NARC_CONTACT_ROWS, NULL);
    const narc_step_result *r, *other;
    narc_error error;
    memory.now_count = 0;
    for (size_t k = 0; k < steps; k++) {
        const narc_bodies bodies = narc_view_bodies(w->body, w->count + w->ground);
        const narc_pair_filter filter = {.kind = NARC_ARRAY(w->kind),
                                         .category = NARC_ARRAY(w->category),
                                         .mask = NARC_ARRAY(w->mask),
                                         .group = NARC_ARRAY(w->group)};
        narc_step step = make_step(w, &bodies, &filter);
        expect_ok(narc_update_contacts(all, w->store, &step, &r, &error), &error);
        check_pairs(w, &step, r);
        check_rows(w, &step, r);
        check_events(w, r, &memory);
        assert_true(r->asked_count <= r->count);
        step.workers = &workers;
        expect_ok(narc_update_contacts(shared, w->store, &step, &other, &error), &error);
        check_same(r, other);
        step.workers = NULL;
        expect_ok(narc_update_contacts(contacts, w->store, &step, &other, &error), &error);
        if (!ground)
            check_contact_rows(r, other);
        if (k > 0) {
            step.moved = NARC_ARRAY(w->moved);
            step.moved_count = w->moved_count;
        }
        expect_ok(narc_update_contacts(listed, w->store, &step, &other, &error), &error);
        check_same(r, other);
        move_world(w);
    }
    narc_destroy_contacts(all);
    narc_destroy_contacts(listed);
    narc_destroy_contacts(shared);
    narc_destroy_contacts(contacts);
    destroy_world(w);
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

/* ------------------------------------------------------------------------------------------------ recycling */

/* Rows that were kept are off by less than the tolerance, and so is what is not told yet. */
static size_t check_followed(const struct world *w, const narc_step *step, const narc_step_result *r) {
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
            assert_true(fabsf(deepest - margins[k]) < step->recycling);
        assert_true(!(r->state[slot] & NARC_FOLLOWED) || fabsf(hypotf(row->normal_x, row->normal_y) - 1) < 1e-5f);
    }
    return followed;
}

TEST(rows_follow_their_bodies) {
    struct world *const w = make_world(test_random_named("followers"), false);
    narc_contacts *const contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const narc_step_result *r;
    narc_error error;
    size_t followed = 0, asked = 0, pairs = 0;
    w->has_filter = w->has_ahead = w->has_motion = false;
    w->body[3].x = 0;
    for (size_t k = 0; k < 100; k++) {
        const narc_bodies bodies = narc_view_bodies(w->body, w->count);
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
    narc_destroy_contacts(contacts);
    destroy_world(w);
}

/* ------------------------------------------------------------------------------------------------ what fails */

static size_t allowed; /* allocations until one fails; SIZE_MAX: none does */

/* The size in front, and behind the memory what nobody may write. */
enum { IN_FRONT = 16, BEHIND = 64 };

static void *allocate(size_t size, void *context) {
    (void)context;
    char *const memory = allowed == SIZE_MAX || allowed-- > 0 ? malloc(IN_FRONT + size + BEHIND) : NULL;
    if (!memory)
        return NULL;
    memcpy(memory, &size, sizeof size);
    memset(memory + IN_FRONT + size, GUARD_JUNK, BEHIND);
    return memory + IN_FRONT;
}

static void release(void *given, void *context) {
    char *const memory = (char *)given - IN_FRONT;
    size_t size;
    (void)context;
    memcpy(&size, memory, sizeof size);
    for (size_t k = 0; k < BEHIND; k++)
        assert_int_equal(memory[IN_FRONT + size + k], (char)GUARD_JUNK);
    free(memory);
}

static const narc_allocator watched = {.allocate = allocate, .release = release};

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
        struct world *const w = make_world((struct test_random){random_bits(&random)}, trial % 2);
        const narc_step_result *r = NULL;
        narc_contacts *contacts;
        narc_error error;
        allowed = SIZE_MAX;
        contacts = make_contacts(NARC_MANIFOLD_ROWS, &watched);
        for (size_t k = 0; k < 12; k++) {
            const narc_bodies bodies = narc_view_bodies(w->body, w->count + w->ground);
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
                    move_world(w);
                else
                    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
            }
            if (status == NARC_OK || allowed == SIZE_MAX) {
                const narc_bodies now = narc_view_bodies(w->body, w->count + w->ground);
                const narc_step again = make_step(w, &now, &filter);
                allowed = SIZE_MAX;
                expect_ok(narc_update_contacts(contacts, w->store, &again, &r, &error), &error);
                check_pairs(w, &again, r);
                check_rows(w, &again, r);
                for (size_t i = 0; i < r->count; i++)
                    ((struct mark *)r->user)[r->order[i]] = mark_of(w->id[pair_a[i]], w->id[pair_b[i]]);
            }
            move_world(w);
        }
        narc_destroy_contacts(contacts);
        destroy_world(w);
    }
    assert_true(failures > test_trials(40));
}

/* Bodies of one shape by their places, with ids from 1 on. */
struct few {
    narc_shapes *store;
    narc_body body[600];
    uint64_t id[600];
    uint8_t kind[600];
    narc_bodies bodies;
    narc_pair_filter filter;
    narc_step step;
    narc_contacts *contacts;
};

static struct few *make_few(struct shape shape, size_t count, const narc_allocator *allocator) {
    struct few *const few = calloc(1, sizeof *few);
    assert_non_null(few);
    few->store = empty_store();
    store_shape(few->store, shape);
    for (size_t k = 0; k < count; k++) {
        few->body[k] = (narc_body){.x = (double)(k / 2) * 10 + 0.9 * (double)(k % 2), .cosine = 1, .scale = 1};
        few->id[k] = k + 1;
    }
    few->bodies = narc_view_bodies(few->body, count);
    few->filter = (narc_pair_filter){.kind = NARC_ARRAY(few->kind)};
    few->step = (narc_step){
        .bodies = &few->bodies, .margin = 0.02f, .skin = 1, .id = NARC_ARRAY(few->id), .filter = &few->filter};
    few->contacts = make_contacts(NARC_MANIFOLD_ROWS, allocator);
    return few;
}

static const narc_step_result *step_few(struct few *few) {
    const narc_step_result *r;
    narc_error error;
    expect_ok(narc_update_contacts(few->contacts, few->store, &few->step, &r, &error), &error);
    return r;
}

static void destroy_few(struct few *few) {
    narc_destroy_contacts(few->contacts);
    narc_destroy_shapes(few->store);
    free(few);
}

/* All slots that there is room for are asked, and new. */
TEST(slots_have_room) {
    allowed = SIZE_MAX;
    struct few *const few = make_few(circle_of(0.5), 600, &watched);
    few->bodies.count = 8;
    assert_int_equal(step_few(few)->count, 4);
    for (size_t count = 500; count <= 600; count += 2) {
        few->bodies.count = count;
        for (size_t k = 0; k < count; k++)
            few->body[k].y += 1e-4;
        assert_int_equal(step_few(few)->count, count / 2);
    }
    destroy_few(few);
}

/* Two that sleep change their order: the row is that of (a, b) all the same. */
TEST(rows_at_rest_are_turned) {
    struct few *const few = make_few(circle_of(0.5), 3, NULL);
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
    destroy_few(few);
}

/* A step that failed has not been: the list of what moved is that since the step before it. */
TEST(goes_on_from_the_last_good_step) {
    struct few *const few = make_few(circle_of(0.5), 3, NULL);
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
    destroy_few(few);
}

/* The same bodies in an object that knows nothing of them: as much touches, as deep. */
static void check_with_fresh(struct few *few) {
    narc_contacts *const kept = few->contacts;
    const narc_step_result *const r = step_few(few);
    few->contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const narc_step_result *const fresh = step_few(few);
    assert_int_equal(r->count, fresh->count);
    assert_int_equal(r->touching_count, fresh->touching_count);
    assert_int_equal(r->more_count, fresh->more_count);
    for (size_t k = 0; k < r->touching_count; k++)
        check_row(&r->manifolds[r->touching[k]], fresh->manifolds[fresh->touching[k]], r->touching[k]);
    narc_destroy_contacts(few->contacts);
    few->contacts = kept;
}

/* Two change their numbers, and each stands where the other one stood. */
TEST(bodies_are_known_by_their_ids) {
    struct few *const few = make_few(circle_of(0.5), 3, NULL);
    few->body[1].x = 0.05;
    few->body[2].x = 0.9;
    check_with_fresh(few);
    few->id[0] = 2;
    few->id[1] = 1;
    check_with_fresh(few);
    destroy_few(few);
}

/* Entries of a chain as static bodies behind body 0, without what is between. */
static size_t lay_entries(struct few *few, const narc_arc *arcs, size_t count, double weld, uint32_t *run) {
    static narc_chain_entry entries[256];
    const narc_chain_options options = {.weld = weld};
    size_t found = 0;
    narc_error error;
    expect_ok(narc_add_chain(few->store, arcs, count, &options, entries, 256, &found, &error), &error);
    run[0] = NARC_NO_RUN;
    for (size_t k = 0; k < found; k++) {
        few->body[1 + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        few->kind[1 + k] = NARC_STATIC;
        few->id[1 + k] = 2 + k;
        run[1 + k] = entries[k].run;
    }
    few->bodies.count = 1 + found;
    return found;
}

/* A ball lies where two entries meet, and one row is merged away. The piece that has the other goes, or is no ground any
 * more: what was merged away is told. */
TEST(ground_that_goes_leaves_what_it_was_merged_with) {
    const narc_arc line[] = {{2, 0, 0, PI / 2, PI / 2}, {-2, 0, 0, PI / 2, PI / 2}};
    for (int way = 0; way < 10; way++) {
        struct few *const few = make_few(circle_of(0.5), 2, NULL);
        static uint32_t run[600];
        static uint64_t mask[600];
        const uint32_t small = store_shape(few->store, circle_of(0.01));
        const size_t count = lay_entries(few, line, 2, 0.5, run), gone = 4 + (size_t)way / 5;
        memset(mask, 0xff, sizeof mask);
        few->step.run = NARC_ARRAY(run);
        few->filter.mask = NARC_ARRAY(mask);
        few->step.skin = 0.05f;
        few->body[0] = (narc_body){(few->body[4].x + few->body[5].x) / 2, 0.5, 1, 0, 1, 0};
        check_with_fresh(few);
        assert_int_equal(step_few(few)->touching_count, 1);
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
            few->body[gone] = few->body[count];
            few->id[gone] = count + 1;
            few->bodies.count--;
            break;
        default:
            few->body[gone].y = -50;
            break;
        }
        check_with_fresh(few);
        assert_int_equal(step_few(few)->touching_count, 1);
        destroy_few(few);
    }
}

/* A box touches a bowl in two places, and then the bowl is a circle. */
TEST(second_rows_go_with_their_ground) {
    struct few *const few = make_few(box_of(1, 0.2, 0), 2, NULL);
    const narc_arc bowl = {0, 0, -1, PI / 2 + 0.65, PI / 2 - 0.65};
    static uint32_t run[600];
    const uint32_t circle = store_shape(few->store, circle_of(1));
    const size_t count = lay_entries(few, &bowl, 1, 0, run);
    few->step.run = NARC_ARRAY(run);
    few->body[0] = (narc_body){0, -0.77, 1, 0, 1, 0};
    check_with_fresh(few);
    assert_true(step_few(few)->more_count > 0);
    for (size_t k = 1; k <= count; k++) {
        few->body[k].shape = circle;
        run[k] = NARC_NO_RUN;
    }
    check_with_fresh(few);
    assert_int_equal(step_few(few)->more_count, 0);
    destroy_few(few);
}

/* What was kept of a row goes with it, whatever recycling is meanwhile. */
TEST(kept_rows_are_those_of_now) {
    struct few *const few = make_few(box_of(1, 1, 0), 2, NULL);
    const double places[] = {0.7, 0.9, 2, 2, 0.7, 0.7005};
    for (size_t k = 0; k < 6; k++) {
        for (size_t i = 0; i < 2; i++) {
            few->body[i].cosine = few->body[i].sine = 0.70710678f;
            few->body[i].x = few->body[i].y = i == 0 ? 0 : places[k];
        }
        few->step.recycling = k == 1 || k == 2 ? 0 : 0.01f;
        assert_int_equal(step_few(few)->touching_count, places[k] < 0.8);
    }
    destroy_few(few);
}

/* A box turns about the first point of its contact: that stays, and the second one does not. */
TEST(a_turn_is_a_way) {
    struct few *const few = make_few(box_of(1, 1, 0), 2, NULL);
    few->body[0].x = few->body[1].x = 0;
    few->body[1].y = 0.995;
    few->step.recycling = 0.01f;
    const narc_manifold row = step_few(few)->manifolds[0];
    assert_int_equal(row.count, 2);
    for (int sign = -1; sign <= 1; sign += 2) {
        const double angle = 0.015 * sign, x = (double)row.point[0].x, y = (double)row.point[0].y;
        few->body[1] = (narc_body){x + cos(angle) * -x - sin(angle) * (0.995 - y),
                                   y + sin(angle) * -x + cos(angle) * (0.995 - y),
                                   (float)cos(angle),
                                   (float)sin(angle),
                                   1,
                                   0};
        const narc_step_result *const r = step_few(few);
        assert_int_equal(r->state[0] & (NARC_ASKED | NARC_FOLLOWED), NARC_ASKED);
        few->body[1] = (narc_body){0, 0.995, 1, 0, 1, 0};
        step_few(few);
    }
    destroy_few(few);
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
    struct few *const few = make_few(circle_of(0.5), 600, NULL);
    struct test_random random = test_random_named("shared steps");
    const narc_workers workers = narc_openmp_workers(3);
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
    destroy_few(few);
}

static void expect_refused(narc_contacts *contacts, const narc_shapes *store, const narc_step *step, narc_status status,
                           const char *words) {
    const narc_step_result *r;
    narc_error error = {0};
    expect_error(narc_update_contacts(contacts, store, step, &r, &error), status, &error, words);
}

TEST(says_what_is_wrong) {
    struct world *const w = make_world(test_random_named("wrong"), false);
    narc_contacts *const contacts = make_contacts(NARC_MANIFOLD_ROWS, NULL);
    const narc_bodies bodies = narc_view_bodies(w->body, w->count);
    const uint32_t moved[] = {1, BODIES};
    const narc_step_result *r;
    narc_contacts *none;
    narc_error error;
    narc_step step = {.bodies = &bodies};
    assert_int_equal(narc_create_contacts(&(narc_contacts_settings){.rows = 2}, &none, &error), NARC_ERROR_ARGUMENT);
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
    step.reserved[1] = w;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.reserved[1]");
    step.reserved[1] = NULL;
    step.moved_count = 1;
    expect_refused(contacts, w->store, &step, NARC_ERROR_ARGUMENT, "step.moved is NULL");
    step.moved_count = 0;
    narc_forget_contacts(contacts);
    expect_ok(narc_update_contacts(contacts, w->store, &step, &r, &error), &error);
    step.moved = NARC_ARRAY(moved);
    step.moved_count = 2;
    expect_refused(contacts, w->store, &step, NARC_ERROR_INDEX, "step.moved[1] is body 160");
    w->body[1].shape = 9999;
    expect_refused(contacts, w->store, &step, NARC_ERROR_INDEX, "body 1: shape is 9999");
    w->body[1].shape = 0;
    step.moved_count = 1;
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
    narc_destroy_contacts(contacts);
    narc_destroy_contacts(NULL);
    destroy_world(w);
}

TEST_MAIN("contacts")
