/* SPDX-License-Identifier: MIT
 *
 * pair.c - pairs that bring their own poses, alone or many at once; bodies of two sets; sets that stand at the origin.
 * All have the bits of the same bodies and pairs given by index.
 */
#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "corpus.h"
#include "expect.h"
#include "narc_scene.h"

enum { BODIES = 60, PAIRS = 600 };

/* Bodies 2k and 2k + 1 are those of pair k. */
static narc_body *find_rows(const struct scene *scene) {
    narc_body *rows = malloc(2 * scene->pair_count * sizeof *rows);
    assert_non_null(rows);
    for (size_t k = 0; k < scene->pair_count; k++) {
        rows[2 * k] = scene_body(scene, scene->pairs[k].a);
        rows[2 * k + 1] = scene_body(scene, scene->pairs[k].b);
    }
    return rows;
}

/* Fails unless all three calls have the bits of those for the scene, for all pairs and for some. */
static void check_same_answers(const struct scene *scene, const narc_bodies *bodies, const narc_pairs *pairs) {
    static const uint32_t selection[] = {7, PAIRS - 1, 0, 300, 64, 63, 1};
    const narc_bodies right_bodies = scene_bodies(scene);
    const narc_pairs right_pairs = scene_pairs(scene);
    const narc_workers workers = openmp_workers(2);
    const narc_query queries[] = {
        {.margin = INFINITY},
        {.margin = 0.1f, .workers = &workers},
        {.margin = 0.1f, .first = 64, .count = 128},
        {.margin = INFINITY, .selection = NARC_ARRAY(selection), .selection_count = 7},
    };
    for (size_t q = 0; q < sizeof queries / sizeof *queries; q++) {
        const narc_query *query = &queries[q];
        const size_t asked = query->selection_count ? query->selection_count : PAIRS;
        AUTO(free_at) uint64_t *bits = find_overlaps(scene->store, bodies, pairs, query);
        AUTO(free_at) uint64_t *right_bits = find_overlaps(scene->store, &right_bodies, &right_pairs, query);
        assert_memory_equal(bits, right_bits, NARC_BIT_WORDS(asked) * sizeof *bits);
        AUTO(free_at) struct contacts list = find_contacts(scene->store, bodies, pairs, query);
        AUTO(free_at) struct contacts right = find_contacts(scene->store, &right_bodies, &right_pairs, query);
        assert_int_equal(list.count, right.count);
        assert_memory_equal(list.rows, right.rows, right.count * sizeof *right.rows);
        AUTO(free_at) struct manifolds points = find_manifolds(scene->store, bodies, pairs, query);
        AUTO(free_at) struct manifolds right_points = find_manifolds(scene->store, &right_bodies, &right_pairs, query);
        assert_int_equal(points.count, right_points.count);
        assert_memory_equal(points.rows, right_points.rows, right_points.count * sizeof *points.rows);
    }
}

/* Two bodies asked directly have the dense row of a batch, whatever is asked. */
static void check_two(const narc_shapes *store, const narc_body two[2]) {
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    const float reach = fmaxf(two[0].scale, two[1].scale);
    const narc_query asked[] = {{.margin = INFINITY},
                                {.margin = 0},
                                {.margin = 0.1f * reach, .second_margin = 0.4f * reach, .flat_angle = 0.1f},
                                {.margin = -0.1f * reach, .flat_angle = -1}};
    for (size_t q = 0; q < sizeof asked / sizeof *asked; q++) {
        narc_query query = asked[q], dense = asked[q];
        narc_contact contact, right;
        narc_manifold manifold, right_manifold;
        size_t found, skipped = 9, skipped_manifold = 9, right_skipped = 9;
        narc_error error;
        dense.dense = 1;
        dense.out_skipped = &right_skipped;
        query.out_skipped = &skipped;
        expect_ok(narc_find_contacts(store, &bodies, &(narc_pairs){.count = 1}, &dense, &right, 1, &found, &error),
                  &error);
        expect_ok(narc_find_contact(store, &two[0], &two[1], &query, &contact, &error), &error);
        assert_memory_equal(&contact, &right, sizeof contact);
        assert_true(skipped == right_skipped && contact.count == found);
        query.out_skipped = &skipped_manifold;
        expect_ok(
            narc_find_manifolds(store, &bodies, &(narc_pairs){.count = 1}, &dense, &right_manifold, 1, &found, &error),
            &error);
        expect_ok(narc_find_manifold(store, &two[0], &two[1], &query, &manifold, &error), &error);
        assert_memory_equal(&manifold, &right_manifold, sizeof manifold);
        assert_true(skipped_manifold == right_skipped);
    }
}

