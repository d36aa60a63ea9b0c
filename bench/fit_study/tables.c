/* SPDX-License-Identifier: MIT
 *
 * tables.c - the report: what the paper says against what was measured, and medians over many outlines.
 */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "fits.h"
#include "numbers.h"

static const subject *find(const study *all, const char *name) {
    for (size_t i = 0; name && i < all->count; i++)
        if (strcmp(all->subjects[i].name, name) == 0)
            return &all->subjects[i];
    return NULL;
}

/* ---------------------------------------------------------------------------- what the paper says */

/* Each statement is made into numbers and a range; it holds if all of them lie in the range. */
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
    for (size_t size = first; size <= last; size++)
        ratios = join(ratios, ratio_of(find(all, name), size));
    return ratios;
}

static span medians_of(const subject *const *some, size_t count) {
    span medians = {INFINITY, -INFINITY};
    for (size_t size = 0; size < SIZES; size++) {
        numbers ratios = {0};
        for (size_t i = 0; i < count; i++)
            add_number(&ratios, ratio_of(some[i], size));
        medians = join(medians, find_quantile(&ratios, 0.5));
    }
    return medians;
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

static void print_share(FILE *out, const char *text, const char *measure, size_t outlines, size_t count) {
    const double share = (double)outlines / (double)count;
    print_claim(out, "I", text, measure, most_of, (span){share, share});
}

static void print_claims(const study *all, const subject *const *some, size_t count, FILE *out) {
    enum { FOUR, SIX, EIGHT };
    const double octagon = value_of(find(all, "house"), N_GON, EIGHT, AREA);
    size_t poor_circles = 0, poor_boxes = 0, better_boxes = 0, good_polygons = 0;
    for (size_t i = 0; i < count; i++) {
        const bounds found = find_bounds(some[i]);
        poor_circles += found.areas[CIRCLE] >= POOR;
        poor_boxes += found.areas[AABB] >= POOR;
        better_boxes += found.areas[OBB] < 0.999 * fmin(found.areas[CIRCLE], found.areas[AABB]);
        good_polygons += found.areas[POLYGON] <= GOOD;
    }
    fprintf(out, "### What the paper says\n\n| section | the paper | measured as | holds in | ours |\n"
                 "| --- | --- | --- | --- | --- |\n");
    print_share(out, "circles are a poor fit for many objects", "part of the outlines with 1.25 of the hull's area",
                poor_circles, count);
    print_share(out, "AABBs are a poor fit for many objects", "part of the outlines with 1.25 of the hull's area",
                poor_boxes, count);
    print_share(out, "OBBs are a better fit for most objects",
                "part of the outlines where it is the least of the three", better_boxes, count);
    print_share(out, "polygons are a good fit for many objects",
                "part of the outlines whose 8-gon has at most 1.1 of the hull's area", good_polygons, count);
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
                medians_of(some, count));
    fputc('\n', out);
}

/* The paper's tables that can be read: areas in pixels of images that are not at hand. */
typedef struct paper_table {
    const char *name;
    const char *ours[2]; /* the subjects that it may be compared with; the second may be NULL */
    double n_arc[SIZES], n_gon[SIZES];
} paper_table;

static const paper_table paper_tables[] = {
    {"ghost (figure 6)", {"ghost", NULL}, {250709, 193206, 190113}, {205817, 193536, 188046}},
    {"spaceship (figure 8)", {"rocket", "tree"}, {139253, 120478, 118935}, {122248, 120166, 113624}},
};

static void print_verdict(const paper_table *table, const study *all, size_t size, FILE *out) {
    const double paper = table->n_arc[size] / table->n_gon[size];
    const char *beaten_by[2] = {NULL, NULL};
    size_t compared = 0, beaten = 0;
    fprintf(out, "| %s | %zu | %.3f |", table->name, sizes[size], paper);
    for (size_t k = 0; k < 2; k++) {
        const subject *ours = find(all, table->ours[k]);
        if (ours) {
            fprintf(out, "%s %s %.3f", compared ? "," : "", ours->name, ratio_of(ours, size));
            compared++;
            if (ratio_of(ours, size) < paper)
                beaten_by[beaten++] = ours->name;
        }
    }
    if (beaten == 0)
        fprintf(out, " | **not beaten** |\n");
    else if (beaten == compared)
        fprintf(out, " | beaten%s |\n", compared > 1 ? " by both" : "");
    else
        fprintf(out, " | beaten by the %s only |\n", beaten_by[0]);
}

