/* SPDX-License-Identifier: MIT
 *
 * difference.c - the area of the symmetric difference of a chain and a hull.
 *
 * Seen from a point inside both, either outline is a function of the direction, a and k, and the area is half the
 * integral of |a^2 - k^2|. Between the directions of corners and junctions both are smooth. Nothing depends on where
 * exactly the outlines cross, which rounding can't tell where edges lie on sides of the hull. When the chain moves a
 * little, a changes by the outward part of the motion over the cosine between normal and direction.
 */
#include "difference.h"

#include <string.h>

#include "vector.h"

/* The widest step of the quadrature, in radians; each has two points (Gauss). */
static const double STEP = 0.02;
static const double GAUSS = 0.577350269189625764509; /* 1 / sqrt(3) */

enum { MAX_PIECES = 2 * MAX_CHAIN };

/* An arc or an edge of the chain, up to a direction; the points are seen from the middle. */
typedef struct piece {
    bool is_edge;
    size_t arc; /* of an edge: the one behind it */
    narc_point start, end;
} piece;

typedef struct work {
    const chain *of;
    const hull *around;
    narc_point middle;
    size_t pieces;
    piece piece[MAX_PIECES];
    narc_point force[MAX_CHAIN]; /* derivatives by the centres */
    double push[MAX_CHAIN];      /* by the radii, centres aside */
} work;

/* Edges come before their arcs. Pieces without length are left out. */
static void list_pieces(work *in) {
    const chain *of = in->of;
    for (size_t i = 0; i < of->count; i++) {
        const size_t before = (i + of->count - 1) % of->count;
        const narc_point d = of->normal[i];
        const narc_point p = minus(along(of->center[before], of->radius[before], d), in->middle);
        const narc_point q = minus(along(of->center[i], of->radius[i], d), in->middle);
        const narc_point r = minus(along(of->center[i], of->radius[i], of->normal[i + 1]), in->middle);
        if (of->edge[i] > 0) {
            in->piece[in->pieces++] = (piece){true, i, p, q};
        }
        if (of->radius[i] > 0) {
            in->piece[in->pieces++] = (piece){false, i, q, r};
        }
    }
}

/* Both outlines go round the middle: it is on the inner side of every piece and side. */
static bool is_middle_inside(const work *in) {
    bool inside = in->pieces > 0;
    for (size_t k = 0; k < in->pieces; k++) {
        const piece *at = &in->piece[k];
        inside = inside && dot(at->start, in->of->normal[at->arc]) > 0;
    }
    for (size_t k = 0; k < in->around->count; k++) {
        inside = inside && dot(minus(in->around->corners[k], in->middle), in->around->normals[k]) > 0;
    }
    return inside;
}

/* How far a piece is in direction e. */
static double reach_piece(const work *in, const piece *at, narc_point e) {
    const narc_point d = in->of->normal[at->arc];
    if (at->is_edge) {
        return dot(at->start, d) / dot(e, d);
    }
    const narc_point a = minus(in->of->center[at->arc], in->middle);
    const double forward = dot(a, e), sideways = cross(a, e), r = in->of->radius[at->arc];
    return forward + sqrt(fmax(0, r * r - sideways * sideways));
}

/* Adds what a motion of the chain does at the point at distance `reach` in direction e, times `weight`. */
static void add_force(work *in, const piece *at, narc_point e, double reach, double weight) {
    const size_t i = at->arc;
    if (at->is_edge) {
        /* The edge's end moves with its arc, its start with the arc before, what is between by parts. */
        const narc_point d = in->of->normal[i], side = minus(at->end, at->start);
        const size_t before = (i + in->of->count - 1) % in->of->count;
        const double part = dot(minus((narc_point){reach * e.x, reach * e.y}, at->start), side) / dot(side, side);
        const double whole = weight / dot(e, d);
        in->force[i] = along(in->force[i], part * whole, d);
        in->push[i] += part * whole;
        in->force[before] = along(in->force[before], (1 - part) * whole, d);
        in->push[before] += (1 - part) * whole;
        return;
    }
    const narc_point from =
        minus((narc_point){in->middle.x + reach * e.x, in->middle.y + reach * e.y}, in->of->center[i]);
    const narc_point u = {from.x / in->of->radius[i], from.y / in->of->radius[i]};
    const double whole = weight / fmax(dot(e, u), 1e-9);
    in->force[i] = along(in->force[i], whole, u);
    in->push[i] += whole;
}

