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

narc_status narc_check_length(float length, const char *owner, const char *name, narc_error *error) {
    if (!isfinite(length))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)length, "%s.%s is %g", owner, name, (double)length);
    if (length < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)length, "%s.%s is %g, less than 0", owner, name,
                         (double)length);
    return NARC_OK;
}

typedef struct box_job {
    narc_box_batch batch;
    const narc_kernel_table *kernels;
    const narc_known_poses *known;
    float slack;                    /* known.slack of a body whose box is new */
    narc_float_column reach, ahead; /* known, too */
    narc_index_column run;
    narc_index_column moved; /* the bodies, where they are listed */
    bool reframed;           /* all boxes are to be computed */
    size_t first;
    narc_box *out_boxes;
    atomic_size_t skipped;
} box_job;

/* ------------------------------------------------------------------------------------------------ room */

/* x - by or less, finite: a rounding errs by half of the step that is added, or less. */
static float lower(float x, float by) {
    const float rounded = x - by, down = rounded - (fabsf(rounded) * 0x1p-23f + FLT_TRUE_MIN);
    return by == 0 ? x : down < -FLT_MAX ? -FLT_MAX : down;
}

narc_box narc_widen_box(narc_box box, float by) {
    return (narc_box){lower(box.min_x, by), lower(box.min_y, by), -lower(-box.max_x, by), -lower(-box.max_y, by)};
}

/* With a reach of its own; empty if that is broken. */
static narc_box add_reach(narc_box box, float reach) {
    return narc_is_box(&box) && reach >= 0 && reach <= FLT_MAX ? narc_widen_box(box, reach) : narc_empty_box();
}

/* ------------------------------------------------------------------------------------------------ what has moved */

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

static narc_motion_bits get_motion_bits(const box_job *job, size_t k) {
    const narc_float_column column[4] = {job->batch.motion_x, job->batch.motion_y, job->reach, job->ahead};
    narc_motion_bits bits = {{0}};
    for (int i = 0; i < 4; i++)
        if (column[i].base)
            bits.word[i] = (uint32_t)bits_at(column[i].base, column[i].stride, k);
    if (job->run.base)
        bits.word[4] = narc_index_at(job->run, k);
    return bits;
}

static double position_of(narc_precision precision, uint64_t bits) {
    double position;
    float single;
    const uint32_t low = (uint32_t)bits;
    if (precision == NARC_FLOAT64) {
        memcpy(&position, &bits, sizeof position);
        return position;
    }
    memcpy(&single, &low, sizeof single);
    return (double)single;
}

static bool is_unit(float cosine, float sine) {
    return fabsf(cosine * cosine + sine * sine - 1) < (float)NARC_ROTATION_TOLERANCE / 2;
}

/* As far as this, or less, all points of a body have gone from one pose to another; NaN or infinite where nothing is known.
 * Scale and shape are the same. */
static float find_way(const box_job *job, const narc_pose_bits *from, const narc_pose_bits *to, size_t body) {
    const narc_bodies *const bodies = job->batch.bodies;
    const narc_shape_header *const shape = &job->batch.shapes->headers[narc_index_at(bodies->shape, body)];
    const float extent = fabsf(shape->bound_x) + fabsf(shape->bound_y) + shape->bound_radius;
    const narc_precision precision = bodies->x.precision;
    const double x = position_of(precision, to->word[0]) - position_of(precision, from->word[0]);
    const double y = position_of(precision, to->word[1]) - position_of(precision, from->word[1]);
    float then[2], now[2];
    memcpy(then, &from->word[2], sizeof then);
    memcpy(now, &to->word[2], sizeof now);
    const float turn = fabsf(now[0] - then[0]) + fabsf(now[1] - then[1]);
    const float way = (float)(fabs(x) + fabs(y)) + turn * extent * narc_float_or(bodies->scale, body, 1);
    if (narc_is_piece(shape)) /* its box holds what lies behind it, too */
        return INFINITY;
    return is_unit(then[0], then[1]) && is_unit(now[0], now[1]) ? way * (1 + 0x1p-6f) : INFINITY;
}

