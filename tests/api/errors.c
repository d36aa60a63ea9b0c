/* SPDX-License-Identifier: MIT
 *
 * errors.c - wrong arguments, in every question: each has its status and a message that names the culprit, and no
 * output is touched; and lists that are too short.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "ledger.h"
#include "narc_contacts.h"
#include "questions.h"

enum { PAIRS = 200, BODIES = 30 };

/* Outputs of all calls. */
struct outputs {
    narc_manifold rows[PAIRS]; /* of others and bits, too */
    uint8_t outcomes[PAIRS];
    size_t count, skipped;
};

/* What a wrong call is made of, beside outputs: those of `query` are set for each call. */
struct call {
    const void *shapes;
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    narc_query query;
};

static narc_status run(const struct question *question, const struct call *call, struct outputs *out,
                       narc_error *error) {
    narc_query query = call->query;
    query.out_skipped = &out->skipped;
    const struct asked asked = {call->shapes, call->bodies, call->pairs, &query,
                                out->rows,    PAIRS,        &out->count, out->outcomes};
    return question->ask(question, &asked, error);
}

/* With an error to fill and without, and some numbers of threads: always the same error, and nothing is written. */
static void check_call(const struct question *question, struct call call, narc_status expected,
                       const char *const texts[], size_t text_count) {
    AUTO(free_at) struct outputs *out = make_junk(sizeof *out);
    for (unsigned threads = 0; threads < 3; threads++) {
        const narc_workers workers = openmp_workers(threads);
        call.query.workers = &workers;
        narc_error error = {0};
        const narc_status status = run(question, &call, out, &error);
        expect_error(status, expected, &error, "");
        for (size_t k = 0; k < text_count; k++)
            expect_error(status, expected, &error, texts[k]);
        assert_int_equal(run(question, &call, out, NULL), expected);
    }
    assert_true(is_junk(out, sizeof *out));
}

/* What is wrong with a batch is so in every question. */
static void check_batch(struct call call, narc_status expected, const char *const texts[], size_t text_count) {
    for (size_t q = 0; q < question_count; q++)
        check_call(&questions[q], call, expected, texts, text_count);
}

#define NAMES(...) (const char *const[]){__VA_ARGS__}, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)

/* A scene, and a call that has nothing wrong. */
struct fixture {
    struct scene scene;
    narc_bodies bodies;
    narc_pairs pairs;
    struct call call;
};

static void set_up(struct fixture *f) {
    struct test_random random = test_random_named("errors");
    f->scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    f->bodies = scene_bodies(&f->scene);
    f->pairs = scene_pairs(&f->scene);
    f->call = (struct call){take_shapes(f->scene.store, NULL), &f->bodies, &f->pairs, {.margin = INFINITY}};
}

static void tear_down(struct fixture *f) {
    release_shapes(f->call.shapes);
    destroy_scene(&f->scene);
}

/* ------------------------------------------------------------------------------------------------ arguments */

TEST(test_queries) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    enum { MANIFOLDS = sizeof(narc_manifold) };
    static const struct {
        narc_query query;
        size_t row_size; /* of such rows alone; 0: of all */
        narc_status status;
        const char *words;
    } cases[] = {
        {{.margin = NAN}, 0, NARC_ERROR_NOT_FINITE, "margin"},
        {{.second_margin = NAN}, MANIFOLDS, NARC_ERROR_NOT_FINITE, "second_margin"},
        {{.flat_angle = NAN}, MANIFOLDS, NARC_ERROR_NOT_FINITE, "flat_angle"},
        {{.flat_angle = 1.6f}, MANIFOLDS, NARC_ERROR_ARGUMENT, "flat_angle is 1.6"},
        {{.row_stride = 4}, 0, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = sizeof(narc_contact) - 4}, 0, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = sizeof(narc_manifold) - 4}, MANIFOLDS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = 66}, 0, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = 129}, 0, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = -32}, 0, NARC_ERROR_ARGUMENT, "row_stride"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        f.call.query = cases[k].query;
        for (size_t q = 0; q < question_count; q++)
            if (questions[q].row_size && !questions[q].polygons && /* there are others */
                (!cases[k].row_size || cases[k].row_size == questions[q].row_size))
                check_call(&questions[q], f.call, cases[k].status, &cases[k].words, 1);
    }
    f.call.query = (narc_query){.selection_count = 1};
    check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("selection is NULL"));
    for (size_t k = 0; k < sizeof f.call.query.reserved / sizeof *f.call.query.reserved; k++) {
        f.call.query = (narc_query){0};
        f.call.query.reserved[k] = &f;
        check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("reserved"));
    }
}

