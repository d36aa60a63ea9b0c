/* SPDX-License-Identifier: MIT
 *
 * ray_scenes.c - rays through an index against each body asked by itself, to the last bit: all options, masks, ignored
 * bodies, any tree, workers, order and layout; moved scenes.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "layouts.h"
#include "narc_broad_phase.h"
#include "ray_room.h"

/* ------------------------------------------------------------------------------------------------ brute force */

/* Row k * bodies + b: ray k against body b by itself, in an index of its own, and no other ray in the call. */
static narc_ray_hit *cast_one_by_one(const struct room *room, const struct test_ray *rays, size_t count,
                                     narc_inside inside) {
    const size_t bodies = room->scene.body_count;
    narc_ray_hit *const all = calloc(count * bodies + 1, sizeof *all);
    narc_index *index;
    narc_error error;
    assert_non_null(all);
    assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
    const narc_ray_options options = {.inside = inside};
    for (size_t b = 0; b < bodies; b++) {
        struct scene alone = room->scene;
        alone.bodies += b;
        alone.body_count = 1;
        const narc_bodies body = scene_bodies(&alone);
        expect_ok(narc_build_index(index, &room->boxes[b], 1, NULL, &error), &error);
        for (size_t k = 0; k < count; k++) {
            const narc_rays ray = view_rays(rays + k, 1);
            narc_ray_hit *const hit = &all[k * bodies + b];
            expect_ok(narc_cast_rays(index, room->scene.store, &body, &ray, &options, hit, 1, &error), &error);
            hit->ray = (uint32_t)k;
            hit->body = hit->count ? (uint32_t)b : 0;
        }
    }
    narc_destroy_index(index);
    return all;
}

static int compare_hits(const void *left, const void *right) {
    const narc_ray_hit *const a = left, *const b = right;
    if (a->fraction < b->fraction || a->fraction > b->fraction)
        return a->fraction < b->fraction ? -1 : 1;
    return (a->body > b->body) - (a->body < b->body);
}

/* Compares rows with those of each body by itself, sorted. */
static void compare_rows(const struct room *room, const narc_ray_hit *all, const narc_rays *rays,
                         const narc_ray_options *options, bool masks, const narc_ray_hit *found) {
    const size_t bodies = room->scene.body_count, most = options->most ? options->most : 1;
    narc_ray_hit *const list = calloc(bodies + most, sizeof *list);
    const narc_index_query *const search = &options->search;
    for (size_t k = 0; k < rays->count; k++) {
        const uint64_t mask = search->mask.base ? search->mask.base[k] : UINT64_MAX;
        size_t count = 0;
        for (size_t b = 0; b < bodies; b++) {
            const narc_ray_hit *const hit = &all[k * bodies + b];
            const bool wanted = mask & (masks ? room->category[b] : UINT64_MAX);
            if (hit->count && wanted && !(search->ignored.base && search->ignored.base[k] == b))
                list[count++] = *hit;
        }
        qsort(list, count, sizeof *list, compare_hits);
        for (size_t i = 0; i < most; i++) {
            const narc_ray_hit none = {.ray = (uint32_t)k}, *const row = &found[k * most + i];
            if (options->any && i == 0 && count > 0) {
                const narc_ray_hit *const same = &all[k * bodies + row->body];
                assert_true(row->count == 1 && row->body < bodies);
                assert_memory_equal(row, same, sizeof *row);
            } else {
                assert_memory_equal(row, i < count && !options->any ? &list[i] : &none, sizeof *row);
            }
        }
    }
    free(list);
}

