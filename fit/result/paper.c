/* SPDX-License-Identifier: MIT
 *
 * paper.c - Algorithm 1 on a polygon, enlarged until it bounds.
 */
#include "result/paper.h"

#include <string.h>

#include "error.h"
#include "model/chain.h"
#include "outline/vector.h"

/* How many values of the free radius are tried, evenly in its logarithm. */
enum { RADII = 64 };

/* Is the hull inside the arcs when they are scaled about a point? */
static bool bounds_scaled(const narc_arc *arcs, size_t count, const narc_hull *hull, narc_point center, double factor) {
    for (size_t k = 0; k < hull->count; k++) {
        const narc_point p = hull->corners[k];
        const narc_point back = {center.x + (p.x - center.x) / factor, center.y + (p.y - center.y) / factor};
        double distance;
        if (!narc_compute_distance(arcs, count, &back, &distance) || distance * factor > -hull->inflation)
            return false;
    }
    return true;
}

/* Scales arcs about their centroid by the least factor that makes them bound the hull, found by bisection. */
static bool enlarge(narc_arc *arcs, size_t count, const narc_hull *hull, double *out_area) {
    narc_mass mass;
    if (!narc_compute_mass(arcs, count, &mass))
        return false;
    const narc_point center = {mass.centroid_x, mass.centroid_y};
    double low = 0.25, high = 8;
    if (!bounds_scaled(arcs, count, hull, center, high))
        return false;
    while (high - low > 1e-9 * high) {
        const double middle = 0.5 * (low + high);
        if (bounds_scaled(arcs, count, hull, center, middle))
            high = middle;
        else
            low = middle;
    }
    for (size_t i = 0; i < count; i++) {
        arcs[i].center_x = center.x + high * (arcs[i].center_x - center.x);
        arcs[i].center_y = center.y + high * (arcs[i].center_y - center.y);
        arcs[i].radius *= high;
    }
    *out_area = high * high * mass.area;
    return true;
}

/* The sharpest corner loses this part of the shorter of its two sides: near the 0.293 that makes a regular octagon of a
 * square, and less than half, so that both ends of a side can be cut. */
static const double CUT = 0.29;

static size_t find_sharpest(const narc_point *points, size_t count) {
    double largest = -1;
    size_t sharpest = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_point incoming = minus(points[k], points[(k + count - 1) % count]);
        const narc_point outgoing = minus(points[(k + 1) % count], points[k]);
        const double turn = narc_atan2(cross(incoming, outgoing), dot(incoming, outgoing));
        if (turn > largest + 1e-9) {
            largest = turn;
            sharpest = k;
        }
    }
    return sharpest;
}

/* Cuts off corners until there are `wanted`. */
static void cut_corners(narc_point *points, size_t count, size_t wanted) {
    for (; count < wanted; count++) {
        const size_t k = find_sharpest(points, count);
        const narc_point sharpest = points[k], back = minus(points[(k + count - 1) % count], sharpest);
        const narc_point ahead = minus(points[(k + 1) % count], sharpest);
        const double cut = CUT * fmin(length(back), length(ahead));
        memmove(points + k + 1, points + k, (count - k) * sizeof *points);
        points[k] = along(sharpest, cut / length(back), back);
        points[k + 1] = along(sharpest, cut / length(ahead), ahead);
    }
}

narc_status narc_follow_paper(const narc_point *polygon, size_t sides, size_t count, const narc_hull *hull,
                              narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    narc_point corners[NARC_MAX_ARCS], junctions[NARC_MAX_ARCS];
    memcpy(corners, polygon, sides * sizeof *corners);
    cut_corners(corners, sides, count);
    double smallest, largest, chosen;
    narc_status status = narc_adjust_polygon(corners, count, junctions, error);
    if (status == NARC_OK)
        status = narc_find_radius_range(junctions, count, &smallest, &largest, &chosen, error);
    if (status != NARC_OK)
        return status;
    double best = INFINITY;
    /* Odd counts have one radius. Of even counts radii reach from one end of the range to the other, as far as arcs may
     * be flat; the first try is the most even one. */
    const double low = fmax(smallest, 1e-3), high = fmin(largest, 64);
    for (unsigned k = 0; k <= (count % 2 ? 0 : RADII); k++) {
        const double radius = k == 0 ? 0 : low * narc_pow(high / low, (k - 0.5) / RADII);
        narc_arc arcs[NARC_MAX_ARCS];
        size_t arc_count;
        double area;
        if (narc_build_points(junctions, count, radius, arcs, &arc_count, NULL) == NARC_OK &&
            enlarge(arcs, arc_count, hull, &area) && area < best) {
            best = area;
            *out_count = arc_count;
            memcpy(out_arcs, arcs, arc_count * sizeof *arcs);
        }
    }
    return isfinite(best) ? NARC_OK
                          : narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0,
                                      "Algorithm 1 gives no n-arc with %zu arcs that bounds the outline", count);
}
