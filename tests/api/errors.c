/* SPDX-License-Identifier: MIT
 *
 * errors.c - wrong arguments of the queries, by every method: each has its status and a message that names the culprit,
 * and no output is touched; bodies that are none, and lists that are too short.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "methods.h"

enum { PAIRS = 200, BODIES = 30, METHODS = 7 };

static bool has_contacts(narc_method method) { return method < NARC_METHOD_CIRCLE; }

/* Outputs of all calls. */
struct outputs {
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    uint32_t hints[PAIRS];
    uint8_t outcomes[PAIRS];
    narc_manifold rows[PAIRS]; /* of contacts, too */
    size_t count, skipped;
};

/* What a wrong call is made of, beside outputs: those of `query` and `options` are set for each call. */
struct call {
    const narc_shapes *shapes;
    const narc_methods *methods;
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    narc_method_options options;
    narc_query query;
};

/* The calls, bits: by a method they are BY times those. */
enum { OVERLAPS = 1, CONTACTS = 2, MANIFOLDS = 4, LISTS = CONTACTS | MANIFOLDS, PLAIN = OVERLAPS | LISTS, BY = 8 };
enum { BY_METHODS = BY * (OVERLAPS | CONTACTS), ALL = PLAIN | BY_METHODS };

static narc_status run(const struct call *call, int kind, struct outputs *out, narc_error *error) {
    void *rows = out->rows;
    switch (kind) {
    case OVERLAPS:
        return narc_find_overlaps(call->shapes, call->bodies, call->pairs, &call->query, out->bits, error);
    case CONTACTS:
        return narc_find_contacts(call->shapes, call->bodies, call->pairs, &call->query, rows, PAIRS, &out->count,
                                  error);
    case MANIFOLDS:
        return narc_find_manifolds(call->shapes, call->bodies, call->pairs, &call->query, rows, PAIRS, &out->count,
                                   error);
    case BY *OVERLAPS:
        return narc_find_overlaps_by(call->methods, call->bodies, call->pairs, &call->options, &call->query, out->bits,
                                     error);
    default:
        return narc_find_contacts_by(call->methods, call->bodies, call->pairs, &call->options, &call->query, rows,
                                     PAIRS, &out->count, error);
    }
}

static void check_error(narc_status status, narc_status expected, const narc_error *error, const char *const texts[],
                        size_t text_count) {
    for (size_t k = 0; k < text_count; k++)
        expect_error(status, expected, error, texts[k]);
    expect_error(status, expected, error, "");
}

/* The calls in `kinds`, with an error to fill and without, and some numbers of threads: always the same error, and
 * nothing is written. */
static void check_call(const struct call *wrong, int kinds, narc_status expected, const char *const texts[],
                       size_t text_count) {
    struct outputs *out = make_junk(sizeof *out);
    for (unsigned run_number = 0; run_number < 3; run_number++) {
        const narc_workers workers = narc_openmp_workers(run_number);
        struct call call = *wrong;
        call.query.hints = NARC_HINT_ARRAY(out->hints);
        call.query.workers = &workers;
        call.query.out_skipped = &out->skipped;
        call.options.out_outcomes = out->outcomes;
        for (int kind = 1; kind <= kinds; kind *= 2) {
            if (!(kinds & kind) || (kind == BY * CONTACTS && !has_contacts(call.options.method)))
                continue;
            narc_error error = {0};
            check_error(run(&call, kind, out, &error), expected, &error, texts, text_count);
            assert_int_equal(run(&call, kind, out, NULL), expected);
        }
    }
    assert_true(is_junk(out, sizeof *out));
    free(out);
}

