/* SPDX-License-Identifier: MIT
 *
 * hard_shapes.c - shapes that shortcuts go wrong on.
 */
#include <math.h>
#include <stdlib.h>

#include "hard.h"

/* A little more than the library's least sweep. */
static const double least_sweep = 1.02 * NARC_TOLERANCE;

const char *hard_family_name(enum hard_family family) {
    static const char *const names[HARD_COUNT] = {"corners",   "regular", "stack", "tips",  "long",
                                                  "many arcs", "split",   "sum",   "speck", "away"};
    return names[family];
}

static double wrap(double angle) {
    angle = fmod(angle, 2 * PI);
    return angle < 0 ? angle + 2 * PI : angle;
}

/* Corners at random angles of an ellipse, at least 1/4 of the mean distance apart. */
static struct shape make_corners(struct test_random *random) {
    struct shape shape;
    narc_point point[NARC_MAX_ARCS];
    do {
        const size_t count = 3 + random_below(random, NARC_MAX_ARCS - 2);
        const double flat = random_below(random, 2) ? 1 : random_log_between(random, 0.05, 1);
        for (size_t i = 0; i < count; i++) {
            const double angle = 2 * PI * ((double)i + random_between(random, -0.37, 0.37)) / (double)count;
            point[i] = (narc_point){cos(angle), flat * sin(angle)};
        }
        if (narc_build_polygon(point, count, 0, shape.arcs, &shape.count, NULL) == NARC_OK)
            return shape;
    } while (true);
}

