/* SPDX-License-Identifier: MIT
 *
 * hard_places.c - places that shortcuts go wrong on.
 */
#include <math.h>

#include "hard.h"

const char *hard_placement_name(enum hard_placement placement) {
    static const char *const names[HARD_PLACES] = {"touch", "junction", "aligned", "concentric"};
    return names[placement];
}

/* 0, then both signs of a geometric series from `least` up. */
static double series_item(size_t k, double least, double ratio) {
    return k == 0 ? 0 : (k % 2 ? 1 : -1) * least * pow(ratio, (double)((k - 1) / 2));
}

/* An angle that is nothing, or nearly. */
static double nearly_nothing(struct test_random *random) {
    return random_below(random, 3) ? series_item(1 + random_below(random, 2), random_log_between(random, 1e-8, 1e-3), 1)
                                   : 0;
}

static void choose_scales(struct test_random *random, double *out_a, double *out_b) {
    const size_t kind = random_below(random, 4);
    const double ratio = kind >= 2 ? random_log_between(random, 1e-4, 1e4) : 1;
    const double common = kind == 3 ? random_log_between(random, 1e-4, 1e4) : 1;
    *out_a = common * fmin(1, 1 / ratio);
    *out_b = common * fmin(1, ratio);
}

/* As long as the kernels take it. The places are those of the rotation without it. */
static void drift(struct test_random *random, struct body *body) {
    const float factor = (float)(1 + 0.498 * NARC_ROTATION_TOLERANCE * random_between(random, -1, 1));
    body->cosine *= factor;
    body->sine *= factor;
}

/* The point of a body that lies furthest along a normal, relative to the body's position. */
static narc_point support_point(const struct scene *scene, const struct body *body, double angle) {
    const struct shape *shape = &scene->shapes[body->shape];
    const double c = (double)body->cosine, s = (double)body->sine, x = cos(angle), y = sin(angle);
    narc_point p;
    assert_true(narc_find_support(shape->arcs, shape->count, c * x + s * y, c * y - s * x, &p, NULL));
    return (narc_point){(double)body->scale * (c * p.x - s * p.y), (double)body->scale * (s * p.x + c * p.y)};
}

/* A point well inside a body, relative to its position. */
static narc_point middle_of(const struct scene *scene, const struct body *body) {
    narc_point sum = {0, 0};
    for (int k = 0; k < 4; k++) {
        const narc_point p = support_point(scene, body, 0.5 + PI / 2 * k);
        sum.x += p.x / 4;
        sum.y += p.y / 4;
    }
    return sum;
}

/* A world for one call of add_hard_pairs(). */
struct place {
    struct test_random *random;
    struct scene *scene;
    struct body a, b; /* b: shape, rotation and scale, and a position relative to a's */
    double size;      /* the larger scale */
    double x, y;      /* where all of it is */
    bool drifted;
};

static void add_pair(struct place *place) {
    struct body a = place->a, b = place->b;
    a.x = place->x;
    a.y = place->y;
    b.x += place->x;
    b.y += place->y;
    if (place->drifted) {
        drift(place->random, &a);
        drift(place->random, &b);
    }
    scene_add_two(place->scene, a, b);
}

/* The support points across a normal meet, but for a gap and a shift along the tangent. */
static void meet(struct place *place, double normal, double gap, double shift) {
    const narc_point from = support_point(place->scene, &place->a, normal);
    const narc_point to = support_point(place->scene, &place->b, normal + PI);
    place->b.x = from.x - to.x + gap * cos(normal) - shift * sin(normal);
    place->b.y = from.y - to.y + gap * sin(normal) + shift * cos(normal);
}

static void turn(struct body *body, double angle) {
    body->cosine = (float)cos(angle);
    body->sine = (float)sin(angle);
}

static double junction_of(const struct place *place, const struct body *body) {
    const struct shape *shape = &place->scene->shapes[body->shape];
    return shape->arcs[random_below(place->random, shape->count)].start;
}

