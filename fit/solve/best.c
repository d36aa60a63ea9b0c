/* SPDX-License-Identifier: MIT
 *
 * best.c - from many starts to the best chains: a linear programme for each set of normals, the local search from the
 * most promising ones, further from the best quarter, and then exchanges, in which one junction goes and another comes
 * somewhere else.
 */
#include "solve/best.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/vector.h"
#include "solve/starts.h"

/* Steps of quadratic programming and the gain that is worth another: from each start, from the best quarter, after an
 * exchange, and for the best. */
struct depth {
    unsigned steps;
    double gain;
};
static const struct depth FIRST = {60, 1e-7}, SECOND = {40, 1e-6}, EXCHANGE = {16, 1e-5}, LAST = {60, 1e-8};

/* Who has no hope to come before the best but so many that were found goes on no further: with this times the gain of
 * its last step, or less in a quick search, which also makes exchanges in the best chain alone. */
enum { RANKED_FIRST = 3, RANKED_SECOND = 2, RANKED_QUICK = 1 };
static const double HOPE = 300, QUICK_HOPE = 5;

/* Steps take time in proportion to the cube of the arcs or so: of more arcs there are fewer. */
static unsigned count_steps(struct depth depth, size_t arcs) {
    return arcs <= 8 ? depth.steps : (unsigned)((8 * depth.steps + arcs - 1) / arcs);
}

static void refine(narc_search *search, narc_candidate *item, struct depth depth, double target) {
    narc_refine(search, item, count_steps(depth, search->problem.count), depth.gain, target);
}

/* An exchange tries all pairs of a junction that seems needed least and an arc that seems to need another most, so many
 * of each, and goes on from the best few. The best few chains are treated so as long as it helps. */
enum { EXCHANGED = 5, EXCHANGE_SEARCHES = 2, EXCHANGERS = 3 };

/* Chains of fewer arcs are split in all places, others where another arc is wanted most. */
enum { SPLIT_EVERYWHERE = 8 };

/* Values that differ by less than this part are those of one chain, found twice. */
static const double SAME = 1e-7;

static size_t count_near(size_t starts) { return starts / 3 + 1; }
static size_t count_best(size_t starts) { return starts / 4 + 1; }

size_t narc_count_work(const narc_effort *effort) {
    return effort->starts + count_near(effort->starts) + count_best(effort->starts) +
           EXCHANGERS * EXCHANGE_SEARCHES * effort->exchanges + 1;
}

struct pool {
    size_t count, room;
    narc_candidate *items;
};

/* Keeps the best candidates, sorted, each value once. */
static void enter(struct pool *pool, const narc_candidate *entered) {
    size_t place = pool->count;
    while (place > 0 && pool->items[place - 1].value > entered->value)
        place--;
    const bool again = (place > 0 && entered->value <= pool->items[place - 1].value * (1 + SAME)) ||
                       (place < pool->count && pool->items[place].value <= entered->value * (1 + SAME));
    if (place < pool->count && again) {
        pool->items[place] = pool->items[place].value > entered->value ? *entered : pool->items[place];
        return;
    }
    if (place >= pool->room || again || !isfinite(entered->value))
        return;
    pool->count += pool->count < pool->room;
    memmove(&pool->items[place + 1], &pool->items[place], (pool->count - place - 1) * sizeof *pool->items);
    pool->items[place] = *entered;
}

/* Picks the places with the smallest marks (the largest, if the marks are negated). */
static size_t pick_least(const double *marks, size_t count, size_t wanted, size_t *out_places) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        size_t place = found;
        while (place > 0 && marks[out_places[place - 1]] > marks[k])
            place--;
        if (place < wanted) {
            found += found < wanted;
            memmove(&out_places[place + 1], &out_places[place], (found - place - 1) * sizeof *out_places);
            out_places[place] = k;
        }
    }
    return found;
}

/* A junction is needed little if the radii on both sides of it are alike, and no edge lies there. An arc wants another
 * junction if much of the space between shape and hull is in its sector, or where distance counts the largest. */
static void mark_places(narc_search *search, const narc_chain *chain, double *out_needs, double *out_wants) {
    const size_t n = chain->count, count = narc_make_profile(chain, search->problem.hull, search->intervals);
    memset(out_wants, 0, n * sizeof *out_wants);
    for (size_t k = 0; k < count; k++) {
        const narc_interval *interval = &search->intervals[k];
        const double farthest = fmax(fabs(interval->least.difference), fabs(interval->largest.difference));
        const double width = length(minus(interval->end, interval->start)) * (chain->radius[interval->arc] + 0.1);
        if (narc_is_distance(&search->problem))
            out_wants[interval->arc] = fmin(out_wants[interval->arc], -farthest);
        else
            out_wants[interval->arc] -= width * fabs(interval->least.difference + interval->largest.difference);
    }
    for (size_t i = 0; i < n; i++) {
        const size_t before = (i + n - 1) % n;
        const double here =
            fmin(narc_end_angle(chain, i) - chain->angle[i], narc_end_angle(chain, before) - chain->angle[before]);
        out_needs[i] = (fabs(chain->radius[i] - chain->radius[before]) + chain->edge[i]) * here;
    }
}

