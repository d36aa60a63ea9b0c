/* SPDX-License-Identifier: MIT
 *
 * errors.c - wrong arguments of the queries, by every method: each has its status and a message that names the culprit,
 * and no output is touched; bodies that are none, and lists that are too short.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "methods.h"

enum { PAIRS = 200, BODIES = 30, METHODS = 7 };

static struct scene make_scene(void) {
    struct test_random random = test_random_named("errors");
    return make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
}

static bool has_contacts(narc_method method) { return method < NARC_METHOD_CIRCLE; }

/* Outputs of all calls, and what they held. */
struct outputs {
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    uint32_t hints[PAIRS];
    uint8_t outcomes[PAIRS];
    size_t skipped;
    struct contacts contacts, fresh;
    narc_error error;
};

static struct outputs create_outputs(void) {
    struct outputs out = {.contacts = create_contacts(PAIRS), .fresh = create_contacts(PAIRS)};
    memset(out.bits, 0xa5, sizeof out.bits);
    memset(out.hints, 0xa5, sizeof out.hints);
    memset(out.outcomes, 0xa5, sizeof out.outcomes);
    memset(&out.skipped, 0xa5, sizeof out.skipped);
    out.contacts.count = 12345;
    return out;
}

static void check_junk(const void *memory, size_t size) {
    const unsigned char *bytes = memory;
    for (size_t k = 0; k < size; k++)
        assert_int_equal(bytes[k], 0xa5);
}

static void destroy_untouched(struct outputs *out) {
    const narc_contacts *c = &out->contacts.view, *f = &out->fresh.view;
    check_junk(out->bits, sizeof out->bits);
    check_junk(out->hints, sizeof out->hints);
    check_junk(out->outcomes, sizeof out->outcomes);
    check_junk(&out->skipped, sizeof out->skipped);
    assert_int_equal(out->contacts.count, 12345);
    assert_memory_equal(c->pair, f->pair, PAIRS * sizeof(uint32_t));
    assert_memory_equal(c->separation, f->separation, PAIRS * sizeof(float));
    assert_memory_equal(c->normal_x, f->normal_x, PAIRS * sizeof(float));
    assert_memory_equal(c->normal_y, f->normal_y, PAIRS * sizeof(float));
    assert_memory_equal(c->point_x, f->point_x, PAIRS * sizeof(float));
    assert_memory_equal(c->point_y, f->point_y, PAIRS * sizeof(float));
    assert_memory_equal(c->arc_a, f->arc_a, PAIRS);
    assert_memory_equal(c->arc_b, f->arc_b, PAIRS);
    destroy_contacts(&out->contacts);
    destroy_contacts(&out->fresh);
}

/* What a wrong call is made of. */
struct call {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    bool no_query;
    narc_method_query query; /* hints and outcomes are wanted always */
    float margin;
    bool contacts_only;
};

static void check_error(const struct outputs *out, narc_status status, narc_status expected, const char *const texts[],
                        size_t text_count) {
    if (status != expected || out->error.status != expected) {
        fail_msg("%s (%s), not %s: '%s'", narc_status_name(status), narc_status_name(out->error.status),
                 narc_status_name(expected), out->error.message);
    }
    for (size_t k = 0; k < text_count; k++)
        if (!strstr(out->error.message, texts[k]))
            fail_msg("'%s' does not name '%s'", out->error.message, texts[k]);
}

/* The calls of narc.h, with an error to fill and without. */
static void check_plain_calls(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                              unsigned threads, narc_status expected, const char *const texts[], size_t text_count) {
    struct outputs out = create_outputs();
    const size_t count = pairs && pairs->count <= PAIRS ? pairs->count : 64;
    for (int call = 0; call < 8; call++) {
        narc_error *error = call < 4 ? &out.error : NULL;
        narc_status status;
        if (error)
            memset(error, 0, sizeof *error);
        switch (call % 4) {
        case 0:
            status = narc_find_overlaps(shapes, bodies, pairs, threads, out.bits, error);
            break;
        case 1:
            status = narc_find_overlaps_range(shapes, bodies, pairs, 0, count, out.bits, error);
            break;
        case 2:
            status = narc_find_contacts(shapes, bodies, pairs, INFINITY, threads, &out.contacts.view,
                                        &out.contacts.count, error);
            break;
        default:
            status = narc_find_contacts_range(shapes, bodies, pairs, 0, count, INFINITY, &out.contacts.view,
                                              &out.contacts.count, error);
        }
        check_error(&out, status, expected, texts, text_count);
    }
    destroy_untouched(&out);
}

