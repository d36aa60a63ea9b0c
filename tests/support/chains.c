/* SPDX-License-Identifier: MIT
 *
 * chains.c - random chains, made by walking with the solid on the left, and bodies on them.
 */
#include "chains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "everywhere.h"
#include "expect.h"
#include "merge.h"

/* How steep open chains get: they go from right to left, the air above. */
static const double steepest = 1.1;

/* A turn that keeps the normal between the steepest ones, to the left or to the right. */
static double choose_turn(struct test_random *random, const struct turtle *t, double widest, bool left) {
    const double room = left ? PI / 2 + steepest - t->normal : t->normal - (PI / 2 - steepest);
    const double sweep =
        random_below(random, 4) ? random_between(random, 0.05, widest) : random_log_between(random, 0.02, widest);
    return sweep < room ? sweep : 0;
}

/* One piece, if there is room to turn. */
static void put_piece(struct test_random *random, struct turtle *t, enum chain_family family, double size) {
    if (t->count == 0)
        walk_arc(t, 0, 0); /* an edge needs a beginning */
    const bool left = random_below(random, 2);
    const bool sharp = family == CHAIN_STEPS || (family == CHAIN_MIXED && random_below(random, 2)) ||
                       (family != CHAIN_HILLS && random_below(random, 6) == 0);
    const double turn = choose_turn(random, t, 1.2, left);
    const double radius = sharp ? 0 : size * random_log_between(random, 0.2, 3);
    if (turn > 0)
        walk_arc(t, radius, left ? turn : -turn);
    if (sharp || random_below(random, 3) == 0) {
        size_t edges = random_below(random, 4) ? 1 : 1 + random_below(random, 5);
        walk_line(t, size * random_log_between(random, 0.1, 2));
        while (--edges > 0) {
            walk_arc(t, 0, 0);
            walk_line(t, size * random_log_between(random, 0.1, 2));
        }
        if (turn <= 0)
            walk_arc(t, 0, 0);
    }
}

/* A concave arc in several pieces, perhaps with a flat bottom, between convex arcs or corners. */
static void put_bowl(struct test_random *random, struct turtle *t) {
    const double radius = random_log_between(random, 0.3, 3), down = random_between(random, 0.3, steepest);
    const double rim = random_below(random, 3) ? random_log_between(random, 0.1, 1) : 0;
    const size_t pieces = 1 + random_below(random, 5);
    if (t->normal < PI / 2 + down)
        walk_arc(t, rim, PI / 2 + down - t->normal);
    if (random_below(random, 2) || rim <= 0)
        walk_line(t, random_log_between(random, 0.1, 1));
    const double turn = t->normal - PI / 2;
    for (size_t k = 0; k < pieces; k++)
        walk_arc(t, radius, -turn / (double)pieces);
    if (random_below(random, 2))
        walk_line(t, random_log_between(random, 0.1, 2));
    for (size_t k = 0; k < pieces; k++)
        walk_arc(t, radius, -down / (double)pieces);
}

enum { MOST_CORNERS = 64 };

/* A polygon whose corners are arcs, each with a share of the largest radius that there is room for, but no more than
 * `radius`; no shares: sharp corners. */
static struct chain round_corners(const narc_point *point, size_t corners, const double *share, double radius) {
    narc_arc *const arcs = malloc(corners * sizeof *arcs);
    for (size_t k = 0; k < corners; k++) {
        const narc_point *p = &point[(k + corners - 1) % corners], *q = &point[k], *r = &point[(k + 1) % corners];
        const double before = hypot(q->x - p->x, q->y - p->y), after = hypot(r->x - q->x, r->y - q->y);
        const double heading = atan2(q->y - p->y, q->x - p->x), normal = heading - PI / 2;
        const double turn = remainder(atan2(r->y - q->y, r->x - q->x) - heading, 2 * PI), tangent = tan(fabs(turn) / 2);
        const double most = fmin(before, after) / 2 / tangent,
                     own = copysign(share ? fmin(share[k] * most, radius) : 0, turn);
        const narc_point from = {q->x - fabs(own) * tangent * cos(heading), q->y - fabs(own) * tangent * sin(heading)};
        arcs[k] = (narc_arc){from.x - own * cos(normal), from.y - own * sin(normal), own, normal, normal + turn};
    }
    return (struct chain){arcs, corners, true};
}

