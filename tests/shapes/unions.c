/* SPDX-License-Identifier: MIT
 *
 * unions.c - the mass of compounds: families whose union is known, random ones against the outlines of their samples,
 * turned and reordered ones against themselves, and that nothing jumps where parts hardly touch.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "families.h"
#include "guard.h"
#include "ledger.h"
#include "oracle.h"
#include "support.h"
#include "tests.h"

/* Of compounds some units large: what roundings come to. */
static const double rounding = 1e-12;

enum { MOST_PARTS = 36 };

struct compound {
    narc_arc arcs[MOST_PARTS * NARC_MAX_ARCS];
    size_t counts[MOST_PARTS];
    size_t parts, total;
};

static void add_part(struct compound *c, const struct shape *shape, double x, double y, double angle) {
    narc_error error;
    assert_true(c->parts < MOST_PARTS);
    expect_ok(narc_move_arcs(shape->arcs, shape->count, x, y, angle, 1, c->arcs + c->total, &error), &error);
    c->counts[c->parts++] = shape->count;
    c->total += shape->count;
}

static narc_mass measure(const struct compound *c) {
    narc_mass mass;
    narc_error error;
    expect_ok(narc_compute_union_mass(c->arcs, c->counts, c->parts, &guard_allocator, &mass, &error), &error);
    return mass;
}

/* All parts moved together. */
static struct compound move_compound(const struct compound *c, double x, double y, double angle) {
    struct compound moved = *c;
    for (size_t part = 0, first = 0; part < c->parts; first += c->counts[part++])
        assert_int_equal(narc_move_arcs(c->arcs + first, c->counts[part], x, y, angle, 1, moved.arcs + first, NULL),
                         NARC_OK);
    return moved;
}

/* Each part moved for itself, by up to `most`. */
static struct compound shake_compound(const struct compound *c, struct test_random *random, double most) {
    struct compound moved = *c;
    for (size_t part = 0, first = 0; part < c->parts; first += c->counts[part++])
        assert_int_equal(narc_move_arcs(c->arcs + first, c->counts[part], random_between(random, -most, most),
                                        random_between(random, -most, most), random_between(random, -most, most),
                                        1 + random_between(random, -most, most), moved.arcs + first, NULL),
                         NARC_OK);
    return moved;
}

static void expect_mass(narc_mass mass, narc_mass expected, double tolerance) {
    expect_near(mass.area, expected.area, tolerance, "area");
    expect_near(mass.second_moment, expected.second_moment, tolerance, "second moment");
    expect_near(mass.centroid_x * expected.area, expected.centroid_x * expected.area, tolerance, "first moment in x");
    expect_near(mass.centroid_y * expected.area, expected.centroid_y * expected.area, tolerance, "first moment in y");
}

static narc_mass mass_of(const struct shape *shape) {
    narc_mass mass;
    assert_true(narc_compute_mass(shape->arcs, shape->count, &mass));
    return mass;
}

/* ------------------------------------------------------------------------------------------------ one part */

TEST(one_part_is_itself) {
    struct test_random random = test_random_named("unions of one");
    for (size_t k = 0; k < FAMILY_COUNT * test_trials(100); k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        const double x = random_between(&random, -1, 1), y = random_between(&random, -1, 1);
        const double angle = k % 3 ? random_between(&random, -9, 9) : PI / 2 * (double)random_below(&random, 9);
        struct compound one = {.parts = 0};
        struct samples samples = oracle_sample(shape.arcs, shape.count, 1);
        narc_mass moved = mass_of(&shape);
        add_part(&one, &shape, x, y, angle);
        moved.centroid_x = x + cos(angle) * mass_of(&shape).centroid_x - sin(angle) * mass_of(&shape).centroid_y;
        moved.centroid_y = y + sin(angle) * mass_of(&shape).centroid_x + cos(angle) * mass_of(&shape).centroid_y;
        expect_mass(measure(&one), moved, 4 * rounding + 100 * samples.defect);
        if (moved.area == 0)
            expect_near(measure(&one).centroid_x, moved.centroid_x, rounding, "a segment's middle");
        oracle_free(&samples);
    }
}

