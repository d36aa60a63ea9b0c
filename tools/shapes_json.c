/* SPDX-License-Identifier: MIT
 *
 * shapes_json.c - reads and writes the shapes file. Reading is strict: a key that is unknown, missing or there twice is
 * an error, so that a misspelt one is not silently ignored.
 */
#include "shapes_json.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "json_position.h"
#include "text.h"

enum { NOWHERE = -1 };

typedef struct reader {
    const char *path, *text;
    long shape;       /* the current one, or NOWHERE */
    const char *list; /* the current shape's arcs, points or polygon, if that is what is read */
    long element;     /* the current one of that list, or NOWHERE */
    char where[256];  /* "shape 'lens': arc 2: ", for messages */
    size_t where_end; /* length of the part that names the shape */
} reader;

/* The line on which what is read now begins: the element, else the shape, else the file's value. */
static size_t find_line(const reader *at) {
    const char *place = find_root(at->text);
    const char *inner = at->shape == NOWHERE ? NULL : find_member(place, "shapes");
    inner = inner ? find_element(inner, (size_t)at->shape) : NULL;
    place = inner ? inner : place;
    inner = inner && at->list && at->element != NOWHERE ? find_member(inner, at->list) : NULL;
    inner = inner ? find_element(inner, (size_t)at->element) : NULL;
    return line_of(at->text, inner ? inner : place);
}

PRINTF_LIKE(2, 3) static _Noreturn void fail_shape(const reader *at, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(at->path, find_line(at), "%s%s", at->where, message);
}

/* How much of a text a message shows: not all of a long one, and no part of a character. */
static int shown_length(const char *text, size_t length) {
    enum { LONGEST = 40 };
    if (length <= LONGEST) {
        return (int)length;
    }
    for (length = LONGEST; length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80;) {
        length--;
    }
    return (int)length;
}

/* "what is not a number 'value'", the value as JSON. */
static _Noreturn void fail_value(const reader *at, const cJSON *item, const char *what, const char *problem) {
    char *value = cJSON_PrintUnformatted(item);
    if (!value) {
        fail_shape(at, "%s %s", what, problem);
    }
    const int shown = shown_length(value, strlen(value));
    fail_shape(at, "%s %s '%.*s'%s", what, problem, shown, value, value[shown] ? "..." : "");
}

/* ---------------------------------------------------------------------------- checked access */

/* Every key of `object` is among `keys` (the end of the list is NULL) and there once. */
static void check_keys(const reader *at, const cJSON *object, const char *const *keys) {
    const cJSON *item, *other;
    cJSON_ArrayForEach(item, object) {
        size_t k = 0;
        while (keys[k] && strcmp(keys[k], item->string) != 0) {
            k++;
        }
        if (!keys[k]) {
            fail_shape(at, "unknown key '%s'", item->string);
        }
        for (other = object->child; other != item; other = other->next) {
            if (strcmp(other->string, item->string) == 0) {
                fail_shape(at, "key '%s' is there twice", item->string);
            }
        }
    }
}

static double as_number(const reader *at, const cJSON *item, const char *what) {
    if (!item) {
        fail_shape(at, "%s is missing", what);
    }
    if (!cJSON_IsNumber(item)) {
        fail_value(at, item, what, "is not a number");
    }
    if (!isfinite(item->valuedouble)) {
        fail_shape(at, "%s is not finite '%g'", what, item->valuedouble);
    }
    return item->valuedouble;
}

static double get_number(const reader *at, const cJSON *object, const char *key) {
    return as_number(at, cJSON_GetObjectItemCaseSensitive(object, key), key);
}

static double get_number_or_zero(const reader *at, const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    return item ? as_number(at, item, key) : 0;
}

static narc_point as_point(const reader *at, const cJSON *item, const char *what) {
    if (!item) {
        fail_shape(at, "%s is missing", what);
    }
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2) {
        fail_value(at, item, what, "is not a list of two numbers");
    }
    return (narc_point){as_number(at, item->child, what), as_number(at, item->child->next, what)};
}

/* The length of a list that must have between 1 and NARC_MAX_ARCS items. */
static size_t check_list(const reader *at, const cJSON *list, const char *key) {
    if (!cJSON_IsArray(list)) {
        fail_value(at, list, key, "is not a list");
    }
    const size_t count = (size_t)cJSON_GetArraySize(list);
    if (count == 0) {
        fail_shape(at, "%s is an empty list", key);
    }
    if (count > NARC_MAX_ARCS) {
        fail_shape(at, "%s has %zu items, at most %d are possible", key, count, NARC_MAX_ARCS);
    }
    return count;
}

static size_t get_points(reader *at, const cJSON *list, const char *key, narc_point *out_points) {
    const size_t count = check_list(at, list, key);
    const cJSON *item = list->child;
    at->list = key;
    for (size_t i = 0; i < count; i++, item = item->next) {
        char what[32];
        snprintf(what, sizeof what, "point %zu", i);
        at->element = (long)i;
        out_points[i] = as_point(at, item, what);
    }
    at->element = NOWHERE;
    return count;
}

