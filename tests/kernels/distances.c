/* SPDX-License-Identifier: MIT
 *
 * distances.c - distances of points to bodies, compared with the reference; what has no answer;
 * what is near to a body.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "expect.h"
#include "hard.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "scene.h"

enum point_placement {
    POINT_NEAR,     /* beside the outline, within half a size */
    POINT_DEEP,     /* anywhere around: mostly within */
    POINT_TOUCH,    /* the outline, up to a few roundings off */
    POINT_JUNCTION, /* on the normal of a junction, inside and outside */
    POINT_CENTER,   /* the centre of an arc, or nearly */
    POINT_CORNER,   /* where an arc starts */
    POINT_EDGE,     /* the line of an edge, or of a tangent */
    POINT_POSITION, /* the position */
    POINT_FAR,      /* up to 1e6 sizes away */
    POINT_PLACES
};

static const char *const placement_names[POINT_PLACES] = {"near",   "deep", "touch",    "junction", "center",
                                                          "corner", "edge", "position", "far"};

/* In a shape's own coordinates; the shape's size is about 1. */
static narc_point place_point(struct test_random *random, const struct shape *shape, enum point_placement placement) {
    const narc_arc arc = shape->arcs[random_below(random, shape->count)];
    const double angle = random_between(random, -PI, PI), x = cos(arc.start), y = sin(arc.start);
    const narc_point start = {arc.center_x + arc.radius * x, arc.center_y + arc.radius * y};
    const double series = (random_below(random, 2) ? 1 : -1) * random_log_between(random, 1e-8, 1e-3);
    narc_point p;
    assert_true(narc_find_support(shape->arcs, shape->count, cos(angle), sin(angle), &p, NULL));
    double away = 0, x_away = cos(angle), y_away = sin(angle);
    switch (placement) {
    case POINT_NEAR:
        away = random_between(random, -0.5, 0.5);
        break;
    case POINT_DEEP:
        away = random_between(random, -2, 0);
        break;
    case POINT_TOUCH:
        away = random_below(random, 2) ? 0 : series * 1e-3;
        break;
    case POINT_FAR:
        away = random_log_between(random, 1, 1e6);
        break;
    case POINT_JUNCTION:
        p = start;
        x_away = x;
        y_away = y;
        away = random_between(random, -2 - arc.radius, 3);
        break;
    case POINT_CENTER:
        p = (narc_point){arc.center_x, arc.center_y};
        away = random_below(random, 2) ? 0 : series;
        break;
    case POINT_CORNER:
        p = start;
        away = random_below(random, 2) ? 0 : series;
        break;
    case POINT_EDGE:
        p = start;
        x_away = -y;
        y_away = x;
        away = random_between(random, -2, 2);
        break;
    case POINT_POSITION:
        p = (narc_point){0, 0};
        break;
    case POINT_PLACES:
        break;
    }
    return (narc_point){p.x + x_away * away, p.y + y_away * away};
}

struct asked_point {
    double x, y;
    float x_single, y_single;
    uint32_t body;
};

/* A scene with bodies of shapes of a family, and points to ask of. */
struct point_scene {
    struct scene scene;
    struct asked_point *points;
    size_t count;
};

enum { SHAPES = 4 };

/* A pose near the origin or far from it; sizes about 1, or not at all; rotations now and then drifted. */
static struct body random_body(struct test_random *random, narc_precision precision) {
    const double scale = random_below(random, 2) ? 1 : random_log_between(random, 1e-6, 1e6);
    const double way = random_below(random, 2) ? 2 : scale * (precision == NARC_FLOAT64 ? 1e7 : 1e3);
    struct body body = turned_body(random_between(random, -PI, PI), scale);
    if (random_below(random, 4) == 0) {
        const float factor = (float)(1 + 0.498 * NARC_ROTATION_TOLERANCE * random_between(random, -1, 1));
        body.cosine *= factor;
        body.sine *= factor;
    }
    body.x = random_between(random, -way, way);
    body.y = random_between(random, -way, way);
    if (random_below(random, 50) == 0)
        body = fly_away(body, random_below(random, 24), precision);
    return body;
}

