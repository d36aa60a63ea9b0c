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

/* Pairs in a chunk of contacts: some 25 microseconds of work, against about one for handing it out, and the size of
 * each thread's buffer on its stack, 27 KB. */
enum { CHUNK = NARC_CONTACT_GROUP };

/* Pairs in a chunk of overlaps, multiples of 64: as many as possible, because at the end of a chunk the kernel decides
 * the rest of its pairs in vectors that are not full, but several for each thread, so that all end together. */
enum { MOST_OVERLAPS = 16384, LEAST_OVERLAPS = 1024, CHUNKS_PER_THREAD = 4 };

unsigned narc_default_threads(void) {
#ifdef _OPENMP
    return (unsigned)omp_get_max_threads();
#else
    return 1;
#endif
}

/* OpenMP ends the process if it cannot start as many threads as it was asked for. */
enum { MOST_THREADS = 256 };

int narc_team_size(unsigned threads, size_t parts) {
    const unsigned asked = threads ? threads : narc_default_threads(),
                   wanted = asked < MOST_THREADS ? asked : MOST_THREADS;
    return (int)(wanted < parts ? wanted : parts);
}

/* Kernels write only the outcomes of pairs that did not end well. */
static void clear_outcomes(const narc_batch *batch, size_t first, size_t count) {
    if (batch->outcomes && count > 0)              /* memset() wants a pointer even for nothing */
        memset(batch->outcomes + first, 0, count); /* NARC_OUTCOME_DONE */
}

void narc_run_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, unsigned threads, uint64_t *out_bits) {
    const size_t count = batch->pairs->count;
    if (count == 0)
        return;
    clear_outcomes(batch, 0, count);
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
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic) num_threads(team)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++) {
        const size_t start = chunk * chunk_size, left = count - start;
        kernel(batch, start, left < chunk_size ? left : chunk_size, out_bits + start / 64);
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
static size_t fill_buffer(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count,
                          float margin, struct buffer *b) {
    const narc_contacts list = {CHUNK,      b->pair,    b->separation, b->normal_x, b->normal_y,
                                b->point_x, b->point_y, b->arc_a,      b->arc_b};
    return kernel(batch, first, count, margin, &list);
}

size_t narc_run_contacts(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count, float margin,
                         unsigned threads, const narc_contacts *out_contacts) {
    clear_outcomes(batch, first, count);
    const size_t chunks = (count + CHUNK - 1) / CHUNK;
    const int team = narc_team_size(threads, chunks);
    size_t total = 0;
    if (team <= 1) {
        for (size_t start = 0; start < count; start += CHUNK) {
            struct buffer buffer;
            const size_t size = count - start < CHUNK ? count - start : CHUNK;
            const size_t found = fill_buffer(kernel, batch, first + start, size, margin, &buffer);
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
        const size_t start = chunk * CHUNK, size = count - start < CHUNK ? count - start : CHUNK;
        const size_t found = fill_buffer(kernel, batch, first + start, size, margin, &buffer);
        while (atomic_load_explicit(&turn, memory_order_acquire) != chunk)
            give_way();
        const size_t offset = total;
        total += found;
        atomic_store_explicit(&turn, chunk + 1, memory_order_release);
        copy_contacts(&buffer, found, offset, out_contacts);
    }
    return total;
}
