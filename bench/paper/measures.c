/* SPDX-License-Identifier: MIT
 *
 * measures.c - what is measured besides times of methods: what EPA's threshold buys, support points, what it costs polygon
 * SAT to compute the sides' normals for each pair instead of storing them, bytes of a shape.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"
#include "random.h"
#include "store.h"

const char *const thresholds[THRESHOLDS] = {"1e-01", "1e-02", "1e-03", "1e-04", "1e-05", "1e-06"};
const char *const motions[MOTIONS] = {"0", "0.001", "0.003", "0.01", "0.03", "0.1", "0.3"};

/* ------------------------------------------------------------------------------------------------ depths */

/* GJK's depths against the exact ones, in parts of the sum of both bounding radii; all pairs of the scene collide. */
static void measure_depth(const struct scene *scene, enum kind kind, const char *threshold) {
    const size_t count = scene->pair_count, n = scene->templates->n;
    const struct shapes *shapes = &scene->templates->kinds[kind];
    const narc_bodies bodies = bodies_of(scene->bodies, 2 * count);
    const narc_pairs pairs = neighbours(count);
    narc_contact *exact = allocate(count, sizeof *exact), *found = allocate(count, sizeof *found);
    double *errors = allocate(count, sizeof *errors);
    const narc_method_options options = {.method = NARC_METHOD_GJK, .tolerance = strtof(threshold, NULL)};
    const narc_query query = {.margin = INFINITY, .workers = all_workers()};
    size_t found_count;
    narc_error error;
    separate(shapes->shapes, scene->bodies, count, exact);
    must(narc_find_contacts_by(shapes->methods, &bodies, &pairs, &options, &query, found, count, &found_count, &error),
         &error);
    for (size_t k = 0; k < count; k++)
        errors[k] = fabs((double)found[k].separation - (double)exact[k].separation) /
                    size_of(shapes->bounds, &scene->bodies[2 * k]);
    put_value(quantile(errors, count, 0.5), "depth-median/%s/%s/%zu", kind_names[kind], threshold, n);
    put_value(quantile(errors, count, 0.99), "depth-high/%s/%s/%zu", kind_names[kind], threshold, n);
    put_value(quantile(errors, count, 1), "depth-most/%s/%s/%zu", kind_names[kind], threshold, n);
    free(errors);
    free(exact);
    free(found);
}

void measure_depths(const struct paper *paper) {
    begin_step("errors of depths");
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
            for (size_t size = 0; size < paper->settings.figure_sizes; size++)
                measure_depth(&paper->scenes[size][COLLIDING], kind, thresholds[threshold]);
}

/* ------------------------------------------------------------------------------------------------ support points */

/* Support points (of each body) that GJK asks for; for contacts in the longer of its two phases. With a limit of k, a pair
 * whose outcome is NARC_OUTCOME_LIMIT needs more than k; the mean of the numbers is the sum of the parts of pairs that
 * need more than 0, 1, 2 ... */
static void count_scene(const struct scene *scene, enum kind kind, const char *threshold) {
    const size_t count = scene->pair_count;
    const narc_bodies bodies = bodies_of(scene->bodies, 2 * count);
    const narc_pairs pairs = neighbours(count);
    const narc_methods *methods = scene->templates->kinds[kind].methods;
    uint8_t *outcomes = allocate(count, 1);
    uint64_t *bits = allocate(NARC_BIT_WORDS(count), sizeof *bits);
    narc_contact *contacts = allocate(count, sizeof *contacts);
    size_t sum = count, more = count, most = 1, found;
    narc_method_options options = {.method = NARC_METHOD_GJK, .out_outcomes = outcomes};
    const narc_query query = {.workers = all_workers()};
    narc_error error;
    if (threshold)
        options.tolerance = strtof(threshold, NULL);
    for (options.iterations = 1; options.iterations < NARC_MAX_ITERATIONS && more > 0; options.iterations++) {
        if (threshold)
            must(narc_find_contacts_by(methods, &bodies, &pairs, &options, &query, contacts, count, &found, &error),
                 &error);
        else
            must(narc_find_overlaps_by(methods, &bodies, &pairs, &options, &query, bits, &error), &error);
        more = 0;
        for (size_t k = 0; k < count; k++)
            more += outcomes[k] == NARC_OUTCOME_LIMIT;
        sum += more;
        if (more > 0)
            most = options.iterations + 1;
    }
    free(contacts);
    free(bits);
    free(outcomes);
    const char *which = threshold ? threshold : situation_names[scene->situation];
    put_value((double)sum / (double)count, "points/%s/%s/%zu", which, kind_names[kind], scene->templates->n);
    put_value((double)most, "most-points/%s/%s/%zu", which, kind_names[kind], scene->templates->n);
}

void count_points(const struct paper *paper) {
    begin_step("support points of GJK and EPA");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        for (enum kind kind = 0; kind < KINDS; kind++) {
            count_scene(&paper->scenes[size][APART], kind, NULL);
            count_scene(&paper->scenes[size][COLLIDING], kind, NULL);
            for (size_t threshold = 0; threshold < THRESHOLDS; threshold++)
                count_scene(&paper->scenes[size][COLLIDING], kind, thresholds[threshold]);
        }
}

