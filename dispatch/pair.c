/* SPDX-License-Identifier: MIT
 *
 * pair.c - pairs by themselves: batches of a few, and the calls of narc.h for two bodies alone. The pair kernel answers
 * nearly all, and the others what it leaves.
 */
#include "column.h"
#include "compiler.h"
#include "dispatch.h"
#include "error.h"

#include <math.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------ a few of a batch */

/* The kernel's answer for the pair of a batch at `place`. */
static int ask_few(const narc_kernel_table *kernels, const narc_batch *batch, uint32_t number, bool manifold,
                   void *out_row) {
    narc_body a, b;
    narc_gather_pair(batch, number, &a, &b);
    const float margin = narc_float_or(batch->query->margins, number, batch->query->margin);
    const narc_one_pair asked = {batch, &a, &b, out_row, margin, number, manifold};
    return kernels->pair(&asked);
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
        const uint32_t number = (uint32_t)narc_pair_at(batch, place);
        char *const row = out->base + (ptrdiff_t)(dense ? number : found) * out->stride;
        const int rows = ask_few(kernels, batch, number, manifold, row);
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
        const uint32_t number = (uint32_t)narc_pair_at(batch, place);
        narc_contact row;
        const int rows = ask_few(kernels, batch, number, false, &row);
        const float separation = rows > 0 ? row.separation : INFINITY;
        if (rows < 0)
            found += NARC_KERNELS_FOR(1, kernels)->separation(batch, place, 1, skipped, out);
        else
            memcpy(out->base + (ptrdiff_t)number * out->stride, &separation, sizeof separation);
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
NOINLINE narc_status ask_batch(const narc_one_pair *asked, narc_error *error) {
    const narc_shapes *const shapes = asked->batch->shapes;
    if (!asked->a || !asked->b || !asked->out_row)
        return narc_fail_missing(error, !asked->a ? "a" : !asked->b ? "b" : "out_row");
    const narc_body two[] = {*asked->a, *asked->b};
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    const narc_pairs pair = {.count = 1};
    narc_query own = *asked->batch->query;
    size_t count;
    own.margins = (narc_float_column){NULL, 0};
    own.selection = (narc_index_column){NULL, 0};
    own.selection_count = own.first = own.count = 0;
    own.row_stride = 0;
    own.workers = NULL;
    own.dense = 1;
    return asked->manifold ? narc_find_manifolds(shapes, &bodies, &pair, &own, asked->out_row, 1, &count, error)
                           : narc_find_contacts(shapes, &bodies, &pair, &own, asked->out_row, 1, &count, error);
}

/* What is needed behind the kernel's call is read from what it was given: nothing is kept in registers across it. */
INLINE narc_status ask(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *given,
                       bool manifold, void *out_row, narc_error *error) {
    narc_batch batch; /* an initialiser would clear all of it, of which the kernel reads this */
    batch.shapes = shapes;
    batch.query = given ? given : &defaults;
    const narc_one_pair asked = {&batch, a, b, out_row, batch.query->margin, 0, manifold};
    const narc_kernel_table *kernels = NULL;
    narc_status status = NARC_OK;
    int found = -1;
    if (shapes && a && b && out_row && a->shape < shapes->count && b->shape < shapes->count &&
        (!given || narc_check_asking(given, NULL) == NARC_OK))
        kernels = narc_kernels(&status, NULL);
    if (kernels) {
        batch.flat_sine = manifold ? narc_find_flat_sine(batch.query->flat_angle) : -1;
        found = kernels->pair(&asked);
    }
    if (found < 0)
        return ask_batch(&asked, error);
    if (found == 0)
        memset(asked.out_row, 0, manifold ? sizeof(narc_manifold) : sizeof(narc_contact));
    if (batch.query->out_skipped)
        *batch.query->out_skipped = 0;
    return NARC_OK;
}

narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                              const narc_query *query, narc_contact *out_row, narc_error *error) {
    return ask(shapes, a, b, query, false, out_row, error);
}

narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                               const narc_query *query, narc_manifold *out_row, narc_error *error) {
    return ask(shapes, a, b, query, true, out_row, error);
}
