/* SPDX-License-Identifier: MIT
 *
 * encode.c - a shape as the store keeps it: validated, rounded to single precision, with all that kernels ask of it.
 */
#include "encode.h"

#include <math.h>
#include <string.h>

#include "broken.h"
#include "elementary.h"
#include "error.h"
#include "outline.h"

/* How far outside, relative to the size, an arc's centre may be found and still count as inside: a few dozen
 * roundings of the largest coordinate that validation lets through, NARC_MAX_RADIUS_RATIO times the size. */
#define CENTER_SLACK 1e-12

static float round_up(double value) {
    float rounded = (float)value;
    return (double)rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

static float round_down(double value) {
    float rounded = (float)value;
    return (double)rounded > value ? nextafterf(rounded, -INFINITY) : rounded;
}

/* `room` is what rounding may have moved. */
static uint8_t find_flags(const narc_outline *o, size_t count, double size, double room) {
    bool smooth = true, polygon = true, inside = true;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        smooth = smooth && narc_hypot(to.x - from.x, to.y - from.y) <= NARC_TOLERANCE * size + room;
        polygon = polygon && o->radius[i] == 0;
        inside = inside && (o->radius[i] == 0 || narc_find_point_separation(o, o->center_x[i], o->center_y[i], NULL) <=
                                                     CENTER_SLACK * size + room);
    }
    return (uint8_t)((smooth ? NARC_SHAPE_SMOOTH : 0) | (count == 1 ? NARC_SHAPE_CIRCLE : 0) |
                     (polygon ? NARC_SHAPE_POLYGON : 0) | (inside ? NARC_SHAPE_CENTERS_INSIDE : 0));
}

static unsigned find_size_class(double extent) { return (unsigned)(fmin(fmax(0, ilogb(extent) + 32), 79) / 5); }

/* By how much the arcs fail to make a closed convex outline, in all: distances across the normal of a junction, and
 * along an edge that runs backwards. */
static double find_misfit(const narc_outline *o) {
    double misfit = 0;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        double x = to.x - from.x, y = to.y - from.y, n_x = o->normal_x[i], n_y = o->normal_y[i];
        misfit += fabs(x * n_x + y * n_y) + fmax(0, x * n_y - y * n_x);
    }
    return misfit;
}

/* How far the outline of stored arcs may be from the one that was given: a few roundings of each coordinate, radius and
 * normal. Relative to the extent; a quarter of what the circles leave as room. */
#define STORED_ROOM (NARC_ROUNDING_ROOM / 4)

static narc_shape_header make_header(const narc_outline *o, size_t count, narc_circle bound, double extent) {
    narc_circle inner;
    narc_inscribe_outline(o, &inner);
    double misfit = find_misfit(o), room = NARC_ROUNDING_ROOM * extent + misfit;
    /* The middle of a segment whose ends miss each other lies beside it. */
    const double outside = narc_find_point_separation(o, inner.x, inner.y, NULL);
    inner.radius = outside > STORED_ROOM * extent ? -outside : inner.radius;
    inner.x += o->origin_x;
    inner.y += o->origin_y;
    narc_shape_header header = {.count = (uint8_t)o->count};
    header.flags = (uint8_t)(find_flags(o, count, bound.radius, 0) | find_size_class(extent) << NARC_SIZE_CLASS_SHIFT);
    header.bound_x = (float)bound.x;
    header.bound_y = (float)bound.y;
    double moved = narc_hypot((double)header.bound_x - bound.x, (double)header.bound_y - bound.y);
    header.bound_radius = round_up(bound.radius + moved + room);
    header.inner_x = (float)inner.x;
    header.inner_y = (float)inner.y;
    moved = narc_hypot((double)header.inner_x - inner.x, (double)header.inner_y - inner.y);
    header.inner_radius = round_down(inner.radius - moved - room);
    /* One part in a million for the rounding of what is stored. */
    header.extent_ratio = UINT8_MAX;
    if (misfit <= NARC_MAX_MISFIT * extent)
        header.extent_ratio = (uint8_t)fmin(UINT8_MAX, ceil(extent * (1 + 1e-6) / (double)header.bound_radius));
    return header;
}