/* ------------------------------------------------------------------------------------------------ perpendiculars */

/* The paper's Algorithm 3 in single precision, one pair after the other. B's vertices are placed in A's frame once; then
 * each side of either polygon is held against all vertices of the other. All pairs collide, so that no test ends early. */
struct polygon {
    size_t count;
    float x[NARC_MAX_ARCS + 1], y[NARC_MAX_ARCS + 1]; /* the vertex behind the last one is the first */
    float normal_x[NARC_MAX_ARCS], normal_y[NARC_MAX_ARCS];
};

static struct polygon read_polygon(const narc_shapes *shapes, uint32_t shape) {
    narc_arc arcs[NARC_MAX_ARCS];
    struct polygon polygon = {.count = narc_get_arcs(shapes, shape, arcs)};
    for (size_t k = 0; k <= polygon.count; k++) {
        polygon.x[k] = (float)arcs[k % polygon.count].center_x;
        polygon.y[k] = (float)arcs[k % polygon.count].center_y;
    }
    for (size_t k = 0; k < polygon.count; k++) { /* a vertex ends where the side behind it begins */
        polygon.normal_x[k] = (float)cos(arcs[k].end);
        polygon.normal_y[k] = (float)sin(arcs[k].end);
    }
    return polygon;
}

static void pose(const struct polygon *polygon, const struct body *pair, bool normals, struct polygon *out) {
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
        float n_x = sides->normal_x[i], n_y = sides->normal_y[i], least = INFINITY;
        if (!stored) {
            n_x = sides->y[i + 1] - sides->y[i];
            n_y = sides->x[i] - sides->x[i + 1];
            const float length = unit ? sqrtf(n_x * n_x + n_y * n_y) : 1;
            n_x /= length;
            n_y /= length;
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
    pose(&polygons[pair[1].shape], pair, stored, &b);
    const float one = gap_along(a, &b, stored, unit), other = gap_along(&b, a, stored, unit);
    return one > other ? one : other;
}

/* A side's unit normal stored, or computed for each pair: for a yes or no its length does not matter, for a depth it is
 * made 1. */
enum way { STORED, COMPUTED, STORED_DEPTH, NORMALISED_DEPTH, WAYS };
static const char *const way_names[WAYS] = {"stored", "computed", "stored-depth", "normalised-depth"};

/* Sums of gaps, so that no way can be left out. */
static float run(const struct polygon *polygons, const struct scene *scene, enum way way) {
    float sum = 0;
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct body *pair = &scene->bodies[2 * k];
        if (way == STORED)
            sum += gap_of(polygons, pair, true, true) < 0;
        else if (way == COMPUTED)
            sum += gap_of(polygons, pair, false, false) < 0;
        else if (way == STORED_DEPTH)
            sum += gap_of(polygons, pair, true, true);
        else
            sum += gap_of(polygons, pair, false, true);
    }
    return sum;
}

/* All ways in turn, repetition after repetition; the median of each. */
void time_perpendiculars(const struct paper *paper) {
    const size_t repetitions = (size_t)paper->settings.repetitions;
    begin_step("perpendiculars of polygons");
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        const struct scene *scene = &paper->scenes[size][COLLIDING];
        const struct shapes *gons = &scene->templates->kinds[KIND_GON];
        struct polygon *polygons = allocate(gons->count, sizeof *polygons);
        double times[WAYS][MAX_REPETITIONS];
        for (uint32_t k = 0; k < gons->count; k++)
            polygons[k] = read_polygon(gons->shapes, k);
        for (size_t repetition = 0; repetition < repetitions; repetition++)
            for (enum way way = 0; way < WAYS; way++) {
                const double start = now();
                const float sum = run(polygons, scene, way);
                times[way][repetition] = (now() - start) / (double)scene->pair_count;
                if (way <= COMPUTED ? sum != (float)scene->pair_count : !(sum < 0))
                    fail("polygon SAT in plain C finds a gap where n-gons collide, n = %zu", scene->templates->n);
            }
        for (enum way way = 0; way < WAYS; way++)
            put_value(quantile(times[way], repetitions, 0.5), "perpendicular/%s/scalar/%zu", way_names[way],
                      scene->templates->n);
        free(polygons);
    }
}

/* ------------------------------------------------------------------------------------------------ bytes */

/* What the paper's algorithms read, in single precision. SAT and GJK of n-arcs: n centres, directions and radii, and the
 * centroid. Polygons: n vertices and perpendiculars. And what this library stores, of whatever shape. */
void count_bytes(const struct paper *paper) {
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        const size_t n = paper->settings.sizes[size];
        put_value((double)(sizeof(float) * (2 * n + 2 * n + n + 2)), "bytes/arc/%zu", n);
        put_value((double)(sizeof(float) * (2 * n + 2 * n)), "bytes/gon/%zu", n);
        put_value((double)(sizeof(narc_shape_header) + sizeof(narc_record) * (narc_angle_records(n) + n + 1)),
                  "bytes/store/%zu", n);
    }
}
