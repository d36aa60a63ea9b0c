/* SPDX-License-Identifier: MIT
 *
 * boxes.c - narc_compute_boxes(): argument checks, then bodies part by part to the kernel; and the boxes of a step of
 * narc_update_pairs(), of bodies that have moved.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <math.h>

/* Bodies in a part: some 20 microseconds of work. */
enum { PART = 1024 };

narc_status narc_check_length(float length, const char *name, narc_error *error) {
    if (!isfinite(length))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)length, "options.%s is %g", name, (double)length);
    if (length < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)length, "options.%s is %g, less than 0", name,
                         (double)length);
    return NARC_OK;
}

typedef struct box_job {
    narc_box_batch batch;
    const narc_kernel_table *kernels;
    const narc_known_poses *known;
    size_t first;
    narc_box *out_boxes;
    atomic_size_t skipped;
} box_job;

/* The bits of an item of 32 bits of a column. */
static uint64_t bits_at(const void *base, ptrdiff_t stride, size_t k) {
    uint32_t bits;
    memcpy(&bits, narc_at(base, stride, k), sizeof bits);
    return bits;
}

static uint64_t position_bits_at(narc_position_column column, size_t k) {
    uint64_t bits;
    if (column.precision == NARC_FLOAT32)
        return bits_at(column.base, column.stride, k);
    memcpy(&bits, narc_at(column.base, column.stride, k), sizeof bits);
    return bits;
}

/* Two numbers of 32 bits as they follow each other in memory. Put together in registers: a word that is read from two halves
 * just written waits for both. */
static uint64_t join_bits(uint64_t first, uint64_t second) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return first << 32 | second;
#else
    return first | second << 32;
#endif
}

static narc_pose_bits get_pose_bits(const narc_bodies *bodies, size_t k) {
    static const float one = 1;
    const narc_float_column cosine = bodies->cosine, sine = bodies->sine;
    const narc_float_column scale = bodies->scale.base ? bodies->scale : (narc_float_column){&one, 0};
    return (narc_pose_bits){{position_bits_at(bodies->x, k), position_bits_at(bodies->y, k),
                             join_bits(bits_at(cosine.base, cosine.stride, k), bits_at(sine.base, sine.stride, k)),
                             join_bits(bits_at(scale.base, scale.stride, k), narc_index_at(bodies->shape, k))}};
}

/* Is it just these bits that lie in memory for each body, as of narc_body? */
static bool are_rows(const narc_bodies *bodies) {
    const char *const row = bodies->x.base;
    const ptrdiff_t stride = bodies->x.stride;
    return bodies->x.precision == NARC_FLOAT64 && bodies->scale.base &&
           bodies->y.base == row + offsetof(narc_body, y) &&
           (const char *)bodies->cosine.base == row + offsetof(narc_body, cosine) &&
           (const char *)bodies->sine.base == row + offsetof(narc_body, sine) &&
           (const char *)bodies->scale.base == row + offsetof(narc_body, scale) &&
           (const char *)bodies->shape.base == row + offsetof(narc_body, shape) && bodies->y.stride == stride &&
           bodies->cosine.stride == stride && bodies->sine.stride == stride && bodies->scale.stride == stride &&
           bodies->shape.stride == stride;
}

/* Lists those of bodies first .. end - 1 whose poses are not the known ones, which they are then. */
static size_t list_moved(const narc_bodies *given, const narc_known_poses *all, size_t first, size_t end,
                         uint32_t *list) {
    const narc_bodies bodies = *given; /* copies, which nothing that is written could change */
    const narc_known_poses known = *all;
    const bool rows = are_rows(&bodies);
    size_t count = 0;
    for (size_t k = first; k < end; k++) {
        narc_pose_bits now;
        if (rows)
            memcpy(&now, narc_at(bodies.x.base, bodies.x.stride, k), sizeof now);
        else
            now = get_pose_bits(&bodies, k);
        if (k < known.count) {
            const narc_pose_bits then = known.poses[k];
            const uint64_t other = (now.word[0] ^ then.word[0]) | (now.word[1] ^ then.word[1]) |
                                   (now.word[2] ^ then.word[2]) | (now.word[3] ^ then.word[3]);
            if (other == 0)
                continue;
        }
        known.poses[k] = now;
        known.moved[k] = 1;
        list[count++] = (uint32_t)k;
    }
    return count;
}

