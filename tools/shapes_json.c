/* SPDX-License-Identifier: MIT
 *
 * shapes_json.c - reads and writes the shapes file. Reading is strict: a key that is unknown, missing or there twice is
 * an error, so that a misspelt one is not silently ignored.
 */
#include "shapes_json.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "json.h"
#include "text.h"

/* What is read now, for messages. */
typedef struct reader {
    const char *path;
    char shape[64];   /* "shape 'lens'"; empty: the file's value */
    char element[32]; /* "arc 2"; empty: the shape itself */
} reader;

/* "narc: shapes.json: shape 'lens', arc 2: message". */
PRINTF_LIKE(2, 3) static _Noreturn void fail_shape(const reader *at, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(at->path, 0, "%s%s%s%s%s", at->shape, at->element[0] ? ", " : "", at->element, at->shape[0] ? ": " : "",
            message);
}

/* "what is not a number 'value'", the value as JSON. */
static _Noreturn void fail_value(const reader *at, const cJSON *item, const char *what, const char *problem) {
    fail_shape(at, "%s %s '%s'", what, problem, narc_show_json(item).text);
}

/* ---------------------------------------------------------------------------- checked access */

/* Every key of `object` is among `keys` (the end of the list is NULL) and there once. */
static void check_keys(const reader *at, const cJSON *object, const char *const *keys) {
    const cJSON *item, *other;
    cJSON_ArrayForEach(item, object) {
        size_t k = 0;
        while (keys[k] && strcmp(keys[k], item->string) != 0)
            k++;
        if (!keys[k])
            fail_shape(at, "unknown key '%s'", narc_make_excerpt(item->string).text);
        for (other = object->child; other != item; other = other->next)
            if (strcmp(other->string, item->string) == 0)
                fail_shape(at, "key '%s' is there twice", narc_make_excerpt(item->string).text);
    }
}

static double as_number(const reader *at, const cJSON *item, const char *what) {
    if (!item)
        fail_shape(at, "%s is missing", what);
    if (!cJSON_IsNumber(item))
        fail_value(at, item, what, "is not a number");
    if (!isfinite(item->valuedouble))
        fail_shape(at, "%s is not finite", what);
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
    if (!item)
        fail_shape(at, "%s is missing", what);
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2)
        fail_value(at, item, what, "is not a list of two numbers");
    return (narc_point){as_number(at, item->child, what), as_number(at, item->child->next, what)};
}

/* The length of a list that must have between 1 and NARC_MAX_ARCS items. */
static size_t check_list(const reader *at, const cJSON *list, const char *key) {
    if (!cJSON_IsArray(list))
        fail_value(at, list, key, "is not a list");
    const size_t count = (size_t)cJSON_GetArraySize(list);
    if (count == 0)
        fail_shape(at, "%s is an empty list", key);
    if (count > NARC_MAX_ARCS)
        fail_shape(at, "%s has %zu items, at most %d are possible", key, count, NARC_MAX_ARCS);
    return count;
}

static size_t get_points(reader *at, const cJSON *list, const char *key, narc_point *out_points) {
    const size_t count = check_list(at, list, key);
    const cJSON *item = list->child;
    for (size_t i = 0; i < count; i++, item = item->next) {
        snprintf(at->element, sizeof at->element, "point %zu", i);
        out_points[i] = as_point(at, item, "it");
    }
    at->element[0] = 0;
    return count;
}

static void check_object(const reader *at, const cJSON *item, const char *what, const char *const *keys) {
    if (!cJSON_IsObject(item))
        fail_value(at, item, what, "is not an object");
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
    for (size_t i = 0; i < count; i++, arc = arc->next) {
        snprintf(at->element, sizeof at->element, "arc %zu", i);
        check_object(at, arc, "it", keys);
        const narc_point center = as_point(at, cJSON_GetObjectItemCaseSensitive(arc, "center"), "center");
        out_arcs[i] = (narc_arc){center.x, center.y, get_number(at, arc, "radius"), get_number(at, arc, "start"),
                                 get_number(at, arc, "end")};
    }
    at->element[0] = 0;
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

static narc_status build_four_arc(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                  narc_error *error) {
    static const char *const keys[] = {"radius_low", "radius_high", "distance", "radius_left", "radius_right", NULL};
    (void)radius;
    check_object(at, item, "four_arc", keys);
    const narc_four_arc form = {.radius_low = get_number(at, item, "radius_low"),
                                .radius_high = get_number(at, item, "radius_high"),
                                .distance = get_number(at, item, "distance"),
                                .radius_left = get_number_or_zero(at, item, "radius_left"),
                                .radius_right = get_number_or_zero(at, item, "radius_right")};
    return narc_build_four_arc(form, out_arcs, out_count, error);
}

static const struct {
    const char *key;
    bool takes_radius; /* a key "radius" may stand beside it */
    build_form *build;
} forms[] = {
    {"arcs", false, build_arcs},         {"points", true, build_points},    {"polygon", true, build_polygon},
    {"circle", false, build_circle},     {"capsule", false, build_capsule}, {"box", false, build_box},
    {"four_arc", false, build_four_arc},
};
enum { FORM_COUNT = sizeof forms / sizeof forms[0] };

/* ---------------------------------------------------------------------------- shapes */

/* Finds the one form that a shape has. */
static size_t find_form(const reader *at, const cJSON *object) {
    size_t found = FORM_COUNT;
    for (size_t i = 0; i < FORM_COUNT; i++) {
        if (cJSON_GetObjectItemCaseSensitive(object, forms[i].key)) {
            if (found < FORM_COUNT)
                fail_shape(at, "it has both '%s' and '%s'", forms[found].key, forms[i].key);
            found = i;
        }
    }
    if (found == FORM_COUNT)
        fail_shape(at, "none of arcs, points, polygon, circle, capsule, box and four_arc is there");
    return found;
}

/* The name of shape number `index`. */
static const char *get_name(const reader *at, const cJSON *object, size_t index) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "name");
    if (!item)
        fail_shape(at, "name is missing");
    if (!cJSON_IsString(item))
        fail_value(at, item, "name", "is not a string");
    const char *name = item->valuestring;
    if (!is_shape_name(name)) {
        fail_shape(at,
                   "a name cannot be empty, begin or end with a blank, or hold commas, quotes, control characters "
                   "or invalid UTF-8 '%s'",
                   narc_make_excerpt(name).text);
    }
    uint64_t number;
    if (!name[strspn(name, "0123456789")] && !(parse_whole(name, index, &number) && number == index)) {
        fail_shape(at, "a name of digits would be taken for the index of another shape '%s'",
                   narc_make_excerpt(name).text);
    }
    return name;
}

