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

#include "chains.h"
#include "check.h"
#include "expect.h"
#include "merge.h"
#include "narc_broad_phase.h"

enum { SHOWN = 3, BODIES = 160, MOVERS, SHAPES = 16, MOST_TOLD = 1024 };

/* A search with so many steps along a body, or across the smallest piece beside it; and how much finer where it seems to
 * have missed something. */
static const double steps_per_body = 96, steps_per_piece = 3, finer = 16;

/* Minima that must be told and were, by rows; minima and rows that are not compared, or by themselves alone, see below;
 * bodies that touch none of the ground, and are not in it, and how many of them are told of; that meet it, of which no cast
 * begins with that. */
enum what {
    BODY,
    MINIMUM,
    ROW,
    BEYOND,
    SUNK,
    OVERRULED,
    DEEP,
    NEARER,
    SHALLOW,
    TOUCHING,
    WRONG,
    REFUSED,
    IN_AIR,
    TOLD,
    MET,
    UNMET,
    WHATS
};

static const char *const what_names[WHATS] = {"bodies",
                                              "minima told by",
                                              "rows;",
                                              "minima beyond reach,",
                                              "deeper than half of what is there,",
                                              "of runs that are less deep;",
                                              "rows deeper,",
                                              "of farther sides;",
                                              "minima shallow,",
                                              "rows;",
                                              "wrong,",
                                              "chains refused,",
                                              "bodies in the air,",
                                              "of them told;",
                                              "meet the ground,",
                                              "of them without a cast"};

struct counts {
    size_t of[WHATS];
    double worst; /* error of a separation, by its bound */
};

struct setting;

/* Ground and bodies: those of a family, or a scene's own. */
struct kind {
    const char *name;
    enum chain_family family;
    struct chain (*make_chain)(struct test_random *random);
    struct shape (*make_shape)(struct test_random *random);
    struct body (*place)(struct test_random *random, const struct setting *setting, const struct shape *shape);
};

