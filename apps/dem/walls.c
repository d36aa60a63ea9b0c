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

dem_vec dem_wall_force(const dem *d, size_t wall) {
    const size_t k = d->grain_count + wall;
    return (dem_vec){d->bodies.fx[k], d->bodies.fy[k]};
}

/* The extent is the diameter of the disc of equal area: of a square the side times 2 / sqrt(pi). */
double dem_half_block(const dem *d, const dem_wall *plate) {
    const double side_by_extent = 0.88622692545275801; /* sqrt(pi) / 2 */
    return 0.5 * d->shapes[plate->shape].extent * side_by_extent;
}

/* ------------------------------------------------------------------------------------------------ servo control */

/* How far two walls are from each other, along the normal of a plate, else between their centres. */
static double find_distance(const dem *d, int first, int second) {
    const size_t i = d->grain_count + (size_t)first, j = d->grain_count + (size_t)second;
    const dem_wall *a = &d->walls[first], *b = &d->walls[second];
    dem_vec between = {d->bodies.x[j] - d->bodies.x[i], d->bodies.y[j] - d->bodies.y[i]};
    if (a->kind != DEM_PLATE || b->kind != DEM_PLATE)
        return sqrt(between.x * between.x + between.y * between.y);
    const double half = dem_half_block(d, a);
    between.x += half * (b->normal.x - a->normal.x);
    between.y += half * (b->normal.y - a->normal.y);
    return fabs(between.x * a->normal.x + between.y * a->normal.y);
}

/* A wall with nothing to press would go on without end. */
static bool count_idle_way(dem *d, dem_wall *wall, double speed, bool touches) {
    const double travel = wall->servo.travel > 0 ? wall->servo.travel : d->diagonal;
    wall->idle_way = touches ? 0 : wall->idle_way + fabs(speed) * d->settings.time_step;
    if (wall->idle_way <= travel)
        return true;
    return dem_fail(d,
                    "step %llu: wall '%s' has moved by more than %g without touching a grain: its servo has "
                    "nothing to press",
                    (unsigned long long)d->step, wall->name, travel);
}

bool dem_steer_walls(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++) {
        dem_wall *wall = &d->walls[w];
        const dem_servo *servo = &wall->servo;
        if (!servo->on)
            continue;
        const dem_vec force = dem_wall_force(d, w);
        const double target = servo->between[0] >= 0 ? servo->stress * d->settings.thickness *
                                                           find_distance(d, servo->between[0], servo->between[1])
                                                     : servo->force;
        const double missing = target + force.x * servo->direction.x + force.y * servo->direction.y;
        const double speed = fmin(fmax(servo->gain * missing, -servo->max_speed), servo->max_speed);
        wall->velocity = (dem_vec){speed * servo->direction.x, speed * servo->direction.y};
        if (!count_idle_way(d, wall, speed, force.x != 0 || force.y != 0))
            return false;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------ motion */

/* A plate moves across itself only: along itself its place means nothing, and its velocity is seen by friction. */
void dem_move_walls(dem *d) {
    const dem_bodies *b = &d->bodies;
    const double dt = d->settings.time_step;
    for (size_t w = 0; w < d->wall_count; w++) {
        const size_t k = d->grain_count + w;
        dem_wall *wall = &d->walls[w];
        const dem_vec v = wall->velocity, n = wall->normal;
        const double across = dt * (v.x * n.x + v.y * n.y);
        const dem_vec way =
            wall->kind == DEM_PLATE ? (dem_vec){across * n.x, across * n.y} : (dem_vec){dt * v.x, dt * v.y};
        b->x[k] += way.x;
        b->y[k] += way.y;
        b->vx[k] = v.x;
        b->vy[k] = v.y;
        b->spin[k] = wall->spin;
        if (wall->kind == DEM_PLATE)
            continue;
        wall->pivot = (dem_vec){wall->pivot.x + way.x, wall->pivot.y + way.y};
        if (wall->spin == 0)
            continue;
        const dem_vec turn = dem_find_turn(dt * wall->spin);
        const dem_vec arm = {b->x[k] - wall->pivot.x, b->y[k] - wall->pivot.y};
        const dem_vec now = {turn.x * arm.x - turn.y * arm.y, turn.y * arm.x + turn.x * arm.y};
        dem_turn(&b->cosine[k], &b->sine[k], turn);
        b->x[k] = wall->pivot.x + now.x;
        b->y[k] = wall->pivot.y + now.y;
        b->vx[k] -= wall->spin * now.y;
        b->vy[k] += wall->spin * now.x;
    }
}

/* Half of a step's work, with the forces as they are now: called before and after they change. */
void dem_count_wall_work(dem *d) {
    const dem_bodies *b = &d->bodies;
    for (size_t w = 0; w < d->wall_count; w++) {
        const size_t k = d->grain_count + w;
        d->walls[w].work -=
            0.5 * d->settings.time_step * (b->fx[k] * b->vx[k] + b->fy[k] * b->vy[k] + b->torque[k] * b->spin[k]);
    }
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* Every grain that is closer to the plate than the skin. (A box pair would be found a little further.) */
static bool add_pairs_of_plate(dem *d, uint32_t body, const dem_wall *plate) {
    dem_scratch *s = d->scratch;
    const dem_bodies *b = &d->bodies;
    const double half = dem_half_block(d, plate);
    for (uint32_t part = 0; part < b->first_part[d->grain_count]; part++) { /* those of grains */
        const size_t k = d->parts.body[part];
        const double x = b->x[k] - b->x[body], y = b->y[k] - b->y[body];
        const double height = x * plate->normal.x + y * plate->normal.y - half;
        if (height - b->reach[k] > d->settings.skin * 1.001)
            continue;
        if (!dem_reserve(d, &s->extra, &s->extra_capacity, s->extra_count + 1, sizeof *s->extra))
            return false;
        const double along = plate->normal.x * y - plate->normal.y * x; /* the tangent is (-ny, nx) */
        s->extra[s->extra_count++] =
            (dem_extra){part, b->first_part[body], (float)(-plate->normal.y * along), (float)(plate->normal.x * along)};
    }
    return true;
}

/* A plate of a periodic cell must run along the border, or it would end there. */
static bool check_plate(dem *d, const dem_wall *plate) {
    const double x = fabs(plate->normal.x), y = fabs(plate->normal.y);
    if ((d->settings.periodic_x && x > 1e-12) || (d->settings.periodic_y && y > 1e-12))
        return dem_fail(d, "wall '%s': a plate with normal %g, %g crosses a periodic border", plate->name,
                        plate->normal.x, plate->normal.y);
    return true;
}

bool dem_add_plate_pairs(dem *d) {
    for (size_t w = 0; w < d->wall_count; w++)
        if (d->walls[w].kind == DEM_PLATE &&
            (!check_plate(d, &d->walls[w]) || !add_pairs_of_plate(d, (uint32_t)(d->grain_count + w), &d->walls[w])))
            return false;
    return true;
}
