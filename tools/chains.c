/* SPDX-License-Identifier: MIT
 *
 * chains.c - narc fit --chain: whole outlines, not their hulls, as chains of arcs and lines.
 */
#include "chains.h"

#include <stdlib.h>

#include "fail.h"
#include "progress.h"

narc_arc_chains *fit_chains(outline_list *outlines, double tolerance, bool open, bool smooth) {
    narc_arc_chains *chains = allocate(outlines->count, sizeof *chains);
    size_t kept = 0;
    for (size_t i = 0; i < outlines->count; i++) {
        narc_error error;
        if ((smooth ? narc_fit_chains : narc_fit_fewest_chains)(outlines->items[i].path, tolerance, open, &chains[kept],
                                                                &error) != NARC_OK)
            report_outline(&outlines->items[i], error.message);
        else
            keep_outline(outlines, i, kept++);
        show_progress("fitting", i, outlines->count);
    }
    cut_outlines(outlines, kept);
    return chains;
}

narc_named_shape *describe_chains(const outline_list *outlines, const narc_arc_chains *chains, bool open,
                                  size_t *out_count) {
    size_t count = 0, used = 0;
    for (size_t i = 0; i < outlines->count; i++)
        count += chains[i].count;
    narc_named_shape *shapes = allocate(count, sizeof *shapes);
    for (size_t i = 0; i < outlines->count; i++) {
        for (size_t k = 0, begin = 0; k < chains[i].count; begin = chains[i].ends[k++]) {
            const size_t pieces = chains[i].ends[k] - begin;
            narc_arc *arcs = allocate(3 * pieces + 1, sizeof *arcs);
            narc_named_shape *made = &shapes[used++];
            *made = (narc_named_shape){.name = name_part(&outlines->items[i], k, chains[i].count),
                                       .arcs = arcs,
                                       .form = open ? NARC_FORM_OPEN_CHAIN : NARC_FORM_CLOSED_CHAIN};
            narc_error error;
            if (narc_describe_chain(chains[i].arcs + begin, pieces, !open, arcs, &made->arc_count, &error) != NARC_OK)
                fail("%s", error.message);
        }
    }
    *out_count = count;
    return shapes;
}

size_t count_curved(const narc_arc_chains *chains) {
    size_t count = 0;
    for (size_t i = 0; i < chains->arc_count; i++)
        count += chains->arcs[i].turn != 0;
    return count;
}

void print_chains(FILE *file, const outline_list *outlines, const narc_arc_chains *chains) {
    const int width = print_name(file, outlines, "shape", 0);
    fprintf(file, " %8s %6s %6s %12s\n", "chains", "arcs", "lines", "max distance");
    for (size_t i = 0; i < outlines->count; i++) {
        const size_t curved = count_curved(&chains[i]);
        print_name(file, outlines, outlines->items[i].name, width);
        fprintf(file, " %8zu %6zu %6zu %12.4g\n", chains[i].count, curved, chains[i].arc_count - curved,
                chains[i].distance);
    }
}
