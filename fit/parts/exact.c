/* SPDX-License-Identifier: MIT
 *
 * exact.c - an outline of lines and convex arcs as convex parts that are just it: no tolerance, no laps.
 *
 * Every corner that turns inwards needs an end of a cut in the cone between the extensions of its two sides; then none of the
 * angles it is left with turns inwards. A cut that joins two such corners within both cones serves both: first a set of these that
 * do not cross is taken, those first that rule out fewest others. Each corner that is left is cut along the shorter extension
 * of its sides, to where that meets an outline or another cut. A cut from a hole joins it to what is around.
 */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/crossings.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "result/finish.h"

/* Corners this near, in parts of the extent, are one; directions that differ by less, as a sine, are the same. */
static const double NEAR = 1e-10, STRAIGHT = 1e-9;

/* Of cuts that serve two corners the shortest are looked at. */
enum { MOST_PAIRS = 4096 };

/* A corner of a ring, with the inside on its left, and what leads to the next: a line, or an arc that turns to the left. */
typedef struct corner {
    narc_point at, center;
    double radius; /* 0: a line */
    size_t next, last;
} corner;

typedef struct rings {
    corner *items;
    size_t count, capacity;
    double near;
} rings;

/* A cut to a corner, or to a point of the line or arc behind it. */
typedef struct hit {
    size_t at;
    double way;
    narc_point point;
    bool is_corner;
} hit;

typedef struct pair {
    size_t a, b, conflicts;
    double size;
    bool gone;
} pair;

static narc_status fail_memory(narc_error *error) {
    return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for the parts of an outline");
}

/* ---------------------------------------------------------------------------- corners */

static narc_point leave(const rings *r, size_t k) {
    const corner *c = &r->items[k];
    return unit(c->radius > 0 ? turned(minus(c->at, c->center)) : minus(r->items[c->next].at, c->at));
}

static narc_point arrive(const rings *r, size_t k) {
    const corner *c = &r->items[k], *from = &r->items[c->last];
    return unit(from->radius > 0 ? turned(minus(c->at, from->center)) : minus(c->at, from->at));
}

static bool turns_inwards(const rings *r, size_t k) { return cross(arrive(r, k), leave(r, k)) < -STRAIGHT; }

/* Does a cut from there leave no corner that turns inwards? */
static bool settles(const rings *r, size_t k, narc_point way) {
    return cross(arrive(r, k), way) >= -STRAIGHT && cross(leave(r, k), way) >= -STRAIGHT;
}

/* Is the inside there, from a corner? */
static bool leads_inside(const rings *r, size_t k, narc_point way) {
    const narc_point in = arrive(r, k), out = leave(r, k);
    const bool left_of_in = cross(in, way) >= -STRAIGHT, left_of_out = cross(out, way) >= -STRAIGHT;
    return cross(in, out) < -STRAIGHT ? left_of_in || left_of_out : left_of_in && left_of_out;
}

static bool add_corner(rings *r, corner added) {
    corner *items = narc_grow(r->items, &r->capacity, r->count + 1, sizeof *items);
    if (!items)
        return false;
    r->items = items;
    items[r->count++] = added;
    return true;
}

/* ---------------------------------------------------------------------------- cuts */

static bool is_on_arc(const corner *from, narc_point end, narc_point p) {
    const narc_point a = minus(from->at, from->center), b = minus(end, from->center), q = minus(p, from->center);
    const double room = -STRAIGHT * from->radius * from->radius;
    return cross(a, q) >= room && cross(q, b) >= room;
}

/* How far the line or arc behind a corner is along a ray that leaves the inside there; INFINITY: nowhere. */
static double meet(const rings *r, const corner *c, narc_point from, narc_point way) {
    const narc_point end = r->items[c->next].at;
    if (c->radius > 0) {
        const narc_point to = minus(c->center, from);
        const double middle = dot(to, way), off = cross(to, way), square = c->radius * c->radius - off * off;
        const double at = middle + sqrt(fmax(0, square));
        return square > 0 && is_on_arc(c, end, along(from, at, way)) ? at : INFINITY;
    }
    const narc_point side = minus(end, c->at), to = minus(c->at, from);
    const double size = length(side), slope = cross(side, way);
    if (!(slope < -STRAIGHT * size))
        return INFINITY;
    const double part = cross(to, way) / -slope, slack = r->near / size;
    return part >= -slack && part <= 1 + slack ? cross(to, side) / -slope : INFINITY;
}

