/* SPDX-License-Identifier: MIT
 *
 * cast_shapes.c - movers through an index against casts of all pairs, one by one; the same bits with any workers and on
 * every instruction set; casts whose answers are known; what is refused.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "ledger.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "scene.h"

enum { MOVERS = 300 };

struct motion {
    float x, y, angle;
};

/* Bodies that stand, those that move, and an index of the former. */
struct stage {
    struct scene scene, movers;
    struct motion *motion;
    narc_index *index;
    uint64_t *category, *mask;
    uint32_t *ignored;
    float target, *targets; /* of each mover, if `varied` */
    bool varied;
};

static struct stage make_stage(struct test_random *random, narc_precision precision, size_t bodies, bool turning) {
    struct stage s = {.scene = make_random_scene(random, precision, bodies, bodies > 0)};
    s.movers = s.scene;
    s.movers.bodies = calloc(MOVERS, sizeof *s.movers.bodies);
    s.movers.body_count = MOVERS;
    s.motion = calloc(MOVERS, sizeof *s.motion);
    s.category = calloc(bodies + 1, sizeof *s.category);
    s.mask = calloc(MOVERS, sizeof *s.mask);
    s.ignored = calloc(MOVERS, sizeof *s.ignored);
    s.targets = calloc(MOVERS, sizeof *s.targets);
    const double width = sqrt((double)bodies) * 2.5;
    for (size_t k = 0; k < bodies; k++) {
        struct body *const body = &s.scene.bodies[k];
        body->x = random_between(random, 0, width);
        body->y = random_between(random, 0, width);
        body->scale *= 0.4f;
        round_position(body, precision);
        if (k % 40 == 7)
            *body = fly_away(*body, k / 40, precision);
        s.category[k] = (uint64_t)1 << random_below(random, 64);
    }
    for (size_t k = 0; k < MOVERS; k++) {
        struct body body = turned_body(random_between(random, -4, 4), random_log_between(random, 0.05, 1));
        const double angle = random_between(random, -4, 4), way = random_log_between(random, 0.01, width);
        body.x = random_between(random, 0, width);
        body.y = random_between(random, 0, width);
        body.shape = (uint32_t)random_below(random, s.scene.shape_count);
        round_position(&body, precision);
        s.movers.bodies[k] = body;
        s.motion[k] = (struct motion){(float)(way * cos(angle)), (float)(way * sin(angle)), 0};
        if (turning && k % 3)
            s.motion[k].angle = (float)random_between(random, -4, 4);
        s.mask[k] = k % 4 ? UINT64_MAX : random_bits(random);
        s.ignored[k] = bodies > 0 && k % 2 ? (uint32_t)random_below(random, bodies) : UINT32_MAX;
    }
    const narc_bodies all = scene_bodies(&s.scene);
    narc_box *const boxes = calloc(bodies + 1, sizeof *boxes);
    narc_error error;
    assert_int_equal(narc_create_index(NULL, &s.index), NARC_OK);
    if (bodies > 0)
        expect_ok(narc_compute_boxes(s.scene.store, &all, NULL, boxes, &error), &error);
    const narc_index_options options = {.category = {s.category, sizeof *s.category}};
    expect_ok(narc_build_index(s.index, boxes, bodies, &options, &error), &error);
    free(boxes);
    return s;
}

static void destroy_stage(struct stage *s) {
    narc_destroy_index(s->index);
    free(s->movers.bodies);
    free(s->motion);
    free(s->category);
    free(s->mask);
    free(s->ignored);
    free(s->targets);
    destroy_scene(&s->scene);
}

static narc_motions motions_of(const struct stage *s) {
    return (narc_motions){
        .x = NARC_COLUMN(s->motion, x), .y = NARC_COLUMN(s->motion, y), .angle = NARC_COLUMN(s->motion, angle)};
}

