/* SPDX-License-Identifier: MIT
 *
 * strips.c - makes the strips of the broad phase: which boxes lie in each, and the columns that hold them.
 *
 * A level holds boxes of one world whose heights differ by less than a factor of 4 and whose widths by less than 16 (the lowest: all
 * down to 0). Its strips are as high as the highest box of its heights, h. With min_y / h rounded down as the number of
 * a box's strip, two boxes of a level that overlap are at most one strip apart, and a box overlaps boxes of a level
 * with higher strips only from one strip below its own min_y up to that of its max_y. The height has LEVEL_ROOM in it
 * for rounding: of a box's own height, 2^-24, and of the quotients of two boxes, each 2^-53 of MOST_STRIPS.
 */
#include "dispatch.h"
#include "steps.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LEVEL_ROOM 0x1p-20

/* Strips are counted from y = 0. Beyond so many, numbers in single precision are several h apart: a box there has no
 * height, and each number gets a strip of its own. */
#define MOST_STRIPS 0x1p26

/* Powers of two to a level. */
enum { HEIGHT_STEP = 2, WIDTH_STEP = 4, EXPONENTS = NARC_EXPONENTS };

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The power of two in a number >= 0, counted from the smallest. */
static uint32_t exponent_of(float value) { return bits_of(value) >> 23 & 0xff; }

/* ------------------------------------------------------------------------------------------------ levels */

/* Classes of sizes: from the largest down, some powers of two to a class. */
typedef struct classes {
    uint8_t of[EXPONENTS];
    float largest[EXPONENTS]; /* of each class */
    size_t count;
} classes;

/* What the passes over boxes and entries share. */
typedef struct passes {
    narc_broad_phase *broad;
    const narc_box *boxes;
    const narc_workers *workers;
    size_t parts; /* at most */
    classes heights, widths;
    narc_index_column world; /* base NULL: all are of world 0 */
    bool coarse;             /* worlds have such numbers that those of strips have no room: each level has one strip */
} passes;

static uint32_t world_of(const passes *p, size_t body) { return p->world.base ? narc_index_at(p->world, body) : 0; }

/* Returns how many parts there are. */
static size_t run_pass(passes *p, size_t count, narc_range *pass) {
    return narc_run_ranges(p->workers, count, narc_part_size(count, p->parts), pass, p);
}

static void add_size(float *largest, float size) {
    largest += exponent_of(size);
    if (size > *largest) /* rarely: nothing waits for a store */
        *largest = size;
}

static void count_part(void *argument, size_t part, size_t first, size_t end) {
    const passes *p = argument;
    const narc_box *const boxes = p->boxes;
    narc_strip_part *const own = &p->broad->parts[part];
    size_t found = 0;
    own->world = 0;
    for (int k = 0; k < EXPONENTS; k++)
        own->heights[k] = own->widths[k] = -1;
    for (size_t k = first; k < end; k++) {
        if (!narc_is_box(&boxes[k]))
            continue;
        add_size(own->heights, boxes[k].max_y - boxes[k].min_y);
        add_size(own->widths, boxes[k].max_x - boxes[k].min_x);
        found++;
    }
    own->count = found;
    for (size_t k = first; k < end && p->world.base; k++)
        own->world = world_of(p, k) > own->world ? world_of(p, k) : own->world;
}

static void make_classes(const float *largest, int step, classes *out) {
    *out = (classes){.count = 0};
    for (int k = EXPONENTS - 1; k >= 0; k--) {
        if (largest[k] < 0)
            continue;
        const int lowest = k >= step ? k - step + 1 : 0;
        out->largest[out->count] = largest[k];
        while (k > lowest)
            out->of[k--] = (uint8_t)out->count;
        out->of[k] = (uint8_t)out->count++;
    }
}