/* Every pair by itself, with bodies of its own, has the row of its pair in a batch. */
static void check_each(const struct scene *scene, const narc_body *rows) {
    AUTO(free_at) struct contacts batch = scene_contacts(scene, INFINITY);
    AUTO(free_at) struct manifolds points = scene_manifolds(scene, INFINITY);
    AUTO(free_at) uint64_t *bits = scene_overlaps(scene);
    const narc_pairs one = {.count = 1};
    for (size_t k = 0; k < PAIRS; k++) {
        narc_bodies two;
        narc_view_bodies(&rows[2 * k], 2, &two);
        const narc_query query = {.margin = INFINITY, .flat_angle = k % 4 ? 0 : NARC_FLAT_ANGLE};
        narc_contact contact;
        narc_manifold manifold;
        uint64_t bit;
        size_t found, found_points;
        narc_error error;
        expect_ok(narc_find_overlaps(scene->store, &two, &one, NULL, &bit, &error), &error);
        expect_ok(narc_find_contacts(scene->store, &two, &one, &query, &contact, 1, &found, &error), &error);
        expect_ok(narc_find_manifolds(scene->store, &two, &one, &query, &manifold, 1, &found_points, &error), &error);
        assert_true(bit == bit_is_set(bits, k));
        assert_true(found == 1 && found_points == 1 && contact.pair == 0 && manifold.pair == 0);
        contact.pair = manifold.pair = (uint32_t)k;
        assert_memory_equal(&contact, &batch.rows[k], sizeof contact);
        assert_memory_equal(&manifold, &points.rows[k], sizeof manifold);
        check_two(scene->store, &rows[2 * k]);
    }
}

TEST(own_poses) {
    struct test_random random = test_random_named("own poses");
    for (int precision = 0; precision < 2; precision++) {
        AUTO(destroy_scene)
        struct scene scene = make_random_scene(&random, precision ? NARC_FLOAT64 : NARC_FLOAT32, BODIES, PAIRS);
        AUTO(free_at) narc_body *rows = find_rows(&scene);
        narc_bodies bodies, few;
        narc_view_bodies(rows, 2 * PAIRS, &bodies);
        narc_view_bodies(rows, 2 * PAIRS - 1, &few);
        const narc_pairs pairs = {.count = PAIRS};
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            if (!narc_isa_supported(narc_isa_name(isa)))
                continue;
            test_use_isa(narc_isa_name(isa));
            check_same_answers(&scene, &bodies, &pairs);
            check_each(&scene, rows);
        }
        test_use_isa(test_isa());
        uint64_t bits[NARC_BIT_WORDS(PAIRS)];
        narc_error error;
        expect_error(narc_find_overlaps(scene.store, &few, &pairs, NULL, bits, &error), NARC_ERROR_INDEX, &error,
                     "pair 599");
    }
}

/* The point less half the separation along the normal lies on A, and plus that on B, near and far: check_contact(). */
TEST(one_pair_is_right) {
    struct test_random random = test_random_named("one contact, reference");
    struct fractions worst = {0};
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    AUTO(free_at) narc_body *rows = find_rows(&scene);
    size_t apart = 0;
    for (size_t k = 0; k < PAIRS; k++) {
        const struct reference_body a = scene_reference(&scene, scene.pairs[k].a);
        const struct reference_body b = scene_reference(&scene, scene.pairs[k].b);
        narc_bodies two;
        narc_view_bodies(&rows[2 * k], 2, &two);
        AUTO(free_at)
        struct contacts one =
            find_contacts(scene.store, &two, &(narc_pairs){.count = 1}, &(narc_query){.margin = INFINITY});
        const char *wrong = check_contact(&a, &b, reference_find_gap(&a, &b).gap, one.rows, &worst);
        if (wrong) {
            print_pair(&a, &b);
            fail_msg("%s", wrong);
        }
        apart += one.rows->separation > 0;
    }
    assert_true(apart > PAIRS / 10 && apart < PAIRS * 9 / 10);
}

