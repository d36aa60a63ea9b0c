/* SPDX-License-Identifier: MIT
 *
 * export_formats.c - the files of other programs, as their documents and loaders have them.
 */
#include <cjson/cJSON.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "export.h"
#include "fail.h"
#include "names.h"
#include "turn.h"

/* ---------------------------------------------------------------------------- texts */

static void put_xml(FILE *file, const char *name) {
    static const char odd[] = "&<>", *const words[] = {"&amp;", "&lt;", "&gt;"};
    for (; *name; name++) {
        const char *found = strchr(odd, *name);
        if (found)
            fputs(words[found - odd], file);
        else
            fputc(*name, file);
    }
}

/* The name without `odd` characters; for DXF R12, what is not ASCII as \U+XXXX, which has four digits. */
static char *clean_name(const char *name, const char *odd, bool is_dxf) {
    char *clean = allocate(7 * strlen(name) + 1, sizeof *clean), *end = clean;
    for (const char *at = name; *at;) {
        const char *from = at;
        uint32_t code = '?';
        (void)narc_next_code_point(&at, &code); /* names are UTF-8 */
        if (code < 0x80 ? strchr(odd, (int)code) != NULL : is_dxf && code > 0xffff)
            *end++ = '_';
        else if (code >= 0x80 && is_dxf)
            end += snprintf(end, sizeof "\\U+XXXX", "\\U+%04X", (unsigned)code);
        else
            while (from < at)
                *end++ = *from++;
    }
    *end = 0;
    return clean;
}

typedef struct taken_name {
    char *text;
    size_t number;
    bool is_changed, is_dxf;
} taken_name;

/* By their letters, of DXF without case; among those of the same ones, a body's true name is first. */
static int compare_letters(const taken_name *a, const taken_name *b) {
    const unsigned char *p = (const unsigned char *)a->text, *q = (const unsigned char *)b->text;
    while (*p && (a->is_dxf ? toupper(*p) == toupper(*q) : *p == *q)) {
        p++;
        q++;
    }
    return a->is_dxf ? toupper(*p) - toupper(*q) : *p - *q;
}
static int compare_names(const void *x, const void *y) {
    const taken_name *a = x, *b = y;
    const int letters = compare_letters(a, b);
    return letters                          ? letters
           : a->is_changed != b->is_changed ? (int)a->is_changed - (int)b->is_changed
                                            : (a->number > b->number) - (a->number < b->number);
}

/* Names of all bodies as a format can have them: of those that would be one, all but one get their body's number. */
static char **name_bodies(const exported *what, const char *odd, bool is_dxf) {
    char **names = allocate(what->count, sizeof *names);
    taken_name *taken = allocate(what->count, sizeof *taken);
    for (size_t i = 0; i < what->count; i++) {
        taken[i] = (taken_name){clean_name(what->bodies[i].name, odd, is_dxf), i, false, is_dxf};
        taken[i].is_changed = strcmp(taken[i].text, what->bodies[i].name) != 0;
    }
    for (bool again = true; again;) {
        again = false;
        qsort(taken, what->count, sizeof *taken, compare_names);
        for (size_t i = what->count; i-- > 1;) {
            if (compare_letters(&taken[i - 1], &taken[i]) == 0) {
                char number[24], *old = taken[i].text;
                snprintf(number, sizeof number, "_%zu", taken[i].number);
                taken[i].text = join_text(old, strlen(old), number);
                taken[i].is_changed = again = true;
                free(old);
            }
        }
    }
    for (size_t i = 0; i < what->count; i++)
        names[taken[i].number] = taken[i].text;
    free(taken);
    return names;
}

static void free_names(char **names, const exported *what) {
    for (size_t i = 0; i < what->count; i++)
        free(names[i]);
    free(names);
}

static void put_points(FILE *file, const piece *of, const char *between, const char *next) {
    for (size_t k = 0; k < of->count; k++)
        fprintf(file, "%s%.15g%s%.15g", k ? next : "", of->corners[k].x, between, of->corners[k].y);
}

