/* SPDX-License-Identifier: MIT
 *
 * chain.c - places, area and perimeter of a chain of arcs and edges, and their derivatives.
 */
#include "chain.h"

#include <string.h>

#include "vector.h"

layout narc_layout_of(size_t count) {
    return (layout){.radius = 0,
                    .edge = count,
                    .start = 2 * count,
                    .angle = 2 * count + 2,
                    .distance = 3 * count + 2,
                    .count = 3 * count + 3};
}

static double radius_before(const chain *of, size_t k) { return of->radius[(k + of->count - 1) % of->count]; }

void narc_place_chain(chain *of) {
    const size_t n = of->count;
    for (size_t k = 0; k < n; k++) {
        of->normal[k] = unit_at(of->angle[k]);
    }
    of->normal[n] = of->normal[0];
    of->center[0] = of->start;
    for (size_t k = 1; k <= n; k++) {
        const narc_point d = of->normal[k];
        const narc_point moved = along(of->center[k - 1], of->radius[k - 1] - of->radius[k % n], d);
        of->center[k] = along(moved, of->edge[k % n], turned(d));
    }
}

double narc_end_angle(const chain *of, size_t i) {
    return i + 1 < of->count ? of->angle[i + 1] : of->angle[0] + 2 * PI;
}

/* The gap between the ends of the chain is the sum of r_i (d_{i+1} - d_i) + l_i t_i. Changing each radius and length in
 * proportion to itself and its own vector, by -size * (vector . x), closes it for the x that solves a 2 x 2 system. */
bool narc_close_chain(chain *of) {
    const size_t n = of->count;
    narc_place_chain(of);
    double xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < n; i++) {
        const narc_point e = minus(of->normal[i + 1], of->normal[i]), t = turned(of->normal[i]);
        xx += of->radius[i] * e.x * e.x + of->edge[i] * t.x * t.x;
        xy += of->radius[i] * e.x * e.y + of->edge[i] * t.x * t.y;
        yy += of->radius[i] * e.y * e.y + of->edge[i] * t.y * t.y;
    }
    const double determinant = xx * yy - xy * xy;
    const narc_point gap = minus(of->center[n], of->center[0]);
    if (!(determinant > 1e-18 * (xx + yy) * (xx + yy))) {
        return false;
    }
    const narc_point x = {(yy * gap.x - xy * gap.y) / determinant, (xx * gap.y - xy * gap.x) / determinant};
    for (size_t i = 0; i < n; i++) {
        const narc_point e = minus(of->normal[i + 1], of->normal[i]), t = turned(of->normal[i]);
        of->radius[i] *= fmax(0, 1 - dot(e, x));
        of->edge[i] *= fmax(0, 1 - dot(t, x));
    }
    narc_place_chain(of);
    return true;
}

void narc_offset_chain(chain *of, double distance, bool polygon) {
    const size_t n = of->count;
    if (polygon) {
        const narc_point d = of->normal[0], e = of->normal[1];
        of->start = along(of->start, distance / (1 + dot(d, e)), plus(d, e));
        for (size_t k = 0; k < n; k++) {
            const double before = of->angle[k] - (k ? of->angle[k - 1] : of->angle[n - 1] - 2 * PI);
            const double after = narc_end_angle(of, k) - of->angle[k];
            of->edge[k] += distance * (tan(before / 2) + tan(after / 2));
        }
    } else {
        for (size_t k = 0; k < n; k++) {
            of->radius[k] += distance;
        }
    }
    narc_place_chain(of);
}

/* The integral of the unit vectors of an arc's sector. */
static narc_point sector_vector(const chain *of, size_t i) {
    const narc_point e = minus(of->normal[i + 1], of->normal[i]);
    return (narc_point){e.y, -e.x};
}

/* Green's theorem with the support function: half the integral of h along the outline. */
double narc_chain_area(const chain *of) {
    double twice = 0;
    for (size_t i = 0; i < of->count; i++) {
        const double sweep = narc_end_angle(of, i) - of->angle[i];
        twice += of->radius[i] * (dot(of->center[i], sector_vector(of, i)) + of->radius[i] * sweep) +
                 of->edge[i] * (dot(of->center[i], of->normal[i]) + of->radius[i]);
    }
    return 0.5 * twice;
}