/* Point k is placed by k % POINT_PLACES. */
static struct point_scene make_point_scene(struct test_random *random, narc_precision precision, int kind,
                                           size_t count) {
    struct point_scene made = {create_scene(precision, SHAPES, count, 0), NULL, count};
    made.points = calloc(count, sizeof *made.points);
    assert_non_null(made.points);
    for (int k = 0; k < SHAPES; k++) {
        const struct shape shape = make_any_shape(random, (size_t)kind);
        scene_add_shape(&made.scene, &shape);
    }
    for (size_t k = 0; k < count; k++) {
        struct body body = random_body(random, precision);
        body.shape = (uint32_t)random_below(random, SHAPES);
        const uint32_t index = scene_add_body(&made.scene, body);
        body = made.scene.bodies[index];
        const narc_point p =
            place_point(random, &made.scene.shapes[body.shape], (enum point_placement)(k % POINT_PLACES));
        const double length = hypot((double)body.cosine, (double)body.sine), scale = (double)body.scale / length;
        struct body at = {.x = body.x + scale * ((double)body.cosine * p.x - (double)body.sine * p.y),
                          .y = body.y + scale * ((double)body.sine * p.x + (double)body.cosine * p.y)};
        round_position(&at, precision);
        made.points[k] = (struct asked_point){at.x, at.y, at.x_single, at.y_single, index};
    }
    return made;
}

static void destroy_point_scene(struct point_scene *scene) {
    destroy_scene(&scene->scene);
    free(scene->points);
}

static narc_points points_of(const struct asked_point *points, size_t count, narc_precision precision) {
    const bool single = precision == NARC_FLOAT32;
    return (narc_points){.count = count,
                         .x = single ? NARC_POSITION_COLUMN(points, x_single) : NARC_POSITION_COLUMN(points, x),
                         .y = single ? NARC_POSITION_COLUMN(points, y_single) : NARC_POSITION_COLUMN(points, y)};
}

static narc_distance *find_distances(const struct point_scene *scene) {
    narc_distance *rows = make_junk(scene->count * sizeof *rows);
    const narc_bodies bodies = scene_bodies(&scene->scene);
    const narc_points points = points_of(scene->points, scene->count, scene->scene.precision);
    narc_error error;
    if (narc_find_distances(scene->scene.store, &bodies, &points, &NARC_COLUMN(scene->points, body), NULL, rows,
                            &error) != NARC_OK)
        fail_msg("%s", error.message);
    return rows;
}

/* ------------------------------------------------------------------------------------------------ meaning */

/* What is wrong with a row, or NULL; raises the errors as fractions of the bound. It is the contact with a circle of radius
 * 0, whose point is halfway from the place to the point. */
static const char *check_row(const struct reference_body *body, const struct asked_point *point,
                             const narc_distance *row, struct fractions *worst) {
    const narc_arc dot = {0, 0, 0, 0, 2 * PI};
    const struct reference_body other = {&dot, 1, point->x, point->y, 1, 0, 1};
    const double half = (double)row->separation / 2;
    const narc_contact contact = {.feature = row->feature,
                                  .count = row->count,
                                  .separation = row->separation,
                                  .normal_x = row->normal_x,
                                  .normal_y = row->normal_y,
                                  .point_x = (float)((double)row->place_x + half * (double)row->normal_x),
                                  .point_y = (float)((double)row->place_y + half * (double)row->normal_y),
                                  .radius_a = row->radius};
    return check_contact(body, &other, reference_solve_gap(body, &other).gap, &contact, worst);
}

/* How many wrong rows are shown in full. */
enum { SHOWN = 5 };

/* Errors stay far below the bound, which adds their largest values; above this a kernel has become worse. */
static const double expected_part = 0.2;

