/* SPDX-License-Identifier: MIT
 *
 * chain_arcs.c - a chain of pieces in the form of shapes: arcs with the angles of their normals.
 */
#include <math.h>

#include "error.h"
#include "narc_fit.h"
#include "outline/vector.h"

/* Where the tangent has turned by less than this since the arc before, it goes on. What turns by more is a corner, and one
 * turns by NARC_TOLERANCE at least; so it may turn too far, by half of what normals of an edge and its arcs may differ. */
static const double SMOOTH = NARC_TOLERANCE / 2, LEAST_TURN = NARC_TOLERANCE * (1 + 0x1p-4);

/* The angle of the normal to the right of a piece at its start. */
static double find_normal(const narc_curve_arc *piece) {
    if (piece->turn == 0) {
        const narc_point along_line = minus(piece->end, piece->start);
        return narc_atan2(-along_line.x, along_line.y);
    }
    const narc_point away = minus(piece->start, piece->center);
    return piece->turn > 0 ? narc_atan2(away.y, away.x) : narc_atan2(-away.y, -away.x);
}

typedef struct writer {
    narc_arc *arcs;
    size_t count;
    double normal; /* at the end of what is written */
} writer;

/* A corner or valley where a piece begins, if it turns there, or a plain point. */
static void put_corner(writer *to, narc_point at, double next, bool is_end) {
    double turn = remainder(next - to->normal, 2 * PI);
    turn = fabs(turn) > SMOOTH && !is_end ? copysign(fmax(fabs(turn), LEAST_TURN), turn) : 0;
    if (turn != 0 || is_end)
        to->arcs[to->count++] = (narc_arc){at.x, at.y, turn < 0 ? -0.0 : 0.0, to->normal, to->normal + turn};
    to->normal += turn;
}

/* An arc, in two halves if it turns by more than half a turn. */
static void put_piece(writer *to, const narc_curve_arc *piece) {
    const int parts = piece->turn == 0 ? 0 : fabs(piece->turn) > PI + SMOOTH ? 2 : 1;
    const double first = find_normal(piece), start = to->normal + remainder(first - to->normal, 2 * PI);
    for (int k = 0; k < parts; k++)
        to->arcs[to->count++] =
            (narc_arc){piece->center.x, piece->center.y, piece->turn < 0 ? -piece->radius : piece->radius,
                       start + piece->turn * k / parts, start + piece->turn * (k + 1) / parts};
    to->normal = parts ? start + piece->turn : to->normal;
}

narc_status narc_describe_chain(const narc_curve_arc *pieces, size_t count, bool closed, narc_arc *out_arcs,
                                size_t *out_count, narc_error *error) {
    if (!pieces || !out_arcs || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "pieces, out_arcs or out_count is NULL");
    if (count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "a chain without pieces");
    writer to = {.arcs = out_arcs, .normal = find_normal(&pieces[0])};
    if (closed) {
        const narc_curve_arc *last = &pieces[count - 1];
        to.normal = find_normal(last) + last->turn;
        put_corner(&to, pieces[0].start, find_normal(&pieces[0]), false);
    } else if (pieces[0].turn == 0) {
        put_corner(&to, pieces[0].start, to.normal, true);
    }
    for (size_t k = 0; k < count; k++) {
        if (k)
            put_corner(&to, pieces[k].start, find_normal(&pieces[k]), false);
        put_piece(&to, &pieces[k]);
    }
    if (!closed && pieces[count - 1].turn == 0)
        put_corner(&to, pieces[count - 1].end, to.normal, true);
    *out_count = to.count;
    return NARC_OK;
}
