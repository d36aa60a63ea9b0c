/* SPDX-License-Identifier: MIT
 *
 * ray_reference.c - rays that are hard to answer, and what is right.
 */
#include "ray_reference.h"

#include <math.h>

#include "narc.h"

/* ------------------------------------------------------------------------------------------------ outline */

struct outline_reference make_outline_reference(const struct shape *shape) {
    struct outline_reference outline = {.count = shape->count, .arcs = shape->arcs};
    for (size_t k = 0; k < shape->count; k++) {
        const narc_arc *const arc = &shape->arcs[k], *const next = &shape->arcs[(k + 1) % shape->count];
        const long double from = arc->start,
                          to = shape->count > 1 ? next->start : arc->end; /* ends may differ a little */
        outline.center_x[k] = arc->center_x;
        outline.center_y[k] = arc->center_y;
        outline.radius[k] = arc->radius;
        outline.start_x[k] = cosl(from);
        outline.start_y[k] = sinl(from);
        outline.end_x[k] = cosl(to);
        outline.end_y[k] = sinl(to);
        outline.extent = fmaxl(outline.extent, hypotl(arc->center_x, arc->center_y) + arc->radius);
    }
    narc_circle bound = {0, 0, 0};
    narc_compute_bounding_circle(shape->arcs, shape->count, &bound);
    outline.is_own = outline.extent < 250 * (long double)bound.radius;
    return outline;
}

/* The largest of n.q over the normals of an arc. */
static long double find_reach(const struct outline_reference *o, size_t k, long double x, long double y) {
    const long double at_start = o->start_x[k] * x + o->start_y[k] * y, at_end = o->end_x[k] * x + o->end_y[k] * y;
    const bool behind_start = o->start_x[k] * y - o->start_y[k] * x >= 0,
               before_end = x * o->end_y[k] - y * o->end_x[k] >= 0;
    return o->count == 1 || (behind_start && before_end) ? sqrtl(x * x + y * y) : fmaxl(at_start, at_end);
}

long double find_signed_distance(const struct outline_reference *o, long double x, long double y) {
    long double distance = -INFINITY;
    for (size_t k = 0; k < o->count; k++)
        distance = fmaxl(distance, find_reach(o, k, x - o->center_x[k], y - o->center_y[k]) - o->radius[k]);
    return distance;
}

/* The support function, by the arc that holds the normal, or nearly does. */
static long double find_support(const struct outline_reference *o, long double x, long double y) {
    long double most = -INFINITY, support = 0;
    for (size_t k = 0; k < o->count; k++) {
        const long double from = o->start_x[k] * y - o->start_y[k] * x, to = x * o->end_y[k] - y * o->end_x[k];
        if (fminl(from, to) > most) {
            most = fminl(from, to);
            support = o->center_x[k] * x + o->center_y[k] * y + o->radius[k];
        }
    }
    return support;
}

/* ------------------------------------------------------------------------------------------------ a ray in the shape */

/* A line in the shape's coordinates: the direction is a unit vector, along it `zero` is where the ray starts, from the
 * place nearest to the bounding circle's centre. */
struct line {
    long double x, y, direction_x, direction_y, start, end, length; /* the latter: of the ray's motion */
};

struct frame {
    long double cosine, sine, scale;
};

static struct frame frame_of(const struct body *body) {
    const long double length = hypotl(body->cosine, body->sine);
    return (struct frame){body->cosine / length, body->sine / length, body->scale};
}

static void turn_back(const struct frame *frame, long double *x, long double *y) {
    const long double a = *x, b = *y;
    *x = (frame->cosine * a + frame->sine * b) / frame->scale;
    *y = (frame->cosine * b - frame->sine * a) / frame->scale;
}

