/* SPDX-License-Identifier: MIT
 *
 * store.c - the store: what goes in comes out, memory, flags, and the header's circles.
 */
#include <math.h>
#include <stdlib.h>

#include "families.h"
#include "ledger.h"
#include "oracle.h"
#include "store.h"
#include "support.h"
#include "tests.h"

/* One rounding to single precision, relative. */
static const double ulp = 1.0 / 16777216.0;

static void expect_same_arcs(const struct shape *shape, const narc_arc *stored, size_t count) {
    assert_int_equal(count, shape->count);
    for (size_t i = 0; i < count; i++) {
        const narc_arc *a = &shape->arcs[i], *b = &stored[i];
        assert_true(b->center_x == (double)(float)b->center_x && b->radius == (double)(float)b->radius);
        expect_near(b->center_x, a->center_x, ulp * fabs(a->center_x) + 1e-15, "center x");
        expect_near(b->center_y, a->center_y, ulp * fabs(a->center_y) + 1e-15, "center y");
        expect_near(b->radius, a->radius, ulp * a->radius, "radius");
        expect_near(remainder(b->start - a->start, 2 * PI), 0, 2 * ulp, "start");
        expect_near(remainder(b->end - a->end, 2 * PI), 0, 2 * ulp, "end");
        double sweep = b->end - b->start;
        assert_true(sweep > 0 && sweep <= (count == 1 ? 2 * PI : PI) + 1e-15);
    }
}

static double extent_of(const struct shape *shape) {
    double extent = 0;
    for (size_t i = 0; i < shape->count; i++)
        extent = fmax(extent, hypot(shape->arcs[i].center_x, shape->arcs[i].center_y) + shape->arcs[i].radius);
    return extent;
}

/* The layout that the kernels rely on. */
TEST(lays_out_blocks) {
    struct test_random random = test_random_named("blocks");
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    for (size_t k = 0; k < 40 * FAMILY_COUNT; k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        assert_int_equal(narc_add_shape_at(shapes, (uint32_t)k, shape.arcs, shape.count, NULL), NARC_OK);
        narc_arc stored[NARC_MAX_ARCS];
        expect_same_arcs(&shape, stored, narc_get_arcs(shapes, (uint32_t)k, stored));
        assert_int_equal(narc_get_arcs(shapes, (uint32_t)k, NULL), shape.count);
        assert_int_equal(narc_validate_arcs(stored, shape.count, NULL), NARC_OK);
        narc_shape_header header = shapes->headers[k];
        size_t count = shape.count == 1 ? 2 : shape.count, turn_records = narc_angle_records(count);
        const narc_record *block = &shapes->records[header.first_record], *arcs = narc_arcs_of(shapes, &header);
        assert_int_equal((uintptr_t)shapes->headers % NARC_CACHE_LINE, 0);
        assert_int_equal((uintptr_t)shapes->records % NARC_CACHE_LINE, 0);
        assert_int_equal(header.count, count);
        assert_true(header.first_arc < count);
        assert_int_equal((size_t)(arcs - shapes->records) + count, shapes->record_count); /* and nothing behind them */
        assert_ptr_equal(arcs, block + turn_records);
        for (size_t i = 0; i < count; i++) {
            const narc_stored_arc *arc = &arcs[i].arc, *next = &arcs[(i + 1) % count].arc;
            double ax = (double)arc->start_x, ay = (double)arc->start_y, bx = (double)arc->end_x,
                   by = (double)arc->end_y;
            expect_near(hypot(ax, ay), 1, ulp, "length of a normal");
            assert_true(ax * by - ay * bx > 0 || (ax == -bx && ay == -by)); /* in order, or exactly opposite */
            assert_true(arc->end_x == next->start_x && arc->end_y == next->start_y);
            double turn = ay >= 0 ? 1 - ax / (fabs(ax) + fabs(ay)) : 3 + ax / (fabs(ax) + fabs(ay));
            int16_t rounded = block[i / NARC_RECORD_ANGLES].angles[i % NARC_RECORD_ANGLES];
            expect_near((double)rounded, (double)NARC_ANGLE_SCALE * turn - (double)NARC_ANGLE_OFFSET, 1.01,
                        "its 16 bits");
            assert_true(i == 0 || rounded >= block[(i - 1) / NARC_RECORD_ANGLES].angles[(i - 1) % NARC_RECORD_ANGLES]);
        }
        for (size_t i = count; i < NARC_RECORD_ANGLES * turn_records; i++)
            assert_int_equal(block[i / NARC_RECORD_ANGLES].angles[i % NARC_RECORD_ANGLES], NARC_ANGLE_NONE);
        const double extent = extent_of(&shape);
        assert_true(header.extent_ratio == 255 || header.extent_ratio * (double)header.bound_radius >= extent);
        assert_true((header.extent_ratio - 1) * (double)header.bound_radius <= extent * 1.001);
    }
    assert_int_equal(narc_get_arcs(shapes, 40 * FAMILY_COUNT, NULL), 0);
    assert_int_equal(narc_shape_flags(shapes, 40 * FAMILY_COUNT), 0);
}

