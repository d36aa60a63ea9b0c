/* SPDX-License-Identifier: MIT
 *
 * hints.c - hints change no bit, whatever they are; what is left of them is the same everywhere.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "hard.h"
#include "layouts.h"
#include "plain.h"

static const float margins[] = {0, 0.2f, -0.1f, INFINITY};
enum { MARGINS = sizeof margins / sizeof *margins };

static uint32_t *create_hints(size_t count) {
    uint32_t *hints = calloc(count + 1, sizeof *hints);
    assert_non_null(hints);
    return hints;
}

/* A scene of everything: random pairs, and some in hard places. */
static struct scene make_scene(struct test_random *random, size_t pairs) {
    enum { HARD_SHAPES = 40 };
    const size_t hard_pairs = HARD_SHAPES / 2 * HARD_BODIES / 2;
    const struct scene plain = make_random_scene(random, NARC_FLOAT32, 300, pairs);
    struct scene scene = create_scene(NARC_FLOAT32, plain.shape_count + HARD_SHAPES, plain.body_count + 2 * hard_pairs,
                                      pairs + hard_pairs);
    for (size_t k = 0; k < plain.shape_count; k++)
        scene_add_shape(&scene, &plain.shapes[k]);
    for (size_t k = 0; k < plain.body_count; k++)
        scene_add_body(&scene, plain.bodies[k]);
    for (size_t k = 0; k < pairs; k++)
        scene_add_pair(&scene, plain.pairs[k].a, plain.pairs[k].b);
    for (size_t k = 0; k < HARD_SHAPES / 2; k++) {
        const struct shape a = make_hard_shape(random, (enum hard_family)random_below(random, HARD_COUNT));
        const struct shape b = make_hard_shape(random, (enum hard_family)random_below(random, HARD_COUNT));
        const uint32_t index = scene_add_shape(&scene, &a);
        add_hard_pairs(random, &scene, (enum hard_placement)(k % HARD_PLACES), index, scene_add_shape(&scene, &b));
    }
    struct scene done = plain;
    destroy_scene(&done);
    return scene;
}

/* A step of all bodies, small or not. */
static void move_bodies(struct test_random *random, struct scene *scene, double step) {
    for (size_t k = 0; k < scene->body_count; k++) {
        struct body *body = &scene->bodies[k];
        const double angle = atan2((double)body->sine, (double)body->cosine) + step * random_between(random, -1, 1);
        body->cosine = (float)cos(angle);
        body->sine = (float)sin(angle);
        body->x += (double)body->scale * step * random_between(random, -1, 1);
        body->y += (double)body->scale * step * random_between(random, -1, 1);
        round_position(body, scene->precision);
    }
}

/* Calls with these hints: right with any margin, and leave the same hints on every instruction set and with any number
 * of threads. `out_hints` gets those of margin 0; it may be `hints`, or NULL. */
static void check_hints(const struct scene *scene, const uint32_t *hints, uint32_t *out_hints, const char *name) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    struct contacts right = find_plain_contacts(scene->store, &bodies, &pairs);
    const struct plain_batch batch = {
        .shapes = scene->store, .bodies = &bodies, .pairs = &pairs, .right = right.rows, .scene = scene, .name = name};
    const size_t size = pairs.count * sizeof *hints;
    uint32_t *left = create_hints(pairs.count), *other = create_hints(pairs.count);
    for (size_t m = 0; m < MARGINS; m++) {
        memcpy(left, hints, size);
        check_plain_contacts(&batch, margins[m], 1, left);
        memcpy(other, hints, size);
        check_plain_contacts(&batch, margins[m], 2, other);
        assert_memory_equal(left, other, size);
        test_use_isa("scalar");
        memcpy(other, hints, size);
        check_plain_contacts(&batch, margins[m], 1, other);
        test_use_isa(test_isa());
        assert_memory_equal(left, other, size);
        if (m == 0 && out_hints)
            memcpy(out_hints, left, size);
    }
    free(left);
    free(other);
    free(right.rows);
}

