/* SPDX-License-Identifier: MIT
 *
 * restart.c - the state is the same to the last bit on each instruction set, with any number of threads, and going on from a
 * file; damaged files are told.
 */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "worlds.h"

static const char path[] = "test.restart"; /* in the folder of the build */

/* A run that has no more steps tells what the last one found: contacts and stresses too. */
static void check_same_measures(const dem *d, const dem *other) {
    dem_measures a, b;
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    dem_measure(d, NULL, &a);
    dem_measure(other, NULL, &b);
    assert_true(a.contacts > 0 && a.stress.yy > 0);
    assert_int_equal(a.contacts, b.contacts);
    assert_memory_equal(&a.energy, &b.energy, sizeof a.energy);
    const double numbers[] = {a.coordination, a.stress.xx, a.stress.xy, a.stress.yx, a.stress.yy, a.deepest, a.fastest};
    const double others[] = {b.coordination, b.stress.xx, b.stress.xy, b.stress.yx, b.stress.yy, b.deepest, b.fastest};
    assert_memory_equal(numbers, others, sizeof numbers);
}

static void check_same_walls(const dem *d, const dem *other) {
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_wall *a = &d->walls[w], *b = &other->walls[w];
        const dem_servo *s = &a->servo, *t = &b->servo;
        const double numbers[] = {a->velocity.x,  a->velocity.y,  a->pivot.x, a->pivot.y,  a->spin,
                                  a->work,        a->idle_way,    s->force,   s->stress,   s->gain,
                                  s->direction.x, s->direction.y, s->travel,  s->max_speed};
        const double others[] = {b->velocity.x,  b->velocity.y,  b->pivot.x, b->pivot.y,  b->spin,
                                 b->work,        b->idle_way,    t->force,   t->stress,   t->gain,
                                 t->direction.x, t->direction.y, t->travel,  t->max_speed};
        assert_memory_equal(numbers, others, sizeof numbers);
        assert_memory_equal(s->between, t->between, sizeof s->between);
        assert_true(s->on == t->on);
    }
}

/* Borders, history, rolling friction, walls that move, turn and are controlled: all of it goes on. */
TEST(test_bit_for_bit) {
    AUTO(dem_destroy) dem d = make_busy_world(1), again = make_busy_world(2);
    const dem_progress progress = {.input = 5, .stage = 1, .stage_step = 17, .csv_position = 99, .frame = 3};
    dem_progress found = {.input = 5};
    d.walls[2].velocity = (vec){0.01, 0.02};
    d.walls[2].spin = 2.5;
    d.walls[2].idle_way = 1;
    d.walls[2].servo = (dem_servo){false, {0.6, 0.8}, 3, 4, {1, 0}, 0.5, 6, 7};
    again.walls[0].servo = (dem_servo){.between = {-1, -1}};
    dem_start(&d);
    dem_start(&again);
    step(&d, 3000);
    dem_write_restart(&d, &progress, path);
    dem_read_restart(&again, &found, path);
    assert_memory_equal(&progress, &found, sizeof progress);
    assert_true(dem_hash(&d) == dem_hash(&again));
    check_same_measures(&d, &again);
    check_same_walls(&d, &again);
    for (int i = 0; i < 10; i++) {
        step(&d, 100);
        step(&again, 100);
        assert_true(dem_hash(&d) == dem_hash(&again));
    }
    assert_true(d.renewals > 10 && d.walls[0].work != 0 && d.account.rolling > 0);
    assert_true(d.renewals == again.renewals);
}

static void write_file(const char *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void expect_refusal(const char *message, uint64_t input) {
    AUTO(dem_destroy) dem d = make_busy_world(1);
    dem_progress progress = {.input = input};
    dem_start(&d);
    const uint64_t before = dem_hash(&d);
    EXPECT_ERROR(&d, message, dem_read_restart(&d, &progress, path));
    check_error(&d, path);
    assert_true(dem_hash(&d) == before);
}

TEST(test_damage) {
    static const struct {
        size_t offset;
        const char *message;
    } flips[] = {{0, "not a restart file"}, {7, "not a restart file"}, {8, "its version is"},
                 {12, "order of bytes"},    {16, "and should have"},   {24, "damaged"},
                 {32, "another input"},     {40, "damaged"},           {5000, "damaged"}};
    AUTO(dem_destroy) dem d = make_busy_world(1);
    size_t size;
    dem_start(&d);
    step(&d, 10);
    dem_write_restart(&d, &(dem_progress){.input = 5}, path);
    char *bytes = dem_read_file(path, &size);
    for (size_t i = 0; i < sizeof flips / sizeof flips[0]; i++) {
        bytes[flips[i].offset] ^= 1;
        write_file(bytes, size);
        bytes[flips[i].offset] ^= 1;
        expect_refusal(flips[i].message, 5);
    }
    static const size_t sizes[] = {0, 1, 39};
    for (size_t i = 0; i < 3; i++) {
        write_file(bytes, sizes[i]);
        expect_refusal("not a restart file", 5);
    }
    write_file(bytes, size - 1);
    expect_refusal("and should have", 5);
    write_file(bytes, size);
    expect_refusal("another input", 6);
    dem_release(bytes);
}

/* A whole file, but a body has no mass, as a wall has none. */
TEST(test_foreign_bodies) {
    AUTO(dem_destroy) dem d = make_busy_world(1);
    dem_start(&d);
    d.bodies[0].inverse_mass = 0;
    dem_write_restart(&d, &(dem_progress){.input = 5}, path);
    expect_refusal("its bodies do not fit the input", 5);
}

/* A whole file, but a history is of other parts than its contact. */
TEST(test_foreign_pairs) {
    AUTO(dem_destroy) dem d = make_busy_world(1), again = make_busy_world(1);
    dem_progress progress = {.input = 5};
    dem_start(&d);
    dem_start(&again);
    step(&d, 1000);
    assert_true(d.contact_count > 0);
    d.pairs[d.contacts[0].pair].a ^= 1;
    dem_write_restart(&d, &progress, path);
    EXPECT_ERROR(&again, "its bodies do not fit the input", dem_read_restart(&again, &progress, path));
}

/* A file that cannot be written leaves the old one. */
TEST(test_no_place_to_write) {
    AUTO(dem_destroy) dem d = make_busy_world(1);
    dem_start(&d);
    const dem_progress progress = {.input = 1};
    EXPECT_ERROR(&d, "/nonexistent/folder/file: ", dem_write_restart(&d, &progress, "/nonexistent/folder/file"));
}

static uint64_t run_world(const char *isa, unsigned threads) {
    assert_int_equal(narc_set_isa(isa, NULL), NARC_OK);
    AUTO(dem_destroy) dem d = make_busy_world(threads);
    dem_start(&d);
    step(&d, 7000);
    assert_true(d.contact_count > 60);
    const uint64_t hash = dem_hash(&d);
    print_message("%s, %u threads: %016" PRIx64 ", %zu contacts\n", isa, threads, hash, d.contact_count);
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
    AUTO(dem_destroy) dem d = make_busy_world(1);
    dem_start(&d);
    const uint64_t before = dem_hash(&d);
    d.bodies[5].spin = nextafter(d.bodies[5].spin, 100);
    assert_int_not_equal(dem_hash(&d), before);
}
