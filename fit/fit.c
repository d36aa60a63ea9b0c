/* SPDX-License-Identifier: MIT
 *
 * fit.c - the call for a fit: checks, scaling, families, and the fewest arcs for a tolerance.
 */
#define _POSIX_C_SOURCE 199309L
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "best.h"
#include "error.h"
#include "finish.h"
#include "paper.h"
#include "vector.h"

/* Starts of the local search where the caller names no number: of a fit, fewer of many arcs, whose searches take long;
 * and of each try of a count of arcs. */
enum { USUAL_STARTS = 6, TRIAL_STARTS = 5, MOST_STARTS = 100000 };
static unsigned count_starts(size_t arcs) {
    return arcs <= 6 ? 2 * USUAL_STARTS : arcs <= 12 ? USUAL_STARTS : USUAL_STARTS * 12 / (unsigned)arcs;
}

/* A radius of the hull below this, or above, would leave no room for the shape in the store's range. */
static const double LEAST_RADIUS = 4 * NARC_MIN_SIZE, LARGEST_RADIUS = 0.1 * NARC_MAX_SIZE;

/* A hull with less area than this part of its radius squared counts as a line: its width is near what single precision
 * tells apart. */
static const double LEAST_AREA = 1e-5;

/* The largest radius is this part of what the store takes, which rounding must not exceed. */
static const double RADIUS_ROOM = 0.99, LESS_RADIUS = 0.8;
enum { MOST_RADII = 12 };

/* Hulls with more corners are thinned, by twice this (in parts of the radius), or four times ..., until they have
 * fewer. A circle has some 1500 corners at 2e-6. */
static const double LEAST_THINNING = 1e-6, MOST_THINNING = 1e-3;
enum { MOST_CORNERS = 2000 };

/* With a tolerance, curves are flattened to this part of it at least. */
static const double FLATNESS_OF_TOLERANCE = 0.02;

/* A fit under way. */
typedef struct job {
    const narc_fit_request *request;
    hull around; /* scaled: within 1 of the origin */
    scale at;
    double flatness, max_radius;
    unsigned starts;
    progress work;
} job;

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---------------------------------------------------------------------------- preparation */

static narc_status check_request(const narc_path *path, const narc_fit_request *of, const narc_fit_result *out,
                                 narc_error *error) {
    if (!path || !of || !out) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !path ? "the path"
                         : !of ? "the request"
                               : "the result");
    }
    if ((unsigned)of->family > NARC_FIT_PAPER) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, of->family, "there is no family %d", (int)of->family);
    }
    if ((unsigned)of->goal > NARC_FIT_DIFFERENCE) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, of->goal, "there is no goal %d", (int)of->goal);
    }
    if (of->family == NARC_FIT_PAPER && of->goal != NARC_FIT_BOUND_AREA) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, of->goal, "the paper's route has no goal but to bound");
    }
    const bool corners = of->family == NARC_FIT_POLYGON || of->family == NARC_FIT_PAPER;
    const size_t least = corners ? 3 : 1;
    if (of->arc_count > NARC_MAX_FIT_ARCS || (of->arc_count && of->arc_count < least)) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)of->arc_count, "%zu arcs, but a fit has %zu to %d",
                         of->arc_count, least, NARC_MAX_FIT_ARCS);
    }
    if (of->starts > MOST_STARTS) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, of->starts, "%u starts, but the most is %d", of->starts,
                         MOST_STARTS);
    }
    if (of->arc_count == 0 && !(of->tolerance > 0 && isfinite(of->tolerance))) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, of->tolerance, "the tolerance %g is not a positive length",
                         of->tolerance);
    }
    return NARC_OK;
}

/* The hull of the flattened contours, moved and scaled to fit in the unit circle. */
static narc_status scale_hull(const narc_contours *contours, job *to, narc_error *error) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < contours->point_count; k++) {
        const narc_point p = contours->points[k];
        box = (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
    }
    to->at.middle = (narc_point){0.5 * (box.min_x + box.max_x), 0.5 * (box.min_y + box.max_y)};
    to->at.radius = 0;
    for (size_t k = 0; k < contours->point_count; k++) {
        to->at.radius = fmax(to->at.radius, length(minus(contours->points[k], to->at.middle)));
    }
    if (contours->point_count == 0) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    }
    if (to->at.radius > 0 && !(to->at.radius >= LEAST_RADIUS && to->at.radius <= LARGEST_RADIUS)) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, to->at.radius, "the outline's radius %g is not within %g and %g",
                         to->at.radius, LEAST_RADIUS, LARGEST_RADIUS);
    }
    narc_point *scaled = malloc(contours->point_count * sizeof *scaled);
    if (!scaled) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu points", contours->point_count);
    }
    for (size_t k = 0; k < contours->point_count && to->at.radius > 0; k++) {
        const narc_point p = minus(contours->points[k], to->at.middle);
        scaled[k] = (narc_point){p.x / to->at.radius, p.y / to->at.radius};
    }
    const size_t count = to->at.radius > 0 ? contours->point_count : 1;
    scaled[0] = to->at.radius > 0 ? scaled[0] : (narc_point){0, 0};
    const narc_status status = narc_make_hull(scaled, count, &to->around, error);
    free(scaled);
    return status;
}

