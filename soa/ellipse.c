/* SPDX-License-Identifier: MIT
 *
 * ellipse.c - the n-arc that is nearest to an ellipse.
 *
 * The Hausdorff distance of two convex shapes is the largest difference of their support functions (Schneider,
 * "Convex Bodies", section 1.8). That of an ellipse is h(t) = sqrt(a^2 cos^2 t + b^2 sin^2 t); that of an n-arc is
 * centre.n + radius of the arc that holds the normal n at the angle t. A quadrant with m junctions has 2 m + 1
 * unknowns: the angles of the junctions, and the radii of m + 1 arcs, of which the first and the last go on beyond
 * the axes. The best choice is one whose 2 m + 2 errors of largest size are equal, in turn above and below 0. The
 * Remez exchange finds it: solve for equal errors where the largest ones are now, by Newton's method; look where they
 * are then; and so on.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "error.h"
#include "outline.h"

enum { MOST_JUNCTIONS = NARC_MAX_ARCS / 4, MOST_UNKNOWNS = 2 * MOST_JUNCTIONS + 1, MOST_PEAKS = 2 * MOST_UNKNOWNS };

typedef struct ellipse {
    double a, b;
} ellipse;

/* A quadrant: radius[k] holds from junction[k] to junction[k + 1], 0 and pi / 2 at the ends. */
typedef struct quadrant {
    size_t junctions;
    double junction[MOST_JUNCTIONS + 2], radius[MOST_JUNCTIONS + 1];
    double center_x[MOST_JUNCTIONS + 1], center_y[MOST_JUNCTIONS + 1];
} quadrant;

static double find_height(ellipse e, double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return narc_hypot(e.a * c, e.b * s);
}

static double find_curvature_radius(ellipse e, double angle) {
    double height = find_height(e, angle);
    return e.a * e.a * e.b * e.b / (height * height * height);
}

/* The centres follow from the rest: neighbours lie on the normal of their junction, the first on the x axis, the last
 * on the y axis. */
static void place_centers(quadrant *q) {
    const size_t m = q->junctions;
    q->center_x[0] = q->center_y[0] = 0;
    for (size_t k = 1; k <= m; k++) {
        double step = q->radius[k - 1] - q->radius[k];
        double c, s;
        narc_find_cosine(q->junction[k], &c, &s);
        q->center_x[k] = q->center_x[k - 1] + step * c;
        q->center_y[k] = q->center_y[k - 1] + step * s;
    }
    double last = q->center_x[m];
    for (size_t k = 0; k <= m; k++)
        q->center_x[k] -= last;
}

/* How far the arc's support line lies outside the ellipse's, and the derivative of that. */
static double find_error(ellipse e, const quadrant *q, size_t arc, double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return q->center_x[arc] * c + q->center_y[arc] * s + q->radius[arc] - narc_hypot(e.a * c, e.b * s);
}

static double find_slope(ellipse e, const quadrant *q, size_t arc, double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return q->center_y[arc] * c - q->center_x[arc] * s +
           (e.a - e.b) * (e.a + e.b) * c * s / narc_hypot(e.a * c, e.b * s);
}

/* ------------------------------------------------------------------------------------------------ equations */

typedef double matrix[MOST_UNKNOWNS + 1][MOST_UNKNOWNS + 2];

/* Solves the first n equations, each with its right side in column n; the solution goes to that column. */
static bool solve(matrix rows, size_t n) {
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++)
            pivot = fabs(rows[i][k]) > fabs(rows[pivot][k]) ? i : pivot;
        if (!(fabs(rows[pivot][k]) > 0))
            return false;
        for (size_t j = k; j <= n; j++) {
            double kept = rows[k][j];
            rows[k][j] = rows[pivot][j];
            rows[pivot][j] = kept;
        }
        for (size_t i = 0; i < n; i++) {
            if (i == k)
                continue;
            double factor = rows[i][k] / rows[k][k];
            for (size_t j = k; j <= n; j++)
                rows[i][j] -= factor * rows[k][j];
        }
    }
    for (size_t k = 0; k < n; k++)
        rows[k][n] /= rows[k][k];
    return true;
}

/* ------------------------------------------------------------------------------------------------ first guess */

/* On an arc that spans an angle d the error grows with |derivative of the radius of curvature| d^3: junctions that
 * divide the integral of its cube root evenly, half a part for the halves of arcs at the ends. Steps are even halfway
 * between the angle of the normal and that of the point, so that of a thin ellipse neither end has few. */
