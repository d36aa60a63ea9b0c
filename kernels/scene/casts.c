/* SPDX-License-Identifier: MIT
 *
 * casts.c - the kernels of times of impact, a pair in each lane: where it begins, where its bodies are at a time, and
 * what the contact there means. What is not proved by docs/algorithm.md is not relied upon: a pair never goes past a
 * time at which its separation could have come down to the target, or goes back there if it may have.
 *
 * With d the way from A's position to B's, w its change in a whole step, n the contact normal and f the separation:
 *
 * Without turning f is convex in time, because it is the signed distance of a point on a line from a convex set. Its
 * slope is n.w. So the tangent never passes the first root (Newton). The circles that touch may be followed further, to
 * the root of their distance: where f still falls at that time, and is not below the target, no root was passed.
 *
 * With turning f(t) is at least the gap g(t) along any axis, and the axis that n is now, at rest or turning with a
 * body, is followed to a time before which g cannot be at the target. While the arcs that hold the axis stay the same, with
 * centres p relative to their bodies and the axis turning at the rate w_n,
 *     g' = n.w + w_n n x d + (w_b - w_n) p_b x n - (w_a - w_n) p_a x n,    g'' >= -M,
 *     M  = w_n^2 |d| + 2 |w_n| |w| + (w_b - w_n)^2 max(p_b.n, 0) + (w_a - w_n)^2 max(-p_a.n, 0).
 * Past them a support function changes at most as fast as its body turns times its lever. Where n.w falls faster than
 * both change together, f was never smaller before: such a contact is worth a try further on, where g is at the target.
 */
#include <math.h>
#include <stdint.h>

#include "base/shape.inl"
#include "elementary.h"
#include "kernels.h"
#include "narc_scene.h"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* Rounds after which an answer is "not finished". */
enum { MOST_ROUNDS = 128 };

/* Of a body that turns, by default: the part of the smaller bounding radius that a hit may be away from the target. */
#define TURNING_TOLERANCE 0x1p-10

/* What a separation without turning may be away from the target, of a distance and both radii: a quarter of what
 * rounding may do to it (NARC_ERROR_BOUND). */
#define ROUNDING 0x1p-21

/* ------------------------------------------------------------------------------------------------ double lanes */

typedef struct {
    vd x, y;
} spot;

INLINE vd find_dot(spot a, spot b) { return a.x * b.x + a.y * b.y; }
INLINE vd find_cross(spot a, spot b) { return a.x * b.y - a.y * b.x; }
INLINE vd find_length(spot a) { return d_sqrt(find_dot(a, a)); }
INLINE spot turn(spot rotation, spot p) {
    return (spot){rotation.x * p.x - rotation.y * p.y, rotation.y * p.x + rotation.x * p.y};
}
INLINE spot turn_back(spot rotation, spot p) {
    return (spot){rotation.x * p.x + rotation.y * p.y, rotation.x * p.y - rotation.y * p.x};
}
INLINE spot get_spot(const float *x, const float *y) { return (spot){d_of_floats(x), d_of_floats(y)}; }

/* Times of 0 or more as floats that are not later. */
INLINE vd round_down(vd time) {
    float lane[V_WIDTH];
    d_put_floats(lane, time);
    const vd rounded = d_of_floats(lane);
    d_put_floats(lane, d_select(d_lt(time, rounded), rounded - rounded * d_set(0x1p-24), rounded));
    return d_of_floats(lane);
}

/* Rotations at the start. The factor is Newton's step for the root, as in base/pair_setup.inl. */
INLINE spot find_rotation(const float *cosine, const float *sine) {
    float square[V_WIDTH];
    for (int l = 0; l < D_WIDTH; l++)
        square[l] = cosine[l] * cosine[l] + sine[l] * sine[l] - 1.0f;
    const vd factor = d_set(1) - d_set(0.5) * d_of_floats(square);
    return (spot){factor * d_of_floats(cosine), factor * d_of_floats(sine)};
}

/* The slots k ...; lanes behind the last one repeat the first. */
INLINE void get_slots(size_t k, size_t end, int32_t slot[V_WIDTH]) {
    for (size_t l = 0; l < V_WIDTH; l++)
        slot[l] = (int32_t)(k + l < end ? k + l : k);
}

INLINE vi get_shapes(const struct narc_cast_side *side, const int32_t *slot) {
    int32_t shape[V_WIDTH];
    for (int l = 0; l < V_WIDTH; l++)
        shape[l] = (int32_t)side->shape[slot[l]];
    return vi_load(shape);
}

/* ------------------------------------------------------------------------------------------------ the start */

/* A body: its header, and whether it is a circle, 1 or 0. */
struct outline {
    float bound_x[V_WIDTH], bound_y[V_WIDTH], bound[V_WIDTH], inner_x[V_WIDTH], inner_y[V_WIDTH], inner[V_WIDTH];
    float round[V_WIDTH];
};

