/* SPDX-License-Identifier: MIT
 *
 * shapes_file.c - reads and writes the shapes file. Reading is strict: a key that is unknown, missing or there twice is
 * an error, so that a misspelt one is not silently ignored.
 */
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "json.h"

#include "memory.h"
#include "names.h"
#include "narc_chains.h"
#include "narc_files.h"

/* What is read now, for messages. After the first error numbers are 0 and lists are empty. */
typedef struct reader {
    const char *text;
    cJSON *root;
    narc_status status; /* of the first error */
    narc_error *error;
    char shape[64];   /* "shape 'lens'"; empty: the file's value */
    char element[32]; /* "arc 2"; empty: the shape itself */
} reader;

/* "line 3: shape 'lens', arc 2: message", the line being that of `item`. */
PRINTF_LIKE(5, 6)
static void fail_shape(reader *at, narc_status status, const cJSON *item, double value, const char *format, ...) {
    char message[sizeof((narc_error *)0)->message];
    if (at->status)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const size_t line = narc_find_json_line(at->text, at->root, item);
    at->status = narc_fail(at->error, status, line, value, "line %zu: %s%s%s%s%s", line, at->shape,
                           at->element[0] ? ", " : "", at->element, at->shape[0] ? ": " : "", message);
}

/* "what is not a number 'value'", the value as JSON. */
static void fail_value(reader *at, const cJSON *item, const char *what, const char *problem) {
    fail_shape(at, NARC_ERROR_FORMAT, item, 0, "%s %s '%s'", what, problem, narc_show_json(item).text);
}

/* ---------------------------------------------------------------------------- checked access */

/* Every key of `object` is among `keys` (the end of the list is NULL) and there once. */
static void check_keys(reader *at, const cJSON *object, const char *const *keys) {
    const cJSON *item, *other;
    cJSON_ArrayForEach(item, object) {
        size_t k = 0;
        while (keys[k] && strcmp(keys[k], item->string) != 0)
            k++;
        if (!keys[k])
            fail_shape(at, NARC_ERROR_FORMAT, item, 0, "unknown key '%s'", narc_make_excerpt(item->string).text);
        for (other = object->child; other != item && !at->status; other = other->next)
            if (strcmp(other->string, item->string) == 0)
                fail_shape(at, NARC_ERROR_FORMAT, item, 0, "key '%s' is there twice",
                           narc_make_excerpt(item->string).text);
    }
}

static const cJSON *find(const cJSON *object, const char *key) { return cJSON_GetObjectItemCaseSensitive(object, key); }

/* The value of a key that must be there. */
static const cJSON *require(reader *at, const cJSON *object, const char *key) {
    const cJSON *item = find(object, key);
    if (!item)
        fail_shape(at, NARC_ERROR_FORMAT, object, 0, "%s is missing", key);
    return item;
}

static double as_number(reader *at, const cJSON *item, const char *what) {
    if (!at->status && !cJSON_IsNumber(item))
        fail_value(at, item, what, "is not a number");
    else if (!at->status && !isfinite(item->valuedouble))
        fail_shape(at, NARC_ERROR_NOT_FINITE, item, item->valuedouble, "%s is not finite", what);
    return at->status ? 0 : item->valuedouble;
}

static double get_number(reader *at, const cJSON *object, const char *key) {
    return as_number(at, require(at, object, key), key);
}

static double get_number_or_zero(reader *at, const cJSON *object, const char *key) {
    const cJSON *item = find(object, key);
    return item ? as_number(at, item, key) : 0;
}

static narc_point as_point(reader *at, const cJSON *item, const char *what) {
    if (!at->status && (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2))
        fail_value(at, item, what, "is not a list of two numbers");
    return at->status ? (narc_point){0}
                      : (narc_point){as_number(at, item->child, what), as_number(at, item->child->next, what)};
}

/* The length of a list that must have between 1 and `most` items. */
static size_t check_list(reader *at, const cJSON *list, const char *key, size_t most) {
    const size_t count = (size_t)cJSON_GetArraySize(list);
    if (!cJSON_IsArray(list))
        fail_value(at, list, key, "is not a list");
    else if (count == 0)
        fail_shape(at, NARC_ERROR_COUNT, list, 0, "%s is an empty list", key);
    else if (count > most)
        fail_shape(at, NARC_ERROR_COUNT, list, (double)count, "%s has %zu items, at most %zu are possible", key, count,
                   most);
    return at->status ? 0 : count;
}

