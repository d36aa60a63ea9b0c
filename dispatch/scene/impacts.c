/* SPDX-License-Identifier: MIT
 *
 * impacts.c - the time of impact of one pair, a separation at a time. What is not proved by docs/algorithm.md is not
 * relied upon: a pair never goes past a time at which its separation could have come down to the target.
 *
 * With d the way from A's position to B's, w its change in a whole step, n the contact normal and f the separation:
 *
 * Without turning f is convex in time, because it is the signed distance of a point on a line from a convex set. Its
 * slope is n.w. So the tangent never passes the first root (Newton). The circles that touch may be followed further, to
 * the root of their distance: where f still falls at that time, and is not below the target, no root was passed.
 *
 * With turning f(t) is at least the gap g(t) along any axis, and the axis that n is now, at rest or turning with a body,
 * is followed to a time before which g cannot be at the target. While the arcs that hold the axis stay the same, with
 * centres p relative to their bodies and the axis turning at the rate w_n,
 *     g' = n.w + w_n n x d + (w_b - w_n) p_b x n - (w_a - w_n) p_a x n,    g'' >= -M,
 *     M  = w_n^2 |d| + 2 |w_n| |w| + (w_b - w_n)^2 max(p_b.n, 0) + (w_a - w_n)^2 max(-p_a.n, 0).
 * Past them a support function changes at most as fast as its body turns times its lever.
 */
#include <math.h>

#include "casts.h"
#include "elementary.h"

/* Rounds after which an answer is "not finished". */
enum { MOST_ROUNDS = 128 };

/* Of a body that turns, by default: the part of the smaller bounding radius that a hit may be away from the target. */
#define TURNING_TOLERANCE 0x1p-10

/* What a separation without turning may be away from the target, of a distance and both radii: a quarter of what
 * rounding may do to it (NARC_ERROR_BOUND). */
#define ROUNDING 0x1p-21

static double dot(narc_point a, narc_point b) { return a.x * b.x + a.y * b.y; }
static double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static double length(narc_point a) { return sqrt(dot(a, a)); }

/* A time of 0 or more as a float that is not later. */
static float round_down(double time) {
    const float rounded = (float)time;
    return (double)rounded > time ? rounded - rounded * 0x1p-24f : rounded;
}

