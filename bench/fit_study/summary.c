/* SPDX-License-Identifier: MIT
 *
 * summary.c - medians over kinds of outlines, and which property of a hull goes with n-arcs or n-gons.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "numbers.h"

/* ---------------------------------------------------------------------------- by kind */

/* "median (least to largest), wins of all" of the ratios of some subjects. */
static void print_ratios(const subject *const *some, size_t count, size_t size, FILE *out) {
    numbers ratios = {0};
    size_t wins = 0;
    for (size_t i = 0; i < count; i++) {
        add_number(&ratios, ratio_of(some[i], size));
        wins += ratio_of(some[i], size) < 1 ? 1 : 0;
    }
    print_range(&ratios, 3, out);
    fprintf(out, " | %zu of %zu |", wins, count);
}

/* Those of a kind, or for KINDS all but the image, which is another subject once more, and the grains, which are more
 * than all others. */
static size_t pick(const study *all, kind which, const subject **out_some) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (which == KINDS ? of->of != IMAGE && of->of != GRAINS : of->of == which)
            out_some[count++] = of;
    }
    return count;
}

static void print_kinds(const study *all, const subject **some, FILE *out) {
    fprintf(out, "### n-arc / n-gon by kind: median (least to largest), and how often the n-arc is smaller\n\n"
                 "| | n = 4 | | 6 | | 8 | |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    static const kind order[] = {PAPER, LETTERS, ANIMALS, PLANTS, TOOLS, SIGNS, KINDS, GRAINS};
    for (size_t k = 0; k < sizeof order / sizeof order[0]; k++) {
        const size_t count = pick(all, order[k], some);
        if (count == 0)
            continue;
        fprintf(out, "| %s |", order[k] == KINDS ? "**all of these**" : kind_names[order[k]]);
        for (size_t size = 0; size < SIZES; size++)
            print_ratios(some, count, size, out);
        fputc('\n', out);
    }
    fputc('\n', out);
}

/* ---------------------------------------------------------------------------- by family */

static void print_families(const subject *const *some, size_t count, FILE *out) {
    static const char *const formats[QUANTITIES] = {" %.4f |", " %.2f |", " %.2f |", " %.2f |"};
    fprintf(out, "### Medians over all outlines but the grains\n\n"
                 "| | area, hull = 1: 4 | 6 | 8 | largest distance, %%: 4 | 6 | 8 | mean distance, %%: 4 | 6 | 8 | "
                 "seconds: 4 | 6 | 8 |\n"
                 "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (int which = 0; which < FAMILIES; which++) {
        fprintf(out, "| %s |", family_names[which]);
        for (int column = 0; column < QUANTITIES * SIZES; column++) {
            numbers values = {0};
            for (size_t i = 0; i < count; i++) {
                add_number(&values,
                           value_of(some[i], (family)which, (size_t)column % SIZES, (quantity)(column / SIZES)));
            }
            fprintf(out, formats[column / SIZES], find_quantile(&values, 0.5));
        }
        fputc('\n', out);
    }
    fputc('\n', out);
}

/* How often one shape is smaller than another. */
static void print_contest(const subject *const *some, size_t count, const char *what, family one, size_t one_size,
                          family other, size_t other_size, FILE *out) {
    numbers ratios = {0};
    size_t wins = 0;
    for (size_t i = 0; i < count; i++) {
        const double ratio = area_of(some[i], one, one_size) / area_of(some[i], other, other_size);
        add_number(&ratios, ratio);
        wins += ratio < 1 ? 1 : 0;
    }
    fprintf(out, "| %s |", what);
    print_range(&ratios, 3, out);
    fprintf(out, " | %zu of %zu |\n", wins, ratios.count);
}

static void print_contests(const subject *const *some, size_t count, FILE *out) {
    fprintf(
        out,
        "### Other ratios of areas, all outlines but the grains: median (least to largest), and how often below 1\n\n"
        "| | | |\n| --- | ---: | ---: |\n");
    print_contest(some, count, "8-arc / 8-arc of the paper's route", N_ARC, 2, ROUTE, 2, out);
    print_contest(some, count, "8 arcs + edges / 8-gon", ARCS_AND_EDGES, 2, N_GON, 2, out);
    print_contest(some, count, "4 arcs + edges / 6-gon: 12 numbers each", ARCS_AND_EDGES, 0, N_GON, 1, out);
    print_contest(some, count, "4 arcs + edges / 6-arc: 12 numbers each", ARCS_AND_EDGES, 0, N_ARC, 1, out);
    fputc('\n', out);
}

static const subject *find_source(const study *all, const subject *image) {
    for (size_t i = 0; i < all->count; i++)
        if (strcmp(all->subjects[i].name, image->image) == 0)
            return &all->subjects[i];
    return image;
}

static void print_images(const study *all, FILE *out) {
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (of->of != IMAGE)
            continue;
        const subject *source = find_source(all, of);
        double most = 0;
        for (int cell = 0; cell < FAMILIES * SIZES; cell++) {
            const double one = area_of(of, (family)(cell / SIZES), (size_t)cell % SIZES);
            const double other = area_of(source, (family)(cell / SIZES), (size_t)cell % SIZES);
            most = fmax(most, fabs(one / other - 1)); /* NAN, where one has no fit, is passed over */
        }
        fprintf(out, "The %s drawn as an image has areas, relative to the hull's, within %.2f %% of the drawing's.\n\n",
                source->name, 100 * most);
    }
}

