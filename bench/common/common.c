/* SPDX-License-Identifier: MIT
 *
 * common.c - memory, errors, the clock, order statistics, results, and what a report says of the machine.
 */
#define _POSIX_C_SOURCE 200809L

#include "common.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef __clang__
const char *const compiler_name = __VERSION__;
#else
const char *const compiler_name = "GCC " __VERSION__;
#endif
const char *const compiler_flags = BENCH_FLAGS;

void fail(const char *format, ...) {
    va_list list;
    va_start(list, format);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    exit(1);
}

void must(narc_status status, const narc_error *error) {
    if (status != NARC_OK)
        fail("%s: %s", narc_status_name(status), error->message);
}

void *allocate(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (!memory)
        fail("out of memory");
    return memory;
}

double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static int compare(const void *left, const void *right) {
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

double quantile(double *values, size_t count, double part) {
    qsort(values, count, sizeof *values, compare);
    return values[(size_t)(part * (double)(count - 1) + 0.5)];
}

FILE *open_result(const char *folder, const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        fail("%s can't be written", path);
    return file;
}

void close_result(FILE *file) {
    if (ferror(file) || fclose(file) != 0)
        fail("a result could not be written");
}

const narc_workers *all_workers(void) {
    static narc_workers workers;
    narc_openmp_workers(0, &workers);
    return &workers;
}

const char *processor_name(void) {
    static char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    const char *name = "unknown processor";
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon) {
            line[strcspn(line, "\n")] = 0;
            name = colon + 2;
            break;
        }
    }
    if (file)
        fclose(file);
    return name;
}

const char *choose_best_isa(void) {
    narc_error error;
    must(narc_set_isa(NULL, &error), &error);
    return narc_get_isa();
}

const char *option_value(const char *argument, const char *prefix) {
    const size_t length = strlen(prefix);
    return strncmp(argument, prefix, length) == 0 ? argument + length : NULL;
}
