/* SPDX-License-Identifier: MIT
 *
 * cast_places.inl - where the bodies of casts are at their times.
 */
#ifndef NARC_SCENE_CAST_PLACES_INL
#define NARC_SCENE_CAST_PLACES_INL

#include <stdbool.h>
#include <stddef.h>

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
    return direction;
}

/* Too large for that. */
INLINE vl are_many_turns(vd angle) { return ~d_lt(d_abs(angle), d_set(0x1p20)); }

INLINE dvec2 find_all_directions(vd angle) {
    dvec2 direction = find_directions(angle);
    const vl many = are_many_turns(angle);
    if (d_any(many)) {
        double angles[D_WIDTH], cosine[D_WIDTH], sine[D_WIDTH];
        d_store(angles, angle);
        for (int l = 0; l < D_WIDTH; l++)
            narc_find_cosine(angles[l], &cosine[l], &sine[l]);
        direction = (dvec2){d_select(many, d_load(cosine), direction.x), d_select(many, d_load(sine), direction.y)};
    }
    return direction;
}

/* Which of casts k ... turn? */
INLINE vm find_turning(const narc_casts *casts, size_t k) {
    const vf angle_a = v_load(casts->side[0].angle + k), angle_b = v_load(casts->side[1].angle + k);
    return v_lt(v_set(0), v_max(v_abs(angle_a), v_abs(angle_b)));
}

/* The rotations of casts k ... at their times; what does not turn keeps its own, to the bit. */
INLINE void turn_bodies(narc_casts *casts, int which, size_t k) {
    const struct narc_cast_side *const side = &casts->side[which];
    float cosine[V_WIDTH], sine[V_WIDTH];
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const size_t slot = k + (size_t)h;
        const vd angle = d_of_floats(side->angle + slot), zero = d_set(0);
        dvec2 direction = {d_set(1), zero};
        if (d_any(d_lt(zero, d_abs(angle))))
            direction = find_all_directions(d_of_floats(casts->time + slot) * angle);
        const dvec2 turned = turn(direction, find_rotation(side->cosine + slot, side->sine + slot));
        d_store(casts->turned_x[which] + slot, turned.x);
        d_store(casts->turned_y[which] + slot, turned.y);
        d_put_floats(cosine + h, turned.x);
        d_put_floats(sine + h, turned.y);
    }
    const vm turns = v_lt(v_set(0), v_abs(v_load(side->angle + k)));
    v_store(casts->cosine_now[which] + k, v_select(turns, v_load(cosine), v_load(side->cosine + k)));
    v_store(casts->sine_now[which] + k, v_select(turns, v_load(sine), v_load(side->sine + k)));
}

/* The bodies of one cast that turns, in both halves of registers: their angles, and their rotations at the start. */
#ifdef NARC_SIMD_ONE_H
struct both {
    vd angle;
    dvec2 rotation;
};

INLINE struct both load_both(const narc_casts *casts) {
    const struct narc_cast_side *const a = &casts->side[0], *const b = &casts->side[1];
    const dvec2 of_a = find_rotation(a->cosine, a->sine), of_b = find_rotation(b->cosine, b->sine);
    return (struct both){d_both(d_of_floats(a->angle), d_of_floats(b->angle)),
                         {d_both(of_a.x, of_b.x), d_both(of_a.y, of_b.y)}};
}

/* turn_bodies() of both, or false. */
INLINE bool turn_both(narc_casts *casts, const struct both *both) {
    const vd angle = d_set((double)casts->time[0]) * both->angle;
    const vl many = are_many_turns(angle);
    if (d_any(many) || d_any((vl)d_other((vd)many)))
        return false;
    const dvec2 turned = turn(find_directions(angle), both->rotation);
    float cosine[2], sine[2];
    _mm_storel_pi((__m64 *)(void *)cosine, _mm_cvtpd_ps(turned.x));
    _mm_storel_pi((__m64 *)(void *)sine, _mm_cvtpd_ps(turned.y));
    for (int which = 0; which < 2; which++) {
        const bool turns = casts->side[which].angle[0] != 0;
        d_store(casts->turned_x[which], which == 0 ? turned.x : d_other(turned.x));
        d_store(casts->turned_y[which], which == 0 ? turned.y : d_other(turned.y));
        casts->cosine_now[which][0] = turns ? cosine[which] : casts->side[which].cosine[0];
        casts->sine_now[which][0] = turns ? sine[which] : casts->side[which].sine[0];
    }
    return true;
}
#elif defined(NARC_ONE_PAIR)
struct both {
    bool none;
};

INLINE struct both load_both(const narc_casts *casts) { return (struct both){casts == NULL}; }

INLINE bool turn_both(const narc_casts *casts, const struct both *both) { return !casts && both->none; }
#endif

/* The positions of casts k ... at their times. */
INLINE void move_bodies(narc_casts *casts, size_t k) {
    for (size_t h = k; h < k + V_WIDTH; h += D_WIDTH) {
        const vd time = d_of_floats(casts->time + h);
        d_put_floats(casts->x_now + h, d_load(casts->x + h) + time * d_load(casts->motion_x + h));
        d_put_floats(casts->y_now + h, d_load(casts->y + h) + time * d_load(casts->motion_y + h));
    }
}

#endif
