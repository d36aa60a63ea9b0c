/* SPDX-License-Identifier: MIT
 *
 * tables.c - the tables and the data of the plots, from what was measured.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lists.h"
#include "paper.h"

/* A table: a line for each of a list of "title = name", for each instruction set if the name has "ISA"; a column for each
 * word of another list, which stands for "COL" in the names, or for each n. */
struct grid {
    const char *title, *labels; /* of the first columns */
    const char *const *columns; /* NULL: each n */
    size_t count;
    const char *lines, *format; /* "points": the mean and the most */
};

#define ALGORITHMS(test)                                                                                               \
    "n-arc SAT, exact = " test "/sat/ISA/N; n-arc SAT, first pair (the paper's) = " test "/first/ISA/N;"               \
    "n-arc GJK = " test "/gjk/ISA/N; n-gon SAT = " test "/gon-sat/ISA/N; n-gon GJK = " test "/gon-gjk/ISA/N"
#define CIRCLES(test) "; bounding circles alone = " test "/circle/ISA/N"
#define MOVING(n)                                                                                                      \
    "overlap, GJK, cold = moving/overlap/cold/" n "; overlap, GJK, warm = moving/overlap/warm/" n ";"                  \
    "contact, GJK, cold = moving/contact/cold/" n "; contact, GJK, warm = moving/contact/warm/" n
#define KIND_POINTS(kind)                                                                                              \
    "n-" kind "s, threshold 1e-01 = points/1e-01/" kind "/N; n-" kind "s, threshold 1e-02 = points/1e-02/" kind "/N;"  \
    "n-" kind "s, threshold 1e-03 = points/1e-03/" kind "/N; n-" kind "s, threshold 1e-04 = points/1e-04/" kind "/N;"  \
    "n-" kind "s, threshold 1e-05 = points/1e-05/" kind "/N; n-" kind "s, threshold 1e-06 = points/1e-06/" kind "/N"

static const struct grid times[] = {
    {"No collision (the paper's figure 4): do they collide?", "µs for 1,000 checks", NULL, 0,
     ALGORITHMS("apart") CIRCLES("apart"), "time"},
    {"Collision (the paper's figure 5): depth, normal and point", "µs for 1,000 checks", NULL, 0, ALGORITHMS("contact"),
     "time"},
    {"Collision: do they collide?", "µs for 1,000 checks", NULL, 0, ALGORITHMS("overlap") CIRCLES("overlap"), "time"},
};

static const struct grid others[] = {
    {"Support points of each body until GJK knows whether they collide: mean, most", "", NULL, 0,
     "n-arcs, no collision = points/apart/arc/N; n-gons, no collision = points/apart/gon/N;"
     "n-arcs, collision = points/colliding/arc/N; n-gons, collision = points/colliding/gon/N",
     "points"},
    {"Support points in the longer of GJK's and EPA's search, collision scene: mean, most", "", NULL, 0,
     KIND_POINTS("arc") ";" KIND_POINTS("gon"), "points"},
    {"Perpendiculars of polygons, plain C, one after the other, collision scene", "µs for 1,000 checks", NULL, 0,
     "yes or no, stored = perpendicular/stored/scalar/N;"
     "yes or no, computed, any length = perpendicular/computed/scalar/N;"
     "depth, stored = perpendicular/stored-depth/scalar/N;"
     "depth, computed and normalised = perpendicular/normalised-depth/scalar/N",
     "time"},
    {"Moving pairs, n = 8, by the motion in a frame, in parts of the size and in radians", "µs for 1,000 checks",
     motions, MOTIONS,
     MOVING("COL/ISA/8") ";overlap, exact SAT = moving/overlap/sat/COL/ISA/8;"
                         "contact, exact SAT = moving/contact/sat/COL/ISA/8",
     "time"},
    {"Moving pairs, motion 0.01", "µs for 1,000 checks", NULL, 0, MOVING("0.01/ISA/N"), "time"},
    {"Bytes of a shape, single precision", "", NULL, 0,
     "n-arc, SAT and GJK: centres, directions, radii, centroid = bytes/arc/N;"
     "n-gon, SAT (GJK: half of it): vertices, perpendiculars = bytes/gon/N;"
     "this library, all methods: circles around and inside, junction angles, arcs, box = bytes/store/N",
     "count"},
};

/* ------------------------------------------------------------------------------------------------ tables */

