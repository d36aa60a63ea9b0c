/* SPDX-License-Identifier: MIT
 *
 * chains.c - random chains, made by walking with the solid on the left, and bodies on them.
 */
#include "chains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "turtle.h"

/* How steep open chains get: they go from right to left, the air above. */
static const double steepest = 1.1;

struct walk {
    narc_arc *arcs;
    size_t count;
    narc_point at;
    double heading; /* pi: to the left */
};

static void put_arc(struct walk *walk, double radius, double sweep) {
    const double normal = walk->heading - PI / 2;
    const narc_point center = {walk->at.x - radius * cos(normal), walk->at.y - radius * sin(normal)};
    walk->arcs[walk->count++] = (narc_arc){center.x, center.y, radius, normal, normal + sweep};
    walk->heading += sweep;
    walk->at = (narc_point){center.x + radius * cos(normal + sweep), center.y + radius * sin(normal + sweep)};
}

static void put_edge(struct walk *walk, double length) {
    walk->at.x += length * cos(walk->heading);
    walk->at.y += length * sin(walk->heading);
}

/* A sweep that keeps the heading between the steepest ones, to the left or to the right. */
static double choose_sweep(struct test_random *random, const struct walk *walk, double widest, bool left) {
    const double room = left ? PI + steepest - walk->heading : walk->heading - (PI - steepest);
    const double sweep =
        random_below(random, 4) ? random_between(random, 0.05, widest) : random_log_between(random, 0.02, widest);
    return sweep < room ? sweep : 0;
}

/* One piece, if there is room to turn. */
static void put_piece(struct test_random *random, struct walk *walk, enum chain_family family, double size) {
    if (walk->count == 0)
        put_arc(walk, 0, 0); /* an edge needs a beginning */
    const bool left = random_below(random, 2);
    const bool sharp = family == CHAIN_STEPS || (family == CHAIN_MIXED && random_below(random, 2)) ||
                       (family != CHAIN_HILLS && random_below(random, 6) == 0);
    const double sweep = choose_sweep(random, walk, 1.2, left);
    const double radius = sharp ? 0 : size * random_log_between(random, 0.2, 3);
    if (sweep > 0)
        put_arc(walk, left ? radius : -radius, left ? sweep : -sweep);
    if (sharp || random_below(random, 3) == 0) {
        size_t edges = random_below(random, 4) ? 1 : 1 + random_below(random, 5);
        put_edge(walk, size * random_log_between(random, 0.1, 2));
        while (--edges > 0) {
            put_arc(walk, 0, 0);
            put_edge(walk, size * random_log_between(random, 0.1, 2));
        }
        if (sweep <= 0)
            put_arc(walk, 0, 0);
    }
}

/* A concave arc in several pieces, perhaps with a flat bottom, between convex arcs or corners. */
static void put_bowl(struct test_random *random, struct walk *walk) {
    const double radius = random_log_between(random, 0.3, 3), down = random_between(random, 0.3, steepest);
    const double rim = random_below(random, 3) ? random_log_between(random, 0.1, 1) : 0;
    const size_t pieces = 1 + random_below(random, 5);
    if (walk->heading < PI + down)
        put_arc(walk, rim, PI + down - walk->heading);
    if (random_below(random, 2) || rim <= 0)
        put_edge(walk, random_log_between(random, 0.1, 1));
    const double turn = walk->heading - PI;
    for (size_t k = 0; k < pieces; k++)
        put_arc(walk, -radius, -turn / (double)pieces);
    if (random_below(random, 2))
        put_edge(walk, random_log_between(random, 0.1, 2));
    for (size_t k = 0; k < pieces; k++)
        put_arc(walk, -radius, -down / (double)pieces);
}

static struct chain finish(struct test_random *random, struct walk *walk, bool capped) {
    if (capped)
        put_arc(walk, 0, PI / 2);
    else if (random_below(random, 2)) {
        put_edge(walk, random_log_between(random, 0.1, 2));
        put_arc(walk, 0, 0);
    }
    return (struct chain){walk->arcs, walk->count, false};
}

