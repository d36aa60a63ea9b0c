/* SPDX-License-Identifier: MIT
 *
 * flatten.c - curves to chords.
 *
 * A chord over a parameter step h strays from its curve by at most h^2 / 8 times the largest second derivative, and
 * that of a Bezier curve of degree d is at most d (d - 1) times the largest second difference D of its control points.
 * So k even steps stay within d (d - 1) D / (8 k^2), and rounding on top of that. Of a circle with radius r, the chord
 * of an angle a strays by r (1 - cos(a / 2)), which is less than r a^2 / 8.
 */
#include "outline/path.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "error.h"
#include "outline/vector.h"

/* Most chords of one curve. The default flatness never needs 1000: with E the larger side of the curve's bounding box,
 * Markov's inequality bounds the second derivative of a cubic by 48 E in each coordinate, so D by 8 sqrt(2) E. */
enum { MAX_CHORDS = 20000 };

/* Rounding, in DBL_EPSILON times the curve's largest absolute coordinate M: D takes two roundings in each coordinate,
 * of sums up to 3 M and 4 M, and narc_hypot(); all together not more than 11, of which d (d - 1) / 8 counts: 8.3. The
 * division and the root are right to 4 epsilon of at most 0.75 * 4 sqrt(2) M: 17. Both are divided by k^2. A single
 * chord has exact ends; with more, these are off by 5 in each coordinate (see evaluate_curve()): 7, and their steps are
 * up to (1 + k epsilon) / k, which makes at most 2 * 4.3 / k more. That is 26 for k = 1, and less for others. */
static const double ROUNDING = 26;

/* The point of a curve at 0 <= t <= 1, by de Casteljau. Each of up to three rounds of s a + t b rounds s, a product and
 * the sum, half an epsilon each: each coordinate is within 5 epsilon of the largest absolute coordinate. */
static narc_point evaluate_curve(const narc_drawn_move *curve, double t) {
    narc_point p[4];
    const double s = 1 - t;
    if (curve->is_arc) {
        const narc_curve_arc arc = narc_find_arc(curve);
        return narc_find_arc_point(&arc, t);
    }
    for (unsigned i = 0; i <= curve->degree; i++)
        p[i] = curve->controls[i];
    for (unsigned last = curve->degree; last > 0; last--)
        for (unsigned i = 0; i < last; i++)
            p[i] = (narc_point){s * p[i].x + t * p[i + 1].x, s * p[i].y + t * p[i + 1].y};
    return p[0];
}

narc_curve_arc narc_find_arc(const narc_drawn_move *move) {
    const narc_point p = move->controls[0], q = move->controls[2], m = move->controls[1];
    const narc_point in = minus(m, p), out = minus(q, m), chord = minus(q, p);
    const double across = cross(in, out);
    if (across == 0)
        return (narc_curve_arc){.start = p, .end = q, .center = p, .radius = INFINITY};
    const double half =
        narc_atan2(across, dot(in, out)); /* the angle at a point of the arc is half that at the centre */
    const narc_point center = along(along(p, 0.5, chord), 0.5 / tangent(half), turned(chord));
    return (narc_curve_arc){p, q, center, length(chord) / fabs(2 * narc_sin(half)), 2 * half};
}

narc_point narc_find_arc_point(const narc_curve_arc *arc, double t) {
    const narc_point chord = minus(arc->end, arc->start);
    if (arc->turn == 0)
        return along(arc->start, t, chord);
    const double part = narc_sin(t * arc->turn / 2) / narc_sin(arc->turn / 2); /* of the chord, which is turned too */
    const narc_point way = unit_at((t - 1) * arc->turn / 2);
    return (narc_point){arc->start.x + part * (way.x * chord.x - way.y * chord.y),
                        arc->start.y + part * (way.x * chord.y + way.y * chord.x)};
}

/* ---------------------------------------------------------------------------- how many chords */

/* What one chord for the whole curve may stray, without rounding: divided by k^2 for k chords. */
static double find_bend(const narc_drawn_move *curve) {
    double difference = 0;
    if (curve->is_arc) {
        const narc_curve_arc arc = narc_find_arc(curve);
        return arc.turn == 0 ? 0 : arc.radius * arc.turn * arc.turn / 8;
    }
    for (unsigned i = 0; i + 2 <= curve->degree; i++) {
        const narc_point a = curve->controls[i], b = curve->controls[i + 1], c = curve->controls[i + 2];
        difference = fmax(difference, narc_hypot(a.x - 2 * b.x + c.x, a.y - 2 * b.y + c.y));
    }
    return curve->degree * (curve->degree - 1) * difference / 8;
}