/* What is wrong with a batch is so with every method. */
static void check_batch(struct call call, narc_status expected, const char *const texts[], size_t text_count) {
    check_call(&call, PLAIN, expected, texts, text_count);
    for (int method = 0; method < METHODS; method++) {
        call.options.method = (narc_method)method;
        check_call(&call, BY_METHODS, expected, texts, text_count);
    }
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
    f->call = (struct call){.shapes = f->scene.store,
                            .methods = scene_methods(&f->scene),
                            .bodies = &f->bodies,
                            .pairs = &f->pairs,
                            .query = {.margin = INFINITY}};
}

/* ------------------------------------------------------------------------------------------------ arguments */

TEST(test_options) {
    struct fixture f;
    set_up(&f);
    static const int bad_methods[] = {METHODS, 100, -1, INT32_MAX, INT32_MIN};
    for (size_t k = 0; k < sizeof bad_methods / sizeof *bad_methods; k++) {
        char number[16];
        snprintf(number, sizeof number, "%d", bad_methods[k]);
        f.call.options.method = (narc_method)bad_methods[k];
        check_call(&f.call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("method", number));
    }
    for (int method = 0; method < METHODS; method++) {
        f.call.options = (narc_method_options){.method = (narc_method)method, .tolerance = NAN};
        check_call(&f.call, BY_METHODS, NARC_ERROR_NOT_FINITE, NAMES("tolerance"));
        f.call.options.tolerance = INFINITY;
        check_call(&f.call, BY_METHODS, NARC_ERROR_NOT_FINITE, NAMES("tolerance", "inf"));
        f.call.options.tolerance = -INFINITY;
        check_call(&f.call, BY_METHODS, NARC_ERROR_NOT_FINITE, NAMES("tolerance", "-inf"));
        f.call.options.tolerance = -0.25f;
        check_call(&f.call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("tolerance", "-0.25"));
        f.call.options.tolerance = 0;
        f.call.options.reserved[3] = &f;
        check_call(&f.call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("reserved"));
    }
    destroy_scene(&f.scene);
}

TEST(test_queries) {
    struct fixture f;
    set_up(&f);
    static const struct {
        narc_query query;
        int kinds;
        narc_status status;
        const char *words;
    } cases[] = {
        {{.margin = NAN}, LISTS | BY * CONTACTS, NARC_ERROR_NOT_FINITE, "margin"},
        {{.second_margin = NAN}, MANIFOLDS, NARC_ERROR_NOT_FINITE, "second_margin"},
        {{.flat_angle = NAN}, MANIFOLDS, NARC_ERROR_NOT_FINITE, "flat_angle"},
        {{.flat_angle = 1.6f}, MANIFOLDS, NARC_ERROR_ARGUMENT, "flat_angle is 1.6"},
        {{.row_stride = 4}, LISTS | BY * CONTACTS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = sizeof(narc_contact) - 4}, LISTS | BY * CONTACTS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = sizeof(narc_manifold) - 4}, MANIFOLDS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = 66}, LISTS | BY * CONTACTS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = 129}, LISTS | BY * CONTACTS, NARC_ERROR_ARGUMENT, "row_stride"},
        {{.row_stride = -32}, LISTS | BY * CONTACTS, NARC_ERROR_ARGUMENT, "row_stride"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        f.call.query = cases[k].query;
        check_call(&f.call, cases[k].kinds, cases[k].status, &cases[k].words, 1);
    }
    f.call.query = (narc_query){.selection_count = 1};
    check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("selection is NULL"));
    for (size_t k = 0; k < sizeof f.call.query.reserved / sizeof *f.call.query.reserved; k++) {
        f.call.query = (narc_query){0};
        f.call.query.reserved[k] = &f;
        check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("reserved"));
    }
    destroy_scene(&f.scene);
}

TEST(test_null_arguments) {
    struct fixture f;
    set_up(&f);
    struct call call = f.call;
    call.shapes = NULL;
    check_call(&call, PLAIN, NARC_ERROR_ARGUMENT, NAMES("shapes"));
    call.methods = NULL;
    check_call(&call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("methods"));
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
    destroy_scene(&f.scene);
}