static void compute_part(void *argument, size_t part, size_t start, size_t end) {
    box_job *job = argument;
    const size_t first = job->first + start;
    size_t count = end - start;
    uint32_t list[PART];
    (void)part;
    if (job->known)
        count = list_moved(job->batch.bodies, job->known, first, job->first + end, list);
    const size_t skipped = job->kernels->box(&job->batch, job->known ? list : NULL, first, count, job->out_boxes);
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* Where boxes of some poses are known, from the same options and shapes, of all others. */
static narc_status compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                                 const narc_known_poses *known, narc_box *out_boxes, narc_error *error) {
    static const narc_box_options defaults = {0};
    const narc_box_options *const o = options ? options : &defaults;
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    size_t count = o->count;
    narc_status status = narc_check_length(o->margin, "margin", error);
    if (status == NARC_OK)
        status = narc_check_reserved(o->reserved, 4, "options", error);
    if (status == NARC_OK)
        status = narc_check_bodies(shapes, bodies, o->first, &count, o->workers, error);
    if (status != NARC_OK)
        return status;
    if (count > 0 && !out_boxes)
        return narc_fail_missing(error, "out_boxes");
    box_job job = {{shapes, bodies, o->margin, o->motion_x, o->motion_y},
                   narc_kernels(&status, error),
                   .known = known,
                   .first = o->first,
                   .out_boxes = out_boxes};
    if (!job.kernels)
        return status;
    narc_run_ranges(o->workers, count, PART, compute_part, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return NARC_OK;
}

narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                               narc_box *out_boxes, narc_error *error) {
    return compute_boxes(shapes, bodies, options, NULL, out_boxes, error);
}

/* ------------------------------------------------------------------------------------------------ boxes of a step */

/* x - by or less, finite: a rounding errs by half of the step that is added, or less. */
static float lower(float x, float by) {
    const float rounded = x - by, down = rounded - (fabsf(rounded) * 0x1p-23f + FLT_TRUE_MIN);
    return by == 0 ? x : down < -FLT_MAX ? -FLT_MAX : down;
}

narc_box narc_widen_box(narc_box box, float by) {
    return (narc_box){lower(box.min_x, by), lower(box.min_y, by), -lower(-box.max_x, by), -lower(-box.max_y, by)};
}

void narc_add_room(const narc_box *boxes, size_t count, float room, narc_float_column reach, narc_box *out_boxes) {
    for (size_t k = 0; k < count; k++) {
        const float own = reach.base ? narc_float_at(reach, k) : 0;
        const bool fine = narc_is_box(&boxes[k]) && own >= 0 && own <= FLT_MAX;
        out_boxes[k] = fine ? narc_widen_box(narc_widen_box(boxes[k], room), own) : narc_empty_box();
    }
}

void narc_forget_poses(narc_broad_phase *broad) {
    broad->known.count = 0;
    memset(broad->known.moved, 1, broad->body_capacity);
}

narc_status narc_compute_step_boxes(narc_broad_phase *broad, const narc_shapes *shapes, const narc_bodies *bodies,
                                    const narc_pair_options *options, narc_error *error) {
    const narc_box_options box_options = {.margin = options->margin * 0.5f,
                                          .motion_x = options->motion_x,
                                          .motion_y = options->motion_y,
                                          .workers = options->workers};
    const bool by_pose = !options->motion_x.base && !options->motion_y.base && !options->reach.base;
    narc_known_poses *const known = &broad->known;
    if (!by_pose || known->precision != bodies->x.precision || known->shapes != shapes ||
        known->history != shapes->history || known->margin != options->margin || known->skin != options->skin)
        narc_forget_poses(broad);
    const narc_status status =
        compute_boxes(shapes, bodies, &box_options, by_pose ? known : NULL, broad->boxes_now, error);
    if (status != NARC_OK)
        return status;
    if (options->reach.base)
        narc_add_room(broad->boxes_now, bodies->count, 0, options->reach, broad->boxes_now);
    known->count = by_pose ? bodies->count : 0;
    known->precision = bodies->x.precision;
    known->shapes = shapes;
    known->history = shapes->history;
    known->margin = options->margin;
    known->skin = options->skin;
    return NARC_OK;
}
