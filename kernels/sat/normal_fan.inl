/* SPDX-License-Identifier: MIT
 *
 * normal_fan.inl - the deciding formula: the largest gap over all directions, exactly, for one pair in each lane.
 *
 * For a direction n (A to B) held by arc i of A, and -n by arc j of B, the gap between the support lines is
 *     g(n) = u.n - (r_i + r_j),   u = b_j - a_i.
 * Lay the junction normals of A and the negated ones of B over each other: they cut the circle of directions into m + n
 * intervals, each with one pair (i, j), walked once in the order of their angle (rotating calipers). The derivative of
 * g by the angle of n is n x u: where it turns from rising to falling, g has a local maximum. Within an interval from
 * lo to hi that is so if it rises at lo, lo x u >= 0, and falls at hi, u x hi >= 0: then u lies between them, and g is
 * largest along u, with the value |u| - (r_i + r_j). At the junction between two intervals it is so if g rises at the
 * end of the one and falls at the start of the next, each with its own u: a kink, which an edge makes; the value is u.n
 * - (r_i + r_j). The largest of all these values is the separation of the bodies.
 *
 * Edges cost nothing extra, hence one path for all shapes; for those without edges the test at junctions closes the
 * seams, where rounding puts u just outside both intervals. As every sign is used for what lies on either side of it,
 * no change from rising to falling can be lost, unless a sign is wrong. It can be where n x u is 0 up to rounding,
 * that is near a minimum or a maximum; this can make g seem to fall, or rise, all the way past a minimum and a
 * maximum next to it. If the two are close, so are their values. They are far apart only in an interval of nearly
 * half a turn with u near one of its ends: so in an interval wider than a right angle, it is enough that u points
 * less than a right angle into it from either end. Last, g may seem to rise or fall all around; then it is constant
 * up to rounding (two circles in one place), and its value at the first junction serves.
 *
 * In an interval that is empty up to rounding, u opposite to lo passes both tests, so in one up to a right angle u must
 * also have u.lo + u.hi > 0. Where it does not, or is too short to tell, the value at lo is taken: no value of g can do
 * harm.
 *
 * Error, in units of e = 2^-24, with D the distance between the positions, a and b the centres of two arcs and r their
 * radii, scaled; each line bounds what one step adds to g (docs/algorithm.md derives the numbers):
 *                                                                        D      |a|     |b|      r
 *     centres and radii in single precision                                      1       1       1
 *     the rotations' rounding, and what is left of their length         4                8
 *     rounding and rotating the difference of positions                 3.42
 *     the relative rotation, and the rotation of a centre                                4.24
 *     scaling                                                                    1       1       1
 *     the difference of centres                                         2        1       2
 *     norm or dot product                                               2        2       2
 *     a junction normal at a kink, its direction and its length        12.35    12.35   12.35
 *     the sum of radii and the last subtraction                         1        1       1       2
 * Together at most 24.8 D + 18.4 |a| + 31.6 |b| + 4 r. With the extents E, the largest |centre| + radius,
 * NARC_ERROR_BOUND covers it: 32 (D + E_a + E_b).
 *
 * The angle that orders the junctions is the diamond angle, monotonic in the true one: 0 along +x, 1 along +y, at most
 * 4. It may swap junctions that agree up to rounding, which the line on junction normals covers. Junctions of one
 * shape never swap: their normals differ by more than NARC_TOLERANCE.
 */
#ifndef NARC_SAT_NORMAL_FAN_INL
#define NARC_SAT_NORMAL_FAN_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* The arc of B whose start, negated and in A's frame, is the first junction counter-clockwise from +x: the one with the
 * smallest angle, because all others have larger angles than the arcs before them. */
