/* SPDX-License-Identifier: MIT
 *
 * everything.c - all that a scene can be asked, asked in two ways: on this instruction set and in scalar, with workers and
 * without, as bodies move; from every layout, behind guard pages; one by one; elsewhere; beside bodies that
 * are far away; and of any bits.
 */
#include "everything.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "corpus.h"
#include "guard.h"
#include "layouts.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"

static void run_backwards(void *context, unsigned count, void (*task)(void *argument, unsigned index), void *argument) {
    (void)context;
    while (count-- > 0)
        task(argument, count);
}

/* Scalar in one call decides. Returns its answers. */
static struct answers check_bits(const struct everything *e, const char *how) {
    static const narc_workers backwards = {NULL, 3, run_backwards};
    const narc_workers openmp = openmp_workers(4);
    test_use_isa("scalar");
    struct answers right = ask_everything(e, NULL);
    test_use_isa(test_isa());
    for (int way = 0; way < 2; way++) {
        AUTO(destroy_answers) struct answers found = ask_everything(e, way ? &openmp : &backwards);
        expect_same_answers(&right, &found, 0, how);
    }
    return right;
}

/* ------------------------------------------------------------------------------------------------ bits */

/* The world goes on: bodies move a little, small steps and large ones. */
static void check_moves(struct test_random *random, struct world *world, size_t indexed, const char *name) {
    enum { MOVES = 3 };
    for (int move = 0; move < MOVES; move++) {
        struct everything e = view_world(world);
        e.indexed = e.movers = indexed;
        struct answers right = check_bits(&e, name);
        destroy_answers(&right);
        scene_move_bodies(&world->scene, random, random_log_between(random, 1e-7, 0.1));
    }
}

TEST(same_bits_of_everything_there_is) {
    enum { INDEXED = 64, RAYS = 512 };
    for (int precision = 0; precision < 2; precision++) {
        const char *const name = precision ? "corpus, double positions" : "corpus";
        struct test_random random = test_random_named(name);
        struct corpus corpus = make_corpus(name, (narc_precision)precision, 0.5, false);
        const size_t indexed = corpus.scene.body_count < INDEXED ? corpus.scene.body_count : INDEXED;
        AUTO(destroy_world) struct world world = make_world(&random, corpus.scene, indexed, RAYS);
        check_moves(&random, &world, indexed, name);
        free(corpus.pairs);
    }
}

TEST(same_bits_of_a_crowd) {
    enum { BODIES = 300, PAIRS = 1000, RAYS = 1000 };
    struct test_random random = test_random_named("crowd");
    for (size_t round = 0; round < test_trials(4); round++) {
        struct scene scene = make_random_scene(&random, (narc_precision)(round % 2), BODIES, PAIRS);
        for (size_t k = 0; k < BODIES; k++) {
            scene.bodies[k].x *= 9;
            scene.bodies[k].y *= 9;
            round_position(&scene.bodies[k], scene.precision);
        }
        AUTO(destroy_world) struct world world = make_world(&random, scene, BODIES, RAYS);
        check_moves(&random, &world, BODIES, "crowd");
    }
}