struct setting {
    const struct kind *kind;
    struct ground_scene *scene;
    struct body bodies[MOVERS];  /* the last one is far away */
    struct shape shapes[SHAPES]; /* of body k the one with the number k % SHAPES */
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

/* Half of what is beside thin ground comes out of the air, up to half of its size away, or as deep as what it is wide. */
static struct body place_body(struct test_random *random, const struct setting *setting, const struct shape *shape) {
    const struct chain *const chain = &setting->scene->chain;
    narc_circle inner, around;
    const double reach = setting->margin > 0 ? setting->margin : 0.01;
    if (setting->kind->place)
        return setting->kind->place(random, setting, shape);
    if (setting->kind->family < CHAIN_SLAB)
        return ride_chain(random, chain, shape, reach);
    narc_compute_inscribed_circle(shape->arcs, shape->count, &inner);
    narc_compute_bounding_circle(shape->arcs, shape->count, &around);
    switch (random_below(random, 4)) {
    case 0:
        return ride_chain(random, chain, shape, around.radius * random_log_between(random, 0.01, 0.5));
    case 1:
        return approach_chain(random, chain, setting->scene->ground, shape,
                              -2 * inner.radius * random_log_between(random, 1e-3, 1));
    default:
        return approach_chain(random, chain, setting->scene->ground, shape,
                              around.radius * random_log_between(random, 1e-3, 0.5));
    }
}

static bool make_setting(struct test_random *random, const struct kind *kind, struct setting *setting) {
    const struct chain chain = kind->make_chain ? kind->make_chain(random) : make_chain(random, kind->family);
    struct ground_scene *const scene = setting->scene = create_ground_scene();
    setting->kind = kind;
    setting->margin = random_below(random, 4) ? random_log_between(random, 1e-3, 0.1) : 0;
    setting->weld = random_below(random, 2) ? random_log_between(random, 0.3, 10) : 0;
    scene->place = turned_body(random_below(random, 2) ? random_between(random, -PI, PI) : 0, 1);
    scene->place.x = random_below(random, 2) ? random_between(random, -100, 100) : 0;
    scene->place.y = random_below(random, 2) ? random_between(random, -100, 100) : 0;
    narc_error error = {0};
    const narc_status status = add_ground(scene, chain, (narc_chain_options){.weld = setting->weld}, &error);
    /* Arcs that turn by next to nothing are too flat. Thin sheets may cross themselves. */
    if (status == NARC_ERROR_RADIUS || (kind->family >= CHAIN_SLAB && status == NARC_ERROR_NOT_SIMPLE)) {
        destroy_ground_scene(scene);
        return false;
    }
    expect_ok(status, &error);
    ground_of(scene);
    uint32_t stored[SHAPES];
    for (size_t k = 0; k < SHAPES; k++) {
        setting->shapes[k] =
            kind->make_shape ? kind->make_shape(random) : make_rider(random, &scene->chain, kind->family);
        stored[k] = store_shape(scene->store, setting->shapes[k]);
    }
    for (size_t k = 0; k < BODIES; k++) {
        setting->bodies[k] = ground_to_world(scene, place_body(random, setting, &setting->shapes[k % SHAPES]));
        setting->bodies[k].shape = stored[k % SHAPES];
    }
    struct body *far = &setting->bodies[BODIES]; /* lawful, and changes nothing */
    *far = turned_body(0, 1);
    *(random_below(random, 2) ? &far->x : &far->y) = random_below(random, 2) ? 1e24 : -1e24;
    far->shape = stored[0];
    return true;
}

/* Pairs of what is far away with all entries, before those of all bodies whose boxes meet an entry's, each with these. */
struct near_pairs {
    narc_bodies movers, ground;
    narc_pairs list;
    struct pair pairs[MOVERS * GROUND_ENTRIES];
};

static void find_near_pairs(const struct setting *setting, struct near_pairs *out) {
    static narc_box boxes[MOVERS], entries[GROUND_ENTRIES];
    const struct ground_scene *const scene = setting->scene;
    const narc_box_options options = {.margin = (float)(setting->margin / 2)};
    narc_error error = {0};
    out->movers = view_columns(setting->bodies, MOVERS);
    out->ground = view_columns(scene->bodies, scene->count);
    expect_ok(narc_compute_boxes(scene->store, &out->movers, &options, boxes, &error), &error);
    expect_ok(narc_compute_boxes(scene->store, &out->ground, &options, entries, &error), &error);
    size_t count = 0;
    for (uint32_t b = 0; b < scene->count; b++)
        out->pairs[count++] = (struct pair){BODIES, b};
    for (uint32_t a = 0; a < BODIES; a++)
        for (uint32_t b = 0; b < scene->count; b++)
            if (boxes[a].min_x <= entries[b].max_x && entries[b].min_x <= boxes[a].max_x &&
                boxes[a].min_y <= entries[b].max_y && entries[b].min_y <= boxes[a].max_y)
                out->pairs[count++] = (struct pair){a, b};
    out->list = (narc_pairs){
        .count = count, .a = NARC_COLUMN(out->pairs, a), .b = NARC_COLUMN(out->pairs, b), .other_bodies = &out->ground};
}

/* The documented bound of a separation's error, with the entry's extent, closure and all. */
static double entry_bound(const struct setting *setting, const struct reference_body *body, uint32_t b) {
    narc_arc arcs[NARC_MAX_ARCS];
    const narc_chain_entry *entry = &setting->scene->entries[b];
    const size_t count = narc_get_arcs(setting->scene->store, entry->shape, arcs);
    double extent = 0;
    for (size_t k = 0; k < count; k++)
        extent = fmax(extent, hypot(arcs[k].center_x, arcs[k].center_y) + fabs(arcs[k].radius));
    return NARC_ERROR_BOUND * (hypot(body->x - entry->x, body->y - entry->y) + extent + reference_extent(body));
}

static struct told read_row(const struct setting *setting, const struct reference_body *body, uint32_t entry,
                            const narc_manifold *row) {
    const size_t deepest = row->count > 1 && row->point[1].separation < row->point[0].separation;
    const narc_manifold_point *point = &row->point[deepest];
    const narc_point normal = rotate_to_ground(setting->scene, (double)row->normal_x, (double)row->normal_y);
    const narc_point offset = rotate_to_ground(setting->scene, (double)point->x, (double)point->y);
    const double half = (double)point->separation / 2;
    const narc_manifold_point *second = &row->point[row->count > 1 ? 1 - deepest : deepest];
    const narc_point second_offset = rotate_to_ground(setting->scene, (double)second->x, (double)second->y);
    const double second_half = (double)second->separation / 2;
    struct told told = {.normal_x = -normal.x, .normal_y = -normal.y, .separation = 2 * half, .run = GROUND_CONCAVE};
    told.at = (narc_point){body->x + offset.x - half * normal.x, body->y + offset.y - half * normal.y};
    told.foot = (narc_point){body->x + offset.x + half * normal.x, body->y + offset.y + half * normal.y};
    told.other = (narc_point){body->x + second_offset.x - second_half * normal.x,
                              body->y + second_offset.y - second_half * normal.y};
    told.other_separation = 2 * second_half;
    told.bound = entry_bound(setting, body, entry);
    told.entry = entry;
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
    return chain->closed ? INFINITY
                         : fmin(distance_between(chain_point(first, first->start), point),
                                distance_between(chain_point(last, last->end), point));
}

/* How far it is to the end of an arc. */
static double find_arc_end_distance(const narc_arc *arc, narc_point point) {
    return fmin(distance_between(chain_point(arc, arc->start), point),
                distance_between(chain_point(arc, arc->end), point));
}

/* Does a point lie where two pieces meet? Seams reach beyond that: arcs by 1e-4 rad, edges by 2^-16 of their length. */
static bool is_at_seam(const struct chain *chain, narc_point point, double bound) {
    for (const narc_arc *arc = chain->arcs; arc < chain->arcs + chain->count; arc++)
        if (find_arc_end_distance(arc, point) < 4 * bound + 1.1e-4 * (1 + fabs(arc->radius)))
            return true;
    return false;
}

/* Does a point of the chain lie in a body? */
static bool holds(const struct reference_body *body, narc_point point) {
    const double x = (point.x - body->x) / body->scale, y = (point.y - body->y) / body->scale;
    return narc_contains_point(body->arcs, body->count,
                               &(narc_point){body->cosine * x + body->sine * y, body->cosine * y - body->sine * x});
}

/* Is a place right where a concave arc begins or ends, so near that what is `depth` deep below it belongs to neither side for
 * certain, and is that more than a fifth of the arc's radius? */
static bool is_deep_beside_arc(const struct chain *chain, narc_point foot, double depth, double bound) {
    for (const narc_arc *arc = chain->arcs; arc < chain->arcs + chain->count; arc++)
        if (arc->radius < 0 && depth > -arc->radius / 5 &&
            find_arc_end_distance(arc, foot) <= 0x1p-10 * depth + 4 * bound)
            return true;
    return false;
}

/* Is the ground's outline there out of a body's reach, as docs/terrain.md has it: outside the body, which is deeper, by
 * `deepest`, than its inscribed circle is wide, or than the ground is thick there; outside its bounding circle; right beside a
 * concave arc that is small beside the depth; or no further from an open end than deep, or does the body have one within:
 * there the ground has no other side? */
static bool is_beyond(const struct setting *setting, const struct reference_body *body,
                      const struct ground_minimum *minimum, double deepest, double bound) {
    const struct chain *const chain = &setting->scene->chain;
    const narc_arc *first = chain->arcs, *last = &chain->arcs[chain->count - 1];
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
    if (find_end_distance(chain, minimum->foot.at) <= depth ||
        is_deep_beside_arc(chain, minimum->foot.at, depth, bound))
        return true;
    narc_compute_inscribed_circle(body->arcs, body->count, &inner);
    const double promised = 0.98 * fmin(2 * inner.radius * body->scale, minimum->foot.thickness);
    return (deepest > promised && !holds(body, minimum->foot.at)) ||
           (!chain->closed &&
            (holds(body, chain_point(first, first->start)) || holds(body, chain_point(last, last->end))));
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
    if (!(lowest >= -8 * told->bound) && !(is_touch && is_at_seam(&setting->scene->chain, told->foot, told->bound)))
        return "not the lowest point along the normal";
    /* A point above the foot has that foot, or one below, at the bottom of a valley. Seams extend arcs by 1e-4 rad. Where
     * points coincide the normal is any. */
    if (is_touch)
        return NULL;
    for (int side = -1; side <= 1; side += 2) {
        const double height = 1e-3 * size * side;
        const narc_point beside = {told->foot.x + height * told->normal_x, told->foot.y + height * told->normal_y};
        struct ground_foot feet[FEET];
        const size_t count = ground_feet(setting->scene->ground, beside, feet, FEET);
        for (size_t k = 0; k < count; k++)
            if (fabs(feet[k].distance - height) <= 4 * told->bound &&
                distance_between(feet[k].at, told->foot) <= 4 * told->bound + 1e-3 * size) {
                told->run = feet[k].run;
                return NULL;
            }
    }
    return find_end_distance(&setting->scene->chain, told->foot) <= 8 * told->slide ? NULL : "foot not on the ground";
}

/* Of a disc with its centre next to that of a concave arc the separation alone is promised. */
static const char *check_centred(const struct setting *setting, const struct reference_body *body,
                                 const struct told *told) {
    const struct ground_scene *const scene = setting->scene;
    const narc_arc *arc = &scene->chain.arcs[scene->entries[told->entry].first_arc], *own = &body->arcs[0];
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
    const struct chain *const chain = &setting->scene->chain;
    enum { FEET = 64 };
    struct ground_foot feet[FEET];
    const size_t count = ground_feet(setting->scene->ground, point, feet, FEET);
    double other = INFINITY;
    for (size_t k = count; k-- > 1;)
        if (hypot(feet[k].normal_x - feet[0].normal_x, feet[k].normal_y - feet[0].normal_y) > 1e-3)
            other = fabs(feet[k].distance);
    for (const narc_arc *arc = chain->arcs; arc < chain->arcs + chain->count; arc++)
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
                           size_t count, double fineness, struct counts *counts) {
    struct ground_search *search =
        search_ground(setting->scene->ground, body, setting->margin + 0.01,
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
    enum fate fate[MOST_TOLD];

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
        const double nearest = ground_distance(setting->scene->ground, told[i].at).distance;
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
            counts->worst = fmax(counts->worst, error / told[i].bound);
        }
        if (fate[i] == FATE_WRONG && told[i].separation < 0 && fabs(nearest) < fabs(told[i].separation) - told[i].bound)
            fate[i] = FATE_DEEP; /* something else is nearer: beyond reach */
        if (fate[i] == FATE_WRONG && told[i].separation >= 0 && nearest < told[i].separation - told[i].bound)
            fate[i] = FATE_NEARER; /* of a valley the other side */
        if (fate[i] == FATE_WRONG && !isfinite(nearest))
            fate[i] = FATE_DEEP; /* an open end is nearer */
        const double reach = fmin(2e-4 * size, find_realm(setting, told[i].at));
        if (fate[i] == FATE_WRONG && (ground_least(search, along, reach) >= nearest - 4 * bound ||
                                      is_at_seam(&setting->scene->chain, told[i].foot, told[i].bound)))
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
        counts->of[MINIMUM] += matched;
        counts->of[BEYOND] += beyond;
        counts->of[OVERRULED] += overruled;
        counts->of[SUNK] += sunk;
        counts->of[SHALLOW] += shallow;
        for (size_t i = 0; i < count; i++) {
            counts->of[ROW] += fate[i] == FATE_MATCHED;
            counts->of[DEEP] += fate[i] == FATE_DEEP;
            counts->of[NEARER] += fate[i] == FATE_NEARER;
            counts->of[TOUCHING] += fate[i] == FATE_SHALLOW;
        }
    }
    if (wrong && fineness > 1 && getenv("NARC_TEST_SHOW")) {
        for (size_t m = 0; m < minimum_count; m++)
            print_error("  minimum %.9g at (%.9g, %.9g), normal (%.6g, %.6g), depth %.3g%s, told %zu times\n",
                        minima[m].foot.distance, minima[m].at.x, minima[m].at.y, minima[m].foot.normal_x,
                        minima[m].foot.normal_y, minima[m].depth, minima[m].doubtful ? ", doubtful" : "", told_by[m]);
        for (size_t i = 0; i < count; i++)
            print_error(
                "  row %.9g at (%.9g, %.9g), normal (%.6g, %.6g), bound %.3g, entry %u, %u points, feature %04x\n",
                told[i].separation, told[i].at.x, told[i].at.y, told[i].normal_x, told[i].normal_y, told[i].bound,
                told[i].entry, told[i].count, told[i].feature);
    }
    destroy_search(search);
    return wrong;
}

