/* SPDX-License-Identifier: MIT
 *
 * pair_columns.c - what a pair may have of its own: a margin, and a shift of its second body. Each against calls
 * without: one call for each margin, and bodies that are where the shift puts them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "layouts.h"
#include "methods.h"
#include "scene.h"

enum { BODIES = 150, PAIRS = 2000 };

static const float margins[] = {0, 0.25f, -0.1f, INFINITY, NAN};
enum { MARGINS = sizeof margins / sizeof *margins };

static void check_same_rows(const narc_contact *found, const narc_contact *right, size_t count) {
    assert_memory_equal(found, right, count * sizeof *found);
}

/* The contacts of a method, in two threads, so that chunks meet. */
static struct contacts find_by(const struct scene *scene, narc_method method, narc_query query) {
    const narc_workers workers = narc_openmp_workers(2);
    query.workers = &workers;
    return query_contacts(scene, &(narc_method_options){.method = method}, &query);
}

static void check_margins(const struct scene *scene, narc_method method) {
    static uint32_t hints[PAIRS];
    float margin[PAIRS + 1];
    size_t skipped = 0, expected_skipped = 0, at = 0, next[MARGINS] = {0};
    struct contacts each[MARGINS];
    for (size_t m = 0; m < MARGINS; m++)
        each[m] = find_by(scene, method, (narc_query){.margin = isnan(margins[m]) ? 0 : margins[m]});
    for (size_t k = 0; k < PAIRS; k++) {
        margin[k] = margins[(k * k + k / 3) % MARGINS];
        expected_skipped += isnan(margin[k]) ? 1 : 0;
    }
    memset(hints, 0, sizeof hints);
    for (size_t round = 0; round < 3; round++) { /* without hints, with none, with those of the round before */
        const narc_query query = {.margin = -1000,
                                  .margins = NARC_ARRAY(margin),
                                  .hints = hint_column(round == 0 ? NULL : hints),
                                  .out_skipped = &skipped};
        struct contacts found = find_by(scene, method, query);
        assert_int_equal(skipped, expected_skipped);
        at = 0;
        memset(next, 0, sizeof next);
        for (size_t k = 0; k < PAIRS; k++) {
            for (size_t m = 0; m < MARGINS; m++)
                next[m] += next[m] < each[m].count && each[m].rows[next[m]].pair < k;
            const size_t m = (k * k + k / 3) % MARGINS;
            const bool wanted = !isnan(margins[m]) && next[m] < each[m].count && each[m].rows[next[m]].pair == k;
            const bool there = at < found.count && found.rows[at].pair == k;
            assert_int_equal(there, wanted);
            if (there && round < 2) /* GJK's hints change its roundings */
                check_same_rows(&found.rows[at], &each[m].rows[next[m]], 1);
            at += there;
        }
        assert_int_equal(at, found.count);
        free(found.rows);
    }
    for (size_t m = 0; m < MARGINS; m++)
        free(each[m].rows);
}

/* Margins are those of the pairs, wherever these stand in a selection. */
static void check_selected_margins(const struct scene *scene) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
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
    struct contacts all = find_contacts(scene->store, &bodies, &pairs, &query);
    query.selection = (narc_index_column){selection, sizeof *selection};
    query.selection_count = PAIRS / 2;
    struct contacts found = find_contacts(scene->store, &bodies, &pairs, &query);
    size_t at = 0;
    for (size_t k = all.count; k-- > 0;)
        if (all.rows[k].pair % 2)
            check_same_rows(&found.rows[at++], &all.rows[k], 1);
    assert_int_equal(at, found.count);
    free(all.rows);
    free(found.rows);
}

static void test_margins(void **state) {
    (void)state;
    struct test_random random = test_random_named("margins");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    check_margins(&scene, NARC_METHOD_SAT);
    check_margins(&scene, NARC_METHOD_SAT_FIRST);
    check_margins(&scene, NARC_METHOD_GJK);
    check_selected_margins(&scene);
    destroy_scene(&scene);
}