enum { MOST_CORNERS = 64 };

/* A polygon whose corners are arcs, each with a share of the largest radius that there is room for, but no more than
 * `radius`. */
static struct chain round_corners(const narc_point *point, size_t corners, const double *share, double radius,
                                  narc_arc *arcs) {
    for (size_t k = 0; k < corners; k++) {
        const narc_point *p = &point[(k + corners - 1) % corners], *q = &point[k], *r = &point[(k + 1) % corners];
        const double before = hypot(q->x - p->x, q->y - p->y), after = hypot(r->x - q->x, r->y - q->y);
        const double heading = atan2(q->y - p->y, q->x - p->x), normal = heading - PI / 2;
        const double turn = remainder(atan2(r->y - q->y, r->x - q->x) - heading, 2 * PI), tangent = tan(fabs(turn) / 2);
        const double most = fmin(before, after) / 2 / tangent, own = copysign(fmin(share[k] * most, radius), turn);
        const narc_point from = {q->x - fabs(own) * tangent * cos(heading), q->y - fabs(own) * tangent * sin(heading)};
        arcs[k] = (narc_arc){from.x - own * cos(normal), from.y - own * sin(normal), own, normal, normal + turn};
    }
    return (struct chain){arcs, corners, true};
}

/* A polygon around the origin whose corners are arcs: convex ones and concave ones. */
static struct chain make_closed(struct test_random *random, narc_arc *arcs) {
    enum { MOST = 24 };
    const size_t corners = 3 + random_below(random, MOST - 2);
    const bool convex = random_below(random, 4) == 0;
    narc_point point[MOST];
    for (size_t k = 0; k < corners; k++) {
        const double angle = 2 * PI * ((double)k + random_between(random, -0.2, 0.2)) / (double)corners;
        const double radius = convex ? 2 : random_between(random, 1.2, 2.6);
        point[k] = (narc_point){radius * cos(angle), radius * sin(angle)};
    }
    double share[MOST];
    for (size_t k = 0; k < corners; k++)
        share[k] = random_below(random, 4) ? random_between(random, 0.05, 0.99) : 0;
    const struct chain chain = round_corners(point, corners, share, INFINITY, arcs);
    for (size_t k = 0; k < corners; k++)
        if (fabs(arcs[k].end - arcs[k].start) < 1e-2)
            return make_closed(random, arcs);
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
static struct chain bend_sheet(const struct sheet *sheet, double radius, bool round_ends, narc_arc *arcs) {
    struct walk walk = {.arcs = arcs};
    const double half = sheet->thickness / 2;
    for (int face = 0; face < 2; face++) {
        const double sign = face ? -1 : 1;
        for (size_t i = 0; i < sheet->count; i++) {
            const size_t k = face ? sheet->count - 1 - i : i;
            const double first = k > 0 ? tan(fabs(sheet->turn[k - 1]) / 2) : 0,
                         second = k + 1 < sheet->count ? tan(fabs(sheet->turn[k]) / 2) : 0;
            put_edge(&walk, fmax(0.05, sheet->side[k] - radius * (first + second)));
            if (i + 1 < sheet->count) {
                const double turn = sign * sheet->turn[face ? k - 1 : k];
                put_arc(&walk, turn > 0 ? radius + half : half - radius, turn);
            }
        }
        put_arc(&walk, round_ends ? half : 0, round_ends ? PI : PI / 2);
        if (!round_ends) {
            put_edge(&walk, sheet->thickness);
            put_arc(&walk, 0, PI / 2);
        }
    }
    return (struct chain){arcs, walk.count, true};
}

/* The same with corners, of which all or some are rounded a little, or none. */
static struct chain fold_sheet(struct test_random *random, const struct sheet *sheet, narc_arc *arcs) {
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
    return round_corners(point, corners, share, radius, arcs);
}

/* Walls from right to left, all a little different, on a slab. */
static struct chain make_walls(struct test_random *random, double thickness, narc_arc *arcs) {
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
    return round_corners(point, corners, share, thickness * random_log_between(random, 0.05, 1), arcs);
}

/* What is thin may cross itself: the store refuses that. */
static struct chain make_thin(struct test_random *random, enum chain_family family, narc_arc *arcs) {
    struct sheet sheet = {.count = 1, .thickness = random_log_between(random, 0.02, random_below(random, 2) ? 1 : 0.1)};
    const bool both_ways = family == CHAIN_ZIGZAG || family == CHAIN_SHEET;
    const double whole = family == CHAIN_PIPE ? random_between(random, 4.5, 6) : random_between(random, 0.5, 3.5);
    const double sign = random_below(random, 2) ? 1 : -1, side = random_log_between(random, 0.5, 2);
    if (family == CHAIN_WALLS)
        return make_walls(random, sheet.thickness, arcs);
    if (family == CHAIN_GEAR) {
        struct turtle t = walk_gear(5 + random_below(random, 20), random_between(random, 0.1, 0.5));
        const struct chain chain = {memcpy(arcs, t.arcs, t.count * sizeof *arcs), t.count, true};
        free(t.arcs);
        return chain;
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
                          random_below(random, 2), arcs);
    return fold_sheet(random, &sheet, arcs);
}

static struct chain make_open(struct test_random *random, enum chain_family family, narc_arc *arcs) {
    struct walk walk = {.arcs = arcs, .heading = PI + random_between(random, -0.5, 0.5)};
    const bool capped = family == CHAIN_ENDS ? random_below(random, 2) : false;
    size_t pieces = 4 + random_below(random, 12);
    if (family == CHAIN_LONG)
        pieces = 60 + random_below(random, 90);
    if (family == CHAIN_FINE)
        pieces = 30 + random_below(random, 40);
    if (family == CHAIN_ENDS)
        pieces = 1 + random_below(random, 4);
    if (capped) {
        walk.heading -= PI / 2;
        put_arc(&walk, 0, PI / 2);
        put_edge(&walk, random_log_between(random, 0.1, 2));
    } else if (random_below(random, 2)) {
        put_arc(&walk, 0, 0);
        put_edge(&walk, random_log_between(random, 0.1, 2));
    } else {
        const double sign = random_below(random, 2) ? 1 : -1;
        put_arc(&walk, sign * 0.5, sign * random_between(random, 0.05, 0.4));
    }
    const size_t begun = walk.count;
    for (size_t k = 0; k < pieces && walk.count < CHAIN_ARCS - 16; k++) {
        double size = 1;
        if (family == CHAIN_LONG)
            size = random_log_between(random, 3e-3, 3);
        if (family == CHAIN_FINE)
            size = random_log_between(random, 0.02, 0.2);
        if (family == CHAIN_BOWLS || (family == CHAIN_TIGHT && random_below(random, 2)))
            put_bowl(random, &walk);
        else
            put_piece(random, &walk, family, size);
    }
    if (walk.count == begun)
        put_arc(&walk, walk.count ? 0.5 : 1, 0.5);
    return finish(random, &walk, capped);
}

const char *chain_family_name(enum chain_family family) {
    static const char *const names[CHAIN_FAMILIES] = {"hills", "mixed",  "bowls", "tight", "fine",  "steps",
                                                      "long",  "closed", "ends",  "slab",  "arch",  "zigzag",
                                                      "sheet", "angle",  "cup",   "pipe",  "walls", "gear"};
    return names[family];
}

struct chain make_chain(struct test_random *random, enum chain_family family, narc_arc *arcs) {
    struct chain chain;
    do
        chain = family >= CHAIN_SLAB     ? make_thin(random, family, arcs)
                : family == CHAIN_CLOSED ? make_closed(random, arcs)
                                         : make_open(random, family, arcs);
    while (chain.count < 2);
    return chain;
}

/* ------------------------------------------------------------------------------------------------ riders */

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

static narc_point find_arc_end(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

double chain_side(const struct chain *chain) {
    double length = 0, pieces = 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k], *before = k ? arc - 1 : &chain->arcs[chain->count - 1];
        const narc_point from = find_arc_end(before, before->end), to = find_arc_end(arc, arc->start);
        const double line = k || chain->closed ? hypot(to.x - from.x, to.y - from.y) : 0;
        const double own = fabs(arc->radius * (arc->end - arc->start));
        length += line + own;
        pieces += (line > 1e-9) + (own > 1e-9);
    }
    return length / pieces;
}

