/* SPDX-License-Identifier: MIT
 *
 * strips.c - sorts boxes into the strips of the broad phase.
 *
 * A level holds boxes whose heights differ by less than a factor of 4 and whose widths by less than 16 (the lowest: all
 * down to 0). Its strips are as high as the highest box of its heights, h. With min_y / h rounded down as the number of
 * a box's strip, two boxes of a level that overlap are at most one strip apart, and a box overlaps boxes of a level
 * with higher strips only from one strip below its own min_y up to that of its max_y. The height has LEVEL_ROOM in it
 * for rounding: of a box's own height, 2^-24, and of the quotients of two boxes, each 2^-53 of MOST_STRIPS.
 */
#include "steps.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LEVEL_ROOM 0x1p-20

/* Strips are counted from y = 0. Beyond so many, numbers in single precision are several h apart: a box there has no
 * height, and each number gets a strip of its own. */
#define MOST_STRIPS 0x1p26

/* Powers of two to a level. */
enum { HEIGHT_STEP = 2, WIDTH_STEP = 4, EXPONENTS = 256 };

/* Parts that the boxes are divided into, one for each thread. */
enum { MOST_PARTS = 16 };

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

/* ------------------------------------------------------------------------------------------------ levels */

/* Of each power of two the largest number, or -1. */
typedef struct sizes {
    float largest[EXPONENTS];
} sizes;

static void clear_sizes(sizes *of) {
    for (int k = 0; k < EXPONENTS; k++)
        of->largest[k] = -1;
}

static void add_size(sizes *to, float size) {
    float *const largest = &to->largest[exponent_of(size)];
    if (size > *largest) /* rarely: nothing waits for a store */
        *largest = size;
}

static void join_sizes(sizes *to, const sizes *from) {
    for (int k = 0; k < EXPONENTS; k++)
        to->largest[k] = from->largest[k] > to->largest[k] ? from->largest[k] : to->largest[k];
}

/* What all boxes have, and how many of each part are not empty. */
typedef struct census {
    sizes heights, widths;
    size_t start[MOST_PARTS + 1]; /* of each part's entries, if they are listed one part after another */
} census;

static void count_boxes(const narc_box *boxes, size_t count, int parts, census *out) {
    clear_sizes(&out->heights);
    clear_sizes(&out->widths);
    out->start[0] = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t end = narc_part_start(count, part + 1, parts);
        sizes heights, widths;
        size_t found = 0;
        clear_sizes(&heights);
        clear_sizes(&widths);
        for (size_t k = narc_part_start(count, part, parts); k < end; k++) {
            if (!is_box(&boxes[k]))
                continue;
            add_size(&heights, boxes[k].max_y - boxes[k].min_y);
            add_size(&widths, boxes[k].max_x - boxes[k].min_x);
            found++;
        }
        out->start[part + 1] = found;
#ifdef _OPENMP
#pragma omp critical(narc_count_boxes)
#endif
        {
            join_sizes(&out->heights, &heights);
            join_sizes(&out->widths, &widths);
        }
    }
    for (int part = 0; part < parts; part++)
        out->start[part + 1] += out->start[part];
}

/* Classes of sizes: from the largest down, some powers of two to a class. */
typedef struct classes {
    uint8_t of[EXPONENTS];
    float largest[EXPONENTS]; /* of each class */
    size_t count;
} classes;

static void make_classes(const sizes *from, int step, classes *out) {
    *out = (classes){.count = 0};
    for (int k = EXPONENTS - 1; k >= 0; k--) {
        if (from->largest[k] < 0)
            continue;
        const int lowest = k >= step ? k - step + 1 : 0;
        out->largest[out->count] = from->largest[k];
        while (k > lowest)
            out->of[k--] = (uint8_t)out->count;
        out->of[k] = (uint8_t)out->count++;
    }
}

/* One over the height of the strips of a class. */
static double find_scale(const classes *heights, size_t height_class) {
    return 1 / ((1 + LEVEL_ROOM) * fmax((double)heights->largest[height_class], (double)FLT_MIN));
}

/* ------------------------------------------------------------------------------------------------ entries */

