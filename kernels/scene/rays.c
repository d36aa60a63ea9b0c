/* SPDX-License-Identifier: MIT
 *
 * rays.c - the kernel of rays: from the root of the index down to the bodies whose boxes a ray meets, nearest first.
 *
 * The lanes are a node's eight slots. A slot's box is met from `near` to `far` along the ray, which are computed in
 * single precision with room, so that nothing is lost that ray_entry.inl would find; then it makes no difference which
 * boxes are met besides, in which order, and how large they are. Rays that start outside of all boxes are moved to where they meet them
 * first: so the room is in proportion to the scene. A near, a far err by three roundings in proportion, and by the
 * rounding of the start, up to 2^-24 of it.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "column.h"
#include "index.h"
#include "kernels.h"
#include "scene/part_walk.inl"
#include "scene/ray_entry.inl"
#include "scene/ray_lanes.inl"
#include "scene/things.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Relative to all that near and far are computed from, eight times their error. */
#define ROOM 0x1p-20f

/* 1 / a direction's component that is less than the inverse counts as this: within the scene the ray moves by less than
 * its room along that axis. */
#define LARGEST_INVERSE 0x1p60f

/* A ray's way along an axis past boxes: the planes that it meets first and last of a node's, as offsets in floats, and
 * the start, moved apart by the room. */
struct axis {
    size_t first, last;
    float first_start, last_start, inverse;
};

#define PLANE(name) (offsetof(narc_index_node, name) / sizeof(float))

/* Where a walk is: of each level its node, counted within it, and how far away the slots are. All that is left to visit is
 * a bit, eight for each level, of slot ^ flips: the lowest is the next. */
struct descent {
    uint64_t left, above;
    unsigned levels;
    uint32_t node[NARC_INDEX_LEVELS];
    unsigned flips[NARC_INDEX_LEVELS];
    float near[NARC_INDEX_LEVELS][NARC_NODE_SLOTS > V_WIDTH ? NARC_NODE_SLOTS : V_WIDTH];
};

/* A ray, and what is known of its hits. */
struct walk {
    struct ray ray;
    struct axis x, y;
    unsigned left, aslant; /* see narc_find_flips() */
    double base;           /* where along the ray nears are counted from */
    float room;            /* of a distance */
    float limit;           /* no body whose near is above is wanted */
    float limit_fraction;
    struct chosen chosen;
    size_t found;
    narc_ray_hit *rows;
};

/* ------------------------------------------------------------------------------------------------ a ray begins */

static float clip_to_float(double a) { return (float)find_most(-(double)FLT_MAX, find_least((double)FLT_MAX, a)); }

/* Nothing further than a fraction of the ray's motion is wanted; what is as far still is, also up to rounding of fractions
 * that underflow. */
INLINE void set_limit(struct walk *w, float fraction) {
    const double distance = ((double)fraction * (1 + 0x1p-22) + 0x1p-149) * w->ray.length - w->base;
    w->limit_fraction = fraction;
    w->limit = clip_to_float(distance + fabs(distance) * (double)ROOM + (double)w->room);
}

/* Rays that are read together, in double lanes. Vectors may read on behind them. */
enum { READ = 128, READ_ROOM = READ + V_WIDTH };

struct read_axis {
    float first_start[READ], last_start[READ], inverse[READ_ROOM];
};

struct read_rays {
    size_t count;
    uint32_t number[READ];
    double origin_x[READ], origin_y[READ], direction_x[READ_ROOM], direction_y[READ_ROOM];
    double length[READ_ROOM]; /* 0: it has no answer */
    double inverse_length[READ_ROOM];
    double base[READ]; /* where it meets the scene; -1: it never does */
    float fraction[READ], room[READ], limit[READ_ROOM];
    struct read_axis x, y;
};

INLINE vd d_most(vd a, vd b) { return d_select(d_lt(b, a), a, b); }
/* A single ray, which was just written, is not read in a vector: that would wait. */
INLINE vd get_lanes(const double *p, bool single) { return single ? d_set(*p) : d_load(p); }

INLINE vd clip(vd a, double limit) { return d_most(d_set(-limit), d_min(d_set(limit), a)); }

/* A ray meets a body that it passes by TOUCH, and what rounding adds, perhaps beside its box. For each unit of the
 * extent's ratio to the bounding radius, which is less than 1.42 times the scene's largest coordinate. */
#define TOUCH_ROOM 0x1p-19

/* As set_limit() has it. */
INLINE vd find_limit(vd fraction, vd length, vd base, vd room) {
    const vd distance = (fraction * d_set(1 + 0x1p-22) + d_set(0x1p-149)) * length - base;
    return clip(distance + d_abs(distance) * d_set((double)ROOM) + room, (double)FLT_MAX);
}

/* Cuts from .. to down to where a line lies between two sides. NaN on a side that it lies in. */
INLINE void cut_stretch(vd low, vd high, vd origin, vd inverse, vd *from, vd *to) {
    const vl backwards = d_lt(inverse, d_set(0));
    const vd a = (low - origin) * inverse, b = (high - origin) * inverse;
    *from = d_most(d_select(backwards, b, a), *from);
    *to = d_min(d_select(backwards, a, b), *to);
}

INLINE void put_axis(vd start, vd room, vd inverse, size_t k, struct read_axis *out) {
    const vl backwards = d_lt(inverse, d_set(0));
    const vd low = start - room, high = start + room;
    d_put_floats(out->first_start + k, clip(d_select(backwards, low, high), (double)FLT_MAX));
    d_put_floats(out->last_start + k, clip(d_select(backwards, high, low), (double)FLT_MAX));
    d_put_floats(out->inverse + k, clip(inverse, (double)LARGEST_INVERSE));
}

/* Columns of the rays `number`, the first one again behind the last. */
INLINE void read_floats(const narc_float_column *column, const uint32_t *number, size_t end, double *out) {
    for (size_t k = 0; k < end; k++)
        out[k] = (double)narc_float_at(*column, number[k]);
}

