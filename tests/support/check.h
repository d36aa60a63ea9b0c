/* SPDX-License-Identifier: MIT
 *
 * check.h - is a contact right? Compared with the reference, within the documented error bound.
 */
#ifndef NARC_TEST_CHECK_H
#define NARC_TEST_CHECK_H

#include "scene.h"

/* Errors as fractions of what is allowed. */
struct fractions {
    double separation, normal, point;
};

/* The documented bound of a separation's error. */
double separation_bound(const struct reference_body *a, const struct reference_body *b);

/* Checks a contact against the exact gap of its pair: separation, normal, point, arcs and radii. Raises `worst` to this
 * contact's errors where they are larger. Returns NULL, or what is wrong (static storage). */
const char *check_contact(const struct reference_body *a, const struct reference_body *b, double gap,
                          const narc_contact *contact, struct fractions *worst);

/* Prints a pair so that it can be put into a test of its own. */
void print_pair(const struct reference_body *a, const struct reference_body *b);

#endif