static void check_all_kinds(const char *name, narc_precision precision, size_t rounds) {
    struct test_random random = test_random_named(name);
    struct fractions worst[ALL_FAMILIES + POINT_PLACES] = {{0}};
    size_t wrong_count = 0, count = POINT_PLACES * test_trials(rounds);
    for (int kind = 0; kind < ALL_FAMILIES; kind++) {
        AUTO(destroy_point_scene) struct point_scene scene = make_point_scene(&random, precision, kind, count);
        AUTO(free_at) narc_distance *rows = find_distances(&scene);
        for (size_t k = 0; k < count; k++) {
            const struct reference_body body = scene_reference(&scene.scene, scene.points[k].body);
            struct fractions errors = {0};
            const char *wrong = check_row(&body, &scene.points[k], &rows[k], &errors);
            if (rows[k].point != k || rows[k].body != scene.points[k].body)
                wrong = "numbers";
            struct fractions *const rows_of[2] = {&worst[kind], &worst[ALL_FAMILIES + k % POINT_PLACES]};
            for (int t = 0; t < 2; t++) {
                rows_of[t]->separation = fmax(rows_of[t]->separation, errors.separation);
                rows_of[t]->normal = fmax(rows_of[t]->normal, errors.normal);
                rows_of[t]->point = fmax(rows_of[t]->point, errors.point);
            }
            if (wrong && wrong_count++ < SHOWN) {
                print_error("%s, %s: %s; point (%a, %a); separation %.9g, normal (%.9g, %.9g), place (%.9g, %.9g), "
                            "feature %d, radius %g; errors %g %g %g\n",
                            any_family_name((size_t)kind), placement_names[k % POINT_PLACES], wrong, scene.points[k].x,
                            scene.points[k].y, (double)rows[k].separation, (double)rows[k].normal_x,
                            (double)rows[k].normal_y, (double)rows[k].place_x, (double)rows[k].place_y, rows[k].feature,
                            (double)rows[k].radius, errors.separation, errors.normal, errors.point);
                print_pair(&body, &body);
            }
        }
    }
    printf("  %-11s %12s %7s %7s   (largest errors, as fractions of the bound)\n", "", "separation", "normal", "place");
    for (int k = 0; k < ALL_FAMILIES + POINT_PLACES; k++)
        printf("  %-11s %12.3f %7.3f %7.3f\n",
               k < ALL_FAMILIES ? any_family_name((size_t)k) : placement_names[k - ALL_FAMILIES], worst[k].separation,
               worst[k].normal, worst[k].point);
    if (wrong_count)
        fail_msg("%zu wrong rows", wrong_count);
    for (int k = 0; k < ALL_FAMILIES; k++)
        assert_true(fmax(worst[k].separation, fmax(worst[k].normal, worst[k].point)) < expected_part);
}

TEST(test_single_positions) { check_all_kinds("points, single positions", NARC_FLOAT32, 20); }

TEST(test_double_positions) { check_all_kinds("points, double positions", NARC_FLOAT64, 20); }

/* A circle with a flat place, a short one, and an arc beside it that hardly turns: from there on, the edge's normal,
 * the arc's end and the arc behind the edge have the same separation but for rounding. */
