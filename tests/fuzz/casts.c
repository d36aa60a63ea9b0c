/* SPDX-License-Identifier: MIT
 *
 * casts.c - rays, times of impact and distances in a scene from arbitrary bytes: the same bits on every instruction
 * set, and right where the bodies are sound.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "fuzz.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "ray_reference.h"

enum { BODIES = 12, RAYS = 8, PAIRS = RAYS };

struct question {
    struct scene scene;
    narc_index *index;
    narc_box boxes[BODIES];
    struct test_ray rays[RAYS];
    narc_motion motions[BODIES];
    narc_ray_options rays_asked;
    uint32_t owner[BODIES];
    float target, parting;
    size_t chosen; /* a ray and a pair for the references, which take long */
};

struct answer {
    narc_ray_hit hits[RAYS];
    narc_impact impacts[PAIRS], first[BODIES];
    narc_distance distances[RAYS], nearest[2 * RAYS];
    narc_ray_hit hits_of_things[2 * RAYS];
    narc_distance nearest_things[2 * RAYS];
    narc_ray_hit alone[RAYS]; /* ray k at body k */
    uint64_t inside[NARC_BIT_WORDS(RAYS)];
};

static void ask(const void *question, const narc_workers *workers, void *out_answer) {
    const struct question *const q = question;
    struct answer *const answer = out_answer;
    const narc_bodies bodies = scene_bodies(&q->scene);
    const narc_pairs pairs = scene_pairs(&q->scene);
    const narc_shapes *const store = q->scene.store;
    const narc_rays rays = view_rays(q->rays, RAYS);
    const narc_points points = {.count = RAYS, .x = rays.x, .y = rays.y};
    const narc_motions motions = {
        NARC_COLUMN(q->motions, x), NARC_COLUMN(q->motions, y), NARC_COLUMN(q->motions, angle), {NULL}};
    const narc_index_query search = {.workers = workers};
    const narc_cast_options cast = {.target = q->target, .parting = q->parting, .workers = workers};
    narc_nearest_options near = {.search = search, .distance = 5, .most = 2};
    narc_ray_options through = q->rays_asked;
    through.search.workers = workers;
    assert_int_equal(narc_cast_rays(q->index, store, &bodies, &rays, &through, answer->hits, RAYS, NULL), NARC_OK);
    assert_int_equal(narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, &cast, answer->impacts, PAIRS, NULL),
                     NARC_OK);
    assert_int_equal(
        narc_cast_shapes(q->index, store, &bodies, &bodies, &motions, &search, &cast, answer->first, BODIES, NULL),
        NARC_OK);
    assert_int_equal(narc_find_distances(store, &bodies, &points, NULL, workers, answer->distances, NULL), NARC_OK);
    assert_int_equal(narc_find_inside(store, &bodies, &points, NULL, workers, answer->inside, NULL), NARC_OK);
    assert_int_equal(narc_cast_ray_pairs(store, &bodies, &rays, NULL, &through, answer->alone, RAYS, NULL), NARC_OK);
    assert_int_equal(narc_find_nearest(q->index, store, &bodies, &points, &near, answer->nearest, 2 * RAYS, NULL),
                     NARC_OK);
    const narc_owners owners = {.owner = NARC_ARRAY(q->owner)};
    through.search.owners = near.search.owners = &owners;
    through.most = 2;
    assert_int_equal(narc_cast_rays(q->index, store, &bodies, &rays, &through, answer->hits_of_things, 2 * RAYS, NULL),
                     NARC_OK);
    assert_int_equal(
        narc_find_nearest(q->index, store, &bodies, &points, &near, answer->nearest_things, 2 * RAYS, NULL), NARC_OK);
}

