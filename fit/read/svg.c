/* SPDX-License-Identifier: MIT
 *
 * svg.c - SVG files: plain drawings by their geometry; librsvg draws all others, and the outline of what is drawn is traced.
 *
 * What is fainter than the threshold does not count, unless it is REACH pixels or less from what does: an edge of strong
 * ink has faint pixels too, and so has its tip, which is w pixels wide where 7 w pixels of a tip of 8 degrees are left.
 * Between two rows its alpha is w / 2 at most: up to a threshold of 1/2 that is within 8 pixels of the end.
 *
 * How far the outline is from the ink, in pixels. Ink is in every pixel that counts. The contours pass a
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
#include <dlfcn.h>
#include <librsvg/rsvg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "lines.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "read/svg_geometry.h"
#include "read/trace.h"

/* Pixels of the page's longer side in the first look, of the ink's longer side, and of the page's at most: of a page of
 * 8192 x 8192, librsvg needs 256 MB for each group that it has to put together before it draws it. Fuzzing takes few
 * pixels, or it would do nothing but trace. */
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
enum { LOOK = 64, INK = 256, PAGE = 512 };
#else
enum { LOOK = 1024, INK = 4096, PAGE = 8192 };
#endif

/* Samples of pixels with ink, and the level of the contours: 1/4 of the way from such a pixel to one without. */
enum { FULL = 65535 };
static const double LEVEL = 0.75 * FULL;

/* What counts if nothing else is asked for: shadows and glows are fainter, in most drawings, glass is not. And how far
 * from it, in pixels, fainter ink counts too. */
static const double THRESHOLD = 0.25;
enum { REACH = 8 };

/* What percentages are of in a file that tells no size: CSS's size of a picture that has none. */
static const RsvgRectangle NO_SIZE = {0, 0, 300, 150};

/* The part of the plane that is drawn, and the viewport with which user units stay as they are. */
struct page {
    RsvgRectangle box, viewport;
    bool cuts; /* off what is outside */
};

/* What is drawn, and the threshold, above which it counts: from `least` of 255 on. */
struct subject {
    RsvgHandle *handle;
    struct page page;
    const char *element; /* "#id" of what counts; NULL: all */
    narc_silhouette silhouette;
    double threshold;
    int least;
};

/* A drawing's alpha, or darkness or lightness, in rows of `stride` bytes. */
struct drawing {
    cairo_surface_t *surface;
    const unsigned char *alpha;
    size_t stride;
    int width, height;
    double scale; /* pixels per user unit */
};

/* The rows and columns with ink that counts: from the first to the one before the end. */
struct extent {
    int left, right, top, bottom;
};

/* ---------------------------------------------------------------------------- librsvg, where a drawing is read */

/* Loading it and the thirty libraries that it needs is two thirds of what a start of the command takes. */
#define FUNCTIONS(F)                                                                                                   \
    F(new_from_data)                                                                                                   \
    F(set_dpi)                                                                                                         \
    F(has_sub)                                                                                                         \
    F(render_layer)                                                                                                    \
    F(get_geometry_for_layer)                                                                                          \
    F(get_intrinsic_dimensions)                                                                                        \
    F(get_intrinsic_size_in_pixels)

#define DECLARE(name) TYPE_OF(&rsvg_handle_##name) name;
static struct librsvg { FUNCTIONS(DECLARE) } rsvg;

static bool find_function(void *library, const char *name, void *out_pointer) {
    void *const function = library ? dlsym(library, name) : NULL;
    memcpy(out_pointer, &function, sizeof function);
    return function;
}

static narc_status load_librsvg(narc_error *error) {
    static gsize state; /* 1: it is there, 2: it is not */
    if (g_once_init_enter(&state)) {
        void *const library = dlopen(NARC_LIBRSVG, RTLD_LAZY | RTLD_LOCAL);
#define FIND(name) &&find_function(library, "rsvg_handle_" #name, &rsvg.name)
        const bool found = true FUNCTIONS(FIND);
        g_once_init_leave(&state, found ? 1 : 2);
    }
    return state == 1
               ? NARC_OK
               : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "SVG files need %s, which can't be loaded", NARC_LIBRSVG);
}

