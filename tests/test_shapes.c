/* SPDX-License-Identifier: MIT
 *
 * test_shapes.c - shapes: validation, builders, derived quantities and the store.
 */
#include <math.h>
#include <string.h>

#include "shapes_tests.h"
#include "support.h"

void expect_error(narc_status status, narc_status expected, const narc_error *error, const char *words) {
    if (status != expected) {
        fail_msg("got %s, expected %s (%s)", narc_status_name(status), narc_status_name(expected), words);
    }
    if (error->status != expected) {
        fail_msg("the error says %s, not %s", narc_status_name(error->status), narc_status_name(expected));
    }
    if (!strstr(error->message, words)) {
        fail_msg("the message is \"%s\", it should mention \"%s\"", error->message, words);
    }
    size_t length = strlen(error->message);
    if (length == 0 || strchr(error->message, '\n') || error->message[length - 1] == '.') {
        fail_msg("not one line without a full stop: \"%s\"", error->message);
    }
}

void expect_ok(narc_status status, const narc_error *error) {
    if (status != NARC_OK) {
        fail_msg("%s: %s", narc_status_name(status), error->message);
    }
}

void expect_near(double value, double expected, double tolerance, const char *what) {
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%s is %.17g, expected %.17g within %g", what, value, expected, tolerance);
    }
}

int main(void) {
    if (!test_begin()) {
        return TEST_SKIPPED;
    }
    return test_validation() + test_builders() + test_junctions() + test_derived() + test_store() + test_rolls() != 0;
}
