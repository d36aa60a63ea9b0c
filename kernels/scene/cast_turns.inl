/* SPDX-License-Identifier: MIT
 *
 * cast_turns.inl - what contacts of casts mean where outlines turn.
 *
 * With d the way from A's position to B's, w its change in a whole step, n the contact normal and f the separation:
 *
 * f(t) is at least the gap g(t) along any axis, and the axis that n is now, at rest or turning with a body or with the
 * line of two arcs' centres, is followed to a time before which g cannot be at the target. While the arcs that hold it stay
 * the same, with centres p relative to their bodies and the axis turning at the rate w_n,
 *     g' = n.w + w_n n x d + (w_b - w_n) p_b x n - (w_a - w_n) p_a x n,    g'' >= -M,
 *     M  = w_n^2 |d| + 2 |w_n| |w| + (w_b - w_n)^2 max(p_b.n, 0) + (w_a - w_n)^2 max(-p_a.n, 0).
 * So steps lead to the first root of a quadratic, and from there again: g and g' after a time s are at least what their
 * series to s^3 have, with the bound of the fourth derivative, w_n^4 |d| + 4 |w_n|^3 |w| + (w_b - w_n)^4 |p_b| +
 * (w_a - w_n)^4 |p_a|. Past these arcs a support function changes at most as fast as its body turns times its lever.
 */
#ifndef NARC_SCENE_CAST_TURNS_INL
#define NARC_SCENE_CAST_TURNS_INL

#include <math.h>
#include <stdbool.h>

#include "narc_scene.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* What axes that turn meet of a body: the centre of an arc, for as long as they stay on that arc. */
struct lever {
    vd arm;      /* centre x axis */
    vd reach;    /* centre.axis */
    vd bend;     /* the least centre.axis on the way, below 0 */
    vd duration; /* at least */
};

/* An axis that is as near to an arc's end as this has the next arc; and it may be so much before the start. */
#define AT_END 0x1p-19

/* The axes of the contacts of a vector: how fast each turns, and what it meets of each body, seen from there. */
struct axes {
    float rate[V_WIDTH];
    struct met {
        struct outline_part part;
        struct held_arcs arcs; /* the arcs that hold the axes, */
        float on_arc[V_WIDTH]; /* 1, or 0: none does */
        double axis_x[V_WIDTH], axis_y[V_WIDTH];
    } met[2];
};

/* Where axes that turn leave their arcs, and where those begin. */
INLINE void find_ends(const struct held_arcs *arcs, int h, vl forward, dvec2 *out_from, dvec2 *out_to) {
    const dvec2 start = get_dvec2(arcs->start_x + h, arcs->start_y + h),
                end = get_dvec2(arcs->end_x + h, arcs->end_y + h);
    *out_from = (dvec2){d_select(forward, start.x, end.x), d_select(forward, start.y, end.y)};
    *out_to = (dvec2){d_select(forward, end.x, start.x), d_select(forward, end.y, start.y)};
}

/* Are axes, which turn in the sense of a sign, on their arcs, and stay there? */
INLINE void compare_axes(struct met *met, const float *sign) {
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const vd of = d_of_floats(sign + h), zero = d_set(0);
        const dvec2 axis = {d_load(met->axis_x + h), d_load(met->axis_y + h)};
        dvec2 from, to;
        find_ends(&met->arcs, h, d_lt(zero, of), &from, &to);
        const vl on = d_lt(d_set(AT_END), of * find_cross(axis, to)) | d_lt(find_dot(axis, to), zero);
        d_put_floats(met->on_arc + h, d_select(on, d_set(1), zero));
    }
}

