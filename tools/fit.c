/* SPDX-License-Identifier: MIT
 *
 * fit.c - narc fit: outlines from files of any kind to arc shapes.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "canvas.h"
#include "commands.h"
#include "fail.h"
#include "fit_inputs.h"
#include "options.h"
#include "output.h"
#include "picture_fits.h"
#include "progress.h"
#include "splines.h"
#include "text.h"

static const char HELP[] =
    "usage: narc fit INPUT... --arcs N|--tolerance T [--bound|--approximate] [--objective NAME]\n"
    "                [--edges|--polygon|--paper] [--characters TEXT] [--silhouette NAME]\n"
    "                [--threshold X] [--flatness F] [--min-radius R] [--starts N] [--keep-origin]\n"
    "                [--keep-going] [--out shapes.json] [--picture FILE]\n"
    "       narc fit INPUT... --spline --tolerance T [--characters TEXT] [--silhouette NAME]\n"
    "                [--threshold X] [--keep-going] [--out splines.json] [--picture FILE]\n"
    "\n"
    "Makes an arc shape of each input: the best that is found of those that bound the outline, or of\n"
    "those that come close to it. Of an outline only the convex hull counts.\n"
    "\n"
    "  INPUT           files; the first bytes tell their kind, or else the suffix:\n"
    "                  fonts         with --characters: each of these is one shape; lengths in em\n"
    "                  SVG           what is drawn, as one shape, traced at its edge\n"
    "                  PNG           the silhouette: what is not transparent; lengths in pixels\n"
    "                  CSV           points, one x,y a line, or columns x and y of a table; a blank\n"
    "                                line begins another contour\n"
    "                  JSON          points, [[x, y], ...], or a list of such lists\n"
    "  --arcs N        at most N arcs a shape, 1 to 32\n"
    "  --tolerance T   instead: as few arcs as stay within the distance T of the hull, in the\n"
    "                  input's unit of length\n"
    "  --bound         the shape contains the outline; the default\n"
    "  --approximate   it may also lie inside\n"
    "  --objective NAME\n"
    "                  with --arcs: what is least\n"
    "                  area          with --bound, where it is the default: the shape's area;\n"
    "                                with --approximate: the area between shape and hull\n"
    "                  perimeter     with --bound only: the shape's perimeter\n"
    "                  distance      the largest distance of shape and hull; the default with\n"
    "                                --approximate\n"
    "  --edges         straight edges may stand between arcs; without it tangents are continuous\n"
    "  --polygon       to compare: a bounding polygon of least area, its corners arcs of radius 0\n"
    "  --paper         to compare: such a polygon turned into an n-arc by the paper's Algorithm 1,\n"
    "                  enlarged until it bounds\n"
    "  --characters TEXT\n"
    "                  which glyphs of fonts, UTF-8; repeated characters are skipped\n"
    "  --silhouette NAME\n"
    "                  what counts in PNG and SVG: alpha (the default), dark or light\n"
    "  --threshold X   how much of that; above 0 and below 1, default 0.5 of PNG, 0.25 of SVG\n"
    "  --flatness F    how far chords may be from curves, as a part of the larger side of the\n"
    "                  outline's bounding box; 1e-9 to 0.1, default 2e-5\n"
    "  --min-radius R  no arc has a smaller radius, in the input's unit of length: shapes are smooth\n"
    "  --starts N      how many places the search starts from, 1 to 10000; more are never worse\n"
    "  --keep-origin   the shapes keep the input's coordinates: a body at 0, 0 lies over its outline;\n"
    "                  far from its origin a shape is rounded more\n"
    "  --spline        instead of a convex shape: the outline itself as arcs that join with a common\n"
    "                  tangent, within --tolerance of its curves\n"
    "  --keep-going    what cannot be read or fitted is left out; its error is told, and the exit status\n"
    "                  is 1\n"
    "  --out FILE      the shapes file to write; left out or -: standard output\n"
    "  --picture FILE  a .png or .svg picture of outlines, hulls and shapes\n"
    "\n"
    "A shape is named by its file without the suffix (shape-0 for 0.csv), a glyph by its ASCII letter or\n"
    "its code point (U+1F47B); names that are taken get -2, -3 and so on. A shape's centroid is its\n"
    "origin; \"origin\" in the shapes file tells where that is in the input's coordinates.\n"
    "\n"
    "The table has areas of shape and hull and their ratio, how far the shape is from the hull: at\n"
    "most, and in the mean along the shape, and the origin.\n";

enum {
    ARCS,
    TOLERANCE,
    BOUND,
    APPROXIMATE,
    OBJECTIVE,
    EDGES,
    POLYGON,
    PAPER,
    CHARACTERS,
    SILHOUETTE,
    THRESHOLD,
    FLATNESS,
    MIN_RADIUS,
    STARTS,
    SPLINE,
    KEEP_ORIGIN,
    KEEP_GOING,
    OUT,
    PICTURE,
    OPTIONS
};

/* ---------------------------------------------------------------------------- options */