static size_t get_points(reader *at, const cJSON *list, const char *key, narc_point *out_points) {
    const size_t count = check_list(at, list, key, NARC_MAX_ARCS);
    const cJSON *item = list->child;
    for (size_t i = 0; i < count; i++, item = item->next) {
        snprintf(at->element, sizeof at->element, "point %zu", i);
        out_points[i] = as_point(at, item, "it");
    }
    at->element[0] = 0;
    return count;
}

static void check_object(reader *at, const cJSON *item, const char *what, const char *const *keys) {
    if (cJSON_IsObject(item))
        check_keys(at, item, keys);
    else
        fail_value(at, item, what, "is not an object");
}

/* ---------------------------------------------------------------------------- the forms of a shape */

/* Builds a shape from what was read; after an error in that, of anything. The store judges it. */
typedef narc_status build_form(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                               narc_error *error);

/* `count` arcs of a list, which has as many. */
static void read_arcs(reader *at, const cJSON *list, size_t count, narc_arc *out_arcs) {
    static const char *const keys[] = {"center", "radius", "start", "end", NULL};
    const cJSON *arc = list->child;
    for (size_t i = 0; i < count; i++, arc = arc->next) {
        snprintf(at->element, sizeof at->element, "arc %zu", i);
        check_object(at, arc, "it", keys);
        const narc_point center = as_point(at, require(at, arc, "center"), "center");
        out_arcs[i] = (narc_arc){center.x, center.y, get_number(at, arc, "radius"), get_number(at, arc, "start"),
                                 get_number(at, arc, "end")};
    }
    at->element[0] = 0;
}

static narc_status build_arcs(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                              narc_error *error) {
    (void)radius;
    *out_count = check_list(at, item, "arcs", NARC_MAX_ARCS);
    (void)error;
    read_arcs(at, item, *out_count, out_arcs);
    return NARC_OK;
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
    return narc_build_four_arc(&form, out_arcs, out_count, error);
}

static narc_status build_half_plane(reader *at, const cJSON *item, double radius, narc_arc *out_arcs, size_t *out_count,
                                    narc_error *error) {
    (void)radius, (void)out_arcs, (void)error;
    if (!cJSON_IsTrue(item))
        fail_value(at, item, "half_plane", "is not true");
    *out_count = 0;
    return NARC_OK;
}

static const struct {
    const char *key;
    bool takes_radius; /* a key "radius" may stand beside it */
    build_form *build;
} forms[] = {
    {"arcs", false, build_arcs},         {"points", true, build_points},          {"polygon", true, build_polygon},
    {"circle", false, build_circle},     {"capsule", false, build_capsule},       {"box", false, build_box},
    {"four_arc", false, build_four_arc}, {"half_plane", false, build_half_plane},
};
enum { FORM_COUNT = sizeof forms / sizeof forms[0], CHAIN = FORM_COUNT, NO_FORM };

static bool is_chain(const narc_named_shape *shape) {
    return shape->form == NARC_FORM_OPEN_CHAIN || shape->form == NARC_FORM_CLOSED_CHAIN;
}

/* What files hold the store takes: a shape is added to it, of a chain it is asked. */
static narc_status offer(narc_shapes *store, const narc_arc *arcs, size_t count, narc_form form, uint32_t *out_index,
                         narc_error *error) {
    if (form == NARC_FORM_SHAPE)
        return narc_add_shape(store, arcs, count, out_index, error);
    if (form == NARC_FORM_HALF_PLANE)
        return narc_add_half_plane(store, out_index, error);
    const narc_chain_options options = {.closed = form == NARC_FORM_CLOSED_CHAIN};
    size_t entries;
    const narc_status status = narc_add_chain(store, arcs, count, &options, NULL, 0, &entries, error);
    return status == NARC_ERROR_CAPACITY ? NARC_OK : status; /* all is well, but there is no room for entries */
}

/* ---------------------------------------------------------------------------- names */

static bool is_index(const char *digits, size_t index) {
    size_t value = 0;
    for (; *digits && value <= index; digits++)
        value = 10 * value + (size_t)(*digits - '0');
    return !*digits && value == index;
}

/* What is wrong with the name of shape number `index`, or NULL. */
static const char *check_name(const char *name, size_t index) {
    if (!narc_is_name(name))
        return "a name cannot be empty, begin or end with a blank, or hold commas, quotes, control characters or "
               "invalid UTF-8";
    if (!name[strspn(name, "0123456789")] && !is_index(name, index))
        return "a name of digits would be taken for the index of another shape";
    return NULL;
}

