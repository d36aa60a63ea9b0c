/* SPDX-License-Identifier: MIT
 *
 * step.c - a step of velocity Verlet: half of the velocity's change, the way, the forces at its end, the other half.
 *
 * The forces see the place at the step's end, and the velocity there as the forces at its beginning foretell it: `ahead`.
 * So springs and dashpots are of second order in the time step. (The tangential spring takes the tangent of the step's end:
 * where the contact turns that is of first order.) Forces before the first step are those of where grains begin.
 *
 * How bodies turn: dem_turn().
 */
#include <math.h>

#include "dem.h"

/* Has a point of the body moved by the limit since the images were made? A turn moves it by at most the body's reach
 * times the chord between both rotations. (p + q)^2 is at most 2 (p^2 + q^2), which needs no root: what is below the
 * limit so has not moved. A NaN has moved. */
static inline bool has_moved(const dem_body *b, double limit) {
    const vec way = minus(b->position, b->last_position), turn = minus(b->turn, b->last_turn);
    const double p = dot(way, way), q = b->reach * b->reach * dot(turn, turn);
    return !(2 * (p + q) <= limit * limit) && !(sqrt(p) + sqrt(q) <= limit);
}

static inline void kick(dem_body *b, double half, vec gravity) {
    const vec by = {half * (b->force.x * b->inverse_mass + gravity.x),
                    half * (b->force.y * b->inverse_mass + gravity.y)};
    const double turn = half * (b->torque * b->inverse_inertia);
    b->velocity = plus(b->velocity, by);
    b->spin += turn;
    b->ahead = plus(b->velocity, by);
    b->spin_ahead = b->spin + turn;
}

/* Drag changes velocities by this factor in a half step; what energy that takes is damping. */
static void drag_grains(dem *d, double factor) {
    for (dem_body *b = d->bodies; b < d->bodies + d->grain_count && d->settings.drag > 0; b++) {
        const double square = b->mass * dot(b->velocity, b->velocity) + b->inertia * b->spin * b->spin;
        d->account.damping += 0.5 * (1 - factor * factor) * square;
        b->velocity = times(factor, b->velocity);
        b->spin *= factor;
    }
}

/* Half of the change of grains' velocities, and the way, of walls too. Has anything moved by half of the skin, or of
 * what shear has left of it? */
static bool begin_step(dem *d) {
    const vec size = minus(dem_cell_size(d), d->last_size);
    const double deformed = d->drifts ? fabs(d->offset - d->last_offset) + fabs(size.x) + fabs(size.y) : 0;
    const double dt = d->settings.time_step, limit = 0.5 * (d->settings.skin - deformed);
    int moved = !(limit > 0);
    drag_grains(d, 1 - 0.5 * dt * d->settings.drag);
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1) reduction(| : moved)
    for (size_t k = 0; k < d->grain_count; k++) {
        dem_body *b = &d->bodies[k];
        kick(b, 0.5 * dt, d->settings.gravity);
        b->position = plus(b->position, times(dt, b->velocity));
        b->turn = dem_turn(b->turn, dem_find_turn(dt * b->spin));
        moved |= has_moved(b, limit);
    }
    dem_move_walls(d);
    for (size_t k = d->grain_count; k < d->body_count; k++)
        moved |= has_moved(&d->bodies[k], limit);
    return moved != 0;
}

static void end_step(dem *d) {
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1)
    for (size_t k = 0; k < d->grain_count; k++)
        kick(&d->bodies[k], 0.5 * d->settings.time_step, d->settings.gravity);
    drag_grains(d, 1 / (1 + 0.5 * d->settings.time_step * d->settings.drag));
}

/* With a time step of 0 no spring stretches and no work is done. */
void dem_find_first_forces(dem *d) {
    const double time_step = d->settings.time_step;
    d->settings.time_step = 0;
    dem_move_walls(d); /* walls get their velocities */
    for (dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++) {
        b->ahead = b->velocity;
        b->spin_ahead = b->spin;
    }
    dem_find_pairs(d, true);
    dem_apply_laws(d);
    d->settings.time_step = time_step;
}

void dem_step(dem *d) {
    d->step++;
    d->time += d->settings.time_step;
    dem_steer_walls(d);
    dem_deform_cell(d);
    const bool renews = begin_step(d);
    if (renews)
        dem_renew_images(d);
    dem_find_pairs(d, renews);
    dem_count_work(d);
    dem_apply_laws(d);
    dem_count_work(d);
    end_step(d);
}
