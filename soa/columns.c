/* SPDX-License-Identifier: MIT
 *
 * columns.c - are the columns of a caller's bodies there?
 */
#include "column.h"
#include "error.h"

narc_status narc_check_columns(const narc_bodies *bodies, narc_error *error) {
    const struct {
        const char *name;
        const void *base;
    } columns[] = {{"x", bodies->x.base},
                   {"y", bodies->y.base},
                   {"cosine", bodies->cosine.base},
                   {"sine", bodies->sine.base},
                   {"shape", bodies->shape.base}};
    for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
        if (!columns[k].base)
            return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "bodies.%s is NULL", columns[k].name);
    const narc_precision x = bodies->x.precision, y = bodies->y.precision;
    if ((x != NARC_FLOAT32 && x != NARC_FLOAT64) || x != y)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)x,
                         "bodies.x.precision is %d and bodies.y.precision is %d", (int)x, (int)y);
    return NARC_OK;
}
