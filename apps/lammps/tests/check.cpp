/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * check.cpp - what tests claim, counted.
 */
#include "check.h"

int failures = 0;

void check_at_most(const char *what, double value, double bound) {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const bool good = value <= bound;
    failures += !good;
    if (rank == 0)
        std::printf("%s  %s: %.3g, at most %.3g\n", good ? "ok    " : "FAILED", what, value, bound);
}

Difference compare(const std::vector<State> &a, const std::vector<State> &b, double width, double height) {
    Difference most = {};
    const auto grow = [](double &so_far, double value) { so_far = value > so_far || value != value ? value : so_far; };
    for (size_t i = 0; i < a.size(); i++) {
        grow(most.position,
             std::hypot(std::remainder(a[i].x - b[i].x, width), std::remainder(a[i].y - b[i].y, height)));
        grow(most.angle, std::hypot(a[i].cosine - b[i].cosine, a[i].sine - b[i].sine));
        grow(most.velocity, std::hypot(a[i].velocity_x - b[i].velocity_x, a[i].velocity_y - b[i].velocity_y));
        grow(most.spin, std::fabs(a[i].spin - b[i].spin));
        grow(most.force, std::hypot(a[i].force_x - b[i].force_x, a[i].force_y - b[i].force_y));
        grow(most.torque, std::fabs(a[i].torque - b[i].torque));
    }
    return most;
}
