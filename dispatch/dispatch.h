/* SPDX-License-Identifier: MIT
 *
 * dispatch.h - what the files of dispatch/ know of each other. Internal.
 */
#ifndef NARC_DISPATCH_H
#define NARC_DISPATCH_H

#include <stdatomic.h>

#include "elementary.h"
#include "kernels.h"
#include "narc.h"

/* What a table may need of the processor and the operating system: all features of that kind in the list of cpu.c. */
enum { NARC_CPU_AVX2 = 1, NARC_CPU_AVX512 = 2, NARC_CPU_NEON = 4, NARC_CPU_SSE41 = 8, NARC_CPU_WASM128 = 16 };
unsigned narc_detect_cpu(void);

/* The table in use, chosen at the first call; NULL if NARC_ISA asks for what can't be had (`*out_status` says why). */
extern _Atomic(const narc_kernel_table *) narc_active_kernels;
const narc_kernel_table *narc_choose_kernels(narc_status *out_status, narc_error *error);
static inline const narc_kernel_table *narc_kernels(narc_status *out_status, narc_error *error) {
    const narc_kernel_table *const table = atomic_load_explicit(&narc_active_kernels, memory_order_acquire);
    return table ? table : narc_choose_kernels(out_status, error);
}

/* "`name` is NULL". */
narc_status narc_fail_missing(narc_error *error, const char *name);

/* Are all of a struct's reserved members NULL? */
narc_status narc_check_reserved(void *const *reserved, size_t count, const char *name, narc_error *error);

/* Are there no more than `most`? `items` are named in the message. */
narc_status narc_check_count(size_t count, size_t most, const char *items, narc_error *error);

/* Is `owner`.origin finite? NULL is fine. */
narc_status narc_check_origin(const narc_point *origin, const char *owner, narc_error *error);

/* The margins and the flat angle of a query, which is called `name`. */
narc_status narc_check_numbers(const narc_query *query, const char *name, narc_error *error);

/* And that nothing is asked for that this version does not know: what there is to check of a query without its pairs. */
narc_status narc_check_asking(const narc_query *query, narc_error *error);

/* The sine of a query's flat angle, by default of NARC_FLAT_ANGLE; below 0: no second points. */
static inline float narc_find_flat_sine(float angle) {
    return angle == 0 ? 0x1.bd679ap-2f : angle < 0 ? -1.0f : (float)narc_sin((double)angle);
}

/* A range of `*count` items from `first` on; 0 of them: to the end of `total`. */
narc_status narc_check_range(size_t first, size_t *count, size_t total, const char *items, narc_error *error);

/* Checks what a batch call was given, but for its outputs, and fills a batch; its query's `count` is how many pairs
 * there are from `first` on. */
narc_status narc_begin_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                             const narc_query *query, narc_batch *out_batch, narc_error *error);

/* The same, of pairs, bodies and shapes that are known to be there. */
narc_status narc_fill_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                            const narc_query *query, narc_batch *out_batch, narc_error *error);

/* A pair's body A (side 0) or B (1), by the caller's number, and its shape. The body exists. */
struct narc_side {
    size_t body;
    uint32_t shape;
};
struct narc_side narc_find_side(const narc_batch *batch, size_t pair, int side);

/* Checks the outputs, runs a kernel on a batch that was begun, and tells what was skipped. */
narc_status narc_answer_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, uint64_t *out_bits,
                                 narc_error *error);
narc_status narc_answer_rows(narc_row_kernel *kernel, const narc_batch *batch, void *out_rows, size_t capacity,
                             size_t *out_count, narc_error *error);

/* Row kernels for a few pairs, of which each is asked by itself: NARC_FEW at most. */
narc_row_kernel narc_find_few_contacts, narc_find_few_manifolds, narc_find_few_separations;

/* The answers of a call that has a few pairs, and a query that asks for nothing else than a margin: false if it is another call,
 * or something is wrong, or the pair kernel leaves a pair. Then a batch is to be begun. */
bool narc_answer_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                     const narc_query *query, bool manifold, void *out_rows, size_t capacity, size_t *out_count);
bool narc_overlap_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                      const narc_query *query, uint64_t *out_bits);

/* The rows of narc_find_contacts() and narc_find_manifolds() of a batch that was begun. */
narc_status narc_answer_contacts(narc_batch *batch, narc_contact *out_rows, size_t capacity, size_t *out_count,
                                 narc_error *error);
narc_status narc_answer_manifolds(narc_batch *batch, narc_manifold *out_rows, size_t capacity, size_t *out_count,
                                  narc_error *error);

/* Of the pairs that a batch asks for, the place of the first that names a pair, a body or a shape that does not exist;
 * the end of the range if none. */
size_t narc_find_bad_pair(const narc_batch *batch);

/* The first of items first .. first + count - 1 of a column that is not below `limit`; first + count if all are. */
size_t narc_find_bad_index(narc_index_column column, size_t first, size_t count, size_t limit,
                           const narc_workers *workers);

/* Are there the bodies, and their shapes, that `count` items name in a column, or without one items themselves? `item` is what
 * a message calls one. */
narc_status narc_check_named(const narc_shapes *shapes, const narc_bodies *bodies, narc_index_column column,
                             size_t count, const char *item, const narc_workers *workers, narc_error *error);

/* Checks a set of bodies by itself: their number and columns. */
narc_status narc_check_set(const narc_bodies *bodies, narc_error *error);

/* The same for the bodies of an index, which are as many as its boxes. */
narc_status narc_check_indexed(const narc_index *index, const narc_bodies *bodies, narc_error *error);

/* Is what a question of an index, the member `name`, asks for in order? */
narc_status narc_check_search(const narc_index *index, const narc_index_query *query, const char *name,
                              narc_error *error);

/* Checks bodies first .. first + *count - 1 as far as kernels rely on it: columns and shapes. *count 0: to the end. */
narc_status narc_check_bodies(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t *count,
                              const narc_workers *workers, narc_error *error);

/* How many run at once of so many parts: at least 1. `workers` as the caller gave it, NULL too. */
unsigned narc_count_workers(const narc_workers *workers, size_t parts);

/* Calls part(argument, k) for each k below `parts`, once. They are begun in rising order; none waits for another, and
 * all have ended when this returns. With one worker, or one part, in the calling thread, without `workers->run`. */
typedef void narc_part(void *argument, size_t part);
void narc_run_parts(const narc_workers *workers, size_t parts, narc_part *part, void *argument);

/* The same for items: range(argument, part, first, end) for each part of `size` items first .. end - 1, of which the
 * last may have fewer. Returns how many parts there are. */
typedef void narc_range(void *argument, size_t part, size_t first, size_t end);
size_t narc_run_ranges(const narc_workers *workers, size_t count, size_t size, narc_range *range, void *argument);

/* Numbers of items become the places where they begin: those of place k behind those of all places before it, and of the
 * same place in all parts before it, whose numbers are `stride` further on each. */
static inline void narc_begin_places(uint32_t *place, size_t places, size_t stride, size_t parts) {
    uint32_t first = 0;
    for (size_t k = 0; k < places; k++)
        for (size_t part = 0; part < parts; part++) {
            const uint32_t here = place[part * stride + k];
            place[part * stride + k] = first;
            first += here;
        }
}

#endif
