/* SPDX-License-Identifier: MIT
 *
 * cut.c - approximate convex decomposition (after Lien and Amato 2006): a piece that is too far from convex is cut from
 * one of its deepest bays to where that leaves least empty ground in the hulls of both halves.
 *
 * A piece is a ring of points of the region, with lines of contours and cuts between them. Whatever the cuts are, the
 * pieces hold all of the region: winding numbers of both halves add up to those of the whole, and a hull holds all
 * points round which its ring winds.
 */
#include "parts/cut.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/crossings.h"
#include "outline/hull.h"
#include "outline/path.h"
#include "outline/vector.h"

/* Bays from which cuts are tried, and how near they may be, in parts of the extent. */
enum { STARTS = 8 };
static const double APART = 1.0 / 64;

/* Of more nodes than that some are left out as ends of cuts: time grows with the number of nodes then, not with its
 * square, and halves are searched better. */
enum { MOST_ENDS = 256 };

/* A point that turns right by less than this, as the sine of the angle, is no bay. */
static const double STRAIGHT = 0.02;

/* What is walked there and back has less area than this, in parts of the extent's square. */
static const double NOTHING = 1e-14;

/* A length of cuts, in parts of the extent, that weighs as much as a cell whose distance is a cell's size: of cuts that
 * are equally good the shortest is taken. */
static const double CUT_WEIGHT = 0.1;

/* A point of a ring: its place in the region's points, and whether a cut goes from there to the next. */
typedef struct node {
    uint32_t point;
    bool is_cut;
} node;

typedef struct ring {
    node *nodes;
    size_t count;
} ring;

typedef struct ring_list {
    ring *items;
    size_t count, capacity;
} ring_list;

/* A ring's node by its place. */
typedef struct placed {
    narc_point at;
    size_t node;
} placed;

/* Room for a ring's work, as large as the largest ring can be. */
typedef struct work {
    const narc_region *region;
    ring_list rings; /* those that are not cut yet */
    double *depths;
    placed *order; /* a ring's nodes */
    narc_point *points, *corners;
} work;

/* ---------------------------------------------------------------------------- hulls */

size_t narc_wrap_points(narc_point *points, size_t count, narc_point *out_corners) {
    qsort(points, count, sizeof *points, compare_points);
    return narc_wrap_sorted(points, count, 0, out_corners);
}

static narc_point place(const work *w, node at) { return w->region->points[at.point]; }

/* The hull of the ring's nodes themselves, into w->corners. */
static size_t wrap_nodes(const work *w, const ring *of) {
    for (size_t k = 0; k < of->count; k++)
        w->points[k] = place(w, of->nodes[k]);
    return narc_wrap_points(w->points, of->count, w->corners);
}

/* ---------------------------------------------------------------------------- rings */

static bool add_ring(work *w, ring added) {
    ring *items = narc_grow(w->rings.items, &w->rings.capacity, w->rings.count + 1, sizeof *items);
    if (!items) {
        free(added.nodes);
        return false;
    }
    w->rings.items = items;
    items[w->rings.count++] = added;
    return true;
}

/* The nodes of one contour, from its node `first` on. */
static void copy_contour(const narc_region *region, size_t contour, size_t first, node *out_nodes) {
    const size_t begin = begin_of(region->kept_ends, contour), count = region->kept_ends[contour] - begin;
    for (size_t k = 0; k < count; k++)
        out_nodes[k] = (node){region->kept[begin + (first + k) % count], false};
}

/* The bridge from a hole to a ring: the shortest between their nodes. */
typedef struct bridge {
    size_t hole, from, to; /* contour, its node, the ring's */
    double length;
} bridge;

