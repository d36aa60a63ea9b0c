/* SPDX-License-Identifier: MIT
 *
 * main.c - the goodness of fit of n-arcs, arcs with edges and n-gons on real outlines: the study of section 3.2 of
 * "Using Piecewise Circular Curves as a 2D Collision Primitive", done again. README.md beside this file says what is
 * measured.
 *
 *     fit_study --font=FILE --drawings=FOLDER [--grains=FOLDER] [--out=FOLDER]
 *     fit_study --quick --font=FILE [--grains=FOLDER] [--out=FOLDER]
 */
#include <string.h>

#include "fail.h"
#include "fits.h"
#include "options.h"
#include "output.h"
#include "pictures.h"
#include "progress.h"
#include "tables.h"

enum { QUICK_STARTS = 2, PATH_SIZE = 4096 };

static const char *in_folder(const char *folder, const char *name, char *path) {
    if (snprintf(path, PATH_SIZE, "%s/%s", folder, name) >= PATH_SIZE)
        fail("%s: the name is too long", folder);
    return path;
}

static void write_file(const study *all, const char *folder, const char *name,
                       void (*print)(const study *all, FILE *out)) {
    char path[PATH_SIZE];
    print(all, open_output(in_folder(folder, name, path)));
    finish_outputs();
    commit_outputs();
}

static void draw_pictures(const study *all, const char *folder) {
    char name[64], path[PATH_SIZE];
    for (size_t i = 0; i < PAPER_SUBJECTS; i++) {
        snprintf(name, sizeof name, "fit-%s.png", all->subjects[i].name);
        draw_subject(&all->subjects[i], in_folder(folder, name, path));
    }
    draw_bounds(&all->subjects[0], in_folder(folder, "fit-figure2.png", path)); /* the ghost, which leans */
    draw_many(all, false, in_folder(folder, "fit-others.png", path));
    draw_many(all, true, in_folder(folder, "fit-grains.png", path));
}

int main(int argc, char **argv) {
    enum { FONT, DRAWINGS, SAND, OUT, QUICK, OPTIONS };
    option options[OPTIONS] = {
        [FONT] = {"--font", true, NULL}, [DRAWINGS] = {"--drawings", true, NULL}, [SAND] = {"--grains", true, NULL},
        [OUT] = {"--out", true, NULL},   [QUICK] = {"--quick", false, NULL},
    };
    parse_options(argc - 1, argv + 1, options, OPTIONS, NULL, NULL);
    const char *folder = options[OUT].value ? options[OUT].value : "out";
    const double begin = seconds_now();
    study all = load_subjects(required_option(&options[FONT]),
                              options[QUICK].value ? NULL : required_option(&options[DRAWINGS]), options[SAND].value);
    find_fits(&all, options[QUICK].value ? QUICK_STARTS : 0);
    fprintf(stderr, "pictures and tables\n");
    draw_pictures(&all, folder);
    write_file(&all, folder, "fit-study.md", print_results);
    write_file(&all, folder, "fit-study.csv", print_csv);
    write_file(&all, folder, "fit-study.dat", print_points);
    const bool right = check_fits(&all);
    fprintf(stderr, "%zu outlines, %.0f seconds\n", all.count, seconds_now() - begin);
    free_subjects(&all);
    return right ? 0 : 1;
}
