/* SPDX-License-Identifier: MIT
 *
 * boundary.c - periodic borders: bodies are wrapped into the cell when images are made, and only then. Shear.
 *
 * A sheared cell (Lees and Edwards 1972): the cell above moves to the right, by the rate of shear times the height. Who
 * is in it is `offset` further right than its image here, and faster by that speed; who crosses the border gets both.
 * So images across it move in each step.
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ shear */

double dem_find_drift(const dem *d) { return d->settings.shear * dem_cell_size(d).y; }

/* Changes a grain's velocity, and counts the work. */
static void push_grain(dem *d, dem_body *b, double by) {
    const double old = b->velocity.x;
    b->velocity.x += by;
    d->shear_work += 0.5 * b->mass * (b->velocity.x * b->velocity.x - old * old);
}

void dem_set_shear(dem *d, double rate) {
    const double middle = 0.5 * (d->settings.low.y + d->settings.high.y);
    for (dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++)
        push_grain(d, b, (rate - d->settings.shear) * (b->position.y - middle));
    d->settings.shear = rate;
}

void dem_shear_cell(dem *d) { d->offset += d->settings.time_step * dem_find_drift(d); }

/* ------------------------------------------------------------------------------------------------ wrapping */

/* Where a coordinate is in [low, low + width): by steps of whole widths. What is lost stays so. */
static double wrap(double value, double low, double width, int32_t *cell) {
    const double turns = floor((value - low) / width);
    if (!(fabs(turns) < 1e9))
        return INFINITY;
    *cell += (int32_t)turns;
    return value - turns * width;
}

void dem_wrap_bodies(dem *d) {
    const dem_settings *s = &d->settings;
    const vec size = dem_cell_size(d);
    if (!s->periodic_x && !s->periodic_y)
        return;
    if (s->sheared)
        d->offset -= size.x * nearbyint(d->offset / size.x);
    d->last_offset = d->offset;
    for (size_t k = 0; k < d->body_count; k++) {
        dem_body *b = &d->bodies[k];
        dem_wall *wall = k < d->grain_count ? NULL : &d->walls[k - d->grain_count];
        const vec old = b->position;
        const int32_t before = b->cell_y;
        if (wall && wall->kind == DEM_PLATE)
            continue;
        if (s->periodic_y)
            b->position.y = wrap(b->position.y, s->low.y, size.y, &b->cell_y);
        if (s->sheared && b->cell_y != before) {
            b->position.x -= (b->cell_y - before) * d->offset;
            push_grain(d, b, -(b->cell_y - before) * dem_find_drift(d));
        }
        if (s->periodic_x)
            b->position.x = wrap(b->position.x, s->low.x, size.x, &b->cell_x);
        if (wall)
            wall->pivot = plus(wall->pivot, minus(b->position, old));
    }
}
