/* SPDX-License-Identifier: MIT
 *
 * parts.c - a body of several shapes: one of them in its place, and the mass of what all of them cover.
 *
 * The union is cut into strips by vertical lines, through all ends of arcs and edges and wherever two of them cross.
 * Within a strip a convex part lies between one curve below and one above, and these keep their order from one side to
 * the other. So the union is what is left of as many intervals, merged as they lie in the strip's middle, and each is
 * bounded by two curves, whose integrals are known.
 *   Nothing depends on whether curves that nearly coincide are found to cross, nor on where: what is taken for the
 * lower one there differs from it by no more than rounding.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "error.h"
#include "memory.h"
#include "outline.h"

narc_status narc_move_arcs(const narc_arc *arcs, size_t count, double x, double y, double angle, double scale,
                           narc_arc *out_arcs, narc_error *error) {
    narc_arc moved[NARC_MAX_ARCS];
    narc_status status = narc_validate_arcs(arcs, count, error);
    if (status != NARC_OK)
        return status;
    if (!out_arcs)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "out_arcs is NULL");
    const double numbers[] = {x, y, angle, scale};
    for (int k = 0; k < 4; k++)
        if (!isfinite(numbers[k]))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, numbers[k], "%s is %g",
                             (const char *[]){"x", "y", "angle", "scale"}[k], numbers[k]);
    if (scale <= 0)
        return narc_fail(error, NARC_ERROR_SIZE, 0, scale, "scale is %g", scale);
    double c, s;
    angle = narc_wrap_angle(angle);
    narc_find_normal(angle, &c, &s);
    for (size_t i = 0; i < count; i++) {
        const narc_arc *const arc = &arcs[i];
        moved[i] = (narc_arc){x + scale * (c * arc->center_x - s * arc->center_y),
                              y + scale * (s * arc->center_x + c * arc->center_y), scale * arc->radius,
                              arc->start + angle, arc->end + angle};
    }
    status = narc_validate_arcs(moved, count, error);
    if (status == NARC_OK)
        memcpy(out_arcs, moved, count * sizeof *moved);
    return status;
}

/* ------------------------------------------------------------------------------------------------ curves */

/* Half an arc at most, or an edge: the graph of a function of x. */
typedef struct curve {
    double from, to;        /* x, rising */
    double from_y, to_y;    /* of an edge */
    narc_point center;      /* of an arc */
    double radius;          /* 0: an edge */
    double lowest, highest; /* y in the strips between two ends of curves */
    size_t part;
    bool above; /* does it bound its part above? Else below */
} curve;

/* What lies between two curves at some x. */
typedef struct interval {
    double low, high;
    const curve *below, *above;
} interval;

typedef struct plane {
    curve *curves;
    curve **active; /* those that cross the strip at hand, part by part */
    interval *intervals;
    size_t count, active_count, interval_count;
    narc_moments sum;
} plane;

/* `start` and `end` are normals, both in the upper half or both in the lower. */
static void put_half(plane *p, curve c, narc_point start, narc_point end) {
    const double first = c.center.x + c.radius * start.x, last = c.center.x + c.radius * end.x;
    c.above = end.x < start.x;
    c.from = c.above ? last : first;
    c.to = c.above ? first : last;
    if (c.from < c.to)
        p->curves[p->count++] = c;
}

static void put_arc(plane *p, curve c, narc_point start, narc_point end) {
    for (int side = -1; side <= 1; side += 2) /* is there a vertical tangent within? At most one is */
        if (-side * start.y > 0 && side * end.y > 0) {
            put_half(p, c, start, (narc_point){side, 0});
            start = (narc_point){side, 0};
        }
    put_half(p, c, start, end);
}

static void put_edge(plane *p, curve c, narc_point start, narc_point end) {
    c.radius = 0;
    c.above = end.x < start.x;
    const narc_point left = c.above ? end : start, right = c.above ? start : end;
    c.from = left.x;
    c.from_y = left.y;
    c.to = right.x;
    c.to_y = right.y;
    if (c.from < c.to)
        p->curves[p->count++] = c;
}

static narc_point add_points(narc_point a, narc_point b) { return (narc_point){a.x + b.x, a.y + b.y}; }

static void put_outline(plane *p, const narc_outline *o, size_t part, narc_point origin) {
    const narc_point by = {o->origin_x - origin.x, o->origin_y - origin.y};
    for (size_t i = 0; i < o->count; i++) {
        const narc_point center = add_points((narc_point){o->center_x[i], o->center_y[i]}, by);
        const curve c = {.center = center, .radius = o->radius[i], .part = part};
        put_arc(p, c, (narc_point){o->normal_x[i], o->normal_y[i]},
                (narc_point){o->normal_x[i + 1], o->normal_y[i + 1]});
        put_edge(p, c, add_points(narc_find_end(o, i), by), add_points(narc_find_start(o, (i + 1) % o->count), by));
    }
}