INLINE void read_positions(const narc_position_column *column, const uint32_t *number, size_t end, double *out) {
    if (column->precision == NARC_FLOAT64)
        for (size_t k = 0; k < end; k++)
            out[k] = narc_double_at(*column, number[k]);
    else
        for (size_t k = 0; k < end; k++)
            out[k] = (double)narc_single_at(*column, number[k]);
}

/* Rays first .. first + count - 1 in their order, at most READ, set out from where they meet the scene, with room. */
static void read_rays(const narc_ray_batch *batch, const narc_box *scene, size_t first, size_t count,
                      struct read_rays *out) {
    const narc_rays *const rays = batch->rays;
    const vd min_x = d_set((double)scene->min_x), min_y = d_set((double)scene->min_y);
    const vd max_x = d_set((double)scene->max_x), max_y = d_set((double)scene->max_y);
    const double size = find_most(find_most(-(double)scene->min_x, (double)scene->max_x),
                                  find_most(-(double)scene->min_y, (double)scene->max_y));
    const double least_touch = size * ((double)ROOM + (double)batch->shapes->largest_ratio * TOUCH_ROOM);
    const bool single = count == 1;
    const size_t end = (count + D_WIDTH - 1) / D_WIDTH * D_WIDTH, given = single ? 1 : end;
    const uint32_t *const order = batch->options->out_order;
    out->count = count;
    for (size_t k = 0; k < given; k++) {
        const size_t i = first + (k < count ? k : 0);
        out->number[k] = order ? order[i] : (uint32_t)i;
    }
    read_positions(&rays->x, out->number, given, out->origin_x);
    read_positions(&rays->y, out->number, given, out->origin_y);
    read_floats(&rays->motion_x, out->number, given, out->direction_x);
    read_floats(&rays->motion_y, out->number, given, out->direction_y);
    for (size_t k = 0; k < given; k++)
        out->fraction[k] = narc_float_or(rays->fraction, out->number[k], 1);
    for (size_t k = 0; k < end; k += D_WIDTH) {
        const vd zero = d_set(0), one = d_set(1), largest = d_set(DBL_MAX);
        const vd x = get_lanes(out->origin_x + k, single) - d_set(batch->index->origin.x);
        const vd y = get_lanes(out->origin_y + k, single) - d_set(batch->index->origin.y);
        const vd motion_x = get_lanes(out->direction_x + k, single), motion_y = get_lanes(out->direction_y + k, single);
        const vd length = d_sqrt(motion_x * motion_x + motion_y * motion_y), inverse_length = one / length;
        const vl is_finite = d_le(d_abs(x), largest) & d_le(d_abs(y), largest) & d_le(length, largest);
        const vd fraction = single ? d_set((double)*out->fraction) : d_of_floats(out->fraction + k);
        const vl has_answer = is_finite & d_lt(zero, length) & d_le(zero, fraction);
        const vd direction_x = motion_x * inverse_length, direction_y = motion_y * inverse_length;
        const vd inverse_x = one / direction_x, inverse_y = one / direction_y;
        const vd touch = d_set(least_touch) + (d_abs(x) + d_abs(y)) * d_set(0x1p-48);
        vd from = zero, to = d_set((double)INFINITY);
        cut_stretch(min_x - touch, max_x + touch, x, inverse_x, &from, &to);
        cut_stretch(min_y - touch, max_y + touch, y, inverse_y, &from, &to);
        const vd base = d_min(from, largest);
        const vd start_x = x + base * direction_x, start_y = y + base * direction_y;
        const vd room = (d_abs(start_x) + d_abs(start_y)) * d_set((double)ROOM) + touch;
        d_store(out->direction_x + k, direction_x);
        d_store(out->direction_y + k, direction_y);
        d_store(out->length + k, d_select(has_answer, length, zero));
        d_store(out->inverse_length + k, inverse_length);
        d_store(out->base + k, d_select(d_le(zero, to), base, -one));
        d_put_floats(out->room + k, clip(room, (double)FLT_MAX));
        d_put_floats(out->limit + k, find_limit(fraction, length, base, room));
        put_axis(start_x, room, inverse_x, k, &out->x);
        put_axis(start_y, room, inverse_y, k, &out->y);
    }
    if (NARC_SHORTCUTS && V_WIDTH > 1 && !single) {
        double *const columns[] = {out->direction_x, out->direction_y, out->length, out->inverse_length};
        for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
            memset(columns[k] + end, 0, V_WIDTH * sizeof *columns[k]);
        float *const others[] = {out->limit, out->x.inverse, out->y.inverse};
        for (size_t k = 0; k < sizeof others / sizeof *others; k++)
            memset(others[k] + end, 0, V_WIDTH * sizeof *others[k]);
    }
}

/* Planes of greatest coordinates lie so many floats behind those of the least. */
enum { PLANES_APART = PLANE(max_x) - PLANE(min_x) };

INLINE struct axis get_axis(const struct read_axis *axis, size_t k, bool backwards, size_t min) {
    const size_t first = min + PLANES_APART * backwards;
    return (struct axis){first, 2 * min + PLANES_APART - first, axis->first_start[k], axis->last_start[k],
                         axis->inverse[k]};
}

/* The rows of the k-th of them. */
INLINE narc_ray_hit *get_rows(const narc_ray_batch *batch, const struct read_rays *rays, size_t k) {
    return batch->out + (size_t)rays->number[k] * batch->most;
}

/* The k-th of them; its rows are empty. */
INLINE void begin_walk(const narc_ray_batch *batch, const struct read_rays *rays, size_t k, struct walk *w) {
    w->ray = (struct ray){{rays->origin_x[k], rays->origin_y[k]},
                          {rays->direction_x[k], rays->direction_y[k]},
                          rays->length[k],
                          rays->inverse_length[k]};
    const bool left = rays->x.inverse[k] < 0, down = rays->y.inverse[k] < 0;
    w->x = get_axis(&rays->x, k, left, PLANE(min_x));
    w->y = get_axis(&rays->y, k, down, PLANE(min_y));
    w->left = left ? 7 : 0;
    w->aslant = left != down ? 7 : 0;
    w->base = rays->base[k];
    w->room = rays->room[k];
    w->chosen = read_chosen(&batch->options->search, rays->number[k]);
    w->found = 0;
    w->rows = get_rows(batch, rays, k);
    w->limit = rays->limit[k];
    w->limit_fraction = rays->fraction[k];
}