static void check_object(const reader *at, const cJSON *item, const char *what, const char *const *keys) {
    if (!cJSON_IsObject(item)) {
        fail_value(at, item, what, "is not an object");
    }
    check_keys(at, item, keys);
}

/* ---------------------------------------------------------------------------- the forms of a shape */

typedef narc_status build_form(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                               narc_error *error);

static narc_status build_arcs(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                              narc_error *error) {
    static const char *const keys[] = {"center", "radius", "start", "end", NULL};
    (void)radius;
    const size_t count = check_list(at, item, "arcs");
    const cJSON *arc = item->child;
    at->list = "arcs";
    for (size_t i = 0; i < count; i++, arc = arc->next) {
        snprintf(at->where + at->where_end, sizeof at->where - at->where_end, "arc %zu: ", i);
        at->element = (long)i;
        check_object(at, arc, "it", keys);
        const narc_point center = as_point(at, cJSON_GetObjectItemCaseSensitive(arc, "center"), "center");
        out_arcs[i] = (narc_arc){center.x, center.y, get_number(at, arc, "radius"), get_number(at, arc, "start"),
                                 get_number(at, arc, "end")};
    }
    at->where[at->where_end] = 0;
    at->element = NOWHERE;
    *out_count = count;
    return narc_validate_arcs(out_arcs, count, error);
}

static narc_status build_points(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                narc_error *error) {
    narc_point points[NARC_MAX_ARCS];
    const size_t count = get_points(at, item, "points", points);
    return narc_build_points(points, count, radius, out_arcs, out_count, error);
}

static narc_status build_polygon(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                 narc_error *error) {
    narc_point points[NARC_MAX_ARCS];
    const size_t count = get_points(at, item, "polygon", points);
    return narc_build_polygon(points, count, radius, out_arcs, out_count, error);
}

static narc_status build_circle(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                narc_error *error) {
    (void)radius;
    return narc_build_circle(as_number(at, item, "circle"), out_arcs, out_count, error);
}

static narc_status build_capsule(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                 narc_error *error) {
    static const char *const keys[] = {"length", "radius", NULL};
    (void)radius;
    check_object(at, item, "capsule", keys);
    return narc_build_capsule(get_number(at, item, "length"), get_number(at, item, "radius"), out_arcs, out_count,
                              error);
}

static narc_status build_box(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                             narc_error *error) {
    static const char *const keys[] = {"width", "height", "radius", NULL};
    (void)radius;
    check_object(at, item, "box", keys);
    return narc_build_box(get_number(at, item, "width"), get_number(at, item, "height"),
                          get_number_or_zero(at, item, "radius"), out_arcs, out_count, error);
}

static const struct {
    const char *key;
    bool takes_radius; /* a key "radius" may stand beside it */
    build_form *build;
} forms[] = {
    {"arcs", false, build_arcs},     {"points", true, build_points},    {"polygon", true, build_polygon},
    {"circle", false, build_circle}, {"capsule", false, build_capsule}, {"box", false, build_box},
};
enum { FORM_COUNT = sizeof forms / sizeof forms[0] };

/* ---------------------------------------------------------------------------- shapes */

/* Finds the one form that a shape has. */
static size_t find_form(const reader *at, const cJSON *object) {
    size_t found = FORM_COUNT;
    for (size_t i = 0; i < FORM_COUNT; i++) {
        if (cJSON_GetObjectItemCaseSensitive(object, forms[i].key)) {
            if (found < FORM_COUNT) {
                fail_shape(at, "it has both '%s' and '%s'", forms[found].key, forms[i].key);
            }
            found = i;
        }
    }
    if (found == FORM_COUNT) {
        fail_shape(at, "none of arcs, points, polygon, circle, capsule and box is there");
    }
    return found;
}

/* The name of shape number `index`. */
static const char *get_name(const reader *at, const cJSON *object, size_t index) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "name");
    if (!item) {
        fail_shape(at, "name is missing");
    }
    if (!cJSON_IsString(item)) {
        fail_value(at, item, "name", "is not a string");
    }
    const char *name = item->valuestring;
    if (!is_shape_name(name)) {
        fail_shape(at,
                   "a name cannot be empty, begin or end with a blank, or hold commas, quotes, control characters "
                   "or invalid UTF-8 '%s'",
                   name);
    }
    uint64_t number;
    if (!name[strspn(name, "0123456789")] && !(parse_whole(name, index, &number) && number == index)) {
        fail_shape(at, "a name of digits would be taken for the index of another shape '%s'", name);
    }
    return name;
}

/* Is the builder's error about one arc, point or side? Number 0 may also mean none; but then the message does not begin
 * like "arc 0: ". */
