/* SPDX-License-Identifier: MIT
 *
 * forms.c - closed forms of what a referee checks: bodies that are cut, dashpots, cohesion, drag, cells
 * that hold a stress, groups of walls, chains.
 */
#include <math.h>
#include <string.h>

#include "worlds.h"

#define PI 3.14159265358979323846

static narc_error error;

/* A bar of 2.7 by 0.8, whole or as two bars of 2 that lie over each other; boxes, or with round ends. */
static uint32_t add_bar(dem *d, bool round, int parts) {
    narc_arc arcs[2 * NARC_MAX_ARCS], one[NARC_MAX_ARCS];
    size_t counts[2], used = 0;
    for (int i = 0; i < parts; i++, used += counts[i - 1]) {
        const double length = parts == 1 ? 2.7 : 2;
        assert_int_equal((round ? narc_build_capsule(length, 0.4, one, &counts[i], &error)
                                : narc_build_box(length, 0.8, 0, one, &counts[i], &error)),
                         NARC_OK);
        assert_int_equal(narc_move_arcs(one, counts[i], parts == 1 ? 0.35 : 0.7 * i, 0, 0, 1, arcs + used, &error),
                         NARC_OK);
    }
    return dem_add_compound(d, "bar", arcs, counts, (size_t)parts);
}

/* What springs of stiffness 1 hold, and force and torque on the first body. */
typedef struct load {
    double energy, force, torque;
} load;

static load press(const uint32_t shapes[2], double x, double y, const double turns[2]) {
    dem_contact_law law = plain_law();
    dem_settings settings = plain_settings();
    settings.max_overlap = 10;
    law.kn = 1;
    AUTO(dem_destroy) dem d = make_world(settings, law);
    for (uint32_t k = 0; k < 4; k++) /* shapes ELL + 1 ... */
        add_bar(&d, k % 2 != 0, k < 2 ? 1 : 2);
    for (int k = 0; k < 2; k++)
        dem_add_grain(&d, (dem_grain){.shape = shapes[k], .position = {k * x, k * y}, .angle = turns[k], .scale = 1});
    d.settings.time_step = 1e-6;
    dem_start(&d);
    const dem_energies e = energies(&d);
    const load found = {e.elastic, hypot(d.bodies[0].force.x, d.bodies[0].force.y), d.bodies[0].torque};
    return found;
}

/* A bar that is cut does what the whole one does: against discs always; against bars where no end fades. */
TEST(test_cut_is_whole) {
    uint64_t seed = 7;
    const dem_sizes unit = {DEM_UNIFORM, 0, 0, 0, 1};
    size_t touched = 0, wrong = 0;
    for (int k = 0; k < 400; k++) {
        const uint32_t round = (uint32_t)k / 2 % 2, whole = ELL + 1 + round, cut = ELL + 3 + round;
        const bool disc = k % 2;
        const double turn = 2 * PI * dem_draw_size(&unit, &seed),
                     way = turn + PI / 2 + 2 * (dem_draw_size(&unit, &seed) - 0.5);
        const double turns[2] = {turn, disc ? 0 : turn + 0.01 * (dem_draw_size(&unit, &seed) - 0.5)};
        const double far = disc ? 1.39 + 0.9 * dem_draw_size(&unit, &seed) : 0.79 / sin(way - turn);
        const load one = press((uint32_t[]){whole, disc ? DISC : whole}, far * cos(way), far * sin(way), turns);
        const load two = press((uint32_t[]){cut, disc ? DISC : cut}, far * cos(way), far * sin(way), turns);
        touched += one.energy > 0;
        wrong += fabs(one.energy - two.energy) > 1e-5 * one.energy + 1e-12 ||
                 fabs(one.force - two.force) > 1e-4 * one.force + 1e-9;
        if (disc)
            assert_true(fabs(one.energy - two.energy) <= 1e-5 * one.energy + 1e-12);
    }
    print_message("touching %zu, different %zu\n", touched, wrong);
    assert_true(touched > 100 && wrong < touched / 50);
}

/* Two discs meet at every phase of a step: how far the mean and the worst restitution are off, and the energy account. */
static void bounce(dem_law kind, double restitution, double steps, double *out_worst, double *out_account) {
    dem_settings settings = plain_settings();
    settings.law = kind;
    settings.max_overlap = kind == DEM_HERTZ ? 0.002 : 0.3;
    *out_worst = *out_account = 0;
    for (int phase = 0; phase < 20; phase++) {
        dem_contact_law law = plain_law();
        law.damping_ratio = dem_damping_ratio(kind, restitution);
        AUTO(dem_destroy) dem d = make_world(settings, law);
        const double m = PI / 2, u = 0.2, b = dem_damping_ratio(DEM_LINEAR, restitution) / 2;
        const double stiffness = d.laws[0][0].kn * sqrt(0.5);
        double time = PI * sqrt(m / law.kn) / sqrt(1 - b * b);
        if (kind == DEM_HERTZ)
            time = 2.94 * pow(m * 5 / 4 / stiffness, 0.4) * pow(u, -0.2);
        d.settings.time_step = time / steps;
        add_grain(&d, DISC, 0, 0, u / 2, 0);
        add_grain(&d, DISC, 2 + u * d.settings.time_step * (1.001 + phase / 20.0), 0, -u / 2, 0);
        dem_start(&d);
        const double energy = total_energy(&d);
        step(&d, (size_t)(4 * steps) + 4);
        assert_int_equal(d.contact_count, 0);
        *out_worst = fmax(*out_worst, fabs((d.bodies[1].velocity.x - d.bodies[0].velocity.x) / u - restitution));
        *out_account = fmax(*out_account, fabs(total_energy(&d) / energy - 1));
    }
}

