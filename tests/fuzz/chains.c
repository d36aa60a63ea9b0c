/* SPDX-License-Identifier: MIT
 *
 * chains.c - chains from arbitrary bytes, and bodies on their pieces: the same bits on every instruction set, the same
 * answers from all questions, and of ground of ordinary size contacts that lie on it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "merge.h"
#include "narc.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "turtle.h"

enum { BODIES = 4, STEPS = 16, ENTRIES = 256, PAIRS = 48, ROWS = 1024 };

struct question {
    struct scene scene; /* its pairs are not asked of */
    struct turtle chain;
    double size; /* of ordinary ground, else 0 */
    bool closed;
    narc_body ground[ENTRIES];
    uint32_t run[ENTRIES];
    size_t entries;
    struct pair pairs[PAIRS];
    float motion_x[BODIES], motion_y[BODIES], angle[BODIES], target;
    narc_query query;
    size_t room; /* for rows, too few perhaps */
};

struct answer {
    uint64_t bits;
    size_t count, few_count, manifold_count, merged_count, dense_count, skipped;
    narc_status few;
    narc_contact contacts[ROWS], few_contacts[PAIRS], merged[ROWS], dense[PAIRS], below[ROWS];
    size_t below_count;
    narc_manifold manifolds[ROWS];
    narc_impact impacts[PAIRS];
    narc_distance distances[PAIRS];
};

static void ask(const void *question, const narc_workers *workers, void *out_answer) {
    const struct question *const q = question;
    struct answer *const answer = out_answer;
    const narc_shapes *const store = q->scene.store;
    const narc_bodies bodies = scene_bodies(&q->scene);
    narc_bodies ground;
    narc_view_bodies(q->ground, q->entries, &ground);
    const narc_pairs pairs = {
        .count = PAIRS, .a = NARC_COLUMN(q->pairs, a), .b = NARC_COLUMN(q->pairs, b), .other_bodies = &ground};
    const narc_motions motions = {NARC_ARRAY(q->motion_x), NARC_ARRAY(q->motion_y), NARC_ARRAY(q->angle), {NULL}};
    const narc_points points = {
        BODIES, NARC_POSITION_COLUMN(q->scene.bodies, x), NARC_POSITION_COLUMN(q->scene.bodies, y), {NULL}};
    const narc_cast_options cast = {.target = q->target, .workers = workers};
    const narc_query touching = {.workers = workers};
    narc_query query = q->query;
    memset(answer, 0, sizeof *answer);
    query.workers = workers;
    query.out_skipped = &answer->skipped;
    assert_int_equal(narc_find_overlaps(store, &bodies, &pairs, &query, &answer->bits, NULL), NARC_OK);
    assert_int_equal(narc_find_contacts(store, &bodies, &pairs, &query, answer->contacts, ROWS, &answer->count, NULL),
                     NARC_OK);
    assert_int_equal(
        narc_find_contacts(store, &bodies, &pairs, &touching, answer->below, ROWS, &answer->below_count, NULL),
        NARC_OK);
    answer->few =
        narc_find_contacts(store, &bodies, &pairs, &query, answer->few_contacts, q->room, &answer->few_count, NULL);
    assert_int_equal(
        narc_find_manifolds(store, &bodies, &pairs, &query, answer->manifolds, ROWS, &answer->manifold_count, NULL),
        NARC_OK);
    query.dense = 1;
    assert_int_equal(
        narc_find_contacts(store, &bodies, &pairs, &query, answer->dense, PAIRS, &answer->dense_count, NULL), NARC_OK);
    /* Behind the last row there may be anything. */
    memset(answer->contacts + answer->count, 0, (ROWS - answer->count) * sizeof *answer->contacts);
    memset(answer->below + answer->below_count, 0, (ROWS - answer->below_count) * sizeof *answer->below);
    memset(answer->manifolds + answer->manifold_count, 0, (ROWS - answer->manifold_count) * sizeof *answer->manifolds);
    memset(answer->few_contacts + (answer->few_count < q->room ? answer->few_count : q->room), 0,
           (PAIRS - (answer->few_count < q->room ? answer->few_count : q->room)) * sizeof *answer->few_contacts);
    memcpy(answer->merged, answer->contacts, sizeof answer->merged);
    answer->merged_count = narc_merge_rows(
        &(narc_merging){&pairs, NARC_ARRAY(q->run), store, &ground, .contacts = answer->merged}, answer->count);
    assert_true(answer->merged_count <= answer->count);
    memset(answer->merged + answer->merged_count, 0, (ROWS - answer->merged_count) * sizeof *answer->merged);
    assert_int_equal(narc_cast_pairs(store, &bodies, &motions, &pairs, NULL, &cast, answer->impacts, PAIRS, NULL),
                     NARC_OK);
    for (size_t k = 0; k < PAIRS; k += BODIES) /* of one body of the ground after the other */
        assert_int_equal(narc_find_distances(store, &ground, &points, &(narc_index_column){&q->pairs[k].b, 0}, workers,
                                             &answer->distances[k], NULL),
                         NARC_OK);
}

