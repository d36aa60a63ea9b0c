/* SPDX-License-Identifier: MIT
 *
 * ray_reading.inl - rays are read, as many together as double lanes pay for, and set out from where they meet the scene.
 *
 * Rays that start outside of all boxes are moved to where they meet them first: so what single precision needs as room is
 * in proportion to the scene.
 */
#ifndef NARC_SCENE_RAY_READING_INL
#define NARC_SCENE_RAY_READING_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "column.h"
#include "index.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Relative to all that near and far are computed from, eight times their error. */
#define ROOM 0x1p-20f

/* 1 / a direction's component that is less than the inverse counts as this: within the scene the ray moves by less than
 * its room along that axis. */
#define LARGEST_INVERSE 0x1p60f

/* Rays that are read together, in double lanes. Vectors may read on behind them, those of fans too, which are up to so wide. */
enum { READ = 128, BEHIND = 16, READ_ROOM = READ + BEHIND };

struct read_axis {
    float first_start[READ], last_start[READ], inverse[READ_ROOM];
};

struct read_rays {
    size_t count;
    uint32_t number[READ];
    double origin_x[READ_ROOM], origin_y[READ_ROOM], direction_x[READ_ROOM], direction_y[READ_ROOM];
    double length[READ_ROOM]; /* 0: it has no answer */
    double inverse_length[READ_ROOM];
    double base[READ]; /* where it meets the scene; -1: it never does */
    float fraction[READ], room[READ], limit[READ_ROOM];
    struct read_axis x, y;
};

/* A single ray, which was just written, is not read in a vector: that would wait. */
INLINE vd get_lanes(const double *p, bool single) { return single ? d_set(*p) : d_load(p); }

INLINE vd clip(vd a, double limit) { return d_max(d_set(-limit), d_min(d_set(limit), a)); }

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
    *from = d_max(d_select(backwards, b, a), *from);
    *to = d_min(d_select(backwards, a, b), *to);
}

INLINE void put_axis(vd start, vd room, vd inverse, size_t k, struct read_axis *out) {
    const vl backwards = d_lt(inverse, d_set(0));
    const vd low = start - room, high = start + room;
    d_put_floats(out->first_start + k, clip(d_select(backwards, low, high), (double)FLT_MAX));
    d_put_floats(out->last_start + k, clip(d_select(backwards, high, low), (double)FLT_MAX));
    d_put_floats(out->inverse + k, clip(inverse, (double)LARGEST_INVERSE));
}

/* Rays first .. first + count - 1 in their order, at most READ, set out from where they meet the scene, with room. */
static inline void read_rays(const narc_ray_batch *batch, const narc_box *scene, size_t first, size_t count,
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
    for (size_t k = 0; k < given; k++) { /* the first one again behind the last */
        const size_t at = first + (k < count ? k : 0);
        const uint32_t i = order ? order[at] : (uint32_t)at;
        out->number[k] = i;
        out->origin_x[k] = narc_position_at(rays->x, i);
        out->origin_y[k] = narc_position_at(rays->y, i);
        out->direction_x[k] = (double)narc_float_at(rays->motion_x, i);
        out->direction_y[k] = (double)narc_float_at(rays->motion_y, i);
        out->fraction[k] = narc_float_or(rays->fraction, i, 1);
    }
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
        const vd inverse_x = length / motion_x, inverse_y = length / motion_y;
        const vd touch = d_set(least_touch) + (d_abs(x) + d_abs(y)) * d_set(0x1p-48);
        vd base = zero, start_x = x, start_y = y, to = d_set((double)INFINITY);
        if (d_any(~(d_le(min_x, x) & d_le(x, max_x) & d_le(min_y, y) & d_le(y, max_y)))) {
            cut_stretch(min_x - touch, max_x + touch, x, inverse_x, &base, &to);
            cut_stretch(min_y - touch, max_y + touch, y, inverse_y, &base, &to);
            base = d_min(base, largest);
            start_x = x + base * direction_x;
            start_y = y + base * direction_y;
        }
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
            memset(columns[k] + end, 0, BEHIND * sizeof *columns[k]);
        float *const others[] = {out->limit, out->x.inverse, out->y.inverse};
        for (size_t k = 0; k < sizeof others / sizeof *others; k++)
            memset(others[k] + end, 0, BEHIND * sizeof *others[k]);
    }
}

/* The rows of the k-th of them. */
INLINE narc_ray_hit *get_rows(const narc_ray_batch *batch, const struct read_rays *rays, size_t k) {
    return batch->out + (size_t)rays->number[k] * batch->most;
}

#endif
