/* SPDX-License-Identifier: MIT
 *
 * golden.c - the bits of the answers to fixed scenes, recorded: the same for every instruction set and processor.
 *
 * The recorded numbers may change only together with a wanted change of the kernels; the program prints what it finds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "golden_scene.h"
#include "merge.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"

/* With margins and flat angles: of all shapes, then of those with edges. */
static const uint64_t golden_options[] = {0xa587ca0bb31632beu, 0xc803306e0478649au, 0x6b545d9829a5f6d4u,
                                          0x2f582f2ce8237786u, 0xd42ceb6599b1aaddu, 0xcebd37e43dfc70d8u,
                                          0x6c143cafc48dcc48u, 0xfe17e944adb10d98u};
#ifndef NARC_SMALL
/* Contacts, merged manifolds, straight and turning casts, rays, points. */
static const uint64_t golden_ground[] = {0x471bc187c2798e2au, 0xd0faa4284c90e4cdu, 0x2d08c8c3879e27cau,
                                         0x8529cdd8fb7c58dcu, 0xc87b4cab193be64eu, 0x1d994ca4b002334cu};
/* Beside half-planes: contacts and manifolds, straight and turning casts, boxes, points, rays. */
static const uint64_t golden_planes[] = {0x4a1dc3d782503138u, 0xe60b4645660ab253u, 0x0e101ac6aa97cc64u,
                                         0x04186dcea4816287u, 0x78033af980cb9b5bu, 0xdce13962d86ce8f6u};
/* Hulls, their polylines. */
static const uint64_t golden_outlines[] = {0x063a84d40a282487u, 0x8b695e716cf6b629u};
#endif
#ifdef NARC_TEST_POSES
/* Without SLEEF, and of SLEEF 3.5.1. */
static const uint64_t golden_poses[] = {0x04246f5f8f209554u, 0x8b6998bde9bc55d9u};
#endif

static uint64_t hash_answers(const struct scene *scene, int way) {
    (void)way;
    AUTO(free_at) uint64_t *bits = scene_overlaps(scene);
    AUTO(free_at) struct contacts all = scene_contacts(scene, INFINITY), colliding = scene_contacts(scene, 0);
    uint64_t hash = test_hash_items(TEST_HASH_START, bits, NARC_BIT_WORDS(PAIRS), sizeof(uint64_t));
    assert_int_equal(all.count, PAIRS);
    hash = hash_contacts(hash, all);
    HASH_FIELD(hash, colliding, pair);
    printf("  %zu of %d pairs collide\n", colliding.count, (int)PAIRS);
    /* Were all or none to collide, the hash would say little. */
    assert_true(colliding.count > PAIRS / 4 && colliding.count < PAIRS * 3 / 4);
    return hash;
}

