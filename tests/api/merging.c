/* SPDX-License-Identifier: MIT
 *
 * merging.c - narc_merge_rows(): what stays of rows that entries of one chain tell of a body. Internal.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "merge.h"
#include "support.h"

enum { MOST = 16 };

/* Rows k of pairs k: body `a` on the ground's body `b`. */
struct rows {
    uint32_t a[MOST], b[MOST];
    narc_manifold manifolds[MOST];
    size_t count;
};

/* Halfway between the surfaces where the ground is at (x, y). */
static narc_manifold_point find_half_way(const float ground[3], float normal_x, float normal_y) {
    const float half = ground[2] / 2;
    return (narc_manifold_point){ground[0] - half * normal_x, ground[1] - half * normal_y, ground[2], 0};
}

/* A row of body a on entry b with a normal's angle and one point, or two: where the ground is, and the separation. */
static void add_row(struct rows *rows, uint32_t a, uint32_t b, double angle, size_t count, const float points[][3]) {
    narc_manifold *row = &rows->manifolds[rows->count];
    *row = (narc_manifold){.pair = (uint32_t)rows->count,
                           .count = (uint32_t)count,
                           .normal_x = (float)cos(angle),
                           .normal_y = (float)sin(angle),
                           .radius_a = (float)rows->count,
                           .radius_b = (float)b};
    for (size_t k = 0; k < count; k++) {
        row->point[k] = find_half_way(points[k], row->normal_x, row->normal_y);
        row->point[k].feature = 100 * b + (uint32_t)k;
    }
    rows->a[rows->count] = a;
    rows->b[rows->count++] = b;
}

static const double down = -1.57079632679489661923; /* the ground is below: the normal from the body to it */

static size_t merge_as_told(struct rows *rows, const uint32_t *runs) {
    const narc_pairs pairs = {.count = rows->count, .a = NARC_ARRAY(rows->a), .b = NARC_ARRAY(rows->b)};
    AUTO(guard_release_at) narc_manifold *own = guard_copy(rows->manifolds, rows->count * sizeof *own);
    const narc_index_column run = {runs, runs ? sizeof *runs : 0};
    const size_t left = narc_merge_rows(&(narc_merging){&pairs, run, .manifolds = own}, rows->count);
    memcpy(rows->manifolds, own, left * sizeof *own);
    return left;
}

/* Entries without a run are concave arcs, whose rows say so. */
static void make_concave(struct rows *rows, const uint32_t *runs) {
    for (size_t k = 0; k < rows->count; k++)
        if (!runs || runs[rows->b[k]] == NARC_NO_RUN)
            rows->manifolds[k].radius_b = copysignf(rows->manifolds[k].radius_b, -1);
}

static size_t merge(struct rows *rows, const uint32_t *runs) {
    make_concave(rows, runs);
    return merge_as_told(rows, runs);
}

/* With the ground at (x, y) and the normal down, or nearly. */
static void expect_point(const narc_manifold_point *p, float x, float y, float separation, uint32_t feature) {
    assert_true(fabsf(p->x - x) <= 1e-6f && fabsf(p->y - (y + separation / 2)) <= 1e-6f && p->separation == separation);
    assert_int_equal(p->feature, feature);
}

/* A box flat on collinear entries keeps the outermost points. Along (n_y, -n_x) turned: with the normal down, the order
 * of points is that of x. */
TEST(joins_flush_rows_of_a_run) {
    const uint32_t runs[MOST] = {4, 4, 4, 4, 4, 4, 4, 4, 4, 4};
    struct rows rows = {.count = 0};
    for (uint32_t b = 0; b < 10; b++) {
        const float x = (float)b - 5;
        add_row(&rows, 7, b, down + 3e-5 * (b % 2), 2,
                (const float[][3]){{x, -1, -0.001f * (float)b}, {x + 1, -1, -0.001f * (float)(b + 1)}});
    }
    assert_int_equal(merge(&rows, runs), 1);
    const narc_manifold *row = &rows.manifolds[0];
    assert_int_equal(row->pair, 0);
    assert_int_equal(row->count, 2);
    expect_point(&row->point[0], -5, -1, 0, 0);
    expect_point(&row->point[1], 5, -1, -0.001f * 10, 901);
    assert_true(row->radius_a == 9 && row->radius_b == 9); /* of the deepest */
}

