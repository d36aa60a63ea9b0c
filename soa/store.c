/* SPDX-License-Identifier: MIT
 *
 * store.c - the growing list of shapes: validates, rounds to single precision, lays out, and tells what it holds.
 */
#include "store.h"

#include <math.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "outline.h"

/* The promised 2^31 floats. */
#define MAX_RECORDS (((size_t)1 << 31) * sizeof(float) / sizeof(narc_record))

/* How far outside, relative to the size, an arc's centre may be found and still count as inside: a few dozen
 * roundings of the largest coordinate that validation lets through, NARC_MAX_RADIUS_RATIO times the size. */
#define CENTER_SLACK 1e-12

/* ------------------------------------------------------------------------------------------------ memory */

static void release(const narc_shapes *shapes, void *memory) {
    if (memory)
        shapes->allocator.release(memory, shapes->allocator.context);
}

narc_status narc_create_shapes(const narc_allocator *allocator, narc_shapes **out_shapes) {
    const narc_allocator chosen = narc_choose_allocator(allocator);
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
    release(shapes, shapes->headers_memory);
    release(shapes, shapes->records_memory);
    allocator.release(shapes, allocator.context);
}

/* Room for `needed` items where there is room for `capacity`: twice as much, so that adding copies little. */
static size_t choose_capacity(size_t capacity, size_t needed, size_t smallest, size_t limit) {
    size_t chosen = capacity < limit / 2 ? 2 * capacity : limit;
    if (chosen < smallest)
        chosen = smallest;
    return chosen < needed ? needed : chosen;
}

/* Moves `used` bytes at `array` to a new place for `count` items, in memory of its own that begins at a cache line. */
static bool grow(const narc_shapes *shapes, void **memory, const void *array, size_t used, size_t count, size_t item,
                 void **out_array) {
    if (count > (SIZE_MAX - NARC_CACHE_LINE) / item)
        return false;
    char *grown = shapes->allocator.allocate(count * item + NARC_CACHE_LINE, shapes->allocator.context);
    if (!grown)
        return false;
    *out_array = grown + (NARC_CACHE_LINE - (uintptr_t)grown % NARC_CACHE_LINE);
    if (used)
        memcpy(*out_array, array, used);
    release(shapes, *memory);
    *memory = grown;
    return true;
}

static bool grow_heads(narc_shapes *shapes, size_t capacity) {
    void *headers = NULL;
    if (!grow(shapes, &shapes->headers_memory, shapes->headers, shapes->count * sizeof(narc_shape_header), capacity,
              sizeof(narc_shape_header), &headers))
        return false;
    shapes->headers = headers;
    shapes->capacity = capacity;
    return true;
}

static bool grow_records(narc_shapes *shapes, size_t capacity) {
    void *records = NULL;
    if (!grow(shapes, &shapes->records_memory, shapes->records, shapes->record_count * sizeof(narc_record), capacity,
              sizeof(narc_record), &records))
        return false;
    shapes->records = records;
    shapes->record_capacity = capacity;
    return true;
}

/* Room for so many shapes and records in all. If the second allocation fails the first stays, unseen and unused. */
static narc_status make_room(narc_shapes *shapes, size_t count, size_t records) {
    if (count > NARC_MAX_SHAPES || records > MAX_RECORDS)
        return NARC_ERROR_COUNT;
    if (count > shapes->capacity && !grow_heads(shapes, choose_capacity(shapes->capacity, count, 16, NARC_MAX_SHAPES)))
        return NARC_ERROR_MEMORY;
    if (records > shapes->record_capacity &&
        !grow_records(shapes, choose_capacity(shapes->record_capacity, records, 64, MAX_RECORDS)))
        return NARC_ERROR_MEMORY;
    return NARC_OK;
}

static size_t count_records(size_t count) { return narc_angle_records(count) + count + 1; }

