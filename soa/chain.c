/* SPDX-License-Identifier: MIT
 *
 * chain.c - reads a chain, checks that its arcs meet, and adds its pieces to a store.
 */
#include "chain.h"

#include <math.h>

#include "elementary.h"
#include "encode.h"
#include "error.h"
#include "outline.h"

/* What the largest coordinates of an arc may be off by, relative to them: some thousand roundings. */
#define COORDINATE_ROOM 1e-12

/* Edges are welded to parts of this many times their mean. */
#define DEFAULT_WELD 32.0

static const size_t max_count = (size_t)1 << 30;

narc_point narc_find_chain_point(const narc_chain_arc *arc, double turned) {
    double x, y;
    narc_find_normal(arc->start + turned, &x, &y);
    return (narc_point){arc->x + arc->radius * x, arc->y + arc->radius * y};
}

double narc_find_chain_room(const narc_chain_arc *before, const narc_chain_arc *after) {
    const double size = fabs(before->x) + fabs(before->y) + fabs(before->radius) + fabs(after->x) + fabs(after->y) +
                        fabs(after->radius);
    return NARC_TOLERANCE * (fabs(before->radius * before->turn) + fabs(after->radius * after->turn)) +
           COORDINATE_ROOM * size;
}

/* ------------------------------------------------------------------------------------------------ reading */

/* A valley's bottom may have lost the sign of its radius, as programs write it that read -0 as a whole number: its normals
 * still turn clockwise. Of half a turn the sign decides. */
static bool is_concave(const narc_arc *arc) {
    const double turn = arc->end - arc->start + (arc->end < arc->start ? 2 * NARC_PI : 0);
    return signbit(arc->radius) ||
           (arc->radius == 0 && turn > NARC_PI + NARC_TOLERANCE && turn <= 2 * NARC_PI - NARC_TOLERANCE);
}

static narc_status read_arc(const narc_arc *arc, size_t i, const narc_chain_options *options, narc_chain_arc *out_arc,
                            narc_error *error) {
    const double numbers[] = {arc->center_x, arc->center_y, arc->radius, arc->start, arc->end};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (!(fabs(numbers[k]) <= NARC_MAX_DISTANCE))
            return narc_fail(error, isfinite(numbers[k]) ? NARC_ERROR_SIZE : NARC_ERROR_NOT_FINITE, i, numbers[k],
                             "arc %zu: a number is %g", i, numbers[k]);
    const bool concave = is_concave(arc);
    double turn = concave ? arc->start - arc->end : arc->end - arc->start;
    *out_arc = (narc_chain_arc){.x = arc->center_x,
                                .y = arc->center_y,
                                .radius = concave ? -fabs(arc->radius) : arc->radius,
                                .start = arc->start,
                                .number = (uint32_t)i};
    if (arc->radius == 0 && fabs(turn) <= NARC_TOLERANCE) {
        out_arc->radius = 0;
        return NARC_OK;
    }
    turn += turn < 0 ? 2 * NARC_PI : 0;
    if (!(turn >= NARC_TOLERANCE && turn <= NARC_PI + NARC_TOLERANCE))
        return narc_fail(error, NARC_ERROR_SWEEP, i, turn, "arc %zu: sweep is %.9g rad%s, %s", i, turn,
                         concave ? " clockwise" : "",
                         turn < NARC_TOLERANCE ? "it turns by nothing" : "more than half a turn");
    if (concave && fabs(arc->radius) < options->least_radius)
        return narc_fail(error, NARC_ERROR_RADIUS, i, arc->radius, "arc %zu: concave with the radius %.9g, below %.9g",
                         i, fabs(arc->radius), options->least_radius);
    out_arc->turn = concave ? -turn : turn;
    return NARC_OK;
}

