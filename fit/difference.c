/* SPDX-License-Identifier: MIT
 *
 * difference.c - the area of the symmetric difference of a chain and a hull.
 *
 * Both outlines are cut where they cross. The pieces of either that lie in the other bound what both have in common, and
 * Green's theorem tells its area. When the chain moves a little, the difference grows by the integral of the motion's
 * outward part along the pieces of the chain outside the hull, and shrinks by that along those inside.
 */
#include "difference.h"

#include <stdlib.h>
#include <string.h>

#include "vector.h"

/* Where an arc, edge or side is cut, sorted. A side of the hull is a line, which a convex outline crosses twice; some room
 * more is for cuts that rounding finds on both sides of a junction. An arc may weave through all sides. */
enum { SIDE_CUTS = 8 };

/* Outlines nearer than this, in parts of the hull's perimeter, coincide: straight edges often lie on sides. Well above
 * the roundings of a distance, and far below what would show in an area. */
static const double COINCIDENT = 1e-12;

typedef struct cuts {
    size_t count, room;
    double *at;
} cuts;

static void add_cut(cuts *to, double at) {
    size_t place = to->count;
    if (to->count == to->room) {
        return;
    }
    for (; place > 0 && to->at[place - 1] > at; place--) {
        to->at[place] = to->at[place - 1];
    }
    to->at[place] = at;
    to->count++;
}

/* How far inside the chain a point is, at most `enough`; negative outside. */
static double depth_in_chain(const chain *of, narc_point x, double enough) {
    double least = enough;
    for (size_t i = 0; i < of->count; i++) {
        const narc_point q = minus(x, of->center[i]), u = of->normal[i], v = of->normal[i + 1];
        least = fmin(least, of->radius[i] - dot(q, u));
        const bool whole = of->count == 1; /* a circle: its sector is all directions */
        if (whole || (cross(u, q) > 0 && cross(q, v) > 0)) {
            least = fmin(least, of->radius[i] - length(q));
        }
    }
    return least;
}

static double depth_in_side(const hull *around, size_t k, narc_point x) {
    return -dot(minus(x, around->corners[k]), around->normals[k]);
}

/* The same for the hull: binary search in the fan of triangles around corner 0 finds the side that matters, besides the
 * two at that corner. */