static struct line find_line(const struct outline_reference *o, const struct body *body, const struct test_ray *ray) {
    const struct frame frame = frame_of(body);
    long double x = (long double)ray->x - body->x, y = (long double)ray->y - body->y;
    long double dx = ray->motion_x, dy = ray->motion_y;
    turn_back(&frame, &x, &y);
    turn_back(&frame, &dx, &dy);
    struct line line = {.length = hypotl(dx, dy)};
    line.direction_x = dx / line.length;
    line.direction_y = dy / line.length;
    line.start = (x - o->center_x[0]) * line.direction_x + (y - o->center_y[0]) * line.direction_y;
    line.x = x - line.start * line.direction_x;
    line.y = y - line.start * line.direction_y;
    line.end = line.start + line.length * ray->fraction;
    return line;
}

static long double distance_at(const struct outline_reference *o, const struct line *line, long double along) {
    return find_signed_distance(o, line->x + along * line->direction_x, line->y + along * line->direction_y);
}

/* The least signed distance between two places of a line: golden sections. Beyond two extents nothing is near. */
static long double find_least(const struct outline_reference *o, const struct line *line, long double from,
                              long double to) {
    const long double ratio = 0.61803398874989484820L, reach = 4 * o->extent;
    long double low = fmaxl(from, -reach), high = fminl(to, reach);
    if (low > high)
        return fminl(distance_at(o, line, from), distance_at(o, line, fminl(to, 1e30L)));
    long double left = high - ratio * (high - low), right = low + ratio * (high - low);
    long double at_left = distance_at(o, line, left), at_right = distance_at(o, line, right);
    long double least = fminl(distance_at(o, line, low), distance_at(o, line, high));
    while (high - low > 1e-10L * o->extent) {
        least = fminl(least, fminl(at_left, at_right));
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - ratio * (high - low);
            at_left = distance_at(o, line, left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + ratio * (high - low);
            at_right = distance_at(o, line, right);
        }
    }
    return least;
}

struct ray_truth find_ray_truth(const struct outline_reference *o, const struct body *body,
                                const struct test_ray *ray) {
    const struct line line = find_line(o, body, ray);
    return (struct ray_truth){distance_at(o, &line, line.start), find_least(o, &line, line.start, line.end),
                              NARC_ERROR_BOUND * o->extent};
}

/* ------------------------------------------------------------------------------------------------ is a hit right? */

static void raise(double *worst, long double error) { *worst = fmax(*worst, (double)error); }

/* Does the feature have that radius and normal? */
static const char *check_feature(const struct outline_reference *o, const struct body *body, const narc_ray_hit *hit,
                                 long double nx, long double ny) {
    const unsigned arc = hit->feature & 0x3f;
    const double right = (double)body->scale * (double)o->radius[arc], radius = (double)hit->radius;
    if (arc >= o->count || hit->feature > 0x7f)
        return "no such feature";
    if (hit->feature & NARC_FEATURE_EDGE) {
        const bool along = fabsl(nx * o->start_y[arc] - ny * o->start_x[arc]) < 1e-6L;
        return radius == INFINITY && along ? NULL : "an edge with another normal";
    }
    return fabs(radius - right) <= 1e-6 * right ? NULL : "another radius of curvature";
}