enum { GUESS_STEPS = 4096 };

static double find_step_angle(ellipse e, int step) {
    const double t = NARC_PI / 2 * step / GUESS_STEPS;
    if (step == 0 || step == GUESS_STEPS)
        return t;
    return narc_atan2(sqrt(e.a) * narc_sin(t), sqrt(e.b) * narc_cos(t));
}

static void guess_junctions(ellipse e, quadrant *q) {
    double sum[GUESS_STEPS + 1] = {0}, last = 0;
    for (int k = 1; k <= GUESS_STEPS; k++) {
        const double angle = find_step_angle(e, k), width = angle - last;
        const double change = find_curvature_radius(e, angle) - find_curvature_radius(e, last);
        sum[k] = sum[k - 1] + narc_pow(fabs(change) * width * width, 1.0 / 3);
        last = angle;
    }
    int step = 1;
    for (size_t junction = 1; junction <= q->junctions; junction++) {
        const double wanted = sum[GUESS_STEPS] * ((double)junction - 0.5) / (double)q->junctions;
        while (sum[step] < wanted)
            step++;
        const double part = (wanted - sum[step - 1]) / (sum[step] - sum[step - 1]);
        const double from = find_step_angle(e, step - 1), to = find_step_angle(e, step);
        q->junction[junction] = from + part * (to - from);
    }
    q->junction[q->junctions + 1] = NARC_PI / 2;
}

/* The radii with the least sum of squares of the error, which is linear in them. */
static bool guess_radii(ellipse e, quadrant *q) {
    enum { SAMPLES = 16 };
    const size_t count = q->junctions + 1;
    quadrant unit[MOST_JUNCTIONS + 1];
    matrix rows = {{0}};
    for (size_t k = 0; k < count; k++) {
        unit[k] = *q;
        memset(unit[k].radius, 0, sizeof unit[k].radius);
        unit[k].radius[k] = 1;
        place_centers(&unit[k]);
    }
    for (size_t arc = 0; arc < count; arc++)
        for (int sample = 0; sample < SAMPLES; sample++) {
            double width = q->junction[arc + 1] - q->junction[arc], value[MOST_JUNCTIONS + 1];
            double angle = q->junction[arc] + width * (sample + 0.5) / SAMPLES, height = find_height(e, angle);
            for (size_t k = 0; k < count; k++)
                value[k] = find_error(e, &unit[k], arc, angle) + height;
            for (size_t k = 0; k < count; k++) {
                for (size_t j = 0; j < count; j++)
                    rows[k][j] += value[k] * value[j];
                rows[k][count] += value[k] * height;
            }
        }
    if (!solve(rows, count))
        return false;
    for (size_t k = 0; k < count; k++)
        q->radius[k] = rows[k][count];
    place_centers(q);
    return true;
}

/* ------------------------------------------------------------------------------------------------ exchange */

/* A local extremum of the error. */
typedef struct peak {
    size_t arc;
    double angle, error;
} peak;

/* All of them in order, as far as there is room; returns how many there are. The slope is 0 on the axes. */
static size_t find_peaks(ellipse e, const quadrant *q, peak peaks[MOST_PEAKS]) {
    enum { SAMPLES = 32, HALVINGS = 48 };
    size_t count = 0;
    peaks[count++] = (peak){0, 0, find_error(e, q, 0, 0)};
    for (size_t arc = 0; arc <= q->junctions; arc++) {
        const double from = q->junction[arc], width = q->junction[arc + 1] - from;
        for (int k = 0; k < SAMPLES && count + 1 < MOST_PEAKS; k++) {
            double low = from + width * k / SAMPLES, high = from + width * (k + 1) / SAMPLES;
            const bool rises = find_slope(e, q, arc, low) > 0;
            if (low <= 0 || high >= NARC_PI / 2 || rises == (find_slope(e, q, arc, high) > 0))
                continue;
            for (int i = 0; i < HALVINGS; i++) {
                const double middle = low + (high - low) / 2;
                if ((find_slope(e, q, arc, middle) > 0) == rises)
                    low = middle;
                else
                    high = middle;
            }
            peaks[count++] = (peak){arc, low, find_error(e, q, arc, low)};
        }
    }
    peaks[count++] = (peak){q->junctions, NARC_PI / 2, find_error(e, q, q->junctions, NARC_PI / 2)};
    return count;
}

static double find_largest(const peak *peaks, size_t count) {
    double largest = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs(peaks[i].error));
    return largest;
}

