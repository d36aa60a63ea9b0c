/* SPDX-License-Identifier: MIT
 *
 * auto.h - what a test makes is released where its block ends.
 *
 *     AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, 30, 200);
 *     AUTO(free_at) char *text = malloc(size);
 *
 * The function gets the variable's address; the last variable is released first.
 */
#ifndef NARC_TEST_AUTO_H
#define NARC_TEST_AUTO_H

#include <stdlib.h>
#include <string.h>

#include "narc_contacts.h"
#include "narc_scene.h"

#define AUTO(release) __attribute__((cleanup(release), unused))

/* Makes release_at() of a function that takes a pointer: of a variable that is one, or a struct whose first member is. */
#define RELEASE_AT(release)                                                                                            \
    static inline void release##_at(const void *at) {                                                                  \
        void *made;                                                                                                    \
        memcpy(&made, at, sizeof made);                                                                                \
        release(made);                                                                                                 \
    }
RELEASE_AT(free)
RELEASE_AT(narc_destroy_shapes)
RELEASE_AT(narc_destroy_broad_phase)
RELEASE_AT(narc_destroy_contacts)
RELEASE_AT(narc_destroy_index)

#endif
