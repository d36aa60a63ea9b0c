/* SPDX-License-Identifier: MIT
 *
 * cubic.c - parts, derivatives, tangents and cusps of cubics.
 */
#include <string.h>

#include "biarc/biarc.h"

/* A place where the curve is slower than STILL (per unit of its parameter, the curve being about 1 large) counts as one
 * where it stands still. So does one where speed^2 / |second derivative| is below TIP: that is about the size of the
 * tip in which a curve turns round when it is slow only there, and no tolerance sees it. (Slow as in t^3 with speed v,
 * the turning takes sqrt(v) of the parameter and a size of v^1.5, 1e-12 again.) */
static const double STILL = 1e-8;
static const double TIP = 1e-12;

static narc_point mix(narc_point a, double t, narc_point b) { return along(a, t, minus(b, a)); }

/* The polar form: its value at (t, t, t) is the curve's at t, and the control points of the part from s to t are those
 * at (s, s, s), (s, s, t), (s, t, t) and (t, t, t). */
static narc_point polar(const narc_cubic *curve, double t0, double t1, double t2) {
    const narc_point *c = curve->c;
    const narc_point a = mix(c[0], t0, c[1]), b = mix(c[1], t0, c[2]), d = mix(c[2], t0, c[3]);
    return mix(mix(a, t1, b), t2, mix(b, t1, d));
}

narc_cubic narc_cut_cubic(const narc_cubic *curve, double t0, double t1) {
    narc_cubic part = {
        {polar(curve, t0, t0, t0), polar(curve, t0, t0, t1), polar(curve, t0, t1, t1), polar(curve, t1, t1, t1)}};
    if (t0 == 0)
        part.c[0] = curve->c[0];
    if (t1 == 1)
        part.c[3] = curve->c[3];
    return part;
}

narc_cubic narc_reverse_cubic(const narc_cubic *curve) {
    return (narc_cubic){{curve->c[3], curve->c[2], curve->c[1], curve->c[0]}};
}

narc_derivatives narc_derive_cubic(const narc_cubic *curve, double t) {
    const narc_point *c = curve->c;
    const narc_point u = minus(c[1], c[0]), v = minus(c[2], c[1]), w = minus(c[3], c[2]);
    const narc_point uv = minus(v, u), vw = minus(w, v), uvw = minus(vw, uv);
    const narc_point first = mix(mix(u, t, v), t, mix(v, t, w)), second = mix(uv, t, vw);
    return (narc_derivatives){{3 * first.x, 3 * first.y}, {6 * second.x, 6 * second.y}, {6 * uvw.x, 6 * uvw.y}};
}

void narc_expand_circle(const narc_cubic *curve, narc_point origin, narc_point normal, double curvature,
                        double out_coefficients[7]) {
    /* The product of two Bernstein polynomials of degree 3 is one of degree 6 times C(3, i) C(3, j) / C(6, i + j). */
    static const double WEIGHT[4][4] = {{1, 1. / 2, 1. / 5, 1. / 20},
                                        {1. / 2, 3. / 5, 9. / 20, 1. / 5},
                                        {1. / 5, 9. / 20, 3. / 5, 1. / 2},
                                        {1. / 20, 1. / 5, 1. / 2, 1}};
    narc_point p[4];
    double along_normal[4], sums[7] = {0};
    for (int i = 0; i < 4; i++) {
        p[i] = minus(curve->c[i], origin);
        along_normal[i] = dot(p[i], normal);
        for (int j = 0; j <= i; j++) {
            const double value = curvature / 2 * dot(p[i], p[j]) - (along_normal[i] + along_normal[j]) / 2;
            sums[i + j] += (i == j ? 1 : 2) * WEIGHT[i][j] * value;
        }
    }
    memcpy(out_coefficients, sums, sizeof sums);
}

static void find_end_tangents(const narc_cubic *curve, double rounding, narc_point out_ends[2]) {
    const narc_point *c = curve->c;
    narc_point start = minus(c[3], c[0]), end = start;
    for (int i = 2; i > 0; i--) {
        const narc_point leaving = minus(c[i], c[0]), arriving = minus(c[3], c[3 - i]);
        start = length(leaving) > rounding ? leaving : start;
        end = length(arriving) > rounding ? arriving : end;
    }
    out_ends[0] = unit(start);
    out_ends[1] = unit(end);
}

