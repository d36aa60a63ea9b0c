/* SPDX-License-Identifier: MIT
 *
 * far.c - scenes far from the world's origin, whose boxes have one of their own: what is asked of an index there has the answers
 * that it has at the world's origin, to the last bit.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "everything.h"
#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "ray_room.h"

enum { BODIES = 300, RAYS = 400, MOST = 3 };

/* Positions that are the same numbers after they have been moved there and back. */
static double coarse(double position) { return round(position * 0x1p20) * 0x1p-20; }
static const narc_point places[] = {{0x1p30, -0x1p31}, {-1e9 - 7, 1e9}, {0x1p32, 0}};

static void move_to(struct body *bodies, size_t count, narc_point place) {
    for (size_t k = 0; k < count; k++) {
        bodies[k].x = coarse(bodies[k].x) + place.x;
        bodies[k].y = coarse(bodies[k].y) + place.y;
    }
}

/* All that is asked, of bodies that are moved by `place`, with an index whose origin is there; or came there `later`. */
struct far_answers {
    narc_box box[BODIES];
    narc_ray_hit hit[6][RAYS * MOST]; /* then of things */
    narc_distance nearest[RAYS * MOST];
    narc_impact impact[BODIES];
    uint32_t a[BODIES * BODIES / 4], b[BODIES * BODIES / 4];
    size_t pairs;
};

static void ask_all(struct world *world, const struct test_ray *rays, narc_point place, bool later,
                    struct far_answers *out) {
    static narc_box old[BODIES];
    static struct test_ray moved[RAYS];
    struct everything e = view_world(world);
    narc_index *index;
    narc_pairs pairs;
    narc_error error;
    uint32_t own[BODIES], owner[BODIES];
    const narc_owners owners = {.owner = NARC_ARRAY(owner)};
    const narc_index_options at = {.origin = &place};
    const narc_index_query others = {.ignored = NARC_ARRAY(own)};
    for (uint32_t k = 0; k < BODIES; k++)
        own[k] = k, owner[k] = k / 10;
    move_to(world->scene.bodies, BODIES, place);
    for (size_t k = 0; k < RAYS; k++) {
        moved[k] = rays[k];
        moved[k].x = coarse(rays[k].x) + place.x;
        moved[k].y = coarse(rays[k].y) + place.y;
    }
    expect_ok(narc_compute_boxes(e.shapes, &e.bodies, &(narc_box_options){.origin = &place}, out->box, &error), &error);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    if (later) {
        const narc_index_column none = NARC_ARRAY(own);
        expect_ok(narc_compute_boxes(e.shapes, &e.bodies, NULL, old, &error), &error);
        expect_ok(narc_build_index(index, old, BODIES, NULL, &error), &error);
        expect_ok(narc_update_index(index, out->box, BODIES, &none, 0, &at, &error), &error);
    } else
        expect_ok(narc_build_index(index, out->box, BODIES, &at, &error), &error);
    for (int way = 0; way < 6; way++) {
        const narc_rays view = view_rays(moved, RAYS);
        const narc_ray_options options = {
            .search = {.owners = way < 3 ? NULL : &owners}, .inside = (narc_inside)(way % 3), .most = MOST};
        expect_ok(
            narc_cast_rays(index, e.shapes, &e.bodies, &view, &options, out->hit[way], (size_t)RAYS * MOST, &error),
            &error);
    }
    const narc_points points = {.count = RAYS,
                                .x = {&moved[0].x, sizeof *moved, NARC_FLOAT64},
                                .y = {&moved[0].y, sizeof *moved, NARC_FLOAT64}};
    const narc_nearest_options nearest = {.most = MOST};
    expect_ok(
        narc_find_nearest(index, e.shapes, &e.bodies, &points, &nearest, out->nearest, (size_t)RAYS * MOST, &error),
        &error);
    expect_ok(
        narc_cast_shapes(index, e.shapes, &e.bodies, &e.bodies, &e.motions, &others, NULL, out->impact, BODIES, &error),
        &error);
    expect_ok(narc_query_index(index, out->box, BODIES, NULL, &pairs, &error), &error);
    out->pairs = pairs.count;
    assert_true(pairs.count <= sizeof out->a / sizeof *out->a);
    memcpy(out->a, pairs.a.base, pairs.count * sizeof *out->a);
    memcpy(out->b, pairs.b.base, pairs.count * sizeof *out->b);
    narc_destroy_index(index);
    for (size_t k = 0; k < BODIES; k++) {
        world->scene.bodies[k].x -= place.x;
        world->scene.bodies[k].y -= place.y;
    }
}

