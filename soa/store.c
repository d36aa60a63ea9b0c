/* SPDX-License-Identifier: MIT
 *
 * store.c - the list of shapes: its memory, how shapes come and go, and what it tells of them.
 *
 * Blocks of records lie in the order in which they came. A shape that is removed, or replaced by one with more or fewer
 * arcs, leaves a gap; the gaps go when the array is full and moves to a new place. The first block is a circle that
 * belongs to no shape: when its own block is gone, a removed shape has that one, so that kernels may read it as any
 * other.
 *
 * Equal shapes are found by a hash of their stored bits, in lists with an average length of at most 1: there are as
 * many of them as there is room for headers.
 */
#include "store.h"

#include <math.h>
#include <string.h>

#include "elementary.h"
#include "encode.h"
#include "error.h"
#include "memory.h"
#include "outline.h"
#include "piece.h"

/* The promised 2^31 floats. */
#define MAX_RECORDS (((size_t)1 << 31) / (sizeof(narc_record) / sizeof(float)))

/* The block of removed shapes: a circle, two arcs. */
enum { SPARE_ARCS = 2, SPARE_RECORDS = 1 + SPARE_ARCS };

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
    *shapes = (narc_shapes){.used_records = SPARE_RECORDS, .last_removed = NARC_NO_SHAPE, .allocator = chosen};
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

/* Room for `needed` headers where there is room for `capacity`: twice as much, so that adding copies little. */
static size_t choose_headers(size_t capacity, size_t needed) {
    const size_t twice = capacity < NARC_MAX_SHAPES / 2 ? 2 * capacity : NARC_MAX_SHAPES, least = 16;
    const size_t chosen = twice > least ? twice : least;
    return chosen > needed ? chosen : needed;
}

/* Memory for `size` bytes that begin at a cache line, and end with the memory but for less than a line. */
static void *allocate(const narc_shapes *shapes, size_t size, void **out_array) {
    char *memory = shapes->allocator.allocate(size + NARC_CACHE_LINE, shapes->allocator.context);
    if (memory)
        *out_array = memory + (NARC_CACHE_LINE - (uintptr_t)memory % NARC_CACHE_LINE);
    return memory;
}

static uint32_t *find_bucket(const narc_shapes *shapes, uint32_t hash) {
    return &shapes->buckets[(uint64_t)hash * shapes->capacity >> 32];
}

/* Puts a shape at the head of a list. */
static void link_shape(narc_shapes *shapes, uint32_t shape, uint32_t *head) {
    shapes->entries[shape].next = *head;
    shapes->entries[shape].before = NARC_NO_SHAPE;
    if (*head != NARC_NO_SHAPE)
        shapes->entries[*head].before = shape;
    *head = shape;
}

static void unlink_shape(narc_shapes *shapes, uint32_t shape, uint32_t *head) {
    const narc_shape_entry *entry = &shapes->entries[shape];
    if (entry->before == NARC_NO_SHAPE)
        *head = entry->next;
    else
        shapes->entries[entry->before].next = entry->next;
    if (entry->next != NARC_NO_SHAPE)
        shapes->entries[entry->next].before = entry->before;
}

