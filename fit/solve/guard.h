/* SPDX-License-Identifier: MIT
 *
 * guard.h - calls that may throw a C++ exception. Internal.
 */
#ifndef NARC_FIT_GUARD_H
#define NARC_FIT_GUARD_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Calls call(context). False if an exception came out of it. C functions between it and what throws must be compiled
 * with -fexceptions. */
bool narc_call_guarded(void (*call)(void *), void *context);

#ifdef __cplusplus
}
#endif

#endif
