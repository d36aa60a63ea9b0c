/* SPDX-License-Identifier: MIT
 *
 * error.h - fills a narc_error. Internal.
 */
#ifndef NARC_ERROR_H
#define NARC_ERROR_H

#include "compiler.h"
#include "narc_shapes.h"

/* Fills `error` unless it is NULL and returns `status`, so that a check reads `return narc_fail(...)`. */
PRINTF_LIKE(5, 6)
narc_status narc_fail(narc_error *error, narc_status status, size_t index, double value, const char *format, ...);

#endif
