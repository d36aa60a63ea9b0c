/* SPDX-License-Identifier: MIT
 *
 * worlds.c - small worlds of grains.
 */
#include "worlds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static struct CMUnitTest tests[40]; /* those without a name are none to cmocka */

void test_add(const char *name, CMUnitTestFunction test) {
    size_t k = 0;
    while (tests[k].name)
        if (++k == sizeof tests / sizeof *tests)
            abort();
    tests[k] = (struct CMUnitTest){.name = name, .test_func = test};
}

int main(void) { return cmocka_run_group_tests(tests, NULL, NULL); }

dem_settings plain_settings(void) {
    dem_settings s = dem_defaults;
    s.gravity = (vec){0, 0};
    s.time_step = 1e-4;
    s.skin = 0.2;
    s.threads = 1;
    return s;
}

dem_settings sheared_settings(double side, double rate) {
    dem_settings s = plain_settings();
    s.periodic_x = s.periodic_y = s.sheared = true;
    s.high.x = s.high.y = side;
    s.rates.shear = rate;
    return s;
}

dem_contact_law plain_law(void) {
    return (dem_contact_law){.kn = 1e5, .kt = 2e5 / 7, .damping_ratio = -1, .gamma_n = 0, .tangential_share = 0.5};
}

jmp_buf error_place;

static void jump(__attribute__((unused)) dem *d) { longjmp(error_place, 1); }

void watch_errors(dem *d) { d->on_error = jump; }

void check_error(const dem *d, const char *message) {
    if (!strstr(d->error, message))
        fail_msg("'%s' instead of '%s'", d->error, message);
}

/* A grain as narc fit --arcs 8 writes it. */
static const narc_arc sand[] = {
    {0.30362318967031376, 0.0097855072832697121, 0.72173061243176462, 0.12140611267875406, 0.97257050336731055},
    {0.01522636700788127, -0.4133720053420914, 1.233819479536947, 0.97257050336731055, 1.5028508135931822},
    {0.016630730194921811, -0.39273486050015705, 1.2131346062429649, 1.5028508135931822, 2.0501343749940517},
    {-0.12957769536272123, -0.11144026794320344, 0.89611165517186753, 2.0501343749940517, 2.7825076160484885},
    {-0.39880257185007739, -0.010384390519988337, 0.60854544630613849, 2.7825076160484885, -2.3711150810513208},
    {-0.031176707217766608, 0.34643157181772455, 1.1208602004618646, -2.3711150810513208, -1.6325517584529359},
    {-0.015673973613442471, 0.59714669779339768, 1.3720541676310709, -1.6325517584529359, -1.0322511169388462},
    {0.33309866011495537, 0.013381695560912482, 0.69203657383710404, -1.0322511169388462, 0.12140611267875406}};