/* By name, then by place. */
static int compare_names(const void *left, const void *right) {
    const narc_named_shape *const *a = left, *const *b = right;
    const int order = strcmp((*a)->name, (*b)->name);
    return order ? order : (*a > *b) - (*a < *b);
}

/* Sorts the shapes by name. Returns the place of one whose name another one before it has, or `count`. */
static size_t sort_names(const narc_named_shape *shapes, size_t count, const narc_named_shape **out_sorted) {
    for (size_t i = 0; i < count; i++)
        out_sorted[i] = &shapes[i];
    qsort(out_sorted, count, sizeof(const narc_named_shape *), compare_names);
    for (size_t i = 1; i < count; i++)
        if (strcmp(out_sorted[i - 1]->name, out_sorted[i]->name) == 0)
            return (size_t)(out_sorted[i] - shapes);
    return count;
}

/* ---------------------------------------------------------------------------- the list */

/* What stands behind a narc_shape_list; the shapes' arcs, with the name behind them, are blocks of their own. */
typedef struct list {
    narc_shape_list shown; /* its count is that of the shapes that are whole */
    narc_allocator allocator;
    const narc_named_shape **by_name;
    narc_named_shape items[];
} list;

static bool is_incomplete(const narc_allocator *allocator) {
    return allocator && (!allocator->allocate || !allocator->release);
}

static void *allocate(const narc_allocator *allocator, size_t size, const char *what, narc_error *error) {
    void *memory = allocator->allocate(size, allocator->context);
    if (!memory)
        narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %s of %zu bytes", what, size);
    return memory;
}

/* A store to ask, where the caller has none. NULL on error. */
static narc_status open_store(const narc_allocator *allocator, narc_shapes **out_store, narc_error *error) {
    *out_store = NULL;
    const narc_status status = narc_create_shapes(allocator, out_store);
    return status ? narc_fail(error, status, 0, 0, "not enough memory for a store") : NARC_OK;
}

/* A list without shapes, with room for as many as there are values in the parsed file; so its size is less than theirs,
 * which is in memory. */
static list *create_list(const narc_allocator *allocator, size_t count, narc_error *error) {
    const size_t item = sizeof(narc_named_shape) + sizeof(const narc_named_shape *);
    list *made = allocate(allocator, sizeof *made + count * item, "a list", error);
    if (made) {
        *made = (list){.allocator = *allocator, .by_name = (const narc_named_shape **)(void *)&made->items[count]};
        made->shown.items = made->items;
    }
    return made;
}

void narc_destroy_shape_list(narc_shape_list *shapes) {
    if (!shapes)
        return;
    const narc_allocator allocator = ((list *)shapes)->allocator;
    for (size_t i = 0; i < shapes->count; i++)
        allocator.release((void *)shapes->items[i].arcs, allocator.context);
    allocator.release(shapes, allocator.context);
}

size_t narc_find_named_shape(const narc_shape_list *shapes, const char *name) {
    const narc_named_shape **by_name = ((const list *)shapes)->by_name;
    size_t low = 0, high = shapes->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = strcmp(name, by_name[middle]->name);
        if (order == 0)
            return (size_t)(by_name[middle] - shapes->items);
        low = order > 0 ? middle + 1 : low;
        high = order > 0 ? high : middle;
    }
    return shapes->count;
}

/* ---------------------------------------------------------------------------- reading */

static const char *key_of(size_t form) { return form == CHAIN ? "chain" : forms[form].key; }

/* Finds the one form that a shape has. */
static size_t find_form(reader *at, const cJSON *object) {
    size_t found = NO_FORM;
    for (size_t i = 0; i < NO_FORM; i++) {
        const cJSON *item = find(object, key_of(i));
        if (item && found < NO_FORM)
            fail_shape(at, NARC_ERROR_FORMAT, item, 0, "it has both '%s' and '%s'", key_of(found), key_of(i));
        found = item ? i : found;
    }
    if (found == NO_FORM)
        fail_shape(at, NARC_ERROR_FORMAT, object, 0,
                   "none of arcs, points, polygon, circle, capsule, box, four_arc, half_plane and chain is there");
    return found;
}

