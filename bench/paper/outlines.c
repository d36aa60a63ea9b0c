/* SPDX-License-Identifier: MIT
 *
 * outlines.c - random smooth convex outlines, and the n-arc and the n-gon that stand for one.
 *
 * With the radius of curvature r(t) = 1 + sum b_k cos(k t + p_k), the support function h, for which h + h" = r, is
 * 1 + sum b_k / (1 - k^2) cos(k t + p_k); the point with normal n(t) and tangent t(t) is h n + h' t, and the area is
 * half the integral of h r.
 */
#include "outlines.h"

#include <math.h>

#include "random.h"

/* Long shapes, blunt triangles, blunt squares; together less than 1, so that the outline is convex. */
static const double largest_amplitude[HARMONICS] = {0.6, 0.25, 0.1};

struct smooth random_smooth(uint64_t *random) {
    struct smooth outline;
    for (size_t k = 0; k < HARMONICS; k++) {
        outline.amplitude[k] = random_between(random, 0, largest_amplitude[k]);
        outline.phase[k] = random_between(random, 0, 2 * pi);
    }
    return outline;
}

static double harmonic(size_t k) { return (double)k + 2; }

static narc_point point_at(const struct smooth *outline, double angle) {
    double height = 1, slope = 0;
    for (size_t k = 0; k < HARMONICS; k++) {
        const double order = harmonic(k), part = outline->amplitude[k] / (1 - order * order);
        height += part * cos(order * angle + outline->phase[k]);
        slope -= part * order * sin(order * angle + outline->phase[k]);
    }
    return (narc_point){height * cos(angle) - slope * sin(angle), height * sin(angle) + slope * cos(angle)};
}

static double area_of(const struct smooth *outline) {
    double sum = 1;
    for (size_t k = 0; k < HARMONICS; k++)
        sum += outline->amplitude[k] * outline->amplitude[k] / (2 * (1 - harmonic(k) * harmonic(k)));
    return pi * sum;
}

static void match_area(narc_arc *arcs, size_t count, double area) {
    resize(arcs, count, sqrt(area / mass_of(arcs, count).area));
    center(arcs, count);
}

bool fit_n_arc(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs) {
    for (size_t k = 0; k < count; k++) {
        const double start = junctions[k], end = junctions[k + 1], middle = (start + end) / 2;
        const narc_point from = point_at(outline, start), to = point_at(outline, end);
        const double chord = (to.y - from.y) * cos(middle) - (to.x - from.x) * sin(middle);
        out_arcs[k] = (narc_arc){.radius = chord / (2 * sin((end - start) / 2)), .start = start, .end = end};
    }
    close_radii(out_arcs, count, NULL);
    for (size_t k = 0; k < count; k++)
        if (out_arcs[k].radius < 0.05)
            return false;
    chain_centers(out_arcs, count);
    match_area(out_arcs, count, area_of(outline));
    return true;
}

void fit_n_gon(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs) {
    narc_point points[NARC_MAX_ARCS];
    narc_error error;
    size_t arc_count;
    for (size_t k = 0; k < count; k++)
        points[k] = point_at(outline, junctions[k]);
    must(narc_build_polygon(points, count, 0, out_arcs, &arc_count, &error), &error);
    match_area(out_arcs, count, area_of(outline));
}
