/* SPDX-License-Identifier: MIT
 *
 * rays.c - the kernel of rays: reads them, and sends them through the index, in company or alone.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "index.h"
#include "kernels.h"
#include "scene/ray_fans.inl"
#include "scene/ray_reading.inl"
#include "scene/ray_walk.inl"
#include "simd/simd.h"

/* Empties a ray's rows. Has it an answer? */
INLINE bool empty_rows(const narc_ray_batch *batch, const struct read_rays *rays, size_t k) {
    narc_ray_hit *const rows = get_rows(batch, rays, k);
    for (size_t i = 0; i < batch->most; i++)
        rows[i] = (narc_ray_hit){.ray = rays->number[k]};
    return rays->length[k] > 0;
}

/* Casts rays that are read; how many have no answer? */
static size_t cast_rays(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays) {
    struct loners loners;
    struct fan fan;
    size_t skipped = 0;
    loners.rays = rays;
    loners.next = loners.count = 0;
    for (size_t k = 0; k < rays->count; k++)
        skipped += !empty_rows(batch, rays, k);
    for (size_t k = 0, count; k < rays->count; k += count) {
        count = 1;
        if (!(rays->length[k] > 0) || rays->base[k] < 0)
            continue;
        count = gather_fan(batch, scene, rays, k, &fan);
        if (count >= LEAST_TOGETHER) {
            walk_together(batch, &fan);
            continue;
        }
        for (size_t i = k; i < k + count; i++)
            loners.number[loners.count++] = (uint8_t)i;
    }
    if (IN_LANES && loners.count >= LEAST_TOGETHER)
        walk_apart(batch, &loners);
    else
        walk_one_by_one(batch, &loners);
    return skipped;
}

/* A ray by itself; has it no answer? */
static bool cast_one_ray(const narc_ray_batch *batch, const narc_box *scene, size_t k, struct read_rays *rays) {
    struct walk w;
    read_rays(batch, scene, k, 1, rays);
    if (!empty_rows(batch, rays, 0))
        return true;
    if (rays->base[0] >= 0) {
        begin_walk(batch, rays, 0, &w);
        walk_alone(batch, &w);
    }
    return false;
}

size_t NARC_NAMED(rays)(const narc_ray_batch *batch, size_t first, size_t count) {
    const narc_box scene = batch->index->box;
    size_t skipped = 0;
    struct read_rays rays;
    if (count == 1)
        return cast_one_ray(batch, &scene, first, &rays);
    for (size_t k = first; k < first + count; k += READ) {
        const size_t left = first + count - k;
        read_rays(batch, &scene, k, left < READ ? left : READ, &rays);
        skipped += cast_rays(batch, &scene, &rays);
    }
    return skipped;
}
