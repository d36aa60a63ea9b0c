/* SPDX-License-Identifier: MIT
 *
 * situations.h - templates of one n, and the two scenes of the paper: pairs that never collide, pairs that always do.
 */
#ifndef NARC_PAPER_SITUATIONS_H
#define NARC_PAPER_SITUATIONS_H

#include "common.h"
#include "bodies.h"

/* What stands for an outline. */
enum kind { KIND_ARC, KIND_GON, KINDS };

/* A shape's bounding circle, and the extent that narc.h's error bound speaks of. */
struct bound {
    double x, y, radius, extent;
};

/* Outline k is shape k of either store: there an n-arc, here an n-gon. */
struct templates {
    size_t n, count;
    narc_shapes *shapes[KINDS];
    narc_methods *methods[KINDS];
    struct bound *bounds[KINDS];
};

struct templates make_templates(size_t n, size_t count, uint64_t *random);
struct bound bound_of(const narc_arc *arcs, size_t count);

enum situation { APART, COLLIDING, SITUATIONS };

/* Pair k is of the bodies 2 k and 2 k + 1, so that what a pair reads lies together. */
struct scene {
    const struct templates *templates;
    enum situation situation;
    size_t pair_count;
    struct body *bodies;
    size_t drawn_again; /* pairs that had no room between touching and where their circles come apart */
    size_t left_out;    /* placed pairs that were not what the scene claims, as either kind: replaced by others */
};

struct scene make_scene(const struct templates *templates, enum situation situation, size_t pair_count,
                        uint64_t *random);

/* How far rounding may move the separation of a pair (narc.h): one closer to 0 than that may have either answer. */
double rounding_of(const struct bound *bounds, const struct body *pair);

/* The sum of both bounding radii: the unit of GJK's tolerance. */
double size_of(const struct bound *bounds, const struct body *pair);

/* Distances (apart) or depths (colliding) of the n-arcs, relative to the sum of both bounding radii. */
struct spread {
    double least, lower, median, upper, most; /* quartiles */
};
struct spread spread_of(const struct scene *scene);

#endif
