/* SPDX-License-Identifier: MIT
 *
 * fit.c - narc fit: outlines from files of any kind to arc shapes.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "calls.h"
#include "canvas.h"
#include "chains.h"
#include "commands.h"
#include "draw_fit.h"
#include "fail.h"
#include "fit_inputs.h"
#include "json.h"
#include "options.h"
#include "output.h"
#include "picture_fits.h"
#include "progress.h"
#include "report.h"
#include "system.h"
#include "text.h"
#ifdef _OPENMP
#include <omp.h>
#endif

enum {
    ARCS,
    TOLERANCE,
    PARTS,
    BOUND,
    APPROXIMATE,
    OBJECTIVE,
    EDGES,
    POLYGON,
    PAPER,
    NO_EDGES,
    READING,
    FLATNESS = READING + READING_OPTIONS,
    MIN_RADIUS,
    QUICK,
    STARTS,
    JOBS,
    CHAIN,
    OPEN,
    SMOOTH,
    KEEP_ORIGIN,
    KEEP_GOING,
    OUT,
    PICTURE,
    REPORT,
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
    exclude(&options[NO_EDGES], &options[EDGES], families);
    exclude(&options[NO_EDGES], &options[POLYGON], families);
    exclude(&options[QUICK], &options[STARTS], "a quick search chooses its starts");
    exclude(&options[TOLERANCE], &options[OBJECTIVE], "the least number of arcs is looked for");
    for (int family = POLYGON; family <= PAPER; family++)
        exclude(&options[family], &options[APPROXIMATE], "it bounds");
    static const int of_hulls[] = {ARCS,  PARTS,    BOUND, APPROXIMATE, OBJECTIVE, EDGES,       POLYGON,
                                   PAPER, FLATNESS, QUICK, STARTS,      JOBS,      KEEP_ORIGIN, NO_EDGES};
    for (size_t k = 0; k < sizeof of_hulls / sizeof of_hulls[0]; k++)
        exclude(&options[CHAIN], &options[of_hulls[k]], "a chain follows the outline itself, within --tolerance");
    if (options[OPEN].value && !options[CHAIN].value)
        fail("--open is for --chain: shapes are closed");
    if (options[SMOOTH].value && !options[CHAIN].value)
        fail("--smooth is for --chain: shapes are smooth without it");
    if (options[NO_EDGES].value && !options[PARTS].value && !options[TOLERANCE].value)
        fail("--no-edges is for --parts and --tolerance: other shapes have edges with --edges alone");
    if (options[ARCS].value || options[TOLERANCE].value)
        return;
    if (!options[PARTS].value)
        fail(options[CHAIN].value ? "--tolerance, within which chains follow the outline, is missing"
                                  : "--arcs, --tolerance or --parts is missing: see narc fit --help");
    static const int of_fits[] = {BOUND, APPROXIMATE, OBJECTIVE,  EDGES, NO_EDGES, POLYGON,
                                  PAPER, FLATNESS,    MIN_RADIUS, QUICK, STARTS};
    for (size_t k = 0; k < sizeof of_fits / sizeof of_fits[0]; k++)
        if (options[of_fits[k]].value)
            fail("%s is for fits: --parts alone, without --arcs or --tolerance, cuts the outline exactly",
                 options[of_fits[k]].name);
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
    const bool edges = options[PARTS].value && !options[NO_EDGES].value; /* cuts are straight */
    narc_fit_request request = {.goal = choose_goal(options), .family = edges ? NARC_FIT_EDGES : NARC_FIT_N_ARC};
    for (int k = EDGES; k <= PAPER; k++)
        request.family = options[k].value ? families[k] : request.family;
    if (options[ARCS].value) {
        const bool has_corners = request.family == NARC_FIT_POLYGON || request.family == NARC_FIT_PAPER;
        request.arc_count = (size_t)whole_option(&options[ARCS], has_corners ? 3 : 1, NARC_MAX_FIT_ARCS);
    }
    request.tolerance = number_option(&options[TOLERANCE], DBL_MIN, DBL_MAX, "more than 0", 0);
    request.min_radius = number_option(&options[MIN_RADIUS], DBL_MIN, DBL_MAX, "more than 0", 0);
    request.keep_origin = options[KEEP_ORIGIN].value;
    request.quick = options[QUICK].value;
    if (options[STARTS].value)
        request.starts = (unsigned)whole_option(&options[STARTS], 1, 10000);
    return request;
}