INLINE vi find_first_of_b(const narc_record *records, struct ring ring, const struct pose *pose) {
    vi record = ring.base, first = record;
    vf least = v_set(INFINITY);
    for (int i = 0; vm_any(vi_lt(vi_set(i), ring.count)); i++, record = vi_add(record, vi_set(1))) {
        const vm exists = vi_lt(vi_set(i), ring.count);
        int32_t index[V_WIDTH];
        vf ends[4];
        vi_store(index, vi_select(exists, record, ring.base));
        v_rows(&records->arc.start_x, sizeof *records, index, ends);
        const vf angle = find_diamond_angle(v2_rotate_opposite(pose->rotation, (vec2){ends[0], ends[1]}));
        const vm earlier = vm_and(exists, v_lt(angle, least));
        least = v_select(earlier, angle, least);
        first = vi_select(earlier, record, first);
    }
    return first;
}

/* The walk around the fan. Angles of at least 0 have the order of their bits, as integers. Those of this round, 0 to 4,
 * are moved down by THIS_ROUND so that all of the next round follow them; exactly, so that the last interval ends where
 * the first one began. */
struct fan {
    struct ring ring_a, ring_b;
    vi record_a, record_b;
    struct arc_pair arcs;
    vi angle_a, angle_b; /* of the junctions ahead, where these arcs end */
    vm a_is_next;        /* is A's junction ahead the nearer one? */
};

#define THIS_ROUND (-0x40800001) /* minus the bits of 4.0f, and one more */

/* The junction ahead. */
INLINE vec2 get_fan_end(const struct fan *fan) { return v2_select(fan->a_is_next, fan->arcs.a.end, fan->arcs.b.end); }

/* Starts before the first junction counter-clockwise from +x. */
INLINE struct fan start_fan(const narc_record *records, const struct queue *queue, int k, const struct pose *pose) {
    struct fan fan = {.ring_a = get_ring_a(queue, k), .ring_b = get_ring_b(queue, k)};
    const vi back = vi_set(-1), this_round = vi_set(THIS_ROUND);
    fan.record_a = step_record(fan.ring_a, fan.ring_a.base, back);
    fan.record_b = step_record(fan.ring_b, find_first_of_b(records, fan.ring_b, pose), back);
    fan.arcs = load_arc_pair(records, fan.record_a, fan.record_b, pose);
    fan.angle_a = vi_add(vi_bits(find_diamond_angle(fan.arcs.a.end)), this_round);
    fan.angle_b = vi_add(vi_bits(find_diamond_angle(fan.arcs.b.end)), this_round);
    fan.a_is_next = vi_lt(fan.angle_a, fan.angle_b);
    return fan;
}

/* Passes the junction ahead: the arc that starts there takes over. The junction ahead of it on that shape belongs to
 * the next round where the list begins anew. */
SHARED void pass_junction(struct fan *fan, const narc_record *records, const struct pose *pose) {
    const vm is_a = fan->a_is_next;
    const vi one = vi_set(1);
    const vi passed =
        vi_select(is_a, step_record(fan->ring_a, fan->record_a, one), step_record(fan->ring_b, fan->record_b, one));
    vf field[8];
    load_records(records, passed, field);
    const struct arcs new_a = place_a(field, pose), new_b = place_b(field, pose);
    fan->arcs.a = select_arcs(is_a, &new_a, &fan->arcs.a);
    fan->arcs.b = select_arcs(is_a, &fan->arcs.b, &new_b);
    fan->record_a = vi_select(is_a, passed, fan->record_a);
    fan->record_b = vi_select(is_a, fan->record_b, passed);
    const vi next_round = vi_bits(find_diamond_angle(get_fan_end(fan))), angle = vi_add(next_round, vi_set(THIS_ROUND));
    const vm wraps = vi_lt(angle, vi_select(is_a, fan->angle_a, fan->angle_b));
    const vi later = vi_select(wraps, next_round, angle);
    fan->angle_a = vi_select(is_a, later, fan->angle_a);
    fan->angle_b = vi_select(is_a, fan->angle_b, later);
    fan->a_is_next = vi_lt(fan->angle_a, fan->angle_b);
}

/* An interval's candidate: its value, along u if that lies `inside`, else at lo. */
struct candidate {
    vm exists, inside;
    vf value, length, at_lo; /* |u|, and the value at lo */
    vec2 u;
    vm rises; /* does g rise at hi? */
};

