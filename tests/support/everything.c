/* SPDX-License-Identifier: MIT
 *
 * everything.c - all that a scene can be asked, by one call.
 */
#include "everything.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "ledger.h"

enum { MOST_HITS = 2, MOST_NEAREST = 2, COUNTS = 11 };

/* `floats`: a bit for each of a row's words that is a float. Rows that are `numbered` begin with the number of their pair,
 * ray or point. */
static const struct {
    const char *name;
    size_t size;
    unsigned floats;
    bool numbered;
} kinds[ANSWERS] = {
    [ANSWER_BOXES] = {"boxes", sizeof(narc_box), 0xf, false},
    [ANSWER_PARTS] = {"parts", sizeof(narc_body), 0x70, false},
    [ANSWER_OVERLAPS] = {"words of overlaps", sizeof(uint64_t), 0, false},
    [ANSWER_SEPARATIONS] = {"separations", sizeof(float), 1, false},
    [ANSWER_CONTACTS] = {"contacts", sizeof(narc_contact), 0x1fc, true},
    [ANSWER_MANIFOLDS] = {"manifolds", sizeof(narc_manifold), 0x773c, true},
    [ANSWER_CASTS] = {"casts of pairs", sizeof(narc_impact), 0x7f8, true},
    [ANSWER_DISTANCES] = {"distances", sizeof(narc_distance), 0x1f8, true},
    [ANSWER_INSIDE] = {"words of points within", sizeof(uint64_t), 0, false},
    [ANSWER_RAY_PAIRS] = {"rays at bodies", sizeof(narc_ray_hit), 0x1f8, true},
    [ANSWER_RAYS] = {"rays", sizeof(narc_ray_hit), 0x1f8, true},
    [ANSWER_NEAREST] = {"nearest bodies", sizeof(narc_distance), 0x1f8, true},
    [ANSWER_MOVERS] = {"casts of shapes", sizeof(narc_impact), 0x7f8, true},
    [ANSWER_LISTS] = {"lists of pairs", sizeof(uint64_t), 0, false},
    [ANSWER_COUNTS] = {"counts", sizeof(size_t), 0, false},
};

/* ------------------------------------------------------------------------------------------------ asking */

static void *add_rows(struct answers *answers, enum answer_kind kind, size_t count) {
    answers->count[kind] = count;
    return answers->rows[kind] = guard_allocate(count * kinds[kind].size);
}

static void ask_pairs(const struct everything *e, const narc_workers *workers, struct answers *answers,
                      size_t *counts) {
    const size_t count = e->pairs.count;
    narc_query query = e->query;
    narc_cast_options cast = e->cast;
    narc_error error;
    query.dense = 1;
    query.workers = cast.workers = workers;
    query.out_skipped = &counts[0];
    expect_ok(narc_find_overlaps(e->shapes, &e->bodies, &e->pairs, &query,
                                 add_rows(answers, ANSWER_OVERLAPS, NARC_BIT_WORDS(count)), &error),
              &error);
    query.out_skipped = &counts[1];
    expect_ok(narc_find_separations(e->shapes, &e->bodies, &e->pairs, &query,
                                    add_rows(answers, ANSWER_SEPARATIONS, count), &error),
              &error);
    query.out_skipped = &counts[2];
    expect_ok(narc_find_contacts(e->shapes, &e->bodies, &e->pairs, &query, add_rows(answers, ANSWER_CONTACTS, count),
                                 count, &counts[3], &error),
              &error);
    query.out_skipped = &counts[4];
    expect_ok(narc_find_manifolds(e->shapes, &e->bodies, &e->pairs, &query, add_rows(answers, ANSWER_MANIFOLDS, count),
                                  count, &counts[5], &error),
              &error);
    cast.out_skipped = &counts[6];
    expect_ok(narc_cast_pairs(e->shapes, &e->bodies, &e->motions, &e->pairs, NULL, &cast,
                              add_rows(answers, ANSWER_CASTS, count), count, &error),
              &error);
    expect_ok(narc_find_distances(e->shapes, &e->bodies, &e->points, &e->pairs.a, workers,
                                  add_rows(answers, ANSWER_DISTANCES, count), &error),
              &error);
    expect_ok(narc_find_inside(e->shapes, &e->bodies, &e->points, &e->pairs.a, workers,
                               add_rows(answers, ANSWER_INSIDE, NARC_BIT_WORDS(count)), &error),
              &error);
    static const uint32_t first = 0;
    const narc_index_column body = {&first, 0};
    const narc_ray_options at_first = {.search.workers = workers, .inside = e->inside, .out_skipped = &counts[10]};
    expect_ok(narc_cast_ray_pairs(e->shapes, &e->bodies, &e->rays, &body, &at_first,
                                  add_rows(answers, ANSWER_RAY_PAIRS, e->rays.count), e->rays.count, &error),
              &error);
}

