/* SPDX-License-Identifier: MIT
 *
 * polylines.c - chains of many lines, such as traced outlines, as few arcs: how many, how far from the chain, joined.
 */
#include <math.h>
#include <stdlib.h>

#include "families.h"
#include "fit_support.h"
#include "narc_chains.h"
#include "narc_fit.h"

static narc_point minus(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }

/* A point of an arc, by its definition in the header. */
static narc_point arc_point(const narc_curve_arc *arc, double part) {
    if (isinf(arc->radius)) {
        const narc_point e = minus(arc->end, arc->start);
        return (narc_point){arc->start.x + part * e.x, arc->start.y + part * e.y};
    }
    const narc_point from = minus(arc->start, arc->center);
    const double c = cos(part * arc->turn), s = sin(part * arc->turn);
    return (narc_point){arc->center.x + c * from.x - s * from.y, arc->center.y + s * from.x + c * from.y};
}

/* Both ways, by samples, which miss `slop` at most: the chain's closed lines and the arcs. */
static void check_near(const char *name, const narc_point *points, size_t count, const narc_arc_chains *chains,
                       double tolerance, double slop) {
    enum { SAMPLES = 50 };
    AUTO(free_at) narc_point *samples = malloc(chains->arc_count * (SAMPLES + 1) * sizeof *samples);
    size_t sample_count = 0;
    for (size_t i = 0; i < chains->arc_count; i++)
        for (size_t s = 0; s <= SAMPLES; s++)
            samples[sample_count++] = arc_point(&chains->arcs[i], (double)s / SAMPLES);
    for (size_t s = 0; s < sample_count; s++) {
        double least = INFINITY;
        for (size_t k = 0; k < count; k++)
            least = fmin(least, measure_distance(samples[s], points[k], points[(k + 1) % count]));
        if (!(least <= tolerance * (1 + 1e-9)))
            fail_msg("%s: the arcs are %g from the chain, the tolerance is %g", name, least, tolerance);
    }
    for (size_t k = 0; k < count; k++) {
        double least = INFINITY;
        for (size_t s = 0; s + 1 < sample_count; s++)
            least = fmin(least, measure_distance(points[k], samples[s], samples[s + 1]));
        if (!(least <= tolerance + slop))
            fail_msg("%s: point %zu is %g from the arcs, the tolerance is %g", name, k, least, tolerance);
    }
    assert_true(chains->distance <= tolerance);
}

/* The store takes a chain. */
static void expect_taken(const narc_arc *arcs, size_t count, bool closed) {
    narc_shapes *store = empty_store();
    narc_error error;
    size_t entries;
    if (narc_add_chain(store, arcs, count, &(narc_chain_options){.closed = closed}, NULL, 0, &entries, &error) !=
        NARC_ERROR_CAPACITY)
        fail_msg("the store refuses a chain: %s", error.message);
    narc_destroy_shapes(store);
}

/* The closed chain in the form of shapes: arcs lie on its pieces, edges are its lines, and normals go on where an arc
 * follows. */
static void check_arcs(const narc_arc_chains *chains) {
    AUTO(free_at) narc_arc *arcs = malloc((3 * chains->arc_count + 1) * sizeof *arcs);
    size_t count, curved = 0, met = 0;
    assert_non_null(arcs);
    assert_int_equal(narc_describe_chain(chains->arcs, chains->arc_count, true, arcs, &count, NULL), NARC_OK);
    expect_taken(arcs, count, true);
    double turn = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *arc = &arcs[k], *next = &arcs[(k + 1) % count];
        const double sweep = arc->end - arc->start;
        assert_true(sweep != 0 && (sweep < 0) == (signbit(arc->radius) != 0));
        assert_true(fabs(sin(next->start - arc->end)) <= 1e-5 && cos(next->start - arc->end) > 0);
        turn += sweep;
        if (arc->radius == 0)
            continue;
        for (size_t i = 0; i < chains->arc_count; i++) {
            const narc_curve_arc *piece = &chains->arcs[i];
            const narc_point from = {arc->center_x + arc->radius * cos(arc->start),
                                     arc->center_y + arc->radius * sin(arc->start)},
                             to = {arc->center_x + arc->radius * cos(arc->end),
                                   arc->center_y + arc->radius * sin(arc->end)};
            const double scale = 1e-9 * (1 + fabs(arc->radius));
            met += piece->turn != 0 && hypot(from.x - piece->start.x, from.y - piece->start.y) <= scale &&
                   hypot(to.x - piece->end.x, to.y - piece->end.y) <= scale;
        }
        curved++;
    }
    assert_int_equal(met, curved);
    assert_true(fabs(turn - 2 * PI) <= 1e-5 * (double)count); /* once round, the inside on the left */
}