static double depth_in_hull(const hull *around, narc_point x) {
    const narc_point *p = around->corners;
    size_t low = 1, high = around->count - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (cross(minus(p[middle], p[0]), minus(x, p[0])) >= 0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return fmin(depth_in_side(around, low, x),
                fmin(depth_in_side(around, 0, x), depth_in_side(around, around->count - 1, x)));
}

/* Parts of a side, edge or arc a little beyond its ends count as the ends: so a crossing at a corner is found by at least
 * one of two neighbours, and found twice it makes a piece of no length. */
static const double END = 1e-9;

static bool clamp_part(double *part) {
    const bool near = *part >= -END && *part <= 1 + END;
    *part = fmin(fmax(*part, 0), 1);
    return near;
}

/* The part of a side of the hull, from 0 to 1, where a point of its line is; false if beyond. */
static bool find_part(const hull *around, size_t side, narc_point x, double *out) {
    const narc_point p = around->corners[side], e = minus(around->corners[(side + 1) % around->count], p);
    *out = dot(minus(x, p), e) / dot(e, e);
    return clamp_part(out);
}

typedef struct work {
    const chain *of;
    const hull *around;
    cuts *sides;                 /* of each side of the hull */
    cuts pieces;                 /* of the arc or edge at hand */
    narc_point force[MAX_CHAIN]; /* derivatives by the centres */
    double push[MAX_CHAIN];      /* by the radii, centres aside */
    double common;               /* twice the area in both */
    double margin;               /* what lies this near the other outline is on it: then the chain's piece counts */
} work;

static void cut_arc(work *in, size_t i, double from, double to, cuts *out) {
    const narc_point a = in->of->center[i];
    const double r = in->of->radius[i];
    for (size_t k = 0; k < in->around->count && r > 0; k++) {
        const double c = dot(minus(in->around->corners[k], a), in->around->normals[k]) / r;
        if (!(fabs(c) < 1)) {
            continue;
        }
        const double half = acos(c);
        for (int sign = -1; sign <= 1; sign += 2) {
            double angle = in->around->angles[k] + sign * half, on_side;
            angle -= 2 * PI * floor((angle - from + END) / (2 * PI));
            double on_arc = (angle - from) / (to - from);
            if (clamp_part(&on_arc) && find_part(in->around, k, along(a, r, unit_at(angle)), &on_side)) {
                add_cut(out, from + on_arc * (to - from));
                add_cut(&in->sides[k], on_side);
            }
        }
    }
    add_cut(out, to);
}

static void sum_arc(work *in, size_t i) {
    const narc_point a = in->of->center[i];
    const double r = in->of->radius[i], end = narc_end_angle(in->of, i);
    double from = in->of->angle[i];
    in->pieces.count = 0;
    cut_arc(in, i, from, end, &in->pieces);
    for (size_t k = 0; k < in->pieces.count; k++) {
        const double to = in->pieces.at[k];
        const bool inside = depth_in_hull(in->around, along(a, r, unit_at(0.5 * (from + to)))) > -in->margin;
        const narc_point sum = {sin(to) - sin(from), cos(from) - cos(to)};
        const double sign = inside ? -r : r;
        in->force[i] = along(in->force[i], sign, sum);
        in->push[i] += sign * (to - from);
        in->common += inside ? r * (dot(a, sum) + r * (to - from)) : 0;
        from = to;
    }
}

static void cut_edge(work *in, narc_point p, narc_point e, cuts *out) {
    for (size_t k = 0; k < in->around->count; k++) {
        const narc_point normal = in->around->normals[k];
        const double slope = dot(e, normal), height = dot(minus(in->around->corners[k], p), normal);
        double on_edge = height / slope, on_side;
        if (slope != 0 && clamp_part(&on_edge) && find_part(in->around, k, along(p, height / slope, e), &on_side)) {
            add_cut(out, on_edge);
            add_cut(&in->sides[k], on_side);
        }
    }
    add_cut(out, 1);
}

static void sum_edge(work *in, size_t i) {
    const chain *of = in->of;
    const size_t before = (i + of->count - 1) % of->count;
    const narc_point d = of->normal[i], p = along(of->center[before], of->radius[before], d);
    const narc_point e = {of->edge[i] * -d.y, of->edge[i] * d.x};
    in->pieces.count = 0;
    cut_edge(in, p, e, &in->pieces);
    double from = 0;
    for (size_t k = 0; k < in->pieces.count; k++) {
        const double to = in->pieces.at[k];
        const bool inside = depth_in_hull(in->around, along(p, 0.5 * (from + to), e)) > -in->margin;
        /* The edge's end moves with arc i, its start with the arc before, what is between by parts. */
        const double sign = inside ? -of->edge[i] : of->edge[i];
        const double at_end = sign * 0.5 * (to * to - from * from), at_start = sign * (to - from) - at_end;
        in->force[i] = along(in->force[i], at_end, d);
        in->push[i] += at_end;
        in->force[before] = along(in->force[before], at_start, d);
        in->push[before] += at_start;
        in->common += inside ? (to - from) * cross(p, e) : 0;
        from = to;
    }
}

static void sum_sides(work *in) {
    for (size_t k = 0; k < in->around->count; k++) {
        const narc_point p = in->around->corners[k], e = minus(in->around->corners[(k + 1) % in->around->count], p);
        double from = 0;
        add_cut(&in->sides[k], 1);
        for (size_t c = 0; c < in->sides[k].count; c++) {
            const double to = in->sides[k].at[c];
            if (depth_in_chain(in->of, along(p, 0.5 * (from + to), e), 2 * in->margin) > in->margin) {
                in->common += (to - from) * cross(p, e);
            }
            from = to;
        }
    }
}

static bool open_work(work *in) {
    const size_t sides = in->around->count, room = 2 * sides + 1;
    in->sides = malloc(sides * sizeof *in->sides);
    in->pieces = (cuts){.room = room, .at = malloc((room + sides * SIDE_CUTS) * sizeof(double))};
    for (size_t k = 0; k < sides && in->sides && in->pieces.at; k++) {
        in->sides[k] = (cuts){.room = SIDE_CUTS, .at = in->pieces.at + room + k * SIDE_CUTS};
    }
    return in->sides && in->pieces.at;
}

static void close_work(work *in) {
    free(in->sides);
    free(in->pieces.at);
}

double narc_difference_area(const chain *of, const hull *around, double *derivatives) {
    work in = {.of = of, .around = around, .margin = COINCIDENT * around->perimeter};
    if (!open_work(&in)) {
        close_work(&in);
        return INFINITY;
    }
    for (size_t i = 0; i < of->count; i++) {
        sum_arc(&in, i);
        if (of->edge[i] > 0) {
            sum_edge(&in, i);
        }
    }
    sum_sides(&in);
    close_work(&in);
    if (derivatives) {
        const layout columns = narc_layout_of(of->count);
        memset(derivatives, 0, columns.count * sizeof *derivatives);
        for (size_t i = 0; i < of->count; i++) {
            narc_derive_center(of, i, in.force[i], 1, derivatives);
            derivatives[columns.radius + i] += in.push[i];
        }
    }
    return narc_chain_area(of) + around->area - in.common;
}
