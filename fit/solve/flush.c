/* SPDX-License-Identifier: MIT
 *
 * flush.c - least-area bounding polygons with flush sides, by dynamic programming.
 */
#include "solve/flush.h"

#include <stdlib.h>
#include <string.h>

#include "model/chain.h"
#include "outline/vector.h"

/* Sides that are left of the hull. The programme takes time in proportion to the cube of this. */
enum { MOST_SIDES = 56 };

struct line {
    narc_point normal;
    double angle, offset; /* normal.x = offset */
};

/* Where two lines meet, and whether that is outside the sides between them: they turn by less than a half turn. */
static bool meet(const struct line *a, const struct line *b, narc_point *out) {
    const double turn = cross(a->normal, b->normal);
    if (!(turn > 1e-9))
        return false;
    *out = (narc_point){(a->offset * b->normal.y - b->offset * a->normal.y) / turn,
                        (b->offset * a->normal.x - a->offset * b->normal.x) / turn};
    return true;
}

/* The area that is added when line k goes: between it and the lines on both sides of it. */
static double price(const struct line *lines, size_t count, size_t k) {
    const struct line *before = &lines[(k + count - 1) % count], *gone = &lines[k], *after = &lines[(k + 1) % count];
    narc_point start, end, tip;
    if (!meet(before, gone, &start) || !meet(gone, after, &end) || !meet(before, after, &tip))
        return INFINITY;
    return 0.5 * fabs(cross(minus(end, start), minus(tip, start)));
}

/* Again and again the line that costs least goes, until `most` are left or none can go. Only its neighbours' prices
 * change then. `prices` is room for one of each line. */
static size_t thin_lines(struct line *lines, double *prices, size_t count, size_t most) {
    for (size_t k = 0; k < count && count > most; k++)
        prices[k] = price(lines, count, k);
    while (count > most) {
        size_t best = 0;
        for (size_t k = 1; k < count; k++)
            best = prices[k] < prices[best] ? k : best;
        if (!isfinite(prices[best]))
            break;
        memmove(lines + best, lines + best + 1, (count - best - 1) * sizeof *lines);
        memmove(prices + best, prices + best + 1, (count - best - 1) * sizeof *prices);
        count--;
        const size_t before = (best + count - 1) % count, after = best % count;
        prices[before] = price(lines, count, before);
        prices[after] = price(lines, count, after);
    }
    return count;
}

struct pockets {
    size_t count;
    struct line lines[MOST_SIDES];
    double area[MOST_SIDES][MOST_SIDES]; /* between the sides i and j when they are extended until they meet */
};

static bool fill_pockets(struct pockets *pockets) {
    const size_t n = pockets->count;
    narc_point corners[MOST_SIDES]; /* corner k: where lines k - 1 and k meet */
    for (size_t k = 0; k < n; k++)
        if (!meet(&pockets->lines[(k + n - 1) % n], &pockets->lines[k], &corners[k]))
            return false;
    for (size_t i = 0; i < n; i++) {
        double outline = 0;
        for (size_t step = 1; step < n; step++) {
            const size_t j = (i + step) % n, first = (i + 1) % n;
            if (step > 1)
                outline += cross(corners[(j + n - 1) % n], corners[j]);
            narc_point tip;
            pockets->area[i][j] = INFINITY;
            if (meet(&pockets->lines[i], &pockets->lines[j], &tip))
                pockets->area[i][j] = 0.5 * (cross(corners[first], tip) + cross(tip, corners[j]) - outline);
        }
    }
    return true;
}

/* The best choice of `count` lines with the first of them given. */
static double choose_from(const struct pockets *pockets, size_t first, size_t count, size_t *out_chosen) {
    static const size_t none = MOST_SIDES;
    double cost[MAX_CHAIN][MOST_SIDES];
    size_t previous[MAX_CHAIN][MOST_SIDES];
    for (size_t c = 0; c < count; c++) {
        for (size_t j = 0; j < pockets->count; j++) {
            cost[c][j] = c == 0 && j == first ? 0 : INFINITY;
            previous[c][j] = none;
            for (size_t i = first; c > 0 && i < j; i++) {
                const double sum = cost[c - 1][i] + pockets->area[i][j];
                if (sum < cost[c][j]) {
                    cost[c][j] = sum;
                    previous[c][j] = i;
                }
            }
        }
    }
    double least = INFINITY;
    size_t last = none;
    for (size_t j = first + 1; j < pockets->count; j++) {
        const double sum = cost[count - 1][j] + pockets->area[j][first];
        if (sum < least) {
            least = sum;
            last = j;
        }
    }
    for (size_t c = count; last != none && c-- > 0; last = previous[c][last])
        out_chosen[c] = last;
    return least;
}

static size_t choose(const struct pockets *pockets, size_t count, double *out_angles) {
    double least = INFINITY;
    for (size_t first = 0; first + count <= pockets->count; first++) {
        size_t chosen[MAX_CHAIN];
        const double area = choose_from(pockets, first, count, chosen);
        if (area < least) {
            least = area;
            for (size_t c = 0; c < count; c++)
                out_angles[c] = pockets->lines[chosen[c]].angle;
        }
    }
    return isfinite(least) ? count : 0;
}

size_t narc_find_flush_polygon(const narc_hull *hull, size_t count, double *out_angles, bool *no_memory) {
    struct line *lines = malloc(hull->count * sizeof *lines);
    double *prices = malloc(hull->count * sizeof *prices);
    struct pockets *pockets = malloc(sizeof *pockets);
    size_t found = 0;
    *no_memory = *no_memory || !lines || !prices || !pockets;
    if (lines && prices && pockets && count >= 3) {
        for (size_t k = 0; k < hull->count; k++) {
            const narc_point d = hull->normals[k];
            lines[k] = (struct line){d, hull->angles[k], dot(d, hull->corners[k]) + hull->inflation};
        }
        pockets->count = thin_lines(lines, prices, hull->count, MOST_SIDES);
        if (pockets->count <= MOST_SIDES) {
            memcpy(pockets->lines, lines, pockets->count * sizeof *lines);
            found = fill_pockets(pockets) ? choose(pockets, count < pockets->count ? count : pockets->count, out_angles)
                                          : 0;
        }
    }
    free(lines);
    free(prices);
    free(pockets);
    return found;
}
