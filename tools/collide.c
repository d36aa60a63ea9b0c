/* SPDX-License-Identifier: MIT
 *
 * collide.c - narc collide: bodies of a file against each other, by a method of choice.
 */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "broad_phase.h"
#include "calls.h"
#include "canvas.h"
#include "commands.h"
#include "fail.h"
#include "narrow_phase.h"
#include "options.h"
#include "output.h"
#include "picture_bodies.h"
#include "progress.h"
#include "text.h"

enum { DEFAULT_MOST_PAIRS = 100000000 };

/* Far below what single precision can reach, and far above what it rounds to 0, which would mean the default. */
static const double LEAST_TOLERANCE = 1e-9;

typedef struct settings {
    const char *shapes, *bodies, *pairs, *out, *picture, *isa;
    double search_margin; /* bounding boxes closer than this are candidates */
    uint64_t most_pairs;  /* of those */
    narrow_settings narrow;
} settings;

typedef struct job {
    narc_shape_list *shapes;
    narc_shapes *store;
    body_list bodies;
    narc_aabb *boxes;
    pair_list pairs;
    narrow_result narrow;
    bool *marked; /* bodies that collide */
    double broad_seconds;
    size_t unboxed;
} job;

enum {
    SHAPES,
    BODIES,
    PAIRS,
    MAX_PAIRS,
    OUT,
    ALL,
    MARGIN,
    PICTURE,
    METHOD,
    TOLERANCE,
    ITERATIONS,
    ISA,
    THREADS,
    OPTIONS
};

static const char PART_COLUMNS[] = ",part_a,part_b";

static void refuse_option(const option *given, const char *method, const char *reason) {
    if (given->value)
        fail("%s is not for method '%s', %s", given->name, method, reason);
}

/* Method, tolerance and iterations; options of other methods are errors. */
static void read_method(const option *options, narrow_settings *out_chosen) {
    const narc_method method = options[METHOD].value ? find_method(options[METHOD].value) : NARC_METHOD_SAT;
    const char *name = narc_method_name(method);
    *out_chosen = (narrow_settings){.method = method, .iterations = NARC_MAX_ITERATIONS};
    if (method != NARC_METHOD_GJK) {
        refuse_option(&options[TOLERANCE], name, "only for 'gjk'");
        refuse_option(&options[ITERATIONS], name, "only for 'gjk'");
    }
    if (is_filter(method)) {
        refuse_option(&options[MARGIN], name, "which finds no contacts");
        refuse_option(&options[ALL], name, "which finds no contacts");
    }
    out_chosen->tolerance =
        (float)number_option(&options[TOLERANCE], LEAST_TOLERANCE, 1, "from 1e-9 to 1", (double)NARC_DEFAULT_TOLERANCE);
    if (options[ITERATIONS].value)
        out_chosen->iterations = (unsigned)whole_option(&options[ITERATIONS], 1, NARC_MAX_ITERATIONS);
}

static settings read_settings(int argc, char **argv) {
    option options[OPTIONS] = {
        [SHAPES] = {"--shapes", INPUT_FILE, NULL},   [BODIES] = {"--bodies", INPUT_FILE, NULL},
        [PAIRS] = {"--pairs", INPUT_FILE, NULL},     [MAX_PAIRS] = {"--max-pairs", true, NULL},
        [OUT] = {"--out", OUTPUT_FILE, NULL},        [ALL] = {"--all", false, NULL},
        [MARGIN] = {"--margin", true, NULL},         [PICTURE] = {"--picture", OUTPUT_FILE, NULL},
        [METHOD] = {"--method", true, NULL},         [TOLERANCE] = {"--tolerance", true, NULL},
        [ITERATIONS] = {"--iterations", true, NULL}, [ISA] = {"--isa", true, NULL},
        [THREADS] = {"--threads", true, NULL}};
    parse_options(argc, argv, options, OPTIONS, NULL, NULL);
    settings chosen = {.shapes = required_option(&options[SHAPES]),
                       .bodies = required_option(&options[BODIES]),
                       .pairs = options[PAIRS].value,
                       .most_pairs = DEFAULT_MOST_PAIRS,
                       .out = options[OUT].value,
                       .picture = options[PICTURE].value,
                       .isa = options[ISA].value};
    picture_kind_of(chosen.picture);
    read_method(options, &chosen.narrow);
    const double margin = number_option(&options[MARGIN], -(double)FLT_MAX, (double)FLT_MAX, "of float's range", 0);
    chosen.narrow.margin = (float)margin;
    chosen.search_margin = fmax(margin, 0);
    if (options[MAX_PAIRS].value) {
        if (chosen.pairs)
            fail("--pairs and --max-pairs exclude each other: one gives the pairs, the other lets them be found");
        chosen.most_pairs = whole_option(&options[MAX_PAIRS], 1, UINT32_MAX);
    }
    if (options[ALL].value)
        chosen.narrow.margin = INFINITY;
    chosen.narrow.workers = choose_workers(&options[THREADS]);
    return chosen;
}

