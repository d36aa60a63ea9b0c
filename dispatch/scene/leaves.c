/* SPDX-License-Identifier: MIT
 *
 * leaves.c - bodies into the order of leaves: by halving, or along a curve.
 *
 * By halving: a node with room for n bodies has two halves for n / 2 each, side by side or one above the other, as its
 * bodies are spread further along x or y; and so on until there is room for one. The first half is always full. So the
 * bodies of a part are those from a multiple of its room on, whatever the boxes are, and all parts of a size are halved
 * at once.
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
    size_t count, part_size, parts;
    entry *from, *to;
    int shift;
    float min_x, min_y, scale; /* of the curve */
    struct part {
        narc_box bounds; /* of centres */
        uint32_t place[DIGITS];
    } part[MOST_PARTS];
} sorting;

static void begin_sorting(sorting *s, const narc_index *index, const narc_box *boxes, const narc_workers *workers) {
    const size_t count = index->count, few = count / LEAST_OF_PART + 1;
    const size_t parts = narc_count_workers(workers, few < MOST_PARTS ? few : MOST_PARTS);
    s->boxes = boxes;
    s->workers = workers;
    s->count = count;
    s->part_size = count / parts + (count % parts != 0);
    s->from = index->build_memory;
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

/* Lists all entries, sorts them, equal ones by their bodies, and lists their bodies in this order. */
static void sort_entries(sorting *s, narc_range *list_entries, uint32_t *out_bodies) {
    const size_t parts = narc_run_ranges(s->workers, s->count, s->part_size, list_entries, s);
    for (s->shift = 0; s->shift < 32; s->shift += DIGIT_BITS) {
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

/* ------------------------------------------------------------------------------------------------ halving */

/* Parts with room for so many bodies are halved by one worker down to the last. */
enum { PART = 4096 };

/* Of a float, a number that is larger if the float is, below that of an empty box. */
static uint32_t order_float(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static void list_by_x(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[k];
        const uint32_t key = order_float(halve_centre(box->min_x, box->max_x));
        s->from[k] = (entry){narc_is_full_box(box) ? key : UINT32_MAX, (uint32_t)k};
    }
}

static void list_by_y(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[k];
        const uint32_t key = order_float(halve_centre(box->min_y, box->max_y));
        s->from[k] = (entry){narc_is_full_box(box) ? key : UINT32_MAX, (uint32_t)k};
    }
}

typedef struct halving {
    const narc_box *boxes;
    uint32_t *by_x, *by_y, *spare;
    uint8_t *second; /* of each body: is it in the second half? */
    size_t room;     /* for the bodies of a part */
} halving;

/* Halves bodies first .. end - 1 of both lists; more than `half` of them. */
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

static void halve_all(const halving *h, size_t first, size_t end, size_t room) {
    for (size_t half = room / 2; end - first > 1; half /= 2)
        if (end - first > half) {
            halve(h, first, end, half);
            halve_all(h, first + half, end, half);
            end = first + half;
        }
}

static void halve_part(void *argument, size_t part, size_t first, size_t end) {
    const halving *const h = argument;
    (void)part;
    if (end - first > h->room / 2)
        halve(h, first, end, h->room / 2);
}

static void halve_last_part(void *argument, size_t part, size_t first, size_t end) {
    const halving *const h = argument;
    (void)part;
    halve_all(h, first, end, h->room);
}

void narc_halve_bodies(narc_index *index, const narc_box *boxes, const narc_workers *workers) {
    const size_t count = index->count;
    sorting s;
    begin_sorting(&s, index, boxes, workers);
    /* What is sorted is not wanted any more when halving begins. */
    halving h = {boxes, index->body, (uint32_t *)(void *)(s.from + 2 * count), index->build_memory, NULL, 1};
    h.second = (uint8_t *)(h.spare + count);
    sort_entries(&s, list_by_x, h.by_x);
    sort_entries(&s, list_by_y, h.by_y);
    size_t full = count; /* empty boxes are last in both */
    while (full > 0 && !narc_is_full_box(&boxes[h.by_x[full - 1]]))
        full--;
    while (h.room < count)
        h.room *= 2;
    for (; h.room > PART; h.room /= 2)
        narc_run_ranges(workers, full, h.room, halve_part, &h);
    narc_run_ranges(workers, full, h.room, halve_last_part, &h);
}

/* ------------------------------------------------------------------------------------------------ a curve */

static void find_bounds(void *argument, size_t part, size_t first, size_t end) {
    sorting *const s = argument;
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[k];
        const float x = halve_centre(box->min_x, box->max_x), y = halve_centre(box->min_y, box->max_y);
        const bool fine = narc_is_full_box(box);
        all.min_x = fine && x < all.min_x ? x : all.min_x;
        all.min_y = fine && y < all.min_y ? y : all.min_y;
        all.max_x = fine && x > all.max_x ? x : all.max_x;
        all.max_y = fine && y > all.max_y ? y : all.max_y;
    }
    s->part[part].bounds = all;
}

static void list_on_curve(void *argument, size_t part, size_t first, size_t end) {
    const sorting *const s = argument;
    const float min_x = s->min_x, min_y = s->min_y, scale = s->scale;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_box *const box = &s->boxes[k];
        const bool fine = narc_is_full_box(box);
        const float x = (halve_centre(box->min_x, box->max_x) - min_x) * scale;
        const float y = (halve_centre(box->min_y, box->max_y) - min_y) * scale;
        const uint32_t key =
            fine ? narc_spread_bits((uint32_t)(int32_t)x) | narc_spread_bits((uint32_t)(int32_t)y) << 1 : UINT32_MAX;
        s->from[k] = (entry){key, (uint32_t)k};
    }
}

void narc_sort_bodies_by_curve(narc_index *index, const narc_box *boxes, const narc_workers *workers) {
    narc_box all = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    sorting s;
    begin_sorting(&s, index, boxes, workers);
    const size_t parts = narc_run_ranges(workers, s.count, s.part_size, find_bounds, &s);
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
    sort_entries(&s, list_on_curve, index->body);
}
