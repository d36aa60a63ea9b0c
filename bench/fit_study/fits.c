/* SPDX-License-Identifier: MIT
 *
 * fits.c - all fits of all subjects; n-arcs against those of a longer search, of the same outlines turned and in a mirror,
 * and with fewer arcs.
 */
#include "fits.h"

#include <float.h>

#include "fail.h"

/* Degrees; the last one is in a mirror. */
enum { TURNS = 5 };
static const double turns[TURNS] = {0, 20, 45, 110, 0};

/* The outline's points, turned. */
static narc_path *turn_subject(const subject *of, double degrees, bool mirror) {
    narc_path *path = make_path();
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    for (size_t k = 0, contour = 0; k < of->contours.point_count; k++) {
        const narc_point p = of->contours.points[k];
        const double x = mirror ? -p.x : p.x;
        const narc_point turned = {c * x - s * p.y, s * x + c * p.y};
        const bool first = k == 0 || k == of->contours.ends[contour];
        contour += first && k > 0;
        if ((first ? narc_move_to : narc_line_to)(path, &turned, NULL) != NARC_OK)
            fail("%s: a point that can't be turned", of->name);
    }
    return path;
}

static double measure_turned(const subject *of, size_t turn, size_t size, unsigned starts) {
    narc_path *path = turn_subject(of, turns[turn], turn + 1 == TURNS);
    const narc_fit_request request = {.arc_count = sizes[size], .starts = starts};
    narc_fit_result made;
    narc_error error;
    if (narc_fit_path(path, &request, &made, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    narc_destroy_path(path);
    return made.area;
}

static trial try_size(const subject *of, size_t size, unsigned starts) {
    double least = INFINITY, most = 0, plain = 0;
    for (size_t turn = 0; turn < TURNS; turn++) {
        const double area = measure_turned(of, turn, size, starts);
        plain = turn == 0 ? area : plain;
        least = fmin(least, area);
        most = fmax(most, area);
    }
    const double longer = measure_turned(of, 0, size, TIMES * (starts ? starts : USUAL_STARTS));
    return (trial){.excess = plain / longer - 1, .spread = most / least - 1};
}

static void find_fit(const subject *of, family which, size_t size, unsigned starts, fit *out) {
    static const narc_fit_family families[] = {NARC_FIT_N_ARC, NARC_FIT_EDGES, NARC_FIT_POLYGON, NARC_FIT_PAPER};
    const narc_fit_request request = {
        .arc_count = sizes[size], .family = families[which], .goal = NARC_FIT_BOUND_AREA, .starts = starts};
    narc_error error;
    const narc_status status = narc_fit_path(of->path, &request, &out->made, &error);
    out->found = status == NARC_OK;
    if (!out->found && !(which == ROUTE && status == NARC_ERROR_NO_SOLUTION))
        fail("%s: %s", of->name, error.message);
}

void find_fits(study *all, unsigned starts) {
    /* The longest first, so that processors end together: trials, large sizes, then slow families. */
    static const family slow_first[FAMILIES] = {ARCS_AND_EDGES, N_ARC, ROUTE, N_GON};
    const size_t jobs = all->count * (FAMILIES + 1) * SIZES;
    size_t done = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (size_t job = 0; job < jobs; job++) {
        subject *of = &all->subjects[job % all->count];
        const size_t row = job / all->count, size = SIZES - 1 - row % SIZES;
        if (row >= SIZES)
            find_fit(of, slow_first[row / SIZES - 1], size, starts, &of->fits[slow_first[row / SIZES - 1]][size]);
        else
            of->trials[size] = of->of == GRAINS ? (trial){NAN, NAN} : try_size(of, size, starts);
#ifdef _OPENMP
#pragma omp critical
#endif
        if (++done % all->count == 0)
            fprintf(stderr, "fits: %zu of %zu\n", done, jobs);
    }
}

/* ---------------------------------------------------------------------------- checks */

/* How much areas may differ by rounding, relative to the hull's: fits hold the outline with the flatness of its curves
 * around it, and 16 roundings to single precision of lengths that are less than the perimeter, all along the perimeter. */
static double find_slack(const fit *of) {
    const double moved = of->made.flatness + 16 * FLT_EPSILON * of->made.perimeter;
    return moved * of->made.perimeter / of->made.hull_area;
}

size_t count_worse(const study *all, size_t size) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        for (family which = N_ARC; which <= N_GON; which++) {
            const subject *of = &all->subjects[i];
            const double more = value_of(of, which, size, AREA), less = value_of(of, which, size - 1, AREA);
            count += !(more <= less + find_slack(&of->fits[which][size]));
        }
    }
    return count;
}

bool check_fits(const study *all) {
    const size_t worse = count_worse(all, 1) + count_worse(all, 2);
    size_t small = 0;
    for (size_t i = 0; i < all->count; i++)
        for (int cell = 0; cell < FAMILIES * SIZES; cell++) {
            const fit *at = &all->subjects[i].fits[cell / SIZES][cell % SIZES];
            if (at->found && !(at->made.area >= at->made.hull_area * (1 - find_slack(at)))) {
                fprintf(stderr, "fit_study: %s: %s, n = %zu, is smaller than the hull\n", all->subjects[i].name,
                        family_names[cell / SIZES], sizes[cell % SIZES]);
                small++;
            }
        }
    if (worse > 0)
        fprintf(stderr, "fit_study: %zu fits are larger than with fewer arcs\n", worse);
    return worse == 0 && small == 0;
}
