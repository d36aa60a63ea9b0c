/* SPDX-License-Identifier: MIT
 *
 * pose.c - the pose kernel: cosines and sines of many angles.
 *
 * SLEEF's `cinz` functions promise equal bits on every instruction set and use no fused multiply-add, so that the
 * scalar table runs on any processor. Without SLEEF every table takes one angle at a time, in double precision, by
 * soa/elementary.h.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "kernels.h"
#include "simd/simd.h"

#if defined(NARC_WITH_SLEEF)
#include <sleef.h>

static inline void sincos_lanes(const float *angles, float *out_cosines, float *out_sines) {
    const vf angle = v_load(angles);
    const vm finite = v_lt(v_abs(angle), v_set(INFINITY));
    const TYPE_OF(V_SINCOS(angle)) sincos = V_SINCOS(angle);
    v_store(out_cosines, v_select(finite, sincos.y, v_set(NAN)));
    v_store(out_sines, v_select(finite, sincos.x, v_set(NAN)));
}

void NARC_NAMED(pose)(const float *angles, size_t count, float *out_cosines, float *out_sines) {
    size_t k = 0;
    for (; count - k >= V_WIDTH; k += V_WIDTH)
        sincos_lanes(angles + k, out_cosines + k, out_sines + k);
    if (k == count)
        return;
    float rest[V_WIDTH] = {0}, cosines[V_WIDTH], sines[V_WIDTH];
    memcpy(rest, angles + k, (count - k) * sizeof(float));
    sincos_lanes(rest, cosines, sines);
    memcpy(out_cosines + k, cosines, (count - k) * sizeof(float));
    memcpy(out_sines + k, sines, (count - k) * sizeof(float));
}

#else

void NARC_NAMED(pose)(const float *angles, size_t count, float *out_cosines, float *out_sines) {
    for (size_t k = 0; k < count; k++) {
        double cosine, sine;
        narc_find_cosine((double)angles[k], &cosine, &sine);
        out_cosines[k] = (float)cosine;
        out_sines[k] = (float)sine;
    }
}

#endif