/* Where a ray from a corner first comes to an outline or a cut. Corners come before what leads to them. */
static bool find_hit(const rings *r, size_t k, narc_point way, hit *out) {
    const narc_point from = r->items[k].at;
    hit best = {.way = INFINITY}, corner_hit = {.way = INFINITY};
    for (size_t i = 0; i < r->count; i++) {
        const corner *c = &r->items[i];
        const narc_point to = minus(c->at, from);
        const double far = dot(to, way), at = meet(r, c, from, way);
        if (far > r->near && far < corner_hit.way && fabs(cross(to, way)) <= r->near &&
            leads_inside(r, i, minus((narc_point){0, 0}, way)))
            corner_hit = (hit){i, far, c->at, true};
        if (at > r->near && at < best.way)
            best = (hit){i, at, along(from, at, way), false};
    }
    *out = corner_hit.way <= best.way + 2 * r->near ? corner_hit : best;
    return isfinite(out->way);
}

/* Two corners, each of which becomes two: the copies have what leads on from there. */
static bool join(rings *r, size_t a, size_t b) {
    const size_t a2 = r->count, b2 = a2 + 1;
    if (!add_corner(r, r->items[a]) || !add_corner(r, r->items[b]))
        return false;
    corner *items = r->items;
    items[items[a].next].last = a2;
    items[items[b].next].last = b2;
    items[a].radius = items[b].radius = 0;
    items[a].next = b2;
    items[b2].last = a;
    items[b].next = a2;
    items[a2].last = b;
    return true;
}

static bool cut_to(rings *r, size_t k, const hit *to) {
    size_t end = to->at;
    if (!to->is_corner) {
        corner middle = r->items[end];
        middle.at = to->point;
        middle.last = end;
        if (!add_corner(r, middle))
            return false;
        end = r->count - 1;
        r->items[middle.next].last = end;
        r->items[to->at].next = end;
    }
    return join(r, k, end);
}

static int compare_pairs(const void *left, const void *right) {
    const pair *a = left, *b = right;
    return a->size != b->size ? (a->size > b->size) - (a->size < b->size)
           : a->a != b->a     ? (a->a > b->a) - (a->a < b->a)
                              : (a->b > b->b) - (a->b < b->b);
}

static bool conflict(const rings *r, const pair *p, const pair *q) {
    if (p->a == q->a || p->a == q->b || p->b == q->a || p->b == q->b)
        return true;
    const narc_point a = r->items[p->a].at, b = r->items[p->b].at, c = r->items[q->a].at, d = r->items[q->b].at;
    const narc_point ab = minus(b, a), cd = minus(d, c);
    return cross(ab, minus(c, a)) * cross(ab, minus(d, a)) < 0 && cross(cd, minus(a, c)) * cross(cd, minus(b, c)) < 0;
}

/* All cuts that serve two corners. */
static bool list_pairs(const rings *r, pair **out_pairs, size_t *out_count) {
    size_t *inwards = malloc((r->count + 1) * sizeof *inwards), count = 0, room = 0;
    pair *pairs = NULL;
    *out_count = 0;
    for (size_t k = 0; inwards && k < r->count; k++)
        if (turns_inwards(r, k))
            inwards[count++] = k;
    bool done = inwards;
    for (size_t i = 0; done && i < count; i++)
        for (size_t k = i + 1; done && k < count; k++) {
            const size_t a = inwards[i], b = inwards[k];
            const narc_point step = minus(r->items[b].at, r->items[a].at), way = unit(step);
            hit met;
            if (!(length(step) > r->near) || !settles(r, a, way) || !settles(r, b, minus((narc_point){0, 0}, way)) ||
                !find_hit(r, a, way, &met) || !met.is_corner || met.at != b)
                continue;
            pair *grown = narc_grow(pairs, &room, *out_count + 1, sizeof *pairs);
            done = grown;
            pairs = done ? grown : pairs;
            if (done)
                pairs[(*out_count)++] = (pair){a, b, 0, length(step), false};
        }
    free(inwards);
    *out_pairs = pairs;
    return done;
}