TEST(test_short_arcs) {
    const double turn = 4.7e-5, flat = 1e-3;
    const struct shape shape = {{{0, 0, 1, 0, turn}, {-flat * turn, flat, 1, turn, PI}, {0, 0, 1, PI, 2 * PI}}, 3};
    struct test_random random = test_random_named("points, short arcs");
    const size_t count = test_trials(1000);
    AUTO(destroy_point_scene)
    struct point_scene scene = {create_scene(NARC_FLOAT64, 1, count, 0), calloc(count, sizeof *scene.points), count};
    assert_non_null(scene.points);
    scene_add_shape(&scene.scene, &shape);
    for (size_t k = 0; k < count; k++) {
        const struct body body = turned_body(random_between(&random, -PI, PI), 1);
        const double along = flat * random_between(&random, -1, 2), c = (double)body.cosine, s = (double)body.sine;
        const double x = cos(turn) - along * sin(turn), y = sin(turn) + along * cos(turn);
        const uint32_t index = scene_add_body(&scene.scene, body);
        scene.points[k] = (struct asked_point){.x = c * x - s * y, .y = s * x + c * y, .body = index};
    }
    AUTO(free_at) narc_distance *rows = find_distances(&scene);
    for (size_t k = 0; k < count; k++) {
        const struct reference_body body = scene_reference(&scene.scene, scene.points[k].body);
        struct fractions errors = {0};
        const char *wrong = check_row(&body, &scene.points[k], &rows[k], &errors);
        if (wrong)
            fail_msg("%s: %g", wrong, errors.point);
    }
}

/* ------------------------------------------------------------------------------------------------ the rest */

/* What has no answer: the numbers of broken bodies, and of points. */
TEST(test_no_answer) {
    static const float broken[] = {NAN, INFINITY, -INFINITY, 2, 0};
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT32, 1, 64, 0);
    const struct shape box = box_of(1, 1, 0);
    scene_add_shape(&scene, &box);
    const struct body fine = turned_body(0.3, 1);
    scene_add_body(&scene, fine);
    for (size_t k = 0; k < sizeof broken / sizeof broken[0]; k++) {
        struct body body = fine;
        if (k < 3)
            body.x = (double)broken[k];
        scene_add_body(&scene, body);
        body = fine;
        body.cosine = broken[k];
        scene_add_body(&scene, body);
        body = fine;
        body.scale = k == 3 ? -1 : broken[k];
        scene_add_body(&scene, body);
    }
    const size_t count = scene.body_count;
    const float x[] = {3}, y[] = {0.1f};
    const narc_points points = {.count = count, .x = {x, 0, NARC_FLOAT32}, .y = {y, 0, NARC_FLOAT32}};
    const narc_bodies bodies = scene_bodies(&scene);
    AUTO(free_at) narc_distance *rows = make_junk(count * sizeof *rows);
    assert_int_equal(narc_find_distances(scene.store, &bodies, &points, NULL, NULL, rows, NULL), NARC_OK);
    size_t answers = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_distance none = {.point = (uint32_t)k};
        const struct body *body = &scene.bodies[k];
        const bool is_fine = isfinite(body->x) && body->cosine == fine.cosine && body->scale == 1;
        answers += rows[k].count;
        assert_int_equal(rows[k].count, is_fine);
        if (!is_fine)
            assert_memory_equal(&rows[k], &none, sizeof none);
    }
    assert_true(answers >= 1);
    static const double far[] = {0, 9e16, 1.1e17, 1e300, NAN, INFINITY, -INFINITY};
    const double nothing = 0;
    for (size_t k = 0; k < sizeof far / sizeof far[0]; k++) {
        const narc_points one = {.count = 1, .x = {&far[k], 0, NARC_FLOAT64}, .y = {&nothing, 0, NARC_FLOAT64}};
        assert_int_equal(narc_find_distances(scene.store, &bodies, &one, NULL, NULL, rows, NULL), NARC_OK);
        assert_int_equal(rows[0].count, k < 2);
        if (k == 1)
            assert_true(fabs((double)rows[0].separation - far[k]) < 1e-6 * far[k] && rows[0].normal_x > 0.999999f);
    }
    assert_int_equal(narc_remove_shape(scene.store, 0, NULL), NARC_OK);
    assert_int_equal(narc_find_distances(scene.store, &bodies, &points, NULL, NULL, rows, NULL), NARC_OK);
    for (size_t k = 0; k < count; k++)
        assert_int_equal(rows[k].count, 0);
}

