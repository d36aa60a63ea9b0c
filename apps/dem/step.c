/* SPDX-License-Identifier: MIT
 *
 * step.c - a step of velocity Verlet: half of the velocity's change, the way, the forces at its end, the other half.
 *
 * The forces see the velocity in the middle of the step, and the place at its end. So springs are of second order in
 * the time step, dashpots of first. (So is the tangential spring where the contact turns: it takes the tangent of the
 * step's end.) Forces before the first step are those of where grains begin.
 *
 * How bodies turn: dem_turn().
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ motion */

static void kick(dem *d) {
    const dem_bodies b = d->bodies;
    const double half = 0.5 * d->settings.time_step, gx = d->settings.gravity.x, gy = d->settings.gravity.y;
    const size_t count = d->grain_count;
#pragma omp parallel for simd schedule(static) num_threads(dem_team(d)) if (parallel : dem_team(d) > 1)
    for (size_t k = 0; k < count; k++) {
        b.vx[k] += half * (b.fx[k] * b.inverse_mass[k] + gx);
        b.vy[k] += half * (b.fy[k] * b.inverse_mass[k] + gy);
        b.spin[k] += half * (b.torque[k] * b.inverse_inertia[k]);
    }
}

static void drift(dem *d) {
    const dem_bodies b = d->bodies;
    const double dt = d->settings.time_step;
    const size_t count = d->grain_count;
#pragma omp parallel for simd schedule(static) num_threads(dem_team(d)) if (parallel : dem_team(d) > 1)
    for (size_t k = 0; k < count; k++) {
        b.x[k] += dt * b.vx[k];
        b.y[k] += dt * b.vy[k];
        dem_turn(&b.cosine[k], &b.sine[k], dem_find_turn(dt * b.spin[k]));
    }
}

/* Has a point of any body moved half of the skin since the pairs were found, or of what shear has left of it? A turn
 * moves it by at most the body's reach times the chord between both rotations. (p + q)^2 is at most 2 (p^2 + q^2),
 * which needs no root: what is below the limit so has not moved, and only if all is not, roots are drawn. A NaN has
 * moved. */
static bool have_moved(const dem *d, bool exactly) {
    const dem_bodies b = d->bodies;
    const double limit = 0.5 * (d->settings.skin - fabs(d->offset - d->list_offset));
    const size_t count = b.count;
    int moved = !(limit > 0);
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1) reduction(| : moved)
    for (size_t k = 0; k < count; k++) {
        const double x = b.x[k] - b.list_x[k], y = b.y[k] - b.list_y[k];
        const double c = b.cosine[k] - b.list_cosine[k], s = b.sine[k] - b.list_sine[k];
        const double way = x * x + y * y, turn = b.reach[k] * b.reach[k] * (c * c + s * s);
        moved |= exactly ? !(sqrt(way) + sqrt(turn) <= limit) : !(2 * (way + turn) <= limit * limit);
    }
    return moved != 0;
}

/* ------------------------------------------------------------------------------------------------ contacts */

bool dem_make_room_for_contacts(dem *d) {
    dem_contacts *c = &d->contacts;
    const size_t count = d->pairs.capacity;
    if (count <= c->capacity)
        return true;
    if (!dem_resize(d, &c->rows, count, sizeof *c->rows) || !dem_resize(d, &c->found, count, sizeof *c->found))
        return false;
    c->capacity = count;
    return true;
}

static bool find_contacts(dem *d) {
    const dem_pairs *p = &d->pairs;
    dem_contacts *c = &d->contacts;
    narc_bodies bodies;
    narc_pairs pairs = {.count = p->count, .a = NARC_ARRAY(p->a), .b = NARC_ARRAY(p->b)};
    if (d->scratch->extra_count > 0) {
        pairs.shift_x = NARC_ARRAY(p->shift_x);
        pairs.shift_y = NARC_ARRAY(p->shift_y);
    }
    const narc_workers workers = dem_workers(d);
    size_t skipped = 0;
    /* touch.h decides; shifts of a sheared cell are rounded. */
    const double rounding = d->settings.sheared ? 2e-7 * dem_cell_width(d) : 0;
    const narc_query query = {.margin = (float)(4 * NARC_ERROR_BOUND * d->grain_reach + rounding),
                              .hints = NARC_HINT_ARRAY(p->hints),
                              .workers = &workers,
                              .out_skipped = &skipped};
    narc_error error;
    if (!dem_make_room_for_contacts(d) || !dem_make_poses(d, &bodies))
        return false;
    if (narc_find_contacts(d->store, &bodies, &pairs, &query, c->found, c->capacity, &c->found_count, &error) !=
        NARC_OK)
        return dem_fail_narc(d, "contacts", &error);
    return skipped == 0 || dem_find_broken_body(d);
}

/* ------------------------------------------------------------------------------------------------ the step */

/* With a time step of 0 no spring stretches and no work is done. */
bool dem_find_first_forces(dem *d) {
    const double time_step = d->settings.time_step;
    d->settings.time_step = 0;
    dem_move_walls(d); /* walls get their velocities */
    const bool found = find_contacts(d) && dem_apply_laws(d);
    d->settings.time_step = time_step;
    return found;
}

bool dem_step(dem *d) {
    d->step++;
    d->time += d->settings.time_step;
    if (!dem_steer_walls(d))
        return false;
    kick(d);
    drift(d);
    dem_move_walls(d);
    dem_shear_cell(d);
    if (have_moved(d, false) && have_moved(d, true) && !dem_renew_lists(d))
        return false;
    if (!find_contacts(d))
        return false;
    dem_count_wall_work(d);
    dem_count_shear_work(d);
    if (!dem_apply_laws(d))
        return false;
    dem_count_wall_work(d);
    dem_count_shear_work(d);
    kick(d);
    return true;
}
