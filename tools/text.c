/* SPDX-License-Identifier: MIT
 *
 * text.c - whole files, numbers and UTF-8.
 */
#include "text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "output.h"

char *read_bytes(const char *path, size_t *out_size) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        fail("%s: %s", path, strerror(errno));
    }
    protect_input(file);
    char *bytes = NULL;
    size_t size = 0, capacity = 0, got;
    do {
        /* Doubling the room asked for keeps the number of copies small. */
        bytes = grow(bytes, &capacity, size + 65536, 1);
        got = fread(bytes + size, 1, capacity - size - 1, file);
        size += got;
    } while (got);
    if (ferror(file)) {
        fail("%s: %s", path, strerror(errno));
    }
    fclose(file);
    bytes[size] = 0;
    *out_size = size;
    return bytes;
}

char *read_text(const char *path, size_t *out_size) {
    size_t size;
    char *text = read_bytes(path, &size);
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        size -= 3;
        memmove(text, text + 3, size + 1);
    }
    if (strlen(text) != size) {
        fail_at(path, line_of(text, text + strlen(text)), "a NUL byte");
    }
    *out_size = size;
    return text;
}

size_t line_of(const char *text, const char *position) {
    size_t line = 1;
    while ((text = memchr(text, '\n', (size_t)(position - text)))) {
        line++;
        text++;
    }
    return line;
}

bool parse_number(const char *text, double *out_value) {
    /* strtod() also takes leading space, hexadecimal, "nan" and "inf". */
    if (!*text || text[strspn(text, "+-.0123456789eE")]) {
        return false;
    }
    char *end;
    const double value = strtod(text, &end);
    if (*end || !isfinite(value)) {
        return false;
    }
    *out_value = value;
    return true;
}

bool parse_whole(const char *text, uint64_t largest, uint64_t *out_value) {
    uint64_t value = 0;
    if (!*text) {
        return false;
    }
    for (; *text; text++) {
        const unsigned digit = (unsigned)(*text - '0');
        if (digit > 9 || value > (UINT64_MAX - digit) / 10) {
            return false;
        }
        value = 10 * value + digit;
    }
    if (value > largest) {
        return false;
    }
    *out_value = value;
    return true;
}

bool next_code_point(const char **text, uint32_t *out_code) {
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *byte = (const unsigned char *)*text;
    const size_t length = byte[0] < 0x80 ? 1 : byte[0] < 0xc0 ? 0 : byte[0] < 0xe0 ? 2 : byte[0] < 0xf0 ? 3 : 4;
    if (length == 0 || byte[0] > 0xf4) {
        return false;
    }
    uint32_t code = length == 1 ? byte[0] : byte[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((byte[i] & 0xc0) != 0x80) {
            return false;
        }
        code = code << 6 | (byte[i] & 0x3f);
    }
    if (code < smallest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) {
        return false;
    }
    *text += length;
    *out_code = code;
    return true;
}