static void shorten_bridge(const work *w, const ring *to, size_t first, bridge *at) {
    const narc_region *region = w->region;
    const size_t begin = begin_of(region->kept_ends, at->hole);
    for (size_t k = begin; k < region->kept_ends[at->hole]; k++) {
        for (size_t i = first; i < to->count; i++) {
            const narc_point away = minus(region->points[region->kept[k]], place(w, to->nodes[i]));
            if (dot(away, away) < at->length) {
                at->length = dot(away, away);
                at->from = k - begin;
                at->to = to->nodes[i].point;
            }
        }
    }
}

/* Puts a hole's nodes into a ring, behind a node of it, with the bridge there and back. */
static bool insert_hole(const work *w, const bridge *at, ring *into) {
    const narc_region *region = w->region;
    const size_t count = region->kept_ends[at->hole] - begin_of(region->kept_ends, at->hole), more = count + 2;
    node *nodes = realloc(into->nodes, (into->count + more) * sizeof *nodes);
    if (!nodes)
        return false;
    into->nodes = nodes;
    size_t k = 0;
    while (nodes[k].point != at->to)
        k++;
    memmove(nodes + k + more, nodes + k, (into->count - k) * sizeof *nodes);
    nodes[k].is_cut = true;
    copy_contour(region, at->hole, at->from, nodes + k + 1);
    nodes[k + 1 + count] = (node){nodes[k + 1].point, true};
    into->count += more;
    return true;
}

/* A hole that no point of its hull is far from what is around it may be filled. */
static bool can_fill(const work *w, size_t hole) {
    const size_t begin = begin_of(w->region->kept_ends, hole), count = w->region->kept_ends[hole] - begin;
    for (size_t k = 0; k < count; k++)
        w->points[k] = w->region->points[w->region->kept[begin + k]];
    return narc_is_within_limit(w->region, w->corners, narc_wrap_points(w->points, count, w->corners));
}

/* An outer contour with its holes, the nearest first. */
static bool add_contour(work *w, size_t contour) {
    const narc_region *region = w->region;
    ring made = {.count = region->kept_ends[contour] - begin_of(region->kept_ends, contour)};
    made.nodes = malloc(made.count * sizeof *made.nodes);
    bridge *bridges = malloc(region->count * sizeof *bridges);
    bool done = made.nodes && bridges;
    size_t holes = 0;
    if (done)
        copy_contour(region, contour, 0, made.nodes);
    for (size_t k = 0; done && k < region->count; k++)
        if (region->parents[k] == contour && !can_fill(w, k))
            bridges[holes++] = (bridge){.hole = k, .length = INFINITY};
    for (size_t k = 0; k < holes; k++)
        shorten_bridge(w, &made, 0, &bridges[k]);
    while (done && holes > 0) {
        size_t nearest = 0;
        for (size_t k = 1; k < holes; k++)
            nearest = bridges[k].length < bridges[nearest].length ? k : nearest;
        const bridge chosen = bridges[nearest];
        bridges[nearest] = bridges[--holes];
        done = insert_hole(w, &chosen, &made);
        const size_t begin = begin_of(region->kept_ends, chosen.hole);
        ring added = {.count = region->kept_ends[chosen.hole] - begin};
        added.nodes = malloc(added.count * sizeof *added.nodes);
        done = done && added.nodes;
        if (done)
            copy_contour(region, chosen.hole, 0, added.nodes);
        for (size_t k = 0; done && k < holes; k++)
            shorten_bridge(w, &added, 0, &bridges[k]);
        free(added.nodes);
    }
    free(bridges);
    if (!done)
        free(made.nodes);
    return done && add_ring(w, made);
}

/* ---------------------------------------------------------------------------- the best cut */

/* The ways to a node and on from it, past others in its place: bridges may have no length. */
static void find_ways(const work *w, const ring *of, size_t k, narc_point *out_in, narc_point *out_on) {
    const size_t n = of->count;
    const narc_point p = place(w, of->nodes[k]);
    *out_in = *out_on = (narc_point){0, 0};
    for (size_t i = 1; i < n && out_in->x == 0 && out_in->y == 0; i++)
        *out_in = minus(p, place(w, of->nodes[(k + n - i) % n]));
    for (size_t i = 1; i < n && out_on->x == 0 && out_on->y == 0; i++)
        *out_on = minus(place(w, of->nodes[(k + i) % n]), p);
}