/* The normals without junction `gone`, and with one in the middle of arc `split`. False if a sector gets too wide. */
static bool exchange(const narc_chain *chain, double widest, size_t gone, size_t split, double *out_angles) {
    const size_t n = chain->count, before = (gone + n - 1) % n;
    if (narc_end_angle(chain, gone) - chain->angle[before] + (gone ? 0 : 2 * PI) > widest || split == gone ||
        split == before)
        return false;
    size_t count = 0;
    for (size_t k = 0; k < n; k++) {
        if (k != gone)
            out_angles[count++] = chain->angle[k];
        if (k == split)
            out_angles[count++] = 0.5 * (chain->angle[k] + narc_end_angle(chain, k));
    }
    return true;
}

/* Tries exchanges once; true if one of them made the candidate better. */
static bool try_exchanges(narc_search *search, narc_candidate *best) {
    double needs[MAX_CHAIN], wants[MAX_CHAIN], angles[MAX_CHAIN];
    size_t gone[EXCHANGED], split[EXCHANGED];
    mark_places(search, &best->chain, needs, wants);
    const size_t goers = pick_least(needs, search->problem.count, EXCHANGED, gone);
    const size_t splits = pick_least(wants, search->problem.count, EXCHANGED, split);
    narc_candidate room[EXCHANGE_SEARCHES];
    struct pool promising = {.room = EXCHANGE_SEARCHES, .items = room};
    for (size_t g = 0; g < goers; g++) {
        for (size_t s = 0; s < splits; s++) {
            narc_candidate next;
            if (exchange(&best->chain, narc_widest_sweep(&search->problem), gone[g], split[s], angles) &&
                narc_fit_normals(search, angles, &next))
                enter(&promising, &next);
        }
    }
    const double value = best->value;
    for (size_t k = 0; k < promising.count; k++) {
        refine(search, &promising.items[k], EXCHANGE, value);
        if (promising.items[k].value < best->value)
            *best = promising.items[k];
        if (!narc_advance(search->progress, search->problem.count))
            return false;
    }
    return best->value < value * (1 - EXCHANGE.gain);
}

/* Solves a linear programme for more sets of normals than the pool has room for, and for many more where they end in
 * the same chains, as they do for a symmetric outline. */
static bool enter_starts(narc_search *search, uint64_t round, struct pool *pool) {
    const size_t usual = 3 * pool->room / 2 + (search->problem.count > MANY_ARCS ? 2 : 12);
    narc_start_list starts = {.room = 3 * usual};
    starts.angles = malloc(starts.room * sizeof *starts.angles);
    if (!starts.angles)
        return false;
    narc_list_starts(&search->problem, round, &starts);
    for (size_t k = 0; k < starts.count && (k < usual || pool->count < pool->room); k++) {
        narc_candidate next;
        if (narc_fit_normals(search, starts.angles[k], &next))
            enter(pool, &next);
    }
    free(starts.angles);
    return !starts.no_memory;
}

/* The same shape with arc `split` in two halves. */
static narc_chain split_arc(const narc_chain *chain, size_t split) {
    narc_chain result = {.count = chain->count + 1, .start = chain->start};
    for (size_t k = 0; k < result.count; k++) {
        const size_t source = k <= split ? k : k - 1;
        result.angle[k] =
            k == split + 1 ? 0.5 * (chain->angle[split] + narc_end_angle(chain, split)) : chain->angle[source];
        result.radius[k] = chain->radius[source];
        result.edge[k] = k == split + 1 ? 0 : chain->edge[source];
    }
    narc_place_chain(&result);
    return result;
}

/* A chain counts as it is, and is a start. */
static void enter_whole(narc_search *search, const narc_chain *known, struct pool *pool, struct pool *best) {
    narc_candidate next = {.chain = *known};
    narc_place_chain(&next.chain);
    next.value = narc_settle(search, &next.chain);
    enter(best, &next);
    enter(pool, &next);
}

/* A chain with an arc less counts as it is, with any arc in two halves; linear programmes with such normals are
 * starts. */