/* Multiples of a quarter turn are stored as exact zeros and ones, whole turns added or not. */
TEST(stores_exact_quarter_turns) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const float x[4] = {1, 0, -1, 0}, y[4] = {0, 1, 0, -1};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    assert_int_equal(narc_build_box(2, 1, 0.25, arcs, &count, NULL), NARC_OK);
    for (int turns = -3; turns <= 3; turns++) {
        narc_arc turned[4];
        uint32_t index;
        for (size_t i = 0; i < 4; i++) {
            turned[i] = arcs[i];
            turned[i].start += 2 * PI * turns;
            turned[i].end += 2 * PI * turns;
        }
        assert_int_equal(narc_add_shape(shapes, turned, 4, &index, NULL), NARC_OK);
        for (size_t i = 0; i < 4; i++) {
            const narc_shape_header *header = &shapes->headers[index];
            const narc_stored_arc *arc = &narc_arcs_of(shapes, header)[(i + 4 - header->first_arc) % 4].arc;
            assert_true(arc->start_x == x[i] && arc->start_y == y[i]);
        }
    }
}

static unsigned add_and_get_flags(narc_shapes *shapes, const narc_arc *arcs, size_t count) {
    uint32_t index;
    assert_int_equal(narc_add_shape(shapes, arcs, count, &index, NULL), NARC_OK);
    return narc_shape_flags(shapes, index);
}

TEST(knows_what_shapes_are) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const narc_point rhombus[4] = {{2, 0}, {0, 1}, {-2, 0}, {0, -1}}, square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    narc_build_circle(1, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count),
                     NARC_SHAPE_SMOOTH | NARC_SHAPE_CIRCLE | NARC_SHAPE_CENTERS_INSIDE);
    narc_build_capsule(0, 1, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_SMOOTH | NARC_SHAPE_CENTERS_INSIDE);
    narc_build_capsule(1, 1, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_CENTERS_INSIDE);
    narc_build_polygon(rhombus, 4, 0, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_POLYGON | NARC_SHAPE_CENTERS_INSIDE);
    narc_build_polygon(rhombus, 4, 0.1, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_CENTERS_INSIDE);
    narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0.25, 0.25}, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_SMOOTH);
    assert_int_equal(narc_build_points(square, 4, 0.5, arcs, &count, NULL), NARC_ERROR_RADIUS);
    narc_build_points(square, 4, 0.6, arcs, &count, NULL);
    assert_int_equal(add_and_get_flags(shapes, arcs, count), NARC_SHAPE_SMOOTH | NARC_SHAPE_CENTERS_INSIDE);
}

/* The form of the box that some arcs make, in a store of their own. */
static narc_box_form find_form(const narc_arc *arcs, size_t count) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
    const narc_box_form form = shapes->boxes[0];
    assert_int_equal(shapes->box_count, narc_has_form(&form));
    return form;
}

static bool is_none_of_these(const narc_arc *arcs, size_t count) {
    const narc_box_form form = find_form(arcs, count);
    return !narc_has_form(&form);
}

