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

bool dem_fail(dem *d, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(d->error, sizeof d->error, format, arguments);
    va_end(arguments);
    return false;
}

bool dem_fail_narc(dem *d, const char *what, const narc_error *error) {
    return dem_fail(d, "%s: %s", what, error->message);
}

/* ------------------------------------------------------------------------------------------------ memory */

bool dem_resize(dem *d, void *array_pointer, size_t count, size_t size) {
    void *array;
    memcpy(&array, array_pointer, sizeof array);
    void *larger = count <= SIZE_MAX / size ? realloc(array, count > 0 ? count * size : 1) : NULL;
    if (!larger)
        return dem_fail(d, "not enough memory for %zu items of %zu bytes", count, size);
    memcpy(array_pointer, &larger, sizeof larger);
    return true;
}

bool dem_reserve(dem *d, void *array_pointer, size_t *capacity, size_t needed, size_t size) {
    if (needed <= *capacity)
        return true;
    const size_t larger = needed + needed / 2 + 16;
    if (!dem_resize(d, array_pointer, larger, size))
        return false;
    *capacity = larger;
    return true;
}

/* Where the arrays of a structure are in it, and what they hold. */
typedef struct column {
    size_t offset, size;
} column;

#define BODY(field)                                                                                                    \
    { offsetof(dem_bodies, field), sizeof(*((dem_bodies *)0)->field) }
#define PAIR(field)                                                                                                    \
    { offsetof(dem_pairs, field), sizeof(*((dem_pairs *)0)->field) }

static const column body_columns[] = {
    BODY(x),      BODY(y),      BODY(cosine),      BODY(sine),         BODY(vx),
    BODY(vy),     BODY(spin),   BODY(fx),          BODY(fy),           BODY(torque),
    BODY(list_x), BODY(list_y), BODY(list_cosine), BODY(list_sine),    BODY(cell_x),
    BODY(cell_y), BODY(scale),  BODY(shape),       BODY(first_part),   BODY(material),
    BODY(still),  BODY(mass),   BODY(inertia),     BODY(inverse_mass), BODY(inverse_inertia),
    BODY(reach),  BODY(extent), BODY(disc)};
enum { BODY_COLUMNS = sizeof body_columns / sizeof body_columns[0] };

static const column pair_columns[] = {PAIR(a),     PAIR(b),      PAIR(shift_x), PAIR(shift_y),
                                      PAIR(hints), PAIR(memory), PAIR(rolling)};
enum { PAIR_COLUMNS = sizeof pair_columns / sizeof pair_columns[0] };

void *dem_body_column(const dem *d, size_t index, size_t *out_item_size) {
    if (index >= BODY_COLUMNS)
        return NULL;
    void *array;
    memcpy(&array, (const char *)&d->bodies + body_columns[index].offset, sizeof array);
    *out_item_size = body_columns[index].size;
    return array;
}

static bool resize_columns(dem *d, void *structure, const column *columns, size_t column_count, size_t count) {
    for (size_t i = 0; i < column_count; i++)
        if (!dem_resize(d, (char *)structure + columns[i].offset, count, columns[i].size))
            return false;
    return true;
}

/* Frees what array pointers of a structure point to. */
static void free_columns(void *structure, const column *columns, size_t column_count) {
    for (size_t i = 0; i < column_count; i++) {
        void *array;
        memcpy(&array, (char *)structure + columns[i].offset, sizeof array);
        free(array);
    }
}

bool dem_grow_pairs(dem *d, dem_pairs *pairs, size_t needed) {
    const size_t capacity = needed + needed / 2 + 16;
    if (needed > pairs->capacity && !resize_columns(d, pairs, pair_columns, PAIR_COLUMNS, capacity))
        return false;
    pairs->capacity = needed > pairs->capacity ? capacity : pairs->capacity;
    return true;
}

bool dem_create(dem *d, dem_settings settings) {
    memset(d, 0, sizeof *d);
    d->settings = settings;
    d->scratch = calloc(1, sizeof *d->scratch);
    if (!d->scratch || narc_create_shapes(NULL, &d->store) != NARC_OK || narc_create_broad_phase(NULL, &d->broad))
        return dem_fail(d, "not enough memory");
    return true;
}