/* Makes the classes, and returns how many boxes are not empty. The entries of a part stand behind those before. */
static size_t count_boxes(passes *p, size_t count) {
    narc_strip_part *const all = p->broad->parts;
    size_t listed = 0;
    const size_t parts = run_pass(p, count, count_part);
    for (size_t part = 0; part < parts; part++) {
        const narc_strip_part *const own = &all[part];
        for (int k = 0; k < EXPONENTS; k++) {
            all->heights[k] = fmaxf(all->heights[k], own->heights[k]);
            all->widths[k] = fmaxf(all->widths[k], own->widths[k]);
        }
        all[part].start = listed;
        all->world = own->world > all->world ? own->world : all->world;
        listed += own->count;
    }
    if (parts > 0) {
        make_classes(all->heights, HEIGHT_STEP, &p->heights);
        make_classes(all->widths, WIDTH_STEP, &p->widths);
    }
    return listed;
}

/* Of each world. */
static uint64_t count_levels(const passes *p) { return (uint64_t)p->heights.count * (uint64_t)p->widths.count; }

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

static void list_part(void *argument, size_t part, size_t first, size_t end) {
    const passes *p = argument;
    const narc_box *const boxes = p->boxes;
    const size_t width_count = p->widths.count;
    narc_strip_part *const own = &p->broad->parts[part];
    const bool none_empty = own->count == end - first;
    narc_box_entry *to = p->broad->entries + own->start;
    double scale[EXPONENTS];
    int64_t lowest = INT64_MAX, highest = INT64_MIN;
    for (size_t k = 0; k < p->heights.count; k++)
        scale[k] = find_scale(&p->heights, k);
    for (size_t k = first; k < end; k++) {
        if (!none_empty && !narc_is_box(&boxes[k]))
            continue;
        const size_t height = p->heights.of[exponent_of(boxes[k].max_y - boxes[k].min_y)];
        const size_t width = p->widths.of[exponent_of(boxes[k].max_x - boxes[k].min_x)];
        const int64_t strip = strip_at(scale[height], boxes[k].min_y);
        lowest = strip < lowest ? strip : lowest;
        highest = strip > highest ? strip : highest;
        *to++ =
            (narc_box_entry){(uint64_t)(height * width_count + width) << STRIP_BITS | (uint64_t)(strip + STRIP_ZERO),
                             boxes[k].min_x, (uint32_t)k};
    }
    own->lowest = lowest;
    own->highest = highest;
}

/* Makes an entry's world, level and strip one number, (world * levels + level) * span + (strip - lowest). */
static void join_part(void *argument, size_t part, size_t first, size_t end) {
    const passes *const p = argument;
    const narc_broad_phase *const broad = p->broad;
    narc_box_entry *const entries = broad->entries;
    const uint64_t lowest = (uint64_t)(broad->lowest_strip + STRIP_ZERO), span = (uint64_t)broad->strip_span;
    const uint64_t levels = count_levels(p);
    (void)part;
    for (size_t k = first; k < end; k++) {
        const uint64_t level = entries[k].strip >> STRIP_BITS,
                       strip = entries[k].strip & (((uint64_t)1 << STRIP_BITS) - 1);
        entries[k].strip = (world_of(p, entries[k].body) * levels + level) * span + (p->coarse ? 0 : strip - lowest);
    }
}

/* More than any number of a world and its levels: then there is one strip. */
#define MOST_NUMBERS 0x1p63

/* Lists the entries of all boxes that are not empty: `listed` of them, at least one. Returns how many numbers strips
 * may have. */
static uint64_t list_entries(passes *p, size_t count, size_t listed) {
    int64_t lowest = INT64_MAX, highest = INT64_MIN;
    const uint64_t worlds = p->broad->parts->world; /* the highest */
    const size_t parts = run_pass(p, count, list_part);
    for (const narc_strip_part *own = p->broad->parts; own < p->broad->parts + parts; own++) {
        lowest = own->lowest < lowest ? own->lowest : lowest;
        highest = own->highest > highest ? own->highest : highest;
    }
    const uint64_t levels = (worlds + 1) * count_levels(p);
    p->coarse = (double)levels * (double)(highest - lowest + 2) > MOST_NUMBERS;
    p->broad->lowest_strip = p->coarse ? 0 : lowest;
    p->broad->strip_span = p->coarse ? 2 : highest - lowest + 2; /* one more: levels are not next to each other */
    run_pass(p, listed, join_part);
    return levels * (uint64_t)p->broad->strip_span;
}

/* ------------------------------------------------------------------------------------------------ strips */

