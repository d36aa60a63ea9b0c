/* SPDX-License-Identifier: MIT
 *
 * ground.c - what ground costs in a step of many bodies: columns of three rounded boxes on hills, which shake a little; by
 * themselves, with the ground's entries among the bodies of the broad phase, which keeps the list, or with an index of
 * the entries that is asked in every step.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "narc_chains.h"
#include "random.h"
#include "rows.h"

/* A chain by walking from right to left, the air above. */
struct walk {
    narc_arc *arcs;
    size_t count;
    double x, y, normal; /* where it is, and the angle of the outward normal */
};

static void put_arc(struct walk *w, double radius, double sweep) {
    const double x = w->x - radius * cos(w->normal), y = w->y - radius * sin(w->normal);
    w->arcs[w->count++] = (narc_arc){x, y, radius, w->normal, w->normal + sweep};
    w->normal += sweep;
    w->x = x + radius * cos(w->normal);
    w->y = y + radius * sin(w->normal);
}

/* Convex, concave and straight pieces in turn, none steeper than half a radian. */
static struct walk walk_hills(size_t pieces, double size) {
    uint64_t random = 7;
    struct walk w = {.arcs = allocate(pieces + 2, sizeof(narc_arc)), .normal = pi / 2};
    put_arc(&w, 3 * size, 0.2);
    for (size_t k = 1; k < pieces; k++) {
        const double turn = random_between(&random, 0.05, 0.3), radius = size * random_between(&random, 1, 4);
        const bool left = w.normal + turn < pi / 2 + 0.5 && (w.normal - turn < pi / 2 - 0.5 || k % 2);
        put_arc(&w, left ? radius : -radius, left ? turn : -turn);
        if (random_below(&random, 3) == 0) {
            const double length = size * random_between(&random, 0.2, 2);
            w.x -= length * sin(w.normal);
            w.y += length * cos(w.normal);
            k++;
        }
    }
    return w;
}

struct country {
    narc_shapes *shapes;
    size_t made, pieces, steps, room;
    narc_body *bodies; /* the boxes, and behind them the ground */
    uint8_t *kinds;
    uint32_t *runs;
    narc_index *index; /* of the ground */
    narc_broad_phase *broad;
    narc_box *boxes;
    narc_manifold *rows;
};

static void build_index(struct country *c) {
    const narc_bodies pieces = narc_view_bodies(c->bodies + c->made, c->pieces);
    narc_box *boxes = allocate(c->pieces, sizeof *boxes);
    narc_error error;
    must(narc_compute_boxes(c->shapes, &pieces, NULL, boxes, &error), &error);
    must(narc_create_index(NULL, &c->index), NULL);
    must(narc_build_index(c->index, boxes, c->pieces, NULL, &error), &error);
    free(boxes);
}

