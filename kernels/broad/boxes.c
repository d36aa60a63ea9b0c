/* SPDX-License-Identifier: MIT
 *
 * boxes.c - the box kernel: axis-aligned boxes of bodies in the world.
 *
 * A body reaches as far along a direction as its support function says, which for the arc that holds the direction m is
 * height = scale (centre.m + radius). The directions are the world's four axes in the body's frame, each a quarter turn
 * from the one before: (c, -s), (s, c), (-c, s), (-s, -c).
 *
 * Which arcs hold them? The look-up by 16-bit angles cannot tell on which side of a junction a direction lies that is
 * within two units of it. Then both arcs are asked, and the larger height counts. That one is never too small, and
 * hardly too large: the angle t beyond an arc's end is less than 2.5e-4 (near angle 0 four units are merged, which are
 * half as wide), and there its circle exceeds the shape by at most radius (1 - cos t) < 0.6 e radius, e = 2^-24.
 *
 * What rounding can take from centre.m + radius, with |c| = |centre_x| + |centre_y|:
 *
 *   m                  4.5 e |c|            the rotation is within 1.5 e of unit and has three roundings
 *   centre, radius     e |c| + e radius     as stored
 *   two products       e |c|
 *   two sums           2 e |c| + e radius
 *
 * With the roundings behind it (by the scale, of this very room, and of the sum with the margin and the low part of a
 * double position) 12 e (|c| + radius) is enough. Rounding can also add what it can take away, |c| is at most 1.42
 * times the centre's distance from the origin, and add_upwards() adds up to 4 e of its sum, twice if the body moves:
 * all that is below 40 e (NARC_BOX_ROOM).
 */
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/pair_setup.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "piece.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

#define HEIGHT_ROOM (12.0f / 16777216.0f)

enum { AXES = 4 };

/* ------------------------------------------------------------------------------------------------ heights */

/* The arcs that may hold a direction: `more` of them behind the first. */
struct arc_run {
    vi first, more; /* counted from the shape's first arc, the next one after the last is 0 */
};

/* Junctions below the one, and from the other on, are not told from a direction near angle 0. */
enum { FIRST_ANGLE = INT16_MIN + 3, LAST_ANGLE = INT16_MAX - 3 };

/* Counts, in both halves of `before`, half of the junction angles that are below each limit, in both halves as well. */
INLINE void count_angles(const narc_record *records, vi first_record, vi count, const vi limit[2 * AXES],
                         vi before[2 * AXES]) {
    int32_t index[V_WIDTH];
    vi_store(index, first_record);
    for (int k = 0; k < 2 * AXES; k++)
        before[k] = vi_set(0);
    /* Eight angles at a time. Lanes with fewer count nothing: there is no angle below -2^15. They read on behind
     * their own: of any shape four records may be read (NARC_READ_AHEAD). */
    _Static_assert(NARC_MAX_ARCS <= 4 * NARC_RECORD_ANGLES, "of a shape with two arcs four records are read");
    for (int done = 0; done < NARC_MAX_ARCS; done += 8) {
        const vm more = vi_lt(vi_set(done), count);
        if (!vm_any(more))
            break;
        vf angles[4];
        v_rows((const char *)records + (size_t)done * sizeof(int16_t), sizeof *records, index, angles);
        for (int k = 0; k < 2 * AXES; k++) {
            const vi below = done == 0 ? limit[k] : vi_select(more, limit[k], vi_set((int32_t)0x80008000u));
            for (int i = 0; i < 4; i++)
                before[k] = vi_count16(before[k], below, vi_bits(angles[i]));
        }
    }
}

INLINE vi fill_both_halves(vi angle) { return vi_add(vi_and(angle, vi_set(0xffff)), vi_shift_left(angle, 16)); }

INLINE vi add_halves(vi twice) { return vi_add(vi_and(twice, vi_set(0xffff)), vi_shift_right(twice, 16)); }

/* The arcs that may hold the axes: those between the junctions that are surely before a direction and surely behind
 * it. Near angle 0, the junctions that are before it are the last ones. */
INLINE void find_arc_runs(const narc_record *records, vi first_record, vi count, vec2 right, struct arc_run run[AXES]) {
    const vf quarter = find_diamond_angle(right);
    vi limit[2 * AXES], before[2 * AXES];
    vm turn[AXES];
    UNROLL
    for (int k = 0; k < AXES; k++) {
        vf angle = v_add(quarter, v_set((float)k));
        angle = v_select(v_lt(v_set(4), angle), v_sub(angle, v_set(4)), angle);
        const vi unit = vi_truncate(v_sub(v_mul(angle, v_set(NARC_ANGLE_SCALE)), v_set(NARC_ANGLE_OFFSET)));
        turn[k] = vm_or(vi_lt(unit, vi_set(FIRST_ANGLE - 1)), vi_lt(vi_set(LAST_ANGLE), unit));
        const vi low = vi_select(turn[k], vi_set(LAST_ANGLE), vi_sub(unit, vi_set(1)));
        const vi high = vi_select(turn[k], vi_set(FIRST_ANGLE), vi_add(unit, vi_set(2)));
        limit[2 * k] = fill_both_halves(low);
        limit[2 * k + 1] = fill_both_halves(high);
    }
    count_angles(records, first_record, count, limit, before);
    UNROLL
    for (int k = 0; k < AXES; k++) {
        const vi all = add_halves(before[2 * k]), high = add_halves(before[2 * k + 1]);
        const vi low = vi_sub(all, vi_select(turn[k], count, vi_set(0)));
        const vi first = vi_sub(low, vi_set(1));
        run[k] =
            (struct arc_run){vi_add(first, vi_select(vi_lt(first, vi_set(0)), count, vi_set(0))), vi_sub(high, low)};
    }
}

