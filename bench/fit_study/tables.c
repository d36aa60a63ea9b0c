/* SPDX-License-Identifier: MIT
 *
 * tables.c - the paper's tables with ours beside them, the verdicts on its ratios, and all areas.
 */
#include <math.h>
#include <string.h>

#include "study.h"

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
enum { PAPER_TABLES = sizeof paper_tables / sizeof paper_tables[0] };

static const subject *find(const study *all, const char *name) {
    for (size_t i = 0; name && i < all->count; i++)
        if (strcmp(all->subjects[i].name, name) == 0)
            return &all->subjects[i];
    return NULL;
}

static void print_cell(FILE *out, const char *format, double value) {
    fputs(" ", out);
    if (isnan(value))
        fputs("none", out);
    else
        fprintf(out, format, value);
    fputs(" |", out);
}

/* ---------------------------------------------------------------------------- verdicts */

static void print_verdict(const paper_table *table, const study *all, size_t size, FILE *out) {
    const double paper = table->n_arc[size] / table->n_gon[size];
    const char *beaten_by[2] = {NULL, NULL};
    size_t compared = 0, beaten = 0;
    fprintf(out, "| %s | %zu | %.3f |", table->name, sizes[size], paper);
    for (size_t k = 0; k < 2; k++) {
        const subject *ours = find(all, table->ours[k]);
        if (ours) {
            const double greedy = ours->fits[N_ARC][size].made.area / ours->greedy[size];
            fprintf(out, "%s %s %.3f (%.3f)", compared ? "," : "", ours->name, ratio_of(ours, size), greedy);
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

void print_verdicts(const study *all, FILE *out) {
    fprintf(out, "### The paper's ratios\n\n"
                 "| the paper's outline | n | its n-arc / n-gon | ours, least n-gon (n-gon by taking sides away) | |\n"
                 "| --- | ---: | ---: | --- | --- |\n");
    for (size_t k = 0; k < PAPER_TABLES; k++)
        for (size_t size = 0; size < SIZES; size++)
            print_verdict(&paper_tables[k], all, size, out);
    fputc('\n', out);
}

/* ---------------------------------------------------------------------------- the four */

static const char four_columns[] =
    "| area, hull = 1: 4 | 6 | 8 | largest distance, %: 4 | 6 | 8 | mean distance, %: 4 | 6 | 8 | seconds: 4 | 6 | 8 "
    "|\n"
    "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
enum { OTHER_COLUMNS = 3 * SIZES }; /* behind the areas */

static void print_family(const subject *of, family which, FILE *out) {
    fprintf(out, "| %s |", family_names[which]);
    for (size_t size = 0; size < SIZES; size++)
        print_cell(out, "%.4f", area_of(of, which, size));
    for (int column = 0; column < OTHER_COLUMNS; column++) {
        const fit *at = &of->fits[which][column % SIZES];
        const double values[] = {100 * at->made.max_distance / of->extent, 100 * at->made.mean_distance / of->extent,
                                 at->made.seconds};
        print_cell(out, "%.2f", at->found ? values[column / SIZES] : NAN);
    }
    fputc('\n', out);
}

/* A row with numbers under the areas only. */
static void print_row(FILE *out, const char *what, const char *format, const double *values) {
    fprintf(out, "| %s |", what);
    for (size_t size = 0; size < SIZES; size++)
        print_cell(out, format, values[size]);
    for (int column = 0; column < OTHER_COLUMNS; column++)
        fputs(" |", out);
    fputc('\n', out);
}

static void print_paper_rows(const paper_table *table, FILE *out) {
    double ratios[SIZES];
    char what[128];
    for (size_t size = 0; size < SIZES; size++)
        ratios[size] = table->n_arc[size] / table->n_gon[size];
    snprintf(what, sizeof what, "the paper's %s: n-arc, pixels", table->name);
    print_row(out, what, "%.0f", table->n_arc);
    print_row(out, "its n-gon, pixels", "%.0f", table->n_gon);
    print_row(out, "its n-arc / n-gon", "%.3f", ratios);
}

void print_paper_tables(const study *all, FILE *out) {
    fprintf(out, "### The paper's four outlines\n\n");
    for (size_t i = 0; i < PAPER_SUBJECTS; i++) {
        const subject *of = &all->subjects[i];
        fprintf(out, "| %s %s", of->name, four_columns);
        for (int which = 0; which < FAMILIES; which++)
            print_family(of, (family)which, out);
        double ratios[SIZES], greedy[SIZES];
        for (size_t size = 0; size < SIZES; size++) {
            ratios[size] = ratio_of(of, size);
            greedy[size] = of->greedy[size] / of->around.area;
        }
        print_row(out, "n-gon by taking sides away", "%.4f", greedy);
        print_row(out, "n-arc / n-gon", "%.3f", ratios);
        for (size_t k = 0; k < PAPER_TABLES; k++)
            if (strcmp(paper_tables[k].ours[0], of->name) == 0)
                print_paper_rows(&paper_tables[k], out);
        fputc('\n', out);
    }
}

/* ---------------------------------------------------------------------------- all */

void print_all(const study *all, FILE *out) {
    fprintf(out, "### All outlines: areas, hull = 1\n\n| |");
    for (int which = 0; which < FAMILIES; which++)
        fprintf(out, " %s: 4 | 6 | 8 |", family_names[which]);
    fprintf(out, " n-arc / n-gon: 4 | 6 | 8 | straight |\n| --- |");
    for (int column = 0; column < SIZES * (FAMILIES + 1) + 1; column++)
        fprintf(out, " ---: |");
    fputc('\n', out);
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (of->of == GRAINS && of->number > SHOWN_GRAINS)
            continue;
        fprintf(out, "| %s |", of->name);
        for (int cell = 0; cell < FAMILIES * SIZES; cell++)
            print_cell(out, "%.4f", area_of(of, (family)(cell / SIZES), (size_t)cell % SIZES));
        for (size_t size = 0; size < SIZES; size++)
            print_cell(out, "%.3f", ratio_of(of, size));
        fprintf(out, " %.0f %% |\n", 100 * of->straight_share);
    }
    fputc('\n', out);
}
