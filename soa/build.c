/* SPDX-License-Identifier: MIT
 *
 * build.c - arcs of circles, capsules, segments, boxes, convex polygons with round corners, and the four-arc lens.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "error.h"
#include "outline.h"

/* Radii may exceed what fits by so much, relatively, to forgive the rounding of a caller's own arithmetic. */
#define FIT_SLACK 1e-12

/* A named number that a builder was given. A radius that may be 0 is that of a corner or a tip. */
typedef enum kind { POSITIVE, LENGTH, RADIUS } kind;
typedef struct quantity {
    const char *name;
    double value;
    kind kind;
} quantity;

static narc_status check_lengths(const quantity *lengths, size_t count, narc_error *error) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(lengths[i].value))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, lengths[i].value, "%s is %g", lengths[i].name,
                             lengths[i].value);
    for (size_t i = 0; i < count; i++)
        if (lengths[i].value < 0 || (lengths[i].value == 0 && lengths[i].kind == POSITIVE))
            return narc_fail(error, lengths[i].kind == RADIUS ? NARC_ERROR_RADIUS : NARC_ERROR_SIZE, 0,
                             lengths[i].value, "%s is %g, not %s", lengths[i].name, lengths[i].value,
                             lengths[i].kind == POSITIVE ? "above 0" : "0 or more");
    return NARC_OK;
}

static narc_status check_outputs(const narc_arc *out_arcs, const size_t *out_count, narc_error *error) {
    return out_arcs && out_count ? NARC_OK : narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an output is NULL");
}

/* Validates what was built and hands it over. */
static narc_status finish(const narc_arc *arcs, size_t count, narc_arc *out_arcs, size_t *out_count,
                          narc_error *error) {
    narc_status status = narc_validate_arcs(arcs, count, error);
    if (status == NARC_OK) {
        memcpy(out_arcs, arcs, count * sizeof *arcs);
        *out_count = count;
    }
    return status;
}

narc_status narc_build_circle(double radius, narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK)
        status = check_lengths(&(quantity){"radius", radius, POSITIVE}, 1, error);
    if (status != NARC_OK)
        return status;
    return finish(&(narc_arc){0, 0, radius, -NARC_PI, NARC_PI}, 1, out_arcs, out_count, error);
}

narc_status narc_build_capsule(double length, double radius, narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    const quantity lengths[] = {{"length", length, LENGTH}, {"radius", radius, POSITIVE}};
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK)
        status = check_lengths(lengths, 2, error);
    if (status != NARC_OK)
        return status;
    const narc_arc arcs[2] = {{length / 2, 0, radius, -NARC_PI / 2, NARC_PI / 2},
                              {-length / 2, 0, radius, NARC_PI / 2, -NARC_PI / 2}};
    return finish(arcs, 2, out_arcs, out_count, error);
}

narc_status narc_build_segment(const narc_point *from, const narc_point *to, double radius, narc_arc *out_arcs,
                               size_t *out_count, narc_error *error) {
    const quantity length = {"radius", radius, RADIUS};
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK && (!from || !to))
        status = narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", from ? "to" : "from");
    if (status == NARC_OK)
        status = narc_check_points((const narc_point[]){*from, *to}, 2, error);
    if (status == NARC_OK)
        status = check_lengths(&length, 1, error);
    if (status != NARC_OK)
        return status;
    double x = to->x - from->x, y = to->y - from->y;
    if (x == 0 && y == 0)
        x = 1;
    const double right = narc_atan2(-x, y), left = narc_atan2(x, -y);
    const narc_arc arcs[2] = {{to->x, to->y, radius, right, left}, {from->x, from->y, radius, left, right}};
    return finish(arcs, 2, out_arcs, out_count, error);
}

narc_status narc_build_box(double width, double height, double radius, narc_arc *out_arcs, size_t *out_count,
                           narc_error *error) {
    const quantity lengths[] = {{"width", width, POSITIVE}, {"height", height, POSITIVE}, {"radius", radius, RADIUS}};
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK)
        status = check_lengths(lengths, 3, error);
    if (status != NARC_OK)
        return status;
    double largest = fmin(width, height) / 2;
    if (radius > largest * (1 + FIT_SLACK))
        return narc_fail(error, NARC_ERROR_RADIUS, 0, radius, "radius is %.9g, more than half the shorter side, %.9g",
                         radius, largest);
    double r = fmin(radius, largest), x = width / 2 - r, y = height / 2 - r;
    const narc_arc arcs[4] = {{x, y, r, 0, NARC_PI / 2},
                              {-x, y, r, NARC_PI / 2, NARC_PI},
                              {-x, -y, r, -NARC_PI, -NARC_PI / 2},
                              {x, -y, r, -NARC_PI / 2, 0}};
    return finish(arcs, 4, out_arcs, out_count, error);
}

