/* SPDX-License-Identifier: MIT
 *
 * error.c - the one place that fills a narc_error. The fitting library has its own copy of this file's object, so that
 * the function stays hidden in both.
 */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>

narc_status narc_fail(narc_error *error, narc_status status, size_t index, double value, const char *format, ...) {
    if (error) {
        error->status = status;
        error->index = index;
        error->value = value;
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
    }
    return status;
}