/* Headers come last, so that what reads past them reads past the memory. */
static bool grow_headers(narc_shapes *shapes, size_t capacity, bool with_fronts) {
    const size_t item = sizeof(narc_piece_form) + sizeof(narc_box_form) + sizeof(uint32_t) + sizeof(narc_shape_entry) +
                        sizeof(narc_shape_header);
    void *array = NULL, *memory;
    if (capacity > (SIZE_MAX - 2 * NARC_CACHE_LINE) / item)
        return false;
    const size_t fronts_size = with_fronts ? capacity * sizeof(narc_piece_form) : 0;
    const size_t boxes_size = fronts_size + capacity * sizeof(narc_box_form);
    const size_t links = capacity * (sizeof(uint32_t) + sizeof(narc_shape_entry));
    const size_t front = (boxes_size + links + NARC_CACHE_LINE - 1) / NARC_CACHE_LINE * NARC_CACHE_LINE;
    memory = allocate(shapes, front + capacity * sizeof(narc_shape_header), &array);
    if (!memory)
        return false;
    narc_shape_header *headers = (void *)((char *)array + front);
    narc_box_form *boxes = (void *)((char *)array + fronts_size);
    narc_shape_entry *entries = (void *)(boxes + capacity);
    memset(array, 0, fronts_size);
    if (shapes->fronts && shapes->count)
        memcpy(array, shapes->fronts, shapes->count * sizeof *shapes->fronts);
    if (shapes->count) {
        memcpy(boxes, shapes->boxes, shapes->count * sizeof *boxes);
        memcpy(headers, shapes->headers, shapes->count * sizeof *headers);
        memcpy(entries, shapes->entries, shapes->count * sizeof *entries);
    }
    release(shapes, shapes->headers_memory);
    shapes->headers_memory = memory;
    shapes->headers = headers;
    shapes->fronts = with_fronts ? array : NULL;
    shapes->boxes = boxes;
    shapes->entries = entries;
    shapes->buckets = (void *)(entries + capacity);
    shapes->capacity = capacity;
    for (size_t k = 0; k < capacity; k++)
        shapes->buckets[k] = NARC_NO_SHAPE;
    for (uint32_t k = 0; k < shapes->count; k++)
        if (entries[k].uses)
            link_shape(shapes, k, find_bucket(shapes, entries[k].hash));
    return true;
}

/* Records behind the last one, NARC_READ_AHEAD or more: of a shape with one arc 16 may be read (load_own_arcs()). */
enum { ARCS_AHEAD = 15 };
_Static_assert(ARCS_AHEAD >= (int)NARC_READ_AHEAD, "what kernels read");

/* Moves all blocks that are in use to a new array, one behind the other. */
static bool move_records(narc_shapes *shapes, size_t capacity) {
    static const narc_arc circle = {0, 0, 1, 0, 2 * NARC_PI};
    narc_encoded_shape spare;
    void *array = NULL, *memory;
    if (capacity > (SIZE_MAX - NARC_CACHE_LINE) / sizeof(narc_record) - ARCS_AHEAD)
        return false;
    memory = allocate(shapes, (capacity + ARCS_AHEAD) * sizeof(narc_record), &array);
    if (!memory)
        return false;
    narc_record *records = array;
    size_t next = SPARE_RECORDS;
    (void)narc_encode_shape(&circle, 1, &spare, NULL);
    memcpy(records, spare.records, SPARE_RECORDS * sizeof *records);
    for (uint32_t k = 0; k < shapes->count; k++) {
        narc_shape_header *header = &shapes->headers[k];
        const size_t size = narc_count_records(header);
        if (!narc_has_shape(shapes, k)) {
            header->first_record = 0;
            header->count = SPARE_ARCS;
            header->first_arc = 0;
            continue;
        }
        memcpy(&records[next], &shapes->records[header->first_record], size * sizeof *records);
        header->first_record = (uint32_t)next;
        next += size;
    }
    release(shapes, shapes->records_memory);
    shapes->records_memory = memory;
    shapes->records = records;
    shapes->record_count = next;
    shapes->record_capacity = capacity;
    return true;
}

/* Records to make room for, where `used` and `added` have to fit: room for as many as are used, so that moves copy
 * little, and never more than twice what was needed at one time, so that both arrays of a move are within four times
 * that. */
static size_t choose_records(const narc_shapes *shapes, size_t used, size_t added) {
    const size_t most = MAX_RECORDS - used, room = added > used ? added : used, least = 64;
    const size_t chosen = used + (room < most ? room : most);
    const size_t larger = chosen > least ? chosen : least;
    return larger > shapes->record_capacity ? larger : shapes->record_capacity;
}

/* Room for so many headers in all, and so many records behind those that are there. If the second allocation fails the
 * first stays, unseen and unused. */
narc_status narc_make_room(narc_shapes *shapes, size_t count, size_t records, bool fronts) {
    const size_t used = shapes->used_records;
    const bool full = count > shapes->capacity, with_fronts = fronts || shapes->fronts;
    if (count > NARC_MAX_SHAPES || records > MAX_RECORDS - used)
        return NARC_ERROR_COUNT;
    if ((full || (with_fronts && !shapes->fronts)) &&
        !grow_headers(shapes, full ? choose_headers(shapes->capacity, count) : shapes->capacity, with_fronts))
        return NARC_ERROR_MEMORY;
    if (records <= shapes->record_capacity - shapes->record_count)
        return NARC_OK;
    return move_records(shapes, choose_records(shapes, used, records)) ? NARC_OK : NARC_ERROR_MEMORY;
}

