/* SPDX-License-Identifier: MIT
 *
 * speed.c - what a step costs, part by part, in settled piles of discs, eight-arcs and rounded octagons, beside a loop
 * written for discs (speed_discs.c).
 *
 * A pile of 625 grains settles in a cell that is periodic in x and is then set side by side: all piles are at rest, and
 * of any size. Candidates take turns; each number is a median. Lists are renewed once for each candidate and turn,
 * which is shared among as many steps as LIST_LIFE says.
 */
#include <getopt.h>
#include <math.h>
#include <stdlib.h>

#include "internal.h"
#include "json_path.h"
#include "place.h"
#include "speed.h"

enum { COLUMN = 625, WIDTH = 25, MAX_TURNS = 101, KINDS = 3, MAX_THREADS = 2 };

/* Steps that a list lasts, in the table. Piles at rest keep theirs; here it is assumed that what moves among them wants
 * a new one as often as this. */
static const double LIST_LIFE = 100;

static const char *const names[KINDS] = {"discs", "rounded octagons", "eight-arcs"};

/* ------------------------------------------------------------------------------------------------ piles */

static dem_settings pile_settings(double width) {
    dem_settings s = dem_defaults;
    s.gravity = (dem_vec){0, -10};
    s.time_step = 3e-4;
    s.skin = 0.15;
    s.max_overlap = 0.5;
    s.periodic_x = true;
    s.high_x = width;
    s.threads = 1;
    return s;
}

static void need(const dem *d, bool ok) {
    if (!ok)
        fail("%s", d->error);
}

/* A world with one shape, one material and a floor. */
static void make_world(dem *d, int kind, double width) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_point points[8];
    size_t count = 0;
    uint32_t shape;
    uint8_t material;
    need(d, dem_create(d, pile_settings(width)));
    for (int i = 0; i < 8; i++)
        points[i] = (narc_point){0.55 * cos(i * 0.78539816339744831), 0.5 * sin(i * 0.78539816339744831)};
    if (kind == 0)
        narc_build_circle(0.5, arcs, &count, NULL);
    else if (kind == 1)
        narc_build_regular_polygon(8, 0.52, 0.1, arcs, &count, NULL);
    else
        narc_build_ring(points, 8, arcs, &count, NULL);
    need(d, dem_add_shape(d, names[kind], arcs, count, &shape));
    need(d, dem_add_material(d, (dem_material){"stuff", 1, 0, 0}, &material));
    dem_set_law(d, material, material,
                (dem_contact_law){.kn = 4e4,
                                  .kt = 1e4,
                                  .damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.2),
                                  .tangential_share = 0.5,
                                  .friction = 0.5});
    need(d, dem_add_wall(
                d, (dem_wall){.name = "floor", .kind = DEM_PLATE, .normal = {0, 1}, .servo = {.between = {-1, -1}}}));
}

static void settle(dem *d, int kind) {
    uint64_t random = 1;
    make_world(d, kind, WIDTH);
    const dem_filling filling = {.count = COLUMN,
                                 .region = {true, 0, WIDTH, 0.2, 30},
                                 .shape_count = 1,
                                 .sizes = {DEM_UNIFORM, 0, 0, 0.8, 1.2},
                                 .spacing = {1, 1.15},
                                 .jitter = 0.05};
    need(d, dem_fill_lattice(d, &filling, &random));
    need(d, dem_start(d));
    for (int step = 0; step < 12000; step++)
        need(d, dem_step(d));
}

/* Copies of a pile side by side. */
static void spread(const dem *pile, dem *d, int kind, size_t copies) {
    const dem_bodies *b = &pile->bodies;
    make_world(d, kind, (double)copies * WIDTH);
    for (size_t c = 0; c < copies; c++)
        for (size_t k = 0; k < pile->grain_count; k++)
            need(d, dem_add_grain(d, (dem_grain){.x = b->x[k] + (double)c * WIDTH,
                                                 .y = b->y[k],
                                                 .angle = atan2(b->sine[k], b->cosine[k]),
                                                 .scale = (double)b->scale[k]}));
    need(d, dem_start(d));
    for (int step = 0; step < 200; step++) /* until springs carry again what they did */
        need(d, dem_step(d));
}

/* ------------------------------------------------------------------------------------------------ times */

typedef struct times {
    double lists[MAX_TURNS], narrow[MAX_TURNS], forces[MAX_TURNS], motion[MAX_TURNS], step[MAX_TURNS];
} times;