static void find_pairs(job *work, const settings *chosen) {
    const double margin = chosen->search_margin;
    const size_t count = work->bodies.count;
    narc_aabb *widened = NULL;
    if (margin > 0) {
        const double half = 0.5 * margin;
        widened = allocate(count, sizeof *widened);
        for (size_t i = 0; i < count; i++) {
            const narc_aabb box = work->boxes[i];
            widened[i] = (narc_aabb){nextafter(box.min_x - half, -INFINITY), nextafter(box.min_y - half, -INFINITY),
                                     nextafter(box.max_x + half, INFINITY), nextafter(box.max_y + half, INFINITY)};
        }
    }
    find_candidates(chosen->bodies, widened ? widened : work->boxes, count, chosen->most_pairs, &chosen->narrow.workers,
                    &work->pairs);
    if (has_parts(&work->bodies))
        drop_own_pairs(&work->bodies, &work->pairs);
    free(widened);
}

/* The library would name pair and shape; the user knows the line of a body. A row of the file is a line, the first is
 * the header. */
static void check_polygons(const job *work, const char *path) {
    for (size_t k = 0; k < work->pairs.count; k++) {
        const uint32_t both[2] = {work->pairs.items[k].a, work->pairs.items[k].b};
        for (int side = 0; side < 2; side++) {
            const body *used = &work->bodies.items[both[side]];
            if (!(narc_shape_flags(work->store, used->shape) & NARC_SHAPE_POLYGON)) {
                fail_at(path, (size_t)used->row + 2,
                        "method 'polygon-sat' needs polygons without rounding, but this body's shape has arcs '%s'",
                        work->shapes->items[used->item].name);
            }
        }
    }
}

static void mark_bodies(job *work) {
    work->marked = allocate(work->bodies.count, sizeof *work->marked);
    memset(work->marked, 0, work->bodies.count * sizeof *work->marked);
    for (size_t k = 0; k < work->pairs.count; k++) {
        if (pair_collides(&work->narrow, k)) {
            const pair hit = work->pairs.items[k];
            work->marked[hit.a] = work->marked[hit.b] = true;
        }
    }
}

/* Ends a row of bodies a and b: where a body has several parts, with the numbers of both. */
static void end_row(FILE *file, const job *work, const body *a, const body *b) {
    if (has_parts(&work->bodies))
        fprintf(file, ",%" PRIu32 ",%" PRIu32, a->part, b->part);
    fprintf(file, "\n");
}

/* What a filter lets pass, in the form of a pairs file. */
static void write_passing(FILE *file, const job *work) {
    fprintf(file, "a,b%s\n", has_parts(&work->bodies) ? PART_COLUMNS : "");
    for (size_t k = 0; k < work->pairs.count && !ferror(file); k++) {
        const pair of = work->pairs.items[k];
        const body *a = &work->bodies.items[of.a], *b = &work->bodies.items[of.b];
        if (pair_collides(&work->narrow, k)) {
            fprintf(file, "%" PRIu32 ",%" PRIu32, a->row, b->row);
            end_row(file, work, a, b);
        }
        show_progress("writing pairs", k, work->pairs.count);
    }
}

/* The library's points are relative to body a, those of the file are in the world. Adding 0 makes a negative zero a
 * plain one. */
static void write_contacts(FILE *file, const job *work) {
    fprintf(file, "a,b,separation,normal_x,normal_y,point_x,point_y,arc_a,arc_b%s\n",
            has_parts(&work->bodies) ? PART_COLUMNS : "");
    for (size_t k = 0; k < work->narrow.contact_count && !ferror(file); k++) {
        const narc_contact *found = &work->narrow.contacts[k];
        const pair of = work->pairs.items[found->pair];
        const body *a = &work->bodies.items[of.a], *b = &work->bodies.items[of.b];
        fprintf(file, "%" PRIu32 ",%" PRIu32 ",%.9g,%.9g,%.9g,%.9g,%.9g,%d,%d", a->row, b->row,
                0 + (double)found->separation, 0 + (double)found->normal_x, 0 + (double)found->normal_y,
                0 + (a->x + (double)found->point_x), 0 + (a->y + (double)found->point_y),
                found->feature & (NARC_MAX_ARCS - 1), found->feature >> 8 & (NARC_MAX_ARCS - 1));
        end_row(file, work, a, b);
        show_progress("writing contacts", k, work->narrow.contact_count);
    }
}

static void print_method(FILE *file, const narrow_settings *chosen) {
    fprintf(file, "method              %s", narc_method_name(chosen->method));
    if (chosen->method == NARC_METHOD_GJK)
        fprintf(file, ", tolerance %g, at most %u iterations", (double)chosen->tolerance, chosen->iterations);
    fprintf(file, "\n");
}