/* Both calls, with an error to fill and without, and some numbers of threads. */
static void check_call(const struct call *call, narc_status expected, const char *const texts[], size_t text_count) {
    for (unsigned threads = 0; threads < 3; threads++) {
        struct outputs out = create_outputs();
        narc_method_query query = call->query;
        query.hints = out.hints;
        query.out_outcomes = out.outcomes;
        query.out_skipped = &out.skipped;
        const narc_method_query *passed = call->no_query ? NULL : &query;
        for (int silent = 0; silent < 2 && !call->contacts_only; silent++) {
            const narc_status status = overlaps_by_method(call->shapes, call->bodies, call->pairs, passed, threads,
                                                          out.bits, silent ? NULL : &out.error);
            check_error(&out, status, expected, texts, text_count);
        }
        memset(&out.error, 0, sizeof out.error);
        for (int silent = 0; silent < 2 && (has_contacts(query.method) || call->contacts_only); silent++) {
            const narc_status status =
                contacts_by_method(call->shapes, call->bodies, call->pairs, passed, call->margin, threads,
                                   &out.contacts.view, &out.contacts.count, silent ? NULL : &out.error);
            check_error(&out, status, expected, texts, text_count);
        }
        destroy_untouched(&out);
    }
}

/* What is wrong with a batch is so with every method. */
static void check_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                        narc_status expected, const char *const texts[], size_t text_count) {
    for (int method = 0; method < METHODS; method++) {
        const struct call call = {
            .shapes = shapes, .bodies = bodies, .pairs = pairs, .query = {.method = (narc_method)method}};
        check_call(&call, expected, texts, text_count);
    }
    for (unsigned threads = 0; threads < 6; threads++)
        check_plain_calls(shapes, bodies, pairs, threads, expected, texts, text_count);
}

#define NAMES(...) (const char *const[]){__VA_ARGS__}, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)

/* ------------------------------------------------------------------------------------------------ arguments */

static void test_queries(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct call call = {.shapes = scene.store, .bodies = &bodies, .pairs = &pairs, .no_query = true};
    check_call(&call, NARC_ERROR_ARGUMENT, NAMES("query"));
    call.no_query = false;
    static const int bad_methods[] = {METHODS, 100, -1, INT32_MAX, INT32_MIN};
    for (size_t k = 0; k < sizeof bad_methods / sizeof *bad_methods; k++) {
        char number[16];
        snprintf(number, sizeof number, "%d", bad_methods[k]);
        call.query.method = (narc_method)bad_methods[k];
        call.contacts_only = false;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("method", number));
        call.contacts_only = true;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("method", number));
    }
    call.contacts_only = false;
    for (int method = 0; method < METHODS; method++) {
        call.query = (narc_method_query){.method = (narc_method)method, .tolerance = NAN};
        check_call(&call, NARC_ERROR_NOT_FINITE, NAMES("tolerance"));
        call.query.tolerance = INFINITY;
        check_call(&call, NARC_ERROR_NOT_FINITE, NAMES("tolerance", "inf"));
        call.query.tolerance = -INFINITY;
        check_call(&call, NARC_ERROR_NOT_FINITE, NAMES("tolerance", "-inf"));
        call.query.tolerance = -0.25f;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("tolerance", "-0.25"));
    }
    destroy_scene(&scene);
}

