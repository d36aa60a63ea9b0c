/* SPDX-License-Identifier: MIT
 *
 * golden.c - the bits of the answers to fixed scenes, recorded: the same for every instruction set and processor.
 *
 * The scenes come from whole numbers, sums, products and quotients alone, so that no library function can make them
 * differ. Rotations are rational, ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)). The recorded numbers may change only
 * together with a wanted change of the kernels; the program prints what it finds.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "methods.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "scene.h"

/* One number for both precisions: the double positions are the single ones, 2^30 away, and as exact. */
static const uint64_t golden_answers = 0x9467dc252df3f63fu;
static const uint64_t golden_casts[] = {0x2634ea780a76a17au, 0x8b787b23ced4e944u}; /* straight, turning */
static const uint64_t golden_manifolds = 0x1fe97f326534654au, golden_reaches = 0xb20aca8e704ae916u;
/* Boxes: the doubles 2^30 away are rounded outwards to floats. */
static const uint64_t golden_points = 0x57ecde8c73d6312eu;
/* Rays that stop, leave, ignore. */
static const uint64_t golden_rays[] = {0x3d921d721e7f6ffbu, 0x93bc1e29f9ee300fu, 0xebbd7d8a4e9a67f1u};
static const uint64_t golden_boxes[] = {0x82c50e42c4824bc1u, 0xf33d99eef204246fu};
/* Those of the other methods, in their order. */
static const uint64_t golden_methods[] = {0x85810ad0d8fcad45u, 0xde05f3d86d13b145u, 0xb72adc1892a6c4b6u,
                                          0x656376e9cda0e835u, 0x7ec640b6e75a6511u, 0x88b6eccb0495ec6du};
#ifndef NARC_SMALL
/* With margins, flat angles and hints: of all shapes, then of those with edges. */
static const uint64_t golden_options[] = {0x7eb0ec61bfb327c5u, 0xf3466e065087098eu, 0x2f1a7d6b0b10e611u,
                                          0x29e07556c7e1bab8u, 0x51340ea22a195ba6u, 0x89ff86af5a47f142u,
                                          0xa042a9caddcff272u, 0xd450c1a226291e8du};
/* Contacts, merged manifolds, straight and turning casts, rays, points. */
static const uint64_t golden_ground[] = {0x53d4caf0cb0d1c9cu, 0x42dd8c39813594bau, 0xd2f7a23d8eddfd23u,
                                         0xf5781947ff2c20c7u, 0x61fd0c6162d066bdu, 0x297755085bdb519du};
#endif
#ifdef NARC_TEST_POSES
/* Without SLEEF, and of SLEEF 3.5.1. */
static const uint64_t golden_poses[] = {0x04246f5f8f209554u, 0x8b6998bde9bc55d9u};
#endif

/* Angles of the directions (3, 4) / 5, (7, 24) / 25 and (20, 99) / 101. */
#define ANGLE_5   0.92729521800161224
#define ANGLE_25  1.28700221758656973
#define ANGLE_101 1.37145902181257261

/* Four arcs around a direction d = (x, y) of the list above, at angle `a`: flat ones of radius R and tips of radius
 * r. */
#define LENS(a, x, y, R, r)                                                                                            \
    {                                                                                                                  \
        {                                                                                                              \
            {((R) - (r)) * (x), 0, (r), -(a), (a)},                                                                    \
            {0, -((R) - (r)) * (y), (R), (a), PI - (a)},                                                               \
            {-((R) - (r)) * (x), 0, (r), PI - (a), PI + (a)},                                                          \
            {0, ((R) - (r)) * (y), (R), PI + (a), 2 * PI - (a)},                                                       \
        },                                                                                                             \
            4                                                                                                          \
    }

#define TRIANGLE(r)                                                                                                    \
    { {{1.5, -1, (r), -PI / 2, ANGLE_5}, {-1, 0.875, (r), ANGLE_5, PI}, {-1, -1, (r), PI, 1.5 * PI}}, 3 }

