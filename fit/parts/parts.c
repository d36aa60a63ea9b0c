/* SPDX-License-Identifier: MIT
 *
 * parts.c - the call: an outline as convex parts.
 */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "parts/cut.h"

/* Of the tolerance, and of the extent: how far simpler contours may be from the outline's own. */
static const double SLACK = 1.0 / 16, LARGEST_SLACK = 1.0 / 2048;

/* Tolerances, and limits that are tried to find a number of parts, in parts of the extent. */
static const double LEAST_TOLERANCE = 1.0 / 1024, LEAST_LIMIT = 1.0 / 1024;
enum { TRIES = 10 };

/* Before pieces are joined there may be so many times more, and some. */
enum { MORE_PIECES = 16, SOME_PIECES = 256 };

/* A part with less area than this part of its length squared gets this much wider on both sides, in parts of its length
 * or, if it is a point, of the extent. */
static const double THIN = 2e-4, WIDER = 4e-4;

/* ---------------------------------------------------------------------------- laps */

/* What is near a corner is bounded by lines that turn by no more than this: at 30 degrees nothing is further away than
 * NARC_LAP_REACH laps. */
static const double LAP_TURN = PI / 6;

/* The part of a polygon that is not further than `reach` outside the line from a to b. */
static size_t clip(const narc_point *corners, size_t count, narc_point a, narc_point b, double reach,
                   narc_point *out_corners) {
    const narc_point side = minus(b, a);
    const double size = length(side);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_point p = corners[k], q = corners[(k + 1) % count];
        const double from = cross(minus(p, a), side) / size - reach, to = cross(minus(q, a), side) / size - reach;
        if (from <= 0)
            out_corners[kept++] = p;
        if ((from <= 0) != (to <= 0))
            out_corners[kept++] = along(p, from / (from - to), minus(q, p));
    }
    return kept;
}

/* The part of a polygon that is near a convex one: within `lap` of its sides, and of its corners. */
static size_t clip_near(const narc_piece *piece, double lap, narc_point *halves[2], size_t count) {
    size_t from = 0;
    for (size_t k = 0; k < piece->count && count; k++) {
        const narc_point a = piece->corners[k], b = piece->corners[(k + 1) % piece->count];
        const narc_point side = minus(b, a), next = minus(piece->corners[(k + 2) % piece->count], b);
        const double turn = narc_atan2(cross(side, next), dot(side, next)), steps = ceil(turn / LAP_TURN);
        for (double step = 0; step < fmax(1, steps) && count; step++, from = !from) {
            const narc_point way = unit_at(turn * (step / fmax(1, steps)));
            const narc_point along_step = {way.x * side.x - way.y * side.y, way.x * side.y + way.y * side.x};
            count = clip(halves[from], count, b, plus(b, along_step), lap, halves[!from]);
        }
    }
    if (from)
        memcpy(halves[0], halves[1], count * sizeof *halves[0]);
    return count;
}

/* The hull of a piece and of what others have within `lap` of it: so it reaches no further than that, rounded up, beyond
 * the piece. */
static narc_status lap_piece(const narc_pieces *pieces, size_t k, double lap, narc_piece *out_piece) {
    const narc_piece *piece = &pieces->items[k];
    const size_t lines = piece->count + (size_t)(2 * PI / LAP_TURN) + 1; /* each may add a corner */
    size_t most = piece->count;
    for (size_t i = 0; i < pieces->count; i++)
        most += pieces->items[i].count + lines;
    narc_point *points = malloc(most * sizeof *points), *corners = malloc((most + 1) * sizeof *corners);
    narc_point *halves[2] = {malloc(most * sizeof *points), malloc(most * sizeof *points)};
    narc_status status = points && corners && halves[0] && halves[1] ? NARC_OK : NARC_ERROR_MEMORY;
    size_t count = piece->count;
    if (!status)
        memcpy(points, piece->corners, count * sizeof *points);
    for (size_t i = 0; i < pieces->count && !status && piece->count > 2; i++) {
        const narc_piece *other = &pieces->items[i];
        size_t left = i == k ? 0 : other->count;
        memcpy(halves[0], other->corners, left * sizeof *points);
        left = clip_near(piece, lap, halves, left);
        memcpy(points + count, halves[0], left * sizeof *points);
        count += left;
    }
    if (status)
        free(corners);
    else
        *out_piece = (narc_piece){corners, narc_wrap_points(points, count, corners)};
    free(points);
    free(halves[0]);
    free(halves[1]);
    return status;
}

static narc_status lap_pieces(narc_pieces *pieces, double lap) {
    narc_pieces lapped = {.items = calloc(pieces->count, sizeof *lapped.items)};
    narc_status status = lapped.items ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t k = 0; k < pieces->count && !status; k++, lapped.count += !status)
        status = lap_piece(pieces, k, lap, &lapped.items[k]);
    if (!status) {
        const narc_pieces old = *pieces;
        *pieces = lapped;
        lapped = old;
    }
    narc_release_pieces(&lapped);
    return status;
}

