/* SPDX-License-Identifier: MIT
 *
 * ground.c - what ground costs in a step: columns of three rounded boxes on hills, which shake a little, by themselves and
 * with the ground's entries behind them; balls or boxes, each on the ground, beside a peer's chain. Ground without end is
 * flat, and one piece.
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

/* One flat piece so long, between two more. */
static struct walk walk_flat(double length) {
    const double x[] = {0, -0.1, -length, -length - 1};
    struct walk w = {.arcs = allocate(4, sizeof(narc_arc)), .count = 4};
    for (size_t k = 0; k < w.count; k++)
        w.arcs[k] = (narc_arc){x[k], 0, 0, pi / 2, pi / 2};
    return w;
}

/* Where arcs and straight edges meet. */
static void list_points(const struct walk *walk, struct scene *out) {
    struct vector *points = allocate(2 * walk->count, sizeof *points);
    size_t count = 0;
    for (size_t k = 0; k < walk->count; k++)
        for (int end = 0; end < 2; end++) {
            const narc_arc *arc = &walk->arcs[k];
            const double angle = end ? arc->end : arc->start;
            const double x = arc->center_x + arc->radius * cos(angle), y = arc->center_y + arc->radius * sin(angle);
            if (count == 0 || hypot(x - points[count - 1].x, y - points[count - 1].y) > 1e-6)
                points[count++] = (struct vector){x, y};
        }
    out->ground = points;
    out->ground_count = count;
}

static const float margin = 0.02f;

struct country {
    struct scene scene; /* a peer's */
    narc_shapes *shapes;
    size_t made, pieces, steps;
    narc_body *bodies; /* the boxes, and behind them the ground */
    uint8_t *kinds;
    uint32_t *runs, *moved; /* the boxes */
    narc_contacts *contacts[2];
    struct pair *pairs; /* of boxes and entries; a peer's of segments and boxes */
    size_t pair_count;
    narc_manifold *manifolds;
    uint8_t *touching;
};

/* Bodies that are 1 high. */
static void add_column(struct country *c, double x, double y, int levels) {
    for (int level = 0; level < levels; level++) {
        c->runs[c->made] = NARC_NO_RUN;
        c->moved[c->made] = (uint32_t)c->made;
        c->bodies[c->made++] = (narc_body){x, y + 0.51 + 1.001 * level, 1, 0, 1, 0};
    }
}

/* Columns of so many bodies, on ground without end or on pieces. */
static struct country make_country(const struct walk *walk, bool endless, const struct outline *outline, size_t count,
                                   int levels, double pitch) {
    const size_t most = 4 * walk->count + 100;
    struct country c = {0};
    narc_chain_entry *entries = allocate(most, sizeof *entries);
    narc_error error;
    must(narc_create_shapes(NULL, &c.shapes), NULL);
    add_outline(c.shapes, outline);
    entries[0] = (narc_chain_entry){.run = NARC_NO_RUN};
    c.pieces = 1;
    if (endless)
        must(narc_add_half_plane(c.shapes, &entries[0].shape, &error), &error);
    else
        must(narc_add_chain(c.shapes, walk->arcs, walk->count, NULL, entries, most, &c.pieces, &error), &error);
    for (size_t way = 0; way < 2; way++)
        must(narc_create_contacts(NULL, &c.contacts[way], NULL), NULL);
    c.bodies = allocate(count + c.pieces, sizeof *c.bodies);
    c.kinds = allocate(count + c.pieces, 1);
    c.runs = allocate(count + c.pieces, sizeof *c.runs);
    c.moved = allocate(count, sizeof *c.moved);
    double at = walk->arcs[0].center_x;
    /* A column stands where an arc begins. */
    for (size_t k = 1; !endless && k < walk->count && c.made + (size_t)levels <= count; k++) {
        const narc_arc *a = &walk->arcs[k];
        const double x = a->center_x + a->radius * cos(a->start), y = a->center_y + a->radius * sin(a->start);
        if (x > at - pitch)
            continue;
        at = x;
        add_column(&c, x, y, levels);
    }
    while (endless && c.made + (size_t)levels <= count)
        add_column(&c, at -= pitch, 0, levels);
    for (size_t k = 0; k < c.pieces; k++) {
        c.bodies[c.made + k] = (narc_body){entries[k].x, entries[k].y, 1, 0, 1, entries[k].shape};
        c.kinds[c.made + k] = NARC_STATIC;
        c.runs[c.made + k] = entries[k].run;
    }
    free(entries);
    return c;
}

/* A step without the ground's entries, or with them; manifolds of pairs with them. */
enum way { NONE, AMONG, PAIRS };

static const narc_step_result *step(struct country *c, int way) {
    narc_bodies bodies;
    narc_view_bodies(c->bodies, way == AMONG ? c->made + c->pieces : c->made, &bodies);
    const narc_pair_filter filter = {.kind = {c->kinds, 1}};
    const narc_step asked = {.bodies = &bodies,
                             .margin = margin,
                             .skin = 0.05f,
                             .run = NARC_ARRAY(c->runs),
                             .moved = NARC_ARRAY(c->moved),
                             .moved_count = c->made,
                             .filter = &filter};
    const narc_step_result *result;
    narc_error error;
    must(narc_update_contacts(c->contacts[way], c->shapes, &asked, &result, &error), &error);
    return result;
}

static void keep_pairs(struct country *c, const narc_step_result *result) {
    const uint32_t *a = result->pairs.a.base, *b = result->pairs.b.base;
    c->pair_count = result->count;
    c->pairs = allocate(c->pair_count, sizeof *c->pairs);
    c->manifolds = allocate(c->pair_count, sizeof *c->manifolds);
    for (size_t k = 0; k < c->pair_count; k++)
        c->pairs[k] = (struct pair){a[result->order[k]], b[result->order[k]]};
}

