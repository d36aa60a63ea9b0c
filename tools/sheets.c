/* SPDX-License-Identifier: MIT
 *
 * sheets.c - images that hold many.
 */
#include "sheets.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "json.h"
#include "system.h"
#include "text.h"

enum { MOST_PIXELS = 32767 }; /* cairo's, a side */

/* Where a frame lies on the sheet, and where its pixels belong in the frame as it was. Rotated ones lie on the sheet turned
 * clockwise by a quarter, `height` wide and `width` high. */
typedef struct frame {
    int x, y, width, height;
    bool rotated;
    int left, top, whole_width, whole_height;
} frame;

/* ---------------------------------------------------------------------------- images */

typedef struct stream {
    char *bytes;
    size_t size, capacity;
} stream;

static cairo_status_t read_some(void *context, unsigned char *to, unsigned length) {
    stream *from = context;
    if (length > from->capacity - from->size)
        return CAIRO_STATUS_READ_ERROR;
    memcpy(to, from->bytes + from->size, length);
    from->size += length;
    return CAIRO_STATUS_SUCCESS;
}

static cairo_status_t write_some(void *context, const unsigned char *from, unsigned length) {
    stream *to = context;
    to->bytes = grow(to->bytes, &to->capacity, to->size + length, 1);
    memcpy(to->bytes + to->size, from, length);
    to->size += length;
    return CAIRO_STATUS_SUCCESS;
}

/* NULL, and an error is told. */
static cairo_surface_t *open_sheet(const char *file, const char *bytes, size_t size) {
    stream from = {(char *)bytes, 0, size};
    cairo_surface_t *sheet = cairo_image_surface_create_from_png_stream(read_some, &from);
    if (cairo_surface_status(sheet) == CAIRO_STATUS_SUCCESS)
        return sheet;
    report_at(file, 0, "this PNG image cannot be read: %s", cairo_status_to_string(cairo_surface_status(sheet)));
    cairo_surface_destroy(sheet);
    return NULL;
}

/* The frame by itself. */
static cairo_surface_t *cut_frame(cairo_surface_t *sheet, const frame *of) {
    cairo_surface_t *alone = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, of->whole_width, of->whole_height);
    cairo_t *pen = cairo_create(alone);
    const double left = of->left, top = of->top, x = of->x, y = of->y;
    cairo_matrix_t place;
    cairo_matrix_init_translate(&place, left - x, top - y);
    if (of->rotated)
        cairo_matrix_init(&place, 0, -1, 1, 0, left - y, top + of->height + x);
    cairo_rectangle(pen, left, top, of->width, of->height);
    cairo_clip(pen);
    cairo_transform(pen, &place);
    cairo_set_source_surface(pen, sheet, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(pen), CAIRO_FILTER_NEAREST);
    cairo_paint(pen);
    cairo_destroy(pen);
    cairo_surface_flush(alone);
    return alone;
}

static bool has_ink(cairo_surface_t *image) {
    const unsigned char *row = cairo_image_surface_get_data(image);
    const int width = cairo_image_surface_get_width(image), stride = cairo_image_surface_get_stride(image);
    for (int y = cairo_image_surface_get_height(image); y > 0; y--, row += stride)
        for (int x = 0; x < 4 * width; x++) /* premultiplied: without alpha all is 0 */
            if (row[x])
                return true;
    return false;
}

static void give_frame(cairo_surface_t *image, const char *name, take_frame *take, void *context) {
    stream to = {0};
    const cairo_status_t status = cairo_surface_write_to_png_stream(image, write_some, &to);
    if (status != CAIRO_STATUS_SUCCESS)
        fail("frame '%s': %s", name, cairo_status_to_string(status));
    take(name, to.bytes, to.size, context);
    free(to.bytes);
}

/* ---------------------------------------------------------------------------- grids */

grid parse_grid(const char *text) {
    grid cells = {0, 0};
    const char *x = text ? strchr(text, 'x') : NULL;
    if (!text)
        return cells;
    char *width = x ? join_text(text, (size_t)(x - text), "") : NULL;
    if (!x || !parse_whole(width, MOST_PIXELS, &cells.width) || !parse_whole(x + 1, MOST_PIXELS, &cells.height) ||
        cells.width == 0 || cells.height == 0)
        fail("--grid must be a cell's width and height in pixels, such as 32x48, not '%s'",
             narc_make_excerpt(text).text);
    free(width);
    return cells;
}

void read_grid(const char *file, const char *bytes, size_t size, grid cells, const char *name, take_frame *take,
               void *context) {
    cairo_surface_t *sheet = open_sheet(file, bytes, size);
    if (!sheet)
        return;
    const int width = cairo_image_surface_get_width(sheet), height = cairo_image_surface_get_height(sheet);
    const int w = (int)cells.width, h = (int)cells.height, columns = width / w, rows = height / h;
    if (width % w || height % h) {
        report_at(file, 0, "the image has %d x %d pixels, no whole number of --grid cells of %d x %d", width, height, w,
                  h);
        cairo_surface_destroy(sheet);
        return;
    }
    bool any = false;
    for (int k = 0; k < columns * rows; k++) {
        const frame of = {k % columns * w, k / columns * h, w, h, false, 0, 0, w, h};
        cairo_surface_t *image = cut_frame(sheet, &of);
        char number[24];
        snprintf(number, sizeof number, "-%d", k);
        char *own = join_text(name, strlen(name), number);
        if (has_ink(image)) {
            give_frame(image, own, take, context);
            any = true;
        }
        free(own);
        cairo_surface_destroy(image);
    }
    if (!any)
        report_at(file, 0, "all cells of its --grid are transparent");
    cairo_surface_destroy(sheet);
}

