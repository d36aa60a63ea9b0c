/* SPDX-License-Identifier: MIT
 *
 * steps.c - the collision step of a simulation: boxes, pairs, and all of it by plain calls; contacts that stay, and
 * worlds of peers, while bodies move.
 */
#include <math.h>
#include <string.h>

#include "common.h"
#include "random.h"
#include "rows.h"

enum step {
    STEP_BOXES,
    STEP_PAIRS, /* of boxes that are there */
    STEP_PLAIN, /* both, and manifolds */
    STEP_WORLDS,
    /* The whole step. Of so many bodies one moves: */
    STEP_MOVING = 4, /* ten steps there and ten back */
    STEP_SETTLED,    /* by nearly nothing */
    STEP_RAIN,       /* to where another one was, so that all pairs are new */
    STEP_RECYCLED = 8
};

/* Metres, radians in a step; a body is some 2 in size. Box2D's margin, the most of its skin, its recycling. */
static const double motion = 0.005, little = 0.00002;
static const float margin = 0.02f, skin = 0.05f, recycling = 0.05f;

/* How a body moves in a step. */
struct way {
    float x, y, cosine, sine;
};

struct steps {
    size_t runs, capacity, found;
    struct body *bodies;
    struct way *ways;
    uint32_t *moved, *a, *b;
    size_t moved_count;
    narc_box *boxes;
    narc_body *placed; /* "worlds": squares of the scene, each a world, all at one place */
    uint32_t *world;
    narc_broad_phase *broad;
    narc_contacts *contacts;
    const narc_step_result *result;
};

/* ------------------------------------------------------------------------------------------------ plain calls */

static void run_plain(struct row *row) {
    struct steps *s = row->state;
    const struct scene *scene = row->scene;
    const narc_bodies bodies = bodies_of_scene(scene);
    const narc_query query = {.margin = margin, .workers = &row->workers};
    narc_error error;
    if (row->question->what != STEP_PAIRS)
        find_boxes(scene, margin / 2 + skin, &row->workers, s->boxes);
    if (row->question->what != STEP_BOXES)
        must(narc_find_pairs(s->broad, s->boxes, scene->body_count, NULL, &row->workers, s->a, s->b, 0, s->capacity,
                             &s->found, &error),
             &error);
    const narc_pairs pairs = {.count = s->found, .a = NARC_ARRAY(s->a), .b = NARC_ARRAY(s->b)};
    if (row->question->what == STEP_PLAIN)
        must(narc_find_manifolds(scene->shapes, &bodies, &pairs, &query, share_manifolds(s->capacity), s->capacity,
                                 &s->found, &error),
             &error);
}

static void prepare_plain(struct row *row) {
    struct steps *s = row->state = allocate(1, sizeof *s);
    const size_t count = row->scene->body_count;
    s->capacity = 8 * count;
    s->a = allocate(s->capacity, sizeof *s->a);
    s->b = allocate(s->capacity, sizeof *s->b);
    s->boxes = allocate(count, sizeof *s->boxes);
    must(narc_create_broad_phase(NULL, &s->broad), NULL);
    find_boxes(row->scene, margin / 2 + skin, NULL, s->boxes);
    row->bench.count = row->scene->pair_count;
    run_plain(row);
}

/* Boxes, pairs and contacts of all worlds. */
static void run_worlds(struct row *row) {
    struct steps *s = row->state;
    const narc_shapes *const shapes = row->scene->shapes;
    const size_t count = row->scene->body_count;
    const narc_pair_filter filter = {.world = NARC_ARRAY(s->world)};
    const narc_query query = {.workers = &row->workers};
    const narc_box_options options = {.workers = &row->workers};
    narc_bodies bodies;
    narc_error error;
    narc_view_bodies(s->placed, count, &bodies);
    must(narc_compute_boxes(shapes, &bodies, &options, s->boxes, &error), &error);
    must(narc_find_pairs(s->broad, s->boxes, count, &filter, &row->workers, s->a, s->b, 0, s->capacity, &s->found,
                         &error),
         &error);
    const narc_pairs pairs = {.count = s->found, .a = NARC_ARRAY(s->a), .b = NARC_ARRAY(s->b)};
    must(narc_find_manifolds(shapes, &bodies, &pairs, &query, share_manifolds(s->capacity), s->capacity, &s->found,
                             &error),
         &error);
}

static void prepare_worlds(struct row *row) {
    enum { SIDE = 10, ROW = 1 << 12 }; /* a square of so much has some 32 bodies */
    struct scene *const scene = row->scene;
    prepare_plain(row);
    struct steps *s = row->state;
    index_scene(scene);
    s->placed = allocate(scene->body_count, sizeof *s->placed);
    s->world = allocate(scene->body_count, sizeof *s->world);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *at = &scene->bodies[k];
        const double x = floor(((double)at->x + scene->half) / SIDE), y = floor(((double)at->y + scene->half) / SIDE);
        s->placed[k] =
            (narc_body){(double)at->x - x * SIDE, (double)at->y - y * SIDE, at->cosine, at->sine, 1, at->shape};
        s->world[k] = (uint32_t)(x + ROW * y);
    }
    row->bench.count = scene->body_count;
    run_worlds(row);
}

/* ------------------------------------------------------------------------------------------------ whole steps */

