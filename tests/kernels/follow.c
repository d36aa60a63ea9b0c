/* SPDX-License-Identifier: MIT
 *
 * follow.c - pairs of smooth shapes that are answered from their entries, and all others anew, against plain calls: the same
 * bits at all poses, and most of them are decided where bodies move little. Rows that are kept, and follow: the same bits as
 * in plain C.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contacts/entries.h"
#include "dispatch.h"
#include "expect.h"
#include "guard.h"
#include "layouts.h"

/* Bodies stand in a square, columns and rows of them, that goes on periodically to the right. */
enum { SIDE = 12, BODIES = SIDE * SIDE, PAIRS = 3 * BODIES, SHAPES = 24 };

enum mixture { SMOOTH, SMOOTH_AND_OTHERS, ELLIPSES };

struct world {
    struct scene scene;
    double size; /* of a body of scale 1, times what all scales have in common */
    double spacing;
    float shift_x[PAIRS], shift_y[PAIRS], margin[PAIRS];
    bool smooth[PAIRS];
};

static struct shape make_ellipse(struct test_random *random, size_t arcs) {
    struct shape shape;
    narc_error error;
    expect_ok(narc_build_ellipse(1, random_between(random, 0.3, 1), arcs, shape.arcs, &shape.count, NULL, &error),
              &error);
    return shape;
}

static struct shape make_smooth(struct test_random *random) {
    static const enum family families[] = {FAMILY_SMOOTH, FAMILY_UNEQUAL, FAMILY_CIRCLE, FAMILY_MANY};
    const size_t kind = random_below(random, 8);
    return kind < 2   ? make_ellipse(random, 4)
           : kind < 4 ? make_ellipse(random, 8)
                      : make_shape(random, families[kind - 4]);
}

static void make_world(struct world *world, struct test_random *random, narc_precision precision, enum mixture mixture,
                       double size, bool many_scales, double far) {
    static const enum family others[] = {FAMILY_BOX, FAMILY_POLYGON, FAMILY_CAPSULE, FAMILY_ROUNDED, FAMILY_THIN};
    struct scene *const scene = &world->scene;
    *scene = create_scene(precision, SHAPES, BODIES, PAIRS);
    world->size = size;
    world->spacing = 1.7 * size;
    for (size_t k = 0; k < SHAPES; k++) {
        struct shape shape = make_smooth(random);
        if (mixture == ELLIPSES)
            shape = k % 8 == 0 ? circle_of(0.8) : make_ellipse(random, k % 2 ? 4 : 8);
        else if (mixture == SMOOTH_AND_OTHERS && k % 2)
            shape = make_shape(random, others[random_below(random, sizeof others / sizeof *others)]);
        scene_add_shape(scene, &shape);
    }
    for (size_t k = 0; k < BODIES; k++) {
        struct body body = turned_body(random_between(random, -PI, PI), size);
        if (many_scales)
            body.scale *= (float)random_between(random, 0.7, 1.3);
        body.shape = (uint32_t)random_below(random, SHAPES);
        body.x = far + world->spacing * ((double)(k % SIDE) + random_between(random, -0.2, 0.2));
        body.y = far + world->spacing * ((double)(k / SIDE) + random_between(random, -0.2, 0.2));
        round_position(&body, precision);
        scene_add_body(scene, body);
    }
    memset(world->shift_y, 0, sizeof world->shift_y);
    for (size_t k = 0; k < BODIES; k++) {
        const size_t column = k % SIDE, right = k - column + (column + 1) % SIDE, up = (k + SIDE) % BODIES;
        const size_t other[] = {right, up, (up - up % SIDE) + (column + 1) % SIDE};
        for (size_t i = 0; i < 3; i++) {
            const uint32_t pair = scene_add_pair(scene, (uint32_t)k, (uint32_t)other[i]);
            world->shift_x[pair] = column + 1 == SIDE && i != 1 ? (float)(SIDE * world->spacing) : 0;
            world->margin[pair] = (float)(size * random_between(random, -0.05, 0.3));
        }
    }
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct pair pair = scene->pairs[k];
        world->smooth[k] = narc_shape_flags(scene->store, scene->bodies[pair.a].shape) &
                           narc_shape_flags(scene->store, scene->bodies[pair.b].shape) & NARC_SHAPE_SMOOTH;
    }
}

