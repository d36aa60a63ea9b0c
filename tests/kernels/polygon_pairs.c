/* SPDX-License-Identifier: MIT
 *
 * polygon_pairs.c - pairs of sharp polygons of up to 8 corners have a way of their own: rows are those of the deciding
 * formula, byte by byte, where polygons are regular, thin, have short edges or edges that are nearly parallel, where they
 * face each other with edges, corners or both, and among shapes that go other ways.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "hard.h"
#include "plain.h"

enum { SHAPES = 12, PAIRS = 128 * HARD_BODIES / 2, MOST_CORNERS = 8 };

/* What a scene is made of. */
enum kinds {
    ROUND,   /* corners anywhere near a circle */
    REGULAR, /* regular ones, mostly in multiples of their own angles */
    THIN,    /* corners on an ellipse, down to 1 : 1000 */
    SHORT,   /* an edge is cut off from a corner, down to 1e-6 of the size */
    FLAT,    /* neighbours in an edge's line, up to an angle that is hardly one */
    LATTICE, /* corners in eighths */
    AWAY,    /* far from their own origins */
    OTHERS,  /* all these, and polygons with more corners or round ones, boxes, circles, n-arcs */
    KINDS
};

static bool try_polygon(const narc_point *point, size_t count, double radius, struct shape *out) {
    return narc_build_polygon(point, count, radius, out->arcs, &out->count, NULL) == NARC_OK;
}

static size_t make_ellipse(struct test_random *random, double flat, narc_point *out) {
    const size_t count = 3 + random_below(random, MOST_CORNERS - 2);
    const double turn = random_between(random, -PI, PI);
    for (size_t i = 0; i < count; i++) {
        const double angle = turn + 2 * PI * ((double)i + random_between(random, -0.4, 0.4)) / (double)count;
        out[i] = (narc_point){cos(angle), flat * sin(angle)};
    }
    return count;
}

static size_t make_regular(struct test_random *random, narc_point *out) {
    const size_t counts[] = {3, 4, 5, 6, 8, 8}, count = counts[random_below(random, 6)];
    const double turn = random_below(random, 2) ? 0 : PI / (double)count;
    for (size_t i = 0; i < count; i++)
        out[i] = (narc_point){cos(turn + 2 * PI * (double)i / (double)count),
                              sin(turn + 2 * PI * (double)i / (double)count)};
    return count;
}

/* A corner becomes two: at the parts `before` and `behind` of the edges beside it. */
static size_t cut_corner(narc_point *point, size_t count, size_t corner, double before, double behind) {
    const narc_point last = point[(corner + count - 1) % count], here = point[corner],
                     next = point[(corner + 1) % count];
    if (count == MOST_CORNERS)
        return count;
    for (size_t i = count; i > corner; i--)
        point[i] = point[i - 1];
    point[corner] = (narc_point){here.x + before * (last.x - here.x), here.y + before * (last.y - here.y)};
    point[corner + 1] = (narc_point){here.x + behind * (next.x - here.x), here.y + behind * (next.y - here.y)};
    return count + 1;
}

/* A corner nearly on an edge: the edge's middle, moved outwards. */
static size_t bend_edge(narc_point *point, size_t count, size_t edge, double by) {
    const narc_point from = point[edge], to = point[(edge + 1) % count];
    if (count == MOST_CORNERS)
        return count;
    for (size_t i = count; i > edge + 1; i--)
        point[i] = point[i - 1];
    point[edge + 1] =
        (narc_point){(from.x + to.x) / 2 + by * (to.y - from.y), (from.y + to.y) / 2 - by * (to.x - from.x)};
    return count + 1;
}

/* A box with corners cut off, in eighths. */
static size_t make_lattice(struct test_random *random, narc_point *out) {
    const double x = 0.25 * (double)(1 + random_below(random, 4)), y = 0.25 * (double)(1 + random_below(random, 4));
    const narc_point box[] = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
    const double cut = 0.125;
    size_t count = 0;
    for (size_t i = 0; i < 4; i++) {
        const double sign = i % 2 ? -1 : 1, sign_x = box[i].x > 0 ? 1 : -1, sign_y = box[i].y > 0 ? 1 : -1;
        const narc_point on_x = {box[i].x - sign_x * cut, box[i].y}, on_y = {box[i].x, box[i].y - sign_y * cut};
        if (random_below(random, 2)) {
            out[count++] = box[i];
        } else {
            out[count++] = sign > 0 ? on_y : on_x;
            out[count++] = sign > 0 ? on_x : on_y;
        }
    }
    return count;
}

