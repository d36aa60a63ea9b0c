/* SPDX-License-Identifier: MIT
 *
 * ground.c - what chains are worth: a ball over joined pieces, a box over edges in line, a ball in a bowl and in
 * polylines of the same bowl, and what ground costs in a step of many bodies.
 *
 *     bench_ground [--bodies=30000] [--pieces=100000] [--rounds=7]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "random.h"
#include "setting.h"

/* ------------------------------------------------------------------------------------------------ ground */

/* A chain by walking from right to left, the air above; and a place on it that a ball's contact is compared with. */
struct walk {
    narc_arc *arcs;
    size_t count, capacity;
    double x, y, normal; /* where it is, and the angle of the outward normal */
};

static void put_arc(struct walk *w, double radius, double sweep) {
    if (w->count == w->capacity)
        fail("too many arcs");
    const double x = w->x - radius * cos(w->normal), y = w->y - radius * sin(w->normal);
    w->arcs[w->count++] = (narc_arc){x, y, radius, w->normal, w->normal + sweep};
    w->normal += sweep;
    w->x = x + radius * cos(w->normal);
    w->y = y + radius * sin(w->normal);
}

static void put_edge(struct walk *w, double length) {
    w->x -= length * sin(w->normal);
    w->y += length * cos(w->normal);
}

static struct walk begin_walk(size_t capacity) {
    return (struct walk){.arcs = allocate(capacity, sizeof(narc_arc)), .capacity = capacity, .normal = pi / 2};
}

/* A chain in a store: its entries as bodies, and an index of their boxes. */
struct ground {
    narc_shapes *shapes;
    narc_body *bodies;
    uint32_t *runs;
    size_t count;
    narc_index *index;
};

static struct ground make_ground(narc_shapes *shapes, const struct walk *walk) {
    struct ground g = {.shapes = shapes};
    narc_error error;
    const size_t room = 4 * walk->count + 100;
    narc_chain_entry *const entries = allocate(room, sizeof *entries);
    must(narc_add_chain(shapes, walk->arcs, walk->count, NULL, entries, room, &g.count, &error), &error);
    g.bodies = allocate(g.count, sizeof *g.bodies);
    g.runs = allocate(g.count, sizeof *g.runs);
    for (size_t k = 0; k < g.count; k++) {
        g.bodies[k] =
            (narc_body){.x = entries[k].x, .y = entries[k].y, .cosine = 1, .scale = 1, .shape = entries[k].shape};
        g.runs[k] = entries[k].run;
    }
    const narc_bodies bodies = narc_view_bodies(g.bodies, g.count);
    narc_box *const boxes = allocate(g.count, sizeof *boxes);
    must(narc_compute_boxes(shapes, &bodies, NULL, boxes, &error), &error);
    must(narc_create_index(NULL, &g.index), NULL);
    must(narc_build_index(g.index, boxes, g.count, NULL, &error), &error);
    free(boxes);
    free(entries);
    return g;
}

static void destroy_ground(struct ground *g) {
    narc_destroy_index(g->index);
    narc_destroy_shapes(g->shapes);
    free(g->bodies);
    free(g->runs);
}

/* The contacts of bodies with the ground, merged. */
static size_t touch_ground(const struct ground *g, const narc_bodies *bodies, float margin, narc_box *boxes,
                           narc_manifold *rows, size_t capacity) {
    const narc_bodies pieces = narc_view_bodies(g->bodies, g->count);
    const narc_box_options around = {.margin = margin};
    const narc_query query = {.margin = margin};
    narc_pairs pairs;
    narc_error error;
    size_t found;
    must(narc_compute_boxes(g->shapes, bodies, &around, boxes, &error), &error);
    must(narc_query_index(g->index, boxes, bodies->count, NULL, &pairs, &error), &error);
    pairs.other_bodies = &pieces;
    must(narc_find_manifolds(g->shapes, bodies, &pairs, &query, rows, capacity, &found, &error), &error);
    return narc_merge_manifolds(&pairs, (narc_index_column){g->runs, sizeof *g->runs}, rows, found);
}

enum { ROWS = 64 };

/* The contacts of one body; their normals point from it into the ground. */
static size_t touch_one(const struct ground *g, const narc_body *body, narc_manifold rows[ROWS]) {
    narc_box box;
    const narc_bodies one = narc_view_bodies(body, 1);
    return touch_ground(g, &one, 0.05f, &box, rows, ROWS);
}