/* The name of shape number `index`. */
static const char *get_name(reader *at, const cJSON *object, size_t index) {
    const cJSON *item = require(at, object, "name");
    if (item && !cJSON_IsString(item))
        fail_value(at, item, "name", "is not a string");
    if (at->status)
        return NULL;
    const char *problem = check_name(item->valuestring, index);
    if (problem)
        fail_shape(at, NARC_ERROR_FORMAT, item, 0, "%s '%s'", problem, narc_make_excerpt(item->valuestring).text);
    return item->valuestring;
}

/* Reports an error of a builder or of the store, which may begin with what it is about: "arc 2: ". */
static void fail_build(reader *at, const cJSON *item, const narc_error *error) {
    int length = 0, number = (int)error->index;
    const bool begins = sscanf(error->message, "%*[a-z] %d%n", &number, &length) == 1 && error->message[length] == ':';
    const cJSON *element = cJSON_IsArray(item) && (begins || number > 0) ? cJSON_GetArrayItem(item, number) : NULL;
    if (begins)
        snprintf(at->element, sizeof at->element, "%.*s", length, error->message);
    fail_shape(at, error->status, element ? element : item, error->value, "%s",
               error->message + (begins ? length + 2 : 0));
}

/* A convex shape, which also comes into the store. */
static const narc_arc *read_convex(reader *at, const cJSON *item, size_t form, double radius, narc_shapes *store,
                                   narc_arc *arcs, narc_named_shape *shape) {
    narc_error error;
    shape->form = forms[form].build == build_half_plane ? NARC_FORM_HALF_PLANE : NARC_FORM_SHAPE;
    if (forms[form].build(at, item, radius, arcs, &shape->arc_count, &error) != NARC_OK ||
        (!at->status && offer(store, arcs, shape->arc_count, shape->form, &shape->index, &error) != NARC_OK))
        fail_build(at, item, &error);
    return arcs;
}

/* A chain, whose arcs stay where they are until the shape has a block of its own; to be released if not NULL. */
static narc_arc *read_chain(reader *at, const cJSON *item, narc_shapes *store, const list *shapes,
                            narc_named_shape *shape) {
    static const char *const keys[] = {"closed", "arcs", NULL};
    check_object(at, item, "chain", keys);
    const cJSON *closed = at->status ? NULL : find(item, "closed"),
                *arcs = at->status ? NULL : require(at, item, "arcs");
    if (closed && !cJSON_IsBool(closed))
        fail_value(at, closed, "closed", "is neither true nor false");
    shape->form = closed && cJSON_IsTrue(closed) ? NARC_FORM_CLOSED_CHAIN : NARC_FORM_OPEN_CHAIN;
    shape->arc_count = at->status ? 0 : check_list(at, arcs, "arcs", SIZE_MAX / sizeof(narc_arc));
    narc_arc *read =
        at->status ? NULL : allocate(&shapes->allocator, shape->arc_count * sizeof *read, "arcs", at->error);
    narc_error error;
    if (!at->status && !read)
        at->status = NARC_ERROR_MEMORY;
    if (read)
        read_arcs(at, arcs, shape->arc_count, read);
    if (read && !at->status && offer(store, read, shape->arc_count, shape->form, NULL, &error) != NARC_OK)
        fail_build(at, arcs, &error);
    return read;
}

/* Gives the shape that comes next in the list its arcs, and the name behind them. */
static void keep_shape(reader *at, list *shapes, const char *name, const narc_arc *arcs) {
    narc_named_shape *shape = &shapes->items[shapes->shown.count];
    const size_t size = shape->arc_count * sizeof *arcs, length = strlen(name) + 1;
    char *block = allocate(&shapes->allocator, size + length, "a shape", at->error);
    if (block) {
        shape->arcs = memcpy(block, arcs, size);
        shape->name = memcpy(block + size, name, length);
        shapes->shown.count++;
    } else {
        at->status = NARC_ERROR_MEMORY;
    }
}

