/* SPDX-License-Identifier: MIT
 *
 * bench.h - the part of Google Benchmark that the benchmarks use, callable from C (shim.cc).
 */
#ifndef NARC_BENCH_H
#define NARC_BENCH_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Registers a benchmark: `run(argument)` is timed as a whole and counts as `items` items. */
void bench_add(const char *name, void (*run)(void *argument), void *argument, size_t items);

/* Registers one that cannot run here, so that it shows as skipped with the reason instead of being absent. */
void bench_skip(const char *name, const char *reason);

/* Parses Google Benchmark's options and runs what was registered; the exit status. */
int bench_run(int argc, char **argv);

#ifdef __cplusplus
}
#endif

#endif
