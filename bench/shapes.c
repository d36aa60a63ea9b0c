/* SPDX-License-Identifier: MIT
 *
 * shapes.c - the random shapes of the benchmarks.
 */
#include "shapes.h"

#include <math.h>

#include "arcs.h"
#include "random.h"

/* Of rounded polygons. */
static const double corner_radius = 0.2;

static size_t list_arcs(const struct outline *outline, narc_arc *out) {
    for (size_t k = 0; k < outline->count; k++) {
        const struct arc *arc = &outline->arcs[k], *next = arc + 1;
        out[k] = (narc_arc){arc->x, arc->y, arc->radius, atan2(arc->start_y, arc->start_x),
                            atan2(next->start_y, next->start_x)};
    }
    if (outline->count == 1) {
        out[0].start = 0;
        out[0].end = 2 * pi;
    }
    return outline->count;
}

/* The junction normals are up to 0.3 of a sector away from equal angles. The radii, as a function of the angle, have a
 * second and a third harmonic (long shapes and blunt triangles), up to 15 % noise, and what closes the outline. */
static void try_n_arc(uint64_t *random, size_t n, narc_arc *out) {
    const double turn = random_between(random, 0, 2 * pi), second = random_between(random, 0, 0.6);
    const double third = n > 5 ? random_between(random, 0, 0.25) : 0;
    const double phase2 = random_between(random, 0, 2 * pi), phase3 = random_between(random, 0, 2 * pi);
    for (size_t k = 0; k < n; k++) {
        const double middle = turn + 2 * pi / (double)n * ((double)k + 0.5);
        out[k].start = turn + 2 * pi / (double)n * ((double)k + random_between(random, -0.3, 0.3));
        out[k].radius = (1 + second * cos(2 * middle + phase2) + third * cos(3 * middle + phase3)) *
                        random_between(random, 0.85, 1.15);
    }
    for (size_t k = 0; k < n; k++)
        out[k].end = k + 1 < n ? out[k + 1].start : out[0].start + 2 * pi;
    close_radii(out, n, NULL);
}

static struct outline make_n_arc(uint64_t *random, size_t n) {
    narc_arc arcs[MAX_EDGES] = {{0}};
    double least = 0;
    while (least <= 0.05) {
        try_n_arc(random, n, arcs);
        least = INFINITY;
        for (size_t k = 0; k < n; k++)
            least = fmin(least, arcs[k].radius);
    }
    chain_centers(arcs, n);
    center(arcs, n);
    struct outline outline = {.count = n};
    for (size_t k = 0; k < n; k++)
        outline.arcs[k] =
            (struct arc){arcs[k].center_x, arcs[k].center_y, arcs[k].radius, cos(arcs[k].start), sin(arcs[k].start)};
    outline.arcs[n] = outline.arcs[0];
    return outline;
}

/* Vertex k has the normals between those of the edges before and behind it. */
static void add_edge_normals(struct outline *outline) {
    for (size_t k = 0; k < outline->count; k++) {
        const struct arc *before = &outline->arcs[(k + outline->count - 1) % outline->count];
        struct arc *vertex = &outline->arcs[k];
        const double x = vertex->x - before->x, y = vertex->y - before->y, length = hypot(x, y);
        vertex->radius = 0;
        vertex->start_x = y / length;
        vertex->start_y = -x / length;
    }
    outline->arcs[outline->count] = outline->arcs[0];
}

static void grow(struct outline *polygon, double factor, double radius) {
    for (size_t k = 0; k <= polygon->count; k++) {
        polygon->arcs[k].x *= factor;
        polygon->arcs[k].y *= factor;
        polygon->arcs[k].radius = radius;
    }
}

/* The vertices are the junctions, where arcs start. */
struct outline polygon_of(const struct outline *n_arc, bool large) {
    struct outline outline = {.count = n_arc->count};
    for (size_t k = 0; k < n_arc->count; k++) {
        const struct arc *arc = &n_arc->arcs[k];
        outline.arcs[k].x = arc->x + arc->radius * arc->start_x;
        outline.arcs[k].y = arc->y + arc->radius * arc->start_y;
    }
    add_edge_normals(&outline);
    if (large)
        grow(&outline, sqrt(area_of(n_arc) / area_of(&outline)), 0);
    return outline;
}

struct outline box_with(double x, double y) {
    struct outline outline = {.count = 4, .arcs = {{.x = x, .y = -y}, {.x = x, .y = y}, {.x = -x, .y = y}}};
    outline.arcs[3] = (struct arc){.x = -x, .y = -y};
    add_edge_normals(&outline);
    return outline;
}

struct outline circle_with(double radius) {
    return (struct outline){.count = 1, .arcs = {{.radius = radius, .start_x = 1}, {.radius = radius, .start_x = 1}}};
}

struct outline make_outline(enum form form, size_t edges, size_t index, uint64_t *random) {
    static const enum form kinds[] = {FORM_DISC, FORM_BOX, FORM_POLYGON, FORM_N_ARC};
    struct outline outline = make_n_arc(random, edges);
    if (form == FORM_KINDS)
        form = kinds[index % 4];
    else if (form == FORM_BALLS_BOXES)
        form = kinds[index % 2];
    if (form == FORM_POLYGON || form == FORM_ROUNDED) {
        outline = polygon_of(&outline, false);
        if (form == FORM_ROUNDED)
            grow(&outline, 1 - corner_radius, corner_radius);
    } else if (form == FORM_BOX) {
        const double x = random_between(random, 0.5, 1.2);
        outline = box_with(x, random_between(random, 0.5, 1.2));
    } else if (form == FORM_SQUARE) {
        outline = box_with(0.5, 0.5);
    } else if (form == FORM_DISC) {
        outline = circle_with(random_between(random, 0.6, 1.2));
    } else if (form == FORM_CAPSULE) {
        const double x = random_between(random, 0.5, 1.2), radius = random_between(random, 0.35, 0.6);
        outline = (struct outline){.count = 2, .arcs = {{x, 0, radius, 0, -1}, {-x, 0, radius, 0, 1}}};
        outline.arcs[2] = outline.arcs[0];
    }
    return outline;
}

double area_of(const struct outline *outline) {
    narc_arc arcs[MAX_EDGES] = {{0}};
    const size_t count = list_arcs(outline, arcs);
    return mass_of(arcs, count).area;
}

double extent_of(const struct outline *outline) {
    double extent = 0;
    for (size_t k = 0; k < outline->count; k++)
        extent = fmax(extent, hypot(outline->arcs[k].x, outline->arcs[k].y) + outline->arcs[k].radius);
    return extent;
}

void add_outline(narc_shapes *shapes, const struct outline *outline) {
    narc_arc arcs[MAX_EDGES] = {{0}};
    const size_t count = list_arcs(outline, arcs);
    narc_error error;
    /* Equal outlines too are shapes of their own: what has a shape for each body measures that. */
    must(narc_add_shape_at(shapes, (uint32_t)narc_count_shapes(shapes), arcs, count, &error), &error);
}