narc_status narc_reserve_shapes(narc_shapes *shapes, size_t shape_count, size_t arc_count) {
    if (!shapes)
        return NARC_ERROR_ARGUMENT;
    if (shape_count > NARC_MAX_SHAPES || arc_count > MAX_RECORDS)
        return NARC_ERROR_COUNT;
    /* A record for each arc and one for 16 arcs' angles; for each shape, angles that do not fill their record, a
     * circle's second half, and the box. */
    return make_room(shapes, shapes->count + shape_count,
                     shapes->record_count + arc_count + arc_count / NARC_RECORD_ANGLES + 3 * shape_count);
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

static uint8_t find_flags(const narc_outline *o, size_t count, double size) {
    bool smooth = true, polygon = true, inside = true;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        smooth = smooth && hypot(to.x - from.x, to.y - from.y) <= NARC_TOLERANCE * size;
        polygon = polygon && o->radius[i] == 0;
        inside = inside &&
                 (o->radius[i] == 0 || narc_find_gap(o, o->center_x[i], o->center_y[i], NULL) <= CENTER_SLACK * size);
    }
    return (uint8_t)((smooth ? NARC_SHAPE_SMOOTH : 0) | (count == 1 ? NARC_SHAPE_CIRCLE : 0) |
                     (polygon ? NARC_SHAPE_POLYGON : 0) | (inside ? NARC_SHAPE_CENTERS_INSIDE : 0));
}

/* By how much the arcs fail to make a closed convex outline, in all: distances across the normal of a junction, and
 * along an edge that runs backwards. */
static double find_misfit(const narc_outline *o) {
    double misfit = 0;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        double x = to.x - from.x, y = to.y - from.y, n_x = o->normal_x[i], n_y = o->normal_y[i];
        misfit += fabs(x * n_x + y * n_y) + fmax(0, x * n_y - y * n_x);
    }
    return misfit;
}

static narc_shape_header make_header(const narc_outline *o, size_t count, narc_circle bound, double extent) {
    narc_circle inner;
    narc_inscribe_outline(o, &inner);
    double misfit = find_misfit(o), room = NARC_ROUNDING_ROOM * extent + misfit;
    inner.x += o->origin_x;
    inner.y += o->origin_y;
    narc_shape_header header = {.count = (uint8_t)o->count};
    header.flags = find_flags(o, count, bound.radius);
    header.bound_x = (float)bound.x;
    header.bound_y = (float)bound.y;
    double moved = hypot((double)header.bound_x - bound.x, (double)header.bound_y - bound.y);
    header.bound_radius = round_up(bound.radius + moved + room);
    header.inner_x = (float)inner.x;
    header.inner_y = (float)inner.y;
    moved = hypot((double)header.inner_x - inner.x, (double)header.inner_y - inner.y);
    header.inner_radius = round_down(inner.radius - moved - room);
    /* One part in a million for the rounding of what is stored. */
    header.extent_ratio = UINT8_MAX;
    if (misfit <= NARC_MAX_MISFIT * extent)
        header.extent_ratio = (uint8_t)fmin(UINT8_MAX, ceil(extent * (1 + 1e-6) / (double)header.bound_radius));
    return header;
}

/* The smallest of the boxes along the junctions' normals: of a polygon, whose junctions are at both ends of every edge
 * and have its normal, the smallest of all, which lies along an edge. Its numbers are rounded to single precision,
 * which NARC_ROUNDING_ROOM has room for. */
static narc_oriented_box make_box(const narc_outline *o, const narc_arc *arcs, size_t count, double room) {
    double least = INFINITY;
    narc_oriented_box box = {0};
    for (size_t i = 0; i < o->count; i++) {
        double x = o->normal_x[i], y = o->normal_y[i];
        double front = narc_find_height(o, x, y), back = narc_find_height(o, -x, -y);
        double left = narc_find_height(o, -y, x), right = narc_find_height(o, y, -x);
        double half_x = (front + back) / 2, half_y = (left + right) / 2;
        if (half_x * half_y < least) {
            double along = (front - back) / 2, across = (left - right) / 2;
            least = half_x * half_y;
            box.center_x = (float)(o->origin_x + along * x - across * y);
            box.center_y = (float)(o->origin_y + along * y + across * x);
            box.half_x = round_up(half_x + room);
            box.half_y = round_up(half_y + room);
            box.axis_x = (float)x;
            box.axis_y = (float)y;
        }
    }
    narc_mass mass = {0};
    narc_compute_mass(arcs, count, &mass);
    box.centroid_x = (float)mass.centroid_x;
    box.centroid_y = (float)mass.centroid_y;
    return box;
}

/* The diamond angle of a normal, as the kernels compute it. */
static float find_diamond_angle(float x, float y) {
    float p = x / (fabsf(x) + fabsf(y));
    return 0 <= y ? 1 - p : 3 + p;
}

/* The smallest radius of the arcs that hold a direction within `window` of one of arc `arc`. Those that begin just
 * outside the window count, too, against rounding. */
