/* SPDX-License-Identifier: MIT
 *
 * ground_minima.c - bodies on chains of pieces: none of the contacts that a search finds is missed or told twice, and
 * none is told that is not there. With NARC_TEST_SHOW in the environment all of a failure is printed.
 *
 * A contact on the ground's air side is a local minimum of the ground's signed distance over the body. So it is on the
 * solid side, too, while nothing else of the ground is as near (below a corner the corner is not the nearest): minima
 * and rows beyond that reach are counted, and rows are looked at by themselves.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "check.h"
#include "expect.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "turtle.h"

static const double pi = 3.14159265358979323846;

enum { SHOWN = 3, BODIES = 160, MOVERS, SHAPES = 16, ENTRIES = 2 * CHAIN_ARCS, ROWS = 16384 };

/* A search with so many steps along a body, or across the smallest piece beside it; and how much finer where it seems to
 * have missed something. */
static const double steps_per_body = 96, steps_per_piece = 3, finer = 16;

/* What may tell of a body in the air that it touches the ground. */
enum { MERGED_MANIFOLDS, MANIFOLDS, CONTACTS, MERGED_CONTACTS, OVERLAPS, CASTS, PHANTOMS };

struct tally {
    size_t bodies, minima, rows; /* minima that must be told and were; rows that are one of them */
    size_t beyond, sunk, overruled, deep, nearer, shallow,
        touching; /* not compared, or by themselves alone; see below */
    size_t wrong, refused;
    double worst; /* error of a separation, by its bound */
    size_t in_air, met,
        unmet; /* bodies that touch none of the ground, and are not in it; that meet it, of which a cast does not begin with it */
    size_t phantoms[PHANTOMS];
};

struct setting;

/* Ground and bodies: those of a family, or a scene's own. */
struct kind {
    const char *name;
    enum chain_family family;
    struct chain (*make_chain)(struct test_random *random, narc_arc *arcs);
    struct shape (*make_shape)(struct test_random *random);
    struct body (*place)(struct test_random *random, const struct setting *setting, const struct shape *shape);
};

/* A chain in a store, in a place, and its entries as bodies. */
struct setting {
    const struct kind *kind;
    struct chain chain;
    struct ground *ground;
    struct body place;
    narc_shapes *store;
    narc_chain_entry entries[ENTRIES];
    size_t entry_count;
    struct body bodies[MOVERS + ENTRIES]; /* first what lies on the chain, and what is far away */
    struct shape shapes[SHAPES];          /* of body k the one with the number k % SHAPES */
    uint32_t runs[MOVERS + ENTRIES];
    double margin, weld;
};

/* What a row says, in the chain's coordinates. */
struct told {
    narc_point at, foot; /* on the body, on the ground; the deepest point */
    narc_point other;    /* on the body, the other point, or the same */
    double other_separation;
    double normal_x, normal_y, separation, bound;
    double slide; /* how far rounding may move the foot along the ground */
    uint32_t entry, count, feature;
    size_t run;      /* of the ground at the foot */
    bool is_centred; /* in an arc of nearly its radius: the direction between the centres is that of rounding */
};

static narc_point rotate(const struct body *place, double x, double y) {
    const double length = hypot((double)place->cosine, (double)place->sine);
    const double c = (double)place->cosine / length, s = (double)place->sine / length;
    return (narc_point){c * x - s * y, s * x + c * y};
}

static narc_point rotate_back(const struct body *place, double x, double y) {
    struct body back = *place;
    back.sine = -back.sine;
    return rotate(&back, x, y);
}

/* A body of the world in the chain's coordinates. */
static struct reference_body pose_on(const struct setting *setting, size_t k) {
    const struct body *body = &setting->bodies[k];
    const struct shape *shape = &setting->shapes[k % SHAPES];
    const narc_point at = rotate_back(&setting->place, body->x - setting->place.x, body->y - setting->place.y);
    const narc_point axis = rotate_back(&setting->place, (double)body->cosine, (double)body->sine);
    const double length = hypot(axis.x, axis.y);
    return (struct reference_body){shape->arcs,     shape->count,       at.x, at.y, axis.x / length,
                                   axis.y / length, (double)body->scale};
}

static struct body in_world(const struct setting *setting, struct body body) {
    const narc_point at = rotate(&setting->place, body.x, body.y);
    const narc_point axis = rotate(&setting->place, (double)body.cosine, (double)body.sine);
    body.x = setting->place.x + at.x;
    body.y = setting->place.y + at.y;
    body.cosine = (float)axis.x;
    body.sine = (float)axis.y;
    return body;
}

/* Half of what is beside thin ground comes out of the air, up to half of its size away, or as deep as what it is wide. */
static struct body place_body(struct test_random *random, const struct setting *setting, const struct shape *shape) {
    narc_circle inner, around;
    const double reach = setting->margin > 0 ? setting->margin : 0.01;
    if (setting->kind->place)
        return setting->kind->place(random, setting, shape);
    if (setting->kind->family < CHAIN_SLAB)
        return ride_chain(random, &setting->chain, shape, reach);
    narc_compute_inscribed_circle(shape->arcs, shape->count, &inner);
    narc_compute_bounding_circle(shape->arcs, shape->count, &around);
    switch (random_below(random, 4)) {
    case 0:
        return ride_chain(random, &setting->chain, shape, around.radius * random_log_between(random, 0.01, 0.5));
    case 1:
        return approach_chain(random, &setting->chain, setting->ground, shape,
                              -2 * inner.radius * random_log_between(random, 1e-3, 1));
    default:
        return approach_chain(random, &setting->chain, setting->ground, shape,
                              around.radius * random_log_between(random, 1e-3, 0.5));
    }
}