static void print_head(const struct paper *paper, const struct grid *grid, bool isas, FILE *out) {
    const size_t count = grid->columns ? grid->count : paper->settings.size_count;
    fprintf(out, "\n### %s\n\n| %s |%s", grid->title, grid->labels, isas ? " |" : "");
    for (size_t k = 0; k < count; k++)
        if (grid->columns)
            fprintf(out, " %s |", grid->columns[k]);
        else
            fprintf(out, k ? " %zu |" : " n = %zu |", paper->settings.sizes[k]);
    fprintf(out, "\n| --- |%s", isas ? " --- |" : "");
    for (size_t k = 0; k < count; k++)
        fprintf(out, " ---: |");
    fputc('\n', out);
}

static void print_cell(const struct grid *grid, const char *pattern, const char *column, const char *isa, size_t n,
                       FILE *out) {
    const double value = value_at(pattern, column, isa, n);
    char most[ITEM_VALUE];
    snprintf(most, sizeof most, "most-%s", pattern);
    if (strcmp(grid->format, "error") == 0)
        fprintf(out, " %.1e |", value);
    else if (strcmp(grid->format, "points") == 0)
        fprintf(out, " %.2f, %.0f |", value, value_at(most, column, isa, n));
    else
        fprintf(out, value < 99.95 && strcmp(grid->format, "time") == 0 ? " %.1f |" : " %.0f |", value);
}

static void print_lines(const struct paper *paper, const struct grid *grid, FILE *out) {
    struct item lines[MOST_ITEMS];
    const size_t line_count = read_items(grid->lines, lines);
    const size_t count = grid->columns ? grid->count : paper->settings.size_count;
    for (size_t line = 0; line < line_count; line++)
        for (int isa = 0; isa < (strstr(lines[line].value, "ISA") ? 2 : 1); isa++) {
            const char *name = isa ? "scalar" : paper->best;
            fprintf(out, "| %s |", lines[line].title);
            if (strstr(lines[line].value, "ISA"))
                fprintf(out, " %s |", name);
            for (size_t k = 0; k < count; k++)
                print_cell(grid, lines[line].value, grid->columns ? grid->columns[k] : "", name,
                           paper->settings.sizes[grid->columns ? 0 : k], out);
            fputc('\n', out);
        }
}

static void print_grid(const struct paper *paper, const struct grid *grid, FILE *out) {
    print_head(paper, grid, strstr(grid->lines, "ISA"), out);
    print_lines(paper, grid, out);
}

/* Every method on every instruction set that the machine has. */
static void print_lanes(FILE *out) {
    static const char *const tests[] = {"apart", "contact"};
    struct item lines[MOST_ITEMS];
    const size_t count = read_items(ALGORITHMS("COL") CIRCLES("COL") "; axis-aligned boxes = COL/aabb/ISA/N;"
                                                                     "oriented boxes = COL/obb/ISA/N",
                                    lines);
    fprintf(out, "\n### What vectors are worth, n = 8: µs for 1,000 checks, and how many times as fast as scalar\n\n"
                 "| |");
    for (int test = 0; test < 2; test++)
        for (size_t k = 0; narc_isa_name(k); k++)
            if (narc_isa_supported(narc_isa_name(k)))
                fprintf(out, " %s: %s |", test ? "collision, contact" : "no collision, overlap", narc_isa_name(k));
    fprintf(out, "\n| --- |");
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k)))
            fprintf(out, " ---: | ---: |");
    fputc('\n', out);
    for (size_t line = 0; line < count; line++) {
        fprintf(out, "| %s |", lines[line].title);
        for (int test = 0; test < 2; test++)
            for (size_t k = 0; narc_isa_name(k); k++) {
                const double ns = value_at(lines[line].value, tests[test], narc_isa_name(k), 8);
                const double scalar = value_at(lines[line].value, tests[test], "scalar", 8);
                if (!isnan(ns) && strcmp(narc_isa_name(k), "scalar") != 0)
                    fprintf(out, " %.1f (%.1f) |", ns, scalar / ns);
                else if (narc_isa_supported(narc_isa_name(k)))
                    fprintf(out, isnan(ns) ? " |" : " %.1f |", ns);
            }
        fputc('\n', out);
    }
}

/* A line or more for each of the figures' shapes; "KIND" and "SIZE" in their titles and names. */
static void print_thresholds(const struct paper *paper, struct grid grid, FILE *out) {
    char by_kind[512], lines[512], size[24];
    const char *pattern = grid.lines;
    print_head(paper, &grid, true, out);
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t k = 0; k < paper->settings.figure_sizes; k++) {
            snprintf(size, sizeof size, "%zu", paper->settings.sizes[k]);
            replace_word(pattern, "KIND", kind_names[kind], by_kind, sizeof by_kind);
            replace_word(by_kind, "SIZE", size, lines, sizeof lines);
            grid.lines = lines;
            print_lines(paper, &grid, out);
        }
}

