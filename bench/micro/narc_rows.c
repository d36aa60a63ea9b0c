/* SPDX-License-Identifier: MIT
 *
 * narc_rows.c - the rows of this library: a batch call, and the check of what it answers.
 */
#include "narc_rows.h"

#include <math.h>
#include <stdio.h>

#include "common.h"

struct narc_row {
    struct bench_row row;
    struct narc_job job;
    const struct workload *frames[2]; /* in one frame both are the same */
    size_t runs;
    uint64_t *bits;
    narc_contacts contacts;
    size_t contact_count;
    uint32_t *hints;
};

static void run(struct bench_row *bench_row) {
    struct narc_row *row = bench_row->context;
    const struct workload *workload = row->frames[row->runs++ % 2];
    const narc_bodies bodies = bodies_of(workload->bodies, workload->body_count);
    const narc_pairs pairs = {
        .count = row->job.pair_count, .a = NARC_COLUMN(workload->pairs, a), .b = NARC_COLUMN(workload->pairs, b)};
    narc_error error;
    narc_status status;
    if (row->job.query == QUERY_OVERLAP)
        status = narc_find_overlaps(workload->shapes, &bodies, &pairs, row->job.threads, row->bits, &error);
    else if (row->job.query == QUERY_HINTED)
        status = narc_find_contacts_hinted(workload->shapes, &bodies, &pairs, 0, row->job.threads, row->hints,
                                           &row->contacts, &row->contact_count, &error);
    else
        status = narc_find_contacts(workload->shapes, &bodies, &pairs, 0, row->job.threads, &row->contacts,
                                    &row->contact_count, &error);
    if (status != NARC_OK)
        fail("%s: %s", row->row.name, error.message);
}

/* Bits from a list of contacts. A separation that is not the exact one counts as a wrong answer. */
static size_t spread_contacts(struct narc_row *row, const struct workload *workload) {
    size_t wrong = 0;
    for (size_t k = 0; k < NARC_BIT_WORDS(row->job.pair_count); k++)
        row->bits[k] = 0;
    for (size_t k = 0; k < row->contact_count; k++) {
        const uint32_t pair = row->contacts.pair[k];
        row->bits[pair / 64] |= (uint64_t)1 << pair % 64;
        wrong += !(fabs(row->contacts.separation[k] - workload->gaps[pair]) < TOUCHING);
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
        for (size_t k = 0; k < row->job.pair_count; k++) {
            const int hit = row->bits[k / 64] >> k % 64 & 1;
            colliding += (size_t)hit;
            wrong += hit != (workload->gaps[k] < 0) && fabs(workload->gaps[k]) >= TOUCHING;
        }
    }
    row->row.colliding = (double)colliding / (2 * (double)row->job.pair_count);
    row->row.wrong = (double)wrong;
}

static void make_outputs(struct narc_row *row) {
    const size_t count = row->job.pair_count;
    row->bits = allocate(NARC_BIT_WORDS(count), sizeof *row->bits);
    if (row->job.query == QUERY_OVERLAP)
        return;
    row->contacts = allocate_contacts(count);
    row->hints = allocate(count, sizeof *row->hints);
}

static void prepare(struct bench_row *bench_row) {
    struct narc_row *row = bench_row->context;
    narc_error error;
    must(narc_set_isa(row->job.isa, &error), &error);
    if (row->bits)
        return;
    struct workload_key key = row->job.key;
    row->frames[0] = row->frames[1] = get_workload(&key);
    if (row->job.query >= QUERY_FRAMES) {
        key.moved = true;
        row->frames[1] = get_workload(&key);
    }
    make_outputs(row);
    check(row);
}

struct bench_row *make_narc_row(const char *name, const struct narc_job *job) {
    struct narc_row *row = allocate(1, sizeof *row);
    row->job = *job;
    snprintf(row->row.name, sizeof row->row.name, "%s", name);
    row->row.pairs = job->pair_count;
    row->row.prepare = prepare;
    row->row.run = run;
    row->row.context = row;
    row->row.threaded = job->threads > 1;
    row->row.must_be_right = true;
    return &row->row;
}