static double find_rounding(const narc_drawn_move *curve) {
    return ROUNDING * DBL_EPSILON * largest_in(bound_points(curve->controls, curve->degree + 1));
}

/* The least flatness that a curve can be had with. */
static double find_least_flatness(const narc_drawn_move *curve) {
    return find_bend(curve) / ((double)MAX_CHORDS * MAX_CHORDS) + find_rounding(curve);
}

/* `flatness` is at least the least one. */
static size_t count_chords(const narc_drawn_move *curve, double flatness) {
    const double bend = find_bend(curve);
    if (curve->degree == 1 || bend == 0)
        return 1;
    const double chords = ceil(sqrt(bend / (flatness - find_rounding(curve))));
    return chords < 1 ? 1 : chords < MAX_CHORDS ? (size_t)chords : MAX_CHORDS;
}

/* ---------------------------------------------------------------------------- a path's extent */

/* Widens the box by a curve's point at t, if that is on the curve (no root, a division by 0: it is not). */
static void widen_at(narc_aabb *box, const narc_drawn_move *curve, double t) {
    if (t > 0 && t < 1)
        *box = widen_box(*box, evaluate_curve(curve, t));
}

/* Widens the box by the points where one coordinate turns back: c0 .. c3 are that coordinate of the control points.
 * The derivative is proportional to (1 - t)^2 p + 2 t (1 - t) q + t^2 r with the differences p, q and r. */
static void widen_by_turns(narc_aabb *box, const narc_drawn_move *curve, const double *c) {
    if (curve->degree == 2) {
        widen_at(box, curve, (c[0] - c[1]) / (c[0] - 2 * c[1] + c[2]));
    } else if (curve->degree == 3) {
        const double p = c[1] - c[0], q = c[2] - c[1], r = c[3] - c[2];
        const double root = sqrt(fmax(0, q * q - p * r));
        /* Of the two ways to write the roots, the one that does not cancel. */
        const double sum = p - q + (p > q ? root : -root);
        widen_at(box, curve, sum / (p - 2 * q + r));
        widen_at(box, curve, p / sum);
    }
}

/* Widens the box by the points of an arc that are its circle's furthest to the right, top, left, bottom. */
static void widen_by_sides(narc_aabb *box, const narc_drawn_move *curve) {
    const narc_curve_arc arc = narc_find_arc(curve);
    const narc_point from = minus(arc.start, arc.center);
    for (int side = 0; side < 4 && arc.turn != 0; side++) {
        const narc_point to = {side == 0 ? 1 : side == 2 ? -1 : 0, side == 1 ? 1 : side == 3 ? -1 : 0};
        const double angle = narc_atan2(copysign(1, arc.turn) * cross(from, to), dot(from, to));
        widen_at(box, curve, (angle < 0 ? angle + 2 * PI : angle) / fabs(arc.turn));
    }
}

static void widen_by_curve(narc_aabb *box, const narc_drawn_move *curve) {
    double x[4], y[4];
    for (unsigned i = 0; i <= curve->degree; i++) {
        x[i] = curve->controls[i].x;
        y[i] = curve->controls[i].y;
    }
    *box = widen_box(widen_box(*box, curve->controls[0]), curve->controls[curve->degree]);
    if (curve->is_arc) {
        widen_by_sides(box, curve);
        return;
    }
    widen_by_turns(box, curve, x);
    widen_by_turns(box, curve, y);
}

/* ---------------------------------------------------------------------------- the walk over the moves */

bool narc_next_drawn(const narc_path *path, narc_drawn_move *move) {
    bool begins = false;
    while (move->move < path->move_count) {
        const unsigned coded = path->degrees[move->move++], degree = coded & ~NARC_ARC_MOVE;
        const size_t point = move->point;
        move->point += narc_count_move_points(degree);
        if (degree > 0) {
            move->contour += begins && move->controls;
            move->controls = path->points + point - 1;
            move->degree = degree;
            move->is_arc = (coded & NARC_ARC_MOVE) != 0;
            move->begins = begins;
            return true;
        }
        begins = true;
    }
    return false;
}

/* What is known of a path before it is flattened. */
struct survey {
    narc_aabb extent;
    size_t contour_count;
    bool has_curves;
    double least_flatness; /* of all curves */
    size_t worst_contour;  /* that of the curve which asks for it */
};

