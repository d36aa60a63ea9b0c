/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * measure.h - what both measurements have in common.
 */
#ifndef NARC_LAMMPS_MEASURE_H
#define NARC_LAMMPS_MEASURE_H

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "lammps.h"
#include "simulation.h"
#include "timer.h"

/* What the time of a step goes to. */
enum { pair, neighbour, modify, communication, rest, whole, section_count };

struct Sizes {
    int side, steps, rounds; /* grains: side times side */
};

/* Of the command's arguments: [--grains N] [--steps N] [--rounds N]. */
inline Sizes read_sizes(const char *program, int count, char **arguments) {
    int grains = 10000, steps = 200, rounds = 7;
    bool good = count % 2 == 1;
    for (int i = 1; i + 1 < count; i += 2) {
        const char *names[] = {"--grains", "--steps", "--rounds"};
        int *const values[] = {&grains, &steps, &rounds};
        const auto found =
            std::find_if(names, names + 3, [&](const char *name) { return !std::strcmp(arguments[i], name); });
        good = good && found != names + 3;
        if (good)
            *values[found - names] = std::atoi(arguments[i + 1]);
    }
    const int side = static_cast<int>(std::lround(std::sqrt(std::max(grains, 0))));
    if (!good || side < 10 || steps < 1 || rounds < 1) {
        std::fprintf(stderr, "usage: %s [--grains N] [--steps N] [--rounds N]\n", program);
        std::exit(2);
    }
    return {side, steps, rounds};
}

inline double mean_of_ranks(double value) {
    int ranks;
    double sum;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Allreduce(&value, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum / ranks;
}

/* The processor's time for the last run in some unit, which after `timer full` LAMMPS has, and which does not count what
 * else the machine does. */
inline void add_times(const Simulation &simulation, double unit, std::vector<double> *times) {
    using LAMMPS_NS::Timer;
    const auto spent = [&](Timer::ttype section) {
        return unit * mean_of_ranks(simulation.lammps->timer->get_cpu(section));
    };
    double row[section_count] = {spent(Timer::PAIR), spent(Timer::NEIGH), spent(Timer::MODIFY), spent(Timer::COMM)};
    row[whole] = spent(Timer::TOTAL);
    row[rest] = row[whole] - row[pair] - row[neighbour] - row[modify] - row[communication];
    for (int k = 0; k < section_count; k++)
        times[k].push_back(row[k]);
}

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/* A row's columns. */
inline void print_times(const std::vector<double> *times) {
    for (int k = 0; k < section_count; k++)
        std::printf("| %.1f ", median(times[k]));
}

#endif
