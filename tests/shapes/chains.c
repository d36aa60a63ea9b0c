/* SPDX-License-Identifier: MIT
 *
 * chains.c - chains in a store: what is refused, that the entries' fronts cover the chain and overlap at their seams,
 * that closed runs are shapes, and that pieces are kept, saved and removed as shapes are.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "families.h"
#include "ledger.h"
#include "store.h"
#include "tests.h"
#include "turtle.h"

enum { MOST = 4096 };

static narc_chain_entry entries[MOST];

static size_t add(narc_shapes *shapes, const narc_arc *arcs, size_t count, const narc_chain_options *options) {
    size_t found = 0;
    narc_error error;
    expect_ok(narc_add_chain(shapes, arcs, count, options, entries, MOST, &found, &error), &error);
    return found;
}

/* ------------------------------------------------------------------------------------------------ fronts */

/* What touches of an entry, in the chain's coordinates: arcs with normals from start counter-clockwise to end, and the
 * edges between them, in the order of the walk. */
struct front {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    bool is_concave;
    double size; /* of the stored shape, to which its roundings are in proportion */
};

static narc_point point_at(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

/* Both ends of a run are corners of no turn. */
static struct front get_front(const narc_shapes *shapes, const narc_chain_entry *entry) {
    struct front f = {.is_concave = narc_shape_flags(shapes, entry->shape) & NARC_SHAPE_CONCAVE};
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(shapes, entry->shape, arcs);
    f.size = (double)shapes->headers[entry->shape].bound_radius;
    f.count = f.is_concave ? 1 : count - 4;
    for (size_t k = 0; k < f.count; k++) {
        f.arcs[k] = arcs[k];
        f.arcs[k].center_x += entry->x;
        f.arcs[k].center_y += entry->y;
        if (!f.is_concave && k == 0)
            f.arcs[k].start = f.arcs[k].end;
        if (!f.is_concave && k + 1 == f.count)
            f.arcs[k].end = f.arcs[k].start;
        f.size = fmax(f.size, fabs(f.arcs[k].radius));
    }
    if (f.is_concave) {
        f.arcs[0].start = arcs[0].end;
        f.arcs[0].end = arcs[0].start;
    }
    return f;
}

static double find_turn(double from, double to) { return remainder(to - from, 2 * PI); }

/* Does a front have this point with this normal, further from its ends than some radians on its first or last arc, and
 * than some length on its edges? */
static bool has_point(const struct front *f, narc_point p, double normal, double inside, double length) {
    const double room = 4e-6 * f->size;
    for (size_t k = 0; k < f->count; k++) {
        const narc_arc *arc = &f->arcs[k];
        const narc_point q = point_at(arc, normal);
        if (hypot(p.x - q.x, p.y - q.y) <= room + 1e-6 * fabs(arc->radius) && find_turn(arc->start, normal) >= inside &&
            find_turn(normal, arc->end) >= inside)
            return true;
        if (k == 0)
            continue;
        const narc_point from = point_at(arc - 1, arc[-1].end), to = point_at(arc, arc->start);
        const double edge = hypot(to.x - from.x, to.y - from.y);
        const double x = (to.x - from.x) / edge, y = (to.y - from.y) / edge;
        const double along = (p.x - from.x) * x + (p.y - from.y) * y;
        if (edge > room && fabs((p.x - from.x) * y - (p.y - from.y) * x) <= room &&
            fabs(find_turn(atan2(-x, y), normal)) <= 2e-4 && along >= length && edge - along >= length)
            return true;
    }
    return false;
}

static size_t count_fronts(const struct front *fronts, size_t count, narc_point p, double normal) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++)
        found += has_point(&fronts[k], p, normal, -1e-6, -1e-5 * fronts[k].size);
    return found;
}

static void check_covered(const struct front *fronts, size_t count, narc_point p, double normal, size_t arc) {
    const size_t found = count_fronts(fronts, count, p, normal);
    if (found == 0 || found > 3)
        fail_msg("%zu fronts have the point (%.17g, %.17g) with the normal %.9g, at arc %zu", found, p.x, p.y, normal,
                 arc);
}

/* Every point of the chain is on a front. */
static void check_cover(const narc_arc *arcs, size_t count, bool closed, const struct front *fronts, size_t found) {
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *before = &arcs[(i + count - 1) % count];
        for (int k = 0; k <= 6 && arc->start != arc->end; k++) {
            const double normal = arc->start + (arc->end - arc->start) * k / 6;
            check_covered(fronts, found, point_at(arc, normal), normal, i);
        }
        const narc_point from = point_at(before, before->end), to = point_at(arc, arc->start);
        for (int k = 0; k <= 8 && (i > 0 || closed) && hypot(to.x - from.x, to.y - from.y) > 1e-9; k++)
            check_covered(fronts, found,
                          (narc_point){from.x + (to.x - from.x) * k / 8, from.y + (to.y - from.y) * k / 8}, arc->start,
                          i);
    }
}

/* The last arc of a front, or its first: where a corner is cut that corner, beyond which it reaches along an edge. */
static const narc_arc *find_end(const struct front *f, bool at_end) {
    const narc_arc *end = &f->arcs[at_end && !f->is_concave ? f->count - 1 : 0];
    const narc_arc *next = f->is_concave ? end : at_end ? end - 1 : end + 1;
    const double edge = hypot(end->center_x - next->center_x, end->center_y - next->center_y);
    return end->radius == 0 && next->radius == 0 && edge < 0x1p-15 * f->size ? next : end;
}

/* Is the end of a front, or its beginning, or the place from where it reaches on, inside another one? */
static bool has_end(const struct front *f, bool at_end, const struct front *other) {
    const narc_arc *arc = find_end(f, at_end);
    const double normal = at_end != f->is_concave ? arc->end : arc->start;
    bool found = false;
    for (int k = 0; k <= 1000 && !found; k++) { /* the bottom of a valley reaches on the furthest */
        const double back = 1e-6 * k, inside = normal - (at_end != f->is_concave ? back : -back);
        found = found || has_point(other, point_at(arc, inside), inside, 1e-6, 1e-6 * fmin(f->size, other->size));
    }
    return found;
}

