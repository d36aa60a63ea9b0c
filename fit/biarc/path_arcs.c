/* SPDX-License-Identifier: MIT
 *
 * path_arcs.c - the contours of a path as chains of arcs: each curve, and lines one after the other. What comes out is
 * shown to the store first.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "biarc/biarc.h"
#include "error.h"
#include "narc_chains.h"
#include "outline/crossings.h"
#include "outline/path.h"

/* How near a contour is fitted, and whether by lines alone; whether it has a chain, and that met another one. */
struct effort {
    double tolerance;
    bool lines, drawn, meets;
};

struct builder {
    narc_arc_list list; /* of chain k the arcs ends[k - 1] .. ends[k] - 1 */
    size_t *ends;
    size_t count, end_capacity;
    double tolerance; /* of the contour that is fitted */
    bool open, fewest;
    narc_contours fine;     /* flattened for the fewest pieces */
    struct effort *efforts; /* of contours */
    narc_contours drawn;    /* flattened */
    narc_aabb *boxes;       /* of its contours */
    narc_crossings crossings;
    narc_shapes *store; /* that is asked what it takes */
    narc_error *error;
};

static narc_status fail_memory(const struct builder *builder) {
    return narc_fail(builder->error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu arcs",
                     builder->list.count + 1);
}

/* Adds the lines from `points[0]` on, and one to `start` unless that is NULL; `closed` if they are a whole contour. */
static narc_status add_lines(struct builder *builder, const narc_point *points, size_t lines, const narc_point *start,
                             bool closed, double slack) {
    narc_point *kept = malloc((lines + 2) * sizeof *kept);
    if (!kept)
        return fail_memory(builder);
    size_t count = 1;
    kept[0] = points[0];
    for (size_t k = 1; k <= lines; k++)
        if (!is_same(points[k], kept[count - 1]))
            kept[count++] = points[k];
    if (start && !is_same(*start, kept[count - 1]))
        kept[count++] = *start;
    narc_status status = NARC_OK;
    const narc_polyline line = {kept, count, closed, slack, NULL};
    if (count > 2)
        status = narc_add_polyline(&line, builder->tolerance, &builder->list, builder->error);
    else if (count == 2)
        status = narc_add_curve(kept, 1, builder->tolerance, &builder->list, builder->error);
    free(kept);
    return status;
}

/* An arc as it is, unless it is a point. */
static narc_status add_piece(struct builder *builder, const narc_curve_arc *piece) {
    narc_arc_list *list = &builder->list;
    narc_curve_arc *arcs = narc_grow(list->arcs, &list->capacity, list->count + 1, sizeof *arcs);
    if (!arcs)
        return fail_memory(builder);
    list->arcs = arcs;
    if (!is_same(piece->start, piece->end))
        arcs[list->count++] = *piece;
    return NARC_OK;
}

/* Of the tolerance, the flatness for the fewest pieces, and what it must leave. Within fewer slacks than this the stairs of a
 * tracing are followed, one by one. */
static const double SHARE_OF_FLATNESS = 1.0 / 32, LEAST_OF_FLAT = 0.75, SLACKS = 2;

/* The moves of a contour from its first one on, and the line that closes it. */
static narc_status add_contour(struct builder *builder, const narc_path *path, narc_drawn_move move) {
    const size_t contour = move.contour;
    const narc_point start = move.controls[0];
    narc_status status = NARC_OK;
    for (bool more = true, whole = true; more && !status; whole = false) {
        const narc_point *points = move.controls;
        const unsigned degree = move.degree;
        const bool is_arc = move.is_arc;
        const narc_curve_arc arc = is_arc ? narc_find_arc(&move) : (narc_curve_arc){0};
        size_t lines = 0;
        do {
            lines += degree == 1;
            more = narc_next_drawn(path, &move) && move.contour == contour;
        } while (more && degree == 1 && move.degree == 1);
        const bool closing = !more && !builder->open;
        if (is_arc)
            status = add_piece(builder, &arc);
        else if (degree > 1)
            status = narc_add_curve(points, degree, builder->tolerance, &builder->list, builder->error);
        if (!status && (degree == 1 || closing)) /* a curve's end stands behind its controls */
            status = add_lines(builder, degree == 1 ? points : points + degree, lines, closing ? &start : NULL,
                               closing && degree == 1 && whole, path->slack);
    }
    return status;
}