/* How many arcs and lines, which join, and with a common tangent but at `corners` places. */
static size_t fit_ring(const char *name, const narc_point *points, size_t count, double tolerance, size_t corners) {
    narc_path *path = make_path();
    narc_error error;
    narc_arc_chains chains;
    draw_polygon(path, points, count);
    if (narc_fit_chains(path, tolerance, false, &chains, &error) != NARC_OK)
        fail_msg("%s: %s", name, error.message);
    assert_int_equal(chains.count, 1);
    size_t bends = 0;
    for (size_t i = 0; i < chains.arc_count; i++) {
        const narc_curve_arc *arc = &chains.arcs[i], *next = &chains.arcs[(i + 1) % chains.arc_count];
        assert_true(arc->end.x == next->start.x && arc->end.y == next->start.y);
        const narc_point end = arc_point(arc, 1), in = minus(end, arc_point(arc, 1 - 1e-4));
        const narc_point out = minus(arc_point(next, 1e-4), next->start);
        assert_true(hypot(end.x - arc->end.x, end.y - arc->end.y) <= 1e-9);
        bends += fabs(atan2(in.x * out.y - in.y * out.x, in.x * out.x + in.y * out.y)) > 1e-3;
    }
    if (bends > corners)
        fail_msg("%s: %zu corners, but the chain has %zu", name, bends, corners);
    check_arcs(&chains);
    check_near(name, points, count, &chains, tolerance, 1e-3 * tolerance + 1e-3);
    const size_t arcs = chains.arc_count;
    narc_release_chains(&chains);
    if (narc_fit_fewest_chains(path, tolerance, false, &chains, &error) != NARC_OK)
        fail_msg("%s: %s", name, error.message);
    for (size_t i = 0; i < chains.arc_count; i++) {
        const narc_curve_arc *arc = &chains.arcs[i], *next = &chains.arcs[(i + 1) % chains.arc_count];
        assert_true(arc->end.x == next->start.x && arc->end.y == next->start.y);
    }
    check_arcs(&chains);
    check_near(name, points, count, &chains, tolerance, 1e-3 * tolerance + 1e-3);
    if (chains.arc_count > arcs)
        fail_msg("%s: the fewest are %zu pieces, but %zu smooth ones serve", name, chains.arc_count, arcs);
    narc_release_chains(&chains);
    narc_destroy_path(path);
    return arcs;
}

/* ---------------------------------------------------------------------------- the fewest pieces */

static size_t count_fewest(narc_path *path, double tolerance) {
    AUTO(narc_release_chains) narc_arc_chains chains;
    narc_error error;
    expect_ok(narc_fit_fewest_chains(path, tolerance, false, &chains, &error), &error);
    return chains.arc_count;
}

enum { FEW = 60 };

/* Is some arc between two points of a ring, by trial of many, near those between them? */
static bool can_join(const narc_point *points, size_t from, size_t length, double tolerance) {
    enum { TRIALS = 201 };
    const narc_point p = points[from], q = points[(from + length) % FEW];
    const double x = q.x - p.x, y = q.y - p.y;
    for (int k = 0; k < TRIALS; k++) {
        const double bulge = (double)k / (TRIALS / 2) - 1, up = bulge == 0 ? 0 : (1 - bulge * bulge) / (4 * bulge);
        const narc_point center = {(p.x + q.x) / 2 - up * y, (p.y + q.y) / 2 + up * x};
        const double radius = hypot(p.x - center.x, p.y - center.y);
        bool near = true;
        for (size_t i = 1; near && i < length; i++) {
            const narc_point r = points[(from + i) % FEW];
            const double along = ((r.x - p.x) * x + (r.y - p.y) * y) / (x * x + y * y);
            const double off = bulge == 0 ? fabs(x * (r.y - p.y) - y * (r.x - p.x)) / hypot(x, y)
                                          : fabs(hypot(r.x - center.x, r.y - center.y) - radius);
            near = off <= tolerance && along >= 0 && along <= 1;
        }
        if (near)
            return true;
    }
    return false;
}

