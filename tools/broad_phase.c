/* SPDX-License-Identifier: MIT
 *
 * broad_phase.c - sort-and-sweep, in regions that are halved until a sweep is cheap.
 *
 * Coordinates are replaced by ranks: a box begins, along an axis, at its place in the order of all lower sides, and
 * ends at the last box whose lower side is not above its own upper side. Two boxes overlap along the axis exactly if
 * these intervals of ranks do, so from there on only integers are compared, and neither far-away bodies nor crowds need
 * a grid size. A region of the rank plane lists the boxes that reach into it, in order of x. While cutting it in two
 * along x or y sorts most boxes to one side, it is cut; then a sweep along x finds the overlaps. A pair may meet in
 * several regions; it belongs to the one with the point (later beginning in x, later beginning in y).
 */
#include "broad_phase.h"

#include <assert.h>
#include <inttypes.h>
#include <stdlib.h>

#include "fail.h"
#include "progress.h"

/* Lists this short are swept. Longer ones are cut if no part keeps more than 3/4 of the boxes and both together list at
 * most 3/2 of them. So all lists that live at one time hold at most 1 + 3/4 + (3/4)^2 + ... = 4 entries per box. */
enum { SHORT_LIST = 48 };

enum { REPORT_EVERY = 4096 }; /* steps of a long sweep between two reports */

typedef struct item {
    uint32_t body;
    uint32_t x_last; /* the item's x_first is its place in the list */
    uint32_t y_first, y_last;
} item;

typedef struct region {
    uint32_t x_first, x_last, y_first, y_last; /* ranks, both ends included */
} region;

typedef struct search {
    const item *items;
    size_t count;
    size_t *cursor; /* for each body a, moved on by one for each pair (a, b) */
    pair *pairs;    /* where cursor points to; NULL: pairs are only counted */
    uint64_t steps; /* pairs looked at */
    double covered; /* ranks squared that were swept, for the progress line */
} search;

/* ---------------------------------------------------------------------------- ranks */

typedef struct side {
    double value;
    uint32_t box;
} side;

static int compare_sides(const void *left, const void *right) {
    const side *a = left, *b = right;
    return a->value != b->value ? (a->value > b->value) - (a->value < b->value) : (a->box > b->box) - (a->box < b->box);
}

/* The last of the sorted sides that is not above `value`; there is one. */
static uint32_t last_not_above(const side *sides, size_t count, double value) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (sides[middle].value <= value)
            low = middle + 1;
        else
            high = middle;
    }
    return (uint32_t)(low - 1);
}

/* The boxes as intervals of ranks, in order of x. */
static item *rank_boxes(const narc_aabb *boxes, size_t count) {
    item *items = allocate(count, sizeof *items);
    uint32_t *place = allocate(count, sizeof *place); /* of each box in `items` */
    side *sides = allocate(count, sizeof *sides);
    for (size_t i = 0; i < count; i++)
        sides[i] = (side){boxes[i].min_x, (uint32_t)i};
    qsort(sides, count, sizeof *sides, compare_sides);
    for (size_t k = 0; k < count; k++) {
        show_progress("broad phase, sorting", k, 2 * count);
        const uint32_t box = sides[k].box;
        items[k].body = box;
        items[k].x_last = last_not_above(sides, count, boxes[box].max_x);
        place[box] = (uint32_t)k;
    }
    for (size_t i = 0; i < count; i++)
        sides[i] = (side){boxes[i].min_y, (uint32_t)i};
    qsort(sides, count, sizeof *sides, compare_sides);
    for (size_t k = 0; k < count; k++) {
        show_progress("broad phase, sorting", count + k, 2 * count);
        const uint32_t box = sides[k].box;
        items[place[box]].y_first = (uint32_t)k;
        items[place[box]].y_last = last_not_above(sides, count, boxes[box].max_y);
    }
    free(place);
    free(sides);
    return items;
}

/* ---------------------------------------------------------------------------- how many */

