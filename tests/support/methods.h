/* SPDX-License-Identifier: MIT
 *
 * methods.h - what the tests of narc_methods.h share: calls on scenes, and pairs of everything with exact answers.
 */
#ifndef NARC_TEST_METHODS_H
#define NARC_TEST_METHODS_H

#include "hard.h"
#include "narc_methods.h"
#include "scene.h"

/* A pair as the reference sees it. Its rotations have length 1: that is what the kernels make of a rotation that has
 * drifted. */
struct exact_pair {
    struct reference_body a, b;
    double gap, normal_x, normal_y;
    double reach;
    double size;           /* the sum of both bounding radii */
    double bound;          /* of a separation's error: the documented one, and by how much the arcs fail to join */
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

/* Prints pair k so that it can be put into a test of its own. */
void print_corpus_pair(const struct corpus *corpus, size_t k);

/* Counts a pair that is wrong, and prints the first three, with the answer if there is a contact. */
void show_wrong_pair(const struct corpus *corpus, size_t k, const char *name, const char *wrong,
                     const narc_contact *told, unsigned outcome, size_t *count);

/* The calls of narc_methods.h on a scene; any error fails the test. Outputs are full of junk before. `query` may be
 * NULL. */
uint64_t *query_overlaps(const struct scene *scene, const narc_method_options *options, const narc_query *query);
struct contacts query_contacts(const struct scene *scene, const narc_method_options *options, const narc_query *query);

/* `count` outcomes, all junk. */
uint8_t *create_outcomes(size_t count);
uint32_t *create_hints(size_t count); /* zeros */

/* A plain array of hints; NULL: none. */
static inline narc_hint_column hint_column(uint32_t *hints) { return (narc_hint_column){hints, sizeof *hints}; }

/* Fail unless both lists hold the same bits. */
void check_same_contacts(const struct contacts *found, const struct contacts *expected, const char *what);

/* Fails unless the list is that of the items of `all`, one for each pair, with a separation below the margin. */
void check_contacts_below(const struct contacts *found, const struct contacts *all, float margin, const char *what);

/* Fails unless the pairs of a list are those whose bits are set. */
void check_contacts_are_bits(const struct contacts *found, const uint64_t *bits, size_t count, const char *what);

/* How far a body reaches from its position along a unit vector. */
double reference_height(const struct reference_body *body, double x, double y);

/* Is a contact told by some method one of its own normal? The normal is unit, the separation is the gap along it and
 * that of the arcs told, and the point lies halfway between both support lines across it. `unknown`: the method did not
 * get to know whether the bodies collide; then the separation is 0, and the gap not more. Returns NULL or what is
 * wrong. */
const char *check_along_normal(const struct exact_pair *pair, const narc_contact *contact, bool unknown);

/* Does a contact's point lie between the points where the bodies touch these lines? NULL or what is wrong. */
const char *check_between_touches(const struct exact_pair *pair, const narc_contact *contact);

/* Half a separation back and forth along the normal from a contact's point are points of A's and B's outlines: by how
 * much are they not, at worst? */
double distance_from_outlines(const struct exact_pair *pair, const narc_contact *contact);

/* Half a separation back and forth must be as near to the outlines as this many bounds. */
extern const double point_bounds;

#endif