/* The fewest pieces from point to point of a ring, of all that there are. */
static size_t search_ring(const narc_point *points, double tolerance) {
    static bool joins[FEW][FEW];
    size_t least = FEW;
    for (size_t i = 0; i < FEW; i++)
        for (size_t n = 1; n < FEW; n++)
            joins[i][n] = can_join(points, i, n, tolerance);
    for (size_t first = 0; first < FEW; first++) {
        size_t best[FEW + 1] = {0};
        for (size_t n = 1; n <= FEW; n++) {
            best[n] = FEW;
            for (size_t m = n == FEW ? 1 : 0; m < n; m++)
                if (joins[(first + m) % FEW][n - m] && best[m] + 1 < best[n])
                    best[n] = best[m] + 1;
        }
        least = best[FEW] < least ? best[FEW] : least;
    }
    return least;
}

/* No more than a slow search of all pieces between points finds, which looks at points alone: lines between them are up to a
 * sixth of the tolerance further away. */
TEST(test_fewest) {
    struct test_random random = test_random_named("fewest");
    for (size_t trial = 0, trials = test_trials(12); trial < trials; trial++) {
        const double height = 0.25 * random_unit(&random), waves = 2 + (double)(trial % 4);
        narc_point points[FEW];
        for (size_t k = 0; k < FEW; k++) {
            const double a = 2 * PI * (double)k / FEW, r = 10 * (1 + height * cos(waves * a));
            points[k] = (narc_point){r * cos(a), r * sin(a)};
        }
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        draw_polygon(path, points, FEW);
        const size_t found = count_fewest(path, 0.4), least = search_ring(points, 0.4 * 5 / 6);
        if (found > least)
            fail_msg("%zu pieces, %zu serve", found, least);
    }
}

/* Is some circle or line near all points of a run, by trial of those through three places across its first, middle and last
 * point? The ends are free, so no chain within the tolerance has a piece that is near more; the places are an eighth of it
 * apart, what lies between any of them and the next is less than a tenth of it away. */
static bool is_one_piece(const narc_point *points, size_t total, size_t from, size_t length, double tolerance) {
    enum { SIDE = 9, ALL = 2 * SIDE + 1 };
    narc_point places[3][ALL];
    if (length < 3)
        return true;
    for (size_t i = 0; i < 3; i++) {
        const size_t at = from + i * (length - 1) / 2;
        const narc_point before = points[(at + total - 1) % total], p = points[at % total],
                         next = points[(at + 1) % total];
        const double x = next.x - before.x, y = next.y - before.y, step = tolerance / 8 / hypot(x, y);
        for (int k = 0; k < ALL; k++)
            places[i][k] = (narc_point){p.x - step * (k - SIDE) * y, p.y + step * (k - SIDE) * x};
    }
    for (size_t trial = 0; trial < (size_t)ALL * ALL * ALL; trial++) {
        const narc_point a = places[0][trial % ALL], b = places[1][trial / ALL % ALL], c = places[2][trial / ALL / ALL];
        /* |p|^2 - 2 m.p = k from a: two equations for m. */
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, turn = 2 * (bx * cy - by * cx);
        const double bb = bx * bx + by * by, cc = cx * cx + cy * cy, x = (bb * cy - cc * by) / turn,
                     y = (cc * bx - bb * cx) / turn, radius = hypot(x, y);
        bool near = true;
        for (size_t k = 0; near && k < length; k++) {
            const narc_point p = points[(from + k) % total];
            const double off = radius < 1e6 ? hypot(p.x - a.x - x, p.y - a.y - y) - radius
                                            : ((p.x - a.x) * cy - (p.y - a.y) * cx) / sqrt(cc);
            near = fabs(off) <= 1.1 * tolerance;
        }
        if (near)
            return true;
    }
    return false;
}

enum { MANY = 240 };

