/* SPDX-License-Identifier: MIT
 *
 * store.c - the growing list of shapes: validates, rounds to single precision, lays out, and tells what it holds.
 */
#include "store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline.h"

/* Block indices are 32-bit, and half of that keeps every sum of one with an offset in range. */
#define MAX_FLOATS ((size_t)1 << 31)

/* How far outside, relative to the size, an arc's centre may be found and still count as inside: a few dozen
 * roundings of the largest coordinate that validation lets through, NARC_MAX_RADIUS_RATIO times the size. */
#define CENTER_SLACK 1e-12

/* ------------------------------------------------------------------------------------------------ memory */

static void *allocate_default(size_t size, void *context) {
    (void)context;
    return malloc(size);
}

static void release_default(void *memory, void *context) {
    (void)context;
    free(memory);
}

static void release(const narc_shapes *shapes, void *memory) {
    if (memory)
        shapes->allocator.release(memory, shapes->allocator.context);
}

narc_status narc_create_shapes(const narc_allocator *allocator, narc_shapes **out_shapes) {
    narc_allocator chosen = allocator ? *allocator : (narc_allocator){allocate_default, release_default, NULL};
    if (!out_shapes || !chosen.allocate || !chosen.release)
        return NARC_ERROR_ARGUMENT;
    narc_shapes *shapes = chosen.allocate(sizeof *shapes, chosen.context);
    if (!shapes)
        return NARC_ERROR_MEMORY;
    *shapes = (narc_shapes){.allocator = chosen};
    *out_shapes = shapes;
    return NARC_OK;
}

void narc_destroy_shapes(narc_shapes *shapes) {
    if (!shapes)
        return;
    narc_allocator allocator = shapes->allocator;
    release(shapes, shapes->heads);
    release(shapes, shapes->arcs_memory);
    allocator.release(shapes, allocator.context);
}

/* Room for `needed` items where there is room for `capacity`: twice as much, so that adding copies little. */
static size_t choose_capacity(size_t capacity, size_t needed, size_t smallest, size_t limit) {
    size_t chosen = capacity < limit / 2 ? 2 * capacity : limit;
    if (chosen < smallest)
        chosen = smallest;
    return chosen < needed ? needed : chosen;
}

static bool grow_heads(narc_shapes *shapes, size_t capacity) {
    if (capacity > SIZE_MAX / sizeof(narc_head))
        return false;
    narc_head *heads = shapes->allocator.allocate(capacity * sizeof *heads, shapes->allocator.context);
    if (!heads)
        return false;
    if (shapes->count)
        memcpy(heads, shapes->heads, shapes->count * sizeof *heads);
    release(shapes, shapes->heads);
    shapes->heads = heads;
    shapes->capacity = capacity;
    return true;
}

static bool grow_arcs(narc_shapes *shapes, size_t capacity) {
    if (capacity > (SIZE_MAX - NARC_BLOCK_ALIGNMENT) / sizeof(float))
        return false;
    size_t size = capacity * sizeof(float) + NARC_BLOCK_ALIGNMENT;
    char *memory = shapes->allocator.allocate(size, shapes->allocator.context);
    if (!memory)
        return false;
    float *arcs = (float *)(void *)(memory + (NARC_BLOCK_ALIGNMENT - (uintptr_t)memory % NARC_BLOCK_ALIGNMENT));
    if (shapes->float_count)
        memcpy(arcs, shapes->arcs, shapes->float_count * sizeof *arcs);
    release(shapes, shapes->arcs_memory);
    shapes->arcs_memory = memory;
    shapes->arcs = arcs;
    shapes->float_capacity = capacity;
    return true;
}

/* Room for so many heads and floats in all. If the second allocation fails the first stays, unseen and unused. */
static narc_status make_room(narc_shapes *shapes, size_t heads, size_t floats) {
    if (heads > NARC_MAX_SHAPES || floats > MAX_FLOATS)
        return NARC_ERROR_COUNT;
    if (heads > shapes->capacity && !grow_heads(shapes, choose_capacity(shapes->capacity, heads, 16, NARC_MAX_SHAPES)))
        return NARC_ERROR_MEMORY;
    if (floats > shapes->float_capacity &&
        !grow_arcs(shapes, choose_capacity(shapes->float_capacity, floats, 512, MAX_FLOATS)))
        return NARC_ERROR_MEMORY;
    return NARC_OK;
}

