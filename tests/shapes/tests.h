/* SPDX-License-Identifier: MIT
 *
 * tests.h - what the tests of shapes share.
 */
#ifndef NARC_TEST_TESTS_H
#define NARC_TEST_TESTS_H

#include "expect.h"

/* Fails unless |value - expected| <= tolerance. */
void expect_near(double value, double expected, double tolerance, const char *what);

#endif
