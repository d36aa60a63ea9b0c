/* SPDX-License-Identifier: MIT
 *
 * ladder.c - fits that build on others: each count of arcs on the one before, so that more arcs are never worse; arcs
 * with edges on arcs without and on edges alone; what bounds or differs least on what is closest.
 */
#include "solve/ladder.h"

#include <stdlib.h>

#include "error.h"
#include "outline/vector.h"

enum { MOST_NEEDS = 5, MOST_KNOWN = MOST_NEEDS * MOST_RANKED };

/* Closed chains of up to three arcs without edges are circles. */
static size_t least_count(narc_fit_family family) { return family == NARC_FIT_EDGES ? 2 : 3; }

/* Of the starts of 6 to 8 arcs a third or so ends at the best that is known, on hard outlines one in 50; exchanges
 * find it less often in the same time. n-arcs of least area have most: what else is fitted has known chains too.
 * Fewer arcs have fewer ways to be placed; and fewer starts of many arcs, whose searches take long. The first start, on
 * the sides of a bounding polygon, is always there: chains that only grow from fewer arcs stay behind it. */
enum { FEW_ARCS = 8, STARTS_OF_OTHERS = 36 };
static const size_t STARTS[FEW_ARCS + 1] = {8, 8, 8, 8, 12, 12, 24, 32, USUAL_STARTS};
static const size_t QUICK_STARTS[FEW_ARCS + 1] = {2, 2, 2, 4, 4, 4, 6, 6, 10};

static narc_effort choose_effort(const narc_ladder *ladder, const narc_rung *rung) {
    const size_t n = rung->count, starts = ladder->starts;
    if (starts)
        return (narc_effort){n <= MANY_ARCS ? starts : (starts + 3) / 4, .exchanges = 1, .round = ladder->round};
    if (ladder->quick || (ladder->fewest && rung->family != ladder->family))
        return (narc_effort){n <= FEW_ARCS ? QUICK_STARTS[n] : 1, .exchanges = n <= MANY_ARCS, .quick = true};
    const bool plain = rung->family == NARC_FIT_N_ARC && rung->goal == NARC_FIT_BOUND_AREA;
    const size_t most = plain ? USUAL_STARTS : STARTS_OF_OTHERS;
    return n <= FEW_ARCS    ? (narc_effort){.starts = STARTS[n] < most ? STARTS[n] : most, .exchanges = 1}
           : n <= MANY_ARCS ? (narc_effort){.starts = 2, .exchanges = 1}
                            : (narc_effort){.starts = 1};
}

/* The fits that one builds on. With many arcs and edges those of other families come too far behind to be worth the
 * time. */
static size_t list_needs(const narc_ladder *ladder, const narc_rung *rung, narc_rung *out) {
    size_t count = 0;
    if (rung->count > least_count(rung->family) && (!ladder->fewest || rung->goal != NARC_FIT_BOUND_DISTANCE ||
                                                    ladder->found[rung->family][rung->goal][rung->count - 1]))
        out[count++] = (narc_rung){rung->family, rung->goal, rung->count - 1};
    if (rung->goal == NARC_FIT_BOUND_DISTANCE || rung->goal == NARC_FIT_DIFFERENCE)
        out[count++] = (narc_rung){rung->family, NARC_FIT_DISTANCE, rung->count};
    if (rung->family == NARC_FIT_EDGES && rung->count <= MANY_ARCS) {
        out[count++] = (narc_rung){NARC_FIT_N_ARC, rung->goal, rung->count < 3 ? 3 : rung->count};
        if (rung->count >= 3 && ladder->min_radius == 0)
            out[count++] = (narc_rung){NARC_FIT_POLYGON, rung->goal, rung->count};
    }
    return count;
}

size_t narc_plan_look(const narc_ladder *ladder, const narc_rung *rung) {
    const narc_effort effort = choose_effort(ladder, rung);
    return narc_count_work(&effort) * rung->count;
}

static size_t plan(const narc_ladder *ladder, const narc_rung *rung, bool seen[][LADDER_GOALS][MAX_CHAIN + 1]) {
    bool *mine = &seen[rung->family][rung->goal][rung->count];
    if (*mine)
        return 0;
    *mine = true;
    size_t sum = narc_plan_look(ladder, rung);
    narc_rung needs[MOST_NEEDS];
    const size_t count = list_needs(ladder, rung, needs);
    for (size_t k = 0; k < count; k++)
        sum += plan(ladder, &needs[k], seen);
    return sum;
}

