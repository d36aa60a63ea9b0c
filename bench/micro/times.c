/* SPDX-License-Identifier: MIT
 *
 * times.c - the times of rows by their names.
 */
#include "report.h"

#include <math.h>
#include <string.h>

void replace_word(const char *text, const char *key, const char *value, char *out, size_t size) {
    const char *word = strstr(text, key);
    if (word)
        snprintf(out, size, "%.*s%s%s", (int)(word - text), text, value, word + strlen(key));
    else
        snprintf(out, size, "%s", text);
}

static double time_of_row(const struct report *report, const char *name) {
    char full[BENCH_NAME];
    replace_word(name, "BEST", report->best_isa, full, sizeof full);
    for (size_t k = 0; k < report->row_count; k++)
        if (strcmp(report->rows[k]->name, full) == 0 && report->rows[k]->ns > 0)
            return report->rows[k]->ns;
    return NAN;
}

double time_of(const struct report *report, const char *names) {
    char first[BENCH_NAME];
    const char *more = strstr(names, " + ");
    if (!more)
        return time_of_row(report, names);
    snprintf(first, sizeof first, "%.*s", (int)(more - names), names);
    return time_of_row(report, first) + time_of_row(report, more + 3);
}

void print_cell(FILE *out, double value) {
    if (isnan(value))
        fprintf(out, " |");
    else
        fprintf(out, " %.1f |", value);
}