void print_summary(const study *all, FILE *out) {
    const subject **some = allocate(all->count, sizeof *some);
    print_kinds(all, some, out);
    const size_t count = pick(all, KINDS, some);
    print_families(some, count, out);
    print_contests(some, count, out);
    print_images(all, out);
    free(some);
}

/* ---------------------------------------------------------------------------- the property */

static int compare_straight(const void *left, const void *right) {
    const subject *a = *(const subject *const *)left, *b = *(const subject *const *)right;
    return (a->straight_share > b->straight_share) - (a->straight_share < b->straight_share);
}

static void print_groups(const subject *const *sorted, size_t count, FILE *out) {
    enum { GROUPS = 3 };
    fprintf(out, "### n-arc / n-gon by how much of the hull's perimeter is straight\n\n"
                 "| straight | n = 4 | | 6 | | 8 | |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (size_t group = 0; group < GROUPS; group++) {
        const size_t from = group * count / GROUPS, to = (group + 1) * count / GROUPS;
        if (from == to)
            continue;
        fprintf(out, "| %.0f to %.0f %% |", 100 * sorted[from]->straight_share, 100 * sorted[to - 1]->straight_share);
        for (size_t size = 0; size < SIZES; size++)
            print_ratios(sorted + from, to - from, size, out);
        fputc('\n', out);
    }
    fputc('\n', out);
}

static void print_correlations(const subject *const *some, size_t count, FILE *out) {
    fprintf(out, "Rank correlation with the ratio for n = 4, 6, 8:");
    for (int property = 0; property < 2; property++) {
        fprintf(out, property ? "; of the part of the turn at corners" : " of the straight part");
        for (size_t size = 0; size < SIZES; size++) {
            numbers shares = {0}, ratios = {0};
            for (size_t i = 0; i < count; i++) {
                add_number(&shares, property ? some[i]->corner_share : some[i]->straight_share);
                add_number(&ratios, ratio_of(some[i], size));
            }
            fprintf(out, "%s %.2f", size ? "," : "", correlate_ranks(&shares, &ratios));
        }
    }
    fprintf(out, ".\n\n");
}

/* Up to which straight part every n-arc is smaller, and from which on none is. */
static void print_limits(const subject *const *sorted, size_t count, size_t size, FILE *out) {
    size_t wins = 0, last_win = count;
    while (wins < count && ratio_of(sorted[wins], size) < 1)
        wins++;
    while (last_win > 0 && !(ratio_of(sorted[last_win - 1], size) < 1))
        last_win--;
    fprintf(out, "| %zu |", sizes[size]);
    if (wins > 0)
        fprintf(out, " %.0f %% (%zu of %zu) |", 100 * sorted[wins - 1]->straight_share, wins, count);
    else
        fprintf(out, " - |");
    if (last_win > 0) {
        const subject *last = sorted[last_win - 1];
        fprintf(out, " the %s, %.0f %% (%zu of %zu are straighter) |\n", last->name, 100 * last->straight_share,
                count - last_win, count);
    } else {
        fprintf(out, " - |\n");
    }
}

void print_relation(const study *all, FILE *out) {
    const subject **some = allocate(all->count, sizeof *some);
    const size_t count = pick(all, KINDS, some);
    qsort(some, count, sizeof *some, compare_straight);
    print_groups(some, count, out);
    fprintf(
        out,
        "| n | the n-arc is smaller on all outlines with a straight part up to | the straightest outline on which it "
        "is smaller |\n| --- | ---: | ---: |\n");
    for (size_t size = 0; size < SIZES; size++)
        print_limits(some, count, size, out);
    fputc('\n', out);
    print_correlations(some, count, out);
    free(some);
}