/* The example of narc_scene.h: what is near to a body. */
static size_t count_near_a_body(struct test_random *random) {
    AUTO(destroy_scene) struct scene scene = make_random_scene(random, NARC_FLOAT32, 60, 1);
    const narc_bodies bodies = scene_bodies(&scene);
    narc_box box[60];
    narc_pairs pairs;
    narc_contact contact[60], *all = make_junk(60 * sizeof *all);
    size_t found = 0, expected = 0;
    AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene.store, &bodies, NULL, box);
    const narc_box_options around = {.first = 7, .count = 1, .margin = 0.5f};
    const uint32_t seven = 7;
    const narc_index_query others = {.ignored = {&seven, 0}};
    assert_int_equal(narc_compute_boxes(scene.store, &bodies, &around, box, NULL), NARC_OK);
    assert_int_equal(narc_query_index(index, box + 7, 1, &others, &pairs, NULL), NARC_OK);
    pairs.a = (narc_index_column){&seven, 0};
    const narc_query query = {.margin = 0.5f};
    assert_int_equal(narc_find_contacts(scene.store, &bodies, &pairs, &query, contact, 60, &found, NULL), NARC_OK);

    for (uint32_t k = 0; k < 60; k++) {
        const narc_pairs one = {.count = 1, .a = {&seven, 0}, .b = {&k, 0}};
        size_t near = 0;
        if (k == 7)
            continue;
        assert_int_equal(narc_find_contacts(scene.store, &bodies, &one, &query, all, 1, &near, NULL), NARC_OK);
        if (near == 0)
            continue;
        assert_true(expected < found);
        assert_int_equal(pairs.b.base[contact[expected].pair], k);
        assert_true(contact[expected].separation == all[0].separation);
        expected++;
    }
    assert_int_equal(found, expected);
    free(all);
    return found;
}

TEST(test_near_a_body) {
    struct test_random random = test_random_named("points, near a body");
    size_t found = 0;
    for (int scenes = 0; scenes < 8; scenes++) /* a body may be alone in one */
        found += count_near_a_body(&random);
    assert_true(found > 0);
}

/* ------------------------------------------------------------------------------------------------ things */

enum { PARTS = 12 };
static const double spacing = 0.02, seam = 1e-5;

/* Parts that overlap, or tiles that lie side by side, up to rounding; and a few bodies by themselves. */
static struct scene make_thing(struct test_random *random, size_t trial, uint32_t *owner) {
    struct scene scene = create_scene((narc_precision)(trial % 2), PARTS, PARTS, 1);
    const bool tiles = trial % 3 == 0;
    const double angle = random_between(random, -4, 4), c = cos(angle), s = sin(angle);
    for (size_t k = 0; k < PARTS; k++) {
        const struct shape shape =
            tiles ? box_of(1, 1, 0) : make_shape(random, (enum family)random_below(random, FAMILY_COUNT));
        scene_add_shape(&scene, &shape);
        struct body body =
            turned_body(tiles ? angle : random_between(random, -4, 4), tiles ? 1 : random_between(random, 0.5, 1.5));
        const double x = tiles ? (double)(k % 4) : random_between(random, -1.5, 1.5),
                     y = tiles ? (double)(k / 4) : random_between(random, -1.5, 1.5);
        body.x = c * x - s * y;
        body.y = s * x + c * y;
        body.shape = (uint32_t)k;
        round_position(&body, scene.precision);
        scene_add_body(&scene, body);
        owner[k] = random_below(random, 8) ? 5 : UINT32_MAX;
    }
    return scene;
}

/* How far a place is from the nearest part, below 0 in one. */
static double find_separation(const struct scene *scene, const uint32_t *owner, double x, double y) {
    double least = INFINITY;
    for (uint32_t k = 0; k < PARTS; k++) {
        const struct reference_body body = scene_reference(scene, k);
        if (owner[k] == 5)
            least = fmin(least, reference_point_distance(&body, x - body.x, y - body.y));
    }
    return least;
}