/* Fenwick trees of counts: entry i of `tree` (from 1) holds those of the places i - (i & -i) .. i - 1. */
static void add_at(uint32_t *tree, size_t count, uint32_t place, uint32_t change) {
    for (size_t i = (size_t)place + 1; i <= count; i += i & (~i + 1))
        tree[i] += change;
}

static uint32_t sum_below(const uint32_t *tree, size_t place) {
    uint32_t sum = 0;
    for (; place > 0; place &= place - 1)
        sum += tree[place];
    return sum;
}

/* Counts overlapping pairs without looking at them, in n log n steps: a line moves along x over the boxes that it
 * meets. Of these, the ones that overlap the next box along y have begun at its end and not ended before its
 * beginning. */
static uint64_t count_overlaps(const item *items, size_t count) {
    uint32_t *begun = allocate(count + 1, sizeof *begun), *ended = allocate(count + 1, sizeof *ended);
    uint32_t *last = allocate(count, sizeof *last),
             *next = allocate(count, sizeof *next); /* lists of boxes by x_last */
    for (size_t k = 0; k < count; k++) {
        begun[k + 1] = ended[k + 1] = 0;
        last[k] = UINT32_MAX;
    }
    uint64_t found = 0;
    for (uint32_t k = 0; k < count; k++) {
        const item *box = &items[k];
        found += sum_below(begun, (size_t)box->y_last + 1) - sum_below(ended, box->y_first);
        add_at(begun, count, box->y_first, 1);
        add_at(ended, count, box->y_last, 1);
        next[k] = last[box->x_last];
        last[box->x_last] = k;
        for (uint32_t gone = last[k]; gone != UINT32_MAX; gone = next[gone]) {
            add_at(begun, count, items[gone].y_first, UINT32_MAX); /* -1 */
            add_at(ended, count, items[gone].y_last, UINT32_MAX);
        }
    }
    free(begun);
    free(ended);
    free(last);
    free(next);
    return found;
}

/* ---------------------------------------------------------------------------- regions */

/* Tells how far the search is when the fraction `part` of a region has been swept. */
static void report(const search *in, region where, double part) {
    const double area =
        ((double)(where.x_last - where.x_first) + 1) * ((double)(where.y_last - where.y_first) + 1) * part;
    const double all = (double)in->count * (double)in->count;
    show_progress(in->pairs ? "broad phase, pairs" : "broad phase, counting",
                  (size_t)(1e6 * (in->covered + area) / all), 1000000);
}

static void sweep(search *in, const uint32_t *list, size_t count, region where) {
    for (size_t p = 0; p < count; p++) {
        const item *first = &in->items[list[p]];
        for (size_t q = p + 1; q < count && list[q] <= first->x_last; q++) {
            const item *second = &in->items[list[q]];
            if (++in->steps % REPORT_EVERY == 0)
                report(in, where, (double)p / (double)count);
            const uint32_t x = list[q], y = first->y_first > second->y_first ? first->y_first : second->y_first;
            if (y > first->y_last || y > second->y_last || x < where.x_first || x > where.x_last || y < where.y_first ||
                y > where.y_last)
                continue;
            const bool in_order = first->body < second->body;
            const uint32_t a = in_order ? first->body : second->body, b = in_order ? second->body : first->body;
            if (in->pairs)
                in->pairs[in->cursor[a]] = (pair){a, b};
            in->cursor[a]++;
        }
    }
    report(in, where, 1);
    in->covered += ((double)(where.x_last - where.x_first) + 1) * ((double)(where.y_last - where.y_first) + 1);
}

/* A cut: ranks below `at` lie on the low side. */
typedef struct cut {
    bool along_y;
    uint32_t at;
    size_t low, high; /* boxes on either side */
} cut;

static bool is_low(const search *in, uint32_t k, const cut *by) {
    return (by->along_y ? in->items[k].y_first : k) < by->at;
}

static bool is_high(const search *in, uint32_t k, const cut *by) {
    return (by->along_y ? in->items[k].y_last : in->items[k].x_last) >= by->at;
}

