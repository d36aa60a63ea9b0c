/* SPDX-License-Identifier: MIT
 *
 * steps.c - the steps of a simulation from bodies to manifolds, one by one and together; lists of pairs that are kept;
 * the worlds of peers.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "rows.h"

/* Every run takes the other of two frames. */
enum step {
    STEP_BOXES,
    STEP_PAIRS, /* of boxes that are there */
    STEP_MATCH, /* pairs of one frame with those of the other, and a word of each carried over */
    STEP_WHOLE, /* all of these, and manifolds; or a peer's */
    STEP_KEPT,  /* pairs that are updated, and kept, and manifolds */
    STEP_STAY,  /* narc_update_contacts() */
};

/* What there is of each frame. */
struct frame {
    struct scene *scene;
    narc_box *boxes;
    size_t pair_count;
    uint32_t *a, *b, *words; /* `words`: an engine's own */
};

struct steps {
    const narc_workers *workers;
    struct frame frames[2];
    size_t runs, capacity, manifold_count;
    narc_broad_phase *broad;
    const narc_pair_list *list; /* STEP_KEPT: that of the first frame, which serves both */
    narc_contacts *contacts;    /* STEP_STAY */
    uint32_t *match;
};

static void find_frame_pairs(struct steps *s, struct frame *frame) {
    narc_error error;
    must(narc_find_pairs(s->broad, frame->boxes, frame->scene->body_count, NULL, s->workers, frame->a, frame->b,
                         s->capacity, &frame->pair_count, &error),
         &error);
}

static narc_pairs pairs_of(const struct frame *frame) {
    return (narc_pairs){.count = frame->pair_count, .a = NARC_ARRAY(frame->a), .b = NARC_ARRAY(frame->b)};
}

static void carry_words(struct steps *s, const struct frame *last, struct frame *frame) {
    const narc_pairs old_pairs = pairs_of(last), new_pairs = pairs_of(frame);
    narc_error error;
    must(narc_match_pairs(s->broad, &old_pairs, &new_pairs, s->workers, s->match, &error), &error);
    narc_gather(s->match, frame->pair_count, sizeof *frame->words, last->words, frame->words);
}

/* The manifolds of these pairs where the bodies of `frame` are. */
static void find_frame_manifolds(struct steps *s, const struct frame *frame, const narc_pairs *pairs) {
    struct scene *scene = frame->scene;
    const narc_bodies bodies = bodies_of(scene->bodies, scene->body_count);
    const narc_query query = {.workers = s->workers};
    narc_error error;
    must(narc_find_manifolds(scene->shapes, &bodies, pairs, &query, share_manifolds(s->capacity), s->capacity,
                             &s->manifold_count, &error),
         &error);
}

static void run_whole(struct steps *s, const struct frame *last, struct frame *frame) {
    find_boxes(frame->scene, SKIN / 2, s->workers, frame->boxes);
    find_frame_pairs(s, frame);
    carry_words(s, last, frame);
    const narc_pairs pairs = pairs_of(frame);
    find_frame_manifolds(s, frame, &pairs);
}

static void update_pairs(struct steps *s, const struct frame *frame) {
    const narc_bodies bodies = bodies_of(frame->scene->bodies, frame->scene->body_count);
    const narc_pair_options options = {.skin = (float)(SKIN / 2), .workers = s->workers};
    narc_error error;
    must(narc_update_pairs(s->broad, frame->scene->shapes, &bodies, &options, &s->list, &error), &error);
}

static void run_kept(struct steps *s, const struct frame *frame) {
    update_pairs(s, frame);
    if (!s->list->kept)
        fail("a body of a kept list has left its box");
    find_frame_manifolds(s, frame, &s->list->pairs);
}

static void run_contacts(struct steps *s, const struct frame *frame) {
    const narc_bodies bodies = bodies_of(frame->scene->bodies, frame->scene->body_count);
    const narc_step step = {.bodies = &bodies, .skin = (float)(SKIN / 2), .workers = s->workers};
    const narc_step_result *result;
    narc_error error;
    must(narc_update_contacts(s->contacts, frame->scene->shapes, &step, &result, &error), &error);
    s->manifold_count = result->touching_count;
}

static void run(struct row *row) {
    struct steps *s = row->state;
    struct frame *frame = &s->frames[s->runs % 2], *last = &s->frames[1 - s->runs % 2];
    s->runs++;
    switch ((enum step)row->question->what) {
    case STEP_BOXES:
        find_boxes(frame->scene, SKIN / 2, s->workers, frame->boxes);
        break;
    case STEP_PAIRS:
        find_frame_pairs(s, frame);
        break;
    case STEP_MATCH:
        carry_words(s, last, frame);
        break;
    case STEP_WHOLE:
        if (row->peer)
            row->bench.seconds = row->peer->step(row->peer_state);
        else
            run_whole(s, last, frame);
        break;
    case STEP_KEPT:
        run_kept(s, frame);
        break;
    case STEP_STAY:
        run_contacts(s, frame);
        break;
    }
}

/* Manifolds whose separation is not the exact one; are there enough of them? */
static double count_wrong(const struct steps *s, struct scene *scene, const narc_pairs *pairs) {
    const narc_manifold *list = share_manifolds(s->capacity);
    const uint32_t *a = pairs->a.base, *b = pairs->b.base;
    const double *gaps = gaps_of(scene);
    size_t wrong = 0, colliding = 0;
    for (size_t k = 0; k < s->manifold_count; k++) {
        const struct body *of_a = &scene->bodies[a[list[k].pair]], *of_b = &scene->bodies[b[list[k].pair]];
        struct vector normal;
        const double gap = exact_gap(scene->outlines, of_a, of_b, &normal);
        wrong += !(fabs(deepest_separation(&list[k]) - gap) < TOUCHING);
    }
    for (size_t k = 0; k < scene->pair_count; k++)
        colliding += gaps[k] < -TOUCHING;
    return (double)(wrong + (s->manifold_count < colliding));
}

