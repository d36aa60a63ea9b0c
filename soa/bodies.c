/* SPDX-License-Identifier: MIT
 *
 * bodies.c - rows of bodies; are a caller's bodies what the kernels take them for?
 */
#include <math.h>

#include "broken.h"
#include "column.h"
#include "elementary.h"
#include "error.h"

static narc_status check_body(const narc_shapes *shapes, const narc_bodies *bodies, size_t body, narc_error *error) {
    const uint32_t shape = narc_index_at(bodies->shape, body);
    const double x = narc_position_at(bodies->x, body), y = narc_position_at(bodies->y, body);
    const float cosine = narc_float_at(bodies->cosine, body), sine = narc_float_at(bodies->sine, body);
    const float scale = bodies->scale.base ? narc_float_at(bodies->scale, body) : 1.0f;
    const double c = (double)cosine, s = (double)sine;
    if (shape >= shapes->count)
        return narc_fail(error, NARC_ERROR_INDEX, body, shape, "body %zu: shape is %lu, but there are %zu shapes", body,
                         (unsigned long)shape, shapes->count);
    if (!narc_has_shape(shapes, shape))
        return narc_fail(error, NARC_ERROR_INDEX, body, shape, "body %zu: shape %lu was removed", body,
                         (unsigned long)shape);
    if (!isfinite(x) || !isfinite(y))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, body, isfinite(x) ? y : x, "body %zu: %s is %g", body,
                         isfinite(x) ? "y" : "x", isfinite(x) ? y : x);
    if (!isfinite(c) || !isfinite(s))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, body, isfinite(c) ? s : c, "body %zu: %s is %g", body,
                         isfinite(c) ? "sine" : "cosine", isfinite(c) ? s : c);
    if (!narc_is_rotation(cosine, sine))
        return narc_fail(error, NARC_ERROR_ARGUMENT, body, narc_hypot(c, s),
                         "body %zu: cosine and sine make a vector of length %.9g, not 1", body, narc_hypot(c, s));
    const float size = scale * shapes->headers[shape].bound_radius;
    if (!narc_is_size(size))
        return narc_fail(error, NARC_ERROR_SIZE, body, (double)scale,
                         "body %zu: scale is %.9g, its bounding radius is then %.9g, not in %g .. %g", body,
                         (double)scale, (double)size, NARC_MIN_SIZE, NARC_MAX_SIZE);
    return NARC_OK;
}

narc_status narc_validate_bodies(const narc_shapes *shapes, const narc_bodies *bodies, narc_error *error) {
    if (!shapes || !bodies)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", shapes ? "bodies" : "shapes");
    if (bodies->count == 0)
        return NARC_OK;
    narc_status status = narc_check_columns(bodies, error);
    for (size_t body = 0; body < bodies->count && status == NARC_OK; body++)
        status = check_body(shapes, bodies, body, error);
    return status;
}

void narc_view_bodies(const narc_body *rows, size_t count, narc_bodies *out_bodies) {
    if (out_bodies)
        *out_bodies = rows ? (narc_bodies){.count = count,
                                           .x = NARC_POSITION_COLUMN(rows, x),
                                           .y = NARC_POSITION_COLUMN(rows, y),
                                           .cosine = NARC_COLUMN(rows, cosine),
                                           .sine = NARC_COLUMN(rows, sine),
                                           .scale = NARC_COLUMN(rows, scale),
                                           .shape = NARC_COLUMN(rows, shape)}
                           : (narc_bodies){0};
}

/* ------------------------------------------------------------------------------------------------ pairs */

narc_status narc_copy_pairs(const narc_pairs *pairs, const uint32_t *selection, size_t count, uint32_t *out_a,
                            uint32_t *out_b, ptrdiff_t stride, narc_error *error) {
    if (!pairs)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "pairs is NULL");
    if (stride % 4 != 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)stride, "stride is %td, no multiple of 4", stride);
    if (!selection && count > pairs->count)
        return narc_fail(error, NARC_ERROR_INDEX, count, (double)count, "%zu pairs to copy, but there are %zu", count,
                         pairs->count);
    if (count == 0)
        return NARC_OK;
    if (!pairs->a.base || !pairs->b.base || !out_a)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !pairs->a.base   ? "pairs.a"
                         : !pairs->b.base ? "pairs.b"
                                          : "out_a");
    for (size_t k = 0; selection && k < count; k++)
        if (selection[k] >= pairs->count)
            return narc_fail(error, NARC_ERROR_INDEX, k, selection[k], "item %zu: pair %lu, but there are %zu pairs", k,
                             (unsigned long)selection[k], pairs->count);
    const ptrdiff_t step = stride ? stride / 4 : 1;
    for (size_t k = 0; k < count; k++) {
        const size_t pair = selection ? selection[k] : k;
        out_a[(ptrdiff_t)k * step] = narc_index_at(pairs->a, pair);
        if (out_b)
            out_b[(ptrdiff_t)k * step] = narc_index_at(pairs->b, pair);
    }
    return NARC_OK;
}