const char *check_ray_hit(const struct outline_reference *o, const struct body *body, const struct test_ray *ray,
                          narc_inside inside, const narc_ray_hit *hit, struct ray_errors *worst) {
    const struct frame frame = frame_of(body);
    const struct line line = find_line(o, body, ray);
    const struct ray_truth truth = find_ray_truth(o, body, ray);
    const long double bound = truth.bound;
    const bool starts_inside = truth.start <= bound, surely_inside = truth.start < -bound;
    if (hit->count == 0) {
        /* Of a ray that goes past all of the body a touch counts, far below the bound, unless the shape is far from its own origin. */
        if (o->is_own && truth.start > bound && line.start < -2 * o->extent && line.end > 2 * o->extent &&
            truth.least < bound / 8)
            return "does not touch";
        if (truth.start > bound && truth.least < -bound) {
            /* It may end where it enters. */
            const long double slack = line.length * ray->fraction * 0x1p-22L + bound;
            return find_least(o, &line, line.start, line.end - slack) < -bound ? "missed" : NULL;
        }
        if (!surely_inside || inside == NARC_INSIDE_IGNORES)
            return NULL;
        if (inside == NARC_INSIDE_STOPS)
            return "missed from inside";
        return distance_at(o, &line, line.end - 0x1p-22L * line.length * ray->fraction) > bound ? "missed the way out"
                                                                                                : NULL;
    }
    long double x = hit->point_x, y = hit->point_y, nx = hit->normal_x, ny = hit->normal_y;
    if (!isfinite(x) || !isfinite(y) || !isfinite(nx) || !isfinite(ny) || !isfinite(hit->fraction) || hit->count != 1 ||
        isnan(hit->radius) || hit->fraction < 0 || hit->fraction > ray->fraction)
        return "not a hit";
    turn_back(&frame, &x, &y);
    if (nx == 0 && ny == 0)
        return inside == NARC_INSIDE_STOPS && starts_inside && hit->fraction == 0 && hit->feature == 0 &&
                       hit->radius == 0
                   ? NULL
                   : "no normal";
    const long double length = hypotl(nx, ny);
    turn_back(&frame, &nx, &ny);
    nx *= frame.scale / length;
    ny *= frame.scale / length;
    const long double along = (x - line.x) * line.direction_x + (y - line.y) * line.direction_y;
    const long double beside = (x - line.x) * line.direction_y - (y - line.y) * line.direction_x;
    const long double off = find_signed_distance(o, x, y);
    const long double to_line = fabsl(nx * x + ny * y - find_support(o, nx, ny));
    raise(&worst->outline, fabsl(off) / bound);
    raise(&worst->ray, fabsl(beside) / bound);
    raise(&worst->normal, to_line / bound);
    if (fabsl(length - 1) > 3e-7L)
        return "not a unit normal";
    if (fabsl(off) > bound)
        return "not on the outline";
    if (fabsl(beside) > bound)
        return "not on the ray";
    if (to_line > bound)
        return "the normal of another place";
    if (along < line.start - bound)
        return "behind the start";
    const long double fraction_error = fabsl((long double)hit->fraction * line.length - (along - line.start));
    if (fraction_error > 0x1p-23L * (along - line.start) + 2 * bound)
        return "another fraction";
    const long double facing = nx * line.direction_x + ny * line.direction_y;
    if (inside == NARC_INSIDE_LEAVES && starts_inside && facing >= 0) {
        if (find_least(o, &line, line.start, along) > bound)
            return "leaves what it is not in";
        if (find_least(o, &line, along, line.end + bound) < -bound)
            return "leaves too early";
    } else {
        const long double before = find_least(o, &line, line.start, along);
        raise(&worst->early, -before / bound);
        if (before < -bound)
            return surely_inside ? "enters from within" : "something before it is inside";
        if (facing > 1e-6L)
            return "enters where it leaves";
    }
    return check_feature(o, body, hit, nx, ny);
}

/* ------------------------------------------------------------------------------------------------ rays */

const char *ray_kind_name(enum ray_kind kind) {
    static const char *const names[RAY_KINDS] = {"any", "tangent", "junction", "point", "edge", "inside"};
    return names[kind];
}

static double nearly_nothing(struct test_random *random, double least, double most) {
    return random_below(random, 4) ? random_log_between(random, least, most) * (random_below(random, 2) ? 1 : -1) : 0;
}