/* centre.m + radius of an arc, with its room for rounding. */
INLINE vf find_arc_support(const narc_record *records, vi record, vec2 m) {
    vf arc[4];
    load_circle(records, record, arc);
    const vf size = v_add(v_add(v_abs(arc[0]), v_abs(arc[1])), arc[2]);
    const vf height = v_add(v_add(v_mul(arc[0], m.x), v_mul(arc[1], m.y)), arc[2]);
    return v_add(height, v_mul(size, v_set(HEIGHT_ROOM)));
}

/* The largest height of the arcs that may hold m. There is mostly one. */
INLINE vf find_support_value(const narc_record *records, vi arcs, vi count, struct arc_run run, vec2 m) {
    vf height = find_arc_support(records, vi_add(arcs, run.first), m);
    vi arc = run.first;
    for (int k = 1; k < NARC_MAX_ARCS; k++) {
        const vm more = vi_lt(vi_set(k - 1), run.more);
        if (!vm_any(more))
            break;
        const vi next = vi_add(arc, vi_select(more, vi_set(1), vi_set(0)));
        arc = vi_select(vi_lt(next, count), next, vi_set(0));
        height = v_max(height, find_arc_support(records, vi_add(arcs, arc), m));
    }
    return height;
}

/* ------------------------------------------------------------------------------------------------ boxes */

/* a + b, and by one or two units in the last place more. */
INLINE vf add_upwards(vf a, vf b) {
    const vf sum = v_add(a, b);
    return v_add(sum, v_mul(v_abs(sum), v_set(0x1p-23f)));
}

/* Boxes of some bodies, as four columns: what they reach to the left and below counts to the left and below. */
struct reaches {
    vf right, up, left, down;
};

/* Adds what bodies move along an axis to the side that they move to. */
INLINE void add_motion(vf *forward, vf *backward, vf motion) {
    *forward = v_select(v_lt(v_set(0), motion), add_upwards(*forward, motion), *forward);
    *backward = v_select(v_lt(motion, v_set(0)), add_upwards(*backward, v_neg(motion)), *backward);
}

INLINE vm is_finite(vf a) { return v_le(v_abs(a), v_set(FLT_MAX)); }

/* Puts the heights of pieces of chains, with the same room, in place of those of their closed shapes. */
NOINLINE void put_piece_heights(const narc_shapes *shapes, const int32_t shape[V_WIDTH], const vec2 axis[AXES],
                                vf scale, vf margin, vf height[AXES]) {
    for (int k = 0; k < AXES; k++) {
        float x[V_WIDTH], y[V_WIDTH], support[V_WIDTH], is_piece[V_WIDTH];
        v_store(x, axis[k].x);
        v_store(y, axis[k].y);
        for (int l = 0; l < V_WIDTH; l++) {
            const narc_shape_header *header = &shapes->headers[shape[l]];
            double size = 0;
            is_piece[l] = narc_is_piece(header) ? 1 : 0;
            support[l] = 0;
            if (is_piece[l] > 0) {
                const narc_record *arcs = narc_arcs_of(shapes, header);
                support[l] = (float)(narc_find_front_height(header, arcs, (double)x[l], (double)y[l],
                                                            narc_find_front_depth(header, arcs), &size) +
                                     (double)HEIGHT_ROOM * size);
            }
        }
        const vf own = v_add(v_mul(v_load(support), scale), margin);
        height[k] = v_select(v_lt(v_set(0), v_load(is_piece)), own, height[k]);
    }
}

/* Half-planes have no end but along the boundary's normal (-sine, cosine), where that is an axis. */
NOINLINE void open_planes(vi info, vec2 rotation, struct reaches *r) {
    const vf c = rotation.x, s = rotation.y, zero = v_set(0);
    const vf along[AXES] = {v_neg(s), c, s, v_neg(c)}, across[AXES] = {c, s, c, s};
    vf *const side[AXES] = {&r->right, &r->up, &r->left, &r->down};
    for (int k = 0; k < AXES; k++) {
        const vm bounded = vm_and(v_le(v_abs(across[k]), zero), v_lt(zero, along[k]));
        *side[k] = v_select(vm_and_not(is_plane(info), bounded), v_set(FLT_MAX), *side[k]);
    }
}

