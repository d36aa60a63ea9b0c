/* SPDX-License-Identifier: MIT
 *
 * casts.c - narc_cast_pairs(): argument checks, then pairs part by part. Of a part some pairs are under way at a time,
 * each in a slot: all of them are placed at their present times, the contact kernel finds what there is between them,
 * and each goes on or makes room for the next pair. So vectors are full until a part ends.
 */
#include <math.h>

#include "casts.h"
#include "column.h"
#include "error.h"

/* Pairs in a part. */
enum { PART = 1024 };

/* Pairs under way: what fits on the stack beside the kernel's queues (NARC_STACK_SIZE). */
enum { SLOTS = 32 };

/* So few are asked for of the kernels with one lane; see api.c. */
enum { FEW = 2 };

/* What the kernel reads of a body: a pose in the form that is read fastest. A stands at the origin. */
struct pose {
    float x, y, cosine, sine;
};

struct slots {
    size_t count;
    narc_cast cast[SLOTS];
    uint32_t pair[SLOTS];
    struct pose pose[SLOTS][2];
    float scale[SLOTS][2];
    uint32_t shape[SLOTS][2];
    uint32_t hint[SLOTS];
    narc_contact contact[SLOTS];
    narc_bodies a, b;
    narc_pairs pairs;
    narc_query query;
    narc_batch batch;
};

/* ------------------------------------------------------------------------------------------------ slots */

static void open_slots(const narc_cast_job *job, struct slots *slots) {
    const ptrdiff_t stride = 2 * sizeof(struct pose), item = 2 * sizeof(float);
    const struct pose *const a = &slots->pose[0][0], *const b = &slots->pose[0][1];
    slots->count = 0;
    slots->a = (narc_bodies){.count = SLOTS,
                             .x = {&a->x, stride, NARC_FLOAT32},
                             .y = {&a->y, stride, NARC_FLOAT32},
                             .cosine = {&a->cosine, stride},
                             .sine = {&a->sine, stride},
                             .scale = {&slots->scale[0][0], item},
                             .shape = {&slots->shape[0][0], item}};
    slots->b = (narc_bodies){.count = SLOTS,
                             .x = {&b->x, stride, NARC_FLOAT32},
                             .y = {&b->y, stride, NARC_FLOAT32},
                             .cosine = {&b->cosine, stride},
                             .sine = {&b->sine, stride},
                             .scale = {&slots->scale[0][1], item},
                             .shape = {&slots->shape[0][1], item}};
    slots->pairs = (narc_pairs){.count = SLOTS, .other_bodies = &slots->b};
    slots->query = (narc_query){.margin = INFINITY, .dense = 1, .hints = {slots->hint, sizeof slots->hint[0]}};
    slots->batch.shapes = job->batch->shapes;
    slots->batch.a = &slots->a;
    slots->batch.b = &slots->b;
    slots->batch.pairs = &slots->pairs;
    slots->batch.query = &slots->query;
    slots->batch.first = 0;
    slots->batch.count = slots->batch.asked = SLOTS;
    slots->batch.manifolds = false;
}

/* Puts the pair in a slot where it is at its present time. */
static void place(struct slots *slots, size_t slot) {
    narc_cast *const cast = &slots->cast[slot];
    const double time = (double)cast->time;
    for (int side = 0; side < 2; side++) {
        narc_mover *const mover = side == 0 ? &cast->a : &cast->b;
        if (mover->angle == 0)
            continue;
        narc_turn_mover(mover, cast->time);
        slots->pose[slot][side].cosine = (float)mover->turned.x;
        slots->pose[slot][side].sine = (float)mover->turned.y;
    }
    slots->pose[slot][1].x = (float)(cast->x + time * cast->motion_x);
    slots->pose[slot][1].y = (float)(cast->y + time * cast->motion_y);
}

static void move_slot(struct slots *slots, size_t from, size_t to) {
    slots->cast[to] = slots->cast[from];
    slots->pair[to] = slots->pair[from];
    slots->hint[to] = slots->hint[from];
    for (int side = 0; side < 2; side++) {
        slots->pose[to][side] = slots->pose[from][side];
        slots->scale[to][side] = slots->scale[from][side];
        slots->shape[to][side] = slots->shape[from][side];
    }
}

/* ------------------------------------------------------------------------------------------------ one pair */

static float item_or(narc_float_column column, size_t item, float none) {
    return column.base ? narc_float_at(column, item) : none;
}

