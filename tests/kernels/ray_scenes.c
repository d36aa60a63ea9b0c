/* SPDX-License-Identifier: MIT
 *
 * ray_scenes.c - rays that meet things of several parts, rays without an answer, bodies of any size from anywhere.
 * searches.c has rays through an index against each body by itself.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"
#include "ray_room.h"

/* ------------------------------------------------------------------------------------------------ things */

enum { THINGS = 12, PARTS = 5, THING_RAYS = 60 };

/* Bars of tiles that touch, or overlap, or have a gap, in any order of numbers, crossing each other. */
static struct room create_things(struct test_random *random, uint32_t *owner) {
    struct room room = {.scene = create_scene(NARC_FLOAT64, 2, THINGS * PARTS, 1)};
    const struct shape box = box_of(1, 1, 0), disc = circle_of(0.55);
    scene_add_shape(&room.scene, &box);
    scene_add_shape(&room.scene, &disc);
    for (size_t k = 0; k < THINGS * PARTS; k++) {
        owner[k] = 7 * (uint32_t)(k % THINGS) + 1;
        if (k % THINGS == 3)
            owner[k] = UINT32_MAX;
    }
    for (size_t k = 0; k < THINGS * PARTS; k++) {
        static double x[THINGS], y[THINGS], angle[THINGS], step[THINGS];
        const size_t thing = k % THINGS, part = k / THINGS;
        if (part == 0) {
            x[thing] = random_between(random, 0, 6);
            y[thing] = random_between(random, 0, 6);
            angle[thing] = random_below(random, 2) ? random_between(random, -4, 4) : 0;
            step[thing] = random_below(random, 3) ? 1 : random_between(random, 0.5, 1.1);
        }
        struct body body = turned_body(angle[thing], 1);
        const double c = (double)body.cosine, s = (double)body.sine, length = hypot(c, s);
        const size_t place = (3 * part + thing) % PARTS; /* neighbours have other numbers */
        body.x = x[thing] + step[thing] * (double)place * c / length;
        body.y = y[thing] + step[thing] * (double)place * s / length;
        body.shape = (uint32_t)(random_below(random, 4) == 0);
        scene_add_body(&room.scene, body);
    }
    room.boxes = calloc(THINGS * PARTS, sizeof *room.boxes);
    room.category = calloc(THINGS * PARTS, sizeof *room.category);
    assert_true(room.boxes && room.category);
    for (size_t k = 0; k < THINGS * PARTS; k++)
        room.category[k] = random_below(random, 8) ? 3 : 1;
    assert_int_equal(narc_create_index(&guard_allocator, &room.index), NARC_OK);
    return room;
}

/* Rows of all parts, each by itself, from where a ray enters or starts, and to where it leaves: of the same ray, turned
 * round. */
struct spans {
    bool meets[THINGS * PARTS], starts[THINGS * PARTS];
    double from[THINGS * PARTS], to[THINGS * PARTS];
};

static struct spans find_spans(const struct room *room, const struct test_ray *ray) {
    struct spans spans = {{false}, {false}, {0}, {0}};
    for (size_t b = 0; b < THINGS * PARTS; b++) {
        struct test_ray rays[2] = {*ray, *ray};
        rays[1].x += (double)ray->motion_x * 64;
        rays[1].y += (double)ray->motion_y * 64;
        rays[1].motion_x *= -1;
        rays[1].motion_y *= -1;
        rays[0].fraction = rays[1].fraction = 64;
        const narc_rays view = view_rays(rays, 2);
        struct room alone = *room;
        alone.scene.bodies += b;
        alone.scene.body_count = 1;
        narc_box box;
        alone.boxes = &box;
        index_room(&alone, false, false);
        AUTO(guard_release_at) narc_ray_hit *const hits = cast_in_room(&alone, &view, NULL);
        spans.meets[b] = hits[0].count && hits[1].count;
        spans.starts[b] = spans.meets[b] && hits[0].normal_x == 0 && hits[0].normal_y == 0;
        spans.from[b] = (double)hits[0].fraction;
        spans.to[b] = 64 - (double)hits[1].fraction;
    }
    return spans;
}

