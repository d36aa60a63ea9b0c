/* SPDX-License-Identifier: MIT
 *
 * figures.h - the figures of docs/algorithm.md, and what they share.
 */
#ifndef NARC_FIGURES_H
#define NARC_FIGURES_H

#include "page.h"

/* Most intervals of two normal fans. */
enum { MOST = 2 * NARC_MAX_ARCS };

/* Sample shapes: a round n-arc, a long one, a polygon with round corners. */
outline make_pebble(void);
outline make_bean(void);
outline make_block(void);

/* A letter with an index, and a pair of indices; both count from 1. */
void write_index(sheet *page, double x, double y, double right, double down, double size, char letter, size_t k);
void write_pair(sheet *page, double x, double y, double right, double down, double size, size_t i, size_t j);

/* Each draws one figure into a folder. */
void draw_shape(const char *folder);       /* an n-arc with its centres and sectors */
void draw_gap(const char *folder);         /* the gap between two support lines */
void draw_directions(const char *folder);  /* the gap over all directions */
void draw_fans(const char *folder);        /* two normal fans laid over each other */
void draw_search(const char *folder);      /* the steps of the directed search */
void draw_certificate(const char *folder); /* a disc in the difference of two shapes */

#endif
