/* SPDX-License-Identifier: MIT
 *
 * boundary.c - periodic borders: bodies are wrapped into the cell when images are made, and only then. Shear.
 *
 * A sheared cell (Lees and Edwards 1972): the cell above moves to the right, by the rate of shear times the height. Who
 * is in it is `offset` further right than its image here, and faster by that speed; who crosses the border gets both.
 * So images across it move in each step. A cell whose sides move does the same in its own directions: nothing drives grains
 * but those across the border.
 */
#include <math.h>

#include "dem.h"

/* ------------------------------------------------------------------------------------------------ shear */

vec dem_find_drift(const dem *d, const dem_image *image) {
    const vec size = dem_cell_size(d);
    const dem_rates *r = &d->settings.rates;
    return (vec){image->right * r->x * size.x + image->up * r->shear * size.y, image->up * r->y * size.y};
}

/* Changes a grain's velocity, and counts the work. */
static void push_grain(dem *d, dem_body *b, vec by) {
    const double old = dot(b->velocity, b->velocity);
    b->velocity = plus(b->velocity, by);
    b->ahead = plus(b->ahead, by);
    d->shear_work += 0.5 * b->mass * (dot(b->velocity, b->velocity) - old);
}

void dem_set_rates(dem *d, dem_rates rates) {
    const dem_rates *old = &d->settings.rates;
    const vec middle = times(0.5, plus(d->settings.low, d->settings.high));
    const dem_rates by = {rates.shear - old->shear, rates.x - old->x, rates.y - old->y};
    for (dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++) {
        const vec way = minus(b->position, middle);
        push_grain(d, b, (vec){by.shear * way.y + by.x * way.x, by.y * way.y});
    }
    d->settings.rates = rates;
}

static void hold_stress(const dem_side *side, double stress, double *rate) {
    if (side->on)
        *rate = fmin(fmax(side->gain * (stress - side->stress), -side->max_rate), side->max_rate);
}

/* The middle of the cell stays where it is. */
void dem_deform_cell(dem *d) {
    const double dt = d->settings.time_step;
    dem_rates rates = d->settings.rates;
    hold_stress(&d->sides[0], d->stress.x, &rates.x);
    hold_stress(&d->sides[1], d->stress.y, &rates.y);
    if (d->sides[0].on || d->sides[1].on)
        dem_set_rates(d, rates);
    const vec size = dem_cell_size(d), half = {0.5 * dt * rates.x * size.x, 0.5 * dt * rates.y * size.y};
    if (d->settings.strained) {
        d->settings.low = minus(d->settings.low, half);
        d->settings.high = plus(d->settings.high, half);
    }
    d->offset += dt * rates.shear * size.y;
}

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
    d->last_size = size;
    for (size_t k = 0; k < d->body_count; k++) {
        dem_body *b = &d->bodies[k];
        dem_wall *wall = k < d->grain_count ? NULL : &d->walls[k - d->grain_count];
        const vec old = b->position;
        const int32_t before = b->cell_y;
        if (wall && wall->kind == DEM_PLATE)
            continue;
        if (s->periodic_y)
            b->position.y = wrap(b->position.y, s->low.y, size.y, &b->cell_y);
        if (d->drifts && b->cell_y != before) {
            b->position.x -= (b->cell_y - before) * d->offset;
            push_grain(d, b, times(before - b->cell_y, dem_find_drift(d, &(dem_image){.up = 1})));
        }
        const int32_t beside = b->cell_x;
        if (s->periodic_x)
            b->position.x = wrap(b->position.x, s->low.x, size.x, &b->cell_x);
        if (s->strained && b->cell_x != beside)
            push_grain(d, b, times(beside - b->cell_x, dem_find_drift(d, &(dem_image){.right = 1})));
        if (wall)
            wall->pivot = plus(wall->pivot, minus(b->position, old));
    }
}
