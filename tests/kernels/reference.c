/* SPDX-License-Identifier: MIT
 *
 * reference.c - is the reference itself right? One way against another; formula.c compares it with the formula, known.c with
 * answers that are known.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "chains.h"
#include "corpus.h"
#include "placements.h"

/* What the reference claims, relative to sizes near 1. */
static const double tolerance = 1e-12;

static struct reference_body at(const struct shape *shape, double x, double y, double angle) {
    return (struct reference_body){shape->arcs, shape->count, x, y, cos(angle), sin(angle), 1};
}

/* g at the returned direction is the returned gap, and no direction of many has more. */
TEST(test_maximum) {
    struct test_random random = test_random_named("maximum");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        struct shape shape_a = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        struct shape shape_b = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        struct body body_a, body_b;
        place_pair(&random, (enum placement)random_below(&random, PLACE_SCALED), NARC_FLOAT64, &shape_a, &shape_b,
                   &body_a, &body_b);
        struct reference_body a = pose_shape(&shape_a, &body_a), b = pose_shape(&shape_b, &body_b);
        struct reference_gap found = reference_find_gap(&a, &b);
        double reach = reference_reach(&a, &b);
        assert_true(fabs(reference_gap_along(&a, &b, found.normal_x, found.normal_y) - found.gap) <= tolerance * reach);
        for (int k = 0; k < 1000; k++) {
            double angle = 2 * PI * random_unit(&random);
            assert_true(reference_gap_along(&a, &b, cos(angle), sin(angle)) <= found.gap + tolerance * reach);
        }
    }
}

/* Piece by piece against the search, for all that there is. Arcs of a shape miss each other by what their maker rounds, up
 * to some 1e-11 of the size: g has a step there, and either side of it is an answer. */
TEST(test_pieces) {
    static const double steps = 1e-11;
    double worst = 0;
    for (int precision = 0; precision < 2; precision++) {
        AUTO(destroy_corpus)
        struct corpus corpus = make_corpus("pieces", precision ? NARC_FLOAT64 : NARC_FLOAT32, 0.5, false);
        solve_corpus(&corpus);
        for (size_t k = 0; k < corpus.scene.pair_count; k++) {
            const struct exact_pair *pair = &corpus.pairs[k];
            const struct reference_gap found = reference_solve_gap(&pair->a, &pair->b);
            const double along = reference_gap_along(&pair->a, &pair->b, found.normal_x, found.normal_y);
            const double difference = fmax(fabs(found.gap - pair->gap), fabs(found.gap - along)) / pair->reach;
            assert_true(difference < steps && isfinite(along));
            worst = fmax(worst, difference);
        }
        printf("  %zu pairs, largest difference %.3g of their reach\n", corpus.scene.pair_count, worst);
    }
}

/* A circle around the centre of a capsule's end: all directions of the end are as good. */
TEST(test_common_centres) {
    const struct shape capsule = {{{1, 0, 0.5, -PI / 2, PI / 2}, {-1, 0, 0.5, PI / 2, 3 * PI / 2}}, 2};
    const struct shape circle = circle_of(0.5);
    for (size_t k = 0; k < 1000; k++) {
        const double angle = 2 * PI * (double)k / 1000;
        const struct reference_body a = at(&capsule, 0, 0, angle), b = at(&circle, cos(angle), sin(angle), 0);
        const struct reference_gap found = reference_solve_gap(&a, &b);
        assert_true(fabs(found.gap + 1) < tolerance);
        assert_true(fabs(reference_gap_along(&a, &b, found.normal_x, found.normal_y) + 1) < tolerance);
    }
}