struct chain fold_chain(const narc_point *point, size_t count) {
    return round_corners(point, count, NULL, 0);
}

/* A polygon around the origin whose corners are arcs: convex ones and concave ones. */
static struct chain make_closed(struct test_random *random) {
    enum { MOST = 24 };
    const size_t corners = 3 + random_below(random, MOST - 2);
    const bool convex = random_below(random, 4) == 0;
    narc_point point[MOST];
    double share[MOST];
    for (size_t k = 0; k < corners; k++) {
        const double angle = 2 * PI * ((double)k + random_between(random, -0.2, 0.2)) / (double)corners;
        const double radius = convex ? 2 : random_between(random, 1.2, 2.6);
        point[k] = (narc_point){radius * cos(angle), radius * sin(angle)};
        share[k] = random_below(random, 4) ? random_between(random, 0.05, 0.99) : 0;
    }
    const struct chain chain = round_corners(point, corners, share, INFINITY);
    for (size_t k = 0; k < corners; k++)
        if (fabs(chain.arcs[k].end - chain.arcs[k].start) < 1e-2) {
            free(chain.arcs);
            return make_closed(random);
        }
    return chain;
}

/* ------------------------------------------------------------------------------------------------ what is thin */

/* The middle of a sheet: sides and the turn after each, the last one's counts for nothing. */
struct sheet {
    double side[MOST_CORNERS], turn[MOST_CORNERS];
    size_t count;
    double thickness;
};

/* A sheet whose bends are arcs around one centre on both faces, and whose ends are flat or round. Thickness and radius
 * are counted from the middle. */
static struct chain bend_sheet(const struct sheet *sheet, double radius, bool round_ends) {
    struct turtle t = create_turtle(0, 0, -PI / 2);
    const double half = sheet->thickness / 2;
    for (int face = 0; face < 2; face++) {
        const double sign = face ? -1 : 1;
        for (size_t i = 0; i < sheet->count; i++) {
            const size_t k = face ? sheet->count - 1 - i : i;
            const double first = k > 0 ? tan(fabs(sheet->turn[k - 1]) / 2) : 0,
                         second = k + 1 < sheet->count ? tan(fabs(sheet->turn[k]) / 2) : 0;
            walk_line(&t, fmax(0.05, sheet->side[k] - radius * (first + second)));
            if (i + 1 < sheet->count) {
                const double turn = sign * sheet->turn[face ? k - 1 : k];
                walk_arc(&t, turn > 0 ? radius + half : radius - half, turn);
            }
        }
        walk_arc(&t, round_ends ? half : 0, round_ends ? PI : PI / 2);
        if (!round_ends) {
            walk_line(&t, sheet->thickness);
            walk_arc(&t, 0, PI / 2);
        }
    }
    return end_walk(&t, true);
}

/* The same with corners, of which all or some are rounded a little, or none. */
static struct chain fold_sheet(struct test_random *random, const struct sheet *sheet) {
    narc_point point[2 * MOST_CORNERS + 2], at = {0, 0};
    double share[2 * MOST_CORNERS + 2], heading = 0;
    const size_t corners = 2 * sheet->count + 2, kind = random_below(random, 3);
    for (size_t k = 0; k <= sheet->count; k++) {
        const double turn = k > 0 && k < sheet->count ? sheet->turn[k - 1] : 0;
        const double half = sheet->thickness / 2 / cos(turn / 2), normal = heading + turn / 2 - PI / 2;
        point[k] = (narc_point){at.x + half * cos(normal), at.y + half * sin(normal)};
        point[corners - 1 - k] = (narc_point){at.x - half * cos(normal), at.y - half * sin(normal)};
        heading += turn;
        at.x += k < sheet->count ? sheet->side[k] * cos(heading) : 0;
        at.y += k < sheet->count ? sheet->side[k] * sin(heading) : 0;
    }
    for (size_t k = 0; k < corners; k++)
        share[k] = kind == 0 || (kind == 1 && random_below(random, 2)) ? 0 : random_between(random, 0.1, 0.9);
    const double radius = sheet->thickness * random_log_between(random, 0.05, 1);
    return round_corners(point, corners, share, radius);
}

