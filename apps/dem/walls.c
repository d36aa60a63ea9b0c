/* SPDX-License-Identifier: MIT
 *
 * walls.c - walls move as they are told, or so that the grains press against them with a given force.
 *
 * A plate is a half plane. Its body is a block whose upper side is the plate. A pair of a grain and the plate has a
 * shift along the plate that brings the block under the grain: so the plate has no ends, and narc sees two bodies of
 * similar size, whose separation is precise.
 */
#include <math.h>

#include "dem.h"

vec dem_wall_force(const dem *d, size_t wall) { return d->bodies[d->grain_count + wall].force; }

/* ------------------------------------------------------------------------------------------------ servo control */

/* How far two walls are from each other, along the normal of a plate, else between their centres. */
static double find_distance(const dem *d, int first, int second) {
    const dem_wall *a = &d->walls[first], *b = &d->walls[second];
    const dem_body *walls = d->bodies + d->grain_count;
    const vec between = minus(walls[second].place, walls[first].place);
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
        wall->velocity = times(speed, s->direction);
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
        b->velocity = wall->velocity;
        b->spin = wall->spin;
        if (wall->kind == DEM_PLATE) {
            b->place = plus(b->place, times(dt * dot(wall->velocity, wall->normal), wall->normal));
            continue;
        }
        const vec way = times(dt, wall->velocity), turn = dem_find_turn(dt * wall->spin);
        b->place = plus(b->place, way);
        wall->pivot = plus(wall->pivot, way);
        if (wall->spin == 0)
            continue;
        const vec arm = rotate(turn, minus(b->place, wall->pivot));
        b->turn = dem_turn(b->turn, turn);
        b->place = plus(wall->pivot, arm);
        b->velocity = (vec){b->velocity.x - wall->spin * arm.y, b->velocity.y + wall->spin * arm.x};
    }
}

/* Called before and after forces change. */
void dem_count_work(dem *d) {
    const double half = 0.5 * d->settings.time_step;
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_body *b = &d->bodies[d->grain_count + w];
        d->walls[w].work -= half * (dot(b->force, b->velocity) + b->torque * b->spin);
    }
    d->shear_work -= half * dem_find_drift(d) * d->pull;
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* Every grain that is closer to the plate than the skin. (A box pair would be found a little further.) One whose centre
 * is deeper than that of the block would be pushed out behind it. */
static void add_pairs_of_plate(dem *d, const dem_body *block, const dem_wall *plate) {
    const vec n = plate->normal;
    for (uint32_t part = 0; part < d->bodies[d->grain_count].first_part; part++) { /* those of grains */
        const dem_body *b = &d->bodies[d->parts[part].body];
        const vec way = minus(b->place, block->place);
        const double height = dot(way, n) - plate->half, along = cross(n, way);
        const dem_pair pair = {part, block->first_part, (float)(-n.y * along), (float)(n.x * along), 0};
        if (height < -plate->half)
            dem_fail(d, "step %llu: grain %zu is behind wall '%s'. %s", (unsigned long long)d->step,
                     (size_t)(b - d->bodies), plate->name, dem_explain_depth(d));
        if (height - b->reach <= d->settings.skin * 1.001)
            dem_add_extra_pair(d, pair);
    }
}

/* A plate of a periodic cell must run along the border, or it would end there. */
void dem_add_plate_pairs(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_wall *plate = &d->walls[w];
        const vec n = plate->normal;
        if (plate->kind != DEM_PLATE)
            continue;
        if ((d->settings.periodic_x && fabs(n.x) > 1e-12) || (d->settings.periodic_y && fabs(n.y) > 1e-12))
            dem_fail(d, "wall '%s': a plate with normal %g, %g crosses a periodic border", plate->name, n.x, n.y);
        add_pairs_of_plate(d, &d->bodies[d->grain_count + w], plate);
    }
}