TEST(moved_shapes_are_the_same_elsewhere) {
    struct test_random random = test_random_named("moved arcs");
    for (size_t k = 0; k < FAMILY_COUNT * test_trials(20); k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        const double x = random_between(&random, -3, 3), y = random_between(&random, -3, 3);
        const double angle = random_between(&random, -9, 9), scale = random_log_between(&random, 0.1, 10);
        struct shape moved = {.count = shape.count};
        assert_int_equal(narc_move_arcs(shape.arcs, shape.count, x, y, angle, scale, moved.arcs, NULL), NARC_OK);
        for (size_t i = 0; i < 20; i++) {
            const narc_point p = {random_between(&random, -2, 2), random_between(&random, -2, 2)};
            const narc_point q = {x + scale * (cos(angle) * p.x - sin(angle) * p.y),
                                  y + scale * (sin(angle) * p.x + cos(angle) * p.y)};
            double distance, there;
            assert_true(narc_compute_distance(shape.arcs, shape.count, &p, &distance));
            assert_true(narc_compute_distance(moved.arcs, moved.count, &q, &there));
            expect_near(there / scale, distance, 1e-12, "distance");
        }
    }
}

/* ------------------------------------------------------------------------------------------------ known unions */

/* A compound whose union is one shape, or something else that is known. */
struct known {
    struct compound compound;
    narc_mass mass;
};

enum kind { TRIANGLES, SLICES, SQUARES, CAPSULES, COPIES, INSIDE, TWO_CIRCLES, TOUCHING, RESTING, KINDS };

/* A polygon, cut into triangles from a point within, some of them twice: edges are shared, corners meet. */
static void make_triangles(struct test_random *random, struct known *k) {
    narc_point corner[12];
    struct shape whole = {.count = 0};
    const size_t count = 3 + random_below(random, 10);
    const narc_point middle = {random_between(random, -0.1, 0.1), random_between(random, -0.1, 0.1)};
    for (size_t i = 0; i < count; i++) {
        const double angle = 2 * PI * ((double)i + random_between(random, 0.1, 0.9) * (count > 3)) / (double)count;
        corner[i] = (narc_point){2 * cos(angle), sin(angle)};
    }
    assert_int_equal(narc_build_polygon(corner, count, 0, whole.arcs, &whole.count, NULL), NARC_OK);
    for (size_t i = 0; i < count; i++) {
        struct shape triangle = {.count = 0};
        const narc_point points[3] = {middle, corner[i], corner[(i + 1) % count]};
        assert_int_equal(narc_build_polygon(points, 3, 0, triangle.arcs, &triangle.count, NULL), NARC_OK);
        for (size_t times = 1 + random_below(random, 2); times > 0; times--)
            add_part(&k->compound, &triangle, 0, 0, 0);
    }
    k->mass = mass_of(&whole);
}

/* A disc as some slices, each an arc and its chord, and the polygon between them. */
static void make_slices(struct test_random *random, struct known *k) {
    const size_t count = 3 + random_below(random, 6);
    const double radius = random_between(random, 0.5, 2), turn = random_between(random, 0, 7);
    struct shape polygon = {.count = 0}, disc = circle_of(radius);
    assert_int_equal(narc_build_regular_polygon(count, radius, 0, polygon.arcs, &polygon.count, NULL), NARC_OK);
    add_part(&k->compound, &polygon, 0, 0, turn);
    for (size_t i = 0; i < count; i++) {
        const double start = 2 * PI * (double)i / (double)count, end = 2 * PI * ((double)i + 1) / (double)count;
        const double back = (start + end) / 2 + PI;
        const struct shape slice = {{{0, 0, radius, start, end},
                                     {radius * cos(end), radius * sin(end), 0, end, back},
                                     {radius * cos(start), radius * sin(start), 0, back, start + 2 * PI}},
                                    3};
        add_part(&k->compound, &slice, 0, 0, turn);
    }
    k->mass = mass_of(&disc);
}

/* A square of squares, which may lie over each other. */
static void make_squares(struct test_random *random, struct known *k) {
    const size_t side = 1 + random_below(random, 6);
    const double step = 0.3, size = step * (double)(1 + random_below(random, 2));
    const struct shape square = box_of(size, size, 0);
    const struct shape whole = box_of(step * ((double)side - 1) + size, step * ((double)side - 1) + size, 0);
    for (size_t i = 0; i < side * side; i++)
        add_part(&k->compound, &square, step * ((double)(i % side) - ((double)side - 1) / 2),
                 step * ((double)(i / side) - ((double)side - 1) / 2), PI / 2 * (double)random_below(random, 4));
    k->mass = mass_of(&whole);
}

