/* SPDX-License-Identifier: MIT
 *
 * plain.c - which plain shape a hull is.
 *
 * All are a core with a disc around each of its points: a point, a segment, a rectangle or a regular polygon. Their numbers
 * come from the smallest circle or rectangle around the hull, or from its corners, and are those of an exact drawing. Of a
 * rough one the shape then grows or shrinks by half of what it is off.
 */
#include "result/plain.h"

#include <stdlib.h>

#include "error.h"
#include "outline/vector.h"

enum { MOST_SIDES = 16, ROUNDS = 40, CIRCLE_ROUNDS = 64 };

/* What roundings of an exact drawing may make, in parts of the shape's size. */
static const double ROUNDING = 1e-10;

typedef struct plain {
    enum { CIRCLE, CAPSULE, BOX, POLYGON } kind;
    size_t corners;    /* of the core */
    narc_point center; /* in the outline's coordinates, less the frame's middle */
    narc_point axis;   /* its x axis */
    double x, y;       /* of the core: half its sides, or the circumradius */
    double radius;     /* around it */
} plain;

/* The outline of a disc around the core moves out by `distance`; of a core alone its sides do. */
static plain grow(plain shape, double distance) {
    if (shape.kind == POLYGON) {
        shape.x += distance / narc_cos(PI / (double)shape.corners);
    } else if (shape.radius > 0) {
        shape.radius += distance;
    } else {
        shape.x += distance;
        shape.y += distance;
    }
    return shape;
}

static narc_point turn(narc_point axis, double x, double y) {
    return (narc_point){x * axis.x - y * axis.y, x * axis.y + y * axis.x};
}

static narc_status make_arcs(const plain *shape, bool single, narc_arc *out_arcs, size_t *out_count) {
    const double x = single ? narc_to_single(shape->x) : shape->x, y = single ? narc_to_single(shape->y) : shape->y;
    const double radius = single ? narc_to_single(shape->radius) : shape->radius;
    const bool lies = shape->axis.x == 1 && shape->axis.y == 0;
    if (shape->kind == CIRCLE)
        return narc_build_circle(radius, out_arcs, out_count, NULL);
    if (shape->kind == CAPSULE && lies)
        return narc_build_capsule(2 * x, radius, out_arcs, out_count, NULL);
    if (shape->kind == BOX && lies)
        return narc_build_box(2 * (x + radius), 2 * (y + radius), radius, out_arcs, out_count, NULL);
    narc_point corners[MOST_SIDES];
    for (size_t k = 0; k < shape->corners; k++) {
        const double sign_x = k == 0 || k == 3 ? x : -x, sign_y = k < 2 ? y : -y;
        const narc_point way = unit_at(2 * PI * (double)k / (double)shape->corners);
        const narc_point p = shape->kind == POLYGON   ? turn(shape->axis, x * way.x, x * way.y)
                             : shape->kind == CAPSULE ? turn(shape->axis, k ? -x : x, 0)
                                                      : turn(shape->axis, sign_x, sign_y);
        corners[k] = single ? (narc_point){narc_to_single(p.x), narc_to_single(p.y)} : p;
    }
    return shape->kind == CAPSULE ? narc_build_segment(&corners[1], &corners[0], radius, out_arcs, out_count, NULL)
                                  : narc_build_skin_polygon(corners, shape->corners, radius, out_arcs, out_count, NULL);
}

/* How far it reaches beyond the hull, least and largest; false if it is none. */
static bool compare(const plain *shape, const narc_hull *hull, narc_difference_range *out_range) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    if (!(shape->x >= 0 && shape->y >= 0 && shape->radius >= 0) || make_arcs(shape, false, arcs, &count) != NARC_OK)
        return false;
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x += shape->center.x;
        arcs[k].center_y += shape->center.y;
    }
    return narc_compare_arcs(arcs, count, hull, out_range);
}

/* ---------------------------------------------------------------------------- numbers */

