/* SPDX-License-Identifier: MIT
 *
 * claims.c - the paper's statements about goodness of fit against what was measured.
 *
 * Each statement is made into numbers and a range; it holds if all of them lie in the range.
 */
#include <math.h>
#include <string.h>

#include "numbers.h"

/* What the paper's words mean here: one area over the other. */
typedef struct range {
    double low, high;
} range;
static const range slightly_smaller = {0.9, 1}, slightly_larger = {1, 1.1}, larger = {1, INFINITY};
static const range much_larger = {1.05, INFINITY}, perfect = {1, 1.001}, most_of = {0.5, 1};

/* An area of 1.25 times the hull's is a poor fit, one of 1.1 a good one. */
static const double POOR = 1.25, GOOD = 1.1;

typedef struct span {
    double least, most;
} span;

static span join(span one, double value) { return (span){fmin(one.least, value), fmax(one.most, value)}; }

/* n-arc / n-gon of an outline, for the sizes from the first index to the last. */
static span ratios_of(const study *all, const char *name, size_t first, size_t last) {
    span ratios = {INFINITY, -INFINITY};
    for (size_t i = 0; i < all->count; i++)
        for (size_t size = first; strcmp(all->subjects[i].name, name) == 0 && size <= last; size++)
            ratios = join(ratios, ratio_of(&all->subjects[i], size));
    return ratios;
}

static void print_claim(FILE *out, const char *section, const char *text, const char *measure, range holds_in,
                        span values) {
    fprintf(out, "| %s | %s | %s | ", section, text, measure);
    if (isinf(holds_in.high))
        fprintf(out, "at least %g", holds_in.low);
    else if (holds_in.low == 0)
        fprintf(out, "at most %g", holds_in.high);
    else
        fprintf(out, "%g to %g", holds_in.low, holds_in.high);
    fprintf(out, " | %.3f", values.least);
    if (values.most != values.least)
        fprintf(out, " to %.3f", values.most);
    /* A fit is within a thousandth of what it is meant to be. */
    const bool holds = values.least >= holds_in.low - 5e-4 && values.most <= holds_in.high + 5e-4;
    fprintf(out, ", %s |\n", holds ? "holds" : "**does not hold**");
}

/* ---------------------------------------------------------------------------- figure 2 */

/* Parts of all outlines but grains and images. */
typedef struct shares {
    double poor_circle, poor_aabb, better_obb, good_polygon;
} shares;

static shares find_shares(const study *all) {
    shares found = {0, 0, 0, 0};
    double count = 0;
    for (size_t i = 0; i < all->count; i++) {
        double areas[BOUNDS];
        if (all->subjects[i].of == GRAINS || all->subjects[i].of == IMAGE)
            continue;
        measure_bounds(&all->subjects[i], areas);
        found.poor_circle += areas[CIRCLE] >= POOR;
        found.poor_aabb += areas[AABB] >= POOR;
        found.better_obb += areas[OBB] < 0.999 * fmin(areas[CIRCLE], areas[AABB]);
        found.good_polygon += areas[POLYGON] <= GOOD;
        count++;
    }
    return (shares){found.poor_circle / count, found.poor_aabb / count, found.better_obb / count,
                    found.good_polygon / count};
}

static void print_figure_2(const study *all, FILE *out) {
    const shares found = find_shares(all);
    print_claim(out, "I", "circles are a poor fit for many objects",
                "part of the outlines with 1.25 of the hull's area", most_of,
                (span){found.poor_circle, found.poor_circle});
    print_claim(out, "I", "AABBs are a poor fit for many objects", "part of the outlines with 1.25 of the hull's area",
                most_of, (span){found.poor_aabb, found.poor_aabb});
    print_claim(out, "I", "OBBs are a better fit for most objects",
                "part of the outlines where it is the least of the three", most_of,
                (span){found.better_obb, found.better_obb});
    print_claim(out, "I", "polygons are a good fit for many objects",
                "part of the outlines whose 8-gon has at most 1.1 of the hull's area", most_of,
                (span){found.good_polygon, found.good_polygon});
}

/* ---------------------------------------------------------------------------- figures 6 to 9 */

static span medians_of(const study *all) {
    span medians = {INFINITY, -INFINITY};
    for (size_t size = 0; size < SIZES; size++) {
        numbers ratios = {0};
        for (size_t i = 0; i < all->count; i++)
            if (all->subjects[i].of != GRAINS && all->subjects[i].of != IMAGE)
                add_number(&ratios, ratio_of(&all->subjects[i], size));
        medians = join(medians, find_quantile(&ratios, 0.5));
    }
    return medians;
}

void print_claims(const study *all, FILE *out) {
    enum { FOUR, SIX, EIGHT };
    const subject *house = &all->subjects[1];
    const double octagon = area_of(house, N_GON, EIGHT);
    fprintf(out, "### What the paper says\n\n| section | the paper | measured as | holds in | ours |\n"
                 "| --- | --- | --- | --- | --- |\n");
    print_figure_2(all, out);
    print_claim(out, "3.2", "ghost: the 6-arc is slightly tighter than the 6-gon", "area of the n-arc over the n-gon's",
                slightly_smaller, ratios_of(all, "ghost", SIX, SIX));
    print_claim(out, "3.2", "ghost: the 8-gon is tighter than the 8-arc", "the same", larger,
                ratios_of(all, "ghost", EIGHT, EIGHT));
    print_claim(out, "3.2", "house: the 8-gon is a perfect fit", "area, hull = 1", perfect, (span){octagon, octagon});
    print_claim(out, "3.2", "house: n-gons are considerably smaller", "n-arc over n-gon, n = 4, 6, 8", much_larger,
                ratios_of(all, "house", FOUR, EIGHT));
    print_claim(out, "3.2", "spaceship (our rocket): 6- and 8-arc are slightly larger", "n-arc over n-gon, n = 6, 8",
                slightly_larger, ratios_of(all, "rocket", SIX, EIGHT));
    print_claim(out, "3.2", "tree: n-gons are tighter", "n-arc over n-gon, n = 4, 6, 8", larger,
                ratios_of(all, "tree", FOUR, EIGHT));
    print_claim(out, "IV", "n-arcs are often slightly worse than polygons",
                "n-arc over n-gon, n = 4, 6, 8: medians of all outlines but the grains", slightly_larger,
                medians_of(all));
    fputc('\n', out);
}
