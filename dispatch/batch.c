/* SPDX-License-Identifier: MIT
 *
 * batch.c - runs a batch, part by part: in the calling thread, or by workers.
 *
 * Parts are ranges of pairs, and each pair's answer depends on that pair alone, so the bytes of the result are the same
 * for any workers. A part's rows are written to the place of its first pair, as if every pair had a row; when all parts
 * before it are in their final place, they are moved to the end of these. No part waits for that: it is done by whoever
 * ends a part and finds it due, for those behind it that have ended, too.
 */
#include "compiler.h"
#include "dispatch.h"
#include "error.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

/* Pairs in a part of overlaps, multiples of 64: as many as possible, because at the end of a part the kernel decides
 * the rest of its pairs in vectors that are not full, but several for each worker, so that all end together. */
enum { MOST_OVERLAPS = 16384, LEAST_OVERLAPS = 1024, PARTS_PER_WORKER = 4 };

/* Parts of rows are at most that many, so that what is known of them has room on the stack. */
enum { MOST_PARTS = 64 };

/* Where there is room for fewer rows, so many pairs are answered apart. */
enum { APART = 16 };

struct job {
    const narc_batch *batch;
    size_t first, count, part_size;
    atomic_size_t skipped, more;

    narc_overlap_kernel *overlap;
    uint64_t *bits;

    narc_row_kernel *kernel;
    size_t row_size;
    narc_rows rows;                  /* of dense ones the first is the batch's, else that of `first` */
    atomic_flag closing;             /* does someone move rows? */
    atomic_size_t due;               /* the part to move next */
    size_t found;                    /* rows in their final place; of who moves them */
    atomic_size_t ended[MOST_PARTS]; /* how many rows a part has and 1; 0: it has not ended */
};

static size_t size_of_part(const struct job *job, size_t part) {
    const size_t left = job->count - part * job->part_size;
    return left < job->part_size ? left : job->part_size;
}

/* ------------------------------------------------------------------------------------------------ overlaps */

static void find_part_of_overlaps(void *argument, size_t part) {
    struct job *const job = argument;
    size_t skipped = 0;
    const size_t start = job->first + part * job->part_size;
    job->overlap(job->batch, start, size_of_part(job, part), &skipped, job->bits + start / 64);
    atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

/* Several workers; returns how many pairs were skipped. */
static size_t share_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, uint64_t *out_bits) {
    const size_t count = batch->count, workers = batch->query->workers->count;
    const size_t even = count / (workers * PARTS_PER_WORKER) / 64 * 64;
    struct job job = {.batch = batch, .first = batch->first, .count = count, .overlap = kernel, .bits = out_bits};
    job.part_size = even < LEAST_OVERLAPS ? LEAST_OVERLAPS : even > MOST_OVERLAPS ? MOST_OVERLAPS : even;
    narc_run_parts(batch->query->workers, (count - 1) / job.part_size + 1, find_part_of_overlaps, &job);
    return atomic_load(&job.skipped);
}

