/* SPDX-License-Identifier: MIT
 *
 * ground_casts.c - bodies that fly through the air beside ground of all kinds: the first impact of a cast with all
 * entries is where narc_find_contacts() first tells of one, looked for at many times.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "everywhere.h"
#include "expect.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "turtle.h"

enum { ENTRIES = 2 * CHAIN_ARCS, ROWS = 8 * ENTRIES, TIMES = 160 };

/* A chain in a store, and its entries as bodies; the last body moves. */
struct setting {
    narc_shapes *store;
    narc_arc arcs[CHAIN_ARCS];
    struct chain chain;
    struct ground *ground;
    narc_chain_entry entries[ENTRIES];
    size_t count;
    struct body bodies[ENTRIES], mover;
    struct shape shape; /* the mover's */
};

/* ------------------------------------------------------------------------------------------------ ground */

static bool add_chain(struct setting *s) {
    narc_error error = {0};
    const narc_chain_options options = {.closed = s->chain.closed};
    const narc_status status =
        narc_add_chain(s->store, s->arcs, s->chain.count, &options, s->entries, ENTRIES, &s->count, &error);
    if (status == NARC_ERROR_RADIUS || status == NARC_ERROR_NOT_SIMPLE || status == NARC_ERROR_SIZE)
        return false;
    expect_ok(status, &error);
    for (size_t k = 0; k < s->count; k++)
        s->bodies[k] = (struct body){
            .x = s->entries[k].x, .y = s->entries[k].y, .cosine = 1, .scale = 1, .shape = s->entries[k].shape};
    return true;
}

static void take_turtle(struct setting *s, struct turtle *t, bool closed) {
    assert_true(t->count <= CHAIN_ARCS);
    memcpy(s->arcs, t->arcs, t->count * sizeof *t->arcs);
    s->chain = (struct chain){s->arcs, t->count, closed};
    free(t->arcs);
}

/* By up to a whole turn. */
static void walk_turn(struct turtle *t, double radius, double turn) {
    walk_arc(t, radius, turn / 2);
    walk_arc(t, radius, turn / 2);
}

/* A horseshoe, open below. */
static void make_horseshoe(struct setting *s, double radius, double thickness) {
    const double turn = 5;
    struct turtle t = create_turtle(0.1, 0, TEST_PI / 2 - turn / 2);
    for (int side = 0; side < 2; side++) {
        walk_turn(&t, side ? radius : radius + thickness, side ? -turn : turn);
        walk_arc(&t, 0, TEST_PI / 2);
        walk_line(&t, thickness);
        walk_arc(&t, 0, TEST_PI / 2);
    }
    take_turtle(s, &t, true);
}

static struct setting *make_setting(struct test_random *random, enum chain_family family) {
    struct setting *s = calloc(1, sizeof *s);
    do {
        narc_destroy_shapes(s->store);
        s->store = empty_store();
        s->chain = make_chain(random, family, s->arcs);
    } while (!add_chain(s));
    s->ground = make_ground(&s->chain);
    return s;
}

static void end_setting(struct setting *s) {
    destroy_ground(s->ground);
    narc_destroy_shapes(s->store);
    free(s);
}

/* How large the chain is: the furthest end of a piece from the origin. */
static double find_extent(const struct chain *chain) {
    double most = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k];
        most = fmax(
            most, hypot(arc->center_x + arc->radius * cos(arc->start), arc->center_y + arc->radius * sin(arc->start)));
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------ what is told */

static narc_bodies bodies_of(const struct body *bodies, size_t count) {
    return (narc_bodies){.count = count,
                         .x = NARC_POSITION_COLUMN(bodies, x),
                         .y = NARC_POSITION_COLUMN(bodies, y),
                         .cosine = NARC_COLUMN(bodies, cosine),
                         .sine = NARC_COLUMN(bodies, sine),
                         .scale = NARC_COLUMN(bodies, scale),
                         .shape = NARC_COLUMN(bodies, shape)};
}