/* No chain within the tolerance of a ring's points has fewer pieces: each is near a run of them. */
static size_t bound_ring(const narc_point *points, double tolerance) {
    size_t runs[MANY], least = MANY;
    for (size_t i = 0; i < MANY; i++) { /* a run has a shorter one from the next point */
        runs[i] = i && runs[i - 1] > 1 ? runs[i - 1] - 1 : 1;
        while (runs[i] < MANY && is_one_piece(points, MANY, i, runs[i] + 1, tolerance))
            runs[i]++;
    }
    for (size_t first = 0; first < MANY; first++) {
        size_t count = 0;
        for (size_t at = 0; at < MANY; at += runs[(first + at) % MANY])
            count++;
        least = count < least ? count : least;
    }
    return least;
}

/* Most are as few as there can be, by a search that looks at no way of joining them; where that says less, by how much. */
TEST(fewest_are_the_fewest) {
    static const struct {
        double waves, height;
        size_t over;
    } rings[] = {{2, 0.055347, 0}, {3, 0.064697, 0}, {3, 0.257285, 0}, {4, 0.227056, 0}, {5, 0.180097, 0},
                 {5, 0.196051, 0}, {2, 0.129575, 1}, {4, 0.156838, 1}, {5, 0.221184, 4}};
    for (size_t i = 0; i < sizeof rings / sizeof *rings; i++) {
        narc_point points[MANY];
        for (size_t k = 0; k < MANY; k++) {
            const double a = 2 * PI * (double)k / MANY, r = 10 * (1 + rings[i].height * cos(rings[i].waves * a));
            points[k] = (narc_point){r * cos(a), r * sin(a)};
        }
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        draw_polygon(path, points, MANY);
        const size_t found = count_fewest(path, 0.2), least = bound_ring(points, 0.2);
        assert_in_range(found, least, least + rings[i].over);
    }
}

/* A circle is two arcs, and a rectangle with round corners four lines and four arcs, exactly. */
TEST(test_exact_shapes) {
    static const double turn[] = {0, 1, 0, -1, 0};
    narc_path *path = make_path();
    narc_arc_chains chains;
    narc_error error;
    expect_ok(narc_move_to(path, &(narc_point){50, 0}, &error), &error);
    expect_ok(narc_arc_to(path, &(narc_point){0, 50}, &(narc_point){-50, 0}, &error), &error);
    expect_ok(narc_arc_to(path, &(narc_point){0, -50}, &(narc_point){50, 0}, &error), &error);
    expect_ok(narc_fit_fewest_chains(path, 0.02, false, &chains, &error), &error);
    assert_int_equal(chains.arc_count, 2);
    for (size_t k = 0; k < 2; k++)
        assert_true(fabs(chains.arcs[k].radius - 50) < 1e-9 &&
                    hypot(chains.arcs[k].center.x, chains.arcs[k].center.y) < 1e-9);
    narc_release_chains(&chains);
    narc_destroy_path(path);
    path = make_path();
    for (int k = 0; k < 4; k++) {
        const double c = turn[k + 1], s = turn[k], m = sqrt(0.5);
        const narc_point at = {30 * (c - s > 0 ? 1 : -1), 20 * (c + s > 0 ? 1 : -1)};
        const narc_point from = {at.x + 5 * c, at.y + 5 * s}, to = {at.x - 5 * s, at.y + 5 * c};
        const narc_point middle = {at.x + 5 * m * (c - s), at.y + 5 * m * (c + s)};
        expect_ok((k ? narc_line_to : narc_move_to)(path, &from, &error), &error);
        expect_ok(narc_arc_to(path, &middle, &to, &error), &error);
    }
    for (double tolerance = 0.1; tolerance > 1e-3; tolerance /= 5) {
        size_t lines = 0;
        expect_ok(narc_fit_fewest_chains(path, tolerance, false, &chains, &error), &error);
        assert_int_equal(chains.arc_count, 8);
        for (size_t k = 0; k < 8; k++) {
            lines += chains.arcs[k].turn == 0;
            assert_true(chains.arcs[k].turn == 0 || fabs(chains.arcs[k].radius - 5) < 1e-9);
        }
        assert_int_equal(lines, 4);
        narc_release_chains(&chains);
    }
    narc_destroy_path(path);
}