static void exclude(const option *a, const option *b, const char *why) {
    if (a->value && b->value)
        fail("%s and %s exclude each other: %s", a->name, b->name, why);
}

static void check_combinations(const option *options) {
    static const char families[] = "each asks for shapes of its own kind";
    exclude(&options[ARCS], &options[TOLERANCE], "one gives the number of arcs, the other lets it be found");
    exclude(&options[BOUND], &options[APPROXIMATE], "a shape that bounds lies nowhere inside");
    exclude(&options[EDGES], &options[POLYGON], families);
    exclude(&options[EDGES], &options[PAPER], families);
    exclude(&options[POLYGON], &options[PAPER], families);
    exclude(&options[TOLERANCE], &options[OBJECTIVE], "the least number of arcs is looked for");
    for (int family = POLYGON; family <= PAPER; family++)
        exclude(&options[family], &options[APPROXIMATE], "it bounds");
    static const int of_hulls[] = {ARCS,    BOUND, APPROXIMATE, OBJECTIVE, EDGES,
                                   POLYGON, PAPER, FLATNESS,    STARTS,    KEEP_ORIGIN};
    for (size_t k = 0; k < sizeof of_hulls / sizeof of_hulls[0]; k++)
        exclude(&options[SPLINE], &options[of_hulls[k]], "a spline follows the outline itself, within --tolerance");
    if (!options[ARCS].value && !options[TOLERANCE].value)
        fail("--arcs or --tolerance is missing");
}

static narc_fit_goal choose_goal(const option *options) {
    const char *objective = options[OBJECTIVE].value;
    const bool approximate = options[APPROXIMATE].value;
    if (!objective)
        return approximate ? NARC_FIT_DISTANCE : NARC_FIT_BOUND_AREA;
    for (int family = POLYGON; family <= PAPER; family++) {
        if (options[family].value && strcmp(objective, "area") != 0) {
            fail("%s makes the area least: --objective cannot be '%s'", options[family].name,
                 narc_make_excerpt(objective).text);
        }
    }
    if (strcmp(objective, "area") == 0)
        return approximate ? NARC_FIT_DIFFERENCE : NARC_FIT_BOUND_AREA;
    if (strcmp(objective, "distance") == 0)
        return approximate ? NARC_FIT_DISTANCE : NARC_FIT_BOUND_DISTANCE;
    if (strcmp(objective, "perimeter") != 0)
        fail("--objective must be one of area, perimeter, distance, not '%s'", narc_make_excerpt(objective).text);
    if (approximate)
        fail("--objective perimeter is for --bound: what may lie inside has the least perimeter as a point");
    return NARC_FIT_BOUND_PERIMETER;
}

static narc_fit_request make_request(const option *options) {
    static const narc_fit_family families[] = {
        [EDGES] = NARC_FIT_EDGES, [POLYGON] = NARC_FIT_POLYGON, [PAPER] = NARC_FIT_PAPER};
    check_combinations(options);
    narc_fit_request request = {.goal = choose_goal(options), .family = NARC_FIT_N_ARC};
    for (int k = EDGES; k <= PAPER; k++)
        request.family = options[k].value ? families[k] : request.family;
    if (options[ARCS].value) {
        const bool has_corners = request.family == NARC_FIT_POLYGON || request.family == NARC_FIT_PAPER;
        request.arc_count = (size_t)whole_option(&options[ARCS], has_corners ? 3 : 1, NARC_MAX_FIT_ARCS);
    }
    request.tolerance = number_option(&options[TOLERANCE], DBL_MIN, DBL_MAX, "more than 0", 0);
    request.min_radius = number_option(&options[MIN_RADIUS], DBL_MIN, DBL_MAX, "more than 0", 0);
    request.keep_origin = options[KEEP_ORIGIN].value;
    if (options[STARTS].value)
        request.starts = (unsigned)whole_option(&options[STARTS], 1, 10000);
    return request;
}

