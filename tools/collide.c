/* SPDX-License-Identifier: MIT
 *
 * collide.c - narc collide: bodies of a file against each other.
 */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "broad_phase.h"
#include "canvas.h"
#include "commands.h"
#include "fail.h"
#include "narc.h"
#include "options.h"
#include "output.h"
#include "picture_bodies.h"
#include "progress.h"
#include "shapes_json.h"

static const char HELP[] =
    "usage: narc collide --shapes shapes.json --bodies bodies.csv [--pairs pairs.csv]\n"
    "                    [--out contacts.csv] [--all] [--margin M] [--picture FILE]\n"
    "                    [--isa NAME] [--threads N]\n"
    "\n"
    "Tests bodies for collision, exactly, and prints a short report.\n"
    "\n"
    "  --shapes FILE   the shapes file\n"
    "  --bodies FILE   CSV, header shape,x,y,angle or shape,x,y,angle,scale; a shape is given by\n"
    "                  its name or its index from 0, an angle in radians\n"
    "  --pairs FILE    CSV, header a,b: the pairs to test, body indices from 0; left out: all\n"
    "                  pairs whose bounding boxes overlap (or come closer than the margin)\n"
    "  --out FILE      the contacts: CSV, header\n"
    "                  a,b,separation,normal_x,normal_y,point_x,point_y,arc_a,arc_b\n"
    "                  -: standard output, and the report goes to standard error\n"
    "  --margin M      report pairs whose separation is less than M; default 0, those that collide\n"
    "  --all           report every pair, whatever its separation: those of --pairs, and without\n"
    "                  it every candidate; then --margin only widens the search for candidates\n"
    "  --picture FILE  a .png or .svg picture of bodies, contact points and normals\n"
    "  --isa NAME      the instruction set: scalar, neon, avx2 or avx512 (see narc info)\n"
    "  --threads N     1 to 1024; left out: one for each processor\n"
    "\n"
    "The narrow phase's time is that of the batch call narc_find_contacts() alone; it is repeated\n"
    "and the median taken where one call is too short to measure.\n"
    "\n"
    "The shapes file: {\"shapes\": [SHAPE, ...]}, where a SHAPE is one of\n"
    "  {\"name\": \"lens\", \"arcs\": [{\"center\": [x, y], \"radius\": r, \"start\": a, \"end\": b}, ...]}\n"
    "  {\"name\": \"p\", \"points\": [[x, y], ...], \"radius\": r}     an n-arc's junctions\n"
    "  {\"name\": \"q\", \"polygon\": [[x, y], ...], \"radius\": r}    corners rounded, 0 if left out\n"
    "  {\"name\": \"c\", \"circle\": r}\n"
    "  {\"name\": \"k\", \"capsule\": {\"length\": l, \"radius\": r}}\n"
    "  {\"name\": \"b\", \"box\": {\"width\": w, \"height\": h, \"radius\": r}}\n";

enum { LARGEST_THREADS = 1024 };

/* One batch call is repeated until this much time has been measured, or this often. */
static const double MEASURED_SECONDS = 0.2;
enum { MOST_RUNS = 9 };

/* A batch call with more pairs may take a second on one thread without vector instructions. */
enum { MANY_PAIRS = 4000000 };

typedef struct settings {
    const char *shapes, *bodies, *pairs, *out, *picture, *isa;
    float margin;         /* +infinity: every pair */
    double search_margin; /* bounding boxes closer than this are candidates */
    unsigned threads;     /* 0: the library's choice */
} settings;

typedef struct job {
    shape_list shapes;
    body_list bodies;
    narc_aabb *boxes;
    pair_list pairs;
    narc_contacts contacts;
    size_t contact_count, colliding_count;
    bool *colliding; /* bodies */
    double broad_seconds, narrow_seconds;
    int runs;
} job;

static settings read_settings(int argc, char **argv) {
    enum { SHAPES, BODIES, PAIRS, OUT, ALL, MARGIN, PICTURE, ISA, THREADS, OPTIONS };
    option options[OPTIONS] = {{"--shapes", true, NULL},  {"--bodies", true, NULL}, {"--pairs", true, NULL},
                               {"--out", true, NULL},     {"--all", false, NULL},   {"--margin", true, NULL},
                               {"--picture", true, NULL}, {"--isa", true, NULL},    {"--threads", true, NULL}};
    parse_options(argc, argv, options, OPTIONS, NULL, 0, NULL);
    settings chosen = {.shapes = required_option(&options[SHAPES]),
                       .bodies = required_option(&options[BODIES]),
                       .pairs = options[PAIRS].value,
                       .out = options[OUT].value,
                       .picture = options[PICTURE].value,
                       .isa = options[ISA].value};
    picture_kind_of(chosen.picture);
    if (options[MARGIN].value) {
        const double margin = number_option(&options[MARGIN]);
        if (fabs(margin) > (double)FLT_MAX) {
            fail("--margin is too large '%s'", options[MARGIN].value);
        }
        chosen.margin = (float)margin;
        chosen.search_margin = fmax(margin, 0);
    }
    if (options[ALL].value) {
        chosen.margin = INFINITY;
    }
    if (options[THREADS].value) {
        chosen.threads = (unsigned)whole_option(&options[THREADS], 1, LARGEST_THREADS);
    }
    return chosen;
}

