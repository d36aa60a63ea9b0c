/* SPDX-License-Identifier: MIT
 *
 * bench.h - the part of Google Benchmark that the benchmarks use, callable from C (shim.cc).
 */
#ifndef NARC_BENCH_H
#define NARC_BENCH_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BENCH_NAME = 96 };

/* A row of the benchmark: `run` is timed as a whole and answers `count` questions. The first member of what it is for. */
struct bench_row {
    char name[BENCH_NAME];
    size_t count;                           /* set by prepare */
    void (*prepare)(struct bench_row *row); /* before every repetition, outside the time; makes the scene, checks */
    void (*run)(struct bench_row *row);
    bool threaded;  /* timed by the clock on the wall; else by the processor time of the calling thread */
    bool own_clock; /* timed by what `run` sets `seconds` to */
    double seconds;
    bool must_be_right; /* wrong answers of this row fail the program */
    double hits;        /* set by prepare: the part of the questions that found something */
    double wrong;       /* set by prepare: the number of wrong answers */
    double ns;          /* set when the row has run: nanoseconds a question, the median of the repetitions; else 0 */
};

/* Registers a row, which must outlive bench_run(). */
void bench_add(struct bench_row *row);

/* Registers one that cannot run here, so that it shows as skipped with the reason instead of being absent. */
void bench_skip(const char *name, const char *reason);

/* A line of the report's head, such as the compiler. */
void bench_describe(const char *key, const char *value);

/* Parses Google Benchmark's options and runs the rows; the exit status, 1 if there was none to run. */
int bench_run(int argc, char **argv);

#ifdef __cplusplus
}
#endif

#endif