/* The bodies that `b` names are in another set, in another order there; or body k of each set is of pair k. */
TEST(two_sets) {
    struct test_random random = test_random_named("two sets");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT64, BODIES, PAIRS);
    narc_body others[BODIES], of_a[PAIRS], of_b[PAIRS];
    uint32_t b[PAIRS];
    for (uint32_t k = 0; k < BODIES; k++)
        others[BODIES - 1 - k] = scene_body(&scene, k);
    for (size_t k = 0; k < PAIRS; k++) {
        b[k] = BODIES - 1 - scene.pairs[k].b;
        of_a[k] = scene_body(&scene, scene.pairs[k].a);
        of_b[k] = scene_body(&scene, scene.pairs[k].b);
    }
    const narc_bodies bodies = scene_bodies(&scene);
    narc_bodies other_bodies;
    narc_view_bodies(others, BODIES, &other_bodies);
    narc_bodies all_a, all_b;
    narc_view_bodies(of_a, PAIRS, &all_a);
    narc_view_bodies(of_b, PAIRS, &all_b);
    narc_bodies fewer;
    narc_view_bodies(of_b, PAIRS - 1, &fewer);
    narc_pairs pairs = {
        .count = PAIRS, .a = NARC_COLUMN(scene.pairs, a), .b = NARC_ARRAY(b), .other_bodies = &other_bodies};
    check_same_answers(&scene, &bodies, &pairs);
    check_same_answers(&scene, &all_a, &(narc_pairs){.count = PAIRS, .other_bodies = &all_b});

    /* Each index counts in its own set. */
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    narc_error error;
    b[500] = BODIES;
    expect_error(narc_find_overlaps(scene.store, &all_a, &pairs, NULL, bits, &error), NARC_ERROR_INDEX, &error,
                 "pair 500");
    pairs = (narc_pairs){.count = PAIRS, .other_bodies = &fewer};
    expect_error(narc_find_overlaps(scene.store, &all_a, &pairs, NULL, bits, &error), NARC_ERROR_INDEX, &error,
                 "pair 599");
}

/* A scene in which the bodies A, or B, or both, stand at the origin. */
static struct scene make_origin_scene(struct test_random *random, bool a, bool b) {
    const struct scene from = make_random_scene(random, NARC_FLOAT64, BODIES, PAIRS);
    struct scene scene = create_scene(NARC_FLOAT64, from.shape_count, 2 * PAIRS, PAIRS);
    for (size_t k = 0; k < from.shape_count; k++)
        scene_add_shape(&scene, &from.shapes[k]);
    for (uint32_t k = 0; k < PAIRS; k++) {
        for (int side = 0; side < 2; side++) {
            struct body body = from.bodies[side ? from.pairs[k].b : from.pairs[k].a];
            if (side ? b : a)
                body = (struct body){.cosine = 1, .scale = body.scale, .shape = body.shape};
            scene_add_body(&scene, body);
        }
        scene_add_pair(&scene, 2 * k, 2 * k + 1);
    }
    AUTO(destroy_scene) struct scene done = from;
    return scene;
}

/* Every second body of a scene from `first` on; with `shapes_only`, without poses. */
static narc_bodies find_side(const struct scene *scene, size_t first, bool shapes_only) {
    struct two {
        struct body body[2];
    } *two = (void *)(scene->bodies + first);
    narc_bodies side = {
        .count = PAIRS, .scale = NARC_COLUMN(two, body[0].scale), .shape = NARC_COLUMN(two, body[0].shape)};
    if (!shapes_only) {
        side.x = NARC_POSITION_COLUMN(two, body[0].x);
        side.y = NARC_POSITION_COLUMN(two, body[0].y);
        side.cosine = NARC_COLUMN(two, body[0].cosine);
        side.sine = NARC_COLUMN(two, body[0].sine);
    }
    return side;
}

