/* SPDX-License-Identifier: MIT
 *
 * chain.c - places, area and perimeter of a chain of arcs and edges, and their derivatives.
 */
#include "model/chain.h"

#include <string.h>

#include "outline/vector.h"

narc_layout narc_make_layout(size_t count) {
    return (narc_layout){.radius = 0,
                         .edge = count,
                         .start = 2 * count,
                         .angle = 2 * count + 2,
                         .distance = 3 * count + 2,
                         .count = 3 * count + 3};
}

static double radius_before(const narc_chain *chain, size_t k) {
    return chain->radius[(k + chain->count - 1) % chain->count];
}

void narc_place_chain(narc_chain *chain) {
    const size_t n = chain->count;
    for (size_t k = 0; k < n; k++)
        chain->normal[k] = unit_at(chain->angle[k]);
    chain->normal[n] = chain->normal[0];
    chain->center[0] = chain->start;
    for (size_t k = 1; k <= n; k++) {
        const narc_point d = chain->normal[k];
        const narc_point moved = along(chain->center[k - 1], chain->radius[k - 1] - chain->radius[k % n], d);
        chain->center[k] = along(moved, chain->edge[k % n], turned(d));
    }
}

double narc_end_angle(const narc_chain *chain, size_t i) {
    return i + 1 < chain->count ? chain->angle[i + 1] : chain->angle[0] + 2 * PI;
}

/* A gap of the roundings of lengths near 1, which it stands for, is none. */
static const double CLOSED = 1e-15;

/* The gap between the ends of the chain is the sum of r_i (d_{i+1} - d_i) + l_i t_i. Changing each radius and length in
 * proportion to itself and its own vector, by -size * (vector . x), closes it for the x that solves a 2 x 2 system. */
bool narc_close_chain(narc_chain *chain, double least_radius) {
    const size_t n = chain->count;
    narc_place_chain(chain);
    double xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < n; i++) {
        const narc_point e = minus(chain->normal[i + 1], chain->normal[i]), t = turned(chain->normal[i]);
        const double spare = chain->radius[i] - least_radius;
        xx += spare * e.x * e.x + chain->edge[i] * t.x * t.x;
        xy += spare * e.x * e.y + chain->edge[i] * t.x * t.y;
        yy += spare * e.y * e.y + chain->edge[i] * t.y * t.y;
    }
    const double determinant = xx * yy - xy * xy;
    const narc_point gap = minus(chain->center[n], chain->center[0]);
    if (length(gap) <= CLOSED)
        return true;
    if (!(determinant > 1e-18 * (xx + yy) * (xx + yy)))
        return false;
    const narc_point x = {(yy * gap.x - xy * gap.y) / determinant, (xx * gap.y - xy * gap.x) / determinant};
    for (size_t i = 0; i < n; i++) {
        const narc_point e = minus(chain->normal[i + 1], chain->normal[i]), t = turned(chain->normal[i]);
        chain->radius[i] -= (chain->radius[i] - least_radius) * fmin(1, dot(e, x));
        chain->edge[i] *= fmax(0, 1 - dot(t, x));
    }
    narc_place_chain(chain);
    return true;
}

void narc_offset_chain(narc_chain *chain, double distance, bool polygon) {
    const size_t n = chain->count;
    if (polygon) {
        const narc_point d = chain->normal[0], e = chain->normal[1];
        chain->start = along(chain->start, distance / (1 + dot(d, e)), plus(d, e));
        for (size_t k = 0; k < n; k++) {
            const double before = chain->angle[k] - (k ? chain->angle[k - 1] : chain->angle[n - 1] - 2 * PI);
            const double after = narc_end_angle(chain, k) - chain->angle[k];
            chain->edge[k] += distance * (tangent(before / 2) + tangent(after / 2));
        }
    } else {
        for (size_t k = 0; k < n; k++)
            chain->radius[k] += distance;
    }
    narc_place_chain(chain);
}

void narc_mirror_chain(narc_chain *chain) {
    const narc_chain old = *chain;
    const size_t n = chain->count;
    for (size_t k = 0; k < n; k++) {
        const size_t source = n - 1 - k;
        chain->angle[k] = PI - narc_end_angle(&old, source);
        chain->radius[k] = old.radius[source];
        chain->edge[k] = old.edge[(source + 1) % n];
    }
    chain->start = (narc_point){-old.center[n - 1].x, old.center[n - 1].y};
    narc_place_chain(chain);
}

/* The integral of the unit vectors of an arc's sector. */
static narc_point sector_vector(const narc_chain *chain, size_t i) {
    const narc_point e = minus(chain->normal[i + 1], chain->normal[i]);
    return (narc_point){e.y, -e.x};
}