/* Walls from right to left, all a little different, on a slab. */
static struct chain make_walls(struct test_random *random, double thickness) {
    const size_t walls = 1 + random_below(random, 4), corners = 4 + 4 * walls;
    narc_point point[MOST_CORNERS];
    double share[MOST_CORNERS], x = 1;
    const bool is_round = random_below(random, 2);
    point[1] = (narc_point){x, -thickness};
    point[2] = (narc_point){x, 0};
    for (size_t k = 3; k + 1 < corners; k += 4) {
        const double right = x - random_between(random, 0.7, 2), height = random_between(random, 0.3, 3),
                     left = right - thickness * random_between(random, 0.9, 1.1),
                     lean = random_between(random, -0.3, 0.3);
        point[k] = (narc_point){right, 0};
        point[k + 1] = (narc_point){right + lean, height};
        point[k + 2] = (narc_point){left + lean, height};
        point[k + 3] = (narc_point){left, 0};
        x = left;
    }
    x -= random_between(random, 0.3, 2);
    point[0] = (narc_point){x, -thickness};
    point[corners - 1] = (narc_point){x, 0};
    for (size_t k = 0; k < corners; k++)
        share[k] = is_round && random_below(random, 4) ? random_between(random, 0.1, 0.9) : 0;
    return round_corners(point, corners, share, thickness * random_log_between(random, 0.05, 1));
}

/* What is thin may cross itself: the store refuses that. */
static struct chain make_thin(struct test_random *random, enum chain_family family) {
    struct sheet sheet = {.count = 1, .thickness = random_log_between(random, 0.02, random_below(random, 2) ? 1 : 0.1)};
    const bool both_ways = family == CHAIN_ZIGZAG || family == CHAIN_SHEET;
    const double whole = family == CHAIN_PIPE ? random_between(random, 4.5, 6) : random_between(random, 0.5, 3.5);
    const double sign = random_below(random, 2) ? 1 : -1, side = random_log_between(random, 0.5, 2);
    if (family == CHAIN_WALLS)
        return make_walls(random, sheet.thickness);
    if (family == CHAIN_GEAR) {
        struct turtle t = walk_gear(5 + random_below(random, 20), random_between(random, 0.1, 0.5));
        return end_walk(&t, true);
    }
    if (family == CHAIN_ANGLE || family == CHAIN_CUP)
        sheet.count = family == CHAIN_ANGLE ? 2 : 3;
    else if (family != CHAIN_SLAB)
        sheet.count = (family == CHAIN_PIPE ? 8 : 3) + random_below(random, 12);
    const double bend = random_between(random, 0.3, 2.2);
    for (size_t k = 0; k < sheet.count; k++) {
        const bool is_even = family == CHAIN_ARCH || family == CHAIN_PIPE;
        sheet.side[k] = side * (family == CHAIN_SLAB ? 3 : 1) * (is_even ? 1 : random_between(random, 0.5, 1.5));
        sheet.turn[k] = sign * (is_even               ? whole / (double)(sheet.count - 1)
                                : both_ways           ? bend * (k % 2 ? -1 : 1)
                                : family == CHAIN_CUP ? random_between(random, 1, 1.9)
                                                      : bend);
    }
    if (family == CHAIN_SHEET || (family != CHAIN_ZIGZAG && random_below(random, 3) == 0))
        return bend_sheet(&sheet, sheet.thickness / 2 * (1 + random_log_between(random, 0.01, 3)),
                          random_below(random, 2));
    return fold_sheet(random, &sheet);
}

static struct chain make_open(struct test_random *random, enum chain_family family) {
    struct turtle t = create_turtle(0, 0, PI / 2 + random_between(random, -0.5, 0.5));
    const bool capped = family == CHAIN_ENDS ? random_below(random, 2) : false;
    const size_t pieces = family == CHAIN_LONG   ? 60 + random_below(random, 90)
                          : family == CHAIN_FINE ? 30 + random_below(random, 40)
                          : family == CHAIN_ENDS ? 1 + random_below(random, 4)
                                                 : 4 + random_below(random, 12);
    if (capped) {
        t.normal -= PI / 2;
        walk_arc(&t, 0, PI / 2);
        walk_line(&t, random_log_between(random, 0.1, 2));
    } else if (random_below(random, 2)) {
        walk_arc(&t, 0, 0);
        walk_line(&t, random_log_between(random, 0.1, 2));
    } else {
        walk_arc(&t, 0.5, (random_below(random, 2) ? 1 : -1) * random_between(random, 0.05, 0.4));
    }
    const size_t begun = t.count;
    for (size_t k = 0; k < pieces && t.count < CHAIN_ARCS - 16; k++) {
        const double size = family == CHAIN_LONG   ? random_log_between(random, 3e-3, 3)
                            : family == CHAIN_FINE ? random_log_between(random, 0.02, 0.2)
                                                   : 1;
        if (family == CHAIN_BOWLS || (family == CHAIN_TIGHT && random_below(random, 2)))
            put_bowl(random, &t);
        else
            put_piece(random, &t, family, size);
    }
    if (t.count == begun)
        walk_arc(&t, 0.5, 0.5);
    if (capped) {
        walk_arc(&t, 0, PI / 2);
    } else if (random_below(random, 2)) {
        walk_line(&t, random_log_between(random, 0.1, 2));
        walk_arc(&t, 0, 0);
    }
    return end_walk(&t, false);
}

