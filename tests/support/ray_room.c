/* SPDX-License-Identifier: MIT
 *
 * ray_room.c - scenes of many bodies with their index, and rays through them.
 */
#include "ray_room.h"

#include <math.h>
#include <stdlib.h>

#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"

void index_room(struct room *room, bool fast, bool masks) {
    const narc_bodies bodies = scene_bodies(&room->scene);
    narc_index_options options = {.fast = fast};
    narc_error error;
    if (masks)
        options.category = (narc_word_column){room->category, sizeof *room->category};
    expect_ok(narc_compute_boxes(room->scene.store, &bodies, NULL, room->boxes, &error), &error);
    expect_ok(narc_build_index(room->index, room->boxes, bodies.count, &options, &error), &error);
}

struct room create_room(struct test_random *random, narc_precision precision, size_t count, double side) {
    struct room room = {.scene = create_scene(precision, FAMILY_COUNT, count, 1)};
    for (enum family family = 0; family < FAMILY_COUNT; family++) {
        const struct shape shape = make_shape(random, family);
        scene_add_shape(&room.scene, &shape);
    }
    const double far = precision == NARC_FLOAT64 ? 1e6 : 100;
    for (size_t k = 0; k < count; k++) {
        const bool lattice = random_below(random, 3) == 0;
        struct body body =
            turned_body(lattice ? 0 : random_between(random, -4, 4), lattice ? 1 : random_log_between(random, 0.1, 3));
        body.x = far + (lattice ? (double)random_below(random, (size_t)side + 1) : random_between(random, 0, side));
        body.y = lattice ? (double)random_below(random, (size_t)side + 1) : random_between(random, 0, side);
        body.shape = (uint32_t)random_below(random, FAMILY_COUNT);
        if (k % 5 == 4)
            body = room.scene.bodies[k - 1];
        scene_add_body(&room.scene, body);
    }
    if (count > 20) {
        room.scene.bodies[7].sine = 3;
        room.scene.bodies[11] = fly_away(room.scene.bodies[11], random_below(random, 24), precision);
        room.scene.bodies[8].shape = FAMILY_FITTED;
        assert_int_equal(narc_remove_shape(room.scene.store, FAMILY_FITTED, NULL), NARC_OK);
    }
    room.boxes = calloc(count + 1, sizeof *room.boxes);
    room.category = calloc(count + 1, sizeof *room.category);
    assert_true(room.boxes && room.category);
    for (size_t k = 0; k < count; k++)
        room.category[k] = UINT64_C(1) << random_below(random, 64) | (uint64_t)(k % 3);
    assert_int_equal(narc_create_index(&guard_allocator, &room.index), NARC_OK);
    index_room(&room, false, false);
    return room;
}

void destroy_room(struct room *room) {
    narc_destroy_index(room->index);
    free(room->boxes);
    free(room->category);
    destroy_scene(&room->scene);
}

/* Turns a ray into a fan from where it starts, or from outside of the scene, in the order of angles and otherwise; some
 * pass the axes, where components are 0 and -0. */
static void fan_out(struct test_random *random, struct test_ray *rays, size_t count, double side) {
    static const double steps[] = {0, 1e-7, 1e-3, 0.02, 0.1, 0.5};
    struct test_ray first = rays[0];
    const double length = hypot((double)first.motion_x, (double)first.motion_y);
    const double step = steps[random_below(random, sizeof steps / sizeof *steps)];
    const double start = random_below(random, 2) ? random_between(random, -4, 4)
                                                 : (double)random_below(random, 4) * 1.5707963267948966 - 3 * step;
    if (random_below(random, 3) == 0) {
        first.x -= round(100 * side * cos(start));
        first.y -= round(100 * side * sin(start));
        first.fraction = INFINITY;
    }
    for (size_t k = 0; k < count; k++) {
        const size_t turns = random_below(random, 8) ? k : random_below(random, count);
        const double x = cos(start + step * (double)turns), y = sin(start + step * (double)turns);
        rays[k] = first;
        rays[k].motion_x = fabs(x) < 1e-9 ? copysignf(0, (float)x) : (float)(length * x);
        rays[k].motion_y = fabs(y) < 1e-9 ? copysignf(0, (float)y) : (float)(length * y);
        rays[k].fraction = random_below(random, 9) ? first.fraction : (float)random_between(random, 0, 1);
    }
}

struct test_ray *make_rays(struct test_random *random, const struct room *room, size_t count, double side) {
    struct test_ray *const rays = calloc(count + 1, sizeof *rays);
    const struct scene *const scene = &room->scene;
    assert_non_null(rays);
    for (size_t k = 0; k < count; k++) {
        const struct body *const body = &scene->bodies[random_below(random, scene->body_count)];
        if (random_below(random, 2) && body->sine < 2) {
            rays[k] = make_ray(random, &scene->shapes[body->shape], body, scene->precision,
                               (enum ray_kind)random_below(random, RAY_KINDS));
            continue;
        }
        const double angle = random_between(random, -4, 4), length = random_log_between(random, 0.1, 3 * side);
        const bool along_axis = random_below(random, 3) == 0, whole = random_below(random, 2);
        const size_t quarter = random_below(random, 4);
        rays[k] = (struct test_ray){
            .x = scene->bodies[0].x + (whole ? (double)random_below(random, 10) : random_between(random, -side, side)),
            .y = whole ? (double)random_below(random, 10) : random_between(random, -side, 2 * side),
            .motion_x = (float)(length * (along_axis ? (double)(1 - (int)quarter) * (quarter != 3) : cos(angle))),
            .motion_y = (float)(length * (along_axis ? (quarter == 1) - (quarter == 3) : sin(angle))),
            .fraction = random_below(random, 4) ? 1 : INFINITY};
    }
    for (size_t k = 0; k < count;) {
        const size_t next = k + 1 + random_below(random, 80);
        if (next <= count && random_below(random, 2))
            fan_out(random, rays + k, next - k, side);
        k = next;
    }
    for (size_t k = 0; k < count && scene->precision == NARC_FLOAT32; k++) {
        rays[k].x = (double)(float)rays[k].x;
        rays[k].y = (double)(float)rays[k].y;
    }
    return rays;
}

narc_ray_hit *cast_in_room(const struct room *room, const narc_rays *rays, const narc_ray_options *options) {
    const narc_bodies bodies = scene_bodies(&room->scene);
    const size_t rows = rays->count * (options && options->most ? options->most : 1);
    narc_ray_hit *const hits = guard_allocate(rows * sizeof *hits);
    narc_error error;
    expect_ok(narc_cast_rays(room->index, room->scene.store, &bodies, rays, options, hits, rows, &error), &error);
    return hits;
}
