/* SPDX-License-Identifier: MIT
 *
 * broken.c - which bodies are broken: all calls agree, for bodies at the limits of what they may be and beyond.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "scene.h"

/* ------------------------------------------------------------------------------------------------ what calls say */

/* Which calls take a body for a sound one. All ask of it and of a sound body, its mate, in the same place. */
enum asked {
    VALIDATE,
    CONTACT,
    ONE_CONTACT,
    OVERLAP,
    SEPARATION,
    MANIFOLD,
    CAST_OF_A,
    CAST_OF_B,
    DISTANCE,
    OWNER,
    PART,
    BOX, /* from here on a body needs a box */
    PAIR,
    REGION,
    RAY,
    NEAREST,
    CAST_AT_IT,
    MOVER,
    ASKED
};
static const char *const names[ASKED] = {"validate",  "contacts",  "one contact", "overlaps",  "separations",
                                         "manifolds", "cast of a", "cast of b",   "distances", "owner",
                                         "part",      "boxes",     "pairs",       "regions",   "rays",
                                         "nearest",   "casts at",  "mover"};

enum { MOST = 1500, SHAPES = 6, FAN = 4 };

struct trial {
    narc_shapes *store;
    double radius[SHAPES]; /* of the bounding circles */
    size_t count;
    double reach; /* at least the largest bounding radius; nobody else is as near as four of it */
    double from;  /* where rays start, to the left */
    narc_body tried[MOST], mate[MOST], both[2 * MOST]; /* 2 k, its mate 2 k + 1 */
    bool fine[ASKED][MOST];
};

static struct trial *create_trial(size_t count) {
    struct trial *const t = calloc(1, sizeof *t);
    assert_non_null(t);
    struct shape shapes[SHAPES] = {circle_of(1), box_of(2, 1, 0), box_of(2, 1, 0.25), capsule_of(2, 0.5)};
    assert_int_equal(narc_build_ellipse(1, 0.5, 8, shapes[4].arcs, &shapes[4].count, NULL, NULL), NARC_OK);
    assert_int_equal(narc_build_regular_polygon(5, 1, 0, shapes[5].arcs, &shapes[5].count, NULL), NARC_OK);
    t->store = empty_store();
    t->count = count < MOST ? count : MOST;
    for (int k = 0; k < SHAPES; k++) {
        narc_circle circle;
        store_shape(t->store, shapes[k]);
        narc_compute_bounding_circle(shapes[k].arcs, shapes[k].count, &circle);
        t->radius[k] = circle.radius;
    }
    return t;
}

static void destroy_trial(struct trial *t) {
    narc_destroy_shapes(t->store);
    free(t);
}
RELEASE_AT(destroy_trial)