/* Shapes by pair, one side or both without poses. */
TEST(sets_at_the_origin) {
    struct test_random random = test_random_named("sets at the origin");
    for (int sides = 1; sides < 4; sides++) {
        AUTO(destroy_scene) struct scene scene = make_origin_scene(&random, sides & 1, sides & 2);
        const narc_bodies a = find_side(&scene, 0, sides & 1), b = find_side(&scene, 1, sides & 2);
        check_same_answers(&scene, &a, &(narc_pairs){.count = PAIRS, .other_bodies = &b});
        uint32_t own[PAIRS]; /* the same by index */
        for (uint32_t k = 0; k < PAIRS; k++)
            own[k] = k;
        const narc_pairs named = {.count = PAIRS, .a = NARC_ARRAY(own), .b = NARC_ARRAY(own), .other_bodies = &b};
        check_same_answers(&scene, &a, &named);
    }
    /* In one set, too. */
    AUTO(destroy_scene) struct scene scene = make_origin_scene(&random, true, true);
    narc_bodies bodies = scene_bodies(&scene);
    const narc_bodies all = bodies;
    bodies.x = bodies.y = (narc_position_column){0};
    bodies.cosine = bodies.sine = (narc_float_column){0};
    const narc_pairs pairs = scene_pairs(&scene);
    check_same_answers(&scene, &bodies, &pairs);
    check_same_answers(&scene, &bodies, &(narc_pairs){.count = PAIRS});

    /* Some columns, but not all, are an error, of either set; so is one index column without the other. */
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    for (unsigned mask = 1; mask < 15; mask++) {
        narc_bodies some = all;
        narc_error error;
        some.x.base = mask & 1 ? some.x.base : NULL;
        some.y.base = mask & 2 ? some.y.base : NULL;
        some.cosine.base = mask & 4 ? some.cosine.base : NULL;
        some.sine.base = mask & 8 ? some.sine.base : NULL;
        const char *missing = mask & 1 ? mask & 2 ? mask & 4 ? "sine" : "cosine" : "y" : "x";
        narc_pairs of_two = pairs;
        of_two.other_bodies = &some;
        expect_error(narc_find_overlaps(scene.store, &some, &pairs, NULL, bits, &error), NARC_ERROR_ARGUMENT, &error,
                     missing);
        expect_error(narc_find_overlaps(scene.store, &all, &of_two, NULL, bits, &error), NARC_ERROR_ARGUMENT, &error,
                     missing);
    }
    for (int side = 0; side < 2; side++) {
        narc_pairs half = pairs;
        narc_error error;
        *(side ? &half.b : &half.a) = (narc_index_column){0};
        expect_error(narc_find_overlaps(scene.store, &all, &half, NULL, bits, &error), NARC_ERROR_ARGUMENT, &error,
                     side ? "b" : "a");
    }
}

/* Two boxes, by hand. */
TEST(boxes) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count, found;
    uint32_t box;
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    assert_int_equal(narc_build_box(2, 2, 0, arcs, &arc_count, NULL), NARC_OK);
    assert_int_equal(narc_add_shape(shapes, arcs, arc_count, &box, NULL), NARC_OK);
    narc_body two[] = {{.cosine = 1, .scale = 1, .shape = box}, {.x = 2.5, .cosine = 1, .scale = 1, .shape = box}};
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    const narc_pairs pairs = {.count = 1};
    const narc_query query = {.margin = INFINITY};
    narc_contact c;
    narc_manifold m;
    assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, &query, &c, 1, &found, NULL), NARC_OK);
    assert_true(c.separation == 0.5f && c.normal_x == 1 && c.normal_y == 0 && c.point_x == 1.25f && c.point_y == 0);
    assert_true(c.feature == 0x4240 && c.radius_a == INFINITY && c.radius_b == INFINITY);
    assert_int_equal(narc_find_manifolds(shapes, &bodies, &pairs, NULL, &m, 1, &found, NULL), NARC_OK);
    assert_int_equal(found, 0);
    two[1].scale = 2;
    assert_int_equal(narc_find_manifolds(shapes, &bodies, &pairs, NULL, &m, 1, &found, NULL), NARC_OK);
    assert_int_equal(m.count, 2);
    assert_true(m.point[0].separation == -0.5f && m.point[1].separation == -0.5f);
    /* Too far: no answer. */
    two[1].x = 1e18;
    const narc_contact no_contact = {.separation = INFINITY};
    const narc_manifold no_manifold = {.point = {{.separation = INFINITY}}};
    assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, &query, &c, 1, &found, NULL), NARC_OK);
    assert_memory_equal(&c, &no_contact, sizeof c);
    assert_int_equal(narc_find_manifolds(shapes, &bodies, &pairs, &query, &m, 1, &found, NULL), NARC_OK);
    assert_memory_equal(&m, &no_manifold, sizeof m);
    check_two(shapes, two);
}

