/* SPDX-License-Identifier: MIT
 *
 * queries.c - rays, regions and the nearest bodies: settled piles and sparse scenes, in batches and one by one.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "random.h"
#include "rows.h"

enum { FAN = 1080, RAYS = 10 * FAN, REGIONS = 10000, POINTS = 20000, MOST_FOUND = 200 /* of a region, in the mean */ };

struct questions {
    struct asked asked;
    narc_points points;
    uint32_t *bodies; /* of points that are asked about one each */

    /* Answers, as far as the question has them. */
    narc_ray_hit *hits;
    narc_distance *distances;
    float *floats; /* a peer's */
    uint64_t *keys;
};

enum ray_kind { RAY_FAN, RAY_LONG, RAY_SHORT };
enum nearest_kind { NEAREST, DISTANCE };

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

/* So many rays in a call; of fans one each. */
static void cast_rays(const struct row *row, size_t batch, narc_ray_hit *out) {
    const struct questions *q = row->state;
    const narc_bodies bodies = bodies_of_scene(row->scene);
    const narc_ray_options options = {.inside = NARC_INSIDE_IGNORES};
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const struct ray *first = q->asked.rays + k;
        const narc_rays rays = {.count = batch < q->asked.count - k ? batch : q->asked.count - k,
                                .x = NARC_POSITION_COLUMN(first, x),
                                .y = NARC_POSITION_COLUMN(first, y),
                                .motion_x = NARC_COLUMN(first, motion_x),
                                .motion_y = NARC_COLUMN(first, motion_y)};
        narc_error error;
        must(narc_cast_rays(row->scene->index, row->scene->shapes, &bodies, &rays, &options, out + k, rays.count,
                            &error),
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

/* Appends pairs as keys region << 32 | body; how many keys there are now. */
static size_t add_keys(const narc_pairs *pairs, uint64_t first, uint64_t *keys, size_t count) {
    const uint32_t *a = pairs->a.base, *b = pairs->b.base;
    for (size_t k = 0; k < pairs->count; k++)
        keys[count++] = (first + a[k]) << 32 | b[k];
    return count;
}

static int compare_keys(const void *left, const void *right) {
    const uint64_t l = *(const uint64_t *)left, r = *(const uint64_t *)right;
    return (l > r) - (l < r);
}

/* How many keys only one of the two has. Sorts both. */
static size_t count_differences(uint64_t *left, size_t left_count, uint64_t *right, size_t right_count) {
    size_t differences = 0, l = 0, r = 0;
    qsort(left, left_count, sizeof *left, compare_keys);
    qsort(right, right_count, sizeof *right, compare_keys);
    while (l < left_count && r < right_count) {
        differences += left[l] != right[r];
        const bool next_left = left[l] <= right[r], next_right = right[r] <= left[l];
        l += next_left;
        r += next_right;
    }
    return differences + (left_count - l) + (right_count - r);
}

/* So many regions in a call. Keys are kept if they are wanted; returns how many. */
static size_t ask_index(const struct row *row, size_t batch, uint64_t *keys) {
    const struct questions *q = row->state;
    const narc_index_query query = {.workers = row->threads > 1 ? &row->workers : NULL};
    size_t count = 0;
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const size_t part = batch < q->asked.count - k ? batch : q->asked.count - k;
        narc_pairs pairs;
        narc_error error;
        must(narc_query_index(row->scene->index, q->asked.regions + k, part, &query, &pairs, &error), &error);
        if (keys)
            count = add_keys(&pairs, k, keys, count);
    }
    return count;
}

static void run_regions(struct row *row) {
    struct questions *q = row->state;
    if (row->peer)
        row->peer->ask(row->peer_state, &q->asked, q->keys);
    else
        ask_index(row, row->batch ? row->batch : q->asked.count, NULL);
}

/* What a peer finds, and what this library does one by one, against a batch of it. */
static void prepare_regions(struct row *row) {
    struct questions *q = begin(row, REGIONS);
    const size_t count = q->asked.count;
    uint64_t *expected = allocate(MOST_FOUND * count, sizeof *expected);
    q->asked.regions = make_regions(row->scene, row->question->what, count);
    q->keys = allocate(MOST_FOUND * count, sizeof *q->keys);
    const size_t expected_count = ask_index(row, count, expected);
    const size_t found = row->peer ? row->peer->ask(row->peer_state, &q->asked, q->keys)
                                   : ask_index(row, row->batch ? row->batch : count, q->keys);
    row->bench.hits = (double)expected_count / (double)count;
    row->bench.wrong = (double)count_differences(expected, expected_count, q->keys, found);
    free(expected);
    if (!row->peer) /* lists pairs in its index */
        free(q->keys);
}

/* ------------------------------------------------------------------------------------------------ the nearest body */

static void find_nearest(const struct row *row, size_t batch, narc_distance *out) {
    const struct questions *q = row->state;
    const narc_bodies bodies = bodies_of_scene(row->scene);
    const narc_nearest_options options = {.search.workers = row->threads > 1 ? &row->workers : NULL};
    for (size_t k = 0; k < q->asked.count; k += batch) {
        const narc_points points = {.count = batch < q->asked.count - k ? batch : q->asked.count - k,
                                    .x = NARC_POSITION_ARRAY(q->asked.x + k),
                                    .y = NARC_POSITION_ARRAY(q->asked.y + k)};
        narc_error error;
        must(narc_find_nearest(row->scene->index, row->scene->shapes, &bodies, &points, &options, out + k, points.count,
                               &error),
             &error);
    }
}

static void run_nearest(struct row *row) {
    struct questions *q = row->state;
    if (row->peer) {
        row->peer->ask(row->peer_state, &q->asked, q->floats);
    } else if (row->question->what == NEAREST) {
        find_nearest(row, row->batch ? row->batch : q->asked.count, q->distances);
    } else {
        const narc_bodies bodies = bodies_of_scene(row->scene);
        const narc_index_column named = NARC_ARRAY(q->bodies);
        narc_error error;
        must(narc_find_distances(row->scene->shapes, &bodies, &q->points, named, NULL, q->distances, &error), &error);
    }
}

/* Within bodies peers name another depth, or none. */
static void prepare_nearest(struct row *row) {
    struct questions *q = begin(row, POINTS);
    const size_t count = q->asked.count;
    const double half = row->scene->half;
    narc_distance *expected = allocate(count, sizeof *expected);
    float *x = allocate(count, sizeof *x), *y = allocate(count, sizeof *y);
    uint64_t random = 78;
    for (size_t k = 0; k < count; k++) {
        x[k] = (float)random_between(&random, -half, half);
        y[k] = (float)random_between(&random, -half, half);
    }
    q->asked.x = x;
    q->asked.y = y;
    q->points = (narc_points){.count = count, .x = NARC_POSITION_ARRAY(x), .y = NARC_POSITION_ARRAY(y)};
    q->bodies = allocate(count, sizeof *q->bodies);
    q->distances = allocate(count, sizeof *q->distances);
    q->floats = allocate(count, sizeof *q->floats);
    find_nearest(row, count, expected);
    for (size_t k = 0; k < count; k++)
        q->bodies[k] = expected[k].body;
    run_nearest(row);
    for (size_t k = 0; k < count; k++) {
        const float separation = expected[k].separation;
        row->bench.hits += (separation < 0) / (double)count;
        if (row->peer)
            row->bench.wrong += fabs((double)(separation - q->floats[k])) > 1e-3 && separation > 0;
        else
            row->bench.wrong += q->distances[k].separation != separation;
    }
    free(expected);
}

const struct question scene_questions[] = {{"ray-fan", prepare_rays, run_rays, RAY_FAN, false},
                                           {"ray-long", prepare_rays, run_rays, RAY_LONG, false},
                                           {"ray-short", prepare_rays, run_rays, RAY_SHORT, false},
                                           {"region-48", prepare_regions, run_regions, 48, false},
                                           {"region-3", prepare_regions, run_regions, 3, false},
                                           {"nearest", prepare_nearest, run_nearest, NEAREST, false},
                                           {"distance", prepare_nearest, run_nearest, DISTANCE, false},
                                           {.name = NULL}};