/* Reads a body of the set as the kernels would; false if it is broken, by their rules (base/bodies.inl). */
static bool read_body(const narc_shapes *shapes, const narc_bodies *set, size_t item, uint32_t shape, float angle,
                      struct pose *pose, float *out_scale, narc_mover *out) {
    const float c = narc_float_at(set->cosine, item), s = narc_float_at(set->sine, item), one = 1;
    const float error = (c * c + s * s) - one, scale = item_or(set->scale, item, 1);
    const double inverse = 1 - 0.5 * (double)error; /* Newton's step for the root, as the kernels' */
    pose->cosine = c;
    pose->sine = s;
    *out_scale = scale;
    out->header = &shapes->headers[shape];
    out->rotation = out->turned = (narc_point){inverse * (double)c, inverse * (double)s};
    out->scale = (double)scale;
    out->angle = (double)angle;
    const float size = scale * out->header->bound_radius;
    return fabsf(error) <= (float)NARC_ROTATION_TOLERANCE && size >= (float)NARC_MIN_SIZE &&
           size <= (float)NARC_MAX_BOUND_RADIUS && isfinite(angle);
}

/* The row that a pair's answer goes to. */
static narc_impact *find_row(const narc_cast_job *job, size_t pair) {
    return &job->rows[job->nearest ? narc_index_at(job->batch->pairs->a, pair) : pair];
}

/* Has its mover hit something before a time? */
static bool is_late(const narc_cast_job *job, size_t pair, float time) {
    const narc_impact *const row = find_row(job, pair);
    return job->nearest && row->count != NARC_CAST_MISS && row->fraction < time;
}

/* Writes the row of a pair, unless its mover hits another body before, or one with a lower number then. */
static void write_row(const narc_cast_job *job, size_t pair, int outcome, const narc_contact *c, float time) {
    narc_impact *const row = find_row(job, pair);
    const uint32_t body = (uint32_t)narc_find_side(job->batch, pair, 1).body;
    if (outcome == NARC_CAST_MISS) {
        if (!job->nearest)
            *row = (narc_impact){.pair = (uint32_t)pair};
        return;
    }
    if (is_late(job, pair, time) ||
        (job->nearest && row->count != NARC_CAST_MISS && row->fraction == time && row->body < body))
        return;
    *row = (narc_impact){.pair = job->nearest ? row->pair : (uint32_t)pair,
                         .body = body,
                         .feature = c->feature,
                         .count = (uint16_t)outcome,
                         .fraction = time,
                         .separation = c->separation,
                         .normal_x = c->normal_x,
                         .normal_y = c->normal_y,
                         .point_x = c->point_x,
                         .point_y = c->point_y,
                         .radius_a = c->radius_a,
                         .radius_b = c->radius_b};
}

/* Begins a pair in a slot. False if it is done at once: its circles never meet, or it has no answer. */
static bool begin_pair(const narc_cast_job *job, struct slots *slots, size_t slot, size_t pair, size_t *skipped) {
    const narc_batch *const batch = job->batch;
    const narc_bodies *const sets[2] = {batch->a, batch->b};
    const narc_index_column columns[2] = {batch->pairs->a, batch->pairs->b};
    narc_cast *const cast = &slots->cast[slot];
    size_t item[2];
    float motion[2][2];
    bool fine = true;
    for (int side = 0; side < 2; side++) {
        const struct narc_side body = narc_find_side(batch, pair, side);
        const narc_motions *const m = &job->motions[side];
        item[side] = columns[side].base ? narc_index_at(columns[side], pair) : pair;
        slots->shape[slot][side] = body.shape;
        fine &= read_body(batch->shapes, sets[side], item[side], body.shape, item_or(m->angle, body.body, 0),
                          &slots->pose[slot][side], &slots->scale[slot][side], side == 0 ? &cast->a : &cast->b);
        motion[side][0] = item_or(m->x, body.body, 0);
        motion[side][1] = item_or(m->y, body.body, 0);
    }
    cast->x = narc_position_at(batch->b->x, item[1]) - narc_position_at(batch->a->x, item[0]) +
              (double)item_or(batch->pairs->shift_x, pair, 0);
    cast->y = narc_position_at(batch->b->y, item[1]) - narc_position_at(batch->a->y, item[0]) +
              (double)item_or(batch->pairs->shift_y, pair, 0);
    cast->motion_x = (double)motion[1][0] - (double)motion[0][0];
    cast->motion_y = (double)motion[1][1] - (double)motion[0][1];
    cast->target = (double)job->target;
    fine = fine && fabs(cast->x) <= NARC_MAX_DISTANCE && fabs(cast->y) <= NARC_MAX_DISTANCE &&
           isfinite(cast->motion_x) && isfinite(cast->motion_y);
    *skipped += !fine;
    const int outcome = fine ? narc_begin_cast(cast, job->tolerance) : NARC_CAST_MISS;
    if (outcome == NARC_CAST_MISS || is_late(job, pair, cast->time)) {
        write_row(job, pair, NARC_CAST_MISS, NULL, 0);
        return false;
    }
    slots->pair[slot] = (uint32_t)pair;
    slots->hint[slot] = 0;
    slots->pose[slot][0].x = slots->pose[slot][0].y = 0;
    place(slots, slot);
    return true;
}