static size_t find_rows(struct country *c) {
    narc_bodies bodies;
    narc_view_bodies(c->bodies, c->made + c->pieces, &bodies);
    const narc_pairs pairs = {.count = c->pair_count, .a = NARC_COLUMN(c->pairs, a), .b = NARC_COLUMN(c->pairs, b)};
    size_t found;
    narc_error error;
    must(narc_find_manifolds(c->shapes, &bodies, &pairs, &(narc_query){.margin = margin}, c->manifolds, c->pair_count,
                             &found, &error),
         &error);
    return found;
}

static void run(struct row *row) {
    struct country *c = row->state;
    const double start = now(), shake = c->steps++ % 2 ? 1e-3 : -1e-3;
    const bool pairs = row->question->what == PAIRS;
    if (row->peer && pairs)
        row->peer->ask(row->peer_state, &(struct asked){.count = c->pair_count, .pairs = c->pairs}, c->touching);
    else if (row->peer)
        row->bench.seconds = row->peer->step(row->peer_state, c->scene.bodies, c->moved, c->made, 0);
    else if (pairs)
        find_rows(c);
    else
        step(c, row->question->what);
    if (!row->peer || pairs)
        row->bench.seconds = 1e-9 * (now() - start);
    for (size_t k = 0; k < c->made; k++)
        c->bodies[k].x += shake;
    for (size_t k = 0; k < c->scene.body_count; k++)
        c->scene.bodies[k].x += (float)shake;
}

/* Bodies and points go from right to left. */
static void pair_segments(struct country *c) {
    const struct vector *points = c->scene.ground;
    const double reach = 0.5 + (double)margin;
    size_t first = 1;
    c->pairs = allocate(16 * c->made, sizeof *c->pairs);
    for (size_t k = 0; k < c->made; k++) {
        const double x = c->bodies[k].x, y = c->bodies[k].y;
        while (points[first + 1].x > x + reach)
            first++;
        for (size_t s = first; s + 2 < c->scene.ground_count && points[s].x >= x - reach; s++)
            if (fmin(points[s].y, points[s + 1].y) <= y + reach && fmax(points[s].y, points[s + 1].y) >= y - reach)
                c->pairs[c->pair_count++] = (struct pair){(uint32_t)s, (uint32_t)k};
    }
    c->touching = allocate(c->pair_count, 1);
}

static void begin_peer(struct row *row, const struct walk *walk, struct outline *outline) {
    struct country *c = row->state;
    c->scene.outlines = outline;
    c->scene.body_count = c->made;
    c->scene.bodies = allocate(c->made, sizeof *c->scene.bodies);
    for (size_t k = 0; k < c->made; k++)
        c->scene.bodies[k] = (struct body){(float)c->bodies[k].x, (float)c->bodies[k].y, 1, 0, 0};
    list_points(walk, &c->scene);
    row->peer_state = row->peer->create(&c->scene);
    pair_segments(c);
    for (int steps = 0; steps < 3; steps++)
        run(row);
    size_t found = row->peer->count_touching(row->peer_state);
    for (size_t k = 0; k < c->pair_count; k++)
        found += c->touching[k];
    row->bench.hits = (double)found / (double)row->bench.count;
}

/* 30,000 bodies on 100,000 pieces, each 1.1 long; or so short that the boxes stand on all of them. Each column lies on it.
 * Of few hills a tenth, which single precision has room for, and as many on ground without end. */
static void prepare(struct row *row) {
    const bool endless = strstr(row->bench.name, "/plane/") != NULL;
    const bool few = endless || strstr(row->bench.name, "/few-hills/"),
               balls = strstr(row->bench.name, "/balls/") != NULL;
    const bool is_short = strstr(row->bench.name, "/short-hills/") != NULL;
    const size_t count = scaled(few ? 3000 : 30000), pieces = scaled(few ? 10000 : 100000), levels = few ? 1 : 3;
    const double columns = (double)(count / levels);
    const double length = is_short ? 1.2 * 1.1 * columns / (double)pieces : 1.1;
    const double pitch = fmax(1.1, 0.9 * length * (double)pieces / columns);
    const struct walk walk =
        endless ? walk_flat(pitch * ((double)count + 1)) : walk_hills(pieces * 4 / 3, length / 0.45);
    struct country *c = row->state = allocate(1, sizeof *c);
    struct outline *outline = allocate(1, sizeof *outline);
    *outline = balls ? circle_with(0.5) : box_with(0.4, 0.4);
    for (size_t k = 0; k <= outline->count && !balls; k++)
        outline->arcs[k].radius = 0.1;
    *c = make_country(&walk, endless, outline, count, (int)levels, pitch);
    row->bench.count = few ? c->made : 1; /* bodies, steps */
    if (row->peer) {
        begin_peer(row, &walk, outline);
        free(walk.arcs);
        return;
    }
    size_t found = step(c, AMONG)->touching_count - step(c, NONE)->touching_count;
    if (row->question->what == PAIRS) {
        keep_pairs(c, step(c, AMONG));
        found = find_rows(c);
    }
    row->bench.hits = (double)found / (double)row->bench.count;
    row->bench.wrong = found < c->made / levels ? (double)(c->made / levels - found) : 0;
    free(walk.arcs);
}

const struct question ground_questions[] = {{"ground-none", prepare, run, NONE, true},
                                            {"ground-among", prepare, run, AMONG, true},
                                            {"ground-pairs", prepare, run, PAIRS, true},
                                            {.name = NULL}};