/* The arcs of the body `which` that hold the axes, which turn at `rate` against it: those that touch, or the next. */
INLINE void find_held(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                      int which, vm live, vf rate, struct met *met) {
    const struct outline_part *const part = &met->part;
    const vm forward = v_lt(v_set(0), rate), turns = vm_and(live, v_lt(v_set(0), v_abs(rate)));
    if (!vm_any(turns))
        return;
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const size_t slot = k + (size_t)h;
        const dvec2 n = get_dvec2(touch->normal_x + h, touch->normal_y + h), back = {-n.x, -n.y};
        const dvec2 turned = {d_load(casts->turned_x[which] + slot), d_load(casts->turned_y[which] + slot)};
        const dvec2 axis = turn_back(turned, which == 0 ? n : back);
        d_store(met->axis_x + h, axis.x);
        d_store(met->axis_y + h, axis.y);
    }
    const vi one = vi_set(1), last = vi_sub(part->count, one);
    const vi before = vi_select(vi_lt(vi_set(0), part->arc), vi_sub(part->arc, one), last);
    const vi after = vi_select(vi_lt(part->arc, last), vi_add(part->arc, one), vi_set(0));
    float sign[V_WIDTH];
    v_store(sign, v_select(forward, v_set(1), v_set(-1)));
    const vi first = vi_select(vm_and_not(part->on_edge, forward), before, part->arc);
    load_held(shapes, part, first, &met->arcs);
    compare_axes(met, sign);
    const vm lost = vm_and_not(turns, vm_or(part->round, v_lt(v_set(0), v_load(met->on_arc))));
    if (vm_any(lost)) {
        load_held(shapes, part, vi_select(lost, vi_select(forward, after, before), first), &met->arcs);
        compare_axes(met, sign);
    }
}

/* How far an axis may turn is at least the chord to its arc's end. Of circles there is no end. */
INLINE struct lever find_arm(const struct met *met, int h, vl moves, vd scale, vd rate) {
    const vd zero = d_set(0), center_x = scale * d_of_floats(met->arcs.center_x + h),
             center_y = scale * d_of_floats(met->arcs.center_y + h);
    const dvec2 center = {center_x, center_y}, axis = {d_load(met->axis_x + h), d_load(met->axis_y + h)};
    const vl forward = d_lt(zero, rate), round = d_of_lanes(met->part.round, h);
    const vd sign = d_select(forward, d_set(1), d_set(-1)), arm = find_cross(center, axis);
    dvec2 from, to;
    find_ends(&met->arcs, h, forward, &from, &to);
    const dvec2 chord = {to.x - axis.x, to.y - axis.y};
    const vl known = d_le(d_set(-AT_END), sign * find_cross(from, axis)) | d_lt(find_dot(axis, from), zero);
    const vl through = round | (d_lt(zero, sign * arm) & d_lt(sign * find_cross(center, to), zero));
    vd least = d_min(find_dot(center, axis), find_dot(center, to));
    if (d_any(through & moves))
        least = d_select(through, -find_length(center), least);
    const vd duration = d_select(round, d_set(INFINITY), d_select(known, find_length(chord) / d_abs(rate), zero));
    const vl some = round | d_lt(zero, d_of_floats(met->on_arc + h));
    return (struct lever){d_select(some, arm, zero), d_select(some, find_dot(center, axis), zero),
                          d_select(some, d_min(least, zero), zero), d_select(some, duration, zero)};
}

/* The gap along an axis, above the target, after a time s: at least gap + s (first + s (second + s (third + s fourth))), and
 * its slope at least the slope of that; its second derivative is never below -bend. */
struct series {
    vd first, second, third, fourth, bend;
};

/* Adds a cos(rate s) + b sin(rate s), but for its value at the start and what it bends by. */
INLINE void add_turn(struct series *series, vd rate, vd a, vd b) {
    const vd square = rate * rate;
    series->first += rate * b;
    series->second -= a * square * d_set(0.5);
    series->third -= b * rate * square * d_set(1.0 / 6);
}

/* For how long a gap stays above 0 that has a slope, and bends no more than by `bend`. */
INLINE vd find_wait(vd gap, vd slope, vd bend) {
    const vd zero = d_set(0), two = d_set(2), root = d_sqrt(slope * slope + two * bend * gap);
    const vl down = d_lt(slope, zero);
    const vd way = d_select(down, two * gap, root + slope) / d_select(down, root - slope, bend);
    return d_select(down | d_lt(zero, bend), way, d_set(INFINITY));
}

