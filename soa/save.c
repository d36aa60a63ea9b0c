/* SPDX-License-Identifier: MIT
 *
 * save.c - a store as bytes, and back.
 *
 * All numbers are little-endian, floats as their bits (IEEE 754). A start of 40 bytes:
 *   "NARCSHPS", version 3 (4 bytes), indices, removed indices, the last that was removed (4 bytes each; 2^32 - 1:
 * none),
 *   all bytes (8), a checksum of all other bytes (8)
 * and for each index
 *   uses (4); if that is 0 the index that was removed before it (4; 2^32 - 1: none); else
 *   count, first_arc, flags, extent_ratio (1 each) and six floats of the header, and of each arc eight words of 4
 * bytes,
 *   as in store.h. Angles and box follow from these.
 */
#include <string.h>

#include "encode.h"
#include "error.h"

static const char magic[8] = "NARCSHPS";

enum {
    VERSION = 3,
    AT_VERSION = 8,
    AT_COUNT = 12,
    AT_REMOVED = 16,
    AT_LAST = 20,
    AT_SIZE = 24,
    AT_CHECKSUM = 32,
    START = 40,
    HEADER_FLOATS = 6,
    HEADER_BYTES = 4 + 4 * HEADER_FLOATS,
    ARC_WORDS = 8,
    HOLE_BYTES = 8
};

/* Arcs, and behind those of a piece of a chain its solid. */
static size_t count_saved_records(unsigned count, unsigned first_arc) {
    return count + (first_arc & NARC_PIECE_MARKS ? 1 : 0);
}

static size_t count_shape_bytes(unsigned count, unsigned first_arc) {
    return 4 + HEADER_BYTES + count_saved_records(count, first_arc) * 4 * ARC_WORDS;
}

static void put_word(unsigned char *bytes, uint32_t word) {
    for (int k = 0; k < 4; k++)
        bytes[k] = (unsigned char)(word >> 8 * k);
}

static uint32_t get_word(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_words(unsigned char *bytes, const void *items, size_t count) {
    for (size_t k = 0; k < count; k++) {
        uint32_t word;
        memcpy(&word, (const char *)items + 4 * k, sizeof word);
        put_word(bytes + 4 * k, word);
    }
}

static void get_words(const unsigned char *bytes, void *out_items, size_t count) {
    for (size_t k = 0; k < count; k++) {
        const uint32_t word = get_word(bytes + 4 * k);
        memcpy((char *)out_items + 4 * k, &word, sizeof word);
    }
}

static void put_long(unsigned char *bytes, uint64_t value) {
    put_word(bytes, (uint32_t)value);
    put_word(bytes + 4, (uint32_t)(value >> 32));
}

static uint64_t get_long(const unsigned char *bytes) { return get_word(bytes) | (uint64_t)get_word(bytes + 4) << 32; }

/* FNV-1a, 64 bits. */
static uint64_t add_bytes(uint64_t hash, const unsigned char *bytes, size_t size) {
    for (size_t k = 0; k < size; k++)
        hash = (hash ^ bytes[k]) * 0x100000001b3u;
    return hash;
}

static uint64_t find_checksum(const unsigned char *bytes, size_t size) {
    const uint64_t hash = add_bytes(0xcbf29ce484222325u, bytes, AT_CHECKSUM);
    return add_bytes(hash, bytes + START, size - START);
}

/* ------------------------------------------------------------------------------------------------ saving */

size_t narc_count_saved_bytes(const narc_shapes *shapes) {
    size_t size = START;
    for (uint32_t k = 0; k < narc_count_shapes(shapes); k++)
        size += narc_has_shape(shapes, k) ? count_shape_bytes(shapes->headers[k].count, shapes->headers[k].first_arc)
                                          : HOLE_BYTES;
    return size;
}

static size_t put_shape(const narc_shapes *shapes, uint32_t shape, unsigned char *bytes) {
    const narc_shape_header *header = &shapes->headers[shape];
    const unsigned char small[4] = {header->count, header->first_arc, header->flags, header->extent_ratio};
    put_word(bytes, shapes->entries[shape].uses);
    memcpy(bytes + 4, small, sizeof small);
    put_words(bytes + 8, &header->bound_x, HEADER_FLOATS);
    put_words(bytes + 4 + HEADER_BYTES, narc_arcs_of(shapes, header),
              ARC_WORDS * count_saved_records(header->count, header->first_arc));
    return count_shape_bytes(header->count, header->first_arc);
}

narc_status narc_save_shapes(const narc_shapes *shapes, void *out_bytes, size_t size, narc_error *error) {
    if (!shapes || !out_bytes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", shapes ? "out_bytes" : "shapes");
    const size_t needed = narc_count_saved_bytes(shapes);
    if (size < needed)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)needed, "there is room for %zu bytes, not for %zu",
                         size, needed);
    unsigned char *const bytes = out_bytes, *at = bytes + START;
    memcpy(bytes, magic, sizeof magic);
    put_word(bytes + AT_VERSION, VERSION);
    put_word(bytes + AT_COUNT, (uint32_t)shapes->count);
    put_word(bytes + AT_REMOVED, (uint32_t)shapes->removed_count);
    put_word(bytes + AT_LAST, shapes->last_removed);
    put_long(bytes + AT_SIZE, needed);
    for (uint32_t k = 0; k < shapes->count; k++) {
        if (narc_has_shape(shapes, k)) {
            at += put_shape(shapes, k, at);
        } else {
            put_word(at, 0);
            put_word(at + 4, shapes->entries[k].next);
            at += HOLE_BYTES;
        }
    }
    put_long(bytes + AT_CHECKSUM, find_checksum(bytes, needed));
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ loading */

static narc_status fail_format(narc_error *error, size_t index, const char *what) {
    return narc_fail(error, NARC_ERROR_FORMAT, index, (double)index, "shape %zu: %s", index, what);
}

static narc_status check_start(const unsigned char *bytes, size_t size, narc_error *error) {
    if (size < START || memcmp(bytes, magic, sizeof magic) != 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "these bytes are no store of shapes");
    const uint32_t version = get_word(bytes + AT_VERSION);
    if (version != VERSION)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, version, "version %lu, this library reads %d",
                         (unsigned long)version, VERSION);
    if (get_long(bytes + AT_SIZE) != size)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, (double)size,
                         "there are %zu bytes, it had %.0f when it was saved", size, (double)get_long(bytes + AT_SIZE));
    if (get_long(bytes + AT_CHECKSUM) != find_checksum(bytes, size))
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the checksum is wrong, some byte is not as it was saved");
    const uint32_t count = get_word(bytes + AT_COUNT);
    if (count > NARC_MAX_SHAPES || count > (size - START) / HOLE_BYTES)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, count, "%lu indices in %zu bytes", (unsigned long)count, size);
    return NARC_OK;
}

