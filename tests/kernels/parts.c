/* SPDX-License-Identifier: MIT
 *
 * parts.c - compounds: their parts are where they should be; those of one body form no pair.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "expect.h"
#include "guard.h"
#include "ledger.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "scene.h"

/* Random owners and parts, and whose they are. Some of each are broken. */
struct compounds {
    struct scene owners, parts;
    uint32_t *owner;
};

static struct compounds make_compounds(struct test_random *random, size_t owners, size_t parts, bool broken) {
    struct compounds c = {make_random_scene(random, (narc_precision)random_below(random, 2), owners, 1),
                          make_random_scene(random, (narc_precision)random_below(random, 2), parts, 1),
                          malloc(parts * sizeof *c.owner)};
    assert_non_null(c.owner);
    for (size_t k = 0; k < parts; k++)
        c.owner[k] = (uint32_t)random_below(random, owners);
    for (size_t k = 0; broken && k < parts / 8; k++) {
        c.parts.bodies[random_below(random, parts)].sine = k % 2 ? NAN : 3;
        c.owners.bodies[random_below(random, owners)].scale = k % 2 ? -1 : INFINITY;
    }
    return c;
}

static void destroy_compounds(struct compounds *c) {
    destroy_scene(&c->owners);
    destroy_scene(&c->parts);
    free(c->owner);
}

static narc_body *place(const narc_bodies *owners, const narc_bodies *parts, const uint32_t *owner,
                        const narc_workers *workers) {
    narc_body *const rows = guard_allocate(parts->count * sizeof *rows);
    narc_error error;
    expect_ok(narc_place_parts(owners, parts, &(narc_index_column){owner, sizeof *owner}, workers, rows, &error),
              &error);
    return rows;
}

static narc_body *place_all(const struct compounds *c) {
    const narc_bodies owners = scene_bodies(&c->owners), parts = scene_bodies(&c->parts);
    return place(&owners, &parts, c->owner, NULL);
}

/* Without cosines, sines and scales it is as with those of a part that is not turned. */
TEST(what_is_left_out_is_not_turned) {
    struct test_random random = test_random_named("unturned parts");
    AUTO(destroy_compounds) struct compounds c = make_compounds(&random, 20, 300, false);
    for (size_t k = 0; k < c.parts.body_count; k++) {
        c.parts.bodies[k].cosine = c.parts.bodies[k].scale = 1;
        c.parts.bodies[k].sine = 0;
    }
    AUTO(guard_release_at) narc_body *const right = place_all(&c);
    const narc_bodies owners = scene_bodies(&c.owners);
    narc_bodies parts = scene_bodies(&c.parts);
    parts.cosine.base = parts.sine.base = parts.scale.base = NULL;
    AUTO(guard_release_at) narc_body *const rows = place(&owners, &parts, c.owner, NULL);
    assert_memory_equal(rows, right, parts.count * sizeof *rows);
}

/* ------------------------------------------------------------------------------------------------ places */

static double number_of(const struct scene *scene, const struct body *body, bool y) {
    return scene->precision == NARC_FLOAT64 ? (y ? body->y : body->x) : (double)(y ? body->y_single : body->x_single);
}

/* With roundings of double precision for a position, of single precision for a rotation and a scale. */
TEST(parts_are_in_their_places) {
    struct test_random random = test_random_named("places of parts");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        AUTO(destroy_compounds) struct compounds c = make_compounds(&random, 1 + random_below(&random, 40), 200, false);
        AUTO(guard_release_at) narc_body *const rows = place_all(&c);
        for (size_t k = 0; k < c.parts.body_count; k++) {
            const struct body *const part = &c.parts.bodies[k], *const at = &c.owners.bodies[c.owner[k]];
            const double turn = atan2((double)at->sine, (double)at->cosine), scale = (double)at->scale;
            const double x = number_of(&c.parts, part, false), y = number_of(&c.parts, part, true);
            const double angle = turn + atan2((double)part->sine, (double)part->cosine);
            const bool unturned =
                part->sine == 0 && part->cosine > 0; /* then to the bit, however long the owner's is */
            const double cosine = unturned ? (double)at->cosine : cos(angle),
                         sine = unturned ? (double)at->sine : sin(angle);
            const double to_x = number_of(&c.owners, at, false) + scale * (cos(turn) * x - sin(turn) * y);
            const double to_y = number_of(&c.owners, at, true) + scale * (sin(turn) * x + cos(turn) * y);
            const double room = 8 * DBL_EPSILON * (fabs(to_x) + fabs(to_y) + scale * (fabs(x) + fabs(y)));
            assert_true(fabs(rows[k].x - to_x) <= room && fabs(rows[k].y - to_y) <= room);
            assert_true(fabs((double)rows[k].cosine - cosine) <= 0x1p-24 * 0.51 &&
                        fabs((double)rows[k].sine - sine) <= 0x1p-24 * 0.51);
            assert_true(rows[k].scale == at->scale * part->scale && rows[k].shape == part->shape);
        }
    }
}

