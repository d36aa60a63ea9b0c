/* SPDX-License-Identifier: MIT
 *
 * error.h - fills a narc_error. Internal.
 */
#ifndef NARC_ERROR_H
#define NARC_ERROR_H

#include "narc_shapes.h"

/* Fills `error` unless it is NULL and returns `status`, so that a check reads `return narc_fail(...)`. */
#if defined(__MINGW32__)
#include <stdio.h>
__attribute__((format(__MINGW_PRINTF_FORMAT, 5, 6)))
#elif defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
narc_status
narc_fail(narc_error *error, narc_status status, size_t index, double value, const char *format, ...);

#endif