static double find_least_radius(const narc_outline *o, size_t arc, double window) {
    double least = o->radius[arc];
    for (int side = 0; side < 2; side++) {
        double angle = 0;
        for (size_t k = 1; k < o->count && angle <= window + NARC_TOLERANCE; k++) {
            size_t i = (side ? arc + k : arc + o->count - k) % o->count;
            least = fmin(least, o->radius[i]);
            angle += o->sweep[i];
        }
    }
    return least;
}

/* The largest radius of a circle in the shape that touches its outline at the point p with the normal n, not more than
 * `limit`. Such a circle of radius t reaches p.m + t (1 - n.m) in the direction m, so t is at most
 * (h(m) - p.m) / (1 - n.m) for every m. With m in the sector of arc j, h(m) - p.m = r - w.m where w = p - its centre;
 * the quotient is least at an end of the sector or where the circle touches that arc. */
static double find_inner_radius(const narc_outline *o, narc_point p, double n_x, double n_y, double limit) {
    /* Arcs that touch p, or hold directions as near to n as that, are neighbours: `limit` knows their radii. */
    const double nothing = NARC_TOLERANCE * NARC_TOLERANCE;
    double least = limit;
    for (size_t j = 0; j < o->count; j++) {
        double w_x = p.x - o->center_x[j], w_y = p.y - o->center_y[j], r = o->radius[j];
        for (size_t end = j; end <= j + 1; end++) {
            double m_x = o->normal_x[end], m_y = o->normal_y[end], width = 1 - (n_x * m_x + n_y * m_y);
            if (width > nothing)
                least = fmin(least, (r - (w_x * m_x + w_y * m_y)) / width);
        }
        double fall = r - (w_x * n_x + w_y * n_y);
        if (fall > nothing * r) {
            double touching = (r * r - (w_x * w_x + w_y * w_y)) / (2 * fall);
            if (narc_in_sector(o, j, w_x - touching * n_x, w_y - touching * n_y))
                least = fmin(least, touching);
        }
    }
    return fmax(0, least);
}

/* Of all circles that touch an arc from inside, those at its ends are the first to leave the shape: by how much the
 * arc's circle exceeds the shape in a direction m does not depend on the point, and it counts most from the nearest. */
static double find_arc_inner(const narc_outline *o, size_t arc) {
    double inner = find_least_radius(o, arc, NARC_INNER_WINDOW);
    inner = find_inner_radius(o, narc_find_start(o, arc), o->normal_x[arc], o->normal_y[arc], inner);
    return find_inner_radius(o, narc_find_end(o, arc), o->normal_x[arc + 1], o->normal_y[arc + 1], inner);
}

/* The upper half of a float that is at most a value, less a part in a million for the rounding of what is stored. */
static uint32_t find_upper_half(double value) {
    float rounded = (float)(value * (1 - 1e-6));
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits >> 16;
}

