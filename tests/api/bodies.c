/* SPDX-License-Identifier: MIT
 *
 * bodies.c - narc_validate_bodies(): each kind of bad number, and which body the message names; drifted rotations.
 */
#include <math.h>
#include <string.h>

#include "families.h"
#include "narc.h"

enum { COUNT = 5, BAD = 3 };

struct fixture {
    narc_shapes *shapes;
    narc_body body[COUNT];
    narc_bodies bodies;
};

static void set_up(struct fixture *f) {
    f->shapes = empty_store();
    store_shape(f->shapes, circle_of(2));
    for (int k = 0; k < COUNT; k++)
        f->body[k] = (narc_body){k, -k, 0.6f, 0.8f, 1, 0};
    narc_view_bodies(f->body, COUNT, &f->bodies);
}

static void expect(struct fixture *f, narc_status status, const char *words) {
    narc_error error = {0};
    assert_int_equal(narc_validate_bodies(f->shapes, &f->bodies, &error), status);
    assert_int_equal(error.status, status);
    assert_int_equal(error.index, BAD);
    assert_non_null(strstr(error.message, "body 3: "));
    assert_non_null(strstr(error.message, words));
    assert_int_equal(narc_validate_bodies(f->shapes, &f->bodies, NULL), status);
}

TEST(test_good_bodies) {
    struct fixture f;
    set_up(&f);
    narc_error error = {.status = NARC_ERROR_MEMORY};
    assert_int_equal(narc_validate_bodies(f.shapes, &f.bodies, &error), NARC_OK);
    f.bodies.scale.base = NULL;
    assert_int_equal(narc_validate_bodies(f.shapes, &f.bodies, &error), NARC_OK);
    f.bodies = (narc_bodies){.count = 0};
    assert_int_equal(narc_validate_bodies(f.shapes, &f.bodies, &error), NARC_OK);
    assert_int_equal(error.status, NARC_ERROR_MEMORY); /* untouched */
    narc_destroy_shapes(f.shapes);
}

