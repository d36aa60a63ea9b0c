/* SPDX-License-Identifier: MIT
 *
 * leaves.c - bodies into the slots of leaves: by halving, or along a curve.
 *
 * By halving: a node with n slots has two halves of n / 2 each, side by side or one above the other, as its bodies are
 * spread further along x or y; and so on down to one slot. Bodies are spread evenly: which of them are those of a part
 * follows from its slots, whatever the boxes are, and all parts of a size are halved at once.
 *
 * All bodies are sorted once along x and once along y. A part is a range of both lists; halving it leaves one as it is,
 * and divides the other, in its order, by who is in which half. No time depends on where the boxes lie.
 */
#include "leaves.h"

#include "dispatch.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A quarter of the place of a box's centre twice: differences are finite. */
static float halve_centre(float min, float max) { return min * 0.25f + max * 0.25f; }

/* ------------------------------------------------------------------------------------------------ sorting */

/* A body and the number that it is sorted by. */
typedef struct entry {
    uint32_t key, body;
} entry;

/* Numbers are sorted by their digits, the lowest first, by so many workers at most. */
enum { DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS, MOST_PARTS = 16, LEAST_OF_PART = 2048 };

typedef struct sorting {
    const narc_box *boxes;
    const narc_workers *workers;
    const uint32_t *bodies; /* those that are sorted */
    size_t count, part_size, parts;
    entry *from, *to;
    int shift;
    float min_x, min_y, scale; /* of the curve */
    struct part {
        narc_box bounds; /* of centres */
        uint32_t place[DIGITS];
    } part[MOST_PARTS];
} sorting;

/* In the memory for building: two lists of bodies, and behind them what is sorted. */
static void begin_sorting(sorting *s, const narc_filling *f) {
    const size_t count = f->count, few = count / LEAST_OF_PART + 1;
    const size_t parts = narc_count_workers(f->workers, few < MOST_PARTS ? few : MOST_PARTS);
    s->boxes = f->boxes;
    s->workers = f->workers;
    s->bodies = f->index->build_memory;
    s->count = count;
    s->part_size = count / parts + 1;
    s->from = (entry *)(void *)((uint32_t *)f->index->build_memory + 2 * count);
    s->to = s->from + count;
}

static void count_digits(void *argument, size_t part, size_t first, size_t end) {
    sorting *const s = argument;
    uint32_t *const place = s->part[part].place;
    memset(place, 0, sizeof s->part[part].place);
    for (size_t k = first; k < end; k++)
        place[s->from[k].key >> s->shift & (DIGITS - 1)]++;
}

static void move_entries(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    uint32_t *const place = ((sorting *)argument)->part[part].place;
    const entry *const from = s->from;
    entry *const to = s->to;
    const int shift = s->shift;
    for (size_t k = first; k < end; k++) {
        const entry moved = from[k];
        to[place[moved.key >> shift & (DIGITS - 1)]++] = moved;
    }
}

/* So few entries are put into order one by one. */
enum { FEW = 64 };

static void insert_entries(entry *entries, size_t count) {
    for (size_t k = 1; k < count; k++) {
        const entry moved = entries[k];
        size_t to = k;
        for (; to > 0 && entries[to - 1].key > moved.key; to--)
            entries[to] = entries[to - 1];
        entries[to] = moved;
    }
}

/* Lists all entries, sorts them, equal ones as they were listed, and lists their bodies in this order. */
static void sort_entries(sorting *s, narc_range *list_entries, uint32_t *out_bodies) {
    const size_t parts = narc_run_ranges(s->workers, s->count, s->part_size, list_entries, s);
    if (s->count <= FEW)
        insert_entries(s->from, s->count);
    for (s->shift = 0; s->count > FEW && s->shift < 32; s->shift += DIGIT_BITS) {
        narc_run_ranges(s->workers, s->count, s->part_size, count_digits, s);
        narc_begin_places(s->part[0].place, DIGITS, sizeof *s->part / sizeof(uint32_t), parts);
        narc_run_ranges(s->workers, s->count, s->part_size, move_entries, s);
        entry *const sorted = s->to;
        s->to = s->from;
        s->from = sorted;
    }
    for (size_t k = 0; k < s->count; k++)
        out_bodies[k] = s->from[k].body;
}

