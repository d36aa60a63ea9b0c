/* SPDX-License-Identifier: MIT
 *
 * corners.c - what a hull is like: how much of it turns at corners, how much is straight; and its n-gon by taking sides
 * away.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "study.h"

/* A corner: a stretch of the hull's outline no longer than this part of its perimeter that turns by at least this
 * angle. So a corner that is rounded a little is one too, and so is one that pixels or curves cut into several. */
static const double CORNER_LENGTH = 0.01, CORNER_TURN = PI / 6;

/* A long side, as a part of the perimeter. */
static const double LONG_SIDE = 0.05;

static double side_length(const hull *of, size_t k) {
    return length(minus(of->corners[(k + 1) % of->count], of->corners[k]));
}

/* The angle between the sides before and behind corner k. */
static double turn_at(const hull *of, size_t k) {
    const narc_point in = of->normals[(k + of->count - 1) % of->count], out = of->normals[k];
    return atan2(cross(in, out), dot(in, out));
}

/* The turn of the stretch that begins at corner `from`; `used` corners end it. Sets how many corners it has. */
static double turn_of_stretch(const hull *of, const bool *used, size_t from, size_t *out_count) {
    double turn = 0, walked = 0;
    *out_count = 0;
    for (size_t k = from; !used[k % of->count] && *out_count < of->count; k++) {
        turn += turn_at(of, k % of->count);
        ++*out_count;
        walked += side_length(of, k % of->count);
        if (walked > CORNER_LENGTH * of->perimeter)
            break;
    }
    return turn;
}

/* The sharpest stretches first, until none is a corner. */
static double find_corner_share(const hull *of) {
    bool *used = memset(allocate(of->count, sizeof *used), 0, of->count * sizeof *used);
    double share = 0;
    for (;;) {
        double sharpest = 0;
        size_t from = 0, count = 0;
        for (size_t k = 0; k < of->count; k++) {
            size_t corners;
            const double turn = turn_of_stretch(of, used, k, &corners);
            if (turn > sharpest) {
                sharpest = turn;
                from = k;
                count = corners;
            }
        }
        if (sharpest < CORNER_TURN)
            break;
        share += sharpest / (2 * PI);
        for (size_t k = 0; k < count; k++)
            used[(from + k) % of->count] = true;
    }
    free(used);
    return share;
}

void measure_corners(subject *of) {
    of->corner_share = find_corner_share(&of->around);
    of->straight_share = 0;
    for (size_t k = 0; k < of->around.count; k++) {
        const double part = side_length(&of->around, k) / of->around.perimeter;
        of->straight_share += part >= LONG_SIDE ? part : 0;
    }
}

/* ---------------------------------------------------------------------------- greedy n-gons */

/* Where the sides before and behind side k meet if it is taken away, and the area that this adds; INFINITY if they do
 * not meet on its far side. */
static double cost_of_side(const narc_point *corners, size_t count, size_t k, narc_point *out_meet) {
    const narc_point a = corners[k], b = corners[(k + 1) % count];
    const narc_point before = minus(a, corners[(k + count - 1) % count]);
    const narc_point behind = minus(b, corners[(k + 2) % count]), side = minus(b, a);
    const double sine = cross(behind, before); /* > 0: the two sides turn by less than half a turn */
    if (!(sine > 0))
        return INFINITY;
    const double t = cross(behind, side) / sine;
    *out_meet = along(a, t, before);
    return 0.5 * fabs(cross(minus(*out_meet, a), side));
}

double find_greedy_area(const hull *around, size_t sides) {
    size_t count = around->count;
    double area = around->area;
    narc_point *corners = memcpy(allocate(count, sizeof *corners), around->corners, count * sizeof *corners);
    while (count > sides) {
        double least = INFINITY;
        size_t best = count;
        narc_point corner = {0, 0}, meet = {0, 0};
        for (size_t k = 0; k < count; k++) {
            const double cost = cost_of_side(corners, count, k, &meet);
            if (cost < least) {
                least = cost;
                best = k;
                corner = meet;
            }
        }
        if (best == count) /* a parallelogram */
            break;
        area += least;
        const size_t gone = (best + 1) % count;
        corners[best] = corner;
        memmove(corners + gone, corners + gone + 1, (count - gone - 1) * sizeof *corners);
        count--;
    }
    free(corners);
    return area;
}
