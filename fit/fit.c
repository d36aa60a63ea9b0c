/* SPDX-License-Identifier: MIT
 *
 * fit.c - the call for a fit: checks, scaling, families, and the fewest arcs for a tolerance.
 */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "error.h"
#include "model/least_distance.h"
#include "outline/vector.h"
#include "result/finish.h"
#include "result/paper.h"
#include "result/plain.h"
#include "solve/ladder.h"

enum { MOST_STARTS = 100000 };

/* A radius of the hull below this, or above, would leave no room for the shape in the store's range. */
static const double LEAST_RADIUS = 4 * NARC_MIN_SIZE, LARGEST_RADIUS = 0.1 * NARC_MAX_SIZE;

/* A hull with less area than this part of its radius squared counts as a line: its width is near what single precision
 * tells apart. */
static const double LEAST_AREA = 1e-5;

/* The largest radius is this part of what the store takes, which rounding must not exceed. */
static const double RADIUS_ROOM = 0.99, LESS_RADIUS = 0.8;
enum { MOST_RADII = 12 };

/* The search keeps radii above the least one by this part of it, which rounding does not exceed. In parts of the
 * outline's radius, less than single precision would tell from 0, and more than programmes are good for, are not worked
 * with. */
static const double LEAST_ROOM = 1e-5, SMALLEST_LEAST = 4e-7, LARGEST_LEAST = 16;

/* A third moment of the hull that roundings may have made. */
static const double SYMMETRIC = 1e-9;

/* Hulls with more corners are thinned, by twice this (in parts of the radius), or four times ..., until they have
 * fewer. A circle has some 1500 corners at 2e-6. */
static const double LEAST_THINNING = 1e-6, MOST_THINNING = 1e-3;
enum { MOST_CORNERS = 2000 };

/* With a tolerance, curves are flattened to this part of it at least; of plain shapes, whose numbers are wanted, to this. */
static const double FLATNESS_OF_TOLERANCE = 0.02, FLATNESS_OF_PLAIN = 2e-4;

/* Coordinates are rounded to single precision, by up to this part of their size. */
static const double SINGLE_ROUNDING = 0x1p-24;

/* A shape keeps an origin that is so far away that its coordinates are rounded by up to this part of its radius: one
 * that bounds is then a tenth larger or so. */
static const double COARSEST = 1.0 / 16;

/* Chains of the most arcs that grow from fewer are closer than those from fresh starts, but not so many times: on five
 * outlines of different kinds it was 2.3 times at most. They take as long as a few counts: of tolerances that are not small,
 * in parts of the hull's radius, those are tried first that mostly do. */
static const double LOOK_AHEAD = 16, SMALL_TOLERANCE = 1e-4;
enum { LOOK_AHEAD_FROM = 9 };

/* A fit under way. */
struct job {
    const narc_fit_request *request;
    narc_hull hull; /* scaled: within 1 of the origin */
    narc_frame frame;
    narc_contours outline; /* flattened */
    double flatness, max_radius;
    narc_hull mirrored; /* what is searched, if that is the hull in a mirror; otherwise empty */
    narc_ladder ladder;
    narc_progress progress;
};

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---------------------------------------------------------------------------- preparation */

