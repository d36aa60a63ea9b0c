/* SPDX-License-Identifier: MIT
 *
 * path_arcs.c - the contours of a path as chains of arcs: narc_fit_bezier() for each line and curve, and
 * narc_fit_polyline() for lines one after the other.
 */
#include <math.h>
#include <stdlib.h>

#include "biarc/polyline.h"
#include "error.h"
#include "outline/path.h"

struct builder {
    narc_arc_chains chains;
    size_t arc_capacity, end_capacity;
    double tolerance;
    bool open;
    narc_error *error;
};

static narc_status fail_memory(const struct builder *builder) {
    return narc_fail(builder->error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu arcs",
                     builder->chains.arc_count + 1);
}

/* Adds a line or curve: once to count its arcs, once to have them. */
static narc_status add_curve(struct builder *builder, const narc_point *controls, size_t degree) {
    size_t count;
    double distance;
    narc_status status =
        narc_fit_bezier(controls, degree, builder->tolerance, NULL, 0, &count, &distance, builder->error);
    if (status || count == 0)
        return status;
    narc_arc_chains *chains = &builder->chains;
    narc_curve_arc *arcs = narc_grow(chains->arcs, &builder->arc_capacity, chains->arc_count + count, sizeof *arcs);
    if (!arcs)
        return fail_memory(builder);
    chains->arcs = arcs;
    status = narc_fit_bezier(controls, degree, builder->tolerance, arcs + chains->arc_count, count, &count, &distance,
                             builder->error);
    chains->arc_count += count;
    chains->distance = fmax(chains->distance, distance);
    return status;
}

static narc_curve_arc describe_arc(const narc_spline_arc *arc) {
    narc_curve_arc out = {.start = arc->start, .end = arc->end, .center = arc->start, .radius = INFINITY};
    if (arc->curvature != 0) {
        out.center = along(arc->start, 1 / arc->curvature, turned(arc->start_tangent));
        out.radius = fabs(1 / arc->curvature);
        out.turn = arc->turn;
    }
    return out;
}

/* A tolerance must be what narc_fit_bezier() takes for each of the lines. */
static narc_status check_tolerance(const struct builder *builder, const narc_point *points, size_t count) {
    narc_status status = NARC_OK;
    for (size_t k = 0; k + 1 < count && !status; k++) {
        size_t arcs;
        double distance;
        status = narc_fit_bezier(points + k, 1, builder->tolerance, NULL, 0, &arcs, &distance, builder->error);
    }
    return status;
}

/* Adds lines from each point to the next, `count` points of which no two successive ones are the same. */
static narc_status add_polyline(struct builder *builder, const narc_point *points, size_t count, bool closed,
                                double slack) {
    const narc_polyline line = {points, count, closed, slack};
    narc_arc_chains *chains = &builder->chains;
    narc_spline spline = {0};
    narc_status status = check_tolerance(builder, points, count);
    if (!status)
        status = narc_fit_polyline(&line, builder->tolerance, &spline, builder->error);
    narc_curve_arc *arcs =
        status ? NULL : narc_grow(chains->arcs, &builder->arc_capacity, chains->arc_count + spline.count, sizeof *arcs);
    if (arcs) {
        for (size_t k = 0; k < spline.count; k++)
            arcs[chains->arc_count + k] = describe_arc(&spline.arcs[k]);
        chains->arcs = arcs;
        chains->arc_count += spline.count;
        chains->distance = fmax(chains->distance, spline.distance);
    }
    free(spline.arcs);
    return status || arcs ? status : fail_memory(builder);
}

static bool is_same(narc_point p, narc_point q) { return p.x == q.x && p.y == q.y; }

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
    if (count > 2)
        status = add_polyline(builder, kept, count, closed, slack);
    else if (count == 2)
        status = add_curve(builder, kept, 1);
    free(kept);
    return status;
}

/* Ends a chain, if it has any arcs. */
static narc_status end_chain(struct builder *builder) {
    narc_arc_chains *chains = &builder->chains;
    if (chains->arc_count == (chains->count ? chains->ends[chains->count - 1] : 0))
        return NARC_OK;
    size_t *ends = narc_grow(chains->ends, &builder->end_capacity, chains->count + 1, sizeof *ends);
    if (!ends)
        return fail_memory(builder);
    chains->ends = ends;
    ends[chains->count++] = chains->arc_count;
    return NARC_OK;
}

