/* SPDX-License-Identifier: MIT
 *
 * tests.h - the groups of test_shapes; each returns the number of its tests that failed.
 */
#ifndef NARC_TEST_TESTS_H
#define NARC_TEST_TESTS_H

#include "expect.h"

int test_validation(void);
int test_builders(void);
int test_junctions(void);
int test_derived(void);
int test_store(void);
int test_replacing(void);
int test_sharing(void);
int test_saving(void);
int test_rolls(void);

/* Fails unless |value - expected| <= tolerance. */
void expect_near(double value, double expected, double tolerance, const char *what);

#endif