/* The smallest circle around two or three points, if they are its corners. */
static plain circle_of(narc_point a, narc_point b, narc_point c) {
    const narc_point p = minus(b, a), q = minus(c, a);
    const double twice = 2 * cross(p, q);
    const narc_point center = {(q.y * dot(p, p) - p.y * dot(q, q)) / twice,
                               (p.x * dot(q, q) - q.x * dot(p, p)) / twice};
    return (plain){.kind = CIRCLE, .corners = 1, .center = plus(a, center), .axis = {1, 0}, .radius = length(center)};
}

static plain circle_between(narc_point a, narc_point b) {
    return (plain){.kind = CIRCLE,
                   .corners = 1,
                   .center = along(a, 0.5, minus(b, a)),
                   .axis = {1, 0},
                   .radius = length(minus(b, a)) / 2};
}

static bool holds(const plain *circle, narc_point p) {
    return length(minus(p, circle->center)) <= circle->radius * (1 + ROUNDING);
}

/* The smallest circle around all corners: the furthest one joins those that carry it, until none is outside. */
static plain find_circle(const narc_hull *hull) {
    narc_point carriers[4] = {hull->corners[0], hull->corners[hull->count / 3], hull->corners[2 * hull->count / 3]};
    plain best = {0};
    for (int round = 0; round < CIRCLE_ROUNDS; round++) {
        const size_t count = round ? 4 : 3;
        best.radius = INFINITY;
        size_t chosen[3] = {0, 1, 2};
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j < i; j++)
                for (size_t k = 0; k <= j; k++) {
                    const plain circle = k < j ? circle_of(carriers[i], carriers[j], carriers[k])
                                               : circle_between(carriers[i], carriers[j]);
                    bool all = circle.radius < best.radius;
                    for (size_t l = 0; l < count; l++)
                        all = all && holds(&circle, carriers[l]);
                    if (all) {
                        best = circle;
                        chosen[0] = i, chosen[1] = j, chosen[2] = k;
                    }
                }
        size_t furthest = 0;
        for (size_t k = 0; k < hull->count; k++)
            if (length(minus(hull->corners[k], best.center)) > length(minus(hull->corners[furthest], best.center)))
                furthest = k;
        if (!isfinite(best.radius) || holds(&best, hull->corners[furthest]))
            break;
        const narc_point kept[3] = {carriers[chosen[0]], carriers[chosen[1]], carriers[chosen[2]]};
        for (int k = 0; k < 3; k++)
            carriers[k] = kept[k];
        carriers[3] = hull->corners[furthest];
    }
    return best;
}

static narc_point find_support(const narc_hull *hull, narc_point way) {
    return hull->corners[narc_find_corner(hull, narc_atan2(way.y, way.x))];
}

/* The smallest rectangle around the hull, its longer side along its x axis; of the smallest ones that on the longest side.
 * A quarter turn is the axis 0, 1. */
static plain find_rectangle(const narc_hull *hull) {
    plain best = {.kind = BOX, .corners = 4};
    double least = INFINITY, longest = 0;
    for (size_t k = 0; k < hull->count; k++) {
        const narc_point side = minus(hull->corners[(k + 1) % hull->count], hull->corners[k]), x = unit(side),
                         y = turned(x);
        const double right = dot(find_support(hull, x), x),
                     left = -dot(find_support(hull, minus((narc_point){0, 0}, x)), x);
        const double high = dot(find_support(hull, y), y), low = -dot(hull->corners[k], y);
        const double area = (right + left) * (high + low), size = length(side);
        if (!(area < least * (1 - ROUNDING) || (area < least * (1 + ROUNDING) && size > longest)))
            continue;
        least = fmin(area, least);
        longest = size;
        best.x = (right + left) / 2;
        best.y = (high + low) / 2;
        best.axis = x;
        best.center = turn(x, (right - left) / 2, (high - low) / 2);
    }
    if (best.y > best.x) {
        const double x = best.x;
        best.x = best.y;
        best.y = x;
        best.axis = turned(best.axis);
    }
    if (best.axis.x < 0 || (best.axis.x == 0 && best.axis.y < 0))
        best.axis = minus((narc_point){0, 0}, best.axis);
    if (fabs(best.axis.y) < ROUNDING)
        best.axis = (narc_point){1, 0};
    if (fabs(best.axis.x) < ROUNDING)
        best.axis = (narc_point){0, 1};
    return best;
}

