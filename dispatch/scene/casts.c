/* SPDX-License-Identifier: MIT
 *
 * casts.c - narc_cast_pairs(): argument checks, then pairs part by part. Of a part some pairs are under way at a time,
 * each in a slot: all of them are placed at their present times, the contact kernel finds what there is between them,
 * and each goes on or makes room for the next pair (kernels/scene/casts.c). So vectors are full until a part ends.
 */
#include <math.h>

#include "casts.h"
#include "column.h"
#include "error.h"

/* Pairs in a part. */
enum { PART = 1024 };

/* So few are asked for of the kernels with one lane; see api.c. */
enum { FEW = 2 };

struct slots {
    size_t count;
    uint32_t pair[NARC_CAST_SLOTS], hint[NARC_CAST_SLOTS];
    narc_bodies a, b;
    narc_pairs pairs;
    narc_query query;
    narc_batch batch;
    narc_casts casts;
};

/* ------------------------------------------------------------------------------------------------ slots */

/* What the contact kernel reads of a body: poses in the form that is read fastest. */
static void view_side(const narc_casts *casts, int side, narc_bodies *out) {
    const float *const pose = casts->pose[side][0];
    const struct narc_cast_side *const of = &casts->side[side];
    const ptrdiff_t stride = sizeof casts->pose[side][0], item = sizeof(float);
    out->count = NARC_CAST_SLOTS;
    out->x = (narc_position_column){pose, stride, NARC_FLOAT32};
    out->y = (narc_position_column){pose + 1, stride, NARC_FLOAT32};
    out->cosine = (narc_float_column){pose + 2, stride};
    out->sine = (narc_float_column){pose + 3, stride};
    out->scale = (narc_float_column){of->scale, item};
    out->shape = (narc_index_column){of->shape, item};
}

static void open_slots(const narc_cast_job *job, struct slots *slots) {
    static const narc_pairs pairs = {.count = NARC_CAST_SLOTS};
    static const narc_query query = {.margin = INFINITY, .dense = 1};
    slots->count = 0;
    view_side(&slots->casts, 0, &slots->a);
    view_side(&slots->casts, 1, &slots->b);
    slots->pairs = pairs;
    slots->pairs.other_bodies = &slots->b;
    slots->query = query;
    slots->query.hints = (narc_hint_column){slots->hint, sizeof slots->hint[0]};
    slots->batch.shapes = job->batch->shapes;
    slots->batch.a = &slots->a;
    slots->batch.b = &slots->b;
    slots->batch.pairs = &slots->pairs;
    slots->batch.query = &slots->query;
    slots->batch.first = 0;
    slots->batch.count = slots->batch.asked = NARC_CAST_SLOTS;
    slots->batch.whole = true;
    slots->casts.tolerance = job->tolerance;
    slots->casts.front_only = job->front_only;
}

static void move_slot(struct slots *slots, size_t from, size_t to) {
    narc_casts *const c = &slots->casts;
    slots->pair[to] = slots->pair[from];
    slots->hint[to] = slots->hint[from];
    for (int k = 0; k < 2; k++) {
        struct narc_cast_side *const side = &c->side[k];
        side->shape[to] = side->shape[from];
        side->cosine[to] = side->cosine[from];
        side->sine[to] = side->sine[from];
        side->scale[to] = side->scale[from];
        side->angle[to] = side->angle[from];
        side->lever[to] = side->lever[from];
    }
    c->x[to] = c->x[from];
    c->y[to] = c->y[from];
    c->motion_x[to] = c->motion_x[from];
    c->motion_y[to] = c->motion_y[from];
    c->target[to] = c->target[from];
    c->end[to] = c->end[from];
    c->enough[to] = c->enough[from];
    c->turning[to] = c->turning[from];
    c->time[to] = c->time[from];
    c->back[to] = c->back[from];
    c->rounds[to] = c->rounds[from];
}

/* ------------------------------------------------------------------------------------------------ rows */

/* The row that a pair's answer goes to. */
static narc_impact *find_row(const narc_cast_job *job, size_t pair) {
    return &job->rows[job->nearest ? narc_index_at(job->batch->pairs->a, pair) : pair];
}

/* Has its mover hit something before a time? */
static bool is_late(const narc_cast_job *job, size_t pair, float time) {
    if (!job->nearest)
        return false;
    const narc_impact *const row = find_row(job, pair);
    return row->count != NARC_CAST_MISS && row->fraction < time;
}

static void write_miss(const narc_cast_job *job, size_t pair) {
    if (!job->nearest)
        job->rows[pair] = (narc_impact){.pair = (uint32_t)pair};
}