/* The normal of an arc at x. */
static narc_point find_normal_at(const curve *c, double x) {
    const double u = fmax(-1, fmin((x - c->center.x) / c->radius, 1)), v = sqrt((1 - u) * (1 + u));
    return (narc_point){u, c->above ? v : -v};
}

static double find_y(const curve *c, double x) {
    return c->radius > 0 ? c->center.y + c->radius * find_normal_at(c, x).y
                         : c->from_y + (x - c->from) / (c->to - c->from) * (c->to_y - c->from_y);
}

/* ------------------------------------------------------------------------------------------------ crossings */

/* x where the lines or circles of two curves meet, up to two of them, or else where they are nearest: a strip does not
 * have in its middle, where its curves are told apart, a place where they nearly touch. NAN is none. */
static void cross_curves(const curve *a, const curve *b, double x[2]) {
    x[0] = x[1] = NAN;
    if (a->radius > 0 && b->radius > 0) { /* on the line that both have the same power to */
        const double dx = b->center.x - a->center.x, dy = b->center.y - a->center.y, square = dx * dx + dy * dy;
        const double distance = sqrt(square);
        const double along = (square + (a->radius - b->radius) * (a->radius + b->radius)) / (2 * distance);
        const double across = sqrt(fmax(0, (a->radius - along) * (a->radius + along)));
        x[0] = a->center.x + (along * dx - across * dy) / distance;
        x[1] = a->center.x + (along * dx + across * dy) / distance;
    } else if (a->radius > 0 || b->radius > 0) {
        const curve *const arc = a->radius > 0 ? a : b, *const edge = a->radius > 0 ? b : a;
        const double width = edge->to - edge->from, rise = edge->to_y - edge->from_y, length = narc_hypot(width, rise);
        const double c = width / length, s = rise / length;
        const double px = arc->center.x - edge->from, py = arc->center.y - edge->from_y;
        const double along = c * px + s * py, off = c * py - s * px;
        const double half = sqrt(fmax(0, (arc->radius - off) * (arc->radius + off)));
        x[0] = edge->from + c * (along - half);
        x[1] = edge->from + c * (along + half);
    } else {
        const double left = fmax(a->from, b->from), right = fmin(a->to, b->to);
        const double before = find_y(a, left) - find_y(b, left), behind = find_y(a, right) - find_y(b, right);
        if ((before < 0) != (behind < 0))
            x[0] = left + (right - left) * (before / (before - behind));
    }
}

/* The first crossing of active curves behind x and before `end`, or that. */
static double find_cut(const plane *p, double x, double end) {
    for (size_t i = 1; i < p->active_count; i++)
        for (size_t k = 0; k < i; k++) {
            const curve *const a = p->active[i], *const b = p->active[k];
            double cut[2];
            if (a->part == b->part || a->lowest > b->highest || b->lowest > a->highest)
                continue;
            cross_curves(a, b, cut);
            for (int side = 0; side < 2; side++)
                end = cut[side] > x && cut[side] < end ? cut[side] : end;
        }
    return end;
}

/* ------------------------------------------------------------------------------------------------ strips */

/* The piece of a curve from x to `to`, which is further right below, further left above; returns where it ends. */
static narc_point add_piece(plane *p, const curve *c, narc_point start, double to) {
    const narc_point end = {to, find_y(c, to)};
    narc_add_triangle(&p->sum, start, end);
    if (c->radius > 0) {
        const narc_point first = find_normal_at(c, start.x), last = find_normal_at(c, to);
        const double sine = narc_hypot(last.x - first.x, last.y - first.y); /* of half the sweep, twice */
        const double cosine = narc_hypot(last.x + first.x, last.y + first.y);
        narc_add_segment(&p->sum, c->center.x, c->center.y, c->radius, first.x, first.y, 2 * narc_atan2(sine, cosine));
    }
    return end;
}

static void add_interval(plane *p, const interval *i, double from, double to) {
    const narc_point start = {from, find_y(i->below, from)}, low = add_piece(p, i->below, start, to);
    const narc_point high = {to, find_y(i->above, to)};
    narc_add_triangle(&p->sum, low, high);
    narc_add_triangle(&p->sum, add_piece(p, i->above, high, from), start);
}

/* Puts an interval where its lower end belongs. */
static void insert_interval(plane *p, interval one) {
    size_t k = p->interval_count++;
    for (; k > 0 && p->intervals[k - 1].low > one.low; k--)
        p->intervals[k] = p->intervals[k - 1];
    p->intervals[k] = one;
}