narc_status narc_reserve_shapes(narc_shapes *shapes, size_t shape_count, size_t arc_count) {
    if (!shapes)
        return NARC_ERROR_ARGUMENT;
    if (shape_count > NARC_MAX_SHAPES || arc_count > MAX_RECORDS)
        return NARC_ERROR_COUNT;
    /* A record for each arc and one for 16 arcs' angles; for each shape, angles that do not fill their record, and a
     * circle's second half. */
    return narc_make_room(shapes, shapes->count + shape_count,
                          arc_count + arc_count / NARC_RECORD_ANGLES + 2 * shape_count, false);
}

/* ------------------------------------------------------------------------------------------------ adding */

static narc_status fail_room(const narc_shapes *shapes, narc_status status, narc_error *error) {
    if (status == NARC_ERROR_COUNT)
        return narc_fail(error, status, shapes->count, (double)shapes->count, "the store is full, it has %zu shapes",
                         shapes->count);
    return narc_fail(error, status, shapes->count, 0, "no memory for a shape beside the other %zu", shapes->count);
}

/* How many records an index's own block has: also that of a removed shape, until it is gone. */
static size_t count_own_records(const narc_shapes *shapes, uint32_t shape) {
    const bool has_block = shape < shapes->count && shapes->headers[shape].first_record > 0;
    return has_block ? narc_count_records(&shapes->headers[shape]) : 0;
}

static const size_t hashed_header = offsetof(narc_shape_header, first_record) + sizeof(uint32_t);

/* Mixes the words of an array into a hash: a change of any bit changes all bits of the result about half of the
 * time. */
static uint64_t mix(uint64_t hash, const void *words, size_t size) {
    for (size_t at = 0; at < size; at += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const char *)words + at, sizeof word);
        hash = (hash ^ word) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return hash;
}

/* What two equal shapes have in common: all of the header but its place, and all records. */
static size_t count_hashed_bytes(const narc_shape_header *header) {
    return narc_count_records(header) * sizeof(narc_record);
}

static uint32_t hash_shape(const narc_encoded_shape *encoded) {
    const narc_shape_header *header = &encoded->header;
    const uint64_t hash = mix(0, (const char *)header + hashed_header, sizeof *header - hashed_header);
    return (uint32_t)mix(hash, encoded->records, count_hashed_bytes(header));
}

static bool has_bits(const narc_shapes *shapes, uint32_t shape, const narc_encoded_shape *encoded) {
    const narc_shape_header *a = &shapes->headers[shape], *b = &encoded->header;
    return memcmp((const char *)a + hashed_header, (const char *)b + hashed_header, sizeof *a - hashed_header) == 0 &&
           memcmp(&shapes->records[a->first_record], encoded->records, count_hashed_bytes(b)) == 0;
}

/* A stored shape with these bits, or NARC_NO_SHAPE. */
static uint32_t find_equal(const narc_shapes *shapes, const narc_encoded_shape *encoded, uint32_t hash) {
    uint32_t shape = shapes->capacity ? *find_bucket(shapes, hash) : NARC_NO_SHAPE;
    while (shape != NARC_NO_SHAPE && !(shapes->entries[shape].hash == hash && has_bits(shapes, shape, encoded)))
        shape = shapes->entries[shape].next;
    return shape;
}

static void note_change(narc_shapes *shapes, uint32_t shape, uint32_t hash) {
    const uint32_t change[] = {shape, hash};
    shapes->change_count++;
    shapes->history = mix(shapes->history, change, sizeof change);
}

/* A shape comes (1) or goes (-1). */
static void count_piece(narc_shapes *shapes, const narc_shape_header *header, int by) {
    shapes->piece_count += narc_is_piece(header) ? (size_t)by : 0;
    shapes->plane_count += narc_is_plane(header) ? (size_t)by : 0;
}

