/* SPDX-License-Identifier: MIT
 *
 * families.c - random shapes. Most come from random end normals, radii and edge lengths, made to close.
 */
#include "families.h"

#include <math.h>
#include <string.h>

/* Flatter arcs are refused by the library (NARC_MAX_RADIUS_RATIO); this leaves room for a bounding circle that is only
 * estimated here. */
static const double max_radius_ratio = 32.0;

/* An arc list still without places: arc i covers the normals from start[i] to start[i + 1], an edge of length[i] with
 * the normal start[i] comes before it. */
struct outline {
    size_t count;
    double start[NARC_MAX_ARCS];
    double radius[NARC_MAX_ARCS];
    double length[NARC_MAX_ARCS];
};

static double end_of(const struct outline *outline, size_t i) {
    return i + 1 < outline->count ? outline->start[i + 1] : outline->start[0] + 2 * PI;
}

/* Random end normals. Each lies in its own part of the turn, `spread` (0 .. 1) of that part wide; no sweep is above
 * pi or so small that its ends could be mistaken for one. */
static void choose_normals(struct test_random *random, struct outline *outline, size_t count, double spread) {
    const double least_sweep = 0.01;
    double origin = random_between(random, -PI, PI);
    bool valid;
    outline->count = count;
    do {
        valid = true;
        for (size_t i = 0; i < count; i++) {
            double jitter = spread * (random_unit(random) - 0.5);
            outline->start[i] = origin + 2 * PI * ((double)i + jitter) / (double)count;
        }
        for (size_t i = 0; i < count; i++) {
            double sweep = end_of(outline, i) - outline->start[i];
            valid = valid && sweep >= least_sweep && sweep < PI;
        }
    } while (!valid);
}

/* Going around, arc i moves the outline by radius[i] * (end normal - start normal), an edge along its normal turned
 * left. The moves must add up to nothing. The change that achieves it and is least in proportion to each value: with
 * the moves as columns of a 2-row matrix M, values x and W = diag(x^2), it is -W M' (M W M')^-1 M x. Zeros stay zero.
 * False if something would get negative. */
static bool close_outline(struct outline *outline) {
    double move_x[2 * NARC_MAX_ARCS], move_y[2 * NARC_MAX_ARCS], *value[2 * NARC_MAX_ARCS];
    double sum_x = 0, sum_y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < outline->count; i++) {
        double start = outline->start[i], end = end_of(outline, i);
        move_x[2 * i] = cos(end) - cos(start);
        move_y[2 * i] = sin(end) - sin(start);
        value[2 * i] = &outline->radius[i];
        move_x[2 * i + 1] = -sin(start);
        move_y[2 * i + 1] = cos(start);
        value[2 * i + 1] = &outline->length[i];
    }
    for (size_t k = 0; k < 2 * outline->count; k++) {
        double weight = *value[k] * *value[k];
        sum_x += *value[k] * move_x[k];
        sum_y += *value[k] * move_y[k];
        xx += weight * move_x[k] * move_x[k];
        xy += weight * move_x[k] * move_y[k];
        yy += weight * move_y[k] * move_y[k];
    }
    double determinant = xx * yy - xy * xy;
    if (determinant <= 1e-9 * xx * yy)
        return false;
    double lambda_x = (yy * sum_x - xy * sum_y) / determinant, lambda_y = (xx * sum_y - xy * sum_x) / determinant;
    for (size_t k = 0; k < 2 * outline->count; k++) {
        double old = *value[k];
        *value[k] = old - old * old * (move_x[k] * lambda_x + move_y[k] * lambda_y);
        if (old > 0 && *value[k] < 0.01 * old)
            return false;
    }
    return true;
}

static void move_shape(struct shape *shape, double x, double y) {
    for (size_t i = 0; i < shape->count; i++) {
        shape->arcs[i].center_x += x;
        shape->arcs[i].center_y += y;
    }
}

/* Walks along the outline; then moves the mean of the corners to the origin and makes the largest distance from it 1.
 * False if an arc is too flat for that size. */
static bool place_outline(const struct outline *outline, struct shape *shape) {
    double x = 0, y = 0, mean_x = 0, mean_y = 0, size = 0, max_radius = 0;
    double corner_x[NARC_MAX_ARCS], corner_y[NARC_MAX_ARCS];
    shape->count = outline->count;
    for (size_t i = 0; i < outline->count; i++) {
        double start = outline->start[i], end = end_of(outline, i), radius = outline->radius[i];
        x -= sin(start) * outline->length[i];
        y += cos(start) * outline->length[i];
        corner_x[i] = x;
        corner_y[i] = y;
        mean_x += x / (double)outline->count;
        mean_y += y / (double)outline->count;
        shape->arcs[i] = (narc_arc){x - radius * cos(start), y - radius * sin(start), radius, start, end};
        x += radius * (cos(end) - cos(start));
        y += radius * (sin(end) - sin(start));
    }
    move_shape(shape, -mean_x, -mean_y);
    for (size_t i = 0; i < shape->count; i++) {
        size = fmax(size, hypot(corner_x[i] - mean_x, corner_y[i] - mean_y));
        max_radius = fmax(max_radius, shape->arcs[i].radius);
    }
    for (size_t i = 0; i < shape->count; i++) {
        shape->arcs[i].center_x /= size;
        shape->arcs[i].center_y /= size;
        shape->arcs[i].radius /= size;
    }
    return max_radius <= max_radius_ratio * size;
}