/* ------------------------------------------------------------------------------------------------ a node */

/* A bit for each slot that the ray meets, and where. */
INLINE uint32_t find_slots(const struct walk *w, const narc_index_node *node, float *out_near) {
    const float *const planes = (const float *)node;
    const vf inverse_x = v_set(w->x.inverse), inverse_y = v_set(w->y.inverse), limit = v_set(w->limit);
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf near_x = v_mul(v_sub(v_load(planes + w->x.first + k), v_set(w->x.first_start)), inverse_x);
        const vf near_y = v_mul(v_sub(v_load(planes + w->y.first + k), v_set(w->y.first_start)), inverse_y);
        const vf far_x = v_mul(v_sub(v_load(planes + w->x.last + k), v_set(w->x.last_start)), inverse_x);
        const vf far_y = v_mul(v_sub(v_load(planes + w->y.last + k), v_set(w->y.last_start)), inverse_y);
        const vf near = v_max(v_max(near_x, near_y), v_set(0));
        const vf far = v_mul(v_min(far_x, far_y), v_set(1 + ROOM));
        v_store(out_near + k, near);
        slots |= vm_bits(vm_and(v_le(near, far), v_le(near, limit))) << k;
    }
    return slots & ((1u << NARC_NODE_SLOTS) - 1);
}

/* Of each set of slots and each flips: bit k becomes bit k ^ flips. Sets of more slots are those of fewer, without a slot
 * and with it. */
#define FLIP(k, f)       | 1 << ((k) ^ (f))
#define SETS_2(set, f)   set, set FLIP(0, f)
#define SETS_4(set, f)   SETS_2(set, f), SETS_2(set FLIP(1, f), f)
#define SETS_8(set, f)   SETS_4(set, f), SETS_4(set FLIP(2, f), f)
#define SETS_16(set, f)  SETS_8(set, f), SETS_8(set FLIP(3, f), f)
#define SETS_32(set, f)  SETS_16(set, f), SETS_16(set FLIP(4, f), f)
#define SETS_64(set, f)  SETS_32(set, f), SETS_32(set FLIP(5, f), f)
#define SETS_128(set, f) SETS_64(set, f), SETS_64(set FLIP(6, f), f)
#define ALL_SETS(f)                                                                                                    \
    { SETS_128(0, f), SETS_128(0 FLIP(7, f), f) }
static const uint8_t flipped[8][256] = {ALL_SETS(0), ALL_SETS(1), ALL_SETS(2), ALL_SETS(3),
                                        ALL_SETS(4), ALL_SETS(5), ALL_SETS(6), ALL_SETS(7)};

INLINE bool is_before(const narc_ray_hit *a, const narc_ray_hit *b) {
    return a->fraction < b->fraction || (a->fraction == b->fraction && a->body < b->body);
}

/* Puts a hit among a ray's rows, if it is one of the first. */
INLINE void keep_hit(struct walk *w, size_t most, const narc_ray_hit *hit) {
    size_t k = w->found;
    if (k == most && !is_before(hit, &w->rows[most - 1]))
        return;
    for (k = k == most ? most - 1 : k; k > 0 && is_before(hit, &w->rows[k - 1]); k--)
        w->rows[k] = w->rows[k - 1];
    w->rows[k] = *hit;
    w->found += w->found < most;
    if (w->found == most)
        set_limit(w, w->rows[most - 1].fraction);
}

/* ------------------------------------------------------------------------------------------------ things */

/* Does the ray start within a part of the thing? */
NOINLINE bool starts_in(const narc_ray_batch *batch, const struct walk *w, uint32_t owner) {
    struct part_walk parts = begin_part_walk(batch->index, &w->chosen, owner, w->ray.origin, 4 * (double)w->room);
    struct body_frame frame;
    struct meeting met;
    uint32_t body;
    while (find_next_part(&parts, batch->shapes, batch->bodies, &body, &frame))
        if (find_meeting(&frame, &w->ray, NARC_INSIDE_STOPS, false, &met) && met.is_within)
            return true;
    return false;
}

/* Where the ray leaves a thing, from where it leaves a part that it starts in (`out`, at this distance): from part to part, as
 * long as one that holds the place, or lies within a seam of it, goes on further. False if that is too far. */
NOINLINE bool leave_thing(const narc_ray_batch *batch, const struct walk *w, uint32_t owner, double distance,
                          narc_ray_hit *out) {
    const struct ray *const ray = &w->ray;
    for (double at = -1; at < distance;) {
        at = distance;
        const place from = {ray->origin.x + at * ray->direction.x, ray->origin.y + at * ray->direction.y};
        struct part_walk parts = begin_part_walk(batch->index, &w->chosen, owner, from, 4 * (double)w->room);
        struct body_frame frame;
        struct meeting met;
        uint32_t body;
        while (find_next_part(&parts, batch->shapes, batch->bodies, &body, &frame))
            if (find_meeting(&frame, ray, NARC_INSIDE_LEAVES, true, &met) &&
                (met.distance > distance || (met.distance == distance && body < out->body)) &&
                find_depth_in(&frame, find_place_in(&frame, from)) * frame.scale <= find_seam(&frame) &&
                put_meeting(&frame, ray, &met, INFINITY, out)) {
                distance = met.distance;
                out->body = body;
            }
    }
    return out->fraction <= w->limit_fraction;
}