static bool make_setting(struct test_random *random, const struct kind *kind, narc_arc *arcs, struct setting *setting) {
    setting->kind = kind;
    setting->chain = kind->make_chain ? kind->make_chain(random, arcs) : make_chain(random, kind->family, arcs);
    setting->margin = random_below(random, 4) ? random_log_between(random, 1e-3, 0.1) : 0;
    setting->place = turned_body(random_below(random, 2) ? random_between(random, -pi, pi) : 0, 1);
    setting->place.x = random_below(random, 2) ? random_between(random, -100, 100) : 0;
    setting->place.y = random_below(random, 2) ? random_between(random, -100, 100) : 0;
    setting->store = empty_store();
    setting->weld = random_below(random, 2) ? random_log_between(random, 0.3, 10) : 0;
    const narc_chain_options options = {.closed = setting->chain.closed, .weld = setting->weld};
    narc_error error = {0};
    const narc_status status = narc_add_chain(setting->store, arcs, setting->chain.count, &options, setting->entries,
                                              ENTRIES, &setting->entry_count, &error);
    /* Arcs that turn by next to nothing are too flat. Thin sheets may cross themselves. */
    if (status == NARC_ERROR_RADIUS || (kind->family >= CHAIN_SLAB && status == NARC_ERROR_NOT_SIMPLE)) {
        narc_destroy_shapes(setting->store);
        return false;
    }
    if (status != NARC_OK && getenv("NARC_TEST_SHOW")) {
        print_error("weld %.17g closed %d: %s\n", options.weld, options.closed, error.message);
        for (size_t k = 0; k < setting->chain.count; k++)
            print_error("  {%.17g, %.17g, %.17g, %.17g, %.17g},\n", arcs[k].center_x, arcs[k].center_y, arcs[k].radius,
                        arcs[k].start, arcs[k].end);
        narc_destroy_shapes(setting->store);
        return false;
    }
    expect_ok(status, &error);
    setting->ground = make_ground(&setting->chain);
    uint32_t stored[SHAPES];
    for (size_t k = 0; k < SHAPES; k++) {
        setting->shapes[k] =
            kind->make_shape ? kind->make_shape(random) : make_rider(random, &setting->chain, kind->family);
        stored[k] = store_shape(setting->store, setting->shapes[k]);
    }
    for (size_t k = 0; k < BODIES; k++) {
        const struct shape *shape = &setting->shapes[k % SHAPES];
        setting->bodies[k] = in_world(setting, place_body(random, setting, shape));
        setting->bodies[k].shape = stored[k % SHAPES];
    }
    struct body *far = &setting->bodies[BODIES]; /* lawful, and changes nothing */
    *far = turned_body(0, 1);
    *(random_below(random, 2) ? &far->x : &far->y) = random_below(random, 2) ? 1e24 : -1e24;
    far->shape = stored[0];
    for (size_t k = 0; k < setting->entry_count; k++) {
        struct body entry = turned_body(0, 1);
        entry.x = setting->entries[k].x;
        entry.y = setting->entries[k].y;
        entry.shape = setting->entries[k].shape;
        entry = in_world(setting, entry);
        entry.cosine = setting->place.cosine;
        entry.sine = setting->place.sine;
        setting->bodies[MOVERS + k] = entry;
        setting->runs[MOVERS + k] = setting->entries[k].run;
    }
    return true;
}

static void end_setting(struct setting *setting) {
    destroy_ground(setting->ground);
    narc_destroy_shapes(setting->store);
}

/* What is asked of all bodies whose boxes meet an entry's, each with those, and of what is far away with all entries, before
 * the others. */
struct question {
    narc_bodies bodies;
    narc_pairs list, near;
    struct pair pairs[MOVERS * ENTRIES];
};

static void pose_question(const struct setting *setting, struct question *out) {
    static narc_box boxes[MOVERS + ENTRIES];
    const size_t count = MOVERS + setting->entry_count;
    out->bodies = (narc_bodies){.count = count,
                                .x = NARC_POSITION_COLUMN(setting->bodies, x),
                                .y = NARC_POSITION_COLUMN(setting->bodies, y),
                                .cosine = NARC_COLUMN(setting->bodies, cosine),
                                .sine = NARC_COLUMN(setting->bodies, sine),
                                .scale = NARC_COLUMN(setting->bodies, scale),
                                .shape = NARC_COLUMN(setting->bodies, shape)};
    const narc_box_options options = {.margin = (float)(setting->margin / 2)};
    narc_error error = {0};
    expect_ok(narc_compute_boxes(setting->store, &out->bodies, &options, boxes, &error), &error);
    size_t pair_count = 0;
    for (uint32_t b = MOVERS; b < count; b++)
        out->pairs[pair_count++] = (struct pair){BODIES, b};
    for (uint32_t a = 0; a < BODIES; a++) {
        for (uint32_t b = MOVERS; b < count; b++)
            if (boxes[a].min_x <= boxes[b].max_x && boxes[b].min_x <= boxes[a].max_x &&
                boxes[a].min_y <= boxes[b].max_y && boxes[b].min_y <= boxes[a].max_y)
                out->pairs[pair_count++] = (struct pair){a, b};
    }
    const struct pair *near = &out->pairs[setting->entry_count];
    out->list = (narc_pairs){.count = pair_count, .a = NARC_COLUMN(out->pairs, a), .b = NARC_COLUMN(out->pairs, b)};
    out->near =
        (narc_pairs){.count = pair_count - setting->entry_count, .a = NARC_COLUMN(near, a), .b = NARC_COLUMN(near, b)};
}

/* The manifolds of the bodies near the ground. */
static size_t find_rows(const struct setting *setting, const struct question *question, narc_manifold *rows) {
    static narc_manifold with_far[ROWS];
    size_t skipped = 0, found = 0, again = 0;
    const narc_query query = {.margin = (float)setting->margin, .out_skipped = &skipped};
    narc_error error = {0};
    expect_ok(
        narc_find_manifolds(setting->store, &question->bodies, &question->near, &query, rows, ROWS, &found, &error),
        &error);
    assert_int_equal(skipped, 0);
    expect_ok(
        narc_find_manifolds(setting->store, &question->bodies, &question->list, &query, with_far, ROWS, &again, &error),
        &error);
    assert_true(again == found && skipped <= setting->entry_count); /* pairs so far apart may have no answer */
    for (size_t k = 0; k < found; k++)
        with_far[k].pair -= (uint32_t)setting->entry_count;
    assert_memory_equal(with_far, rows, found * sizeof *rows);
    for (size_t k = 1; k < found; k++) /* a pair's rows are in the order of their normals */
        assert_true(rows[k].pair != rows[k - 1].pair ||
                    rows[k - 1].normal_x * rows[k].normal_y - rows[k - 1].normal_y * rows[k].normal_x >= 0);
    return found;
}

static uint32_t body_of(const narc_pairs *pairs, size_t pair) {
    return *(const uint32_t *)((const char *)pairs->a.base + pair * (size_t)pairs->a.stride);
}