/* Where one front ends the next one goes on, or began before. */
static void check_seams(const struct front *fronts, size_t count, bool closed) {
    for (size_t k = 0; k + 1 < count + closed; k++) {
        const struct front *f = &fronts[k], *g = &fronts[(k + 1) % count];
        if (!has_end(f, true, g) && !has_end(g, false, f))
            fail_msg("fronts %zu and %zu do not overlap", k, (k + 1) % count);
    }
}

/* Front arcs are the chain's, from first_arc on and without plain points. */
static void check_numbers(const narc_arc *arcs, size_t count, const narc_chain_entry *entry, const struct front *f) {
    size_t i = entry->first_arc;
    assert_in_range(i, 0, count - 1);
    for (size_t k = 0; k < entry->arc_count; k++, i = (i + 1) % count) {
        while (arcs[i].start == arcs[i].end)
            i = (i + 1) % count;
        const narc_arc *own = &f->arcs[f->is_concave ? 0 : k + 1];
        const double room = 1e-6 * (f->size + fabs(arcs[i].center_x) + fabs(arcs[i].center_y));
        if (!f->is_concave && signbit(arcs[i].radius)) { /* a corner, where an edge meets a concave arc */
            const narc_point end = point_at(&arcs[i], arcs[i].end), start = point_at(&arcs[i], arcs[i].start);
            const double beyond = room + 1e-4 * fmin(-arcs[i].radius, f->size); /* where it meets that, and on */
            const bool begins = k == 0 && hypot(own->center_x - end.x, own->center_y - end.y) < beyond;
            const narc_point meet = begins ? end : start;
            assert_true(begins || k + 1 == entry->arc_count);
            expect_near(own->radius, 0, 0, "radius");
            expect_near(own->center_x, meet.x, beyond, "center x");
            expect_near(own->center_y, meet.y, beyond, "center y");
            continue;
        }
        assert_int_equal(signbit(own->radius) != 0, signbit(arcs[i].radius) != 0);
        expect_near(own->radius, arcs[i].radius, room, "radius");
        expect_near(own->center_x, arcs[i].center_x, room, "center x");
        expect_near(own->center_y, arcs[i].center_y, room, "center y");
    }
}

/* Divides a chain and looks at all of it; returns the number of entries. */
static size_t check_division(const narc_arc *arcs, size_t count, const narc_chain_options *options) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    const size_t found = add(shapes, arcs, count, options);
    const bool closed = options && options->closed;
    AUTO(free_at) struct front *fronts = malloc(found * sizeof *fronts);
    assert_non_null(fronts);
    uint32_t run = options ? options->first_run : 0;
    for (size_t k = 0; k < found; k++) {
        const narc_chain_entry *entry = &entries[k];
        narc_arc own[NARC_MAX_ARCS];
        narc_error error;
        fronts[k] = get_front(shapes, entry);
        check_numbers(arcs, count, entry, &fronts[k]);
        if (fronts[k].is_concave) {
            assert_int_equal(entry->run, NARC_NO_RUN);
            assert_int_equal(entry->arc_count, 1);
            assert_true(fronts[k].arcs[0].end - fronts[k].arcs[0].start < 2.001);
            run += k > 0 && entries[k - 1].run == run;
            continue;
        }
        const size_t stored = narc_get_arcs(shapes, entry->shape, own);
        assert_in_range(stored, entry->arc_count + 6, entry->arc_count + 7); /* one more at a corner that was cut */
        assert_int_equal(narc_shape_flags(shapes, entry->shape) & NARC_SHAPE_RUN, NARC_SHAPE_RUN);
        assert_int_equal(entry->run, run);
        expect_ok(narc_validate_arcs(own, stored, &error), &error);
        assert_true(find_turn(own[0].end, own[stored - 5].start) < 1.91);
    }
    check_cover(arcs, count, closed, fronts, found);
    check_seams(fronts, found, closed);
    assert_true(shapes->piece_count == shapes->count);
    return found;
}

TEST(divides_ground) {
    struct test_random random = test_random_named("ground");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        AUTO(free_at)
        struct turtle t = walk_ground(&random, 1 + random_below(&random, 60), random_between(&random, 0.1, 1.3));
        const narc_chain_options options = {.first_run = (uint32_t)random_below(&random, 3),
                                            .weld = random_below(&random, 2) ? random_between(&random, 0.5, 5) : 0};
        check_division(t.arcs, t.count, &options);
    }
}

TEST(divides_rings) {
    const narc_chain_options ring = {.closed = 1};
    for (size_t teeth = 3; teeth < 40; teeth += 4) {
        AUTO(free_at) struct turtle t = walk_gear(teeth, 0.5);
        check_division(t.arcs, t.count, &ring);
    }
    AUTO(free_at) struct turtle shoe = create_turtle(2, 0, 0); /* a horseshoe */
    walk_arc(&shoe, 2, PI);
    walk_arc(&shoe, 0, PI / 2);
    walk_line(&shoe, 1);
    walk_arc(&shoe, 0, PI / 2);
    walk_arc(&shoe, 1, -PI);
    walk_arc(&shoe, 0, PI / 2);
    walk_line(&shoe, 1);
    walk_arc(&shoe, 0, PI / 2);
    assert_int_equal(check_division(shoe.arcs, shoe.count, &ring), 8);
    AUTO(free_at) struct turtle cave = create_turtle(-1, 0, 0); /* a round hole */
    walk_arc(&cave, 1, -PI);
    walk_arc(&cave, 1, -PI);
    assert_int_equal(check_division(cave.arcs, cave.count, &ring), 4);
    for (size_t corners = 3; corners < 400; corners = corners * 3 / 2) { /* convex polygons, from a plain point on */
        AUTO(free_at) struct turtle t = create_turtle(1, 0, 0);
        for (size_t k = 0; k < corners; k++) {
            walk_arc(&t, 0, 0);
            walk_line(&t, 1);
            walk_arc(&t, k % 2 ? 0.3 : 0, 2 * PI / (double)corners);
            walk_line(&t, corners % 2 ? 1 : 0.5);
        }
        if (corners % 2 == 0 || corners == 3) /* else it does not close: every other corner is another one */
            check_division(t.arcs, t.count, &ring);
    }
}