/* Takes a thing's row out, if it has one. False if that is before the hit. */
INLINE bool replace_row(struct walk *w, uint32_t owner, const narc_ray_hit *hit) {
    for (size_t k = 0; k < w->found; k++)
        if (find_owner(&w->chosen, w->rows[k].body) == owner) {
            if (!is_before(hit, &w->rows[k]))
                return false;
            for (w->found--; k < w->found; k++)
                w->rows[k] = w->rows[k + 1];
        }
    return true;
}

/* A row for a part, if none of its thing is before it. Of a thing that the ray starts in, that of its end, or none. */
INLINE bool find_part_row(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame,
                          narc_ray_hit *out) {
    const narc_inside inside = batch->options->inside;
    const uint32_t owner = find_owner(&w->chosen, out->body);
    const bool is_part = owner != UINT32_MAX;
    struct meeting met;
    if (!is_chosen(&w->chosen, out->body) ||
        !find_meeting(frame, &w->ray, is_part && inside == NARC_INSIDE_IGNORES ? NARC_INSIDE_LEAVES : inside, false,
                      &met))
        return false;
    if (!is_part || inside == NARC_INSIDE_STOPS || !met.is_within)
        return put_meeting(frame, &w->ray, &met, w->limit_fraction, out) &&
               (!is_part || inside == NARC_INSIDE_STOPS || !starts_in(batch, w, owner)) &&
               (!is_part || replace_row(w, owner, out));
    return inside == NARC_INSIDE_LEAVES && put_meeting(frame, &w->ray, &met, INFINITY, out) &&
           leave_thing(batch, w, owner, met.distance, out) && replace_row(w, owner, out);
}

/* ------------------------------------------------------------------------------------------------ a body */

