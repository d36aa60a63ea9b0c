/* SPDX-License-Identifier: MIT
 *
 * same_bits.c - the state is the same to the last bit on each instruction set and with any number of threads.
 */
#include <inttypes.h>
#include <math.h>

#include "worlds.h"

static uint64_t run_world(const char *isa, unsigned threads) {
    assert_int_equal(narc_set_isa(isa, NULL), NARC_OK);
    dem d = make_busy_world(threads);
    dem_start(&d);
    step(&d, 7000);
    assert_true(d.contact_count > 60);
    const uint64_t hash = dem_hash(&d);
    print_message("%s, %u threads: %016" PRIx64 ", %zu contacts\n", isa, threads, hash, d.contact_count);
    dem_destroy(&d);
    return hash;
}

TEST(test_same_bits) {
    const uint64_t expected = run_world("scalar", 1);
    assert_int_equal(run_world("scalar", 2), expected);
    for (size_t i = 0; narc_isa_name(i); i++)
        if (narc_isa_supported(narc_isa_name(i)))
            assert_int_equal(run_world(narc_isa_name(i), 1 + (unsigned)i % 2), expected);
}

/* The hash sees a last bit. */
TEST(test_hash_sees_all) {
    dem d = make_busy_world(1);
    dem_start(&d);
    const uint64_t before = dem_hash(&d);
    d.bodies[5].spin = nextafter(d.bodies[5].spin, 100);
    assert_int_not_equal(dem_hash(&d), before);
    dem_destroy(&d);
}