static int compare(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static double median(double *values, size_t count) {
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

/* Microseconds a step, over some steps. */
static void time_turn(dem *d, unsigned threads, size_t steps, times *t, size_t turn) {
    d->settings.threads = threads;
    const double before = dem_seconds();
    need(d, dem_renew_lists(d));
    t->lists[turn] = 1e6 * (dem_seconds() - before) / LIST_LIFE;
    d->clock = (dem_clock){.on = true};
    const uint64_t builds = d->list_builds;
    for (size_t i = 0; i < steps; i++)
        need(d, dem_step(d));
    if (d->list_builds != builds)
        fail("the pile is not at rest: lists are renewed");
    const double each = 1e6 / (double)steps;
    t->narrow[turn] = each * d->clock.narrow;
    t->forces[turn] = each * d->clock.forces;
    t->motion[turn] = each * d->clock.motion;
    t->step[turn] = t->lists[turn] + t->narrow[turn] + t->forces[turn] + t->motion[turn];
}

static void time_discs(const dem *d, unsigned threads, size_t steps, double lists, times *t, size_t turn) {
    discs *state = discs_copy(d);
    if (!state)
        fail("not enough memory for discs");
    const double before = dem_seconds();
    for (size_t i = 0; i < steps; i++)
        if (!discs_step(state, threads))
            fail("the pile is not at rest: lists are renewed");
    t->step[turn] = lists + 1e6 * (dem_seconds() - before) / (double)steps;
    discs_free(state);
}

/* Does the loop for discs do what the world does? Their ways part by rounding alone. */
static void check_discs(dem *d) {
    discs *state = discs_copy(d);
    dem_measures m;
    if (!state)
        fail("not enough memory for discs");
    for (int i = 0; i < 20; i++) {
        need(d, dem_step(d));
        discs_step(state, 1 + (unsigned)i % MAX_THREADS);
    }
    dem_measure(d, NULL, &m);
    const double kinetic = discs_kinetic(state);
    printf("kinetic energy after 20 steps: %.6g, of the loop for discs %.6g\n", m.energy.kinetic, kinetic);
    if (!(fabs(kinetic - m.energy.kinetic) <= 0.02 * m.energy.kinetic + 1e-9))
        fail("the loop for discs does something else");
    discs_free(state);
}

typedef struct request {
    size_t grains, steps, turns;
} request;

static void print_row(const char *name, unsigned threads, times *t, size_t turns, bool has_parts, double yardstick) {
    const double step = median(t->step, turns);
    if (has_parts)
        printf("%-18s %7u %10.1f %10.1f %10.1f %10.1f", name, threads, median(t->lists, turns),
               median(t->narrow, turns), median(t->forces, turns), median(t->motion, turns));
    else
        printf("%-18s %7u %10s %10s %10s %10s", name, threads, "", "", "", "");
    printf(" %10.1f %10.2f\n", step, step / yardstick);
}

static void print_table(times all[KINDS + 1][MAX_THREADS], const request *r) {
    double steps[KINDS + 1][MAX_THREADS];
    printf("%-18s %7s %10s %10s %10s %10s %10s %10s\n", "microseconds", "threads", "lists", "narrow", "forces",
           "motion", "a step", "by discs'");
    for (unsigned n = 0; n < MAX_THREADS; n++)
        for (int kind = KINDS; kind >= 0; kind--) {
            times *t = &all[kind][n];
            steps[kind][n] = median(t->step, r->turns);
            print_row(kind == KINDS ? "discs, by hand" : names[kind], n + 1, t, r->turns, kind < KINDS,
                      steps[KINDS][n]);
        }
    const double narrow = median(all[2][0].narrow, r->turns);
    printf("eight-arcs by discs by hand  %.2f (target: at most 1.5)\n", steps[2][0] / steps[KINDS][0]);
    printf("narrow phase of the step     %.2f (target: at most 0.5)\n", narrow / steps[2][0]);
    printf("two threads, eight-arcs      %.2f (target: at least 1.8)\n", steps[2][0] / steps[2][1]);
}

static void run(const request *r) {
    static times all[KINDS + 1][MAX_THREADS];
    dem piles[KINDS];
    for (int kind = 0; kind < KINDS; kind++) {
        dem pile;
        settle(&pile, kind);
        spread(&pile, &piles[kind], kind, (r->grains + COLUMN - 1) / COLUMN);
        dem_destroy(&pile);
    }
    for (int kind = 0; kind < KINDS; kind++)
        printf("%-18s %zu grains, %zu pairs, %zu contacts\n", names[kind], piles[kind].grain_count,
               piles[kind].pairs.count, piles[kind].contacts.count);
    check_discs(&piles[0]);
    for (size_t turn = 0; turn < r->turns; turn++)
        for (unsigned n = 0; n < MAX_THREADS; n++) {
            for (int kind = 0; kind < KINDS; kind++)
                time_turn(&piles[kind], n + 1, r->steps, &all[kind][n], turn);
            time_discs(&piles[0], n + 1, r->steps, all[0][n].lists[turn], &all[KINDS][n], turn);
        }
    print_table(all, r);
    for (int kind = 0; kind < KINDS; kind++)
        dem_destroy(&piles[kind]);
}

int main(int argc, char **argv) {
    static const struct option options[] = {{"grains", required_argument, NULL, 'g'},
                                            {"steps", required_argument, NULL, 's'},
                                            {"turns", required_argument, NULL, 't'},
                                            {NULL, 0, NULL, 0}};
    request r = {.grains = 5000, .steps = 50, .turns = 11};
    for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        if (option == 'g')
            r.grains = (size_t)read_whole("--grains", optarg, 1, 10000000);
        else if (option == 's')
            r.steps = (size_t)read_whole("--steps", optarg, 1, 1000000);
        else if (option == 't')
            r.turns = (size_t)read_whole("--turns", optarg, 1, MAX_TURNS);
        else {
            fprintf(stderr,
                    "usage: dem_speed [--grains N] [--steps N] [--turns N]\n\n"
                    "What a step costs in a settled pile of N grains (5000), in turns (11) of some steps (50).\n");
            return 2;
        }
    }
    run(&r);
    return 0;
}
