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

enum { TIMES = 160 };

/* A body of that shape which moves above the ground. */
struct flyer {
    struct shape shape;
    struct body body;
};

/* By up to a whole turn. */
static void walk_turn(struct turtle *t, double radius, double turn) {
    walk_arc(t, radius, turn / 2);
    walk_arc(t, radius, turn / 2);
}

/* A horseshoe, open below. */
static struct chain make_horseshoe(double radius, double thickness) {
    const double turn = 5;
    struct turtle t = create_turtle(0.1, 0, PI / 2 - turn / 2);
    for (int side = 0; side < 2; side++) {
        walk_turn(&t, side ? radius : radius + thickness, side ? -turn : turn);
        walk_arc(&t, 0, PI / 2);
        walk_line(&t, thickness);
        walk_arc(&t, 0, PI / 2);
    }
    return end_walk(&t, true);
}

/* How large the chain is: the furthest end of a piece from the origin. */
static double find_extent(const struct chain *chain) {
    double most = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_point at = chain_point(&chain->arcs[k], chain->arcs[k].start);
        most = fmax(most, hypot(at.x, at.y));
    }
    return most;
}

/* A body of any shape anywhere near the chain, or near an end of one of its arcs. */
static struct flyer choose_flyer(struct test_random *random, struct ground_scene *scene) {
    const double extent = find_extent(&scene->chain);
    struct flyer out = {.shape = make_shape(random, (enum family)random_below(random, FAMILY_COUNT)),
                        .body = turned_body(random_between(random, -PI, PI), random_log_between(random, 0.05, 1))};
    out.body.x = random_between(random, -extent, extent);
    out.body.y = random_between(random, -extent, extent);
    out.body.shape = store_shape(scene->store, out.shape);
    return out;
}

static void put_near_end(struct test_random *random, const struct chain *chain, struct body *body) {
    const narc_arc *arc = &chain->arcs[random_below(random, chain->count)];
    const narc_point end = chain_point(arc, random_below(random, 2) ? arc->start : arc->end);
    body->x = end.x + (double)body->scale * random_between(random, -2, 2);
    body->y = end.y + (double)body->scale * random_between(random, -2, 2);
}

