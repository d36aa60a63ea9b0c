/* SPDX-License-Identifier: MIT
 *
 * contact_row.inl - an answer as a contact.
 */
#ifndef NARC_BASE_CONTACT_ROW_INL
#define NARC_BASE_CONTACT_ROW_INL

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/question.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Bytes of a row's members: eight words from there to the end, behind the pair. */
enum { CONTACT_WORDS = offsetof(narc_contact, feature) };
_Static_assert(sizeof(narc_contact) == 36 && CONTACT_WORDS == 4, "two writes of four words follow the pair");

INLINE void write_contacts(const struct call *call, char *const *place, vi numbers, const struct answer *answer,
                           const struct sides *sides) {
    const vf front[4] = {v_of_bits(pack_halves(answer->feature, vi_set(1))), answer->separation, answer->normal.x,
                         answer->normal.y};
    const vf rest[4] = {answer->point.x, answer->point.y, answer->radius_a, answer->radius_b};
    int32_t number[V_WIDTH];
    (void)call;
    (void)sides;
    vi_store(number, numbers);
    v_put_rows(place, CONTACT_WORDS, front);
    v_put_rows(place, CONTACT_WORDS + 16, rest);
    for (int lane = 0; lane < V_WIDTH; lane++)
        memcpy(place[lane], &number[lane], sizeof number[lane]);
}

static inline void write_no_contact(char *place, uint32_t pair, float separation) {
    const narc_contact contact = {.pair = pair, .separation = separation};
    memcpy(place, &contact, sizeof contact);
}

#endif