TEST(test_bad_numbers) {
    struct fixture f;
    set_up(&f);
    const float c = 0.6f, s = 0.8f;
    const struct {
        narc_body body;
        narc_status status;
        const char *words;
    } cases[] = {
        {{1, 1, c, s, 1, 1}, NARC_ERROR_INDEX, "shape is 1"},
        {{NAN, 1, c, s, 1, 0}, NARC_ERROR_NOT_FINITE, "x is"},
        {{1, INFINITY, c, s, 1, 0}, NARC_ERROR_NOT_FINITE, "y is inf"},
        {{1, 1, NAN, s, 1, 0}, NARC_ERROR_NOT_FINITE, "cosine"},
        {{1, 1, c, -INFINITY, 1, 0}, NARC_ERROR_NOT_FINITE, "sine"},
        {{1, 1, c, 0.801f, 1, 0}, NARC_ERROR_ARGUMENT, "length 1.0008"},
        {{1, 1, c, s, 0, 0}, NARC_ERROR_SIZE, "scale is 0"},
        {{1, 1, c, s, -1, 0}, NARC_ERROR_SIZE, "scale is -1"},
        {{1, 1, c, s, NAN, 0}, NARC_ERROR_SIZE, "scale is"},
        {{1, 1, c, s, 1e9f, 0}, NARC_ERROR_SIZE, "radius is then 2"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        f.body[BAD] = cases[k].body;
        expect(&f, cases[k].status, cases[k].words);
    }
    narc_destroy_shapes(f.shapes);
}

TEST(test_bad_arguments) {
    struct fixture f;
    set_up(&f);
    assert_int_equal(narc_validate_bodies(NULL, &f.bodies, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_validate_bodies(f.shapes, NULL, NULL), NARC_ERROR_ARGUMENT);
    const narc_bodies good = f.bodies;
    const void **const bases[] = {&f.bodies.x.base, &f.bodies.y.base, (const void **)&f.bodies.cosine.base,
                                  (const void **)&f.bodies.sine.base, (const void **)&f.bodies.shape.base};
    for (int k = 0; k < 6; k++) {
        if (k < 5)
            *bases[k] = NULL;
        else
            f.bodies.y.precision = NARC_FLOAT32;
        assert_int_equal(narc_validate_bodies(f.shapes, &f.bodies, NULL), NARC_ERROR_ARGUMENT);
        f.bodies = good;
    }
    narc_destroy_shapes(f.shapes);
}

/* The separation of two boxes, B at the given place and rotation, A at the origin; +infinity if they have none. */
static float separation_of_boxes(float x, float y, float cosine, float sine) {
    narc_shapes *shapes = empty_store();
    store_shape(shapes, box_of(2, 1, 0.25));
    const narc_body body[] = {
        {(double)x, (double)y, cosine, sine, 1, 0}, {0, 0, 1, 0, 1, 0}, {(double)x, (double)y, cosine, sine, 1, 0}};
    float separation[2];
    for (int k = 0; k < 2; k++) { /* both orders of a rotated body and one that is not */
        narc_bodies bodies;
        narc_view_bodies(&body[k], 2, &bodies);
        const narc_query query = {.margin = INFINITY};
        narc_contact contact;
        size_t count;
        assert_int_equal(
            narc_find_contacts(shapes, &bodies, &(narc_pairs){.count = 1}, &query, &contact, 1, &count, NULL), NARC_OK);
        separation[k] = contact.separation;
    }
    narc_destroy_shapes(shapes);
    assert_true(separation[0] == separation[1] || fabsf(separation[0] - separation[1]) < 2e-6f);
    return separation[0];
}

/* A rotation that has drifted from the unit circle is taken as the rotation it was; one that is far off has no
 * answer. */
TEST(test_drifted_rotations) {
    const float exact = separation_of_boxes(1.5f, 0.75f, 0.6f, 0.8f);
    for (float drift = -2.4e-4f; drift < 2.4e-4f; drift += 0.1e-4f) {
        const float drifted = separation_of_boxes(1.5f, 0.75f, 0.6f * (1 + drift), 0.8f * (1 + drift));
        assert_true(fabsf(drifted - exact) < 2e-6f);
    }
    assert_true(isinf(separation_of_boxes(1.5f, 0.75f, 0.6f * 1.001f, 0.8f * 1.001f)));
    assert_true(isinf(separation_of_boxes(0, 0, 0, 0)));
    assert_true(isinf(separation_of_boxes(0, 0, 0.6f * 0.999f, 0.8f * 0.999f)));
}

/* The kernels take a drifted rotation as the rotation it was, and so must the box that a broad phase uses. */
TEST(test_box_of_drifted_rotation) {
    struct fixture f;
    set_up(&f);
    narc_aabb box;
    for (float length = 0.9998f; length < 1.0003f; length += 0.0001f) {
        assert_true(narc_get_aabb(f.shapes, 0, 0.6f * length, 0.8f * length, 0.5f, &box));
        assert_true(box.min_x <= -1 && box.min_y <= -1 && box.max_x >= 1 && box.max_y >= 1);
        assert_true(box.min_x > -1.0001 && box.max_y < 1.0001);
    }
    assert_false(narc_get_aabb(f.shapes, 0, 0, 0, 1, &box));
    assert_false(narc_get_aabb(f.shapes, 0, NAN, 0, 1, &box));
    assert_false(narc_get_aabb(f.shapes, 1, 1, 0, 1, &box));
    narc_destroy_shapes(f.shapes);
}

/* ------------------------------------------------------------------------------------------------ columns */

static const narc_body two_bodies[] = {{1, 2, 1, 0, 1, 0}, {3, 4, 1, 0, 1, 0}};
static const float numbers[] = {5, 6, 7};
static const narc_index_column constant_column = NARC_COLUMN_INIT(two_bodies, shape);
static const narc_bodies constant_bodies = {.count = 2,
                                            .x = NARC_POSITION_COLUMN_INIT(two_bodies, x),
                                            .y = NARC_POSITION_ARRAY_INIT(numbers),
                                            .cosine = NARC_ARRAY_INIT(numbers)};

#define EXPECT_COLUMN(column, first, step)                                                                             \
    do {                                                                                                               \
        assert_ptr_equal((column).base, first);                                                                        \
        assert_int_equal((column).stride, step);                                                                       \
    } while (0)

/* Columns are values, wherever a value may stand; constants are the initialisers of static objects. */
TEST(test_columns) {
    narc_bodies bodies = {.count = 2, .x = NARC_POSITION_COLUMN(two_bodies, x), .sine = NARC_ARRAY(numbers)};
    EXPECT_COLUMN(bodies.x, &two_bodies[0].x, sizeof two_bodies[0]);
    EXPECT_COLUMN(bodies.sine, numbers, sizeof(float));
    bodies.x = NARC_POSITION_COLUMN(two_bodies, y);
    bodies.sine = bodies.count > 2 ? bodies.cosine : NARC_ARRAY(numbers + 1);
    EXPECT_COLUMN(bodies.x, &two_bodies[0].y, sizeof two_bodies[0]);
    EXPECT_COLUMN(bodies.sine, numbers + 1, sizeof(float));
    EXPECT_COLUMN(NARC_COLUMN(two_bodies + 1, shape), &two_bodies[1].shape, sizeof two_bodies[0]);
    EXPECT_COLUMN(constant_column, &two_bodies[0].shape, sizeof two_bodies[0]);
    EXPECT_COLUMN(constant_bodies.x, &two_bodies[0].x, sizeof two_bodies[0]);
    EXPECT_COLUMN(constant_bodies.cosine, numbers, sizeof(float));
    assert_int_equal(constant_bodies.x.precision, NARC_FLOAT64);
    assert_int_equal(constant_bodies.y.precision, NARC_FLOAT32);
    const bool flags[] = {true, false};
    const narc_byte_column bytes = NARC_ARRAY(flags);
    EXPECT_COLUMN(bytes, flags, 1);
}

int main(void) { return test_run("bodies", NULL, NULL); }
