/* SPDX-License-Identifier: MIT
 *
 * finish.c - rounds a fit to what the store keeps of it, and makes sure of it there.
 */
#include "result/finish.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/difference.h"
#include "model/profile.h"
#include "outline/vector.h"

/* Radii and edges below this, in units of the hull's radius, are taken for 0, and centres this close for one: the steps
 * of the search end there, and single precision is coarser. */
static const double NOTHING = 2e-7;

/* A direction within a rounding of a junction's normal, a single-precision unit vector, may be taken for either arc's:
 * sectors are checked with this much more at both ends, in radians. */
static const double NORMAL_SLOP = 1.0 / (1 << 23);

/* An edge shorter than this part of the radius is not counted as one. */
static const double SHORT_EDGE = 1e-5;

/* What is bounded has this much room, in parts of the largest |centre| + radius, for the roundings of checks in double
 * precision, each a few times 2^-53 of that. */
static const double DOUBLE_ROOM = 0x1p-48;

/* A corner with a sweep that has 1 + its cosine below this is rounded, not moved, since it would have to move by more
 * than 30 times what its sides do. The sides of polygons never are that close to parallel. */
static const double SHARPEST = 0x1p-9;

enum { CERTIFY_ROUNDS = 40, SAMPLES = 1000 };

/* ---------------------------------------------------------------------------- from a chain to arcs */

static bool is_one_arc(const narc_arc *a, const narc_arc *b) {
    return narc_hypot(a->center_x - b->center_x, a->center_y - b->center_y) < NOTHING &&
           fabs(a->radius - b->radius) < NOTHING;
}

/* Neighbours that lie on one circle become one arc, as far as arcs may turn. */
static size_t merge_arcs(narc_arc *arcs, size_t count) {
    size_t kept = 1;
    for (size_t i = 1; i < count; i++) {
        narc_arc *last = &arcs[kept - 1];
        if (is_one_arc(last, &arcs[i]) && arcs[i].end - last->start <= PI)
            last->end = arcs[i].end;
        else
            arcs[kept++] = arcs[i];
    }
    const bool wraps = kept > 1 && is_one_arc(&arcs[kept - 1], &arcs[0]);
    if (wraps && arcs[0].end + 2 * PI - arcs[kept - 1].start <= PI) {
        arcs[0].start = arcs[kept - 1].start - 2 * PI;
        kept--;
    }
    return kept;
}

static size_t list_arcs(const narc_chain *chain, narc_arc *out_arcs) {
    narc_chain clean = *chain;
    for (size_t i = 0; i < clean.count; i++) {
        clean.radius[i] = clean.radius[i] < NOTHING ? 0 : clean.radius[i];
        clean.edge[i] = clean.edge[i] < NOTHING ? 0 : clean.edge[i];
    }
    if (!narc_close_chain(&clean, 0))
        clean = *chain;
    bool circle = true;
    for (size_t i = 0; i < clean.count; i++) {
        out_arcs[i] = (narc_arc){clean.center[i].x, clean.center[i].y, clean.radius[i], clean.angle[i],
                                 narc_end_angle(&clean, i)};
        circle = circle && is_one_arc(&out_arcs[0], &out_arcs[i]);
    }
    if (circle && clean.radius[0] > 0) {
        out_arcs[0].end = out_arcs[0].start + 2 * PI;
        return 1;
    }
    return merge_arcs(out_arcs, clean.count);
}

/* ---------------------------------------------------------------------------- single precision */

/* GCC 12 drops the rounding of a pair of neighbours when it makes vector code of it; not through a volatile. */
double narc_to_single(double x) {
    volatile float rounded = (float)x;
    return rounded;
}

/* Moves the outline out by `distance`: arcs grow, and corners go where their sides meet again, which leaves edges of
 * the length of `distance` where arcs join corners. */
static void offset_arcs(const narc_arc *arcs, size_t count, double distance, narc_arc *out_arcs) {
    for (size_t i = 0; i < count; i++) {
        out_arcs[i] = arcs[i];
        const narc_point d = unit_at(arcs[i].start), e = unit_at(arcs[i].end);
        const double closeness = 1 + dot(d, e);
        if (arcs[i].radius == 0 && closeness > SHARPEST) {
            out_arcs[i].center_x += distance * (d.x + e.x) / closeness;
            out_arcs[i].center_y += distance * (d.y + e.y) / closeness;
        } else {
            out_arcs[i].radius += distance;
        }
    }
}

static void round_arcs(const narc_arc *arcs, size_t count, narc_arc *out_arcs) {
    for (size_t i = 0; i < count; i++) {
        out_arcs[i] = arcs[i];
        out_arcs[i].center_x = narc_to_single(arcs[i].center_x);
        out_arcs[i].center_y = narc_to_single(arcs[i].center_y);
        out_arcs[i].radius = narc_to_single(arcs[i].radius);
    }
}

