/* SPDX-License-Identifier: MIT
 *
 * world_main.c - runs a scene, tells each second how it does, and writes files from which the narc command draws it.
 *   cc world*.c scenes.c -o world $(pkg-config --cflags --libs narc) -lm
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

static int print_usage(FILE *to) {
    fprintf(to, "usage: world SCENE [--seconds T] [--seed N] [--substeps N] [--flat-angle DEGREES] [--threads N]\n"
                "                   [--recycling METRES] [--sleep SECONDS] [--out FOLDER]\n\n");
    for (const scene *s = scenes; s->name; s++)
        fprintf(to, "  %-10s %s\n", s->name, s->purpose);
    fprintf(to, "\nWith --recycling 0 all contacts are found anew, with --sleep 0 nothing sleeps. With --out, "
                "shapes.json and bodies.csv show the end:\n"
                "  narc collide --shapes shapes.json --bodies bodies.csv --picture world.png\n");
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

static FILE *open_file(const char *folder, const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        perror(path);
    return file;
}

/* As docs/formats.md describes them. */
static bool write_files(const world *w, const char *folder) {
    FILE *shapes = open_file(folder, "shapes.json"), *bodies = shapes ? open_file(folder, "bodies.csv") : NULL;
    if (!bodies)
        return false;
    for (uint32_t s = 0; s < narc_count_shapes(w->store); s++) {
        narc_arc arc[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(w->store, s, arc);
        fprintf(shapes, "%s{\"name\": \"s%" PRIu32 "\", \"arcs\": [", s == 0 ? "{\"shapes\": [\n" : ",\n", s);
        for (size_t i = 0; i < count; i++)
            fprintf(shapes, "%s{\"center\": [%.9g, %.9g], \"radius\": %.9g, \"start\": %.9g, \"end\": %.9g}",
                    i == 0 ? "" : ", ", arc[i].center_x, arc[i].center_y, arc[i].radius, arc[i].start, arc[i].end);
        fprintf(shapes, "]}");
    }
    fprintf(shapes, "\n]}\n");
    fprintf(bodies, "shape,x,y,angle\n");
    for (size_t k = 0; k < w->body_count; k++) {
        const world_body *body = &w->bodies[k];
        fprintf(bodies, "%" PRIu32 ",%.9g,%.9g,%.9g\n", body->shape, (double)body->position.x, (double)body->position.y,
                atan2((double)body->sine, (double)body->cosine));
    }
    const bool closed = fclose(shapes) == 0;
    return fclose(bodies) == 0 && closed;
}

static narc_status run(const scene *chosen, double seconds, world *w) {
    const long steps = lround(seconds / (double)w->settings.time_step);
    const long second = lroundf(1 / w->settings.time_step);
    size_t events = 0, kept = 0, asked = 0; /* in a second: events, lists of pairs that were kept, contacts found */
    printf("%8s %14s %12s %9s %7s %6s %7s %7s %5s %8s\n", "seconds", "energy", "displacement", "overlap", "moving",
           "awake", "points", "events", "kept", "found");
    for (long step = 1; step <= steps; step++) {
        const narc_status status = step_scene(chosen, w, step);
        if (status != NARC_OK)
            return status;
        events += w->event_count;
        kept += w->list->kept;
        asked += w->asked_count;
        if (step % second != 0 && step != steps)
            continue;
        const scene_state state = measure_scene(w);
        printf("%8.2f %14.4f %12.6f %9.6f %7zu %6zu %7zu %7zu %5zu %8zu\n",
               (double)((float)step * w->settings.time_step), state.energy, state.displacement, state.overlap,
               state.moving, state.awake, state.points, events, kept, asked);
        events = kept = asked = 0;
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
    const char *const folder = find_text(&line, "--out");
    settings.sleep_time = sleep_time > 0 ? (float)sleep_time : INFINITY;
    settings.substeps = (unsigned)find_number(&line, "--substeps", settings.substeps, 1, 1000);
    settings.flat_angle =
        (float)(degree * find_number(&line, "--flat-angle", (double)settings.flat_angle / degree, -90, 90));
    settings.recycling = (float)find_number(&line, "--recycling", (double)settings.recycling, 0, 1e9);
    settings.workers = narc_openmp_workers((unsigned)find_number(&line, "--threads", 1, 0, 256));
    if (line.wrong || line.used != argc)
        return print_usage(stderr);
    world w;
    narc_status status = build_scene(chosen, settings, seed, &w);
    if (status == NARC_OK)
        status = run(chosen, seconds, &w);
    if (status != NARC_OK)
        fprintf(stderr, "world: %s: %s\n", narc_status_name(status), w.error.message);
    const bool done = status == NARC_OK && (!folder || write_files(&w, folder));
    world_destroy(&w);
    return done ? 0 : 2;
}