/* What is broken has no answer; a wrong call has its error, and nothing is written. */
TEST(two_bodies_that_are_wrong) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count, skipped = 9;
    narc_error error;
    expect_ok(narc_create_shapes(NULL, &shapes), &error);
    expect_ok(narc_build_box(2, 2, 0, arcs, &arc_count, NULL), &error);
    expect_ok(narc_add_shape(shapes, arcs, arc_count, NULL, NULL), &error);
    const narc_body fine = {.cosine = 1, .scale = 1};
    const narc_body broken[] = {{.x = NAN, .cosine = 1, .scale = 1},
                                {.y = INFINITY, .cosine = 1, .scale = 1},
                                {.cosine = 1.1f, .scale = 1},
                                {.cosine = 1, .scale = NAN},
                                {.cosine = 1, .sine = NAN, .scale = 1},
                                {.cosine = 1, .scale = -1},
                                {.cosine = 1, .scale = 1e30f, .shape = 0},
                                {.cosine = 1, .scale = 0},
                                {.x = 1e300, .cosine = 1, .scale = 1e-30f}};
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        const narc_body two[] = {fine, broken[k]}, turned[] = {broken[k], fine};
        narc_contact contact = {.pair = 7, .count = 3};
        check_two(shapes, two);
        check_two(shapes, turned);
        expect_ok(
            narc_find_contact(shapes, &fine, &broken[k], &(narc_query){.out_skipped = &skipped}, &contact, &error),
            &error);
        assert_true(skipped == 1 && contact.pair == 0 && contact.count == 0);
    }
    const narc_body nowhere = {.cosine = 1, .scale = 1, .shape = 1};
    static int something;
    const struct {
        const narc_shapes *shapes;
        const narc_body *a, *b;
        narc_query query;
        bool to_nothing;
        narc_status status;
        const char *text;
    } cases[] = {
        {NULL, &fine, &fine, {.margin = 0}, false, NARC_ERROR_ARGUMENT, "shapes is NULL"},
        {shapes, NULL, &fine, {.margin = 0}, false, NARC_ERROR_ARGUMENT, "a is NULL"},
        {shapes, &fine, NULL, {.margin = 0}, false, NARC_ERROR_ARGUMENT, "b is NULL"},
        {shapes, &fine, &fine, {.margin = 0}, true, NARC_ERROR_ARGUMENT, "out_row is NULL"},
        {shapes, &fine, &nowhere, {.margin = 0}, false, NARC_ERROR_INDEX, "shape 1"},
        {shapes, &nowhere, &fine, {.margin = 0}, false, NARC_ERROR_INDEX, "shape 1"},
        {shapes, &fine, &fine, {.margin = NAN}, false, NARC_ERROR_NOT_FINITE, "query.margin"},
        {shapes, &fine, &fine, {.second_margin = NAN}, false, NARC_ERROR_NOT_FINITE, "query.second_margin"},
        {shapes, &fine, &fine, {.flat_angle = NAN}, false, NARC_ERROR_NOT_FINITE, "query.flat_angle"},
        {shapes, &fine, &fine, {.flat_angle = 2}, false, NARC_ERROR_ARGUMENT, "query.flat_angle"},
        {shapes, &fine, &fine, {.reserved = {NULL, &something}}, false, NARC_ERROR_ARGUMENT, "query.reserved[1]"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        narc_query query = cases[k].query;
        narc_contact contact;
        narc_manifold manifold;
        memset(&contact, 0x5a, sizeof contact);
        memset(&manifold, 0x5a, sizeof manifold);
        const narc_contact contact_before = contact;
        const narc_manifold manifold_before = manifold;
        skipped = 9;
        query.out_skipped = &skipped;
        expect_error(narc_find_contact(cases[k].shapes, cases[k].a, cases[k].b, &query,
                                       cases[k].to_nothing ? NULL : &contact, &error),
                     cases[k].status, &error, cases[k].text);
        expect_error(narc_find_manifold(cases[k].shapes, cases[k].a, cases[k].b, &query,
                                        cases[k].to_nothing ? NULL : &manifold, &error),
                     cases[k].status, &error, cases[k].text);
        assert_true(skipped == 9);
        assert_memory_equal(&contact, &contact_before, sizeof contact);
        assert_memory_equal(&manifold, &manifold_before, sizeof manifold);
    }
}

