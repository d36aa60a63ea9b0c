/* SPDX-License-Identifier: MIT
 *
 * casts.c - the kernel of times of impact, a pair in each lane. Some pairs are under way at a time: all of them are placed
 * at their present times, the contact kernel finds what there is between them, and each goes on or makes room for the
 * next pair, so that vectors are full until a part ends.
 *
 * A pair never goes past a time at which its separation could have come down to the target (docs/algorithm.md). What
 * contacts mean is in cast_lines.inl and cast_turns.inl.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "narc_scene.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "scene/cast_lines.inl"
#include "scene/cast_places.inl"
#include "scene/cast_planes.inl"
#include "scene/cast_start.inl"
#include "scene/cast_turns.inl"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* What the casts of a call have in common. */
struct cast_call {
    const narc_cast_batch *given;
    const narc_shapes *shapes;
    struct sources sources;
    enum pose_layout layout[2];
    bool own, pieces; /* do pairs bring their own bodies; are there pieces of chains? */
    bool lets_go;     /* what is at its target at the start */
    float
        looked[V_WIDTH]; /* times at which those were looked at that are advanced; only kept where bodies are let go */
    size_t skipped;      /* pairs without an answer */
};

/* ------------------------------------------------------------------------------------------------ rows */

/* The row that a pair's answer goes to. */
static narc_impact *find_row(const narc_cast_batch *given, size_t pair) {
    return &given->out[given->nearest ? narc_index_at(given->batch->pairs->a, pair) : pair];
}

/* Has its mover, of `nearest`, hit something before it can? */
static bool is_late(const narc_cast_batch *given, const narc_casts *casts, size_t slot) {
    const narc_impact *const row = find_row(given, casts->pair[slot]);
    return row->count != NARC_CAST_MISS && row->fraction < casts->time[slot];
}

/* Writes the row of a pair. */
static void write_row(const narc_cast_batch *given, const narc_casts *casts, size_t slot, int outcome) {
    const struct impact impact = {casts->pair[slot], casts->body[slot], casts->time[slot], outcome};
    narc_contact contact = casts->contact[slot];
    if (NARC_PIECES && given->batch->shapes->plane_count > 0)
        move_to_plane(given, casts, slot, &contact);
    write_impact(&impact, &contact, given->nearest, find_row(given, impact.pair));
}

/* The caller's target of a cast. */
static float find_target(const narc_cast_batch *given, const narc_casts *casts, size_t slot) {
    const size_t pair = casts->pair[slot];
    const bool of_movers = given->nearest && !given->depths.base;
    return narc_float_or(given->targets, of_movers ? narc_index_at(given->batch->pairs->a, pair) : pair, given->target);
}

#if NARC_PIECES
/* Is what touches a piece's front for certain? Else it may be a run's closure, or behind a piece: where it has been
 * from the start, or is to be so deep. */
static bool is_in_front(const narc_shape_header *a, const narc_shape_header *b, const narc_casts *casts, size_t slot) {
    const narc_contact *const c = &casts->contact[slot];
    const bool starts = !(casts->time[slot] > 0), deep = c->separation < 0 && (starts || casts->target[slot] < 0);
    return narc_touches(a, c->feature & 0xff) && narc_touches(b, c->feature >> 8) &&
           !(deep && (narc_is_of_chain(a) || narc_is_of_chain(b)));
}

/* Goes on alone with a cast of pieces, where it must: with a concave arc from the start, or where it hits what may not be
 * a front. */
static int cast_pieces(const struct cast_call *call, narc_casts *casts, size_t slot, int outcome) {
    const narc_shape_header *const a = &call->shapes->headers[casts->side[0].shape[slot]],
                                   *const b = &call->shapes->headers[casts->side[1].shape[slot]];
    if (outcome == CAST_GOES_ON ? narc_is_concave(a) || narc_is_concave(b)
                                : outcome == NARC_CAST_HIT && !is_in_front(a, b, casts, slot))
        return NARC_NAMED(piece)(call->shapes, casts, slot, find_target(call->given, casts, slot));
    return outcome;
}
#endif