static narc_impact *cast(const struct stage *s, bool filtered, unsigned threads) {
    const narc_bodies bodies = scene_bodies(&s->scene), movers = scene_bodies(&s->movers);
    const narc_motions motions = motions_of(s);
    const narc_workers workers = narc_openmp_workers(threads);
    narc_index_query search = {.workers = &workers};
    if (filtered) {
        search.mask = (narc_word_column){s->mask, sizeof *s->mask};
        search.ignored = (narc_index_column){s->ignored, sizeof *s->ignored};
    }
    size_t skipped = 9;
    narc_cast_options options = {.target = s->target, .out_skipped = &skipped};
    if (s->varied)
        options.targets = (narc_float_column){s->targets, sizeof *s->targets};
    narc_impact *const rows = guard_allocate(MOVERS * sizeof *rows);
    narc_error error;
    expect_ok(
        narc_cast_shapes(s->index, s->scene.store, &bodies, &movers, &motions, &search, &options, rows, MOVERS, &error),
        &error);
    assert_int_equal(skipped, 0);
    return rows;
}

/* The least (fraction, body) of casts against each body. */
static size_t check_by_force(const struct stage *s, const narc_impact *rows, bool filtered) {
    const narc_bodies bodies = scene_bodies(&s->scene), movers = scene_bodies(&s->movers);
    const narc_motions motions = motions_of(s);
    const size_t count = s->scene.body_count;
    uint32_t *const a = calloc(count, sizeof *a), *const b = calloc(count, sizeof *b);
    narc_impact *const all = calloc(count, sizeof *all);
    size_t hits = 0;
    narc_error error;
    for (uint32_t k = 0; k < MOVERS; k++) {
        const narc_cast_options options = {.target = s->varied ? s->targets[k] : s->target};
        narc_impact best = {.pair = k};
        for (uint32_t i = 0; i < count; i++) {
            a[i] = k;
            b[i] = i;
        }
        const narc_pairs pairs = {.count = count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &bodies};
        expect_ok(narc_cast_pairs(s->scene.store, &movers, &motions, &pairs, NULL, &options, all, count, &error),
                  &error);
        for (size_t i = 0; i < count; i++)
            if (all[i].count && (!best.count || all[i].fraction < best.fraction) &&
                !(filtered && (s->ignored[k] == i || !(s->category[i] & s->mask[k])))) {
                best = all[i];
                best.pair = k;
            }
        assert_memory_equal(&rows[k], &best, sizeof best);
        hits += best.count == NARC_CAST_HIT;
    }
    free(a);
    free(b);
    free(all);
    return hits;
}

TEST(test_by_force) {
    struct test_random random = test_random_named("cast shapes"), of_targets = test_random_named("targets");
    static const size_t counts[] = {1, 7, 64, 300};
    for (int round = 0; round < 8; round++) {
        struct stage s = make_stage(&random, (narc_precision)(round % 2), counts[round / 2], true);
        s.target = round == 3 ? -0.02f : round == 5 ? 0.1f : 0;
        s.varied = round % 4 == 2;
        for (size_t k = 0; k < MOVERS; k++)
            s.targets[k] = k % 3 == 0 ? 0 : (float)random_between(&of_targets, -0.1, 0.3);
        for (int filtered = 0; filtered < 2; filtered++) {
            narc_impact *const rows = cast(&s, filtered, 1), *const shared = cast(&s, filtered, 3);
            assert_memory_equal(rows, shared, MOVERS * sizeof *rows);
            const size_t hits = check_by_force(&s, rows, filtered);
            if (round >= 4 && !filtered)
                assert_in_range(hits, MOVERS / 4, MOVERS - 1);
            guard_release(shared);
            guard_release(rows);
        }
        destroy_stage(&s);
    }
}

