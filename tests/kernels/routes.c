/* SPDX-License-Identifier: MIT
 *
 * routes.c - pairs of discs are answered without a queue where a vector has no others, and pairs with edges skip stages
 * where most of those before them rest on each other: answers and hints must not depend on the company of a pair.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "plain.h"

static const float margins[] = {0, 0.3f, -0.1f, INFINITY};
enum { MARGINS = sizeof margins / sizeof *margins, BODIES = 300, PAIRS = 2600 };

/* Gives all bodies a disc but every `other`-th one (0: all), and breaks every `broken`-th (0: none). */
static struct scene make_discs(struct test_random *random, size_t pairs, size_t other, size_t broken) {
    struct scene scene = make_random_scene(random, NARC_FLOAT32, BODIES, pairs);
    uint32_t disc[4 * FAMILY_COUNT], count = 0;
    for (uint32_t k = 0; k < scene.shape_count; k++)
        if (narc_shape_flags(scene.store, k) & NARC_SHAPE_CIRCLE)
            disc[count++] = k;
    assert_true(count > 3);
    for (size_t k = 0; k < BODIES; k++) {
        if (other == 0 || k % other != 0)
            scene.bodies[k].shape = disc[k % count];
        if (broken > 0 && k % broken == 0)
            scene.bodies[k].sine = NAN;
    }
    return scene;
}

static void find_hinted(const struct scene *scene, size_t first, size_t count, float margin, uint32_t *hints) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_query query = {.margin = margin, .hints = NARC_HINT_ARRAY(hints), .first = first, .count = count};
    free(find_contacts(scene->store, &bodies, &pairs, &query).rows);
}

/* Hints of the whole batch against those of scalar, and of parts of all lengths. */
static void check_hints(struct test_random *random, const struct scene *scene, float margin, const uint32_t *hints) {
    const size_t count = scene->pair_count, size = count * sizeof *hints;
    uint32_t *whole = malloc(size), *other = malloc(size);
    assert_non_null(whole);
    assert_non_null(other);
    memcpy(whole, hints, size);
    find_hinted(scene, 0, count, margin, whole);
    memcpy(other, hints, size);
    test_use_isa("scalar");
    find_hinted(scene, 0, count, margin, other);
    test_use_isa(test_isa());
    assert_memory_equal(whole, other, size);
    memcpy(other, hints, size);
    for (size_t first = 0; first < count;) {
        const size_t wanted = 1 + random_below(random, 40), part = wanted < count - first ? wanted : count - first;
        find_hinted(scene, first, part, margin, other);
        first += part;
    }
    assert_memory_equal(whole, other, size);
    free(whole);
    free(other);
}

/* Manifolds by the deciding formula, and those found. `own`: margins of the pairs, or NULL. */
static void check_manifolds(const struct scene *scene, float margin, const float *own, unsigned threads) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_workers workers = narc_openmp_workers(threads);
    const narc_query query = {.margin = margin, .margins = {own, sizeof *own}, .workers = &workers};
    struct manifolds right = find_plain_manifolds(scene->store, &bodies, &pairs, &query);
    struct manifolds found = {guard_allocate(pairs.count * sizeof *found.rows), 0};
    assert_int_equal(
        narc_find_manifolds(scene->store, &bodies, &pairs, &query, found.rows, pairs.count, &found.count, NULL),
        NARC_OK);
    assert_int_equal(found.count, right.count);
    assert_memory_equal(found.rows, right.rows, right.count * sizeof *right.rows);
    guard_release(found.rows);
    free(right.rows);
}

static void check_all(struct test_random *random, const struct scene *scene, const char *name) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const struct plain_batch batch = make_plain_batch(scene, &bodies, &pairs, name);
    uint32_t *hints = calloc(pairs.count, sizeof *hints);
    float *own = malloc(pairs.count * sizeof *own);
    assert_non_null(hints);
    assert_non_null(own);
    for (size_t k = 0; k < pairs.count; k++)
        own[k] = margins[random_below(random, MARGINS)];
    check_manifolds(scene, 1000, own, 1);
    check_manifolds(scene, -1000, own, 2);
    const narc_workers workers[] = {narc_openmp_workers(1), narc_openmp_workers(2)};
    for (size_t w = 0; w < 2; w++)
        check_plain_overlaps(&batch, &workers[w]);
    for (size_t m = 0; m < MARGINS; m++) {
        for (size_t k = 0; k < pairs.count; k++)
            hints[k] = m % 2 ? (uint32_t)random_bits(random) & 0x0f0f : 0;
        check_hints(random, scene, margins[m], hints);
        narc_query query = {.margin = margins[m], .workers = &workers[m % 2]};
        check_plain_contacts(&batch, &query);
        query.hints = NARC_HINT_ARRAY(hints);
        query.workers = &workers[1 - m % 2];
        check_plain_contacts(&batch, &query);
        query.workers = NULL;
        check_plain_contacts(&batch, &query);
        check_manifolds(scene, margins[m], NULL, 1 + (unsigned)m % 2);
    }
    free(hints);
    free(own);
    free(batch.right);
}

