/* SPDX-License-Identifier: MIT
 *
 * refine.c - narc_refine_contacts(): what the features of rows say, in double precision.
 *
 * Two arcs touch along the line of their centres, as far apart as these are, less both radii. An edge is a tangent of the
 * arcs before and behind it: its normal n has the same height over both, n.u = r - r' with u from one centre to the other.
 * What touches an edge is as far from it as the height along n says. Nothing is computed but + - * / and sqrt, so bits are
 * the same everywhere.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "vec2.h"

#include <math.h>

/* Rows in a range: some 20 microseconds of work. */
enum { RANGE = 512 };

/* Where the direction of two centres differs more than this from the row's normal, the centres lie in one place up to
 * rounding: then the row's counts. It is the cosine of some 25 degrees. */
static const double LEAST_AGREEMENT = 0.9;

static narc_point scale_by(double s, narc_point a) { return (narc_point){s * a.x, s * a.y}; }

typedef struct refine_job {
    narc_batch batch;
    const narc_refinement *with;
    const narc_contact *rows;
    narc_refined_contact *out;
} refine_job;

/* ------------------------------------------------------------------------------------------------ bodies */

/* A body of a pair: where it is from A, and its rotation times its scale. */
typedef struct placed {
    const narc_shape_header *header;
    const narc_record *stored;
    const narc_arc *arcs; /* the caller's, or NULL */
    size_t count;
    narc_point position, turn;
    double scale;
} placed;

typedef struct circle {
    narc_point center;
    double radius; /* of a concave arc below 0, or -0 */
} circle;

typedef struct edge {
    circle before, behind;
    narc_point normal; /* outwards */
    bool endless;      /* a half-plane's */
} edge;

static size_t count_arcs(const narc_shape_header *header) {
    return header->flags & NARC_SHAPE_CIRCLE ? 1 : header->count;
}

static placed place_body(const refine_job *job, size_t pair, int side) {
    const narc_batch *batch = &job->batch;
    const narc_bodies *set = side == 0 ? batch->a : batch->b;
    const narc_index_column index = side == 0 ? batch->pairs->a : batch->pairs->b;
    const size_t item = index.base ? narc_index_at(index, pair) : pair;
    const struct narc_side named = narc_find_side(batch, pair, side);
    const bool other = side == 1 && batch->pairs->other_bodies;
    const narc_position_column cosine = other ? job->with->other_cosine : job->with->cosine;
    const narc_position_column sine = other ? job->with->other_sine : job->with->sine;
    const double c = cosine.base ? narc_position_at(cosine, named.body) : (double)narc_float_at(set->cosine, item);
    const double s = sine.base ? narc_position_at(sine, named.body) : (double)narc_float_at(set->sine, item);
    placed p = {.header = &batch->shapes->headers[named.shape],
                .arcs = job->with->arcs ? job->with->arcs[named.shape] : NULL,
                .position = {narc_position_at(set->x, item), narc_position_at(set->y, item)},
                .scale = (double)narc_float_or(set->scale, item, 1)};
    p.stored = narc_arcs_of(batch->shapes, p.header);
    p.count = count_arcs(p.header);
    p.turn = scale_by(p.scale / sqrt(c * c + s * s), (narc_point){c, s});
    return p;
}

/* B's position, from that of A, with the pair's shift. */
static narc_point find_way(const refine_job *job, size_t pair, const placed *a, const placed *b) {
    const narc_refinement *with = job->with;
    const narc_pairs *pairs = job->batch.pairs;
    const narc_point way = narc_subtract(b->position, a->position);
    const double x =
        with->shift_x.base ? narc_position_at(with->shift_x, pair) : (double)narc_float_or(pairs->shift_x, pair, 0);
    const double y =
        with->shift_y.base ? narc_position_at(with->shift_y, pair) : (double)narc_float_or(pairs->shift_y, pair, 0);
    return (narc_point){way.x + x, way.y + y};
}

static circle place_arc(const placed *p, size_t arc) {
    double x, y, radius;
    if (p->arcs) {
        x = p->arcs[arc].center_x;
        y = p->arcs[arc].center_y;
        radius = p->arcs[arc].radius;
    } else {
        const size_t first = p->header->first_arc & NARC_FIRST_ARC;
        const narc_stored_arc *stored = &p->stored[arc < first ? arc + p->count - first : arc - first].arc;
        x = (double)stored->center_x;
        y = (double)stored->center_y;
        radius = (double)stored->radius;
    }
    const narc_point from_origin = {p->turn.x * x - p->turn.y * y, p->turn.y * x + p->turn.x * y};
    return (circle){narc_add_scaled(p->position, 1, from_origin), p->scale * radius};
}