/* The same point told by both parts of a cut arc is one. */
TEST(joins_one_point_of_a_run) {
    const uint32_t runs[MOST] = {4, 4};
    struct rows rows = {.count = 0};
    add_row(&rows, 7, 0, down, 1, (const float[][3]){{0, -1, -0.01f}});
    add_row(&rows, 7, 1, down, 1, (const float[][3]){{0.0001f, -1, -0.0101f}});
    assert_int_equal(merge(&rows, runs), 1);
    assert_int_equal(rows.manifolds[0].count, 1);
    expect_point(&rows.manifolds[0].point[0], 0.0001f, -1, -0.0101f, 100);
    expect_point(&rows.manifolds[0].point[1], 0, 0, 0, 0);
}

/* Deep in a run that turns, a box has maxima to other sides. Wherever the row of the greatest separation stands, it
 * stays alone. */
TEST(keeps_the_greatest_separation_of_a_run) {
    const uint32_t runs[MOST] = {4, 4, 4, 4};
    for (uint32_t best = 0; best < 4; best++) {
        struct rows rows = {.count = 0};
        for (uint32_t b = 0; b < 4; b++) { /* on a disc of radius 10 */
            const double angle = b == best ? down : down + 0.3 * (b + 1);
            add_row(&rows, 7, b, angle, 1,
                    (const float[][3]){{(float)(-10 * cos(angle)), (float)(-11 - 10 * sin(angle)),
                                        b == best ? -0.01f : -0.4f - (float)b}});
        }
        assert_int_equal(merge(&rows, runs), 1);
        assert_int_equal(rows.manifolds[0].pair, best);
        expect_point(&rows.manifolds[0].point[0], 0, -1, -0.01f, 100 * best);
    }
}

/* Sides of a run that face each other both hold what lies between them. */
TEST(keeps_sides_that_face_each_other) {
    const uint32_t runs[MOST] = {4, 4};
    struct rows rows = {.count = 0};
    add_row(&rows, 7, 0, 0, 1, (const float[][3]){{1, 0, -0.01f}});
    add_row(&rows, 7, 1, 2 * down, 1, (const float[][3]){{-1, 0, -0.02f}});
    assert_int_equal(merge(&rows, runs), 2);
}

/* A box's edge on two parts of a hill: what counts is where each is deepest, not how high the edge is above the rest. */
TEST(joins_an_edge_on_a_hill) {
    const uint32_t runs[MOST] = {4, 4};
    for (int first = 0; first < 2; first++) {
        struct rows rows = {.count = 0};
        const float level[][3] = {{-1, -1, -0.01f}, {0, -1, -0.01f}},
                    falling[][3] = {{1, -1.05f, 0.04f}, {0, -1, -0.01f}};
        add_row(&rows, 7, 0, down, 2, first ? level : falling);
        add_row(&rows, 7, 1, down, 2, first ? falling : level);
        assert_int_equal(merge(&rows, runs), 1);
        assert_int_equal(rows.manifolds[0].count, 2);
    }
}

/* A box's edge over a corner, deep: each side's row ends at the corner and at a corner of the box. The corner stays. */
TEST(keeps_the_deepest_point_between_two) {
    const uint32_t runs[MOST] = {4, 4};
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct rows rows = {.count = 0};
        const float side = mirrored ? -1 : 1;
        add_row(&rows, 7, 0, down, 2, (const float[][3]){{-side, -1.05f, -0.05f}, {0, -1, -0.1f}});
        add_row(&rows, 7, 1, down, 2, (const float[][3]){{0, -1, -0.1f}, {side, -1.02f, -0.08f}});
        assert_int_equal(merge(&rows, runs), 1);
        assert_int_equal(rows.manifolds[0].count, 2);
        expect_point(&rows.manifolds[0].point[mirrored], 0, -1, -0.1f, 1);
        expect_point(&rows.manifolds[0].point[1 - mirrored], side, -1.02f, -0.08f, 101);
    }
}

