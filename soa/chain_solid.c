/* SPDX-License-Identifier: MIT
 *
 * chain_solid.c - how thick the solid is behind a piece of a chain, and how far other surfaces are from its ends.
 */
#include <math.h>

#include "chain.h"
#include "elementary.h"
#include "outline.h"
#include "vec2.h"

/* What is this near to the ends of a front, relative to its size, is where the next one begins. */
#define END_ROOM 0x1p-18

/* How far a chain may turn away beside a place for what is near it to be one surface, in radians. What lies behind the
 * solid is never taken for that: the way there and straight back turns by half a turn, and so does any way round to the
 * walls of a crack. */
#define LOCAL_TURN 1.0

static double find_distance(narc_point a, narc_point b) { return narc_hypot(a.x - b.x, a.y - b.y); }

/* ------------------------------------------------------------------------------------------------ thickness */

/* The rays that go into the solid from a part of a front, against its normals, and the shortest one up to what it meets.
 * Those of an arc go through its centre: what they meet of a curve first lies at an end of it, where it enters or leaves
 * the rays, or where the distance from the centre, or the line, has an extreme. */
typedef struct rays {
    const narc_curves *curves;
    narc_point from;       /* where a line begins, or the centre of an arc */
    narc_point along;      /* of a line */
    narc_point side[2];    /* the normals at both ends */
    narc_point begin, end; /* of the front */
    double size;           /* the length of a line, or the radius of an arc: below 0 of a concave one */
    bool is_line;
    double room, least;
    narc_aabb box;
} rays;

/* A place that a curve has; `side`: on the ray from that end, or the other way. */
static void try_place(rays *r, narc_point p, const narc_point *side) {
    const narc_point w = narc_subtract(p, r->from);
    double depth;
    if (r->is_line) {
        const double at = narc_dot(w, r->along);
        if (!side && !(at >= 0 && at <= r->size))
            return;
        depth = -narc_dot(w, r->side[0]);
    } else {
        const bool before =
            side ? narc_dot(w, *side) > 0 : narc_cross(r->side[0], w) >= 0 && narc_cross(w, r->side[1]) >= 0;
        const bool behind = side ? !before : narc_cross(r->side[0], w) <= 0 && narc_cross(w, r->side[1]) <= 0;
        if (!behind && !(before && r->size > 0))
            return;
        const double away = narc_hypot(w.x, w.y);
        depth = r->size + (behind ? away : -away);
    }
    if (depth > r->room && depth < r->least && find_distance(p, r->begin) > r->room &&
        find_distance(p, r->end) > r->room)
        r->least = depth;
}

/* What a curve has on the line through o along the unit vector d. */
static void try_crossings(rays *r, const narc_curve *c, narc_point o, narc_point d, const narc_point *side) {
    if (c->radius > 0) {
        const narc_point w = narc_subtract(c->center, o);
        const double across = narc_cross(d, w), square = (c->radius - across) * (c->radius + across);
        for (int k = -1; k <= 1 && square >= 0; k += 2) {
            const narc_point p = narc_add_scaled(o, narc_dot(w, d) + k * sqrt(square), d);
            if (narc_curve_holds(c, narc_subtract(p, c->center)))
                try_place(r, p, side);
        }
        return;
    }
    const double from = narc_cross(d, narc_subtract(c->from, o)), to = narc_cross(d, narc_subtract(c->to, o));
    if (from != to && ((from <= 0 && to >= 0) || (from >= 0 && to <= 0)))
        try_place(r, narc_add_scaled(c->from, from / (from - to), narc_subtract(c->to, c->from)), side);
}

static void try_curve(rays *r, const narc_curve *c) {
    try_place(r, c->from, NULL);
    try_place(r, c->to, NULL);
    for (int k = 0; k < 2; k++)
        try_crossings(r, c, r->is_line && k > 0 ? narc_add_scaled(r->from, r->size, r->along) : r->from, r->side[k],
                      &r->side[k]);
    if (c->radius > 0) { /* the line through its centre meets it square */
        const narc_point w = narc_subtract(c->center, r->from);
        const double away = narc_hypot(w.x, w.y);
        if (r->is_line || away > 0)
            try_crossings(r, c, c->center, r->is_line ? r->side[0] : (narc_point){w.x / away, w.y / away}, NULL);
    } else if (!r->is_line) {
        const narc_point d = narc_subtract(c->to, c->from), w = narc_subtract(r->from, c->from);
        const double square = narc_dot(d, d), part = narc_dot(w, d) / square;
        if (square > 0 && part > 0 && part < 1)
            try_place(r, narc_add_scaled(c->from, part, d), NULL);
    }
}