/* The rows of a body with all entries; it is A. */
static size_t ask(const struct setting *s, const struct body *mover, double margin, narc_contact *rows) {
    const uint32_t zero = 0;
    const narc_bodies a = bodies_of(mover, 1), b = bodies_of(s->bodies, s->count);
    uint32_t *entry = malloc(s->count * sizeof *entry);
    for (size_t k = 0; k < s->count; k++)
        entry[k] = (uint32_t)k;
    const narc_pairs pairs = {.count = s->count, .a = {&zero, 0}, .b = NARC_ARRAY(entry), .other_bodies = &b};
    const narc_query query = {.margin = (float)margin};
    narc_error error = {0};
    size_t found = 0;
    expect_ok(narc_find_contacts(s->store, &a, &pairs, &query, rows, ROWS, &found, &error), &error);
    free(entry);
    return found;
}

static double find_deepest(const struct setting *s, const struct body *mover, double margin) {
    static narc_contact rows[ROWS];
    const size_t count = ask(s, mover, margin, rows);
    double least = INFINITY;
    for (size_t k = 0; k < count; k++)
        least = fmin(least, (double)rows[k].separation);
    return least;
}

/* A body of any shape anywhere near the chain. */
static void choose_body(struct test_random *random, struct setting *s, double largest) {
    const double extent = find_extent(&s->chain);
    s->shape = make_shape(random, (enum family)random_below(random, FAMILY_COUNT));
    s->mover = turned_body(random_between(random, -TEST_PI, TEST_PI), random_log_between(random, 0.05, largest));
    s->mover.x = random_between(random, -extent, extent);
    s->mover.y = random_between(random, -extent, extent);
    s->mover.shape = store_shape(s->store, s->shape);
}

/* To an end of an arc. */
static void put_near_end(struct test_random *random, struct setting *s) {
    const narc_arc *arc = &s->arcs[random_below(random, s->chain.count)];
    const double size = (double)s->mover.scale, angle = random_below(random, 2) ? arc->start : arc->end;
    s->mover.x = arc->center_x + arc->radius * cos(angle) + size * random_between(random, -2, 2);
    s->mover.y = arc->center_y + arc->radius * sin(angle) + size * random_between(random, -2, 2);
}

static void scale_arcs(narc_arc *arcs, size_t count, double factor) {
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x *= factor;
        arcs[k].center_y *= factor;
        arcs[k].radius *= factor;
    }
}

/* Ground and body 2^10 times as large: the same rows, but for their lengths, to the bit. */
TEST(test_scaled) {
    static narc_contact rows[ROWS], others[ROWS];
    struct test_random random = test_random_named("scaled ground");
    size_t seen = 0;
    for (size_t round = 0; round < test_trials(10 * CHAIN_FAMILIES); round++) {
        struct setting *s = make_setting(&random, (enum chain_family)(round % CHAIN_FAMILIES)),
                       *other = calloc(1, sizeof *other);
        const double factor = 0x1p10;
        other->store = empty_store();
        memcpy(other->arcs, s->arcs, sizeof s->arcs);
        other->chain = (struct chain){other->arcs, s->chain.count, s->chain.closed};
        scale_arcs(other->arcs, other->chain.count, factor);
        assert_true(add_chain(other) && other->count == s->count);
        other->ground = make_ground(&other->chain);
        for (int k = 0; k < 40; k++) {
            choose_body(&random, s, 1);
            put_near_end(&random, s);
            struct shape shape = s->shape;
            scale_arcs(shape.arcs, shape.count, factor);
            other->mover = s->mover;
            other->mover.x *= factor;
            other->mover.y *= factor;
            other->mover.shape = store_shape(other->store, shape);
            const size_t count = ask(s, &s->mover, 0.01, rows);
            assert_int_equal(ask(other, &other->mover, 0.01 * factor, others), count);
            for (size_t i = 0; i < count; i++) {
                others[i].point_x /= (float)factor;
                others[i].point_y /= (float)factor;
                others[i].separation /= (float)factor;
                others[i].radius_a /= (float)factor;
                others[i].radius_b /= (float)factor;
            }
            assert_memory_equal(others, rows, count * sizeof *rows);
            seen += count;
        }
        end_setting(other);
        end_setting(s);
    }
    print_message("  %zu rows\n", seen);
    assert_true(seen > test_trials(100 * CHAIN_FAMILIES) || test_trials(100) < 10);
}

/* The mean of the arcs' centres. */
static narc_point find_middle(const struct chain *chain) {
    const double part = 1 / (double)chain->count;
    narc_point middle = {0, 0};
    for (size_t k = 0; k < chain->count; k++)
        middle.x += part * chain->arcs[k].center_x;
    for (size_t k = 0; k < chain->count; k++)
        middle.y += part * chain->arcs[k].center_y;
    return middle;
}

