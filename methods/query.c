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
    narc_row_kernel *contact; /* NULL: it has none */
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
    for (size_t k = 0; k < batch->count; k++) {
        const size_t pair = narc_pair_at(batch, batch->first + k);
        for (int side = 0; side < 2; side++) {
            const struct narc_side s = narc_find_side(batch, pair, side);
            if (narc_has_shape(batch->shapes, s.shape) && !(batch->shapes->headers[s.shape].flags & NARC_SHAPE_POLYGON))
                return narc_fail(error, NARC_ERROR_ARGUMENT, pair, s.shape,
                                 "pair %zu: polygon-sat needs polygons, but shape %lu of body %zu has arcs", pair,
                                 (unsigned long)s.shape, s.body);
        }
    }
    return NARC_OK;
}

static narc_status check_options(const narc_methods *methods, const narc_method_options *options, narc_error *error) {
    if (!methods || !options)
        return narc_fail_missing(error, methods ? "options" : "methods");
    if (!narc_method_name(options->method))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)options->method, "there is no method %d",
                         (int)options->method);
    if (methods->change_count != methods->store->change_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0,
                         "the store has changed since the last narc_create_methods() or narc_refresh_methods()");
    if (!isfinite(options->tolerance))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)options->tolerance, "options.tolerance is %g",
                         (double)options->tolerance);
    if (options->tolerance < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)options->tolerance,
                         "options.tolerance is %g, less than 0", (double)options->tolerance);
    return narc_check_reserved(options->reserved, sizeof options->reserved / sizeof(void *), "options", error);
}

/* Kernels write only the outcomes of pairs that did not end well. */
static void clear_outcomes(uint8_t *outcomes, const narc_batch *batch, size_t first, size_t count) {
    for (size_t k = 0; k < count && outcomes; k++)
        outcomes[narc_pair_at(batch, first + k)] = NARC_OUTCOME_DONE;
}

/* Checks all but the outputs, and fills a call. The batch's shapes are the call's. */
static narc_status begin_call(const narc_methods *methods, const narc_bodies *bodies, const narc_pairs *pairs,
                              const narc_method_options *options, const narc_query *query, narc_method_call *out_call,
                              narc_batch *out_batch, narc_error *error) {
    narc_status status = check_options(methods, options, error);
    if (status != NARC_OK)
        return status;
    out_call->shapes = methods->shapes;
    status = narc_begin_batch(&out_call->shapes, bodies, pairs, query, out_batch, error);
    if (status != NARC_OK)
        return status;
    const narc_method_table *table = find_table(&status, error);
    if (!table)
        return status;
    if (options->method == NARC_METHOD_POLYGON_SAT && check_polygons(methods, out_batch, error) != NARC_OK)
        return NARC_ERROR_ARGUMENT;
    const struct kernels kernels = kernels_of(table, options->method);
    const unsigned iterations = options->iterations;
    out_call->overlap = kernels.overlap;
    out_call->contact = kernels.contact;
    out_call->outcomes = options->out_outcomes;
    out_call->simplexes = options->simplexes;
    out_call->tolerance = options->tolerance > 0 ? options->tolerance : NARC_DEFAULT_TOLERANCE;
    out_call->iterations = iterations > 0 && iterations < NARC_MAX_ITERATIONS ? (int)iterations : NARC_MAX_ITERATIONS;
    return NARC_OK;
}

static void run_overlaps(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    clear_outcomes(narc_call_of(batch)->outcomes, batch, first, count);
    narc_call_of(batch)->overlap(batch, first, count, skipped, out_bits);
}

static size_t run_contacts(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    clear_outcomes(narc_call_of(batch)->outcomes, batch, first, count);
    return narc_call_of(batch)->contact(batch, first, count, skipped, out);
}

narc_status narc_find_overlaps_by(const narc_methods *methods, const narc_bodies *bodies, const narc_pairs *pairs,
                                  const narc_method_options *options, const narc_query *query, uint64_t *out_bits,
                                  narc_error *error) {
    narc_method_call call;
    narc_batch batch;
    narc_status status = begin_call(methods, bodies, pairs, options, query, &call, &batch, error);
    if (status != NARC_OK)
        return status;
    if (options->method == NARC_METHOD_SAT) {
        status = narc_find_overlaps(methods->store, bodies, pairs, query, out_bits, error);
        if (status == NARC_OK)
            clear_outcomes(options->out_outcomes, &batch, batch.first, batch.count);
        return status;
    }
    return narc_answer_overlaps(run_overlaps, &batch, out_bits, error);
}

narc_status narc_find_contacts_by(const narc_methods *methods, const narc_bodies *bodies, const narc_pairs *pairs,
                                  const narc_method_options *options, const narc_query *query, narc_contact *out_rows,
                                  size_t capacity, size_t *out_count, narc_error *error) {
    narc_method_call call;
    narc_batch batch;
    narc_status status = begin_call(methods, bodies, pairs, options, query, &call, &batch, error);
    if (status != NARC_OK)
        return status;
    if (options->method == NARC_METHOD_SAT) {
        status = narc_find_contacts(methods->store, bodies, pairs, query, out_rows, capacity, out_count, error);
        if (status == NARC_OK || (status == NARC_ERROR_CAPACITY && !batch.query->dense))
            clear_outcomes(options->out_outcomes, &batch, batch.first, batch.count);
        return status;
    }
    if (!call.contact)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)options->method, "%s answers overlaps only",
                         narc_method_name(options->method));
    batch.row_size = sizeof *out_rows;
    return narc_answer_rows(run_contacts, &batch, out_rows, capacity, out_count, error);
}