/* Do two arcs meet, over any plain points between them? */
static narc_status check_join(const narc_chain_arc *before, const narc_chain_arc *after, narc_error *error) {
    const narc_point from = narc_find_chain_end(before), to = narc_find_chain_start(after);
    const double apart = narc_wrap_angle(after->start - (before->start + before->turn));
    const double x = to.x - from.x, y = to.y - from.y;
    const double tolerance = NARC_TOLERANCE * narc_hypot(x, y) + narc_find_chain_room(before, after);
    const size_t i = after->number;
    double n_x, n_y;
    narc_find_normal(after->start - apart / 2, &n_x, &n_y);
    const double off = x * n_x + y * n_y, along = y * n_x - x * n_y;
    if (fabs(apart) > NARC_TOLERANCE)
        return narc_fail(error, NARC_ERROR_NOT_CLOSED, i, apart,
                         "arc %zu: its start normal is %.9g rad from the end normal of arc %lu", i, apart,
                         (unsigned long)before->number);
    if (fabs(off) > tolerance)
        return narc_fail(error, NARC_ERROR_NOT_CLOSED, i, off,
                         "arc %zu: starts %.6g away from where the edge from arc %lu should meet it", i, fabs(off),
                         (unsigned long)before->number);
    if (along < -tolerance)
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, i, along,
                         "arc %zu: the edge from arc %lu runs backwards, its length is %.6g", i,
                         (unsigned long)before->number, along);
    return NARC_OK;
}

/* Where to begin: at a concave arc of a closed chain, else at one that turns. */
static size_t find_first(const narc_arc *arcs, size_t count, bool closed) {
    size_t first = 0;
    bool found = !closed;
    for (size_t i = 0; i < count && !(found && is_concave(&arcs[first])) && closed; i++) {
        const bool turns = !(arcs[i].radius == 0 && fabs(arcs[i].end - arcs[i].start) <= NARC_TOLERANCE);
        if (turns && (!found || is_concave(&arcs[i]))) {
            first = i;
            found = true;
        }
    }
    return found ? first : count;
}

/* Cuts the first arc of a closed convex chain: its first part becomes the last arc. */
static void cut_first(narc_chain *chain) {
    narc_chain_arc *first = &chain->arcs[0], *last = &chain->arcs[chain->count - 1];
    const double cut = first->turn / 2, seam = narc_find_seam(first);
    const double end = fmin(cut + seam, first->turn), begin = fmax(cut - seam, 0);
    *last = *first;
    last->turn = end;
    first->start += begin;
    first->turn -= begin;
}

static size_t find_number(const narc_chain *chain, size_t i) {
    const ptrdiff_t number = chain->number + chain->way * (ptrdiff_t)i;
    return number < 0 ? 0 : (size_t)number > chain->most ? chain->most : (size_t)number;
}

