/* SPDX-License-Identifier: MIT
 *
 * same_bits.c - the world's state is the same to the last bit on each instruction set and with any number of threads.
 * The example's own arithmetic is compiled once, without contraction, and has no function that could round otherwise.
 */
#include <inttypes.h>
#include <math.h>

#include "runs.h"

/* Of the last state, and of all events on the way. */
static uint64_t run_scene(const char *name, float margin, const char *isa, unsigned threads) {
    test_use_isa(isa);
    world_settings settings = world_defaults;
    narc_openmp_workers(threads, &settings.workers);
    settings.margin = margin;
    if (margin > 0.1f) { /* all are asked */
        settings.recycling = 0;
        settings.sleep_time = INFINITY;
    }
    run r = begin_run(name, settings, 1);
    uint64_t hash = TEST_HASH_START;
    for (int step = 0; step < 240; step++) {
        continue_run(&r, 1 / 60.0f);
        for (size_t k = 0; k < r.world.event_count; k++) {
            const world_event *event = &r.world.events[k];
            const uint64_t numbers[] = {event->id_a, event->id_b, event->begins, event->sensor};
            hash = test_hash_items(hash, numbers, 4, sizeof numbers[0]);
        }
    }
    hash ^= world_hash(&r.world);
    print_message("%s, %s, %u threads: %zu pairs, %016" PRIx64 "\n", name, isa, threads, r.world.result->count, hash);
    /* Enough for two threads, of chunks of 512. */
    assert_true(margin < 0.1f || (r.world.result->count > 512 && r.world.result->asked_count > 512));
    end_run(&r);
    return hash;
}

static void check_same_bits(const char *name, float margin) {
    const uint64_t expected = run_scene(name, margin, "scalar", 1);
    for (size_t i = 0; narc_isa_name(i); i++)
        if (narc_isa_supported(narc_isa_name(i)))
            assert_int_equal(run_scene(name, margin, narc_isa_name(i), 2), expected);
}

/* Many pairs. */
TEST(test_heap) { check_same_bits("heap", 0.3f); }

/* Bodies come and go. */
TEST(test_rain) { check_same_bits("rain", 0.02f); }

/* Ground, whose rows are merged, and joints. */
TEST(test_ground) {
    check_same_bits("car", 0.02f);
    check_same_bits("dominoes", 0.02f);
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
