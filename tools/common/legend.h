/* SPDX-License-Identifier: MIT
 *
 * legend.h - samples of what a picture shows, with a word each.
 */
#ifndef NARC_TOOL_LEGEND_H
#define NARC_TOOL_LEGEND_H

#include "canvas.h"

/* Draws sample number `sample` around x, y, from x - half to x + half. */
typedef void draw_sample(canvas *page, int sample, double x, double y, double half);

/* Draws those of `count` samples that are `shown` in one line around x = middle, y. The text has this size, or less if
 * the line would be wider than `widest`. */
void draw_legend(canvas *page, const char *const *words, const bool *shown, int count, draw_sample *draw, double middle,
                 double y, double size, double widest);

#endif
