/* SPDX-License-Identifier: MIT
 *
 * support.h - what all test programs share: the seed, the number of trials, the instruction set, random numbers.
 *
 * Environment:
 *   NARC_TEST_SEED     where the random numbers start; printed by every program
 *   NARC_TEST_TRIALS   multiplies the number of random trials (0.1: a quick run, 100: a long one)
 *   NARC_TEST_ISA      the instruction set to test; the program is skipped if it can't be had
 */
#ifndef NARC_TEST_SUPPORT_H
#define NARC_TEST_SUPPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* cmocka.h needs these before it; where there is none, the one of without_cmocka/ needs nothing. */
#ifndef NARC_TEST_WITHOUT_CMOCKA
#include <setjmp.h>
#endif
#include <stdarg.h>

#include <cmocka.h>

#include "auto.h"

#define PI 3.14159265358979323846

/* A test of this program: TEST_MAIN() or test_run() runs all, those of a file in their order there. */
#define TEST(name)                                                                                                     \
    static void name(void **state);                                                                                    \
    __attribute__((constructor)) static void add_##name(void) { test_add(#name, name); }                               \
    static void name(__attribute__((unused)) void **state)
void test_add(const char *name, CMUnitTestFunction test);

/* The number of tests that failed; set_up and tear_down may be NULL. */
int test_run(const char *program, CMFixtureFunction set_up, CMFixtureFunction tear_down);

/* main() of a program that has nothing to do but run its tests. */
#define TEST_MAIN(program)                                                                                             \
    int main(void) { return test_begin() ? test_run(program, NULL, NULL) : TEST_SKIPPED; }

/* What ctest takes for "skipped" (SKIP_RETURN_CODE). */
enum { TEST_SKIPPED = 77 };

/* Prints seed and instruction set, and chooses the latter. False if this machine does not have it: then main() returns
 * TEST_SKIPPED. To be called first. */
bool test_begin(void);

/* The instruction set under test, never NULL after test_begin(). */
const char *test_isa(void);

/* `base` times NARC_TEST_TRIALS, at least 1. */
size_t test_trials(size_t base);

/* Makes `name` the instruction set of all calls that follow; fails the test if that can't be done. */
void test_use_isa(const char *name);

/* narc_openmp_workers() as a value. */
static inline narc_workers openmp_workers(unsigned count) {
    narc_workers workers;
    narc_openmp_workers(count, &workers);
    return workers;
}

/* A stream of random numbers (a 64-bit counter put through a mixing function), the same on every machine. */
struct test_random {
    uint64_t state;
};

/* A stream of its own for each name, so that no test depends on those before it. */
struct test_random test_random_named(const char *name);

uint64_t random_bits(struct test_random *random);
double random_unit(struct test_random *random);                             /* 0 <= x < 1 */
double random_between(struct test_random *random, double low, double high); /* low <= x < high */
double random_log_between(struct test_random *random, double low, double high);
size_t random_below(struct test_random *random, size_t limit); /* 0 .. limit - 1 */

/* Damages a text of JSON or CSV in up to three places: bytes become others, are left out or inserted, bits flip, or the
 * end is cut. Returns its new size; it may grow by three. */
size_t random_damage(struct test_random *random, char *text, size_t size);

/* FNV-1a, 64 bits, continued from `hash`: of bytes, and of numbers of `size` bytes each, the lowest byte first on every
 * machine. */
#define TEST_HASH_START 0xcbf29ce484222325u
uint64_t test_hash(uint64_t hash, const void *bytes, size_t size);
uint64_t test_hash_items(uint64_t hash, const void *items, size_t count, size_t size);

/* Gives saved contacts their sum, as narc_save_contacts() does. */
void sum_up_contacts(char *bytes, size_t size);

#endif