/* Steps along the series of one contact. */
enum { SERIES_STEPS = 2 };

/* For how long from now on the gap, which is `gap` above the target, stays there along the normal as an axis that turns
 * at a rate; `falls` is how fast it falls at most along one at rest. `out_slope`: how it changes now. */
INLINE vd follow_axis(const narc_casts *casts, const struct touch *touch, const struct axes *axes, size_t k, int h,
                      vd gap, vd falls, vd *out_slope) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), half = d_set(0.5), two = d_set(2), rate = d_of_floats(axes->rate + h), size = d_abs(rate);
    const dvec2 n = get_dvec2(touch->normal_x + h, touch->normal_y + h),
                motion = {d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)};
    const vd along = find_dot(n, motion);
    const vl turns = d_lt(zero, size);
    struct series series = {along, zero, zero, zero, zero};
    vd duration = d_set(INFINITY), fastest = falls;
    if (d_any(turns)) {
        const vd time = d_of_floats(casts->time + slot), left = d_load(casts->end + slot) - time;
        const dvec2 way = {d_load(casts->x + slot) + time * motion.x, d_load(casts->y + slot) + time * motion.y};
        const vd speed = find_length(motion), far = size * (find_length(way) + speed * left);
        add_turn(&series, rate, find_dot(n, way), find_cross(n, way));
        series.second += rate * find_cross(n, motion);
        series.third -= half * rate * rate * along;
        series.fourth = size * size * size * (far + d_set(4) * speed);
        series.bend = size * (far + two * speed);
        fastest += d_select(turns, along + speed, zero);
    }
    for (int side = 0; side < 2; side++) {
        const struct narc_cast_side *const of = &casts->side[side];
        const vd its = rate - d_of_floats(of->angle + slot), square = its * its;
        const vl moves = d_lt(zero, d_abs(its));
        if (!d_any(moves))
            continue;
        const struct lever lever = find_arm(&axes->met[side], h, moves, d_of_floats(of->scale + slot), its);
        const vd arm = d_select(moves, lever.arm, zero), reach = d_select(moves, lever.reach, zero);
        add_turn(&series, its, -reach, arm);
        series.fourth += square * square * (d_abs(arm) + d_abs(reach));
        series.bend -= d_select(moves, square * lever.bend, zero);
        duration = d_select(moves, d_min(lever.duration, duration), duration);
    }
    const vd slope = series.first, bend = series.bend, fourth = series.fourth * d_set(-1.0 / 24);
    vd whole = find_wait(gap, slope, bend);
    UNROLL
    for (int step = 0; step < SERIES_STEPS; step++) {
        const vd high = series.third + whole * fourth, low = series.second + whole * high;
        const vd value = gap + whole * (slope + whole * low);
        const vd next = find_wait(value, slope + whole * (low + low + whole * (high + whole * fourth)), bend);
        whole = d_select(d_lt(zero, value) & d_lt(zero, next), whole + next, whole);
    }
    *out_slope = slope;
    const vl on_arc = d_le(whole, duration);
    if (!d_any(~on_arc))
        return whole;
    const vd rest = gap + duration * (slope - bend * duration / two);
    return d_select(on_arc, whole, d_select(d_lt(zero, rest), duration + rest / fastest, duration));
}