TEST(finds_what_asking_every_body_finds) {
    struct test_random random = test_random_named("rays and scenes");
    static const size_t counts[] = {1, 2, 7, 8, 9, 63, 65, 130, 513};
    static const size_t mosts[] = {0, 1, 2, 5, 40};
    for (size_t trial = 0; trial < test_trials(sizeof counts / sizeof *counts); trial++) {
        const size_t count = counts[trial % (sizeof counts / sizeof *counts)], rays = count < 100 ? 300 : 100;
        const double side = sqrt((double)count) * random_between(&random, 0.5, 4);
        struct room room = create_room(&random, (narc_precision)(trial % 2), count, side);
        struct test_ray *const ray = make_rays(&random, &room, rays, side);
        for (size_t k = 0; k < rays && trial % 2 == NARC_FLOAT64; k += 5) { /* from where doubles are coarse */
            const double x = (double)ray[k].motion_x, y = (double)ray[k].motion_y, length = hypot(x, y);
            if (!(length > 0))
                continue;
            ray[k].x -= 0x1p44 * (x / length);
            ray[k].y -= 0x1p44 * (y / length);
            ray[k].fraction = INFINITY;
        }
        const narc_rays view = view_rays(ray, rays);
        uint64_t *const mask = calloc(rays, sizeof *mask);
        uint32_t *const ignored = calloc(rays, sizeof *ignored);
        for (size_t k = 0; k < rays; k++) {
            const uint64_t bits = random_bits(&random); /* a quarter of the bits is set */
            mask[k] = k % 7 ? bits & random_bits(&random) : 0;
            ignored[k] = k % 5 ? (uint32_t)random_below(&random, count) : UINT32_MAX;
        }
        for (narc_inside inside = NARC_INSIDE_STOPS; inside <= NARC_INSIDE_IGNORES; inside++) {
            narc_ray_hit *const all = cast_one_by_one(&room, ray, rays, inside);
            for (size_t k = 0; k < 15; k++) {
                const bool masks = k % 3 == 1, fast = k % 2;
                const narc_workers workers = narc_openmp_workers((unsigned)k % 4);
                narc_ray_options options = {.inside = inside, .most = mosts[k % 5], .any = k > 9};
                options.search.workers = &workers;
                if (k % 3)
                    options.search.mask = (narc_word_column){mask, sizeof *mask};
                if (k % 4 > 1)
                    options.search.ignored = (narc_index_column){ignored, sizeof *ignored};
                index_room(&room, fast, masks);
                narc_ray_hit *const found = cast_in_room(&room, &view, &options);
                compare_rows(&room, all, &view, &options, masks, found);
                guard_release(found);
            }
            free(all);
        }
        free(mask);
        free(ignored);
        free(ray);
        destroy_room(&room);
    }
}

/* Rays so long that fractions underflow: bodies at different places are hit at the same one, and the lower number counts,
 * in any tree. */
TEST(longest_rays_go_by_number) {
    enum { BODIES = 65, RAYS = 100 };
    struct test_random random = test_random_named("longest rays");
    size_t same = 0;
    for (size_t trial = 0; trial < test_trials(4); trial++) {
        struct room room = create_room(&random, (narc_precision)(trial % 2), BODIES, 9);
        struct test_ray ray[RAYS] = {{.fraction = 1}};
        for (size_t b = 0; b < BODIES; b++) {
            struct body *const body = &room.scene.bodies[b];
            body->x = 0x1p-23 * random_between(&random, 0, 9);
            body->y *= 0x1p-23;
            body->scale *= 0x1p-23f;
            round_position(body, room.scene.precision);
        }
        for (size_t k = 0; k < RAYS; k++) {
            const double angle = random_between(&random, -4, 4), length = random_log_between(&random, 1e36, 3.4e38);
            ray[k] = (struct test_ray){(float)(0x1p-23 * random_between(&random, -9, 18)),
                                       (float)(0x1p-23 * random_between(&random, -9, 18)), (float)(length * cos(angle)),
                                       (float)(length * sin(angle)), 1};
        }
        const narc_rays view = view_rays(ray, RAYS);
        index_room(&room, false, false);
        narc_ray_hit *const all = cast_one_by_one(&room, ray, RAYS, NARC_INSIDE_STOPS);
        for (size_t k = 1; k < RAYS * BODIES; k++)
            same += all[k].count && all[k - 1].count && all[k].fraction > 0 && all[k].fraction == all[k - 1].fraction;
        for (size_t k = 0; k < 4; k++) {
            const narc_ray_options options = {.most = k < 2 ? 1 : 5};
            index_room(&room, k % 2, false);
            narc_ray_hit *const found = cast_in_room(&room, &view, &options);
            compare_rows(&room, all, &view, &options, false, found);
            guard_release(found);
        }
        free(all);
        destroy_room(&room);
    }
    assert_true(same > 0);
}

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
        narc_ray_hit *const hits = cast_in_room(&alone, &view, NULL);
        spans.meets[b] = hits[0].count && hits[1].count;
        spans.starts[b] = spans.meets[b] && hits[0].normal_x == 0 && hits[0].normal_y == 0;
        spans.from[b] = (double)hits[0].fraction;
        spans.to[b] = 64 - (double)hits[1].fraction;
        guard_release(hits);
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
        struct room room = create_things(&random, owner);
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
                narc_ray_hit *const rows = cast_in_room(&room, &view, &options);
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
                narc_ray_hit *const row = cast_in_room(&room, &view, &first);
                assert_memory_equal(row, rows, sizeof *row);
                guard_release(row);
                guard_release(rows);
            }
        }
        destroy_room(&room);
    }
}