/* What the method found, and how far that can be trusted. */
static void print_answers(FILE *file, const narrow_result *found, narc_method method) {
    static const char *const outcomes[OUTCOME_COUNT] = {
        [NARC_OUTCOME_LIMIT] = "limit", [NARC_OUTCOME_ROUNDING] = "rounding", [NARC_OUTCOME_NONE] = "none"};
    static const char *const reasons[OUTCOME_COUNT] = {[NARC_OUTCOME_LIMIT] = "iterations ran out",
                                                       [NARC_OUTCOME_ROUNDING] = "stopped short of the tolerance",
                                                       [NARC_OUTCOME_NONE] = "no two arcs pass the test"};
    if (is_filter(method)) {
        fprintf(file, "passing pairs       %zu\n", found->colliding_count);
    } else {
        fprintf(file, "colliding pairs     %zu\n", found->colliding_count);
        fprintf(file, "reported contacts   %zu\n", found->contact_count);
    }
    fprintf(file, "skipped pairs       %zu\n", found->skipped);
    for (int k = NARC_OUTCOME_LIMIT; k < OUTCOME_COUNT; k++)
        if (found->outcomes[k])
            fprintf(file, "outcome %-11s %zu pairs: %s\n", outcomes[k], found->outcomes[k], reasons[k]);
    if (method != NARC_METHOD_SAT) {
        fprintf(file, "differs from sat    %zu pairs: %zu missed, %zu extra\n", found->missed + found->extra,
                found->missed, found->extra);
    }
}

static void print_report(FILE *file, const job *work, const settings *chosen) {
    const narrow_result *found = &work->narrow;
    fprintf(file, "shapes              %zu\n", work->shapes->count);
    if (has_parts(&work->bodies))
        fprintf(file, "bodies              %zu, of %zu parts\n", work->bodies.row_count, work->bodies.count);
    else
        fprintf(file, "bodies              %zu\n", work->bodies.count);
    print_unboxed(file, work->unboxed);
    fprintf(file, "candidate pairs     %zu%s\n", work->pairs.count, chosen->pairs ? " (from the file)" : "");
    print_method(file, &chosen->narrow);
    print_answers(file, found, chosen->narrow.method);
    fprintf(file, "instruction set     %s\n", narc_get_isa());
    if (chosen->narrow.workers.run)
        fprintf(file, "threads             at most %u\n", chosen->narrow.workers.count);
    else
        fprintf(file, "threads             1 (built without OpenMP)\n");
    if (!chosen->pairs)
        fprintf(file, "broad phase         %.3f ms\n", 1e3 * work->broad_seconds);
    fprintf(file, "narrow phase        %.3f ms (%s, ", 1e3 * found->seconds, found->call);
    if (found->runs == 1)
        fprintf(file, "one run)\n");
    else
        fprintf(file, "median of %d runs)\n", found->runs);
    const double speed = found->seconds > 0 ? 1e-6 * (double)work->pairs.count / found->seconds : 0;
    fprintf(file, "speed               %.2f million pairs per second\n", speed);
}

static void run(int argc, char **argv) {
    const settings chosen = read_settings(argc, argv);
    job work = {0};
    choose_isa(chosen.isa);
    work.shapes = read_shapes(chosen.shapes, &work.store);
    read_bodies(chosen.bodies, chosen.shapes, work.shapes, work.store, &work.bodies);
    check_picture_size(chosen.picture, work.bodies.count);
    work.boxes = bound_bodies(work.store, &work.bodies);
    work.unboxed = count_unboxed(work.store, &work.bodies);
    if (chosen.pairs)
        read_pairs(chosen.pairs, &work.bodies, &work.pairs);
    /* Outputs that cannot be written are found before the work is done. */
    FILE *out = chosen.out ? open_output(chosen.out) : NULL;
    FILE *picture = chosen.picture ? open_output(chosen.picture) : NULL;
    if (!chosen.pairs) {
        const double start = seconds_now();
        find_pairs(&work, &chosen);
        work.broad_seconds = seconds_now() - start;
    }
    if (chosen.narrow.method == NARC_METHOD_POLYGON_SAT)
        check_polygons(&work, chosen.bodies);
    run_narrow_phase(&chosen.narrow, work.store, &work.bodies, &work.pairs, &work.narrow);
    mark_bodies(&work);
    if (out && is_filter(chosen.narrow.method))
        write_passing(out, &work);
    else if (out)
        write_contacts(out, &work);
    if (out)
        flush_output(out);
    if (picture) {
        const body_scene scene = {.shapes = work.shapes,
                                  .store = work.store,
                                  .bodies = &work.bodies,
                                  .boxes = work.boxes,
                                  .marked = work.marked,
                                  .pairs = &work.pairs,
                                  .contacts = work.narrow.contacts,
                                  .contact_count = work.narrow.contact_count,
                                  .is_filter = is_filter(chosen.narrow.method)};
        draw_bodies(chosen.picture, picture, &scene);
    }
    FILE *report = finish_outputs();
    print_report(report, &work, &chosen);
    finish_report(report);
    commit_outputs();

    free_narrow_result(&work.narrow);
    free(work.marked);
    free(work.pairs.items);
    free(work.boxes);
    free(work.bodies.items);
    narc_destroy_shape_list(work.shapes);
    narc_destroy_shapes(work.store);
}

const command collide_command = {"collide", "bodies against each other: contacts, report, picture", run};