INLINE bool is_let_go(const narc_cast_batch *given, const narc_casts *casts, size_t slot) {
    return casts->target[slot] < find_target(given, casts, slot);
}

/* Lets go what is at its target at the start. Its target is deeper by `parting` from then on, until it is seen clear of the
 * caller's: nothing that does not turn comes back from there, as separations are convex in time. What comes so deep before
 * hits at the start, which is looked at once more with a target that all have reached. */
static int let_go(const struct cast_call *call, narc_casts *casts, size_t slot, int outcome) {
    const narc_cast_batch *const given = call->given;
    const float looked = call->looked[slot % V_WIDTH], separation = casts->contact[slot].separation,
                depth = narc_float_or(given->depths, casts->pair[slot], INFINITY), enough = (float)casts->enough[slot],
                wanted = find_target(given, casts, slot), target = casts->target[slot];
    const bool is_gone = target < wanted;
    if (outcome == NARC_CAST_HIT && (is_gone || (target <= wanted && !(casts->time[slot] > 0)))) {
        const float deeper = (separation < depth ? separation : depth) - given->parting - enough;
        casts->target[slot] = is_gone ? FLT_MAX : deeper < wanted ? deeper : nextafterf(wanted, -INFINITY);
        casts->time[slot] = 0;
    } else if (is_gone && (outcome == NARC_CAST_MISS || (outcome == CAST_GOES_ON && casts->time[slot] >= looked)) &&
               separation > wanted + enough) {
        if (!(casts->moved[slot] > 0))
            return NARC_CAST_MISS;
        casts->target[slot] = wanted;
        casts->time[slot] = looked;
    } else
        return outcome;
    casts->rounds[slot] = 0;
    return CAST_GOES_ON;
}

/* What a step of a cast comes to by rules that are for it alone. */
NOINLINE int end_alone(const struct cast_call *call, narc_casts *casts, size_t slot, int outcome) {
    for (float target = NAN; target != casts->target[slot];) {
        target = casts->target[slot];
#if NARC_PIECES
        if (call->pieces)
            outcome = cast_pieces(call, casts, slot, outcome);
#endif
        if (call->lets_go)
            outcome = let_go(call, casts, slot, outcome);
    }
    return outcome;
}

/* Of casts k ... in some lanes: ends those that are done. */
NOINLINE void end_casts(struct cast_call *call, narc_casts *casts, size_t k, uint32_t lanes, int32_t *outcome) {
    const narc_cast_batch *const given = call->given;
    for (; lanes; lanes &= lanes - 1) {
        const size_t lane = (size_t)FIND_LOWEST(lanes), slot = k + lane;
        if (call->pieces || call->lets_go)
            outcome[lane] = end_alone(call, casts, slot, outcome[lane]);
        if (outcome[lane] == NARC_CAST_HIT || outcome[lane] == NARC_CAST_UNFINISHED) {
            write_row(given, casts, slot, outcome[lane]);
        } else if (outcome[lane] == CAST_GOES_ON) {
            if (given->nearest && is_late(given, casts, slot) && !(call->lets_go && is_let_go(given, casts, slot)))
                outcome[lane] = NARC_CAST_MISS;
        } else {
            call->skipped += outcome[lane] == CAST_BROKEN;
            if (!given->nearest)
                given->out[casts->pair[slot]] = (narc_impact){.pair = casts->pair[slot]};
        }
    }
}