void dem_destroy(dem *d) {
    dem_scratch *s = d->scratch, none = {0};
    s = s ? s : &none;
    for (size_t k = 0; k < d->outline_count; k++)
        free(d->outlines[k].sides);
    void *const arrays[] = {d->shapes, d->outlines,      d->walls,          d->parts.body, d->parts.outline,
                            s->boxes,  d->contacts.rows, d->contacts.found, s->images,     s->match,
                            s->extra,  s->sums,          s->poses,          d->scratch};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++)
        free(arrays[i]);
    free_columns(&d->bodies, body_columns, BODY_COLUMNS);
    free_columns(&d->pairs, pair_columns, PAIR_COLUMNS);
    free_columns(&d->last_pairs, pair_columns, PAIR_COLUMNS);
    narc_destroy_shapes(d->store);
    narc_destroy_broad_phase(d->broad);
    memset(d, 0, sizeof *d);
}

/* ------------------------------------------------------------------------------------------------ shapes, materials */

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
static bool add_outline(dem *d, const char *name, const narc_arc *arcs, size_t count, narc_point centroid,
                        double *reach) {
    narc_arc moved[NARC_MAX_ARCS];
    narc_error error;
    const uint32_t index = (uint32_t)d->outline_count;
    if (!dem_reserve(d, &d->outlines, &d->outline_capacity, d->outline_count + 1, sizeof *d->outlines))
        return false;
    if (narc_move_arcs(arcs, count, -centroid.x, -centroid.y, 0, 1, moved, &error) != NARC_OK ||
        narc_add_shape_at(d->store, index, moved, count, &error) != NARC_OK)
        return dem_fail_narc(d, name, &error);
    dem_outline *outline = &d->outlines[d->outline_count];
    *outline = (dem_outline){.side_count = count};
    if (!dem_resize(d, &outline->sides, count, sizeof *outline->sides))
        return false;
    d->outline_count++;
    make_touch_sides(moved, count, outline->sides);
    *reach = fmax(*reach, find_reach(moved, count));
    return true;
}

bool dem_add_compound(dem *d, const char *name, const narc_arc *arcs, const size_t *counts, size_t part_count,
                      uint32_t *out_shape) {
    narc_error error;
    narc_mass mass;
    dem_shape shape = {.first_outline = (uint32_t)d->outline_count, .outline_count = (uint32_t)part_count};
    if (narc_compute_union_mass(arcs, counts, part_count, NULL, &mass, &error) != NARC_OK)
        return dem_fail_narc(d, name, &error);
    if (!(mass.area > 0))
        return dem_fail(d, "%s: the shape encloses no area", name);
    if (part_count == 1) /* simpler sums, of fewer roundings */
        narc_compute_mass(arcs, counts[0], &mass);
    for (size_t part = 0; part < part_count; arcs += counts[part++])
        if (!add_outline(d, name, arcs, counts[part], (narc_point){mass.centroid_x, mass.centroid_y}, &shape.reach))
            return false;
    if (!dem_reserve(d, &d->shapes, &d->shape_capacity, d->shape_count + 1, sizeof *d->shapes))
        return false;
    shape.area = mass.area;
    shape.second_moment = mass.second_moment;
    shape.extent = 2 * sqrt(mass.area / DEM_PI);
    snprintf(shape.name, sizeof shape.name, "%s", name);
    *out_shape = (uint32_t)d->shape_count;
    d->shapes[d->shape_count++] = shape;
    return true;
}

bool dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count, uint32_t *out_shape) {
    return dem_add_compound(d, name, arcs, &count, 1, out_shape);
}

/* ------------------------------------------------------------------------------------------------ bodies */

/* A body of mass 0, without speed. */
static bool add_body(dem *d, uint32_t shape_index, uint8_t material, dem_vec at, double angle, double scale) {
    dem_bodies *b = &d->bodies;
    dem_parts *p = &d->parts;
    const dem_shape *shape = &d->shapes[shape_index];
    const size_t k = b->count, parts = p->count + shape->outline_count;
    if (k + 1 > b->capacity) {
        b->capacity = 2 * k + 64;
        if (!resize_columns(d, b, body_columns, BODY_COLUMNS, b->capacity))
            return false;
    }
    if (parts > p->capacity) {
        p->capacity = 2 * parts + 64;
        if (!dem_resize(d, &p->body, p->capacity, sizeof *p->body) ||
            !dem_resize(d, &p->outline, p->capacity, sizeof *p->outline))
            return false;
    }
    for (size_t i = 0; i < BODY_COLUMNS; i++) {
        size_t size;
        char *array = dem_body_column(d, i, &size);
        memset(array + k * size, 0, size);
    }
    const dem_outline *outline = &d->outlines[shape->first_outline];
    const touch_side *side = outline->sides;
    const bool is_disc = shape->outline_count == 1 && outline->side_count == 1 && side->x == 0 && side->y == 0;
    b->x[k] = at.x;
    b->y[k] = at.y;
    b->cosine[k] = cos(angle);
    b->sine[k] = sin(angle);
    b->scale[k] = (float)scale;
    b->shape[k] = shape_index;
    b->material[k] = material;
    b->reach[k] = (double)b->scale[k] * shape->reach;
    b->extent[k] = (double)b->scale[k] * shape->extent;
    b->disc[k] = is_disc ? (double)b->scale[k] * side->radius : 0;
    b->first_part[k] = (uint32_t)p->count;
    for (uint32_t i = 0; i < shape->outline_count; i++) {
        p->body[p->count] = (uint32_t)k;
        p->outline[p->count++] = shape->first_outline + i;
    }
    b->count++;
    return true;
}

