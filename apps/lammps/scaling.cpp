/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * scaling.cpp - where the time of a step goes on several ranks, and what that makes of many more.
 *   mpirun -np R scaling [--grains N] [--steps N] [--rounds N] [--out FILE]    prints a row, or adds it to FILE
 *   scaling --model FILE                                                        prints FILE, and the model from it
 *
 * Each rank has N grains, so that work and communication of a rank stay what they are while ranks become more (weak
 * scaling). The grains are 8-arcs in a dense periodic box that collide. scaling.md explains the model.
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

/* What the model takes of the network; scaling.md says why. */
constexpr double latency = 2e-6;  /* seconds a message */
constexpr double bandwidth = 1e9; /* bytes a second and rank */

/* A measurement. Times in nanoseconds a grain of the rank and step, the rest a rank and step. */
struct Row {
    int ranks;
    double grains, pair, neighbour, modify, communication, rest, ghosts, bytes, messages;
};

const char *const row_format = "%d %lf %lf %lf %lf %lf %lf %lf %lf %lf\n";

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

std::vector<Row> read_rows(const char *path) {
    std::vector<Row> rows;
    FILE *file = std::fopen(path, "r");
    for (Row r; file && std::fscanf(file, row_format, &r.ranks, &r.grains, &r.pair, &r.neighbour, &r.modify,
                                    &r.communication, &r.rest, &r.ghosts, &r.bytes, &r.messages) == 10;)
        rows.push_back(r);
    if (file)
        std::fclose(file);
    return rows;
}

void print_rows(const std::vector<Row> &rows) {
    std::printf("\n| ranks | grains a rank | pair | neighbour | modify | communication | rest | ns a grain and step | "
                "ghosts a rank | messages a step | bytes a step | bytes a ghost |\n"
                "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const Row &r : rows)
        std::printf("| %d | %.0f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.0f | %.1f | %.0f | %.1f |\n", r.ranks,
                    r.grains, r.pair, r.neighbour, r.modify, r.communication, r.rest,
                    r.pair + r.neighbour + r.modify + r.communication + r.rest, r.ghosts, r.messages, r.bytes,
                    r.bytes / r.ghosts);
}

/* The time of a step with n grains on each of R ranks: n times the work of a grain, g = c sqrt(n) ghosts that are
 * packed and sent, messages, and the one sum over all ranks that decides about new neighbour lists. */
void print_model(const Row &alone, double bytes_per_ghost) {
    const double work = 1e-9 * (alone.pair + alone.neighbour + alone.modify + alone.rest);
    const double ghosts_per_root = alone.ghosts / std::sqrt(alone.grains);
    const double packing = 1e-9 * alone.communication * alone.grains / alone.ghosts;
    std::printf("\nwork %.1f ns a grain, ghosts %.2f sqrt(grains), %.0f ns and %.0f bytes a ghost; assumed %.0f us a "
                "message, %.0f GB/s a rank\n\n",
                1e9 * work, ghosts_per_root, 1e9 * packing, bytes_per_ghost, 1e6 * latency, 1e-9 * bandwidth);
    std::printf("| grains | ranks | a rank | work | ghosts packed | bytes | messages | sum over ranks | ms a step | "
                "efficiency | rules |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n");
    for (double grains = 1e6; grains < 2e9; grains *= 10) {
        for (double ranks = 1; ranks <= 100000; ranks *= 10) {
            const double n = grains / ranks, ghosts = ghosts_per_root * std::sqrt(n);
            if (n < 100 || n > 1e7)
                continue;
            const bool one = ranks == 1;
            const double terms[] = {n * work, ghosts * packing, one ? 0 : ghosts * bytes_per_ghost / bandwidth,
                                    one ? 0 : 4 * latency, latency * std::log2(ranks)};
            const char *const names[] = {"work", "ghosts packed", "bytes", "messages", "sum over ranks"};
            double sum = 0;
            for (const double term : terms)
                sum += term;
            const size_t most = static_cast<size_t>(std::max_element(terms, terms + 5) - terms);
            std::printf("| %.0e | %.0f | %.0f | %.4f | %.4f | %.4f | %.4f | %.4f | %.4f | %.0f %% | %s |\n", grains,
                        ranks, n, 1e3 * terms[0], 1e3 * terms[1], 1e3 * terms[2], 1e3 * terms[3], 1e3 * terms[4],
                        1e3 * sum, 100 * terms[0] / sum, names[most]);
        }
    }
}

/* Times of the row on one rank, bytes of the row with most ranks, where every ghost comes from another rank. */
int model(const char *path) {
    const std::vector<Row> rows = read_rows(path);
    const Row *alone = nullptr, *most = nullptr;
    for (const Row &row : rows) {
        alone = row.ranks == 1 ? &row : alone;
        most = !most || row.ranks > most->ranks ? &row : most;
    }
    if (!alone || most->ranks < 4) {
        std::fprintf(stderr, "scaling: %s: rows of 1 and of 4 or more ranks are wanted\n", path);
        return 2;
    }
    print_rows(rows);
    print_model(*alone, most->bytes / most->ghosts);
    return 0;
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
    const char *out = nullptr, *table = nullptr;
    for (int i = 1; i + 1 < count; i += 2) {
        const char *value = arguments[i + 1];
        if (!std::strcmp(arguments[i], "--grains"))
            grains = std::atoi(value);
        else if (!std::strcmp(arguments[i], "--steps"))
            steps = std::atoi(value);
        else if (!std::strcmp(arguments[i], "--rounds"))
            rounds = std::atoi(value);
        else if (!std::strcmp(arguments[i], "--out"))
            out = value;
        else if (!std::strcmp(arguments[i], "--model"))
            table = value;
    }
    if (table)
        return model(table);
    const int side = static_cast<int>(std::lround(std::sqrt(grains)));
    if (count % 2 == 0 || side < 10 || steps < 1 || rounds < 1) {
        std::fprintf(stderr, "usage: scaling [--grains N] [--steps N] [--rounds N] [--out FILE] | --model FILE\n");
        return 2;
    }
    MPI_Init(&count, &arguments);
    const Row r = measure(side, steps, rounds);
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) {
        FILE *file = out ? std::fopen(out, "a") : nullptr;
        if (!file) {
            print_rows({r});
        } else {
            std::fprintf(file, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", r.ranks, r.grains, r.pair,
                         r.neighbour, r.modify, r.communication, r.rest, r.ghosts, r.bytes, r.messages);
            std::fclose(file);
        }
    }
    MPI_Finalize();
    return 0;
}