/* Coefficients of B'.B'', a cubic in t: half the derivative of the squared speed. */
static void find_speed_slope(const narc_cubic *curve, double out[4]) {
    const narc_derivatives d = narc_derive_cubic(curve, 0);
    out[0] = dot(d.first, d.second);
    out[1] = dot(d.second, d.second) + dot(d.first, d.third);
    out[2] = 1.5 * dot(d.second, d.third);
    out[3] = 0.5 * dot(d.third, d.third);
}

static double evaluate(const double p[4], double t) { return p[0] + t * (p[1] + t * (p[2] + t * p[3])); }

/* Where a cubic polynomial is stationary in (0, 1), in order; their number. */
static size_t find_stationary(const double p[4], double out[2]) {
    const double a = 3 * p[3], b = p[2], c = p[1]; /* a t^2 + 2 b t + c = 0 */
    const double square = b * b - a * c;
    size_t count = 0;
    if (square >= 0) {
        const double q = -(b + copysign(sqrt(square), b));
        const double first = q / a, second = c / q;
        const double low = fmin(first, second), high = fmax(first, second);
        for (int k = 0; k < 2; k++) {
            const double t = k ? high : low;
            if (t > 0 && t < 1)
                out[count++] = t;
        }
    }
    return count;
}

/* The tangents with which the curve comes to and leaves the place; false if it is no cusp. */
static bool describe_cusp(const narc_cubic *curve, double t, narc_cusp *out_cusp) {
    const narc_derivatives d = narc_derive_cubic(curve, t);
    const double speed = length(d.first), bend = length(d.second);
    if (speed > STILL && speed * speed > TIP * bend)
        return false;
    /* If the second derivative vanishes as well the curve goes on the way it came. */
    const bool turns = bend > 1e-4 * length(d.third);
    const narc_point out = unit(turns ? d.second : d.third);
    *out_cusp = (narc_cusp){t, turns ? (narc_point){-out.x, -out.y} : out, out};
    return true;
}

static size_t find_slow_places(const narc_cubic *curve, narc_cusp out_cusps[3]) {
    /* Speed is least where B'.B'' rises through 0; between the places where it is stationary there is at most one. */
    double slope[4], ends[4] = {0}, inner[2];
    find_speed_slope(curve, slope);
    const size_t stationary = find_stationary(slope, inner);
    size_t count = 0;
    for (size_t k = 0; k < stationary; k++)
        ends[k + 1] = inner[k];
    ends[stationary + 1] = 1;
    for (size_t k = 0; k <= stationary; k++) {
        double low = ends[k], high = ends[k + 1];
        if (evaluate(slope, low) > 0 || evaluate(slope, high) < 0)
            continue;
        for (int i = 0; i < 60; i++) {
            const double middle = (low + high) / 2;
            *(evaluate(slope, middle) < 0 ? &low : &high) = middle;
        }
        count += describe_cusp(curve, low, &out_cusps[count]);
    }
    return count;
}

/* Is the part from s to t no larger than rounding? */
static bool is_negligible(const narc_cubic *curve, double s, double t, double rounding) {
    const narc_cubic part = narc_cut_cubic(curve, s, t);
    double size = 0;
    for (int i = 1; i < 4; i++)
        size = fmax(size, length(minus(part.c[i], part.c[0])));
    return size <= rounding;
}

size_t narc_find_cusps(const narc_cubic *curve, double rounding, narc_cusp out_cusps[3], narc_point out_ends[2]) {
    narc_cusp found[3];
    const size_t found_count = find_slow_places(curve, found);
    size_t count = 0;
    find_end_tangents(curve, rounding, out_ends);
    for (size_t k = 0; k < found_count; k++) {
        if (is_negligible(curve, 0, found[k].t, rounding)) {
            out_ends[0] = found[k].leaving;
        } else if (is_negligible(curve, found[k].t, 1, rounding)) {
            out_ends[1] = found[k].arriving;
            break;
        } else if (count > 0 && is_negligible(curve, out_cusps[count - 1].t, found[k].t, rounding)) {
            out_cusps[count - 1].leaving = found[k].leaving;
        } else {
            out_cusps[count++] = found[k];
        }
    }
    return count;
}