static narc_status check_request(const narc_path *path, const narc_fit_request *request, const narc_fit_result *out,
                                 narc_error *error) {
    if (!path || !request || !out) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !path      ? "the path"
                         : !request ? "the request"
                                    : "the result");
    }
    if ((unsigned)request->family > NARC_FIT_PLAIN)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->family, "there is no family %d", (int)request->family);
    if ((unsigned)request->goal > NARC_FIT_DIFFERENCE)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->goal, "there is no goal %d", (int)request->goal);
    if (request->family == NARC_FIT_PAPER && request->goal != NARC_FIT_BOUND_AREA)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->goal, "the paper's route has no goal but to bound");
    const bool corners = request->family == NARC_FIT_POLYGON || request->family == NARC_FIT_PAPER;
    const size_t least = corners ? 3 : 1;
    if (request->family == NARC_FIT_PLAIN && request->arc_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)request->arc_count,
                         "%zu arcs, but plain shapes have as many as they need", request->arc_count);
    if (request->arc_count > NARC_MAX_FIT_ARCS || (request->arc_count && request->arc_count < least)) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)request->arc_count, "%zu arcs, but a fit has %zu to %d",
                         request->arc_count, least, NARC_MAX_FIT_ARCS);
    }
    if (request->starts > MOST_STARTS) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, request->starts, "%u starts, but the most is %d", request->starts,
                         MOST_STARTS);
    }
    if (request->quick && request->starts) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->starts, "a quick fit chooses its starts, not %u",
                         request->starts);
    }
    if (!(request->min_radius >= 0 && isfinite(request->min_radius))) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, request->min_radius, "the least radius %g is not a length",
                         request->min_radius);
    }
    if (request->min_radius > 0 && corners) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->min_radius,
                         "a least radius of %g, but polygons, and the paper's route from them, have corners",
                         request->min_radius);
    }
    if (request->arc_count == 0 && !(request->tolerance > 0 && isfinite(request->tolerance))) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, request->tolerance, "the tolerance %g is not a positive length",
                         request->tolerance);
    }
    return NARC_OK;
}

/* The hull of the flattened contours, moved and scaled to fit in the unit circle. */
static narc_status scale_hull(const narc_contours *contours, struct job *job, narc_error *error) {
    const narc_aabb box = bound_points(contours->points, contours->point_count);
    job->frame.middle = (narc_point){0.5 * (box.min_x + box.max_x), 0.5 * (box.min_y + box.max_y)};
    job->frame.radius = 0;
    for (size_t k = 0; k < contours->point_count; k++)
        job->frame.radius = fmax(job->frame.radius, length(minus(contours->points[k], job->frame.middle)));
    if (contours->point_count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    if (job->frame.radius > 0 && !(job->frame.radius >= LEAST_RADIUS && job->frame.radius <= LARGEST_RADIUS)) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, job->frame.radius,
                         "the outline's radius %g is not within %g and %g", job->frame.radius, LEAST_RADIUS,
                         LARGEST_RADIUS);
    }
    narc_point *scaled = malloc(contours->point_count * sizeof *scaled);
    if (!scaled)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu points", contours->point_count);
    for (size_t k = 0; k < contours->point_count && job->frame.radius > 0; k++) {
        const narc_point p = minus(contours->points[k], job->frame.middle);
        scaled[k] = (narc_point){p.x / job->frame.radius, p.y / job->frame.radius};
    }
    const size_t count = job->frame.radius > 0 ? contours->point_count : 1;
    scaled[0] = job->frame.radius > 0 ? scaled[0] : (narc_point){0, 0};
    const narc_status status = narc_make_hull(scaled, count, &job->hull, error);
    free(scaled);
    return status;
}

/* Puts the hull where it does not matter how the outline lay: its centroid at the origin, its furthest corner 1 away,
 * its longest side below. So the search sees the same hull of an outline that was moved, scaled or turned, apart from
 * rounding and the choice among sides of one length. */
static narc_status settle_hull(struct job *job, narc_error *error) {
    const narc_hull *old = &job->hull;
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
    const narc_point middle = along(job->frame.middle, job->frame.radius, centroid);
    const narc_point moved = minus(middle, job->frame.middle);
    centroid = (narc_point){moved.x / job->frame.radius, moved.y / job->frame.radius};
    const double angle = old->angles[longest] + PI / 2;
    narc_point *corners = malloc(old->count * sizeof *corners);
    if (!corners)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", old->count);
    const narc_point x = unit_at(angle);
    for (size_t k = 0; k < old->count; k++) {
        const narc_point p = minus(old->corners[(longest + k) % old->count], centroid);
        corners[k] = (narc_point){dot(p, x), cross(x, p)};
        radius = fmax(radius, length(p));
    }
    for (size_t k = 0; k < old->count; k++)
        corners[k] = (narc_point){corners[k].x / radius, corners[k].y / radius};
    narc_hull hull;
    const narc_status status = narc_adopt_corners(corners, old->count, &hull, error);
    free(corners);
    if (status == NARC_OK) {
        narc_release_hull(&job->hull);
        job->hull = hull;
        job->frame.middle = middle;
        job->frame.radius *= radius;
        job->frame.angle = angle;
    }
    return status;
}

