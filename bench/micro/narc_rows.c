/* SPDX-License-Identifier: MIT
 *
 * narc_rows.c - the rows of this library: a batch call, and the check of what it answers.
 */
#include "rows.h"

#include <math.h>

#include "common.h"
#include "disc_loops.h"
#include "manifolds.h"

struct narc_row {
    struct bench_row row;
    struct narc_job job;
    const struct workload *frames[2]; /* in one frame both are the same */
    narc_workers workers;
    size_t runs;
    uint64_t *bits;
    narc_contact *contacts;
    size_t found;
    uint32_t *hints;
    struct disc *discs[2]; /* of the frames */
};

static bool has_frames(const struct narc_job *job) { return job->query >= QUERY_FRAMES || is_settled(&job->key); }

static bool has_hints(const struct narc_job *job) { return job->query == QUERY_HINTED || job->query == QUERY_MANIFOLD; }

/* All pairs in one call, or so many in each. */
static narc_status find_contacts(struct narc_row *row, const narc_shapes *shapes, const narc_bodies *bodies,
                                 const narc_pairs *pairs, narc_query query, narc_error *error) {
    narc_status status = NARC_OK;
    row->found = 0;
    while (query.first < pairs->count && status == NARC_OK) {
        const size_t left = pairs->count - query.first, batch = row->job.batch;
        size_t found = 0;
        query.count = batch > 0 && batch < left ? batch : left;
        status = narc_find_contacts(shapes, bodies, pairs, &query, row->contacts + row->found,
                                    pairs->count - row->found, &found, error);
        query.first += query.count;
        row->found += found;
    }
    return status;
}

static void run(struct bench_row *bench_row) {
    struct narc_row *row = bench_row->context;
    const struct narc_job *job = &row->job;
    const size_t frame = row->runs++ % 2;
    const struct workload *workload = row->frames[frame];
    const narc_bodies bodies = bodies_of(workload->bodies, workload->body_count);
    const narc_pairs pairs = {
        .count = row->row.pairs, .a = NARC_COLUMN(workload->pairs, a), .b = NARC_COLUMN(workload->pairs, b)};
    const narc_query query = {.hints = NARC_HINT_ARRAY(row->hints), .workers = &row->workers};
    narc_error error;
    narc_status status = NARC_OK;
    if (job->query == QUERY_OVERLAP)
        status = narc_find_overlaps(workload->shapes, &bodies, &pairs, &query, row->bits, &error);
    else if (job->query == QUERY_MANIFOLD)
        status = narc_find_manifolds(workload->shapes, &bodies, &pairs, &query, share_manifolds(pairs.count),
                                     pairs.count, &row->found, &error);
    else if (job->query == QUERY_DISCS)
        row->found = find_disc_loop(job->isa)(row->discs[frame], workload->pairs, pairs.count, row->contacts);
    else
        status = find_contacts(row, workload->shapes, &bodies, &pairs, query, &error);
    if (status != NARC_OK)
        fail("%s: %s", row->row.name, error.message);
}

/* Bits from a list of contacts. A separation that is not the exact one counts as a wrong answer. */
static size_t spread_contacts(struct narc_row *row, const struct workload *workload) {
    const bool manifolds = row->job.query == QUERY_MANIFOLD;
    const narc_manifold *list = share_manifolds(row->row.pairs);
    size_t wrong = 0;
    for (size_t k = 0; k < NARC_BIT_WORDS(row->row.pairs); k++)
        row->bits[k] = 0;
    for (size_t k = 0; k < row->found; k++) {
        const uint32_t pair = manifolds ? list[k].pair : row->contacts[k].pair;
        const double separation = manifolds ? deepest_separation(&list[k]) : row->contacts[k].separation;
        row->bits[pair / 64] |= (uint64_t)1 << pair % 64;
        wrong += !(fabs(separation - workload->gaps[pair]) < TOUCHING);
    }
    return wrong;
}

static void check(struct narc_row *row) {
    size_t wrong = 0, colliding = 0;
    for (int frame = 0; frame < 2; frame++) {
        const struct workload *workload = row->frames[row->runs % 2];
        run(&row->row);
        if (row->job.query != QUERY_OVERLAP)
            wrong += spread_contacts(row, workload);
        for (size_t k = 0; k < row->row.pairs; k++) {
            const int hit = row->bits[k / 64] >> k % 64 & 1;
            colliding += (size_t)hit;
            wrong += hit != (workload->gaps[k] < 0) && fabs(workload->gaps[k]) >= TOUCHING;
        }
    }
    row->row.colliding = (double)colliding / (2 * (double)row->row.pairs);
    row->row.wrong = (double)wrong;
}

static struct disc *make_discs(const struct workload *workload) {
    struct disc *discs = allocate(workload->body_count, sizeof *discs);
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *body = &workload->bodies[k];
        discs[k] = (struct disc){body->x, body->y, (float)workload->outlines[body->shape].arcs[0].radius, 0};
    }
    return discs;
}

static void make_outputs(struct narc_row *row) {
    const size_t count = row->row.pairs;
    row->bits = allocate(NARC_BIT_WORDS(count), sizeof *row->bits);
    if (row->job.query == QUERY_OVERLAP)
        return;
    if (row->job.query != QUERY_MANIFOLD)
        row->contacts = allocate(count + 1, sizeof *row->contacts); /* disc loops write one more */
    if (has_hints(&row->job))
        row->hints = allocate(count, sizeof *row->hints);
    for (int frame = 0; frame < 2 && row->job.query == QUERY_DISCS; frame++)
        row->discs[frame] = make_discs(row->frames[frame]);
}

static void prepare(struct bench_row *bench_row) {
    struct narc_row *row = bench_row->context;
    narc_error error;
    if (row->job.query != QUERY_DISCS)
        must(narc_set_isa(row->job.isa, &error), &error);
    if (row->bits)
        return;
    struct workload_key key = row->job.key;
    row->frames[0] = row->frames[1] = get_workload(&key);
    row->row.pairs = row->job.pair_count > 0 ? row->job.pair_count : row->frames[0]->pair_count;
    if (has_frames(&row->job)) {
        key.moved = true;
        row->frames[1] = get_workload(&key);
    }
    make_outputs(row);
    check(row);
}

struct bench_row *make_narc_row(const char *name, const struct narc_job *job) {
    struct narc_row *row = allocate(1, sizeof *row);
    row->job = *job;
    row->workers = narc_openmp_workers(job->threads);
    bench_set(&row->row, name, prepare, run, row, true);
    row->row.threaded = job->threads > 1;
    return &row->row;
}
