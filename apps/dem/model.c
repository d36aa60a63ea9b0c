/* SPDX-License-Identifier: MIT
 *
 * model.c - the world's memory, its shapes, materials and bodies.
 */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "dem.h"

const dem_settings dem_defaults = {
    .time_step = 1e-5, .skin = 0.1, .thickness = 1, .gravity = {0, -9.81}, .max_overlap = 0.05};

/* _Exit() drops what is still buffered: nothing more gets written. */
void dem_quit(const char *format, ...) {
    char line[2048] = "dem: ";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + 5, sizeof line - 5, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    fprintf(stderr, "%s\n", line);
    _Exit(2);
}

void dem_fail(dem *d, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(d->error, sizeof d->error, format, arguments);
    va_end(arguments);
    if (d->on_error)
        d->on_error(d);
    dem_quit("%s%s", d->place, d->error);
}

void dem_demand(dem *d, narc_status status, const char *what, const narc_error *error) {
    if (status != NARC_OK)
        dem_fail(d, "%s: %s", what, error->message);
}

/* ------------------------------------------------------------------------------------------------ memory */

/* In front of an array: how many items it has room for. Items are aligned as malloc() aligns. */
typedef union head {
    size_t capacity;
    max_align_t alignment;
} head;

void dem_grow(void *array_pointer, size_t needed, size_t size) {
    char *array;
    memcpy(&array, array_pointer, sizeof array);
    head *old = array ? (head *)(void *)array - 1 : NULL;
    if (old && needed <= old->capacity)
        return;
    const size_t capacity = needed + needed / 2 + 16;
    head *larger = capacity <= SIZE_MAX / size - sizeof(head) ? realloc(old, sizeof(head) + capacity * size) : NULL;
    if (!larger)
        dem_quit("not enough memory for %zu items of %zu bytes", capacity, size);
    larger->capacity = capacity;
    larger++;
    memcpy(array_pointer, &larger, sizeof larger);
}

void dem_release(void *array) { free(array ? (head *)array - 1 : NULL); }

void dem_create(dem *d, dem_settings settings) {
    memset(d, 0, sizeof *d);
    d->settings = settings;
    if (narc_create_shapes(NULL, &d->store) != NARC_OK || narc_create_broad_phase(NULL, &d->broad) != NARC_OK)
        dem_quit("not enough memory");
    dem_grow(&d->list.pairs, 0, sizeof *d->list.pairs); /* columns are of an array, which may be empty */
}

void dem_destroy(dem *d) {
    void *const arrays[] = {d->outlines,
                            d->shapes,
                            d->bodies,
                            d->parts,
                            d->walls,
                            d->contacts,
                            d->list.pairs,
                            d->list.memory,
                            d->other_list.pairs,
                            d->other_list.memory,
                            d->poses,
                            d->found,
                            d->blocks,
                            d->boxes,
                            d->images,
                            d->extra,
                            d->match};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++)
        dem_release(arrays[i]);
    narc_destroy_shapes(d->store);
    narc_destroy_broad_phase(d->broad);
    memset(d, 0, sizeof *d);
}

/* ------------------------------------------------------------------------------------------------ shapes */

/* At the point that is furthest from the origin the normal points away from the origin, so the arc's centre is on the
 * same line: the point is the support in that direction, or in the opposite one if the arc is flatter. */
static double find_reach(const narc_arc *arcs, size_t count) {
    double reach = 0;
    for (size_t i = 0; i < 2 * count; i++) {
        const narc_arc *arc = &arcs[i / 2];
        const double sign = i % 2 ? -1 : 1;
        const bool central = arc->center_x == 0 && arc->center_y == 0;
        narc_point p = {0, 0};
        narc_find_support(arcs, count, central ? 1 : sign * arc->center_x, sign * arc->center_y, &p, NULL);
        reach = fmax(reach, hypot(p.x, p.y));
    }
    return reach;
}