bool dem_add_grain(dem *d, dem_grain grain) {
    const size_t k = d->bodies.count;
    if (!add_body(d, grain.shape, grain.material, (dem_vec){grain.x, grain.y}, grain.angle, grain.scale))
        return false;
    dem_bodies *b = &d->bodies;
    const dem_shape *shape = &d->shapes[grain.shape];
    const double s = (double)b->scale[k], pillar = d->materials[grain.material].density * d->settings.thickness;
    b->vx[k] = grain.vx;
    b->vy[k] = grain.vy;
    b->spin[k] = grain.spin;
    b->mass[k] = pillar * shape->area * s * s;
    b->inertia[k] = pillar * shape->second_moment * s * s * s * s;
    b->inverse_mass[k] = 1 / b->mass[k];
    b->inverse_inertia[k] = 1 / b->inertia[k];
    if (!isfinite(b->inverse_mass[k]) || !isfinite(b->inverse_inertia[k]) || !isfinite(b->inertia[k]))
        return dem_fail(d, "grain %zu: mass %g is out of range", k, b->mass[k]);
    d->grain_count++;
    d->grain_reach = fmax(d->grain_reach, b->reach[k]);
    d->grain_extent = fmax(d->grain_extent, b->extent[k]);
    const double allowed = d->settings.max_overlap * b->extent[k];
    d->safe_depth = k == 0 ? allowed : fmin(d->safe_depth, allowed);
    return true;
}

bool dem_add_wall(dem *d, dem_wall wall) {
    const double length = hypot(wall.normal.x, wall.normal.y);
    if (wall.kind == DEM_BOX && !((float)wall.scale > 0 && isfinite((float)wall.scale)))
        return dem_fail(d, "wall '%s': scale %g is out of range", wall.name, wall.scale);
    if (!dem_reserve(d, &d->walls, &d->wall_capacity, d->wall_count + 1, sizeof *d->walls))
        return false;
    if (wall.kind == DEM_PLATE)
        wall.normal = (dem_vec){wall.normal.x / length, wall.normal.y / length};
    d->walls[d->wall_count++] = wall;
    return true;
}

/* A plate's body is a block whose upper side is the plate: with four times the largest grain's reach and the skin in
 * half its side, so that it goes on further than any grain that may touch it, whatever both move before the next list.
 */
static bool add_walls(dem *d) {
    const double half = 4 * (d->grain_reach + d->settings.skin);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    uint32_t block = UINT32_MAX;
    for (size_t w = 0; w < d->wall_count; w++) {
        dem_wall *wall = &d->walls[w];
        const bool plate = wall->kind == DEM_PLATE;
        if (plate && block == UINT32_MAX) {
            if (narc_build_box(2 * half, 2 * half, 0, arcs, &count, &error) != NARC_OK)
                return dem_fail_narc(d, "the block of a plate", &error);
            if (!dem_add_shape(d, "plate", arcs, count, &block))
                return false;
        }
        wall->shape = plate ? block : wall->shape;
        wall->scale = plate ? 1 : wall->scale;
        const double down = plate ? half : 0; /* a box has no normal */
        const dem_vec place = {wall->place.x - down * wall->normal.x, wall->place.y - down * wall->normal.y};
        const size_t k = d->bodies.count;
        if (!add_body(d, wall->shape, wall->material, place, wall->angle, wall->scale))
            return false;
        d->bodies.cosine[k] = plate ? wall->normal.y : d->bodies.cosine[k];
        d->bodies.sine[k] = plate ? -wall->normal.x : d->bodies.sine[k];
        d->bodies.still[k] = 1;
    }
    return true;
}