/* Outside all of the thing's parts: one that the place lies in answers. */
static bool is_outside(const struct scene *scene, const uint32_t *owner, double x, double y) {
    static uint32_t last; /* neighbours of a place lie in the same part */
    for (uint32_t k = 0; k < PARTS; k++) {
        const uint32_t part = (last + k) % PARTS;
        const struct reference_body body = scene_reference(scene, part);
        if (owner[part] == 5 && !(reference_point_distance(&body, x - body.x, y - body.y) > 0)) {
            last = part;
            return false;
        }
    }
    return true;
}

/* Takes a place of an outline, if it is nearer and what lies so far beyond it is outside. */
static void take_outside(const struct scene *scene, const uint32_t *owner, double x, double y, double at_x, double at_y,
                         double beyond, double *best) {
    const double away = hypot(at_x - x, at_y - y);
    if (away < *best && is_outside(scene, owner, at_x + beyond * (at_x - x) / away, at_y + beyond * (at_y - y) / away))
        *best = away;
}

/* How far it is to the outside, by places of all outlines that are no further than `spacing` apart. */
static double find_way_out(const struct scene *scene, const uint32_t *owner, double x, double y, double beyond) {
    enum { NORMALS = 500 };
    double best = INFINITY;
    for (uint32_t k = 0; k < PARTS; k++) {
        const struct body *const body = &scene->bodies[k];
        const struct shape *const shape = &scene->shapes[body->shape];
        const struct reference_body at = scene_reference(scene, k);
        narc_point last = {0, 0};
        for (int i = 0; owner[k] == 5 && i <= NORMALS; i++) {
            const double angle = 2 * PI * i / NORMALS;
            narc_point p;
            assert_true(narc_find_support(shape->arcs, shape->count, cos(angle), sin(angle), &p, NULL));
            const narc_point now = {at.x + at.scale * (at.cosine * p.x - at.sine * p.y),
                                    at.y + at.scale * (at.sine * p.x + at.cosine * p.y)};
            const int pieces = i > 0 ? 1 + (int)(hypot(now.x - last.x, now.y - last.y) / spacing) : 1;
            for (int piece = 1; piece <= pieces; piece++) {
                const double part = (double)piece / pieces;
                take_outside(scene, owner, x, y, i > 0 ? last.x + part * (now.x - last.x) : now.x,
                             i > 0 ? last.y + part * (now.y - last.y) : now.y, beyond, &best);
            }
            last = now;
        }
    }
    return best;
}

/* Is a place beside the outside, such as a hole between two places of find_way_out()? */
static bool is_near_outside(const struct scene *scene, const uint32_t *owner, double x, double y) {
    enum { ANGLES = 256 };
    bool found = false;
    for (double radius = 2 * seam; radius < 100 * seam && !found; radius *= 2)
        for (int k = 0; k < ANGLES && !found; k++) {
            const double angle = 2 * PI * k / ANGLES;
            found = is_outside(scene, owner, x + radius * cos(angle), y + radius * sin(angle));
        }
    return found;
}

