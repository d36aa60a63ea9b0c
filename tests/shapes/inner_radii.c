/* SPDX-License-Identifier: MIT
 *
 * inner_radii.c - the two radii that the store keeps of each arc: what they promise holds, and they are hardly less
 * than they could be.
 */
#include <math.h>
#include <string.h>

#include "families.h"
#include "hard.h"
#include "oracle.h"
#include "store.h"
#include "tests.h"

/* Half a float has 8 digits, of which rounding down takes the last. */
static const double half_precision = 1.0 / 128;

/* Where an arc's circle may seem to leave the shape: rounding, of large radii above all. */
static const double room = 1e-10;

static double sweep_of(const narc_arc *arc) {
    const double sweep = fmod(arc->end - arc->start, 2 * PI);
    return sweep > 0 ? sweep : sweep + 2 * PI;
}

static double least_sweep(const struct shape *shape) {
    double least = 2 * PI;
    for (size_t i = 0; i < shape->count; i++)
        least = fmin(least, sweep_of(&shape->arcs[i]));
    return least;
}

/* The angle between the nearest directions of two arcs, 0 if they have one in common. */
static double angle_between(const narc_arc *a, const narc_arc *b) {
    const double from_a = sweep_of(&(narc_arc){.start = a->start, .end = b->start});
    const double from_b = sweep_of(&(narc_arc){.start = b->start, .end = a->start});
    return fmax(0, fmin(from_a - sweep_of(a), from_b - sweep_of(b)));
}

/* The least radius of the arcs with a direction within an angle of one of this arc's. */
static double least_radius(const struct shape *shape, size_t arc, double angle) {
    double least = shape->arcs[arc].radius;
    for (size_t i = 0; i < shape->count; i++)
        if (angle_between(&shape->arcs[arc], &shape->arcs[i]) <= angle)
            least = fmin(least, shape->arcs[i].radius);
    return least;
}

/* By how much the circle that touches an arc from inside, at an angle, leaves the shape; 0 or less if it does not. */
static double excess_of(const struct shape *shape, const narc_arc *arc, double angle, double radius) {
    const double way = arc->radius - radius;
    const narc_point center = {arc->center_x + way * cos(angle), arc->center_y + way * sin(angle)};
    return oracle_distance(shape->arcs, shape->count, center) + radius;
}

/* The largest radius, up to a limit, with which it does not: such circles lie in each other. */
static double largest_circle(const struct shape *shape, const narc_arc *arc, double angle, double limit, double slack) {
    double low = 0, high = limit;
    if (excess_of(shape, arc, angle, limit) <= slack)
        return limit;
    for (int step = 0; step < 30; step++) {
        const double middle = (low + high) / 2;
        *(excess_of(shape, arc, angle, middle) <= slack ? &low : &high) = middle;
    }
    return low;
}

static double half_float(uint32_t upper) {
    float value;
    upper <<= 16;
    memcpy(&value, &upper, sizeof value);
    return (double)value;
}

static void check_arc(const struct shape *shape, size_t i, uint32_t radii, double extent) {
    enum { STEPS = 24 };
    const narc_arc *arc = &shape->arcs[i];
    const double inner = half_float(radii >> 16), near = half_float(radii & 0xffff), slack = room * extent;
    const double beside = least_radius(shape, i, NARC_INNER_WINDOW), around = least_radius(shape, i, NARC_NEAR_WINDOW);
    const double least = 1 - half_precision - 2e-6;
    assert_true(inner >= 0 && inner <= beside);
    assert_true(near >= 0 && near <= around);
    /* The library adds its tolerance to the windows. */
    assert_true(near >= least * least_radius(shape, i, NARC_NEAR_WINDOW + 2 * NARC_TOLERANCE));
    double possible = least_radius(shape, i, NARC_INNER_WINDOW + 2 * NARC_TOLERANCE);
    for (size_t k = 0; k <= STEPS; k++) {
        const double angle = arc->start + sweep_of(arc) * (double)k / STEPS,
                     excess = excess_of(shape, arc, angle, inner);
        if (excess > slack) {
            fail_msg("arc %zu of %zu: inner is %g, that circle leaves the shape by %g at %g (%g to %g)", i,
                     shape->count, inner, excess, angle, arc->start, arc->end);
        }
        possible = largest_circle(shape, arc, angle, possible, slack);
    }
    /* What an arc takes away that hardly turns is below the oracle's rounding. */
    if (least_sweep(shape) > 1e-2 && inner < 0.98 * possible - 1e-6 * extent)
        fail_msg("arc %zu of %zu: inner is %g, it could be %g", i, shape->count, inner, possible);
}