/* Corners that turn so much that a piece between two cuts has no other feature. */
TEST(divides_sharp_corners) {
    AUTO(free_at) struct turtle sliver = create_turtle(0, 0, 0);
    const double tip = 2.9;
    walk_line(&sliver, 4 * cos(PI - tip));
    walk_arc(&sliver, 0, tip);
    walk_line(&sliver, 2);
    walk_arc(&sliver, 0, 2 * (PI - tip));
    walk_line(&sliver, 2);
    walk_arc(&sliver, 0, tip);
    assert_int_equal(check_division(sliver.arcs, sliver.count, &(narc_chain_options){.closed = 1}), 4);
    AUTO(free_at) struct turtle spike = create_turtle(4, 0, PI / 2); /* up and down from level ground */
    walk_arc(&spike, 0, 0);
    walk_line(&spike, 2);
    walk_arc(&spike, 0, -1.4);
    walk_line(&spike, 3);
    walk_arc(&spike, 0, 2.8);
    walk_line(&spike, 3);
    walk_arc(&spike, 0, -1.4);
    walk_line(&spike, 2);
    walk_arc(&spike, 0, 0);
    assert_int_equal(check_division(spike.arcs, spike.count, NULL), 6);
    struct turtle cusp = create_turtle(4, 0, PI / 2); /* between two concave arcs, without an edge */
    walk_arc(&cusp, 2, -1.5);
    walk_arc(&cusp, 0, 3);
    walk_arc(&cusp, 2, -1.5);
    assert_int_equal(check_division(cusp.arcs, cusp.count, NULL), 4);
    free(cusp.arcs);
}

TEST(divides_one_edge_and_valleys) {
    const narc_arc edge[] = {{9, 0, 0, PI / 2, PI / 2}, {0, 0, 0, PI / 2, PI / 2}};
    assert_int_equal(check_division(edge, 2, NULL), 1);
    assert_int_equal(entries[0].arc_count, 0);
    assert_true(entries[0].x == 4.5 && entries[0].y == 0);
    assert_int_equal(check_division(edge, 2, &(narc_chain_options){.weld = 2}), 6); /* 1.5 apart */
    assert_int_equal(check_division(edge, 2, &(narc_chain_options){.weld = INFINITY}), 1);
    struct turtle t = create_turtle(3, 3, PI * 3 / 4); /* a zigzag of edges, then valleys beside arcs */
    walk_arc(&t, 0, 0);
    for (int k = 0; k < 3; k++) {
        walk_line(&t, 1);
        walk_arc(&t, 0, -PI / 2);
        walk_line(&t, 1);
        walk_arc(&t, 0, PI / 2);
    }
    for (int k = 0; k < 3; k++) {
        walk_arc(&t, 0, -PI / 2);
        walk_arc(&t, 1, PI / 2);
    }
    assert_int_equal(check_division(t.arcs, t.count, NULL), 13);
    free(t.arcs);
}

/* A corner and a valley at one point, where a chain begins or ends or both: the corner has no size but its neighbours'. */
TEST(divides_corners_beside_valleys) {
    for (int ends = 1; ends < 4; ends++)
        for (int first = -1; first < 2; first += 2) {
            AUTO(free_at) struct turtle t = create_turtle(1, 2, PI / 2);
            for (int end = 1; end < 3; end++) {
                walk_arc(&t, 0, ends & end ? 0.5 * first : 0);
                if (ends & end)
                    walk_arc(&t, 0, -0.7 * first);
                if (end == 1)
                    walk_line(&t, 3);
            }
            assert_in_range(check_division(t.arcs, t.count, NULL), 2, 5);
        }
}

/* A valley is one whatever the sign of its 0, as programs write it that know no -0: the same entries, the same bits. */
TEST(divides_valleys_without_a_sign) {
    struct test_random random = test_random_named("unsigned valleys");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        const bool closed = trial % 4 == 0;
        AUTO(free_at) struct turtle t = closed ? walk_gear(5, 1) : walk_ground(&random, 40, 1.2);
        for (size_t k = 0; closed && k < t.count; k++) /* valleys of right angles in a ring of corners */
            t.arcs[k] = (narc_arc){0, 0, 0, 0, 0};
        t.count = closed ? 0 : t.count;
        for (int k = 0; closed && k < 4; k++) {
            walk_arc(&t, 0, PI / 2);
            walk_line(&t, 3);
            walk_arc(&t, 0, PI / 2);
            walk_line(&t, 3);
            walk_arc(&t, 0, -PI / 2);
            walk_line(&t, 1);
        }
        const narc_chain_options options = {.closed = closed};
        narc_chain_entry found[2][300];
        narc_shapes *stores[2];
        size_t counts[2], valleys = 0;
        for (int unsigned_ = 0; unsigned_ < 2; unsigned_++) {
            narc_error error;
            stores[unsigned_] = empty_store();
            for (size_t k = 0; unsigned_ && k < t.count; k++) {
                valleys += signbit(t.arcs[k].radius) && t.arcs[k].radius == 0;
                t.arcs[k].radius = t.arcs[k].radius == 0 ? 0.0 : t.arcs[k].radius;
            }
            expect_ok(narc_add_chain(stores[unsigned_], t.arcs, t.count, &options, found[unsigned_], 300,
                                     &counts[unsigned_], &error),
                      &error);
        }
        assert_true(!closed || valleys == 4);
        assert_int_equal(counts[0], counts[1]);
        assert_memory_equal(found[0], found[1], counts[0] * sizeof **found);
        for (size_t k = 0; k < counts[0]; k++) {
            narc_arc arcs[2][NARC_MAX_ARCS];
            const size_t count = narc_get_arcs(stores[0], found[0][k].shape, arcs[0]);
            assert_int_equal(narc_get_arcs(stores[1], found[1][k].shape, arcs[1]), count);
            assert_memory_equal(arcs[0], arcs[1], count * sizeof **arcs);
        }
        narc_destroy_shapes(stores[0]);
        narc_destroy_shapes(stores[1]);
    }
}

