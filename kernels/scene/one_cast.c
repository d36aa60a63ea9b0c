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

/* What becomes of a cast. STRAIGHT: what turns moves nothing by it. */
enum { UNANSWERED = -1, ANSWERED, SKIPPED, STRAIGHT };

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
        its->angle[0] = turns ? asked->motions[side]->angle : 0;
        loaded.motion_x[side][0] = asked->motions[side]->x;
        loaded.motion_y[side][0] = asked->motions[side]->y;
        load_outline(asked->shapes, (const int32_t *)its->shape, turns, 0, its, &loaded.outline[side]);
        loaded.fine = vm_and(loaded.fine, are_fine(its, 0, &loaded.outline[side]));
    }
    load_forms(asked->shapes, (const int32_t *)casts->side[0].shape, (const int32_t *)casts->side[1].shape, &loaded);
    casts->x[0] = asked->bodies[1]->x - asked->bodies[0]->x + 0; /* as ways of batches are */
    casts->y[0] = asked->bodies[1]->y - asked->bodies[0]->y + 0;
    casts->target[0] = asked->target;
    casts->rounds[0] = 0;
    begin_half(asked->tolerance, casts, 0, 0, &loaded, outcome);
    if (!turns)
        begin_lines(asked->shapes, casts, 0, &loaded, outcome);
    return vm_any(loaded.fine) ? (int)outcome[0] : CAST_BROKEN;
}

static const narc_query all_rows = {.margin = INFINITY};

/* Takes what touches at the cast's times, until it ends. */
INLINE int follow(const narc_one_cast *asked, narc_casts *casts, narc_contact *contact, bool turns) {
    const vm live = vm_front(1);
    narc_batch batch; /* of which little is read */
    batch.shapes = asked->shapes;
    batch.query = &all_rows;
    narc_body at[] = {*asked->bodies[0], *asked->bodies[1]};
    const narc_one_pair pair = {&batch, &at[0], &at[1], contact, INFINITY, 0, false};
    int outcome = CAST_GOES_ON;
    struct turning turning;
    at[0].x = at[0].y = 0;
    if (turns)
        turning = load_turning(casts, 0);
    while (outcome == CAST_GOES_ON) {
        struct step step;
        move_bodies(casts, 0);
        at[1].x = (double)casts->x_now[0];
        at[1].y = (double)casts->y_now[0];
        if (turns)
            turn_bodies(casts, 0, &turning);
        UNROLL
        for (int side = 0; turns && side < 2; side++)
            if (casts->side[side].angle[0] != 0) {
                at[side].cosine = casts->cosine_now[side][0];
                at[side].sine = casts->sine_now[side][0];
            }
        if (NARC_ISA_SYMBOL(narc_pair_, NARC_ISA_NAME)(&pair) <= 0)
            return UNANSWERED;
        const struct touch touch = load_contacts(contact, live);
        if (turns)
            advance_turns(asked->shapes, casts, &touch, 0, live, &step);
        else
            advance_lines(casts, &touch, 0, &step);
        casts->time[0] = step.time[0];
        casts->rounds[0] = step.rounds[0];
        outcome = (int)step.outcome[0];
    }
    return outcome;
}

/* A cast from its begin to its row. Nothing is given the address of what is under way, so that it stays in registers. */
INLINE int cast(const narc_one_cast *asked, bool turns) {
    narc_casts casts;
    narc_contact contact;
    int outcome = begin(asked, &casts, turns);
    if (turns && outcome == CAST_GOES_ON && !vm_any(find_turning(&casts, 0)))
        return STRAIGHT;
    if (outcome == CAST_GOES_ON)
        outcome = follow(asked, &casts, &contact, turns);
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

NOINLINE int cast_line(const narc_one_cast *asked) { return cast(asked, false); }

NOINLINE int cast_turn(const narc_one_cast *asked) { return cast(asked, true); }

int NARC_ISA_SYMBOL(narc_cast_, NARC_ISA_NAME)(const narc_one_cast *asked) {
    const bool turns = asked->motions[0]->angle != 0 || asked->motions[1]->angle != 0; /* a NaN does */
    const int answered = turns ? cast_turn(asked) : STRAIGHT;
    return answered == STRAIGHT ? cast_line(asked) : answered;
}

#else

int NARC_ISA_SYMBOL(narc_cast_, NARC_ISA_NAME)(const narc_one_cast *asked) {
    (void)asked;
    return UNANSWERED;
}

#endif