/* ---------------------------------------------------------------------------- fits */

typedef struct stage {
    size_t done, total; /* outlines */
} stage;

static bool tell_progress(size_t done, size_t total, void *context) {
    const stage *at = context;
    const double part = total ? (double)done / (double)total : 0;
    show_share("fitting", ((double)at->done + part) / (double)at->total);
    return true;
}

/* The larger side of an outline's bounding box; 0 if it has none, which fitting then tells. */
static double measure_extent(const outline *of) {
    narc_contours contours;
    if (narc_flatten_path(of->path, 0, &contours, NULL) != NARC_OK)
        return 0;
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < contours.point_count; i++) {
        const narc_point p = contours.points[i];
        box = (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
    }
    narc_release_contours(&contours);
    return fmax(box.max_x - box.min_x, box.max_y - box.min_y);
}

/* `flatness` is relative to an outline's extent; 0: the usual one. */
static narc_fit_result *fit_outlines(outline_list *outlines, narc_fit_request request, double flatness,
                                     narc_named_shape *out_shapes) {
    narc_fit_result *fits = allocate(outlines->count, sizeof *fits);
    narc_shapes *store; /* takes what a file must be able to bring there */
    size_t kept = 0;
    if (narc_create_shapes(NULL, &store) != NARC_OK)
        fail("not enough memory for a store of shapes");
    stage at = {0, outlines->count};
    request.progress = tell_progress;
    request.context = &at;
    for (; at.done < at.total; at.done++) {
        const outline *of = &outlines->items[at.done];
        narc_error error;
        request.flatness = flatness > 0 ? flatness * measure_extent(of) : 0;
        narc_fit_result *fit = &fits[kept];
        if (narc_fit_path(of->path, &request, fit, &error) != NARC_OK ||
            narc_add_shape(store, fit->arcs, fit->arc_count, NULL, &error) != NARC_OK) {
            report_outline(of, error.message);
            continue;
        }
        out_shapes[kept] =
            (narc_named_shape){.name = of->name, .arcs = fit->arcs, .arc_count = fit->arc_count, .origin = fit->origin};
        keep_outline(outlines, at.done, kept++);
    }
    cut_outlines(outlines, kept);
    narc_destroy_shapes(store);
    return fits;
}

/* ---------------------------------------------------------------------------- the table */

/* The shape's centroid in the input's coordinates: its origin, unless the input's is kept. */
static narc_point find_centroid(const narc_fit_result *fit) {
    narc_mass mass = {0};
    if (fit->origin.x == 0 && fit->origin.y == 0)
        narc_compute_mass(fit->arcs, fit->arc_count, &mass);
    return (narc_point){fit->origin.x + mass.centroid_x, fit->origin.y + mass.centroid_y};
}

static void print_table(FILE *file, const outline_list *outlines, const narc_fit_result *fits) {
    const int width = print_name(file, outlines, "shape", 0);
    fprintf(file, " %5s %5s %11s %11s %8s %11s %12s %13s %11s %11s %8s\n", "arcs", "edges", "area", "hull area",
            "ratio", "perimeter", "max distance", "mean distance", "origin x", "origin y", "seconds");
    for (size_t i = 0; i < outlines->count; i++) {
        const narc_fit_result *f = &fits[i];
        const narc_point centroid = find_centroid(f);
        print_name(file, outlines, outlines->items[i].name, width);
        fprintf(file, " %5zu %5zu %11.6g %11.6g %8.5f %11.6g %12.4g %13.4g %11.6g %11.6g %8.2f\n", f->arc_count,
                f->edge_count, f->area, f->hull_area, f->area / f->hull_area, f->perimeter, f->max_distance,
                f->mean_distance, centroid.x, centroid.y, f->seconds);
    }
}

/* ---------------------------------------------------------------------------- both kinds of answers */

/* Nothing is left of the inputs: their errors have been told. */
static void check_any(const outline_list *outlines) {
    if (outlines->count == 0)
        fail("no outline is left to fit");
}