/* A chain of capsules in a line, from one to the next by as much as they are long, or less. */
static void make_capsules(struct test_random *random, struct known *k) {
    const size_t count = 2 + random_below(random, 6);
    const double length = 0.7, step = length * (random_below(random, 2) ? 1 : random_unit(random));
    const double radius = random_between(random, 0.1, 1);
    const struct shape capsule = capsule_of(length, radius),
                       whole = capsule_of(length + step * ((double)count - 1), radius);
    for (size_t i = 0; i < count; i++)
        add_part(&k->compound, &capsule, step * ((double)i - ((double)count - 1) / 2), 0, PI * (double)(i % 2));
    k->mass = mass_of(&whole);
}

static void make_copies(struct test_random *random, struct known *k) {
    struct shape shape;
    do {
        shape = make_shape(random, (enum family)random_below(random, FAMILY_COUNT));
        struct samples samples = oracle_sample(shape.arcs, shape.count, 1);
        k->mass.second_moment = samples.defect;
        oracle_free(&samples);
    } while (k->mass.second_moment > rounding / 100); /* of what misses itself by more, copies do so elsewhere */
    for (size_t i = 1 + random_below(random, 5); i > 0; i--)
        add_part(&k->compound, &shape, 0, 0, 0);
    k->mass = mass_of(&shape);
}

/* Discs within a rounded box, some of which touch it, in a corner or along a side. */
static void make_inside(struct test_random *random, struct known *k) {
    const struct shape box = box_of(3, 2, 0.5), corner = circle_of(0.5),
                       disc = circle_of(random_between(random, 0.1, 1));
    const double radius = disc.arcs[0].radius;
    add_part(&k->compound, &corner, 1, 0.5, 0);
    add_part(&k->compound, &corner, -1, -0.5, 1);
    add_part(&k->compound, &box, 0, 0, 0);
    add_part(&k->compound, &disc, 0, 1 - radius, 0);
    add_part(&k->compound, &disc, radius - 1.5, 0, random_between(random, -9, 9));
    k->mass = mass_of(&box);
}

/* Two discs that overlap: their areas less that of the lens, a segment of each. */
static void make_two_circles(struct test_random *random, struct known *k) {
    const double r = random_between(random, 0.2, 1.5), s = random_between(random, 0.2, 1.5);
    const double d = fabs(r - s) + random_unit(random) * 2 * fmin(r, s), x = (d * d + r * r - s * s) / (2 * d);
    const double f = acos(x / r), g = acos((d - x) / s), one = circle_of(r).arcs[0].radius;
    const struct shape a = circle_of(r), b = circle_of(s);
    add_part(&k->compound, &a, 0, 0, 0);
    add_part(&k->compound, &b, d, 0, 0);
    /* Of a segment of a disc about its centre: area, first moment along its axis, second polar moment. */
    const double area_a = r * r * (f - sin(f) * cos(f)), area_b = s * s * (g - sin(g) * cos(g));
    const double first_a = 2.0 / 3 * pow(r * sin(f), 3), first_b = 2.0 / 3 * pow(s * sin(g), 3);
    const double second_a = pow(r, 4) / 2 * (f - sin(f) * cos(f) + 2.0 / 3 * sin(f) * cos(f) * sin(f) * sin(f));
    const double second_b = pow(s, 4) / 2 * (g - sin(g) * cos(g) + 2.0 / 3 * sin(g) * cos(g) * sin(g) * sin(g));
    const double area = PI * (one * one + s * s) - area_a - area_b;
    const double first = PI * s * s * d - first_a - (d * area_b - first_b);
    const double second = PI / 2 * (pow(r, 4) + pow(s, 4)) + PI * s * s * d * d - second_a -
                          (second_b + d * d * area_b - 2 * d * first_b);
    k->mass = (narc_mass){area, first / area, 0, second - first * first / area};
}

