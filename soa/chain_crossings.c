/* SPDX-License-Identifier: MIT
 *
 * chain_crossings.c - does a chain meet itself?
 *
 * Boxes around the chain's lines and arcs are the leaves of a binary tree over the chain's order: what follows each
 * other lies together, so few pairs of boxes overlap in a chain that does not come near itself often.
 */
#include <math.h>

#include "chain.h"
#include "error.h"
#include "outline.h"

/* Parts that join, or that have one small part between them, have met if they do so further from their ends than this
 * many times their size. */
#define NEAR_ENDS 1e-7

/* What coordinates are off by, relative to them: some fifty roundings. Curves that are as near along a stretch lie on
 * each other. */
#define ROUNDING 1e-14

/* A line from `from` to `to`, or with a radius above 0 an arc, counter-clockwise from the normal u to the normal v, with
 * its ends. */
typedef struct curve {
    narc_point from, to, center, u, v;
    double radius;
    uint32_t number;
} curve;

typedef struct tree {
    curve *curves;
    narc_aabb *boxes; /* node k has the nodes 2 k + 1 and 2 k + 2 below */
    size_t count;     /* curves */
    bool closed;
    uint32_t found[2]; /* numbers of the curves that meet */
} tree;

static double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static narc_point subtract(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }

/* ------------------------------------------------------------------------------------------------ two curves */

static bool is_in_sector(const curve *c, narc_point a) { return cross(c->u, a) >= 0 && cross(a, c->v) >= 0; }

static double measure(const curve *c) { return c->radius + fabs(c->to.x - c->from.x) + fabs(c->to.y - c->from.y); }

/* Does a point of both circles or lines lie on both curves, further from their ends than `away`? */
static bool is_common(const curve *a, const curve *b, narc_point p, double away) {
    const curve *const curves[] = {a, b};
    for (int k = 0; k < 2; k++) {
        const curve *c = curves[k];
        const narc_point from = subtract(p, c->from), to = subtract(c->to, p);
        if (c->radius > 0 ? !is_in_sector(c, subtract(p, c->center)) : from.x * to.x + from.y * to.y < 0)
            return false;
        if (away > 0 && (fmax(fabs(from.x), fabs(from.y)) <= away || fmax(fabs(to.x), fabs(to.y)) <= away))
            return false;
    }
    return true;
}

/* The points on the line p + t d, or its opposite, at the distance `half` from p. */
static bool has_common(const curve *a, const curve *b, narc_point p, narc_point d, double half, double away) {
    return is_common(a, b, (narc_point){p.x + half * d.x, p.y + half * d.y}, away) ||
           is_common(a, b, (narc_point){p.x - half * d.x, p.y - half * d.y}, away);
}

static bool do_lines_meet(const curve *a, const curve *b, double away) {
    const narc_point d = subtract(a->to, a->from), e = subtract(b->to, b->from), w = subtract(b->from, a->from);
    const double across = cross(d, e);
    const double s = cross(w, e) / across, t = cross(w, d) / across;
    return across != 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1 &&
           (away == 0 || (fmin(s, 1 - s) * measure(a) > away && fmin(t, 1 - t) * measure(b) > away));
}

static bool do_line_and_arc_meet(const curve *line, const curve *arc, double away) {
    const narc_point d = subtract(line->to, line->from), w = subtract(arc->center, line->from);
    const double length = sqrt(d.x * d.x + d.y * d.y);
    const narc_point along = {d.x / length, d.y / length};
    const double t = w.x * along.x + w.y * along.y, height = cross(along, w);
    const double square = (arc->radius - height) * (arc->radius + height);
    const narc_point foot = {line->from.x + t * along.x, line->from.y + t * along.y};
    return square >= 0 && has_common(line, arc, foot, along, sqrt(square), away);
}

