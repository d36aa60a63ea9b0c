/* SPDX-License-Identifier: MIT
 *
 * figures.c - the paper's figures 4 and 5: time against the number of arcs or edges.
 */
#include <math.h>
#include <string.h>

#include "paper.h"

static const struct {
    enum kind kind;
    narc_method method;
    const char *title;
} algorithms[ALGORITHMS] = {
    [ARC_SAT] = {KIND_ARC, NARC_METHOD_SAT, "n-arc SAT, exact"},
    [ARC_FIRST] = {KIND_ARC, NARC_METHOD_SAT_FIRST, "n-arc SAT, first pair (the paper's)"},
    [ARC_GJK] = {KIND_ARC, NARC_METHOD_GJK, "n-arc GJK"},
    [GON_SAT] = {KIND_GON, NARC_METHOD_POLYGON_SAT, "n-gon SAT"},
    [GON_GJK] = {KIND_GON, NARC_METHOD_GJK, "n-gon GJK"},
    [READING] = {KIND_ARC, NARC_METHOD_CIRCLE, "bounding circles alone"},
};

static const struct {
    enum situation situation;
    enum question question;
    const char *title;
} tests[TESTS] = {
    [APART_OVERLAP] = {APART, QUESTION_OVERLAP, "No collision (the paper's figure 4): do they collide?"},
    [COLLIDING_CONTACT] = {COLLIDING, QUESTION_CONTACT, "Collision (the paper's figure 5): depth, normal and point"},
    [COLLIDING_OVERLAP] = {COLLIDING, QUESTION_OVERLAP, "Collision: do they collide?"},
};

/* Bounding circles answer no more than that. */
static bool is_asked(enum test test, enum algorithm algorithm) {
    return algorithm != READING || tests[test].question == QUESTION_OVERLAP;
}

void add_figures(struct paper *paper, struct figures *figures) {
    for (enum isa isa = 0; isa < ISAS; isa++)
        for (enum test test = 0; test < TESTS; test++)
            for (enum algorithm algorithm = 0; algorithm < ALGORITHMS; algorithm++)
                for (size_t size = 0; size < paper->settings.size_count && is_asked(test, algorithm); size++) {
                    const struct scene *scene = &paper->scenes[size][tests[test].situation];
                    struct row row = row_of(scene, algorithms[algorithm].kind, tests[test].question,
                                            algorithms[algorithm].method, paper->isas[isa]);
                    if (algorithm == READING)
                        row.claim = -1;
                    figures->rows[isa][test][algorithm][size] = add_row(&paper->rows, row);
                }
}

static const struct row *row_at(const struct paper *paper, const struct figures *figures, enum isa isa, enum test test,
                                enum algorithm algorithm, size_t size) {
    return &paper->rows.list[figures->rows[isa][test][algorithm][size]];
}

double time_of(const struct paper *paper, const struct figures *figures, enum isa isa, enum test test,
               enum algorithm algorithm, size_t size) {
    return row_at(paper, figures, isa, test, algorithm, size)->ns;
}

double slope_of(const struct paper *paper, const double *times) {
    double count = 0, x_sum = 0, y_sum = 0, xx_sum = 0, xy_sum = 0;
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        const double x = log((double)paper->settings.sizes[size]), y = log(times[size]);
        if (paper->settings.sizes[size] < 8)
            continue;
        count++;
        x_sum += x, y_sum += y, xx_sum += x * x, xy_sum += x * y;
    }
    return count < 2 ? NAN : (count * xy_sum - x_sum * y_sum) / (count * xx_sum - x_sum * x_sum);
}

/* ------------------------------------------------------------------------------------------------ tables */

void print_sizes_head(const struct paper *paper, const char *title, const char *labels, const char *last, FILE *out) {
    fprintf(out, "\n### %s\n\n%s", title, labels);
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, size ? " %zu |" : " n = %zu |", paper->settings.sizes[size]);
    fprintf(out, "%s\n|", last);
    for (const char *bar = strchr(labels + 1, '|'); bar; bar = strchr(bar + 1, '|'))
        fprintf(out, " --- |");
    for (size_t size = 0; size < paper->settings.size_count + (*last != 0); size++)
        fprintf(out, " ---: |");
    fputc('\n', out);
}

/* Wrong answers per thousand, of the row of any instruction set: all give the same. */
static void print_wrong(const struct paper *paper, const struct figures *figures, enum test test,
                        enum algorithm algorithm, FILE *out) {
    size_t wrong = 0, checks = 0;
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        const struct row *row = row_at(paper, figures, BEST, test, algorithm, size);
        wrong += row->wrong;
        checks += row->pair_count;
    }
    if (algorithm == READING)
        fprintf(out, " |\n");
    else
        fprintf(out, " %zu of %zu |\n", wrong, checks);
}