static uint64_t hash_manifold_rows(uint64_t hash, struct manifolds list) {
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

static uint64_t hash_reach_rows(uint64_t hash, struct manifolds list) {
    for (size_t k = 0; k < list.count; k++) {
        hash = test_hash_items(hash, list.rows[k].reach_a, 2, sizeof(uint16_t));
        hash = test_hash_items(hash, list.rows[k].reach_b, 2, sizeof(uint16_t));
    }
    return hash;
}

/* Manifolds, or their reaches. */
static uint64_t hash_manifolds(const struct scene *scene, int reaches) {
    const float margins[] = {0, INFINITY};
    uint64_t hash = TEST_HASH_START;
    for (size_t m = 0; m < 2; m++) {
        AUTO(free_at) struct manifolds list = scene_manifolds(scene, margins[m]);
        size_t two = 0;
        hash = reaches ? hash_reach_rows(hash, list) : hash_manifold_rows(hash, list);
        for (size_t k = 0; k < list.count; k++)
            two += list.rows[k].count == 2;
        assert_true(two > list.count / 20);
    }
    return hash;
}

/* Rays from each body's position at another body, and which points of a lattice around each are within it. */
static uint64_t hash_alone(const struct scene *scene, int inside) {
    enum { GRID = 9, POINTS = BODIES * GRID * GRID };
    static double x[POINTS], y[POINTS];
    static uint32_t at[POINTS];
    static uint64_t bits[NARC_BIT_WORDS(POINTS)];
    const narc_bodies bodies = scene_bodies(scene);
    float motion[BODIES + 2];
    uint32_t other[BODIES];
    struct {
        narc_ray_hit rows[BODIES];
        size_t count;
    } list = {.count = BODIES};
    size_t hits = 0, within = 0;
    for (uint32_t k = 0; k < BODIES + 2; k++)
        motion[k] = ((float)(k % 17) - 8) / 4;
    for (uint32_t k = 0; k < BODIES; k++)
        other[k] = k % 3 ? (7 * k + 3) % BODIES : k;
    for (uint32_t k = 0; k < POINTS; k++) {
        at[k] = k / (GRID * GRID);
        x[k] = scene->bodies[at[k]].x + ((double)(k % GRID) - GRID / 2) / 4;
        y[k] = scene->bodies[at[k]].y + ((double)(k / GRID % GRID) - GRID / 2) / 4;
    }
    const narc_rays rays = {.count = BODIES,
                            .x = bodies.x,
                            .y = bodies.y,
                            .motion_x = NARC_ARRAY(motion),
                            .motion_y = {motion + BODIES + 1, -(ptrdiff_t)sizeof *motion}};
    const narc_points points = {.count = POINTS, .x = NARC_POSITION_ARRAY(x), .y = NARC_POSITION_ARRAY(y)};
    const narc_index_column body = NARC_ARRAY(other), of_points = NARC_ARRAY(at);
    const narc_ray_options options = {.inside = (narc_inside)inside};
    uint64_t hash = TEST_HASH_START;
    assert_int_equal(narc_cast_ray_pairs(scene->store, &bodies, &rays, &body, &options, list.rows, BODIES, NULL),
                     NARC_OK);
    assert_int_equal(narc_find_inside(scene->store, &bodies, &points, &of_points, NULL, bits, NULL), NARC_OK);
    HASH_FIELD(hash, list, body);
    HASH_FIELD(hash, list, feature);
    HASH_FIELD(hash, list, count);
    HASH_FIELD(hash, list, fraction);
    HASH_FIELD(hash, list, normal_x);
    HASH_FIELD(hash, list, point_y);
    HASH_FIELD(hash, list, radius);
    for (size_t k = 0; k < BODIES; k++)
        hits += list.rows[k].count;
    for (size_t k = 0; k < POINTS; k++)
        within += bit_is_set(bits, k);
    printf("  %zu hits of %d, %zu of %d points within\n", hits, (int)BODIES, within, (int)POINTS);
    assert_true(hits > BODIES / 8 && within > POINTS / 8 && within < POINTS / 8 * 7);
    return test_hash_items(hash, bits, NARC_BIT_WORDS(POINTS), sizeof *bits);
}

static uint64_t hash_separations(const struct scene *scene, int way) {
    (void)way;
    static float separations[PAIRS];
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    uint64_t hash = TEST_HASH_START;
    for (int all = 0; all < 2; all++) {
        const narc_query query = {.margin = all ? INFINITY : 0.125f};
        assert_int_equal(narc_find_separations(scene->store, &bodies, &pairs, &query, separations, NULL), NARC_OK);
        hash = test_hash_items(hash, separations, PAIRS, sizeof *separations);
    }
    return hash;
}

/* Overlaps, contacts and manifolds. */
static uint64_t hash_query(const narc_shapes *store, const narc_bodies *bodies, const narc_pairs *pairs,
                           const narc_query *query) {
    AUTO(free_at) uint64_t *bits = find_overlaps(store, bodies, pairs, query);
    uint64_t hash = test_hash_items(TEST_HASH_START, bits, NARC_BIT_WORDS(pairs->count), sizeof *bits);
    AUTO(free_at) struct contacts contacts = find_contacts(store, bodies, pairs, query);
    HASH_FIELD(hash, contacts, pair);
    hash = hash_contacts(hash, contacts);
    HASH_FIELD(hash, contacts, radius_a);
    HASH_FIELD(hash, contacts, radius_b);
    AUTO(free_at) struct manifolds manifolds = find_manifolds(store, bodies, pairs, query);
    hash = hash_reach_rows(hash_manifold_rows(hash, manifolds), manifolds);
    return hash;
}

TEST(test_options) {
    static const narc_query options[] = {{.margin = 0.0625f, .flat_angle = 0.5f, .second_margin = 0.25f},
                                         {.margin = -0.125f, .flat_angle = NARC_MAX_FLAT_ANGLE},
                                         {.margin = INFINITY, .flat_angle = -1},
                                         {.margin = 1, .flat_angle = 0.0625f, .second_margin = 1}};
    enum { COUNT = sizeof options / sizeof *options };
    static const uint32_t flat[] = {2, 4, 5, 7}; /* a capsule, boxes, a triangle */
    AUTO(destroy_scene) struct scene scene = make_golden_scene(NARC_FLOAT32);
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    uint64_t hashes[2 * COUNT];
    for (size_t k = 0; k < COUNT; k++)
        hashes[k] = hash_query(scene.store, &bodies, &pairs, &options[k]);
    for (size_t k = 0; k < BODIES; k++)
        scene.bodies[k].shape = flat[scene.bodies[k].shape % 4];
    for (size_t k = 0; k < COUNT; k++)
        hashes[COUNT + k] = hash_query(scene.store, &bodies, &pairs, &options[k]);
    for (size_t k = 0; k < 2 * COUNT; k++)
        check_hash("options", hashes[k], golden_options[k]);
}

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

/* `way`: 0: straight; 1: turning; 2: turning, and what touches is let go. */
static uint64_t hash_casts(const struct scene *scene, int way) {
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    float motion[BODIES];
    for (size_t k = 0; k < BODIES; k++)
        motion[k] = ((float)(k % 17) - 8) / 4;
    const narc_float_column column = NARC_ARRAY(motion);
    const narc_motions motions = {
        .x = column, .y = {motion + BODIES - 1, -column.stride}, .angle = {way ? motion : NULL, column.stride}};
    const narc_cast_options options = {.parting = way == 2 ? 0x1p-6f : 0};
    AUTO(free_at) struct impacts list = {make_junk(PAIRS * sizeof *list.rows), PAIRS};
    assert_int_equal(narc_cast_pairs(scene->store, &bodies, &motions, &pairs, NULL, &options, list.rows, PAIRS, NULL),
                     NARC_OK);
    return hash_impacts(list);
}

static uint64_t hash_boxes(const struct scene *scene, int way) {
    (void)way;
    const narc_bodies bodies = scene_bodies(scene);
    narc_box boxes[BODIES];
    float motion[BODIES];
    for (size_t k = 0; k < BODIES; k++)
        motion[k] = (float)(k % 17) - 8;
    narc_box_options options = {0};
    uint64_t hash = TEST_HASH_START;
    for (int round = 0; round < 2; round++) {
        assert_int_equal(narc_compute_boxes(scene->store, &bodies, &options, boxes, NULL), NARC_OK);
        hash = test_hash_items(hash, boxes, BODIES * 4, sizeof(float));
        options = (narc_box_options){.margin = 0.125f, .motion_x = NARC_ARRAY(motion), .motion_y = {motion + 5, 0}};
    }
    return hash;
}

/* Distances of each body's position to another body, and to the two nearest but itself. `things`: to the two nearest of things of
 * three bodies. */
static uint64_t hash_points(const struct scene *scene, int things) {
    const narc_bodies bodies = scene_bodies(scene);
    const size_t count = things ? BODIES / 8 : BODIES; /* the way out of a thing is long */
    const narc_points points = {.count = count, .x = bodies.x, .y = bodies.y};
    uint32_t own[BODIES], other[BODIES], owner[BODIES];
    narc_distance rows[3 * BODIES];
    narc_box boxes[BODIES];
    for (uint32_t k = 0; k < BODIES; k++) {
        own[k] = k;
        other[k] = (7 * k + 3) % BODIES;
        owner[k] = k / 3;
    }
    const narc_owners owners = {.owner = NARC_ARRAY(owner)};
    narc_nearest_options options = {.search.ignored = NARC_ARRAY(own), .most = 2};
    if (things)
        options.search = (narc_index_query){.owners = &owners};
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene->store, &bodies, NULL, boxes);
    assert_int_equal(narc_find_distances(scene->store, &bodies, &points, &NARC_ARRAY(other), NULL, rows, NULL),
                     NARC_OK);
    assert_int_equal(narc_find_nearest(index, scene->store, &bodies, &points, &options, rows + count, 2 * count, NULL),
                     NARC_OK);
    uint64_t hash = TEST_HASH_START;
    for (size_t k = 0; k < 3 * count; k++) {
        hash = test_hash_items(hash, &rows[k].point, 2, sizeof rows[k].point);
        hash = test_hash_items(hash, &rows[k].feature, 2, sizeof rows[k].feature);
        hash = test_hash_items(hash, &rows[k].separation, 6, sizeof rows[k].separation);
    }
    return hash;
}

