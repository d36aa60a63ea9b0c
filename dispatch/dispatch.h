/* SPDX-License-Identifier: MIT
 *
 * dispatch.h - what the files of dispatch/ know of each other. Internal.
 */
#ifndef NARC_DISPATCH_H
#define NARC_DISPATCH_H

#include "kernels.h"
#include "narc.h"

/* What a table may need of the processor and the operating system: all features of that kind in the list of cpu.c. */
enum { NARC_CPU_AVX2 = 1, NARC_CPU_AVX512 = 2, NARC_CPU_NEON = 4 };
unsigned narc_detect_cpu(void);

/* The table in use, chosen at the first call; NULL if NARC_ISA asks for what can't be had (`*out_status` says why). */
const narc_kernel_table *narc_kernels(narc_status *out_status, narc_error *error);

/* How many threads to use for so many parts of work; `threads` as the caller gave it. */
int narc_team_size(unsigned threads, size_t parts);

/* "`name` is NULL". */
narc_status narc_fail_missing(narc_error *error, const char *name);

/* The checks that all batch calls share, for pairs first .. first + count - 1; the second one gives the table, too. */
narc_status narc_check_pairs(const narc_batch *batch, size_t first, size_t count, unsigned threads, narc_error *error);
narc_status narc_check_batch(const narc_batch *batch, size_t first, size_t count, unsigned threads,
                             const narc_kernel_table **out_kernels, narc_error *error);

/* The rest of a call for contacts, after narc_check_batch(): checks the outputs, runs the kernel. */
narc_status narc_list_contacts(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count,
                               float margin, unsigned threads, const narc_contacts *out_contacts, size_t *out_count,
                               narc_error *error);

/* Checks options, and finds the sine of the flat angle as a batch has it. */
narc_status narc_read_manifold_options(const narc_manifold_options *options, narc_batch *batch, narc_error *error);

/* The arrays of narc_contacts and narc_manifolds, all of them: COLUMN(list, member) for each. */
/* clang-format off */
#define NARC_CONTACT_COLUMNS(COLUMN, list)                  \
    COLUMN(list, pair)        COLUMN(list, separation)      \
    COLUMN(list, normal_x)    COLUMN(list, normal_y)        \
    COLUMN(list, point_x)     COLUMN(list, point_y)         \
    COLUMN(list, arc_a)       COLUMN(list, arc_b)
#define NARC_MANIFOLD_COLUMNS(COLUMN, list)                 \
    COLUMN(list, pair)          COLUMN(list, point_count)   \
    COLUMN(list, normal_x)      COLUMN(list, normal_y)      \
    COLUMN(list, separation[0]) COLUMN(list, separation[1]) \
    COLUMN(list, point_x[0])    COLUMN(list, point_x[1])    \
    COLUMN(list, point_y[0])    COLUMN(list, point_y[1])    \
    COLUMN(list, feature[0])    COLUMN(list, feature[1])    \
    COLUMN(list, radius_a[0])   COLUMN(list, radius_a[1])   \
    COLUMN(list, radius_b[0])   COLUMN(list, radius_b[1])
/* clang-format on */

/* COLUMN: initialisers, sums, and the members out of a list of pointers, `array`. */
#define NARC_COLUMN_ARRAY(list, member) (list)->member,
#define NARC_COLUMN_SIZE(list, member)  sizeof *(list)->member,
#define NARC_PLUS_SIZE(list, member)    +(int)sizeof *(list)->member
#define NARC_PLUS_ONE(list, member)     +1
#define NARC_TAKE_ARRAY(list, member)   (list)->member = *array++;

/* How many there are, the bytes of one item in all of them, and how many pairs a chunk has: some 25 microseconds of
 * work, against about one for handing it out. */
enum {
    NARC_CONTACT_COLUMN_COUNT = 0 NARC_CONTACT_COLUMNS(NARC_PLUS_ONE, ),
    NARC_MANIFOLD_COLUMN_COUNT = 0 NARC_MANIFOLD_COLUMNS(NARC_PLUS_ONE, ),
    NARC_CONTACT_BYTES = 0 NARC_CONTACT_COLUMNS(NARC_PLUS_SIZE, (const narc_contacts *)NULL),
    NARC_MANIFOLD_BYTES = 0 NARC_MANIFOLD_COLUMNS(NARC_PLUS_SIZE, (const narc_manifolds *)NULL),
    NARC_CONTACT_CHUNK = NARC_CONTACT_GROUP,
    NARC_MANIFOLD_CHUNK = NARC_CONTACT_GROUP / 2
};
_Static_assert(sizeof(narc_contacts) == sizeof(size_t) + NARC_CONTACT_COLUMN_COUNT * sizeof(void *), "a column is new");
_Static_assert(sizeof(narc_manifolds) == sizeof(size_t) + NARC_MANIFOLD_COLUMN_COUNT * sizeof(void *),
               "a column is new");

/* A list of answers in the caller's memory, contacts or manifolds, as columns. */
enum { NARC_LIST_COLUMNS = NARC_MANIFOLD_COLUMN_COUNT };
typedef struct narc_list {
    size_t capacity, columns;
    size_t item[NARC_LIST_COLUMNS]; /* bytes */
    void *array[NARC_LIST_COLUMNS]; /* NULL: not wanted */
} narc_list;

/* What finds the answers to some pairs: a kernel, and how to call it. */
typedef struct narc_lister {
    /* Those to at most `chunk` pairs, to the front of a list with room for as many; returns how many. */
    size_t (*find)(const struct narc_lister *lister, const narc_batch *batch, size_t first, size_t count,
                   const narc_list *list);
    size_t chunk;
    float margin;
    narc_contact_kernel *contact; /* one of both */
    narc_manifold_kernel *manifold;
} narc_lister;

/* Spread a checked batch over threads (0: as many as OpenMP would use). Lists come in the order of the pairs; what has
 * no room is left out, and counted. */
size_t narc_run_list(const narc_lister *lister, const narc_batch *batch, size_t first, size_t count, unsigned threads,
                     const narc_list *list);
void narc_run_overlaps(narc_overlap_kernel *kernel, const narc_batch *batch, unsigned threads, uint64_t *out_bits);
size_t narc_run_contacts(narc_contact_kernel *kernel, const narc_batch *batch, size_t first, size_t count, float margin,
                         unsigned threads, const narc_contacts *out_contacts);

/* The first of pairs first .. first + count - 1 that names a body or a shape that does not exist; first + count if
 * none. */
size_t narc_find_bad_pair(const narc_batch *batch, size_t first, size_t count, unsigned threads);

/* The first of bodies first .. first + count - 1 whose shape does not exist; first + count if none. */
size_t narc_find_bad_body(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t count,
                          unsigned threads);

#endif