static void expect_form(const struct shape *shape, float half_x, float half_y, float radius, uint32_t info) {
    const narc_box_form form = find_form(shape->arcs, shape->count);
    assert_int_equal(form.info, info);
    assert_true(form.half_x == half_x && form.half_y == half_y && form.radius == radius);
}

/* Boxes about their origin with equal corners, whichever arc comes first; nothing else. */
TEST(knows_boxes) {
    const narc_point corners[4] = {{-2, 1}, {-2, -1}, {2, -1}, {2, 1}};
    struct shape box = box_of(4, 2, 0), shape, polygon;
    expect_form(&box, 2, 1, 0, NARC_IS_BOX);
    assert_int_equal(narc_build_polygon(corners, 4, 0, polygon.arcs, &polygon.count, NULL), NARC_OK);
    expect_form(&polygon, 2, 1, 0, NARC_IS_BOX | 3);
    box = box_of(4, 2, 0.25);
    expect_form(&box, 1.75f, 0.75f, 0.25f, NARC_IS_BOX);
    for (uint32_t first = 1; first < 4; first++) {
        shape.count = 4;
        for (uint32_t k = 0; k < 4; k++)
            shape.arcs[(k + first) % 4] = box.arcs[k];
        expect_form(&shape, 1.75f, 0.75f, 0.25f, NARC_IS_BOX | first);
    }
    for (int change = 0; change < 6; change++) {
        shape = box;
        for (size_t k = 0; k < 4; k++) {
            narc_arc *arc = &shape.arcs[k];
            arc->center_x += change == 0 ? 1e-6 : 0;
            arc->center_y += change == 1 ? 0.5 : 0;
            arc->start += change == 2 ? 1e-6 : 0; /* turned, as far as it still joins */
            arc->end += change == 2 ? 1e-6 : 0;
        }
        if (change == 3) { /* one corner has another radius */
            shape.arcs[2].radius = 0.5;
            shape.arcs[2].center_x += 0.25;
            shape.arcs[2].center_y += 0.25;
        }
        if (change == 4)
            shape = box_of(4, 2, 1); /* a capsule of four arcs */
        if (change == 5)
            shape = box_of(4, 2, 0.9999999); /* its short sides are no edges */
        assert_true(is_none_of_these(shape.arcs, shape.count));
    }
}

/* Circles about their origin; no others. */
TEST(knows_circles) {
    struct shape circle = circle_of(2);
    expect_form(&circle, 0, 0, 2, NARC_IS_CIRCLE);
    circle.arcs[0].start = 1;
    circle.arcs[0].end = 1 + 2 * PI;
    expect_form(&circle, 0, 0, 2, NARC_IS_CIRCLE);
    for (int axis = 0; axis < 2; axis++) {
        circle = circle_of(2);
        *(axis ? &circle.arcs[0].center_y : &circle.arcs[0].center_x) = 1e-6;
        assert_true(is_none_of_these(circle.arcs, circle.count));
    }
    circle = capsule_of(0, 2); /* two half circles */
    assert_true(is_none_of_these(circle.arcs, circle.count));
}

/* Capsules along the x axis about their origin, listed from either end, with the signs of the zeros in their normals;
 * nothing else. */
TEST(knows_capsules) {
    struct shape capsule = capsule_of(4, 1), shape;
    for (int turned = 0; turned < 2; turned++) {
        const double x = turned ? -2 : 2;
        for (int radius = 0; radius < 2; radius++) {
            narc_build_segment(&(narc_point){-x, 0}, &(narc_point){x, 0}, radius, shape.arcs, &shape.count, NULL);
            expect_form(&shape, 2, 0, (float)radius, turned ? NARC_IS_CAPSULE : NARC_IS_CAPSULE | 1);
            assert_int_equal(signbit(find_form(shape.arcs, shape.count).half_y) != 0, !turned);
        }
    }
    expect_form(&capsule, 2, 0, 1, NARC_IS_CAPSULE | 1);
    for (int change = 0; change < 5; change++) {
        const double turn = change == 2 ? 1e-6 : change == 3 ? 1.5707963267948966 : 0;
        shape = capsule;
        for (size_t k = 0; k < 2; k++) {
            narc_arc *arc = &shape.arcs[k];
            const double x = arc->center_x;
            arc->center_x = cos(turn) * x + (change == 0 ? 1e-6 : 0);
            arc->center_y = sin(turn) * x + (change == 1 ? 0.5 : 0);
            arc->start += turn;
            arc->end += turn;
        }
        if (change == 4)
            shape = capsule_of(1e-7, 1); /* its sides are no edges */
        assert_true(is_none_of_these(shape.arcs, shape.count));
    }
}