/* What a thing is met at, as unions of spans have it: -1: nowhere. */
static double meet_thing(const struct spans *spans, const uint32_t *owner, const bool *found, uint32_t thing,
                         narc_inside inside) {
    const double seam = 1e-5;
    bool starts = false;
    double first = INFINITY, end = 0;
    for (size_t b = 0; b < THINGS * PARTS; b++)
        if (found[b] && spans->meets[b] && owner[b] == thing) {
            starts = starts || spans->starts[b];
            first = fmin(first, spans->from[b]);
        }
    if (!starts || inside == NARC_INSIDE_STOPS)
        return first < INFINITY ? first : -1;
    for (size_t round = 0; round < PARTS; round++)
        for (size_t b = 0; b < THINGS * PARTS; b++)
            if (found[b] && spans->meets[b] && owner[b] == thing && spans->from[b] <= end + seam)
                end = fmax(end, spans->to[b]);
    return inside == NARC_INSIDE_LEAVES ? end : -1;
}

/* One row a thing; what starts in one part of it leaves the last, or does not meet it at all; what is masked, or ignored,
 * or of an owner that is, is not there. */
TEST(things_are_met_as_wholes) {
    struct test_random random = test_random_named("rays and owners");
    enum { BODIES = THINGS * PARTS };
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        uint32_t owner[BODIES];
        AUTO(destroy_room) struct room room = create_things(&random, owner);
        for (size_t k = 0; k < THING_RAYS; k++) {
            const struct body *const body = &room.scene.bodies[random_below(&random, BODIES)];
            const double along = atan2((double)body->sine, (double)body->cosine);
            const double angle = random_below(&random, 3) ? along + random_between(&random, -0.05, 0.05)
                                                          : random_between(&random, -4, 4);
            const struct test_ray ray = {body->x + random_between(&random, -0.4, 0.4),
                                         body->y + random_between(&random, -0.4, 0.4), (float)cos(angle),
                                         (float)sin(angle), 16};
            const struct spans spans = find_spans(&room, &ray);
            const uint64_t mask = random_below(&random, 2) ? 2 : 3;
            const uint32_t ignored = random_below(&random, 4) ? UINT32_MAX : (uint32_t)random_below(&random, BODIES);
            const uint32_t ignored_owner = random_below(&random, 4) ? UINT32_MAX : owner[random_below(&random, BODIES)];
            const narc_owners owners = {.owner = NARC_ARRAY(owner), .ignored = {&ignored_owner, 0}};
            bool found[BODIES];
            for (size_t b = 0; b < BODIES; b++)
                found[b] = (room.category[b] & mask) && b != ignored &&
                           (ignored_owner == UINT32_MAX || owner[b] != ignored_owner);
            index_room(&room, trial % 2, true);
            const narc_rays view = view_rays(&ray, 1);
            for (narc_inside inside = NARC_INSIDE_STOPS; inside <= NARC_INSIDE_IGNORES; inside++) {
                const narc_ray_options options = {
                    .search = {.mask = {&mask, 0}, .ignored = {&ignored, 0}, .owners = &owners},
                    .inside = inside,
                    .most = BODIES};
                AUTO(guard_release_at) narc_ray_hit *const rows = cast_in_room(&room, &view, &options);
                for (size_t i = 0; i < BODIES && rows[i].count; i++) {
                    const uint32_t thing = owner[rows[i].body];
                    assert_true(found[rows[i].body] && (i == 0 || rows[i - 1].fraction <= rows[i].fraction));
                    for (size_t j = 0; j < i && thing != UINT32_MAX; j++)
                        assert_int_not_equal(owner[rows[j].body], thing);
                    const double right = meet_thing(&spans, owner, found, thing, inside);
                    if (thing != UINT32_MAX && !(fabs((double)rows[i].fraction - right) < 3e-5))
                        fail_msg("trial %zu, ray %zu, inside %d: owner %u at %.9g, but %.9g", trial, k, (int)inside,
                                 thing, (double)rows[i].fraction, right);
                    /* The place and the normal are of the part that the row names. */
                    const uint32_t part = rows[i].body;
                    const bool starts = thing == UINT32_MAX
                                            ? spans.starts[part]
                                            : meet_thing(&spans, owner, found, thing, NARC_INSIDE_IGNORES) < 0;
                    const bool leaves = starts && inside == NARC_INSIDE_LEAVES;
                    const double own = leaves ? spans.to[part] : spans.from[part];
                    const double facing = (double)(rows[i].normal_x * ray.motion_x + rows[i].normal_y * ray.motion_y);
                    const double length = hypot((double)rows[i].normal_x, (double)rows[i].normal_y);
                    assert_true(fabs((double)rows[i].fraction - own) < 3e-5);
                    assert_true(leaves ? facing > -1e-6 : facing < 1e-6);
                    assert_true(starts && inside == NARC_INSIDE_STOPS ? length == 0 : fabs(length - 1) < 1e-6);
                }
                for (size_t thing = 0; thing < THINGS; thing++) {
                    const double right = meet_thing(&spans, owner, found, owner[thing], inside);
                    bool has_row = owner[thing] == UINT32_MAX || right < 0 || right > 16;
                    for (size_t i = 0; i < BODIES && rows[i].count; i++)
                        has_row = has_row || owner[rows[i].body] == owner[thing];
                    assert_true(has_row);
                }
                narc_ray_options first = options;
                first.most = 1;
                AUTO(guard_release_at) narc_ray_hit *const row = cast_in_room(&room, &view, &first);
                assert_memory_equal(row, rows, sizeof *row);
            }
        }
    }
}

