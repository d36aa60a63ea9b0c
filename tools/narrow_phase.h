/* SPDX-License-Identifier: MIT
 *
 * narrow_phase.h - pairs of bodies put to the library by a method, timed, and compared with the exact answer.
 */
#ifndef NARC_TOOL_NARROW_PHASE_H
#define NARC_TOOL_NARROW_PHASE_H

#include "bodies.h"
#include "narc_methods.h"

typedef struct narrow_settings {
    narc_method method;
    float tolerance;     /* gjk; 0: the library's choice */
    unsigned iterations; /* gjk; 0: the library's choice */
    float margin;        /* +infinity: every pair; filters have none */
    narc_workers workers;
} narrow_settings;

enum { OUTCOME_COUNT = NARC_OUTCOME_NONE + 1 };

typedef struct narrow_result {
    narc_contact *contacts; /* none from a filter */
    size_t room;            /* for contacts */
    size_t contact_count;
    uint64_t *colliding; /* one bit for each pair, see pair_collides() */
    size_t colliding_count;
    size_t skipped;                 /* pairs without an answer: see narc_query.out_skipped */
    size_t missed, extra;           /* pairs that collide, or do not, and of which the method says otherwise */
    size_t outcomes[OUTCOME_COUNT]; /* pairs by narc_outcome */
    const char *call;               /* what was timed: the library's function */
    double seconds;                 /* of one call, the median of `runs` */
    int runs;
} narrow_result;

/* The method of this name; an error that lists all of them if there is none. */
narc_method find_method(const char *name);

/* Filters tell which pairs may collide, and find no contacts. */
bool is_filter(narc_method method);

/* Runs the method on all pairs. */
void run_narrow_phase(const narrow_settings *chosen, const narc_shapes *shapes, const body_list *bodies,
                      const pair_list *pairs, narrow_result *out_result);

/* Does pair number `index` collide, as the method finds it? */
bool pair_collides(const narrow_result *result, size_t index);

void free_narrow_result(narrow_result *result);

#endif
