/* SPDX-License-Identifier: MIT
 *
 * json_position.c - steps over the values of a JSON text. The text is known to be valid, so that following strings and
 * nesting is enough.
 */
#include "json_position.h"

#include <string.h>

#include "../fit/json_place.h"

static const char *skip_value(const char *c) { return c + narc_measure_json_value(c); }

/* From behind a value to the next one, over the comma or colon between them. */
static const char *next_value(const char *c) {
    c = narc_skip_json_blanks(c);
    return *c == ',' || *c == ':' ? narc_skip_json_blanks(c + 1) : c;
}

const char *find_root(const char *text) { return narc_skip_json_blanks(text); }

const char *find_member(const char *object, const char *key) {
    const size_t length = strlen(key);
    if (*object != '{') {
        return NULL;
    }
    for (const char *c = narc_skip_json_blanks(object + 1); *c == '"';) {
        const char *end = narc_skip_json_string(c), *value = next_value(end);
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
    const char *c = narc_skip_json_blanks(list + 1);
    for (; index > 0 && *c && *c != ']'; index--) {
        c = next_value(skip_value(c));
    }
    return *c && *c != ']' ? c : NULL;
}
