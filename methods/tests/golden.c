/* SPDX-License-Identifier: MIT
 *
 * golden.c - the bits of the methods' answers to a fixed scene, recorded: the same for every instruction set and
 * processor. They may change only together with a wanted change of the kernels; the program prints what it finds.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "golden_scene.h"
#include "method_support.h"

/* In the order of the methods; the exact one has the hashes of narc. */
static const uint64_t golden_methods[] = {0x85810ad0d8fcad45u, 0xde05f3d86d13b145u, 0xb72adc1892a6c4b6u,
                                          0x656376e9cda0e835u, 0x7ec640b6e75a6511u, 0x88b6eccb0495ec6du};

/* Twice, by GJK the second time from the first one's simplexes. */
static uint64_t hash_method(const struct scene *scene, narc_method method) {
    static uint8_t outcomes[PAIRS];
    static uint32_t simplexes[PAIRS];
    const narc_method_options options = {.method = method, .out_outcomes = outcomes, .simplexes = simplexes};
    const narc_query query = {.margin = INFINITY};
    uint64_t hash = TEST_HASH_START;
    memset(simplexes, 0, sizeof simplexes);
    for (int round = 0; round < 2; round++) {
        AUTO(free_at) uint64_t *bits = query_overlaps(scene, &options, &query);
        AUTO(free_at) struct contacts found = {0};
        if (method <= NARC_METHOD_GJK) {
            found = query_contacts(scene, &options, &query);
            assert_int_equal(found.count, scene->pair_count);
        }
        hash = test_hash_items(hash, bits, NARC_BIT_WORDS(scene->pair_count), sizeof(uint64_t));
        hash = test_hash(hash, outcomes, scene->pair_count);
        hash = test_hash_items(hash, simplexes, PAIRS, sizeof *simplexes);
        hash = hash_contacts(hash, found);
    }
    return hash;
}

static bool is_polygon(const struct scene *scene, uint32_t body) {
    return narc_shape_flags(scene->store, scene->bodies[body].shape) & NARC_SHAPE_POLYGON;
}

TEST(test_methods) {
    struct scene scene = make_golden_scene(NARC_FLOAT32), polygons = scene;
    polygons.pairs = malloc(PAIRS * sizeof *polygons.pairs);
    polygons.pair_count = 0;
    assert_non_null(polygons.pairs);
    for (size_t k = 0; k < PAIRS; k++)
        if (is_polygon(&scene, scene.pairs[k].a) && is_polygon(&scene, scene.pairs[k].b))
            polygons.pairs[polygons.pair_count++] = scene.pairs[k];
    assert_true(polygons.pair_count > PAIRS / 40);
    for (narc_method method = NARC_METHOD_SAT_FIRST; narc_method_name(method); method++)
        check_hash(narc_method_name(method),
                   hash_method(method == NARC_METHOD_POLYGON_SAT ? &polygons : &scene, method),
                   golden_methods[method - NARC_METHOD_SAT_FIRST]);
    free(polygons.pairs);
    destroy_scene(&scene);
}

TEST_MAIN("method_golden")