/* The distance from a point by search against the library's closed form. */
TEST(test_point_distance) {
    struct test_random random = test_random_named("point distance");
    for (size_t trial = 0; trial < test_trials(1000); trial++) {
        struct shape shape = make_shape(&random, (enum family)(trial % FAMILY_COUNT));
        struct reference_body body = at(&shape, 7, 7, 0);
        narc_point point = {random_between(&random, -2, 2), random_between(&random, -2, 2)};
        double distance;
        assert_true(narc_compute_distance(shape.arcs, shape.count, &point, &distance));
        double searched = reference_point_distance(&body, point.x, point.y);
        if (fabs(searched - distance) > tolerance * (reference_extent(&body) + 3)) {
            fail_msg("%s: distance %.17g, by search %.17g", family_name((enum family)(trial % FAMILY_COUNT)), distance,
                     searched);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ ground */

/* A shape is a closed convex chain: the same signed distance, and of two shapes that are apart one minimum, the gap. */
TEST(test_ground_of_shapes) {
    struct test_random random = test_random_named("ground of shapes");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        struct shape below = make_shape(&random, (enum family)random_below(&random, FAMILY_SEGMENT));
        struct shape above = make_shape(&random, (enum family)random_below(&random, FAMILY_SEGMENT));
        for (size_t k = 0; k < below.count; k++)
            below.arcs[k].end += below.arcs[k].end <= below.arcs[k].start ? 2 * PI : 0;
        struct ground *ground = make_ground(&(struct chain){below.arcs, below.count, true});
        const narc_point point = {random_between(&random, -2, 2), random_between(&random, -2, 2)};
        double distance;
        assert_true(narc_compute_distance(below.arcs, below.count, &point, &distance));
        const double bound = 1e-9 * (2 + hypot(below.arcs[0].center_x, below.arcs[0].center_y));
        if (fabs(ground_distance(ground, point).distance - distance) > bound)
            fail_msg("distance %.17g, of the ground %.17g", distance, ground_distance(ground, point).distance);

        const struct body still = turned_body(0, 1);
        struct body body = turned_body(random_between(&random, -PI, PI), 1);
        place_at_gap(&below, &above, random_between(&random, -PI, PI), random_between(&random, 0, 0.1), &still, &body);
        const struct reference_body a = pose_shape(&below, &still), b = pose_shape(&above, &body);
        const double gap = reference_find_gap(&a, &b).gap;
        struct ground_minimum minima[GROUND_MINIMA];
        struct ground_search *search = search_ground(ground, &b, 1, 0.01, 1);
        const size_t count = ground_minima(search, 1e-9, minima);
        if (count != 1 || fabs(minima[0].foot.distance - gap) > bound)
            fail_msg("%zu minima, the first one %.12g, gap %.12g", count, minima[0].foot.distance, gap);
        destroy_search(search);
        destroy_ground(ground);
    }
}

/* The least distance over a disc is that of its centre, less its radius, unless it is on the solid side; there it may be
 * more: below a corner the corner is not the nearest. (Beyond open ends there is no distance.) */
TEST(test_ground_under_discs) {
    struct test_random random = test_random_named("ground under discs");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        AUTO(free_at) const struct chain chain = make_chain(&random, (enum chain_family)(trial % CHAIN_FAMILIES));
        const struct shape disc = circle_of(random_log_between(&random, 0.1, 1));
        const struct body body = ride_chain(&random, &chain, &disc, 0.1);
        const struct reference_body posed = pose_shape(&disc, &body);
        AUTO(destroy_ground_at) struct ground *ground = make_ground(&chain);
        struct ground_search *search = search_ground(ground, &posed, 0.5, 0.02, 0.2);
        const double middle = ground_distance(ground, (narc_point){body.x, body.y}).distance;
        const double radius = disc.arcs[0].radius * hypot(posed.cosine, posed.sine);
        struct ground_minimum minima[GROUND_MINIMA];
        double least = INFINITY;
        for (size_t k = ground_minima(search, 0, minima); k > 0; k--)
            least = fmin(least, minima[k - 1].foot.distance);
        const double off = least - fmin(middle - radius, 0.5);
        const narc_arc *first = &chain.arcs[0], *last = &chain.arcs[chain.count - 1];
        const double to_first = hypot(first->center_x + first->radius * cos(first->start) - body.x,
                                      first->center_y + first->radius * sin(first->start) - body.y);
        const double to_last = hypot(last->center_x + last->radius * cos(last->end) - body.x,
                                     last->center_y + last->radius * sin(last->end) - body.y);
        const double end = chain.closed ? INFINITY : fmin(to_first, to_last);
        if (end > 2 * radius + fabs(middle) && (off < -1e-9 || (middle >= radius && off > 1e-9)))
            fail_msg("%s: least distance %.12g instead of %.12g",
                     chain_family_name((enum chain_family)(trial % CHAIN_FAMILIES)), least, middle - radius);
        destroy_search(search);
    }
}

/* The distance of a body from the ground is that of the nearest of many points of its outline, but for the way between
 * them; it is in the air if they all are. */
TEST(test_clearance_of_ground) {
    enum { DIRECTIONS = 512, PARTS = 8 };
    struct test_random random = test_random_named("clearance of ground");
    size_t in_air = 0, met = 0;
    for (size_t trial = 0; trial < test_trials(20 * CHAIN_FAMILIES); trial++) {
        AUTO(free_at) const struct chain chain = make_chain(&random, (enum chain_family)(trial % CHAIN_FAMILIES));
        const struct shape shape = make_rider(&random, &chain, (enum chain_family)(trial % CHAIN_FAMILIES));
        AUTO(destroy_ground_at) struct ground *ground = make_ground(&chain);
        const double gap = random_between(&random, -0.1, 0.3);
        const struct body body = approach_chain(&random, &chain, ground, &shape, gap);
        const struct reference_body posed = pose_shape(&shape, &body);
        const struct ground_clearance found = ground_find_clearance(ground, &posed);
        narc_point last = {0, 0};
        double least = INFINITY, lowest = INFINITY, way = 0;
        for (int k = 0; k <= DIRECTIONS; k++) {
            narc_point own;
            narc_find_support(shape.arcs, shape.count, cos(2 * PI * k / DIRECTIONS), sin(2 * PI * k / DIRECTIONS), &own,
                              NULL);
            const narc_point at = {posed.x + posed.scale * (posed.cosine * own.x - posed.sine * own.y),
                                   posed.y + posed.scale * (posed.sine * own.x + posed.cosine * own.y)};
            for (int i = 0; i < PARTS && k > 0; i++) {
                const double part = (double)i / PARTS;
                const narc_point p = {last.x + part * (at.x - last.x), last.y + part * (at.y - last.y)};
                least = fmin(least, ground_outline_distance(ground, p));
                lowest = fmin(lowest, ground_distance(ground, p).distance);
            }
            way = fmax(way, k > 0 ? hypot(at.x - last.x, at.y - last.y) : 0);
            last = at;
        }
        const bool is_around =
            reference_point_distance(
                &posed, chain.arcs[0].center_x + chain.arcs[0].radius * cos(chain.arcs[0].start) - posed.x,
                chain.arcs[0].center_y + chain.arcs[0].radius * sin(chain.arcs[0].start) - posed.y) < 0;
        const double room = way / PARTS + 1e-4 * reference_extent(&posed);
        if (found.distance > least + room || (found.distance > 0 && found.distance < least - room) ||
            (found.in_air && lowest < -1e-4 * reference_extent(&posed)) ||
            (!found.in_air && chain.closed && lowest > room && !is_around))
            fail_msg("%s: distance %.9g, %s the air; of many points %.9g, %.9g",
                     chain_family_name((enum chain_family)(trial % CHAIN_FAMILIES)), found.distance,
                     found.in_air ? "in" : "not in", least, lowest);
        in_air += found.in_air;
        met += !(found.distance > 0);
    }
    print_message("  %zu in the air, %zu meet the ground\n", in_air, met);
    assert_true(test_trials(100) < 100 || (in_air > test_trials(100) && met > test_trials(20)));
}

TEST_MAIN("reference")
