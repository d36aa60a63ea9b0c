/* SPDX-License-Identifier: MIT
 *
 * pair_columns.c - what a pair may have of its own: a margin (of whole batches: bits.c), and a shift of its second body,
 * against bodies that are where the shift puts them.
 */
#include <math.h>
#include <stdlib.h>

#include "guard.h"
#include "scene.h"

enum { BODIES = 150, PAIRS = 2000 };

static void check_same_rows(const narc_contact *found, const narc_contact *right, size_t count) {
    assert_memory_equal(found, right, count * sizeof *found);
}

/* Margins are those of the pairs, wherever these stand in a selection. */
TEST(test_selected_margins) {
    static const float margins[] = {0, 0.25f, -0.1f};
    struct test_random random = test_random_named("margins");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct margin {
        double before;
        float margin;
    } margin[PAIRS];
    uint32_t selection[PAIRS / 2];
    for (size_t k = 0; k < PAIRS; k++)
        margin[k].margin = margins[k % 3];
    for (uint32_t k = 0; k < PAIRS / 2; k++)
        selection[k] = PAIRS - 1 - 2 * k;
    narc_query query = {.margins = NARC_COLUMN(margin, margin)};
    AUTO(free_at) struct contacts all = find_contacts(scene.store, &bodies, &pairs, &query);
    query.selection = NARC_ARRAY(selection);
    query.selection_count = PAIRS / 2;
    AUTO(free_at) struct contacts found = find_contacts(scene.store, &bodies, &pairs, &query);
    size_t at = 0;
    for (size_t k = all.count; k-- > 0;)
        if (all.rows[k].pair % 2)
            check_same_rows(&found.rows[at++], &all.rows[k], 1);
    assert_int_equal(at, found.count);
}

/* Of the same shapes, each pair's bodies anew: A in the origin, B where the difference of the positions and the shift
 * puts it. */
static struct scene place_differences(const struct scene *scene, const float *shift_x, const float *shift_y) {
    struct scene placed = *scene;
    placed.bodies = calloc(2 * PAIRS, sizeof *placed.bodies);
    placed.pairs = calloc(PAIRS, sizeof *placed.pairs);
    placed.body_count = 0;
    placed.precision = NARC_FLOAT32;
    assert_true(placed.bodies && placed.pairs);
    for (size_t k = 0; k < PAIRS; k++) {
        const struct body a = scene->bodies[scene->pairs[k].a], b = scene->bodies[scene->pairs[k].b];
        struct body at_origin = a, there = b;
        at_origin.x = at_origin.y = 0;
        there.x = (double)(float)(b.x - a.x + (double)shift_x[k]);
        there.y = (double)(float)(b.y - a.y + (double)shift_y[k]);
        placed.pairs[k].a = scene_add_body(&placed, at_origin);
        placed.pairs[k].b = scene_add_body(&placed, there);
    }
    return placed;
}

/* Shifts with all their digits, where doubles are as coarse as floats near 1, too. */
TEST(test_shifts) {
    struct test_random random = test_random_named("shifts");
    for (int precision = 0; precision < 2; precision++) {
        AUTO(destroy_scene) struct scene scene = make_random_scene(&random, (narc_precision)precision, BODIES, PAIRS);
        AUTO(guard_release_at) float *const shift_x = guard_allocate(PAIRS * sizeof *shift_x);
        AUTO(guard_release_at) float *const shift_y = guard_allocate(PAIRS * sizeof *shift_y);
        for (size_t k = 0; k < BODIES && precision; k++) {
            scene.bodies[k].x += 1e9;
            scene.bodies[k].y -= 1e9;
        }
        for (size_t k = 0; k < PAIRS; k++) {
            shift_x[k] = (float)random_between(&random, -1, 1);
            shift_y[k] = (float)random_between(&random, -1, 1);
        }
        struct scene placed = place_differences(&scene, shift_x, shift_y);
        AUTO(free_at) struct contacts right = scene_contacts(&placed, 0.3f);
        AUTO(free_at) uint64_t *const right_bits = scene_overlaps(&placed);
        const narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        pairs.shift_x = (narc_float_column){shift_x, sizeof *shift_x};
        pairs.shift_y = (narc_float_column){shift_y, sizeof *shift_y};
        AUTO(free_at)
        struct contacts found = find_contacts(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.3f});
        AUTO(free_at) uint64_t *const bits = find_overlaps(scene.store, &bodies, &pairs, NULL);
        assert_int_equal(found.count, right.count);
        check_same_rows(found.rows, right.rows, right.count);
        assert_memory_equal(bits, right_bits, NARC_BIT_WORDS(PAIRS) * sizeof *bits);
        free(placed.bodies);
        free(placed.pairs);
    }
}

/* A column may be left out. Where a shift is NaN or infinite there is no answer. */
TEST(test_one_shift) {
    struct test_random random = test_random_named("one shift");
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    static float shift[PAIRS], zeros[PAIRS];
    for (size_t k = 0; k < PAIRS; k++)
        shift[k] = (float)random_between(&random, -1, 1);
    shift[17] = NAN;
    shift[18] = INFINITY;
    for (int along_y = 0; along_y < 2; along_y++) {
        size_t skipped = 0;
        pairs.shift_x = along_y ? (narc_float_column){0} : NARC_ARRAY(shift);
        pairs.shift_y = along_y ? NARC_ARRAY(shift) : (narc_float_column){0};
        const narc_query query = {.margin = INFINITY, .out_skipped = &skipped};
        AUTO(free_at) struct contacts found = find_contacts(scene.store, &bodies, &pairs, &query);
        *(along_y ? &pairs.shift_x : &pairs.shift_y) = NARC_ARRAY(zeros);
        AUTO(free_at) struct contacts right = find_contacts(scene.store, &bodies, &pairs, &query);
        check_same_rows(found.rows, right.rows, PAIRS);
        assert_int_equal(skipped, 2);
        assert_true(found.rows[17].count == 0 && found.rows[18].count == 0);
    }
}

TEST_MAIN("pair_columns")