/* One target for each pair: the rows of casts with that target alone, whatever the pair's bodies. */
TEST(test_targets_of_pairs) {
    enum { PAIRS = 2000 };
    struct test_random random = test_random_named("targets of pairs");
    struct stage s = make_stage(&random, NARC_FLOAT64, 40, true);
    const narc_bodies bodies = scene_bodies(&s.scene), movers = scene_bodies(&s.movers);
    const narc_motions motions = motions_of(&s);
    float targets[PAIRS][2]; /* a column with a stride */
    uint32_t a[PAIRS], b[PAIRS];
    narc_impact rows[PAIRS], alone;
    size_t hits = 0;
    narc_error error;
    for (int k = 0; k < PAIRS; k++) {
        a[k] = (uint32_t)random_below(&random, MOVERS);
        b[k] = (uint32_t)random_below(&random, 40);
        targets[k][0] = random_below(&random, 4) ? (float)random_between(&random, -0.2, 4) : 0;
    }
    narc_pairs pairs = {.count = PAIRS, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &bodies};
    const narc_cast_options options = {.target = 100, .targets = {targets[0], sizeof targets[0]}};
    expect_ok(narc_cast_pairs(s.scene.store, &movers, &motions, &pairs, NULL, &options, rows, PAIRS, &error), &error);
    pairs.count = 1;
    for (uint32_t k = 0; k < PAIRS; k++) {
        pairs.a.base = &a[k];
        pairs.b.base = &b[k];
        const narc_cast_options one = {.target = targets[k][0]};
        expect_ok(narc_cast_pairs(s.scene.store, &movers, &motions, &pairs, NULL, &one, &alone, 1, &error), &error);
        alone.pair = k;
        assert_memory_equal(&rows[k], &alone, sizeof alone);
        hits += alone.count == NARC_CAST_HIT && alone.fraction > 0;
    }
    assert_true(hits > PAIRS / 100);
    destroy_stage(&s);
}

TEST(test_no_bodies) {
    struct test_random random = test_random_named("no bodies");
    struct stage s = make_stage(&random, NARC_FLOAT32, 0, true);
    narc_impact *const rows = cast(&s, false, 1);
    for (uint32_t k = 0; k < MOVERS; k++) {
        const narc_impact none = {.pair = k};
        assert_memory_equal(&rows[k], &none, sizeof none);
    }
    guard_release(rows);
    destroy_stage(&s);
}

/* Movers that are broken, or whose motion is, hit nothing and are counted. */
TEST(test_broken_movers) {
    struct test_random random = test_random_named("broken movers");
    struct stage s = make_stage(&random, NARC_FLOAT32, 100, true);
    narc_impact *const right = cast(&s, false, 1);
    const narc_bodies bodies = scene_bodies(&s.scene), movers = scene_bodies(&s.movers);
    const narc_motions motions = motions_of(&s);
    s.movers.bodies[3].x_single = NAN;
    s.movers.bodies[10].cosine = 2;
    s.movers.bodies[11].scale = -1;
    s.motion[20].x = NAN;
    s.motion[21].y = INFINITY;
    s.motion[22].angle = NAN;
    s.motion[23].angle = -INFINITY;
    static const uint32_t broken[] = {3, 10, 11, 20, 21, 22, 23};
    size_t skipped = 0, next = 0;
    const narc_cast_options options = {.out_skipped = &skipped};
    narc_impact rows[MOVERS];
    narc_error error;
    expect_ok(
        narc_cast_shapes(s.index, s.scene.store, &bodies, &movers, &motions, NULL, &options, rows, MOVERS, &error),
        &error);
    assert_int_equal(skipped, 7);
    for (uint32_t k = 0; k < MOVERS; k++) {
        const narc_impact none = {.pair = k};
        const bool is_broken = next < 7 && broken[next] == k;
        next += is_broken;
        assert_memory_equal(&rows[k], is_broken ? &none : &right[k], sizeof none);
    }
    guard_release(right);
    destroy_stage(&s);
}

