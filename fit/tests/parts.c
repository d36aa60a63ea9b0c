/* SPDX-License-Identifier: MIT
 *
 * parts.c - outlines as convex parts: they hold the inside, reach no further than they tell, are as few as they should
 * be, and shapes fitted to them keep all of it; by samples in a grid, whose distances are found the slow obvious way.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "outlines.h"

enum { SAMPLES = 64 };

static double find_distance(const narc_contours *of, narc_point p) {
    double least = INFINITY;
    for (size_t k = 0, begin = 0; k < of->count; begin = of->ends[k++])
        for (size_t i = begin; i < of->ends[k]; i++)
            least = fmin(least, measure_distance(p, of->points[i], of->points[i + 1 < of->ends[k] ? i + 1 : begin]));
    return is_inside(of, p) ? 0 : least;
}

/* Inside all edges of a convex polygon, or within `reach` of that; of shapes: below all their support. */
static bool is_in_polygon(const narc_contours *of, narc_point p, double reach) {
    for (size_t i = 0; i < of->point_count; i++) {
        const narc_point a = of->points[i], b = of->points[(i + 1) % of->point_count];
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < -reach * hypot(b.x - a.x, b.y - a.y))
            return false;
    }
    return true;
}

/* A shape as the directions and supports of many half-planes, those of its edges among them. */
enum { DIRECTIONS = 96 + NARC_MAX_FIT_ARCS };
typedef struct walls {
    narc_point normals[DIRECTIONS];
    double supports[DIRECTIONS];
} walls;

static walls wall_in(const narc_fit_result *fit) {
    walls made;
    for (size_t k = 0; k < DIRECTIONS; k++) {
        const double angle = k < 96 ? 2 * PI * (double)k / 96 : fit->arcs[k % fit->arc_count].start;
        made.normals[k] = (narc_point){cos(angle), sin(angle)};
        made.supports[k] = (double)reference_arcs_support(fit->arcs, fit->arc_count, angle) +
                           fit->origin.x * cos(angle) + fit->origin.y * sin(angle);
    }
    return made;
}

static bool is_in_shape(const walls *of, narc_point p, double reach) {
    for (size_t k = 0; k < DIRECTIONS; k++)
        if (p.x * of->normals[k].x + p.y * of->normals[k].y > of->supports[k] + reach)
            return false;
    return true;
}

typedef struct cover {
    const char *name;
    narc_contours outline;
    narc_parts parts;
    narc_contours *polygons;
    const walls *fits; /* NULL: the polygons count */
} cover;

static bool is_covered(const cover *by, narc_point p, double reach) {
    for (size_t k = 0; k < by->parts.count; k++)
        if (by->fits ? is_in_shape(&by->fits[k], p, reach) : is_in_polygon(&by->polygons[k], p, reach))
            return true;
    return false;
}

static narc_aabb bound(const narc_contours *of) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < of->point_count; k++) {
        const narc_point p = of->points[k];
        box = (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
    }
    return box;
}

/* Samples inside, and all corners, are covered but for `missing`; what is covered is within `distance`. */
static void check_cover(const cover *by, double distance, double missing) {
    const narc_aabb box = bound(&by->outline);
    const double size = fmax(box.max_x - box.min_x, box.max_y - box.min_y), rounding = 1e-9 * size;
    for (size_t k = 0; k < by->outline.point_count; k++)
        if (!is_covered(by, by->outline.points[k], missing + rounding))
            fail_msg("%s: corner %zu is not covered", by->name, k);
    for (int i = 0; i <= SAMPLES; i++) {
        for (int j = 0; j <= SAMPLES; j++) {
            const narc_point p = {box.min_x + size * (1.2 * (i + 0.31) / SAMPLES - 0.1),
                                  box.min_y + size * (1.2 * (j + 0.17) / SAMPLES - 0.1)};
            const double away = find_distance(&by->outline, p);
            if (away == 0 && !is_covered(by, p, missing + rounding))
                fail_msg("%s: %g, %g is inside, and not covered", by->name, p.x, p.y);
            if (away > distance + rounding && is_covered(by, p, 0))
                fail_msg("%s: %g, %g is covered, but %g away, more than %g", by->name, p.x, p.y, away, distance);
        }
    }
}

