/* SPDX-License-Identifier: MIT
 *
 * difference.c - the area of the symmetric difference of a chain and a hull.
 *
 * Seen from a point inside both, either outline is a function of the direction, a and k, and the area is half the
 * integral of |a^2 - k^2|. Between the directions of corners and junctions both are smooth. Nothing depends on where
 * exactly the outlines cross, which rounding can't tell where edges lie on sides of the hull. When the chain moves a
 * little, a changes by the outward part of the motion over the cosine between normal and direction.
 */
#include "model/difference.h"

#include <string.h>

#include "outline/vector.h"

/* The widest step of the quadrature, in radians; each has two points (Gauss). */
static const double STEP = 0.02;
static const double GAUSS = 0.577350269189625764509; /* 1 / sqrt(3) */

enum { MAX_PIECES = 2 * MAX_CHAIN };

/* An arc or an edge of the chain, up to a direction; the points are seen from the middle. */
struct piece {
    bool is_edge;
    size_t arc; /* of an edge: the one behind it */
    narc_point start, end;
};

struct quadrature {
    const narc_chain *chain;
    const narc_hull *hull;
    narc_point middle;
    size_t piece_count;
    struct piece pieces[MAX_PIECES];
    narc_point force[MAX_CHAIN]; /* derivatives by the centres */
    double push[MAX_CHAIN];      /* by the radii, centres aside */
};

/* Edges come before their arcs. Pieces without length are left out. */
static void list_pieces(struct quadrature *quadrature) {
    const narc_chain *chain = quadrature->chain;
    for (size_t i = 0; i < chain->count; i++) {
        const size_t before = (i + chain->count - 1) % chain->count;
        const narc_point d = chain->normal[i];
        const narc_point p = minus(along(chain->center[before], chain->radius[before], d), quadrature->middle);
        const narc_point q = minus(along(chain->center[i], chain->radius[i], d), quadrature->middle);
        const narc_point r = minus(along(chain->center[i], chain->radius[i], chain->normal[i + 1]), quadrature->middle);
        if (chain->edge[i] > 0)
            quadrature->pieces[quadrature->piece_count++] = (struct piece){true, i, p, q};
        if (chain->radius[i] > 0)
            quadrature->pieces[quadrature->piece_count++] = (struct piece){false, i, q, r};
    }
}

/* Both outlines go round the middle: it is on the inner side of every piece and side. */
static bool is_middle_inside(const struct quadrature *quadrature) {
    bool inside = quadrature->piece_count > 0;
    for (size_t k = 0; k < quadrature->piece_count; k++) {
        const struct piece *piece = &quadrature->pieces[k];
        inside = inside && dot(piece->start, quadrature->chain->normal[piece->arc]) > 0;
    }
    for (size_t k = 0; k < quadrature->hull->count; k++) {
        inside =
            inside && dot(minus(quadrature->hull->corners[k], quadrature->middle), quadrature->hull->normals[k]) > 0;
    }
    return inside;
}

/* How far a piece is in direction e. */
static double reach_piece(const struct quadrature *quadrature, const struct piece *piece, narc_point e) {
    const narc_point d = quadrature->chain->normal[piece->arc];
    if (piece->is_edge)
        return dot(piece->start, d) / dot(e, d);
    const narc_point a = minus(quadrature->chain->center[piece->arc], quadrature->middle);
    const double forward = dot(a, e), sideways = cross(a, e), r = quadrature->chain->radius[piece->arc];
    return forward + sqrt(fmax(0, r * r - sideways * sideways));
}

/* Adds what a motion of the chain does at the point at distance `reach` in direction e, times `weight`. */
static void add_force(struct quadrature *quadrature, const struct piece *piece, narc_point e, double reach,
                      double weight) {
    const size_t i = piece->arc;
    if (piece->is_edge) {
        /* The edge's end moves with its arc, its start with the arc before, what is between by parts. */
        const narc_point d = quadrature->chain->normal[i], side = minus(piece->end, piece->start);
        const size_t before = (i + quadrature->chain->count - 1) % quadrature->chain->count;
        const double part = dot(minus((narc_point){reach * e.x, reach * e.y}, piece->start), side) / dot(side, side);
        const double whole = weight / dot(e, d);
        quadrature->force[i] = along(quadrature->force[i], part * whole, d);
        quadrature->push[i] += part * whole;
        quadrature->force[before] = along(quadrature->force[before], (1 - part) * whole, d);
        quadrature->push[before] += (1 - part) * whole;
        return;
    }
    const narc_point radial =
        minus((narc_point){quadrature->middle.x + reach * e.x, quadrature->middle.y + reach * e.y},
              quadrature->chain->center[i]);
    const narc_point u = {radial.x / quadrature->chain->radius[i], radial.y / quadrature->chain->radius[i]};
    const double whole = weight / fmax(dot(e, u), 1e-9);
    quadrature->force[i] = along(quadrature->force[i], whole, u);
    quadrature->push[i] += whole;
}