#define BOX(x, y, r)                                                                                                   \
    {                                                                                                                  \
        {{(x), (y), (r), 0, PI / 2},                                                                                   \
         {-(x), (y), (r), PI / 2, PI},                                                                                 \
         {-(x), -(y), (r), PI, 1.5 * PI},                                                                              \
         {(x), -(y), (r), 1.5 * PI, 2 * PI}},                                                                          \
            4                                                                                                          \
    }

static const struct shape shapes[] = {
    {{{0, 0, 1, 0, 2 * PI}}, 1},
    {{{0.25, -0.5, 0.375, 0, 2 * PI}}, 1},
    {{{1, 0, 0.25, -PI / 2, PI / 2}, {-1, 0, 0.25, PI / 2, 1.5 * PI}}, 2},
    {{{0, -1, 0, -PI / 2, 0}, {0, 1, 0, 0, PI / 2}, {0, 0, 1, PI / 2, 1.5 * PI}}, 3},
    BOX(0.75, 0.5, 0),
    BOX(0.5, 0.25, 0.125),
    BOX(1, 0.015625, 0),
    TRIANGLE(0),
    TRIANGLE(0.125),
    LENS(ANGLE_5, 0.6, 0.8, 1.5, 0.25),
    LENS(ANGLE_25, 0.28, 0.96, 4.0, 0.0625),
    LENS(ANGLE_101, 20.0 / 101, 99.0 / 101, 6.0, 0),
    LENS(ANGLE_25, 0.28, 0.96, 1.0, 0.9375),
};
enum { SHAPES = sizeof(shapes) / sizeof(shapes[0]), BODIES = 600, PAIRS = 10000 };

static struct scene make_scene(narc_precision precision) {
    /* Not of NARC_TEST_SEED. */
    struct test_random random = {1};
    struct scene scene = create_scene(precision, SHAPES, BODIES, PAIRS);
    for (size_t k = 0; k < SHAPES; k++)
        scene_add_shape(&scene, &shapes[k]);
    for (size_t k = 0; k < BODIES; k++) {
        double t = ((double)random_below(&random, 129) - 64) / 64, square = t * t;
        double cosine = (1 - square) / (1 + square), sine = 2 * t / (1 + square);
        bool lattice = random_below(&random, 4) == 0, turned = random_below(&random, 2);
        cosine = lattice ? 1 : cosine;
        sine = lattice ? 0 : sine;
        /* One random number per statement: within one, each compiler has its own order. */
        struct body body = {.cosine = (float)(turned ? -sine : cosine), .sine = (float)(turned ? cosine : sine)};
        body.scale = 0.25f * (float)(1 + random_below(&random, 8));
        body.shape = (uint32_t)random_below(&random, SHAPES);
        double grid = lattice ? 0.125 : 0x1p-16, far = precision == NARC_FLOAT64 ? 0x1p30 : 0;
        size_t places = lattice ? 25 : 200000;
        body.x = far + (double)random_below(&random, places) * grid;
        body.y = far + (double)random_below(&random, places) * grid;
        scene_add_body(&scene, body);
    }
    for (size_t k = 0; k < PAIRS; k++) {
        uint32_t a = (uint32_t)random_below(&random, BODIES);
        scene_add_pair(&scene, a, (uint32_t)random_below(&random, BODIES));
    }
    return scene;
}

/* One number of each row, as if they stood in an array. */
#define HASH_FIELD(hash, list, field)                                                                                  \
    do {                                                                                                               \
        for (size_t hash_k = 0; hash_k < (list).count; hash_k++)                                                       \
            (hash) = test_hash_items(hash, &(list).rows[hash_k].field, 1, sizeof(list).rows[hash_k].field);            \
    } while (0)

static uint64_t hash_contacts(uint64_t hash, struct contacts list) {
    HASH_FIELD(hash, list, separation);
    HASH_FIELD(hash, list, normal_x);
    HASH_FIELD(hash, list, normal_y);
    HASH_FIELD(hash, list, point_x);
    HASH_FIELD(hash, list, point_y);
    for (int shift = 0; shift <= 8; shift += 8) {
        for (size_t k = 0; k < list.count; k++) {
            const uint8_t arc = list.rows[k].feature >> shift & 0x3f;
            hash = test_hash(hash, &arc, 1);
        }
    }
    return hash;
}