static void read_shape(reader *at, const cJSON *object, narc_shapes *store, list *shapes) {
    static const char *const keys[] = {"name",   "origin",  "arcs",     "points", "polygon", "circle",     "box",
                                       "radius", "capsule", "four_arc", "chain",  "user",    "half_plane", NULL};
    narc_named_shape *shape = &shapes->items[shapes->shown.count];
    snprintf(at->shape, sizeof at->shape, "shape %zu", shapes->shown.count);
    if (!cJSON_IsObject(object))
        fail_value(at, object, "it", "is not an object");
    const char *name = get_name(at, object, shapes->shown.count);
    if (at->status)
        return;
    snprintf(at->shape, sizeof at->shape, "shape '%s'", narc_make_excerpt(name).text);
    check_keys(at, object, keys);
    const size_t form = find_form(at, object);
    if (at->status)
        return;
    const cJSON *item = find(object, key_of(form)), *radius = find(object, "radius"), *origin = find(object, "origin");
    if (radius && (form == CHAIN || !forms[form].takes_radius))
        fail_shape(at, NARC_ERROR_FORMAT, radius, 0, "'%s' takes no 'radius' beside it", key_of(form));
    *shape = (narc_named_shape){.origin = origin ? as_point(at, origin, "origin") : (narc_point){0}};

    const double corner = get_number_or_zero(at, object, "radius");
    narc_arc own[NARC_MAX_ARCS], *chain = form == CHAIN ? read_chain(at, item, store, shapes, shape) : NULL;
    const narc_arc *arcs = form == CHAIN ? chain : read_convex(at, item, form, corner, store, own, shape);
    const bool added = !at->status && form != CHAIN;
    if (!at->status)
        keep_shape(at, shapes, name, arcs);
    if (chain)
        shapes->allocator.release(chain, shapes->allocator.context);
    if (at->status && added)
        narc_remove_shape(store, shape->index, NULL);
}

/* The list of shapes that the file must be; NULL after an error. */
static const cJSON *find_list(reader *at) {
    static const char *const keys[] = {"$schema", "shapes", "user", NULL};
    check_object(at, at->root, "the file's value", keys);
    const cJSON *schema = at->status ? NULL : find(at->root, "$schema"); /* which editors look for */
    if (schema && !cJSON_IsString(schema))
        fail_value(at, schema, "$schema", "is not a string");
    const cJSON *found = at->status ? NULL : require(at, at->root, "shapes");
    if (found && !cJSON_IsArray(found))
        fail_value(at, found, "shapes", "is not a list");
    else if (found && !found->child)
        fail_shape(at, NARC_ERROR_COUNT, found, 0, "shapes is an empty list");
    return at->status ? NULL : found;
}

static list *read_list(reader *at, const narc_allocator *allocator, narc_shapes *store) {
    const cJSON *values = find_list(at), *item;
    size_t count = 0;
    if (!values)
        return NULL;
    cJSON_ArrayForEach(item, values) { count++; }
    list *shapes = create_list(allocator, count, at->error);
    if (!shapes) {
        at->status = NARC_ERROR_MEMORY;
        return NULL;
    }
    for (item = values->child; item && !at->status; item = item->next)
        read_shape(at, item, store, shapes);
    const size_t twin = at->status ? count : sort_names(shapes->items, count, shapes->by_name);
    if (twin < count) {
        snprintf(at->shape, sizeof at->shape, "shape %zu", twin);
        fail_shape(at, NARC_ERROR_FORMAT, find(cJSON_GetArrayItem(values, (int)twin), "name"), 0,
                   "another shape has that name '%s'", narc_make_excerpt(shapes->items[twin].name).text);
    }
    if (!at->status)
        return shapes;
    for (size_t i = shapes->shown.count; i > 0; i--)
        if (!is_chain(&shapes->items[i - 1]))
            narc_remove_shape(store, shapes->items[i - 1].index, NULL);
    narc_destroy_shape_list(&shapes->shown);
    return NULL;
}

narc_status narc_read_shapes(const void *data, size_t size, const narc_allocator *allocator, narc_shapes *store,
                             narc_shape_list **out_shapes, narc_error *error) {
    if (!data || !out_shapes)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", data ? "out_shapes" : "data");
    if (is_incomplete(allocator))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "the allocator lacks a function");
    const narc_allocator chosen = narc_choose_allocator(allocator);
    char *text = size < SIZE_MAX ? allocate(&chosen, size + 1, "a text", error) : NULL;
    if (!text)
        return NARC_ERROR_MEMORY;
    memcpy(text, data, size);
    text[size] = 0;
    reader at = {.text = text, .error = error};
    list *read = NULL;
    narc_shapes *own = NULL;
    at.status = narc_clean_text(text, size, error);
    if (!at.status)
        at.status = narc_parse_json(text, &at.root, error);
    if (!at.status && !store)
        at.status = open_store(&chosen, &own, error);
    if (!at.status)
        read = read_list(&at, &chosen, store ? store : own);
    for (size_t i = 0; own && read && i < read->shown.count; i++)
        read->items[i].index = 0;
    narc_destroy_shapes(own);
    cJSON_Delete(at.root);
    chosen.release(text, chosen.context);
    if (read)
        *out_shapes = &read->shown;
    return at.status;
}

