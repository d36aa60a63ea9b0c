/* SPDX-License-Identifier: MIT
 *
 * path_arcs.c - the contours of a path as chains of arcs: narc_fit_bezier() for each line and curve.
 */
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "outline/path.h"

struct builder {
    narc_arc_chains chains;
    size_t arc_capacity, end_capacity;
    double tolerance;
    narc_error *error;
};

static narc_status fail_memory(const struct builder *builder) {
    return narc_fail(builder->error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu arcs",
                     builder->chains.arc_count + 1);
}

/* Adds a line or curve: once to count its arcs, once to have them. */
static narc_status add_curve(struct builder *builder, const narc_point *controls, size_t degree) {
    size_t count;
    double distance;
    narc_status status =
        narc_fit_bezier(controls, degree, builder->tolerance, NULL, 0, &count, &distance, builder->error);
    if (status || count == 0)
        return status;
    narc_arc_chains *chains = &builder->chains;
    narc_curve_arc *arcs = narc_grow(chains->arcs, &builder->arc_capacity, chains->arc_count + count, sizeof *arcs);
    if (!arcs)
        return fail_memory(builder);
    chains->arcs = arcs;
    status = narc_fit_bezier(controls, degree, builder->tolerance, arcs + chains->arc_count, count, &count, &distance,
                             builder->error);
    chains->arc_count += count;
    chains->distance = fmax(chains->distance, distance);
    return status;
}

/* Closes the contour that began at `start`, if anything was drawn of it. */
static narc_status end_contour(struct builder *builder, narc_point start, narc_point pen) {
    narc_arc_chains *chains = &builder->chains;
    const narc_point closing[2] = {pen, start};
    const narc_status status = add_curve(builder, closing, 1);
    if (status || chains->arc_count == (chains->count ? chains->ends[chains->count - 1] : 0))
        return status;
    size_t *ends = narc_grow(chains->ends, &builder->end_capacity, chains->count + 1, sizeof *ends);
    if (!ends)
        return fail_memory(builder);
    chains->ends = ends;
    ends[chains->count++] = chains->arc_count;
    return NARC_OK;
}

static narc_status add_moves(struct builder *builder, const narc_path *path) {
    const narc_point *next = path->points;
    narc_point start = {0, 0}, pen = {0, 0};
    narc_status status = NARC_OK;
    for (size_t k = 0; k < path->move_count && !status; k++) {
        const unsigned degree = path->degrees[k];
        if (degree > 0) {
            status = add_curve(builder, next - 1, degree); /* the pen's place stands before the move's points */
        } else {
            status = end_contour(builder, start, pen);
            start = next[0];
        }
        next += narc_count_move_points(degree);
        pen = next[-1];
    }
    return status ? status : end_contour(builder, start, pen);
}

narc_status narc_fit_chains(const narc_path *path, double tolerance, narc_arc_chains *out_chains, narc_error *error) {
    if (!path || !out_chains)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", path ? "out_chains" : "path");
    struct builder builder = {.tolerance = tolerance, .error = error};
    narc_status status = add_moves(&builder, path);
    if (!status && builder.chains.count == 0)
        status = narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the path has no lines and no curves");
    if (status)
        narc_release_chains(&builder.chains);
    else
        *out_chains = builder.chains;
    return status;
}

void narc_release_chains(narc_arc_chains *chains) {
    free(chains->arcs);
    free(chains->ends);
    *chains = (narc_arc_chains){0};
}
