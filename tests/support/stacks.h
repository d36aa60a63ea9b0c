/* SPDX-License-Identifier: MIT
 *
 * stacks.h - calls in threads with little stack.
 */
#ifndef NARC_TEST_STACKS_H
#define NARC_TEST_STACKS_H

#include "narc.h"
#include "support.h"

struct stack_call {
    const char *name;
    narc_status (*run)(narc_error *error);
};

/* Whether frames are larger here than was promised: sanitizers make them so, and a compiler that does not optimise. */
extern const bool large_frames;

/* Runs each call in a thread with `promised` bytes of stack: by itself, with OpenMP's threads, and with workers whose
 * tasks have such threads of their own. `set_workers` gives the calls their workers. Below each stack lies a forbidden
 * megabyte: more ends the process, and the last line that it printed names the call. Stacks are filled with junk before:
 * what is left of it tells how much was used. */
void run_on_stacks(const struct stack_call *calls, size_t call_count, size_t promised,
                   void (*set_workers)(const narc_workers *workers));

#endif