/* ---------------------------------------------------------------------------- opening */

enum { LONGEST_REASON = 160 };

/* The parser's message has the line inside: "... on line 3 column 7 of data: what is wrong". It may end with a full stop. */
static narc_status fail_svg(GError *problem, narc_error *error) {
    static const char before_line[] = " on line ", before_reason[] = " of data: ";
    const char *text = problem ? problem->message : "no reason told";
    const char *place = strstr(text, before_line), *reason = strstr(text, before_reason);
    const unsigned long line = place ? strtoul(place + strlen(before_line), NULL, 10) : 0;
    reason = reason ? reason + strlen(before_reason) : text;
    int size = (int)strcspn(reason, "\r\n");
    size = size < LONGEST_REASON ? size : LONGEST_REASON;
    while (size > 0 && reason[size - 1] == '.')
        size--;
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
    const narc_status status = load_librsvg(error);
    if (status)
        return status;
    GError *problem = NULL;
    *out_handle = rsvg.new_from_data(data, size, &problem);
    if (!*out_handle)
        return fail_svg(problem, error);
    rsvg.set_dpi(*out_handle, 96); /* CSS: an inch has 96 user units */
    return NARC_OK;
}

/* One call of librsvg. Each has a thread of its own, because Pango keeps the fonts of a thread: one that FreeType could
 * not scale to some size, and that was left out, would make later calls fail, also those for other files. */
struct rendering {
    RsvgHandle *handle;
    cairo_t *cairo;
    const char *element; /* "#id"; NULL: all */
    RsvgRectangle viewport, ink;
    GError *problem;
};

static void *render(void *context) {
    struct rendering *r = context;
    const gboolean done = r->cairo
                              ? rsvg.render_layer(r->handle, r->cairo, r->element, &r->viewport, &r->problem)
                              : rsvg.get_geometry_for_layer(r->handle, NULL, &r->viewport, &r->ink, NULL, &r->problem);
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
    rsvg.get_intrinsic_dimensions(handle, &has_width, &width, &has_height, &height, &has_view, &view);
    if (!has_view) {
        view = (RsvgRectangle){0};
        has_view = rsvg.get_intrinsic_size_in_pixels(handle, &view.width, &view.height);
    }
    if (!has_view && !(is_whole(width) && is_whole(height)))
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the SVG file has no viewBox, and only a part of a size");
    *out_page = has_view ? (struct page){view, view, true} : surround_ink(rehearsal.ink);
    return has_area(out_page->box) ? NARC_OK
                                   : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "nothing is seen in the SVG file");
}

/* ---------------------------------------------------------------------------- drawing */

static void release_drawing(struct drawing *drawing) {
    if (drawing->surface)
        cairo_surface_destroy(drawing->surface);
    *drawing = (struct drawing){0};
}

/* Makes bytes of darkness or lightness, which the alpha has multiplied, of pixels of four, in the same rows. Colours
 * have the weights of BT.709. */
static void weigh_pixels(narc_silhouette silhouette, const struct drawing *drawing, unsigned char *bytes) {
    for (int y = 0; y < drawing->height; y++) {
        unsigned char *row = bytes + (size_t)y * drawing->stride;
        for (int x = 0; x < drawing->width; x++) {
            uint32_t pixel;
            memcpy(&pixel, row + (size_t)x * sizeof pixel, sizeof pixel);
            const uint32_t alpha = pixel >> 24, red = pixel >> 16 & 255, green = pixel >> 8 & 255, blue = pixel & 255;
            const uint32_t light = (54 * red + 183 * green + 19 * blue + 128) / 256;
            row[x] = (unsigned char)(silhouette == NARC_SILHOUETTE_LIGHT ? light : alpha > light ? alpha - light : 0);
        }
    }
}