static void enlarge(dem_region *r, double x, double y, double by) {
    r->low_x = fmin(r->low_x, x - by);
    r->low_y = fmin(r->low_y, y - by);
    r->high_x = fmax(r->high_x, x + by);
    r->high_y = fmax(r->high_y, y + by);
}

dem_region dem_bound_grains(const dem *d) {
    dem_region r = {.low_x = INFINITY, .low_y = INFINITY, .high_x = -INFINITY, .high_y = -INFINITY};
    for (size_t k = 0; k < d->grain_count; k++)
        enlarge(&r, d->bodies.x[k], d->bodies.y[k], d->bodies.reach[k]);
    return r;
}

/* A periodic cell's width is rounded to a float: the shift of an image is one. */
static bool check_cell(dem *d, const char *axis, double low, double *high) {
    const float width = (float)(*high - low);
    if (!(width > 0) || !isfinite(width))
        return dem_fail(d, "the periodic cell's width in %s is %g", axis, *high - low);
    *high = low + (double)width;
    return true;
}

bool dem_start(dem *d) {
    dem_settings *s = &d->settings;
    const double shortest = dem_find_shortest_contact(d), rate = s->shear;
    if (s->time_step > shortest / 5)
        return dem_fail(
            d,
            "time step %g is more than a fifth of what the shortest contact lasts, %g. Take a 15th, or less "
            "stiff contacts",
            s->time_step, shortest);
    if (s->sheared && (!s->periodic_x || !s->periodic_y || d->wall_count > 0 || s->gravity.x != 0 || s->gravity.y != 0))
        return dem_fail(d, "a sheared cell is periodic in x and y, and has neither walls nor gravity");
    if ((s->periodic_x && !check_cell(d, "x", s->low_x, &s->high_x)) ||
        (s->periodic_y && !check_cell(d, "y", s->low_y, &s->high_y)) || !add_walls(d))
        return false;
    s->shear = 0;
    dem_set_shear(d, rate);
    d->shear_work = 0; /* grains begin so */
    dem_region all = dem_bound_grains(d);
    for (size_t w = 0; w < d->wall_count; w++)
        enlarge(&all, d->walls[w].place.x, d->walls[w].place.y, 0);
    d->diagonal = hypot(all.high_x - all.low_x, all.high_y - all.low_y);
    return dem_renew_lists(d) && dem_find_first_forces(d);
}

/* ------------------------------------------------------------------------------------------------ poses */

bool dem_make_poses(dem *d, narc_bodies *out) {
    const dem_bodies *b = &d->bodies;
    const dem_parts *p = &d->parts;
    const size_t count = p->count;
    if (!dem_reserve(d, &d->scratch->poses, &d->scratch->pose_capacity, count, sizeof *d->scratch->poses))
        return false;
    narc_body *const pose = d->scratch->poses;
#pragma omp parallel for schedule(static) num_threads(dem_team(d)) if (dem_team(d) > 1)
    for (size_t i = 0; i < count; i++) {
        const size_t k = p->body[i];
        pose[i] = (narc_body){b->x[k], b->y[k], (float)b->cosine[k], (float)b->sine[k], b->scale[k], p->outline[i]};
    }
    *out = narc_view_bodies(pose, count);
    return true;
}

bool dem_find_broken_body(dem *d) {
    narc_bodies bodies;
    narc_error error = {.message = "its place is out of range"};
    if (!dem_make_poses(d, &bodies))
        return false;
    size_t k = 0;
    if (narc_validate_bodies(d->store, &bodies, &error) != NARC_OK)
        k = d->parts.body[error.index];
    else
        while (k + 1 < d->bodies.count && fabs(d->bodies.x[k]) + fabs(d->bodies.y[k]) < NARC_MAX_DISTANCE)
            k++;
    const bool is_grain = k < d->grain_count;
    return dem_fail(d, "step %llu: %s %zu is lost (%s): forces became too large. Use a shorter time step",
                    (unsigned long long)d->step, is_grain ? "grain" : "wall", is_grain ? k : k - d->grain_count,
                    error.message);
}

/* Threads wait for each other several times a step: unless they are asked for there is one. */
unsigned dem_team(const dem *d) { return d->settings.threads > 0 ? d->settings.threads : 1; }

narc_workers dem_workers(const dem *d) { return narc_openmp_workers(dem_team(d)); }

double dem_cell_width(const dem *d) { return d->settings.high_x - d->settings.low_x; }
double dem_cell_height(const dem *d) { return d->settings.high_y - d->settings.low_y; }
