/* SPDX-License-Identifier: MIT
 *
 * local_maximum.inl - a local maximum of the gap over all directions (normal_fan.inl).
 */
#ifndef NARC_SAT_LOCAL_MAXIMUM_INL
#define NARC_SAT_LOCAL_MAXIMUM_INL

#include "base/arcs.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* It lies between two junctions, where `after` and `before` are both the arcs that hold it, or (`kink`) at a junction,
 * with the arcs after it and those before. */
struct local_maximum {
    vm found, kink;
    vec2 direction; /* not yet of length 1 */
    struct arc_pair after, before;
    vi record_a, record_b; /* of the arcs after it */
};

#endif