/* Ground and body 2^10 times as large: the same rows, but for their lengths, to the bit. */
TEST(test_scaled) {
    static narc_contact rows[TOLD_ROWS], large[TOLD_ROWS];
    struct test_random random = test_random_named("scaled ground");
    const double factor = 0x1p10;
    size_t seen = 0;
    for (size_t round = 0; round < test_trials(10 * CHAIN_FAMILIES); round++) {
        AUTO(destroy_ground_scene_at)
        struct ground_scene *s = lay_random_ground(&random, (enum chain_family)(round % CHAIN_FAMILIES));
        struct chain chain = {malloc(s->chain.count * sizeof *chain.arcs), s->chain.count, s->chain.closed};
        memcpy(chain.arcs, s->chain.arcs, chain.count * sizeof *chain.arcs);
        scale_arcs(chain.arcs, chain.count, factor);
        AUTO(destroy_ground_scene_at) struct ground_scene *other = lay_ground(chain, (narc_chain_options){0});
        assert_int_equal(other->count, s->count);
        for (int k = 0; k < 40; k++) {
            struct flyer flyer = choose_flyer(&random, s);
            put_near_end(&random, &s->chain, &flyer.body);
            const size_t count = ground_contacts(s, &flyer.body, (narc_query){.margin = 0.01f}, rows, TOLD_ROWS);
            scale_arcs(flyer.shape.arcs, flyer.shape.count, factor);
            flyer.body.x *= factor;
            flyer.body.y *= factor;
            flyer.body.shape = store_shape(other->store, flyer.shape);
            const narc_query margin = {.margin = (float)(0.01 * factor)};
            assert_int_equal(ground_contacts(other, &flyer.body, margin, large, TOLD_ROWS), count);
            for (size_t i = 0; i < count; i++) {
                narc_contact *row = &large[i];
                float *const lengths[] = {&row->point_x, &row->point_y, &row->separation, &row->radius_a,
                                          &row->radius_b};
                for (size_t length = 0; length < sizeof lengths / sizeof *lengths; length++)
                    *lengths[length] /= (float)factor;
            }
            assert_memory_equal(large, rows, count * sizeof *rows);
            seen += count;
        }
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
        const bool gear = round % 2;
        struct turtle t = gear ? walk_gear(6 + random_below(&random, 10), 0.3) : create_turtle(0, 0, 0);
        if (!gear)
            walk_turn(&t, 1, 2 * PI);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, true), (narc_chain_options){0});
        const size_t inner = s->count;
        const narc_point middle = find_middle(&s->chain);
        const double far = find_reach_of(&s->chain, middle), thickness = random_between(&random, 0.05, 0.5) * far;
        narc_error error = {0};
        expect_ok(add_ground(s, make_horseshoe(1.1 * far, thickness), (narc_chain_options){0}, &error), &error);
        const narc_query outer = {.margin = (float)(0.01 * far), .first = inner};
        size_t told = 0;
        for (int deep = 0; deep < 2; deep++)
            for (size_t k = 0; k < inner; k++) {
                struct body mover = s->bodies[k];
                mover.x += s->chain.arcs[0].center_x - middle.x;
                mover.y += s->chain.arcs[0].center_y - middle.y + (deep ? 0.13 * far : 0); /* the opening is below */
                const double deepest = ground_separation(s, &mover, outer);
                told += deepest < INFINITY;
                if (!deep && deepest < INFINITY)
                    fail_msg("round %zu, entry %zu: told of %g", round, k, deepest);
            }
        assert_true(told > 0 || gear); /* a gear may have a gap there */
    }
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
    const struct ground_scene *scene;
    const struct body *mover;
    const struct flight *flight;
    float target, parting;
    bool ground_first;
};

static void ask_casts(const void *question, const narc_workers *workers, void *out_rows) {
    const struct cast_question *const q = question;
    const struct ground_scene *const s = q->scene;
    const uint32_t zero = 0;
    const narc_bodies mover = view_columns(q->mover, 1), entries = view_columns(s->bodies, s->count);
    const narc_motions motion = {.x = {&q->flight->x, 0}, .y = {&q->flight->y, 0}, .angle = {&q->flight->angle, 0}};
    AUTO(free_at) uint32_t *entry = malloc(s->count * sizeof *entry);
    for (size_t k = 0; k < s->count; k++)
        entry[k] = (uint32_t)k;
    const narc_index_column all = NARC_ARRAY(entry), one = {&zero, 0};
    const narc_pairs pairs = {.count = s->count,
                              .a = q->ground_first ? all : one,
                              .b = q->ground_first ? one : all,
                              .other_bodies = q->ground_first ? &mover : &entries};
    const narc_cast_options options = {
        .target = q->target, .parting = q->parting, .tolerance = q->parting > 0 ? 1e-3f : 0, .workers = workers};
    narc_error error = {0};
    expect_ok(narc_cast_pairs(s->store, q->ground_first ? &entries : &mover, q->ground_first ? NULL : &motion, &pairs,
                              q->ground_first ? &motion : NULL, &options, out_rows, s->count, &error),
              &error);
}

/* Casts of the mover with all entries, A or B, on every instruction set; the first hit, or a miss, or what is not finished
 * before that. */
static narc_impact cast(const struct ground_scene *s, const struct body *mover, const struct flight *flight,
                        float target, bool ground_first) {
    const struct cast_question question = {s, mover, flight, target, 0, ground_first};
    narc_impact *rows = ask_everywhere(ask_casts, &question, s->count * sizeof *rows, NULL), first = {.fraction = 2};
    for (size_t k = 0; k < s->count; k++)
        if (rows[k].count != NARC_CAST_MISS && rows[k].fraction < first.fraction)
            first = rows[k];
    free(rows);
    return first;
}