/* Moves an outline by -centroid, and adds it to the store: one index for each, also of equal ones. */
static void add_outline(dem *d, const char *name, const narc_arc *arcs, size_t count, const narc_mass *mass,
                        double *reach) {
    narc_arc moved[NARC_MAX_ARCS];
    narc_error error;
    const size_t k = d->outline_count;
    dem_grow(&d->outlines, k + 1, sizeof *d->outlines);
    dem_demand(d, narc_move_arcs(arcs, count, -mass->centroid_x, -mass->centroid_y, 0, 1, moved, &error), name, &error);
    dem_demand(d, narc_add_shape_at(d->store, (uint32_t)k, moved, count, &error), name, &error);
    d->outlines[k].side_count = count;
    make_touch_sides(moved, count, d->outlines[k].sides);
    d->outline_count++;
    *reach = fmax(*reach, find_reach(moved, count));
}

uint32_t dem_add_compound(dem *d, const char *name, const narc_arc *arcs, const size_t *counts, size_t part_count) {
    narc_error error;
    narc_mass mass;
    dem_shape shape = {.first_outline = (uint32_t)d->outline_count, .outline_count = (uint32_t)part_count};
    dem_demand(d, narc_compute_union_mass(arcs, counts, part_count, NULL, &mass, &error), name, &error);
    if (!(mass.area > 0))
        dem_fail(d, "%s: the shape encloses no area", name);
    if (part_count == 1) /* simpler sums, of fewer roundings */
        narc_compute_mass(arcs, counts[0], &mass);
    for (size_t part = 0; part < part_count; arcs += counts[part++])
        add_outline(d, name, arcs, counts[part], &mass, &shape.reach);
    shape.area = mass.area;
    shape.second_moment = mass.second_moment;
    shape.extent = 2 * sqrt(mass.area / DEM_PI);
    snprintf(shape.name, sizeof shape.name, "%s", name);
    dem_grow(&d->shapes, d->shape_count + 1, sizeof *d->shapes);
    d->shapes[d->shape_count] = shape;
    return (uint32_t)d->shape_count++;
}

uint32_t dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count) {
    return dem_add_compound(d, name, arcs, &count, 1);
}

/* ------------------------------------------------------------------------------------------------ bodies */

