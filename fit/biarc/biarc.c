/* SPDX-License-Identifier: MIT
 *
 * biarc.c - two arcs from point to point with given tangents.
 *
 * With the chord along x and tangents at angles a (start) and b (end) to it, the points where two such arcs can meet
 * lie on a circle through both end points: its tangent is at angle w = (a - b) / 2 at the start and -w at the end. A
 * meeting point J is seen from the start at some angle f between w and 0, from the end, by the inscribed angle, at f
 * - w. An arc turns by twice the angle from its tangent to its chord. So the first turns by 2 (f - a) and ends with
 * the tangent 2 f - a, and the second, whose chord is at angle f - w, ends with 2 (f - w) - (2 f - a) = b, as it
 * should. The law of sines gives the chords.
 */
#include "biarc/biarc.h"

/* An arc that turns by less is taken as a line. Its chord is off by turn / 8 times its length; as a circle, whose
 * radius is 1 / turn times its length, the rounding of centre and radius is off by DBL_EPSILON / turn times its
 * length. Both are the same at sqrt(8 DBL_EPSILON) = 4e-8. The tangent is then off by half of that. */
static const double LINE_TURN = 4e-8;

/* If the arcs are one circle but for this angle, one arc serves: the tangents at its ends are off by half of it. */
static const double CIRCLE_ANGLE = 1e-10;

/* Arcs stay clear of half a turn, where their chord says little of them. */
static const double MOST_TURN = 0.95 * PI;

/* sin(share w) / sin(w), which is the share for small w. */
static double sine_share(double share, double w) { return fabs(w) < 1e-9 ? share : narc_sin(share * w) / narc_sin(w); }

static narc_point rotate(narc_point v, double angle) {
    const narc_point u = unit_at(angle);
    return (narc_point){u.x * v.x - u.y * v.y, u.x * v.y + u.y * v.x};
}

/* Angle from a to b. */
static double angle_between(narc_point a, narc_point b) { return narc_atan2(cross(a, b), dot(a, b)); }

static narc_spline_arc make_arc(narc_post start, narc_post end, double turn) {
    const narc_point chord = minus(end.point, start.point);
    const double size = length(chord);
    if (fabs(turn) < LINE_TURN) {
        const narc_point tangent = {chord.x / size, chord.y / size};
        return (narc_spline_arc){start.point, end.point, tangent, tangent, 0, 0};
    }
    return (narc_spline_arc){start.point, end.point, start.tangent, end.tangent, 2 * narc_sin(turn / 2) / size, turn};
}

size_t narc_join_posts(narc_post start, narc_post end, double share, narc_spline_arc out_arcs[2]) {
    const narc_point chord = minus(end.point, start.point);
    const double a = angle_between(chord, start.tangent), b = angle_between(chord, end.tangent);
    const double w = (a - b) / 2, f = (1 - share) * w;
    const double turns[2] = {2 * (f - a), a + b - 2 * f};
    if (length(chord) > 0 && fabs(a + b) < CIRCLE_ANGLE && fabs(2 * w) < MOST_TURN) {
        out_arcs[0] = make_arc(start, end, -2 * w);
        return 1;
    }
    if (!(length(chord) > 0 && fabs(w) < MOST_TURN && fabs(turns[0]) < MOST_TURN && fabs(turns[1]) < MOST_TURN))
        return 0;
    const narc_point to_meeting = rotate(chord, f);
    const narc_post meeting = {along(start.point, sine_share(share, w), to_meeting), rotate(chord, 2 * f - a)};
    const double size = length(chord);
    const narc_post middle = {meeting.point, {meeting.tangent.x / size, meeting.tangent.y / size}};
    out_arcs[0] = make_arc(start, middle, turns[0]);
    out_arcs[1] = make_arc(middle, end, turns[1]);
    return 2;
}

narc_curve_arc narc_describe_arc(const narc_spline_arc *arc) {
    narc_curve_arc out = {.start = arc->start, .end = arc->end, .center = arc->start, .radius = INFINITY};
    if (arc->curvature != 0) {
        out.center = along(arc->start, 1 / arc->curvature, turned(arc->start_tangent));
        out.radius = fabs(1 / arc->curvature);
        out.turn = arc->turn;
    }
    return out;
}

void narc_reverse_arcs(narc_curve_arc *arcs, size_t count) {
    for (size_t i = 0; i < (count + 1) / 2; i++) {
        const narc_curve_arc pair[2] = {arcs[i], arcs[count - 1 - i]};
        for (int k = 0; k < 2; k++) {
            const narc_curve_arc a = pair[k];
            arcs[k ? i : count - 1 - i] = (narc_curve_arc){a.end, a.start, a.center, a.radius, -a.turn};
        }
    }
}

static double value_at(const double p[5], double t) { return p[0] + t * (p[1] + t * (p[2] + t * (p[3] + t * p[4]))); }

/* The root in (0, 1) that is nearest the middle, of those that a coarse grid shows, of a polynomial of degree 4 with
 * the Bernstein coefficients h; negative if it shows none. Where the arcs meet need not be exactly on the curve. */
static double find_middle_root(const double h[5]) {
    enum { STEPS = 8, HALVINGS = 16 };
    const double p[5] = {h[0], 4 * (h[1] - h[0]), 6 * (h[0] - 2 * h[1] + h[2]), 4 * (h[3] - h[0] + 3 * (h[1] - h[2])),
                         h[0] + h[4] + 6 * h[2] - 4 * (h[1] + h[3])};
    double best = -1, at_low = p[0];
    for (int k = 0; k < STEPS; k++) {
        double low = (double)k / STEPS, high = (double)(k + 1) / STEPS;
        const double at_high = value_at(p, high);
        if ((at_low < 0) != (at_high < 0)) {
            for (int i = 0; i < HALVINGS; i++) {
                const double middle = (low + high) / 2;
                *((value_at(p, middle) < 0) == (at_low < 0) ? &low : &high) = middle;
            }
            best = best < 0 || fabs(low - 0.5) < fabs(best - 0.5) ? low : best;
        }
        at_low = at_high;
    }
    return best;
}

double narc_find_share(const narc_cubic *curve, narc_post start, narc_post end) {
    /* Along the curve, the equation of the circle of meeting points has the roots 0 and 1. Without the factor
     * t (1 - t) degree 4 is left. */
    const narc_point chord = minus(end.point, start.point);
    const double size = length(chord);
    const double w = (angle_between(chord, start.tangent) - angle_between(chord, end.tangent)) / 2;
    const narc_point tangent = rotate(chord, w), normal = {-tangent.y / size, tangent.x / size};
    double g[7], h[5];
    narc_expand_circle(curve, start.point, normal, -2 * narc_sin(w) / size, g);
    for (int i = 1; i < 6; i++)
        h[i - 1] = g[i] * 30 / (i * (6 - i));
    const double t = find_middle_root(h);
    if (!(t > 0))
        return 0.5;
    const narc_point meeting = minus(narc_cut_cubic(curve, t, t).c[0], start.point);
    const double f = angle_between(chord, meeting);
    const double share = fabs(w) < 1e-6 ? length(meeting) / size : 1 - f / w;
    return share > 0.05 && share < 0.95 ? share : 0.5;
}
