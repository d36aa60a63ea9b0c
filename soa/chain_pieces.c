/* SPDX-License-Identifier: MIT
 *
 * chain_pieces.c - divides a chain into pieces that the store keeps: concave arcs, and convex runs, which are closed far
 * behind so that they are shapes as others are (store.h, NARC_PIECE_...).
 *
 * The closure of a run whose normals turn from mid - h to mid + h: at both ends a corner that turns by NARC_END_TURN, then the
 * tangent for the length L to a far corner; from there the outline turns half of the way to -mid, goes down to a depth L
 * below both far corners, and is closed by an edge with the normal -mid. What the far edges add to the support function
 * makes gaps there deeply negative, so that the greatest gap of the closed shape is the greatest one over the run's own
 * normals. The bottom is as wide as the front, and on both sides L (cos h - tan(h / 2)) wider, less what a front that
 * ends lower on one side takes away: above 0 for h up to MAX_TURN / 2 and a little more.
 */
#include <math.h>

#include "chain.h"
#include "elementary.h"
#include "encode.h"
#include "error.h"
#include "outline.h"

/* What two parts of a cut straight line have in common, relative to the longest part: a body that is no wider along the
 * line lies on one of them with all that it touches there. */
#define LINE_OVERLAP 0.25

/* What the number of a line's parts may be rounded by: then they are longer than `weld`, by as much. */
#define PART_ROOM 1e-9

/* A body that is d deep, and less than d times NARC_END_TURN from the end of a run, may have its greatest gap beyond that, and
 * then no contact here. So pieces have that much in common, and no more than merging takes for one. A run reaches beyond
 * where it meets a concave arc by this many times the length of its line or the radius of its arc, and of the concave one,
 * whose rows merging prefers. These reach beyond their ends by less, in radians; the smaller they are, beside what is
 * around, the more are they seen from it with rounded directions. */
#define END_SEAM          1e-4
#define CONCAVE_SEAM      2e-6
#define MOST_CONCAVE_SEAM 2e-4

/* A run's last arc reaches beyond its end by no less: where an edge of a body lies along the tangent, what is within 2^-20
 * radians of an end is taken for what follows (contact_point.inl), and directions are rounded. */
#define LEAST_END_SEAM 0x1.8p-20

/* The bottom of a valley turns further, as does what is right below it; runs reach beyond it by their roundings alone. */
#define VALLEY_TURN 0.99e-3
#define VALLEY_SEAM 0x1p-16

/* How large the bottom of a valley is, relative to what is around. */
#define VALLEY_SIZE 0x1p-16

/* Most that the front of a piece turns by, but for what it shares with others. */
#define MAX_TURN 1.7

/* What is known of the solid around a piece: up to so many times the size of its front, and a little less than is
 * found. */
#define KNOWN      2.0
#define KNOWN_PART 0.99
#define DEPTH_ROOM 1.001 /* for rounding */

/* A corner that turns by more has nothing behind it along some of its normals. */
#define RIGHT_ANGLE (NARC_PI / 2 + 1e-6)

/* The front of a run is a point if it is smaller than this many times its neighbours; then their size serves. */
#define POINT 0x1p-20

enum { CLOSURE_ARCS = 6, MAX_FRONT = NARC_MAX_ARCS - CLOSURE_ARCS - 3 };

/* The piece of a run that is being made: its front are arcs 1 .. count. */
typedef struct piece {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_point begin;
    narc_chain_place before;       /* what the chain has before it */
    double begin_angle, end_angle; /* of normals */
    uint32_t first_arc;
    bool begins_in_corner, ends_in_corner; /* that was cut */
    bool is_sharp;                         /* it holds a corner that turns far */
} piece;

typedef struct divider {
    const narc_chain *chain;
    const narc_curves *curves;
    narc_chain_division *out;
    narc_error *error;
    narc_status status; /* of the first error */
    double reach;       /* the size of what is around */
    double turn;        /* most that pieces of this run turn by */
    piece piece;
} divider;

static narc_point move(narc_point from, double angle, double length) {
    double x, y;
    narc_find_cosine(angle, &x, &y);
    return (narc_point){from.x + length * x, from.y + length * y};
}

