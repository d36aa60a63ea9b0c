/* SPDX-License-Identifier: MIT
 *
 * main.c - runs an input: stages, outputs, progress, signals.
 *
 * Exit status: 0 the run is complete; 2 an error; 128 + the signal's number if SIGINT or SIGTERM ended it, after a
 * restart was written.
 */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "input.h"

/* On a clock that never goes back. */
static double find_seconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static volatile sig_atomic_t caught;

static void on_signal(int number) { caught = number; }

static void watch_signals(void) {
    const struct sigaction action = {.sa_handler = on_signal};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGXFSZ, SIG_IGN); /* a file beyond the limit is an error of writing */
}

/* ------------------------------------------------------------------------------------------------ a run */

typedef struct run {
    dem world;
    dem_input input;
    dem_progress progress;
    FILE *csv;
    uint64_t total_steps, first_step;
    double began, shown; /* seconds */
    bool terminal;
} run;

static void write_restart(run *r) {
    const dem_output *o = &r->input.output;
    if (o->restart[0])
        dem_write_restart(&r->world, &r->progress, o->restart);
}

static void write_frame(run *r) {
    const dem_output *o = &r->input.output;
    dem *d = &r->world;
    char name[DEM_PATH_SIZE];
    if (r->csv) {
        dem_measures measures;
        dem_measure(d, &o->region, &measures);
        if (!dem_write_csv(r->csv, d, &measures))
            dem_quit("%s: it cannot be written: %s", o->csv, strerror(errno));
        r->progress.csv_position = (uint64_t)ftell(r->csv);
    }
    if (o->vtk[0])
        dem_write_vtk(d, o->vtk, r->progress.frame);
    if (o->grains[0]) { /* "out/pile.csv" and 12 make "out/pile-000012.csv" */
        snprintf(name, sizeof name, "%.*s-%06" PRIu64 ".csv", (int)strlen(o->grains) - 4, o->grains, r->progress.frame);
        dem_write_grains(d, name);
    }
    r->progress.frame++;
}

/* Twice a second on a terminal: how far it is, and how long it will take. */
static void show_run(run *r, const dem_stage *stage) {
    const double now = r->terminal ? find_seconds() : 0;
    if (!r->terminal || now - r->shown < 0.5)
        return;
    const uint64_t done = r->world.step - r->first_step;
    const double left = (now - r->began) * (double)(r->total_steps - r->world.step) / (double)(done > 0 ? done : 1);
    r->shown = now;
    fprintf(stderr, "\r\033[K%s: step %" PRIu64 " of %" PRIu64 ", %zu contacts, %.0f s to go", stage->name,
            r->world.step, r->total_steps, r->world.contact_count, left);
    fflush(stderr);
}

/* A signal came: the step is complete. */
static _Noreturn void stop(run *r) {
    const dem_output *o = &r->input.output;
    const int number = caught;
    if (r->terminal)
        fprintf(stderr, "\r\033[K");
    write_restart(r);
    fprintf(stderr, "dem: signal %d at step %" PRIu64 ": %s%s\n", number, r->world.step,
            o->restart[0] ? "go on with --restart " : "no restart, the input's output names none", o->restart);
    exit(128 + number);
}

static void run_stage(run *r, const dem_stage *stage) {
    const dem_output *o = &r->input.output;
    dem *d = &r->world;
    if (r->progress.stage_step == 0)
        dem_enter_stage(d, stage);
    while (r->progress.stage_step < stage->steps) {
        if (caught)
            stop(r);
        dem_step(d);
        r->progress.stage_step++;
        if (d->step % o->every == 0)
            write_frame(r);
        if (d->step % o->restart_every == 0)
            write_restart(r);
        show_run(r, stage);
    }
    r->progress.stage++;
    r->progress.stage_step = 0;
}

