/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * check.h - what tests claim, counted.
 */
#ifndef NARC_LAMMPS_TESTS_CHECK_H
#define NARC_LAMMPS_TESTS_CHECK_H

#include <cmath>
#include <cstdio>
#include <vector>

#include "simulation.h"

extern int failures;

/* `value` is at most `bound`, and a number. Rank 0 prints it. */
void check_at_most(const char *what, double value, double bound);

/* Largest differences of two states; positions across periodic borders. */
struct Difference {
    double position, angle, velocity, spin, force, torque;
};
Difference compare(const std::vector<State> &a, const std::vector<State> &b, double width, double height);

#endif