TEST(test_null_arguments) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    struct call call = f.call;
    call.shapes = NULL;
    check_batch(call, NARC_ERROR_ARGUMENT, &shapes_name, 1);
    call = f.call;
    call.bodies = NULL;
    check_batch(call, NARC_ERROR_ARGUMENT, NAMES("bodies"));
    call = f.call;
    call.pairs = NULL;
    check_batch(call, NARC_ERROR_ARGUMENT, NAMES("pairs"));
    const narc_bodies bodies = f.bodies;
    const narc_pairs pairs = f.pairs;
    const void **const bases[] = {
        (const void **)&f.bodies.x.base,    (const void **)&f.bodies.y.base,     (const void **)&f.bodies.cosine.base,
        (const void **)&f.bodies.sine.base, (const void **)&f.bodies.shape.base, (const void **)&f.pairs.a.base,
        (const void **)&f.pairs.b.base,
    };
    static const char *const names[] = {"x", "y", "cosine", "sine", "shape", "a", "b"};
    for (int k = 0; k < 7; k++) {
        *bases[k] = NULL;
        check_batch(f.call, NARC_ERROR_ARGUMENT, &names[k], 1);
        f.bodies = bodies;
        f.pairs = pairs;
    }
    f.bodies.x.precision = f.bodies.y.precision = (narc_precision)7;
    check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("x.precision is 7"));
    f.bodies.x.precision = NARC_FLOAT32;
    f.bodies.y.precision = NARC_FLOAT64;
    check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("y.precision is 1"));
    f.bodies = bodies;
    for (int k = 0; k < 2; k++) {
        narc_bodies others = bodies;
        f.bodies.reserved[k] = f.pairs.reserved[k] = others.reserved[k] = &f;
        call.pairs = &pairs;
        call.bodies = &f.bodies;
        check_batch(call, NARC_ERROR_ARGUMENT, NAMES("reserved"));
        call.pairs = &f.pairs;
        call.bodies = &bodies;
        check_batch(call, NARC_ERROR_ARGUMENT, NAMES("reserved"));
        f.pairs = pairs;
        f.pairs.other_bodies = &others;
        check_batch(call, NARC_ERROR_ARGUMENT, NAMES("reserved"));
        f.bodies = bodies;
        f.pairs = pairs;
    }
}

/* A pair that names a body there is not, whichever of those that are looked at at once, in plain arrays and in rows of
 * three; of two such pairs the first one is told. */
TEST(test_body_index) {
    static const uint32_t wrong[] = {BODIES, 99991, 0x80000000u, UINT32_MAX};
    uint32_t rows[PAIRS][3];
    for (size_t k = 0; k < 64; k++) {
        AUTO(tear_down) struct fixture f;
        set_up(&f);
        const size_t pair = 134 + k / 16;
        *(k % 2 ? &f.scene.pairs[pair].a : &f.scene.pairs[pair].b) = wrong[k % 8 / 2];
        if (k < 16)
            f.scene.pairs[188].a = 77777;
        for (size_t i = 0; i < PAIRS; i++) {
            rows[i][0] = f.scene.pairs[i].a;
            rows[i][2] = f.scene.pairs[i].b;
        }
        if (k & 8) {
            f.pairs.a = (narc_index_column){&rows[0][0], sizeof *rows};
            f.pairs.b = (narc_index_column){&rows[0][2], sizeof *rows};
        }
        char body[16], number[16];
        snprintf(body, sizeof(body), "%lu", (unsigned long)wrong[k % 8 / 2]);
        snprintf(number, sizeof(number), "%zu", pair);
        check_batch(f.call, NARC_ERROR_INDEX, NAMES(number, body));
    }
}