static uint32_t add_shape(narc_shapes *shapes, double width, double height, double radius) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    uint32_t shape;
    must(narc_build_box(width, height, radius, arcs, &count, NULL), NULL);
    must(narc_add_shape(shapes, arcs, count, &shape, NULL), NULL);
    return shape;
}

static uint32_t add_ball(narc_shapes *shapes, double radius) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    uint32_t shape;
    must(narc_build_circle(radius, arcs, &count, NULL), NULL);
    must(narc_add_shape(shapes, arcs, count, &shape, NULL), NULL);
    return shape;
}

static narc_shapes *make_store(void) {
    narc_shapes *shapes;
    must(narc_create_shapes(NULL, &shapes), NULL);
    return shapes;
}

/* ------------------------------------------------------------------------------------------------ junctions */

/* Convex, concave and straight pieces in turn, none steeper than half a radian. */
static struct walk walk_hills(size_t pieces, double size, uint64_t *random) {
    struct walk w = begin_walk(pieces + 2);
    put_arc(&w, 3 * size, 0.2);
    for (size_t k = 1; k < pieces; k++) {
        const double turn = random_between(random, 0.05, 0.3), radius = size * random_between(random, 1, 4);
        const bool left = w.normal + turn < pi / 2 + 0.5 && (w.normal - turn < pi / 2 - 0.5 || k % 2);
        put_arc(&w, left ? radius : -radius, left ? turn : -turn);
        if (random_below(random, 3) == 0) {
            put_edge(&w, size * random_between(random, 0.2, 2));
            k++;
        }
    }
    return w;
}

/* A ball of radius 0.5 that lies on the ground exactly where a junction is, and 1e-6 to 0.1 beside. A velocity along the
 * ground gets a part along the true normal by the error of the contact's normal: that part, by its speed. */
static void roll_over_junctions(void) {
    enum { PIECES = 1000, PLACES = 13 };
    uint64_t random = 5;
    const struct walk walk = walk_hills(PIECES, 2, &random);
    narc_shapes *const shapes = make_store();
    struct ground g = make_ground(shapes, &walk);
    narc_body ball = {.cosine = 1, .scale = 1, .shape = add_ball(shapes, 0.5)};
    narc_manifold rows[ROWS];
    size_t asked = 0, others = 0;
    double worst = 0, worst_separation = 0;
    for (size_t k = 1; k + 1 < walk.count; k++) {
        for (int place = 0; place < PLACES; place++) {
            const narc_arc *arc = &walk.arcs[k];
            const double beside = place ? pow(10, -(double)((place - 1) / 2 + 1)) : 0;
            const double angle = arc->start + (place % 2 ? 1 : 0) * fmin(beside, 1) * (arc->end - arc->start);
            const double before = walk.arcs[k - 1].end, other = before - beside * (before - walk.arcs[k - 1].start);
            const narc_arc *on = place % 2 || !place ? arc : &walk.arcs[k - 1];
            const double normal = place % 2 || !place ? angle : other;
            ball.x = on->center_x + (on->radius + 0.5) * cos(normal);
            ball.y = on->center_y + (on->radius + 0.5) * sin(normal);
            const size_t count = touch_one(&g, &ball, rows);
            asked++;
            others += count != 1;
            for (size_t i = 0; i < count; i++) {
                const double x = -(double)rows[i].normal_x, y = -(double)rows[i].normal_y;
                worst = fmax(worst, fabs(x * sin(normal) - y * cos(normal)));
                worst_separation = fmax(worst_separation, fabs((double)rows[i].point[0].separation));
            }
        }
    }
    printf("Ball over %zu pieces (%zu entries): %zu places at and beside junctions, %zu without exactly one contact; "
           "greatest velocity along the true normal %.1e of its speed, greatest separation %.1e\n",
           walk.count, g.count, asked, others, worst, worst_separation);
    destroy_ground(&g);
    free(walk.arcs);
}

