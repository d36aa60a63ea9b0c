/* SPDX-License-Identifier: MIT
 *
 * thin_ground.c - bodies beside thin ground, about its ends, through it and on one side of it alone: what is in the air is
 * told of no overlap in any form, what touches has one row.
 */
#include <math.h>
#include <stdlib.h>

#include "chains.h"
#include "expect.h"
#include "narc_broad_phase.h"

#define ROUNDING 1e-5f

static uint32_t add_shape(struct ground_scene *s, struct shape shape) { return store_shape(s->store, shape); }

static struct body turn_body(uint32_t shape, double x, double y, double angle) {
    struct body body = turned_body(angle, 1);
    body.x = x;
    body.y = y;
    body.shape = shape;
    return body;
}

/* Is there this separation, but for rounding? 0: it need not be. */
static bool has_separation(const float *separations, size_t count, float separation) {
    bool found = separation > -ROUNDING;
    for (size_t k = 0; k < count; k++)
        found = found || fabsf(separations[k] - separation) <= ROUNDING;
    return found;
}

/* Asks in every form: a cast that does not move hits with the deepest contact of its entry. Contacts round in float and
 * casts in double: where a tip lies on the seam of two entries, or at the very end of one, the one may tell of one entry what
 * the other one tells of its neighbour. */
static const struct told_rows *ask(const struct ground_scene *s, const struct body *body, narc_query query) {
    static struct told_rows told;
    float touches[GROUND_ENTRIES] = {0}, casts[GROUND_ENTRIES] = {0};
    ask_body(s, body, query, &told);
    for (size_t i = 0; i < told.contact_count; i++) {
        const narc_contact *c = &told.contacts[i];
        touches[c->pair] = fminf(touches[c->pair], c->separation);
    }
    for (size_t k = 0; k < s->count; k++)
        casts[k] = told.impacts[k].count == NARC_CAST_HIT ? fminf(0, told.impacts[k].separation) : 0;
    for (size_t k = 0; k < s->count; k++)
        if (fabsf(touches[k] - casts[k]) > ROUNDING &&
            !(has_separation(casts, s->count, touches[k]) && has_separation(touches, s->count, casts[k])))
            fail_msg("entry %zu: a contact of %g, but a cast of %g", k, (double)touches[k], (double)casts[k]);
    return &told;
}

static void expect_near(double found, double right, double room, const char *what) {
    if (!(fabs(found - right) <= room))
        fail_msg("%s is %.9g, not %.9g", what, found, right);
}

/* A slab as a chain, and as one box or capsule beside which bodies are apart or not. */
TEST(test_triangles_round_ends) {
    struct test_random random = test_random_named("triangles round ends");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        const double thick = random_log_between(&random, 0.02, 0.6), wide = 10;
        const bool is_round = trial % 2;
        struct turtle t = create_turtle(wide / 2, thick / 2, PI / 2);
        for (int k = 0; k < 2; k++) {
            walk_line(&t, wide);
            walk_arc(&t, is_round ? thick / 2 : 0, PI / 2);
            walk_line(&t, is_round ? 0 : thick);
            walk_arc(&t, is_round ? thick / 2 : 0, PI / 2);
        }
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, true), (narc_chain_options){0});
        const uint32_t solid = add_shape(s, is_round ? capsule_of(wide, thick / 2) : box_of(wide, thick, 0));
        const double size = random_log_between(&random, 0.1, 1);
        const size_t sides = 3 + random_below(&random, 3);
        const uint32_t triangle = add_shape(s, regular_of(sides, size, 0));
        for (int k = 0; k < 100; k++) {
            const struct body two[] = {turn_body(triangle, wide / 2 + size * random_between(&random, -1.2, 1.2),
                                                 (thick / 2 + size) * random_between(&random, -1.2, 1.2),
                                                 random_between(&random, -PI, PI)),
                                       turn_body(solid, 0, 0, 0)};
            const narc_bodies bodies = view_columns(two, 2);
            narc_contact contact;
            size_t found;
            narc_error error;
            expect_ok(narc_find_contacts(s->store, &bodies, &(narc_pairs){.count = 1},
                                         &(narc_query){.margin = INFINITY}, &contact, 1, &found, &error),
                      &error);
            const struct told_rows *told = ask(s, &two[0], (narc_query){0});
            const double room = 1e-4;
            const double most = fmin(0.45 * thick, 0.5 * size * cos(PI / 3));
            if (contact.separation > room
                    ? told->count > 0
                    : contact.separation < -room && contact.separation > -most && told->count == 0)
                fail_msg("%g thick: apart by %g, %zu rows, the deepest of %g", thick, (double)contact.separation,
                         told->count, (double)told->deepest);
            const double promised =
                fmin(0.9 * thick / 2, 2 * size * cos(PI / (double)sides)); /* the inscribed circle */
            if (told->count > 0 && contact.separation < -room && (double)-contact.separation < promised)
                expect_near((double)told->deepest, (double)contact.separation, 1e-5, "depth");
        }
    }
}