/* Which of two mirror images the search sees: the one that reaches further to the right, by the third moment of its
 * outline about the centroid. */
static narc_status choose_mirror(struct job *job, narc_error *error) {
    const narc_hull *seen = &job->hull;
    double moment = 0;
    for (size_t k = 0; k < seen->count; k++) {
        const narc_point p = seen->corners[k], q = seen->corners[(k + 1) % seen->count];
        const double middle = 0.5 * (p.x + q.x);
        moment += length(minus(q, p)) * middle * middle * middle;
    }
    if (moment > -SYMMETRIC)
        return NARC_OK;
    narc_point *corners = malloc(seen->count * sizeof *corners);
    if (!corners)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", seen->count);
    for (size_t k = 0; k < seen->count; k++) { /* the longest side stays the first */
        const narc_point p = seen->corners[(seen->count + 1 - k) % seen->count];
        corners[k] = (narc_point){-p.x, p.y};
    }
    const narc_status status = narc_adopt_corners(corners, seen->count, &job->mirrored, error);
    job->mirrored.inflation = seen->inflation;
    free(corners);
    return status;
}

/* Half of the hull's largest width among some directions: no circle around it, or around a shape that holds it, is
 * smaller. */
static double find_least_radius(const narc_hull *hull) {
    enum { DIRECTIONS = 64 };
    double widest = 0;
    for (unsigned k = 0; k < DIRECTIONS; k++) {
        const double angle = PI * k / DIRECTIONS;
        const narc_point u = unit_at(angle);
        const narc_point ahead = hull->corners[narc_find_corner(hull, angle)];
        const narc_point behind = hull->corners[narc_find_corner(hull, angle + PI)];
        widest = fmax(widest, dot(minus(ahead, behind), u));
    }
    return 0.5 * widest;
}

/* The least and the largest radius of arcs, in units of the hull's. */
static narc_status limit_radii(struct job *job, narc_error *error) {
    const double least = job->request->min_radius / job->frame.radius;
    if (least > LARGEST_LEAST) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, job->request->min_radius,
                         "the least radius %g is more than %g times the outline's, %g", job->request->min_radius,
                         LARGEST_LEAST, job->frame.radius);
    }
    job->ladder.min_radius = least > 0 ? fmax(SMALLEST_LEAST, least * (1 + LEAST_ROOM)) : 0;
    job->max_radius = RADIUS_ROOM * NARC_MAX_RADIUS_RATIO * fmax(find_least_radius(&job->hull), job->ladder.min_radius);
    return NARC_OK;
}

static narc_status check_origin(const struct job *job, narc_error *error) {
    const double away = length(job->frame.middle), rounding = away * SINGLE_ROUNDING;
    if (!job->request->keep_origin || rounding <= COARSEST * job->frame.radius)
        return NARC_OK;
    return narc_fail(
        error, NARC_ERROR_NO_SOLUTION, 0, 0,
        "the outline is %g from its origin, where single precision rounds by up to %g: a shape of radius %g "
        "can't keep that origin",
        away, rounding, job->frame.radius);
}