TEST(welds_collinear_edges) {
    enum { EDGES = 10000 };
    AUTO(free_at) struct turtle t = create_turtle(3, 1, 2);
    for (size_t k = 0; k <= EDGES; k++) {
        walk_arc(&t, 0, 0);
        walk_line(&t, 0.125);
    }
    narc_shapes *shapes = empty_store();
    assert_int_equal(add(shapes, t.arcs, t.count, NULL), EDGES / 24 + 1); /* 4 long, 1 in common */
    assert_int_equal(narc_count_shapes(shapes), 7); /* one, but for three at either end: what lies beyond those ends */
    assert_int_equal(entries[3].shape, entries[EDGES / 24 - 3].shape);
    assert_int_equal(add(shapes, t.arcs, t.count, &(narc_chain_options){.weld = 0.125 * EDGES}), 1);
    assert_int_equal(entries[0].arc_count, 0);
    narc_destroy_shapes(shapes);
    assert_int_equal(check_division(t.arcs, 100, &(narc_chain_options){.weld = 2}), 8);
    for (size_t k = 0; k < t.count; k++) {
        t.arcs[k].start += k < 5 ? 0 : 2e-5;
        t.arcs[k].end = t.arcs[k].start;
    }
    narc_error error;
    size_t found;
    shapes = empty_store();
    expect_error(narc_add_chain(shapes, t.arcs, t.count, NULL, entries, MOST, &found, &error), NARC_ERROR_NOT_CLOSED,
                 &error, "arc 5: its start normal is");
    narc_destroy_shapes(shapes);
}

/* More arcs than a shape has room for. */
TEST(divides_runs_of_many_arcs) {
    AUTO(free_at) struct turtle t = create_turtle(0, 0, 1);
    for (int k = 0; k < 200; k++) {
        walk_arc(&t, k % 3 ? 0.5 : 0, 0.006);
        walk_line(&t, 0.1);
    }
    walk_arc(&t, 0, 0);
    const size_t found = check_division(t.arcs, t.count, NULL);
    assert_int_equal(found, 4);
    assert_int_equal(entries[0].arc_count, 56); /* what a shape has room for, less what is behind and at cuts */
}

/* ------------------------------------------------------------------------------------------------ refused */

/* The store is as it was before, and so are the outputs. */
static void check_refused(const narc_arc *arcs, size_t count, const narc_chain_options *options, narc_status status,
                          size_t index, const char *words) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    const uint64_t changes = shapes->change_count;
    size_t found = 77;
    narc_error error;
    entries[0].shape = 1234;
    expect_error(narc_add_chain(shapes, arcs, count, options, entries, MOST, &found, &error), status, &error, words);
    if (index != SIZE_MAX) /* else any */
        assert_int_equal(error.index, index);
    assert_int_equal(found, 77);
    assert_int_equal(entries[0].shape, 1234);
    assert_int_equal(narc_count_shapes(shapes), 0);
    assert_true(shapes->change_count == changes);
}

/* A plain, a hill, a valley with a round bottom, a corner, a plain. */
enum { GROUND = 8 };
static void make_ground(narc_arc arcs[GROUND]) {
    AUTO(free_at) struct turtle t = create_turtle(20, 0, PI / 2);
    walk_arc(&t, 0, 0);
    walk_line(&t, 2);
    walk_arc(&t, 0, 0);
    walk_line(&t, 2);
    walk_arc(&t, 1, -0.5);
    walk_line(&t, 1);
    walk_arc(&t, 2, 1);
    walk_arc(&t, 0.75, -1);
    walk_line(&t, 1);
    walk_arc(&t, 0, 0.5);
    walk_line(&t, 4);
    walk_arc(&t, 0, -0.25);
    walk_line(&t, 3);
    walk_arc(&t, 0, 0);
    assert_int_equal(t.count, GROUND);
    memcpy(arcs, t.arcs, GROUND * sizeof *arcs);
}

TEST(refuses_bad_arguments) {
    narc_arc arcs[GROUND];
    make_ground(arcs);
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    size_t found = 77;
    narc_error error;
    assert_int_equal(check_division(arcs, GROUND, NULL), 7);
    expect_error(narc_add_chain(NULL, arcs, GROUND, NULL, entries, MOST, &found, &error), NARC_ERROR_ARGUMENT, &error,
                 "shapes is NULL");
    expect_error(narc_add_chain(shapes, NULL, GROUND, NULL, entries, MOST, &found, &error), NARC_ERROR_ARGUMENT, &error,
                 "arcs is NULL");
    expect_error(narc_add_chain(shapes, arcs, GROUND, NULL, NULL, MOST, &found, &error), NARC_ERROR_ARGUMENT, &error,
                 "out_entries is NULL");
    expect_error(narc_add_chain(shapes, arcs, GROUND, NULL, entries, MOST, NULL, &error), NARC_ERROR_ARGUMENT, &error,
                 "out_count is NULL");
    check_refused(arcs, 0, NULL, NARC_ERROR_COUNT, 0, "the chain has 0 arcs");
    check_refused(arcs, ((size_t)1 << 30) + 1, NULL, NARC_ERROR_COUNT, 0, "the chain has 1073741825 arcs");
    check_refused(arcs, GROUND, &(narc_chain_options){.weld = -1}, NARC_ERROR_ARGUMENT, 0, "weld is -1");
    check_refused(arcs, GROUND, &(narc_chain_options){.weld = NAN}, NARC_ERROR_ARGUMENT, 0, "weld is");
    check_refused(arcs, GROUND, &(narc_chain_options){.least_radius = NAN}, NARC_ERROR_ARGUMENT, 0, "least radius");
    check_refused(arcs, GROUND, &(narc_chain_options){.thickness = NAN}, NARC_ERROR_ARGUMENT, 0, "the thickness");
    check_refused(arcs, GROUND, &(narc_chain_options){.reserved = {0, arcs}}, NARC_ERROR_ARGUMENT, 0, "reserved");
    check_refused(arcs, GROUND, &(narc_chain_options){.weld = 1e-9}, NARC_ERROR_COUNT, 2, "parts");
    assert_int_equal(narc_add_chain(shapes, arcs, GROUND, NULL, NULL, 0, &found, &error), NARC_ERROR_CAPACITY);
    assert_int_equal(found, 7);
    entries[0].shape = 1234;
    expect_error(narc_add_chain(shapes, arcs, GROUND, NULL, entries, 6, &found, &error), NARC_ERROR_CAPACITY, &error,
                 "room for 6 entries, not for 7");
    assert_int_equal(entries[0].shape, 1234);
    assert_int_equal(narc_count_shapes(shapes), 0);
}

