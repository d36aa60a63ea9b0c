/* SPDX-License-Identifier: MIT
 *
 * batch.c - spreads a batch over threads. The only place that knows OpenMP.
 *
 * Chunks are fixed ranges of pairs whatever the number of threads, and each pair's answer depends on that pair alone,
 * so the bytes of the result are the same for any split.
 */
#include "column.h"
#include "dispatch.h"

#include <stdatomic.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#include <sched.h>
#endif

/* Pairs in a chunk: some 50 microseconds of work, against about one for handing it out; a multiple of 64. For contacts
 * also the size of each thread's buffer on its stack, 27 KB. */
enum { CHUNK = 1024 };

unsigned narc_default_threads(void) {
#ifdef _OPENMP
    return (unsigned)omp_get_max_threads();
#else
    return 1;
#endif
}

/* OpenMP ends the process if it cannot start as many threads as it was asked for. */
enum { MOST_THREADS = 256 };

/* How many threads to ask for, given how many chunks there are. */
static int thread_count(unsigned threads, size_t chunks) {
    const unsigned asked = threads ? threads : narc_default_threads(),
                   wanted = asked < MOST_THREADS ? asked : MOST_THREADS;
    return (int)(wanted < chunks ? wanted : chunks);
}

static size_t chunk_size(size_t count, size_t start) { return count - start < CHUNK ? count - start : CHUNK; }

void narc_run_overlaps(const narc_kernel_table *kernels, const narc_batch *batch, unsigned threads,
                       uint64_t *out_bits) {
    const size_t count = batch->pairs->count, chunks = (count + CHUNK - 1) / CHUNK;
    const int team = thread_count(threads, chunks);
    if (team <= 1) {
        kernels->overlap(batch, 0, count, out_bits);
        return;
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(team)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const size_t start = chunk * CHUNK;
        kernels->overlap(batch, start, chunk_size(count, start), out_bits + start / 64);
    }
}

/* A chunk's contacts, before it is known where in the list they belong. */
struct buffer {
    uint32_t pair[CHUNK];
    float separation[CHUNK], normal_x[CHUNK], normal_y[CHUNK], point_x[CHUNK], point_y[CHUNK];
    uint8_t arc_a[CHUNK], arc_b[CHUNK];
};

static void copy_array(void *to, const void *from, size_t offset, size_t count, size_t item) {
    if (to)
        memcpy((char *)to + offset * item, from, count * item);
}

/* Copies `found` contacts to items offset ... of the caller's list, as far as they fit. */
static void copy_contacts(const struct buffer *from, size_t found, size_t offset, const narc_contacts *to) {
    const size_t room = offset < to->capacity ? to->capacity - offset : 0, count = found < room ? found : room;
    if (count == 0)
        return;
    copy_array(to->pair, from->pair, offset, count, sizeof *to->pair);
    copy_array(to->separation, from->separation, offset, count, sizeof *to->separation);
    copy_array(to->normal_x, from->normal_x, offset, count, sizeof *to->normal_x);
    copy_array(to->normal_y, from->normal_y, offset, count, sizeof *to->normal_y);
    copy_array(to->point_x, from->point_x, offset, count, sizeof *to->point_x);
    copy_array(to->point_y, from->point_y, offset, count, sizeof *to->point_y);
    copy_array(to->arc_a, from->arc_a, offset, count, sizeof *to->arc_a);
    copy_array(to->arc_b, from->arc_b, offset, count, sizeof *to->arc_b);
}

static void give_way(void) {
#ifdef _OPENMP
    sched_yield();
#endif
}

/* The contacts of one chunk, to the buffer; returns how many. */
static size_t fill_buffer(const narc_kernel_table *kernels, const narc_batch *batch, size_t first, size_t count,
                          float margin, struct buffer *b) {
    const narc_contacts list = {CHUNK,      b->pair,    b->separation, b->normal_x, b->normal_y,
                                b->point_x, b->point_y, b->arc_a,      b->arc_b};
    return kernels->contact(batch, first, count, margin, &list);
}

