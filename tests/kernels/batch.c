/* SPDX-License-Identifier: MIT
 *
 * batch.c - threads, sub-ranges, margins and capacities: however a batch is cut, the bytes are the same.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

/* Enough for every thread to get several chunks. */
enum { PAIRS = 20011 };

static struct scene make_scene(const char *name, size_t pairs) {
    struct test_random random = test_random_named(name);
    return make_random_scene(&random, NARC_FLOAT32, 500, pairs);
}

/* Items from .. from + count - 1 of `expected` are items 0 .. count - 1 of `list`. */
static void check_same_items(const narc_contacts *expected, size_t from, const narc_contacts *list, size_t count) {
    assert_memory_equal(expected->pair + from, list->pair, count * sizeof(uint32_t));
    assert_memory_equal(expected->separation + from, list->separation, count * sizeof(float));
    assert_memory_equal(expected->normal_x + from, list->normal_x, count * sizeof(float));
    assert_memory_equal(expected->normal_y + from, list->normal_y, count * sizeof(float));
    assert_memory_equal(expected->point_x + from, list->point_x, count * sizeof(float));
    assert_memory_equal(expected->point_y + from, list->point_y, count * sizeof(float));
    assert_memory_equal(expected->arc_a + from, list->arc_a, count);
    assert_memory_equal(expected->arc_b + from, list->arc_b, count);
}

static bool is_junk(const void *memory, size_t size) {
    const unsigned char *byte = memory;
    for (size_t k = 0; k < size; k++)
        if (byte[k] != 0xa5)
            return false;
    return true;
}

/* Items from .. capacity - 1 still hold what create_contacts() put there. */
static void check_untouched(const struct contacts *contacts, size_t from, size_t capacity) {
    const narc_contacts *c = &contacts->view;
    size_t count = capacity - from;
    assert_true(is_junk(c->pair + from, count * sizeof(uint32_t)));
    assert_true(is_junk(c->separation + from, count * sizeof(float)));
    assert_true(is_junk(c->normal_x + from, count * sizeof(float)));
    assert_true(is_junk(c->normal_y + from, count * sizeof(float)));
    assert_true(is_junk(c->point_x + from, count * sizeof(float)));
    assert_true(is_junk(c->point_y + from, count * sizeof(float)));
    assert_true(is_junk(c->arc_a + from, count));
    assert_true(is_junk(c->arc_b + from, count));
}

static void test_threads(void **state) {
    (void)state;
    static const unsigned threads[] = {0, 2, 3, 7, 64};
    static const size_t counts[] = {1, 63, 1024, 1025, PAIRS};
    for (size_t s = 0; s < sizeof(counts) / sizeof(counts[0]); s++) {
        struct scene scene = make_scene("threads", counts[s]);
        size_t words = NARC_BIT_WORDS(counts[s]);
        narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        uint64_t *serial_bits = scene_overlaps(&scene), *bits = calloc(words + 1, sizeof(uint64_t));
        struct contacts serial = scene_contacts(&scene, 0), all = scene_contacts(&scene, INFINITY);
        for (size_t t = 0; t < sizeof(threads) / sizeof(threads[0]); t++) {
            bits[words] = 0x0123456789abcdefu;
            assert_int_equal(narc_find_overlaps(scene.store, &bodies, &pairs, threads[t], bits, NULL), NARC_OK);
            assert_memory_equal(bits, serial_bits, words * sizeof(uint64_t));
            assert_true(bits[words] == 0x0123456789abcdefu);
            for (int every = 0; every < 2; every++) {
                const struct contacts *expected = every ? &all : &serial;
                struct contacts found = create_contacts(counts[s] + 5);
                found.view.capacity = counts[s];
                assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, every ? INFINITY : 0, threads[t],
                                                    &found.view, &found.count, NULL),
                                 NARC_OK);
                assert_int_equal(found.count, expected->count);
                check_same_items(&expected->rows[0], &found.view, found.count);
                check_untouched(&found, counts[s], counts[s] + 5);
                free(found.rows);
            }
        }
        free(serial.rows);
        free(all.rows);
        free(serial_bits);
        free(bits);
        destroy_scene(&scene);
    }
}

/* Sub-ranges of 64, 128 ... pairs, in any order, write their own words only and together say what the whole call
 * says. */