/* ---------------------------------------------------------------------------- JSON */

static cJSON *put(cJSON *to, const char *key, cJSON *item) {
    if (!item || !(key ? cJSON_AddItemToObject(to, key, item) : cJSON_AddItemToArray(to, item)))
        fail("not enough memory for JSON");
    return item;
}
static cJSON *put_list(cJSON *to, const char *key) { return put(to, key, cJSON_CreateArray()); }
static cJSON *put_object(cJSON *to, const char *key) { return put(to, key, cJSON_CreateObject()); }
static void put_number(cJSON *to, const char *key, double value) { put(to, key, cJSON_CreateNumber(value)); }
static void put_text(cJSON *to, const char *key, const char *value) { put(to, key, cJSON_CreateString(value)); }

static void put_vector(cJSON *to, const char *key, double x, double y) {
    cJSON *vector = put_object(to, key);
    put_number(vector, "x", x);
    put_number(vector, "y", y);
}

static cJSON *put_vectors(cJSON *to, const char *key, const piece *of) {
    cJSON *list = put_list(to, key);
    for (size_t k = 0; k < of->count; k++)
        put_vector(list, NULL, of->corners[k].x, of->corners[k].y);
    return list;
}

static cJSON *open_json(void) {
    cJSON *root = cJSON_CreateObject();
    if (!root)
        fail("not enough memory for JSON");
    return root;
}

static void close_json(FILE *file, cJSON *root) {
    char *text = cJSON_Print(root);
    if (!text)
        fail("not enough memory for JSON");
    fprintf(file, "%s\n", text);
    cJSON_free(text);
    cJSON_Delete(root);
}

/* ---------------------------------------------------------------------------- Tiled */

/* A map has tiles, which its editor needs; these cover what is right of and below the origin. */
enum { TILE = 32 };
static double count_tiles(double length) {
    const double count = fmax(ceil(length / TILE), 1);
    if (!(count < 0x1p31))
        fail("what is %.3g from the origin needs a map of more than 2^31 tiles: --origin center", length);
    return count;
}

static void write_tmx(FILE *file, const exported *what) {
    size_t objects = 1;
    for (size_t i = 0; i < what->count; i++)
        objects += what->bodies[i].count;
    fprintf(file,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<map version=\"1.10\" orientation=\"orthogonal\" "
            "renderorder=\"right-down\" width=\"%.0f\" height=\"%.0f\" tilewidth=\"%d\" tileheight=\"%d\" "
            "infinite=\"0\" nextlayerid=\"%zu\" nextobjectid=\"%zu\">\n",
            count_tiles(what->box.max_x), count_tiles(what->box.max_y), TILE, TILE, what->count + 1, objects);
    objects = 1;
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        fprintf(file, " <objectgroup id=\"%zu\" name=\"", i + 1);
        put_xml(file, body->name);
        fputs("\">\n", file);
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            fprintf(file, "  <object id=\"%zu\" name=\"", objects++);
            put_xml(file, p->name);
            if (p->kind & (CIRCLE | BOX)) {
                fprintf(file, "\" x=\"%.15g\" y=\"%.15g\" width=\"%.10g\" height=\"%.10g\"%s\n", p->low.x, p->low.y,
                        p->width, p->height, p->kind == BOX ? "/>" : "><ellipse/></object>");
            } else {
                fprintf(file, "\" x=\"0\" y=\"0\"><%s points=\"", p->kind == LINE ? "polyline" : "polygon");
                put_points(file, p, ",", " ");
                fputs("\"/></object>\n", file);
            }
        }
        fputs(" </objectgroup>\n", file);
    }
    fputs("</map>\n", file);
}

static cJSON *put_layer(cJSON *layer, double id, const char *name) {
    put_text(layer, "type", "objectgroup");
    put_number(layer, "id", id);
    put_text(layer, "name", name);
    put_text(layer, "draworder", "topdown");
    put(layer, "visible", cJSON_CreateTrue());
    put_number(layer, "opacity", 1);
    put_number(layer, "x", 0);
    put_number(layer, "y", 0);
    return put_list(layer, "objects");
}

