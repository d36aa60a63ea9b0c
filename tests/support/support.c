/* SPDX-License-Identifier: MIT
 *
 * support.c - seed, trials, instruction set and random numbers of the tests.
 */
#include "support.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "narc.h"

/* At the end of a process clang 14's OpenMP takes the records of threads away that still leave their last barrier. */
#ifdef NARC_TEST_ENDS_OPENMP
#include <omp.h>
#endif

static struct CMUnitTest tests[200]; /* those without a name are none to cmocka */
static size_t test_count;

void test_add(const char *name, CMUnitTestFunction test) {
    if (test_count == sizeof tests / sizeof *tests)
        abort();
    tests[test_count++] = (struct CMUnitTest){.name = name, .test_func = test};
}

int test_run(const char *program, CMFixtureFunction set_up, CMFixtureFunction tear_down) {
    int failed = cmocka_run_group_tests_name(program, tests, set_up, tear_down);
#ifdef NARC_TEST_ENDS_OPENMP
    omp_pause_resource_all(omp_pause_hard);
#endif
    return failed;
}

static const uint64_t default_seed = 20250101;

static uint64_t seed(void) {
    const char *text = getenv("NARC_TEST_SEED");
    return text ? strtoull(text, NULL, 0) : default_seed;
}

const char *test_isa(void) {
    const char *name = getenv("NARC_TEST_ISA");
    return name ? name : narc_get_isa();
}

bool test_begin(void) {
    setvbuf(stdout, NULL, _IOLBF, 0);
    const char *name = getenv("NARC_TEST_ISA");
    if (name && !narc_isa_supported(name)) {
        printf("skipped: this build or this machine has no %s\n", name);
        return false;
    }
    narc_error error;
    if (name && narc_set_isa(name, &error) != NARC_OK) {
        printf("narc_set_isa: %s\n", error.message);
        exit(EXIT_FAILURE);
    }
    printf("NARC_TEST_SEED=%" PRIu64 " NARC_TEST_ISA=%s\n", seed(), test_isa());
    return true;
}

size_t test_trials(size_t base) {
    const char *text = getenv("NARC_TEST_TRIALS");
    double trials = (double)base * (text ? strtod(text, NULL) : 1.0);
    return trials > 1.0 ? (size_t)trials : 1;
}

void test_use_isa(const char *name) {
    narc_error error = {0};
    if (narc_set_isa(name, &error) != NARC_OK)
        fail_msg("narc_set_isa(%s): %s", name, error.message);
}

struct test_random test_random_named(const char *name) {
    return (struct test_random){test_hash(TEST_HASH_START ^ seed(), name, strlen(name))};
}

uint64_t random_bits(struct test_random *random) {
    /* A Weyl sequence, then two rounds of xor-shift and multiplication to spread every bit over all others. */
    random->state += 0x9e3779b97f4a7c15u;
    uint64_t bits = random->state;
    bits = (bits ^ (bits >> 32)) * 0xd6e8feb86659fd93u;
    bits = (bits ^ (bits >> 32)) * 0xd6e8feb86659fd93u;
    return bits ^ (bits >> 32);
}

double random_unit(struct test_random *random) { return (double)(random_bits(random) >> 11) * 0x1p-53; }

double random_between(struct test_random *random, double low, double high) {
    return low + (high - low) * random_unit(random);
}

double random_log_between(struct test_random *random, double low, double high) {
    return exp(random_between(random, log(low), log(high)));
}

size_t random_below(struct test_random *random, size_t limit) { return (size_t)(random_bits(random) % limit); }

size_t random_damage(struct test_random *random, char *text, size_t size) {
    static const char bytes[] = "[]{},;:\"\\ \n\r\t0123456789.-+eEnaifu\xff\xc3\0";
    for (size_t changes = 1 + random_below(random, 3); changes > 0; changes--) {
        const size_t at = random_below(random, size), length = 1 + random_below(random, 8);
        switch (random_below(random, 5)) {
        case 0:
            text[at] = bytes[random_below(random, sizeof bytes)];
            break;
        case 1:
            memmove(text + at + 1, text + at, size++ - at);
            text[at] = bytes[random_below(random, sizeof bytes)];
            break;
        case 2:
            if (at + length < size)
                memmove(text + at, text + at + length, (size -= length) - at);
            break;
        case 3:
            text[at] = (char)(text[at] ^ 1 << random_below(random, 8));
            break;
        default:
            size = random_below(random, 4) ? size : at + 1;
            break;
        }
    }
    return size;
}

uint64_t test_hash(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *byte = bytes;
    for (size_t k = 0; k < size; k++)
        hash = (hash ^ byte[k]) * 0x100000001b3u;
    return hash;
}

uint64_t test_hash_items(uint64_t hash, const void *items, size_t count, size_t size) {
    const unsigned char *byte = items;
    const size_t turn = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? size - 1 : 0;
    for (size_t k = 0; k < count; k++, byte += size)
        for (size_t i = 0; i < size; i++)
            hash = test_hash(hash, &byte[i ^ turn], 1);
    return hash;
}

void sum_up_contacts(char *bytes, size_t size) {
    enum { CHECKSUM = 24 };
    uint64_t sum = size, word;
    for (size_t at = 0; at + sizeof word <= size; at += sizeof word) {
        if (at == CHECKSUM)
            continue;
        memcpy(&word, bytes + at, sizeof word);
        sum = (sum ^ word) * 0xff51afd7ed558ccdu;
        sum ^= sum >> 32;
    }
    memcpy(bytes + CHECKSUM, &sum, sizeof sum);
}
