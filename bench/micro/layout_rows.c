/* SPDX-License-Identifier: MIT
 *
 * layout_rows.c - the benchmark rows that compare layouts, and the check that all of them say the same, and nothing
 * that the exact separation contradicts.
 */
#include "layout_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common.h"
#include "layout.h"

static const char *const names[LAYOUTS + 1] = {"rows", "planes-gathered", "planes-masked", "planes-loaded", NULL};

const char *layout_name(size_t layout) { return names[layout]; }

struct layout_row {
    struct bench_row row;
    struct workload_key key;
    layout_stage *const *stages;
    enum layout layout;
    const struct layout_input *input;
    uint64_t *apart, *deep;
};

/* Room for rounding, in parts of the radius. */
static const double room = 1e-5;

static struct shape_row row_of(const narc_shapes *shapes, uint32_t shape) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(shapes, shape, arcs);
    narc_circle bound = {0}, inner = {0};
    if (!narc_compute_bounding_circle(arcs, count, &bound) || !narc_compute_inscribed_circle(arcs, count, &inner))
        fail("a shape without circles");
    return (struct shape_row){shape,
                              (uint32_t)count,
                              (float)bound.x,
                              (float)bound.y,
                              (float)(bound.radius * (1 + room)),
                              (float)inner.x,
                              (float)inner.y,
                              (float)(inner.radius * (1 - room))};
}

static const struct layout_input *make_input(const struct workload *workload) {
    struct layout_input *input = allocate(1, sizeof *input);
    struct shape_row *rows = allocate(workload->shape_count, sizeof *rows);
    float *planes = allocate(SHAPE_WORDS * workload->shape_count, sizeof *planes);
    for (size_t k = 0; k < workload->shape_count; k++) {
        float words[SHAPE_WORDS];
        rows[k] = row_of(workload->shapes, (uint32_t)k);
        memcpy(words, &rows[k], sizeof words);
        for (size_t w = 0; w < SHAPE_WORDS; w++)
            planes[w * workload->shape_count + k] = words[w];
    }
    *input = (struct layout_input){.bodies = workload->bodies,
                                   .pairs = workload->pairs,
                                   .pair_count = workload->pair_count / 64 * 64,
                                   .rows = rows};
    for (size_t w = 0; w < SHAPE_WORDS; w++)
        input->planes[w] = &planes[w * workload->shape_count];
    return input;
}

/* All rows of a workload share its input. */
static const struct layout_input *input_of(const struct workload *workload) {
    enum { MAX_INPUTS = 16 };
    static struct {
        const struct workload *workload;
        const struct layout_input *input;
    } inputs[MAX_INPUTS];
    size_t k = 0;
    for (; k < MAX_INPUTS && inputs[k].workload; k++)
        if (inputs[k].workload == workload)
            return inputs[k].input;
    if (k == MAX_INPUTS)
        fail("more than %d workloads of layouts", MAX_INPUTS);
    inputs[k].workload = workload;
    return inputs[k].input = make_input(workload);
}

static void run(struct bench_row *bench_row) {
    struct layout_row *row = bench_row->context;
    row->stages[row->layout](row->input, row->apart, row->deep);
}

static void check(struct layout_row *row, const struct workload *workload) {
    const size_t words = row->input->pair_count / 64;
    uint64_t *apart = allocate(words, sizeof *apart), *deep = allocate(words, sizeof *deep);
    size_t wrong = 0, colliding = 0;
    run(&row->row);
    row->stages[ROWS](row->input, apart, deep);
    for (size_t k = 0; k < row->input->pair_count; k++) {
        const bool is_apart = row->apart[k / 64] >> k % 64 & 1, is_deep = row->deep[k / 64] >> k % 64 & 1;
        const double gap = workload->gaps[k];
        wrong += (is_apart && gap < -TOUCHING) || (is_deep && gap > TOUCHING);
        wrong += is_apart != (apart[k / 64] >> k % 64 & 1) || is_deep != (deep[k / 64] >> k % 64 & 1);
        colliding += is_deep;
    }
    row->row.colliding = (double)colliding / (double)row->input->pair_count;
    row->row.wrong = (double)wrong;
}

static void prepare(struct bench_row *bench_row) {
    struct layout_row *row = bench_row->context;
    if (row->input)
        return;
    const struct workload *workload = get_workload(&row->key);
    row->input = input_of(workload);
    row->apart = allocate(row->input->pair_count / 64, sizeof *row->apart);
    row->deep = allocate(row->input->pair_count / 64, sizeof *row->deep);
    check(row, workload);
}

static layout_stage *const *stages_of(const char *isa) {
#ifdef BENCH_LAYOUTS
    if (strcmp(isa, "avx2") == 0)
        return layouts_avx2;
    if (strcmp(isa, "avx512") == 0)
        return layouts_avx512;
#endif
    (void)isa;
    return NULL;
}

struct bench_row *make_layout_row(const char *name, size_t layout, const struct workload_key *key, const char *isa) {
    layout_stage *const *stages = stages_of(isa);
    if (!stages)
        return NULL;
    struct layout_row *row = allocate(1, sizeof *row);
    row->key = *key;
    row->stages = stages;
    row->layout = (enum layout)layout;
    snprintf(row->row.name, sizeof row->row.name, "%s", name);
    row->row.pairs = key->pair_count / 64 * 64;
    row->row.prepare = prepare;
    row->row.run = run;
    row->row.context = row;
    row->row.must_be_right = true;
    return &row->row;
}