/* The diamond angle of a normal, as the kernels compute it. */
static float find_diamond_angle(float x, float y) {
    float p = x / (fabsf(x) + fabsf(y));
    return 0 <= y ? 1 - p : 3 + p;
}

/* The smallest radius of the arcs that hold a direction within `window` of one of arc `arc`. Those that begin just
 * outside the window count, too, against rounding. */
static double find_least_radius(const narc_outline *o, size_t arc, double window) {
    double least = o->radius[arc];
    for (int side = 0; side < 2; side++) {
        double angle = 0;
        for (size_t k = 1; k < o->count && angle <= window + NARC_TOLERANCE; k++) {
            size_t i = (side ? arc + k : arc + o->count - k) % o->count;
            least = fmin(least, o->radius[i]);
            angle += o->sweep[i];
        }
    }
    return least;
}

/* The largest radius of a circle in the shape that touches its outline at the point p with the normal n, not more than
 * `limit`. Such a circle of radius t reaches p.m + t (1 - n.m) in the direction m, so t is at most
 * (h(m) - p.m) / (1 - n.m) for every m. With m in the sector of arc j, h(m) - p.m = r - w.m where w = p - its centre;
 * the quotient is least at an end of the sector or where the circle touches that arc. */
static double find_inner_radius(const narc_outline *o, narc_point p, double n_x, double n_y, double limit) {
    /* Arcs that touch p, or hold directions as near to n as that, are neighbours: `limit` knows their radii. */
    const double nothing = NARC_TOLERANCE * NARC_TOLERANCE;
    double least = limit;
    for (size_t j = 0; j < o->count; j++) {
        double w_x = p.x - o->center_x[j], w_y = p.y - o->center_y[j], r = o->radius[j];
        for (size_t end = j; end <= j + 1; end++) {
            double m_x = o->normal_x[end], m_y = o->normal_y[end], width = 1 - (n_x * m_x + n_y * m_y);
            if (width > nothing)
                least = fmin(least, (r - (w_x * m_x + w_y * m_y)) / width);
        }
        double fall = r - (w_x * n_x + w_y * n_y);
        if (fall > nothing * r) {
            double touching = (r * r - (w_x * w_x + w_y * w_y)) / (2 * fall);
            if (narc_in_sector(o, j, w_x - touching * n_x, w_y - touching * n_y))
                least = fmin(least, touching);
        }
    }
    return fmax(0, least);
}

/* Of all circles that touch an arc from inside, those at its ends are the first to leave the shape: by how much the
 * arc's circle exceeds the shape in a direction m does not depend on the point, and it counts most from the nearest. */
static double find_arc_inner(const narc_outline *o, size_t arc) {
    double inner = find_least_radius(o, arc, NARC_INNER_WINDOW);
    inner = find_inner_radius(o, narc_find_start(o, arc), o->normal_x[arc], o->normal_y[arc], inner);
    return find_inner_radius(o, narc_find_end(o, arc), o->normal_x[arc + 1], o->normal_y[arc + 1], inner);
}

/* The upper half of a float that is at most a value, less a part in a million for the rounding of what is stored. */
static uint32_t find_upper_half(double value) {
    float rounded = (float)(value * (1 - 1e-6));
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits >> 16;
}

static void write_records(const narc_outline *o, narc_shape_header *header, narc_record *records) {
    size_t count = o->count, first = 0, angle_records = narc_angle_records(count);
    float angles[NARC_MAX_ARCS];
    for (size_t i = 0; i < count; i++) {
        angles[i] = find_diamond_angle((float)o->normal_x[i], (float)o->normal_y[i]);
        first = angles[i] < angles[first] ? i : first;
    }
    header->first_arc = (uint8_t)first;
    for (size_t k = 0; k < NARC_RECORD_ANGLES * angle_records; k++) {
        int16_t angle = NARC_ANGLE_NONE;
        if (k < count)
            angle = (int16_t)(angles[(first + k) % count] * NARC_ANGLE_SCALE - NARC_ANGLE_OFFSET);
        records[k / NARC_RECORD_ANGLES].angles[k % NARC_RECORD_ANGLES] = angle;
    }
    for (size_t k = 0; k < count; k++) {
        size_t i = (first + k) % count;
        records[angle_records + k].arc =
            (narc_stored_arc){.center_x = (float)(o->center_x[i] + o->origin_x),
                              .center_y = (float)(o->center_y[i] + o->origin_y),
                              .radius = (float)o->radius[i],
                              .inner_radii = find_upper_half(find_arc_inner(o, i)) << 16 |
                                             find_upper_half(find_least_radius(o, i, NARC_NEAR_WINDOW)),
                              .start_x = (float)o->normal_x[i],
                              .start_y = (float)o->normal_y[i],
                              .end_x = (float)o->normal_x[i + 1],
                              .end_y = (float)o->normal_y[i + 1]};
    }
}

