/* SPDX-License-Identifier: MIT
 *
 * contact.c - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their order.
 */
#include <stddef.h>

#include "base/contact_row.inl"
#include "kernels.h"
#include "sat/answers.inl"

/* The count is the upper half of the word behind the pair, in memory the second. */
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
enum { EXTRA_ROW = NARC_FURTHER_ROW };
#else
enum { EXTRA_ROW = NARC_FURTHER_ROW << 16 };
#endif

NARC_QUESTION(contact, narc_contact, offsetof(narc_contact, normal_x), EXTRA_ROW, write_no_contact, write_contacts,
              false)
