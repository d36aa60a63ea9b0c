/* SPDX-License-Identifier: MIT
 *
 * fewest.c - chains of lines as the fewest arcs and lines within a tolerance (after Maier and Pisinger 2013).
 *
 * Pieces go from gate to gate. A gate is a point of the chain with a few others across the chain, so that pieces may end
 * beside it. What they pass are places: points of the chain, and some between far ones. Through two points there is a family of arcs with one
 * parameter, the bulge b = tan(turn / 4), and a place between them is within the tolerance of those in an interval: with
 * the chord's half h along x, the middle as the origin and the turn 2 f, a circle is |P|^2 - h^2 + 2 h y cot f = 0 at P =
 * (x, y), and one that touches the disc of radius T about P has A sin f + B cos f = -C or C with A = |P|^2 - h^2 - T^2,
 * B = 2 h y, C = 2 h T. In b these are quadratic equations with the roots (B -+ C) / (D - A), D^2 = A^2 + B^2 - C^2.
 * A line, b = 0, is preferred, then the arc of least squares. What is chosen is measured along whole lines. The fewest
 * are a shortest way through the gates.
 */
#include "biarc/biarc.h"

#include <stdint.h>
#include <stdlib.h>

#include "error.h"
#include "outline/path.h"

/* Points of a gate: so many tolerances to the left of the chain. */
static const double across[] = {0, 0.6, -0.6};
enum { ACROSS = sizeof across / sizeof across[0] };

/* Between far points there are so many places at most, and they are so many tolerances apart at least. */
enum { MOST_BETWEEN = 7 };
static const double LEAST_STEP = 8;

/* Of the tolerance, what leaving points out takes where there are many; and how far the chain goes from lines between gates, at first: of short
 * chains there are more gates. */
static const double THINNING = 1.0 / 16, GATES = 0.5;
enum { FEW_GATES = 60, FEW_POINTS = 300 };

/* A piece is one; of as many, fewer arcs are better; then those nearer to the chain. */
static const double ARC = 1e-3, DISTANCE = 1e-6;

/* Arcs are no flatter than the store takes them, radius below 100 chords, and turn by half a turn at most, as in files. */
static const double LEAST_BULGE = 0.0026, MOST_BULGE = 1;

/* After so many gates in a row that cannot be reached no further one is tried. */
enum { MISSES = 6 };

/* A place of the chain, a point of it or one between two. */
struct place {
    narc_point at;
    bool is_point, is_joint, is_gate;
};

struct gate {
    narc_point at[ACROSS];
    size_t place;
    bool is_joint;
};

/* The best way to a point of a gate. */
struct way {
    double cost, bulge;
    size_t from;
};

struct search {
    struct place *places;
    size_t place_count;
    struct gate *gates;
    struct way *ways; /* of all points of all gates */
    size_t count;
    double tolerance;
    bool closed;
};

/* ---------------------------------------------------------------------------- one piece */

static narc_curve_arc make_piece(narc_point p, narc_point q, double bulge) {
    const narc_point chord = minus(q, p);
    if (bulge == 0)
        return (narc_curve_arc){.start = p, .end = q, .center = p, .radius = INFINITY};
    /* The middle of the arc is bulge * chord / 2 to the right of the chord's. */
    const double up = (1 - bulge * bulge) / (4 * bulge), size = length(chord);
    return (narc_curve_arc){p, q, along(along(p, 0.5, chord), up, turned(chord)),
                            size * (1 + bulge * bulge) / (4 * fabs(bulge)), 4 * narc_atan2(bulge, 1)};
}

/* How far a point is from a piece. */
static double measure_point(const narc_curve_arc *piece, narc_point p) {
    if (piece->turn == 0)
        return sqrt(side_distance(p, piece->start, piece->end));
    const double side = copysign(1, piece->turn);
    const narc_point from = minus(p, piece->center), u = minus(piece->start, piece->center),
                     v = minus(piece->end, piece->center);
    const bool behind_start = side * cross(u, from) >= 0, before_end = side * cross(from, v) >= 0;
    const bool within = fabs(piece->turn) <= PI ? behind_start && before_end : behind_start || before_end;
    return within ? fabs(length(from) - piece->radius)
                  : fmin(length(minus(p, piece->start)), length(minus(p, piece->end)));
}