static void print_table(const struct paper *paper, const struct figures *figures, enum test test, FILE *out) {
    print_sizes_head(paper, tests[test].title, "| µs for 1,000 checks | |", " wrong |", out);
    for (enum algorithm algorithm = 0; algorithm < ALGORITHMS; algorithm++) {
        for (int isa = ISAS - 1; isa >= 0 && is_asked(test, algorithm); isa--) {
            fprintf(out, "| %s | %s |", algorithms[algorithm].title, paper->isas[isa]);
            for (size_t size = 0; size < paper->settings.size_count; size++) {
                const double ns = time_of(paper, figures, (enum isa)isa, test, algorithm, size);
                fprintf(out, " %.*f |", ns < 100 ? 1 : 0, ns);
            }
            print_wrong(paper, figures, test, algorithm, out);
        }
    }
}

static void print_slopes(const struct paper *paper, const struct figures *figures, FILE *out) {
    fprintf(out, "\n### How the time grows: the exponent of n, fitted from n = 8 on\n\n| | ");
    for (enum test test = 0; test < TESTS; test++)
        for (int isa = ISAS - 1; isa >= 0; isa--)
            fprintf(out, "| %s, %s ",
                    test == APART_OVERLAP       ? "no collision"
                    : test == COLLIDING_CONTACT ? "collision, contact"
                                                : "collision, overlap",
                    paper->isas[isa]);
    fprintf(out, "|\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (enum algorithm algorithm = 0; algorithm < READING; algorithm++) {
        fprintf(out, "| %s |", algorithms[algorithm].title);
        for (enum test test = 0; test < TESTS; test++)
            for (int isa = ISAS - 1; isa >= 0; isa--) {
                double times[MAX_SIZES];
                for (size_t size = 0; size < paper->settings.size_count; size++)
                    times[size] = time_of(paper, figures, (enum isa)isa, test, algorithm, size);
                fprintf(out, " %.2f |", slope_of(paper, times));
            }
        fputc('\n', out);
    }
}

/* What was placed where. */
static void print_scenes(const struct paper *paper, FILE *out) {
    fprintf(out, "\n### The scenes: distances and depths of the n-arcs, in parts of the sum of both bounding radii\n\n"
                 "| n | scene | least | quartile | median | quartile | most | no room | left out |\n"
                 "| ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        for (enum situation situation = 0; situation < SITUATIONS; situation++) {
            const struct scene *scene = &paper->scenes[size][situation];
            const struct spread s = spread_of(scene);
            fprintf(out, "| %zu | %s | %.4f | %.4f | %.4f | %.4f | %.4f | %zu | %zu |\n", paper->settings.sizes[size],
                    situation == APART ? "no collision: distance" : "collision: depth", s.least, s.lower, s.median,
                    s.upper, s.most, scene->drawn_again, scene->left_out);
        }
}

void print_figures(const struct paper *paper, const struct figures *figures, FILE *out) {
    for (enum test test = 0; test < TESTS; test++)
        print_table(paper, figures, test, out);
    print_slopes(paper, figures, out);
    print_scenes(paper, out);
}

/* ------------------------------------------------------------------------------------------------ plots */

static void write_test(const struct paper *paper, const struct figures *figures, enum test test, enum isa isa,
                       const char *name) {
    FILE *file = open_result(paper->settings.folder, name);
    fprintf(file, "n");
    for (enum algorithm algorithm = 0; algorithm < READING; algorithm++)
        fprintf(file, "\t\"%s\"", algorithms[algorithm].title);
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        fprintf(file, "\n%zu", paper->settings.sizes[size]);
        for (enum algorithm algorithm = 0; algorithm < READING; algorithm++)
            fprintf(file, "\t%.4g", time_of(paper, figures, isa, test, algorithm, size));
    }
    fputc('\n', file);
    close_result(file);
}

void write_figures(const struct paper *paper, const struct figures *figures) {
    write_test(paper, figures, APART_OVERLAP, BEST, "paper-apart-best.dat");
    write_test(paper, figures, APART_OVERLAP, SCALAR, "paper-apart-scalar.dat");
    write_test(paper, figures, COLLIDING_CONTACT, BEST, "paper-colliding-best.dat");
    write_test(paper, figures, COLLIDING_CONTACT, SCALAR, "paper-colliding-scalar.dat");
}
