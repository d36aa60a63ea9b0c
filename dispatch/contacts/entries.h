/* SPDX-License-Identifier: MIT
 *
 * entries.h - what is kept of pairs of smooth shapes for the kernel that answers them again. Internal.
 */
#ifndef NARC_ENTRIES_H
#define NARC_ENTRIES_H

#include "kernels.h"

/* Writes the entries of a batch's pairs after their dense rows, `row_stride` bytes apart, are known: those of the `count`
 * pairs that are listed, or without a list of all that are asked of at first ... The entry of pair k goes to entries[k],
 * and of manifolds also to ends[k] (of contacts NULL). It decides nothing where a shape is not smooth, or a piece of a
 * chain, where numbers are broken, or where nothing is certain. Rows say which arcs touch; they are not trusted: no rows,
 * and no poses, make an entry that tells a wrong answer.
 *
 * An entry knows the two shapes, and how bodies scale them. It serves at all poses, shifts and margins, until
 *   - its number is that of another pair, or its bodies are exchanged,
 *   - the shape index of a body, or its scale, has other bits,
 *   - a shape is replaced or removed (narc_shapes.history changes with each; a shape that is added changes nothing here,
 *     nor does it that the store moves its memory).
 * Then it must be made anew, or filled with zeros. Ends are written of pairs with known arcs alone, and read of others
 * without effect: they must have some value from the start. */
void narc_make_entries(const narc_batch *batch, size_t first, size_t count, const uint32_t *pairs, const void *rows,
                       ptrdiff_t row_stride, narc_entry *entries, narc_entry_ends *ends);

#endif