/* How far its arcs' circles reach from a point. */
static double find_reach_of(const struct chain *chain, narc_point from) {
    double far = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *const arc = &chain->arcs[k];
        const double reach = hypot(arc->center_x - from.x, arc->center_y - from.y) + fabs(arc->radius);
        if (reach > far)
            far = reach;
    }
    return far;
}

/* Two chains: a peg in a horseshoe, a gear in a ring. Nothing is told of them while there is air between them, and the
 * depth is told when the inner one is moved into the other. */
TEST(test_chains_in_chains) {
    struct test_random random = test_random_named("chains in chains");
    for (size_t round = 0; round < test_trials(40); round++) {
        struct setting *outer = calloc(1, sizeof *outer), *inner = calloc(1, sizeof *inner);
        const bool gear = round % 2;
        struct turtle t = gear ? walk_gear(6 + random_below(&random, 10), 0.3) : create_turtle(0, 0, 0);
        if (!gear)
            walk_turn(&t, 1, 2 * TEST_PI);
        outer->store = inner->store = empty_store();
        take_turtle(inner, &t, true);
        assert_true(add_chain(inner));
        const narc_point middle = find_middle(&inner->chain);
        const double x = middle.x, y = middle.y, far = find_reach_of(&inner->chain, middle);
        const double thickness = random_between(&random, 0.05, 0.5) * far, radius = 1.1 * far;
        make_horseshoe(outer, radius, thickness);
        assert_true(add_chain(outer));
        const double center_x = outer->arcs[0].center_x, center_y = outer->arcs[0].center_y;
        size_t told = 0;
        for (int deep = 0; deep < 2; deep++)
            for (size_t k = 0; k < inner->count; k++) {
                struct body mover = inner->bodies[k];
                mover.x += center_x - x;
                mover.y += center_y - y + (deep ? 0.13 * far : 0); /* the opening is below */
                const double deepest = find_deepest(outer, &mover, 0.01 * far);
                told += deepest < INFINITY;
                if (!deep && deepest < INFINITY)
                    fail_msg("round %zu, entry %zu: told of %g", round, k, deepest);
            }
        assert_true(told > 0 || gear); /* a gear may have a gap there */
        narc_destroy_shapes(outer->store);
        free(outer);
        free(inner);
    }
}

/* A box that two arcs of touch a hollow has two rows, as often as it is asked. */
TEST(test_rows_of_many_pairs) {
    enum { COUNT = 50 };
    static narc_contact rows[COUNT * NARC_MAX_ARCS];
    struct setting *s = calloc(1, sizeof *s);
    struct turtle t = create_turtle(0, 0, TEST_PI / 2 + 0.9);
    const uint32_t zero = 0;
    s->store = empty_store();
    walk_arc(&t, 2, -1.8);
    take_turtle(s, &t, false);
    assert_true(add_chain(s));
    s->mover = turned_body(0, 1);
    s->mover.shape = store_shape(s->store, box_of(2, 1, 0.125));
    s->mover.x = s->arcs[0].center_x;
    s->mover.y = s->arcs[0].center_y - 1.3;
    const narc_bodies a = bodies_of(&s->mover, 1), b = bodies_of(s->bodies, s->count);
    const narc_pairs pairs = {.count = COUNT, .a = {&zero, 0}, .b = {&zero, 0}, .other_bodies = &b};
    size_t count, own = 0;
    assert_int_equal(s->count, 1);
    assert_int_equal(
        narc_find_contacts(s->store, &a, &pairs, &(narc_query){0}, rows, COUNT * NARC_MAX_ARCS, &count, NULL), NARC_OK);
    while (own < count && rows[own].pair == 0)
        own++;
    assert_true(own >= 2 && count == COUNT * own);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(rows[k].pair, k / own);
        rows[k].pair = 0;
        assert_memory_equal(&rows[k], &rows[k % own], sizeof *rows);
    }
    narc_destroy_shapes(s->store);
    free(s);
}

/* ------------------------------------------------------------------------------------------------ casts */

struct flight {
    float x, y, angle;
};