static void list_strips_of_part(void *argument, size_t part, size_t first, size_t end) {
    narc_broad_phase *const broad = ((const passes *)argument)->broad;
    narc_strip *to = broad->strips + first;
    for (size_t k = first; k < end; k++)
        if (k == 0 || broad->entries[k].strip != broad->entries[k - 1].strip)
            *to++ = (narc_strip){.number = broad->entries[k].strip, .first = (uint32_t)k};
    broad->parts[part].start = first;
    broad->parts[part].count = (size_t)(to - broad->strips) - first;
}

/* Each part lists its strips where its entries are; then the lists move together. */
static void list_strips(passes *p, size_t listed) {
    narc_broad_phase *const broad = p->broad;
    const size_t parts = run_pass(p, listed, list_strips_of_part);
    size_t count = 0;
    for (const narc_strip_part *own = broad->parts; own < broad->parts + parts; own++) {
        memmove(broad->strips + count, broad->strips + own->start, own->count * sizeof *broad->strips);
        count += own->count;
    }
    broad->strip_count = count;
    for (size_t k = 0; k < count; k++)
        broad->strips[k].end = k + 1 < count ? broad->strips[k + 1].first : (uint32_t)listed;
}

/* The levels that have boxes, by worlds, and in each the highest strips first. */
static void list_levels(const passes *p) {
    narc_broad_phase *const broad = p->broad;
    broad->level_count = 0;
    for (size_t k = 0; k < broad->strip_count; k++) {
        const uint64_t number = broad->strips[k].number / (uint64_t)broad->strip_span;
        if (broad->level_count == 0 || broad->levels[broad->level_count - 1].number != number) {
            const narc_level *const before = broad->level_count > 0 ? &broad->levels[broad->level_count - 1] : NULL;
            const uint32_t world = (uint32_t)(number / count_levels(p));
            const size_t height = (size_t)(number % count_levels(p)) / p->widths.count;
            broad->levels[broad->level_count] =
                (narc_level){.number = number,
                             .scale = find_scale(&p->heights, height),
                             .first = (uint32_t)k,
                             .world = world,
                             .start = before && before->world == world ? before->start : (uint32_t)broad->level_count};
            broad->level_count++;
        }
        broad->levels[broad->level_count - 1].end = (uint32_t)(k + 1);
        broad->strips[k].level = (uint32_t)(broad->level_count - 1);
    }
}

void narc_fill_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes) {
    const narc_box_columns *const out = &broad->boxes;
    const size_t count = strip->end - strip->first;
    const narc_box_entry *const sorted =
        narc_sort_by_min_x(broad->entries + strip->first, broad->spare + strip->first, count);
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

/* Strips that a thread fills at a time. */
enum { FEW_STRIPS = 4 };

static void fill_strips(void *argument, size_t part, size_t first, size_t end) {
    const passes *p = argument;
    (void)part;
    for (size_t k = first; k < end; k++)
        narc_fill_strip(p->broad, &p->broad->strips[k], p->boxes);
}

void narc_end_columns(const narc_box_columns *boxes, size_t end) {
    for (size_t k = end; k < end + NARC_BOX_PADDING; k++) { /* read, and of no use */
        boxes->min_x[k] = boxes->max_x[k] = boxes->min_y[k] = boxes->max_y[k] = 0;
        boxes->body[k] = 0;
    }
}

void narc_make_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count, const narc_pair_filter *filter,
                      const narc_workers *workers) {
    passes p = {.broad = broad,
                .boxes = boxes,
                .workers = workers,
                .world = filter ? filter->world : (narc_index_column){NULL, 0},
                .parts = workers->count < NARC_STRIP_PARTS ? workers->count : NARC_STRIP_PARTS};
    const size_t listed = count_boxes(&p, count);
    if (listed > 0)
        narc_sort_by_strip(broad, listed, list_entries(&p, count, listed), p.parts, workers);
    list_strips(&p, listed);
    list_levels(&p);
    broad->sorted_count = listed;
    broad->unsorted_count = 0;
    narc_run_ranges(workers, broad->strip_count, FEW_STRIPS, fill_strips, &p);
    narc_end_columns(&broad->boxes, listed);
}
