/* SPDX-License-Identifier: MIT
 *
 * main.c - options, rows, report.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "common.h"
#include "list.h"
#include "peers.h"
#include "report.h"

enum { DEFAULT_PAIRS = 65536, DEFAULT_PACKING = 1000000 };

struct options {
    size_t pair_count;
    bool all;
    const char *folder;
};

/* Takes our options out of the list and leaves Google Benchmark's. */
static struct options take_options(int *argc, char **argv) {
    struct options options = {.pair_count = DEFAULT_PAIRS};
    int kept = 1;
    for (int k = 1; k < *argc; k++) {
        const char *folder = option_value(argv[k], "--out="), *pairs = option_value(argv[k], "--pairs=");
        if (strcmp(argv[k], "--all") == 0)
            options.all = true;
        else if (folder)
            options.folder = folder;
        else if (pairs)
            options.pair_count = (size_t)strtoul(pairs, NULL, 10);
        else
            argv[kept++] = argv[k];
    }
    *argc = kept;
    return options;
}

int main(int argc, char **argv) {
    const struct options options = take_options(&argc, argv);
    const size_t pair_count = options.pair_count;
    if (pair_count < 1024 || pair_count > 1u << 24) {
        fprintf(stderr, "--pairs=N: from 1024 to 16777216\n");
        return 2;
    }
    const char *best = choose_best_isa();
    bench_describe("narc", narc_version());
    bench_describe("cpu", processor_name());
    bench_describe("compiler", compiler_name);
    bench_describe("flags", compiler_flags);
    bench_describe("best_isa", best);
    bench_describe("box2d", box2d_name());
    const struct row_choice choice = {.best_isa = best,
                                      .pair_count = pair_count,
                                      .packing_count = (size_t)((double)pair_count * DEFAULT_PACKING / DEFAULT_PAIRS),
                                      .all = options.all};
    const struct row_list list = list_rows(&choice);
    const int status = bench_run(argc, argv);
    if (status != 0)
        return status;
    const struct report report = {list.rows, list.count, best, choice.packing_count};
    print_report(&report, stdout);
    if (options.folder)
        write_report(&report, options.folder);
    return is_all_right(&report, stderr) ? 0 : 1;
}
