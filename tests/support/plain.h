/* SPDX-License-Identifier: MIT
 *
 * plain.h - whatever settles a pair, the answer must be that of the deciding formula, to the last bit.
 */
#ifndef NARC_TEST_PLAIN_H
#define NARC_TEST_PLAIN_H

#include "layouts.h"

/* What the deciding formula says of every pair of a batch: contact k is that of pair k. Checks on the way that its
 * overlaps are the contacts with a separation below 0. */
struct contacts find_plain_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs);

/* A batch with the answers that are right for it. The scene is that of the same pairs, to print one that is wrong. */
struct plain_batch {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    narc_contact *right;
    const struct scene *scene;
    const char *name;
};

/* A batch of a scene; whoever gets it frees `right`. */
struct plain_batch make_plain_batch(const struct scene *scene, const narc_bodies *bodies, const narc_pairs *pairs,
                                    const char *name);

/* Fail, with the pair, unless the instruction set under test says the same. */
void check_plain_overlaps(const struct plain_batch *batch, const narc_workers *workers);
void check_plain_contacts(const struct plain_batch *batch, const narc_query *query);

/* What the deciding formula tells, with the margins and angles of a query; of no pair with a concave arc. */
struct manifolds find_plain_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                      const narc_query *query);

/* Arrays or structures. */
enum layout any_layout(struct test_random *random);

/* The same of manifolds with any flat angle and margins, contacts, and overlaps of a scene. */
void check_plain_scene(struct test_random *random, const struct scene *scene, const char *name);

#endif