/* A box on a level line whose corner has come onto a concave arc that goes on there has one row. */
TEST(test_level_line_into_a_bowl) {
    struct test_random random = test_random_named("level line into a bowl");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        const double radius = random_log_between(&random, 0.3, 3),
                     angle = trial % 2 ? 0 : random_between(&random, -PI, PI);
        struct turtle t = create_turtle(0, 0, angle);
        walk_arc(&t, 0, 0);
        walk_line(&t, 1);
        const double x = t.x, y = t.y;
        walk_arc(&t, radius, -1.2);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
        const double wide = random_between(&random, 0.05, 0.3), over = random_between(&random, 2e-4, 9e-4) * radius;
        const uint32_t box = add_shape(s, box_of(wide, wide / 2, 0));
        const double up = wide / 4 - 1e-7, along = over - wide / 2;
        const struct body body = turn_body(box, x + up * cos(angle) - along * sin(angle),
                                           y + up * sin(angle) + along * cos(angle), angle - PI / 2);
        const struct told_rows *told = ask(s, &body, (narc_query){.margin = 1e-3f});
        size_t level = 0;
        for (size_t k = 0; k < told->count; k++)
            level += told->rows[k].count;
        if (trial % 2 && !(told->count == 1 && level == 2)) /* exactly level */
            fail_msg("%zu rows with %zu points, %g over the seam of a radius %g", told->count, level, over, radius);
    }
}

#define VAULT_TURN 1.4
static const double vault_radius = 8, vault_thickness = 0.4;

/* Arcs of one circle above, and of another one below. */
static struct chain make_vault(size_t parts) {
    struct turtle t = create_turtle(0, 0, PI / 2 - VAULT_TURN / 2);
    for (int side = 0; side < 2; side++) {
        const double radius = side ? vault_radius - vault_thickness : vault_radius,
                     turn = side ? -VAULT_TURN : VAULT_TURN;
        for (size_t k = 0; k < parts; k++)
            walk_arc(&t, radius, turn / (double)parts);
        walk_arc(&t, 0, PI / 2);
        walk_line(&t, vault_thickness);
        walk_arc(&t, 0, PI / 2);
    }
    return end_walk(&t, true);
}

/* Boxes of entries meet those of all bodies that they answer: a tip that comes in through the next one, too. */
TEST(test_boxes_reach_back) {
    struct test_random random = test_random_named("boxes reach back");
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        const size_t parts = 4 + random_below(&random, 20);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(make_vault(parts), (narc_chain_options){0});
        narc_box boxes[GROUND_ENTRIES], own;
        const narc_bodies ground = view_columns(s->bodies, s->count);
        narc_error error;
        expect_ok(narc_compute_boxes(s->store, &ground, NULL, boxes, &error), &error);
        const uint32_t triangle = add_shape(s, regular_of(3, 0.075, 0));
        const narc_arc *first = &s->chain.arcs[0];
        for (int k = 0; k < 400; k++) {
            const double angle = first[1 + random_below(&random, parts - 1)].start +
                                 random_log_between(&random, 1e-6, 1e-2) * (k % 2 ? 1 : -1);
            const double reach = vault_radius - vault_thickness + random_log_between(&random, 1e-3, 0.012),
                         tilt = angle + random_between(&random, -0.5, 0.5);
            const struct body body = turn_body(triangle, first->center_x + reach * cos(angle) - 0.075 * cos(tilt),
                                               first->center_y + reach * sin(angle) - 0.075 * sin(tilt), tilt);
            const struct told_rows *told = ask(s, &body, (narc_query){0});
            const narc_bodies one = view_columns(&body, 1);
            expect_ok(narc_compute_boxes(s->store, &one, NULL, &own, &error), &error);
            assert_true(told->count > 0);
            for (size_t i = 0; i < told->count; i++) {
                const narc_box *box = &boxes[told->rows[i].pair];
                if (!(box->min_x <= own.max_x && own.min_x <= box->max_x && box->min_y <= own.max_y &&
                      own.min_y <= box->max_y))
                    fail_msg("%g deep: the boxes do not meet", (double)find_deepest(&told->rows[i]));
            }
        }
    }
}

