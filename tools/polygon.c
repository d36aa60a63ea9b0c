/* SPDX-License-Identifier: MIT
 *
 * polygon.c - convex hull, and convex polygons with fewer or more sides.
 */
#include "polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"

/* Each side of a corner that is cut off loses this part of the shorter one: near the 0.293 that makes a regular octagon
 * of a square, and less than half, so that both ends of a side can be cut. */
static const double CUT = 0.29;

static double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static narc_point minus(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }
static narc_point along(narc_point a, narc_point direction, double t) {
    return (narc_point){a.x + t * direction.x, a.y + t * direction.y};
}

static int compare_points(const void *left, const void *right) {
    const narc_point *a = left, *b = right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

/* Adds p to a chain of corners that all turn left; those that no longer do are dropped, but none below `keep`. */
static size_t extend_chain(narc_point *chain, size_t length, size_t keep, narc_point p) {
    while (length > keep && cross(minus(chain[length - 1], chain[length - 2]), minus(p, chain[length - 1])) <= 0) {
        length--;
    }
    chain[length] = p;
    return length + 1;
}

size_t compute_hull(narc_point *points, size_t count, narc_point *out_hull) {
    if (count < 3) {
        return 0;
    }
    qsort(points, count, sizeof *points, compare_points);
    size_t length = 0;
    for (size_t i = 0; i < count; i++) {
        length = extend_chain(out_hull, length, 1, points[i]);
    }
    const size_t lower = length;
    for (size_t i = count - 1; i-- > 0;) {
        length = extend_chain(out_hull, length, lower, points[i]);
    }
    return length - 1;
}

double polygon_area(const narc_point *points, size_t count) {
    double twice = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        twice += cross(minus(points[i], points[0]), minus(points[i + 1], points[0]));
    }
    return 0.5 * twice;
}

/* Where the neighbours of the side from corner i to the next meet when they are extended, and the area of the triangle
 * that this adds; infinite if they do not meet on that side. */
static double find_meeting(const narc_point *polygon, size_t count, size_t i, narc_point *out_meeting) {
    const narc_point start = polygon[i], end = polygon[(i + 1) % count];
    const narc_point before = minus(start, polygon[(i + count - 1) % count]);
    const narc_point after = minus(polygon[(i + 2) % count], end);
    const narc_point side = minus(end, start);
    const double turn = cross(before, after);
    if (!(turn > 0)) {
        return INFINITY;
    }
    *out_meeting = along(start, before, cross(side, after) / turn);
    return 0.5 * fabs(cross(side, minus(*out_meeting, start)));
}

static bool remove_side(narc_point *polygon, size_t count) {
    double least = INFINITY;
    size_t best = 0;
    narc_point best_meeting = {0, 0};
    for (size_t i = 0; i < count; i++) {
        narc_point meeting = {0, 0};
        const double area = find_meeting(polygon, count, i, &meeting);
        if (area < least) {
            least = area;
            best = i;
            best_meeting = meeting;
        }
    }
    if (!isfinite(least)) {
        return false;
    }
    /* The side's two ends become one corner. */
    polygon[best] = best_meeting;
    if (best + 1 < count) {
        memmove(&polygon[best + 1], &polygon[best + 2], (count - best - 2) * sizeof *polygon);
    } else {
        memmove(&polygon[0], &polygon[1], (count - 1) * sizeof *polygon);
    }
    return true;
}

typedef struct corner {
    size_t index;
    double turn; /* exterior angle */
    bool cut;
} corner;

static int compare_corners(const void *left, const void *right) {
    const corner *a = left, *b = right;
    return a->turn != b->turn ? (a->turn < b->turn) - (a->turn > b->turn)
                              : (a->index > b->index) - (a->index < b->index);
}

/* Cuts off the `cuts` sharpest corners at once, so that a symmetric polygon is treated evenly. */
static void cut_corners(narc_point *polygon, size_t count, size_t cuts) {
    corner *corners = allocate(count, sizeof *corners);
    bool *chosen = allocate(count, sizeof *chosen);
    narc_point *old = allocate(count, sizeof *old);
    memcpy(old, polygon, count * sizeof *old);
    for (size_t i = 0; i < count; i++) {
        const narc_point in = minus(old[i], old[(i + count - 1) % count]), out = minus(old[(i + 1) % count], old[i]);
        corners[i] = (corner){.index = i, .turn = atan2(cross(in, out), in.x * out.x + in.y * out.y)};
        chosen[i] = false;
    }
    qsort(corners, count, sizeof *corners, compare_corners);
    for (size_t k = 0; k < cuts; k++) {
        chosen[corners[k].index] = true;
    }
    size_t written = 0;
    for (size_t i = 0; i < count; i++) {
        if (!chosen[i]) {
            polygon[written++] = old[i];
            continue;
        }
        const narc_point back = minus(old[(i + count - 1) % count], old[i]),
                         ahead = minus(old[(i + 1) % count], old[i]);
        const double back_length = hypot(back.x, back.y), ahead_length = hypot(ahead.x, ahead.y);
        const double length = CUT * fmin(back_length, ahead_length);
        polygon[written++] = along(old[i], back, length / back_length);
        polygon[written++] = along(old[i], ahead, length / ahead_length);
    }
    free(corners);
    free(chosen);
    free(old);
}

bool set_side_count(narc_point *polygon, size_t count, size_t wanted) {
    while (count < wanted) {
        const size_t cuts = wanted - count < count ? wanted - count : count;
        cut_corners(polygon, count, cuts);
        count += cuts;
    }
    for (; count > wanted; count--) {
        if (!remove_side(polygon, count)) {
            return false;
        }
    }
    return true;
}