static edge place_edge(const placed *p, size_t number) {
    edge e = {.endless = narc_is_plane(p->header),
              .before = place_arc(p, number > 0 ? number - 1 : p->count - 1),
              .behind = place_arc(p, number)};
    const narc_point u = narc_subtract(e.behind.center, e.before.center);
    const double square = narc_dot(u, u), rise = e.before.radius - e.behind.radius;
    const double length = sqrt(fmax(square - rise * rise, 0));
    e.normal = e.endless
                   ? scale_by(1 / p->scale, (narc_point){-p->turn.y, p->turn.x}) /* also where centres are far away */
                   : scale_by(1 / square, narc_add_scaled(scale_by(rise, u), length, (narc_point){u.y, -u.x}));
    return e;
}

/* ------------------------------------------------------------------------------------------------ rows */

static narc_refined_contact make_row(double separation, narc_point normal, narc_point point) {
    return (narc_refined_contact){separation, normal.x, normal.y, point.x, point.y};
}

/* Where a centre lies within a concave arc, away from it is towards the arc. */
static narc_refined_contact meet_arcs(circle a, circle b, narc_point told) {
    const narc_point u = narc_subtract(b.center, a.center);
    const double distance = sqrt(narc_dot(u, u)), sign = signbit(a.radius) || signbit(b.radius) ? -1 : 1;
    narc_point n = scale_by(sign / distance, u);
    double along = sign * distance;
    if (!(narc_dot(n, told) > LEAST_AGREEMENT)) {
        n = told;
        along = narc_dot(n, u);
    }
    const double separation = along - (a.radius + b.radius);
    return make_row(separation, n, narc_add_scaled(a.center, a.radius + 0.5 * separation, n));
}

/* An arc over an edge, of B over A's; `sign` -1: of A over B's. */
static narc_refined_contact meet_edge(edge e, circle c, double sign) {
    const double separation = narc_dot(e.normal, narc_subtract(c.center, e.behind.center)) - e.behind.radius - c.radius;
    return make_row(separation, scale_by(sign, e.normal),
                    narc_add_scaled(c.center, -(c.radius + 0.5 * separation), e.normal));
}

/* How far an edge of B is over one of A along a normal. */
static double find_height(const edge *a, const edge *b, narc_point n) {
    const double top =
        fmax(narc_dot(n, a->before.center) + a->before.radius, narc_dot(n, a->behind.center) + a->behind.radius);
    return fmin(narc_dot(n, b->before.center) - b->before.radius, narc_dot(n, b->behind.center) - b->behind.radius) -
           top;
}

/* Of an edge's ends along a tangent the lower one [0] and the higher one. */
static void find_ends(const edge *e, narc_point tangent, double *out_ends) {
    const double before = narc_dot(tangent, narc_add_scaled(e->before.center, e->before.radius, e->normal));
    const double behind = narc_dot(tangent, narc_add_scaled(e->behind.center, e->behind.radius, e->normal));
    out_ends[0] = e->endless ? -INFINITY : fmin(before, behind);
    out_ends[1] = e->endless ? INFINITY : fmax(before, behind);
}

/* The separation is the larger one along both normals, or along that of an edge without end, the point the middle of the
 * common stretch. */
static narc_refined_contact meet_edges(edge a, edge b) {
    const narc_point opposite = scale_by(-1, b.normal);
    const double along_a = b.endless ? -INFINITY : find_height(&a, &b, a.normal),
                 along_b = a.endless ? -INFINITY : find_height(&a, &b, opposite);
    const narc_point n = along_a >= along_b ? a.normal : opposite, tangent = {-n.y, n.x};
    const double separation = fmax(along_a, along_b);
    const double top =
        fmax(narc_dot(n, a.before.center) + a.before.radius, narc_dot(n, a.behind.center) + a.behind.radius);
    double of_a[2], of_b[2];
    find_ends(&a, tangent, of_a);
    find_ends(&b, tangent, of_b);
    const double middle = 0.5 * (fmax(of_a[0], of_b[0]) + fmin(of_a[1], of_b[1]));
    return make_row(separation, n, narc_add_scaled(scale_by(top + 0.5 * separation, n), middle, tangent));
}