static struct country make_country(const struct walk *walk, size_t count, double pitch) {
    const size_t most = 4 * walk->count + 100;
    struct country c = {.room = 20 * count + 1000};
    narc_chain_entry *entries = allocate(most, sizeof *entries);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count;
    uint32_t shape;
    narc_error error;
    must(narc_create_shapes(NULL, &c.shapes), NULL);
    must(narc_add_chain(c.shapes, walk->arcs, walk->count, NULL, entries, most, &c.pieces, &error), &error);
    must(narc_build_box(1, 1, 0.1, arcs, &arc_count, &error), &error);
    must(narc_add_shape(c.shapes, arcs, arc_count, &shape, &error), &error);
    must(narc_create_broad_phase(NULL, &c.broad), NULL);
    c.bodies = allocate(count + c.pieces, sizeof *c.bodies);
    c.kinds = allocate(count + c.pieces, 1);
    c.runs = allocate(count + c.pieces, sizeof *c.runs);
    c.rows = allocate(c.room, sizeof *c.rows);
    c.boxes = allocate(count, sizeof *c.boxes);
    double at = walk->arcs[0].center_x;
    for (size_t k = 1; k < walk->count && c.made + 3 <= count; k++) { /* a column stands where an arc begins */
        const narc_arc *a = &walk->arcs[k];
        const double x = a->center_x + a->radius * cos(a->start), y = a->center_y + a->radius * sin(a->start);
        if (x > at - pitch)
            continue;
        at = x;
        for (int level = 0; level < 3; level++) { /* rows of two boxes are of runs of their own */
            c.runs[c.made] = (uint32_t)(0x80000000u + c.made);
            c.bodies[c.made++] = (narc_body){x, y + 0.53 + 1.001 * level, 1, 0, 1, shape};
        }
    }
    for (size_t k = 0; k < c.pieces; k++) {
        c.bodies[c.made + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        c.kinds[c.made + k] = NARC_STATIC;
        c.runs[c.made + k] = entries[k].run;
    }
    free(entries);
    build_index(&c);
    return c;
}

/* The contacts of the boxes with the ground, merged. */
static size_t ask_index(const struct country *c) {
    const narc_bodies boxes = narc_view_bodies(c->bodies, c->made);
    const narc_bodies pieces = narc_view_bodies(c->bodies + c->made, c->pieces);
    const narc_box_options around = {.margin = 0.02f};
    const narc_query query = {.margin = 0.02f};
    const narc_index_column runs = {c->runs + c->made, sizeof *c->runs};
    narc_pairs pairs;
    narc_error error;
    size_t found;
    must(narc_compute_boxes(c->shapes, &boxes, &around, c->boxes, &error), &error);
    must(narc_query_index(c->index, c->boxes, boxes.count, NULL, &pairs, &error), &error);
    pairs.other_bodies = &pieces;
    must(narc_find_manifolds(c->shapes, &boxes, &pairs, &query, c->rows, c->room, &found, &error), &error);
    return narc_merge_manifolds(&pairs, runs, c->rows, found);
}

enum way { NONE, AMONG, INDEX };

/* Pairs and manifolds; merged, those of the ground. */
static size_t step(const struct country *c, int way) {
    const narc_bodies bodies = narc_view_bodies(c->bodies, way == AMONG ? c->made + c->pieces : c->made);
    const narc_pair_filter filter = {.kind = {c->kinds, 1}};
    const narc_pair_options options = {.margin = 0.02f, .skin = 0.05f, .filter = &filter};
    const narc_query query = {.margin = 0.02f};
    const narc_pair_list *list;
    size_t found;
    narc_error error;
    must(narc_update_pairs(c->broad, c->shapes, &bodies, &options, &list, &error), &error);
    must(narc_find_manifolds(c->shapes, &bodies, &list->pairs, &query, c->rows, c->room, &found, &error), &error);
    if (way == AMONG)
        found = narc_merge_manifolds(&list->pairs, (narc_index_column){c->runs, sizeof *c->runs}, c->rows, found);
    return way == INDEX ? found + ask_index(c) : found;
}

static void run(struct row *row) {
    struct country *c = row->state;
    const double start = now(), shake = c->steps++ % 2 ? 1e-3 : -1e-3;
    step(c, row->question->what);
    row->bench.seconds = 1e-9 * (now() - start);
    for (size_t k = 0; k < c->made; k++)
        c->bodies[k].x += shake;
}

/* On 100,000 pieces, each 1.1 long; or so short that the boxes stand on all of them. Both ways find the same contacts. */
static void prepare(struct row *row) {
    const size_t count = scaled(30000), pieces = scaled(100000);
    const bool is_short = strstr(row->bench.name, "/short-hills/") != NULL;
    const double length = is_short ? 1.2 * 1.1 * (double)count / 3 / (double)pieces : 1.1;
    const double pitch = fmax(1.1, 0.9 * length * (double)pieces / ((double)count / 3));
    const struct walk walk = walk_hills(pieces * 4 / 3, length / 0.45);
    struct country *c = row->state = allocate(1, sizeof *c);
    *c = make_country(&walk, count, pitch);
    const size_t by_index = step(c, INDEX), among = step(c, AMONG), none = step(c, NONE);
    step(c, row->question->what); /* whose list of pairs is kept */
    row->bench.count = 1;         /* a step */
    row->bench.hits = (double)(among - none);
    row->bench.wrong = (double)(among > by_index ? among - by_index : by_index - among);
    free(walk.arcs);
}

const struct question ground_questions[] = {{"ground-none", prepare, run, NONE, true},
                                            {"ground-among", prepare, run, AMONG, true},
                                            {"ground-index", prepare, run, INDEX, true},
                                            {.name = NULL}};