TEST(test_errors) {
    struct test_random random = test_random_named("errors");
    struct stage s = make_stage(&random, NARC_FLOAT32, 10, false);
    const narc_bodies bodies = scene_bodies(&s.scene), movers = scene_bodies(&s.movers);
    narc_bodies fewer = bodies, wrong = movers;
    const narc_motions motions = motions_of(&s);
    narc_impact *const rows = make_junk(MOVERS * sizeof *rows);
    narc_shapes *const store = s.scene.store;
    narc_error e;
    fewer.count--;
    wrong.reserved[1] = rows;
#define REFUSED(status, words, ...) expect_error(narc_cast_shapes(__VA_ARGS__, rows, MOVERS, &e), status, &e, words)
    REFUSED(NARC_ERROR_ARGUMENT, "index is NULL", NULL, store, &bodies, &movers, &motions, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "shapes is NULL", s.index, NULL, &bodies, &movers, &motions, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "movers is NULL", s.index, store, &bodies, NULL, &motions, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "9 bodies, but the index was built from 10 boxes", s.index, store, &fewer, &movers,
            &motions, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "bodies.reserved[1]", s.index, store, &bodies, &wrong, &motions, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "tolerance", s.index, store, &bodies, &movers, &motions, NULL,
            (&(narc_cast_options){.tolerance = -1}));
    REFUSED(NARC_ERROR_NOT_FINITE, "target", s.index, store, &bodies, &movers, &motions, NULL,
            (&(narc_cast_options){.target = NAN}));
    REFUSED(NARC_ERROR_NOT_FINITE, "tolerance", s.index, store, &bodies, &movers, &motions, NULL,
            (&(narc_cast_options){.tolerance = INFINITY}));
    REFUSED(NARC_ERROR_ARGUMENT, "options.reserved[0]", s.index, store, &bodies, &movers, &motions, NULL,
            (&(narc_cast_options){.reserved = {rows}}));
    s.targets[7] = NAN;
    REFUSED(NARC_ERROR_NOT_FINITE, "options.targets[7] is nan", s.index, store, &bodies, &movers, &motions, NULL,
            (&(narc_cast_options){.targets = NARC_ARRAY(s.targets)}));
    s.targets[7] = 0;
    REFUSED(NARC_ERROR_ARGUMENT, "motions.reserved[0]", s.index, store, &bodies, &movers,
            (&(narc_motions){.reserved = {rows}}), NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "search.reserved[0]", s.index, store, &bodies, &movers, &motions,
            (&(narc_index_query){.reserved = {rows}}), NULL);
    expect_error(narc_cast_shapes(s.index, store, &bodies, &movers, &motions, NULL, NULL, rows, MOVERS - 1, &e),
                 NARC_ERROR_CAPACITY, &e, "300 rows");
    expect_error(narc_cast_shapes(s.index, store, &bodies, &movers, &motions, NULL, NULL, NULL, MOVERS, &e),
                 NARC_ERROR_ARGUMENT, &e, "out_rows is NULL");
    s.movers.bodies[5].shape = 1000000;
    REFUSED(NARC_ERROR_INDEX, "body 5: shape is 1000000", s.index, store, &bodies, &movers, &motions, NULL, NULL);
#undef REFUSED
    const narc_pairs pairs = {.count = 2}, others = {.count = 2, .other_bodies = &bodies};
#define REFUSED(status, words, ...) expect_error(narc_cast_pairs(__VA_ARGS__, rows, MOVERS, &e), status, &e, words)
    REFUSED(NARC_ERROR_ARGUMENT, "shapes is NULL", NULL, &bodies, &motions, &pairs, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "pairs is NULL", store, &bodies, &motions, NULL, NULL, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "other_motions", store, &bodies, &motions, &pairs, &motions, NULL);
    REFUSED(NARC_ERROR_ARGUMENT, "other_motions.reserved[1]", store, &bodies, &motions, &others,
            (&(narc_motions){.reserved = {NULL, rows}}), NULL);
    REFUSED(NARC_ERROR_NOT_FINITE, "options.targets[1] is -inf", store, &bodies, &motions, &pairs, NULL,
            (&(narc_cast_options){.targets = NARC_ARRAY(((const float[]){0, -INFINITY}))}));
    REFUSED(NARC_ERROR_ARGUMENT, "tolerance is -2", store, &bodies, &motions, &pairs, NULL,
            (&(narc_cast_options){.tolerance = -2}));
#undef REFUSED
    expect_error(narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, NULL, rows, 1, &e), NARC_ERROR_CAPACITY, &e,
                 "2 rows");
    expect_error(narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, NULL, NULL, 2, &e), NARC_ERROR_ARGUMENT, &e,
                 "out_rows is NULL");
    s.movers.bodies[5].shape = 0;
    struct ledger ledger = {0};
    const narc_allocator allocator = ledger_allocator(&ledger);
    narc_box boxes[10];
    narc_index *poor = NULL;
    expect_ok(narc_create_index(&allocator, &poor), &e);
    expect_ok(narc_compute_boxes(store, &bodies, NULL, boxes, &e), &e);
    expect_ok(narc_build_index(poor, boxes, 10, NULL, &e), &e);
    ledger.limited = true;
    expect_error(narc_cast_shapes(poor, store, &bodies, &movers, &motions, NULL, NULL, rows, MOVERS, &e),
                 NARC_ERROR_MEMORY, &e, "no memory for 300 movers");
    narc_destroy_index(poor);
    assert_true(is_junk(rows, MOVERS * sizeof *rows));
    expect_ok(narc_cast_pairs(store, &bodies, NULL, &(narc_pairs){0}, NULL, NULL, NULL, 0, &e), &e);
    free(rows);
    destroy_stage(&s);
}