/* Of circles, too, where two halves have to meet just across: the smooth pieces are taken where they are fewer. */
TEST(fewest_are_no_more_than_smooth_ones) {
    for (size_t corners = 100; corners <= 500; corners += 100) {
        for (double tolerance = 0.1; tolerance > 1e-3; tolerance /= 4) {
            AUTO(narc_destroy_path_at) narc_path *path = make_path();
            AUTO(narc_release_chains) narc_arc_chains chains;
            narc_error error;
            narc_point points[500];
            for (size_t k = 0; k < corners; k++) {
                const double angle = 2 * PI * (double)k / (double)corners;
                points[k] = (narc_point){2 * cos(angle), 2 * sin(angle)};
            }
            draw_polygon(path, points, corners);
            expect_ok(narc_fit_chains(path, tolerance, false, &chains, &error), &error);
            const size_t fewest = count_fewest(path, tolerance);
            if (fewest > chains.arc_count)
                fail_msg("%zu corners, tolerance %g: %zu pieces, but %zu smooth ones", corners, tolerance, fewest,
                         chains.arc_count);
        }
    }
}

/* ---------------------------------------------------------------------------- smooth chains */

enum { COUNT = 600 };

/* A circle is four arcs, an ellipse some more: of q, the change of curvature along it, follows their least number. */
TEST(test_smooth_rings) {
    static const double tolerances[] = {0.02, 0.002};
    static const size_t most[2][2] = {{4, 12}, {6, 24}};
    for (size_t t = 0; t < 2; t++) {
        for (size_t shape = 0; shape < 2; shape++) {
            narc_point points[COUNT];
            for (size_t k = 0; k < COUNT; k++) {
                const double a = 2 * PI * (double)k / COUNT;
                points[k] = (narc_point){cos(a), (shape ? 0.5 : 1) * sin(a)};
            }
            const size_t arcs = fit_ring(shape ? "ellipse" : "circle", points, COUNT, tolerances[t], 0);
            if (arcs > most[t][shape])
                fail_msg("shape %zu, tolerance %g: %zu arcs", shape, tolerances[t], arcs);
        }
    }
}

/* Sides of many lines are one line each, wherever the chain begins. */
TEST(test_square) {
    static const narc_point corners[] = {{0, 0}, {3, 1}, {2, 4}, {-1, 3}};
    for (size_t first = 0; first < COUNT; first += 75 * stride(4)) {
        narc_point points[COUNT];
        for (size_t k = 0; k < COUNT; k++) {
            const size_t place = (k + first + 7) % COUNT, side = place / (COUNT / 4);
            const double part = (double)(place % (COUNT / 4)) / (COUNT / 4);
            const narc_point p = corners[side], e = minus(corners[(side + 1) % 4], p);
            points[k] = (narc_point){p.x + part * e.x, p.y + part * e.y};
        }
        assert_int_equal(fit_ring("square", points, COUNT, 0.01, 4), 4);
    }
}

/* Waves of several lengths, and noise below the tolerance: whatever comes out is near. */
TEST(test_random_rings) {
    struct test_random random = test_random_named("rings");
    for (size_t trial = 0, trials = test_trials(12); trial < trials; trial++) {
        const double tolerance = pow(10, -1 - 3 * random_unit(&random)), noise = 0.2 * tolerance * (double)(trial % 2);
        double height[6], phase[6];
        for (int w = 0; w < 6; w++) {
            height[w] = 0.3 * random_unit(&random) / (w + 1);
            phase[w] = 2 * PI * random_unit(&random);
        }
        narc_point points[COUNT];
        for (size_t k = 0; k < COUNT; k++) {
            const double a = 2 * PI * (double)k / COUNT;
            double r = 1 + noise * random_unit(&random);
            for (int w = 0; w < 6; w++)
                r += height[w] * cos((w + 1) * a + phase[w]);
            points[k] = (narc_point){r * cos(a), r * sin(a)};
        }
        fit_ring("waves", points, COUNT, tolerance, COUNT);
    }
}

