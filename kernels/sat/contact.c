/* SPDX-License-Identifier: MIT
 *
 * contact.c - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their order.
 * Other questions go the same way.
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
              false, NULL)

/* Two circles are soon answered: of contacts without a call. */
INLINE void write_discs(const struct call *call, char *const *place, vi numbers, const struct answer *answer,
                        const struct sides *sides) {
    if (LIKELY(!call->question->discs))
        write_contacts(call, place, numbers, answer, sides);
    else
        call->question->discs(call, place, numbers, answer, sides);
}

NARC_ROWS(contacts, narc_contact, write_discs, ANSWER_EDGES)

size_t NARC_NAMED(rows)(const struct question *question, const narc_batch *batch, size_t first, size_t count,
                        size_t *skipped, const narc_rows *out) {
    return answer_contacts(question, batch, first, count, skipped, out);
}

size_t NARC_NAMED(contact)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    return answer_contacts(&contact_question, batch, first, count, skipped, out);
}