/* ---------------------------------------------------------------------------- fits */

typedef struct stage {
    const char *name;   /* of the outline */
    size_t part, parts; /* of it */
} stage;

static int count_cores(void) {
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
}

static size_t fitted, to_fit; /* outlines */

static bool tell_progress(size_t done, size_t total, void *context) {
    const stage *at = context;
    const double part = ((double)at->part + (total ? (double)done / (double)total : 0)) / (double)at->parts;
#pragma omp critical(progress)
    {
        char what[160];
        snprintf(what, sizeof what, "fitting %.140s", at->name);
        show_share(what, fmin(1, ((double)fitted + part) / (double)to_fit));
    }
    return !was_interrupted();
}

/* The larger side of an outline's bounding box; 0 if it has none, which fitting then tells. */
static double measure_extent(const outline *of) {
    narc_contours contours;
    if (narc_flatten_path(of->path, 0, &contours, NULL) != NARC_OK)
        return 0;
    narc_aabb box = EMPTY_BOX;
    for (size_t i = 0; i < contours.point_count; i++) {
        const narc_point p = contours.points[i];
        box = join_boxes(box, (narc_aabb){p.x, p.y, p.x, p.y});
    }
    narc_release_contours(&contours);
    return box_size(box);
}

typedef struct fitting {
    narc_fit_request request;
    size_t parts;       /* at most; 0: the hull */
    bool no_edges;      /* no plain shapes either */
    double flatness;    /* relative to an outline's extent; 0: the usual one */
    narc_shapes *store; /* takes what a file must be able to bring there */
    stage at;
} fitting;

/* An outline with less, in parts of its extent's square, has no area but that of roundings. */
static const double LEAST_AREA = 1e-12;

/* Of a tolerance, what parts get; the rest is for the shapes that are fitted to them. Of parts that are approximated laps
 * take twice the rest. */
static const double SHARE_OF_PARTS = 0.75, SHARE_OF_LAPPED_PARTS = 0.875;

static bool fit_each(fitting *how, narc_path *const *paths, narc_fit_request request, collider *out,
                     narc_error *error) {
    request.progress = tell_progress;
    request.context = &how->at;
    how->at.parts = out->count;
    out->fits = allocate(out->count, sizeof *out->fits);
    for (how->at.part = 0; how->at.part < out->count; how->at.part++) {
        narc_fit_result *fit = &out->fits[how->at.part];
        const narc_fit_family family = request.family;
        const bool may_be_plain =
            request.arc_count == 0 && !how->no_edges && (family == NARC_FIT_N_ARC || family == NARC_FIT_EDGES);
        request.family = may_be_plain ? NARC_FIT_PLAIN : family;
        narc_status status = narc_fit_path(paths[how->at.part], &request, fit, error);
        request.family = family;
        if (status == NARC_ERROR_NO_SOLUTION && may_be_plain)
            status = narc_fit_path(paths[how->at.part], &request, fit, error);
        if (status != NARC_OK || narc_add_shape(how->store, fit->arcs, fit->arc_count, NULL, error) != NARC_OK)
            return false;
        out->distance = fmax(out->distance, fit->max_distance);
    }
    return true;
}

static bool measure_union(collider *of, narc_error *error) {
    narc_arc *arcs = allocate(of->count, sizeof of->fits->arcs);
    size_t *counts = allocate(of->count, sizeof *counts), next = 0;
    narc_mass mass;
    for (size_t k = 0; k < of->count; k++) {
        const narc_fit_result *fit = &of->fits[k];
        counts[k] = fit->arc_count;
        for (size_t i = 0; i < fit->arc_count; i++, next++) {
            arcs[next] = fit->arcs[i];
            arcs[next].center_x += fit->origin.x;
            arcs[next].center_y += fit->origin.y;
        }
    }
    const bool done = narc_compute_union_mass(arcs, counts, of->count, NULL, &mass, error) == NARC_OK;
    of->area = done ? mass.area : 0;
    free(arcs);
    free(counts);
    return done;
}

