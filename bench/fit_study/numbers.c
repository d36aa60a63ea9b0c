/* SPDX-License-Identifier: MIT
 *
 * numbers.c - order statistics.
 */
#include "numbers.h"

#include <math.h>
#include <stdlib.h>

#include "fail.h"

static int compare(const void *left, const void *right) {
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

void add_number(numbers *to, double value) {
    if (to->count == MOST_NUMBERS)
        fail("more than %d numbers", MOST_NUMBERS);
    if (!isnan(value))
        to->values[to->count++] = value;
}

double find_quantile(numbers *of, double part) {
    if (of->count == 0)
        return NAN;
    qsort(of->values, of->count, sizeof *of->values, compare);
    const double at = part * (double)(of->count - 1);
    const size_t low = (size_t)at, high = low + 1 < of->count ? low + 1 : low;
    return of->values[low] + (at - (double)low) * (of->values[high] - of->values[low]);
}

void print_range(numbers *of, int decimals, FILE *out) {
    fprintf(out, " %.*f (%.*f to %.*f)", decimals, find_quantile(of, 0.5), decimals, find_quantile(of, 0), decimals,
            find_quantile(of, 1));
}