static void put_objects(cJSON *list, const export_body *body, size_t *next) {
    for (size_t k = 0; k < body->count; k++) {
        const piece *p = &body->pieces[k];
        const bool plain = p->kind & (CIRCLE | BOX);
        cJSON *object = put_object(list, NULL);
        put_number(object, "id", (double)(*next)++);
        put_text(object, "name", p->name);
        put_text(object, "type", "");
        put_number(object, "rotation", 0);
        put(object, "visible", cJSON_CreateTrue());
        put_number(object, "x", plain ? p->low.x : 0);
        put_number(object, "y", plain ? p->low.y : 0);
        put_number(object, "width", plain ? p->width : 0);
        put_number(object, "height", plain ? p->height : 0);
        if (p->kind == CIRCLE)
            put(object, "ellipse", cJSON_CreateTrue());
        else if (!plain)
            put_vectors(object, p->kind == LINE ? "polyline" : "polygon", p);
    }
}

static void write_tmj(FILE *file, const exported *what) {
    cJSON *map = open_json(), *layers = put_list(map, "layers");
    size_t objects = 1;
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        put_objects(put_layer(put_object(layers, NULL), (double)i + 1, body->name), body, &objects);
    }
    put_text(map, "type", "map");
    put_text(map, "version", "1.10");
    put_text(map, "orientation", "orthogonal");
    put_text(map, "renderorder", "right-down");
    put_number(map, "width", count_tiles(what->box.max_x));
    put_number(map, "height", count_tiles(what->box.max_y));
    put_number(map, "tilewidth", TILE);
    put_number(map, "tileheight", TILE);
    put(map, "infinite", cJSON_CreateFalse());
    put_number(map, "nextlayerid", (double)what->count + 1);
    put_number(map, "nextobjectid", (double)objects);
    put_list(map, "tilesets");
    close_json(file, map);
}

static void put_image(cJSON *to, const char *image, unsigned width, unsigned height) {
    put_text(to, "image", image);
    put_number(to, "imagewidth", width);
    put_number(to, "imageheight", height);
}

static void write_tsj(FILE *file, const exported *what) {
    cJSON *set = open_json(), *tiles = put_list(set, "tiles");
    unsigned width = 0, height = 0;
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        cJSON *tile = put_object(tiles, NULL);
        size_t objects = 1;
        put_number(tile, "id", body->tile);
        if (body->image)
            put_image(tile, body->image, body->width, body->height);
        put_objects(put_layer(put_object(tile, "objectgroup"), 2, ""), body, &objects);
        width = body->width > width ? body->width : width;
        height = body->height > height ? body->height : height;
    }
    const unsigned columns = what->sheet ? what->sheet_width / width : 0;
    put_text(set, "type", "tileset");
    put_text(set, "version", "1.10");
    put_text(set, "name", "colliders");
    put_number(set, "tilewidth", width);
    put_number(set, "tileheight", height);
    put_number(set, "columns", columns);
    put_number(set, "tilecount", what->sheet ? columns * (what->sheet_height / height) : (double)what->count);
    put_number(set, "margin", 0);
    put_number(set, "spacing", 0);
    if (what->sheet)
        put_image(set, what->sheet, what->sheet_width, what->sheet_height);
    close_json(file, set);
}

/* ---------------------------------------------------------------------------- Godot */