/* As large as a tenth of a side of the ground to ten times that. */
static struct shape make_beside_thin(struct test_random *random, const struct chain *chain) {
    const double size = chain_side(chain) * random_log_between(random, 0.05, 5);
    struct shape shape;
    switch (random_below(random, 8)) {
    case 0:
        return circle_of(size);
    case 1:
        return box_of(2 * size, 2 * size * random_log_between(random, 0.1, 1), 0);
    case 2:
        return box_of(2 * size, size, size * random_between(random, 0.01, 0.4));
    case 3:
        return capsule_of(2 * size, size * random_log_between(random, 0.05, 1));
    case 4: /* a needle */
        return random_below(random, 2) ? box_of(2 * size, 0.04 * size, 0) : capsule_of(2 * size, 0.02 * size);
    case 5:
        assert_int_equal(narc_build_regular_polygon(3, size, random_below(random, 2) ? 0 : 0.1 * size, shape.arcs,
                                                    &shape.count, NULL),
                         NARC_OK);
        return shape;
    case 6:
        shape = make_shape(random, FAMILY_LENS);
        break;
    default:
        shape = make_shape(random, (enum family)random_below(random, FAMILY_SEGMENT));
    }
    for (size_t k = 0; k < shape.count; k++) {
        shape.arcs[k].center_x *= size;
        shape.arcs[k].center_y *= size;
        shape.arcs[k].radius *= size;
    }
    return shape;
}