/* A body of mass 0, without speed. */
static dem_body *add_body(dem *d, uint32_t shape_index, uint32_t material, vec place, vec turn, double scale) {
    const dem_shape *shape = &d->shapes[shape_index];
    const dem_outline *outline = &d->outlines[shape->first_outline];
    const touch_side *side = outline->sides;
    const bool is_disc = shape->outline_count == 1 && outline->side_count == 1 && side->x == 0 && side->y == 0;
    const double s = (double)(float)scale;
    dem_grow(&d->bodies, d->body_count + 1, sizeof *d->bodies);
    dem_grow(&d->parts, d->part_count + shape->outline_count, sizeof *d->parts);
    dem_body *b = &d->bodies[d->body_count];
    *b = (dem_body){.place = place,
                    .turn = turn,
                    .scale = (float)scale,
                    .reach = s * shape->reach,
                    .extent = s * shape->extent,
                    .disc = is_disc ? s * side->radius : 0,
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
    dem_body *b = add_body(d, grain.shape, grain.material, grain.place, turn, grain.scale);
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
 * that it goes on further than any grain that may touch it, whatever both move before the next list. */
static void add_walls(dem *d) {
    const double side_by_extent = 0.88622692545275801; /* of a square: sqrt(pi) / 2 */
    const double half = 4 * (d->grain_reach + d->settings.skin);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    uint32_t block = UINT32_MAX;
    for (dem_wall *w = d->walls; w < d->walls + d->wall_count; w++) {
        vec place = w->place, turn = {cos(w->angle), sin(w->angle)};
        if (w->kind == DEM_PLATE) {
            if (block == UINT32_MAX) {
                dem_demand(d, narc_build_box(2 * half, 2 * half, 0, arcs, &count, &error), "a plate", &error);
                block = dem_add_shape(d, "plate", arcs, count);
            }
            w->shape = block;
            w->scale = 1;
            w->half = 0.5 * d->shapes[block].extent * side_by_extent;
            place = minus(place, times(half, w->normal));
            turn = (vec){w->normal.y, -w->normal.x};
        }
        add_body(d, w->shape, w->material, place, turn, w->scale);
    }
}

static void enlarge(dem_region *r, vec p, double by) {
    r->low = (vec){fmin(r->low.x, p.x - by), fmin(r->low.y, p.y - by)};
    r->high = (vec){fmax(r->high.x, p.x + by), fmax(r->high.y, p.y + by)};
}

dem_region dem_bound_grains(const dem *d) {
    dem_region r = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (size_t k = 0; k < d->grain_count; k++)
        enlarge(&r, d->bodies[k].place, d->bodies[k].reach);
    return r;
}

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
    const double shortest = dem_find_shortest_contact(d), rate = s->shear;
    if (s->time_step > shortest / 5)
        dem_fail(d,
                 "time step %g is more than a fifth of what the shortest contact lasts, %g. Take a 15th, or less stiff "
                 "contacts",
                 s->time_step, shortest);
    if (s->sheared && (!s->periodic_x || !s->periodic_y || d->wall_count > 0 || s->gravity.x != 0 || s->gravity.y != 0))
        dem_fail(d, "a sheared cell is periodic in x and y, and has neither walls nor gravity");
    if (s->periodic_x)
        s->high.x = s->low.x + round_width(d, "x", s->high.x - s->low.x);
    if (s->periodic_y)
        s->high.y = s->low.y + round_width(d, "y", s->high.y - s->low.y);
    add_walls(d);
    d->workers = (narc_workers){.count = dem_team(d), .run = run_in_team};
    s->shear = 0;
    dem_set_shear(d, rate);
    d->shear_work = 0; /* grains begin so */
    dem_region all = dem_bound_grains(d);
    for (size_t w = 0; w < d->wall_count; w++)
        enlarge(&all, d->walls[w].place, 0);
    d->diagonal = hypot(all.high.x - all.low.x, all.high.y - all.low.y);
    dem_renew_lists(d);
    dem_find_first_forces(d);
}

/* ------------------------------------------------------------------------------------------------ poses */

narc_bodies dem_make_poses(dem *d) {
    dem_grow(&d->poses, d->part_count, sizeof *d->poses);
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1)
    for (size_t i = 0; i < d->part_count; i++) {
        const dem_body *b = &d->bodies[d->parts[i].body];
        const float cosine = (float)b->turn.x, sine = (float)b->turn.y;
        d->poses[i] = (narc_body){b->place.x, b->place.y, cosine, sine, b->scale, d->parts[i].outline};
    }
    return narc_view_bodies(d->poses, d->part_count);
}

void dem_fail_lost(dem *d) {
    const narc_bodies bodies = dem_make_poses(d);
    narc_error error = {.message = "its place is out of range"};
    size_t k = 0;
    if (narc_validate_bodies(d->store, &bodies, &error) != NARC_OK)
        k = d->parts[error.index].body;
    else
        while (k + 1 < d->body_count && fabs(d->bodies[k].place.x) + fabs(d->bodies[k].place.y) < NARC_MAX_DISTANCE)
            k++;
    dem_fail(d, "step %llu: %s %zu is lost (%s): forces became too large. Use a shorter time step",
             (unsigned long long)d->step, dem_name_kind(d, k), dem_number(d, k), error.message);
}

const char *dem_name_kind(const dem *d, size_t body) { return body < d->grain_count ? "grain" : "wall"; }
size_t dem_number(const dem *d, size_t body) { return body < d->grain_count ? body : body - d->grain_count; }

/* Threads wait for each other several times a step: unless they are asked for there is one. */
unsigned dem_team(const dem *d) { return d->settings.threads > 0 ? d->settings.threads : 1; }

vec dem_cell_size(const dem *d) { return minus(d->settings.high, d->settings.low); }
