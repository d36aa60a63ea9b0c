/* SPDX-License-Identifier: MIT
 *
 * trials.c - how far the search can be relied on: n-arcs against those of a longer search, of the same outlines turned
 * and in a mirror, and with fewer arcs.
 */
#include <math.h>

#include "fail.h"
#include "numbers.h"

enum { USUAL_STARTS = 56, TIMES = 8 };

/* Degrees; the last one is in a mirror. */
enum { TURNS = 5 };
static const double turns[TURNS] = {0, 20, 45, 110, 0};

/* The outline's points, turned. */
static narc_path *turn_subject(const subject *of, double degrees, bool mirror) {
    narc_path *path = make_path();
    const double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    size_t contour = 0;
    for (size_t k = 0; k < of->contours.point_count; k++) {
        const narc_point p = of->contours.points[k];
        const double x = mirror ? -p.x : p.x;
        const narc_point turned = {c * x - s * p.y, s * x + c * p.y};
        const bool first = k == 0 || k == of->contours.ends[contour];
        contour += first && k > 0;
        if ((first ? narc_move_to : narc_line_to)(path, turned, NULL) != NARC_OK)
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

void find_trials(study *all, unsigned starts) {
    const size_t jobs = all->count * SIZES;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (size_t job = 0; job < jobs; job++) {
        subject *of = &all->subjects[job / SIZES];
        const size_t size = job % SIZES;
        of->trials[size] = of->of == GRAINS ? (trial){NAN, NAN} : try_size(of, size, starts);
    }
}

/* How many fits are larger than the one with fewer arcs. The paper's route promises nothing. */
static size_t count_worse(const study *all, size_t size) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        for (family which = N_ARC; which <= N_GON; which++) {
            const subject *of = &all->subjects[i];
            const double more = area_of(of, which, size), less = area_of(of, which, size - 1);
            count += !(more <= less + find_slack(&of->fits[which][size]));
        }
    }
    return count;
}

static void print_trial(const study *all, bool spread, FILE *out) {
    for (size_t size = 0; size < SIZES; size++) {
        numbers found = {0};
        for (size_t i = 0; i < all->count; i++) {
            const trial *at = &all->subjects[i].trials[size];
            add_number(&found, 100 * (spread ? at->spread : at->excess));
        }
        print_range(&found, 3, out);
        fprintf(out, " |");
    }
    fputc('\n', out);
}

void print_trials(const study *all, FILE *out) {
    fprintf(out,
            "### How far the search can be relied on: n-arcs, median (least to largest) in percent of the area\n\n"
            "All outlines but the grains; the last row has them too.\n\n"
            "| | n = 4 | 6 | 8 |\n| --- | ---: | ---: | ---: |\n"
            "| larger than with %d times the starts |",
            TIMES);
    print_trial(all, false, out);
    fprintf(out, "| largest over least, turned by 0, 20, 45, 110 degrees and in a mirror |");
    print_trial(all, true, out);
    fprintf(out, "| larger than with two arcs, or corners, less: how many, of all families | | %zu | %zu |\n\n",
            count_worse(all, 1), count_worse(all, 2));
}

bool check_trials(const study *all) {
    const size_t worse = count_worse(all, 1) + count_worse(all, 2);
    if (worse > 0)
        fprintf(stderr, "fit_study: %zu fits are larger than with fewer arcs\n", worse);
    return worse == 0;
}