/* Is a body within its box still, as it has hardly moved since this was computed? What is left of its slack is less then. */
static bool stays_in_box(const box_job *job, const narc_pose_bits *from, const narc_pose_bits *to, size_t body) {
    float *const slack = &job->known->slack[body];
    const float left = job->slack > 0 ? *slack - find_way(job, from, to, body) : -1;
    if (!(left >= 0))
        return false;
    *slack = left - left * 0x1p-22f; /* a way that is lost in rounding is one, too */
    return true;
}

/* What a body with this box may move: none, if it has none or is so far away that rounding counts. */
static float find_own_slack(const narc_box *box, float slack) {
    const float far = fmaxf(fmaxf(fabsf(box->min_x), fabsf(box->max_x)), fmaxf(fabsf(box->min_y), fabsf(box->max_y)));
    return far < slack * 0x1p18f ? slack - far * 0x1p-20f : -1;
}

/* Lists those of bodies first .. end - 1, or of the listed ones, whose poses or motions are not the known ones, which they
 * are then. */
static size_t list_moved(const box_job *job, size_t first, size_t end, uint32_t *list) {
    const narc_bodies bodies = *job->batch.bodies; /* copies, which nothing that is written could change */
    const narc_known_poses known = *job->known;
    const narc_index_column moved = job->moved;
    const bool listed = moved.base;
    const bool rows = are_rows(&bodies);
    size_t count = 0;
    for (size_t i = first; i < end; i++) {
        const size_t k = listed ? narc_index_at(moved, i) : i;
        bool same_pose = k < known.count, same_motion = same_pose, same_shape = same_pose;
        narc_pose_bits now;
        if (rows)
            memcpy(&now, narc_at(bodies.x.base, bodies.x.stride, k), sizeof now);
        else
            now = get_pose_bits(&bodies, k);
        if (same_pose) {
            const narc_pose_bits then = known.poses[k];
            const uint64_t other = (now.word[0] ^ then.word[0]) | (now.word[1] ^ then.word[1]) |
                                   (now.word[2] ^ then.word[2]) | (now.word[3] ^ then.word[3]);
            same_pose = other == 0;
            same_shape = now.word[3] == then.word[3];
        }
        if (known.has_motions) {
            const narc_motion_bits motion = get_motion_bits(job, k);
            same_shape = same_shape && memcmp(&motion.word[3], &known.motions[k].word[3], 2 * sizeof(uint32_t)) == 0;
            same_motion = same_motion && memcmp(&motion, &known.motions[k], sizeof motion) == 0;
            known.motions[k] = motion;
        }
        if (same_pose && same_motion && !job->reframed)
            continue;
        const bool stays = !job->reframed && same_shape && stays_in_box(job, &known.poses[k], &now, k);
        known.poses[k] = now;
        if (!same_shape)
            known.changed[k] = NARC_ALL_CHANGED;
        else if (!same_pose)
            known.changed[k] |= NARC_CHANGED;
        if (stays)
            continue;
        known.moved[k] |= job->out_boxes != NULL;
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
        count = list_moved(job, first, job->first + end, list);
    size_t skipped = 0;
    if (!job->out_boxes)
        return;
    if (count > 0) /* mostly nothing moves */
        skipped = job->kernels->box(&job->batch, job->known ? list : NULL, first, count, job->out_boxes);
    for (size_t i = 0; i < count && job->slack > 0; i++)
        job->known->slack[list[i]] = find_own_slack(&job->out_boxes[list[i]], job->slack);
    for (size_t i = 0; i < count && (job->reach.base || job->ahead.base); i++) {
        const float ahead = narc_float_or(job->ahead, list[i], 0), reach = narc_float_or(job->reach, list[i], 0);
        job->out_boxes[list[i]] = add_reach(job->out_boxes[list[i]], ahead >= 0 && ahead <= FLT_MAX ? reach : -1);
    }
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* Room for what a step needs beside the bodies of a box batch: options.reach and what is known. */
static narc_status compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                                 size_t count, box_job *job, narc_error *error) {
    narc_status status = NARC_OK;
    job->batch =
        (narc_box_batch){shapes, bodies, options->margin, options->motion_x, options->motion_y, options->origin};
    job->kernels = narc_kernels(&status, error);
    job->first = options->first;
    if (job->kernels)
        narc_run_ranges(options->workers, count, PART, compute_part, job);
    return status;
}

narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                               narc_box *out_boxes, narc_error *error) {
    static const narc_box_options defaults = {0};
    const narc_box_options *const o = options ? options : &defaults;
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    size_t count = o->count;
    narc_status status = narc_check_length(o->margin, "options", "margin", error);
    if (status == NARC_OK)
        status = narc_check_origin(o->origin, "options", error);
    if (status == NARC_OK)
        status = narc_check_reserved(o->reserved, 3, "options", error);
    if (status == NARC_OK)
        status = narc_check_bodies(shapes, bodies, o->first, &count, o->workers, error);
    if (status != NARC_OK)
        return status;
    if (count > 0 && !out_boxes)
        return narc_fail_missing(error, "out_boxes");
    box_job job = {.out_boxes = out_boxes};
    status = compute_boxes(shapes, bodies, o, count, &job, error);
    if (status == NARC_OK && o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return status;
}

/* ------------------------------------------------------------------------------------------------ boxes of a step */

void narc_forget_poses(narc_broad_phase *broad) {
    broad->known.count = 0;
    if (broad->body_capacity > 0)
        memset(broad->known.moved, 1, broad->body_capacity);
}

bool narc_are_poses_known(const narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step) {
    const narc_known_poses *const known = &broad->known;
    return known->precision == step->bodies->x.precision && known->shapes == shapes &&
           known->history == shapes->history && known->margin == step->margin && known->skin == step->skin &&
           known->has_motions == narc_has_motions(step) && known->has_boxes == !step->pairs;
}

narc_status narc_compute_step_boxes(narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step,
                                    bool listed, narc_error *error) {
    const narc_bodies *const bodies = step->bodies;
    const float slack = narc_find_slack(step->skin, narc_has_motions(step));
    const narc_box_options box_options = {.margin = step->margin * 0.5f + slack,
                                          .motion_x = step->motion_x,
                                          .motion_y = step->motion_y,
                                          .workers = step->workers,
                                          .origin = &broad->origin};
    narc_known_poses *const known = &broad->known;
    if (!narc_are_poses_known(broad, shapes, step))
        narc_forget_poses(broad);
    known->has_motions = narc_has_motions(step);
    known->has_boxes = !step->pairs;
    box_job job = {.known = known,
                   .slack = step->pairs ? 0 : slack,
                   .reach = step->reach,
                   .ahead = step->ahead,
                   .run = step->run,
                   .reframed = broad->reframed,
                   .out_boxes = step->pairs ? NULL : broad->boxes_now};
    size_t count = listed ? step->moved_count : 0;
    narc_status status = NARC_OK;
    if (listed) {
        job.moved = step->moved;
        status = narc_check_named(shapes, bodies, step->moved, step->moved_count, "step.moved", step->workers, error);
    } else
        status = narc_check_bodies(shapes, bodies, 0, &count, step->workers, error);
    if (status == NARC_OK)
        status = compute_boxes(shapes, bodies, &box_options, count, &job, error);
    if (status != NARC_OK)
        return status;
    known->count = bodies->count;
    known->precision = bodies->x.precision;
    known->shapes = shapes;
    known->history = shapes->history;
    known->margin = step->margin;
    known->skin = step->skin;
    return NARC_OK;
}