/* Arcs with radii and edges with lengths between low and 1, either of them zero with its own probability. */
struct recipe {
    size_t count;
    double spread;
    double radius_low, radius_zero;
    double length_low, length_zero;
};

static struct shape make_outline(struct test_random *random, struct recipe recipe) {
    struct outline outline;
    struct shape shape;
    do {
        do {
            choose_normals(random, &outline, recipe.count, recipe.spread);
            for (size_t i = 0; i < recipe.count; i++) {
                bool sharp = random_unit(random) < recipe.radius_zero,
                     joined = random_unit(random) < recipe.length_zero;
                outline.radius[i] = sharp ? 0 : random_log_between(random, recipe.radius_low, 1);
                outline.length[i] = joined ? 0 : random_log_between(random, recipe.length_low, 1);
            }
        } while (!close_outline(&outline));
    } while (!place_outline(&outline, &shape));
    return shape;
}

static void require_ok(narc_status status, const narc_error *error) {
    if (status != NARC_OK)
        fail_msg("a builder refused a valid shape: %s", error->message);
}

struct shape circle_of(double radius) {
    struct shape shape;
    narc_error error;
    require_ok(narc_build_circle(radius, shape.arcs, &shape.count, &error), &error);
    return shape;
}

struct shape box_of(double width, double height, double radius) {
    struct shape shape;
    narc_error error;
    require_ok(narc_build_box(width, height, radius, shape.arcs, &shape.count, &error), &error);
    return shape;
}

struct shape capsule_of(double length, double radius) {
    struct shape shape;
    narc_error error;
    require_ok(narc_build_capsule(length, radius, shape.arcs, &shape.count, &error), &error);
    return shape;
}

narc_shapes *empty_store(void) {
    narc_shapes *store = NULL;
    assert_int_equal(narc_create_shapes(NULL, &store), NARC_OK);
    return store;
}

uint32_t store_shape(narc_shapes *store, struct shape shape) {
    uint32_t index = UINT32_MAX;
    narc_error error;
    require_ok(narc_add_shape(store, shape.arcs, shape.count, &index, &error), &error);
    return index;
}

static struct shape make_box(struct test_random *random, double width, double height) {
    return box_of(width, height, random_below(random, 3) ? 0 : fmin(width, height) * random_between(random, 0.0, 0.5));
}

static struct shape make_capsule(struct test_random *random, double thinnest) {
    const double length = random_below(random, 8) ? random_between(random, 0.5, 2) : 0;
    return capsule_of(length, length > 0 ? length * random_log_between(random, thinnest, 1) : 1);
}

static struct shape make_circle(struct test_random *random) {
    return circle_of(random_below(random, 2) ? random_log_between(random, 0.1, 2)
                                             : 0.125 * (double)(1 + random_below(random, 8)));
}

/* Half as wide as 1 and `flatness` thick: two large arcs of radius R that cross, the sagitta of each is `flatness` /
 * 2. */
static struct shape make_lens(struct test_random *random) {
    struct shape shape;
    narc_error error;
    double sagitta = random_log_between(random, 0.02, 0.5), radius = (1 + sagitta * sagitta) / (2 * sagitta);
    bool equal = random_below(random, 2), sharp = random_below(random, 3) == 0;
    double other = equal ? radius : fmin(radius * random_between(random, 0.7, 1.4), max_radius_ratio);
    double tip = sharp ? 0 : sagitta * random_log_between(random, 0.02, 0.6);
    /* Thickness radius + other - distance, that of the lens with equal arcs. */
    narc_four_arc form = {radius, other, radius + other - 2 * sagitta, tip, random_below(random, 2) ? tip : tip / 2};
    require_ok(narc_build_four_arc(&form, shape.arcs, &shape.count, &error), &error);
    return shape;
}

/* Two tips with nearly all of the turn, and between them flat arcs. */
static struct shape make_thin_smooth(struct test_random *random) {
    struct outline outline;
    struct shape shape;
    size_t side = 1 + random_below(random, 3);
    do {
        do {
            double flat = random_log_between(random, 0.05, 0.4);
            outline.count = 2 * side + 2;
            for (size_t half = 0; half < 2; half++) {
                double middle = PI * ((double)half + 0.5);
                for (size_t k = 0; k <= side; k++) {
                    size_t i = half * (side + 1) + k;
                    outline.start[i] = middle + flat * ((double)k / (double)side - 0.5);
                    outline.radius[i] =
                        k < side ? random_between(random, 0.3, 1) / flat : random_log_between(random, 0.01, 0.1);
                    outline.length[i] = 0;
                }
            }
        } while (!close_outline(&outline));
    } while (!place_outline(&outline, &shape));
    return shape;
}

