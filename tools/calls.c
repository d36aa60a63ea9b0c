/* SPDX-License-Identifier: MIT
 *
 * calls.c - how the library is called: its errors, its instruction set, its threads.
 */
#include "calls.h"

#include <stdlib.h>
#include <string.h>

#include "fail.h"

enum { LARGEST_THREADS = 1024 };

void check_call(narc_status status, const narc_error *error) {
    if (status != NARC_OK)
        fail("%s", error->message);
}

void choose_isa(const char *name) {
    narc_error error;
    /* The message begins with the library's function; the user knows the option. */
    if (name && narc_set_isa(name, &error) != NARC_OK)
        fail("--isa%s", error.message + strcspn(error.message, ":"));
}

narc_workers choose_workers(const option *threads) {
    narc_workers workers;
    narc_openmp_workers(threads->value ? (unsigned)whole_option(threads, 1, LARGEST_THREADS) : 0, &workers);
    return workers;
}

static int compare_numbers(const void *left, const void *right) {
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

double find_median(double *numbers, size_t count) {
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return numbers[count / 2];
}