INLINE void load_outline(const narc_shapes *shapes, const struct narc_cast_side *side, const int32_t *slot,
                         struct outline *out) {
    int32_t shape[V_WIDTH];
    vi_store(shape, get_shapes(side, slot));
    const struct headers h = load_headers(shapes->headers, shape);
    v_store(out->bound_x, h.bound_center.x);
    v_store(out->bound_y, h.bound_center.y);
    v_store(out->bound, h.bound_radius);
    v_store(out->inner_x, h.inner_center.x);
    v_store(out->inner_y, h.inner_center.y);
    v_store(out->inner, h.inner_radius);
    v_store(out->round, v_select(has_flag(h.info, NARC_SHAPE_CIRCLE), v_set(1), v_set(0)));
}

/* Which bodies have no broken numbers, by the kernels' rules (base/pair_setup.inl)? */
INLINE vm are_fine(const struct narc_cast_side *side, size_t k, const struct outline *outline) {
    const vf c = v_load(side->cosine + k), s = v_load(side->sine + k), one = v_set(1);
    const vf error = v_sub(v_add(v_mul(c, c), v_mul(s, s)), one);
    const vf size = v_mul(v_load(side->scale + k), v_load(outline->bound));
    const vm in_range =
        vm_and(v_le(v_set((float)NARC_MIN_SIZE), size), v_le(size, v_set((float)NARC_MAX_BOUND_RADIUS)));
    return vm_and(vm_and(in_range, v_le(v_abs(error), v_set((float)NARC_ROTATION_TOLERANCE))),
                  v_lt(v_abs(v_load(side->angle + k)), v_set(INFINITY)));
}

/* The largest |point x normal| of an outline, at most: the rate at which its support function changes when the shape
 * turns by a radian. A point p of the outline is no further from the centre q of a circle in the shape than R, and
 * along its normal p - q is no shorter than that circle's radius r, so that |p x n| <= |q| + sqrt(R^2 - r^2). Of boxes
 * and regular polygons about their origins it is half an edge, and no less will do. */
INLINE vd find_lever(const struct outline *outline, int h) {
    const spot inner = get_spot(outline->inner_x + h, outline->inner_y + h);
    const spot bound = get_spot(outline->bound_x + h, outline->bound_y + h);
    const vd off = find_length(inner), zero = d_set(0), radius = d_of_floats(outline->inner + h);
    const vd r = d_select(d_lt(zero, radius), radius, zero);
    const vd far = d_of_floats(outline->bound + h) + find_length((spot){bound.x - inner.x, bound.y - inner.y});
    const vl disc = d_lt(zero, d_of_floats(outline->round + h)) & d_le(off, zero);
    return d_select(disc, zero, off + d_sqrt(far * far - r * r));
}

/* Circles that hold the bodies all the time: their radii, and their centres from the positions. */
INLINE vd find_circle(struct narc_cast_side *side, size_t k, const struct outline *outline, int h, spot *out_center) {
    const vd scale = d_of_floats(side->scale + k), angle = d_of_floats(side->angle + k), zero = d_set(0);
    const vd radius = scale * d_of_floats(outline->bound + h);
    const spot bound = get_spot(outline->bound_x + h, outline->bound_y + h),
               center = {scale * bound.x, scale * bound.y};
    const spot turned = turn(find_rotation(side->cosine + k, side->sine + k), center);
    const vl still = d_le(d_abs(angle), zero);
    vd lever = zero;
    if (d_any(~still))
        lever = d_select(still, zero, scale * find_lever(outline, h));
    const vl rests = d_le(lever, zero);
    d_store(side->lever + k, lever);
    *out_center = (spot){d_select(rests, turned.x, zero), d_select(rests, turned.y, zero)};
    return d_select(rests, radius, radius + find_length(center));
}

/* When are two circles, that far apart, as near as `reach`? */
INLINE vl meet_circles(spot apart, spot motion, vd reach, vd *out_start, vd *out_end) {
    const vd zero = d_set(0), one = d_set(1), square = find_dot(motion, motion);
    const vd excess = find_dot(apart, apart) - reach * reach, along = find_dot(apart, motion),
             across = find_cross(apart, motion), height = reach * reach * square - across * across;
    const vd half = d_sqrt(d_select(d_lt(height, zero), zero, height));
    const vl rests = d_le(square, zero), touch = d_le(excess, zero);
    const vd divisor = d_select(rests, one, square), first = (-along - half) / divisor, last = (half - along) / divisor;
    const vd start = d_select(touch | rests, zero, first), end = d_select(rests, one, d_min(last, one));
    const vl meet = ~d_lt(height, zero) & d_le(start, end) & d_le(zero, last) & (touch | d_le(zero, first));
    *out_start = start;
    *out_end = end;
    return (rests & touch) | (~rests & meet);
}