static void add_shapes(dem *d) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_point points[8];
    size_t count;
    assert_int_equal(narc_build_circle(1, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "disc", arcs, count);
    for (int i = 0; i < 8; i++)
        arcs[i] = (narc_arc){0, 0, 1, i * PI / 4, (i + 1) * PI / 4};
    dem_add_shape(d, "round", arcs, 8);
    assert_int_equal(narc_build_regular_polygon(8, 1, 0.2, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "octagon", arcs, count);
    for (int i = 0; i < 8; i++)
        points[i] = (narc_point){1.3 * cos(i * PI / 4), sin(i * PI / 4)};
    assert_int_equal(narc_build_ring(points, 8, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "arcs", arcs, count);
    assert_int_equal(narc_build_ellipse(1.5, 0.75, 8, arcs, &count, NULL, NULL), NARC_OK);
    dem_add_shape(d, "ellipse", arcs, count);
    assert_int_equal(narc_build_regular_polygon(8, 1, 0, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "sharp", arcs, count);
    assert_int_equal(narc_build_box(1, 1, 0, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "square", arcs, count);
    assert_int_equal(narc_build_capsule(1, 0.5, arcs, &count, NULL), NARC_OK);
    dem_add_shape(d, "long", arcs, count);
    assert_int_equal(dem_add_shape(d, "sand", sand, sizeof sand / sizeof sand[0]), SAND);
    const size_t discs[2] = {1, 1}, bars[2] = {2, 2};
    for (int i = 0; i < 2; i++)
        arcs[i] = (narc_arc){i - 0.5, 0, 0.5, 0, 2 * PI};
    dem_add_compound(d, "dimer", arcs, discs, 2);
    assert_int_equal(narc_build_capsule(1.2, 0.3, arcs, &count, NULL), NARC_OK);
    assert_int_equal(narc_move_arcs(arcs, 2, 0.6, 0, 0, 1, arcs, NULL), NARC_OK);
    assert_int_equal(narc_move_arcs(arcs, 2, 0, 0, PI / 2, 1, arcs + 2, NULL), NARC_OK);
    assert_int_equal(dem_add_compound(d, "ell", arcs, bars, 2), ELL);
}

dem make_world(dem_settings settings, dem_contact_law law) {
    dem d;
    dem_create(&d, settings);
    add_shapes(&d);
    d.materials[d.material_count++] = (dem_material){"stuff", 1, 1e6, 0.25};
    dem_set_law(&d, 0, 0, law);
    return d;
}

dem plain_world(void) { return make_world(plain_settings(), plain_law()); }

void add_grain(dem *d, uint32_t shape, double x, double y, double vx, double vy) {
    dem_add_grain(d, (dem_grain){.shape = shape, .position = {x, y}, .scale = 1, .velocity = {vx, vy}});
}

void add_plate(dem *d, const char *name, double x, double y, double normal_x, double normal_y) {
    dem_wall wall = {
        .kind = DEM_PLATE, .position = {x, y}, .normal = {normal_x, normal_y}, .servo = {.between = {-1, -1}}};
    snprintf(wall.name, sizeof wall.name, "%s", name);
    dem_add_wall(d, wall);
}

dem_wall *add_box(dem *d, uint32_t shape, double scale, double x, double y) {
    dem_add_wall(d, (dem_wall){.name = "box",
                               .kind = DEM_BOX,
                               .shape = shape,
                               .scale = scale,
                               .position = {x, y},
                               .pivot = {x, y},
                               .servo = {.between = {-1, -1}}});
    return &d->walls[d->wall_count - 1];
}

dem make_busy_world(unsigned threads) {
    dem d = plain_world();
    dem_contact_law *law = &d.laws[0][0];
    d.settings.gravity = (vec){1, -40};
    d.settings.periodic_x = true;
    d.settings.high.x = 24;
    d.settings.threads = threads;
    law->kn = 1e6;
    law->kt = 3e5;
    law->damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.6);
    law->friction = 0.5;
    law->rolling_friction = 0.05;
    add_plate(&d, "floor", 0, 0, 0, 1);
    add_plate(&d, "lid", 0, 22.5, 0, -1);
    d.walls[1].velocity = (vec){3, 0};
    dem_wall *paddle = add_box(&d, OCTAGON, 1.5, 12, 3);
    paddle->pivot.x = 12.5;
    paddle->spin = 2;
    d.walls[0].servo =
        (dem_servo){.on = true, .direction = {0, 1}, .stress = 100, .between = {0, 1}, .gain = 1e-4, .max_speed = 2};
    const dem_filling filling = {.count = 120,
                                 .region = {true, {0, 1.2}, {24, 21.3}},
                                 .shapes = {DISC, ROUND, OCTAGON, ARCS, ELL},
                                 .shape_count = 5,
                                 .sizes = {DEM_UNIFORM, 0, 0, 1.2, 2},
                                 .speed = 3,
                                 .spin = 1,
                                 .tries = 20000};
    uint64_t random = 7;
    dem_fill_randomly(&d, &filling, &random);
    return d;
}

void step(dem *d, size_t count) {
    for (size_t i = 0; i < count; i++)
        dem_step(d);
}

dem_energies energies(const dem *d) {
    dem_measures m;
    dem_measure(d, NULL, &m);
    return m.energy;
}

double total_energy(const dem *d) {
    const dem_energies e = energies(d);
    return e.kinetic + e.potential + e.elastic + e.damping + e.friction - e.walls;
}
