/* SPDX-License-Identifier: MIT
 *
 * png_damage.c - PNG files that are wrong: damaged, too large, without an outline.
 */
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "png_files.h"

enum { FULL = 65535 };

static const struct png_format gray_8 = {8, PNG_COLOR_TYPE_GRAY, false};
static const struct png_format gray_alpha_8 = {8, PNG_COLOR_TYPE_GRAY_ALPHA, false};

static void expect_request_error(const void *bytes, size_t size, narc_image_request request, narc_status status,
                                 const char *words) {
    bool whole = true;
    request.out_whole = &whole;
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_error error = {.message = "?"};
    AUTO(free_at) unsigned char *copy = malloc(size ? size : 1); /* the address sanitizer sees every read behind it */
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    expect_error(narc_read_png(copy, size, &request, path, &error), status, &error, words);
    assert_int_equal(narc_read_png(copy, size, &request, path, NULL), status);
    expect_unchanged(path);
    assert_true(whole);
}

static void expect_png_error(const void *bytes, size_t size, double threshold, narc_status status, const char *words) {
    expect_request_error(bytes, size, (narc_image_request){.threshold = threshold}, status, words);
}

static struct png_file write_square(struct png_format format) {
    uint16_t alpha[64] = {0}, gray[64];
    for (size_t k = 0; k < 64; k++) {
        alpha[k] = k % 8 >= 2 && k % 8 < 6 && k >= 16 && k < 48 ? FULL : 0;
        gray[k] = (uint16_t)(FULL - alpha[k]);
    }
    return write_png(format, 8, 8, gray, alpha);
}

TEST(refuses_damaged_files) {
    AUTO(free_at) struct png_file file = write_square(gray_8);
    expect_png_error("", 0, 0, NARC_ERROR_FORMAT, "the PNG file is empty");
    expect_png_error("GIF89a_____________________________", 35, 0, NARC_ERROR_FORMAT, "not PNG, or damaged");
    expect_png_error(file.bytes, file.size / 2, 0, NARC_ERROR_FORMAT, "not PNG, or damaged");
    file.bytes[file.size - 13] ^= 1; /* the checksum of the image's data; behind it is IEND, which has 12 bytes */
    expect_png_error(file.bytes, file.size, 0, NARC_ERROR_FORMAT, "CRC");
}

static unsigned long checksum(const unsigned char *bytes, size_t size) {
    unsigned long crc = 0xffffffff;
    for (size_t k = 0; k < size; k++) {
        crc ^= bytes[k];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return crc ^ 0xffffffff;
}

static void put_word(unsigned char *bytes, unsigned long word) {
    for (int k = 0; k < 4; k++)
        bytes[k] = (unsigned char)(word >> (24 - 8 * k));
}

/* The header, 13 bytes from byte 16 on, tells a huge image, with the right checksum. */
TEST(refuses_huge_images) {
    static const struct {
        unsigned long width, height;
        narc_status status;
        const char *words;
    } cases[] = {
        {20001, 1, NARC_ERROR_SIZE, "20001 x 1 pixels; at most 20000 a side"},
        {1, 20001, NARC_ERROR_SIZE, "1 x 20001 pixels"},
        {20000, 5001, NARC_ERROR_SIZE, "100000000 in all"},
        {1000000, 1000000, NARC_ERROR_SIZE, "1000000 x 1000000 pixels"},
        {20000, 5000, NARC_ERROR_FORMAT, "damaged"}, /* as large as can be, but there is not so much data */
    };
    AUTO(free_at) struct png_file file = write_square(gray_8);
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        put_word(file.bytes + 16, cases[k].width);
        put_word(file.bytes + 20, cases[k].height);
        put_word(file.bytes + 29, checksum(file.bytes + 12, 17));
        expect_png_error(file.bytes, file.size, 0, cases[k].status, cases[k].words);
    }
}

TEST(refuses_what_has_no_outline) {
    uint16_t none[4] = {0}, some[4] = {30000, 0, 0, 0}, full[4] = {FULL, FULL, FULL, FULL};
    struct png_file file = write_png(gray_alpha_8, 2, 2, full, none);
    expect_png_error(file.bytes, file.size, 0, NARC_ERROR_FORMAT, "the image is transparent throughout");
    free(file.bytes);
    file = write_png(gray_8, 2, 2, full, NULL);
    expect_request_error(file.bytes, file.size, (narc_image_request){.silhouette = NARC_SILHOUETTE_DARK},
                         NARC_ERROR_FORMAT, "the image is light or transparent throughout");
    for (int k = -1; k <= 3; k += 4)
        expect_request_error(file.bytes, file.size, (narc_image_request){.silhouette = (narc_silhouette)k},
                             NARC_ERROR_ARGUMENT, "there is no silhouette");
    free(file.bytes);
    file = write_png(gray_alpha_8, 2, 2, full, some);
    expect_png_error(file.bytes, file.size, 0, NARC_ERROR_FORMAT, "no pixel");
    expect_png_error(file.bytes, file.size, 1, NARC_ERROR_SIZE, "threshold is 1;");
    expect_png_error(file.bytes, file.size, -0.5, NARC_ERROR_SIZE, "threshold is -0.5;");
    expect_png_error(file.bytes, file.size, NAN, NARC_ERROR_NOT_FINITE, "threshold is");
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    expect_error(narc_read_png(NULL, 5, NULL, path, &error), NARC_ERROR_ARGUMENT, &error, "data is NULL");
    expect_error(narc_read_png(file.bytes, file.size, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
    free(file.bytes);
}
