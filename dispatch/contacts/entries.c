/* SPDX-License-Identifier: MIT
 *
 * entries.c - what is kept of pairs of smooth shapes (kernels/sat/follow.c).
 *
 * Of two bodies that touch it is the arcs with which they do. Of two that are apart it is a circle around each: that of
 * the shape's largest radius R which touches the shape from outside at its point nearest to the other body. As no arc is
 * flatter, the circle holds the shape, wherever the other body goes. Where bodies are well apart the bounding circles
 * serve, which hold at any angle.
 *
 * These circles are as large as the extent E, and their centres within 3 E. Where arcs were given a little apart
 * (NARC_TOLERANCE of the bounding radius, at each junction) a shape reaches as much beyond its circle. So their gap is off
 * by less than the arithmetic of arcs is with extents four times as large, and by these tolerances.
 */
#include "contacts/entries.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "broken.h"
#include "column.h"
#include "vec2.h"

/* A shape at its scale. */
struct side {
    const narc_shape_header *header;
    const narc_record *arcs;
    uint32_t shape;
    float scale;
    float cosine, sine; /* of the body */
};

/* B's pose in A's frame, but for the lengths of the bodies' rotations, which may be any. */
struct relative {
    narc_point position, rotation;
};

static narc_point rotate(narc_point q, narc_point p) {
    return (narc_point){q.x * p.x - q.y * p.y, q.y * p.x + q.x * p.y};
}

static narc_point unrotate(narc_point q, narc_point p) {
    return (narc_point){q.x * p.x + q.y * p.y, q.x * p.y - q.y * p.x};
}

static narc_point normalise(narc_point p) {
    const double length = sqrt(narc_dot(p, p));
    return (narc_point){p.x / length, p.y / length};
}

static struct side find_side(const narc_batch *batch, const narc_bodies *bodies, narc_index_column column, size_t pair,
                             size_t *out_body) {
    const size_t body = column.base ? narc_index_at(column, pair) : pair;
    const uint32_t shape = narc_index_at(bodies->shape, body);
    *out_body = body;
    return (struct side){.header = &batch->shapes->headers[shape],
                         .arcs = narc_arcs_of(batch->shapes, &batch->shapes->headers[shape]),
                         .shape = shape,
                         .scale = narc_float_or(bodies->scale, body, 1),
                         .cosine = narc_float_at(bodies->cosine, body),
                         .sine = narc_float_at(bodies->sine, body)};
}

static struct relative find_relative(const narc_batch *batch, const struct side *a, const struct side *b, size_t body_a,
                                     size_t body_b, size_t pair) {
    const narc_pairs *pairs = batch->pairs;
    const narc_point q = {(double)a->cosine, (double)a->sine};
    const narc_point d = {narc_position_at(batch->b->x, body_b) - narc_position_at(batch->a->x, body_a) +
                              (double)narc_float_or(pairs->shift_x, pair, 0),
                          narc_position_at(batch->b->y, body_b) - narc_position_at(batch->a->y, body_a) +
                              (double)narc_float_or(pairs->shift_y, pair, 0)};
    return (struct relative){unrotate(q, d), unrotate(q, (narc_point){(double)b->cosine, (double)b->sine})};
}

/* Is something to be kept of a shape? */
static bool is_kept(const struct side *s) {
    return (s->header->flags & NARC_SHAPE_SMOOTH) && !narc_is_piece(s->header) && s->header->extent_ratio < UINT8_MAX &&
           narc_is_size(s->scale * s->header->bound_radius);
}

static bool is_circle(const struct side *s) { return (s->header->flags & NARC_SHAPE_CIRCLE) != 0; }

static double find_size(const struct side *s) { return (double)s->scale * (double)s->header->bound_radius; }

/* ------------------------------------------------------------------------------------------------ arcs */

/* Normals are turned by a little more than what the kernel counts on, for what is rounded: 2^-15 in each half, and
 * as much where the lower one adds to the upper. */
#define TURN       (0x1p-10 + 0x1p-13)
#define NORMAL_ONE 32700.0 /* of normals that are longer than 1 by less than TURN */

static int32_t round_off(double value) { return (int32_t)(value < 0 ? value - 0.5 : value + 0.5); }

static uint32_t pack_normal(double x, double y) {
    return (uint32_t)round_off(y * NORMAL_ONE) << 16 | ((uint32_t)round_off(x * NORMAL_ONE) & 0xffff);
}

/* The ends of an arc. False if nothing is left between them. */
static bool turn_inwards(const narc_stored_arc *arc, uint32_t normal[2]) {
    const double s_x = (double)arc->start_x, s_y = (double)arc->start_y;
    const double e_x = (double)arc->end_x, e_y = (double)arc->end_y;
    normal[0] = pack_normal(s_x - TURN * s_y, s_y + TURN * s_x);
    normal[1] = pack_normal(e_x + TURN * e_y, e_y - TURN * e_x);
    return s_x * e_y - s_y * e_x > 4 * TURN || s_x * e_x + s_y * e_y < 0;
}

