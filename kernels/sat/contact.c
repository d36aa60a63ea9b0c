/* SPDX-License-Identifier: MIT
 *
 * contact.c - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their order.
 */
#include <stddef.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/contact_row.inl"
#include "base/question.inl"
#include "kernels.h"
#include "sat/answers.inl"
#include "simd/simd.h"

/* The count is the upper half of the word behind the pair, in memory the second. */
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
enum { EXTRA_ROW = NARC_MORE_ROW };
#else
enum { EXTRA_ROW = NARC_MORE_ROW << 16 };
#endif

NARC_QUESTION(contact, narc_contact, offsetof(narc_contact, normal_x), EXTRA_ROW, write_no_contact, write_contacts,
              false)
NARC_ROWS(contacts, narc_contact, write_contacts, ANSWER_EDGES)

size_t NARC_NAMED(contact)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    return answer_contacts(&contact_question, batch, first, count, skipped, out);
}
