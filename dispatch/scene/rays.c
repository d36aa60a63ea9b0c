/* SPDX-License-Identifier: MIT
 *
 * rays.c - narc_cast_rays() and narc_cast_ray_pairs(): argument checks, rays into an order if asked, then part by part to the
 * kernels.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "index.h"
#include "leaves.h"
#include "narc_scene.h"
#include "pair.h"

#include <stdatomic.h>
#include <string.h>

/* Rays in a part: some 20 microseconds of work. */
enum { PART = 128 };

struct ray_job {
    narc_ray_batch batch;
    const narc_kernel_table *kernels;
    atomic_size_t skipped;
};

/* Casts rays first .. first + count - 1; how many have no answer? */
static size_t cast_some(const narc_kernel_table *kernels, const narc_ray_batch *batch, size_t first, size_t count) {
    return (batch->index ? kernels->rays : kernels->ray_pairs)(batch, first, count);
}

static void cast_part(void *argument, size_t part, size_t first, size_t end) {
    struct ray_job *const job = argument;
    (void)part;
    const size_t skipped = cast_some(job->kernels, &job->batch, first, end - first);
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* ------------------------------------------------------------------------------------------------ order */

/* Rays are sorted by their worlds, as far as there are no more of these than cells, and by the cells of a grid over the
 * scene that they start in, along Morton's curve. Where rows will be, the cells' numbers wait, and where the rays of each
 * begin. */
struct ordering {
    const narc_rays *rays;
    narc_index_column world;
    double min_x, min_y, cells_x, cells_y; /* the latter in a unit of length */
    uint32_t cells;                        /* along each axis */
    uint32_t worlds;                       /* a power of 2: what is above does not count */
    uint32_t *cell;
};

enum { CELLS = 4096, RAYS_IN_CELL = 2, MOST_CELLS = 4096 };

static uint32_t find_cell(double at, uint32_t cells) {
    return at < (double)cells ? at >= 1 ? (uint32_t)(int32_t)at : 0 : cells - 1;
}

static void find_cells(void *argument, size_t part, size_t first, size_t end) {
    const struct ordering *const o = argument;
    const narc_rays *const rays = o->rays;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const double x = narc_position_at(rays->x, k), y = narc_position_at(rays->y, k);
        const uint32_t cell_x = find_cell((x - o->min_x) * o->cells_x, o->cells);
        const uint32_t cell_y = find_cell((y - o->min_y) * o->cells_y, o->cells);
        const uint32_t world = o->world.base ? narc_index_at(o->world, k) & (o->worlds - 1) : 0;
        o->cell[k] = narc_spread_bits(cell_x) + 2 * narc_spread_bits(cell_y) + o->cells * o->cells * world;
    }
}

static uint32_t find_largest_world(narc_index_column world, size_t count) {
    uint32_t largest = 0;
    for (size_t k = 0; k < count && world.base; k++)
        largest = narc_index_at(world, k) > largest ? narc_index_at(world, k) : largest;
    return largest;
}

static void order_rays(const narc_index *index, const narc_rays *rays, const narc_index_query *search, void *room,
                       uint32_t *out) {
    const narc_box scene = index->box;
    const narc_point origin = index->origin;
    struct ordering o = {.rays = rays,
                         .world = search->world,
                         .min_x = (double)scene.min_x + origin.x,
                         .min_y = (double)scene.min_y + origin.y,
                         .cells = 1,
                         .worlds = 1,
                         .cell = room};
    uint32_t *const place = o.cell + rays->count;
    const size_t most = rays->count / RAYS_IN_CELL, largest = find_largest_world(o.world, rays->count);
    while (o.worlds <= largest && 2 * (size_t)o.worlds <= most)
        o.worlds *= 2;
    while (4 * (size_t)o.cells * o.cells * o.worlds <= most && o.cells < MOST_CELLS)
        o.cells *= 2;
    o.cells_x = o.cells / ((double)scene.max_x - (double)scene.min_x);
    o.cells_y = o.cells / ((double)scene.max_y - (double)scene.min_y);
    const size_t cells = (size_t)o.cells * o.cells * o.worlds;
    narc_run_ranges(search->workers, rays->count, CELLS, find_cells, &o);
    memset(place, 0, cells * sizeof *place);
    for (size_t k = 0; k < rays->count; k++)
        place[o.cell[k]]++;
    narc_begin_places(place, cells, cells, 1);
    for (size_t k = 0; k < rays->count; k++)
        out[place[o.cell[k]]++] = (uint32_t)k;
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_rays(const narc_rays *rays, narc_error *error) {
    narc_status status = narc_check_count(rays->count, UINT32_MAX, "rays", error);
    if (status == NARC_OK && rays->count > 0)
        status = narc_check_positions("rays", rays->x, rays->y, error);
    if (status == NARC_OK && rays->count > 0 && (!rays->motion_x.base || !rays->motion_y.base))
        return narc_fail_missing(error, rays->motion_x.base ? "rays.motion_y" : "rays.motion_x");
    return status == NARC_OK ? narc_check_reserved(rays->reserved, 2, "rays", error) : status;
}

static narc_status check_options(const narc_index *index, const narc_ray_options *options, narc_error *error) {
    if ((unsigned)options->inside > NARC_INSIDE_IGNORES)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)options->inside, "options.inside is %d",
                         (int)options->inside);
    const narc_status status = index ? narc_check_search(index, &options->search, "options.search", error) : NARC_OK;
    return status == NARC_OK ? narc_check_reserved(options->reserved, 3, "options", error) : status;
}

