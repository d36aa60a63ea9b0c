/* SPDX-License-Identifier: MIT
 *
 * plain_kernels.c - the exact kernels' scalar table without shortcuts.
 */
#define NARC_SHORTCUTS 0
#define NARC_SIMD      "simd/scalar.h"
#include "plain_kernels.h"
#include "pose.inl"
#include "sat/contact.inl"
#include "sat/overlap.inl"

const narc_kernel_table narc_kernels_plain = {
    .isa = "plain", .overlap = overlap, .contact = contact, .manifold = manifold, .pose = pose};
