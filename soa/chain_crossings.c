/* SPDX-License-Identifier: MIT
 *
 * chain_crossings.c - does a chain meet itself?
 *
 * Few pairs of boxes of the tree of its curves overlap in a chain that does not come near itself often.
 */
#include <math.h>

#include "chain.h"
#include "error.h"
#include "outline.h"
#include "vec2.h"

/* Parts that join, or that have one small part between them, have met if they do so further from their ends than this
 * many times their size. */
#define NEAR_ENDS 1e-7

/* ------------------------------------------------------------------------------------------------ two curves */

static double measure(const narc_curve *c) { return c->radius + fabs(c->to.x - c->from.x) + fabs(c->to.y - c->from.y); }

/* Does a point of both circles or lines lie on both curves, further from their ends than `away`? */
static bool is_common(const narc_curve *a, const narc_curve *b, narc_point p, double away) {
    const narc_curve *const curves[] = {a, b};
    for (int k = 0; k < 2; k++) {
        const narc_curve *c = curves[k];
        const narc_point from = narc_subtract(p, c->from), to = narc_subtract(c->to, p);
        if (c->radius > 0 ? !narc_curve_holds(c, narc_subtract(p, c->center)) : from.x * to.x + from.y * to.y < 0)
            return false;
        if (away > 0 && (fmax(fabs(from.x), fabs(from.y)) <= away || fmax(fabs(to.x), fabs(to.y)) <= away))
            return false;
    }
    return true;
}

/* The points on the line p + t d, or its opposite, at the distance `half` from p. */
static bool has_common(const narc_curve *a, const narc_curve *b, narc_point p, narc_point d, double half, double away) {
    return is_common(a, b, (narc_point){p.x + half * d.x, p.y + half * d.y}, away) ||
           is_common(a, b, (narc_point){p.x - half * d.x, p.y - half * d.y}, away);
}

static bool do_lines_meet(const narc_curve *a, const narc_curve *b, double away) {
    const narc_point d = narc_subtract(a->to, a->from), e = narc_subtract(b->to, b->from),
                     w = narc_subtract(b->from, a->from);
    const double across = narc_cross(d, e);
    const double s = narc_cross(w, e) / across, t = narc_cross(w, d) / across;
    return across != 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1 &&
           (away == 0 || (fmin(s, 1 - s) * measure(a) > away && fmin(t, 1 - t) * measure(b) > away));
}

static bool do_line_and_arc_meet(const narc_curve *line, const narc_curve *arc, double away) {
    const narc_point d = narc_subtract(line->to, line->from), w = narc_subtract(arc->center, line->from);
    const double length = sqrt(d.x * d.x + d.y * d.y);
    const narc_point along = {d.x / length, d.y / length};
    const double t = w.x * along.x + w.y * along.y, height = narc_cross(along, w);
    const double square = (arc->radius - height) * (arc->radius + height);
    const narc_point foot = {line->from.x + t * along.x, line->from.y + t * along.y};
    return square >= 0 && has_common(line, arc, foot, along, sqrt(square), away);
}

static bool do_arcs_meet(const narc_curve *a, const narc_curve *b, double away) {
    const narc_point d = narc_subtract(b->center, a->center);
    const double distance = sqrt(d.x * d.x + d.y * d.y);
    if (!(distance > 0))
        return false;
    const double t = (distance + (a->radius - b->radius) * ((a->radius + b->radius) / distance)) / 2;
    const double square = (a->radius - t) * (a->radius + t);
    const narc_point along = {d.x / distance, d.y / distance};
    const narc_point foot = {a->center.x + t * along.x, a->center.y + t * along.y};
    return square >= 0 && has_common(a, b, foot, (narc_point){-along.y, along.x}, sqrt(square), away);
}

/* Does a curve go through a point, but for `room`? */
static bool holds(const narc_curve *c, narc_point p, double room) {
    const narc_point from = narc_subtract(p, c->from), along = narc_subtract(c->to, c->from),
                     a = narc_subtract(p, c->center);
    const double length = sqrt(along.x * along.x + along.y * along.y), t = from.x * along.x + from.y * along.y;
    if (c->radius > 0)
        return fabs(sqrt(a.x * a.x + a.y * a.y) - c->radius) <= room && narc_cross(c->u, a) >= -room &&
               narc_cross(a, c->v) >= -room;
    return fabs(narc_cross(along, from)) <= room * length && t >= -room * length && t <= (length + room) * length;
}

