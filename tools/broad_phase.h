/* SPDX-License-Identifier: MIT
 *
 * broad_phase.h - which boxes overlap? Sort-and-sweep.
 */
#ifndef NARC_TOOL_BROAD_PHASE_H
#define NARC_TOOL_BROAD_PHASE_H

#include "bodies.h"

/* The pairs of boxes that overlap or touch, a < b, sorted by a and then b. `boxes` holds no NaN. More than UINT32_MAX
 * pairs are an error. Memory grows in proportion to boxes and pairs. */
void find_candidates(const narc_aabb *boxes, size_t count, pair_list *out_pairs);

#endif