/* Green's theorem with the support function: half the integral of h along the outline. */
double narc_chain_area(const narc_chain *chain) {
    double twice = 0;
    for (size_t i = 0; i < chain->count; i++) {
        const double sweep = narc_end_angle(chain, i) - chain->angle[i];
        twice += chain->radius[i] * (dot(chain->center[i], sector_vector(chain, i)) + chain->radius[i] * sweep) +
                 chain->edge[i] * (dot(chain->center[i], chain->normal[i]) + chain->radius[i]);
    }
    return 0.5 * twice;
}

double narc_chain_perimeter(const narc_chain *chain) {
    double sum = 0;
    for (size_t i = 0; i < chain->count; i++)
        sum += chain->radius[i] * (narc_end_angle(chain, i) - chain->angle[i]) + chain->edge[i];
    return sum;
}

/* Adds the derivatives of the sum of F_i.a_i over all arcs, given for each k the sum of F_i from k on. */
static void add_center_forces(const narc_chain *chain, const narc_point *suffix, double *out) {
    const size_t n = chain->count;
    const narc_layout layout = narc_make_layout(n);
    out[layout.start] += suffix[0].x;
    out[layout.start + 1] += suffix[0].y;
    for (size_t k = 1; k < n; k++) {
        const narc_point d = chain->normal[k], t = turned(d);
        const double outward = dot(suffix[k], d), onward = dot(suffix[k], t);
        out[layout.radius + k - 1] += outward;
        out[layout.radius + k] -= outward;
        out[layout.edge + k] += onward;
        out[layout.angle + k] += (chain->radius[k - 1] - chain->radius[k]) * onward - chain->edge[k] * outward;
    }
}

void narc_derive_center(const narc_chain *chain, size_t i, narc_point u, double factor, double *out) {
    narc_point suffix[MAX_CHAIN];
    for (size_t k = 0; k < chain->count; k++)
        suffix[k] = k <= i ? (narc_point){factor * u.x, factor * u.y} : (narc_point){0, 0};
    add_center_forces(chain, suffix, out);
}

/* Term by term of narc_chain_area(), which also holds (as a formula) where the chain does not close. */
void narc_derive_area(const narc_chain *chain, double *out) {
    const size_t n = chain->count;
    const narc_layout layout = narc_make_layout(n);
    memset(out, 0, layout.count * sizeof *out);
    narc_point suffix[MAX_CHAIN];
    narc_point sum = {0, 0};
    for (size_t i = n; i-- > 0;) {
        const narc_point sector = sector_vector(chain, i), d = chain->normal[i], a = chain->center[i];
        const double r = chain->radius[i], sweep = narc_end_angle(chain, i) - chain->angle[i];
        sum = along(along(sum, 0.5 * r, sector), 0.5 * chain->edge[i], d);
        suffix[i] = sum;
        out[layout.radius + i] = 0.5 * (dot(a, sector) + chain->edge[i]) + r * sweep;
        out[layout.edge + i] = 0.5 * (dot(a, d) + r);
        out[layout.angle + i] += 0.5 * (chain->edge[i] * dot(a, turned(d)) - r * (dot(a, d) + r));
        out[layout.angle + (i + 1) % n] += 0.5 * r * (dot(a, chain->normal[i + 1]) + r);
    }
    add_center_forces(chain, suffix, out);
}

void narc_derive_gap(const narc_chain *chain, double *out_x, double *out_y) {
    const narc_layout layout = narc_make_layout(chain->count);
    for (size_t k = 0; k < chain->count; k++) {
        const narc_point d = chain->normal[k], t = turned(d), e = minus(chain->normal[k + 1], d);
        const double before = radius_before(chain, k) - chain->radius[k];
        out_x[layout.radius + k] = e.x;
        out_y[layout.radius + k] = e.y;
        out_x[layout.edge + k] = t.x;
        out_y[layout.edge + k] = t.y;
        out_x[layout.angle + k] = before * t.x - chain->edge[k] * d.x;
        out_y[layout.angle + k] = before * t.y - chain->edge[k] * d.y;
    }
}

void narc_derive_perimeter(const narc_chain *chain, double *out) {
    const size_t n = chain->count;
    const narc_layout layout = narc_make_layout(n);
    memset(out, 0, layout.count * sizeof *out);
    for (size_t i = 0; i < n; i++) {
        out[layout.radius + i] = narc_end_angle(chain, i) - chain->angle[i];
        out[layout.edge + i] = 1;
        out[layout.angle + i] = radius_before(chain, i) - chain->radius[i];
    }
}
