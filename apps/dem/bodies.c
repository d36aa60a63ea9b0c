/* SPDX-License-Identifier: MIT
 *
 * bodies.c - grains and walls, as they are added and as narc sees them; what messages call them.
 */
#include <math.h>

#include "dem.h"

/* A body of mass 0, without speed. */
static dem_body *add_body(dem *d, uint32_t shape_index, uint32_t material, vec position, vec turn, double scale) {
    const dem_shape *shape = &d->shapes[shape_index];
    const dem_outline *outline = &d->outlines[shape->first_outline];
    const touch_side *side = outline->sides;
    const bool is_disc =
        shape->outline_count == 1 && !shape->is_chain && outline->side_count == 1 && side->x == 0 && side->y == 0;
    const double s = (double)(float)scale;
    dem_grow(&d->bodies, d->body_count + 1, sizeof *d->bodies);
    dem_grow(&d->parts, d->part_count + shape->outline_count, sizeof *d->parts);
    dem_body *b = &d->bodies[d->body_count];
    *b = (dem_body){.position = position,
                    .turn = turn,
                    .scale = (float)scale,
                    .reach = s * shape->reach,
                    .extent = s * shape->extent,
                    .disc = is_disc ? s * side->radius : 0,
                    .joins = shape->outline_count > 1,
                    .shape = shape_index,
                    .material = material,
                    .first_part = (uint32_t)d->part_count};
    for (uint32_t i = 0; i < shape->outline_count; i++)
        d->parts[d->part_count++] = (dem_part){(uint32_t)d->body_count, shape->first_outline + i};
    d->body_count++;
    return b;
}

void dem_add_grain(dem *d, dem_grain grain) {
    const vec turn = {cos(grain.angle), sin(grain.angle)};
    dem_body *b = add_body(d, grain.shape, grain.material, grain.position, turn, grain.scale);
    const dem_shape *shape = &d->shapes[grain.shape];
    const double s = (double)b->scale, pillar = d->materials[grain.material].density * d->settings.thickness;
    b->velocity = grain.velocity;
    b->spin = grain.spin;
    b->mass = pillar * shape->area * s * s;
    b->inertia = pillar * shape->second_moment * s * s * s * s;
    b->inverse_mass = 1 / b->mass;
    b->inverse_inertia = 1 / b->inertia;
    if (!(b->inverse_mass > 0 && isfinite(b->inverse_mass) && b->inverse_inertia > 0 && isfinite(b->inverse_inertia)))
        dem_fail(d, "grain %zu: mass %g is out of range", d->grain_count, b->mass);
    d->grain_count++;
    d->joins |= b->joins;
    d->grain_reach = fmax(d->grain_reach, b->reach);
    d->grain_extent = fmax(d->grain_extent, b->extent);
}

void dem_add_wall(dem *d, dem_wall wall) {
    const double length = hypot(wall.normal.x, wall.normal.y);
    if (wall.kind == DEM_BOX && !((float)wall.scale > 0 && isfinite((float)wall.scale)))
        dem_fail(d, "wall '%s': scale %g is out of range", wall.name, wall.scale);
    if (wall.kind == DEM_PLATE)
        wall.normal = (vec){wall.normal.x / length, wall.normal.y / length};
    dem_grow(&d->walls, d->wall_count + 1, sizeof *d->walls);
    d->walls[d->wall_count++] = wall;
}

/* A plate is the upper side of its block. Half of that side is four times the largest grain's reach and the skin, so
 * that it goes on further than any grain that may touch it, whatever both move before there is another image. */
