/* SPDX-License-Identifier: MIT
 *
 * chains.h - narc fit --chain: whole outlines, not their hulls, as chains of arcs and lines.
 */
#ifndef NARC_TOOL_CHAINS_H
#define NARC_TOOL_CHAINS_H

#include <stdio.h>

#include "fit_inputs.h"
#include "narc_files.h"

/* The chains of each outline; free each, then the array. Open: contours are strokes that are not closed;
 * smooth: pieces join with a common tangent. */
narc_arc_chains *fit_chains(outline_list *outlines, double tolerance, bool open, bool smooth);

/* The same for a file, with the names of their outlines. Free the arcs of each, then the array. */
narc_named_shape *describe_chains(const outline_list *outlines, const narc_arc_chains *chains, bool open,
                                  size_t *out_count);

void print_chains(FILE *file, const outline_list *outlines, const narc_arc_chains *chains);

/* How many pieces are arcs; the others are lines. */
size_t count_curved(const narc_arc_chains *chains);

#endif
