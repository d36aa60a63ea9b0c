/* SPDX-License-Identifier: MIT
 *
 * steps.c - how many support points GJK and EPA ask for.
 *
 * With a limit of k, a pair whose outcome is NARC_OUTCOME_LIMIT needs more than k; the mean of the numbers is the sum
 * of the parts of pairs that need more than 0, 1, 2 ...
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"

double mean_steps(const struct scene *scene, enum kind kind, enum question question, double threshold) {
    const size_t count = scene->pair_count;
    const narc_bodies bodies = bodies_of(scene->poses, 2 * count, kind);
    const narc_pairs pairs = neighbours(count);
    uint8_t *outcomes = allocate(count, 1);
    uint64_t *bits = allocate(NARC_BIT_WORDS(count), sizeof *bits);
    narc_contacts contacts = allocate_contacts(count);
    size_t sum = count, more = count, found;
    narc_query query = {.method = NARC_METHOD_GJK, .tolerance = (float)threshold, .out_outcomes = outcomes};
    narc_error error;
    for (query.iterations = 1; query.iterations < NARC_MAX_ITERATIONS && more > 0; query.iterations++) {
        if (question == QUESTION_OVERLAP)
            must(narc_query_overlaps(scene->templates->shapes, &bodies, &pairs, &query, 0, bits, &error), &error);
        else
            must(
                narc_query_contacts(scene->templates->shapes, &bodies, &pairs, &query, 0, 0, &contacts, &found, &error),
                &error);
        more = 0;
        for (size_t k = 0; k < count; k++)
            more += outcomes[k] == NARC_OUTCOME_LIMIT;
        sum += more;
    }
    free_contacts(&contacts);
    free(bits);
    free(outcomes);
    return (double)sum / (double)count;
}

/* ------------------------------------------------------------------------------------------------ tables */

static void print_sizes(const struct paper *paper, FILE *out) {
    static const char *const titles[SITUATIONS] = {"no collision", "collision"};
    fprintf(out, "\n### Support points of each body until GJK knows whether they collide, mean\n\n| |");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, size ? " %zu |" : " n = %zu |", paper->settings.sizes[size]);
    fprintf(out, "\n| --- |");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, " ---: |");
    for (enum situation situation = 0; situation < SITUATIONS; situation++)
        for (enum kind kind = 0; kind < KINDS; kind++) {
            fprintf(out, "\n| %s, %s |", kind == KIND_ARC ? "n-arcs" : "n-gons", titles[situation]);
            for (size_t size = 0; size < paper->settings.size_count; size++)
                fprintf(out, " %.2f |", mean_steps(&paper->scenes[size][situation], kind, QUESTION_OVERLAP, 0));
        }
    fputc('\n', out);
}

static void print_thresholds(const struct paper *paper, FILE *out) {
    fprintf(out, "\n### Support points in the longer of GJK's and EPA's search, collision scene, mean, by threshold\n\n"
                 "| shapes |");
    for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
        fprintf(out, " %.0e |", threshold_of(threshold));
    fprintf(out, "\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
            fprintf(out, "| %zu-%s |", paper->settings.sizes[size], kind == KIND_ARC ? "arcs" : "gons");
            for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
                fprintf(out, " %.2f |",
                        mean_steps(&paper->scenes[size][COLLIDING], kind, QUESTION_CONTACT, threshold_of(threshold)));
            fputc('\n', out);
        }
}

void print_steps(const struct paper *paper, FILE *out) {
    print_sizes(paper, out);
    print_thresholds(paper, out);
}
