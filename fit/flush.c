/* SPDX-License-Identifier: MIT
 *
 * flush.c - least-area bounding polygons with flush sides, by dynamic programming.
 */
#include "flush.h"

#include <stdlib.h>
#include <string.h>

#include "chain.h"
#include "vector.h"

/* Sides that are left of the hull. The programme takes time in proportion to the cube of this. */
enum { MOST_SIDES = 56 };

typedef struct line {
    narc_point normal;
    double angle, offset; /* normal.x = offset */
} line;

/* Where two lines meet, and whether that is outside the sides between them: they turn by less than a half turn. */
static bool meet(const line *a, const line *b, narc_point *out) {
    const double turn = cross(a->normal, b->normal);
    if (!(turn > 1e-9)) {
        return false;
    }
    *out = (narc_point){(a->offset * b->normal.y - b->offset * a->normal.y) / turn,
                        (b->offset * a->normal.x - a->offset * b->normal.x) / turn};
    return true;
}

/* The area that is added when the line between two others goes. */
static double price(const line *before, const line *gone, const line *after) {
    narc_point start, end, tip;
    if (!meet(before, gone, &start) || !meet(gone, after, &end) || !meet(before, after, &tip)) {
        return INFINITY;
    }
    return 0.5 * fabs(cross(minus(end, start), minus(tip, start)));
}

/* Again and again the line that costs least goes, until `most` are left or none can go. */
static size_t thin_lines(line *lines, size_t count, size_t most) {
    while (count > most) {
        double least = INFINITY;
        size_t best = 0;
        for (size_t k = 0; k < count; k++) {
            const double cost = price(&lines[(k + count - 1) % count], &lines[k], &lines[(k + 1) % count]);
            if (cost < least) {
                least = cost;
                best = k;
            }
        }
        if (!isfinite(least)) {
            break;
        }
        memmove(lines + best, lines + best + 1, (count - best - 1) * sizeof *lines);
        count--;
    }
    return count;
}

typedef struct pockets {
    size_t count;
    line lines[MOST_SIDES];
    double area[MOST_SIDES][MOST_SIDES]; /* between the sides i and j when they are extended until they meet */
} pockets;

static bool fill_pockets(pockets *of) {
    const size_t n = of->count;
    narc_point corners[MOST_SIDES]; /* corner k: where lines k - 1 and k meet */
    for (size_t k = 0; k < n; k++) {
        if (!meet(&of->lines[(k + n - 1) % n], &of->lines[k], &corners[k])) {
            return false;
        }
    }
    for (size_t i = 0; i < n; i++) {
        double outline = 0;
        for (size_t step = 1; step < n; step++) {
            const size_t j = (i + step) % n, first = (i + 1) % n;
            if (step > 1) {
                outline += cross(corners[(j + n - 1) % n], corners[j]);
            }
            narc_point tip;
            of->area[i][j] = INFINITY;
            if (meet(&of->lines[i], &of->lines[j], &tip)) {
                of->area[i][j] = 0.5 * (cross(corners[first], tip) + cross(tip, corners[j]) - outline);
            }
        }
    }
    return true;
}

/* The best choice of `count` lines with the first of them given. */
static double choose_from(const pockets *of, size_t first, size_t count, size_t *out_chosen) {
    static const size_t none = MOST_SIDES;
    double cost[MAX_CHAIN][MOST_SIDES];
    size_t from[MAX_CHAIN][MOST_SIDES];
    for (size_t c = 0; c < count; c++) {
        for (size_t j = 0; j < of->count; j++) {
            cost[c][j] = c == 0 && j == first ? 0 : INFINITY;
            from[c][j] = none;
            for (size_t i = first; c > 0 && i < j; i++) {
                const double sum = cost[c - 1][i] + of->area[i][j];
                if (sum < cost[c][j]) {
                    cost[c][j] = sum;
                    from[c][j] = i;
                }
            }
        }
    }
    double least = INFINITY;
    size_t last = none;
    for (size_t j = first + 1; j < of->count; j++) {
        const double sum = cost[count - 1][j] + of->area[j][first];
        if (sum < least) {
            least = sum;
            last = j;
        }
    }
    for (size_t c = count; last != none && c-- > 0; last = from[c][last]) {
        out_chosen[c] = last;
    }
    return least;
}

static size_t choose(const pockets *of, size_t count, double *out_angles) {
    double least = INFINITY;
    for (size_t first = 0; first + count <= of->count; first++) {
        size_t chosen[MAX_CHAIN];
        const double area = choose_from(of, first, count, chosen);
        if (area < least) {
            least = area;
            for (size_t c = 0; c < count; c++) {
                out_angles[c] = of->lines[chosen[c]].angle;
            }
        }
    }
    return isfinite(least) ? count : 0;
}

size_t narc_find_flush_polygon(const hull *around, size_t count, double *out_angles) {
    line *lines = malloc(around->count * sizeof *lines);
    pockets *between = malloc(sizeof *between);
    size_t found = 0;
    if (lines && between && count >= 3) {
        for (size_t k = 0; k < around->count; k++) {
            const narc_point d = around->normals[k];
            lines[k] = (line){d, around->angles[k], dot(d, around->corners[k]) + around->inflation};
        }
        between->count = thin_lines(lines, around->count, MOST_SIDES);
        if (between->count <= MOST_SIDES) {
            memcpy(between->lines, lines, between->count * sizeof *lines);
            found = fill_pockets(between) ? choose(between, count < between->count ? count : between->count, out_angles)
                                          : 0;
        }
    }
    free(lines);
    free(between);
    return found;
}