/* Of 3 to NARC_FORM_CORNERS corners that have one radius; what is a box is that. */
TEST(knows_polygons) {
    for (size_t corners = 3; corners <= NARC_FORM_CORNERS + 1; corners++)
        for (int change = 0; change < 3; change++) {
            struct shape shape;
            assert_int_equal(narc_build_regular_polygon(corners, 2, 0.25 * change, shape.arcs, &shape.count, NULL),
                             NARC_OK);
            const bool is = corners <= NARC_FORM_CORNERS && change < 2;
            if (change == 2) { /* one corner is rounder than the others, its sides where they were */
                shape.arcs[0].radius = 0.75;
                shape.arcs[0].center_x -= 0.25 / cos(3.14159265358979323846 / (double)corners);
            }
            assert_true(is_none_of_these(shape.arcs, shape.count));
            assert_int_equal(find_form(shape.arcs, shape.count).info, is ? NARC_IS_POLYGON : 0);
        }
    struct shape box = box_of(4, 2, 0), smooth;
    assert_int_equal(find_form(box.arcs, box.count).info, NARC_IS_BOX);
    assert_int_equal(narc_build_ellipse(2, 1, 8, smooth.arcs, &smooth.count, NULL, NULL), NARC_OK);
    assert_int_equal(find_form(smooth.arcs, smooth.count).info, 0);
}