/* Both entries of a cut line tell of both corners, of the deeper one with other roundings: it lies between no others. */
TEST(keeps_both_corners_of_a_tilted_box) {
    const uint32_t runs[] = {0, 0};
    for (int deeper = 0; deeper < 2; deeper++) {
        const float low = deeper ? -0.1f : -0.2f, high = deeper ? -0.2f : -0.1f;
        const float outer[][3] = {{-1, 0, low}, {1, 0, high}},
                    inner[][3] = {{-0.9999f, 0, low * 1.0005f}, {0.9999f, 0, high * 1.0005f}};
        struct rows rows = {.count = 0};
        add_row(&rows, 5, 0, down, 2, outer);
        add_row(&rows, 5, 1, down, 2, inner);
        assert_int_equal(merge(&rows, runs), 1);
        assert_int_equal(rows.manifolds[0].count, 2);
        assert_true(fabsf(rows.manifolds[0].point[deeper].separation - 1.0005f * -0.2f) < 1e-6f);
    }
}

/* Two parts of a run beside a concave arc, whose row is that of one end of both: it goes only once they are joined. */
TEST(drops_what_joined_rows_tell) {
    const uint32_t runs[MOST] = {NARC_NO_RUN, 4, 4};
    struct rows rows = {.count = 0};
    add_row(&rows, 7, 0, down, 1, (const float[][3]){{-1, -1, -0.01f}});
    add_row(&rows, 7, 1, down, 2, (const float[][3]){{0.3f, -1, -0.01f}, {1, -1, -0.01f}});
    add_row(&rows, 7, 2, down, 2, (const float[][3]){{-1, -1, -0.01f}, {0.5f, -1, -0.01f}});
    assert_int_equal(merge(&rows, runs), 1);
    assert_int_equal(rows.manifolds[0].count, 2);
    expect_point(&rows.manifolds[0].point[0], -1, -1, -0.01f, 200);
    expect_point(&rows.manifolds[0].point[1], 1, -1, -0.01f, 101);
}

/* A corner deep below the bottom of a valley, told by the valley and by a side of it: it is one point of the body, with
 * normals from there to either, and halfway along these the points are apart. */
TEST(drops_one_corner_with_two_normals) {
    const uint32_t runs[MOST] = {NARC_NO_RUN, 4};
    for (double turn = -9e-4; turn < 1e-3; turn += 1.8e-3) {
        struct rows rows = {.count = 0};
        const float depth = 0.5f, x = 0.05f, y = -0.1f; /* the body's corner */
        for (uint32_t b = 0; b < 2; b++) {
            const double angle = down + (b ? turn : 0);
            add_row(&rows, 7, b, angle, 1,
                    (const float[][3]){{(float)((double)x - (double)depth * cos(angle)),
                                        (float)((double)y - (double)depth * sin(angle)), -depth}});
        }
        assert_int_equal(merge(&rows, runs), 1);
    }
}

/* Of a closed outline with one valley both sides are of one run, however shallow the valley is. A hill as shallow is
 * convex: there the greater separation is that of all. */
TEST(keeps_both_sides_of_a_shallow_valley) {
    const uint32_t runs[MOST] = {4, 4};
    for (int hill = 0; hill < 2; hill++)
        for (double turn = 3e-4; turn < 1; turn *= 3)
            for (double apart = 1e-3; apart < 0.5; apart *= 3) {
                const double side = hill ? -turn / 2 : turn / 2, fall = apart / 2 * sin(turn / 2);
                const float height = (float)(hill ? -1 - fall : -1 + fall), half = (float)(apart / 2);
                struct rows rows = {.count = 0};
                add_row(&rows, 7, 0, down - side, 1, (const float[][3]){{-half, height, -0.01f}});
                add_row(&rows, 7, 1, down + side, 1, (const float[][3]){{half, height, -0.02f}});
                assert_int_equal(merge(&rows, runs), hill ? 1 : 2);
            }
}

