/* SPDX-License-Identifier: MIT
 *
 * touch.c - where and how deep two grains overlap, in double precision.
 */
#include "touch.h"

#include <math.h>

#include "vec.h"

/* An edge that is shorter than this share of the outline is none that another can lie on. */
static const double LEAST_EDGE = 1e-4;

/* The edge between two circles has its normal n with n.u = r - r', where u goes from one centre to the other. */
void make_touch_sides(const narc_arc *arcs, size_t count, touch_side *out_sides) {
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fmax(size, hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *before = &arcs[(i + count - 1) % count];
        const vec u = {arc->center_x - before->center_x, arc->center_y - before->center_y};
        vec n = {cos(arc->start), sin(arc->start)};
        double length = u.y * n.x - u.x * n.y;
        if (count > 1 && length > LEAST_EDGE * size) {
            const double rise = before->radius - arc->radius, square = dot(u, u);
            length = sqrt(fmax(square - rise * rise, 0));
            n = plus(times(rise / square, u), times(length / square, (vec){u.y, -u.x}));
        } else {
            length = 0;
        }
        out_sides[i] = (touch_side){arc->center_x, arc->center_y, arc->radius, n.x, n.y, length, false};
    }
    if (count == 1 && signbit(arcs[0].radius)) /* touches with a side to each end, and has a normal more */
        out_sides[1] = (touch_side){.normal_x = cos(arcs[0].end), .normal_y = sin(arcs[0].end)};
    for (size_t i = 0; i < count; i++)
        out_sides[i].has_edge = out_sides[i].length > 0 || out_sides[(i + 1) % count].length > 0;
}

/* At the point that is furthest from the origin the normal points away from the origin, so the arc's centre is on the
 * same line: the point is the support in that direction, or in the opposite one if the arc is flatter. */
double find_outline_reach(const narc_arc *arcs, size_t count) {
    double reach = 0;
    for (size_t i = 0; i < 2 * count; i++) {
        const narc_arc *arc = &arcs[i / 2];
        const double sign = i % 2 ? -1 : 1;
        const bool central = arc->center_x == 0 && arc->center_y == 0;
        narc_point p = {0, 0};
        narc_find_support(arcs, count, central ? 1 : sign * arc->center_x, sign * arc->center_y, &p, NULL);
        reach = fmax(reach, hypot(p.x, p.y));
    }
    return reach;
}

/* ---------------------------------------------------------------------------------------- as they lie */

/* An arc, an edge of a grain in the plane, from the centre of A. */
typedef struct circle {
    vec at;
    double radius;
} circle;

typedef struct edge {
    circle first, last; /* the arcs before and behind it */
    vec normal;
    double height, length; /* its line is where normal.p = height */
} edge;

static vec turn(const touch_grain *g, double x, double y) { return rotate((vec){g->cosine, g->sine}, (vec){x, y}); }

static circle place_circle(const touch_grain *g, vec centre, size_t i) {
    const touch_side *s = &g->sides[i];
    return (circle){plus(centre, times(g->scale, turn(g, s->x, s->y))), g->scale * s->radius};
}

static edge place_edge(const touch_grain *g, vec centre, size_t i) {
    const touch_side *s = &g->sides[i];
    edge e = {.first = place_circle(g, centre, i > 0 ? i - 1 : g->count - 1), .last = place_circle(g, centre, i)};
    e.normal = turn(g, s->normal_x, s->normal_y);
    e.height = dot(e.normal, e.last.at) + e.last.radius;
    e.length = g->scale * s->length;
    return e;
}

/* ---------------------------------------------------------------------------------------- one point */

/* An arc over the edge of the other one: of A if `is_b` is not set. */
static touch_end meet_edge(circle c, edge e, bool is_b) {
    const double depth = e.height + c.radius - dot(e.normal, c.at), sign = is_b ? 1 : -1;
    const vec p = plus(c.at, times(0.5 * depth - c.radius, e.normal));
    return (touch_end){p.x, p.y, sign * e.normal.x, sign * e.normal.y, depth, 1};
}