static double deepest_of(const narc_manifold *row) {
    return (double)(row->count > 1 ? fminf(row->point[0].separation, row->point[1].separation)
                                   : row->point[0].separation);
}

/* What contacts, overlaps and the starts of casts say agrees; counts what they tell of each body. */
static void ask_otherwise(const struct setting *setting, const struct question *question,
                          const narc_manifold *manifolds, size_t manifold_count, size_t (*told)[PHANTOMS]) {
    static narc_contact rows[ROWS];
    static narc_impact impacts[MOVERS * ENTRIES];
    static uint64_t bits[MOVERS * ENTRIES / 64 + 1];
    static double deepest[MOVERS * ENTRIES];
    static float motion[MOVERS + ENTRIES];
    const narc_pairs *pairs = &question->near;
    const narc_index_column runs = {setting->runs, sizeof *setting->runs};
    const narc_query query = {.margin = (float)setting->margin};
    size_t count = 0;
    narc_error error = {0};
    for (size_t k = 0; k < MOVERS; k++)
        motion[k] = (float)(k % 16) / 64 - 0.1f;
    const narc_motions motions = {.x = NARC_ARRAY(motion), .y = {&motion[5], 0}};
    expect_ok(narc_find_contacts(setting->store, &question->bodies, pairs, &query, rows, ROWS, &count, &error), &error);
    expect_ok(narc_find_overlaps(setting->store, &question->bodies, pairs, NULL, bits, &error), &error);
    expect_ok(narc_cast_pairs(setting->store, &question->bodies, &motions, pairs, NULL, NULL, impacts, MOVERS * ENTRIES,
                              &error),
              &error);
    for (size_t k = 0; k < pairs->count; k++)
        deepest[k] = INFINITY;
    for (size_t k = 0; k < count; k++) {
        deepest[rows[k].pair] = fmin(deepest[rows[k].pair], (double)rows[k].separation);
        told[body_of(pairs, rows[k].pair)][CONTACTS] += rows[k].separation < 0;
    }
    for (size_t k = 0; k < pairs->count; k++) {
        const bool begins = impacts[k].count == NARC_CAST_HIT && impacts[k].fraction == 0;
        assert_int_equal(bit_is_set(bits, k), deepest[k] < 0);
        told[body_of(pairs, k)][OVERLAPS] += bit_is_set(bits, k);
        told[body_of(pairs, k)][CASTS] += begins;
    }
    assert_int_equal(manifold_count, count);
    for (size_t k = 0; k < count; k++) {
        assert_true(manifolds[k].pair == rows[k].pair && deepest_of(&manifolds[k]) == (double)rows[k].separation);
        told[body_of(pairs, rows[k].pair)][MANIFOLDS] += deepest_of(&manifolds[k]) < 0;
    }
    count = narc_merge_contacts(pairs, runs, rows, count);
    for (size_t k = 0; k < count; k++)
        told[body_of(pairs, rows[k].pair)][MERGED_CONTACTS] += rows[k].separation < 0;
}

/* The documented bound of a separation's error, with the entry's extent, closure and all. */
static double entry_bound(const struct setting *setting, const struct reference_body *body, uint32_t b) {
    narc_arc arcs[NARC_MAX_ARCS];
    const narc_chain_entry *entry = &setting->entries[b - MOVERS];
    const size_t count = narc_get_arcs(setting->store, entry->shape, arcs);
    double extent = 0;
    for (size_t k = 0; k < count; k++)
        extent = fmax(extent, hypot(arcs[k].center_x, arcs[k].center_y) + fabs(arcs[k].radius));
    return NARC_ERROR_BOUND * (hypot(body->x - entry->x, body->y - entry->y) + extent + reference_extent(body));
}

static struct told read_row(const struct setting *setting, const struct reference_body *body, const struct pair *pair,
                            const narc_manifold *row) {
    const size_t deepest = row->count > 1 && row->point[1].separation < row->point[0].separation;
    const narc_manifold_point *point = &row->point[deepest];
    const narc_point normal = rotate_back(&setting->place, (double)row->normal_x, (double)row->normal_y);
    const narc_point offset = rotate_back(&setting->place, (double)point->x, (double)point->y);
    const double half = (double)point->separation / 2;
    const narc_manifold_point *second = &row->point[row->count > 1 ? 1 - deepest : deepest];
    const narc_point second_offset = rotate_back(&setting->place, (double)second->x, (double)second->y);
    const double second_half = (double)second->separation / 2;
    struct told told = {.normal_x = -normal.x, .normal_y = -normal.y, .separation = 2 * half, .run = GROUND_CONCAVE};
    told.at = (narc_point){body->x + offset.x - half * normal.x, body->y + offset.y - half * normal.y};
    told.foot = (narc_point){body->x + offset.x + half * normal.x, body->y + offset.y + half * normal.y};
    told.other = (narc_point){body->x + second_offset.x - second_half * normal.x,
                              body->y + second_offset.y - second_half * normal.y};
    told.other_separation = 2 * second_half;
    told.bound = entry_bound(setting, body, pair->b);
    told.entry = pair->b - MOVERS;
    told.count = row->count;
    told.feature = point->feature;
    const double apart = -(double)row->radius_a - (double)row->radius_b - told.separation; /* the centres */
    told.is_centred = row->radius_b < 0 && apart < -(double)row->radius_b / 256;
    told.slide = row->radius_b < 0 ? told.bound * fmax(1, -(double)row->radius_b / apart) : told.bound;
    return told;
}

static double distance_between(narc_point a, narc_point b) { return hypot(a.x - b.x, a.y - b.y); }

/* How far a point is from the open ends of a chain. */
static double find_end_distance(const struct chain *chain, narc_point point) {
    const narc_arc *first = &chain->arcs[0], *last = &chain->arcs[chain->count - 1];
    const narc_point from = {first->center_x + first->radius * cos(first->start),
                             first->center_y + first->radius * sin(first->start)};
    const narc_point to = {last->center_x + last->radius * cos(last->end),
                           last->center_y + last->radius * sin(last->end)};
    return chain->closed ? INFINITY : fmin(distance_between(from, point), distance_between(to, point));
}