static bool do_arcs_meet(const curve *a, const curve *b, double away) {
    const narc_point d = subtract(b->center, a->center);
    const double distance = sqrt(d.x * d.x + d.y * d.y);
    if (!(distance > 0))
        return false;
    const double t = (distance + (a->radius - b->radius) * ((a->radius + b->radius) / distance)) / 2;
    const double square = (a->radius - t) * (a->radius + t);
    const narc_point along = {d.x / distance, d.y / distance};
    const narc_point foot = {a->center.x + t * along.x, a->center.y + t * along.y};
    return square >= 0 && has_common(a, b, foot, (narc_point){-along.y, along.x}, sqrt(square), away);
}

static double find_room(const curve *c) {
    return ROUNDING * (fabs(c->from.x) + fabs(c->from.y) + fabs(c->to.x) + fabs(c->to.y) + c->radius);
}

/* Does a curve go through a point, but for `room`? */
static bool holds(const curve *c, narc_point p, double room) {
    const narc_point from = subtract(p, c->from), along = subtract(c->to, c->from), a = subtract(p, c->center);
    const double length = sqrt(along.x * along.x + along.y * along.y), t = from.x * along.x + from.y * along.y;
    if (c->radius > 0)
        return fabs(sqrt(a.x * a.x + a.y * a.y) - c->radius) <= room && cross(c->u, a) >= -room &&
               cross(a, c->v) >= -room;
    return fabs(cross(along, from)) <= room * length && t >= -room * length && t <= (length + room) * length;
}

/* The middle of a curve between two of its points. */
static narc_point find_middle(const curve *c, narc_point p, narc_point q) {
    const narc_point d = subtract(q, p);
    const double length = sqrt(d.x * d.x + d.y * d.y);
    const double side = is_in_sector(c, (narc_point){d.y, -d.x}) ? c->radius / length : -c->radius / length;
    return c->radius > 0 ? (narc_point){c->center.x + side * d.y, c->center.y - side * d.x}
                         : (narc_point){(p.x + q.x) / 2, (p.y + q.y) / 2};
}