static uint64_t hash_answers(const struct scene *scene) {
    uint64_t *bits = scene_overlaps(scene);
    struct contacts all = scene_contacts(scene, INFINITY), colliding = scene_contacts(scene, 0);
    uint64_t hash = test_hash_items(TEST_HASH_START, bits, NARC_BIT_WORDS(PAIRS), sizeof(uint64_t));
    assert_int_equal(all.count, PAIRS);
    hash = hash_contacts(hash, all);
    HASH_FIELD(hash, colliding, pair);
    printf("  %zu of %d pairs collide\n", colliding.count, (int)PAIRS);
    /* Were all or none to collide, the hash would say little. */
    assert_true(colliding.count > PAIRS / 4 && colliding.count < PAIRS * 3 / 4);
    free(all.rows);
    free(colliding.rows);
    free(bits);
    return hash;
}

static void check_hash(const char *name, uint64_t hash, uint64_t golden) {
    printf("  %s: 0x%016" PRIx64 "\n", name, hash);
    assert_true(hash == golden);
}

static void check_scene(const char *name, narc_precision precision, uint64_t golden) {
    struct scene scene = make_scene(precision);
    check_hash(name, hash_answers(&scene), golden);
    destroy_scene(&scene);
}

TEST(test_single_positions) { check_scene("single positions", NARC_FLOAT32, golden_answers); }

TEST(test_double_positions) { check_scene("double positions", NARC_FLOAT64, golden_answers); }

/* Answers by one of the methods of narc_methods.h; by GJK twice, the second time from the first one's hints. */
static uint64_t hash_method(const struct scene *scene, const narc_bodies *bodies, const narc_pairs *pairs,
                            narc_method method) {
    static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    static uint8_t outcomes[PAIRS];
    static uint32_t hints[PAIRS];
    const bool lists = method <= NARC_METHOD_GJK;
    const narc_method_options options = {.method = method, .out_outcomes = outcomes};
    const narc_query query = {.margin = INFINITY, .hints = NARC_HINT_ARRAY(hints)};
    const narc_methods *methods = scene_methods(scene);
    struct contacts found = {make_junk(PAIRS * sizeof *found.rows), 0};
    uint64_t hash = TEST_HASH_START;
    memset(hints, 0, sizeof hints);
    for (int round = 0; round < 2; round++) {
        assert_int_equal(narc_find_overlaps_by(methods, bodies, pairs, &options, &query, bits, NULL), NARC_OK);
        if (lists)
            assert_int_equal(
                narc_find_contacts_by(methods, bodies, pairs, &options, &query, found.rows, PAIRS, &found.count, NULL),
                NARC_OK);
        assert_true(!lists || found.count == pairs->count);
        hash = test_hash_items(hash, bits, NARC_BIT_WORDS(pairs->count), sizeof(uint64_t));
        hash = test_hash(hash, outcomes, pairs->count);
        hash = test_hash_items(hash, hints, PAIRS, sizeof *hints);
        hash = hash_contacts(hash, found);
    }
    free(found.rows);
    return hash;
}

static bool is_polygon(const struct scene *scene, uint32_t body) {
    return narc_shape_flags(scene->store, scene->bodies[body].shape) & NARC_SHAPE_POLYGON;
}

