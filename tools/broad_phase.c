/* SPDX-License-Identifier: MIT
 *
 * broad_phase.c - pairs of boxes in double precision: narc_find_pairs() for the boxes rounded outwards to single
 * precision, and then those of its pairs whose own boxes overlap.
 */
#include "broad_phase.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "calls.h"
#include "fail.h"
#include "narc_broad_phase.h"
#include "progress.h"

/* More of them may take a second on one thread. */
enum { MANY_BOXES = 2000000 };

/* Boxes that the middle is taken from; room for pairs of each box, before they are counted. */
enum { SAMPLES = 1000, LIKELY_PAIRS = 4 };

/* The median of some boxes' lower sides along one axis. A few bodies far away do not move it, so that the others keep
 * their precision. */
static double find_middle(const narc_aabb *boxes, size_t count, bool along_y) {
    double sides[SAMPLES];
    size_t taken = 0;
    for (size_t i = 0; i < count; i += count / SAMPLES + 1) {
        const double side = along_y ? boxes[i].min_y : boxes[i].min_x;
        sides[taken] = side;
        taken += isfinite(side) ? 1 : 0; /* of ground without end not */
    }
    if (taken == 0)
        return 0;
    return find_median(sides, taken);
}

/* Numbers beyond the range of floats become the last float: what overlaps there still does. */
static float round_down(double value) {
    const double limit = (double)FLT_MAX;
    const float near = (float)fmax(fmin(value, limit), -limit);
    return (double)near > value && near > -FLT_MAX ? nextafterf(near, -INFINITY) : near;
}

static float round_up(double value) { return -round_down(-value); }

/* Boxes around the others, relative to their middle. Both roundings keep the order of numbers, so no overlap is lost. */
static narc_box *round_boxes(const narc_aabb *boxes, size_t count) {
    const double x = find_middle(boxes, count, false), y = find_middle(boxes, count, true);
    narc_box *rounded = allocate(count, sizeof *rounded);
    for (size_t i = 0; i < count; i++) {
        const narc_aabb box = boxes[i];
        rounded[i] = (narc_box){.min_x = round_down(box.min_x - x),
                                .min_y = round_down(box.min_y - y),
                                .max_x = round_up(box.max_x - x),
                                .max_y = round_up(box.max_y - y)};
    }
    return rounded;
}

static void refuse(const char *path, const char *more_than, size_t found, uint64_t most) {
    fail_at(path, 0, "%s%zu candidate pairs, bodies whose bounding boxes overlap: more than --max-pairs %" PRIu64,
            more_than, found, most);
}

static bool overlap(const narc_aabb *a, const narc_aabb *b) {
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y && b->min_y <= a->max_y;
}

void find_candidates(const char *path, const narc_aabb *boxes, size_t count, uint64_t most, const narc_workers *workers,
                     pair_list *out_pairs) {
    *out_pairs = (pair_list){0};
    out_pairs->items = grow(NULL, &out_pairs->capacity, 0, sizeof *out_pairs->items);
    if (count < 2)
        return;
    show_stage("broad phase", count, "bodies", count > MANY_BOXES);
    narc_box *rounded = round_boxes(boxes, count);
    narc_broad_phase *broad = NULL;
    if (narc_create_broad_phase(NULL, &broad) != NARC_OK)
        fail("not enough memory");
    size_t capacity = LIKELY_PAIRS * count, found = 0;
    uint32_t *a;
    for (;; capacity = found) {
        narc_error error;
        a = allocate(capacity, 2 * sizeof *a);
        const narc_status status =
            narc_find_pairs(broad, rounded, count, NULL, workers, a, a + capacity, 0, capacity, &found, &error);
        if (status == NARC_ERROR_COUNT)
            refuse(path, "more than ", UINT32_MAX, most);
        if (status != NARC_OK && status != NARC_ERROR_CAPACITY)
            fail("%s", error.message);
        if (found > most)
            refuse(path, "", found, most);
        if (status == NARC_OK)
            break;
        free(a);
    }
    free(rounded);
    out_pairs->items = grow(out_pairs->items, &out_pairs->capacity, found, sizeof *out_pairs->items);
    for (size_t k = 0; k < found; k++) {
        const pair one = {a[k], a[capacity + k]};
        if (overlap(&boxes[one.a], &boxes[one.b]))
            out_pairs->items[out_pairs->count++] = one;
    }
    free(a);
    narc_destroy_broad_phase(broad);
}