static void ask_pairs(struct trial *t) {
    static narc_contact contacts[MOST];
    static narc_manifold manifolds[MOST];
    static narc_impact impacts[MOST];
    static float separations[MOST];
    static uint64_t bits[NARC_BIT_WORDS(MOST)];
    static uint32_t odd[MOST], even[MOST];
    const size_t count = t->count;
    narc_bodies both;
    narc_view_bodies(t->both, 2 * count, &both);
    const narc_pairs pairs = {.count = count}, swapped = {.count = count, .a = NARC_ARRAY(odd), .b = NARC_ARRAY(even)};
    const float turn = 0.5f;
    const narc_motions turning = {.angle = {&turn, 0}};
    size_t found, skipped[6] = {0}, broken = 0;
    narc_query query = {.margin = INFINITY, .dense = 1, .out_skipped = &skipped[0]};
    assert_int_equal(narc_find_contacts(t->store, &both, &pairs, &query, contacts, count, &found, NULL), NARC_OK);
    query.out_skipped = &skipped[1];
    assert_int_equal(narc_find_manifolds(t->store, &both, &pairs, &query, manifolds, count, &found, NULL), NARC_OK);
    query.out_skipped = &skipped[2];
    assert_int_equal(narc_find_overlaps(t->store, &both, &pairs, &query, bits, NULL), NARC_OK);
    query.out_skipped = &skipped[5];
    assert_int_equal(narc_find_separations(t->store, &both, &pairs, &query, separations, NULL), NARC_OK);
    narc_cast_options options = {.out_skipped = &skipped[3]};
    assert_int_equal(narc_cast_pairs(t->store, &both, NULL, &pairs, NULL, &options, impacts, count, NULL), NARC_OK);
    for (size_t k = 0; k < count; k++) {
        odd[k] = 2 * (uint32_t)k + 1;
        even[k] = 2 * (uint32_t)k;
        t->fine[CONTACT][k] = contacts[k].count != 0;
        t->fine[MANIFOLD][k] = manifolds[k].count != 0;
        t->fine[OVERLAP][k] = bit_is_set(bits, k);
        t->fine[SEPARATION][k] = separations[k] < INFINITY;
        t->fine[CAST_OF_A][k] = impacts[k].count == NARC_CAST_HIT;
        narc_bodies own;
        narc_view_bodies(t->both + 2 * k, 2, &own);
        assert_int_equal(narc_find_contacts(t->store, &own, &(narc_pairs){.count = 1}, NULL, contacts, 1, &found, NULL),
                         NARC_OK);
        t->fine[ONE_CONTACT][k] = found == 1;
        broken += !t->fine[CONTACT][k];
    }
    options.out_skipped = &skipped[4];
    assert_int_equal(narc_cast_pairs(t->store, &both, &turning, &swapped, NULL, &options, impacts, count, NULL),
                     NARC_OK);
    for (size_t k = 0; k < count; k++)
        t->fine[CAST_OF_B][k] = impacts[k].count == NARC_CAST_HIT;
    for (int k = 0; k < 5; k++)
        assert_int_equal(skipped[k], broken);
}

static void ask_poses(struct trial *t) {
    static narc_distance distances[MOST];
    static narc_body placed[MOST];
    static uint32_t numbers[MOST];
    narc_bodies tried;
    narc_view_bodies(t->tried, t->count, &tried);
    const narc_body plain = {.cosine = 1, .scale = 1};
    const narc_points points = {.count = t->count, .x = tried.x, .y = tried.y};
    narc_bodies plains;
    narc_view_bodies(&plain, t->count, &plains);
    const narc_index_column owner = NARC_ARRAY(numbers);
    plains.x.stride = plains.y.stride = plains.cosine.stride = plains.sine.stride = plains.scale.stride = 0;
    plains.shape.stride = 0;
    for (size_t k = 0; k < t->count; k++) {
        narc_bodies own;
        narc_view_bodies(&t->tried[k], 1, &own);
        t->fine[VALIDATE][k] = narc_validate_bodies(t->store, &own, NULL) == NARC_OK;
        numbers[k] = (uint32_t)k;
    }
    assert_int_equal(narc_find_distances(t->store, &tried, &points, NULL, NULL, distances, NULL), NARC_OK);
    assert_int_equal(narc_place_parts(&tried, &plains, &owner, NULL, placed, NULL), NARC_OK);
    for (size_t k = 0; k < t->count; k++) {
        const narc_body *const own = &t->tried[k];
        t->fine[DISTANCE][k] = distances[k].count != 0;
        t->fine[OWNER][k] = placed[k].scale > 0;
        if (t->fine[OWNER][k]) /* the part is its owner */
            assert_memory_equal(&placed[k].cosine, &own->cosine, 3 * sizeof own->cosine);
    }
    assert_int_equal(narc_place_parts(&plains, &tried, &owner, NULL, placed, NULL), NARC_OK);
    for (size_t k = 0; k < t->count; k++)
        t->fine[PART][k] = placed[k].scale > 0;
}

