/* SPDX-License-Identifier: MIT
 *
 * queries.c - rays, regions and the nearest bodies, in batches and one by one; rays, distances and points of one body
 * each; builds of an index.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "random.h"
#include "rows.h"

enum { FAN = 1080, RAYS = 10 * FAN, REGIONS = 10000, POINTS = 20000, MOST_FOUND = 200 /* of a region, in the mean */ };

struct questions {
    struct asked asked; /* points are rays that go nowhere */

    /* Answers, as far as the question has them. */
    narc_ray_hit *hits;
    narc_distance *distances;
    float *floats; /* a peer's */
    uint64_t *keys, *bits;
};

enum ray_kind { RAY_FAN, RAY_LONG, RAY_SHORT, RAY_NAMED };
enum point_kind { NEAREST, DISTANCE, INSIDE, INSIDE_ONE };

/* Peers that are asked several questions about a scene have it once. */
static void *share_peer(const struct row *row) {
    const struct row *other;
    for (size_t k = 0; (other = get_row(k)) != NULL; k++)
        if (other->peer_state && other->scene == row->scene && other->peer->create == row->peer->create)
            return other->peer_state;
    return row->peer->create(row->scene);
}

static struct questions *begin(struct row *row, size_t count) {
    struct questions *q = row->state = allocate(1, sizeof *q);
    index_scene(row->scene);
    q->asked.count = scaled(count);
    row->bench.count = q->asked.count;
    if (row->peer)
        row->peer_state = share_peer(row);
    return q;
}

/* ------------------------------------------------------------------------------------------------ rays */

static const struct ray *make_rays(double half, enum ray_kind kind, size_t count) {
    struct ray *rays = allocate(count, sizeof *rays);
    uint64_t random = 77;
    double x = 0, y = 0;
    for (size_t k = 0; k < count; k++) {
        if (kind != RAY_FAN || k % FAN == 0) {
            x = random_between(&random, -half, half);
            y = random_between(&random, -half, half);
        }
        const double angle = kind == RAY_FAN ? 2 * pi * (double)(k % FAN) / FAN : random_between(&random, -pi, pi);
        const double length = kind == RAY_SHORT ? 4 : half;
        rays[k] = (struct ray){(float)x, (float)y, (float)(length * cos(angle)), (float)(length * sin(angle))};
    }
    return rays;
}

/* Rays at a body each, which start 2 to 4 away and pass its position by up to 1. */
static void make_named(struct questions *q, const struct scene *scene) {
    struct ray *rays = allocate(q->asked.count, sizeof *rays);
    uint32_t *named = allocate(q->asked.count, sizeof *named);
    uint64_t random = 80;
    for (size_t k = 0; k < q->asked.count; k++) {
        named[k] = (uint32_t)(random_bits(&random) % scene->body_count);
        const struct body *body = &scene->bodies[named[k]];
        const double angle = random_between(&random, -pi, pi), x = cos(angle), y = sin(angle);
        const double far = random_between(&random, 2, 4), by = random_between(&random, -1, 1);
        rays[k] = (struct ray){body->x - (float)(far * x + by * y), body->y - (float)(far * y - by * x),
                               (float)(2 * far * x), (float)(2 * far * y)};
    }
    q->asked.rays = rays;
    q->asked.named = named;
}

/* So many rays in a call; of fans one each. */
static void cast_rays(const struct row *row, size_t batch, narc_ray_hit *out) {
    const struct questions *q = row->state;
    const struct scene *scene = row->scene;
    const narc_bodies bodies = bodies_of_scene(scene);
    const narc_ray_options options = {.inside = NARC_INSIDE_IGNORES};
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const struct ray *first = q->asked.rays + k;
        const narc_rays rays = {.count = batch < q->asked.count - k ? batch : q->asked.count - k,
                                .x = NARC_POSITION_COLUMN(first, x),
                                .y = NARC_POSITION_COLUMN(first, y),
                                .motion_x = NARC_COLUMN(first, motion_x),
                                .motion_y = NARC_COLUMN(first, motion_y)};
        const narc_index_column named = {q->asked.named + (q->asked.named ? k : 0), sizeof *q->asked.named};
        narc_error error;
        must(q->asked.named
                 ? narc_cast_ray_pairs(scene->shapes, &bodies, &rays, &named, &options, out + k, rays.count, &error)
                 : narc_cast_rays(scene->index, scene->shapes, &bodies, &rays, &options, out + k, rays.count, &error),
             &error);
    }
}