static void print_arcs(const char *name, const narc_arc *arcs, size_t count) {
    for (size_t i = 0; i < count; i++)
        print_error("  %s {%.17g, %.17g, %.17g, %.17g, %.17g},\n", name, arcs[i].center_x, arcs[i].center_y,
                    arcs[i].radius, arcs[i].start, arcs[i].end);
}

static void print_failure(const struct setting *setting, const struct reference_body *body) {
    const struct chain *const chain = &setting->scene->chain;
    print_error("  at %.17g %.17g turned %.17g %.17g scale %.17g\n", body->x, body->y, body->cosine, body->sine,
                body->scale);
    print_arcs("body", body->arcs, body->count);
    print_error("  closed %d weld %.17g\n", chain->closed, setting->weld);
    print_arcs("chain", chain->arcs, chain->count);
}

/* Nothing tells of a body in the air that it touches the ground; and of one that does, casts begin with that. (At an open
 * end rounding decides.) */
static const char *check_air(const struct setting *setting, const struct reference_body *body, bool is_told,
                             bool is_cast, const struct told *deepest, struct counts *counts) {
    const struct ground_clearance clearance = ground_find_clearance(setting->scene->ground, body);
    const struct chain *const chain = &setting->scene->chain;
    const double room = 1e-5 * (1 + hypot(body->x, body->y) + reference_extent(body));
    counts->of[MET] += !(clearance.distance > 0);
    if (!(clearance.distance > 0) && deepest && deepest->separation < -room && chain->closed && !is_cast &&
        !is_deep_beside_arc(chain, deepest->foot, -deepest->separation, deepest->bound)) {
        counts->of[UNMET]++;
        return "no cast begins with it";
    }
    if (!clearance.in_air || clearance.distance < room)
        return NULL;
    counts->of[IN_AIR]++;
    counts->of[TOLD] += is_told || is_cast;
    return is_told || is_cast ? "told of in the air" : NULL;
}

