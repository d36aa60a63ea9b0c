/* SPDX-License-Identifier: MIT
 *
 * schema.c - objects of JSON by tables of their keys.
 */
#include "schema.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 40 }; /* of what is shown of a file */

/* _Exit() drops what is still buffered: nothing more gets written. */
void fail(const char *format, ...) {
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

json_value json_read_file(const char *path) {
    char error[512];
    size_t size, line = 1;
    char *text = dem_read_file(path, &size, error);
    if (!text)
        fail("%s", error);
    const char *end = text, *cut = strstr(text, "\\u0000"); /* cJSON would end a string there */
    errno = 0;                                              /* cJSON does not tell what is wrong; malloc() does */
    json_value root = {.file = path, .item = cJSON_ParseWithOpts(text, &end, true)};
    if (!root.item && errno == ENOMEM)
        fail("%s: not enough memory", path);
    end = root.item && cut ? cut : end;
    if (!root.item || end != text + size) {
        for (const char *c = text; c < end; c++)
            line += *c == '\n';
        fail("%s: line %zu: not valid JSON here: '%.*s'", path, line, LONGEST, end);
    }
    free(text);
    return root;
}

void json_fail(const json_value *value, const char *problem) {
    const char *colon = value->place[0] ? ": " : "", *text = cJSON_PrintUnformatted(value->item);
    if (text)
        fail("%s: %s%s%s '%.*s%s'", value->file, value->place, colon, problem, LONGEST, text,
             strlen(text) > LONGEST ? "..." : "");
    fail("%s: %s%s%s", value->file, value->place, colon, problem);
}

/* ------------------------------------------------------------------------------------------------ members, items */

static json_value name_member(const json_value *object, const char *key, const cJSON *item) {
    json_value member = {.file = object->file, .item = item};
    snprintf(member.place, sizeof member.place, "%.80s%s%.36s", object->place, object->place[0] ? "." : "", key);
    return member;
}

json_value json_member(const json_value *object, const char *key) {
    return name_member(object, key, cJSON_GetObjectItemCaseSensitive(object->item, key));
}

bool json_has(const json_value *object, const char *key) { return json_member(object, key).item != NULL; }

void json_require(const json_value *object, const char *key) {
    if (!cJSON_IsObject(object->item))
        json_fail(object, "is not an object");
    const json_value member = json_member(object, key);
    if (!member.item)
        json_fail(&member, "is missing");
}

void json_refuse(const json_value *object, const char *keys, const char *problem) {
    for (const char *word = keys; *word; word += strcspn(word, " "), word += *word == ' ') {
        char key[32];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(word, " "), word);
        const json_value member = json_member(object, key);
        if (member.item)
            json_fail(&member, problem);
    }
}

bool json_next(const json_value *list, json_value *item) {
    const cJSON *next = item->item ? item->item->next : list->item ? list->item->child : NULL;
    const size_t index = item->item ? item->index + 1 : 0;
    *item = (json_value){.file = list->file, .item = next, .index = index};
    if (next && next->string)
        *item = name_member(list, next->string, next);
    else
        snprintf(item->place, sizeof item->place, "%.80s[%zu]", list->place, index);
    return next != NULL;
}

/* ------------------------------------------------------------------------------------------------ values */

static double take_number(const json_value *value, double low, double high, bool open) {
    char problem[96];
    if (!cJSON_IsNumber(value->item))
        json_fail(value, "is not a number");
    const double number = value->item->valuedouble;
    if (!isfinite(number))
        json_fail(value, "is not finite");
    if (number < low || (open && number <= low)) {
        snprintf(problem, sizeof problem, open ? "is not above %g" : "is less than %g", low);
        json_fail(value, problem);
    }
    if (number > high) {
        snprintf(problem, sizeof problem, "is more than %g", high);
        json_fail(value, problem);
    }
    return number;
}

static void take_numbers(const json_value *list, size_t count, double *out_numbers) {
    char problem[64];
    snprintf(problem, sizeof problem, "is not a list of %zu numbers", count);
    if (!cJSON_IsArray(list->item) || (size_t)cJSON_GetArraySize(list->item) != count)
        json_fail(list, problem);
    for (json_value item = {0}; json_next(list, &item);)
        out_numbers[item.index] = take_number(&item, -1e300, 1e300, false);
}