static narc_status draw(const struct subject *of, double scale, struct drawing *out_drawing, narc_error *error) {
    const struct page *page = &of->page;
    const bool colours = of->silhouette != NARC_SILHOUETTE_ALPHA;
    struct drawing drawing = {
        .width = (int)ceil(page->box.width * scale), .height = (int)ceil(page->box.height * scale), .scale = scale};
    drawing.surface =
        cairo_image_surface_create(colours ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_A8, drawing.width, drawing.height);
    cairo_t *cairo = cairo_create(drawing.surface);
    cairo_scale(cairo, scale, scale);
    cairo_translate(cairo, -page->box.x, -page->box.y);
    struct rendering rendering = {
        .handle = of->handle, .cairo = cairo, .element = of->element, .viewport = page->viewport};
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
    if (colours)
        weigh_pixels(of->silhouette, &drawing, cairo_image_surface_get_data(drawing.surface));
    *out_drawing = drawing;
    return NARC_OK;
}

/* The extent of what is at least so strong. Without any the end is not behind the beginning. */
static struct extent find_extent(const struct drawing *drawing, int least) {
    struct extent found = {drawing->width, 0, drawing->height, 0};
    for (int y = 0; y < drawing->height; y++) {
        const unsigned char *row = drawing->alpha + (size_t)y * drawing->stride;
        int left = 0, right = drawing->width;
        while (left < right && row[left] < least)
            left++;
        while (right > left && row[right - 1] < least)
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
static narc_status find_scale(const struct subject *of, double *out_scale, narc_error *error) {
    const double longer = fmax(of->page.box.width, of->page.box.height);
    struct drawing look;
    const narc_status status = draw(of, LOOK / longer, &look, error);
    if (!status) {
        const struct extent ink = find_extent(&look, of->least);
        const int width = ink.right - ink.left, height = ink.bottom - ink.top, size = width > height ? width : height;
        *out_scale = fmin(PAGE / longer, look.scale * INK / fmax(1, size - 2));
        release_drawing(&look);
    }
    return status;
}

/* ---------------------------------------------------------------------------- the outline */

/* Which of a row's next 64 bytes from x on are at least so large. Most are all 0 or all 255. */
static uint64_t list_word(const unsigned char *row, size_t width, size_t x, int least) {
    const unsigned char *const bytes = row + x;
    const size_t count = width - x < 64 ? width - x : 64;
    uint64_t word = 0;
    for (size_t k = 0; k < count;) {
        uint64_t eight;
        if (k + sizeof eight <= count) {
            memcpy(&eight, bytes + k, sizeof eight);
            if (eight == 0 || eight == UINT64_MAX) {
                word |= (eight & 255) << k;
                k += sizeof eight;
                continue;
            }
        }
        for (const size_t end = k + 8 < count ? k + 8 : count; k < end; k++)
            word |= (uint64_t)(bytes[k] >= least) << k;
    }
    return word;
}

/* Adds the neighbours that are `by` pixels away in a row, fewer than 64. */
static void spread_row(const uint64_t *row, size_t stride, unsigned by, uint64_t *out) {
    for (size_t k = 0; k < stride; k++) {
        const uint64_t before = k > 0 ? row[k - 1] : 0, behind = k + 1 < stride ? row[k + 1] : 0;
        out[k] = row[k] | row[k] << by | row[k] >> by | before >> (64 - by) | behind << (64 - by);
    }
}

/* And those in rows that are `by` rows away. */
static void spread_rows(const uint64_t *words, size_t stride, size_t height, size_t by, uint64_t *out) {
    for (size_t y = 0; y < height; y++) {
        const uint64_t *const row = words + y * stride;
        const uint64_t *const above = y >= by ? row - by * stride : row;
        const uint64_t *const below = height - y > by ? row + by * stride : row;
        for (size_t k = 0; k < stride; k++)
            out[y * stride + k] = row[k] | above[k] | below[k];
    }
}

/* Spread one after the other, these are all within REACH: each distance is a sum of some of them, so that no step leaves
 * the picture on the way from one pixel of it to another. */
static const unsigned spreads[] = {4, 2, 1, 1};
enum { SPREADS = sizeof spreads / sizeof *spreads };
_Static_assert(REACH == 4 + 2 + 1 + 1, "spreads");

static void swap(uint64_t **a, uint64_t **b) {
    uint64_t *const other = *a;
    *a = *b;
    *b = other;
}

/* The ink that counts: what is strong enough, and fainter ink within REACH of it in both directions. Returns the one of two
 * arrays of height * stride words that it is in. */
static uint64_t *mark_ink(const struct drawing *drawing, struct extent part, int least, size_t stride, uint64_t *words,
                          uint64_t *spare) {
    const size_t width = (size_t)(part.right - part.left), height = (size_t)(part.bottom - part.top);
    const unsigned char *first = drawing->alpha + (size_t)part.top * drawing->stride + part.left;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x += 64)
            words[y * stride + x / 64] = list_word(first + y * drawing->stride, width, x, least);
    for (size_t k = 0; k < SPREADS; k++, swap(&words, &spare))
        for (size_t y = 0; y < height; y++)
            spread_row(words + y * stride, stride, spreads[k], spare + y * stride);
    for (size_t k = 0; k < SPREADS; k++, swap(&words, &spare))
        spread_rows(words, stride, height, spreads[k], spare);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x += 64)
            if (words[y * stride + x / 64])
                words[y * stride + x / 64] &= list_word(first + y * drawing->stride, width, x, 1);
    return words;
}