static void check(narc_status status, const narc_error *error) {
    if (status != NARC_OK) {
        fail("%s", error->message);
    }
}

/* The bodies' bounding boxes in the world, rounded outwards: the kernels subtract positions exactly, a box must not
 * lose a pair to rounding. */
static void bound_bodies(job *work) {
    work->boxes = allocate(work->bodies.count, sizeof *work->boxes);
    for (size_t i = 0; i < work->bodies.count; i++) {
        const body *at = &work->bodies.items[i];
        narc_aabb box;
        narc_get_aabb(work->shapes.store, at->shape, at->cosine, at->sine, at->scale, &box);
        work->boxes[i] = (narc_aabb){nextafter(at->x + box.min_x, -INFINITY), nextafter(at->y + box.min_y, -INFINITY),
                                     nextafter(at->x + box.max_x, INFINITY), nextafter(at->y + box.max_y, INFINITY)};
    }
}

static void find_pairs(job *work, double margin) {
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
    find_candidates(widened ? widened : work->boxes, count, &work->pairs);
    free(widened);
}

static void allocate_contacts(narc_contacts *contacts, size_t capacity) {
    *contacts = (narc_contacts){.capacity = capacity,
                                .pair = allocate(capacity, sizeof(uint32_t)),
                                .separation = allocate(capacity, sizeof(float)),
                                .normal_x = allocate(capacity, sizeof(float)),
                                .normal_y = allocate(capacity, sizeof(float)),
                                .point_x = allocate(capacity, sizeof(float)),
                                .point_y = allocate(capacity, sizeof(float)),
                                .arc_a = allocate(capacity, 1),
                                .arc_b = allocate(capacity, 1)};
}

static void free_contacts(narc_contacts *contacts) {
    free(contacts->pair);
    free(contacts->separation);
    free(contacts->normal_x);
    free(contacts->normal_y);
    free(contacts->point_x);
    free(contacts->point_y);
    free(contacts->arc_a);
    free(contacts->arc_b);
}