/* Seams between a run and concave arcs: one row of points that are told twice, wherever the larger one stands. */
TEST(drops_points_that_are_told_twice) {
    const uint32_t runs[MOST] = {4, NARC_NO_RUN, NARC_NO_RUN, 5};
    for (int order = 0; order < 2; order++) {
        struct rows rows = {.count = 0};
        const float points[][3] = {{-1, -1, -0.01f}, {1, -1, -0.01f}};
        for (int k = 0; k < 2; k++)
            if (k == order)
                add_row(&rows, 7, 0, down, 2, points);
            else
                add_row(&rows, 7, 1, down + 5e-4, 1, (const float[][3]){{1, -1, -0.0101f}}); /* not less deep */
        add_row(&rows, 7, 2, down + 0.002, 1, points + 1);                                   /* another normal */
        add_row(&rows, 7, 3, down, 1, (const float[][3]){{1.001f, -1, -0.01f}});             /* another point */
        assert_int_equal(merge(&rows, runs), 3);
        assert_int_equal(rows.manifolds[0].pair, order);
        assert_int_equal(rows.manifolds[0].count, 2);
        assert_true(rows.manifolds[0].point[0].separation == -0.01f &&
                    rows.manifolds[0].point[1].separation == -0.0101f);
        assert_int_equal(rows.manifolds[1].pair, 2);
        assert_int_equal(rows.manifolds[2].pair, 3);
    }
}

/* A box in a bowl stands on two corners of one arc. Rows of other bodies, or of this one elsewhere in the list, are
 * nobody's seam; rows without a contact go. */
TEST(keeps_what_is_not_the_same) {
    const uint32_t runs[MOST] = {NARC_NO_RUN, 4, 5};
    struct rows rows = {.count = 0};
    const float left[][3] = {{-1, -1, -0.01f}}, right[][3] = {{1, -1, -0.01f}};
    add_row(&rows, 7, 0, down - 0.3, 1, left);
    add_row(&rows, 7, 0, down + 0.3, 1, right);
    add_row(&rows, 8, 1, down, 1, left);
    add_row(&rows, 8, 2, down, 0, left);
    add_row(&rows, 7, 1, down, 1, left);
    add_row(&rows, 9, 1, down, 1, left);
    make_concave(&rows, runs);
    struct rows all = rows;
    assert_int_equal(merge(&rows, runs), 5);
    for (size_t k = 0; k < 5; k++)
        assert_memory_equal(&rows.manifolds[k], &all.manifolds[k < 3 ? k : k + 1], sizeof(narc_manifold));
    assert_int_equal(merge(&all, NULL), 5); /* all concave */
    rows.count = 0;
    assert_int_equal(merge(&rows, runs), 0);
}

/* Bodies that are no entries have no run, as concave arcs have none, and are known by their radius: what they tell stays,
 * in one place with each other or with the ground. */
TEST(keeps_rows_of_other_bodies) {
    const uint32_t runs[MOST] = {4, NARC_NO_RUN, NARC_NO_RUN, NARC_NO_RUN};
    const float points[][3] = {{-1, -1, -0.01f}, {1, -1, -0.01f}};
    struct rows rows = {.count = 0};
    add_row(&rows, 7, 0, down, 2, points);
    add_row(&rows, 7, 1, down, 2, points);
    add_row(&rows, 7, 2, down, 1, points);
    add_row(&rows, 7, 3, down, 2, points);
    rows.manifolds[3].radius_b = -3; /* a concave arc, which is one with the run */
    const struct rows all = rows;
    assert_int_equal(merge_as_told(&rows, runs), 3);
    assert_memory_equal(&rows.manifolds[0], &all.manifolds[1], 2 * sizeof(narc_manifold));
    assert_int_equal(rows.manifolds[2].pair, 3);
    rows = all;
    rows.manifolds[0].radius_b = rows.manifolds[3].radius_b = INFINITY;
    assert_int_equal(merge_as_told(&rows, NULL), 4);
}

/* Contacts have one point: of one run the greatest separation, of flush rows the smaller one. Pairs without columns name
 * the bodies of two sets. */
