/* SPDX-License-Identifier: MIT
 *
 * corpus.h - pairs of everything, each with its exact answer.
 */
#ifndef NARC_TEST_CORPUS_H
#define NARC_TEST_CORPUS_H

#include "hard.h"
#include "scene.h"

/* A pair as the reference sees it. Its rotations have length 1: that is what the kernels make of a rotation that has
 * drifted. */
struct exact_pair {
    struct reference_body a, b;
    double gap, normal_x, normal_y;
    double reach;
    double size;           /* the sum of both bounding radii */
    double bound;          /* of a separation's error */
    size_t kind_a, kind_b; /* see make_any_shape() */
    const char *place;
};

struct corpus {
    struct scene scene;
    struct exact_pair *pairs; /* scene.pair_count of them, exact after solve_corpus() */
};

/* Shapes of all families and all hard families, each against each in all placements, and each in all hard places;
 * or polygons only. As many trials as `rounds` times all that, spread over all. */
struct corpus make_corpus(const char *name, narc_precision precision, double rounds, bool polygons);
void solve_corpus(struct corpus *corpus);
void destroy_corpus(struct corpus *corpus);

#endif