INLINE struct reaches find_reaches(const narc_shapes *shapes, const int32_t shape[V_WIDTH],
                                   const struct headers *headers, const struct placed_bodies *bodies, vec2 rotation,
                                   vf margin) {
    const vec2 right = {rotation.x, v_neg(rotation.y)}, up = {rotation.y, rotation.x};
    const vec2 axis[AXES] = {right, up, {v_neg(right.x), v_neg(right.y)}, {v_neg(up.x), v_neg(up.y)}};
    const vi count = get_arc_count(headers->info), arcs = find_first_arc(headers->first_record, headers->info);
    struct arc_run run[AXES];
    vf height[AXES];
    find_arc_runs(shapes->records, headers->first_record, count, right, run);
    UNROLL
    for (int k = 0; k < AXES; k++)
        height[k] =
            v_add(v_mul(find_support_value(shapes->records, arcs, count, run[k], axis[k]), bodies->scale), margin);
    if (NARC_PIECES &&
        vm_any(has_mark(headers->info, NARC_PIECE_MARKS))) { /* copies, so that the others stay in registers */
        const vec2 axes[AXES] = {axis[0], axis[1], axis[2], axis[3]};
        vf heights[AXES] = {height[0], height[1], height[2], height[3]};
        put_piece_heights(shapes, shape, axes, bodies->scale, margin, heights);
        UNROLL
        for (int k = 0; k < AXES; k++)
            height[k] = heights[k];
    }
    const vec2 at = bodies->position, rest = bodies->rest;
    return (struct reaches){add_upwards(at.x, v_add(rest.x, height[0])), add_upwards(at.y, v_add(rest.y, height[1])),
                            add_upwards(v_neg(at.x), v_sub(height[2], rest.x)),
                            add_upwards(v_neg(at.y), v_sub(height[3], rest.y))};
}

/* The boxes of bodies list[0 .. count - 1], or first .. first + count - 1 without a list, to their places in `out`;
 * returns how many have none. */
size_t NARC_NAMED(box)(const narc_box_batch *batch, const uint32_t *list, size_t first, size_t count, narc_box *out) {
    const narc_bodies *const bodies = batch->bodies;
    const enum pose_layout layout = find_pose_layout(bodies);
    /* Room for the sum with a height, and for underflow: less than any rounding of NARC_MIN_SIZE. */
    const vf margin = v_set(batch->margin * (1 + 0x1p-22f) + 0x1p-80f), none = v_set(INFINITY);
    size_t skipped = 0;
    for (size_t k = 0; k < count; k += V_WIDTH) {
        /* The lanes behind the last body repeat the vector's first. */
        const int lanes = count - k < V_WIDTH ? (int)(count - k) : V_WIDTH;
        int32_t body[V_WIDTH], shape[V_WIDTH];
        char *to[V_WIDTH];
        for (int l = 0; l < V_WIDTH; l++) {
            const size_t place = k + (size_t)(l < lanes ? l : 0), own = list ? list[place] : first + place;
            body[l] = (int32_t)(uint32_t)own;
            shape[l] = (int32_t)narc_index_at(bodies->shape, own);
            to[l] = (char *)(out + own);
        }
        const struct headers headers = load_headers(batch->shapes->headers, shape);
        const struct placed_bodies placed = load_placed_bodies(bodies, layout, batch->origin, body);
        vm valid;
        const vec2 rotation = normalise_rotation(placed.rotation, &valid);
        struct reaches r = find_reaches(batch->shapes, shape, &headers, &placed, rotation, margin);
        valid = vm_and(valid, is_size_in_range(v_mul(placed.scale, headers.bound_radius)));
        if (batch->motion_x.base) {
            const vf motion = load_column(batch->motion_x, body);
            add_motion(&r.right, &r.left, motion);
            valid = vm_and(valid, is_finite(motion));
        }
        if (batch->motion_y.base) {
            const vf motion = load_column(batch->motion_y, body);
            add_motion(&r.up, &r.down, motion);
            valid = vm_and(valid, is_finite(motion));
        }
        valid = vm_and(
            valid, vm_and(vm_and(is_finite(r.right), is_finite(r.up)), vm_and(is_finite(r.left), is_finite(r.down))));
        if (NARC_PIECES && !LIKELY(batch->shapes->plane_count == 0)) {
            struct reaches opened = r;
            open_planes(headers.info, placed.rotation, &opened);
            r = opened;
        }
        const vf sides[4] = {v_select(valid, v_neg(r.left), none), v_select(valid, v_neg(r.down), none),
                             v_select(valid, r.right, v_neg(none)), v_select(valid, r.up, v_neg(none))};
        v_put_rows(to, 0, sides);
        skipped += (size_t)COUNT_BITS(vm_bits(vm_and_not(vm_front(lanes), valid)));
    }
    return skipped;
}