static void test_null_arguments(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    check_batch(NULL, &bodies, &pairs, NARC_ERROR_ARGUMENT, NAMES("shapes"));
    check_batch(scene.store, NULL, &pairs, NARC_ERROR_ARGUMENT, NAMES("bodies"));
    check_batch(scene.store, &bodies, NULL, NARC_ERROR_ARGUMENT, NAMES("pairs"));
    for (int k = 0; k < 7; k++) {
        static const char *const names[] = {"x", "y", "cosine", "sine", "shape", "a", "b"};
        narc_bodies b = bodies;
        narc_pairs p = pairs;
        switch (k) {
        case 0:
            b.x.base = NULL;
            break;
        case 1:
            b.y.base = NULL;
            break;
        case 2:
            b.cosine.base = NULL;
            break;
        case 3:
            b.sine.base = NULL;
            break;
        case 4:
            b.shape.base = NULL;
            break;
        case 5:
            p.a.base = NULL;
            break;
        default:
            p.b.base = NULL;
            break;
        }
        check_batch(scene.store, &b, &p, NARC_ERROR_ARGUMENT, &names[k], 1);
    }
    narc_bodies b = bodies;
    b.x.precision = b.y.precision = (narc_precision)7;
    check_batch(scene.store, &b, &pairs, NARC_ERROR_ARGUMENT, NAMES("x.precision is 7"));
    b.x.precision = NARC_FLOAT32;
    b.y.precision = NARC_FLOAT64;
    check_batch(scene.store, &b, &pairs, NARC_ERROR_ARGUMENT, NAMES("y.precision is 1"));
    destroy_scene(&scene);
}

/* A pair that names a body there is not; the first such pair is the one that is told. */
static void test_body_index(void **state) {
    (void)state;
    static const uint32_t wrong[] = {BODIES, 99991, 0x80000000u, UINT32_MAX};
    for (int k = 0; k < 8; k++) {
        struct scene scene = make_scene();
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        *(k % 2 ? &scene.pairs[137].a : &scene.pairs[137].b) = wrong[k / 2];
        scene.pairs[188].a = 77777;
        char body[16];
        snprintf(body, sizeof(body), "%lu", (unsigned long)wrong[k / 2]);
        check_batch(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, NAMES("137", body));
        destroy_scene(&scene);
    }
}

/* Several threads look; the first wrong pair of all is still the one that is told. */
static void test_first_wrong_pair(void **state) {
    (void)state;
    struct test_random random = test_random_named("first wrong pair");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 9000);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts contacts = create_contacts(9000);
    scene.pairs[8111].a = scene.pairs[4055].b = scene.pairs[4056].a = 5005;
    for (unsigned threads = 0; threads < 6; threads++) {
        narc_error error = {0};
        assert_int_equal(
            narc_find_contacts(scene.store, &bodies, &pairs, 0, threads, &contacts.view, &contacts.count, &error),
            NARC_ERROR_INDEX);
        assert_non_null(strstr(error.message, "4055"));
        assert_non_null(strstr(error.message, "5005"));
    }
    destroy_contacts(&contacts);
    destroy_scene(&scene);
}

static void test_shape_index(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    for (size_t k = 0; k < PAIRS; k++)
        scene.pairs[k] = (struct pair){(uint32_t)(k % 20), (uint32_t)(k / 20)};
    scene.pairs[141].b = 23;
    scene.bodies[23].shape = 4711;
    check_batch(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, NAMES("141", "23", "4711"));
    scene.bodies[23].shape = (uint32_t)narc_count_shapes(scene.store);
    check_batch(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, NAMES("141", "23"));
    destroy_scene(&scene);
}

/* No body at all, and no shape at all. */
static void test_empty_tables(void **state) {
    (void)state;
    struct scene scene = make_scene();
    narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    narc_shapes *empty;
    assert_int_equal(narc_create_shapes(NULL, &empty), NARC_OK);
    check_batch(empty, &bodies, &pairs, NARC_ERROR_INDEX, NAMES("pair 0"));
    bodies = (narc_bodies){0};
    check_batch(scene.store, &bodies, &pairs, NARC_ERROR_INDEX, NAMES("pair 0"));
    narc_destroy_shapes(empty);
    destroy_scene(&scene);
}

static void test_too_many_pairs(void **state) {
    (void)state;
#if SIZE_MAX > UINT32_MAX
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    /* With a stride of 0 there really are that many. */
    static const uint32_t first_body = 0;
    const narc_pairs pairs = {.count = (size_t)UINT32_MAX + 1, .a = {&first_body, 0}, .b = {&first_body, 0}};
    check_batch(scene.store, &bodies, &pairs, NARC_ERROR_ARGUMENT, NULL, 0);
    destroy_scene(&scene);
#endif
}