static cover cut(const struct outline *of, size_t most, double tolerance, double lap) {
    cover made = {.name = of->name, .outline = flatten(of->path)};
    const narc_parts_request request = {.most = most, .tolerance = tolerance, .lap = lap};
    narc_error error;
    if (narc_cut_path(of->path, &request, &made.parts, &error) != NARC_OK)
        fail_msg("%s: %s", of->name, error.message);
    assert_in_range(made.parts.count, 1, most);
    made.polygons = malloc(made.parts.count * sizeof *made.polygons);
    assert_non_null(made.polygons);
    for (size_t k = 0; k < made.parts.count; k++)
        made.polygons[k] = flatten(made.parts.paths[k]);
    return made;
}

static void free_cover(cover *made) {
    for (size_t k = 0; k < made->parts.count; k++)
        narc_release_contours(&made->polygons[k]);
    free(made->polygons);
    narc_release_parts(&made->parts);
    narc_release_contours(&made->outline);
}

static double measure_union(const narc_fit_result *fits, size_t count) {
    AUTO(free_at) narc_arc *arcs = malloc(count * sizeof fits->arcs);
    size_t *counts = malloc(count * sizeof *counts), next = 0;
    narc_mass mass;
    assert_true(arcs && counts);
    for (size_t k = 0; k < count; k++) {
        counts[k] = fits[k].arc_count;
        for (size_t i = 0; i < fits[k].arc_count; i++, next++) {
            arcs[next] = fits[k].arcs[i];
            arcs[next].center_x += fits[k].origin.x;
            arcs[next].center_y += fits[k].origin.y;
        }
    }
    assert_int_equal(narc_compute_union_mass(arcs, counts, count, NULL, &mass, NULL), NARC_OK);
    free(counts);
    return mass.area;
}

/* Fits each part: bounding, or to either side. */
static void check_fits(cover *made, narc_fit_goal goal) {
    AUTO(free_at) narc_fit_result *fits = malloc(made->parts.count * sizeof *fits);
    double furthest = 0, area = 0;
    assert_non_null(fits);
    for (size_t k = 0; k < made->parts.count; k++) {
        const narc_fit_request request = {.arc_count = 6, .family = NARC_FIT_EDGES, .goal = goal, .starts = 1};
        narc_error error;
        if (narc_fit_path(made->parts.paths[k], &request, &fits[k], &error) != NARC_OK)
            fail_msg("%s, part %zu: %s", made->name, k, error.message);
        assert_int_equal(narc_validate_arcs(fits[k].arcs, fits[k].arc_count, &error), NARC_OK);
        furthest = fmax(furthest, fits[k].max_distance);
        area += fits[k].area;
    }
    AUTO(free_at) walls *around = malloc(made->parts.count * sizeof *around);
    assert_non_null(around);
    for (size_t k = 0; k < made->parts.count; k++)
        around[k] = wall_in(&fits[k]);
    made->fits = around;
    /* Where an arc bends by a 96th of a turn, its half-planes are further out than it is. */
    check_cover(made, made->parts.distance + furthest + 0.003, goal == NARC_FIT_BOUND_AREA ? 0 : furthest);
    const double covered = measure_union(fits, made->parts.count);
    assert_true(covered <= area * (1 + 1e-9));
    assert_true(goal != NARC_FIT_BOUND_AREA || covered >= made->parts.area * (1 - 1e-9));
    made->fits = NULL;
}

/* ---------------------------------------------------------------------------- families */