void print_tables(const struct paper *paper, FILE *out) {
    for (size_t k = 0; k < sizeof times / sizeof times[0]; k++)
        print_grid(paper, &times[k], out);
    print_lanes(out);
    print_thresholds(paper,
                     (struct grid){"GJK with EPA, collision scene, by threshold", "µs for 1,000 checks", thresholds,
                                   THRESHOLDS, "SIZE-KINDs = epa/KIND/COL/ISA/SIZE", "time"},
                     out);
    print_thresholds(paper,
                     (struct grid){"The same: error of the depth, in parts of the sum of both bounding radii", "",
                                   thresholds, THRESHOLDS,
                                   "SIZE-KINDs | median = depth-median/KIND/COL/SIZE;"
                                   "SIZE-KINDs | 99 % are below = depth-high/KIND/COL/SIZE;"
                                   "SIZE-KINDs | most = depth-most/KIND/COL/SIZE",
                                   "error"},
                     out);
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++)
        print_grid(paper, &others[k], out);
}

/* ------------------------------------------------------------------------------------------------ plots */

/* A column for each line of a list, under its title; a line for each n, or each of `xs`. */
static void write_columns(const struct paper *paper, const char *name, const char *isa, const char *const *xs,
                          size_t count, const char *list) {
    struct item columns[MOST_ITEMS];
    const size_t column_count = read_items(list, columns);
    FILE *file = open_result(paper->settings.folder, name);
    fprintf(file, xs ? "x" : "n");
    for (size_t k = 0; k < column_count; k++)
        fprintf(file, "\t\"%s\"", columns[k].title);
    for (size_t x = 0; x < (xs ? count : paper->settings.size_count); x++) {
        if (xs)
            fprintf(file, "\n%s", xs[x]);
        else
            fprintf(file, "\n%zu", paper->settings.sizes[x]);
        for (size_t k = 0; k < column_count; k++)
            fprintf(file, "\t%.4g",
                    value_at(columns[k].value, xs ? xs[x] : "", isa, paper->settings.sizes[xs ? 0 : x]));
    }
    fputc('\n', file);
    close_result(file);
}

void write_plots(const struct paper *paper) {
    static const char *const quantities[] = {"epa", "depth-median", "depth-high"};
    static const char *const names[] = {"paper-epa-cost.dat", "paper-epa-median.dat", "paper-epa-high.dat"};
    write_columns(paper, "paper-apart-best.dat", paper->best, NULL, 0, ALGORITHMS("apart"));
    write_columns(paper, "paper-apart-scalar.dat", "scalar", NULL, 0, ALGORITHMS("apart"));
    write_columns(paper, "paper-colliding-best.dat", paper->best, NULL, 0, ALGORITHMS("contact"));
    write_columns(paper, "paper-colliding-scalar.dat", "scalar", NULL, 0, ALGORITHMS("contact"));
    write_columns(paper, "paper-warm-overlap.dat", paper->best, motions, MOTIONS,
                  "GJK, cold = moving/overlap/cold/COL/ISA/8; GJK, warm = moving/overlap/warm/COL/ISA/8;"
                  "exact SAT = moving/overlap/sat/COL/ISA/8");
    write_columns(paper, "paper-warm-contact.dat", paper->best, motions, MOTIONS,
                  "GJK, cold = moving/contact/cold/COL/ISA/8; GJK, warm = moving/contact/warm/COL/ISA/8;"
                  "exact SAT = moving/contact/sat/COL/ISA/8");
    for (int what = 0; what < 3; what++) {
        char list[1024] = "";
        for (enum kind kind = 0; kind < KINDS; kind++)
            for (size_t size = 0; size < paper->settings.figure_sizes; size++)
                snprintf(list + strlen(list), sizeof list - strlen(list), "%s%zu-%ss = %s/%s/COL/%s%zu",
                         *list ? "; " : "", paper->settings.sizes[size], kind_names[kind], quantities[what],
                         kind_names[kind], what ? "" : "ISA/", paper->settings.sizes[size]);
        write_columns(paper, names[what], paper->best, thresholds, THRESHOLDS, list);
    }
    FILE *file = open_result(paper->settings.folder, "paper-settings.gp");
    fprintf(file, "best = \"%s\"\nmoving = 8\nshapes = %zu\n", paper->best, paper->settings.figure_sizes);
    close_result(file);
}