/* Two arcs of a lens, one of them much larger than the lens, meet where it is deepest in a line of several entries: the
 * normal there is the line's up to rounding, and casts begin with what contacts say. */
TEST(test_lenses_in_a_slope) {
    struct test_random random = test_random_named("lenses in a slope");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        const double slope = random_between(&random, -0.5, 0.5);
        struct turtle t = create_turtle(0, 0, PI / 2 + slope);
        walk_arc(&t, 0, 0);
        walk_line(&t, 20);
        walk_arc(&t, 0, 0);
        AUTO(destroy_ground_scene_at)
        struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){.weld = 3});
        const struct shape lens = make_shape(&random, FAMILY_LENS);
        const uint32_t shape = add_shape(s, lens);
        for (int k = 0; k < 40; k++) {
            const narc_arc *arc = &lens.arcs[random_below(&random, lens.count)];
            const double angle = slope - PI / 2 - arc->end, depth = random_log_between(&random, 1e-4, 1e-2);
            const double c = cos(angle), d = sin(angle), along = random_between(&random, 8, 12);
            const narc_point p = chain_point(arc, arc->end);
            const struct body body = turn_body(shape, -along * cos(slope) + depth * sin(slope) - (c * p.x - d * p.y),
                                               -along * sin(slope) - depth * cos(slope) - (d * p.x + c * p.y), angle);
            const struct told_rows *told = ask(s, &body, (narc_query){0});
            assert_true(told->count > 0);
            expect_near((double)find_deepest(&told->rows[0]), -depth, 1e-5, "separation");
        }
    }
}

/* A bent sheet of two chains, its upper side and its lower one, which know nothing of each other: a plank over the ridge. */
TEST(test_given_thickness) {
    const double slope = 0.3, turn = 2 * slope, thick = 0.08;
    for (int given = 0; given < 2; given++) {
        AUTO(destroy_ground_scene_at) struct ground_scene *s = create_ground_scene();
        narc_error error = {0};
        for (int lower = 0; lower < 2; lower++) {
            struct turtle t = create_turtle(lower ? -4 : 4, -4 * tan(slope) - lower * thick / cos(slope),
                                            PI / 2 - (lower ? -slope - PI : slope));
            t.normal = lower ? slope - PI / 2 : PI / 2 - slope;
            walk_arc(&t, 0, 0);
            walk_line(&t, 4 / cos(slope));
            walk_arc(&t, 0, lower ? -turn : turn);
            walk_line(&t, 4 / cos(slope));
            walk_arc(&t, 0, 0);
            const narc_chain_options options = {.thickness = given ? (float)thick : 0};
            expect_ok(add_ground(s, end_walk(&t, false), options, &error), &error);
        }
        const uint32_t plank = add_shape(s, box_of(2.4, 0.3, 0));
        const struct body above = turn_body(plank, 0, 0.16, 0), low = turn_body(plank, 0, 0.13, 0);
        assert_int_equal(ask(s, &above, (narc_query){0})->count > 0, !given);
        const struct told_rows *told = ask(s, &low, (narc_query){0});
        float least = -INFINITY; /* the least deep */
        for (size_t k = 0; k < told->count; k++)
            least = fmaxf(least, find_deepest(&told->rows[k]));
        assert_true(told->count > 0);
        expect_near((double)least, -0.02, 1e-5, "depth");
    }
}

