/* SPDX-License-Identifier: MIT
 *
 * thin_ground.c - bodies beside thin ground, about its ends, through it and on one side of it alone: what is in the air is
 * told of no overlap in any form, what touches has one row.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "expect.h"
#include "families.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "scene.h"
#include "turtle.h"

enum { ENTRIES = 400, ROWS = 1600 };

#define ROUNDING 1e-5f

/* Entries as bodies, and one body. */
struct setting {
    narc_shapes *store;
    narc_chain_entry entries[ENTRIES];
    narc_body bodies[ENTRIES];
    uint32_t runs[ENTRIES];
    size_t count;
};

/* What a body is told, merged. */
struct told {
    narc_manifold rows[ROWS];
    size_t count, below; /* below: with a separation below 0 */
    uint32_t entry[ROWS];
};

static struct setting *begin_setting(void) {
    struct setting *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->store = empty_store();
    return s;
}

static void end_setting(struct setting *s) {
    narc_destroy_shapes(s->store);
    free(s);
}

static void add_ground(struct setting *s, const struct turtle *t, narc_chain_options options) {
    narc_error error;
    size_t found;
    options.first_run = (uint32_t)s->count;
    expect_ok(narc_add_chain(s->store, t->arcs, t->count, &options, s->entries + s->count, ENTRIES - s->count, &found,
                             &error),
              &error);
    for (size_t end = s->count + found; s->count < end; s->count++) {
        const narc_chain_entry *e = &s->entries[s->count];
        s->bodies[s->count] = (narc_body){e->x, e->y, 1, 0, 1, e->shape};
        s->runs[s->count] = e->run;
    }
}

static struct shape regular_of(size_t corners, double size) {
    struct shape shape;
    narc_error error;
    expect_ok(narc_build_regular_polygon(corners, size, 0, shape.arcs, &shape.count, &error), &error);
    return shape;
}

static uint32_t add_shape(struct setting *s, struct shape shape) { return store_shape(s->store, shape); }

static narc_body turn_body(uint32_t shape, double x, double y, double angle) {
    return (narc_body){x, y, (float)cos(angle), (float)sin(angle), 1, shape};
}

/* Is there this separation, but for rounding? 0: it need not be. */
static bool has_separation(const float *separations, size_t count, float separation) {
    bool found = separation > -ROUNDING;
    for (size_t k = 0; k < count; k++)
        found = found || fabsf(separations[k] - separation) <= ROUNDING;
    return found;
}

/* Asks in every form: overlaps are contacts below 0, and a cast that does not move hits with the deepest contact of its
 * entry. Contacts round in float and casts in double: where a tip lies on the seam of two entries, or at the very end of one,
 * the one may tell of one entry what the other one tells of its neighbour. */
static struct told *ask(const struct setting *s, const narc_body *body, narc_query query) {
    static struct told told;
    static uint32_t a[ENTRIES], b[ENTRIES];
    static narc_contact contacts[ROWS];
    static narc_impact impacts[ENTRIES];
    uint64_t bits[NARC_BIT_WORDS(ENTRIES)] = {0};
    for (uint32_t k = 0; k < s->count; k++)
        b[k] = k;
    const narc_bodies own = narc_view_bodies(body, 1), ground = narc_view_bodies(s->bodies, s->count);
    const narc_pairs pairs = {.count = s->count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b), .other_bodies = &ground};
    size_t found;
    narc_error error;
    expect_ok(narc_find_contacts(s->store, &own, &pairs, &query, contacts, ROWS, &found, &error), &error);
    expect_ok(narc_find_overlaps(s->store, &own, &pairs, &query, bits, &error), &error);
    const narc_cast_options options = {.front_only = query.front_only};
    expect_ok(narc_cast_pairs(s->store, &own, NULL, &pairs, NULL, &options, impacts, ENTRIES, &error), &error);
    float touches[ENTRIES] = {0}, casts[ENTRIES] = {0};
    for (size_t i = 0; i < found; i++)
        touches[contacts[i].pair] = fminf(touches[contacts[i].pair], contacts[i].separation);
    for (uint32_t k = 0; k < s->count; k++) {
        assert_int_equal(bits[k / 64] >> k % 64 & 1, touches[k] < 0);
        casts[k] = impacts[k].count == NARC_CAST_HIT ? fminf(0, impacts[k].separation) : 0;
    }
    for (uint32_t k = 0; k < s->count; k++)
        if (fabsf(touches[k] - casts[k]) > ROUNDING &&
            !(has_separation(casts, s->count, touches[k]) && has_separation(touches, s->count, casts[k])))
            fail_msg("entry %u: a contact of %g, but a cast of %g", k, (double)touches[k], (double)casts[k]);
    expect_ok(narc_find_manifolds(s->store, &own, &pairs, &query, told.rows, ROWS, &found, &error), &error);
    told.count = narc_merge_manifolds(&pairs, NARC_ARRAY(s->runs), told.rows, found);
    told.below = 0;
    for (size_t k = 0; k < told.count; k++) {
        told.entry[k] = told.rows[k].pair;
        told.below +=
            told.rows[k].point[0].separation < 0 || (told.rows[k].count > 1 && told.rows[k].point[1].separation < 0);
    }
    return &told;
}

