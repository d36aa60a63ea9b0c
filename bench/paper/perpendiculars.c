/* SPDX-License-Identifier: MIT
 *
 * perpendiculars.c - what it costs polygon SAT to compute the sides' normals for each pair instead of storing them.
 *
 * The paper's Algorithm 3 in single precision, one pair after the other. B's vertices are placed in A's frame once;
 * then each side of either polygon is held against all vertices of the other. All pairs collide, so that no test ends
 * early.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"
#include "random.h"

struct polygon {
    size_t count;
    float x[NARC_MAX_ARCS + 1], y[NARC_MAX_ARCS + 1]; /* the vertex behind the last one is the first */
    float normal_x[NARC_MAX_ARCS], normal_y[NARC_MAX_ARCS];
};

static struct polygon read_polygon(const narc_shapes *shapes, uint32_t shape) {
    narc_arc arcs[NARC_MAX_ARCS];
    struct polygon polygon = {.count = narc_get_arcs(shapes, shape, arcs)};
    for (size_t k = 0; k < polygon.count; k++) {
        polygon.x[k] = (float)arcs[k].center_x;
        polygon.y[k] = (float)arcs[k].center_y;
        polygon.normal_x[k] = (float)cos(arcs[k].end); /* a vertex ends where the side behind it begins */
        polygon.normal_y[k] = (float)sin(arcs[k].end);
    }
    polygon.x[polygon.count] = polygon.x[0];
    polygon.y[polygon.count] = polygon.y[0];
    return polygon;
}

static void place(const struct polygon *polygon, const struct body *pair, bool normals, struct polygon *out) {
    const float d_x = pair[1].x - pair[0].x, d_y = pair[1].y - pair[0].y;
    const float x = pair[0].cosine * d_x + pair[0].sine * d_y, y = pair[0].cosine * d_y - pair[0].sine * d_x;
    const float c = pair[0].cosine * pair[1].cosine + pair[0].sine * pair[1].sine;
    const float s = pair[0].cosine * pair[1].sine - pair[0].sine * pair[1].cosine;
    out->count = polygon->count;
    for (size_t k = 0; k <= polygon->count; k++) {
        out->x[k] = c * polygon->x[k] - s * polygon->y[k] + x;
        out->y[k] = s * polygon->x[k] + c * polygon->y[k] + y;
    }
    for (size_t k = 0; normals && k < polygon->count; k++) {
        out->normal_x[k] = c * polygon->normal_x[k] - s * polygon->normal_y[k];
        out->normal_y[k] = s * polygon->normal_x[k] + c * polygon->normal_y[k];
    }
}

/* The largest gap along a normal of `sides`, by length 1 or by the side's length. */
static inline float gap_along(const struct polygon *sides, const struct polygon *points, bool stored, bool unit) {
    float most = -INFINITY;
    for (size_t i = 0; i < sides->count; i++) {
        float n_x, n_y, least = INFINITY;
        if (stored) {
            n_x = sides->normal_x[i];
            n_y = sides->normal_y[i];
        } else {
            n_x = sides->y[i + 1] - sides->y[i];
            n_y = sides->x[i] - sides->x[i + 1];
            if (unit) {
                const float length = sqrtf(n_x * n_x + n_y * n_y);
                n_x /= length;
                n_y /= length;
            }
        }
        for (size_t j = 0; j < points->count; j++) {
            const float height = n_x * (points->x[j] - sides->x[i]) + n_y * (points->y[j] - sides->y[i]);
            least = height < least ? height : least;
        }
        most = least > most ? least : most;
        if (most > 0)
            break;
    }
    return most;
}

static inline float gap_of(const struct polygon *polygons, const struct body *pair, bool stored, bool unit) {
    const struct polygon *a = &polygons[pair[0].shape];
    struct polygon b;
    place(&polygons[pair[1].shape], pair, stored, &b);
    const float one = gap_along(a, &b, stored, unit), other = gap_along(&b, a, stored, unit);
    return one > other ? one : other;
}

/* Sums of gaps, so that no variant can be left out. */
static float run(const struct polygon *polygons, const struct scene *scene, enum perpendicular way) {
    float sum = 0;
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct body *pair = &scene->bodies[2 * k];
        switch (way) {
        case STORED_YES_NO:
            sum += gap_of(polygons, pair, true, true) < 0;
            break;
        case COMPUTED_YES_NO:
            sum += gap_of(polygons, pair, false, false) < 0;
            break;
        case STORED_DEPTH:
            sum += gap_of(polygons, pair, true, true);
            break;
        default:
            sum += gap_of(polygons, pair, false, true);
        }
    }
    return sum;
}

/* All ways in turn, repetition after repetition; the median of each. */
static void time_size(const struct paper *paper, size_t size, struct perpendiculars *times) {
    const struct scene *scene = &paper->scenes[size][COLLIDING];
    const size_t repetitions = (size_t)paper->settings.repetitions;
    struct polygon *polygons = allocate(scene->templates->count, sizeof *polygons);
    double measured[PERPENDICULARS][MAX_REPETITIONS];
    for (uint32_t k = 0; k < scene->templates->count; k++)
        polygons[k] = read_polygon(scene->templates->shapes[KIND_GON], k);
    for (size_t repetition = 0; repetition < repetitions; repetition++)
        for (enum perpendicular way = 0; way < PERPENDICULARS; way++) {
            const double start = now();
            const float sum = run(polygons, scene, way);
            measured[way][repetition] = (now() - start) / (double)scene->pair_count;
            if (way <= COMPUTED_YES_NO ? sum != (float)scene->pair_count : !(sum < 0))
                fail("polygon SAT in plain C finds a gap where n-gons collide, n = %zu", scene->templates->n);
        }
    for (enum perpendicular way = 0; way < PERPENDICULARS; way++)
        times->ns[way][size] = quantile(measured[way], repetitions, 0.5);
    free(polygons);
}

void time_perpendiculars(const struct paper *paper, struct perpendiculars *times) {
    begin_step("perpendiculars of polygons");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        time_size(paper, size, times);
}

void print_perpendiculars(const struct paper *paper, const struct perpendiculars *times, FILE *out) {
    static const char *const titles[PERPENDICULARS] = {"yes or no, stored", "yes or no, computed, any length",
                                                       "depth, stored", "depth, computed and normalised"};
    print_sizes_head(paper,
                     "Perpendiculars of polygons: µs for 1,000 checks of plain C, one after the other, collision scene",
                     "| |", "", out);
    for (enum perpendicular way = 0; way < PERPENDICULARS; way++) {
        fprintf(out, "| %s |", titles[way]);
        for (size_t size = 0; size < paper->settings.size_count; size++)
            fprintf(out, " %.0f |", times->ns[way][size]);
        fputc('\n', out);
    }
}