TEST(an_index_far_away_has_the_same_answers) {
    static struct far_answers here, there;
    struct test_random random = test_random_named("far");
    for (size_t trial = 0; trial < test_trials(6); trial++) {
        struct room room = create_room(&random, NARC_FLOAT64, BODIES, 30);
        AUTO(free_at) struct test_ray *const rays = make_rays(&random, &room, RAYS, 30);
        room.scene.bodies[11] = room.scene.bodies[10]; /* it has flown away */
        move_to(room.scene.bodies, BODIES, (narc_point){-1e6, 0});
        for (size_t k = 0; k < RAYS; k++)
            rays[k].x -= 1e6;
        struct world world = make_world(&random, room.scene, BODIES, 0);
        size_t hits = 0, impacts = 0;
        for (size_t k = 0; k < BODIES; k++)
            world.motion[k] =
                (narc_motion){(float)random_between(&random, -4, 4), (float)random_between(&random, -4, 4),
                              random_below(&random, 2) ? (float)random_between(&random, -3, 3) : 0};
        memset(&here, 0, sizeof here);
        ask_all(&world, rays, (narc_point){0, 0}, false, &here);
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            memset(&there, 0, sizeof there);
            ask_all(&world, rays, places[k], (trial + k) % 2 == 1, &there);
            assert_memory_equal(there.box, here.box, sizeof here.box);
            assert_memory_equal(there.hit, here.hit, sizeof here.hit);
            assert_memory_equal(there.nearest, here.nearest, sizeof here.nearest);
            assert_memory_equal(there.impact, here.impact, sizeof here.impact);
            assert_int_equal(there.pairs, here.pairs);
            assert_memory_equal(there.a, here.a, sizeof here.a);
            assert_memory_equal(there.b, here.b, sizeof here.b);
        }
        for (size_t k = 0; k < (size_t)RAYS * MOST; k++)
            hits += here.hit[0][k].count;
        for (size_t k = 0; k < BODIES; k++)
            impacts += here.impact[k].count == NARC_CAST_HIT;
        assert_true(hits > RAYS / 4 && impacts > BODIES / 8);
        narc_destroy_index(room.index);
        free(room.boxes);
        free(room.category);
        destroy_world(&world); /* with the room's bodies */
    }
}

/* A polygon with a side through its own origin is a plane, however large it is: contacts near its position are as exact as near
 * a small one, level or tilted. */
TEST(a_large_polygon_is_a_plane) {
    struct test_random random = test_random_named("planes");
    const double sizes[] = {1e2, 1e4, 1e6, 1e8};
    for (size_t k = 0; k < 4 * test_trials(500); k++) {
        const double size = sizes[k % 4], angle = k % 8 < 4 ? 0 : random_between(&random, -PI, PI);
        const narc_point corners[] = {{size, 0}, {-size, 0}, {-size, -size}, {size, -size}};
        struct shape plane = {.count = 0};
        AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
        narc_error error;
        expect_ok(narc_build_polygon(corners, 4, 0, plane.arcs, &plane.count, &error), &error);
        const narc_body ground = {0, 0, (float)cos(angle), (float)sin(angle), 1, store_shape(shapes, plane)};
        const double length = hypot((double)ground.cosine, (double)ground.sine);
        const double c = (double)ground.cosine / length, s = (double)ground.sine / length;
        const double along = random_between(&random, -50, 50), gap = random_between(&random, -0.4, 0.4);
        const narc_body box = {
            c * along - s * (gap + 0.5),         s * along + c * (gap + 0.5), ground.cosine, ground.sine, 1,
            store_shape(shapes, box_of(1, 1, 0))};
        const narc_query query = {.margin = 1};
        narc_manifold row;
        expect_ok(narc_find_manifold(shapes, &ground, &box, &query, &row, &error), &error);
        assert_int_equal(row.count, 2);
        const double bound = NARC_ERROR_BOUND * (fabs(along) + 2);
        for (int i = 0; i < 2; i++)
            assert_true(fabs((double)row.point[i].separation - gap) <= bound);
        assert_true(fabs((double)row.normal_x + s) <= 1e-6 && fabs((double)row.normal_y - c) <= 1e-6);
    }
}

/* An origin that is none is refused, and nothing is written. */
TEST(origins_are_finite) {
    const narc_point bad[] = {{NAN, 0}, {0, INFINITY}};
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    AUTO(narc_destroy_contacts_at) narc_contacts *contacts;
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_error error;
    const narc_bodies none = {.count = 0};
    const narc_step_result *r = NULL;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    assert_int_equal(narc_create_contacts(NULL, &contacts, NULL), NARC_OK);
    for (int k = 0; k < 2; k++) {
        const narc_box_options boxes = {.origin = &bad[k]};
        const narc_index_options options = {.origin = &bad[k]};
        const narc_step step = {.bodies = &none, .origin = &bad[k]};
        assert_int_equal(narc_compute_boxes(shapes, &none, &boxes, NULL, &error), NARC_ERROR_NOT_FINITE);
        assert_non_null(strstr(error.message, "options.origin"));
        assert_int_equal(narc_build_index(index, NULL, 0, &options, &error), NARC_ERROR_NOT_FINITE);
        assert_int_equal(narc_update_contacts(contacts, shapes, &step, &r, &error), NARC_ERROR_NOT_FINITE);
        assert_non_null(strstr(error.message, "step.origin"));
        assert_null(r);
    }
}

TEST_MAIN("far")