/* Of casts k ..., in the lanes `live`: ends those that are done, and moves the others to `to`. Returns how many. */
INLINE size_t keep_casts(struct cast_call *call, narc_casts *casts, size_t k, vm live, vi outcome, size_t to) {
    const vi broken = vi_set(CAST_BROKEN);
    int32_t lane[V_WIDTH];
    const vm ended = vm_and_not(live, vi_lt(broken, outcome));
    const uint32_t lanes = call->pieces || call->lets_go || call->given->nearest ? vm_bits(live) : vm_bits(ended);
    if (lanes) {
        vi_store(lane, outcome);
        end_casts(call, casts, k, lanes, lane);
        outcome = vi_load(lane);
    }
    const vm on = vm_and(live, vi_lt(broken, outcome));
    const int count = COUNT_BITS(vm_bits(on));
    if (k == to && vm_bits(on) == vm_bits(vm_front(count)))
        return (size_t)count;
    const vp packing = vm_packing(on);
    UNROLL
    for (int f = 0; f < (int)(sizeof casts->single / sizeof casts->single[0]); f++)
        v_store(casts->single[f] + to, v_pack(packing, v_load(casts->single[f] + k)));
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const vl half = d_of_lanes(on, h);
        UNROLL
        for (int f = 0; f < (int)(sizeof casts->wide / sizeof casts->wide[0]); f++)
            d_store(casts->wide[f] + to, d_pack(half, d_load(casts->wide[f] + k + (size_t)h)));
        to += (size_t)COUNT_BITS(vm_bits(on) >> h & ((1u << D_WIDTH) - 1));
    }
    return (size_t)count;
}

/* ------------------------------------------------------------------------------------------------ the start */

INLINE void load_casts(const struct cast_call *call, const struct pair_indices *in, int k, narc_casts *casts, size_t to,
                       struct loaded *out) {
    const narc_cast_batch *const given = call->given;
    const struct sources *const from = &call->sources;
    const int32_t *const number = in->number + k, *const item[2] = {in->a + k, in->b + k},
                         *const shape[2] = {in->shape_a + k, in->shape_b + k};
    const narc_bodies *const sets[2] = {&from->a, &from->b};
    int32_t body[2][V_WIDTH]; /* the caller's numbers */
    vf angles = v_set(0);
    for (int side = 0; side < 2; side++) {
        struct narc_cast_side *const its = &casts->side[side];
        const narc_motions *const motions = given->motions[side];
        const struct placed_bodies bodies = load_placed_bodies(sets[side], call->layout[side], NULL, item[side]);
        const vi pairs = vi_load(number);
        vi_store(body[side], call->own ? vi_add(vi_add(pairs, pairs), vi_set(side)) : vi_load(item[side]));
        memcpy(its->shape + to, shape[side], V_WIDTH * sizeof(int32_t));
        v_store(its->cosine + to, bodies.rotation.x);
        v_store(its->sine + to, bodies.rotation.y);
        v_store(its->scale + to, bodies.scale);
        const vf angle = load_column_or(motions->angle, body[side], 0);
        angles = v_max(angles, v_abs(angle));
        v_store(its->angle + to, angle);
        v_store(out->motion_x[side], load_column_or(motions->x, body[side], 0));
        v_store(out->motion_y[side], load_column_or(motions->y, body[side], 0));
    }
    out->turn = vm_any(v_lt(v_set(0), angles));
    out->fine = vm_front(V_WIDTH);
    for (int side = 0; side < 2; side++) {
        load_outline(call->shapes, shape[side], out->turn, to, &casts->side[side], &out->outline[side]);
        out->fine = vm_and(out->fine, are_fine(&casts->side[side], to, &out->outline[side]));
    }
    load_forms(call->shapes, shape[0], shape[1], out);
    load_ways(&from->a, &from->b, &from->pairs, in, k, casts->x + to, casts->y + to);
    v_store(casts->target + to,
            load_column_or(given->targets, given->nearest && !given->depths.base ? item[0] : number, given->target));
    v_store(casts->rounds + to, v_set(0));
    memcpy(casts->pair + to, number, V_WIDTH * sizeof(int32_t));
    memcpy(casts->body + to, body[1], V_WIDTH * sizeof(int32_t));
}