/* Lines that are nearly one, and arcs that are nearly lines: the chain keeps the tolerance, and the store takes it. */
TEST(test_flat_chains) {
    static const double tolerances[] = {0.3, 0.01, 1e-4};
    for (int bow = 0; bow < 14; bow += (int)stride(3)) {
        const double depth = (bow % 2 ? -1 : 1) * 2 * pow(10, -bow / 2); /* from 2 % of the length to less than 1e-7 */
        narc_point points[103];
        for (size_t k = 0; k <= 100; k++)
            points[k] = (narc_point){(double)k, depth * (1 - pow((double)k / 50 - 1, 2))};
        points[101] = (narc_point){100, 50};
        points[102] = (narc_point){0, 50};
        for (size_t t = 0; t < 3; t++)
            fit_ring("bow", points, 103, tolerances[t], 103);
    }
    const narc_point bent[] = {{0, 0}, {50, 0.1}, {100, 0}, {100, 100}, {0, 100}};
    fit_ring("bent", bent, 5, 0.05, 5);
}

/* A slot that is narrower than arcs may be off: they come nearer. */
TEST(test_narrow_slots) {
    enum { SIDE = 60 };
    narc_point points[2 * SIDE + 4] = {{0, 0}, {10, 0}};
    size_t count = 2;
    for (int side = 0; side < 2; side++)
        for (size_t k = 0; k < SIDE; k++) { /* from the right to x = 1, and back */
            const double x = 1 + 9 * (double)(side ? k : SIDE - 1 - k) / (SIDE - 1);
            points[count++] = (narc_point){x, 5 + 0.4 * sin(x) + (side ? 0.02 : 0)};
        }
    points[count++] = (narc_point){10, 20};
    points[count++] = (narc_point){0, 20};
    fit_ring("slot", points, count, 0.05, count);
}

/* A slot that is thousands of times thinner than the tolerance: lines alone keep it whole. */
TEST(test_thinnest_slots) {
    enum { SIDE = 300 }; /* chords are nearer than 6e-5 */
    for (double width = 2e-3; width > 2e-4; width /= 3) {
        narc_point points[2 * SIDE];
        for (size_t k = 0; k < 2 * SIDE; k++) {
            const double x = 10 * (k < SIDE ? (double)k : (double)(2 * SIDE) - 1.5 - (double)k) / (SIDE - 1);
            points[k] = (narc_point){x, 0.4 * sin(x) + (k < SIDE ? 0 : width)};
        }
        fit_ring("thinnest slot", points, 2 * SIDE, 0.5, 2 * SIDE);
    }
}

/* Contours that are nearer to each other than the tolerance: their chains do not cross. Seen in many lines. */
TEST(test_near_contours) {
    enum { SIDES = 200, STEPS = 64 };
    struct test_random random = test_random_named("near contours");
    for (size_t trial = 0, trials = test_trials(6); trial < trials; trial++) {
        const double tolerance = 0.05, gap = tolerance * random_log_between(&random, 1e-3, 0.5);
        double phase[6];
        for (int w = 0; w < 6; w++)
            phase[w] = 2 * PI * random_unit(&random);
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        for (int inner = 0; inner < 2; inner++) {
            narc_point points[SIDES];
            for (size_t k = 0; k < SIDES; k++) {
                const double a = 2 * PI * ((double)k + 0.37 * inner) / SIDES;
                double r = inner ? 1 - gap - 1e-4 : 1; /* chords are nearer by less than 1e-4 */
                for (int w = 0; w < 6; w++)
                    r += 0.15 / (w + 1) * cos((w + 1) * a + phase[w]);
                points[k] = (narc_point){4 * r * cos(a), 4 * r * sin(a)};
            }
            draw_polygon(path, points, SIDES);
        }
        AUTO(narc_release_chains) narc_arc_chains chains;
        narc_error error;
        expect_ok(narc_fit_chains(path, tolerance, false, &chains, &error), &error);
        assert_int_equal(chains.count, 2);
        assert_true(chains.distance <= tolerance);
        /* All of the inner one, a sample each 64th of a piece, is inside the outer one. */
        AUTO(free_at)
        narc_contours outer = {.count = 1, .point_count = STEPS * chains.ends[0], .ends = &outer.point_count};
        outer.points = malloc(outer.point_count * sizeof *outer.points);
        assert_non_null(outer.points);
        for (size_t i = 0; i < outer.point_count; i++)
            outer.points[i] = arc_point(&chains.arcs[i / STEPS], (double)(i % STEPS) / STEPS);
        for (size_t i = outer.point_count; i < STEPS * chains.arc_count; i++) {
            const narc_point p = arc_point(&chains.arcs[i / STEPS], (double)(i % STEPS) / STEPS);
            double least = INFINITY;
            for (size_t k = 0; k < outer.point_count && !is_inside(&outer, p); k++)
                least = fmin(least, measure_distance(p, outer.points[k], outer.points[(k + 1) % outer.point_count]));
            if (least < INFINITY && least > 1e-4) /* the lines are that near to the arcs */
                fail_msg("gap %g: the chain of the hole leaves that around it at %g, %g", gap, p.x, p.y);
        }
    }
}

