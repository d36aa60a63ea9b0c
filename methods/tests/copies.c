/* SPDX-License-Identifier: MIT
 *
 * copies.c - the copy of a store that methods have: its boxes, and that it never answers for other shapes than those of
 * the store.
 */
#include "copy.h"

#include <math.h>

#include "expect.h"
#include "ledger.h"
#include "method_support.h"
#include "narc_chains.h"
#include "store.h"

/* One rounding to single precision, relative. */
static const double ulp = 1.0 / 16777216.0;

/* The box behind the arcs of the methods' copy: along a junction's normal, of a polygon an edge's; none along another
 * junction's is smaller; it holds the shape with the room that is promised, but for the rounding of its numbers, and
 * hardly more. */
static void check_box(const struct shape *shape, const narc_shape_header *header, const narc_record *arcs) {
    const narc_oriented_box *box = (const narc_oriented_box *)&arcs[header->count];
    const struct reference_body body = {shape->arcs, shape->count, 0, 0, 1, 0, 1};
    const double x = (double)box->axis_x, y = (double)box->axis_y, extent = reference_extent(&body);
    const double least = (NARC_ROUNDING_ROOM - 8 * ulp) * extent, most = (NARC_ROUNDING_ROOM + 8 * ulp) * extent;
    double area = INFINITY, least_area = INFINITY;
    narc_mass mass;
    assert_true(narc_compute_mass(shape->arcs, shape->count, &mass));
    assert_true(fabs((double)box->centroid_x - mass.centroid_x) <= ulp * extent);
    assert_true(fabs((double)box->centroid_y - mass.centroid_y) <= ulp * extent);
    for (size_t i = 0; i < header->count; i++) {
        const double start = shape->count == 1 ? shape->arcs[0].start + PI * (double)i
                                               : shape->arcs[(i + header->first_arc) % header->count].start;
        const double n_x = cos(start), n_y = sin(start);
        const double this_area = (reference_height(&body, n_x, n_y) + reference_height(&body, -n_x, -n_y)) *
                                 (reference_height(&body, -n_y, n_x) + reference_height(&body, n_y, -n_x)) / 4;
        if (box->axis_x == arcs[i].arc.start_x && box->axis_y == arcs[i].arc.start_y)
            area = this_area;
        least_area = fmin(least_area, this_area);
    }
    /* Of equal ones it is the first; what was stored is rounded, of both sides. Infinite: along no junction's normal. */
    assert_true(area <= least_area * (1 + 1.001e-6) + 4 * ulp * extent * extent);
    const double from_x = (double)box->center_x * x + (double)box->center_y * y,
                 from_y = (double)box->center_y * x - (double)box->center_x * y;
    const double room[4] = {(double)box->half_x - (reference_height(&body, x, y) - from_x),
                            (double)box->half_x - (reference_height(&body, -x, -y) + from_x),
                            (double)box->half_y - (reference_height(&body, -y, x) - from_y),
                            (double)box->half_y - (reference_height(&body, y, -x) + from_y)};
    for (int k = 0; k < 4; k++)
        assert_true(room[k] >= least && room[k] <= most);
}

/* Each shape as it is in the store, and its box. */
TEST(test_boxes) {
    enum { SHAPES = 40 * FAMILY_COUNT };
    struct test_random random = test_random_named("blocks");
    AUTO(narc_destroy_methods_at) narc_methods *methods = NULL;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    for (size_t k = 0; k < SHAPES; k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        assert_int_equal(narc_add_shape_at(shapes, (uint32_t)k, shape.arcs, shape.count, NULL), NARC_OK);
    }
    assert_int_equal(narc_create_methods(shapes, NULL, &methods, NULL), NARC_OK);
    assert_int_equal(methods->shapes.count, SHAPES);
    for (size_t k = 0; k < SHAPES; k++) {
        narc_shape_header header = methods->shapes.headers[k];
        const narc_record *arcs = narc_arcs_of(&methods->shapes, &header);
        assert_memory_equal(&methods->shapes.records[header.first_record],
                            &shapes->records[shapes->headers[k].first_record],
                            narc_count_records(&header) * sizeof *arcs);
        struct shape stored;
        stored.count = narc_get_arcs(shapes, (uint32_t)k, stored.arcs);
        check_box(&stored, &header, arcs);
        header.first_record = shapes->headers[k].first_record;
        assert_memory_equal(&header, &shapes->headers[k], sizeof header);
    }
}

