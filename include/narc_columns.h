/* SPDX-License-Identifier: MIT
 *
 * narc_columns.h - strided columns in the caller's memory, and how to make them of arrays.
 *
 * A column tells where a property of many things lies: item k is `stride` * k bytes behind `base`. A stride of 0 gives
 * every item the same value, one below 0 goes backwards from the last item in memory. Items must be aligned for their
 * type. A column of no items may have any base.
 *
 *     struct body { float x, y, c, s; uint32_t shape; } body[1000];     (the engine's own)
 *     double px[1000], py[1000];
 *
 *     NARC_COLUMN(body, c)             one field of an array of structures
 *     NARC_ARRAY(angles)               a plain array, or a pointer to its first item
 *     NARC_POSITION_COLUMN(body, x)    the same for positions, which may be float or double
 *     NARC_POSITION_ARRAY(px)
 *
 * These are values: they initialise, are assigned and passed. Their type is that of the items, so that doubles where
 * floats are meant do not compile. With _INIT behind the name they are bare initialisers, for objects of static storage
 * duration, where C wants constants. In C++ the first argument may be a container with data(), an empty one too.
 */
#ifndef NARC_COLUMNS_H
#define NARC_COLUMNS_H

#include <stddef.h>
#include <stdint.h>

/* What a position is made of. Doubles keep their precision in large worlds: positions are subtracted before anything is
 * rounded to single precision. */
typedef enum narc_precision { NARC_FLOAT32 = 0, NARC_FLOAT64 = 1 } narc_precision;

typedef struct narc_float_column {
    const float *base;
    ptrdiff_t stride; /* bytes */
} narc_float_column;

typedef struct narc_index_column {
    const uint32_t *base;
    ptrdiff_t stride;
} narc_index_column;

typedef struct narc_word_column {
    const uint64_t *base;
    ptrdiff_t stride;
} narc_word_column;

typedef struct narc_byte_column {
    const uint8_t *base;
    ptrdiff_t stride;
} narc_byte_column;

typedef struct narc_position_column {
    const void *base;
    ptrdiff_t stride;
    narc_precision precision;
} narc_position_column;

#ifndef __cplusplus

#define NARC_COLUMN(array, field) NARC_TYPED_COLUMN(&(array)[0].field, sizeof((array)[0]))
#define NARC_ARRAY(array)         NARC_TYPED_COLUMN(&(array)[0], sizeof((array)[0]))
#define NARC_POSITION_COLUMN(array, field)                                                                             \
    ((narc_position_column)NARC_POSITIONS_AT(&(array)[0].field, sizeof((array)[0])))
#define NARC_POSITION_ARRAY(array) ((narc_position_column)NARC_POSITIONS_AT(&(array)[0], sizeof((array)[0])))

#define NARC_COLUMN_INIT(array, field)                                                                                 \
    { NARC_TYPED_POINTER(&(array)[0].field), (ptrdiff_t)sizeof((array)[0]) }
#define NARC_ARRAY_INIT(array)                                                                                         \
    { NARC_TYPED_POINTER(&(array)[0]), (ptrdiff_t)sizeof((array)[0]) }
#define NARC_POSITION_COLUMN_INIT(array, field) NARC_POSITIONS_AT(&(array)[0].field, sizeof((array)[0]))
#define NARC_POSITION_ARRAY_INIT(array)         NARC_POSITIONS_AT(&(array)[0], sizeof((array)[0]))

/* What those above are made of. Each type of items has a pointer that may write and one that may not. */
#define NARC_MADE_COLUMN(type, pointer, size) ((type){(const void *)(pointer), (ptrdiff_t)(size)})
/* clang-format off */
#define NARC_TYPED_COLUMN(pointer, size)                                                                               \
    _Generic((pointer),                                                                                                \
             float *: NARC_MADE_COLUMN(narc_float_column, pointer, size),                                              \
             const float *: NARC_MADE_COLUMN(narc_float_column, pointer, size),                                        \
             uint32_t *: NARC_MADE_COLUMN(narc_index_column, pointer, size),                                           \
             const uint32_t *: NARC_MADE_COLUMN(narc_index_column, pointer, size),                                     \
             uint64_t *: NARC_MADE_COLUMN(narc_word_column, pointer, size),                                            \
             const uint64_t *: NARC_MADE_COLUMN(narc_word_column, pointer, size),                                      \
             uint8_t *: NARC_MADE_COLUMN(narc_byte_column, pointer, size),                                             \
             const uint8_t *: NARC_MADE_COLUMN(narc_byte_column, pointer, size),                                       \
             _Bool *: NARC_MADE_COLUMN(narc_byte_column, pointer, size),                                               \
             const _Bool *: NARC_MADE_COLUMN(narc_byte_column, pointer, size))
#define NARC_TYPED_POINTER(pointer)                                                                                    \
    _Generic((pointer), float *: (pointer), const float *: (pointer), uint32_t *: (pointer),                           \
             const uint32_t *: (pointer), uint64_t *: (pointer), const uint64_t *: (pointer), uint8_t *: (pointer),    \
             const uint8_t *: (pointer))
#define NARC_POSITIONS_AT(pointer, size)                                                                               \
    {                                                                                                                  \
        (pointer), (ptrdiff_t)(size),                                                                                  \
            _Generic((pointer), float *: NARC_FLOAT32, const float *: NARC_FLOAT32, double *: NARC_FLOAT64,            \
                     const double *: NARC_FLOAT64)                                                                     \
    }
/* clang-format on */

#else

#define NARC_COLUMN(array, field)          NARC_FIELD(narc::make_column, array, field)
#define NARC_ARRAY(array)                  narc::make_column(narc::data_of(array), sizeof *narc::data_of(array))
#define NARC_POSITION_COLUMN(array, field) NARC_FIELD(narc::make_positions, array, field)
#define NARC_POSITION_ARRAY(array)         narc::make_positions(narc::data_of(array), sizeof *narc::data_of(array))

#define NARC_COLUMN_INIT          NARC_COLUMN
#define NARC_ARRAY_INIT           NARC_ARRAY
#define NARC_POSITION_COLUMN_INIT NARC_POSITION_COLUMN
#define NARC_POSITION_ARRAY_INIT  NARC_POSITION_ARRAY

#define NARC_FIELD(make, array, field)                                                                                 \
    make(narc::data_of(array) ? &narc::data_of(array)->field : nullptr, sizeof *narc::data_of(array))

namespace narc {

template <class Item> constexpr Item *data_of(Item *items) { return items; }

template <class Container> auto data_of(Container &&container) -> decltype(container.data()) {
    return container.data();
}

constexpr narc_float_column make_column(const float *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride)};
}

constexpr narc_index_column make_column(const uint32_t *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride)};
}

constexpr narc_word_column make_column(const uint64_t *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride)};
}

constexpr narc_byte_column make_column(const uint8_t *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride)};
}

inline narc_byte_column make_column(const bool *base, size_t stride) {
    return {reinterpret_cast<const uint8_t *>(base), static_cast<ptrdiff_t>(stride)};
}

constexpr narc_position_column make_positions(const float *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride), NARC_FLOAT32};
}

constexpr narc_position_column make_positions(const double *base, size_t stride) {
    return {base, static_cast<ptrdiff_t>(stride), NARC_FLOAT64};
}

} // namespace narc

#endif

#endif
