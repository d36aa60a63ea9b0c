/* SPDX-License-Identifier: MIT
 *
 * main.c - the evaluation of "Using Piecewise Circular Curves as a 2D Collision Primitive", done again: times, claims,
 * wrong answers. README.md beside this file says what is measured.
 *
 *     bench_paper [--out=FOLDER] [--quick]
 */
#include <stdlib.h>
#include <string.h>

#include "paper.h"

static const struct settings full = {
    .sizes = {4, 6, 8, 10, 12, 16, 24, 32, 48, 64},
    .size_count = 10,
    .figure_sizes = 5,
    .template_count = 256,
    .pair_count = 16384,
    .repetitions = 9,
    .least_time = 15e6,
    .answer_pairs = 2000000,
    .chunk = 250000,
};

/* Everything once, on little: does it run, and are the answers right? */
static const struct settings quick = {
    .sizes = {4, 8, 12, 64},
    .size_count = 4,
    .figure_sizes = 3,
    .template_count = 16,
    .pair_count = 512,
    .repetitions = 2,
    .least_time = 0,
    .answer_pairs = 20000,
    .chunk = 8192,
};

static int begun, in_all;

void set_steps(int count) { in_all = count; }

void begin_step(const char *what) { fprintf(stderr, "%d/%d %s\n", ++begun, in_all, what); }

static void make_scenes(struct paper *paper, uint64_t *random) {
    const struct settings *settings = &paper->settings;
    for (size_t size = 0; size < settings->size_count; size++) {
        char what[64];
        snprintf(what, sizeof what, "scenes: n = %zu", settings->sizes[size]);
        begin_step(what);
        paper->templates[size] = make_templates(settings->sizes[size], settings->template_count, random);
        for (enum situation situation = 0; situation < SITUATIONS; situation++)
            paper->scenes[size][situation] =
                make_scene(&paper->templates[size], situation, settings->pair_count, random);
    }
}

/* Where repetitions of most rows differ by more than this, something else was running. */
static const double busy = 0.1;

/* The middle half of a row's repetitions: how far apart, for the median row and for nine rows of ten. */
static void print_noise(const struct paper *paper, FILE *out) {
    double *spreads = allocate(paper->rows.count, sizeof *spreads);
    for (size_t k = 0; k < paper->rows.count; k++)
        spreads[k] = paper->rows.list[k].spread;
    const double median = quantile(spreads, paper->rows.count, 0.5), most = quantile(spreads, paper->rows.count, 0.9);
    if (median > busy)
        fprintf(stderr, "bench_paper: repetitions differ by %.0f %%: the machine was busy, times mean little\n",
                100 * median);
    fprintf(
        out,
        "%zu templates, %zu pairs, one thread; medians of %d repetitions, whose middle half lies within %.1f %% for "
        "half of the rows and within %.1f %% for nine of ten.\n",
        paper->settings.template_count, paper->settings.pair_count, paper->settings.repetitions, 100 * median,
        100 * most);
    free(spreads);
}

/* Wrong booleans of timed rows and moving pairs. Only sat-first may have any: no pair of the rows is so close to
 * touching that rounding could decide. */
static size_t count_wrong(const struct paper *paper, const struct frames *frames) {
    size_t wrong = 0;
    for (size_t k = 0; k < paper->rows.count; k++) {
        const struct row *row = &paper->rows.list[k];
        if (row->options.method != NARC_METHOD_SAT_FIRST && row->wrong > 0) {
            fprintf(stderr, "bench_paper: %s, %s: %zu of %zu answers are wrong\n",
                    narc_method_name(row->options.method), row->isa, row->wrong, row->pair_count);
            wrong += row->wrong;
        }
    }
    for (size_t motion = 0; motion < MOTIONS; motion++)
        wrong += frames->wrong[0][motion] + frames->wrong[1][motion];
    return wrong;
}

static void write_plot_settings(const struct paper *paper, const struct frames *frames) {
    FILE *file = open_result(paper->settings.folder, "paper-settings.gp");
    fprintf(file, "best = \"%s\"\nmoving = %zu\nshapes = %zu\n", paper->isas[BEST],
            paper->settings.sizes[frames->moving_size], paper->settings.figure_sizes);
    close_result(file);
}

static bool take_options(int argc, char **argv, struct settings *out) {
    const char *folder = "out";
    *out = full;
    for (int k = 1; k < argc; k++)
        if (strcmp(argv[k], "--quick") == 0)
            *out = quick;
        else if (option_value(argv[k], "--out="))
            folder = option_value(argv[k], "--out=");
        else
            return false;
    out->folder = folder;
    return true;
}

int main(int argc, char **argv) {
    static struct paper paper;
    static struct figures figures;
    static struct epa epa;
    static struct lanes lanes;
    static struct steps steps;
    static struct perpendiculars perpendiculars;
    static struct frames frames;
    uint64_t random = 1;
    if (!take_options(argc, argv, &paper.settings)) {
        fprintf(stderr, "usage: bench_paper [--out=FOLDER] [--quick]\n");
        return 2;
    }
    enum { FAMILY_STEPS = 5, OTHER_STEPS = 5 };
    set_steps((int)paper.settings.size_count + paper.settings.repetitions + FAMILY_STEPS + OTHER_STEPS);
    paper.isas[BEST] = choose_best_isa();
    paper.isas[SCALAR] = "scalar";
    FILE *out = open_result(paper.settings.folder, "paper.md");
    fprintf(out, "%s, %s, %s. ", processor_name(), compiler_name, compiler_flags);
    make_scenes(&paper, &random);
    begin_step("errors of depths");
    add_figures(&paper, &figures);
    add_epa(&paper, &epa);
    add_lanes(&paper, &lanes);
    begin_step("moving scenes");
    add_frames(&paper, &frames, &random);
    time_rows(&paper.rows, paper.settings.repetitions, paper.settings.least_time, &random);
    print_noise(&paper, out);
    time_perpendiculars(&paper, &perpendiculars);
    choose_best_isa();
    count_steps(&paper, &steps);
    const struct results results = {&paper, &figures, &epa, &steps, &perpendiculars, &lanes, &frames};
    print_claims(&results, out);
    print_figures(&paper, &figures, out);
    print_lanes(&paper, &lanes, out);
    print_epa(&paper, &epa, out);
    print_steps(&paper, &steps, out);
    print_perpendiculars(&paper, &perpendiculars, out);
    print_frames(&paper, &frames, out);
    print_storage(&paper, out);
    const size_t broken = print_answers(&paper.settings, &random, out);
    close_result(out);
    write_figures(&paper, &figures);
    write_epa(&paper, &epa);
    write_frames(&paper, &frames);
    write_plot_settings(&paper, &frames);
    if (broken > 0)
        fprintf(stderr, "bench_paper: %zu answers break what narc_methods.h promises\n", broken);
    return count_wrong(&paper, &frames) + broken > 0 ? 1 : 0;
}