/* A body of one shape is a part at (0, 0) of its own. */
TEST(unturned_parts_keep_their_rotation) {
    enum { COUNT = 10000 };
    struct test_random random = test_random_named("parts that are not turned");
    static narc_body bodies[COUNT];
    static uint32_t owner[COUNT];
    const narc_body plain[2] = {{.cosine = 1, .scale = 1, .shape = 7}, {.cosine = 1.0001f, .sine = -0.0f, .scale = 1}};
    for (size_t k = 0; k < COUNT; k++) {
        const struct body at = turned_body(k < 5 ? PI / 2 * (double)k : random_between(&random, -PI, PI), 1);
        bodies[k] = (narc_body){(double)k, 1, at.cosine, at.sine, at.scale, 7};
        owner[k] = (uint32_t)k;
    }
    bodies[5] = (narc_body){0, 1, 1, -0.0f, 1, 7};
    narc_bodies owners;
    narc_view_bodies(bodies, COUNT, &owners);
    for (int drifted = 0; drifted < 2; drifted++) {
        narc_bodies parts;
        narc_view_bodies(&plain[drifted], COUNT, &parts);
        parts.x.stride = parts.y.stride = parts.cosine.stride = parts.sine.stride = parts.scale.stride = 0;
        parts.shape.stride = 0;
        AUTO(guard_release_at) narc_body *const rows = place(&owners, &parts, owner, NULL);
        for (size_t k = 0; k < COUNT; k++)
            assert_memory_equal(&rows[k].cosine, &bodies[k].cosine, 2 * sizeof(float));
        if (!drifted)
            assert_memory_equal(rows, bodies, sizeof bodies);
    }
}

/* Scales below 0, whose product is not. */
TEST(two_broken_scales_are_none) {
    const narc_body owner = {1, 2, 0.6f, 0.8f, -1, 0}, part = {3, 4, 1, 0, -2, 0}, zeros = {0};
    narc_bodies owners, parts;
    narc_view_bodies(&owner, 1, &owners);
    narc_view_bodies(&part, 1, &parts);
    const uint32_t zero = 0;
    narc_body row;
    assert_int_equal(narc_place_parts(&owners, &parts, &(narc_index_column){&zero, 0}, NULL, &row, NULL), NARC_OK);
    assert_memory_equal(&row, &zeros, sizeof row);
}

/* A part in its place is the shape that narc_move_arcs() makes, in the place of its owner. */
TEST(moved_shapes_are_placed_parts) {
    struct test_random random = test_random_named("parts and moved shapes");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        const double angle = random_between(&random, -4, 4), scale = random_between(&random, 0.5, 2);
        const float cosine = (float)cos(angle), sine = (float)sin(angle);
        struct shape moved = {.count = shape.count};
        AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
        narc_body part = {random_between(&random, -2, 2), random_between(&random, -2, 2), cosine, sine, (float)scale,
                          store_shape(store, shape)};
        const struct body turned = turned_body(random_between(&random, -4, 4), 1.5);
        narc_body bodies[4] = {{5, 6, turned.cosine, turned.sine, turned.scale, 0}};
        narc_bodies owners, parts;
        narc_view_bodies(bodies, 1, &owners);
        narc_view_bodies(&part, 1, &parts);
        narc_bodies all;
        narc_view_bodies(bodies, 4, &all);
        const uint32_t zero = 0;
        narc_contact row[2];
        size_t found;
        assert_int_equal(narc_place_parts(&owners, &parts, &(narc_index_column){&zero, 0}, NULL, &bodies[1], NULL),
                         NARC_OK);
        assert_int_equal(narc_move_arcs(shape.arcs, shape.count, part.x, part.y,
                                        atan2((double)part.sine, (double)part.cosine), (double)part.scale, moved.arcs,
                                        NULL),
                         NARC_OK);
        bodies[3] = bodies[0];
        bodies[3].shape = store_shape(store, moved);
        bodies[0] = bodies[2] = (narc_body){5 + random_between(&random, -4, 4), 6, 1, 0, 1, part.shape};
        assert_int_equal(narc_find_contacts(store, &all, &(narc_pairs){.count = 2}, &(narc_query){.margin = INFINITY},
                                            row, 2, &found, NULL),
                         NARC_OK);
        assert_int_equal(row[0].count + row[1].count, 2);
        assert_true(fabsf(row[0].separation - row[1].separation) <= 40 * (float)NARC_ERROR_BOUND);
    }
}

