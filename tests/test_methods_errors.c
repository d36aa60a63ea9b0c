/* SPDX-License-Identifier: MIT
 *
 * test_methods_errors.c - wrong arguments of narc_query_...: each has its status and a message that names the culprit,
 * and no output is touched; bodies that are none, and lists that are too short.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "methods.h"

enum { PAIRS = 200, BODIES = 30, METHODS = 7 };

static struct scene make_scene(void) {
    struct test_random random = test_random_named("method errors");
    return make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
}

static bool has_contacts(narc_method method) { return method < NARC_METHOD_CIRCLE; }

/* Outputs of all calls, and what they held. */
struct outputs {
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    uint32_t hints[PAIRS];
    uint8_t outcomes[PAIRS];
    struct contacts contacts, fresh;
    narc_error error;
};

static struct outputs create_outputs(void) {
    struct outputs out = {.contacts = create_contacts(PAIRS), .fresh = create_contacts(PAIRS)};
    memset(out.bits, 0xa5, sizeof out.bits);
    memset(out.hints, 0xa5, sizeof out.hints);
    memset(out.outcomes, 0xa5, sizeof out.outcomes);
    out.contacts.count = 12345;
    return out;
}

static void check_junk(const void *memory, size_t size) {
    const unsigned char *bytes = memory;
    for (size_t k = 0; k < size; k++) {
        assert_int_equal(bytes[k], 0xa5);
    }
}

static void destroy_untouched(struct outputs *out) {
    const narc_contacts *c = &out->contacts.view, *f = &out->fresh.view;
    check_junk(out->bits, sizeof out->bits);
    check_junk(out->hints, sizeof out->hints);
    check_junk(out->outcomes, sizeof out->outcomes);
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
    narc_query query; /* hints and outcomes are wanted always */
    float margin;
    bool contacts_only;
};

static void check_error(const struct outputs *out, narc_status status, narc_status expected, const char *const texts[],
                        size_t text_count) {
    if (status != expected || out->error.status != expected) {
        fail_msg("%s (%s), not %s: '%s'", narc_status_name(status), narc_status_name(out->error.status),
                 narc_status_name(expected), out->error.message);
    }
    for (size_t k = 0; k < text_count; k++) {
        if (!strstr(out->error.message, texts[k])) {
            fail_msg("'%s' does not name '%s'", out->error.message, texts[k]);
        }
    }
}

/* Both calls, with an error to fill and without, and some numbers of threads. */
static void check_call(const struct call *call, narc_status expected, const char *const texts[], size_t text_count) {
    for (unsigned threads = 0; threads < 3; threads++) {
        struct outputs out = create_outputs();
        narc_query query = call->query;
        query.hints = out.hints;
        query.out_outcomes = out.outcomes;
        const narc_query *passed = call->no_query ? NULL : &query;
        for (int silent = 0; silent < 2 && !call->contacts_only; silent++) {
            const narc_status status = narc_query_overlaps(call->shapes, call->bodies, call->pairs, passed, threads,
                                                           out.bits, silent ? NULL : &out.error);
            check_error(&out, status, expected, texts, text_count);
        }
        memset(&out.error, 0, sizeof out.error);
        for (int silent = 0; silent < 2 && (has_contacts(query.method) || call->contacts_only); silent++) {
            const narc_status status =
                narc_query_contacts(call->shapes, call->bodies, call->pairs, passed, call->margin, threads,
                                    &out.contacts.view, &out.contacts.count, silent ? NULL : &out.error);
            check_error(&out, status, expected, texts, text_count);
        }
        destroy_untouched(&out);
    }
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
        call.query = (narc_query){.method = (narc_method)method, .tolerance = NAN};
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

/* What is wrong with a batch is so with any method. */
static void test_batches(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    for (int method = 0; method < METHODS; method++) {
        struct call call = {.shapes = scene.store, .bodies = &bodies, .pairs = &pairs};
        call.query.method = (narc_method)method;
        call.shapes = NULL;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("shapes"));
        call.shapes = scene.store;
        call.bodies = NULL;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("bodies"));
        call.bodies = &bodies;
        call.pairs = NULL;
        check_call(&call, NARC_ERROR_ARGUMENT, NAMES("pairs"));
        call.pairs = &pairs;
        const struct pair old = scene.pairs[137];
        scene.pairs[137].b = 4711;
        check_call(&call, NARC_ERROR_INDEX, NAMES("137", "4711"));
        scene.pairs[137] = old;
        const uint32_t old_shape = scene.bodies[old.a].shape;
        scene.bodies[old.a].shape = 4712;
        check_call(&call, NARC_ERROR_INDEX, NAMES("4712"));
        scene.bodies[old.a].shape = old_shape;
    }
    destroy_scene(&scene);
}