static struct body move_body(const struct body *body, const struct flight *by, double time) {
    const double angle = time * (double)by->angle, c = cos(angle), sn = sin(angle);
    struct body out = *body;
    out.x += time * (double)by->x;
    out.y += time * (double)by->y;
    out.cosine = (float)(c * (double)body->cosine - sn * (double)body->sine);
    out.sine = (float)(c * (double)body->sine + sn * (double)body->cosine);
    return out;
}

struct cast_question {
    const struct setting *setting;
    const struct flight *flight;
    float target;
    bool ground_first;
};

static void ask_casts(const void *question, const narc_workers *workers, void *out_rows) {
    const struct cast_question *const q = question;
    const struct setting *const s = q->setting;
    const uint32_t zero = 0;
    const narc_bodies mover = bodies_of(&s->mover, 1), entries = bodies_of(s->bodies, s->count);
    const narc_motions motion = {.x = {&q->flight->x, 0}, .y = {&q->flight->y, 0}, .angle = {&q->flight->angle, 0}};
    uint32_t *entry = malloc(s->count * sizeof *entry);
    for (size_t k = 0; k < s->count; k++)
        entry[k] = (uint32_t)k;
    const narc_index_column all = NARC_ARRAY(entry), one = {&zero, 0};
    const narc_pairs pairs = {.count = s->count,
                              .a = q->ground_first ? all : one,
                              .b = q->ground_first ? one : all,
                              .other_bodies = q->ground_first ? &mover : &entries};
    const narc_cast_options options = {.target = q->target, .workers = workers};
    narc_error error = {0};
    expect_ok(narc_cast_pairs(s->store, q->ground_first ? &entries : &mover, q->ground_first ? NULL : &motion, &pairs,
                              q->ground_first ? &motion : NULL, &options, out_rows, s->count, &error),
              &error);
    free(entry);
}

/* Casts of the mover with all entries, A or B, on every instruction set; the first hit, or a miss, or what is not finished
 * before that. */
static narc_impact cast(const struct setting *s, const struct flight *flight, float target, bool ground_first) {
    const struct cast_question question = {s, flight, target, ground_first};
    narc_impact *rows = ask_everywhere(ask_casts, &question, s->count * sizeof *rows, NULL), first = {.fraction = 2};
    for (size_t k = 0; k < s->count; k++)
        if (rows[k].count != NARC_CAST_MISS && rows[k].fraction < first.fraction)
            first = rows[k];
    free(rows);
    return first;
}

struct tally {
    size_t flights, hits, misses, unfinished, round_ends;
    size_t doubtful; /* have come past an end, and are told of beside where they are hit */
};

/* Rows with separations below `most` begin between two times. Does the body slip past an open end, so that it need not be
 * hit? It does if it gets into the solid without meeting the ground, which it has left by then: from behind, its deepest
 * place first. What comes from the air crosses the ground, or is around its end; of that rows tell unless it is deeper
 * than it is wide. */
static bool slips_past_end(const struct setting *s, const struct flight *flight, double most, double before,
                           double after) {
    enum { PARTS = 64, HALVINGS = 24 };
    const double from = before, part = (after - before) / PARTS, margin = fmax(most, 0);
    bool told = false;
    for (int k = 1; k < PARTS && !told; k++) {
        const double time = from + k * part;
        const struct body now = move_body(&s->mover, flight, time);
        told = find_deepest(s, &now, margin) < most;
        *(told ? &after : &before) = time;
    }
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = (before + after) / 2;
        const struct body now = move_body(&s->mover, flight, middle);
        *(find_deepest(s, &now, margin) < most ? &after : &before) = middle;
    }
    if (s->chain.closed)
        return false;
    const struct body first = move_body(&s->mover, flight, after);
    double deepest = find_deepest(s, &first, margin); /* a part that is next to nothing may be over the ground */
    narc_circle inner;
    narc_compute_inscribed_circle(s->shape.arcs, s->shape.count, &inner);
    if (-deepest > 2 * (double)s->mover.scale * inner.radius)
        return true;
    for (double time = after; time > 0; time -= part) {
        const struct body then = move_body(&s->mover, flight, time);
        const struct reference_body placed = pose_shape(&s->shape, &then);
        const struct ground_clearance clearance = ground_find_clearance(s->ground, &placed);
        if (clearance.distance > 0)
            return !clearance.in_air || deepest < 0;
        deepest = INFINITY;
    }
    return false;
}

