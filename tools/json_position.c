/* SPDX-License-Identifier: MIT
 *
 * json_position.c - steps over the values of a JSON text. The text is known to be valid, so that following strings and
 * nesting is enough.
 */
#include "json_position.h"

#include <stdbool.h>
#include <string.h>

/* What cJSON takes for a blank. */
static bool is_blank(char c) { return (unsigned char)c <= ' '; }

static const char *skip_blanks(const char *c) {
    while (*c && is_blank(*c)) {
        c++;
    }
    return c;
}

/* From the opening quote of a string to behind the closing one. */
static const char *skip_string(const char *c) {
    for (c++; *c && *c != '"'; c++) {
        c += *c == '\\' && c[1];
    }
    return *c ? c + 1 : c;
}

static const char *skip_value(const char *c) {
    size_t depth = 0;
    while (*c) {
        const bool opens = *c == '[' || *c == '{', closes = *c == ']' || *c == '}';
        if (depth == 0 && (closes || *c == ',' || *c == ':' || is_blank(*c))) {
            break;
        }
        depth += opens;
        depth -= closes;
        c = *c == '"' ? skip_string(c) : c + 1;
    }
    return c;
}

/* From behind a value to the next one, over the comma or colon between them. */
static const char *next_value(const char *c) {
    c = skip_blanks(c);
    return *c == ',' || *c == ':' ? skip_blanks(c + 1) : c;
}

const char *find_root(const char *text) { return skip_blanks(text); }

const char *find_member(const char *object, const char *key) {
    const size_t length = strlen(key);
    if (*object != '{') {
        return NULL;
    }
    for (const char *c = skip_blanks(object + 1); *c == '"';) {
        const char *end = skip_string(c), *value = next_value(end);
        if ((size_t)(end - c) == length + 2 && memcmp(c + 1, key, length) == 0) {
            return value;
        }
        c = next_value(skip_value(value));
    }
    return NULL;
}

const char *find_element(const char *list, size_t index) {
    if (*list != '[') {
        return NULL;
    }
    const char *c = skip_blanks(list + 1);
    for (; index > 0 && *c && *c != ']'; index--) {
        c = next_value(skip_value(c));
    }
    return *c && *c != ']' ? c : NULL;
}