/* ------------------------------------------------------------------------------------------------ polygon */

/* Side i of a polygon, from corner i to corner i + 1, and what the outline turns by at corner i. */
typedef struct side {
    double length, normal_x, normal_y, turn;
} side;

static narc_status find_sides(const narc_point *points, size_t count, side *out_sides, narc_error *error) {
    narc_status status = narc_check_points(points, count, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        narc_point from = points[i], to = points[(i + 1) % count];
        double length = narc_hypot(to.x - from.x, to.y - from.y);
        if (!(length > 0) || !isfinite(length))
            return narc_fail(error, NARC_ERROR_SIZE, i, length, "side %zu: length is %g", i, length);
        out_sides[i] = (side){length, (to.y - from.y) / length, (from.x - to.x) / length, 0};
    }
    double turns[NARC_MAX_ARCS];
    for (size_t i = 0; i < count; i++) {
        const side *after = &out_sides[i], *before = &out_sides[(i + count - 1) % count];
        double cross = before->normal_x * after->normal_y - before->normal_y * after->normal_x;
        turns[i] = narc_atan2(cross, before->normal_x * after->normal_x + before->normal_y * after->normal_y);
        out_sides[i].turn = turns[i];
    }
    return narc_check_turns(turns, count, error);
}

static double find_tangent(double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return s / c;
}

/* What all builders of polygons check, and the sides. */
static narc_status check_polygon(const narc_point *points, size_t count, double radius, const narc_arc *out_arcs,
                                 const size_t *out_count, side *out_sides, narc_error *error) {
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status != NARC_OK)
        return status;
    if (!points)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "points is NULL");
    if (count < 3 || count > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu points, not 3 to %d", count,
                         NARC_MAX_ARCS);
    status = check_lengths(&(quantity){"radius", radius, RADIUS}, 1, error);
    return status == NARC_OK ? find_sides(points, count, out_sides, error) : status;
}

/* An arc of `radius` at each corner, its centre moved inwards to where it is `inset` away from both sides. */
static narc_status round_corners(const narc_point *points, const side *sides, size_t count, double radius, double inset,
                                 narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    narc_arc arcs[NARC_MAX_ARCS];
    double start = narc_atan2(sides[count - 1].normal_y, sides[count - 1].normal_x);
    for (size_t i = 0; i < count; i++) {
        const side *before = &sides[(i + count - 1) % count], *after = &sides[i];
        const double move = inset > 0 ? inset / (1 + narc_cos(after->turn)) : 0;
        const double end = narc_atan2(after->normal_y, after->normal_x);
        arcs[i] = (narc_arc){points[i].x - move * (before->normal_x + after->normal_x),
                             points[i].y - move * (before->normal_y + after->normal_y), radius, start, end};
        start = end;
    }
    return finish(arcs, count, out_arcs, out_count, error);
}

narc_status narc_build_polygon(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                               size_t *out_count, narc_error *error) {
    side sides[NARC_MAX_ARCS];
    narc_status status = check_polygon(points, count, radius, out_arcs, out_count, sides, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        /* A corner that turns by e, rounded with radius r, uses up r tan(e / 2) of both its sides. */
        double most =
            sides[i].length / (find_tangent(sides[i].turn / 2) + find_tangent(sides[(i + 1) % count].turn / 2));
        if (radius > most * (1 + FIT_SLACK))
            return narc_fail(error, NARC_ERROR_RADIUS, i, radius,
                             "side %zu: radius is %.9g, the largest that fits it is %.9g", i, radius, most);
    }
    return round_corners(points, sides, count, radius, radius, out_arcs, out_count, error);
}

narc_status narc_build_skin_polygon(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                                    size_t *out_count, narc_error *error) {
    side sides[NARC_MAX_ARCS];
    narc_status status = check_polygon(points, count, radius, out_arcs, out_count, sides, error);
    return status == NARC_OK ? round_corners(points, sides, count, radius, 0, out_arcs, out_count, error) : status;
}

static double find_distance(narc_point p, narc_point a, narc_point b) {
    double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    double t = square > 0 ? ((p.x - a.x) * x + (p.y - a.y) * y) / square : 0;
    t = fmin(1, fmax(0, t));
    return narc_hypot(a.x + t * x - p.x, a.y + t * y - p.y);
}

/* The largest distance of the corners strictly between two others from the segment that joins these. */
static double find_loss(const narc_point *points, size_t count, size_t from, size_t to) {
    double loss = 0;
    for (size_t i = (from + 1) % count; i != to; i = (i + 1) % count)
        loss = fmax(loss, find_distance(points[i], points[from], points[to]));
    return loss;
}