static void check_setting(const struct setting *setting, struct counts *counts) {
    static struct near_pairs near;
    static struct told told[MOST_TOLD];
    const struct ground_scene *const scene = setting->scene;
    bool is_told[MOVERS] = {false}, is_cast[MOVERS] = {false};
    float motion[MOVERS];
    for (size_t k = 0; k < MOVERS; k++)
        motion[k] = (float)(k % 16) / 64 - 0.1f;
    find_near_pairs(setting, &near);
    const narc_motions motions = {.x = NARC_ARRAY(motion), .y = {&motion[5], 0}};
    AUTO(free_at)
    const struct ground_answers answers =
        ask_ground(scene, &near.movers, &motions, &near.list, (narc_query){.margin = (float)setting->margin});
    for (size_t k = 0; k < near.list.count; k++) {
        is_told[near.pairs[k].a] |= bit_is_set(answers.bits, k);
        is_cast[near.pairs[k].a] |= answers.impacts[k].count == NARC_CAST_HIT && answers.impacts[k].fraction == 0;
    }
    narc_manifold *const rows = answers.manifolds;
    const size_t count = narc_merge_rows(
        &(narc_merging){&near.list, NARC_ARRAY(scene->runs), scene->store, &near.ground, .manifolds = rows},
        answers.counts[1]);
    size_t row = 0;
    for (size_t k = 0; k < BODIES; k++) {
        const struct reference_body body = pose_on_ground(scene, &setting->shapes[k % SHAPES], &setting->bodies[k]);
        size_t of_body = 0;
        const struct told *deepest = NULL;
        for (; row < count && near.pairs[rows[row].pair].a == k; row++) {
            assert_true(of_body < MOST_TOLD);
            told[of_body] = read_row(setting, &body, near.pairs[rows[row].pair].b, &rows[row]);
            if (!deepest || told[of_body].separation < deepest->separation)
                deepest = &told[of_body];
            of_body++;
        }
        counts->of[BODY]++;
        const char *wrong = check_air(setting, &body, is_told[k], is_cast[k], deepest, counts);
        if (!wrong && compare(setting, &body, told, of_body, 1, counts))
            wrong = compare(setting, &body, told, of_body, finer, counts);
        if (wrong && (counts->of[WRONG]++ < SHOWN || getenv("NARC_TEST_SHOW"))) {
            if (getenv("NARC_TEST_SHOW"))
                print_failure(setting, &body);
            print_error("%s: %s; margin %.9g, body of %zu arcs at (%a, %a)\n", setting->kind->name, wrong,
                        setting->margin, body.count, body.x, body.y);
        }
    }
    assert_int_equal(row, count); /* none of what is far away */
}