static bool overlaps(const narc_aabb *a, const narc_aabb *b) {
    return a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y && b->min_y <= a->max_y;
}

static void try_curves(rays *r, narc_span s) {
    if (!overlaps(&r->curves->nodes[s.node].box, &r->box))
        return;
    if (s.end - s.first == 1) {
        try_curve(r, &r->curves->curves[s.first]);
    } else {
        try_curves(r, narc_get_half(s, 0));
        try_curves(r, narc_get_half(s, 1));
    }
}

static void try_all(rays *r) {
    narc_curve ends[2]; /* where the rays begin and end */
    narc_aabb box[2];
    for (int k = 0; k < 2; k++) {
        const double radius = r->size - (k ? r->least : 0), sign = radius < 0 ? -1 : 1;
        ends[k] = (narc_curve){.center = r->from, .radius = fabs(radius)};
        ends[k].u = (narc_point){sign * r->side[0].x, sign * r->side[0].y};
        ends[k].v = (narc_point){sign * r->side[1].x, sign * r->side[1].y};
        ends[k].from = narc_add_scaled(r->from, radius, r->side[0]);
        ends[k].to = narc_add_scaled(r->from, radius, r->side[1]);
        if (r->is_line) {
            const double depth = k ? -r->least : 0;
            ends[k].radius = 0;
            ends[k].from = narc_add_scaled(r->from, depth, r->side[0]);
            ends[k].to = narc_add_scaled(ends[k].from, r->size, r->along);
        }
        box[k] = narc_find_curve_box(&ends[k]);
    }
    r->box = (narc_aabb){fmin(box[0].min_x, box[1].min_x), fmin(box[0].min_y, box[1].min_y),
                         fmax(box[0].max_x, box[1].max_x), fmax(box[0].max_y, box[1].max_y)};
    try_curves(r, (narc_span){0, 0, r->curves->count});
    for (int k = 0; k < 2 && !r->curves->closed; k++)
        try_curve(r, &r->curves->end_sides[k]);
}

static void try_line(rays *r, narc_point from, narc_point to) {
    r->size = find_distance(from, to);
    if (!(r->size > r->room))
        return;
    r->is_line = true;
    r->from = from;
    r->along = (narc_point){(to.x - from.x) / r->size, (to.y - from.y) / r->size};
    r->side[0] = r->side[1] = (narc_point){r->along.y, -r->along.x};
    try_all(r);
}

double narc_find_thickness(const narc_curves *curves, const narc_arc *arcs, size_t count, narc_point begin,
                           narc_point end, narc_point origin, double most) {
    rays r = {.curves = curves, .room = END_ROOM * most, .least = most};
    if (curves->count == 0)
        return most;
    r.begin = narc_add_scaled(origin, 1, begin);
    r.end = narc_add_scaled(origin, 1, end);
    r.room += narc_find_curve_room(&(narc_curve){.from = r.begin, .to = r.end});
    narc_point last = r.begin;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *arc = &arcs[k];
        const narc_point center = {origin.x + arc->center_x, origin.y + arc->center_y};
        narc_point n[2];
        narc_find_normal(arc->start, &n[0].x, &n[0].y);
        narc_find_normal(arc->end, &n[1].x, &n[1].y);
        if (!signbit(arc->radius))
            try_line(&r, last, narc_add_scaled(center, arc->radius, n[0]));
        r.is_line = false;
        r.from = center;
        r.size = arc->radius;
        r.side[0] = n[0];
        r.side[1] = n[1];
        try_all(&r);
        last = narc_add_scaled(center, arc->radius, n[1]);
    }
    if (count == 0 || !signbit(arcs[0].radius))
        try_line(&r, last, r.end);
    return r.least;
}