static uint64_t hash_pairs(uint64_t hash, const narc_pairs *pairs, size_t near) {
    for (size_t k = 0; k < pairs->count; k++)
        if (pairs->a.base[k] < near && pairs->b.base[k] < near) {
            hash = test_hash(hash, &pairs->a.base[k], sizeof(uint32_t));
            hash = test_hash(hash, &pairs->b.base[k], sizeof(uint32_t));
        }
    return hash;
}

static void ask_lists(const struct everything *e, narc_index *index, const narc_box *boxes, const narc_workers *workers,
                      struct answers *answers) {
    const size_t near = e->near > 0 ? e->near : e->indexed;
    const narc_index_query search = {.workers = workers};
    narc_broad_phase *const broad = create_broad_phase(NULL);
    narc_pairs pairs;
    size_t found;
    narc_error error;
    expect_ok(narc_query_index(index, boxes, near, &search, &pairs, &error), &error);
    uint64_t hash = hash_pairs(TEST_HASH_START, &pairs, near);
    const narc_status status =
        narc_find_pairs(broad, boxes, e->indexed, NULL, workers, NULL, NULL, 0, 0, &found, &error);
    assert_int_equal(status, found > 0 ? NARC_ERROR_CAPACITY : NARC_OK);
    AUTO(guard_release_at)
    uint32_t *const a = guard_allocate(found * sizeof *a), *const b = guard_allocate(found * sizeof *b);
    expect_ok(narc_find_pairs(broad, boxes, e->indexed, NULL, workers, a, b, 0, found, &found, &error), &error);
    pairs = (narc_pairs){.count = found, .a = {a, sizeof *a}, .b = {b, sizeof *b}};
    hash = hash_pairs(hash, &pairs, near);
    narc_destroy_broad_phase(broad);
    memcpy(add_rows(answers, ANSWER_LISTS, 1), &hash, sizeof hash);
}

static void ask_index(const struct everything *e, const narc_box *boxes, const narc_workers *workers,
                      struct answers *answers, size_t *counts) {
    const size_t hits = e->rays.count * MOST_HITS, nearest = e->points.count * MOST_NEAREST;
    narc_bodies bodies = e->bodies, movers = e->bodies;
    narc_cast_options cast = e->cast;
    narc_index_query search = {.workers = workers};
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    narc_error error;
    AUTO(guard_release_at) uint32_t *const own = guard_allocate(e->movers * sizeof *own);
    for (uint32_t k = 0; k < e->movers; k++)
        own[k] = k;
    bodies.count = e->indexed;
    movers.count = e->movers;
    expect_ok(narc_create_index(&guard_allocator, &index), &error);
    expect_ok(narc_build_index(index, boxes, e->indexed, &(narc_index_options){.workers = workers}, &error), &error);
    AUTO(guard_release_at) uint32_t *const order = guard_allocate(e->rays.count * sizeof *order);
    const narc_ray_options through = {.search = search,
                                      .inside = e->inside,
                                      .most = MOST_HITS,
                                      .out_skipped = &counts[7],
                                      .out_order = e->inside == NARC_INSIDE_LEAVES ? order : NULL};
    expect_ok(narc_cast_rays(index, e->shapes, &bodies, &e->rays, &through, add_rows(answers, ANSWER_RAYS, hits), hits,
                             &error),
              &error);
    const narc_nearest_options near = {.search = search, .most = MOST_NEAREST};
    expect_ok(narc_find_nearest(index, e->shapes, &bodies, &e->points, &near,
                                add_rows(answers, ANSWER_NEAREST, nearest), nearest, &error),
              &error);
    search.ignored = (narc_index_column){own, sizeof *own};
    cast.out_skipped = &counts[8];
    expect_ok(narc_cast_shapes(index, e->shapes, &bodies, &movers, &e->motions, &search, &cast,
                               add_rows(answers, ANSWER_MOVERS, e->movers), e->movers, &error),
              &error);
    ask_lists(e, index, boxes, workers, answers);
}