/* A box of 1 by 1 over 10,000 edges of 0.1 in line. */
static void slide_over_edges(void) {
    enum { EDGES = 10000 };
    struct walk walk = begin_walk(EDGES + 1);
    put_arc(&walk, 0, 0);
    for (size_t k = 0; k < EDGES; k++) {
        put_edge(&walk, 0.1);
        put_arc(&walk, 0, 0);
    }
    narc_shapes *const shapes = make_store();
    struct ground g = make_ground(shapes, &walk);
    narc_body box = {.cosine = 1, .scale = 1, .shape = add_shape(shapes, 1, 1, 0)};
    narc_manifold rows[ROWS];
    size_t others = 0, steps = 0;
    double worst = 0, worst_separation = 0;
    for (box.x = -1; box.x > -999; box.x -= 30.0 / 240 / 4, steps++) {
        box.y = 0.5 - 0.001;
        const size_t count = touch_one(&g, &box, rows);
        others += count != 1 || rows[0].count != 2;
        for (size_t i = 0; i < count; i++) {
            worst = fmax(worst, fabs((double)rows[i].normal_x));
            for (size_t p = 0; p < rows[i].count; p++)
                worst_separation = fmax(worst_separation, fabs((double)rows[i].point[p].separation + 0.001));
        }
    }
    printf(
        "Box over %d edges in line (%zu entries): %zu steps, %zu without one contact of two points; greatest tilt of "
        "the normal %.1e, greatest error of a separation %.1e\n",
        EDGES, g.count, steps, others, worst, worst_separation);
    destroy_ground(&g);
    free(walk.arcs);
}

/* ------------------------------------------------------------------------------------------------ a bowl */

enum bowl { ONE_ARC, FIFTY_ARCS, SIDES_60, SIDES_240, BOWLS };

/* Radius 5, from 80 degrees on one side to 80 on the other; polylines have their sides' middles on the circle, and so
 * many sides to a full one. */
static struct walk walk_bowl(enum bowl bowl) {
    static const size_t parts[BOWLS] = {2, 50, 60, 240};
    const double radius = 5, half = 80 * pi / 180;
    struct walk w = begin_walk(300);
    w.normal = pi / 2 + half;
    w.x = -radius * cos(w.normal);
    w.y = radius - radius * sin(w.normal);
    if (bowl == ONE_ARC) {
        put_arc(&w, -radius, -2 * half);
        return w;
    }
    if (bowl == FIFTY_ARCS) {
        for (size_t k = 0; k < parts[bowl]; k++)
            put_arc(&w, -radius, -2 * half / (double)parts[bowl]);
        return w;
    }
    const double turn = 2 * pi / (double)parts[bowl], side = 2 * radius * tan(turn / 2);
    put_arc(&w, 0, 0);
    put_edge(&w, side / 2);
    while (w.normal > pi / 2 - half) {
        put_edge(&w, side / 2);
        put_arc(&w, -0.0, -turn);
        put_edge(&w, side / 2);
    }
    put_arc(&w, 0, 0);
    return w;
}

struct deepest {
    double separation, x, y; /* the ground's normal */
};

static struct deepest find_deepest(const struct ground *g, const narc_body *ball) {
    narc_manifold rows[ROWS];
    struct deepest d = {INFINITY, 0, 1};
    for (size_t k = touch_one(g, ball, rows); k > 0; k--)
        if ((double)rows[k - 1].point[0].separation < d.separation)
            d = (struct deepest){(double)rows[k - 1].point[0].separation, -(double)rows[k - 1].normal_x,
                                 -(double)rows[k - 1].normal_y};
    return d;
}

/* A ball of radius 0.5 without friction from 60 degrees, ten swings, 240 steps a second: the ground pushes along the
 * normal where the step begins, as far as the ball would sink in it, and takes what is left of the velocity against the
 * normal where the step ends (RATTLE: of a smooth constraint it keeps the energy). */