struct counts {
    size_t flights, hits, misses, unfinished, round_ends;
    size_t like_contacts; /* impacts that are one of the contacts there */
    size_t doubtful;      /* have come past an end, and are told of beside where they are hit */
};

/* Rows with separations below `most` begin between two times. Does the body slip past an open end, so that it need not be
 * hit? It does if it gets into the solid without meeting the ground, which it has left by then: from behind, its deepest
 * place first. What comes from the air crosses the ground, or is around its end; of that rows tell unless it is deeper
 * than it is wide. */
static bool slips_past_end(struct ground_scene *s, const struct flyer *flyer, const struct flight *flight, double most,
                           double before, double after) {
    enum { PARTS = 64, HALVINGS = 24 };
    const double from = before, part = (after - before) / PARTS, margin = fmax(most, 0);
    bool told = false;
    for (int k = 1; k < PARTS && !told; k++) {
        const double time = from + k * part;
        const struct body now = move_body(&flyer->body, flight, time);
        told = ground_separation(s, &now, (narc_query){.margin = (float)margin}) < most;
        *(told ? &after : &before) = time;
    }
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = (before + after) / 2;
        const struct body now = move_body(&flyer->body, flight, middle);
        *(ground_separation(s, &now, (narc_query){.margin = (float)margin}) < most ? &after : &before) = middle;
    }
    if (s->chain.closed)
        return false;
    const struct body first = move_body(&flyer->body, flight, after);
    double deepest = ground_separation(
        s, &first, (narc_query){.margin = (float)margin}); /* a part that is next to nothing may be over the ground */
    narc_circle inner;
    narc_compute_inscribed_circle(flyer->shape.arcs, flyer->shape.count, &inner);
    if (-deepest > 2 * (double)flyer->body.scale * inner.radius)
        return true;
    for (double time = after; time > 0; time -= part) {
        const struct body then = move_body(&flyer->body, flight, time);
        const struct reference_body placed = pose_shape(&flyer->shape, &then);
        const struct ground_clearance clearance = ground_find_clearance(ground_of(s), &placed);
        if (clearance.distance > 0)
            return !clearance.in_air || deepest < 0;
        deepest = INFINITY;
    }
    return false;
}

/* Is there a contact beside an impact, as far along the ground as rounding may move where one begins? Past an open end,
 * where the front's closure turns by 2^-10, the gap along the closure is greater by a 1024th of the way from the end. */
static bool is_told_beside(const struct ground_scene *s, const struct flyer *flyer, const struct body *mover,
                           const narc_impact *hit, double margin) {
    enum { PARTS = 8 };
    const struct reference_body body = pose_shape(&flyer->shape, mover);
    const struct body *const entry = &s->bodies[hit->pair];
    const double reach =
                     hypot(mover->x - entry->x, mover->y - entry->y) + reference_extent(&body) + find_extent(&s->chain),
                 step = 0x1p-12 * reach / PARTS;
    bool told = false;
    for (int k = -PARTS; k <= PARTS && !told; k++) {
        struct body beside = *mover;
        beside.x -= k * step * (double)hit->normal_y;
        beside.y += k * step * (double)hit->normal_x;
        told = ground_separation(s, &beside, (narc_query){.margin = (float)margin}) < INFINITY;
    }
    return told;
}

/* Is one of the contacts there the impact: of that entry, with its separation, normal and point? `room`: for what turns, and
 * rounding. Where next to nothing is between them the normal may be any. */
static bool is_contact(const struct ground_scene *s, const struct body *mover, const narc_impact *hit, double margin,
                       double room, bool ground_first) {
    static narc_contact rows[TOLD_ROWS];
    const size_t count = ground_contacts(s, mover, (narc_query){.margin = (float)margin}, rows, TOLD_ROWS);
    const double sign = ground_first ? -1 : 1, x = ground_first ? s->bodies[hit->pair].x - mover->x : 0,
                 y = ground_first ? s->bodies[hit->pair].y - mover->y : 0;
    for (size_t k = 0; k < count; k++) {
        const narc_contact *c = &rows[k];
        const double turned = hypot((double)c->normal_x - sign * (double)hit->normal_x,
                                    (double)c->normal_y - sign * (double)hit->normal_y),
                     off = hypot((double)c->point_x - x - (double)hit->point_x,
                                 (double)c->point_y - y - (double)hit->point_y);
        if (c->pair == hit->pair && fabs((double)(c->separation - hit->separation)) <= room &&
            (turned * (double)hit->separation <= 8 * room || turned < 1e-3) && off <= 1e-3 + 64 * room)
            return true;
    }
    return false;
}