static void print_verdicts(const study *all, FILE *out) {
    fprintf(out, "### The paper's ratios\n\n"
                 "| the paper's outline | n | its n-arc / n-gon | ours | |\n"
                 "| --- | ---: | ---: | --- | --- |\n");
    for (size_t k = 0; k < sizeof paper_tables / sizeof *paper_tables; k++)
        for (size_t size = 0; size < SIZES; size++)
            print_verdict(&paper_tables[k], all, size, out);
    fputc('\n', out);
}

/* ---------------------------------------------------------------------------- medians */

static void print_bounds(const subject *const *some, size_t count, FILE *out) {
    numbers values[BOUNDS] = {0};
    fprintf(out, "### Figure 2: areas of simple shapes, hull = 1\n\n| | circle | AABB | OBB | 8-gon |\n"
                 "| --- | ---: | ---: | ---: | ---: |\n");
    for (size_t i = 0; i <= count; i++) {
        const bounds found = i < count ? find_bounds(some[i]) : (bounds){0};
        if (i == count || some[i]->of == PAPER)
            fprintf(out, "| %s |", i < count ? some[i]->name : "median of all outlines but the grains");
        for (int which = 0; which < BOUNDS; which++) {
            if (i < count)
                add_number(&values[which], found.areas[which]);
            if (i == count || some[i]->of == PAPER)
                fprintf(out, " %.3f |", i < count ? found.areas[which] : find_quantile(&values[which], 0.5));
        }
        if (i == count || some[i]->of == PAPER)
            fputc('\n', out);
    }
    fputc('\n', out);
}

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
        const double ratio = value_of(some[i], one, one_size, AREA) / value_of(some[i], other, other_size, AREA);
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

/* ---------------------------------------------------------------------------- grains */

/* A row of medians: of the ratios n-arc / n-gon if there is no family. */
static void print_medians(const char *what, const subject *const *some, size_t count, family which, quantity of,
                          int decimals, FILE *out) {
    fprintf(out, "| %s |", what);
    for (size_t size = 0; size < SIZES; size++) {
        numbers values = {0};
        for (size_t i = 0; i < count; i++)
            add_number(&values, which == FAMILIES ? ratio_of(some[i], size) : value_of(some[i], which, size, of));
        print_range(&values, decimals, out);
        fputs(" |", out);
    }
    fputc('\n', out);
}

static void print_grains(const subject *const *some, size_t count, FILE *out) {
    numbers discs = {0};
    char what[64];
    fprintf(out, "### Sand grains: median (least to largest)\n\n");
    if (count == 0) {
        fprintf(out, "Left out: the study was not given any.\n\n");
        return;
    }
    fprintf(out, "| | n = 4 | 6 | 8 |\n| --- | ---: | ---: | ---: |\n");
    for (family which = N_ARC; which < FAMILIES; which++) {
        snprintf(what, sizeof what, "%s: area, hull = 1", family_names[which]);
        print_medians(what, some, count, which, AREA, 4, out);
    }
    print_medians("n-arc: largest distance, %", some, count, N_ARC, LARGEST, 2, out);
    print_medians("n-arc: mean distance, %", some, count, N_ARC, MEAN, 2, out);
    for (size_t from = 0, to; from < count; from = to) { /* each sand by itself, which begin with number 1 */
        for (to = from + 1; to < count && some[to]->number > 1; to++) {
        }
        snprintf(what, sizeof what, "n-arc / n-gon, %zu grains of %.*s sand", to - from,
                 (int)strcspn(some[from]->name, " "), some[from]->name);
        print_medians(what, some + from, to - from, FAMILIES, AREA, 3, out);
    }
    for (size_t i = 0; i < count; i++)
        add_number(&discs, find_bounds(some[i]).areas[CIRCLE]);
    fprintf(out, "\nThe least disc around a grain has %.0f %% more area than its hull (median).\n\n",
            100 * (find_quantile(&discs, 0.5) - 1));
}