/* By how much the errors, every other one turned, differ from their mean, relative to it. */
static double find_spread(const peak *peaks, size_t count) {
    double mean = 0, largest = 0;
    for (size_t i = 0; i < count; i++)
        mean += (i % 2 ? 1 : -1) * peaks[i].error / (double)count;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs((i % 2 ? 1 : -1) * peaks[i].error - mean));
    return largest / fabs(mean);
}

/* The unknowns: junctions, then radii. */
static double *find_unknown(quadrant *q, size_t k) {
    return k < q->junctions ? &q->junction[k + 1] : &q->radius[k - q->junctions];
}

/* The step of the unknowns, in out_step, that makes the errors at the peaks equal to first order. */
static bool find_step(ellipse e, const quadrant *q, const peak *peaks, size_t count, double *out_step) {
    const double nudge = 1e-6; /* central differences of smooth functions of size 1 */
    matrix rows;
    for (size_t k = 0; k + 1 < count; k++) {
        quadrant less = *q, more = *q;
        *find_unknown(&less, k) -= nudge;
        *find_unknown(&more, k) += nudge;
        place_centers(&less);
        place_centers(&more);
        for (size_t i = 0; i < count; i++)
            rows[i][k] = (find_error(e, &more, peaks[i].arc, peaks[i].angle) -
                          find_error(e, &less, peaks[i].arc, peaks[i].angle)) /
                         (2 * nudge);
    }
    for (size_t i = 0; i < count; i++) {
        rows[i][count - 1] = i % 2 ? 1 : -1; /* times the error that all shall have */
        rows[i][count] = -peaks[i].error;
    }
    if (!solve(rows, count))
        return false;
    for (size_t k = 0; k + 1 < count; k++)
        out_step[k] = rows[k][count];
    return true;
}

static bool is_in_order(const quadrant *q) {
    bool fine = true;
    for (size_t k = 0; k <= q->junctions; k++)
        fine = fine && q->junction[k] < q->junction[k + 1] && q->radius[k] > 0;
    return fine;
}

/* One exchange: the largest part of the step that brings the errors closer together. False if none does. */
static bool exchange(ellipse e, quadrant *q, double *spread) {
    const size_t wanted = 2 * q->junctions + 2;
    peak peaks[MOST_PEAKS];
    double step[MOST_UNKNOWNS];
    if (find_peaks(e, q, peaks) != wanted || !find_step(e, q, peaks, wanted, step))
        return false;
    for (double part = 1; part > 1e-3; part /= 2) {
        quadrant next = *q;
        for (size_t k = 0; k + 1 < wanted; k++)
            *find_unknown(&next, k) += part * step[k];
        place_centers(&next);
        if (!is_in_order(&next) || find_peaks(e, &next, peaks) != wanted)
            continue;
        const double after = find_spread(peaks, wanted);
        if (after < *spread) {
            *q = next;
            *spread = after;
            return true;
        }
    }
    return false;
}

/* Makes the largest errors equal, with at most *left exchanges; false if that fails. */
static bool equalise(ellipse e, quadrant *q, int *left) {
    const double equal = 1e-4; /* rounding leaves less, of errors of 1e-9 */
    double spread = INFINITY;
    while (spread > equal && (*left)-- > 0 && exchange(e, q, &spread))
        ;
    return spread <= equal;
}

static bool find_from_guess(ellipse e, quadrant *q, int *left) {
    guess_junctions(e, q);
    return guess_radii(e, q) && is_in_order(q) && equalise(e, q, left);
}

/* A rounder ellipse: half axes to a power of 0 to 1. */
static ellipse round_off(ellipse e, double power) {
    return power < 1 ? (ellipse){narc_pow(e.a, power), narc_pow(e.b, power)} : e;
}

/* If the guess is not good enough, the exchange starts from a rounder ellipse and follows it to the one that is wanted.
 * False if it loses its way. */
static bool follow(ellipse e, quadrant *q, int *left) {
    const double rounder = 0.8, roundest = 1e-3, least = 1e-4;
    double done = rounder;
    while (!find_from_guess(round_off(e, done), q, left))
        if (*left <= 0 || (done *= rounder) < roundest)
            return false;
    for (double stride = 0.1 * done; done < 1;) {
        const double next = fmin(1, done + stride);
        quadrant moved = *q;
        if (equalise(round_off(e, next), &moved, left)) {
            *q = moved;
            done = next;
            stride *= 2;
        } else if (*left <= 0 || (stride /= 2) < least) {
            return false;
        }
    }
    return true;
}