/* Several threads look; the first wrong pair of all is still the one that is told. */
TEST(test_first_wrong_pair) {
    enum { MANY = 9000 };
    struct test_random random = test_random_named("first wrong pair");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, MANY);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    const void *shapes = take_shapes(scene.store, NULL);
    AUTO(free_at) narc_manifold *rows = make_junk(MANY * sizeof *rows);
    AUTO(free_at) uint8_t *outcomes = make_junk(MANY);
    scene.pairs[8111].a = scene.pairs[4055].b = scene.pairs[4056].a = 5005;
    for (size_t k = 0; k < 6 * question_count; k++) {
        const narc_workers workers = openmp_workers((unsigned)(k % 6));
        const narc_query query = {.workers = &workers};
        size_t found;
        const struct asked asked = {shapes, &bodies, &pairs, &query, rows, MANY, &found, outcomes};
        narc_error error = {0};
        const narc_status status = questions[k / 6].ask(&questions[k / 6], &asked, &error);
        expect_error(status, NARC_ERROR_INDEX, &error, "4055");
        expect_error(status, NARC_ERROR_INDEX, &error, "5005");
        assert_int_equal(error.index, 4055);
    }
    assert_true(is_junk(outcomes, MANY));
    release_shapes(shapes);
}

TEST(test_shape_index) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    for (size_t k = 0; k < PAIRS; k++)
        f.scene.pairs[k] = (struct pair){(uint32_t)(k % 20), (uint32_t)(k / 20)};
    f.scene.pairs[141].b = 23;
    f.scene.bodies[23].shape = 4711;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "23", "4711"));
    f.scene.bodies[23].shape = (uint32_t)narc_count_shapes(f.scene.store);
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "23"));
}

/* Of two sets of bodies, either of which may have a shape that there is not. */
TEST(test_shapes_of_two_sets) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    AUTO(free_at) struct body *others = make_junk(BODIES * sizeof *others);
    memcpy(others, f.scene.bodies, BODIES * sizeof *others);
    const struct scene second = {.bodies = others, .body_count = BODIES, .precision = NARC_FLOAT32};
    const narc_bodies other_bodies = scene_bodies(&second);
    f.pairs.other_bodies = &other_bodies;
    for (size_t k = 0; k < PAIRS; k++)
        f.scene.pairs[k] = (struct pair){(uint32_t)(k % 20), (uint32_t)(k / 20)};
    f.scene.pairs[141] = (struct pair){22, 23};
    others[23].shape = 4711;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "23", "4711"));
    f.scene.bodies[22].shape = 4712;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "22", "4712"));
}

/* A selection that names a pair there is not, or a pair that names a body there is not. What is not asked of may be
 * wrong. */
TEST(test_selections) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    uint32_t selection[] = {150, 3, PAIRS, 7};
    f.call.query.selection = NARC_ARRAY(selection);
    f.call.query.selection_count = 4;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("selection", "200"));
    selection[2] = 10;
    f.scene.pairs[3].b = 4711;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("pair 3", "4711"));
    struct call range = f.call;
    range.query = (narc_query){.first = 64};
    selection[1] = 4;
    AUTO(free_at) struct outputs *out = make_junk(sizeof *out);
    for (size_t q = 0; q < question_count; q++) {
        narc_error error;
        if (questions[q].polygons)
            continue; /* there are others */
        expect_ok(run(&questions[q], &range, out, &error), &error);
        out->count = 4;
        expect_ok(run(&questions[q], &f.call, out, &error), &error);
        assert_int_equal(out->count, 4);
    }
    static const size_t too_many[] = {PAIRS + 1, UINT32_MAX, SIZE_MAX};
    for (size_t k = 0; k < sizeof too_many / sizeof *too_many; k++) {
        f.call.query.selection_count = too_many[k];
        check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("query.selection_count", "200 pairs"));
    }
}