static struct shape make_regular(struct test_random *random) {
    struct shape shape;
    narc_point point[NARC_MAX_ARCS];
    const size_t count = 3 + random_below(random, random_below(random, 2) ? 10 : NARC_MAX_ARCS - 2);
    const double turn = random_below(random, 2) ? 0 : random_between(random, -PI, PI);
    for (size_t i = 0; i < count; i++) {
        const double angle = turn + 2 * PI * (double)i / (double)count;
        point[i] = (narc_point){cos(angle), sin(angle)};
    }
    if (random_below(random, 2) && narc_build_points(point, count, 0, shape.arcs, &shape.count, NULL) == NARC_OK)
        return shape;
    const double radius = random_below(random, 2) ? 0 : cos(PI / (double)count) * random_between(random, 0.01, 0.9);
    assert_int_equal(narc_build_polygon(point, count, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

static double eighths(struct test_random *random) { return 0.125 * (double)(1 + random_below(random, 16)); }

static struct shape make_stack(struct test_random *random) {
    struct shape shape;
    const double width = eighths(random), height = eighths(random);
    const double radius =
        random_below(random, 2) ? 0 : 0.5 * fmin(width, height) / (double)(1 + random_below(random, 4));
    if (random_below(random, 4) == 0)
        assert_int_equal(narc_build_capsule(width, height / 4, shape.arcs, &shape.count, NULL), NARC_OK);
    else
        assert_int_equal(narc_build_box(width, height, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

/* See narc_four_arc: two large arcs that cross at (+-1, 0), their sagitta the half of the lens's thickness. */
static struct shape make_tips(struct test_random *random) {
    struct shape shape;
    do {
        const double sagitta = random_log_between(random, 0.009, 0.7), radius = (1 + sagitta * sagitta) / (2 * sagitta);
        const double tip = sagitta * random_log_between(random, 1e-5, 1e-2);
        const narc_four_arc form = {radius, radius, 2 * (radius - sagitta), tip, random_below(random, 2) ? tip : 0};
        if (narc_build_four_arc(&form, shape.arcs, &shape.count, NULL) == NARC_OK)
            return shape;
    } while (true);
}

static struct shape make_long(struct test_random *random) {
    struct shape shape;
    const double thickness = random_log_between(random, 1e-3, 1e-1);
    if (random_below(random, 2)) {
        assert_int_equal(narc_build_capsule(2, thickness, shape.arcs, &shape.count, NULL), NARC_OK);
    } else {
        const double radius = random_below(random, 2) ? 0 : thickness * random_between(random, 0.01, 0.5);
        assert_int_equal(narc_build_box(2, thickness, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    }
    return shape;
}

/* The family's, as long as it has no edges. */
static struct shape make_many(struct test_random *random) {
    struct shape shape;
    double edges;
    do {
        shape = make_shape(random, FAMILY_MANY);
        edges = 0;
        for (size_t i = 0; i < shape.count; i++) {
            const narc_arc *a = &shape.arcs[i], *b = &shape.arcs[(i + 1) % shape.count];
            edges += hypot(a->center_x - b->center_x + (a->radius - b->radius) * cos(a->end),
                           a->center_y - b->center_y + (a->radius - b->radius) * sin(a->end));
        }
    } while (edges > 1e-9);
    return shape;
}

static struct shape make_split(struct test_random *random) {
    struct shape shape;
    do /* of a segment neither end can be two corners: it would be a polygon without area */
        shape = make_shape(random, (enum family)random_below(random, FAMILY_OFFSET));
    while (shape.count == 2 && shape.arcs[0].radius == 0 && shape.arcs[1].radius == 0);
    size_t splits = 1 + random_below(random, 6);
    if (shape.count == 1) { /* a circle: first into halves */
        const double middle = shape.arcs[0].start + PI;
        shape.arcs[1] = shape.arcs[0];
        shape.arcs[0].end = shape.arcs[1].start = middle;
        shape.count = 2;
    }
    for (; splits > 0 && shape.count < NARC_MAX_ARCS; splits--) {
        const size_t at = random_below(random, shape.count);
        const narc_arc old = shape.arcs[at];
        const double sweep = wrap(old.end - old.start);
        double part =
            random_below(random, 2) ? random_log_between(random, least_sweep, 1e-2) : sweep * random_unit(random);
        part = random_below(random, 2) ? part : sweep - part;
        if (part < least_sweep || sweep - part < least_sweep)
            continue;
        for (size_t i = shape.count; i > at; i--)
            shape.arcs[i] = shape.arcs[i - 1];
        shape.arcs[at].end = shape.arcs[at + 1].start = old.start + part;
        shape.count++;
    }
    return shape;
}

static const narc_arc *find_arc(const struct shape *shape, double angle) {
    for (size_t i = 0; i + 1 < shape->count; i++) {
        const narc_arc *arc = &shape->arcs[i];
        if (wrap(angle - arc->start) < wrap(arc->end - arc->start))
            return arc;
    }
    return &shape->arcs[shape->count - 1];
}

static int compare_angles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The sum of two shapes, the second scaled and turned: in each direction the centres add up, and the radii. False if
 * that is not a shape that the library accepts. */
static bool add_shapes(const struct shape *a, const struct shape *b, double scale, double turn, struct shape *out) {
    double start[2 * NARC_MAX_ARCS];
    size_t count = 0;
    for (size_t i = 0; a->count > 1 && i < a->count; i++)
        start[count++] = wrap(a->arcs[i].start);
    for (size_t i = 0; b->count > 1 && i < b->count; i++)
        start[count++] = wrap(b->arcs[i].start + turn);
    if (count < 2 || count > NARC_MAX_ARCS)
        return false;
    qsort(start, count, sizeof *start, compare_angles);
    out->count = count;
    for (size_t i = 0; i < count; i++) {
        const double end = i + 1 < count ? start[i + 1] : start[0] + 2 * PI, middle = (start[i] + end) / 2;
        const narc_arc *of_a = find_arc(a, middle), *of_b = find_arc(b, middle - turn);
        const double c = scale * cos(turn), s = scale * sin(turn);
        out->arcs[i] = (narc_arc){of_a->center_x + c * of_b->center_x - s * of_b->center_y,
                                  of_a->center_y + s * of_b->center_x + c * of_b->center_y,
                                  of_a->radius + scale * of_b->radius, start[i], end};
    }
    return narc_validate_arcs(out->arcs, count, NULL) == NARC_OK;
}

static struct shape make_sum(struct test_random *random, double least_scale) {
    struct shape sum;
    bool done = false;
    while (!done) {
        const struct shape a = make_shape(random, (enum family)random_below(random, FAMILY_OFFSET));
        const struct shape b = make_shape(random, (enum family)random_below(random, FAMILY_OFFSET));
        const double close = random_log_between(random, least_sweep, 1e-2) * (random_below(random, 2) ? 1 : -1);
        const double meeting =
            a.arcs[random_below(random, a.count)].start - b.arcs[random_below(random, b.count)].start;
        const double turn = random_below(random, 3) ? meeting + close : random_between(random, -PI, PI);
        done = add_shapes(&a, &b, random_log_between(random, least_scale, 1), turn, &sum);
    }
    return sum;
}

static struct shape make_away(struct test_random *random) {
    struct shape shape = make_shape(random, (enum family)random_below(random, FAMILY_OFFSET));
    const double distance = random_log_between(random, 1, 1e4), angle = random_between(random, -PI, PI);
    for (size_t i = 0; i < shape.count; i++) {
        shape.arcs[i].center_x += distance * cos(angle);
        shape.arcs[i].center_y += distance * sin(angle);
    }
    return shape;
}

struct shape make_hard_shape(struct test_random *random, enum hard_family family) {
    switch (family) {
    case HARD_CORNERS:
        return make_corners(random);
    case HARD_REGULAR:
        return make_regular(random);
    case HARD_STACK:
        return make_stack(random);
    case HARD_TIPS:
        return make_tips(random);
    case HARD_LONG:
        return make_long(random);
    case HARD_MANY:
        return make_many(random);
    case HARD_SPLIT:
        return make_split(random);
    case HARD_SUM:
        return make_sum(random, 0.1);
    case HARD_SPECK:
        return make_sum(random, 1e-5);
    default:
        return make_away(random);
    }
}

struct shape make_any_shape(struct test_random *random, size_t family) {
    return family < FAMILY_COUNT ? make_shape(random, (enum family)family)
                                 : make_hard_shape(random, (enum hard_family)(family - FAMILY_COUNT));
}

const char *any_family_name(size_t family) {
    return family < FAMILY_COUNT ? family_name((enum family)family)
                                 : hard_family_name((enum hard_family)(family - FAMILY_COUNT));
}