static narc_status prepare(const narc_path *path, struct job *job, narc_error *error) {
    const narc_fit_request *request = job->request;
    double flatness = request->flatness;
    if (flatness == 0 && request->arc_count == 0)
        flatness = (request->family == NARC_FIT_PLAIN ? FLATNESS_OF_PLAIN : FLATNESS_OF_TOLERANCE) * request->tolerance;
    narc_status status = narc_flatten_path(path, flatness, &job->outline, error);
    if (status == NARC_ERROR_SIZE &&
        request->flatness == 0) /* finer than numbers are: such a tolerance is not reached */
        status = narc_flatten_path(path, 0, &job->outline, error);
    if (status != NARC_OK)
        return status;
    job->frame.outline = &job->outline;
    job->frame.keep_origin = request->keep_origin;
    status = scale_hull(&job->outline, job, error);
    job->flatness = job->outline.flatness;
    if (status != NARC_OK)
        return status;
    if (!(job->hull.area >= LEAST_AREA)) {
        narc_release_hull(&job->hull);
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, job->hull.area,
                         "the outline is as thin as a line, single precision can't tell its sides apart");
    }
    status = check_origin(job, error);
    if (!status && request->family != NARC_FIT_PLAIN)
        status = settle_hull(job, error);
    job->hull.inflation = job->flatness / job->frame.radius;
    for (double tolerance = LEAST_THINNING;
         status == NARC_OK && job->hull.count > MOST_CORNERS && tolerance < MOST_THINNING;) {
        tolerance *= 2;
        status = narc_thin_hull(&job->hull, tolerance, error);
    }
    job->flatness = job->frame.radius * job->hull.inflation;
    if (status == NARC_OK)
        status = limit_radii(job, error);
    if (status == NARC_OK)
        status = choose_mirror(job, error);
    if (status != NARC_OK)
        narc_release_hull(&job->hull);
    return status;
}

/* ---------------------------------------------------------------------------- one count of arcs */

static narc_ladder *aim_ladder(struct job *job) {
    job->ladder.hull = job->mirrored.count ? &job->mirrored : &job->hull;
    job->ladder.progress = &job->progress;
    job->ladder.max_radius = job->max_radius;
    return &job->ladder;
}

static narc_status find_chains(struct job *job, narc_fit_family family, narc_fit_goal goal, size_t count,
                               const narc_ranking **out_best, narc_error *error) {
    narc_rung wanted = {family, goal, count};
    /* Closed chains of up to three arcs without edges are circles. */
    if (family == NARC_FIT_N_ARC ? count < 3 : count < 2) {
        wanted.family = NARC_FIT_N_ARC;
        wanted.count = 3;
    }
    return narc_climb(aim_ladder(job), &wanted, out_best, error);
}

/* A chain as the outline has it. */
static narc_chain place_found(const struct job *job, const narc_candidate *found) {
    narc_chain chain = found->chain;
    if (job->mirrored.count)
        narc_mirror_chain(&chain);
    return chain;
}

static narc_status fit_paper(struct job *job, size_t count, narc_fit_result *out_result, narc_error *error) {
    const narc_ranking *best;
    narc_status status = find_chains(job, NARC_FIT_POLYGON, NARC_FIT_BOUND_AREA, count, &best, error);
    if (status != NARC_OK)
        return status;
    const narc_chain polygon = place_found(job, &best->items[0]);
    /* Corners that coincide are one. */
    narc_point corners[MAX_CHAIN];
    size_t sides = 0;
    for (size_t k = 0; k < polygon.count; k++)
        if (polygon.edge[k] > 1e-6)
            corners[sides++] = polygon.center[k];
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count;
    status = narc_follow_paper(corners, sides, count, &job->hull, arcs, &arc_count, error);
    return status != NARC_OK ? status
                             : narc_finish_arcs(arcs, arc_count, &job->hull, &job->frame, true, out_result, error);
}

/* Rounds the best of the chains that can be. */
static narc_status finish_best(const struct job *job, const narc_ranking *best, bool bound, narc_fit_result *out_result,
                               narc_error *error) {
    narc_status status = NARC_ERROR_NO_SOLUTION;
    for (size_t k = 0; k < best->count && status == NARC_ERROR_NO_SOLUTION; k++) {
        const narc_chain chain = place_found(job, &best->items[k]);
        status = narc_finish_fit(&chain, &job->hull, &job->frame, bound, out_result, error);
        for (size_t i = 0; status == NARC_OK && i < out_result->arc_count; i++) {
            const double radius = out_result->arcs[i].radius;
            if (!(radius >= job->request->min_radius)) {
                status = narc_fail(error, NARC_ERROR_NO_SOLUTION, i, 0, "arc %zu has the radius %g, the least is %g", i,
                                   radius, job->request->min_radius);
            }
        }
    }
    return status;
}