/* Floats in a plane, and floats in a block with what it takes to begin the next one aligned. */
static size_t find_stride(size_t count) {
    return (count + NARC_STRIDE_MULTIPLE - 1) / NARC_STRIDE_MULTIPLE * NARC_STRIDE_MULTIPLE;
}

static size_t find_block_size(size_t count) {
    size_t multiple = NARC_BLOCK_ALIGNMENT / sizeof(float);
    return (NARC_PLANES * find_stride(count) + multiple - 1) / multiple * multiple;
}

narc_status narc_reserve_shapes(narc_shapes *shapes, size_t shape_count, size_t arc_count) {
    if (!shapes)
        return NARC_ERROR_ARGUMENT;
    if (shape_count > NARC_MAX_SHAPES || arc_count > MAX_FLOATS / NARC_PLANES)
        return NARC_ERROR_COUNT;
    /* A block has 5 floats an arc, and a shape wastes most with one arc (a circle): 24 - 5 floats. */
    return make_room(shapes, shapes->count + shape_count,
                     shapes->float_count + NARC_PLANES * arc_count + (find_block_size(1) - NARC_PLANES) * shape_count);
}

/* ------------------------------------------------------------------------------------------------ adding */

static float round_up(double value) {
    float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

static float round_down(double value) {
    float rounded = (float)value;
    return (double)rounded > value ? nextafterf(rounded, -INFINITY) : rounded;
}

static uint16_t find_flags(const narc_outline *o, size_t count, double size) {
    bool smooth = true, polygon = true, inside = true;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        smooth = smooth && hypot(to.x - from.x, to.y - from.y) <= NARC_TOLERANCE * size;
        polygon = polygon && o->radius[i] == 0;
        inside = inside &&
                 (o->radius[i] == 0 || narc_find_gap(o, o->center_x[i], o->center_y[i], NULL) <= CENTER_SLACK * size);
    }
    return (uint16_t)((smooth ? NARC_SHAPE_SMOOTH : 0) | (count == 1 ? NARC_SHAPE_CIRCLE : 0) |
                      (polygon ? NARC_SHAPE_POLYGON : 0) | (inside ? NARC_SHAPE_CENTERS_INSIDE : 0));
}

static narc_head make_head(const narc_outline *o, size_t count, narc_circle bound, double extent) {
    narc_circle inner;
    narc_inscribe_outline(o, &inner);
    inner.x += o->origin_x;
    inner.y += o->origin_y;
    narc_head head = {.count = (uint8_t)o->count, .stride = (uint8_t)find_stride(o->count)};
    head.flags = find_flags(o, count, bound.radius);
    head.bound_x = (float)bound.x;
    head.bound_y = (float)bound.y;
    double moved = hypot((double)head.bound_x - bound.x, (double)head.bound_y - bound.y);
    head.bound_radius = round_up(bound.radius + moved + NARC_HEAD_SLACK * extent);
    head.inner_x = (float)inner.x;
    head.inner_y = (float)inner.y;
    moved = hypot((double)head.inner_x - inner.x, (double)head.inner_y - inner.y);
    head.inner_radius = round_down(fmax(0, inner.radius - moved - NARC_HEAD_SLACK * extent));
    return head;
}

static void write_block(const narc_outline *o, float *block) {
    size_t stride = find_stride(o->count);
    for (size_t k = 0; k < stride; k++) {
        size_t i = k < o->count ? k : o->count - 1;
        block[k] = (float)(o->center_x[i] + o->origin_x);
        block[stride + k] = (float)(o->center_y[i] + o->origin_y);
        block[2 * stride + k] = (float)o->radius[i];
        block[3 * stride + k] = (float)o->normal_x[i];
        block[4 * stride + k] = (float)o->normal_y[i];
    }
}

