/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * scaling.cpp - where the time of a step goes on several ranks.
 *   mpirun -np R scaling [--grains N] [--steps N] [--rounds N]    prints a row of a table, its head where R is 1
 *
 * Each rank has N grains, so that work and communication of a rank stay what they are while ranks become more (weak
 * scaling). The grains are 8-arcs in a dense periodic box that collide.
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "atom.h"
#include "lammps.h"
#include "simulation.h"
#include "timer.h"

namespace {

long long sent_bytes = 0, sent_messages = 0;

/* A measurement. Times in nanoseconds a grain of the rank and step, the rest a rank and step. */
struct Row {
    int ranks;
    double grains, pair, neighbour, modify, communication, rest, ghosts, bytes, messages;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double mean_of_ranks(double value) {
    int ranks;
    double sum;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Allreduce(&value, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum / ranks;
}

Row measure(int side, int steps, int rounds) {
    using LAMMPS_NS::Timer;
    Row row = {};
    MPI_Comm_size(MPI_COMM_WORLD, &row.ranks);
    int shape[2] = {0, 0};
    MPI_Dims_create(row.ranks, 2, shape);
    Simulation simulation(MPI_COMM_WORLD);
    simulation.create(make_lattice(side * shape[0], side * shape[1], 1.15, 0.1, 0.3, 5));
    simulation.run(std::string("neighbor 0.1 bin\nneigh_modify delay 0 every 1 check yes\n") +
                   "fix shapes all narc/shapes " + GRAINS_FILE + " pebble8 density 1\n" +
                   "pair_style narc/hooke/history 1e4 NULL 20 NULL 0.5 1\npair_coeff * *\nfix nve all narc/nve\n" +
                   "timestep 5e-4\nthermo 1000000\nrun 400");
    std::vector<double> times[5];
    const int sections[] = {Timer::PAIR, Timer::NEIGH, Timer::MODIFY, Timer::COMM, Timer::TOTAL};
    row.grains = mean_of_ranks(simulation.lammps->atom->nlocal);
    for (int round = 0; round < rounds; round++) {
        sent_bytes = sent_messages = 0;
        simulation.run("run " + std::to_string(steps) + " post no");
        row.bytes += mean_of_ranks(static_cast<double>(sent_bytes)) / steps / rounds;
        row.messages += mean_of_ranks(static_cast<double>(sent_messages)) / steps / rounds;
        row.ghosts += mean_of_ranks(simulation.lammps->atom->nghost) / rounds;
        for (int k = 0; k < 5; k++)
            times[k].push_back(1e9 * mean_of_ranks(simulation.seconds_of(sections[k])) / (row.grains * steps));
    }
    row.pair = median(times[0]);
    row.neighbour = median(times[1]);
    row.modify = median(times[2]);
    row.communication = median(times[3]);
    row.rest = median(times[4]) - row.pair - row.neighbour - row.modify - row.communication;
    return row;
}

void print_row(const Row &r) {
    if (r.ranks == 1)
        std::printf(
            "\n| ranks | grains a rank | pair | neighbour | modify | communication | rest | ns a grain and step | "
            "ghosts a rank | messages a step | bytes a step | bytes a ghost |\n"
            "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    std::printf("| %d | %.0f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.0f | %.1f | %.0f | %.1f |\n", r.ranks,
                r.grains, r.pair, r.neighbour, r.modify, r.communication, r.rest,
                r.pair + r.neighbour + r.modify + r.communication + r.rest, r.ghosts, r.messages, r.bytes,
                r.bytes / r.ghosts);
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
    int grains = 10000, steps = 200, rounds = 7;
    for (int i = 1; i + 1 < count; i += 2) {
        const char *value = arguments[i + 1];
        if (!std::strcmp(arguments[i], "--grains"))
            grains = std::atoi(value);
        else if (!std::strcmp(arguments[i], "--steps"))
            steps = std::atoi(value);
        else if (!std::strcmp(arguments[i], "--rounds"))
            rounds = std::atoi(value);
    }
    const int side = static_cast<int>(std::lround(std::sqrt(grains)));
    if (count % 2 == 0 || side < 10 || steps < 1 || rounds < 1) {
        std::fprintf(stderr, "usage: scaling [--grains N] [--steps N] [--rounds N]\n");
        return 2;
    }
    MPI_Init(&count, &arguments);
    const Row r = measure(side, steps, rounds);
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0)
        print_row(r);
    MPI_Finalize();
    return 0;
}