static void test_frames(void **state) {
    (void)state;
    struct test_random random = test_random_named("frames");
    for (size_t round = 0; round < test_trials(2); round++) {
        struct scene scene = make_scene(&random, 2500);
        uint32_t *hints = create_hints(scene.pair_count), *zeros = create_hints(scene.pair_count);
        for (size_t frame = 0; frame < 8; frame++) {
            check_hints(&scene, hints, hints, "frames");
            if (frame == 0) /* there are some */
                assert_true(memcmp(hints, zeros, scene.pair_count * sizeof *hints) != 0);
            move_bodies(&random, &scene, frame < 5 ? 0.01 : 1e-6);
        }
        free(hints);
        free(zeros);
        destroy_scene(&scene);
    }
}

/* Those of other pairs, of other places, and of other shapes. */
static void test_stale(void **state) {
    (void)state;
    struct test_random random = test_random_named("stale");
    for (size_t round = 0; round < test_trials(4); round++) {
        struct scene scene = make_scene(&random, 2500), other = make_scene(&random, 2500);
        const size_t count = scene.pair_count < other.pair_count ? scene.pair_count : other.pair_count;
        scene.pair_count = other.pair_count = count;
        uint32_t *hints = create_hints(count);
        check_hints(&scene, hints, hints, "zeros");
        check_hints(&other, hints, NULL, "another scene's");
        move_bodies(&random, &scene, 3);
        check_hints(&scene, hints, hints, "hours old");
        for (size_t k = count - 1; k > 0; k--) {
            const size_t i = random_below(&random, k + 1);
            const uint32_t swapped = hints[k];
            hints[k] = hints[i];
            hints[i] = swapped;
        }
        check_hints(&scene, hints, NULL, "another pair's");
        free(hints);
        destroy_scene(&scene);
        destroy_scene(&other);
    }
}

static void test_garbage(void **state) {
    (void)state;
    struct test_random random = test_random_named("garbage hints");
    for (size_t round = 0; round < test_trials(4); round++) {
        struct scene scene = make_scene(&random, 2500);
        uint32_t *hints = create_hints(scene.pair_count);
        for (size_t k = 0; k < scene.pair_count; k++)
            hints[k] = (uint32_t)random_bits(&random);
        check_hints(&scene, hints, NULL, "random bits");
        for (size_t k = 0; k < scene.pair_count; k++) { /* mostly arcs that exist, or nearly */
            const size_t limit = random_below(&random, 2) ? 5 : NARC_MAX_ARCS + 3;
            const uint32_t of_a = (uint32_t)random_below(&random, limit), of_b = (uint32_t)random_below(&random, limit);
            const uint32_t high = random_below(&random, 4) ? 0 : (uint32_t)random_bits(&random) << 16;
            hints[k] = of_a | of_b << 8 | high;
        }
        check_hints(&scene, hints, NULL, "random arcs");
        memset(hints, 0xff, scene.pair_count * sizeof *hints);
        check_hints(&scene, hints, NULL, "all ones");
        for (size_t k = 0; k < scene.pair_count; k++)
            hints[k] = 0x80000000u >> k % 32;
        check_hints(&scene, hints, NULL, "single bits");
        free(hints);
        destroy_scene(&scene);
    }
}

/* Hints between forbidden pages, for batches of every small size. */
static void test_guards(void **state) {
    (void)state;
    struct test_random random = test_random_named("guarded hints");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 60, 1200);
    narc_shapes *store = guard_store(&scene);
    for (size_t count = 0; count < 140; count += 1 + count / 20) {
        for (size_t m = 0; m < MARGINS; m++) {
            struct columns columns = create_columns(&scene, LAYOUT_STRUCTURES, random_below(&random, 1000), count);
            narc_contacts out = create_guarded_contacts(count), again = create_guarded_contacts(count);
            uint32_t *hints = guard_allocate(count * sizeof *hints); /* junk */
            size_t found = 0, found_again = 0;
            assert_int_equal(narc_find_contacts_hinted(store, &columns.bodies, &columns.pairs, margins[m], 1, hints,
                                                       &out, &found, NULL),
                             NARC_OK);
            assert_int_equal(narc_find_contacts_hinted(store, &columns.bodies, &columns.pairs, margins[m], 1, hints,
                                                       &again, &found_again, NULL),
                             NARC_OK);
            assert_int_equal(found, found_again);
            assert_memory_equal(out.separation, again.separation, found * sizeof(float));
            assert_memory_equal(out.arc_a, again.arc_a, found);
            guard_release(hints);
            destroy_guarded_contacts(&out);
            destroy_guarded_contacts(&again);
            destroy_columns(&columns);
        }
    }
    narc_destroy_shapes(store);
    destroy_scene(&scene);
}