static int compare_numbers(const void *left, const void *right) {
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* The batch call, timed. */
static void run_narrow_phase(job *work, const settings *chosen) {
    const narc_bodies bodies = view_bodies(&work->bodies);
    const narc_pairs pairs = view_pairs(&work->pairs);
    double seconds[MOST_RUNS], total = 0;
    allocate_contacts(&work->contacts, work->pairs.count);
    show_stage("narrow phase", work->pairs.count, "pairs", work->pairs.count > MANY_PAIRS);
    work->runs = 0;
    while (work->runs < MOST_RUNS && total < MEASURED_SECONDS) {
        narc_error error;
        const double start = seconds_now();
        const narc_status status = narc_find_contacts(work->shapes.store, &bodies, &pairs, chosen->margin,
                                                      chosen->threads, &work->contacts, &work->contact_count, &error);
        seconds[work->runs] = seconds_now() - start;
        check(status, &error);
        total += seconds[work->runs++];
    }
    qsort(seconds, (size_t)work->runs, sizeof *seconds, compare_numbers);
    work->narrow_seconds = seconds[work->runs / 2];
}

static void mark_pair(job *work, size_t index) {
    const pair hit = work->pairs.items[index];
    work->colliding[hit.a] = work->colliding[hit.b] = true;
    work->colliding_count++;
}

/* Counts the colliding pairs and marks their bodies. With a margin below 0 they are not all among the contacts. */
static void count_collisions(job *work, const settings *chosen) {
    work->colliding = allocate(work->bodies.count, sizeof *work->colliding);
    for (size_t i = 0; i < work->bodies.count; i++) {
        work->colliding[i] = false;
    }
    if (chosen->margin >= 0) {
        for (size_t k = 0; k < work->contact_count; k++) {
            if (work->contacts.separation[k] < 0) {
                mark_pair(work, work->contacts.pair[k]);
            }
        }
        return;
    }
    const narc_bodies bodies = view_bodies(&work->bodies);
    const narc_pairs pairs = view_pairs(&work->pairs);
    uint64_t *bits = allocate(NARC_BIT_WORDS(work->pairs.count), sizeof *bits);
    narc_error error;
    check(narc_find_overlaps(work->shapes.store, &bodies, &pairs, chosen->threads, bits, &error), &error);
    for (size_t k = 0; k < work->pairs.count; k++) {
        if (bits[k / 64] >> k % 64 & 1) {
            mark_pair(work, k);
        }
    }
    free(bits);
}

/* Adding 0 makes a negative zero a plain one. */
static void write_contacts(FILE *file, const job *work) {
    const narc_contacts *found = &work->contacts;
    fprintf(file, "a,b,separation,normal_x,normal_y,point_x,point_y,arc_a,arc_b\n");
    for (size_t k = 0; k < work->contact_count && !ferror(file); k++) {
        const pair of = work->pairs.items[found->pair[k]];
        const body *a = &work->bodies.items[of.a];
        fprintf(file, "%" PRIu32 ",%" PRIu32 ",%.9g,%.9g,%.9g,%.9g,%.9g,%u,%u\n", of.a, of.b,
                0 + (double)found->separation[k], 0 + (double)found->normal_x[k], 0 + (double)found->normal_y[k],
                0 + (a->x + (double)found->point_x[k]), 0 + (a->y + (double)found->point_y[k]),
                (unsigned)found->arc_a[k], (unsigned)found->arc_b[k]);
        show_progress("writing contacts", k, work->contact_count);
    }
}

static void print_threads(FILE *file, unsigned chosen) {
#ifdef NARC_TOOL_OPENMP
    fprintf(file, "threads             at most %u\n", chosen ? chosen : narc_default_threads());
#else
    (void)chosen;
    fprintf(file, "threads             1 (built without OpenMP)\n");
#endif
}

static void print_report(FILE *file, const job *work, const settings *chosen) {
    fprintf(file, "shapes              %zu\n", work->shapes.count);
    fprintf(file, "bodies              %zu\n", work->bodies.count);
    fprintf(file, "candidate pairs     %zu%s\n", work->pairs.count, chosen->pairs ? " (from the file)" : "");
    fprintf(file, "colliding pairs     %zu\n", work->colliding_count);
    fprintf(file, "reported contacts   %zu\n", work->contact_count);
    fprintf(file, "instruction set     %s\n", narc_get_isa());
    print_threads(file, chosen->threads);
    if (!chosen->pairs) {
        fprintf(file, "broad phase         %.3f ms\n", 1e3 * work->broad_seconds);
    }
    fprintf(file, "narrow phase        %.3f ms (narc_find_contacts, ", 1e3 * work->narrow_seconds);
    if (work->runs == 1) {
        fprintf(file, "one run)\n");
    } else {
        fprintf(file, "median of %d runs)\n", work->runs);
    }
    const double speed = work->narrow_seconds > 0 ? 1e-6 * (double)work->pairs.count / work->narrow_seconds : 0;
    fprintf(file, "speed               %.2f million pairs per second\n", speed);
}

static void run(int argc, char **argv) {
    const settings chosen = read_settings(argc, argv);
    job work = {0};
    narc_error error;
    if (chosen.isa && narc_set_isa(chosen.isa, &error) != NARC_OK) {
        /* The message begins with the library's function; the user knows the option. */
        fail("--isa%s", error.message + strcspn(error.message, ":"));
    }
    read_shapes(chosen.shapes, &work.shapes);
    read_bodies(chosen.bodies, &work.shapes, &work.bodies);
    check_picture_size(chosen.picture, work.bodies.count);
    bound_bodies(&work);
    if (chosen.pairs) {
        read_pairs(chosen.pairs, work.bodies.count, &work.pairs);
    }
    /* Outputs that cannot be written are found before the work is done. */
    FILE *out = chosen.out ? open_output(chosen.out) : NULL;
    FILE *picture = chosen.picture ? open_output(chosen.picture) : NULL;
    if (!chosen.pairs) {
        const double start = seconds_now();
        find_pairs(&work, chosen.search_margin);
        work.broad_seconds = seconds_now() - start;
    }
    run_narrow_phase(&work, &chosen);
    count_collisions(&work, &chosen);
    if (out) {
        write_contacts(out, &work);
    }
    if (picture) {
        const body_scene scene = {&work.shapes, &work.bodies,   work.boxes,        work.colliding,
                                  &work.pairs,  &work.contacts, work.contact_count};
        draw_bodies(chosen.picture, picture, &scene);
    }
    finish_outputs();
    hide_progress();
    FILE *report = is_standard_output(chosen.out) ? stderr : stdout;
    print_report(report, &work, &chosen);
    finish_report(report);
    commit_outputs();

    free_contacts(&work.contacts);
    free(work.colliding);
    free(work.pairs.items);
    free(work.boxes);
    free(work.bodies.items);
    free_shapes(&work.shapes);
}

const command collide_command = {"collide", "bodies against each other: contacts, report, picture", HELP, run};