/* The integral over directions that belong to one piece and one side of the hull. */
static double sum_interval(struct quadrature *quadrature, const struct piece *piece, size_t side, double start,
                           double end) {
    const narc_point corner = minus(quadrature->hull->corners[side], quadrature->middle),
                     normal = quadrature->hull->normals[side];
    const unsigned steps = (unsigned)ceil((end - start) / STEP);
    double sum = 0;
    for (unsigned k = 0; k < 2 * steps; k++) {
        const double half = 0.5 * (end - start) / steps;
        const double angle = start + half * ((k | 1) + (k % 2 ? GAUSS : -GAUSS));
        const narc_point e = unit_at(angle);
        const double mine = reach_piece(quadrature, piece, e), other = dot(corner, normal) / dot(e, normal);
        const double difference = mine * mine - other * other;
        sum += 0.5 * half * fabs(difference);
        add_force(quadrature, piece, e, mine, difference > 0 ? half * mine : -half * mine);
    }
    return sum;
}

static double angle_of(narc_point p) { return narc_atan2(p.y, p.x); }

/* How far it is from one angle to another, counter-clockwise; nearly a whole turn is taken for a rounding below 0. */
static double turn_to(double start, double end) {
    const double turn = end - start - 2 * PI * floor((end - start) / (2 * PI));
    return turn > 2 * PI - 1e-9 ? 0 : turn;
}

/* The side of the hull in a direction from the middle. */
static size_t find_side(const struct quadrature *quadrature, double angle) {
    size_t best = 0;
    double least = INFINITY;
    for (size_t k = 0; k < quadrature->hull->count; k++) {
        const double turn = turn_to(angle_of(minus(quadrature->hull->corners[k], quadrature->middle)), angle);
        if (turn < least) {
            least = turn;
            best = k;
        }
    }
    return best;
}

/* Walks one piece, side by side. A circle alone goes all the way round. */
static double sum_piece(struct quadrature *quadrature, const struct piece *piece, size_t *side) {
    const double start = angle_of(piece->start);
    const double whole = quadrature->piece_count == 1 ? 2 * PI : turn_to(start, angle_of(piece->end));
    double sum = 0, done = 0;
    for (size_t step = 0; step <= quadrature->hull->count && done < whole; step++) {
        const narc_point corner =
            minus(quadrature->hull->corners[(*side + 1) % quadrature->hull->count], quadrature->middle);
        const double left = turn_to(start + done, angle_of(corner));
        const double until = fmin(whole, done + left);
        if (until > done)
            sum += sum_interval(quadrature, piece, *side, start + done, start + until);
        done = until;
        *side = done < whole ? (*side + 1) % quadrature->hull->count : *side;
    }
    return sum;
}

double narc_difference_area(const narc_chain *chain, const narc_hull *hull, narc_point middle, double *derivatives) {
    struct quadrature quadrature = {.chain = chain, .hull = hull, .middle = middle};
    list_pieces(&quadrature);
    if (!is_middle_inside(&quadrature))
        return INFINITY;
    double sum = 0;
    size_t side = find_side(&quadrature, angle_of(quadrature.pieces[0].start));
    for (size_t k = 0; k < quadrature.piece_count; k++)
        sum += sum_piece(&quadrature, &quadrature.pieces[k], &side);
    if (derivatives) {
        const narc_layout layout = narc_make_layout(chain->count);
        memset(derivatives, 0, layout.count * sizeof *derivatives);
        for (size_t i = 0; i < chain->count; i++) {
            narc_derive_center(chain, i, quadrature.force[i], 1, derivatives);
            derivatives[layout.radius + i] += quadrature.push[i];
        }
    }
    return sum;
}