static double find_inner(const narc_stored_arc *arc) {
    const uint32_t bits = arc->inner_radii & 0xffff0000u;
    float inner;
    memcpy(&inner, &bits, sizeof inner);
    return (double)inner;
}

/* The number of an arc as the caller knows it. */
static uint32_t find_number(const struct side *s, unsigned arc) {
    return is_circle(s) ? 0 : (arc + s->header->first_arc) % s->header->count;
}

/* The arc of that number. */
static unsigned find_arc(const struct side *s, unsigned number) {
    return (number + s->header->count - s->header->first_arc) % s->header->count;
}

/* What is written of a pair; `ends` may be NULL. */
struct kept {
    narc_entry *entry;
    narc_entry_ends *ends;
};

/* `slack`: that of the extents. */
static void keep_arcs(const struct side *a, const struct side *b, unsigned arc_a, unsigned arc_b, double slack,
                      struct kept out) {
    const narc_stored_arc *p = &a->arcs[arc_a].arc, *q = &b->arcs[arc_b].arc;
    const double inner = (double)a->scale * find_inner(p) + (double)b->scale * find_inner(q);
    narc_entry entry = {.center_a = {a->scale * p->center_x, a->scale * p->center_y},
                        .center_b = {q->center_x, q->center_y},
                        .radius_a = a->scale * p->radius,
                        .radius_b = b->scale * q->radius,
                        .scale_b = b->scale,
                        .spare = (float)(inner - 1024 * slack),
                        .slack = (float)slack,
                        .feature = find_number(a, arc_a) | find_number(b, arc_b) << 8 | NARC_ENTRY_KNOWN};
    if ((!is_circle(a) && !turn_inwards(p, entry.normal)) || (!is_circle(b) && !turn_inwards(q, entry.normal + 2)))
        return;
    *out.entry = entry;
    if (!out.ends)
        return;
    memset(out.ends, 0, sizeof *out.ends);
    if (!is_circle(a))
        memcpy(out.ends->start_a, &p->start_x, 4 * sizeof(float));
    if (!is_circle(b))
        memcpy(out.ends->start_b, &q->start_x, 4 * sizeof(float));
}

/* ------------------------------------------------------------------------------------------------ apart */

/* The arc that holds a direction, exactly: in double precision a product of normals has its sign, and two arcs share the
 * normal of a junction. `count` if rounding leaves none. */
static unsigned find_holder(const struct side *s, narc_point n) {
    for (unsigned i = 0; i < s->header->count; i++) {
        const narc_stored_arc *arc = &s->arcs[i].arc;
        if ((double)arc->start_x * n.y - (double)arc->start_y * n.x >= 0 &&
            n.x * (double)arc->end_y - n.y * (double)arc->end_x >= 0)
            return i;
    }
    return s->header->count;
}

static double find_largest_radius(const struct side *s) {
    float largest = 0;
    for (unsigned i = 0; i < s->header->count; i++)
        largest = fmaxf(largest, s->arcs[i].arc.radius);
    return (double)largest;
}

/* Two circles that hold the bodies, in their shapes' units. */
struct circles {
    narc_point center_a, center_b;
    double radius_a, radius_b;
};

static void keep_circles(const struct side *a, const struct side *b, const struct circles *c, double slack,
                         struct kept out) {
    const double scale_a = (double)a->scale, scale_b = (double)b->scale;
    *out.entry = (narc_entry){.center_a = {(float)(scale_a * c->center_a.x), (float)(scale_a * c->center_a.y)},
                              .center_b = {(float)c->center_b.x, (float)c->center_b.y},
                              .radius_a = (float)(scale_a * c->radius_a),
                              .radius_b = (float)(scale_b * c->radius_b),
                              .scale_b = b->scale,
                              .spare = -INFINITY,
                              .slack = (float)slack,
                              .feature = NARC_ENTRY_KNOWN};
}

static narc_point find_difference(const struct side *a, const struct side *b, const struct relative *pose,
                                  narc_point of_a, narc_point of_b) {
    const double scale_a = (double)a->scale, scale_b = (double)b->scale;
    const narc_point at_b = rotate(pose->rotation, of_b);
    return (narc_point){pose->position.x + scale_b * at_b.x - scale_a * of_a.x,
                        pose->position.y + scale_b * at_b.y - scale_a * of_a.y};
}

/* By how much bounding circles must be apart to be kept, in proportion to their radii. */
#define WELL_APART 0.05

/* How often the search for the nearest arcs goes on. */
enum { MOST_STEPS = 8 };