/* Arcs of more than half a turn become two. */
TEST(test_large_turns) {
    for (int way = 0; way < 2; way++) {
        const double turn = way ? -1.5 * PI : 1.5 * PI;
        const narc_curve_arc pieces[] = {{{1, 0}, {0, way ? 1 : -1}, {0, 0}, 1, turn},
                                         {{0, way ? 1 : -1}, {3, way ? 1 : -1}, {0, 0}, INFINITY, 0}};
        narc_arc arcs[7];
        size_t count;
        assert_int_equal(narc_describe_chain(pieces, 2, false, arcs, &count, NULL), NARC_OK);
        assert_int_equal(count, 3); /* two halves, and the end of the line */
        assert_true(fabs(arcs[0].end - arcs[0].start - turn / 2) <= 1e-12 && arcs[1].start == arcs[0].end);
        expect_taken(arcs, count, false);
    }
}

/* Lines that turn by less and less: by less than a corner must, and together by more. */
TEST(test_slight_turns) {
    for (double turn = 2e-7; turn < 1e-4; turn *= 1.3) {
        narc_curve_arc pieces[40];
        narc_arc arcs[121];
        size_t count;
        narc_point at = {0, 0};
        double angle = 0.3;
        for (size_t k = 0; k < 40; k++, angle += k % 9 < 6 ? turn : -turn) {
            const narc_point end = {at.x + cos(angle), at.y + sin(angle)};
            pieces[k] = (narc_curve_arc){at, end, at, INFINITY, 0};
            at = end;
        }
        assert_int_equal(narc_describe_chain(pieces, 40, false, arcs, &count, NULL), NARC_OK);
        expect_taken(arcs, count, false);
    }
}

/* Lines that cross or lie on each other, of one contour or of two, are refused, with contour and line. */
TEST(test_crossings) {
    static const narc_point bow[] = {{0, 0}, {4, 4}, {4, 0}, {0, 4}}, box[] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}},
                            other[] = {{2, 2}, {6, 2}, {6, 6}, {2, 6}}, beside[] = {{4, 0}, {8, 0}, {8, 4}, {4, 4}},
                            across[] = {{4, 4}, {8, 4}, {8, 8}, {4, 8}},
                            spike[] = {{0, 0}, {4, 0}, {4, 9}, {4, 4}, {0, 4}};
    const struct {
        const narc_point *first, *second;
        size_t count;
        const char *message;
    } cases[] = {{bow, NULL, 4, "contour 0: line 0 crosses line 2 of contour 0 at (2, 2)"},
                 {spike, NULL, 5, "contour 0: line 1 meets line 2 of contour 0 at (4, 4)"},
                 {box, other, 4, "contour 0: line 1 crosses line 0 of contour 1 at (4, 2)"},
                 {box, beside, 4, NULL},
                 {box, across, 4, NULL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        narc_arc_chains chains;
        narc_error error;
        draw_polygon(path, cases[k].first, cases[k].count);
        if (cases[k].second)
            draw_polygon(path, cases[k].second, cases[k].count);
        const narc_status status = narc_fit_chains(path, 0.05, false, &chains, &error);
        if (cases[k].message)
            expect_error(status, NARC_ERROR_NOT_SIMPLE, &error, cases[k].message);
        else
            expect_ok(status, &error);
        if (!status)
            narc_release_chains(&chains);
    }
}

TEST_MAIN("polylines")
