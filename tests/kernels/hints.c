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

/* Calls with these hints: right with any margin, and leave the same hints on every instruction set and with any number
 * of threads. `out_hints` gets those of margin 0; it may be `hints`, or NULL. */
static void check_hints(const struct scene *scene, const uint32_t *hints, uint32_t *out_hints, const char *name) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const struct plain_batch batch = make_plain_batch(scene, &bodies, &pairs, name);
    const size_t size = pairs.count * sizeof *hints;
    uint32_t *left = create_hints(pairs.count), *other = create_hints(pairs.count);
    const narc_workers two = narc_openmp_workers(2);
    for (size_t m = 0; m < MARGINS; m++) {
        memcpy(left, hints, size);
        check_plain_contacts(&batch, &(narc_query){.margin = margins[m], .hints = NARC_HINT_ARRAY(left)});
        const narc_query query = {.margin = margins[m], .hints = NARC_HINT_ARRAY(other), .workers = &two};
        memcpy(other, hints, size);
        check_plain_contacts(&batch, &query);
        assert_memory_equal(left, other, size);
        memcpy(other, hints, size); /* those of manifolds are the same */
        free(find_manifolds(scene->store, &bodies, &pairs, &query).rows);
        assert_memory_equal(left, other, size);
        test_use_isa("scalar");
        memcpy(other, hints, size);
        check_plain_contacts(&batch, &(narc_query){.margin = margins[m], .hints = NARC_HINT_ARRAY(other)});
        test_use_isa(test_isa());
        assert_memory_equal(left, other, size);
        if (m == 0 && out_hints)
            memcpy(out_hints, left, size);
    }
    free(left);
    free(other);
    free(batch.right);
}

TEST(test_frames) {
    struct test_random random = test_random_named("frames");
    for (size_t round = 0; round < test_trials(2); round++) {
        struct scene scene = make_scene(&random, 2500);
        uint32_t *hints = create_hints(scene.pair_count), *zeros = create_hints(scene.pair_count);
        for (size_t frame = 0; frame < 8; frame++) {
            check_hints(&scene, hints, hints, "frames");
            if (frame == 0) /* there are some */
                assert_true(memcmp(hints, zeros, scene.pair_count * sizeof *hints) != 0);
            scene_move_bodies(&scene, &random, frame < 5 ? 0.01 : 1e-6);
        }
        free(hints);
        free(zeros);
        destroy_scene(&scene);
    }
}