TEST(merges_contacts) {
    const uint32_t runs[] = {4, 4, 4, NARC_NO_RUN, NARC_NO_RUN, 4};
    const uint32_t a[] = {3, 3, 3, 3, 3, 2};
    const float separations[] = {-0.02f, -0.03f, -0.4f, -0.03f, -0.01f, -1};
    const double angles[] = {down, down, 0, down + 4e-4, down + 1, down};
    narc_contact rows[6];
    for (uint32_t k = 0; k < 6; k++) {
        const float ground[3] = {k == 2 ? -0.1f : 0.0001f * (float)k, k == 2 ? -1.1f : -1, separations[k]};
        const float x = (float)cos(angles[k]), y = (float)sin(angles[k]);
        const narc_manifold_point p = find_half_way(ground, x, y);
        rows[k] = (narc_contact){.pair = k,
                                 .count = 1,
                                 .separation = separations[k],
                                 .radius_b = runs[k] == NARC_NO_RUN ? -0.0f : 0, /* a valley */
                                 .normal_x = x,
                                 .normal_y = y,
                                 .point_x = p.x,
                                 .point_y = p.y};
    }
    const narc_bodies ground = {.count = 6};
    const narc_pairs pairs = {.count = 6, .a = NARC_ARRAY(a), .other_bodies = &ground};
    assert_int_equal(narc_merge_rows(&(narc_merging){&pairs, NARC_ARRAY(runs), .contacts = rows}, 6), 3);
    assert_int_equal(rows[0].pair, 1);
    assert_int_equal(rows[1].pair, 4);
    assert_int_equal(rows[2].pair, 5);
    /* Pairs that bring two bodies each: none has two rows. */
    narc_contact own[2] = {rows[0], rows[0]};
    own[0].pair = 0;
    own[1].pair = 1;
    const uint32_t four[] = {9, 4, 9, 4};
    assert_int_equal(narc_merge_rows(&(narc_merging){&(narc_pairs){.count = 2}, NARC_ARRAY(four), .contacts = own}, 2),
                     2);
}

/* In any long list what stays is what a search through all rows of the body says. */
TEST(merges_long_lists) {
    struct test_random random = test_random_named("merging");
    enum { ROWS = 5000, RUNS = 6 };
    static narc_contact rows[ROWS], before[ROWS];
    static uint32_t a[ROWS], b[ROWS];
    uint32_t runs[RUNS + 2];
    for (uint32_t k = 0; k < RUNS + 2; k++)
        runs[k] = k < RUNS ? k / 2 : NARC_NO_RUN;
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        for (uint32_t k = 0; k < ROWS; k++) {
            const double angle = 0.5 * (double)random_below(&random, 5);
            a[k] = k == 0 ? 0 : a[k - 1] + (random_below(&random, 6) == 0);
            b[k] = (uint32_t)random_below(&random, RUNS + 2);
            const double aside = 0.125 * (double)random_below(&random, 4); /* along the tangent of a disc */
            const float x = (float)cos(angle), y = (float)sin(angle);
            const float ground[3] = {(float)(-10 * cos(angle) - aside * sin(angle)),
                                     (float)(aside * cos(angle) - 10 * sin(angle)), (float)random_unit(&random)};
            const narc_manifold_point p = find_half_way(ground, x, y);
            rows[k] = (narc_contact){.pair = k,
                                     .count = random_below(&random, 9) != 0,
                                     .separation = ground[2],
                                     .radius_b = runs[b[k]] == NARC_NO_RUN ? -1 : 1,
                                     .normal_x = x,
                                     .normal_y = y,
                                     .point_x = p.x,
                                     .point_y = p.y};
        }
        memcpy(before, rows, sizeof rows);
        const narc_pairs pairs = {.count = ROWS, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
        const size_t left = narc_merge_rows(&(narc_merging){&pairs, NARC_ARRAY(runs), .contacts = rows}, ROWS);
        size_t next = 0;
        for (size_t k = 0; k < left; k++) { /* some of the rows in their order, untouched but for what is deeper */
            while (next < ROWS && rows[k].pair != before[next].pair)
                next++;
            assert_true(next < ROWS);
            assert_true(rows[k].separation <= before[next].separation);
            before[next].separation = rows[k].separation;
            assert_memory_equal(&rows[k], &before[next], sizeof *rows);
            for (size_t i = k; i-- > 0 && a[rows[i].pair] == a[rows[k].pair];) {
                const uint32_t run = runs[b[rows[k].pair]];
                assert_false(run != NARC_NO_RUN && run == runs[b[rows[i].pair]]);
                assert_false(rows[i].normal_x == rows[k].normal_x && rows[i].point_x == rows[k].point_x);
            }
        }
        size_t kept[ROWS / 2] = {0}, there[ROWS / 2] = {0}; /* no body loses all */
        for (size_t k = 0; k < left; k++)
            kept[a[rows[k].pair]] = 1;
        for (size_t k = 0; k < ROWS; k++)
            there[a[k]] |= before[k].count;
        assert_memory_equal(kept, there, (a[ROWS - 1] + 1) * sizeof *kept);
    }
}

TEST_MAIN("merging")
