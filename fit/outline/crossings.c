/* SPDX-License-Identifier: MIT
 *
 * crossings.c - where the lines of contours cross, touch or lie on each other: sweeps over their boxes, from left to
 * right, in strips that have as many lines as there are strips, but for long ones.
 */
#include "outline/crossings.h"

#include <stdlib.h>

#include "error.h"
#include "outline/path.h"
#include "outline/vector.h"

/* Points that are nearer to a line than this part of the contours' extent lie on it: some roundings. */
static const double ON_LINE = 1e-14;

enum { MOST_CROSSINGS = 1 << 22 };

typedef struct line {
    narc_point from, to;
    double low, high;   /* in x */
    size_t first, last; /* strips */
    size_t number;
} line;

typedef struct sweep {
    line *lines;
    size_t count, strips;
    size_t *ends, *items; /* strip k has the lines items[ends[k - 1] .. ends[k] - 1], in their order */
    double near;
    narc_crossings found;
    narc_status status;
} sweep;

size_t narc_find_contour(const size_t *ends, size_t count, size_t point) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (ends[middle] <= point)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void note(sweep *s, const line *on, const line *other, double part, narc_point at, bool crosses) {
    narc_crossings *found = &s->found;
    narc_crossing *items = narc_grow(found->items, &found->capacity, found->count + 1, sizeof *items);
    if (!items || found->count == MOST_CROSSINGS) {
        s->status = items ? NARC_ERROR_NOT_SIMPLE : NARC_ERROR_MEMORY;
        found->items = items ? items : found->items;
        return;
    }
    found->items = items;
    items[found->count++] = (narc_crossing){on->number, other->number, part, at, crosses};
}

/* Notes an end of another line that lies on this one, between its ends. */
static bool note_touch(sweep *s, const line *on, const line *other, narc_point p) {
    const narc_point side = minus(on->to, on->from), from = minus(p, on->from);
    const double size = length(side), far = dot(from, side) / size;
    if (fabs(cross(side, from)) > s->near * size || far < -s->near || far > size + s->near)
        return false;
    if (far > s->near && far < size - s->near)
        note(s, on, other, far / size, p, false);
    return true;
}

static void look_at(sweep *s, const line *a, const line *b) {
    const bool heads = is_same(a->from, b->from), tails = is_same(a->to, b->to);
    const bool follows = is_same(a->to, b->from), leads = is_same(b->to, a->from);
    const narc_point d = minus(a->to, a->from), e = minus(b->to, b->from), w = minus(b->from, a->from);
    bool touches = heads || tails || follows || leads;
    if ((heads && tails) || (follows && leads)) /* one line, drawn twice */
        note(s, a, b, 0, a->from, false);
    for (int k = 0; k < 2; k++) {
        touches |= note_touch(s, a, b, k ? b->to : b->from);
        touches |= note_touch(s, b, a, k ? a->to : a->from);
    }
    const double across = cross(d, e), t = cross(w, e) / across, u = cross(w, d) / across;
    if (touches || !(across != 0 && t > 0 && t < 1 && u > 0 && u < 1))
        return;
    const narc_point at = along(a->from, t, d);
    note(s, a, b, t, at, true);
    note(s, b, a, u, at, true);
}

static int compare_lines(const void *left, const void *right) {
    const line *a = left, *b = right;
    return a->low != b->low ? (a->low > b->low) - (a->low < b->low) : (a->number > b->number) - (a->number < b->number);
}

static int compare_crossings(const void *left, const void *right) {
    const narc_crossing *a = left, *b = right;
    return a->line != b->line   ? (a->line > b->line) - (a->line < b->line)
           : a->part != b->part ? (a->part > b->part) - (a->part < b->part)
                                : (a->other > b->other) - (a->other < b->other);
}