const char *chain_family_name(enum chain_family family) {
    static const char *const names[CHAIN_FAMILIES] = {"hills", "mixed",  "bowls", "tight", "fine",  "steps",
                                                      "long",  "closed", "ends",  "slab",  "arch",  "zigzag",
                                                      "sheet", "angle",  "cup",   "pipe",  "walls", "gear"};
    return names[family];
}

struct chain make_chain(struct test_random *random, enum chain_family family) {
    for (;;) {
        const struct chain chain = family >= CHAIN_SLAB     ? make_thin(random, family)
                                   : family == CHAIN_CLOSED ? make_closed(random)
                                                            : make_open(random, family);
        if (chain.count >= 2)
            return chain;
        free(chain.arcs);
    }
}

/* ------------------------------------------------------------------------------------------------ riders */

struct shape regular_of(size_t corners, double size, double radius) {
    struct shape shape;
    assert_int_equal(narc_build_regular_polygon(corners, size, radius, shape.arcs, &shape.count, NULL), NARC_OK);
    return shape;
}

void scale_arcs(narc_arc *arcs, size_t count, double factor) {
    for (size_t k = 0; k < count; k++) {
        arcs[k].center_x *= factor;
        arcs[k].center_y *= factor;
        arcs[k].radius *= factor;
    }
}

static struct shape ellipse_of(double half_x, double half_y, size_t arcs) {
    struct shape shape;
    if (narc_build_ellipse(half_x, half_y, arcs, shape.arcs, &shape.count, NULL, NULL) != NARC_OK)
        return circle_of(half_x);
    return shape;
}

static double concave_radius(struct test_random *random, const struct chain *chain) {
    for (size_t tries = 0; tries < 100; tries++) {
        const double radius = chain->arcs[random_below(random, chain->count)].radius;
        if (radius < -1e-2)
            return -radius;
    }
    return 1;
}

double chain_side(const struct chain *chain) {
    double length = 0, pieces = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k], *before = k ? arc - 1 : &chain->arcs[chain->count - 1];
        const narc_point from = chain_point(before, before->end), to = chain_point(arc, arc->start);
        const double line = k || chain->closed ? hypot(to.x - from.x, to.y - from.y) : 0;
        const double own = fabs(arc->radius * (arc->end - arc->start));
        length += line + own;
        pieces += (line > 1e-9) + (own > 1e-9);
    }
    return length / pieces;
}

/* Next to a concave arc's radius. */
static struct shape make_tight(struct test_random *random, const struct chain *chain) {
    const double size = concave_radius(random, chain) *
                        (1 + (random_below(random, 4) ? -1 : 1) * random_log_between(random, 1e-6, 0.3));
    switch (random_below(random, 4)) {
    case 0:
        return ellipse_of(size, size * random_between(random, 0.7, 1), 8);
    case 1:
        return box_of(2.5 * size, 2.2 * size, size);
    default:
        return circle_of(size);
    }
}