static narc_point turn(double cosine, double sine, narc_point p) {
    return (narc_point){cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

/* ------------------------------------------------------------------------------------------------ the start */

/* The largest |point x normal| of an outline, at most: the rate at which its support function changes when the shape
 * turns by a radian. A point p of the outline is no further from the centre q of a circle in the shape than R, and along
 * its normal p - q is no shorter than that circle's radius r, so that |p x n| <= |q| + sqrt(R^2 - r^2). Of boxes and
 * regular polygons about their origins it is half an edge, and no less will do. */
static double find_lever(const narc_shape_header *header) {
    const narc_point inner = {(double)header->inner_x, (double)header->inner_y};
    const narc_point bound = {(double)header->bound_x, (double)header->bound_y};
    const double off = length(inner);
    if (header->flags & NARC_SHAPE_CIRCLE && off == 0)
        return 0;
    const double r = header->inner_radius > 0 ? (double)header->inner_radius : 0;
    const double far = (double)header->bound_radius + length((narc_point){bound.x - inner.x, bound.y - inner.y});
    return off + sqrt(far * far - r * r);
}

/* A circle that holds the body all the time: its radius, and its centre from the position. */
static double find_circle(const narc_mover *mover, narc_point *out_center) {
    const narc_shape_header *const header = mover->header;
    const narc_point center = {mover->scale * (double)header->bound_x, mover->scale * (double)header->bound_y};
    const double radius = mover->scale * (double)header->bound_radius;
    if (narc_turns(mover)) {
        *out_center = (narc_point){0, 0};
        return radius + length(center);
    }
    *out_center = turn(mover->rotation.x, mover->rotation.y, center);
    return radius;
}

/* When are two circles, that far apart, as near as `reach`? */
static bool meet_circles(narc_point apart, narc_point motion, double reach, double *out_start, double *out_end) {
    const double excess = dot(apart, apart) - reach * reach, square = dot(motion, motion), along = dot(apart, motion),
                 across = cross(apart, motion), height = reach * reach * square - across * across;
    *out_start = 0;
    *out_end = 1;
    if (square == 0)
        return excess <= 0;
    if (height < 0)
        return false;
    const double half = sqrt(height), first = (-along - half) / square, last = (-along + half) / square;
    *out_start = excess > 0 ? first : 0;
    *out_end = last < 1 ? last : 1;
    return *out_start <= *out_end && last >= 0 && (excess <= 0 || first >= 0);
}

int narc_begin_cast(narc_cast *cast, float tolerance) {
    cast->a.lever = cast->a.angle == 0 ? 0 : cast->a.scale * find_lever(cast->a.header);
    cast->b.lever = cast->b.angle == 0 ? 0 : cast->b.scale * find_lever(cast->b.header);
    const bool turns = narc_turns(&cast->a) || narc_turns(&cast->b);
    narc_point center_a, center_b;
    const double radius_a = find_circle(&cast->a, &center_a), radius_b = find_circle(&cast->b, &center_b);
    const narc_point apart = {cast->x + center_b.x - center_a.x, cast->y + center_b.y - center_a.y};
    const double reach = radius_a + radius_b + cast->target;
    double start;
    if (reach < 0 || !meet_circles(apart, (narc_point){cast->motion_x, cast->motion_y}, reach, &start, &cast->end))
        return NARC_CAST_MISS;
    const double smaller = cast->a.scale * (double)cast->a.header->bound_radius,
                 other = cast->b.scale * (double)cast->b.header->bound_radius;
    cast->speed = length((narc_point){cast->motion_x, cast->motion_y});
    cast->tolerance = tolerance > 0 ? (double)tolerance : TURNING_TOLERANCE * (smaller < other ? smaller : other);
    if (!turns)
        cast->tolerance = ROUNDING * (radius_a + radius_b + fabs(cast->target));
    cast->time = round_down(start);
    cast->back = -1;
    cast->rounds = 0;
    cast->direct = false;
    return NARC_CAST_GOES_ON;
}

/* ------------------------------------------------------------------------------------------------ what touches */

static unsigned get_arc_of(const narc_mover *mover, unsigned feature) {
    const narc_shape_header *const header = mover->header;
    const unsigned number = feature & (NARC_FEATURE_EDGE - 1), first = header->first_arc;
    return number >= first ? number - first : number + header->count - first;
}

/* Does an arc hold a normal, both in the shape's frame? */
static bool holds(const narc_stored_arc *arc, narc_point normal) {
    const narc_point start = {(double)arc->start_x, (double)arc->start_y};
    const narc_point end = {(double)arc->end_x, (double)arc->end_y};
    return cross(start, normal) >= 0 && cross(normal, end) >= 0;
}

static narc_point find_center(const narc_mover *mover, const narc_stored_arc *arc) {
    return (narc_point){mover->scale * (double)arc->center_x, mover->scale * (double)arc->center_y};
}

static bool is_circle(const narc_mover *mover) { return mover->header->flags & NARC_SHAPE_CIRCLE; }

/* ------------------------------------------------------------------------------------------------ without turning */

/* When, from now on, the circles of two arcs that are nearest to each other are at the target; false if never, or if
 * other arcs would be nearest then. */
static bool find_touch(const narc_shapes *shapes, const narc_cast *cast, const narc_contact *contact,
                       double *out_duration) {
    const double radii = (double)contact->radius_a + (double)contact->radius_b, goal = radii + cast->target,
                 way = radii + (double)contact->separation;
    if (!(radii < (double)INFINITY) || goal <= 0)
        return false;
    const narc_point n = {(double)contact->normal_x, (double)contact->normal_y}, u = {way * n.x, way * n.y},
                     motion = {cast->motion_x, cast->motion_y};
    const double across = cross(u, motion), height = goal * goal * dot(motion, motion) - across * across;
    if (height < 0)
        return false;
    const double duration = (dot(u, u) - goal * goal) / (sqrt(height) - dot(u, motion));
    const narc_point then = {u.x + duration * motion.x, u.y + duration * motion.y}, back = {-then.x, -then.y};
    *out_duration = duration;
    for (int side = 0; side < 2; side++) {
        const narc_mover *const mover = side == 0 ? &cast->a : &cast->b;
        const narc_record *const arcs = narc_arcs_of(shapes, mover->header);
        const unsigned arc = get_arc_of(mover, (unsigned)contact->feature >> 8 * side);
        if (!is_circle(mover) &&
            !holds(&arcs[arc].arc, turn(mover->rotation.x, -mover->rotation.y, side == 0 ? then : back)))
            return false;
    }
    return true;
}

static int advance_line(const narc_shapes *shapes, narc_cast *cast, const narc_contact *contact) {
    const double gap = (double)contact->separation - cast->target,
                 slope = (double)contact->normal_x * cast->motion_x + (double)contact->normal_y * cast->motion_y;
    if (cast->back >= 0 && (slope >= 0 || gap < -cast->tolerance)) { /* it may have passed the first root */
        cast->time = cast->back;
        cast->back = -1;
        cast->direct = true;
        return NARC_CAST_GOES_ON;
    }
    cast->back = -1;
    if (gap <= 0 || (gap <= cast->tolerance && slope < 0))
        return NARC_CAST_HIT;
    const double next = (double)cast->time - gap / slope;
    if (slope >= 0 || next > cast->end)
        return NARC_CAST_MISS;
    const float time = round_down(next);
    if (time <= cast->time)
        return NARC_CAST_HIT;
    if (++cast->rounds >= MOST_ROUNDS)
        return NARC_CAST_UNFINISHED;
    double duration;
    const bool further = !cast->direct && find_touch(shapes, cast, contact, &duration);
    const double touch = further ? (double)cast->time + duration : 0;
    cast->time = time;
    if (touch > next && touch <= cast->end) {
        cast->back = time;
        cast->time = round_down(touch);
    }
    return NARC_CAST_GOES_ON;
}

/* ------------------------------------------------------------------------------------------------ turning */

/* What an axis that turns meets of a body: the centre of an arc, for as long as it stays on that arc. */
struct lever {
    double arm;      /* centre x axis */
    double bend;     /* the least centre.axis on the way, below 0 */
    double duration; /* at least */
};

/* An axis that is as near to an arc's end as this has the next arc; and it may be so much before the start. */
#define AT_END 0x1p-19

/* `feature` of the body, on which the axis, outwards, turns at a rate. How far it may turn is at least the chord to the
 * arc's end. */
static struct lever find_arm(const narc_shapes *shapes, const narc_mover *mover, unsigned feature, narc_point axis,
                             double rate) {
    const narc_record *const arcs = narc_arcs_of(shapes, mover->header);
    const unsigned count = mover->header->count, arc = get_arc_of(mover, feature);
    if (is_circle(mover)) {
        const narc_point center = find_center(mover, &arcs->arc);
        return (struct lever){cross(center, axis), -length(center), (double)INFINITY};
    }
    const double sign = rate > 0 ? 1 : -1;
    const unsigned before = arc > 0 ? arc - 1 : count - 1, after = arc + 1 < count ? arc + 1 : 0;
    const bool on_edge = feature & NARC_FEATURE_EDGE; /* the one before the arc */
    const narc_stored_arc *held = &arcs[on_edge && rate < 0 ? before : arc].arc;
    for (int k = 0; k < 2; k++) {
        const narc_point start = {(double)held->start_x, (double)held->start_y};
        const narc_point end = {(double)held->end_x, (double)held->end_y};
        const narc_point to = rate > 0 ? end : start, from = rate > 0 ? start : end;
        if (sign * cross(axis, to) > AT_END || dot(axis, to) < 0) {
            const narc_point center = find_center(mover, held), chord = {to.x - axis.x, to.y - axis.y};
            const bool known = sign * cross(from, axis) >= -AT_END || dot(axis, from) < 0;
            const double arm = cross(center, axis), at_axis = dot(center, axis), at_end = dot(center, to);
            const double least = sign * arm > 0 && sign * cross(center, to) < 0 ? -length(center)
                                 : at_axis < at_end                             ? at_axis
                                                                                : at_end;
            return (struct lever){arm, least < 0 ? least : 0, known ? length(chord) / fabs(rate) : 0};
        }
        held = &arcs[rate > 0 ? after : before].arc;
    }
    return (struct lever){0, 0, 0};
}

/* For how long from now on the gap, which is `gap` above the target, stays there along the normal as an axis that turns
 * at a rate; `falls` is how fast it falls at most along one at rest. `out_slope`: of the gap. */
static double follow_axis(const narc_shapes *shapes, const narc_cast *cast, const narc_contact *contact, double gap,
                          double rate, double falls, double *out_slope) {
    const double time = (double)cast->time, left = cast->end - time;
    const narc_point n = {(double)contact->normal_x, (double)contact->normal_y}, back = {-n.x, -n.y},
                     motion = {cast->motion_x, cast->motion_y};
    double slope = dot(n, motion), bend = 0, duration = (double)INFINITY, fastest = falls;
    if (rate != 0) {
        const narc_point way = {cast->x + time * motion.x, cast->y + time * motion.y};
        slope += rate * cross(n, way);
        bend = rate * rate * (length(way) + cast->speed * left) + 2 * fabs(rate) * cast->speed;
        fastest += dot(n, motion) + cast->speed;
    }
    for (int side = 0; side < 2; side++) {
        const narc_mover *const mover = side == 0 ? &cast->a : &cast->b;
        const double its = rate - mover->angle;
        if (its == 0)
            continue;
        const narc_point axis = turn(mover->turned.x, -mover->turned.y, side == 0 ? n : back);
        const struct lever lever = find_arm(shapes, mover, (unsigned)contact->feature >> 8 * side, axis, its);
        slope += its * lever.arm;
        bend -= its * its * lever.bend;
        duration = lever.duration < duration ? lever.duration : duration;
    }
    *out_slope = slope;
    const double root = sqrt(slope * slope + 2 * bend * gap);
    const double whole = slope < 0 ? 2 * gap / (root - slope) : bend > 0 ? (root + slope) / bend : (double)INFINITY;
    if (whole <= duration)
        return whole;
    const double rest = gap + duration * (slope - bend * duration / 2);
    return rest > 0 ? duration + rest / fastest : duration;
}

static int advance_turn(const narc_shapes *shapes, narc_cast *cast, const narc_contact *contact) {
    const double gap = (double)contact->separation - cast->target;
    if (gap <= 0)
        return NARC_CAST_HIT;
    const double along = (double)contact->normal_x * cast->motion_x + (double)contact->normal_y * cast->motion_y;
    const double falls = cast->a.lever * fabs(cast->a.angle) + cast->b.lever * fabs(cast->b.angle) - along;
    if (falls <= 0)
        return NARC_CAST_MISS;
    const bool edge_a = contact->feature & NARC_FEATURE_EDGE, edge_b = contact->feature & NARC_FEATURE_EDGE << 8;
    const double rate = edge_a && cast->a.angle != 0 ? cast->a.angle : edge_b ? cast->b.angle : 0;
    double slope;
    const double duration = follow_axis(shapes, cast, contact, gap, rate, falls, &slope), least = gap / falls;
    if (gap <= cast->tolerance && slope <= 0)
        return NARC_CAST_HIT;
    const double next = (double)cast->time + (duration > least ? duration : least);
    if (next > cast->end)
        return NARC_CAST_MISS;
    const float time = round_down(next);
    if (time <= cast->time)
        return NARC_CAST_HIT;
    if (++cast->rounds >= MOST_ROUNDS)
        return gap <= cast->tolerance ? NARC_CAST_HIT : NARC_CAST_UNFINISHED;
    cast->time = time;
    return NARC_CAST_GOES_ON;
}

int narc_advance_cast(const narc_shapes *shapes, narc_cast *cast, const narc_contact *contact) {
    return narc_turns(&cast->a) || narc_turns(&cast->b) ? advance_turn(shapes, cast, contact)
                                                        : advance_line(shapes, cast, contact);
}

/* Cosine and sine of an angle, to some 1e-14: quarter turns and the series of the rest. They are rounded to floats. */
static narc_point find_direction(double angle) {
    if (!(fabs(angle) < 0x1p20)) {
        narc_point direction;
        narc_find_cosine(angle, &direction.x, &direction.y);
        return direction;
    }
    const int quarters = (int)(angle * 0.63661977236758134 + (angle < 0 ? -0.5 : 0.5)); /* 2 / pi */
    const double x = (angle - quarters * 0x1.921fb544p+0) - quarters * 0x1.0b4611a626331p-34, z = x * x;
    const double s =
        x + x * z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880 - z * (1.0 / 39916800)))));
    const double c =
        1 - z * (0.5 - z * (1.0 / 24 - z * (1.0 / 720 - z * (1.0 / 40320 - z * (1.0 / 3628800 - z / 479001600.0)))));
    const narc_point odd = {-s, c}, even = {c, s}, p = quarters & 1 ? odd : even;
    return quarters & 2 ? (narc_point){-p.x, -p.y} : p;
}

void narc_turn_mover(narc_mover *mover, float time) {
    const narc_point direction = find_direction((double)time * mover->angle);
    mover->turned = turn(direction.x, direction.y, mover->rotation);
}