static bool cut_pairs(rings *r) {
    pair *pairs;
    size_t count;
    bool done = list_pairs(r, &pairs, &count);
    if (done && count)
        qsort(pairs, count, sizeof *pairs, compare_pairs);
    count = count < MOST_PAIRS ? count : MOST_PAIRS;
    for (size_t i = 0; done && i < count; i++)
        for (size_t k = 0; k < count; k++)
            pairs[i].conflicts += i != k && conflict(r, &pairs[i], &pairs[k]);
    while (done) {
        pair *best = NULL;
        for (size_t i = 0; i < count; i++)
            if (!pairs[i].gone && (!best || pairs[i].conflicts < best->conflicts))
                best = &pairs[i];
        if (!best)
            break;
        best->gone = true;
        for (size_t i = 0; i < count; i++) {
            if (pairs[i].gone || !conflict(r, best, &pairs[i]))
                continue;
            pairs[i].gone = true;
            for (size_t k = 0; k < count; k++)
                pairs[k].conflicts -= !pairs[k].gone && conflict(r, &pairs[i], &pairs[k]);
        }
        done = join(r, best->a, best->b);
    }
    free(pairs);
    return done;
}

/* The rest, each along the shorter extension of its sides. */
static narc_status cut_corners(rings *r, narc_error *error) {
    for (size_t k = 0; k < r->count; k++) {
        if (!turns_inwards(r, k))
            continue;
        hit ahead, behind;
        const bool on = find_hit(r, k, arrive(r, k), &ahead);
        const bool back = find_hit(r, k, minus((narc_point){0, 0}, leave(r, k)), &behind);
        if (!on && !back)
            return narc_fail(error, NARC_ERROR_NOT_SIMPLE, 0, r->items[k].at.x,
                             "no cut is found from %g, %g: lines may touch near there", r->items[k].at.x,
                             r->items[k].at.y);
        if (!cut_to(r, k, on && (!back || ahead.way <= behind.way) ? &ahead : &behind))
            return fail_memory(error);
    }
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- rings from a path */

static narc_point turn_about(narc_point center, narc_point p, double angle) {
    const narc_point u = unit_at(angle), q = minus(p, center);
    return (narc_point){center.x + u.x * q.x - u.y * q.y, center.y + u.x * q.y + u.y * q.x};
}

/* A contour is a hole if an odd number of others is around it. */
static bool is_hole(const narc_contours *flat, size_t contour) {
    const narc_point p = flat->points[begin_of(flat->ends, contour)];
    bool hole = false;
    for (size_t k = 0; k < flat->count; k++) {
        const size_t begin = begin_of(flat->ends, k);
        if (k != contour && is_around(flat->points + begin, flat->ends[k] - begin, p))
            hole = !hole;
    }
    return hole;
}

static double measure_signed(const narc_contours *flat, size_t contour) {
    double area = 0;
    const size_t begin = begin_of(flat->ends, contour), end = flat->ends[contour];
    for (size_t k = begin; k < end; k++)
        area += cross(minus(flat->points[k], flat->points[begin]),
                      minus(flat->points[k + 1 < end ? k + 1 : begin], flat->points[begin]));
    return area / 2;
}

/* Links the corners of a ring, from `first` on; the other way round if need be. Arcs must turn to the left then. */
static void close_ring(rings *r, size_t first, bool reversed) {
    const size_t count = r->count - first;
    for (size_t k = 0; reversed && k < count / 2; k++) {
        const corner kept = r->items[first + k];
        r->items[first + k] = r->items[r->count - 1 - k];
        r->items[r->count - 1 - k] = kept;
    }
    if (reversed) { /* what led to the next corner leads from it now */
        const corner begin = r->items[first];
        for (size_t k = first; k + 1 < r->count; k++) {
            r->items[k].center = r->items[k + 1].center;
            r->items[k].radius = r->items[k + 1].radius;
        }
        r->items[r->count - 1].center = begin.center;
        r->items[r->count - 1].radius = begin.radius;
    }
    for (size_t k = 0; k < count; k++) {
        r->items[first + k].next = first + (k + 1) % count;
        r->items[first + k].last = first + (k + count - 1) % count;
    }
}

/* A line, or an arc in two halves, from the last corner on. */
static bool add_piece(rings *r, const narc_drawn_move *move) {
    const narc_point p = move->controls[0], q = move->controls[move->degree];
    if (!move->is_arc)
        return length(minus(q, p)) <= r->near || add_corner(r, (corner){.at = p});
    const narc_curve_arc arc = narc_find_arc(move);
    if (arc.turn == 0)
        return length(minus(q, p)) <= r->near || add_corner(r, (corner){.at = p});
    const bool half = fabs(arc.turn) > PI / 2;
    return add_corner(r, (corner){p, arc.center, arc.radius, 0, 0}) &&
           (!half || add_corner(r, (corner){turn_about(arc.center, p, arc.turn / 2), arc.center, arc.radius, 0, 0}));
}

static narc_status refuse(const narc_drawn_move *move, size_t number, const char *what, narc_error *error) {
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, move->contour, (double)number,
                     "contour %zu, piece %zu is %s: convex parts come only near it, within a tolerance", move->contour,
                     number, what);
}

