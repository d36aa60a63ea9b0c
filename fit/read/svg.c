/* SPDX-License-Identifier: MIT
 *
 * svg.c - SVG files: librsvg draws them, and the outline of what is drawn is traced.
 *
 * How far the outline is from the ink, in pixels. Ink is in every pixel whose alpha is not 0. The contours pass a
 * quarter of a pixel beyond the centres of the outermost of these pixels, so that round each centre there is at least
 * the diamond |x| + |y| <= 1/4. A corner of the pixel is (1 - 1/4) / sqrt 2 = 0.53 from it, and no point of the pixel
 * is further: so far the ink may be outside. Each point of the contours is at most 1/4 from a centre, across from
 * which ink may be in the opposite corner only: hypot(3/4, 1/2) = 0.90 away. One pixel is told. For what is drawn
 * outside those pixels this leaves 0.47: a tenth for the chords with which cairo draws curves, a 360th for its grid of
 * coordinates, and a fifteenth for its rows of samples, between which the edge of something can lie.
 *
 * What is thinner than a fifteenth of a pixel may fall between these rows. The tip of a needle with angle a is as thin
 * over 1 / (30 tan (a / 2)) pixels: above 0.47 for angles below 8 degrees.
 */
#include <librsvg/rsvg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/path.h"
#include "read/trace.h"

/* Pixels of the page's longer side in the first look, of the ink's longer side, and of the page's at most: of a page of
 * 8192 x 8192, librsvg needs 256 MB for each group that it has to put together before it draws it. */
enum { LOOK = 1024, INK = 4096, PAGE = 8192 };

/* Samples of pixels with ink, and the level of the contours: 1/4 of the way from such a pixel to one without. */
enum { FULL = 65535 };
static const double LEVEL = 0.75 * FULL;

/* What percentages are of in a file that tells no size: CSS's size of a picture that has none. */
static const RsvgRectangle NO_SIZE = {0, 0, 300, 150};

/* The part of the plane that is drawn, and the viewport with which user units stay as they are. */
struct page {
    RsvgRectangle box, viewport;
};

/* A drawing's alpha, in rows of `stride` bytes. */
struct drawing {
    cairo_surface_t *surface;
    const unsigned char *alpha;
    size_t stride;
    int width, height;
    double scale; /* pixels per user unit */
};

/* The rows and columns with ink: from the first to the one before the end. */
struct extent {
    int left, right, top, bottom;
};

/* ---------------------------------------------------------------------------- opening */

/* The parser's message has the line inside: "... on line 3 column 7 of data: what is wrong". */
static narc_status fail_svg(GError *problem, narc_error *error) {
    static const char before_line[] = " on line ", before_reason[] = " of data: ";
    const char *text = problem ? problem->message : "no reason told";
    const char *place = strstr(text, before_line), *reason = strstr(text, before_reason);
    const unsigned long line = place ? strtoul(place + strlen(before_line), NULL, 10) : 0;
    reason = reason ? reason + strlen(before_reason) : text;
    const int size = (int)strcspn(reason, "\r\n");
    const narc_status status =
        line ? narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %lu: not SVG: %.*s", line, size, reason)
             : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "not SVG: %.*s", size, reason);
    g_clear_error(&problem);
    return status;
}

