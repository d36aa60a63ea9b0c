/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * simulation.h - an instance of LAMMPS for tests and measurements: commands in, the state of all grains out.
 */
#ifndef NARC_LAMMPS_TESTS_SIMULATION_H
#define NARC_LAMMPS_TESTS_SIMULATION_H

#include <string>
#include <vector>

#include <mpi.h>

namespace LAMMPS_NS {
class LAMMPS;
}

struct Grain {
    int type;
    double x, y, radius;
    double angle;
    double velocity_x, velocity_y, spin;
};

/* A rectangle with grains. */
struct Packing {
    double width, height;
    std::vector<Grain> grains;
    int types = 1;
};

/* What is known of a grain after some steps. `mass` and `inertia` only where fix narc/shapes knows them. */
struct State {
    double x, y, cosine, sine;
    double velocity_x, velocity_y, spin;
    double force_x, force_y, torque;
    double mass;
};

class Simulation {
  public:
    explicit Simulation(MPI_Comm ranks, bool with_styles = true);
    ~Simulation();
    Simulation(const Simulation &) = delete;
    Simulation &operator=(const Simulation &) = delete;

    /* Runs commands, one a line. */
    void run(const std::string &commands);

    /* Box, atoms and what all tests have in common; `boundary` as of LAMMPS. Of atom style sphere there is no rotation. */
    void create(const Packing &packing, const std::string &boundary = "p p p", bool newton = false,
                const std::string &atom_style = "hybrid sphere dipole");

    std::vector<State> states() const;
    double pair_energy() const;
    double variable(const std::string &expression);

    LAMMPS_NS::LAMMPS *lammps;

  private:
    MPI_Comm world;
};

/* Grains on a square lattice of `columns` by `rows`, turned and moved at random, periodic. `fill` is the grains'
 * diameter in lattice constants of 1, and radii vary by `spread` of it; speeds are up to `speed`. */
Packing make_lattice(int columns, int rows, double fill, double spread, double speed, unsigned seed);

#endif