TEST(refuses_arcs_that_are_wrong) {
    narc_arc arcs[GROUND];
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < GROUND; i++)
        for (size_t k = 0; k < 15; k++) {
            make_ground(arcs);
            *(&arcs[i].center_x + k % 5) = bad[k / 5];
            check_refused(arcs, GROUND, NULL, NARC_ERROR_NOT_FINITE, i, "a number is");
        }
    make_ground(arcs);
    arcs[3].center_x = 1e18;
    check_refused(arcs, GROUND, NULL, NARC_ERROR_SIZE, 3, "a number is 1e+18");
    make_ground(arcs);
    check_refused(arcs, GROUND, &(narc_chain_options){.least_radius = 0.8}, NARC_ERROR_RADIUS, 4,
                  "concave with the radius 0.75, below 0.8");
    check_refused(arcs, GROUND, &(narc_chain_options){.least_radius = 0.1}, NARC_ERROR_RADIUS, 6, "radius 0,");
    arcs[3].end = arcs[3].start - 0.5; /* backwards */
    check_refused(arcs, GROUND, NULL, NARC_ERROR_SWEEP, 3, "more than half a turn");
    make_ground(arcs);
    arcs[4].end = arcs[4].start + 0.5;
    check_refused(arcs, GROUND, NULL, NARC_ERROR_SWEEP, 4, "clockwise, more than half a turn");
    arcs[4].end = arcs[4].start - 1e-6;
    check_refused(arcs, GROUND, NULL, NARC_ERROR_SWEEP, 4, "it turns by nothing");
    make_ground(arcs);
    arcs[3].start += 1e-4; /* a tangent that jumps */
    check_refused(arcs, GROUND, NULL, NARC_ERROR_NOT_CLOSED, 3, "its start normal is 0.0001");
    make_ground(arcs);
    arcs[3].center_y += 1e-3; /* arcs that do not meet */
    check_refused(arcs, GROUND, NULL, NARC_ERROR_NOT_CLOSED, 3, "starts 0.000");
    make_ground(arcs);
    arcs[1].center_x += 2.5; /* an edge that runs backwards, over a plain point */
    check_refused(arcs, GROUND, NULL, NARC_ERROR_NOT_CONVEX, 1, "runs backwards, its length is -0.5");
    make_ground(arcs);
    check_refused(arcs, GROUND, &(narc_chain_options){.closed = 1}, NARC_ERROR_NOT_CLOSED, 0, "end normal of arc 7");
    check_refused(arcs, 1, NULL, NARC_ERROR_SIZE, 0, "the chain has no length");
    check_refused(arcs, 2, &(narc_chain_options){.closed = 1}, NARC_ERROR_SWEEP, 0, "does not turn");
}

/* Arcs that are flatter than single precision can tell from edges, and parts that are too large. */
TEST(refuses_sizes_out_of_range) {
    for (int concave = 0; concave < 2; concave++) {
        AUTO(free_at) struct turtle t = create_turtle(0, 0, PI / 2);
        walk_arc(&t, 1, 0.5);
        walk_arc(&t, 1, -0.25);
        walk_arc(&t, 1e4, concave ? -1e-4 : 1e-4);
        walk_arc(&t, 1, -0.25);
        check_refused(t.arcs, t.count, NULL, NARC_ERROR_RADIUS, 2, "begins at arc 2");
    }
    const narc_arc far[] = {{2e10, 0, 0, PI / 2, PI / 2}, {0, 0, 0, PI / 2, PI / 2}};
    check_refused(far, 2, NULL, NARC_ERROR_SIZE, 0, "bounding radius");
    const narc_arc point[] = {{2, 0, 0, 0, 1}};
    check_refused(point, 1, NULL, NARC_ERROR_SIZE, 0, "begins at arc 0");
}

TEST(refuses_chains_that_cross_themselves) {
    const narc_chain_options ring = {.closed = 1};
    struct turtle t = create_turtle(0, 0, 0); /* a loop */
    walk_arc(&t, 0, 0);
    walk_line(&t, 3);
    for (int k = 0; k < 3; k++) {
        walk_arc(&t, 0.5, PI / 2);
        walk_line(&t, 1);
    }
    walk_line(&t, 1);
    walk_arc(&t, 0, 0);
    check_refused(t.arcs, t.count, NULL, NARC_ERROR_NOT_SIMPLE, 4, "arc 4, or the edge before it, meets arc 1");
    check_division(t.arcs, 3, NULL);
    free(t.arcs);
    t = create_turtle(0, 0, 0); /* a figure of eight: each half is closed by a line across the other one's */
    for (int half = 0; half < 2; half++) {
        walk_line(&t, 4);
        walk_arc(&t, 1, half ? -PI : PI);
        walk_line(&t, 4);
        walk_arc(&t, 0, half ? -2.2 : 2.2);
    }
    t.count = 0; /* corners at (1, 1), (-1, 1), (1, -1), (-1, -1) */
    const narc_point corner[] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    for (int k = 0; k < 4; k++) {
        const narc_point a = corner[(k + 3) % 4], b = corner[k], c = corner[(k + 1) % 4];
        const double in = atan2(-(b.x - a.x), b.y - a.y), turn = find_turn(in, atan2(-(c.x - b.x), c.y - b.y));
        t.arcs[t.count++] = (narc_arc){b.x, b.y, turn < 0 ? -0.0 : 0, in, in + turn};
    }
    check_refused(t.arcs, 4, &ring, NARC_ERROR_NOT_SIMPLE, 3, "meets arc");
    free(t.arcs);
    /* Two arcs that join at a corner and meet again; two long ways that cross far from their joins. */
    t = create_turtle(0, 0, 0);
    walk_arc(&t, 1, 3);
    walk_arc(&t, 0, 2.5);
    walk_arc(&t, 1, 3);
    check_refused(t.arcs, t.count, NULL, NARC_ERROR_NOT_SIMPLE, 2, "arc 2");
    free(t.arcs);
    t = create_turtle(0, 0, PI / 2);
    for (int k = 0; k < 3000; k++) {
        walk_arc(&t, 1, k % 2 ? 0.5 : -0.5);
        for (int i = 0; k == 1499 && i < 2; i++)
            walk_arc(&t, 100, 3); /* nearly back, and downhill */
    }
    check_division(t.arcs, 300, NULL);
    narc_shapes *shapes = empty_store();
    assert_true(add(shapes, t.arcs, 1501, NULL) > 1500);
    narc_destroy_shapes(shapes);
    check_refused(t.arcs, t.count, NULL, NARC_ERROR_NOT_SIMPLE, SIZE_MAX, "meets arc");
    free(t.arcs);
}

