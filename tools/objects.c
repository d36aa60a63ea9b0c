/* SPDX-License-Identifier: MIT
 *
 * objects.c - collision objects in the files of editors.
 *
 * Tiled's XML becomes the JSON that Tiled itself writes, and is read as that.
 */
#include "objects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "json.h"
#include "system.h"
#include "text.h"
#include "turn.h"

#if NARC_SVG
#include <glib.h>
#endif

typedef struct objects {
    const char *file;
    begin_object *begin;
    void *context;
    size_t count;
} objects;

static const cJSON *get(const cJSON *of, const char *key) { return cJSON_GetObjectItemCaseSensitive(of, key); }
static double number(const cJSON *of, const char *key) {
    const cJSON *item = get(of, key);
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}
static const char *word(const cJSON *of, const char *key) {
    const cJSON *item = get(of, key);
    return cJSON_IsString(item) ? item->valuestring : "";
}

static cJSON *sure(cJSON *item) {
    if (!item)
        fail("not enough memory for objects");
    return item;
}

/* What must be a number where it is there. False if something is none: that was reported. */
static bool check_numbers(const char *file, const char *owner, const cJSON *of) {
    static const char *const keys[] = {"x",       "y",       "width",  "height", "rotation",
                                       "offsetx", "offsety", "radius", "angle"};
    const cJSON *item;
    bool right = true;
    owner = *word(of, "name") ? word(of, "name") : owner;
    cJSON_ArrayForEach(item, of) {
        bool is_known = false;
        for (size_t k = 0; k < sizeof keys / sizeof keys[0] && item->string && !cJSON_IsObject(item);
             k++) /* a body may be named so */
            is_known = is_known || strcmp(item->string, keys[k]) == 0;
        const cJSON *value = is_known && cJSON_IsArray(item) ? item->child : item; /* R.U.B.E. has lists of them */
        for (; is_known && value; value = value == item ? NULL : value->next)
            if (!cJSON_IsNumber(value) || !isfinite(value->valuedouble)) {
                report_at(file, 0, "'%s': %s is no number: '%s'", narc_make_excerpt(owner).text, item->string,
                          narc_make_excerpt(cJSON_IsString(value) ? value->valuestring : "").text);
                right = false;
            }
        if (!is_known && !(item->string && strcmp(item->string, "properties") == 0)) /* which are the user's */
            right = check_numbers(file, item->string ? item->string : owner, item) && right;
    }
    return right;
}

/* ---------------------------------------------------------------------------- drawing */

/* Where an object's own coordinates are: turned about a place, y up or down. */
typedef struct place {
    double x, y, cosine, sine, up;
} place;

static narc_point put(const place *at, double x, double y) {
    return (narc_point){at->x + at->cosine * x - at->sine * y, at->up * (at->y + at->sine * x + at->cosine * y)};
}

static narc_path *begin_path(objects *to, const char *name, size_t number, size_t count) {
    char part[24] = "";
    if (count > 1)
        snprintf(part, sizeof part, "/%zu", number + 1);
    char *whole = join_text(name, strlen(name), part);
    narc_path *path = to->begin(whole, to->context);
    free(whole);
    to->count++;
    return path;
}

static void check(const objects *of, const char *name, narc_status status, const narc_error *error) {
    if (status)
        fail_at(of->file, 0, "'%s': %s", narc_make_excerpt(name).text, error->message);
}

/* Points as {x, y}, or as one list of each. */
static void draw_points(objects *to, const char *name, narc_path *path, const cJSON *points, const place *at) {
    const cJSON *xs = get(points, "x"), *ys = get(points, "y"), *x = xs ? xs->child : points->child,
                *y = ys ? ys->child : NULL;
    for (bool first = true; x && (!ys || y); x = x->next, y = y ? y->next : NULL, first = false) {
        const narc_point p = ys ? put(at, x->valuedouble, y->valuedouble) : put(at, number(x, "x"), number(x, "y"));
        narc_error error;
        check(to, name, first ? narc_move_to(path, &p, &error) : narc_line_to(path, &p, &error), &error);
    }
}