static void check_direct(const struct scene *scene, const narc_query *query, const struct contacts *all,
                         const struct manifolds *points) {
    for (size_t k = 0; k < scene->pair_count; k++) {
        const narc_body a = scene_body(scene, scene->pairs[k].a), b = scene_body(scene, scene->pairs[k].b);
        narc_contact contact;
        narc_manifold manifold;
        narc_error error;
        expect_ok(narc_find_contact(scene->store, &a, &b, query, &contact, &error), &error);
        expect_ok(narc_find_manifold(scene->store, &a, &b, query, &manifold, &error), &error);
        contact.pair = manifold.pair = (uint32_t)k;
        assert_memory_equal(&contact, &all->rows[k], sizeof contact);
        assert_memory_equal(&manifold, &points->rows[k], sizeof manifold);
    }
}

/* Everything there is in the hardest places, asked directly, has the rows of the whole batch. */
TEST(hard_places) {
    static const float margins[] = {INFINITY, 0, 0.25f, -0.1f};
    for (size_t q = 0; q < 8; q++) {
        AUTO(destroy_corpus)
        struct corpus corpus = make_corpus("two bodies", q % 2 ? NARC_FLOAT64 : NARC_FLOAT32, 0.5, q % 4 > 1);
        const struct scene *scene = &corpus.scene;
        const narc_bodies bodies = scene_bodies(scene);
        const narc_pairs pairs = scene_pairs(scene);
        narc_query query = {.margin = margins[q / 2], .dense = 1, .flat_angle = q == 1 ? 0.2f : 0};
        AUTO(free_at) struct contacts all = find_contacts(scene->store, &bodies, &pairs, &query);
        AUTO(free_at) struct manifolds points = find_manifolds(scene->store, &bodies, &pairs, &query);
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            if (!narc_isa_supported(narc_isa_name(isa)))
                continue;
            test_use_isa(narc_isa_name(isa));
            check_direct(scene, &query, &all, &points);
        }
        test_use_isa(test_isa());
    }
}

/* Shapes that one pair has ways of its own for: circles, boxes, capsules about their origins, and polygons of corners of
 * one radius. */
static size_t add_known_kinds(narc_shapes *store, struct test_random *random) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    size_t count;
    expect_ok(narc_build_circle(1, arcs, &count, &error), &error);
    expect_ok(narc_add_shape(store, arcs, count, NULL, &error), &error);
    expect_ok(narc_build_circle(0.25, arcs, &count, &error), &error);
    expect_ok(narc_add_shape(store, arcs, count, NULL, &error), &error);
    expect_ok(narc_build_box(2, 1, 0, arcs, &count, &error), &error);
    expect_ok(narc_add_shape(store, arcs, count, NULL, &error), &error);
    expect_ok(narc_build_box(1, 1, 0.2, arcs, &count, &error), &error);
    expect_ok(narc_add_shape(store, arcs, count, NULL, &error), &error);
    expect_ok(narc_build_capsule(2, 0.5, arcs, &count, &error), &error);
    expect_ok(narc_add_shape(store, arcs, count, NULL, &error), &error);
    for (size_t sides = 3; sides <= 9; sides++)
        for (int kind = 0; kind < 3; kind++) {
            narc_arc moved[NARC_MAX_ARCS];
            const double x = kind == 2 ? random_between(random, -1, 1) : 0;
            expect_ok(narc_build_regular_polygon(sides, 1, kind == 0 ? 0 : 0.2, arcs, &count, &error), &error);
            expect_ok(narc_move_arcs(arcs, count, x, -x, 5 * x, 1, moved, &error), &error);
            expect_ok(narc_add_shape(store, moved, count, NULL, &error), &error);
        }
    return narc_count_shapes(store);
}

/* Bodies whose sides are parallel or nearly so, along an axis of the other one or not, within its reach. */
static void place_beside(struct test_random *random, size_t shapes, narc_body two[2]) {
    const double quarter = 1.5707963267948966, turn = quarter * (double)random_below(random, 9) / 2;
    const double tilt =
        random_below(random, 2) ? random_between(random, -1, 1) * ldexp(1, -(int)random_below(random, 26)) : 0;
    const double way =
        random_below(random, 2) ? quarter * (double)random_below(random, 4) : random_between(random, 0, 6.3);
    for (int side = 0; side < 2; side++) {
        const double angle = side ? turn + tilt : random_below(random, 2) ? 0 : turn;
        two[side] = (narc_body){0, 0, (float)cos(angle), (float)sin(angle), 1, (uint32_t)random_below(random, shapes)};
        if (angle == 0 && random_below(random, 2))
            two[side].sine = -0.0f;
        if (random_below(random, 3) == 0)
            two[side].scale = (float)random_log_between(random, 0.25, 4);
    }
    const double distance = (two[0].scale + two[1].scale) * random_unit(random) * 1.2;
    two[1].x = distance * cos(way);
    two[1].y = random_below(random, 4) ? distance * sin(way) : random_below(random, 2) ? 0.0 : -0.0;
    if (random_below(random, 50) == 0)
        *(random_below(random, 2) ? &two[0].cosine : &two[1].scale) = random_below(random, 2) ? NAN : 0;
}

