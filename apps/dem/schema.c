/* SPDX-License-Identifier: MIT
 *
 * schema.c - objects of JSON by tables of their keys.
 */
#include "schema.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 40 }; /* of what is shown of a file */

json_value json_read_file(const char *path) {
    size_t size, line = 1;
    char *text = dem_read_file(path, &size);
    const char *end = text, *cut = strstr(text, "\\u0000"); /* cJSON would end a string there */
    errno = 0;                                              /* cJSON does not tell what is wrong; malloc() does */
    json_value root = {.file = path, .item = cJSON_ParseWithOpts(text, &end, true)};
    if (!root.item && errno == ENOMEM)
        dem_quit("%s: not enough memory", path);
    end = root.item && cut ? cut : end;
    if (!root.item || end != text + size) {
        for (const char *c = text; c < end; c++)
            line += *c == '\n';
        dem_quit("%s: line %zu: not valid JSON here: '%.*s'", path, line, LONGEST, end);
    }
    dem_release(text);
    return root;
}

void json_fail(const json_value *value, const char *problem) {
    const char *colon = value->path[0] ? ": " : "", *text = cJSON_PrintUnformatted(value->item);
    if (text)
        dem_quit("%s: %s%s%s '%.*s%s'", value->file, value->path, colon, problem, LONGEST, text,
                 strlen(text) > LONGEST ? "..." : "");
    dem_quit("%s: %s%s%s", value->file, value->path, colon, problem);
}

/* ------------------------------------------------------------------------------------------------ members, items */

static json_value name_member(const json_value *object, const char *key, const cJSON *item) {
    json_value member = {.file = object->file, .item = item};
    snprintf(member.path, sizeof member.path, "%.80s%s%.36s", object->path, object->path[0] ? "." : "", key);
    return member;
}

json_value json_member(const json_value *object, const char *key) {
    return name_member(object, key, cJSON_GetObjectItemCaseSensitive(object->item, key));
}

bool json_has(const json_value *object, const char *key) { return json_member(object, key).item != NULL; }

void json_refuse(const json_value *object, const char *key, const char *problem) {
    const json_value member = json_member(object, key);
    if (member.item)
        json_fail(&member, problem);
}

bool json_next(const json_value *list, json_value *item) {
    const cJSON *next = item->item ? item->item->next : list->item ? list->item->child : NULL;
    const size_t index = item->item ? item->index + 1 : 0;
    *item = (json_value){.file = list->file, .item = next};
    if (next && next->string)
        *item = name_member(list, next->string, next);
    else
        snprintf(item->path, sizeof item->path, "%.80s[%zu]", list->path, index);
    item->index = index;
    return next != NULL;
}

/* ------------------------------------------------------------------------------------------------ values */

/* With a number in the problem. */
static _Noreturn void fail_by(const json_value *value, const char *format, double number) {
    char problem[96];
    snprintf(problem, sizeof problem, format, number);
    json_fail(value, problem);
}

static double take_number(const json_value *value, double low, double high, bool open) {
    if (!cJSON_IsNumber(value->item))
        json_fail(value, "is not a number");
    const double number = value->item->valuedouble;
    if (!isfinite(number))
        json_fail(value, "is not finite");
    if (number < low || (open && number <= low))
        fail_by(value, open ? "is not above %g" : "is less than %g", low);
    if (number > high)
        fail_by(value, "is more than %g", high);
    return number;
}