/* Apart at first, B moves along the normal, which is that of the touch, too. */
static void add_touches(struct place *place) {
    struct test_random *random = place->random;
    turn(&place->a, random_between(random, -PI, PI));
    turn(&place->b, random_between(random, -PI, PI));
    meet(place, random_between(random, -PI, PI), place->size * random_log_between(random, 1e-3, 3), 0);
    struct reference_body a = pose_shape(&place->scene->shapes[place->a.shape], &place->a);
    struct reference_body b = pose_shape(&place->scene->shapes[place->b.shape], &place->b);
    a.x = a.y = 0;
    const struct reference_gap found = reference_solve_gap(&a, &b);
    for (size_t k = 0; k < HARD_BODIES / 2 - 5; k++) {
        const double way = place->size * series_item(k, 1e-8, 3.0) - found.gap;
        place->b.x = b.x + way * found.normal_x;
        place->b.y = b.y + way * found.normal_y;
        add_pair(place);
    }
}

static void add_junctions(struct place *place) {
    struct test_random *random = place->random;
    const bool of_both = random_below(random, 4) != 0, quarter = random_below(random, 4) == 0;
    const double start_a = junction_of(place, &place->a), start_b = junction_of(place, &place->b);
    /* With the normal along an axis of A, or a quarter turn between the bodies, many roundings vanish. */
    const double normal = quarter ? start_a : random_between(random, -PI, PI);
    for (size_t k = 0; k < HARD_BODIES / 2 - 5; k++) {
        const double gaps[] = {0, 1e-7, 1e-6, 1e-5, 1e-3, 0.1, 0.4};
        const double gap = gaps[random_below(random, sizeof gaps / sizeof *gaps)] * (random_below(random, 2) ? 1 : -1);
        double beside = of_both ? nearly_nothing(random) : random_between(random, -PI, PI);
        if (of_both && random_below(random, 4) == 0)
            beside = random_log_between(random, 1e-4, 0.05) * (random_below(random, 2) ? 1 : -1);
        const double shift = random_below(random, 2) ? 0 : random_between(random, -0.5, 0.5);
        turn(&place->a, normal - start_a + series_item(k, 1e-8, 3));
        turn(&place->b, normal + PI - start_b + beside);
        meet(place, normal, place->size * gap, fmin((double)place->a.scale, (double)place->b.scale) * shift);
        add_pair(place);
    }
}

static void add_aligned(struct place *place) {
    struct test_random *random = place->random;
    for (size_t k = 0; k < HARD_BODIES / 2 - 5; k++) {
        const double angle = random_below(random, 4) ? random_between(random, -PI, PI) : 0;
        turn(&place->a, angle);
        turn(&place->b,
             angle + junction_of(place, &place->a) + PI - junction_of(place, &place->b) + series_item(k, 1e-8, 3));
        const narc_point from = middle_of(place->scene, &place->a), to = middle_of(place->scene, &place->b);
        place->b.x = from.x - to.x + place->size * random_between(random, -0.8, 0.8);
        place->b.y = from.y - to.y + place->size * random_between(random, -0.8, 0.8);
        add_pair(place);
    }
}

static void add_concentric(struct place *place) {
    struct test_random *random = place->random;
    for (size_t k = 0; k < HARD_BODIES / 2 - 5; k++) {
        const double angle = random_below(random, 4) ? random_between(random, -PI, PI) : 0;
        const double between =
            random_below(random, 2) ? PI / 2 * (double)random_below(random, 4) : random_between(random, -PI, PI);
        const double direction =
            random_below(random, 2) ? PI / 2 * (double)random_below(random, 4) : random_between(random, -PI, PI);
        turn(&place->a, angle);
        turn(&place->b, angle + between + nearly_nothing(random));
        const narc_point from = middle_of(place->scene, &place->a), to = middle_of(place->scene, &place->b);
        const double way = place->size * series_item(k, 1e-8, 4);
        place->b.x = from.x - to.x + way * cos(direction);
        place->b.y = from.y - to.y + way * sin(direction);
        add_pair(place);
    }
}

