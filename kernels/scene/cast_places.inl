/* SPDX-License-Identifier: MIT
 *
 * cast_places.inl - where the bodies of casts are at their times.
 */
#ifndef NARC_SCENE_CAST_PLACES_INL
#define NARC_SCENE_CAST_PLACES_INL

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "elementary.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Cosines and sines of angles, to some 1e-14: quarter turns and the series of the rest. They are rounded to floats. */
INLINE dvec2 find_directions(vd angle) {
    const vd whole = d_set(0x1.8p52); /* what is added to it is rounded to an integer */
    const vd quarters = (angle * d_set(0.63661977236758134) + whole) - whole; /* 2 / pi */
    const vd part = quarters - d_set(4) * ((quarters * d_set(0.25) + whole) - whole), size = d_abs(part);
    const vd x = (angle - quarters * d_set(0x1.921fb544p+0)) - quarters * d_set(0x1.0b4611a626331p-34), z = x * x;
    const vd one = d_set(1);
    vd s = d_set(-1.0 / 39916800), c = d_set(1.0 / 479001600);
    s = d_set(-1.0 / 6) + z * (d_set(1.0 / 120) + z * (d_set(-1.0 / 5040) + z * (d_set(1.0 / 362880) + z * s)));
    c = d_set(1.0 / 24) + z * (d_set(-1.0 / 720) + z * (d_set(1.0 / 40320) + z * (d_set(-1.0 / 3628800) + z * c)));
    s = x + x * z * s;
    c = one - z * (d_set(0.5) - z * c);
    const vl odd = d_le(size, one) & d_le(one, size), opposite = d_lt(one, size) | d_lt(part, d_set(0));
    const dvec2 p = {d_select(odd, -s, c), d_select(odd, c, s)};
    dvec2 direction = {d_select(opposite, -p.x, p.x), d_select(opposite, -p.y, p.y)};
    const vl small = d_lt(d_abs(angle), d_set(0x1p20));
    if (d_any_held(~small)) {
        double angles[D_HELD], cosine[D_HELD], sine[D_HELD];
        memcpy(angles, &angle, sizeof angle);
        for (int l = 0; l < D_HELD; l++)
            narc_find_cosine(angles[l], &cosine[l], &sine[l]);
        dvec2 other;
        memcpy(&other.x, cosine, sizeof angle);
        memcpy(&other.y, sine, sizeof angle);
        direction = (dvec2){d_select(small, direction.x, other.x), d_select(small, direction.y, other.y)};
    }
    return direction;
}

/* Which of casts k ... turn? */
INLINE vm find_turning(const narc_casts *casts, size_t k) {
    const vf angle_a = v_load(casts->side[0].angle + k), angle_b = v_load(casts->side[1].angle + k);
    return v_lt(v_set(0), v_max(v_abs(angle_a), v_abs(angle_b)));
}

/* The bodies of casts that turn: their angles, and their rotations at the start. Both in one register where it has room. */
enum { HOLDERS = 2 / D_ROOM };
struct turning {
    vd angle[HOLDERS];
    dvec2 rotation[HOLDERS];
};

INLINE struct turning load_turning(const narc_casts *casts, size_t slot) {
    const struct narc_cast_side *const a = &casts->side[0], *const b = &casts->side[1];
    const dvec2 rotation[] = {find_rotation(a->cosine + slot, a->sine + slot),
                              find_rotation(b->cosine + slot, b->sine + slot)};
    const vd angle[] = {d_of_floats(a->angle + slot), d_of_floats(b->angle + slot)};
    struct turning turning;
    for (int k = 0; k < HOLDERS; k++) {
        turning.angle[k] = d_both(angle[k], angle[1]);
        turning.rotation[k] = (dvec2){d_both(rotation[k].x, rotation[1].x), d_both(rotation[k].y, rotation[1].y)};
    }
    return turning;
}

/* Their rotations at their times. */
INLINE void turn_bodies(narc_casts *casts, size_t slot, const struct turning *turning) {
    const vd time = d_both(d_of_floats(casts->time + slot), d_of_floats(casts->time + slot)), zero = d_set(0);
    dvec2 turned[HOLDERS];
    for (int k = 0; k < HOLDERS; k++) {
        dvec2 direction = {d_set(1), zero};
        if (D_ROOM > 1 || d_any(d_lt(zero, d_abs(turning->angle[k]))))
            direction = find_directions(time * turning->angle[k]);
        turned[k] = turn(direction, turning->rotation[k]);
    }
    const vd x[] = {turned[0].x, d_other(turned[HOLDERS - 1].x)}, y[] = {turned[0].y, d_other(turned[HOLDERS - 1].y)};
    UNROLL
    for (int which = 0; which < 2; which++) {
        d_store(casts->turned_x[which] + slot, x[which]);
        d_store(casts->turned_y[which] + slot, y[which]);
        d_put_floats(casts->cosine_now[which] + slot, x[which]);
        d_put_floats(casts->sine_now[which] + slot, y[which]);
    }
}

/* What does not turn, of casts k ..., keeps its own rotation, to the bit. */
INLINE void keep_rotations(narc_casts *casts, size_t k) {
    UNROLL
    for (int which = 0; which < 2; which++) {
        const struct narc_cast_side *const side = &casts->side[which];
        float *const cosine = casts->cosine_now[which] + k, *const sine = casts->sine_now[which] + k;
        const vm turns = v_lt(v_set(0), v_abs(v_load(side->angle + k)));
        v_store(cosine, v_select(turns, v_load(cosine), v_load(side->cosine + k)));
        v_store(sine, v_select(turns, v_load(sine), v_load(side->sine + k)));
    }
}

/* The positions of casts k ... at their times. */
INLINE void move_bodies(narc_casts *casts, size_t k) {
    for (size_t h = k; h < k + V_WIDTH; h += D_WIDTH) {
        const vd time = d_of_floats(casts->time + h);
        d_put_floats(casts->x_now + h, d_load(casts->x + h) + time * d_load(casts->motion_x + h));
        d_put_floats(casts->y_now + h, d_load(casts->y + h) + time * d_load(casts->motion_y + h));
    }
}

#endif
