/* SPDX-License-Identifier: MIT
 *
 * step_world.c - worlds in which bodies come, go, change places, sleep, fall asleep, jump, become sensors, and shapes are
 * replaced; and what contacts that stay are to say of each step, by the plain calls.
 */
#include "step_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "expect.h"
#include "families.h"
#include "guard.h"
#include "merge.h"
#include "narc.h"
#include "narc_broad_phase.h"

static double size_of_world(const struct step_world *w) { return 1.2 * sqrt((double)w->count); }

static void put_body(struct step_world *w, size_t k) {
    struct test_random *const random = &w->random;
    const double angle = random_between(random, -PI, PI), size = size_of_world(w);
    w->body[k].x = random_between(random, -size, size);
    w->body[k].y = random_between(random, w->ground ? 0 : -size, size);
    w->body[k].cosine = (float)cos(angle);
    w->body[k].sine = (float)sin(angle);
}

static void make_body(struct step_world *w, size_t k) {
    struct test_random *const random = &w->random;
    w->body[k] =
        (narc_body){.scale = (float)random_between(random, 0.4, 1.1), .shape = (uint32_t)random_below(random, SHAPES)};
    put_body(w, k);
    w->id[k] = ++w->last_id;
    w->kind[k] = random_below(random, 6) ? 0 : (uint8_t)random_below(random, 8);
    w->category[k] = 1u << random_below(random, 3);
    w->mask[k] = random_below(random, 4) ? UINT64_MAX : 3;
    w->owner[k] = random_below(random, 9) ? UINT32_MAX : (uint32_t)random_below(random, 3);
    w->run[k] = NARC_NO_RUN;
    w->motion_x[k] = w->motion_y[k] = w->ahead[k] = 0;
}

/* Ground's entries stand behind all bodies. */
static void copy_body(struct step_world *w, size_t to, size_t from) {
    w->body[to] = w->body[from];
    w->id[to] = w->id[from];
    w->kind[to] = w->kind[from];
    w->category[to] = w->category[from];
    w->mask[to] = w->mask[from];
    w->owner[to] = w->owner[from];
    w->run[to] = w->run[from];
    w->motion_x[to] = w->motion_x[from];
    w->motion_y[to] = w->motion_y[from];
    w->ahead[to] = w->ahead[from];
}