size_t narc_run_contacts(const narc_kernel_table *kernels, const narc_batch *batch, size_t first, size_t count,
                         float margin, unsigned threads, const narc_contacts *out_contacts) {
    const size_t chunks = (count + CHUNK - 1) / CHUNK;
    const int team = thread_count(threads, chunks);
    size_t total = 0;
    if (team <= 1) {
        for (size_t start = 0; start < count; start += CHUNK) {
            struct buffer buffer;
            const size_t size = chunk_size(count, start);
            const size_t found = fill_buffer(kernels, batch, first + start, size, margin, &buffer);
            copy_contacts(&buffer, found, total, out_contacts);
            total += found;
        }
        return total;
    }
    /* Chunks are handed out in the order of the pairs and run at once; only the reservation of their place in the list
     * waits for its turn. It gives up the processor while it waits: OpenMP's own `ordered` spins, which on a busy
     * machine keeps the thread that it waits for from running. */
    atomic_size_t turn = 0;
#ifdef _OPENMP
#pragma omp parallel for schedule(monotonic : dynamic) num_threads(team)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        struct buffer buffer;
        const size_t start = chunk * CHUNK, size = chunk_size(count, start);
        const size_t found = fill_buffer(kernels, batch, first + start, size, margin, &buffer);
        while (atomic_load_explicit(&turn, memory_order_acquire) != chunk)
            give_way();
        const size_t offset = total;
        total += found;
        atomic_store_explicit(&turn, chunk + 1, memory_order_release);
        copy_contacts(&buffer, found, offset, out_contacts);
    }
    return total;
}

static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }

/* The largest index of items first .. last - 1 of a column. Four at a time, because one comparison would wait for the
 * other; a plain array in a loop that compilers turn into vectors. */
static uint32_t find_largest(narc_column column, size_t first, size_t last) {
    uint32_t largest[4] = {0};
    size_t k = first;
    if (column.stride == sizeof(uint32_t)) {
        const uint32_t *index = column.base;
        for (; k < last; k++)
            largest[0] = larger(largest[0], index[k]);
    }
    for (; k + 4 <= last; k += 4) {
        const char *item = narc_at(column, k);
        largest[0] = larger(largest[0], *(const uint32_t *)(const void *)item);
        largest[1] = larger(largest[1], *(const uint32_t *)(const void *)(item + column.stride));
        largest[2] = larger(largest[2], *(const uint32_t *)(const void *)(item + 2 * column.stride));
        largest[3] = larger(largest[3], *(const uint32_t *)(const void *)(item + 3 * column.stride));
    }
    for (; k < last; k++)
        largest[0] = larger(largest[0], narc_index_at(column, k));
    return larger(larger(largest[0], largest[1]), larger(largest[2], largest[3]));
}

/* Is it certain that no pair of the sub-range is bad? Reads columns from front to back, so it is much faster than
 * looking at every pair's bodies; it pays if there are not many more bodies than pairs. */
static bool all_in_range(const narc_batch *batch, size_t first, size_t count) {
    const narc_bodies *bodies = batch->bodies;
    narc_column a = batch->pairs->a, b = batch->pairs->b;
    size_t last = first + count;
    if (bodies->count / 4 > count)
        return false;
    if (a.stride == 2 * sizeof(uint32_t) && b.stride == a.stride && (const char *)b.base == (const char *)a.base + 4) {
        a.stride = sizeof(uint32_t); /* both columns are one */
        first *= 2;
        last *= 2;
        b = a;
    }
    return find_largest(a, first, last) < bodies->count &&
           (b.stride == sizeof(uint32_t) && b.base == a.base ? true : find_largest(b, first, last) < bodies->count) &&
           find_largest(bodies->shape, 0, bodies->count) < batch->shapes->count;
}

/* The first of pairs first .. last - 1 that names a body or a shape that does not exist; last if none. */
static size_t find_bad_pair(const narc_batch *batch, size_t first, size_t last) {
    const narc_bodies *bodies = batch->bodies;
    for (size_t pair = first; pair < last; pair++) {
        const uint32_t a = narc_index_at(batch->pairs->a, pair);
        const uint32_t b = narc_index_at(batch->pairs->b, pair);
        if (a >= bodies->count || b >= bodies->count || narc_index_at(bodies->shape, a) >= batch->shapes->count ||
            narc_index_at(bodies->shape, b) >= batch->shapes->count)
            return pair;
    }
    return last;
}

size_t narc_find_bad_pair(const narc_batch *batch, size_t first, size_t count, unsigned threads) {
    const size_t chunks = (count + CHUNK - 1) / CHUNK;
    const int team = thread_count(threads, chunks);
    if (all_in_range(batch, first, count))
        return first + count;
    if (team <= 1)
        return find_bad_pair(batch, first, first + count);
    size_t bad = first + count;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(min : bad)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const size_t start = first + chunk * CHUNK, last = start + chunk_size(count, chunk * CHUNK);
        const size_t found = find_bad_pair(batch, start, last);
        if (found < last && found < bad)
            bad = found;
    }
    return bad;
}