/* One row a thing. Outside its nearest part is the nearest body, and the first that stops a ray. */
static void check_things(const struct question *q, size_t k, const struct answer *answer) {
    const narc_ray_hit *const hit = &answer->hits_of_things[2 * k];
    const narc_distance *const near = &answer->nearest_things[2 * k];
    if (hit[1].count)
        assert_true(q->owner[hit[0].body] == UINT32_MAX || q->owner[hit[0].body] != q->owner[hit[1].body]);
    if (near[1].count)
        assert_true(q->owner[near[0].body] == UINT32_MAX || q->owner[near[0].body] != q->owner[near[1].body]);
    const narc_distance *const part = &answer->nearest[2 * k];
    if (near->separation < 0) { /* a thing is at least as deep as its parts, but for what connects parts */
        const struct reference_body body = scene_reference(&q->scene, part->body);
        double most = hypot(q->rays[k].x - body.x, q->rays[k].y - body.y) + reference_extent(&body);
        for (uint32_t b = 0; b < BODIES; b++)
            if (q->owner[b] == q->owner[part->body] && q->boxes[b].min_x <= q->boxes[b].max_x) {
                const struct reference_body other = scene_reference(&q->scene, b);
                most = fmax(most, reference_extent(&other));
            }
        assert_true((double)near->separation <= (double)part->separation + 8 * NARC_ERROR_BOUND * most);
    } else
        assert_memory_equal(near, part, sizeof *near);
    if (q->rays_asked.inside == NARC_INSIDE_STOPS)
        assert_memory_equal(hit, &answer->hits[k], sizeof *hit);
}

/* The nearest of a point are those of all bodies' distances, but of what has no box. */
static void check_nearest(const struct question *q, size_t point, const narc_distance nearest[2]) {
    const narc_bodies bodies = scene_bodies(&q->scene);
    narc_rays one = view_rays(q->rays + point, BODIES);
    narc_distance all[BODIES], best[2] = {{.point = (uint32_t)point}, {.point = (uint32_t)point}};
    one.x.stride = one.y.stride = 0;
    const narc_points points = {.count = BODIES, .x = one.x, .y = one.y};
    assert_int_equal(narc_find_distances(q->scene.store, &bodies, &points, NULL, NULL, all, NULL), NARC_OK);
    for (size_t k = 0; k < BODIES; k++) {
        narc_distance *const row = &all[k];
        row->point = (uint32_t)point;
        if (row->count == 0 || !(row->separation < 5) || !(q->boxes[k].min_x <= q->boxes[k].max_x))
            continue;
        const size_t place = best[0].count == 0 || row->separation < best[0].separation ? 0 : 1;
        if (place == 0)
            best[1] = best[0];
        if (place == 0 || best[1].count == 0 || row->separation < best[1].separation)
            best[place] = *row;
    }
    assert_memory_equal(nearest, best, sizeof best);
}

/* Is a ray's hit right for the body that it tells of, and is no other body in the way? */
static void check_ray(const struct question *q, size_t k, const narc_ray_hit *hit) {
    for (uint32_t b = 0; b < BODIES; b++) {
        const struct body *const body = &q->scene.bodies[b];
        const struct outline_reference outline = make_outline_reference(&q->scene.shapes[body->shape]);
        struct ray_errors worst = {0};
        if (hit->count == 0 || hit->body == b) {
            const char *const wrong = check_ray_hit(&outline, body, &q->rays[k], q->rays_asked.inside, hit, &worst);
            if (wrong)
                fail_msg("ray %zu, body %u: %s", k, b, wrong);
        }
    }
}

/* The separation of a pair when that part of its motion is done. */
static double separation_at(const struct question *q, uint32_t pair, double time, double *out_bound) {
    struct reference_body two[2];
    const uint32_t numbers[2] = {q->scene.pairs[pair].a, q->scene.pairs[pair].b};
    for (int k = 0; k < 2; k++) {
        const narc_motion *const motion = &q->motions[numbers[k]];
        struct reference_body body = scene_reference(&q->scene, numbers[k]);
        const double angle = atan2(body.sine, body.cosine) + time * (double)motion->angle;
        body.x += time * (double)motion->x;
        body.y += time * (double)motion->y;
        body.cosine = cos(angle);
        body.sine = sin(angle);
        two[k] = body;
    }
    *out_bound = 2 * separation_bound(&two[0], &two[1]);
    return reference_find_gap(&two[0], &two[1]).gap;
}