/* Beside thin ground as large as a tenth of its sides to ten times that, and needles and tips, too. */
struct shape make_rider(struct test_random *random, const struct chain *chain, enum chain_family family) {
    const bool thin = family >= CHAIN_SLAB;
    const double size =
        thin ? chain_side(chain) * random_log_between(random, 0.05, 5) : random_log_between(random, 0.1, 2);
    struct shape shape;
    if (family == CHAIN_TIGHT && random_below(random, 4))
        return make_tight(random, chain);
    const size_t kind = random_below(random, 8);
    switch (kind) {
    case 0:
        return circle_of(size);
    case 1:
        return box_of(2 * size, 2 * size * random_log_between(random, 0.1, 1), 0);
    case 2:
        return box_of(2 * size, size, size * random_between(random, 0.01, 0.4));
    case 3:
        return capsule_of((thin ? 2 : 1) * size, size * random_log_between(random, thin ? 0.05 : 0.1, 1));
    case 4:
        if (!thin)
            return ellipse_of(size, size * random_between(random, 0.3, 1), 4 + 4 * random_below(random, 4));
        return random_below(random, 2) ? box_of(2 * size, 0.04 * size, 0) : capsule_of(2 * size, 0.02 * size);
    default:
        if (thin && kind == 5)
            return regular_of(3, size, random_below(random, 2) ? 0 : 0.1 * size);
        shape = make_shape(random, thin && kind == 6 ? FAMILY_LENS : (enum family)random_below(random, FAMILY_SEGMENT));
    }
    if (thin)
        scale_arcs(shape.arcs, shape.count, size);
    return shape;
}

/* A place on the chain and an outward normal there: mostly the end of an arc, exactly or nearly. */
static narc_point choose_place(struct test_random *random, const struct chain *chain, double *out_angle) {
    const size_t k = random_below(random, chain->count);
    const narc_arc *arc = &chain->arcs[k];
    double part = random_unit(random);
    if (random_below(random, 2))
        part = (double)random_below(random, 2) +
               ((double)random_below(random, 3) - 1) * random_log_between(random, 1e-9, 1e-3);
    *out_angle = arc->start + (arc->end - arc->start) * part;
    narc_point place = chain_point(arc, *out_angle);
    if ((k || chain->closed) && random_below(random, 3) == 0) {
        const narc_arc *before = k ? arc - 1 : &chain->arcs[chain->count - 1];
        const narc_point from = chain_point(before, arc->start), to = chain_point(arc, arc->start);
        const double t = random_unit(random);
        *out_angle = arc->start;
        place = (narc_point){(1 - t) * from.x + t * to.x, (1 - t) * from.y + t * to.y};
    }
    return place;
}

struct body ride_chain(struct test_random *random, const struct chain *chain, const struct shape *shape,
                       double margin) {
    double normal;
    const narc_point place = choose_place(random, chain, &normal);
    /* The body's normal that meets it: one of its junctions, exactly or nearly, or any. */
    const narc_arc *arc = &shape->arcs[random_below(random, shape->count)];
    double own = random_between(random, -PI, PI);
    if (random_below(random, 3))
        own = arc->start;
    if (random_below(random, 4) == 0)
        own += (random_below(random, 2) ? -1 : 1) * random_log_between(random, 1e-8, 1e-2);
    double gap = random_between(random, -margin, margin);
    if (random_below(random, 3) == 0)
        gap = margin * (random_below(random, 2) ? -1 : 1) * random_log_between(random, 1e-7, 1);
    if (random_below(random, 8) == 0)
        gap = -random_between(random, 0, 0.4); /* deep */
    struct body body = turned_body(normal + PI - own, 1);
    const struct reference_body posed = pose_shape(shape, &body);
    const double turned = normal + PI - atan2(posed.sine, posed.cosine);
    narc_point foot;
    narc_find_support(shape->arcs, shape->count, cos(turned), sin(turned), &foot, NULL);
    if (random_below(random, 3) == 0) { /* another point of the shape that is as far */
        const double beside = turned + (random_below(random, 2) ? -1 : 1) * 1e-6;
        narc_find_support(shape->arcs, shape->count, cos(beside), sin(beside), &foot, NULL);
    }
    body.x = place.x + gap * cos(normal) - (posed.cosine * foot.x - posed.sine * foot.y);
    body.y = place.y + gap * sin(normal) - (posed.sine * foot.x + posed.cosine * foot.y);
    round_position(&body, NARC_FLOAT64);
    return body;
}

