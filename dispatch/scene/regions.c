/* SPDX-License-Identifier: MIT
 *
 * regions.c - narc_query_index(): a walk for each query, then the bodies of each into order and their pairs into rows.
 *
 * Nobody knows before the walks how many bodies there are. They go to memory that tasks take in chunks; a query's own
 * lie next to each other. If there is too little, the rest is only counted, and all is done again with more.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "index.h"

#include <stdatomic.h>
#include <string.h>

/* Queries that a task takes at a time, and bodies of a chunk. */
enum { QUERIES = 64, CHUNK = 4096 };

/* The walks of a call, and what its tasks share. */
typedef struct search {
    narc_region_batch batch;
    narc_index *index;
    const narc_kernel_table *kernels;
    size_t count;
    atomic_size_t next_query, taken; /* taken: of the memory for bodies */
    atomic_uint_least64_t total;     /* bodies that are found */
    atomic_bool full;                /* some were only counted */
} search;

/* Of a task: what the kernel writes to, first; and bodies that are only counted. */
typedef struct own_bodies {
    narc_found_bodies out;
    search *search;
    size_t query;
    uint64_t lost, total; /* of this query; of all */
    uint32_t spare[NARC_REGION_ROOM];
} own_bodies;

/* The bodies of the present query move to a larger chunk, so that they are moved a few times at most. */
static void get_room(narc_found_bodies *out) {
    own_bodies *const own = (own_bodies *)out;
    search *const s = own->search;
    const size_t wanted = CHUNK + 4 * out->count;
    if (out->body != own->spare) {
        const size_t at = atomic_fetch_add_explicit(&s->taken, wanted, memory_order_relaxed);
        if (at <= s->index->found_capacity && wanted <= s->index->found_capacity - at) {
            memcpy(s->index->found + at, out->body, out->count * sizeof *out->body);
            out->body = s->index->found + at;
            out->room = wanted;
            return;
        }
        atomic_store_explicit(&s->full, true, memory_order_relaxed);
    }
    own->lost += out->count;
    out->body = own->spare;
    out->count = 0;
    out->room = NARC_REGION_ROOM;
}

static void end_query(narc_found_bodies *out) {
    own_bodies *const own = (own_bodies *)out;
    const uint64_t count = own->lost + out->count;
    const size_t first = count > 0 && out->body != own->spare ? (size_t)(out->body - own->search->index->found) : 0;
    own->search->index->regions[own->query++] = (narc_region){first, (uint32_t)count, 0};
    own->total += count;
    own->lost = 0;
    if (out->body != own->spare) {
        out->body += out->count;
        out->room -= out->count;
    }
    out->count = 0;
}

/* One task: walks for queries that no other does, until there are too many pairs. */
static void walk_some(void *argument, size_t task) {
    search *const s = argument;
    own_bodies own = {.out = {.body = s->index->found, .get_room = get_room, .end_query = end_query}, .search = s};
    (void)task;
    for (size_t first; (first = atomic_fetch_add_explicit(&s->next_query, QUERIES, memory_order_relaxed)) < s->count;) {
        own.query = first;
        own.total = 0;
        s->kernels->regions(&s->batch, first, s->count - first < QUERIES ? s->count - first : QUERIES, &own.out);
        const uint64_t before = atomic_fetch_add_explicit(&s->total, own.total, memory_order_relaxed);
        if (before + own.total > UINT32_MAX)
            return;
    }
}

/* Walks for all queries, until all that is found has had room. */
static narc_status walk_all(search *s, const narc_workers *workers, uint64_t *out_total, narc_error *error) {
    const size_t tasks = narc_count_workers(workers, s->count / QUERIES + 1);
    uint64_t wanted = tasks * CHUNK;
    for (;;) {
        if (wanted > SIZE_MAX || narc_reserve_found(s->index, (size_t)wanted) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)wanted, "no memory for the bodies of %zu queries",
                             s->count);
        atomic_store(&s->next_query, 0);
        atomic_store(&s->taken, 0);
        atomic_store(&s->total, 0);
        atomic_store(&s->full, false);
        narc_run_parts(workers, tasks, walk_some, s);
        *out_total = atomic_load(&s->total);
        if (*out_total > UINT32_MAX)
            return narc_fail(error, NARC_ERROR_COUNT, 0, (double)*out_total, "2^32 pairs or more of %zu queries",
                             s->count);
        if (!atomic_load(&s->full))
            return NARC_OK;
        wanted = 2 * (uint64_t)s->index->found_capacity;
        wanted = wanted < 2 * *out_total + tasks * CHUNK ? 2 * *out_total + tasks * CHUNK : wanted;
    }
}