/* ---------------------------------------------------------------------------- writing */

/* A text that is written twice: for its length, with `text` NULL, and into the memory for it. */
typedef struct writer {
    char *text;
    size_t length;
} writer;

static void put(writer *to, const char *text) {
    const size_t length = strlen(text);
    if (to->text)
        memcpy(to->text + to->length, text, length);
    to->length += length;
}

/* Not "-0", which other programs read as a whole number, and write without its sign. */
static void put_number(writer *to, const char *before, double value) {
    char digits[40];
    snprintf(digits, sizeof digits, value == 0 && signbit(value) ? "%.1f" : "%.17g", value);
    const char *point = localeconv()->decimal_point;
    char *found = strstr(digits, point);
    if (found) {
        *found = '.';
        memmove(found + 1, found + strlen(point), strlen(found + strlen(point)) + 1);
    }
    put(to, before);
    put(to, digits);
}

/* No more than a backslash needs another one: names have no quotes and no control characters. */
static void put_name(writer *to, const char *name) {
    for (; *name; name++)
        put(to, *name == '\\' ? "\\\\" : (char[]){*name, 0});
}

typedef struct built {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
} built;

static bool is_built(narc_status status, const built *from, const narc_named_shape *shape) {
    return !status && from->count == shape->arc_count &&
           memcmp(from->arcs, shape->arcs, from->count * sizeof *from->arcs) == 0;
}

/* A circle, capsule or box about its origin, or a polygon with corners, has few numbers: if they give the same arcs, to the
 * last bit, they are written. */
static bool put_plain(writer *to, const narc_named_shape *shape) {
    const narc_arc *arcs = shape->arcs;
    const double x = fabs(arcs[0].center_x), y = fabs(arcs[0].center_y), radius = arcs[0].radius;
    narc_point corners[NARC_MAX_ARCS];
    built from;
    if (is_built(narc_build_circle(radius, from.arcs, &from.count, NULL), &from, shape)) {
        put_number(to, "], \"circle\": ", radius);
    } else if (is_built(narc_build_capsule(2 * x, radius, from.arcs, &from.count, NULL), &from, shape)) {
        put_number(to, "], \"capsule\": {\"length\": ", 2 * x);
        put_number(to, ", \"radius\": ", radius);
        put(to, "}");
    } else if (is_built(narc_build_box(2 * (x + radius), 2 * (y + radius), radius, from.arcs, &from.count, NULL), &from,
                        shape)) {
        put_number(to, "], \"box\": {\"width\": ", 2 * (x + radius));
        put_number(to, ", \"height\": ", 2 * (y + radius));
        if (radius > 0)
            put_number(to, ", \"radius\": ", radius);
        put(to, "}");
    } else {
        for (size_t k = 0; k < shape->arc_count; k++)
            corners[k] = (narc_point){arcs[k].center_x, arcs[k].center_y};
        if (!is_built(narc_build_polygon(corners, shape->arc_count, 0, from.arcs, &from.count, NULL), &from, shape))
            return false;
        for (size_t k = 0; k < shape->arc_count; k++) {
            put_number(to, k ? ", [" : "], \"polygon\": [[", corners[k].x);
            put_number(to, ", ", corners[k].y);
            put(to, "]");
        }
        put(to, "]");
    }
    put(to, "}");
    return true;
}

