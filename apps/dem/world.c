/* SPDX-License-Identifier: MIT
 *
 * world.c - a world from its beginning to its end: made, started, freed.
 */
#include <math.h>
#include <string.h>

#include "dem.h"

const dem_settings dem_defaults = {
    .time_step = 1e-5, .skin = 0.1, .thickness = 1, .gravity = {0, -9.81}, .max_overlap = 0.05};

void dem_create(dem *d, dem_settings settings) {
    memset(d, 0, sizeof *d);
    d->settings = settings;
    const narc_contacts_settings kept = {.rows = NARC_CONTACT_ROWS, .user_size = sizeof(dem_memory)};
    if (narc_create_shapes(NULL, &d->store) != NARC_OK || narc_create_contacts(&kept, &d->near, NULL) != NARC_OK ||
        narc_create_broad_phase(NULL, &d->broad) != NARC_OK)
        dem_quit("not enough memory");
}

void dem_destroy(dem *d) {
    void *const arrays[] = {d->outlines, d->shapes, d->bodies, d->parts, d->walls,  d->images, d->pairs,
                            d->contacts, d->poses,  d->blocks, d->boxes, d->near_a, d->near_b};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++)
        dem_release(arrays[i]);
    narc_destroy_shapes(d->store);
    narc_destroy_contacts(d->near);
    narc_destroy_broad_phase(d->broad);
    memset(d, 0, sizeof *d);
}

/* ------------------------------------------------------------------------------------------------ the start */

/* A periodic cell's width is rounded to a float: the shift of an image is one. */
static double round_width(dem *d, const char *axis, double width) {
    if (!((float)width > 0) || !isfinite((float)width))
        dem_fail(d, "the periodic cell's width in %s is %g", axis, width);
    return (double)(float)width;
}

/* narc's tasks in the team of all other loops. */
static void run_in_team(void *context, unsigned task_count, void (*task)(void *argument, unsigned index),
                        void *argument) {
    (void)context;
#pragma omp parallel for schedule(static, 1) num_threads((int)task_count)
    for (unsigned index = 0; index < task_count; index++)
        task(argument, index);
}

void dem_start(dem *d) {
    dem_settings *s = &d->settings;
    const double shortest = dem_find_shortest_contact(d);
    const dem_rates rates = s->rates;
    if (s->time_step > shortest / 5)
        dem_fail(d,
                 "time step %g is more than a fifth of what the shortest contact lasts, %g. Take a 15th, or less stiff "
                 "contacts",
                 s->time_step, shortest);
    d->drifts = s->sheared || s->strained;
    if (d->drifts && (!s->periodic_x || !s->periodic_y || d->wall_count > 0 || s->gravity.x != 0 || s->gravity.y != 0))
        dem_fail(d, "a cell that is sheared or strained is periodic in x and y, and has neither walls nor gravity");
    if (!(s->time_step * s->drag < 1))
        dem_fail(d, "drag %g is more than one by the time step", s->drag);
    for (size_t i = 0; i < d->material_count * d->material_count; i++)
        d->range = fmax(d->range, d->laws[i / d->material_count][i % d->material_count].range);
    if (s->periodic_x)
        s->high.x = s->low.x + round_width(d, "x", s->high.x - s->low.x);
    if (s->periodic_y)
        s->high.y = s->low.y + round_width(d, "y", s->high.y - s->low.y);
    dem_add_walls(d);
    d->workers = (narc_workers){.count = dem_team(d), .run = run_in_team};
    s->rates = (dem_rates){0, 0, 0};
    dem_set_rates(d, rates);
    d->shear_work = 0; /* grains begin so */
    const dem_region all = dem_bound(d, true);
    d->diagonal = hypot(all.high.x - all.low.x, all.high.y - all.low.y);
    d->margin = 4 * NARC_ERROR_BOUND * d->grain_reach +
                (d->wall_count > 0 ? 2e-7 * d->diagonal : 0) /* along plates */ + d->range;
    dem_renew_images(d);
    dem_find_first_forces(d);
}