static void fly(struct test_random *random, struct ground_scene *s, const char *kind, bool turns,
                struct counts *counts) {
    const double extent = find_extent(&s->chain);
    const struct flyer flyer = choose_flyer(random, s);
    const struct body *const mover = &flyer.body;
    const struct reference_body body = pose_shape(&flyer.shape, mover);
    const bool near = random_below(random, 2);
    const struct ground_clearance air = ground_find_clearance(ground_of(s), &body);
    if (!air.in_air || !(air.distance > 0.05))
        return;
    const double way = near ? random_log_between(random, 0.05, 1) : extent, toward = atan2(-mover->y, -mover->x),
                 angle = random_between(random, -PI, PI);
    const double along = random_below(random, 2) ? toward + 0.3 * angle : angle;
    const struct flight flight = {(float)(way * cos(along)), (float)(way * sin(along)),
                                  turns ? (float)random_between(random, -3, 3) : 0};
    const float target = random_below(random, 3) ? 0 : (float)random_between(random, 0, 0.05);
    const bool ground_first = random_below(random, 2);
    const narc_impact hit = cast(s, mover, &flight, target, ground_first);
    const double size = (double)mover->scale, tolerance = turns ? size * 4e-3 : 0, room = 1e-5 * (1 + extent);
    counts->flights++;
    counts->unfinished += hit.count == NARC_CAST_UNFINISHED;
    const double until = hit.count == NARC_CAST_MISS ? 1 : (double)hit.fraction;
    double before = 0;
    for (int k = 0; k <= TIMES; k++) {
        const double time = until * k / TIMES;
        const struct body now = move_body(mover, &flight, time);
        const double deepest = ground_separation(s, &now, (narc_query){.margin = target + 0.01f});
        if ((time < until || hit.count == NARC_CAST_MISS) && deepest < (double)target - room) {
            const struct reference_body placed = pose_shape(&flyer.shape, &now);
            const struct ground_clearance clearance = ground_find_clearance(ground_of(s), &placed);
            if (clearance.in_air && clearance.distance > (double)target + 10 * room)
                fail_msg("%s: told of %g at %g, in the air by %g", kind, deepest, time, clearance.distance);
            if (!slips_past_end(s, &flyer, &flight, (double)target - room, before, time))
                fail_msg("%s: told of %g at %g (%d), but %s at %g; %zu", kind, deepest, time, k,
                         hit.count == NARC_CAST_MISS ? "a miss" : "met", until, counts->flights);
            counts->round_ends++;
            return;
        }
        before = time;
    }
    counts->misses += hit.count == NARC_CAST_MISS;
    if (hit.count != NARC_CAST_HIT)
        return;
    counts->hits++;
    const struct body then = move_body(mover, &flight, until), next = move_body(mover, &flight, until + 2e-4);
    const double most = (double)target + tolerance + 2 * room; /* what has passed an end is told of from one time on */
    const narc_query query = {.margin = (float)most};
    const double there = ground_separation(s, &then, query);
    counts->like_contacts += is_contact(s, &then, &hit, most, tolerance + 2 * room, ground_first);
    if (fmin(there, ground_separation(s, &next, query)) < INFINITY)
        return;
    if (!is_told_beside(s, &flyer, &then, &hit, most))
        fail_msg("%s: met at %g with separation %g, but nothing is told there; %zu", kind, until,
                 (double)hit.separation, counts->flights);
    counts->doubtful++;
}