/* ------------------------------------------------------------------------------------------------ rows */

/* Sorts bodies by their digits, the lowest first, to `out`, by way of `spare`. The bodies are not written: another worker's
   kernel may read some of them behind those of its own query. */
static void sort_bodies(const uint32_t *bodies, size_t count, size_t limit, uint32_t *spare, uint32_t *out) {
    enum { BITS = 8, DIGITS = 1 << BITS };
    int passes = 1;
    while (passes < 4 && limit >> (passes * BITS) > 0)
        passes++;
    const uint32_t *from = bodies;
    for (int pass = 0; pass < passes; pass++) {
        uint32_t *const to = (passes - pass) % 2 ? out : spare;
        const int shift = pass * BITS;
        uint32_t place[DIGITS] = {0};
        for (size_t k = 0; k < count; k++)
            place[from[k] >> shift & (DIGITS - 1)]++;
        narc_begin_places(place, DIGITS, 0, 1);
        for (size_t k = 0; k < count; k++)
            to[place[from[k] >> shift & (DIGITS - 1)]++] = from[k];
        from = to;
    }
}

static void list_part(void *argument, size_t part, size_t first, size_t end) {
    const search *const s = argument;
    const narc_index *const index = s->index;
    uint32_t *const a = index->rows, *const b = index->rows + index->row_capacity;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const narc_region region = index->regions[k];
        const uint32_t *const bodies = index->found + region.first;
        if (region.count > NARC_ORDER_BODIES)
            sort_bodies(bodies, region.count, index->count, a + region.row, b + region.row);
        else if (region.count > 0)
            s->kernels->order(bodies, region.count, b + region.row);
        for (size_t i = 0; i < region.count; i++)
            a[region.row + i] = (uint32_t)k;
    }
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_arguments(const narc_index *index, const narc_box *boxes, size_t count,
                                   const narc_index_query *query, const narc_pairs *out_pairs, narc_error *error) {
    if (!index || (!boxes && count > 0) || !out_pairs)
        return narc_fail_missing(error, !index ? "index" : !out_pairs ? "out_pairs" : "boxes");
    const narc_status status = narc_check_count(count, UINT32_MAX - 1, "queries in one call", error);
    return status == NARC_OK ? narc_check_search(index, query, "query", error) : status;
}

narc_status narc_query_index(narc_index *index, const narc_box *boxes, size_t count, const narc_index_query *query,
                             narc_pairs *out_pairs, narc_error *error) {
    static const narc_index_query defaults = {0};
    const narc_index_query *const q = query ? query : &defaults;
    narc_status status = check_arguments(index, boxes, count, q, out_pairs, error);
    search s = {.batch = {index, boxes, q}, .index = index, .count = count};
    uint64_t total = 0;
    if (status == NARC_OK && !(s.kernels = narc_kernels(&status, error)))
        return status;
    if (status == NARC_OK && count > 0 && index->count > 0) {
        status = narc_reserve_regions(index, count);
        if (status != NARC_OK)
            return narc_fail(error, status, 0, (double)count, "no memory for %zu queries", count);
        status = walk_all(&s, q->workers, &total, error);
    }
    if (status == NARC_OK && narc_reserve_rows(index, (size_t)total) != NARC_OK)
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, (double)total, "no memory for %zu pairs", (size_t)total);
    if (status != NARC_OK)
        return status;
    uint32_t row = 0;
    for (size_t k = 0; k < count && total > 0; k++) {
        index->regions[k].row = row;
        row += index->regions[k].count;
    }
    if (total > 0)
        narc_run_ranges(q->workers, count, QUERIES, list_part, &s);
    *out_pairs = (narc_pairs){.count = (size_t)total,
                              .a = {index->rows, sizeof(uint32_t)},
                              .b = {index->rows ? index->rows + index->row_capacity : NULL, sizeof(uint32_t)}};
    return NARC_OK;
}
