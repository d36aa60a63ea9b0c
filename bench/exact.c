/* SPDX-License-Identifier: MIT
 *
 * exact.c - the separation of two bodies in double precision.
 *
 * With h the support function, the gap in direction n is g(n) = -h_A(n) - h_B(-n), and between two junction normals it
 * is a sinusoid plus a constant. So its maximum is where the line through the centres of two arcs is a normal of both,
 * or at a junction normal (of an edge, that is where g has a corner). All of these are tried, in no clever order.
 */
#include "shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static double cross(struct vector a, struct vector b) { return a.x * b.y - a.y * b.x; }

static struct vector negative(struct vector v) { return (struct vector){-v.x, -v.y}; }

static struct vector start_of(const struct arc *arc) { return (struct vector){arc->start_x, arc->start_y}; }

/* The outline turned and moved; the rotation's length, which is that of a rounded one, is taken out. */
static void pose(const struct outline *outline, const struct body *body, double x, double y, struct outline *out) {
    const double length = hypot(body->cosine, body->sine), c = body->cosine / length, s = body->sine / length;
    out->count = outline->count;
    for (size_t k = 0; k <= outline->count; k++) {
        const struct arc *arc = &outline->arcs[k];
        out->arcs[k] = (struct arc){c * arc->x - s * arc->y + x, s * arc->x + c * arc->y + y, arc->radius,
                                    c * arc->start_x - s * arc->start_y, s * arc->start_x + c * arc->start_y};
    }
}

/* Closed at the start and open at the end, by the same expression: one of the arcs has each direction. */
static int covers(const struct outline *outline, size_t k, struct vector v) {
    const struct vector start = start_of(&outline->arcs[k]), end = start_of(&outline->arcs[k + 1]);
    const double behind = cross(start, v);
    if (outline->count == 2)
        return behind > 0 || (behind == 0 && start.x * v.x + start.y * v.y > 0);
    return outline->count == 1 || (behind >= 0 && cross(end, v) < 0);
}

static double support(const struct outline *outline, struct vector v) {
    for (size_t k = 0; k < outline->count; k++)
        if (covers(outline, k, v))
            return outline->arcs[k].x * v.x + outline->arcs[k].y * v.y + outline->arcs[k].radius;
    fprintf(stderr, "exact.c: an outline without a support point\n");
    abort();
}

static double gap_in(const struct outline *a, const struct outline *b, struct vector n) {
    return -support(a, n) - support(b, negative(n));
}

struct best {
    double gap;
    struct vector normal;
};

static void take(struct best *best, double gap, struct vector normal) {
    if (gap > best->gap)
        *best = (struct best){gap, normal};
}

double exact_gap(const struct outline *outlines, const struct body *body_a, const struct body *body_b,
                 struct vector *out_normal) {
    struct outline a, b;
    struct best best = {-INFINITY, {1, 0}};
    pose(&outlines[body_a->shape], body_a, 0, 0, &a);
    pose(&outlines[body_b->shape], body_b, (double)body_b->x - body_a->x, (double)body_b->y - body_a->y, &b);
    for (size_t i = 0; i < a.count; i++) {
        for (size_t j = 0; j < b.count; j++) {
            struct vector u = {b.arcs[j].x - a.arcs[i].x, b.arcs[j].y - a.arcs[i].y};
            if (covers(&a, i, u) && covers(&b, j, negative(u))) {
                const double length = sqrt(u.x * u.x + u.y * u.y);
                if (length > 0)
                    take(&best, length - a.arcs[i].radius - b.arcs[j].radius,
                         (struct vector){u.x / length, u.y / length});
            }
        }
    }
    for (size_t i = 0; i < a.count && a.count > 1; i++)
        take(&best, gap_in(&a, &b, start_of(&a.arcs[i])), start_of(&a.arcs[i]));
    for (size_t j = 0; j < b.count && b.count > 1; j++)
        take(&best, gap_in(&a, &b, negative(start_of(&b.arcs[j]))), negative(start_of(&b.arcs[j])));
    if (best.gap == -INFINITY) /* two circles around one point: every direction is as good */
        best.gap = -a.arcs[0].radius - b.arcs[0].radius;
    *out_normal = best.normal;
    return best.gap;
}
