/* SPDX-License-Identifier: MIT
 *
 * families.c - random shapes of several families.
 */
#include "families.h"

#include <math.h>

#include "outlines.h"
#include "random.h"

enum { LEAST_ARCS = 4, MOST_ARCS = 16 };

static const char *const names[FAMILIES] = {"round", "thin", "flat lens", "very unequal radii", "polygon"};

const char *family_name(enum family family) { return names[family]; }

static size_t random_count(uint64_t *random) { return LEAST_ARCS + random_below(random, MOST_ARCS - LEAST_ARCS + 1); }

/* From `low` to `high`, equally likely on a logarithmic scale. */
static double random_scale(uint64_t *random, double low, double high) {
    return low * pow(high / low, random_unit(random));
}

/* The n-arcs of the timed scenes. */
static size_t make_round(uint64_t *random, narc_arc *out) {
    const size_t count = random_count(random);
    const struct smooth outline = random_smooth(random);
    double junctions[NARC_MAX_ARCS + 1];
    do
        random_junctions(random, count, junctions);
    while (!fit_n_arc(&outline, junctions, count, out));
    return count;
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
            const double place = turn + 2 * pi / (double)count * ((double)k + random_between(random, -0.3, 0.3));
            normals[k] = atan2(sin(place) * aspect, cos(place));
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
        if (narc_build_four_arc(form, out, &count, NULL) == NARC_OK) {
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

/* The n-gons of the timed scenes. */
static size_t make_polygon(uint64_t *random, narc_arc *out) {
    const size_t count = random_count(random);
    const struct smooth outline = random_smooth(random);
    double junctions[NARC_MAX_ARCS + 1];
    random_junctions(random, count, junctions);
    fit_n_gon(&outline, junctions, count, out);
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
