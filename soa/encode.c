/* SPDX-License-Identifier: MIT
 *
 * encode.c - a shape as the store keeps it: validated, rounded to single precision, with all that kernels ask of it.
 */
#include "encode.h"

#include <math.h>
#include <string.h>

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

static uint8_t find_flags(const narc_outline *o, size_t count, double size) {
    bool smooth = true, polygon = true, inside = true;
    for (size_t i = 0; i < o->count; i++) {
        narc_point from = narc_find_end(o, i ? i - 1 : o->count - 1), to = narc_find_start(o, i);
        smooth = smooth && narc_hypot(to.x - from.x, to.y - from.y) <= NARC_TOLERANCE * size;
        polygon = polygon && o->radius[i] == 0;
        inside = inside &&
                 (o->radius[i] == 0 || narc_find_gap(o, o->center_x[i], o->center_y[i], NULL) <= CENTER_SLACK * size);
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

static narc_shape_header make_header(const narc_outline *o, size_t count, narc_circle bound, double extent) {
    narc_circle inner;
    narc_inscribe_outline(o, &inner);
    double misfit = find_misfit(o), room = NARC_ROUNDING_ROOM * extent + misfit;
    inner.x += o->origin_x;
    inner.y += o->origin_y;
    narc_shape_header header = {.count = (uint8_t)o->count};
    header.flags = (uint8_t)(find_flags(o, count, bound.radius) | find_size_class(extent) << NARC_SIZE_CLASS_SHIFT);
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
    if ((double)header.bound_radius > NARC_MAX_BOUND_RADIUS)
        return narc_fail(error, NARC_ERROR_SIZE, 0, bound.radius,
                         "the shape's bounding radius is %.9g, with room for rounding %.9g, more than %g", bound.radius,
                         (double)header.bound_radius, NARC_MAX_SIZE);
    write_records(&outline, &header, out_shape->records);
    out_shape->header = header;
    return NARC_OK;
}