/* Begins the next pairs at the first times at which bounding circles touch; those whose circles never meet, or that have
 * no answer, are done. */
NOINLINE void begin_casts(struct cast_call *call, size_t first, size_t count, narc_casts *casts) {
    struct pair_indices in;
    load_pairs(&call->sources, first, (int)count, true, &in);
    for (int k = 0; k < (int)count; k += V_WIDTH) {
        const size_t to = casts->count;
        float outcome[V_WIDTH];
        struct loaded loaded;
        load_casts(call, &in, k, casts, to, &loaded);
        if (NARC_PIECES && call->shapes->plane_count > 0)
            measure_planes(call->shapes, casts, to, &loaded);
        for (int h = 0; h < V_WIDTH; h += D_WIDTH)
            begin_half(call->given->tolerance, casts, to + (size_t)h, h, &loaded, outcome + h);
        begin_lines(call->shapes, casts, to, &loaded, outcome);
        if (NARC_PIECES && call->shapes->plane_count > 0)
            begin_at_planes(call->shapes, casts, to, &loaded, outcome);
        const vi found = vi_select(loaded.fine, vi_truncate(v_load(outcome)), vi_set(CAST_BROKEN));
        casts->count += keep_casts(call, casts, to, vm_front((int)count - k), found, to);
    }
}

/* ------------------------------------------------------------------------------------------------ places */

/* Places all bodies at their casts' times. */
NOINLINE void place_casts(narc_casts *casts) {
    for (size_t k = 0; k < casts->count; k += V_WIDTH) {
        const vm live = vm_front((int)(casts->count - k));
        const bool any_turns = vm_any(vm_and(live, find_turning(casts, k)));
        move_bodies(casts, k);
        for (size_t slot = k; any_turns && slot < k + V_WIDTH; slot += D_WIDTH) {
            const struct turning turning = load_turning(casts, slot);
            turn_bodies(casts, slot, &turning);
        }
        keep_rotations(casts, k);
    }
}

/* ------------------------------------------------------------------------------------------------ all */

/* Takes the contacts at the times of all casts and finds what they mean, and where to look next. Those that are done make
 * room. */
NOINLINE void advance_casts(struct cast_call *call, narc_casts *casts) {
    size_t kept = 0;
    for (size_t k = 0; k < casts->count; k += V_WIDTH) {
        const vm live = vm_front((int)(casts->count - k));
        const vm turning = find_turning(casts, k);
        const struct touch touch = load_contacts(casts->contact + k, live);
        const vm straight = vm_and_not(live, turning), turns = vm_and(live, turning);
        const bool any_turns = vm_any(turns);
        struct step step, turned;
        if (any_turns)
            advance_turns(call->shapes, casts, &touch, k, turns, &turned);
        if (any_turns && !vm_any(straight)) {
            step = turned;
        } else {
            advance_lines(casts, &touch, k, &step);
            if (any_turns)
                select_steps(straight, &step, &turned);
        }
        if (call->lets_go)
            v_store(call->looked, v_load(casts->time + k));
        v_store(casts->time + k, v_load(step.time));
        v_store(casts->rounds + k, v_load(step.rounds));
        const vi outcome = vi_truncate(v_load(step.outcome));
        kept += keep_casts(call, casts, k, live, vi_select(touch.known, outcome, vi_set(CAST_BROKEN)), kept);
    }
    casts->count = kept;
}

/* What the contact kernel reads of a side, whose positions are in two arrays. */
static narc_bodies view_side(const narc_casts *casts, int side, const float *x, const float *y) {
    const ptrdiff_t item = sizeof(float);
    return (narc_bodies){.count = CAST_SLOTS,
                         .x = {x, item, NARC_FLOAT32},
                         .y = {y, item, NARC_FLOAT32},
                         .cosine = {casts->cosine_now[side], item},
                         .sine = {casts->sine_now[side], item},
                         .scale = {casts->side[side].scale, item},
                         .shape = {casts->side[side].shape, item}};
}