/* Is there a contact beside an impact, as far along the ground as rounding may move where one begins? Past an open end,
 * where the front's closure turns by 2^-10, the gap along the closure is greater by a 1024th of the way from the end. */
static bool is_told_beside(const struct setting *s, const struct body *mover, const narc_impact *hit, double margin) {
    enum { PARTS = 8 };
    const struct reference_body body = pose_shape(&s->shape, mover);
    const struct body *const entry = &s->bodies[hit->pair];
    const double reach =
                     hypot(mover->x - entry->x, mover->y - entry->y) + reference_extent(&body) + find_extent(&s->chain),
                 step = 0x1p-12 * reach / PARTS;
    bool told = false;
    for (int k = -PARTS; k <= PARTS && !told; k++) {
        struct body beside = *mover;
        beside.x -= k * step * (double)hit->normal_y;
        beside.y += k * step * (double)hit->normal_x;
        told = find_deepest(s, &beside, margin) < INFINITY;
    }
    return told;
}

static void fly(struct test_random *random, struct setting *s, const char *kind, bool turns, struct tally *tally) {
    const double extent = find_extent(&s->chain);
    choose_body(random, s, 1);
    struct reference_body body = pose_shape(&s->shape, &s->mover);
    const bool near = random_below(random, 2);
    const struct ground_clearance air = ground_find_clearance(s->ground, &body);
    if (!air.in_air || !(air.distance > 0.05))
        return;
    const double way = near ? random_log_between(random, 0.05, 1) : extent, toward = atan2(-s->mover.y, -s->mover.x),
                 angle = random_between(random, -TEST_PI, TEST_PI);
    const double along = random_below(random, 2) ? toward + 0.3 * angle : angle;
    const struct flight flight = {(float)(way * cos(along)), (float)(way * sin(along)),
                                  turns ? (float)random_between(random, -3, 3) : 0};
    const float target = random_below(random, 3) ? 0 : (float)random_between(random, 0, 0.05);
    const bool ground_first = random_below(random, 2);
    const narc_impact hit = cast(s, &flight, target, ground_first);
    const double size = (double)s->mover.scale, tolerance = turns ? size * 4e-3 : 0, room = 1e-5 * (1 + extent);
    tally->flights++;
    if (hit.count == NARC_CAST_UNFINISHED)
        tally->unfinished++;
    const double until = hit.count == NARC_CAST_MISS ? 1 : (double)hit.fraction;
    double before = 0;
    for (int k = 0; k <= TIMES; k++) {
        const double time = until * k / TIMES;
        const struct body now = move_body(&s->mover, &flight, time);
        const double deepest = find_deepest(s, &now, (double)target + 0.01);
        if ((time < until || hit.count == NARC_CAST_MISS) && deepest < (double)target - room) {
            const struct reference_body placed = pose_shape(&s->shape, &now);
            const struct ground_clearance clearance = ground_find_clearance(s->ground, &placed);
            if (clearance.in_air && clearance.distance > (double)target + 10 * room)
                fail_msg("%s: told of %g at %g, in the air by %g", kind, deepest, time, clearance.distance);
            if (slips_past_end(s, &flight, (double)target - room, before, time))
                tally->round_ends++;
            else
                fail_msg("%s: told of %g at %g (%d), but %s at %g; %zu", kind, deepest, time, k,
                         hit.count == NARC_CAST_MISS ? "a miss" : "met", until, tally->flights);
            return;
        }
        before = time;
    }
    tally->misses += hit.count == NARC_CAST_MISS;
    if (hit.count != NARC_CAST_HIT)
        return;
    tally->hits++;
    const struct body then = move_body(&s->mover, &flight, until), next = move_body(&s->mover, &flight, until + 2e-4);
    const double most = (double)target + tolerance + 2 * room; /* what has passed an end is told of from one time on */
    if (fmin(find_deepest(s, &then, most), find_deepest(s, &next, most)) < INFINITY)
        return;
    if (!is_told_beside(s, &then, &hit, most))
        fail_msg("%s: met at %g with separation %g, but nothing is told there; %zu", kind, until,
                 (double)hit.separation, tally->flights);
    tally->doubtful++;
}