struct answers ask_everything(const struct everything *e, const narc_workers *workers) {
    struct answers answers;
    const size_t bodies = e->bodies.count;
    size_t *const counts = memset(add_rows(&answers, ANSWER_COUNTS, COUNTS), 0, COUNTS * sizeof *counts);
    AUTO(guard_release_at) uint32_t *const owner = guard_allocate(bodies * sizeof *owner);
    narc_box *const boxes = add_rows(&answers, ANSWER_BOXES, bodies);
    const narc_box_options options = {.workers = workers, .out_skipped = &counts[9]};
    narc_error error;
    for (size_t k = 0; k < bodies; k++)
        owner[k] = (uint32_t)((7 * k + 3) % bodies);
    expect_ok(narc_compute_boxes(e->shapes, &e->bodies, &options, boxes, &error), &error);
    expect_ok(narc_place_parts(&e->bodies, &e->bodies, &NARC_ARRAY(owner), workers,
                               add_rows(&answers, ANSWER_PARTS, bodies), &error),
              &error);
    ask_pairs(e, workers, &answers, counts);
    ask_index(e, e->boxes ? e->boxes : boxes, workers, &answers, counts);
    return answers;
}

void destroy_answers(struct answers *answers) {
    for (int kind = 0; kind < ANSWERS; kind++)
        guard_release(answers->rows[kind]);
}

/* ------------------------------------------------------------------------------------------------ comparing */

static char *row_of(const struct answers *answers, int kind, size_t k) {
    return (char *)answers->rows[kind] + k * kinds[kind].size;
}

void expect_same_answers(const struct answers *right, const struct answers *found, unsigned but, const char *how) {
    for (int kind = 0; kind < ANSWERS; kind++) {
        if (but >> kind & 1)
            continue;
        assert_int_equal(found->count[kind], right->count[kind]);
        for (size_t k = 0; k < right->count[kind]; k++)
            if (memcmp(row_of(found, kind, k), row_of(right, kind, k), kinds[kind].size) != 0)
                fail_msg("%s: of %s row %zu differs", how, kinds[kind].name, k);
    }
}

void expect_same_row(const struct answers *all, size_t k, const struct answers *one) {
    const float *const separations = all->rows[ANSWER_SEPARATIONS];
    assert_memory_equal(one->rows[ANSWER_SEPARATIONS], &separations[k], sizeof *separations);
    assert_int_equal(bit_is_set(one->rows[ANSWER_OVERLAPS], 0), bit_is_set(all->rows[ANSWER_OVERLAPS], k));
    assert_int_equal(bit_is_set(one->rows[ANSWER_INSIDE], 0), bit_is_set(all->rows[ANSWER_INSIDE], k));
    for (int kind = 0; kind < ANSWERS; kind++) {
        if (!kinds[kind].numbered || kind == ANSWER_MOVERS)
            continue;
        const size_t rows = one->count[kind];
        for (size_t i = 0; i < rows; i++) {
            *(uint32_t *)(void *)row_of(one, kind, i) += (uint32_t)k;
            if (memcmp(row_of(one, kind, i), row_of(all, kind, k * rows + i), kinds[kind].size) != 0)
                fail_msg("%s %zu by itself differs", kinds[kind].name, k);
        }
    }
}