/* What is found by boxes. */
static void ask_scene(struct trial *t) {
    static narc_box boxes[MOST], mate_boxes[MOST];
    static struct {
        double x, y;
        float motion_x, motion_y;
    } rays[FAN * MOST];
    static narc_ray_hit hits[FAN * MOST];
    static narc_distance nearest[MOST];
    static narc_impact impacts[MOST];
    const size_t count = t->count;
    narc_bodies tried, mates, both;
    narc_view_bodies(t->tried, count, &tried);
    narc_view_bodies(t->mate, count, &mates);
    narc_view_bodies(t->both, 2 * count, &both);
    const narc_step step = {.bodies = &both};
    const narc_step_result *r = NULL;
    AUTO(narc_destroy_contacts_at) narc_contacts *contacts = NULL;
    size_t broken = 0, skipped = 0;
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(t->store, &tried, NULL, boxes);
    AUTO(narc_destroy_index_at) narc_index *const mate_index = index_bodies(t->store, &mates, NULL, mate_boxes);
    assert_int_equal(narc_create_contacts(NULL, &contacts, NULL), NARC_OK);
    assert_int_equal(narc_update_contacts(contacts, t->store, &step, &r, NULL), NARC_OK);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t a = r->pairs.a.base[r->order[k]];
        t->fine[PAIR][a / 2] |= a + 1 == r->pairs.b.base[r->order[k]];
    }
    for (size_t k = 0; k < count; k++) {
        t->fine[BOX][k] = boxes[k].min_x <= boxes[k].max_x;
        broken += !t->fine[BOX][k];
        for (int i = 0; i < FAN; i++) {
            rays[FAN * k + (size_t)i].x = t->tried[k].x - t->from;
            rays[FAN * k + (size_t)i].y = t->tried[k].y;
            rays[FAN * k + (size_t)i].motion_x = (float)(6 * t->reach);
            rays[FAN * k + (size_t)i].motion_y = (float)(0.001 * i * t->reach);
        }
    }
    narc_pairs pairs;
    assert_int_equal(narc_query_index(index, mate_boxes, count, NULL, &pairs, NULL), NARC_OK);
    for (size_t k = 0; k < pairs.count; k++)
        t->fine[REGION][pairs.a.base[k]] |= pairs.a.base[k] == pairs.b.base[k];
    const narc_rays view = {.count = FAN * count,
                            .x = NARC_POSITION_COLUMN(rays, x),
                            .y = NARC_POSITION_COLUMN(rays, y),
                            .motion_x = NARC_COLUMN(rays, motion_x),
                            .motion_y = NARC_COLUMN(rays, motion_y)};
    assert_int_equal(narc_cast_rays(index, t->store, &tried, &view, NULL, hits, FAN * count, NULL), NARC_OK);
    const narc_points points = {.count = count, .x = tried.x, .y = tried.y};
    assert_int_equal(
        narc_find_nearest(index, t->store, &tried, &points, &(narc_nearest_options){.inside = 1}, nearest, count, NULL),
        NARC_OK);
    assert_int_equal(narc_cast_shapes(index, t->store, &tried, &mates, NULL, NULL, NULL, impacts, count, NULL),
                     NARC_OK);
    for (size_t k = 0; k < count; k++) {
        t->fine[RAY][k] = hits[FAN * k].count != 0 && hits[FAN * k].body == k;
        for (size_t i = 1; i < FAN; i++)
            assert_int_equal(hits[FAN * k + i].count != 0 && hits[FAN * k + i].body == k, t->fine[RAY][k]);
        t->fine[NEAREST][k] = nearest[k].count != 0 && nearest[k].body == k;
        t->fine[CAST_AT_IT][k] = impacts[k].count == NARC_CAST_HIT && impacts[k].body == k;
    }
    const narc_cast_options options = {.out_skipped = &skipped};
    assert_int_equal(narc_cast_shapes(mate_index, t->store, &mates, &tried, NULL, NULL, &options, impacts, count, NULL),
                     NARC_OK);
    assert_int_equal(skipped, broken);
    for (size_t k = 0; k < count; k++)
        t->fine[MOVER][k] = impacts[k].count == NARC_CAST_HIT && impacts[k].body == k;
}

static void ask_all(struct trial *t) {
    for (size_t k = 0; k < t->count; k++) {
        t->both[2 * k] = t->tried[k];
        t->both[2 * k + 1] = t->mate[k];
    }
    memset(t->fine, 0, sizeof t->fine);
    ask_pairs(t);
    ask_poses(t);
    ask_scene(t);
}

static void expect_answer(const struct trial *t, enum asked asked, size_t k, bool fine) {
    const narc_body *const b = &t->tried[k];
    if (t->fine[asked][k] != fine)
        fail_msg("%s takes a body for %s: x %g, cosine %a, sine %a, scale %a, shape %u", names[asked],
                 fine ? "a broken one" : "a sound one", b->x, (double)b->cosine, (double)b->sine, (double)b->scale,
                 b->shape);
}

