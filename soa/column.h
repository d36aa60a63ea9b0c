/* SPDX-License-Identifier: MIT
 *
 * column.h - a caller's columns. Internal.
 */
#ifndef NARC_COLUMN_H
#define NARC_COLUMN_H

#include "narc_shapes.h"

static inline const void *narc_at(narc_column column, size_t index) {
    return (const char *)column.base + index * column.stride;
}

static inline float narc_float_at(narc_column column, size_t index) { return *(const float *)narc_at(column, index); }

static inline double narc_double_at(narc_column column, size_t index) {
    return *(const double *)narc_at(column, index);
}

static inline uint32_t narc_index_at(narc_column column, size_t index) {
    return *(const uint32_t *)narc_at(column, index);
}

/* Has a body all columns that it must have, and are positions of a known type? */
narc_status narc_check_columns(const narc_bodies *bodies, narc_error *error);

#endif
