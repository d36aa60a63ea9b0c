/* SPDX-License-Identifier: MIT
 *
 * sort.c - sorts the entries of boxes: by strip, then those of a strip by min_x.
 *
 * Both divide entries by counting: how many go to each place, where those of each place begin, then each to its own. A
 * number is sorted by its digits, the lowest first, since equal ones stay in order.
 */
#include "dispatch.h"
#include "steps.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { DIGIT_BITS = 11, DIGITS = NARC_DIGITS };
_Static_assert(DIGITS == 1 << DIGIT_BITS, "digits have that many bits");

/* Where an entry goes: into buckets of equal widths of min_x, or by a digit. */
typedef struct division {
    float low, scale;
    int shift;
} division;

typedef size_t find_place(const narc_box_entry *entry, const division *by);

static void exchange(narc_box_entry **one, narc_box_entry **other) {
    narc_box_entry *const first = *one;
    *one = *other;
    *other = first;
}

static inline void count_places(const narc_box_entry *from, size_t count, find_place *find, const division *by,
                                uint32_t *place, size_t places) {
    memset(place, 0, places * sizeof *place);
    for (size_t k = 0; k < count; k++)
        place[find(&from[k], by)]++;
}

static inline void move_to_places(const narc_box_entry *from, size_t count, find_place *find, const division *by,
                                  uint32_t *place, narc_box_entry *to) {
    for (size_t k = 0; k < count; k++)
        to[place[find(&from[k], by)]++] = from[k];
}

/* ------------------------------------------------------------------------------------------------ by strip */

typedef struct strip_pass {
    narc_broad_phase *broad;
    division by;
} strip_pass;

static size_t find_strip_digit(const narc_box_entry *entry, const division *by) {
    return entry->strip >> by->shift & (DIGITS - 1);
}

static void count_part(void *argument, size_t part, size_t first, size_t end) {
    const strip_pass *p = argument;
    const division by = p->by;
    count_places(p->broad->entries + first, end - first, find_strip_digit, &by, p->broad->parts[part].place, DIGITS);
}

static void move_part(void *argument, size_t part, size_t first, size_t end) {
    const strip_pass *p = argument;
    const division by = p->by;
    move_to_places(p->broad->entries + first, end - first, find_strip_digit, &by, p->broad->parts[part].place,
                   p->broad->spare);
}

/* Each part counts its digits, and then knows where those of the parts before it end. */
void narc_sort_by_strip(narc_broad_phase *broad, size_t count, uint64_t limit, size_t parts,
                        const narc_workers *workers) {
    const size_t size = narc_part_size(count, parts);
    for (strip_pass p = {.broad = broad}; p.by.shift < 64 && limit >> p.by.shift > 0; p.by.shift += DIGIT_BITS) {
        const size_t used = narc_run_ranges(workers, count, size, count_part, &p);
        narc_begin_places(broad->parts->place, DIGITS, sizeof *broad->parts / sizeof(uint32_t), used);
        narc_run_ranges(workers, count, size, move_part, &p);
        exchange(&broad->entries, &broad->spare);
    }
}

/* ------------------------------------------------------------------------------------------------ by min_x */

/* Below so many entries, insertion is the faster sort. More go into buckets first, as many as there are entries; and
 * where buckets would hold more than one or two each, digits are faster. */
enum { SMALL = 32, BUCKETS = 8192, MOST_FOR_BUCKETS = BUCKETS * 3 / 2 };

/* Sorts by insertion with at most `moves` moves; false if they are not enough: then all entries are still there. */
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

static size_t find_bucket(const narc_box_entry *entry, const division *by) {
    return (uint32_t)((entry->min_x - by->low) * by->scale);
}

/* Of unsigned numbers in the order of floats. */
static size_t find_digit(const narc_box_entry *entry, const division *by) {
    uint32_t bits;
    memcpy(&bits, &entry->min_x, sizeof bits);
    return (bits & 0x80000000u ? ~bits : bits | 0x80000000u) >> by->shift & (DIGITS - 1);
}

static inline void divide(const narc_box_entry *from, size_t count, find_place *find, const division *by,
                          uint32_t *place, size_t places, narc_box_entry *to) {
    count_places(from, count, find, by, place, places);
    narc_begin_places(place, places, 0, 1);
    move_to_places(from, count, find, by, place, to);
}

/* Buckets of equal widths bring entries that are spread evenly nearly into their order, which insertion completes. */
narc_box_entry *narc_sort_by_min_x(narc_box_entry *entries, narc_box_entry *spare, size_t count) {
    uint32_t place[BUCKETS];
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
    division by = {.low = low, .scale = (float)(buckets - 1) / (high - low)};
    /* Not too many, nor nearly all in one place, nor too far apart. */
    if (count <= MOST_FOR_BUCKETS && by.scale > 0 && by.scale <= FLT_MAX) {
        divide(entries, count, find_bucket, &by, place, buckets, spare);
        if (insert_all(spare, count, 2 * count))
            return spare;
    }
    for (; by.shift < 32; by.shift += DIGIT_BITS) {
        divide(entries, count, find_digit, &by, place, DIGITS, spare);
        exchange(&entries, &spare);
    }
    return entries;
}
