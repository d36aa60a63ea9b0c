/* SPDX-License-Identifier: MIT
 *
 * cast_lanes.inl - what the kernels of casts share: places in double lanes, contacts, and the arcs that touch.
 */
#ifndef NARC_SCENE_CAST_LANES_INL
#define NARC_SCENE_CAST_LANES_INL

#include <stddef.h>
#include <stdint.h>

#include "base/shape.inl"
#include "broken.h"
#include "kernels.h"
#include "narc_scene.h"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* Rounds after which an answer is "not finished". */
enum { MOST_ROUNDS = 128 };

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

/* Times of 0 or more as floats that are not later. What is less by half a step or more is rounded to the float before: in
 * proportion, and where floats underflow, by three quarters of their step. */
INLINE vd round_down(vd time) {
    float lane[V_WIDTH];
    d_put_floats(lane, time);
    const vd rounded = d_of_floats(lane), below = rounded - (rounded * d_set(0x1p-24) + d_set(0x1.8p-150));
    d_put_floats(lane, d_select(d_lt(time, rounded), below, rounded));
    return d_of_floats(lane);
}

/* Rotations at the start. */
INLINE spot find_rotation(const float *cosine, const float *sine) {
    const spot given = get_spot(cosine, sine);
    const vd error = find_dot(given, given) - d_set(1), factor = NARC_INVERSE_LENGTH(error);
    return (spot){factor * given.x, factor * given.y};
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

#endif
