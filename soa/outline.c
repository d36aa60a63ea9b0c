/* SPDX-License-Identifier: MIT
 *
 * outline.c - reads arcs into normals, and asks an outline for heights and distances.
 */
#include "outline.h"

#include <math.h>

#include "elementary.h"

/* How far the cosine or sine of a multiple of pi/2, itself rounded to a double, can be from 0: per radian of the
 * angle. */
#define SNAP 1e-15

void narc_find_normal(double angle, double *out_x, double *out_y) {
    double x, y, snap = SNAP * fmax(1.0, fabs(angle));
    narc_find_cosine(angle, &x, &y);
    if (fabs(x) <= snap) {
        x = 0;
        y = y > 0 ? 1 : -1;
    } else if (fabs(y) <= snap) {
        x = x > 0 ? 1 : -1;
        y = 0;
    }
    *out_x = x;
    *out_y = y;
}

double narc_wrap_angle(double angle) { return angle - 2 * NARC_PI * nearbyint(angle / (2 * NARC_PI)); }

double narc_find_sweep(const narc_arc *arc) {
    double sweep = arc->end - arc->start;
    return sweep < 0 ? sweep + 2 * NARC_PI : sweep;
}

/* If the largest sweep is half a turn but for rounding, or a little more because its angles have few digits, the
 * normal at its end becomes exactly the opposite of that at its start. No second arc can need it: the other sweeps
 * make up the other half turn. */
static void straighten_half_turn(narc_outline *outline) {
    size_t widest = 0;
    for (size_t i = 1; i < outline->count; i++)
        if (outline->sweep[i] > outline->sweep[widest])
            widest = i;
    double excess = outline->sweep[widest] - NARC_PI;
    if (excess < -4 * SNAP)
        return;
    size_t next = (widest + 1) % outline->count;
    outline->sweep[widest] = NARC_PI;
    outline->sweep[next] += excess;
    outline->normal_x[next] = -outline->normal_x[widest];
    outline->normal_y[next] = -outline->normal_y[widest];
}

void narc_read_outline(const narc_arc *arcs, size_t count, narc_outline *out_outline) {
    narc_outline *o = out_outline;
    if (count == 1) {
        o->count = 2;
        narc_find_normal(arcs[0].start, &o->normal_x[0], &o->normal_y[0]);
        o->sweep[0] = o->sweep[1] = NARC_PI;
    } else {
        o->count = count;
        /* Half of what is missing between the end of one arc and the start of the next goes to either. */
        double first = narc_wrap_angle(arcs[0].start - arcs[count - 1].end) / 2, half = first;
        for (size_t i = 0; i < count; i++) {
            double next = i + 1 < count ? narc_wrap_angle(arcs[i + 1].start - arcs[i].end) / 2 : first;
            narc_find_normal(arcs[i].start - half, &o->normal_x[i], &o->normal_y[i]);
            o->sweep[i] = narc_find_sweep(&arcs[i]) + half + next;
            half = next;
        }
    }
    straighten_half_turn(o);
    o->normal_x[o->count] = o->normal_x[0];
    o->normal_y[o->count] = o->normal_y[0];
    o->origin_x = arcs[0].center_x + arcs[0].radius * o->normal_x[0];
    o->origin_y = arcs[0].center_y + arcs[0].radius * o->normal_y[0];
    for (size_t i = 0; i < o->count; i++) {
        const narc_arc *arc = &arcs[count == 1 ? 0 : i];
        o->center_x[i] = arc->center_x - o->origin_x;
        o->center_y[i] = arc->center_y - o->origin_y;
        o->radius[i] = arc->radius;
    }
}

static narc_point find_point(const narc_outline *o, size_t arc, size_t normal) {
    return (narc_point){o->center_x[arc] + o->radius[arc] * o->normal_x[normal],
                        o->center_y[arc] + o->radius[arc] * o->normal_y[normal]};
}

narc_point narc_find_start(const narc_outline *outline, size_t arc) { return find_point(outline, arc, arc); }

narc_point narc_find_end(const narc_outline *outline, size_t arc) { return find_point(outline, arc, arc + 1); }

bool narc_in_sector(const narc_outline *o, size_t arc, double x, double y) {
    return o->normal_x[arc] * y - o->normal_y[arc] * x >= 0 && x * o->normal_y[arc + 1] - y * o->normal_x[arc + 1] >= 0;
}

double narc_find_height(const narc_outline *o, double x, double y) {
    double best = -INFINITY;
    for (size_t i = 0; i < o->count; i++) {
        double center = o->center_x[i] * x + o->center_y[i] * y;
        double start = center + o->radius[i] * (o->normal_x[i] * x + o->normal_y[i] * y);
        double height = narc_in_sector(o, i, x, y) ? center + o->radius[i] : start;
        best = fmax(best, height);
    }
    return best;
}

/* In one sector p.n - h(n) = (p - centre).n - radius, a sinusoid: it is largest where n points from the centre to p
 * if the sector has that direction, else at a boundary, which starts some sector. */
double narc_find_point_separation(const narc_outline *o, double x, double y, narc_point *out_normal) {
    double best = -INFINITY;
    narc_point normal = {0, 0};
    for (size_t i = 0; i < o->count; i++) {
        double dx = x - o->center_x[i], dy = y - o->center_y[i];
        double gap = dx * o->normal_x[i] + dy * o->normal_y[i] - o->radius[i];
        if (gap > best) {
            best = gap;
            normal = (narc_point){o->normal_x[i], o->normal_y[i]};
        }
        if (narc_in_sector(o, i, dx, dy)) {
            double distance = sqrt(dx * dx + dy * dy);
            if (distance > 0 && distance - o->radius[i] > best) {
                best = distance - o->radius[i];
                normal = (narc_point){dx / distance, dy / distance};
            }
        }
    }
    if (out_normal)
        *out_normal = normal;
    return best;
}
