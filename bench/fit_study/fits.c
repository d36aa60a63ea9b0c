/* SPDX-License-Identifier: MIT
 *
 * fits.c - all fits of all subjects, on all processors, and how they agree with each other.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "fail.h"
#include "study.h"

static narc_status find_fit(const subject *of, family which, size_t size, unsigned starts, fit *out,
                            narc_error *error) {
    const narc_fit_request request = {
        .arc_count = sizes[size], .family = family_requests[which], .goal = NARC_FIT_BOUND_AREA, .starts = starts};
    const narc_status status = narc_fit_path(of->path, &request, &out->made, error);
    out->found = status == NARC_OK;
    return which == ROUTE && status == NARC_ERROR_NO_SOLUTION ? NARC_OK : status;
}

/* Jobs are numbered with the longest first, so that processors end together: large sizes, then slow families. */
static void find_job(size_t job, size_t subjects, size_t *out_subject, family *out_family, size_t *out_size) {
    static const family slow_first[FAMILIES] = {ARCS_AND_EDGES, N_ARC, ROUTE, N_GON};
    *out_subject = job % subjects;
    *out_family = slow_first[job / subjects % FAMILIES];
    *out_size = SIZES - 1 - job / subjects / FAMILIES;
}

void find_fits(study *all, unsigned starts) {
    const size_t jobs = all->count * FAMILIES * SIZES;
    size_t done = 0;
    narc_status worst = NARC_OK;
    narc_error message;
    const char *name = "";
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (size_t job = 0; job < jobs; job++) {
        size_t which, size;
        family way;
        find_job(job, all->count, &which, &way, &size);
        subject *of = &all->subjects[which];
        narc_error error;
        const narc_status status = find_fit(of, way, size, starts, &of->fits[way][size], &error);
#ifdef _OPENMP
#pragma omp critical
#endif
        {
            if (status != NARC_OK && worst == NARC_OK) {
                worst = status;
                message = error;
                name = of->name;
            }
            if (++done % all->count == 0)
                fprintf(stderr, "fits: %zu of %zu\n", done, jobs);
        }
    }
    if (worst != NARC_OK)
        fail("%s: %s", name, message.message);
}

/* ---------------------------------------------------------------------------- checks */

/* The fits hold the outline with
 * the flatness of its curves around it, and 16 roundings to single precision of lengths that are less than the
 * perimeter, all along the perimeter. */
double find_slack(const fit *of) {
    const double moved = of->made.flatness + 16 * FLT_EPSILON * of->made.perimeter;
    return moved * of->made.perimeter / of->made.hull_area;
}

bool check_bounds(const study *all) {
    bool right = true;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        for (int cell = 0; cell < FAMILIES * SIZES; cell++) {
            const fit *at = &of->fits[cell / SIZES][cell % SIZES];
            if (at->found && !(at->made.area >= at->made.hull_area * (1 - find_slack(at)))) {
                fprintf(stderr, "fit_study: %s: %s, n = %zu, is smaller than the hull\n", of->name,
                        family_names[cell / SIZES], sizes[cell % SIZES]);
                right = false;
            }
        }
    }
    return right;
}

/* The least area among shapes that the study knows to be allowed for a fit, and what they are. */
static double find_known(const subject *of, family which, size_t size, const char **out_what) {
    double least = INFINITY;
    if (size > 0 && which != ROUTE) {
        least = area_of(of, which, size - 1);
        *out_what = "the one with two arcs or corners less";
    }
    const double greedy = of->greedy[size] / of->around.area;
    if (which == N_GON && greedy < least) {
        least = greedy;
        *out_what = "the n-gon by taking sides away";
    }
    if (which == N_ARC && area_of(of, ROUTE, size) < least) {
        least = area_of(of, ROUTE, size);
        *out_what = "the paper's route";
    }
    for (family narrower = N_ARC; which == ARCS_AND_EDGES && narrower <= N_GON; narrower++) {
        if (narrower != ARCS_AND_EDGES && area_of(of, narrower, size) < least) {
            least = area_of(of, narrower, size);
            *out_what = family_names[narrower];
        }
    }
    return least;
}

void print_shortfalls(const study *all, FILE *out) {
    size_t count = 0;
    fprintf(out, "### Fits that are known not to be the best\n\n");
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        for (int cell = 0; cell < FAMILIES * SIZES; cell++) {
            const family which = (family)(cell / SIZES);
            const size_t size = (size_t)cell % SIZES;
            const char *what = "";
            const double known = find_known(of, which, size, &what), area = area_of(of, which, size);
            if (area > known + find_slack(&of->fits[which][size])) {
                fprintf(out, "- %s, %s, n = %zu: %.5f; %s has %.5f\n", of->name, family_names[which], sizes[size], area,
                        what, known);
                count++;
            }
        }
    }
    fprintf(out, "%s%zu of %zu fits are larger than another shape of the study that they might have been.\n\n",
            count ? "\n" : "", count, all->count * FAMILIES * SIZES);
}