/* ------------------------------------------------------------------------------------------------ bits */

/* Scalar in one call decides: instruction sets, workers, the order of rays, one by one, fitted trees. */
TEST(same_bits_however_asked) {
    struct test_random random = test_random_named("bits of rays");
    enum { COUNT = 700, RAYS = 1500, MOST = 3 };
    for (int precision = 0; precision < 2; precision++) {
        struct room room = create_room(&random, (narc_precision)precision, COUNT, 40);
        struct test_ray *const rays = make_rays(&random, &room, RAYS, 40), *const mixed = calloc(RAYS, sizeof *mixed);
        const narc_rays view = view_rays(rays, RAYS);
        uint32_t owner[COUNT];
        for (size_t k = 0; k < COUNT; k++)
            owner[k] = (uint32_t)k / 4;
        const narc_owners owners = {.owner = NARC_ARRAY(owner)};
        narc_ray_options options = {.most = MOST, .inside = (narc_inside)precision};
        options.search.owners = precision ? &owners : NULL;
        test_use_isa("scalar");
        narc_ray_hit *const right = cast_in_room(&room, &view, &options);
        test_use_isa(test_isa());
        for (unsigned threads = 1; threads < 6; threads++) {
            const narc_workers workers = narc_openmp_workers(threads);
            options.search.workers = &workers;
            narc_ray_hit *const found = cast_in_room(&room, &view, &options);
            assert_memory_equal(found, right, RAYS * MOST * sizeof *right);
            guard_release(found);
        }
        options.search.workers = NULL;
        size_t order[RAYS];
        for (size_t k = 0; k < RAYS; k++)
            order[k] = k;
        for (size_t k = RAYS - 1; k > 0; k--) {
            const size_t other = random_below(&random, k + 1), moved = order[k];
            order[k] = order[other];
            order[other] = moved;
        }
        for (size_t k = 0; k < RAYS; k++)
            mixed[k] = rays[order[k]];
        for (size_t size = 1; size < RAYS; size = size < 10 ? size + 1 : 3 * size)
            for (size_t first = 0; first < RAYS; first += size) {
                const size_t count = RAYS - first < size ? RAYS - first : size;
                const narc_rays part = view_rays(mixed + first, count);
                narc_ray_hit *const found = cast_in_room(&room, &part, &options);
                for (size_t k = 0; k < count; k++) {
                    for (size_t i = 0; i < MOST; i++)
                        found[k * MOST + i].ray = (uint32_t)order[first + k];
                    assert_memory_equal(&found[k * MOST], &right[order[first + k] * MOST], MOST * sizeof *right);
                }
                guard_release(found);
            }
        narc_box *const moved = calloc(COUNT, sizeof *moved);
        for (size_t k = 0; k < COUNT; k++)
            moved[k] = room.boxes[COUNT - 1 - k];
        narc_error error;
        expect_ok(narc_build_index(room.index, moved, COUNT, NULL, &error), &error);
        expect_ok(narc_refit_index(room.index, room.boxes, COUNT, NULL, NULL, &error), &error); /* a poor tree */
        narc_ray_hit *const found = cast_in_room(&room, &view, &options);
        assert_memory_equal(found, right, RAYS * MOST * sizeof *right);
        guard_release(found);
        free(moved);
        guard_release(right);
        free(rays);
        free(mixed);
        destroy_room(&room);
    }
}