/* There is no answer for pieces of chains. */
TEST(test_pieces) {
    static const narc_arc hill[] = {{0, 0, 1, 0.5, 2.5}};
    narc_chain_entry entries[4];
    size_t count;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    narc_methods *methods = NULL;
    narc_error error;
    expect_ok(narc_add_chain(shapes, hill, 1, NULL, entries, 4, &count, &error), &error);
    expect_error(narc_create_methods(shapes, NULL, &methods, &error), NARC_ERROR_ARGUMENT, &error, "pieces of chains");
    assert_null(methods);
}

/* Two bodies of shape 0, 3 apart: do their boxes meet, or why is that not told? */
static narc_status ask_boxes(const narc_methods *methods, bool *out_meet, narc_error *error) {
    static const uint32_t a = 0, b = 1, shape = 0;
    static const float x[] = {0, 3}, zero = 0, one = 1;
    const narc_bodies bodies = {.count = 2,
                                .x = NARC_POSITION_ARRAY(x),
                                .y = {&zero, 0, NARC_FLOAT32},
                                .cosine = {&one, 0},
                                .sine = {&zero, 0},
                                .shape = {&shape, 0}};
    const narc_pairs pairs = {.count = 1, .a = {&a, 0}, .b = {&b, 0}};
    const narc_method_options options = {.method = NARC_METHOD_OBB};
    uint64_t bits = 0xa5;
    const narc_status status = narc_find_overlaps_by(methods, &bodies, &pairs, &options, NULL, &bits, error);
    *out_meet = bits & 1;
    assert_true(status == NARC_OK ? bits <= 1 : bits == 0xa5);
    return status;
}

/* A copy never answers for shapes that the store does not have. */
TEST(test_never_stale) {
    struct ledger ledger = {0};
    const narc_allocator allocator = ledger_allocator(&ledger);
    const struct shape small = box_of(1, 1, 0);
    struct shape wide;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_methods *methods = NULL;
    narc_error error;
    bool meet = false;
    assert_int_equal(narc_build_regular_polygon(64, 2, 0, wide.arcs, &wide.count, NULL), NARC_OK);
    expect_error(narc_create_methods(NULL, NULL, &methods, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_refresh_methods(NULL, &error), NARC_ERROR_ARGUMENT, &error, "methods is NULL");
    expect_error(ask_boxes(NULL, &meet, &error), NARC_ERROR_ARGUMENT, &error, "methods is NULL");
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    expect_error(narc_create_methods(shapes, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_methods is NULL");
    ledger.limited = true;
    expect_error(narc_create_methods(shapes, &allocator, &methods, &error), NARC_ERROR_MEMORY, &error, "no memory");
    assert_null(methods);
    ledger.limited = false;
    expect_ok(narc_create_methods(shapes, &allocator, &methods, &error), &error);
    for (int change = 0; change < 4; change++) {
        if (change == 0)
            store_shape(shapes, small);
        else if (change == 1)
            assert_int_equal(narc_replace_shape(shapes, 0, wide.arcs, wide.count, NULL), NARC_OK);
        else if (change == 2)
            assert_int_equal(narc_remove_shape(shapes, 0, NULL), NARC_OK);
        else
            store_shape(shapes, wide);
        expect_error(ask_boxes(methods, &meet, &error), NARC_ERROR_ARGUMENT, &error, "narc_refresh_methods()");
        ledger.limited = true;
        expect_error(narc_refresh_methods(methods, &error), NARC_ERROR_MEMORY, &error, "no memory");
        expect_error(ask_boxes(methods, &meet, &error), NARC_ERROR_ARGUMENT, &error, "narc_refresh_methods()");
        ledger.limited = false;
        expect_ok(narc_refresh_methods(methods, &error), &error);
        expect_ok(ask_boxes(methods, &meet, &error), &error);
        assert_int_equal(meet, change == 1 || change == 3); /* one radius is 1, or 2; removed shapes meet nothing */
    }
    const size_t allocations = ledger.allocations;
    expect_ok(narc_refresh_methods(methods, &error), &error);
    assert_int_equal(ledger.allocations, allocations);
    narc_destroy_methods(methods);
    narc_destroy_methods(NULL);
    assert_int_equal(ledger.live, 0);
}

TEST_MAIN("method_copies")