/* A list of arcs as a chain whose centres are what they are. */
static void chain_arcs(const narc_arc *arcs, size_t count, narc_chain *out_chain) {
    *out_chain = (narc_chain){.count = count, .start = {arcs[0].center_x, arcs[0].center_y}};
    double last = arcs[0].start;
    for (size_t i = 0; i < count; i++) {
        double angle = arcs[i].start;
        angle += 2 * PI * ceil((last - angle) / (2 * PI) - 0.25);
        out_chain->angle[i] = last = angle;
        out_chain->normal[i] = unit_at(angle);
        out_chain->radius[i] = arcs[i].radius;
        out_chain->center[i] = (narc_point){arcs[i].center_x, arcs[i].center_y};
    }
    out_chain->normal[count] = out_chain->normal[0];
    out_chain->center[count] = out_chain->center[0];
    for (size_t i = 0; i < count; i++) {
        const narc_point step = minus(out_chain->center[i], out_chain->center[(i + count - 1) % count]);
        out_chain->edge[i] = fmax(0, dot(step, turned(out_chain->normal[i])));
    }
}

/* What the store makes of a list of arcs. */
static narc_status store_arcs(const narc_arc *arcs, size_t count, narc_chain *out_chain, narc_error *error) {
    narc_shapes *shapes = NULL;
    narc_status status = narc_create_shapes(NULL, &shapes);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, 0, "not enough memory for a shape");
    status = narc_add_shape(shapes, arcs, count, NULL, error);
    if (status == NARC_OK) {
        narc_arc stored[NARC_MAX_ARCS];
        chain_arcs(stored, narc_get_arcs(shapes, 0, stored), out_chain);
    }
    narc_destroy_shapes(shapes);
    return status;
}

/* The directions between two that are less than a half turn apart belong to one circle. */
struct sector {
    narc_point center, start, end;
    double radius;
};

static size_t list_sectors(const narc_chain *chain, struct sector *out_sectors) {
    size_t count = 0;
    for (size_t i = 0; i < chain->count; i++) {
        const double start = chain->angle[i] - NORMAL_SLOP, sweep = narc_end_angle(chain, i) + NORMAL_SLOP - start;
        const unsigned parts = sweep > 1.5 * PI ? 4 : 2; /* a circle, or any other arc */
        for (unsigned k = 0; k < parts; k++) {
            out_sectors[count++] = (struct sector){chain->center[i], unit_at(start + sweep * k / parts),
                                                   unit_at(start + sweep * (k + 1) / parts), chain->radius[i]};
        }
    }
    return count;
}

/* The least over a sector's directions u of how far its circle reaches beyond p. */
static double find_room(const struct sector *sector, narc_point p) {
    const narc_point q = minus(p, sector->center);
    if (cross(sector->start, q) >= 0 && cross(q, sector->end) >= 0 && dot(q, plus(sector->start, sector->end)) > 0)
        return sector->radius - length(q);
    return sector->radius - fmax(dot(q, sector->start), dot(q, sector->end));
}

/* The certificate: how far the stored shape, around `origin`, reaches beyond the outline's own points and its curves in
 * the direction where it does so least, less what roundings of this sum may be. Above 0 everything is inside. It uses
 * nothing that the search made but the shape itself. NaN if anything is. */
static double find_clearance(const narc_chain *stored, const narc_contours *outline, narc_point origin) {
    struct sector sectors[2 * MAX_CHAIN + 2];
    const size_t count = list_sectors(stored, sectors);
    double least = INFINITY, reach = 0;
    for (size_t k = 0; k < count; k++) {
        reach = fmax(reach, length(sectors[k].center) + sectors[k].radius);
        for (size_t i = 0; i < outline->point_count; i++) {
            const double room = find_room(&sectors[k], minus(outline->points[i], origin));
            least = room >= least ? least : room;
            if (isnan(room))
                return room;
        }
    }
    return least - outline->flatness - DOUBLE_ROOM * reach;
}

narc_status narc_certify_arcs(const narc_arc *arcs, size_t count, const narc_frame *frame, narc_point origin,
                              double *out_clearance, narc_error *error) {
    narc_chain stored;
    const narc_status status = store_arcs(arcs, count, &stored, error);
    if (status == NARC_OK)
        *out_clearance = find_clearance(&stored, frame->outline, origin);
    return status;
}

/* Rounds the arcs, moved out by as little as makes the shape that the store keeps of them hold the outline. `arcs` are
 * then the rounded ones, and `exact` is moved out as far. Far from the origin rounded arcs would not join: there the
 * store takes the exact ones, and rounds them itself. */
