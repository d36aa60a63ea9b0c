/* SPDX-License-Identifier: MIT
 *
 * method_support.h - what the tests of narc_methods.h share: calls on scenes, and what a method's contact must be.
 */
#ifndef NARC_TEST_METHOD_SUPPORT_H
#define NARC_TEST_METHOD_SUPPORT_H

#include "corpus.h"
#include "narc_methods.h"

narc_methods *create_methods(const narc_shapes *shapes);
RELEASE_AT(narc_destroy_methods)

/* The calls of narc_methods.h on a scene; any error fails the test. Outputs are full of junk before. `query` may be
 * NULL. */
uint64_t *query_overlaps(const struct scene *scene, const narc_method_options *options, const narc_query *query);
struct contacts query_contacts(const struct scene *scene, const narc_method_options *options, const narc_query *query);

/* Counts a pair that is wrong, and prints the first three, with the answer if there is a contact. */
void show_wrong_pair(const struct corpus *corpus, size_t k, const char *name, const char *wrong,
                     const narc_contact *told, unsigned outcome, size_t *count);

/* Fails unless the list is that of the items of `all`, one for each pair, with a separation below the margin; with an
 * infinite margin all of them. */
void check_contacts_below(const struct contacts *found, const struct contacts *all, float margin, const char *what);

/* A point of a body's shape, scaled and turned: from the body's position. */
narc_point turn_point(const struct reference_body *body, double x, double y);

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
