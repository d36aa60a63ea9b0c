/* SPDX-License-Identifier: MIT
 *
 * cast_fields.inl - casts under way: their fields, which move together.
 */
#ifndef NARC_SCENE_CAST_FIELDS_INL
#define NARC_SCENE_CAST_FIELDS_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels.h"
#include "narc_pairs.h"
#include "narc_scene.h"
#include "store.h"

/* So many casts are under way at a time, whole vectors: what fits on the stack beside the queues of the contact kernel.
 * So many begin at once, so that whoever looks for the nearest has them in the same order on every instruction set. */
#ifdef NARC_ONE_PAIR
enum { CAST_SLOTS = 1, CAST_GROUP = 1 };
#else
enum { CAST_SLOTS = 48, CAST_GROUP = 16 };
#endif

/* What a step of a cast may come to, beside NARC_CAST_...: it has no answer; it goes on. */
enum { CAST_BROKEN = 3, CAST_GOES_ON = 4 };

/* Of one body of each cast: its shape, that one's first arc and info (base/shape.inl); how it is at the start, a unit
 * vector but for rounding; and the angle by which it turns in the step, 0 if that moves nothing. */
struct narc_cast_side {
    uint32_t shape[CAST_SLOTS];
    float record[CAST_SLOTS], info[CAST_SLOTS]; /* bits of integers */
    float cosine[CAST_SLOTS], sine[CAST_SLOTS], scale[CAST_SLOTS], angle[CAST_SLOTS];
};

/* Times are floats, rounded down: a place at a time is exact, and the caller's own. */
typedef struct narc_casts {
    union {
        struct {
            double x[CAST_SLOTS], y[CAST_SLOTS];               /* B's position at the start, from A's */
            double motion_x[CAST_SLOTS], motion_y[CAST_SLOTS]; /* B's against A's */
            double end[CAST_SLOTS];                            /* nothing touches then or later */
            double enough[CAST_SLOTS]; /* a separation that is so much above the target is a hit */
            double moved[CAST_SLOTS];  /* by how much turning moves the outlines, at most; 0: nothing turns */
        };
        double wide[7][CAST_SLOTS];
    };
    union {
        struct {
            struct narc_cast_side side[2]; /* A, B */
            float target[CAST_SLOTS]; /* the caller's; below that where it is let go, and above at the end of that */
            float time[CAST_SLOTS];   /* where it is now */
            float rounds[CAST_SLOTS]; /* contacts so far */
            uint32_t pair[CAST_SLOTS], body[CAST_SLOTS]; /* its number, and that of B */
        };
        float single[19][CAST_SLOTS];
    };
    /* What does not move: where they are at their times, A at the origin, and what touches there. */
    float x_now[CAST_SLOTS], y_now[CAST_SLOTS], cosine_now[2][CAST_SLOTS], sine_now[2][CAST_SLOTS];
    double turned_x[2][CAST_SLOTS], turned_y[2][CAST_SLOTS];
    narc_contact contact[CAST_SLOTS];
    size_t count;
    bool front_only; /* the caller's */
} narc_casts;
_Static_assert(sizeof((narc_casts *)NULL)->wide == offsetof(narc_casts, single) &&
                   sizeof((narc_casts *)NULL)->single == offsetof(narc_casts, x_now) - offsetof(narc_casts, single),
               "all fields move");

#if NARC_PIECES
/* What becomes of one cast with a concave arc, or from where it meets a run's closure (piece_casts.c). Time and contact
 * are then the answer's. `wanted`: the caller's target, which counts again where one that is let go comes clear of it. */
int NARC_NAMED(piece)(const narc_shapes *shapes, narc_casts *casts, size_t slot, float wanted);
#endif

#endif
