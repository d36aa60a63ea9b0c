/* SPDX-License-Identifier: MIT
 *
 * settled_tables.c - the times of settled piles: by kind of shape, and of a step by the size of the pile.
 */
#include "report.h"

#include <math.h>
#include <stdbool.h>

enum { COLUMNS = 7 };

/* A line of a table: what stands for the words in a pattern, and the line's title. */
struct line {
    const char *title, *value;
};

/* A table of rows: the name in each column, with a word that each line replaces. */
struct table {
    const char *head, *key;
    const char *columns[COLUMNS];
    const struct line *lines;
};

static const struct line kinds[] = {
    {"4 arcs", "n4"},   {"8 arcs", "n8"},   {"12 arcs", "n12"},       {"rounded 8-gons", "rounded"},
    {"boxes", "boxes"}, {"discs", "discs"}, {"capsules", "capsules"}, {"all kinds", "kinds"},
    {NULL, NULL}};

static const struct table tables[] = {
    {"ns per pair, 30,000 bodies, 64 shapes | overlap | contact | with hints | manifolds | Box2D | Chipmunk | a loop |",
     "KIND",
     {"overlap/KIND/settled/few/sorted/BEST", "contact/KIND/settled/few/sorted/BEST",
      "hinted/KIND/settled/few/sorted/BEST", "manifold/KIND/settled/few/sorted/BEST",
      "contact/KIND/settled/few/sorted/box2d-collide", "contact/KIND/settled/few/sorted/chipmunk",
      "contact/KIND/settled/few/sorted/avx2-loop"},
     kinds},
    {"ns per pair, 30,000 bodies, 4,096 shapes | overlap | contact | with hints | manifolds | Box2D | Chipmunk |",
     "KIND",
     {"overlap/KIND/settled/unique/sorted/BEST", "contact/KIND/settled/unique/sorted/BEST",
      "hinted/KIND/settled/unique/sorted/BEST", "manifold/KIND/settled/unique/sorted/BEST",
      "contact/KIND/settled/unique/sorted/box2d-collide", "contact/KIND/settled/unique/sorted/chipmunk"},
     kinds},
    {"ns per pair, 8 arcs, 64 shapes | 2,000 bodies | 30,000 | 1,000,000 | 1,000,000, 2 threads |",
     "STEP",
     {"STEP/n8/settled-small/few/sorted/BEST", "STEP/n8/settled/few/sorted/BEST",
      "STEP/n8/settled-large/few/sorted/BEST", "STEP/n8/settled-large/few/sorted/BEST/2threads"},
     (const struct line[]){{"boxes", "boxes"},
                           {"pairs", "pairs"},
                           {"match, gather hints", "match"},
                           {"whole step", "step"},
                           {"whole step, pairs kept", "kept"},
                           {NULL, NULL}}},
    {"ns per pair, 8-gons, one thread | 2,000 bodies | 30,000 |",
     "STEP",
     {"step/n8/settled-small/few/sorted/STEP", "step/n8/settled/few/sorted/STEP"},
     (const struct line[]){{"Box2D's collide", "box2d-world"}, {"Chipmunk's", "chipmunk-space"}, {NULL, NULL}}},
};

static bool print_line(const struct report *report, const struct table *table, const struct line *line, bool headed,
                       FILE *out) {
    double times[COLUMNS];
    size_t count = 0;
    bool any = false;
    for (; count < COLUMNS && table->columns[count]; count++) {
        char name[BENCH_NAME];
        replace_word(table->columns[count], table->key, line->value, name, sizeof name);
        times[count] = time_of(report, name);
        any |= !isnan(times[count]);
    }
    if (!any)
        return headed;
    if (!headed) {
        fprintf(out, "| %s\n| --- |", table->head);
        for (size_t k = 0; k < count; k++)
            fprintf(out, " ---: |");
        fputc('\n', out);
    }
    fprintf(out, "| %s |", line->title);
    for (size_t k = 0; k < count; k++)
        print_cell(out, times[k]);
    fputc('\n', out);
    return true;
}

void print_settled_times(const struct report *report, FILE *out) {
    for (size_t t = 0; t < sizeof tables / sizeof tables[0]; t++) {
        bool headed = false;
        for (const struct line *line = tables[t].lines; line->title; line++)
            headed = print_line(report, &tables[t], line, headed, out);
        if (headed)
            fputc('\n', out);
    }
}
