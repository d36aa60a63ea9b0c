/* SPDX-License-Identifier: MIT
 *
 * layouts.c - the same bodies and pairs in the layouts that callers have.
 */
#include "layouts.h"

#include <string.h>

#include "guard.h"

struct structure {
    float x, y, cosine, sine, scale;
    uint32_t shape;
};

struct double_structure {
    double x, y;
    float cosine, sine, scale;
    uint32_t shape;
};

struct reversed {
    uint32_t shape;
    float scale, sine, cosine, y, x;
};

struct double_reversed {
    uint32_t shape;
    float scale, sine, cosine;
    double y, x;
};

struct reversed_pair {
    uint32_t user[1], b, a;
};

static void *add_memory(struct columns *columns, size_t size) {
    void *memory = guard_allocate(size);
    columns->memory[columns->memory_count++] = memory;
    return memory;
}

/* A packed array of `count` values of `type`, the member of each of the items. */
#define PACK(columns, type, items, count, member, column, make)                                                        \
    do {                                                                                                               \
        type *packed = add_memory(columns, (count) * sizeof(type));                                                    \
        for (size_t pack_k = 0; pack_k < (count); pack_k++)                                                            \
            packed[pack_k] = (items)[pack_k].member;                                                                   \
        (column) = make(packed);                                                                                       \
    } while (0)

/* An array of structures of `type`, positions from the members x_from and y_from. */
#define STRUCTURES(columns, type, items, count, x_from, y_from)                                                        \
    do {                                                                                                               \
        type *array = add_memory(columns, (count) * sizeof(type));                                                     \
        for (size_t k = 0; k < (count); k++)                                                                           \
            array[k] = (type){.x = (items)[k].x_from,                                                                  \
                              .y = (items)[k].y_from,                                                                  \
                              .cosine = (items)[k].cosine,                                                             \
                              .sine = (items)[k].sine,                                                                 \
                              .scale = (items)[k].scale,                                                               \
                              .shape = (items)[k].shape};                                                              \
        (columns)->bodies.x = NARC_POSITION_COLUMN(array, x);                                                          \
        (columns)->bodies.y = NARC_POSITION_COLUMN(array, y);                                                          \
        (columns)->bodies.cosine = NARC_COLUMN(array, cosine);                                                         \
        (columns)->bodies.sine = NARC_COLUMN(array, sine);                                                             \
        (columns)->bodies.scale = NARC_COLUMN(array, scale);                                                           \
        (columns)->bodies.shape = NARC_COLUMN(array, shape);                                                           \
    } while (0)

static void add_positions(struct columns *columns, const struct scene *scene) {
    const struct body *body = scene->bodies;
    size_t count = scene->body_count;
    if (scene->precision == NARC_FLOAT64) {
        PACK(columns, double, body, count, x, columns->bodies.x, NARC_POSITION_ARRAY);
        PACK(columns, double, body, count, y, columns->bodies.y, NARC_POSITION_ARRAY);
    } else {
        PACK(columns, float, body, count, x_single, columns->bodies.x, NARC_POSITION_ARRAY);
        PACK(columns, float, body, count, y_single, columns->bodies.y, NARC_POSITION_ARRAY);
    }
}

/* Everything but the positions: `count` values each, or one for all with a stride of 0. */
static void add_arrays(struct columns *columns, const struct scene *scene, size_t count) {
    narc_bodies *bodies = &columns->bodies;
    PACK(columns, float, scene->bodies, count, cosine, bodies->cosine, NARC_ARRAY);
    PACK(columns, float, scene->bodies, count, sine, bodies->sine, NARC_ARRAY);
    PACK(columns, float, scene->bodies, count, scale, bodies->scale, NARC_ARRAY);
    PACK(columns, uint32_t, scene->bodies, count, shape, bodies->shape, NARC_ARRAY);
    if (count < scene->body_count)
        bodies->cosine.stride = bodies->sine.stride = bodies->scale.stride = bodies->shape.stride = 0;
}

/* Turns an array of `count` items round, so that the column that begins at its last one has the same items. */
static void *turn_round(const void *base, size_t count, size_t size) {
    char *first = (char *)(uintptr_t)base, item[sizeof(double)];
    for (size_t k = 0; k < count / 2; k++) {
        char *const a = first + k * size, *const b = first + (count - 1 - k) * size;
        memcpy(item, a, size);
        memcpy(a, b, size);
        memcpy(b, item, size);
    }
    return count ? first + (count - 1) * size : first;
}