/* A pair that names a body there is not, whichever of those that are looked at at once, in plain arrays and in rows of
 * three; of two such pairs the first one is told. */
TEST(test_body_index) {
    static const uint32_t wrong[] = {BODIES, 99991, 0x80000000u, UINT32_MAX};
    uint32_t rows[PAIRS][3];
    for (size_t k = 0; k < 64; k++) {
        struct fixture f;
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
        destroy_scene(&f.scene);
    }
}

/* Several threads look; the first wrong pair of all is still the one that is told. */
TEST(test_first_wrong_pair) {
    struct test_random random = test_random_named("first wrong pair");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 9000);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    narc_contact *rows = make_junk(9000 * sizeof *rows);
    scene.pairs[8111].a = scene.pairs[4055].b = scene.pairs[4056].a = 5005;
    for (unsigned threads = 0; threads < 6; threads++) {
        const narc_workers workers = narc_openmp_workers(threads);
        size_t found;
        narc_error error = {0};
        const narc_status status = narc_find_contacts(scene.store, &bodies, &pairs, &(narc_query){.workers = &workers},
                                                      rows, 9000, &found, &error);
        check_error(status, NARC_ERROR_INDEX, &error, NAMES("4055", "5005"));
        assert_int_equal(error.index, 4055);
    }
    free(rows);
    destroy_scene(&scene);
}

TEST(test_shape_index) {
    struct fixture f;
    set_up(&f);
    for (size_t k = 0; k < PAIRS; k++)
        f.scene.pairs[k] = (struct pair){(uint32_t)(k % 20), (uint32_t)(k / 20)};
    f.scene.pairs[141].b = 23;
    f.scene.bodies[23].shape = 4711;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "23", "4711"));
    f.scene.bodies[23].shape = (uint32_t)narc_count_shapes(f.scene.store);
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("141", "23"));
    destroy_scene(&f.scene);
}

/* Of two sets of bodies, either of which may have a shape that there is not. */
TEST(test_shapes_of_two_sets) {
    struct fixture f;
    set_up(&f);
    struct body *others = make_junk(BODIES * sizeof *others);
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
    free(others);
    destroy_scene(&f.scene);
}

/* A selection that names a pair there is not, or a pair that names a body there is not. What is not asked of may be
 * wrong. */
TEST(test_selections) {
    struct fixture f;
    set_up(&f);
    uint32_t selection[] = {150, 3, PAIRS, 7};
    f.call.query.selection = (narc_index_column){selection, sizeof *selection};
    f.call.query.selection_count = 4;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("selection", "200"));
    selection[2] = 10;
    f.scene.pairs[3].b = 4711;
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("pair 3", "4711"));
    struct outputs *out = make_junk(sizeof *out);
    narc_error error;
    selection[1] = 4;
    expect_ok(run(&f.call, OVERLAPS, out, &error), &error);
    expect_ok(run(&f.call, CONTACTS, out, &error), &error);
    assert_int_equal(out->count, 4);
    static const size_t too_many[] = {PAIRS + 1, UINT32_MAX, SIZE_MAX};
    for (size_t k = 0; k < sizeof too_many / sizeof *too_many; k++) {
        f.call.query.selection_count = too_many[k];
        check_batch(f.call, NARC_ERROR_ARGUMENT, NAMES("query.selection_count", "200 pairs"));
    }
    f.call.query.selection = (narc_index_column){0};
    f.call.query.selection_count = 0;
    f.call.query.first = 64;
    expect_ok(run(&f.call, OVERLAPS, out, &error), &error);
    free(out);
    destroy_scene(&f.scene);
}