/* ---------------------------------------------------------------------------------------- two points */

/* The weight of the other end: s^2 (3 - 2 s) of the stretch's length, relative to a quarter of the shorter edge. */
static double find_weight(double length, double edge_length, double *out_slope) {
    const double whole = 0.25 * edge_length, s = fmin(fmax(length / whole, 0), 1);
    *out_slope = 6 * s * (1 - s) / whole;
    return s * s * (3 - 2 * s);
}

/* Where an edge meets one of its arcs. */
static vec find_junction(circle c, edge e) { return plus(c.at, times(c.radius, e.normal)); }

/* Edges of A and B that face each other, and the end of their common stretch that is deepest: `first`. It is the low
 * one where A's edge begins and B's ends. */
static void meet_sides(edge a, edge b, bool low, touch_end first, touch *out) {
    const vec near_a = find_junction(low ? a.first : a.last, a), near_b = find_junction(low ? b.last : b.first, b);
    const vec far_a = find_junction(low ? a.last : a.first, a), far_b = find_junction(low ? b.first : b.last, b);
    const vec along_a = times(low ? 1 : -1, (vec){-a.normal.y, a.normal.x});
    const vec along_b = times(low ? -1 : 1, (vec){-b.normal.y, b.normal.x});
    /* The straight stretch goes from the near junction that is further inwards to the nearer one of the far ones. */
    const bool begin_is_b = dot(minus(near_b, near_a), along_a) > 0;
    const bool end_is_b = dot(minus(far_b, far_a), along_a) < 0;
    const vec begin = begin_is_b ? near_b : near_a, along = end_is_b ? along_b : along_a;
    touch_end second = end_is_b ? meet_edge((circle){far_b, 0}, a, true) : meet_edge((circle){far_a, 0}, b, false);
    double weight = 1, slope = 0;
    if (begin_is_b != end_is_b) /* else it is an edge, whose length never changes */
        weight = find_weight(dot(minus(end_is_b ? far_b : far_a, begin), along), fmin(a.length, b.length), &slope);
    if (!(first.depth > 0 && second.depth > 0 && weight > 0)) {
        put_point(first, out);
        return;
    }
    out->count = 2;
    out->part = 1;
    out->leads = true;
    out->depth = sqrt(first.depth * first.depth + weight * second.depth * second.depth);
    first.share = first.depth / out->depth;
    second.share = weight * second.depth / out->depth;
    out->end[0] = first;
    out->end[1] = second;
    /* -dh/dL grad L, on B: a stretch that gets shorter eases the contact. */
    const double ease = 0.5 * slope * second.depth * second.depth / out->depth * (begin_is_b ? 1 : -1);
    out->slide_x = ease * along.x;
    out->slide_y = ease * along.y;
    out->corner_x = begin.x;
    out->corner_y = begin.y;
}

/* Two edges that the library names: the deeper end of their stretch is an arc of one of them. */
static void meet_edges(edge a, edge b, touch *out) {
    const vec t = {-a.normal.y, a.normal.x};
    const touch_end low =
        dot(minus(b.last.at, a.first.at), t) > 0 ? meet_edge(b.last, a, true) : meet_edge(a.first, b, false);
    const touch_end high =
        dot(minus(b.first.at, a.last.at), t) < 0 ? meet_edge(b.first, a, true) : meet_edge(a.last, b, false);
    if (low.depth >= high.depth)
        meet_sides(a, b, true, low, out);
    else
        meet_sides(a, b, false, high, out);
}

/* Edges are taken for sides that lie on each other if both normals are within a third of a right angle or so of that of
 * the contact. At larger angles the second end would have to be nearer than the contact is deep. */
static const double LEAST_FACING = 0.85;

