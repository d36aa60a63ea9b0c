/* SPDX-License-Identifier: MIT
 *
 * touch.h - where and how deep two grains overlap, in double precision: from the arcs and edges that the library says
 * touch, for apps/dem and apps/lammps.
 *
 * The library answers in single precision, which is plenty to tell what touches, and too little for forces at rest: an
 * overlap of 1e-5 of a grain would be known to a few per cent. Here it is known to the rounding of the positions.
 *
 * Two flat sides that face each other touch at both ends of their common stretch. With one point a brick would rock:
 * the deepest point would go from end to end for ever. The ends have the depths h_0 and h_1, each measured across the
 * side that the end of the other body's side lies on; so the depth of the bodies is the larger one, h_0. A law takes
 *
 *       h = sqrt(h_0^2 + w h_1^2),    of a single point h_0,
 *
 * and the ends bear h_0 / h and w h_1 / h of its force: two springs side by side. As h depends on the poses alone, a
 * force that depends on h alone has a potential. The weight w is 1, but for a stretch between an end of A and one of B
 * that is shorter than a quarter of the shorter side: then it fades with the length L, so that h goes over into that of
 * a single point as the sides slide past each other, and the gradient of L is a force along the side.
 *
 * A body of several parts has one surface, however it was cut: see join_touches().
 */
#ifndef NARC_APPS_TOUCH_H
#define NARC_APPS_TOUCH_H

#include <math.h>
#include <narc.h>

#ifdef __cplusplus
extern "C" {
#endif

/* An arc of an outline, and the edge before it. */
typedef struct touch_side {
    double x, y, radius;       /* the arc's circle */
    double normal_x, normal_y; /* outwards, of the edge before it; where there is none, of the arc's beginning */
    double length;             /* of that edge; 0: there is none */
    bool has_edge;             /* before the arc or behind it */
} touch_side;

/* The sides of an outline: as many as arcs, in their order. A concave arc of a chain, alone, has room for one more. */
void make_touch_sides(const narc_arc *arcs, size_t count, touch_side *out_sides);

/* The distance of an outline's furthest point from the origin. */
double find_outline_reach(const narc_arc *arcs, size_t count);

/* A grain as it is: its outline, rotation and scale. */
typedef struct touch_grain {
    const touch_side *sides;
    size_t count;
    double cosine, sine, scale;
} touch_grain;

typedef struct touch_end {
    double x, y;               /* halfway between both surfaces, from the centre of A */
    double normal_x, normal_y; /* unit, from A to B */
    double depth, share;       /* h_i and dh / dh_i */
} touch_end;

typedef struct touch {
    int count;        /* of ends, 1 or 2; 0: the parts touch where others of their bodies do */
    bool leads;       /* is this the deepest contact of its surface? */
    double depth;     /* h of the surface; not above 0: the grains are that far apart */
    double part;      /* this contact's share of h^2; 1 unless the surface has other contacts */
    touch_end end[2]; /* of two, the deeper one first */
    double slide_x,
        slide_y; /* times the force of the law: what B feels besides, on a line through the first end's corner */
    double corner_x, corner_y;
} touch;

/* Of one point. */
static inline void put_point(touch_end end, touch *out) {
    out->end[0] = end;
    out->depth = end.depth;
    out->part = 1;
    out->leads = true;
    out->count = 1;
}

/* Of two discs, B's centre at x, y from A's. */
static inline touch_end meet_discs(double radius_a, double radius_b, double x, double y) {
    const double distance = sqrt(x * x + y * y), inverse = 1 / distance;
    const double depth = radius_a + radius_b - distance, along = radius_a - 0.5 * depth;
    const double normal_x = distance > 0 ? inverse * x : 1, normal_y = distance > 0 ? inverse * y : 0;
    const touch_end end = {along * normal_x, along * normal_y, normal_x, normal_y, depth, 1};
    return end;
}

/* Of the circles of two arcs. */
static inline touch_end meet_arcs(const touch_grain *a, const touch_grain *b, double x, double y, const touch_side *s,
                                  const touch_side *r) {
    const double at_x = a->scale * (a->cosine * s->x - a->sine * s->y);
    const double at_y = a->scale * (a->sine * s->x + a->cosine * s->y);
    const double way_x = x + b->scale * (b->cosine * r->x - b->sine * r->y) - at_x;
    const double way_y = y + b->scale * (b->sine * r->x + b->cosine * r->y) - at_y;
    touch_end end = meet_discs(a->scale * s->radius, b->scale * r->radius, way_x, way_y);
    end.x += at_x;
    end.y += at_y;
    return end;
}

/* As find_touch(), of whatever touches. */
void find_any_touch(const touch_grain *a, const touch_grain *b, double x, double y, unsigned feature, touch *out);

/* Most contacts are of two arcs, one of which has no edges beside it: these touch in one point, and the two circles
 * tell it in a few flops. A law's loop has that without a call. `x`, `y` is where B is from A, `feature` what touches, as of
 * narc_contact. False: it is none of these. */
static inline bool find_point(const touch_grain *a, const touch_grain *b, double x, double y, unsigned feature,
                              touch_end *out) {
    const touch_side *s = &a->sides[feature & 0x3f], *r = &b->sides[feature >> 8 & 0x3f];
    if ((feature & (NARC_FEATURE_EDGE | NARC_FEATURE_EDGE << 8)) != 0 || (s->has_edge && r->has_edge) ||
        signbit(r->radius))
        return false;
    *out = meet_arcs(a, b, x, y, s, r);
    return true;
}

/* Of all contacts. Of what is not there nothing is set. */
static inline void find_touch(const touch_grain *a, const touch_grain *b, double x, double y, unsigned feature,
                              touch *out) {
    touch_end end;
    if (find_point(a, b, x, y, feature, &end))
        put_point(end, out);
    else
        find_any_touch(a, b, x, y, feature, out);
}

/* A contact of a part of A with a part of B: where each is from the centre of A, and a number that no other part has. */
typedef struct touch_parts {
    touch_grain a, b;
    double x, y;
    size_t part_a, part_b;
    touch at;
} touch_parts;

/* The contacts of two bodies of several parts: those of one surface become one, so that nothing depends on how a body is
 * cut into parts. An end whose point lies in another part, or on its border where that goes on, is no end of the common
 * stretch: it goes, if that part touches as well. Of single points that lie in each other's parts the deepest stays. The
 * ends that stay on one surface share its load by the rule above: h^2 is the sum of all their squares. */
void join_touches(touch_parts *parts, size_t count);

#ifdef __cplusplus
}
#endif

#endif
