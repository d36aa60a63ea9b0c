/* SPDX-License-Identifier: MIT
 *
 * batch.c - spreads a batch over threads.
 *
 * Chunks are fixed ranges of pairs whatever the number of threads, and each pair's answer depends on that pair alone,
 * so the bytes of the result are the same for any split.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

#ifdef _OPENMP
#include <sched.h>
#endif

/* Each thread has a buffer for the answers to a chunk on its stack, contacts or manifolds with all columns. */
enum {
    CONTACTS = NARC_CONTACT_CHUNK * NARC_CONTACT_BYTES,
    MANIFOLDS = NARC_MANIFOLD_CHUNK * NARC_MANIFOLD_BYTES,
    BUFFER = CONTACTS > MANIFOLDS ? CONTACTS : MANIFOLDS
};

/* Pairs in a chunk of overlaps, multiples of 64: as many as possible, because at the end of a chunk the kernel decides
 * the rest of its pairs in vectors that are not full, but several for each thread, so that all end together. */
enum { MOST_OVERLAPS = 16384, LEAST_OVERLAPS = 1024, CHUNKS_PER_THREAD = 4 };

/* OpenMP ends the process if it cannot start as many threads as it was asked for. */
enum { MOST_THREADS = 256 };

int narc_team_size(unsigned threads, size_t parts) {
    const unsigned asked = threads ? threads : narc_default_threads(),
                   wanted = asked < MOST_THREADS ? asked : MOST_THREADS;
    return (int)(wanted < parts ? wanted : parts);
}

/* The same batch with a counter of the calling thread's own. */
static narc_batch count_apart(const narc_batch *batch, size_t *skipped) {
    narc_batch part = *batch;
    part.skipped = batch->skipped ? skipped : NULL;
    return part;
}

void narc_run_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, unsigned threads, uint64_t *out_bits) {
    const size_t count = batch->pairs->count;
    if (count == 0)
        return;
    const int team = narc_team_size(threads, (count + LEAST_OVERLAPS - 1) / LEAST_OVERLAPS);
    if (team <= 1) {
        kernel(batch, 0, count, out_bits);
        return;
    }
    size_t chunk_size = count / ((size_t)team * CHUNKS_PER_THREAD) / 64 * 64;
    if (chunk_size < LEAST_OVERLAPS)
        chunk_size = LEAST_OVERLAPS;
    if (chunk_size > MOST_OVERLAPS)
        chunk_size = MOST_OVERLAPS;
    const size_t chunks = (count + chunk_size - 1) / chunk_size;
    size_t skipped = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(team) reduction(+ : skipped)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const narc_batch part = count_apart(batch, &skipped);
        const size_t start = chunk * chunk_size, left = count - start;
        kernel(&part, start, left < chunk_size ? left : chunk_size, out_bits + start / 64);
    }
    if (batch->skipped)
        *batch->skipped += skipped;
}

/* A list's columns in a buffer, without gaps, for `count` items; those that are not wanted are not wanted there. */
static narc_list divide_buffer(const narc_list *list, size_t count, char buffer[BUFFER]) {
    narc_list part = *list;
    char *next = buffer;
    part.capacity = count;
    for (size_t c = 0; c < list->columns; c++) {
        part.array[c] = list->array[c] ? next : NULL;
        next += count * list->item[c];
    }
    assert(next <= buffer + BUFFER);
    return part;
}

/* The same list from item `offset` on. */
static narc_list skip_items(const narc_list *list, size_t offset) {
    narc_list rest = *list;
    rest.capacity -= offset;
    for (size_t c = 0; c < list->columns; c++)
        if (list->array[c])
            rest.array[c] = (char *)list->array[c] + offset * list->item[c];
    return rest;
}

/* Copies `found` items to items offset ... of the caller's list, as far as they fit. */
static void copy_items(const narc_list *from, size_t found, size_t offset, const narc_list *to) {
    const size_t room = offset < to->capacity ? to->capacity - offset : 0, count = found < room ? found : room;
    for (size_t c = 0; c < to->columns && count > 0; c++)
        if (to->array[c])
            memcpy((char *)to->array[c] + offset * to->item[c], from->array[c], count * to->item[c]);
}

static void give_way(void) {
#ifdef _OPENMP
    sched_yield();
#endif
}

/* One chunk after the other, straight to the caller's list while it has room for as many answers as a chunk has
 * pairs. */