INLINE void begin_half(narc_casts *casts, size_t k, int h, struct outline outline[2], float *out_outcome) {
    const float *const sizes[2] = {outline[0].bound + h, outline[1].bound + h};
    const spot from = {d_load(casts->x + k), d_load(casts->y + k)},
               motion = {d_load(casts->motion_x + k), d_load(casts->motion_y + k)};
    const vd far = d_set(NARC_MAX_DISTANCE), zero = d_set(0), target = d_set((double)casts->target);
    spot center_a, center_b;
    vd start, end;
    const vd radius_a = find_circle(&casts->side[0], k, &outline[0], h, &center_a),
             radius_b = find_circle(&casts->side[1], k, &outline[1], h, &center_b),
             reach = radius_a + radius_b + target;
    const spot apart = {from.x + center_b.x - center_a.x, from.y + center_b.y - center_a.y};
    const vl meet = d_le(zero, reach) & meet_circles(apart, motion, reach, &start, &end);
    const vl turns = d_lt(zero, d_load(casts->side[0].lever + k) + d_load(casts->side[1].lever + k));
    const vd smaller = d_min(d_of_floats(casts->side[0].scale + k) * d_of_floats(sizes[0]),
                             d_of_floats(casts->side[1].scale + k) * d_of_floats(sizes[1]));
    const vd given = d_set((double)casts->tolerance),
             enough = d_select(d_lt(zero, given), given, d_set(TURNING_TOLERANCE) * smaller);
    d_store(casts->end + k, end);
    d_store(casts->enough + k, d_select(turns, enough, d_set(ROUNDING) * (radius_a + radius_b + d_abs(target))));
    d_put_floats(casts->time + k, round_down(start));
    d_put_floats(casts->turning + k, d_select(turns, d_set(1), zero));
    const vd longest = d_set(INFINITY);
    const vl fine = d_le(d_abs(from.x), far) & d_le(d_abs(from.y), far) & d_lt(d_abs(motion.x), longest) &
                    d_lt(d_abs(motion.y), longest);
    const vd outcome = d_select(meet, d_set(NARC_CAST_GOES_ON), d_set(NARC_CAST_MISS));
    d_put_floats(out_outcome, d_select(fine, outcome, d_set(NARC_CAST_BROKEN)));
}

/* Places casts first .. end - 1 at the first times at which bounding circles touch, or says that they never do:
 * NARC_CAST_MISS. */
void NARC_NAMED(begin)(const narc_shapes *shapes, narc_casts *casts, size_t first, size_t end) {
    for (size_t k = first; k < end; k += V_WIDTH) {
        int32_t slot[V_WIDTH];
        float outcome[V_WIDTH];
        struct outline outline[2];
        vm fine = vm_front(V_WIDTH);
        get_slots(k, end, slot);
        for (int side = 0; side < 2; side++) {
            load_outline(shapes, &casts->side[side], slot, &outline[side]);
            fine = vm_and(fine, are_fine(&casts->side[side], k, &outline[side]));
        }
        for (int h = 0; h < V_WIDTH; h += D_WIDTH)
            begin_half(casts, k + (size_t)h, h, outline, outcome + h);
        v_store(casts->back + k, v_set(NARC_CAST_FREE));
        v_store(casts->rounds + k, v_set(0));
        vi_store(casts->outcome + k, vi_select(fine, vi_truncate(v_load(outcome)), vi_set(NARC_CAST_BROKEN)));
    }
}

/* ------------------------------------------------------------------------------------------------ places */

/* Cosines and sines of angles, to some 1e-14: quarter turns and the series of the rest. They are rounded to floats. */
INLINE spot find_directions(vd angle) {
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
    const spot p = {d_select(odd, -s, c), d_select(odd, c, s)};
    spot direction = {d_select(opposite, -p.x, p.x), d_select(opposite, -p.y, p.y)};
    const vl small = d_lt(d_abs(angle), d_set(0x1p20));
    if (d_any(~small)) {
        double angles[D_WIDTH], cosine[D_WIDTH], sine[D_WIDTH];
        d_store(angles, angle);
        for (int l = 0; l < D_WIDTH; l++)
            narc_find_cosine(angles[l], &cosine[l], &sine[l]);
        direction = (spot){d_select(small, direction.x, d_load(cosine)), d_select(small, direction.y, d_load(sine))};
    }
    return direction;
}

/* The rotations of slots k ... at their times; what does not turn keeps its own, to the bit. */
INLINE void turn_bodies(struct narc_cast_side *side, const float *time, size_t k, float *out_cosine, float *out_sine) {
    for (size_t h = k; h < k + V_WIDTH; h += D_WIDTH) {
        const spot direction = find_directions(d_of_floats(time + h) * d_of_floats(side->angle + h));
        const spot turned = turn(direction, find_rotation(side->cosine + h, side->sine + h));
        d_store(side->turned_x + h, turned.x);
        d_store(side->turned_y + h, turned.y);
        d_put_floats(out_cosine + (h - k), turned.x);
        d_put_floats(out_sine + (h - k), turned.y);
    }
    const vm turns = v_lt(v_set(0), v_abs(v_load(side->angle + k)));
    v_store(out_cosine, v_select(turns, v_load(out_cosine), v_load(side->cosine + k)));
    v_store(out_sine, v_select(turns, v_load(out_sine), v_load(side->sine + k)));
}