/* The filters' circles hold for the shape that was stored, and are not much larger or smaller than they must be. */
TEST(bounds_what_is_stored) {
    struct test_random random = test_random_named("bounds");
    /* The room that is promised, less or more what rounding the arcs and the circle itself takes. */
    const double least = NARC_ROUNDING_ROOM - 8 * ulp, most = NARC_ROUNDING_ROOM + 8 * ulp;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    for (size_t k = 0; k < test_trials(100) * FAMILY_COUNT; k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        narc_arc arcs[NARC_MAX_ARCS];
        narc_circle bound, inner;
        double extent = 0;
        const uint32_t index = store_shape(shapes, shape);
        size_t count = narc_get_arcs(shapes, index, arcs);
        for (size_t i = 0; i < count; i++)
            extent = fmax(extent, hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
        narc_shape_header header = shapes->headers[index];
        double reach = oracle_reach(arcs, count, (narc_point){(double)header.bound_x, (double)header.bound_y});
        narc_point middle = {(double)header.inner_x, (double)header.inner_y};
        double room = fabs(oracle_distance(arcs, count, middle)); /* its sign is lost in the rounding of the joins */
        /* What was stored of a segment lies on it but for rounding. */
        const bool segment = count == 2 && arcs[0].radius == 0 && arcs[1].radius == 0;
        assert_true(narc_contains_point(arcs, count, &middle) || (segment && room <= 2 * ulp * extent));
        narc_compute_bounding_circle(shape.arcs, shape.count, &bound);
        narc_compute_inscribed_circle(shape.arcs, shape.count, &inner);
        assert_true((double)header.bound_radius >= reach + least * extent);
        assert_true((double)header.bound_radius <= bound.radius + most * extent);
        assert_true((double)header.inner_radius <= room - least * extent || header.inner_radius == 0);
        assert_true((double)header.inner_radius >= inner.radius - most * extent);
        /* The box of the body, turned and scaled. */
        float angle = (float)random_between(&random, -PI, PI), c = cosf(angle), s = sinf(angle);
        float scale = (float)random_log_between(&random, 0.1, 10);
        double cosine = (double)c, sine = (double)s, size = (double)scale;
        narc_aabb box;
        assert_true(narc_get_aabb(shapes, index, c, s, scale, &box));
        struct samples samples = oracle_sample(arcs, count, 300);
        double slack = size * (2 * most * extent + samples.height_error);
        double max_x = size * oracle_height(&samples, cosine, -sine),
               max_y = size * oracle_height(&samples, sine, cosine);
        double min_x = -size * oracle_height(&samples, -cosine, sine),
               min_y = -size * oracle_height(&samples, -sine, -cosine);
        oracle_free(&samples);
        assert_true(box.max_x >= max_x + least * size * extent && box.max_x <= max_x + slack);
        assert_true(box.max_y >= max_y + least * size * extent && box.max_y <= max_y + slack);
        assert_true(box.min_x <= min_x - least * size * extent && box.min_x >= min_x - slack);
        assert_true(box.min_y <= min_y - least * size * extent && box.min_y >= min_y - slack);
        assert_false(narc_get_aabb(shapes, (uint32_t)narc_count_shapes(shapes), c, s, scale, &box));
        assert_false(narc_get_aabb(shapes, index, c, s, scale, NULL));
    }
}

/* ------------------------------------------------------------------------------------------------ memory */

/* Whichever allocation fails, the store stays as it was, and the same shape can be added once there is memory. */
TEST(survives_failing_allocations) {
    struct test_random random = test_random_named("failing allocations");
    struct shape added[400];
    struct ledger ledger = {.limited = true};
    const narc_allocator allocator = ledger_allocator(&ledger);
    narc_shapes *shapes = NULL;
    narc_error error;
    size_t failures = 0;
    assert_int_equal(narc_create_shapes(&allocator, &shapes), NARC_ERROR_MEMORY);
    assert_null(shapes);
    ledger.left = 1;
    assert_int_equal(narc_create_shapes(&allocator, &shapes), NARC_OK);
    for (size_t k = 0; k < 400; k++) {
        added[k] = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        narc_status status;
        while ((status = narc_add_shape_at(shapes, (uint32_t)k, added[k].arcs, added[k].count, &error)) != NARC_OK) {
            failures++;
            expect_error(status, NARC_ERROR_MEMORY, &error, "shape ");
            assert_true(error.value == 0);
            assert_int_equal(narc_count_shapes(shapes), k);
            assert_int_equal(narc_get_arcs(shapes, (uint32_t)k, NULL), 0);
            for (size_t j = 0; j < k; j++) {
                narc_arc arcs[NARC_MAX_ARCS];
                expect_same_arcs(&added[j], arcs, narc_get_arcs(shapes, (uint32_t)j, arcs));
            }
            ledger.left++;
        }
    }
    assert_true(failures >= 10); /* each of the two arrays grew several times */
    narc_destroy_shapes(shapes);
    assert_int_equal(ledger.live, 0);
}

TEST(reserve_is_enough) {
    struct test_random random = test_random_named("reserve");
    for (size_t round = 0; round < 50; round++) {
        struct shape added[2 * FAMILY_COUNT];
        struct ledger ledger = {.limited = true, .left = 3};
        narc_shapes *shapes = ledger_store(&ledger);
        size_t arc_count = 0;
        for (size_t k = 0; k < 2 * FAMILY_COUNT; k++) {
            added[k] = make_shape(&random, round % 2 ? FAMILY_CIRCLE : (enum family)(k % FAMILY_COUNT));
            arc_count += added[k].count;
        }
        assert_int_equal(narc_reserve_shapes(shapes, 2 * FAMILY_COUNT, arc_count), NARC_OK);
        assert_int_equal(ledger.allocations, 3);
        for (size_t k = 0; k < 2 * FAMILY_COUNT; k++)
            assert_int_equal(narc_add_shape_at(shapes, (uint32_t)k, added[k].arcs, added[k].count, NULL), NARC_OK);
        assert_int_equal(narc_reserve_shapes(shapes, 1000000, 8000000), NARC_ERROR_MEMORY);
        assert_int_equal(narc_reserve_shapes(shapes, SIZE_MAX, 0), NARC_ERROR_COUNT);
        assert_int_equal(narc_reserve_shapes(shapes, 0, SIZE_MAX), NARC_ERROR_COUNT);
        assert_int_equal(narc_reserve_shapes(shapes, 1, (size_t)1 << 30), NARC_ERROR_COUNT);
        assert_int_equal(narc_reserve_shapes(shapes, 0, 0), NARC_OK);
        narc_destroy_shapes(shapes);
        assert_int_equal(ledger.live, 0);
    }
}

/* By how much arcs are apart across two junctions, or overlap along one, is uncertain of both circles. */
TEST(leaves_room_for_arcs_that_are_apart) {
    const double apart = 9e-6;
    for (int along = 0; along < 2; along++) {
        for (double angle = 0; angle < 2 * PI; angle += 0.1) {
            const double x = apart * cos(angle + along * PI / 2), y = apart * sin(angle + along * PI / 2);
            const narc_arc halves[2] = {{0, 0, 1, angle, angle + PI}, {x, y, 1, angle + PI, angle + 2 * PI}};
            const double room = along ? apart : 2 * apart;
            AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
            assert_int_equal(narc_add_shape(shapes, halves, 2, NULL, NULL), NARC_OK);
            const narc_shape_header *const header = &shapes->headers[0];
            assert_true((double)header->bound_radius >= 1 + room && (double)header->inner_radius <= 1 - room);
        }
    }
}

/* As many shapes as a store takes, and as many uses of one, are more than a test can add: the counts are set. */
TEST(tells_that_it_is_full) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    const struct shape circle = circle_of(1), other = circle_of(2);
    uint32_t index = 7;
    narc_error error;
    store_shape(shapes, circle);
    shapes->entries[0].uses = UINT32_MAX;
    expect_error(narc_add_shape(shapes, circle.arcs, 1, &index, &error), NARC_ERROR_COUNT, &error,
                 "shape 0 is used 4294967295 times, which is most");
    shapes->entries[0].uses = 1;
    const size_t all = shapes->count;
    shapes->count = NARC_MAX_SHAPES;
    expect_error(narc_add_shape(shapes, other.arcs, 1, &index, &error), NARC_ERROR_COUNT, &error,
                 "the store is full, it has 2147483647 shapes");
    shapes->count = all;
    assert_int_equal(index, 7);
}