static double find_distance(narc_point a, narc_point b) { return narc_hypot(a.x - b.x, a.y - b.y); }

static double find_length(const narc_chain_arc *arc) { return fabs(arc->radius * arc->turn); }

/* The line before arc k, but no more than one part of it. */
static double find_line(const narc_chain *chain, size_t k) {
    return fmin(chain->weld,
                find_distance(narc_find_chain_end(&chain->arcs[k - 1]), narc_find_chain_start(&chain->arcs[k])));
}

/* Puts a piece into the store. */
static void put_entry(divider *d, narc_encoded_shape *encoded, narc_chain_entry entry) {
    narc_chain_division *out = d->out;
    if (out->shapes) {
        d->status = narc_share_encoded_shape(out->shapes, encoded, &entry.shape, d->error);
        if (d->status != NARC_OK)
            return;
        out->entries[out->count] = entry;
    }
    out->count++;
    out->records += narc_count_records(&encoded->header);
}

static void fail_piece(divider *d, narc_status status, uint32_t number, const narc_error *reason) {
    d->status = narc_fail(d->error, status, number, reason->value, "the piece of the chain that begins at arc %lu: %s",
                          (unsigned long)number, reason->message);
}

/* ------------------------------------------------------------------------------------------------ its solid */

/* Is it a corner that turns far? A closed chain may have cut its first one. */
static bool is_sharp(const narc_chain *chain, const narc_chain_arc *arc) {
    const narc_chain_arc *first = chain->arcs, *last = chain->arcs + chain->count - 1;
    const bool is_cut = chain->closed && (arc == first || arc == last);
    return arc->radius == 0 &&
           (is_cut ? narc_wrap_angle(first->start - last->start) + first->turn : arc->turn) > RIGHT_ANGLE;
}

/* Does a concave arc begin or end in one? */
static bool ends_in_sharp(const narc_chain *chain, const narc_chain_arc *arc) {
    const narc_chain_arc *const end = chain->arcs + chain->count - 1;
    const narc_chain_arc *const before = arc > chain->arcs ? arc - 1 : chain->closed ? end - 1 : NULL;
    return (before && is_sharp(chain, before) &&
            find_distance(narc_find_chain_end(before), narc_find_chain_start(arc)) <=
                narc_find_chain_room(before, arc)) ||
           (arc < end && is_sharp(chain, arc + 1) &&
            find_distance(narc_find_chain_end(arc), narc_find_chain_start(arc + 1)) <=
                narc_find_chain_room(arc, arc + 1));
}

static float keep_part(double length) { return (float)(KNOWN_PART * length); }

/* An end of a front: from the origin, with its normal there, and where it is on the chain. */
typedef struct front_end {
    narc_point at;
    double angle;
    narc_chain_place place;
} front_end;

/* What is known of the solid around a front of so many arcs. Nothing is before there is a store. */
static narc_solid measure_solid(const divider *d, const narc_arc *arcs, size_t count, const front_end ends[2],
                                narc_point origin, double size, bool holds_sharp) {
    const double most = fmin(KNOWN * size, d->chain->thickness);
    narc_solid solid = {.thickness = most > 0 ? 0 : -0.0f};
    if (!d->out->shapes || !(most > 0))
        return solid;
    if (!holds_sharp)
        solid.thickness = keep_part(narc_find_thickness(d->curves, arcs, count, ends[0].at, ends[1].at, origin, most));
    double depth = (double)solid.thickness;
    for (int k = 0; k < 2; k++) {
        const front_end *end = &ends[k], *other = &ends[1 - k];
        const narc_point at = {origin.x + end->at.x, origin.y + end->at.y};
        solid.clearance[k] = keep_part(narc_find_clearance(d->curves, at, end->place, most));
        /* Near an end, behind a place of the front that lies the higher, the further it is from there. */
        narc_point n;
        narc_find_normal(other->angle, &n.x, &n.y);
        const double rise = (other->at.x - end->at.x) * n.x + (other->at.y - end->at.y) * n.y;
        depth = fmax(depth, (double)solid.clearance[k] + fmax(0, rise));
    }
    solid.depth = (float)(DEPTH_ROOM * depth);
    return solid;
}

