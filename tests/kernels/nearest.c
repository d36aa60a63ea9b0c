/* SPDX-License-Identifier: MIT
 *
 * nearest.c - the bodies nearest to points: an index against all distances, with all options; the same bytes on every
 * instruction set, with any workers, in any order, whatever boxes the index was built from.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "hard.h"
#include "layouts.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "scene.h"

/* ------------------------------------------------------------------------------------------------ scenes */

/* Bodies, their boxes and an index, and points to ask of. */
struct question {
    struct scene scene;
    narc_bodies bodies;
    narc_index *index;
    narc_box *boxes;
    uint64_t *category;
    size_t count;
    double *x, *y;
    float *x_single, *y_single;
    narc_points points;
};

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    assert_non_null(memory);
    return memory;
}

enum { SHAPES = 24 };

static struct scene make_scene(struct test_random *random, narc_precision precision, size_t count, double spread,
                               double away) {
    struct scene scene = create_scene(precision, SHAPES, count, 0);
    for (int k = 0; k < SHAPES; k++) {
        const struct shape shape = k < FAMILY_COUNT
                                       ? make_shape(random, (enum family)k)
                                       : make_hard_shape(random, (enum hard_family)((k - FAMILY_COUNT) % HARD_COUNT));
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < count; k++) {
        struct body body = turned_body(random_between(random, -PI, PI), random_log_between(random, 0.1, 2));
        body.shape = (uint32_t)random_below(random, SHAPES);
        body.x = away + random_between(random, -spread, spread);
        body.y = away + random_between(random, -spread, spread);
        if (random_below(random, 50) == 0) /* broken */
            *(random_below(random, 2) ? &body.x : &body.y) = NAN;
        else if (random_below(random, 20) == 0 && scene.body_count > 0) /* one more of the same: ties */
            body = scene.bodies[random_below(random, scene.body_count)];
        else if (random_below(random, 50) == 0)
            body = fly_away(body, random_below(random, 24), precision);
        scene_add_body(&scene, body);
    }
    return scene;
}

static struct question ask(struct test_random *random, narc_precision precision, size_t bodies, size_t points,
                           double spread, double away) {
    struct question q = {.scene = make_scene(random, precision, bodies, spread, away), .count = points};
    q.bodies = scene_bodies(&q.scene);
    q.boxes = allocate(bodies, sizeof *q.boxes);
    q.category = allocate(bodies, sizeof *q.category);
    q.x = allocate(points, sizeof *q.x);
    q.y = allocate(points, sizeof *q.y);
    q.x_single = allocate(points, sizeof *q.x_single);
    q.y_single = allocate(points, sizeof *q.y_single);
    for (size_t k = 0; k < bodies; k++)
        q.category[k] = (uint64_t)1 << random_below(random, 4);
    for (size_t k = 0; k < points; k++) {
        const double reach = random_below(random, 8) ? spread : spread * random_log_between(random, 1, 1e6);
        struct body at = {.x = away + random_between(random, -reach, reach),
                          .y = away + random_between(random, -reach, reach)};
        if (random_below(random, 4) == 0 && bodies > 0) { /* where a body is, in single precision perhaps not quite */
            at.x = q.scene.bodies[random_below(random, bodies)].x;
            at.y = q.scene.bodies[random_below(random, bodies)].y;
        }
        if (random_below(random, 64) == 0)
            at.x = random_below(random, 2) ? NAN : random_below(random, 2) ? 1e30 : INFINITY;
        round_position(&at, precision);
        q.x[k] = at.x;
        q.y[k] = at.y;
        q.x_single[k] = at.x_single;
        q.y_single[k] = at.y_single;
    }
    const bool single = precision == NARC_FLOAT32;
    q.points = (narc_points){.count = points,
                             .x = single ? NARC_POSITION_ARRAY(q.x_single) : NARC_POSITION_ARRAY(q.x),
                             .y = single ? NARC_POSITION_ARRAY(q.y_single) : NARC_POSITION_ARRAY(q.y)};
    q.index = index_bodies(q.scene.store, &q.bodies, NULL, q.boxes);
    return q;
}