/* No body gets through the ground between two entries, whichever side of a piece it meets first. */
static void fly_all(const char *name, bool turns) {
    struct test_random random = test_random_named(name);
    struct tally tally = {0};
    for (size_t round = 0; round < test_trials(14 * CHAIN_FAMILIES); round++) {
        const enum chain_family kind = (enum chain_family)(round % CHAIN_FAMILIES);
        struct setting *s = make_setting(&random, kind);
        for (int k = 0; k < 10; k++)
            fly(&random, s, chain_family_name(kind), turns, &tally);
        end_setting(s);
    }
    print_message("%zu flights: %zu hits, %zu misses, %zu unfinished, %zu past an end, %zu doubtful\n", tally.flights,
                  tally.hits, tally.misses, tally.unfinished, tally.round_ends, tally.doubtful);
    if (tally.flights >= 100) /* a few may all hit, or all miss */
        assert_true(tally.hits > tally.flights / 16 && tally.misses > 0 && 200 * tally.unfinished <= tally.flights);
    assert_true(1000 * tally.doubtful <= tally.flights + 1000);
}

TEST(test_straight_flights) { fly_all("straight flights", false); }
TEST(test_turning_flights) { fly_all("turning flights", true); }

/* A box in the air that turns onto a corner with its edge, while it is behind the ground on one side of that: the corner is
 * where a hollow ends, so its entry is closed by an arc of the same centre that touches nothing. */
TEST(test_turns_onto_a_corner) {
    struct test_random random = test_random_named("onto a corner");
    struct setting *s = calloc(1, sizeof *s);
    struct turtle t = create_turtle(0, 0, TEST_PI / 2);
    size_t flights = 0;
    s->store = empty_store();
    walk_arc(&t, 1.5, -1);
    walk_arc(&t, 0, TEST_PI / 2);
    walk_line(&t, 0.5);
    walk_arc(&t, 0, TEST_PI / 2);
    take_turtle(s, &t, false);
    assert_true(add_chain(s));
    s->ground = make_ground(&s->chain);
    const narc_arc *const corner = &s->arcs[1];
    for (size_t round = 0; round < test_trials(2000); round++) {
        const double width = random_between(&random, 0.3, 1), thickness = random_between(&random, 0.05, 0.3);
        const double normal = random_between(&random, corner->start + 0.01, corner->end - 0.01),
                     along = width * random_between(&random, -0.49, 0.49), turn = random_between(&random, -2, 2);
        s->shape = box_of(2 * width, 2 * thickness, 0);
        s->mover = turned_body(normal - TEST_PI / 2 - turn, 1);
        s->mover.shape = store_shape(s->store, s->shape);
        s->mover.x = corner->center_x + thickness * cos(normal) - along * sin(normal);
        s->mover.y = corner->center_y + thickness * sin(normal) + along * cos(normal);
        const struct flight flight = {0, 0, (float)(1.05 * turn)};
        const struct body late = move_body(&s->mover, &flight, 1);
        bool clear = find_deepest(s, &late, 0) < -1e-3;
        for (int k = 0; k < 20 && clear; k++) {
            const struct body now = move_body(&s->mover, &flight, k / 21.0);
            const struct reference_body placed = pose_shape(&s->shape, &now);
            clear = ground_find_clearance(s->ground, &placed).in_air && !(find_deepest(s, &now, 1e-4) < INFINITY);
        }
        if (!clear)
            continue;
        flights++;
        const narc_impact hit = cast(s, &flight, 0, random_below(&random, 2));
        const struct body then = move_body(&s->mover, &flight, (double)hit.fraction);
        assert_int_equal(hit.count, NARC_CAST_HIT);
        assert_true(find_deepest(s, &then, 2e-3) < INFINITY);
    }
    print_message("  %zu flights\n", flights);
    assert_true(20 * flights > test_trials(2000) || test_trials(2000) < 100);
    end_setting(s);
}

/* A concave arc that stands alone, and bodies beside and behind it of which an arc comes into its sector: they hit
 * where something is told, and not while their circles are apart. Every other body turns. */