static uint32_t index_in(narc_index_column column, size_t k) {
    uint32_t index;
    memcpy(&index, (const char *)column.base + (ptrdiff_t)k * column.stride, sizeof index);
    return index;
}

static void expect_feature(const struct everything *e, uint32_t body, unsigned feature) {
    assert_true((feature & 0x3f) < narc_get_arcs(e->shapes, index_in(e->bodies.shape, body), NULL));
}

void expect_sane_answers(const struct everything *e, const struct answers *answers) {
    for (int kind = 0; kind < ANSWERS; kind++)
        for (size_t k = 0; k < answers->count[kind]; k++)
            for (size_t word = 0; word < 16 && kinds[kind].floats >> word; word++) {
                float number = 0;
                if (kinds[kind].floats >> word & 1)
                    memcpy(&number, row_of(answers, kind, k) + 4 * word, sizeof number);
                if (isnan(number))
                    fail_msg("word %zu of row %zu of %s is a NaN", word, k, kinds[kind].name);
            }
    const float *const separations = answers->rows[ANSWER_SEPARATIONS];
    for (size_t k = 0; k < e->pairs.count; k++) {
        const narc_contact *const contact = (const narc_contact *)answers->rows[ANSWER_CONTACTS] + k;
        const narc_impact *const impact = (const narc_impact *)answers->rows[ANSWER_CASTS] + k;
        assert_int_equal(bit_is_set(answers->rows[ANSWER_OVERLAPS], k), separations[k] < 0);
        assert_int_equal(bit_is_set(answers->rows[ANSWER_INSIDE], k),
                         ((const narc_distance *)answers->rows[ANSWER_DISTANCES])[k].separation < 0);
        assert_true(separations[k] == (contact->count ? contact->separation : INFINITY));
        assert_true(impact->fraction >= 0 && impact->fraction <= 1 && impact->count <= NARC_CAST_UNFINISHED);
        if (contact->count) {
            expect_feature(e, index_in(e->pairs.a, k), contact->feature);
            expect_feature(e, index_in(e->pairs.b, k), contact->feature >> 8);
        }
    }
    size_t empty = 0;
    for (size_t k = 0; k < e->bodies.count; k++) {
        const narc_box *const box = (const narc_box *)answers->rows[ANSWER_BOXES] + k;
        const narc_body *const part = (const narc_body *)answers->rows[ANSWER_PARTS] + k;
        const bool whole = box->min_x <= box->max_x && box->min_y <= box->max_y && isfinite(box->min_x) &&
                           isfinite(box->min_y) && isfinite(box->max_x) && isfinite(box->max_y);
        assert_true(whole || (box->min_x == INFINITY && box->max_y == -INFINITY));
        empty += !whole;
        const double c = (double)part->cosine, s = (double)part->sine;
        const narc_body none = {.shape = part->shape};
        /* A part that is not turned has the rotation of its owner. */
        assert_true((isfinite(part->x) && isfinite(part->y) &&
                     fabs(c * c + s * s - 1) <= NARC_ROTATION_TOLERANCE + 1e-6 && part->scale > 0 &&
                     isfinite(part->scale)) ||
                    memcmp(part, &none, sizeof none) == 0);
    }
    assert_int_equal(empty, ((const size_t *)answers->rows[ANSWER_COUNTS])[9]);
    for (size_t k = 0; k < answers->count[ANSWER_RAYS]; k++) {
        const narc_ray_hit *const hit = (const narc_ray_hit *)answers->rows[ANSWER_RAYS] + k;
        assert_true(hit->ray == k / MOST_HITS && hit->count <= 1 && hit->body < e->indexed && hit->radius >= 0);
        assert_true(hit->fraction >= 0 && isfinite(hit->fraction));
        assert_true(fabsf(hit->normal_x) <= 1.000001f && fabsf(hit->normal_y) <= 1.000001f);
    }
}

