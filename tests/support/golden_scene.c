/* SPDX-License-Identifier: MIT
 *
 * golden_scene.c - a fixed scene, and hashes of answers to it.
 */
#include "golden_scene.h"

#include <inttypes.h>
#include <stdio.h>

/* Angles of the directions (7, 24) / 25 and (20, 99) / 101. */
#define ANGLE_25  1.28700221758656973
#define ANGLE_101 1.37145902181257261

/* Four arcs around one of those directions, d = (x, y) at angle `a`: flat ones of radius R and tips of radius
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
_Static_assert(sizeof shapes / sizeof *shapes == SHAPES, "shapes");

struct scene make_golden_scene(narc_precision precision) {
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

uint64_t hash_contacts(uint64_t hash, struct contacts list) {
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

void check_hash(const char *name, uint64_t hash, uint64_t golden) {
    printf("  %s: 0x%016" PRIx64 "\n", name, hash);
    assert_true(hash == golden);
}