/* Contour by contour: `first` is the first corner of one, `end` the move behind it. */
static narc_status make_rings(const narc_path *path, const narc_contours *flat, rings *r, narc_error *error) {
    size_t first = 0, number = 0, contour = 0;
    bool reversed = false, any = false;
    narc_point begin = {0, 0}, last = {0, 0};
    for (narc_drawn_move move = {0};;) {
        const bool more = narc_next_drawn(path, &move);
        if (any && (!more || move.begins)) {
            const narc_drawn_move closing = {.controls = (narc_point[]){last, begin}, .degree = 1};
            if (!add_piece(r, &closing))
                return fail_memory(error);
            close_ring(r, first, reversed);
        }
        if (!more)
            return NARC_OK;
        if (move.begins) {
            contour = move.contour;
            reversed = (measure_signed(flat, contour) < 0) != is_hole(flat, contour);
            first = r->count;
            number = 0;
            begin = move.controls[0];
            any = true;
        }
        if (move.degree > 1 && !move.is_arc)
            return refuse(&move, number, "a curve", error);
        const double turn = move.is_arc ? narc_find_arc(&move).turn : 0;
        if (reversed ? turn > 0 : turn < 0)
            return refuse(&move, number, "a concave arc", error);
        if (!add_piece(r, &move))
            return fail_memory(error);
        last = move.controls[move.degree];
        number++;
    }
}

/* ---------------------------------------------------------------------------- parts */

/* Does the arc before a corner go on behind it? */
static bool goes_on(const rings *r, size_t k) {
    const corner *c = &r->items[k], *from = &r->items[c->last];
    return c->radius > 0 && c->radius == from->radius && is_same(c->center, from->center);
}

/* The arcs of a ring, as many as `most`: what leads on is an arc or a line, between them corners. Returns the count, or
 * what it would be. */
