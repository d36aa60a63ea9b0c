/* SPDX-License-Identifier: MIT
 *
 * world_main.c - runs a scene, tells each second how it does, and draws it.
 *   cc world*.c scenes.c -o world $(pkg-config --cflags --libs narc) -lm
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

static int print_usage(FILE *to) {
    fprintf(to, "usage: world SCENE [--seconds T] [--seed N] [--substeps N] [--flat-angle DEGREES] [--threads N]\n"
                "                   [--recycling METRES] [--sleep SECONDS] [--picture FILE [--every SECONDS]]\n\n");
    for (const scene *s = scenes; s->name; s++)
        fprintf(to, "  %-10s %s\n", s->name, s->purpose);
    fprintf(to, "\nWith --recycling 0 all contacts are found anew, with --sleep 0 nothing sleeps. The picture is an "
                "SVG image of the end,\nand with --every of the way there.\n");
    return to == stdout ? 0 : 2;
}

typedef struct command_line {
    int count, used; /* words; those that were understood */
    bool wrong;
    char **words;
} command_line;

static const char *find_text(command_line *line, const char *name) {
    for (int i = 2; i + 1 < line->count; i += 2)
        if (strcmp(line->words[i], name) == 0) {
            line->used += 2;
            return line->words[i + 1];
        }
    return NULL;
}

static double find_number(command_line *line, const char *name, double otherwise, double least, double most) {
    const char *const text = find_text(line, name);
    char *end;
    const double number = text ? strtod(text, &end) : otherwise;
    line->wrong |= text && (*text == '\0' || *end != '\0' || !(number >= least && number <= most));
    return line->wrong ? otherwise : number;
}

/* An SVG image of the ground and of bodies, the same ones at several times. Its head, the last to be known, is first. */
typedef struct picture {
    FILE *file;
    narc_aabb box;
} picture;

static void begin_picture(picture *p) {
    const narc_aabb b = p->box;
    const double width = b.max_x - b.min_x, height = b.max_y - b.min_y;
    rewind(p->file);
    fprintf(p->file,
            "<svg xmlns='http://www.w3.org/2000/svg' width='1200' viewBox='%9.3f %9.3f %9.3f %9.3f'>\n"
            "<rect x='%9.3f' y='%9.3f' width='100%%' height='100%%' fill='white'/>\n"
            "<g transform='scale(1 -1)' stroke='#333' stroke-width='0.02'>\n",
            b.min_x, -b.max_y, width, height, b.min_x, -b.max_y);
}

/* Ground, of which runs are closed behind by four corners (narc_chains.h), is a band below its surface. */
static void draw_body(picture *p, const world *w, const world_body *body, double opacity) {
    narc_arc arc[NARC_MAX_ARCS];
    narc_aabb box;
    const size_t number = (size_t)(body - w->bodies);
    const bool ground = number >= w->body_count, run = narc_shape_flags(w->store, body->shape) & NARC_SHAPE_RUN;
    const size_t count = narc_get_arcs(w->store, body->shape, arc) - (run ? 4 : 0);
    const double x = (double)body->position.x, y = (double)body->position.y, half = ground ? 0.08 : 0, margin = 0.3;
    narc_get_aabb(w->store, body->shape, body->cosine, body->sine, 1, &box);
    if (ground || !(body->kind & NARC_STATIC))
        p->box = (narc_aabb){fmin(p->box.min_x, x + box.min_x - margin), fmin(p->box.min_y, y + box.min_y - margin),
                             fmax(p->box.max_x, x + box.max_x + margin), fmax(p->box.max_y, y + box.max_y + margin)};
    fprintf(p->file, "<path transform='matrix(%.4f %.4f %.4f %.4f %.3f %.3f)' ", (double)body->cosine,
            (double)body->sine, -(double)body->sine, (double)body->cosine, x, y);
    if (ground)
        fprintf(p->file, "fill='none' stroke='#9a8a70' stroke-width='%g' stroke-linecap='round' d='", 2 * half);
    else
        fprintf(p->file, "fill='hsl(%zu,%d%%,65%%)' opacity='%g' d='", number * 137 % 360,
                body->kind & NARC_STATIC ? 0 : 60, opacity);
    for (size_t i = 0; i < 3 * count; i++) { /* in two halves: SVG draws no full circle */
        const narc_arc *a = &arc[i / 3];
        const double radius = a->radius - half, angle = a->start + (double)(i % 3) / 2 * (a->end - a->start);
        if (i % 3 == 0)
            fputc(i == 0 ? 'M' : 'L', p->file);
        else
            fprintf(p->file, "A%.3f %.3f 0 0 %d ", fabs(radius), fabs(radius), a->end > a->start);
        fprintf(p->file, "%.3f %.3f", a->center_x + radius * cos(angle), a->center_y + radius * sin(angle));
    }
    fprintf(p->file, "%s'/>\n", ground ? "" : "z");
}