/* Does a direction go from the ring's node to its inside? */
static bool goes_inside(const work *w, const ring *of, size_t k, narc_point direction) {
    narc_point in, out;
    find_ways(w, of, k, &in, &out);
    const bool left_of_in = cross(in, direction) > 0, left_of_out = cross(out, direction) > 0;
    return cross(in, out) >= 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
}

static double turn_of(narc_point a, narc_point b, narc_point c) { return cross(minus(b, a), minus(c, a)); }

/* Is the cut inside the ring, but for points that it touches? */
static bool is_open(const work *w, const ring *of, size_t i, size_t j) {
    const narc_point a = place(w, of->nodes[i]), b = place(w, of->nodes[j]);
    if (!goes_inside(w, of, i, minus(b, a)) || !goes_inside(w, of, j, minus(a, b)))
        return false;
    narc_point p = place(w, of->nodes[of->count - 1]);
    for (size_t k = 0; k < of->count; k++) {
        const narc_point q = place(w, of->nodes[k]);
        if (turn_of(a, b, p) * turn_of(a, b, q) < 0 && turn_of(p, q, a) * turn_of(p, q, b) < 0)
            return false;
        p = q;
    }
    return true;
}

/* The emptiness of the hull of nodes i to j, of one side of a cut. */
static double measure_side(const work *w, const ring *of, size_t i, size_t j) {
    size_t count = 0;
    for (size_t k = 0; k < of->count; k++) {
        const size_t n = w->order[k].node;
        if (i < j ? n >= i && n <= j : n >= i || n <= j)
            w->points[count++] = w->order[k].at;
    }
    return narc_measure_emptiness(w->region, w->corners, narc_wrap_sorted(w->points, count, 0, w->corners), NULL);
}

static int compare_places(const void *left, const void *right) {
    const placed *a = left, *b = right;
    const int order = compare_points(&a->at, &b->at);
    return order ? order : (a->node > b->node) - (a->node < b->node);
}

static void sort_nodes(const work *w, const ring *of) {
    for (size_t k = 0; k < of->count; k++)
        w->order[k] = (placed){place(w, of->nodes[k]), k};
    qsort(w->order, of->count, sizeof *w->order, compare_places);
}

/* How deep each node lies in the hull, if the ring turns right there; else 0. */
static void find_depths(const work *w, const ring *of) {
    const size_t count = wrap_nodes(w, of);
    for (size_t k = 0; k < of->count; k++) {
        const narc_point p = place(w, of->nodes[k]);
        narc_point in, out;
        find_ways(w, of, k, &in, &out);
        double depth = INFINITY;
        if (cross(in, out) >= -STRAIGHT * length(in) * length(out) && !(cross(in, out) == 0 && dot(in, out) < 0))
            depth = 0;
        for (size_t i = 0; i < count && depth > 0; i++) {
            const narc_point a = w->corners[i], side = minus(w->corners[(i + 1) % count], a);
            depth = fmin(depth, fmax(0, cross(side, minus(p, a))) / fmax(length(side), 1e-300));
        }
        w->depths[k] = depth;
    }
}

/* The deepest nodes that are apart. Returns how many. */
static size_t choose_starts(const work *w, const ring *of, size_t *out_starts) {
    size_t count = 0;
    while (count < STARTS) {
        size_t deepest = 0;
        for (size_t k = 1; k < of->count; k++)
            deepest = w->depths[k] > w->depths[deepest] ? k : deepest;
        if (!(w->depths[deepest] > 0))
            break;
        out_starts[count++] = deepest;
        const narc_point p = place(w, of->nodes[deepest]);
        for (size_t k = 0; k < of->count; k++)
            if (length(minus(place(w, of->nodes[k]), p)) <= APART * w->region->extent)
                w->depths[k] = 0;
    }
    return count;
}