/* A scene of the same shapes and as many pairs, whose bodies come later. */
static struct scene share_shapes(const struct scene *scene, size_t bodies) {
    struct scene shared = *scene;
    shared.bodies = calloc(bodies, sizeof *shared.bodies);
    shared.pairs = calloc(PAIRS, sizeof *shared.pairs);
    assert_true(shared.bodies && shared.pairs);
    shared.body_count = 0;
    return shared;
}

/* Each pair gets a copy of its second body, shifted. Shifts are multiples of 1/4 and positions of 2^-16, so that both
 * ways subtract exactly. */
static void test_shifts(void **state) {
    (void)state;
    struct test_random random = test_random_named("shifts");
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_random_scene(&random, (narc_precision)precision, BODIES, PAIRS);
        struct scene moved = share_shapes(&scene, BODIES + PAIRS);
        const double far = precision == NARC_FLOAT64 ? 0x1p30 : 0; /* where floats have no fractions */
        float shift[PAIRS][2];
        for (size_t k = 0; k < BODIES; k++) {
            struct body *body = &scene.bodies[k];
            body->x = round(body->x * 0x1p16) / 0x1p16 + far;
            body->y = round(body->y * 0x1p16) / 0x1p16;
            round_position(body, scene.precision);
            scene_add_body(&moved, *body);
        }
        for (uint32_t k = 0; k < PAIRS; k++) {
            struct body body = scene.bodies[scene.pairs[k].b];
            shift[k][0] = ((float)random_below(&random, 9) - 4) / 4;
            shift[k][1] = ((float)random_below(&random, 9) - 4) / 4;
            body.x += (double)shift[k][0];
            body.y += (double)shift[k][1];
            moved.pairs[k] = (struct pair){scene.pairs[k].a, scene_add_body(&moved, body)};
        }
        const narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        pairs.shift_x = (narc_float_column){&shift[0][0], sizeof shift[0]};
        pairs.shift_y = (narc_float_column){&shift[0][1], sizeof shift[0]};
        const narc_workers workers = narc_openmp_workers(2);
        struct contacts right = scene_contacts(&moved, 0.2f);
        struct contacts found = find_contacts(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.2f});
        assert_int_equal(found.count, right.count);
        check_same_rows(found.rows, right.rows, right.count);
        uint64_t *right_bits = scene_overlaps(&moved);
        uint64_t *bits = find_overlaps(scene.store, &bodies, &pairs, &(narc_query){.workers = &workers});
        assert_memory_equal(bits, right_bits, NARC_BIT_WORDS(PAIRS) * sizeof *bits);
        free(bits);

        /* A sub-range reads its own items, and a column may be left out. */
        const narc_query range = {.margin = INFINITY, .first = 700, .count = 333};
        struct contacts part = find_contacts(scene.store, &bodies, &pairs, &range);
        struct contacts all = scene_contacts(&moved, INFINITY);
        assert_int_equal(part.count, 333);
        check_same_rows(part.rows, &all.rows[700], part.count);
        pairs.shift_y = (narc_float_column){0};
        for (size_t k = 0; k < PAIRS; k++) {
            moved.bodies[BODIES + k].y = scene.bodies[scene.pairs[k].b].y;
            round_position(&moved.bodies[BODIES + k], scene.precision);
        }
        struct contacts along_x = scene_contacts(&moved, INFINITY);
        free(found.rows);
        found = find_contacts(scene.store, &bodies, &pairs, &(narc_query){.margin = INFINITY});
        check_same_rows(found.rows, along_x.rows, PAIRS);

        /* A NaN or an infinity: no answer. */
        shift[17][0] = NAN;
        shift[18][0] = INFINITY;
        size_t skipped = 0;
        bits = find_overlaps(scene.store, &bodies, &pairs, &(narc_query){.out_skipped = &skipped});
        assert_int_equal(skipped, 2);
        assert_false(bit_is_set(bits, 17) || bit_is_set(bits, 18));
        void *const used[] = {bits,       right_bits, moved.bodies, moved.pairs, right.rows,
                              found.rows, part.rows,  all.rows,     along_x.rows};
        for (size_t k = 0; k < sizeof used / sizeof *used; k++)
            free(used[k]);
        destroy_scene(&scene);
    }
}

