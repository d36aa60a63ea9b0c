/* SPDX-License-Identifier: MIT
 *
 * png.c - silhouettes in PNG images.
 */
#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdlib.h>

#include "error.h"
#include "outline/path.h"
#include "read/trace.h"

/* An image of that size takes 400 MB while it is read, and up to a GB with the outline. */
enum { MOST_PIXELS = 100000000, LONGEST_SIDE = 20000 };

/* What the samples of a narc_image go up to. */
enum { FULL = 65535 };

struct source {
    const void *data;
    size_t size;
    narc_error *error;
};

/* libpng tells in words that there is no memory, in several; malloc() does in errno. */
static narc_status fail_png(const struct source *source, png_image *image) {
    const bool has_memory = errno != ENOMEM;
    png_image_free(image);
    if (!has_memory)
        return narc_fail(source->error, NARC_ERROR_MEMORY, 0, 0, "no memory for the image");
    return narc_fail(source->error, NARC_ERROR_FORMAT, 0, 0, "not PNG, or damaged: %s", image->message);
}

/* Reads the header. The caller frees the image. */
static narc_status begin(const struct source *source, png_image *image) {
    errno = 0;
    *image = (png_image){.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(image, source->data, source->size))
        return fail_png(source, image);
    /* Images of 16 bits that do not tell their gamma are as those of 8 bits. */
    image->flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    const double pixels = (double)image->width * image->height;
    const unsigned width = image->width, height = image->height;
    if (width > LONGEST_SIDE || height > LONGEST_SIDE || pixels > MOST_PIXELS) {
        png_image_free(image);
        return narc_fail(source->error, NARC_ERROR_SIZE, 0, pixels,
                         "an image of %u x %u pixels; at most %d a side and %d in all are read, make it smaller", width,
                         height, (int)LONGEST_SIDE, (int)MOST_PIXELS);
    }
    return NARC_OK;
}

/* Reads the pixels as gray and alpha: bytes, or linear light of 16 bits, which the alpha has multiplied. Images of 16
 * bits go through linear light: libpng 1.6 mixes up the rows if it is to read an interlaced one with 8 bits. Its tables
 * keep 11 bits. */
static narc_status load(const struct source *source, png_image *image, bool *out_deep, void **out_buffer) {
    const narc_status status = begin(source, image);
    if (status)
        return status;
    const bool deep = image->format & PNG_FORMAT_FLAG_LINEAR;
    image->format = deep ? PNG_FORMAT_LINEAR_Y_ALPHA : PNG_FORMAT_GA;
    const size_t size = PNG_IMAGE_SIZE(*image);
    void *buffer = malloc(size);
    if (!buffer) {
        png_image_free(image);
        return narc_fail(source->error, NARC_ERROR_MEMORY, 0, (double)size, "no memory for the image");
    }
    if (!png_image_finish_read(image, NULL, buffer, 0, NULL)) {
        free(buffer);
        return fail_png(source, image);
    }
    *out_deep = deep;
    *out_buffer = buffer;
    return NARC_OK;
}

/* How much a pixel of this gray and alpha, of at most `full`, belongs to the silhouette. */
static unsigned weigh(narc_silhouette silhouette, unsigned gray, unsigned alpha, unsigned full) {
    const unsigned part = silhouette == NARC_SILHOUETTE_ALPHA  ? full
                          : silhouette == NARC_SILHOUETTE_DARK ? full - gray
                                                               : gray;
    return (unsigned)(((uint64_t)part * alpha + full / 2) / full);
}

static void weigh_bytes(narc_silhouette silhouette, void *buffer, size_t count) {
    const unsigned char *bytes = buffer;
    uint16_t *samples = buffer;
    for (size_t k = 0; k < count; k++) {
        const unsigned weight = weigh(silhouette, bytes[2 * k], bytes[2 * k + 1], 255);
        samples[k] = (uint16_t)(weight * (FULL / 255));
    }
}

/* Linear light counts as what a file holds, which is what antialiased edges are blended in: libpng takes values for
 * linear light to the power 0.45455 unless the file tells another. */
