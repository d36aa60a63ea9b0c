/* SPDX-License-Identifier: MIT
 *
 * same_bits.c - the world's state is the same to the last bit on each instruction set and with any number of threads.
 * The example's own arithmetic is compiled once, without contraction, and has no function that could round otherwise.
 */
#include <inttypes.h>
#include <math.h>

#include "runs.h"

static uint64_t run_heap(const char *isa, unsigned threads) {
    test_use_isa(isa);
    world_settings settings = world_defaults;
    settings.workers = narc_openmp_workers(threads);
    settings.margin = 0.3f; /* many pairs */
    run r = begin_run("heap", settings, 1);
    continue_run(&r, 4);
    assert_true(r.world.list->pairs.count > 512); /* enough for two threads, of chunks of 512 */
    const uint64_t hash = world_hash(&r.world);
    print_message("%s, %u threads: %016" PRIx64 "\n", isa, threads, hash);
    end_run(&r);
    return hash;
}

TEST(test_same_bits) {
    const uint64_t expected = run_heap("scalar", 1);
    for (size_t i = 0; narc_isa_name(i); i++)
        if (narc_isa_supported(narc_isa_name(i)))
            assert_int_equal(run_heap(narc_isa_name(i), 2), expected);
}

/* The hash sees a last bit. */
TEST(test_hash_sees_all) {
    run r = begin_run("stack", world_defaults, 1);
    const uint64_t before = world_hash(&r.world);
    r.world.bodies[5].spin = nextafterf(r.world.bodies[5].spin, 1);
    assert_int_not_equal(world_hash(&r.world), before);
    end_run(&r);
}

TEST_MAIN("same_bits")