NOINLINE bool cast_at_part(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame, uint32_t body) {
    narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
    if (!find_part_row(batch, w, frame, &hit))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

/* Casts a ray at a body. Is it done? */
NOINLINE bool cast_at_body(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame, uint32_t body) {
    narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
    struct meeting met;
    if (w->chosen.owners)
        return cast_at_part(batch, w, frame, body);
    if (body == w->chosen.ignored || !find_meeting(frame, &w->ray, batch->options->inside, false, &met) ||
        !put_meeting(frame, &w->ray, &met, w->limit_fraction, &hit))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

INLINE bool load_slot_frame(const narc_ray_batch *batch, size_t leaf, unsigned slot, struct body_frame *out) {
    return load_body_frame(batch->shapes, batch->bodies, batch->index->body[NARC_NODE_SLOTS * leaf + slot], out);
}

INLINE void leave_slots(struct descent *d, unsigned level, uint32_t slots, unsigned flips) {
    const uint64_t left = (uint64_t)flipped[flips][slots] << 8 * (level & 7);
    d->flips[level] = flips;
    if (level < 8)
        d->left |= left;
    else
        d->above |= left;
}

/* Leaves out what is further than a limit that has become less, from a level up. */
NOINLINE void drop_slots(struct descent *d, unsigned level, float limit) {
    for (; level < d->levels; level++) {
        uint32_t far = 0;
        for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH)
            far |= vm_bits(v_lt(v_set(limit), v_load(d->near[level] + k))) << k;
        const uint64_t dropped = (uint64_t)flipped[d->flips[level]][far & 0xff] << 8 * (level & 7);
        if (level < 8)
            d->left &= ~dropped;
        else
            d->above &= ~dropped;
    }
}

/* The next slot that is left, and its level. False if there is none. */
INLINE bool take_slot(struct descent *d, unsigned *level, unsigned *slot) {
    unsigned bit;
    if (d->left) {
        bit = (unsigned)FIND_LOWEST_64(d->left);
        d->left &= d->left - 1;
    } else {
        if (d->above == 0)
            return false;
        bit = 64 + (unsigned)FIND_LOWEST_64(d->above);
        d->above &= d->above - 1;
    }
    *level = bit >> 3;
    *slot = (bit & 7) ^ d->flips[*level];
    return true;
}

/* Casts a ray at the body in a leaf's slot. Is it done? */
INLINE bool visit_slot(const narc_ray_batch *batch, struct walk *w, struct descent *d, unsigned slot) {
    const size_t leaf = d->node[0];
    const float limit = w->limit;
    struct body_frame frame;
    if (load_slot_frame(batch, leaf, slot, &frame) &&
        cast_at_body(batch, w, &frame, batch->index->body[NARC_NODE_SLOTS * leaf + slot]))
        return true;
    if (w->limit < limit)
        drop_slots(d, 0, w->limit);
    return false;
}

/* Leaves the slots of a node that the ray meets to be visited. */
INLINE void visit_node(const narc_index *index, const struct walk *w, unsigned level, uint32_t at, struct descent *d) {
    const size_t node = (size_t)index->first_node[level] + at;
    const uint32_t slots = find_slots(w, &index->nodes[node], d->near[level]);
    d->node[level] = at;
    leave_slots(d, level, mask_slots(index, node, slots, &w->chosen),
                narc_find_flips(index->order[node], w->left, w->aslant));
}

NOINLINE void walk_alone(const narc_ray_batch *batch, struct walk *w) {
    struct descent d;
    unsigned slot, level = batch->index->level_count - 1;
    uint32_t below = 0;
    d.left = d.above = 0;
    d.levels = level + 1;
    for (;; below = NARC_NODE_SLOTS * d.node[level] + slot, level--) {
        visit_node(batch->index, w, level, below, &d);
        do {
            if (!take_slot(&d, &level, &slot) || (level == 0 && visit_slot(batch, w, &d, slot)))
                return;
        } while (level == 0);
    }
}

/* ------------------------------------------------------------------------------------------------ fans */

enum { LEAST_TOGETHER = 4, MOST_TOGETHER = 32, LANES = MOST_TOGETHER + V_WIDTH, ON_EDGE = 256 };

/* Do rays that go together meet a body in lanes? In the module for WebAssembly they take too much room. */
#if defined(__wasm__)
#define IN_LANES 0
#else
#define IN_LANES (NARC_SHORTCUTS && V_WIDTH > 1)
#endif

/* The least cosine of the angle between a ray and the first that it goes with. */
#define COHERENT 0.8

/* Of rays in lanes, each with room for one hit: its nearest, as far as it is not yet in its row. A body is its number less
 * 2^31, and UINT32_MAX there is none. */
struct nearest {
    uint32_t waiting; /* a bit for each ray */
    int32_t body[LANES];
    float fraction[LANES], normal_x[LANES], normal_y[LANES], point_x[LANES], point_y[LANES];
    int32_t feature[LANES]; /* the arc, and ON_EDGE */
    int32_t word[LANES];    /* that and the count as rows have them, */
    float radius[LANES];    /* and this, when they are written */
};

/* Rays of one origin whose directions differ little go through the index together: a node is visited if it meets the
 * wedge between the outermost two, and only at a leaf each ray is asked, in a lane of its own. A ray's answer is the same
 * whether it goes alone or not. */
struct fan {
    struct read_rays *rays;
    size_t first, count;
    size_t left, right;                     /* the outermost */
    float left_x, left_y, right_x, right_y; /* their directions */
    float limit;                            /* the largest */
    struct chosen chosen;                   /* their world, all masks together */
    float *limits;
    bool in_lanes;
    struct walk walks[MOST_TOGETHER]; /* in lanes: the first, and those that are asked alone */
    struct nearest nearest;
};

INLINE bool goes_in_lanes(const struct fan *f) { return IN_LANES && f->in_lanes; }

/* Does a ray go the way of another one? */
INLINE bool joins(const struct read_rays *rays, size_t first, size_t k) {
    return rays->origin_x[k] == rays->origin_x[first] && rays->origin_y[k] == rays->origin_y[first] &&
           rays->length[k] > 0 && (rays->x.inverse[k] < 0) == (rays->x.inverse[first] < 0) &&
           (rays->y.inverse[k] < 0) == (rays->y.inverse[first] < 0);
}

INLINE bool have_one_world(const narc_ray_batch *batch, const struct read_rays *rays, size_t first, size_t k) {
    const narc_index_column world = batch->options->search.world;
    return !world.base || narc_index_at(world, rays->number[first]) == narc_index_at(world, rays->number[k]);
}

/* Rays that start within the scene may go together, if it is not so large that a wedge's numbers overflow, and unless
 * any hit will do: which is found depends on the way. */
INLINE bool is_open(const narc_ray_batch *batch, const narc_box *scene, const struct read_rays *rays, size_t k) {
    const narc_point *const origin = &batch->index->origin;
    const place o = {rays->origin_x[k] - origin->x, rays->origin_y[k] - origin->y};
    return (double)scene->min_x <= o.x && o.x <= (double)scene->max_x && (double)scene->min_y <= o.y &&
           o.y <= (double)scene->max_y && rays->room[k] <= 0x1p80f && !batch->options->any;
}

/* Gathers the rays from `first` on that go together; how many are they? */
INLINE size_t gather_fan(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays, size_t first,
                         struct fan *f) {
    const place direction = {rays->direction_x[first], rays->direction_y[first]};
    const size_t left = rays->count - first, end = first + (left < MOST_TOGETHER ? left : MOST_TOGETHER);
    double most = 0, least = 0;
    size_t k = first + 1;
    if (!NARC_SHORTCUTS || k == end || !joins(rays, first, k) || !is_open(batch, scene, rays, first))
        return 1;
    f->left = f->right = first;
    for (; k < end && joins(rays, first, k) && have_one_world(batch, rays, first, k); k++) {
        const place other = {rays->direction_x[k], rays->direction_y[k]};
        const double sine = find_cross(direction, other);
        if (find_dot(direction, other) <= COHERENT)
            break;
        f->left = sine > most ? k : f->left;
        f->right = sine < least ? k : f->right;
        most = find_most(most, sine);
        least = find_least(least, sine);
    }
    f->rays = rays;
    f->first = first;
    f->count = k - first;
    return f->count;
}

/* The largest limit of all. */
INLINE float find_largest_limit(const struct fan *f) {
    vf largest = v_set(-INFINITY);
    float lanes[V_WIDTH];
    for (int k = 0; k < (int)f->count; k += V_WIDTH)
        largest = v_max(v_select(vm_front((int)f->count - k), v_load(f->limits + k), v_set(-INFINITY)), largest);
    v_store(lanes, largest);
    for (int l = 1; l < V_WIDTH; l++)
        lanes[0] = lanes[l] > lanes[0] ? lanes[l] : lanes[0];
    return lanes[0];
}

INLINE void begin_fan(const narc_ray_batch *batch, struct fan *f) {
    const narc_index_query *const search = &batch->options->search;
    struct read_rays *const rays = f->rays;
    f->limits = rays->limit + f->first;
    f->limit = find_largest_limit(f);
    f->left_x = (float)rays->direction_x[f->left];
    f->left_y = (float)rays->direction_y[f->left];
    f->right_x = (float)rays->direction_x[f->right];
    f->right_y = (float)rays->direction_y[f->right];
    f->in_lanes = IN_LANES && batch->most == 1 && !search->owners && !search->ignored.base && !batch->index->masks &&
                  !search->mask.base;
    f->chosen = read_chosen(search, rays->number[f->first]);
    for (size_t k = 0; k < (goes_in_lanes(f) ? 1 : f->count); k++) {
        begin_walk(batch, rays, f->first + k, &f->walks[k]);
        f->chosen.mask |= f->walks[k].chosen.mask;
    }
    if (!goes_in_lanes(f))
        return;
    f->nearest.waiting = 0;
    for (int k = 0; k < (int)f->count + V_WIDTH; k += V_WIDTH) {
        v_store(f->nearest.fraction + k, v_set(-1));
        vi_store(f->nearest.body + k, vi_set(INT32_MAX));
    }
    memcpy(f->nearest.fraction, rays->fraction + f->first, f->count * sizeof *rays->fraction);
}

/* A bit for each slot that the wedge may meet, and how far away it is at least: boxes have corners to the left of the
 * rightmost ray and to the right of the leftmost one; which corner decides is known by the quadrant. Boxes are larger by
 * the room on every side, and a cross product errs by less than half of it. */
INLINE uint32_t find_wedge_slots(const struct fan *f, const narc_index_node *node, float *out_near) {
    const struct walk *const w = &f->walks[0];
    const float *const planes = (const float *)node;
    const bool aslant = w->aslant;
    const vf zero = v_set(0), limit = v_set(f->limit), right_x = v_set(f->right_x), right_y = v_set(f->right_y);
    const vf outer_x = aslant ? right_x : v_set(f->left_x), outer_y = aslant ? right_y : v_set(f->left_y);
    const vf other_x = aslant ? v_set(f->left_x) : right_x, other_y = aslant ? v_set(f->left_y) : right_y;
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf first_x = v_sub(v_load(planes + w->x.first + k), v_set(w->x.first_start));
        const vf first_y = v_sub(v_load(planes + w->y.first + k), v_set(w->y.first_start));
        const vf last_x = v_sub(v_load(planes + w->x.last + k), v_set(w->x.last_start));
        const vf last_y = v_sub(v_load(planes + w->y.last + k), v_set(w->y.last_start));
        const vf a = v_sub(v_mul(outer_x, first_y), v_mul(outer_y, last_x));
        const vf c = v_sub(v_mul(other_x, last_y), v_mul(other_y, first_x));
        const vm beside = aslant ? vm_and(v_le(zero, a), v_le(c, zero)) : vm_and(v_le(a, zero), v_le(zero, c));
        const vf near = v_add(v_mul(right_x, first_x), v_mul(right_y, first_y));
        const vf far = v_add(v_mul(right_x, last_x), v_mul(right_y, last_y));
        v_store(out_near + k, near);
        slots |= vm_bits(vm_and(beside, vm_and(v_le(zero, far), v_le(near, limit)))) << k;
    }
    return slots & ((1u << NARC_NODE_SLOTS) - 1);
}