/* Some bodies with numbers that are broken, or nearly, and one that is far away. They move on as sound ones. */
static void break_bodies(struct world *world, struct test_random *random) {
    struct body *const body = world->scene.bodies;
    for (size_t k = 0; k < BODIES; k += 3) { /* rotations that are nearly too long or too short */
        const float length = k % 2 ? 1.0002f : 0.9998f;
        body[k].cosine *= length;
        body[k].sine *= length;
    }
    body[random_below(random, BODIES)].cosine = NAN;
    body[random_below(random, BODIES)].sine = 2;
    body[random_below(random, BODIES)].scale = 0;
    body[random_below(random, BODIES)].x = INFINITY;
    body[random_below(random, BODIES)].x = 1e24;
    body[random_below(random, BODIES)].scale = NAN;
    for (size_t k = 0; k < BODIES; k++)
        round_position(&body[k], world->scene.precision);
}

/* What is asked for, and how. */
struct question {
    bool manifolds, shifted, selected;
    enum layout layout;
    size_t more; /* bytes between rows */
    float margin;
    bool margins; /* in place of `margin` */
};

struct counts {
    size_t smooth, smooth_left, all, left;
};

static narc_status ask(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                       const narc_query *query, bool manifolds, void *rows, size_t *out_count, narc_error *error) {
    return manifolds ? narc_find_manifolds(shapes, bodies, pairs, query, rows, PAIRS, out_count, error)
                     : narc_find_contacts(shapes, bodies, pairs, query, rows, PAIRS, out_count, error);
}

/* Answers the world from its entries and anew, compares that with a plain call, and makes the entries of what was answered
 * anew. `entries`: of all pairs, with a guard behind them. */
static void check_frame(const struct world *world, const struct question *q, narc_entry *entries, narc_entry_ends *ends,
                        struct counts *counts) {
    const size_t size = q->manifolds ? sizeof(narc_manifold) : sizeof(narc_contact), stride = size + q->more;
    AUTO(destroy_columns) struct columns columns = create_columns(&world->scene, q->layout, 0, PAIRS);
    const narc_shapes *const shapes = world->scene.store;
    narc_pairs *const pairs = &columns.pairs;
    if (q->shifted) {
        pairs->shift_x = NARC_ARRAY(world->shift_x);
        pairs->shift_y = NARC_ARRAY(world->shift_y);
    }
    uint32_t selection[PAIRS], left[PAIRS + 1], same[PAIRS + 1];
    size_t selected = 0, found, skipped, skipped_of_left = 0;
    for (uint32_t k = 0; k < PAIRS; k++)
        if (!q->selected || k % 3)
            selection[selected++] = k;
    narc_query query = {.margin = q->margin, .dense = 1, .row_stride = (ptrdiff_t)stride, .out_skipped = &skipped};
    if (q->margins)
        query.margins = NARC_ARRAY(world->margin);
    if (q->selected) {
        query.selection = NARC_ARRAY(selection);
        query.selection_count = selected;
    }
    narc_error error;
    const size_t room = (PAIRS - 1) * stride + size;
    AUTO(guard_release_at) char *const right = guard_allocate(room), *const rows = guard_allocate(room);
    test_use_isa("scalar");
    expect_ok(ask(shapes, &columns.bodies, pairs, &query, q->manifolds, right, &found, &error), &error);
    test_use_isa(test_isa());

    narc_batch batch;
    expect_ok(narc_begin_batch(shapes, &columns.bodies, pairs, &query, &batch, &error), &error);
    batch.row_size = size;
    assert_int_equal(batch.count, selected);
    const narc_rows out = {.base = rows, .stride = (ptrdiff_t)stride};
    narc_status status;
    const narc_kernel_table *const kernels = narc_kernels(&status, &error);
    left[0] = same[0] = 0xa5a5a5a5u;
    size_t count = 0;
    for (size_t first = 0, part; first < selected; first += part) { /* any split */
        part = first == 0 ? 7 : selected - first;
        count += kernels->follow(&batch, first, part, entries, ends, &out, left + count);
    }
    assert_int_equal(NARC_KERNELS_FOR(1, kernels)->follow(&batch, 0, selected, entries, ends, &out, same), count);
    assert_memory_equal(left, same, count * sizeof *left);
    for (size_t i = 0; i < count; i++) { /* nothing was written for those that are left */
        assert_true(i == 0 || left[i - 1] < left[i]);
        assert_true(is_junk(rows + left[i] * stride, size));
    }
    if (count > 0) {
        narc_query rest = query;
        rest.selection = NARC_ARRAY(left);
        rest.selection_count = count;
        rest.out_skipped = &skipped_of_left;
        expect_ok(ask(shapes, &columns.bodies, pairs, &rest, q->manifolds, rows, &found, &error), &error);
    }
    assert_int_equal(skipped_of_left, skipped);
    assert_memory_equal(rows, right, room);

    size_t next = 0;
    for (size_t i = 0; i < selected; i++) {
        const uint32_t pair = selection[i];
        const bool is_left = next < count && left[next] == pair;
        next += is_left;
        assert_true(world->smooth[pair] || is_left);
        counts->all++;
        counts->left += is_left;
        counts->smooth += world->smooth[pair];
        counts->smooth_left += world->smooth[pair] && is_left;
    }
    assert_int_equal(next, count);
    narc_make_entries(&batch, 0, count, left, rows, (ptrdiff_t)stride, entries, ends);
}