/* The cut from one start that leaves least, of every `stride`th end; returns what that is. */
static double try_start(const work *w, const ring *of, size_t start, size_t stride, double least, size_t *out_end) {
    const size_t n = of->count;
    for (size_t step = 2; step + 1 < n; step += stride) {
        const size_t end = (start + step) % n;
        if (!is_open(w, of, start, end))
            continue;
        const double size = length(minus(place(w, of->nodes[start]), place(w, of->nodes[end])));
        double cost = CUT_WEIGHT * size / w->region->extent;
        if (cost < least)
            cost += measure_side(w, of, start, end);
        if (cost < least)
            cost += measure_side(w, of, end, start);
        if (cost < least) {
            least = cost;
            *out_end = end;
        }
    }
    return least;
}

/* Twice the area of the side from node i to node j. */
static double measure_ring(const work *w, const ring *of, size_t i, size_t j) {
    const narc_point base = place(w, of->nodes[i]);
    double twice = 0;
    for (size_t k = i + 1; k < j; k++)
        twice += cross(minus(place(w, of->nodes[k]), base), minus(place(w, of->nodes[k + 1]), base));
    return twice;
}

/* A ring that comes to a place twice, with its inside on the left of both ways round, is two that touch there. The nodes
 * are in order. */
static bool find_pinch(const work *w, const ring *of, size_t *out_i, size_t *out_j) {
    const double nothing = NOTHING * w->region->extent * w->region->extent;
    for (size_t k = 0; k < of->count; k++)
        for (size_t next = k + 1; next < of->count && is_same(w->order[k].at, w->order[next].at); next++) {
            const size_t i = w->order[k].node, j = w->order[next].node;
            const double side = measure_ring(w, of, i, j), other = measure_ring(w, of, 0, of->count - 1) - side;
            const bool is_spike = j - i > 2 && fabs(side) <= nothing;
            if ((side > 0 || is_spike) && other > 0) {
                *out_i = i;
                *out_j = j;
                return true;
            }
        }
    return false;
}

/* Where to cut a ring of four nodes or more: from its deepest bays to some ends, or to any, or else from any node. If no cut
 * is open, anywhere: both halves are smaller. */
static void find_cut(const work *w, const ring *of, size_t *out_i, size_t *out_j) {
    size_t starts[STARTS], end = 0;
    sort_nodes(w, of);
    if (find_pinch(w, of, out_i, out_j))
        return;
    find_depths(w, of);
    const size_t count = choose_starts(w, of, starts);
    *out_i = 0;
    *out_j = of->count / 2;
    double least = INFINITY;
    for (size_t k = 0; k < 2 * count + of->count; k++) {
        const bool is_round = k == 0 || k == count || k >= 2 * count; /* what was tried before may be enough */
        if (is_round && !isinf(least))
            break;
        const size_t start = k < 2 * count ? starts[k % count] : k - 2 * count;
        const double cost = try_start(w, of, start, k < count ? 1 + of->count / MOST_ENDS : 1, least, &end);
        if (cost < least) {
            least = cost;
            *out_i = start;
            *out_j = end;
        }
    }
}

/* ---------------------------------------------------------------------------- pieces */

/* The ring's part from node i to node j, and the cut back. */
static ring take_side(const ring *of, size_t i, size_t j) {
    ring side = {.count = (j + of->count - i) % of->count + 1};
    side.nodes = malloc(side.count * sizeof *side.nodes);
    for (size_t k = 0; side.nodes && k < side.count; k++)
        side.nodes[k] = of->nodes[(i + k) % of->count];
    if (side.nodes)
        side.nodes[side.count - 1].is_cut = true;
    return side;
}

static narc_status add_piece(narc_pieces *pieces, narc_piece added) {
    narc_piece *items = narc_grow(pieces->items, &pieces->capacity, pieces->count + 1, sizeof *items);
    if (!items) {
        free(added.corners);
        return NARC_ERROR_MEMORY;
    }
    pieces->items = items;
    items[pieces->count++] = added;
    return NARC_OK;
}