/* No body at all, and no shape at all. */
TEST(test_empty_tables) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    AUTO(destroy_scene) struct scene empty = create_scene(NARC_FLOAT32, 0, 0, 0);
    struct call call = f.call;
    call.shapes = take_shapes(empty.store, NULL);
    check_batch(call, NARC_ERROR_INDEX, NAMES("pair 0"));
    f.bodies = (narc_bodies){0};
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("pair 0"));
    release_shapes(call.shapes);
}

TEST(test_too_many_pairs) {
#if SIZE_MAX > UINT32_MAX
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    /* With a stride of 0 there really are that many. */
    static const uint32_t first_body = 0;
    f.pairs = (narc_pairs){.count = (size_t)UINT32_MAX + 1, .a = {&first_body, 0}, .b = {&first_body, 0}};
    check_batch(f.call, NARC_ERROR_ARGUMENT, NULL, 0);
#endif
}

TEST(test_ranges) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    static const size_t bad_anywhere[][2] = {{PAIRS, 1},          {0, PAIRS + 1},       {192, 9}, {SIZE_MAX - 63, 64},
                                             {64, SIZE_MAX - 63}, {SIZE_MAX, SIZE_MAX}, {256, 0}};
    static const size_t bad_for_bits[][2] = {{1, 64}, {32, PAIRS - 32}, {0, 63}, {64, 65}, {63, 1}, {1, 0}};
    uint32_t selection[PAIRS];
    for (uint32_t k = 0; k < PAIRS; k++)
        selection[k] = k;
    for (int selected = 0; selected < 2; selected++) {
        for (size_t k = 0; k < sizeof(bad_anywhere) / sizeof(bad_anywhere[0]); k++) {
            f.call.query.first = bad_anywhere[k][0];
            f.call.query.count = bad_anywhere[k][1];
            check_batch(f.call, NARC_ERROR_ARGUMENT, NULL, 0);
        }
        for (size_t k = 0; k < sizeof(bad_for_bits) / sizeof(bad_for_bits[0]); k++) {
            f.call.query.first = bad_for_bits[k][0];
            f.call.query.count = bad_for_bits[k][1];
            for (size_t q = 0; q < question_count; q++)
                if (!questions[q].row_size)
                    check_call(&questions[q], f.call, NARC_ERROR_ARGUMENT, NULL, 0);
        }
        f.call.query.selection = NARC_ARRAY(selection);
        f.call.query.selection_count = PAIRS;
    }
}