/* All calls agree with the first; returns how many bodies are sound. Parts have no size: of their scales alone nothing is
 * said. */
static size_t expect_agreement(const struct trial *t, bool of_parts) {
    size_t sound = 0;
    for (size_t k = 0; k < t->count; k++) {
        for (int asked = 0; asked < ASKED; asked++)
            if (of_parts || (asked != OWNER && asked != PART))
                expect_answer(t, (enum asked)asked, k, t->fine[VALIDATE][k]);
        sound += t->fine[VALIDATE][k];
    }
    return sound;
}

/* ------------------------------------------------------------------------------------------------ limits */

/* The next float, or the one before, so many times. */
static float step_float(float x, int steps) {
    for (; steps != 0; steps += steps < 0 ? 1 : -1)
        x = nextafterf(x, steps < 0 ? -INFINITY : INFINITY);
    return x;
}

static narc_body at_place(const struct trial *t, size_t k) {
    const double side = 16 * t->reach;
    return (narc_body){side * (double)(k % 40), side * (double)(k / 40), 1, 0, 1, (uint32_t)(k % SHAPES)};
}

TEST(rotations_at_the_limit) {
    struct test_random random = test_random_named("rotations at the limit");
    AUTO(destroy_trial_at) struct trial *const t = create_trial(test_trials(1200));
    t->reach = 2.5;
    t->from = 3 * t->reach;
    for (int round = 0; round < 4; round++) {
        for (size_t k = 0; k < t->count; k++) {
            const double error = NARC_ROTATION_TOLERANCE * (random_below(&random, 2) ? 1 : -1);
            const double angle = random_between(&random, -PI, PI), length = sqrt(1 + error);
            narc_body body = at_place(t, k);
            t->mate[k] = body;
            body.cosine = step_float((float)(length * cos(angle)), (int)random_below(&random, 5) - 2);
            body.sine = step_float((float)(length * sin(angle)), (int)random_below(&random, 5) - 2);
            body.scale = (float)random_between(&random, 0.5, 2);
            t->tried[k] = body;
        }
        ask_all(t);
        const size_t sound = expect_agreement(t, true);
        assert_true(t->count < 200 || (sound > t->count / 5 && sound < t->count * 4 / 5));
        for (size_t k = 0; k < t->count; k++) { /* the rule has the rounding of floats, and no more */
            const double c = (double)t->tried[k].cosine, s = (double)t->tried[k].sine, off = fabs(c * c + s * s - 1);
            if (fabs(off - NARC_ROTATION_TOLERANCE) > 0x1p-23)
                expect_answer(t, VALIDATE, k, off < NARC_ROTATION_TOLERANCE);
        }
    }
}

/* One number of a body that is none, or a rotation without a length. */
TEST(numbers_that_are_none) {
    static const float none[] = {NAN, INFINITY, -INFINITY};
    enum { NUMBERS = 5, WAYS = 3 * NUMBERS + 1 };
    AUTO(destroy_trial_at) struct trial *const t = create_trial(4 * WAYS);
    t->reach = 2.5;
    t->from = 3 * t->reach;
    for (size_t k = 0; k < t->count; k++) {
        narc_body body = at_place(t, k);
        const size_t way = k % WAYS;
        t->mate[k] = body;
        if (way == WAYS - 1)
            body.cosine = 0;
        else if (way / 3 < 2)
            *(way / 3 ? &body.y : &body.x) = (double)none[way % 3];
        else
            *(float *[]){&body.cosine, &body.sine, &body.scale}[way / 3 - 2] = none[way % 3];
        t->tried[k] = body;
    }
    ask_all(t);
    assert_int_equal(expect_agreement(t, true), 0);
}

/* The last scale of a shape that is accepted, from one that is towards one that is not. */
static float find_last_scale(const struct trial *t, uint32_t shape, float from, float to) {
    for (;;) {
        const float middle = from + (to - from) / 2;
        const narc_body body = {.cosine = 1, .scale = middle, .shape = shape};
        narc_bodies bodies;
        narc_view_bodies(&body, 1, &bodies);
        if (middle == from || middle == to)
            return from;
        *(narc_validate_bodies(t->store, &bodies, NULL) == NARC_OK ? &from : &to) = middle;
    }
}