static void forget(struct question *q) {
    narc_destroy_index(q->index);
    destroy_scene(&q->scene);
    free(q->boxes);
    free(q->category);
    free(q->x);
    free(q->y);
    free(q->x_single);
    free(q->y_single);
}

static void find_nearest(const struct question *q, const narc_nearest_options *options, narc_distance *rows) {
    const size_t most = options && options->most > 0 ? options->most : 1;
    narc_error error;
    if (narc_find_nearest(q->index, q->scene.store, &q->bodies, &q->points, options, rows, q->count * most, &error) !=
        NARC_OK)
        fail_msg("%s", error.message);
}

/* ------------------------------------------------------------------------------------------------ brute force */

static int compare_rows(const void *left, const void *right) {
    const narc_distance *a = left, *b = right;
    if (a->separation != b->separation)
        return a->separation < b->separation ? -1 : 1;
    return (a->body > b->body) - (a->body < b->body);
}

/* Of the distances to all bodies, those that the options let pass, in order. */
static size_t search_all(const struct question *q, const narc_nearest_options *options, size_t point,
                         narc_distance *rows) {
    const size_t bodies = q->bodies.count;
    const narc_points one = {
        .count = bodies,
        .x = {(const char *)q->points.x.base + (ptrdiff_t)point * q->points.x.stride, 0, q->points.x.precision},
        .y = {(const char *)q->points.y.base + (ptrdiff_t)point * q->points.y.stride, 0, q->points.y.precision}};
    const uint64_t mask = options && options->search.mask.base ? options->search.mask.base[point] : UINT64_MAX;
    const uint32_t ignored = options && options->search.ignored.base ? options->search.ignored.base[point] : UINT32_MAX;
    const narc_owners *const owners = options ? options->search.owners : NULL;
    const uint32_t ignored_owner = owners && owners->ignored.base ? owners->ignored.base[point] : UINT32_MAX;
    size_t found = 0, things = 0;
    assert_int_equal(
        narc_find_distances(q->scene.store, &q->bodies, &one, (narc_index_column){NULL, 0}, NULL, rows, NULL), NARC_OK);
    for (size_t k = 0; k < bodies; k++) {
        narc_distance row = rows[k];
        row.point = (uint32_t)point;
        const bool near = !options || options->distance == 0 || row.separation < options->distance;
        if (row.count == 1 && near && !(options && options->inside && row.separation >= 0) &&
            (q->category[k] & mask) != 0 && k != ignored &&
            (ignored_owner == UINT32_MAX || owners->owner.base[k] != ignored_owner))
            rows[found++] = row;
    }
    qsort(rows, found, sizeof *rows, compare_rows);
    for (size_t k = 0; k < found; k++) { /* the first of each thing */
        bool first = true;
        for (size_t i = 0; i < things && owners; i++)
            first = first && (owners->owner.base[rows[k].body] == UINT32_MAX ||
                              owners->owner.base[rows[k].body] != owners->owner.base[rows[i].body]);
        if (first)
            rows[things++] = rows[k];
    }
    return things;
}

static size_t check_against_all(const struct question *q, const narc_nearest_options *options) {
    const size_t most = options && options->most > 0 ? options->most : 1;
    narc_distance *rows = make_junk(q->count * most * sizeof *rows);
    narc_distance *all = allocate(q->bodies.count, sizeof *all);
    size_t sum = 0;
    find_nearest(q, options, rows);
    for (size_t k = 0; k < q->count; k++) {
        const size_t found = search_all(q, options, k, all);
        sum += found;
        for (size_t i = 0; i < most; i++) {
            const narc_distance none = {.point = (uint32_t)k};
            const narc_distance *const expected = i < found ? &all[i] : &none, *const row = &rows[k * most + i];
            if (memcmp(row, expected, sizeof *row) != 0)
                fail_msg("point %zu (%a, %a), row %zu: body %u, count %d, separation %.9g; but %u, %d, %.9g", k,
                         q->x[k], q->y[k], i, row->body, row->count, (double)row->separation, expected->body,
                         expected->count, (double)expected->separation);
        }
    }
    free(rows);
    free(all);
    return sum;
}