/* How many parts would do, and with which tolerance, more than `least`, these would: each is tried. */
static void find_remedy(const fitting *how, const narc_path *path, const narc_parts_request *cut, double least,
                        char *reason, size_t size) {
    const double whole = how->request.tolerance;
    narc_parts_request more = *cut, wider = *cut;
    narc_parts parts;
    const char *before = ", ", *behind = " may do";
    size_t used = (size_t)snprintf(reason, size,
                                   least > 0 ? "the tolerance %g is too small for %zu parts and their shapes"
                                             : "the tolerance %g is not reached with %zu parts",
                                   whole, cut->most);
    more.most = NARC_MAX_PARTS;
    if (!(least > 0) && narc_cut_path(path, &more, &parts, NULL) == NARC_OK) {
        used += (size_t)snprintf(reason + used, size - used, ", --parts %zu may do", parts.count);
        narc_release_parts(&parts);
        before = ", or ", behind = "";
    }
    wider.tolerance = 0;
    if (narc_cut_path(path, &wider, &parts, NULL) != NARC_OK)
        return;
    double enough = fmax(least, parts.distance * whole / cut->tolerance);
    narc_release_parts(&parts);
    for (int tries = 0; tries < 8; tries++) { /* what is simplified takes a part */
        char text[32];
        enough *= 1.03;
        snprintf(text, sizeof text, "%.3g", enough);
        wider.tolerance = strtod(text, NULL) * cut->tolerance / whole;
        wider.lap = cut->lap * wider.tolerance / cut->tolerance;
        if (narc_cut_path(path, &wider, &parts, NULL) != NARC_OK)
            continue;
        narc_release_parts(&parts);
        snprintf(reason + used, size - used, "%s--tolerance %s%s", before, text, behind);
        return;
    }
}

static bool is_smooth(const narc_fit_request *request) {
    return request->family == NARC_FIT_N_ARC && !(request->min_radius > 0);
}

/* What went wrong with cuts, or with the shape of the part that how->at tells, which has `share` of the tolerance. */
static void explain(const fitting *how, const narc_path *path, const narc_parts_request *cut, double share,
                    narc_error *error) {
    const double whole = how->request.tolerance, lap = NARC_LAP_REACH * cut->lap;
    char reason[sizeof error->message];
    if (!(whole > 0) || error->status != NARC_ERROR_NO_SOLUTION)
        return;
    if (share > 0 && error->value > share)
        snprintf(reason, sizeof reason,
                 "part %zu has %.3g of the tolerance %g, and its shape comes within %.3g: %s--tolerance %.3g may do",
                 how->at.part + 1, share, whole, error->value,
                 is_smooth(&how->request) ? "leave --no-edges out, or " : "", 1.1 * whole * error->value / share);
    else if (share > 0)
        snprintf(reason, sizeof reason, "part %zu: %.150s", how->at.part + 1, error->message);
    else /* laps are in proportion to the tolerance */
        find_remedy(how, path, cut,
                    error->value > cut->tolerance ? whole * (error->value - lap) / (cut->tolerance - lap) : 0, reason,
                    sizeof reason);
    memcpy(error->message, reason, sizeof reason);
}

/* To the error of a shape that does not come near enough: what would do, which is tried. */
static void suggest_tolerance(fitting *how, const narc_path *path, narc_fit_request request, narc_error *error) {
    narc_fit_result fit;
    narc_error last = *error;
    request.progress = tell_progress;
    request.context = &how->at;
    for (int tries = 0; tries < 4 && last.status == NARC_ERROR_NO_SOLUTION && last.value > request.tolerance; tries++) {
        char text[32];
        snprintf(text, sizeof text, "%.3g", 1.01 * last.value);
        request.tolerance = strtod(text, NULL);
        if (narc_fit_path(path, &request, &fit, &last) != NARC_OK)
            continue;
        const char *reason = strstr(error->message, ": radii end at"); /* then edges do */
        const size_t used = reason ? (size_t)(reason - error->message) : strlen(error->message);
        snprintf(error->message + used, sizeof error->message - used, "%s--tolerance %s does",
                 reason ? ": --edges may do, " : "; ", text);
        return;
    }
}

