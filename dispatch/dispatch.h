/* SPDX-License-Identifier: MIT
 *
 * dispatch.h - what the files of dispatch/ know of each other. Internal.
 */
#ifndef NARC_DISPATCH_H
#define NARC_DISPATCH_H

#include "kernels.h"
#include "narc.h"

/* What a table may need of the processor and the operating system. */
enum { NARC_CPU_AVX = 1, NARC_CPU_AVX2 = 2, NARC_CPU_AVX512 = 4, NARC_CPU_NEON = 8 };
unsigned narc_detect_cpu(void);

/* The table in use, chosen at the first call; NULL if NARC_ISA asks for what can't be had (`*out_status` says why). */
const narc_kernel_table *narc_kernels(narc_status *out_status, narc_error *error);

/* How many threads to use for so many parts of work; `threads` as the caller gave it. */
int narc_team_size(unsigned threads, size_t parts);

/* Spread a checked batch over threads (0: as many as OpenMP would use). */
void narc_run_overlaps(const narc_kernel_table *kernels, const narc_batch *batch, unsigned threads, uint64_t *out_bits);
size_t narc_run_contacts(const narc_kernel_table *kernels, const narc_batch *batch, size_t first, size_t count,
                         float margin, unsigned threads, const narc_contacts *out_contacts);

/* The first of pairs first .. first + count - 1 that names a body or a shape that does not exist; first + count if
 * none. */
size_t narc_find_bad_pair(const narc_batch *batch, size_t first, size_t count, unsigned threads);

#endif
