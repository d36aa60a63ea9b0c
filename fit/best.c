/* SPDX-License-Identifier: MIT
 *
 * best.c - from many starts to the best chain: a linear programme for each set of normals, the local search from the
 * most promising ones, and then exchanges, in which one junction goes and another comes somewhere else.
 */
#include "best.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "starts.h"
#include "vector.h"

/* Rounds of quadratic programming: from each start fewer the more they cost, for the few best as many as help. */
enum { LAST_ROUNDS = 10 };
static unsigned count_rounds(const problem *of) {
    return 1 + (of->family == NARC_FIT_POLYGON ? 64 : 16) / (unsigned)of->count;
}

/* An exchange tries all pairs of so many junctions that seem needed least and arcs that seem to need another most, and
 * goes on from the best few. That is done with the best few finalists, as long as it helps. */
enum { EXCHANGED = 5, EXCHANGE_SEARCHES = 2, EXCHANGERS = 2 };

bool narc_advance(progress *of) {
    of->done += of->done < of->total;
    of->cancelled = of->cancelled || (of->tell && !of->tell(of->done, of->total, of->context));
    return !of->cancelled;
}

static unsigned count_exchanges(unsigned starts) { return starts / 3; }

size_t narc_count_work(unsigned starts) {
    return starts + (size_t)EXCHANGE_SEARCHES * EXCHANGERS * count_exchanges(starts) + 1;
}

typedef struct finalists {
    size_t count, room;
    candidate *items;
} finalists;

/* Keeps the best candidates, sorted. */
static void enter(finalists *in, const candidate *entered) {
    size_t place = in->count;
    while (place > 0 && in->items[place - 1].value > entered->value) {
        place--;
    }
    if (place >= in->room) {
        return;
    }
    in->count += in->count < in->room;
    memmove(&in->items[place + 1], &in->items[place], (in->count - place - 1) * sizeof *in->items);
    in->items[place] = *entered;
}

static void take_better(candidate *best, const candidate *other) {
    if (other->value < best->value) {
        *best = *other;
    }
}

static int compare_candidates(const void *left, const void *right) {
    const candidate *a = left, *b = right;
    return (a->value > b->value) - (a->value < b->value);
}

/* The places with the least (or, negated, largest) marks. */
static size_t pick_least(const double *marks, size_t count, size_t wanted, size_t *out_places) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        size_t place = found;
        while (place > 0 && marks[out_places[place - 1]] > marks[k]) {
            place--;
        }
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
static void mark_places(search *with, const chain *at, double *out_needs, double *out_wants) {
    const size_t n = at->count, count = narc_make_profile(at, with->of.around, 0, with->intervals);
    memset(out_wants, 0, n * sizeof *out_wants);
    for (size_t k = 0; k < count; k++) {
        const interval *in = &with->intervals[k];
        const double farthest = fmax(fabs(in->least.difference), fabs(in->largest.difference));
        const double width = length(minus(in->to, in->from)) * (at->radius[in->arc] + 0.1);
        if (narc_is_distance(&with->of)) {
            out_wants[in->arc] = fmin(out_wants[in->arc], -farthest);
        } else {
            out_wants[in->arc] -= width * fabs(in->least.difference + in->largest.difference);
        }
    }
    for (size_t i = 0; i < n; i++) {
        const size_t before = (i + n - 1) % n;
        const double here = fmin(narc_end_angle(at, i) - at->angle[i], narc_end_angle(at, before) - at->angle[before]);
        out_needs[i] = (fabs(at->radius[i] - at->radius[before]) + at->edge[i]) * here;
    }
}

/* The normals without junction `gone`, and with one in the middle of arc `split`. False if a sector gets too wide. */
static bool exchange(const chain *at, double widest, size_t gone, size_t split, double *out_angles) {
    const size_t n = at->count, before = (gone + n - 1) % n;
    if (narc_end_angle(at, gone) - at->angle[before] + (gone ? 0 : 2 * PI) > widest || split == gone ||
        split == before) {
        return false;
    }
    size_t count = 0;
    for (size_t k = 0; k < n; k++) {
        if (k != gone) {
            out_angles[count++] = at->angle[k];
        }
        if (k == split) {
            out_angles[count++] = 0.5 * (at->angle[k] + narc_end_angle(at, k));
        }
    }
    return true;
}

