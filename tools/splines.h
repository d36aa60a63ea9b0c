/* SPDX-License-Identifier: MIT
 *
 * splines.h - narc fit --spline: whole outlines, not their hulls, as chains of arcs and lines.
 */
#ifndef NARC_TOOL_SPLINES_H
#define NARC_TOOL_SPLINES_H

#include <stdio.h>

#include "fit_inputs.h"

/* The chains of each outline; free each, then the array. */
narc_arc_chains *fit_splines(outline_list *outlines, double tolerance);

/* {"splines": [{"name": ..., "contours": [[{"start", "end", "center", "radius", "turn"}, ...], ...]}, ...]}, with 17
 * significant digits. A line has "start" and "end" only. */
void write_splines(FILE *file, const outline_list *outlines, const narc_arc_chains *chains);

void print_splines(FILE *file, const outline_list *outlines, const narc_arc_chains *chains);

/* How many pieces are arcs; the others are lines. */
size_t count_curved(const narc_arc_chains *chains);

#endif
