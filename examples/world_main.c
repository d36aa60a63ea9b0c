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

typedef struct request {
    const scene *scene;
    world_settings settings;
    float seconds;
    uint64_t seed;
    const char *folder; /* where files go, or NULL */
} request;

static int print_usage(FILE *to) {
    fprintf(to, "usage: world SCENE [--seconds T] [--seed N] [--substeps N] [--flat-angle DEGREES] [--threads N]\n"
                "                   [--recycling METRES] [--sleep SECONDS] [--out FOLDER]\n\n");
    for (size_t i = 0; get_scene(i); i++)
        fprintf(to, "  %-10s %s\n", get_scene(i)->name, get_scene(i)->purpose);
    fprintf(to, "\nWith --recycling 0 all contacts are found anew, with --sleep 0 nothing sleeps. With --out, "
                "shapes.json and bodies.csv show the end:\n"
                "  narc collide --shapes shapes.json --bodies bodies.csv --picture world.png\n");
    return to == stdout ? 0 : 2;
}

static bool read_option(request *wanted, const char *name, const char *value) {
    char *end;
    const double number = strtod(value, &end);
    if (strcmp(name, "--out") == 0) {
        wanted->folder = value;
        return true;
    }
    if (*value == '\0' || *end != '\0' || !(number >= -90 && number <= 1e9))
        return false;
    if (strcmp(name, "--seconds") == 0 && number > 0)
        wanted->seconds = (float)number;
    else if (strcmp(name, "--seed") == 0 && number >= 0)
        wanted->seed = (uint64_t)number;
    else if (strcmp(name, "--substeps") == 0 && number >= 1 && number <= 1000)
        wanted->settings.substeps = (unsigned)number;
    else if (strcmp(name, "--flat-angle") == 0)
        wanted->settings.flat_angle = (float)(number * 3.14159265 / 180);
    else if (strcmp(name, "--recycling") == 0 && number >= 0)
        wanted->settings.recycling = (float)number;
    else if (strcmp(name, "--sleep") == 0 && number >= 0)
        wanted->settings.sleep_time = number > 0 ? (float)number : INFINITY;
    else if (strcmp(name, "--threads") == 0 && number >= 0 && number <= 256)
        wanted->settings.workers = narc_openmp_workers((unsigned)number);
    else
        return false;
    return true;
}

static FILE *open_file(const char *folder, const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        fprintf(stderr, "world: %s cannot be written\n", path);
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

static narc_status run(const request *wanted, world *w, world_body *start) {
    const long steps = lroundf(wanted->seconds / w->settings.time_step);
    const long second = lroundf(1 / w->settings.time_step);
    memcpy(start, w->bodies, w->body_count * sizeof *start);
    size_t events = 0, kept = 0, asked = 0; /* in a second: events, lists of pairs that were kept, contacts found */
    printf("%8s %14s %12s %9s %7s %6s %9s %7s %7s %5s %8s\n", "seconds", "energy", "displacement", "overlap", "moving",
           "awake", "contacts", "points", "events", "kept", "found");
    for (long step = 1; step <= steps; step++) {
        const narc_status status = step_scene(wanted->scene, w, step);
        if (status != NARC_OK)
            return status;
        events += w->event_count;
        kept += w->list->kept;
        asked += w->asked_count;
        if (step % second != 0 && step != steps)
            continue;
        const scene_state state = measure_scene(w, start);
        printf("%8.2f %14.4f %12.6f %9.6f %7zu %6zu %9zu %7zu %7zu %5zu %8zu\n",
               (double)((float)step * w->settings.time_step), state.energy, state.displacement, state.overlap,
               state.moving, state.awake, state.contacts, state.points, events, kept, asked);
        events = kept = asked = 0;
    }
    printf("state %016" PRIx64 "\n", world_hash(w));
    return NARC_OK;
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--help") == 0)
        return print_usage(stdout);
    request wanted = {.scene = argc > 1 ? find_scene(argv[1]) : NULL, .settings = world_defaults, .seed = 1};
    if (!wanted.scene || argc % 2 != 0)
        return print_usage(stderr);
    wanted.seconds = wanted.scene->seconds;
    for (int i = 2; i < argc; i += 2)
        if (!read_option(&wanted, argv[i], argv[i + 1]))
            return print_usage(stderr);
    world w;
    narc_status status = build_scene(wanted.scene, wanted.settings, wanted.seed, &w);
    world_body *start = calloc(wanted.scene->capacity, sizeof *start);
    bool written = true;
    if (status == NARC_OK && start)
        status = run(&wanted, &w, start);
    if (status == NARC_OK && wanted.folder)
        written = write_files(&w, wanted.folder);
    if (status != NARC_OK)
        fprintf(stderr, "world: %s: %s\n", narc_status_name(status), w.error.message);
    free(start);
    world_destroy(&w);
    return status == NARC_OK && start && written ? 0 : 2;
}
