/* SPDX-License-Identifier: MIT
 *
 * loads.c - a shape's reach, and each grain's share of the contacts: stress, rattlers.
 */
#include <math.h>

#include "worlds.h"

#define PI 3.14159265358979323846

/* The furthest of the points that the shape has in many directions. Its distance from the centroid is missed by at most
 * 1 - cos of half a step between directions. */
static double sample_reach(const dem *d, const dem_shape *shape) {
    double reach = 0;
    for (uint32_t k = 0; k < shape->outline_count; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, d->outlines[shape->first_outline + k].stored, arcs);
        for (int i = 0; i < 100000; i++) {
            narc_point p;
            assert_true(narc_find_support(arcs, count, cos(i * PI / 50000), sin(i * PI / 50000), &p, NULL));
            reach = fmax(reach, hypot(p.x, p.y));
        }
    }
    return reach;
}

/* Flat arcs too, whose circles reach far. */
TEST(test_reach) {
    AUTO(dem_destroy) dem d = plain_world();
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_four_arc(&(narc_four_arc){20, 30, 48, 0.1, 0}, arcs, &count, NULL), NARC_OK);
    dem_add_shape(&d, "lens", arcs, count);
    assert_int_equal(narc_build_box(4, 1, 0, arcs, &count, NULL), NARC_OK);
    const uint32_t box = dem_add_shape(&d, "box", arcs, count);
    for (uint32_t k = 0; k < d.shape_count; k++) {
        const double sampled = sample_reach(&d, &d.shapes[k]);
        print_message("%s: reach %.9g, sampled %.9g\n", d.shapes[k].name, d.shapes[k].reach, sampled);
        assert_true(fabs(d.shapes[k].reach - sampled) <= 1e-6 * sampled);
    }
    assert_true(fabs(d.shapes[box].reach - sqrt(4.25)) < 1e-6);
}

/* A column of two discs of radius 1 between plates 3.98 apart, without gravity, and a disc that touches one of them from
 * the side. Three contacts with depths of 0.02 / 3 if all are alike; they are placed so. */
static dem make_column(double friction, double aside) {
    const double depth = 0.02 / 3;
    dem d = plain_world();
    d.laws[0][0].friction = friction;
    d.settings.time_step = 1e-9; /* forces of where they are put */
    d.settings.thickness = 2;
    add_plate(&d, "floor", 0, 0, 0, 1);
    add_plate(&d, "lid", 0, 4 - 3 * depth, 0, -1);
    add_grain(&d, DISC, 5, 1 - depth, 0, 0);
    add_grain(&d, DISC, 5, 3 - 2 * depth, 0, 0);
    add_grain(&d, DISC, 5 + aside, 1 - depth, 0, 0);
    dem_start(&d);
    step(&d, 1);
    return d;
}

TEST(test_loads) {
    AUTO(dem_destroy) dem d = make_column(0.5, 1.99);
    dem_load *loads = dem_find_loads(&d);
    const double push = 1e5 * 0.02 / 3, arm = 1 - 0.01 / 3, volume = PI * 2;
    /* Floor and neighbour above; from the side the third, which also stands on the floor: with friction two are enough. */
    assert_int_equal(loads[0].contacts, 3);
    assert_int_equal(loads[1].contacts, 2);
    assert_int_equal(loads[2].contacts, 2);
    assert_int_equal(loads[0].bearing, 3);
    assert_int_equal(loads[1].bearing, 2);
    const double expected = 2 * push * arm / volume;
    print_message("stress %.6g, expected %.6g\n", loads[1].stress.yy, expected);
    assert_true(fabs(loads[1].stress.yy / expected - 1) < 1e-3); /* depths are within 1e-6 or so of 7e-3 */
    assert_true(fabs(loads[1].stress.xx) < 1e-3 * expected);
    dem_release(loads);
}

/* Alone and without friction nobody has three; with friction the column stands and the third, on the floor alone, rattles. */
TEST(test_rattlers) {
    static const uint32_t expected[2][3] = {{0, 0, 0}, {2, 2, 0}};
    for (int friction = 0; friction < 2; friction++) {
        AUTO(dem_destroy) dem d = make_column(friction, 4);
        dem_load *loads = dem_find_loads(&d);
        for (size_t k = 0; k < 3; k++)
            assert_int_equal(loads[k].bearing, expected[friction][k]);
        assert_int_equal(loads[2].contacts, 1);
        dem_release(loads);
    }
}
