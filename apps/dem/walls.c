/* SPDX-License-Identifier: MIT
 *
 * walls.c - walls move as they are told, or so that the grains press against them with a given force.
 */
#include <math.h>

#include "dem.h"

/* Walls of a group count together. */
vec dem_wall_force(const dem *d, size_t wall) {
    const uint32_t group = d->walls[wall].group;
    vec sum = {0, 0};
    for (size_t w = group > 0 ? 0 : wall; w < (group > 0 ? d->wall_count : wall + 1); w++)
        if (d->walls[w].group == group)
            sum = plus(sum, d->bodies[d->grain_count + w].force);
    return sum;
}

/* ------------------------------------------------------------------------------------------------ servo control */

/* How far two walls are from each other, along the normal of a plate, else between their centres. */
static double find_distance(const dem *d, int first, int second) {
    const dem_wall *a = &d->walls[first], *b = &d->walls[second];
    const dem_body *walls = d->bodies + d->grain_count;
    const vec between = minus(walls[second].position, walls[first].position);
    if (a->kind != DEM_PLATE || b->kind != DEM_PLATE)
        return sqrt(dot(between, between));
    return fabs(dot(plus(between, times(a->half, minus(b->normal, a->normal))), a->normal));
}

/* A wall with nothing to press would go on without end. */
static void count_idle_way(dem *d, dem_wall *wall, double speed, bool touches) {
    const double travel = wall->servo.travel > 0 ? wall->servo.travel : d->diagonal;
    wall->idle_way = touches ? 0 : wall->idle_way + fabs(speed) * d->settings.time_step;
    if (wall->idle_way > travel)
        dem_fail(d,
                 "step %llu: wall '%s' has moved by more than %g without touching a grain: its servo has "
                 "nothing to press",
                 (unsigned long long)d->step, wall->name, travel);
}

void dem_steer_walls(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++) {
        dem_wall *wall = &d->walls[w];
        const dem_servo *s = &wall->servo;
        if (!s->on)
            continue;
        const vec force = dem_wall_force(d, w);
        const double target = s->between[0] >= 0
                                  ? s->stress * d->settings.thickness * find_distance(d, s->between[0], s->between[1])
                                  : s->force;
        const double missing = target + force.x * s->direction.x + force.y * s->direction.y;
        const double speed = fmin(fmax(s->gain * missing, -s->max_speed), s->max_speed);
        wall->speed = speed;
        count_idle_way(d, wall, speed, force.x != 0 || force.y != 0);
    }
}

/* ------------------------------------------------------------------------------------------------ motion */

/* A plate moves across itself only: along itself its place means nothing, and its velocity is seen by friction. */
void dem_move_walls(dem *d) {
    const double dt = d->settings.time_step;
    for (size_t w = 0; w < d->wall_count; w++) {
        dem_body *b = &d->bodies[d->grain_count + w];
        dem_wall *wall = &d->walls[w];
        const vec velocity = plus(wall->velocity, times(wall->speed, wall->servo.direction));
        b->velocity = b->ahead = velocity;
        b->spin = b->spin_ahead = wall->spin;
        if (wall->kind == DEM_PLATE) {
            b->position = plus(b->position, times(dt * dot(velocity, wall->normal), wall->normal));
            continue;
        }
        const vec way = times(dt, velocity), turn = dem_find_turn(dt * wall->spin);
        b->position = plus(b->position, way);
        wall->pivot = plus(wall->pivot, way);
        if (wall->spin == 0)
            continue;
        const vec arm = rotate(turn, minus(b->position, wall->pivot));
        b->turn = dem_turn(b->turn, turn);
        b->position = plus(wall->pivot, arm);
        b->velocity = b->ahead = (vec){velocity.x - wall->spin * arm.y, velocity.y + wall->spin * arm.x};
    }
}

/* Called before and after forces change. */
void dem_count_work(dem *d) {
    const double half = 0.5 * d->settings.time_step;
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_body *b = &d->bodies[d->grain_count + w];
        d->walls[w].work -= half * (dot(b->force, b->velocity) + b->torque * b->spin);
    }
    if (d->drifts)
        d->shear_work -= half * (dot(dem_find_drift(d, &(dem_image){.right = 1}), d->pull.right) +
                                 dot(dem_find_drift(d, &(dem_image){.up = 1}), d->pull.up));
}
