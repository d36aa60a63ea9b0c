/* SPDX-License-Identifier: MIT
 *
 * report.c - the report's tables of times against n, and the data of the plots, from the rows that ran.
 */
#include "report.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "peers.h"

/* ------------------------------------------------------------------------------------------------ times against n */

static const unsigned arc_counts[] = {4, 6, 8, 12, 16};
enum { ARC_COUNTS = sizeof arc_counts / sizeof arc_counts[0] };

struct series {
    const char *title;
    const char *query, *who;
};

static const struct series series[] = {
    {"narc overlap", "overlap", "BEST"},
    {"narc overlap, AVX2", "overlap", "avx2"},
    {"narc contact", "contact", "BEST"},
    {"narc contact, AVX2", "contact", "avx2"},
    {"Box2D b2CollidePolygons", "contact", "box2d-collide"},
    {"Box2D GJK", "overlap", "box2d-overlap"},
    {"Chipmunk cpShapesCollide", "contact", "chipmunk"},
    {"libccd GJK", "overlap", "ccd-gjk"},
    {"libccd MPR", "overlap", "ccd-mpr"},
    {"published test, plain loop", "overlap", "plain-paper"},
    {"exact test, plain loop", "overlap", "plain-exact"},
};
enum { SERIES = sizeof series / sizeof series[0] };

static double time_in(const struct report *report, const struct series *of, unsigned n) {
    char name[BENCH_NAME];
    snprintf(name, sizeof name, "%s/n%u/mixed/unique/random/%s", of->query, n, of->who);
    return time_of(report, name);
}

static bool ran(const struct report *report, const struct series *of) {
    bool any = false;
    for (size_t k = 0; k < ARC_COUNTS; k++)
        any |= !isnan(time_in(report, of, arc_counts[k]));
    return any;
}

static void print_times(const struct report *report, FILE *out) {
    bool any = false;
    for (size_t s = 0; s < SERIES; s++) {
        if (!ran(report, &series[s]))
            continue;
        if (!any)
            fprintf(out, "| ns per pair, mixed scene, unique shapes | n = 4 | 6 | 8 | 12 | 16 |\n"
                         "| --- | ---: | ---: | ---: | ---: | ---: |\n");
        any = true;
        fprintf(out, "| %s |", series[s].title);
        for (size_t k = 0; k < ARC_COUNTS; k++)
            print_cell(out, time_in(report, &series[s], arc_counts[k]));
        fputc('\n', out);
    }
    if (any)
        fputc('\n', out);
}

void print_report(const struct report *report, FILE *out) {
    bool any = false;
    for (size_t k = 0; k < report->row_count; k++)
        any |= report->rows[k]->ns > 0;
    if (!any)
        return;
    fprintf(out, "\n%s, %s, %s; %s unless said otherwise; one thread; beside %s\n\n", processor_name(), compiler_name,
            compiler_flags, report->best_isa, box2d_name());
    print_settled_targets(report, out);
    print_settled_times(report, out);
    print_targets(report, out);
    print_times(report, out);
}

/* ------------------------------------------------------------------------------------------------ plots */

static void print_value(FILE *out, double value) {
    if (isnan(value))
        fprintf(out, "\t?");
    else
        fprintf(out, "\t%.4g", value);
}

/* One column for each series, under its title. */
static void write_arcs(const struct report *report, const char *folder) {
    bool any = false;
    for (size_t s = 0; s < SERIES; s++)
        any |= ran(report, &series[s]);
    if (!any)
        return;
    FILE *file = open_result(folder, "arcs.dat");
    fprintf(file, "n");
    for (size_t s = 0; s < SERIES; s++)
        fprintf(file, "\t\"%s\"", series[s].title);
    for (size_t k = 0; k < ARC_COUNTS; k++) {
        fprintf(file, "\n%u", arc_counts[k]);
        for (size_t s = 0; s < SERIES; s++)
            print_value(file, time_in(report, &series[s], arc_counts[k]));
    }
    fputc('\n', file);
    close_result(file);
}

/* Pairs per second against the size of a batch, with 1 and with 2 threads. */
static void write_batches(const struct report *report, const char *folder) {
    FILE *file = NULL;
    for (size_t pairs = 64;; pairs *= 4) {
        char name[BENCH_NAME], part[32] = "";
        const bool all = pairs >= report->packing_pairs;
        if (!all)
            snprintf(part, sizeof part, "/%zupairs", pairs);
        snprintf(name, sizeof name, "overlap/n8/packing/unique/sorted/BEST%s", part);
        const double one = time_of(report, name);
        snprintf(name, sizeof name, "overlap/n8/packing/unique/sorted/BEST/2threads%s", part);
        const double two = time_of(report, name);
        if (!file && !isnan(one) && !isnan(two)) {
            file = open_result(folder, "batches.dat");
            fprintf(file, "pairs\t\"1 thread\"\t\"2 threads\"\n");
        }
        if (file) {
            fprintf(file, "%zu", all ? report->packing_pairs : pairs);
            print_value(file, 1e9 / one);
            print_value(file, 1e9 / two);
            fputc('\n', file);
        }
        if (all)
            break;
    }
    if (file)
        close_result(file);
}

void write_report(const struct report *report, const char *folder) {
    FILE *file = open_result(folder, "bench.md");
    print_report(report, file);
    close_result(file);
    write_arcs(report, folder);
    write_batches(report, folder);
}

/* ------------------------------------------------------------------------------------------------ answers */

bool is_all_right(const struct report *report, FILE *out) {
    bool right = true;
    for (size_t k = 0; k < report->row_count; k++) {
        const struct bench_row *row = report->rows[k];
        if (row->must_be_right && row->wrong > 0) {
            fprintf(out, "%s: %.0f wrong answers\n", row->name, row->wrong);
            right = false;
        }
    }
    return right;
}