static void check_scene(struct test_random *random, narc_precision precision, size_t bodies, size_t points,
                        double spread, double away) {
    struct question q = ask(random, precision, bodies, points, spread, away);
    uint64_t *masks = allocate(points, sizeof *masks);
    uint32_t *ignored = allocate(points, sizeof *ignored);
    for (size_t k = 0; k < points; k++) {
        masks[k] = random_bits(random) & 15;
        ignored[k] = random_below(random, 3) ? (uint32_t)random_below(random, bodies + 1) : UINT32_MAX;
    }
    const narc_index_options with_categories = {.category = {q.category, sizeof *q.category}};
    check_against_all(&q, NULL);
    check_against_all(&q, &(narc_nearest_options){.most = 7});
    check_against_all(&q, &(narc_nearest_options){.most = 3, .inside = 1});
    check_against_all(&q, &(narc_nearest_options){.distance = 0.3f, .most = 5});
    check_against_all(&q, &(narc_nearest_options){.distance = -0.2f});
    check_against_all(&q, &(narc_nearest_options){.distance = INFINITY, .inside = 1});
    const narc_nearest_options ignoring = {.search.ignored = {ignored, sizeof *ignored}, .most = 2};
    check_against_all(&q, &ignoring);
    uint32_t *owner = allocate(bodies, sizeof *owner);
    for (size_t k = 0; k < bodies; k++)
        owner[k] = random_below(random, 8) ? (uint32_t)random_below(random, bodies / 3 + 1) : UINT32_MAX;
    const narc_owners owners = {.owner = {owner, sizeof *owner}, .ignored = ignoring.search.ignored};
    for (size_t most = 1; most < 6; most += 2)
        check_against_all(&q, &(narc_nearest_options){.search.owners = &owners, .most = most, .inside = most == 3});
    free(owner);
    /* Boxes that have moved a little, grown, and in an index that was built otherwise. */
    assert_int_equal(narc_build_index(q.index, q.boxes, bodies,
                                      &(narc_index_options){.category = with_categories.category, .fast = 1}, NULL),
                     NARC_OK);
    const narc_nearest_options masked = {.search.mask = {masks, sizeof *masks}, .most = 4};
    check_against_all(&q, &masked);
    for (size_t k = 0; k < bodies; k++)
        if (q.boxes[k].min_x <= q.boxes[k].max_x) {
            q.boxes[k].min_x -= (float)random_between(random, 0, 1);
            q.boxes[k].max_y += (float)random_between(random, 0, 1);
        }
    assert_int_equal(narc_refit_index(q.index, q.boxes, bodies, &with_categories, NULL, NULL), NARC_OK);
    check_against_all(&q, &masked);
    const narc_nearest_options both = {
        .search = {.mask = masked.search.mask, .ignored = ignoring.search.ignored}, .distance = 1, .most = 4};
    check_against_all(&q, &both);
    free(masks);
    free(ignored);
    forget(&q);
}

TEST(test_against_all) {
    static const size_t counts[] = {1, 2, 7, 8, 9, 63, 64, 65, 200, 513};
    struct test_random random = test_random_named("nearest, against all");
    for (size_t round = 0; round < 2; round++)
        for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
            const double spread = random_log_between(&random, 1, 100);
            check_scene(&random, NARC_FLOAT32, counts[k], test_trials(60), spread, 0);
            check_scene(&random, NARC_FLOAT64, counts[k], test_trials(60), spread, 0);
            check_scene(&random, NARC_FLOAT64, counts[k], test_trials(30), spread, 1e7);
            check_scene(&random, NARC_FLOAT32, counts[k], test_trials(30), spread, 1e5);
        }
}

/* A lattice of equal bodies: many separations are the same, and the lowest numbers count. From 2^25 on, floats are 4 apart:
 * those of boxes are exact there, but points are not. */
