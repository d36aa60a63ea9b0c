/* SPDX-License-Identifier: MIT
 *
 * corpus.c - pairs of everything with their exact answers.
 */
#include "corpus.h"

#include <stdlib.h>

#include "check.h"
#include "placements.h"

enum { SHAPES_PER_KIND = 4 };

/* The kinds that have polygons: all numbers below FAMILY_COUNT are families, the rest are hard ones. */
static const size_t polygon_kinds[] = {FAMILY_POLYGON,
                                       FAMILY_BOX,
                                       FAMILY_COUNT + HARD_CORNERS,
                                       FAMILY_COUNT + HARD_REGULAR,
                                       FAMILY_COUNT + HARD_STACK,
                                       FAMILY_COUNT + HARD_LONG};
enum { POLYGON_KINDS = sizeof(polygon_kinds) / sizeof(polygon_kinds[0]) };

static bool is_polygon(const struct shape *shape) {
    bool polygon = true;
    for (size_t i = 0; i < shape->count; i++)
        polygon = polygon && shape->arcs[i].radius == 0;
    return polygon;
}

static struct shape make_kind(struct test_random *random, size_t kind, bool polygon) {
    struct shape shape;
    do {
        shape = make_any_shape(random, kind);
    } while (polygon && !is_polygon(&shape));
    return shape;
}

static double bounding_radius(const struct shape *shape) {
    narc_circle circle;
    assert_true(narc_compute_bounding_circle(shape->arcs, shape->count, &circle));
    return circle.radius;
}

/* What is exact of pair k. */
static void find_exact(struct corpus *corpus, size_t k) {
    const struct scene *scene = &corpus->scene;
    const uint32_t index_a = scene->pairs[k].a, index_b = scene->pairs[k].b;
    const struct shape *a = &scene->shapes[scene->bodies[index_a].shape],
                       *b = &scene->shapes[scene->bodies[index_b].shape];
    struct exact_pair *pair = &corpus->pairs[k];
    pair->a = scene_reference(scene, index_a);
    pair->b = scene_reference(scene, index_b);
    const struct reference_gap found = reference_find_gap(&pair->a, &pair->b);
    pair->gap = found.gap;
    pair->normal_x = found.normal_x;
    pair->normal_y = found.normal_y;
    pair->reach = reference_reach(&pair->a, &pair->b);
    pair->size = pair->a.scale * bounding_radius(a) + pair->b.scale * bounding_radius(b);
    pair->bound = separation_bound(&pair->a, &pair->b);
}

/* Names for the pairs from number `first` on. */
static void name_pairs(struct corpus *corpus, size_t first, size_t kind_a, size_t kind_b, const char *place) {
    for (size_t k = first; k < corpus->scene.pair_count; k++) {
        corpus->pairs[k].kind_a = kind_a;
        corpus->pairs[k].kind_b = kind_b;
        corpus->pairs[k].place = place;
    }
}

static uint32_t pick_shape(struct test_random *random, size_t kind_number) {
    return (uint32_t)(kind_number * SHAPES_PER_KIND + random_below(random, SHAPES_PER_KIND));
}

/* Number i of `count`: one of `all` cases, in turn, or as evenly as it gets where there are fewer than all. */
static size_t spread(size_t i, size_t count, size_t all) { return count < all ? i * all / count : i % all; }

struct corpus make_corpus(const char *name, narc_precision precision, double rounds, bool polygons) {
    struct test_random random = test_random_named(name);
    const size_t kinds = polygons ? POLYGON_KINDS : ALL_FAMILIES;
    const size_t places = kinds * kinds * PLACE_COUNT, hard_places = kinds * HARD_PLACES;
    const size_t placed = test_trials((size_t)(rounds * (double)places)),
                 hard = test_trials((size_t)(rounds * (double)hard_places));
    const size_t most = placed + hard * HARD_BODIES / 2;
    struct corpus corpus = {.scene = create_scene(precision, kinds * SHAPES_PER_KIND, 2 * most, most),
                            .pairs = calloc(most, sizeof(struct exact_pair))};
    assert_non_null(corpus.pairs);
    size_t kind[ALL_FAMILIES];
    for (size_t k = 0; k < kinds; k++) {
        kind[k] = polygons ? polygon_kinds[k] : k;
        for (size_t i = 0; i < SHAPES_PER_KIND; i++) {
            const struct shape shape = make_kind(&random, kind[k], polygons);
            scene_add_shape(&corpus.scene, &shape);
        }
    }
    for (size_t i = 0; i < placed; i++) {
        const size_t k = spread(i, placed, places), a = k % kinds, b = k / kinds % kinds;
        const size_t first = corpus.scene.pair_count;
        const enum placement placement = (enum placement)(k / kinds / kinds);
        const uint32_t shape_a = pick_shape(&random, a), shape_b = pick_shape(&random, b);
        scene_add_placed(&random, &corpus.scene, placement, shape_a, shape_b);
        name_pairs(&corpus, first, kind[a], kind[b], placement_name(placement));
    }
    for (size_t i = 0; i < hard; i++) {
        const size_t k = spread(i, hard, hard_places), a = k % kinds, b = random_below(&random, kinds);
        const size_t first = corpus.scene.pair_count;
        const enum hard_placement placement = (enum hard_placement)(k / kinds);
        const uint32_t shape_a = pick_shape(&random, a), shape_b = pick_shape(&random, b);
        add_hard_pairs(&random, &corpus.scene, placement, shape_a, shape_b);
        name_pairs(&corpus, first, kind[a], kind[b], hard_placement_name(placement));
    }
    return corpus;
}

void solve_corpus(struct corpus *corpus) {
    for (size_t k = 0; k < corpus->scene.pair_count; k++)
        find_exact(corpus, k);
}

void destroy_corpus(struct corpus *corpus) {
    destroy_scene(&corpus->scene);
    free(corpus->pairs);
}