/* A bit for each ray that meets a slot's box: as find_slots(), with a lane for each ray. */
INLINE uint32_t find_rays(const struct fan *f, const narc_index_node *node, unsigned slot) {
    const struct walk *const w = &f->walks[0];
    const float *const planes = (const float *)node + slot;
    const float *const all_x = f->rays->x.inverse + f->first, *const all_y = f->rays->y.inverse + f->first;
    const vf first_x = v_set(planes[w->x.first] - w->x.first_start),
             last_x = v_set(planes[w->x.last] - w->x.last_start);
    const vf first_y = v_set(planes[w->y.first] - w->y.first_start),
             last_y = v_set(planes[w->y.last] - w->y.last_start);
    uint64_t rays = 0;
    for (size_t k = 0; k < f->count; k += V_WIDTH) {
        const vf inverse_x = v_load(all_x + k), inverse_y = v_load(all_y + k);
        const vf near = v_max(v_max(v_mul(first_x, inverse_x), v_mul(first_y, inverse_y)), v_set(0));
        const vf far = v_mul(v_min(v_mul(last_x, inverse_x), v_mul(last_y, inverse_y)), v_set(1 + ROOM));
        rays |= (uint64_t)vm_bits(vm_and(v_le(near, far), v_le(near, v_load(f->limits + k)))) << k;
    }
    return (uint32_t)(rays & (((uint64_t)1 << f->count) - 1));
}

INLINE unsigned find_nearest_slot(uint32_t slots, const float *near) {
    unsigned nearest = (unsigned)FIND_LOWEST(slots);
    while (slots &= slots - 1)
        nearest = near[FIND_LOWEST(slots)] < near[nearest] ? (unsigned)FIND_LOWEST(slots) : nearest;
    return nearest;
}

/* Writes what waits of these rays to their rows. Neighbours mostly hit the same body, often by the same feature. */
NOINLINE void put_hits(const narc_ray_batch *batch, struct fan *f, uint32_t rays) {
    struct nearest *const nearest = &f->nearest;
    narc_ray_hit told = {.count = 1}, spare;
    struct body_frame frame = {.header = NULL};
    int32_t body = INT32_MAX, feature = -1;
    const uint64_t put = rays & nearest->waiting;
    for (uint64_t left = put; left; left &= left - 1) {
        const unsigned k = (unsigned)FIND_LOWEST_64(left);
        if (nearest->body[k] != body)
            load_body_frame(batch->shapes, batch->bodies, (uint32_t)nearest->body[k] ^ 0x80000000u, &frame);
        if (nearest->body[k] != body || nearest->feature[k] != feature)
            put_feature(&frame,
                        &(struct entry){.arc = nearest->feature[k] & (ON_EDGE - 1),
                                        .on_edge = (nearest->feature[k] & ON_EDGE) != 0},
                        &told);
        body = nearest->body[k];
        feature = nearest->feature[k];
        memcpy(&nearest->word[k], &told.feature, sizeof nearest->word[k]);
        nearest->radius[k] = told.radius;
    }
    for (size_t k = 0; k < f->count; k += V_WIDTH) {
        const vf first[4] = {v_of_bits(vi_add(vi_load(nearest->body + k), vi_set(INT32_MIN))),
                             v_of_bits(vi_load(nearest->word + k)), v_load(nearest->fraction + k),
                             v_load(nearest->normal_x + k)};
        const vf second[4] = {v_load(nearest->normal_y + k), v_load(nearest->point_x + k), v_load(nearest->point_y + k),
                              v_load(nearest->radius + k)};
        char *row[V_WIDTH];
        for (size_t l = 0; l < V_WIDTH; l++)
            row[l] = (char *)(put >> (k + l) & 1 ? get_rows(batch, f->rays, f->first + k + l) : &spare);
        v_put_rows(row, offsetof(narc_ray_hit, body), first);
        v_put_rows(row, offsetof(narc_ray_hit, normal_y), second);
    }
    nearest->waiting &= ~rays;
}