static narc_status fit_count(struct job *job, narc_fit_goal goal, size_t count, narc_fit_result *out_result,
                             narc_error *error) {
    if (job->request->family == NARC_FIT_PAPER)
        return fit_paper(job, count, out_result, error);
    const bool bound = goal <= NARC_FIT_BOUND_DISTANCE;
    const double max_radius = job->max_radius;
    narc_status status = NARC_ERROR_RADIUS;
    /* A shape that need not bound may be smaller than the hull, and then so are the largest radii that it may have. */
    narc_error last;
    for (unsigned round = 0; round < MOST_RADII && status == NARC_ERROR_RADIUS; round++) {
        const narc_ranking *best;
        status = find_chains(job, job->request->family, goal, count, &best, &last);
        if (status == NARC_OK)
            status = finish_best(job, best, bound, out_result, &last);
        if (status == NARC_ERROR_RADIUS) {
            job->max_radius *= LESS_RADIUS;
            narc_clear_ladder(&job->ladder);
        }
    }
    if (job->max_radius != max_radius) {
        narc_clear_ladder(&job->ladder);
        job->max_radius = max_radius;
    }
    if (status != NARC_OK && error)
        *error = last;
    return status;
}

/* ---------------------------------------------------------------------------- the fewest arcs */

static bool is_n_arc(narc_fit_family family) { return family == NARC_FIT_N_ARC || family == NARC_FIT_PAPER; }

static narc_fit_goal tolerance_goal(const narc_fit_request *request) {
    return request->goal <= NARC_FIT_BOUND_DISTANCE ? NARC_FIT_BOUND_DISTANCE : NARC_FIT_DISTANCE;
}

/* Is the tolerance less than what is known before the search? A fit that bounds goes around the chords of curves by
 * their flatness, and distances count the flatness once more. */
static narc_status check_tolerance(const struct job *job, narc_error *error) {
    const narc_fit_request *request = job->request;
    const bool bound = tolerance_goal(request) == NARC_FIT_BOUND_DISTANCE;
    const double bulge = is_n_arc(request->family) ? narc_least_distance(&job->hull, bound) : 0;
    const double away = request->keep_origin ? length(job->frame.middle) : 0;
    const double rounding = fmax(job->frame.radius, away) * SINGLE_ROUNDING, side = job->frame.radius * bulge;
    const double flatness = job->flatness + (bound ? job->outline.flatness : 0);
    const double least = flatness + fmax(rounding, side);
    if (request->tolerance >= least)
        return NARC_OK;
    char reason[160];
    if (flatness >= fmax(rounding, side))
        snprintf(reason, sizeof reason, "its chords are within %g of its curves", job->flatness);
    else if (side >= rounding)
        snprintf(reason, sizeof reason, "radii end at 64 times the shape's, straight edges may come closer");
    else
        snprintf(reason, sizeof reason, "single precision rounds its coordinates by up to %g", rounding);
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, least,
                     "up to %d arcs come no closer than %g to the outline, not within the tolerance %g: %s",
                     NARC_MAX_FIT_ARCS, least, request->tolerance, reason);
}

/* Tries a count; true if it keeps the tolerance, and then the result is taken. `closest` is the least distance of all
 * tries. */
static bool keeps_tolerance(struct job *job, size_t count, narc_fit_result *out_result, double *closest,
                            narc_status *out_status, narc_error *error) {
    narc_fit_result result;
    *out_status = fit_count(job, tolerance_goal(job->request), count, &result, error);
    if (*out_status != NARC_OK)
        return false;
    const double distance = result.max_distance + job->flatness;
    *closest = fmin(*closest, distance);
    if (!(distance <= job->request->tolerance))
        return false;
    *out_result = result;
    return true;
}