/* Rays from each body's position through a few of the bodies, up to two hits each. */
static uint64_t hash_rays(const struct scene *scene, int inside) {
    enum { MOST = 2, ROWS = BODIES * MOST };
    const narc_bodies bodies = scene_bodies(scene);
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
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene->store, &bodies, &seen, boxes);
    struct {
        narc_ray_hit rows[ROWS];
        size_t count;
    } list = {.count = ROWS};
    const narc_ray_options options = {.search.mask = NARC_ARRAY(mask), .inside = (narc_inside)inside, .most = MOST};
    uint64_t hash = TEST_HASH_START;
    size_t hits = 0;
    assert_int_equal(narc_cast_rays(index, scene->store, &bodies, &rays, &options, list.rows, ROWS, NULL), NARC_OK);
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
    return hash;
}

/* Pairs of boxes in worlds, and what an index finds of each one's world after bodies have changed places. */
static uint64_t hash_worlds(const struct scene *scene, int way) {
    enum { WORLDS = 3 };
    const narc_bodies bodies = scene_bodies(scene);
    narc_box boxes[BODIES];
    uint32_t world[BODIES], changed[BODIES];
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = NULL;
    size_t count = 0;
    (void)way;
    for (size_t k = 0; k < BODIES; k++) {
        world[k] = (uint32_t)(k * k % WORLDS) << 30;
        changed[k] = (uint32_t)k;
    }
    const narc_index_options seen = {.world = NARC_ARRAY(world)};
    const narc_index_query asked = {.world = NARC_ARRAY(world)};
    const narc_pair_filter filter = {.world = NARC_ARRAY(world)};
    const narc_index_column list = NARC_ARRAY(changed);
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene->store, &bodies, &seen, boxes);
    narc_pairs found;
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    narc_find_pairs(broad, boxes, BODIES, &filter, NULL, NULL, NULL, 0, 0, &count, NULL);
    AUTO(free_at) uint32_t *const rows = calloc(2 * count, sizeof *rows);
    assert_int_equal(narc_find_pairs(broad, boxes, BODIES, &filter, NULL, rows, rows + count, 0, count, &count, NULL),
                     NARC_OK);
    printf("  %zu pairs of boxes in worlds\n", count);
    uint64_t hash = test_hash_items(TEST_HASH_START, rows, 2 * count, sizeof *rows);
    for (size_t k = 0; k + 7 < BODIES; k += 7) {
        const narc_box box = boxes[k];
        boxes[k] = boxes[k + 7];
        boxes[k + 7] = box;
    }
    assert_int_equal(narc_update_index(index, boxes, BODIES, &list, BODIES, &seen, NULL), NARC_OK);
    assert_int_equal(narc_query_index(index, boxes, BODIES, &asked, &found, NULL), NARC_OK);
    hash = test_hash_items(hash, found.a.base, found.count, sizeof(uint32_t));
    hash = test_hash_items(hash, found.b.base, found.count, sizeof(uint32_t));
    return hash;
}