static size_t list_arcs(const rings *r, size_t first, narc_arc *out, size_t most) {
    size_t begin = r->items[first].next;
    while (begin != first && goes_on(r, begin))
        begin = r->items[begin].next;
    size_t count = 0, k = first = begin;
    do {
        const corner *c = &r->items[k];
        const narc_point in = arrive(r, k), way = leave(r, k);
        const narc_point end = r->items[c->next].at;
        if (cross(in, way) > STRAIGHT || dot(in, way) < 0) {
            if (count < most)
                out[count] = (narc_arc){c->at.x, c->at.y, 0, narc_atan2(-in.x, in.y), narc_atan2(-way.x, way.y)};
            count++;
        }
        if (c->radius > 0) {
            const narc_point a = minus(c->at, c->center), b = minus(end, c->center);
            narc_arc *before = count && count <= most ? &out[count - 1] : NULL;
            const narc_arc arc = {c->center.x, c->center.y, c->radius, narc_atan2(a.y, a.x), narc_atan2(b.y, b.x)};
            double turn = before ? arc.end - before->start : 0;
            turn += turn < 0 ? 2 * PI : 0;
            if (before && before->center_x == arc.center_x && before->center_y == arc.center_y &&
                before->radius == arc.radius && turn <= PI * (1 + STRAIGHT) && turn > 0) {
                before->end = arc.end;
            } else {
                if (count < most)
                    out[count] = arc;
                count++;
            }
        }
        k = c->next;
    } while (k != first);
    return count;
}

/* All arcs on one circle are that; what has the form of a box or polygon gets the angles that their builders make. */
static void tidy_arcs(narc_arc *arcs, size_t *count) {
    bool round = true, sharp = true;
    narc_point corners[NARC_MAX_ARCS];
    for (size_t k = 0; k < *count; k++) {
        const double x = arcs[k].center_x, y = arcs[k].center_y, nothing = STRAIGHT * arcs[0].radius;
        round = round && arcs[k].radius > 0 && fabs(arcs[k].radius - arcs[0].radius) <= nothing &&
                narc_hypot(x, y) <= nothing;
        sharp = sharp && arcs[k].radius == 0;
        corners[k] = (narc_point){arcs[k].center_x, arcs[k].center_y};
    }
    if (round) { /* about its centroid */
        arcs[0] = (narc_arc){0, 0, arcs[0].radius, -PI, PI};
        *count = 1;
    }
    if (!sharp)
        return;
    narc_build_skin_polygon(corners, *count, 0, arcs, count, NULL);
    for (size_t k = 0; k < 4 && *count == 4; k++) {
        const narc_point a = corners[k], b = corners[(k + 1) % 4], c = corners[(k + 2) % 4], d = corners[(k + 3) % 4];
        if (a.x > 0 && a.y > 0 && b.x == -a.x && b.y == a.y && c.x == -a.x && c.y == -a.y && d.x == a.x && d.y == -a.y)
            narc_build_box(2 * a.x, 2 * a.y, 0, arcs, count, NULL);
    }
}

static narc_status make_part(narc_arc *arcs, size_t count, narc_fit_result *out, narc_error *error) {
    narc_mass mass;
    narc_compute_mass(arcs, count, &mass);
    *out = (narc_fit_result){.arc_count = count, .origin = {mass.centroid_x, mass.centroid_y}};
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x = narc_to_single(arcs[k].center_x - out->origin.x);
        arcs[k].center_y = narc_to_single(arcs[k].center_y - out->origin.y);
        arcs[k].radius = narc_to_single(arcs[k].radius);
    }
    tidy_arcs(arcs, &out->arc_count);
    memcpy(out->arcs, arcs, out->arc_count * sizeof *arcs);
    narc_shapes *store = NULL;
    narc_status status = narc_create_shapes(NULL, &store);
    status = status ? fail_memory(error) : narc_add_shape(store, arcs, out->arc_count, NULL, error);
    narc_destroy_shapes(store);
    if (status)
        return status;
    narc_compute_perimeter(arcs, out->arc_count, &out->perimeter);
    out->area = out->hull_area = mass.area;
    out->hull_perimeter = out->perimeter;
    for (size_t k = 0; k < out->arc_count; k++) {
        const narc_arc *a = &arcs[k], *b = &arcs[(k + 1) % out->arc_count];
        out->edge_count += a->center_x != b->center_x || a->center_y != b->center_y;
    }
    return NARC_OK;
}

