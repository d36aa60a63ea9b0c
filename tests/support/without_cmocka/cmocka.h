/* SPDX-License-Identifier: MIT
 *
 * cmocka.h - as much of cmocka as these tests use, for platforms that have no package of it. The first failure ends the
 * program.
 */
#ifndef NARC_TEST_WITHOUT_CMOCKA_H
#define NARC_TEST_WITHOUT_CMOCKA_H

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*CMUnitTestFunction)(void **state);
typedef int (*CMFixtureFunction)(void **state);
struct CMUnitTest {
    const char *name;
    CMUnitTestFunction test_func;
};

#define print_message(...) ((void)printf(__VA_ARGS__))
#define print_error(...)   ((void)printf(__VA_ARGS__))
#define fail_msg(...)                                                                                                  \
    (printf("%s:%d: ", __FILE__, __LINE__), printf(__VA_ARGS__), putchar('\n'), fflush(stdout), exit(EXIT_FAILURE))
#define fail() fail_msg("failed")
#define skip() return

#define assert_true(what)               ((what) ? (void)0 : fail_msg("not true: %s", #what))
#define assert_false(what)              ((what) ? fail_msg("not false: %s", #what) : (void)0)
#define assert_null(what)               assert_true((what) == NULL)
#define assert_non_null(what)           assert_true((what) != NULL)
#define assert_ptr_equal(a, b)          assert_true((const void *)(a) == (const void *)(b))
#define assert_string_equal(a, b)       assert_true(strcmp(a, b) == 0)
#define assert_string_not_equal(a, b)   assert_true(strcmp(a, b) != 0)
#define assert_memory_equal(a, b, size) assert_true(memcmp(a, b, size) == 0)
#define assert_int_equal(a, b)          assert_integers((long long)(a), (long long)(b), 1, #a " == " #b, __FILE__, __LINE__)
#define assert_int_not_equal(a, b)      assert_integers((long long)(a), (long long)(b), 0, #a " != " #b, __FILE__, __LINE__)
#define assert_in_range(value, least, most)                                                                            \
    assert_range((size_t)(value), (size_t)(least), (size_t)(most), #value, __FILE__, __LINE__)

static inline void assert_integers(long long a, long long b, int equal, const char *what, const char *file, int line) {
    if ((a == b) != equal) {
        printf("%s:%d: not true: %s: %lld and %lld\n", file, line, what, a, b);
        fflush(stdout);
        exit(EXIT_FAILURE);
    }
}

static inline void assert_range(size_t value, size_t least, size_t most, const char *what, const char *file, int line) {
    if (value < least || value > most) {
        printf("%s:%d: %s is %zu, not from %zu to %zu\n", file, line, what, value, least, most);
        fflush(stdout);
        exit(EXIT_FAILURE);
    }
}

#define cmocka_run_group_tests_name(name, tests, set_up, tear_down)                                                    \
    run_group(name, tests, sizeof(tests) / sizeof *(tests), set_up, tear_down)
static inline int run_group(const char *name, const struct CMUnitTest *tests, size_t count, CMFixtureFunction set_up,
                            CMFixtureFunction tear_down) {
    void *state = NULL;
    if (set_up && set_up(&state) != 0)
        return 1;
    for (size_t k = 0; k < count; k++) {
        if (!tests[k].test_func)
            continue;
        printf("[ %s ] %s\n", name, tests[k].name);
        tests[k].test_func(&state);
    }
    return tear_down && tear_down(&state) != 0;
}

#endif