/* Reads all arcs into chain->arcs, which has room for one more, without plain points inside of straight lines. */
static narc_status read_chain(const narc_arc *arcs, size_t count, const narc_chain_options *options, narc_chain *chain,
                              narc_error *error) {
    const size_t first = find_first(arcs, count, chain->closed);
    narc_chain_arc last = {.turn = 0};
    double edges = 0, length = 0;
    if (first == count)
        return narc_fail(error, NARC_ERROR_SWEEP, 0, 0, "the closed chain does not turn");
    for (size_t k = 0; k < count + (chain->closed ? 1 : 0); k++) {
        const size_t i = (first + k) % count;
        narc_chain_arc arc;
        narc_status status = read_arc(&arcs[i], find_number(chain, i), options, &arc, error);
        if (status == NARC_OK && k > 0) {
            status = check_join(&last, &arc, error); /* an edge that runs back over a plain point */
            if (status == NARC_OK)
                status = check_join(&chain->arcs[chain->count - 1], &arc, error);
            const narc_point from = narc_find_chain_end(&last), to = narc_find_chain_start(&arc);
            const double edge = narc_hypot(to.x - from.x, to.y - from.y);
            const bool is_edge = edge > narc_find_chain_room(&last, &arc);
            edges += is_edge;
            length += is_edge ? edge : 0;
        }
        if (status != NARC_OK)
            return status;
        if (arc.turn != 0 || (!chain->closed && (k == 0 || k + 1 == count)))
            chain->arcs[chain->count++] = arc;
        last = arc;
    }
    if (chain->closed && chain->arcs[0].turn > 0)
        cut_first(chain);
    chain->weld = options->weld > 0 ? options->weld : edges > 0 ? DEFAULT_WELD * length / edges : INFINITY;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ sides */

/* A chain that is read, or one side of a line. */
typedef struct side {
    narc_chain chain;
    narc_curves curves;
    size_t count, records; /* entries, and the records that they need */
} side;

static narc_status fail_memory(size_t count, narc_error *error) {
    return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for %zu arcs", count);
}

static narc_arc make_end(const narc_arc *arc, double at, double start, double end) {
    narc_point n;
    narc_find_normal(at, &n.x, &n.y);
    return (narc_arc){arc->center_x + arc->radius * n.x, arc->center_y + arc->radius * n.y, 0, start, end};
}

/* One side of a line, `back`: the left one, walked back, with the solid on the other side of its arcs. Open ends get a
 * corner of a quarter turn. Returns how many arcs it has. */
static size_t make_side(const narc_arc *arcs, size_t count, bool closed, bool back, narc_arc *out) {
    const size_t from = closed ? 0 : 1;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *arc = &arcs[back ? count - 1 - k : k];
        out[from + k] =
            back ? (narc_arc){arc->center_x, arc->center_y, is_concave(arc) ? fabs(arc->radius) : -arc->radius,
                              arc->end + NARC_PI, arc->start + NARC_PI}
                 : *arc;
    }
    if (closed)
        return count;
    const narc_arc *first = &out[1], *last = &out[count];
    out[0] = make_end(first, first->start, first->start - NARC_PI / 2, first->start);
    out[count + 1] = make_end(last, last->end, last->end, last->end + NARC_PI / 2);
    return count + 2;
}

static void release_side(const side *s, const narc_allocator *allocator) {
    if (s->curves.curves)
        allocator->release(s->curves.curves, allocator->context);
    if (s->chain.arcs)
        allocator->release(s->chain.arcs, allocator->context);
}

/* Reads arcs, counts what they are divided into, and so finds what is wrong. */
static narc_status read_side(const narc_arc *arcs, size_t count, const narc_chain_options *options,
                             const narc_allocator *allocator, side *s, narc_error *error) {
    narc_chain_division division = {.run = 0};
    s->chain.closed = options->closed != 0;
    if (count < SIZE_MAX / sizeof *s->chain.arcs)
        s->chain.arcs = allocator->allocate((count + 1) * sizeof *s->chain.arcs, allocator->context);
    if (!s->chain.arcs)
        return fail_memory(count, error);
    narc_status status = read_chain(arcs, count, options, &s->chain, error);
    if (status == NARC_OK)
        status = narc_build_curves(&s->chain, allocator, &s->curves, error);
    if (status == NARC_OK)
        status = narc_check_crossings(&s->curves, error);
    if (status == NARC_OK)
        narc_find_end_sides(&s->chain, &s->curves);
    if (status == NARC_OK)
        status = narc_divide_chain(&s->chain, &s->curves, &division, error);
    s->count = division.count;
    s->records = division.records;
    return status;
}

