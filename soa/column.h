/* SPDX-License-Identifier: MIT
 *
 * column.h - a caller's columns. Internal.
 */
#ifndef NARC_COLUMN_H
#define NARC_COLUMN_H

#include "narc_pairs.h"

static inline const void *narc_at(const void *base, ptrdiff_t stride, size_t index) {
    return (const char *)base + (ptrdiff_t)index * stride;
}

static inline float narc_float_at(narc_float_column column, size_t index) {
    return *(const float *)narc_at(column.base, column.stride, index);
}

/* Of a column that may be left out. */
static inline float narc_float_or(narc_float_column column, size_t index, float none) {
    return column.base ? narc_float_at(column, index) : none;
}

static inline uint32_t narc_index_at(narc_index_column column, size_t index) {
    return *(const uint32_t *)narc_at(column.base, column.stride, index);
}

static inline uint64_t narc_word_at(narc_word_column column, size_t index) {
    return *(const uint64_t *)narc_at(column.base, column.stride, index);
}

static inline uint8_t narc_byte_at(narc_byte_column column, size_t index) {
    return *(const uint8_t *)narc_at(column.base, column.stride, index);
}

static inline float narc_single_at(narc_position_column column, size_t index) {
    return *(const float *)narc_at(column.base, column.stride, index);
}

static inline double narc_double_at(narc_position_column column, size_t index) {
    return *(const double *)narc_at(column.base, column.stride, index);
}

static inline double narc_position_at(narc_position_column column, size_t index) {
    return column.precision == NARC_FLOAT64 ? narc_double_at(column, index) : (double)narc_single_at(column, index);
}

/* Are both columns of the positions of `name` there, and of one known type? */
narc_status narc_check_positions(const char *name, narc_position_column x, narc_position_column y, narc_error *error);

/* Has a body all columns that it must have, and are positions of a known type? */
narc_status narc_check_columns(const narc_bodies *bodies, narc_error *error);

#endif