narc_status narc_encode_shape(const narc_arc *arcs, size_t count, narc_encoded_shape *out_shape, narc_error *error) {
    narc_outline outline;
    narc_circle bound;
    narc_status status = narc_check_arcs(arcs, count, &outline, &bound, error);
    if (status != NARC_OK)
        return status;
    double extent = 0;
    for (size_t i = 0; i < count; i++)
        extent = fmax(extent, narc_hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
    narc_shape_header header = make_header(&outline, count, bound, extent);
    if (!narc_is_size(header.bound_radius))
        return narc_fail(error, NARC_ERROR_SIZE, 0, bound.radius,
                         "the shape's bounding radius is %.9g, with room for rounding %.9g, more than %g", bound.radius,
                         (double)header.bound_radius, NARC_MAX_SIZE);
    write_records(&outline, &header, out_shape->records);
    out_shape->header = header;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ pieces of chains */

/* Of a piece, whose header is known. */
static narc_solid *find_solid(narc_encoded_shape *shape) {
    return &shape->records[narc_count_records(&shape->header) - 1].solid;
}

narc_status narc_encode_run(const narc_arc *arcs, size_t count, const narc_solid *solid, narc_encoded_shape *out_shape,
                            narc_error *error) {
    const narc_status status = narc_encode_shape(arcs, count, out_shape, error);
    if (status == NARC_OK) {
        out_shape->header.first_arc |= NARC_PIECE_RUN;
        *find_solid(out_shape) = *solid;
    }
    return status;
}

/* Centre and radius of a concave arc that is stored, added. */
static double find_concave_extent(const narc_stored_arc *arc) {
    return narc_hypot((double)arc->center_x, (double)arc->center_y) - (double)arc->radius;
}

/* The circle around the chord's middle: the arc turns by less than half a turn. */
static float bound_concave(const narc_stored_arc *arc, float *out_x, float *out_y) {
    const double x = (double)arc->center_x, y = (double)arc->center_y, radius = (double)arc->radius;
    const narc_point start = {x + radius * (double)arc->start_x, y + radius * (double)arc->start_y};
    const narc_point end = {x + radius * (double)arc->end_x, y + radius * (double)arc->end_y};
    const float m_x = (float)((start.x + end.x) / 2), m_y = (float)((start.y + end.y) / 2);
    *out_x = m_x;
    *out_y = m_y;
    return round_up(fmax(narc_hypot(start.x - (double)m_x, start.y - (double)m_y),
                         narc_hypot(end.x - (double)m_x, end.y - (double)m_y)) +
                    NARC_ROUNDING_ROOM * find_concave_extent(arc));
}

/* The header and the angles of a concave arc that is stored, with a circle of at least this radius. */
static void write_concave(narc_encoded_shape *shape, float least_bound) {
    const narc_stored_arc *arc = &shape->records[1].arc;
    const double extent = find_concave_extent(arc);
    float x, y;
    const float bound = fmaxf(bound_concave(arc, &x, &y), least_bound);
    shape->header =
        (narc_shape_header){.count = 1,
                            .first_arc = NARC_PIECE_CONCAVE,
                            .flags = (uint8_t)(find_size_class(extent) << NARC_SIZE_CLASS_SHIFT),
                            .extent_ratio = (uint8_t)fmin(UINT8_MAX, ceil(extent * (1 + 1e-6) / (double)bound)),
                            .bound_x = x,
                            .bound_y = y,
                            .bound_radius = bound,
                            .inner_radius = -INFINITY};
    for (size_t k = 0; k < NARC_RECORD_ANGLES; k++)
        shape->records[0].angles[k] = NARC_ANGLE_NONE;
    shape->records[0].angles[0] =
        (int16_t)(find_diamond_angle(arc->start_x, arc->start_y) * NARC_ANGLE_SCALE - NARC_ANGLE_OFFSET);
}

narc_status narc_encode_concave(const narc_arc *arc, double least_bound, const narc_solid *solid,
                                narc_encoded_shape *out_shape, narc_error *error) {
    narc_point start, end;
    narc_find_normal(arc->start, &start.x, &start.y);
    narc_find_normal(arc->end, &end.x, &end.y);
    out_shape->records[1].arc = (narc_stored_arc){.center_x = (float)arc->center_x,
                                                  .center_y = (float)arc->center_y,
                                                  .radius = (float)arc->radius,
                                                  .start_x = (float)start.x,
                                                  .start_y = (float)start.y,
                                                  .end_x = (float)end.x,
                                                  .end_y = (float)end.y};
    write_concave(out_shape, (float)least_bound);
    *find_solid(out_shape) = *solid;
    const double bound = (double)out_shape->header.bound_radius;
    if (!narc_is_size(out_shape->header.bound_radius))
        return narc_fail(error, NARC_ERROR_SIZE, 0, bound, "its bounding radius is %g, not in %g .. %g", bound,
                         NARC_MIN_SIZE, NARC_MAX_SIZE);
    if (-arc->radius > 4 * NARC_MAX_RADIUS_RATIO * bound)
        return narc_fail(error, NARC_ERROR_RADIUS, 0, arc->radius,
                         "radius is %.9g, more than %g times half the chord %.9g", arc->radius,
                         4 * NARC_MAX_RADIUS_RATIO, bound);
    return NARC_OK;
}

narc_status narc_encode_plane(narc_encoded_shape *out_shape, narc_error *error) {
    static const narc_point corners[] = {{-1, 0}, {-1, -1}, {1, -1}, {1, 0}}; /* edge 0 is the boundary */
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    if (!NARC_PIECES)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "this module has no half-planes");
    narc_status status = narc_build_polygon(corners, sizeof corners / sizeof *corners, 0, arcs, &count, error);
    if (status == NARC_OK)
        status = narc_encode_shape(arcs, count, out_shape, error);
    if (status == NARC_OK) {
        out_shape->header.first_arc |= NARC_PIECE_PLANE;
        *find_solid(out_shape) = (narc_solid){0};
    }
    return status;
}

static bool has_same_bits(float a, float b) {
    uint32_t bits[2];
    memcpy(&bits[0], &a, sizeof a);
    memcpy(&bits[1], &b, sizeof b);
    return bits[0] == bits[1];
}

/* The caller's arc of a number, round and round. */
static const narc_stored_arc *find_caller_arc(const narc_encoded_shape *shape, size_t number) {
    const size_t count = shape->header.count, first = shape->header.first_arc & NARC_FIRST_ARC;
    return &shape->records[narc_angle_records(count) + (number + count - first) % count].arc;
}

/* Is it stored with these bits? The normals are those of the edges before and behind it. */
static bool is_corner(const narc_stored_arc *arc, float x, float y, float radius, const float *start,
                      const float *end) {
    return has_same_bits(arc->center_x, x) && has_same_bits(arc->center_y, y) && has_same_bits(arc->radius, radius) &&
           has_same_bits(arc->start_x, start[0]) && has_same_bits(arc->start_y, start[1]) &&
           has_same_bits(arc->end_x, end[0]) && has_same_bits(arc->end_y, end[1]);
}

/* Is a shape a polygon of a few corners, which have one radius? Pieces of chains are none. */
static bool has_equal_corners(const narc_encoded_shape *shape) {
    const narc_shape_header *header = &shape->header;
    const narc_record *arcs = &shape->records[narc_angle_records(header->count)];
    bool equal = header->count >= 3 && header->count <= NARC_FORM_CORNERS && !(header->flags & NARC_SHAPE_SMOOTH) &&
                 !narc_is_piece(header);
    for (size_t k = 1; equal && k < header->count; k++)
        equal = has_same_bits(arcs[k].arc.radius, arcs[0].arc.radius);
    return equal;
}

narc_box_form narc_find_box_form(const narc_encoded_shape *shape) {
    static const float normals[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    static const float sides[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const narc_shape_header *header = &shape->header;
    const narc_record *arcs = &shape->records[narc_angle_records(header->count)];
    const bool circle = header->flags & NARC_SHAPE_CIRCLE, capsule = header->count == 2 && !circle;
    const bool smooth = header->flags & NARC_SHAPE_SMOOTH;
    const uint32_t other = has_equal_corners(shape) ? NARC_IS_POLYGON : 0;
    if (narc_is_of_chain(header)) {
        const narc_stored_arc *a = find_caller_arc(shape, 3);
        return (narc_box_form){a->center_x, a->center_y, header->bound_radius, NARC_HAS_FRONT | NARC_IS_POLYGON};
    }
    if (narc_is_plane(header))
        return (narc_box_form){1, 0, 0, NARC_IS_PLANE | NARC_IS_POLYGON | (header->first_arc & NARC_FIRST_ARC)};
    if ((header->count != 4 && header->count != 2) || header->extent_ratio == UINT8_MAX || smooth != circle)
        return (narc_box_form){.info = other};
    const float x = fabsf(arcs[0].arc.center_x), radius = arcs[0].arc.radius;
    const float y = capsule ? arcs[0].arc.start_x : arcs[0].arc.center_y; /* of a capsule a zero with its sign */
    const float least_edge = ldexpf(1, 5 * (header->flags >> NARC_SIZE_CLASS_SHIFT) - 47);
    /* A header that was loaded may say anything of the bounding circle; kernels go by half of its size. */
    bool found = (circle || x > least_edge) && header->bound_radius <= 1.001f * (x + y + radius);
    if (circle) {
        for (size_t k = 0; k < 2; k++)
            found = found && has_same_bits(arcs[k].arc.center_x, 0) && has_same_bits(arcs[k].arc.center_y, 0);
    } else if (capsule) {
        const float up[2] = {y, 1}, down[2] = {-y, -1};
        found = found && y == 0 && is_corner(&arcs[0].arc, -x, 0, radius, up, down) &&
                is_corner(&arcs[1].arc, x, 0, radius, down, up);
    } else {
        found = found && y > least_edge;
        for (size_t k = 0; k < 4; k++)
            found =
                found && is_corner(&arcs[k].arc, sides[k][0] * x, sides[k][1] * y, radius, normals[k], normals[k + 1]);
    }
    const uint32_t info = circle ? NARC_IS_CIRCLE : (capsule ? NARC_IS_CAPSULE : NARC_IS_BOX) | header->first_arc;
    return found ? (narc_box_form){x, y, radius, info} : (narc_box_form){.info = other};
}

narc_piece_form narc_find_piece_form(const narc_encoded_shape *shape) {
    narc_shape_header header = shape->header;
    uint32_t info;
    if (!narc_is_of_chain(&header))
        return (narc_piece_form){.info = 0};
    const narc_stored_arc *const arc[] = {find_caller_arc(shape, 0), find_caller_arc(shape, 1),
                                          find_caller_arc(shape, 2)};
    header.first_arc &= NARC_PIECE_MARKS;
    memcpy(&info, (const char *)&header + sizeof header.first_record, sizeof info);
    return (narc_piece_form){.center_0 = {arc[0]->center_x, arc[0]->center_y},
                             .normal_1 = {arc[1]->start_x, arc[1]->start_y},
                             .center_1 = {arc[1]->center_x, arc[1]->center_y},
                             .radius_1 = arc[1]->radius,
                             .info = info,
                             .normal_2 = {arc[1]->end_x, arc[1]->end_y},
                             .center_2 = {arc[2]->center_x, arc[2]->center_y},
                             .normal_3 = {arc[2]->end_x, arc[2]->end_y},
                             .radius_2 = arc[2]->radius,
                             .thickness = shape->records[narc_count_records(&header) - 1].solid.thickness};
}

/* ------------------------------------------------------------------------------------------------ loading */

/* A cosine or sine of a stored normal is off by half a rounding. */
#define UNIT_SLACK 1e-6

static narc_status fail_stored(narc_error *error, const char *what) {
    return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "%s", what);
}

/* The outline of stored arcs, in the caller's order, and their extent. */
static narc_status read_stored(const narc_shape_header *header, const narc_record *arcs, narc_outline *out_outline,
                               double *out_extent, narc_error *error) {
    narc_outline *o = out_outline;
    double sum = 0, extent = 0;
    const size_t count = header->count;
    o->count = count;
    for (size_t k = 0; k < count; k++) {
        const narc_stored_arc *a = &arcs[k].arc, *next = &arcs[(k + 1) % count].arc;
        const size_t i = (k + header->first_arc) % count;
        const double x = (double)a->start_x, y = (double)a->start_y;
        if (!isfinite(a->center_x) || !isfinite(a->center_y) || !isfinite(a->radius) || a->radius < 0)
            return fail_stored(error, "a number that no arc has");
        if (!(fabs(x * x + y * y - 1) <= UNIT_SLACK) || !has_same_bits(a->end_x, next->start_x) ||
            !has_same_bits(a->end_y, next->start_y))
            return fail_stored(error, "normals that do not join");
        o->center_x[i] = (double)a->center_x;
        o->center_y[i] = (double)a->center_y;
        o->radius[i] = (double)a->radius;
        o->normal_x[i] = x;
        o->normal_y[i] = y;
        const double cross = x * (double)next->start_y - y * (double)next->start_x;
        const double dot = x * (double)next->start_x + y * (double)next->start_y;
        o->sweep[i] = dot < 0 && fabs(cross) <= UNIT_SLACK ? NARC_PI : narc_atan2(cross, dot);
        if (!(o->sweep[i] >= NARC_TOLERANCE / 4))
            return fail_stored(error, "an arc that does not turn");
        sum += o->sweep[i];
        extent = fmax(extent, narc_hypot(o->center_x[i], o->center_y[i]) + o->radius[i]);
    }
    if (fabs(sum - 2 * NARC_PI) > 1)
        return fail_stored(error, "arcs that do not make one turn");
    if (extent > 4 * NARC_MAX_RADIUS_RATIO * NARC_MAX_SIZE)
        return fail_stored(error, "arcs that are too large");
    o->normal_x[count] = o->normal_x[0];
    o->normal_y[count] = o->normal_y[0];
    o->origin_x = o->center_x[0] + o->radius[0] * o->normal_x[0];
    o->origin_y = o->center_y[0] + o->radius[0] * o->normal_y[0];
    for (size_t i = 0; i < count; i++) {
        o->center_x[i] -= o->origin_x;
        o->center_y[i] -= o->origin_y;
    }
    *out_extent = extent;
    return NARC_OK;
}

/* Is what the stored header says of this outline true? */
static narc_status check_header(const narc_shape_header *header, const narc_outline *o, const narc_record *arcs,
                                double extent, narc_error *error) {
    const double join = (double)o->count * 8 / 16777216 * extent, misfit = find_misfit(o);
    const double room = NARC_ROUNDING_ROOM * extent - STORED_ROOM * extent + fmax(0, misfit - join);
    const double bound = (double)header->bound_radius, inner = (double)header->inner_radius;
    narc_circle circle;
    narc_point farthest;
    narc_bound_outline(o, &circle);
    if (narc_check_edges(o, NARC_TOLERANCE * circle.radius + STORED_ROOM * extent, NULL) != NARC_OK)
        return fail_stored(error, "arcs that do not meet");
    for (size_t i = 0; i < o->count; i++)
        if (o->radius[i] > NARC_MAX_RADIUS_RATIO * circle.radius * (1 + 1e-6) + STORED_ROOM * extent)
            return fail_stored(error, "an arc that is too flat");
    if (!narc_is_size(header->bound_radius) || !isfinite(header->bound_x) || !isfinite(header->bound_y) ||
        !isfinite(header->inner_x) || !isfinite(header->inner_y) || !isfinite(inner))
        return fail_stored(error, "a circle that is out of range");
    if (!(narc_hypot((double)header->bound_x, (double)header->bound_y) <= NARC_MAX_SIZE * (1 + 1e-6)))
        return fail_stored(error, "a shape too far from its origin");
    if (!(narc_find_farthest(o, (double)header->bound_x - o->origin_x, (double)header->bound_y - o->origin_y,
                             &farthest) +
              room <=
          bound))
        return fail_stored(error, "a circle that does not hold its shape");
    if (!(inner <= -narc_find_point_separation(o, (double)header->inner_x - o->origin_x,
                                               (double)header->inner_y - o->origin_y, NULL) -
                       room))
        return fail_stored(error, "a circle that is not in its shape");
    if (header->extent_ratio != UINT8_MAX &&
        (extent * (1 + 5e-7) > header->extent_ratio * bound || misfit > NARC_MAX_MISFIT * extent + join))
        return fail_stored(error, "an extent that is too small");
    const bool disc = o->count == 2 && arcs[0].arc.radius > 0 &&
                      memcmp(&arcs[0].arc, &arcs[1].arc, offsetof(narc_stored_arc, inner_radii)) == 0;
    const unsigned true_flags = find_flags(o, disc ? 1 : 2, circle.radius, STORED_ROOM * extent);
    const unsigned size_class = header->flags >> NARC_SIZE_CLASS_SHIFT;
    if ((header->flags & ~true_flags & ((1u << NARC_SIZE_CLASS_SHIFT) - 1)) ||
        size_class < find_size_class(extent * (1 - 1e-6)) || size_class > find_size_class(extent * (1 + 1e-6)))
        return fail_stored(error, "flags that are not the shape's");
    return NARC_OK;
}

static double read_upper_half(uint32_t half) {
    const uint32_t bits = half << 16;
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/* Does a circle of radius `inner` that touches the outline from inside, at a point with the normal n, lie in it? */
static bool has_room(const narc_outline *o, narc_point p, double n_x, double n_y, double inner, double room) {
    return -narc_find_point_separation(o, p.x - inner * n_x, p.y - inner * n_y, NULL) >= inner - room;
}

/* Are the inner radii of an arc none that it does not have? The windows are narrower than those of the encoder by more
 * than sums of stored normals are off. Where arcs do not quite meet, an end of one lies outside of the other's edge. */
static bool has_inner_radii(const narc_outline *o, size_t arc, uint32_t radii, double extent, double misfit) {
    const double inner = read_upper_half(radii >> 16), near = read_upper_half(radii & 0xffff);
    const double room = STORED_ROOM * extent / 3 + misfit, slack = 1 + 1e-6;
    return inner >= 0 && near >= 0 && inner <= find_least_radius(o, arc, NARC_INNER_WINDOW - NARC_TOLERANCE) * slack &&
           near <= find_least_radius(o, arc, NARC_NEAR_WINDOW - NARC_TOLERANCE) * slack &&
           has_room(o, narc_find_start(o, arc), o->normal_x[arc], o->normal_y[arc], inner, room) &&
           has_room(o, narc_find_end(o, arc), o->normal_x[arc + 1], o->normal_y[arc + 1], inner, room);
}

static bool is_solid(const narc_solid *solid) {
    const float lengths[] = {solid->thickness, solid->clearance[0], solid->clearance[1], solid->depth};
    bool is = true;
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++)
        is = is && lengths[k] >= 0 && isfinite(lengths[k]);
    for (size_t k = 0; k < sizeof solid->unused / sizeof *solid->unused; k++)
        is = is && has_same_bits(solid->unused[k], 0);
    return is;
}

/* Is it a concave arc with the header that it should have? Its circle may be larger: that of a valley's bottom is. */
static narc_status restore_concave(narc_encoded_shape *shape, narc_error *error) {
    const narc_shape_header header = shape->header;
    const narc_stored_arc *a = &shape->records[1].arc;
    const double x = (double)a->start_x, y = (double)a->start_y, end_x = (double)a->end_x, end_y = (double)a->end_y;
    if (header.count != 1 || header.first_arc != NARC_PIECE_CONCAVE || a->inner_radii != 0)
        return fail_stored(error, "a piece of a chain that is none");
    if (!isfinite(a->center_x) || !isfinite(a->center_y) || !isfinite(a->radius) || !signbit(a->radius) ||
        !narc_is_size(header.bound_radius) || find_concave_extent(a) > 5 * NARC_MAX_RADIUS_RATIO * NARC_MAX_SIZE)
        return fail_stored(error, "a number that no concave arc has");
    if (!(fabs(x * x + y * y - 1) <= UNIT_SLACK) || !(fabs(end_x * end_x + end_y * end_y - 1) <= UNIT_SLACK) ||
        !(x * end_y - y * end_x >= NARC_TOLERANCE / 4))
        return fail_stored(error, "a concave arc that does not turn");
    if (!is_solid(find_solid(shape)))
        return fail_stored(error, "a solid that no piece of a chain has");
    write_concave(shape, header.bound_radius);
    if (memcmp((const char *)&shape->header, (const char *)&header, sizeof header) != 0 ||
        -(double)a->radius > 5 * NARC_MAX_RADIUS_RATIO * (double)header.bound_radius)
        return fail_stored(error, "a concave arc whose header is another's");
    return NARC_OK;
}

/* There is one half-plane. */
static narc_status restore_plane(narc_encoded_shape *shape, narc_error *error) {
    narc_encoded_shape plane;
    const size_t first = offsetof(narc_shape_header, first_record) + sizeof(uint32_t);
    const narc_status status = narc_encode_plane(&plane, error);
    if (status != NARC_OK)
        return status;
    const size_t angles = narc_angle_records(plane.header.count);
    memcpy(shape->records, plane.records, angles * sizeof *plane.records);
    if (memcmp((const char *)&shape->header + first, (const char *)&plane.header + first,
               sizeof plane.header - first) != 0 ||
        memcmp(shape->records, plane.records, narc_count_records(&plane.header) * sizeof *plane.records) != 0)
        return fail_stored(error, "a half-plane that is none");
    return NARC_OK;
}

/* Are both ends and the far side of a closed run corners? */
static bool is_closed_run(const narc_outline *o) {
    bool corners = o->count >= 6;
    for (size_t k = 0; corners && k < 6; k++)
        corners = o->radius[k > 0 ? o->count - k : 0] == 0;
    return corners;
}

narc_status narc_restore_shape(narc_encoded_shape *shape, narc_error *error) {
    narc_outline o;
    narc_record stored[NARC_MAX_ARCS];
    double extent = 0;
    narc_shape_header header = shape->header;
    const uint8_t mark = NARC_PIECES ? header.first_arc & NARC_PIECE_RUN : 0;
    if (narc_is_plane(&header))
        return restore_plane(shape, error);
    if (narc_is_concave(&header))
        return restore_concave(shape, error);
    header.first_arc ^= mark;
    if (header.count < 2 || header.count > NARC_MAX_ARCS || header.first_arc >= header.count)
        return fail_stored(error, "a number of arcs that no shape has");
    const size_t count = header.count, angles = narc_angle_records(count);
    memcpy(stored, &shape->records[angles], count * sizeof *stored);
    narc_status status = read_stored(&header, stored, &o, &extent, error);
    if (status == NARC_OK)
        status = check_header(&header, &o, stored, extent, error);
    if (status != NARC_OK)
        return status;
    if (mark && !is_closed_run(&o))
        return fail_stored(error, "a piece of a chain that is none");
    if (mark && !is_solid(find_solid(shape)))
        return fail_stored(error, "a solid that no piece of a chain has");
    write_records(&o, &shape->header, shape->records);
    if (shape->header.first_arc != header.first_arc)
        return fail_stored(error, "arcs out of order");
    shape->header.first_arc |= mark;
    const double misfit = find_misfit(&o);
    for (size_t k = 0; k < count; k++)
        if (!has_inner_radii(&o, (k + header.first_arc) % count, stored[k].arc.inner_radii, extent, misfit))
            return fail_stored(error, "an arc without the room behind it that it should have");
    memcpy(&shape->records[angles], stored, count * sizeof *stored);
    return NARC_OK;
}