struct body approach_chain(struct test_random *random, const struct chain *chain, struct ground *ground,
                           const struct shape *shape, double gap) {
    enum { STEPS = 40 };
    double normal;
    const narc_point place = choose_place(random, chain, &normal);
    const struct body still = turned_body(0, 1);
    const struct reference_body unturned = pose_shape(shape, &still);
    const double size = reference_extent(&unturned), least = gap > 0 ? gap : 1e-6 * size;
    /* Turned at random and from anywhere, or an edge along the ground there, and nearly straight down. */
    const bool is_flat = random_below(random, 2);
    const double own =
        is_flat ? normal + PI - shape->arcs[random_below(random, shape->count)].start : random_between(random, -PI, PI);
    const double from =
        is_flat || random_below(random, 2) ? normal + random_between(random, -1, 1) : random_between(random, -PI, PI);
    const double far = random_below(random, 4) ? random_between(random, 0, 2) * size : size + random_unit(random);
    const double way = is_flat                   ? normal + PI
                       : random_below(random, 3) ? from + PI + random_between(random, -0.7, 0.7)
                                                 : random_between(random, -PI, PI);
    struct body body = turned_body(own, 1);
    body.x = place.x + far * cos(from);
    body.y = place.y + far * sin(from);
    double moved = 0;
    for (int k = 0; k < STEPS; k++) {
        const struct reference_body posed = pose_shape(shape, &body);
        const struct ground_clearance clearance = ground_find_clearance(ground, &posed);
        const double step = clearance.distance - least;
        if (!clearance.in_air || step <= 0.1 * least || moved > 4 * size)
            break;
        body.x += step * cos(way);
        body.y += step * sin(way);
        moved += step;
    }
    if (gap < 0 && moved <= 4 * size) {
        body.x -= gap * cos(way);
        body.y -= gap * sin(way);
    }
    round_position(&body, NARC_FLOAT64);
    return body;
}

/* ------------------------------------------------------------------------------------------------ in a store */

struct ground_scene *create_ground_scene(void) {
    struct ground_scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    scene->store = empty_store();
    scene->place = turned_body(0, 1);
    return scene;
}

void destroy_ground_scene(struct ground_scene *scene) {
    if (scene->ground)
        destroy_ground(scene->ground);
    free(scene->chain.arcs);
    narc_destroy_shapes(scene->store);
    free(scene);
}

narc_status add_ground(struct ground_scene *scene, struct chain chain, narc_chain_options options, narc_error *error) {
    size_t found = 0;
    options.closed = chain.closed;
    options.first_run = (uint32_t)scene->count;
    free(scene->chain.arcs);
    scene->chain = chain;
    const narc_status status =
        narc_add_chain(scene->store, chain.arcs, chain.count, &options, &scene->entries[scene->count],
                       GROUND_ENTRIES - scene->count, &found, error);
    for (const size_t end = scene->count + (status == NARC_OK ? found : 0); scene->count < end; scene->count++) {
        const narc_chain_entry *entry = &scene->entries[scene->count];
        const struct body own = {.x = entry->x, .y = entry->y, .cosine = 1, .scale = 1, .shape = entry->shape};
        struct body *body = &scene->bodies[scene->count];
        *body = ground_to_world(scene, own);
        body->cosine = scene->place.cosine;
        body->sine = scene->place.sine;
        scene->runs[scene->count] = entry->run;
    }
    return status;
}

struct ground_scene *lay_ground(struct chain chain, narc_chain_options options) {
    struct ground_scene *scene = create_ground_scene();
    narc_error error = {0};
    expect_ok(add_ground(scene, chain, options, &error), &error);
    return scene;
}

struct ground_scene *lay_random_ground(struct test_random *random, enum chain_family family) {
    for (;;) {
        struct ground_scene *scene = create_ground_scene();
        narc_error error = {0};
        const narc_status status = add_ground(scene, make_chain(random, family), (narc_chain_options){0}, &error);
        if (status == NARC_OK)
            return scene;
        if (status != NARC_ERROR_RADIUS && status != NARC_ERROR_NOT_SIMPLE && status != NARC_ERROR_SIZE)
            fail_msg("%s", error.message);
        destroy_ground_scene(scene);
    }
}

struct ground *ground_of(struct ground_scene *scene) {
    if (!scene->ground)
        scene->ground = make_ground(&scene->chain);
    return scene->ground;
}

static narc_point rotate(const struct body *place, double x, double y) {
    const double length = hypot((double)place->cosine, (double)place->sine);
    const double c = (double)place->cosine / length, s = (double)place->sine / length;
    return (narc_point){c * x - s * y, s * x + c * y};
}

