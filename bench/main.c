/* SPDX-License-Identifier: MIT
 *
 * main.c - options, rows, report.
 */
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "report.h"
#include "rows.h"

enum { DEFAULT_PAIRS = 65536, LEAST_PAIRS = 1024, MOST_PAIRS = 1 << 24 };

int main(int argc, char **argv) {
    const char *out_folder = NULL;
    size_t pairs = DEFAULT_PAIRS;
    unsigned threads = 1;
    int kept = 1; /* Google Benchmark's options */
    for (int k = 1; k < argc; k++) {
        const char *folder = option_value(argv[k], "--out="), *count = option_value(argv[k], "--pairs=");
        const char *workers = option_value(argv[k], "--threads=");
        if (folder)
            out_folder = folder;
        else if (count)
            pairs = (size_t)strtoul(count, NULL, 10);
        else if (workers)
            threads = (unsigned)strtoul(workers, NULL, 10);
        else
            argv[kept++] = argv[k];
    }
    if (pairs < LEAST_PAIRS || pairs > MOST_PAIRS) {
        fprintf(stderr, "--pairs=N: from %d to %d\n", LEAST_PAIRS, MOST_PAIRS);
        return 2;
    }
    const char *best = choose_best_isa();
    bench_describe("narc", narc_version());
    bench_describe("cpu", processor_name());
    bench_describe("compiler", compiler_name);
    bench_describe("flags", compiler_flags);
    bench_describe("best_isa", best);
    bench_describe("box2d", box2d_name());
    set_pairs(pairs);
    list_rows(best, threads);
    const int status = bench_run(kept, argv);
    if (status != 0)
        return status;
    print_report(best, stdout);
    if (out_folder)
        write_report(best, out_folder);
    return is_all_right(stderr) ? 0 : 1;
}