void NARC_NAMED(place)(narc_casts *casts, size_t count) {
    for (size_t k = 0; k < count; k += V_WIDTH) {
        const vm live = vm_front(count - k < V_WIDTH ? (int)(count - k) : V_WIDTH);
        const vf angles = v_max(v_abs(v_load(casts->side[0].angle + k)), v_abs(v_load(casts->side[1].angle + k)));
        const int any_turns = vm_any(vm_and(live, v_lt(v_set(0), angles)));
        float x[V_WIDTH], y[V_WIDTH], cosine[V_WIDTH], sine[V_WIDTH];
        for (size_t h = 0; h < V_WIDTH; h += D_WIDTH) {
            const vd time = d_of_floats(casts->time + k + h);
            d_put_floats(x + h, d_load(casts->x + k + h) + time * d_load(casts->motion_x + k + h));
            d_put_floats(y + h, d_load(casts->y + k + h) + time * d_load(casts->motion_y + k + h));
        }
        for (int side = 0; side < 2; side++) {
            char *place[V_WIDTH];
            vf row[4] = {v_set(0), v_set(0), v_load(casts->side[side].cosine + k), v_load(casts->side[side].sine + k)};
            if (any_turns) {
                turn_bodies(&casts->side[side], casts->time, k, cosine, sine);
                row[2] = v_load(cosine);
                row[3] = v_load(sine);
            }
            if (side == 1) {
                row[0] = v_load(x);
                row[1] = v_load(y);
            }
            for (size_t l = 0; l < V_WIDTH; l++)
                place[l] = (char *)casts->pose[side][k + l];
            v_put_rows(place, 0, row);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ what touches */

/* Contacts, from rows, and the arcs that they name. */
struct touch {
    int32_t slot[V_WIDTH];
    vi feature;
    float separation[V_WIDTH], normal_x[V_WIDTH], normal_y[V_WIDTH], radius_a[V_WIDTH], radius_b[V_WIDTH];
};

INLINE struct touch load_contacts(const narc_contact *contacts, size_t k, size_t count) {
    struct touch touch;
    vf row[8];
    _Static_assert(offsetof(narc_contact, normal_y) - offsetof(narc_contact, feature) == 12 &&
                       offsetof(narc_contact, radius_b) - offsetof(narc_contact, point_x) == 12,
                   "four numbers that follow each other");
    get_slots(k, count, touch.slot);
    if (V_WIDTH == 1) { /* the row has just been written, otherwise divided */
        const narc_contact *const c = &contacts[k];
        touch.feature = vi_set(c->feature);
        touch.separation[0] = c->separation;
        touch.normal_x[0] = c->normal_x;
        touch.normal_y[0] = c->normal_y;
        touch.radius_a[0] = c->radius_a;
        touch.radius_b[0] = c->radius_b;
        return touch;
    }
    v_rows(&contacts->feature, sizeof *contacts, touch.slot, row);
    v_rows(&contacts->point_x, sizeof *contacts, touch.slot, row + 4);
    touch.feature = vi_bits(row[0]);
    v_store(touch.separation, row[1]);
    v_store(touch.normal_x, row[2]);
    v_store(touch.normal_y, row[3]);
    v_store(touch.radius_a, row[6]);
    v_store(touch.radius_b, row[7]);
    return touch;
}

/* The shape of a body, and which arc of it touches. */
struct outline_part {
    vi first_record, count, arc;
    vm round, on_edge; /* is it a circle; does the edge before the arc touch? */
};

INLINE struct outline_part find_part(const narc_shapes *shapes, const struct narc_cast_side *side, int which,
                                     const struct touch *touch) {
    int32_t shape[V_WIDTH];
    vf word[4];
    vi_store(shape, get_shapes(side, touch->slot));
    v_rows(shapes->headers, sizeof *shapes->headers, shape, word);
    const vi info = vi_bits(word[1]), count = get_arc_count(info);
    const vi feature = which == 0 ? touch->feature : vi_shift_right(touch->feature, 8);
    const vi from_first = vi_sub(vi_and(feature, vi_set(NARC_FEATURE_EDGE - 1)), get_first_arc(info));
    return (struct outline_part){.first_record = find_first_arc(vi_bits(word[0]), info),
                                 .count = count,
                                 .arc = vi_select(vi_lt(from_first, vi_set(0)), vi_add(from_first, count), from_first),
                                 .round = has_flag(info, NARC_SHAPE_CIRCLE),
                                 .on_edge = vi_lt(vi_set(0), vi_and(feature, vi_set(NARC_FEATURE_EDGE)))};
}

/* An arc of each lane. */
struct held_arcs {
    float center_x[V_WIDTH], center_y[V_WIDTH], start_x[V_WIDTH], start_y[V_WIDTH], end_x[V_WIDTH], end_y[V_WIDTH];
};

INLINE void load_held(const narc_shapes *shapes, const struct outline_part *part, vi arc, struct held_arcs *out) {
    vf field[8];
    load_records(shapes->records, vi_add(part->first_record, vi_select(part->round, vi_set(0), arc)), field);
    v_store(out->center_x, field[0]);
    v_store(out->center_y, field[1]);
    v_store(out->start_x, field[4]);
    v_store(out->start_y, field[5]);
    v_store(out->end_x, field[6]);
    v_store(out->end_y, field[7]);
}

INLINE vl find_true(vm m, int h) {
    float lane[V_WIDTH];
    v_store(lane, v_select(m, v_set(1), v_set(0)));
    return d_lt(d_set(0), d_of_floats(lane + h));
}

/* What a step has come to. */
struct step {
    float outcome[V_WIDTH], time[V_WIDTH], back[V_WIDTH], rounds[V_WIDTH];
};

INLINE void put_step(struct step *out, int h, vd outcome, vd time, vd back, vd rounds) {
    d_put_floats(out->outcome + h, outcome);
    d_put_floats(out->time + h, time);
    d_put_floats(out->back + h, back);
    d_put_floats(out->rounds + h, rounds);
}

/* ------------------------------------------------------------------------------------------------ without turning */

/* When, from now on, the circles of two arcs that are nearest to each other are at the target; false if never, or if
 * other arcs would be nearest then. */
INLINE vl find_touch(const narc_casts *casts, const struct touch *touch, size_t k, int h,
                     const struct held_arcs arcs[2], const struct outline_part parts[2], vd *out_duration) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), radii = d_of_floats(touch->radius_a + h) + d_of_floats(touch->radius_b + h),
             goal = radii + d_set((double)casts->target), way = radii + d_of_floats(touch->separation + h);
    const spot n = get_spot(touch->normal_x + h, touch->normal_y + h), u = {way * n.x, way * n.y},
               motion = {d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)};
    const vd across = find_cross(u, motion), height = goal * goal * find_dot(motion, motion) - across * across;
    const vd duration = (find_dot(u, u) - goal * goal) / (d_sqrt(d_abs(height)) - find_dot(u, motion));
    vl found = d_lt(radii, d_set(INFINITY)) & d_lt(zero, goal) & d_le(zero, height);
    for (int side = 0; side < 2; side++) {
        const spot then = {u.x + duration * motion.x, u.y + duration * motion.y}, back = {-then.x, -then.y};
        const spot normal = turn_back(find_rotation(casts->side[side].cosine + slot, casts->side[side].sine + slot),
                                      side == 0 ? then : back);
        const spot start = get_spot(arcs[side].start_x + h, arcs[side].start_y + h),
                   end = get_spot(arcs[side].end_x + h, arcs[side].end_y + h);
        found &= find_true(parts[side].round, h) |
                 (d_le(zero, find_cross(start, normal)) & d_le(zero, find_cross(normal, end)));
    }
    *out_duration = duration;
    return found;
}

