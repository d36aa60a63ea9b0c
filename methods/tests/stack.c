/* SPDX-License-Identifier: MIT
 *
 * stack.c - every call of narc_methods.h in a thread whose stack has NARC_METHODS_STACK_SIZE bytes.
 */
#include <math.h>

#include "method_support.h"
#include "stacks.h"

enum { BODIES = 1500, PAIRS = 30000 };

/* All shapes, and polygons; of lists too little, so that calls fill what they have for that. */
static struct scene scene, polygons;
static narc_methods *of_scene, *of_polygons;
static narc_query query;
static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
static narc_contact contacts[PAIRS / 4];
static uint32_t simplexes[PAIRS];
static uint8_t outcomes[PAIRS];
static size_t count, skipped;

/* Bits, and contacts of methods that have them. */
static narc_status ask(narc_method method, narc_error *error) {
    const bool of_some = method == NARC_METHOD_POLYGON_SAT;
    const narc_methods *methods = of_some ? of_polygons : of_scene;
    const narc_bodies bodies = scene_bodies(of_some ? &polygons : &scene);
    const narc_pairs pairs = scene_pairs(&scene);
    const narc_method_options options = {.method = method, .out_outcomes = outcomes, .simplexes = simplexes};
    const narc_status status = narc_find_overlaps_by(methods, &bodies, &pairs, &options, &query, bits, error);
    if (status != NARC_OK || method >= NARC_METHOD_CIRCLE)
        return status;
    return narc_find_contacts_by(methods, &bodies, &pairs, &options, &query, contacts, PAIRS / 4, &count, error);
}

/* Makes and takes a copy of the shapes. */
static narc_status copy(narc_error *error) {
    AUTO(narc_destroy_methods_at) narc_methods *methods = NULL;
    narc_status status = narc_create_methods(scene.store, NULL, &methods, error);
    if (status == NARC_OK)
        status = narc_refresh_methods(methods, error);
    return status;
}

#define CALLS(CALL)                                                                                                    \
    CALL(sat, ask(NARC_METHOD_SAT, error))                                                                             \
    CALL(sat_first, ask(NARC_METHOD_SAT_FIRST, error))                                                                 \
    CALL(polygon_sat, ask(NARC_METHOD_POLYGON_SAT, error))                                                             \
    CALL(gjk, ask(NARC_METHOD_GJK, error))                                                                             \
    CALL(circle_filter, ask(NARC_METHOD_CIRCLE, error))                                                                \
    CALL(aabb_filter, ask(NARC_METHOD_AABB, error))                                                                    \
    CALL(obb_filter, ask(NARC_METHOD_OBB, error))                                                                      \
    CALL(copy, copy(error))

#define DEFINE(name, expression)                                                                                       \
    static narc_status call_##name(narc_error *error) { return expression; }
CALLS(DEFINE)
#define LIST_CALL(name, expression) {#name, call_##name},
static const struct stack_call calls[] = {CALLS(LIST_CALL)};

static void set_workers(const narc_workers *workers) { query.workers = workers; }

TEST(test_calls) {
    static float margins[PAIRS];
    struct test_random random = test_random_named("stack of methods");
    scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    polygons = create_scene(NARC_FLOAT64, 1, BODIES, 0);
    const struct shape polygon = make_shape(&random, FAMILY_POLYGON);
    scene_add_shape(&polygons, &polygon);
    for (size_t k = 0; k < BODIES; k++) {
        struct body body = scene.bodies[k];
        body.shape = 0;
        scene_add_body(&polygons, body);
    }
    of_scene = create_methods(scene.store);
    of_polygons = create_methods(polygons.store);
    for (size_t k = 0; k < PAIRS; k++)
        margins[k] = k % 3 ? INFINITY : 0.25f;
    query = (narc_query){.margins = NARC_ARRAY(margins), .out_skipped = &skipped};
    run_on_stacks(calls, sizeof calls / sizeof *calls, NARC_METHODS_STACK_SIZE, set_workers);
}

int main(void) { return !large_frames && test_begin() ? test_run("method_stack", NULL, NULL) : TEST_SKIPPED; }