/* A fan whose rays leave out the body that is hit first, all alike or not, by its number or by masks: each as alone. */
TEST(fans_leave_out_what_a_ray_does) {
    struct test_random random = test_random_named("fans and masks");
    enum { COUNT = 60, RAYS = 48 };
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        AUTO(destroy_room) struct room room = create_room(&random, NARC_FLOAT64, COUNT, 10);
        struct test_ray rays[RAYS];
        uint64_t masks[RAYS];
        uint32_t ignored[RAYS];
        size_t changed = 0;
        for (size_t k = 0; k < RAYS; k++) {
            const double angle = 0.02 * (double)k;
            rays[k] = (struct test_ray){1e6 + 5, 5, 20 * (float)cos(angle), 20 * (float)sin(angle), 1};
        }
        index_room(&room, true, true);
        const narc_rays all = view_rays(rays, RAYS);
        AUTO(guard_release_at) narc_ray_hit *const hits = cast_in_room(&room, &all, NULL);
        for (size_t k = 0; k < RAYS; k++) {
            const size_t like = trial % 2 ? k - k % 8 : 0;
            ignored[k] = hits[like].count ? hits[like].body : UINT32_MAX;
            masks[k] = hits[like].count ? ~room.category[hits[like].body] : UINT64_MAX;
        }
        for (int by_masks = 0; by_masks < 2; by_masks++) {
            narc_ray_options options = {.inside = NARC_INSIDE_IGNORES};
            if (by_masks)
                options.search.mask = (narc_word_column){masks, sizeof *masks};
            else
                options.search.ignored = (narc_index_column){ignored, sizeof *ignored};
            AUTO(guard_release_at) narc_ray_hit *const found = cast_in_room(&room, &all, &options);
            for (size_t k = 0; k < RAYS; k++) {
                const narc_rays one = view_rays(&rays[k], 1);
                narc_ray_options alone = options;
                alone.search.mask.base = by_masks ? &masks[k] : NULL;
                alone.search.ignored.base = by_masks ? NULL : &ignored[k];
                AUTO(guard_release_at) narc_ray_hit *const row = cast_in_room(&room, &one, &alone);
                row->ray = (uint32_t)k;
                assert_memory_equal(row, &found[k], sizeof *row);
                changed += found[k].count && hits[k].count && found[k].body != hits[k].body;
            }
        }
        assert_true(changed > 0 || trial > 0);
    }
}

/* ------------------------------------------------------------------------------------------------ numbers */