/* One number for both precisions: the double positions are the single ones, 2^30 away, and as exact. Boxes of those are
 * rounded outwards to floats. */
TEST(test_scenes) {
    static const struct {
        const char *name;
        uint64_t (*hash)(const struct scene *scene, int way);
        int way;
        uint64_t golden[2];
    } rows[] = {
        {"answers", hash_answers, 0, {0x9467dc252df3f63fu, 0x9467dc252df3f63fu}},
        {"manifolds", hash_manifolds, 0, {0x1fe97f326534654au, 0x1fe97f326534654au}},
        {"reaches", hash_manifolds, 1, {0xb20aca8e704ae916u, 0xb20aca8e704ae916u}},
        {"separations", hash_separations, 0, {0xe84fda589ddcfdb3u, 0xe84fda589ddcfdb3u}},
        {"straight casts", hash_casts, 0, {0x71e588e0560ea0bcu, 0x71e588e0560ea0bcu}},
        {"turning casts", hash_casts, 1, {0x1aec262a18092860u, 0x1aec262a18092860u}},
        {"casts that let go", hash_casts, 2, {0x4f688ca929b85a0cu, 0x4f688ca929b85a0cu}},
        {"boxes", hash_boxes, 0, {0x82c50e42c4824bc1u, 0xf33d99eef204246fu}},
        {"points", hash_points, 0, {0x57ecde8c73d6312eu, 0x57ecde8c73d6312eu}},
        {"worlds", hash_worlds, 0, {0xc98564332c7d076cu, 0xf20f34fe4959a5b1u}},
        {"points and things", hash_points, 1, {0x573dc0eaa30d7485u, 0xa51d05ecbd8aa077u}},
        {"rays stop", hash_rays, NARC_INSIDE_STOPS, {0x3d921d721e7f6ffbu, 0x3d921d721e7f6ffbu}},
        {"rays leave", hash_rays, NARC_INSIDE_LEAVES, {0x93bc1e29f9ee300fu, 0x93bc1e29f9ee300fu}},
        {"rays ignore", hash_rays, NARC_INSIDE_IGNORES, {0xebbd7d8a4e9a67f1u, 0xebbd7d8a4e9a67f1u}},
        {"alone", hash_alone, NARC_INSIDE_LEAVES, {0x9008dfea5b72d305u, 0x9008dfea5b72d305u}},
    };
    for (int precision = 0; precision < 2; precision++) {
        AUTO(destroy_scene) struct scene scene = make_golden_scene((narc_precision)precision);
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
            check_hash(rows[k].name, rows[k].hash(&scene, rows[k].way), rows[k].golden[precision]);
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
    AUTO(free_at) uint64_t *bits = find_overlaps(store, bodies, pairs, &(narc_query){0});
    AUTO(free_at) struct contacts contacts = find_contacts(store, bodies, pairs, &(narc_query){0});
    AUTO(free_at) uint64_t *of_contacts = calloc(NARC_BIT_WORDS(pairs->count), sizeof *of_contacts);
    for (size_t k = 0; k < contacts.count; k++)
        of_contacts[contacts.rows[k].pair / 64] |= UINT64_C(1) << contacts.rows[k].pair % 64;
    assert_memory_equal(bits, of_contacts, NARC_BIT_WORDS(pairs->count) * sizeof *bits);
}

/* Bodies on ground and on a few others: contacts, what is left of them when they are merged, casts, rays and points. */
TEST(test_ground) {
    enum { MOST = 64, GUESTS = 120, OTHERS = 4 };
    AUTO(destroy_scene) struct scene scene = make_golden_scene(NARC_FLOAT32);
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
    narc_bodies bodies, pieces;
    narc_view_bodies(guests, GUESTS, &bodies);
    narc_view_bodies(ground, count, &pieces);
    const narc_pairs pairs = {.count = pair_count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &pieces};
    check_bits(scene.store, &bodies, &pairs);
    hashes[0] = hash_query(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.125f, .flat_angle = 0.25f});
    AUTO(free_at)
    struct manifolds merged = find_manifolds(scene.store, &bodies, &pairs, &(narc_query){.margin = 0.125f});
    printf("  %zu manifolds on ground\n", merged.count);
    assert_true(merged.count > GUESTS / 2);
    merged.count = narc_merge_rows(
        &(narc_merging){&pairs, NARC_ARRAY(runs), scene.store, &pieces, .manifolds = merged.rows}, merged.count);
    hashes[1] = hash_reach_rows(hash_manifold_rows(TEST_HASH_START, merged), merged);
    for (int turning = 0; turning < 2; turning++) {
        const narc_motions motions = {.x = NARC_ARRAY(motion),
                                      .y = {motion + GUESTS, -(ptrdiff_t)sizeof *motion},
                                      .angle = {turning ? motion : NULL, sizeof *motion}};
        const narc_cast_options options = {.target = turning ? 0.0625f : 0, .tolerance = turning ? 0x1p-8f : 0};
        AUTO(free_at) struct impacts list = {make_junk(pair_count * sizeof *list.rows), pair_count};
        assert_int_equal(
            narc_cast_pairs(scene.store, &bodies, &motions, &pairs, NULL, &options, list.rows, pair_count, NULL),
            NARC_OK);
        hashes[2 + turning] = hash_impacts(list);
    }
    narc_box boxes[MOST];
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene.store, &pieces, NULL, boxes);
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
    for (size_t k = 0; k < 6; k++)
        check_hash("ground", hashes[k], golden_ground[k]);
    free(a);
    free(b);
}
#endif

