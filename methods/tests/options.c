/* SPDX-License-Identifier: MIT
 *
 * options.c - names of methods, and what is wrong with their options: a status, a message that names the culprit, and
 * no output is touched.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "expect.h"
#include "method_support.h"

enum { PAIRS = 200, METHODS = 7 };

TEST(test_names) {
    static const char *const names[METHODS] = {"sat", "sat-first", "polygon-sat", "gjk", "circle", "aabb", "obb"};
    for (int method = 0; method < METHODS; method++)
        assert_string_equal(narc_method_name((narc_method)method), names[method]);
    assert_null(narc_method_name((narc_method)METHODS));
    assert_null(narc_method_name((narc_method)-1));
}

/* Contacts of a scene, and overlaps unless a filter's name is awaited: filters have those. */
static void expect_wrong(const struct scene *scene, narc_method_options options, narc_status expected,
                         const char *words) {
    struct {
        narc_contact rows[PAIRS];
        uint64_t bits[NARC_BIT_WORDS(PAIRS)];
        size_t count;
        uint8_t outcomes[PAIRS];
    } *out = make_junk(sizeof *out);
    AUTO(narc_destroy_methods_at) narc_methods *methods = create_methods(scene->store);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    options.out_outcomes = out->outcomes;
    if (words != narc_method_name(options.method))
        expect_error(narc_find_overlaps_by(methods, &bodies, &pairs, &options, NULL, out->bits, &error), expected,
                     &error, words);
    expect_error(narc_find_contacts_by(methods, &bodies, &pairs, &options, NULL, out->rows, PAIRS, &out->count, &error),
                 expected, &error, words);
    assert_true(is_junk(out, sizeof *out));
    free(out);
}

TEST(test_options) {
    static const int bad_methods[] = {METHODS, 100, -1, INT32_MAX, INT32_MIN};
    struct test_random random = test_random_named("options");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, 30, PAIRS);
    for (size_t k = 0; k < sizeof bad_methods / sizeof *bad_methods; k++) {
        char words[32];
        snprintf(words, sizeof words, "no method %d", bad_methods[k]);
        expect_wrong(&scene, (narc_method_options){.method = (narc_method)bad_methods[k]}, NARC_ERROR_ARGUMENT, words);
    }
    for (narc_method method = NARC_METHOD_SAT; narc_method_name(method); method++) {
        narc_method_options options = {.method = method, .tolerance = NAN};
        expect_wrong(&scene, options, NARC_ERROR_NOT_FINITE, "tolerance");
        options.tolerance = INFINITY;
        expect_wrong(&scene, options, NARC_ERROR_NOT_FINITE, "tolerance is inf");
        options.tolerance = -INFINITY;
        expect_wrong(&scene, options, NARC_ERROR_NOT_FINITE, "tolerance is -inf");
        options.tolerance = -0.25f;
        expect_wrong(&scene, options, NARC_ERROR_ARGUMENT, "tolerance is -0.25");
        options.tolerance = 0;
        options.reserved[2] = &scene;
        expect_wrong(&scene, options, NARC_ERROR_ARGUMENT, "reserved");
        options.reserved[2] = NULL;
        if (method >= NARC_METHOD_CIRCLE)
            expect_wrong(&scene, options, NARC_ERROR_ARGUMENT, narc_method_name(method));
    }
}

/* The first pair whose shape is not a polygon is the one that is told, and the shape and the body. */
TEST(test_not_a_polygon) {
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 2, 40, PAIRS);
    const struct shape box = box_of(1, 1, 0), round = box_of(1, 1, 0.1);
    const narc_method_options polygons = {.method = NARC_METHOD_POLYGON_SAT};
    scene_add_shape(&scene, &box);
    scene_add_shape(&scene, &round);
    for (uint32_t k = 0; k < 40; k++) {
        struct body body = turned_body(0.1 * k, 1);
        body.shape = k == 23 || k == 31;
        scene_add_body(&scene, body);
    }
    for (uint32_t k = 0; k < PAIRS; k++)
        scene_add_pair(&scene, k % 20, (k + 1) % 20);
    free(query_overlaps(&scene, &polygons, NULL));
    scene.pairs[171].a = 31;
    expect_wrong(&scene, polygons, NARC_ERROR_ARGUMENT,
                 "pair 171: polygon-sat needs polygons, but shape 1 of body 31 has arcs");
    scene.pairs[66].b = 23;
    expect_wrong(&scene, polygons, NARC_ERROR_ARGUMENT,
                 "pair 66: polygon-sat needs polygons, but shape 1 of body 23 has arcs");
}