TEST(skips_rays_without_an_answer) {
    struct test_random random = test_random_named("skipped rays");
    enum { COUNT = 50, RAYS = 12 };
    AUTO(destroy_room) struct room room = create_room(&random, NARC_FLOAT64, COUNT, 10);
    for (size_t k = 0; k < RAYS; k++) {
        struct test_ray rays[RAYS];
        size_t skipped = 99;
        for (size_t i = 0; i < RAYS; i++)
            rays[i] = (struct test_ray){room.scene.bodies[0].x - 5, room.scene.bodies[0].y, 10, 0, 1};
        float *const numbers[] = {&rays[k].motion_x, &rays[k].motion_y, &rays[k].motion_x, &rays[k].fraction,
                                  &rays[k].fraction};
        static const float wrong[] = {NAN, INFINITY, 0, NAN, -1e-30f};
        static const double places[] = {NAN, -INFINITY, INFINITY};
        if (k < 5)
            *numbers[k] = wrong[k];
        else if (k < 8)
            *(k == 6 ? &rays[k].y : &rays[k].x) = places[k - 5];
        else
            rays[k].fraction = INFINITY;
        const narc_rays view = view_rays(rays, RAYS);
        AUTO(guard_release_at)
        narc_ray_hit *const hits = cast_in_room(&room, &view, &(narc_ray_options){.out_skipped = &skipped});
        assert_int_equal(skipped, k < 8);
        for (size_t i = 0; i < RAYS; i++) {
            const narc_ray_hit none = {.ray = (uint32_t)i};
            if (i == k && k < 8)
                assert_memory_equal(&hits[i], &none, sizeof none);
            else
                assert_int_equal(hits[i].count, 1);
        }
    }
}

/* Scenes of any size, far from anything, with rays from beyond and of any length. */
TEST(finds_bodies_of_any_size_from_anywhere) {
    struct test_random random = test_random_named("any size");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 1, 1, 1);
        const struct shape disc = circle_of(1);
        const double size = random_log_between(&random, 1e-8, 1e8), away = size * random_log_between(&random, 1, 1e9);
        const double angle = trial % 4 ? random_between(&random, -4, 4) : 1.5707963267948966 * (double)(trial / 4 % 4);
        scene_add_shape(&scene, &disc);
        struct body body = turned_body(0, size);
        body.x = trial % 3 ? 0 : random_log_between(&random, 1e-6, 1e6) * size;
        scene_add_body(&scene, body);
        struct room room = {.scene = scene};
        narc_box box;
        room.boxes = &box;
        assert_int_equal(narc_create_index(NULL, &room.index), NARC_OK);
        index_room(&room, false, false);
        const double length = random_log_between(&random, 1e-30, 1e30);
        struct test_ray ray = {
            .motion_x = (float)(length * cos(angle)), .motion_y = (float)(length * sin(angle)), .fraction = INFINITY};
        const double unit = hypot((double)ray.motion_x, (double)ray.motion_y);
        ray.x = scene.bodies[0].x - away * ((double)ray.motion_x / unit);
        ray.y = -away * ((double)ray.motion_y / unit);
        const narc_rays view = view_rays(&ray, 1);
        AUTO(guard_release_at)
        narc_ray_hit *const hit = cast_in_room(&room, &view, &(narc_ray_options){.inside = NARC_INSIDE_LEAVES});
        if (away > 1.001 * size && away / unit < 1e38) {
            assert_int_equal(hit->count, 1);
            assert_true(fabs((double)hit->fraction * unit - (away - size)) <= 1e-6 * away);
            assert_true(fabs(hypot((double)hit->point_x, (double)hit->point_y) - size) <= 1e-6 * size);
        }
        narc_destroy_index(room.index);
    }
}

/* Nothing to meet. */
TEST(meets_nobody) {
    const struct test_ray ray = {0, 0, 1, 0, 1};
    const narc_rays view = view_rays(&ray, 1);
    AUTO(narc_destroy_shapes_at) narc_shapes *const store = empty_store();
    narc_ray_hit hit;
    AUTO(narc_destroy_index_at) narc_index *index = NULL;
    narc_error error;
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    expect_ok(narc_build_index(index, NULL, 0, NULL, &error), &error);
    expect_ok(narc_cast_rays(index, store, &(narc_bodies){0}, &view, NULL, &hit, 1, &error), &error);
    assert_true(hit.ray == 0 && hit.count == 0);
}

TEST_MAIN("ray_scenes")