static void swing(enum bowl bowl, const char *name) {
    const double step = 1.0 / 240, gravity = 9.81, arm = 4.5, start = 60 * pi / 180;
    const struct walk walk = walk_bowl(bowl);
    narc_shapes *const shapes = make_store();
    struct ground g = make_ground(shapes, &walk);
    narc_body ball = {
        .x = arm * sin(start), .y = 5 - arm * cos(start), .cosine = 1, .scale = 1, .shape = add_ball(shapes, 0.5)};
    const double first = gravity * (ball.y - 0.5);
    double v_x = 0, v_y = 0, noise = 0, squares = 0;
    struct deepest here = find_deepest(&g, &ball);
    size_t steps = 0, touching = 0, turns = 0;
    while (turns < 20 && steps < 100000) {
        const double before = v_x;
        v_y -= step * gravity / 2;
        const double from_x = ball.x, from_y = ball.y;
        ball.x += step * v_x;
        ball.y += step * v_y;
        struct deepest there = find_deepest(&g, &ball);
        for (int k = 0; k < 3 && there.separation < 0; k++) {
            const double push = there.separation / (there.x * here.x + there.y * here.y);
            ball.x -= push * here.x;
            ball.y -= push * here.y;
            there = find_deepest(&g, &ball);
        }
        v_x = (ball.x - from_x) / step;
        v_y = (ball.y - from_y) / step - step * gravity / 2;
        if (there.separation < 1e-4) {
            const double into = v_x * there.x + v_y * there.y, speed = hypot(v_x, v_y);
            if (into < 0) {
                v_x -= into * there.x;
                v_y -= into * there.y;
            }
            /* How much more, or less, the normal turned than it does along the circle. */
            const double turned = asin(here.x * there.y - here.y * there.x);
            const double error = speed * fabs(fabs(turned) - hypot(ball.x - from_x, ball.y - from_y) / arm);
            noise = fmax(noise, error);
            squares += error * error;
            touching++;
        }
        here = there;
        turns += before * v_x < 0;
        steps++;
    }
    const double last = gravity * (ball.y - 0.5) + (v_x * v_x + v_y * v_y) / 2;
    printf("| %s | %zu | %.3f %% | %.1e | %.1e | %.1f %% |\n", name, turns / 2, 100 * (first - last) / first, noise,
           sqrt(squares / (double)touching), 100 * (double)touching / (double)steps);
    destroy_ground(&g);
    free(walk.arcs);
}

/* ------------------------------------------------------------------------------------------------ cost */

/* Columns of three rounded boxes on hills, which shake a little: bodies by themselves; and then with the ground, its
 * entries among the bodies of the broad phase, which keeps the list, or asked of an index in every step. */
struct country {
    struct ground ground;
    narc_body *bodies; /* the boxes, and behind them the ground */
    uint8_t *kinds;
    uint32_t *runs;
    size_t made;
    narc_manifold *rows;
    size_t room;
};

static struct country make_country(const struct walk *walk, size_t count, double pitch) {
    narc_shapes *const shapes = make_store();
    struct country c = {.ground = make_ground(shapes, walk), .room = 20 * count + 1000};
    const uint32_t shape = add_shape(shapes, 1, 1, 0.1);
    const size_t all = count + c.ground.count;
    c.bodies = allocate(all, sizeof *c.bodies);
    c.kinds = allocate(all, 1);
    c.runs = allocate(all, sizeof *c.runs);
    c.rows = allocate(c.room, sizeof *c.rows);
    double at = walk->arcs[0].center_x;
    for (size_t k = 1; k < walk->count && c.made + 3 <= count; k++) { /* a column stands where an arc begins */
        const narc_arc *a = &walk->arcs[k];
        const double x = a->center_x + a->radius * cos(a->start), y = a->center_y + a->radius * sin(a->start);
        if (x > at - pitch)
            continue;
        at = x;
        for (int level = 0; level < 3; level++)
            c.bodies[c.made++] =
                (narc_body){.x = x, .y = y + 0.53 + 1.001 * level, .cosine = 1, .scale = 1, .shape = shape};
    }
    for (size_t k = 0; k < c.ground.count; k++) {
        c.bodies[c.made + k] = c.ground.bodies[k];
        c.kinds[c.made + k] = NARC_STATIC;
        c.runs[c.made + k] = c.ground.runs[k];
    }
    return c;
}

/* Pairs and manifolds of the first `count` bodies; merged, those of the ground among them. */
static size_t step_country(const struct country *c, narc_broad_phase *broad, size_t count) {
    const narc_bodies bodies = narc_view_bodies(c->bodies, count);
    const narc_pair_filter filter = {.kind = {c->kinds, 1}};
    const narc_pair_options options = {.margin = 0.02f, .skin = 0.05f, .filter = &filter};
    const narc_query query = {.margin = 0.02f};
    const narc_pair_list *list;
    size_t found;
    narc_error error;
    must(narc_update_pairs(broad, c->ground.shapes, &bodies, &options, &list, &error), &error);
    must(narc_find_manifolds(c->ground.shapes, &bodies, &list->pairs, &query, c->rows, c->room, &found, &error),
         &error);
    /* Rows of two boxes are of runs of their own, and stay. */
    return count > c->made
               ? narc_merge_manifolds(&list->pairs, (narc_index_column){c->runs, sizeof *c->runs}, c->rows, found)
               : found;
}

