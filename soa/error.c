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
        size_t end = sizeof error->message - 1;
        if (vsnprintf(error->message, end + 1, format, arguments) > (int)end) { /* cut: but within no character */
            while (end > 0 && ((unsigned char)error->message[end - 1] & 0xc0) == 0x80)
                end--;
            error->message[end - (end > 0 && (unsigned char)error->message[end - 1] >= 0xc0)] = 0;
        }
        va_end(arguments);
    }
    return status;
}
