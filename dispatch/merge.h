/* SPDX-License-Identifier: MIT
 *
 * merge.h - what several entries of a chain tell of one body, as one. Internal.
 */
#ifndef NARC_MERGE_H
#define NARC_MERGE_H

#include "narc_chains.h"

/* Rows that are merged:
 *   pairs    those of the query, whose bodies `a` are asked about. Bodies `b` are entries of chains, or others
 *   run      of each body `b`: its entry's run, of other bodies NARC_NO_RUN: their rows stay as they are; base NULL: as
 *            if all were NARC_NO_RUN
 *   shapes   the store of bodies `b`, and those; or NULL: none goes on where a corner is cut */
typedef struct narc_merging {
    const narc_pairs *pairs;
    narc_index_column run;
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    narc_contact *contacts; /* one of both */
    narc_manifold *manifolds;
} narc_merging;

/* Merges what several entries tell of one body: `count` rows of narc_find_contacts() or narc_find_manifolds(), in their
 * order, without gaps, in place; returns how many are left. Rows without a contact go.
 * Looked at are rows of one body a that follow each other, as a broad phase lists them, each beside the 64 before it:
 *   - Of two rows of one run that have one normal (within 1e-4 rad) the points are joined: the two outermost stay,
 *     but for the higher one where the deepest lies between them, in the first one's row, which is compared again. (A
 *     contact has one point: that with the smaller separation.) Else the row with the greater separation stays, which is
 *     that of the whole run, unless what they touch is not convex: the sides of a run that turns by more than half a turn
 *     may face each other, where they are further from each other than entries go on beyond a corner that is cut.
 *   - Of two rows with one normal (within 1e-3 rad) and the same points (within 2^-12 of their distance from the
 *     position of a; deep ones of one depth in the body's surface or the ground's) the one with more points stays, else
 *     that of a concave arc, or the first one, with the smaller separation of each point: a seam, told by both.
 *   - Where an edge of a body lies along a line that goes over into a concave arc, and ends on that, both rows are joined.
 *   - Of two rows below 0 of faces that look away from each other, the two sides of a thin solid, the deeper one goes.
 * The same bits on every machine. Time in proportion to the rows. Thread-safe. */
size_t narc_merge_rows(const narc_merging *list, size_t count);

/* The same of rows first .. end - 1, which are of one body; returns the end of those that are left. */
size_t narc_merge_body(const narc_merging *rows, size_t first, size_t end);

#endif
