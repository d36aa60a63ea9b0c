/* SPDX-License-Identifier: MIT
 *
 * casts.c - times of impact beside Box2D: pairs of bodies that fly at each other, with and without turning, in batches and
 * one by one. The libraries take turns within one process.
 *
 *     bench_casts [--pairs=1000] [--rounds=25]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "narc_scene.h"
#include "peers.h"
#include "random.h"
#include "setting.h"

enum { POINTS = 8 };

/* ------------------------------------------------------------------------------------------------ shapes */

/* A shape, and the polygon that stands for it in Box2D. */
struct kind {
    const char *name;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    struct peer_polygon polygon;
};

static void add_box(struct kind *kind, const char *name, double width, double height) {
    kind->name = name;
    must(narc_build_box(width, height, 0, kind->arcs, &kind->count, NULL), NULL);
    kind->polygon.count = 4;
    for (int k = 0; k < 4; k++) {
        kind->polygon.x[k] = (float)(k == 0 || k == 3 ? -width / 2 : width / 2);
        kind->polygon.y[k] = (float)(k < 2 ? -height / 2 : height / 2);
    }
}

static void add_round(struct kind *kind, const char *name, double half_y) {
    kind->name = name;
    kind->polygon.count = POINTS;
    for (int k = 0; k < POINTS; k++) {
        kind->polygon.x[k] = (float)cos(2 * pi * k / POINTS);
        kind->polygon.y[k] = (float)(half_y * sin(2 * pi * k / POINTS));
    }
}

enum { KINDS = 4 };

static void make_kinds(struct kind kinds[KINDS]) {
    add_box(&kinds[0], "boxes 1 : 1", 1.4, 1.4);
    add_box(&kinds[1], "boxes 1 : 8", 2, 0.25);
    add_round(&kinds[2], "8-gons", 1);
    must(narc_build_regular_polygon(POINTS, 1, 0, kinds[2].arcs, &kinds[2].count, NULL), NULL);
    add_round(&kinds[3], "n-arcs of 8", 0.6);
    must(narc_build_ellipse(1, 0.6, POINTS, kinds[3].arcs, &kinds[3].count, NULL, NULL), NULL);
}

/* ------------------------------------------------------------------------------------------------ pairs */

struct questions {
    const struct setting *setting;
    const struct kind *kind;
    narc_shapes *shapes;
    narc_body *bodies;
    struct peer_motion *motions;
    narc_contact *contacts;
    narc_impact *impacts;
    float *fractions;
    bool turning;
};

/* B is 2 to 4 away from A; both fly up to 4 roughly at each other, or, if they are to miss, anywhere. */
static void make_pairs(struct questions *q, double turning, bool astray) {
    uint64_t random = 99;
    q->turning = turning > 0;
    for (size_t k = 0; k < 2 * q->setting->questions; k++) {
        const bool is_b = k % 2;
        static double direction, distance;
        if (!is_b) {
            direction = random_between(&random, -pi, pi);
            distance = random_between(&random, 2, 4);
        }
        const double angle = random_between(&random, -pi, pi), way = random_between(&random, 0, 4);
        const double to = direction + (is_b ? pi : 0) + random_between(&random, -1, 1) * (astray ? pi : 0.6);
        q->bodies[k] = (narc_body){is_b ? distance * cos(direction) : 0,
                                   is_b ? distance * sin(direction) : 0,
                                   (float)cos(angle),
                                   (float)sin(angle),
                                   1,
                                   0};
        q->motions[k] = (struct peer_motion){(float)(way * cos(to)), (float)(way * sin(to)),
                                             (float)(turning * random_between(&random, -1, 1))};
    }
}

static narc_motions motions_of(const struct questions *q, size_t first) {
    return (narc_motions){.x = NARC_COLUMN(q->motions + first, x),
                          .y = NARC_COLUMN(q->motions + first, y),
                          .angle = q->turning ? (narc_float_column)NARC_COLUMN(q->motions + first, angle)
                                              : (narc_float_column){NULL}};
}