/* Does a contour end where it begins, by what is drawn? */
static bool is_drawn_round(const narc_path *path, narc_drawn_move move) {
    const size_t contour = move.contour;
    const narc_point start = move.controls[0];
    narc_point end;
    do
        end = move.controls[move.degree];
    while (narc_next_drawn(path, &move) && move.contour == contour);
    return is_same(start, end);
}

/* The fewest pieces for a contour that is flattened; where the tolerance says little, those of its moves. */
static narc_status add_fewest(struct builder *builder, const narc_path *path, narc_drawn_move move) {
    const narc_contours *fine = &builder->fine;
    const size_t begin = begin_of(fine->ends, move.contour), count = fine->ends[move.contour] - begin;
    const double flatness = fmax(0, fine->flatness - path->slack), tolerance = builder->tolerance - flatness;
    if (count < 2)
        return NARC_OK;
    if ((builder->open && is_drawn_round(path, move)) || tolerance < LEAST_OF_FLAT * builder->tolerance ||
        tolerance < SLACKS * path->slack)
        return add_contour(builder, path, move);
    narc_point *points = malloc((count + 1) * sizeof *points);
    bool *joints = calloc(count + 1, sizeof *joints);
    if (!points || !joints) {
        free(points);
        free(joints);
        return fail_memory(builder);
    }
    narc_drawn_move at = move;
    bool more = true, curved = false;
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) { /* where a curve begins or ends there is a joint */
        const narc_point p = fine->points[begin + k];
        if (!kept || !is_same(p, points[kept - 1]))
            points[kept++] = p;
        while (more && is_same(p, at.controls[0])) {
            joints[kept - 1] = curved || at.degree > 1;
            curved = at.degree > 1;
            more = narc_next_drawn(path, &at) && at.contour == move.contour;
        }
    }
    joints[kept - 1] = joints[kept - 1] || curved;
    if (!builder->open) {
        points[kept] = points[0];
        joints[kept++] = joints[0] || curved;
    }
    const narc_polyline line = {points, kept, !builder->open, path->slack, joints};
    narc_arc_list *const list = &builder->list;
    const size_t first = list->count;
    const double distance = list->distance;
    list->distance = 0;
    narc_status status = narc_add_fewest(&line, tolerance, list, builder->error);
    free(points);
    free(joints);
    if (status == NARC_ERROR_MEMORY)
        return status;
    const size_t second = list->count, found = status ? SIZE_MAX : second - first;
    const double of_fewest = fmax(distance, list->distance + flatness);
    list->distance = distance;
    status = add_contour(builder, path, move); /* on a circle, say, these may be fewer */
    if (!status && list->count - second < found) {
        memmove(list->arcs + first, list->arcs + second, (list->count - second) * sizeof *list->arcs);
        list->count -= second - first;
    } else if (found < SIZE_MAX && status != NARC_ERROR_MEMORY) {
        list->count = second;
        list->distance = of_fewest;
        status = NARC_OK;
    }
    return status;
}

