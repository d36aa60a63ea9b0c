/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * scaling.cpp - where the time of a step goes on several ranks.
 *   mpirun -np R scaling [--grains N] [--steps N] [--rounds N]    prints a row of a table, its head where R is 1
 *
 * Each rank has N grains, so that work and communication of a rank stay what they are while ranks become more (weak
 * scaling). The grains are 8-arcs in a dense periodic box that collide.
 */
#include <cstdio>

#include "atom.h"
#include "measure.h"

namespace {

long long sent_bytes = 0, sent_messages = 0;

void measure(const Sizes &sizes) {
    int ranks, rank, shape[2] = {0, 0};
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Dims_create(ranks, 2, shape);
    Simulation simulation(MPI_COMM_WORLD);
    simulation.create(make_lattice(sizes.side * shape[0], sizes.side * shape[1], 1.15, 0.1, 0.3, 5));
    simulation.run(std::string("neighbor 0.1 bin\nneigh_modify delay 0 every 1 check yes\n") +
                   "fix shapes all narc/shapes " + GRAINS_FILE + " pebble8 density 1\n" +
                   "pair_style narc/hooke/history 1e4 NULL 20 NULL 0.5 1\npair_coeff * *\nfix nve all narc/nve\n" +
                   "timestep 5e-4\nthermo 1000000\ntimer full\nrun 400");
    const double grains = mean_of_ranks(simulation.lammps->atom->nlocal);
    std::vector<double> times[section_count];
    double bytes = 0, messages = 0, ghosts = 0;
    for (int round = 0; round < sizes.rounds; round++) {
        sent_bytes = sent_messages = 0;
        simulation.run("run " + std::to_string(sizes.steps) + " post no");
        bytes += mean_of_ranks(static_cast<double>(sent_bytes)) / sizes.steps / sizes.rounds;
        messages += mean_of_ranks(static_cast<double>(sent_messages)) / sizes.steps / sizes.rounds;
        ghosts += mean_of_ranks(simulation.lammps->atom->nghost) / sizes.rounds;
        add_times(simulation, 1e9 / (grains * sizes.steps), times);
    }
    if (rank != 0)
        return;
    if (ranks == 1)
        std::printf(
            "\n| ranks | grains a rank | pair | neighbour | modify | communication | rest | ns a grain and step "
            "| ghosts a rank | messages a step | bytes a step | bytes a ghost |\n"
            "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    std::printf("| %d | %.0f ", ranks, grains);
    print_times(times);
    std::printf("| %.0f | %.1f | %.0f | %.1f |\n", ghosts, messages, bytes, bytes / ghosts);
}

} // namespace

/* LAMMPS' calls come by here. Sends to the own rank are none: it copies those itself. */
extern "C" int MPI_Send(const void *data, int count, MPI_Datatype type, int to, int tag, MPI_Comm world) {
    int size;
    MPI_Type_size(type, &size);
    sent_bytes += 1LL * size * count;
    sent_messages++;
    return PMPI_Send(data, count, type, to, tag, world);
}

int main(int count, char **arguments) {
    const Sizes sizes = read_sizes("scaling", count, arguments);
    MPI_Init(&count, &arguments);
    measure(sizes);
    MPI_Finalize();
    return 0;
}