static void test_ranges(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    static const size_t bad_anywhere[][2] = {{PAIRS, 1},          {0, PAIRS + 1},       {192, 9}, {SIZE_MAX - 63, 64},
                                             {64, SIZE_MAX - 63}, {SIZE_MAX, SIZE_MAX}, {256, 0}};
    static const size_t bad_for_bits[][2] = {{1, 64}, {32, PAIRS - 32}, {0, 63}, {64, 65}, {63, 1}};
    struct outputs out = create_outputs();
    for (size_t k = 0; k < sizeof(bad_anywhere) / sizeof(bad_anywhere[0]); k++) {
        size_t first = bad_anywhere[k][0], count = bad_anywhere[k][1];
        assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, first, count, out.bits, &out.error),
                         NARC_ERROR_ARGUMENT);
        assert_int_equal(narc_find_contacts_range(scene.store, &bodies, &pairs, first, count, 0, &out.contacts.view,
                                                  &out.contacts.count, &out.error),
                         NARC_ERROR_ARGUMENT);
    }
    for (size_t k = 0; k < sizeof(bad_for_bits) / sizeof(bad_for_bits[0]); k++) {
        size_t first = bad_for_bits[k][0], count = bad_for_bits[k][1];
        assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, first, count, out.bits, &out.error),
                         NARC_ERROR_ARGUMENT);
    }
    destroy_untouched(&out);
    destroy_scene(&scene);
}

static void test_outputs(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    for (int method = 0; method < METHODS; method++) {
        if (method == NARC_METHOD_POLYGON_SAT)
            continue; /* not of these shapes */
        struct outputs out = create_outputs();
        const narc_method_query query = {
            .method = (narc_method)method, .hints = out.hints, .out_outcomes = out.outcomes};
        check_error(&out, overlaps_by_method(scene.store, &bodies, &pairs, &query, 1, NULL, &out.error),
                    NARC_ERROR_ARGUMENT, NAMES("out_bits"));
        if (has_contacts(query.method)) {
            check_error(
                &out,
                contacts_by_method(scene.store, &bodies, &pairs, &query, 0, 1, NULL, &out.contacts.count, &out.error),
                NARC_ERROR_ARGUMENT, NAMES("out_contacts"));
            check_error(
                &out,
                contacts_by_method(scene.store, &bodies, &pairs, &query, 0, 1, &out.contacts.view, NULL, &out.error),
                NARC_ERROR_ARGUMENT, NAMES("out_count"));
            check_error(&out,
                        contacts_by_method(scene.store, &bodies, &pairs, &query, NAN, 1, &out.contacts.view,
                                           &out.contacts.count, &out.error),
                        NARC_ERROR_NOT_FINITE, NAMES("margin"));
        } else {
            check_error(&out,
                        contacts_by_method(scene.store, &bodies, &pairs, &query, 0, 1, &out.contacts.view,
                                           &out.contacts.count, &out.error),
                        NARC_ERROR_ARGUMENT, NAMES(narc_method_name(query.method)));
        }
        destroy_untouched(&out);
    }
    destroy_scene(&scene);
}