static void test_overlap_ranges(void **state) {
    (void)state;
    struct test_random random = test_random_named("overlap ranges");
    for (size_t round = 0; round < test_trials(40); round++) {
        size_t count = 1 + random_below(&random, 3000), words = NARC_BIT_WORDS(count);
        struct scene scene = make_scene("ranges", count);
        narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        uint64_t *whole = scene_overlaps(&scene), *glued = malloc(words * sizeof(uint64_t));
        memset(glued, 0xa5, words * sizeof(uint64_t));
        for (size_t first = 0; first < words;) {
            size_t step = 1 + random_below(&random, 5), last = first + step < words ? first + step : words;
            size_t from = first * 64, pair_count = last == words ? count - from : step * 64;
            assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, from, pair_count, glued, NULL),
                             NARC_OK);
            assert_memory_equal(glued, whole, last * sizeof(uint64_t));
            assert_true(is_junk(glued + last, (words - last) * sizeof(uint64_t)));
            first = last;
        }
        /* A sub-range in the middle leaves both sides alone. */
        if (words > 2) {
            memset(glued, 0xa5, words * sizeof(uint64_t));
            assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, 64, 64, glued, NULL), NARC_OK);
            assert_true(is_junk(glued, 8) && glued[1] == whole[1] && is_junk(glued + 2, (words - 2) * 8));
        }
        assert_int_equal(narc_find_overlaps_range(scene.store, &bodies, &pairs, 0, 0, NULL, NULL), NARC_OK);
        free(whole);
        free(glued);
        destroy_scene(&scene);
    }
}

/* Sub-ranges of any length: their lists one after another are the whole list. */
static void test_contact_ranges(void **state) {
    (void)state;
    struct test_random random = test_random_named("contact ranges");
    for (size_t round = 0; round < test_trials(40); round++) {
        size_t count = 1 + random_below(&random, 3000), seen = 0;
        struct scene scene = make_scene("ranges", count);
        narc_bodies bodies = scene_bodies(&scene);
        narc_pairs pairs = scene_pairs(&scene);
        float margin = round % 3 ? 0.1f : INFINITY;
        struct contacts whole = scene_contacts(&scene, margin), part = create_contacts(count);
        for (size_t first = 0; first < count;) {
            size_t step = random_below(&random, 300), size = step < count - first ? step : count - first;
            assert_int_equal(narc_find_contacts_range(scene.store, &bodies, &pairs, first, size, margin, &part.view,
                                                      &part.count, NULL),
                             NARC_OK);
            assert_true(part.count <= size && seen + part.count <= whole.count);
            check_same_items(&whole.view, seen, &part.view, part.count);
            seen += part.count;
            first += size;
        }
        assert_int_equal(seen, whole.count);
        free(whole.rows);
        free(part.rows);
        destroy_scene(&scene);
    }
}

/* A margin keeps exactly the contacts below it out of the list of all, unchanged. */
static void test_margins(void **state) {
    (void)state;
    const float margins[] = {0.0f,   -0.0f,  1e-6f, 0.05f,   0.7f,   100.0f,   3e38f,
                             -1e-6f, -0.05f, -0.7f, -100.0f, -3e38f, -INFINITY};
    struct scene scene = make_scene("margins", 5000);
    struct contacts all = scene_contacts(&scene, INFINITY);
    uint64_t *bits = scene_overlaps(&scene);
    for (size_t m = 0; m < sizeof(margins) / sizeof(margins[0]); m++) {
        struct contacts some = scene_contacts(&scene, margins[m]);
        size_t next = 0;
        for (size_t k = 0; k < all.count; k++) {
            if (all.rows[k].separation < margins[m]) {
                assert_true(next < some.count);
                assert_int_equal(some.rows[next].pair, k);
                assert_memory_equal(&some.rows[next].separation, &all.rows[k].separation, sizeof(float));
                assert_memory_equal(&some.rows[next].point_x, &all.rows[k].point_x, sizeof(float));
                assert_memory_equal(&some.rows[next].normal_y, &all.rows[k].normal_y, sizeof(float));
                next++;
            }
            if (margins[m] == 0)
                assert_int_equal(bit_is_set(bits, k), all.rows[k].separation < 0);
        }
        assert_int_equal(next, some.count);
        free(some.rows);
    }
    free(all.rows);
    free(bits);
    destroy_scene(&scene);
}

/* Too short a list: what fits is there, the needed size is told, nothing behind the list is written. */
static void test_capacity(void **state) {
    (void)state;
    struct test_random random = test_random_named("capacity");
    struct scene scene = make_scene("capacity", 4000);
    narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    struct contacts all = scene_contacts(&scene, 0);
    assert_true(all.count > 100);
    for (size_t trial = 0; trial < 60; trial++) {
        static const size_t fixed[] = {0, 1, 63, 64, 65};
        size_t capacity = trial < 5 ? fixed[trial] : trial == 5 ? all.count - 1 : random_below(&random, all.count);
        unsigned threads = (unsigned)(trial % 4);
        struct contacts some = create_contacts(all.count + 64);
        some.view.capacity = capacity;
        narc_error error = {0};
        narc_status status =
            narc_find_contacts(scene.store, &bodies, &pairs, 0, threads, &some.view, &some.count, &error);
        assert_int_equal(status, NARC_ERROR_CAPACITY);
        assert_int_equal(error.status, NARC_ERROR_CAPACITY);
        assert_int_equal(some.count, all.count);
        check_same_items(&all.rows[0], &some.view, capacity);
        check_untouched(&some, capacity, all.count + 64);
        status = narc_find_contacts_range(scene.store, &bodies, &pairs, 0, 4000, 0, &some.view, &some.count, NULL);
        assert_int_equal(status, NARC_ERROR_CAPACITY);
        assert_int_equal(some.count, all.count);
        check_untouched(&some, capacity, all.count + 64);
        free(some.rows);
    }
    struct contacts exact = create_contacts(all.count + 64);
    exact.view.capacity = all.count;
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 2, &exact.view, &exact.count, NULL), NARC_OK);
    check_untouched(&exact, all.count, all.count + 64);
    free(exact.rows);
    free(all.rows);
    destroy_scene(&scene);
}

