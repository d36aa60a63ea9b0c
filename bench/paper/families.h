/* SPDX-License-Identifier: MIT
 *
 * families.h - random shapes of several families, easy and hard ones, for counting wrong answers.
 */
#ifndef NARC_PAPER_FAMILIES_H
#define NARC_PAPER_FAMILIES_H

#include "common.h"

enum family { FAMILY_ROUND, FAMILY_THIN, FAMILY_LENS, FAMILY_UNEQUAL, FAMILY_POLYGON, FAMILIES };

const char *family_name(enum family family);

/* A shape with a bounding radius from 0.5 to 2 around its centroid; the number of its arcs is returned. */
size_t make_shape(enum family family, uint64_t *random, narc_arc *out_arcs);

#endif