static narc_status round_and_certify(narc_arc *exact, narc_arc *arcs, size_t count, const narc_frame *frame,
                                     narc_point origin, bool bound, double *out_clearance, narc_error *error) {
    narc_arc moved[NARC_MAX_ARCS];
    double distance = 0, more = 1e-9 * frame->radius;
    for (unsigned round = 0; round < CERTIFY_ROUNDS; round++) {
        double clearance;
        offset_arcs(exact, count, distance, moved);
        round_arcs(moved, count, arcs);
        const narc_status status =
            narc_certify_arcs(frame->keep_origin ? moved : arcs, count, frame, origin, &clearance, error);
        if (status != NARC_OK)
            return status;
        if (!bound || clearance > 0) {
            *out_clearance = clearance;
            memcpy(exact, moved, count * sizeof *exact);
            return NARC_OK;
        }
        distance += more - fmin(clearance, 0);
        more *= 2;
    }
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, distance,
                     "the outline is not inside the shape in single precision, even moved out by %g", distance);
}

/* ---------------------------------------------------------------------------- measures */

static double distance_to_side(const narc_hull *hull, size_t k, narc_point x) {
    const narc_point p = hull->corners[k], e = minus(hull->corners[(k + 1) % hull->count], p);
    const double part = dot(minus(x, p), e) / dot(e, e);
    return length(minus(x, along(p, fmin(fmax(part, 0), 1), e)));
}

static double distance_to_outline(const narc_hull *hull, narc_point x) {
    double least = INFINITY;
    for (size_t k = 0; k < hull->count; k++)
        least = fmin(least, distance_to_side(hull, k, x));
    return least;
}

/* The mean over the shape's outline, by the midpoint rule on pieces of like lengths. */
static double mean_distance(const narc_chain *chain, const narc_hull *hull) {
    const double perimeter = narc_chain_perimeter(chain);
    double sum = 0;
    for (size_t i = 0; i < chain->count; i++) {
        const narc_point a = chain->center[i], d = chain->normal[i];
        const double sweep = narc_end_angle(chain, i) - chain->angle[i], r = chain->radius[i];
        const unsigned arc_pieces = (unsigned)ceil(SAMPLES * r * sweep / perimeter);
        for (unsigned k = 0; k < arc_pieces; k++) {
            const narc_point x = along(a, r, unit_at(chain->angle[i] + sweep * (k + 0.5) / arc_pieces));
            sum += r * sweep / arc_pieces * distance_to_outline(hull, x);
        }
        const unsigned edge_pieces = (unsigned)ceil(SAMPLES * chain->edge[i] / perimeter);
        for (unsigned k = 0; k < edge_pieces; k++) {
            const narc_point end = along(a, r, d);
            const narc_point x = along(end, -chain->edge[i] * (k + 0.5) / edge_pieces, turned(d));
            sum += chain->edge[i] / edge_pieces * distance_to_outline(hull, x);
        }
    }
    return sum / perimeter;
}

/* The area of the symmetric difference is that of the shape before it was rounded: rounding leaves gaps between arcs,
 * and edges that are not quite square to their normals, which matter more than the difference does where edges lie on
 * sides of the hull. */
static double measure_difference(const narc_arc *arcs, size_t count, const narc_hull *hull) {
    narc_chain chain;
    chain_arcs(arcs, count, &chain);
    const double area = narc_difference_area(&chain, hull, (narc_point){0, 0}, NULL);
    return isfinite(area) ? area : narc_chain_area(&chain) + hull->area; /* the shape's centroid is outside the hull */
}

bool narc_compare_arcs(const narc_arc *arcs, size_t count, const narc_hull *hull, narc_difference_range *out_range) {
    narc_chain chain;
    chain_arcs(arcs, count, &chain);
    narc_hull bare = *hull;
    bare.inflation = 0;
    narc_interval *intervals = malloc(narc_count_intervals(count, hull->count) * sizeof *intervals);
    if (!intervals)
        return false;
    *out_range = narc_find_range(intervals, narc_make_profile(&chain, &bare, intervals));
    free(intervals);
    return true;
}

static bool measure(const narc_hull *hull, narc_fit_result *result) {
    narc_chain chain;
    narc_difference_range range;
    if (!narc_compare_arcs(result->arcs, result->arc_count, hull, &range))
        return false;
    chain_arcs(result->arcs, result->arc_count, &chain);
    narc_mass mass;
    narc_compute_mass(result->arcs, result->arc_count, &mass);
    narc_compute_perimeter(result->arcs, result->arc_count, &result->perimeter);
    result->area = mass.area;
    result->hull_area = hull->area;
    result->hull_perimeter = hull->perimeter;
    result->max_distance = fmax(-range.least, range.largest);
    result->mean_distance = mean_distance(&chain, hull);
    result->edge_count = 0;
    for (size_t i = 0; i < chain.count; i++)
        result->edge_count += chain.edge[i] > SHORT_EDGE * hull->perimeter;
    return true;
}

