/* SPDX-License-Identifier: MIT
 *
 * join.c - pieces joined again where that goes: cuts are made one at a time, and some are not needed in the end. Two humps
 * on either side of a body could be one piece across it, too: fewer parts, but slivers that cross, which nobody would draw.
 */
#include <stdlib.h>
#include <string.h>

#include "outline/vector.h"
#include "parts/cut.h"

/* Of more pieces than that no two are joined: it takes time with their square. */
enum { MOST_JOINED = 1000 };

/* How much of others' ground a joined piece may cover, in parts of its own; and what that weighs, a cell against one whose
 * emptiness is a cell's size: of joins that cover no empty ground those come first that lap least. */
static const double LARGEST_LAP = 1, LAP_WEIGHT = 1e-3;

/* What joining two pieces costs: the emptiness that their hull has and they have not, and a little for laps; INFINITY where
 * it is too far from the region, or laps too much. In a square of count by count, above the diagonal. */
typedef struct joining {
    const narc_region *region;
    narc_pieces *pieces;
    size_t count;                       /* at the beginning */
    double largest_lap, *own, *grounds; /* of pieces: emptiness, and ground of all that was joined */
    float *costs;
    size_t *partners;             /* with which each costs least */
    narc_point *points, *corners; /* room for those of all pieces, and one more */
} joining;

/* The hull of two pieces, into j->corners. */
static size_t wrap_pair(const joining *j, size_t a, size_t b) {
    const narc_piece *p = &j->pieces->items[a], *q = &j->pieces->items[b];
    memcpy(j->points, p->corners, p->count * sizeof *p->corners);
    memcpy(j->points + p->count, q->corners, q->count * sizeof *q->corners);
    return narc_wrap_points(j->points, p->count + q->count, j->corners);
}

static float *cost_of(const joining *j, size_t a, size_t b) {
    return &j->costs[a < b ? a * j->count + b : b * j->count + a];
}

static void measure_pair(joining *j, size_t a, size_t b) {
    const size_t count = wrap_pair(j, a, b);
    const double before = j->own[a] + j->own[b], ground = j->grounds[a] + j->grounds[b];
    double covered;
    const double emptiness = narc_measure_emptiness(j->region, j->corners, count, &covered);
    const double lap = fmax(0, covered - ground);
    *cost_of(j, a, b) = lap <= j->largest_lap * (ground + 1) && narc_may_be_within_limit(j->region, j->corners, count)
                            ? (float)(emptiness - before + LAP_WEIGHT * lap)
                            : INFINITY;
}

/* A piece that is gone has no corners. */
static void measure_pairs(joining *j, size_t a) {
    j->own[a] = narc_measure_emptiness(j->region, j->pieces->items[a].corners, j->pieces->items[a].count, NULL);
    for (size_t b = 0; b < j->count; b++)
        if (b != a && j->pieces->items[b].count)
            measure_pair(j, a, b);
}

static float cost_with_partner(const joining *j, size_t a) {
    const size_t b = j->partners[a];
    return j->pieces->items[a].count && j->pieces->items[b].count && a != b ? *cost_of(j, a, b) : INFINITY;
}

static void find_partner(joining *j, size_t a) {
    float least = INFINITY;
    j->partners[a] = a;
    for (size_t b = 0; b < j->count; b++) {
        if (b != a && j->pieces->items[b].count && *cost_of(j, a, b) < least) {
            least = *cost_of(j, a, b);
            j->partners[a] = b;
        }
    }
}

/* After a has changed, and b perhaps gone. */
static void update_partners(joining *j, size_t a, size_t b) {
    find_partner(j, a);
    find_partner(j, b);
    for (size_t k = 0; k < j->count; k++) {
        if (k == a || k == b || !j->pieces->items[k].count)
            continue;
        if (j->partners[k] == a || j->partners[k] == b)
            find_partner(j, k);
        else if (j->pieces->items[a].count && *cost_of(j, a, k) < cost_with_partner(j, k))
            j->partners[k] = a;
    }
}

static size_t find_cheapest(const joining *j) {
    size_t found = 0;
    for (size_t a = 1; a < j->count; a++)
        found = cost_with_partner(j, a) < cost_with_partner(j, found) ? a : found;
    return found;
}

/* The common hull takes the place of a. */
static bool join_pair(joining *j, size_t a, size_t b) {
    narc_piece *items = j->pieces->items;
    const size_t count = wrap_pair(j, a, b);
    if (!narc_is_within_limit(j->region, j->corners, count)) {
        *cost_of(j, a, b) = INFINITY;
        return true;
    }
    narc_point *corners = malloc(count * sizeof *corners);
    if (!corners)
        return false;
    memcpy(corners, j->corners, count * sizeof *corners);
    free(items[a].corners);
    free(items[b].corners);
    items[a] = (narc_piece){corners, count};
    items[b] = (narc_piece){0};
    j->grounds[a] += j->grounds[b];
    measure_pairs(j, a);
    return true;
}

/* While more than so many pieces are left; returns how many are, 0 where memory runs out. */
static size_t join_nearest(joining *j, double largest_lap, size_t most) {
    size_t left = 0;
    bool done = true;
    j->largest_lap = largest_lap;
    for (size_t a = 0; a < j->count; a++) {
        left += j->pieces->items[a].count > 0;
        for (size_t b = a + 1; b < j->count && j->pieces->items[a].count; b++)
            if (j->pieces->items[b].count)
                measure_pair(j, a, b);
    }
    for (size_t a = 0; a < j->count; a++)
        find_partner(j, a);
    for (size_t a; done && left > most && cost_with_partner(j, a = find_cheapest(j)) < INFINITY;) {
        const size_t b = j->partners[a];
        done = join_pair(j, a, b);
        update_partners(j, a, b);
        left -= j->pieces->items[b].count == 0;
    }
    return done ? left : 0;
}

narc_status narc_join_pieces(const narc_region *region, size_t most, narc_pieces *pieces) {
    joining j = {.region = region, .pieces = pieces, .count = pieces->count};
    if (j.count < 2 || j.count > MOST_JOINED)
        return NARC_OK;
    j.own = malloc(j.count * sizeof *j.own);
    j.grounds = malloc(j.count * sizeof *j.grounds);
    j.costs = malloc(j.count * j.count * sizeof *j.costs);
    j.partners = malloc(j.count * sizeof *j.partners);
    size_t corners = 1;
    for (size_t a = 0; a < j.count; a++)
        corners += pieces->items[a].count;
    j.points = malloc(corners * sizeof *j.points);
    j.corners = malloc(corners * sizeof *j.corners);
    const bool done = j.own && j.grounds && j.costs && j.partners && j.points && j.corners;
    for (size_t a = 0; done && a < j.count; a++)
        j.own[a] = narc_measure_emptiness(region, pieces->items[a].corners, pieces->items[a].count, &j.grounds[a]);
    size_t left = done ? join_nearest(&j, LARGEST_LAP, 1) : 0;
    if (left > most)
        left = join_nearest(&j, INFINITY, most);
    size_t kept = 0;
    for (size_t a = 0; a < j.count; a++) /* also where memory ran out */
        if (pieces->items[a].count)
            pieces->items[kept++] = pieces->items[a];
    pieces->count = kept;
    free(j.own);
    free(j.grounds);
    free(j.costs);
    free(j.partners);
    free(j.points);
    free(j.corners);
    return left ? NARC_OK : NARC_ERROR_MEMORY;
}
