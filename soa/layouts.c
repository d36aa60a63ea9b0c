/* SPDX-License-Identifier: MIT
 *
 * layouts.c - the tables of public structures and constants. cmake/layouts.cmake reads the headers and makes declared.h,
 * which includes them and lists what they declare; numbers come from the compiler.
 */
#include "narc_layouts.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "compiler.h"
#include "narc.h"

/* clang-format off */
#define ITEMS(type, name)          (sizeof(((type *)0)->name) / sizeof(((type *)0)->name[0]))
#define MEMBER(type, name, of)     {#name, of, offsetof(type, name), sizeof(((type *)0)->name), 1},
#define ARRAY(type, name, of)      {#name, of, offsetof(type, name), sizeof(((type *)0)->name), ITEMS(type, name)},
#define STRUCTURE(type, ...)       static const narc_member members_of_##type[] = {__VA_ARGS__};
#define ENUMERATION(type)
#define CONSTANT(name)
#include "declared.h"
#undef STRUCTURE
#undef ENUMERATION
#undef CONSTANT

static const narc_layout layouts[] = {
#define STRUCTURE(type, ...)                                                                                           \
    {#type, sizeof(type), _Alignof(type), members_of_##type, sizeof members_of_##type / sizeof *members_of_##type},
#define ENUMERATION(type)          {#type, sizeof(type), _Alignof(type), NULL, 0},
#define CONSTANT(name)
#include "declared.h"
#undef STRUCTURE
#undef ENUMERATION
#undef CONSTANT
};

static const narc_constant constants[] = {
#define STRUCTURE(type, ...)
#define ENUMERATION(type)
#define CONSTANT(name)             {#name, (double)(name)},
#include "declared.h"
};
/* clang-format on */

const narc_layout *narc_get_layout(size_t index) {
    return index < sizeof layouts / sizeof *layouts ? &layouts[index] : NULL;
}

const narc_constant *narc_get_constant(size_t index) {
    return index < sizeof constants / sizeof *constants ? &constants[index] : NULL;
}

const narc_layout *narc_find_layout(const char *name) {
    size_t k = 0;
    while (narc_get_layout(k) && strcmp(layouts[k].name, name) != 0)
        k++;
    return narc_get_layout(k);
}

/* ------------------------------------------------------------------------------------------------ JSON */

typedef struct writer {
    char *text;
    size_t capacity, size;
} writer;

PRINTF_LIKE(2, 3)
static void put(writer *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const size_t room = w->size < w->capacity ? w->capacity - w->size : 0;
    const int size = vsnprintf(room ? w->text + w->size : NULL, room, format, arguments);
    va_end(arguments);
    w->size += size > 0 ? (size_t)size : 0;
}

/* As strtod() in the locale "C" reads it. */
static void put_number(writer *w, double value) {
    char digits[32];
    snprintf(digits, sizeof digits, "%.17g", value);
    const size_t before = strspn(digits, "-+0123456789e"), after = strcspn(digits + before, "0123456789");
    put(w, "%.*s%s%s", (int)before, digits, after ? "." : "", digits + before + after);
}

static void put_layout(writer *w, const narc_layout *layout) {
    put(w, "  \"%s\": {\"size\": %zu, \"alignment\": %zu, \"members\": [", layout->name, layout->size,
        layout->alignment);
    for (size_t k = 0; k < layout->member_count; k++) {
        const narc_member *const m = &layout->members[k];
        put(w, "%s\n    {\"name\": \"%s\", \"type\": \"%s\", \"offset\": %zu, \"size\": %zu, \"count\": %zu}",
            k ? "," : "", m->name, m->type, m->offset, m->size, m->count);
    }
    put(w, "]}");
}

size_t narc_write_layouts(char *out_text, size_t capacity) {
    const uint16_t one = 1;
    writer w = {out_text, capacity, 0};
    put(&w, "{\"version\": \"%s\", \"little_endian\": %s, \"layouts\": {\n", narc_version(),
        *(const uint8_t *)&one ? "true" : "false");
    for (size_t k = 0; narc_get_layout(k); k++) {
        put(&w, k ? ",\n" : "");
        put_layout(&w, &layouts[k]);
    }
    put(&w, "},\n\"constants\": {");
    for (size_t k = 0; narc_get_constant(k); k++) {
        put(&w, "%s\n  \"%s\": ", k ? "," : "", constants[k].name);
        put_number(&w, constants[k].value);
    }
    put(&w, "}}\n");
    return w.size;
}