/* The depth of a thing is that to its outside, wherever the seams between its parts are. */
TEST(test_depth_of_things) {
    enum { POINTS = 6 };
    struct test_random random = test_random_named("points, things");
    size_t within = 0, deeper = 0, corners = 0;
    for (size_t trial = 0; trial < test_trials(24); trial++) {
        uint32_t owner[PARTS];
        AUTO(destroy_scene) struct scene scene = make_thing(&random, trial, owner);
        const narc_bodies bodies = scene_bodies(&scene);
        narc_box boxes[PARTS];
        AUTO(narc_destroy_index_at)
        narc_index *const index = index_bodies(scene.store, &bodies, &(narc_index_options){.fast = trial % 2}, boxes);
        double x[POINTS], y[POINTS];
        for (size_t k = 0; k < POINTS; k++) {
            const struct body *const near = &scene.bodies[random_below(&random, PARTS)];
            const struct reference_body at = scene_reference(&scene, (uint32_t)(near - scene.bodies));
            x[k] = at.x + random_between(&random, -0.5, 0.5);
            y[k] = at.y + random_between(&random, -0.5, 0.5);
        }
        const narc_owners owners = {.owner = NARC_ARRAY(owner)};
        const narc_points points = {.count = POINTS, .x = NARC_POSITION_ARRAY(x), .y = NARC_POSITION_ARRAY(y)};
        const narc_nearest_options options = {.search.owners = &owners, .inside = 1, .most = PARTS};
        narc_distance rows[POINTS][PARTS];
        narc_error error;
        expect_ok(narc_find_nearest(index, scene.store, &bodies, &points, &options, rows[0], POINTS * PARTS, &error),
                  &error);
        for (size_t k = 0; k < POINTS; k++) {
            const double part = find_separation(&scene, owner, x[k], y[k]);
            const narc_distance *row = rows[k];
            while (row < rows[k] + PARTS && row->count && owner[row->body] != 5)
                row++;
            const bool found = row < rows[k] + PARTS && row->count;
            assert_true(found == (part < 0) || fabs(part) < seam);
            if (!found || part > -10 * seam)
                continue;
            const double depth = -(double)row->separation, right = find_way_out(&scene, owner, x[k], y[k], 4 * seam);
            const struct reference_body body = scene_reference(&scene, row->body);
            const double at_x = body.x + (double)row->place_x, at_y = body.y + (double)row->place_y;
            const bool is_right = depth <= right + 4 * seam || /* holes that are hardly wider than rounding */
                                  depth <= find_way_out(&scene, owner, x[k], y[k], 200 * seam) + 4 * seam;
            if (!(is_right && (depth >= right - spacing || is_near_outside(&scene, owner, at_x, at_y))))
                fail_msg("trial %zu, point %zu: depth %.9g, not %.9g; of a part %.9g", trial, k, depth, right, -part);
            assert_true(fabs(hypot(at_x - x[k], at_y - y[k]) - depth) < seam);
            assert_true(fabs(reference_point_distance(&body, (double)row->place_x, (double)row->place_y)) < seam);
            assert_true(find_separation(&scene, owner, at_x, at_y) > -seam);
            assert_true(fabs(x[k] + depth * (double)row->normal_x - at_x) < 4 * seam);
            within++;
            deeper += depth > -part + 4 * seam;
            corners += row->radius == 0;
        }
        narc_distance others[POINTS][PARTS]; /* through another tree */
        AUTO(narc_destroy_index_at)
        narc_index *const other =
            index_bodies(scene.store, &bodies, &(narc_index_options){.fast = trial % 2 == 0}, boxes);
        expect_ok(narc_find_nearest(other, scene.store, &bodies, &points, &options, others[0], POINTS * PARTS, &error),
                  &error);
        assert_memory_equal(rows, others, sizeof rows);
    }
    print_message("%zu points within, %zu of them deeper than in a part, %zu nearest to where two parts meet\n", within,
                  deeper, corners);
    assert_true(test_trials(24) < 10 || (deeper > 0 && corners > 0));
}