static float find_deepest(const narc_manifold *m) {
    return m->count > 1 ? fminf(m->point[0].separation, m->point[1].separation) : m->point[0].separation;
}

static void expect_near(double found, double right, double room, const char *what) {
    if (!(fabs(found - right) <= room))
        fail_msg("%s is %.9g, not %.9g", what, found, right);
}

static const narc_chain_options ring = {.closed = 1};

/* An arch of straight sides, and as a sheet back inside: from the right end to the left one. */
static struct turtle walk_arch(size_t sides, double radius, double thick) {
    const double turn = PI / (double)sides;
    struct turtle t = create_turtle(0, 0, turn / 2);
    for (int back = 0; back < 2; back++) {
        const double side = 2 * (radius - (back ? thick : 0)) * sin(turn / 2);
        for (size_t k = 0; k < sides; k++) {
            walk_line(&t, side);
            walk_arc(&t, 0, k + 1 == sides ? PI / 2 + turn / 2 * (back ? -1 : 1) : back ? -turn : turn);
        }
        walk_line(&t, thick);
        walk_arc(&t, 0, PI / 2 + turn / 2 * (back ? 1 : -1));
    }
    return t;
}

/* The outer side is convex: what lies above a line through a corner that the sides beside it do not cross is in the air. */
TEST(test_planks_over_arches) {
    struct test_random random = test_random_named("planks over arches");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        struct setting *s = begin_setting();
        const size_t sides = 4 + random_below(&random, 9);
        const double turn = PI / (double)sides, radius = 4, thick = random_log_between(&random, 0.02, 0.2);
        struct turtle t = walk_arch(sides, radius, thick);
        add_ground(s, &t, ring);
        const double wide = random_log_between(&random, 0.3, 6), high = random_log_between(&random, 0.05, 1);
        const uint32_t plank = add_shape(s, box_of(wide, high, 0));
        for (int k = 0; k < 40; k++) {
            const size_t at = random_below(&random, sides - 1);
            const double lean = random_between(&random, -turn / 2, turn / 2),
                         normal = t.arcs[at].start + turn / 2 + lean;
            const double up = high / 2 + random_log_between(&random, 1e-3, 0.1),
                         along = random_between(&random, -wide / 2, wide / 2);
            const narc_body body =
                turn_body(plank, t.arcs[at].center_x + up * cos(normal) - along * sin(normal),
                          t.arcs[at].center_y + up * sin(normal) + along * cos(normal), normal - PI / 2);
            const struct told *told = ask(s, &body, (narc_query){0});
            if (told->count > 0)
                fail_msg("%zu sides, %g thick: a plank %g above the sheet is told of %g", sides, thick, up - high / 2,
                         (double)find_deepest(&told->rows[0]));
        }
        free(t.arcs);
        end_setting(s);
    }
}