static void check_world(struct world *world, struct test_random *random, struct question q, double step,
                        struct counts *moved) {
    enum { FRAMES = 8, TELEPORT = 5 };
    AUTO(guard_release_at) narc_entry *const entries = guard_allocate(PAIRS * sizeof *entries);
    narc_entry_ends *const ends = q.manifolds ? guard_allocate(PAIRS * sizeof *ends) : NULL;
    struct counts counts = {0};
    memset(entries, 0, PAIRS * sizeof *entries);
    check_frame(world, &q, entries, ends, &counts);
    assert_int_equal(counts.left, counts.all); /* zeros decide nothing */
    for (size_t frame = 1; frame < FRAMES; frame++) {
        scene_move_bodies(&world->scene, random, frame == TELEPORT ? 2 : step);
        check_frame(world, &q, entries, ends, frame == TELEPORT ? &counts : moved);
    }
    q.margins = false; /* entries know of no margin */
    static const float margins[] = {0, 0.3f, -0.1f, INFINITY, -INFINITY};
    for (size_t k = 0; k < sizeof margins / sizeof *margins; k++) {
        q.margin = margins[k] * (float)world->size;
        check_frame(world, &q, entries, ends, &counts);
    }
    if (ends)
        guard_release(ends);
}

static void print_left(const struct counts *counts) {
    printf("%zu pairs that moved a little, %.2f %% of them left\n", counts->all,
           100 * (double)counts->left / (double)counts->all);
}

static struct question make_question(struct test_random *random, double size) {
    static const float margins[] = {0, 0, 0.1f, 0.02f, -0.1f, INFINITY};
    struct question q = {.manifolds = random_below(random, 2),
                         .shifted = random_below(random, 2),
                         .selected = random_below(random, 4) == 0,
                         .layout = (enum layout)random_below(random, LAYOUT_BACKWARDS + 1),
                         .more = 4 * random_below(random, 3),
                         .margins = random_below(random, 4) == 0};
    q.margin = margins[random_below(random, sizeof margins / sizeof *margins)] * (float)size;
    return q;
}

/* At all scales and places; where bodies move by a hundredth of their size most pairs are decided: all but some sixth. */
TEST(test_moves) {
    struct test_random random = test_random_named("moves");
    struct counts counts = {0};
    for (size_t round = 0; round < test_trials(80); round++) {
        static struct world world;
        const double size = random_log_between(&random, 1e-3, 1e3);
        const narc_precision precision = random_below(&random, 2) ? NARC_FLOAT64 : NARC_FLOAT32;
        const double far =
            precision == NARC_FLOAT64 && random_below(&random, 2) ? random_between(&random, -1e6, 1e6) : 0;
        make_world(&world, &random, precision, SMOOTH, size, random_below(&random, 2), far);
        check_world(&world, &random, make_question(&random, size), 0.005, &counts);
        destroy_scene(&world.scene);
    }
    print_left(&counts);
    assert_true(counts.left * 5 < counts.all);
}

/* Beside boxes, capsules and polygons, which are all left, and broken bodies. */
TEST(test_mixtures) {
    struct test_random random = test_random_named("mixtures");
    struct counts counts = {0};
    for (size_t round = 0; round < test_trials(20); round++) {
        static struct world world;
        const double size = random_log_between(&random, 1e-3, 1e3);
        const narc_precision precision = random_below(&random, 2) ? NARC_FLOAT64 : NARC_FLOAT32;
        make_world(&world, &random, precision, round % 2 ? SMOOTH : SMOOTH_AND_OTHERS, size, true, 0);
        break_bodies(&world, &random);
        check_world(&world, &random, make_question(&random, size), round % 3 ? 0.01 : 0.2, &counts);
        destroy_scene(&world.scene);
    }
    assert_true(counts.smooth_left < counts.smooth && counts.smooth < counts.all);
}