/* A place of the outline, and a direction along it, in the shape's coordinates. */
static void choose_place(struct test_random *random, const struct shape *shape, enum ray_kind kind, double size,
                         double *out_x, double *out_y, double *out_angle) {
    const size_t k = random_below(random, shape->count), before = (k + shape->count - 1) % shape->count;
    const narc_arc *arc = &shape->arcs[k];
    double normal = arc->start, x = arc->center_x, y = arc->center_y, r = arc->radius;
    *out_angle = random_between(random, -PI, PI);
    if (kind == RAY_TANGENT || kind == RAY_INSIDE) {
        const double sweep = fmod(arc->end - arc->start + 4 * PI, 2 * PI);
        normal += random_unit(random) * (shape->count == 1 ? 2 * PI : sweep);
    }
    if (kind == RAY_EDGE) {
        const double part = random_between(random, -0.2, 1.2);
        const narc_arc *from = &shape->arcs[before];
        x += part * (from->center_x - x);
        y += part * (from->center_y - y);
        r += part * (from->radius - r);
    }
    if (kind == RAY_TANGENT || kind == RAY_JUNCTION || kind == RAY_EDGE) {
        const double beside = size * nearly_nothing(random, 1e-9, 1e-3);
        *out_angle = normal + (random_below(random, 2) ? 1 : -1) * PI / 2 + nearly_nothing(random, 1e-9, 1e-2);
        r += beside;
    }
    if (kind == RAY_INSIDE && random_below(random, 4))
        r *= random_between(random, -1, 1);
    *out_x = x + r * cos(normal);
    *out_y = y + r * sin(normal);
    if (kind == RAY_ANY) {
        *out_x = arc->center_x + size * random_between(random, -1.5, 1.5);
        *out_y = arc->center_y + size * random_between(random, -1.5, 1.5);
    }
}

struct test_ray make_ray(struct test_random *random, const struct shape *shape, const struct body *body,
                         narc_precision precision, enum ray_kind kind) {
    const struct frame frame = frame_of(body);
    const double c = (double)frame.cosine, s = (double)frame.sine, scale = (double)body->scale;
    narc_circle bound = {0, 0, 1};
    narc_compute_bounding_circle(shape->arcs, shape->count, &bound);
    double x, y, angle;
    choose_place(random, shape, kind, bound.radius, &x, &y, &angle);
    const double px = body->x + scale * (c * x - s * y), py = body->y + scale * (s * x + c * y);
    const double turned = random_below(random, 8) ? angle + atan2(s, c) : PI / 2 * (double)random_below(random, 4);
    const double size = scale * bound.radius;
    const double away =
        kind == RAY_INSIDE ? 0 : size * random_log_between(random, 1e-2, random_below(random, 3) ? 10 : 1e6);
    const double length = size * random_log_between(random, 1e-2, random_below(random, 3) ? 10 : 1e6);
    struct test_ray ray = {.motion_x = (float)(length * cos(turned)), .motion_y = (float)(length * sin(turned))};
    if (random_below(random, 8) == 0 && fabs(cos(turned)) < 1e-6)
        ray.motion_x = 0;
    if (random_below(random, 8) == 0 && fabs(sin(turned)) < 1e-6)
        ray.motion_y = 0;
    const double unit = hypot((double)ray.motion_x, (double)ray.motion_y);
    ray.x = px - away * (double)ray.motion_x / unit;
    ray.y = py - away * (double)ray.motion_y / unit;
    if (precision == NARC_FLOAT32) {
        ray.x = (double)(float)ray.x;
        ray.y = (double)(float)ray.y;
    }
    const double enough = (away + 2 * size) / unit;
    ray.fraction = (float)(random_below(random, 4) ? enough * 2 : away / unit * random_between(random, 0.5, 1.5));
    return ray;
}

narc_rays view_rays(const struct test_ray *rays, size_t count) {
    return (narc_rays){.count = count,
                       .x = NARC_POSITION_COLUMN(rays, x),
                       .y = NARC_POSITION_COLUMN(rays, y),
                       .motion_x = NARC_COLUMN(rays, motion_x),
                       .motion_y = NARC_COLUMN(rays, motion_y),
                       .fraction = NARC_COLUMN(rays, fraction)};
}