double narc_chain_perimeter(const chain *of) {
    double sum = 0;
    for (size_t i = 0; i < of->count; i++) {
        sum += of->radius[i] * (narc_end_angle(of, i) - of->angle[i]) + of->edge[i];
    }
    return sum;
}

/* Adds the derivatives of the sum of F_i.a_i over all arcs, given for each k the sum of F_i from k on. */
static void add_center_forces(const chain *of, const narc_point *suffix, double *out) {
    const size_t n = of->count;
    const layout at = narc_layout_of(n);
    out[at.start] += suffix[0].x;
    out[at.start + 1] += suffix[0].y;
    for (size_t k = 1; k < n; k++) {
        const narc_point d = of->normal[k], t = turned(d);
        const double outward = dot(suffix[k], d), onward = dot(suffix[k], t);
        out[at.radius + k - 1] += outward;
        out[at.radius + k] -= outward;
        out[at.edge + k] += onward;
        out[at.angle + k] += (of->radius[k - 1] - of->radius[k]) * onward - of->edge[k] * outward;
    }
}

void narc_derive_center(const chain *of, size_t i, narc_point u, double factor, double *out) {
    narc_point suffix[MAX_CHAIN];
    for (size_t k = 0; k < of->count; k++) {
        suffix[k] = k <= i ? (narc_point){factor * u.x, factor * u.y} : (narc_point){0, 0};
    }
    add_center_forces(of, suffix, out);
}

/* Term by term of narc_chain_area(), which also holds (as a formula) where the chain does not close. */
void narc_derive_area(const chain *of, double *out) {
    const size_t n = of->count;
    const layout at = narc_layout_of(n);
    memset(out, 0, at.count * sizeof *out);
    narc_point suffix[MAX_CHAIN];
    narc_point sum = {0, 0};
    for (size_t i = n; i-- > 0;) {
        const narc_point sector = sector_vector(of, i), d = of->normal[i], a = of->center[i];
        const double r = of->radius[i], sweep = narc_end_angle(of, i) - of->angle[i];
        sum = along(along(sum, 0.5 * r, sector), 0.5 * of->edge[i], d);
        suffix[i] = sum;
        out[at.radius + i] = 0.5 * (dot(a, sector) + of->edge[i]) + r * sweep;
        out[at.edge + i] = 0.5 * (dot(a, d) + r);
        out[at.angle + i] += 0.5 * (of->edge[i] * dot(a, turned(d)) - r * (dot(a, d) + r));
        out[at.angle + (i + 1) % n] += 0.5 * r * (dot(a, of->normal[i + 1]) + r);
    }
    add_center_forces(of, suffix, out);
}

void narc_derive_gap(const chain *of, double *out_x, double *out_y) {
    const layout at = narc_layout_of(of->count);
    for (size_t k = 0; k < of->count; k++) {
        const narc_point d = of->normal[k], t = turned(d), e = minus(of->normal[k + 1], d);
        const double before = radius_before(of, k) - of->radius[k];
        out_x[at.radius + k] = e.x;
        out_y[at.radius + k] = e.y;
        out_x[at.edge + k] = t.x;
        out_y[at.edge + k] = t.y;
        out_x[at.angle + k] = before * t.x - of->edge[k] * d.x;
        out_y[at.angle + k] = before * t.y - of->edge[k] * d.y;
    }
}

void narc_derive_perimeter(const chain *of, double *out) {
    const size_t n = of->count;
    const layout at = narc_layout_of(n);
    memset(out, 0, at.count * sizeof *out);
    for (size_t i = 0; i < n; i++) {
        out[at.radius + i] = narc_end_angle(of, i) - of->angle[i];
        out[at.edge + i] = 1;
        out[at.angle + i] = radius_before(of, i) - of->radius[i];
    }
}