void add_hard_pairs(struct test_random *random, struct scene *scene, enum hard_placement placement, uint32_t shape_a,
                    uint32_t shape_b) {
    double scale_a, scale_b;
    choose_scales(random, &scale_a, &scale_b);
    struct place place = {.random = random, .scene = scene, .size = fmax(scale_a, scale_b)};
    place.a = turned_body(0, scale_a);
    place.b = turned_body(0, scale_b);
    place.a.shape = shape_a;
    place.b.shape = shape_b;
    place.drifted = random_below(random, 4) == 0;
    if (random_below(random, 2)) {
        const double far = place.size * (scene->precision == NARC_FLOAT64 ? 1e7 : 1e2);
        place.x = far * random_between(random, -1, 1);
        place.y = far * random_between(random, -1, 1);
    }
    switch (placement) {
    case HARD_TOUCH:
        add_touches(&place);
        break;
    case HARD_JUNCTION:
        add_junctions(&place);
        break;
    case HARD_ALIGNED:
        add_aligned(&place);
        break;
    default:
        add_concentric(&place);
        break;
    }
}

/* A shape of the given size, `shift` away from its origin. */
static struct shape move_away(struct test_random *random, struct shape shape, double size, double shift) {
    narc_circle bound;
    assert_true(narc_compute_bounding_circle(shape.arcs, shape.count, &bound));
    const double angle = random_between(random, -PI, PI), factor = size / bound.radius;
    for (size_t i = 0; i < shape.count; i++) {
        narc_arc *arc = &shape.arcs[i];
        arc->center_x = (arc->center_x - bound.x) * factor + shift * cos(angle);
        arc->center_y = (arc->center_y - bound.y) * factor + shift * sin(angle);
        arc->radius *= factor;
    }
    return shape;
}

/* Adds a body somewhere within `reach` of the world's origin, seen from the middle of its shape. */
static uint32_t add_near_origin(struct test_random *random, struct scene *scene, uint32_t shape, double reach) {
    struct body body = turned_body(random_below(random, 2) ? 0 : random_between(random, -PI, PI), 1);
    const double c = (double)body.cosine, s = (double)body.sine;
    narc_circle bound;
    assert_true(narc_compute_bounding_circle(scene->shapes[shape].arcs, scene->shapes[shape].count, &bound));
    body.x = reach * random_between(random, -1, 1) - (c * bound.x - s * bound.y);
    body.y = reach * random_between(random, -1, 1) - (s * bound.x + c * bound.y);
    body.shape = shape;
    return scene_add_body(scene, body);
}

struct scene make_far_scene(struct test_random *random, int decade) {
    enum { SHAPES = 40, PAIRS = 4000 };
    const double size = 1.000001 * fmin(1, pow(10, 9 - decade)), shift = fmin(pow(10, decade), 0.999999e9);
    struct scene scene = create_scene(NARC_FLOAT64, SHAPES, 2 * PAIRS, PAIRS);
    for (size_t k = 0; k < SHAPES; k++) {
        const bool joins = decade < 10 || k % 2;
        const struct shape shape =
            make_any_shape(random, joins ? random_below(random, ALL_FAMILIES - 1) : FAMILY_CIRCLE);
        const struct shape moved = move_away(random, shape, size, k % 2 ? 0 : shift);
        scene_add_shape(&scene, &moved);
    }
    for (size_t k = 0; k < PAIRS; k++) {
        const double reach = size * random_log_between(random, 0.1, 2);
        const uint32_t first = add_near_origin(random, &scene, (uint32_t)random_below(random, SHAPES), reach);
        scene_add_pair(&scene, first, add_near_origin(random, &scene, (uint32_t)random_below(random, SHAPES), reach));
    }
    return scene;
}
