/* SPDX-License-Identifier: MIT
 *
 * grains.c - outlines of sand grains: how they are read, and their part of the report.
 */
#include <math.h>
#include <stdlib.h>

#include "fail.h"
#include "numbers.h"

static const char *const sands[] = {"river", "sea"};
enum { SANDS = sizeof sands / sizeof sands[0] };

void name_grain_file(const subject *of, char *out_name, size_t size) {
    snprintf(out_name, size, "%s-%02u.csv", of->sand, of->number);
}

/* ---------------------------------------------------------------------------- reading */

/* False if there is no such grain. */
static bool add_grain(study *all, const char *folder, const char *sand, unsigned number) {
    if (all->count == MOST_SUBJECTS)
        fail("%s: too many grains", folder);
    subject *of = &all->subjects[all->count];
    *of = (subject){.of = GRAINS, .sand = sand, .number = number};
    char file[32];
    size_t size;
    name_grain_file(of, file, sizeof file);
    char *bytes = read_from(folder, file, &size);
    if (!bytes)
        return false;
    snprintf(of->label, sizeof of->label, "%s %u", sand, number);
    of->name = of->label;
    of->path = make_path();
    narc_error error;
    if (narc_read_csv(bytes, size, of->path, &error) != NARC_OK)
        fail("%s/%s: %s", folder, file, error.message);
    free(bytes);
    measure_subject(of);
    all->count++;
    return true;
}

void add_grains(study *all, const char *folder) {
    for (size_t k = 0; k < SANDS; k++) {
        unsigned number = 1;
        while (add_grain(all, folder, sands[k], number))
            number++;
        if (number == 1)
            fail("%s holds no %s-01.csv; grains.R of the study writes the grains", folder, sands[k]);
    }
}

/* ---------------------------------------------------------------------------- report */

/* The grains of a sand, or all for NULL. */
static size_t pick_grains(const study *all, const char *sand, const subject **out_some) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (of->of == GRAINS && (!sand || of->sand == sand))
            out_some[count++] = of;
    }
    return count;
}

static void print_quantity(const subject *const *some, size_t count, family which, quantity what, int decimals,
                           FILE *out) {
    for (size_t size = 0; size < SIZES; size++) {
        numbers values = {0};
        for (size_t i = 0; i < count; i++)
            add_number(&values, value_of(some[i], which, size, what));
        print_range(&values, decimals, out);
        fputs(" |", out);
    }
    fputc('\n', out);
}

static void print_sand(const study *all, const char *sand, const subject **some, FILE *out) {
    const size_t count = pick_grains(all, sand, some);
    fprintf(out, "| n-arc / n-gon, %zu grains of %s sand |", count, sand);
    for (size_t size = 0; size < SIZES; size++) {
        numbers ratios = {0};
        for (size_t i = 0; i < count; i++)
            add_number(&ratios, ratio_of(some[i], size));
        print_range(&ratios, 3, out);
        fputs(" |", out);
    }
    fputc('\n', out);
}

/* The area inside an outline that does not cross itself. */
static double measure_inside(const narc_contours *contours) {
    double area = 0;
    size_t start = 0;
    for (size_t k = 0; k < contours->count; start = contours->ends[k++]) {
        for (size_t i = start; i < contours->ends[k]; i++) {
            const narc_point a = contours->points[i];
            const narc_point b = contours->points[i + 1 < contours->ends[k] ? i + 1 : start];
            area += 0.5 * (a.x * b.y - b.x * a.y);
        }
    }
    return fabs(area);
}

static void print_hulls(const subject *const *some, size_t count, FILE *out) {
    numbers hollows = {0}, straight = {0};
    for (size_t i = 0; i < count; i++) {
        add_number(&hollows, 100 * (some[i]->around.area / measure_inside(&some[i]->contours) - 1));
        add_number(&straight, 100 * some[i]->straight_share);
    }
    fprintf(out, "A hull is larger than its grain by");
    print_range(&hollows, 1, out);
    fprintf(out, " %%. The straight part of its perimeter is");
    print_range(&straight, 0, out);
    fprintf(out, " %%.\n\n");
}

/* How much larger than the hull, in percent, the median of a family is. */
static double find_excess(const subject *const *some, size_t count, family which, size_t size) {
    numbers areas = {0};
    for (size_t i = 0; i < count; i++)
        add_number(&areas, area_of(some[i], which, size));
    return 100 * (find_quantile(&areas, 0.5) - 1);
}

static void print_meaning(const subject *const *some, size_t count, FILE *out) {
    numbers discs = {0};
    for (size_t i = 0; i < count; i++) {
        const narc_fit_result disc = find_disc(some[i]);
        add_number(&discs, disc.area / disc.hull_area);
    }
    fprintf(out,
            "For simulations of particles: the least disc around a grain has %.0f %% more area than the grain's hull "
            "(median)",
            100 * (find_quantile(&discs, 0.5) - 1));
    for (size_t size = 0; size < SIZES; size++) {
        fprintf(out, "%s %zu-arc %.1f %% (with edges %.1f, %zu-gon %.1f)", size + 1 < SIZES ? ", the" : " and the",
                sizes[size], find_excess(some, count, N_ARC, size), find_excess(some, count, ARCS_AND_EDGES, size),
                sizes[size], find_excess(some, count, N_GON, size));
    }
    fprintf(out, ".\n\n");
}

void print_grains(const study *all, FILE *out) {
    const subject **some = allocate(all->count, sizeof *some);
    const size_t count = pick_grains(all, NULL, some);
    fprintf(out, "### Sand grains: median (least to largest)\n\n");
    if (count == 0) {
        fprintf(out, "Left out: the study was not given any.\n\n");
        free(some);
        return;
    }
    fprintf(out, "| | n = 4 | 6 | 8 |\n| --- | ---: | ---: | ---: |\n");
    for (family which = N_ARC; which < FAMILIES; which++) {
        fprintf(out, "| %s: area, hull = 1 |", family_names[which]);
        print_quantity(some, count, which, AREA, 4, out);
    }
    fprintf(out, "| n-arc: largest distance, %% |");
    print_quantity(some, count, N_ARC, LARGEST, 2, out);
    fprintf(out, "| n-arc: mean distance, %% |");
    print_quantity(some, count, N_ARC, MEAN, 2, out);
    for (size_t k = 0; k < SANDS; k++)
        print_sand(all, sands[k], some, out);
    fputc('\n', out);
    pick_grains(all, NULL, some);
    print_meaning(some, count, out);
    print_hulls(some, count, out);
    free(some);
}