/* From a circle's centre all places where others cross it are as near: which one answers is not the tree's choice. */
TEST(test_ties_of_things) {
    enum { DISCS = 48, TREES = 2 };
    struct test_random random = test_random_named("points, ties");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2, DISCS, 1);
        const struct shape disc = {{{0, 0, 0.5, 0, 2 * PI}}, 1},
                           wedge = {{{0.6, 0, 0, -1.2, 1.2},
                                     {-0.6, 1.2 / tan(1.2), 0, 1.2, PI},
                                     {-0.6, -1.2 / tan(1.2), 0, PI, 2 * PI - 1.2}},
                                    3};
        scene_add_shape(&scene, &disc);
        scene_add_shape(&scene, &wedge);
        for (size_t k = 0; k < DISCS; k++) {
            const double far = k > 0 ? random_between(&random, 0, 1.2) : 0, angle = random_between(&random, -PI, PI);
            struct body body = turned_body(angle, random_between(&random, 0.5, 1.5));
            body.x = far * cos(angle);
            body.y = far * sin(angle);
            body.shape = k % 3 > 0;
            scene_add_body(&scene, body);
        }
        const narc_bodies bodies = scene_bodies(&scene);
        const uint32_t owner = 5;
        const narc_owners owners = {.owner = {&owner, 0}};
        const narc_nearest_options options = {.search.owners = &owners};
        narc_distance rows[TREES][DISCS];
        narc_box boxes[DISCS];
        const narc_points points = {.count = DISCS, .x = bodies.x, .y = bodies.y};
        for (uint32_t tree = 0; tree < TREES; tree++) {
            AUTO(narc_destroy_index_at)
            narc_index *const index = index_bodies(scene.store, &bodies, &(narc_index_options){.fast = tree}, boxes);
            assert_int_equal(narc_find_nearest(index, scene.store, &bodies, &points, &options, rows[tree], DISCS, NULL),
                             NARC_OK);
        }
        assert_memory_equal(rows[0], rows[1], sizeof rows[0]);
    }
}

/* A point on the outline of a thing is as deep as rounding, however far that is from another place of the outline: also
 * where rounding takes the point for one within. */
TEST(test_outlines_of_things) {
    enum { TRIALS = 300, POINTS = 40, TWO = 2 };
    struct test_random random = test_random_named("points, outlines");
    size_t within = 0;
    for (size_t trial = 0; trial < test_trials(TRIALS); trial++) {
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2, TWO, 1);
        const struct shape disc = {{{0, 0, 0.5, 0, 2 * PI}}, 1}, box = box_of(1, 0.8, 0);
        scene_add_shape(&scene, &disc);
        scene_add_shape(&scene, &box);
        struct body body = turned_body(random_between(&random, -PI, PI), 1);
        body.x = random_between(&random, -20, 20);
        body.y = random_between(&random, -20, 20);
        body.shape = trial % 2;
        scene_add_body(&scene, body);
        struct body beside = turned_body(random_between(&random, -PI, PI), random_between(&random, 0.5, 1.5));
        beside.x = body.x + random_between(&random, 0.3, 0.7);
        beside.y = body.y + random_between(&random, -0.3, 0.3);
        scene_add_body(&scene, beside);
        const struct reference_body others = scene_reference(&scene, 1);
        double x[POINTS], y[POINTS];
        size_t count = 0;
        for (size_t k = 0; k < POINTS; k++) {
            const double angle = random_between(&random, -PI, PI), c = (double)body.cosine, s = (double)body.sine;
            const double along = random_between(&random, -0.4, 0.4), p = body.shape ? -0.5 : 0.5 * cos(angle),
                         q = body.shape ? along : 0.5 * sin(angle), length = hypot(c, s);
            x[count] = body.x + (c * p - s * q) / length;
            y[count] = body.y + (s * p + c * q) / length;
            count += reference_point_distance(&others, x[count] - others.x, y[count] - others.y) > 1e-4;
        }
        const narc_bodies bodies = scene_bodies(&scene);
        const uint32_t owner = 5;
        const narc_owners owners = {.owner = {&owner, 0}};
        const narc_nearest_options options = {.search.owners = &owners};
        const narc_points points = {
            .count = count, .x = {x, sizeof *x, NARC_FLOAT64}, .y = {y, sizeof *y, NARC_FLOAT64}};
        narc_box boxes[TWO];
        narc_distance rows[POINTS];
        AUTO(narc_destroy_index_at) narc_index *const index = index_bodies(scene.store, &bodies, NULL, boxes);
        assert_int_equal(narc_find_nearest(index, scene.store, &bodies, &points, &options, rows, POINTS, NULL),
                         NARC_OK);
        for (size_t k = 0; k < count; k++) {
            assert_true(fabsf(rows[k].separation) < 1e-5f);
            within += rows[k].separation < 0;
        }
    }
    assert_true(within > 0);
}

TEST_MAIN("distances")