static void take_numbers(const json_value *list, size_t count, double *out_numbers) {
    if (!cJSON_IsArray(list->item) || (size_t)cJSON_GetArraySize(list->item) != count)
        fail_by(list, "is not a list of %g numbers", (double)count);
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

size_t json_find(const json_names *names, const char *name) {
    size_t k = 0;
    while (k < names->count && strcmp((const char *)names->items + k * names->size, name) != 0)
        k++;
    return k;
}

static uint32_t take_choice(const json_value *value, const json_names *names) {
    char text[DEM_NAME_SIZE];
    take_text(value, false, text, sizeof text);
    const size_t k = json_find(names, text);
    if (k == names->count)
        json_fail(value, names->problem);
    return (uint32_t)k;
}

void json_check_new(const json_value *object, const char *name, json_names before) {
    if (json_find(&before, name) < before.count)
        json_refuse(object, "name", before.problem);
}

static void check_list(const json_value *list, double low, double high) {
    if (!cJSON_IsArray(list->item))
        json_fail(list, "is not a list");
    const double count = cJSON_GetArraySize(list->item);
    if (count == 0 && low > 0)
        json_fail(list, "is empty");
    if (count < low || (high > 0 && count > high))
        fail_by(list, low < high ? "has more than %g items" : "is not a list of %g names", high);
}

void json_take(const json_value *value, json_key key) {
    const bool any = key.low == 0 && key.high == 0;
    double n[4];
    switch (key.kind & ~MUST) {
    case NUMBER:
        *(double *)key.out = take_number(value, any ? -1e300 : key.low, any ? 1e300 : key.high, false);
        break;
    case POSITIVE:
        *(double *)key.out = take_number(value, 0, 1e300, true);
        break;
    case WHOLE:
        n[0] = take_number(value, key.low, key.high, false);
        if (n[0] != floor(n[0]))
            json_fail(value, "is not a whole number");
        *(uint64_t *)key.out = (uint64_t)n[0];
        break;
    case BOOL:
        if (!cJSON_IsBool(value->item))
            json_fail(value, "is neither true nor false");
        *(bool *)key.out = cJSON_IsTrue(value->item);
        break;
    case PAIR:
        take_numbers(value, 2, n);
        *(vec *)key.out = (vec){n[0], n[1]};
        break;
    case REGION:
        take_numbers(value, 4, n);
        if (!(n[2] > n[0] && n[3] > n[1]))
            json_fail(value, "is not a region [low x, low y, high x, high y]");
        *(dem_region *)key.out = (dem_region){true, {n[0], n[1]}, {n[2], n[3]}};
        break;
    case TEXT:
        take_text(value, false, key.out, (size_t)key.high);
        break;
    case NAME:
        take_text(value, true, key.out, (size_t)key.high);
        break;
    case ONE_OF:
        *(uint32_t *)key.out = take_choice(value, key.names);
        break;
    case SOME_OF:
        check_list(value, key.low, key.high);
        for (json_value item = {0}; json_next(value, &item);)
            ((uint32_t *)key.out)[item.index] = take_choice(&item, key.names);
        break;
    case LIST:
        check_list(value, key.low, key.high);
        *(json_value *)key.out = *value;
        break;
    case OBJECT:
        json_read(value, key.out);
        break;
    default:
        if (key.out)
            *(json_value *)key.out = *value;
    }
}

void json_read_some(const json_value *object, const json_key *keys) {
    if (!cJSON_IsObject(object->item))
        json_fail(object, "is not an object");
    for (const json_key *key = keys; key->name; key++) {
        const json_value member = json_member(object, key->name);
        if (member.item && key->no)
            json_fail(&member, key->no);
        if (member.item)
            json_take(&member, *key);
        else if (key->kind & MUST && !key->no)
            json_fail(&member, "is missing");
    }
}

void json_read(const json_value *object, const json_key *keys) {
    for (json_value member = {0}; cJSON_IsObject(object->item) && json_next(object, &member);) {
        const char *name = member.item->string;
        const json_key *key = keys;
        while (key->name && strcmp(key->name, name) != 0)
            key++;
        if (!key->name)
            json_fail(&member, "is an unknown key with the value");
        if (cJSON_GetObjectItemCaseSensitive(object->item, name) != member.item)
            json_fail(&member, "is there twice, the second time as");
    }
    json_read_some(object, keys);
}