/* ------------------------------------------------------------------------------------------------ known */

/* Casts one pair of boxes, the first of which moves. */
static narc_impact cast_boxes(struct body a, struct body b, struct motion motion, const narc_cast_options *options) {
    narc_shapes *const store = empty_store();
    store_shape(store, box_of(2, 2, 0));
    store_shape(store, box_of(8, 0.125, 0));
    const narc_body rows[2] = {{a.x, a.y, a.cosine, a.sine, a.scale, a.shape},
                               {b.x, b.y, b.cosine, b.sine, b.scale, b.shape}};
    const float motions[2][3] = {{motion.x, motion.y, motion.angle}};
    const narc_bodies bodies = narc_view_bodies(rows, 2);
    const narc_motions moving = {{&motions[0][0], sizeof motions[0]},
                                 {&motions[0][1], sizeof motions[0]},
                                 {&motions[0][2], sizeof motions[0]},
                                 {NULL}};
    narc_impact impact;
    narc_error error;
    expect_ok(narc_cast_pairs(store, &bodies, &moving, &(narc_pairs){.count = 1}, NULL, options, &impact, 1, &error),
              &error);
    narc_destroy_shapes(store);
    return impact;
}

static struct body at(double x, double y, double angle, uint32_t shape) {
    struct body body = turned_body(angle, 1);
    body.x = x;
    body.y = y;
    body.shape = shape;
    return body;
}

#define EXPECT(found, expected, tolerance) assert_true(fabs((double)(found) - (expected)) <= (tolerance))

/* Whether bounding circles that touch overlap is a matter of rounding: what goes through the other body hits it. */
TEST(test_circles_that_touch) {
    struct test_random random = test_random_named("circles that touch");
    struct body a = at(0, 0, 0, 0), b = at(1.4142217590853303, 0.00011313774096818694, 0, 0);
    a.scale = b.scale = 0.5f;
    for (size_t k = 0; k < test_trials(20000); k++) {
        const struct motion motion = {(float)(2 * b.x), (float)(2 * b.y), k % 3 == 2 ? 0.1f : 0};
        const narc_impact impact = cast_boxes(a, b, motion, NULL);
        assert_true(impact.count == NARC_CAST_HIT && impact.fraction < 0.5f);
        const double angle = random_between(&random, 0, 6.3);
        b.x = 1.4142217590853303 * cos(angle) * (1 + 1e-16 * random_between(&random, -4, 4));
        b.y = 1.4142217590853303 * sin(angle);
    }
}

/* A body that turns hits what is as near as the tolerance says: whatever boxes the index has. */
TEST(test_loose_boxes) {
    narc_shapes *const store = empty_store();
    store_shape(store, box_of(1, 1, 0));
    const narc_body body = {0, 0, 1, 0, 1, 0}, mover = {-5, 1.3, 1, 0, 1, 0};
    const narc_bodies bodies = narc_view_bodies(&body, 1), movers = narc_view_bodies(&mover, 1);
    const float x = 10, angle = 0.001f;
    const narc_motions motions = {.x = {&x, 0}, .angle = {&angle, 0}};
    const narc_cast_options options = {.tolerance = 0.5f};
    narc_box box;
    narc_impact impact[2];
    narc_index *index;
    narc_error error;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_compute_boxes(store, &bodies, NULL, &box, &error), &error);
    for (int k = 0; k < 2; k++) {
        box.max_y += (float)k;
        expect_ok(narc_build_index(index, &box, 1, NULL, &error), &error);
        expect_ok(narc_cast_shapes(index, store, &bodies, &movers, &motions, NULL, &options, &impact[k], 1, &error),
                  &error);
        assert_int_equal(impact[k].count, NARC_CAST_HIT);
    }
    assert_memory_equal(&impact[0], &impact[1], sizeof impact[0]);
    narc_destroy_index(index);
    narc_destroy_shapes(store);
}