/* Bodies in all layouts, rays in columns backwards, in rows and shared, each with a guard page behind it. */
TEST(reads_nothing_but_what_it_is_given) {
    struct test_random random = test_random_named("layouts of rays");
    enum { COUNT = 100, RAYS = 67 };
    for (int precision = 0; precision < 2; precision++)
        for (enum layout layout = 0; layout < LAYOUT_COUNT; layout++) {
            struct scene scene = make_random_scene(&random, (narc_precision)precision, COUNT, 1);
            suit_layout(&scene, layout);
            struct columns columns = create_columns(&scene, layout, 0, 0);
            narc_shapes *const store = guard_store(&scene);
            struct room room = {.scene = scene};
            narc_box boxes[COUNT];
            room.boxes = boxes;
            assert_int_equal(narc_create_index(&guard_allocator, &room.index), NARC_OK);
            index_room(&room, false, false);
            struct test_ray *const rays = make_rays(&random, &room, RAYS, 10);
            for (size_t count = 0; count <= RAYS; count++) {
                const narc_rays view = view_rays(rays, count);
                narc_ray_hit *const right = cast_in_room(&room, &view, NULL), *const found =
                                                                                  guard_allocate(count * sizeof *found);
                float *const numbers = guard_allocate(3 * count * sizeof *numbers);
                double *const places = guard_allocate(2 * count * sizeof *places);
                for (size_t k = 0; k < count; k++) { /* backwards */
                    places[count - 1 - k] = rays[k].x;
                    places[2 * count - 1 - k] = rays[k].y;
                    numbers[count - 1 - k] = rays[k].motion_x;
                    numbers[2 * count - 1 - k] = rays[k].motion_y;
                    numbers[3 * count - 1 - k] = rays[k].fraction;
                }
                const ptrdiff_t last = (ptrdiff_t)count - 1, back = -(ptrdiff_t)sizeof(float);
                const narc_rays other = {
                    .count = count,
                    .x = {places + last, 2 * back, NARC_FLOAT64},
                    .y = {places + last + (ptrdiff_t)count, 2 * back, NARC_FLOAT64},
                    .motion_x = {numbers + last, back},
                    .motion_y = {numbers + last + (ptrdiff_t)count, back},
                    .fraction = {numbers + last + 2 * (ptrdiff_t)count, back},
                };
                narc_error error;
                expect_ok(narc_cast_rays(room.index, store, &columns.bodies, &other, NULL, found, count, &error),
                          &error);
                assert_memory_equal(found, right, count * sizeof *found);
                guard_release(right);
                guard_release(found);
                guard_release(numbers);
                guard_release(places);
            }
            free(rays);
            narc_destroy_index(room.index);
            narc_destroy_shapes(store);
            destroy_columns(&columns);
            destroy_scene(&scene);
        }
}

/* ------------------------------------------------------------------------------------------------ other frames */

/* A scene moved by what doubles add exactly gives the same bits. */
TEST(answers_the_same_elsewhere) {
    struct test_random random = test_random_named("moved rays");
    enum { COUNT = 400, RAYS = 1000 };
    struct room room = create_room(&random, NARC_FLOAT64, COUNT, 60);
    struct test_ray *const rays = make_rays(&random, &room, RAYS, 60);
    narc_rays view = view_rays(rays, RAYS);
    for (size_t k = 0; k < COUNT; k++) {
        room.scene.bodies[k].x = round(room.scene.bodies[k].x * 0x1p20) * 0x1p-20;
        room.scene.bodies[k].y = round(room.scene.bodies[k].y * 0x1p20) * 0x1p-20;
    }
    for (size_t k = 0; k < RAYS; k++) {
        rays[k].x = round(rays[k].x * 0x1p20) * 0x1p-20;
        rays[k].y = round(rays[k].y * 0x1p20) * 0x1p-20;
    }
    index_room(&room, false, false);
    narc_ray_hit *const right = cast_in_room(&room, &view, NULL);
    for (size_t k = 0; k < COUNT; k++) {
        room.scene.bodies[k].x += 0x1p20;
        room.scene.bodies[k].y -= 0x1p24;
    }
    for (size_t k = 0; k < RAYS; k++) {
        rays[k].x += 0x1p20;
        rays[k].y -= 0x1p24;
    }
    index_room(&room, false, false);
    narc_ray_hit *const moved = cast_in_room(&room, &view, NULL);
    assert_memory_equal(moved, right, RAYS * sizeof *moved);
    guard_release(right);
    guard_release(moved);
    free(rays);
    destroy_room(&room);
}

TEST_MAIN("ray_scenes")