static void check_impact(const struct question *q, const narc_impact *impact) {
    const double end = impact->count == NARC_CAST_MISS ? 1 : (double)impact->fraction;
    double bound, speed = 0, target = (double)q->target;
    if (q->parting > 0) /* no deeper than that, and what turning may add */
        target = fmin(target, separation_at(q, impact->pair, 0, &bound) - (double)q->parting - 0.1 - 2 * bound);
    for (int k = 0; k < 2; k++) {
        const narc_motion *const motion =
            &q->motions[k ? q->scene.pairs[impact->pair].b : q->scene.pairs[impact->pair].a];
        speed += fabs((double)motion->x) + fabs((double)motion->y) + 20 * fabs((double)motion->angle);
    }
    for (int k = 0; k < 8; k++) {
        const double at = separation_at(q, impact->pair, end * k / 8, &bound);
        assert_true(end == 0 || at >= target - bound - 0x1p-23 * speed);
    }
    if (impact->count == NARC_CAST_HIT && end > 0)
        assert_true(separation_at(q, impact->pair, end, &bound) <= (double)q->target + 0.05 + bound + 0x1p-23 * speed);
}

static void check(const struct question *q, const struct answer *answer) {
    const narc_bodies bodies = scene_bodies(&q->scene);
    for (size_t k = 0; k < RAYS; k++) {
        const narc_ray_hit *const alone = &answer->alone[k], *const first = &answer->hits[k];
        assert_int_equal(bit_is_set(answer->inside, k), answer->distances[k].separation < 0);
        if (!(q->boxes[k].min_x <= q->boxes[k].max_x)) /* it is in no index */
            assert_true(!first->count || first->body != k);
        else if (alone->count) /* among others it is no later */
            assert_true(first->count && first->fraction <= alone->fraction &&
                        (first->body != k || memcmp(first, alone, sizeof *first) == 0));
        else
            assert_true(!first->count || first->body != k);
        check_nearest(q, k, answer->nearest + 2 * k);
        check_things(q, k, answer);
    }
    if (narc_validate_bodies(q->scene.store, &bodies, NULL) != NARC_OK)
        return;
    if (q->rays[q->chosen].motion_x != 0 || q->rays[q->chosen].motion_y != 0)
        check_ray(q, q->chosen, &answer->hits[q->chosen]);
    check_impact(q, &answer->impacts[q->chosen]);
    for (size_t k = 0; k < RAYS; k++) {
        const narc_distance *const row = &answer->distances[k];
        const struct reference_body body = scene_reference(&q->scene, (uint32_t)k);
        const double x = q->rays[k].x - body.x, y = q->rays[k].y - body.y;
        if (fmax(fabs(x), fabs(y)) > NARC_MAX_DISTANCE)
            continue;
        assert_true(row->count == 1 && row->body == k);
        assert_true(fabs((double)row->separation - reference_point_distance(&body, x, y)) <=
                    NARC_ERROR_BOUND * (hypot(x, y) + reference_extent(&body)));
    }
}

static double take_step(struct bytes *from, double size) {
    const double step = take_number(from, size);
    return fabs(step) <= size ? step : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct question q = {.chosen = take_below(&from, RAYS)};
    q.scene = take_scene(&from, 4, BODIES, PAIRS);
    const narc_bodies bodies = scene_bodies(&q.scene);
    q.rays_asked.inside = (narc_inside)take_below(&from, 3);
    q.target = (float)take_step(&from, 0.5);
    q.parting = take_below(&from, 2) ? 0 : fabsf((float)take_step(&from, 0.25));
    for (size_t k = 0; k < BODIES; k++)
        q.motions[k] = (narc_motion){(float)take_step(&from, 8), (float)take_step(&from, 8),
                                     take_below(&from, 2) ? (float)take_step(&from, 3) : 0};
    for (size_t k = 0; k < RAYS; k++)
        q.rays[k] = (struct test_ray){(double)(float)take_step(&from, 8), (double)(float)take_step(&from, 8),
                                      (float)take_step(&from, 16), (float)take_step(&from, 16), 1};
    const narc_index_options options = {.fast = take_below(&from, 2)};
    take_flights(&from, &q.scene);
    for (size_t k = 0; k < BODIES; k++)
        q.owner[k] = (uint32_t)take_below(&from, 4) - 1;
    assert_int_equal(narc_compute_boxes(q.scene.store, &bodies, NULL, q.boxes, NULL), NARC_OK);
    assert_int_equal(narc_create_index(NULL, &q.index), NARC_OK);
    assert_int_equal(narc_build_index(q.index, q.boxes, BODIES, &options, NULL), NARC_OK);
    AUTO(free_at) struct answer *const answer = ask_everywhere(ask, &q, sizeof *answer, NULL);
    check(&q, answer);
    narc_destroy_index(q.index);
    destroy_scene(&q.scene);
    return 0;
}