INLINE void advance_turn(const narc_casts *casts, const struct touch *touch, const struct axes *axes, size_t k, int h,
                         struct step *out) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), time = d_of_floats(casts->time + slot), end = d_load(casts->end + slot),
             rounds = d_of_floats(casts->rounds + slot) + d_set(1);
    const vd gap = d_of_floats(touch->separation + h) - d_of_floats(casts->target + slot);
    const vd along = d_of_floats(touch->normal_x + h) * d_load(casts->motion_x + slot) +
                     d_of_floats(touch->normal_y + h) * d_load(casts->motion_y + slot);
    const vd falls = d_load(casts->moved + slot) - along;
    vd slope;
    const vd duration = follow_axis(casts, touch, axes, k, h, gap, falls, &slope), least = gap / falls;
    const vd next = time + d_max(duration, least), safe = round_down(next);
    const vl near = d_le(gap, d_load(casts->enough + slot)), last = d_le(d_set(MOST_ROUNDS), rounds);
    const vd hit = d_set(NARC_CAST_HIT), miss = d_set(NARC_CAST_MISS), on = d_set(CAST_GOES_ON);
    vd outcome = d_select(last, d_select(near, hit, d_set(NARC_CAST_UNFINISHED)), on);
    outcome = d_select(d_lt(end, next), miss, d_select(d_le(safe, time), hit, outcome));
    outcome = d_select(d_le(falls, zero), miss, d_select(near & d_le(slope, zero), hit, outcome));
    outcome = d_select(d_le(gap, zero), hit, outcome);
    put_step(out, h, outcome, d_select(d_lt(d_set(NARC_CAST_UNFINISHED), outcome), safe, time), rounds);
}

/* The line of the centres of two arcs counts as at rest where it turns faster: then its series says little. */
#define MOST_RATE 0x1p5

/* How fast that line turns: what its ends move across it, by its length. Along n both outlines are half a separation from
 * the point of the contact, and the centres their radii from there. */
INLINE vd find_rate(const narc_casts *casts, const struct touch *touch, size_t k, int h) {
    const size_t slot = k + (size_t)h;
    const dvec2 n = get_dvec2(touch->normal_x + h, touch->normal_y + h),
                motion = {d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)},
                position = get_dvec2(casts->x_now + slot, casts->y_now + slot);
    const vd half = d_set(0.5) * d_of_floats(touch->separation + h),
             middle = find_dot(n, get_dvec2(touch->point_x + h, touch->point_y + h)),
             a = middle - half - d_of_floats(touch->radius_a + h), b = middle + half + d_of_floats(touch->radius_b + h),
             length = b - a;
    const vd across = find_cross(n, motion) - d_of_floats(casts->side[0].angle + slot) * a +
                      d_of_floats(casts->side[1].angle + slot) * (b - find_dot(n, position));
    return d_select(d_lt(d_abs(across), d_set(MOST_RATE) * length), across / length, d_set(0));
}

INLINE void advance_turns(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                          vm live, struct step *out) {
    const vf angle_a = v_load(casts->side[0].angle + k), angle_b = v_load(casts->side[1].angle + k), zero = v_set(0);
    struct axes axes;
    for (int side = 0; side < 2; side++)
        axes.met[side].part = find_part(&casts->side[side], k, side, live, touch);
    const vf of_b = v_select(axes.met[1].part.on_edge, angle_b, zero);
    const vf of_edges = v_select(vm_and(axes.met[0].part.on_edge, v_lt(zero, v_abs(angle_a))), angle_a, of_b);
    const vm planes =
        vm_or(is_plane(vi_bits(v_load(casts->side[0].info + k))), is_plane(vi_bits(v_load(casts->side[1].info + k))));
    vf rate = v_select(planes, zero, of_edges); /* of a half-plane no other axis says anything */
    const vf radii = v_add(v_load(touch->radius_a), v_load(touch->radius_b)); /* infinite on an edge */
    const vm round = vm_and(v_lt(v_abs(v_load(touch->separation)), radii), v_lt(radii, v_set(INFINITY)));
    if (vm_any(vm_and(live, round))) {
        for (int h = 0; h < V_WIDTH; h += D_WIDTH)
            d_put_floats(axes.rate + h, find_rate(casts, touch, k, h));
        rate = v_select(round, v_load(axes.rate), rate);
    }
    v_store(axes.rate, rate);
    for (int side = 0; side < 2; side++)
        find_held(shapes, casts, touch, k, side, live, v_sub(rate, side == 0 ? angle_a : angle_b), &axes.met[side]);
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        advance_turn(casts, touch, &axes, k, h, out);
}

#endif