/* Takes the pair in a slot a step further. False if it is done. */
static bool advance_pair(const narc_cast_job *job, struct slots *slots, size_t slot, size_t *skipped) {
    narc_cast *const cast = &slots->cast[slot];
    const narc_contact *const contact = &slots->contact[slot];
    const int outcome = contact->count > 0 ? narc_advance_cast(job->batch->shapes, cast, contact) : (int)NARC_CAST_MISS;
    *skipped += contact->count == 0;
    if (outcome == NARC_CAST_GOES_ON && !is_late(job, slots->pair[slot], cast->back >= 0 ? cast->back : cast->time)) {
        place(slots, slot);
        return true;
    }
    write_row(job, slots->pair[slot], outcome == NARC_CAST_GOES_ON ? NARC_CAST_MISS : outcome, contact, cast->time);
    return false;
}

void narc_cast_range(narc_cast_job *job, size_t first, size_t end) {
    struct slots slots;
    size_t next = first, skipped = 0, unused = 0;
    open_slots(job, &slots);
    while (slots.count < SLOTS && next < end)
        slots.count += begin_pair(job, &slots, slots.count, next++, &skipped);
    while (slots.count > 0) {
        const narc_kernel_table *const kernels =
            slots.count <= FEW ? NARC_KERNELS_FOR_FEW(NARC_BUILT_scalar, job->kernels) : job->kernels;
        const narc_rows rows = {(char *)slots.contact, sizeof slots.contact[0]};
        kernels->contact(&slots.batch, 0, slots.count, &unused, &rows);
        for (size_t slot = slots.count; slot-- > 0;) {
            bool busy = advance_pair(job, &slots, slot, &skipped);
            while (!busy && next < end)
                busy = begin_pair(job, &slots, slot, next++, &skipped);
            if (!busy && --slots.count > slot)
                move_slot(&slots, slots.count, slot);
        }
    }
    atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_number(float number, const char *name, narc_error *error) {
    return isfinite(number)
               ? NARC_OK
               : narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)number, "options.%s is %g", name, (double)number);
}

narc_status narc_check_casts(const narc_motions *motions, const narc_motions *other_motions,
                             const narc_cast_options *options, narc_cast_job *out_job, narc_error *error) {
    static const narc_motions none = {.x = {0}};
    const narc_motions *const both[2] = {motions ? motions : &none, other_motions ? other_motions : &none};
    narc_status status = check_number(options->target, "target", error);
    if (status == NARC_OK)
        status = check_number(options->tolerance, "tolerance", error);
    if (status == NARC_OK && options->tolerance < 0)
        status = narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)options->tolerance,
                           "options.tolerance is %g, less than 0", (double)options->tolerance);
    if (status == NARC_OK)
        status = narc_check_reserved(options->reserved, 4, "options", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[0]->reserved, 2, "motions", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[1]->reserved, 2, "other_motions", error);
    *out_job =
        (narc_cast_job){.motions = {*both[0], *both[1]}, .target = options->target, .tolerance = options->tolerance};
    return status;
}

static void cast_part(void *argument, size_t part, size_t first, size_t end) {
    (void)part;
    narc_cast_range(argument, first, end);
}

narc_status narc_cast_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                            const narc_pairs *pairs, const narc_motions *other_motions,
                            const narc_cast_options *options, narc_impact *out_rows, size_t capacity,
                            narc_error *error) {
    static const narc_cast_options defaults = {0};
    const narc_cast_options *const o = options ? options : &defaults;
    const narc_query query = {.workers = o->workers};
    narc_batch batch;
    narc_cast_job job;
    narc_status status = narc_check_casts(motions, other_motions, o, &job, error);
    if (status == NARC_OK)
        status = narc_begin_batch(shapes, bodies, pairs, &query, &batch, error);
    if (status != NARC_OK)
        return status;
    if (!pairs->other_bodies && other_motions)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "other_motions is not NULL, but there are no other bodies");
    if (pairs->count > 0 && !out_rows)
        return narc_fail_missing(error, "out_rows");
    if (capacity < pairs->count)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)pairs->count, "%zu rows, but there is room for %zu",
                         pairs->count, capacity);
    if (!pairs->other_bodies)
        job.motions[1] = job.motions[0];
    job.batch = &batch;
    job.rows = out_rows;
    job.kernels = narc_kernels(&status, error);
    if (!job.kernels)
        return status;
    narc_run_ranges(o->workers, pairs->count, PART, cast_part, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return NARC_OK;
}
