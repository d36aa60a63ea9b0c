/* SPDX-License-Identifier: MIT
 *
 * ladder.h - fits that build on fits with an arc less, of a narrower family, or for another goal. Internal.
 */
#ifndef NARC_FIT_LADDER_H
#define NARC_FIT_LADDER_H

#include "solve/best.h"

/* What is fitted. */
typedef struct narc_rung {
    narc_fit_family family;
    narc_fit_goal goal;
    size_t count;
} narc_rung;

enum { LADDER_FAMILIES = 3, LADDER_GOALS = 5 };

/* The usual number of starts for n-arcs of least area with 8 arcs or less, where it is largest. */
enum { USUAL_STARTS = 56 };

typedef struct narc_ladder {
    const narc_hull *hull;
    double min_radius, max_radius; /* of arcs, in units of the hull's radius */
    unsigned starts;               /* 0: the usual number */
    bool quick;                    /* fewer, and less of each */
    bool fewest;            /* for a tolerance: what bounds builds on fewer arcs only if these were asked for, and
                                      other families are searched quickly */
    narc_fit_family family; /* the one that is asked for */
    unsigned round;         /* of searches from as many starts: each from other random ones */
    narc_progress *progress;
    narc_ranking *found[LADDER_FAMILIES][LADDER_GOALS][MAX_CHAIN + 1]; /* those that were searched for */
} narc_ladder;

/* How many pieces of work a fit takes that nothing was done for yet. */
size_t narc_plan_ladder(const narc_ladder *ladder, const narc_rung *rung);

/* The best chains for a rung, which stay until the ladder is cleared: found[0] is no worse than what the same ladder
 * finds with fewer arcs, or with a narrower family. Errors: those of narc_find_best(). */
narc_status narc_climb(narc_ladder *ladder, const narc_rung *rung, const narc_ranking **out_best, narc_error *error);

/* The value of the best chain that a rung finds from its own starts alone, which takes a small part of a climb;
 * and how many pieces of work that takes. */
narc_status narc_look_ahead(narc_ladder *ladder, const narc_rung *rung, double *out_value, narc_error *error);
size_t narc_plan_look(const narc_ladder *ladder, const narc_rung *rung);

void narc_clear_ladder(narc_ladder *ladder);

#endif