/* Tries exchanges once; true if one of them made the candidate better. */
static bool try_exchanges(search *with, candidate *best, progress *work) {
    double needs[MAX_CHAIN], wants[MAX_CHAIN], angles[MAX_CHAIN];
    size_t gone[EXCHANGED], split[EXCHANGED];
    mark_places(with, &best->form, needs, wants);
    const size_t goers = pick_least(needs, with->of.count, EXCHANGED, gone);
    const size_t splits = pick_least(wants, with->of.count, EXCHANGED, split);
    candidate room[EXCHANGE_SEARCHES];
    finalists promising = {.room = EXCHANGE_SEARCHES, .items = room};
    for (size_t g = 0; g < goers; g++) {
        for (size_t s = 0; s < splits; s++) {
            candidate next;
            if (exchange(&best->form, narc_widest_sweep(&with->of), gone[g], split[s], angles) &&
                narc_fit_normals(with, angles, &next)) {
                enter(&promising, &next);
            }
        }
    }
    const double value = best->value;
    for (size_t k = 0; k < EXCHANGE_SEARCHES; k++) {
        if (k < promising.count) {
            narc_refine(with, &promising.items[k], count_rounds(&with->of));
            take_better(best, &promising.items[k]);
        }
        if (!narc_advance(work)) {
            return false;
        }
    }
    return best->value < value * (1 - 1e-5);
}

/* A linear programme for each of twice as many sets of normals as there may be finalists. */
static bool enter_starts(search *with, finalists *in) {
    start_list starts = {.room = 2 * in->room + 12};
    starts.angles = malloc(starts.room * sizeof *starts.angles);
    if (!starts.angles) {
        return false;
    }
    narc_list_starts(&with->of, &starts);
    for (size_t k = 0; k < starts.count; k++) {
        candidate next;
        if (narc_fit_normals(with, starts.angles[k], &next)) {
            enter(in, &next);
        }
    }
    free(starts.angles);
    return true;
}

/* Chains that were found otherwise count as they are, and after the local search. */
static void try_known(search *with, const chain *known, size_t count, const progress *work, candidate *best) {
    for (size_t k = 0; k < count; k++) {
        candidate next = {.form = known[k]};
        narc_place_chain(&next.form);
        next.value = narc_settle(with, &next.form);
        take_better(best, &next);
        if (!work->cancelled) {
            narc_refine(with, &next, count_rounds(&with->of));
            take_better(best, &next);
        }
    }
}

narc_status narc_find_best(const problem *of, unsigned starts, const chain *known, size_t known_count, progress *work,
                           candidate *out_best, narc_error *error) {
    search with;
    const narc_status status = narc_open_search(&with, of, error);
    if (status != NARC_OK) {
        return status;
    }
    finalists promising = {.room = starts, .items = malloc(starts * sizeof *promising.items)};
    if (!promising.items || !(work->cancelled || enter_starts(&with, &promising))) {
        free(promising.items);
        narc_close_search(&with);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %u starts", starts);
    }
    candidate best = {.value = INFINITY};
    try_known(&with, known, known_count, work, &best);
    bool going = !work->cancelled;
    for (size_t k = 0; k < promising.count && going; k++) {
        narc_refine(&with, &promising.items[k], count_rounds(of));
        going = narc_advance(work);
    }
    if (promising.count) {
        qsort(promising.items, promising.count, sizeof *promising.items, compare_candidates);
    }
    for (size_t k = 0; k < promising.count && k < EXCHANGERS; k++) {
        candidate *item = &promising.items[k];
        for (unsigned round = 0; round < count_exchanges(starts) && going && of->count > 3; round++) {
            going = try_exchanges(&with, item, work) && !work->cancelled;
        }
        going = !work->cancelled;
        if (going) {
            narc_refine(&with, item, LAST_ROUNDS);
        }
        take_better(&best, item);
    }
    if (isfinite(best.value) && !work->cancelled) {
        narc_refine(&with, &best, LAST_ROUNDS);
    }
    free(promising.items);
    narc_close_search(&with);
    if (!isfinite(best.value)) {
        return work->cancelled
                   ? narc_fail(error, NARC_ERROR_CANCELLED, 0, 0, "the fit was ended before it found a shape")
                   : narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, (double)of->count, "no shape with %zu arcs was found",
                               of->count);
    }
    *out_best = best;
    return NARC_OK;
}