/* An upright rectangle is a lying one with its sides exchanged. */
static plain lay_down(plain box) {
    if (box.axis.x == 0)
        box = (plain){BOX, 4, box.center, {1, 0}, box.y, box.x, box.radius};
    return box;
}

/* The radius of round corners: of the four that go through the hull's corners furthest along the diagonals the least,
 * or their mean. */
static plain round_corners(const narc_hull *hull, const plain *box, bool bound) {
    double least = INFINITY, sum = 0;
    for (int k = 0; k < 4; k++) {
        const double sign_x = k & 1 ? -1 : 1, sign_y = k & 2 ? -1 : 1;
        const narc_point p = minus(find_support(hull, turn(box->axis, sign_x, sign_y)), box->center);
        const double u = fmax(0, box->x - sign_x * dot(p, box->axis)),
                     v = fmax(0, box->y - sign_y * cross(box->axis, p));
        const double radius = u + v + sqrt(2 * u * v);
        least = fmin(least, radius);
        sum += radius;
    }
    plain found = *box;
    found.radius = fmin(bound ? least : sum / 4, fmin(box->x, box->y));
    found.x -= found.radius;
    found.y -= found.radius;
    return found;
}

/* With corners at angles that differ from the hull's least, weighted by what it turns there. */
static plain find_polygon(const narc_hull *hull, size_t sides) {
    plain found = {.kind = POLYGON, .corners = sides};
    narc_point moment = {0, 0};
    for (size_t k = 0; k < hull->count; k++) {
        const narc_point p = hull->corners[k], q = hull->corners[(k + 1) % hull->count];
        found.center = along(found.center, cross(p, q) / (6 * hull->area), plus(p, q));
    }
    for (size_t k = 0; k < hull->count; k++) {
        const narc_point n = hull->normals[(k + hull->count - 1) % hull->count], m = hull->normals[k];
        const narc_point p = minus(hull->corners[k], found.center);
        const double angle = narc_atan2(p.y, p.x) * (double)sides;
        moment = along(moment, narc_atan2(cross(n, m), dot(n, m)), unit_at(angle));
    }
    const double phase = narc_atan2(moment.y, moment.x) / (double)sides;
    found.axis = fabs(phase) < ROUNDING ? (narc_point){1, 0} : unit_at(phase);
    for (size_t k = 0; k < sides; k++) {
        const narc_point way = unit_at(phase + PI * (double)(2 * k + 1) / (double)sides);
        found.x = fmax(found.x, dot(minus(find_support(hull, way), found.center), way));
    }
    found.x /= narc_cos(PI / (double)sides);
    return found;
}

/* ---------------------------------------------------------------------------- the shape */

/* Grown to hold the hull, or so that it is as far outside as inside; is it within the tolerance then? */
static bool settle(plain *shape, const narc_hull *hull, bool bound, double tolerance) {
    narc_difference_range range;
    if (!compare(shape, hull, &range))
        return false;
    if (bound ? range.least < -ROUNDING * hull->perimeter : fmax(-range.least, range.largest) > tolerance) {
        *shape = grow(*shape, bound ? -range.least : -(range.least + range.largest) / 2);
        if (!compare(shape, hull, &range))
            return false;
    }
    return fmax(-range.least, range.largest) <= tolerance;
}

/* A capsule as wide as the rectangle, whose round ends go through the hull's corners furthest to both sides. */
static plain find_capsule(const narc_hull *hull, const plain *box) {
    plain found = {CAPSULE, 2, box->center, box->axis, 0, 0, box->y};
    double ends[2];
    for (int k = 0; k < 2; k++) {
        const double sign = k ? -1 : 1;
        const narc_point p = minus(find_support(hull, turn(box->axis, sign, 0)), box->center);
        const double q = cross(box->axis, p);
        ends[k] = sign * dot(p, box->axis) - sqrt(fmax(0, box->y * box->y - q * q));
    }
    found.x = (ends[0] + ends[1]) / 2;
    found.center = along(found.center, (ends[0] - ends[1]) / 2, box->axis);
    return found;
}