static const narc_point ell[] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
static const narc_point horseshoe[] = {{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};
static const narc_point comb[] = {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1}, {5, 3}, {4, 3},
                                  {4, 1}, {3, 1}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
static const narc_point frame[] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, hole[] = {{1, 1}, {3, 1}, {3, 3}, {1, 3}};

/* `count`: the least number there is; the area is exact. */
static void check_exact(const char *name, const narc_point *points, size_t corners, bool has_hole, double area,
                        size_t count) {
    struct outline of = make_outline(name);
    add_corners(&of, points, corners);
    if (has_hole)
        add_corners(&of, hole, 4);
    for (double tolerance = 0.03; tolerance < 0.1; tolerance *= 2) {
        cover made = cut(&of, 20, tolerance, 0);
        assert_int_equal(made.parts.count, count);
        assert_true(fabs(made.parts.area - area) <= 1e-9);
        assert_true(made.parts.distance <= tolerance);
        check_cover(&made, made.parts.distance, 0);
        if (tolerance < 0.04)
            check_fits(&made, NARC_FIT_BOUND_AREA);
        free_cover(&made);
    }
    cover fewest = cut(&of, count, 0, 0);
    assert_true(fewest.parts.distance <= 0.02);
    check_cover(&fewest, fewest.parts.distance, 0);
    free_cover(&fewest);
    cover one = cut(&of, 1, 0, 0);
    check_cover(&one, one.parts.distance, 0);
    free_cover(&one);
    free_outline(&of);
}

TEST(test_exact_families) {
    check_exact("L", ell, 6, false, 7, 2);
    check_exact("U", horseshoe, 8, false, 10, 3);
    check_exact("comb", comb, 16, false, 15, 5);
    check_exact("frame", frame, 4, true, 12, 4);
}

/* Two long parts from point to point, and one for the point that is left. */
TEST(test_star) {
    struct outline of = make_outline("star");
    narc_point points[10];
    for (size_t k = 0; k < 10; k++) {
        const double angle = PI * (double)k / 5, r = k % 2 ? 0.4 : 1;
        points[k] = (narc_point){r * cos(angle), r * sin(angle)};
    }
    add_corners(&of, points, 10);
    cover made = cut(&of, 20, 0.04, 0);
    assert_int_equal(made.parts.count, 3);
    check_cover(&made, made.parts.distance, 0);
    check_fits(&made, NARC_FIT_BOUND_AREA);
    free_cover(&made);
    free_outline(&of);
}

/* Teeth around a body: no part goes from tooth to tooth across others, unless fewer parts are asked for. */
TEST(test_no_slivers_across) {
    struct outline of = make_outline("cog");
    narc_point points[40];
    for (size_t k = 0; k < 40; k++) {
        const double angle = PI * (double)k / 20 + (k % 2 ? 0.07 : 0), r = k % 2 ? 0.8 : 1 + 0.01 * (double)(k % 7);
        points[k] = (narc_point){r * cos(angle), 0.8 * r * sin(angle)};
    }
    add_corners(&of, points, 40);
    const double size = fabs(measure_area(&(narc_contours){points, 40, (size_t[]){40}, 1, 0}, 0));
    size_t count = 41;
    for (int few = 0; few < 2; few++) {
        cover made = cut(&of, count - 1, 0.04, 0);
        double area = 0;
        for (size_t k = 0; k < made.parts.count; k++)
            area += fabs(measure_area(&made.polygons[k], 0));
        assert_true(few ? made.parts.count == count - 1 : area <= 1.1 * size);
        count = made.parts.count;
        check_cover(&made, made.parts.distance, 0);
        free_cover(&made);
    }
    free_outline(&of);
}

/* A slit and a hole that no disc of the tolerance fits into stay, however deep they are. */
TEST(test_narrow_bays) {
    static const narc_point slit[] = {{0, 0}, {4, 0}, {4, 4}, {2.04, 4}, {2.02, 0.5}, {2, 4}, {0, 4}};
    static const narc_point small[] = {{1, 1}, {1.05, 1}, {1.05, 1.05}, {1, 1.05}};
    struct outline of = make_outline("slit");
    add_corners(&of, slit, 7);
    add_corners(&of, small, 4);
    cover made = cut(&of, 20, 0.06, 0);
    assert_int_equal(made.parts.count, 1);
    check_cover(&made, made.parts.distance, 0);
    free_cover(&made);
    free_outline(&of);
}

/* Shapes that approximate lie inside in places; with laps no seam is open. */
TEST(test_laps) {
    struct outline of = make_outline("lapped U");
    add_corners(&of, horseshoe, 8);
    cover plain = cut(&of, 20, 0.05, 0), lapped = cut(&of, 20, 0.2, 0.1);
    assert_int_equal(lapped.parts.count, plain.parts.count);
    double areas[2] = {0, 0};
    for (size_t k = 0; k < plain.parts.count; k++) {
        areas[0] += fabs(measure_area(&plain.polygons[k], 0));
        areas[1] += fabs(measure_area(&lapped.polygons[k], 0));
    }
    /* Two seams of length 1, or one of 4 and ..., each lapped from both sides. */
    assert_true(areas[1] >= areas[0] + 0.35);
    assert_true(lapped.parts.distance <= 0.2);
    check_cover(&lapped, lapped.parts.distance, 0);
    check_fits(&lapped, NARC_FIT_DISTANCE);
    narc_parts none; /* laps count: without them 0.05 is enough */
    narc_error error;
    expect_error(
        narc_cut_path(of.path, &(narc_parts_request){.most = 20, .tolerance = 0.05, .lap = 0.1}, &none, &error),
        NARC_ERROR_NO_SOLUTION, &error, "the tolerance 0.05 is too small for parts, at least 0.10");
    assert_true(error.value > NARC_LAP_REACH * 0.1 && error.value < 0.12);
    free_cover(&plain);
    free_cover(&lapped);
    free_outline(&of);
}

/* A tolerance holds with laps, also beside sharp corners. */
TEST(test_laps_within_tolerances) {
    struct test_random random = test_random_named("laps");
    for (size_t trial = 0, trials = test_trials(6); trial < trials; trial++) {
        struct outline of = make_outline("lapped star");
        narc_point points[14];
        for (size_t k = 0; k < 14; k++) {
            const double a = PI * ((double)k + 0.4 * random_unit(&random)) / 7,
                         r = k % 2 ? 1 : 3 + 4 * random_unit(&random);
            points[k] = (narc_point){r * cos(a), r * sin(a)};
        }
        add_corners(&of, points, 14);
        const double tolerance = random_between(&random, 0.1, 0.6);
        cover made = cut(&of, NARC_MAX_PARTS, tolerance, tolerance * random_between(&random, 0.2, 0.8));
        assert_true(made.parts.distance <= tolerance);
        check_cover(&made, made.parts.distance, 0);
        free_cover(&made);
        free_outline(&of);
    }
}

/* Contours that cross, touch or lie on themselves or each other: the area is that of what is odd inside of one, and of
 * the union of several. */
TEST(test_crossings) {
    static const narc_point bow[] = {{0, 0}, {4, 4}, {4, 0}, {0, 4}};
    static const narc_point spike[] = {{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 20}, {5, 10}, {0, 10}};
    static const narc_point inward[] = {{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 3}, {5, 10}, {0, 10}};
    static const narc_point fold[] = {{0, 0}, {10, 0}, {5, 0}, {5, 5}};
    static const narc_point twice[] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {4, 0}, {4, 4}, {0, 4}};
    static const narc_point eight[] = {{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}};
    narc_point star[5], other[] = {{2, 2}, {6, 2}, {6, 6}, {2, 6}}, small[] = {{0.5, 0.5}, {1, 0.5}, {1, 1}, {0.5, 1}};
    for (size_t k = 0; k < 5; k++)
        star[k] = (narc_point){4 * cos(0.8 * PI * (double)k), 4 * sin(0.8 * PI * (double)k)};
    const double inner = 4 * cos(0.4 * PI) / cos(0.2 * PI);
    const struct {
        const char *name;
        const narc_point *points;
        size_t count;
        double area;
    } alone[] = {{"bow-tie", bow, 4, 8},
                 {"spike", spike, 7, 100},
                 {"inward spike", inward, 7, 100},
                 {"fold", fold, 4, 12.5},
                 {"walked twice", twice, 8, 16},
                 {"eight", eight, 6, 8},
                 {"star", star, 5, 20 * inner * sin(0.2 * PI) - 2.5 * inner * inner * sin(0.4 * PI)}};
    for (size_t k = 0; k < sizeof alone / sizeof *alone; k++) {
        struct outline of = make_outline(alone[k].name);
        add_corners(&of, alone[k].points, alone[k].count);
        for (double tolerance = 0; tolerance < 1; tolerance += 0.6) {
            cover made = cut(&of, 20, tolerance, 0);
            if (!(fabs(made.parts.area - alone[k].area) <= 1e-9 * alone[k].area))
                fail_msg("%s: the area is %.12g, not %.12g", alone[k].name, made.parts.area, alone[k].area);
            double area = 0;
            for (size_t i = 0; i < made.parts.count; i++)
                area += fabs(measure_area(&made.polygons[i], 0));
            assert_true(area >= alone[k].area * (1 - 1e-9));
            for (size_t i = 0; i < made.outline.point_count; i++)
                assert_true(is_covered(&made, made.outline.points[i], 1e-9));
            free_cover(&made);
        }
        free_outline(&of);
    }
    struct outline of = make_outline("two squares and a hole");
    add_corners(&of, frame, 4);
    add_corners(&of, other, 4);
    add_corners(&of, small, 4);
    cover made = cut(&of, 20, 0.05, 0);
    assert_true(fabs(made.parts.area - 27.75) <= 1e-9);
    free_cover(&made);
    free_outline(&of);
}