TEST(test_methods) {
    struct scene scene = make_scene(NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    struct pair *polygons = malloc(PAIRS * sizeof *polygons);
    size_t count = 0;
    assert_non_null(polygons);
    for (size_t k = 0; k < PAIRS; k++)
        if (is_polygon(&scene, scene.pairs[k].a) && is_polygon(&scene, scene.pairs[k].b))
            polygons[count++] = scene.pairs[k];
    assert_true(count > PAIRS / 40);
    const narc_pairs all = scene_pairs(&scene),
                     some = {.count = count, .a = NARC_COLUMN(polygons, a), .b = NARC_COLUMN(polygons, b)};
    bool right = true;
    for (narc_method method = NARC_METHOD_SAT_FIRST; narc_method_name(method); method++) {
        const uint64_t hash = hash_method(&scene, &bodies, method == NARC_METHOD_POLYGON_SAT ? &some : &all, method);
        printf("  %s: 0x%016" PRIx64 "\n", narc_method_name(method), hash);
        right = right && hash == golden_methods[method - NARC_METHOD_SAT_FIRST];
    }
    assert_true(right);
    free(polygons);
    destroy_scene(&scene);
}

static uint64_t hash_manifolds(uint64_t hash, struct manifolds list) {
    HASH_FIELD(hash, list, pair);
    for (size_t k = 0; k < list.count; k++)
        hash = test_hash(hash, &(uint8_t){(uint8_t)list.rows[k].count}, 1);
    HASH_FIELD(hash, list, normal_x);
    HASH_FIELD(hash, list, normal_y);
    HASH_FIELD(hash, list, point[0].separation);
    HASH_FIELD(hash, list, point[1].separation);
    HASH_FIELD(hash, list, point[0].x);
    HASH_FIELD(hash, list, point[1].x);
    HASH_FIELD(hash, list, point[0].y);
    HASH_FIELD(hash, list, point[1].y);
    for (size_t i = 0; i < 2; i++)
        for (size_t k = 0; k < list.count; k++)
            hash = test_hash_items(hash, &(uint16_t){(uint16_t)list.rows[k].point[i].feature}, 1, sizeof(uint16_t));
    HASH_FIELD(hash, list, radius_a);
    HASH_FIELD(hash, list, radius_b);
    return hash;
}

static uint64_t hash_reaches(uint64_t hash, struct manifolds list) {
    for (size_t k = 0; k < list.count; k++) {
        hash = test_hash_items(hash, list.rows[k].reach_a, 2, sizeof(uint16_t));
        hash = test_hash_items(hash, list.rows[k].reach_b, 2, sizeof(uint16_t));
    }
    return hash;
}

TEST(test_manifolds) {
    uint64_t hashes[2], reaches[2] = {TEST_HASH_START, TEST_HASH_START};
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene((narc_precision)precision);
        const float margins[] = {0, INFINITY};
        uint64_t hash = TEST_HASH_START;
        for (size_t m = 0; m < 2; m++) {
            struct manifolds list = scene_manifolds(&scene, margins[m]);
            size_t two = 0;
            hash = hash_manifolds(hash, list);
            reaches[precision] = hash_reaches(reaches[precision], list);
            for (size_t k = 0; k < list.count; k++)
                two += list.rows[k].count == 2;
            printf("  %zu of %zu manifolds have two points\n", two, list.count);
            assert_true(two > list.count / 20);
            free(list.rows);
        }
        hashes[precision] = hash;
        destroy_scene(&scene);
    }
    check_hash("manifolds, single positions", hashes[0], golden_manifolds);
    check_hash("manifolds, double positions", hashes[1], golden_manifolds);
    check_hash("reaches, single positions", reaches[0], golden_reaches);
    check_hash("reaches, double positions", reaches[1], golden_reaches);
}

#ifndef NARC_SMALL /* which has other hints, and no chains */
static void check_hashes(const char *name, const uint64_t *hashes, const uint64_t *golden, size_t count) {
    bool right = true;
    for (size_t k = 0; k < count; k++) {
        printf("  %s: 0x%016" PRIx64 "\n", name, hashes[k]);
        right = right && hashes[k] == golden[k];
    }
    assert_true(right);
}

/* Overlaps, contacts, and manifolds twice, all with the hints of the call before. */
static uint64_t hash_hinted(const narc_shapes *store, const narc_bodies *bodies, const narc_pairs *pairs,
                            const narc_query *options) {
    uint32_t *hints = calloc(pairs->count, sizeof *hints);
    uint64_t hash = TEST_HASH_START;
    narc_query query = *options;
    query.hints = NARC_HINT_ARRAY(hints);
    uint64_t *bits = find_overlaps(store, bodies, pairs, &query);
    hash = test_hash_items(hash, bits, NARC_BIT_WORDS(pairs->count), sizeof *bits);
    hash = test_hash_items(hash, hints, pairs->count, sizeof *hints);
    struct contacts contacts = find_contacts(store, bodies, pairs, &query);
    HASH_FIELD(hash, contacts, pair);
    hash = hash_contacts(hash, contacts);
    HASH_FIELD(hash, contacts, radius_a);
    HASH_FIELD(hash, contacts, radius_b);
    hash = test_hash_items(hash, hints, pairs->count, sizeof *hints);
    for (int round = 0; round < 2; round++) {
        struct manifolds list = find_manifolds(store, bodies, pairs, &query);
        hash = hash_reaches(hash_manifolds(hash, list), list);
        hash = test_hash_items(hash, hints, pairs->count, sizeof *hints);
        free(list.rows);
    }
    free(contacts.rows);
    free(bits);
    free(hints);
    return hash;
}