static const narc_query all_rows = {.margin = INFINITY};

/* What touches at the times of casts `first` ...: a row each. */
NOINLINE void ask_contacts(const narc_shapes *shapes, narc_casts *casts, size_t first, size_t count) {
    static const float zeros[CAST_SLOTS];
    const narc_rows rows = {.base = (char *)&casts->contact[first], .stride = sizeof casts->contact[0]};
    size_t unused = 0;
    /* An initialiser would clear all of it. Its own sets are these, or the stack would have two more. */
    narc_batch batch;
    batch.filled[0] = view_side(casts, 0, zeros, zeros);
    batch.filled[1] = view_side(casts, 1, casts->x_now, casts->y_now);
    const narc_pairs pairs = {.count = CAST_SLOTS, .other_bodies = &batch.filled[1]};
    batch.shapes = shapes;
    batch.a = &batch.filled[0];
    batch.b = &batch.filled[1];
    batch.pairs = &pairs;
    batch.query = &all_rows;
    batch.first = 0;
    batch.count = batch.asked = CAST_SLOTS;
    batch.row_size = batch.more_at = 0;
    batch.of_casts = true;
    batch.flat_sine = 0;
    NARC_NAMED(contact)(&batch, first, count, &unused, &rows);
}

/* The same of a few casts, each by itself where that has an answer. */
NOINLINE void ask_few(const narc_cast_batch *given, narc_casts *casts) {
    const struct narc_cast_side *const a = &casts->side[0], *const b = &casts->side[1];
    narc_batch batch;
    batch.shapes = given->batch->shapes;
    batch.query = &all_rows;
    for (size_t k = 0; k < casts->count; k++) {
        const narc_body at[2] = {{0, 0, casts->cosine_now[0][k], casts->sine_now[0][k], a->scale[k], a->shape[k]},
                                 {casts->x_now[k], casts->y_now[k], casts->cosine_now[1][k], casts->sine_now[1][k],
                                  b->scale[k], b->shape[k]}};
        const narc_one_pair asked = {&batch, &at[0], &at[1], &casts->contact[k], INFINITY, (uint32_t)k, false};
        if (given->kernels->pair(&asked) < 0)
            ask_contacts(batch.shapes, casts, k, 1);
    }
}

size_t NARC_NAMED(casts)(const narc_cast_batch *given, size_t first, size_t end) {
    const narc_batch *const batch = given->batch;
    const bool few = end - first <= NARC_FEW; /* then looking at the layout takes longer than it saves */
    struct cast_call call;
    call.given = given;
    call.shapes = batch->shapes;
    call.sources.a = *batch->a; /* one by one: a copy of all would be made in another place first */
    call.sources.b = *batch->b;
    call.sources.pairs = *batch->pairs;
    call.sources.selection = batch->query->selection;
    call.layout[0] = few ? POSE_COLUMNS : find_pose_layout(batch->a);
    call.layout[1] = few ? POSE_COLUMNS : find_pose_layout(batch->b);
    call.own = narc_have_own_bodies(batch->pairs);
    call.pieces = NARC_PIECES && batch->shapes->piece_count > 0;
    call.lets_go = given->parting > 0;
    call.skipped = 0;
    narc_casts casts;
    casts.count = 0;
    casts.front_only = given->front_only;
    while (casts.count > 0 || first < end) {
        while (casts.count + CAST_GROUP <= CAST_SLOTS && first < end) {
            const size_t count = end - first < CAST_GROUP ? end - first : CAST_GROUP;
            begin_casts(&call, first, count, &casts);
            first += count;
        }
        place_casts(&casts);
        if (casts.count <= NARC_FEW)
            ask_few(given, &casts);
        else
            ask_contacts(batch->shapes, &casts, 0, casts.count);
        advance_casts(&call, &casts);
    }
    return call.skipped;
}
