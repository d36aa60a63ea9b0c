/* SPDX-License-Identifier: MIT
 *
 * few_bodies.h - contacts that stay, of some bodies that a test puts where it wants them.
 */
#ifndef NARC_TEST_FEW_BODIES_H
#define NARC_TEST_FEW_BODIES_H

#include "families.h"
#include "narc_chains.h"
#include "narc_contacts.h"

/* Bodies of one shape by their places, with ids from 1 on. */
struct few {
    narc_shapes *store;
    narc_body body[600];
    uint64_t id[600];
    uint8_t kind[600];
    narc_bodies bodies;
    narc_pair_filter filter;
    narc_step step;
    narc_contacts *contacts;
};

struct few *make_few(struct shape shape, size_t count, const narc_allocator *allocator);
const narc_step_result *step_few(struct few *few);
void destroy_few(struct few *few);
RELEASE_AT(destroy_few)

/* The same bodies in an object that knows nothing of them: as much touches, as deep. */
void check_with_fresh(struct few *few);

/* Entries of a chain as static bodies behind body 0, instead of those there; how many. `run`: of each body. */
size_t lay_entries(struct few *few, const narc_arc *arcs, size_t count, double weld, uint32_t *run);

/* A body, which was not turned, after a turn about a place. */
narc_body turn_about(narc_body body, double x, double y, double angle);

#endif