/* A slab as a chain, and as one box or capsule beside which bodies are apart or not. */
TEST(test_triangles_round_ends) {
    struct test_random random = test_random_named("triangles round ends");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        struct setting *s = begin_setting();
        const double thick = random_log_between(&random, 0.02, 0.6), wide = 10;
        const bool is_round = trial % 2;
        struct turtle t = create_turtle(wide / 2, thick / 2, PI / 2);
        for (int k = 0; k < 2; k++) {
            walk_line(&t, wide);
            walk_arc(&t, is_round ? thick / 2 : 0, PI / 2);
            walk_line(&t, is_round ? 0 : thick);
            walk_arc(&t, is_round ? thick / 2 : 0, PI / 2);
        }
        add_ground(s, &t, ring);
        const uint32_t solid = add_shape(s, is_round ? capsule_of(wide, thick / 2) : box_of(wide, thick, 0));
        const double size = random_log_between(&random, 0.1, 1);
        const uint32_t triangle = add_shape(s, regular_of(3 + random_below(&random, 3), size));
        for (int k = 0; k < 100; k++) {
            const narc_body two[] = {turn_body(triangle, wide / 2 + size * random_between(&random, -1.2, 1.2),
                                               (thick / 2 + size) * random_between(&random, -1.2, 1.2),
                                               random_between(&random, -PI, PI)),
                                     turn_body(solid, 0, 0, 0)};
            const narc_bodies bodies = narc_view_bodies(two, 2);
            narc_contact contact;
            size_t found;
            narc_error error;
            expect_ok(narc_find_contacts(s->store, &bodies, &(narc_pairs){.count = 1},
                                         &(narc_query){.margin = INFINITY}, &contact, 1, &found, &error),
                      &error);
            const struct told *told = ask(s, &two[0], (narc_query){0});
            const double room = 1e-4;
            const double most = fmin(0.45 * thick, 0.5 * size * cos(PI / 3));
            if (contact.separation > room
                    ? told->count > 0
                    : contact.separation < -room && contact.separation > -most && told->count == 0)
                fail_msg("%g thick: apart by %g, %zu rows, the first of %g", thick, (double)contact.separation,
                         told->count, told->count ? (double)find_deepest(&told->rows[0]) : 0);
            if (told->count > 0 && contact.separation < -room && (double)-contact.separation < 0.9 * thick / 2) {
                float least = 0;
                for (size_t i = 0; i < told->count; i++)
                    least = fminf(least, find_deepest(&told->rows[i]));
                expect_near((double)least, (double)contact.separation, 1e-5, "depth");
            }
        }
        free(t.arcs);
        end_setting(s);
    }
}

/* A box on a level line whose corner has come onto a concave arc that goes on there has one row. */
TEST(test_level_line_into_a_bowl) {
    struct test_random random = test_random_named("level line into a bowl");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        struct setting *s = begin_setting();
        const double radius = random_log_between(&random, 0.3, 3),
                     angle = trial % 2 ? 0 : random_between(&random, -PI, PI);
        struct turtle t = create_turtle(0, 0, angle);
        walk_arc(&t, 0, 0);
        walk_line(&t, 1);
        const double x = t.x, y = t.y;
        walk_arc(&t, radius, -1.2);
        add_ground(s, &t, (narc_chain_options){0});
        const double wide = random_between(&random, 0.05, 0.3), over = random_between(&random, 2e-4, 9e-4) * radius;
        const uint32_t box = add_shape(s, box_of(wide, wide / 2, 0));
        const double up = wide / 4 - 1e-7, along = over - wide / 2;
        const narc_body body = turn_body(box, x + up * cos(angle) - along * sin(angle),
                                         y + up * sin(angle) + along * cos(angle), angle - PI / 2);
        const struct told *told = ask(s, &body, (narc_query){.margin = 1e-3f});
        size_t level = 0;
        for (size_t k = 0; k < told->count; k++)
            level += told->rows[k].count;
        if (trial % 2 && !(told->count == 1 && level == 2)) /* exactly level */
            fail_msg("%zu rows with %zu points, %g over the seam of a radius %g", told->count, level, over, radius);
        free(t.arcs);
        end_setting(s);
    }
}

#define VAULT_TURN 1.4
static const double vault_radius = 8, vault_thickness = 0.4;

/* Arcs of one circle above, and of another one below. */
static struct turtle walk_vault(size_t parts) {
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
    return t;
}

/* Boxes of entries meet those of all bodies that they answer: a tip that comes in through the next one, too. */
TEST(test_boxes_reach_back) {
    struct test_random random = test_random_named("boxes reach back");
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        struct setting *s = begin_setting();
        const size_t parts = 4 + random_below(&random, 20);
        struct turtle t = walk_vault(parts);
        add_ground(s, &t, ring);
        narc_box boxes[ENTRIES], own;
        const narc_bodies ground = narc_view_bodies(s->bodies, s->count);
        narc_error error;
        expect_ok(narc_compute_boxes(s->store, &ground, NULL, boxes, &error), &error);
        const uint32_t triangle = add_shape(s, regular_of(3, 0.075));
        const narc_arc *first = &t.arcs[0];
        for (int k = 0; k < 400; k++) {
            const double angle = t.arcs[1 + random_below(&random, parts - 1)].start +
                                 random_log_between(&random, 1e-6, 1e-2) * (k % 2 ? 1 : -1);
            const double reach = vault_radius - vault_thickness + random_log_between(&random, 1e-3, 0.012),
                         tilt = angle + random_between(&random, -0.5, 0.5);
            const narc_body body = turn_body(triangle, first->center_x + reach * cos(angle) - 0.075 * cos(tilt),
                                             first->center_y + reach * sin(angle) - 0.075 * sin(tilt), tilt);
            const struct told *told = ask(s, &body, (narc_query){0});
            const narc_bodies one = narc_view_bodies(&body, 1);
            expect_ok(narc_compute_boxes(s->store, &one, NULL, &own, &error), &error);
            assert_true(told->count > 0);
            for (size_t i = 0; i < told->count; i++) {
                const narc_box *box = &boxes[told->entry[i]];
                if (!(box->min_x <= own.max_x && own.min_x <= box->max_x && box->min_y <= own.max_y &&
                      own.min_y <= box->max_y))
                    fail_msg("%g deep: the boxes do not meet", (double)find_deepest(&told->rows[i]));
            }
        }
        free(t.arcs);
        end_setting(s);
    }
}