/* With a tolerance both kinds of distances share it. Parts that are approximated go on beyond their cuts by twice the
 * distance of their shapes: with a number of arcs that is known only when they have been fitted once. */
static bool fit_parts(fitting *how, const outline *of, narc_fit_request request, collider *out, narc_error *error) {
    const double extent = measure_extent(of);
    if (extent > 0 && extent < NARC_MIN_SIZE) {
        snprintf(error->message, sizeof error->message, "its size is %g, at least %g is possible", extent,
                 NARC_MIN_SIZE);
        return false;
    }
    const bool approximates = request.goal > NARC_FIT_BOUND_DISTANCE;
    const double whole = request.tolerance, share = approximates ? SHARE_OF_LAPPED_PARTS : SHARE_OF_PARTS;
    narc_parts_request cut = {.most = how->parts, .tolerance = share * whole, .flatness = request.flatness};
    if (approximates)
        cut.lap = 2 * (whole - cut.tolerance);
    for (int tries = approximates && request.arc_count ? 2 : 1; tries > 0; tries--) {
        narc_parts parts;
        if (narc_cut_path(of->path, &cut, &parts, error) != NARC_OK) {
            explain(how, of->path, &cut, 0, error);
            return false;
        }
        free(out->fits);
        *out = (collider){.count = parts.count, .outline_area = parts.area};
        if (!(parts.area > LEAST_AREA * extent * extent)) {
            narc_release_parts(&parts);
            snprintf(error->message, sizeof error->message, "its lines enclose no area");
            return false;
        }
        if (request.arc_count == 0) /* more than half a lap would open seams */
            request.tolerance = approximates ? cut.lap / 2 : whole - parts.distance;
        const bool done = fit_each(how, parts.paths, request, out, error);
        if (!done)
            explain(how, of->path, &cut, request.tolerance, error);
        cut.lap = 2 * out->distance;
        out->distance += parts.distance;
        narc_release_parts(&parts);
        if (!done)
            return false;
    }
    return measure_union(out, error);
}

/* Parts that are just the outline. */
static bool cut_exactly(fitting *how, const outline *of, collider *out, narc_error *error) {
    out->fits = allocate(how->parts, sizeof *out->fits);
    if (narc_cut_exactly(of->path, out->fits, how->parts, &out->count, error) != NARC_OK)
        return false;
    for (size_t k = 0; k < out->count; k++) {
        narc_fit_result *part = &out->fits[k];
        out->outline_area += part->area;
        for (size_t i = 0; i < part->arc_count && how->request.keep_origin; i++) {
            part->arcs[i].center_x += part->origin.x;
            part->arcs[i].center_y += part->origin.y;
        }
        if (how->request.keep_origin)
            part->origin = (narc_point){0, 0};
    }
    return measure_union(out, error);
}

static bool fit_outline(fitting *how, const outline *of, collider *out, narc_error *error) {
    if (narc_create_shapes(NULL, &how->store) != NARC_OK)
        fail("not enough memory for a store of shapes");
    narc_fit_request request = how->request;
    const double begin = seconds_now();
    request.flatness = how->flatness > 0 ? how->flatness * measure_extent(of) : 0;
    *out = (collider){.count = 1};
    const bool exact = request.arc_count == 0 && !(request.tolerance > 0);
    const bool done = exact        ? cut_exactly(how, of, out, error)
                      : how->parts ? fit_parts(how, of, request, out, error)
                                   : fit_each(how, &(narc_path *){of->path}, request, out, error);
    if (!done && !exact && !how->parts && request.arc_count == 0)
        suggest_tolerance(how, of->path, request, error);
    out->seconds = seconds_now() - begin;
    narc_destroy_shapes(how->store);
    if (!done)
        free(out->fits);
    return done;
}

/* Each outline by itself: what comes out is the same whatever is fitted at the same time. Without keep_going() the first
 * that fails ends the command, and those behind it are not begun. */