/* Keeps the form of a shape's box, or that it is none, and what a circle touches of a piece. */
static void put_forms(narc_shapes *shapes, uint32_t shape, narc_box_form box, narc_piece_form piece) {
    shapes->box_count += narc_has_form(&box) - (size_t)narc_has_form(&shapes->boxes[shape]);
    shapes->boxes[shape] = box;
    if (shapes->fronts)
        shapes->fronts[shape] = piece;
}

void narc_open_indices(narc_shapes *shapes, size_t count) {
    for (uint32_t k = (uint32_t)count; k-- > shapes->count;) {
        shapes->headers[k] = (narc_shape_header){.count = SPARE_ARCS};
        shapes->boxes[k] = (narc_box_form){.info = 0};
        shapes->entries[k] = (narc_shape_entry){.uses = 0};
        link_shape(shapes, k, &shapes->last_removed);
        shapes->removed_count++;
    }
    shapes->count = count > shapes->count ? count : shapes->count;
}

/* Puts an encoded shape at an index: in the place of the block that is there, if it fits. */
narc_status narc_put_encoded_shape(narc_shapes *shapes, uint32_t shape, narc_encoded_shape *encoded,
                                   narc_error *error) {
    const size_t size = narc_count_records(&encoded->header), own_size = count_own_records(shapes, shape);
    const size_t used_size = narc_has_shape(shapes, shape) ? own_size : 0;
    const size_t count = shape < shapes->count ? shapes->count : (size_t)shape + 1;
    const uint32_t hash = hash_shape(encoded);
    const bool has_front = narc_is_of_chain(&encoded->header);
    if (size > own_size || (has_front && !shapes->fronts)) {
        const narc_status status = narc_make_room(shapes, count, size > own_size ? size : 0, has_front);
        if (status != NARC_OK)
            return fail_room(shapes, status, error);
    }
    if (size > own_size) {
        encoded->header.first_record = (uint32_t)shapes->record_count;
        shapes->record_count += size;
    } else {
        encoded->header.first_record = shapes->headers[shape].first_record;
    }
    narc_open_indices(shapes, count);
    if (narc_has_shape(shapes, shape)) {
        count_piece(shapes, &shapes->headers[shape], -1);
        unlink_shape(shapes, shape, find_bucket(shapes, shapes->entries[shape].hash));
    } else {
        unlink_shape(shapes, shape, &shapes->last_removed);
        shapes->removed_count--;
    }
    memcpy(&shapes->records[encoded->header.first_record], encoded->records, size * sizeof *encoded->records);
    shapes->headers[shape] = encoded->header;
    count_piece(shapes, &encoded->header, 1);
    if (shapes->largest_ratio < encoded->header.extent_ratio)
        shapes->largest_ratio = encoded->header.extent_ratio;
    put_forms(shapes, shape, narc_find_box_form(encoded), narc_find_piece_form(encoded));
    shapes->entries[shape] = (narc_shape_entry){.uses = 1, .hash = hash};
    link_shape(shapes, shape, find_bucket(shapes, hash));
    shapes->used_records += size - used_size;
    note_change(shapes, shape, hash);
    return NARC_OK;
}

narc_status narc_share_encoded_shape(narc_shapes *shapes, narc_encoded_shape *encoded, uint32_t *out_shape,
                                     narc_error *error) {
    narc_status status = NARC_OK;
    uint32_t shape = find_equal(shapes, encoded, hash_shape(encoded));
    if (shape != NARC_NO_SHAPE) {
        if (shapes->entries[shape].uses == UINT32_MAX)
            return narc_fail(error, NARC_ERROR_COUNT, shape, UINT32_MAX, "shape %lu is used %lu times, which is most",
                             (unsigned long)shape, (unsigned long)UINT32_MAX);
        shapes->entries[shape].uses++;
    } else {
        shape = shapes->removed_count ? shapes->last_removed : (uint32_t)shapes->count;
        status = narc_put_encoded_shape(shapes, shape, encoded, error);
    }
    if (status == NARC_OK && out_shape)
        *out_shape = shape;
    return status;
}

