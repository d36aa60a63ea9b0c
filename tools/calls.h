/* SPDX-License-Identifier: MIT
 *
 * calls.h - how the library is called: its errors, its instruction set, its threads.
 */
#ifndef NARC_TOOL_CALLS_H
#define NARC_TOOL_CALLS_H

#include "narc.h"
#include "options.h"

/* Ends the command if a call failed. */
void check_call(narc_status status, const narc_error *error);

/* What --isa names; NULL: the library chooses. */
void choose_isa(const char *name);

/* What --threads says; if it is not given, one thread for each processor. */
narc_workers choose_workers(const option *threads);

/* Of numbers, which it sorts. */
double find_median(double *numbers, size_t count);

#endif