/* Cuts the list at the middle box along x, or at the mean beginning along y. */
static cut make_cut(const search *in, const uint32_t *list, size_t count, region where, bool along_y) {
    cut made = {.along_y = along_y, .at = list[count / 2]};
    if (along_y) {
        double sum = 0;
        for (size_t p = 0; p < count; p++) {
            const uint32_t begin = in->items[list[p]].y_first;
            sum += begin > where.y_first ? begin : where.y_first;
        }
        made.at = (uint32_t)(sum / (double)count);
    }
    for (size_t p = 0; p < count; p++) {
        made.low += is_low(in, list[p], &made);
        made.high += is_high(in, list[p], &made);
    }
    return made;
}

static bool is_useful(const cut *made, size_t count) {
    const size_t larger = made->low > made->high ? made->low : made->high;
    return larger <= count - count / 4 && made->low + made->high <= count + count / 2;
}

static void search_region(search *in, const uint32_t *list, size_t count, region where) {
    cut best = {0};
    bool useful = false;
    if (count > SHORT_LIST) {
        best = make_cut(in, list, count, where, true);
        const cut other = make_cut(in, list, count, where, false);
        useful = is_useful(&best, count);
        if (is_useful(&other, count) && (!useful || other.low + other.high < best.low + best.high)) {
            best = other;
            useful = true;
        }
    }
    if (!useful) {
        sweep(in, list, count, where);
        return;
    }
    uint32_t *part = allocate(best.low > best.high ? best.low : best.high, sizeof *part);
    for (int high = 0; high < 2; high++) {
        size_t length = 0;
        for (size_t p = 0; p < count; p++)
            if (high ? is_high(in, list[p], &best) : is_low(in, list[p], &best))
                part[length++] = list[p];
        region half = where;
        uint32_t *low_end = best.along_y ? &half.y_last : &half.x_last;
        uint32_t *high_begin = best.along_y ? &half.y_first : &half.x_first;
        if (high)
            *high_begin = best.at;
        else
            *low_end = best.at - 1;
        search_region(in, part, length, half);
    }
    free(part);
}

static int compare_partners(const void *left, const void *right) {
    const pair *a = left, *b = right;
    return (a->b > b->b) - (a->b < b->b);
}

void find_candidates(const char *path, const narc_aabb *boxes, size_t count, uint64_t most, pair_list *out_pairs) {
    *out_pairs = (pair_list){0};
    out_pairs->items = grow(NULL, &out_pairs->capacity, 0, sizeof *out_pairs->items);
    if (count < 2)
        return;
    show_stage("broad phase", count, "bodies", false);
    item *items = rank_boxes(boxes, count);
    const uint64_t overlaps = count_overlaps(items, count);
    if (overlaps > most) {
        fail_at(path, 0,
                "%" PRIu64 " candidate pairs, bodies whose bounding boxes overlap: more than --max-pairs %" PRIu64,
                overlaps, most);
    }
    uint32_t *list = allocate(count, sizeof *list);
    size_t *cursor = allocate(count, sizeof *cursor);
    for (size_t k = 0; k < count; k++) {
        list[k] = (uint32_t)k;
        cursor[k] = 0;
    }
    const region whole = {0, (uint32_t)(count - 1), 0, (uint32_t)(count - 1)};

    /* Once to count the pairs of each body, once more to write them where they belong. */
    search in = {.items = items, .count = count, .cursor = cursor};
    search_region(&in, list, count, whole);
    size_t total = 0;
    for (size_t a = 0; a < count; a++) {
        const size_t own = cursor[a];
        cursor[a] = total;
        total += own;
    }
    assert(total == overlaps);
    pair *pairs = out_pairs->items = grow(out_pairs->items, &out_pairs->capacity, total, sizeof *pairs);
    in = (search){.items = items, .count = count, .cursor = cursor, .pairs = pairs};
    search_region(&in, list, count, whole);
    for (size_t a = 0, start = 0; a < count; start = cursor[a++]) {
        qsort(pairs + start, cursor[a] - start, sizeof *pairs, compare_partners);
        show_progress("broad phase, order", a, count);
    }
    out_pairs->count = total;
    free(items);
    free(cursor);
    free(list);
}
