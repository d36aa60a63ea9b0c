/* SPDX-License-Identifier: MIT
 *
 * number.c - decimal numbers in texts.
 */
#include "number.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 300, LONGEST_POINT = 16 };

bool narc_parse_number(const char *text, size_t size, double *out_value) {
    /* strtod() wants the decimal point of the locale, which may be a comma and several bytes long. */
    const char *point = localeconv()->decimal_point;
    const size_t point_size = strlen(point);
    char buffer[LONGEST + LONGEST_POINT + 1];
    size_t length = 0;
    bool has_point = false;
    if (size == 0 || size > LONGEST || point_size > LONGEST_POINT)
        return false;
    for (size_t i = 0; i < size; i++) {
        if (!text[i] || !strchr("+-.0123456789eE", text[i]) || (text[i] == '.' && has_point))
            return false; /* there is room for one point */
        if (text[i] == '.') {
            has_point = true;
            memcpy(buffer + length, point, point_size);
            length += point_size;
        } else {
            buffer[length++] = text[i];
        }
    }
    buffer[length] = 0;
    char *end;
    const double value = strtod(buffer, &end);
    if (*end)
        return false;
    *out_value = value;
    return true;
}