/* Those of other pairs, of other places, and of other shapes. */
TEST(test_stale) {
    struct test_random random = test_random_named("stale");
    for (size_t round = 0; round < test_trials(4); round++) {
        struct scene scene = make_scene(&random, 2500), other = make_scene(&random, 2500);
        const size_t count = scene.pair_count < other.pair_count ? scene.pair_count : other.pair_count;
        scene.pair_count = other.pair_count = count;
        uint32_t *hints = create_hints(count);
        check_hints(&scene, hints, hints, "zeros");
        check_hints(&other, hints, NULL, "another scene's");
        scene_move_bodies(&scene, &random, 3);
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

TEST(test_garbage) {
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
TEST(test_guards) {
    struct test_random random = test_random_named("guarded hints");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 60, 1200);
    narc_shapes *store = guard_store(&scene);
    for (size_t count = 0; count < 140; count += 1 + count / 20) {
        for (size_t m = 0; m < MARGINS; m++) {
            struct columns columns = create_columns(&scene, LAYOUT_STRUCTURES, random_below(&random, 1000), count);
            narc_contact *out = guard_allocate(count * sizeof *out), *again = guard_allocate(count * sizeof *again);
            uint32_t *hints = guard_allocate(count * sizeof *hints); /* junk */
            const narc_query query = {.margin = margins[m], .hints = NARC_HINT_ARRAY(hints)};
            size_t found = 0, found_again = 0;
            assert_int_equal(
                narc_find_contacts(store, &columns.bodies, &columns.pairs, &query, out, count, &found, NULL), NARC_OK);
            assert_int_equal(
                narc_find_contacts(store, &columns.bodies, &columns.pairs, &query, again, count, &found_again, NULL),
                NARC_OK);
            assert_int_equal(found, found_again);
            assert_memory_equal(out, again, found * sizeof *out);
            guard_release(hints);
            guard_release(out);
            guard_release(again);
            destroy_columns(&columns);
        }
    }
    narc_destroy_shapes(store);
    destroy_scene(&scene);
}

/* A hint of a pair within the caller's own structure. */
struct cache {
    uint64_t before;
    uint32_t hint, after;
};

/* Sub-ranges one by one leave what the whole batch leaves, and touch no hints but their own; a column with a stride has
 * those of an array. */
TEST(test_ranges) {
    enum { PAIRS = 3000 };
    struct test_random random = test_random_named("hinted ranges");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    static struct cache caches[PAIRS], before[PAIRS];
    uint32_t *whole = create_hints(PAIRS);
    narc_contact *part = make_junk(PAIRS * sizeof *part);
    memset(caches, 0xa5, sizeof caches);
    for (size_t round = 0; round < test_trials(20); round++) {
        size_t first = 0, listed = 0;
        for (size_t k = 0; k < PAIRS; k++)
            caches[k].hint = whole[k] = round % 2 ? caches[k].hint : (uint32_t)random_bits(&random);
        const narc_query asked = {.margin = 0.1f, .hints = NARC_HINT_ARRAY(whole)};
        struct contacts all = find_contacts(scene.store, &bodies, &pairs, &asked);
        while (first < PAIRS) {
            const size_t wanted = 1 + random_below(&random, round % 3 ? 200 : 2000);
            const size_t count = wanted < PAIRS - first ? wanted : PAIRS - first;
            const narc_query query = {
                .margin = 0.1f, .hints = NARC_HINT_COLUMN(caches, hint), .first = first, .count = count};
            size_t found;
            memcpy(before, caches, sizeof before);
            for (size_t k = first; k < first + count; k++)
                before[k].hint = whole[k];
            assert_int_equal(ask_contacts(&scene, &query, part, PAIRS, &found, NULL), NARC_OK);
            assert_memory_equal(caches, before, sizeof before);
            assert_true(listed + found <= all.count);
            assert_memory_equal(part, all.rows + listed, found * sizeof *part);
            listed += found;
            first += count;
        }
        assert_int_equal(listed, all.count);
        free(all.rows);
    }
    free(whole);
    free(part);
    destroy_scene(&scene);
}

/* Of a selection, the hints of its pairs alone are read and written, wherever they stand in it. */
TEST(test_selections) {
    enum { PAIRS = 3000, EVERY = 7 };
    struct test_random random = test_random_named("hinted selections");
    struct scene scene = make_random_scene(&random, NARC_FLOAT32, 200, PAIRS);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    uint32_t *hints = create_hints(PAIRS), *whole = create_hints(PAIRS), selection[PAIRS];
    for (uint32_t k = 0; k < PAIRS; k++) {
        hints[k] = whole[k] = (uint32_t)random_bits(&random) & 0x0f0f;
        selection[k] = PAIRS - 1 - k;
    }
    struct contacts all =
        find_contacts(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.1f, .hints = NARC_HINT_ARRAY(whole)});
    for (size_t k = 0; k < PAIRS; k += EVERY)
        whole[PAIRS - 1 - k] = hints[PAIRS - 1 - k]; /* the pairs that are not asked of keep theirs */
    size_t selected = 0, expected = 0;
    for (size_t k = 0; k < PAIRS; k++)
        if (k % EVERY != 0)
            selection[selected++] = selection[k];
    const narc_query query = {.margin = 0.1f,
                              .hints = NARC_HINT_ARRAY(hints),
                              .selection = NARC_ARRAY(selection),
                              .selection_count = selected};
    struct contacts found = find_contacts(scene.store, &bodies, &pairs, &query);
    assert_memory_equal(hints, whole, PAIRS * sizeof *hints);
    for (size_t k = all.count; k-- > 0;)
        if ((PAIRS - 1 - all.rows[k].pair) % EVERY != 0)
            assert_memory_equal(&found.rows[expected++], &all.rows[k], sizeof *all.rows);
    assert_int_equal(expected, found.count);
    free(hints);
    free(whole);
    free(all.rows);
    free(found.rows);
    destroy_scene(&scene);
}

TEST_MAIN("hints")