/* Sub-ranges one by one leave what the whole batch leaves, and touch no hints but their own. */
static void test_ranges(void **state) {
    (void)state;
    enum { PAIRS = 3000 };
    struct test_random random = test_random_named("hinted ranges");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    struct contacts all = create_contacts(PAIRS), part = create_contacts(PAIRS);
    uint32_t *hints = create_hints(PAIRS), *whole = create_hints(PAIRS), *before = create_hints(PAIRS);
    for (size_t round = 0; round < test_trials(20); round++) {
        size_t first = 0, listed = 0;
        for (size_t k = 0; k < PAIRS; k++)
            hints[k] = whole[k] = round % 2 ? hints[k] : (uint32_t)random_bits(&random);
        assert_int_equal(
            narc_find_contacts_hinted(scene.store, &bodies, &pairs, 0.1f, 1, whole, &all.view, &all.count, NULL),
            NARC_OK);
        while (first < PAIRS) {
            const size_t wanted = 1 + random_below(&random, round % 3 ? 200 : 2000);
            const size_t count = wanted < PAIRS - first ? wanted : PAIRS - first;
            memcpy(before, hints, PAIRS * sizeof *hints);
            assert_int_equal(narc_find_contacts_hinted_range(scene.store, &bodies, &pairs, first, count, 0.1f, hints,
                                                             &part.view, &part.count, NULL),
                             NARC_OK);
            assert_memory_equal(hints, before, first * sizeof *hints);
            assert_memory_equal(hints + first, whole + first, count * sizeof *hints);
            assert_memory_equal(hints + first + count, before + first + count, (PAIRS - first - count) * sizeof *hints);
            assert_memory_equal(part.view.pair, all.view.pair + listed, part.count * sizeof(uint32_t));
            assert_memory_equal(part.view.separation, all.view.separation + listed, part.count * sizeof(float));
            assert_memory_equal(part.view.arc_b, all.view.arc_b + listed, part.count);
            listed += part.count;
            first += count;
        }
        assert_int_equal(listed, all.count);
    }
    narc_error error;
    assert_int_equal(
        narc_find_contacts_hinted_range(scene.store, &bodies, &pairs, 0, 10, 0, NULL, &part.view, &part.count, &error),
        NARC_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "hints"));
    assert_int_equal(narc_find_contacts_hinted_range(scene.store, &bodies, &pairs, PAIRS - 5, 10, 0, hints, &part.view,
                                                     &part.count, &error),
                     NARC_ERROR_ARGUMENT);
    assert_memory_equal(hints, whole, PAIRS * sizeof *hints);
    free(hints);
    free(whole);
    free(before);
    free(all.rows);
    free(part.rows);
    destroy_scene(&scene);
}

static void test_errors(void **state) {
    (void)state;
    enum { PAIRS = 3000 };
    struct test_random random = test_random_named("hint errors");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, PAIRS);
    narc_bodies bodies = scene_bodies(&scene);
    narc_pairs pairs = scene_pairs(&scene);
    struct contacts out = create_contacts(PAIRS), shorter = create_contacts(PAIRS);
    uint32_t *hints = create_hints(PAIRS), *before = create_hints(PAIRS), *enough = create_hints(PAIRS);
    size_t found = 12345;
    narc_error error;
    for (size_t k = 0; k < PAIRS; k++)
        hints[k] = before[k] = enough[k] = (uint32_t)random_bits(&random);