/* Data from memory have no folder: librsvg then reads no other file, and nothing from a network. */
static narc_status open_svg(const void *data, size_t size, RsvgHandle **out_handle, narc_error *error) {
    static const unsigned char gzip[2] = {0x1f, 0x8b};
    if (size == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the SVG file is empty");
    if (size >= 2 && memcmp(data, gzip, 2) == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "a compressed SVG file (svgz): it must be unpacked first");
    GError *problem = NULL;
    *out_handle = rsvg_handle_new_from_data(data, size, &problem);
    if (!*out_handle)
        return fail_svg(problem, error);
    rsvg_handle_set_dpi(*out_handle, 96); /* CSS: an inch has 96 user units */
    return NARC_OK;
}

/* One call of librsvg. Each has a thread of its own, because Pango keeps the fonts of a thread: one that FreeType could
 * not scale to some size, and that was left out, would make later calls fail, also those for other files. */
struct rendering {
    RsvgHandle *handle;
    cairo_t *cairo;
    RsvgRectangle viewport, ink;
    GError *problem;
};

static void *render(void *context) {
    struct rendering *r = context;
    const gboolean done =
        r->cairo ? rsvg_handle_render_document(r->handle, r->cairo, &r->viewport, &r->problem)
                 : rsvg_handle_get_geometry_for_layer(r->handle, NULL, &r->viewport, &r->ink, NULL, &r->problem);
    return done ? context : NULL;
}

static bool render_apart(struct rendering *rendering) {
    GThread *thread = g_thread_try_new("narc", render, rendering, NULL);
    return thread ? g_thread_join(thread) != NULL : render(rendering) != NULL;
}

/* ---------------------------------------------------------------------------- the page */

static bool has_area(RsvgRectangle box) {
    return isfinite(box.width) && isfinite(box.height) && box.width > 0 && box.height > 0;
}

/* A file without a page is drawn whole: `ink` and a margin, since blur and the like reach further than it tells. */
static struct page surround_ink(RsvgRectangle ink) {
    const double margin = 0.25 * fmax(ink.width, ink.height);
    const double right = fmax(NO_SIZE.width, ink.x + ink.width), bottom = fmax(NO_SIZE.height, ink.y + ink.height);
    return (struct page){.box = {ink.x - margin, ink.y - margin, ink.width + 2 * margin, ink.height + 2 * margin},
                         .viewport = {0, 0, right, bottom}};
}

/* A width or height that is not told is 100 %. */
static bool is_whole(RsvgLength side) { return side.unit == RSVG_UNIT_PERCENT && side.length == 1; }

/* Measuring the ink is a rehearsal too: a file that uses elements again and again, and would take minutes to draw, is
 * refused after seconds. */
static narc_status find_page(RsvgHandle *handle, struct page *out_page, narc_error *error) {
    struct rendering rehearsal = {.handle = handle, .viewport = NO_SIZE};
    RsvgRectangle view = {0};
    gboolean has_width, has_height, has_view;
    RsvgLength width, height;
    if (!render_apart(&rehearsal))
        return fail_svg(rehearsal.problem, error);
    rsvg_handle_get_intrinsic_dimensions(handle, &has_width, &width, &has_height, &height, &has_view, &view);
    if (!has_view) {
        view = (RsvgRectangle){0};
        has_view = rsvg_handle_get_intrinsic_size_in_pixels(handle, &view.width, &view.height);
    }
    if (!has_view && !(is_whole(width) && is_whole(height)))
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the SVG file has no viewBox, and only a part of a size");
    *out_page = has_view ? (struct page){view, view} : surround_ink(rehearsal.ink);
    return has_area(out_page->box) ? NARC_OK
                                   : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "nothing is seen in the SVG file");
}

/* ---------------------------------------------------------------------------- drawing */

static void release_drawing(struct drawing *drawing) {
    if (drawing->surface)
        cairo_surface_destroy(drawing->surface);
    *drawing = (struct drawing){0};
}

static narc_status draw(RsvgHandle *handle, const struct page *page, double scale, struct drawing *out_drawing,
                        narc_error *error) {
    struct drawing drawing = {
        .width = (int)ceil(page->box.width * scale), .height = (int)ceil(page->box.height * scale), .scale = scale};
    drawing.surface = cairo_image_surface_create(CAIRO_FORMAT_A8, drawing.width, drawing.height);
    cairo_t *cairo = cairo_create(drawing.surface);
    cairo_scale(cairo, scale, scale);
    cairo_translate(cairo, -page->box.x, -page->box.y);
    struct rendering rendering = {.handle = handle, .cairo = cairo, .viewport = page->viewport};
    const bool drawn = render_apart(&rendering);
    const bool sound = cairo_status(cairo) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cairo);
    if (!drawn || !sound) {
        release_drawing(&drawing);
        return drawn ? narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory to draw the SVG file")
                     : fail_svg(rendering.problem, error);
    }
    cairo_surface_flush(drawing.surface);
    drawing.alpha = cairo_image_surface_get_data(drawing.surface);
    drawing.stride = (size_t)cairo_image_surface_get_stride(drawing.surface);
    *out_drawing = drawing;
    return NARC_OK;
}