/* The corner of a triangle is 6 mm deep in a ceiling of arcs of one circle, right beside a seam: pairs of boxes without a
 * margin have the entry that tells of it. */
TEST(test_box_beside_a_seam) {
    struct setting *s = begin_setting();
    struct turtle t = walk_vault(16);
    add_ground(s, &t, ring);
    const size_t count = s->count + 1;
    assert_true(count < ENTRIES);
    s->bodies[s->count] =
        turn_body(add_shape(s, regular_of(3, 0.075)), t.arcs[0].center_x - 0.7245, t.arcs[0].center_y + 7.5327, 0.6381);
    const narc_bodies all = narc_view_bodies(s->bodies, count);
    static narc_box boxes[ENTRIES];
    static uint32_t a[ENTRIES * 16], b[ENTRIES * 16];
    static narc_contact rows[ROWS];
    narc_error error;
    size_t pair_count, found, kept = 0;
    narc_broad_phase *broad;
    assert_int_equal(narc_create_broad_phase(NULL, &broad), NARC_OK);
    expect_ok(narc_compute_boxes(s->store, &all, NULL, boxes, &error), &error);
    expect_ok(narc_find_pairs(broad, boxes, count, NULL, NULL, a, b, ENTRIES * 16, &pair_count, &error), &error);
    for (size_t k = 0; k < pair_count; k++)
        if (b[k] == s->count) {
            a[kept] = a[k];
            b[kept++] = b[k];
        }
    const narc_pairs pairs = {.count = kept, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    expect_ok(narc_find_contacts(s->store, &all, &pairs, &(narc_query){0}, rows, ROWS, &found, &error), &error);
    float deepest = 0;
    for (size_t k = 0; k < found; k++)
        deepest = fminf(deepest, rows[k].separation);
    expect_near((double)deepest, -0.0064350766, 1e-5, "the corner's separation");
    narc_destroy_broad_phase(broad);
    free(t.arcs);
    end_setting(s);
}

/* Two arcs of a lens, one of them much larger than the lens, meet where it is deepest in a line of several entries: the
 * normal there is the line's up to rounding, and casts begin with what contacts say. */
TEST(test_lenses_in_a_slope) {
    struct test_random random = test_random_named("lenses in a slope");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        struct setting *s = begin_setting();
        const double slope = random_between(&random, -0.5, 0.5);
        struct turtle t = create_turtle(0, 0, PI / 2 + slope);
        walk_arc(&t, 0, 0);
        walk_line(&t, 20);
        walk_arc(&t, 0, 0);
        add_ground(s, &t, (narc_chain_options){.weld = 3});
        free(t.arcs);
        const struct shape lens = make_shape(&random, FAMILY_LENS);
        const uint32_t shape = add_shape(s, lens);
        for (int k = 0; k < 40; k++) {
            const narc_arc *arc = &lens.arcs[random_below(&random, lens.count)];
            const double angle = slope - PI / 2 - arc->end, depth = random_log_between(&random, 1e-4, 1e-2);
            const double c = cos(angle), d = sin(angle), along = random_between(&random, 8, 12);
            const double x = arc->center_x + arc->radius * cos(arc->end),
                         y = arc->center_y + arc->radius * sin(arc->end);
            const narc_body body = turn_body(shape, -along * cos(slope) + depth * sin(slope) - (c * x - d * y),
                                             -along * sin(slope) - depth * cos(slope) - (d * x + c * y), angle);
            const struct told *told = ask(s, &body, (narc_query){0});
            assert_true(told->count > 0);
            expect_near((double)find_deepest(&told->rows[0]), -depth, 1e-5, "separation");
        }
        end_setting(s);
    }
}

