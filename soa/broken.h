/* SPDX-License-Identifier: MIT
 *
 * broken.h - when the numbers of a body are broken, and how a rotation is made of length 1. Internal.
 *
 * The limits are those of single precision, operation by operation as the lanes of kernels/base/bodies.inl compute them:
 * at the limit rounding decides, and all calls must decide alike (tests/kernels/broken.c).
 */
#ifndef NARC_BROKEN_H
#define NARC_BROKEN_H

#include <math.h>
#include <stdbool.h>

#include "narc_pairs.h"
#include "store.h"

/* False for NaN. */
static inline bool narc_is_rotation(float cosine, float sine) {
    return fabsf(cosine * cosine + sine * sine - 1.0f) <= (float)NARC_ROTATION_TOLERANCE;
}

/* The bounding radius times the scale. False for NaN, and for a removed shape's. */
static inline bool narc_is_size(float size) {
    return (float)NARC_MIN_SIZE <= size && size <= (float)NARC_MAX_BOUND_RADIUS;
}

/* 1 / sqrt(1 + e), of a rotation whose square is 1 + e, doubles or lanes of them: the next term, 63/256 e^5, is below
 * 2^-57. So what is far away is not off in proportion. Lanes of floats take the first two terms. */
#define NARC_INVERSE_LENGTH(e) (1.0 - (e) * (0.5 - (e) * (0.375 - (e) * (0.3125 - (e)*0.2734375))))

#endif