/* A line or an arc that is walked back, from a corner of half a turn; a circle that is walked on over its beginning; a
 * line that goes on over itself. By exact numbers and by ones that are off by roundings. */
TEST(refuses_chains_that_lie_on_themselves) {
    struct test_random random = test_random_named("on themselves");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        const bool exact = trial < 16;
        AUTO(free_at)
        struct turtle t = create_turtle(exact ? 0 : random_between(&random, -9, 9), 0,
                                        exact ? PI / 2 : random_between(&random, -9, 9));
        const double size = exact ? 1 : random_log_between(&random, 0.1, 10);
        const double back = random_below(&random, 2) ? 1 : random_between(&random, 0.1, 2);
        const bool concave = random_below(&random, 2);
        const double turn = (concave ? -1 : 1) * (random_below(&random, 4) ? random_between(&random, 0.1, 1.5) : 1.5);
        walk_arc(&t, 0, 0);
        switch (trial % 4) {
        case 0: /* a line of no thickness, or a slit of no width */
            walk_line(&t, size);
            walk_arc(&t, 0, concave ? -PI : PI);
            walk_line(&t, back * size);
            break;
        case 1: /* an arc and back */
            walk_arc(&t, size, turn);
            walk_arc(&t, 0, concave ? -PI : PI);
            walk_arc(&t, size, -turn * fmin(back, 2));
            break;
        case 2: /* more than once around */
            for (int k = 0; k < 5; k++)
                walk_arc(&t, size, copysign(fmin(1.26 + 0.2 * back, PI), turn));
            break;
        default: /* back to the line that it began with, by an arc that is no wider than it; on along the line */
            walk_line(&t, 3 * size);
            walk_arc(&t, size / 2, PI);
            walk_line(&t, 2 * size);
            walk_arc(&t, size / 2, PI);
            walk_line(&t, size);
        }
        walk_arc(&t, 0, 0);
        check_refused(t.arcs, t.count, NULL, NARC_ERROR_NOT_SIMPLE, SIZE_MAX, "meets arc");
    }
    AUTO(free_at) struct turtle t = create_turtle(0, 0, 0); /* a closed outline that is walked twice */
    for (int k = 0; k < 8; k++) {
        walk_line(&t, 1);
        walk_arc(&t, k % 2 ? 0.5 : 0, PI / 2);
    }
    check_refused(t.arcs, t.count, &(narc_chain_options){.closed = 1}, NARC_ERROR_NOT_SIMPLE, SIZE_MAX, "meets arc");
    check_division(t.arcs, 4, &(narc_chain_options){.closed = 1});
}

/* What meets at a point alone: equal parts of one circle or line, thin walls, slits and cusps, a lens. */
TEST(accepts_parts_that_are_alike) {
    struct test_random random = test_random_named("alike");
    for (size_t trial = 0; trial < test_trials(200); trial++) {
        const double x = random_between(&random, -9, 9), y = random_between(&random, -9, 9);
        const double size = random_log_between(&random, 0.1, 10), thin = random_log_between(&random, 1e-5, 0.3);
        struct turtle t = create_turtle(x, y, random_between(&random, -9, 9));
        const size_t parts = 1 + random_below(&random, 9);
        for (size_t k = 0; k < parts; k++) /* nearly once around */
            walk_arc(&t, size, 6.2 / (double)(parts < 2 ? 2 : parts));
        check_division(t.arcs, t.count, NULL);
        free(t.arcs);
        t = create_turtle(x, y, random_between(&random, -9, 9)); /* a wall, or a slit, with a sharp end */
        const double side = random_below(&random, 2) ? 1 : -1;
        walk_arc(&t, 0, 0);
        for (size_t k = 0; k < parts; k++) {
            walk_line(&t, size);
            walk_arc(&t, 0, k + 1 < parts ? 0 : side * (PI - thin));
        }
        walk_line(&t, size * random_between(&random, 0.1, 2));
        walk_arc(&t, 0, 0);
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
        add(shapes, t.arcs, t.count, NULL);
        free(t.arcs);
        t = create_turtle(x, y, random_between(&random, -9, 9)); /* a cusp, with one tangent on both sides */
        walk_arc(&t, size, -1);
        walk_arc(&t, 0, PI);
        walk_arc(&t, size * random_between(&random, 0.5, 2), -1);
        add(shapes, t.arcs, t.count, NULL);
        free(t.arcs);
        t = create_turtle(x, y, random_between(&random, -9, 9)); /* a lens, and a closed circle of equal parts */
        for (int k = 0; k < 2; k++) {
            walk_arc(&t, size, 0.1 + thin);
            walk_arc(&t, 0, PI - 0.1 - thin);
        }
        add(shapes, t.arcs, t.count, &(narc_chain_options){.closed = 1});
        t.count = 0;
        for (size_t k = 0; k <= parts; k++)
            walk_arc(&t, size, 2 * PI / (double)(parts + 1) * (trial % 2 ? 1 : -1));
        add(shapes, t.arcs, t.count, &(narc_chain_options){.closed = 1});
        free(t.arcs);
    }
}

