/* SPDX-License-Identifier: MIT
 *
 * scene.c - narc scene: bodies at random places.
 */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "commands.h"
#include "fail.h"
#include "options.h"
#include "output.h"
#include "progress.h"
#include "text.h"
#include "turn.h"

/* SplitMix64: a counter in steps of the golden ratio, its bits mixed by two multiplications. */
static uint64_t next_random(uint64_t *state) {
    uint64_t bits = *state += UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94d049bb133111eb);
    return bits ^ (bits >> 31);
}

/* In [0, 1), a multiple of 2^-53. */
static double next_uniform(uint64_t *state) { return (double)(next_random(state) >> 11) * 0x1p-53; }

/* In [0, count): the bias of a 64-bit multiple is beyond notice. */
static size_t next_index(uint64_t *state, size_t count) { return (size_t)(next_uniform(state) * (double)count); }

static void run(int argc, char **argv) {
    enum { SHAPES, BODIES, DENSITY, SEED, OUT, OPTIONS };
    option options[OPTIONS] = {{"--shapes", INPUT_FILE, NULL},
                               {"--bodies", true, NULL},
                               {"--density", true, NULL},
                               {"--seed", true, NULL},
                               {"--out", OUTPUT_FILE, NULL}};
    parse_options(argc, argv, options, OPTIONS, NULL, NULL);
    const char *path = required_option(&options[SHAPES]), *out = options[OUT].value ? options[OUT].value : "-";
    const uint64_t count = whole_option(&options[BODIES], 1, UINT32_MAX);
    required_option(&options[DENSITY]);
    const double density = number_option(&options[DENSITY], DBL_MIN, 10, "more than 0 and at most 10", 0);
    const uint64_t seed = whole_option(&options[SEED], 0, UINT64_MAX);

    narc_shapes *store;
    narc_shape_list *shapes = read_shapes(path, &store); /* all of them can be in a store */
    double *areas = allocate(shapes->count, sizeof *areas);
    for (size_t k = 0; k < shapes->count; k++) {
        narc_mass mass;
        if (shapes->items[k].form != NARC_FORM_SHAPE)
            fail_at(path, 0, "shape '%s' is %s, which this command does not take", shapes->items[k].name,
                    shapes->items[k].form == NARC_FORM_HALF_PLANE ? "a half-plane" : "a chain");
        narc_compute_mass(shapes->items[k].arcs, shapes->items[k].arc_count, &mass);
        areas[k] = mass.area;
    }
    uint64_t state = seed;
    double area = 0;
    for (uint64_t i = 0; i < count; i++) {
        area += areas[next_index(&state, shapes->count)];
        show_progress("measuring shapes", (size_t)i, (size_t)count);
    }
    /* Rounded to single precision: areas come from sines, whose last bit differs from one C library to the next. */
    const double side = (double)(float)sqrt(area / density);

    if (!isfinite(side))
        fail("--density is too small '%s'", narc_make_excerpt(options[DENSITY].value).text);

    /* The same shapes once more, from the same seed; places from where that sequence ended. */
    uint64_t shape_state = seed;
    FILE *file = open_output(out);
    fprintf(file, "shape,x,y,angle\n");
    for (uint64_t i = 0; i < count && !ferror(file); i++) {
        const char *name = shapes->items[next_index(&shape_state, shapes->count)].name;
        const double x = side * (next_uniform(&state) - 0.5), y = side * (next_uniform(&state) - 0.5);
        const double angle = FULL_TURN * next_uniform(&state);
        fprintf(file, "%s,%.17g,%.17g,%.17g\n", name, x, y, angle);
        show_progress("writing bodies", (size_t)i, (size_t)count);
    }
    FILE *report = finish_outputs();
    fprintf(report, "%" PRIu64 " bodies of %zu shapes in a square of side %g\n", count, shapes->count, side);
    finish_report(report);
    commit_outputs();
    free(areas);
    narc_destroy_shape_list(shapes);
    narc_destroy_shapes(store);
}

const command scene_command = {"scene", "bodies at random places", run};
