/* SPDX-License-Identifier: MIT
 *
 * one_cast.c - the kernel of one time of impact by itself, with one lane: what casts.c does with many, in a straight line.
 * The pair kernel (sat/pair.c) tells what touches; where that leaves a pair to others, so is the cast, and so are pieces of
 * chains and what lets bodies go.
 */
#define NARC_ONE_PAIR
#undef NARC_SIMD
#ifdef __AVX2__
#define NARC_SIMD "simd/one.h"
#else
#define NARC_SIMD "simd/scalar.h"
#endif

#include "kernels.h"

/* What becomes of a cast. */
enum { UNANSWERED = -1, ANSWERED, SKIPPED };

#if NARC_SHORTCUTS && (defined(__SSE4_1__) || defined(__ARM_NEON))

#include <math.h>
#include <stdbool.h>

#include "base/vec2.inl"
#include "narc_scene.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "scene/cast_lines.inl"
#include "scene/cast_places.inl"
#include "scene/cast_start.inl"
#include "scene/cast_turns.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Begins a cast: it goes on, has missed, or is broken. */
INLINE int begin(const narc_one_cast *asked, narc_casts *casts, bool turns) {
    struct loaded loaded;
    float outcome[V_WIDTH];
    loaded.turn = turns;
    loaded.fine = vm_front(1);
    UNROLL
    for (int side = 0; side < 2; side++) {
        const narc_body *const body = asked->bodies[side];
        struct narc_cast_side *const its = &casts->side[side];
        its->shape[0] = body->shape;
        its->cosine[0] = body->cosine;
        its->sine[0] = body->sine;
        its->scale[0] = body->scale;
        its->angle[0] = turns ? asked->motions[side][2] : 0;
        loaded.motion_x[side][0] = asked->motions[side][0];
        loaded.motion_y[side][0] = asked->motions[side][1];
        loaded.shift_x[0] = loaded.shift_y[0] = 0; /* it is in the way */
        load_outline(asked->shapes, (const int32_t *)its->shape, turns, 0, its, &loaded.outline[side]);
        loaded.fine = vm_and(loaded.fine, are_fine(its, 0, &loaded.outline[side]));
    }
    casts->x[0] = asked->bodies[1]->x;
    casts->y[0] = asked->bodies[1]->y;
    casts->target[0] = asked->target;
    casts->back[0] = CAST_FREE;
    casts->rounds[0] = 0;
    begin_half(asked->tolerance, casts, 0, 0, &loaded, outcome);
    return vm_any(loaded.fine) ? (int)outcome[0] : CAST_BROKEN;
}

NOINLINE int begin_line(const narc_one_cast *asked, narc_casts *casts) { return begin(asked, casts, false); }

NOINLINE int begin_turn(const narc_one_cast *asked, narc_casts *casts) { return begin(asked, casts, true); }

static const narc_query all_rows = {.margin = INFINITY};

/* Takes what touches at the cast's times, until it ends. */
INLINE int follow(const narc_one_cast *asked, narc_casts *casts, narc_contact *contact, bool turns) {
    const vm live = vm_front(1);
    narc_batch batch; /* of which little is read */
    batch.shapes = asked->shapes;
    batch.query = &all_rows;
    narc_body *const b = asked->bodies[1];
    const narc_one_pair pair = {&batch, asked->bodies[0], b, contact, INFINITY, 0, false};
    int outcome = CAST_GOES_ON;
    struct both both;
    if (turns)
        both = load_both(casts);
    while (outcome == CAST_GOES_ON) {
        struct step step;
        move_bodies(casts, 0);
        b->x = (double)casts->x_now[0];
        b->y = (double)casts->y_now[0];
        if (turns)
            turn_both(casts, &both);
        UNROLL
        for (int side = 0; turns && side < 2; side++) {
            narc_body *const body = asked->bodies[side];
            body->cosine = casts->cosine_now[side][0];
            body->sine = casts->sine_now[side][0];
        }
        if (NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(&pair) <= 0)
            return UNANSWERED;
        const struct touch touch = load_contacts(contact, live);
        if (turns)
            advance_turns(asked->shapes, casts, &touch, 0, live, &step);
        else
            advance_lines(asked->shapes, casts, &touch, 0, live, &step);
        casts->time[0] = step.time[0];
        casts->back[0] = step.back[0];
        casts->rounds[0] = step.rounds[0];
        outcome = (int)step.outcome[0];
    }
    return outcome;
}

NOINLINE int follow_line(const narc_one_cast *asked, narc_casts *casts, narc_contact *contact) {
    return follow(asked, casts, contact, false);
}

NOINLINE int follow_turn(const narc_one_cast *asked, narc_casts *casts, narc_contact *contact) {
    return follow(asked, casts, contact, true);
}

int NARC_ISA_SYMBOL(narc_cast_, NARC_ISA_NAME)(const narc_one_cast *asked) {
    narc_casts casts;
    narc_contact contact;
    const bool turns = asked->motions[0][2] != 0 || asked->motions[1][2] != 0; /* a NaN does */
    int outcome = (turns ? begin_turn : begin_line)(asked, &casts);
    if (outcome == CAST_GOES_ON)
        outcome = (turns && vm_any(find_turning(&casts, 0)) ? follow_turn : follow_line)(asked, &casts, &contact);
    if (outcome == UNANSWERED)
        return UNANSWERED;
    if (outcome == NARC_CAST_HIT || outcome == NARC_CAST_UNFINISHED) {
        const struct impact impact = {asked->pair, asked->body, casts.time[0], outcome};
        write_impact(&impact, &contact, asked->nearest, asked->out_row);
    } else if (!asked->nearest) {
        *asked->out_row = (narc_impact){.pair = asked->pair};
    }
    return outcome == CAST_BROKEN ? SKIPPED : ANSWERED;
}

#else

int NARC_ISA_SYMBOL(narc_cast_, NARC_ISA_NAME)(const narc_one_cast *asked) {
    (void)asked;
    return UNANSWERED;
}

#endif
