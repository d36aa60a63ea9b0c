/* SPDX-License-Identifier: MIT
 *
 * bodies.c - reads the bodies and pairs files.
 */
#include "bodies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "calls.h"
#include "elementary.h"
#include "fail.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "table.h"
#include "text.h"
#include "turn.h"

enum { SHAPE, X, Y, ANGLE, SCALE, BODY_COLUMNS };
static const char *const body_columns[BODY_COLUMNS] = {"shape", "x", "y", "angle", "scale"};

/* The scale of the current row, for this shape. The kernels ignore a body that is too small or too large; a file must not
 * have one. */
static float read_scale(table *rows, const narc_shapes *store, uint32_t shape) {
    const narc_body sized = {.cosine = 1, .scale = (float)row_number(rows, SCALE), .shape = shape};
    narc_bodies one;
    narc_view_bodies(&sized, 1, &one);
    narc_error error;
    if (!(row_number(rows, SCALE) > 0))
        fail_field(rows, SCALE, "must be more than 0");
    if (narc_validate_bodies(store, &one, &error) != NARC_OK) /* "body 0: scale is ..." */
        fail_field(rows, SCALE, "%s,", error.message + strlen("body 0: scale "));
    return sized.scale;
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

/* What bodies may be: the shapes of a file, and the entries of chains. */
typedef struct catalogue {
    const char *path;
    const narc_shape_list *shapes;
    narc_shapes *store;
    chain_entries *chains;
} catalogue;

/* Adds a chain to the store, the first time that a body names it. */
static void add_chain(catalogue *c, size_t k) {
    const narc_named_shape *shape = &c->shapes->items[k];
    const narc_chain_options options = {.closed = shape->form == NARC_FORM_CLOSED_CHAIN};
    chain_entries *chain = &c->chains[k];
    narc_error error;
    narc_add_chain(c->store, shape->arcs, shape->arc_count, &options, NULL, 0, &chain->count, &error);
    chain->items = allocate(chain->count, sizeof *chain->items);
    if (narc_add_chain(c->store, shape->arcs, shape->arc_count, &options, chain->items, chain->count, &chain->count,
                       &error) != NARC_OK)
        fail_at(c->path, 0, "chain '%s': %s", shape->name, error.message);
}

static catalogue open_catalogue(const char *path, const narc_shape_list *shapes, narc_shapes *store) {
    catalogue c = {path, shapes, store, allocate(shapes->count, sizeof *c.chains)};
    for (size_t k = 0; k < shapes->count; k++)
        c.chains[k] = (chain_entries){NULL, 0};
    return c;
}

static void close_catalogue(catalogue *c) {
    for (size_t k = 0; k < c->shapes->count; k++)
        free(c->chains[k].items);
    free(c->chains);
}

/* A part of a body: its shape, in the file and in the store, and where it lies in the body's coordinates. */
typedef struct body_part {
    size_t item;
    uint32_t shape;
    narc_point at;
} body_part;

/* A shape of several parts, and where their common centroid is in the coordinates of their origins. */
typedef struct compound {
    body_part *parts;
    size_t count, capacity;
    narc_point centroid;
} compound;

static void put_part(compound *out, size_t item, uint32_t shape, double x, double y) {
    out->parts = grow(out->parts, &out->capacity, out->count + 1, sizeof *out->parts);
    out->parts[out->count++] = (body_part){item, shape, {x, y}};
}

static bool is_chain(const narc_named_shape *shape) {
    return shape->form == NARC_FORM_OPEN_CHAIN || shape->form == NARC_FORM_CLOSED_CHAIN;
}

/* The parts of a shape: itself, or those of a chain, or NAME/1, NAME/2 ...; none if there is no such name. */
static void find_parts(catalogue *c, const char *name, compound *out) {
    enum { SIZE = 1024 };
    const narc_shape_list *shapes = c->shapes;
    char text[SIZE];
    double area = 0;
    const size_t found = find_shape(shapes, name);
    out->count = 0;
    out->centroid = (narc_point){0, 0};
    if (found < shapes->count && is_chain(&shapes->items[found])) {
        if (!c->chains[found].items)
            add_chain(c, found);
        for (size_t k = 0; k < c->chains[found].count; k++) {
            const narc_chain_entry *entry = &c->chains[found].items[k];
            put_part(out, found, entry->shape, entry->x, entry->y);
        }
        return;
    }
    if (found < shapes->count) {
        put_part(out, found, shapes->items[found].index, 0, 0);
        return;
    }
    for (size_t next; snprintf(text, SIZE, "%s/%zu", name, out->count + 1) < SIZE &&
                      (next = narc_find_named_shape(shapes, text)) < shapes->count &&
                      shapes->items[next].form == NARC_FORM_SHAPE;) {
        const narc_named_shape *shape = &shapes->items[next];
        narc_mass mass;
        put_part(out, next, shape->index, shape->origin.x, shape->origin.y);
        narc_compute_mass(shape->arcs, shape->arc_count, &mass);
        area += mass.area;
        out->centroid.x += mass.area * (shape->origin.x + mass.centroid_x);
        out->centroid.y += mass.area * (shape->origin.y + mass.centroid_y);
    }
    if (area > 0)
        out->centroid = (narc_point){out->centroid.x / area, out->centroid.y / area};
}

static void add_part(table *rows, body_list *bodies, const compound *of, size_t k, const narc_shapes *store) {
    const body_part *part = &of->parts[k];
    const double scale = has_column(rows, SCALE) ? (double)read_scale(rows, store, part->shape) : 1;
    const double angle = remainder(row_number(rows, ANGLE), FULL_TURN);
    narc_point turn;
    narc_find_cosine(angle, &turn.x, &turn.y);
    const narc_point away = {scale * (part->at.x - of->centroid.x), scale * (part->at.y - of->centroid.y)};
    if (bodies->count == UINT32_MAX)
        fail_at(rows->path, rows->csv.line, "more than %u bodies", UINT32_MAX);
    bodies->items = grow(bodies->items, &bodies->capacity, bodies->count + 1, sizeof *bodies->items);
    bodies->items[bodies->count++] = (body){.x = row_number(rows, X) + turn.x * away.x - turn.y * away.y,
                                            .y = row_number(rows, Y) + turn.y * away.x + turn.x * away.y,
                                            .scale = (float)scale,
                                            .shape = part->shape,
                                            .item = (uint32_t)part->item,
                                            .row = (uint32_t)bodies->row_count,
                                            .part = (uint32_t)k};
}

void read_bodies(const char *path, const char *shapes_path, const narc_shape_list *shapes, narc_shapes *store,
                 body_list *out_bodies) {
    table rows;
    open_table(&rows, path, body_columns, BODY_COLUMNS, SCALE);
    catalogue known = open_catalogue(shapes_path, shapes, store);
    body_list bodies = {0};
    bodies.items = grow(NULL, &bodies.capacity, 0, sizeof *bodies.items);
    size_t angle_capacity = 0;
    float *angles = grow(NULL, &angle_capacity, 0, sizeof *angles);
    compound of = {0};
    for (; next_row(&rows, "reading bodies"); bodies.row_count++) {
        find_parts(&known, row_field(&rows, SHAPE), &of);
        if (of.count == 0)
            fail_field(&rows, SHAPE, "is no name or index of a shape (there are %zu)", shapes->count);
        for (size_t part = 0; part < of.count; part++) {
            add_part(&rows, &bodies, &of, part, store);
            angles = grow(angles, &angle_capacity, bodies.count, sizeof *angles);
            angles[bodies.count - 1] = (float)remainder(row_number(&rows, ANGLE), FULL_TURN);
        }
    }
    compute_poses(&bodies, angles);
    free(of.parts);
    free(angles);
    close_catalogue(&known);
    close_table(&rows);
    *out_bodies = bodies;
}

bool has_parts(const body_list *bodies) { return bodies->row_count < bodies->count; }

void drop_own_pairs(const body_list *bodies, pair_list *pairs) {
    size_t kept = 0;
    for (size_t k = 0; k < pairs->count; k++)
        if (bodies->items[pairs->items[k].a].row != bodies->items[pairs->items[k].b].row)
            pairs->items[kept++] = pairs->items[k];
    pairs->count = kept;
}

/* Where the parts of each row begin; one more at the end. */
static size_t *list_rows(const body_list *bodies) {
    size_t *begins = allocate(bodies->row_count + 1, sizeof *begins);
    for (size_t k = bodies->count; k-- > 0;)
        begins[bodies->items[k].row] = k;
    begins[bodies->row_count] = bodies->count;
    return begins;
}

static uint32_t read_index(const table *rows, size_t column, size_t body_count) {
    uint64_t index;
    if (!parse_whole(row_field(rows, column), UINT64_MAX, &index))
        fail_field(rows, column, "is not a whole number");
    if (index >= body_count)
        fail_field(rows, column, "is out of range, there are %zu bodies", body_count);
    return (uint32_t)index;
}

void read_pairs(const char *path, const body_list *bodies, pair_list *out_pairs) {
    static const char *const names[] = {"a", "b"};
    table rows;
    open_table(&rows, path, names, 2, 2);
    pair_list pairs = {0};
    pairs.items = grow(NULL, &pairs.capacity, 0, sizeof *pairs.items);
    size_t *begins = list_rows(bodies);
    while (next_row(&rows, "reading pairs")) {
        const uint32_t a = read_index(&rows, 0, bodies->row_count), b = read_index(&rows, 1, bodies->row_count);
        for (size_t i = begins[a]; i < begins[a + 1]; i++) {
            for (size_t j = begins[b]; j < begins[b + 1]; j++) {
                if (pairs.count == UINT32_MAX)
                    fail_at(path, rows.csv.line, "more than %u pairs", UINT32_MAX);
                pairs.items = grow(pairs.items, &pairs.capacity, pairs.count + 1, sizeof *pairs.items);
                pairs.items[pairs.count++] = (pair){(uint32_t)i, (uint32_t)j};
            }
        }
    }
    free(begins);
    close_table(&rows);
    *out_pairs = pairs;
}

/* Around the origin; of a half-plane without end but upwards, if up is along an axis. */
static narc_aabb bound_shape(const narc_shapes *store, const body *at) {
    narc_aabb box = {-INFINITY, -INFINITY, INFINITY, INFINITY};
    if (!(narc_shape_flags(store, at->shape) & NARC_SHAPE_HALF_PLANE))
        narc_get_aabb(store, at->shape, at->cosine, at->sine, at->scale, &box);
    else if (at->sine == 0)
        *(at->cosine > 0 ? &box.max_y : &box.min_y) = 0;
    else if (at->cosine == 0)
        *(at->sine > 0 ? &box.min_x : &box.max_x) = 0;
    return box;
}

/* Rounded outwards: the kernels subtract positions exactly, a box must not lose a pair to rounding. */
narc_aabb *bound_bodies(const narc_shapes *store, const body_list *bodies) {
    narc_aabb *boxes = allocate(bodies->count, sizeof *boxes);
    for (size_t i = 0; i < bodies->count; i++) {
        const body *at = &bodies->items[i];
        const narc_aabb box = bound_shape(store, at);
        boxes[i] = (narc_aabb){nextafter(at->x + box.min_x, -INFINITY), nextafter(at->y + box.min_y, -INFINITY),
                               nextafter(at->x + box.max_x, INFINITY), nextafter(at->y + box.max_y, INFINITY)};
    }
    return boxes;
}

size_t count_unboxed(const narc_shapes *store, const body_list *bodies) {
    const narc_bodies view = view_bodies(bodies);
    narc_box *boxes = allocate(bodies->count, sizeof *boxes);
    size_t count = 0, counted = SIZE_MAX; /* a row, whose parts follow each other */
    narc_error error;
    check_call(narc_compute_boxes(store, &view, NULL, boxes, &error), &error);
    for (size_t k = 0; k < bodies->count; k++)
        if (!(boxes[k].min_x <= boxes[k].max_x) && bodies->items[k].row != counted) {
            counted = bodies->items[k].row;
            count++;
        }
    free(boxes);
    return count;
}

void print_unboxed(FILE *file, size_t count) {
    if (count)
        fprintf(file, "without a box       %zu bodies, beyond the range of single precision\n", count);
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