TEST(test_outputs) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    AUTO(free_at) struct outputs *out = make_junk(sizeof *out);
    for (size_t q = 0; q < question_count; q++) {
        const struct question *question = &questions[q];
        struct asked asked = {f.call.shapes, &f.bodies, &f.pairs, NULL, NULL, 3, &out->count, out->outcomes};
        narc_error error;
        if (question->polygons)
            continue; /* there are others */
        expect_error(question->ask(question, &asked, &error), NARC_ERROR_ARGUMENT, &error,
                     question->row_size ? "out_rows" : "out_bits");
        asked.rows = out->rows;
        asked.out_count = NULL;
        if (question->row_size)
            expect_error(question->ask(question, &asked, &error), NARC_ERROR_ARGUMENT, &error, "out_count");
    }
    assert_true(is_junk(out, sizeof *out));
    float angle = 0, cosine = 7, sine = 7;
    assert_int_equal(narc_compute_poses(NULL, 1, &cosine, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, NULL, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, &cosine, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_true(cosine == 7 && sine == 7);
}

/* No pairs: nothing is needed, nothing is written. */
TEST(test_no_pairs) {
    AUTO(tear_down) struct fixture f;
    set_up(&f);
    AUTO(free_at) struct outputs *out = make_junk(sizeof *out);
    f.pairs = (narc_pairs){0};
    for (size_t k = 0; k < 6 * question_count; k++) {
        const struct question *question = &questions[k / 6];
        const narc_workers workers = openmp_workers((unsigned)(k % 3));
        f.call.query = (narc_query){.dense = k % 2, .workers = &workers};
        f.bodies.count = k % 6 < 3 ? 0 : BODIES;
        out->skipped = 12345;
        out->count = question->row_size ? 12345 : 0;
        assert_int_equal(run(question, &f.call, out, NULL), NARC_OK);
        assert_true(out->count == 0 && out->skipped == 0);
        memset(&out->count, GUARD_JUNK, 2 * sizeof out->count);
        assert_true(is_junk(out, sizeof *out));
    }
}

/* ------------------------------------------------------------------------------------------------ capacity */

/* What fits is the start of the list, the needed size is told, nothing behind the list is written; outcomes are
 * as with enough room. No list at all: the call counts. */
TEST(test_capacity) {
    enum { MANY = 3000 };
    struct test_random random = test_random_named("capacity");
    for (size_t q = 0; q < question_count; q++) {
        const struct question *question = &questions[q];
        if (!question->row_size)
            continue;
        AUTO(destroy_scene) struct scene scene = make_question_scene(&random, question, NARC_FLOAT32, 200, MANY);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        const void *shapes = take_shapes(scene.store, NULL);
        AUTO(free_at) uint8_t *outcomes = make_junk(MANY);
        AUTO(destroy_answer) struct answer all = ask_scene(question, &scene, (narc_query){0});
        const size_t fixed[] = {0, 1, 63, 64, 65, all.count - 1, all.count};
        assert_true(all.count > 100);
        for (size_t trial = 0; trial < 24; trial++) {
            const narc_workers workers = openmp_workers((unsigned)(trial % 4));
            const size_t capacity = trial < 7 ? fixed[trial] : random_below(&random, all.count);
            AUTO(guard_release_at) void *shorter = guard_allocate(answer_size(question, capacity));
            size_t skipped = 12345, needed;
            narc_query query = {.workers = &workers, .out_skipped = &skipped};
            query.row_stride = trial % 2 ? (ptrdiff_t)question->row_size : 0;
            const struct asked asked = {shapes,   &bodies, &pairs,  &query, trial ? shorter : NULL,
                                        capacity, &needed, outcomes};
            narc_error error = {0};
            const narc_status status = question->ask(question, &asked, &error);
            if (capacity < all.count)
                expect_error(status, NARC_ERROR_CAPACITY, &error, "rows");
            else
                expect_ok(status, &error);
            assert_int_equal(needed, all.count);
            assert_int_equal(skipped, 0);
            assert_memory_equal(shorter, all.rows, answer_size(question, capacity));
            assert_memory_equal(outcomes, all.outcomes, MANY);
        }
        release_shapes(shapes);
    }
}

/* ------------------------------------------------------------------------------------------------ contacts that stay */

TEST(test_contact_settings) {
    AUTO(narc_destroy_contacts_at) narc_contacts *contacts = NULL;
    narc_error error;
    const struct {
        narc_contacts_settings settings;
        const char *words;
    } cases[] = {
        {{.rows = 4}, "settings.rows is 4"},
        {{.row_offset = 4}, "settings.row_offset is 4, without NARC_ROWS_IN_USER"},
        {{.rows = NARC_ROWS_IN_USER}, "settings.user_size is 0: no room for rows of 64 bytes at 0"},
        {{.rows = NARC_ROWS_IN_USER, .user_size = 66}, "in multiples of 4"},
        {{.rows = NARC_ROWS_IN_USER, .user_size = 80, .row_offset = 2}, "at 2, in multiples of 4"},
        {{.rows = 3, .user_size = 40, .row_offset = 8}, "settings.user_size is 40: no room for rows of 36 bytes at 8"},
        {{.rows = 3, .user_size = 40, .row_offset = SIZE_MAX - 3}, "no room"},
        {{.rows = 3, .user_size = SIZE_MAX - 3}, "no room"},
        {{.allocator = &(const narc_allocator){NULL, NULL, NULL}}, "settings.allocator's function is NULL"},
        {{.reserved = {NULL, NULL, NULL, &contacts}}, "settings.reserved[3]"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        expect_error(narc_create_contacts(&cases[k].settings, &contacts, &error), NARC_ERROR_ARGUMENT, &error,
                     cases[k].words);
    expect_error(narc_create_contacts(NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_contacts is NULL");
    assert_null(contacts);
    const narc_contacts_settings tight = {.rows = 3, .user_size = 40, .row_offset = 4};
    expect_ok(narc_create_contacts(&tight, &contacts, &error), &error);
}

/* Five discs in a row, each touching the next; and contacts of them. */
struct row_of_discs {
    narc_shapes *store;
    narc_body body[5];
    narc_bodies bodies;
    narc_contacts *contacts;
    const narc_step_result *r;
};

static void set_up_discs(struct row_of_discs *d) {
    narc_error error;
    d->store = empty_store();
    store_shape(d->store, circle_of(0.5));
    for (size_t k = 0; k < 5; k++)
        d->body[k] = (narc_body){.x = 0.9 * (double)k, .cosine = 1, .scale = 1};
    narc_view_bodies(d->body, 5, &d->bodies);
    expect_ok(narc_create_contacts(&(narc_contacts_settings){.user_size = 4}, &d->contacts, &error), &error);
    const narc_step step = {.bodies = &d->bodies};
    expect_ok(narc_update_contacts(d->contacts, d->store, &step, &d->r, &error), &error);
    assert_int_equal(d->r->touching_count, 4);
}

/* After an error all is as it was, and goes on from there. */
static void tear_down_discs(struct row_of_discs *d) {
    const narc_step step = {.bodies = &d->bodies};
    narc_error error;
    assert_int_equal(d->r->began_count, 4);
    expect_ok(narc_update_contacts(d->contacts, d->store, &step, &d->r, &error), &error);
    assert_int_equal(d->r->touching_count, 4);
    assert_int_equal(d->r->began_count + d->r->ended_count, 0);
    narc_destroy_contacts(d->contacts);
    narc_destroy_shapes(d->store);
}

TEST(test_steps) {
    static const uint32_t a[] = {0, 1, 1, 4}, same[] = {3, 1}, far[] = {0, 5}, once[] = {1, 2, 2, 3}, turned[] = {1, 0};
    static const uint64_t ids[] = {9, 3, 2, 7, 3};
    static const float zero = 0;
    AUTO(tear_down_discs) struct row_of_discs d;
    set_up_discs(&d);
#define PAIRS_OF(...) (&(const narc_pairs){__VA_ARGS__})
    const struct {
        narc_step step;
        narc_status status;
        const char *words;
    } cases[] =
    { {{.skin = -1}, NARC_ERROR_ARGUMENT, "step.skin is -1, less than 0"},
      {{.skin = INFINITY}, NARC_ERROR_NOT_FINITE, "step.skin is inf"},
      {{.id = NARC_ARRAY(ids)}, NARC_ERROR_ARGUMENT, "body 4: id 3 is also that of a body before it"},
      {{.pairs = PAIRS_OF(.count = 2)}, NARC_ERROR_ARGUMENT, "step.pairs.a is NULL"},
      {{.pairs = PAIRS_OF(.count = 2, .a = NARC_ARRAY(a))}, NARC_ERROR_ARGUMENT, "step.pairs.b is NULL"},
      {{.pairs = PAIRS_OF(.other_bodies = &d.bodies)}, NARC_ERROR_ARGUMENT, "step.pairs with other_bodies"},
      {{.pairs = PAIRS_OF(.shift_x = {&zero, 0})}, NARC_ERROR_ARGUMENT, "step.pairs with shifts"},
      {{.pairs = PAIRS_OF(.shift_y = {&zero, 0})}, NARC_ERROR_ARGUMENT, "step.pairs with shifts"},
      {{.pairs = PAIRS_OF(.reserved = {&d})}, NARC_ERROR_ARGUMENT, "step.pairs.reserved[0]"},
      {{.pairs = PAIRS_OF(.count = 2, .a = NARC_ARRAY(a), .b = NARC_ARRAY(same))},
       NARC_ERROR_ARGUMENT,
       "pair 1: both are body 1"},
      {{.pairs = PAIRS_OF(.count = 2, .a = NARC_ARRAY(once), .b = NARC_ARRAY(far))},
       NARC_ERROR_INDEX,
       "pair 1: body 5, but there are 5 bodies"},
      {{.pairs = PAIRS_OF(.count = 3, .a = NARC_ARRAY(a), .b = NARC_ARRAY(once))},
       NARC_ERROR_ARGUMENT,
       "step.pairs has bodies 1 and 2 twice"},
      {{.pairs = PAIRS_OF(.count = 2, .a = NARC_ARRAY(a), .b = NARC_ARRAY(turned))},
       NARC_ERROR_ARGUMENT,
       "step.pairs has bodies 0 and 1 twice"},
#if SIZE_MAX > UINT32_MAX
      {{.pairs = PAIRS_OF(.count = UINT32_MAX, .a = {a, 0}, .b = {once, 0})}, NARC_ERROR_ARGUMENT, "4294967295 pairs"},
#endif
    };
    narc_error error;
    const narc_step_result *r = NULL;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        narc_step step = cases[k].step;
        step.bodies = &d.bodies;
        expect_error(narc_update_contacts(d.contacts, d.store, &step, &r, &error), cases[k].status, &error,
                     cases[k].words);
        assert_null(r);
    }
    expect_error(narc_update_contacts(d.contacts, d.store, &(narc_step){.bodies = &d.bodies}, NULL, &error),
                 NARC_ERROR_ARGUMENT, &error, "out_result is NULL");
}

/* The first step has memory for so many arrays alone: rows in the caller's bytes are nowhere yet. */
TEST(test_first_step_without_memory) {
    AUTO(tear_down_discs) struct row_of_discs d;
    set_up_discs(&d);
    for (size_t left = 0, failures = 1; failures > 0; left++) {
        struct ledger ledger = {0};
        const narc_allocator allocator = ledger_allocator(&ledger);
        const narc_contacts_settings settings = {
            .rows = NARC_ROWS_IN_USER, .user_size = 72, .row_offset = 8, .allocator = &allocator};
        const narc_step step = {.bodies = &d.bodies};
        narc_contacts *contacts;
        const narc_step_result *r = NULL;
        narc_error error;
        expect_ok(narc_create_contacts(&settings, &contacts, &error), &error);
        ledger.limited = true;
        ledger.left = left;
        for (failures = 0; narc_update_contacts(contacts, d.store, &step, &r, &error) != NARC_OK; failures++) {
            expect_error(error.status, NARC_ERROR_MEMORY, &error, "not enough memory");
            assert_null(r);
            ledger.limited = false;
        }
        assert_int_equal(r->touching_count, 4);
        narc_destroy_contacts(contacts);
        assert_int_equal(ledger.live, 0);
    }
}

TEST(test_slots_of_bodies) {
    AUTO(tear_down_discs) struct row_of_discs d;
    AUTO(narc_destroy_contacts_at) narc_contacts *none;
    const narc_step_result *r;
    const uint32_t *slots = NULL;
    size_t count = 7;
    narc_error error;
    set_up_discs(&d);
    expect_ok(narc_create_contacts(NULL, &none, &error), &error);
    expect_error(narc_find_body_slots(none, 0, &slots, &count, &error), NARC_ERROR_INDEX, &error,
                 "body 0, but the last step had 0 bodies");
    expect_error(narc_find_body_slots(d.contacts, 5, &slots, &count, &error), NARC_ERROR_INDEX, &error,
                 "body 5, but the last step had 5 bodies");
    expect_error(narc_find_body_slots(NULL, 0, &slots, &count, &error), NARC_ERROR_ARGUMENT, &error, "contacts");
    expect_error(narc_find_body_slots(none, 0, NULL, &count, &error), NARC_ERROR_ARGUMENT, &error, "out_slots");
    expect_error(narc_find_body_slots(none, 0, &slots, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_count");
    expect_error(narc_forget_bodies(NULL, NULL, 0, &error), NARC_ERROR_ARGUMENT, &error, "contacts is NULL");
    expect_error(narc_forget_bodies(d.contacts, NULL, 1, &error), NARC_ERROR_ARGUMENT, &error, "ids is NULL");
    expect_ok(narc_forget_bodies(d.contacts, NULL, 0, &error), &error);
    assert_true(!slots && count == 7);
    d.bodies.count = 1; /* which has no pair */
    expect_ok(narc_update_contacts(none, d.store, &(narc_step){.bodies = &d.bodies}, &r, &error), &error);
    expect_ok(narc_find_body_slots(none, 0, &slots, &count, &error), &error);
    assert_int_equal(count, 0);
    d.bodies.count = 5;
}

/* Bytes of which any one is another are refused, and so are those of other settings. */
TEST(test_saved_contacts) {
    AUTO(tear_down_discs) struct row_of_discs d;
    narc_contacts *other;
    const narc_step_result *r = NULL;
    narc_error error;
    set_up_discs(&d);
    const size_t size = narc_count_contact_bytes(d.contacts);
    char *const bytes = guard_allocate(size), *const junk = make_junk(size);
    assert_int_equal(narc_count_contact_bytes(NULL), 0);
    expect_error(narc_save_contacts(NULL, bytes, size, &error), NARC_ERROR_ARGUMENT, &error, "contacts is NULL");
    expect_error(narc_save_contacts(d.contacts, NULL, size, &error), NARC_ERROR_ARGUMENT, &error, "out_bytes is NULL");
    expect_error(narc_save_contacts(d.contacts, junk, size - 1, &error), NARC_ERROR_CAPACITY, &error, "there is room");
    assert_true(is_junk(junk, size));
    expect_ok(narc_save_contacts(d.contacts, bytes, size, &error), &error);
#define LOAD(contacts, store, from, count) narc_load_contacts(contacts, store, from, count, &r, &error)
    expect_error(LOAD(NULL, d.store, bytes, size), NARC_ERROR_ARGUMENT, &error, "contacts is NULL");
    expect_error(LOAD(d.contacts, NULL, bytes, size), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(LOAD(d.contacts, d.store, NULL, size), NARC_ERROR_ARGUMENT, &error, "bytes is NULL");
    for (size_t k = 0; k < size; k++) {
        bytes[k] = (char)(bytes[k] ^ 1 << k % 8);
        expect_error(LOAD(d.contacts, d.store, bytes, size), NARC_ERROR_FORMAT, &error, "not contacts that were saved");
        bytes[k] = (char)(bytes[k] ^ 1 << k % 8);
        expect_error(LOAD(d.contacts, d.store, bytes, k), NARC_ERROR_FORMAT, &error, "not contacts that were saved");
    }
    static const narc_contacts_settings others[] = {
        {.rows = NARC_CONTACT_ROWS, .user_size = 4}, {.user_size = 8}, {.rows = NARC_ROWS_IN_USER, .user_size = 64}};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        expect_ok(narc_create_contacts(&others[k], &other, &error), &error);
        expect_error(LOAD(other, d.store, bytes, size), NARC_ERROR_ARGUMENT, &error, "other settings");
        narc_destroy_contacts(other);
    }
    assert_null(r);
    expect_ok(LOAD(d.contacts, d.store, bytes, size), &error);
    assert_int_equal(r->began_count, 4);
    expect_ok(narc_load_contacts(d.contacts, d.store, bytes, size, NULL, NULL), &error);
    guard_release(bytes);
    free(junk);
}

TEST_MAIN("errors")