void dem_add_walls(dem *d) {
    const double side_by_extent = 0.88622692545275801; /* of a square: sqrt(pi) / 2 */
    const double half = 4 * (d->grain_reach + d->settings.skin);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    uint32_t block = UINT32_MAX;
    for (dem_wall *w = d->walls; w < d->walls + d->wall_count; w++) {
        vec position = w->position, turn = {cos(w->angle), sin(w->angle)};
        if (w->kind == DEM_PLATE) {
            if (block == UINT32_MAX) {
                dem_demand(d, narc_build_box(2 * half, 2 * half, 0, arcs, &count, &error), "a plate", &error);
                block = dem_add_shape(d, "plate", arcs, count);
            }
            w->shape = block;
            w->scale = 1;
            w->half = 0.5 * d->shapes[block].extent * side_by_extent;
            position = minus(position, times(half, w->normal));
            turn = (vec){w->normal.y, -w->normal.x};
        }
        add_body(d, w->shape, w->material, position, turn, w->scale);
        d->joins |= d->wall_count > 1;
        d->bodies[d->body_count - 1].joins |= d->wall_count > 1;
    }
}

/* ------------------------------------------------------------------------------------------------ all of them */

vec dem_find_shift(const dem *d, const dem_image *of, bool last) {
    const vec size = last ? d->last_size : dem_cell_size(d);
    return (vec){of->right * size.x + of->up * (last ? d->last_offset : d->offset), of->up * size.y};
}

narc_bodies dem_make_poses(dem *d, bool last) {
    dem_grow(&d->poses, d->image_count, sizeof *d->poses);
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1)
    for (size_t i = 0; i < d->image_count; i++) {
        dem_image *image = &d->images[i];
        const dem_part *part = &d->parts[image->part];
        const dem_body *b = &d->bodies[part->body];
        if (d->drifts)
            image->shift = dem_find_shift(d, image, last);
        const dem_outline *outline = &d->outlines[part->outline];
        const vec turn = last ? b->last_turn : b->turn, arm = rotate(turn, outline->at);
        const vec at = plus(plus(last ? b->last_position : b->position, arm), image->shift);
        d->poses[i] = (narc_body){at.x, at.y, (float)turn.x, (float)turn.y, b->scale, outline->stored};
    }
    narc_bodies bodies;
    narc_view_bodies(d->poses, d->image_count, &bodies);
    return bodies;
}

dem_region dem_bound(const dem *d, bool with_walls) {
    dem_region r = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (size_t k = 0; k < d->grain_count + (with_walls ? d->wall_count : 0); k++) {
        const bool grain = k < d->grain_count;
        const vec p = grain ? d->bodies[k].position : d->walls[k - d->grain_count].position;
        const double reach = grain ? d->bodies[k].reach : 0;
        r.low = (vec){fmin(r.low.x, p.x - reach), fmin(r.low.y, p.y - reach)};
        r.high = (vec){fmax(r.high.x, p.x + reach), fmax(r.high.y, p.y + reach)};
    }
    return r;
}

const char *dem_name_kind(const dem *d, size_t body) { return body < d->grain_count ? "grain" : "wall"; }
size_t dem_number(const dem *d, size_t body) { return body < d->grain_count ? body : body - d->grain_count; }

/* Threads wait for each other several times a step: unless they are asked for there is one. */
unsigned dem_team(const dem *d) { return d->settings.threads > 0 ? d->settings.threads : 1; }

vec dem_cell_size(const dem *d) { return minus(d->settings.high, d->settings.low); }

/* ------------------------------------------------------------------------------------------------ messages */

void dem_fail_lost(dem *d) {
    const narc_bodies bodies = dem_make_poses(d, false);
    narc_error error = {.message = "its position is out of range"};
    size_t k = 0;
    if (narc_validate_bodies(d->store, &bodies, &error) != NARC_OK)
        k = d->parts[d->images[error.index].part].body;
    else
        while (k + 1 < d->body_count &&
               fabs(d->bodies[k].position.x) + fabs(d->bodies[k].position.y) < NARC_MAX_DISTANCE)
            k++;
    dem_fail(d, "step %llu: %s %zu is lost (%s): forces became too large. Use a shorter time step",
             (unsigned long long)d->step, dem_name_kind(d, k), dem_number(d, k), error.message);
}

const char *dem_explain_depth(const dem *d) {
    return d->step == 0 ? "They are placed so: the run has not begun" : "Use a shorter time step, or stiffer contacts";
}
