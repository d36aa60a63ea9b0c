/* SPDX-License-Identifier: MIT
 *
 * query.c - the batch calls of narc_methods.h: which kernel a method means, its settings, and their checks.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_methods.h"

#include <math.h>

/* A method's kernels in one table. */
struct kernels {
    narc_overlap_kernel *overlap;
    narc_contact_kernel *contact; /* NULL: it has none */
};

static const char *const method_names[] = {
    [NARC_METHOD_SAT] = "sat", [NARC_METHOD_SAT_FIRST] = "sat-first", [NARC_METHOD_POLYGON_SAT] = "polygon-sat",
    [NARC_METHOD_GJK] = "gjk", [NARC_METHOD_CIRCLE] = "circle",       [NARC_METHOD_AABB] = "aabb",
    [NARC_METHOD_OBB] = "obb",
};
enum { METHOD_COUNT = sizeof method_names / sizeof *method_names };

static struct kernels kernels_of(const narc_kernel_table *table, narc_method method) {
    const narc_method_table *methods = table->methods;
    const struct kernels all[METHOD_COUNT] = {
        [NARC_METHOD_SAT] = {table->overlap, table->contact},
        [NARC_METHOD_SAT_FIRST] = {methods->overlap_first, methods->contact_first},
        [NARC_METHOD_POLYGON_SAT] = {methods->overlap_polygon, methods->contact_polygon},
        [NARC_METHOD_GJK] = {methods->overlap_gjk, methods->contact_gjk},
        [NARC_METHOD_CIRCLE] = {methods->overlap_circle, NULL},
        [NARC_METHOD_AABB] = {methods->overlap_aabb, NULL},
        [NARC_METHOD_OBB] = {methods->overlap_obb, NULL},
    };
    return all[method];
}

const char *narc_method_name(narc_method method) {
    return (unsigned)method < METHOD_COUNT ? method_names[method] : NULL;
}

/* Are all shapes of all pairs polygons? */
static narc_status check_polygons(const narc_batch *batch, narc_error *error) {
    if (batch->shapes->curved_count == 0)
        return NARC_OK;
    const narc_index_column columns[2] = {batch->pairs->a, batch->pairs->b};
    for (size_t pair = 0; pair < batch->pairs->count; pair++) {
        for (int k = 0; k < 2; k++) {
            const uint32_t body = narc_index_at(columns[k], pair), shape = narc_index_at(batch->bodies->shape, body);
            if (narc_has_shape(batch->shapes, shape) && !(batch->shapes->headers[shape].flags & NARC_SHAPE_POLYGON))
                return narc_fail(error, NARC_ERROR_ARGUMENT, pair, shape,
                                 "pair %zu: polygon-sat needs polygons, but shape %lu of body %lu has arcs", pair,
                                 (unsigned long)shape, (unsigned long)body);
        }
    }
    return NARC_OK;
}

/* Checks batch and query, and puts the query's settings into the batch. */
static narc_status check_query(narc_batch *batch, const narc_query *query, unsigned threads,
                               struct kernels *out_kernels, narc_error *error) {
    const narc_kernel_table *table = NULL;
    if (!query)
        return narc_fail_missing(error, "query");
    if ((unsigned)query->method >= METHOD_COUNT)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->method, "query.method is %d",
                         (int)query->method);
    if (!isfinite(query->tolerance))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)query->tolerance, "query.tolerance is %g",
                         (double)query->tolerance);
    if (query->tolerance < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->tolerance, "query.tolerance is %g, less than 0",
                         (double)query->tolerance);
    const narc_status status =
        narc_check_batch(batch, 0, batch->pairs ? batch->pairs->count : 0, threads, &table, error);
    if (status != NARC_OK)
        return status;
    if (query->method == NARC_METHOD_POLYGON_SAT && check_polygons(batch, error) != NARC_OK)
        return NARC_ERROR_ARGUMENT;
    const unsigned iterations = query->iterations;
    batch->hints = query->hints;
    batch->outcomes = query->out_outcomes;
    batch->tolerance = query->tolerance > 0 ? query->tolerance : NARC_DEFAULT_TOLERANCE;
    batch->iterations = iterations > 0 && iterations < NARC_MAX_ITERATIONS ? (int)iterations : NARC_MAX_ITERATIONS;
    *out_kernels = kernels_of(table, query->method);
    return NARC_OK;
}

narc_status narc_query_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query, unsigned threads, uint64_t *out_bits, narc_error *error) {
    narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    struct kernels kernels = {NULL, NULL};
    const narc_status status = check_query(&batch, query, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (pairs->count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    if (query->out_skipped)
        *query->out_skipped = 0;
    batch.skipped = query->out_skipped;
    narc_run_overlaps(kernels.overlap, &batch, threads, out_bits);
    return NARC_OK;
}

narc_status narc_query_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query, float margin, unsigned threads,
                                const narc_contacts *out_contacts, size_t *out_count, narc_error *error) {
    narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    struct kernels kernels = {NULL, NULL};
    narc_status status = check_query(&batch, query, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (!kernels.contact)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->method, "%s answers overlaps only",
                         narc_method_name(query->method));
    size_t skipped = 0;
    batch.skipped = query->out_skipped ? &skipped : NULL;
    status =
        narc_list_contacts(kernels.contact, &batch, 0, pairs->count, margin, threads, out_contacts, out_count, error);
    if (query->out_skipped && (status == NARC_OK || status == NARC_ERROR_CAPACITY))
        *query->out_skipped = skipped;
    return status;
}
