/* SPDX-License-Identifier: MIT
 *
 * check.h - are contacts and manifolds right? Compared with the references, within the documented error bound.
 */
#ifndef NARC_TEST_CHECK_H
#define NARC_TEST_CHECK_H

#include "scene.h"

/* Prints a pair so that it can be put into a test of its own. */
void print_pair(const struct reference_body *a, const struct reference_body *b);

/* Errors as fractions of what is allowed. */
struct fractions {
    double separation, normal, point;
};

/* The documented bound of a separation's error. */
double separation_bound(const struct reference_body *a, const struct reference_body *b);

/* Signed distance from a point in world axes, relative to A's position, to a body. */
double distance_to(const struct reference_body *a, const struct reference_body *body, double x, double y);

/* Checks a contact against the exact gap of its pair: separation, normal, point, arcs and radii. Raises `worst` to this
 * contact's errors where they are larger. Returns NULL, or what is wrong (static storage). */
const char *check_contact(const struct reference_body *a, const struct reference_body *b, double gap,
                          const narc_contact *contact, struct fractions *worst);

/* The same of pair `k` of a batch, which must be what its row tells, and with whether the pair's overlap is told. */
const char *check_answer(const struct reference_body *a, const struct reference_body *b, double gap, size_t k,
                         bool overlap, const narc_contact *contact, struct fractions *worst);
void print_answer(const struct reference_body *a, const struct reference_body *b, double gap, bool overlap,
                  const narc_contact *contact);

/* Pairs of a kind: how many collide, how many are too near to touching to be sure, and the largest errors. */
struct contact_summary {
    size_t pairs, colliding, inside_band;
    struct fractions worst;
};
void count_pair(struct contact_summary *summary, double gap, double bound, const struct fractions *errors);

/* A point of a manifold and its separation may be off by that many bounds of a separation: both edges' ends, a rotated
 * normal, and the slope of an edge at the flat angle. */
extern const double manifold_bounds;

/* Of manifolds: `doubtful` ones have choices within rounding, so that the contact in them is all that is certain. `worst`
 * is the largest error of a point as a fraction of what is allowed. */
struct manifold_summary {
    size_t pairs, two, stretches, doubtful;
    double worst;
};

/* A manifold found with an infinite margin against the pair's contact, found so too, and the reference. NULL, or what is
 * wrong. */
const char *check_manifold(const struct reference_body *a, const struct reference_body *b, const narc_contact *found,
                           const narc_manifold *m, struct manifold_summary *summary);

#endif
