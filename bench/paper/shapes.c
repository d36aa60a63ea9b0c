/* SPDX-License-Identifier: MIT
 *
 * shapes.c - random smooth convex outlines with the n-arc and the n-gon that stand for one; and families of hard shapes.
 *
 * With the radius of curvature r(t) = 1 + sum b_k cos(k t + p_k), the support function h, for which h + h" = r, is
 * 1 + sum b_k / (1 - k^2) cos(k t + p_k); the point with normal n(t) and tangent t(t) is h n + h' t, and the area is
 * half the integral of h r.
 */
#include <math.h>

#include "arcs.h"
#include "paper.h"
#include "random.h"

const char *const kind_names[KINDS] = {"arc", "gon"};
const char *const family_names[FAMILIES] = {"round", "thin", "flat lens", "very unequal radii", "polygon"};

enum { HARMONICS = 3, LEAST_ARCS = 4, MOST_ARCS = 16 };

/* An outline by its radius of curvature as a function of the outward normal's angle: 1, and harmonics 2, 3 and 4. (A
 * first harmonic would leave it open.) */
struct smooth {
    double amplitude[HARMONICS], phase[HARMONICS];
};

/* Long shapes, blunt triangles, blunt squares; together less than 1, so that the outline is convex. */
static const double largest_amplitude[HARMONICS] = {0.6, 0.25, 0.1};

static struct smooth random_smooth(uint64_t *random) {
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

/* Each radius is such that the arc's chord is as long, along its own direction, as that of the outline's piece with the
 * same normals, but for the least change (in squares) that closes the list. The area is the outline's and the centroid
 * the origin. False if a radius is below 0.05. */
static bool fit_n_arc(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs) {
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

/* The vertices are the outline's points with these normals; enlarged to the outline's area, its centroid the origin. A
 * vertex is an arc of radius 0. */
static void fit_n_gon(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs) {
    narc_point points[NARC_MAX_ARCS];
    narc_error error;
    size_t arc_count;
    for (size_t k = 0; k < count; k++)
        points[k] = point_at(outline, junctions[k]);
    must(narc_build_polygon(points, count, 0, out_arcs, &arc_count, &error), &error);
    match_area(out_arcs, count, area_of(outline));
}

void make_twins(uint64_t *random, size_t count, narc_arc *out_arcs, narc_arc *out_gon) {
    const struct smooth outline = random_smooth(random);
    double junctions[NARC_MAX_ARCS + 1];
    do
        random_junctions(random, count, junctions);
    while (!fit_n_arc(&outline, junctions, count, out_arcs));
    fit_n_gon(&outline, junctions, count, out_gon);
}

/* ------------------------------------------------------------------------------------------------ families */

static size_t random_count(uint64_t *random) { return LEAST_ARCS + random_below(random, MOST_ARCS - LEAST_ARCS + 1); }

/* From `low` to `high`, equally likely on a logarithmic scale. */
static double random_scale(uint64_t *random, double low, double high) {
    return low * pow(high / low, random_unit(random));
}

/* Closes a list of arcs of very different radii: each radius gives way in proportion to its own size, so that small
 * ones stay small. False if one would lose more than nine tenths of itself, or be too large for the shape. */
static bool close_in_proportion(narc_arc *arcs, size_t count) {
    double radii[NARC_MAX_ARCS] = {0};
    for (size_t k = 0; k < count; k++)
        radii[k] = arcs[k].radius;
    close_radii(arcs, count, radii);
    for (size_t k = 0; k < count; k++)
        if (arcs[k].radius < radii[k] / 10)
            return false;
    chain_centers(arcs, count);
    center(arcs, count);
    return narc_validate_arcs(arcs, count, NULL) == NARC_OK;
}

/* The radii of curvature of an ellipse, 4 to 10 times as long as wide, at the middles of sectors that are equal parts
 * of the ellipse's parameter: small where it is curved much. */
static size_t make_thin(uint64_t *random, narc_arc *out) {
    for (;;) {
        const size_t count = random_count(random);
        const double aspect = random_scale(random, 4, 10), turn = random_between(random, 0, 2 * pi);
        double normals[NARC_MAX_ARCS + 1];
        for (size_t k = 0; k < count; k++) {
            const double parameter = turn + 2 * pi / (double)count * ((double)k + random_between(random, -0.3, 0.3));
            normals[k] = atan2(sin(parameter) * aspect, cos(parameter));
            while (k > 0 && normals[k] < normals[k - 1])
                normals[k] += 2 * pi;
        }
        normals[count] = normals[0] + 2 * pi;
        double widest = 0;
        for (size_t k = 0; k < count; k++) {
            const double middle = (normals[k] + normals[k + 1]) / 2, c = cos(middle) * aspect, s = sin(middle);
            out[k] = (narc_arc){
                .radius = aspect * aspect / pow(c * c + s * s, 1.5), .start = normals[k], .end = normals[k + 1]};
            widest = fmax(widest, normals[k + 1] - normals[k]);
        }
        if (widest < pi && close_in_proportion(out, count))
            return count;
    }
}

/* Two large arcs of 1.5 to 20 times the lens's half length, tips of 1 to 10 % of its half thickness. */
static size_t make_lens(uint64_t *random, narc_arc *out) {
    for (;;) {
        const double low = random_scale(random, 1.5, 20), high = random_scale(random, 1.5, 20);
        const double thickness = low - sqrt(low * low - 1) + high - sqrt(high * high - 1);
        const narc_four_arc form = {low, high, low + high - thickness, thickness / 2 * random_scale(random, 0.01, 0.1),
                                    thickness / 2 * random_scale(random, 0.01, 0.1)};
        size_t count;
        if (narc_build_four_arc(&form, out, &count, NULL) == NARC_OK) {
            center(out, count);
            return count;
        }
    }
}

/* Radii from 1 to 1,000, equally likely on a logarithmic scale, in sectors up to 0.3 from equal. */
static size_t make_unequal(uint64_t *random, narc_arc *out) {
    for (;;) {
        const size_t count = random_count(random);
        double junctions[NARC_MAX_ARCS + 1];
        random_junctions(random, count, junctions);
        for (size_t k = 0; k < count; k++)
            out[k] =
                (narc_arc){.radius = random_scale(random, 1, 1000), .start = junctions[k], .end = junctions[k + 1]};
        if (close_in_proportion(out, count))
            return count;
    }
}

/* The n-arcs and n-gons of the timed scenes. */
static size_t make_round(uint64_t *random, narc_arc *out) {
    narc_arc gon[NARC_MAX_ARCS];
    const size_t count = random_count(random);
    make_twins(random, count, out, gon);
    return count;
}

static size_t make_polygon(uint64_t *random, narc_arc *out) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = random_count(random);
    make_twins(random, count, arcs, out);
    return count;
}

size_t make_shape(enum family family, uint64_t *random, narc_arc *out_arcs) {
    static size_t (*const makers[FAMILIES])(uint64_t *, narc_arc *) = {make_round, make_thin, make_lens, make_unequal,
                                                                       make_polygon};
    const size_t count = makers[family](random, out_arcs);
    narc_circle circle = {0};
    if (!narc_compute_bounding_circle(out_arcs, count, &circle))
        fail("a shape without a bounding circle");
    resize(out_arcs, count, random_scale(random, 0.5, 2) / circle.radius);
    return count;
}