narc_status narc_weld_polygon(const narc_point *points, size_t count, double tolerance, narc_point *out_points,
                              size_t *out_count, narc_error *error) {
    size_t corner[NARC_MAX_ARCS], left = count;
    if (!points || !out_points || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", points ? "an output" : "points");
    if (count < 3 || count > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu points, not 3 to %d", count,
                         NARC_MAX_ARCS);
    narc_status status = check_lengths(&(quantity){"tolerance", tolerance, LENGTH}, 1, error);
    if (status == NARC_OK)
        status = narc_check_points(points, count, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        corner[i] = i;
    for (;;) {
        double least = INFINITY;
        size_t leaving = 0;
        for (size_t k = 0; k < left; k++) {
            double loss = find_loss(points, count, corner[(k + left - 1) % left], corner[(k + 1) % left]);
            if (loss < least) {
                least = loss;
                leaving = k;
            }
        }
        if (least > tolerance)
            break;
        if (left == 3)
            return narc_fail(error, NARC_ERROR_COUNT, corner[leaving], least,
                             "fewer than 3 corners are left: the polygon is within %.9g of a segment", least);
        left--;
        for (size_t k = leaving; k < left; k++)
            corner[k] = corner[k + 1];
    }
    for (size_t k = 0; k < left; k++) /* corner[k] >= k: nothing is read that was written */
        out_points[k] = points[corner[k]];
    *out_count = left;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ hulls */

/* A side of a hull under way, from its corner to the next one's, and the point that is furthest outside of it. */
typedef struct hull_side {
    narc_point corner, furthest;
    double distance;
} hull_side;

/* Of points that are as far, to some roundings, any: one between two corners is welded in the end. */
static void look_outside(const narc_point *points, size_t count, hull_side *of, narc_point to) {
    const narc_point from = of->corner;
    const double x = to.x - from.x, y = to.y - from.y;
    double most = 0; /* times the length */
    for (size_t k = 0; k < count; k++) {
        const double outside = (points[k].x - from.x) * y - (points[k].y - from.y) * x;
        if (outside > most) {
            most = outside;
            of->furthest = points[k];
        }
    }
    of->distance = most > 0 ? most / narc_hypot(x, y) : 0;
}

/* A corner that is further than half of this from the line between its neighbours turns by four times as much for each extent:
 * by more than narc_check_turns() asks for. */
#define LEAST_TOLERANCE 0x1p-17

/* From two corners on, the point that is furthest outside becomes the next one: it is a corner of the hull, up to rounding,
 * which is far below what may stay outside. */
narc_status narc_build_hull(const narc_point *points, size_t count, double tolerance, double radius, narc_arc *out_arcs,
                            size_t *out_count, narc_error *error) {
    const quantity lengths[] = {{"tolerance", tolerance, LENGTH}, {"radius", radius, RADIUS}};
    hull_side sides[NARC_MAX_ARCS];
    narc_point corners[NARC_MAX_ARCS];
    size_t left = 2, second = 0;
    double extent = 0;
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK && !points)
        status = narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "points is NULL");
    if (status == NARC_OK && count < 3)
        status =
            narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu points, a hull has 3 at least", count);
    if (status == NARC_OK)
        status = check_lengths(lengths, 2, error);
    if (status == NARC_OK)
        status = narc_check_points(points, count, error);
    if (status != NARC_OK)
        return status;
    sides[0].corner = points[0];
    for (size_t k = 1; k < count; k++)
        if (points[k].x < sides[0].corner.x || (points[k].x == sides[0].corner.x && points[k].y < sides[0].corner.y))
            sides[0].corner = points[k];
    for (size_t k = 0; k < count; k++) {
        const double far = narc_hypot(points[k].x - sides[0].corner.x, points[k].y - sides[0].corner.y);
        second = far > extent ? k : second;
        extent = fmax(extent, far);
    }
    sides[1].corner = points[second];
    const double most = fmax(tolerance, extent * LEAST_TOLERANCE) / 2; /* outside, and welded */
    for (size_t k = 0; k < 2 && extent > 0; k++)
        look_outside(points, count, &sides[k], sides[1 - k].corner);
    for (;;) {
        size_t at = 0;
        for (size_t k = 1; k < left; k++)
            at = sides[k].distance > sides[at].distance ? k : at;
        const hull_side widest = sides[at];
        if (!(extent > 0) || widest.distance <= most)
            break;
        if (left == NARC_MAX_ARCS)
            return narc_fail(error, NARC_ERROR_COUNT, 0, 2 * widest.distance,
                             "more than %d corners: with so many a tolerance of %.9g is possible", NARC_MAX_ARCS,
                             2 * widest.distance);
        memmove(&sides[at + 2], &sides[at + 1], (left - at - 1) * sizeof *sides);
        left++;
        sides[at + 1].corner = widest.furthest;
        look_outside(points, count, &sides[at], widest.furthest);
        look_outside(points, count, &sides[at + 1], sides[(at + 2) % left].corner);
    }
    for (size_t k = 0; k < left; k++)
        corners[k] = sides[k].corner;
    if (left < 3 || narc_weld_polygon(corners, left, most, corners, &left, NULL) != NARC_OK)
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, extent,
                         "all points lie within %.9g of a segment: narc_build_segment() makes one", 2 * most);
    return narc_build_skin_polygon(corners, left, radius, out_arcs, out_count, error);
}