static struct shape make_thin(struct test_random *random) {
    switch (random_below(random, 3)) {
    case 0:
        return make_box(random, 2, 2 * random_log_between(random, 0.01, 0.1));
    case 1:
        return make_capsule(random, 0.01);
    default:
        return make_thin_smooth(random);
    }
}

/* A slice of the unit disc left of a vertical line: half a disc, or less. */
static struct shape make_half(struct test_random *random) {
    double half = random_below(random, 2) ? PI / 2 : random_between(random, 0.3, PI / 2);
    double x = -cos(half), y = sin(half);
    if (half == PI / 2)
        x = 0;
    struct shape shape = {
        .count = 3,
        .arcs = {{x, -y, 0, PI + half - 2 * PI, 0}, {x, y, 0, 0, PI - half}, {0, 0, 1, PI - half, PI + half}}};
    return shape;
}

/* A star-shaped polygon, adjusted by the library until an n-arc goes through its corners. */
static struct shape make_fitted(struct test_random *random) {
    narc_point polygon[16], junctions[16];
    struct shape shape;
    for (;;) {
        size_t count = 3 + random_below(random, 14);
        for (size_t i = 0; i < count; i++) {
            double angle = 2 * PI * ((double)i + random_between(random, -0.3, 0.3)) / (double)count;
            double distance = random_between(random, 0.5, 1);
            polygon[i] = (narc_point){distance * cos(angle), distance * sin(angle)};
        }
        if (narc_adjust_polygon(polygon, count, junctions, NULL) == NARC_OK &&
            narc_build_points(junctions, count, 0, shape.arcs, &shape.count, NULL) == NARC_OK)
            return shape;
    }
}

/* Along x, along y, or anywhere; its middle is not always its origin. */
static struct shape make_segment(struct test_random *random) {
    struct shape shape;
    narc_error error;
    const double angle =
        random_below(random, 3) ? random_between(random, -PI, PI) : PI / 2 * (double)random_below(random, 4);
    const double half = random_between(random, 0.25, 1),
                 part = random_below(random, 2) ? 1 : random_between(random, 0.2, 1);
    const double x = random_below(random, 3) ? half * cos(angle) : half, y = x == half ? 0 : half * sin(angle);
    require_ok(narc_build_segment(&(narc_point){-x * part, -y * part}, &(narc_point){x, y}, 0, shape.arcs, &shape.count,
                                  &error),
               &error);
    return shape;
}

const char *family_name(enum family family) {
    static const char *const names[FAMILY_COUNT] = {"smooth", "unequal", "thin",    "lens",    "polygon",
                                                    "box",    "capsule", "rounded", "circle",  "half",
                                                    "mixed",  "fitted",  "many",    "segment", "offset"};
    return names[family];
}

struct shape make_shape(struct test_random *random, enum family family) {
    struct shape shape;
    switch (family) {
    case FAMILY_SMOOTH:
        return make_outline(random, (struct recipe){3 + random_below(random, 14), 0.9, 0.2, 0, 1, 1});
    case FAMILY_UNEQUAL:
        return make_outline(random, (struct recipe){4 + random_below(random, 9), 0.9, 0.001, 0, 1, 1});
    case FAMILY_THIN:
        return make_thin(random);
    case FAMILY_LENS:
        return make_lens(random);
    case FAMILY_POLYGON:
        return make_outline(random, (struct recipe){3 + random_below(random, 10), 0.9, 1, 1, 0.1, 0});
    case FAMILY_BOX:
        return random_below(random, 2)
                   ? make_box(random, 0.125 * (double)(1 + random_below(random, 16)),
                              0.125 * (double)(1 + random_below(random, 16)))
                   : make_box(random, random_between(random, 0.1, 2), random_between(random, 0.1, 2));
    case FAMILY_CAPSULE:
        return make_capsule(random, 0.1);
    case FAMILY_ROUNDED:
        return make_outline(random, (struct recipe){3 + random_below(random, 10), 0.9, 0.02, 0, 0.1, 0});
    case FAMILY_CIRCLE:
        return make_circle(random);
    case FAMILY_HALF:
        return make_half(random);
    case FAMILY_MIXED:
        return make_outline(random, (struct recipe){3 + random_below(random, 14), 0.9, 0.05, 0.3, 0.05, 0.5});
    case FAMILY_FITTED:
        return make_fitted(random);
    case FAMILY_MANY:
        return make_outline(random, (struct recipe){17 + random_below(random, 48), 0.7, 0.1, 0.2, 0.1,
                                                    random_below(random, 2) ? 0.5 : 1});
    case FAMILY_SEGMENT:
        return make_segment(random);
    default:
        shape = make_shape(random, (enum family)random_below(random, FAMILY_OFFSET));
        move_shape(&shape, random_between(random, -3, 3), random_between(random, -3, 3));
        return shape;
    }
}