/* ------------------------------------------------------------------------------------------------ checks */

static double distance_from_edge(narc_point from, narc_point to, narc_point p) {
    const double x = to.x - from.x, y = to.y - from.y, square = x * x + y * y;
    const double t = square > 0 ? fmin(fmax(((p.x - from.x) * x + (p.y - from.y) * y) / square, 0), 1) : 0;
    return hypot(p.x - from.x - t * x, p.y - from.y - t * y);
}

static narc_point point_of(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

/* How far a point is from a chain's outline. */
static double distance_from_chain(const struct question *q, narc_point p) {
    double least = INFINITY;
    for (size_t k = 0; k < q->chain.count; k++) {
        const narc_arc *const arc = &q->chain.arcs[k];
        const double sign = signbit(arc->radius) ? -1 : 1, middle = (arc->start + arc->end) / 2;
        const double x = sign * (p.x - arc->center_x), y = sign * (p.y - arc->center_y);
        if (fabs(remainder(atan2(y, x) - middle, 2 * PI)) <= fabs(arc->end - arc->start) / 2)
            least = fmin(least, fabs(hypot(x, y) - fabs(arc->radius)));
        if (k > 0 || q->closed) {
            const narc_arc *const before = k ? arc - 1 : &q->chain.arcs[q->chain.count - 1];
            least = fmin(least, distance_from_edge(point_of(before, before->end), point_of(arc, arc->start), p));
        }
    }
    const narc_point first = point_of(&q->chain.arcs[0], q->chain.arcs[0].start);
    return fmin(least, hypot(p.x - first.x, p.y - first.y));
}

static double find_extent(const struct question *q, uint32_t shape) {
    narc_arc arcs[NARC_MAX_ARCS];
    double extent = 0;
    const size_t count = narc_get_arcs(q->scene.store, shape, arcs);
    for (size_t k = 0; k < count; k++)
        extent = fmax(extent, hypot(arcs[k].center_x, arcs[k].center_y) + fabs(arcs[k].radius));
    return extent;
}

/* Does the contact lie on the ground? */
static void check_place(const struct question *q, const narc_contact *row) {
    const struct body *const body = &q->scene.bodies[q->pairs[row->pair].a];
    const narc_body *const piece = &q->ground[q->pairs[row->pair].b];
    const double half = (double)row->separation / 2;
    const narc_point at = {body->x + (double)row->point_x + half * (double)row->normal_x,
                           body->y + (double)row->point_y + half * (double)row->normal_y};
    const double room = 2 * NARC_ERROR_BOUND *
                        (hypot(body->x - piece->x, body->y - piece->y) +
                         (double)body->scale * find_extent(q, body->shape) + find_extent(q, piece->shape));
    if (q->size > 0 && distance_from_chain(q, at) > room + 1e-4 * q->size)
        fail_msg("pair %u: the contact at %g, %g is %g from the ground", row->pair, at.x, at.y,
                 distance_from_chain(q, at));
}

static void check_row(const struct question *q, const narc_contact *row) {
    const uint32_t shape = q->ground[q->pairs[row->pair].b].shape;
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(q->scene.store, shape, arcs);
    const unsigned number = arc_of_b(row->feature), edge = row->feature >> 8 & NARC_FEATURE_EDGE;
    assert_true(row->count == 1 && row->pair < PAIRS && row->separation < q->query.margin);
    const double length = hypot((double)row->normal_x, (double)row->normal_y);
    assert_true(fabs(length - 1) < 1e-5);
    if (narc_shape_flags(q->scene.store, shape) & NARC_SHAPE_RUN)
        assert_true(number >= 1 && number + (edge ? 5 : 6) <= count);
    else
        assert_true(number == 0 && !edge && row->radius_b <= 0);
    check_place(q, row);
}

static void check_impact(const struct question *q, size_t k, const narc_impact *impact) {
    assert_true(impact->pair == k && impact->count <= NARC_CAST_UNFINISHED);
    assert_true(impact->fraction >= 0 && impact->fraction <= 1);
    (void)q;
}

static void check(const struct question *q, const struct answer *answer) {
    uint64_t touching = 0;
    size_t found = 0;
    assert_int_equal(answer->few, answer->count > q->room ? NARC_ERROR_CAPACITY : NARC_OK);
    assert_true(answer->few_count == answer->count && answer->manifold_count == answer->count);
    assert_memory_equal(answer->few_contacts, answer->contacts,
                        (answer->count < q->room ? answer->count : q->room) * sizeof *answer->contacts);
    for (size_t k = 0; k < answer->below_count; k++)
        touching |= (uint64_t)1 << answer->below[k].pair;
    assert_true(touching == answer->bits);
    for (size_t k = 0; k < answer->count; k++) {
        const narc_contact *const row = &answer->contacts[k];
        const narc_manifold *const manifold = &answer->manifolds[k];
        assert_true(k == 0 || row[-1].pair <= row->pair);
        check_row(q, row);
        assert_true(manifold->pair == row->pair && manifold->normal_x == row->normal_x &&
                    manifold->normal_y == row->normal_y);
        assert_true(manifold->point[0].separation == row->separation ||
                    manifold->point[1].separation == row->separation);
        if (k == 0 || row[-1].pair != row->pair)
            found++;
        assert_true(answer->dense[row->pair].separation <= row->separation);
    }
    assert_int_equal(answer->dense_count, found);
    for (size_t k = 0; k < PAIRS; k++)
        check_impact(q, k, &answer->impacts[k]);
}

/* ------------------------------------------------------------------------------------------------ chains */

static double take_size(struct bytes *from) {
    const double size = fabs(take_number(from, 2));
    return size > 0.05 && size < 4 ? size : take_below(from, 8) ? 0.5 : size;
}

static void take_step(struct bytes *from, struct turtle *t) {
    const unsigned kind = take_below(from, 8);
    const double turn = take_number(from, 1.5), size = take_size(from);
    if (kind < 5 && fabs(turn) < 3.2)
        walk_arc(t, kind == 0 ? 0 : size, turn);
    else if (kind == 5)
        walk_arc(t, 0, 0);
    else if (kind == 6)
        walk_line(t, size);
    else { /* as it comes */
        walk_arc(t, 1, 1);
        t->arcs[t->count - 1] = (narc_arc){take_number(from, 4), take_number(from, 4), take_number(from, 2),
                                           take_number(from, 3.25), take_number(from, 3.25)};
    }
}

static struct turtle take_chain(struct bytes *from, bool *out_closed) {
    if (take_below(from, 4) == 0) {
        *out_closed = true;
        return walk_gear(3 + take_below(from, 14), 0.1 * (1 + take_below(from, 30)));
    }
    struct turtle t = create_turtle(take_number(from, 2), take_number(from, 2), take_number(from, 3.25));
    const size_t steps = 1 + take_below(from, STEPS);
    *out_closed = take_below(from, 8) == 0;
    for (size_t k = 0; k < steps; k++)
        take_step(from, &t);
    walk_arc(&t, 0, take_below(from, 2) ? 0 : PI / 2);
    return t;
}

/* 0 if it is not of ordinary size. */
static double measure(const struct turtle *chain) {
    double most = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *const arc = &chain->arcs[k];
        most = fmax(most, fabs(arc->center_x) + fabs(arc->center_y) + fabs(arc->radius));
    }
    return most < 100 ? most : 0;
}