static void put_shapes(writer *to, const narc_named_shape *shapes, size_t count) {
    put(to, "{\"shapes\": [");
    for (size_t i = 0; i < count; i++) {
        const narc_named_shape *shape = &shapes[i];
        put(to, i ? ",\n  {\"name\": \"" : "\n  {\"name\": \"");
        put_name(to, shape->name);
        put_number(to, "\", \"origin\": [", shape->origin.x);
        put_number(to, ", ", shape->origin.y);
        if (shape->form == NARC_FORM_HALF_PLANE)
            put(to, "], \"half_plane\": true}");
        if (shape->form == NARC_FORM_HALF_PLANE || (shape->form == NARC_FORM_SHAPE && put_plain(to, shape)))
            continue;
        put(to, shape->form == NARC_FORM_SHAPE        ? "], \"arcs\": ["
                : shape->form == NARC_FORM_OPEN_CHAIN ? "], \"chain\": {\"closed\": false, \"arcs\": ["
                                                      : "], \"chain\": {\"closed\": true, \"arcs\": [");
        for (size_t k = 0; k < shape->arc_count; k++) {
            const narc_arc *arc = &shape->arcs[k];
            put_number(to, k ? ",\n    {\"center\": [" : "\n    {\"center\": [", arc->center_x);
            put_number(to, ", ", arc->center_y);
            put_number(to, "], \"radius\": ", arc->radius);
            put_number(to, ", \"start\": ", arc->start);
            put_number(to, ", \"end\": ", arc->end);
            put(to, "}");
        }
        put(to, shape->form == NARC_FORM_SHAPE ? "\n  ]}" : "\n  ]}}");
    }
    put(to, "\n]}\n");
}

/* Would the shape be read again? */
static narc_status check_shape(const narc_named_shape *shape, size_t index, narc_shapes *store, narc_error *error) {
    if (!shape->name || (!shape->arcs && shape->form != NARC_FORM_HALF_PLANE))
        return narc_fail(error, NARC_ERROR_ARGUMENT, index, 0, "shape %zu: %s is NULL", index,
                         shape->name ? "arcs" : "name");
    const char *problem = check_name(shape->name, index);
    if (problem)
        return narc_fail(error, NARC_ERROR_FORMAT, index, 0, "shape %zu: %s '%s'", index, problem,
                         narc_make_excerpt(shape->name).text);
    if (!isfinite(shape->origin.x) || !isfinite(shape->origin.y))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, index, shape->origin.x + shape->origin.y,
                         "shape '%s': origin is not finite", narc_make_excerpt(shape->name).text);
    if ((unsigned)shape->form > NARC_FORM_HALF_PLANE)
        return narc_fail(error, NARC_ERROR_ARGUMENT, index, shape->form, "shape %zu: there is no form %d", index,
                         (int)shape->form);
    narc_error wrong;
    uint32_t added;
    if (offer(store, shape->arcs, shape->arc_count, shape->form, &added, &wrong) != NARC_OK)
        return narc_fail(error, wrong.status, index, wrong.value, "shape '%s': %s", narc_make_excerpt(shape->name).text,
                         wrong.message);
    return is_chain(shape) ? NARC_OK : narc_remove_shape(store, added, error);
}

/* Do all names differ? */
static narc_status check_twins(const narc_named_shape *shapes, size_t count, const narc_allocator *allocator,
                               narc_error *error) {
    const narc_named_shape **sorted = allocate(allocator, count * sizeof *sorted, "names", error);
    if (!sorted)
        return NARC_ERROR_MEMORY;
    const size_t twin = sort_names(shapes, count, sorted);
    allocator->release((void *)sorted, allocator->context);
    return twin == count ? NARC_OK
                         : narc_fail(error, NARC_ERROR_FORMAT, twin, 0, "shape %zu: another shape has that name '%s'",
                                     twin, narc_make_excerpt(shapes[twin].name).text);
}

narc_status narc_write_shapes(const narc_named_shape *shapes, size_t count, const narc_allocator *allocator,
                              char **out_text, size_t *out_size, narc_error *error) {
    if (!shapes || !out_text || !out_size)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !shapes     ? "shapes"
                         : !out_text ? "out_text"
                                     : "out_size");
    if (is_incomplete(allocator))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "the allocator lacks a function");
    if (count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "no shape to write");
    const narc_allocator chosen = narc_choose_allocator(allocator);
    narc_shapes *store;
    narc_status status = open_store(&chosen, &store, error);
    for (size_t i = 0; i < count && !status; i++)
        status = check_shape(&shapes[i], i, store, error);
    narc_destroy_shapes(store);
    status = status ? status : check_twins(shapes, count, &chosen, error);
    if (status)
        return status;
    writer to = {0};
    put_shapes(&to, shapes, count);
    const size_t size = to.length;
    to = (writer){.text = allocate(&chosen, size + 1, "a text", error)};
    if (!to.text)
        return NARC_ERROR_MEMORY;
    put_shapes(&to, shapes, count);
    to.text[size] = 0;
    *out_text = to.text;
    *out_size = size;
    return NARC_OK;
}