/* No count keeps the tolerance: how close they came, or why there is no fit at all. */
static narc_status fail_fewest(const struct job *job, double closest, narc_status status, const narc_error *last,
                               narc_error *error) {
    if (!isfinite(closest))
        return narc_fail(error, status, 0, last->value, "%s", last->message);
    char reason[100] = "";
    if (job->request->min_radius > 0)
        snprintf(reason, sizeof reason, ": arcs have at least the radius %g", job->request->min_radius);
    else if (is_n_arc(job->request->family))
        snprintf(reason, sizeof reason, ": radii end at 64 times the shape's, straight edges may come closer");
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, closest,
                     "up to %d arcs come within %g of the outline, not within the tolerance %g%s", NARC_MAX_FIT_ARCS,
                     closest, job->request->tolerance, reason);
}

/* Are the most arcs, from fresh starts, so far off that none is worth a search? */
static bool is_out_of_reach(struct job *job, double *out_distance) {
    const narc_rung most = {job->request->family, tolerance_goal(job->request), NARC_MAX_FIT_ARCS};
    double value;
    if (job->request->family == NARC_FIT_PAPER || narc_look_ahead(aim_ladder(job), &most, &value, NULL) != NARC_OK)
        return false;
    *out_distance = job->frame.radius * value + job->flatness;
    return *out_distance > LOOK_AHEAD * job->request->tolerance;
}

/* What bounds is no closer than what need not: if that is too far off, a search for it can be spared. */
static bool is_too_far(struct job *job, size_t count) {
    const narc_ranking *closest;
    narc_error unused;
    return tolerance_goal(job->request) == NARC_FIT_BOUND_DISTANCE && job->request->family != NARC_FIT_PAPER &&
           find_chains(job, job->request->family, NARC_FIT_DISTANCE, count, &closest, &unused) == NARC_OK &&
           closest->items[0].value * job->frame.radius + job->flatness > job->request->tolerance;
}

/* More and more arcs up to `most`, of which each count builds on the one before, until the tolerance is kept. */
static narc_status fit_fewest(struct job *job, size_t most, narc_fit_result *out_result, narc_error *error) {
    const bool corners = job->request->family == NARC_FIT_POLYGON || job->request->family == NARC_FIT_PAPER;
    const bool small = job->request->tolerance < SMALL_TOLERANCE * job->frame.radius;
    const size_t first = corners ? 3 : 1, look = small ? first : LOOK_AHEAD_FROM;
    double closest = INFINITY;
    narc_status status = check_tolerance(job, error);
    narc_error last;
    if (status != NARC_OK)
        return status;
    job->ladder.fewest = true;
    job->ladder.family = job->request->family;
    for (size_t count = first; count <= most; count++) {
        double far;
        if (count == look && most == NARC_MAX_FIT_ARCS && is_out_of_reach(job, &far))
            return fail_fewest(job, far, status, NULL, error);
        if (count < most && is_too_far(job, count))
            continue;
        if (keeps_tolerance(job, count, out_result, &closest, &status, &last))
            return NARC_OK;
        if (status == NARC_ERROR_MEMORY)
            return narc_fail(error, status, 0, 0, "%s", last.message);
        if (job->progress.cancelled)
            return narc_fail(error, NARC_ERROR_CANCELLED, 0, 0, "the search for the fewest arcs was ended");
    }
    return fail_fewest(job, closest, status, &last, error);
}

static size_t plan_work(const struct job *job) {
    const narc_fit_request *request = job->request;
    const bool paper = request->family == NARC_FIT_PAPER, fewest = request->arc_count == 0;
    const narc_rung last = {.family = paper ? NARC_FIT_POLYGON : request->family,
                            .goal = !fewest || paper ? request->goal : tolerance_goal(request),
                            .count = fewest                   ? NARC_MAX_FIT_ARCS
                                     : request->arc_count < 3 ? 3
                                                              : request->arc_count};
    return narc_plan_ladder(&job->ladder, &last) + (fewest && !paper ? narc_plan_look(&job->ladder, &last) : 0);
}