/* However fast: through an index as of the pair, and each mover's first body. Fractions underflow, so that bodies at
 * different places are hit at the same one: then the lower number counts. */
TEST(test_largest_motions) {
    enum { BODIES = 40 };
    static const float motions[] = {10, 1e10f, 1e20f, 1e30f, 1e38f, 3e38f, FLT_MAX};
    struct test_random random = test_random_named("largest motions");
    narc_shapes *const store = empty_store();
    store_shape(store, box_of(2, 2, 0));
    store_shape(store, circle_of(1));
    size_t same = 0;
    for (int round = 0; round < 7 * 8; round++) {
        const float way = (round % 2 ? -1 : 1) * motions[round % 7], turn = round % 4 ? 0 : 0.5f;
        const float size = round / 14 % 2 ? 1e-7f : 1;
        narc_body body[BODIES], mover = {0, 0, 1, 0, size, (uint32_t)(round / 7 % 2)};
        narc_box boxes[BODIES];
        uint32_t none[BODIES] = {0}, all[BODIES];
        narc_impact pairs[BODIES], first;
        size_t skipped[2];
        narc_index *index;
        narc_error error;
        for (uint32_t k = 0; k < BODIES; k++) {
            const double far = (double)size * random_log_between(&random, 2.2, 40);
            body[k] = (narc_body){random_below(&random, 2) ? far : -far, 0, 1, 0, size, k % 2};
            body[k].y = (double)size * random_between(&random, -1, 1);
            all[k] = k;
        }
        const bool up = round / 7 % 3 == 0;
        for (uint32_t k = 0; up && k < BODIES; k++)
            body[k] = (narc_body){-body[k].y, body[k].x, 0, 1, size, body[k].shape};
        const narc_bodies bodies = narc_view_bodies(body, BODIES), movers = narc_view_bodies(&mover, 1);
        const narc_float_column along = {&way, 0};
        const narc_motions moving = {
            .x = up ? (narc_float_column){0} : along, .y = up ? along : (narc_float_column){0}, .angle = {&turn, 0}};
        assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
        expect_ok(narc_compute_boxes(store, &bodies, NULL, boxes, &error), &error);
        expect_ok(narc_build_index(index, boxes, BODIES, NULL, &error), &error);
        narc_cast_options options = {.out_skipped = &skipped[0]};
        expect_ok(narc_cast_shapes(index, store, &bodies, &movers, &moving, NULL, &options, &first, 1, &error), &error);
        options.out_skipped = &skipped[1];
        const narc_pairs batch = {
            .count = BODIES, .a = NARC_ARRAY(none), .b = NARC_ARRAY(all), .other_bodies = &bodies};
        expect_ok(narc_cast_pairs(store, &movers, &moving, &batch, NULL, &options, pairs, BODIES, &error), &error);
        assert_true(skipped[0] == 0 && skipped[1] == 0);
        narc_impact best = {.count = NARC_CAST_MISS};
        for (size_t k = 0; k < BODIES; k++) {
            assert_true(pairs[k].separation >= -1e-4f * size); /* fractions are rounded down */
            same += best.count && pairs[k].count && pairs[k].fraction == best.fraction;
            if (pairs[k].count && (!best.count || pairs[k].fraction < best.fraction))
                best = pairs[k];
        }
        best.pair = 0;
        assert_int_equal(best.count, NARC_CAST_HIT);
        assert_memory_equal(&first, &best, sizeof best);
        narc_destroy_index(index);
    }
    print_message("%zu as soon as another\n", same);
    narc_destroy_shapes(store);
}

