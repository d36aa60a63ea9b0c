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

int main(void) {
    if (!test_begin())
        return TEST_SKIPPED;
    return test_validation() + test_builders() + test_junctions() + test_derived() + test_store() + test_replacing() +
               test_rolls() + test_sharing() + test_saving() !=
           0;
}