/* Was no arithmetic of a pair invalid but that of NaN, and of bodies in one place up to rounding, whose direction is 0 / 0? On
 * x86, where a process may trap it. */
static bool was_valid(const narc_body two[2]) {
#if defined(__x86_64__)
    return !fetestexcept(FE_INVALID) || isnan(two[0].cosine) || isnan(two[1].scale) ||
           fabs(two[1].x) + fabs(two[1].y) < 1e-9;
#else
    (void)two;
    return true;
#endif
}

/* Circles and polygons with round corners by themselves have the bits that they have among many, signs of zeros too. */
TEST(kinds_with_ways_of_their_own) {
    enum { MANY = 4000 };
    struct test_random random = test_random_named("kinds with ways of their own");
    AUTO(narc_destroy_shapes_at) narc_shapes *store = NULL;
    assert_int_equal(narc_create_shapes(NULL, &store), NARC_OK);
    const size_t shapes = add_known_kinds(store, &random);
    AUTO(free_at) narc_body *const rows = malloc(2 * MANY * sizeof *rows);
    assert_non_null(rows);
    narc_bodies bodies;
    narc_view_bodies(rows, 2 * MANY, &bodies);
    for (size_t trial = 0; trial < test_trials(3); trial++) {
        const narc_query query = {.margin = trial % 3 == 0 ? INFINITY : trial % 3 == 1 ? 0 : 0.1f, .dense = 1};
        for (size_t k = 0; k < MANY; k++)
            place_beside(&random, shapes, &rows[2 * k]);
        AUTO(free_at) struct contacts all = find_contacts(store, &bodies, &(narc_pairs){.count = MANY}, &query);
        AUTO(free_at) struct manifolds points = find_manifolds(store, &bodies, &(narc_pairs){.count = MANY}, &query);
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            if (!narc_isa_supported(narc_isa_name(isa)))
                continue;
            test_use_isa(narc_isa_name(isa));
            for (size_t k = 0; k < MANY; k++) {
                narc_contact contact;
                narc_manifold manifold;
                narc_error error;
                feclearexcept(FE_ALL_EXCEPT);
                expect_ok(narc_find_contact(store, &rows[2 * k], &rows[2 * k + 1], &query, &contact, &error), &error);
                expect_ok(narc_find_manifold(store, &rows[2 * k], &rows[2 * k + 1], &query, &manifold, &error), &error);
                assert_true(was_valid(&rows[2 * k]));
                contact.pair = manifold.pair = (uint32_t)k;
                assert_memory_equal(&contact, &all.rows[k], sizeof contact);
                assert_memory_equal(&manifold, &points.rows[k], sizeof manifold);
                if (query.margin < INFINITY || contact.count == 0)
                    continue;
                const narc_query just = {.margin = nextafterf(all.rows[k].separation, INFINITY)},
                                 not = {.margin = all.rows[k].separation};
                expect_ok(narc_find_contact(store, &rows[2 * k], &rows[2 * k + 1], &just, &contact, &error), &error);
                contact.pair = (uint32_t)k;
                assert_memory_equal(&contact, &all.rows[k], sizeof contact);
                expect_ok(narc_find_contact(store, &rows[2 * k], &rows[2 * k + 1], &not, &contact, &error), &error);
                assert_int_equal(contact.count, 0);
            }
        }
        test_use_isa(test_isa());
    }
}

/* One pair or two of a batch have the rows that they have among all, listed, dense and in larger structures, with margins
 * and shifts of their own. */
