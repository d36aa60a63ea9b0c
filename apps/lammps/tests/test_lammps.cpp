/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * test_lammps.cpp - the styles against LAMMPS' own, against closed forms, and against themselves on other ranks.
 *   mpirun -np 4 test_lammps TEST
 */
#include <cstring>
#include <fstream>
#include <map>

#include <dlfcn.h>

#include "check.h"
#include "compute.h"
#include "lammps.h"
#include "modify.h"

namespace {

const std::string shapes_file = GRAINS_FILE;
const std::string tracking = "neighbor 0.2 bin\nneigh_modify delay 0 every 1 check yes\n";

/* Fixes and pair style for grains of one shape or several. */
std::string grains(const std::string &shapes, const std::string &pair_style) {
    return tracking + "fix shapes all narc/shapes " + shapes_file + " " + shapes + " density 1\npair_style " +
           pair_style + "\npair_coeff * *\nfix nve all narc/nve\n";
}

/* LAMMPS' own styles for discs of density 1. */
std::string discs(const std::string &pair_style) {
    return tracking + "set group all density/disc 1\npair_style " + pair_style +
           "\npair_coeff * *\nfix nve all nve/sphere disc\nfix flat all enforce2d\n";
}

double kinetic_energy(Simulation &simulation) {
    double energy = simulation.variable("f_nve");
    for (const State &s : simulation.states())
        energy += 0.5 * s.mass * (s.velocity_x * s.velocity_x + s.velocity_y * s.velocity_y);
    return energy;
}

/* ---------------------------------------------------------------------------- against LAMMPS' own styles */

/* The library's separation of two discs is within NARC_ERROR_BOUND * (D + E_a + E_b) of theirs, D and both E being at
 * most 1.2 in all here, each: 5e-6; its measured error is some 1e-7. Forces: kn times that for the six contacts of a
 * disc. Positions after a time T: half the acceleration times T^2.
 * Neighbour lists are new every 7 steps, so that memories of contacts move. */
void compare_with_own(const char *law, double stiffening) {
    const double kn = 1e4, separation_error = 32.0 / 16777216 * 2.4, step = 2e-4;
    const int steps = 100;
    const Packing packing = make_lattice(20, 20, 1.06, 0.1, 0.5, 7);
    const std::string coefficients = "/history 10000 3000 20 10 0.4 1";
    const std::string start =
        "neigh_modify delay 0 every 7 check no\ntimestep 2e-4\nthermo_style custom step pxx pyy pxy\nrun 0";
    Simulation narc(MPI_COMM_WORLD), own(MPI_COMM_WORLD);
    narc.create(packing);
    narc.run(grains("disc", std::string("narc/") + law + coefficients) + start);
    own.create(packing);
    own.run(discs(std::string("gran/") + law + coefficients) + start);
    Difference at = compare(narc.states(), own.states(), packing.width, packing.height);
    const double force_error = 6 * kn * stiffening * separation_error, mass = 0.6;
    /* Two contacts a grain, grains a unit apart: the virial of a unit of area. */
    for (const char *part : {"pxx", "pyy", "pxy"})
        check_at_most(part, std::fabs(narc.variable(part) - own.variable(part)), force_error / 3);
    check_at_most("forces at the start", at.force, force_error);
    check_at_most("torques at the start", at.torque, force_error);
    const std::string more = "run " + std::to_string(steps);
    narc.run(more);
    own.run(more);
    at = compare(narc.states(), own.states(), packing.width, packing.height);
    const double time = steps * step;
    check_at_most("positions after 100 steps", at.position, 0.5 * force_error / mass * time * time);
    check_at_most("velocities after 100 steps", at.velocity, force_error / mass * time);
    check_at_most("spins after 100 steps", at.spin, 4 * force_error / mass * time);
}

void test_discs_hooke() { compare_with_own("hooke", 1); }

/* The derivative of Hertz' force, 3/2 sqrt(R overlap), is below 1 here. */
void test_discs_hertz() { compare_with_own("hertz", 1); }

/* ---------------------------------------------------------------------------- closed forms */

/* A head-on collision of two grains with damping is half a period of a damped oscillation:
 * e = exp(-gamma pi / (2 w)), w^2 = kn / m - gamma^2 / 4. The steps, 4000 of them a period, leave 1e-3. */
void check_restitution(const std::string &shape, double radius, bool turned) {
    const double kn = 1e5, gamma = 60, quarter = std::acos(0.0);
    Packing packing = {10, 10, {}};
    const double gap = 2.01 * radius;
    packing.grains = {{1, 5 - gap / 2, 5, radius, turned ? 2 * quarter : 0, 1, 0, 0},
                      {1, 5 + gap / 2, 5, radius, 0, -1, 0, 0}};
    Simulation pair(MPI_COMM_WORLD);
    pair.create(packing);
    pair.run(grains(shape, "narc/hooke/history 1e4 NULL 0 NULL 0 1") +
             "pair_coeff 1 1 1e5 NULL 60 NULL 0.5 1\ntimestep 2e-6\nrun 0");
    const double mass = pair.states()[0].mass / 2;
    const double frequency = std::sqrt(kn / mass - gamma * gamma / 4);
    const double restitution = std::exp(-gamma * 2 * quarter / (2 * frequency));
    pair.run("run 20000");
    const std::vector<State> after = pair.states();
    const std::string what = "restitution of " + shape;
    check_at_most(what.c_str(), std::fabs((after[1].velocity_x - after[0].velocity_x) / 2 - restitution),
                  1e-3 * restitution);
    check_at_most("the collision stays straight", std::fabs(after[0].velocity_y) + std::fabs(after[0].spin), 1e-4);
}

/* The larger disc comes from the left and meets the smaller one, with the restitution that is given, whatever the
 * masses and the speed. 200 steps a contact and more leave 1e-2. */
void check_given(const char *law, double speed) {
    Packing packing = {10, 10, {{1, 4, 5, 0.7, 0, speed, 0, 0}, {1, 5.11, 5, 0.4, 0, 0, 0, 0}}};
    Simulation pair(MPI_COMM_WORLD);
    pair.create(packing);
    pair.run(grains("disc", std::string("narc/") + law + "/history 1e4 NULL 0 NULL 0.5 1 restitution 0.6") +
             "timestep 5e-5\nrun 20000");
    const std::vector<State> after = pair.states();
    const double found = (after[1].velocity_x - after[0].velocity_x) / speed;
    check_at_most((std::string("a given restitution, ") + law).c_str(), std::fabs(found - 0.6), 1e-2);
}

void test_restitution() {
    for (const char *law : {"hooke", "hertz"})
        for (const double speed : {0.2, 1.0})
            check_given(law, speed);
    check_restitution("disc", 0.5, false);
    check_restitution("ellipse8", 0.5, true);
}

/* Hertz' force kn sqrt(R d) d of two grains along x that overlap by d, with the radii of the discs of equal area, to
 * the rounding of their places. */
void check_hertz(const char *what, const std::string &shapes, const Grain &a, const Grain &b, double overlap,
                 double radius_a, double radius_b) {
    Packing packing = {10, 10, {a, b}};
    packing.types = 2;
    Simulation pair(MPI_COMM_WORLD);
    pair.create(packing);
    pair.run(grains(shapes, "narc/hertz/history 1e4 0 0 0 0 0") + "timestep 1e-6\nrun 0");
    const double force = 1e4 * std::sqrt(radius_a * radius_b / (radius_a + radius_b) * overlap) * overlap;
    check_at_most(what, std::fabs(pair.states()[1].force_x / force - 1), 1e-11);
}

/* One radius for a grain, whatever touches. Two flat sides touch at two ends: d and the force are sqrt(2) as large. */
void test_hertz() {
    const double d = 0.01, pi = std::acos(-1.0);
    const double half_width = 0.8, half_height = 0.45, reach = std::hypot(half_width, half_height);
    const double scale = 0.5 / reach, brick = scale * std::sqrt(4 * half_width * half_height / pi);
    const double to_corner = pi - std::atan2(half_height, half_width);
    const Grain disc = {1, 5, 5, 0.5, 0, 0, 0, 0}, side = {2, 5.5 + half_width * scale - d, 5, 0.5, 0, 0, 0, 0};
    check_hertz("force of disc and side", "disc brick", disc, side, d, 0.5, brick);
    check_hertz("force of disc and corner", "disc brick", disc, {2, 6 - d, 5, 0.5, to_corner, 0, 0, 0}, d, 0.5, brick);
    /* kn sqrt(R h) h sqrt(2) with h = sqrt(2) d is that of a depth of 2^(5 / 6) times d. */
    check_hertz("force of two sides", "brick brick", {1, 5, 5, 0.5, 0, 0, 0, 0},
                {2, 5 + 2 * half_width * scale - d, 5, 0.5, 0, 0, 0, 0}, d * std::pow(2, 5.0 / 6), brick, brick);
}

/* A grain goes down a slope of 30 degrees from rest without sliding. A disc of radius R has the torque mu R N against
 * it and the moment of inertia m R^2 / 2: its acceleration is 2/3 (g sin - mu g cos), and 0 if that is negative.
 * Springs ring at first, with an amplitude that is the load's overlap. */
void test_rolling() {
    const double angle = std::acos(-1.0) / 6, time = 4;
    for (const double mu : {0.0, 0.3, 0.7}) {
        Packing packing = {40, 4, {{1, 2, 0.5, 0.5, 0, 0, 0, 0}}};
        Simulation slope(MPI_COMM_WORLD);
        slope.create(packing, "f f p");
        char floor[200];
        std::snprintf(floor, sizeof floor,
                      "fix floor all wall/narc hooke/history 1e5 NULL 200 NULL 0.9 1 rolling %g plate 0 0 0 1\n", mu);
        slope.run(grains("disc", "narc/hooke/history 1e5 NULL 60 NULL 0 1") + floor +
                  "fix gravity all gravity 1 vector 0.5 -0.86602540378443865 0\ntimestep 1e-4\nrun 20000");
        const double before = slope.states()[0].velocity_x;
        slope.run("run " + std::to_string(static_cast<int>(time / 1e-4)));
        const double found = (slope.states()[0].velocity_x - before) / time;
        const double expected = std::fmax(2.0 / 3 * (std::sin(angle) - mu * std::cos(angle)), 0);
        check_at_most("acceleration of a disc that rolls", std::fabs(found - expected), 1e-4);
    }
}

/* ---------------------------------------------------------------------------- grains of parts */

/* What a collision must keep: momentum, angular momentum about the origin, energy. */
struct Kept {
    double x = 0, y = 0, turn = 0, energy = 0;
};

Kept sum_kept(Simulation &simulation, const double inertia[2]) {
    Kept sum;
    sum.energy = kinetic_energy(simulation);
    const std::vector<State> states = simulation.states();
    for (size_t i = 0; i < states.size(); i++) {
        const State &s = states[i];
        sum.x += s.mass * s.velocity_x;
        sum.y += s.mass * s.velocity_y;
        sum.turn += s.mass * (s.x * s.velocity_y - s.y * s.velocity_x) + inertia[i] * s.spin;
    }
    return sum;
}

/* A disc meets one end of a dimer, two discs that touch, square to its axis. The push P along y changes the momenta of
 * both by P and the dimer's spin by P a / I; energy tells P. The contact is soft: the dimer turns a little meanwhile,
 * by the speed times its time, 2e-3 of the arm a. */
void test_clumps() {
    const double r = 0.5, pi = std::acos(-1.0), m = pi * r * r, inertia = 2 * (pi * std::pow(r, 4) * (0.5 + 1));
    const double spins[2] = {inertia, m * r * r / 2};
    Packing packing = {10, 10, {{1, 4, 5, 2 * r, 0, 0, 0, 0}, {2, 4.5, 6.01, r, 0, 0, -1, 0}}};
    packing.types = 2;
    Simulation hit(MPI_COMM_WORLD);
    hit.create(packing);
    hit.run(grains("dimer disc", "narc/hooke/history 1e7 NULL 0 NULL 0 1") + "timestep 1e-5\nrun 0");
    const Kept before = sum_kept(hit, spins);
    hit.run("run 4000");
    const Kept after = sum_kept(hit, spins);
    const std::vector<State> states = hit.states();
    const double push = 2 / (1 / m + 1 / (2 * m) + r * r / inertia);
    check_at_most("mass of a dimer", std::fabs(states[0].mass / (2 * m) - 1), 1e-12);
    check_at_most("spin of a dimer", std::fabs(states[0].spin / (-push * r / inertia) - 1), 5e-3);
    check_at_most("velocity of the disc", std::fabs(states[1].velocity_y + 1 - push / m), 5e-3);
    check_at_most("momentum", std::hypot(after.x - before.x, after.y - before.y), 1e-12);
    check_at_most("angular momentum", std::fabs(after.turn - before.turn), 1e-12);
    check_at_most("energy of a dimer's collision", std::fabs(after.energy / before.energy - 1), 1e-4);

    /* Two angles whose arms reach into each other, and touch with several parts at once. */
    packing.grains = {{1, 4, 4, 0.8, 0.3, 1, 0.5, 0.4}, {1, 5.3, 5.5, 0.8, 3.6, -1, -0.5, -0.3}};
    Simulation clash(MPI_COMM_WORLD);
    clash.create(packing);
    clash.run(grains("ell ell", "narc/hooke/history 1e6 NULL 0 NULL 0 1") + "timestep 1e-5\nrun 0");
    const double ratio = clash.variable("f_nve") / (0.5 * (0.4 * 0.4 + 0.3 * 0.3)); /* both are alike */
    const double same[2] = {ratio, ratio};
    const Kept first = sum_kept(clash, same);
    const double speed = clash.states()[0].spin;
    clash.run("run 200000");
    const Kept last = sum_kept(clash, same);
    check_at_most("the angles have met", -std::fabs(clash.states()[0].spin - speed), -0.1);
    check_at_most("and are apart", clash.pair_energy(), 0);
    check_at_most("momentum", std::hypot(last.x - first.x, last.y - first.y), 1e-12);
    check_at_most("angular momentum", std::fabs(last.turn - first.turn), 1e-10); /* 2e5 roundings of x, 4e-16 each */
    check_at_most("energy of the angles' collisions", std::fabs(last.energy / first.energy - 1), 1e-3);
}

/* Forces between grains are equal and opposite, so that momentum stays but for roundings of sums. */
void test_momentum() {
    for (const bool newton : {false, true}) {
        Packing packing = make_lattice(20, 20, 1.15, 0.1, 1, 11);
        packing.types = 4;
        for (size_t i = 0; i < packing.grains.size(); i++)
            packing.grains[i].type = 1 + static_cast<int>(i % 4);
        Simulation simulation(MPI_COMM_WORLD);
        simulation.create(packing, "p p p", newton);
        simulation.run(grains("ellipse8 ell dimer pebble8", "narc/hooke/history 1e4 NULL 50 NULL 0.5 1") +
                       "timestep 2e-4\nrun 0");
        double momentum[2] = {0, 0}, scale = 0;
        for (const State &s : simulation.states()) {
            momentum[0] -= s.mass * s.velocity_x;
            momentum[1] -= s.mass * s.velocity_y;
            scale += s.mass * std::hypot(s.velocity_x, s.velocity_y);
        }
        simulation.run("run 1000");
        for (const State &s : simulation.states()) {
            momentum[0] += s.mass * s.velocity_x;
            momentum[1] += s.mass * s.velocity_y;
        }
        check_at_most("momentum gained in 1000 steps", std::hypot(momentum[0], momentum[1]), 1e-12 * scale);
    }
}

/* Without damping and friction energy stays. A step of velocity Verlet errs by some (w dt)^2 / 24 of what is in the
 * springs, w^2 = 2 kn / m and w dt = 0.02 here: 2e-5; separations are single precision, 1e-7 of kn overlap^2. Grains
 * are pressed together by a seventh of their size, but for those with sides, which such an overlap is as long as. */
void check_energy(const std::string &shape, const std::string &law, const std::string &kn, double fill) {
    const Packing packing = make_lattice(20, 20, fill, 0.1, 1, 13);
    Simulation simulation(MPI_COMM_WORLD);
    simulation.create(packing);
    simulation.run(grains(shape, "narc/" + law + "/history " + kn + " 0 0 0 0 0") + "timestep 1e-4\nrun 0");
    const double kinetic = kinetic_energy(simulation), before = kinetic + simulation.pair_energy();
    double most_elastic = before - kinetic;
    for (int i = 0; i < 20; i++) {
        simulation.run("run 500");
        most_elastic = std::fmax(most_elastic, simulation.pair_energy());
    }
    const double after = kinetic_energy(simulation) + simulation.pair_energy();
    check_at_most((law + ", " + shape + ": energy gained or lost").c_str(), std::fabs(after / before - 1), 1e-4);
    check_at_most("the energy that stayed has been in springs", -most_elastic / before, fill > 1 ? -0.1 : -1e-3);
}

void test_energy() {
    check_energy("ellipse8", "hooke", "1e4", 1.15);
    check_energy("pebble8", "hertz", "1e4", 1.15);
    check_energy("octagon", "hooke", "1e4", 0.9);
    check_energy("octagon", "hertz", "3e5", 0.9);
}

/* ---------------------------------------------------------------------------- against itself */

/* Dense grains that drift, so that many go from rank to rank while they touch others. */
Packing make_drifting(unsigned seed) {
    Packing packing = make_lattice(20, 20, 1.15, 0.1, 1, seed);
    packing.types = 2;
    for (Grain &grain : packing.grains) {
        grain.type = grain.angle > 5 ? 2 : 1;
        grain.velocity_x += 13;
        grain.velocity_y += 7;
    }
    return packing;
}

std::vector<State> run_piece(MPI_Comm world, bool newton, const Packing &packing) {
    Simulation simulation(world);
    simulation.create(packing, "p p p", newton);
    simulation.run(grains("pebble8 ell", "narc/hooke/history 1e4 NULL 50 NULL 0.5 1 rolling 0.1") +
                   "timestep 2e-4\nrun 500");
    return simulation.states();
}

/* The same pairs have the same bits on any ranks, so that only the order of sums differs, and what differs by a
 * rounding of double precision may be rounded to another float: 1e-7 of a grain, times what 500 steps make of it. */
void test_ranks() {
    int rank, size;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    const Packing packing = make_drifting(17);
    const std::vector<State> alone = run_piece(MPI_COMM_SELF, false, packing);
    for (int count = 2; count <= size; count *= 2) {
        for (const bool newton : {false, true}) {
            MPI_Comm part;
            MPI_Comm_split(MPI_COMM_WORLD, rank / count, rank, &part);
            const Difference at = compare(run_piece(part, newton, packing), alone, packing.width, packing.height);
            const std::string what = std::to_string(count) + " ranks, newton " + (newton ? "on" : "off");
            check_at_most((what + ": positions").c_str(), at.position, 1e-6);
            check_at_most((what + ": angles").c_str(), at.angle, 1e-6);
            check_at_most((what + ": velocities").c_str(), at.velocity, 1e-4);
            MPI_Comm_free(&part);
        }
    }
}

/* A cell that is sheared further than it is wide by half gets another tilt, with the same images. */
void test_flips() {
    const Packing packing = make_lattice(10, 10, 1.15, 0.1, 1, 41);
    const auto shear = [&](Simulation &cell, const std::string &flip) {
        cell.create(packing);
        cell.run("change_box all triclinic");
        cell.run(grains("pebble8", "narc/hooke/history 1e4 NULL 50 NULL 0.5 1") +
                 "fix shear all deform 1 xy erate 1 flip " + flip + " remap v\ntimestep 2e-4\nrun 3500");
    };
    Simulation flips(MPI_COMM_WORLD), tilts(MPI_COMM_WORLD);
    shear(flips, "yes");
    shear(tilts, "no");
    check_at_most("one tilt", std::fabs(tilts.variable("xy") - 7), 1e-9);
    check_at_most("the other", std::fabs(flips.variable("xy") + 3), 1e-9);
    const Difference at = compare(flips.states(), tilts.states(), packing.width, packing.height);
    check_at_most("velocities after a flip", at.velocity, 1e-6);
    check_at_most("spins after a flip", at.spin, 1e-6);
    check_at_most("angles after a flip", at.angle, 1e-6);
}

/* A run that was broken off goes on as if it were not: the memory of contacts is in the restart file. */
void test_restart() {
    const std::string file = "test.restart";
    Packing packing = make_lattice(20, 20, 1.15, 0.1, 0.2, 23);
    packing.types = 2;
    for (Grain &grain : packing.grains)
        grain.type = grain.angle > 3 ? 2 : 1;
    const std::string wall = "fix floor all wall/narc hooke/history 1e4 NULL 50 NULL 0.5 1 plate 10 1 0.1 1 "
                             "velocity 0 0.5\nfix vane all wall/narc hooke/history 1e4 NULL 50 NULL 0.5 1 rolling 0.1 "
                             "box 10 10 3 1 20 spin 5 11 10\n";
    Simulation whole(MPI_COMM_WORLD);
    whole.create(packing, "p f p", true);
    whole.run(grains("pebble8 ell", "narc/hooke/history 1e3 NULL 5 NULL 0.1 1") +
              "pair_coeff * * 1e4 NULL 50 NULL 0.5 1 rolling 0.1\n" + wall +
              "fix ceiling all wall/narc hooke/history 1e4 NULL 50 NULL 0.5 1 plate 10 20 0 -1\ntimestep 2e-4\n"
              "run 500\nwrite_restart " +
              file + "\nrun 500");
    Simulation rest(MPI_COMM_WORLD);
    rest.run("atom_modify map array\nread_restart " + file + "\n" + tracking + "comm_modify vel yes\n" +
             "fix shapes all narc/shapes " + shapes_file + " pebble8 ell density 1\nfix nve all narc/nve\n" + wall +
             "fix ceiling all wall/narc hooke/history 1e4 NULL 50 NULL 0.5 1 plate 10 20 0 -1\ntimestep 2e-4\n"
             "run 0");
    rest.run("run 500");
    const Difference at = compare(rest.states(), whole.states(), packing.width, packing.height);
    check_at_most("positions after a restart", at.position, 1e-6);
    check_at_most("angles after a restart", at.angle, 1e-6);
    check_at_most("forces after a restart", at.force, 1e-2);
    check_at_most("travel of the wall after a restart", std::fabs(rest.variable("f_floor[4]") - 0.1), 1e-12);
    std::remove(file.c_str());
}

/* ---------------------------------------------------------------------------- walls */

/* A heap of discs, 4-arcs and 8-arcs between a plate and two boxes comes to rest: walls and floor carry its weight. */
void test_walls() {
    Packing packing = make_lattice(8, 10, 0.9, 0.1, 0.3, 29);
    packing.types = 4;
    for (size_t i = 0; i < packing.grains.size(); i++)
        packing.grains[i].type = 1 + static_cast<int>(i % 4);
    packing.width = 8;
    const std::string coefficients = "hertz/history 2e4 NULL 200 NULL 0.5 1 ";
    Simulation heap(MPI_COMM_WORLD);
    heap.create(packing, "f f p");
    const std::string wall = " all wall/narc " + coefficients;
    heap.run(grains("disc ellipse4 ellipse8 pebble8", "narc/" + coefficients));
    heap.run("fix floor" + wall + "plate 0 0.1 0 1");
    heap.run("fix left" + wall + "box -0.9 5 2 30 0");
    heap.run("fix right" + wall + "box 8.9 5 30 2 90");
    heap.run("fix gravity all gravity 1 vector 0 -1 0\nfix slow all viscous 0.5\ntimestep 1e-3\nrun 40000");
    double weight = 0, sideways = 0, lowest = 1e9, fastest = 0;
    for (const State &s : heap.states()) {
        weight += s.mass;
        lowest = std::fmin(lowest, s.y);
        sideways = std::fmax(sideways, std::fabs(s.x - 4));
        fastest = std::fmax(fastest, std::hypot(s.velocity_x, s.velocity_y));
    }
    check_at_most("the heap rests", fastest, 1e-3);
    check_at_most("no grain is below the floor", 0.1 - lowest, 0);
    check_at_most("no grain is in a wall", sideways, 4);
    const double lift = heap.variable("f_left[2]") + heap.variable("f_right[2]") + heap.variable("f_floor[2]");
    check_at_most("walls and floor carry the weight", std::fabs(lift / weight + 1), 1e-3);
    const double push = heap.variable("f_left[1]") + heap.variable("f_right[1]") + heap.variable("f_floor[1]");
    check_at_most("and push sideways as little", std::fabs(push / weight), 1e-3);
}

/* A floor of grains that are frozen carries the weight of those that fall on it; with a velocity it moves. */
void test_rough() {
    Packing packing = make_lattice(8, 8, 0.95, 0.1, 0, 47);
    Simulation heap(MPI_COMM_WORLD);
    heap.create(packing, "f f p");
    const std::string law = "hooke/history 2e4 NULL 200 NULL 0 1 ";
    heap.run(grains("octagon_sharp", "narc/hooke/history 2e4 NULL 200 NULL 0.5 1"));
    heap.run("fix left all wall/narc " + law + "plate 0 0 1 0\nfix right all wall/narc " + law + "plate 8 0 -1 0");
    heap.run("group floor id 1:8\nfix gravity all gravity 1 vector 0 -1 0\nfix slow all viscous 0.5\n"
             "fix hold floor freeze\ntimestep 1e-3\nrun 40000");
    double weight = 0;
    for (const State &s : heap.states())
        weight += s.mass;
    check_at_most("the floor carries the weight", std::fabs(heap.variable("f_hold[2]") / weight + 1), 1e-4);
    const double before = heap.states()[0].x;
    heap.run("velocity floor set 0.1 NULL NULL\nrun 1000");
    check_at_most("and moves", std::fabs(heap.states()[0].x - before - 0.1), 1e-12);
}

/* On a chain of nine pieces a disc without friction keeps its speed; in a bowl, a concave arc, it is a pendulum of the length
 * R - r. */
void test_ground() {
    const double pi = std::acos(-1.0);
    std::ofstream file("ground.json");
    file.precision(17);
    file << "{\"shapes\": [{\"name\": \"flat\", \"chain\": {\"closed\": false, \"arcs\": [";
    for (int k = 0; k < 9; k++)
        file << (k ? ", " : "") << "{\"center\": [" << 24 - 3 * k << ", 0], \"radius\": 0, \"start\": " << pi / 2
             << ", \"end\": " << pi / 2 << "}";
    file << "]}}, {\"name\": \"bowl\", \"chain\": {\"closed\": false, \"arcs\": [{\"center\": [0, 0], \"radius\": -5, "
         << "\"start\": " << 0.9 * pi << ", \"end\": " << 0.1 * pi << "}]}}]}\n";
    file.close();
    for (const bool bowl : {false, true}) {
        const double h = pi / 4 / 1e5, begin = 0.05, length = 4.5;
        const Grain on_flat = {1, 1.5, 2.5 - h, 0.5, 0, 1, 0, 0};
        const Grain in_bowl = {1, 12 + length * std::sin(begin), 12 - length * std::cos(begin), 0.5, 0, 0, 0, 0};
        Packing packing = {24, 24, {bowl ? in_bowl : on_flat}};
        Simulation one(MPI_COMM_WORLD);
        one.create(packing, "f f p");
        const std::string law = "hooke/history 1e5 NULL 0 NULL 0 0";
        const double time = bowl ? pi * std::sqrt(length) * (1 + begin * begin / 16) : 20;
        one.run(grains("disc", "narc/" + law) + "fix ground all wall/narc " + law + " chain ground.json " +
                (bowl ? "bowl 12 12 0\n" : "flat 0 2 0\n") +
                "fix gravity all gravity 1 vector 0 -1 0\ntimestep 5e-4\nrun " +
                std::to_string(static_cast<int>(time / 5e-4 + 0.5)));
        const State s = one.states()[0];
        if (bowl)
            check_at_most("half a swing in a bowl", std::fabs(s.x - 12 + length * std::sin(begin)), 1e-3);
        else
            check_at_most("speed on a chain", std::fabs(s.velocity_x - 1), 1e-9);
    }
}

/* Two discs rest where the spring bears the cohesion, and do not pull further apart than its range. */
void test_cohesion() {
    for (const double gap : {-0.01, 0.01, 0.03}) {
        Packing packing = {10, 10, {{1, 4, 5, 0.5, 0, 0, 0, 0}, {1, 5 + gap, 5, 0.5, 0, 0, 0, 0}}};
        Simulation both(MPI_COMM_WORLD);
        both.create(packing);
        both.run(grains("disc", "narc/hooke/history 1000 NULL 0 NULL 0.5 1 cohesion 10 0.02") + "run 0");
        check_at_most("cohesion", std::fabs(both.states()[0].force_x - (gap < 0 ? 0 : gap < 0.02 ? 5 : 0)), 1e-9);
    }
}

/* A gas with friction and without dashpots: with the rescaled law its energy only falls. */
void test_mindlin() {
    Packing packing = make_lattice(10, 10, 0.9, 0.1, 1, 5);
    Simulation gas(MPI_COMM_WORLD);
    gas.create(packing);
    gas.run(grains("disc", "narc/mindlin/rescale 1e5 1e5 0 NULL 50 0") + "timestep 1e-4\nrun 1");
    double before = kinetic_energy(gas) + gas.pair_energy(), most = 0;
    const double first = before;
    for (int k = 0; k < 40; k++) {
        gas.run("run 500 pre no post no");
        const double now = kinetic_energy(gas) + gas.pair_energy();
        most = std::max(most, now - before);
        before = now;
    }
    check_at_most("energy from friction", most / first, 1e-3);
    check_at_most("energy that is left", before / first, 0.99);
}

/* A disc in a pocket of three boxes that turn about a point goes round with them: it has the velocity w r, the spin w,
 * and the walls' force on it is m w^2 r towards the point. Its spring is m w^2 r / kn = 1e-5
 * deep, and friction acts so much from the surface. */
void test_turning() {
    const double w = 2, r = 3, time = 4, pi = std::acos(-1.0);
    Packing packing = {20, 20, {{1, 10 + r, 10, 0.5, 0, 0, w * r, w}}};
    Simulation pocket(MPI_COMM_WORLD);
    pocket.create(packing, "f f p");
    const std::string law = "hooke/history 1e6 NULL 50 NULL 0.5 1";
    const std::string turn = " 0 spin 2 10 10\n";
    pocket.run(grains("disc", "narc/" + law) + "fix out all wall/narc " + law + " box 14 10 1 3" + turn +
               "fix left all wall/narc " + law + " box 13 10.99999 3 1" + turn + "fix right all wall/narc " + law +
               " box 13 9.00001 3 1" + turn + "timestep 1e-4\nrun " + std::to_string(static_cast<int>(time / 1e-4)));
    const State s = pocket.states()[0];
    const double c = std::cos(w * time), y = std::sin(w * time);
    check_at_most("place", std::hypot(s.x - 10 - r * c, s.y - 10 - r * y), 1e-4);
    check_at_most("angle", std::hypot(s.cosine - c, s.sine - y), 1e-3);
    check_at_most("velocity", std::hypot(s.velocity_x + w * r * y, s.velocity_y - w * r * c), 1e-4);
    const double pull = s.mass * w * w * r;
    check_at_most("force", std::hypot(s.force_x + pull * c, s.force_y + pull * y) / pull, 1e-4);
    const char *sum_x = "f_out[1]+f_left[1]+f_right[1]";
    check_at_most("force on the walls", std::fabs(pocket.variable(sum_x) + s.force_x), 1e-12 * pull);
    check_at_most("torque on the walls", std::fabs(pocket.variable("f_out[5]+f_left[5]+f_right[5]")), 1e-4 * pull);
    check_at_most("angle of a wall", std::fabs(pocket.variable("f_out[6]") - w * time), 1e-10);
    check_at_most("half a turn and more", pi, w * time);
}

/* Grains at rest between plates: the virial theorem has the sum of force times arm over all contacts, those with walls
 * too, as the force on a plate times the distance of the plates (contacts lie up to half an overlap beyond them); the
 * forces on each grain have no sum. */
void check_pressed(const char *law) {
    Packing packing = make_lattice(8, 8, 1.2, 0.1, 0.3, 43);
    packing.types = 4;
    for (size_t i = 0; i < packing.grains.size(); i++)
        packing.grains[i].type = 1 + static_cast<int>(i % 4);
    Simulation cell(MPI_COMM_WORLD);
    cell.create(packing, "f f p");
    const std::string coefficients = std::string(law) + "/history 2e4 NULL 100 NULL 0.3 1 ";
    cell.run(grains("disc ell dimer pebble8", "narc/" + coefficients));
    const std::string smooth = std::string(law) + "/history 2e4 NULL 100 NULL 0 1 ";
    for (const char *plate : {"left 0 4 1 0", "right 7.6 4 -1 0", "floor 4 0 0 1", "ceiling 4 7.6 0 -1"}) {
        const std::string text = plate, name = text.substr(0, text.find(' '));
        cell.run("fix " + name + " all wall/narc " + smooth + "plate" + text.substr(name.size()) + "\nfix_modify " +
                 name + " virial yes");
    }
    cell.run("compute rows all narc/contact\ncompute stress all pressure NULL virial\n"
             "thermo_style custom step c_stress[1] c_stress[2]\nfix slow all viscous 2\ntimestep 2e-4\nrun 60000");
    const double wide = 7.6, area = 64, forces[2] = {cell.variable("f_right[1]"), cell.variable("f_ceiling[2]")};
    check_at_most("the cell is pressed", -std::fmin(forces[0], forces[1]), -10);
    LAMMPS_NS::Modify *modify = cell.lammps->modify;
    LAMMPS_NS::Compute *rows = modify->compute[modify->find_compute("rows")];
    rows->compute_local();
    const std::vector<State> states = cell.states();
    std::vector<double> left(3 * states.size(), 0); /* force and torque */
    double strongest = 0, length = 0, deepest = 0;
    for (int k = 0; k < rows->size_local_rows; k++) {
        const double *row = rows->array_local[k];
        strongest = std::fmax(strongest, std::hypot(row[6], row[7]));
        deepest = std::fmax(deepest, row[1] < 0 ? row[8] : 0);
        length = std::fmax(length, std::fabs(std::hypot(row[4], row[5]) - 1));
        for (int end = 0; end < 2; end++) {
            const int id = static_cast<int>(row[end]);
            if (id < 0)
                continue;
            const size_t i = static_cast<size_t>(id) - 1;
            const double sign = end ? 1 : -1, x = row[2] - states[i].x, y = row[3] - states[i].y;
            left[3 * i] += sign * row[6];
            left[3 * i + 1] += sign * row[7];
            left[3 * i + 2] += sign * (x * row[7] - y * row[6]);
        }
    }
    for (const char axis : {'x', 'y'}) {
        const std::string stress = std::string("c_stress[") + (axis == 'x' ? "1]" : "2]");
        const double found = cell.variable(stress) * area / (forces[axis == 'y'] * wide);
        check_at_most((std::string("stress along ") + axis).c_str(), std::fabs(found - 1), deepest / wide);
    }
    double most[2] = {0, 0};
    for (size_t k = 0; k < left.size(); k++)
        most[k % 3 == 2] = std::fmax(most[k % 3 == 2], std::fabs(left[k]));
    check_at_most("normals are of length 1", length, 1e-12);
    check_at_most("forces on a grain, summed", most[0] / strongest, 1e-6);
    check_at_most("torques on a grain, summed: forces act half an overlap from there", most[1] / strongest, 0.02);
}

void test_pressed() {
    check_pressed("hooke");
    check_pressed("hertz");
}

/* Bricks on each other come to rest, where one point for each contact would rock. */
void test_bricks() {
    const double half_height = 0.45 / std::hypot(0.8, 0.45);
    Packing packing = {4, 8, {}};
    for (int i = 0; i < 4; i++)
        packing.grains.push_back({1, 2 + 0.05 * (i % 2), half_height * (2 * i + 1), 1, 0, 0, 0, 0});
    Simulation wall(MPI_COMM_WORLD);
    wall.create(packing, "f f p");
    const std::string law = "hooke/history 1e4 NULL 50 NULL 0.5 1";
    wall.run(grains("brick", "narc/" + law) + "fix floor all wall/narc " + law +
             " plate 0 0 0 1\nfix gravity all gravity 1 vector 0 -1 0\ntimestep 1e-3\nrun 100000");
    double fastest = 0;
    for (const State &s : wall.states())
        fastest = std::fmax(fastest, std::fmax(std::hypot(s.velocity_x, s.velocity_y), std::fabs(s.spin)));
    check_at_most("bricks stand still", fastest, 1e-11);
}

/* Grains that come into an empty box, and large ones to a small one, do not pass through each other. (There is no map:
 * LAMMPS' fix pour of 2021 writes beyond one of style array.) */
void test_pour() {
    for (const bool beside : {false, true}) {
        Simulation heap(MPI_COMM_WORLD);
        heap.run("units lj\ndimension 2\natom_style hybrid sphere dipole\ncomm_modify vel yes\nboundary f f p\n"
                 "newton off\nregion all block 0 8 0 20 -0.5 0.5\ncreate_box 1 all\nmass * 1");
        if (beside)
            heap.run("create_atoms 1 single 1 0.1 0\nset group all diameter 0.2");
        const std::string law = "hooke/history 1e4 NULL 50 NULL 0.5 1";
        heap.run(grains("ellipse8", "narc/" + law) + "fix floor all wall/narc " + law +
                 " plate 0 0 0 1\nfix left all wall/narc " + law + " plate 0 0 1 0\nfix right all wall/narc " + law +
                 " plate 8 0 -1 0\nfix gravity all gravity 1 vector 0 -1 0\nregion above block 1 7 14 18 -0.5 0.5\n"
                 "fix pour all pour 40 1 4767 region above diam one 1 vol 0.4 100 dens 1 1\ntimestep 1e-3\nrun 40000");
        const std::vector<State> all = heap.states();
        const size_t first = beside ? 1 : 0;
        double most = 0;
        check_at_most("grains that are missing", 40 + static_cast<double>(first) - static_cast<double>(all.size()), 0);
        for (size_t i = first; i < all.size(); i++) /* half axes of ellipse8: 0.5, and 0.7 of it */
            for (size_t j = first; j < i; j++)
                most = std::fmax(most, 0.7 - std::hypot(all[i].x - all[j].x, all[i].y - all[j].y));
        check_at_most("how much grains are in each other", most, 0.01);
    }
}

/* ---------------------------------------------------------------------------- other ways */

/* Shapes by atom answer as shapes by type. */
void test_by_atom() {
    Packing packing = make_lattice(10, 10, 1.15, 0.1, 1, 31);
    const std::string law = "narc/hooke/history 1e4 NULL 50 NULL 0.5 1";
    const std::string end = "\npair_coeff * *\nfix nve all narc/nve\ntimestep 2e-4\nrun 200";
    Simulation by_atom(MPI_COMM_WORLD), by_type(MPI_COMM_WORLD);
    by_atom.create(packing);
    by_atom.run(tracking +
                "fix which all property/atom i_which ghost yes\nset group all i_which 1\nset atom 1*50 i_which 2\n"
                "fix shapes all narc/shapes " +
                shapes_file + " ellipse8 pebble8 density 1 shape i_which\npair_style " + law + end);
    packing.types = 2;
    for (size_t i = 0; i < packing.grains.size(); i++)
        packing.grains[i].type = i < 50 ? 2 : 1;
    by_type.create(packing);
    by_type.run(grains("ellipse8 pebble8", law) + "timestep 2e-4\nrun 200");
    const Difference at = compare(by_atom.states(), by_type.states(), packing.width, packing.height);
    check_at_most("positions, shapes by atom and by type", at.position, 0);
}

/* A form's mesh has the form's area, but for what its chords leave out: (0.09)^2 / 12 of the arcs' share of it. */
void test_mesh() {
    Simulation simulation(MPI_COMM_WORLD);
    simulation.create(make_lattice(5, 5, 0.9, 0, 0, 1));
    simulation.run("fix shapes all narc/shapes " + shapes_file + " disc density 1 mesh drawn");
    FILE *file = std::fopen("drawn.disc.obj", "r");
    check_at_most("the mesh is there", file ? 0 : 1, 0);
    std::vector<double> x, y;
    double point[2];
    for (char line[4000]; file && std::fgets(line, sizeof line, file);) {
        if (std::sscanf(line, "v %lf %lf", &point[0], &point[1]) == 2) {
            x.push_back(point[0]);
            y.push_back(point[1]);
        }
    }
    if (file)
        std::fclose(file);
    double area = 0;
    for (size_t i = 0; i < x.size(); i++) {
        const size_t next = (i + 1) % x.size();
        area += 0.5 * (x[i] * y[next] - x[next] * y[i]);
    }
    check_at_most("area of the mesh", std::fabs(area / std::acos(-1.0) - 1), 2e-3);
}

/* The plugin's styles are as good as the program's. */
void test_plugin() {
    const Packing packing = make_lattice(10, 10, 1.15, 0.1, 1, 37);
    const std::string commands =
        grains("pebble8", "narc/hooke/history 1e4 NULL 50 NULL 0.5 1") + "timestep 2e-4\nrun 100";
    Simulation plugged(MPI_COMM_WORLD, false), built_in(MPI_COMM_WORLD);
    void *plugin = dlopen(PLUGIN_FILE, RTLD_NOW | RTLD_LOCAL);
    check_at_most("the plugin loads", plugin ? 0 : 1, 0);
    if (!plugin)
        return;
    using Init = void (*)(void *, void *, void *);
    reinterpret_cast<Init>(dlsym(plugin, "lammpsplugin_init"))(plugged.lammps, plugin, nullptr);
    plugged.create(packing);
    plugged.run(commands);
    built_in.create(packing);
    built_in.run(commands);
    const Difference at = compare(plugged.states(), built_in.states(), packing.width, packing.height);
    check_at_most("positions, plugin and program", at.position, 0);
}

const std::map<std::string, void (*)()> tests = {
    {"discs_hooke", test_discs_hooke},
    {"discs_hertz", test_discs_hertz},
    {"restitution", test_restitution},
    {"momentum", test_momentum},
    {"energy", test_energy},
    {"ranks", test_ranks},
    {"restart", test_restart},
    {"walls", test_walls},
    {"rough", test_rough},
    {"ground", test_ground},
    {"cohesion", test_cohesion},
    {"mindlin", test_mindlin},
    {"flips", test_flips},
    {"by_atom", test_by_atom},
    {"plugin", test_plugin},
    {"bricks", test_bricks},
    {"pour", test_pour},
    {"mesh", test_mesh},
    {"hertz", test_hertz},
    {"rolling", test_rolling},
    {"clumps", test_clumps},
    {"turning", test_turning},
    {"pressed", test_pressed},
};

} // namespace

int main(int count, char **arguments) {
    MPI_Init(&count, &arguments);
    const auto test = count == 2 ? tests.find(arguments[1]) : tests.end();
    if (test == tests.end()) {
        std::fprintf(stderr, "usage: test_lammps TEST\n");
        for (const auto &known : tests)
            std::fprintf(stderr, "  %s\n", known.first.c_str());
        MPI_Finalize();
        return 2;
    }
    test->second();
    MPI_Finalize();
    return failures ? 1 : 0;
}