/* A resource of a scene, or with number 0 a file of its own. */
static void put_godot_shape(FILE *file, const piece *p, size_t number, bool is_3) {
    static const char *const types[] = {
        [CIRCLE] = "Circle", [CAPSULE] = "Capsule", [BOX] = "Rectangle", [OUTLINE] = "ConvexPolygon"};
    const char *type = p->kind & (LOOP | LINE) ? "ConcavePolygon" : types[p->kind];
    const char *array = is_3 ? "PoolVector2Array" : "PackedVector2Array";
    if (number == 0)
        fprintf(file, "[gd_resource type=\"%sShape2D\" format=%d]\n\n[resource]\n", type, is_3 ? 2 : 3);
    else
        fprintf(file,
                is_3 ? "[sub_resource type=\"%sShape2D\" id=%zu]\n" : "[sub_resource type=\"%sShape2D\" id=\"%zu\"]\n",
                type, number);
    if (p->kind & (CIRCLE | CAPSULE))
        fprintf(file, "radius = %.10g\n", p->radius);
    if (p->kind == CAPSULE)
        fprintf(file, "height = %.10g\n", is_3 ? p->width - 2 * p->radius : p->width);
    if (p->kind == BOX)
        fprintf(file, is_3 ? "extents = Vector2(%.10g, %.10g)\n" : "size = Vector2(%.10g, %.10g)\n",
                is_3 ? p->width / 2 : p->width, is_3 ? p->height / 2 : p->height);
    if (p->kind == OUTLINE) {
        fprintf(file, "points = %s(", array);
        put_points(file, p, ", ", ", ");
        fputs(")\n", file);
    }
    if (p->kind & (LOOP | LINE)) {
        fprintf(file, "segments = %s(", array);
        for (size_t k = 0; k + (p->kind == LINE) < p->count; k++) {
            const corner *to = &p->corners[(k + 1) % p->count];
            fprintf(file, "%s%.15g, %.15g, %.15g, %.15g", k ? ", " : "", p->corners[k].x, p->corners[k].y, to->x,
                    to->y);
        }
        fputs(")\n", file);
    }
    fputc('\n', file);
}

static void write_scene(FILE *file, const exported *what, bool is_3) {
    char **names = name_bodies(what, ".:@/%\\", false);
    size_t shapes = 0;
    for (size_t i = 0; i < what->count; i++)
        shapes += what->bodies[i].count;
    fprintf(file, "[gd_scene load_steps=%zu format=%d]\n\n", shapes + 1, is_3 ? 2 : 3);
    shapes = 0;
    for (size_t i = 0; i < what->count; i++)
        for (size_t k = 0; k < what->bodies[i].count; k++)
            put_godot_shape(file, &what->bodies[i].pieces[k], ++shapes, is_3);
    fputs("[node name=\"Colliders\" type=\"Node2D\"]\n", file);
    shapes = 0;
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        fputs("\n[node name=\"", file);
        fputs(names[i], file);
        fputs("\" type=\"StaticBody2D\" parent=\".\"]\n", file);
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            fprintf(file, "\n[node name=\"%zu\" type=\"CollisionShape2D\" parent=\"", k + 1);
            fputs(names[i], file);
            fputs("\"]\n", file);
            if (p->kind & (CIRCLE | CAPSULE | BOX))
                fprintf(file, "position = Vector2(%.15g, %.15g)\n", p->center.x, p->center.y);
            if (p->kind == CAPSULE) /* whose axis is y */
                fprintf(file, "rotation = %.10g\n", p->angle - FULL_TURN / 4);
            fprintf(file, is_3 ? "shape = SubResource( %zu )\n" : "shape = SubResource(\"%zu\")\n", ++shapes);
        }
    }
    free_names(names, what);
}

static void write_godot(FILE *file, const exported *what) { write_scene(file, what, false); }
static void write_godot_3(FILE *file, const exported *what) { write_scene(file, what, true); }
static void write_tres(FILE *file, const exported *what) { put_godot_shape(file, what->bodies->pieces, 0, false); }
static void write_tres_3(FILE *file, const exported *what) { put_godot_shape(file, what->bodies->pieces, 0, true); }

/* ---------------------------------------------------------------------------- engines */

/* Circles too: Matter would make polygons of them that lie inside, by more than the tolerance. */
static void write_phaser(FILE *file, const exported *what) {
    cJSON *root = open_json();
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        cJSON *out = put_object(root, body->name);
        put_text(out, "type", "fromPhysicsEditor");
        put_text(out, "label", body->name);
        cJSON *fixtures = put_list(out, "fixtures");
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            cJSON *fixture = put_object(fixtures, NULL);
            put_text(fixture, "label", p->name);
            put_vectors(put_list(fixture, "vertices"), NULL, p);
        }
    }
    close_json(file, root);
}