static narc_status weigh_words(const struct source *source, narc_silhouette silhouette, uint16_t *samples,
                               size_t count) {
    uint16_t *encoded = malloc((FULL + 1) * sizeof *encoded);
    if (!encoded)
        return narc_fail(source->error, NARC_ERROR_MEMORY, 0, 0, "no memory for the image");
    for (size_t k = 0; k <= FULL; k++)
        encoded[k] = (uint16_t)lround(FULL * pow((double)k / FULL, 0.45455));
    for (size_t k = 0; k < count; k++) {
        const uint32_t light = samples[2 * k], alpha = samples[2 * k + 1];
        const uint32_t gray = light < alpha ? (light * FULL + alpha / 2) / alpha : FULL;
        samples[k] = (uint16_t)weigh(silhouette, encoded[gray], alpha, FULL);
    }
    free(encoded);
    return NARC_OK;
}

static narc_status load_silhouette(const struct source *source, narc_silhouette silhouette, png_image *image,
                                   void **out_buffer) {
    void *buffer = NULL;
    bool deep = false;
    narc_status status = load(source, image, &deep, &buffer);
    if (status)
        return status;
    const size_t count = (size_t)image->width * image->height;
    if (deep)
        status = weigh_words(source, silhouette, buffer, count);
    else
        weigh_bytes(silhouette, buffer, count);
    if (status)
        free(buffer);
    else
        *out_buffer = buffer;
    return status;
}

/* Between two values that a sample can have: contours then never pass through a sample, where they could touch. */
static double sample_level(double threshold) { return floor((threshold == 0 ? 0.5 : threshold) * FULL) + 0.5; }

static void find_range(const narc_image *image, unsigned *least, unsigned *most) {
    *least = FULL;
    *most = 0;
    for (size_t k = 0; k < image->width * image->height; k++) {
        *least = image->samples[k] < *least ? image->samples[k] : *least;
        *most = image->samples[k] > *most ? image->samples[k] : *most;
    }
}

/* An image that is full throughout. A contour of the samples would cut its corners. */
static narc_status draw_rectangle(double width, double height, narc_path *path, narc_error *error) {
    narc_status status = narc_move_to(path, &(narc_point){0, 0}, error);
    status = status ? status : narc_line_to(path, &(narc_point){width, 0}, error);
    status = status ? status : narc_line_to(path, &(narc_point){width, height}, error);
    return status ? status : narc_line_to(path, &(narc_point){0, height}, error);
}

narc_status narc_read_png(const void *data, size_t size, const narc_image_request *request, narc_path *path,
                          narc_error *error) {
    const narc_image_request usual = {0}, *how = request ? request : &usual;
    narc_status status = narc_check_image_request(data, how, path, error);
    if (status)
        return status;
    if (size == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the PNG file is empty");
    const struct source source = {data, size, error};
    png_image image;
    void *samples = NULL;
    status = load_silhouette(&source, how->silhouette, &image, &samples);
    if (status)
        return status;
    const narc_image silhouette = {.samples = samples, .width = image.width, .height = image.height, .pixel = 1};
    const double level = sample_level(how->threshold);
    static const char *const empty[] = {"transparent", "light or transparent", "dark or transparent"};
    unsigned least, most;
    find_range(&silhouette, &least, &most);
    const narc_path_mark mark = narc_mark_path(path);
    status = least == FULL ? draw_rectangle(image.width, image.height, path, error)
                           : narc_trace_image(&silhouette, level, path, error);
    if (!status && !narc_is_drawn_since(path, mark))
        status = most == 0 ? narc_fail(error, NARC_ERROR_FORMAT, 0, how->threshold, "the image is %s throughout",
                                       empty[how->silhouette])
                           : narc_fail(error, NARC_ERROR_FORMAT, 0, how->threshold,
                                       "no pixel of the image reaches the threshold %g; the strongest has %.3g",
                                       how->threshold == 0 ? 0.5 : how->threshold, most / (double)FULL);
    if (status)
        narc_rewind_path(path, mark);
    else if (how->out_whole)
        *how->out_whole = least > level;
    free(samples);
    return status;
}