/* Does a point lie where two pieces meet? Seams reach beyond that: arcs by 1e-4 rad, edges by 2^-16 of their length. */
static bool is_at_seam(const struct chain *chain, narc_point point, double bound) {
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k];
        const double seam = 4 * bound + 1.1e-4 * (1 + fabs(arc->radius));
        for (int end = 0; end < 2; end++) {
            const double angle = end ? arc->end : arc->start;
            if (hypot(arc->center_x + arc->radius * cos(angle) - point.x,
                      arc->center_y + arc->radius * sin(angle) - point.y) < seam)
                return true;
        }
    }
    return false;
}

/* Does a point of the chain lie in a body? */
static bool holds(const struct reference_body *body, narc_point point) {
    const double x = (point.x - body->x) / body->scale, y = (point.y - body->y) / body->scale;
    return narc_contains_point(body->arcs, body->count,
                               (narc_point){body->cosine * x + body->sine * y, body->cosine * y - body->sine * x});
}

/* Is a place right where a concave arc begins or ends, so near that what is `depth` deep below it belongs to neither side for
 * certain, and is that more than a fifth of the arc's radius? */
static bool is_deep_beside_arc(const struct chain *chain, narc_point foot, double depth, double bound) {
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k];
        for (int end = 0; end < 2 && arc->radius < 0 && depth > -arc->radius / 5; end++) {
            const double angle = end ? arc->end : arc->start;
            const narc_point at = {arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
            if (distance_between(at, foot) <= 0x1p-10 * depth + 4 * bound)
                return true;
        }
    }
    return false;
}

/* Is the ground's outline there out of a body's reach, as docs/terrain.md has it: outside the body, which is deeper, by
 * `deepest`, than its inscribed circle is wide, or than the ground is thick there; outside its bounding circle; right beside a
 * concave arc that is small beside the depth; or no further from an open end than deep, or does the body have one within:
 * there the ground has no other side? */
static bool is_beyond(const struct setting *setting, const struct reference_body *body,
                      const struct ground_minimum *minimum, double deepest, double bound) {
    const narc_arc *first = &setting->chain.arcs[0], *last = &setting->chain.arcs[setting->chain.count - 1];
    const narc_point from = {first->center_x + first->radius * cos(first->start),
                             first->center_y + first->radius * sin(first->start)};
    const narc_point to = {last->center_x + last->radius * cos(last->end),
                           last->center_y + last->radius * sin(last->end)};
    const double depth = -minimum->foot.distance;
    narc_circle inner, around;
    if (depth <= 0)
        return false;
    if (narc_compute_bounding_circle(body->arcs, body->count, &around)) {
        const narc_point middle = {body->x + body->scale * (body->cosine * around.x - body->sine * around.y),
                                   body->y + body->scale * (body->sine * around.x + body->cosine * around.y)};
        if (distance_between(middle, minimum->foot.at) > body->scale * around.radius)
            return true;
    }
    if (find_end_distance(&setting->chain, minimum->foot.at) <= depth ||
        is_deep_beside_arc(&setting->chain, minimum->foot.at, depth, bound))
        return true;
    narc_compute_inscribed_circle(body->arcs, body->count, &inner);
    const double promised = 0.98 * fmin(2 * inner.radius * body->scale, minimum->foot.thickness);
    return (deepest > promised && !holds(body, minimum->foot.at)) ||
           (!setting->chain.closed && (holds(body, from) || holds(body, to)));
}

/* Is a row what it says: do both points lie where they should, with that normal? `size` of the body. */
static const char *check_row(const struct setting *setting, struct ground_search *search,
                             const struct reference_body *body, struct told *told, double size) {
    enum { FEET = 64 };
    double off;
    ground_project(search, told->at, &off);
    if (!(fabs(hypot(told->normal_x, told->normal_y) - 1) < 1e-6))
        return "normal not of length 1";
    if (!(off <= 4 * told->bound))
        return "point not on the body";
    /* No point of the body lies further down. */
    const double turn = atan2(body->sine, body->cosine), down = atan2(-told->normal_y, -told->normal_x) - turn;
    narc_point support;
    narc_find_support(body->arcs, body->count, cos(down), sin(down), &support, NULL);
    const double x = body->x + body->scale * (body->cosine * support.x - body->sine * support.y);
    const double y = body->y + body->scale * (body->sine * support.x + body->cosine * support.y);
    const double lowest = told->normal_x * (x - told->at.x) + told->normal_y * (y - told->at.y);
    const bool is_touch = fabs(told->separation) < 4 * told->bound; /* corner on corner: any normal */
    if (!(lowest >= -8 * told->bound) && !(is_touch && is_at_seam(&setting->chain, told->foot, told->bound)))
        return "not the lowest point along the normal";
    /* A point above the foot has that foot, or one below, at the bottom of a valley. Seams extend arcs by 1e-4 rad. Where
     * points coincide the normal is any. */
    if (is_touch)
        return NULL;
    for (int side = -1; side <= 1; side += 2) {
        const double height = 1e-3 * size * side;
        const narc_point beside = {told->foot.x + height * told->normal_x, told->foot.y + height * told->normal_y};
        struct ground_foot feet[FEET];
        const size_t count = ground_feet(setting->ground, beside, feet, FEET);
        for (size_t k = 0; k < count; k++)
            if (fabs(feet[k].distance - height) <= 4 * told->bound &&
                distance_between(feet[k].at, told->foot) <= 4 * told->bound + 1e-3 * size) {
                told->run = feet[k].run;
                return NULL;
            }
    }
    return find_end_distance(&setting->chain, told->foot) <= 8 * told->slide ? NULL : "foot not on the ground";
}

/* Of a disc with its centre next to that of a concave arc the separation alone is promised. */
static const char *check_centred(const struct setting *setting, const struct reference_body *body,
                                 const struct told *told) {
    const narc_arc *arc = &setting->chain.arcs[setting->entries[told->entry].first_arc], *own = &body->arcs[0];
    const double x =
        body->x + body->scale * (body->cosine * own->center_x - body->sine * own->center_y) - arc->center_x;
    const double y =
        body->y + body->scale * (body->sine * own->center_x + body->cosine * own->center_y) - arc->center_y;
    const double separation = -arc->radius - hypot(x, y) - body->scale * own->radius;
    return body->count > 1 || fabs(separation - told->separation) <= told->bound ? NULL : "separation wrong";
}

