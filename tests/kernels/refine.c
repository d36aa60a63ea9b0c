/* SPDX-License-Identifier: MIT
 *
 * refine.c - rows in double precision, with rotations and shifts in double, compared with the reference; the ground; what is
 * refused and what has no answer. pairs.c has all families in all placements.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "expect.h"
#include "narc_chains.h"
#include "placements.h"

/* Of the extents and the distance. */
static const double ROUNDING = 1e-14;

/* What is refined and beside what. */
struct refined {
    size_t all, exact, on_surface;
    double worst; /* as a share of the bound */
};

static double find_surface(const struct reference_body *body, double x, double y, const narc_refined_contact *row,
                           double sign) {
    const double half = sign * 0.5 * row->separation;
    return fabs(reference_point_distance(body, x + half * row->normal_x, y + half * row->normal_y));
}

/* `x`, `y` is where B is from A. */
static void count_row(const struct reference_body *a, const struct reference_body *b, const narc_contact *row,
                      const narc_refined_contact *fine, struct refined *out) {
    const double gap = reference_solve_gap(a, b).gap, size = reference_reach(a, b), off = fabs(fine->separation - gap);
    const bool edges =
        (row->feature & (NARC_FEATURE_EDGE | NARC_FEATURE_EDGE << 8)) == (NARC_FEATURE_EDGE | NARC_FEATURE_EDGE << 8);
    assert_true(fabs(hypot(fine->normal_x, fine->normal_y) - 1) < ROUNDING);
    out->worst = fmax(out->worst, off / separation_bound(a, b));
    out->all++;
    out->exact += off <= ROUNDING * size;
    /* Two edges that are not quite parallel: their middle is a rounding of the row from each. */
    const double room = (edges ? NARC_ERROR_BOUND : 10 * ROUNDING) * size;
    out->on_surface += find_surface(a, fine->point_x, fine->point_y, fine, -1) <= room &&
                       find_surface(b, fine->point_x - (b->x - a->x), fine->point_y - (b->y - a->y), fine, 1) <= room;
}

/* What single precision had for as deep may not be, of a few rows. */
static void check_counts(const struct refined *counts) {
    print_message("%zu rows, %zu exact, %zu points on both surfaces, worst %.3g of the bound\n", counts->all,
                  counts->exact, counts->on_surface, counts->worst);
    assert_true(counts->worst < 1);
    assert_true((double)counts->exact > 0.995 * (double)counts->all);
    assert_true((double)counts->on_surface > 0.98 * (double)counts->all);
}

/* ------------------------------------------------------------------------------------------------ all in double */

enum { BODIES = 600 };