/* The calls that have no query. */
static void test_plain_outputs(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts contacts = create_contacts(PAIRS);
    size_t count = 12345;
    assert_int_equal(narc_find_overlaps(scene.store, &bodies, &pairs, 1, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, 0, 64, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 1, NULL, &count, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(count, 12345);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 1, &contacts.view, NULL, NULL),
                     NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, NAN, 1, &contacts.view, &count, NULL),
                     NARC_ERROR_NOT_FINITE);
    assert_int_equal(narc_find_contacts_range(scene.store, &bodies, &pairs, 0, 10, NAN, &contacts.view, &count, NULL),
                     NARC_ERROR_NOT_FINITE);
    assert_int_equal(count, 12345);
    float angle = 0, cosine = 7, sine = 7;
    assert_int_equal(narc_compute_poses(NULL, 1, &cosine, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, NULL, &sine, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_compute_poses(&angle, 1, &cosine, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_true(cosine == 7 && sine == 7);
    destroy_contacts(&contacts);
    destroy_scene(&scene);
}

/* The first pair whose shape is not a polygon is the one that is told, and the shape and the body. */
static void test_not_a_polygon(void **state) {
    (void)state;
    struct scene scene = create_scene(NARC_FLOAT32, 2, 40, PAIRS);
    struct shape box, round;
    assert_int_equal(narc_build_box(1, 1, 0, box.arcs, &box.count, NULL), NARC_OK);
    assert_int_equal(narc_build_box(1, 1, 0.1, round.arcs, &round.count, NULL), NARC_OK);
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
    const struct call call = {
        .shapes = scene.store, .bodies = &bodies, .pairs = &pairs, .query = {.method = NARC_METHOD_POLYGON_SAT}};
    free(query_overlaps(&scene, &call.query, 1));
    scene.pairs[171].a = 31;
    check_call(&call, NARC_ERROR_ARGUMENT, NAMES("pair 171", "shape 1", "body 31"));
    scene.pairs[66].b = 23;
    check_call(&call, NARC_ERROR_ARGUMENT, NAMES("pair 66", "shape 1", "body 23"));
    destroy_scene(&scene);
}

/* No pairs: nothing is needed, nothing is written. */
static void test_no_pairs(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    pairs.count = 0;
    for (int method = 0; method < METHODS; method++) {
        struct outputs out = create_outputs();
        const narc_method_query query = {
            .method = (narc_method)method, .hints = out.hints, .out_outcomes = out.outcomes};
        assert_int_equal(overlaps_by_method(scene.store, &bodies, &pairs, &query, 0, NULL, NULL), NARC_OK);
        assert_int_equal(overlaps_by_method(scene.store, &bodies, &pairs, &query, 2, out.bits, NULL), NARC_OK);
        if (has_contacts(query.method)) {
            assert_int_equal(contacts_by_method(scene.store, &bodies, &pairs, &query, 0, 2, &out.contacts.view,
                                                &out.contacts.count, NULL),
                             NARC_OK);
            assert_int_equal(out.contacts.count, 0);
            out.contacts.count = 12345;
        }
        destroy_untouched(&out);
    }
    destroy_scene(&scene);
}

static void test_names(void **state) {
    (void)state;
    static const char *const names[METHODS] = {"sat", "sat-first", "polygon-sat", "gjk", "circle", "aabb", "obb"};
    for (int method = 0; method < METHODS; method++)
        assert_string_equal(narc_method_name((narc_method)method), names[method]);
    assert_null(narc_method_name((narc_method)METHODS));
    assert_null(narc_method_name((narc_method)-1));
}

/* ------------------------------------------------------------------------------------------------ capacity */

/* What fits is the start of the list; hints and outcomes are as with enough room. */
static void test_capacity(void **state) {
    (void)state;
    enum { MANY = 3000 };
    struct test_random random = test_random_named("method capacity");
    static const narc_method methods[] = {NARC_METHOD_SAT, NARC_METHOD_SAT_FIRST, NARC_METHOD_GJK};
    for (int m = 0; m < 3; m++) {
        struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, MANY);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        uint32_t *hints = create_hints(MANY), *enough_hints = create_hints(MANY);
        uint8_t *outcomes = create_outcomes(MANY), *enough_outcomes = create_outcomes(MANY);
        const narc_method_query enough = {.method = methods[m], .hints = enough_hints, .out_outcomes = enough_outcomes};
        size_t skipped;
        const narc_method_query query = {
            .method = methods[m], .hints = hints, .out_outcomes = outcomes, .out_skipped = &skipped};
        struct contacts all = query_contacts(&scene, &enough, 0, 1);
        assert_true(all.count > 100);
        for (unsigned threads = 1; threads <= 2; threads++) {
            struct contacts shorter = create_contacts(MANY), junk = create_contacts(MANY);
            const size_t capacity = shorter.view.capacity = all.count - 1 - random_below(&random, all.count - 1);
            narc_error error;
            memset(hints, 0, MANY * sizeof *hints);
            skipped = 12345;
            assert_int_equal(contacts_by_method(scene.store, &bodies, &pairs, &query, 0, threads, &shorter.view,
                                                &shorter.count, &error),
                             NARC_ERROR_CAPACITY);
            assert_int_equal(error.status, NARC_ERROR_CAPACITY);
            assert_int_equal(shorter.count, all.count);
            assert_int_equal(skipped, 0);
            assert_memory_equal(shorter.view.pair, all.view.pair, capacity * sizeof(uint32_t));
            assert_memory_equal(shorter.view.separation, all.view.separation, capacity * sizeof(float));
            assert_memory_equal(shorter.view.arc_b, all.view.arc_b, capacity);
            assert_memory_equal(shorter.view.separation + capacity, junk.view.separation,
                                (MANY - capacity) * sizeof(float));
            assert_memory_equal(hints, enough_hints, MANY * sizeof *hints);
            assert_memory_equal(outcomes, enough_outcomes, MANY);
            destroy_contacts(&shorter);
            destroy_contacts(&junk);
        }
        free(hints);
        free(enough_hints);
        free(outcomes);
        free(enough_outcomes);
        destroy_contacts(&all);
        destroy_scene(&scene);
    }
}

/* --------------------------------------------------------------------------------------------- bodies that are none */

/* All pairs of two squares in one place, one of them with a quantity spoilt. */
static struct scene make_spoilt_scene(void) {
    static const float spoilt[] = {NAN, INFINITY, -INFINITY};
    struct scene scene = create_scene(NARC_FLOAT32, 1, 64, 64);
    struct shape box;
    assert_int_equal(narc_build_box(1, 1, 0, box.arcs, &box.count, NULL), NARC_OK);
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

static void test_invalid_bodies(void **state) {
    (void)state;
    struct scene scene = make_spoilt_scene();
    const size_t count = scene.pair_count;
    for (int method = 0; method < METHODS; method++) {
        uint8_t *outcomes = create_outcomes(count);
        uint32_t *hints = create_hints(count);
        size_t skipped = 0;
        const narc_method_query query = {
            .method = (narc_method)method, .hints = hints, .out_outcomes = outcomes, .out_skipped = &skipped};
        uint64_t *bits = query_overlaps(&scene, &query, 1);
        assert_true(bits[0] == 0);
        assert_int_equal(skipped, count);
        for (int margin = 0; margin < 2 && has_contacts(query.method); margin++) {
            struct contacts found = query_contacts(&scene, &query, margin ? INFINITY : 1e30f, 1);
            assert_int_equal(found.count, margin ? count : 0);
            assert_int_equal(skipped, count);
            for (size_t k = 0; k < found.count; k++) {
                assert_int_equal(outcomes[k], NARC_OUTCOME_DONE);
                assert_int_equal(found.view.pair[k], k);
                assert_true(found.view.separation[k] == INFINITY);
                assert_true(found.view.normal_x[k] == 0 && found.view.normal_y[k] == 0);
                assert_true(found.view.point_x[k] == 0 && found.view.point_y[k] == 0);
                assert_true(found.view.arc_a[k] == 0 && found.view.arc_b[k] == 0);
            }
            destroy_contacts(&found);
        }
        free(bits);
        free(outcomes);
        free(hints);
    }
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_queries),        cmocka_unit_test(test_null_arguments),
        cmocka_unit_test(test_body_index),     cmocka_unit_test(test_first_wrong_pair),
        cmocka_unit_test(test_shape_index),    cmocka_unit_test(test_empty_tables),
        cmocka_unit_test(test_too_many_pairs), cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_outputs),        cmocka_unit_test(test_plain_outputs),
        cmocka_unit_test(test_not_a_polygon),  cmocka_unit_test(test_no_pairs),
        cmocka_unit_test(test_names),          cmocka_unit_test(test_capacity),
        cmocka_unit_test(test_invalid_bodies),
    };
    return test_begin() ? cmocka_run_group_tests_name("errors", tests, NULL, NULL) : TEST_SKIPPED;
}