/* Straight back means: from a corner at the end, as far as it turns by less than a right angle, from what is before it.
 * A little beyond the end, so that rays along a side do not meet it. */
void narc_find_end_sides(const narc_chain *chain, narc_curves *curves) {
    narc_curves whole = *curves;
    whole.closed = true;
    for (int end = 0; end < 2 && !chain->closed && curves->count > 0; end++) {
        const narc_chain_arc *arc = &chain->arcs[end ? chain->count - 1 : 0];
        const double corner = arc->radius == 0 ? fmin(fmax(0, arc->turn), NARC_PI / 2) : 0;
        const narc_aabb *box = &curves->nodes[0].box;
        const narc_point from = end ? narc_find_chain_end(arc) : narc_find_chain_start(arc);
        narc_point n;
        narc_find_normal(end ? arc->start + arc->turn - corner : arc->start + corner, &n.x, &n.y);
        rays r = {.curves = &whole, .from = from, .along = {-n.y, n.x}, .side = {n, n}, .begin = from, .end = from};
        r.is_line = true;
        r.least = 4 * (box->max_x - box->min_x + box->max_y - box->min_y);
        r.room = 4 * narc_find_curve_room(&(narc_curve){.from = from, .to = narc_add_scaled(from, -r.least, n)});
        try_all(&r);
        narc_curve *side = &curves->end_sides[end];
        side->from = narc_add_scaled(from, end ? r.room : -r.room, r.along);
        side->to = narc_add_scaled(side->from, -r.least, n);
    }
}

/* ------------------------------------------------------------------------------------------------ clearance */

/* A place on a curve: its number in a chain that goes on and on, and how much of it lies before the place. */
typedef struct stop {
    ptrdiff_t curve;
    double part;
} stop;

/* The first curve below a node, from number `from` on, where the chain has turned by more than `limit`; or the last one
 * before number `to` where it has turned by less. `none`: there is none. */
static size_t find_first(const narc_curves *t, narc_span s, size_t from, double limit, size_t none) {
    if (s.end <= from || !(t->nodes[s.node].most > limit))
        return none;
    if (s.end - s.first == 1)
        return s.first;
    const size_t found = find_first(t, narc_get_half(s, 0), from, limit, none);
    return found != none ? found : find_first(t, narc_get_half(s, 1), from, limit, none);
}

static size_t find_last(const narc_curves *t, narc_span s, size_t to, double limit, size_t none) {
    if (s.first >= to || !(t->nodes[s.node].least < limit))
        return none;
    if (s.end - s.first == 1)
        return s.first;
    const size_t found = find_last(t, narc_get_half(s, 1), to, limit, none);
    return found != none ? found : find_last(t, narc_get_half(s, 0), to, limit, none);
}

/* Goes along the chain, after (way 1) or before (-1) a place, until it has turned away by LOCAL_TURN. Returns whether it
 * does. `own`: the curve that the place lies on, or else the next one. */
static bool leave_surface(const narc_curves *t, size_t own, bool is_on_curve, double turned, int way, stop *out) {
    const narc_span all = {0, 0, t->count};
    const size_t none = SIZE_MAX;
    const int turns = is_on_curve ? (t->curves[own].turn > 0) - (t->curves[own].turn < 0) : 0;
    double limit = turned + way * LOCAL_TURN;
    ptrdiff_t before = 0;
    /* What is left of a concave arc turns the other way. */
    size_t k = way > 0 ? find_first(t, all, own + (turns < 0), limit, none)
                       : find_last(t, all, own + (turns > 0), limit, none);
    if (k == none && t->closed) { /* once around */
        limit -= way * t->turn;
        before = way * (ptrdiff_t)t->count;
        k = way > 0 ? find_first(t, all, 0, limit, none) : find_last(t, all, t->count, limit, none);
    }
    if (k == none)
        return false;
    const narc_curve *c = &t->curves[k];
    const double part = c->turn > 0 ? (limit - c->turned) / c->turn : way > 0 ? 0 : 1;
    *out = (stop){before + (ptrdiff_t)k, fmin(1, fmax(0, part))};
    return true;
}