/* The strip at a height, counted from y = 0. */
static int64_t strip_at(double scale, float y) {
    const double strip = (double)y * scale;
    if (fabs(strip) < MOST_STRIPS) {
        const int64_t towards_zero = (int64_t)strip;
        return towards_zero - ((double)towards_zero > strip);
    }
    const int64_t beyond = (int64_t)bits_of(fabsf(y)) - (int64_t)bits_of((float)(MOST_STRIPS / scale));
    const int64_t number = (int64_t)MOST_STRIPS + (beyond > 0 ? beyond : 0);
    return y < 0 ? -number - 1 : number;
}

uint64_t narc_strip_number(const narc_broad_phase *broad, const narc_level *level, float y, int64_t offset) {
    const int64_t strip = strip_at(level->scale, y) + offset - broad->lowest_strip;
    const int64_t last = broad->strip_span - 2, within = strip < 0 ? 0 : strip > last ? last : strip;
    return level->number * (uint64_t)broad->strip_span + (uint64_t)within;
}

/* An entry's level and strip until the range of strips is known. */
enum { STRIP_BITS = 40 };
#define STRIP_ZERO ((int64_t)1 << 34)

/* Lists the entries of all boxes that are not empty. */
static void list_entries(narc_broad_phase *broad, const narc_box *boxes, size_t count, int parts, const census *all,
                         const classes *heights, const classes *widths) {
    double scale[EXPONENTS];
    int64_t lowest = INT64_MAX, highest = INT64_MIN;
    for (size_t k = 0; k < heights->count; k++)
        scale[k] = find_scale(heights, k);
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(parts) reduction(min                                             \
                                                                       : lowest) reduction(max                         \
                                                                                           : highest) if (parts > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t first = narc_part_start(count, part, parts), end = narc_part_start(count, part + 1, parts);
        const bool none_empty = all->start[part + 1] - all->start[part] == end - first;
        narc_box_entry *to = broad->entries + all->start[part];
        for (size_t k = first; k < end; k++) {
            if (!none_empty && !is_box(&boxes[k]))
                continue;
            const size_t height = heights->of[exponent_of(boxes[k].max_y - boxes[k].min_y)];
            const size_t width = widths->of[exponent_of(boxes[k].max_x - boxes[k].min_x)];
            const int64_t strip = strip_at(scale[height], boxes[k].min_y);
            lowest = strip < lowest ? strip : lowest;
            highest = strip > highest ? strip : highest;
            *to++ = (narc_box_entry){(uint64_t)(height * widths->count + width) << STRIP_BITS |
                                         (uint64_t)(strip + STRIP_ZERO),
                                     boxes[k].min_x, (uint32_t)k};
        }
    }
    const bool any = lowest <= highest;
    broad->lowest_strip = any ? lowest : 0;
    broad->strip_span = any ? highest - lowest + 2 : 2; /* one more, so that levels are not next to each other */
}

/* An entry's level and strip as one number, once the range of strips is known. */
static uint64_t join_strip(uint64_t level_and_strip, int64_t lowest, int64_t span) {
    const uint64_t level = level_and_strip >> STRIP_BITS;
    const int64_t strip = (int64_t)(level_and_strip & (((uint64_t)1 << STRIP_BITS) - 1)) - STRIP_ZERO;
    return level * (uint64_t)span + (uint64_t)(strip - lowest);
}

/* ------------------------------------------------------------------------------------------------ sorting */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

/* One pass of a stable radix sort, from `entries` to `spare`, which change places. Each part counts its digits, and then
 * knows where those of the parts before it end. The first pass joins levels and strips. */
static void sort_by_digit(narc_broad_phase *broad, size_t count, int shift, int parts) {
    narc_box_entry *const from = broad->entries, *const to = broad->spare;
    const int64_t lowest = broad->lowest_strip, span = broad->strip_span;
    const bool first_pass = shift == 0;
    uint32_t place[MOST_PARTS][DIGITS];
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t end = narc_part_start(count, part + 1, parts);
        memset(place[part], 0, sizeof place[part]);
        for (size_t k = narc_part_start(count, part, parts); k < end; k++) {
            const uint64_t number = first_pass ? join_strip(from[k].strip, lowest, span) : from[k].strip;
            place[part][number >> shift & (DIGITS - 1)]++;
        }
    }
    uint32_t sum = 0;
    for (size_t k = 0; k < DIGITS; k++) {
        for (int part = 0; part < parts; part++) {
            const uint32_t here = place[part][k];
            place[part][k] = sum;
            sum += here;
        }
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t end = narc_part_start(count, part + 1, parts);
        for (size_t k = narc_part_start(count, part, parts); k < end; k++) {
            const uint64_t number = first_pass ? join_strip(from[k].strip, lowest, span) : from[k].strip;
            to[place[part][number >> shift & (DIGITS - 1)]++] = (narc_box_entry){number, from[k].min_x, from[k].body};
        }
    }
    broad->entries = to;
    broad->spare = from;
}