static void test_outputs(void **state) {
    (void)state;
    struct scene scene = make_scene();
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    for (int method = 0; method < METHODS; method++) {
        if (method == NARC_METHOD_POLYGON_SAT) {
            continue; /* not of these shapes */
        }
        struct outputs out = create_outputs();
        const narc_query query = {.method = (narc_method)method, .hints = out.hints, .out_outcomes = out.outcomes};
        check_error(&out, narc_query_overlaps(scene.store, &bodies, &pairs, &query, 1, NULL, &out.error),
                    NARC_ERROR_ARGUMENT, NAMES("out_bits"));
        if (has_contacts(query.method)) {
            check_error(
                &out,
                narc_query_contacts(scene.store, &bodies, &pairs, &query, 0, 1, NULL, &out.contacts.count, &out.error),
                NARC_ERROR_ARGUMENT, NAMES("out_contacts"));
            check_error(
                &out,
                narc_query_contacts(scene.store, &bodies, &pairs, &query, 0, 1, &out.contacts.view, NULL, &out.error),
                NARC_ERROR_ARGUMENT, NAMES("out_count"));
            check_error(&out,
                        narc_query_contacts(scene.store, &bodies, &pairs, &query, NAN, 1, &out.contacts.view,
                                            &out.contacts.count, &out.error),
                        NARC_ERROR_NOT_FINITE, NAMES("margin"));
        } else {
            check_error(&out,
                        narc_query_contacts(scene.store, &bodies, &pairs, &query, 0, 1, &out.contacts.view,
                                            &out.contacts.count, &out.error),
                        NARC_ERROR_ARGUMENT, NAMES(narc_method_name(query.method)));
        }
        destroy_untouched(&out);
    }
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
    for (uint32_t k = 0; k < PAIRS; k++) {
        scene_add_pair(&scene, k % 20, (k + 1) % 20);
    }
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
        const narc_query query = {.method = (narc_method)method, .hints = out.hints, .out_outcomes = out.outcomes};
        assert_int_equal(narc_query_overlaps(scene.store, &bodies, &pairs, &query, 0, NULL, NULL), NARC_OK);
        assert_int_equal(narc_query_overlaps(scene.store, &bodies, &pairs, &query, 2, out.bits, NULL), NARC_OK);
        if (has_contacts(query.method)) {
            assert_int_equal(narc_query_contacts(scene.store, &bodies, &pairs, &query, 0, 2, &out.contacts.view,
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
    for (int method = 0; method < METHODS; method++) {
        assert_string_equal(narc_method_name((narc_method)method), names[method]);
    }
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
        const narc_query enough = {.method = methods[m], .hints = enough_hints, .out_outcomes = enough_outcomes};
        const narc_query query = {.method = methods[m], .hints = hints, .out_outcomes = outcomes};
        struct contacts all = query_contacts(&scene, &enough, 0, 1);
        assert_true(all.count > 100);
        for (unsigned threads = 1; threads <= 2; threads++) {
            struct contacts shorter = create_contacts(MANY), junk = create_contacts(MANY);
            const size_t capacity = shorter.view.capacity = all.count - 1 - random_below(&random, all.count - 1);
            narc_error error;
            memset(hints, 0, MANY * sizeof *hints);
            assert_int_equal(narc_query_contacts(scene.store, &bodies, &pairs, &query, 0, threads, &shorter.view,
                                                 &shorter.count, &error),
                             NARC_ERROR_CAPACITY);
            assert_int_equal(error.status, NARC_ERROR_CAPACITY);
            assert_int_equal(shorter.count, all.count);
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
        if (k < 15) {
            *values[k / 3] = spoilt[k % 3];
        } else if (k == 15) {
            body->scale = 0;
        } else if (k == 16) {
            body->scale = -1;
        } else if (k == 17) {
            body->cosine = body->sine = 0;
        } else {
            body->cosine *= 1.01f;
        }
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
        const narc_query query = {.method = (narc_method)method, .hints = hints, .out_outcomes = outcomes};
        uint64_t *bits = query_overlaps(&scene, &query, 1);
        assert_true(bits[0] == 0);
        for (int margin = 0; margin < 2 && has_contacts(query.method); margin++) {
            struct contacts found = query_contacts(&scene, &query, margin ? INFINITY : 1e30f, 1);
            assert_int_equal(found.count, margin ? count : 0);
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
        cmocka_unit_test(test_queries),       cmocka_unit_test(test_batches),        cmocka_unit_test(test_outputs),
        cmocka_unit_test(test_not_a_polygon), cmocka_unit_test(test_no_pairs),       cmocka_unit_test(test_names),
        cmocka_unit_test(test_capacity),      cmocka_unit_test(test_invalid_bodies),
    };
    return test_begin() ? cmocka_run_group_tests_name("methods_errors", tests, NULL, NULL) : TEST_SKIPPED;
}
