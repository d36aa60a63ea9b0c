/* SPDX-License-Identifier: MIT
 *
 * pair.c - the calls of narc.h for two bodies alone. The pair kernel answers nearly all; what it does not, and what is not
 * in order, goes through a batch, which also says what is wrong.
 */
#include "dispatch.h"
#include "error.h"

#include <string.h>

static const narc_query defaults;

static bool is_in_order(const narc_query *query) {
    for (size_t k = 0; k < sizeof query->reserved / sizeof(void *); k++)
        if (query->reserved[k])
            return false;
    return query->margin == query->margin && query->second_margin == query->second_margin &&
           query->flat_angle <= NARC_MAX_FLAT_ANGLE;
}

/* What counts of a query; there is a row in any case. */
static narc_status ask_batch(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *query,
                             bool manifold, void *out_row, narc_error *error) {
    if (!a || !b || !out_row)
        return narc_fail_missing(error, !a ? "a" : !b ? "b" : "out_row");
    const narc_body two[] = {*a, *b};
    const narc_bodies bodies = narc_view_bodies(two, 2);
    const narc_pairs pair = {.count = 1};
    narc_query own = {.margin = query->margin,
                      .second_margin = query->second_margin,
                      .flat_angle = query->flat_angle,
                      .dense = 1,
                      .out_skipped = query->out_skipped,
                      .front_only = query->front_only};
    size_t count;
    memcpy(own.reserved, query->reserved, sizeof own.reserved);
    return manifold ? narc_find_manifolds(shapes, &bodies, &pair, &own, out_row, 1, &count, error)
                    : narc_find_contacts(shapes, &bodies, &pair, &own, out_row, 1, &count, error);
}

/* The kernel's answer, below 0 if there is none. */
static int ask_kernel(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *query,
                      bool manifold, void *out_row) {
    if (!shapes || !a || !b || !out_row || a->shape >= shapes->count || b->shape >= shapes->count ||
        !is_in_order(query))
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
    own.selection.base = NULL;
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