TEST(test_known) {
    const struct body left = at(0, 0, 0, 0), right = at(10, 0, 0, 0);
    narc_impact i = cast_boxes(left, right, (struct motion){16, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    assert_true(i.fraction == 0.5f && i.separation == 0 && i.normal_x == 1 && i.normal_y == 0);
    assert_true(i.point_x == 1 && i.point_y == 0 && i.body == 1 && i.pair == 0);
    i = cast_boxes(left, right, (struct motion){7.5f, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, right, (struct motion){8, 0, 0}, NULL); /* they touch as the step ends */
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 1);
    i = cast_boxes(left, right, (struct motion){16, 0, 0}, &(narc_cast_options){.target = 4});
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0.25f && i.separation == 4);
    i = cast_boxes(left, right, (struct motion){16, 0, 0}, &(narc_cast_options){.target = -1});
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0.5625f && i.separation == -1);
    i = cast_boxes(left, right, (struct motion){16, 0, 0}, &(narc_cast_options){.target = -2.5f});
    assert_int_equal(i.count, NARC_CAST_MISS); /* never so deep */
    /* At the start: touching and parting, apart and parting, deeper and parting. */
    i = cast_boxes(left, at(2, 0, 0, 0), (struct motion){-1, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0);
    i = cast_boxes(left, at(2.0625, 0, 0, 0), (struct motion){-1, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(1.5, 0, 0, 0), (struct motion){-1, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0 && i.separation == -0.5f);
    /* No motion. */
    i = cast_boxes(left, right, (struct motion){0, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(1, 0, 0, 0), (struct motion){0, 0, 0}, NULL);
    assert_true(i.count == NARC_CAST_HIT && i.fraction == 0 && i.separation == -1);
    /* It slides past, closer than half a rounding of its way, but apart. */
    i = cast_boxes(left, at(5, 2 + 1e-5, 0, 0), (struct motion){100, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    i = cast_boxes(left, at(5, 2 - 1e-5, 0, 0), (struct motion){100, 0, 0}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    EXPECT(i.fraction, 0.03, 1e-6);
    /* A bar of 8 x 1/8 turns by a quarter turn, until a corner of its end, at (4, -1/16) before, is 2 lower. */
    i = cast_boxes(at(0, 3, 0, 1), at(3.5, 0, 0, 0), (struct motion){0, 0, -1.5707963f}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    assert_true(i.separation >= 0 && i.separation <= 2.0f / 1024);
    EXPECT(i.fraction, (asin(2 / hypot(4, 0.0625)) - atan2(0.0625, 4)) / 1.57079632679, 1e-3);
    /* A whole turn beside it: the bar comes back to where it was, and was in between. */
    i = cast_boxes(at(0, 3, 0, 1), at(3.5, 0, 0, 0), (struct motion){0, 0, 6.2831853f}, NULL);
    assert_int_equal(i.count, NARC_CAST_HIT);
    i = cast_boxes(at(0, 3, 0, 1), at(8.5, 0, 0, 0), (struct motion){0, 0, 6.2831853f}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
    /* What turns in touch and parts by that. */
    i = cast_boxes(at(0, 1.0625 + 1e-4, 0, 1), at(3.5, 0, 0, 0), (struct motion){0, 1, 0.01f}, NULL);
    assert_int_equal(i.count, NARC_CAST_MISS);
}

/* ------------------------------------------------------------------------------------------------ bits */

/* The first instruction set that is asked of others is scalar. */
TEST(test_bits) {
    struct test_random random = test_random_named("bits");
    for (int turning = 0; turning < 2; turning++) {
        struct stage s = make_stage(&random, NARC_FLOAT64, 200, turning);
        narc_impact *const rows = cast(&s, false, 2);
        test_use_isa("scalar");
        narc_impact *const scalar = cast(&s, false, 1);
        test_use_isa(test_isa());
        assert_memory_equal(rows, scalar, MOVERS * sizeof *rows);
        guard_release(scalar);
        guard_release(rows);
        destroy_stage(&s);
    }
}

TEST_MAIN("cast_shapes")