/* The largest circle has room for rounding about its origin, but not a radius away from it. */
TEST(refuses_circles_without_room) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    narc_arc circle = {0, 0, NARC_MAX_SIZE, -PI, PI};
    narc_error error;
    expect_ok(narc_add_shape(shapes, &circle, 1, NULL, &error), &error);
    circle.center_x = NARC_MAX_SIZE;
    expect_error(narc_add_shape(shapes, &circle, 1, NULL, &error), NARC_ERROR_SIZE, &error, "with room for rounding");
}

TEST(refuses_bad_arguments) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_error error;
    struct ledger ledger = {0};
    narc_allocator incomplete = ledger_allocator(&ledger);
    incomplete.allocate = NULL;
    narc_arc arc = {0, 0, -1, -PI, PI};
    uint32_t index = 12345;
    assert_int_equal(narc_create_shapes(NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_create_shapes(&incomplete, &shapes), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    expect_error(narc_add_shape(NULL, &arc, 1, &index, &error), NARC_ERROR_ARGUMENT, &error, "shapes");
    expect_error(narc_add_shape_at(NULL, 0, &arc, 1, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_add_shape(shapes, NULL, 1, &index, &error), NARC_ERROR_ARGUMENT, &error, "arcs");
    expect_error(narc_add_shape(shapes, &arc, 0, &index, &error), NARC_ERROR_COUNT, &error, "0 arcs");
    expect_error(narc_add_shape(shapes, &arc, 1, &index, &error), NARC_ERROR_RADIUS, &error, "arc 0: radius is -1");
    assert_int_equal(narc_count_shapes(shapes), 0);
    assert_int_equal(index, 12345);
    assert_int_equal(narc_count_shapes(NULL), 0);
    assert_int_equal(narc_shape_flags(NULL, 0), 0);
    assert_int_equal(narc_get_arcs(NULL, 0, &arc), 0);
    assert_int_equal(narc_reserve_shapes(NULL, 1, 1), NARC_ERROR_ARGUMENT);
    narc_destroy_shapes(NULL);
}