static void begin(run *r, const char *restart) {
    const dem_output *o = &r->input.output;
    r->progress.input = r->input.hash;
    if (restart)
        dem_read_restart(&r->world, &r->progress, restart);
    const uint64_t stage = r->progress.stage;
    if (restart && stage > r->input.stage_count)
        dem_quit("%s: it is at stage %" PRIu64 ", the input has %zu", restart, stage, r->input.stage_count);
    if (restart && stage < r->input.stage_count && r->progress.stage_step > r->input.stages[stage].steps)
        dem_quit("%s: it has done %" PRIu64 " steps of stage %" PRIu64 ", which has %" PRIu64 " in the input", restart,
                 r->progress.stage_step, stage, r->input.stages[stage].steps);
    if (o->csv[0])
        r->csv = dem_open_csv(&r->world, o->csv, &r->progress.csv_position);
    if (!restart)
        write_frame(r);
    r->first_step = r->total_steps = r->world.step;
    for (size_t i = (size_t)r->progress.stage; i < r->input.stage_count; i++)
        r->total_steps += r->input.stages[i].steps - (i == r->progress.stage ? r->progress.stage_step : 0);
    r->terminal = isatty(STDERR_FILENO);
    r->began = r->shown = find_seconds();
}

static void report(const run *r) {
    dem_measures m;
    dem_measure(&r->world, &r->input.output.region, &m);
    const double steps = (double)(r->world.step - r->first_step), seconds = find_seconds() - r->began;
    if (r->terminal)
        fprintf(stderr, "\r\033[K");
    if (r->total_steps == r->first_step)
        fprintf(stderr, "dem: nothing was left to run: all stages of the input were over\n");
    printf("steps %" PRIu64 ", time %g, renewals %" PRIu64 "\n", r->world.step, r->world.time, r->world.renewals);
    printf("grains %zu, walls %zu, contacts %zu, coordination %.3f\n", r->world.grain_count, r->world.wall_count,
           m.contacts, m.coordination);
    printf("kinetic %.6g, potential %.6g, elastic %.6g, damping %.6g, friction %.6g, walls %.6g\n", m.energy.kinetic,
           m.energy.potential, m.energy.elastic, m.energy.damping, m.energy.friction, m.energy.walls);
    printf("state %016" PRIx64 "\n", dem_hash(&r->world));
    if (fflush(stdout) != 0 || ferror(stdout))
        dem_quit("the report cannot be written");
    fprintf(stderr, "dem: %.1f s, %.1f microseconds a step\n", seconds, steps > 0 ? 1e6 * seconds / steps : 0);
}

static const char USAGE[] = "usage: dem INPUT.json [--restart FILE] [--threads N]\n\n"
                            "Runs the discrete element simulation that the input describes (apps/dem/README.md).\n"
                            "  --restart FILE   go on from a restart file\n"
                            "  --threads N      1 to 256; otherwise 1\n";

int main(int argc, char **argv) {
    static const struct option options[] = {{"help", no_argument, NULL, 'h'},
                                            {"restart", required_argument, NULL, 'r'},
                                            {"threads", required_argument, NULL, 't'},
                                            {NULL, 0, NULL, 0}};
    const char *restart = NULL;
    unsigned threads = 0;
    int read = 0;
    argv[0] = (char[]){"dem"}; /* with which getopt_long() begins its messages */
    for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        if (option == 'h')
            return fputs(USAGE, stdout) == EOF || fflush(stdout) != 0 ? 2 : 0;
        if (option == '?')
            return 2;
        if (option == 'r')
            restart = optarg;
        else if (sscanf(optarg, "%3u%n", &threads, &read) != 1 || optarg[read] || threads < 1 || threads > 256)
            dem_quit("--threads must be a whole number from 1 to 256, not '%.40s'", optarg);
    }
    if (optind == argc)
        dem_quit("INPUT is missing");
    if (optind + 1 < argc)
        dem_quit("'%s' is one input too many", argv[optind + 1]);
    run *r = calloc(1, sizeof *r);
    if (!r)
        dem_quit("not enough memory");
    dem_read_input(argv[optind], threads, &r->world, &r->input);
    const double shortest = dem_find_shortest_contact(&r->world), time_step = r->world.settings.time_step;
    if (time_step > shortest / 15)
        fprintf(stderr, "dem: %s: time step %g is more than a 15th of what the shortest contact lasts, %g\n",
                argv[optind], time_step, shortest);
    watch_signals(); /* before that a signal ends the program at once: a filling may take long */
    begin(r, restart);
    while (r->progress.stage < r->input.stage_count)
        run_stage(r, &r->input.stages[r->progress.stage]);
    write_restart(r);
    if (r->csv && fclose(r->csv) != 0)
        dem_quit("%s: it cannot be written", r->input.output.csv);
    report(r);
    dem_destroy(&r->world);
    dem_free_input(&r->input);
    free(r);
    return 0;
}