narc_point rotate_to_ground(const struct ground_scene *scene, double x, double y) {
    struct body back = scene->place;
    back.sine = -back.sine;
    return rotate(&back, x, y);
}

struct body ground_to_world(const struct ground_scene *scene, struct body body) {
    const struct body *place = &scene->place;
    const narc_point at = rotate(place, body.x, body.y), axis = rotate(place, (double)body.cosine, (double)body.sine);
    body.x = place->x + at.x;
    body.y = place->y + at.y;
    body.cosine = (float)axis.x;
    body.sine = (float)axis.y;
    round_position(&body, NARC_FLOAT64);
    return body;
}

struct reference_body pose_on_ground(const struct ground_scene *scene, const struct shape *shape,
                                     const struct body *body) {
    const narc_point at = rotate_to_ground(scene, body->x - scene->place.x, body->y - scene->place.y);
    const narc_point axis = rotate_to_ground(scene, (double)body->cosine, (double)body->sine);
    const double length = hypot(axis.x, axis.y);
    return (struct reference_body){shape->arcs,     shape->count,       at.x, at.y, axis.x / length,
                                   axis.y / length, (double)body->scale};
}

narc_bodies view_columns(const struct body *bodies, size_t count) {
    return (narc_bodies){.count = count,
                         .x = NARC_POSITION_COLUMN(bodies, x),
                         .y = NARC_POSITION_COLUMN(bodies, y),
                         .cosine = NARC_COLUMN(bodies, cosine),
                         .sine = NARC_COLUMN(bodies, sine),
                         .scale = NARC_COLUMN(bodies, scale),
                         .shape = NARC_COLUMN(bodies, shape)};
}

/* ------------------------------------------------------------------------------------------------ answers */

struct question {
    const struct ground_scene *scene;
    const narc_bodies *movers;
    const narc_motions *motions;
    const narc_pairs *pairs;
    narc_query query;
    size_t capacity;
};

/* The places of answers in memory that begins with how many rows there are. */
static struct ground_answers spread(const struct question *q, void *memory) {
    struct ground_answers out = {.counts = memory, .bits = (uint64_t *)memory + 2};
    out.contacts = (narc_contact *)(out.bits + NARC_BIT_WORDS(q->pairs->count));
    out.manifolds = (narc_manifold *)(out.contacts + q->capacity);
    out.impacts = (narc_impact *)(out.manifolds + q->capacity);
    return out;
}

static void ask_all(const void *question, const narc_workers *workers, void *memory) {
    const struct question *const q = question;
    const struct ground_answers out = spread(q, memory);
    const narc_shapes *const store = q->scene->store;
    narc_query query = q->query;
    const narc_cast_options casts = {.front_only = query.front_only, .workers = workers};
    size_t contacts = 0, manifolds = 0;
    narc_error error = {0};
    query.workers = workers;
    expect_ok(narc_find_contacts(store, q->movers, q->pairs, &query, out.contacts, q->capacity, &contacts, &error),
              &error);
    expect_ok(narc_find_manifolds(store, q->movers, q->pairs, &query, out.manifolds, q->capacity, &manifolds, &error),
              &error);
    query.margin = 0;
    expect_ok(narc_find_overlaps(store, q->movers, q->pairs, &query, out.bits, &error), &error);
    expect_ok(
        narc_cast_pairs(store, q->movers, q->motions, q->pairs, NULL, &casts, out.impacts, q->pairs->count, &error),
        &error);
    out.counts[0] = contacts;
    out.counts[1] = manifolds;
    /* What was written behind them, of pairs with several rows, is none of the answer. */
    memset(out.contacts + contacts, 0, (q->capacity - contacts) * sizeof *out.contacts);
    memset(out.manifolds + manifolds, 0, (q->capacity - manifolds) * sizeof *out.manifolds);
}

/* A pair's rows in the order of their normals, each manifold with its contact's normal and separation, a bit where one is
 * below 0. */