static void draw_ellipse(objects *to, const char *name, narc_path *path, const place *at, double rx, double ry) {
    const narc_point center = put(at, 0, 0), end = put(at, rx, 0), top = put(at, 0, ry);
    const narc_point u = {end.x - center.x, end.y - center.y}, v = {top.x - center.x, top.y - center.y};
    narc_error error;
    check(to, name, narc_move_to(path, &end, &error), &error);
    check(to, name, narc_ellipse_to(path, &center, &u, &v, 0, FULL_TURN, &end, &error), &error);
}

/* Of a box from (0, 0): the shorter sides are half circles. */
static void draw_capsule(objects *to, const char *name, narc_path *path, const place *at, double width, double height) {
    const bool lies = width > height;
    const double radius = fmin(width, height) / 2, far = fmax(width, height) - radius, across = 2 * radius;
    /* Along the capsule, across it: a side, the end behind it, the other side, the other end. */
    const double points[6][2] = {{far, 0},   {far + radius, radius}, {far, across}, {radius, across}, {0, radius},
                                 {radius, 0}};
    narc_point p[6];
    narc_error error;
    for (int k = 0; k < 6; k++)
        p[k] = put(at, points[k][lies ? 0 : 1], points[k][lies ? 1 : 0]);
    check(to, name, narc_move_to(path, &p[5], &error), &error);
    for (int k = 0; k < 6; k += 3) {
        check(to, name, narc_line_to(path, &p[k], &error), &error);
        check(to, name, narc_arc_to(path, &p[k + 1], &p[k + 2], &error), &error);
    }
}

/* ---------------------------------------------------------------------------- Tiled */

/* Text, points, insertion points and tiles are none. */
static bool is_drawn(const cJSON *object) {
    return !get(object, "text") && !get(object, "point") && !get(object, "gid") &&
           (get(object, "polygon") || get(object, "polyline") ||
            (number(object, "width") > 0 && number(object, "height") > 0));
}

/* The objects of a layer or a tile, moved by (x, y); its lower side is y = 0 if it has a height. */
static void draw_group(objects *to, const cJSON *group, const char *name, double x, double y, double height) {
    const cJSON *list = get(group, "objects"), *object;
    size_t count = 0, done = 0, lost = 0;
    cJSON_ArrayForEach(object, list) {
        count += is_drawn(object) && !*word(object, "name");
        lost += !is_drawn(object) && !get(object, "text") && !get(object, "point") && !get(object, "gid");
    }
    if (lost)
        warn_at(to->file, "'%s': %zu objects without width and height, or of a kind that is not known, are left out",
                narc_make_excerpt(name).text, lost);
    cJSON_ArrayForEach(object, list) {
        if (!is_drawn(object))
            continue;
        const char *own = word(object, "name");
        narc_path *path = *own ? begin_path(to, own, 0, 1) : begin_path(to, name, done++, count);
        const double turn = number(object, "rotation") * FULL_TURN / 360, w = number(object, "width"),
                     h = number(object, "height");
        const place at = {x + number(object, "x"), y + number(object, "y") - height, cos(turn), sin(turn), -1};
        const cJSON *points = get(object, "polygon") ? get(object, "polygon") : get(object, "polyline");
        if (points) {
            draw_points(to, own, path, points, &at);
        } else if (get(object, "ellipse")) {
            const narc_point center = put(&at, w / 2, h / 2);
            draw_ellipse(to, own, path, &(place){center.x, -center.y, at.cosine, at.sine, -1}, w / 2, h / 2);
        } else if (get(object, "capsule")) {
            draw_capsule(to, own, path, &at, w, h);
        } else {
            narc_error error;
            for (int k = 0; k < 4; k++) {
                const narc_point p = put(&at, k == 1 || k == 2 ? w : 0, k >= 2 ? h : 0);
                check(to, own, k ? narc_line_to(path, &p, &error) : narc_move_to(path, &p, &error), &error);
            }
        }
    }
}