/* ---------------------------------------------------------------------------- parts */

/* A piece that is as thin as a line becomes a thin diamond, which a shape can be fitted to. */
static narc_status widen_piece(narc_piece *piece, double extent) {
    narc_point a = piece->corners[0], b = a;
    double area = 0;
    for (size_t k = 0; k < piece->count; k++) {
        const narc_point p = piece->corners[k], q = piece->corners[(k + 1) % piece->count];
        area += 0.5 * cross(minus(p, a), minus(q, a));
        b = length(minus(p, a)) > length(minus(b, a)) ? p : b;
    }
    const double size = length(minus(b, a)), width = WIDER * (size > 0 ? size : extent);
    if (area > THIN * size * size)
        return NARC_OK;
    const narc_point side = size > 0 ? (narc_point){(b.x - a.x) / size, (b.y - a.y) / size} : (narc_point){1, 0};
    narc_point *points = malloc((piece->count + 4) * sizeof *points);
    narc_point *corners = malloc((piece->count + 5) * sizeof *corners);
    if (points && corners) {
        const narc_point middle = along(a, 0.5, minus(b, a)), across = turned(side);
        memcpy(points, piece->corners, piece->count * sizeof *points);
        points[piece->count] = along(middle, 2 * width, across);
        points[piece->count + 1] = along(middle, -2 * width, across);
        points[piece->count + 2] = along(a, -width, side);
        points[piece->count + 3] = along(b, width, side);
        free(piece->corners);
        *piece = (narc_piece){corners, narc_wrap_points(points, piece->count + 4, corners)};
    } else {
        free(corners);
    }
    free(points);
    return points && corners ? NARC_OK : NARC_ERROR_MEMORY;
}

static narc_status draw_piece(const narc_piece *piece, double flatness, narc_path **out_path) {
    narc_path *path = NULL;
    narc_status status = narc_create_path(&path);
    for (size_t k = 0; k < piece->count && !status; k++)
        status = k ? narc_line_to(path, &piece->corners[k], NULL) : narc_move_to(path, &piece->corners[k], NULL);
    if (status) {
        narc_destroy_path(path);
        return status;
    }
    path->slack = flatness;
    *out_path = path;
    return NARC_OK;
}

static narc_status draw_pieces(const narc_pieces *pieces, double flatness, narc_parts *out_parts) {
    narc_parts parts = {.paths = calloc(pieces->count, sizeof(narc_path *))};
    narc_status status = parts.paths ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t k = 0; k < pieces->count && !status; k++, parts.count += !status)
        status = draw_piece(&pieces->items[k], flatness, &parts.paths[k]);
    if (status)
        narc_release_parts(&parts);
    else
        *out_parts = parts;
    return status;
}

static narc_status cut_and_join(narc_region *region, double limit, size_t most, narc_pieces *out_pieces) {
    narc_limit_region(region, limit);
    narc_pieces pieces = {0};
    narc_status status = narc_cut_region(region, MORE_PIECES * most + SOME_PIECES, &pieces);
    status = status ? status : narc_join_pieces(region, most, &pieces);
    if (!status && pieces.count > most)
        status = NARC_ERROR_CAPACITY;
    if (status)
        narc_release_pieces(&pieces);
    else
        *out_pieces = pieces;
    return status;
}

/* The least limit with which so few pieces are found, between that of too many and that of few enough. */
static narc_status find_limit(narc_region *region, size_t most, narc_pieces *out_pieces) {
    double low = LEAST_LIMIT * region->extent, high = 2 * region->extent;
    narc_status status = cut_and_join(region, low, most, out_pieces);
    if (status != NARC_ERROR_CAPACITY)
        return status;
    status = cut_and_join(region, high, most, out_pieces);
    for (int k = 0; k < TRIES && !status; k++) {
        const double limit = sqrt(low * high);
        narc_pieces found;
        const narc_status tried = cut_and_join(region, limit, most, &found);
        if (tried == NARC_ERROR_CAPACITY) {
            low = limit;
            continue;
        }
        narc_release_pieces(out_pieces);
        status = tried;
        if (!status)
            *out_pieces = found;
        high = limit;
    }
    return status;
}

/* What is measured may be more by rounding than what is known. */
static double measure_gaps(const narc_region *region, const narc_pieces *pieces) {
    double most = 0;
    for (size_t k = 0; k < pieces->count; k++) {
        const narc_piece *of = &pieces->items[k];
        const double gap = narc_measure_gap(region, of->corners, of->count);
        const bool within = gap > region->limit && narc_is_within_limit(region, of->corners, of->count);
        most = fmax(most, within ? region->limit : gap);
    }
    return most + region->slack;
}

