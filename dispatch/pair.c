/* SPDX-License-Identifier: MIT
 *
 * pair.c - pairs by themselves: batches of a few, and the calls of narc.h for two bodies alone. The pair kernel answers
 * nearly all, and the others what it leaves.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"

#include <math.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------ a few of a batch */

/* As kernels have it (base/bodies.inl). A difference of floats, rounded from double, is that in single precision. */
static float find_difference(const narc_position_column *of_a, const narc_position_column *of_b, size_t a, size_t b) {
    return (float)(narc_position_at(*of_b, b) - narc_position_at(*of_a, a));
}

static float find_shifted(const narc_position_column *of_a, const narc_position_column *of_b, size_t a, size_t b,
                          narc_float_column shift, size_t pair) {
    return (float)(narc_position_at(*of_b, b) - narc_position_at(*of_a, a) + (double)narc_float_or(shift, pair, 0));
}

/* The pair that a batch asks of at `place`. */
static narc_one_pair gather_pair(const narc_batch *batch, size_t place) {
    const narc_bodies *const of_a = batch->a, *const of_b = batch->b;
    const narc_pairs *const pairs = batch->pairs;
    const size_t number = narc_pair_at(batch, place);
    const size_t a = pairs->a.base ? narc_index_at(pairs->a, number) : number;
    const size_t b = pairs->b.base ? narc_index_at(pairs->b, number) : number;
    const bool shifted = pairs->shift_x.base || pairs->shift_y.base;
    return (narc_one_pair){.number = (uint32_t)number,
                           .shape_a = narc_index_at(of_a->shape, a),
                           .shape_b = narc_index_at(of_b->shape, b),
                           .x = shifted ? find_shifted(&of_a->x, &of_b->x, a, b, pairs->shift_x, number)
                                        : find_difference(&of_a->x, &of_b->x, a, b),
                           .y = shifted ? find_shifted(&of_a->y, &of_b->y, a, b, pairs->shift_y, number)
                                        : find_difference(&of_a->y, &of_b->y, a, b),
                           .cosine_a = narc_float_at(of_a->cosine, a),
                           .sine_a = narc_float_at(of_a->sine, a),
                           .scale_a = narc_float_or(of_a->scale, a, 1),
                           .cosine_b = narc_float_at(of_b->cosine, b),
                           .sine_b = narc_float_at(of_b->sine, b),
                           .scale_b = narc_float_or(of_b->scale, b, 1),
                           .margin = narc_float_or(batch->query->margins, number, batch->query->margin)};
}

static size_t find_few(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out,
                       bool manifold) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL), *const others = NARC_KERNELS_FOR(1, kernels);
    narc_row_kernel *const kernel = manifold ? others->manifold : others->contact;
    const bool dense = batch->query->dense != 0;
    size_t found = 0;
    if (out->lists)
        return kernel(batch, first, count, skipped, out);
    for (size_t place = first; place < first + count; place++) {
        const narc_one_pair at = gather_pair(batch, place);
        const uint32_t number = (uint32_t)narc_pair_at(batch, place);
        char *const row = out->base + (ptrdiff_t)(dense ? number : found) * out->stride;
        const int rows = kernels->pair(batch, &at, manifold, row);
        if (rows < 0) {
            narc_rows to = *out;
            to.base = dense ? out->base : row;
            found += kernel(batch, place, 1, skipped, &to);
        } else if (rows == 0 && dense) {
            memset(row, 0, batch->row_size);
            memcpy(row, &number, sizeof number);
        }
        found += rows > 0;
    }
    return found;
}

size_t narc_find_few_contacts(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                              const narc_rows *out) {
    return find_few(batch, first, count, skipped, out, false);
}

size_t narc_find_few_separations(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                                 const narc_rows *out) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    size_t found = 0;
    for (size_t place = first; place < first + count; place++) {
        const narc_one_pair at = gather_pair(batch, place);
        narc_contact row;
        const int rows = kernels->pair(batch, &at, false, &row);
        const float separation = rows > 0 ? row.separation : INFINITY;
        if (rows < 0)
            found += NARC_KERNELS_FOR(1, kernels)->separation(batch, place, 1, skipped, out);
        else
            memcpy(out->base + (ptrdiff_t)narc_pair_at(batch, place) * out->stride, &separation, sizeof separation);
        found += rows > 0;
    }
    return found;
}

size_t narc_find_few_manifolds(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                               const narc_rows *out) {
    return find_few(batch, first, count, skipped, out, true);
}

/* ------------------------------------------------------------------------------------------------ two bodies */

static const narc_query defaults;

/* Through a batch, which says what is wrong. What is of many pairs in a query does not count; there is a row in any case. */
static narc_status ask_batch(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *query,
                             bool manifold, void *out_row, narc_error *error) {
    if (!a || !b || !out_row)
        return narc_fail_missing(error, !a ? "a" : !b ? "b" : "out_row");
    const narc_body two[] = {*a, *b};
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    const narc_pairs pair = {.count = 1};
    narc_query own = *query;
    size_t count;
    own.margins = (narc_float_column){NULL, 0};
    own.selection = (narc_index_column){NULL, 0};
    own.selection_count = own.first = own.count = 0;
    own.row_stride = 0;
    own.workers = NULL;
    own.dense = 1;
    return manifold ? narc_find_manifolds(shapes, &bodies, &pair, &own, out_row, 1, &count, error)
                    : narc_find_contacts(shapes, &bodies, &pair, &own, out_row, 1, &count, error);
}

/* The kernel's answer, below 0 if there is none. */
static int ask_kernel(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *query,
                      bool manifold, void *out_row) {
    if (!shapes || !a || !b || !out_row || a->shape >= shapes->count || b->shape >= shapes->count ||
        narc_check_asking(query, NULL) != NARC_OK)
        return -1;
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    if (!kernels)
        return -1;
    const narc_one_pair at = {.shape_a = a->shape,
                              .shape_b = b->shape,
                              .x = (float)(b->x - a->x),
                              .y = (float)(b->y - a->y),
                              .cosine_a = a->cosine,
                              .sine_a = a->sine,
                              .scale_a = a->scale,
                              .cosine_b = b->cosine,
                              .sine_b = b->sine,
                              .scale_b = b->scale,
                              .margin = query->margin};
    narc_query own; /* an initialiser would clear all of both, of which kernels read little */
    narc_batch batch;
    own.second_margin = query->second_margin;
    batch.shapes = shapes;
    batch.query = &own;
    batch.flat_sine = manifold ? narc_find_flat_sine(query->flat_angle) : -1;
    return kernels->pair(&batch, &at, manifold, out_row);
}

static narc_status ask(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *given,
                       bool manifold, void *out_row, size_t row_size, narc_error *error) {
    const narc_query *const query = given ? given : &defaults;
    const int found = ask_kernel(shapes, a, b, query, manifold, out_row);
    if (found < 0)
        return ask_batch(shapes, a, b, query, manifold, out_row, error);
    if (found == 0)
        memset(out_row, 0, row_size);
    if (query->out_skipped)
        *query->out_skipped = 0;
    return NARC_OK;
}

narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                              const narc_query *query, narc_contact *out_row, narc_error *error) {
    return ask(shapes, a, b, query, false, out_row, sizeof *out_row, error);
}

narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                               const narc_query *query, narc_manifold *out_row, narc_error *error) {
    return ask(shapes, a, b, query, true, out_row, sizeof *out_row, error);
}