static bool begins_strip(const narc_box_entry *entries, size_t k) {
    return k == 0 || entries[k].strip != entries[k - 1].strip;
}

/* Each part lists its strips where its entries are; then the lists move together. */
static void list_strips(narc_broad_phase *broad, size_t listed, int parts) {
    size_t found[MOST_PARTS] = {0};
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(parts) if (parts > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t first = narc_part_start(listed, part, parts), end = narc_part_start(listed, part + 1, parts);
        narc_strip *to = broad->strips + first;
        for (size_t k = first; k < end; k++)
            if (begins_strip(broad->entries, k))
                *to++ = (narc_strip){.number = broad->entries[k].strip, .first = (uint32_t)k};
        found[part] = (size_t)(to - (broad->strips + first));
    }
    size_t count = 0;
    for (int part = 0; part < parts; part++) {
        const narc_strip *from = broad->strips + narc_part_start(listed, part, parts);
        memmove(broad->strips + count, from, found[part] * sizeof *from);
        count += found[part];
    }
    broad->strip_count = count;
    for (size_t k = 0; k < count; k++)
        broad->strips[k].end = k + 1 < count ? broad->strips[k + 1].first : (uint32_t)listed;
}

/* The levels that have boxes, the highest strips first. */
static void list_levels(narc_broad_phase *broad, const classes *heights, const classes *widths) {
    broad->level_count = 0;
    for (size_t k = 0; k < broad->strip_count; k++) {
        const uint64_t number = broad->strips[k].number / (uint64_t)broad->strip_span;
        if (broad->level_count == 0 || broad->levels[broad->level_count - 1].number != number)
            broad->levels[broad->level_count++] = (narc_level){
                .number = number, .scale = find_scale(heights, (size_t)number / widths->count), .first = (uint32_t)k};
        broad->levels[broad->level_count - 1].end = (uint32_t)(k + 1);
        broad->strips[k].level = (uint32_t)(broad->level_count - 1);
    }
}

size_t narc_sort_into_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count, int team) {
    const int parts = team < MOST_PARTS ? team : MOST_PARTS;
    census all;
    classes heights, widths;
    count_boxes(boxes, count, parts, &all);
    make_classes(&all.heights, HEIGHT_STEP, &heights);
    make_classes(&all.widths, WIDTH_STEP, &widths);
    list_entries(broad, boxes, count, parts, &all, &heights, &widths);
    const size_t listed = all.start[parts];
    const uint64_t numbers = (uint64_t)heights.count * (uint64_t)widths.count * (uint64_t)broad->strip_span;
    for (int shift = 0; shift < 64 && numbers >> shift > 0; shift += DIGIT_BITS)
        sort_by_digit(broad, listed, shift, parts);
    list_strips(broad, listed, parts);
    list_levels(broad, &heights, &widths);
    for (size_t k = listed; k < listed + NARC_BOX_PADDING; k++) { /* read, and of no use */
        broad->boxes.min_x[k] = broad->boxes.max_x[k] = broad->boxes.min_y[k] = broad->boxes.max_y[k] = 0;
        broad->boxes.body[k] = 0;
    }
    return listed;
}

/* ------------------------------------------------------------------------------------------------ within a strip */

/* Below so many entries, insertion is the faster sort. More go into buckets first, as many as there are entries; and where
 * buckets would hold more than one or two each, bytes are faster. */
enum { SMALL = 32, BUCKETS = 8192, MOST_FOR_BUCKETS = BUCKETS * 3 / 2, BYTE = 256 };