static void move_bodies(struct steps *s, const struct scene *scene, bool rain) {
    const size_t count = scene->body_count, runs = s->runs++;
    const bool back = runs / 10 % 2;
    for (size_t k = 0; rain && k < count; k++) {
        const struct body *at = &scene->bodies[(k * 7919 + runs * 104729) % count];
        s->bodies[k] = (struct body){at->x, at->y, at->cosine, at->sine, s->bodies[k].shape};
    }
    for (size_t k = 0; !rain && k < s->moved_count; k++) {
        struct body *body = &s->bodies[s->moved[k]];
        const struct way *way = &s->ways[s->moved[k]];
        const float sine = back ? -way->sine : way->sine;
        const float x = body->cosine * way->cosine - body->sine * sine,
                    y = body->cosine * sine + body->sine * way->cosine;
        const float unit = 1.5f - 0.5f * (x * x + y * y);
        body->x += back ? -way->x : way->x;
        body->y += back ? -way->y : way->y;
        body->cosine = unit * x;
        body->sine = unit * y;
    }
}

static void run_steps(struct row *row) {
    struct steps *s = row->state;
    const struct scene *scene = row->scene;
    const int what = row->question->what;
    const narc_bodies bodies = bodies_of(s->bodies, scene->body_count);
    narc_step step = {.bodies = &bodies,
                      .margin = margin,
                      .skin = skin,
                      .recycling = what & STEP_RECYCLED ? recycling : 0,
                      .workers = &row->workers};
    narc_error error;
    move_bodies(s, scene, (what & ~STEP_RECYCLED) == STEP_RAIN);
    if (row->peer) {
        row->bench.seconds = row->peer->step(row->peer_state, s->bodies, s->moved, s->moved_count, step.recycling);
        return;
    }
    if (row->one_of != 1) {
        step.moved = (narc_index_column){s->moved, sizeof *s->moved};
        step.moved_count = s->moved_count;
    }
    must(narc_update_contacts(s->contacts, scene->shapes, &step, &s->result, &error), &error);
}

/* Rows whose separation is not the exact one, and what collides and has none. */
static double count_wrong(const struct row *row) {
    const struct steps *s = row->state;
    const struct scene *scene = row->scene;
    const uint32_t *a = s->result->pairs.a.base, *b = s->result->pairs.b.base;
    const double most = row->question->what & STEP_RECYCLED ? (double)recycling : 2 * TOUCHING;
    size_t wrong = 0, colliding = 0, found = 0;
    struct vector normal;
    for (size_t k = 0; k < s->result->touching_count; k++) {
        const uint32_t slot = s->result->touching[k];
        const double gap = exact_gap(scene->outlines, &s->bodies[a[slot]], &s->bodies[b[slot]], &normal);
        wrong += !(fabs(deepest_separation(&s->result->manifolds[slot]) - gap) < most);
        found += gap < -TOUCHING;
    }
    for (size_t k = 0; k < scene->pair_count && (row->question->what & ~STEP_RECYCLED) != STEP_RAIN; k++)
        colliding +=
            exact_gap(scene->outlines, &s->bodies[scene->pairs[k].a], &s->bodies[scene->pairs[k].b], &normal) < -most;
    return (double)(wrong + (found < colliding ? colliding - found : 0));
}

/* What is new at first is outside the time, and the entries that contacts make of pairs that stay. */
static void prepare_steps(struct row *row) {
    struct steps *s = row->state = allocate(1, sizeof *s);
    const struct scene *scene = row->scene;
    const size_t count = scene->body_count;
    const double most = (row->question->what & ~STEP_RECYCLED) == STEP_SETTLED ? little : motion;
    uint64_t random = 3;
    s->bodies = allocate(count, sizeof *s->bodies);
    s->ways = allocate(count, sizeof *s->ways);
    s->moved = allocate(count, sizeof *s->moved);
    memcpy(s->bodies, scene->bodies, count * sizeof *s->bodies);
    for (size_t k = 0; k < count; k += row->one_of) {
        const struct direction to = random_direction(&random);
        const double turn = random_between(&random, -most, most);
        s->ways[k] = (struct way){(float)(most * to.x), (float)(most * to.y), (float)cos(turn), (float)sin(turn)};
        s->moved[s->moved_count++] = (uint32_t)k;
    }
    row->bench.count = scene->pair_count;
    if (row->peer)
        row->peer_state = row->peer->create(row->scene);
    else
        must(narc_create_contacts(NULL, &s->contacts, NULL), NULL);
    for (int step = 0; step < 5; step++)
        run_steps(row);
    if (row->peer) {
        row->bench.hits = (double)row->peer->count_touching(row->peer_state) / (double)row->bench.count;
        return;
    }
    row->bench.hits = (double)s->result->touching_count / (double)row->bench.count;
    row->bench.wrong = count_wrong(row);
}

const struct question step_questions[] = {
    {"boxes", prepare_plain, run_plain, STEP_BOXES, false},
    {"pairs", prepare_plain, run_plain, STEP_PAIRS, false},
    {"plain", prepare_plain, run_plain, STEP_PLAIN, false},
    {"worlds", prepare_worlds, run_worlds, STEP_WORLDS, false},
    {"stay-moving", prepare_steps, run_steps, STEP_MOVING, false},
    {"stay-moving-recycled", prepare_steps, run_steps, STEP_MOVING | STEP_RECYCLED, false},
    {"stay-settled", prepare_steps, run_steps, STEP_SETTLED, false},
    {"stay-settled-recycled", prepare_steps, run_steps, STEP_SETTLED | STEP_RECYCLED, false},
    {"stay-rain", prepare_steps, run_steps, STEP_RAIN, false},
    {.name = NULL}};