/* Two bodies without a contact: keeps circles that are more than margin + slack apart, or the nearest arcs. */
static void keep_apart(const struct side *a, const struct side *b, const struct relative *pose, double margin,
                       double slack, struct kept out) {
    const double size_a = find_size(a), size_b = find_size(b), scale_a = (double)a->scale, scale_b = (double)b->scale;
    const double away = 0x1p-17 * (fabs(pose->position.x) + fabs(pose->position.y));
    struct circles c = {{(double)a->header->bound_x, (double)a->header->bound_y},
                        {(double)b->header->bound_x, (double)b->header->bound_y},
                        (double)a->header->bound_radius,
                        (double)b->header->bound_radius};
    narc_point u = find_difference(a, b, pose, c.center_a, c.center_b);
    double length = sqrt(narc_dot(u, u));
    if (length - size_a - size_b > margin + 2 * (away + slack) + WELL_APART * (size_a + size_b)) {
        keep_circles(a, b, &c, slack, out);
        return;
    }
    const double radius_a = find_largest_radius(a), radius_b = find_largest_radius(b);
    const double tolerance = NARC_TOLERANCE * (a->header->count * size_a + b->header->count * size_b);
    const double room = 4 * slack + tolerance, least = margin + 2 * (away + room);
    double most = -INFINITY;
    unsigned arc_a = UINT8_MAX, arc_b = UINT8_MAX;
    for (int step = 0; step < MOST_STEPS && length > 0; step++) {
        const narc_point n = {u.x / length, u.y / length};
        const narc_point n_b = normalise(unrotate(pose->rotation, (narc_point){-n.x, -n.y}));
        const unsigned i = find_holder(a, n), j = find_holder(b, n_b);
        if (i == a->header->count || j == b->header->count)
            return;
        const narc_stored_arc *p = &a->arcs[i].arc, *q = &b->arcs[j].arc;
        const narc_point of_p = {(double)p->center_x, (double)p->center_y},
                         of_q = {(double)q->center_x, (double)q->center_y};
        const double in_a = radius_a - (double)p->radius, in_b = radius_b - (double)q->radius;
        u = find_difference(a, b, pose, of_p, of_q);
        length = sqrt(narc_dot(u, u));
        const double gap = narc_dot(u, n) - scale_a * (double)p->radius - scale_b * (double)q->radius;
        if (gap > most) {
            most = gap;
            c = (struct circles){{of_p.x - in_a * n.x, of_p.y - in_a * n.y},
                                 {of_q.x - in_b * n_b.x, of_q.y - in_b * n_b.y},
                                 radius_a,
                                 radius_b};
        }
        if (i == arc_a && j == arc_b)
            break;
        arc_a = i;
        arc_b = j;
    }
    if (most > least)
        keep_circles(a, b, &c, room, out);
    else if (arc_a < a->header->count && arc_b < b->header->count)
        keep_arcs(a, b, arc_a, arc_b, slack, out);
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* The feature of a row, UINT32_MAX where there is none. */
static uint32_t read_feature(const narc_batch *batch, const char *row) {
    narc_contact contact;
    narc_manifold manifold;
    if (batch->row_size == sizeof manifold) {
        memcpy(&manifold, row, sizeof manifold);
        return manifold.count > 0 ? manifold.point[0].feature : UINT32_MAX;
    }
    memcpy(&contact, row, sizeof contact);
    return contact.count > 0 ? contact.feature : UINT32_MAX;
}

static void make_entry(const narc_batch *batch, size_t pair, const char *row, struct kept out) {
    size_t body_a, body_b;
    const struct side a = find_side(batch, batch->a, batch->pairs->a, pair, &body_a);
    const struct side b = find_side(batch, batch->b, batch->pairs->b, pair, &body_b);
    const uint32_t feature = read_feature(batch, row);
    memset(out.entry, 0, sizeof *out.entry);
    if (!is_kept(&a) || !is_kept(&b))
        return;
    /* as in find_slack() of kernels/base/pair_setup.inl, and as much again as rounding takes */
    const double slack =
        0x1.00001p-17 * (find_size(&a) * a.header->extent_ratio + find_size(&b) * b.header->extent_ratio);
    if (feature != UINT32_MAX) {
        const unsigned number_a = feature & 0xff, number_b = feature >> 8 & 0xff;
        if (number_a < a.header->count && number_b < b.header->count)
            keep_arcs(&a, &b, find_arc(&a, number_a), find_arc(&b, number_b), slack, out);
        return;
    }
    const struct relative pose = find_relative(batch, &a, &b, body_a, body_b, pair);
    const double margin = (double)narc_float_or(batch->query->margins, pair, batch->query->margin);
    keep_apart(&a, &b, &pose, margin, slack, out);
}

void narc_make_entries(const narc_batch *batch, size_t first, size_t count, const uint32_t *pairs, const void *rows,
                       ptrdiff_t row_stride, narc_entry *entries, narc_entry_ends *ends) {
    for (size_t k = 0; k < count; k++) {
        const size_t pair = pairs ? pairs[k] : narc_pair_at(batch, first + k);
        make_entry(batch, pair, (const char *)rows + (ptrdiff_t)pair * row_stride,
                   (struct kept){&entries[pair], ends ? &ends[pair] : NULL});
    }
}
