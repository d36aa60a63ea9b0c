/* SPDX-License-Identifier: MIT
 *
 * cast_lanes.inl - what the kernels of casts share: places in double lanes, contacts, and the arcs that touch.
 */
#ifndef NARC_SCENE_CAST_LANES_INL
#define NARC_SCENE_CAST_LANES_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/shape.inl"
#include "broken.h"
#include "narc_scene.h"
#include "scene/cast_fields.inl"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* Rounds after which an answer is "not finished". */
enum { MOST_ROUNDS = 128 };

typedef struct {
    vd x, y;
} dvec2;

INLINE vd find_dot(dvec2 a, dvec2 b) { return a.x * b.x + a.y * b.y; }
INLINE vd find_cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }
INLINE vd find_length(dvec2 a) { return d_sqrt(find_dot(a, a)); }
INLINE dvec2 turn(dvec2 rotation, dvec2 p) {
    return (dvec2){rotation.x * p.x - rotation.y * p.y, rotation.y * p.x + rotation.x * p.y};
}
INLINE dvec2 turn_back(dvec2 rotation, dvec2 p) {
    return (dvec2){rotation.x * p.x + rotation.y * p.y, rotation.x * p.y - rotation.y * p.x};
}
INLINE dvec2 get_dvec2(const float *x, const float *y) { return (dvec2){d_of_floats(x), d_of_floats(y)}; }

/* Times of 0 or more as floats that are not later. What is less by half a step or more is rounded to the float before: in
 * proportion, and where floats underflow, by three quarters of their step. */
INLINE vd round_down(vd time) {
    float lane[V_WIDTH];
    d_put_floats(lane, time);
    const vd rounded = d_of_floats(lane), below = rounded * d_set(1 - 0x1p-24) - d_set(0x1.8p-150);
    d_put_floats(lane, d_select(d_lt(time, rounded), below, rounded));
    return d_of_floats(lane);
}

/* Rotations at the start. */
INLINE dvec2 find_rotation(const float *cosine, const float *sine) {
    const dvec2 given = get_dvec2(cosine, sine);
    const vd error = find_dot(given, given) - d_set(1), factor = NARC_INVERSE_LENGTH(error);
    return (dvec2){factor * given.x, factor * given.y};
}

/* ------------------------------------------------------------------------------------------------ what touches */

/* Contacts, from rows. */
struct touch {
    vi feature; /* 0 in lanes that have none */
    vm known;   /* which have an answer */
    float separation[V_WIDTH], normal_x[V_WIDTH], normal_y[V_WIDTH], point_x[V_WIDTH], point_y[V_WIDTH];
    float radius_a[V_WIDTH], radius_b[V_WIDTH];
};

INLINE struct touch load_contacts(const narc_contact *contacts, vm live) {
    struct touch touch;
    int32_t lane[V_WIDTH];
    vf row[8];
    _Static_assert(offsetof(narc_contact, normal_y) - offsetof(narc_contact, feature) == 12 &&
                       offsetof(narc_contact, radius_b) - offsetof(narc_contact, point_x) == 12,
                   "four numbers that follow each other");
    if (V_WIDTH == 1) { /* the row has just been written, otherwise divided */
        touch.feature = vi_set(contacts->feature);
        touch.known = vi_lt(vi_set(0), vi_set(contacts->count));
        touch.separation[0] = contacts->separation;
        touch.normal_x[0] = contacts->normal_x;
        touch.normal_y[0] = contacts->normal_y;
        touch.point_x[0] = contacts->point_x;
        touch.point_y[0] = contacts->point_y;
        touch.radius_a[0] = contacts->radius_a;
        touch.radius_b[0] = contacts->radius_b;
        return touch;
    }
    for (int l = 0; l < V_WIDTH; l++)
        lane[l] = l;
    v_rows(&contacts->feature, sizeof *contacts, lane, row);
    v_rows(&contacts->point_x, sizeof *contacts, lane, row + 4);
    touch.feature = vi_select(live, vi_bits(row[0]), vi_set(0));
    touch.known = vi_lt(vi_set(0), vi_shift_right(touch.feature, 16));
    v_store(touch.separation, row[1]);
    v_store(touch.normal_x, row[2]);
    v_store(touch.normal_y, row[3]);
    v_store(touch.point_x, row[4]);
    v_store(touch.point_y, row[5]);
    v_store(touch.radius_a, row[6]);
    v_store(touch.radius_b, row[7]);
    return touch;
}

/* The shape of a body, and which arc of it touches. */
struct outline_part {
    vi first_record, count, arc;
    vm round, on_edge; /* is it a circle; does the edge before the arc touch? */
};

/* Those of casts k ..., in the lanes `live`; the others have the first arc of all. */
INLINE struct outline_part find_part(const struct narc_cast_side *side, size_t k, int which, vm live,
                                     const struct touch *touch) {
    const vi record = vi_bits(v_select(live, v_load(side->record + k), v_set(0)));
    const vi info = vi_select(live, vi_bits(v_load(side->info + k)), vi_set(1)), count = get_arc_count(info);
    const vi feature = which == 0 ? touch->feature : vi_shift_right(touch->feature, 8);
    const vi from_first = vi_sub(vi_and(feature, vi_set(NARC_FEATURE_EDGE - 1)), get_first_arc(info));
    return (struct outline_part){.first_record = record,
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

/* What a step has come to. */
struct step {
    float outcome[V_WIDTH], time[V_WIDTH], rounds[V_WIDTH];
};

INLINE void put_step(struct step *out, int h, vd outcome, vd time, vd rounds) {
    d_put_floats(out->outcome + h, outcome);
    d_put_floats(out->time + h, time);
    d_put_floats(out->rounds + h, rounds);
}

/* Keeps the lanes m of steps, and takes the rest from others. */
INLINE void select_steps(vm m, struct step *steps, const struct step *others) {
    v_store(steps->outcome, v_select(m, v_load(steps->outcome), v_load(others->outcome)));
    v_store(steps->time, v_select(m, v_load(steps->time), v_load(others->time)));
    v_store(steps->rounds, v_select(m, v_load(steps->rounds), v_load(others->rounds)));
}

/* ------------------------------------------------------------------------------------------------ rows */

_Static_assert(sizeof(narc_impact) - offsetof(narc_impact, separation) ==
                   sizeof(narc_contact) - offsetof(narc_contact, separation),
               "from there on rows are alike");

/* What a cast has come to, beside what touches then. */
struct impact {
    uint32_t pair, body;
    float time;
    int outcome;
};

/* Writes it to its row; of `nearest` not where the mover hits another body before, or one with a lower number then. */
INLINE void write_impact(const struct impact *impact, const narc_contact *contact, bool nearest, narc_impact *row) {
    if (!nearest)
        row->pair = impact->pair;
    else if (row->count != NARC_CAST_MISS &&
             (row->fraction < impact->time || (row->fraction == impact->time && row->body < impact->body)))
        return;
    row->body = impact->body;
    row->feature = contact->feature;
    row->count = (uint16_t)impact->outcome;
    row->fraction = impact->time;
    memcpy(&row->separation, &contact->separation, sizeof *contact - offsetof(narc_contact, separation));
}

#endif