/* How much two edges face each other across the contact: 1, if they are parallel. */
static double find_facing(const touch_grain *a, const touch_grain *b, size_t i, size_t j, vec normal) {
    const touch_side *s = &a->sides[i], *r = &b->sides[j];
    if (!(s->length > 0 && r->length > 0))
        return -1;
    return fmin(dot(turn(a, s->normal_x, s->normal_y), normal), -dot(turn(b, r->normal_x, r->normal_y), normal));
}

/* Is `u` on the way, counter-clockwise, from one normal to the other, by a whole turn at most? */
static bool is_between(vec from, vec u, vec to) {
    const bool after = cross(from, u) >= 0, before = cross(u, to) >= 0, small = cross(from, to) > 0;
    if (!small && dot(from, to) > 0) /* next to nothing: the normals tell enough */
        return false;
    return small ? after && before : after || before;
}

/* A concave arc, of a chain: its radius is below 0, and behind it is where its normals end. */
static bool is_hollow(const touch_grain *g) { return signbit(g->sides[0].radius); }

/* Is `way`, from its centre, towards the arc? What touches where it ends must not be lost by rounding: then both pieces
 * tell of it, and are one surface. */
static bool faces_hollow(const touch_side *s, vec way) {
    const double slack = -1e-6 * sqrt(dot(way, way));
    const vec begin = {-s->normal_x, -s->normal_y}, end = {-s[1].normal_x, -s[1].normal_y};
    return cross(end, way) >= slack && cross(way, begin) >= slack && dot(way, plus(begin, end)) > slack;
}

/* Each arc of a convex grain is deepest in the direction of its own centre from the hollow's; the two deepest count, so a
 * box rests on both of its corners. */
static void meet_hollow(const touch_grain *a, const touch_grain *b, vec way, touch *out) {
    const touch_side *hollow = &b->sides[0];
    const circle round = place_circle(b, way, 0);
    touch_end end[2] = {{.depth = -INFINITY}, {.depth = -INFINITY}};
    for (size_t i = 0; i < a->count; i++) {
        const circle c = place_circle(a, (vec){0, 0}, i);
        const touch_side *s = &a->sides[i], *next = &a->sides[i + 1 < a->count ? i + 1 : 0];
        const vec u = minus(c.at, round.at);
        const double length = sqrt(dot(u, u)), depth = length + c.radius + round.radius;
        if (!(depth > end[1].depth) || !(length > 0) || !faces_hollow(hollow, rotate((vec){b->cosine, -b->sine}, u)) ||
            (a->count > 1 &&
             !is_between(turn(a, s->normal_x, s->normal_y), u, turn(a, next->normal_x, next->normal_y))))
            continue;
        const vec n = times(1 / length, u), p = plus(c.at, times(c.radius - 0.5 * depth, n));
        end[1] = (touch_end){p.x, p.y, n.x, n.y, depth, 1};
        if (depth > end[0].depth) {
            const touch_end deeper = end[1];
            end[1] = end[0];
            end[0] = deeper;
        }
    }
    put_point(end[0], out);
    if (!(end[1].depth > 0))
        return;
    out->count = 2;
    out->depth = sqrt(end[0].depth * end[0].depth + end[1].depth * end[1].depth);
    for (int e = 0; e < 2; e++) {
        out->end[e] = end[e];
        out->end[e].share = end[e].depth / out->depth;
    }
    out->slide_x = out->slide_y = 0;
    out->corner_x = end[0].x;
    out->corner_y = end[0].y;
}