/* The nearest quadrant; of a thin ellipse with many arcs, if the exchange fails, the guess with the least squares.
 * False if that has none. */
static bool find_nearest(ellipse e, quadrant *q) {
    int left = 400; /* most need ten */
    if (find_from_guess(e, q, &left) || follow(e, q, &left))
        return true;
    guess_junctions(e, q);
    return guess_radii(e, q) && is_in_order(q);
}

/* ------------------------------------------------------------------------------------------------ the outline */

/* All four quadrants, counter-clockwise from the arc that holds the normal (1, 0). */
static size_t list_arcs(const quadrant *q, double scale, narc_arc *out_arcs) {
    const size_t m = q->junctions;
    for (size_t i = 0; i < 4 * m; i++) {
        size_t turn = i / (2 * m), k = i % (2 * m) <= m ? i % (2 * m) : 2 * m - i % (2 * m);
        bool left = i % (2 * m) > m; /* of the y axis, before it is turned by half a turn */
        double start = k > 0 ? q->junction[k] : -q->junction[1],
               end = k < m ? q->junction[k + 1] : NARC_PI - q->junction[m];
        double x = scale * (left ? -q->center_x[k] : q->center_x[k]), y = scale * q->center_y[k];
        double from = left ? NARC_PI - end : start, to = left ? NARC_PI - start : end;
        /* Half a turn: angles stay in -pi .. pi. */
        out_arcs[i] = turn == 0 ? (narc_arc){x, y, scale * q->radius[k], from, to}
                                : (narc_arc){-x, -y, scale * q->radius[k], from - NARC_PI, to - NARC_PI};
        if (turn == 1 && k == 0)
            out_arcs[i].start = NARC_PI - q->junction[1];
    }
    return 4 * m;
}

narc_status narc_build_ellipse(double half_x, double half_y, size_t arc_count, narc_arc *out_arcs, size_t *out_count,
                               double *out_distance, narc_error *error) {
    if (!out_arcs || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an output is NULL");
    const double halves[] = {half_x, half_y}, size = fmax(half_x, half_y);
    for (int k = 0; k < 2; k++) {
        const char *name = k ? "half_y" : "half_x";
        if (!isfinite(halves[k]))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, halves[k], "%s is %g", name, halves[k]);
        if (!(halves[k] > 0))
            return narc_fail(error, NARC_ERROR_SIZE, 0, halves[k], "%s is %g, not above 0", name, halves[k]);
    }
    /* Squares of all lengths are numbers, and no arc is flatter than a shape may have. */
    if (!(fmin(half_x, half_y) >= 1e-150 && size <= 1e150))
        return narc_fail(error, NARC_ERROR_SIZE, 0, size, "the half axes are %g and %g, not from 1e-150 to 1e150",
                         half_x, half_y);
    if (size > 2 * NARC_MAX_RADIUS_RATIO * fmin(half_x, half_y))
        return narc_fail(error, NARC_ERROR_RADIUS, 0, half_x / half_y, "an ellipse %.6g by %.6g is too thin", half_x,
                         half_y);
    if (arc_count < 4 || arc_count > NARC_MAX_ARCS || arc_count % 4 != 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)arc_count, "arc_count is %zu, not 4, 8, 12 ... %d",
                         arc_count, NARC_MAX_ARCS);
    double distance = fabs(half_x - half_y) / 2;
    narc_arc arcs[NARC_MAX_ARCS] = {{0, 0, half_x / 2 + half_y / 2, -NARC_PI, NARC_PI}};
    size_t count = 1;
    if (distance > NARC_TOLERANCE * size) {
        const ellipse e = {half_x / size, half_y / size};
        quadrant q = {.junctions = arc_count / 4};
        peak peaks[MOST_PEAKS];
        if (!find_nearest(e, &q))
            return narc_fail(error, NARC_ERROR_RADIUS, 0, half_x / half_y,
                             "an ellipse %.6g by %.6g is too thin for %zu arcs", half_x, half_y, arc_count);
        distance = size * find_largest(peaks, find_peaks(e, &q, peaks));
        count = list_arcs(&q, size, arcs);
    }
    const narc_status status = narc_validate_arcs(arcs, count, error);
    if (status != NARC_OK)
        return status;
    memcpy(out_arcs, arcs, count * sizeof *arcs);
    *out_count = count;
    if (out_distance)
        *out_distance = distance;
    return NARC_OK;
}