narc_status narc_add_shape(narc_shapes *shapes, const narc_arc *arcs, size_t count, uint32_t *out_shape,
                           narc_error *error) {
    narc_outline outline;
    narc_circle bound;
    if (!shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "shapes is NULL");
    narc_status status = narc_check_arcs(arcs, count, &outline, &bound, error);
    if (status != NARC_OK)
        return status;
    size_t block = shapes->float_count, block_size = find_block_size(outline.count);
    status = make_room(shapes, shapes->count + 1, block + block_size);
    if (status == NARC_ERROR_COUNT)
        return narc_fail(error, status, shapes->count, (double)shapes->count, "the store is full, it has %zu shapes",
                         shapes->count);
    if (status != NARC_OK)
        return narc_fail(error, status, shapes->count, 0, "no memory for shape %zu", shapes->count);
    double extent = 0;
    for (size_t i = 0; i < count; i++)
        extent = fmax(extent, hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
    narc_head head = make_head(&outline, count, bound, extent);
    if ((double)head.bound_radius > NARC_HEAD_MAX_RADIUS)
        return narc_fail(error, NARC_ERROR_SIZE, 0, bound.radius,
                         "the shape's bounding radius is %.9g, with room for rounding %.9g, more than %g", bound.radius,
                         (double)head.bound_radius, NARC_MAX_SIZE);
    head.block = (uint32_t)block;
    memset(shapes->arcs + block, 0, block_size * sizeof(float)); /* what is behind the planes is never read */
    write_block(&outline, shapes->arcs + block);
    if (out_shape)
        *out_shape = (uint32_t)shapes->count;
    shapes->heads[shapes->count++] = head;
    shapes->float_count += block_size;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ reading */

size_t narc_count_shapes(const narc_shapes *shapes) { return shapes ? shapes->count : 0; }

unsigned narc_shape_flags(const narc_shapes *shapes, uint32_t shape) {
    return shape < narc_count_shapes(shapes) ? shapes->heads[shape].flags : 0;
}

size_t narc_get_arcs(const narc_shapes *shapes, uint32_t shape, narc_arc *out_arcs) {
    if (shape >= narc_count_shapes(shapes))
        return 0;
    narc_head head = shapes->heads[shape];
    size_t stride = head.stride, count = head.flags & NARC_SHAPE_CIRCLE ? 1 : head.count;
    const float *block = shapes->arcs + head.block;
    for (size_t i = 0; out_arcs && i < count; i++) {
        size_t next = (i + 1) % count;
        double start = atan2((double)block[4 * stride + i], (double)block[3 * stride + i]);
        double end = atan2((double)block[4 * stride + next], (double)block[3 * stride + next]);
        if (end <= start)
            end += 2 * NARC_PI;
        out_arcs[i] =
            (narc_arc){(double)block[i], (double)block[stride + i], (double)block[2 * stride + i], start, end};
    }
    return count;
}

/* The support function of the stored arcs: the furthest of all arc ends, or a point inside the arc that has the
 * direction. */
static double find_stored_height(const float *block, size_t count, size_t stride, double x, double y) {
    double best = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        size_t next = i + 1 < count ? i + 1 : 0;
        double ax = (double)block[3 * stride + i], ay = (double)block[4 * stride + i];
        double bx = (double)block[3 * stride + next], by = (double)block[4 * stride + next];
        double center = (double)block[i] * x + (double)block[stride + i] * y, radius = (double)block[2 * stride + i];
        if (ax * y - ay * x >= 0 && x * by - y * bx >= 0)
            best = fmax(best, center + radius * sqrt(x * x + y * y));
        else
            best = fmax(best, center + radius * fmax(ax * x + ay * y, bx * x + by * y));
    }
    return best;
}

bool narc_get_aabb(const narc_shapes *shapes, uint32_t shape, float cosine, float sine, float scale,
                   narc_aabb *out_aabb) {
    if (!out_aabb || shape >= narc_count_shapes(shapes))
        return false;
    narc_head head = shapes->heads[shape];
    const float *block = shapes->arcs + head.block;
    size_t count = head.count, stride = head.stride;
    double length = hypot((double)cosine, (double)sine), c = (double)cosine / length, s = (double)sine / length;
    double extent = 0;
    if (!(length > 0) || !isfinite(length))
        return false;
    for (size_t i = 0; i < count; i++)
        extent = fmax(extent, fabs((double)block[i]) + fabs((double)block[stride + i]) + (double)block[2 * stride + i]);
    /* The world's x axis is (c, -s) in the shape's axes, its y axis (s, c). */
    double slack = NARC_HEAD_SLACK * extent, factor = (double)scale;
    *out_aabb = (narc_aabb){.min_x = factor * -(find_stored_height(block, count, stride, -c, s) + slack),
                            .min_y = factor * -(find_stored_height(block, count, stride, -s, -c) + slack),
                            .max_x = factor * (find_stored_height(block, count, stride, c, -s) + slack),
                            .max_y = factor * (find_stored_height(block, count, stride, s, c) + slack)};
    return true;
}