/* No body gets through the ground between two entries, whichever side of a piece it meets first. */
static void fly_all(const char *name, bool turns) {
    struct test_random random = test_random_named(name);
    struct counts counts = {0};
    for (size_t round = 0; round < test_trials(14 * CHAIN_FAMILIES); round++) {
        const enum chain_family kind = (enum chain_family)(round % CHAIN_FAMILIES);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_random_ground(&random, kind);
        for (int k = 0; k < 10; k++)
            fly(&random, s, chain_family_name(kind), turns, &counts);
    }
    print_message("%zu flights: %zu hits, %zu of them as contacts there, %zu misses, %zu unfinished, %zu past an end, "
                  "%zu doubtful\n",
                  counts.flights, counts.hits, counts.like_contacts, counts.misses, counts.unfinished,
                  counts.round_ends, counts.doubtful);
    if (counts.flights >= 100) /* a few may all hit, or all miss */
        assert_true(counts.hits > counts.flights / 16 && counts.misses > 0 &&
                    200 * counts.unfinished <= counts.flights);
    assert_true(1000 * counts.doubtful <= counts.flights + 1000);
    assert_true(counts.like_contacts + counts.hits / 20 + 2 >= counts.hits); /* the others may have passed an end */
}

TEST(test_straight_flights) { fly_all("straight flights", false); }
TEST(test_turning_flights) { fly_all("turning flights", true); }

/* ------------------------------------------------------------------------------------------------ let go */

/* A body that touches the ground somewhere, as deep as it says. False if there is no such place. */
static bool put_on_ground(struct test_random *random, struct ground_scene *s, double depth, struct flyer *out,
                          narc_contact *out_contact) {
    static narc_contact rows[TOLD_ROWS];
    *out = choose_flyer(random, s);
    put_near_end(random, &s->chain, &out->body);
    for (int round = 0; round < 12; round++) {
        const size_t count = ground_contacts(s, &out->body, (narc_query){.margin = 2}, rows, TOLD_ROWS);
        size_t best = 0;
        for (size_t k = 1; k < count; k++)
            best = rows[k].separation < rows[best].separation ? k : best;
        if (count == 0)
            return false;
        const double off = (double)rows[best].separation + depth;
        *out_contact = rows[best];
        if (fabs(off) < 1e-4)
            return true;
        out->body.x += off * (double)rows[best].normal_x;
        out->body.y += off * (double)rows[best].normal_y;
    }
    return false;
}

/* What touches an entry at the start: let go unless it comes deeper, and hit again once it was clear. */
static void check_let_go(struct ground_scene *s, const struct flyer *flyer, const struct flight *flight,
                         const narc_impact *row, double parting, size_t counts[3]) {
    const narc_query entry = {.margin = 1, .first = row->pair, .count = 1};
    const double room = 2e-5 * (1 + find_extent(&s->chain)), tolerance = flight->angle != 0 ? 1e-3 : 0;
    const double start = ground_separation(s, &flyer->body, entry), deep = start - parting;
    if (start > -1e-4)
        return;
    const double until = row->count == NARC_CAST_MISS || row->fraction == 0 ? 1 : (double)row->fraction;
    double least = INFINITY, most = -INFINITY, now = 0;
    narc_circle inner;
    narc_compute_inscribed_circle(flyer->shape.arcs, flyer->shape.count, &inner);
    const double wide = 2 * (double)flyer->body.scale * inner.radius; /* what is deeper may be behind the ground */
    for (int k = 0; k <= 4 * TIMES; k++) {
        const struct body then = move_body(&flyer->body, flight, until * k / (4 * TIMES));
        now = ground_separation(s, &then, entry);
        if (row->count == NARC_CAST_MISS && now < deep - 2 * tolerance - room && now > -wide)
            fail_msg("let go from %g, %g deep at %g", start, now, until * k / (4 * TIMES));
        least = fmin(least, now);
        most = fmax(most, now);
    }
    if (row->count == NARC_CAST_MISS)
        counts[0]++;
    else if (row->fraction == 0) {
        enum { FINE = 200000 }; /* what comes past an end may be told of for a short time */
        for (int k = 0; k <= FINE && least > deep + room; k++) {
            const struct body then = move_body(&flyer->body, flight, (double)k / FINE);
            least = fmin(least, ground_separation(s, &then, entry));
        }
        if (least > deep + room || fabs((double)row->separation - start) > room)
            fail_msg("hit at %g from %g, but it comes to %g", (double)row->separation, start, least);
        counts[1]++;
    } else if (row->count == NARC_CAST_HIT) {
        const struct body next = move_body(&flyer->body, flight, until + 2e-4); /* where it begins to be told of */
        now = fmin(now, ground_separation(s, &next, entry));
        if (!(most > 0) || now > tolerance + room)
            fail_msg("hit again at %g with %g, from %g, at most %g", until, now, start, most);
        counts[2]++;
    }
}

