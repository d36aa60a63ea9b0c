/* SPDX-License-Identifier: MIT
 *
 * query.c - the calls of narc_methods.h: which kernel a method means, its settings, and their checks.
 */
#include "column.h"
#include "copy.h"
#include "dispatch.h"
#include "error.h"

#include <math.h>
#include <string.h>

/* Each method's kernels in the table of an instruction set; the exact one's are narc's. */
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

static struct kernels kernels_of(const narc_method_table *table, narc_method method) {
    const struct kernels all[METHOD_COUNT] = {
        [NARC_METHOD_SAT_FIRST] = {table->overlap_first, table->contact_first},
        [NARC_METHOD_POLYGON_SAT] = {table->overlap_polygon, table->contact_polygon},
        [NARC_METHOD_GJK] = {table->overlap_gjk, table->contact_gjk},
        [NARC_METHOD_CIRCLE] = {table->overlap_circle, NULL},
        [NARC_METHOD_AABB] = {table->overlap_aabb, NULL},
        [NARC_METHOD_OBB] = {table->overlap_obb, NULL},
    };
    return all[method];
}

const char *narc_method_name(narc_method method) {
    return (unsigned)method < METHOD_COUNT ? method_names[method] : NULL;
}

/* The table of the instruction set that narc uses. */
static const narc_method_table *find_table(narc_status *out_status, narc_error *error) {
    static const struct {
        const char *name;
        const narc_method_table *table;
    } tables[] = {
#define NARC_ISA(name, needs, processors, flags) {#name, NARC_ISA_TABLE(NARC_BUILT_##name, narc_method_kernels_##name)},
#include "isa.def"
    };
    const char *isa = narc_get_isa();
    for (size_t k = 0; isa && k < sizeof tables / sizeof *tables; k++)
        if (tables[k].table && strcmp(tables[k].name, isa) == 0)
            return tables[k].table;
    if (isa)
        *out_status =
            narc_fail(error, NARC_ERROR_ISA_UNSUPPORTED, 0, 0, "narc uses '%s', which narc_methods does not have", isa);
    else
        *out_status = narc_compute_poses(NULL, 0, NULL, NULL, error); /* says what is wrong with NARC_ISA */
    return NULL;
}

/* Are all shapes of all pairs polygons? */
static narc_status check_polygons(const narc_methods *methods, const narc_batch *batch, narc_error *error) {
    if (methods->all_polygons)
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

static narc_status check_query(const narc_methods *methods, const narc_method_query *query, narc_error *error) {
    if (!methods || !query)
        return narc_fail_missing(error, !methods ? "methods" : "query");
    if (methods->change_count != methods->store->change_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0,
                         "shapes of the store were added, replaced or removed since narc_refresh_methods()");
    if ((unsigned)query->method >= METHOD_COUNT)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->method, "query.method is %d",
                         (int)query->method);
    if (!isfinite(query->tolerance))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)query->tolerance, "query.tolerance is %g",
                         (double)query->tolerance);
    if (query->tolerance < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->tolerance, "query.tolerance is %g, less than 0",
                         (double)query->tolerance);
    return NARC_OK;
}

/* Checks all but the outputs, and fills a call. The batch's shapes must be the call's. */
static narc_status begin_call(const narc_methods *methods, const narc_batch *batch, const narc_method_query *query,
                              unsigned threads, narc_method_call *out_call, narc_error *error) {
    out_call->shapes = methods->shapes;
    narc_status status = narc_check_pairs(batch, 0, batch->pairs ? batch->pairs->count : 0, threads, error);
    if (status != NARC_OK)
        return status;
    const narc_method_table *table = find_table(&status, error);
    if (!table)
        return status;
    if (query->method == NARC_METHOD_POLYGON_SAT && check_polygons(methods, batch, error) != NARC_OK)
        return NARC_ERROR_ARGUMENT;
    const struct kernels kernels = kernels_of(table, query->method);
    const unsigned iterations = query->iterations;
    out_call->overlap = kernels.overlap;
    out_call->contact = kernels.contact;
    out_call->outcomes = query->out_outcomes;
    out_call->tolerance = query->tolerance > 0 ? query->tolerance : NARC_DEFAULT_TOLERANCE;
    out_call->iterations = iterations > 0 && iterations < NARC_MAX_ITERATIONS ? (int)iterations : NARC_MAX_ITERATIONS;
    return NARC_OK;
}