static void draw_tiles(objects *to, const cJSON *tileset) {
    const cJSON *tile;
    cJSON_ArrayForEach(tile, get(tileset, "tiles")) {
        char name[32];
        const double own = number(tile, "imageheight");
        snprintf(name, sizeof name, "tile-%.0f", number(tile, "id"));
        const cJSON *group = get(tile, "objectgroup");
        draw_group(to, group, name, number(group, "offsetx"), number(group, "offsety"),
                   own > 0 ? own : number(tileset, "tileheight"));
    }
}

/* Layers in a group move with it. */
static void draw_layers(objects *to, const cJSON *of, double x, double y) {
    const cJSON *layer;
    cJSON_ArrayForEach(layer, get(of, "layers")) {
        const double own_x = x + number(layer, "offsetx"), own_y = y + number(layer, "offsety");
        draw_group(to, layer, *word(layer, "name") ? word(layer, "name") : "objects", own_x, own_y, 0);
        draw_layers(to, layer, own_x, own_y);
    }
}

#if NARC_SVG
/* The elements that are open: for each the JSON that it becomes; NULL: nothing. */
typedef struct xml_reading {
    cJSON *root, *open[32]; /* no root: it is another kind of XML */
    size_t depth;
} xml_reading;

static cJSON *add_to_list(cJSON *to, const char *key) {
    cJSON *list = cJSON_GetObjectItemCaseSensitive(to, key), *item = sure(cJSON_CreateObject());
    cJSON_AddItemToArray(list ? list : sure(cJSON_AddArrayToObject(to, key)), item);
    return item;
}

static void start_element(GMarkupParseContext *context, const char *element, const char **names, const char **values,
                          gpointer data, GError **error) {
    static const struct {
        const char *element, *key; /* of a list that it is an item of; NULL: of an object */
    } known[] = {{"objectgroup", "layers"}, {"group", "layers"},     {"layer", "layers"}, {"object", "objects"},
                 {"tile", "tiles"},         {"tileset", "tilesets"}, {"polygon", NULL},   {"polyline", NULL},
                 {"ellipse", NULL},         {"point", NULL},         {"text", NULL},      {"image", NULL},
                 {"capsule", NULL}};
    xml_reading *at = data;
    cJSON *to = at->depth ? at->open[at->depth - 1] : NULL, *made = NULL;
    const bool is_shape = strncmp(element, "poly", 4) == 0;
    (void)context;
    const bool is_root = !strcmp(element, "map") || !strcmp(element, "tileset") || !strcmp(element, "template");
    if (at->depth == 0 && is_root) {
        at->root = made = sure(cJSON_CreateObject());
        sure(cJSON_AddStringToObject(made, "type", element));
    }
    if (!at->root || at->depth == 32) {
        g_set_error(error, G_MARKUP_ERROR, G_MARKUP_ERROR_INVALID_CONTENT, "its elements nest deeper than 32");
        return;
    }
    for (size_t k = 0; k < sizeof known / sizeof known[0] && to; k++) {
        if (strcmp(element, known[k].element) != 0)
            continue;
        const bool of_tile = strcmp(element, "objectgroup") == 0 && get(to, "id") && !get(to, "layers") &&
                             at->depth >= 2 && get(at->open[at->depth - 2], "tiles");
        made = known[k].key && !of_tile ? add_to_list(to, known[k].key) : sure(cJSON_AddObjectToObject(to, element));
    }
    for (size_t k = 0; names[k] && made; k++) {
        double value;
        if (is_shape && strcmp(names[k], "points") == 0) { /* x,y x,y */
            cJSON *list = sure(cJSON_CreateArray());
            cJSON_ReplaceItemInObjectCaseSensitive(to, element, list);
            for (const char *c = values[k]; *c;) {
                cJSON *point = sure(cJSON_CreateObject());
                cJSON_AddItemToArray(list, point);
                char *comma, *end;
                sure(cJSON_AddNumberToObject(point, "x", g_ascii_strtod(c, &comma)));
                sure(cJSON_AddNumberToObject(point, "y", g_ascii_strtod(comma + (*comma == ','), &end)));
                if (comma == c || *comma != ',' || end == comma + 1 || (*end && *end != ' ')) {
                    g_set_error(error, G_MARKUP_ERROR, G_MARKUP_ERROR_INVALID_CONTENT, "a point is not x,y: '%.20s'",
                                c);
                    return;
                }
                c = end + strspn(end, " ");
            }
            made = NULL;
        } else if (strcmp(names[k], "name") != 0 && parse_number(values[k], &value)) {
            sure(cJSON_AddNumberToObject(made, names[k], value));
        } else {
            sure(cJSON_AddStringToObject(made, names[k], values[k]));
        }
    }
    if (made && to && strcmp(element, "image") == 0) /* of a tile: its own size */
        sure(cJSON_AddNumberToObject(to, "imageheight", number(made, "height")));
    at->open[at->depth++] = made;
}