/* The error falls with the square of the step: by more than 3 where that is halved, once it is small. */
TEST(test_dashpots_are_of_second_order) {
    for (int kind = 0; kind < 2; kind++)
        for (double restitution = 0.9; restitution > 0.2; restitution -= 0.2) {
            double worst[3], account[3];
            for (int i = 0; i < 3; i++)
                bounce(kind ? DEM_HERTZ : DEM_LINEAR, restitution, 22 << i, &worst[i], &account[i]);
            print_message("%s, restitution %.1f: off by %.4f %.4f %.4f, energy by %.4f %.4f %.4f\n",
                          kind ? "hertz" : "linear", restitution, worst[0], worst[1], worst[2], account[0], account[1],
                          account[2]);
            assert_true(account[0] < 0.005);
            assert_true(worst[0] < 0.015 && worst[2] < 0.25 * worst[0] + 1e-4);
        }
}

/* The force that two discs pull with is `cohesion` where they touch, and the work to part them from rest cohesion * range / 2
 * and what the spring holds. */
TEST(test_cohesion) {
    dem_contact_law law = plain_law();
    law.kn = 1000;
    law.cohesion = 10;
    law.range = 0.02;
    AUTO(dem_destroy) dem d = make_world(plain_settings(), law);
    d.settings.time_step = 1e-4;
    const double rest = law.cohesion / law.kn; /* overlap */
    const double held = law.cohesion * law.range / 2 + law.cohesion * law.cohesion / (2 * law.kn), m = PI / 2;
    const double speed = sqrt(2 * held / m);
    for (int fast = 0; fast < 2; fast++) {
        const double v = speed * (fast ? 1.002 : 0.998) / 2;
        add_grain(&d, DISC, 10.0 * fast, 0, -v, 0);
        add_grain(&d, DISC, 10.0 * fast + 2 - rest, 0, v, 0);
    }
    dem_start(&d);
    assert_true(hypot(d.bodies[0].force.x, d.bodies[0].force.y) < 1e-9);
    const double energy = total_energy(&d);
    step(&d, 8000);
    assert_true(fabs(total_energy(&d) - energy) < 1e-4 * held);
    assert_true(d.bodies[1].position.x - d.bodies[0].position.x < 2 + law.range);
    assert_true(d.bodies[3].position.x - d.bodies[2].position.x > 2 + law.range);
}

/* exp(-drag t), with gravity towards g / drag; all is damping. */
TEST(test_drag) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.drag = 2;
    d.settings.gravity = (vec){0, -3};
    d.settings.time_step = 1e-3;
    add_grain(&d, DISC, 0, 0, 5, 0);
    d.bodies[0].spin = 7;
    dem_start(&d);
    const double energy = total_energy(&d);
    step(&d, 1000);
    assert_true(fabs(d.bodies[0].velocity.x - 5 * exp(-2)) < 1e-5 && fabs(d.bodies[0].spin - 7 * exp(-2)) < 1e-5);
    assert_true(fabs(d.bodies[0].velocity.y + 1.5 * (1 - exp(-2))) < 1e-5);
    assert_true(fabs(total_energy(&d) / energy - 1) < 1e-5);
}

/* A square lattice of discs of diameter 2 under a stress p in x and q in y: kn (2 - L_x) = p L_y, and the other way round. */
TEST(test_cell_holds_stress) {
    dem_settings settings = plain_settings();
    settings.periodic_x = settings.periodic_y = settings.strained = true;
    settings.high = (vec){8, 8};
    settings.max_overlap = 0.3;
    dem_contact_law law = plain_law();
    law.kn = 1000;
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.3);
    const double p = 20, q = 10;
    AUTO(dem_destroy) dem d = make_world(settings, law);
    d.settings.time_step = 1e-3;
    for (int k = 0; k < 16; k++)
        add_grain(&d, DISC, 1 + 2 * (k % 4), 1 + 2 * (k / 4), 0, 0);
    dem_start(&d);
    d.sides[0] = (dem_side){1, p, 0.002, 0.5};
    d.sides[1] = (dem_side){1, q, 0.002, 0.5};
    step(&d, 100000);
    const vec size = dem_cell_size(&d);
    const double x = (2 - p / 1000 * 2) / (1 - p * q / 1e6), y = 2 - q / 1000 * x; /* of L_x = 2 - p L_y / kn */
    print_message("cell %.9g by %.9g, of %.9g by %.9g\n", size.x / 4, size.y / 4, x, y);
    assert_true(fabs(size.x / 4 - x) < 1e-6 && fabs(size.y / 4 - y) < 1e-6);
    assert_true(fabs(d.stress.x - p) < 1e-3 && fabs(d.stress.y - q) < 1e-3);
}