#ifndef NARC_SMALL
/* Every seventh body is a half-plane. */
TEST(test_half_planes) {
    AUTO(destroy_scene) struct scene scene = make_golden_scene(NARC_FLOAT64);
    uint32_t plane;
    assert_int_equal(narc_add_half_plane(scene.store, &plane, NULL), NARC_OK);
    for (size_t k = 0; k < BODIES; k += 7)
        scene.bodies[k].shape = plane;
    const narc_bodies bodies = scene_bodies(&scene);
    const narc_pairs pairs = scene_pairs(&scene);
    const narc_query query = {.margin = 0.125f, .flat_angle = 0.25f};
    const uint64_t hashes[] = {hash_query(scene.store, &bodies, &pairs, &query),
                               hash_casts(&scene, 0),
                               hash_casts(&scene, 1),
                               hash_boxes(&scene, 0),
                               hash_points(&scene, 0),
                               hash_alone(&scene, NARC_INSIDE_LEAVES)};
    for (size_t k = 0; k < sizeof hashes / sizeof *hashes; k++)
        check_hash("half-planes", hashes[k], golden_planes[k]);
}

/* Of clouds of points of a lattice, with a skin and without. */
TEST(test_outlines) {
    enum { CLOUDS = 200, POINTS = 60, LINE = 4096 };
    static narc_point line[LINE];
    const narc_body body = {3, -5, 0.6f, 0.8f, 1.5f, 0};
    struct test_random random = {3};
    uint64_t hulls = TEST_HASH_START, lines = TEST_HASH_START;
    size_t all = 0;
    for (size_t k = 0; k < CLOUDS; k++) {
        narc_point points[POINTS];
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count, line_count;
        for (size_t i = 0; i < POINTS; i++)
            points[i] = (narc_point){(double)random_below(&random, 1 << 20) / 1024,
                                     (double)random_below(&random, 1 << 20) / (double)(1024 << k % 8)};
        assert_int_equal(narc_build_hull(points, POINTS, 0.25, (double)(k % 3), arcs, &count, NULL), NARC_OK);
        for (size_t i = 0; i < count; i++)
            hulls = test_hash_items(hulls, &arcs[i], 5, sizeof(double));
        assert_int_equal(
            narc_flatten_arcs(arcs, count, true, k % 2 ? &body : NULL, 0x1p-9, line, LINE, &line_count, NULL), NARC_OK);
        lines = test_hash_items(lines, line, 2 * line_count, sizeof(double));
        all += line_count;
    }
    printf("  %zu points of %d polylines\n", all, (int)CLOUDS);
    check_hash("hulls", hulls, golden_outlines[0]);
    check_hash("polylines", lines, golden_outlines[1]);
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