TEST(test_options) {
    static const narc_query options[] = {{.margin = 0.0625f, .flat_angle = 0.5f, .second_margin = 0.25f},
                                         {.margin = -0.125f, .flat_angle = NARC_MAX_FLAT_ANGLE},
                                         {.margin = INFINITY, .flat_angle = -1},
                                         {.margin = 1, .flat_angle = 0.0625f, .second_margin = 1}};
    enum { COUNT = sizeof options / sizeof *options };
    static const uint32_t flat[] = {2, 4, 5, 7}; /* a capsule, boxes, a triangle */
    struct scene scene = make_scene(NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    uint64_t hashes[2 * COUNT];
    for (size_t k = 0; k < COUNT; k++)
        hashes[k] = hash_hinted(scene.store, &bodies, &pairs, &options[k]);
    for (size_t k = 0; k < BODIES; k++)
        scene.bodies[k].shape = flat[scene.bodies[k].shape % 4];
    for (size_t k = 0; k < COUNT; k++)
        hashes[COUNT + k] = hash_hinted(scene.store, &bodies, &pairs, &options[k]);
    check_hashes("options", hashes, golden_options, 2 * COUNT);
    destroy_scene(&scene);
}
#endif

struct impacts {
    narc_impact *rows;
    size_t count;
};

static uint64_t hash_impacts(struct impacts list) {
    uint64_t hash = TEST_HASH_START;
    HASH_FIELD(hash, list, body);
    HASH_FIELD(hash, list, feature);
    HASH_FIELD(hash, list, count);
    HASH_FIELD(hash, list, fraction);
    HASH_FIELD(hash, list, separation);
    HASH_FIELD(hash, list, normal_x);
    HASH_FIELD(hash, list, normal_y);
    HASH_FIELD(hash, list, point_x);
    HASH_FIELD(hash, list, point_y);
    return hash;
}

TEST(test_casts) {
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene((narc_precision)precision);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_pairs pairs = scene_pairs(&scene);
        float motion[BODIES];
        for (size_t k = 0; k < BODIES; k++)
            motion[k] = ((float)(k % 17) - 8) / 4;
        const narc_float_column column = NARC_ARRAY(motion);
        for (int turning = 0; turning < 2; turning++) {
            const narc_motions motions = {.x = column,
                                          .y = {motion + BODIES - 1, -column.stride},
                                          .angle = {turning ? motion : NULL, column.stride}};
            struct impacts list = {make_junk(PAIRS * sizeof *list.rows), PAIRS};
            assert_int_equal(
                narc_cast_pairs(scene.store, &bodies, &motions, &pairs, NULL, NULL, list.rows, PAIRS, NULL), NARC_OK);
            check_hash(turning ? "turning casts" : "casts", hash_impacts(list), golden_casts[turning]);
            free(list.rows);
        }
        destroy_scene(&scene);
    }
}

TEST(test_boxes) {
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene((narc_precision)precision);
        const narc_bodies bodies = scene_bodies(&scene);
        narc_box boxes[BODIES];
        float motion[BODIES];
        for (size_t k = 0; k < BODIES; k++)
            motion[k] = (float)(k % 17) - 8;
        narc_box_options options = {0};
        uint64_t hash = TEST_HASH_START;
        for (int round = 0; round < 2; round++) {
            assert_int_equal(narc_compute_boxes(scene.store, &bodies, &options, boxes, NULL), NARC_OK);
            hash = test_hash_items(hash, boxes, BODIES * 4, sizeof(float));
            options = (narc_box_options){.margin = 0.125f, .motion_x = NARC_ARRAY(motion), .motion_y = {motion + 5, 0}};
        }
        check_hash("boxes", hash, golden_boxes[precision]);
        destroy_scene(&scene);
    }
}