/* Puts the hull where it does not matter how the outline lay: its centroid at the origin, its furthest corner 1 away,
 * its longest side below. So outlines that were moved, scaled or turned get the same fit, but for roundings. */
static narc_status settle_hull(job *of, narc_error *error) {
    const hull *old = &of->around;
    narc_point centroid = {0, 0};
    size_t longest = 0;
    double side = 0, radius = 0;
    for (size_t k = 0; k < old->count; k++) {
        const narc_point p = old->corners[k], q = old->corners[(k + 1) % old->count];
        const double part = cross(p, q) / (6 * old->area);
        centroid = along(centroid, part, plus(p, q));
        if (length(minus(q, p)) > side * (1 + 1e-9)) {
            side = length(minus(q, p));
            longest = k;
        }
    }
    /* The middle is rounded, a lot where the outline is far away: what the hull moves by is what is left of it. */
    const narc_point middle = along(of->at.middle, of->at.radius, centroid);
    const narc_point moved = minus(middle, of->at.middle);
    centroid = (narc_point){moved.x / of->at.radius, moved.y / of->at.radius};
    const double angle = old->angles[longest] + PI / 2;
    narc_point *corners = malloc(old->count * sizeof *corners);
    if (!corners) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", old->count);
    }
    const narc_point x = unit_at(angle);
    for (size_t k = 0; k < old->count; k++) {
        const narc_point p = minus(old->corners[(longest + k) % old->count], centroid);
        corners[k] = (narc_point){dot(p, x), cross(x, p)};
        radius = fmax(radius, length(p));
    }
    for (size_t k = 0; k < old->count; k++) {
        corners[k] = (narc_point){corners[k].x / radius, corners[k].y / radius};
    }
    hull made;
    const narc_status status = narc_adopt_corners(corners, old->count, &made, error);
    free(corners);
    if (status == NARC_OK) {
        narc_release_hull(&of->around);
        of->around = made;
        of->at.middle = middle;
        of->at.radius *= radius;
        of->at.angle = angle;
    }
    return status;
}

/* Half of the hull's largest width among some directions: no circle around it, or around a shape that holds it, is
 * smaller. */
static double find_least_radius(const hull *of) {
    enum { DIRECTIONS = 64 };
    double widest = 0;
    for (unsigned k = 0; k < DIRECTIONS; k++) {
        const double angle = PI * k / DIRECTIONS;
        const narc_point u = unit_at(angle);
        const narc_point ahead = of->corners[narc_find_corner(of, angle)];
        const narc_point behind = of->corners[narc_find_corner(of, angle + PI)];
        widest = fmax(widest, dot(minus(ahead, behind), u));
    }
    return 0.5 * widest;
}

static narc_status prepare(const narc_path *path, job *to, narc_error *error) {
    const narc_fit_request *request = to->request;
    narc_contours contours;
    double flatness = request->flatness;
    if (flatness == 0 && request->arc_count == 0) {
        flatness = FLATNESS_OF_TOLERANCE * request->tolerance;
    }
    narc_status status = narc_flatten_path(path, flatness, &contours, error);
    if (status == NARC_ERROR_SIZE &&
        request->flatness == 0) { /* finer than numbers are: such a tolerance is not reached */
        status = narc_flatten_path(path, 0, &contours, error);
    }
    if (status != NARC_OK) {
        return status;
    }
    status = scale_hull(&contours, to, error);
    to->flatness = contours.flatness;
    narc_release_contours(&contours);
    if (status != NARC_OK) {
        return status;
    }
    if (to->around.area < LEAST_AREA) {
        narc_release_hull(&to->around);
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, to->around.area,
                         "the outline is as thin as a line, single precision can't tell its sides apart");
    }
    status = settle_hull(to, error);
    to->around.inflation = to->flatness / to->at.radius;
    for (double tolerance = LEAST_THINNING;
         status == NARC_OK && to->around.count > MOST_CORNERS && tolerance < MOST_THINNING;) {
        tolerance *= 2;
        status = narc_thin_hull(&to->around, tolerance, error);
    }
    to->flatness = to->at.radius * to->around.inflation;
    to->max_radius = RADIUS_ROOM * NARC_MAX_RADIUS_RATIO * find_least_radius(&to->around);
    if (status != NARC_OK) {
        narc_release_hull(&to->around);
    }
    return status;
}

