/* SPDX-License-Identifier: MIT
 *
 * parts.c - grains of several outlines: their mass, a collision off the centre, and that they are one body.
 */
#include <math.h>

#include "worlds.h"

#define PI 3.14159265358979323846

/* Two discs that touch, and two boxes whose union is one of 3 by 1, far from their centroid. */
TEST(test_mass_of_parts) {
    AUTO(dem_destroy) dem d = plain_world();
    const double r = 0.5, dimer = 2 * (PI * pow(r, 4) / 2 + PI * pow(r, 4)), box = 3.0 * (9 + 1) / 12;
    narc_arc arcs[2 * NARC_MAX_ARCS], moved[NARC_MAX_ARCS];
    size_t counts[2];
    assert_int_equal(narc_build_box(2, 1, 0, moved, &counts[0], NULL), NARC_OK);
    counts[1] = counts[0];
    for (size_t i = 0; i < 2; i++)
        assert_int_equal(narc_move_arcs(moved, counts[i], 7 + (double)i, -3, 0, 1, arcs + i * counts[0], NULL),
                         NARC_OK);
    const uint32_t index = dem_add_compound(&d, "long box", arcs, counts, 2);
    const dem_shape *shape = &d.shapes[index];
    assert_true(fabs(shape->area - 3) < 1e-12 && fabs(shape->second_moment - box) < 1e-11);
    assert_true(fabs(shape->reach - sqrt(2.5)) < 1e-9 && shape->outline_count == 2);
    shape = &d.shapes[DIMER];
    assert_true(fabs(shape->area - 2 * PI * r * r) < 1e-12 && fabs(shape->second_moment - dimer) < 1e-12);
    assert_true(fabs(shape->reach - 2 * r) < 1e-12);
}

/* A disc meets one end of a dimer square to its axis, without friction or damping. The push P along y changes the
 * momenta of both by P and the dimer's spin by P a / I; energy tells P. Contacts are soft: the dimer turns a little while
 * they last, by the speed times their time, 2e-3 of the arm. */
TEST(test_collision_off_centre) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.time_step = 1e-5;
    d.laws[0][0].kn = 1e7;
    add_grain(&d, DIMER, 0, 0, 0, 0);
    add_grain(&d, DISC, 0.5, 1.51, 0, -1);
    dem_start(&d);
    const double m = d.bodies[1].mass, mass = d.bodies[0].mass, inertia = d.bodies[0].inertia, arm = 0.5;
    const double push = 2 / (1 / m + 1 / mass + arm * arm / inertia);
    step(&d, 4000);
    print_message("spin %.6g, %.6g of theory; disc %.6g, %.6g\n", d.bodies[0].spin, -push * arm / inertia,
                  d.bodies[1].velocity.y, -1 + push / m);
    assert_int_equal(d.contact_count, 0);
    assert_true(fabs(d.bodies[0].spin / (-push * arm / inertia) - 1) < 5e-3);
    assert_true(fabs(d.bodies[1].velocity.y - (-1 + push / m)) < 5e-3 &&
                fabs(d.bodies[0].velocity.y + push / mass) < 5e-3);
}

/* Forces within a grain there are none, though its parts lie over each other; pairs are of parts, forces on bodies. */
TEST(test_parts_are_one_body) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.periodic_x = d.settings.periodic_y = true;
    d.settings.high.x = d.settings.high.y = 8;
    add_grain(&d, ELL, 0.1, 0.1, 0, 0); /* across both borders */
    add_grain(&d, ELL, 4, 4, 0, 0);
    dem_start(&d);
    assert_int_equal(d.part_count, 4);
    assert_int_equal(d.contact_count, 0);
    for (size_t p = 0; p < d.pair_count; p++)
        assert_ptr_not_equal(dem_body_a(&d, p), dem_body_b(&d, p));
}

/* An upright dimer on a plate and one that lies on it: one contact and two, each of which bears its share. */
TEST(test_dimers_on_a_plate) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.gravity = (vec){0, -10};
    d.laws[0][0].damping_ratio = 1;
    add_plate(&d, "floor", 0, 0, 0, 1);
    add_grain(&d, DIMER, 0, 0.5, 0, 0);
    dem_add_grain(&d, (dem_grain){.shape = DIMER, .position = {5, 1}, .angle = PI / 2, .scale = 1});
    dem_start(&d);
    step(&d, 3000);
    assert_int_equal(d.contact_count, 3);
    const double weight = 10 * d.bodies[0].mass;
    assert_true(fabs(d.bodies[0].force.y / weight - 1) < 1e-3 && fabs(d.bodies[1].force.y / weight - 1) < 1e-3);
    assert_true(fabs(d.bodies[0].position.y - (0.5 - weight / 2 / 1e5)) < 1e-6);
    assert_true(fabs(d.bodies[1].position.y - (1 - weight / 1e5)) < 1e-6);
}