/* What each part covers at x. Where its arcs miss each other a little there may be more than two curves. */
static void find_intervals(plane *p, double x) {
    p->interval_count = 0;
    for (size_t i = 0, next; i < p->active_count; i = next) {
        interval one = {INFINITY, -INFINITY, NULL, NULL};
        for (next = i; next < p->active_count && p->active[next]->part == p->active[i]->part; next++) {
            const curve *const c = p->active[next];
            const double y = find_y(c, x);
            if (c->above && y > one.high) {
                one.high = y;
                one.above = c;
            } else if (!c->above && y < one.low) {
                one.low = y;
                one.below = c;
            }
        }
        if (one.below && one.above)
            insert_interval(p, one);
    }
}

/* Adds what parts cover between two lines. */
static void add_strip(plane *p, double from, double to) {
    find_intervals(p, from + (to - from) / 2);
    for (size_t k = 0, next; k < p->interval_count; k = next) {
        interval all = p->intervals[k];
        for (next = k + 1; next < p->interval_count && p->intervals[next].low <= all.high; next++)
            if (p->intervals[next].high > all.high) {
                all.high = p->intervals[next].high;
                all.above = p->intervals[next].above;
            }
        add_interval(p, &all, from, to);
    }
}

/* The curves between two lines that no curve ends between. */
static void activate_curves(plane *p, double from, double to) {
    p->active_count = 0;
    for (size_t k = 0; k < p->count; k++) {
        curve *const c = &p->curves[k];
        if (c->from > from || c->to < to)
            continue;
        const double left = find_y(c, from), right = find_y(c, to);
        const bool has_top = c->radius > 0 && c->center.x > from && c->center.x < to;
        c->lowest = has_top && !c->above ? c->center.y - c->radius : fmin(left, right);
        c->highest = has_top && c->above ? c->center.y + c->radius : fmax(left, right);
        p->active[p->active_count++] = c;
    }
}

/* The first end of a curve behind x; INFINITY if there is none. */
static double find_end(const plane *p, double x) {
    double end = INFINITY;
    for (size_t k = 0; k < p->count; k++) {
        const curve *const c = &p->curves[k];
        end = c->from > x && c->from < end ? c->from : end;
        end = c->to > x && c->to < end ? c->to : end;
    }
    return end;
}

static void add_all(plane *p) {
    double from = find_end(p, -INFINITY), to;
    for (; from < INFINITY && (to = find_end(p, from)) < INFINITY; from = to) {
        activate_curves(p, from, to);
        for (double cut; from < to; from = cut) {
            cut = find_cut(p, from, to);
            add_strip(p, from, cut);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ the call */

/* Checks the parts, counts the curves that they may have at most, and finds the first one's centroid. */
static narc_status check_parts(const narc_arc *arcs, const size_t *counts, size_t part_count, narc_mass *out_first,
                               size_t *out_curves, narc_error *error) {
    narc_error inner;
    for (size_t part = 0; part < part_count; arcs += counts[part++]) {
        const narc_status status = narc_validate_arcs(arcs, counts[part], &inner);
        if (status != NARC_OK)
            return narc_fail(error, status, part, inner.value, "part %zu: %s", part, inner.message);
        if (part == 0)
            narc_compute_mass(arcs, counts[part], out_first);
        *out_curves += 3 * (counts[part] > 1 ? counts[part] : 2); /* two halves and an edge */
    }
    return NARC_OK;
}

narc_status narc_compute_union_mass(const narc_arc *arcs, const size_t *counts, size_t part_count,
                                    const narc_allocator *allocator, narc_mass *out_mass, narc_error *error) {
    if (!arcs || !counts || !out_mass)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !arcs     ? "arcs"
                         : !counts ? "counts"
                                   : "out_mass");
    if (part_count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "there are no parts");
    narc_mass first;
    size_t room = 0;
    const narc_status status = check_parts(arcs, counts, part_count, &first, &room, error);
    if (status != NARC_OK)
        return status;
    const size_t each = sizeof(curve) + sizeof(curve *) + sizeof(interval); /* there are fewer parts than curves */
    const narc_allocator own = narc_choose_allocator(allocator);
    char *const memory = room <= SIZE_MAX / each ? own.allocate(room * each, own.context) : NULL;
    if (!memory)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)room, "no memory for %zu arcs and edges", room);
    plane p = {.curves = (curve *)(void *)memory,
               .intervals = (interval *)(void *)(memory + room * sizeof(curve)),
               .active = (curve **)(void *)(memory + room * (sizeof(curve) + sizeof(interval)))};
    const narc_point origin = {first.centroid_x, first.centroid_y};
    for (size_t part = 0; part < part_count; arcs += counts[part++]) {
        narc_outline outline;
        narc_read_outline(arcs, counts[part], &outline);
        put_outline(&p, &outline, part, origin);
    }
    add_all(&p);
    own.release(memory, own.context);
    const double area = p.sum.area, x = area > 0 ? p.sum.x / area : 0, y = area > 0 ? p.sum.y / area : 0;
    *out_mass = (narc_mass){area, origin.x + x, origin.y + y, p.sum.square - area * (x * x + y * y)};
    return NARC_OK;
}
