/* SPDX-License-Identifier: MIT
 *
 * chain_curves.c - the lines and arcs of a chain, in a tree of boxes.
 */
#include <math.h>

#include "chain.h"
#include "error.h"
#include "outline.h"

/* What coordinates are off by, relative to them: some fifty roundings. Curves that are as near along a stretch lie on
 * each other. */
#define ROUNDING 1e-14

double narc_find_curve_room(const narc_curve *c) {
    return ROUNDING * (fabs(c->from.x) + fabs(c->from.y) + fabs(c->to.x) + fabs(c->to.y) + c->radius);
}

static narc_aabb join(narc_aabb a, narc_aabb b) {
    return (narc_aabb){fmin(a.min_x, b.min_x), fmin(a.min_y, b.min_y), fmax(a.max_x, b.max_x), fmax(a.max_y, b.max_y)};
}

narc_aabb narc_find_curve_box(const narc_curve *c) {
    static const narc_point axes[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    narc_aabb box = {fmin(c->from.x, c->to.x), fmin(c->from.y, c->to.y), fmax(c->from.x, c->to.x),
                     fmax(c->from.y, c->to.y)};
    for (int k = 0; k < 4 && c->radius > 0; k++)
        if (narc_curve_holds(c, axes[k])) {
            const double x = c->center.x + c->radius * axes[k].x, y = c->center.y + c->radius * axes[k].y;
            box = join(box, (narc_aabb){x, y, x, y});
        }
    const double room = narc_find_curve_room(c);
    return (narc_aabb){box.min_x - room, box.min_y - room, box.max_x + room, box.max_y + room};
}

/* The halves of a node are split so that the depth is the logarithm of the count. */
static narc_curve_node build_node(narc_curves *t, narc_span s) {
    narc_curve_node *node = &t->nodes[s.node];
    if (s.end - s.first == 1) {
        const narc_curve *c = &t->curves[s.first];
        const double end = c->turned + c->turn;
        *node = (narc_curve_node){narc_find_curve_box(c), fmax(c->turned, end), fmin(c->turned, end)};
    } else {
        const narc_curve_node a = build_node(t, narc_get_half(s, 0)), b = build_node(t, narc_get_half(s, 1));
        *node = (narc_curve_node){join(a.box, b.box), fmax(a.most, b.most), fmin(a.least, b.least)};
    }
    return *node;
}

static narc_curve make_arc(const narc_chain_arc *arc) {
    const double angle[] = {arc->start, arc->start + arc->turn};
    const bool is_concave = arc->turn < 0;
    narc_curve c = {.from = narc_find_chain_start(arc),
                    .to = narc_find_chain_end(arc),
                    .center = {arc->x, arc->y},
                    .radius = fabs(arc->radius),
                    .turned = arc->turned,
                    .turn = arc->turn,
                    .number = arc->number};
    narc_point normals[2];
    for (int k = 0; k < 2; k++)
        narc_find_normal(angle[k], &normals[k].x, &normals[k].y);
    c.u = is_concave ? (narc_point){-normals[1].x, -normals[1].y} : normals[0];
    c.v = is_concave ? (narc_point){-normals[0].x, -normals[0].y} : normals[1];
    return c;
}

static void collect_curves(narc_chain *chain, narc_curves *t) {
    const bool is_convex = chain->arcs[0].turn > 0; /* if closed, its first and last arc are parts of one */
    for (size_t k = 0; k < chain->count; k++) {
        narc_chain_arc *arc = &chain->arcs[k];
        arc->turned = t->turn;
        if (k > 0) {
            const narc_point from = narc_find_chain_end(arc - 1), to = narc_find_chain_start(arc);
            if (fmax(fabs(to.x - from.x), fabs(to.y - from.y)) > narc_find_chain_room(arc - 1, arc))
                t->curves[t->count++] = (narc_curve){.from = from, .to = to, .turned = t->turn, .number = arc->number};
        }
        arc->curve = t->count;
        narc_chain_arc part = *arc;
        if (chain->closed && k + 1 == chain->count) /* up to where the first one begins */
            part.turn = is_convex ? narc_wrap_angle(chain->arcs[0].start - arc->start) : 0;
        if (arc->radius != 0 && part.turn != 0)
            t->curves[t->count++] = make_arc(&part);
        t->turn += part.turn;
    }
}

narc_status narc_build_curves(narc_chain *chain, const narc_allocator *allocator, narc_curves *out_curves,
                              narc_error *error) {
    const size_t most = 2 * chain->count;
    size_t nodes = 2;
    while (nodes < 2 * most)
        nodes *= 2;
    narc_curves t = {.closed = chain->closed};
    if (most <= SIZE_MAX / (sizeof *t.curves + 4 * sizeof *t.nodes))
        t.curves = allocator->allocate(most * sizeof *t.curves + nodes * sizeof *t.nodes, allocator->context);
    if (!t.curves)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for %zu arcs", chain->count);
    t.nodes = (void *)(t.curves + most);
    collect_curves(chain, &t);
    if (t.count > 0)
        build_node(&t, (narc_span){0, 0, t.count});
    *out_curves = t;
    return NARC_OK;
}