_Static_assert(offsetof(narc_ray_hit, feature) == 8 && offsetof(narc_ray_hit, count) == 10 &&
                   offsetof(narc_ray_hit, fraction) == 12 && offsetof(narc_ray_hit, point_x) == 24 &&
                   offsetof(narc_ray_hit, radius) == 32,
               "a row is the ray's number, and two times four words");

INLINE void select_ints(vm m, int32_t *p, vi a) { vi_store(p, vi_select(m, a, vi_load(p))); }
INLINE void select_floats(vm m, float *p, vf a) { v_store(p, v_select(m, a, v_load(p))); }

/* Casts rays k, k + 1 ... at a body, which has a hit for each ray that it tells nothing of. */
INLINE uint32_t cast_lanes(struct fan *f, const struct body_frame *frame, uint32_t body, bool ignores, unsigned k) {
    struct nearest *const nearest = &f->nearest;
    const struct read_rays *const all = f->rays;
    const size_t at = f->first + k;
    const struct lane_rays rays = {f->walks[0].ray.origin, all->direction_x + at, all->direction_y + at,
                                   all->inverse_length + at};
    struct entry_lanes entries;
    struct half_met met[LANE_HALVES];
    float lanes[V_WIDTH];
    if (!meet_in_lanes(frame, &rays, ignores, &entries, met, lanes))
        return 0;
    const vf fraction = v_load(lanes), least = v_load(nearest->fraction + k);
    const vi number = vi_set((int32_t)(body ^ 0x80000000u));
    const vm is_before = vm_or(v_lt(fraction, least), vi_lt(number, vi_load(nearest->body + k)));
    const vm hits = vm_and(vm_and(v_le(v_set(0), fraction), v_le(fraction, least)), is_before);
    if (vm_any(hits)) {
        float limits[V_WIDTH], normal_x[V_WIDTH], normal_y[V_WIDTH], point_x[V_WIDTH], point_y[V_WIDTH];
        UNROLL
        for (int h = 0; h < LANE_HALVES; h++) {
            const int l = h * D_WIDTH;
            const struct half_place at_place = find_place_lanes(frame, &met[h]);
            d_put_floats(normal_x + l, at_place.normal.x);
            d_put_floats(normal_y + l, at_place.normal.y);
            d_put_floats(point_x + l, at_place.point.x);
            d_put_floats(point_y + l, at_place.point.y);
            d_put_floats(limits + l, find_limit(d_of_floats(lanes + l), d_load(all->length + at + l), d_set(0),
                                                d_set((double)f->walks[0].room)));
        }
        nearest->waiting |= vm_bits(hits) << k;
        select_floats(hits, nearest->fraction + k, fraction);
        select_ints(hits, nearest->body + k, number);
        select_ints(hits, nearest->feature + k,
                    vi_add(vi_load(entries.arc), vi_select(entries.on_edge, vi_set(ON_EDGE), vi_set(0))));
        select_floats(hits, nearest->normal_x + k, v_load(normal_x));
        select_floats(hits, nearest->normal_y + k, v_load(normal_y));
        select_floats(hits, nearest->point_x + k, v_load(point_x));
        select_floats(hits, nearest->point_y + k, v_load(point_y));
        select_floats(hits, f->limits + k, v_load(limits));
    }
    return vm_bits(v_lt(fraction, v_set(0)));
}

/* Casts rays at a body; which are to be asked alone? */
INLINE uint32_t cast_in_lanes(const narc_ray_batch *batch, struct fan *f, const struct body_frame *frame, uint32_t body,
                              uint32_t rays) {
    const bool ignores = batch->options->inside == NARC_INSIDE_IGNORES;
    uint32_t alone = 0;
    while (rays) {
        const unsigned k = (unsigned)FIND_LOWEST(rays);
        const uint32_t lanes = (uint32_t)(((uint64_t)1 << V_WIDTH) - 1) << k;
        alone |= cast_lanes(f, frame, body, ignores, k) << k & rays;
        rays &= ~lanes;
    }
    return alone;
}

/* Casts one ray of a fan at a body, alone. */
NOINLINE void cast_one(const narc_ray_batch *batch, struct fan *f, const struct body_frame *frame, uint32_t body,
                       unsigned k) {
    struct walk *const w = &f->walks[k];
    if (goes_in_lanes(f)) {
        put_hits(batch, f, 1u << k);
        begin_walk(batch, f->rays, f->first + k, w);
        w->found = w->rows->count;
        w->limit = f->limits[k];
        w->limit_fraction = f->nearest.fraction[k];
    }
    cast_at_body(batch, w, frame, body);
    f->limits[k] = w->limit;
    if (goes_in_lanes(f) && w->found > 0) {
        f->nearest.fraction[k] = w->rows->fraction;
        f->nearest.body[k] = (int32_t)(w->rows->body ^ 0x80000000u);
    }
}

/* Is the largest limit less now? */
INLINE bool visit_leaf_together(const narc_ray_batch *batch, struct fan *f, size_t leaf, uint32_t slots,
                                const float *near) {
    const narc_index *const index = batch->index;
    unsigned slot;
    for (; slots; slots &= ~(1u << slot)) {
        slot = find_nearest_slot(slots, near);
        const size_t number = NARC_NODE_SLOTS * leaf + slot;
        uint32_t rays = find_rays(f, &index->nodes[leaf], slot);
        struct body_frame frame;
        if (!rays || !load_slot_frame(batch, leaf, slot, &frame))
            continue;
        if (goes_in_lanes(f) && !narc_is_piece(frame.header))
            rays = cast_in_lanes(batch, f, &frame, index->body[number], rays);
        for (; rays; rays &= rays - 1) {
            const unsigned k = (unsigned)FIND_LOWEST(rays);
            if (goes_in_lanes(f) || (index->masks ? index->masks[number] : UINT64_MAX) & f->walks[k].chosen.mask)
                cast_one(batch, f, &frame, index->body[number], k);
        }
    }
    const float limit = f->limit;
    f->limit = find_largest_limit(f);
    return f->limit < limit;
}