/* What touches the ground parts and slides, straight or turning, and is hit elsewhere on the same entry: across a bowl. */
TEST(test_letting_go) {
    struct test_random random = test_random_named("letting go of ground");
    size_t counts[3] = {0};
    for (size_t round = 0; round < test_trials(20 * CHAIN_FAMILIES); round++) {
        AUTO(destroy_ground_scene_at)
        struct ground_scene *s = lay_random_ground(&random, (enum chain_family)(round % CHAIN_FAMILIES));
        for (int k = 0; k < 8; k++) {
            struct flyer flyer;
            narc_contact contact;
            if (!put_on_ground(&random, s, random_between(&random, 0.001, 0.01), &flyer, &contact))
                continue;
            const double along = atan2(-(double)contact.normal_y, -(double)contact.normal_x) +
                                 (random_below(&random, 2) ? random_between(&random, -2, 2) : PI / 2),
                         way = random_log_between(&random, 0.02, 4);
            const struct flight flight = {(float)(way * cos(along)), (float)(way * sin(along)),
                                          random_below(&random, 2) ? (float)random_between(&random, -1, 1) : 0};
            const struct cast_question question = {s, &flyer.body, &flight, 0, 0.005f, random_below(&random, 2)};
            AUTO(free_at) narc_impact *const rows = ask_everywhere(ask_casts, &question, s->count * sizeof *rows, NULL);
            AUTO(free_at) narc_impact *const held = malloc(s->count * sizeof *held);
            ask_casts(&(struct cast_question){s, &flyer.body, &flight, 0, 0, question.ground_first}, NULL, held);
            for (size_t i = 0; i < s->count; i++)
                if (held[i].count == NARC_CAST_HIT && held[i].fraction == 0)
                    check_let_go(s, &flyer, &flight, &rows[i], 0.005, counts);
        }
    }
    print_message("%zu let go, %zu came deeper, %zu hit again\n", counts[0], counts[1], counts[2]);
    assert_true(test_trials(20) < 10 || (counts[0] > 0 && counts[1] > 0 && counts[2] > 0));
}

/* A box in the air that turns onto a corner with its edge, while it is behind the ground on one side of that: the corner is
 * where a concave arc ends, so its entry is closed by an arc of the same centre that touches nothing. */