static void cast_pairs(const struct questions *q, size_t batch) {
    for (size_t k = 0; k < q->setting->questions; k += batch) {
        const narc_bodies bodies = narc_view_bodies(q->bodies + 2 * k, 2 * batch);
        const narc_motions motions = motions_of(q, 2 * k);
        const narc_pairs pairs = {.count = batch};
        narc_error error;
        must(narc_cast_pairs(q->shapes, &bodies, &motions, &pairs, NULL, NULL, q->impacts + k, batch, &error), &error);
    }
}

static void find_contacts(const struct questions *q) {
    const size_t count = q->setting->questions;
    const narc_bodies bodies = narc_view_bodies(q->bodies, 2 * count);
    const narc_query query = {.margin = INFINITY, .dense = 1};
    size_t found;
    narc_error error;
    must(narc_find_contacts(q->shapes, &bodies, &(narc_pairs){.count = count}, &query, q->contacts, count, &found,
                            &error),
         &error);
}

/* ------------------------------------------------------------------------------------------------ table */

enum { CONTACT, CAST, ONE, PEER, WAYS };

static void compare(const struct questions *q, const char *name) {
    double ns[WAYS][MOST_ROUNDS], median[WAYS];
    size_t hits = 0, peer_hits = 0, unfinished = 0;
    const size_t count = q->setting->questions;
    for (size_t round = 0; round < q->setting->rounds; round++)
        for (int way = 0; way < WAYS; way++) {
            const double start = now();
            if (way == CONTACT)
                find_contacts(q);
            else if (way == PEER)
                box2d_find_impacts(&q->kind->polygon, q->bodies, q->motions, count, q->fractions);
            else
                cast_pairs(q, way == CAST ? count : 1);
            ns[way][round] = (now() - start) / (double)count;
        }
    for (int way = 0; way < WAYS; way++)
        median[way] = quantile(ns[way], q->setting->rounds, 0.5);
    for (size_t k = 0; k < count; k++) {
        hits += q->impacts[k].count == NARC_CAST_HIT;
        unfinished += q->impacts[k].count == NARC_CAST_UNFINISHED;
        peer_hits += q->fractions[k] <= 1;
    }
    printf("| %s | %s | %zu (%zu), %zu | %.0f | %.0f (%.1f) | %.0f | %.0f (%.1f, %.1f) |\n", q->kind->name, name, hits,
           unfinished, peer_hits, median[CONTACT], median[CAST], median[CAST] / median[CONTACT], median[ONE],
           median[PEER], median[PEER] / median[CAST], median[PEER] / median[ONE]);
    fflush(stdout);
}

int main(int argc, char **argv) {
    const struct setting s = read_setting(argc, argv, "--pairs=", 1000, 25);
    struct kind kinds[KINDS];
    make_kinds(kinds);
    printf("%s, %s, %s; one thread, ns a pair; beside %s\n\n", processor_name(), compiler_name, choose_best_isa(),
           box2d_name());
    printf("| Shapes | Motion | Hit (unfinished), Box2D | Contact | Cast (times contact) | one by one | Box2D (times "
           "batch, one by one) |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for (int k = 0; k < KINDS; k++) {
        struct questions q = {.setting = &s, .kind = &kinds[k]};
        q.bodies = allocate(2 * s.questions, sizeof *q.bodies);
        q.motions = allocate(2 * s.questions, sizeof *q.motions);
        q.contacts = allocate(s.questions, sizeof *q.contacts);
        q.impacts = allocate(s.questions, sizeof *q.impacts);
        q.fractions = allocate(s.questions, sizeof *q.fractions);
        uint32_t shape;
        must(narc_create_shapes(NULL, &q.shapes), NULL);
        must(narc_add_shape(q.shapes, kinds[k].arcs, kinds[k].count, &shape, NULL), NULL);
        make_pairs(&q, 0, false);
        compare(&q, "straight");
        make_pairs(&q, 0, true);
        compare(&q, "straight, anywhere");
        make_pairs(&q, 1, false);
        compare(&q, "turning by up to 1");
        make_pairs(&q, 1, true);
        compare(&q, "turning by up to 1, anywhere");
        make_pairs(&q, 6, false);
        compare(&q, "turning by up to 6");
        narc_destroy_shapes(q.shapes);
        free(q.bodies);
        free(q.motions);
        free(q.contacts);
        free(q.impacts);
        free(q.fractions);
    }
    return 0;
}
