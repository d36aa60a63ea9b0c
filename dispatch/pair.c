/* SPDX-License-Identifier: MIT
 *
 * pair.c - pairs by themselves: batches of a few, and the calls of narc.h for two bodies alone. The pair kernel answers
 * nearly all, and the others what it leaves.
 */
#include "pair.h"
#include "column.h"
#include "compiler.h"
#include "dispatch.h"
#include "error.h"

#include <math.h>
#include <string.h>

static const narc_query defaults;

/* ------------------------------------------------------------------------------------------------ a few of a batch */

/* The kernel's answer for the pair `number` of a batch, or of a call whose pairs bring their `own` bodies; UNASKED if it
 * names what does not exist. */
enum { UNASKED = -2 };
INLINE int ask_few(const narc_kernel_table *kernels, const narc_batch *batch, uint32_t number, bool own, bool manifold,
                   void *out_row) {
    narc_gathered pair;
    if (!narc_gather_pair(batch->shapes, batch->a, batch->b, batch->pairs, own, number, &pair))
        return UNASKED;
    const float margin = narc_float_or(batch->query->margins, number, batch->query->margin);
    const narc_one_pair asked = {batch, &pair.a, &pair.b, out_row, margin, number, manifold};
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
        const int rows = ask_few(kernels, batch, number, false, manifold, row);
        if (rows < 0) {
            narc_rows to = *out;
            to.base = dense ? out->base : row;
            found += kernel(batch, place, 1, skipped, &to);
        }
        found += rows > 0;
    }
    return found;
}

/* Begins a batch of a call that has a few pairs, and a query that asks for nothing else than a margin and dense rows; its
 * checks that are left are those of the bodies that are named. */
static bool begin_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                      const narc_query *query, narc_batch *out) {
    const narc_query *const q = out->query = query ? query : &defaults;
    if (!narc_are_few(shapes, bodies, pairs) || q->selection.base || q->selection.stride || q->selection_count ||
        q->first || q->count || q->row_stride || (query && narc_check_asking(query, NULL) != NARC_OK))
        return false;
    out->shapes = shapes;
    out->a = bodies;
    out->b = pairs->other_bodies ? pairs->other_bodies : bodies;
    out->pairs = pairs;
    return true;
}

bool narc_answer_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                     const narc_query *query, bool manifold, void *out_rows, size_t capacity, size_t *out_count) {
    narc_batch batch; /* an initialiser would clear all of it */
    narc_status status = NARC_OK;
    if (!out_rows || !out_count || !begin_few(shapes, bodies, pairs, query, &batch) || capacity < pairs->count)
        return false;
    const narc_query *const q = batch.query;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    const size_t row_size = manifold ? sizeof(narc_manifold) : sizeof(narc_contact);
    const bool own = narc_have_own_bodies(pairs);
    narc_manifold apart[NARC_FEW]; /* or contacts: where the last pair is an error the caller's rows stay as they are */
    char *const rows = pairs->count == 1 ? out_rows : (char *)apart;
    size_t found = 0;
    if (!kernels)
        return false;
    batch.flat_sine = manifold ? narc_find_flat_sine(q->flat_angle) : -1;
    for (uint32_t k = 0; k < pairs->count; k++) {
        char *const row = rows + (q->dense ? k : found) * row_size;
        const int answered = ask_few(kernels, &batch, k, own, manifold, row);
        if (answered < 0)
            return false;
        found += answered > 0;
    }
    if (rows != out_rows)
        memcpy(out_rows, rows, (q->dense ? pairs->count : found) * row_size);
    if (q->out_skipped)
        *q->out_skipped = 0;
    *out_count = found;
    return true;
}

/* A pair overlaps where its contact with a margin of 0 has a row. */
bool narc_overlap_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                      const narc_query *query, uint64_t *out_bits) {
    narc_batch batch;
    narc_status status = NARC_OK;
    uint64_t bits = 0;
    if (!out_bits || !begin_few(shapes, bodies, pairs, query, &batch))
        return false;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    for (uint32_t k = 0; k < pairs->count; k++) {
        narc_gathered pair;
        narc_contact row;
        if (!kernels || !narc_gather_pair(shapes, batch.a, batch.b, pairs, narc_have_own_bodies(pairs), k, &pair))
            return false;
        const narc_one_pair asked = {&batch, &pair.a, &pair.b, &row, 0, k, false};
        const int answered = kernels->pair(&asked);
        if (answered < 0)
            return false;
        bits |= (uint64_t)answered << k;
    }
    *out_bits = bits;
    if (batch.query->out_skipped)
        *batch.query->out_skipped = 0;
    return true;
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
        const int rows = ask_few(kernels, batch, number, false, false, &row);
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

static bool take_query(const narc_query *given, narc_one_pair *asked, narc_batch *batch) {
    asked->margin = given->margin;
    if (narc_check_asking(given, NULL) != NARC_OK)
        return false;
    batch->flat_sine = narc_find_flat_sine(given->flat_angle);
    return true;
}

/* What is needed behind the kernel's call is read from what it was given: nothing is kept in registers across it. */
INLINE narc_status ask(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *given,
                       bool manifold, void *out_row, narc_error *error) {
    narc_batch batch; /* an initialiser would clear all of it, of which the kernel reads this */
    batch.shapes = shapes;
    batch.query = &defaults;
    batch.flat_sine = narc_find_flat_sine(0);
    narc_one_pair asked = {&batch, a, b, out_row, 0, 0, manifold};
    const narc_kernel_table *kernels = NULL;
    if (given)
        batch.query = given;
    if (shapes && a && b && out_row && a->shape < shapes->count && b->shape < shapes->count &&
        (!given || take_query(given, &asked, &batch)))
        kernels = atomic_load_explicit(&narc_active_kernels, memory_order_acquire);
    const int found = kernels ? kernels->pair(&asked) : -1;
    if (found < 0)
        return ask_batch(&asked, error);
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
