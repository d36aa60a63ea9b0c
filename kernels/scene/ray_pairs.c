/* SPDX-License-Identifier: MIT
 *
 * ray_pairs.c - the kernel of rays that ask of one body each: no way to it, and the rows of rays.c.
 */
#define NARC_EIGHT_LANES

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "column.h"
#include "kernels.h"
#include "scene/ray_entry.inl"

/* False: it has no answer. */
INLINE bool load_ray(const narc_rays *rays, size_t k, struct ray *out, float *out_limit) {
    const place motion = {(double)narc_float_at(rays->motion_x, k), (double)narc_float_at(rays->motion_y, k)};
    const double length = sqrt(find_dot(motion, motion)), inverse = 1 / length;
    out->origin = (place){narc_position_at(rays->x, k), narc_position_at(rays->y, k)};
    out->direction = (place){motion.x * inverse, motion.y * inverse};
    out->length = length;
    out->inverse_length = inverse;
    *out_limit = narc_float_or(rays->fraction, k, 1);
    return fabs(out->origin.x) <= DBL_MAX && fabs(out->origin.y) <= DBL_MAX && length > 0 && length <= DBL_MAX &&
           *out_limit >= 0;
}

size_t NARC_NAMED(ray_pairs)(const narc_ray_batch *batch, size_t first, size_t count) {
    size_t skipped = 0;
    for (size_t k = first; k < first + count; k++) {
        const size_t body = batch->body.base ? narc_index_at(batch->body, k) : k;
        narc_ray_hit hit = {.ray = (uint32_t)k, .body = (uint32_t)body, .count = 1};
        struct body_frame frame;
        struct ray ray;
        struct meeting met;
        float limit;
        const bool has_answer = load_ray(batch->rays, k, &ray, &limit);
        const bool hits = has_answer && load_body_frame(batch->shapes, batch->bodies, body, &frame) &&
                          find_meeting(&frame, &ray, batch->options->inside, false, &met) &&
                          put_meeting(&frame, &ray, &met, limit, &hit);
        batch->out[k] = hits ? hit : (narc_ray_hit){.ray = (uint32_t)k};
        skipped += !has_answer;
    }
    return skipped;
}