/* No body at all, and no shape at all. */
TEST(test_empty_tables) {
    struct fixture f;
    set_up(&f);
    const struct scene empty = create_scene(NARC_FLOAT32, 0, 0, 0);
    struct call call = f.call;
    call.shapes = empty.store;
    call.methods = scene_methods(&empty);
    check_batch(call, NARC_ERROR_INDEX, NAMES("pair 0"));
    f.bodies = (narc_bodies){0};
    check_batch(f.call, NARC_ERROR_INDEX, NAMES("pair 0"));
    struct scene done = empty;
    destroy_scene(&done);
    destroy_scene(&f.scene);
}

TEST(test_too_many_pairs) {
#if SIZE_MAX > UINT32_MAX
    struct fixture f;
    set_up(&f);
    /* With a stride of 0 there really are that many. */
    static const uint32_t first_body = 0;
    f.pairs = (narc_pairs){.count = (size_t)UINT32_MAX + 1, .a = {&first_body, 0}, .b = {&first_body, 0}};
    check_batch(f.call, NARC_ERROR_ARGUMENT, NULL, 0);
    destroy_scene(&f.scene);
#endif
}

TEST(test_ranges) {
    struct fixture f;
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
            check_call(&f.call, OVERLAPS | BY * OVERLAPS, NARC_ERROR_ARGUMENT, NULL, 0);
        }
        f.call.query.selection = (narc_index_column){selection, sizeof *selection};
        f.call.query.selection_count = PAIRS;
    }
    destroy_scene(&f.scene);
}