/* Distances of each body's position to another body, and to the two nearest but itself. */
TEST(test_points) {
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene((narc_precision)precision);
        const narc_bodies bodies = scene_bodies(&scene);
        const narc_points points = {.count = BODIES, .x = bodies.x, .y = bodies.y};
        uint32_t own[BODIES], other[BODIES];
        narc_distance rows[3 * BODIES];
        narc_box boxes[BODIES];
        for (uint32_t k = 0; k < BODIES; k++) {
            own[k] = k;
            other[k] = (7 * k + 3) % BODIES;
        }
        const narc_nearest_options options = {.search.ignored = NARC_ARRAY(own), .most = 2};
        narc_index *const index = index_bodies(scene.store, &bodies, NULL, boxes);
        assert_int_equal(narc_find_distances(scene.store, &bodies, &points, NARC_ARRAY(other), NULL, rows, NULL),
                         NARC_OK);
        assert_int_equal(
            narc_find_nearest(index, scene.store, &bodies, &points, &options, rows + BODIES, 2 * BODIES, NULL),
            NARC_OK);
        uint64_t hash = TEST_HASH_START;
        for (size_t k = 0; k < 3 * BODIES; k++) {
            hash = test_hash_items(hash, &rows[k].point, 2, sizeof rows[k].point);
            hash = test_hash_items(hash, &rows[k].feature, 2, sizeof rows[k].feature);
            hash = test_hash_items(hash, &rows[k].separation, 6, sizeof rows[k].separation);
        }
        check_hash("points", hash, golden_points);
        narc_destroy_index(index);
        destroy_scene(&scene);
    }
}

/* Rays from each body's position through a few of the bodies, up to two hits each. */
TEST(test_rays) {
    enum { MOST = 2, ROWS = BODIES * MOST };
    for (int precision = 0; precision < 2; precision++) {
        struct scene scene = make_scene((narc_precision)precision);
        const narc_bodies bodies = scene_bodies(&scene);
        float motion[BODIES + 2];
        uint64_t category[BODIES], mask[BODIES];
        narc_box boxes[BODIES];
        for (size_t k = 0; k < BODIES + 2; k++)
            motion[k] = ((float)(k % 17) - 8) / 4;
        for (size_t k = 0; k < BODIES; k++) {
            category[k] = UINT64_C(1) << k % 64;
            mask[k] = UINT64_C(1) << (k + 1) % 64;
        }
        const narc_index_options seen = {.category = NARC_ARRAY(category)};
        const narc_rays rays = {.count = BODIES,
                                .x = bodies.x,
                                .y = bodies.y,
                                .motion_x = NARC_ARRAY(motion),
                                .motion_y = {motion + BODIES + 1, -(ptrdiff_t)sizeof *motion}};
        narc_index *const index = index_bodies(scene.store, &bodies, &seen, boxes);
        for (int inside = 0; inside < 3; inside++) {
            struct {
                narc_ray_hit rows[ROWS];
                size_t count;
            } list = {.count = ROWS};
            const narc_ray_options options = {
                .search.mask = NARC_ARRAY(mask), .inside = (narc_inside)inside, .most = MOST};
            uint64_t hash = TEST_HASH_START;
            size_t hits = 0;
            assert_int_equal(narc_cast_rays(index, scene.store, &bodies, &rays, &options, list.rows, ROWS, NULL),
                             NARC_OK);
            HASH_FIELD(hash, list, body);
            HASH_FIELD(hash, list, feature);
            HASH_FIELD(hash, list, count);
            HASH_FIELD(hash, list, fraction);
            HASH_FIELD(hash, list, normal_x);
            HASH_FIELD(hash, list, normal_y);
            HASH_FIELD(hash, list, point_x);
            HASH_FIELD(hash, list, point_y);
            HASH_FIELD(hash, list, radius);
            for (size_t k = 0; k < ROWS; k++)
                hits += list.rows[k].count;
            printf("  %zu hits of %d\n", hits, (int)ROWS);
            assert_true(hits > ROWS / 4 && hits < ROWS);
            check_hash("rays", hash, golden_rays[inside]);
        }
        narc_destroy_index(index);
        destroy_scene(&scene);
    }
}