/* Does the whole page count, but for pixels at its right and lower sides of which only a part is on it? */
static bool fills_page(const struct drawing *drawing, int least) {
    for (int y = 0; y + 1 < drawing->height; y++)
        for (int x = 0; x + 1 < drawing->width; x++)
            if (drawing->alpha[(size_t)y * drawing->stride + (size_t)x] < least)
                return false;
    return true;
}

static narc_status fail_faint(const struct subject *of, const struct drawing *drawing, narc_error *error) {
    if (of->silhouette != NARC_SILHOUETTE_ALPHA) {
        return narc_fail(error, NARC_ERROR_FORMAT, 0, of->threshold,
                         "the SVG file has nothing %s above the threshold %g",
                         of->silhouette == NARC_SILHOUETTE_DARK ? "dark" : "light", of->threshold);
    }
    const struct extent any = find_extent(drawing, 1);
    if (any.left >= any.right)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "nothing is seen in the SVG file");
    return narc_fail(error, NARC_ERROR_FORMAT, 0, of->threshold,
                     "all ink of the SVG file is fainter than the threshold %g", of->threshold);
}

static narc_status trace(const struct subject *of, const struct drawing *drawing, narc_path *path, narc_error *error) {
    const struct extent ink = find_extent(drawing, of->least);
    if (ink.left >= ink.right)
        return fail_faint(of, drawing, error);
    const struct extent part = {ink.left > REACH ? ink.left - REACH : 0,
                                ink.right + REACH < drawing->width ? ink.right + REACH : drawing->width,
                                ink.top > REACH ? ink.top - REACH : 0,
                                ink.bottom + REACH < drawing->height ? ink.bottom + REACH : drawing->height};
    const size_t width = (size_t)(part.right - part.left), height = (size_t)(part.bottom - part.top);
    const size_t stride = (width + 63) / 64;
    uint64_t *words = malloc(2 * height * stride * sizeof *words);
    if (!words)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the outline of the SVG file");
    const double pixel = 1 / drawing->scale;
    const narc_image image = {
        .bits = {mark_ink(drawing, part, of->least, stride, words, words + height * stride), stride},
        .width = width,
        .height = height,
        .pixel = pixel,
        /* y up */
        .origin = {of->page.box.x + pixel * part.left, -of->page.box.y - pixel * part.bottom}};
    const narc_status status = narc_trace_image(&image, LEVEL, path, error);
    free(words);
    return status;
}

