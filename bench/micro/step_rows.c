/* SPDX-License-Identifier: MIT
 *
 * step_rows.c - the steps of a simulation from bodies to manifolds, one by one and together.
 */
#include "rows.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "manifolds.h"
#include "narc_broad_phase.h"
#include "settled.h"

/* What there is of each frame. */
struct frame {
    const struct workload *workload;
    narc_box *boxes;
    size_t pair_count;
    uint32_t *a, *b, *hints;
};

struct step_row {
    struct bench_row row;
    struct step_job job;
    narc_workers workers;
    struct frame frames[2];
    size_t runs, capacity, manifold_count;
    narc_broad_phase *broad;
    const narc_pair_list *list; /* STEP_KEPT: that of the first frame, which serves both */
    uint32_t *match;
};

static void find_frame_pairs(struct step_row *row, struct frame *frame) {
    narc_error error;
    must(narc_find_pairs(row->broad, frame->boxes, frame->workload->body_count, NULL, &row->workers, frame->a, frame->b,
                         row->capacity, &frame->pair_count, &error),
         &error);
}

static narc_pairs pairs_of(const struct frame *frame) {
    return (narc_pairs){.count = frame->pair_count, .a = NARC_ARRAY(frame->a), .b = NARC_ARRAY(frame->b)};
}

static void carry_hints(struct step_row *row, const struct frame *last, struct frame *frame) {
    const narc_pairs old_pairs = pairs_of(last), new_pairs = pairs_of(frame);
    narc_error error;
    must(narc_match_pairs(row->broad, &old_pairs, &new_pairs, &row->workers, row->match, &error), &error);
    narc_gather(row->match, frame->pair_count, sizeof *frame->hints, last->hints, frame->hints);
}

/* The manifolds of these pairs where the bodies of `frame` are. */
static void find_frame_manifolds(struct step_row *row, const struct frame *frame, const narc_pairs *pairs,
                                 uint32_t *hints) {
    const struct workload *workload = frame->workload;
    const narc_bodies bodies = bodies_of(workload->bodies, workload->body_count);
    const narc_query query = {.hints = NARC_HINT_ARRAY(hints), .workers = &row->workers};
    narc_error error;
    must(narc_find_manifolds(workload->shapes, &bodies, pairs, &query, share_manifolds(row->capacity), row->capacity,
                             &row->manifold_count, &error),
         &error);
}

static void run_whole(struct step_row *row, const struct frame *last, struct frame *frame) {
    find_boxes(frame->workload, SETTLED_SKIN / 2, &row->workers, frame->boxes);
    find_frame_pairs(row, frame);
    carry_hints(row, last, frame);
    const narc_pairs pairs = pairs_of(frame);
    find_frame_manifolds(row, frame, &pairs, frame->hints);
}

static void update_pairs(struct step_row *row, const struct frame *frame) {
    const narc_bodies bodies = bodies_of(frame->workload->bodies, frame->workload->body_count);
    const narc_pair_options options = {.skin = (float)(SETTLED_SKIN / 2), .workers = &row->workers};
    narc_error error;
    must(narc_update_pairs(row->broad, frame->workload->shapes, &bodies, &options, &row->list, &error), &error);
}

static void run_kept(struct step_row *row, const struct frame *frame) {
    update_pairs(row, frame);
    if (!row->list->kept)
        fail("%s: a body has left its box", row->row.name);
    find_frame_manifolds(row, frame, &row->list->pairs, row->frames[0].hints);
}

static void run(struct bench_row *bench_row) {
    struct step_row *row = bench_row->context;
    struct frame *frame = &row->frames[row->runs % 2], *last = &row->frames[1 - row->runs % 2];
    row->runs++;
    switch (row->job.step) {
    case STEP_BOXES:
        find_boxes(frame->workload, SETTLED_SKIN / 2, &row->workers, frame->boxes);
        break;
    case STEP_PAIRS:
        find_frame_pairs(row, frame);
        break;
    case STEP_MATCH:
        carry_hints(row, last, frame);
        break;
    case STEP_WHOLE:
        run_whole(row, last, frame);
        break;
    case STEP_KEPT:
        run_kept(row, frame);
        break;
    }
}

