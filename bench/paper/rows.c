/* SPDX-License-Identifier: MIT
 *
 * rows.c - timing.
 */
#include "rows.h"

#include <stdlib.h>
#include <string.h>

#include "random.h"

/* Where answers go; large enough for any row. */
struct answers {
    uint64_t *bits;
    narc_contact *contacts;
    size_t found;
};

size_t add_row(struct rows *rows, struct row row) {
    if (rows->count == rows->capacity) {
        rows->capacity = rows->capacity ? 2 * rows->capacity : 64;
        struct row *list = realloc(rows->list, rows->capacity * sizeof *list);
        if (!list)
            fail("out of memory");
        rows->list = list;
    }
    rows->list[rows->count] = row;
    return rows->count++;
}

struct row row_of(const struct scene *scene, enum kind kind, enum question question, narc_method method,
                  const char *isa) {
    return (struct row){.methods = scene->templates->methods[kind],
                        .frames = {scene->bodies},
                        .frame_count = 1,
                        .pair_count = scene->pair_count,
                        .question = question,
                        .options = {.method = method},
                        .isa = isa,
                        .claim = scene->situation == COLLIDING};
}

static void ask(const struct row *row, const struct body *list, struct answers *out) {
    const narc_bodies bodies = bodies_of(list, 2 * row->pair_count);
    const narc_pairs pairs = neighbours(row->pair_count);
    narc_error error;
    if (row->question == QUESTION_OVERLAP)
        must(narc_find_overlaps_by(row->methods, &bodies, &pairs, &row->options, &row->query, out->bits, &error),
             &error);
    else
        must(narc_find_contacts_by(row->methods, &bodies, &pairs, &row->options, &row->query, out->contacts,
                                   row->pair_count, &out->found, &error),
             &error);
}

static void run_pass(const struct row *row, struct answers *out) {
    for (size_t frame = 0; frame < row->frame_count; frame++)
        ask(row, row->frames[frame], out);
}

static size_t count_hits(const struct row *row, const struct answers *answers) {
    size_t hits = 0;
    if (row->question == QUESTION_CONTACT)
        return answers->found;
    for (size_t word = 0; word < NARC_BIT_WORDS(row->pair_count); word++)
        hits += (size_t)__builtin_popcountll(answers->bits[word]);
    return hits;
}

/* One pass that is not counted, for the answers, and one that tells how many fit in a repetition. */
static void prepare(struct row *row, double least_time, struct answers *answers) {
    narc_error error;
    must(narc_set_isa(row->isa, &error), &error);
    run_pass(row, answers);
    if (row->claim >= 0) {
        const size_t hits = count_hits(row, answers);
        row->wrong = row->claim ? row->pair_count - hits : hits;
    }
    const double start = now();
    run_pass(row, answers);
    row->passes = 1 + (size_t)(least_time / (now() - start + 1));
}

static void time_row(struct row *row, int repetition, struct answers *answers) {
    narc_error error;
    must(narc_set_isa(row->isa, &error), &error);
    const double start = now();
    for (size_t pass = 0; pass < row->passes; pass++)
        run_pass(row, answers);
    row->times[repetition] = (now() - start) / (double)(row->passes * row->frame_count * row->pair_count);
}

static void shuffle(size_t *order, size_t count, uint64_t *random) {
    for (size_t k = count; k > 1; k--) {
        const size_t other = random_below(random, k), kept = order[k - 1];
        order[k - 1] = order[other];
        order[other] = kept;
    }
}

static void finish(struct row *row, int repetitions) {
    double *times = row->times;
    const size_t count = (size_t)repetitions;
    row->ns = quantile(times, count, 0.5);
    row->spread = (quantile(times, count, 0.75) - quantile(times, count, 0.25)) / row->ns;
}

void time_rows(struct rows *rows, int repetitions, double least_time, uint64_t *random) {
    size_t *order = allocate(rows->count, sizeof *order), most = 0;
    for (size_t k = 0; k < rows->count; k++) {
        order[k] = k;
        most = rows->list[k].pair_count > most ? rows->list[k].pair_count : most;
    }
    struct answers answers = {allocate(NARC_BIT_WORDS(most), sizeof(uint64_t)), allocate(most, sizeof(narc_contact)),
                              0};
    begin_step("timing: answers, and how often each row fits in a repetition");
    for (size_t k = 0; k < rows->count; k++)
        prepare(&rows->list[k], least_time, &answers);
    for (int repetition = 0; repetition < repetitions; repetition++) {
        begin_step("timing: a repetition of all rows");
        shuffle(order, rows->count, random);
        for (size_t k = 0; k < rows->count; k++)
            time_row(&rows->list[order[k]], repetition, &answers);
    }
    for (size_t k = 0; k < rows->count; k++)
        finish(&rows->list[k], repetitions);
    free(answers.bits);
    free(answers.contacts);
    free(order);
}