narc_status narc_answer_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, uint64_t *out_bits,
                                 narc_error *error) {
    const narc_query *query = batch->query;
    const size_t first = batch->first, count = batch->count;
    if (count > 0 && (first % 64 != 0 || (count % 64 != 0 && first + count != batch->asked)))
        return narc_fail(error, NARC_ERROR_ARGUMENT, first, (double)count,
                         "pairs %zu and the %zu from there on do not begin and end at multiples of 64", first, count);
    if (count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    size_t skipped = 0;
    if (count > 0 && narc_count_workers(query->workers, count / LEAST_OVERLAPS) <= 1)
        kernel(batch, first, count, &skipped, out_bits + first / 64);
    else if (count > 0)
        skipped = share_overlaps(kernel, batch, out_bits);
    if (query->out_skipped)
        *query->out_skipped = skipped;
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ rows */

/* What kernels count beside rows: pairs without an answer, and rows beyond their pair's first one. */
struct counts {
    size_t skipped, more;
};

static char *find_row(const narc_rows *rows, size_t row) { return rows->base + (ptrdiff_t)row * rows->stride; }

/* Moves rows to an earlier place; what lies between them stays. */
static void move_rows(const struct job *job, size_t to, size_t from, size_t count) {
    if (to == from)
        return;
    if (job->rows.stride == (ptrdiff_t)job->row_size) {
        memmove(find_row(&job->rows, to), find_row(&job->rows, from), count * job->row_size);
        return;
    }
    for (size_t k = 0; k < count; k++)
        memcpy(find_row(&job->rows, to + k), find_row(&job->rows, from + k), job->row_size);
}

/* Moves the rows of all parts that are due. Of several threads one does it; one that ends a part while another is at it
 * leaves it to that one, which looks again after it has let go. */
NOINLINE void close_gaps(struct job *job, size_t parts) {
    size_t due = atomic_load(&job->due);
    while (due < parts && atomic_load(&job->ended[due]) && !atomic_flag_test_and_set(&job->closing)) {
        for (due = atomic_load(&job->due); due < parts && atomic_load(&job->ended[due]); due++) {
            const size_t count = atomic_load(&job->ended[due]) - 1;
            move_rows(job, job->found, due * job->part_size, count);
            job->found += count;
        }
        atomic_store(&job->due, due);
        atomic_flag_clear(&job->closing);
    }
}

/* Answers a few pairs where there is room for `room` rows only. Not inlined: the others need no room for these. */
NOINLINE size_t list_apart(const struct job *job, size_t first, size_t count, char *to, size_t room,
                           struct counts *counts) {
    _Alignas(16) char rows[APART * sizeof(narc_manifold)];
    const narc_rows apart = {.base = rows, .stride = (ptrdiff_t)job->row_size, .more = &counts->more};
    const size_t found = job->kernel(job->batch, first, count, &counts->skipped, &apart);
    for (size_t k = 0; k < found && k < room; k++)
        memcpy(to + (ptrdiff_t)k * job->rows.stride, find_row(&apart, k), job->row_size);
    return found;
}

/* Finds the rows of `count` pairs from the job's pair `start` on, group by group, and lists them behind each other from
 * row `start` on, as far as there is room. Returns how many there are. */
static size_t list_rows(const struct job *job, size_t start, size_t count, size_t room, struct counts *counts) {
    const bool dense = job->batch->query->dense != 0;
    size_t found = 0;
    for (size_t k = 0, group; k < count; k += group) {
        const size_t left = count - k, free = found < room ? room - found : 0;
        const bool direct = dense || free >= left || free >= APART;
        narc_rows to = job->rows;
        to.more = &counts->more;
        if (!dense && free > 0)
            to.base = find_row(&to, start + found);
        group = direct ? NARC_ROW_GROUP : APART;
        group = left < group ? left : group;
        if (direct && !dense && free < group)
            group = free;
        found += direct ? job->kernel(job->batch, job->first + start + k, group, &counts->skipped, &to)
                        : list_apart(job, job->first + start + k, group, to.base, free, counts);
    }
    return found;
}

static void find_part_of_rows(void *argument, size_t part) {
    struct job *const job = argument;
    struct counts counts = {0, 0};
    const size_t count = size_of_part(job, part);
    const size_t found = list_rows(job, part * job->part_size, count, count, &counts);
    atomic_fetch_add_explicit(&job->skipped, counts.skipped, memory_order_relaxed);
    atomic_fetch_add_explicit(&job->more, counts.more, memory_order_relaxed);
    atomic_store(&job->ended[part], found + 1);
    if (!job->batch->query->dense)
        close_gaps(job, (job->count - 1) / job->part_size + 1);
}

/* The same by several workers, with room for as many rows as there are pairs. */
static size_t share_rows(struct job *job, struct counts *counts) {
    const size_t groups = (job->count - 1) / NARC_ROW_GROUP + 1;
    job->part_size = ((groups - 1) / MOST_PARTS + 1) * NARC_ROW_GROUP;
    const size_t parts = (job->count - 1) / job->part_size + 1;
    atomic_init(&job->skipped, 0);
    atomic_init(&job->more, 0);
    atomic_init(&job->due, 0);
    job->found = 0;
    atomic_flag_clear(&job->closing);
    for (size_t part = 0; part < parts; part++)
        atomic_init(&job->ended[part], 0);
    narc_run_parts(job->batch->query->workers, parts, find_part_of_rows, job);
    counts->skipped += atomic_load(&job->skipped);
    counts->more += atomic_load(&job->more);
    for (size_t part = 0; part < parts && job->batch->query->dense; part++)
        job->found += atomic_load(&job->ended[part]) - 1;
    return job->found;
}

/* Is there room for the rows, and is it used as it may be? */
static narc_status check_rows(const narc_batch *batch, const narc_rows *rows, size_t size, size_t capacity,
                              const size_t *out_count, narc_error *error) {
    const narc_query *query = batch->query;
    const size_t end = query->selection.base ? batch->pairs->count : batch->first + batch->count;
    const ptrdiff_t stride = rows->stride;
    if (!out_count || (!rows->base && capacity > 0))
        return narc_fail_missing(error, !out_count ? "out_count" : "out_rows");
    if (stride % 4 != 0 || (stride < (ptrdiff_t)size && stride > -(ptrdiff_t)size))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)stride,
                         "query.row_stride is %lld, not a multiple of 4 with room for %zu bytes", (long long)stride,
                         size);
    if (query->dense && batch->count > 0 && capacity < end)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)end, "%zu dense rows, but there is room for %zu", end,
                         capacity);
    return NARC_OK;
}

/* The rows of a batch with more than one group of pairs, or with little room. Workers take so many pairs at a time as
 * there is room for; where that is little, this thread takes them. */