static void run_rays(struct row *row) {
    struct questions *q = row->state;
    if (row->peer)
        row->peer->ask(row->peer_state, &q->asked, q->floats);
    else
        cast_rays(row, row->batch ? row->batch : row->question->what == RAY_FAN ? FAN : RAYS, q->hits);
}

/* Peers may differ in what grazes; this library has the same answers in all batches. */
static void prepare_rays(struct row *row) {
    struct questions *q = begin(row, RAYS);
    const size_t count = q->asked.count;
    narc_ray_hit *expected = allocate(count, sizeof *expected);
    if (row->question->what == RAY_NAMED)
        make_named(q, row->scene);
    else
        q->asked.rays = make_rays(row->scene->half, (enum ray_kind)row->question->what, count);
    q->hits = allocate(count, sizeof *q->hits);
    q->floats = allocate(count, sizeof *q->floats);
    cast_rays(row, RAYS, expected);
    run_rays(row);
    for (size_t k = 0; k < count; k++) {
        const float fraction = expected[k].count ? expected[k].fraction : 2;
        const narc_ray_hit *hit = &q->hits[k];
        row->bench.hits += expected[k].count / (double)count;
        const float other = q->floats[k];
        if (row->peer)
            row->bench.wrong += fabs((double)(fraction - other)) > 1e-3;
        else
            row->bench.wrong += hit->count != expected[k].count || (hit->count && hit->fraction != fraction);
    }
    free(expected);
}

/* ------------------------------------------------------------------------------------------------ regions */

/* Squares that meet so many boxes in the mean, were these everywhere as dense. */
static const narc_box *make_regions(const struct scene *scene, double found, size_t count) {
    narc_box *regions = allocate(count, sizeof *regions);
    const size_t bodies = scene->body_count;
    uint64_t random = 79;
    double width = 0;
    for (size_t k = 0; k < bodies; k++)
        width += (double)(scene->boxes[k].max_x - scene->boxes[k].min_x) / (double)bodies;
    const double half = scene->half, size = fmax(0, 2 * half * sqrt(found / (double)bodies) - width);
    for (size_t k = 0; k < count; k++) {
        const double x = random_between(&random, -half, half - size), y = random_between(&random, -half, half - size);
        regions[k] = (narc_box){(float)x, (float)y, (float)(x + size), (float)(y + size)};
    }
    return regions;
}

/* Pairs region << 32 | body, in any order. */
struct tally {
    uint64_t count, sum;
};

static void add_key(struct tally *tally, uint64_t key) {
    tally->count++;
    tally->sum += random_bits(&key);
}

/* So many regions in a call. */
static struct tally ask_index(const struct row *row, size_t batch, bool check) {
    const struct questions *q = row->state;
    const narc_index_query query = {.workers = &row->workers};
    struct tally tally = {0, 0};
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const size_t part = batch < q->asked.count - k ? batch : q->asked.count - k;
        narc_pairs pairs;
        narc_error error;
        must(narc_query_index(row->scene->index, q->asked.regions + k, part, &query, &pairs, &error), &error);
        const uint32_t *a = pairs.a.base, *b = pairs.b.base;
        for (size_t n = 0; n < pairs.count && check; n++)
            add_key(&tally, (uint64_t)(k + a[n]) << 32 | b[n]);
    }
    return tally;
}

static void run_regions(struct row *row) {
    struct questions *q = row->state;
    if (row->peer)
        row->peer->ask(row->peer_state, &q->asked, q->keys);
    else
        ask_index(row, row->batch ? row->batch : q->asked.count, false);
}