void find_any_touch(const touch_grain *a, const touch_grain *b, double x, double y, unsigned feature, touch *out) {
    const bool edge_a = feature & NARC_FEATURE_EDGE, edge_b = feature >> 8 & NARC_FEATURE_EDGE;
    const size_t i = feature & 0x3f, j = feature >> 8 & 0x3f;
    const vec centre_a = {0, 0}, centre_b = {x, y};
    if (is_hollow(b)) {
        meet_hollow(a, b, centre_b, out);
        return;
    }
    if (edge_a && edge_b) {
        meet_edges(place_edge(a, centre_a, i), place_edge(b, centre_b, j), out);
        return;
    }
    const touch_end first = edge_a   ? meet_edge(place_circle(b, centre_b, j), place_edge(a, centre_a, i), true)
                            : edge_b ? meet_edge(place_circle(a, centre_a, i), place_edge(b, centre_b, j), false)
                                     : meet_arcs(a, b, x, y, &a->sides[i], &b->sides[j]);
    /* Beside an arc of A are the edges i and i + 1, at whose high and low end it is; of B the other way round. */
    const size_t low_i = edge_a ? i : i + 1 < a->count ? i + 1 : 0, high_j = edge_b ? j : j + 1 < b->count ? j + 1 : 0;
    const vec n = {first.normal_x, first.normal_y};
    const double low = find_facing(a, b, low_i, j, n), high = find_facing(a, b, i, high_j, n);
    if (!(fmax(low, high) > LEAST_FACING))
        put_point(first, out);
    else if (low > high)
        meet_sides(place_edge(a, centre_a, low_i), place_edge(b, centre_b, j), true, first, out);
    else
        meet_sides(place_edge(a, centre_a, i), place_edge(b, centre_b, high_j), false, first, out);
}

/* ---------------------------------------------------------------------------------------- one surface */

/* Shares of a part's size: surfaces that near are one; so are ends; and how far beyond an end another part goes on. */
static const double FLUSH = 1e-4, SAME = 1e-3, BEYOND = 0.02;

/* Depths that differ by less than this share of a part's size are equal: then the order of contacts decides, not rounding. */
static const double TIE = 1e-9;

/* How far a point is outside of an outline; below 0: inside. */
static double find_gap(const touch_grain *g, vec point) {
    const double inverse = 1 / g->scale;
    const vec p = times(inverse, rotate((vec){g->cosine, -g->sine}, point));
    double gap = -INFINITY;
    for (size_t i = 0; i < g->count; i++) {
        const touch_side *s = &g->sides[i], *next = &g->sides[i + 1 < g->count ? i + 1 : 0];
        const vec way = {p.x - s->x, p.y - s->y}, n = {s->normal_x, s->normal_y};
        if (is_hollow(g))
            return faces_hollow(s, way) ? g->scale * -(sqrt(dot(way, way)) + s->radius) : INFINITY;
        const bool faces = g->count == 1 || is_between(n, way, (vec){next->normal_x, next->normal_y});
        gap = fmax(gap, (faces ? sqrt(dot(way, way)) : dot(way, n)) - s->radius);
    }
    return g->scale * gap;
}

/* The surface of A, or B, at an end. */
static vec find_surface(const touch_end *end, bool of_b) {
    const double half = (of_b ? -0.5 : 0.5) * end->depth;
    return (vec){end->x + half * end->normal_x, end->y + half * end->normal_y};
}

static double find_size(const touch_grain *g) {
    double size = 0;
    for (size_t i = 0; i < g->count; i++)
        size = fmax(size, fabs(g->sides[i].x) + fabs(g->sides[i].y) + g->sides[i].radius);
    return g->scale * size;
}

/* Does an end lie in a part of the other contact: of A, or of B? Or does the place further on by `beyond` and a share of
 * the part's size? */
static bool lies_in(const touch_parts *own, int e, const touch_parts *other, bool of_b, vec beyond) {
    const touch_grain *g = of_b ? &other->b : &other->a;
    const double size = find_size(g);
    vec at = plus(find_surface(&own->at.end[e], of_b), times(size, beyond));
    if (of_b)
        at = minus(at, (vec){other->x, other->y});
    return find_gap(g, at) < FLUSH * size;
}

/* In that of a contact which has one part in common with this one. */
static bool lies_beside(const touch_parts *own, int e, const touch_parts *other) {
    const bool of_b = own->part_a == other->part_a;
    return of_b != (own->part_b == other->part_b) && lies_in(own, e, other, of_b, (vec){0, 0});
}