narc_status narc_add_shape(narc_shapes *shapes, const narc_arc *arcs, size_t count, uint32_t *out_shape,
                           narc_error *error) {
    narc_encoded_shape encoded;
    if (!shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "shapes is NULL");
    const narc_status status = narc_encode_shape(arcs, count, &encoded, error);
    return status == NARC_OK ? narc_share_encoded_shape(shapes, &encoded, out_shape, error) : status;
}

#if NARC_PIECES
narc_status narc_add_half_plane(narc_shapes *shapes, uint32_t *out_shape, narc_error *error) {
    narc_encoded_shape encoded;
    if (!shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "shapes is NULL");
    const narc_status status = narc_encode_plane(&encoded, error);
    return status == NARC_OK ? narc_share_encoded_shape(shapes, &encoded, out_shape, error) : status;
}
#endif

narc_status narc_add_shape_at(narc_shapes *shapes, uint32_t shape, const narc_arc *arcs, size_t count,
                              narc_error *error) {
    narc_encoded_shape encoded;
    if (!shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "shapes is NULL");
    if (shape >= NARC_MAX_SHAPES)
        return narc_fail(error, NARC_ERROR_INDEX, shape, shape, "shape is %lu, not below %lu", (unsigned long)shape,
                         (unsigned long)NARC_MAX_SHAPES);
    if (narc_has_shape(shapes, shape))
        return narc_fail(error, NARC_ERROR_IN_USE, shape, shape, "there is a shape %lu already", (unsigned long)shape);
    const narc_status status = narc_encode_shape(arcs, count, &encoded, error);
    return status == NARC_OK ? narc_put_encoded_shape(shapes, shape, &encoded, error) : status;
}

/* ------------------------------------------------------------------------------------------------ replacing */

static narc_status check_shape(const narc_shapes *shapes, uint32_t shape, narc_error *error) {
    if (!shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "shapes is NULL");
    if (shape >= shapes->count)
        return narc_fail(error, NARC_ERROR_INDEX, shape, shape, "shape is %lu, but there are %zu shapes",
                         (unsigned long)shape, shapes->count);
    if (!narc_has_shape(shapes, shape))
        return narc_fail(error, NARC_ERROR_INDEX, shape, shape, "shape %lu was removed", (unsigned long)shape);
    return NARC_OK;
}

narc_status narc_replace_shape(narc_shapes *shapes, uint32_t shape, const narc_arc *arcs, size_t count,
                               narc_error *error) {
    narc_encoded_shape encoded;
    narc_status status = check_shape(shapes, shape, error);
    if (status != NARC_OK)
        return status;
    if (shapes->entries[shape].uses > 1)
        return narc_fail(error, NARC_ERROR_IN_USE, shape, shapes->entries[shape].uses,
                         "shape %lu is used %lu times, another would come in the place of all", (unsigned long)shape,
                         (unsigned long)shapes->entries[shape].uses);
    status = narc_encode_shape(arcs, count, &encoded, error);
    return status == NARC_OK ? narc_put_encoded_shape(shapes, shape, &encoded, error) : status;
}

