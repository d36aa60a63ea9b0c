/* SPDX-License-Identifier: MIT
 *
 * cast_planes.inl - casts with a half-plane: what goes along its boundary changes nothing, so that ways and motions are
 * those across it, and the circle around the other body meets it or does not (base/planes.inl).
 */
#ifndef NARC_SCENE_CAST_PLANES_INL
#define NARC_SCENE_CAST_PLANES_INL

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "broken.h"
#include "column.h"
#include "kernels.h"
#include "scene/cast_fields.inl"
#include "scene/cast_start.inl"
#include "store.h"

/* Which side of a cast is a half-plane, or -1. */
INLINE int find_plane_side(const narc_shapes *shapes, const narc_casts *casts, size_t slot) {
    for (int side = 0; side < 2; side++)
        if (narc_is_plane(&shapes->headers[casts->side[side].shape[slot]]))
            return side;
    return -1;
}

/* Half-planes are as large as what is cast at them. */
NOINLINE void measure_planes(const narc_shapes *shapes, const narc_casts *casts, size_t k, struct loaded *loaded) {
    for (size_t l = 0; l < V_WIDTH; l++) {
        const int side = find_plane_side(shapes, casts, k + l);
        if (side < 0)
            continue;
        struct outline *const plane = &loaded->outline[side], *const other = &loaded->outline[1 - side];
        const float by = casts->side[1 - side].scale[k + l] / casts->side[side].scale[k + l];
        plane->bound_x[l] = plane->bound_y[l] = 0;
        plane->bound[l] = by * other->bound[l];
        if (!loaded->turn)
            continue;
        plane->inner_x[l] = plane->inner_y[l] = plane->round[l] = 0;
        plane->inner[l] = by * other->inner[l];
    }
}

/* The boundary's direction; its normal is that a quarter turn on. */
INLINE void find_boundary(const struct narc_cast_side *plane, size_t slot, double *out_x, double *out_y) {
    const double c = (double)plane->cosine[slot], s = (double)plane->sine[slot], error = c * c + s * s - 1;
    const double factor = NARC_INVERSE_LENGTH(error);
    *out_x = c * factor;
    *out_y = s * factor;
}

/* Where casts k ... begin, and how they move. A half-plane that turns has no answer; one meets no other, nor ground. */
NOINLINE void begin_at_planes(const narc_shapes *shapes, narc_casts *casts, size_t k, const struct loaded *loaded,
                              float *outcome) {
    for (size_t l = 0; l < V_WIDTH; l++) {
        const size_t slot = k + l;
        const int side = find_plane_side(shapes, casts, slot);
        if (side < 0 || outcome[l] == (float)CAST_BROKEN)
            continue;
        const struct narc_cast_side *const plane = &casts->side[side], *const other = &casts->side[1 - side];
        const struct outline *const outline = &loaded->outline[1 - side];
        double along_x, along_y;
        find_boundary(plane, slot, &along_x, &along_y);
        const double n_x = -along_y, n_y = along_x, sign = side == 0 ? 1 : -1;
        const double way = n_x * casts->x[slot] + n_y * casts->y[slot];
        const double motion = n_x * casts->motion_x[slot] + n_y * casts->motion_y[slot];
        const double x = (double)outline->bound_x[l], y = (double)outline->bound_y[l];
        const double reach = (double)other->scale[slot] * ((double)outline->bound[l] + sqrt(x * x + y * y));
        const double gap = sign * way - reach - (double)casts->target[slot], time = gap / -(sign * motion);
        const bool is_near = gap <= 0, comes = is_near || (time >= 0 && time <= 1);
        const float from = is_near ? 0 : (float)time;
        casts->x[slot] = n_x * way;
        casts->y[slot] = n_y * way;
        casts->motion_x[slot] = n_x * motion;
        casts->motion_y[slot] = n_y * motion;
        casts->end[slot] = 1;
        casts->time[slot] = !is_near && (double)from > time ? nextafterf(from, 0) : from;
        outcome[l] = plane->angle[slot] != 0                                         ? (float)CAST_BROKEN
                     : !comes || narc_is_piece(&shapes->headers[other->shape[slot]]) ? (float)NARC_CAST_MISS
                                                                                     : (float)CAST_GOES_ON;
    }
}

/* Moves the point of a contact, which is seen from A, to where that is, if it is a half-plane. */
NOINLINE void move_to_plane(const narc_cast_batch *given, const narc_casts *casts, size_t slot, narc_contact *contact) {
    const narc_batch *const batch = given->batch;
    const narc_pairs *const pairs = batch->pairs;
    const size_t pair = casts->pair[slot], a = pairs->a.base ? narc_index_at(pairs->a, pair) : pair,
                 b = pairs->b.base ? narc_index_at(pairs->b, pair) : pair;
    const size_t body_a = narc_body_at(pairs, 0, pair), body_b = narc_body_at(pairs, 1, pair);
    const double time = (double)casts->time[slot];
    if (find_plane_side(batch->shapes, casts, slot) != 0)
        return;
    const narc_motions *const of_a = given->motions[0], *const of_b = given->motions[1];
    const double motion_x = (double)narc_float_or(of_b->x, body_b, 0) - (double)narc_float_or(of_a->x, body_a, 0);
    const double motion_y = (double)narc_float_or(of_b->y, body_b, 0) - (double)narc_float_or(of_a->y, body_a, 0);
    const double x = narc_position_at(batch->b->x, b) - narc_position_at(batch->a->x, a) +
                     (double)narc_float_or(pairs->shift_x, pair, 0) + time * motion_x;
    const double y = narc_position_at(batch->b->y, b) - narc_position_at(batch->a->y, a) +
                     (double)narc_float_or(pairs->shift_y, pair, 0) + time * motion_y;
    double along_x, along_y;
    find_boundary(&casts->side[0], slot, &along_x, &along_y);
    const double along = along_x * x + along_y * y;
    contact->point_x = (float)((double)contact->point_x + along * along_x);
    contact->point_y = (float)((double)contact->point_y + along * along_y);
}

#endif