static bool is_linked(const touch_parts *own, const touch_parts *other) {
    bool linked = false;
    const touch_end *a = &own->at.end[0], *b = &other->at.end[0];
    for (int e = 0; e < own->at.count; e++)
        linked |= lies_beside(own, e, other);
    return linked && a->normal_x * b->normal_x + a->normal_y * b->normal_y > LEAST_FACING;
}

enum { MOST_JOINED = 64 };

/* Of a surface: its contacts are those with its number. */
typedef struct surface {
    touch_parts *parts;
    size_t count, number[MOST_JOINED];
    bool stays[MOST_JOINED][2], alone[MOST_JOINED];
} surface;

static double find_place(const touch_end *end, vec along) { return end->x * along.x + end->y * along.y; }

/* From where to where a contact goes. */
static void find_stretch(const touch *t, vec along, double *low, double *high) {
    const double first = find_place(&t->end[0], along), last = t->count == 2 ? find_place(&t->end[1], along) : first;
    *low = fmin(first, last);
    *high = fmax(first, last);
}

/* The end of a stretch stays, once: that of the longest contact; and not where both bodies go on. `sign` is outwards. */
static void keep_end(surface *s, const bool *in, vec along, double place, double sign, double slack) {
    size_t best = s->count;
    int end = 0;
    double longest = -1;
    bool goes_on[2] = {false, false}; /* A, B */
    for (size_t i = 0; i < s->count; i++)
        for (int e = 0; e < s->parts[i].at.count && in[i]; e++) {
            const touch *t = &s->parts[i].at;
            double low, high;
            find_stretch(t, along, &low, &high);
            if (fabs(find_place(&t->end[e], along) - place) > slack)
                continue;
            for (size_t j = 0; j < s->count; j++)
                for (int side = 0; side < 2; side++)
                    goes_on[side] |= s->number[j] == s->number[i] &&
                                     lies_in(&s->parts[i], e, &s->parts[j], side, times(sign * BEYOND, along));
            if (high - low > longest + slack) {
                longest = high - low;
                best = i;
                end = e;
            }
        }
    if (best < s->count && !(goes_on[0] && goes_on[1]))
        s->stays[best][end] = true;
}

/* The stretches of contacts with two ends that meet are one, with what lies in them. `in`: those of this one. */
static void join_stretch(surface *s, size_t seed, vec along, bool *done) {
    bool in[MOST_JOINED] = {false};
    double low, high, a, b;
    const double slack = SAME * fmin(find_size(&s->parts[seed].a), find_size(&s->parts[seed].b));
    find_stretch(&s->parts[seed].at, along, &low, &high);
    for (bool grows = true; grows;) {
        grows = false;
        for (size_t i = 0; i < s->count; i++) {
            find_stretch(&s->parts[i].at, along, &a, &b);
            if (in[i] || s->number[i] != s->number[seed] || a > high + slack || b < low - slack)
                continue;
            in[i] = done[i] = grows = true;
            low = fmin(low, a);
            high = fmax(high, b);
        }
    }
    keep_end(s, in, along, low, -1, slack);
    keep_end(s, in, along, high, 1, slack);
}

/* Is contact j, so deep, before contact i? */
static bool goes_before(const surface *s, size_t j, double depth, size_t i, double other) {
    const double slack = TIE * find_size(&s->parts[i].a);
    return depth > other + slack || (j < i && depth >= other - slack);
}

/* Does all of the contact lie in the part of a deeper one? So it is with points that are one; and with a side of a part that
 * another part covers. */
static bool is_beaten(const surface *s, size_t i) {
    const touch *t = &s->parts[i].at;
    bool beaten = false;
    for (size_t j = 0; j < s->count; j++) {
        const double own = t->end[0].depth, other = s->parts[j].at.end[0].depth;
        beaten |= goes_before(s, j, other, i, own) && lies_beside(&s->parts[i], 0, &s->parts[j]) &&
                  (t->count == 1 || lies_beside(&s->parts[i], 1, &s->parts[j]));
    }
    return beaten;
}