/* ---------------------------------------------------------------------------- JSON of packers */

/* A whole number of an object's member; -1 if there is none. */
static int get_whole(const cJSON *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    const double value = cJSON_IsNumber(item) ? item->valuedouble : -1;
    return value >= 0 && value <= MOST_PIXELS && value == floor(value) ? (int)value : -1;
}

/* Reads an entry; false, and an error is told, if it is none, or lies outside the image. */
static bool read_frame(const char *file, const cJSON *entry, const char *name, cairo_surface_t *sheet, frame *out) {
    const cJSON *on = cJSON_GetObjectItemCaseSensitive(entry, "frame"),
                *in = cJSON_GetObjectItemCaseSensitive(entry, "spriteSourceSize"),
                *whole = cJSON_GetObjectItemCaseSensitive(entry, "sourceSize");
    *out = (frame){get_whole(on, "x"),
                   get_whole(on, "y"),
                   get_whole(on, "w"),
                   get_whole(on, "h"),
                   cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(entry, "rotated")),
                   0,
                   0,
                   0,
                   0};
    out->left = in ? get_whole(in, "x") : 0;
    out->top = in ? get_whole(in, "y") : 0;
    out->whole_width = whole ? get_whole(whole, "w") : out->width;
    out->whole_height = whole ? get_whole(whole, "h") : out->height;
    const int width = cairo_image_surface_get_width(sheet), height = cairo_image_surface_get_height(sheet);
    const int right = out->x + (out->rotated ? out->height : out->width),
              bottom = out->y + (out->rotated ? out->width : out->height);
    if (out->x < 0 || out->y < 0 || out->width < 1 || out->height < 1 || out->left < 0 || out->top < 0 ||
        out->whole_width < out->left + out->width || out->whole_height < out->top + out->height) {
        report_at(
            file, 0,
            "frame '%s': frame, spriteSourceSize and sourceSize must be whole pixels, and the frame lie within its "
            "source",
            narc_make_excerpt(name).text);
        return false;
    }
    if (right > width || bottom > height) {
        report_at(file, 0, "frame '%s' goes to %d, %d, and the image has %d x %d pixels", narc_make_excerpt(name).text,
                  right, bottom, width, height);
        return false;
    }
    return true;
}

/* The frames of one image; `sheet` has them as a list or by their names. */
static void read_frames(const char *file, const cJSON *frames, const char *image, take_frame *take, void *context) {
    char *path = join_text(file, folder_length(file), image + folder_length(image));
    size_t size;
    char *bytes = try_read_bytes(path, &size);
    cairo_surface_t *sheet = bytes ? open_sheet(path, bytes, size) : NULL;
    for (const cJSON *entry = sheet ? frames->child : NULL; entry; entry = entry->next) {
        const cJSON *named = cJSON_GetObjectItemCaseSensitive(entry, "filename");
        const char *name = cJSON_IsString(named) ? named->valuestring : entry->string ? entry->string : "frame";
        frame of;
        if (!read_frame(file, entry, name, sheet, &of))
            continue;
        /* NAME/1 would be a part of NAME. */
        const char *dot = strrchr(name, '.');
        char *own = join_text(name, dot && dot != name ? (size_t)(dot - name) : strlen(name), "");
        for (char *c = own; *c; c++)
            *c = *c == '/' || *c == '\\' ? '-' : *c;
        cairo_surface_t *alone = cut_frame(sheet, &of);
        give_frame(alone, own, take, context);
        cairo_surface_destroy(alone);
        free(own);
    }
    if (sheet)
        cairo_surface_destroy(sheet);
    free(bytes);
    free(path);
}

/* Frames beside "meta", whose "image" names the file, or a list of "textures" that have both. */
bool read_sheet(const char *file, const char *bytes, size_t size, take_frame *take, void *context) {
    char *text = join_text(bytes, size, "");
    narc_error error;
    cJSON *root = NULL;
    bool any = false;
    if (narc_clean_text(text, size, &error) == NARC_OK && narc_parse_json(text, &root, &error) == NARC_OK) {
        const cJSON *textures = cJSON_GetObjectItemCaseSensitive(root, "textures");
        const cJSON *frames = cJSON_GetObjectItemCaseSensitive(root, "frames");
        any = cJSON_IsArray(textures) || cJSON_IsArray(frames) || cJSON_IsObject(frames);
        for (const cJSON *at = cJSON_IsArray(textures) ? textures->child : root; any && at;
             at = at == root ? NULL : at->next) {
            const cJSON *meta = cJSON_GetObjectItemCaseSensitive(root, "meta");
            const cJSON *image = cJSON_GetObjectItemCaseSensitive(at == root ? meta : at, "image");
            frames = cJSON_GetObjectItemCaseSensitive(at, "frames");
            if (!cJSON_IsString(image) || !frames || !frames->child)
                report_at(file, 0, "it has frames, but does not tell their image under \"meta\", \"image\"");
            else
                read_frames(file, frames, image->valuestring, take, context);
        }
    }
    cJSON_Delete(root);
    free(text);
    return any;
}
