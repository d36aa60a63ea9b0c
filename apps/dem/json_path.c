/* SPDX-License-Identifier: MIT
 *
 * json_path.c - checked numbers of options, checked access to JSON.
 */
#include "json_path.h"

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

unsigned long long read_whole(const char *option, const char *text, unsigned long long low, unsigned long long high) {
    char *end;
    const unsigned long long value = strtoull(text, &end, 10); /* of a number that is too large, the largest */
    if (text[strspn(text, "0123456789")] || end == text || value < low || value > high)
        fail("%s must be a whole number from %llu to %llu, not '%.*s'", option, low, high, LONGEST, text);
    return value;
}

json_value json_read(const char *path) {
    char error[512];
    size_t size, line = 1;
    char *text = dem_read_file(path, &size, error);
    if (!text)
        fail("%s", error);
    const char *end = text, *cut = strstr(text, "\\u0000"); /* cJSON would end a string there */
    json_value root = {.file = path, .item = cJSON_ParseWithOpts(text, &end, true)};
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

json_value json_member(const json_value *object, const char *key) {
    json_value member = {.file = object->file, .item = cJSON_GetObjectItemCaseSensitive(object->item, key)};
    snprintf(member.place, sizeof member.place, "%.80s%s%.36s", object->place, object->place[0] ? "." : "", key);
    return member;
}

json_value json_require(const json_value *object, const char *key) {
    const json_value member = json_member(object, key);
    if (!member.item)
        json_fail(&member, "is missing");
    return member;
}

json_value json_at(const json_value *list, size_t index) {
    json_value item = {.file = list->file, .item = cJSON_GetArrayItem(list->item, (int)index)};
    snprintf(item.place, sizeof item.place, "%.80s[%zu]", list->place, index);
    return item;
}

static bool is_among(const char *keys, const char *key) {
    const size_t length = strlen(key);
    if (length == 0 || strchr(key, ' '))
        return false;
    for (const char *at = keys; (at = strstr(at, key)); at += length)
        if ((at == keys || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return true;
    return false;
}

void json_refuse(const json_value *object, const char *keys, const char *problem) {
    const cJSON *item;
    cJSON_ArrayForEach(item, object->item) {
        const json_value member = json_member(object, item->string);
        if (is_among(keys, item->string))
            json_fail(&member, problem);
    }
}

void json_check_object(const json_value *object, const char *keys) {
    const cJSON *item, *other;
    if (!cJSON_IsObject(object->item))
        json_fail(object, "is not an object");
    cJSON_ArrayForEach(item, object->item) {
        json_value member = {.file = object->file, .item = item};
        snprintf(member.place, sizeof member.place, "%.80s%s%.36s", object->place, object->place[0] ? "." : "",
                 item->string);
        if (!is_among(keys, item->string))
            json_fail(&member, "is an unknown key with the value");
        for (other = object->item->child; other != item; other = other->next)
            if (strcmp(other->string, item->string) == 0)
                json_fail(&member, "is there twice, the second time as");
    }
}

size_t json_list(const json_value *list) {
    if (!cJSON_IsArray(list->item))
        json_fail(list, "is not a list");
    return (size_t)cJSON_GetArraySize(list->item);
}

double json_number(const json_value *value, double low, double high, bool open) {
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

double json_positive(const json_value *object, const char *key) {
    const json_value member = json_require(object, key);
    return json_number(&member, 0, 1e300, true);
}

double json_number_or(const json_value *object, const char *key, double low, double high, double otherwise) {
    const json_value member = json_member(object, key);
    return member.item ? json_number(&member, low, high, false) : otherwise;
}

size_t json_whole(const json_value *value, size_t low, size_t high) {
    const double number = json_number(value, (double)low, (double)high, false);
    if (number != floor(number))
        json_fail(value, "is not a whole number");
    return (size_t)number;
}

bool json_bool_or(const json_value *object, const char *key, bool otherwise) {
    const json_value member = json_member(object, key);
    if (member.item && !cJSON_IsBool(member.item))
        json_fail(&member, "is neither true nor false");
    return member.item ? cJSON_IsTrue(member.item) : otherwise;
}

void json_numbers(const json_value *list, size_t count, double *out_numbers) {
    char problem[64];
    if (!cJSON_IsArray(list->item) || (size_t)cJSON_GetArraySize(list->item) != count) {
        snprintf(problem, sizeof problem, "is not a list of %zu numbers", count);
        json_fail(list, problem);
    }
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(list, i);
        out_numbers[i] = json_number(&item, -1e300, 1e300, false);
    }
}

dem_vec json_vec(const json_value *list) {
    double n[2];
    json_numbers(list, 2, n);
    return (dem_vec){n[0], n[1]};
}

dem_vec json_vec_or(const json_value *object, const char *key, dem_vec otherwise) {
    const json_value member = json_member(object, key);
    return member.item ? json_vec(&member) : otherwise;
}

void json_text(const json_value *value, char *out_text, size_t size) {
    if (!cJSON_IsString(value->item))
        json_fail(value, "is not a string");
    const char *text = value->item->valuestring;
    if (text[0] == 0 || strlen(text) >= size)
        json_fail(value, text[0] ? "is too long" : "is empty");
    strcpy(out_text, text);
}

void json_name(const json_value *value, char *out_text, size_t size) {
    json_text(value, out_text, size);
    bool wrong = out_text[0] == ' ' || out_text[strlen(out_text) - 1] == ' ';
    for (const char *c = out_text; *c; c++)
        wrong |= (unsigned char)*c < 0x20 || *c == 0x7f || *c == ',' || *c == '"';
    if (wrong)
        json_fail(value, "has a comma, a quote, a control character, or a blank at its end");
}

size_t json_find(const json_value *name, const void *items, size_t count, size_t size, const char *problem) {
    char text[DEM_NAME_SIZE];
    json_text(name, text, sizeof text);
    for (size_t k = 0; k < count; k++)
        if (strcmp((const char *)items + k * size, text) == 0)
            return k;
    json_fail(name, problem);
}