static bool find_plain(const narc_hull *hull, bool bound, double tolerance, double min_radius, plain *out) {
    const plain upright = find_rectangle(hull), box = lay_down(upright);
    const plain tried[] = {find_circle(hull), find_capsule(hull, &upright), box, round_corners(hull, &box, bound)};
    for (size_t k = 0; k < sizeof tried / sizeof *tried; k++) {
        *out = tried[k];
        if (settle(out, hull, bound, tolerance) && out->radius >= min_radius)
            return true;
    }
    for (size_t sides = 3; sides <= MOST_SIDES && min_radius == 0; sides++) {
        *out = find_polygon(hull, sides);
        if (settle(out, hull, bound, tolerance))
            return true;
    }
    return false;
}

/* The shape in single precision, grown until the store's holds the outline. */
static narc_status certify(const plain *shape, const narc_frame *frame, bool bound, narc_arc *exact,
                           narc_fit_result *result, narc_error *error) {
    const narc_point shift = frame->keep_origin ? result->origin : (narc_point){0, 0};
    double distance = 0, more = 1e-9 * frame->radius;
    for (int round = 0; round < ROUNDS; round++) {
        const plain grown = grow(*shape, distance);
        narc_arc moved[NARC_MAX_ARCS];
        narc_status status = make_arcs(&grown, !frame->keep_origin, exact, &result->arc_count);
        for (size_t k = 0; k < result->arc_count && !status; k++) {
            moved[k] = exact[k];
            moved[k].center_x += shift.x;
            moved[k].center_y += shift.y;
        }
        if (!status)
            status = narc_certify_arcs(moved, result->arc_count, frame, minus(result->origin, shift),
                                       &result->clearance, error);
        if (status)
            return status;
        if (!bound || result->clearance > 0)
            return NARC_OK;
        distance += more - fmin(result->clearance, 0);
        more *= 2;
    }
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, distance,
                     "the outline is not inside the shape in single precision, even moved out by %g", distance);
}

narc_status narc_see_plain(const narc_hull *hull, const narc_frame *frame, bool bound, double tolerance,
                           double min_radius, narc_fit_result *out_result, narc_error *error) {
    narc_hull sized;
    narc_point *corners = malloc(hull->count * sizeof *corners);
    if (!corners)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", hull->count);
    for (size_t k = 0; k < hull->count; k++)
        corners[k] = (narc_point){frame->radius * hull->corners[k].x, frame->radius * hull->corners[k].y};
    narc_status status = narc_adopt_corners(corners, hull->count, &sized, error);
    plain shape;
    if (status) {
        free(corners);
        return status;
    }
    if (!find_plain(&sized, bound, tolerance, min_radius, &shape)) {
        narc_release_hull(&sized);
        free(corners);
        return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, tolerance,
                         "no circle, capsule, box or regular polygon is within %g of the outline", tolerance);
    }
    narc_fit_result result = {.origin = plus(frame->middle, shape.center)};
    const narc_point seen = minus(result.origin, frame->middle); /* the origin is rounded */
    for (size_t k = 0; k < hull->count; k++)
        corners[k] = minus(sized.corners[k % sized.count], seen);
    const size_t count = sized.count;
    narc_release_hull(&sized);
    status = narc_adopt_corners(corners, count, &sized, error);
    free(corners);
    narc_arc exact[NARC_MAX_ARCS];
    if (status)
        return status;
    status = certify(&shape, frame, bound, exact, &result, error);
    if (!status)
        status = narc_measure_arcs(&sized, exact, &result, error);
    narc_release_hull(&sized);
    for (size_t k = 0; k < result.arc_count && frame->keep_origin; k++) {
        result.arcs[k].center_x += result.origin.x;
        result.arcs[k].center_y += result.origin.y;
    }
    if (frame->keep_origin)
        result.origin = (narc_point){0, 0};
    if (!status)
        *out_result = result;
    return status;
}