/* Discs alone, with few others, with many; with broken bodies between them; around the ends of vectors and calls. */
TEST(test_discs) {
    static const struct {
        size_t other, broken, pairs;
    } mixes[] = {{0, 0, PAIRS}, {0, 0, 1024},    {0, 0, 1025},    {0, 0, 17},   {0, 97, PAIRS},
                 {0, 5, PAIRS}, {150, 0, PAIRS}, {40, 50, PAIRS}, {3, 0, PAIRS}};
    struct test_random random = test_random_named("discs");
    for (size_t k = 0; k < sizeof mixes / sizeof *mixes; k++) {
        struct scene scene = make_discs(&random, mixes[k].pairs, mixes[k].other, mixes[k].broken);
        check_all(&random, &scene, "discs");
        destroy_scene(&scene);
    }
}

/* One other pair, or one of a broken body, in each lane of each of the first vectors; and discs in one place. */
TEST(test_one_other) {
    enum { FEW = 50 };
    struct test_random random = test_random_named("one other");
    struct scene scene = make_discs(&random, FEW, BODIES - 1, 0); /* bodies 0 and BODIES - 1 are others */
    for (size_t k = 0; k < FEW; k++)
        scene.pairs[k] = (struct pair){1 + (uint32_t)k, 2 + (uint32_t)k};
    scene.pairs[20].b = scene.pairs[20].a; /* in one place */
    for (size_t round = 0; round < 2; round++) {
        for (size_t k = 0; k < FEW; k++) {
            const uint32_t kept = scene.pairs[k].a;
            scene.pairs[k].a = 0;
            check_all(&random, &scene, round ? "one broken" : "one other");
            scene.pairs[k].a = kept;
        }
        scene.bodies[0].sine = NAN;
    }
    destroy_scene(&scene);
}

/* Discs whose gap is about what the first proofs that they are apart need. Circles that lie off their origins: of
 * others the bounding circles know. */
TEST(test_hints_at_the_limit) {
    struct test_random random = test_random_named("limit");
    struct scene scene = create_scene(NARC_FLOAT32, 3, 2 * PAIRS, PAIRS);
    const struct shape left = {{{-0.6, -0.8, 1, -PI, PI}}, 1}, right = {{{0.6, 0.8, 1, -PI, PI}}, 1};
    const struct shape box = box_of(2, 2, 0.2);
    scene_add_shape(&scene, &left);
    scene_add_shape(&scene, &right);
    scene_add_shape(&scene, &box);
    for (uint32_t k = 0; k < PAIRS; k++) {
        const double turn = random_between(&random, -5e-4, 5e-4), gap = 0x1p-15 * random_between(&random, 0.98, 1.02);
        struct body a = turned_body(0, 1), b = turned_body(turn, 1);
        b.x = 0.6 * (gap + 1 - cos(turn)) + 0.8 * sin(turn);
        b.y = 0.8 * (gap + 1 - cos(turn)) - 0.6 * sin(turn);
        b.shape = k % 16 == 15 ? 2 : 1;
        scene_add_two(&scene, a, b);
    }
    check_all(&random, &scene, "limit");
    destroy_scene(&scene);
}

/* Blocks of boxes that rest on each other, and blocks that lie anywhere. */
TEST(test_resting_edges) {
    struct test_random random = test_random_named("resting");
    struct scene scene = create_scene(NARC_FLOAT32, 3, 2 * PAIRS, PAIRS);
    const struct shape sharp = box_of(2, 1, 0), round = box_of(2, 1, 0.2);
    struct shape ellipse;
    assert_int_equal(narc_build_ellipse(1, 0.5, 8, ellipse.arcs, &ellipse.count, NULL, NULL), NARC_OK);
    scene_add_shape(&scene, &sharp);
    scene_add_shape(&scene, &round);
    scene_add_shape(&scene, &ellipse);
    for (uint32_t k = 0; k < PAIRS; k++) {
        const bool rests = k / 100 % 3 < 2;
        const double angle = random_between(&random, -PI, PI), along = random_between(&random, -1.5, 1.5);
        const double across = rests ? 1 + 1e-4 * random_between(&random, -1, 1) : random_between(&random, 0, 2);
        struct body a = turned_body(angle, 1), b = turned_body(rests ? angle : 3 * angle, 1);
        a.shape = (uint32_t)random_below(&random, k % 7 ? 2 : 3);
        b.shape = (uint32_t)random_below(&random, k % 5 ? 2 : 3);
        b.x = cos(angle) * along - sin(angle) * across;
        b.y = sin(angle) * along + cos(angle) * across;
        scene_add_two(&scene, a, b);
    }
    check_all(&random, &scene, "resting");
    destroy_scene(&scene);
}

TEST_MAIN("routes")
