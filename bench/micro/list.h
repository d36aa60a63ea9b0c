/* SPDX-License-Identifier: MIT
 *
 * list.h - which rows there are.
 */
#ifndef NARC_BENCH_LIST_H
#define NARC_BENCH_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include "bench.h"

struct row_choice {
    const char *best_isa;
    size_t pair_count, packing_count; /* of a scene; of a packing */
    bool all;                         /* all combinations */
};

struct row_list {
    struct bench_row *const *rows;
    size_t count;
};

/* Makes and registers all rows. */
struct row_list list_rows(const struct row_choice *choice);

/* One of them. */
void list_row(struct bench_row *row);
bool is_listed(const char *name);

/* Those of settled piles. */
void list_settled(const struct row_choice *choice);

#endif