static void make_frame(struct frame *frame, struct scene *scene, size_t capacity) {
    frame->scene = scene;
    frame->boxes = allocate(scene->body_count, sizeof *frame->boxes);
    frame->a = allocate(capacity, sizeof *frame->a);
    frame->b = allocate(capacity, sizeof *frame->b);
    frame->words = allocate(capacity, sizeof *frame->words);
}

/* Steps that have pairs to find and contacts to make are outside the time. */
static void prepare_peer(struct row *row) {
    const struct peer *peer = row->peer;
    row->peer_state = peer->create(row->scene);
    for (int step = 0; step < 3; step++)
        peer->step(row->peer_state);
    row->bench.hits = (double)peer->count_touching(row->peer_state) / (double)row->bench.count;
}

/* Both frames once, so that each has boxes, pairs and words; checks those of the first. */
static void prepare(struct row *row) {
    struct steps *s = row->state = allocate(1, sizeof *s);
    row->bench.count = row->scene->pair_count;
    if (row->peer) {
        prepare_peer(row);
        return;
    }
    s->workers = &row->workers;
    s->capacity = row->bench.count + row->bench.count / 16;
    s->match = allocate(s->capacity, sizeof *s->match);
    must(narc_create_broad_phase(NULL, &s->broad), NULL);
    make_frame(&s->frames[0], row->scene, s->capacity);
    make_frame(&s->frames[1], get_scene(row->family, row->layout, true), s->capacity);
    run_whole(s, &s->frames[1], &s->frames[0]);
    narc_pairs pairs = pairs_of(&s->frames[0]);
    row->bench.wrong = count_wrong(s, row->scene, &pairs);
    row->bench.hits = (double)s->manifold_count / (double)row->bench.count;
    run_whole(s, &s->frames[0], &s->frames[1]);
    if (row->question->what == STEP_KEPT) {
        update_pairs(s, &s->frames[0]);
        run_kept(s, &s->frames[1]);
        row->bench.wrong += count_wrong(s, s->frames[1].scene, &s->list->pairs);
    } else if (row->question->what == STEP_STAY) { /* as many touch as just now */
        const size_t touching = s->manifold_count;
        must(narc_create_contacts(NULL, &s->contacts, NULL), NULL);
        for (size_t k = 0; k < 8; k++)
            run_contacts(s, &s->frames[k % 2]);
        row->bench.wrong += s->manifold_count != touching;
    }
}

/* ------------------------------------------------------------------------------------------------ kept lists */

/* narc_update_pairs(), or narc_update_contacts(), of a pile in which one body of so many leaves its kept box in each step, another one in the next;
 * 1: all of them, 0: none. */
struct rest {
    size_t runs;
    struct body *bodies;
    narc_broad_phase *broad;
    narc_contacts *contacts; /* instead, with the bodies that have moved listed */
    uint32_t *moved;
    bool kept;
};

/* There and back, farther than the skin. */
static void run_rest(struct row *row) {
    struct rest *rest = row->state;
    const float skin = (float)(SKIN / 2);
    const size_t count = row->scene->body_count, one_of = row->one_of, runs = rest->runs++;
    const narc_bodies bodies = bodies_of(rest->bodies, count);
    const narc_pair_options options = {.skin = skin};
    const narc_pair_list *list;
    const narc_step_result *result;
    narc_step step = {.bodies = &bodies, .skin = skin, .moved = NARC_ARRAY(rest->moved)};
    narc_error error;
    for (size_t k = one_of > 0 ? runs % one_of : count; k < count; k += one_of) {
        rest->bodies[k].x += runs / one_of % 2 == 0 ? 1.5f * skin : -1.5f * skin;
        rest->moved[step.moved_count++] = (uint32_t)k;
    }
    if (rest->contacts) {
        must(narc_update_contacts(rest->contacts, row->scene->shapes, &step, &result, &error), &error);
        rest->kept = result->asked_count == 0;
    } else {
        must(narc_update_pairs(rest->broad, row->scene->shapes, &bodies, &options, &list, &error), &error);
        rest->kept = list->kept;
    }
}

static void prepare_rest(struct row *row) {
    struct rest *rest = row->state = allocate(1, sizeof *rest);
    const struct scene *scene = row->scene;
    rest->bodies = allocate(scene->body_count, sizeof *rest->bodies);
    memcpy(rest->bodies, scene->bodies, scene->body_count * sizeof *rest->bodies);
    rest->moved = allocate(scene->body_count, sizeof *rest->moved);
    must(narc_create_broad_phase(NULL, &rest->broad), NULL);
    if (row->question->what == STEP_STAY)
        must(narc_create_contacts(NULL, &rest->contacts, NULL), NULL);
    row->bench.count = scene->pair_count;
    for (int step = 0; step < 10; step++)
        run_rest(row);
    row->bench.wrong = rest->kept != (row->one_of == 0);
}

const struct question step_questions[] = {{"boxes", prepare, run, STEP_BOXES, false},
                                          {"pairs", prepare, run, STEP_PAIRS, false},
                                          {"match", prepare, run, STEP_MATCH, false},
                                          {"step", prepare, run, STEP_WHOLE, false},
                                          {"kept", prepare, run, STEP_KEPT, false},
                                          {"contacts-stay", prepare, run, STEP_STAY, false},
                                          {"update", prepare_rest, run_rest, 0, false},
                                          {"stay", prepare_rest, run_rest, STEP_STAY, false},
                                          {.name = NULL}};
