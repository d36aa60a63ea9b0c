/* SPDX-License-Identifier: MIT
 *
 * chain_arcs.c - a chain of pieces in the form of shapes: arcs with the angles of their normals.
 */
#include <math.h>

#include "error.h"
#include "narc_fit.h"
#include "outline/vector.h"

/* Pieces whose tangents differ by less than this have a common one. */
static const double SMOOTH = 1e-6;

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
    const double turn = remainder(next - to->normal, 2 * PI);
    if (fabs(turn) > SMOOTH || is_end)
        to->arcs[to->count++] =
            (narc_arc){at.x, at.y, turn < 0 ? -0.0 : 0.0, to->normal, is_end ? to->normal : to->normal + turn};
    to->normal += turn;
}

static void put_piece(writer *to, const narc_curve_arc *piece) {
    if (piece->turn == 0)
        return;
    to->arcs[to->count++] =
        (narc_arc){piece->center.x, piece->center.y, piece->turn < 0 ? -piece->radius : piece->radius, to->normal,
                   to->normal + piece->turn};
    to->normal += piece->turn;
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