/* Turns that come near each other, and rings that nearly fill their inside, cross nothing. */
TEST(accepts_chains_that_come_near_themselves) {
    struct turtle t = create_turtle(0, 0, 0);
    for (int k = 1; k < 60; k++)
        walk_arc(&t, 1 + 0.01 * k, 1.5); /* a spiral */
    narc_shapes *shapes = empty_store();
    assert_in_range(add(shapes, t.arcs, t.count, NULL), 45, 60);
    narc_destroy_shapes(shapes);
    free(t.arcs);
    t = walk_gear(7, 40); /* long teeth side by side */
    check_division(t.arcs, t.count, &(narc_chain_options){.closed = 1});
    free(t.arcs);
}

/* ------------------------------------------------------------------------------------------------ kept */

TEST(fails_wherever_memory_ends) {
    AUTO(free_at) struct turtle t = walk_gear(30, 0.5);
    const narc_chain_options ring = {.closed = 1};
    size_t failures = 0;
    narc_status status = NARC_ERROR_MEMORY;
    for (size_t left = 0; status != NARC_OK; left++) {
        struct ledger ledger = {0};
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = ledger_store(&ledger);
        const narc_arc ball = {0, 0, 1, 0, 2 * PI};
        size_t found = 77;
        narc_error error;
        assert_int_equal(narc_add_shape(shapes, &ball, 1, NULL, NULL), NARC_OK);
        const uint64_t changes = shapes->change_count;
        ledger.limited = true;
        ledger.left = left;
        status = narc_add_chain(shapes, t.arcs, t.count, &ring, entries, MOST, &found, &error);
        ledger.limited = false;
        if (status != NARC_OK) {
            expect_error(status, NARC_ERROR_MEMORY, &error, "no ");
            assert_int_equal(found, 77);
            assert_int_equal(narc_count_shapes(shapes), 1);
            assert_true(shapes->change_count == changes && shapes->piece_count == 0);
            assert_int_equal(narc_add_chain(shapes, t.arcs, t.count, &ring, entries, MOST, &found, &error), NARC_OK);
            failures++;
        }
        assert_int_equal(shapes->piece_count + 1, shapes->count);
    }
    assert_int_equal(failures, 4); /* arcs, curves, headers, records */
}

static void add_ring(narc_shapes *shapes, size_t teeth, narc_chain_entry *out_entries, size_t *out_count) {
    AUTO(free_at) struct turtle t = walk_gear(teeth, 0.5);
    narc_error error;
    expect_ok(narc_add_chain(shapes, t.arcs, t.count, &(narc_chain_options){.closed = 1}, out_entries, MOST, out_count,
                             &error),
              &error);
}

TEST(refuses_pieces_that_are_too_large) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    AUTO(free_at) struct turtle t = create_turtle(0, 0, PI / 2 + 1);
    size_t count = 77;
    narc_error error;
    walk_arc(&t, 3e9, -1.9);
    expect_error(narc_add_chain(shapes, t.arcs, t.count, NULL, entries, MOST, &count, &error), NARC_ERROR_SIZE, &error,
                 "its bounding radius is");
    assert_int_equal(narc_count_shapes(shapes), 0);
    assert_int_equal(count, 77);
}

/* A chain whose last piece is a shape with as many uses as it can have: none of its pieces is added. */
TEST(adds_no_piece_where_one_is_used_most) {
    static narc_chain_entry first[MOST], second[MOST];
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    AUTO(free_at) struct turtle t = walk_gear(6, 0.5);
    size_t count, again = 77;
    narc_error error;
    add_ring(shapes, 6, first, &count);
    const uint32_t last = first[count - 1].shape, uses = shapes->entries[last].uses;
    shapes->entries[last].uses = UINT32_MAX;
    expect_error(
        narc_add_chain(shapes, t.arcs, t.count, &(narc_chain_options){.closed = 1}, second, MOST, &again, &error),
        NARC_ERROR_COUNT, &error, "which is most");
    assert_int_equal(again, 77);
    shapes->entries[last].uses = uses;
    for (size_t k = count; k-- > 0;)
        assert_int_equal(narc_remove_shape(shapes, first[k].shape, NULL), NARC_OK);
    assert_int_equal(shapes->piece_count, 0);
}

/* What circles read of pieces is what their records say, wherever these went; other shapes have none. */
static void expect_piece_forms(const narc_shapes *shapes) {
    static const narc_piece_form none;
    for (uint32_t k = 0; k < shapes->count; k++) {
        const narc_shape_header *const header = &shapes->headers[k];
        const narc_piece_form *const form = &shapes->fronts[k];
        const bool is_piece = narc_has_shape(shapes, k) && narc_is_of_chain(header);
        assert_int_equal((shapes->boxes[k].info & NARC_HAS_FRONT) != 0, is_piece);
        if (!is_piece) {
            assert_memory_equal(form, &none, sizeof none);
            continue;
        }
        const narc_record *const arcs = narc_arcs_of(shapes, header);
        const narc_stored_arc *arc[4];
        for (size_t i = 0; i < 4; i++)
            arc[i] = &arcs[(i + header->count - (header->first_arc & NARC_FIRST_ARC)) % header->count].arc;
        const float *const normal[] = {&arc[1]->start_x, &arc[1]->end_x, &arc[2]->end_x};
        assert_memory_equal(form->center_0, &arc[0]->center_x, sizeof form->center_0);
        assert_memory_equal(form->center_1, &arc[1]->center_x, 3 * sizeof(float)); /* and the radius */
        assert_memory_equal(form->center_2, &arc[2]->center_x, sizeof form->center_2);
        assert_memory_equal(&shapes->boxes[k], &arc[3]->center_x, sizeof form->center_0);
        assert_memory_equal(form->normal_1, normal[0], sizeof form->normal_1);
        assert_memory_equal(form->normal_2, normal[1], sizeof form->normal_2);
        assert_memory_equal(form->normal_3, normal[2], sizeof form->normal_3);
        assert_memory_equal(&form->radius_2, &arc[2]->radius, sizeof(float));
        assert_memory_equal(&form->thickness, &arcs[header->count].solid.thickness, sizeof(float));
        assert_memory_equal(&shapes->boxes[k].radius, &header->bound_radius, sizeof(float));
        assert_int_equal(form->info & 0xff, header->count);
        assert_int_equal(form->info >> 8 & 0xff, header->first_arc & NARC_PIECE_MARKS);
        assert_int_equal(form->info >> 24, header->extent_ratio);
    }
}