#ifndef NARC_SMALL
/* Hills and valleys from right to left, of arcs with the normals (3, 4) / 5 and (-3, 4) / 5 at their ends, an edge, a
 * corner, an edge and a valley's bottom. */
static size_t add_ground(narc_shapes *store, narc_chain_entry *out_entries, size_t capacity) {
    enum { HILLS = 5, PARTS = 4 };
    static const double from = ANGLE_5, to = PI - ANGLE_5;
    narc_arc arcs[HILLS * PARTS];
    size_t count;
    for (int k = 0; k < HILLS; k++) {
        const double x = 11 - 4.4 * k;
        narc_arc *const part = &arcs[PARTS * k];
        part[0] = (narc_arc){x, 0, 1, from, to};
        part[1] = (narc_arc){x - 1.2, 1.6, -1, to, from};
        part[2] = (narc_arc){x - 2.8, 1.55, 0, from, to};
        part[3] = (narc_arc){x - 3.8, 0.8, -0.0, to, from};
    }
    const narc_status status = narc_add_chain(store, arcs, HILLS * PARTS, NULL, out_entries, capacity, &count, NULL);
    assert_int_equal(status, NARC_OK);
    return count;
}

/* The bits of overlaps are those of contacts. */
static void check_bits(const narc_shapes *store, const narc_bodies *bodies, const narc_pairs *pairs) {
    uint64_t *bits = find_overlaps(store, bodies, pairs, &(narc_query){0});
    struct contacts contacts = find_contacts(store, bodies, pairs, &(narc_query){0});
    uint64_t *of_contacts = calloc(NARC_BIT_WORDS(pairs->count), sizeof *of_contacts);
    for (size_t k = 0; k < contacts.count; k++)
        of_contacts[contacts.rows[k].pair / 64] |= UINT64_C(1) << contacts.rows[k].pair % 64;
    assert_memory_equal(bits, of_contacts, NARC_BIT_WORDS(pairs->count) * sizeof *bits);
    free(of_contacts);
    free(contacts.rows);
    free(bits);
}

