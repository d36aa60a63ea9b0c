/* SPDX-License-Identifier: MIT
 *
 * text.c - whole files and numbers.
 */
#define _POSIX_C_SOURCE   200809L /* fileno */
#define _FILE_OFFSET_BITS 64      /* of files too large to read */
#include "text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fail.h"
#include "names.h"
#include "number.h"
#include "output.h"
#include "system.h"

static FILE *open_input(const char *path) {
    if (strcmp(path, "-") == 0)
        return stdin;
    FILE *file = open_file(path, "rb");
    if (file)
        protect_input(path);
    return file;
}

/* The reason why a file cannot be read, or NULL. A regular file that is too large is known before it is read. */
static const char *read_all(FILE *file, char **bytes, size_t *size) {
    static const char too_large[] = "it has more than 1 GiB, the most that is read";
    const size_t most = (size_t)1 << 30;
    struct stat found;
    size_t capacity = 0, got = 1;
    if (fstat(fileno(file), &found) == 0 && S_ISREG(found.st_mode) && (uintmax_t)found.st_size > most)
        return too_large;
    while (got) {
        /* Doubling the room asked for keeps the number of copies small. */
        *bytes = grow(*bytes, &capacity, *size + 65536, 1);
        const size_t room = capacity - *size - 1, rest = most + 1 - *size;
        got = fread(*bytes + *size, 1, room < rest ? room : rest, file);
        *size += got;
        if (*size > most)
            return too_large;
    }
    (*bytes)[*size] = 0;
    return ferror(file) ? strerror(errno) : NULL;
}

char *try_read_bytes(const char *path, size_t *out_size) {
    FILE *file = open_input(path);
    char *bytes = NULL;
    *out_size = 0;
    const char *wrong = file ? read_all(file, &bytes, out_size) : strerror(errno);
    if (file)
        fclose(file);
    if (!wrong)
        return bytes;
    free(bytes);
    report_at(path, 0, "%s", wrong);
    return NULL;
}

char *read_bytes(const char *path, size_t *out_size) {
    char *bytes = try_read_bytes(path, out_size);
    if (!bytes)
        abandon();
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

narc_shape_list *read_shapes(const char *path, narc_shapes **out_store) {
    size_t size;
    char *bytes = read_bytes(path, &size);
    narc_shape_list *shapes;
    narc_error error;
    if (out_store && narc_create_shapes(NULL, out_store) != NARC_OK)
        fail("not enough memory for a store of shapes");
    if (narc_read_shapes(bytes, size, NULL, out_store ? *out_store : NULL, &shapes, &error) != NARC_OK)
        fail_text(path, &error);
    free(bytes);
    return shapes;
}

void report_text(const char *path, const narc_error *error) {
    char line[32];
    snprintf(line, sizeof line, "line %zu: ", error->index);
    const size_t length = strlen(line);
    report_at(path, error->index, "%s", error->message + (strncmp(error->message, line, length) == 0 ? length : 0));
}

_Noreturn void fail_text(const char *path, const narc_error *error) {
    report_text(path, error);
    abandon();
}

void put_json_text(FILE *file, const char *text) {
    fputc('"', file);
    while (*text) {
        const char *next = text;
        uint32_t code;
        if (!narc_next_code_point(&next, &code)) {
            fputs("\\ufffd", file);
            text++;
            continue;
        }
        if (code < ' ' || code == '<')
            fprintf(file, "\\u%04x", (unsigned)code);
        else
            fprintf(file, "%s%.*s", code == '"' || code == '\\' ? "\\" : "", (int)(next - text), text);
        text = next;
    }
    fputc('"', file);
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