static void check_shape(const struct shape *shape) {
    double extent = 0;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    store_shape(shapes, *shape);
    const narc_shape_header *header = shapes->headers;
    for (size_t i = 0; i < shape->count; i++)
        extent = fmax(extent, hypot(shape->arcs[i].center_x, shape->arcs[i].center_y) + shape->arcs[i].radius);
    for (size_t i = 0; i < header->count; i++) {
        const size_t caller = (i + header->first_arc) % header->count;
        check_arc(shape, shape->count == 1 ? 0 : caller, narc_arcs_of(shapes, header)[i].arc.inner_radii, extent);
    }
}

TEST(holds_for_all_families) {
    struct test_random random = test_random_named("inner radii");
    for (size_t k = 0; k < test_trials(4); k++) {
        for (int family = 0; family < FAMILY_COUNT; family++) {
            const struct shape shape = make_shape(&random, (enum family)family);
            check_shape(&shape);
        }
        for (int family = 0; family < HARD_COUNT; family++) {
            const struct shape shape = make_hard_shape(&random, (enum hard_family)family);
            check_shape(&shape);
        }
    }
}

static uint32_t inner_radii_of(narc_shapes *shapes, size_t arc) {
    const narc_shape_header *header = &shapes->headers[narc_count_shapes(shapes) - 1];
    return narc_arcs_of(shapes, header)[(arc + header->count - header->first_arc) % header->count].arc.inner_radii;
}

static void expect_inner_radii(narc_shapes *shapes, size_t arc, double inner, double near) {
    const uint32_t radii = inner_radii_of(shapes, arc);
    assert_true(half_float(radii >> 16) <= inner && half_float(radii >> 16) >= inner * (1 - 2 * half_precision));
    assert_true(half_float(radii & 0xffff) <= near && half_float(radii & 0xffff) >= near * (1 - 2 * half_precision));
}

/* Shapes of which it can be told by hand. */
TEST(is_tight_for_known_shapes) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    store_shape(shapes, circle_of(3));
    expect_inner_radii(shapes, 0, 3, 3);
    store_shape(shapes, capsule_of(4, 0.3));
    expect_inner_radii(shapes, 0, 0.3, 0.3);
    store_shape(shapes, box_of(2, 1, 0.25));
    expect_inner_radii(shapes, 2, 0.25, 0.25);
    store_shape(shapes, box_of(2, 1, 0));
    expect_inner_radii(shapes, 1, 0, 0);
    /* A lens with round tips of 0.25: next to them the large arcs have no more room than they. */
    narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &count, NULL);
    assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
    expect_inner_radii(shapes, 0, 0.25, 0.25);
    expect_inner_radii(shapes, 1, 0.25, 0.25);
    /* Half a disc closed by an edge: at the ends of its arc it has the corners' directions. */
    const narc_arc half[] = {{0, 0, 1, -PI / 2, PI / 2}, {0, 1, 0, PI / 2, PI}, {0, -1, 0, -PI, -PI / 2}};
    assert_int_equal(narc_add_shape(shapes, half, 3, NULL, NULL), NARC_OK);
    expect_inner_radii(shapes, 0, 0, 0);
    /* An oval of 16 arcs: within 60 degrees of its flat sides no arc is as sharp as those at its tips. */
    narc_point points[16];
    for (size_t i = 0; i < 16; i++)
        points[i] = (narc_point){1.5 * cos(PI / 8 * ((double)i + 0.5)), sin(PI / 8 * ((double)i + 0.5))};
    assert_int_equal(narc_build_points(points, 16, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
    double sharpest = INFINITY;
    for (size_t i = 0; i < count; i++)
        sharpest = fmin(sharpest, arcs[i].radius);
    assert_true(half_float(inner_radii_of(shapes, 3) & 0xffff) > 1.1 * sharpest);
}