static collider *fit_outlines(outline_list *outlines, const fitting *how, int jobs) {
    typedef struct outcome {
        collider fits;
        enum { NOT_BEGUN, FAILED, FITTED } state;
        narc_error error;
    } outcome;
    const size_t count = outlines->count;
    (void)jobs; /* without OpenMP */
    outcome *outcomes = allocate(count, sizeof *outcomes);
    size_t first_failed = count;
    for (size_t k = 0; k < count; k++)
        outcomes[k].state = NOT_BEGUN;
    fitted = 0;
    to_fit = count;
    hear_interrupts(true);
#pragma omp parallel for schedule(dynamic) num_threads(jobs)
    for (size_t k = 0; k < count; k++) {
        size_t failed;
#pragma omp atomic read
        failed = first_failed;
        if (was_interrupted() || (k > failed && !goes_on()))
            continue;
        fitting own = *how;
        outcome *at = &outcomes[k];
        own.at.name = outlines->items[k].name;
        const bool done = fit_outline(&own, &outlines->items[k], &at->fits, &at->error);
        if (was_interrupted()) { /* what it has so far is less than it would be */
            if (done)
                free(at->fits.fits);
            continue;
        }
        at->state = done ? FITTED : FAILED;
#pragma omp critical(progress)
        {
            fitted++;
            first_failed = !done && k < first_failed ? k : first_failed;
        }
    }
    hear_interrupts(false);
    collider *fits = allocate(count, sizeof *fits);
    size_t kept = 0, left = 0;
    for (size_t k = 0; k < count; k++) {
        if (outcomes[k].state == FAILED)
            report_outline(&outlines->items[k], outcomes[k].error.message);
        left += outcomes[k].state == NOT_BEGUN;
        if (outcomes[k].state != FITTED)
            continue;
        fits[kept] = outcomes[k].fits;
        keep_outline(outlines, k, kept++);
    }
    free(outcomes);
    if (left) {
        keep_going();
        report_at("Ctrl-C", 0, "%zu of %zu outlines are not fitted", left, count);
    }
    cut_outlines(outlines, kept);
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

static void print_table(FILE *file, const outline_list *outlines, const collider *fits) {
    const int width = print_name(file, outlines, "shape", 0);
    fprintf(file, " %5s %5s %11s %11s %8s %11s %12s %13s %11s %11s %8s\n", "arcs", "edges", "area", "hull area",
            "ratio", "perimeter", "max distance", "mean distance", "origin x", "origin y", "seconds");
    for (size_t i = 0; i < outlines->count; i++) {
        const narc_fit_result *f = fits[i].fits;
        const narc_point centroid = find_centroid(f);
        print_name(file, outlines, outlines->items[i].name, width);
        fprintf(file, " %5zu %5zu %11.6g %11.6g %8.5f %11.6g %12.4g %13.4g %11.6g %11.6g %8.2f\n", f->arc_count,
                f->edge_count, f->area, f->hull_area, f->area / f->hull_area, f->perimeter, f->max_distance,
                f->mean_distance, centroid.x, centroid.y, f->seconds);
    }
}

static void print_parts(FILE *file, const outline_list *outlines, const collider *fits) {
    const int width = print_name(file, outlines, "shape", 0);
    fprintf(file, " %5s %5s %5s %11s %12s %8s %12s %8s\n", "parts", "arcs", "edges", "area", "outline area", "ratio",
            "max distance", "seconds");
    for (size_t i = 0; i < outlines->count; i++) {
        const collider *f = &fits[i];
        size_t arcs = 0, edges = 0;
        for (size_t k = 0; k < f->count; k++) {
            arcs += f->fits[k].arc_count;
            edges += f->fits[k].edge_count;
        }
        print_name(file, outlines, outlines->items[i].name, width);
        fprintf(file, " %5zu %5zu %5zu %11.6g %12.6g %8.5f %12.4g %8.2f\n", f->count, arcs, edges, f->area,
                f->outline_area, f->area / f->outline_area, f->distance, f->seconds);
    }
}

/* ---------------------------------------------------------------------------- both kinds of answers */

/* All shapes, those of one outline one after the other: with its name if it has one, else NAME/1, NAME/2 ... */
static narc_named_shape *name_shapes(const outline_list *outlines, const collider *fits, size_t *out_count) {
    size_t count = 0, used = 0;
    for (size_t i = 0; i < outlines->count; i++)
        count += fits[i].count;
    narc_named_shape *shapes = allocate(count, sizeof *shapes);
    for (size_t i = 0; i < outlines->count; i++) {
        for (size_t k = 0; k < fits[i].count; k++) {
            const narc_fit_result *fit = &fits[i].fits[k];
            shapes[used++] = (narc_named_shape){.name = name_part(&outlines->items[i], k, fits[i].count),
                                                .arcs = fit->arcs,
                                                .arc_count = fit->arc_count,
                                                .origin = fit->origin};
        }
    }
    *out_count = count;
    return shapes;
}

/* What the command was asked to write. */
typedef struct wanted {
    const char *out, *picture;
    FILE *file, *picture_file; /* NULL: a file for each outline; no picture */
    bool json;
} wanted;

/* Nothing is left of the inputs: their errors have been told. */
static void check_any(const outline_list *outlines, const wanted *to) {
    if (outlines->count)
        return;
    FILE *report = strcmp(to->out, "-") == 0 ? stderr : stdout;
    if (to->json)
        put_fits(report, outlines, NULL, NULL, NULL, to->out);
    finish_report(report);
    if (to->json && report == stderr)
        abandon();
    fail("no outline is left to fit");
}

/* Says early what is wrong with outputs. */
static void open_files(wanted *of, const outline_list *outlines) {
    for (size_t i = 0; i < outlines->count && !of->file; i++) {
        char *path = expand_pattern(of->out, outlines->items[i].name);
        if (path)
            reserve_output(path);
        else
            of->file = open_output(of->out);
        free(path);
    }
    if (of->picture)
        of->picture_file = open_output(of->picture);
}

/* `kinds` get what the file calls each shape. */
static void write_file(FILE *file, const narc_named_shape *shapes, size_t count, char **kinds) {
    char *text;
    size_t size;
    narc_error error;
    cJSON *root = NULL;
    if (narc_write_shapes(shapes, count, NULL, &text, &size, &error) != NARC_OK)
        fail("%s", error.message);
    fwrite(text, 1, size, file);
    flush_output(file);
    if (kinds && narc_parse_json(text, &root, &error) != NARC_OK)
        fail("%s", error.message);
    const cJSON *shape = root ? root->child->child : NULL;
    for (size_t k = 0; shape; shape = shape->next, k++) { /* behind name and origin */
        const char *kind = shape->child->next->next->string;
        kinds[k] = join_text(kind, strlen(kind), "");
    }
    cJSON_Delete(root);
    free(text);
}

/* One of `fits` and `chains` is NULL. */
static void write_all(const outline_list *outlines, const collider *fits, const narc_arc_chains *chains,
                      narc_named_shape *shapes, size_t count, const wanted *to) {
    char **kinds = to->json ? allocate(count, sizeof *kinds) : NULL;
    if (to->file)
        write_file(to->file, shapes, count, kinds);
    for (size_t i = 0, begin = 0, own; i < outlines->count && !to->file; i++, begin += own) {
        char *path = expand_pattern(to->out, outlines->items[i].name);
        FILE *file = open_output(path);
        own = fits ? fits[i].count : chains[i].count;
        write_file(file, shapes + begin, own, kinds ? kinds + begin : NULL);
        close_output(file);
        free(path);
    }
    if (to->picture)
        draw_fits(to->picture, to->picture_file, outlines, fits, chains);
    FILE *report = finish_outputs();
    if (to->json)
        put_fits(report, outlines, fits, chains, kinds, to->out);
    else if (chains)
        print_chains(report, outlines, chains);
    else if (fits->outline_area > 0)
        print_parts(report, outlines, fits);
    else
        print_table(report, outlines, fits);
    if (!to->json)
        print_ways(report, outlines);
    finish_report(report);
    commit_outputs();
    for (size_t k = 0; k < count; k++) {
        free((char *)shapes[k].name);
        if (chains)
            free((narc_arc *)shapes[k].arcs);
        if (kinds)
            free(kinds[k]);
    }
    free(kinds);
    free(shapes);
}

static void make_shapes(outline_list *outlines, const fitting *how, int jobs, const wanted *to) {
    collider *fits = fit_outlines(outlines, how, jobs);
    check_any(outlines, to);
    size_t count;
    narc_named_shape *shapes = name_shapes(outlines, fits, &count);
    write_all(outlines, fits, NULL, shapes, count, to);
    for (size_t i = 0; i < outlines->count; i++)
        free(fits[i].fits);
    free(fits);
}

static void make_chains(outline_list *outlines, double tolerance, bool open, bool smooth, const wanted *to) {
    narc_arc_chains *chains = fit_chains(outlines, tolerance, open, smooth);
    check_any(outlines, to);
    size_t count;
    narc_named_shape *shapes = describe_chains(outlines, chains, open, &count);
    write_all(outlines, NULL, chains, shapes, count, to);
    for (size_t i = 0; i < outlines->count; i++)
        narc_release_chains(&chains[i]);
    free(chains);
}

static void run(int argc, char **argv) {
    option options[OPTIONS] = {[ARCS] = {"--arcs", true, NULL},
                               [TOLERANCE] = {"--tolerance", true, NULL},
                               [PARTS] = {"--parts", true, NULL},
                               [BOUND] = {"--bound", false, NULL},
                               [APPROXIMATE] = {"--approximate", false, NULL},
                               [OBJECTIVE] = {"--objective", true, NULL},
                               [EDGES] = {"--edges", false, NULL},
                               [POLYGON] = {"--polygon", false, NULL},
                               [PAPER] = {"--paper", false, NULL},
                               [NO_EDGES] = {"--no-edges", false, NULL},
                               [FLATNESS] = {"--flatness", true, NULL},
                               [MIN_RADIUS] = {"--min-radius", true, NULL},
                               [QUICK] = {"--quick", false, NULL},
                               [STARTS] = {"--starts", true, NULL},
                               [JOBS] = {"--jobs", true, NULL},
                               [CHAIN] = {"--chain", false, NULL},
                               [OPEN] = {"--open", false, NULL},
                               [SMOOTH] = {"--smooth", false, NULL},
                               [KEEP_ORIGIN] = {"--keep-origin", false, NULL},
                               [KEEP_GOING] = {"--keep-going", false, NULL},
                               [OUT] = {"--out", true, NULL},
                               [PICTURE] = {"--picture", OUTPUT_FILE, NULL},
                               [REPORT] = {"--report", true, NULL}};
    name_reading_options(&options[READING]);
    const char **files = allocate((size_t)argc, sizeof *files);
    const size_t file_count = parse_options(argc, argv, options, OPTIONS, "INPUT", files);
    const narc_fit_request request = make_request(options);
    const int jobs = options[JOBS].value ? (int)whole_option(&options[JOBS], 1, 1024) : count_cores();
    const size_t parts = options[PARTS].value ? (size_t)whole_option(&options[PARTS], 1, NARC_MAX_PARTS) : 0;
    const double flatness = number_option(&options[FLATNESS], 1e-9, 0.1, "from 1e-9 to 0.1", 0);
    reading how = take_reading(&options[READING]);
    how.open = options[OPEN].value;
    wanted to = {.out = options[OUT].value ? options[OUT].value : "-",
                 .picture = options[PICTURE].value,
                 .json = wants_json(&options[REPORT])};
    picture_kind_of(to.picture);

    outline_list outlines = {0};
    if (options[KEEP_GOING].value)
        keep_going();
    const bool is_told = to.json && strcmp(to.out, "-") == 0; /* by the report on standard error */
    if (is_told)
        hold_lines();
    read_outlines(files, file_count, &how, &outlines);
    check_any(&outlines, &to);
    open_files(&to, &outlines);
    if (options[CHAIN].value)
        make_chains(&outlines, request.tolerance, options[OPEN].value, options[SMOOTH].value, &to);
    else
        make_shapes(
            &outlines,
            &(fitting){.request = request, .parts = parts, .no_edges = options[NO_EDGES].value, .flatness = flatness},
            jobs, &to);
    if (count_reports() && !is_told)
        fprintf(stderr, "narc: errors: %zu; shapes written: %zu\n", count_reports(), outlines.count);
    free_outlines(&outlines);
    free(files);
}

const command fit_command = {"fit", "outlines of glyphs, drawings, images or points to shapes", run};