/* Ellipses and circles without scales: nearly all are decided. */
TEST(test_ellipses) {
    struct test_random random = test_random_named("ellipses");
    struct counts counts = {0};
    for (size_t round = 0; round < test_trials(6); round++) {
        static struct world world;
        struct question q = make_question(&random, 1);
        make_world(&world, &random, NARC_FLOAT32, ELLIPSES, 1, false, 0);
        q.layout = LAYOUT_UNSCALED;
        check_world(&world, &random, q, 0.005, &counts);
        destroy_scene(&world.scene);
    }
    print_left(&counts);
    assert_true(counts.left * 30 < counts.all);
}

/* Rows of any bits, and poses with which bodies are elsewhere and no rotation has length 1, make no entry that tells a wrong
 * answer; nor does it matter that the store moves its memory, or takes
 * more shapes. */
TEST(test_made_up_rows) {
    struct test_random random = test_random_named("made up rows");
    for (size_t round = 0; round < test_trials(10); round++) {
        static struct world world;
        struct question q = make_question(&random, 1);
        q.shifted = q.selected = false;
        make_world(&world, &random, NARC_FLOAT32, SMOOTH_AND_OTHERS, 1, true, 0);
        AUTO(guard_release_at) narc_entry *const entries = guard_allocate(PAIRS * sizeof *entries);
        narc_entry_ends *const ends = q.manifolds ? guard_allocate(PAIRS * sizeof *ends) : NULL;
        narc_manifold rows[PAIRS];
        memset(rows, 0, sizeof rows);
        for (size_t k = 0; k < PAIRS; k++) {
            const uint32_t feature = (uint32_t)(random_below(&random, 10) | random_below(&random, 10) << 8 |
                                                random_below(&random, 5) / 4 << 6);
            const narc_contact contact = {.count = (uint16_t)random_below(&random, 2), .feature = (uint16_t)feature};
            rows[k].count = contact.count;
            rows[k].point[0].feature = feature;
            if (!q.manifolds)
                memcpy(&rows[k], &contact, sizeof contact);
        }
        struct body right[BODIES];
        memcpy(right, world.scene.bodies, sizeof right);
        for (size_t k = 0; k < BODIES; k++) {
            struct body *const body = &world.scene.bodies[k];
            const float length = (float)random_between(&random, 0.5, 2);
            body->cosine *= length;
            body->sine *= length;
            body->x_single *= 1.2f;
            body->y_single *= 1.2f;
        }
        const narc_bodies bodies = scene_bodies(&world.scene);
        const narc_pairs pairs = scene_pairs(&world.scene);
        const narc_query query = {.margin = q.margin};
        narc_batch batch;
        narc_error error;
        expect_ok(narc_begin_batch(world.scene.store, &bodies, &pairs, &query, &batch, &error), &error);
        batch.row_size = q.manifolds ? sizeof(narc_manifold) : sizeof(narc_contact);
        narc_make_entries(&batch, 0, PAIRS, NULL, rows, sizeof *rows, entries, ends);
        memcpy(world.scene.bodies, right, sizeof right);
        struct counts counts = {0};
        struct world later = world;
        assert_int_equal(narc_reserve_shapes(world.scene.store, 4 * SHAPES, 64 * SHAPES), NARC_OK);
        store_shape(world.scene.store, make_shape(&random, FAMILY_MANY));
        check_frame(&later, &q, entries, ends, &counts);
        assert_true(counts.smooth_left < counts.smooth);
        if (ends)
            guard_release(ends);
        destroy_scene(&world.scene);
    }
}

/* ------------------------------------------------------------------------------------------------ rows with edges */

/* Keeps the rows of some pairs by these kernels, at the pairs' numbers, and again at others: the same, and no more. */
static void keep_rows(const narc_kernel_table *kernels, const narc_batch *batch, const narc_rows *rows,
                      narc_kept_row *kept) {
    const size_t count = batch->count, size = batch->row_size;
    AUTO(guard_release_at) uint32_t *const item = guard_allocate((count + 1) * sizeof *item);
    AUTO(guard_release_at) narc_kept_row *const others = guard_allocate((count + 1) * sizeof *others);
    AUTO(guard_release_at) char *const copies = guard_allocate((count + 1) * size);
    const narc_rows from = {.base = copies, .stride = (ptrdiff_t)size};
    for (size_t first = 0, part; first < count; first += part) {
        part = first == 0 && count > 11 ? 11 : count - first;
        kernels->keep(batch, first, part, NULL, rows, kept);
    }
    for (size_t i = 0; i < count; i++) {
        item[i] = (uint32_t)(count - 1 - i);
        memcpy(copies + item[i] * size, rows->base + (ptrdiff_t)narc_pair_at(batch, i) * rows->stride, size);
    }
    kernels->keep(batch, 0, count, item, &from, others);
    for (size_t i = 0; i < count; i++)
        assert_memory_equal(&others[item[i]], &kept[narc_pair_at(batch, i)], sizeof *kept);
}