/* A bent sheet of two chains, its upper side and its lower one, which know nothing of each other: a plank over the ridge. */
TEST(test_given_thickness) {
    const double slope = 0.3, turn = 2 * slope, thick = 0.08;
    for (int given = 0; given < 2; given++) {
        struct setting *s = begin_setting();
        for (int lower = 0; lower < 2; lower++) {
            struct turtle t = create_turtle(lower ? -4 : 4, -4 * tan(slope) - lower * thick / cos(slope),
                                            PI / 2 - (lower ? -slope - PI : slope));
            t.normal = lower ? slope - PI / 2 : PI / 2 - slope;
            walk_arc(&t, 0, 0);
            walk_line(&t, 4 / cos(slope));
            walk_arc(&t, 0, lower ? -turn : turn);
            walk_line(&t, 4 / cos(slope));
            walk_arc(&t, 0, 0);
            add_ground(s, &t, (narc_chain_options){.thickness = given ? (float)thick : 0});
            free(t.arcs);
        }
        const uint32_t plank = add_shape(s, box_of(2.4, 0.3, 0));
        const narc_body above = turn_body(plank, 0, 0.16, 0), low = turn_body(plank, 0, 0.13, 0);
        assert_int_equal(ask(s, &above, (narc_query){0})->count > 0, !given);
        const struct told *told = ask(s, &low, (narc_query){0});
        float least = -INFINITY; /* the least deep */
        for (size_t k = 0; k < told->count; k++)
            least = fmaxf(least, find_deepest(&told->rows[k]));
        assert_true(told->count > 0);
        expect_near((double)least, -0.02, 1e-5, "depth");
        end_setting(s);
    }
}

/* A line that is ground on both sides: balls on either, at its ends, and through it. */
TEST(test_both_sides) {
    struct test_random random = test_random_named("both sides");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        struct setting *s = begin_setting();
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
        add_ground(s, &t, (narc_chain_options){.both_sides = 1});
        const double radius = random_log_between(&random, 0.1, 1);
        const uint32_t ball = add_shape(s, circle_of(radius));
        for (int k = 0; k < 40; k++) {
            const double x = random_between(&random, 2.1, 4.9), side = k % 2 ? 1 : -1;
            const double away = radius * random_between(&random, 0.05, 1.5);
            narc_body body = turn_body(ball, x, side * away, random_between(&random, -PI, PI));
            if (x - 2 < radius)
                continue;
            const struct told *told = ask(s, &body, (narc_query){0});
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
        free(t.arcs);
        end_setting(s);
    }
}

/* Open ground ends straight below its end: a triangle that stands beside it, on the extension of a slope's inner side, is
 * in the air. */
TEST(test_beside_open_ends) {
    struct test_random random = test_random_named("beside open ends");
    for (size_t trial = 0; trial < test_trials(100); trial++) {
        struct setting *s = begin_setting();
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
        add_ground(s, &t, (narc_chain_options){0});
        free(t.arcs);
        const double beside = random_log_between(&random, 1e-3, 0.1), along = random_between(&random, 0.01, 0.05);
        const double foot_x = x - along * cos(slope), foot_y = y - along * sin(slope);
        const double depth = (beside - foot_x) / sin(slope), size = depth * random_between(&random, 1.02, 1.5);
        const double lean = PI / 3 - random_between(&random, 0, PI / 6 - slope);
        narc_body body = turn_body(add_shape(s, regular_of(3, size)), beside + size * cos(lean),
                                   foot_y - depth * cos(slope) + size * sin(lean), lean - PI);
        const struct told *told = ask(s, &body, (narc_query){0});
        if (told->count > 0)
            fail_msg("trial %zu: a triangle %g beside the end is told of %g", trial, beside,
                     (double)find_deepest(&told->rows[0]));
        end_setting(s);
    }
}

/* What a cast of one body against the first entry comes to, all else as its motion says. */
static int cast_first(const struct setting *s, const narc_body *body, float y, float angle, uint32_t front_only) {
    const uint32_t first = 0;
    const narc_bodies own = narc_view_bodies(body, 1), ground = narc_view_bodies(s->bodies, s->count);
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
    struct setting *s = begin_setting();
    struct turtle t = create_turtle(5, 0, PI / 2);
    walk_arc(&t, 0, 0);
    walk_line(&t, 10);
    walk_arc(&t, 0, 0);
    add_ground(s, &t, (narc_chain_options){0});
    free(t.arcs);
    const uint32_t shapes[] = {add_shape(s, circle_of(0.5)), add_shape(s, box_of(2, 1, 0)),
                               add_shape(s, regular_of(3, 0.5))};
    for (int k = 0; k < 3; k++)
        for (double y = 0.61; y > -0.6; y -= 0.05) {
            const narc_body body = turn_body(shapes[k], 0, y, k == 2 ? -PI / 2 : 0);
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
    end_setting(s);
}

TEST_MAIN("thin ground")