static void check_lattice(narc_precision precision, double origin, double size) {
    struct test_random random = test_random_named("nearest, ties");
    const struct shape box = box_of(1, 1, 0);
    struct question q = ask(&random, precision, 400, 300, 1, 0);
    uint32_t shape = 0;
    assert_int_equal(narc_add_shape(q.scene.store, box.arcs, box.count, &shape, NULL), NARC_OK);
    for (size_t k = 0; k < 400; k++) {
        struct body *body = &q.scene.bodies[k];
        *body = (struct body){.cosine = 1, .scale = (float)size, .shape = shape};
        body->x = origin + 2 * size * (double)random_below(&random, 10);
        body->y = origin + 2 * size * (double)random_below(&random, 10);
        round_position(body, precision);
        q.boxes[k] = (narc_box){(float)(body->x - size / 2), (float)(body->y - size / 2), (float)(body->x + size / 2),
                                (float)(body->y + size / 2)};
    }
    for (size_t k = 0; k < 300; k++) {
        q.x[k] = origin + size / 8 * (double)random_below(&random, 160);
        q.y[k] = origin + size / 8 * (double)random_below(&random, 160);
        q.x_single[k] = (float)q.x[k];
        q.y_single[k] = (float)q.y[k];
    }
    assert_int_equal(narc_build_index(q.index, q.boxes, 400, NULL, NULL), NARC_OK);
    check_against_all(&q, NULL);
    check_against_all(&q, &(narc_nearest_options){.most = 9});
    assert_int_equal(narc_build_index(q.index, q.boxes, 400, &(narc_index_options){.fast = 1}, NULL), NARC_OK);
    check_against_all(&q, &(narc_nearest_options){.most = 9});
    forget(&q);
}

TEST(test_ties) {
    check_lattice(NARC_FLOAT32, 0, 1);
    check_lattice(NARC_FLOAT64, 0x1p25, 8);
}

/* ------------------------------------------------------------------------------------------------ the same bytes */

TEST(test_same_bytes) {
    enum { POINTS = 700, MOST = 3 };
    struct test_random random = test_random_named("nearest, bytes");
    for (int precision = NARC_FLOAT32; precision <= NARC_FLOAT64; precision++) {
        struct question q = ask(&random, (narc_precision)precision, 300, POINTS, 20, 0);
        const narc_workers workers = narc_openmp_workers(5);
        const narc_nearest_options options = {.most = MOST};
        narc_nearest_options threaded = options;
        threaded.search.workers = &workers;
        narc_distance *rows = make_junk(POINTS * MOST * sizeof *rows), *other = make_junk(POINTS * MOST * sizeof *rows);
        narc_distance *pairs = make_junk(300 * sizeof *rows), *other_pairs = make_junk(300 * sizeof *rows);
        narc_points first = q.points;
        first.count = 300;
        find_nearest(&q, &options, rows);
        assert_int_equal(
            narc_find_distances(q.scene.store, &q.bodies, &first, (narc_index_column){NULL, 0}, NULL, pairs, NULL),
            NARC_OK);
        test_use_isa("scalar");
        find_nearest(&q, &options, other);
        assert_memory_equal(rows, other, POINTS * MOST * sizeof *rows);
        assert_int_equal(narc_find_distances(q.scene.store, &q.bodies, &first, (narc_index_column){NULL, 0}, NULL,
                                             other_pairs, NULL),
                         NARC_OK);
        assert_memory_equal(pairs, other_pairs, 300 * sizeof *rows);
        test_use_isa(test_isa());
        find_nearest(&q, &threaded, other);
        assert_memory_equal(rows, other, POINTS * MOST * sizeof *rows);
        assert_int_equal(narc_find_distances(q.scene.store, &q.bodies, &first, (narc_index_column){NULL, 0}, &workers,
                                             other_pairs, NULL),
                         NARC_OK);
        assert_memory_equal(pairs, other_pairs, 300 * sizeof *rows);
        /* One by one, from the last on. */
        struct question one = q;
        one.count = one.points.count = 1;
        for (size_t k = POINTS; k-- > 0;) {
            narc_distance own[MOST];
            one.points.x.base = (const char *)q.points.x.base + (ptrdiff_t)k * q.points.x.stride;
            one.points.y.base = (const char *)q.points.y.base + (ptrdiff_t)k * q.points.y.stride;
            find_nearest(&one, &options, own);
            for (size_t i = 0; i < MOST; i++)
                own[i].point = (uint32_t)k;
            assert_memory_equal(own, rows + k * MOST, sizeof own);
        }
        free(rows);
        free(other);
        free(pairs);
        free(other_pairs);
        forget(&q);
    }
}

TEST_MAIN("nearest")
