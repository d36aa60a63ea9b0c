/* SPDX-License-Identifier: MIT
 *
 * manifolds.h - the list of manifolds that rows write.
 */
#ifndef NARC_BENCH_MANIFOLDS_H
#define NARC_BENCH_MANIFOLDS_H

#include "narc.h"

/* A list with room for `count` manifolds, all arrays given. There is one for all rows, since they run one after
 * another: a call may move it. */
const narc_manifolds *share_manifolds(size_t count);

/* The separation of manifold k's deepest point. */
float deepest_separation(const narc_manifolds *manifolds, size_t k);

#endif
