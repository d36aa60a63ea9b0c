/* SPDX-License-Identifier: MIT
 *
 * best.h - the best chains over all starts. Internal.
 */
#ifndef NARC_FIT_BEST_H
#define NARC_FIT_BEST_H

#include "solve/search.h"

/* The best chains that were found, the best first, no two of the same value. */
enum { MOST_RANKED = 3 };
typedef struct narc_ranking {
    size_t count;
    narc_candidate items[MOST_RANKED];
} narc_ranking;

/* With more arcs than this a fit takes so long that searches do less. */
enum { MANY_ARCS = 12 };

/* How much a search does. */
typedef struct narc_effort {
    size_t starts;    /* sets of normals, of chains with an arc less, that the local search sets out from */
    size_t exchanges; /* in a row, from each of the best few */
    uint64_t round;   /* which random sets of normals */
    bool quick;       /* only what is nearest to the best goes on */
} narc_effort;

/* The most pieces of work that narc_find_best() counts. */
size_t narc_count_work(const narc_effort *effort);

/* Is a value the hull's own, which no shape betters? */
bool narc_is_perfect(const narc_problem *problem, double value);

/* Searches from many starts and from known chains, which have as many arcs or one less. Of those with one less, each
 * arc is split in turn. The best is no worse than any known chain. NARC_ERROR_NO_SOLUTION: nothing was found.
 * NARC_ERROR_CANCELLED: nothing was found before the caller ended it. NARC_ERROR_MEMORY. */
narc_status narc_find_best(const narc_problem *problem, const narc_effort *effort, const narc_chain *known,
                           size_t known_count, narc_progress *progress, narc_ranking *out_best, narc_error *error);

#endif