static void walk_together(const narc_ray_batch *batch, struct fan *f) {
    const narc_index *const index = batch->index;
    const struct walk *const first = &f->walks[0];
    struct descent d;
    unsigned slot, level = index->level_count - 1;
    uint32_t below = 0;
    d.left = d.above = 0;
    d.levels = index->level_count;
    begin_fan(batch, f);
    for (;; below = NARC_NODE_SLOTS * d.node[level] + slot, level--) {
        const size_t node = (size_t)index->first_node[level] + below;
        const uint32_t slots =
            mask_slots(index, node, find_wedge_slots(f, &index->nodes[node], d.near[level]), &f->chosen);
        d.node[level] = below;
        if (level > 0)
            leave_slots(&d, level, slots, narc_find_flips(index->order[node], first->left, first->aslant));
        else if (visit_leaf_together(batch, f, node, slots, d.near[0]))
            drop_slots(&d, 1, f->limit);
        if (!take_slot(&d, &level, &slot))
            break;
    }
    if (goes_in_lanes(f))
        put_hits(batch, f, UINT32_MAX);
}

/* ------------------------------------------------------------------------------------------------ rays side by side */

/* Rays that each go their own way take a step in turn, so that the processor need not wait for one. */
enum { UNDER_WAY = 16 };

struct stepper {
    struct walk walk;
    struct descent d;
    unsigned level, slot;
    uint32_t below;
};

/* Goes to what comes next in a walk: a node, or a body at level 0. False at its end. */
INLINE bool find_step(struct stepper *s) {
    if (!take_slot(&s->d, &s->level, &s->slot))
        return false;
    s->below = NARC_NODE_SLOTS * s->d.node[s->level] + s->slot;
    return true;
}

/* Rays that have no company. */
struct loners {
    const struct read_rays *rays;
    size_t next, count;
    uint8_t number[READ];
};

/* The next one begins. False if there is none. */
INLINE bool begin_steps(const narc_ray_batch *batch, struct loners *loners, struct stepper *out) {
    if (loners->next == loners->count)
        return false;
    begin_walk(batch, loners->rays, loners->number[loners->next++], &out->walk);
    out->d.left = out->d.above = 0;
    out->below = 0;
    out->level = out->d.levels = batch->index->level_count;
    return true;
}

NOINLINE void walk_apart(const narc_ray_batch *batch, struct loners *loners) {
    struct stepper steppers[UNDER_WAY], *at_node[UNDER_WAY], *at_body[UNDER_WAY];
    size_t node_count = 0, body_count;
    for (; node_count < UNDER_WAY && begin_steps(batch, loners, &steppers[node_count]); node_count++)
        at_node[node_count] = &steppers[node_count];
    while (node_count > 0) {
        body_count = 0;
        const size_t nodes = node_count;
        node_count = 0;
        for (size_t k = 0; k < nodes; k++) {
            struct stepper *const s = at_node[k];
            visit_node(batch->index, &s->walk, s->level - 1, s->below, &s->d);
            if (!find_step(s) && !begin_steps(batch, loners, s))
                continue;
            at_node[node_count] = at_body[body_count] = s;
            node_count += s->level > 0;
            body_count += s->level == 0;
        }
        for (size_t k = 0; k < body_count; k++) {
            struct stepper *const s = at_body[k];
            bool goes_on;
            do {
                goes_on = !visit_slot(batch, &s->walk, &s->d, s->slot) && find_step(s);
            } while (goes_on && s->level == 0);
            if (goes_on || begin_steps(batch, loners, s))
                at_node[node_count++] = s;
        }
    }
}

/* ------------------------------------------------------------------------------------------------ the kernel */

static void walk_one_by_one(const narc_ray_batch *batch, struct loners *loners) {
    struct walk w;
    while (loners->next < loners->count) {
        begin_walk(batch, loners->rays, loners->number[loners->next++], &w);
        walk_alone(batch, &w);
    }
}

/* Empties a ray's rows. Has it an answer? */
INLINE bool empty_rows(const narc_ray_batch *batch, const struct read_rays *rays, size_t k) {
    narc_ray_hit *const rows = get_rows(batch, rays, k);
    for (size_t i = 0; i < batch->most; i++)
        rows[i] = (narc_ray_hit){.ray = rays->number[k]};
    return rays->length[k] > 0;
}

/* Casts rays that are read; how many have no answer? */
static size_t cast_rays(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays) {
    struct loners loners;
    struct fan fan;
    size_t skipped = 0;
    loners.rays = rays;
    loners.next = loners.count = 0;
    for (size_t k = 0; k < rays->count; k++)
        skipped += !empty_rows(batch, rays, k);
    for (size_t k = 0, count; k < rays->count; k += count) {
        count = 1;
        if (!(rays->length[k] > 0) || rays->base[k] < 0)
            continue;
        count = gather_fan(batch, scene, rays, k, &fan);
        if (count >= LEAST_TOGETHER) {
            walk_together(batch, &fan);
            continue;
        }
        for (size_t i = k; i < k + count; i++)
            loners.number[loners.count++] = (uint8_t)i;
    }
    if (IN_LANES && loners.count >= LEAST_TOGETHER)
        walk_apart(batch, &loners);
    else
        walk_one_by_one(batch, &loners);
    return skipped;
}

size_t NARC_NAMED(rays)(const narc_ray_batch *batch, size_t first, size_t count) {
    const narc_box scene = narc_find_index_box(batch->index);
    size_t skipped = 0;
    struct read_rays rays;
    for (size_t k = first; k < first + count; k += READ) {
        const size_t left = first + count - k;
        read_rays(batch, &scene, k, left < READ ? left : READ, &rays);
        skipped += cast_rays(batch, &scene, &rays);
    }
    return skipped;
}