/* Newton's steps; `out_next`: where each leads to if it may be tried to go further, else infinity. */
INLINE void advance_line(const narc_casts *casts, const struct touch *touch, size_t k, int h, struct step *out,
                         double *out_next) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), time = d_of_floats(casts->time + slot), back = d_of_floats(casts->back + slot),
             rounds = d_of_floats(casts->rounds + slot) + d_set(1), enough = d_load(casts->enough + slot);
    const vd gap = d_of_floats(touch->separation + h) - d_set((double)casts->target),
             slope = d_of_floats(touch->normal_x + h) * d_load(casts->motion_x + slot) +
                     d_of_floats(touch->normal_y + h) * d_load(casts->motion_y + slot);
    const vl parts = d_le(zero, slope), tried = d_le(zero, back), direct = d_le(back, d_set((double)NARC_CAST_DIRECT));
    const vl passed = tried & (parts | d_lt(gap, -enough)); /* it may have passed the first root */
    const vl there = d_le(gap, zero) | (d_le(gap, enough) & ~parts);
    const vd next = time - gap / slope, safe = round_down(next), hit = d_set(NARC_CAST_HIT),
             on = d_set(NARC_CAST_GOES_ON);
    vd outcome = d_select(d_le(d_set(MOST_ROUNDS), rounds), d_set(NARC_CAST_UNFINISHED), on);
    outcome = d_select(parts | d_lt(d_load(casts->end + slot), next), d_set(NARC_CAST_MISS),
                       d_select(d_le(safe, time), hit, outcome));
    outcome = d_select(passed, on, d_select(there, hit, outcome));
    const vl goes_on = d_lt(d_set(NARC_CAST_UNFINISHED), outcome);
    d_store(out_next, d_select(goes_on & ~(passed | direct), next, d_set(INFINITY)));
    put_step(out, h, outcome, d_select(goes_on, d_select(passed, back, safe), time),
             d_select(passed | direct, d_set((double)NARC_CAST_DIRECT), d_set((double)NARC_CAST_FREE)),
             d_select(passed, rounds - d_set(1), rounds));
}