/* Where a line p-q meets that from a centre through a point. */
static narc_point find_meeting(narc_point p, narc_point q, narc_point center, narc_point through) {
    const narc_point way = minus(through, center), e = minus(q, p);
    const double part = cross(minus(center, p), way) / cross(e, way);
    return part > 0 && part < 1 ? along(p, part, e) : p;
}

/* The largest distance of the points of a line from a piece: at its ends, at the foot from the centre, or where what is
 * nearest becomes an end of the arc. */
static double measure_line(const narc_curve_arc *piece, narc_point p, narc_point q) {
    double largest = fmax(measure_point(piece, p), measure_point(piece, q));
    if (piece->turn == 0)
        return largest;
    const narc_point e = minus(q, p);
    const double foot = dot(minus(piece->center, p), e) / dot(e, e);
    if (foot > 0 && foot < 1)
        largest = fmax(largest, measure_point(piece, along(p, foot, e)));
    largest = fmax(largest, measure_point(piece, find_meeting(p, q, piece->center, piece->start)));
    return fmax(largest, measure_point(piece, find_meeting(p, q, piece->center, piece->end)));
}

/* Place k, which counts round a ring, and that of a gate. */
static const struct place *place_of(const struct search *s, size_t k) { return &s->places[k % s->place_count]; }

static size_t find_place(const struct search *s, size_t gate) {
    return s->gates[gate % s->count].place + gate / s->count * s->place_count;
}

/* How far the chain between two gates and a piece are from each other; INFINITY: more than the tolerance. The nearest
 * point of the piece goes along all of it, without a jump, if nothing is as far as half of the radius or the chord. */
static double measure_piece(const struct search *s, const narc_curve_arc *piece, size_t from, size_t to) {
    const double most = fmin(s->tolerance, 0.5 * fmin(piece->radius, length(minus(piece->end, piece->start))));
    double largest = 0;
    for (size_t k = find_place(s, from); k < find_place(s, to) && largest <= most; k++)
        largest = fmax(largest, measure_line(piece, place_of(s, k)->at, place_of(s, k + 1)->at));
    return largest <= most ? largest : INFINITY;
}

/* What bulges arcs between two points may have, and sums of least squares. */
struct family {
    narc_point p, q;
    double size, low, high, squares, sum, weights;
    size_t points;
};

/* Takes a place into account: false, no arc is left. */
static bool narrow(struct family *f, const struct place *place, double t) {
    const narc_point chord = minus(f->q, f->p), at = minus(place->at, along(f->p, 0.5, chord));
    const double h = f->size / 2, c = 2 * h * t;
    const double x = dot(at, chord) / f->size, y = -cross(chord, at) / f->size; /* to the right */
    const double power = x * x + y * y - h * h, a = power - t * t, b = 2 * h * y;
    const double root = a * a + (b - c) * (b + c);
    const double to_p = (x + h) * (x + h) + y * y, to_q = (x - h) * (x - h) + y * y;
    if (root > 0 && to_p > t * t && to_q > t * t) {
        const double below = sqrt(root) - a;
        f->low = fmax(f->low, (b - c) / below);
        f->high = fmin(f->high, (b + c) / below);
        if (!(below > 0) || f->low > f->high)
            return false;
    }
    if (place->is_point) {
        const double weight = sqrt(power * power + b * b) - power;
        f->squares += b * b;
        f->sum += b * weight;
        f->weights += weight * weight;
        f->points++;
    }
    return true;
}

/* Most pieces fail at a few places, which are tried first. */
enum { PROBES = 12 };

/* What there is between two points: nothing; arcs that are too flat, or cost more than what is known; a piece. */
enum answer { NONE, NO_USE, FOUND };