/* Adds the chain to the store, its entries to the ground: false if it is refused. Then nothing has changed. */
static bool add_chain(struct bytes *from, struct question *q) {
    const double weld = take_number(from, 8), tightest = take_number(from, 0.2);
    const narc_chain_options options = {.closed = q->closed,
                                        .first_run = take_below(from, 2),
                                        .weld = weld > 0.1 && weld < 100 ? weld : 0,
                                        .least_radius = fabs(tightest) < 1 ? fabs(tightest) : 0};
    static narc_chain_entry entries[ENTRIES];
    narc_shapes *const store = q->scene.store;
    const size_t shapes = narc_count_shapes(store);
    size_t needed = 0, count = 0;
    narc_error error;
    const narc_status asked = narc_add_chain(store, q->chain.arcs, q->chain.count, &options, NULL, 0, &needed, &error);
    assert_true(asked != NARC_OK && narc_count_shapes(store) == shapes);
    const narc_status status =
        narc_add_chain(store, q->chain.arcs, q->chain.count, &options, entries, ENTRIES, &count, &error);
    assert_true(asked == NARC_ERROR_CAPACITY ? status == NARC_OK || needed > ENTRIES : status == asked);
    if (status != NARC_OK) {
        assert_true(narc_count_shapes(store) == shapes);
        return false;
    }
    assert_true(count == needed && count > 0);
    q->entries = count;
    for (size_t k = 0; k < count; k++) {
        q->ground[k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        q->run[k] = entries[k].run;
    }
    return true;
}

static float take_bounded(struct bytes *from, double size) {
    const double number = take_number(from, size);
    return fabs(number) <= size ? (float)number : 0;
}

/* Bodies come near the pieces that they are asked of. */
static void take_pairs(struct bytes *from, struct question *q) {
    for (size_t k = 0; k < BODIES; k++) {
        struct body *const body = &q->scene.bodies[k];
        const narc_body *const piece = &q->ground[take_byte(from) % q->entries];
        body->x = piece->x + (double)take_bounded(from, 2);
        body->y = piece->y + (double)take_bounded(from, 2);
        round_position(body, q->scene.precision);
        q->motion_x[k] = take_bounded(from, 8);
        q->motion_y[k] = take_bounded(from, 8);
        q->angle[k] = take_below(from, 2) ? take_bounded(from, 3) : 0;
    }
    for (size_t k = 0; k < PAIRS; k++)
        q->pairs[k] = (struct pair){(uint32_t)(k / (PAIRS / BODIES)), (uint32_t)(take_byte(from) % q->entries)};
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static struct question q;
    struct bytes from = {data, size};
    memset(&q, 0, sizeof q);
    q.scene = take_scene(&from, 2, BODIES, 1);
    q.chain = take_chain(&from, &q.closed);
    if (add_chain(&from, &q)) {
        take_pairs(&from, &q);
        const double margin = take_number(&from, 1);
        q.query.margin = margin > 0 && margin < 10 ? (float)margin : 0.1F;
        q.room = take_below(&from, PAIRS + 1);
        q.target = take_bounded(&from, 0.25);
        q.size = measure(&q.chain);
        AUTO(free_at) struct answer *const answer = ask_everywhere(ask, &q, sizeof *answer, NULL);
        check(&q, answer);
    }
    free(q.chain.arcs);
    destroy_scene(&q.scene);
    return 0;
}