/* The number of a pair's A or B in its set; bodies 2 k and 2 k + 1 if the pairs bring their own (check.c). */
static size_t find_body(const narc_cast_job *job, int side, size_t pair) {
    const narc_pairs *const pairs = job->batch->pairs;
    const narc_index_column column = side ? pairs->b : pairs->a;
    const bool own = !pairs->a.base && !pairs->b.base && !pairs->other_bodies;
    return own ? 2 * pair + (size_t)side : column.base ? narc_index_at(column, pair) : pair;
}

/* Writes the row of a pair, unless its mover hits another body before, or one with a lower number then. */
static void write_row(const narc_cast_job *job, const struct slots *slots, size_t slot, int outcome) {
    const narc_contact *const c = &slots->casts.contact[slot];
    const size_t pair = slots->pair[slot];
    const uint32_t body = (uint32_t)find_body(job, 1, pair);
    const float time = slots->casts.time[slot];
    narc_impact *const row = find_row(job, pair);
    if (job->nearest && row->count != NARC_CAST_MISS &&
        (row->fraction < time || (row->fraction == time && row->body < body)))
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

/* ------------------------------------------------------------------------------------------------ pairs */

/* Copies what the caller says of a pair. */
static void load_pair(const narc_cast_job *job, struct slots *slots, size_t slot, size_t pair) {
    const narc_batch *const batch = job->batch;
    const narc_pairs *const pairs = batch->pairs;
    const narc_bodies *const sets[2] = {batch->a, batch->b};
    const narc_index_column columns[2] = {pairs->a, pairs->b};
    narc_casts *const casts = &slots->casts;
    size_t item[2];
    double motion_x[2], motion_y[2];
    for (int k = 0; k < 2; k++) {
        const narc_motions *const m = &job->motions[k];
        struct narc_cast_side *const side = &casts->side[k];
        item[k] = columns[k].base ? narc_index_at(columns[k], pair) : pair;
        const size_t body = find_body(job, k, pair);
        side->shape[slot] = narc_index_at(sets[k]->shape, item[k]);
        side->cosine[slot] = narc_float_at(sets[k]->cosine, item[k]);
        side->sine[slot] = narc_float_at(sets[k]->sine, item[k]);
        side->scale[slot] = narc_float_or(sets[k]->scale, item[k], 1);
        side->angle[slot] = narc_float_or(m->angle, body, 0);
        motion_x[k] = (double)narc_float_or(m->x, body, 0);
        motion_y[k] = (double)narc_float_or(m->y, body, 0);
    }
    casts->x[slot] = narc_position_at(sets[1]->x, item[1]) - narc_position_at(sets[0]->x, item[0]) +
                     (double)narc_float_or(pairs->shift_x, pair, 0);
    casts->y[slot] = narc_position_at(sets[1]->y, item[1]) - narc_position_at(sets[0]->y, item[0]) +
                     (double)narc_float_or(pairs->shift_y, pair, 0);
    casts->motion_x[slot] = motion_x[1] - motion_x[0];
    casts->motion_y[slot] = motion_y[1] - motion_y[0];
    casts->target[slot] = narc_float_or(job->targets, job->nearest ? item[0] : pair, job->target);
    slots->pair[slot] = (uint32_t)pair;
    slots->hint[slot] = 0;
}

/* The shape of a side. */
static const narc_shape_header *find_header(const narc_cast_job *job, const struct slots *slots, size_t slot,
                                            int side) {
    return &job->batch->shapes->headers[slots->casts.side[side].shape[slot]];
}

/* Is there a concave arc? Such pairs are cast one by one. */
static bool has_concave_arc(const narc_cast_job *job, const struct slots *slots, size_t slot) {
    return narc_is_concave(find_header(job, slots, slot, 0)) || narc_is_concave(find_header(job, slots, slot, 1));
}

/* Casts a pair alone, from where it is. */
static int cast_alone(const narc_cast_job *job, struct slots *slots, size_t slot) {
#if NARC_PIECES
    return job->kernels->piece(job->batch->shapes, &slots->casts, slot);
#else
    (void)job, (void)slots, (void)slot;
    return NARC_CAST_MISS;
#endif
}

/* Is what touches a piece's front for certain? Else it may be a run's closure, or behind a piece: where it has been
 * from the start, or is to be so deep. */
static bool is_in_front(const narc_cast_job *job, const struct slots *slots, size_t slot) {
    const narc_shape_header *const a = find_header(job, slots, slot, 0), *const b = find_header(job, slots, slot, 1);
    const narc_contact *const c = &slots->casts.contact[slot];
    const bool starts = !(slots->casts.time[slot] > 0),
               deep = c->separation < 0 && (starts || slots->casts.target[slot] < 0);
    return narc_touches(a, c->feature & 0xff) && narc_touches(b, c->feature >> 8) &&
           !(deep && (narc_is_piece(a) || narc_is_piece(b)));
}

static void end_pair(const narc_cast_job *job, const struct slots *slots, size_t slot, int outcome) {
    if (outcome == NARC_CAST_HIT || outcome == NARC_CAST_UNFINISHED)
        write_row(job, slots, slot, outcome);
    else
        write_miss(job, slots->pair[slot]);
}

static const narc_kernel_table *choose_kernels(const narc_cast_job *job, size_t count) {
    return count <= FEW ? NARC_KERNELS_FOR_FEW(NARC_BUILT_scalar, job->kernels) : job->kernels;
}

/* Begins pairs next ... end - 1 in free slots; those whose circles never meet, or that have no answer, are done.
 * Returns which pair is next. */
static size_t begin_pairs(const narc_cast_job *job, struct slots *slots, size_t next, size_t end, size_t *skipped) {
    while (slots->count < NARC_CAST_SLOTS && next < end) {
        const size_t first = slots->count, room = NARC_CAST_SLOTS - first,
                     count = end - next < room ? end - next : room;
        for (size_t k = 0; k < count; k++)
            load_pair(job, slots, first + k, next + k);
        next += count;
        choose_kernels(job, count)->begin(job->batch->shapes, &slots->casts, first, first + count);
        for (size_t slot = first; slot < first + count; slot++) {
            const int outcome = slots->casts.outcome[slot];
            *skipped += outcome == NARC_CAST_BROKEN;
            if (outcome == NARC_CAST_GOES_ON && has_concave_arc(job, slots, slot))
                end_pair(job, slots, slot, cast_alone(job, slots, slot));
            else if (outcome != NARC_CAST_GOES_ON || is_late(job, slots->pair[slot], slots->casts.time[slot]))
                write_miss(job, slots->pair[slot]);
            else if (slots->count++ < slot)
                move_slot(slots, slot, slots->count - 1);
        }
    }
    return next;
}

/* Takes all pairs under way a step further. Those that are done make room. */
static void advance_pairs(const narc_cast_job *job, struct slots *slots, size_t *skipped) {
    const narc_kernel_table *const kernels = choose_kernels(job, slots->count);
    const bool pieces = NARC_PIECES && job->batch->shapes->piece_count > 0;
    size_t unused = 0;
    const narc_rows rows = {
        .base = (char *)slots->casts.contact, .stride = sizeof slots->casts.contact[0], .further = &unused};
    kernels->place(&slots->casts, slots->count);
    kernels->contact(&slots->batch, 0, slots->count, &unused, &rows);
    kernels->advance(job->batch->shapes, &slots->casts, slots->count);
    for (size_t slot = slots->count; slot-- > 0;) {
        const narc_casts *const c = &slots->casts;
        const bool broken = c->contact[slot].count == 0;
        const bool goes_alone = pieces && c->outcome[slot] == NARC_CAST_HIT && !is_in_front(job, slots, slot);
        const int outcome = broken ? NARC_CAST_MISS : goes_alone ? cast_alone(job, slots, slot) : c->outcome[slot];
        const size_t pair = slots->pair[slot];
        *skipped += broken;
        if (outcome == NARC_CAST_GOES_ON && !is_late(job, pair, c->back[slot] >= 0 ? c->back[slot] : c->time[slot]))
            continue;
        end_pair(job, slots, slot, outcome);
        if (--slots->count > slot)
            move_slot(slots, slots->count, slot);
    }
}

void narc_cast_range(narc_cast_job *job, size_t first, size_t end) {
    struct slots slots;
    size_t next = first, skipped = 0;
    open_slots(job, &slots);
    do {
        next = begin_pairs(job, &slots, next, end, &skipped);
        if (slots.count > 0)
            advance_pairs(job, &slots, &skipped);
    } while (slots.count > 0 || next < end);
    atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_number(float number, const char *name, narc_error *error) {
    return isfinite(number)
               ? NARC_OK
               : narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)number, "options.%s is %g", name, (double)number);
}

narc_status narc_check_targets(const narc_cast_job *job, size_t count, narc_error *error) {
    for (size_t k = 0; job->targets.base && k < count; k++) {
        const double target = (double)narc_float_at(job->targets, k);
        if (!isfinite(target))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, k, target, "options.targets[%zu] is %g", k, target);
    }
    return NARC_OK;
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
        status = narc_check_reserved(options->reserved, 1, "options", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[0]->reserved, 2, "motions", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[1]->reserved, 2, "other_motions", error);
    *out_job = (narc_cast_job){.motions = {*both[0], *both[1]},
                               .target = options->target,
                               .tolerance = options->tolerance,
                               .targets = options->targets,
                               .front_only = options->front_only != 0};
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
    status = narc_check_targets(&job, pairs->count, error);
    if (status != NARC_OK)
        return status;
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
