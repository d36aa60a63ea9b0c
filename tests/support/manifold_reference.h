/* SPDX-License-Identifier: MIT
 *
 * manifold_reference.h - what a manifold must be, in double precision, from the exact contact and the arcs of both
 * bodies.
 */
#ifndef NARC_TEST_MANIFOLD_REFERENCE_H
#define NARC_TEST_MANIFOLD_REFERENCE_H

#include "reference.h"

/* A contact as narc_find_contacts() has it. */
struct exact_contact {
    double separation, normal_x, normal_y, point_x, point_y;
    size_t arc_a, arc_b;
};

struct reference_point {
    double separation, x, y;
    unsigned feature;
    double radius_a, radius_b;
};

struct reference_manifold {
    size_t count;
    struct reference_point point[2];
    size_t deepest; /* which of the two is the contact */
    bool stretch;   /* do two edges touch along their common part? */
    /* Two choices within rounding of each other: of the edges, whether the second point counts, or which end is
     * deepest. Then all that is certain is the contact. */
    bool doubtful;
    bool doubtful_radius; /* whether n is an edge's normal */
};

/* With an infinite margin: whoever has another looks at the separation of the second point. */
struct reference_manifold reference_find_manifold(const struct reference_body *a, const struct reference_body *b,
                                                  const struct exact_contact *contact, double flat_angle);

#endif