/* What a peer finds, and what this library does one by one, against a batch of it. */
static void prepare_regions(struct row *row) {
    struct questions *q = begin(row, REGIONS);
    const size_t count = q->asked.count;
    q->asked.regions = make_regions(row->scene, row->question->what, count);
    const struct tally expected = ask_index(row, count, true);
    struct tally found = {0, 0};
    if (row->peer) {
        q->keys = allocate(MOST_FOUND * count, sizeof *q->keys);
        for (size_t k = row->peer->ask(row->peer_state, &q->asked, q->keys); k > 0; k--)
            add_key(&found, q->keys[k - 1]);
    } else {
        found = ask_index(row, row->batch ? row->batch : count, true);
    }
    row->bench.hits = (double)expected.count / (double)count;
    row->bench.wrong = found.count != expected.count || found.sum != expected.sum;
}

/* ------------------------------------------------------------------------------------------------ points */

static void find_nearest(const struct row *row, const narc_points *points, narc_distance *out) {
    const narc_bodies bodies = bodies_of_scene(row->scene);
    const narc_nearest_options options = {.search.workers = &row->workers};
    narc_error error;
    must(
        narc_find_nearest(row->scene->index, row->scene->shapes, &bodies, points, &options, out, points->count, &error),
        &error);
}

/* So many points in a call. */
static void ask_points(const struct row *row, enum point_kind what, size_t batch, narc_distance *out) {
    const struct questions *q = row->state;
    const narc_bodies bodies = bodies_of_scene(row->scene);
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const struct ray *at = q->asked.rays + k;
        const narc_index_column named = {q->asked.named + k, sizeof *q->asked.named};
        const narc_points points = {.count = batch < q->asked.count - k ? batch : q->asked.count - k,
                                    .x = NARC_POSITION_COLUMN(at, x),
                                    .y = NARC_POSITION_COLUMN(at, y)};
        narc_error error;
        if (what == NEAREST)
            find_nearest(row, &points, out + k);
        else if (what == DISTANCE)
            must(narc_find_distances(row->scene->shapes, &bodies, &points, &named, &row->workers, out + k, &error),
                 &error);
        else
            must(
                narc_find_inside(row->scene->shapes, &bodies, &points, &named, &row->workers, q->bits + k / 64, &error),
                &error);
    }
}

static void run_points(struct row *row) {
    struct questions *q = row->state;
    if (row->peer)
        row->peer->ask(row->peer_state, &q->asked, q->floats);
    else
        ask_points(row, (enum point_kind)row->question->what, row->batch ? row->batch : q->asked.count, q->distances);
}

/* Anywhere, each of the body that is nearest; or around one. A peer's floats are distances, 0 within, or 1 within. */
static void prepare_points(struct row *row) {
    struct questions *q = begin(row, POINTS);
    const enum point_kind what = (enum point_kind)row->question->what;
    const size_t count = q->asked.count;
    const struct body *one = what == INSIDE_ONE ? &row->scene->bodies[row->scene->body_count / 2] : NULL;
    const double half = one ? 1 : row->scene->half;
    narc_distance *expected = allocate(count, sizeof *expected);
    struct ray *points = allocate(count, sizeof *points);
    uint32_t *named = allocate(count, sizeof *named);
    uint64_t random = 78;
    for (size_t k = 0; k < count; k++) {
        points[k].x = (one ? one->x : 0) + (float)random_between(&random, -half, half);
        points[k].y = (one ? one->y : 0) + (float)random_between(&random, -half, half);
        named[k] = (uint32_t)(one ? row->scene->body_count / 2 : 0);
    }
    q->asked.rays = points;
    q->asked.named = named;
    q->distances = allocate(count, sizeof *q->distances);
    q->bits = allocate(NARC_BIT_WORDS(count), sizeof *q->bits);
    q->floats = allocate(count, sizeof *q->floats);
    ask_points(row, one ? DISTANCE : NEAREST, count, expected);
    for (size_t k = 0; k < count && !one; k++)
        named[k] = expected[k].body;
    run_points(row);
    for (size_t k = 0; k < count; k++) {
        const double separation = (double)expected[k].separation;
        const bool within = separation < 0, asks_within = what >= INSIDE;
        row->bench.hits += within / (double)count;
        if (row->peer)
            row->bench.wrong += fabs((double)q->floats[k] - (asks_within ? within : fmax(0, separation))) > 1e-3 &&
                                !(asks_within && fabs(separation) < TOUCHING);
        else
            row->bench.wrong += asks_within ? (q->bits[k / 64] >> k % 64 & 1) != within
                                            : q->distances[k].separation != expected[k].separation;
    }
    free(expected);
}