/* The piece from a point of one gate to one of another: its bulge and cost, below `limit`. */
static enum answer find_piece(const struct search *s, size_t from, narc_point p, size_t to, narc_point q, double limit,
                              double *out_bulge, double *out_cost) {
    const size_t first = find_place(s, from), last = find_place(s, to);
    const double t = s->tolerance;
    struct family f = {.p = p, .q = q, .size = length(minus(q, p)), .low = -MOST_BULGE, .high = MOST_BULGE};
    if (!(f.size > 0))
        return NONE;
    if (limit <= 1 + ARC) /* a line alone is better */
        f.low = f.high = 0;
    for (size_t k = 1; last - first > 2 * PROBES && k < PROBES; k++)
        if (!narrow(&f, place_of(s, first + (last - first) * k / PROBES), t))
            return NONE;
    f = (struct family){.p = p, .q = q, .size = f.size, .low = f.low, .high = f.high};
    for (size_t k = first; k <= last; k++) /* the gates' own places too: pieces may end beside them */
        if (!narrow(&f, place_of(s, k), t))
            return NONE;
    const double low = f.low, high = f.high, squares = f.squares, sum = f.sum, weights = f.weights, size = f.size;
    const size_t points = f.points;
    const bool is_line = low <= 0 && high >= 0;
    if (!is_line && low > -LEAST_BULGE && high < LEAST_BULGE)
        return NO_USE;
    double bulge = weights > 0 ? sum / weights : 0;
    bulge = is_line ? 0 : fmin(high, fmax(low, bulge));
    if (!is_line && fabs(bulge) < LEAST_BULGE)
        bulge = high >= LEAST_BULGE ? LEAST_BULGE : -LEAST_BULGE;
    const double rest = fmax(0, squares - 2 * bulge * sum + bulge * bulge * weights);
    const double off = points ? sqrt(rest / (double)points) / size / t : 0;
    *out_bulge = bulge;
    *out_cost = 1 + (is_line ? 0 : ARC) + DISTANCE * fmin(off, 1);
    if (*out_cost >= limit)
        return NO_USE;
    const narc_curve_arc piece = make_piece(p, q, bulge);
    return measure_piece(s, &piece, from, to) <= t ? FOUND : NONE;
}

/* ---------------------------------------------------------------------------- the shortest way */

static struct way *way_of(const struct search *s, size_t gate, int side) {
    return &s->ways[gate * ACROSS + (size_t)side];
}

static void find_next(const struct search *s, size_t from, int side, size_t first, size_t last, int end_side) {
    const double cost = way_of(s, from - first, side)->cost;
    int misses = 0;
    for (size_t to = from + 1; to <= last && misses < MISSES; to++) {
        bool tried = false, reached = false;
        for (int k = 0; k < ACROSS; k++) {
            struct way *way = way_of(s, to - first, k);
            double bulge, own;
            /* Among equals the nearest is looked for where it may be exact. */
            const struct gate *a = &s->gates[from % s->count], *b = &s->gates[to % s->count];
            const double room =
                way->cost - cost - (side == 0 && k == 0 && a->is_joint && b->is_joint ? 0 : 2 * DISTANCE);
            if (room <= 1 || (to == last && end_side >= 0 && k != end_side))
                continue;
            tried = true;
            const enum answer found = find_piece(s, from, a->at[side], to, b->at[k], room, &bulge, &own);
            if (found == FOUND)
                *way = (struct way){cost + own, bulge, (from - first) * ACROSS + (size_t)side};
            reached = reached || found != NONE;
        }
        misses = reached ? 0 : misses + (tried && isinf(way_of(s, to - first, 0)->cost));
    }
}

/* The shortest way from one gate to another, of a ring on to the same one; its cost. `side` is the point of the first and
 * last gate; below 0: any. */
