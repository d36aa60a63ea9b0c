/* SPDX-License-Identifier: MIT
 *
 * simple.c - does a contour cross or touch itself? A sweep (Shamos and Hoey 1976): a line passes over the points and
 * keeps the sides that it meets in their order along it. Sides that cross or touch are neighbours in that order before
 * the line is at the place, so it is enough to compare neighbours.
 *
 * Points are swept by x, those of equal x by y, as if the line leaned a little. No two points of a contour are equal
 * (that is a touch, found before), so each point begins or ends exactly two sides. All decisions are exact.
 */
#include <stdint.h>
#include <stdlib.h>

#include "error.h"
#include "orientation.h"
#include "path.h"

/* The sides under the line are a skip list (Pugh 1990) with links both ways, closed to a ring by a head. Half of the
 * sides are on one level only, a quarter on two, and so on; the head is on all. */
enum { LEVELS = 24 };

typedef struct link {
    size_t before, after;
} link;

typedef struct event {
    narc_point at;
    size_t point;
} event;

typedef struct sweep {
    const narc_point *points; /* side k goes from point k to the next one */
    size_t count;             /* of points, sides and events; also the number of the head */
    event *events;
    size_t *first; /* the links of side k: links[first[k] + level] */
    link *links;
    size_t a, b; /* two sides that cross or touch, once they are found */
} sweep;

static bool is_before(narc_point a, narc_point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

static narc_point start_of(const sweep *on, size_t side) { return on->points[side]; }

static narc_point end_of(const sweep *on, size_t side) { return on->points[side + 1 < on->count ? side + 1 : 0]; }

/* The end that the line comes to first, and the other one. */
static narc_point left_of(const sweep *on, size_t side) {
    return is_before(start_of(on, side), end_of(on, side)) ? start_of(on, side) : end_of(on, side);
}

static narc_point right_of(const sweep *on, size_t side) {
    return is_before(start_of(on, side), end_of(on, side)) ? end_of(on, side) : start_of(on, side);
}

static bool is_same(narc_point a, narc_point b) { return a.x == b.x && a.y == b.y; }

/* ---------------------------------------------------------------------------- two sides */

/* Is p, a point on the line through the side, on the side? */
static bool is_between(const sweep *on, size_t side, narc_point p) {
    return !is_before(p, left_of(on, side)) && !is_before(right_of(on, side), p);
}

/* Do sides that follow one another in the contour share more than their common point? Only if the second goes back. */
static bool goes_back(const sweep *on, size_t side, size_t next) {
    const narc_point a = start_of(on, side), b = end_of(on, side), c = end_of(on, next);
    return narc_find_orientation(a, b, c) == 0 && is_before(a, b) != is_before(b, c);
}

/* Do two sides have a common point, other than the one that sides following one another share? */
static bool is_hit(const sweep *on, size_t a, size_t b) {
    if (is_same(end_of(on, a), start_of(on, b))) {
        return goes_back(on, a, b);
    }
    if (is_same(end_of(on, b), start_of(on, a))) {
        return goes_back(on, b, a);
    }
    const narc_point p = start_of(on, a), q = end_of(on, a), r = start_of(on, b), s = end_of(on, b);
    const int to_r = narc_find_orientation(p, q, r), to_s = narc_find_orientation(p, q, s);
    const int to_p = narc_find_orientation(r, s, p), to_q = narc_find_orientation(r, s, q);
    if (to_r * to_s < 0 && to_p * to_q < 0) {
        return true;
    }
    return (to_r == 0 && is_between(on, a, r)) || (to_s == 0 && is_between(on, a, s)) ||
           (to_p == 0 && is_between(on, b, p)) || (to_q == 0 && is_between(on, b, q));
}

/* Compares neighbours on the line, either of which may be the head. */
static bool is_free(sweep *on, size_t a, size_t b) {
    if (a == on->count || b == on->count || !is_hit(on, a, b)) {
        return true;
    }
    on->a = a;
    on->b = b;
    return false;
}

/* Where sides that were hit meet: an end of one that is on the other, or where they cross. */
static narc_point find_place(const sweep *on) {
    const size_t sides[] = {on->a, on->b};
    for (size_t k = 0; k < 2; k++) {
        const narc_point p = start_of(on, sides[k]), q = end_of(on, sides[k]);
        const size_t other = sides[1 - k];
        for (int end = 0; end < 2; end++) {
            const narc_point r = end ? end_of(on, other) : start_of(on, other);
            if (narc_find_orientation(p, q, r) == 0 && is_between(on, sides[k], r)) {
                return r;
            }
        }
    }
    const narc_point p = start_of(on, on->a), q = end_of(on, on->a), r = start_of(on, on->b), s = end_of(on, on->b);
    const double x = q.x - p.x, y = q.y - p.y;
    const double to_r = x * (r.y - p.y) - y * (r.x - p.x), to_s = x * (s.y - p.y) - y * (s.x - p.x);
    const double t = to_r == to_s ? 0.5 : to_r / (to_r - to_s); /* equal by rounding only */
    return (narc_point){r.x + t * (s.x - r.x), r.y + t * (s.y - r.y)};
}

/* ---------------------------------------------------------------------------- the sides under the line */

/* How many levels a side is on: as many as its scrambled number has low zeros, and one more. */
static size_t count_levels(size_t side) {
    uint64_t bits = ((uint64_t)side + 1) * 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 32)) * 0xd6e8feb86659fd93u;
    bits ^= bits >> 32;
    size_t levels = 1;
    for (; levels < LEVELS && !(bits & 1); bits >>= 1) {
        levels++;
    }
    return levels;
}