/* ------------------------------------------------------------------------------------------------ runs */

static narc_arc make_corner(narc_point p, double start, double end) { return (narc_arc){p.x, p.y, 0, start, end}; }

/* How far the front reaches from its middle, the origin. */
static double measure_front(const piece *p, narc_point begin) {
    double size = narc_hypot(begin.x, begin.y); /* and so does its end */
    for (size_t i = 1; i <= p->count; i++) {
        const narc_arc *arc = &p->arcs[i];
        const narc_point center = {arc->center_x, arc->center_y};
        const narc_point start = move(center, arc->start, arc->radius), end = move(center, arc->end, arc->radius);
        const double turned = narc_wrap_angle(narc_atan2(center.y, center.x) - (arc->start + arc->end) / 2);
        const double ends = fmax(narc_hypot(start.x, start.y), narc_hypot(end.x, end.y));
        const bool holds = fabs(turned) <= (arc->end - arc->start) / 2; /* the furthest point of its circle */
        size = fmax(size, holds ? narc_hypot(center.x, center.y) + arc->radius : ends);
    }
    return size;
}

/* Adds the corners at both ends and behind. */
static size_t close_run(piece *p, narc_point begin, narc_point end, double length) {
    const double mid = (p->begin_angle + p->end_angle) / 2, h = (p->end_angle - p->begin_angle) / 2 + NARC_END_TURN;
    const double slant = (NARC_PI - h) / 2;
    narc_point m;
    narc_find_cosine(mid, &m.x, &m.y);
    const narc_point after = move(end, mid + h + NARC_PI / 2, length);
    const narc_point before = move(begin, mid - h - NARC_PI / 2, length);
    const double height_after = after.x * m.x + after.y * m.y, height_before = before.x * m.x + before.y * m.y;
    const double bottom = fmin(height_after, height_before) - length, fall = narc_cos(h / 2);
    const double next = mid + h + slant, last = mid - h - slant;
    const narc_point low_after = move(after, next + NARC_PI / 2, (height_after - bottom) / fall);
    const narc_point low_before = move(before, last - NARC_PI / 2, (height_before - bottom) / fall);
    const size_t n = p->count;
    p->arcs[0] = make_corner(begin, p->begin_angle - NARC_END_TURN, p->begin_angle);
    p->arcs[n + 1] = make_corner(end, p->end_angle, p->end_angle + NARC_END_TURN);
    p->arcs[n + 2] = make_corner(after, mid + h, next);
    p->arcs[n + 3] = make_corner(low_after, next, mid + NARC_PI);
    p->arcs[n + 4] = make_corner(low_before, mid + NARC_PI, last + 2 * NARC_PI);
    p->arcs[n + 5] = make_corner(before, last + 2 * NARC_PI, mid - h + 2 * NARC_PI);
    return n + CLOSURE_ARCS;
}

static void open_piece(divider *d, narc_point begin, narc_chain_place before, double angle, uint32_t first_arc) {
    d->piece.count = 0;
    d->piece.before = before;
    d->piece.begin = begin;
    d->piece.begin_angle = d->piece.end_angle = angle;
    d->piece.first_arc = first_arc;
    d->piece.begins_in_corner = d->piece.ends_in_corner = d->piece.is_sharp = false;
}

static void put_arc(divider *d, const narc_chain_arc *arc, double from, double to) {
    piece *p = &d->piece;
    const double start = p->end_angle + narc_wrap_angle(arc->start + from - p->end_angle);
    if (p->count == 0)
        p->first_arc = arc->number;
    p->arcs[++p->count] = (narc_arc){arc->x, arc->y, arc->radius, start, start + (to - from)};
    p->is_sharp = p->is_sharp || is_sharp(d->chain, arc);
    p->end_angle = start + (to - from);
}

/* A corner where a front ends, of no more turn than a seam has. */
static void put_seam(divider *d, narc_point at, double start, uint32_t number) {
    const narc_chain_arc corner = {.x = at.x, .y = at.y, .start = start, .turn = NARC_CHAIN_SEAM, .number = number};
    put_arc(d, &corner, 0, corner.turn);
}