static narc_status draw_and_trace(const struct subject *of, bool *out_whole, narc_path *path, narc_error *error) {
    double scale;
    struct drawing drawing;
    narc_status status = find_scale(of, &scale, error);
    status = status ? status : draw(of, scale, &drawing, error);
    if (status)
        return status;
    const narc_path_mark mark = narc_mark_path(path);
    status = trace(of, &drawing, path, error);
    if (status)
        narc_rewind_path(path, mark);
    else
        path->slack = fmax(path->slack, 1 / scale);
    if (!status && out_whole)
        *out_whole = fills_page(&drawing, of->least);
    release_drawing(&drawing);
    return status;
}

/* "#id" of an element that is there; NULL in *out_element: no one is asked for. */
static narc_status find_element(RsvgHandle *handle, const char *id, char **out_element, narc_error *error) {
    *out_element = NULL;
    if (!id)
        return NARC_OK;
    const size_t size = strlen(id) + 2;
    char *element = malloc(size);
    if (!element)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for an id of the SVG file");
    snprintf(element, size, "#%s", id);
    if (!rsvg.has_sub(handle, element)) {
        free(element);
        return narc_fail(error, NARC_ERROR_INDEX, 0, 0, "the SVG file has no element with the id '%s'",
                         narc_make_excerpt(id).text);
    }
    *out_element = element;
    return NARC_OK;
}

/* A plain drawing by its geometry. */
static narc_status read_geometry(const char *data, size_t size, const narc_image_request *how, const struct subject *of,
                                 narc_path *path, bool *out_plain, narc_error *error) {
    const RsvgRectangle view = of->page.box;
    const narc_aabb page = {view.x, -view.y - view.height, view.x + view.width, -view.y};
    const narc_path_mark mark = narc_mark_path(path);
    narc_status status = narc_read_svg_geometry(data, size, how->element, of->threshold, of->page.cuts ? &page : NULL,
                                                path, out_plain, error);
    if (status || !*out_plain || !how->out_whole)
        return status;
    narc_contours drawn;
    status = narc_flatten_path(path, 0, &drawn, error);
    if (status) {
        narc_rewind_path(path, mark);
        return status;
    }
    size_t corners = 0; /* of the page, in the last contour */
    for (size_t k = begin_of(drawn.ends, drawn.count - 1); k < drawn.point_count; k++)
        corners += (drawn.points[k].x == page.min_x || drawn.points[k].x == page.max_x) &&
                   (drawn.points[k].y == page.min_y || drawn.points[k].y == page.max_y);
    *how->out_whole = of->page.cuts && corners == 4 && path->move_count - mark.move_count <= 5;
    narc_release_contours(&drawn);
    return NARC_OK;
}

narc_status narc_read_svg(const void *data, size_t size, const narc_image_request *request, narc_path *path,
                          narc_error *error) {
    const narc_image_request usual = {0}, *how = request ? request : &usual;
    narc_status status = narc_check_image_request(data, how, path, error);
    if (status)
        return status;
    const double threshold = how->threshold == 0 ? THRESHOLD : how->threshold;
    struct subject of = {
        .silhouette = how->silhouette, .threshold = threshold, .least = (int)floor(threshold * 255) + 1};
    status = open_svg(data, size, &of.handle, error);
    if (status)
        return status;
    char *element;
    status = find_element(of.handle, how->element, &element, error);
    if (!status) {
        of.element = element;
        bool plain = false;
        status = find_page(of.handle, &of.page, error);
        if (!status && !how->trace && how->silhouette == NARC_SILHOUETTE_ALPHA)
            status = read_geometry(data, size, how, &of, path, &plain, error);
        if (!status && !plain)
            status = draw_and_trace(&of, how->out_whole, path, error);
        if (!status && how->out_exact)
            *how->out_exact = plain;
        free(element);
    }
    g_object_unref(of.handle);
    return status;
}
