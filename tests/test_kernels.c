/* SPDX-License-Identifier: MIT
 *
 * test_kernels.c - one instruction set against scalar, to the last bit: all counts, all layouts, guard pages on all
 * sides.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "layouts.h"

/* Around two blocks of 64, and more than any vector is wide. */
enum { SMALL_COUNTS = 132 };

enum { BODIES = 67 };

static const float margins[] = {0.0f, 0.25f, -0.1f, INFINITY};
enum { MARGINS = sizeof(margins) / sizeof(margins[0]) };

/* What scalar says of all pairs of a scene. */
struct expected {
    uint64_t *bits;
    struct contacts contacts[MARGINS];
};

static struct expected expect(const struct scene *scene) {
    struct expected expected;
    test_use_isa("scalar");
    expected.bits = scene_overlaps(scene);
    for (int m = 0; m < MARGINS; m++) {
        expected.contacts[m] = scene_contacts(scene, margins[m]);
    }
    test_use_isa(test_isa());
    return expected;
}

static void destroy_expected(struct expected *expected) {
    free(expected->bits);
    for (int m = 0; m < MARGINS; m++) {
        destroy_contacts(&expected->contacts[m]);
    }
}

/* Bits of pairs first .. first + count - 1, moved to the start of a word; the rest of the last word 0. */
static uint64_t expected_word(const uint64_t *bits, size_t first, size_t count, size_t word) {
    uint64_t moved = 0;
    for (size_t k = word * 64; k < count && k < word * 64 + 64; k++) {
        moved |= (uint64_t)bit_is_set(bits, first + k) << (k % 64);
    }
    return moved;
}

static void check_overlaps(const narc_shapes *store, const struct columns *columns, const uint64_t *bits,
                           size_t first) {
    size_t count = columns->pairs.count, words = NARC_BIT_WORDS(count);
    uint64_t *out = guard_allocate(words * sizeof(uint64_t));
    assert_int_equal(narc_find_overlaps(store, &columns->bodies, &columns->pairs, 1, out, NULL), NARC_OK);
    for (size_t word = 0; word < words; word++) {
        if (out[word] != expected_word(bits, first, count, word)) {
            fail_msg("%zu pairs from %zu: word %zu differs", count, first, word);
        }
    }
    guard_release(out);
}

static void check_contacts(const narc_shapes *store, const struct columns *columns, const struct contacts *all,
                           float margin, size_t first) {
    size_t count = columns->pairs.count, from = 0, found = 0;
    while (from < all->count && all->view.pair[from] < first) {
        from++;
    }
    while (from + found < all->count && all->view.pair[from + found] < first + count) {
        found++;
    }
    /* No longer than what is found: the guards then lie right behind the last contact. */
    narc_contacts out = create_guarded_contacts(found);
    size_t out_count = SIZE_MAX;
    assert_int_equal(narc_find_contacts(store, &columns->bodies, &columns->pairs, margin, 1, &out, &out_count, NULL),
                     NARC_OK);
    assert_int_equal(out_count, found);
    for (size_t k = 0; k < found; k++) {
        assert_int_equal(out.pair[k] + first, all->view.pair[from + k]);
    }
    assert_memory_equal(out.separation, all->view.separation + from, found * sizeof(float));
    assert_memory_equal(out.normal_x, all->view.normal_x + from, found * sizeof(float));
    assert_memory_equal(out.normal_y, all->view.normal_y + from, found * sizeof(float));
    assert_memory_equal(out.point_x, all->view.point_x + from, found * sizeof(float));
    assert_memory_equal(out.point_y, all->view.point_y + from, found * sizeof(float));
    assert_memory_equal(out.arc_a, all->view.arc_a + from, found);
    assert_memory_equal(out.arc_b, all->view.arc_b + from, found);
    destroy_guarded_contacts(&out);
}

/* Pairs first .. first + count - 1 of a scene in one layout. */
static void check_layout(const struct scene *scene, const narc_shapes *store, const struct expected *expected,
                         enum layout layout, size_t first, size_t count) {
    struct columns columns = create_columns(scene, layout, first, count);
    check_overlaps(store, &columns, expected->bits, first);
    for (int m = 0; m < MARGINS; m++) {
        check_contacts(store, &columns, &expected->contacts[m], margins[m], first);
    }
    destroy_columns(&columns);
}