static void end_piece(divider *d, narc_point end, narc_chain_place after) {
    piece *p = &d->piece;
    narc_encoded_shape encoded;
    narc_error reason = {.status = NARC_OK};
    const narc_point middle = {(p->begin.x + end.x) / 2, (p->begin.y + end.y) / 2};
    narc_point begin = {p->begin.x - middle.x, p->begin.y - middle.y}, stop = {-begin.x, -begin.y};
    if (d->status != NARC_OK)
        return;
    for (size_t i = 1; i <= p->count; i++) {
        p->arcs[i].center_x -= middle.x;
        p->arcs[i].center_y -= middle.y;
    }
    double size = measure_front(p, begin);
    if (size <= POINT * d->reach)
        size = d->reach / 8;
    const front_end ends[2] = {{begin, p->begin_angle, p->before}, {stop, p->end_angle, after}};
    const narc_solid solid = measure_solid(d, p->arcs + 1, p->count, ends, middle, 2 * size, p->is_sharp);
    if (p->begins_in_corner)
        begin = move(begin, p->begin_angle - NARC_PI / 2, NARC_FIN * size);
    if (p->ends_in_corner) {
        const double angle = p->end_angle;
        stop = move(stop, angle + NARC_PI / 2, NARC_FIN * size);
        put_seam(d, stop, angle, 0);
    }
    const size_t count = close_run(p, begin, stop, NARC_FAR * size);
    const narc_status status = narc_encode_run(p->arcs, count, &solid, &encoded, &reason);
    if (status != NARC_OK)
        fail_piece(d, status, p->first_arc, &reason);
    else
        put_entry(d, &encoded,
                  (narc_chain_entry){.run = d->out->run,
                                     .x = middle.x,
                                     .y = middle.y,
                                     .first_arc = p->first_arc,
                                     .arc_count = (uint32_t)p->count - p->ends_in_corner});
}

/* A straight line to `to`, cut into parts of one length if it is too long. */
static void add_line(divider *d, narc_point from, narc_point to, const narc_chain_arc *after) {
    const double length = find_distance(from, to), weld = d->chain->weld, common = LINE_OVERLAP * weld;
    const narc_chain_arc *const before = after - 1;
    const unsigned long next = after->number;
    const double parts = fmax(1, ceil((length - common) / (weld - common) - PART_ROOM)); /* 1 if weld is infinite */
    if (!((double)d->out->count + parts <= NARC_MAX_SHAPES))
        d->status =
            narc_fail(d->error, NARC_ERROR_COUNT, next, parts, "arc %lu: the edge before it has %g parts", next, parts);
    const double step_x = (to.x - from.x) / length, step_y = (to.y - from.y) / length;
    for (double k = 1; k < parts && d->status == NARC_OK; k++) {
        const double at = (length - common) * (k / parts), end = at + common;
        end_piece(d, (narc_point){from.x + step_x * end, from.y + step_y * end}, (narc_chain_place){after, 0});
        open_piece(d, (narc_point){from.x + step_x * at, from.y + step_y * at},
                   (narc_chain_place){before, before->turn}, d->piece.end_angle, after->number);
    }
}

/* A convex arc, cut where the piece turns enough or has no room for another arc. */
static void add_arc(divider *d, const narc_chain_arc *arc, double from, double to, bool is_last) {
    double at = from;
    while (d->status == NARC_OK) {
        const double rest = to - at, room = d->turn - (d->piece.end_angle - d->piece.begin_angle);
        if (rest <= room && (d->piece.count < MAX_FRONT || is_last))
            break;
        const double cut = at + fmin(fmax(0, room), rest / (rest <= room ? 2 : 1));
        const double seam = narc_find_seam(arc);
        const double end = fmin(cut + seam, to), begin = fmax(cut - seam, fmax(at, from));
        put_arc(d, arc, at, end);
        d->piece.ends_in_corner = arc->radius == 0;
        end_piece(d, narc_find_chain_point(arc, end), (narc_chain_place){arc, end});
        open_piece(d, narc_find_chain_point(arc, begin), (narc_chain_place){arc, begin}, arc->start + begin,
                   arc->number);
        d->piece.begins_in_corner = arc->radius == 0;
        at = begin;
    }
    put_arc(d, arc, at, to);
}