TEST(test_turns_onto_a_corner) {
    struct test_random random = test_random_named("onto a corner");
    struct turtle t = create_turtle(0, 0, PI / 2);
    size_t flights = 0;
    walk_arc(&t, 1.5, -1);
    walk_arc(&t, 0, PI / 2);
    walk_line(&t, 0.5);
    walk_arc(&t, 0, PI / 2);
    AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
    const narc_arc *const corner = &s->chain.arcs[1];
    for (size_t round = 0; round < test_trials(2000); round++) {
        const double width = random_between(&random, 0.3, 1), thickness = random_between(&random, 0.05, 0.3);
        const double normal = random_between(&random, corner->start + 0.01, corner->end - 0.01),
                     along = width * random_between(&random, -0.49, 0.49), turn = random_between(&random, -2, 2);
        const struct shape box = box_of(2 * width, 2 * thickness, 0);
        struct body mover = turned_body(normal - PI / 2 - turn, 1);
        mover.shape = store_shape(s->store, box);
        mover.x = corner->center_x + thickness * cos(normal) - along * sin(normal);
        mover.y = corner->center_y + thickness * sin(normal) + along * cos(normal);
        const struct flight flight = {0, 0, (float)(1.05 * turn)};
        const struct body late = move_body(&mover, &flight, 1);
        bool clear = ground_separation(s, &late, (narc_query){0}) < -1e-3f;
        for (int k = 0; k < 20 && clear; k++) {
            const struct body now = move_body(&mover, &flight, k / 21.0);
            const struct reference_body placed = pose_shape(&box, &now);
            clear = ground_find_clearance(ground_of(s), &placed).in_air &&
                    !(ground_separation(s, &now, (narc_query){.margin = 1e-4f}) < INFINITY);
        }
        if (!clear)
            continue;
        flights++;
        const narc_impact hit = cast(s, &mover, &flight, 0, random_below(&random, 2));
        const struct body then = move_body(&mover, &flight, (double)hit.fraction);
        assert_int_equal(hit.count, NARC_CAST_HIT);
        assert_true(ground_separation(s, &then, (narc_query){.margin = 2e-3f}) < INFINITY);
    }
    print_message("  %zu flights\n", flights);
    assert_true(20 * flights > test_trials(2000) || test_trials(2000) < 100);
}

/* A concave arc that stands alone, and bodies beside and behind it of which an arc comes into its sector: they hit
 * where something is told, and not while their circles are apart. Every other body turns. */
TEST(test_flights_past_a_concave_arc) {
    struct test_random random = test_random_named("past a concave arc");
    size_t hits = 0;
    for (size_t round = 0; round < test_trials(600); round++) {
        const double turn = random_log_between(&random, 0.02, 1.5), radius = random_log_between(&random, 0.3, 3);
        struct turtle t = create_turtle(0, 0, PI / 2 + turn / 2);
        walk_arc(&t, radius, -turn);
        AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
        for (int k = 0; k < 20; k++) {
            struct flyer flyer = choose_flyer(&random, s);
            const double size = (double)flyer.body.scale, way = random_between(&random, 0, 3) * size,
                         along = random_between(&random, -PI, PI);
            const double beside =
                             turn * random_between(&random, -0.5, 0.5) + size / radius * random_between(&random, -2, 2),
                         from = beside - PI / 2, far = radius + size * random_between(&random, -2, 2);
            const float angle = k % 2 ? (float)random_between(&random, -3, 3) : 0;
            const struct flight flight = {(float)(way * cos(along)), (float)(way * sin(along)), angle};
            const narc_query margin = {.margin = (float)(1e-5 + (k % 2 ? size * 4e-3 : 0))};
            flyer.body.x = s->chain.arcs[0].center_x + far * cos(from);
            flyer.body.y = s->chain.arcs[0].center_y + far * sin(from);
            const narc_impact hit = cast(s, &flyer.body, &flight, 0, random_below(&random, 2));
            if (hit.count != NARC_CAST_HIT || hit.fraction == 0)
                continue;
            const struct body then = move_body(&flyer.body, &flight, (double)hit.fraction),
                              next = move_body(&flyer.body, &flight, (double)hit.fraction + 2e-4);
            hits++;
            if (!(fmin(ground_separation(s, &then, margin), ground_separation(s, &next, margin)) < INFINITY))
                fail_msg("round %zu: met at %g with separation %g, but nothing is told there", round,
                         (double)hit.fraction, (double)hit.separation);
        }
    }
    assert_true(hits > test_trials(300));
}