/* Bodies of two sets, pair k of body k of both, with rotations and shifts of which the batch has floats. */
TEST(test_double_rotations_and_shifts) {
    struct test_random random = test_random_named("refine, double");
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, BODIES, 2 * BODIES, 1);
    static double cosine[2][BODIES], sine[2][BODIES], shift[2][BODIES];
    static float near_shift[2][BODIES];
    AUTO(free_at) const narc_arc **arcs = malloc(BODIES * sizeof *arcs);
    for (uint32_t k = 0; k < BODIES; k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        scene_add_shape(&scene, &shape);
        arcs[k] = scene.shapes[k].arcs;
    }
    for (uint32_t k = 0; k < 2 * BODIES; k++) {
        const uint32_t set = k / BODIES, i = k % BODIES;
        const double angle = random_between(&random, -PI, PI);
        cosine[set][i] = cos(angle);
        sine[set][i] = sin(angle);
        shift[set][i] = random_between(&random, -1, 1);
        near_shift[set][i] = (float)shift[set][i];
        scene_add_body(&scene, (struct body){.x = random_between(&random, -1, 1),
                                             .y = random_between(&random, -1, 1),
                                             .cosine = (float)cosine[set][i],
                                             .sine = (float)sine[set][i],
                                             .scale = (float)random_between(&random, 0.5, 1),
                                             .shape = (uint32_t)random_below(&random, BODIES)});
    }
    narc_bodies all = scene_bodies(&scene), other = all;
    all.count = other.count = BODIES;
    other.x.base = (const char *)other.x.base + BODIES * other.x.stride;
    other.y.base = (const char *)other.y.base + BODIES * other.y.stride;
    other.cosine.base += BODIES * other.cosine.stride / (ptrdiff_t)sizeof(float);
    other.sine.base += BODIES * other.sine.stride / (ptrdiff_t)sizeof(float);
    other.scale.base += BODIES * other.scale.stride / (ptrdiff_t)sizeof(float);
    other.shape.base += BODIES * other.shape.stride / (ptrdiff_t)sizeof(uint32_t);
    const narc_pairs pairs = {.count = BODIES,
                              .other_bodies = &other,
                              .shift_x = NARC_ARRAY(near_shift[0]),
                              .shift_y = NARC_ARRAY(near_shift[1])};
    narc_refinement with = {.arcs = arcs,
                            .cosine = NARC_POSITION_ARRAY(cosine[0]),
                            .sine = NARC_POSITION_ARRAY(sine[0]),
                            .other_cosine = NARC_POSITION_ARRAY(cosine[1]),
                            .other_sine = NARC_POSITION_ARRAY(sine[1]),
                            .shift_x = NARC_POSITION_ARRAY(shift[0]),
                            .shift_y = NARC_POSITION_ARRAY(shift[1])};
    AUTO(free_at) struct contacts rows = find_contacts(scene.store, &all, &pairs, &(narc_query){.margin = INFINITY});
    static narc_refined_contact fine[BODIES], again[BODIES];
    assert_int_equal(narc_refine_contacts(scene.store, &all, &pairs, &with, rows.rows, rows.count, fine, NULL),
                     NARC_OK);
    struct refined counts = {0};
    for (size_t k = 0; k < rows.count; k++) {
        const uint32_t i = rows.rows[k].pair;
        struct reference_body a = scene_reference(&scene, i), b = scene_reference(&scene, BODIES + i);
        a.cosine = cosine[0][i], a.sine = sine[0][i], b.cosine = cosine[1][i], b.sine = sine[1][i];
        b.x += shift[0][i];
        b.y += shift[1][i];
        count_row(&a, &b, &rows.rows[k], &fine[k], &counts);
    }
    check_counts(&counts);
    const narc_workers workers = openmp_workers(3);
    with.workers = &workers;
    assert_int_equal(narc_refine_contacts(scene.store, &all, &pairs, &with, rows.rows, rows.count, again, NULL),
                     NARC_OK);
    assert_memory_equal(fine, again, rows.count * sizeof *fine);
    /* Without an answer: a rotation that is none, a row without a contact. */
    cosine[0][rows.rows[0].pair] = NAN;
    rows.rows[1].count = 0;
    assert_int_equal(narc_refine_contacts(scene.store, &all, &pairs, &with, rows.rows, rows.count, again, NULL),
                     NARC_OK);
    assert_true(again[0].separation == INFINITY && again[0].normal_x == 0 && again[0].point_y == 0);
    assert_true(again[1].separation == (double)rows.rows[1].separation && again[1].normal_x == 0);
    assert_memory_equal(&fine[2], &again[2], (rows.count - 2) * sizeof *fine);
}

/* ------------------------------------------------------------------------------------------------ ground */

/* A ball in a bowl that is an arc of radius 10: as deep as was made, at its lowest point and beside it. */
TEST(test_concave_arcs) {
    const narc_arc bowl = {0, 10, -10, PI / 2 + 0.5, PI / 2 - 0.5};
    narc_shapes *store = empty_store();
    const uint32_t ball = store_shape(store, circle_of(1));
    static narc_chain_entry entries[16];
    size_t count;
    narc_error error;
    if (narc_add_chain(store, &bowl, 1, NULL, entries, 16, &count, &error) != NARC_OK)
        fail_msg("%s", error.message);
    for (int k = 0; k < 5; k++) {
        const double angle = 0.1 * (k - 2), depth = 1e-3, away = 9 + depth;
        size_t found = 0;
        for (size_t i = 0; i < count && found == 0; i++) {
            const narc_body two[2] = {{entries[i].x, entries[i].y, 1, 0, 1, entries[i].shape},
                                      {away * sin(angle), 10 - away * cos(angle), 1, 0, 1, ball}};
            narc_bodies bodies;
            narc_view_bodies(two, 2, &bodies);
            const narc_pairs pairs = {.count = 1};
            narc_contact row;
            narc_refined_contact fine;
            assert_int_equal(narc_find_contacts(store, &bodies, &pairs, NULL, &row, 1, &found, NULL), NARC_OK);
            if (found == 0)
                continue;
            assert_int_equal(narc_refine_contacts(store, &bodies, &pairs, NULL, &row, 1, &fine, NULL), NARC_OK);
            assert_true(row.radius_a < 0);
            assert_true(fabs(fine.separation + depth) < 2e-6); /* floats of the arc's centre and radius */
            assert_true(fabs(fine.separation - (double)row.separation) < 2e-6);
            assert_true(fabs(fine.normal_x + sin(angle)) < 1e-6 && fabs(fine.normal_y - cos(angle)) < 1e-6);
            assert_true(fabs(entries[i].x + fine.point_x - (10 + depth / 2) * sin(angle)) < 1e-5);
        }
        assert_int_equal(found, 1);
    }
    narc_destroy_shapes(store);
}

TEST_MAIN("refine")
