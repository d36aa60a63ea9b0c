/* SPDX-License-Identifier: MIT
 *
 * png.c - silhouettes in PNG images.
 */
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

static narc_status fail_png(const struct source *source, png_image *image) {
    png_image_free(image);
    return narc_fail(source->error, NARC_ERROR_FORMAT, 0, 0, "not PNG, or damaged: %s", image->message);
}

/* Reads the header. The caller frees the image. */
static narc_status begin(const struct source *source, png_image *image) {
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
                         "an image of %u x %u pixels; at most %d a side and %d in all are read", width, height,
                         (int)LONGEST_SIDE, (int)MOST_PIXELS);
    }
    return NARC_OK;
}

/* Reads the pixels in a format of the library's, in a buffer of at least 2 bytes a pixel. */
static narc_status load(const struct source *source, png_uint_32 format, png_image *image, void **out_buffer) {
    const narc_status status = begin(source, image);
    if (status)
        return status;
    image->format = format;
    const size_t size = PNG_IMAGE_SIZE(*image), least = (size_t)2 * image->width * image->height;
    void *buffer = malloc(size > least ? size : least);
    if (!buffer) {
        png_image_free(image);
        return narc_fail(source->error, NARC_ERROR_MEMORY, 0, (double)size, "no memory for the image");
    }
    if (!png_image_finish_read(image, NULL, buffer, 0, NULL)) {
        free(buffer);
        return fail_png(source, image);
    }
    *out_buffer = buffer;
    return NARC_OK;
}

/* Gray (or alpha) of 8 bits that stand every `step` bytes from `first` on become samples in the same buffer, `samples`.
 * With one byte each they grow: from the end, none is overwritten before it was read. */
static void widen(void *buffer, size_t count, size_t first, size_t step) {
    const unsigned char *bytes = buffer;
    uint16_t *samples = buffer;
    if (step == 2) {
        for (size_t k = 0; k < count; k++) {
            const unsigned value = bytes[2 * k + first];
            samples[k] = (uint16_t)(value * (FULL / 255));
        }
        return;
    }
    for (size_t k = count; k-- > 0;) {
        const unsigned value = bytes[k];
        samples[k] = (uint16_t)(value * (FULL / 255));
    }
}

/* The alpha channel, in as many bits as the file has; *out_opaque: it is full throughout. */
static narc_status load_alpha(const struct source *source, bool deep, png_image *image, void **out_buffer,
                              bool *out_opaque) {
    void *buffer = NULL;
    const narc_status status = load(source, deep ? PNG_FORMAT_LINEAR_Y_ALPHA : PNG_FORMAT_GA, image, &buffer);
    if (status)
        return status;
    uint16_t *samples = buffer;
    const size_t count = (size_t)image->width * image->height;
    if (deep)
        for (size_t k = 0; k < count; k++)
            samples[k] = samples[2 * k + 1];
    else
        widen(buffer, count, 1, 2);
    bool opaque = true;
    for (size_t k = 0; k < count && opaque; k++)
        opaque = samples[k] == FULL;
    *out_opaque = opaque;
    *out_buffer = buffer;
    return NARC_OK;
}

/* Linear light of 16 bits as what a file holds, which is what antialiased edges are blended in: libpng takes values for
 * linear light to the power 0.45455 unless the file tells another. */
static narc_status encode(const struct source *source, uint16_t *samples, size_t count) {
    uint16_t *table = malloc((FULL + 1) * sizeof(*table));
    if (!table)
        return narc_fail(source->error, NARC_ERROR_MEMORY, 0, 0, "no memory for the image");
    for (size_t k = 0; k <= FULL; k++)
        table[k] = (uint16_t)lround(FULL * pow((double)k / FULL, 0.45455));
    for (size_t k = 0; k < count; k++)
        samples[k] = table[samples[k]];
    free(table);
    return NARC_OK;
}

/* Gray, encoded. Images of 16 bits go through linear light: libpng 1.6 mixes up the rows if it is to read an interlaced
 * one with 8 bits. Its tables keep 11 bits. */
static narc_status load_gray(const struct source *source, bool deep, png_image *image, void **out_buffer) {
    void *buffer = NULL;
    narc_status status = load(source, deep ? PNG_FORMAT_LINEAR_Y : PNG_FORMAT_GRAY, image, &buffer);
    if (status)
        return status;
    const size_t count = (size_t)image->width * image->height;
    if (deep)
        status = encode(source, buffer, count);
    else
        widen(buffer, count, 0, 1);
    if (status) {
        free(buffer);
        return status;
    }
    *out_buffer = buffer;
    return NARC_OK;
}

/* Darkness, or lightness if the four corners are on average darker than half. */
static narc_status load_darkness(const struct source *source, bool deep, png_image *image, void **out_buffer) {
    const narc_status status = load_gray(source, deep, image, out_buffer);
    if (status)
        return status;
    uint16_t *samples = *out_buffer;
    const size_t width = image->width, count = width * image->height;
    const unsigned corners = (unsigned)samples[0] + samples[width - 1] + samples[count - width] + samples[count - 1];
    for (size_t k = 0; k < count && corners >= 2 * FULL; k++)
        samples[k] = (uint16_t)(FULL - samples[k]);
    return NARC_OK;
}

static narc_status load_silhouette(const struct source *source, png_image *image, void **out_buffer) {
    void *buffer = NULL;
    bool opaque = true;
    narc_status status = begin(source, image);
    if (status)
        return status;
    const bool alpha = image->format & PNG_FORMAT_FLAG_ALPHA, deep = image->format & PNG_FORMAT_FLAG_LINEAR;
    png_image_free(image);
    if (alpha) {
        status = load_alpha(source, deep, image, &buffer, &opaque);
        if (!status && opaque)
            free(buffer);
    }
    if (!status && opaque)
        status = load_darkness(source, deep, image, &buffer);
    if (!status)
        *out_buffer = buffer;
    return status;
}

/* Between two values that a sample can have: contours then never pass through a sample, where they could touch. */
static double sample_level(double threshold) { return floor((threshold == 0 ? 0.5 : threshold) * FULL) + 0.5; }

narc_status narc_read_png(const void *data, size_t size, double threshold, narc_path *path, narc_error *error) {
    if (!data || !path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, data ? "path is NULL" : "data is NULL");
    if (!(threshold >= 0 && threshold < 1)) {
        return narc_fail(error, isnan(threshold) ? NARC_ERROR_NOT_FINITE : NARC_ERROR_SIZE, 0, threshold,
                         "threshold is %g; it must be between 0 and 1", threshold);
    }
    if (size == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the PNG file is empty");
    const struct source source = {data, size, error};
    png_image image;
    void *samples = NULL;
    narc_status status = load_silhouette(&source, &image, &samples);
    if (status)
        return status;
    const narc_image silhouette = {.samples = samples, .width = image.width, .height = image.height, .pixel = 1};
    const narc_path_mark mark = narc_mark_path(path);
    status = narc_trace_image(&silhouette, sample_level(threshold), path, error);
    if (!status && !narc_is_drawn_since(path, mark))
        status = narc_fail(error, NARC_ERROR_FORMAT, 0, threshold, "no pixel of the image reaches the threshold");
    if (status)
        narc_rewind_path(path, mark);
    free(samples);
    return status;
}