/* The middle of a curve between two of its points. */
static narc_point find_middle(const narc_curve *c, narc_point p, narc_point q) {
    const narc_point d = narc_subtract(q, p);
    const double length = sqrt(d.x * d.x + d.y * d.y);
    const double side = narc_curve_holds(c, (narc_point){d.y, -d.x}) ? c->radius / length : -c->radius / length;
    return c->radius > 0 ? (narc_point){c->center.x + side * d.y, c->center.y - side * d.x}
                         : (narc_point){(p.x + q.x) / 2, (p.y + q.y) / 2};
}

/* Do curves lie on each other, along a stretch longer than `away`? It begins and ends where one of them does. */
static bool do_curves_coincide(const narc_curve *a, const narc_curve *b, double away) {
    const narc_point ends[] = {a->from, a->to, b->from, b->to};
    const double room = narc_find_curve_room(a) + narc_find_curve_room(b), least = fmax(away, 4 * room);
    bool is_common_end[4];
    for (int k = 0; k < 4; k++)
        is_common_end[k] = holds(k < 2 ? b : a, ends[k], room);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < k; i++)
            if (is_common_end[k] && is_common_end[i] &&
                fmax(fabs(ends[k].x - ends[i].x), fabs(ends[k].y - ends[i].y)) > least &&
                holds(b, find_middle(a, ends[k], ends[i]), room))
                return true;
    return false;
}

static bool do_curves_meet(const narc_curves *t, size_t i, size_t j) {
    const narc_curve *a = &t->curves[i], *b = &t->curves[j];
    const size_t apart = j - i, around = t->closed ? t->count - apart : apart;
    const double away = apart <= 2 || around <= 2 ? NEAR_ENDS * (measure(a) + measure(b)) : 0;
    if (do_curves_coincide(a, b, away))
        return true;
    if (a->radius > 0 && b->radius > 0)
        return do_arcs_meet(a, b, away);
    if (a->radius > 0 || b->radius > 0)
        return a->radius > 0 ? do_line_and_arc_meet(b, a, away) : do_line_and_arc_meet(a, b, away);
    return do_lines_meet(a, b, away);
}

/* ------------------------------------------------------------------------------------------------ the tree */

/* Do curves of two nodes meet? The first lies before the second one. */
static bool do_nodes_meet(const narc_curves *t, narc_span a, narc_span b, uint32_t found[2]) {
    const narc_aabb *p = &t->nodes[a.node].box, *q = &t->nodes[b.node].box;
    if (p->max_x < q->min_x || q->max_x < p->min_x || p->max_y < q->min_y || q->max_y < p->min_y)
        return false;
    if (a.end - a.first == 1 && b.end - b.first == 1) {
        found[0] = t->curves[a.first].number;
        found[1] = t->curves[b.first].number;
        return do_curves_meet(t, a.first, b.first);
    }
    if (a.end - a.first >= b.end - b.first)
        return do_nodes_meet(t, narc_get_half(a, 0), b, found) || do_nodes_meet(t, narc_get_half(a, 1), b, found);
    return do_nodes_meet(t, a, narc_get_half(b, 0), found) || do_nodes_meet(t, a, narc_get_half(b, 1), found);
}

static bool does_node_meet_itself(const narc_curves *t, narc_span s, uint32_t found[2]) {
    if (s.end - s.first < 2)
        return false;
    const narc_span a = narc_get_half(s, 0), b = narc_get_half(s, 1);
    return does_node_meet_itself(t, a, found) || does_node_meet_itself(t, b, found) || do_nodes_meet(t, a, b, found);
}

narc_status narc_check_crossings(const narc_curves *curves, narc_error *error) {
    uint32_t found[2];
    if (curves->count < 2 || !does_node_meet_itself(curves, (narc_span){0, 0, curves->count}, found))
        return NARC_OK;
    return narc_fail(error, NARC_ERROR_NOT_SIMPLE, found[1], found[0],
                     "arc %lu, or the edge before it, meets arc %lu or the edge before it", (unsigned long)found[1],
                     (unsigned long)found[0]);
}