narc_status narc_build_regular_polygon(size_t corners, double circumradius, double radius, narc_arc *out_arcs,
                                       size_t *out_count, narc_error *error) {
    narc_point points[NARC_MAX_ARCS];
    narc_status status = check_lengths(&(quantity){"circumradius", circumradius, POSITIVE}, 1, error);
    if (status != NARC_OK)
        return status;
    if (corners < 3 || corners > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)corners, "there are %zu corners, not 3 to %d", corners,
                         NARC_MAX_ARCS);
    for (size_t i = 0; i < corners; i++) {
        narc_find_normal(2 * NARC_PI * (double)i / (double)corners, &points[i].x, &points[i].y);
        points[i].x *= circumradius;
        points[i].y *= circumradius;
    }
    return narc_build_polygon(points, corners, radius, out_arcs, out_count, error);
}

/* ------------------------------------------------------------------------------------------------ four arcs */

/* The centre of a circle of `radius` that touches both large circles from inside: `low` and `high` are its distances
 * from their centres. Of the two such points the one with x > 0. */
static narc_point find_tip(const narc_four_arc *form, double radius) {
    double low = form->radius_low - radius, high = form->radius_high - radius, y = form->distance / 2;
    double tip_y = (high - low) * (high + low) / (2 * form->distance);
    return (narc_point){sqrt(fmax(0, (low - (tip_y - y)) * (low + (tip_y - y)))), tip_y};
}

narc_status narc_build_four_arc(const narc_four_arc *form, narc_arc *out_arcs, size_t *out_count, narc_error *error) {
    narc_status status = check_outputs(out_arcs, out_count, error);
    if (status == NARC_OK && !form)
        status = narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "form is NULL");
    if (status != NARC_OK)
        return status;
    const quantity lengths[] = {{"radius_low", form->radius_low, POSITIVE},
                                {"radius_high", form->radius_high, POSITIVE},
                                {"distance", form->distance, POSITIVE},
                                {"radius_left", form->radius_left, RADIUS},
                                {"radius_right", form->radius_right, RADIUS}};
    status = check_lengths(lengths, 5, error);
    if (status != NARC_OK)
        return status;
    double sum = form->radius_low + form->radius_high, difference = fabs(form->radius_low - form->radius_high);
    if (form->distance >= sum)
        return narc_fail(error, NARC_ERROR_SIZE, 0, form->distance,
                         "distance is %.9g, the large circles overlap only below %.9g", form->distance, sum);
    if (form->distance <= difference)
        return narc_fail(error, NARC_ERROR_SIZE, 0, form->distance,
                         "distance is %.9g, one large circle contains the other up to %.9g", form->distance,
                         difference);
    /* A small circle that reaches from side to side at the thickest place is the largest one that fits. */
    double most = (sum - form->distance) / 2;
    for (size_t i = 3; i < 5; i++)
        if (lengths[i].value >= most)
            return narc_fail(error, NARC_ERROR_RADIUS, i == 3 ? 2 : 0, lengths[i].value,
                             "%s is %.9g, it must be below %.9g to fit between the large circles", lengths[i].name,
                             lengths[i].value, most);
    narc_point right = find_tip(form, form->radius_right), left = find_tip(form, form->radius_left);
    double y = form->distance / 2;
    double right_low = narc_atan2(right.y - y, right.x), right_high = narc_atan2(right.y + y, right.x);
    double left_low = narc_atan2(left.y - y, -left.x), left_high = narc_atan2(left.y + y, -left.x);
    const narc_arc arcs[4] = {{right.x, right.y, form->radius_right, right_low, right_high},
                              {0, -y, form->radius_high, right_high, left_high},
                              {-left.x, left.y, form->radius_left, left_high, left_low},
                              {0, y, form->radius_low, left_low, right_low}};
    return finish(arcs, 4, out_arcs, out_count, error);
}
