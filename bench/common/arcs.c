/* SPDX-License-Identifier: MIT
 *
 * arcs.c - lists of arcs in the making.
 */
#include "arcs.h"

#include <math.h>

#include "random.h"

void random_junctions(uint64_t *random, size_t count, double *out_angles) {
    const double turn = random_between(random, 0, 2 * pi);
    for (size_t k = 0; k < count; k++)
        out_angles[k] = turn + 2 * pi / (double)count * ((double)k + random_between(random, -0.3, 0.3));
    out_angles[count] = out_angles[0] + 2 * pi;
}

/* With junction normals d and radii r the outline closes if the sum of r[k] (d[k+1] - d[k]) vanishes:
 * r[k] -= w[k]^2 m . (d[k+1] - d[k]) for one vector m. */
void close_radii(narc_arc *arcs, size_t count, const double *weights) {
    double open_x = 0, open_y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t k = 0; k < count; k++) {
        const double x = cos(arcs[k].end) - cos(arcs[k].start), y = sin(arcs[k].end) - sin(arcs[k].start);
        const double weight = weights ? weights[k] * weights[k] : 1;
        open_x += arcs[k].radius * x, open_y += arcs[k].radius * y;
        xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
    }
    const double determinant = xx * yy - xy * xy;
    const double m_x = (yy * open_x - xy * open_y) / determinant, m_y = (xx * open_y - xy * open_x) / determinant;
    for (size_t k = 0; k < count; k++) {
        const double x = cos(arcs[k].end) - cos(arcs[k].start), y = sin(arcs[k].end) - sin(arcs[k].start);
        arcs[k].radius -= (weights ? weights[k] * weights[k] : 1) * (m_x * x + m_y * y);
    }
}

/* Consecutive centres are c[k] = c[k-1] + (r[k-1] - r[k]) d[k]. */
void chain_centers(narc_arc *arcs, size_t count) {
    arcs[0].center_x = arcs[0].center_y = 0;
    for (size_t k = 1; k < count; k++) {
        const double step = arcs[k - 1].radius - arcs[k].radius;
        arcs[k].center_x = arcs[k - 1].center_x + step * cos(arcs[k].start);
        arcs[k].center_y = arcs[k - 1].center_y + step * sin(arcs[k].start);
    }
}

void resize(narc_arc *arcs, size_t count, double factor) {
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x *= factor;
        arcs[k].center_y *= factor;
        arcs[k].radius *= factor;
    }
}

narc_mass mass_of(const narc_arc *arcs, size_t count) {
    narc_mass mass;
    if (!narc_compute_mass(arcs, count, &mass))
        fail("a shape without mass");
    return mass;
}

void center(narc_arc *arcs, size_t count) {
    const narc_mass mass = mass_of(arcs, count);
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x -= mass.centroid_x;
        arcs[k].center_y -= mass.centroid_y;
    }
}