#define EXPECT(status, words, ...)                                                                                     \
    do {                                                                                                               \
        assert_int_equal(narc_find_contacts_hinted(__VA_ARGS__, &error), status);                                      \
        assert_non_null(strstr(error.message, words));                                                                 \
        assert_memory_equal(hints, before, PAIRS * sizeof *hints);                                                     \
        assert_int_equal(found, 12345);                                                                                \
    } while (0)
    EXPECT(NARC_ERROR_ARGUMENT, "hints", scene.store, &bodies, &pairs, 0, 1, NULL, &out.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "shapes", NULL, &bodies, &pairs, 0, 1, hints, &out.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "bodies", scene.store, NULL, &pairs, 0, 1, hints, &out.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "pairs", scene.store, &bodies, NULL, 0, 1, hints, &out.view, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "out_contacts", scene.store, &bodies, &pairs, 0, 1, hints, NULL, &found);
    EXPECT(NARC_ERROR_ARGUMENT, "out_count", scene.store, &bodies, &pairs, 0, 1, hints, &out.view, NULL);
    EXPECT(NARC_ERROR_NOT_FINITE, "margin", scene.store, &bodies, &pairs, NAN, 1, hints, &out.view, &found);
    scene.pairs[PAIRS - 1].b = 200;
    EXPECT(NARC_ERROR_INDEX, "2999", scene.store, &bodies, &pairs, 0, 1, hints, &out.view, &found);
    scene.pairs[PAIRS - 1].b = 0;
#undef EXPECT

    /* Too short a list: what fits is the start of the whole list, and hints are as with enough room. */
    assert_int_equal(narc_find_contacts_hinted(scene.store, &bodies, &pairs, 0, 1, enough, &out.view, &found, NULL),
                     NARC_OK);
    assert_true(found > 100);
    for (unsigned threads = 1; threads <= 2; threads++) {
        size_t needed = 0;
        shorter.view.capacity = found - 1 - random_below(&random, found - 1);
        memcpy(hints, before, PAIRS * sizeof *hints);
        assert_int_equal(
            narc_find_contacts_hinted(scene.store, &bodies, &pairs, 0, threads, hints, &shorter.view, &needed, &error),
            NARC_ERROR_CAPACITY);
        assert_int_equal(needed, found);
        assert_memory_equal(shorter.view.separation, out.view.separation, shorter.view.capacity * sizeof(float));
        assert_memory_equal(hints, enough, PAIRS * sizeof *hints);
    }

    /* No pairs: nothing to hint at. */
    pairs.count = 0;
    assert_int_equal(narc_find_contacts_hinted(scene.store, &bodies, &pairs, 0, 1, NULL, &out.view, &found, NULL),
                     NARC_OK);
    assert_int_equal(found, 0);
    free(hints);
    free(before);
    free(enough);
    free(out.rows);
    free(shorter.rows);
    destroy_scene(&scene);
}

/* Circles alone, as far from each other as not: pairs that are apart keep their hints. */
static void test_discs(void **state) {
    (void)state;
    enum { SHAPES = 8, DISCS = 200, DISC_PAIRS = 1003 };
    struct test_random random = test_random_named("hints of discs");
    struct scene scene = create_scene(NARC_FLOAT32, SHAPES, DISCS, DISC_PAIRS);
    for (size_t k = 0; k < SHAPES; k++) {
        const struct shape shape = make_shape(&random, FAMILY_CIRCLE);
        scene_add_shape(&scene, &shape);
    }
    for (size_t k = 0; k < DISCS; k++) {
        struct body body = turned_body(random_between(&random, 0, 6), random_between(&random, 0.5, 2));
        body.x = random_between(&random, 0, 8);
        body.y = random_between(&random, 0, 8);
        body.shape = (uint32_t)random_below(&random, SHAPES);
        scene_add_body(&scene, body);
    }
    uint32_t *hints = create_hints(DISC_PAIRS);
    for (size_t k = 0; k < DISC_PAIRS; k++) {
        scene_add_pair(&scene, (uint32_t)random_below(&random, DISCS), (uint32_t)random_below(&random, DISCS));
        hints[k] = (uint32_t)random_bits(&random);
    }
    check_hints(&scene, hints, NULL, "discs");
    free(hints);
    destroy_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames), cmocka_unit_test(test_stale),  cmocka_unit_test(test_garbage),
        cmocka_unit_test(test_guards), cmocka_unit_test(test_errors), cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_discs),
    };
    return test_begin() ? cmocka_run_group_tests_name("hints", tests, NULL, NULL) : TEST_SKIPPED;
}