static double find_way(const struct search *s, size_t first, size_t last, int side) {
    for (size_t k = 0; k < (last - first + 1) * ACROSS; k++)
        s->ways[k] = (struct way){INFINITY, 0, SIZE_MAX};
    for (int k = 0; k < ACROSS; k++)
        if (side < 0 || k == side)
            way_of(s, 0, k)->cost = 0;
    double least = INFINITY;
    for (size_t from = first; from < last; from++)
        for (int k = 0; k < ACROSS; k++)
            if (way_of(s, from - first, k)->cost < INFINITY)
                find_next(s, from, k, first, last, side);
    for (int k = 0; k < ACROSS; k++)
        least = fmin(least, way_of(s, last - first, k)->cost);
    return least;
}

/* ---------------------------------------------------------------------------- gates */

/* Marks points that stay: others are within `room` of the lines through these; in steps that double and halve. */
static size_t thin(const narc_point *points, size_t count, double room, const bool *joints, bool *stays) {
    size_t kept = 1;
    for (size_t k = 0; k < count; k++)
        stays[k] = k == 0;
    for (size_t k = 0; k + 1 < count;) {
        size_t good = k + 1, step = 1;
        for (bool growing = true; step > 0; step = growing ? 2 * step : step / 2) {
            const size_t next = count - 1 - good < step ? count - 1 : good + step;
            bool near = next > good;
            for (size_t i = k + 1; near && i < next; i++)
                near = side_distance(points[i], points[k], points[next]) <= room * room && !(joints && joints[i]);
            growing = growing && near && next < count - 1;
            good = near ? next : good;
        }
        stays[good] = true;
        kept++;
        k = good;
    }
    return kept;
}

static void add_place(struct search *s, narc_point at, bool is_point, bool is_joint, bool is_gate) {
    s->count += is_gate;
    s->places[s->place_count++] = (struct place){at, is_point, is_joint, is_gate};
}

/* The places of a chain, and its gates: of those that stay, the ones that also stay with a larger room. */
static bool make_gates(struct search *s, const narc_polyline *line, double thinned, bool *stays, bool *gates) {
    const narc_point *points = line->points;
    const size_t last = line->count - 1;
    const double step = LEAST_STEP * s->tolerance;
    size_t kept = thin(points, line->count, thinned, line->joints, stays);
    size_t count = 0;
    for (double room = GATES * s->tolerance; count < FEW_GATES && room > THINNING / 4 * s->tolerance; room /= 2)
        count = thin(points, line->count, room, line->joints, gates);
    kept += count;
    for (size_t k = 0; k <= last; k++)
        stays[k] = stays[k] || gates[k];
    s->places = malloc((MOST_BETWEEN + 1) * kept * sizeof *s->places);
    for (size_t k = 0, next; s->places && k < last; k = next) {
        for (next = k + 1; !stays[next];)
            next++;
        const narc_point e = minus(points[next], points[k]);
        const double between = fmin(MOST_BETWEEN, floor(length(e) / step));
        add_place(s, points[k], true, line->joints && line->joints[k], gates[k] || (line->joints && line->joints[k]));
        for (double i = 1; i <= between; i++)
            add_place(s, along(points[k], i / (between + 1), e), false, false, false);
    }
    if (s->places && !s->closed)
        add_place(s, points[last], true, true, true);
    s->gates = malloc(s->count * sizeof *s->gates);
    s->ways = malloc((2 * s->count + 1) * ACROSS * sizeof *s->ways);
    if (!s->places || !s->gates || !s->ways)
        return false;
    for (size_t k = 0, gate = 0; k < s->place_count; k++) {
        const struct place *at = &s->places[k];
        if (!at->is_gate)
            continue;
        const size_t before = k ? k - 1 : s->closed ? s->place_count - 1 : 0;
        const size_t next = k + 1 < s->place_count ? k + 1 : s->closed ? 0 : k;
        const narc_point e = minus(s->places[next].at, s->places[before].at);
        const double size = length(e);
        s->gates[gate] = (struct gate){.place = k, .is_joint = at->is_joint};
        for (int i = 0; i < ACROSS; i++)
            s->gates[gate].at[i] = along(at->at, size > 0 ? across[i] * s->tolerance / size : 0, turned(e));
        gate++;
    }
    return true;
}

/* ---------------------------------------------------------------------------- chains */