static struct shape make_polygon(struct test_random *random, enum kinds kind) {
    narc_point point[2 * MOST_CORNERS];
    struct shape shape;
    do {
        size_t count = make_ellipse(random, kind == THIN ? random_log_between(random, 1e-3, 1) : 1, point);
        if (kind == REGULAR)
            count = make_regular(random, point);
        else if (kind == LATTICE)
            count = make_lattice(random, point);
        for (size_t k = random_below(random, 4); k > 0 && kind == SHORT; k--)
            count = cut_corner(point, count, random_below(random, count), random_log_between(random, 1e-6, 0.5),
                               random_log_between(random, 1e-6, 0.5));
        for (size_t k = random_below(random, 4); k > 0 && kind == FLAT; k--)
            count = bend_edge(point, count, random_below(random, count), random_log_between(random, 3e-6, 0.1));
        const double far = kind == AWAY ? random_log_between(random, 0.1, 1e4) : 0,
                     angle = random_between(random, -PI, PI);
        for (size_t i = 0; i < count; i++)
            point[i] = (narc_point){point[i].x + far * cos(angle), point[i].y + far * sin(angle)};
        if (try_polygon(point, count, 0, &shape))
            return shape;
    } while (true);
}

static struct shape make_other(struct test_random *random) {
    const enum hard_family families[] = {HARD_CORNERS, HARD_REGULAR, HARD_STACK, HARD_TIPS, HARD_LONG, HARD_SPLIT};
    if (random_below(random, 3) == 0)
        return make_hard_shape(random, families[random_below(random, 6)]);
    return random_below(random, 5) ? make_polygon(random, (enum kinds)random_below(random, OTHERS)) : circle_of(1);
}

/* Hard placements of any two shapes. */
static struct scene make_polygons(struct test_random *random, enum kinds kind) {
    const narc_precision precision = random_below(random, 2) ? NARC_FLOAT64 : NARC_FLOAT32;
    struct scene scene = create_scene(precision, SHAPES, 2 * PAIRS, PAIRS);
    for (size_t k = 0; k < SHAPES; k++) {
        const struct shape shape = kind == OTHERS ? make_other(random) : make_polygon(random, kind);
        scene_add_shape(&scene, &shape);
    }
    while (scene.pair_count + HARD_BODIES / 2 <= PAIRS) {
        const uint32_t a = (uint32_t)random_below(random, SHAPES), b = (uint32_t)random_below(random, SHAPES);
        add_hard_pairs(random, &scene, (enum hard_placement)random_below(random, HARD_PLACES), a, b);
    }
    for (size_t k = 0; k < scene.pair_count; k++) {
        if (random_below(random, 64) == 0)
            scene.pairs[k].b = scene.pairs[k].a;
        else if (random_below(random, 2))
            scene.pairs[k] = (struct pair){scene.pairs[k].b, scene.pairs[k].a};
        if (kind == OTHERS && random_below(random, 40) == 0)
            scene.bodies[scene.pairs[k].b].sine = NAN;
    }
    return scene;
}

static void check_kind(enum kinds kind, const char *name) {
    struct test_random random = test_random_named(name);
    for (size_t round = 0; round < test_trials(6); round++) {
        AUTO(destroy_scene) struct scene scene = make_polygons(&random, kind);
        check_plain_scene(&random, &scene, name);
    }
}

TEST(test_round) { check_kind(ROUND, "polygons near circles"); }

TEST(test_regular) { check_kind(REGULAR, "regular polygons"); }

TEST(test_thin) { check_kind(THIN, "thin polygons"); }

TEST(test_short) { check_kind(SHORT, "short edges"); }

TEST(test_flat) { check_kind(FLAT, "edges nearly in line"); }

TEST(test_lattice) { check_kind(LATTICE, "polygons of a lattice"); }

TEST(test_away) { check_kind(AWAY, "polygons away from their origins"); }

TEST(test_others) { check_kind(OTHERS, "polygons among others"); }

/* What a program has most: bodies that touch, or nearly, anyhow; then each a little further. */
TEST(test_piles) {
    struct test_random random = test_random_named("piles");
    for (size_t round = 0; round < test_trials(4); round++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, SHAPES, 2 * PAIRS, PAIRS);
        for (size_t k = 0; k < SHAPES; k++) {
            const struct shape shape = make_polygon(&random, ROUND);
            scene_add_shape(&scene, &shape);
        }
        for (size_t k = 0; k < PAIRS; k++) {
            struct body a = turned_body(random_between(&random, -PI, PI), 1), b = a;
            b = turned_body(random_between(&random, -PI, PI), 1);
            a.shape = (uint32_t)random_below(&random, SHAPES);
            b.shape = (uint32_t)random_below(&random, SHAPES);
            const double angle = random_between(&random, -PI, PI), distance = random_between(&random, 1, 2.1);
            b.x = distance * cos(angle);
            b.y = distance * sin(angle);
            scene_add_two(&scene, a, b);
        }
        for (int frame = 0; frame < 2; frame++) {
            check_plain_scene(&random, &scene, "piles");
            scene_move_bodies(&scene, &random, 0.01);
        }
    }
}

TEST_MAIN("polygon_pairs")