/* How far about a point no piece but the nearest one can be the nearest: half of what others are farther away. A side of
 * a valley may have no foot yet, but not be nearer than the bottom. */
static double find_realm(const struct setting *setting, narc_point point) {
    enum { FEET = 64 };
    struct ground_foot feet[FEET];
    const size_t count = ground_feet(setting->ground, point, feet, FEET);
    double other = INFINITY;
    for (size_t k = count; k-- > 1;)
        if (hypot(feet[k].normal_x - feet[0].normal_x, feet[k].normal_y - feet[0].normal_y) > 1e-3)
            other = fabs(feet[k].distance);
    for (const narc_arc *arc = setting->chain.arcs; arc < setting->chain.arcs + setting->chain.count; arc++)
        if (arc->radius == 0 && signbit(arc->radius))
            other = fmin(other, hypot(arc->center_x - point.x, arc->center_y - point.y));
    return count ? fmax(0, other - fabs(feet[0].distance)) / 2 : 0;
}

/* Do two rows tell of one contact, which merging should have made one: are all points of one those of the other? */
static bool is_same(const struct reference_body *body, const struct told *one, const struct told *other) {
    const struct told *const few = one->count < other->count ? one : other, *const all = few == one ? other : one;
    const narc_point point = {(one->at.x + one->foot.x) / 2, (one->at.y + one->foot.y) / 2};
    const double room = 0.9 / 4096 * hypot(point.x - body->x, point.y - body->y);
    const double at = fmin(distance_between(few->at, all->at), distance_between(few->at, all->other));
    const double second = fmin(distance_between(few->other, all->at), distance_between(few->other, all->other));
    return hypot(one->normal_x - other->normal_x, one->normal_y - other->normal_y) < 0.9e-3 && fmax(at, second) < room;
}

/* What became of a row. */
enum fate { FATE_WRONG, FATE_MATCHED, FATE_NEARER, FATE_DEEP, FATE_SHALLOW };

/* Is one of the rows less deep, of the same convex stretch? Such a stretch is as deep as its least depth. */
static bool is_overruled(const struct ground_minimum *minimum, const struct told *told, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (minimum->foot.run != GROUND_CONCAVE && told[i].run == minimum->foot.run && told[i].separation < 0 &&
            told[i].separation > minimum->foot.distance)
            return true;
    return false;
}

static const char *compare(const struct setting *setting, const struct reference_body *body, struct told *told,
                           size_t count, double fineness, struct tally *tally) {
    struct ground_search *search =
        search_ground(setting->ground, body, setting->margin + 0.01,
                      reference_extent(body) / (steps_per_body * fineness), 1 / (steps_per_piece * fineness));
    struct ground_minimum minima[GROUND_MINIMA];
    const char *wrong = NULL;
    double bound = 0, size = reference_extent(body);
    narc_circle around;
    if (narc_compute_bounding_circle(body->arcs, body->count, &around))
        size = around.radius * body->scale;
    for (size_t i = 0; i < count; i++)
        bound = fmax(bound, told[i].bound);
    bound = fmax(bound, NARC_ERROR_BOUND * 4 * (reference_extent(body) + size));
    const size_t minimum_count = ground_minima(search, 2 * bound, minima);
    size_t told_by[GROUND_MINIMA] = {0};
    enum fate fate[ROWS / BODIES];

    for (size_t i = 0; i < count && !wrong; i++) {
        wrong = told[i].is_centred ? check_centred(setting, body, &told[i])
                                   : check_row(setting, search, body, &told[i], size);
        fate[i] = told[i].is_centred ? FATE_SHALLOW : FATE_WRONG;
        for (size_t m = 0; m < minimum_count && told[i].is_centred; m++)
            told_by[m] += fabs(minima[m].foot.distance - told[i].separation) <= told[i].bound;
        if (told[i].is_centred)
            continue;
        double off;
        const double along = ground_project(search, told[i].at, &off);
        const double nearest = ground_distance(setting->ground, told[i].at).distance;
        const double other_along = ground_project(search, told[i].other, &off);
        const bool is_level = told[i].other_separation <= told[i].separation + told[i].bound;
        for (size_t m = 0; m < minimum_count && !wrong; m++) {
            const double level = fmax(minima[m].foot.distance, nearest) + 2 * bound;
            const double error = fabs(minima[m].foot.distance - told[i].separation);
            if (error > told[i].bound || (ground_barrier(search, along, minima[m].along) > level &&
                                          !(is_level && ground_barrier(search, other_along, minima[m].along) <= level)))
                continue;
            for (size_t j = 0; j < i; j++)
                if (fate[j] == FATE_MATCHED && is_same(body, &told[i], &told[j]))
                    wrong = "told twice";
            told_by[m]++;
            fate[i] = FATE_MATCHED;
            tally->worst = fmax(tally->worst, error / told[i].bound);
        }
        if (fate[i] == FATE_WRONG && told[i].separation < 0 && fabs(nearest) < fabs(told[i].separation) - told[i].bound)
            fate[i] = FATE_DEEP; /* something else is nearer: beyond reach */
        if (fate[i] == FATE_WRONG && told[i].separation >= 0 && nearest < told[i].separation - told[i].bound)
            fate[i] = FATE_NEARER; /* of a valley the other side */
        if (fate[i] == FATE_WRONG && !isfinite(nearest))
            fate[i] = FATE_DEEP; /* an open end is nearer */
        const double reach = fmin(2e-4 * size, find_realm(setting, told[i].at));
        if (fate[i] == FATE_WRONG && (ground_least(search, along, reach) >= nearest - 4 * bound ||
                                      is_at_seam(&setting->chain, told[i].foot, told[i].bound)))
            fate[i] = FATE_SHALLOW; /* the distance does not fall there but by rounding, or beyond a seam */
        if (fate[i] == FATE_WRONG && !wrong)
            wrong = "not a minimum";
    }
    double deepest = 0;
    for (size_t m = 0; m < minimum_count; m++)
        deepest = fmax(deepest, -minima[m].foot.distance);
    size_t beyond = 0, shallow = 0, matched = 0, overruled = 0, sunk = 0;
    for (size_t m = 0; m < minimum_count && !wrong; m++) {
        const double distance = minima[m].foot.distance;
        if (told_by[m])
            matched++;
        else if (distance > setting->margin + bound)
            continue;
        else if (minima[m].doubtful || is_beyond(setting, body, &minima[m], deepest, bound))
            beyond++;
        else if (distance < -minima[m].foot.grain / 2)
            sunk++; /* seams are for what is less deep than pieces are long */
        else if (is_overruled(&minima[m], told, count))
            overruled++;
        else if (distance >= setting->margin - bound || minima[m].depth < 4 * bound)
            shallow++;
        else
            wrong = "missed";
    }
    if (!wrong) {
        tally->minima += matched;
        tally->beyond += beyond;
        tally->overruled += overruled;
        tally->sunk += sunk;
        tally->shallow += shallow;
        for (size_t i = 0; i < count; i++) {
            tally->rows += fate[i] == FATE_MATCHED;
            tally->deep += fate[i] == FATE_DEEP;
            tally->nearer += fate[i] == FATE_NEARER;
            tally->touching += fate[i] == FATE_SHALLOW;
        }
    }
    if (wrong && fineness > 1 && getenv("NARC_TEST_SHOW")) {
        print_error("a failure\n");
        for (size_t m = 0; m < minimum_count; m++)
            print_error("  minimum %.9g at (%.9g, %.9g), normal (%.6g, %.6g), depth %.3g%s, told %zu times\n",
                        minima[m].foot.distance, minima[m].at.x, minima[m].at.y, minima[m].foot.normal_x,
                        minima[m].foot.normal_y, minima[m].depth, minima[m].doubtful ? ", doubtful" : "", told_by[m]);
        for (size_t i = 0; i < count; i++)
            print_error("  row %.9g at (%.9g, %.9g), normal (%.6g, %.6g), bound %.3g, distance there %.9g; "
                        "entry %u of run %d at (%.6g, %.6g), %u points, feature %04x\n",
                        told[i].separation, told[i].at.x, told[i].at.y, told[i].normal_x, told[i].normal_y,
                        told[i].bound, ground_distance(setting->ground, told[i].at).distance, told[i].entry,
                        (int)setting->entries[told[i].entry].run, setting->entries[told[i].entry].x,
                        setting->entries[told[i].entry].y, told[i].count, told[i].feature);
    }
    destroy_search(search);
    return wrong;
}