static void make_shapes(outline_list *outlines, narc_fit_request request, double flatness, FILE *file,
                        const char *picture, FILE *picture_file) {
    narc_named_shape *shapes = allocate(outlines->count, sizeof *shapes);
    narc_fit_result *fits = fit_outlines(outlines, request, flatness, shapes);
    check_any(outlines);
    char *text;
    size_t size;
    narc_error error;
    if (narc_write_shapes(shapes, outlines->count, NULL, &text, &size, &error) != NARC_OK)
        fail("%s", error.message);
    fwrite(text, 1, size, file);
    free(text);
    flush_output(file);
    if (picture)
        draw_fits(picture, picture_file, outlines, fits, NULL);
    FILE *report = finish_outputs();
    print_table(report, outlines, fits);
    finish_report(report);
    commit_outputs();
    free(shapes);
    free(fits);
}

static void make_splines(outline_list *outlines, double tolerance, FILE *file, const char *picture,
                         FILE *picture_file) {
    narc_arc_chains *chains = fit_splines(outlines, tolerance);
    check_any(outlines);
    write_splines(file, outlines, chains);
    flush_output(file);
    if (picture)
        draw_fits(picture, picture_file, outlines, NULL, chains);
    FILE *report = finish_outputs();
    print_splines(report, outlines, chains);
    finish_report(report);
    commit_outputs();
    for (size_t i = 0; i < outlines->count; i++)
        narc_release_chains(&chains[i]);
    free(chains);
}

static void run(int argc, char **argv) {
    option options[OPTIONS] = {[ARCS] = {"--arcs", true, NULL},
                               [TOLERANCE] = {"--tolerance", true, NULL},
                               [BOUND] = {"--bound", false, NULL},
                               [APPROXIMATE] = {"--approximate", false, NULL},
                               [OBJECTIVE] = {"--objective", true, NULL},
                               [EDGES] = {"--edges", false, NULL},
                               [POLYGON] = {"--polygon", false, NULL},
                               [PAPER] = {"--paper", false, NULL},
                               [CHARACTERS] = {"--characters", true, NULL},
                               [SILHOUETTE] = {"--silhouette", true, NULL},
                               [THRESHOLD] = {"--threshold", true, NULL},
                               [FLATNESS] = {"--flatness", true, NULL},
                               [MIN_RADIUS] = {"--min-radius", true, NULL},
                               [STARTS] = {"--starts", true, NULL},
                               [SPLINE] = {"--spline", false, NULL},
                               [KEEP_ORIGIN] = {"--keep-origin", false, NULL},
                               [KEEP_GOING] = {"--keep-going", false, NULL},
                               [OUT] = {"--out", true, NULL},
                               [PICTURE] = {"--picture", true, NULL}};
    const char **files = allocate((size_t)argc, sizeof *files);
    const size_t file_count = parse_options(argc, argv, options, OPTIONS, "INPUT", files);
    const narc_fit_request request = make_request(options);
    const double flatness = number_option(&options[FLATNESS], 1e-9, 0.1, "from 1e-9 to 0.1", 0);
    const reading how = {.characters = options[CHARACTERS].value,
                         .silhouette = options[SILHOUETTE].value,
                         .threshold = number_option(&options[THRESHOLD], DBL_MIN, 1 - DBL_EPSILON / 2,
                                                    "more than 0 and less than 1", 0)};
    const char *picture = options[PICTURE].value, *out = options[OUT].value ? options[OUT].value : "-";
    picture_kind_of(picture);

    outline_list outlines = {0};
    if (options[KEEP_GOING].value)
        keep_going();
    read_outlines(files, file_count, &how, &outlines);
    check_any(&outlines);
    FILE *shapes_file = open_output(out), *picture_file = picture ? open_output(picture) : NULL;
    if (options[SPLINE].value)
        make_splines(&outlines, request.tolerance, shapes_file, picture, picture_file);
    else
        make_shapes(&outlines, request, flatness, shapes_file, picture, picture_file);
    if (count_reports())
        fprintf(stderr, "narc: errors: %zu; shapes written: %zu\n", count_reports(), outlines.count);
    free_outlines(&outlines);
    free(files);
}

const command fit_command = {"fit", "outlines of glyphs, drawings, images or points to shapes", HELP, run};
