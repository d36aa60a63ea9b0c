/* SPDX-License-Identifier: MIT
 *
 * cast.c - narc cast: what the rays of a file hit.
 */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "calls.h"
#include "canvas.h"
#include "commands.h"
#include "fail.h"
#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_scene.h"
#include "options.h"
#include "output.h"
#include "picture_bodies.h"
#include "progress.h"
#include "table.h"
#include "text.h"

enum { LARGEST_MOST = 1000000 };

typedef struct settings {
    const char *shapes, *bodies, *rays, *out, *picture;
    narc_workers workers;
    narc_ray_options cast;
} settings;

/* A row of the rays file. */
typedef struct ray {
    double x, y;
    float motion_x, motion_y;
} ray;

typedef struct ray_list {
    ray *items;
    size_t count, capacity;
} ray_list;

typedef struct job {
    narc_shape_list *shapes;
    narc_shapes *store;
    body_list bodies;
    ray_list rays;
    narc_ray_hit *hits;
    size_t row_count, hit_count, hit_rays, skipped, unboxed;
    double build_seconds, cast_seconds;
} job;

static narc_inside find_inside(const char *name) {
    static const char *const names[] = {
        [NARC_INSIDE_STOPS] = "stops", [NARC_INSIDE_LEAVES] = "leaves", [NARC_INSIDE_IGNORES] = "ignores"};
    for (size_t k = 0; name && k < sizeof names / sizeof names[0]; k++)
        if (strcmp(name, names[k]) == 0)
            return (narc_inside)k;
    if (name)
        fail("--inside must be stops, leaves or ignores '%s'", narc_make_excerpt(name).text);
    return NARC_INSIDE_STOPS;
}

static settings read_settings(int argc, char **argv) {
    enum { SHAPES, BODIES, RAYS, OUT, INSIDE, MOST, PICTURE, ISA, THREADS, OPTIONS };
    option options[OPTIONS] = {
        {"--shapes", INPUT_FILE, NULL},   {"--bodies", INPUT_FILE, NULL}, {"--rays", INPUT_FILE, NULL},
        {"--out", OUTPUT_FILE, NULL},     {"--inside", true, NULL},       {"--most", true, NULL},
        {"--picture", OUTPUT_FILE, NULL}, {"--isa", true, NULL},          {"--threads", true, NULL}};
    parse_options(argc, argv, options, OPTIONS, NULL, NULL);
    settings chosen = {.shapes = required_option(&options[SHAPES]),
                       .bodies = required_option(&options[BODIES]),
                       .rays = required_option(&options[RAYS]),
                       .out = options[OUT].value,
                       .picture = options[PICTURE].value};
    picture_kind_of(chosen.picture);
    chosen.cast.inside = find_inside(options[INSIDE].value);
    chosen.cast.most = options[MOST].value ? (size_t)whole_option(&options[MOST], 1, LARGEST_MOST) : 1;
    choose_isa(options[ISA].value);
    chosen.workers = choose_workers(&options[THREADS]);
    return chosen;
}

static float read_motion(table *rows, size_t column) {
    const double value = row_number(rows, column);
    if (fabs(value) > (double)FLT_MAX)
        fail_field(rows, column, "is beyond the range of single precision");
    return (float)value;
}

static void read_rays(const char *path, ray_list *out_rays) {
    enum { X, Y, MOTION_X, MOTION_Y, COLUMNS };
    static const char *const names[COLUMNS] = {"x", "y", "motion_x", "motion_y"};
    table rows;
    open_table(&rows, path, names, COLUMNS, COLUMNS);
    ray_list rays = {0};
    rays.items = grow(NULL, &rays.capacity, 0, sizeof *rays.items);
    while (next_row(&rows, "reading rays")) {
        if (rays.count == UINT32_MAX)
            fail_at(path, rows.csv.line, "more than %u rays", UINT32_MAX);
        rays.items = grow(rays.items, &rays.capacity, rays.count + 1, sizeof *rays.items);
        const ray read = {row_number(&rows, X), row_number(&rows, Y), read_motion(&rows, MOTION_X),
                          read_motion(&rows, MOTION_Y)};
        if (read.motion_x == 0 && read.motion_y == 0)
            fail_field(&rows, MOTION_X, "and motion_y make a ray of no length");
        rays.items[rays.count++] = read;
    }
    close_table(&rows);
    *out_rays = rays;
}

static void cast_rays(const settings *chosen, job *work) {
    const narc_bodies bodies = view_bodies(&work->bodies);
    const ray *items = work->rays.items;
    const narc_rays rays = {.count = work->rays.count,
                            .x = NARC_POSITION_COLUMN(items, x),
                            .y = NARC_POSITION_COLUMN(items, y),
                            .motion_x = NARC_COLUMN(items, motion_x),
                            .motion_y = NARC_COLUMN(items, motion_y)};
    const narc_owners owners = {.owner = NARC_COLUMN(work->bodies.items, row)};
    narc_ray_options options = chosen->cast;
    options.search.owners = &owners;
    options.search.workers = &chosen->workers;
    options.out_skipped = &work->skipped;
    if (rays.count > SIZE_MAX / options.most)
        fail("not enough memory");
    work->row_count = rays.count * options.most;
    work->hits = allocate(work->row_count, sizeof *work->hits);
    narc_box *boxes = allocate(bodies.count, sizeof *boxes);
    narc_index *index;
    narc_error error;
    check_call(narc_create_index(NULL, &index), &(narc_error){.message = "not enough memory"});
    show_stage("casting", rays.count, "rays", false);
    const double start = seconds_now();
    check_call(
        narc_compute_boxes(work->store, &bodies, &(narc_box_options){.workers = &chosen->workers}, boxes, &error),
        &error);
    const narc_index_options building = {.workers = &chosen->workers};
    check_call(narc_build_index(index, boxes, bodies.count, &building, &error), &error);
    const double built = seconds_now();
    check_call(narc_cast_rays(index, work->store, &bodies, &rays, &options, work->hits, work->row_count, &error),
               &error);
    work->cast_seconds = seconds_now() - built;
    work->build_seconds = built - start;
    narc_destroy_index(index);
    free(boxes);
    work->unboxed = count_unboxed(work->store, &work->bodies);
    for (size_t k = 0; k < work->row_count; k++) {
        work->hit_count += work->hits[k].count;
        work->hit_rays += k % options.most == 0 && work->hits[k].count;
    }
}

