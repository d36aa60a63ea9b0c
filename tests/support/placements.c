/* SPDX-License-Identifier: MIT
 *
 * placements.c - two bodies put where collision tests go wrong.
 */
#include "placements.h"

#include <math.h>

/* One rounding of a float, relative. */
static const double rounding = 0x1p-24;

const char *placement_name(enum placement placement) {
    static const char *const names[PLACE_COUNT] = {"near",    "deep",     "touch",  "junction", "coincident", "inside",
                                                   "lattice", "parallel", "scaled", "extreme",  "far"};
    return names[placement];
}

static struct body random_pose(struct test_random *random, double scale) {
    return turned_body(random_between(random, -PI, PI), scale);
}

/* A point of a shape in the axes of a pose, but relative to its position. */
static narc_point turn_point(const struct body *body, double x, double y) {
    double c = (double)body->cosine * (double)body->scale, s = (double)body->sine * (double)body->scale;
    return (narc_point){c * x - s * y, s * x + c * y};
}

/* The outline's point where an arc starts. */
static narc_point start_point(const narc_arc *arc, const struct body *body) {
    return turn_point(body, arc->center_x + arc->radius * cos(arc->start),
                      arc->center_y + arc->radius * sin(arc->start));
}

/* A point inside a shape, in the axes of a pose but relative to its position: the mean of the ends of its arcs. */
static narc_point middle_of(const struct shape *shape, const struct body *body) {
    if (shape->count == 1)
        return turn_point(body, shape->arcs[0].center_x, shape->arcs[0].center_y);
    narc_point sum = {0, 0};
    for (size_t i = 0; i < shape->count; i++) {
        narc_point point = start_point(&shape->arcs[i], body);
        sum.x += point.x / (double)shape->count;
        sum.y += point.y / (double)shape->count;
    }
    return sum;
}

/* B moves on a line on which its middle passes A's, so that they do collide somewhere. The separation is a convex
 * function of the way along a line (it is a distance to a convex set, negative inside), so that Newton's method from
 * outside comes down to the wanted value without overshooting. It ends early where the line does not get that deep.
 * */
void place_at_gap(const struct shape *a, const struct shape *b, double direction, double target,
                  const struct body *body_a, struct body *body_b) {
    const int max_steps = 12;
    const double least_slope = 0.02;
    double x = cos(direction), y = sin(direction);
    struct reference_body reference_a = pose_shape(a, body_a), reference_b = pose_shape(b, body_b);
    narc_point from = middle_of(a, body_a), to = middle_of(b, body_b);
    double size = reference_extent(&reference_a) + reference_extent(&reference_b), way = 2 * size + fmax(target, 0);
    for (int step = 0; step < max_steps; step++) {
        reference_b.x = reference_a.x + from.x - to.x + way * x;
        reference_b.y = reference_a.y + from.y - to.y + way * y;
        struct reference_gap found = reference_solve_gap(&reference_a, &reference_b);
        double slope = found.normal_x * x + found.normal_y * y;
        if (slope < least_slope || fabs(found.gap - target) < 1e-3 * rounding * size)
            break;
        way -= (found.gap - target) / slope;
    }
    body_b->x = reference_b.x;
    body_b->y = reference_b.y;
}

/* A junction of A, with its normal, meets a junction of B turned against it (or, half of the time, any other normal
 * of B). */
static void place_on_junction(struct test_random *random, const struct shape *a, const struct shape *b,
                              struct body *body_a, struct body *body_b) {
    narc_arc arc_a = a->arcs[random_below(random, a->count)], arc_b = b->arcs[random_below(random, b->count)];
    if (random_below(random, 2))
        arc_b.start = random_between(random, arc_b.start, arc_b.end < arc_b.start ? arc_b.end + 2 * PI : arc_b.end);
    double angle = random_below(random, 2) ? random_between(random, -PI, PI) : -arc_a.start,
           normal = angle + arc_a.start;
    double gap =
        random_below(random, 2) ? random_between(random, -0.2, 0.2) : rounding * random_between(random, -40, 40);
    *body_a = turned_body(angle, 1);
    *body_b = turned_body(normal + PI - arc_b.start, 1);
    narc_point from = start_point(&arc_a, body_a), to = start_point(&arc_b, body_b);
    body_b->x = from.x - to.x + gap * cos(normal);
    body_b->y = from.y - to.y + gap * sin(normal);
}

static struct body right_angle(struct test_random *random) {
    static const float cosines[4] = {1, 0, -1, 0};
    size_t quarter = random_below(random, 4);
    return (struct body){.cosine = cosines[quarter], .sine = cosines[(quarter + 3) % 4], .scale = 1};
}

static void place_on_lattice(struct test_random *random, struct body *body_a, struct body *body_b) {
    *body_a = right_angle(random);
    *body_b = right_angle(random);
    body_a->x = ((double)random_below(random, 33) - 16) / 16;
    body_a->y = ((double)random_below(random, 33) - 16) / 16;
    body_b->x = body_a->x + ((double)random_below(random, 65) - 32) / 16;
    body_b->y = body_a->y + ((double)random_below(random, 65) - 32) / 16;
}