static void print_failure(const struct setting *setting, const struct reference_body *body) {
    for (size_t i = 0; i < body->count; i++)
        print_error("  B {%.17g, %.17g, %.17g, %.17g, %.17g}\n", body->arcs[i].center_x, body->arcs[i].center_y,
                    body->arcs[i].radius, body->arcs[i].start, body->arcs[i].end);
    print_error("  P %.17g %.17g %.17g %.17g %.17g\n", body->x, body->y, body->cosine, body->sine, body->scale);
    print_error("  C %d %.17g\n", setting->chain.closed, setting->weld);
    for (size_t i = 0; i < setting->chain.count && setting->chain.count < 400; i++) {
        const narc_arc *arc = &setting->chain.arcs[i];
        print_error("  {%.17g, %.17g, %.17g, %.17g, %.17g}\n", arc->center_x, arc->center_y, arc->radius, arc->start,
                    arc->end);
    }
}

/* Nothing tells of a body in the air that it touches the ground; and of one that does, casts begin with that. (At an open
 * end rounding decides.) */
static const char *check_forms(const struct setting *setting, const struct reference_body *body, const size_t *told,
                               const struct told *deepest, struct tally *tally) {
    const struct ground_clearance clearance = ground_find_clearance(setting->ground, body);
    const double room = 1e-5 * (1 + hypot(body->x, body->y) + reference_extent(body));
    bool is_told = false;
    tally->met += !(clearance.distance > 0);
    if (!(clearance.distance > 0) && deepest && deepest->separation < -room && setting->chain.closed &&
        told[CASTS] == 0 && !is_deep_beside_arc(&setting->chain, deepest->foot, -deepest->separation, deepest->bound)) {
        tally->unmet++;
        return "no cast begins with it";
    }
    if (!clearance.in_air || clearance.distance < room)
        return NULL;
    tally->in_air++;
    for (int k = 0; k < PHANTOMS; k++) {
        tally->phantoms[k] += told[k] > 0;
        is_told |= told[k] > 0;
    }
    return is_told ? "told of in the air" : NULL;
}

static void check_setting(const struct setting *setting, struct tally *tally) {
    static struct question question;
    static narc_manifold rows[ROWS];
    static struct told told[ROWS];
    size_t otherwise[MOVERS][PHANTOMS] = {{0}};
    pose_question(setting, &question);
    size_t count = find_rows(setting, &question, rows);
    ask_otherwise(setting, &question, rows, count, otherwise);
    const uint32_t *runs = setting->runs;
    count = narc_merge_manifolds(&question.near, (narc_index_column){runs, sizeof *runs}, rows, count);
    for (size_t k = 0; k < count; k++)
        otherwise[body_of(&question.near, rows[k].pair)][MERGED_MANIFOLDS] += deepest_of(&rows[k]) < 0;
    for (size_t k = 0, row = 0; k < BODIES; k++) {
        const struct reference_body body = pose_on(setting, k);
        size_t of_body = 0;
        for (; row < count && body_of(&question.near, rows[row].pair) == k; row++)
            told[of_body++] =
                read_row(setting, &body, &question.pairs[setting->entry_count + rows[row].pair], &rows[row]);
        tally->bodies++;
        const struct told *deepest = NULL;
        for (size_t i = 0; i < of_body; i++)
            if (!deepest || told[i].separation < deepest->separation)
                deepest = &told[i];
        const char *wrong = check_forms(setting, &body, otherwise[k], deepest, tally);
        if (!wrong && compare(setting, &body, told, of_body, 1, tally))
            wrong = compare(setting, &body, told, of_body, finer, tally);
        if (wrong && (tally->wrong++ < SHOWN || getenv("NARC_TEST_SHOW"))) {
            if (getenv("NARC_TEST_SHOW"))
                print_failure(setting, &body);
            print_error("%s: %s; margin %.9g, body of %zu arcs at (%a, %a)\n", setting->kind->name, wrong,
                        setting->margin, body.count, body.x, body.y);
        }
    }
}