struct shape make_rider(struct test_random *random, const struct chain *chain, enum chain_family family) {
    if (family >= CHAIN_SLAB)
        return make_beside_thin(random, chain);
    double size = random_log_between(random, 0.1, 2);
    if (family == CHAIN_TIGHT && random_below(random, 4)) {
        size = concave_radius(random, chain) *
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
    switch (random_below(random, 8)) {
    case 0:
        return circle_of(size);
    case 1:
        return box_of(2 * size, 2 * size * random_log_between(random, 0.1, 1), 0);
    case 2:
        return box_of(2 * size, size, size * random_between(random, 0.01, 0.4));
    case 3:
        return capsule_of(size, size * random_log_between(random, 0.1, 1));
    case 4:
        return ellipse_of(size, size * random_between(random, 0.3, 1), 4 + 4 * random_below(random, 4));
    default:
        return make_shape(random, (enum family)random_below(random, FAMILY_SEGMENT));
    }
}

/* A place on the chain and an outward normal there: mostly the end of an arc, exactly or nearly. */
static narc_point choose_place(struct test_random *random, const struct chain *chain, double *out_angle) {
    const size_t k = random_below(random, chain->count);
    const narc_arc *arc = &chain->arcs[k];
    double part = random_unit(random);
    if (random_below(random, 2))
        part = (double)random_below(random, 2) + (random_below(random, 2) ? 0 : random_between(random, -1e-3, 1e-3));
    *out_angle = arc->start + (arc->end - arc->start) * part;
    narc_point place = {arc->center_x + arc->radius * cos(*out_angle), arc->center_y + arc->radius * sin(*out_angle)};
    if ((k || chain->closed) && random_below(random, 3) == 0) {
        const narc_arc *before = k ? arc - 1 : &chain->arcs[chain->count - 1];
        const double t = random_unit(random);
        *out_angle = arc->start;
        place.x = (1 - t) * (before->center_x + before->radius * cos(arc->start)) +
                  t * (arc->center_x + arc->radius * cos(arc->start));
        place.y = (1 - t) * (before->center_y + before->radius * sin(arc->start)) +
                  t * (arc->center_y + arc->radius * sin(arc->start));
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
