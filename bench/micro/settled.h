/* SPDX-License-Identifier: MIT
 *
 * settled.h - bodies and pairs of a settled pile: what a simulation hands to the narrow phase step after step.
 */
#ifndef NARC_BENCH_SETTLED_H
#define NARC_BENCH_SETTLED_H

#include "narc_broad_phase.h"
#include "workload.h"

/* A pair's boxes are at most this apart, in x and in y: a tenth of a body's size, which is some 2. */
#define SETTLED_SKIN 0.2

/* Bodies in a square, so dense that they hold each other in place: put there at random, and pushed apart until what
 * overlaps does so by 2 % of the size on average. They are numbered row by row. Pairs are those whose boxes, enlarged
 * by half of the skin, overlap. Large piles are made of copies, next to each other. */
void make_settled(struct workload *workload);

/* Boxes around bodies, with `room` on each side. */
void find_boxes(const struct workload *workload, double room, const narc_workers *workers, narc_box *out_boxes);

#endif