/* x and y of corners in a list each; a loop ends with its first corner. */
static void put_columns(cJSON *to, const piece *of) {
    cJSON *vertices = put_object(to, "vertices"), *x = put_list(vertices, "x"), *y = put_list(vertices, "y");
    for (size_t k = 0; k < of->count + (of->kind == LOOP); k++) {
        put_number(x, NULL, of->corners[k % of->count].x);
        put_number(y, NULL, of->corners[k % of->count].y);
    }
}

static void write_box2d(FILE *file, const exported *what) {
    cJSON *root = open_json(), *bodies = put_list(root, "body");
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        cJSON *out = put_object(bodies, NULL);
        put_text(out, "name", body->name);
        put_number(out, "type", body->pieces[0].kind & (LOOP | LINE) ? 0 : 2); /* static, dynamic */
        put_vector(out, "position", 0, 0);
        put_number(out, "angle", 0);
        cJSON *fixtures = put_list(out, "fixture");
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            cJSON *fixture = put_object(fixtures, NULL);
            put_text(fixture, "name", p->name);
            put_number(fixture, "density", 1);
            put_number(fixture, "friction", 0.2);
            cJSON *shape = put_object(fixture, p->kind == CIRCLE ? "circle" : p->kind == OUTLINE ? "polygon" : "chain");
            if (p->kind == CIRCLE) {
                put_vector(shape, "center", p->center.x, p->center.y);
                put_number(shape, "radius", p->radius);
            } else {
                put_columns(shape, p);
            }
            if (p->kind == LOOP) { /* its neighbours over the seam */
                const corner *before = &p->corners[p->count - 1], *after = &p->corners[1];
                put(shape, "hasPrevVertex", cJSON_CreateTrue());
                put_vector(shape, "prevVertex", before->x, before->y);
                put(shape, "hasNextVertex", cJSON_CreateTrue());
                put_vector(shape, "nextVertex", after->x, after->y);
            }
        }
    }
    close_json(file, root);
}

static void write_libgdx(FILE *file, const exported *what) {
    cJSON *root = open_json(), *bodies = put_list(root, "rigidBodies");
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        cJSON *out = put_object(bodies, NULL);
        put_text(out, "name", body->name);
        put_text(out, "imagePath", "");
        put_vector(out, "origin", 0, 0);
        cJSON *polygons = put_list(out, "polygons"), *circles = put_list(out, "circles"),
              *shapes = put_list(out, "shapes");
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            cJSON *shape = put_object(p->kind == CIRCLE ? circles : shapes, NULL);
            if (p->kind == CIRCLE) {
                put_number(shape, "cx", p->center.x);
                put_number(shape, "cy", p->center.y);
                put_number(shape, "r", p->radius);
            } else {
                put_text(shape, "type", "POLYGON");
                put_vectors(shape, "vertices", p);
                put_vectors(polygons, NULL, p);
            }
        }
    }
    put_list(root, "dynamicObjects");
    close_json(file, root);
}

/* ---------------------------------------------------------------------------- drawings */