/* A contour's own lines, or the chords of its curves. */
static narc_status add_chords(struct builder *builder, size_t contour, double flatness) {
    const narc_contours *drawn = &builder->drawn;
    narc_arc_list *list = &builder->list;
    const size_t begin = begin_of(drawn->ends, contour), end = drawn->ends[contour];
    narc_curve_arc *arcs = narc_grow(list->arcs, &list->capacity, list->count + end - begin, sizeof *arcs);
    if (!arcs)
        return fail_memory(builder);
    list->arcs = arcs;
    for (size_t i = begin; i < end; i++) {
        const bool is_last = i + 1 == end;
        const narc_point p = drawn->points[i], q = drawn->points[is_last ? begin : i + 1];
        if (!is_same(p, q) && !(is_last && builder->open))
            arcs[list->count++] = (narc_curve_arc){.start = p, .end = q, .center = p, .radius = INFINITY};
    }
    list->distance = fmax(list->distance, flatness);
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- directions */

/* A place in the middle of a piece. */
static narc_point find_middle(const narc_curve_arc *piece) {
    const narc_point chord = minus(piece->end, piece->start);
    return along(along(piece->start, 0.5, chord), -0.5 * tangent(piece->turn / 4), turned(chord));
}

/* The area inside the pieces from `begin` on. */
static double measure_chain(const narc_arc_list *list, size_t begin) {
    double twice = 0;
    const narc_point base = list->arcs[begin].start;
    for (size_t i = begin; i < list->count; i++) {
        const narc_curve_arc *piece = &list->arcs[i];
        const narc_point middle = minus(find_middle(piece), base);
        twice += cross(minus(piece->start, base), middle) + cross(middle, minus(piece->end, base));
    }
    return 0.5 * twice;
}

/* Is a contour inside an odd number of others? */
static bool is_hole(const struct builder *builder, size_t contour) {
    const narc_contours *drawn = &builder->drawn;
    const narc_point p = drawn->points[begin_of(drawn->ends, contour)];
    bool inside = false;
    for (size_t k = 0; k < drawn->count; k++) {
        const narc_aabb *box = &builder->boxes[k];
        const size_t begin = begin_of(drawn->ends, k);
        if (k != contour && p.x >= box->min_x && p.x <= box->max_x && p.y >= box->min_y && p.y <= box->max_y)
            inside ^= is_around(drawn->points + begin, drawn->ends[k] - begin, p);
    }
    return inside;
}

/* ---------------------------------------------------------------------------- what the store takes */

/* An arc is too flat if its radius is more than this many times its chord, at first: 128 times is what the store takes of
 * concave ones, and less of arcs that it must cut. Each time that it refuses one they are flat sooner. */
static const double FLAT = 100, FLATTER = 0.25;

/* Of the tolerance, what arcs get if flat ones become lines, and what must be left for these. */
static const double SHARE_OF_ARCS = 0.75, LEAST_SHARE = 1.0 / 8;

/* So often a contour is fitted anew: nearer, where its arcs meet and it does not, or with more lines; at last with lines
 * alone. */
enum { MOST_TRIES = 10 };

/* How many chords serve an arc within `room`; 0: it may stay. */
static size_t count_chords(const narc_curve_arc *arc, double flat, double room, double *out_distance) {
    const double chord = length(minus(arc->end, arc->start)), height = chord * fabs(tangent(arc->turn / 4)) / 2;
    if (arc->turn == 0 || (arc->radius <= flat * chord && fabs(arc->turn) >= 2 * NARC_TOLERANCE))
        return 0;
    const double chords = fmax(1, ceil(sqrt(height / room)));
    *out_distance = fmax(*out_distance, height / (chords * chords));
    return (size_t)chords;
}

/* Puts chords in the place of flat arcs from piece `begin` on. */
static narc_status cut_flat_arcs(struct builder *builder, size_t begin, double flat, double room) {
    narc_arc_list *list = &builder->list;
    double distance = 0;
    size_t count = list->count;
    for (size_t i = begin; i < list->count; i++) {
        const size_t chords = count_chords(&list->arcs[i], flat, room, &distance);
        count += chords ? chords - 1 : 0;
    }
    narc_curve_arc *arcs = narc_grow(list->arcs, &list->capacity, count, sizeof *arcs);
    if (!arcs)
        return fail_memory(builder);
    list->arcs = arcs;
    for (size_t i = list->count, to = count; i-- > begin;) {
        const narc_curve_arc arc = arcs[i];
        const size_t chords = count_chords(&arc, flat, room, &distance);
        narc_point end = arc.end;
        for (size_t k = chords; k-- > 0;) { /* the chord up to the angle a has the length 2 r sin(a / 2) */
            const double turn = arc.turn * (double)k / (double)chords,
                         part = narc_sin(turn / 2) / narc_sin(arc.turn / 2);
            const narc_point way = unit_at((turn - arc.turn) / 2), chord = minus(arc.end, arc.start);
            const narc_point start = {arc.start.x + part * (way.x * chord.x - way.y * chord.y),
                                      arc.start.y + part * (way.x * chord.y + way.y * chord.x)};
            arcs[--to] = (narc_curve_arc){.start = k ? start : arc.start, .end = end, .radius = INFINITY};
            arcs[to].center = arcs[to].start;
            end = start;
        }
        if (!chords)
            arcs[--to] = arc;
    }
    list->count = count;
    list->distance += distance;
    return NARC_OK;
}

static narc_status ask_store(const struct builder *builder, size_t begin) {
    const narc_arc_list *list = &builder->list;
    const size_t pieces = list->count - begin;
    const narc_chain_options options = {.closed = !builder->open};
    narc_arc *arcs = malloc((3 * pieces + 1) * sizeof *arcs);
    size_t count;
    if (!arcs)
        return fail_memory(builder);
    narc_status status = narc_describe_chain(list->arcs + begin, pieces, !builder->open, arcs, &count, builder->error);
    if (!status)
        status = narc_add_chain(builder->store, arcs, count, &options, NULL, 0, &count, builder->error);
    free(arcs);
    return status == NARC_ERROR_CAPACITY ? NARC_OK : status; /* it takes it, but there is no room for entries */
}

/* The first crossing of a contour, of its own lines if they meet anyhow, or with another one's; NULL: there is none. */
static const narc_crossing *find_crossing(const struct builder *builder, size_t contour, bool anyhow) {
    const narc_contours *drawn = &builder->drawn;
    for (size_t k = 0; k < builder->crossings.count; k++) {
        const narc_crossing *at = &builder->crossings.items[k];
        const bool own = narc_find_contour(drawn->ends, drawn->count, at->other) == contour;
        if (narc_find_contour(drawn->ends, drawn->count, at->line) == contour && (at->crosses || (own && anyhow)))
            return at;
    }
    return NULL;
}

static narc_status fail_crossing(const struct builder *builder, const narc_path *path, const narc_crossing *at) {
    const narc_contours *drawn = &builder->drawn;
    size_t contours[2], lines[2];
    for (int k = 0; k < 2; k++) {
        const size_t point = k ? at->other : at->line;
        contours[k] = narc_find_contour(drawn->ends, drawn->count, point);
        lines[k] = narc_find_drawn_line(path, drawn, contours[k], point - begin_of(drawn->ends, contours[k]));
    }
    return narc_fail(builder->error, NARC_ERROR_NOT_SIMPLE, contours[0], (double)lines[0],
                     "contour %zu: line %zu %s line %zu of contour %zu at (%.6g, %.6g)", contours[0], lines[0],
                     at->crosses ? "crosses" : "meets", lines[1], contours[1], at->at.x, at->at.y);
}

/* What is wrong with a contour whatever arcs are fitted to it. */
static narc_status check_contour(const struct builder *builder, const narc_path *path, size_t contour) {
    const size_t begin = begin_of(builder->drawn.ends, contour), last = builder->drawn.ends[contour] - 1;
    const narc_point *points = builder->drawn.points;
    const narc_crossing *crossing = find_crossing(builder, contour, false);
    double size = 0;
    for (size_t k = begin; k <= last; k++)
        size = fmax(size, length(minus(points[k], points[begin])));
    if (size > 0 && size < NARC_MIN_SIZE)
        return narc_fail(builder->error, NARC_ERROR_SIZE, contour, size,
                         "contour %zu: its size is %g, at least %g is possible", contour, size, NARC_MIN_SIZE);
    return crossing ? fail_crossing(builder, path, crossing) : NARC_OK;
}

/* Fits a contour, from its first move on, and asks the store; no arcs come of a point. */
static narc_status fit_contour(struct builder *builder, const narc_path *path, narc_drawn_move first) {
    narc_arc_list *list = &builder->list;
    const size_t contour = first.contour, begin = list->count;
    struct effort *effort = &builder->efforts[contour];
    const double whole = builder->tolerance, before = list->distance;
    const double flatness = fmax(0, builder->drawn.flatness - path->slack);
    const bool hole = !builder->open && is_hole(builder, contour);
    double flat = FLAT;
    narc_status status = check_contour(builder, path, contour);
    narc_error *const error = builder->error, reason;
    const narc_crossing *crossing = NULL;
    bool meets = false;    /* arcs where lines do not */
    bool is_round = false; /* an open stroke that ends where it begins; what is drawn has no line that leads there */
    if (status)
        return status;
    builder->error = &reason;
    builder->tolerance = effort->tolerance;
    for (int tries = 0; tries < MOST_TRIES; tries++) {
        const bool lines = flatness <= whole && !is_round && (effort->lines || tries + 1 == MOST_TRIES);
        list->count = begin;
        list->distance = 0;
        status = lines             ? add_chords(builder, contour, flatness)
                 : builder->fewest ? add_fewest(builder, path, first)
                                   : add_contour(builder, path, first);
        if (status || list->count == begin)
            break;
        is_round = builder->open && is_same(list->arcs[begin].start, list->arcs[list->count - 1].end);
        if (!builder->open && (hole ? measure_chain(list, begin) > 0 : measure_chain(list, begin) < 0))
            narc_reverse_arcs(list->arcs + begin, list->count - begin);
        const double room = whole - list->distance;
        bool any = false;
        for (size_t i = begin; i < list->count; i++)
            any = any || count_chords(&list->arcs[i], flat, whole, &(double){0});
        if (any && room < LEAST_SHARE * whole) {
            builder->tolerance = fmin(builder->tolerance, SHARE_OF_ARCS * whole);
            continue;
        }
        status = any ? cut_flat_arcs(builder, begin, flat, room) : NARC_OK;
        status = status ? status : ask_store(builder, begin);
        crossing = status == NARC_ERROR_NOT_SIMPLE ? find_crossing(builder, contour, true) : NULL;
        meets = meets || (status == NARC_ERROR_NOT_SIMPLE && !crossing);
        if (status == NARC_ERROR_NOT_SIMPLE && !crossing)
            builder->tolerance /= 2;
        else if (status == NARC_ERROR_RADIUS)
            flat *= FLATTER;
        else
            break;
    }
    builder->error = error;
    builder->tolerance = whole;
    list->distance = fmax(list->distance, before);
    if (status == NARC_OK && list->count > begin) {
        size_t *ends = narc_grow(builder->ends, &builder->end_capacity, builder->count + 1, sizeof *ends);
        if (!ends)
            return fail_memory(builder);
        builder->ends = ends;
        ends[builder->count++] = list->count;
        effort->drawn = true;
    }
    if (crossing)
        return fail_crossing(builder, path, crossing);
    is_round = is_round && status == NARC_ERROR_NOT_SIMPLE;
    if (status && status != NARC_ERROR_MEMORY && meets && !is_round)
        return narc_fail(error, status, contour, whole,
                         "contour %zu: it is too thin for the tolerance %g: its sides meet", contour, whole);
    return status ? narc_fail(error, status, contour, reason.value, "contour %zu: %s", contour,
                              is_round ? "it ends where it begins, as no open stroke does" : reason.message)
                  : NARC_OK;
}

/* ---------------------------------------------------------------------------- chains that cross each other */

static bool holds(const narc_curve_arc *on, narc_point p) {
    if (on->turn == 0)
        return dot(minus(p, on->start), minus(on->end, p)) >= 0;
    const narc_point u = minus(on->start, on->center), v = minus(p, on->center);
    const double angle = narc_atan2(copysign(1, on->turn) * cross(u, v), dot(u, v));
    return (angle < 0 ? angle + 2 * PI : angle) <= fabs(on->turn);
}

/* Two that have an end in common, but for this part of their lengths, do not meet there. */
static const double AT_ENDS = 1e-6;

static double find_end(const narc_curve_arc *of, narc_point p) {
    return fmin(length(minus(p, of->start)), length(minus(p, of->end)));
}

static bool is_common(const narc_curve_arc *a, const narc_curve_arc *b, narc_point p) {
    const double near = AT_ENDS * (length(minus(a->end, a->start)) + length(minus(b->end, b->start)));
    return holds(a, p) && holds(b, p) && fmax(find_end(a, p), find_end(b, p)) > near;
}

/* Does a line or arc meet another one? */
static bool do_meet(const narc_curve_arc *a, const narc_curve_arc *b) {
    if (a->turn == 0 && b->turn != 0)
        return do_meet(b, a);
    const narc_point d = b->turn == 0 ? minus(b->end, b->start) : minus(b->center, a->center);
    const double size = length(d);
    if (a->turn == 0) {
        const narc_point e = minus(a->end, a->start);
        const double across = cross(e, d), t = cross(minus(b->start, a->start), d) / across;
        return across != 0 && is_common(a, b, along(a->start, t, e));
    }
    /* The points of both circles, or of circle and line, are on both sides of one that is so far from the centre. */
    const narc_point way = {d.x / size, d.y / size}, out = b->turn == 0 ? turned(way) : way;
    const double far = b->turn == 0 ? dot(minus(b->start, a->center), out)
                                    : (size * size + (a->radius - b->radius) * (a->radius + b->radius)) / (2 * size);
    const double half = sqrt((a->radius - far) * (a->radius + far));
    const narc_point foot = along(a->center, far, out), across = turned(out);
    return half >= 0 && (is_common(a, b, along(foot, half, across)) || is_common(a, b, along(foot, -half, across)));
}

/* A piece of a chain, and a box around it. */
struct swept {
    const narc_curve_arc *arc;
    size_t contour;
    narc_aabb box;
};

static int compare_swept(const void *left, const void *right) {
    const struct swept *a = left, *b = right;
    return a->box.min_x != b->box.min_x ? (a->box.min_x > b->box.min_x) - (a->box.min_x < b->box.min_x)
                                        : (a->arc > b->arc) - (a->arc < b->arc);
}

static struct swept bound_arc(const narc_curve_arc *arc, size_t contour) {
    const narc_point p = arc->start, q = arc->end, c = arc->center;
    const double out = arc->turn == 0 ? 0 : length(minus(q, p)) * fabs(tangent(arc->turn / 4)) / 2, r = arc->radius;
    const narc_aabb box = {fmin(p.x, q.x) - out, fmin(p.y, q.y) - out, fmax(p.x, q.x) + out, fmax(p.y, q.y) + out};
    return (struct swept){arc, contour, fabs(arc->turn) > PI ? (narc_aabb){c.x - r, c.y - r, c.x + r, c.y + r} : box};
}

/* Does a contour, as it is drawn, touch another one? */
static bool does_touch(const struct builder *builder, size_t contour, size_t other) {
    const narc_contours *drawn = &builder->drawn;
    const narc_crossing *items = builder->crossings.items;
    size_t k = 0;
    for (size_t high = builder->crossings.count; k < high;) { /* crossings are sorted by lines */
        const size_t middle = (k + high) / 2;
        if (items[middle].line < begin_of(drawn->ends, contour))
            k = middle + 1;
        else
            high = middle;
    }
    for (; k < builder->crossings.count && items[k].line < drawn->ends[contour]; k++)
        if (narc_find_contour(drawn->ends, drawn->count, items[k].other) == other)
            return true;
    return false;
}

/* Notes contours whose chains meet although they themselves do not. */
static narc_status compare_chains(struct builder *builder, bool *out_any) {
    const narc_arc_list *list = &builder->list;
    struct swept *swept = malloc(list->count * sizeof *swept);
    *out_any = false;
    if (!swept)
        return fail_memory(builder);
    for (size_t k = 0, i = 0, contour = 0; k < builder->count; k++, contour++) {
        while (!builder->efforts[contour].drawn)
            contour++;
        for (; i < builder->ends[k]; i++)
            swept[i] = bound_arc(&list->arcs[i], contour);
    }
    qsort(swept, list->count, sizeof *swept, compare_swept);
    for (size_t i = 0; i < list->count; i++)
        for (size_t j = i + 1; j < list->count && swept[j].box.min_x <= swept[i].box.max_x; j++) {
            const struct swept *p = &swept[i], *q = &swept[j];
            const size_t a = p->contour, b = q->contour;
            if (a != b && q->box.min_y <= p->box.max_y && q->box.max_y >= p->box.min_y && do_meet(p->arc, q->arc) &&
                !does_touch(builder, a, b) && !does_touch(builder, b, a))
                builder->efforts[a].meets = builder->efforts[b].meets = *out_any = true;
        }
    free(swept);
    return NARC_OK;
}

/* Fits all contours, and those again, nearer, whose chains cross. */
static narc_status fit_contours(struct builder *builder, const narc_path *path) {
    const double whole = builder->tolerance;
    bool any = true;
    narc_status status = NARC_OK;
    for (size_t k = 0; k < builder->drawn.count; k++)
        builder->efforts[k] = (struct effort){.tolerance = whole};
    for (int tries = 1; any && !status; tries++) {
        builder->list.count = builder->count = 0;
        builder->list.distance = 0;
        narc_drawn_move move = {0};
        for (bool more = narc_next_drawn(path, &move); more && !status;) {
            const narc_drawn_move first = move;
            status = fit_contour(builder, path, first);
            while (more && move.contour == first.contour)
                more = narc_next_drawn(path, &move);
        }
        if (status || builder->count < 2)
            break;
        status = compare_chains(builder, &any);
        for (size_t k = 0; k < builder->drawn.count && any && !status; k++) {
            struct effort *effort = &builder->efforts[k];
            if (effort->meets && tries > MOST_TRIES)
                return narc_fail(builder->error, NARC_ERROR_NOT_SIMPLE, k, whole,
                                 "contour %zu: it is too near another one for the tolerance %g: they cross", k, whole);
            effort->tolerance *= effort->meets ? 0.5 : 1;
            effort->lines = effort->lines || (effort->meets && tries == MOST_TRIES);
            effort->meets = effort->drawn = false;
        }
    }
    return status;
}

/* Contours that cross by so little, in parts of the largest coordinate, or by half of the tolerance, only touch. */
static const double CROSSING = 1e-6;

/* All that contours are compared with. */
static narc_status prepare(struct builder *builder, const narc_path *path) {
    narc_status status = narc_flatten_path(path, 0, &builder->drawn, builder->error);
    if (!status && builder->fewest &&
        narc_flatten_path(path, SHARE_OF_FLATNESS * builder->tolerance, &builder->fine, NULL))
        status = narc_flatten_path(path, 0, &builder->fine, builder->error);
    const narc_contours *drawn = &builder->drawn;
    const double largest = drawn->point_count ? largest_in(bound_points(drawn->points, drawn->point_count)) : 0;
    builder->boxes = malloc((drawn->count + 1) * sizeof *builder->boxes);
    builder->efforts = malloc((drawn->count + 1) * sizeof *builder->efforts);
    for (size_t k = 0; builder->boxes && k < drawn->count; k++) {
        const size_t begin = begin_of(drawn->ends, k);
        builder->boxes[k] = bound_points(drawn->points + begin, drawn->ends[k] - begin);
    }
    if (!status && !(builder->boxes && builder->efforts))
        status = fail_memory(builder);
    if (!status)
        status = narc_find_crossings(&builder->drawn, !builder->open, fmin(builder->tolerance / 2, CROSSING * largest),
                                     &builder->crossings, builder->error);
    if (!status && narc_create_shapes(NULL, &builder->store))
        status = fail_memory(builder);
    return status;
}

static narc_status fit_path(const narc_path *path, double tolerance, bool open, bool fewest,
                            narc_arc_chains *out_chains, narc_error *error) {
    if (!path || !out_chains)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", path ? "out_chains" : "path");
    struct builder builder = {.tolerance = tolerance, .open = open, .fewest = fewest, .error = error};
    narc_status status = prepare(&builder, path);
    if (!status)
        status = fit_contours(&builder, path);
    if (!status && builder.count == 0)
        status = narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the path has no lines and no curves");
    narc_release_contours(&builder.drawn);
    narc_release_contours(&builder.fine);
    free(builder.crossings.items);
    free(builder.boxes);
    free(builder.efforts);
    narc_destroy_shapes(builder.store);
    narc_arc_chains chains = {builder.list.arcs, builder.list.count, builder.ends, builder.count,
                              builder.list.distance};
    if (status)
        narc_release_chains(&chains);
    else
        *out_chains = chains;
    return status;
}

narc_status narc_fit_chains(const narc_path *path, double tolerance, bool open, narc_arc_chains *out_chains,
                            narc_error *error) {
    return fit_path(path, tolerance, open, false, out_chains, error);
}

narc_status narc_fit_fewest_chains(const narc_path *path, double tolerance, bool open, narc_arc_chains *out_chains,
                                   narc_error *error) {
    return fit_path(path, tolerance, open, true, out_chains, error);
}

void narc_release_chains(narc_arc_chains *chains) {
    free(chains->arcs);
    free(chains->ends);
    *chains = (narc_arc_chains){0};
}