/* ---------------------------------------------------------------------------- one count of arcs */

/* Chains to start from besides those that the search finds by itself: an offset of the closest shape that need not
 * bound bounds, the closest shape differs little, the smallest polygons are good in other respects, and arcs with edges
 * may be arcs without or edges alone. */
typedef struct known_chains {
    size_t count;
    chain items[3];
} known_chains;

static narc_status find_chain(job *in, narc_fit_family family, narc_fit_goal goal, size_t count, candidate *out_best,
                              narc_error *error);

static void find_known(job *in, const problem *of, known_chains *out) {
    out->count = 0;
    candidate found;
    if (of->goal == NARC_FIT_BOUND_DISTANCE || of->goal == NARC_FIT_DIFFERENCE) {
        if (find_chain(in, of->family, NARC_FIT_DISTANCE, of->count, &found, NULL) == NARC_OK) {
            if (of->goal == NARC_FIT_BOUND_DISTANCE) {
                narc_offset_chain(&found.form, found.value, of->family == NARC_FIT_POLYGON);
            }
            out->items[out->count++] = found.form;
        }
    }
    for (narc_fit_goal goal = NARC_FIT_BOUND_AREA; of->family == NARC_FIT_POLYGON && goal < of->goal; goal++) {
        if (goal < NARC_FIT_BOUND_DISTANCE && find_chain(in, of->family, goal, of->count, &found, NULL) == NARC_OK) {
            out->items[out->count++] = found.form;
        }
    }
    if (of->family == NARC_FIT_EDGES && of->count == 2 &&
        find_chain(in, NARC_FIT_N_ARC, of->goal, 1, &found, NULL) == NARC_OK) {
        const double radius = found.form.radius[0]; /* a circle is two arcs as well */
        out->items[out->count++] =
            (chain){.count = 2, .start = found.form.start, .angle = {0, PI}, .radius = {radius, radius}};
    }
    if (of->family == NARC_FIT_EDGES && of->count > 2) {
        static const narc_fit_family narrower[] = {NARC_FIT_N_ARC, NARC_FIT_POLYGON};
        const unsigned starts = in->starts;
        in->starts = (starts + 1) / 2; /* they are starts themselves */
        for (size_t k = 0; k < 2 && of->goal != NARC_FIT_BOUND_DISTANCE; k++) {
            if (find_chain(in, narrower[k], of->goal, of->count, &found, NULL) == NARC_OK) {
                out->items[out->count++] = found.form;
            }
        }
        in->starts = starts;
    }
}

static narc_status find_chain(job *in, narc_fit_family family, narc_fit_goal goal, size_t count, candidate *out_best,
                              narc_error *error) {
    problem of = {.around = &in->around, .family = family, .goal = goal, .count = count, .max_radius = in->max_radius};
    /* Closed chains of up to three arcs without edges are circles. */
    const bool circle = family == NARC_FIT_N_ARC ? count < 3 : count < 2;
    if (circle) {
        of.family = NARC_FIT_N_ARC;
        of.count = 3;
    }
    hull bare = in->around;
    if (!narc_must_bound(&of)) {
        bare.inflation = 0;
        of.around = &bare;
    }
    known_chains known;
    find_known(in, &of, &known);
    const unsigned starts = known.count > 1 && count > 6 ? (in->starts + 1) / 2 : in->starts; /* two are known */
    return narc_find_best(&of, starts, known.items, known.count, &in->work, out_best, error);
}

static narc_status fit_paper(job *in, size_t count, narc_fit_result *out_result, narc_error *error) {
    candidate best;
    narc_status status = find_chain(in, NARC_FIT_POLYGON, NARC_FIT_BOUND_AREA, count, &best, error);
    if (status != NARC_OK) {
        return status;
    }
    /* Corners that coincide are one. */
    narc_point corners[MAX_CHAIN];
    size_t sides = 0;
    for (size_t k = 0; k < best.form.count; k++) {
        if (best.form.edge[k] > 1e-6) {
            corners[sides++] = best.form.center[k];
        }
    }
    narc_arc arcs[NARC_MAX_ARCS];
    size_t made;
    status = narc_follow_paper(corners, sides, count, &in->around, arcs, &made, error);
    return status != NARC_OK ? status : narc_finish_arcs(arcs, made, &in->around, &in->at, true, out_result, error);
}