/* How many of the bodies lie in front of a slot. */
static size_t count_before(const narc_filling *f, size_t slot) {
    return (size_t)(((uint64_t)slot * f->count + f->slots - 1) / f->slots);
}

/* Puts bodies, in their order, into the slots. */
static void fill_slots(const narc_filling *f, const uint32_t *bodies) {
    narc_index *const index = f->index;
    size_t done = 0;
    for (size_t k = 0; k < f->slots; k++) {
        const bool is_full = (uint64_t)done * f->slots < (uint64_t)(k + 1) * f->count;
        const uint32_t body = is_full ? bodies[done++] : UINT32_MAX;
        index->body[f->first + k] = body;
        if (is_full)
            index->place[body] = (uint32_t)(f->first + k);
    }
}

/* ------------------------------------------------------------------------------------------------ halving */

/* Parts of so many slots are halved by one worker down to the last. */
enum { PART = 4096 };

/* Of a float, a number that is larger if the float is. */
static uint32_t order_float(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static void list_by_x(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[s->bodies[k]];
        s->from[k] = (entry){order_float(halve_centre(box->min_x, box->max_x)), s->bodies[k]};
    }
}

static void list_by_y(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[s->bodies[k]];
        s->from[k] = (entry){order_float(halve_centre(box->min_y, box->max_y)), s->bodies[k]};
    }
}

typedef struct halving {
    const narc_filling *filling;
    const narc_box *boxes;
    uint32_t *by_x, *by_y, *spare;
    uint8_t *second; /* of each body: is it in the second half? */
    size_t room;     /* slots of a part */
} halving;

/* Halves bodies first .. end - 1 of both lists: `half` of them are the first half. */
static void halve(const halving *h, size_t first, size_t end, size_t half) {
    const narc_box *const left = &h->boxes[h->by_x[first]], *const right = &h->boxes[h->by_x[end - 1]];
    const narc_box *const low = &h->boxes[h->by_y[first]], *const high = &h->boxes[h->by_y[end - 1]];
    const float width = halve_centre(right->min_x, right->max_x) - halve_centre(left->min_x, left->max_x);
    const float height = halve_centre(high->min_y, high->max_y) - halve_centre(low->min_y, low->max_y);
    const bool along_y = height > width;
    const uint32_t *const kept = along_y ? h->by_y : h->by_x;
    uint32_t *const divided = along_y ? h->by_x : h->by_y, *const spare = h->spare + first;
    uint8_t *const second = h->second;
    for (size_t k = first; k < first + half; k++)
        second[kept[k]] = 0;
    for (size_t k = first + half; k < end; k++)
        second[kept[k]] = 1;
    size_t to = first, apart = 0;
    for (size_t k = first; k < end; k++) {
        const uint32_t body = divided[k];
        const size_t in_second = second[body];
        divided[to] = body;
        spare[apart] = body;
        to += 1 - in_second;
        apart += in_second;
    }
    memcpy(divided + to, spare, apart * sizeof *spare);
}

/* Halves bodies first .. end - 1 of slots from `slot` on, of which there are `room` at most, before end_slot. */
static void halve_all(const halving *h, size_t slot, size_t end_slot, size_t first, size_t end, size_t room) {
    for (size_t half = room / 2; end - first > 1; half /= 2)
        if (end_slot - slot > half) {
            const size_t middle = count_before(h->filling, slot + half);
            if (first < middle && middle < end)
                halve(h, first, end, middle - first);
            halve_all(h, slot + half, end_slot, middle, end, half);
            end_slot = slot + half;
            end = middle;
        }
}