static void lay_world(struct step_world *w) {
    narc_chain_entry entries[ROOM / 2];
    narc_error error;
    const enum chain_family families[] = {CHAIN_HILLS, CHAIN_BOWLS, CHAIN_MIXED, CHAIN_STEPS};
    AUTO(free_at) const struct chain chain = make_chain(&w->random, families[random_below(&w->random, 4)]);
    expect_ok(narc_add_chain(w->store, chain.arcs, chain.count, NULL, entries, ROOM / 2, &w->ground, &error), &error);
    for (size_t k = 0; k < w->ground; k++) {
        make_body(w, w->count + k);
        w->body[w->count + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        w->kind[w->count + k] = NARC_STATIC;
        w->owner[w->count + k] = UINT32_MAX;
        w->run[w->count + k] = entries[k].run;
    }
}

struct step_world *make_step_world(struct test_random random, bool ground) {
    struct step_world *const w = calloc(1, sizeof *w);
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

void destroy_step_world(struct step_world *w) {
    narc_destroy_shapes(w->store);
    free(w);
}

static void note_moved(struct step_world *w, size_t k) {
    for (size_t i = 0; i < w->moved_count; i++)
        if (w->moved[i] == k)
            return;
    w->moved[w->moved_count++] = (uint32_t)k;
}

/* What happens between two steps. */
void move_step_world(struct step_world *w) {
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
    if (random_below(random, 6) == 0) { /* the origin moves, a little or far */
        const double far = random_log_between(random, 1, 1e6);
        w->origin = (narc_point){random_between(random, -far, far), random_between(random, -far, far)};
    }
}

narc_step make_step(const struct step_world *w, const narc_bodies *bodies, const narc_pair_filter *filter) {
    narc_step step = {.bodies = bodies,
                      .margin = w->margin,
                      .second_margin = w->has_motion ? 0.2f : 0,
                      .skin = w->skin,
                      .front_only = w->has_motion,
                      .id = NARC_ARRAY(w->id),
                      .origin = &w->origin};
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

uint32_t pair_a[PAIRS], pair_b[PAIRS];
static uint32_t near_a[PAIRS], near_b[PAIRS], tested[PAIRS];
float margins[PAIRS];
static narc_manifold rows[PAIRS];
static uint64_t bits[PAIRS / 64 + 1];
static narc_box boxes[ROOM];

static unsigned kind_of(const struct step_world *w, uint32_t body) { return w->has_filter ? w->kind[body] & 7u : 0; }

static bool moves(const struct step_world *w, uint32_t a, uint32_t b) {
    return !(kind_of(w, a) & 3 && kind_of(w, b) & 3);
}

/* All pairs that are closer than the margin are listed. */
void check_pairs(const struct step_world *w, const narc_step *step, const narc_step_result *r) {
    narc_broad_phase *broad;
    narc_error error;
    size_t found = 0, at = 0;
    const narc_box_options options = {
        .margin = step->margin / 2, .motion_x = step->motion_x, .motion_y = step->motion_y};
    expect_ok(narc_compute_boxes(w->store, step->bodies, &options, boxes, &error), &error);
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    expect_ok(narc_find_pairs(broad, boxes, step->bodies->count, step->filter, NULL, near_a, near_b, 0, PAIRS, &found,
                              &error),
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
void check_row(const narc_manifold *row, narc_manifold expected, uint32_t slot) {
    expected.pair = slot;
    assert_memory_equal(row, &expected, sizeof expected);
}

void check_rows(const struct step_world *w, const narc_step *step, const narc_step_result *r) {
    const narc_pairs pairs = {.count = r->count, .a = NARC_ARRAY(pair_a), .b = NARC_ARRAY(pair_b)};
    const narc_manifold *const more = r->more;
    size_t asked = 0, found = 0, row = 0, next = 0, touching = 0, sensors = 0;
    narc_error error;
    for (size_t k = 0; k < r->count; k++) {
        margins[k] = step->margin + (w->has_ahead ? w->ahead[pair_a[k]] + w->ahead[pair_b[k]] : 0);
        if (moves(w, pair_a[k], pair_b[k]) && !((kind_of(w, pair_a[k]) | kind_of(w, pair_b[k])) & NARC_SENSOR))
            tested[asked++] = (uint32_t)k;
    }
    const narc_query query = {.margins = NARC_ARRAY(margins),
                              .second_margin = step->second_margin,
                              .front_only = step->front_only,
                              .selection = {tested, sizeof *tested},
                              .selection_count = asked};
    const narc_query overlaps = {.front_only = step->front_only};
    expect_ok(narc_find_manifolds(w->store, step->bodies, &pairs, &query, rows, PAIRS, &found, &error), &error);
    if (step->run.base)
        found = narc_merge_rows(&(narc_merging){&pairs, step->run, w->store, step->bodies, .manifolds = rows}, found);
    expect_ok(narc_find_overlaps(w->store, step->bodies, &pairs, &overlaps, bits, &error), &error);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        const bool sensor = (kind_of(w, pair_a[k]) | kind_of(w, pair_b[k])) & NARC_SENSOR;
        const bool now = r->state[slot] & NARC_TOUCHING, rests = !moves(w, pair_a[k], pair_b[k]);
        if (sensor && !rests) {
            assert_int_equal(now, bits[k / 64] >> k % 64 & 1);
            check_row(&r->manifolds[slot], (narc_manifold){0}, slot); /* it may have been none */
        }
        if (sensor && now)
            assert_int_equal(r->sensors[sensors++], slot);
        if (sensor || rests) {
            while (rests && next < r->more_count && more[next].pair == slot)
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

static int compare_marks(const void *one, const void *other) { return memcmp(one, other, sizeof(struct mark)); }

static bool has(const struct mark *marks, size_t count, struct mark mark) {
    return bsearch(&mark, marks, count, sizeof mark, compare_marks);
}

struct mark mark_of(uint64_t a, uint64_t b) {
    return (struct mark){a < b ? a : b, a < b ? b : a};
}

void check_events(const struct step_world *w, const narc_step_result *r, struct memory *m) {
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

static void check_rows_same(const narc_step_result *one, const narc_step_result *other) {
    assert_int_equal(one->count, other->count);
    assert_memory_equal(one->order, other->order, one->count * sizeof *one->order);
    assert_int_equal(one->touching_count, other->touching_count);
    assert_int_equal(one->began_count, other->began_count);
    assert_int_equal(one->ended_count, other->ended_count);
    assert_memory_equal(one->ended, other->ended, one->ended_count * sizeof *one->ended);
    if (one->manifolds && other->manifolds) {
        assert_memory_equal(one->manifolds, other->manifolds, one->pairs.count * sizeof *one->manifolds);
        assert_memory_equal(one->more, other->more, one->more_count * sizeof *one->manifolds);
    }
}

void check_same(const narc_step_result *one, const narc_step_result *other) {
    check_rows_same(one, other);
    assert_memory_equal(one->state, other->state, one->pairs.count);
    assert_int_equal(one->asked_count, other->asked_count);
    assert_int_equal(one->skipped, other->skipped);
}

void check_own(const narc_step_result *one, const narc_step_result *other) {
    check_rows_same(one, other);
    for (size_t slot = 0; slot < one->pairs.count; slot++)
        assert_int_equal(one->state[slot] & ~NARC_ASKED, other->state[slot] & ~NARC_ASKED);
    assert_true(other->asked_count <= other->count);
    assert_int_equal(other->skipped, 0);
}

/* Rows of contacts touch where manifolds do, and are as deep. */
void check_contact_rows(const narc_step_result *manifolds, const narc_step_result *contacts) {
    check_same(manifolds, contacts);
    for (size_t k = 0; k < manifolds->count; k++) {
        const uint32_t slot = manifolds->order[k];
        const narc_manifold *const m = &manifolds->manifolds[slot];
        const narc_contact *const c = &contacts->contacts[slot];
        assert_int_equal(m->count > 0, c->count > 0);
    }
}

void save(const narc_contacts *contacts, struct bytes *out) {
    narc_error error;
    out->count = narc_count_contact_bytes(contacts);
    out->all = realloc(out->all, out->count);
    assert_non_null(out->all);
    expect_ok(narc_save_contacts(contacts, out->all, out->count, &error), &error);
}

void check_saved_alike(const narc_contacts *one, const narc_contacts *other) {
    struct bytes first = {0}, second = {0};
    save(one, &first);
    save(other, &second);
    assert_int_equal(first.count, second.count);
    assert_memory_equal(first.all, second.all, first.count);
    free(first.all);
    free(second.all);
}

narc_contacts *make_contacts(uint32_t row_kind, const narc_allocator *allocator) {
    narc_contacts *contacts;
    narc_error error;
    const narc_contacts_settings settings = {
        .rows = row_kind, .user_size = sizeof(struct mark), .allocator = allocator};
    expect_ok(narc_create_contacts(&settings, &contacts, &error), &error);
    return contacts;
}

/* ------------------------------------------------------------------------------------------------ memory */

size_t allowed;

/* The size in front, and behind the memory what nobody may write. */
enum { IN_FRONT = 16, BEHIND = 64 };

static void *allocate(size_t size, void *context) {
    (void)context;
    char *const memory = allowed > 0 ? malloc(IN_FRONT + size + BEHIND) : NULL;
    if (!memory)
        return NULL;
    allowed -= allowed < SIZE_MAX;
    memcpy(memory, &size, sizeof size);
    memset(memory + IN_FRONT + size, GUARD_JUNK, BEHIND);
    return memory + IN_FRONT;
}

static void release(void *given, void *context) {
    AUTO(free_at) char *const memory = (char *)given - IN_FRONT;
    size_t size;
    (void)context;
    memcpy(&size, memory, sizeof size);
    for (size_t k = 0; k < BEHIND; k++)
        assert_int_equal(memory[IN_FRONT + size + k], (char)GUARD_JUNK);
}

const narc_allocator watched = {.allocate = allocate, .release = release};