/* ---------------------------------------------------------------------------- rounds */

/* A number of starts stands for rounds of searches, each from starts of its own, of which the best fit is kept: from 1,
 * 2, 4 ... starts up to that number, and from 56 on the usual search and further ones of its size. More starts have the
 * rounds of fewer and perhaps others: they are never worse. */
static size_t count_quick_rounds(unsigned starts) {
    size_t count = 0;
    while (1u << count <= starts && 1u << count < USUAL_STARTS)
        count++;
    return count;
}

static void begin_round(struct job *job, size_t index) {
    const size_t quick = count_quick_rounds(job->request->starts);
    narc_clear_ladder(&job->ladder);
    job->ladder.starts = index < quick ? 1u << index : index == quick ? 0 : USUAL_STARTS;
    job->ladder.quick = job->request->quick;
    job->ladder.round = index < quick ? 0 : (unsigned)(index - quick);
}

static bool is_better(const narc_fit_request *request, const narc_fit_result *a, const narc_fit_result *b) {
    if (request->arc_count == 0)
        return a->arc_count < b->arc_count || (a->arc_count == b->arc_count && a->max_distance < b->max_distance);
    return request->goal == NARC_FIT_BOUND_AREA        ? a->area < b->area
           : request->goal == NARC_FIT_BOUND_PERIMETER ? a->perimeter < b->perimeter
           : request->goal == NARC_FIT_DIFFERENCE      ? a->difference_area < b->difference_area
                                                       : a->max_distance < b->max_distance;
}

/* The best of all rounds, or what the last one failed with. */
static narc_status fit_rounds(struct job *job, narc_fit_result *out_result, narc_error *error) {
    const narc_fit_request *request = job->request;
    const size_t rounds = request->starts ? count_quick_rounds(request->starts) + request->starts / USUAL_STARTS : 1;
    size_t planned = 0;
    for (size_t k = 0; k < rounds; k++) {
        begin_round(job, k);
        job->progress.total += plan_work(job);
    }
    narc_fit_result found;
    bool any = false;
    narc_status status = NARC_OK;
    narc_error last;
    for (size_t k = 0; k < rounds && !job->progress.cancelled && status != NARC_ERROR_MEMORY; k++) {
        begin_round(job, k);
        job->progress.done = job->progress.limit = planned;
        planned += plan_work(job);
        status = request->arc_count ? fit_count(job, request->goal, request->arc_count, &found, &last)
                                    : fit_fewest(job, any ? out_result->arc_count : NARC_MAX_FIT_ARCS, &found, &last);
        if (status == NARC_OK && (!any || is_better(request, &found, out_result))) {
            *out_result = found;
            any = true;
        }
    }
    if (any && status != NARC_ERROR_MEMORY)
        return NARC_OK;
    return narc_fail(error, status, last.index, last.value, "%s", last.message);
}

narc_status narc_fit_path(const narc_path *path, const narc_fit_request *request, narc_fit_result *out_result,
                          narc_error *error) {
    const double begin = seconds_now();
    narc_status status = check_request(path, request, out_result, error);
    if (status != NARC_OK)
        return status;
    struct job job = {.request = request};
    status = prepare(path, &job, error);
    if (status != NARC_OK) {
        narc_release_contours(&job.outline);
        return status;
    }
    job.progress = (narc_progress){.tell = request->progress, .context = request->context};
    narc_fit_result result;
    status = request->family == NARC_FIT_PLAIN
                 ? narc_see_plain(&job.hull, &job.frame, tolerance_goal(request) == NARC_FIT_BOUND_DISTANCE,
                                  request->tolerance - job.flatness, request->min_radius, &result, error)
                 : fit_rounds(&job, &result, error);
    narc_clear_ladder(&job.ladder);
    narc_release_hull(&job.hull);
    narc_release_hull(&job.mirrored);
    narc_release_contours(&job.outline);
    if (status == NARC_OK) {
        result.flatness = job.flatness;
        result.seconds = seconds_now() - begin;
        *out_result = result;
    }
    return status;
}
