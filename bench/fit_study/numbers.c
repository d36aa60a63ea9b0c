/* SPDX-License-Identifier: MIT
 *
 * numbers.c - order statistics, and the results as bare numbers.
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

/* The place of a value among others, from 0; equal values share the mean of theirs. */
static double rank_of(const numbers *of, double value) {
    double below = 0, equal = 0;
    for (size_t i = 0; i < of->count; i++) {
        below += of->values[i] < value ? 1 : 0;
        equal += of->values[i] == value ? 1 : 0;
    }
    return below + 0.5 * (equal - 1);
}

double correlate_ranks(const numbers *x, const numbers *y) {
    const double mean = 0.5 * ((double)x->count - 1);
    double xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < x->count; i++) {
        const double a = rank_of(x, x->values[i]) - mean, b = rank_of(y, y->values[i]) - mean;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    return xy / sqrt(xx * yy);
}

/* ---------------------------------------------------------------------------- files */

void print_csv(const study *all, FILE *out) {
    fprintf(out, "outline,kind,source,corner_share,straight_share,family,n,arcs,edges,area,hull_area,largest_distance,"
                 "mean_distance,extent,seconds\n");
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        for (int way = 0; way < FAMILIES; way++) {
            for (size_t size = 0; size < SIZES; size++) {
                const fit *at = &of->fits[way][size];
                fprintf(out, "\"%s\",%s,", of->name, kind_names[of->of]);
                if (of->sand) {
                    char file[32];
                    name_grain_file(of, file, sizeof file);
                    fputs(file, out);
                } else if (of->character) {
                    fprintf(out, "U+%04X", (unsigned)of->character);
                } else {
                    fputs(of->file ? of->file : "pixels", out);
                }
                fprintf(out, ",%.4f,%.4f,%s,%zu,", of->corner_share, of->straight_share, family_names[way],
                        sizes[size]);
                if (at->found) {
                    fprintf(out, "%zu,%zu,%.9g,%.9g,%.6g,%.6g,%.9g,%.3f\n", at->made.arc_count, at->made.edge_count,
                            at->made.area, at->made.hull_area, at->made.max_distance, at->made.mean_distance,
                            of->extent, at->made.seconds);
                } else {
                    fprintf(out, ",,,%.9g,,,%.9g,\n", of->around.area, of->extent);
                }
            }
        }
    }
}

/* A block for each kind, two empty lines between. */
void print_points(const study *all, FILE *out) {
    for (kind which = PAPER; which < IMAGE; which++) {
        fprintf(out, "%s\"%s\"\tcorners\tstraight\t4\t6\t8\n", which == PAPER ? "" : "\n\n", kind_names[which]);
        for (size_t i = 0; i < all->count; i++) {
            const subject *of = &all->subjects[i];
            if (of->of == which) {
                fprintf(out, "\"%s\"\t%.4f\t%.4f", of->name, of->corner_share, of->straight_share);
                for (size_t size = 0; size < SIZES; size++)
                    fprintf(out, "\t%.5f", ratio_of(of, size));
                fputc('\n', out);
            }
        }
    }
}
