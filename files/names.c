/* SPDX-License-Identifier: MIT
 *
 * names.c - UTF-8, and names of shapes.
 */
#include "names.h"

#include <stddef.h>
#include <string.h>

bool narc_next_code_point(const char **text, uint32_t *out_code) {
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *byte = (const unsigned char *)*text;
    const size_t length = byte[0] < 0x80 ? 1 : byte[0] < 0xc0 ? 0 : byte[0] < 0xe0 ? 2 : byte[0] < 0xf0 ? 3 : 4;
    if (length == 0 || byte[0] > 0xf4)
        return false;
    uint32_t code = length == 1 ? byte[0] : byte[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((byte[i] & 0xc0) != 0x80)
            return false;
        code = code << 6 | (byte[i] & 0x3f);
    }
    if (code < smallest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
        return false;
    *text += length;
    *out_code = code;
    return true;
}

void narc_make_printable(char *text) {
    for (char *c = text; *c;) {
        const char *next = c;
        uint32_t code;
        if (narc_next_code_point(&next, &code) && code >= 0x20 && (code < 0x7f || code >= 0xa0))
            c += next - c;
        else
            *c++ = '?';
    }
}

bool narc_next_of_name(const char **text) {
    uint32_t code;
    return narc_next_code_point(text, &code) && code >= 0x20 && code != 0x7f && code != ',' && code != '"';
}

bool narc_is_name(const char *name) {
    const size_t length = strlen(name);
    if (length == 0 || name[0] == ' ' || name[length - 1] == ' ')
        return false;
    while (*name)
        if (!narc_next_of_name(&name))
            return false;
    return true;
}