static void find_ends(surface *s) {
    bool done[MOST_JOINED] = {false};
    for (size_t i = 0; i < s->count; i++) {
        const touch *t = &s->parts[i].at;
        if (t->count == 2 && !done[i])
            join_stretch(s, i, (vec){-t->end[0].normal_y, t->end[0].normal_x}, done);
    }
    for (size_t i = 0; i < s->count; i++)
        if (!done[i])
            s->stays[i][0] = !is_beaten(s, i);
        else if (s->alone[i] && is_beaten(s, i))
            s->stays[i][0] = s->stays[i][1] = false;
    for (size_t i = 0; i < s->count; i++) { /* no surface is without any */
        size_t deepest = i;
        bool any = false;
        for (size_t j = 0; j < s->count; j++) {
            any |= s->alone[i] || (s->number[j] == s->number[i] && (s->stays[j][0] || s->stays[j][1]));
            deepest = s->number[j] == s->number[i] && s->parts[j].at.end[0].depth > s->parts[deepest].at.end[0].depth
                          ? j
                          : deepest;
        }
        s->stays[deepest][0] |= !any;
    }
}

/* What an end has of the square of the depth: w h_i^2. */
static double find_square(const touch *t, int e) {
    return t->count == 2 ? t->end[e].share * t->depth * t->end[e].depth : fmax(t->depth, 0) * fmax(t->depth, 0);
}

void join_touches(touch_parts *parts, size_t count) {
    surface s = {.parts = parts, .count = count < MOST_JOINED ? count : MOST_JOINED};
    double square[MOST_JOINED] = {0}, own[MOST_JOINED] = {0}, deepest[MOST_JOINED];
    bool linked = false;
    for (size_t i = 0; i < s.count; i++) {
        s.number[i] = i;
        s.alone[i] = true;
    }
    for (size_t i = 0; i < s.count; i++)
        for (size_t j = 0; j < s.count; j++) {
            const size_t old = s.number[j], now = s.number[i];
            linked |= i != j && lies_beside(&parts[i], 0, &parts[j]);
            if (old == now || !is_linked(&parts[i], &parts[j]))
                continue;
            linked = true;
            s.alone[i] = s.alone[j] = false;
            for (size_t k = 0; k < s.count; k++)
                s.number[k] = s.number[k] == old ? now : s.number[k];
        }
    if (!linked)
        return;
    find_ends(&s);
    for (size_t i = 0; i < s.count; i++) {
        for (int e = 0; e < parts[i].at.count; e++)
            own[i] += s.stays[i][e] ? find_square(&parts[i].at, e) : 0;
        square[s.number[i]] += own[i];
        deepest[i] = s.stays[i][0] ? parts[i].at.end[0].depth : s.stays[i][1] ? parts[i].at.end[1].depth : -INFINITY;
    }
    for (size_t i = 0; i < s.count; i++) {
        touch *t = &parts[i].at;
        const bool pressed = square[s.number[i]] > 0;
        const double depth = pressed ? sqrt(square[s.number[i]]) : t->depth, scale = pressed ? t->depth / depth : 1;
        for (size_t j = 0; j < s.count; j++)
            t->leads &= j == i || s.number[j] != s.number[i] || !goes_before(&s, j, deepest[j], i, deepest[i]);
        for (int e = 0; e < t->count; e++)
            t->end[e].share *= scale;
        if (t->count == 2) {
            t->slide_x *= s.stays[i][1] ? scale : 0;
            t->slide_y *= s.stays[i][1] ? scale : 0;
        }
        if (!s.stays[i][0])
            t->end[0] = t->end[1];
        t->count = t->count == 0 || (pressed && !(own[i] > 0)) ? 0 : s.stays[i][0] + s.stays[i][1];
        t->part = pressed ? own[i] / (depth * depth) : 1;
        t->depth = depth;
    }
}
