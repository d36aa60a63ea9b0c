/* SPDX-License-Identifier: MIT
 *
 * shapes_tests.h - the groups of test_shapes; each returns the number of its tests that failed.
 */
#ifndef NARC_TEST_SHAPES_TESTS_H
#define NARC_TEST_SHAPES_TESTS_H

#include "narc_shapes.h"

int test_validation(void);
int test_builders(void);
int test_junctions(void);
int test_derived(void);
int test_store(void);
int test_rolls(void);

/* Fails unless `status` is `expected` and the message has `words` in it. */
void expect_error(narc_status status, narc_status expected, const narc_error *error, const char *words);

/* Fails, with the message, unless `status` is NARC_OK. */
void expect_ok(narc_status status, const narc_error *error);

/* Fails unless |value - expected| <= tolerance. */
void expect_near(double value, double expected, double tolerance, const char *what);

#endif