static void check_agreement(const struct ground_answers *out, size_t pairs) {
    assert_int_equal(out->counts[0], out->counts[1]);
    size_t row = 0;
    for (size_t k = 0; k < pairs; k++) {
        bool overlaps = false;
        for (const size_t first = row; row < out->counts[0] && out->contacts[row].pair == k; row++) {
            const narc_contact *c = &out->contacts[row];
            const narc_manifold *m = &out->manifolds[row];
            assert_true(m->pair == k && m->normal_x == c->normal_x && m->normal_y == c->normal_y);
            assert_true(c->count == 1 && m->count >= 1 && m->count <= 2 && find_deepest(m) == c->separation);
            assert_true(row == first || c[-1].normal_x * c->normal_y - c[-1].normal_y * c->normal_x >= 0);
            overlaps = overlaps || c->separation < 0;
        }
        assert_int_equal(bit_is_set(out->bits, k), overlaps);
    }
    assert_int_equal(row, out->counts[0]);
}

static struct ground_answers ask_sets(struct question q, bool everywhere) {
    const size_t row = sizeof(narc_contact) + sizeof(narc_manifold);
    q.capacity = 2 * q.pairs->count + 64;
    const size_t size = (NARC_BIT_WORDS(q.pairs->count) + 2) * sizeof(uint64_t) + q.capacity * row +
                        q.pairs->count * sizeof(narc_impact);
    void *const memory = everywhere ? ask_everywhere(ask_all, &q, size, NULL) : make_junk(size);
    if (!everywhere)
        ask_all(&q, NULL, memory);
    const struct ground_answers out = spread(&q, memory);
    check_agreement(&out, q.pairs->count);
    return out;
}

struct ground_answers ask_ground(const struct ground_scene *scene, const narc_bodies *movers,
                                 const narc_motions *motions, const narc_pairs *pairs, narc_query query) {
    return ask_sets((struct question){scene, movers, motions, pairs, query, 0}, true);
}

/* 0 1 2 ... */
static const uint32_t *entry_numbers(void) {
    static uint32_t all[GROUND_ENTRIES];
    for (uint32_t k = all[1] ? GROUND_ENTRIES : 0; k < GROUND_ENTRIES; k++)
        all[k] = k;
    return all;
}

float find_deepest(const narc_manifold *m) {
    return m->count > 1 ? fminf(m->point[0].separation, m->point[1].separation) : m->point[0].separation;
}

size_t ground_contacts(const struct ground_scene *scene, const struct body *body, narc_query query, narc_contact *rows,
                       size_t capacity) {
    static const uint32_t zero = 0;
    const narc_bodies own = view_columns(body, 1), ground = view_columns(scene->bodies, scene->count);
    const narc_pairs pairs = {
        .count = scene->count, .a = {&zero, 0}, .b = NARC_ARRAY(entry_numbers()), .other_bodies = &ground};
    size_t found = 0;
    narc_error error = {0};
    expect_ok(narc_find_contacts(scene->store, &own, &pairs, &query, rows, capacity, &found, &error), &error);
    return found;
}

double ground_separation(const struct ground_scene *scene, const struct body *body, narc_query query) {
    static narc_contact rows[TOLD_ROWS];
    const size_t count = ground_contacts(scene, body, query, rows, TOLD_ROWS);
    double least = INFINITY;
    for (size_t k = 0; k < count; k++)
        least = fmin(least, (double)rows[k].separation);
    return least;
}

void ask_body(const struct ground_scene *scene, const struct body *body, narc_query query, struct told_rows *out) {
    static const uint32_t zero = 0;
    const narc_bodies own = view_columns(body, 1), ground = view_columns(scene->bodies, scene->count);
    const narc_pairs pairs = {
        .count = scene->count, .a = {&zero, 0}, .b = NARC_ARRAY(entry_numbers()), .other_bodies = &ground};
    AUTO(free_at)
    const struct ground_answers answers = ask_sets((struct question){scene, &own, NULL, &pairs, query, 0}, false);
    out->contact_count = answers.counts[0];
    assert_in_range(out->contact_count, 0, TOLD_ROWS);
    memcpy(out->contacts, answers.contacts, out->contact_count * sizeof *out->contacts);
    memcpy(out->rows, answers.manifolds, out->contact_count * sizeof *out->rows);
    memcpy(out->impacts, answers.impacts, scene->count * sizeof *out->impacts);
    out->count =
        narc_merge_rows(&(narc_merging){&pairs, NARC_ARRAY(scene->runs), scene->store, &ground, .manifolds = out->rows},
                        out->contact_count);
    out->deepest = INFINITY;
    for (size_t k = 0; k < out->count; k++)
        out->deepest = fminf(out->deepest, find_deepest(&out->rows[k]));
}