/* Where a ring is best begun. The way twice round it settles on gates; those are tried, and then all gates of its shortest
 * piece, since a best round has an end in or near it. Half of that way's pieces are the least that a round can have. */
static void choose_cut(const struct search *s, size_t *out_gate, int *out_side) {
    enum { CUTS = 48 };
    size_t cuts[CUTS], count = 0, shortest = SIZE_MAX, begin = 0;
    const double twice = find_way(s, 0, 2 * s->count, -1);
    *out_gate = 0;
    *out_side = 0;
    if (isinf(twice))
        return;
    const struct way *last = way_of(s, 2 * s->count, 0);
    for (int k = 1; k < ACROSS; k++)
        last = way_of(s, 2 * s->count, k)->cost < last->cost ? way_of(s, 2 * s->count, k) : last;
    for (size_t at = last->from, end = 2 * s->count; at != SIZE_MAX; end = at / ACROSS, at = s->ways[at].from) {
        if (end - at / ACROSS < shortest) {
            shortest = end - at / ACROSS;
            begin = at / ACROSS;
        }
        if (at / ACROSS <= s->count + s->count / 2 && count < CUTS / 8)
            cuts[count++] = at;
    }
    for (size_t k = 0; k <= shortest && count < CUTS; k++)
        cuts[count++] = (begin + k) * ACROSS;
    double least = INFINITY;
    const double possible = ceil(floor(twice) / 2);
    for (size_t k = 0; k < count && least >= possible + 1; k++) {
        const size_t gate = cuts[k] / ACROSS % s->count;
        const int side = (int)(cuts[k] % ACROSS);
        const double cost = find_way(s, gate, gate + s->count, side);
        if (cost < least) {
            least = cost;
            *out_gate = gate;
            *out_side = side;
        }
    }
}

static narc_status put_pieces(const struct search *s, size_t first, size_t last, int side, narc_arc_list *to,
                              narc_error *error) {
    size_t count = 0, at = (last - first) * ACROSS + (size_t)side;
    for (size_t k = at; s->ways[k].from != SIZE_MAX; k = s->ways[k].from)
        count++;
    narc_curve_arc *arcs = narc_grow(to->arcs, &to->capacity, to->count + count, sizeof *arcs);
    if (!arcs)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
    to->arcs = arcs;
    for (size_t k = to->count + count; k-- > to->count; at = s->ways[at].from) {
        const size_t from = s->ways[at].from, begin = first + from / ACROSS, end = first + at / ACROSS;
        arcs[k] = make_piece(s->gates[begin % s->count].at[from % ACROSS], s->gates[end % s->count].at[at % ACROSS],
                             s->ways[at].bulge);
        to->distance = fmax(to->distance, measure_piece(s, &arcs[k], begin, end));
    }
    to->count += count;
    return NARC_OK;
}

narc_status narc_add_fewest(const narc_polyline *line, double tolerance, narc_arc_list *to, narc_error *error) {
    const double thinned = line->count <= FEW_POINTS ? 0 : THINNING * tolerance, before = to->distance;
    struct search s = {.tolerance = tolerance - thinned, .closed = line->closed};
    bool *stays = malloc(2 * line->count * sizeof *stays);
    narc_status status = NARC_OK;
    if (!stays || !make_gates(&s, line, thinned, stays, stays + line->count)) {
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for a chain of %zu points", line->count);
    } else {
        size_t first = 0;
        int side = 0;
        if (line->closed)
            choose_cut(&s, &first, &side);
        const size_t last = first + (line->closed ? s.count : s.count - 1);
        to->distance = 0;
        status = isinf(find_way(&s, first, last, side))
                     ? narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, tolerance, "no pieces are within %g", tolerance)
                     : put_pieces(&s, first, last, side, to, error);
        bool all = true;
        for (size_t k = 0; k < line->count; k++)
            all = all && stays[k];
        to->distance = fmax(before, to->distance + (all ? 0 : thinned));
    }
    free(stays);
    free(s.places);
    free(s.gates);
    free(s.ways);
    return status;
}