/* Discs in a ring that touch their neighbours: the sum. */
static void make_touching(struct test_random *random, struct known *k) {
    const size_t count = 3 + random_below(random, 20);
    const double radius = 1.5 * sin(PI / (double)count);
    const struct shape disc = circle_of(radius);
    for (size_t i = 0; i < count; i++) {
        const double angle = 2 * PI * (double)i / (double)count;
        add_part(&k->compound, &disc, 1.5 * cos(angle), 1.5 * sin(angle), angle);
    }
    const double area = (double)count * PI * radius * radius;
    k->mass = (narc_mass){area, 0, 0, area * (radius * radius / 2 + 1.5 * 1.5)};
}

/* Discs that touch a box in the middle of its sides: the sum. */
static void make_resting(struct test_random *random, struct known *k) {
    const double width = random_between(random, 1, 2), height = random_between(random, 0.5, 1);
    const double radius = random_between(random, 0.1, 0.5), area = PI * radius * radius;
    const double x = width / 2 + radius, y = height / 2 + radius;
    const struct shape box = box_of(width, height, 0), disc = circle_of(radius);
    add_part(&k->compound, &box, 0, 0, 0);
    for (int side = -1; side <= 1; side += 2) {
        add_part(&k->compound, &disc, side * x, 0, 0);
        add_part(&k->compound, &disc, 0, side * y, 1);
    }
    k->mass = mass_of(&box);
    k->mass.area += 4 * area;
    k->mass.second_moment += 2 * area * (x * x + y * y + radius * radius);
}

static void make_known(struct test_random *random, enum kind kind, struct known *out) {
    static void (*const make[KINDS])(struct test_random *, struct known *) = {
        make_triangles, make_slices,      make_squares,  make_capsules, make_copies,
        make_inside,    make_two_circles, make_touching, make_resting};
    memset(out, 0, sizeof *out);
    make[kind](random, out);
}

TEST(known_unions) {
    struct test_random random = test_random_named("known unions");
    static struct known k;
    for (size_t trial = 0; trial < KINDS * test_trials(60); trial++) {
        make_known(&random, (enum kind)(trial % KINDS), &k);
        expect_mass(measure(&k.compound), k.mass, rounding);
        /* Turned and moved, so that what coincided does so but for rounding. */
        const double angle = random_between(&random, -4, 4), x = random_between(&random, -1, 1);
        const struct compound moved = move_compound(&k.compound, x, 0.25, angle);
        const narc_mass there = {k.mass.area, x + cos(angle) * k.mass.centroid_x - sin(angle) * k.mass.centroid_y,
                                 0.25 + sin(angle) * k.mass.centroid_x + cos(angle) * k.mass.centroid_y,
                                 k.mass.second_moment};
        expect_mass(measure(&moved), there, 4 * rounding);
    }
}

/* Every part a little elsewhere: all that changes is as small. A motion by m moves each point of an outline by 4 m at
 * most, some units from the origin, and so no more of the area than the outlines sweep over. */
TEST(nothing_jumps) {
    struct test_random random = test_random_named("shaken unions");
    static struct known k;
    for (size_t trial = 0; trial < KINDS * test_trials(150); trial++) {
        const double most = random_log_between(&random, 1e-17, 1e-5);
        double perimeter = 0, length;
        make_known(&random, (enum kind)(trial % KINDS), &k);
        for (size_t part = 0, first = 0; part < k.compound.parts; first += k.compound.counts[part++]) {
            assert_true(narc_compute_perimeter(k.compound.arcs + first, k.compound.counts[part], &length));
            perimeter += length;
        }
        const struct compound shaken = shake_compound(&k.compound, &random, most);
        const narc_mass mass = measure(&shaken);
        const double swept = 8 * most * perimeter; /* times up to the square of a distance from the centroid: 9 */
        expect_near(mass.area, k.mass.area, swept + 2 * rounding, "shaken area");
        expect_near(mass.second_moment, k.mass.second_moment, 9 * swept + 8 * rounding, "shaken second moment");
    }
}

/* ------------------------------------------------------------------------------------------------ random unions */

struct span {
    double from, to;
};

static int compare_spans(const void *a, const void *b) {
    const struct span *one = a, *other = b;
    return (one->from > other->from) - (one->from < other->from);
}