TEST(test_flights_past_a_concave_arc) {
    struct test_random random = test_random_named("past a concave arc");
    size_t hits = 0;
    for (size_t round = 0; round < test_trials(600); round++) {
        struct setting *s = calloc(1, sizeof *s);
        const double turn = random_log_between(&random, 0.02, 1.5), radius = random_log_between(&random, 0.3, 3);
        struct turtle t = create_turtle(0, 0, TEST_PI / 2 + turn / 2);
        s->store = empty_store();
        walk_arc(&t, radius, -turn);
        take_turtle(s, &t, false);
        assert_true(add_chain(s));
        for (int k = 0; k < 20; k++) {
            choose_body(&random, s, 1);
            const double size = (double)s->mover.scale, way = random_between(&random, 0, 3) * size,
                         along = random_between(&random, -TEST_PI, TEST_PI);
            const double beside =
                             turn * random_between(&random, -0.5, 0.5) + size / radius * random_between(&random, -2, 2),
                         from = beside - TEST_PI / 2, far = radius + size * random_between(&random, -2, 2);
            const float angle = k % 2 ? (float)random_between(&random, -3, 3) : 0;
            const struct flight flight = {(float)(way * cos(along)), (float)(way * sin(along)), angle};
            const double margin = 1e-5 + (k % 2 ? size * 4e-3 : 0);
            s->mover.x = s->arcs[0].center_x + far * cos(from);
            s->mover.y = s->arcs[0].center_y + far * sin(from);
            const narc_impact hit = cast(s, &flight, 0, random_below(&random, 2));
            if (hit.count != NARC_CAST_HIT || hit.fraction == 0)
                continue;
            const struct body then = move_body(&s->mover, &flight, (double)hit.fraction),
                              next = move_body(&s->mover, &flight, (double)hit.fraction + 2e-4);
            hits++;
            if (!(fmin(find_deepest(s, &then, margin), find_deepest(s, &next, margin)) < INFINITY))
                fail_msg("round %zu: met at %g with separation %g, but nothing is told there", round,
                         (double)hit.fraction, (double)hit.separation);
        }
        narc_destroy_shapes(s->store);
        free(s);
    }
    assert_true(hits > test_trials(300));
}

/* A circle that flies along the normal at an end of a concave arc, from its centre or from anywhere on the way: by
 * rounding it may meet the arc or pass it, but what it meets is where it should be. The normal is a multiple of the
 * motion, to the last bit. */
TEST(test_flights_along_an_end) {
    struct test_random random = test_random_named("along an end");
    const size_t rounds = 20 + test_trials(200);
    size_t hits = 0;
    for (size_t round = 0; round < rounds; round++) {
        struct setting *s = calloc(1, sizeof *s);
        const bool at_start = round % 2;
        const double radius = 1 + random_unit(&random), size = 0.25 + random_unit(&random) / 2;
        struct turtle t = create_turtle(0, 0, at_start ? TEST_PI / 2 : TEST_PI / 2 + 1);
        s->store = empty_store();
        walk_arc(&t, radius, -1);
        take_turtle(s, &t, false);
        assert_true(add_chain(s));
        struct body *const ground = &s->bodies[0];
        const struct body turned = turned_body(random_between(&random, -TEST_PI, TEST_PI), 1);
        ground->cosine = turned.cosine;
        ground->sine = turned.sine;
        const double c = (double)turned.cosine, sn = (double)turned.sine, length = hypot(c, sn);
        narc_arc stored;
        assert_int_equal(narc_get_arcs(s->store, ground->shape, &stored), 1);
        const double own_x = stored.center_x, own_y = stored.center_y;
        const double from = round % 4 < 2 ? 0 : random_unit(&random) * (radius - size) / length;
        s->shape = circle_of(size);
        s->mover = turned_body(0, 1);
        s->mover.shape = store_shape(s->store, s->shape);
        s->mover.x = ground->x + (c * own_x - sn * own_y) / length + from * sn;
        s->mover.y = ground->y + (sn * own_x + c * own_y) / length - from * c;
        const struct flight flight = {turned.sine * 2, -turned.cosine * 2, 0};
        const narc_impact hit = cast(s, &flight, 0, random_below(&random, 2));
        if (hit.count == NARC_CAST_HIT) {
            hits++;
            assert_true(fabs(2 * length * (double)hit.fraction - (radius - size - from * length)) < 1e-5);
            assert_true(fabs((double)hit.separation) < 1e-5);
        }
        narc_destroy_shapes(s->store);
        free(s);
    }
    print_message("  %zu flights along an end, %zu hits\n", rounds, hits);
    assert_true(4 * hits > rounds);
}

TEST_MAIN("ground_casts")