/* A body that comes from behind a concave arc, and leaves its sector: it hits nothing, not even as it leaves. */
TEST(test_flight_out_of_a_sector) {
    const narc_arc outline[] = {{0.146547115, 0.111392167, 0.5036525, -0.694716892, 0.0941235145},
                                {0.555774061, 0.636021066, 0.0469298983, 0.0941235145, 1.50161337},
                                {0.116196603, 0.280211831, 0.432274985, 1.50161337, 1.91964356},
                                {-0.127117569, -0.0547349249, 0.663878654, 1.91964356, 3.45604625},
                                {-0.537539907, -0.803390024, 0.0420244543, 3.45604625, 4.46666912},
                                {-0.246429889, -0.478646563, 0.42782728, 4.46666912, 5.58846841}};
    struct flyer flyer = {
        .body = {
            .x = -0.810711283, .y = -0.342786242, .cosine = 0.746697962f, .sine = 0.665163279f, .scale = 0.323632449f}};
    const struct flight flight = {-0.125418f, 0.409105f, 0};
    struct turtle t = create_turtle(0, 0, PI / 2 + 0.610032035);
    walk_arc(&t, 0.624064951, -1.22006407);
    AUTO(destroy_ground_scene_at) struct ground_scene *s = lay_ground(end_walk(&t, false), (narc_chain_options){0});
    memcpy(flyer.shape.arcs, outline, sizeof outline);
    flyer.shape.count = sizeof outline / sizeof *outline;
    flyer.body.shape = store_shape(s->store, flyer.shape);
    const struct body told = move_body(&flyer.body, &flight, 0.7);
    assert_true(ground_separation(s, &flyer.body, (narc_query){0}) >= INFINITY);
    assert_true(ground_separation(s, &told, (narc_query){0}) < 0);
    for (int first = 0; first < 2; first++)
        assert_int_equal(cast(s, &flyer.body, &flight, 0, first).count, NARC_CAST_MISS);
}

/* A circle that flies along the normal at an end of a concave arc, from its centre or from anywhere on the way: by
 * rounding it may meet the arc or pass it, but what it meets is where it should be. The normal is a multiple of the
 * motion, to the last bit. */
TEST(test_flights_along_an_end) {
    struct test_random random = test_random_named("along an end");
    const size_t rounds = 20 + test_trials(200);
    size_t hits = 0;
    for (size_t round = 0; round < rounds; round++) {
        AUTO(destroy_ground_scene_at) struct ground_scene *s = create_ground_scene();
        const bool at_start = round % 2;
        const double radius = 1 + random_unit(&random), size = 0.25 + random_unit(&random) / 2;
        struct turtle t = create_turtle(0, 0, at_start ? PI / 2 : PI / 2 + 1);
        narc_error error = {0};
        walk_arc(&t, radius, -1);
        s->place = turned_body(random_between(&random, -PI, PI), 1);
        expect_ok(add_ground(s, end_walk(&t, false), (narc_chain_options){0}, &error), &error);
        const struct body *const ground = &s->bodies[0];
        const double c = (double)ground->cosine, sn = (double)ground->sine, length = hypot(c, sn);
        narc_arc stored;
        assert_int_equal(narc_get_arcs(s->store, ground->shape, &stored), 1);
        const double own_x = stored.center_x, own_y = stored.center_y;
        const double from = round % 4 < 2 ? 0 : random_unit(&random) * (radius - size) / length;
        struct body mover = turned_body(0, 1);
        mover.shape = store_shape(s->store, circle_of(size));
        mover.x = ground->x + (c * own_x - sn * own_y) / length + from * sn;
        mover.y = ground->y + (sn * own_x + c * own_y) / length - from * c;
        const struct flight flight = {ground->sine * 2, -ground->cosine * 2, 0};
        const narc_impact hit = cast(s, &mover, &flight, 0, random_below(&random, 2));
        if (hit.count == NARC_CAST_HIT) {
            hits++;
            assert_true(fabs(2 * length * (double)hit.fraction - (radius - size - from * length)) < 1e-5);
            assert_true(fabs((double)hit.separation) < 1e-5);
        }
    }
    print_message("  %zu flights along an end, %zu hits\n", rounds, hits);
    assert_true(4 * hits > rounds);
}

TEST_MAIN("ground_casts")
