/* SPDX-License-Identifier: MIT
 *
 * places.c - where grains start: free places, sizes as they are distributed, lattices.
 */
#include <math.h>

#include "worlds.h"

/* The mean of many draws is within five deviations of the mean of one, over the root of their number. */
TEST(test_sizes) {
    enum { DRAWS = 100000 };
    static const dem_sizes sizes[] = {
        {DEM_FIXED, 3, 0, 0, 0}, {DEM_UNIFORM, 0, 0, 2, 4}, {DEM_NORMAL, 3, 0.2, 2, 4}, {DEM_LOGNORMAL, 3, 0.3, 1, 9}};
    uint64_t random = 3;
    for (size_t i = 0; i < 4; i++) {
        const dem_sizes *s = &sizes[i];
        const bool lognormal = s->kind == DEM_LOGNORMAL;
        const double deviation = s->kind == DEM_UNIFORM ? 2 / sqrt(12.0) : s->deviation;
        double sum = 0, squares = 0;
        for (int k = 0; k < DRAWS; k++) {
            const double size = dem_draw_size(s, &random), x = lognormal ? log(size / 3) : size - 3;
            assert_true(s->kind == DEM_FIXED ? size == 3 : size >= s->low && size <= s->high);
            sum += x;
            squares += x * x;
        }
        print_message("distribution %zu: mean off by %.2g, deviation %.6g, expected %.6g\n", i, sum / DRAWS,
                      sqrt(squares / DRAWS), deviation);
        assert_true(fabs(sum / DRAWS) <= 5 * deviation / sqrt(DRAWS));
        assert_true(fabs(sqrt(squares / DRAWS) - deviation) <= 0.01 * deviation);
    }
}

static dem_filling plain_filling(size_t count) {
    return (dem_filling){.count = count,
                         .region = {true, {0, 0}, {30, 30}},
                         .shapes = {DISC, ROUND, OCTAGON, ARCS, ELL},
                         .shape_count = 5,
                         .sizes = {DEM_UNIFORM, 0, 0, 0.5, 2.5},
                         .tries = 5000};
}

static dem make_room(void) {
    dem d = plain_world();
    d.settings.periodic_x = true;
    d.settings.high.x = 30;
    add_plate(&d, "floor", 0, 1, 0, 1);
    add_box(&d, OCTAGON, 4, 15, 15);
    return d;
}

/* Every pair of the list is apart by the gap, by the exact test, borders and walls among them. */
TEST(test_free_places) {
    const double gap = 0.05;
    AUTO(dem_destroy) dem d = make_room();
    dem_filling filling = plain_filling(150);
    uint64_t random = 5;
    filling.gap = gap;
    dem_fill_randomly(&d, &filling, &random);
    assert_int_equal(d.grain_count, 150);
    dem_start(&d);
    const narc_bodies bodies = dem_make_poses(&d, false);
    const narc_query query = {
        .margin = (float)gap - 1e-4f, .selection = NARC_ARRAY(d.found->order), .selection_count = d.found->count};
    const uint32_t *b = d.found->pairs.b.base;
    size_t count = 99, walls = 0, images = 0;
    for (size_t k = 0; k < d.found->count; k++) {
        const dem_image *image = &d.images[b[d.found->order[k]]];
        walls += d.parts[image->part].body >= d.grain_count;
        images += d.parts[image->part].body < d.grain_count && image->right != 0;
    }
    assert_int_equal(narc_find_contacts(d.store, &bodies, &d.found->pairs, &query, NULL, 0, &count, NULL), NARC_OK);
    print_message("%zu pairs, %zu with walls, %zu across the border\n", d.found->count, walls, images);
    assert_int_equal(count, 0);
    assert_true(walls > 5 && images > 0);
}

/* Infinite mass is what walls have. */
TEST(test_mass_out_of_range) {
    AUTO(dem_destroy) dem d = plain_world();
    d.materials[0].density = 1e300;
    d.settings.thickness = 1e8; /* so that the moment of inertia, half the mass, is finite */
    EXPECT_ERROR(&d, "mass inf is out of range", add_grain(&d, DISC, 0, 0, 0, 0));
}

TEST(test_lattice) {
    AUTO(dem_destroy) dem d = plain_world();
    dem_filling filling = plain_filling(0);
    uint64_t random = 5;
    filling.spacing = (vec){3, 5};
    filling.jitter = 0.5;
    dem_fill_lattice(&d, &filling, &random);
    assert_int_equal(d.grain_count, 60);
    for (size_t k = 0; k < 60; k++) {
        assert_true(fabs(d.bodies[k].position.x - 3 * ((double)(k % 10) + 0.5)) <= 0.75);
        assert_true(fabs(d.bodies[k].position.y - 5 * ((double)(k / 10) + 0.5)) <= 1.25);
    }
    filling.count = 61;
    EXPECT_ERROR(&d, "has no room for 61 grains", dem_fill_lattice(&d, &filling, &random));
}