/* Reads the shape at an index, `left` bytes behind its uses, and puts it there. */
static narc_status load_shape(narc_shapes *shapes, uint32_t index, uint32_t uses, const unsigned char *bytes,
                              size_t left, size_t *out_size, narc_error *error) {
    narc_encoded_shape encoded = {.header = {.first_record = 0}};
    narc_shape_header *header = &encoded.header;
    narc_error reason = {.status = NARC_OK};
    if (left < HEADER_BYTES || bytes[0] > NARC_MAX_ARCS || left < count_shape_bytes(bytes[0], bytes[1]) - 4)
        return fail_format(error, index, "its arcs are not there");
    header->count = bytes[0];
    header->first_arc = bytes[1];
    header->flags = bytes[2];
    header->extent_ratio = bytes[3];
    get_words(bytes + 4, &header->bound_x, HEADER_FLOATS);
    get_words(bytes + HEADER_BYTES, &encoded.records[narc_angle_records(header->count)],
              ARC_WORDS * count_saved_records(header->count, header->first_arc));
    if (narc_restore_shape(&encoded, &reason) != NARC_OK)
        return fail_format(error, index, reason.message);
    *out_size = count_shape_bytes(header->count, header->first_arc) - 4;
    const narc_status status = narc_put_encoded_shape(shapes, index, &encoded, error);
    if (status == NARC_OK)
        shapes->entries[index].uses = uses;
    return status;
}

/* Puts the removed indices in the order in which they were removed. Each is there once if, from the last on, each is
 * one that was not met before and there are as many as it says. */
static narc_status link_removed(narc_shapes *shapes, uint32_t last, uint32_t removed, narc_error *error) {
    uint32_t index = last, after = NARC_NO_SHAPE;
    if (removed != shapes->removed_count)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, removed, "%lu indices are removed, not %zu",
                         (unsigned long)removed, shapes->removed_count);
    for (uint32_t k = 0; k < removed; k++) {
        if (index >= shapes->count || shapes->entries[index].uses > 0 || shapes->entries[index].hash == 0)
            return fail_format(error, k, "removed indices are no list");
        shapes->entries[index].hash = 0;
        shapes->entries[index].before = after;
        after = index;
        index = shapes->entries[index].next;
    }
    if (index != NARC_NO_SHAPE)
        return fail_format(error, removed, "removed indices are no list");
    shapes->last_removed = last;
    return NARC_OK;
}

static narc_status load_all(narc_shapes *shapes, const unsigned char *bytes, size_t size, narc_error *error) {
    const uint32_t count = get_word(bytes + AT_COUNT);
    const unsigned char *at = bytes + START, *const end = bytes + size;
    narc_status status = count ? narc_make_room(shapes, count, 1, false) : NARC_OK;
    if (status != NARC_OK)
        return narc_fail(error, status, 0, count, "no memory for %lu shapes", (unsigned long)count);
    narc_open_indices(shapes, count);
    for (uint32_t k = 0; k < count; k++) {
        if ((size_t)(end - at) < HOLE_BYTES)
            return fail_format(error, k, "its arcs are not there");
        const uint32_t uses = get_word(at);
        size_t behind = 4;
        if (uses) {
            status = load_shape(shapes, k, uses, at + 4, (size_t)(end - at) - 4, &behind, error);
            if (status != NARC_OK)
                return status;
        }
        at += 4 + behind;
    }
    if (at != end)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "there are bytes behind the last shape");
    /* All shapes are there: the links of the others are free. */
    at = bytes + START;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t uses = get_word(at);
        if (uses == 0)
            shapes->entries[k] = (narc_shape_entry){.hash = 1, .next = get_word(at + 4)}; /* 1: not met before */
        at += uses ? count_shape_bytes(at[4], at[5]) : HOLE_BYTES;
    }
    return link_removed(shapes, get_word(bytes + AT_LAST), get_word(bytes + AT_REMOVED), error);
}

narc_status narc_load_shapes(const narc_allocator *allocator, const void *bytes, size_t size, narc_shapes **out_shapes,
                             narc_error *error) {
    narc_shapes *shapes = NULL;
    if (!bytes || !out_shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", bytes ? "out_shapes" : "bytes");
    narc_status status = check_start(bytes, size, error);
    if (status != NARC_OK)
        return status;
    status = narc_create_shapes(allocator, &shapes);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, 0, "no store: %s", narc_status_name(status));
    status = load_all(shapes, bytes, size, error);
    if (status == NARC_OK)
        *out_shapes = shapes;
    else
        narc_destroy_shapes(shapes);
    return status;
}
