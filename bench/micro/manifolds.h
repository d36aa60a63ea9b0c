/* SPDX-License-Identifier: MIT
 *
 * manifolds.h - the list of manifolds that rows write.
 */
#ifndef NARC_BENCH_MANIFOLDS_H
#define NARC_BENCH_MANIFOLDS_H

#include "narc.h"

/* Room for `count` manifolds, one for all rows of the benchmark, since they run one after another: a call may move it. */
narc_manifold *share_manifolds(size_t count);

float deepest_separation(const narc_manifold *manifold);

#endif