/* In how many of the contours a point is, and how far it is from all of them. */
static size_t count_around(const narc_contours *of, narc_point p, double *out_distance) {
    size_t around = 0;
    *out_distance = INFINITY;
    for (size_t k = 0; k < of->count; k++) {
        const size_t begin = k ? of->ends[k - 1] : 0;
        size_t end = of->ends[k] - begin;
        const narc_contours alone = {of->points + begin, end, &end, 1, 0};
        const double distance = find_distance(&alone, p);
        around += distance == 0;
        *out_distance = fmin(*out_distance, distance);
    }
    return around;
}

/* Contours that cross themselves and each other, or are holes that cross: all are cut within the tolerance. What is in one
 * contour alone is inside; what is in none is not, and covered only near one. The area is between those of both. */
TEST(test_random_crossings) {
    struct test_random random = test_random_named("crossings to cut");
    for (size_t trial = 0, trials = test_trials(12); trial < trials; trial++) {
        struct outline of = make_outline("crossing contours");
        const size_t contours = 2 + random_below(&random, 3), kind = trial % 3;
        for (size_t k = 0; k < contours; k++) {
            narc_point points[12];
            const size_t count = 3 + random_below(&random, 9);
            const double x = random_between(&random, 0, 4), y = random_between(&random, 0, 4),
                         r = random_between(&random, 1, 3);
            for (size_t i = 0; i < count; i++) {
                const double a = 2 * PI * ((double)i + 0.6 * random_unit(&random)) / (double)count,
                             far = r * random_between(&random, 0.4, 1);
                points[i] = kind < 2
                                ? (narc_point){x + far * cos(a), y + far * sin(a)}
                                : (narc_point){x + random_between(&random, -r, r), y + random_between(&random, -r, r)};
            }
            add_corners(&of, points, count);
        }
        const double tolerance = random_between(&random, 0.02, 0.3);
        cover made = cut(&of, NARC_MAX_PARTS, tolerance, 0);
        assert_true(made.parts.distance <= tolerance);
        const narc_aabb box = bound(&made.outline);
        const double width = box.max_x - box.min_x + 1, height = box.max_y - box.min_y + 1;
        size_t alone = 0, any = 0;
        for (int i = 0; i < SAMPLES * SAMPLES; i++) {
            const narc_point p = {box.min_x - 0.5 + width * (i % SAMPLES + 0.31) / SAMPLES,
                                  box.min_y - 0.5 + height * (i / SAMPLES + 0.17) / SAMPLES};
            double distance;
            const size_t around = count_around(&made.outline, p, &distance);
            alone += around == 1;
            any += around > 0;
            if (around == 1 && !is_covered(&made, p, 1e-9))
                fail_msg("trial %zu: %g, %g is inside, and not covered", trial, p.x, p.y);
            if (distance > made.parts.distance + 1e-9 && is_covered(&made, p, 0))
                fail_msg("trial %zu: %g, %g is covered, but %g away", trial, p.x, p.y, distance);
        }
        const double cell = width * height / (SAMPLES * SAMPLES), room = 0.5 * cell * SAMPLES; /* cells on borders */
        assert_true(made.parts.area >= cell * (double)alone - room && made.parts.area <= cell * (double)any + room);
        free_cover(&made);
        free_outline(&of);
    }
}