narc_status narc_remove_shape(narc_shapes *shapes, uint32_t shape, narc_error *error) {
    const narc_status status = check_shape(shapes, shape, error);
    if (status != NARC_OK || --shapes->entries[shape].uses > 0)
        return status;
    narc_shape_header *header = &shapes->headers[shape];
    shapes->used_records -= narc_count_records(header);
    count_piece(shapes, header, -1);
    header->bound_radius = 0;
    put_forms(shapes, shape, (narc_box_form){.info = 0}, (narc_piece_form){.info = 0});
    unlink_shape(shapes, shape, find_bucket(shapes, shapes->entries[shape].hash));
    link_shape(shapes, shape, &shapes->last_removed);
    shapes->removed_count++;
    note_change(shapes, shape, shapes->entries[shape].hash);
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ reading */

size_t narc_count_shapes(const narc_shapes *shapes) { return shapes ? shapes->count : 0; }

uint32_t narc_count_uses(const narc_shapes *shapes, uint32_t shape) {
    return narc_has_shape(shapes, shape) ? shapes->entries[shape].uses : 0;
}

unsigned narc_shape_flags(const narc_shapes *shapes, uint32_t shape) {
    _Static_assert(NARC_PIECE_RUN >> 2 == NARC_SHAPE_RUN && NARC_PIECE_CONCAVE >> 2 == NARC_SHAPE_CONCAVE, "marks");
    if (!narc_has_shape(shapes, shape))
        return 0;
    const narc_shape_header *header = &shapes->headers[shape];
    const unsigned marks = NARC_PIECES ? (header->first_arc & NARC_PIECE_MARKS) >> 2 : 0;
    if (narc_is_plane(header))
        return NARC_SHAPE_HALF_PLANE;
    return header->flags % (1u << NARC_SIZE_CLASS_SHIFT) | marks;
}

size_t narc_get_arcs(const narc_shapes *shapes, uint32_t shape, narc_arc *out_arcs) {
    if (!narc_has_shape(shapes, shape))
        return 0;
    narc_shape_header header = shapes->headers[shape];
    const narc_record *arcs = narc_arcs_of(shapes, &header);
    const bool is_circle = header.flags & NARC_SHAPE_CIRCLE, is_concave = narc_is_concave(&header);
    size_t count = is_circle ? 1 : narc_is_plane(&header) ? 0 : header.count;
    header.first_arc = NARC_PIECES ? header.first_arc & NARC_FIRST_ARC : header.first_arc;
    for (size_t i = 0; out_arcs && i < count; i++) {
        const narc_stored_arc *r = &arcs[(i + header.count - header.first_arc) % header.count].arc;
        double start = narc_atan2((double)r->start_y, (double)r->start_x),
               end = narc_atan2((double)r->end_y, (double)r->end_x);
        if (is_circle)
            end = start;
        if (end <= start)
            end += 2 * NARC_PI;
        if (is_concave) { /* clockwise */
            const double last = start;
            start = end;
            end = last;
        }
        out_arcs[i] = (narc_arc){(double)r->center_x, (double)r->center_y, (double)r->radius, start, end};
    }
    return count;
}

/* The support function of the stored arcs, with room: the furthest of all arc ends, or a point inside the arc that has
 * the direction. */
static double find_stored_height(const narc_shape_header *header, const narc_record *arcs, double x, double y) {
    double best = -INFINITY, extent = 0;
    if (narc_is_piece(header)) {
        best = narc_find_front_height(header, arcs, x, y, narc_find_front_depth(header, arcs), &extent);
        return best + NARC_ROUNDING_ROOM * extent;
    }
    for (size_t i = 0; i < header->count; i++) {
        double ax = (double)arcs[i].arc.start_x, ay = (double)arcs[i].arc.start_y;
        double bx = (double)arcs[i].arc.end_x, by = (double)arcs[i].arc.end_y;
        double center = (double)arcs[i].arc.center_x * x + (double)arcs[i].arc.center_y * y,
               radius = (double)arcs[i].arc.radius;
        if (ax * y - ay * x >= 0 && x * by - y * bx >= 0)
            best = fmax(best, center + radius * sqrt(x * x + y * y));
        else
            best = fmax(best, center + radius * fmax(ax * x + ay * y, bx * x + by * y));
        extent = fmax(extent, fabs((double)arcs[i].arc.center_x) + fabs((double)arcs[i].arc.center_y) + radius);
    }
    return best + NARC_ROUNDING_ROOM * extent;
}

bool narc_get_aabb(const narc_shapes *shapes, uint32_t shape, float cosine, float sine, float scale,
                   narc_aabb *out_aabb) {
    if (!out_aabb || !narc_has_shape(shapes, shape))
        return false;
    const narc_shape_header *header = &shapes->headers[shape];
    const narc_record *arcs = narc_arcs_of(shapes, header);
    double length = narc_hypot((double)cosine, (double)sine), c = (double)cosine / length, s = (double)sine / length;
    double factor = (double)scale;
    if (!(length > 0) || !isfinite(length) || narc_is_plane(header))
        return false;
    /* The world's x axis is (c, -s) in the shape's axes, its y axis (s, c). */
    *out_aabb = (narc_aabb){.min_x = factor * -find_stored_height(header, arcs, -c, s),
                            .min_y = factor * -find_stored_height(header, arcs, -s, -c),
                            .max_x = factor * find_stored_height(header, arcs, c, -s),
                            .max_y = factor * find_stored_height(header, arcs, s, c)};
    return true;
}
