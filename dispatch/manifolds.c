/* SPDX-License-Identifier: MIT
 *
 * manifolds.c - narc_find_manifolds(): argument checks, then one call down.
 */
#include "dispatch.h"
#include "elementary.h"
#include "error.h"

#include <math.h>

static size_t find_manifolds(const narc_lister *lister, const narc_batch *batch, size_t first, size_t count,
                             const narc_list *list) {
    void *const *array = list->array;
    narc_manifolds out = {.capacity = list->capacity};
    NARC_MANIFOLD_COLUMNS(NARC_TAKE_ARRAY, &out)
    return lister->manifold(batch, first, count, lister->margin, &out);
}

narc_status narc_read_manifold_options(const narc_manifold_options *options, narc_batch *batch, narc_error *error) {
    const float margin = options->margin, angle = options->flat_angle;
    if (isnan(margin))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)margin, "options.margin is not a number");
    if (isnan(angle))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)angle, "options.flat_angle is not a number");
    if (angle > NARC_MAX_FLAT_ANGLE)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)angle, "options.flat_angle is %g, more than %g",
                         (double)angle, (double)NARC_MAX_FLAT_ANGLE);
    if (isnan(options->second_margin))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)options->second_margin,
                         "options.second_margin is not a number");
    batch->second_margin = options->second_margin == 0 ? -INFINITY : options->second_margin;
    batch->flat_sine = angle < 0 ? -1.0f : (float)narc_sin((double)(angle == 0 ? NARC_FLAT_ANGLE : angle));
    return NARC_OK;
}

static narc_status find(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs, size_t first,
                        size_t count, const narc_manifold_options *options, unsigned threads,
                        const narc_manifolds *out_manifolds, size_t *out_count, narc_error *error) {
    static const narc_manifold_options defaults = {0};
    const narc_manifold_options *o = options ? options : &defaults;
    size_t skipped = 0;
    narc_batch batch = {.shapes = shapes,
                        .bodies = bodies,
                        .pairs = pairs,
                        .hints = o->hints,
                        .skipped = o->out_skipped ? &skipped : NULL};
    const narc_kernel_table *kernels = NULL;
    narc_status status = narc_check_batch(&batch, first, count, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (!out_manifolds || !out_count)
        return narc_fail_missing(error, !out_manifolds ? "out_manifolds" : "out_count");
    status = narc_read_manifold_options(o, &batch, error);
    if (status != NARC_OK)
        return status;
    const narc_lister lister = {find_manifolds, NARC_MANIFOLD_CHUNK, o->margin, .manifold = kernels->manifold};
    const narc_list list = {.capacity = out_manifolds->capacity,
                            .columns = NARC_MANIFOLD_COLUMN_COUNT,
                            .item = {NARC_MANIFOLD_COLUMNS(NARC_COLUMN_SIZE, out_manifolds)},
                            .array = {NARC_MANIFOLD_COLUMNS(NARC_COLUMN_ARRAY, out_manifolds)}};
    const size_t found = narc_run_list(&lister, &batch, first, count, threads, &list);
    if (o->out_skipped)
        *o->out_skipped = skipped;
    *out_count = found;
    if (found > out_manifolds->capacity)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)found, "%zu manifolds, but there is room for %zu",
                         found, out_manifolds->capacity);
    return NARC_OK;
}

narc_status narc_find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_manifold_options *options, unsigned threads,
                                const narc_manifolds *out_manifolds, size_t *out_count, narc_error *error) {
    return find(shapes, bodies, pairs, 0, pairs ? pairs->count : 0, options, threads, out_manifolds, out_count, error);
}

narc_status narc_find_manifolds_range(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                      size_t first, size_t count, const narc_manifold_options *options,
                                      const narc_manifolds *out_manifolds, size_t *out_count, narc_error *error) {
    return find(shapes, bodies, pairs, first, count, options, 1, out_manifolds, out_count, error);
}
