/* SPDX-License-Identifier: MIT
 *
 * strips.c - sorts boxes into the strips of the broad phase.
 *
 * A level holds boxes whose heights differ by less than a factor of four (the lowest: all down to 0); its strips are as
 * high as its highest box, h. With min_y / h rounded down as the number of a box's strip, two boxes of a level that overlap are at most one strip
 * apart, and a box overlaps boxes of a level with higher strips only from one strip below its own min_y up to that of
 * its max_y. The height has LEVEL_ROOM in it for rounding: of a box's own height, 2^-24, and of the quotients of two
 * boxes, each 2^-53 of MAX_STRIP.
 */
#include "broad_phase_steps.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LEVEL_ROOM 0x1p-20

/* Strips are counted from y = 0. Beyond this, the distance of single-precision numbers is more than a strip's height. */
#define MAX_STRIP 0x1p30

static bool is_box(const narc_box *box) {
    return box->min_x <= box->max_x && box->min_y <= box->max_y && fabsf(box->min_x) <= FLT_MAX &&
           fabsf(box->max_x) <= FLT_MAX && fabsf(box->min_y) <= FLT_MAX && fabsf(box->max_y) <= FLT_MAX;
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The power of two in a number >= 0, counted from the smallest. */
static uint32_t exponent_of(float value) { return bits_of(value) >> 23 & 0xff; }

enum { EXPONENTS = 256 };

/* The levels that these boxes need: from the highest boxes down, two powers of two to a level. */
static void choose_levels(narc_broad_phase *broad, const narc_box *boxes, size_t count, uint8_t level_of[EXPONENTS]) {
    float highest[EXPONENTS];
    for (int k = 0; k < EXPONENTS; k++)
        highest[k] = -1;
    for (size_t k = 0; k < count; k++) {
        if (is_box(&boxes[k])) {
            const float height = boxes[k].max_y - boxes[k].min_y;
            float *const other = &highest[exponent_of(height)];
            *other = height > *other ? height : *other;
        }
    }
    broad->level_count = 0;
    for (int k = EXPONENTS - 1; k >= 0; k--) {
        if (highest[k] < 0)
            continue;
        const double height = (1 + LEVEL_ROOM) * fmax((double)highest[k], (double)FLT_MIN);
        level_of[k] = (uint8_t)broad->level_count;
        if (k > 0)
            level_of[k - 1] = (uint8_t)broad->level_count;
        broad->scale[broad->level_count++] = 1 / height;
        k -= 1;
    }
}

/* The strip at a height, in a level. */
static int64_t strip_at(const narc_broad_phase *broad, size_t level, float y) {
    return (int64_t)floor(fmin(fmax((double)y * broad->scale[level], -MAX_STRIP), MAX_STRIP));
}

uint64_t narc_strip_number(const narc_broad_phase *broad, size_t level, float y, int64_t offset) {
    const int64_t strip = strip_at(broad, level, y) + offset - broad->lowest_strip;
    const int64_t last = broad->strip_span - 2, within = strip < 0 ? 0 : strip > last ? last : strip;
    return (uint64_t)level * (uint64_t)broad->strip_span + (uint64_t)within;
}

/* Unsigned numbers in the order of floats. */
static uint32_t order_of(float x) {
    const uint32_t bits = bits_of(x);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* Lists the entries of all boxes that are not empty; returns how many. */
static size_t list_entries(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                           const uint8_t level_of[EXPONENTS]) {
    int64_t lowest = INT64_MAX, highest = INT64_MIN;
    size_t listed = 0;
    for (size_t k = 0; k < count; k++) {
        if (!is_box(&boxes[k]))
            continue;
        const size_t level = level_of[exponent_of(boxes[k].max_y - boxes[k].min_y)];
        const int64_t strip = strip_at(broad, level, boxes[k].min_y);
        lowest = strip < lowest ? strip : lowest;
        highest = strip > highest ? strip : highest;
        /* The level and the strip for now; the number when the range of strips is known. */
        broad->entries[listed++] = (narc_box_entry){(uint64_t)level << 32 | (uint32_t)(strip + ((int64_t)1 << 31)),
                                                    order_of(boxes[k].min_x), (uint32_t)k};
    }
    broad->lowest_strip = lowest;
    broad->strip_span = listed > 0 ? highest - lowest + 2 : 2; /* one more, so that levels are not next to each other */
    for (size_t k = 0; k < listed; k++) {
        narc_box_entry *const entry = &broad->entries[k];
        const int64_t strip = (int64_t)(uint32_t)entry->strip - ((int64_t)1 << 31);
        entry->strip = (entry->strip >> 32) * (uint64_t)broad->strip_span + (uint64_t)(strip - lowest);
    }
    return listed;
}

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

/* One pass of a stable radix sort. */
static void sort_by_digit(const narc_box_entry *from, narc_box_entry *to, size_t count, int shift) {
    uint32_t place[DIGITS] = {0};
    for (size_t k = 0; k < count; k++)
        place[from[k].strip >> shift & (DIGITS - 1)]++;
    uint32_t sum = 0;
    for (size_t k = 0; k < DIGITS; k++) {
        const uint32_t here = place[k];
        place[k] = sum;
        sum += here;
    }
    for (size_t k = 0; k < count; k++)
        to[place[from[k].strip >> shift & (DIGITS - 1)]++] = from[k];
}

static void swap_entries(narc_broad_phase *broad) {
    narc_box_entry *const old = broad->entries;
    broad->entries = broad->spare;
    broad->spare = old;
}

static void list_strips(narc_broad_phase *broad, size_t listed) {
    broad->strip_count = 0;
    for (size_t k = 0; k < listed; k++) {
        const uint64_t number = broad->entries[k].strip;
        if (k == 0 || number != broad->strips[broad->strip_count - 1].number)
            broad->strips[broad->strip_count++] = (narc_strip){.number = number, .first = (uint32_t)k};
        broad->strips[broad->strip_count - 1].end = (uint32_t)(k + 1);
    }
}

size_t narc_sort_into_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count) {
    uint8_t level_of[EXPONENTS] = {0};
    choose_levels(broad, boxes, count, level_of);
    const size_t listed = list_entries(broad, boxes, count, level_of);
    const uint64_t numbers = (uint64_t)broad->level_count * (uint64_t)broad->strip_span;
    for (int shift = 0; shift < 64 && numbers >> shift > 0; shift += DIGIT_BITS) {
        sort_by_digit(broad->entries, broad->spare, listed, shift);
        swap_entries(broad);
    }
    list_strips(broad, listed);
    for (size_t k = 0; k < NARC_BOX_PADDING; k++) /* read, and of no use */
        broad->boxes.min_x[listed + k] = broad->boxes.max_x[listed + k] = broad->boxes.min_y[listed + k] =
            broad->boxes.max_y[listed + k] = 0;
    return listed;
}

/* ------------------------------------------------------------------------------------------------ within a strip */

/* Below so many entries, insertion is the faster sort. */
enum { SMALL = 48, BYTE = 256 };

static void sort_few(narc_box_entry *entries, size_t count) {
    for (size_t k = 1; k < count; k++) {
        const narc_box_entry moved = entries[k];
        size_t to = k;
        for (; to > 0 && entries[to - 1].min_x > moved.min_x; to--)
            entries[to] = entries[to - 1];
        entries[to] = moved;
    }
}

/* Radix sort, byte by byte, of all four; the result is in `entries` again. */
static void sort_many(narc_box_entry *entries, narc_box_entry *spare, size_t count) {
    uint32_t place[4][BYTE] = {0};
    for (size_t k = 0; k < count; k++)
        for (int byte = 0; byte < 4; byte++)
            place[byte][entries[k].min_x >> 8 * byte & 0xff]++;
    for (int byte = 0; byte < 4; byte++) {
        uint32_t sum = 0;
        for (size_t k = 0; k < BYTE; k++) {
            const uint32_t here = place[byte][k];
            place[byte][k] = sum;
            sum += here;
        }
        for (size_t k = 0; k < count; k++)
            spare[place[byte][entries[k].min_x >> 8 * byte & 0xff]++] = entries[k];
        narc_box_entry *const old = entries;
        entries = spare;
        spare = old;
    }
}

void narc_sort_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes) {
    const narc_box_columns *const out = &broad->boxes;
    const size_t count = strip->end - strip->first;
    if (count < SMALL)
        sort_few(broad->entries + strip->first, count);
    else
        sort_many(broad->entries + strip->first, broad->spare + strip->first, count);
    strip->min_y = INFINITY;
    strip->max_y = -INFINITY;
    for (size_t k = strip->first; k < strip->end; k++) {
        const uint32_t body = broad->entries[k].body;
        const narc_box box = boxes[body];
        out->body[k] = body;
        out->min_x[k] = box.min_x;
        out->max_x[k] = box.max_x;
        out->min_y[k] = box.min_y;
        out->max_y[k] = box.max_y;
        strip->min_y = box.min_y < strip->min_y ? box.min_y : strip->min_y;
        strip->max_y = box.max_y > strip->max_y ? box.max_y : strip->max_y;
    }
}