/* A line that is ground on both sides: balls on either, at its ends, and through it. */
TEST(test_both_sides) {
    struct test_random random = test_random_named("both sides");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        struct turtle t = create_turtle(5, 0, PI / 2);
        walk_arc(&t, 0, 0);
        walk_line(&t, 3);
        if (trial % 4 == 1)
            walk_arc(&t, 2, 1);
        if (trial % 4 == 2)
            walk_arc(&t, 2, -1);
        if (trial % 4 == 3)
            walk_arc(&t, 0, 0.7);
        walk_line(&t, 3);
        walk_arc(&t, 0, 0);
        AUTO(destroy_ground_scene_at)
        struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){.both_sides = 1});
        const double radius = random_log_between(&random, 0.1, 1);
        const uint32_t ball = add_shape(s, circle_of(radius));
        for (int k = 0; k < 40; k++) {
            const double x = random_between(&random, 2.1, 4.9), side = k % 2 ? 1 : -1;
            const double away = radius * random_between(&random, 0.05, 1.5);
            struct body body = turn_body(ball, x, side * away, random_between(&random, -PI, PI));
            if (x - 2 < radius)
                continue;
            const struct told_rows *told = ask(s, &body, (narc_query){0});
            if (told->count != (away < radius))
                fail_msg("trial %zu, a ball of %g at %g, %g: %zu rows, the first of %g", trial, radius, x, side * away,
                         told->count, told->count ? (double)find_deepest(&told->rows[0]) : 0);
            if (away < radius) {
                expect_near((double)find_deepest(&told->rows[0]), away - radius, 1e-5, "separation");
                expect_near((double)told->rows[0].normal_y, -side, 1e-5, "normal");
            }
            const double angle = random_between(&random, -PI / 2, PI / 2); /* about the end */
            body.x = 5 + away * cos(angle);
            body.y = away * sin(angle);
            told = ask(s, &body, (narc_query){0});
            if (told->count != (away < radius))
                fail_msg("trial %zu, a ball of %g about the end, %g away, %g: %zu rows, the first of %g, second %g",
                         trial, radius, away, angle, told->count,
                         told->count ? (double)find_deepest(&told->rows[0]) : 0,
                         told->count > 1 ? (double)find_deepest(&told->rows[1]) : 0);
            if (away < radius)
                expect_near((double)find_deepest(&told->rows[0]), away - radius, 1e-5, "separation at the end");
        }
        for (size_t k = 0; k < s->count; k++)
            assert_in_range(s->entries[k].first_arc, 0, t.count - 1);
        narc_chain_entry none[1];
        size_t needed = 0;
        narc_error error;
        expect_error(
            narc_add_chain(s->store, t.arcs, t.count, &(narc_chain_options){.both_sides = 1}, none, 1, &needed, &error),
            NARC_ERROR_CAPACITY, &error, "room for 1 entries");
        assert_int_equal(needed, s->count);
    }
}

/* Balls at corners that are cut, much smaller than the ground beside these: one row each, with the way from the corner. */
TEST(test_small_balls_at_cut_corners) {
    struct test_random random = test_random_named("small balls at cut corners");
    static struct told_rows told;
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        const size_t sides = 3 + random_below(&random, 3);
        const double turn = 2 * PI / (double)sides;
        struct turtle t = create_turtle(0, 0, random_between(&random, -PI, PI));
        for (size_t k = 0; k < sides; k++) {
            walk_arc(&t, 0, turn);
            walk_line(&t, 4);
        }
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, true), (narc_chain_options){0});
        const double radius = random_log_between(&random, 1e-3, 1);
        const uint32_t ball = add_shape(s, circle_of(radius));
        for (int k = 0; k < 400; k++) {
            const narc_arc *arc = &s->chain.arcs[random_below(&random, sides)];
            const double angle = arc->start + turn * random_between(&random, 0.001, 0.999);
            const double away = radius * (k % 2 ? random_between(&random, 0.1, 0.9) : 0.999);
            const struct body body =
                turn_body(ball, arc->center_x + away * cos(angle), arc->center_y + away * sin(angle), 0);
            ask_body(s, &body, (narc_query){0}, &told);
            if (told.count != 1)
                fail_msg("a ball of %g, %g away, at %g of %g: %zu rows", radius, away, angle - arc->start, turn,
                         told.count);
            expect_near((double)told.deepest, away - radius, 1e-4, "separation");
        }
    }
}

/* Open ground ends straight below its end: a triangle that stands beside it, on the extension of a slope's inner side, is
 * in the air. */
TEST(test_beside_open_ends) {
    struct test_random random = test_random_named("beside open ends");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        const double slope = random_between(&random, 0.3, 0.5), level = random_between(&random, 0.1, 0.4);
        const bool has_corner = trial % 2;
        struct turtle t = create_turtle(0, 0, has_corner ? 0 : PI / 2);
        walk_arc(&t, 0, has_corner ? PI / 2 : 0); /* at the right end */
        walk_line(&t, level);
        walk_arc(&t, 0, slope + 0.05);
        walk_line(&t, 0.1);
        walk_arc(&t, 0.5, -0.05);
        const double x = t.x, y = t.y;
        walk_line(&t, 2);
        walk_arc(&t, 0, 0);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
        const double beside = random_log_between(&random, 1e-3, 0.1), along = random_between(&random, 0.01, 0.05);
        const double foot_x = x - along * cos(slope), foot_y = y - along * sin(slope);
        const double depth = (beside - foot_x) / sin(slope), size = depth * random_between(&random, 1.02, 1.5);
        const double lean = PI / 3 - random_between(&random, 0, PI / 6 - slope);
        struct body body = turn_body(add_shape(s, regular_of(3, size, 0)), beside + size * cos(lean),
                                     foot_y - depth * cos(slope) + size * sin(lean), lean - PI);
        const struct told_rows *told = ask(s, &body, (narc_query){0});
        if (told->count > 0)
            fail_msg("trial %zu: a triangle %g beside the end is told of %g", trial, beside,
                     (double)find_deepest(&told->rows[0]));
    }
}