/* Any array of a list may be missing; the others are as ever. With none at all, the call counts. */
static void test_missing_arrays(void **state) {
    (void)state;
    struct scene scene = make_scene("missing arrays", 3000);
    narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    struct contacts all = scene_contacts(&scene, 0);
    for (unsigned mask = 0; mask < 256; mask++) {
        struct contacts some = create_contacts(all.count);
        narc_contacts view = some.view;
        view.pair = mask & 1 ? view.pair : NULL;
        view.separation = mask & 2 ? view.separation : NULL;
        view.normal_x = mask & 4 ? view.normal_x : NULL;
        view.normal_y = mask & 8 ? view.normal_y : NULL;
        view.point_x = mask & 16 ? view.point_x : NULL;
        view.point_y = mask & 32 ? view.point_y : NULL;
        view.arc_a = mask & 64 ? view.arc_a : NULL;
        view.arc_b = mask & 128 ? view.arc_b : NULL;
        assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, mask % 3, &view, &some.count, NULL),
                         NARC_OK);
        assert_int_equal(some.count, all.count);
        /* What was not given is compared with itself. */
        view.pair = view.pair ? view.pair : all.view.pair;
        view.separation = view.separation ? view.separation : all.view.separation;
        view.normal_x = view.normal_x ? view.normal_x : all.view.normal_x;
        view.normal_y = view.normal_y ? view.normal_y : all.view.normal_y;
        view.point_x = view.point_x ? view.point_x : all.view.point_x;
        view.point_y = view.point_y ? view.point_y : all.view.point_y;
        view.arc_a = view.arc_a ? view.arc_a : all.view.arc_a;
        view.arc_b = view.arc_b ? view.arc_b : all.view.arc_b;
        check_same_items(&all.rows[0], &view, all.count);
        free(some.rows);
    }
    narc_contacts none = {0};
    size_t needed = 0;
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, 0, 1, &none, &needed, NULL), NARC_ERROR_CAPACITY);
    assert_int_equal(needed, all.count);
    free(all.rows);
    destroy_scene(&scene);
}

static void test_no_pairs(void **state) {
    (void)state;
    struct scene scene = make_scene("no pairs", 1);
    narc_bodies bodies = scene_bodies(&scene), no_bodies = {0};
    narc_pairs none = {0};
    struct contacts contacts = create_contacts(3);
    uint64_t word = 42;
    for (unsigned threads = 0; threads < 3; threads++) {
        assert_int_equal(narc_find_overlaps(scene.store, &bodies, &none, threads, NULL, NULL), NARC_OK);
        assert_int_equal(narc_find_overlaps(scene.store, &no_bodies, &none, threads, &word, NULL), NARC_OK);
        assert_int_equal(word, 42);
        contacts.count = 7;
        assert_int_equal(
            narc_find_contacts(scene.store, &no_bodies, &none, 0, threads, &contacts.view, &contacts.count, NULL),
            NARC_OK);
        assert_int_equal(contacts.count, 0);
        check_untouched(&contacts, 0, 3);
    }
    free(contacts.rows);
    destroy_scene(&scene);
}

/* A body and itself: as deep as it gets, and still an answer. (Only a segment has no depth, it touches itself.) */
static void test_pairs_with_itself(void **state) {
    (void)state;
    struct scene scene = make_scene("itself", 500);
    for (uint32_t k = 0; k < 500; k++)
        scene.pairs[k] = (struct pair){k, k};
    struct contacts all = scene_contacts(&scene, INFINITY);
    uint64_t *bits = scene_overlaps(&scene);
    for (uint32_t k = 0; k < 500; k++) {
        struct reference_body body = scene_reference(&scene, k);
        struct fractions errors = {0};
        const double gap = reference_find_gap(&body, &body).gap;
        assert_true(bit_is_set(bits, k) || (body.count == 2 && gap >= -separation_bound(&body, &body)));
        const char *wrong = check_contact(&body, &body, gap, &all.rows[k], &errors);
        if (wrong) {
            print_pair(&body, &body);
            fail_msg("%s", wrong);
        }
    }
    free(all.rows);
    free(bits);
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),        cmocka_unit_test(test_overlap_ranges),
        cmocka_unit_test(test_contact_ranges), cmocka_unit_test(test_margins),
        cmocka_unit_test(test_capacity),       cmocka_unit_test(test_missing_arrays),
        cmocka_unit_test(test_no_pairs),       cmocka_unit_test(test_pairs_with_itself),
    };
    return test_begin() ? cmocka_run_group_tests_name("batch", tests, NULL, NULL) : TEST_SKIPPED;
}
