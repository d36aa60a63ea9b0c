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

static struct step_count count_scene(const struct scene *scene, enum kind kind, enum question question,
                                     double threshold) {
    const size_t count = scene->pair_count;
    const narc_bodies bodies = bodies_of(scene->bodies, 2 * count);
    const narc_pairs pairs = neighbours(count);
    const narc_methods *methods = scene->templates->methods[kind];
    uint8_t *outcomes = allocate(count, 1);
    uint64_t *bits = allocate(NARC_BIT_WORDS(count), sizeof *bits);
    narc_contact *contacts = allocate(count, sizeof *contacts);
    size_t sum = count, more = count, found;
    narc_method_options options = {.method = NARC_METHOD_GJK, .tolerance = (float)threshold, .out_outcomes = outcomes};
    const narc_query query = {.workers = all_workers()};
    narc_error error;
    struct step_count steps = {.most = 1};
    for (options.iterations = 1; options.iterations < NARC_MAX_ITERATIONS && more > 0; options.iterations++) {
        if (question == QUESTION_OVERLAP)
            must(narc_find_overlaps_by(methods, &bodies, &pairs, &options, &query, bits, &error), &error);
        else
            must(narc_find_contacts_by(methods, &bodies, &pairs, &options, &query, contacts, count, &found, &error),
                 &error);
        more = 0;
        for (size_t k = 0; k < count; k++)
            more += outcomes[k] == NARC_OUTCOME_LIMIT;
        sum += more;
        if (more > 0)
            steps.most = options.iterations + 1;
    }
    free(contacts);
    free(bits);
    free(outcomes);
    steps.mean = (double)sum / (double)count;
    return steps;
}

void count_steps(const struct paper *paper, struct steps *steps) {
    begin_step("steps of GJK and EPA");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        for (enum kind kind = 0; kind < KINDS; kind++) {
            const struct scene *scenes = paper->scenes[size];
            for (enum situation situation = 0; situation < SITUATIONS; situation++)
                steps->overlap[situation][kind][size] = count_scene(&scenes[situation], kind, QUESTION_OVERLAP, 0);
            for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
                steps->contact[kind][threshold][size] =
                    count_scene(&scenes[COLLIDING], kind, QUESTION_CONTACT, threshold_of(threshold));
        }
}

/* ------------------------------------------------------------------------------------------------ tables */

/* The mean of each scene, and the most of any pair. */
static void print_row(const struct paper *paper, const char *title, const struct step_count *counts, FILE *out) {
    fprintf(out, "| %s |", title);
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, " %.2f, %zu |", counts[size].mean, counts[size].most);
    fputc('\n', out);
}

void print_steps(const struct paper *paper, const struct steps *steps, FILE *out) {
    static const char *const kinds[KINDS] = {"arcs", "gons"};
    char title[64];
    print_sizes_head(paper, "Support points of each body until GJK knows whether they collide: mean, most", "| |", "",
                     out);
    for (enum situation situation = 0; situation < SITUATIONS; situation++)
        for (enum kind kind = 0; kind < KINDS; kind++) {
            snprintf(title, sizeof title, "n-%s, %s", kinds[kind], situation == APART ? "no collision" : "collision");
            print_row(paper, title, steps->overlap[situation][kind], out);
        }
    print_sizes_head(paper, "Support points in the longer of GJK's and EPA's search, collision scene: mean, most",
                     "| |", "", out);
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t threshold = 0; threshold < THRESHOLDS; threshold++) {
            snprintf(title, sizeof title, "n-%s, threshold %.0e", kinds[kind], threshold_of(threshold));
            print_row(paper, title, steps->contact[kind][threshold], out);
        }
}