/* ------------------------------------------------------------------------------------------------ worlds */

struct world make_world(struct test_random *random, struct scene scene, size_t bodies_with_rays, size_t rays) {
    static const float margins[] = {0.25f, INFINITY, -0.1f, INFINITY};
    const size_t pairs = scene.pair_count;
    struct world world = {.scene = scene,
                          .motion = calloc(scene.body_count, sizeof *world.motion),
                          .rays = calloc(rays + 1, sizeof *world.rays),
                          .points = calloc(pairs + 1, sizeof *world.points),
                          .ray_count = rays,
                          .shift = calloc(pairs + 1, sizeof *world.shift),
                          .margins = calloc(pairs + 1, sizeof *world.margins)};
    world.shifted = random_below(random, 2); /* one random number a statement */
    world.query.margin = margins[random_below(random, 4)];
    world.query.second_margin = (float)random_between(random, -0.1, 0.1);
    world.cast.target = random_below(random, 2) ? 0 : (float)random_between(random, -0.1, 0.1);
    world.cast.parting = world.cast.target > 0 ? 0.01f : 0;
    world.inside = (narc_inside)random_below(random, 3);
    AUTO(free_at) struct contacts contacts = scene_contacts(&scene, INFINITY);
    if (random_below(random, 2))
        world.query.flat_angle = (float)random_between(random, 0, 1.5);
    for (size_t k = 0; k < pairs; k++) {
        const struct body *const a = &scene.bodies[scene.pairs[k].a], *const b = &scene.bodies[scene.pairs[k].b];
        const double far = random_unit(random);
        world.shift[k] = (float)random_between(random, -1, 1);
        world.margins[k] = random_below(random, 9) ? (float)random_between(random, -0.1, 0.3) : NAN;
        world.points[k] = (struct test_ray){.x = a->x + (double)contacts.rows[k].point_x * far,
                                            .y = a->y + (double)contacts.rows[k].point_y * far};
        world.motion[scene.pairs[k].a] = (narc_motion){(float)(b->x - a->x), (float)(b->y - a->y), 0};
        world.motion[scene.pairs[k].b].angle = k % 4 ? 0 : (float)random_between(random, -3, 3);
    }
    for (size_t k = 0; k < rays; k++) {
        const struct body *const body = &scene.bodies[k % bodies_with_rays];
        world.rays[k] = make_ray(random, &scene.shapes[body->shape], body, scene.precision,
                                 (enum ray_kind)random_below(random, RAY_KINDS));
    }
    return world;
}

void destroy_world(struct world *world) {
    free(world->motion);
    free(world->rays);
    free(world->points);
    free(world->shift);
    free(world->margins);
    destroy_scene(&world->scene);
}

struct everything view_world(const struct world *world) {
    const size_t bodies = world->scene.body_count, pairs = world->scene.pair_count;
    const narc_rays points = view_rays(world->points, pairs);
    struct everything e = {.shapes = world->scene.store,
                           .bodies = scene_bodies(&world->scene),
                           .indexed = bodies,
                           .movers = bodies,
                           .motions = view_motions(world->motion),
                           .pairs = scene_pairs(&world->scene),
                           .rays = view_rays(world->rays, world->ray_count),
                           .points = {.count = pairs, .x = points.x, .y = points.y},
                           .query = world->query,
                           .cast = world->cast,
                           .inside = world->inside};
    if (world->shifted) {
        e.pairs.shift_x = e.pairs.shift_y = (narc_float_column){world->shift, sizeof *world->shift};
        e.query.margins = (narc_float_column){world->margins, sizeof *world->margins};
    }
    return e;
}