/* A ray by itself, without the machine of a batch: of a scene, or at a body. False if something is wrong, which the call's checks
 * tell. */
static bool cast_one(const narc_ray_batch *batch, size_t capacity) {
    narc_status status = NARC_OK;
    const narc_index *const index = batch->index;
    const narc_bodies *const bodies = batch->bodies;
    const narc_rays *const rays = batch->rays;
    const narc_ray_options *const options = batch->options;
    if (!batch->shapes || !bodies || !rays || rays->count != 1 || !batch->out || capacity < batch->most ||
        options->out_order ||
        !(index ? bodies->count == index->count && narc_has_columns(bodies)
                : narc_is_one(batch->shapes, bodies, rays->count, &batch->body)) ||
        !narc_has_positions(&rays->x, &rays->y) || !rays->motion_x.base || !rays->motion_y.base || rays->reserved[0] ||
        rays->reserved[1] || check_options(index, options, NULL) != NARC_OK)
        return false;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    if (!kernels)
        return false;
    const size_t skipped = cast_some(kernels, batch, 0, 1);
    if (options->out_skipped)
        *options->out_skipped = skipped;
    return true;
}

/* Of a scene, or without an index of bodies that are named. */
static narc_status cast_all(const narc_ray_batch *batch, size_t capacity, narc_error *error) {
    const narc_index *const index = batch->index;
    const narc_rays *const rays = batch->rays;
    const narc_ray_options *const options = batch->options;
    if (cast_one(batch, capacity))
        return NARC_OK;
    if (!batch->shapes || !batch->bodies || !rays)
        return narc_fail_missing(error, !batch->shapes ? "shapes" : !batch->bodies ? "bodies" : "rays");
    narc_status status = check_rays(rays, error);
    if (status == NARC_OK)
        status = check_options(index, options, error);
    if (status == NARC_OK)
        status = index ? narc_check_indexed(index, batch->bodies, error) : narc_check_set(batch->bodies, error);
    if (status != NARC_OK)
        return status;
    if (rays->count > capacity / batch->most)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)rays->count * (double)batch->most,
                         "%zu rows for each of %zu rays, but there is room for %zu", batch->most, rays->count,
                         capacity);
    if (rays->count > 0 && !batch->out)
        return narc_fail_missing(error, "out_rows");
    struct ray_job job = {*batch, narc_kernels(&status, error), 0};
    if (job.kernels && !index)
        status = narc_check_named(batch->shapes, batch->bodies, batch->body, rays->count, "ray",
                                  options->search.workers, error);
    if (status != NARC_OK)
        return status;
    if (index && options->out_order && rays->count > 0)
        order_rays(index, rays, &options->search, batch->out, options->out_order);
    narc_run_ranges(options->search.workers, rays->count, PART, cast_part, &job);
    if (options->out_skipped)
        *options->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return NARC_OK;
}

static const narc_ray_options defaults;

narc_status narc_cast_rays(const narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                           const narc_rays *rays, const narc_ray_options *options, narc_ray_hit *out_rows,
                           size_t capacity, narc_error *error) {
    const narc_ray_options *const o = options ? options : &defaults;
    const size_t most = o->most > 0 ? o->most : 1;
    const narc_ray_batch batch = {index, shapes, bodies, rays, o, most, out_rows, {NULL, 0}};
    return index ? cast_all(&batch, capacity, error) : narc_fail_missing(error, "index");
}

narc_status narc_cast_ray_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_rays *rays,
                                const narc_index_column *body, const narc_ray_options *options, narc_ray_hit *out_rows,
                                size_t capacity, narc_error *error) {
    const narc_ray_options *const o = options ? options : &defaults;
    const narc_index_column column = body ? *body : (narc_index_column){NULL, 0};
    const narc_ray_batch batch = {NULL, shapes, bodies, rays, o, 1, out_rows, column};
    return cast_all(&batch, capacity, error);
}