static void halve_part(void *argument, size_t part, size_t slot, size_t end_slot) {
    const halving *const h = argument;
    const size_t middle_slot = slot + h->room / 2, first = count_before(h->filling, slot),
                 end = count_before(h->filling, end_slot);
    (void)part;
    if (end_slot > middle_slot && first < count_before(h->filling, middle_slot) &&
        count_before(h->filling, middle_slot) < end)
        halve(h, first, end, count_before(h->filling, middle_slot) - first);
}

static void halve_last_part(void *argument, size_t part, size_t slot, size_t end_slot) {
    const halving *const h = argument;
    (void)part;
    halve_all(h, slot, end_slot, count_before(h->filling, slot), count_before(h->filling, end_slot), h->room);
}

void narc_halve_bodies(const narc_filling *f) {
    sorting s;
    begin_sorting(&s, f);
    /* What is sorted is not wanted any more when halving begins. */
    uint32_t *const list = f->index->build_memory;
    halving h = {f, f->boxes, list, list + f->count, list + 2 * f->count, NULL, 1};
    h.second = (uint8_t *)(h.spare + f->count);
    sort_entries(&s, list_by_x, h.by_x);
    begin_sorting(&s, f);
    sort_entries(&s, list_by_y, h.by_y);
    while (h.room < f->slots)
        h.room *= 2;
    for (; h.room > PART; h.room /= 2)
        narc_run_ranges(f->workers, f->slots, h.room, halve_part, &h);
    narc_run_ranges(f->workers, f->slots, h.room, halve_last_part, &h);
    fill_slots(f, h.by_x);
}

/* ------------------------------------------------------------------------------------------------ a curve */

static void find_bounds(void *argument, size_t part, size_t first, size_t end) {
    sorting *const s = argument;
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[s->bodies[k]];
        const float x = halve_centre(box->min_x, box->max_x), y = halve_centre(box->min_y, box->max_y);
        all.min_x = x < all.min_x ? x : all.min_x;
        all.min_y = y < all.min_y ? y : all.min_y;
        all.max_x = x > all.max_x ? x : all.max_x;
        all.max_y = y > all.max_y ? y : all.max_y;
    }
    s->part[part].bounds = all;
}

static void list_on_curve(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    const float min_x = s->min_x, min_y = s->min_y, scale = s->scale;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[s->bodies[k]];
        const float x = (halve_centre(box->min_x, box->max_x) - min_x) * scale;
        const float y = (halve_centre(box->min_y, box->max_y) - min_y) * scale;
        s->from[k] = (entry){narc_spread_bits((uint32_t)(int32_t)x) | narc_spread_bits((uint32_t)(int32_t)y) << 1, s->bodies[k]};
    }
}

void narc_sort_bodies_by_curve(const narc_filling *f) {
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    sorting s;
    begin_sorting(&s, f);
    const size_t parts = narc_run_ranges(f->workers, s.count, s.part_size, find_bounds, &s);
    for (size_t part = 0; part < parts; part++) {
        const narc_box *const own = &s.part[part].bounds;
        all.min_x = own->min_x < all.min_x ? own->min_x : all.min_x;
        all.min_y = own->min_y < all.min_y ? own->min_y : all.min_y;
        all.max_x = own->max_x > all.max_x ? own->max_x : all.max_x;
        all.max_y = own->max_y > all.max_y ? own->max_y : all.max_y;
    }
    const float width = all.max_x - all.min_x, height = all.max_y - all.min_y;
    const float scale = 65535 / (width > height ? width : height);
    s.min_x = all.min_x;
    s.min_y = all.min_y;
    s.scale = scale > 0 && scale <= FLT_MAX ? scale : 0;
    sort_entries(&s, list_on_curve, f->index->build_memory);
    fill_slots(f, f->index->build_memory);
}