static void check_all_counts(const char *name, enum layout layout, narc_precision precision) {
    struct test_random random = test_random_named(name);
    struct scene scene = make_random_scene(&random, precision, BODIES, 2 * SMALL_COUNTS);
    if (layout == LAYOUT_SHARED) {
        share_values(&scene);
    } else if (layout == LAYOUT_UNSCALED) {
        unit_scales(&scene);
    }
    narc_shapes *store = guard_store(&scene);
    struct expected expected = expect(&scene);
    for (size_t count = 0; count < SMALL_COUNTS; count++) {
        check_layout(&scene, store, &expected, layout, random_below(&random, SMALL_COUNTS), count);
    }
    destroy_expected(&expected);
    narc_destroy_shapes(store);
    destroy_scene(&scene);
}

static void test_arrays(void **state) {
    (void)state;
    check_all_counts("arrays", LAYOUT_ARRAYS, NARC_FLOAT32);
    check_all_counts("arrays, double", LAYOUT_ARRAYS, NARC_FLOAT64);
}

static void test_structures(void **state) {
    (void)state;
    check_all_counts("structures", LAYOUT_STRUCTURES, NARC_FLOAT32);
    check_all_counts("structures, double", LAYOUT_STRUCTURES, NARC_FLOAT64);
    check_all_counts("reversed", LAYOUT_REVERSED, NARC_FLOAT32);
    check_all_counts("reversed, double", LAYOUT_REVERSED, NARC_FLOAT64);
}

static void test_shared_values(void **state) {
    (void)state;
    check_all_counts("shared", LAYOUT_SHARED, NARC_FLOAT32);
    check_all_counts("shared, double", LAYOUT_SHARED, NARC_FLOAT64);
    check_all_counts("unscaled", LAYOUT_UNSCALED, NARC_FLOAT32);
}

static void test_large_counts(void **state) {
    (void)state;
    static const size_t counts[] = {1000, 1024, 4099, 20000};
    struct test_random random = test_random_named("large counts");
    for (size_t k = 0; k < sizeof(counts) / sizeof(counts[0]); k++) {
        size_t count = test_trials(counts[k]);
        struct scene scene = make_random_scene(&random, k % 2 ? NARC_FLOAT64 : NARC_FLOAT32, 1000, count);
        narc_shapes *store = guard_store(&scene);
        struct expected expected = expect(&scene);
        check_layout(&scene, store, &expected, LAYOUT_STRUCTURES, 0, count);
        destroy_expected(&expected);
        narc_destroy_shapes(store);
        destroy_scene(&scene);
    }
}

/* All pairs the same, and all different shapes next to each other: lanes must not depend on their neighbours. */
static void test_neighbours(void **state) {
    (void)state;
    struct test_random random = test_random_named("neighbours");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, BODIES, 200);
    struct contacts all = scene_contacts(&scene, INFINITY);
    for (uint32_t k = 0; k < 200; k++) {
        struct pair chosen = scene.pairs[k];
        struct scene repeated = scene;
        struct pair pairs[40];
        for (size_t i = 0; i < 40; i++) {
            pairs[i] = chosen;
        }
        repeated.pairs = pairs;
        repeated.pair_count = 1 + k % 40;
        struct contacts same = scene_contacts(&repeated, INFINITY);
        for (size_t i = 0; i < same.count; i++) {
            assert_memory_equal(&same.view.separation[i], &all.view.separation[k], sizeof(float));
            assert_memory_equal(&same.view.point_x[i], &all.view.point_x[k], sizeof(float));
            assert_memory_equal(&same.view.point_y[i], &all.view.point_y[k], sizeof(float));
            assert_memory_equal(&same.view.normal_x[i], &all.view.normal_x[k], sizeof(float));
        }
        destroy_contacts(&same);
    }
    destroy_contacts(&all);
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arrays),       cmocka_unit_test(test_structures), cmocka_unit_test(test_shared_values),
        cmocka_unit_test(test_large_counts), cmocka_unit_test(test_neighbours),
    };
    return test_begin() ? cmocka_run_group_tests_name("kernels", tests, NULL, NULL) : TEST_SKIPPED;
}