/* A chain, or both sides of a line. */
static narc_status read_sides(const narc_arc *arcs, size_t count, const narc_chain_options *options,
                              const narc_allocator *allocator, side sides[2], narc_error *error) {
    const bool closed = options->closed != 0, is_line = options->both_sides != 0;
    const size_t most = count - 1;
    narc_arc *own = NULL;
    narc_status status = NARC_OK;
    if (!is_line) {
        sides[0].chain = (narc_chain){.way = 1, .most = most};
        sides[0].chain.thickness = options->thickness > 0 ? (double)options->thickness : INFINITY;
        return read_side(arcs, count, options, allocator, &sides[0], error);
    }
    if (count < SIZE_MAX / sizeof *own - 2)
        own = allocator->allocate((count + 2) * sizeof *own, allocator->context);
    if (!own)
        return fail_memory(count, error);
    for (int back = 0; back < 2 && status == NARC_OK; back++) {
        const size_t all = make_side(arcs, count, closed, back, own);
        const ptrdiff_t end = closed ? 0 : 1; /* an added corner has the number of the end */
        sides[back].chain = (narc_chain){
            .way = back ? -1 : 1, .number = back ? (ptrdiff_t)most + end : -end, .most = most, .thickness = 0};
        status = read_side(own, all, options, allocator, &sides[back], error);
    }
    allocator->release(own, allocator->context);
    return status;
}

/* ------------------------------------------------------------------------------------------------ adding */

/* Divides chains that are read into the store, with room for all. */
static narc_status add_pieces(narc_shapes *shapes, const side sides[2], uint32_t first_run,
                              narc_chain_entry *out_entries, size_t capacity, size_t *out_count, narc_error *error) {
    const size_t count = sides[0].count + sides[1].count;
    if (count == 0)
        return narc_fail(error, NARC_ERROR_SIZE, 0, 0, "the chain has no length");
    if (count > capacity) {
        *out_count = count;
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)count, "there is room for %zu entries, not for %zu",
                         capacity, count);
    }
    narc_status status =
        narc_make_room(shapes, narc_count_shapes(shapes) + count, sides[0].records + sides[1].records, true);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, (double)count, "no room for %zu shapes beside the other %zu", count,
                         narc_count_shapes(shapes));
    narc_chain_division division = {.shapes = shapes, .entries = out_entries, .run = first_run};
    for (int k = 0; k < 2 && status == NARC_OK && sides[k].count > 0; k++)
        status = narc_divide_chain(&sides[k].chain, &sides[k].curves, &division, error);
    for (size_t k = division.count; k-- > 0 && status != NARC_OK;) /* a shape with all the uses that it can have */
        (void)narc_remove_shape(shapes, out_entries[k].shape, NULL);
    if (status == NARC_OK)
        *out_count = division.count;
    return status;
}

narc_status narc_add_chain(narc_shapes *shapes, const narc_arc *arcs, size_t count, const narc_chain_options *options,
                           narc_chain_entry *out_entries, size_t capacity, size_t *out_count, narc_error *error) {
    static const narc_chain_options defaults = {.closed = 0};
    const narc_chain_options *const chosen = options ? options : &defaults;
    if (!shapes || !arcs || !out_count || (!out_entries && capacity))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !shapes      ? "shapes"
                         : !arcs      ? "arcs"
                         : !out_count ? "out_count"
                                      : "out_entries");
    if (!(chosen->weld >= 0 && chosen->least_radius >= 0))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "weld is %g and the least radius %g, not 0 or more",
                         chosen->weld, chosen->least_radius);
    if (!(chosen->thickness >= 0))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)chosen->thickness, "the thickness is %g, not 0 or more",
                         (double)chosen->thickness);
    for (size_t k = 0; k < sizeof chosen->reserved / sizeof *chosen->reserved; k++)
        if (chosen->reserved[k])
            return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "options.reserved is not NULL");
    if (count == 0 || count > max_count)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "the chain has %zu arcs, not 1 to %zu", count,
                         max_count);
    const narc_allocator allocator = shapes->allocator;
    side sides[2] = {{.count = 0}, {.count = 0}};
    narc_status status = read_sides(arcs, count, chosen, &allocator, sides, error);
    if (status == NARC_OK)
        status = add_pieces(shapes, sides, chosen->first_run, out_entries, capacity, out_count, error);
    for (int k = 0; k < 2; k++)
        release_side(&sides[k], &allocator);
    return status;
}