/* The library's points are relative to the body, those of the file are in the world. Adding 0 makes a negative zero a
 * plain one. */
static void write_hits(FILE *file, const job *work) {
    const bool in_parts = has_parts(&work->bodies);
    fprintf(file, "ray,body,fraction,normal_x,normal_y,point_x,point_y,arc%s\n", in_parts ? ",part" : "");
    for (size_t k = 0; k < work->row_count && !ferror(file); k++) {
        const narc_ray_hit *hit = &work->hits[k];
        show_progress("writing hits", k, work->row_count);
        if (!hit->count)
            continue;
        const body *at = &work->bodies.items[hit->body];
        fprintf(file, "%" PRIu32 ",%" PRIu32 ",%.9g,%.9g,%.9g,%.17g,%.17g,%d", hit->ray, at->row, (double)hit->fraction,
                0 + (double)hit->normal_x, 0 + (double)hit->normal_y, 0 + (at->x + (double)hit->point_x),
                0 + (at->y + (double)hit->point_y), hit->feature & (NARC_MAX_ARCS - 1));
        if (in_parts)
            fprintf(file, ",%" PRIu32, at->part);
        fprintf(file, "\n");
    }
}

static void draw(const settings *chosen, FILE *picture, const job *work) {
    const size_t body_count = work->bodies.count;
    bool *is_hit = allocate(body_count, sizeof *is_hit);
    memset(is_hit, 0, body_count * sizeof *is_hit);
    drawn_ray *rays = allocate(work->row_count, sizeof *rays);
    for (size_t k = 0; k < work->row_count; k++) {
        const narc_ray_hit *hit = &work->hits[k];
        const ray *from = &work->rays.items[k / chosen->cast.most];
        rays[k] =
            (drawn_ray){from->x, from->y, from->x + (double)from->motion_x, from->y + (double)from->motion_y, *hit};
        if (hit->count) {
            const body *at = &work->bodies.items[hit->body];
            is_hit[hit->body] = true;
            rays[k].end_x = at->x + (double)hit->point_x;
            rays[k].end_y = at->y + (double)hit->point_y;
        }
    }
    narc_aabb *boxes = bound_bodies(work->store, &work->bodies);
    draw_bodies(chosen->picture, picture,
                &(body_scene){.shapes = work->shapes,
                              .store = work->store,
                              .bodies = &work->bodies,
                              .boxes = boxes,
                              .marked = is_hit,
                              .rays = rays,
                              .ray_count = work->row_count,
                              .hits_per_ray = chosen->cast.most});
    free(boxes);
    free(rays);
    free(is_hit);
}

static void print_report(FILE *file, const job *work) {
    fprintf(file, "shapes              %zu\n", work->shapes->count);
    fprintf(file, "bodies              %zu\n", work->bodies.row_count);
    print_unboxed(file, work->unboxed);
    fprintf(file, "all rays            %zu\n", work->rays.count);
    fprintf(file, "rays that hit       %zu\n", work->hit_rays);
    fprintf(file, "hits                %zu\n", work->hit_count);
    fprintf(file, "skipped rays        %zu\n", work->skipped);
    fprintf(file, "instruction set     %s\n", narc_get_isa());
    fprintf(file, "boxes and index     %.3f ms\n", 1e3 * work->build_seconds);
    fprintf(file, "narc_cast_rays      %.3f ms\n", 1e3 * work->cast_seconds);
}

static void run(int argc, char **argv) {
    const settings chosen = read_settings(argc, argv);
    job work = {0};
    work.shapes = read_shapes(chosen.shapes, &work.store);
    read_bodies(chosen.bodies, chosen.shapes, work.shapes, work.store, &work.bodies);
    check_picture_size(chosen.picture, work.bodies.count);
    read_rays(chosen.rays, &work.rays);
    FILE *out = chosen.out ? open_output(chosen.out) : NULL;
    FILE *picture = chosen.picture ? open_output(chosen.picture) : NULL;
    cast_rays(&chosen, &work);
    if (out) {
        write_hits(out, &work);
        flush_output(out);
    }
    if (picture)
        draw(&chosen, picture, &work);
    FILE *report = finish_outputs();
    print_report(report, &work);
    finish_report(report);
    commit_outputs();
    free(work.hits);
    free(work.rays.items);
    free(work.bodies.items);
    narc_destroy_shape_list(work.shapes);
    narc_destroy_shapes(work.store);
}

const command cast_command = {"cast", "rays against bodies: hits, report, picture", run};
