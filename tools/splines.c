/* SPDX-License-Identifier: MIT
 *
 * splines.c - narc fit --spline: whole outlines, not their hulls, as chains of arcs and lines.
 */
#include "splines.h"

#include "fail.h"
#include "progress.h"

narc_arc_chains *fit_splines(outline_list *outlines, double tolerance) {
    narc_arc_chains *chains = allocate(outlines->count, sizeof *chains);
    size_t kept = 0;
    for (size_t i = 0; i < outlines->count; i++) {
        narc_error error;
        if (narc_fit_chains(outlines->items[i].path, tolerance, &chains[kept], &error) != NARC_OK)
            report_outline(&outlines->items[i], error.message);
        else
            keep_outline(outlines, i, kept++);
        show_progress("fitting", i, outlines->count);
    }
    cut_outlines(outlines, kept);
    return chains;
}

static void write_piece(FILE *file, const narc_curve_arc *piece) {
    fprintf(file, "{\"start\": [%.17g, %.17g], \"end\": [%.17g, %.17g]", piece->start.x, piece->start.y, piece->end.x,
            piece->end.y);
    if (piece->turn != 0) {
        fprintf(file, ", \"center\": [%.17g, %.17g], \"radius\": %.17g, \"turn\": %.17g", piece->center.x,
                piece->center.y, piece->radius, piece->turn);
    }
    fprintf(file, "}");
}

/* A name as a JSON string: names have no quotes and no control characters. */
static void write_name(FILE *file, const char *name) {
    for (; *name; name++)
        fprintf(file, *name == '\\' ? "\\\\" : "%c", *name);
}

void write_splines(FILE *file, const outline_list *outlines, const narc_arc_chains *chains) {
    fprintf(file, "{\"splines\": [");
    for (size_t k = 0; k < outlines->count; k++) {
        fprintf(file, "%s\n  {\"name\": \"", k ? "," : "");
        write_name(file, outlines->items[k].name);
        fprintf(file, "\", \"contours\": [");
        for (size_t c = 0, i = 0; c < chains[k].count; c++) {
            fprintf(file, "%s\n    [", c ? "," : "");
            for (const size_t begin = i; i < chains[k].ends[c]; i++) {
                fprintf(file, "%s\n      ", i > begin ? "," : "");
                write_piece(file, &chains[k].arcs[i]);
            }
            fprintf(file, "\n    ]");
        }
        fprintf(file, "\n  ]}");
    }
    fprintf(file, "\n]}\n");
}

size_t count_curved(const narc_arc_chains *chains) {
    size_t count = 0;
    for (size_t i = 0; i < chains->arc_count; i++)
        count += chains->arcs[i].turn != 0;
    return count;
}

void print_splines(FILE *file, const outline_list *outlines, const narc_arc_chains *chains) {
    const int width = print_name(file, outlines, "shape", 0);
    fprintf(file, " %8s %6s %6s %12s\n", "contours", "arcs", "lines", "max distance");
    for (size_t i = 0; i < outlines->count; i++) {
        const size_t curved = count_curved(&chains[i]);
        print_name(file, outlines, outlines->items[i].name, width);
        fprintf(file, " %8zu %6zu %6zu %12.4g\n", chains[i].count, curved, chains[i].arc_count - curved,
                chains[i].distance);
    }
}