/* The integral over directions that belong to one piece and one side of the hull. */
static double sum_interval(work *in, const piece *at, size_t side, double from, double to) {
    const narc_point corner = minus(in->around->corners[side], in->middle), normal = in->around->normals[side];
    const unsigned steps = (unsigned)ceil((to - from) / STEP);
    double sum = 0;
    for (unsigned k = 0; k < 2 * steps; k++) {
        const double half = 0.5 * (to - from) / steps;
        const double angle = from + half * ((k / 2) * 2 + 1 + (k % 2 ? GAUSS : -GAUSS));
        const narc_point e = unit_at(angle);
        const double mine = reach_piece(in, at, e), other = dot(corner, normal) / dot(e, normal);
        const double difference = mine * mine - other * other;
        sum += 0.5 * half * fabs(difference);
        add_force(in, at, e, mine, difference > 0 ? half * mine : -half * mine);
    }
    return sum;
}

static double angle_of(narc_point p) { return atan2(p.y, p.x); }

/* How far it is from one angle to another, counter-clockwise; nearly a whole turn is taken for a rounding below 0. */
static double turn_to(double from, double to) {
    const double turn = to - from - 2 * PI * floor((to - from) / (2 * PI));
    return turn > 2 * PI - 1e-9 ? 0 : turn;
}

/* The side of the hull in a direction from the middle. */
static size_t find_side(const work *in, double angle) {
    size_t best = 0;
    double least = INFINITY;
    for (size_t k = 0; k < in->around->count; k++) {
        const double turn = turn_to(angle_of(minus(in->around->corners[k], in->middle)), angle);
        if (turn < least) {
            least = turn;
            best = k;
        }
    }
    return best;
}

/* Walks one piece, side by side. A circle alone goes all the way round. */
static double sum_piece(work *in, const piece *at, size_t *side) {
    const double from = angle_of(at->start);
    const double whole = in->pieces == 1 ? 2 * PI : turn_to(from, angle_of(at->end));
    double sum = 0, done = 0;
    for (size_t step = 0; step <= in->around->count && done < whole; step++) {
        const narc_point corner = minus(in->around->corners[(*side + 1) % in->around->count], in->middle);
        const double left = turn_to(from + done, angle_of(corner));
        const double until = fmin(whole, done + left);
        if (until > done) {
            sum += sum_interval(in, at, *side, from + done, from + until);
        }
        done = until;
        *side = done < whole ? (*side + 1) % in->around->count : *side;
    }
    return sum;
}

double narc_difference_area(const chain *of, const hull *around, narc_point middle, double *derivatives) {
    work in = {.of = of, .around = around, .middle = middle};
    list_pieces(&in);
    if (!is_middle_inside(&in)) {
        return INFINITY;
    }
    double sum = 0;
    size_t side = find_side(&in, angle_of(in.piece[0].start));
    for (size_t k = 0; k < in.pieces; k++) {
        sum += sum_piece(&in, &in.piece[k], &side);
    }
    if (derivatives) {
        const layout columns = narc_layout_of(of->count);
        memset(derivatives, 0, columns.count * sizeof *derivatives);
        for (size_t i = 0; i < of->count; i++) {
            narc_derive_center(of, i, in.force[i], 1, derivatives);
            derivatives[columns.radius + i] += in.push[i];
        }
    }
    return sum;
}