static void check_kind(const struct kind *kind) {
    static narc_arc arcs[CHAIN_ARCS];
    static struct setting setting;
    char name[64];
    snprintf(name, sizeof name, "ground, %s", kind->name);
    struct test_random random = test_random_named(name);
    struct tally tally = {0};
    for (size_t trial = test_trials(kind->make_chain ? 3 : 10); trial > 0; trial--)
        if (make_setting(&random, kind, arcs, &setting)) {
            check_setting(&setting, &tally);
            end_setting(&setting);
        } else
            tally.refused++;
    printf("  %s: %zu bodies, %zu minima told by %zu rows; %zu minima beyond reach, %zu deeper than half of what is "
           "there, %zu of runs that are less deep, %zu rows deeper, %zu rows of farther "
           "sides, %zu minima and %zu rows shallow; %zu wrong, %zu chains refused, largest error %.3f\n",
           kind->name, tally.bodies, tally.minima, tally.rows, tally.beyond, tally.sunk, tally.overruled, tally.deep,
           tally.nearer, tally.shallow, tally.touching, tally.wrong, tally.refused, tally.worst);
    printf("    %zu in the air, of which told: %zu (manifolds %zu, contacts %zu, merged %zu, overlaps %zu, casts %zu); "
           "%zu meet the ground, of %zu a cast does not begin with that\n",
           tally.in_air, tally.phantoms[MERGED_MANIFOLDS], tally.phantoms[MANIFOLDS], tally.phantoms[CONTACTS],
           tally.phantoms[MERGED_CONTACTS], tally.phantoms[OVERLAPS], tally.phantoms[CASTS], tally.met, tally.unmet);
    assert_int_equal(tally.wrong, 0);
    assert_true(kind->make_chain || tally.bodies < 10 * BODIES || tally.minima > tally.bodies / 4);
}

static void check_family(enum chain_family family) {
    check_kind(&(struct kind){.name = chain_family_name(family), .family = family});
}

TEST(test_hills) { check_family(CHAIN_HILLS); }
TEST(test_mixed) { check_family(CHAIN_MIXED); }
TEST(test_bowls) { check_family(CHAIN_BOWLS); }
TEST(test_tight) { check_family(CHAIN_TIGHT); }
TEST(test_fine) { check_family(CHAIN_FINE); }
TEST(test_steps) { check_family(CHAIN_STEPS); }
TEST(test_long) { check_family(CHAIN_LONG); }
TEST(test_closed) { check_family(CHAIN_CLOSED); }
TEST(test_ends) { check_family(CHAIN_ENDS); }
TEST(test_slab) { check_family(CHAIN_SLAB); }
TEST(test_arch) { check_family(CHAIN_ARCH); }
TEST(test_zigzag) { check_family(CHAIN_ZIGZAG); }
TEST(test_sheet) { check_family(CHAIN_SHEET); }
TEST(test_angle) { check_family(CHAIN_ANGLE); }
TEST(test_cup) { check_family(CHAIN_CUP); }
TEST(test_pipe) { check_family(CHAIN_PIPE); }
TEST(test_walls) { check_family(CHAIN_WALLS); }
TEST(test_gear) { check_family(CHAIN_GEAR); }

/* ------------------------------------------------------------------------------------------------ scenes */

static struct chain end_walk(struct turtle *t, narc_arc *arcs) {
    const struct chain chain = {memcpy(arcs, t->arcs, t->count * sizeof *arcs), t->count, true};
    free(t->arcs);
    return chain;
}

/* A polygon, counter-clockwise, with corners and the bottoms of valleys. */
static struct chain fold(const narc_point *point, size_t count, narc_arc *arcs) {
    for (size_t k = 0; k < count; k++) {
        const narc_point *p = &point[(k + count - 1) % count], *q = &point[k], *r = &point[(k + 1) % count];
        const double start = atan2(q->y - p->y, q->x - p->x) - pi / 2;
        const double turn = remainder(atan2(r->y - q->y, r->x - q->x) - pi / 2 - start, 2 * pi);
        arcs[k] = (narc_arc){q->x, q->y, copysign(0, turn), start, start + turn};
    }
    return (struct chain){arcs, count, true};
}

/* Half a turn of eight sides around (0, 0), 4 away and 0.02 thick. */
static struct chain make_arch_of_eight(__attribute__((unused)) struct test_random *random, narc_arc *arcs) {
    enum { SIDES = 8 };
    narc_point point[2 * SIDES + 2];
    for (int k = 0; k <= SIDES; k++) {
        const double angle = pi * k / SIDES, inner = 4 - 0.02 / cos(pi / SIDES / 2);
        point[k] = (narc_point){4 * cos(angle), 4 * sin(angle)};
        point[2 * SIDES + 1 - k] = (narc_point){inner * cos(angle), inner * sin(angle)};
    }
    return fold(point, 2 * SIDES + 2, arcs);
}

static struct shape choose_box(struct test_random *random) {
    static const double forms[][3] = {{1, 1, 0}, {3, 0.3, 0}, {1.5, 2.3, 0}, {1.26, 0.0126, 0}, {1.57, 0.47, 0.12}};
    const double *form = forms[random_below(random, sizeof forms / sizeof *forms)];
    return box_of(form[0], form[1], form[2]);
}

/* Up to 0.05 above. */
static struct body place_close(struct test_random *random, const struct setting *setting, const struct shape *shape) {
    return approach_chain(random, &setting->chain, setting->ground, shape, random_log_between(random, 1e-3, 0.05));
}

TEST(test_boxes_above_an_arch) {
    check_kind(&(struct kind){"boxes above an arch", CHAIN_ARCH, make_arch_of_eight, choose_box, place_close});
}

/* A sheet that is bent once, with the ridge at (0, 0); to both sides it falls away by the same angle. */
static struct chain make_roof(struct test_random *random, narc_arc *arcs) {
    const double fall = random_below(random, 4) ? random_between(random, 0.1, 1.2) : atan(1. / 3);
    const double thickness = random_log_between(random, 0.02, 0.3), half = random_between(random, 2, 4);
    const double x = half * cos(fall), y = -half * sin(fall), low = thickness / cos(fall);
    return fold((const narc_point[]){{0, 0}, {-x, y}, {-x, y - low}, {0, -low}, {x, y - low}, {x, y}}, 6, arcs);
}

static struct shape choose_plank(struct test_random *random) {
    return random_below(random, 2) ? box_of(3, 0.3, 0) : box_of(2, 0.3, 0);
}