static link *link_of(const sweep *on, size_t side, size_t level) { return on->links + on->first[side] + level; }

/* The order along the line through the left end of `side`: 1 if that is above `other`, -1 below, 0 if they touch: then
 * `side` comes right above `other`, or above another one that touches it, and is compared with it as its neighbour. */
static int compare_sides(const sweep *on, size_t side, size_t other) {
    const narc_point left = left_of(on, other), right = right_of(on, other), at = left_of(on, side);
    return narc_find_orientation(left, right, is_same(at, left) ? right_of(on, side) : at);
}

static bool insert_side(sweep *on, size_t side) {
    const size_t head = on->count, levels = count_levels(side);
    size_t below = head;
    for (size_t level = LEVELS; level-- > 0;) {
        for (size_t next; (next = link_of(on, below, level)->after) != head; below = next) {
            if (compare_sides(on, side, next) < 0) {
                break;
            }
        }
        if (level < levels) {
            const size_t after = link_of(on, below, level)->after;
            *link_of(on, side, level) = (link){below, after};
            link_of(on, below, level)->after = side;
            link_of(on, after, level)->before = side;
        }
    }
    return is_free(on, link_of(on, side, 0)->before, side) && is_free(on, side, link_of(on, side, 0)->after);
}

static bool remove_side(sweep *on, size_t side) {
    const size_t levels = count_levels(side);
    const link around = *link_of(on, side, 0);
    for (size_t level = 0; level < levels; level++) {
        const link gap = *link_of(on, side, level);
        link_of(on, gap.before, level)->after = gap.after;
        link_of(on, gap.after, level)->before = gap.before;
    }
    return is_free(on, around.before, around.after);
}

/* ---------------------------------------------------------------------------- the sweep */

static int compare_events(const void *first, const void *second) {
    const event *a = first, *b = second;
    return is_before(a->at, b->at) ? -1 : is_before(b->at, a->at);
}

static bool prepare_sweep(sweep *on) {
    const size_t head = on->count;
    on->events = calloc(on->count, sizeof *on->events);
    on->first = calloc(on->count + 1, sizeof *on->first);
    if (!on->events || !on->first) {
        return false;
    }
    size_t total = 0;
    for (size_t k = 0; k < on->count; k++) {
        on->events[k] = (event){on->points[k], k};
        on->first[k] = total;
        total += count_levels(k);
    }
    on->first[head] = total;
    on->links = calloc(total + LEVELS, sizeof *on->links);
    if (!on->links) {
        return false;
    }
    for (size_t level = 0; level < LEVELS; level++) {
        *link_of(on, head, level) = (link){head, head};
    }
    qsort(on->events, on->count, sizeof *on->events, compare_events);
    return true;
}

/* False at the first crossing or touch, with its place. */
static bool run_sweep(sweep *on, narc_point *out_place) {
    for (size_t k = 0; k + 1 < on->count; k++) {
        if (is_same(on->events[k].at, on->events[k + 1].at)) {
            *out_place = on->events[k].at;
            return false;
        }
    }
    for (size_t k = 0; k < on->count; k++) {
        const narc_point at = on->events[k].at;
        const size_t side = on->events[k].point, sides[] = {side, side ? side - 1 : on->count - 1};
        bool fine = true;
        for (size_t i = 0; i < 2 && fine; i++) { /* what ends here makes room for what begins */
            fine = !is_same(right_of(on, sides[i]), at) || remove_side(on, sides[i]);
        }
        for (size_t i = 0; i < 2 && fine; i++) {
            fine = !is_same(left_of(on, sides[i]), at) || insert_side(on, sides[i]);
        }
        if (!fine) {
            *out_place = find_place(on);
            return false;
        }
    }
    return true;
}

/* Leaves out points that repeat the one before, the last one's follower being the first. */
static size_t drop_repeats(narc_point *points, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || !is_same(points[kept - 1], points[i])) {
            points[kept++] = points[i];
        }
    }
    while (kept > 1 && is_same(points[kept - 1], points[0])) {
        kept--;
    }
    return kept;
}

static narc_status check_contour(narc_point *points, size_t count, size_t contour, narc_error *error) {
    count = drop_repeats(points, count);
    if (count < 3) {
        return narc_fail(error, NARC_ERROR_NOT_SIMPLE, contour, 0,
                         "contour %zu encloses nothing: it is a %s at (%g, %g)", contour, count == 1 ? "point" : "line",
                         points[0].x, points[0].y);
    }
    sweep on = {.points = points, .count = count};
    narc_point place;
    narc_status status = NARC_OK;
    if (!prepare_sweep(&on)) {
        status = narc_fail(error, NARC_ERROR_MEMORY, contour, 0, "no memory to check the %zu points of contour %zu",
                           count, contour);
    } else if (!run_sweep(&on, &place)) {
        status = narc_fail(error, NARC_ERROR_NOT_SIMPLE, contour, 0,
                           "contour %zu crosses or touches itself at (%g, %g)", contour, place.x, place.y);
    }
    free(on.events);
    free(on.first);
    free(on.links);
    return status;
}

narc_status narc_check_simple(const narc_path *path, narc_error *error) {
    narc_contours contours;
    narc_status status = narc_flatten_path(path, 0, &contours, error);
    if (status) {
        return status;
    }
    for (size_t k = 0, start = 0; k < contours.count && !status; k++) {
        status = check_contour(contours.points + start, contours.ends[k] - start, k, error);
        start = contours.ends[k];
    }
    narc_release_contours(&contours);
    return status;
}