/* Lets rows follow their bodies, in any split; returns how many do not. */
static size_t follow_rows(const narc_kernel_table *kernels, const narc_batch *batch, const narc_kept_row *kept,
                          float tolerance, const narc_rows *rows, uint32_t *left) {
    size_t count = 0;
    for (size_t first = 0, part; first < batch->count; first += part) {
        part = first == 0 && batch->count > 13 ? 13 : batch->count - first;
        count += kernels->recycle(batch, first, part, NULL, kept, tolerance, rows, left + count);
    }
    return count;
}

/* What is kept, and rows that follow, have the same bits as those of plain C; where nothing has moved rows stay as they were,
 * and all follow. */
TEST(test_rows_are_kept) {
    struct test_random random = test_random_named("kept rows");
    size_t followed = 0, all_left = 0;
    for (size_t round = 0; round < test_trials(40); round++) {
        static struct world world;
        struct question q = make_question(&random, 1);
        const size_t size = q.manifolds ? sizeof(narc_manifold) : sizeof(narc_contact), stride = size + q.more;
        make_world(&world, &random, random_below(&random, 2) ? NARC_FLOAT64 : NARC_FLOAT32, SMOOTH_AND_OTHERS, 1,
                   random_below(&random, 2), 0);
        AUTO(guard_release_at) char *const rows = guard_allocate(PAIRS * stride);
        AUTO(guard_release_at) char *const same = guard_allocate(PAIRS * stride);
        AUTO(guard_release_at) narc_kept_row *const kept = guard_allocate(PAIRS * sizeof *kept);
        AUTO(guard_release_at) narc_kept_row *const right = guard_allocate(PAIRS * sizeof *kept);
        uint32_t list[PAIRS], left[PAIRS], right_left[PAIRS];
        size_t touching = 0, found;
        narc_error error;
        narc_status status;
        for (size_t frame = 0; frame < 3; frame++) {
            struct columns columns = create_columns(&world.scene, q.layout, 0, PAIRS);
            narc_query query = {.margin = 0.05f, .dense = 1, .row_stride = (ptrdiff_t)stride};
            if (frame == 0)
                expect_ok(
                    ask(world.scene.store, &columns.bodies, &columns.pairs, &query, q.manifolds, rows, &found, &error),
                    &error);
            for (uint32_t k = 0; k < PAIRS && frame == 0; k++) {
                narc_contact contact;
                narc_manifold manifold;
                memcpy(q.manifolds ? (void *)&manifold : &contact, rows + k * stride, size);
                if (q.manifolds ? manifold.count > 0 : contact.count > 0)
                    list[touching++] = k;
            }
            query.selection = NARC_ARRAY(list);
            query.selection_count = touching;
            narc_batch batch;
            expect_ok(narc_begin_batch(world.scene.store, &columns.bodies, &columns.pairs, &query, &batch, &error),
                      &error);
            batch.row_size = size;
            const narc_kernel_table *const kernels = narc_kernels(&status, &error), *const plain =
                                                                                        NARC_KERNELS_FOR(1, kernels);
            const narc_rows of_rows = {.base = rows, .stride = (ptrdiff_t)stride},
                            of_same = {.base = same, .stride = (ptrdiff_t)stride};
            memcpy(same, rows, PAIRS * stride);
            if (frame == 0) {
                keep_rows(kernels, &batch, &of_rows, kept);
                keep_rows(plain, &batch, &of_rows, right);
                assert_memory_equal(kept, right, PAIRS * sizeof *kept);
            }
            const float tolerance = frame == 0 ? 1e-4f : 0.02f;
            const size_t count = follow_rows(kernels, &batch, kept, tolerance, &of_rows, left);
            assert_int_equal(follow_rows(plain, &batch, kept, tolerance, &of_same, right_left), count);
            assert_memory_equal(left, right_left, count * sizeof *left);
            assert_memory_equal(rows, same, PAIRS * stride);
            assert_int_equal(plain->recycle(&batch, 0, touching, NULL, kept, tolerance, NULL, right_left), count);
            assert_true(frame > 0 || count == 0);
            followed += frame > 0 ? touching - count : 0;
            all_left += count;
            destroy_columns(&columns);
            scene_move_bodies(&world.scene, &random, 0.005);
        }
        destroy_scene(&world.scene);
    }
    printf("%zu rows followed their bodies, %zu did not\n", followed, all_left);
    assert_true(10 * followed > all_left && 10 * all_left > followed);
}

TEST_MAIN("follow")