/* What of the line from a to b lies in a convex polygon. An edge that is all rounding has no direction. */
static struct span clip_line(narc_point a, narc_point b, const struct samples *polygon) {
    struct span in = {0, 1};
    for (size_t i = 0; i < polygon->count; i++) {
        const narc_point p = polygon->point[i], q = polygon->point[(i + 1) % polygon->count];
        const double at = (q.x - p.x) * (a.y - p.y) - (q.y - p.y) * (a.x - p.x); /* left of the edge: above 0 */
        const double then = (q.x - p.x) * (b.y - p.y) - (q.y - p.y) * (b.x - p.x);
        if (fabs(q.x - p.x) + fabs(q.y - p.y) < 1e-9)
            continue;
        if (at < 0 && then < 0)
            return (struct span){0, 0};
        if (at < 0)
            in.from = fmax(in.from, at / (at - then));
        else if (then < 0)
            in.to = fmin(in.to, at / (at - then));
    }
    return in.from < in.to ? in : (struct span){0, 0};
}

/* The area, by what of each polygon's outline lies in no other. (For those in general position.) */
static double reference_area(const struct samples *polygons, size_t count) {
    double twice = 0;
    for (size_t part = 0; part < count; part++)
        for (size_t i = 0; i < polygons[part].count; i++) {
            const narc_point a = polygons[part].point[i], b = polygons[part].point[(i + 1) % polygons[part].count];
            struct span in[MOST_PARTS];
            size_t spans = 0;
            double out = 0, end = 0;
            for (size_t other = 0; other < count; other++)
                if (other != part)
                    in[spans++] = clip_line(a, b, &polygons[other]);
            qsort(in, spans, sizeof *in, compare_spans);
            for (size_t k = 0; k < spans; k++) {
                out += fmax(0, in[k].from - end);
                end = fmax(end, in[k].to);
            }
            twice += (out + 1 - end) * (a.x * b.y - a.y * b.x);
        }
    return twice / 2;
}

/* Some parts of any families, in any places. */
static void make_random(struct test_random *random, bool sharp, struct compound *out) {
    memset(out, 0, sizeof *out);
    for (size_t parts = 2 + random_below(random, 7); parts > 0; parts--) {
        const enum family family = sharp ? FAMILY_POLYGON : (enum family)random_below(random, FAMILY_COUNT);
        const struct shape shape = make_shape(random, family);
        add_part(out, &shape, random_between(random, -1.5, 1.5), random_between(random, -1.5, 1.5),
                 random_between(random, -4, 4));
    }
}

TEST(random_unions_match_outlines) {
    struct test_random random = test_random_named("random unions");
    static struct compound c;
    size_t tested = 0;
    for (size_t trial = 0; trial < test_trials(120); trial++) {
        struct samples samples[MOST_PARTS];
        double lack = 0, missed = rounding;
        make_random(&random, trial % 2, &c);
        for (size_t part = 0, first = 0; part < c.parts; first += c.counts[part++]) {
            samples[part] = oracle_sample(c.arcs + first, c.counts[part], trial % 2 ? 1 : 60);
            lack += samples[part].area_error;
            missed += 100 * samples[part].defect;
        }
        const double area = measure(&c).area, sampled = reference_area(samples, c.parts);
        assert_true(area >= sampled - missed && area <= sampled + lack + missed);
        tested += lack + missed < (trial % 2 ? 1e-11 : 1e-2) * (double)c.parts;
        for (size_t part = 0; part < c.parts; part++)
            oracle_free(&samples[part]);
    }
    assert_true(tested >= test_trials(120) * 9 / 10); /* or nothing was */
}

