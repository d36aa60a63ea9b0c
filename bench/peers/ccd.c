/* SPDX-License-Identifier: MIT
 *
 * ccd.c - libccd's GJK and MPR, on n-arcs through a support function.
 *
 * libccd works in three dimensions: an n-arc becomes a prism, from z = -1/2 to 1/2.
 */
#include <ccd/ccd.h>
#include <math.h>

#include "common.h"
#include "peers.h"

struct solid {
    const struct outline *outline;
    double x, y, cosine, sine;
};

struct context {
    struct solid *solids; /* one for each body */
    ccd_t settings;
};

static double cross(double a_x, double a_y, double b_x, double b_y) { return a_x * b_y - a_y * b_x; }

/* The arc whose normals hold the direction, and its point there. */
static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out) {
    const struct solid *solid = object;
    const double d_x = direction->v[0], d_y = direction->v[1], length = sqrt(d_x * d_x + d_y * d_y);
    double x = 0, y = 0;
    if (length > 0) {
        const double n_x = (solid->cosine * d_x + solid->sine * d_y) / length;
        const double n_y = (solid->cosine * d_y - solid->sine * d_x) / length;
        const struct arc *arc = solid->outline->arcs;
        for (size_t k = 0; k < solid->outline->count; k++, arc++)
            if (cross(arc->start_x, arc->start_y, n_x, n_y) >= 0 && cross(arc[1].start_x, arc[1].start_y, n_x, n_y) < 0)
                break;
        x = arc->x + arc->radius * n_x;
        y = arc->y + arc->radius * n_y;
    }
    ccdVec3Set(out, solid->x + solid->cosine * x - solid->sine * y, solid->y + solid->sine * x + solid->cosine * y,
               direction->v[2] < 0 ? -0.5 : 0.5);
}

static void center(const void *object, ccd_vec3_t *out) {
    const struct solid *solid = object;
    ccdVec3Set(out, solid->x, solid->y, 0);
}

static void *create(struct scene *scene) {
    struct context *context = allocate(1, sizeof *context);
    context->solids = allocate(scene->body_count, sizeof *context->solids);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *body = &scene->bodies[k];
        const double length = hypot(body->cosine, body->sine);
        context->solids[k] =
            (struct solid){&scene->outlines[body->shape], body->x, body->y, body->cosine / length, body->sine / length};
    }
    CCD_INIT(&context->settings);
    context->settings.support1 = context->settings.support2 = support;
    context->settings.center1 = context->settings.center2 = center;
    context->settings.max_iterations = 100; /* its default, no limit, need not end on curved shapes */
    return context;
}

static size_t ask_gjk(void *argument, const struct asked *asked, void *out) {
    const struct context *context = argument;
    uint8_t *out_colliding = out;
    for (size_t k = 0; k < asked->count; k++)
        out_colliding[k] = ccdGJKIntersect(&context->solids[asked->pairs[k].a], &context->solids[asked->pairs[k].b],
                                           &context->settings) != 0;
    return 0;
}

static size_t ask_mpr(void *argument, const struct asked *asked, void *out) {
    const struct context *context = argument;
    uint8_t *out_colliding = out;
    for (size_t k = 0; k < asked->count; k++)
        out_colliding[k] = ccdMPRIntersect(&context->solids[asked->pairs[k].a], &context->solids[asked->pairs[k].b],
                                           &context->settings) != 0;
    return 0;
}

const struct peer ccd_gjk = {
    .question = "overlap", .name = "ccd-gjk", .arcs = true, .max_edges = MAX_EDGES, .create = create, .ask = ask_gjk};
const struct peer ccd_mpr = {
    .question = "overlap", .name = "ccd-mpr", .arcs = true, .max_edges = MAX_EDGES, .create = create, .ask = ask_mpr};
