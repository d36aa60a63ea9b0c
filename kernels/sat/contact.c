/* SPDX-License-Identifier: MIT
 *
 * contact.c - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their order.
 */
#include <stddef.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/rows.inl"
#include "kernels.h"

size_t NARC_NAMED(contact)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    static const struct question contacts = {
        .kind = CONTACT_ROWS, .normal_at = offsetof(narc_contact, normal_x), .none = write_no_contact};
    struct rows rows;
    const struct call call = begin_rows(&contacts, batch, first, count, skipped, out, &rows);
    NARC_NAMED(find_rows)(&call);
    return end_rows(&call, sizeof(narc_contact));
}