static narc_status find_pieces(narc_region *region, const narc_parts_request *request, double tolerance,
                               narc_pieces *out_pieces, narc_error *error) {
    narc_status status = narc_survey_region(region, error);
    if (status)
        return status;
    status = tolerance > 0 ? cut_and_join(region, tolerance - 2 * region->slack, request->most, out_pieces)
                           : find_limit(region, request->most, out_pieces);
    if (status == NARC_ERROR_CAPACITY)
        return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "the tolerance %g is not reached with %zu parts",
                         request->tolerance, request->most);
    if (!status && request->lap > 0)
        status = lap_pieces(out_pieces, request->lap);
    for (size_t k = 0; k < out_pieces->count && !status; k++)
        status = widen_piece(&out_pieces->items[k], region->extent);
    return status ? narc_fail(error, status, 0, 0, "not enough memory for the parts of an outline") : NARC_OK;
}

static narc_status check_request(const narc_path *path, const narc_parts_request *request, const narc_parts *out,
                                 narc_error *error) {
    if (!path || !request || !out)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !path      ? "the path"
                         : !request ? "the request"
                                    : "out_parts");
    if (request->most < 1 || request->most > NARC_MAX_PARTS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)request->most, "%zu parts, but there may be 1 to %d",
                         request->most, NARC_MAX_PARTS);
    if (!(request->tolerance >= 0 && isfinite(request->tolerance)))
        return narc_fail(error, NARC_ERROR_SIZE, 0, request->tolerance, "the tolerance %g is not a length",
                         request->tolerance);
    if (!(request->lap >= 0 && isfinite(request->lap)))
        return narc_fail(error, NARC_ERROR_SIZE, 0, request->lap, "the lap %g is not a length", request->lap);
    return NARC_OK;
}

static narc_status cut_contours(const narc_contours *contours, bool crosses, const narc_parts_request *request,
                                narc_parts *out_parts, narc_error *error) {
    narc_region region = {0};
    narc_pieces pieces = {0};
    const double extent = extent_of(bound_points(contours->points, contours->point_count));
    const double lap = NARC_LAP_REACH * request->lap, tolerance = request->tolerance - contours->flatness - lap;
    const double least = contours->flatness + lap + LEAST_TOLERANCE * extent;
    if (request->tolerance > 0 && !(tolerance >= LEAST_TOLERANCE * extent))
        return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, least,
                         "the tolerance %g is too small for parts, at least %g is possible", request->tolerance, least);
    const double most = LARGEST_SLACK * extent, slack = request->tolerance > 0 ? fmin(most, SLACK * tolerance) : most;
    narc_contours loops = {0};
    narc_status status = narc_make_region(contours, slack, &region, error);
    if (!status && crosses)
        status = narc_split_holes(&region, &loops, error);
    if (!status && loops.count) {
        narc_release_region(&region);
        status = narc_make_region(&loops, slack, &region, error);
    }
    narc_release_contours(&loops);
    if (status) {
        narc_release_region(&region);
        return status;
    }
    status = find_pieces(&region, request, request->tolerance > 0 ? tolerance : 0, &pieces, error);
    /* The hulls are those of the outline's own points, which may be further out than the simpler ones by the slack. */
    if (!status && request->tolerance > 0)
        narc_limit_region(&region, tolerance + lap - region.slack);
    const double distance = status ? 0 : measure_gaps(&region, &pieces) + contours->flatness;
    if (!status && request->tolerance > 0 && distance > request->tolerance)
        status = narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, distance,
                           "the tolerance %g is not reached: parts were found that are within %g", request->tolerance,
                           distance);
    double area = status ? 0 : narc_measure_region(&region);
    if (!status && crosses)
        status = narc_measure_crossing(&region, &area, error);
    narc_parts parts;
    if (!status && draw_pieces(&pieces, contours->flatness, &parts))
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for the parts of an outline");
    if (!status) {
        parts.distance = distance;
        parts.area = area;
        *out_parts = parts;
    }
    narc_release_pieces(&pieces);
    narc_release_region(&region);
    return status;
}

narc_status narc_cut_path(const narc_path *path, const narc_parts_request *request, narc_parts *out_parts,
                          narc_error *error) {
    narc_status status = check_request(path, request, out_parts, error);
    if (status)
        return status;
    narc_contours contours, loops;
    bool crosses;
    status = narc_flatten_path(path, request->flatness, &contours, error);
    if (status)
        return status;
    status = narc_split_contours(&contours, &loops, &crosses, error);
    narc_release_contours(&contours);
    if (status)
        return status;
    status = cut_contours(&loops, crosses, request, out_parts, error);
    narc_release_contours(&loops);
    return status;
}

void narc_release_parts(narc_parts *parts) {
    for (size_t k = 0; k < parts->count; k++)
        narc_destroy_path(parts->paths[k]);
    free(parts->paths);
    *parts = (narc_parts){0};
}
