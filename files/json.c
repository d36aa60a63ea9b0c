/* SPDX-License-Identifier: MIT
 *
 * json.c - JSON by cJSON, with messages.
 */
#include "json.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "error.h"

/* Lists and objects that are open before `end`, a place in valid JSON. */
static size_t count_open(const char *text, const char *end) {
    size_t open = 0;
    bool is_string = false;
    for (; text < end; text++)
        if (*text == '"')
            is_string = !is_string;
        else if (is_string)
            text += *text == '\\';
        else if (*text == '[' || *text == '{')
            open++;
        else if (*text == ']' || *text == '}')
            open--;
    return open;
}

narc_status narc_parse_json(const char *text, cJSON **out_value, narc_error *error) {
    const char *end = text;
    errno = 0; /* cJSON does not tell what is wrong; malloc() does */
    cJSON *value = cJSON_ParseWithOpts(text, &end, true);
    if (!value && errno == ENOMEM)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for JSON of %zu bytes", strlen(text));
    if (!value) {
        const size_t line = narc_find_line(text, end);
        if ((*end == '[' || *end == '{') && count_open(text, end) >= CJSON_NESTING_LIMIT)
            return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: lists and objects nested more than %d deep",
                             line, CJSON_NESTING_LIMIT);
        return *end ? narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not valid JSON here: '%s'", line,
                                narc_make_excerpt(end).text)
                    : narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not valid JSON: it ends too early", line);
    }
    for (const char *c = text; (c = strchr(c, '\\')); c += 2) {
        if (strncmp(c + 1, "u0000", 5) == 0) {
            const size_t line = narc_find_line(text, c);
            cJSON_Delete(value);
            return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: a NUL character '\\u0000'", line);
        }
    }
    *out_value = value;
    return NARC_OK;
}

narc_excerpt narc_show_json(const cJSON *value) {
    char *text = cJSON_PrintUnformatted(value);
    const narc_excerpt shown = narc_make_excerpt(text ? text : "");
    cJSON_free(text);
    return shown;
}

/* Adds the number of keys and values in front of `item`, in the order of the text; false if it is not in `value`. */
static bool count_before(const cJSON *value, const cJSON *item, size_t *count) {
    if (value == item)
        return true;
    *count += 1;
    for (const cJSON *child = value->child; child; child = child->next) {
        *count += child->string != NULL;
        if (count_before(child, item, count))
            return true;
    }
    return false;
}

size_t narc_find_json_line(const char *text, const cJSON *root, const cJSON *item) {
    size_t before = 0;
    count_before(root, item, &before);
    for (const char *c = text;; before--) {
        while (*c && (*c <= ' ' || strchr(",:]}", *c)))
            c++;
        if (before == 0 || !*c)
            return narc_find_line(text, c);
        if (*c == '"') {
            for (c++; *c && *c != '"'; c++)
                c += *c == '\\' && c[1];
            c += *c == '"';
        } else {
            c += *c == '[' || *c == '{' ? 1 : strcspn(c, ",:]}");
        }
    }
}
