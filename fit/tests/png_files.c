/* SPDX-License-Identifier: MIT
 *
 * png_files.c - PNG files in memory, for the tests of their reader.
 */
#include "png_files.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

static void append(png_struct *png, png_byte *bytes, size_t size) {
    struct png_file *file = png_get_io_ptr(png);
    file->bytes = realloc(file->bytes, file->size + size);
    assert_non_null(file->bytes);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

static void flush(png_struct *png) { (void)png; }

/* 16 entries: grays, or blacks of 16 alphas. */
static void set_palette(png_struct *png, png_info *info, bool transparent) {
    png_color colors[16];
    png_byte alphas[16];
    for (int k = 0; k < 16; k++) {
        const png_byte value = (png_byte)(17 * k), gray = transparent ? 0 : value;
        colors[k] = (png_color){gray, gray, gray};
        alphas[k] = value;
    }
    png_set_PLTE(png, info, colors, 16);
    if (transparent)
        png_set_tRNS(png, info, alphas, 16, NULL);
}

/* Puts one value of 0 .. 65535 into a row, most significant bits first. */
static void put_value(png_byte *row, size_t index, int depth, unsigned value) {
    if (depth == 16) {
        row[2 * index] = (png_byte)(value >> 8);
        row[2 * index + 1] = (png_byte)(value & 255);
        return;
    }
    const unsigned full = (1u << depth) - 1, level = (value * full + 32767) / 65535;
    const size_t bit = index * (size_t)depth;
    row[bit / 8] = (png_byte)(row[bit / 8] | level << (8 - (size_t)depth - bit % 8));
}

static void fill_row(struct png_format format, size_t width, const uint16_t *gray, const uint16_t *alpha,
                     png_byte *row) {
    const bool palette = format.color_type == PNG_COLOR_TYPE_PALETTE;
    const size_t grays = format.color_type & PNG_COLOR_MASK_COLOR && !palette ? 3 : 1;
    size_t index = 0;
    for (size_t x = 0; x < width; x++) {
        if (palette) {
            const unsigned value = alpha ? alpha[x] : gray[x];
            put_value(row, index++, 8, (value * 15 + 32767) / 65535 * 257);
            continue;
        }
        for (size_t k = 0; k < grays; k++)
            put_value(row, index++, format.bit_depth, gray[x]);
        if (format.color_type & PNG_COLOR_MASK_ALPHA)
            put_value(row, index++, format.bit_depth, alpha[x]);
    }
}

struct png_file write_png(struct png_format format, size_t width, size_t height, const uint16_t *gray,
                          const uint16_t *alpha) {
    struct png_file file = {NULL, 0};
    png_struct *png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_info *info = png_create_info_struct(png);
    assert_non_null(info);
    png_set_write_fn(png, &file, append, flush);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, format.bit_depth, format.color_type,
                 format.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (format.color_type == PNG_COLOR_TYPE_PALETTE)
        set_palette(png, info, alpha != NULL);
    png_write_info(png, info);
    const size_t stride = 8 * width;
    AUTO(free_at) png_byte *pixels = calloc(height, stride);
    assert_non_null(pixels);
    for (size_t y = 0; y < height; y++)
        fill_row(format, width, gray + y * width, alpha ? alpha + y * width : NULL, pixels + y * stride);
    for (int pass = png_set_interlace_handling(png); pass > 0; pass--)
        for (size_t y = 0; y < height; y++)
            png_write_row(png, pixels + y * stride);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

narc_contours read_silhouette(struct png_file file, narc_image_request request) {
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error = {.message = ""};
    expect_ok(narc_read_png(file.bytes, file.size, &request, path, &error), &error);
    return flatten(path);
}

narc_contours read_png(struct png_file file, double threshold) {
    return read_silhouette(file, (narc_image_request){.threshold = threshold});
}