/* A ring of more arcs than a shape has is cut across its middle. */
static narc_status take_ring(rings *r, size_t first, narc_fit_result *out, size_t capacity, size_t *count,
                             narc_error *error) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t arc_count = list_arcs(r, first, arcs, NARC_MAX_ARCS);
    if (arc_count > NARC_MAX_ARCS) {
        size_t corners = 0, k = first;
        for (size_t i = r->items[first].next; i != first; i = r->items[i].next)
            corners++;
        for (size_t i = 0; i <= corners / 2; i++)
            k = r->items[k].next;
        if (!join(r, first, k))
            return fail_memory(error);
        const narc_status status = take_ring(r, first, out, capacity, count, error);
        return status ? status : take_ring(r, k, out, capacity, count, error);
    }
    if (arc_count == 0)
        return NARC_OK;
    const narc_status status = *count < capacity ? make_part(arcs, arc_count, &out[*count], error) : NARC_OK;
    ++*count;
    return status;
}

static narc_status take_rings(rings *r, narc_fit_result *out, size_t capacity, size_t *out_count, narc_error *error) {
    const size_t all = r->count;
    bool *taken = calloc(all + 1, sizeof *taken);
    narc_status status = taken ? NARC_OK : fail_memory(error);
    *out_count = 0;
    for (size_t k = 0; k < all && !status; k++) {
        if (taken[k])
            continue;
        for (size_t i = k; !taken[i]; i = r->items[i].next)
            taken[i] = true;
        status = take_ring(r, k, out, capacity, out_count, error);
    }
    free(taken);
    return status;
}

static narc_status check_crossings(const narc_path *path, const narc_contours *flat, double near, narc_error *error) {
    narc_crossings crossings;
    narc_status status = narc_find_crossings(flat, true, near, &crossings, error);
    if (!status && crossings.count) {
        const narc_crossing *at = &crossings.items[0];
        const size_t a = narc_find_contour(flat->ends, flat->count, at->line);
        const size_t b = narc_find_contour(flat->ends, flat->count, at->other);
        const size_t piece = narc_find_drawn_line(path, flat, a, at->line - begin_of(flat->ends, a));
        status =
            narc_fail(error, NARC_ERROR_NOT_SIMPLE, a, (double)piece,
                      "contour %zu, piece %zu crosses or touches contour %zu at %g, %g: such outlines are cut within a "
                      "tolerance",
                      a, piece, b, at->at.x, at->at.y);
    }
    free(crossings.items);
    return status;
}

narc_status narc_cut_exactly(const narc_path *path, narc_fit_result *out_parts, size_t capacity, size_t *out_count,
                             narc_error *error) {
    if (!path || !out_count || (!out_parts && capacity))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", !path ? "the path" : "an output");
    narc_contours flat;
    narc_status status = narc_flatten_path(path, 0, &flat, error);
    if (status)
        return status;
    const double extent = extent_of(bound_points(flat.points, flat.point_count));
    rings r = {.near = NEAR * extent};
    size_t inwards = 0, count = 0;
    if (flat.point_count == 0)
        status = narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    else if (path->slack > 0)
        status = narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, path->slack,
                           "it was traced in an image, and has no exact lines: parts come within a tolerance");
    status = status ? status : make_rings(path, &flat, &r, error);
    status = status ? status : check_crossings(path, &flat, 0, error);
    for (size_t k = 0; !status && k < r.count; k++)
        inwards += turns_inwards(&r, k);
    if (!status && inwards > 4 * NARC_MAX_PARTS)
        status = narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)inwards,
                           "%zu corners turn inwards: more than %d parts", inwards, NARC_MAX_PARTS);
    if (!status && !cut_pairs(&r))
        status = fail_memory(error);
    status = status ? status : cut_corners(&r, error);
    status = status ? status : take_rings(&r, out_parts, capacity, &count, error);
    narc_release_contours(&flat);
    free(r.items);
    if (status)
        return status;
    *out_count = count;
    return count <= capacity ? NARC_OK
                             : narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)count,
                                         "it takes %zu convex parts, more than %zu; within a tolerance fewer may do",
                                         count, capacity);
}