/* Waves round a ring, and another one inside. */
TEST(test_random_rings) {
    struct test_random random = test_random_named("rings to cut");
    for (size_t trial = 0, trials = test_trials(4); trial < trials; trial++) {
        struct outline of = make_outline("ring");
        enum { POINTS = 120 };
        for (int inner = 0; inner < 2; inner++) {
            narc_point points[POINTS];
            double height[7], phase[7];
            for (int w = 0; w < 7; w++) {
                height[w] = 0.1 * random_unit(&random);
                phase[w] = 2 * PI * random_unit(&random);
            }
            for (size_t k = 0; k < POINTS; k++) {
                const double a = 2 * PI * (double)k / POINTS;
                double r = 1;
                for (int w = 0; w < 7; w++)
                    r += height[w] * cos((w + 1) * a + phase[w]);
                r = fmax(0.3, r) * (inner ? 0.25 : 1);
                points[k] = (narc_point){r * cos(a), r * sin(a)};
            }
            add_corners(&of, points, POINTS);
            if (trial % 2)
                break;
        }
        const double tolerance = 0.02 + 0.2 * random_unit(&random);
        cover made = cut(&of, NARC_MAX_PARTS, tolerance, 0);
        assert_true(made.parts.distance <= tolerance);
        check_cover(&made, made.parts.distance, 0);
        free_cover(&made);
        cover few = cut(&of, 1 + random_below(&random, 8), 0, 0);
        check_cover(&few, few.parts.distance, 0);
        free_cover(&few);
        free_outline(&of);
    }
}