/* Up to 0.1 above the ridge, level or not, with its middle or what is beside that. */
static struct body place_on_ridge(struct test_random *random, const struct setting *setting,
                                  const struct shape *shape) {
    const double fall = setting->chain.arcs[0].end - pi / 2;
    struct body body = turned_body(random_below(random, 3) ? random_between(random, -0.99, 0.99) * fall : 0, 1);
    const double c = (double)body.cosine, s = (double)body.sine, height = 0.15 + random_log_between(random, 1e-3, 0.1);
    const double along = random_below(random, 4) ? random_between(random, -1, 1) * shape->arcs[0].center_x : 0;
    body.x = along * c - height * s;
    body.y = along * s + height * c;
    return body;
}

TEST(test_planks_on_a_ridge) {
    check_kind(&(struct kind){"planks on a ridge", CHAIN_ANGLE, make_roof, choose_plank, place_on_ridge});
}

/* A slab with square ends or round ones. */
static struct chain make_ledge(struct test_random *random, narc_arc *arcs) {
    static const double thicknesses[] = {0.02, 0.05, 0.05, 0.1, 0.3};
    const double thickness = thicknesses[random_below(random, 5)], radius = random_below(random, 2) ? thickness / 2 : 0;
    struct turtle t = create_turtle(5, thickness, pi / 2);
    for (int k = 0; k < 2; k++) {
        walk_line(&t, 10);
        walk_arc(&t, radius, radius > 0 ? pi : pi / 2);
        if (radius > 0)
            continue;
        walk_line(&t, thickness);
        walk_arc(&t, 0, pi / 2);
    }
    return end_walk(&t, arcs);
}

static struct shape choose_sharp(struct test_random *random) {
    const narc_four_arc lens = {1, 1, 1.4, 0, 0};
    const size_t kind = random_below(random, 8);
    struct shape shape;
    narc_status status = NARC_OK;
    if (kind == 0)
        return box_of(1, random_below(random, 2) ? 0.5 : 1, 0);
    if (kind == 1)
        status = narc_build_four_arc(lens, shape.arcs, &shape.count, NULL);
    else
        status =
            narc_build_regular_polygon(kind == 2 ? 5 : 3, 0.6, kind == 3 ? 0.1 : 0, shape.arcs, &shape.count, NULL);
    assert_int_equal(status, NARC_OK);
    return shape;
}

/* Anywhere about the right end. */
static struct body place_about_end(struct test_random *random, __attribute__((unused)) const struct setting *setting,
                                   __attribute__((unused)) const struct shape *shape) {
    struct body body = turned_body(random_between(random, -pi, pi), 1);
    body.x = 5 + random_between(random, -0.8, 0.8);
    body.y = random_between(random, -0.8, 1.2);
    return body;
}

TEST(test_triangles_round_an_end) {
    check_kind(&(struct kind){"triangles round an end", CHAIN_SLAB, make_ledge, choose_sharp, place_about_end});
}

/* Ten long, one thick. */
static struct chain make_slab(__attribute__((unused)) struct test_random *random, narc_arc *arcs) {
    return fold((const narc_point[]){{-5, -1}, {5, -1}, {5, 0}, {-5, 0}}, 4, arcs);
}

static struct shape choose_flat(struct test_random *random) {
    const size_t kind = random_below(random, 3);
    return kind == 0 ? box_of(1, 1, 0) : kind == 1 ? capsule_of(1, 0.5) : circle_of(0.5);
}

/* An edge, or where a circle begins, along the top but for what rounding makes of it. */
static struct body place_flat(struct test_random *random, __attribute__((unused)) const struct setting *setting,
                              const struct shape *shape) {
    const double tilt = (double)random_below(random, 2) * random_log_between(random, 1e-9, 1e-5);
    struct body body = turned_body(-pi / 2 - shape->arcs[0].start + (random_below(random, 2) ? tilt : -tilt), 1);
    body.x = random_between(random, -4, 4);
    body.y = 0.5 - random_log_between(random, 1e-4, 0.1);
    return body;
}

TEST(test_boxes_flat_on_a_slab) {
    check_kind(&(struct kind){"boxes flat on a slab", CHAIN_SLAB, make_slab, choose_flat, place_flat});
}

/* A gate from x = -1 to 1: the level line above goes over into an arc on both sides. */
static struct chain make_gate(struct test_random *random, narc_arc *arcs) {
    const double radius = random_between(random, 0.1, 0.8), height = random_between(random, 1, 3);
    struct turtle t = create_turtle(-3, 0, -pi / 2);
    walk_line(&t, 2);
    walk_arc(&t, 0, pi / 2);
    walk_line(&t, height - radius);
    walk_arc(&t, radius, -pi / 2);
    walk_line(&t, 2 - 2 * radius);
    walk_arc(&t, radius, -pi / 2);
    walk_line(&t, height - radius);
    walk_arc(&t, 0, pi / 2);
    for (int k = 0; k < 4; k++) {
        walk_line(&t, k == 0 ? 2 : k == 2 ? 6 : height + 1);
        walk_arc(&t, 0, pi / 2);
    }
    return end_walk(&t, arcs);
}

static struct shape choose_needle(struct test_random *random) {
    const double length = random_log_between(random, 0.05, 0.5);
    return random_below(random, 2) ? box_of(length, length / 100, 0) : capsule_of(length, length / 15);
}

/* Upright below the place where line and arc meet, or along the tangent there. */
static struct body place_below_joint(struct test_random *random, const struct setting *setting,
                                     const struct shape *shape) {
    const narc_arc *arc = &setting->chain.arcs[1], *own = &shape->arcs[0];
    const bool is_upright = random_below(random, 2);
    const double width = own->center_y + own->radius, length = own->center_x + own->radius;
    struct body body = turned_body(is_upright ? pi / 2 : 0, 1);
    const double gap = (double)random_below(random, 3) * random_log_between(random, 1e-9, 1e-2) * length;
    body.x = arc->center_x + ((double)random_below(random, 3) - 1) * (is_upright ? width : length);
    body.y = arc->center_y - arc->radius - (is_upright ? length : width) - gap;
    return body;
}

TEST(test_needles_below_a_joint) {
    check_kind(&(struct kind){"needles below a joint", CHAIN_CUP, make_gate, choose_needle, place_below_joint});
}

TEST_MAIN("ground minima")
