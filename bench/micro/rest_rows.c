/* SPDX-License-Identifier: MIT
 *
 * rest_rows.c - lists of pairs of a settled pile of which all bodies move, a few, or none.
 */
#include "rows.h"

#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "narc_broad_phase.h"
#include "settled.h"

struct rest_row {
    struct bench_row row;
    size_t one_of, runs;
    struct workload_key key;
    const char *isa;
    const narc_shapes *shapes;
    struct body *bodies;
    size_t body_count;
    narc_broad_phase *broad;
    const narc_pair_list *list;
};

static const float skin = (float)(SETTLED_SKIN / 2);

/* There and back, further than the skin. */
static void move_some(struct rest_row *row) {
    const size_t turn = row->one_of > 0 ? row->runs / row->one_of : 0;
    for (size_t k = row->one_of > 0 ? row->runs % row->one_of : row->body_count; k < row->body_count; k += row->one_of)
        row->bodies[k].x += turn % 2 == 0 ? 1.5f * skin : -1.5f * skin;
    row->runs++;
}

static void run(struct bench_row *bench_row) {
    struct rest_row *row = bench_row->context;
    const narc_bodies bodies = bodies_of(row->bodies, row->body_count);
    const narc_pair_options options = {.skin = skin};
    narc_error error;
    move_some(row);
    must(narc_update_pairs(row->broad, row->shapes, &bodies, &options, &row->list, &error), &error);
}

/* Of the pairs of boxes without a skin, how many the list lacks. */
static double count_lost_pairs(const struct rest_row *row) {
    const narc_bodies bodies = bodies_of(row->bodies, row->body_count);
    const size_t capacity = row->list->pairs.count;
    narc_box *const boxes = allocate(row->body_count, sizeof *boxes);
    uint32_t *const a = allocate(capacity, sizeof *a), *const b = allocate(capacity, sizeof *b);
    uint32_t *const match = allocate(capacity, sizeof *match);
    size_t count = 0, lost = 0;
    narc_error error;
    narc_broad_phase *other;
    must(narc_create_broad_phase(NULL, &other), NULL);
    must(narc_compute_boxes(row->shapes, &bodies, NULL, boxes, &error), &error);
    must(narc_find_pairs(other, boxes, row->body_count, NULL, NULL, a, b, capacity, &count, &error), &error);
    const narc_pairs pairs = {.count = count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    must(narc_match_pairs(other, &row->list->pairs, &pairs, NULL, match, &error), &error);
    for (size_t k = 0; k < count; k++)
        lost += match[k] == NARC_NO_MATCH;
    narc_destroy_broad_phase(other);
    free(boxes);
    free(a);
    free(b);
    free(match);
    return (double)lost;
}

static void prepare(struct bench_row *bench_row) {
    struct rest_row *row = bench_row->context;
    narc_error error;
    must(narc_set_isa(row->isa, &error), &error);
    if (row->broad)
        return;
    const struct workload *const workload = get_workload(&row->key);
    row->shapes = workload->shapes;
    row->body_count = workload->body_count;
    row->bodies = allocate(row->body_count, sizeof *row->bodies);
    memcpy(row->bodies, workload->bodies, row->body_count * sizeof *row->bodies);
    must(narc_create_broad_phase(NULL, &row->broad), NULL);
    row->row.pairs = workload->pair_count;
    for (int step = 0; step < 10; step++) {
        run(&row->row);
        row->row.wrong += count_lost_pairs(row);
    }
    row->row.wrong += row->list->kept != (row->one_of == 0);
}

struct bench_row *make_rest_row(const char *name, size_t one_of, const struct workload_key *key, const char *isa) {
    struct rest_row *row = allocate(1, sizeof *row);
    row->one_of = one_of;
    row->key = *key;
    row->isa = isa;
    bench_set(&row->row, name, prepare, run, row, true);
    return &row->row;
}