NOINLINE size_t list_all(narc_row_kernel *kernel, const narc_batch *batch, size_t row_size, const narc_rows *rows,
                         size_t capacity, struct counts *counts) {
    const narc_query *query = batch->query;
    const size_t end = batch->first + batch->count;
    size_t found = 0;
    struct job job; /* most of it is for workers */
    job.batch = batch;
    job.kernel = kernel;
    job.row_size = row_size;
    job.rows = *rows;
    for (job.first = batch->first; job.first < end; job.first += job.count) {
        const size_t left = end - job.first, room = query->dense ? left : found < capacity ? capacity - found : 0;
        job.count = left < room ? left : room;
        const bool shared = narc_count_workers(query->workers, (job.count + NARC_ROW_GROUP - 1) / NARC_ROW_GROUP) > 1;
        if (!query->dense && room > 0)
            job.rows.base = find_row(rows, found);
        if (!shared)
            job.count = left;
        found += shared ? share_rows(&job, counts) : list_rows(&job, 0, left, room, counts);
    }
    return found;
}

/* What a row's count says of its pair: how many rows there are besides. */
static size_t get_more(const narc_batch *batch, const char *row) { return (unsigned char)row[batch->more_at]; }

/* Pairs all of whose rows are wanted, at least two each, and from where on. */
struct wanted {
    uint32_t pair[NARC_MAX_ARCS / 2];
    narc_row_list list[NARC_MAX_ARCS / 2];
    size_t to[NARC_MAX_ARCS / 2];
    size_t count, rows;
};

/* Lists all rows of the wanted pairs, as far as there is room. */
NOINLINE void list_wanted(narc_row_kernel *kernel, const narc_batch *batch, size_t row_size, struct wanted *wanted,
                          const narc_rows *rows, size_t capacity) {
    _Alignas(16) char all[NARC_MAX_ARCS * sizeof(narc_manifold)];
    size_t skipped = 0, more = 0;
    narc_query query = *batch->query;
    query.selection = (narc_index_column){wanted->pair, sizeof *wanted->pair};
    narc_batch some = *batch;
    some.query = &query;
    const narc_rows apart = {all, (ptrdiff_t)row_size, &more, wanted->list};
    if (wanted->count > 0)
        kernel(&some, 0, wanted->count, &skipped, &apart);
    for (size_t i = 0; i < wanted->count; i++)
        for (size_t k = 0; k < wanted->list[i].count && wanted->to[i] + k < capacity; k++)
            memcpy(find_row(rows, wanted->to[i] + k), find_row(&apart, wanted->list[i].first + k), row_size);
    wanted->count = wanted->rows = 0;
}

/* Where pairs with concave arcs have several rows, the deepest one is there, of `count` rows: lists the others, from
 * the last pair on. What has no room is left out. */
NOINLINE void list_more(narc_row_kernel *kernel, const narc_batch *batch, size_t row_size, const narc_rows *rows,
                        size_t count, size_t capacity) {
    struct wanted wanted = {.count = 0};
    size_t to = count;
    for (size_t k = 0; k < count; k++)
        to += get_more(batch, find_row(rows, k));
    size_t k = count;
    while (to > k) {
        char *const row = find_row(rows, --k);
        const size_t own = get_more(batch, row) + 1;
        to -= own;
        if (own == 1 && to < capacity)
            memcpy(find_row(rows, to), row, row_size);
        if (own == 1)
            continue;
        if (wanted.rows + own > NARC_MAX_ARCS)
            list_wanted(kernel, batch, row_size, &wanted, rows, capacity);
        memcpy(&wanted.pair[wanted.count], row, sizeof(uint32_t));
        wanted.list[wanted.count] = (narc_row_list){.first = (uint32_t)wanted.rows, .room = (uint32_t)own};
        wanted.to[wanted.count++] = to;
        wanted.rows += own;
    }
    list_wanted(kernel, batch, row_size, &wanted, rows, capacity);
}

narc_status narc_answer_rows(narc_row_kernel *kernel, const narc_batch *batch, void *out_rows, size_t capacity,
                             size_t *out_count, narc_error *error) {
    const narc_query *query = batch->query;
    const size_t row_size = batch->row_size;
    struct counts counts = {0, 0};
    const narc_rows rows = {
        .base = out_rows, .stride = query->row_stride ? query->row_stride : (ptrdiff_t)row_size, .more = &counts.more};
    const narc_status status = check_rows(batch, &rows, row_size, capacity, out_count, error);
    if (status != NARC_OK)
        return status;
    size_t found = 0;
    if (batch->count <= NARC_ROW_GROUP && batch->count <= capacity)
        found = batch->count > 0 ? kernel(batch, batch->first, batch->count, &counts.skipped, &rows) : 0;
    else
        found = list_all(kernel, batch, row_size, &rows, capacity, &counts);
    if (NARC_PIECES && counts.more > 0 && !query->dense) {
        list_more(kernel, batch, row_size, &rows, found < capacity ? found : capacity, capacity);
        found += counts.more;
    }
    if (query->out_skipped)
        *query->out_skipped = counts.skipped;
    *out_count = found;
    if (found > capacity)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)found, "%zu rows, but there is room for %zu", found,
                         capacity);
    return NARC_OK;
}