/* Pieces come and go as shapes do, and are none that a list of arcs makes. */
TEST(keeps_pieces_as_shapes) {
    static narc_chain_entry first[MOST], second[MOST];
    narc_shapes *shapes = empty_store();
    size_t count, again;
    narc_arc arcs[NARC_MAX_ARCS];
    add_ring(shapes, 6, first, &count);
    const size_t shape_count = narc_count_shapes(shapes);
    add_ring(shapes, 6, second, &again);
    assert_int_equal(again, count);
    assert_memory_equal(first, second, count * sizeof *first);
    assert_int_equal(narc_count_shapes(shapes), shape_count);
    assert_int_equal(shapes->piece_count, shape_count);
    /* The closed outline of a run as a shape of its own. */
    const size_t run = first[0].run == NARC_NO_RUN ? 1 : 0;
    const size_t arc_count = narc_get_arcs(shapes, first[run].shape, arcs);
    uint32_t plain;
    assert_int_equal(narc_add_shape(shapes, arcs, arc_count, &plain, NULL), NARC_OK);
    assert_int_equal(plain, shape_count);
    assert_int_equal(narc_shape_flags(shapes, plain),
                     narc_shape_flags(shapes, first[run].shape) & ~(unsigned)NARC_SHAPE_RUN);
    assert_int_equal(shapes->piece_count, shape_count);
    /* A piece may be replaced by a shape, once it has one use. */
    const uint32_t uses = narc_count_uses(shapes, first[run].shape);
    for (uint32_t k = 1; k < uses; k++)
        assert_int_equal(narc_remove_shape(shapes, first[run].shape, NULL), NARC_OK);
    const narc_arc ball = {0, 0, 1, 0, 2 * PI};
    assert_int_equal(narc_replace_shape(shapes, first[run].shape, &ball, 1, NULL), NARC_OK);
    assert_int_equal(shapes->piece_count, shape_count - 1);
    assert_int_equal(narc_shape_flags(shapes, first[run].shape) & NARC_SHAPE_RUN, 0);
    expect_piece_forms(shapes);
    narc_destroy_shapes(shapes);
    shapes = empty_store();
    add_ring(shapes, 6, first, &count);
    for (size_t k = 0; k < count; k++)
        assert_int_equal(narc_remove_shape(shapes, first[k].shape, NULL), NARC_OK);
    assert_int_equal(shapes->piece_count, 0);
    assert_int_equal(shapes->removed_count, shapes->count);
    expect_piece_forms(shapes);
    for (int k = 0; k < 40; k++) /* in their places, and with memory that moves */
        add_ring(shapes, 6 + (size_t)k, first, &count);
    assert_int_equal(shapes->piece_count + shapes->removed_count, shapes->count);
    expect_piece_forms(shapes);
    narc_destroy_shapes(shapes);
}

/* The box is that of the front, and of what lies behind it as far as contacts are told. */
TEST(finds_boxes_of_fronts) {
    struct test_random random = test_random_named("front boxes");
    for (size_t trial = 0; trial < test_trials(50); trial++) {
        AUTO(free_at) struct turtle t = walk_ground(&random, 20, 1.2);
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
        const size_t found = add(shapes, t.arcs, t.count, NULL);
        for (size_t k = 0; k < found; k++) {
            const struct front f = get_front(shapes, &entries[k]);
            const double angle = random_between(&random, 0, 7), scale = random_log_between(&random, 0.1, 10);
            const double c = cos(angle), s = sin(angle);
            const narc_shape_header *header = &shapes->headers[entries[k].shape];
            const double depth = (double)narc_arcs_of(shapes, header)[header->count].solid.depth;
            narc_aabb box, seen = {INFINITY, INFINITY, -INFINITY, -INFINITY};
            enum { STEPS = 2000 };
            for (size_t i = 0; i < f.count; i++)
                for (int step = 0; step <= STEPS; step++) {
                    const narc_arc *arc = &f.arcs[i];
                    const double normal = arc->start + find_turn(arc->start, arc->end) * ((double)step / STEPS);
                    const narc_point p = point_at(arc, normal);
                    for (int back = 0; back < 2; back++) {
                        const double x = p.x - entries[k].x - back * depth * cos(normal),
                                     y = p.y - entries[k].y - back * depth * sin(normal);
                        const double own[] = {scale * (c * x - s * y), scale * (s * x + c * y)};
                        seen = (narc_aabb){fmin(seen.min_x, own[0]), fmin(seen.min_y, own[1]), fmax(seen.max_x, own[0]),
                                           fmax(seen.max_y, own[1])};
                    }
                }
            assert_true(narc_get_aabb(shapes, entries[k].shape, (float)c, (float)s, (float)scale, &box));
            const double room = scale * (2e-5 * f.size + 1.1e-3 * depth),
                         least = 1e-7 * scale * f.size; /* the pose in floats */
            assert_true(box.min_x <= seen.min_x + least && box.min_y <= seen.min_y + least &&
                        box.max_x >= seen.max_x - least && box.max_y >= seen.max_y - least);
            assert_true(box.min_x >= seen.min_x - room && box.min_y >= seen.min_y - room &&
                        box.max_x <= seen.max_x + room && box.max_y <= seen.max_y + room);
        }
    }
}