static void write_records(const narc_outline *o, narc_shape_header *header, narc_record *records) {
    size_t count = o->count, first = 0, angle_records = narc_angle_records(count);
    float angles[NARC_MAX_ARCS];
    for (size_t i = 0; i < count; i++) {
        angles[i] = find_diamond_angle((float)o->normal_x[i], (float)o->normal_y[i]);
        first = angles[i] < angles[first] ? i : first;
    }
    header->first_arc = (uint8_t)first;
    for (size_t k = 0; k < NARC_RECORD_ANGLES * angle_records; k++) {
        int16_t angle = NARC_ANGLE_NONE;
        if (k < count)
            angle = (int16_t)(angles[(first + k) % count] * NARC_ANGLE_SCALE - NARC_ANGLE_OFFSET);
        records[k / NARC_RECORD_ANGLES].angles[k % NARC_RECORD_ANGLES] = angle;
    }
    for (size_t k = 0; k < count; k++) {
        size_t i = (first + k) % count;
        records[angle_records + k].arc =
            (narc_stored_arc){.center_x = (float)(o->center_x[i] + o->origin_x),
                              .center_y = (float)(o->center_y[i] + o->origin_y),
                              .radius = (float)o->radius[i],
                              .inner_radii = find_upper_half(find_arc_inner(o, i)) << 16 |
                                             find_upper_half(find_least_radius(o, i, NARC_NEAR_WINDOW)),
                              .start_x = (float)o->normal_x[i],
                              .start_y = (float)o->normal_y[i],
                              .end_x = (float)o->normal_x[i + 1],
                              .end_y = (float)o->normal_y[i + 1]};
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
    size_t first_record = shapes->record_count, record_count = count_records(outline.count);
    status = make_room(shapes, shapes->count + 1, first_record + record_count);
    if (status == NARC_ERROR_COUNT)
        return narc_fail(error, status, shapes->count, (double)shapes->count, "the store is full, it has %zu shapes",
                         shapes->count);
    if (status != NARC_OK)
        return narc_fail(error, status, shapes->count, 0, "no memory for shape %zu", shapes->count);
    double extent = 0;
    for (size_t i = 0; i < count; i++)
        extent = fmax(extent, hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
    narc_shape_header header = make_header(&outline, count, bound, extent);
    if ((double)header.bound_radius > NARC_MAX_BOUND_RADIUS)
        return narc_fail(error, NARC_ERROR_SIZE, 0, bound.radius,
                         "the shape's bounding radius is %.9g, with room for rounding %.9g, more than %g", bound.radius,
                         (double)header.bound_radius, NARC_MAX_SIZE);
    header.first_record = (uint32_t)first_record;
    write_records(&outline, &header, shapes->records + first_record);
    shapes->records[first_record + record_count - 1].box =
        make_box(&outline, arcs, count, NARC_ROUNDING_ROOM * extent + find_misfit(&outline));
    if (out_shape)
        *out_shape = (uint32_t)shapes->count;
    shapes->headers[shapes->count++] = header;
    shapes->polygon_count += (header.flags & NARC_SHAPE_POLYGON) != 0;
    shapes->record_count += record_count;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ reading */

size_t narc_count_shapes(const narc_shapes *shapes) { return shapes ? shapes->count : 0; }

unsigned narc_shape_flags(const narc_shapes *shapes, uint32_t shape) {
    return shape < narc_count_shapes(shapes) ? shapes->headers[shape].flags : 0;
}

size_t narc_get_arcs(const narc_shapes *shapes, uint32_t shape, narc_arc *out_arcs) {
    if (shape >= narc_count_shapes(shapes))
        return 0;
    narc_shape_header header = shapes->headers[shape];
    const narc_record *arcs = narc_arcs_of(shapes, &header);
    size_t count = header.flags & NARC_SHAPE_CIRCLE ? 1 : header.count;
    for (size_t i = 0; out_arcs && i < count; i++) {
        const narc_stored_arc *r = &arcs[(i + header.count - header.first_arc) % header.count].arc;
        double start = atan2((double)r->start_y, (double)r->start_x), end = atan2((double)r->end_y, (double)r->end_x);
        if (count == 1)
            end = start;
        if (end <= start)
            end += 2 * NARC_PI;
        out_arcs[i] = (narc_arc){(double)r->center_x, (double)r->center_y, (double)r->radius, start, end};
    }
    return count;
}

/* The support function of the stored arcs: the furthest of all arc ends, or a point inside the arc that has the
 * direction. */
static double find_stored_height(const narc_record *arcs, size_t count, double x, double y) {
    double best = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        double ax = (double)arcs[i].arc.start_x, ay = (double)arcs[i].arc.start_y;
        double bx = (double)arcs[i].arc.end_x, by = (double)arcs[i].arc.end_y;
        double center = (double)arcs[i].arc.center_x * x + (double)arcs[i].arc.center_y * y,
               radius = (double)arcs[i].arc.radius;
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
    const narc_record *arcs = narc_arcs_of(shapes, &shapes->headers[shape]);
    size_t count = shapes->headers[shape].count;
    double length = hypot((double)cosine, (double)sine), c = (double)cosine / length, s = (double)sine / length;
    double extent = 0;
    if (!(length > 0) || !isfinite(length))
        return false;
    for (size_t i = 0; i < count; i++)
        extent = fmax(extent, fabs((double)arcs[i].arc.center_x) + fabs((double)arcs[i].arc.center_y) +
                                  (double)arcs[i].arc.radius);
    /* The world's x axis is (c, -s) in the shape's axes, its y axis (s, c). */
    double slack = NARC_ROUNDING_ROOM * extent, factor = (double)scale;
    *out_aabb = (narc_aabb){.min_x = factor * -(find_stored_height(arcs, count, -c, s) + slack),
                            .min_y = factor * -(find_stored_height(arcs, count, -s, -c) + slack),
                            .max_x = factor * (find_stored_height(arcs, count, c, -s) + slack),
                            .max_y = factor * (find_stored_height(arcs, count, s, c) + slack)};
    return true;
}
