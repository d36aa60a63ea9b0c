/* SPDX-License-Identifier: MIT
 *
 * outlines.c - hulls of clouds of points, and outlines of shapes as polylines.
 */
#include <math.h>

#include "common.h"
#include "random.h"
#include "rows.h"

enum { CLOUDS = 2000, LINES = 10000, MOST_POINTS = 256 };

static const double tolerance = 0.01; /* of polylines; shapes are some 2 large */

struct outlines {
    struct asked asked; /* clouds */
    narc_point *points; /* the same */
    narc_arc (*arcs)[NARC_MAX_ARCS];
    size_t *arc_counts, shape_count;
    narc_point line[MOST_POINTS];
    uint8_t *corners;
};

/* ------------------------------------------------------------------------------------------------ hulls */

static void build_hull(const struct outlines *o, size_t cloud, narc_arc *arcs, size_t *count) {
    const size_t size = o->asked.cloud_size;
    narc_error error;
    must(narc_build_hull(o->points + cloud * size, size, 0, 0, arcs, count, &error), &error);
}

static void run_hulls(struct row *row) {
    struct outlines *o = row->state;
    if (row->peer) {
        row->peer->ask(NULL, &o->asked, o->corners);
        return;
    }
    narc_arc arcs[NARC_MAX_ARCS];
    for (size_t k = 0; k < o->asked.count; k++) {
        size_t count;
        build_hull(o, k, arcs, &count);
        o->corners[k] = (uint8_t)count;
    }
}

/* Points that lie outside are wrong, and of a peer other numbers of corners. */
static void prepare_hulls(struct row *row) {
    struct outlines *o = row->state = allocate(1, sizeof *o);
    const size_t size = o->asked.cloud_size = (size_t)row->question->what;
    const size_t count = o->asked.count = row->bench.count = scaled(CLOUDS);
    float(*cloud)[2] = allocate(count * size, sizeof *cloud);
    uint64_t random = 81;
    o->points = allocate(count * size, sizeof *o->points);
    o->corners = allocate(count, sizeof *o->corners);
    o->asked.cloud = (const float(*)[2])cloud;
    for (size_t k = 0; k < count * size; k++) {
        const double angle = random_between(&random, -pi, pi), way = sqrt(random_unit(&random));
        cloud[k][0] = (float)(way * cos(angle));
        cloud[k][1] = (float)(way * sin(angle));
        o->points[k] = (narc_point){(double)cloud[k][0], (double)cloud[k][1]};
    }
    run_hulls(row);
    for (size_t k = 0; k < count; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        size_t corners;
        build_hull(o, k, arcs, &corners);
        row->bench.wrong += o->corners[k] != corners;
        for (size_t i = 0; i < size && !row->peer; i++) {
            double distance;
            row->bench.wrong +=
                !narc_compute_distance(arcs, corners, &o->points[k * size + i], &distance) || distance > TOUCHING;
        }
    }
    row->bench.hits = 1;
}

/* ------------------------------------------------------------------------------------------------ polylines */

static size_t flatten(struct outlines *o, size_t shape) {
    size_t count;
    narc_error error;
    must(narc_flatten_arcs(o->arcs[shape], o->arc_counts[shape], true, NULL, tolerance, o->line, MOST_POINTS, &count,
                           &error),
         &error);
    return count;
}

static void run_lines(struct row *row) {
    struct outlines *o = row->state;
    for (size_t k = 0; k < row->bench.count; k++)
        flatten(o, k % o->shape_count);
}

static void prepare_lines(struct row *row) {
    const narc_shapes *shapes = row->scene->shapes;
    struct outlines *o = row->state = allocate(1, sizeof *o);
    row->bench.count = scaled(LINES);
    o->shape_count = row->scene->shape_count;
    o->arcs = allocate(o->shape_count, sizeof *o->arcs);
    o->arc_counts = allocate(o->shape_count, sizeof *o->arc_counts);
    for (size_t k = 0; k < o->shape_count; k++) {
        o->arc_counts[k] = narc_get_arcs(shapes, (uint32_t)k, o->arcs[k]);
        const size_t count = flatten(o, k);
        for (size_t i = 0; i < count; i++) {
            double distance;
            row->bench.wrong += !narc_compute_distance(o->arcs[k], o->arc_counts[k], &o->line[i], &distance) ||
                                fabs(distance) > TOUCHING;
        }
        row->bench.hits += (double)count / (double)o->shape_count;
    }
}

const struct question outline_questions[] = {{"hull-8", prepare_hulls, run_hulls, 8, false},
                                             {"hull-200", prepare_hulls, run_hulls, 200, false},
                                             {"polyline", prepare_lines, run_lines, 0, false},
                                             {.name = NULL}};