/* Are the pairs of the first frame those that the workload has? Then its separations are those of the manifolds. */
static double count_wrong_pairs(const struct frame *frame) {
    const struct workload *workload = frame->workload;
    size_t wrong = frame->pair_count != workload->pair_count;
    for (size_t k = 0; k < frame->pair_count && !wrong; k++)
        wrong = frame->a[k] != workload->pairs[k].a || frame->b[k] != workload->pairs[k].b;
    return (double)wrong;
}

/* `index`: of each pair that was asked, its number in the workload; NULL: it is the same. */
static double count_wrong_manifolds(const struct step_row *row, const struct workload *workload,
                                    const uint32_t *index) {
    const narc_manifold *list = share_manifolds(row->capacity);
    size_t wrong = 0, colliding = 0;
    for (size_t k = 0; k < row->manifold_count; k++) {
        const uint32_t pair = index ? index[list[k].pair] : list[k].pair;
        wrong += pair == NARC_NO_MATCH || !(fabs(deepest_separation(&list[k]) - workload->gaps[pair]) < TOUCHING);
    }
    for (size_t k = 0; k < workload->pair_count; k++)
        colliding += workload->gaps[k] < -TOUCHING;
    return (double)(wrong + (row->manifold_count < colliding));
}

/* Finds the pairs of the kept list among those of the first frame. It has all of them, and where coordinates are large a
 * few more: its boxes are widened after they were rounded. Returns how many it lacks. */
static double count_lost_pairs(const struct step_row *row) {
    const narc_pairs frame = pairs_of(&row->frames[0]), *kept = &row->list->pairs;
    size_t found = 0;
    narc_error error;
    if (kept->count > row->capacity)
        return (double)kept->count;
    must(narc_match_pairs(row->broad, &frame, kept, NULL, row->match, &error), &error);
    for (size_t k = 0; k < kept->count; k++)
        found += row->match[k] != NARC_NO_MATCH;
    return (double)(frame.count - found);
}

static void make_frame(struct frame *frame, const struct workload_key *key, size_t capacity) {
    frame->workload = get_workload(key);
    frame->boxes = allocate(frame->workload->body_count, sizeof *frame->boxes);
    frame->a = allocate(capacity, sizeof *frame->a);
    frame->b = allocate(capacity, sizeof *frame->b);
    frame->hints = allocate(capacity, sizeof *frame->hints);
}

/* Both frames once, so that each has boxes, pairs and hints; checks those of the first. */
static void begin(struct step_row *row) {
    row->frames[0].pair_count = row->frames[1].pair_count = 0;
    run_whole(row, &row->frames[1], &row->frames[0]);
    row->row.wrong = count_wrong_pairs(&row->frames[0]);
    if (row->row.wrong == 0)
        row->row.wrong = count_wrong_manifolds(row, row->frames[0].workload, NULL);
    row->row.colliding = (double)row->manifold_count / (double)row->row.pairs;
    run_whole(row, &row->frames[0], &row->frames[1]);
    if (row->job.step == STEP_KEPT) {
        update_pairs(row, &row->frames[0]);
        row->row.wrong += count_lost_pairs(row);
        run_kept(row, &row->frames[1]);
        row->row.wrong += count_wrong_manifolds(row, row->frames[1].workload, row->match);
    }
}

static void prepare(struct bench_row *bench_row) {
    struct step_row *row = bench_row->context;
    struct workload_key key = row->job.key;
    narc_error error;
    must(narc_set_isa(row->job.isa, &error), &error);
    if (row->broad)
        return;
    must(narc_create_broad_phase(NULL, &row->broad), NULL);
    row->row.pairs = get_workload(&key)->pair_count;
    row->capacity = row->row.pairs + row->row.pairs / 16;
    make_frame(&row->frames[0], &key, row->capacity);
    key.moved = true;
    make_frame(&row->frames[1], &key, row->capacity);
    row->match = allocate(row->capacity, sizeof *row->match);
    begin(row);
}

struct bench_row *make_step_row(const char *name, const struct step_job *job) {
    struct step_row *row = allocate(1, sizeof *row);
    row->job = *job;
    row->workers = narc_openmp_workers(job->threads);
    bench_set(&row->row, name, prepare, run, row, true);
    row->row.threaded = job->threads > 1;
    return &row->row;
}
