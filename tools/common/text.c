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
#include "number.h"
#include "output.h"

static FILE *open_input(const char *path) {
    static bool is_input_taken;
    if (strcmp(path, "-") != 0) {
        FILE *file = fopen(path, "rb");
        if (file)
            protect_input(path);
        return file;
    }
    if (is_input_taken)
        fail("standard input is given twice");
    is_input_taken = true;
    return stdin;
}

char *read_bytes(const char *path, size_t *out_size) {
    FILE *file = open_input(path);
    char *bytes = NULL;
    size_t size = 0, capacity = 0, got = 1;
    while (file && got) {
        /* Doubling the room asked for keeps the number of copies small. */
        bytes = grow(bytes, &capacity, size + 65536, 1);
        got = fread(bytes + size, 1, capacity - size - 1, file);
        size += got;
    }
    if (!file || ferror(file))
        fail_at(path, 0, "%s", strerror(errno));
    fclose(file);
    bytes[size] = 0;
    *out_size = size;
    return bytes;
}

char *read_text(const char *path) {
    size_t size;
    narc_error error;
    char *text = read_bytes(path, &size);
    if (narc_clean_text(text, size, &error) != NARC_OK)
        fail_text(path, &error);
    return text;
}

_Noreturn void fail_text(const char *path, const narc_error *error) {
    char line[32];
    snprintf(line, sizeof line, "line %zu: ", error->index);
    const size_t length = strlen(line);
    fail_at(path, error->index, "%s", error->message + (strncmp(error->message, line, length) == 0 ? length : 0));
}

bool parse_number(const char *text, double *out_value) {
    return narc_parse_number(text, strlen(text), out_value) && isfinite(*out_value);
}

bool parse_whole(const char *text, uint64_t largest, uint64_t *out_value) {
    uint64_t value = 0;
    if (!*text)
        return false;
    for (; *text; text++) {
        const unsigned digit = (unsigned)(*text - '0');
        if (digit > 9 || value > (UINT64_MAX - digit) / 10)
            return false;
        value = 10 * value + digit;
    }
    if (value > largest)
        return false;
    *out_value = value;
    return true;
}

bool next_code_point(const char **text, uint32_t *out_code) {
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