/* Do curves lie on each other, along a stretch longer than `away`? It begins and ends where one of them does. */
static bool do_curves_coincide(const curve *a, const curve *b, double away) {
    const narc_point ends[] = {a->from, a->to, b->from, b->to};
    const double room = find_room(a) + find_room(b), least = fmax(away, 4 * room);
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

static bool do_curves_meet(const tree *t, size_t i, size_t j) {
    const curve *a = &t->curves[i], *b = &t->curves[j];
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

static narc_aabb join(narc_aabb a, narc_aabb b) {
    return (narc_aabb){fmin(a.min_x, b.min_x), fmin(a.min_y, b.min_y), fmax(a.max_x, b.max_x), fmax(a.max_y, b.max_y)};
}

static narc_aabb find_box(const curve *c) {
    static const narc_point axes[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    narc_aabb box = {fmin(c->from.x, c->to.x), fmin(c->from.y, c->to.y), fmax(c->from.x, c->to.x),
                     fmax(c->from.y, c->to.y)};
    for (int k = 0; k < 4 && c->radius > 0; k++)
        if (is_in_sector(c, axes[k])) {
            const double x = c->center.x + c->radius * axes[k].x, y = c->center.y + c->radius * axes[k].y;
            box = join(box, (narc_aabb){x, y, x, y});
        }
    const double room = find_room(c);
    return (narc_aabb){box.min_x - room, box.min_y - room, box.max_x + room, box.max_y + room};
}

/* The curves first .. end - 1 are below a node; its halves are split so that the depth is the logarithm of the count. */
static narc_aabb build_node(tree *t, size_t node, size_t first, size_t end) {
    const size_t middle = first + (end - first) / 2;
    t->boxes[node] = end - first == 1
                         ? find_box(&t->curves[first])
                         : join(build_node(t, 2 * node + 1, first, middle), build_node(t, 2 * node + 2, middle, end));
    return t->boxes[node];
}

typedef struct span {
    size_t node, first, end;
} span;

static span get_half(span s, int half) {
    const size_t middle = s.first + (s.end - s.first) / 2;
    return half ? (span){2 * s.node + 2, middle, s.end} : (span){2 * s.node + 1, s.first, middle};
}

/* Do curves of two nodes meet? The first lies before the second one. */
static bool do_nodes_meet(tree *t, span a, span b) {
    const narc_aabb *p = &t->boxes[a.node], *q = &t->boxes[b.node];
    if (p->max_x < q->min_x || q->max_x < p->min_x || p->max_y < q->min_y || q->max_y < p->min_y)
        return false;
    if (a.end - a.first == 1 && b.end - b.first == 1) {
        t->found[0] = t->curves[a.first].number;
        t->found[1] = t->curves[b.first].number;
        return do_curves_meet(t, a.first, b.first);
    }
    if (a.end - a.first >= b.end - b.first)
        return do_nodes_meet(t, get_half(a, 0), b) || do_nodes_meet(t, get_half(a, 1), b);
    return do_nodes_meet(t, a, get_half(b, 0)) || do_nodes_meet(t, a, get_half(b, 1));
}

static bool does_node_meet_itself(tree *t, span s) {
    if (s.end - s.first < 2)
        return false;
    const span a = get_half(s, 0), b = get_half(s, 1);
    return does_node_meet_itself(t, a) || does_node_meet_itself(t, b) || do_nodes_meet(t, a, b);
}

/* ------------------------------------------------------------------------------------------------ a chain */

static curve make_arc(const narc_chain_arc *arc) {
    const double angle[] = {arc->start, arc->start + arc->turn};
    const bool is_concave = arc->turn < 0;
    curve c = {narc_find_chain_start(arc),
               narc_find_chain_end(arc),
               {arc->x, arc->y},
               {0, 0},
               {0, 0},
               fabs(arc->radius),
               arc->number};
    narc_point normals[2];
    for (int k = 0; k < 2; k++)
        narc_find_normal(angle[k], &normals[k].x, &normals[k].y);
    c.u = is_concave ? (narc_point){-normals[1].x, -normals[1].y} : normals[0];
    c.v = is_concave ? (narc_point){-normals[0].x, -normals[0].y} : normals[1];
    return c;
}

static void collect_curves(const narc_chain *chain, tree *t) {
    const bool is_convex = chain->arcs[0].turn > 0; /* if closed, its first and last arc are parts of one */
    for (size_t k = 0; k < chain->count; k++) {
        const narc_chain_arc *arc = &chain->arcs[k];
        if (k > 0) {
            const narc_point from = narc_find_chain_end(arc - 1), to = narc_find_chain_start(arc);
            if (fmax(fabs(to.x - from.x), fabs(to.y - from.y)) > narc_find_chain_room(arc - 1, arc))
                t->curves[t->count++] = (curve){.from = from, .to = to, .number = arc->number};
        }
        narc_chain_arc part = *arc;
        if (chain->closed && k + 1 == chain->count) /* up to where the first one begins */
            part.turn = is_convex ? narc_wrap_angle(chain->arcs[0].start - arc->start) : 0;
        if (arc->radius != 0 && part.turn != 0)
            t->curves[t->count++] = make_arc(&part);
    }
}

narc_status narc_check_crossings(const narc_chain *chain, const narc_allocator *allocator, narc_error *error) {
    const size_t most = 2 * chain->count;
    size_t nodes = 2;
    while (nodes < 2 * most)
        nodes *= 2;
    tree t = {.closed = chain->closed};
    if (most > SIZE_MAX / (sizeof *t.curves + 4 * sizeof *t.boxes))
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for %zu arcs", chain->count);
    t.curves = allocator->allocate(most * sizeof *t.curves + nodes * sizeof *t.boxes, allocator->context);
    if (!t.curves)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for %zu arcs", chain->count);
    t.boxes = (void *)(t.curves + most);
    collect_curves(chain, &t);
    bool found = false;
    if (t.count > 1) {
        build_node(&t, 0, 0, t.count);
        found = does_node_meet_itself(&t, (span){0, 0, t.count});
    }
    allocator->release(t.curves, allocator->context);
    if (!found)
        return NARC_OK;
    return narc_fail(error, NARC_ERROR_NOT_SIMPLE, t.found[1], t.found[0],
                     "arc %lu, or the edge before it, meets arc %lu or the edge before it", (unsigned long)t.found[1],
                     (unsigned long)t.found[0]);
}