static void end_element(GMarkupParseContext *context, const char *element, gpointer data, GError **error) {
    (void)context, (void)element, (void)error;
    ((xml_reading *)data)->depth--;
}

/* NULL if it is no map and no tileset, or (*out_broken) one with an error, which is reported. */
static cJSON *read_xml(const char *file, const char *bytes, size_t size, bool *out_broken) {
    const GMarkupParser parser = {.start_element = start_element, .end_element = end_element};
    xml_reading at = {0};
    GError *error = NULL;
    int line = 0;
    GMarkupParseContext *context = g_markup_parse_context_new(&parser, G_MARKUP_DEFAULT_FLAGS, &at, NULL);
    const bool done = g_markup_parse_context_parse(context, bytes, (gssize)size, &error) &&
                      g_markup_parse_context_end_parse(context, &error);
    g_markup_parse_context_get_position(context, &line, NULL);
    g_markup_parse_context_free(context);
    *out_broken = at.root && !done;
    if (*out_broken) {
        report_at(file, (size_t)line, "%s", narc_make_excerpt(error->message).text);
        cJSON_Delete(at.root);
        at.root = NULL;
    }
    g_clear_error(&error);
    return at.root;
}
#else
static cJSON *read_xml(const char *file, const char *bytes, size_t size, bool *out_broken) {
    (void)file, (void)bytes, (void)size, (void)out_broken;
    return NULL;
}
#endif

/* ---------------------------------------------------------------------------- engines */

/* R.U.B.E.: a body's fixtures are a circle, polygon or chain each, around the body's position. */
static void draw_rube(objects *to, const cJSON *root) {
    const cJSON *body, *fixture;
    cJSON_ArrayForEach(body, get(root, "body")) {
        const cJSON *list = get(body, "fixture"), *position = get(body, "position");
        const double turn = number(body, "angle");
        const place at = {number(position, "x"), number(position, "y"), cos(turn), sin(turn), 1};
        const char *name = *word(body, "name") ? word(body, "name") : "body";
        size_t done = 0;
        cJSON_ArrayForEach(fixture, list) {
            narc_path *path = begin_path(to, name, done++, (size_t)cJSON_GetArraySize(list));
            const cJSON *circle = get(fixture, "circle"), *center = get(circle, "center"),
                        *polygon = get(fixture, "polygon") ? get(fixture, "polygon") : get(fixture, "chain");
            const narc_point p = put(&at, number(center, "x"), number(center, "y"));
            if (circle)
                draw_ellipse(to, name, path, &(place){p.x, p.y, 1, 0, 1}, number(circle, "radius"),
                             number(circle, "radius"));
            else if (get(polygon, "vertices"))
                draw_points(to, name, path, get(polygon, "vertices"), &at);
        }
    }
}