TEST(test_outputs) {
    struct fixture f;
    set_up(&f);
    const narc_shapes *store = f.scene.store;
    narc_contact rows[3];
    narc_manifold points[3];
    uint8_t outcomes[PAIRS];
    size_t count;
    narc_error error;
    memset(rows, 0xa5, sizeof rows);
    memset(points, 0xa5, sizeof points);
    memset(outcomes, 0xa5, sizeof outcomes);
    memset(&count, 0xa5, sizeof count);
#define EXPECT(call, word) expect_error(call, NARC_ERROR_ARGUMENT, &error, word)
    EXPECT(narc_find_overlaps(store, &f.bodies, &f.pairs, NULL, NULL, &error), "out_bits");
    EXPECT(narc_find_contacts(store, &f.bodies, &f.pairs, NULL, NULL, 3, &count, &error), "out_rows");
    EXPECT(narc_find_contacts(store, &f.bodies, &f.pairs, NULL, rows, 3, NULL, &error), "out_count");
    EXPECT(narc_find_manifolds(store, &f.bodies, &f.pairs, NULL, NULL, 3, &count, &error), "out_rows");
    EXPECT(narc_find_manifolds(store, &f.bodies, &f.pairs, NULL, points, 3, NULL, &error), "out_count");
    for (int method = 0; method < METHODS; method++) {
        if (method == NARC_METHOD_POLYGON_SAT)
            continue; /* not of these shapes */
        const narc_method_options o = {.method = (narc_method)method, .out_outcomes = outcomes};
        const narc_methods *methods = f.call.methods;
        const char *name = narc_method_name(o.method);
        EXPECT(narc_find_overlaps_by(methods, &f.bodies, &f.pairs, &o, NULL, NULL, &error), "out_bits");
        EXPECT(narc_find_contacts_by(methods, &f.bodies, &f.pairs, &o, NULL, NULL, 3, &count, &error),
               has_contacts(o.method) ? "out_rows" : name);
        EXPECT(narc_find_contacts_by(methods, &f.bodies, &f.pairs, &o, NULL, rows, 3, NULL, &error),
               has_contacts(o.method) ? "out_count" : name);
    }
#undef EXPECT
    float angle = 0, cosine = 7, sine = 7;
    assert_int_equal(narc_compute_poses(NULL, 1, &cosine, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, NULL, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, &cosine, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_true(cosine == 7 && sine == 7);
    assert_true(is_junk(rows, sizeof rows) && is_junk(points, sizeof points) && is_junk(&count, sizeof count));
    assert_true(is_junk(outcomes, sizeof outcomes));
    destroy_scene(&f.scene);
}

/* The first pair whose shape is not a polygon is the one that is told, and the shape and the body. */
TEST(test_not_a_polygon) {
    struct scene scene = create_scene(NARC_FLOAT32, 2, 40, PAIRS);
    const struct shape box = box_of(1, 1, 0), round = box_of(1, 1, 0.1);
    scene_add_shape(&scene, &box);
    scene_add_shape(&scene, &round);
    for (uint32_t k = 0; k < 40; k++) {
        struct body body = turned_body(0.1 * k, 1);
        body.shape = k == 23 || k == 31;
        scene_add_body(&scene, body);
    }
    for (uint32_t k = 0; k < PAIRS; k++)
        scene_add_pair(&scene, k % 20, (k + 1) % 20);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    const struct call call = {.methods = scene_methods(&scene),
                              .bodies = &bodies,
                              .pairs = &pairs,
                              .options = {.method = NARC_METHOD_POLYGON_SAT}};
    free(query_overlaps(&scene, &call.options, NULL));
    scene.pairs[171].a = 31;
    check_call(&call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("pair 171", "shape 1", "body 31"));
    scene.pairs[66].b = 23;
    check_call(&call, BY_METHODS, NARC_ERROR_ARGUMENT, NAMES("pair 66", "shape 1", "body 23"));
    destroy_scene(&scene);
}

/* No pairs: nothing is needed, nothing is written. */
TEST(test_no_pairs) {
    struct fixture f;
    set_up(&f);
    struct outputs *out = make_junk(sizeof *out);
    f.pairs.count = 0;
    f.call.query.hints = NARC_HINT_ARRAY(out->hints);
    f.call.options.out_outcomes = out->outcomes;
    for (int method = 0; method < METHODS; method++) {
        f.call.options.method = (narc_method)method;
        for (int kind = 1; kind <= ALL; kind *= 2) {
            if (!(ALL & kind) || (kind == BY * CONTACTS && !has_contacts(f.call.options.method)))
                continue;
            out->count = 12345;
            assert_int_equal(run(&f.call, kind, out, NULL), NARC_OK);
            if (kind & (LISTS | BY * CONTACTS))
                assert_int_equal(out->count, 0);
            memset(&out->count, 0xa5, sizeof out->count);
            assert_true(is_junk(out, sizeof *out));
        }
    }
    free(out);
    destroy_scene(&f.scene);
}

TEST(test_names) {
    static const char *const names[METHODS] = {"sat", "sat-first", "polygon-sat", "gjk", "circle", "aabb", "obb"};
    for (int method = 0; method < METHODS; method++)
        assert_string_equal(narc_method_name((narc_method)method), names[method]);
    assert_null(narc_method_name((narc_method)METHODS));
    assert_null(narc_method_name((narc_method)-1));
}

/* ------------------------------------------------------------------------------------------------ capacity */

/* What fits is the start of the list; hints and outcomes are as with enough room. */
TEST(test_capacity) {
    enum { MANY = 3000 };
    struct test_random random = test_random_named("method capacity");
    static const narc_method methods[] = {NARC_METHOD_SAT, NARC_METHOD_SAT_FIRST, NARC_METHOD_GJK};
    for (int m = 0; m < 3; m++) {
        struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, MANY);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        uint32_t *hints = create_hints(MANY), *enough_hints = create_hints(MANY);
        uint8_t *outcomes = create_outcomes(MANY), *enough_outcomes = create_outcomes(MANY);
        const narc_method_options enough = {.method = methods[m], .out_outcomes = enough_outcomes};
        const narc_method_options options = {.method = methods[m], .out_outcomes = outcomes};
        struct contacts all = query_contacts(&scene, &enough, &(narc_query){.hints = NARC_HINT_ARRAY(enough_hints)});
        assert_true(all.count > 100);
        for (unsigned threads = 1; threads <= 2; threads++) {
            const narc_workers workers = narc_openmp_workers(threads);
            const size_t capacity = all.count - 1 - random_below(&random, all.count - 1);
            narc_contact *shorter = guard_allocate(capacity * sizeof *shorter);
            size_t skipped = 12345, needed;
            const narc_query query = {.hints = NARC_HINT_ARRAY(hints), .workers = &workers, .out_skipped = &skipped};
            narc_error error;
            memset(hints, 0, MANY * sizeof *hints);
            expect_error(narc_find_contacts_by(scene_methods(&scene), &bodies, &pairs, &options, &query, shorter,
                                               capacity, &needed, &error),
                         NARC_ERROR_CAPACITY, &error, "rows");
            assert_int_equal(needed, all.count);
            assert_int_equal(skipped, 0);
            assert_memory_equal(shorter, all.rows, capacity * sizeof *shorter);
            assert_memory_equal(hints, enough_hints, MANY * sizeof *hints);
            assert_memory_equal(outcomes, enough_outcomes, MANY);
            guard_release(shorter);
        }
        free(hints);
        free(enough_hints);
        free(outcomes);
        free(enough_outcomes);
        free(all.rows);
        destroy_scene(&scene);
    }
}

/* --------------------------------------------------------------------------------------------- bodies that are none */

/* All pairs of two squares in one place, one of them with a quantity spoilt. */
static struct scene make_spoilt_scene(void) {
    static const float spoilt[] = {NAN, INFINITY, -INFINITY};
    struct scene scene = create_scene(NARC_FLOAT32, 1, 64, 64);
    const struct shape box = box_of(1, 1, 0);
    scene_add_shape(&scene, &box);
    const uint32_t good = scene_add_body(&scene, turned_body(0.5, 1));
    for (int k = 0; k < 19; k++) {
        const uint32_t bad = scene_add_body(&scene, turned_body(0.5, 1));
        struct body *body = &scene.bodies[bad];
        float *const values[] = {&body->x_single, &body->y_single, &body->cosine, &body->sine, &body->scale};
        if (k < 15)
            *values[k / 3] = spoilt[k % 3];
        else if (k == 15)
            body->scale = 0;
        else if (k == 16)
            body->scale = -1;
        else if (k == 17)
            body->cosine = body->sine = 0;
        else
            body->cosine *= 1.01f;
        scene_add_pair(&scene, good, bad);
        scene_add_pair(&scene, bad, good);
    }
    return scene;
}

TEST(test_invalid_bodies) {
    struct scene scene = make_spoilt_scene();
    const size_t count = scene.pair_count;
    for (int method = 0; method < METHODS; method++) {
        uint8_t *outcomes = create_outcomes(count);
        uint32_t *hints = create_hints(count);
        size_t skipped = 0;
        const narc_method_options options = {.method = (narc_method)method, .out_outcomes = outcomes};
        narc_query query = {.hints = NARC_HINT_ARRAY(hints), .out_skipped = &skipped};
        uint64_t *bits = query_overlaps(&scene, &options, &query);
        assert_true(bits[0] == 0);
        assert_int_equal(skipped, count);
        for (int margin = 0; margin < 2 && has_contacts(options.method); margin++) {
            query.margin = margin ? INFINITY : 1e30f;
            struct contacts found = query_contacts(&scene, &options, &query);
            assert_int_equal(found.count, margin ? count : 0);
            assert_int_equal(skipped, count);
            for (size_t k = 0; k < found.count; k++) {
                const narc_contact none = {.pair = (uint32_t)k, .separation = INFINITY};
                assert_int_equal(outcomes[k], NARC_OUTCOME_DONE);
                assert_memory_equal(&found.rows[k], &none, sizeof none);
            }
            free(found.rows);
        }
        free(bits);
        free(outcomes);
        free(hints);
    }
    destroy_scene(&scene);
}

TEST_MAIN("errors")