/* What is told of a pair, a ray, a point depends on it alone. */
TEST(each_by_itself) {
    enum { COUNT = 60 };
    struct test_random random = test_random_named("each by itself");
    for (size_t round = 0; round < test_trials(4); round++) {
        AUTO(destroy_world)
        struct world world =
            make_world(&random, make_random_scene(&random, (narc_precision)(round % 2), COUNT, COUNT), COUNT, COUNT);
        struct everything e = view_world(&world);
        e.movers = 0;
        AUTO(destroy_answers) struct answers all = ask_everything(&e, NULL);
        for (size_t k = 0; k < COUNT; k++) {
            struct everything one = e;
            one.pairs.count = one.points.count = one.rays.count = 1;
            one.pairs.a = NARC_COLUMN(world.scene.pairs + k, a);
            one.pairs.b = NARC_COLUMN(world.scene.pairs + k, b);
            one.rays = view_rays(world.rays + k, 1);
            one.points.x = view_rays(world.points + k, 1).x;
            one.points.y = view_rays(world.points + k, 1).y;
            if (world.shifted) {
                one.pairs.shift_x.base = one.pairs.shift_y.base = world.shift + k;
                one.query.margins.base = world.margins + k;
            }
            AUTO(destroy_answers) struct answers alone = ask_everything(&one, NULL);
            expect_same_row(&all, k, &alone);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ layouts */

/* Numbers of a column in guarded memory of their own, from the last to the first or in their order. */
static const void *copy_column(struct columns *columns, const void *base, ptrdiff_t *stride, size_t count, size_t size,
                               bool backwards) {
    char *const copy = guard_allocate(count * size);
    columns->memory[columns->memory_count++] = copy;
    for (size_t k = 0; k < count; k++)
        memcpy(copy + (backwards ? count - 1 - k : k) * size, (const char *)base + (ptrdiff_t)k * *stride, size);
    *stride = backwards ? -(ptrdiff_t)size : (ptrdiff_t)size;
    return backwards && count > 0 ? copy + (count - 1) * size : copy;
}

#define COPY(columns, column, count, type, backwards)                                                                  \
    ((column).base = copy_column(columns, (column).base, &(column).stride, count, sizeof(type), backwards))

/* The same answers from every layout, with a guard page behind all that is read or written. */
TEST(reads_nothing_but_what_it_is_given) {
    struct test_random random = test_random_named("layouts");
    for (int precision = 0; precision < 2; precision++)
        for (enum layout layout = 0; layout < LAYOUT_COUNT; layout++)
            for (size_t count = 1; count <= 44; count += count < 10 ? 1 : 7) {
                struct scene scene = make_random_scene(&random, (narc_precision)precision, count, count);
                suit_layout(&scene, layout);
                AUTO(destroy_world) struct world world = make_world(&random, scene, count, count);
                struct everything e = view_world(&world);
                AUTO(destroy_answers) struct answers right = ask_everything(&e, NULL);
                AUTO(destroy_columns) struct columns columns = create_columns(&scene, layout, 0, count);
                const bool backwards = layout == LAYOUT_BACKWARDS;
                AUTO(narc_destroy_shapes_at) narc_shapes *const store = guard_store(&scene);
                e.shapes = store;
                e.bodies = columns.bodies;
                e.pairs = columns.pairs;
                COPY(&columns, e.rays.x, count, double, backwards);
                COPY(&columns, e.rays.y, count, double, backwards);
                COPY(&columns, e.rays.motion_x, count, float, backwards);
                COPY(&columns, e.rays.motion_y, count, float, backwards);
                COPY(&columns, e.rays.fraction, count, float, backwards);
                COPY(&columns, e.points.x, count, double, backwards);
                COPY(&columns, e.points.y, count, double, backwards);
                COPY(&columns, e.motions.x, count, float, backwards);
                COPY(&columns, e.motions.y, count, float, backwards);
                COPY(&columns, e.motions.angle, count, float, backwards);
                if (world.shifted) {
                    e.pairs.shift_x = e.pairs.shift_y = view_world(&world).pairs.shift_x;
                    COPY(&columns, e.pairs.shift_x, count, float, backwards);
                    COPY(&columns, e.pairs.shift_y, count, float, backwards);
                    COPY(&columns, e.query.margins, count, float, backwards);
                }
                AUTO(destroy_answers) struct answers found = ask_everything(&e, NULL);
                expect_same_answers(&right, &found, 0, "another layout");
            }
}

/* ------------------------------------------------------------------------------------------------ elsewhere */

/* Positions that floats and doubles add exactly, moved or taken for doubles: nothing changes but what lies in the world. */
TEST(answers_the_same_elsewhere) {
    enum { COUNT = 300, RAYS = 600 };
    static const struct {
        narc_precision before, after;
        double x, y;
    } moves[] = {{NARC_FLOAT32, NARC_FLOAT32, 1024 + 7 * 0x1p-10, -512},
                 {NARC_FLOAT32, NARC_FLOAT64, 0, 0},
                 {NARC_FLOAT64, NARC_FLOAT64, 0x1p20, -0x1p24},
                 {NARC_FLOAT32, NARC_FLOAT64, 0x1p30, -0x1p30}};
    const double grid = 0x1p-10;
    struct test_random random = test_random_named("elsewhere");
    for (size_t m = 0; m < sizeof moves / sizeof *moves; m++) {
        AUTO(destroy_world)
        struct world world =
            make_world(&random, make_random_scene(&random, moves[m].before, COUNT, COUNT), COUNT, RAYS);
        struct answers answers[2];
        for (int moved = 0; moved < 2; moved++) {
            const double x = moved ? moves[m].x : 0, y = moved ? moves[m].y : 0;
            world.scene.precision = moved ? moves[m].after : moves[m].before;
            for (size_t k = 0; k < COUNT; k++) {
                struct body *const body = &world.scene.bodies[k];
                body->x = round(body->x / grid) * grid + x;
                body->y = round(body->y / grid) * grid + y;
                round_position(body, world.scene.precision);
                world.points[k].x = round(world.points[k].x / grid) * grid + x;
                world.points[k].y = round(world.points[k].y / grid) * grid + y;
            }
            for (size_t k = 0; k < RAYS; k++) {
                world.rays[k].x = round(world.rays[k].x / grid) * grid + x;
                world.rays[k].y = round(world.rays[k].y / grid) * grid + y;
            }
            const struct everything e = view_world(&world);
            answers[moved] = ask_everything(&e, NULL);
        }
        expect_same_answers(&answers[0], &answers[1], 1 << ANSWER_BOXES | 1 << ANSWER_PARTS | 1 << ANSWER_LISTS,
                            "elsewhere");
        destroy_answers(&answers[0]);
        destroy_answers(&answers[1]);
    }
}

/* ------------------------------------------------------------------------------------------------ far bodies */

/* The pairs of near bodies in a list that is kept while the others fly away, come back and fly away again. */
static size_t keep_list(struct scene *scene, const struct body *at_home, size_t near, struct pair *out) {
    enum { STEPS = 3 };
    const narc_bodies bodies = scene_bodies(scene);
    const narc_step moves = {.bodies = &bodies, .margin = 0.125f, .skin = 0.25f};
    const narc_step_result *r = NULL;
    AUTO(narc_destroy_contacts_at) narc_contacts *contacts = NULL;
    size_t count = 0;
    assert_int_equal(narc_create_contacts(NULL, &contacts, NULL), NARC_OK);
    for (int step = 0; step < STEPS; step++) {
        for (size_t k = near; k < scene->body_count; k++)
            scene->bodies[k] = step == 1 ? at_home[k] : fly_away(at_home[k], k - near, scene->precision);
        assert_int_equal(narc_update_contacts(contacts, scene->store, &moves, &r, NULL), NARC_OK);
        assert_int_equal(r->skipped, 0);
    }
    for (size_t k = 0; k < r->count; k++)
        if (r->pairs.b.base[r->order[k]] < near)
            out[count++] = (struct pair){r->pairs.a.base[r->order[k]], r->pairs.b.base[r->order[k]]};
    return count;
}

TEST(far_bodies_take_nothing_from_others) {
    enum { NEAR = 300, FAR = 24, ALL = NEAR + FAR, PAIRS = 400, RAYS = 1200, MOST_KEPT = NEAR * NEAR / 2 };
    static struct pair kept[2][MOST_KEPT];
    struct test_random random = test_random_named("far bodies");
    for (size_t round = 0; round < test_trials(12); round++) {
        struct scene scene = make_random_scene(&random, (narc_precision)(round % 2), ALL, PAIRS);
        for (size_t k = 0; k < ALL; k++) {
            scene.bodies[k].x = random_between(&random, -12, 12);
            scene.bodies[k].y = random_between(&random, -12, 12);
            round_position(&scene.bodies[k], scene.precision);
        }
        for (size_t k = 0; k < PAIRS; k++)
            scene.pairs[k] = (struct pair){scene.pairs[k].a % NEAR, scene.pairs[k].b % NEAR};
        AUTO(destroy_world) struct world world = make_world(&random, scene, NEAR, RAYS);
        struct body at_home[ALL];
        memcpy(at_home, scene.bodies, sizeof at_home);
        for (size_t k = NEAR; k < ALL; k++)
            world.scene.bodies[k] = fly_away(at_home[k], k - NEAR, scene.precision);
        struct everything e = view_world(&world);
        e.movers = e.near = NEAR;
        e.indexed = round % 3 ? NEAR + 1 : ALL;
        struct answers with = ask_everything(&e, NULL);
        e.indexed = e.bodies.count = NEAR;
        struct answers without = ask_everything(&e, NULL);
        expect_same_answers(&without, &with, 1 << ANSWER_BOXES | 1 << ANSWER_PARTS, "beside far bodies");
        destroy_answers(&with);
        destroy_answers(&without);
        const size_t count = keep_list(&world.scene, at_home, NEAR, kept[0]);
        world.scene.body_count = NEAR;
        assert_int_equal(keep_list(&world.scene, at_home, NEAR, kept[1]), count);
        assert_memory_equal(kept[0], kept[1], count * sizeof *kept[0]);
        assert_true(count > 0);
    }
}

/* ------------------------------------------------------------------------------------------------ garbage */

/* Any bits; a number that ends a range; or one that is as it should be. */
static float any_float(struct test_random *random, float usual) {
    static const float special[] = {NAN,   INFINITY, -INFINITY, 0,        -0.0f, 0x1p-149f, -0x1p-149f, 1e-38f,
                                    1e17f, 3e38f,    FLT_MAX,   -FLT_MAX, -1,    1e-12f,    1e12f,      -1e-30f};
    const uint32_t bits = (uint32_t)random_bits(random);
    float number;
    memcpy(&number, &bits, sizeof number);
    const size_t kind = random_below(random, 8);
    return kind == 0 ? number : kind == 1 ? special[random_below(random, 16)] : usual;
}

static double any_double(struct test_random *random, double usual) {
    const double number = (double)any_float(random, 1) * (double)any_float(random, 1);
    return random_below(random, 6) ? usual : number;
}

/* Nothing hangs or crashes, and answers are numbers. */
TEST(survives_garbage) {
    enum { COUNT = 200, PAIRS = 1000, RAYS = 200 };
    struct test_random random = test_random_named("garbage");
    for (size_t round = 0; round < test_trials(16); round++) {
        AUTO(destroy_world)
        struct world world =
            make_world(&random, make_random_scene(&random, (narc_precision)(round % 2), COUNT, PAIRS), COUNT, RAYS);
        narc_box boxes[COUNT];
        for (size_t k = 0; k < COUNT; k++) {
            struct body *const body = &world.scene.bodies[k];
            float *const numbers[] = {&body->x_single, &body->y_single, &body->cosine, &body->sine, &body->scale};
            narc_motion *const motion = &world.motion[k];
            for (size_t i = 0; i < 5; i++)
                *numbers[i] = any_float(&random, *numbers[i]);
            body->x = any_double(&random, body->x);
            body->y = any_double(&random, body->y);
            *motion = (narc_motion){any_float(&random, motion->x), any_float(&random, motion->y),
                                    any_float(&random, motion->angle)};
            boxes[k] = (narc_box){any_float(&random, -1), any_float(&random, -1), any_float(&random, 3),
                                  any_float(&random, 3)};
        }
        for (size_t k = 0; k < RAYS; k++) {
            struct test_ray *const ray = &world.rays[k];
            *ray = (struct test_ray){any_double(&random, ray->x), any_double(&random, ray->y),
                                     any_float(&random, ray->motion_x), any_float(&random, ray->motion_y),
                                     any_float(&random, ray->fraction)};
        }
        for (size_t k = 0; k < PAIRS; k++) {
            world.points[k].x = any_double(&random, world.points[k].x);
            world.shift[k] = any_float(&random, world.shift[k]);
        }
        struct everything e = view_world(&world);
        e.query.margin = INFINITY;
        e.query.margins.base = NULL;
        e.boxes = round % 4 < 2 ? boxes : NULL; /* an index of any boxes at all */
        AUTO(destroy_answers) struct answers right = check_bits(&e, "garbage");
        expect_sane_answers(&e, &right);
    }
}

TEST_MAIN("everything")