/* Goes on to where circles touch, where that is later than Newton's step. */
INLINE void go_further(const narc_casts *casts, const struct touch *touch, size_t k, int h,
                       const struct held_arcs arcs[2], const struct outline_part parts[2], const double *next,
                       struct step *out) {
    const size_t slot = k + (size_t)h;
    vd duration;
    const vl found = find_touch(casts, touch, k, h, arcs, parts, &duration);
    const vd ahead = d_of_floats(casts->time + slot) + duration, safe = d_of_floats(out->time + h);
    const vl further = found & d_lt(d_load(next), ahead) & d_le(ahead, d_load(casts->end + slot));
    d_put_floats(out->time + h, d_select(further, round_down(ahead), safe));
    d_put_floats(out->back + h, d_select(further, safe, d_of_floats(out->back + h)));
}

INLINE void advance_lines(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                          vm live, struct step *out) {
    struct held_arcs arcs[2];
    struct outline_part parts[2];
    double next[V_WIDTH];
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        advance_line(casts, touch, k, h, out, next + h);
    const vf radii = v_add(v_load(touch->radius_a), v_load(touch->radius_b)), infinite = v_set(INFINITY);
    float is_free[V_WIDTH];
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        d_put_floats(is_free + h, d_load(next + h));
    if (!vm_any(vm_and(live, vm_and(v_lt(radii, infinite), v_lt(v_load(is_free), infinite)))))
        return;
    for (int side = 0; side < 2; side++) {
        parts[side] = find_part(shapes, &casts->side[side], side, touch);
        load_held(shapes, &parts[side], parts[side].arc, &arcs[side]);
    }
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        go_further(casts, touch, k, h, arcs, parts, next + h, out);
}

/* ------------------------------------------------------------------------------------------------ turning */

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
INLINE void find_ends(const struct held_arcs *arcs, int h, vl forward, spot *out_from, spot *out_to) {
    const spot start = get_spot(arcs->start_x + h, arcs->start_y + h), end = get_spot(arcs->end_x + h, arcs->end_y + h);
    *out_from = (spot){d_select(forward, start.x, end.x), d_select(forward, start.y, end.y)};
    *out_to = (spot){d_select(forward, end.x, start.x), d_select(forward, end.y, start.y)};
}

/* Are axes, which turn in the sense of a sign, on their arcs, and stay there? */
INLINE void compare_axes(struct met *met, const float *sign) {
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const vd of = d_of_floats(sign + h), zero = d_set(0);
        const spot axis = {d_load(met->axis_x + h), d_load(met->axis_y + h)};
        spot from, to;
        find_ends(&met->arcs, h, d_lt(zero, of), &from, &to);
        const vl on = d_lt(d_set(AT_END), of * find_cross(axis, to)) | d_lt(find_dot(axis, to), zero);
        d_put_floats(met->on_arc + h, d_select(on, d_set(1), zero));
    }
}