/* Points anywhere: contours cross themselves, lie on lines, come twice. All points are held, and nothing hangs. */
TEST(test_any_points) {
    struct test_random random = test_random_named("points to cut");
    for (size_t trial = 0, trials = test_trials(16); trial < trials; trial++) {
        struct outline of = make_outline("any points");
        narc_point points[40];
        const size_t count = 2 + random_below(&random, 38), lattice = 1 + random_below(&random, 20);
        for (size_t k = 0; k < count; k++)
            points[k] =
                (narc_point){(double)random_below(&random, lattice), (double)random_below(&random, lattice + 1)};
        points[0].x += 1;
        add_corners(&of, points, count / 2);
        add_corners(&of, points + count / 2, count - count / 2);
        narc_parts parts;
        const narc_parts_request request = {.most = NARC_MAX_PARTS, .tolerance = trial % 2 ? 0.3 : 0};
        narc_error error;
        const narc_status status = narc_cut_path(of.path, &request, &parts, &error);
        if (status == NARC_OK) {
            narc_release_parts(&parts);
            cover made = cut(&of, NARC_MAX_PARTS, request.tolerance, 0);
            for (size_t k = 0; k < made.outline.point_count; k++)
                assert_true(is_covered(&made, made.outline.points[k], 1e-9));
            free_cover(&made);
        } else {
            assert_true(status == NARC_ERROR_SIZE || status == NARC_ERROR_NO_SOLUTION || status == NARC_ERROR_COUNT);
        }
        free_outline(&of);
    }
}

TEST(test_errors) {
    struct outline of = make_box(2, 1);
    narc_parts parts, junk;
    narc_error error = {0};
    memset(&parts, 0x5a, sizeof parts);
    memset(&junk, 0x5a, sizeof junk);
    const struct {
        narc_parts_request request;
        narc_status status;
        const char *words;
    } wrong[] = {{{.most = 0}, NARC_ERROR_COUNT, "0 parts"},
                 {{.most = NARC_MAX_PARTS + 1}, NARC_ERROR_COUNT, "257 parts"},
                 {{.most = 4, .tolerance = -1}, NARC_ERROR_SIZE, "tolerance"},
                 {{.most = 4, .tolerance = NAN}, NARC_ERROR_SIZE, "tolerance"},
                 {{.most = 4, .lap = -1}, NARC_ERROR_SIZE, "lap"},
                 {{.most = 4, .flatness = -1}, NARC_ERROR_SIZE, "flatness"},
                 {{.most = 4, .tolerance = 1e-9}, NARC_ERROR_NO_SOLUTION, "too small"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        expect_error(narc_cut_path(of.path, &wrong[k].request, &parts, &error), wrong[k].status, &error,
                     wrong[k].words);
        assert_memory_equal(&parts, &junk, sizeof parts);
    }
    const narc_parts_request one = {.most = 1, .tolerance = 0.01};
    assert_int_equal(narc_cut_path(NULL, &one, &parts, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_cut_path(of.path, NULL, &parts, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_cut_path(of.path, &one, NULL, NULL), NARC_ERROR_ARGUMENT);
    struct outline bent = make_outline("bent"), empty = make_outline("empty");
    add_corners(&bent, ell, 6);
    expect_error(narc_cut_path(bent.path, &one, &parts, &error), NARC_ERROR_NO_SOLUTION, &error, "1 parts");
    expect_error(narc_cut_path(empty.path, &one, &parts, &error), NARC_ERROR_COUNT, &error, "no points");
    free_outline(&bent);
    free_outline(&empty);
    free_outline(&of);
}

TEST_MAIN("parts")