/* The largest g at lo or between lo and hi, if there is a local maximum; `rises`: towards lo, before it. */
INLINE struct candidate find_candidate(const struct arc_pair *arcs, vec2 lo, vec2 hi, vm rises) {
    const vf zero = v_set(0), radii = v_add(arcs->a.radius, arcs->b.radius);
    const vec2 u = find_center_difference(arcs);
    const vf square = v2_dot(u, u), length = v_sqrt(square);
    const vf after_lo = v2_cross(lo, u), before_hi = v2_cross(u, hi), along_lo = v2_dot(u, lo),
             along_hi = v2_dot(u, hi);
    const vm rises_at_lo = v_le(zero, after_lo), falls_at_hi = v_le(zero, before_hi);
    const vm wide = v_lt(v2_dot(lo, hi), zero);
    const vm near_lo = vm_and(rises_at_lo, v_lt(zero, along_lo)), near_hi = vm_and(falls_at_hi, v_lt(zero, along_hi));
    const vm between = vm_or(vm_and(rises_at_lo, falls_at_hi), vm_and(wide, vm_or(near_lo, near_hi)));
    const vm kink = vm_and(rises, v_lt(after_lo, zero));
    const vm forward = vm_or(wide, v_lt(zero, v_add(along_lo, along_hi)));
    struct candidate found;
    found.exists = vm_or(between, kink);
    found.inside = vm_and(between, vm_and(forward, v_le(v_set(LEAST_SQUARE), square)));
    found.value = v_sub(v_select(found.inside, length, along_lo), radii);
    found.length = length;
    found.at_lo = v_sub(along_lo, radii);
    found.u = u;
    found.rises = v_lt(before_hi, zero);
    return found;
}

/* The separation of the pairs k ... of a queue, of those lanes for which `live` holds (elsewhere +infinity). Without
 * `contact` only the separation is set, and the walk ends as soon as every lane is known not to collide: then it is
 * some value >= 0. */
static inline struct gap find_gap(const narc_shapes *shapes, const struct queue *queue, int k, vm live, bool contact) {
    const struct pose pose = get_pose(queue, k);
    struct fan fan = start_fan(shapes->records, queue, k, &pose);
    const vi steps = vi_add(fan.ring_a.count, fan.ring_b.count);
    struct gap best = {
        v_select(live, v_set(-INFINITY), v_set(INFINITY)), {v_set(0), v_set(0)}, v_set(1), fan.record_a, fan.record_b};
    vec2 lo = get_fan_end(&fan);
    vm rises = v_lt(v2_cross(find_center_difference(&fan.arcs), lo), v_set(0));
    vf fallback = v_set(0); /* the value at the first junction */
    for (int step = 0;; step++) {
        vm active = vm_and(live, vi_lt(vi_set(step), steps));
        if (!contact)
            active = vm_and(active, v_lt(best.separation, v_set(0)));
        if (!vm_any(active))
            break;
        pass_junction(&fan, shapes->records, &pose);
        const vec2 hi = get_fan_end(&fan);
        const struct candidate found = find_candidate(&fan.arcs, lo, hi, rises);
        if (step == 0) {
            fallback = found.at_lo;
            best = (struct gap){best.separation, lo, best.length, fan.record_a, fan.record_b};
        }
        const vm better = vm_and(vm_and(active, found.exists), v_lt(best.separation, found.value));
        const struct gap gap = {found.value, v2_select(found.inside, found.u, lo),
                                v_select(found.inside, found.length, v_set(1)), fan.record_a, fan.record_b};
        if (contact)
            best = select_gap(better, &gap, &best);
        else
            best.separation = v_select(better, gap.separation, best.separation);
        rises = found.rises;
        lo = hi;
    }
    const vm none = v_lt(best.separation, v_set(-FLT_MAX));
    best.separation = v_select(none, fallback, best.separation);
    return best;
}

#endif