size_t narc_plan_ladder(const narc_ladder *ladder, const narc_rung *rung) {
    bool seen[LADDER_FAMILIES][LADDER_GOALS][MAX_CHAIN + 1] = {0};
    return plan(ladder, rung, seen);
}

/* Turns the chains of one fit into starts for another: a circle of three arcs becomes one of two, and the closest shape
 * is moved out so that it bounds. */
static size_t adapt(const narc_ranking *ranking, const narc_rung *source, const narc_rung *rung, narc_chain *out) {
    size_t count = 0;
    for (size_t k = 0; k < ranking->count; k++) {
        narc_chain *chain = &out[count++];
        *chain = ranking->items[k].chain;
        if (source->count > rung->count) {
            const double radius = chain->radius[0];
            *chain = (narc_chain){.count = 2, .start = chain->start, .angle = {0, PI}, .radius = {radius, radius}};
        }
        if (source->goal != rung->goal && rung->goal == NARC_FIT_BOUND_DISTANCE)
            narc_offset_chain(chain, ranking->items[k].value, rung->family == NARC_FIT_POLYGON);
    }
    return count;
}

static narc_problem state_problem(const narc_ladder *ladder, const narc_rung *rung) {
    return (narc_problem){ladder->hull, rung->family, rung->goal, rung->count, ladder->min_radius, ladder->max_radius};
}

/* Searches for a rung's chains from its own starts and from known ones. */
static narc_status search_rung(narc_ladder *ladder, const narc_rung *rung, const narc_chain *known, size_t known_count,
                               narc_ranking *out_best, narc_error *error) {
    narc_problem problem = state_problem(ladder, rung);
    narc_hull bare = *ladder->hull;
    if (!narc_must_bound(&problem)) {
        bare.inflation = 0;
        problem.hull = &bare;
    }
    const narc_effort effort = choose_effort(ladder, rung);
    ladder->progress->limit += narc_plan_look(ladder, rung);
    const narc_status status = narc_find_best(&problem, &effort, known, known_count, ladder->progress, out_best, error);
    ladder->progress->done = ladder->progress->limit;
    return status;
}

narc_status narc_climb(narc_ladder *ladder, const narc_rung *rung, const narc_ranking **out_best, narc_error *error) {
    narc_ranking **mine = &ladder->found[rung->family][rung->goal][rung->count];
    if (*mine) {
        *out_best = *mine;
        return NARC_OK;
    }
    narc_rung needs[MOST_NEEDS];
    narc_chain known[MOST_KNOWN];
    size_t known_count = 0;
    const narc_problem problem = state_problem(ladder, rung);
    const size_t need_count = list_needs(ladder, rung, needs);
    bool perfect = false; /* with an arc less: then more arcs, and other families, change nothing */
    for (size_t k = 0; k < need_count && !perfect; k++) {
        const narc_ranking *other;
        const narc_status status = narc_climb(ladder, &needs[k], &other, NULL);
        if (status == NARC_ERROR_MEMORY)
            return narc_fail(error, status, 0, 0, "not enough memory for chains of %zu arcs", needs[k].count);
        if (status == NARC_OK) {
            known_count += adapt(other, &needs[k], rung, known + known_count);
            perfect = needs[k].family == rung->family && needs[k].goal == rung->goal &&
                      narc_is_perfect(&problem, other->items[0].value);
        }
    }
    narc_ranking *ranking = malloc(sizeof *ranking);
    if (!ranking)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for chains of %zu arcs", rung->count);
    const narc_status status = search_rung(ladder, rung, known, known_count, ranking, error);
    if (status != NARC_OK) {
        free(ranking);
        return status;
    }
    *mine = ranking;
    *out_best = ranking;
    return NARC_OK;
}

narc_status narc_look_ahead(narc_ladder *ladder, const narc_rung *rung, double *out_value, narc_error *error) {
    narc_ranking ranking;
    const narc_status status = search_rung(ladder, rung, NULL, 0, &ranking, error);
    if (status == NARC_OK)
        *out_value = ranking.items[0].value;
    return status;
}

void narc_clear_ladder(narc_ladder *ladder) {
    for (int family = 0; family < LADDER_FAMILIES; family++) {
        for (int goal = 0; goal < LADDER_GOALS; goal++) {
            for (size_t count = 0; count <= MAX_CHAIN; count++) {
                free(ladder->found[family][goal][count]);
                ladder->found[family][goal][count] = NULL;
            }
        }
    }
}