static size_t list_in_order(const narc_lister *lister, const narc_batch *batch, size_t first, size_t count,
                            const narc_list *list) {
    size_t total = 0;
    for (size_t start = 0; start < count; start += lister->chunk) {
        _Alignas(16) char buffer[BUFFER];
        const size_t size = count - start < lister->chunk ? count - start : lister->chunk;
        const bool fits = total <= list->capacity && list->capacity - total >= size;
        const narc_list *to = list; /* as it is, for the first chunk */
        narc_list part;
        if (!fits || total > 0) {
            part = fits ? skip_items(list, total) : divide_buffer(list, lister->chunk, buffer);
            to = &part;
        }
        const size_t found = lister->find(lister, batch, first + start, size, to);
        if (!fits)
            copy_items(to, found, total, list);
        total += found;
    }
    return total;
}

/* Several threads. Not inlined: the buffer of list_in_order() would be on the stack beside the thread's own. */
static __attribute__((noinline)) size_t list_in_team(const narc_lister *lister, const narc_batch *batch, size_t first,
                                                     size_t count, int team, const narc_list *list) {
    const size_t chunks = count / lister->chunk + (count % lister->chunk != 0);
    (void)team;
    /* Chunks are handed out in the order of the pairs and run at once; only the reservation of their place in the list
     * waits for its turn. It gives up the processor while it waits: OpenMP's own `ordered` spins, which on a busy
     * machine keeps the thread that it waits for from running. */
    atomic_size_t turn = 0;
    size_t skipped = 0, total = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(monotonic : dynamic) num_threads(team) reduction(+ : skipped)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const narc_batch own = count_apart(batch, &skipped);
        _Alignas(16) char buffer[BUFFER];
        const narc_list part = divide_buffer(list, lister->chunk, buffer);
        const size_t start = chunk * lister->chunk, left = count - start;
        const size_t found =
            lister->find(lister, &own, first + start, left < lister->chunk ? left : lister->chunk, &part);
        while (atomic_load_explicit(&turn, memory_order_acquire) != chunk)
            give_way();
        const size_t offset = total;
        total += found;
        atomic_store_explicit(&turn, chunk + 1, memory_order_release);
        copy_items(&part, found, offset, list);
    }
    if (batch->skipped)
        *batch->skipped += skipped;
    return total;
}

size_t narc_run_list(const narc_lister *lister, const narc_batch *batch, size_t first, size_t count, unsigned threads,
                     const narc_list *list) {
    const int team = narc_team_size(threads, (count + lister->chunk - 1) / lister->chunk);
    if (team <= 1)
        return list_in_order(lister, batch, first, count, list);
    return list_in_team(lister, batch, first, count, team, list);
}

static size_t find_contacts(const narc_lister *lister, const narc_batch *batch, size_t first, size_t count,
                            const narc_list *list) {
    void *const *array = list->array;
    narc_contacts out = {.capacity = list->capacity};
    NARC_CONTACT_COLUMNS(NARC_TAKE_ARRAY, &out)
    return lister->contact(batch, first, count, lister->margin, &out);
}

size_t narc_run_contacts(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count, float margin,
                         unsigned threads, const narc_contacts *out_contacts) {
    const narc_lister lister = {find_contacts, NARC_CONTACT_CHUNK, margin, .contact = kernel};
    const narc_list list = {.capacity = out_contacts->capacity,
                            .columns = NARC_CONTACT_COLUMN_COUNT,
                            .item = {NARC_CONTACT_COLUMNS(NARC_COLUMN_SIZE, out_contacts)},
                            .array = {NARC_CONTACT_COLUMNS(NARC_COLUMN_ARRAY, out_contacts)}};
    return narc_run_list(&lister, batch, first, count, threads, &list);
}

narc_status narc_list_contacts(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count,
                               float margin, unsigned threads, const narc_contacts *out_contacts, size_t *out_count,
                               narc_error *error) {
    if (!out_contacts || !out_count)
        return narc_fail_missing(error, !out_contacts ? "out_contacts" : "out_count");
    if (isnan(margin))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)margin, "margin is not a number");
    const size_t found = narc_run_contacts(kernel, batch, first, count, margin, threads, out_contacts);
    *out_count = found;
    if (found > out_contacts->capacity)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)found, "%zu contacts, but there is room for %zu", found,
                         out_contacts->capacity);
    return NARC_OK;
}