narc_status narc_measure_arcs(const narc_hull *hull, const narc_arc *arcs, narc_fit_result *result, narc_error *error) {
    memcpy(result->arcs, arcs, result->arc_count * sizeof *arcs);
    if (!measure(hull, result))
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", hull->count);
    result->difference_area = measure_difference(arcs, result->arc_count, hull);
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- all of it */

/* A point of the scaled hull's plane as seen from `origin` there, in the outline's units and directions. */
static narc_point place_point(const narc_frame *frame, narc_point origin, narc_point p) {
    const narc_point offset = minus(p, origin);
    const narc_point x = unit_at(frame->angle), y = turned(x);
    return (narc_point){frame->radius * (offset.x * x.x + offset.y * y.x),
                        frame->radius * (offset.x * x.y + offset.y * y.y)};
}

/* The hull in the outline's units, seen from the shape's origin. */
static narc_status place_hull(const narc_hull *hull, const narc_frame *frame, narc_point origin, narc_point rounding,
                              narc_hull *out, narc_error *error) {
    narc_point *corners = malloc(hull->count * sizeof *corners);
    if (!corners)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", hull->count);
    for (size_t k = 0; k < hull->count; k++)
        corners[k] = plus(place_point(frame, origin, hull->corners[k]), rounding);
    const narc_status status = narc_adopt_corners(corners, hull->count, out, error);
    if (status == NARC_OK)
        out->inflation = frame->radius * hull->inflation;
    free(corners);
    return status;
}

static void move_arcs(const narc_arc *arcs, size_t count, narc_point by, narc_arc *out_arcs) {
    for (size_t i = 0; i < count; i++) {
        out_arcs[i] = arcs[i];
        out_arcs[i].center_x += by.x;
        out_arcs[i].center_y += by.y;
    }
}

narc_status narc_finish_arcs(const narc_arc *arcs, size_t count, const narc_hull *hull, const narc_frame *frame,
                             bool bound, narc_fit_result *out_result, narc_error *error) {
    narc_fit_result result = {.arc_count = count};
    narc_mass mass;
    narc_compute_mass(arcs, count, &mass);
    const narc_point origin = {mass.centroid_x, mass.centroid_y};
    for (size_t i = 0; i < count; i++) {
        const narc_point center = place_point(frame, origin, (narc_point){arcs[i].center_x, arcs[i].center_y});
        result.arcs[i] = (narc_arc){center.x, center.y, frame->radius * arcs[i].radius, arcs[i].start + frame->angle,
                                    arcs[i].end + frame->angle};
    }
    const narc_point step = place_point(frame, (narc_point){0, 0}, origin);
    result.origin = plus(frame->middle, step);
    /* The origin is rounded, a lot where the outline is far away: the hull is placed as it is seen from there. */
    const narc_point rounding = minus(step, minus(result.origin, frame->middle));
    narc_hull placed;
    narc_status status = place_hull(hull, frame, origin, rounding, &placed, error);
    if (status != NARC_OK)
        return status;
    const narc_point shift = frame->keep_origin ? result.origin : (narc_point){0, 0};
    narc_arc exact[NARC_MAX_ARCS], kept[NARC_MAX_ARCS];
    move_arcs(result.arcs, count, shift, exact);
    status = round_and_certify(exact, kept, count, frame, minus(result.origin, shift), bound, &result.clearance, error);
    if (status != NARC_OK) {
        narc_release_hull(&placed);
        return status;
    }
    /* Measures are taken near the origin. */
    const narc_point back = minus((narc_point){0, 0}, shift);
    move_arcs(kept, count, back, result.arcs);
    if (frame->keep_origin)
        memcpy(kept, exact, count * sizeof *kept);
    move_arcs(exact, count, back, exact);
    if (!measure(&placed, &result))
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", hull->count);
    result.difference_area = measure_difference(exact, count, &placed);
    narc_release_hull(&placed);
    memcpy(result.arcs, kept, count * sizeof *kept);
    result.origin = minus(result.origin, shift);
    if (status == NARC_OK)
        *out_result = result;
    return status;
}

narc_status narc_finish_fit(const narc_chain *chain, const narc_hull *hull, const narc_frame *frame, bool bound,
                            narc_fit_result *out_result, narc_error *error) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = list_arcs(chain, arcs);
    return narc_finish_arcs(arcs, count, hull, frame, bound, out_result, error);
}
