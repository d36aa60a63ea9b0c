/* SPDX-License-Identifier: MIT
 *
 * memory.c - errors, and arrays that grow.
 */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "dem.h"

/* _Exit() drops what is still buffered: nothing more gets written. */
void dem_quit(const char *format, ...) {
    char line[2048] = "dem: ";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + 5, sizeof line - 5, format, arguments);
    va_end(arguments);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    fprintf(stderr, "%s\n", line);
    _Exit(2);
}

void dem_fail(dem *d, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(d->error, sizeof d->error, format, arguments);
    va_end(arguments);
    if (d->on_error)
        d->on_error(d);
    dem_quit("%s%s", d->input_path, d->error);
}

void dem_demand(dem *d, narc_status status, const char *what, const narc_error *error) {
    if (status != NARC_OK)
        dem_fail(d, "%s: %s", what, error->message);
}

/* In front of an array: how many items it has room for. Items are aligned as malloc() aligns. */
typedef union head {
    size_t capacity;
    max_align_t alignment;
} head;

void dem_grow(void *array_pointer, size_t needed, size_t size) {
    char *array;
    memcpy(&array, array_pointer, sizeof array);
    head *old = array ? (head *)(void *)array - 1 : NULL;
    if (old && needed <= old->capacity)
        return;
    const size_t capacity = needed + needed / 2 + 16;
    head *larger = capacity <= SIZE_MAX / size - sizeof(head) ? realloc(old, sizeof(head) + capacity * size) : NULL;
    if (!larger)
        dem_quit("not enough memory for %zu items of %zu bytes", capacity, size);
    larger->capacity = capacity;
    larger++;
    memcpy(array_pointer, &larger, sizeof larger);
}

void dem_release(void *array) { free(array ? (head *)array - 1 : NULL); }