static double find_curve_distance(const narc_curve *c, narc_point p) {
    const narc_point d = narc_subtract(c->to, c->from), w = narc_subtract(p, c->from),
                     out = narc_subtract(p, c->center);
    if (c->radius > 0)
        return narc_curve_holds(c, out) ? fabs(narc_hypot(out.x, out.y) - c->radius)
                                        : fmin(find_distance(p, c->from), find_distance(p, c->to));
    const double square = narc_dot(d, d), part = square > 0 ? fmin(1, fmax(0, narc_dot(w, d) / square)) : 0;
    return find_distance(p, narc_add_scaled(c->from, part, d));
}

/* The distance of a curve, of a convex arc from one part of it to another. */
static double find_part_distance(const narc_curve *c, double from, double to, narc_point p) {
    narc_curve part = *c;
    double x, y;
    if (c->turn > 0) {
        narc_find_cosine(from * c->turn, &x, &y);
        part.u = (narc_point){x * c->u.x - y * c->u.y, x * c->u.y + y * c->u.x};
        narc_find_cosine(to * c->turn, &x, &y);
        part.v = (narc_point){x * c->u.x - y * c->u.y, x * c->u.y + y * c->u.x};
        part.from = narc_add_scaled(c->center, c->radius, part.u);
        part.to = narc_add_scaled(c->center, c->radius, part.v);
    }
    return find_curve_distance(&part, p);
}

/* The least distance from the curves first .. end - 1, if that is less. */
static double find_nearest(const narc_curves *t, narc_span s, size_t first, size_t end, narc_point p, double least) {
    const narc_aabb *b = &t->nodes[s.node].box;
    const double x = fmax(0, fmax(b->min_x - p.x, p.x - b->max_x)), y = fmax(0, fmax(b->min_y - p.y, p.y - b->max_y));
    if (s.end <= first || s.first >= end || x * x + y * y >= least * least)
        return least;
    if (s.end - s.first == 1)
        return fmin(least, find_curve_distance(&t->curves[s.first], p));
    least = find_nearest(t, narc_get_half(s, 0), first, end, p, least);
    return find_nearest(t, narc_get_half(s, 1), first, end, p, least);
}

double narc_find_clearance(const narc_curves *curves, narc_point point, narc_chain_place at, double most) {
    const narc_curves *t = curves;
    const narc_span all = {0, 0, t->count};
    const ptrdiff_t count = (ptrdiff_t)t->count;
    const bool is_again = at.arc->curve == t->count; /* the first arc, or the end of an open chain */
    const double turned = at.arc->turned + at.turned - (is_again && t->closed ? t->turn : 0);
    const size_t own = is_again && t->closed ? 0 : at.arc->curve;
    stop ends[2];
    bool ended[2];
    if (count == 0)
        return most;
    for (int k = 0; k < 2; k++)
        ended[k] = leave_surface(t, own, at.arc->radius != 0, turned, k ? -1 : 1, &ends[k]);
    if (t->closed) {
        const ptrdiff_t apart = ended[0] && ended[1] ? ends[1].curve + count - ends[0].curve : -1;
        if (apart < 0 || (apart == 0 && ends[1].part <= ends[0].part)) /* all of it is one surface */
            return most;
        for (int k = 0; k < 2; k++)
            ends[k].curve = (ends[k].curve + count) % count;
        if (apart == 0)
            return fmin(most, find_part_distance(&t->curves[ends[0].curve], ends[0].part, ends[1].part, point));
    }
    double least = most;
    for (int k = 0; k < 2; k++)
        least = fmin(least, ended[k] ? find_part_distance(&t->curves[ends[k].curve], k ? 0 : ends[k].part,
                                                          k ? ends[k].part : 1, point)
                                     : find_distance(point, k ? t->curves[0].from : t->curves[count - 1].to));
    for (int k = 0; k < 2 && !t->closed; k++)
        least = fmin(least, find_curve_distance(&t->end_sides[k], point));
    const size_t first = ended[0] ? (size_t)ends[0].curve + 1 : t->count, last = ended[1] ? (size_t)ends[1].curve : 0;
    if (t->closed && first <= last)
        return find_nearest(t, all, first, last, point, least);
    least = find_nearest(t, all, first, t->count, point, least);
    return find_nearest(t, all, 0, last, point, least);
}
