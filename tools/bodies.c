/* SPDX-License-Identifier: MIT
 *
 * bodies.c - reads the bodies and pairs files.
 */
#include "bodies.h"

#include <math.h>
#include <stdlib.h>

#include "fail.h"
#include "narc.h"
#include "table.h"
#include "text.h"
#include "turn.h"

enum { SHAPE, X, Y, ANGLE, SCALE, BODY_COLUMNS };
static const char *const body_columns[BODY_COLUMNS] = {"shape", "x", "y", "angle", "scale"};

/* The scale of the current row. The kernels ignore a body that is too small or too large; a file must not have one. */
static float read_scale(table *rows, double bound) {
    const double scale = row_number(rows, SCALE);
    const double size = scale * bound;
    if (!(scale > 0))
        fail_field(rows, SCALE, "must be more than 0");
    if (!(size >= NARC_MIN_SIZE && size <= NARC_MAX_SIZE)) {
        fail_field(rows, SCALE, "makes the body's radius %.9g, outside %.9g to %.9g,", size, NARC_MIN_SIZE,
                   NARC_MAX_SIZE);
    }
    return (float)scale;
}

/* Turns angles into cosines and sines. They were reduced to half a turn either way in double precision, so that large
 * angles lose nothing more when they are rounded to single. */
static void compute_poses(body_list *bodies, float *angles) {
    float *sines = allocate(bodies->count, sizeof *sines);
    narc_error error;
    if (narc_compute_poses(angles, bodies->count, angles, sines, &error) != NARC_OK)
        fail("%s", error.message);
    for (size_t i = 0; i < bodies->count; i++) {
        bodies->items[i].cosine = angles[i];
        bodies->items[i].sine = sines[i];
    }
    free(sines);
}

/* The place of the shape that `text` names: by its name, otherwise by its index; shapes->count if there is none. */
static size_t find_shape(const narc_shape_list *shapes, const char *text) {
    const size_t found = narc_find_named_shape(shapes, text);
    uint64_t index;
    return found == shapes->count && parse_whole(text, shapes->count - 1, &index) ? (size_t)index : found;
}

/* The radius of the smallest circle around each shape. */
static double *measure_bounds(const narc_shape_list *shapes) {
    double *bounds = allocate(shapes->count, sizeof *bounds);
    for (size_t k = 0; k < shapes->count; k++) {
        narc_circle bound;
        narc_compute_bounding_circle(shapes->items[k].arcs, shapes->items[k].arc_count, &bound);
        bounds[k] = bound.radius;
    }
    return bounds;
}

void read_bodies(const char *path, const narc_shape_list *shapes, body_list *out_bodies) {
    table rows;
    open_table(&rows, path, body_columns, BODY_COLUMNS, SCALE);
    const bool scaled = has_column(&rows, SCALE);
    double *bounds = measure_bounds(shapes);
    body_list bodies = {0};
    bodies.items = grow(NULL, &bodies.capacity, 0, sizeof *bodies.items);
    size_t angle_capacity = 0;
    float *angles = grow(NULL, &angle_capacity, 0, sizeof *angles);
    while (next_row(&rows, "reading bodies")) {
        if (bodies.count == UINT32_MAX)
            fail_at(path, rows.csv.line, "more than %u bodies", UINT32_MAX);
        bodies.items = grow(bodies.items, &bodies.capacity, bodies.count + 1, sizeof *bodies.items);
        angles = grow(angles, &angle_capacity, bodies.count + 1, sizeof *angles);
        const size_t found = find_shape(shapes, row_field(&rows, SHAPE));
        if (found == shapes->count)
            fail_field(&rows, SHAPE, "is no name or index of a shape (there are %zu)", shapes->count);
        angles[bodies.count] = (float)remainder(row_number(&rows, ANGLE), FULL_TURN);
        bodies.items[bodies.count++] = (body){.x = row_number(&rows, X),
                                              .y = row_number(&rows, Y),
                                              .scale = scaled ? read_scale(&rows, bounds[found]) : 1.0f,
                                              .shape = shapes->items[found].index,
                                              .item = (uint32_t)found};
    }
    compute_poses(&bodies, angles);
    free(angles);
    free(bounds);
    close_table(&rows);
    *out_bodies = bodies;
}

static uint32_t read_index(const table *rows, size_t column, size_t body_count) {
    uint64_t index;
    if (!parse_whole(row_field(rows, column), UINT64_MAX, &index))
        fail_field(rows, column, "is not a whole number");
    if (index >= body_count)
        fail_field(rows, column, "is out of range, there are %zu bodies", body_count);
    return (uint32_t)index;
}

void read_pairs(const char *path, size_t body_count, pair_list *out_pairs) {
    static const char *const names[] = {"a", "b"};
    table rows;
    open_table(&rows, path, names, 2, 2);
    pair_list pairs = {0};
    pairs.items = grow(NULL, &pairs.capacity, 0, sizeof *pairs.items);
    while (next_row(&rows, "reading pairs")) {
        if (pairs.count == UINT32_MAX)
            fail_at(path, rows.csv.line, "more than %u pairs", UINT32_MAX);
        pairs.items = grow(pairs.items, &pairs.capacity, pairs.count + 1, sizeof *pairs.items);
        pairs.items[pairs.count++] = (pair){read_index(&rows, 0, body_count), read_index(&rows, 1, body_count)};
    }
    close_table(&rows);
    *out_pairs = pairs;
}

/* Rounded outwards: the kernels subtract positions exactly, a box must not lose a pair to rounding. */
narc_aabb *bound_bodies(const narc_shapes *store, const body_list *bodies) {
    narc_aabb *boxes = allocate(bodies->count, sizeof *boxes);
    for (size_t i = 0; i < bodies->count; i++) {
        const body *at = &bodies->items[i];
        narc_aabb box;
        narc_get_aabb(store, at->shape, at->cosine, at->sine, at->scale, &box);
        boxes[i] = (narc_aabb){nextafter(at->x + box.min_x, -INFINITY), nextafter(at->y + box.min_y, -INFINITY),
                               nextafter(at->x + box.max_x, INFINITY), nextafter(at->y + box.max_y, INFINITY)};
    }
    return boxes;
}

narc_bodies view_bodies(const body_list *bodies) {
    const body *items = bodies->items;
    return (narc_bodies){.count = bodies->count,
                         .x = NARC_POSITION_COLUMN(items, x),
                         .y = NARC_POSITION_COLUMN(items, y),
                         .cosine = NARC_COLUMN(items, cosine),
                         .sine = NARC_COLUMN(items, sine),
                         .scale = NARC_COLUMN(items, scale),
                         .shape = NARC_COLUMN(items, shape)};
}

narc_pairs view_pairs(const pair_list *pairs) {
    const pair *items = pairs->items;
    return (narc_pairs){.count = pairs->count, .a = NARC_COLUMN(items, a), .b = NARC_COLUMN(items, b)};
}
