/* SPDX-License-Identifier: MIT
 *
 * main.c - the evaluation of "Using Piecewise Circular Curves as a 2D Collision Primitive", done again: times, claims,
 * wrong answers. README.md beside this file says what is measured.
 *
 *     bench_paper [--out=FOLDER] [--quick]
 */
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

void begin_step(const char *what) {
    static int begun;
    fprintf(stderr, "%d %s\n", ++begun, what);
}

int main(int argc, char **argv) {
    static struct paper paper;
    uint64_t random = 1, answers_random = 2;
    paper.settings = full;
    paper.settings.folder = "out";
    for (int k = 1; k < argc; k++) {
        const char *folder = option_value(argv[k], "--out=");
        if (strcmp(argv[k], "--quick") == 0) {
            const char *kept = paper.settings.folder;
            paper.settings = quick;
            paper.settings.folder = kept;
        } else if (folder) {
            paper.settings.folder = folder;
        } else {
            fprintf(stderr, "usage: bench_paper [--out=FOLDER] [--quick]\n");
            return 2;
        }
    }
    paper.best = choose_best_isa();
    FILE *out = open_result(paper.settings.folder, "paper.md");
    fprintf(out, "%s, %s, %s. ", processor_name(), compiler_name, compiler_flags);
    begin_step("scenes");
    for (size_t size = 0; size < paper.settings.size_count; size++) {
        paper.templates[size] = make_templates(paper.settings.sizes[size], paper.settings.template_count, &random);
        for (enum situation situation = 0; situation < SITUATIONS; situation++)
            paper.scenes[size][situation] =
                make_scene(&paper.templates[size], situation, paper.settings.pair_count, &random);
    }
    measure_depths(&paper);
    add_rows(&paper, &random);
    size_t wrong = time_rows(&paper.settings, &random, out);
    time_perpendiculars(&paper);
    choose_best_isa();
    count_points(&paper);
    count_bytes(&paper);
    print_claims(&paper, out);
    print_tables(&paper, out);
    wrong += print_answers(&paper.settings, &answers_random, out);
    close_result(out);
    write_plots(&paper);
    return wrong > 0 ? 1 : 0;
}