/* A turn so small that the cosine stays what it is. */
static void tilt(struct test_random *random, struct body *body) {
    float angle = (float)(rounding * random_between(random, -8, 8));
    if (body->cosine != 0.0f)
        body->sine = angle;
    else
        body->cosine = angle;
}

static void place_near(struct test_random *random, const struct shape *a, const struct shape *b, double scale_a,
                       double scale_b, double target, struct body *body_a, struct body *body_b) {
    *body_a = random_pose(random, scale_a);
    *body_b = random_pose(random, scale_b);
    place_at_gap(a, b, random_between(random, -PI, PI), target, body_a, body_b);
}

void place_pair(struct test_random *random, enum placement placement, narc_precision precision, const struct shape *a,
                const struct shape *b, struct body *out_a, struct body *out_b) {
    double scale, ratio, angle;
    struct reference_body at_a, at_b;
    switch (placement) {
    case PLACE_TOUCH:
        *out_a = random_pose(random, 1);
        *out_b = random_pose(random, 1);
        angle = random_between(random, -PI, PI);
        place_at_gap(a, b, angle, 0, out_a, out_b);
        at_a = pose_shape(a, out_a);
        at_b = pose_shape(b, out_b);
        place_at_gap(a, b, angle, rounding * random_between(random, -40, 40) * reference_reach(&at_a, &at_b), out_a,
                     out_b);
        break;
    case PLACE_DEEP:
        *out_a = random_pose(random, 1);
        *out_b = random_pose(random, 1);
        out_b->x = random_between(random, -0.7, 0.7);
        out_b->y = random_between(random, -0.7, 0.7);
        break;
    case PLACE_JUNCTION:
        place_on_junction(random, a, b, out_a, out_b);
        break;
    case PLACE_COINCIDENT:
        *out_a = random_pose(random, 1);
        *out_b = random_below(random, 4) ? *out_a : random_pose(random, 1);
        break;
    case PLACE_INSIDE:
        *out_a = random_pose(random, 1);
        *out_b = random_pose(random, random_between(random, 0.02, 0.3));
        out_b->x = random_between(random, -0.3, 0.3);
        out_b->y = random_between(random, -0.3, 0.3);
        break;
    case PLACE_LATTICE:
        place_on_lattice(random, out_a, out_b);
        break;
    case PLACE_PARALLEL:
        place_on_lattice(random, out_a, out_b);
        tilt(random, random_below(random, 2) ? out_a : out_b);
        break;
    case PLACE_SCALED:
    case PLACE_EXTREME:
        scale = placement == PLACE_SCALED ? random_log_between(random, 1e-3, 1e3)
                : random_below(random, 2) ? 1e8
                                          : 5e-8;
        ratio = placement == PLACE_SCALED ? random_log_between(random, 0.05, 20) : 1;
        place_near(random, a, b, scale, scale * ratio, scale * fmin(1, ratio) * random_between(random, -0.5, 0.5),
                   out_a, out_b);
        break;
    default:
        place_near(random, a, b, 1, 1, random_between(random, -0.5, 0.5), out_a, out_b);
        break;
    }
    /* Not only at the origin. */
    double distance = placement == PLACE_FAR ? (precision == NARC_FLOAT32 ? 1e4 : 1e7) : 0;
    if (placement == PLACE_NEAR || placement == PLACE_DEEP || placement == PLACE_COINCIDENT)
        distance = random_between(random, 0, 2);
    angle = random_between(random, -PI, PI);
    out_a->x += distance * cos(angle);
    out_a->y += distance * sin(angle);
    out_b->x += distance * cos(angle);
    out_b->y += distance * sin(angle);
    round_position(out_a, precision);
    round_position(out_b, precision);
}

void scene_add_placed(struct test_random *random, struct scene *scene, enum placement placement, uint32_t shape_a,
                      uint32_t shape_b) {
    struct body a, b;
    place_pair(random, placement, scene->precision, &scene->shapes[shape_a], &scene->shapes[shape_b], &a, &b);
    a.shape = shape_a;
    b.shape = shape_b;
    scene_add_two(scene, a, b);
}

struct scene make_placed_scene(struct test_random *random, narc_precision precision, enum family a, enum family b,
                               size_t count) {
    enum { SHAPES_PER_FAMILY = 5 };
    struct scene scene = create_scene(precision, 2 * SHAPES_PER_FAMILY, 2 * count, count);
    for (size_t k = 0; k < 2 * SHAPES_PER_FAMILY; k++) {
        const struct shape shape = make_shape(random, k % 2 ? b : a);
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < count; k++) {
        const uint32_t of_a = 2 * (uint32_t)random_below(random, SHAPES_PER_FAMILY);
        const uint32_t of_b = 2 * (uint32_t)random_below(random, SHAPES_PER_FAMILY) + 1;
        const bool itself = a == b && random_below(random, 3) == 0;
        scene_add_placed(random, &scene, (enum placement)(k % PLACE_COUNT), of_a, itself ? of_a : of_b);
    }
    return scene;
}