static void check_kind(const struct kind *kind) {
    static struct setting setting;
    char name[64];
    snprintf(name, sizeof name, "ground, %s", kind->name);
    struct test_random random = test_random_named(name);
    struct counts counts = {.worst = 0};
    const size_t trials = kind->make_chain              ? 3
                          : kind->family == CHAIN_TIGHT ? 30
                                                        : 10; /* bodies of nearly the radius are few */
    for (size_t trial = test_trials(trials); trial > 0; trial--)
        if (make_setting(&random, kind, &setting)) {
            check_setting(&setting, &counts);
            destroy_ground_scene(setting.scene);
        } else {
            counts.of[REFUSED]++;
        }
    printf("  %s:", kind->name);
    for (int k = 0; k < WHATS; k++)
        printf(" %zu %s", counts.of[k], what_names[k]);
    printf("; largest error %.3f\n", counts.worst);
    assert_int_equal(counts.of[WRONG], 0);
    assert_true(kind->make_chain || counts.of[BODY] < 10 * BODIES || counts.of[MINIMUM] > counts.of[BODY] / 5);
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

/* Half a turn of four to twelve sides around (0, 0), 4 away and thin. */
static struct chain make_arch(struct test_random *random) {
    enum { MOST = 12 };
    const size_t sides = random_below(random, 2) ? 8 : 4 + random_below(random, MOST - 3), count = 2 * sides + 2;
    const double thickness = random_below(random, 2) ? 0.02 : random_log_between(random, 0.02, 0.2);
    narc_point point[2 * MOST + 2];
    for (size_t k = 0; k <= sides; k++) {
        const double angle = PI * (double)k / (double)sides, inner = 4 - thickness / cos(PI / (double)sides / 2);
        point[k] = (narc_point){4 * cos(angle), 4 * sin(angle)};
        point[count - 1 - k] = (narc_point){inner * cos(angle), inner * sin(angle)};
    }
    return fold_chain(point, count);
}

static struct shape choose_box(struct test_random *random) {
    static const double forms[][3] = {{1, 1, 0}, {3, 0.3, 0}, {1.5, 2.3, 0}, {1.26, 0.0126, 0}, {1.57, 0.47, 0.12}};
    const double *form = forms[random_below(random, sizeof forms / sizeof *forms)];
    return box_of(form[0], form[1], form[2]);
}

/* Up to 0.05 above. */
static struct body place_close(struct test_random *random, const struct setting *setting, const struct shape *shape) {
    return approach_chain(random, &setting->scene->chain, setting->scene->ground, shape,
                          random_log_between(random, 1e-3, 0.05));
}

TEST(test_boxes_above_an_arch) {
    check_kind(&(struct kind){"boxes above an arch", CHAIN_ARCH, make_arch, choose_box, place_close});
}

/* A sheet that is bent once, with the ridge at (0, 0); to both sides it falls away by the same angle. */
static struct chain make_roof(struct test_random *random) {
    const double fall = random_below(random, 4) ? random_between(random, 0.1, 1.2) : atan(1. / 3);
    const double thickness = random_log_between(random, 0.02, 0.3), half = random_between(random, 2, 4);
    const double x = half * cos(fall), y = -half * sin(fall), low = thickness / cos(fall);
    return fold_chain((const narc_point[]){{0, 0}, {-x, y}, {-x, y - low}, {0, -low}, {x, y - low}, {x, y}}, 6);
}

static struct shape choose_plank(struct test_random *random) {
    return random_below(random, 2) ? box_of(3, 0.3, 0) : box_of(2, 0.3, 0);
}

/* Up to 0.1 above the ridge, level or not, with its middle or what is beside that. */
static struct body place_on_ridge(struct test_random *random, const struct setting *setting,
                                  const struct shape *shape) {
    const double fall = setting->scene->chain.arcs[0].end - PI / 2;
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
static struct chain make_ledge(struct test_random *random) {
    static const double thicknesses[] = {0.02, 0.05, 0.05, 0.1, 0.3};
    const double thickness = thicknesses[random_below(random, 5)], radius = random_below(random, 2) ? thickness / 2 : 0;
    struct turtle t = create_turtle(5, thickness, PI / 2);
    for (int k = 0; k < 2; k++) {
        walk_line(&t, 10);
        walk_arc(&t, radius, radius > 0 ? PI : PI / 2);
        if (radius > 0)
            continue;
        walk_line(&t, thickness);
        walk_arc(&t, 0, PI / 2);
    }
    return end_walk(&t, true);
}

static struct shape choose_sharp(struct test_random *random) {
    const narc_four_arc lens = {1, 1, 1.4, 0, 0};
    const size_t kind = random_below(random, 8);
    struct shape shape;
    narc_status status = NARC_OK;
    if (kind == 0)
        return box_of(1, random_below(random, 2) ? 0.5 : 1, 0);
    if (kind == 1)
        status = narc_build_four_arc(&lens, shape.arcs, &shape.count, NULL);
    else
        status =
            narc_build_regular_polygon(kind == 2 ? 5 : 3, 0.6, kind == 3 ? 0.1 : 0, shape.arcs, &shape.count, NULL);
    assert_int_equal(status, NARC_OK);
    return shape;
}

/* Anywhere about the right end. */
static struct body place_about_end(struct test_random *random, __attribute__((unused)) const struct setting *setting,
                                   __attribute__((unused)) const struct shape *shape) {
    struct body body = turned_body(random_between(random, -PI, PI), 1);
    body.x = 5 + random_between(random, -0.8, 0.8);
    body.y = random_between(random, -0.8, 1.2);
    return body;
}

TEST(test_triangles_round_an_end) {
    check_kind(&(struct kind){"triangles round an end", CHAIN_SLAB, make_ledge, choose_sharp, place_about_end});
}

/* Ten long, one thick. */
static struct chain make_slab(__attribute__((unused)) struct test_random *random) {
    return fold_chain((const narc_point[]){{-5, -1}, {5, -1}, {5, 0}, {-5, 0}}, 4);
}

static struct shape choose_flat(struct test_random *random) {
    const size_t kind = random_below(random, 3);
    return kind == 0 ? box_of(1, 1, 0) : kind == 1 ? capsule_of(1, 0.5) : circle_of(0.5);
}

/* An edge, or where a circle begins, along the top but for what rounding makes of it. */
static struct body place_flat(struct test_random *random, __attribute__((unused)) const struct setting *setting,
                              const struct shape *shape) {
    const double tilt = (double)random_below(random, 2) * random_log_between(random, 1e-9, 1e-5);
    struct body body = turned_body(-PI / 2 - shape->arcs[0].start + (random_below(random, 2) ? tilt : -tilt), 1);
    body.x = random_between(random, -4, 4);
    body.y = 0.5 - random_log_between(random, 1e-4, 0.1);
    return body;
}

TEST(test_boxes_flat_on_a_slab) {
    check_kind(&(struct kind){"boxes flat on a slab", CHAIN_SLAB, make_slab, choose_flat, place_flat});
}

/* A gate from x = -1 to 1: the level line above goes over into an arc on both sides. */
static struct chain make_gate(struct test_random *random) {
    const double radius = random_between(random, 0.1, 0.8), height = random_between(random, 1, 3);
    struct turtle t = create_turtle(-3, 0, -PI / 2);
    walk_line(&t, 2);
    walk_arc(&t, 0, PI / 2);
    walk_line(&t, height - radius);
    walk_arc(&t, radius, -PI / 2);
    walk_line(&t, 2 - 2 * radius);
    walk_arc(&t, radius, -PI / 2);
    walk_line(&t, height - radius);
    walk_arc(&t, 0, PI / 2);
    for (int k = 0; k < 4; k++) {
        walk_line(&t, k == 0 ? 2 : k == 2 ? 6 : height + 1);
        walk_arc(&t, 0, PI / 2);
    }
    return end_walk(&t, true);
}

static struct shape choose_needle(struct test_random *random) {
    const double length = random_log_between(random, 0.05, 0.5);
    return random_below(random, 2) ? box_of(length, length / 100, 0) : capsule_of(length, length / 15);
}

/* Upright below the place where line and arc meet, or along the tangent there. */
static struct body place_below_joint(struct test_random *random, const struct setting *setting,
                                     const struct shape *shape) {
    const narc_arc *arc = &setting->scene->chain.arcs[1], *own = &shape->arcs[0];
    const bool is_upright = random_below(random, 2);
    const double width = own->center_y + own->radius, length = own->center_x + own->radius;
    struct body body = turned_body(is_upright ? PI / 2 : 0, 1);
    const double gap = (double)random_below(random, 3) * random_log_between(random, 1e-9, 1e-2) * length;
    body.x = arc->center_x + ((double)random_below(random, 3) - 1) * (is_upright ? width : length);
    body.y = arc->center_y - arc->radius - (is_upright ? length : width) - gap;
    return body;
}

TEST(test_needles_below_a_joint) {
    check_kind(&(struct kind){"needles below a joint", CHAIN_CUP, make_gate, choose_needle, place_below_joint});
}

TEST_MAIN("ground minima")