static bool names_element(const narc_error *error) {
    size_t number;
    return error->index > 0 || (sscanf(error->message, "%*[a-z] %zu:", &number) == 1 && number == 0);
}

static void read_shape(reader *at, const cJSON *object, size_t index, shape_list *shapes) {
    at->shape = (long)index;
    at->list = NULL;
    at->element = NOWHERE;
    snprintf(at->where, sizeof at->where, "shape %zu: ", index);
    if (!cJSON_IsObject(object)) {
        fail_value(at, object, "it", "is not an object");
    }
    const char *name = get_name(at, object, index);
    snprintf(at->where, sizeof at->where, "shape '%.100s': ", name);
    at->where_end = strlen(at->where);
    static const char *const keys[] = {"name", "arcs", "points", "polygon", "circle", "capsule", "box", "radius", NULL};
    check_keys(at, object, keys);
    const size_t form = find_form(at, object);
    if (!forms[form].takes_radius && cJSON_GetObjectItemCaseSensitive(object, "radius")) {
        fail_shape(at, "'%s' takes no 'radius' beside it", forms[form].key);
    }
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, forms[form].key);
    if (forms[form].build(at, item, get_number_or_zero(at, object, "radius"), arcs, &count, &error) != NARC_OK ||
        add_shape(shapes, name, arcs, count, &error) != NARC_OK) {
        at->element = names_element(&error) ? (long)error.index : NOWHERE;
        fail_shape(at, "%s", error.message);
    }
}

/* Reports a text that is no JSON, with what stands where it goes wrong. */
static _Noreturn void fail_syntax(const char *path, const char *text, const char *position) {
    const size_t line = line_of(text, position);
    const size_t rest = strcspn(position, "\r\n");
    if (!*position) {
        fail_at(path, line, "not valid JSON: it ends too early");
    }
    fail_at(path, line, "not valid JSON here '%.*s'", shown_length(position, rest), position);
}

/* cJSON ends a string at a NUL character, and so would cut it without a word. */
static void refuse_nul(const char *path, const char *text) {
    for (const char *c = text; (c = strchr(c, '\\')); c += 2) {
        if (strncmp(c + 1, "u0000", 5) == 0) {
            fail_at(path, line_of(text, c), "a NUL character '\\u0000'");
        }
    }
}

void read_shapes(const char *path, shape_list *out_shapes) {
    *out_shapes = (shape_list){0};
    size_t size;
    char *text = read_text(path, &size);
    reader at = {.path = path, .text = text, .shape = NOWHERE, .element = NOWHERE};
    if (!text[strspn(text, " \t\r\n")]) {
        fail_at(path, 1, "the file is empty");
    }
    const char *end = text;
    cJSON *root = cJSON_ParseWithLengthOpts(text, size + 1, &end, true);
    if (!root) {
        fail_syntax(path, text, end);
    }
    refuse_nul(path, text);
    static const char *const keys[] = {"shapes", NULL};
    check_object(&at, root, "the file's value", keys);
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "shapes");
    if (!list) {
        fail_shape(&at, "shapes is missing");
    }
    if (!cJSON_IsArray(list)) {
        fail_value(&at, list, "shapes", "is not a list");
    }
    if (!list->child) {
        fail_shape(&at, "shapes is an empty list");
    }
    const cJSON *item;
    size_t index = 0;
    cJSON_ArrayForEach(item, list) { read_shape(&at, item, index++, out_shapes); }
    const size_t duplicate = index_shapes(out_shapes);
    if (duplicate < out_shapes->count) {
        at.shape = (long)duplicate;
        at.element = NOWHERE;
        at.where[0] = 0;
        fail_shape(&at, "another shape has that name '%s'", out_shapes->items[duplicate].name);
    }
    cJSON_Delete(root);
    free(text);
}

void write_shapes(FILE *file, const shape_list *shapes) {
    fprintf(file, "{\"shapes\": [");
    for (size_t i = 0; i < shapes->count; i++) {
        const shape *item = &shapes->items[i];
        cJSON *name = cJSON_CreateStringReference(item->name);
        char *quoted = name ? cJSON_PrintUnformatted(name) : NULL;
        if (!quoted) {
            fail("not enough memory for a name");
        }
        fprintf(file, "%s\n  {\"name\": %s, \"arcs\": [", i ? "," : "", quoted);
        cJSON_free(quoted);
        cJSON_Delete(name);
        for (size_t k = 0; k < item->arc_count; k++) {
            const narc_arc *arc = &item->arcs[k];
            fprintf(file, "%s\n    {\"center\": [%.17g, %.17g], \"radius\": %.17g, \"start\": %.17g, \"end\": %.17g}",
                    k ? "," : "", arc->center_x, arc->center_y, arc->radius, arc->start, arc->end);
        }
        fprintf(file, "\n  ]}");
    }
    fprintf(file, "\n]}\n");
}
