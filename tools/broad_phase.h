/* SPDX-License-Identifier: MIT
 *
 * broad_phase.h - which boxes overlap? The library's broad phase, for boxes in double precision.
 */
#ifndef NARC_TOOL_BROAD_PHASE_H
#define NARC_TOOL_BROAD_PHASE_H

#include "bodies.h"

/* The pairs of boxes that overlap or touch, a < b, sorted by a and then b. `boxes` holds no NaN. Memory grows in
 * proportion to boxes and pairs. More than `most` pairs, UINT32_MAX at most, are an error, which names `path`; pairs
 * that overlap only when rounded to single precision, around the middle of the boxes, count there too. */
void find_candidates(const char *path, const narc_aabb *boxes, size_t count, uint64_t most, const narc_workers *workers,
                     pair_list *out_pairs);

#endif