/* A shape is stored a little larger than it is: where the limit lies is within 2e-5 of where it should. */
TEST(sizes_at_the_limits) {
    static const double limits[] = {NARC_MIN_SIZE, NARC_MAX_SIZE};
    struct test_random random = test_random_named("sizes at the limits");
    float last[SHAPES];
    AUTO(destroy_trial_at) struct trial *const t = create_trial(test_trials(1200));
    for (int large = 0; large < 2; large++) {
        t->reach = 2 * limits[large];
        t->from = 3 * t->reach;
        for (uint32_t k = 0; k < SHAPES; k++) {
            const double scale = limits[large] / t->radius[k];
            last[k] = find_last_scale(t, k, (float)(scale * (large ? 0.5 : 2)), (float)(scale * (large ? 2 : 0.5)));
        }
        for (size_t k = 0; k < t->count; k++) {
            const double near = random_log_between(&random, 1e-6, 1e-3) * (random_below(&random, 2) ? 1 : -1);
            narc_body body = at_place(t, k);
            body.scale = (float)(limits[large] / t->radius[body.shape] * (1 + near));
            if (k % 3)
                body.scale = step_float(last[body.shape], (int)random_below(&random, 5) - 2);
            body.sine = k % 2 ? -0.6f : 0.6f;
            body.cosine = 0.8f;
            t->tried[k] = t->mate[k] = body;
            t->mate[k].scale *= large ? 0.5f : 2.0f;
            if (k % 16 == 0)
                t->tried[k].scale = (const float[]){0, -body.scale, INFINITY, NAN, 0x1p-149f, FLT_MAX}[k / 16 % 6];
        }
        ask_all(t);
        const size_t sound = expect_agreement(t, false);
        assert_true(t->count < 200 || (sound > t->count / 5 && sound < t->count * 4 / 5));
        for (size_t k = 0; k < t->count; k++) {
            const double size = (double)t->tried[k].scale * t->radius[t->tried[k].shape];
            if (!(fabs(size / limits[large] - 1) <= 2e-5))
                expect_answer(t, VALIDATE, k, limits[0] < size && size < limits[1]);
        }
    }
}

/* Any finite place is one; what is beyond the floats has no box. */
TEST(places_at_the_limits) {
    static const double places[] = {0,    1e17, 1.5e17, 1e18,    1e20,     1e24, 1e30,           3e38,
                                    1e39, 1e60, 1e300,  DBL_MAX, INFINITY, NAN,  (double)FLT_MAX};
    enum { PLACES = sizeof places / sizeof *places };
    AUTO(destroy_trial_at) struct trial *const t = create_trial(4 * (PLACES - 1));
    t->reach = 2;
    for (size_t k = 0; k < t->count; k++) {
        const double place = places[k / 4 + 1] * (k % 2 ? -1 : 1);
        narc_body body = {.cosine = 0.8f, .sine = 0.6f, .scale = 1, .shape = (uint32_t)(k % SHAPES)};
        *(k & 2 ? &body.y : &body.x) = place;
        t->tried[k] = t->mate[k] = body;
    }
    ask_all(t);
    for (size_t k = 0; k < t->count; k++)
        for (int asked = 0; asked < ASKED; asked++) {
            const double place = fabs(t->tried[k].x) + fabs(t->tried[k].y);
            expect_answer(t, (enum asked)asked, k, asked < BOX ? isfinite(place) : place < (double)FLT_MAX);
        }
}

TEST(shapes_that_were_removed) {
    AUTO(destroy_trial_at) struct trial *const t = create_trial(2 * SHAPES * 8);
    t->reach = 2;
    t->from = 3 * t->reach;
    const uint32_t other = store_shape(t->store, circle_of(0.75));
    for (size_t k = 0; k < t->count; k++) {
        t->tried[k] = t->mate[k] = at_place(t, k);
        t->mate[k].shape = other;
    }
    for (uint32_t shape = 0; shape < SHAPES; shape += 2)
        assert_int_equal(narc_remove_shape(t->store, shape, NULL), NARC_OK);
    ask_all(t);
    assert_int_equal(expect_agreement(t, false), t->count / 2);
}

TEST_MAIN("broken")