/* Kernels write only the outcomes of pairs that did not end well. */
static void clear_outcomes(uint8_t *outcomes, size_t first, size_t count) {
    if (outcomes && count > 0)              /* memset() wants a pointer even for nothing */
        memset(outcomes + first, 0, count); /* NARC_OUTCOME_DONE */
}

static void run_overlaps(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    clear_outcomes(narc_call_of(batch)->outcomes, first, count);
    narc_call_of(batch)->overlap(batch, first, count, out_bits);
}

static size_t run_contacts(const narc_batch *batch, size_t first, size_t count, float margin,
                           const narc_contacts *out) {
    clear_outcomes(narc_call_of(batch)->outcomes, first, count);
    return narc_call_of(batch)->contact(batch, first, count, margin, out);
}

narc_status narc_find_overlaps_by(const narc_methods *methods, const narc_bodies *bodies, const narc_pairs *pairs,
                                  const narc_method_query *query, unsigned threads, uint64_t *out_bits,
                                  narc_error *error) {
    narc_status status = check_query(methods, query, error);
    if (status != NARC_OK)
        return status;
    if (query->method == NARC_METHOD_SAT) {
        const narc_query exact = {.out_skipped = query->out_skipped};
        status = narc_query_overlaps(methods->store, bodies, pairs, &exact, threads, out_bits, error);
        if (status == NARC_OK)
            clear_outcomes(query->out_outcomes, 0, pairs->count);
        return status;
    }
    narc_method_call call;
    narc_batch batch = {.shapes = &call.shapes, .bodies = bodies, .pairs = pairs, .hints = query->hints};
    status = begin_call(methods, &batch, query, threads, &call, error);
    if (status != NARC_OK)
        return status;
    if (pairs->count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    if (query->out_skipped)
        *query->out_skipped = 0;
    batch.skipped = query->out_skipped;
    narc_run_overlaps(run_overlaps, &batch, threads, out_bits);
    return NARC_OK;
}

narc_status narc_find_contacts_by(const narc_methods *methods, const narc_bodies *bodies, const narc_pairs *pairs,
                                  const narc_method_query *query, float margin, unsigned threads,
                                  const narc_contacts *out_contacts, size_t *out_count, narc_error *error) {
    narc_status status = check_query(methods, query, error);
    if (status != NARC_OK)
        return status;
    if (query->method == NARC_METHOD_SAT) {
        const narc_query exact = {.hints = query->hints, .out_skipped = query->out_skipped};
        status =
            narc_query_contacts(methods->store, bodies, pairs, &exact, margin, threads, out_contacts, out_count, error);
        if (status == NARC_OK || status == NARC_ERROR_CAPACITY)
            clear_outcomes(query->out_outcomes, 0, pairs->count);
        return status;
    }
    narc_method_call call;
    size_t skipped = 0;
    const narc_batch batch = {.shapes = &call.shapes,
                              .bodies = bodies,
                              .pairs = pairs,
                              .hints = query->hints,
                              .skipped = query->out_skipped ? &skipped : NULL};
    status = begin_call(methods, &batch, query, threads, &call, error);
    if (status != NARC_OK)
        return status;
    if (!call.contact)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)query->method, "%s answers overlaps only",
                         narc_method_name(query->method));
    status = narc_list_contacts(run_contacts, &batch, 0, pairs->count, margin, threads, out_contacts, out_count, error);
    if (query->out_skipped && (status == NARC_OK || status == NARC_ERROR_CAPACITY))
        *query->out_skipped = skipped;
    return status;
}