/* The strips lie in another direction, and the parts come in another order. */
TEST(turned_unions_are_the_same) {
    struct test_random random = test_random_named("turned unions");
    static struct compound c, backwards;
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        double missed = 0;
        make_random(&random, trial % 4 == 0, &c);
        memset(&backwards, 0, sizeof backwards);
        for (size_t part = c.parts, end = c.total; part-- > 0; end -= c.counts[part]) {
            struct shape shape = {.count = c.counts[part]};
            struct samples samples = oracle_sample(c.arcs + end - shape.count, shape.count, 1);
            memcpy(shape.arcs, c.arcs + end - shape.count, shape.count * sizeof *shape.arcs);
            add_part(&backwards, &shape, 0, 0, 0);
            missed += samples.defect;
            oracle_free(&samples);
        }
        const double angle = random_between(&random, -4, 4), tolerance = 10 * rounding + 1000 * missed;
        const struct compound turned = move_compound(&backwards, 0, 0, angle);
        const narc_mass mass = measure(&c), there = measure(&turned);
        const narc_mass expected = {mass.area, cos(angle) * mass.centroid_x - sin(angle) * mass.centroid_y,
                                    sin(angle) * mass.centroid_x + cos(angle) * mass.centroid_y, mass.second_moment};
        expect_mass(there, expected, tolerance);
    }
}

/* ------------------------------------------------------------------------------------------------ errors */

TEST(unions_refuse_bad_arguments) {
    struct compound two = {.parts = 0};
    const struct shape box = box_of(2, 1, 0.25);
    narc_mass mass;
    narc_error error;
    struct ledger ledger = {.limited = true};
    const narc_allocator failing = ledger_allocator(&ledger);
    memset(&mass, GUARD_JUNK, sizeof mass);
    const narc_mass junk = mass;
    add_part(&two, &box, 0, 0, 0);
    add_part(&two, &box, 1, 0, 0);
#define UNION(arcs, counts, parts, allocator, out, status, words)                                                      \
    expect_error(narc_compute_union_mass(arcs, counts, parts, allocator, out, &error), status, &error, words)
    UNION(NULL, two.counts, 2, NULL, &mass, NARC_ERROR_ARGUMENT, "arcs is NULL");
    UNION(two.arcs, NULL, 2, NULL, &mass, NARC_ERROR_ARGUMENT, "counts is NULL");
    UNION(two.arcs, two.counts, 2, NULL, NULL, NARC_ERROR_ARGUMENT, "out_mass is NULL");
    UNION(two.arcs, two.counts, 0, NULL, &mass, NARC_ERROR_COUNT, "no parts");
    UNION(two.arcs, two.counts, 2, &failing, &mass, NARC_ERROR_MEMORY, "no memory");
    two.arcs[5].radius = NAN;
    UNION(two.arcs, two.counts, 2, NULL, &mass, NARC_ERROR_NOT_FINITE, "part 1: arc 1: radius is");
    assert_int_equal(error.index, 1);
    assert_memory_equal(&mass, &junk, sizeof mass);
    ledger.left = 1;
    expect_ok(narc_compute_union_mass(two.arcs, two.counts, 1, &failing, &mass, &error), &error);
    assert_int_equal(ledger.allocations, 1);
}

TEST(moves_refuse_bad_arguments) {
    struct shape box = box_of(2, 1, 0.25);
    narc_arc out[NARC_MAX_ARCS];
    narc_error error;
#define MOVE(arcs, x, y, angle, scale, out, status, words)                                                             \
    expect_error(narc_move_arcs(arcs, box.count, x, y, angle, scale, out, &error), status, &error, words)
    MOVE(NULL, 0, 0, 0, 1, out, NARC_ERROR_ARGUMENT, "arcs is NULL");
    MOVE(box.arcs, 0, 0, 0, 1, NULL, NARC_ERROR_ARGUMENT, "out_arcs is NULL");
    MOVE(box.arcs, NAN, 0, 0, 1, out, NARC_ERROR_NOT_FINITE, "x is");
    MOVE(box.arcs, 0, INFINITY, 0, 1, out, NARC_ERROR_NOT_FINITE, "y is");
    MOVE(box.arcs, 0, 0, NAN, 1, out, NARC_ERROR_NOT_FINITE, "angle is");
    MOVE(box.arcs, 0, 0, 0, 0, out, NARC_ERROR_SIZE, "scale is 0");
    MOVE(box.arcs, 0, 0, 0, 1e10, out, NARC_ERROR_SIZE, "");
    MOVE(box.arcs, 1e10, 0, 0, 1, out, NARC_ERROR_SIZE, "");
    assert_int_equal(narc_move_arcs(box.arcs, box.count, 1, 2, PI / 2, 2, box.arcs, NULL), NARC_OK); /* in place */
    assert_true(box.arcs[0].radius == 0.5);
}