/* Lines without a length are none. */
static void list_lines(sweep *s, const narc_contours *contours, bool closed) {
    const narc_aabb box = bound_points(contours->points, contours->point_count);
    for (size_t k = 0, begin = 0; k < contours->count; begin = contours->ends[k++])
        for (size_t i = begin; i < contours->ends[k]; i++) {
            const bool is_last = i + 1 == contours->ends[k];
            const narc_point p = contours->points[i], q = contours->points[is_last ? begin : i + 1];
            if (!is_same(p, q) && (closed || !is_last))
                s->lines[s->count++] = (line){p, q, fmin(p.x, q.x), fmax(p.x, q.x), 0, 0, i};
        }
    s->near = fmax(s->near, ON_LINE * largest_in(box));
    qsort(s->lines, s->count, sizeof *s->lines, compare_lines);
    s->strips = 1 + (size_t)sqrt((double)s->count);
    const double height = (box.max_y - box.min_y) / (double)s->strips;
    for (size_t i = 0; i < s->count; i++) {
        line *of = &s->lines[i];
        const double from = (fmin(of->from.y, of->to.y) - s->near - box.min_y) / height;
        const double to = (fmax(of->from.y, of->to.y) + s->near - box.min_y) / height;
        const double most = (double)s->strips - 1;
        of->first = height > 0 ? (size_t)fmin(fmax(0, from), most) : 0;
        of->last = height > 0 ? (size_t)fmin(fmax(0, to), most) : 0;
    }
}

/* Puts the lines into strips. */
static bool fill_strips(sweep *s) {
    size_t count = 0;
    s->ends = calloc(s->strips + 1, sizeof *s->ends);
    for (size_t i = 0; s->ends && i < s->count; i++)
        for (size_t k = s->lines[i].first; k <= s->lines[i].last; k++, count++)
            s->ends[k + 1]++;
    for (size_t k = 0; s->ends && k < s->strips; k++)
        s->ends[k + 1] += s->ends[k];
    s->items = s->ends ? malloc((count + 1) * sizeof *s->items) : NULL;
    for (size_t i = 0; s->items && i < s->count; i++)
        for (size_t k = s->lines[i].first; k <= s->lines[i].last; k++)
            s->items[s->ends[k]++] = i;
    return s->items;
}

/* Each pair is looked at in the first strip that both are in. */
static void sweep_strip(sweep *s, size_t strip) {
    const size_t begin = strip ? s->ends[strip - 1] : 0, end = s->ends[strip];
    for (size_t i = begin; i < end && !s->status; i++) {
        const line *a = &s->lines[s->items[i]];
        const double low = fmin(a->from.y, a->to.y) - s->near, high = fmax(a->from.y, a->to.y) + s->near;
        for (size_t j = i + 1; j < end && s->lines[s->items[j]].low <= a->high + s->near && !s->status; j++) {
            const line *b = &s->lines[s->items[j]];
            if ((a->first > b->first ? a->first : b->first) == strip && fmax(b->from.y, b->to.y) >= low &&
                fmin(b->from.y, b->to.y) <= high)
                look_at(s, a, b);
        }
    }
}

narc_status narc_find_crossings(const narc_contours *contours, bool closed, double near, narc_crossings *out_crossings,
                                narc_error *error) {
    sweep s = {.near = near, .lines = malloc((contours->point_count + 1) * sizeof *s.lines)};
    if (s.lines)
        list_lines(&s, contours, closed);
    s.status = s.lines && fill_strips(&s) ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t k = 0; k < s.strips && !s.status; k++)
        sweep_strip(&s, k);
    free(s.lines);
    free(s.ends);
    free(s.items);
    if (s.status) {
        free(s.found.items);
        return s.status == NARC_ERROR_MEMORY
                   ? narc_fail(error, s.status, 0, 0, "not enough memory for %zu lines", contours->point_count)
                   : narc_fail(error, s.status, 0, MOST_CROSSINGS, "its lines cross more than %d times",
                               MOST_CROSSINGS / 2);
    }
    if (s.found.items) // none that cross: no array to sort
        qsort(s.found.items, s.found.count, sizeof *s.found.items, compare_crossings);
    *out_crossings = s.found;
    return NARC_OK;
}