/* On as many pieces, each `length` long. */
static void compare_cost(size_t count, size_t pieces, double length, size_t rounds) {
    enum { ALONE, AMONG, INDEX, WAYS };
    uint64_t random = 7;
    const double pitch = fmax(1.1, 0.9 * length * (double)pieces / ((double)count / 3));
    const struct walk walk = walk_hills(pieces * 4 / 3, length / 0.45, &random);
    struct country c = make_country(&walk, count, pitch);
    for (size_t k = 0; k < c.made; k++)
        c.runs[k] = (uint32_t)(0x80000000u + k);
    const narc_bodies boxes = narc_view_bodies(c.bodies, c.made);
    narc_box *const room = allocate(c.made, sizeof *room);
    narc_broad_phase *broad[2];
    for (int k = 0; k < 2; k++)
        must(narc_create_broad_phase(NULL, &broad[k]), NULL);
    double ms[WAYS][MOST_ROUNDS], median[WAYS];
    size_t rows[WAYS] = {0};
    for (size_t round = 0; round < rounds; round++) {
        for (size_t k = 0; k < c.made; k++)
            c.bodies[k].x += round % 2 ? 1e-3 : -1e-3;
        const double start = now();
        rows[ALONE] = step_country(&c, broad[0], c.made);
        const double second = now();
        rows[AMONG] = step_country(&c, broad[1], c.made + c.ground.count);
        const double third = now();
        rows[INDEX] = touch_ground(&c.ground, &boxes, 0.02f, room, c.rows, c.room);
        ms[INDEX][round] = (now() - third + second - start) / 1e6;
        ms[AMONG][round] = (third - second) / 1e6;
        ms[ALONE][round] = (second - start) / 1e6;
    }
    for (int way = 0; way < WAYS; way++)
        median[way] = quantile(ms[way], rounds, 0.5);
    printf("%zu bodies of 1 m on %zu pieces of %.2f m (%zu entries), pairs and manifolds of a step: %.2f ms without "
           "the ground (%zu rows); "
           "%.2f ms (%+.0f %%) with it among the bodies (%zu rows); %.2f ms (%+.0f %%) with an index of it (%zu rows "
           "more)\n",
           c.made, walk.count, length, c.ground.count, median[ALONE], rows[ALONE], median[AMONG],
           100 * (median[AMONG] / median[ALONE] - 1), rows[AMONG], median[INDEX],
           100 * (median[INDEX] / median[ALONE] - 1), rows[INDEX]);
    narc_destroy_broad_phase(broad[0]);
    narc_destroy_broad_phase(broad[1]);
    destroy_ground(&c.ground);
    free(c.bodies);
    free(c.kinds);
    free(c.runs);
    free(c.rows);
    free(room);
    free(walk.arcs);
}

int main(int argc, char **argv) {
    struct setting s = read_setting(argc, argv, "--pieces=", 100000, 7);
    printf("%s, %s, %s\n\n", processor_name(), compiler_name, choose_best_isa());
    roll_over_junctions();
    slide_over_edges();
    printf("\n| Bowl | Swings | Energy lost | Greatest jump of the velocity, m/s | Root mean square | Touching |\n"
           "| --- | --- | --- | --- | --- | --- |\n");
    swing(ONE_ARC, "one arc");
    swing(FIFTY_ARCS, "fifty arcs");
    swing(SIDES_60, "polyline, 60 sides a turn");
    swing(SIDES_240, "polyline, 240 sides a turn");
    printf("\n");
    const size_t bodies = s.bodies ? s.bodies : 30000;
    compare_cost(bodies, s.questions, 1.1, s.rounds);
    compare_cost(bodies, s.questions, 1.2 * 1.1 * (double)bodies / 3 / (double)s.questions, s.rounds);
    return 0;
}