/* A part of an owner that has moved on its way for some time, and what it comes near to. */
static double separation_at(const narc_shapes *store, const narc_body *part, narc_point motion, double angle,
                            double time, const narc_body *other) {
    const uint32_t zero = 0;
    const narc_body owner = {
        motion.x * (time - 0.5), motion.y * (time - 0.5), (float)cos(angle * time), (float)sin(angle * time), 1, 0};
    narc_body two[2] = {{0}, *other};
    narc_bodies owners, parts, bodies;
    narc_view_bodies(&owner, 1, &owners);
    narc_view_bodies(part, 1, &parts);
    narc_view_bodies(two, 2, &bodies);
    narc_contact row;
    size_t found;
    assert_int_equal(narc_place_parts(&owners, &parts, &(narc_index_column){&zero, 0}, NULL, two, NULL), NARC_OK);
    assert_int_equal(narc_find_contacts(store, &bodies, &(narc_pairs){.count = 1}, &(narc_query){.margin = INFINITY},
                                        &row, 1, &found, NULL),
                     NARC_OK);
    return (double)row.separation;
}

/* Casts of owners that turn, with the part's shape in the owner's frame. */
TEST(moved_shapes_meet_when_parts_do) {
    struct test_random random = test_random_named("casts of compounds");
    const double tolerance = 1e-3, rounding = 1e-4; /* NARC_ERROR_BOUND of some units */
    size_t hits = 0;
    for (size_t trial = 0; trial < test_trials(200); trial++) {
        const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        const float turn = (float)random_between(&random, -3, 3);
        const struct body at = turned_body(random_between(&random, -4, 4), 1);
        AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
        const uint32_t stored = store_shape(store, shape);
        const narc_body part = {random_between(&random, -2, 2), 1, at.cosine, at.sine, 1, stored};
        struct shape moved = {.count = shape.count};
        assert_int_equal(narc_move_arcs(shape.arcs, shape.count, part.x, part.y,
                                        atan2((double)part.sine, (double)part.cosine), 1, moved.arcs, NULL),
                         NARC_OK);
        const narc_body two[2] = {{-4, -0.5, 1, 0, 1, store_shape(store, moved)},
                                  {0.5, random_between(&random, -2, 2), 1, 0, 1, stored}};
        narc_impact row;
        assert_int_equal(narc_cast_pair(store, &two[0], &(narc_motion){8, 1, turn}, &two[1], NULL,
                                        &(narc_cast_options){.tolerance = (float)tolerance}, &row, NULL),
                         NARC_OK);
        const double end = row.count == NARC_CAST_MISS ? 1 : (double)row.fraction;
        for (int k = 0; k <= 20; k++) {
            const double here = separation_at(store, &part, (narc_point){8, 1}, (double)turn, end * k / 20, &two[1]);
            assert_true(here >= -rounding || (row.count == NARC_CAST_HIT && row.fraction == 0));
            if (k == 20 && row.count == NARC_CAST_HIT && row.fraction > 0)
                assert_true(here <= tolerance + rounding);
        }
        hits += row.count == NARC_CAST_HIT && row.fraction > 0;
    }
    assert_true(hits > test_trials(200) / 4);
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* Every pair of parts of two bodies whose boxes meet, and none of one body. */
TEST(parts_of_one_body_form_no_pair) {
    enum { BODIES = 60, PARTS = 4 * BODIES };
    struct test_random random = test_random_named("pairs of parts");
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        AUTO(destroy_compounds) struct compounds c = make_compounds(&random, BODIES, PARTS, false);
        AUTO(narc_destroy_broad_phase_at) narc_broad_phase *const broad = create_broad_phase(NULL);
        uint32_t a[9000], b[9000];
        for (size_t k = 0; k < PARTS; k++) {
            struct body *const part = &c.parts.bodies[k];
            part->x_single *= 0.125f, part->y_single *= 0.125f, part->x *= 0.125, part->y *= 0.125;
        }
        for (size_t k = 0; k < BODIES; k++) {
            struct body *const at = &c.owners.bodies[k];
            at->x = at->x_single = (float)random_between(&random, -9, 9);
            at->y = at->y_single = (float)random_between(&random, -9, 9);
        }
        AUTO(guard_release_at) narc_body *const rows = place_all(&c);
        narc_bodies bodies;
        narc_view_bodies(rows, PARTS, &bodies);
        const narc_pair_filter filter = {.owner = {c.owner, sizeof *c.owner}};
        narc_box boxes[PARTS];
        size_t count, expected = 0, own = 0;
        assert_int_equal(narc_compute_boxes(c.parts.store, &bodies, NULL, boxes, NULL), NARC_OK);
        assert_int_equal(narc_find_pairs(broad, boxes, PARTS, &filter, NULL, a, b, 0, 9000, &count, NULL), NARC_OK);
        for (size_t i = 0; i < PARTS; i++)
            for (size_t j = i + 1; j < PARTS; j++)
                *(c.owner[i] == c.owner[j] ? &own : &expected) += overlap(&boxes[i], &boxes[j]);
        for (size_t k = 0; k < count; k++)
            assert_true(c.owner[a[k]] != c.owner[b[k]] && overlap(&boxes[a[k]], &boxes[b[k]]));
        assert_int_equal(count, expected);
        assert_true(own > 0 && expected > 0); /* or nothing was tested */
    }
}

TEST_MAIN("parts")
