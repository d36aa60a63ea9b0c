/* SPDX-License-Identifier: MIT
 *
 * copy.c - makes the object that methods work on from a store.
 */
#include "copy.h"

#include <math.h>
#include <string.h>

#include "error.h"
#include "memory.h"

/* The promised 2^31 floats. */
#define MAX_RECORDS (((size_t)1 << 31) / (sizeof(narc_record) / sizeof(float)))

#define TEXT_(a) #a
#define TEXT(a)  TEXT_(a)
static const char version[] = TEXT(NARC_VERSION_MAJOR) "." TEXT(NARC_VERSION_MINOR) "." TEXT(NARC_VERSION_PATCH);

/* Boxes whose areas differ by less, relatively, are one as good as the other, and the first is taken: the roundings of
 * what is stored decide nothing. */
#define SAME_AREA 1e-6

static float round_up(double value) {
    const float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

static double find_height(const narc_arc *arcs, size_t count, double x, double y) {
    narc_point p = {0, 0};
    narc_find_support(arcs, count, x, y, &p, NULL);
    return p.x * x + p.y * y;
}

/* The smallest of the boxes along the junctions' normals: of a polygon, whose junctions are at both ends of every edge
 * and have its normal, the smallest of all, which lies along an edge. It has as much room around the arcs as the stored
 * bounding circle: for rounding, and for arcs that do not quite join. */
static narc_oriented_box make_box(const narc_shapes *store, uint32_t shape) {
    const narc_shape_header *header = &store->headers[shape];
    const narc_record *stored = narc_arcs_of(store, header);
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(store, shape, arcs);
    narc_circle circle = {0, 0, 0};
    narc_mass mass = {0};
    narc_compute_bounding_circle(arcs, count, &circle);
    narc_compute_mass(arcs, count, &mass);
    const double room = (double)header->bound_radius - circle.radius;
    narc_oriented_box box = {.centroid_x = (float)mass.centroid_x, .centroid_y = (float)mass.centroid_y};
    double least = INFINITY;
    for (size_t i = 0; i < header->count; i++) { /* in the caller's order */
        const narc_stored_arc *arc = &stored[(i + header->count - header->first_arc) % header->count].arc;
        const double x = (double)arc->start_x, y = (double)arc->start_y;
        const double front = find_height(arcs, count, x, y), back = find_height(arcs, count, -x, -y);
        const double left = find_height(arcs, count, -y, x), right = find_height(arcs, count, y, -x);
        const double half_x = (front + back) / 2, half_y = (left + right) / 2;
        if (half_x * half_y < least * (1 - SAME_AREA)) {
            const double along = (front - back) / 2, across = (left - right) / 2;
            least = half_x * half_y;
            box.center_x = (float)(along * x - across * y);
            box.center_y = (float)(along * y + across * x);
            box.half_x = round_up(half_x + room);
            box.half_y = round_up(half_y + room);
            box.axis_x = arc->start_x;
            box.axis_y = arc->start_y;
        }
    }
    return box;
}

/* Of the headers, up to where the records begin. */
static size_t count_header_bytes(size_t count) {
    return (count * sizeof(narc_shape_header) + NARC_CACHE_LINE - 1) / NARC_CACHE_LINE * NARC_CACHE_LINE;
}

/* Copies headers and blocks. A removed shape keeps the block that it has: kernels read it, for nothing. */
static void copy_shapes(const narc_shapes *store, narc_shapes *out_shapes, bool *out_all_polygons) {
    size_t next = 0;
    *out_all_polygons = true;
    for (uint32_t k = 0; k < store->count; k++) {
        const narc_shape_header *from = &store->headers[k];
        const size_t size = narc_count_records(from);
        narc_shape_header *header = &out_shapes->headers[k];
        narc_record *records = &out_shapes->records[next];
        const bool exists = narc_has_shape(store, k);
        const narc_oriented_box box = exists ? make_box(store, k) : (narc_oriented_box){0};
        *header = *from;
        header->first_record = (uint32_t)next;
        memcpy(records, &store->records[from->first_record], size * sizeof *records);
        memcpy(&records[size], &box, sizeof box);
        next += size + 1;
        *out_all_polygons = *out_all_polygons && (!exists || header->flags & NARC_SHAPE_POLYGON);
    }
}

narc_status narc_refresh_methods(narc_methods *methods, narc_error *error) {
    if (!methods)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "methods is NULL");
    const narc_shapes *store = methods->store;
    if (methods->memory && methods->change_count == store->change_count)
        return NARC_OK;
    if (store->piece_count > 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)store->piece_count,
                         "the store has %zu pieces of chains and half-planes, which other methods do not know",
                         store->piece_count);
    size_t records = 0;
    for (size_t k = 0; k < store->count; k++)
        records += narc_count_records(&store->headers[k]) + 1;
    if (records > MAX_RECORDS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)store->count,
                         "the store's %zu shapes have too many arcs for other methods", store->count);
    const size_t header_bytes = count_header_bytes(store->count);
    const narc_allocator *allocator = &methods->allocator;
    char *memory = NULL;
    if (records <= (SIZE_MAX - NARC_CACHE_LINE - header_bytes) / sizeof(narc_record))
        memory =
            allocator->allocate(header_bytes + records * sizeof(narc_record) + NARC_CACHE_LINE, allocator->context);
    if (!memory)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the boxes of %zu shapes", store->count);
    char *start = memory + (NARC_CACHE_LINE - (uintptr_t)memory % NARC_CACHE_LINE);
    narc_shapes *shapes = &methods->shapes;
    *shapes = (narc_shapes){.headers = (narc_shape_header *)start,
                            .records = (narc_record *)(start + header_bytes),
                            .count = store->count,
                            .record_count = records};
    copy_shapes(store, shapes, &methods->all_polygons);
    if (methods->memory)
        allocator->release(methods->memory, allocator->context);
    methods->memory = memory;
    methods->change_count = store->change_count;
    return NARC_OK;
}

narc_status narc_create_methods(const narc_shapes *shapes, const narc_allocator *allocator, narc_methods **out_methods,
                                narc_error *error) {
    const narc_allocator chosen = narc_choose_allocator(allocator);
    if (strcmp(narc_version(), version) != 0)
        return narc_fail(error, NARC_ERROR_VERSION, 0, 0, "narc_methods is of version %s, but narc of version %.40s",
                         version, narc_version());
    if (!shapes || !out_methods)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", shapes ? "out_methods" : "shapes");
    if (!chosen.allocate || !chosen.release)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "allocator.%s is NULL",
                         chosen.allocate ? "release" : "allocate");
    narc_methods *methods = chosen.allocate(sizeof *methods, chosen.context);
    if (!methods)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the boxes of shapes");
    *methods = (narc_methods){.store = shapes, .allocator = chosen};
    const narc_status status = narc_refresh_methods(methods, error);
    if (status == NARC_OK)
        *out_methods = methods;
    else
        chosen.release(methods, chosen.context);
    return status;
}

void narc_destroy_methods(narc_methods *methods) {
    if (!methods)
        return;
    const narc_allocator allocator = methods->allocator;
    if (methods->memory)
        allocator.release(methods->memory, allocator.context);
    allocator.release(methods, allocator.context);
}