/* PhysicsEditor: bodies by their names; a fixture is a circle, or a list of convex polygons. */
static void draw_fixtures(objects *to, const cJSON *body, bool draws, size_t *count) {
    const cJSON *fixture, *polygon;
    const place at = {0, 0, 1, 0, -1};
    const size_t all = *count;
    *count = 0;
    cJSON_ArrayForEach(fixture, get(body, "fixtures")) {
        const cJSON *circle = get(fixture, "circle");
        if (circle && draws) {
            narc_path *path = begin_path(to, body->string, *count, all);
            draw_ellipse(to, body->string, path, &(place){number(circle, "x"), number(circle, "y"), 1, 0, -1},
                         number(circle, "radius"), number(circle, "radius"));
        }
        *count += circle != NULL;
        cJSON_ArrayForEach(polygon, get(fixture, "vertices")) {
            if (draws)
                draw_points(to, body->string, begin_path(to, body->string, *count, all), polygon, &at);
            *count += 1;
        }
    }
}

static cJSON *parse(const char *file, const char *bytes, size_t size, bool *out_broken) {
    char *text = join_text(bytes, size, "");
    narc_error error;
    cJSON *root = NULL;
    const bool clean = narc_clean_text(text, size, &error) == NARC_OK;
    *out_broken = false;
    if (text[strspn(text, " \t\r\n")] == '<')
        root = clean ? read_xml(file, text, strlen(text), out_broken) : NULL;
    else if (narc_parse_json(text, &root, &error) != NARC_OK)
        root = NULL;
    free(text);
    return root;
}

/* Tiled's templates, files beside this one: what an object does not say itself, its template says. False if one is none: that
 * was reported. */
static bool fill_from_templates(const char *file, cJSON *of) {
    const char *name = word(of, "template");
    cJSON *item;
    bool right = true;
    if (*name) {
        char *path = name[0] == '/' ? join_text(name, strlen(name), "") : join_text(file, folder_length(file), name);
        size_t size;
        char *bytes = try_read_bytes(path, &size);
        bool broken = false;
        cJSON *root = bytes ? parse(path, bytes, size, &broken) : NULL;
        const cJSON *object = get(root, "object") ? get(root, "object") : cJSON_GetArrayItem(get(root, "objects"), 0),
                    *part;
        if (bytes && !broken && !object)
            report_at(path, 0, "it is no template of an object");
        cJSON_ArrayForEach(part, object) {
            if (part->string && !get(of, part->string))
                cJSON_AddItemToObject(of, part->string, sure(cJSON_Duplicate(part, true)));
        }
        right = object && check_numbers(path, "object", object);
        cJSON_Delete(root);
        free(bytes);
        free(path);
    }
    cJSON_ArrayForEach(item, of) {
        if (!(item->string && strcmp(item->string, "properties") == 0)) /* which are the user's */
            right = fill_from_templates(file, item) && right;
    }
    return right;
}

bool read_objects(const char *file, const char *bytes, size_t size, begin_object *begin, void *context) {
    objects to = {file, begin, context, 0};
    bool broken;
    cJSON *root = parse(file, bytes, size, &broken);
    const char *type = word(root, "type");
    const cJSON *tileset, *body;
    const bool is_tiled = strcmp(type, "map") == 0 || strcmp(type, "tileset") == 0,
               is_rube = !is_tiled && cJSON_IsArray(get(root, "body"));
    bool known = is_tiled || is_rube || broken;
    cJSON_ArrayForEach(body, root) { /* PhysicsEditor's */
        known = known || (body->string && cJSON_IsArray(get(body, "fixtures")));
    }
    broken =
        broken || (known && !check_numbers(file, "objects", root)) || (is_tiled && !fill_from_templates(file, root));
    if (known && !broken) {
        if (is_tiled) {
            draw_layers(&to, root, 0, 0);
            draw_tiles(&to, root);
            cJSON_ArrayForEach(tileset, get(root, "tilesets")) { draw_tiles(&to, tileset); }
        } else if (is_rube) {
            draw_rube(&to, root);
        } else {
            cJSON_ArrayForEach(body, root) {
                size_t count = 0;
                draw_fixtures(&to, body, false, &count);
                draw_fixtures(&to, body, true, &count);
            }
        }
        if (to.count == 0)
            report_at(file, 0, "it has no collision objects");
    }
    cJSON_Delete(root);
    return known;
}