/* The arcs of the body `which` that hold the axes, which turn at `rate` against it: those that touch, or the next. */
INLINE void find_held(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                      int which, vm live, vf rate, struct met *met) {
    const struct narc_cast_side *const side = &casts->side[which];
    const struct outline_part *const part = &met->part;
    const vm forward = v_lt(v_set(0), rate), turns = vm_and(live, v_lt(v_set(0), v_abs(rate)));
    if (!vm_any(turns))
        return;
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const size_t slot = k + (size_t)h;
        const spot n = get_spot(touch->normal_x + h, touch->normal_y + h), back = {-n.x, -n.y};
        const spot turned = {d_load(side->turned_x + slot), d_load(side->turned_y + slot)};
        const spot axis = turn_back(turned, which == 0 ? n : back);
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
    const spot center = {center_x, center_y}, axis = {d_load(met->axis_x + h), d_load(met->axis_y + h)};
    const vl forward = d_lt(zero, rate), round = find_true(met->part.round, h);
    const vd sign = d_select(forward, d_set(1), d_set(-1)), arm = find_cross(center, axis);
    spot from, to;
    find_ends(&met->arcs, h, forward, &from, &to);
    const spot chord = {to.x - axis.x, to.y - axis.y};
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

/* The gap along an axis after a time s is gap + s (first + s (second + s (third + s fourth))), nearly. */
struct series {
    vd first, second, third, fourth;
};

/* Adds a (cos(rate s) - 1) + b sin(rate s), but for the first term. */
INLINE void add_turn(struct series *series, vd rate, vd a, vd b) {
    const vd square = rate * rate, half = a * square * d_set(0.5), third = b * rate * square * d_set(1.0 / 6);
    series->second -= half;
    series->third -= third;
    series->fourth += half * square * d_set(1.0 / 12);
}

/* For how long from now on the gap, which is `gap` above the target, stays there along the normal as an axis that turns
 * at a rate; `falls` is how fast it falls at most along one at rest. `out_series`: what it does, as long as the arcs
 * stay the same; where these are round, with what the axis would gain if it turned to where the gap is largest. Unless
 * it `tries`, the first term alone. */
INLINE vd follow_axis(const narc_casts *casts, const struct touch *touch, const struct axes *axes, size_t k, int h,
                      vd gap, vd falls, bool tries, struct series *out_series) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), two = d_set(2), infinite = d_set(INFINITY), rate = d_of_floats(axes->rate + h);
    const spot n = get_spot(touch->normal_x + h, touch->normal_y + h),
               motion = {d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)};
    const vd along = find_dot(n, motion), across = find_cross(n, motion);
    const vl turns = d_lt(zero, d_abs(rate));
    struct series series = {along, zero, zero, zero};
    vd bend = zero, duration = infinite, fastest = falls, slide = across;
    if (d_any(turns)) {
        const vd time = d_of_floats(casts->time + slot), left = d_load(casts->end + slot) - time;
        const spot way = {d_load(casts->x + slot) + time * motion.x, d_load(casts->y + slot) + time * motion.y};
        const vd speed = find_length(motion);
        series.first += rate * find_cross(n, way);
        if (tries) {
            add_turn(&series, rate, find_dot(n, way), find_cross(n, way));
            series.second += across * rate;
            series.third -= along * rate * rate * d_set(0.5);
        }
        bend = rate * rate * (find_length(way) + speed * left) + two * d_abs(rate) * speed;
        fastest += d_select(turns, along + speed, zero);
    }
    for (int side = 0; side < 2; side++) {
        const struct narc_cast_side *const of = &casts->side[side];
        const vd its = rate - d_of_floats(of->angle + slot);
        const vl moves = d_lt(zero, d_abs(its));
        if (!d_any(moves))
            continue;
        const struct lever lever = find_arm(&axes->met[side], h, moves, d_of_floats(of->scale + slot), its);
        series.first += d_select(moves, its * lever.arm, zero);
        if (tries) {
            const vd arm = d_select(moves, lever.arm, zero), reach = d_select(moves, lever.reach, zero);
            add_turn(&series, its, -reach, arm);
            slide += its * reach;
        }
        bend -= d_select(moves, its * its * lever.bend, zero);
        duration = d_select(moves, d_min(lever.duration, duration), duration);
    }
    const vd slope = series.first, root = d_sqrt(slope * slope + two * bend * gap);
    if (tries) {
        const vd apart = d_of_floats(touch->radius_a + h) + d_of_floats(touch->radius_b + h) +
                         d_of_floats(touch->separation + h); /* centres of round arcs; of edges: infinite */
        series.second += slide * slide / (two * d_abs(apart));
    }
    *out_series = series;
    const vl down = d_lt(slope, zero);
    const vd way = d_select(down, two * gap, root + slope) / d_select(down, root - slope, bend);
    const vd whole = d_select(down | d_lt(zero, bend), way, infinite);
    const vl on_arc = d_le(whole, duration);
    if (!d_any(~on_arc))
        return whole;
    const vd rest = gap + duration * (slope - bend * duration / two);
    return d_select(on_arc, whole, d_select(d_lt(zero, rest), duration + rest / fastest, duration));
}

/* When a gap that follows a series is down to 0, `left` at most: Newton's steps, of which nothing is promised. */
INLINE vd find_root(vd gap, const struct series *series, vd left) {
    const vd zero = d_set(0);
    vd s = d_min(-gap / series->first, left);
    for (int step = 0; step < 2; step++) {
        const vd high = series->third + s * series->fourth, low = series->second + s * high;
        const vd value = gap + s * (series->first + s * low);
        const vd slope = series->first + s * (low + low + s * (high + s * series->fourth));
        const vd next = d_min(s - value / slope, left);
        s = d_select(d_lt(zero, next), next, zero);
    }
    return s;
}