/* Reports a builder's error, which may begin with what it is about: "arc 2: ". */
static _Noreturn void fail_build(reader *at, const narc_error *error) {
    int length = 0;
    if (sscanf(error->message, "%*[a-z] %*u%n", &length) == 0 && length && error->message[length] == ':') {
        snprintf(at->element, sizeof at->element, "%.*s", length, error->message);
        fail_shape(at, "%s", error->message + length + 2);
    }
    fail_shape(at, "%s", error->message);
}

static void read_shape(const char *path, const cJSON *object, size_t index, shape_list *shapes) {
    reader at = {.path = path};
    snprintf(at.shape, sizeof at.shape, "shape %zu", index);
    if (!cJSON_IsObject(object))
        fail_value(&at, object, "it", "is not an object");
    const char *name = get_name(&at, object, index);
    snprintf(at.shape, sizeof at.shape, "shape '%s'", narc_make_excerpt(name).text);
    static const char *const keys[] = {"name", "origin", "arcs",    "points",   "polygon", "circle",
                                       "box",  "radius", "capsule", "four_arc", NULL};
    check_keys(&at, object, keys);
    const size_t form = find_form(&at, object);
    if (!forms[form].takes_radius && cJSON_GetObjectItemCaseSensitive(object, "radius"))
        fail_shape(&at, "'%s' takes no 'radius' beside it", forms[form].key);
    const cJSON *origin = cJSON_GetObjectItemCaseSensitive(object, "origin");
    if (origin)
        as_point(&at, origin, "origin");
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, forms[form].key);
    if (forms[form].build(&at, item, get_number_or_zero(&at, object, "radius"), arcs, &count, &error) != NARC_OK ||
        add_shape(shapes, name, arcs, count, &error) != NARC_OK)
        fail_build(&at, &error);
}

void read_shapes(const char *path, shape_list *out_shapes) {
    *out_shapes = (shape_list){0};
    char *text = read_text(path);
    const reader at = {.path = path};
    cJSON *root;
    narc_error error;
    if (narc_parse_json(text, &root, &error) != NARC_OK)
        fail_text(path, &error);
    free(text);
    static const char *const keys[] = {"shapes", NULL};
    check_object(&at, root, "the file's value", keys);
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "shapes");
    if (!list)
        fail_shape(&at, "shapes is missing");
    if (!cJSON_IsArray(list))
        fail_value(&at, list, "shapes", "is not a list");
    if (!list->child)
        fail_shape(&at, "shapes is an empty list");
    const cJSON *item;
    size_t index = 0;
    cJSON_ArrayForEach(item, list) { read_shape(path, item, index++, out_shapes); }
    const size_t duplicate = index_shapes(out_shapes);
    if (duplicate < out_shapes->count) {
        fail_shape(&at, "shape %zu: another shape has that name '%s'", duplicate,
                   narc_make_excerpt(out_shapes->items[duplicate].name).text);
    }
    cJSON_Delete(root);
}

void write_name(FILE *file, const char *name) {
    cJSON *value = cJSON_CreateStringReference(name);
    char *quoted = value ? cJSON_PrintUnformatted(value) : NULL;
    if (!quoted)
        fail("not enough memory for a name");
    fputs(quoted, file);
    cJSON_free(quoted);
    cJSON_Delete(value);
}

void write_shapes(FILE *file, const shape_list *shapes) {
    fprintf(file, "{\"shapes\": [");
    for (size_t i = 0; i < shapes->count; i++) {
        const shape *item = &shapes->items[i];
        fprintf(file, "%s\n  {\"name\": ", i ? "," : "");
        write_name(file, item->name);
        fprintf(file, ", \"origin\": [%.17g, %.17g], \"arcs\": [", item->origin.x, item->origin.y);
        for (size_t k = 0; k < item->arc_count; k++) {
            const narc_arc *arc = &item->arcs[k];
            fprintf(file, "%s\n    {\"center\": [%.17g, %.17g], \"radius\": %.17g, \"start\": %.17g, \"end\": %.17g}",
                    k ? "," : "", arc->center_x, arc->center_y, arc->radius, arc->start, arc->end);
        }
        fprintf(file, "\n  ]}");
    }
    fprintf(file, "\n]}\n");
}