/* ------------------------------------------------------------------------------------------------ builds of an index */

enum build { GOOD, FAST };

static void run_build(struct row *row) {
    struct scene *scene = row->scene;
    const narc_index_options options = {.fast = row->question->what == FAST, .workers = &row->workers};
    narc_index *index = row->state;
    narc_error error;
    must(narc_build_index(index, scene->boxes, scene->body_count, &options, &error), &error);
}

static void prepare_build(struct row *row) {
    narc_index *index;
    index_scene(row->scene);
    row->bench.count = row->scene->body_count;
    must(narc_create_index(NULL, &index), NULL);
    must(narc_build_index(index, row->scene->boxes, row->scene->body_count, NULL, NULL), NULL);
    row->state = index;
}

/* ------------------------------------------------------------------------------------------------ updates of an index */

struct moves {
    narc_index *index;
    narc_box *boxes;
    uint32_t *moved;
    uint64_t random;
};

/* Some bodies go to where others began, or a little away. */
static void run_moves(struct row *row) {
    const struct scene *scene = row->scene;
    struct moves *m = row->state;
    for (size_t k = 0; k < row->bench.count; k++) {
        const uint32_t body = m->moved[k] = (uint32_t)(random_bits(&m->random) % scene->body_count);
        const bool near = row->question->what < 0;
        const narc_box from = near ? m->boxes[body] : scene->boxes[random_bits(&m->random) % scene->body_count];
        const float by = 0.05f * (float)random_between(&m->random, -1, 1);
        m->boxes[body] = (narc_box){from.min_x + by, from.min_y - by, from.max_x + by, from.max_y - by};
    }
    if (row->peer) {
        const struct asked asked = {.count = row->bench.count, .regions = m->boxes, .moved = m->moved};
        row->peer->ask(row->peer_state, &asked, NULL);
    } else {
        const narc_index_column moved = {m->moved, sizeof *m->moved};
        const narc_index_options options = {.workers = &row->workers};
        narc_error error;
        must(narc_update_index(m->index, m->boxes, scene->body_count, &moved, row->bench.count, &options, &error),
             &error);
    }
}

static void prepare_moves(struct row *row) {
    const size_t count = (size_t)abs(row->question->what);
    struct moves *m = row->state = allocate(1, sizeof *m);
    struct scene *scene = row->scene;
    index_scene(scene);
    row->bench.count = count;
    m->boxes = allocate(scene->body_count, sizeof *m->boxes);
    m->moved = allocate(count, sizeof *m->moved);
    memcpy(m->boxes, scene->boxes, scene->body_count * sizeof *m->boxes);
    if (row->peer)
        row->peer_state = row->peer->create(scene);
    must(narc_create_index(NULL, &m->index), NULL);
    must(narc_build_index(m->index, m->boxes, scene->body_count, NULL, NULL), NULL);
}

const struct question scene_questions[] = {{"ray-fan", prepare_rays, run_rays, RAY_FAN, false},
                                           {"ray-long", prepare_rays, run_rays, RAY_LONG, false},
                                           {"ray-short", prepare_rays, run_rays, RAY_SHORT, false},
                                           {"region-48", prepare_regions, run_regions, 48, false},
                                           {"region-3", prepare_regions, run_regions, 3, false},
                                           {"nearest", prepare_points, run_points, NEAREST, false},
                                           {"named-ray", prepare_rays, run_rays, RAY_NAMED, false},
                                           {"distance", prepare_points, run_points, DISTANCE, false},
                                           {"inside", prepare_points, run_points, INSIDE, false},
                                           {"inside-one", prepare_points, run_points, INSIDE_ONE, false},
                                           {"index-good", prepare_build, run_build, GOOD, false},
                                           {"index-fast", prepare_build, run_build, FAST, false},
                                           {"move-1", prepare_moves, run_moves, 1, false},
                                           {"move-100", prepare_moves, run_moves, 100, false},
                                           {"move-2000", prepare_moves, run_moves, 2000, false},
                                           {"move-near-2000", prepare_moves, run_moves, -2000, false},
                                           {.name = NULL}};