static struct survey survey_path(const narc_path *path) {
    struct survey found = {.extent = {INFINITY, INFINITY, -INFINITY, -INFINITY}};
    for (narc_drawn_move move = {0}; narc_next_drawn(path, &move);) {
        found.contour_count = move.contour + 1;
        widen_by_curve(&found.extent, &move);
        if (move.degree > 1) {
            const double least = find_least_flatness(&move);
            found.worst_contour = least > found.least_flatness ? move.contour : found.worst_contour;
            found.least_flatness = fmax(found.least_flatness, least);
            found.has_curves = true;
        }
    }
    return found;
}

static narc_status choose_flatness(const struct survey *found, double *flatness, narc_error *error) {
    if (!(*flatness >= 0) || isinf(*flatness))
        return narc_fail(error, NARC_ERROR_SIZE, 0, *flatness, "flatness is not a length: %g", *flatness);
    if (!found->has_curves) {
        *flatness = 0;
    } else if (*flatness == 0) {
        /* The least one is more only where doubles cannot tell: a speck far from the origin. */
        *flatness = fmax(NARC_FLATNESS * extent_of(found->extent), found->least_flatness);
    } else if (*flatness < found->least_flatness) {
        return narc_fail(error, NARC_ERROR_SIZE, found->worst_contour, *flatness,
                         "flatness %g is too small for a curve of contour %zu: at least %g is fine", *flatness,
                         found->worst_contour, found->least_flatness * (1 + 1e-5)); /* %g cuts to six digits */
    }
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- the chords */

/* At most that many points come of a path, the closing ones that are left out again included. */
static size_t count_points(const narc_path *path, double flatness) {
    size_t count = 0;
    for (narc_drawn_move move = {0}; narc_next_drawn(path, &move);) {
        const size_t more = count_chords(&move, flatness) + move.begins;
        count = count > SIZE_MAX - more ? SIZE_MAX : count + more;
    }
    return count;
}

/* Ends the last contour; a point that repeats the first one is left out. */
static void end_contour(narc_contours *contours, size_t first) {
    const narc_point *points = contours->points;
    while (contours->point_count > first + 1 && is_same(points[contours->point_count - 1], points[first]))
        contours->point_count--;
    contours->ends[contours->count++] = contours->point_count;
}

static void draw_chords(const narc_path *path, narc_contours *contours) {
    size_t first = 0;
    for (narc_drawn_move move = {0}; narc_next_drawn(path, &move);) {
        if (move.begins) {
            if (contours->point_count > 0)
                end_contour(contours, first);
            first = contours->point_count;
            contours->points[contours->point_count++] = move.controls[0];
        }
        const size_t chords = count_chords(&move, contours->flatness);
        for (size_t k = 1; k < chords; k++)
            contours->points[contours->point_count++] = evaluate_curve(&move, (double)k / (double)chords);
        contours->points[contours->point_count++] = move.controls[move.degree];
    }
    if (contours->point_count > 0)
        end_contour(contours, first);
}

narc_status narc_flatten_path(const narc_path *path, double flatness, narc_contours *out_contours, narc_error *error) {
    if (!path || !out_contours)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", path ? "out_contours" : "path");
    const struct survey found = survey_path(path);
    const narc_status status = choose_flatness(&found, &flatness, error);
    if (status)
        return status;
    narc_contours flat = {.flatness = flatness};
    const size_t count = count_points(path, flatness);
    if (count > 0) {
        flat.points = count < SIZE_MAX / sizeof *flat.points ? malloc(count * sizeof *flat.points) : NULL;
        flat.ends = malloc(found.contour_count * sizeof *flat.ends);
        if (!flat.points || !flat.ends) {
            narc_release_contours(&flat);
            return narc_fail(error, NARC_ERROR_MEMORY, 0, flatness, "no memory for %zu points: flatness %g", count,
                             flatness);
        }
        draw_chords(path, &flat);
    }
    flat.flatness += path->slack;
    *out_contours = flat;
    return NARC_OK;
}

size_t narc_find_drawn_line(const narc_path *path, const narc_contours *contours, size_t contour, size_t chord) {
    size_t line = 0;
    for (narc_drawn_move move = {0}; narc_next_drawn(path, &move);) {
        if (move.contour != contour)
            continue;
        const size_t chords = count_chords(&move, contours->flatness - path->slack);
        if (chord < chords)
            break;
        chord -= chords;
        line++;
    }
    return line;
}

void narc_release_contours(narc_contours *contours) {
    if (contours) {
        free(contours->points);
        free(contours->ends);
        *contours = (narc_contours){0};
    }
}
