/* SPDX-License-Identifier: MIT
 *
 * plain.c - two tests for n-arcs as one would first write them: one pair after the other, in double precision.
 *
 * Both look for two arcs, one of each shape, such that each centre lies in the sector of the other arc. The published
 * test wants the vector between the centres to point the same way as that between the centroids as well, and believes
 * the first such pair of arcs. The exact test takes the largest gap of all such pairs.
 */
#include <math.h>

#include "peers.h"

static double cross(double a_x, double a_y, double b_x, double b_y) { return a_x * b_y - a_y * b_x; }

/* B in A's axes. The centroid of an outline is its origin: B's is at `x`, `y`. */
struct relative {
    double x, y;
    size_t count;
    struct arc arcs[MAX_EDGES + 1];
};

static void relate(const struct body *a, const struct body *b, const struct outline *outline, struct relative *out) {
    const double x = (double)b->x - a->x, y = (double)b->y - a->y;
    const double c = (double)a->cosine * b->cosine + (double)a->sine * b->sine;
    const double s = (double)a->cosine * b->sine - (double)a->sine * b->cosine;
    out->x = a->cosine * x + a->sine * y;
    out->y = a->cosine * y - a->sine * x;
    out->count = outline->count;
    for (size_t k = 0; k <= outline->count; k++) {
        const struct arc *arc = &outline->arcs[k];
        out->arcs[k].x = c * arc->x - s * arc->y + out->x;
        out->arcs[k].y = s * arc->x + c * arc->y + out->y;
        out->arcs[k].radius = arc->radius;
        out->arcs[k].start_x = c * arc->start_x - s * arc->start_y;
        out->arcs[k].start_y = s * arc->start_x + c * arc->start_y;
    }
}

/* Does each arc's sector hold the other's centre, u away? */
static bool face_each_other(const struct arc *a, const struct arc *b, double u_x, double u_y) {
    return cross(u_x, u_y, a[1].start_x, a[1].start_y) >= 0 && cross(u_x, u_y, a->start_x, a->start_y) < 0 &&
           cross(u_x, u_y, b[1].start_x, b[1].start_y) < 0 && cross(u_x, u_y, b->start_x, b->start_y) >= 0;
}

static bool published_test(const struct outline *a, const struct relative *b) {
    for (size_t i = 0; i < a->count; i++) {
        for (size_t j = 0; j < b->count; j++) {
            const double x = b->arcs[j].x - a->arcs[i].x, y = b->arcs[j].y - a->arcs[i].y;
            if (face_each_other(&a->arcs[i], &b->arcs[j], x, y) && x * b->x + y * b->y > 0) {
                const double radii = a->arcs[i].radius + b->arcs[j].radius;
                return radii * radii > x * x + y * y;
            }
        }
    }
    return false;
}

static bool exact_test(const struct outline *a, const struct relative *b) {
    double gap = -INFINITY;
    for (size_t i = 0; i < a->count; i++) {
        for (size_t j = 0; j < b->count; j++) {
            const double x = b->arcs[j].x - a->arcs[i].x, y = b->arcs[j].y - a->arcs[i].y;
            if (face_each_other(&a->arcs[i], &b->arcs[j], x, y)) {
                const double value = sqrt(x * x + y * y) - (a->arcs[i].radius + b->arcs[j].radius);
                gap = value > gap ? value : gap;
            }
        }
    }
    return gap < 0;
}

static void *create(const struct workload *workload) {
    return (void *)(uintptr_t)workload; /* not changed, but every peer's context may be */
}

static void run_all(const struct workload *workload, const struct pair *pairs, size_t count, uint8_t *out_colliding,
                    bool (*test)(const struct outline *a, const struct relative *b)) {
    for (size_t k = 0; k < count; k++) {
        const struct body *a = &workload->bodies[pairs[k].a], *b = &workload->bodies[pairs[k].b];
        struct relative relative;
        relate(a, b, &workload->outlines[b->shape], &relative);
        out_colliding[k] = test(&workload->outlines[a->shape], &relative);
    }
}

static void run_paper(void *context, const struct pair *pairs, size_t count, uint8_t *out_colliding) {
    run_all(context, pairs, count, out_colliding, published_test);
}

static void run_exact(void *context, const struct pair *pairs, size_t count, uint8_t *out_colliding) {
    run_all(context, pairs, count, out_colliding, exact_test);
}

const struct peer plain_paper = {
    .name = "plain-paper", .query = "overlap", .max_edges = MAX_EDGES, .create = create, .run = run_paper};
const struct peer plain_exact = {
    .name = "plain-exact", .query = "overlap", .max_edges = MAX_EDGES, .create = create, .run = run_exact};
