/* SPDX-License-Identifier: MIT
 *
 * json_place.c - steps over the values of a JSON text. The text is known to be valid: minding strings and nesting is
 * enough.
 */
#include "json_place.h"

#include <stdbool.h>

/* What cJSON takes for a blank. */
static bool is_blank(char c) { return (unsigned char)c <= ' ' && c; }

const char *narc_skip_json_blanks(const char *at) {
    while (is_blank(*at)) {
        at++;
    }
    return at;
}

const char *narc_skip_json_string(const char *at) {
    for (at++; *at && *at != '"'; at++) {
        at += *at == '\\' && at[1];
    }
    return *at ? at + 1 : at;
}

size_t narc_measure_json_value(const char *value) {
    const char *at = value;
    size_t depth = 0;
    while (*at) {
        const bool opens = *at == '[' || *at == '{', closes = *at == ']' || *at == '}';
        if (depth == 0 && (closes || *at == ',' || *at == ':' || is_blank(*at))) {
            break;
        }
        depth += opens;
        depth -= closes;
        at = *at == '"' ? narc_skip_json_string(at) : at + 1;
        if (depth == 0 && closes) {
            break;
        }
    }
    return (size_t)(at - value);
}

/* From the key of a member to its value; elements of lists have no key. */
static const char *skip_key(const char *at, bool is_object) {
    if (!is_object || *at != '"') {
        return at;
    }
    at = narc_skip_json_blanks(narc_skip_json_string(at));
    return *at == ':' ? narc_skip_json_blanks(at + 1) : at;
}

static const char *find_child(const char *parent, size_t step) {
    const bool is_object = *parent == '{';
    if (!is_object && *parent != '[') {
        return parent;
    }
    const char *at = skip_key(narc_skip_json_blanks(parent + 1), is_object);
    for (; step > 0; step--) {
        at = narc_skip_json_blanks(at + narc_measure_json_value(at));
        if (*at != ',') {
            return parent;
        }
        at = skip_key(narc_skip_json_blanks(at + 1), is_object);
    }
    return *at == ']' || *at == '}' ? parent : at;
}

const char *narc_find_json_value(const char *text, const size_t *steps, size_t count) {
    const char *at = narc_skip_json_blanks(text);
    for (size_t k = 0; k < count; k++) {
        const char *child = find_child(at, steps[k]);
        if (child == at) {
            break;
        }
        at = child;
    }
    return at;
}