static void take_text(const json_value *value, bool is_name, char *out_text, size_t size) {
    if (!cJSON_IsString(value->item))
        json_fail(value, "is not a string");
    const char *text = value->item->valuestring;
    const size_t length = strlen(text);
    if (length == 0 || length >= size)
        json_fail(value, length > 0 ? "is too long" : "is empty");
    bool wrong = text[0] == ' ' || text[length - 1] == ' ';
    for (const char *c = text; *c; c++)
        wrong |= (unsigned char)*c < 0x20 || *c == 0x7f || *c == ',' || *c == '"';
    if (is_name && wrong)
        json_fail(value, "has a comma, a quote, a control character, or a blank at its end");
    strcpy(out_text, text);
}

static void check_list(const json_value *list, double low, double high) {
    char problem[64];
    if (!cJSON_IsArray(list->item))
        json_fail(list, "is not a list");
    const double count = cJSON_GetArraySize(list->item);
    if (count < low || (high > 0 && count > high)) {
        snprintf(problem, sizeof problem, low < high ? "has more than %g items" : "is not a list of %g names", high);
        json_fail(list, count > 0 ? problem : "is empty");
    }
}

void json_take(const json_value *value, json_key key) {
    const bool any = key.low == 0 && key.high == 0;
    const int kind = key.kind & ~MUST;
    double n[4];
    if (kind == NUMBER)
        *(double *)key.out = take_number(value, any ? -1e300 : key.low, any ? 1e300 : key.high, false);
    else if (kind == POSITIVE)
        *(double *)key.out = take_number(value, 0, 1e300, true);
    else if (kind == WHOLE) {
        n[0] = take_number(value, key.low, key.high, false);
        if (n[0] != floor(n[0]))
            json_fail(value, "is not a whole number");
        *(uint64_t *)key.out = (uint64_t)n[0];
    } else if (kind == BOOL) {
        if (!cJSON_IsBool(value->item))
            json_fail(value, "is neither true nor false");
        *(bool *)key.out = cJSON_IsTrue(value->item);
    } else if (kind == PAIR) {
        take_numbers(value, 2, n);
        *(dem_vec *)key.out = (dem_vec){n[0], n[1]};
    } else if (kind == REGION) {
        take_numbers(value, 4, n);
        if (!(n[2] > n[0] && n[3] > n[1]))
            json_fail(value, "is not a region [low x, low y, high x, high y]");
        *(dem_region *)key.out = (dem_region){true, n[0], n[2], n[1], n[3]};
    } else if (kind == TEXT || kind == NAME)
        take_text(value, kind == NAME, key.out, (size_t)key.high);
    else {
        if (kind == LIST)
            check_list(value, key.low, key.high);
        *(json_value *)key.out = *value;
    }
}

void json_read(const json_value *object, const json_key *keys) {
    if (!cJSON_IsObject(object->item))
        json_fail(object, "is not an object");
    for (json_value member = {0}; json_next(object, &member);) {
        const char *name = member.item->string;
        const json_key *key = keys;
        while (key->name && strcmp(key->name, name) != 0)
            key++;
        if (!key->name)
            json_fail(&member, "is an unknown key with the value");
        if (cJSON_GetObjectItemCaseSensitive(object->item, name) != member.item)
            json_fail(&member, "is there twice, the second time as");
    }
    for (const json_key *key = keys; key->name; key++) {
        const json_value member = json_member(object, key->name);
        if (key->kind & MUST)
            json_require(object, key->name);
        if (member.item && key->out)
            json_take(&member, *key);
    }
}

size_t json_find(const json_value *name, const void *items, size_t count, size_t size, const char *problem) {
    char text[DEM_NAME_SIZE];
    take_text(name, false, text, sizeof text);
    for (size_t k = 0; k < count; k++)
        if (strcmp((const char *)items + k * size, text) == 0)
            return k;
    json_fail(name, problem);
}
