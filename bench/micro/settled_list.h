/* SPDX-License-Identifier: MIT
 *
 * settled_list.h - which rows there are of settled piles.
 */
#ifndef NARC_BENCH_SETTLED_LIST_H
#define NARC_BENCH_SETTLED_LIST_H

#include "list.h"

void list_settled(const struct row_choice *choice);

#endif
