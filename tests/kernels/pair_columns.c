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

static bool same_contact(const narc_contacts *a, size_t i, const narc_contacts *b, size_t k) {
    return a->pair[i] == b->pair[k] && memcmp(&a->separation[i], &b->separation[k], sizeof(float)) == 0 &&
           memcmp(&a->normal_x[i], &b->normal_x[k], sizeof(float)) == 0 &&
           memcmp(&a->normal_y[i], &b->normal_y[k], sizeof(float)) == 0 &&
           memcmp(&a->point_x[i], &b->point_x[k], sizeof(float)) == 0 &&
           memcmp(&a->point_y[i], &b->point_y[k], sizeof(float)) == 0 && a->arc_a[i] == b->arc_a[k] &&
           a->arc_b[i] == b->arc_b[k];
}

/* The contacts of a method; those of the exact one in two threads, so that chunks meet. */
static struct contacts find_contacts(const struct scene *scene, const narc_pairs *pairs, narc_method method,
                                     float margin, uint32_t *hints, size_t *out_skipped) {
    struct contacts found = create_contacts(PAIRS);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_method_query query = {.method = method, .hints = hints, .out_skipped = out_skipped};
    assert_int_equal(
        contacts_by_method(scene->store, &bodies, pairs, &query, margin, 2, &found.view, &found.count, NULL), NARC_OK);
    return found;
}

static void check_margins(const struct scene *scene, narc_method method) {
    static uint32_t hints[PAIRS];
    float margin[PAIRS + 1];
    size_t skipped = 0, expected_skipped = 0, at = 0, next[MARGINS] = {0};
    struct contacts each[MARGINS];
    narc_pairs pairs = scene_pairs(scene);
    for (size_t m = 0; m < MARGINS; m++)
        each[m] = find_contacts(scene, &pairs, method, isnan(margins[m]) ? 0 : margins[m], NULL, NULL);
    for (size_t k = 0; k < PAIRS; k++) {
        margin[k] = margins[(k * k + k / 3) % MARGINS];
        expected_skipped += isnan(margin[k]) ? 1 : 0;
    }
    pairs.margin = NARC_ARRAY(margin);
    memset(hints, 0, sizeof hints);
    for (size_t round = 0; round < 3; round++) { /* without hints, with none, with those of the round before */
        struct contacts found = find_contacts(scene, &pairs, method, -1000, round == 0 ? NULL : hints, &skipped);
        assert_int_equal(skipped, expected_skipped);
        at = 0;
        memset(next, 0, sizeof next);
        for (size_t k = 0; k < PAIRS; k++) {
            for (size_t m = 0; m < MARGINS; m++)
                next[m] += next[m] < each[m].count && each[m].view.pair[next[m]] < k;
            const size_t m = (k * k + k / 3) % MARGINS;
            const bool wanted = !isnan(margins[m]) && next[m] < each[m].count && each[m].view.pair[next[m]] == k;
            const bool there = at < found.count && found.rows[at].pair == k;
            assert_int_equal(there, wanted);
            if (there && round < 2) /* GJK's hints change its roundings */
                assert_true(same_contact(&found.view, at, &each[m].view, next[m]));
            at += there;
        }
        assert_int_equal(at, found.count);
        free(found.rows);
    }
    for (size_t m = 0; m < MARGINS; m++)
        free(each[m].rows);
}

static void test_margins(void **state) {
    (void)state;
    struct test_random random = test_random_named("margins");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, PAIRS);
    check_margins(&scene, NARC_METHOD_SAT);
    check_margins(&scene, NARC_METHOD_SAT_FIRST);
    check_margins(&scene, NARC_METHOD_GJK);
    destroy_scene(&scene);
}

/* Each pair gets a copy of its second body, shifted. Shifts are multiples of 1/4 and positions of 2^-16, so that both
 * ways subtract exactly. */
