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
#include "text.h"

typedef struct reader {
    const char *path;
    size_t line;      /* where the current shape begins */
    char where[256];  /* "shape 'lens': arc 2: ", for messages */
    size_t where_end; /* length of the part that names the shape */
} reader;

PRINTF_LIKE(2, 3) static _Noreturn void fail_shape(const reader *at, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(at->path, at->line, "%s%s", at->where, message);
}

/* ---------------------------------------------------------------------------- where shapes begin */

/* The end of a string that begins at its opening quote: behind the closing one. */
static const char *skip_string(const char *c) {
    for (c++; *c && *c != '"'; c++) {
        c += *c == '\\' && c[1];
    }
    return *c ? c + 1 : c;
}

/* The lines on which the elements of the array "shapes" of the root object begin. cJSON has already accepted the text,
 * so this only follows strings and nesting. Lines that are not found stay 1. */
static size_t *find_shape_lines(const char *text, size_t count) {
    static const char key[] = "\"shapes\"";
    size_t *lines = allocate(count, sizeof *lines);
    for (size_t i = 0; i < count; i++) {
        lines[i] = 1;
    }
    size_t line = 1, depth = 0, found = 0;
    bool is_key = false, inside = false, expected = false; /* inside the array; an element may begin here */
    for (const char *c = text; *c;) {
        const char *next = *c == '"' ? skip_string(c) : c + 1;
        if (expected && !strchr(" \t\r\n]", *c) && found < count) {
            lines[found++] = line;
            expected = false;
        }
        line += *c == '\n';
        if (*c == '"' && depth == 1) {
            is_key = strncmp(c, key, sizeof key - 1) == 0;
        } else if (*c == '{' || *c == '[') {
            if (*c == '[' && depth == 1 && is_key) {
                inside = expected = true;
            }
            depth++;
        } else if (*c == '}' || *c == ']') {
            depth--;
            inside = inside && depth >= 2;
        } else if (*c == ',' && inside && depth == 2) {
            expected = true;
        }
        c = next;
    }
    return lines;
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
    if (!cJSON_IsNumber(item)) {
        fail_shape(at, item ? "%s is not a number" : "%s is missing", what);
    }
    if (!isfinite(item->valuedouble)) {
        fail_shape(at, "%s is not finite", what);
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
        fail_shape(at, "%s is not a list of two numbers", what);
    }
    return (narc_point){as_number(at, item->child, what), as_number(at, item->child->next, what)};
}

/* The length of a list that must have between 1 and NARC_MAX_ARCS items. */
static size_t check_list(const reader *at, const cJSON *list, const char *key) {
    if (!cJSON_IsArray(list)) {
        fail_shape(at, "%s is not a list", key);
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

static size_t get_points(const reader *at, const cJSON *list, const char *key, narc_point *out_points) {
    const size_t count = check_list(at, list, key);
    const cJSON *item = list->child;
    for (size_t i = 0; i < count; i++, item = item->next) {
        char what[32];
        snprintf(what, sizeof what, "%s %zu", strcmp(key, "points") == 0 ? "point" : "corner", i);
        out_points[i] = as_point(at, item, what);
    }
    return count;
}

static void check_object(const reader *at, const cJSON *item, const char *what, const char *const *keys) {
    if (!cJSON_IsObject(item)) {
        fail_shape(at, "%s is not an object", what);
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
    for (size_t i = 0; i < count; i++, arc = arc->next) {
        snprintf(at->where + at->where_end, sizeof at->where - at->where_end, "arc %zu: ", i);
        check_object(at, arc, "it", keys);
        const narc_point center = as_point(at, cJSON_GetObjectItemCaseSensitive(arc, "center"), "center");
        out_arcs[i] = (narc_arc){center.x, center.y, get_number(at, arc, "radius"), get_number(at, arc, "start"),
                                 get_number(at, arc, "end")};
    }
    at->where[at->where_end] = 0;
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

static void read_shape(reader *at, const cJSON *object, size_t index, shape_list *shapes) {
    snprintf(at->where, sizeof at->where, "shape %zu: ", index);
    if (!cJSON_IsObject(object)) {
        fail_shape(at, "it is not an object");
    }
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(object, "name");
    if (!cJSON_IsString(name)) {
        fail_shape(at, name ? "name is not a string" : "name is missing");
    }
    if (!is_shape_name(name->valuestring)) {
        fail_shape(at,
                   "a name cannot be empty, begin or end with a blank, or hold commas, quotes, control characters "
                   "or invalid UTF-8 '%s'",
                   name->valuestring);
    }
    snprintf(at->where, sizeof at->where, "shape '%.100s': ", name->valuestring);
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
        add_shape(shapes, name->valuestring, arcs, count, &error) != NARC_OK) {
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
    fail_at(path, line, "not valid JSON here '%.*s'", (int)(rest < 40 ? rest : 40), position);
}

void read_shapes(const char *path, shape_list *out_shapes) {
    *out_shapes = (shape_list){0};
    reader at = {.path = path, .line = 1};
    size_t size;
    char *text = read_text(path, &size);
    if (!text[strspn(text, " \t\r\n")]) {
        fail_at(path, 1, "the file is empty");
    }
    const char *end = text;
    cJSON *root = cJSON_ParseWithLengthOpts(text, size + 1, &end, true);
    if (!root) {
        fail_syntax(path, text, end);
    }
    static const char *const keys[] = {"shapes", NULL};
    check_object(&at, root, "the file's value", keys);
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "shapes");
    if (!cJSON_IsArray(list)) {
        fail_at(path, 1, list ? "shapes is not a list" : "shapes is missing");
    }
    if (!list->child) {
        fail_at(path, 1, "shapes is an empty list");
    }
    size_t *lines = find_shape_lines(text, (size_t)cJSON_GetArraySize(list));
    const cJSON *item;
    size_t index = 0;
    cJSON_ArrayForEach(item, list) {
        at.line = lines[index];
        read_shape(&at, item, index++, out_shapes);
    }
    const size_t duplicate = index_shapes(out_shapes);
    if (duplicate < out_shapes->count) {
        fail_at(path, lines[duplicate], "another shape has that name '%s'", out_shapes->items[duplicate].name);
    }
    free(lines);
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