#define TURN_ROUND(column, count)                                                                                      \
    do {                                                                                                               \
        (column).base = turn_round((column).base, count, (size_t)(column).stride);                                     \
        (column).stride = -(column).stride;                                                                            \
    } while (0)

static void turn_columns(struct columns *columns) {
    narc_bodies *bodies = &columns->bodies;
    TURN_ROUND(bodies->x, bodies->count);
    TURN_ROUND(bodies->y, bodies->count);
    TURN_ROUND(bodies->cosine, bodies->count);
    TURN_ROUND(bodies->sine, bodies->count);
    TURN_ROUND(bodies->scale, bodies->count);
    TURN_ROUND(bodies->shape, bodies->count);
    TURN_ROUND(columns->pairs.a, columns->pairs.count);
    TURN_ROUND(columns->pairs.b, columns->pairs.count);
}

static void add_pairs(struct columns *columns, const struct pair *pairs, size_t count, enum layout layout) {
    columns->pairs.count = count;
    if (layout == LAYOUT_STRUCTURES) {
        struct pair *array = guard_copy(pairs, count * sizeof(*pairs));
        columns->memory[columns->memory_count++] = array;
        columns->pairs.a = NARC_COLUMN(array, a);
        columns->pairs.b = NARC_COLUMN(array, b);
    } else if (layout == LAYOUT_REVERSED) {
        struct reversed_pair *array = add_memory(columns, count * sizeof(*array));
        for (size_t k = 0; k < count; k++) {
            array[k].a = pairs[k].a;
            array[k].b = pairs[k].b;
        }
        columns->pairs.a = NARC_COLUMN(array, a);
        columns->pairs.b = NARC_COLUMN(array, b);
    } else {
        PACK(columns, uint32_t, pairs, count, a, columns->pairs.a, NARC_ARRAY);
        PACK(columns, uint32_t, pairs, count, b, columns->pairs.b, NARC_ARRAY);
    }
}

struct columns create_columns(const struct scene *scene, enum layout layout, size_t first, size_t count) {
    struct columns columns = {.bodies = {.count = scene->body_count}};
    const struct body *body = scene->bodies;
    bool doubles = scene->precision == NARC_FLOAT64;
    switch (layout) {
    case LAYOUT_STRUCTURES:
        if (doubles)
            STRUCTURES(&columns, struct double_structure, body, scene->body_count, x, y);
        else
            STRUCTURES(&columns, struct structure, body, scene->body_count, x_single, y_single);
        break;
    case LAYOUT_REVERSED:
        if (doubles)
            STRUCTURES(&columns, struct double_reversed, body, scene->body_count, x, y);
        else
            STRUCTURES(&columns, struct reversed, body, scene->body_count, x_single, y_single);
        break;
    default:
        add_positions(&columns, scene);
        add_arrays(&columns, scene, layout == LAYOUT_SHARED ? 1 : scene->body_count);
        break;
    }
    if (layout == LAYOUT_UNSCALED)
        columns.bodies.scale.base = NULL;
    add_pairs(&columns, scene->pairs + first, count, layout);
    if (layout == LAYOUT_BACKWARDS)
        turn_columns(&columns);
    return columns;
}

void destroy_columns(struct columns *columns) {
    for (size_t k = 0; k < columns->memory_count; k++)
        guard_release(columns->memory[k]);
}

void suit_layout(struct scene *scene, enum layout layout) {
    for (size_t k = 0; k < scene->body_count; k++) {
        struct body *const body = &scene->bodies[k];
        if (layout == LAYOUT_SHARED) {
            body->cosine = scene->bodies[0].cosine;
            body->sine = scene->bodies[0].sine;
            body->scale = scene->bodies[0].scale;
            body->shape = scene->bodies[0].shape;
        } else if (layout == LAYOUT_UNSCALED) {
            body->scale = 1;
        }
    }
}

narc_shapes *guard_store(const struct scene *scene) {
    narc_shapes *store;
    size_t arcs = 0;
    for (size_t k = 0; k < scene->shape_count; k++)
        arcs += scene->shapes[k].count;
    assert_int_equal(narc_create_shapes(&guard_allocator, &store), NARC_OK);
    assert_int_equal(narc_reserve_shapes(store, scene->shape_count, arcs), NARC_OK);
    for (size_t k = 0; k < scene->shape_count; k++) {
        const struct shape *shape = &scene->shapes[k];
        assert_int_equal(narc_add_shape_at(store, (uint32_t)k, shape->arcs, shape->count, NULL), NARC_OK);
    }
    return store;
}