static void test_shifts(void **state) {
    (void)state;
    struct test_random random = test_random_named("shifts");
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_random_scene(&random, (narc_precision)precision, BODIES, PAIRS);
        struct scene moved = scene;
        const double far = precision == NARC_FLOAT64 ? 0x1p30 : 0; /* where floats have no fractions */
        float shift[PAIRS][2];
        moved.bodies = calloc(BODIES + PAIRS, sizeof *moved.bodies);
        moved.pairs = calloc(PAIRS, sizeof *moved.pairs);
        assert_non_null(moved.bodies);
        assert_non_null(moved.pairs);
        for (size_t k = 0; k < BODIES; k++) {
            struct body *body = &scene.bodies[k];
            body->x = round(body->x * 0x1p16) / 0x1p16 + far;
            body->y = round(body->y * 0x1p16) / 0x1p16;
            round_position(body, scene.precision);
            moved.bodies[k] = *body;
        }
        moved.body_count = BODIES;
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
        struct contacts right = scene_contacts(&moved, 0.2f), found = create_contacts(PAIRS);
        assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0.2f, 1, &found.view, &found.count, NULL),
                         NARC_OK);
        assert_int_equal(found.count, right.count);
        for (size_t k = 0; k < found.count; k++)
            assert_true(same_contact(&found.rows[k], &right.rows[k]));
        uint64_t bits[NARC_BIT_WORDS(PAIRS)], *right_bits = scene_overlaps(&moved);
        assert_int_equal(narc_find_overlaps(scene.store, &bodies, &pairs, 2, bits, NULL), NARC_OK);
        assert_memory_equal(bits, right_bits, sizeof bits);

        /* A sub-range reads its own items, and a column may be left out. */
        struct contacts part = create_contacts(PAIRS);
        assert_int_equal(
            narc_find_contacts_range(scene.store, &bodies, &pairs, 700, 333, INFINITY, &part.view, &part.count, NULL),
            NARC_OK);
        struct contacts all = scene_contacts(&moved, INFINITY);
        for (size_t k = 0; k < part.count; k++)
            assert_true(same_contact(&part.rows[k], &all.view, 700 + k));
        pairs.shift_y = (narc_float_column){0};
        for (size_t k = 0; k < PAIRS; k++) {
            moved.bodies[BODIES + k].y = scene.bodies[scene.pairs[k].b].y;
            round_position(&moved.bodies[BODIES + k], scene.precision);
        }
        struct contacts along_x = scene_contacts(&moved, INFINITY);
        assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, INFINITY, 1, &found.view, &found.count, NULL),
                         NARC_OK);
        for (size_t k = 0; k < PAIRS; k++)
            assert_true(same_contact(&found.rows[k], &along_x.rows[k]));

        /* A NaN or an infinity: no answer. */
        shift[17][0] = NAN;
        shift[18][0] = INFINITY;
        size_t skipped = 0;
        const narc_query query = {.out_skipped = &skipped};
        assert_int_equal(narc_query_overlaps(scene.store, &bodies, &pairs, &query, 1, bits, NULL), NARC_OK);
        assert_int_equal(skipped, 2);
        assert_false(bit_is_set(bits, 17) || bit_is_set(bits, 18));

        free(right_bits);
        free(moved.bodies);
        free(moved.pairs);
        free(right.rows);
        free(found.rows);
        free(part.rows);
        free(all.rows);
        free(along_x.rows);
        destroy_scene(&scene);
    }
}

/* Each pair's bodies anew: A in the origin, B where the difference of the positions and the shift puts it. */
static struct scene place_differences(const struct scene *scene, const float shift[][2]) {
    struct scene placed = *scene;
    placed.precision = NARC_FLOAT32;
    placed.body_count = 0;
    placed.bodies = calloc(2 * PAIRS, sizeof *placed.bodies);
    placed.pairs = calloc(PAIRS, sizeof *placed.pairs);
    assert_non_null(placed.bodies);
    assert_non_null(placed.pairs);
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
        for (size_t k = 0; k < BODIES && precision == NARC_FLOAT64;
             k++) { /* where doubles are as coarse as floats near 1 */
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
        narc_pairs right_pairs = scene_pairs(&placed);
        right_pairs.margin = NARC_ARRAY(margin);
        for (size_t layout = LAYOUT_ARRAYS; layout <= LAYOUT_REVERSED; layout++) {
            for (size_t count = PAIRS - 3; count > PAIRS - 40; count -= 9) {
                const size_t first = random_below(&random, 40);
                struct columns columns = create_columns(&scene, (enum layout)layout, 0, count);
                float *const x = guard_copy(shift_x, count * sizeof *x),
                             *const y = guard_copy(shift_y, count * sizeof *y),
                             *const margins_of = guard_copy(margin, count * sizeof *margins_of);
                struct contacts found = create_contacts(PAIRS), right = create_contacts(PAIRS);
                columns.pairs.shift_x = NARC_ARRAY(x);
                columns.pairs.shift_y = NARC_ARRAY(y);
                columns.pairs.margin = NARC_ARRAY(margins_of);
                assert_int_equal(narc_find_contacts_range(scene.store, &columns.bodies, &columns.pairs, first,
                                                          count - first, 0, &found.view, &found.count, NULL),
                                 NARC_OK);
                assert_int_equal(narc_find_contacts_range(scene.store, &right_bodies, &right_pairs, first,
                                                          count - first, 0, right.rows, &right.count, NULL),
                                 NARC_OK);
                assert_int_equal(found.count, right.count);
                for (size_t k = 0; k < found.count; k++)
                    assert_true(same_contact(&found.rows[k], &right.rows[k]));
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
