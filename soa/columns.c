/* SPDX-License-Identifier: MIT
 *
 * columns.c - are the columns of a caller's bodies there?
 */
#include "column.h"
#include "error.h"

narc_status narc_check_positions(const char *name, narc_position_column x, narc_position_column y, narc_error *error) {
    if (!x.base || !y.base)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s.%c is NULL", name, x.base ? 'y' : 'x');
    if ((x.precision != NARC_FLOAT32 && x.precision != NARC_FLOAT64) || x.precision != y.precision)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)x.precision,
                         "%s.x.precision is %d and %s.y.precision is %d", name, (int)x.precision, name,
                         (int)y.precision);
    return NARC_OK;
}

narc_status narc_check_columns(const narc_bodies *bodies, narc_error *error) {
    const struct {
        const char *name;
        const void *base;
    } columns[] = {{"cosine", bodies->cosine.base}, {"sine", bodies->sine.base}, {"shape", bodies->shape.base}};
    const narc_status status = narc_check_positions("bodies", bodies->x, bodies->y, error);
    for (size_t k = 0; status == NARC_OK && k < sizeof columns / sizeof columns[0]; k++)
        if (!columns[k].base)
            return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "bodies.%s is NULL", columns[k].name);
    return status;
}