/* A contour's moves after the first, `count` of them, and the line that closes it. */
static narc_status add_contour(struct builder *builder, const unsigned char *degrees, size_t count,
                               const narc_point *points, double slack) {
    const narc_point start = points[0];
    const bool closes = !builder->open;
    narc_status status = NARC_OK;
    for (size_t k = 0; !status && (k < count || (closes && k == count && !is_same(points[0], start)));) {
        size_t lines = 0;
        while (k + lines < count && degrees[k + lines] == 1)
            lines++;
        const bool closing = closes && k + lines == count;
        if (lines || closing) {
            status = add_lines(builder, points, lines, closing ? &start : NULL, closing && k == 0, slack);
            points += lines;
            k += lines + closing;
        } else {
            status = add_curve(builder, points, degrees[k]); /* the pen's place stands before the move's points */
            points += degrees[k++];
        }
    }
    return status ? status : end_chain(builder);
}

static narc_status add_moves(struct builder *builder, const narc_path *path) {
    const narc_point *points = path->points;
    narc_status status = NARC_OK;
    for (size_t k = 0; k < path->move_count && !status;) {
        size_t count = 0, point_count = 1;
        for (; k + 1 + count < path->move_count && path->degrees[k + 1 + count] > 0; count++)
            point_count += path->degrees[k + 1 + count];
        status = add_contour(builder, path->degrees + k + 1, count, points, path->slack);
        points += point_count;
        k += 1 + count;
    }
    return status;
}

/* ---------------------------------------------------------------------------- directions */

static size_t begin_of(const narc_arc_chains *chains, size_t k) { return k ? chains->ends[k - 1] : 0; }

/* A place in the middle of a piece. */
static narc_point find_middle(const narc_curve_arc *piece) {
    const narc_point chord = minus(piece->end, piece->start);
    return along(along(piece->start, 0.5, chord), -0.5 * tangent(piece->turn / 4), turned(chord));
}

/* By the chain's ends and middles of pieces, which is right but for chains closer to each other than their chords. */
static bool is_around(const narc_arc_chains *chains, size_t k, narc_point p) {
    bool inside = false;
    for (size_t i = begin_of(chains, k); i < chains->ends[k]; i++) {
        const narc_curve_arc *piece = &chains->arcs[i];
        const narc_point corners[3] = {piece->start, find_middle(piece), piece->end};
        for (int half = 0; half < 2; half++) {
            const narc_point a = corners[half], b = corners[half + 1];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
                inside = !inside;
        }
    }
    return inside;
}

static double measure_chain(const narc_arc_chains *chains, size_t k) {
    double twice = 0;
    const narc_point base = chains->arcs[begin_of(chains, k)].start;
    for (size_t i = begin_of(chains, k); i < chains->ends[k]; i++) {
        const narc_curve_arc *piece = &chains->arcs[i];
        const narc_point middle = minus(find_middle(piece), base);
        twice += cross(minus(piece->start, base), middle) + cross(middle, minus(piece->end, base));
    }
    return 0.5 * twice;
}

static void reverse_chain(narc_arc_chains *chains, size_t k) {
    for (size_t i = begin_of(chains, k); i < chains->ends[k]; i++) {
        narc_curve_arc *piece = &chains->arcs[i];
        const narc_point end = piece->end;
        piece->end = piece->start;
        piece->start = end;
        piece->turn = -piece->turn;
    }
    for (size_t i = begin_of(chains, k), j = chains->ends[k] - 1; i < j; i++, j--) {
        const narc_curve_arc piece = chains->arcs[i];
        chains->arcs[i] = chains->arcs[j];
        chains->arcs[j] = piece;
    }
}

/* Outer chains go counter-clockwise, holes clockwise. */
static void turn_chains(narc_arc_chains *chains) {
    for (size_t k = 0; k < chains->count; k++) {
        bool hole = false;
        for (size_t other = 0; other < chains->count; other++)
            if (other != k && is_around(chains, other, chains->arcs[begin_of(chains, k)].start))
                hole = !hole;
        if (hole ? measure_chain(chains, k) > 0 : measure_chain(chains, k) < 0)
            reverse_chain(chains, k);
    }
}

narc_status narc_fit_chains(const narc_path *path, double tolerance, bool open, narc_arc_chains *out_chains,
                            narc_error *error) {
    if (!path || !out_chains)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", path ? "out_chains" : "path");
    struct builder builder = {.tolerance = tolerance, .open = open, .error = error};
    narc_status status = add_moves(&builder, path);
    if (!status && builder.chains.count == 0)
        status = narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the path has no lines and no curves");
    if (!status && !open)
        turn_chains(&builder.chains);
    if (status)
        narc_release_chains(&builder.chains);
    else
        *out_chains = builder.chains;
    return status;
}

void narc_release_chains(narc_arc_chains *chains) {
    free(chains->arcs);
    free(chains->ends);
    *chains = (narc_arc_chains){0};
}