INLINE void advance_turn(const narc_casts *casts, const struct touch *touch, const struct axes *axes, size_t k, int h,
                         struct step *out) {
    const size_t slot = k + (size_t)h;
    const struct narc_cast_side *const a = &casts->side[0], *const b = &casts->side[1];
    const vd zero = d_set(0), time = d_of_floats(casts->time + slot), end = d_load(casts->end + slot),
             back = d_of_floats(casts->back + slot), rounds = d_of_floats(casts->rounds + slot) + d_set(1),
             enough = d_load(casts->enough + slot);
    const vd gap = d_of_floats(touch->separation + h) - d_set((double)casts->target);
    const vd along = d_of_floats(touch->normal_x + h) * d_load(casts->motion_x + slot) +
                     d_of_floats(touch->normal_y + h) * d_load(casts->motion_y + slot);
    const vd turning = d_load(a->lever + slot) * d_abs(d_of_floats(a->angle + slot)) +
                       d_load(b->lever + slot) * d_abs(d_of_floats(b->angle + slot)),
             falls = turning - along;
    const vl sure = d_lt(along + turning, zero), direct = d_le(back, d_set((double)NARC_CAST_DIRECT));
    const vl passed = d_le(zero, back) & (~sure | d_lt(gap, zero)); /* it may have passed the first root */
    struct series series;
    const vl tries = sure & ~(passed | direct);
    const vd duration = follow_axis(casts, touch, axes, k, h, gap, falls, d_any(tries), &series), least = gap / falls;
    const vd next = time + d_select(d_lt(least, duration), duration, least), safe = round_down(next);
    const vl near = d_le(gap, enough), last = d_le(d_set(MOST_ROUNDS), rounds);
    const vd hit = d_set(NARC_CAST_HIT), miss = d_set(NARC_CAST_MISS), on = d_set(NARC_CAST_GOES_ON);
    vd outcome = d_select(last, d_select(near, hit, d_set(NARC_CAST_UNFINISHED)), on);
    outcome = d_select(d_lt(end, next), miss, d_select(d_le(safe, time), hit, outcome));
    outcome = d_select(d_le(falls, zero), miss, d_select(near & d_le(series.first, zero), hit, outcome));
    outcome = d_select(passed, on, d_select(d_le(gap, zero), hit, outcome));
    const vl goes_on = d_lt(d_set(NARC_CAST_UNFINISHED), outcome);
    const vl may_try = goes_on & tries & d_lt(series.first, zero);
    vd to = d_select(passed, back, safe),
       then_back = d_select(passed | direct, d_set((double)NARC_CAST_DIRECT), d_set((double)NARC_CAST_FREE));
    if (d_any(may_try)) {
        const vd ahead = round_down(time + find_root(gap - d_set(0.5) * enough, &series, end - time));
        const vl try = may_try & d_lt(safe, ahead);
        to = d_select(try, ahead, to);
        then_back = d_select(try, safe, then_back);
    }
    put_step(out, h, outcome, d_select(goes_on, to, time), then_back, rounds);
}

INLINE void advance_turns(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                          vm live, struct step *out) {
    const vf angle_a = v_load(casts->side[0].angle + k), angle_b = v_load(casts->side[1].angle + k), zero = v_set(0);
    struct axes axes;
    for (int side = 0; side < 2; side++)
        axes.met[side].part = find_part(shapes, &casts->side[side], side, touch);
    const vf of_b = v_select(axes.met[1].part.on_edge, angle_b, zero);
    const vf rate = v_select(vm_and(axes.met[0].part.on_edge, v_lt(zero, v_abs(angle_a))), angle_a, of_b);
    v_store(axes.rate, rate);
    for (int side = 0; side < 2; side++)
        find_held(shapes, casts, touch, k, side, live, v_sub(rate, side == 0 ? angle_a : angle_b), &axes.met[side]);
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        advance_turn(casts, touch, &axes, k, h, out);
}

/* ------------------------------------------------------------------------------------------------ all */

/* Of casts 0 .. count - 1: takes the contacts at their times and finds what they mean, and where to look next. Of
 * NARC_CAST_HIT and NARC_CAST_UNFINISHED contact and time are the answer's. */
void NARC_NAMED(advance)(const narc_shapes *shapes, narc_casts *casts, size_t count) {
    for (size_t k = 0; k < count; k += V_WIDTH) {
        const vm live = vm_front(count - k < V_WIDTH ? (int)(count - k) : V_WIDTH);
        const vm turning = v_lt(v_set(0), v_load(casts->turning + k));
        const struct touch touch = load_contacts(casts->contact, k, count);
        struct step lines, turns;
        const bool any_turns = vm_any(vm_and(live, turning));
        const struct step *from = any_turns ? &turns : &lines;
        if (any_turns)
            advance_turns(shapes, casts, &touch, k, vm_and(live, turning), &turns);
        const vm straight = vm_and_not(live, turning);
        if (vm_any(straight))
            advance_lines(shapes, casts, &touch, k, straight, &lines);
        else
            lines = turns;
        vi_store(casts->outcome + k, vi_truncate(v_select(straight, v_load(lines.outcome), v_load(from->outcome))));
        v_store(casts->time + k, v_select(straight, v_load(lines.time), v_load(from->time)));
        v_store(casts->back + k, v_select(straight, v_load(lines.back), v_load(from->back)));
        v_store(casts->rounds + k, v_select(straight, v_load(lines.rounds), v_load(from->rounds)));
    }
}