/* Adds points of the contour from one node to the next; NULL: only counts them. */
static size_t list_points(const narc_region *region, node from, node to, narc_point *out_points) {
    const size_t contour = narc_find_contour(region->ends, region->count, from.point),
                 begin = begin_of(region->ends, contour);
    size_t count = 0;
    for (size_t k = from.point; count == 0 || (k != to.point && !from.is_cut);
         k = k + 1 < region->ends[contour] ? k + 1 : begin) {
        if (out_points)
            out_points[count] = region->points[k];
        count++;
    }
    return count;
}

/* The hull of all points of a ring's contours, not those of the simpler ones only. */
static narc_status finish_ring(const narc_region *region, const ring *of, narc_pieces *pieces) {
    size_t count = 0;
    for (size_t k = 0; k < of->count; k++)
        count += list_points(region, of->nodes[k], of->nodes[(k + 1) % of->count], NULL);
    narc_point *points = malloc(count * sizeof *points);
    narc_piece made = {.corners = malloc((count + 1) * sizeof *made.corners)};
    if (!points || !made.corners) {
        free(points);
        free(made.corners);
        return NARC_ERROR_MEMORY;
    }
    count = 0;
    for (size_t k = 0; k < of->count; k++)
        count += list_points(region, of->nodes[k], of->nodes[(k + 1) % of->count], points + count);
    made.count = narc_wrap_points(points, count, made.corners);
    free(points);
    return add_piece(pieces, made);
}

static narc_status cut_ring(work *w, ring of, narc_pieces *pieces) {
    size_t i, j;
    if (of.count <= 3 || narc_is_within_limit(w->region, w->corners, wrap_nodes(w, &of))) {
        const narc_status status = finish_ring(w->region, &of, pieces);
        free(of.nodes);
        return status;
    }
    find_cut(w, &of, &i, &j);
    const ring low = take_side(&of, i, j), high = take_side(&of, j, i);
    free(of.nodes);
    if (low.nodes && high.nodes && add_ring(w, low))
        return add_ring(w, high) ? NARC_OK : NARC_ERROR_MEMORY;
    if (!low.nodes || !high.nodes)
        free(low.nodes);
    free(high.nodes);
    return NARC_ERROR_MEMORY;
}

narc_status narc_cut_region(const narc_region *region, size_t most, narc_pieces *out_pieces) {
    /* A ring has each point of its contours, and two more of each hole. */
    const size_t room = region->kept_ends[region->count - 1] + 2 * region->count + 1;
    work w = {.region = region,
              .depths = malloc(room * sizeof *w.depths),
              .order = malloc(room * sizeof *w.order),
              .points = malloc(room * sizeof *w.points),
              .corners = malloc((room + 1) * sizeof *w.corners)};
    narc_pieces pieces = {0};
    narc_status status = w.depths && w.order && w.points && w.corners ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t k = 0; k < region->count && !status; k++)
        if (region->parents[k] == SIZE_MAX && !add_contour(&w, k))
            status = NARC_ERROR_MEMORY;
    while (w.rings.count && !status)
        if (w.rings.count + pieces.count > most)
            status = NARC_ERROR_CAPACITY;
        else
            status = cut_ring(&w, w.rings.items[--w.rings.count], &pieces);
    for (size_t k = 0; k < w.rings.count; k++)
        free(w.rings.items[k].nodes);
    free(w.rings.items);
    free(w.depths);
    free(w.order);
    free(w.points);
    free(w.corners);
    if (status)
        narc_release_pieces(&pieces);
    else
        *out_pieces = pieces;
    return status;
}

void narc_release_pieces(narc_pieces *pieces) {
    for (size_t k = 0; k < pieces->count; k++)
        free(pieces->items[k].corners);
    free(pieces->items);
    *pieces = (narc_pieces){0};
}