/* Without any ink the end is not behind the beginning. */
static struct extent find_extent(const struct drawing *drawing) {
    struct extent found = {drawing->width, 0, drawing->height, 0};
    for (int y = 0; y < drawing->height; y++) {
        const unsigned char *row = drawing->alpha + (size_t)y * drawing->stride;
        int left = 0, right = drawing->width;
        while (left < right && !row[left])
            left++;
        while (right > left && !row[right - 1])
            right--;
        if (left < right) {
            found.left = left < found.left ? left : found.left;
            found.right = right > found.right ? right : found.right;
            found.top = y < found.top ? y : found.top;
            found.bottom = y + 1;
        }
    }
    return found;
}

/* The scale at which the ink is large enough: a first look tells its size up to a pixel at both ends. */
static narc_status find_scale(RsvgHandle *handle, const struct page *page, double *out_scale, narc_error *error) {
    const double longer = fmax(page->box.width, page->box.height);
    struct drawing look;
    const narc_status status = draw(handle, page, LOOK / longer, &look, error);
    if (!status) {
        const struct extent ink = find_extent(&look);
        const int width = ink.right - ink.left, height = ink.bottom - ink.top, size = width > height ? width : height;
        *out_scale = fmin(PAGE / longer, look.scale * INK / fmax(1, size - 2));
        release_drawing(&look);
    }
    return status;
}

/* ---------------------------------------------------------------------------- the outline */

static narc_status trace(const struct drawing *drawing, narc_point corner, narc_path *path, narc_error *error) {
    const struct extent ink = find_extent(drawing);
    if (ink.left >= ink.right)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "nothing is seen in the SVG file");
    const size_t width = (size_t)(ink.right - ink.left), height = (size_t)(ink.bottom - ink.top);
    uint16_t *samples = malloc(width * height * sizeof *samples);
    if (!samples)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the outline of the SVG file");
    for (size_t y = 0; y < height; y++) {
        const unsigned char *row = drawing->alpha + ((size_t)ink.top + y) * drawing->stride + ink.left;
        for (size_t x = 0; x < width; x++)
            samples[y * width + x] = row[x] ? FULL : 0;
    }
    const double pixel = 1 / drawing->scale;
    const narc_image image = {.samples = samples,
                              .width = width,
                              .height = height,
                              .pixel = pixel,
                              .origin = {corner.x + pixel * ink.left, corner.y - pixel * ink.bottom}};
    const narc_status status = narc_trace_image(&image, LEVEL, path, error);
    free(samples);
    return status;
}

static narc_status draw_and_trace(RsvgHandle *handle, const struct page *page, narc_path *path, narc_error *error) {
    double scale;
    struct drawing drawing;
    narc_status status = find_scale(handle, page, &scale, error);
    status = status ? status : draw(handle, page, scale, &drawing, error);
    if (status)
        return status;
    const narc_path_mark mark = narc_mark_path(path);
    status = trace(&drawing, (narc_point){page->box.x, -page->box.y}, path, error); /* y up */
    release_drawing(&drawing);
    if (status)
        narc_rewind_path(path, mark);
    else
        path->slack = fmax(path->slack, 1 / scale);
    return status;
}

narc_status narc_read_svg(const void *data, size_t size, narc_path *path, narc_error *error) {
    if (!data || !path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, data ? "path is NULL" : "data is NULL");
    RsvgHandle *handle = NULL;
    narc_status status = open_svg(data, size, &handle, error);
    if (status)
        return status;
    struct page page;
    status = find_page(handle, &page, error);
    status = status ? status : draw_and_trace(handle, &page, path, error);
    g_object_unref(handle);
    return status;
}