/* ---------------------------------------------------------------------------- the search */

static void print_trial(const study *all, bool spread, FILE *out) {
    for (size_t size = 0; size < SIZES; size++) {
        numbers found = {0};
        for (size_t i = 0; i < all->count; i++) {
            const trial *at = &all->subjects[i].trials[size];
            add_number(&found, 100 * (spread ? at->spread : at->excess));
        }
        print_range(&found, 3, out);
        fprintf(out, " |");
    }
    fputc('\n', out);
}

static void print_trials(const study *all, FILE *out) {
    fprintf(out,
            "### How far the search can be relied on: n-arcs, median (least to largest) in percent of the area\n\n"
            "All outlines but the grains; the last row has them too.\n\n"
            "| | n = 4 | 6 | 8 |\n| --- | ---: | ---: | ---: |\n"
            "| larger than with %d times the starts |",
            TIMES);
    print_trial(all, false, out);
    fprintf(out, "| largest over least, turned by 0, 20, 45, 110 degrees and in a mirror |");
    print_trial(all, true, out);
    fprintf(out, "| larger than with two arcs, or corners, less: how many, of all families | | %zu | %zu |\n\n",
            count_worse(all, 1), count_worse(all, 2));
}

/* ---------------------------------------------------------------------------- files */

void print_results(const study *all, FILE *out) {
    const subject **some = allocate(all->count, sizeof *some);
    const size_t count = pick(all, KINDS, some);
    print_claims(all, some, count, out);
    print_verdicts(all, out);
    print_bounds(some, count, out);
    print_families(some, count, out);
    print_contests(some, count, out);
    print_grains(some, pick(all, GRAINS, some), out);
    print_trials(all, out);
    free(some);
}

void print_csv(const study *all, FILE *out) {
    fprintf(out, "outline,kind,source,straight_share,family,n,arcs,edges,area,hull_area,largest_distance,"
                 "mean_distance,extent,seconds\n");
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        for (int cell = 0; cell < FAMILIES * SIZES; cell++) {
            const fit *at = &of->fits[cell / SIZES][cell % SIZES];
            fprintf(out, "\"%s\",%s,", of->name, kind_names[of->of]);
            if (of->character)
                fprintf(out, "U+%04X", (unsigned)of->character);
            else
                fputs(of->file ? of->file : "sand", out);
            fprintf(out, ",%.4f,%s,%zu,", of->straight_share, family_names[cell / SIZES], sizes[cell % SIZES]);
            if (at->found)
                fprintf(out, "%zu,%zu,%.9g,%.9g,%.6g,%.6g,%.9g,%.3f\n", at->made.arc_count, at->made.edge_count,
                        at->made.area, at->made.hull_area, at->made.max_distance, at->made.mean_distance, of->extent,
                        at->made.seconds);
            else
                fprintf(out, ",,,%.9g,,,%.9g,\n", of->hull_area, of->extent);
        }
    }
}

/* A block for each kind, two empty lines between. */
void print_points(const study *all, FILE *out) {
    for (kind which = PAPER; which < KINDS; which++) {
        fprintf(out, "%s\"%s\"\tstraight\t4\t6\t8\n", which == PAPER ? "" : "\n\n", kind_names[which]);
        for (size_t i = 0; i < all->count; i++) {
            const subject *of = &all->subjects[i];
            if (of->of == which)
                fprintf(out, "\"%s\"\t%.4f\t%.5f\t%.5f\t%.5f\n", of->name, of->straight_share, ratio_of(of, 0),
                        ratio_of(of, 1), ratio_of(of, 2));
        }
    }
}