TEST(few_of_a_batch) {
    struct test_random random = test_random_named("few of a batch");
    struct slot {
        float own;
        narc_manifold row;
    } slots[PAIRS];
    for (int precision = 0; precision < 4; precision++) {
        AUTO(destroy_scene)
        struct scene scene = make_random_scene(&random, precision % 2 ? NARC_FLOAT64 : NARC_FLOAT32, BODIES, PAIRS);
        const narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        static float margins[PAIRS], shifts[PAIRS], separations[PAIRS];
        for (size_t k = 0; k < PAIRS; k++) {
            margins[k] = k % 3 ? k % 5 ? 0.2f * (float)(k % 4) : INFINITY : k % 7 ? -0.01f : NAN;
            shifts[k] = 0.25f * (float)(k % 3);
        }
        if (precision > 1)
            pairs.shift_y = NARC_ARRAY(shifts);
        narc_query query = {.margins = NARC_ARRAY(margins), .dense = 1};
        AUTO(free_at) struct contacts all = find_contacts(scene.store, &bodies, &pairs, &query);
        AUTO(free_at) struct manifolds points = find_manifolds(scene.store, &bodies, &pairs, &query);
        query.row_stride = sizeof *slots;
        for (size_t k = 0; k + 1 < PAIRS; k++) {
            const uint32_t selection[] = {(uint32_t)k, (uint32_t)(PAIRS - 1 - k)};
            narc_query few = {.margins = query.margins};
            size_t skipped, found, expected = 0;
            narc_contact row[2];
            narc_error error;
            few.out_skipped = &skipped;
            few.selection = NARC_ARRAY(selection);
            few.selection_count = 1 + k % 2;
            expect_ok(narc_find_contacts(scene.store, &bodies, &pairs, &few, row, 2, &found, &error), &error);
            expect_ok(narc_find_separations(scene.store, &bodies, &pairs, &few, separations, &error), &error);
            for (size_t i = 0; i < few.selection_count; i++) {
                const narc_contact *const right = &all.rows[selection[i]];
                const bool has_row = right->count > 0 || right->separation > 0;
                assert_true(separations[selection[i]] == (has_row ? right->separation : INFINITY));
                if (has_row)
                    assert_memory_equal(&row[expected++], right, sizeof *right);
            }
            assert_int_equal(found, expected);
            few = query;
            few.out_skipped = &skipped;
            few.first = k;
            few.count = 2;
            memset(slots, 0x5a, sizeof slots);
            expect_ok(narc_find_manifolds(scene.store, &bodies, &pairs, &few, &slots[0].row, PAIRS, &found, &error),
                      &error);
            for (size_t i = k; i < k + 2; i++)
                assert_memory_equal(&slots[i].row, &points.rows[i], sizeof slots->row);
            assert_int_equal(found, (points.rows[k].count > 0) + (points.rows[k + 1].count > 0));
            assert_true(skipped >= (isnan(margins[k]) ? 1u : 0u) + (isnan(margins[k + 1]) ? 1u : 0u));
            const unsigned char *const behind = (const void *)&slots[k + 2 < PAIRS ? k + 2 : 0];
            assert_true(behind[0] == 0x5a && behind[sizeof *slots - 1] == 0x5a);
        }
    }
}

/* Where the second pair of two is an error, rows and counts stay as they were. */
TEST(an_error_behind_an_answer) {
    struct test_random random = test_random_named("an error behind an answer");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    const uint32_t a[] = {0, 1}, b[] = {0, BODIES};
    const float motion[BODIES] = {0};
    const narc_pairs pairs = {.count = 2, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    const narc_motions motions = {.x = NARC_ARRAY(motion)};
    narc_contact contacts[2], none[2];
    narc_manifold manifolds[2];
    narc_impact impacts[2];
    size_t found = 7;
    memset(none, 0x5a, sizeof none);
    memset(contacts, 0x5a, sizeof contacts);
    memset(manifolds, 0x5a, sizeof manifolds);
    memset(impacts, 0x5a, sizeof impacts);
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, NULL, contacts, 2, &found, NULL),
                     NARC_ERROR_INDEX);
    assert_int_equal(narc_find_manifolds(scene.store, &bodies, &pairs, NULL, manifolds, 2, &found, NULL),
                     NARC_ERROR_INDEX);
    assert_int_equal(narc_cast_pairs(scene.store, &bodies, &motions, &pairs, NULL, NULL, impacts, 2, NULL),
                     NARC_ERROR_INDEX);
    assert_int_equal(found, 7);
    assert_memory_equal(contacts, none, sizeof contacts);
    assert_memory_equal(manifolds, none, sizeof none);
    assert_memory_equal(impacts, none, sizeof none);
}

TEST_MAIN("pair")