/* Three boxes of one group under two discs: together they bear the target, and go along with a velocity across it. */
TEST(test_group_has_one_servo) {
    dem_contact_law law = plain_law();
    law.kn = 1000;
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.3);
    dem_settings settings = plain_settings();
    settings.time_step = 1e-3;
    settings.max_overlap = 0.3;
    AUTO(dem_destroy) dem d = make_world(settings, law);
    add_plate(&d, "top", 0, 2, 0, -1);
    for (int k = 0; k < 3; k++) {
        dem_wall *box = add_box(&d, SQUARE, 4, 4.0 * k - 4, -2.01);
        snprintf(box->name, sizeof box->name, "box %d", k);
        box->group = 1;
        box->velocity = (vec){0.01, 0};
        box->servo = (dem_servo){1, {0, 1}, 30, 0, {-1, -1}, 0.002, 0.5, 0};
    }
    d.group_count = 1;
    add_grain(&d, DISC, -3, 1, 0, 0);
    add_grain(&d, DISC, 3, 1, 0, 0);
    dem_start(&d);
    step(&d, 50000);
    assert_true(fabs(dem_wall_force(&d, 1).y + 30) < 1e-6 && fabs(dem_wall_force(&d, 0).y - 30) < 1e-4);
    assert_true(fabs(d.bodies[2 + 1].position.x + 3.5) < 1e-9);
    for (int k = 2; k < 4; k++)
        assert_true(d.bodies[2 + k].position.y == d.bodies[2 + 1].position.y);
}

/* A disc in a bowl, a concave arc: a pendulum of length R - r, and of 3/2 of it where it rolls. */
TEST(test_pendulum_in_a_bowl) {
    const narc_arc bowl = {0, 0, -5, PI * 0.9, PI * 0.1};
    for (int rolls = 0; rolls < 2; rolls++) {
        dem_contact_law law = plain_law();
        law.friction = rolls ? 5 : 0;
        dem_settings settings = plain_settings();
        settings.gravity = (vec){0, -1};
        settings.time_step = 5e-4;
        AUTO(dem_destroy) dem d = make_world(settings, law);
        dem_wall wall = {.name = "bowl", .kind = DEM_BOX, .scale = 1};
        wall.shape = dem_add_chain(&d, "bowl", &bowl, 1, false);
        dem_add_wall(&d, wall);
        const double length = 4, begin = 0.05,
                     theory = 2 * PI * sqrt((rolls ? 1.5 : 1) * length) * (1 + begin * begin / 16);
        add_grain(&d, DISC, length * sin(begin), -length * cos(begin), 0, 0);
        dem_start(&d);
        double crossed[3] = {0}, last = 1;
        for (int found = 0; found < 3 && d.time < 50;) {
            const double x = d.bodies[0].position.x;
            if (last > 0 && x <= 0)
                crossed[found++] = d.time - settings.time_step * x / (x - last);
            last = x;
            step(&d, 1);
        }
        print_message("period %.6g, of %.6g\n", (crossed[2] - crossed[0]) / 2, theory);
        assert_true(fabs((crossed[2] - crossed[0]) / 2 / theory - 1) < 3e-4);
    }
}

/* On a flat of pieces, boxes or a chain, a disc without friction keeps its speed. */
TEST(test_flat_ground_of_pieces) {
    narc_arc flat[9];
    for (int k = 0; k < 9; k++)
        flat[k] = (narc_arc){24 - 3.0 * k, 0, 0, PI / 2, PI / 2};
    for (int chain = 0; chain < 2; chain++) {
        dem_contact_law law = plain_law();
        law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.3);
        dem_settings settings = plain_settings();
        settings.gravity = (vec){0, -1};
        settings.time_step = 5e-4;
        AUTO(dem_destroy) dem d = make_world(settings, law);
        if (chain) {
            dem_wall wall = {.name = "flat", .kind = DEM_BOX, .scale = 1};
            wall.shape = dem_add_chain(&d, "flat", flat, 9, false);
            dem_add_wall(&d, wall);
        }
        for (int k = 0; k < 12 && !chain; k++) {
            dem_wall *const box = add_box(&d, SQUARE, 2, 2.0 * k, -1);
            snprintf(box->name, sizeof box->name, "box %d", k);
        }
        add_grain(&d, DISC, 1.5, 1 - PI / law.kn, 1, 0);
        dem_start(&d);
        step(&d, 40000);
        print_message("%s: velocity %.9g, height off by %.2g\n", chain ? "chain" : "boxes", d.bodies[0].velocity.x,
                      d.bodies[0].position.y - 1 + PI / law.kn);
        assert_true(d.bodies[0].position.x > 21 && fabs(d.bodies[0].velocity.x - 1) < 1e-6);
    }
}