static narc_status fit_count(job *in, narc_fit_goal goal, size_t count, narc_fit_result *out_result,
                             narc_error *error) {
    if (in->request->family == NARC_FIT_PAPER) {
        return fit_paper(in, count, out_result, error);
    }
    const bool bound = goal <= NARC_FIT_BOUND_DISTANCE;
    const double max_radius = in->max_radius;
    narc_status status = NARC_ERROR_RADIUS;
    /* A shape that need not bound may be smaller than the hull, and then so are the largest radii that it may have. */
    narc_error last;
    for (unsigned round = 0; round < MOST_RADII && status == NARC_ERROR_RADIUS; round++) {
        candidate best;
        status = find_chain(in, in->request->family, goal, count, &best, &last);
        if (status == NARC_OK) {
            status = narc_finish_fit(&best.form, &in->around, &in->at, bound, out_result, &last);
        }
        in->max_radius *= LESS_RADIUS;
    }
    in->max_radius = max_radius;
    if (status != NARC_OK && error) {
        *error = last;
    }
    return status;
}

/* ---------------------------------------------------------------------------- the fewest arcs */

/* Tries a count; true if it keeps the tolerance, and then the result is taken. */
static bool keeps_tolerance(job *in, size_t count, narc_fit_result *out_result, double *out_distance,
                            narc_status *out_status, narc_error *error) {
    const narc_fit_goal goal =
        in->request->goal <= NARC_FIT_BOUND_DISTANCE ? NARC_FIT_BOUND_DISTANCE : NARC_FIT_DISTANCE;
    narc_fit_result made;
    *out_distance = INFINITY;
    *out_status = fit_count(in, goal, count, &made, error);
    if (*out_status != NARC_OK) {
        return false;
    }
    *out_distance = made.max_distance + in->flatness;
    if (!(*out_distance <= in->request->tolerance)) {
        return false;
    }
    *out_result = made;
    return true;
}

/* Counts grow by half until one keeps the tolerance; then the gap to the last that did not is halved. */
static narc_status fit_fewest(job *in, narc_fit_result *out_result, narc_error *error) {
    const bool corners = in->request->family == NARC_FIT_POLYGON || in->request->family == NARC_FIT_PAPER;
    size_t below = corners ? 2 : 0, count = below + 1;
    double distance;
    narc_status status;
    narc_error last;
    while (!keeps_tolerance(in, count, out_result, &distance, &status, &last)) {
        if (in->work.cancelled || status == NARC_ERROR_MEMORY) {
            return status == NARC_ERROR_MEMORY
                       ? narc_fail(error, status, 0, 0, "%s", last.message)
                       : narc_fail(error, NARC_ERROR_CANCELLED, 0, 0, "the search for the fewest arcs was ended");
        }
        if (count == NARC_MAX_FIT_ARCS) {
            return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, distance,
                             "%d arcs come within %g of the outline, not within the tolerance %g", NARC_MAX_FIT_ARCS,
                             distance, in->request->tolerance);
        }
        below = count;
        count = count < 4 ? count + 1 : count + count / 2;
        count = count < NARC_MAX_FIT_ARCS ? count : NARC_MAX_FIT_ARCS;
    }
    while (count - below > 1 && !in->work.cancelled) {
        const size_t middle = (below + count) / 2;
        if (keeps_tolerance(in, middle, out_result, &distance, &status, NULL)) {
            count = middle;
        } else {
            below = middle;
        }
    }
    return NARC_OK;
}

narc_status narc_fit_path(const narc_path *path, const narc_fit_request *request, narc_fit_result *out_result,
                          narc_error *error) {
    const double begin = seconds_now();
    narc_status status = check_request(path, request, out_result, error);
    if (status != NARC_OK) {
        return status;
    }
    job in = {.request = request};
    status = prepare(path, &in, error);
    if (status != NARC_OK) {
        return status;
    }
    const bool fewest = request->arc_count == 0;
    in.starts = request->starts ? request->starts : fewest ? TRIAL_STARTS : count_starts(request->arc_count);
    in.work = (progress){.tell = request->progress, .context = request->context};
    const size_t searches = request->family == NARC_FIT_EDGES ? 3 : 1;
    in.work.total = narc_count_work(in.starts) * searches * (fewest ? 12 : 1) *
                    (fewest || request->goal == NARC_FIT_BOUND_DISTANCE ? 2 : 1);
    narc_fit_result made;
    status = fewest ? fit_fewest(&in, &made, error) : fit_count(&in, request->goal, request->arc_count, &made, error);
    narc_release_hull(&in.around);
    if (status == NARC_OK) {
        made.flatness = in.flatness;
        made.seconds = seconds_now() - begin;
        *out_result = made;
    }
    return status;
}