static void draw_bodies(picture *p, const world *w, double opacity) {
    for (size_t k = 0; p->file && k < w->body_count; k++)
        draw_body(p, w, &w->bodies[k], opacity);
}

static picture open_picture(const char *path, const world *w) {
    picture p = {path ? fopen(path, "w") : NULL, {INFINITY, INFINITY, -INFINITY, -INFINITY}};
    if (path && !p.file)
        perror(path);
    if (p.file)
        begin_picture(&p);
    for (size_t k = 0; p.file && k < w->ground_count; k++)
        draw_body(&p, w, &w->bodies[w->body_count + k], 1);
    return p;
}

static bool close_picture(picture *p) {
    fprintf(p->file, "</g>\n</svg>\n");
    begin_picture(p);
    return fclose(p->file) == 0;
}

static narc_status run(const scene *chosen, double seconds, world *w, picture *drawn, double every) {
    const long steps = lround(seconds / (double)w->settings.time_step);
    const long second = lroundf(1 / w->settings.time_step);
    size_t events = 0, asked = 0; /* in a second: events, pairs that were asked */
    printf("%8s %14s %12s %9s %7s %6s %7s %7s %8s\n", "seconds", "energy", "displacement", "overlap", "moving", "awake",
           "points", "events", "asked");
    for (long step = 1; step <= steps; step++) {
        const narc_status status = step_scene(chosen, w, step);
        if (status != NARC_OK)
            return status;
        events += w->event_count;
        asked += w->result->asked_count;
        if (every > 0 && (step - 1) % lround(every / (double)w->settings.time_step) == 0)
            draw_bodies(drawn, w, 0.4);
        if (step % second != 0 && step != steps)
            continue;
        const scene_state state = measure_scene(w);
        printf("%8.2f %14.4f %12.6f %9.6f %7zu %6zu %7zu %7zu %8zu\n", (double)((float)step * w->settings.time_step),
               state.energy, state.displacement, state.overlap, state.moving, state.awake, state.points, events, asked);
        events = asked = 0;
    }
    printf("state %016" PRIx64 "\n", world_hash(w));
    return NARC_OK;
}

int main(int argc, char **argv) {
    const double degree = 3.14159265358979 / 180;
    const scene *const chosen = argc > 1 ? find_scene(argv[1]) : NULL;
    if (!chosen)
        return print_usage(argc == 2 && strcmp(argv[1], "--help") == 0 ? stdout : stderr);
    command_line line = {argc, 2, false, argv};
    world_settings settings = world_defaults;
    const double seconds = find_number(&line, "--seconds", (double)chosen->seconds, 1e-3, 1e9);
    const uint64_t seed = (uint64_t)find_number(&line, "--seed", 1, 0, 1e9);
    const double sleep_time = find_number(&line, "--sleep", (double)settings.sleep_time, 0, 1e9);
    const char *const path = find_text(&line, "--picture");
    const double every = find_number(&line, "--every", 0, 0.02, 1e9);
    settings.sleep_time = sleep_time > 0 ? (float)sleep_time : INFINITY;
    settings.substeps = (unsigned)find_number(&line, "--substeps", settings.substeps, 1, 1000);
    settings.flat_angle =
        (float)(degree * find_number(&line, "--flat-angle", (double)settings.flat_angle / degree, -90, 90));
    settings.recycling = (float)find_number(&line, "--recycling", (double)settings.recycling, 0, 1e9);
    narc_openmp_workers((unsigned)find_number(&line, "--threads", 1, 0, 256), &settings.workers);
    if (line.wrong || line.used != argc)
        return print_usage(stderr);
    world w;
    narc_status status = build_scene(chosen, settings, seed, &w);
    picture drawn = open_picture(path, &w);
    if (status == NARC_OK && (drawn.file || !path))
        status = run(chosen, seconds, &w, &drawn, every);
    if (status != NARC_OK)
        fprintf(stderr, "world: %s: %s\n", narc_status_name(status), w.error.message);
    draw_bodies(&drawn, &w, 1);
    const bool done = drawn.file ? close_picture(&drawn) && status == NARC_OK : status == NARC_OK && !path;
    world_destroy(&w);
    return done ? 0 : 2;
}
