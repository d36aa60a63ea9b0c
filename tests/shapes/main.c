/* SPDX-License-Identifier: MIT
 *
 * main.c - shapes: validation, builders, derived quantities and the store.
 */
#include <math.h>

#include "support.h"
#include "tests.h"

void expect_near(double value, double expected, double tolerance, const char *what) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s is %.17g, expected %.17g within %g", what, value, expected, tolerance);
}

TEST_MAIN("shapes")