/* Where a run ends that meets the concave arc `concave` at `end`, if a line leads there from `from`. */
static narc_point extend_line(const narc_chain_arc *concave, narc_point from, narc_point end, double weld) {
    const double length = find_distance(from, end), part = fmin(length, weld);
    const double over = (concave->radius != 0 ? END_SEAM * fmin(part, -concave->radius) : VALLEY_SEAM * part) / length;
    return (narc_point){end.x + over * (end.x - from.x), end.y + over * (end.y - from.y)};
}

/* How far, in radians, a run's last arc goes on where it meets a concave one; at the bottom of a valley that is into the
 * solid, where places nearest to points would be none of the ground. */
static double extend_arc(const narc_chain_arc *concave, const narc_chain_arc *arc) {
    const double least = concave->radius != 0 ? LEAST_END_SEAM : VALLEY_SEAM;
    return -concave->radius < arc->radius ? fmax(END_SEAM * (-concave->radius / arc->radius), least) : END_SEAM;
}

/* The size of the arcs first .. last and the lines between them, and of as many more as it takes if all are one point. */
static double find_reach(const narc_chain *chain, size_t first, size_t last) {
    double reach = find_length(&chain->arcs[last]);
    for (size_t k = last; k > 0 && (k > first || reach == 0); k--)
        reach = fmax(reach, fmax(find_length(&chain->arcs[k - 1]), find_line(chain, k)));
    for (size_t k = last + 1; k < chain->count && reach == 0; k++)
        reach = fmax(find_length(&chain->arcs[k]), find_line(chain, k));
    return reach;
}

/* A run of the arcs first .. end - 1, and the edges at both ends. */
static void divide_run(divider *d, size_t first, size_t end) {
    const narc_chain *chain = d->chain;
    const narc_chain_arc *arcs = chain->arcs, *before = first > 0 ? &arcs[first - 1] : NULL;
    const narc_chain_arc *after = end < chain->count ? &arcs[end] : NULL;
    if (first == end && !(before && after))
        return;
    const narc_chain_arc *begins = first < end ? &arcs[first] : after, *ends = first < end ? &arcs[end - 1] : before;
    narc_point from = narc_find_chain_start(begins), to = narc_find_chain_end(ends);
    const narc_point start = from, stop = to;
    bool has_line = false, has_end_line = false;
    double sum = 0;
    if (before) {
        from = narc_find_chain_end(before);
        has_line = find_distance(from, start) > narc_find_chain_room(before, begins);
        from = has_line ? extend_line(before, start, from, chain->weld) : start;
    }
    if (after) {
        to = narc_find_chain_start(after);
        has_end_line = find_distance(stop, to) > narc_find_chain_room(ends, after);
        to = has_end_line ? extend_line(after, stop, to, chain->weld) : stop;
    }
    for (size_t k = first; k < end; k++)
        sum += arcs[k].turn;
    if (sum == 0 && find_distance(from, to) <= narc_find_chain_room(begins, ends))
        return;
    d->turn = sum / fmax(1, ceil(sum / MAX_TURN)) + 3 * NARC_CORNER_SEAM;
    d->reach = find_reach(chain, before ? first - 1 : first, after ? end : end - 1);
    /* An arc goes on beyond the end itself; a line turns there by a corner, too, but at the bottom of a valley. */
    const double over = before && !has_line ? extend_arc(before, begins) : 0,
                 end_over = after && !has_end_line ? extend_arc(after, ends) : 0;
    const bool has_corner = has_line && before->radius != 0, has_end_corner = has_end_line && after->radius != 0;
    if (over > 0)
        from = narc_find_chain_point(begins, -over);
    if (end_over > 0)
        to = narc_find_chain_point(ends, ends->turn + end_over);
    open_piece(d, from, before ? (narc_chain_place){before, before->turn} : (narc_chain_place){begins, 0},
               begins->start - (has_corner ? NARC_CHAIN_SEAM : over), begins->number);
    if (has_corner)
        put_seam(d, from, begins->start - NARC_CHAIN_SEAM, before->number);
    const bool is_cut = chain->closed && !before; /* a closed convex chain begins and ends where an arc is cut */
    d->piece.begins_in_corner = is_cut && begins->radius == 0;
    narc_point at = from;
    for (size_t k = first; k < end && d->status == NARC_OK; k++) {
        const narc_chain_arc *arc = &arcs[k];
        if (k > first ? find_distance(at, narc_find_chain_start(arc)) > narc_find_chain_room(arc - 1, arc) : has_line)
            add_line(d, at, narc_find_chain_start(arc), arc);
        if (arc->turn > 0)
            add_arc(d, arc, k == first ? -over : 0, arc->turn + (k + 1 == end ? end_over : 0), k + 1 == end);
        at = narc_find_chain_end(arc);
    }
    if (has_end_line)
        add_line(d, at, to, after);
    if (has_end_corner)
        put_seam(d, to, d->piece.end_angle, after->number);
    d->piece.ends_in_corner = is_cut && ends->radius == 0;
    end_piece(d, to, after ? (narc_chain_place){after, 0} : (narc_chain_place){ends, ends->turn});
    d->out->run++;
}