/* A long box over the end of a short line, tilted by less than what tells its edge from the line: casts begin with it. */
TEST(test_long_boxes_over_an_end) {
    struct turtle t = create_turtle(0.5, 0, PI / 2);
    walk_arc(&t, 0, 0);
    walk_line(&t, 1);
    walk_arc(&t, 0, 0);
    AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
    const uint32_t box = add_shape(s, box_of(8, 1, 0));
    for (int side = -1; side <= 1; side += 2)
        for (int k = -8; k <= 8; k++) {
            const struct body body = turn_body(box, 4 * side, 0.49, k * 1e-7);
            assert_int_equal(ask(s, &body, (narc_query){0})->contact_count, 1);
        }
}

/* What a cast of one body against the first entry comes to, all else as its motion says. */
static int cast_first(const struct ground_scene *s, const struct body *body, float y, float angle,
                      uint32_t front_only) {
    const uint32_t first = 0;
    const narc_bodies own = view_columns(body, 1), ground = view_columns(s->bodies, s->count);
    const narc_pairs pairs = {
        .count = 1, .a = {&first, sizeof first}, .b = {&first, sizeof first}, .other_bodies = &ground};
    const narc_motions motions = {.y = {&y, 0}, .angle = {&angle, 0}};
    const narc_cast_options options = {.front_only = front_only};
    narc_impact impact;
    narc_error error;
    expect_ok(narc_cast_pairs(s->store, &own, &motions, &pairs, NULL, &options, &impact, 1, &error), &error);
    return impact.count == NARC_CAST_HIT ? 1 + (impact.fraction > 0) : impact.count;
}

/* A platform that is ground for what comes from above. */
TEST(test_front_only) {
    struct turtle t = create_turtle(5, 0, PI / 2);
    walk_arc(&t, 0, 0);
    walk_line(&t, 10);
    walk_arc(&t, 0, 0);
    AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
    const uint32_t shapes[] = {add_shape(s, circle_of(0.5)), add_shape(s, box_of(2, 1, 0)),
                               add_shape(s, regular_of(3, 0.5, 0))};
    for (int k = 0; k < 3; k++)
        for (double y = 0.61; y > -0.6; y -= 0.05) {
            const struct body body = turn_body(shapes[k], 0, y, k == 2 ? -PI / 2 : 0);
            const bool touches = y < 0.5 && y > (k == 2 ? -0.25 : -0.5);
            assert_int_equal(ask(s, &body, (narc_query){0})->count, touches);
            assert_int_equal(ask(s, &body, (narc_query){.front_only = 1})->count, touches && y > 0);
            for (int turns = 0; turns < 2; turns++) { /* a hit is 1 at the start, and 2 later */
                const float angle = turns ? 0.05f : 0;
                assert_int_equal(cast_first(s, &body, -2, angle, 1), y < 0 ? 0 : touches ? 1 : 2);
                assert_int_equal(cast_first(s, &body, 2, angle, 1), y < 0 ? 0 : touches);
                assert_int_equal(cast_first(s, &body, 2, angle, 0), touches);
            }
        }
}

/* Balls in a shallow bowl of thick ground, no deeper than they are wide, or as their middle is in front. */
TEST(test_balls_in_a_thick_bowl) {
    const double sine = sin(0.25), cosine = cos(0.25);
    struct turtle t = create_turtle(20 * sine, 20 - 20 * cosine, PI / 2 + 0.25);
    walk_arc(&t, 20, -0.5);
    AUTO(destroy_ground_scene_at)
    struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){.thickness = 10});
    const uint32_t shape = add_shape(s, circle_of(0.5));
    for (double y = 0.61; y > -0.8; y -= 0.05) {
        const struct body body = turn_body(shape, 0, y, 0);
        assert_int_equal(ask(s, &body, (narc_query){0})->count, y < 0.5 && y > -0.5);
        assert_int_equal(ask(s, &body, (narc_query){.front_only = 1})->count, y < 0.5 && y > 0);
    }
}

TEST_MAIN("thin ground")