/* Bodies on ground and on a few others: contacts, what is left of them when they are merged, casts, rays and points. */
TEST(test_ground) {
    enum { MOST = 64, GUESTS = 120, OTHERS = 4 };
    struct scene scene = make_scene(NARC_FLOAT32);
    narc_chain_entry entries[MOST];
    const size_t pieces_count = add_ground(scene.store, entries, MOST - OTHERS), count = pieces_count + OTHERS,
                 pair_count = count * GUESTS;
    narc_body ground[MOST], guests[GUESTS];
    uint32_t *a = malloc(pair_count * sizeof *a), *b = malloc(pair_count * sizeof *b), runs[MOST];
    float motion[GUESTS + 1];
    uint64_t hashes[6];
    struct test_random random = {3};
    for (size_t k = 0; k < OTHERS; k++) {
        ground[pieces_count + k] = (narc_body){(float)(4 * k) - 8, 2, 0.6f, 0.8f, 1, (uint32_t)(3 * k)};
        runs[pieces_count + k] = NARC_NO_RUN;
    }
    for (size_t k = 0; k < pieces_count; k++) {
        ground[k] = (narc_body){(float)entries[k].x, (float)entries[k].y, 1, 0, 1, entries[k].shape};
        runs[k] = entries[k].run;
    }
    for (size_t k = 0; k < GUESTS; k++) {
        const struct body *body = &scene.bodies[k];
        guests[k] = (narc_body){0, 0, body->cosine, body->sine, body->scale, body->shape};
        guests[k].x = (float)random_below(&random, 20000) / 1024 - 10;
        guests[k].y = (float)random_below(&random, 3000) / 1024;
        motion[k] = ((float)(k % 17) - 8) / 4;
    }
    motion[GUESTS] = 0.5f;
    for (size_t k = 0; k < pair_count; k++) {
        a[k] = (uint32_t)(k / count);
        b[k] = (uint32_t)(k % count);
    }
    const narc_bodies bodies = narc_view_bodies(guests, GUESTS), pieces = narc_view_bodies(ground, count);
    const narc_pairs pairs = {.count = pair_count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &pieces};
    check_bits(scene.store, &bodies, &pairs);
    hashes[0] = hash_hinted(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.125f, .flat_angle = 0.25f});
    struct manifolds merged = find_manifolds(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.125f});
    printf("  %zu manifolds on ground\n", merged.count);
    assert_true(merged.count > GUESTS / 2);
    merged.count = narc_merge_manifolds(&pairs, NARC_ARRAY(runs), merged.rows, merged.count);
    hashes[1] = hash_reaches(hash_manifolds(TEST_HASH_START, merged), merged);
    free(merged.rows);
    for (int turning = 0; turning < 2; turning++) {
        const narc_motions motions = {.x = NARC_ARRAY(motion),
                                      .y = {motion + GUESTS, -(ptrdiff_t)sizeof *motion},
                                      .angle = {turning ? motion : NULL, sizeof *motion}};
        const narc_cast_options options = {.target = turning ? 0.0625f : 0, .tolerance = turning ? 0x1p-8f : 0};
        struct impacts list = {make_junk(pair_count * sizeof *list.rows), pair_count};
        assert_int_equal(
            narc_cast_pairs(scene.store, &bodies, &motions, &pairs, NULL, &options, list.rows, pair_count, NULL),
            NARC_OK);
        hashes[2 + turning] = hash_impacts(list);
        free(list.rows);
    }
    narc_box boxes[MOST];
    narc_index *const index = index_bodies(scene.store, &pieces, NULL, boxes);
    const narc_rays rays = {.count = GUESTS,
                            .x = bodies.x,
                            .y = bodies.y,
                            .motion_x = NARC_ARRAY(motion),
                            .motion_y = {motion + GUESTS, -(ptrdiff_t)sizeof *motion}};
    narc_ray_hit hits[2 * GUESTS];
    narc_distance nearest[2 * GUESTS];
    hashes[4] = hashes[5] = TEST_HASH_START;
    const narc_points points = {.count = GUESTS, .x = bodies.x, .y = bodies.y};
    assert_int_equal(
        narc_cast_rays(index, scene.store, &pieces, &rays, &(narc_ray_options){.most = 2}, hits, 2 * GUESTS, NULL),
        NARC_OK);
    assert_int_equal(narc_find_nearest(index, scene.store, &pieces, &points, &(narc_nearest_options){.most = 2},
                                       nearest, 2 * GUESTS, NULL),
                     NARC_OK);
    for (size_t k = 0; k < 2 * GUESTS; k++) {
        hashes[4] = test_hash_items(hashes[4], &hits[k].fraction, 1, sizeof hits[k].fraction);
        hashes[4] = test_hash_items(hashes[4], &hits[k].normal_x, 1, sizeof hits[k].normal_x);
        hashes[4] = test_hash_items(hashes[4], &hits[k].radius, 1, sizeof hits[k].radius);
        hashes[5] = test_hash_items(hashes[5], &nearest[k].feature, 2, sizeof nearest[k].feature);
        hashes[5] = test_hash_items(hashes[5], &nearest[k].separation, 6, sizeof nearest[k].separation);
    }
    check_hashes("ground", hashes, golden_ground, 6);
    narc_destroy_index(index);
    free(a);
    free(b);
    destroy_scene(&scene);
}
#endif

#ifdef NARC_TEST_POSES
TEST(test_poses) {
    enum { ANGLES = 100000 };
    static float angles[ANGLES], cosines[ANGLES], sines[ANGLES];
    struct test_random random = {2};
    for (size_t k = 0; k < ANGLES; k++)
        angles[k] = ((float)random_below(&random, 2000001) - 1000000.0f) / (k % 2 ? 4096.0f : 262144.0f);
    assert_int_equal(narc_compute_poses(angles, ANGLES, cosines, sines, NULL), NARC_OK);
    uint64_t hash = test_hash_items(TEST_HASH_START, cosines, ANGLES, sizeof *cosines);
    check_hash("poses", test_hash_items(hash, sines, ANGLES, sizeof *sines), golden_poses[NARC_TEST_POSES]);
}
#endif

TEST_MAIN("golden")