static void write_svg(FILE *file, const exported *what) {
    const narc_aabb box = what->box;
    const double width = box.max_x - box.min_x, height = box.max_y - box.min_y, margin = 0.02 * fmax(width, height);
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%.15g %.15g %.10g %.10g\">\n",
            box.min_x - margin, box.min_y - margin, width + 2 * margin, height + 2 * margin);
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        fputs("<g id=\"", file);
        put_xml(file, body->name);
        fputs("\">\n", file);
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            if (p->kind == CIRCLE) {
                fprintf(file, "<circle cx=\"%.15g\" cy=\"%.15g\" r=\"%.10g\"/>\n", p->center.x, p->center.y, p->radius);
                continue;
            }
            fprintf(file, "<path d=\"M%.15g %.15g", p->corners[0].x, p->corners[0].y);
            for (size_t c = 0; c + (p->kind == LINE) < p->count; c++) {
                const corner *from = &p->corners[c], *to = &p->corners[(c + 1) % p->count];
                if (from->bulge != 0) {
                    const double radius = bend(from, to).radius;
                    fprintf(file, "A%.10g %.10g 0 0 %d %.15g %.15g", radius, radius, from->bulge > 0, to->x, to->y);
                } else {
                    fprintf(file, "L%.15g %.15g", to->x, to->y);
                }
            }
            if (p->kind == LINE)
                fprintf(file, "\" fill=\"none\" stroke=\"#000\" stroke-width=\"%.3g\"/>\n", margin / 8);
            else
                fputs("z\"/>\n", file);
        }
        fputs("</g>\n", file);
    }
    fputs("</svg>\n", file);
}

static void write_dxf(FILE *file, const exported *what) {
    char **names = name_bodies(what, "<>/\\:;?*|=`", true);
    fputs("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n", file);
    for (size_t i = 0; i < what->count; i++) {
        const export_body *body = &what->bodies[i];
        for (size_t k = 0; k < body->count; k++) {
            const piece *p = &body->pieces[k];
            fprintf(file, "0\n%s\n8\n%s", p->kind == CIRCLE ? "CIRCLE" : "POLYLINE", names[i]);
            if (p->kind == CIRCLE) {
                fprintf(file, "\n10\n%.15g\n20\n%.15g\n30\n0\n40\n%.10g\n", p->center.x, p->center.y, p->radius);
                continue;
            }
            fprintf(file, "\n66\n1\n10\n0\n20\n0\n30\n0\n70\n%d\n", p->kind != LINE);
            for (size_t c = 0; c < p->count; c++) {
                const corner *at = &p->corners[c];
                fprintf(file, "0\nVERTEX\n8\n0\n10\n%.15g\n20\n%.15g\n30\n0\n42\n%.10g\n", at->x, at->y, at->bulge);
            }
            fputs("0\nSEQEND\n8\n0\n", file);
        }
    }
    fputs("0\nENDSEC\n0\nEOF\n", file);
    free_names(names, what);
}

/* clang-format off */
const export_format export_formats[] = {
    {"tmx",    true,  CIRCLE | BOX | OUTLINE | LOOP | LINE,           0, false, false, write_tmx},
    {"tmj",    true,  CIRCLE | BOX | OUTLINE | LOOP | LINE,           0, false, false, write_tmj},
    {"tsj",    true,  CIRCLE | BOX | OUTLINE | LOOP | LINE,           0, false, true,  write_tsj},
    {"godot",  true,  CIRCLE | CAPSULE | BOX | OUTLINE | LOOP | LINE, 0, false, false, write_godot},
    {"godot3", true,  CIRCLE | CAPSULE | BOX | OUTLINE | LOOP | LINE, 0, false, false, write_godot_3},
    {"tres",   true,  CIRCLE | CAPSULE | BOX | OUTLINE | LOOP | LINE, 0, true,  false, write_tres},
    {"tres3",  true,  CIRCLE | CAPSULE | BOX | OUTLINE | LOOP | LINE, 0, true,  false, write_tres_3},
    {"phaser", true,  OUTLINE,                                        0, false, false, write_phaser},
    {"box2d",  false, CIRCLE | OUTLINE | LOOP | LINE,                 8, false, false, write_box2d},
    {"libgdx", false, CIRCLE | OUTLINE,                               8, false, false, write_libgdx},
    {"svg",    true,  CIRCLE | OUTLINE | LOOP | LINE | ARCS,          0, false, false, write_svg},
    {"dxf",    false, CIRCLE | OUTLINE | LOOP | LINE | ARCS,          0, false, false, write_dxf},
    {NULL,     false, 0,                                              0, false, false, NULL},
};
/* clang-format on */