/* ------------------------------------------------------------------------------------------------ concave arcs */

static void divide_concave(divider *d, size_t k) {
    const narc_chain *chain = d->chain;
    const narc_chain_arc *arc = &chain->arcs[k];
    const bool has_before = k > 0 || chain->closed, has_after = k + 1 < chain->count;
    const double parts = ceil(-arc->turn / 2);
    const double near = find_reach(chain, k > 0 ? k - 1 : 0, has_after ? k + 1 : k);
    const double seam =
        arc->radius != 0 ? fmin(CONCAVE_SEAM * fmax(1, near / -arc->radius), MOST_CONCAVE_SEAM) : VALLEY_TURN;
    for (double part = 0; part < parts && d->status == NARC_OK; part++) {
        const double high = arc->turn * (part / parts) + (part > 0 || has_before ? seam : 0);
        const double low = arc->turn * ((part + 1) / parts) - (part + 1 < parts || has_after ? seam : 0);
        const narc_point start = narc_find_chain_point(arc, low), end = narc_find_chain_point(arc, high);
        const narc_point middle = {(start.x + end.x) / 2, (start.y + end.y) / 2};
        const narc_arc own = {arc->x - middle.x, arc->y - middle.y, arc->radius, arc->start + low, arc->start + high};
        narc_encoded_shape encoded;
        narc_error reason = {.status = NARC_OK};
        const front_end ends[2] = {{{start.x - middle.x, start.y - middle.y}, own.start, {arc, low}},
                                   {{end.x - middle.x, end.y - middle.y}, own.end, {arc, high}}};
        const narc_solid solid =
            measure_solid(d, &own, 1, ends, middle, fmax(find_distance(start, end), near), ends_in_sharp(chain, arc));
        const narc_status status = narc_encode_concave(&own, VALLEY_SIZE * near, &solid, &encoded, &reason);
        if (status != NARC_OK)
            fail_piece(d, status, arc->number, &reason);
        else
            put_entry(d, &encoded,
                      (narc_chain_entry){
                          .run = NARC_NO_RUN, .x = middle.x, .y = middle.y, .first_arc = arc->number, .arc_count = 1});
    }
}

narc_status narc_divide_chain(const narc_chain *chain, const narc_curves *curves, narc_chain_division *division,
                              narc_error *error) {
    divider d = {.chain = chain, .curves = curves, .out = division, .error = error};
    size_t first = 0;
    while (d.status == NARC_OK) {
        size_t end = first;
        while (end < chain->count && !(chain->arcs[end].turn < 0))
            end++;
        divide_run(&d, first, end);
        if (end == chain->count || (chain->closed && end > 0 && end + 1 == chain->count) || d.status != NARC_OK)
            break;
        divide_concave(&d, end);
        first = end + 1;
    }
    return d.status;
}