/* Each pair's bodies anew: A in the origin, B where the difference of the positions and the shift puts it. */
static struct scene place_differences(const struct scene *scene, const float shift[][2]) {
    struct scene placed = share_shapes(scene, 2 * PAIRS);
    placed.precision = NARC_FLOAT32;
    for (size_t k = 0; k < PAIRS; k++) {
        const struct body a = scene->bodies[scene->pairs[k].a], b = scene->bodies[scene->pairs[k].b];
        struct body at_origin = a, there = b;
        at_origin.x = at_origin.y = 0;
        there.x = (double)(float)(b.x - a.x + (double)shift[k][0]);
        there.y = (double)(float)(b.y - a.y + (double)shift[k][1]);
        placed.pairs[k].a = scene_add_body(&placed, at_origin);
        placed.pairs[k].b = scene_add_body(&placed, there);
    }
    return placed;
}

/* Shifts and margins with all their digits, between guard pages, whatever the layout of the bodies. */
static void test_layouts(void **state) {
    (void)state;
    struct test_random random = test_random_named("shifts and layouts");
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_random_scene(&random, (narc_precision)precision, BODIES, PAIRS);
        static float shift[PAIRS][2], shift_x[PAIRS], shift_y[PAIRS], margin[PAIRS];
        for (size_t k = 0; k < BODIES && precision; k++) { /* where doubles are as coarse as floats near 1 */
            scene.bodies[k].x += 1e9;
            scene.bodies[k].y -= 1e9;
        }
        for (size_t k = 0; k < PAIRS; k++) {
            shift[k][0] = shift_x[k] = (float)random_between(&random, -1, 1);
            shift[k][1] = shift_y[k] = (float)random_between(&random, -1, 1);
            margin[k] = (float)random_between(&random, -0.1, 0.3);
        }
        struct scene placed = place_differences(&scene, (const float(*)[2])shift);
        const narc_bodies right_bodies = scene_bodies(&placed);
        const narc_pairs right_pairs = scene_pairs(&placed);
        for (size_t layout = LAYOUT_ARRAYS; layout <= LAYOUT_REVERSED; layout++) {
            for (size_t count = PAIRS - 3; count > PAIRS - 40; count -= 9) {
                const size_t first = random_below(&random, 40);
                struct columns columns = create_columns(&scene, (enum layout)layout, 0, count);
                float *const x = guard_copy(shift_x, count * sizeof *x),
                             *const y = guard_copy(shift_y, count * sizeof *y),
                             *const margins_of = guard_copy(margin, count * sizeof *margins_of);
                columns.pairs.shift_x = NARC_ARRAY(x);
                columns.pairs.shift_y = NARC_ARRAY(y);
                narc_query query = {.margins = NARC_ARRAY(margins_of), .first = first, .count = count - first};
                struct contacts found = find_contacts(scene.store, &columns.bodies, &columns.pairs, &query);
                query.margins = (narc_float_column){margin, sizeof *margin};
                struct contacts right = find_contacts(scene.store, &right_bodies, &right_pairs, &query);
                assert_int_equal(found.count, right.count);
                check_same_rows(found.rows, right.rows, right.count);
                free(found.rows);
                free(right.rows);
                guard_release(x);
                guard_release(y);
                guard_release(margins_of);
                destroy_columns(&columns);
            }
        }
        free(placed.bodies);
        free(placed.pairs);
        destroy_scene(&scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_margins),
        cmocka_unit_test(test_shifts),
        cmocka_unit_test(test_layouts),
    };
    return test_begin() ? cmocka_run_group_tests_name("pair_columns", tests, NULL, NULL) : TEST_SKIPPED;
}
