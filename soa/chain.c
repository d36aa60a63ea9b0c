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

static narc_status read_arc(const narc_arc *arc, size_t i, const narc_chain_options *options, narc_chain_arc *out_arc,
                            narc_error *error) {
    const double numbers[] = {arc->center_x, arc->center_y, arc->radius, arc->start, arc->end};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (!(fabs(numbers[k]) <= NARC_MAX_DISTANCE))
            return narc_fail(error, isfinite(numbers[k]) ? NARC_ERROR_SIZE : NARC_ERROR_NOT_FINITE, i, numbers[k],
                             "arc %zu: a number is %g", i, numbers[k]);
    const bool is_concave = signbit(arc->radius);
    double turn = is_concave ? arc->start - arc->end : arc->end - arc->start;
    *out_arc = (narc_chain_arc){
        .x = arc->center_x, .y = arc->center_y, .radius = arc->radius, .start = arc->start, .number = (uint32_t)i};
    if (arc->radius == 0 && fabs(turn) <= NARC_TOLERANCE) {
        out_arc->radius = 0;
        return NARC_OK;
    }
    turn += turn < 0 ? 2 * NARC_PI : 0;
    if (!(turn >= NARC_TOLERANCE && turn <= NARC_PI + NARC_TOLERANCE))
        return narc_fail(error, NARC_ERROR_SWEEP, i, turn, "arc %zu: sweep is %.9g rad%s, %s", i, turn,
                         is_concave ? " clockwise" : "",
                         turn < NARC_TOLERANCE ? "it turns by nothing" : "more than half a turn");
    if (is_concave && -arc->radius < options->least_radius)
        return narc_fail(error, NARC_ERROR_RADIUS, i, arc->radius, "arc %zu: concave with the radius %.9g, below %.9g",
                         i, -arc->radius, options->least_radius);
    out_arc->turn = is_concave ? -turn : turn;
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
    for (size_t i = 0; i < count && !(found && signbit(arcs[first].radius)) && closed; i++) {
        const bool turns = !(arcs[i].radius == 0 && fabs(arcs[i].end - arcs[i].start) <= NARC_TOLERANCE);
        if (turns && (!found || signbit(arcs[i].radius))) {
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
        narc_status status = read_arc(&arcs[i], i, options, &arc, error);
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

/* ------------------------------------------------------------------------------------------------ adding */

/* Divides a chain that is read: first to count and to find what is wrong, then, with room for all, into the store. */
static narc_status add_pieces(narc_shapes *shapes, const narc_chain *chain, const narc_curves *curves,
                              uint32_t first_run, narc_chain_entry *out_entries, size_t capacity, size_t *out_count,
                              narc_error *error) {
    narc_chain_division division = {.run = first_run};
    narc_status status = narc_divide_chain(chain, curves, &division, error);
    if (status != NARC_OK)
        return status;
    if (division.count == 0)
        return narc_fail(error, NARC_ERROR_SIZE, 0, 0, "the chain has no length");
    if (division.count > capacity) {
        *out_count = division.count;
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)division.count,
                         "there is room for %zu entries, not for %zu", capacity, division.count);
    }
    status = narc_make_room(shapes, narc_count_shapes(shapes) + division.count, division.records);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, (double)division.count, "no room for %zu shapes beside the other %zu",
                         division.count, narc_count_shapes(shapes));
    division = (narc_chain_division){.shapes = shapes, .entries = out_entries, .run = first_run};
    status = narc_divide_chain(chain, curves, &division, error);
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
    for (int k = 0; k < 4; k++)
        if (chosen->reserved[k])
            return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "options.reserved is not NULL");
    if (count == 0 || count > max_count)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "the chain has %zu arcs, not 1 to %zu", count,
                         max_count);
    const narc_allocator allocator = shapes->allocator;
    narc_chain chain = {.closed = chosen->closed != 0};
    narc_curves curves = {.count = 0};
    if (count < SIZE_MAX / sizeof *chain.arcs)
        chain.arcs = allocator.allocate((count + 1) * sizeof *chain.arcs, allocator.context);
    if (!chain.arcs)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for %zu arcs", count);
    narc_status status = read_chain(arcs, count, chosen, &chain, error);
    if (status == NARC_OK)
        status = narc_build_curves(&chain, &allocator, &curves, error);
    if (status == NARC_OK)
        status = narc_check_crossings(&curves, error);
    if (status == NARC_OK)
        status = add_pieces(shapes, &chain, &curves, chosen->first_run, out_entries, capacity, out_count, error);
    if (curves.curves)
        allocator.release(curves.curves, allocator.context);
    allocator.release(chain.arcs, allocator.context);
    return status;
}