static narc_refined_contact refine_row(const refine_job *job, const narc_contact *row) {
    placed a = place_body(job, row->pair, 0), b = place_body(job, row->pair, 1);
    const size_t i = row->feature & (NARC_FEATURE_EDGE - 1), j = row->feature >> 8 & (NARC_FEATURE_EDGE - 1);
    const bool edge_a = row->feature & NARC_FEATURE_EDGE, edge_b = row->feature >> 8 & NARC_FEATURE_EDGE;
    b.position = find_way(job, row->pair, &a, &b);
    a.position = (narc_point){0, 0};
    if (edge_a && edge_b)
        return meet_edges(place_edge(&a, i), place_edge(&b, j));
    if (edge_a)
        return meet_edge(place_edge(&a, i), place_arc(&b, j), 1);
    if (edge_b)
        return meet_edge(place_edge(&b, j), place_arc(&a, i), -1);
    const narc_point told = {(double)row->normal_x, (double)row->normal_y};
    return meet_arcs(place_arc(&a, i), place_arc(&b, j), scale_by(1 / sqrt(narc_dot(told, told)), told));
}

static void refine_range(void *argument, size_t part, size_t first, size_t end) {
    const refine_job *const job = argument;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_contact *row = &job->rows[k];
        narc_refined_contact out = make_row((double)row->separation, (narc_point){0, 0}, (narc_point){0, 0});
        if (row->count > 0)
            out = refine_row(job, row);
        if (!isfinite(out.separation + out.normal_x + out.normal_y + out.point_x + out.point_y))
            out = make_row(INFINITY, (narc_point){0, 0}, (narc_point){0, 0});
        job->out[k] = out;
    }
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_columns(const narc_refinement *with, narc_error *error) {
    const struct {
        const char *name;
        narc_position_column x, y;
    } both[] = {{"refinement.rotation", with->cosine, with->sine},
                {"refinement.other_rotation", with->other_cosine, with->other_sine},
                {"refinement.shift", with->shift_x, with->shift_y}};
    narc_status status = narc_check_reserved(with->reserved, 2, "refinement", error);
    for (size_t k = 0; k < 3 && status == NARC_OK; k++)
        if (both[k].x.base || both[k].y.base)
            status = narc_check_positions(both[k].name, both[k].x, both[k].y, error);
    return status;
}

static narc_status check_rows(const refine_job *job, size_t count, narc_error *error) {
    for (size_t k = 0; k < count; k++) {
        const narc_contact *row = &job->rows[k];
        if (row->pair >= job->batch.pairs->count)
            return narc_fail(error, NARC_ERROR_INDEX, k, row->pair, "row %zu: pair is %lu, but there are %zu pairs", k,
                             (unsigned long)row->pair, job->batch.pairs->count);
        for (int side = 0; side < 2 && row->count > 0; side++) {
            const unsigned number = row->feature >> 8 * side & (NARC_FEATURE_EDGE - 1);
            const uint32_t shape = narc_find_side(&job->batch, row->pair, side).shape;
            if (number >= count_arcs(&job->batch.shapes->headers[shape]))
                return narc_fail(error, NARC_ERROR_INDEX, k, number,
                                 "row %zu: body %c touches with arc or edge %u, but its shape %lu has fewer", k,
                                 "ab"[side], number, (unsigned long)shape);
        }
    }
    return NARC_OK;
}

narc_status narc_refine_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                 const narc_refinement *refinement, const narc_contact *rows, size_t count,
                                 narc_refined_contact *out_rows, narc_error *error) {
    static const narc_refinement nothing = {0};
    refine_job job = {.with = refinement ? refinement : &nothing, .rows = rows, .out = out_rows};
    const narc_query query = {.workers = job.with->workers};
    narc_status status = narc_begin_batch(shapes, bodies, pairs, &query, &job.batch, error);
    if (status == NARC_OK)
        status = check_columns(job.with, error);
    if (status != NARC_OK || count == 0)
        return status;
    if (!rows || !out_rows)
        return narc_fail_missing(error, rows ? "out_rows" : "rows");
    status = check_rows(&job, count, error);
    if (status == NARC_OK)
        narc_run_ranges(query.workers, count, RANGE, refine_range, &job);
    return status;
}