static void enter_splits(narc_search *search, const narc_chain *known, struct pool *pool, struct pool *best) {
    double needs[MAX_CHAIN], wants[MAX_CHAIN];
    size_t splits[MAX_CHAIN + 1];
    mark_places(search, known, needs, wants);
    size_t count = pick_least(wants, known->count, known->count < SPLIT_EVERYWHERE ? known->count : EXCHANGED, splits);
    double sweep;
    splits[count++] = narc_find_widest(known->angle, known->count, &sweep);
    for (size_t k = 0; k < count; k++) {
        if (narc_end_angle(known, splits[k]) - known->angle[splits[k]] < 4 * LEAST_SWEEP)
            continue;
        const narc_chain chain = split_arc(known, splits[k]);
        narc_candidate next = {.chain = chain};
        next.value = narc_settle(search, &next.chain);
        enter(best, &next);
        if (!search->progress->cancelled && narc_improve(search, &chain, &next))
            enter(pool, &next);
    }
}

static bool refine_all(narc_search *search, struct pool *source, struct depth depth, size_t rank, struct pool *target) {
    for (size_t k = 0; k < source->count; k++) {
        refine(search, &source->items[k], depth, target->count > rank ? target->items[rank].value : INFINITY);
        enter(target, &source->items[k]);
        if (!narc_advance(search->progress, search->problem.count))
            return false;
    }
    return true;
}

static void exchange_best(narc_search *search, const narc_effort *effort, struct pool *best) {
    const size_t exchangers = effort->quick ? 1 : EXCHANGERS;
    for (size_t k = 0; k < exchangers && k < best->count && search->problem.count > 3; k++) {
        narc_candidate item = best->items[k];
        for (size_t round = 0; round < effort->exchanges && try_exchanges(search, &item); round++) {
        }
        enter(best, &item);
    }
}

bool narc_is_perfect(const narc_problem *problem, double value) {
    const narc_hull *hull = problem->hull;
    return problem->goal == NARC_FIT_BOUND_AREA        ? value <= hull->area * (1 + SAME)
           : problem->goal == NARC_FIT_BOUND_PERIMETER ? value <= hull->perimeter * (1 + SAME)
                                                       : value <= SAME;
}

/* `items`: room for all pools but the last, which is the ranking. */
static bool search_all(narc_search *search, const narc_effort *effort, const narc_chain *known, size_t known_count,
                       narc_candidate *items, struct pool *best) {
    struct pool first = {.room = effort->starts, .items = items};
    struct pool near = {.room = count_near(effort->starts), .items = first.items + first.room};
    struct pool second = {.room = count_best(effort->starts), .items = near.items + near.room};
    const size_t ranked = effort->quick ? RANKED_QUICK : RANKED_FIRST;
    for (size_t k = 0; k < known_count; k++)
        (known[k].count == search->problem.count ? enter_whole : enter_splits)(search, &known[k], &near, best);
    if (best->count && narc_is_perfect(&search->problem, best->items[0].value))
        return true;
    if (!search->progress->cancelled && first.room && !enter_starts(search, effort->round, &first))
        return false;
    if (!search->progress->cancelled && refine_all(search, &near, FIRST, ranked, &second) &&
        refine_all(search, &first, FIRST, ranked, &second) &&
        refine_all(search, &second, SECOND, effort->quick ? RANKED_QUICK : RANKED_SECOND, best))
        exchange_best(search, effort, best);
    for (size_t k = 0; k < second.count; k++) /* what a cancelled search has found so far */
        enter(best, &second.items[k]);
    if (!search->progress->cancelled && best->count) {
        narc_candidate last = best->items[0];
        refine(search, &last, LAST, INFINITY);
        enter(best, &last);
        narc_advance(search->progress, search->problem.count);
    }
    return true;
}

narc_status narc_find_best(const narc_problem *problem, const narc_effort *effort, const narc_chain *known,
                           size_t known_count, narc_progress *progress, narc_ranking *out_best, narc_error *error) {
    narc_search search;
    const narc_status status = narc_open_search(&search, problem, progress, error);
    if (status != NARC_OK)
        return status;
    search.hope = effort->quick ? QUICK_HOPE : HOPE;
    narc_candidate *items =
        malloc((effort->starts + count_near(effort->starts) + count_best(effort->starts)) * sizeof *items);
    struct pool best = {.room = MOST_RANKED, .items = out_best->items};
    const bool searched = items && search_all(&search, effort, known, known_count, items, &best);
    free(items);
    narc_close_search(&search);
    out_best->count = best.count;
    if (!searched)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu starts", effort->starts);
    if (best.count)
        return NARC_OK;
    return progress->cancelled
               ? narc_fail(error, NARC_ERROR_CANCELLED, 0, 0, "the fit was ended before it found a shape")
               : narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, (double)problem->count, "no shape with %zu arcs was found",
                           problem->count);
}
