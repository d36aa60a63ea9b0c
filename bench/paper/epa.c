/* SPDX-License-Identifier: MIT
 *
 * epa.c - what EPA's threshold costs, and what it buys: GJK's contacts of colliding pairs, n up to 12.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"

double threshold_of(size_t index) { return pow(10, -(double)(index + 1)); }

static struct row row_with(const struct paper *paper, enum kind kind, size_t size, size_t threshold, const char *isa) {
    struct row row = row_of(&paper->scenes[size][COLLIDING], kind, QUESTION_CONTACT, NARC_METHOD_GJK, isa);
    row.options.tolerance = (float)threshold_of(threshold);
    return row;
}

/* GJK's depths against the exact ones; all pairs of the scene collide. */
static struct depth_error measure(const struct paper *paper, enum kind kind, size_t size, size_t threshold) {
    const struct scene *scene = &paper->scenes[size][COLLIDING];
    const size_t count = scene->pair_count;
    const narc_bodies bodies = bodies_of(scene->bodies, 2 * count);
    const narc_pairs pairs = neighbours(count);
    narc_contact *exact = allocate(count, sizeof *exact), *found = allocate(count, sizeof *found);
    double *errors = allocate(count, sizeof *errors);
    uint8_t *outcomes = allocate(count, 1);
    const narc_method_options options = {
        .method = NARC_METHOD_GJK, .tolerance = (float)threshold_of(threshold), .out_outcomes = outcomes};
    const narc_query query = {.margin = INFINITY, .workers = all_workers()};
    struct depth_error error = {0, 0, 0, 0, 0};
    size_t found_count;
    narc_error reason;
    separate(scene->templates->shapes[kind], scene->bodies, count, exact);
    must(narc_find_contacts_by(scene->templates->methods[kind], &bodies, &pairs, &options, &query, found, count,
                               &found_count, &reason),
         &reason);
    for (size_t k = 0; k < count; k++) {
        const double size_of_pair = size_of(scene->templates->bounds[kind], &scene->bodies[2 * k]);
        errors[k] = fabs((double)found[k].separation - (double)exact[k].separation) / size_of_pair;
        error.limit += outcomes[k] == NARC_OUTCOME_LIMIT;
        error.rounding += outcomes[k] == NARC_OUTCOME_ROUNDING;
    }
    error.median = quantile(errors, count, 0.5);
    error.high = quantile(errors, count, 0.99);
    error.most = quantile(errors, count, 1);
    free(outcomes);
    free(errors);
    free(exact);
    free(found);
    return error;
}

void add_epa(struct paper *paper, struct epa *epa) {
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
            for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
                for (enum isa isa = 0; isa < ISAS; isa++)
                    epa->rows[isa][kind][threshold][size] =
                        add_row(&paper->rows, row_with(paper, kind, size, threshold, paper->isas[isa]));
                epa->errors[kind][threshold][size] = measure(paper, kind, size, threshold);
            }
}

static double cost_of(const struct paper *paper, const struct epa *epa, enum isa isa, enum kind kind, size_t threshold,
                      size_t size) {
    return paper->rows.list[epa->rows[isa][kind][threshold][size]].ns;
}

/* ------------------------------------------------------------------------------------------------ tables */

static void print_head(const char *title, FILE *out) {
    fprintf(out, "\n### %s\n\n| shapes | |", title);
    for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
        fprintf(out, " %.0e |", threshold_of(threshold));
    fprintf(out, "\n| --- | --- |");
    for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
        fprintf(out, " ---: |");
    fputc('\n', out);
}

static void print_shapes(const struct paper *paper, enum kind kind, size_t size, FILE *out) {
    fprintf(out, "| %zu-%s |", paper->settings.sizes[size], kind == KIND_ARC ? "arcs" : "gons");
}

static void print_costs(const struct paper *paper, const struct epa *epa, FILE *out) {
    print_head("GJK with EPA, collision scene: µs for 1,000 checks by threshold", out);
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t size = 0; size < paper->settings.figure_sizes; size++)
            for (int isa = ISAS - 1; isa >= 0; isa--) {
                print_shapes(paper, kind, size, out);
                fprintf(out, " %s |", paper->isas[isa]);
                for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
                    fprintf(out, " %.0f |", cost_of(paper, epa, (enum isa)isa, kind, threshold, size));
                fputc('\n', out);
            }
}

static void print_errors(const struct paper *paper, const struct epa *epa, FILE *out) {
    size_t limit = 0, rounding = 0;
    print_head("The same: error of the depth, in parts of the sum of both bounding radii", out);
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
            for (int which = 0; which < 3; which++) {
                print_shapes(paper, kind, size, out);
                fprintf(out, " %s |", which == 0 ? "median" : which == 1 ? "99 % are below" : "most");
                for (size_t threshold = 0; threshold < THRESHOLDS; threshold++) {
                    const struct depth_error *error = &epa->errors[kind][threshold][size];
                    fprintf(out, " %.1e |", which == 0 ? error->median : which == 1 ? error->high : error->most);
                }
                fputc('\n', out);
            }
            for (size_t threshold = 0; threshold < THRESHOLDS; threshold++) {
                limit += epa->errors[kind][threshold][size].limit;
                rounding += epa->errors[kind][threshold][size].rounding;
            }
        }
    fprintf(out, "\nOutcomes in all: LIMIT %zu, ROUNDING %zu.\n", limit, rounding);
}

void print_epa(const struct paper *paper, const struct epa *epa, FILE *out) {
    print_costs(paper, epa, out);
    print_errors(paper, epa, out);
}

/* ------------------------------------------------------------------------------------------------ plots */

/* One column for each kind and n: its title, then a line for each threshold. What is drawn: 0 cost, 1 median error, 2
 * the one that 99 % are below. */
static void write_columns(const struct paper *paper, const struct epa *epa, int what, const char *name) {
    FILE *file = open_result(paper->settings.folder, name);
    fprintf(file, "threshold");
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t size = 0; size < paper->settings.figure_sizes; size++)
            fprintf(file, "\t\"%zu-%s\"", paper->settings.sizes[size], kind == KIND_ARC ? "arcs" : "gons");
    for (size_t threshold = 0; threshold < THRESHOLDS; threshold++) {
        fprintf(file, "\n%g", threshold_of(threshold));
        for (enum kind kind = 0; kind < KINDS; kind++)
            for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
                const struct depth_error *error = &epa->errors[kind][threshold][size];
                fprintf(file, "\t%.4g",
                        what == 0   ? cost_of(paper, epa, BEST, kind, threshold, size)
                        : what == 1 ? error->median
                                    : error->high);
            }
    }
    fputc('\n', file);
    close_result(file);
}

void write_epa(const struct paper *paper, const struct epa *epa) {
    write_columns(paper, epa, 0, "paper-epa-cost.dat");
    write_columns(paper, epa, 1, "paper-epa-median.dat");
    write_columns(paper, epa, 2, "paper-epa-high.dat");
}