/* Insertion with at most `moves` moves: false if they are not enough. */
static bool insert_all(narc_box_entry *entries, size_t count, size_t moves) {
    for (size_t k = 1; k < count; k++) {
        const narc_box_entry moved = entries[k];
        size_t to = k;
        for (; to > 0 && entries[to - 1].min_x > moved.min_x; to--)
            entries[to] = entries[to - 1];
        entries[to] = moved;
        if (moves < k - to)
            return false;
        moves -= k - to;
    }
    return true;
}

/* Unsigned numbers in the order of floats. */
static uint32_t order_of(float x) {
    const uint32_t bits = bits_of(x);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* Radix sort, byte by byte, of all four; the result is in `entries` again. */
static void sort_by_bytes(narc_box_entry *entries, narc_box_entry *spare, size_t count) {
    uint32_t place[4][BYTE] = {0};
    for (size_t k = 0; k < count; k++)
        for (int byte = 0; byte < 4; byte++)
            place[byte][order_of(entries[k].min_x) >> 8 * byte & 0xff]++;
    for (int byte = 0; byte < 4; byte++) {
        uint32_t sum = 0;
        for (size_t k = 0; k < BYTE; k++) {
            const uint32_t here = place[byte][k];
            place[byte][k] = sum;
            sum += here;
        }
        for (size_t k = 0; k < count; k++)
            spare[place[byte][order_of(entries[k].min_x) >> 8 * byte & 0xff]++] = entries[k];
        narc_box_entry *const old = entries;
        entries = spare;
        spare = old;
    }
}

/* Sorts entries by buckets of equal widths, which brings those that are spread evenly nearly into their order, and by
 * insertion; others byte by byte. Returns where they are then. */
static narc_box_entry *sort_by_min_x(narc_box_entry *entries, narc_box_entry *spare, size_t count) {
    uint32_t place[BUCKETS + 1];
    float low = INFINITY, high = -INFINITY;
    bool in_order = true;
    if (count < SMALL) {
        insert_all(entries, count, SIZE_MAX);
        return entries;
    }
    for (size_t k = 0; k < count; k++) {
        const float x = entries[k].min_x;
        in_order = in_order && x >= high;
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    if (in_order)
        return entries;
    const size_t buckets = count < BUCKETS ? count : BUCKETS;
    const float scale = (float)(buckets - 1) / (high - low);
    /* Too many, nearly all in one place, or too far apart. */
    if (count > MOST_FOR_BUCKETS || !(scale > 0) || scale > FLT_MAX) {
        sort_by_bytes(entries, spare, count);
        return entries;
    }
    memset(place, 0, (buckets + 1) * sizeof *place);
    for (size_t k = 0; k < count; k++)
        place[1 + (uint32_t)((entries[k].min_x - low) * scale)]++;
    for (size_t k = 1; k < buckets; k++)
        place[k] += place[k - 1];
    for (size_t k = 0; k < count; k++)
        spare[place[(uint32_t)((entries[k].min_x - low) * scale)]++] = entries[k];
    if (!insert_all(spare, count, 2 * count))
        sort_by_bytes(spare, entries, count);
    return spare;
}

void narc_sort_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes) {
    const narc_box_columns *const out = &broad->boxes;
    const size_t count = strip->end - strip->first;
    const narc_box_entry *const sorted =
        sort_by_min_x(broad->entries + strip->first, broad->spare + strip->first, count);
    strip->min_y = INFINITY;
    strip->max_y = -INFINITY;
    float width = 0;
    for (size_t k = strip->first; k < strip->end; k++) {
        const uint32_t body = sorted[k - strip->first].body;
        const narc_box box = boxes[body];
        out->body[k] = body;
        out->min_x[k] = box.min_x;
        out->max_x[k] = box.max_x;
        out->min_y[k] = box.min_y;
        out->max_y[k] = box.max_y;
        strip->min_y = box.min_y < strip->min_y ? box.min_y : strip->min_y;
        strip->max_y = box.max_y > strip->max_y ? box.max_y : strip->max_y;
        width = box.max_x - box.min_x > width ? box.max_x - box.min_x : width;
    }
    strip->width = width * (1 + 0x1p-22f) + FLT_TRUE_MIN; /* no box is wider, for all rounding */
}
