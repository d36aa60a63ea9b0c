/* SPDX-License-Identifier: MIT
 *
 * readers.c - any bytes to a reader, the one that FUZZ_READER names: a program for each. Something is read, or an error
 * is told and nothing has changed. A shapes file that is read and written is the same again.
 */
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"
#include "fuzz.h"
#include "narc_files.h"

static const enum format { SHAPES, CSV, JSON, SVG, PNG, DXF, FONT } format = FUZZ_READER;

static void compare_lists(const narc_shape_list *a, const narc_shape_list *b) {
    assert_int_equal(a->count, b->count);
    for (size_t k = 0; k < a->count; k++) {
        const narc_named_shape *const one = &a->items[k], *const other = &b->items[k];
        assert_string_equal(one->name, other->name);
        assert_int_equal(one->arc_count, other->arc_count);
        assert_int_equal(one->form, other->form);
        assert_memory_equal(&one->origin, &other->origin, sizeof one->origin);
        assert_memory_equal(one->arcs, other->arcs, one->arc_count * sizeof *one->arcs);
    }
}

static void read_shapes(const uint8_t *data, size_t size) {
    narc_shape_list *list = NULL, *again = NULL;
    narc_shapes *const store = empty_store();
    narc_error error = {.message = ""};
    char *text = NULL;
    const narc_status status = narc_read_shapes(data, size, NULL, store, &list, &error);
    if (status == NARC_OK) {
        assert_true(narc_count_shapes(store) <= list->count);
        assert_int_equal(narc_write_shapes(list->items, list->count, NULL, &text, &size, NULL), NARC_OK);
        assert_int_equal(narc_read_shapes(text, size, NULL, NULL, &again, NULL), NARC_OK);
        compare_lists(list, again);
        narc_destroy_shape_list(again);
        free(text);
    } else {
        expect_error(status, error.status, &error, "");
        for (uint32_t k = 0; k < narc_count_shapes(store); k++)
            assert_int_equal(narc_count_uses(store, k), 0);
    }
    narc_destroy_shape_list(list);
    narc_destroy_shapes(store);
}

static narc_status read_font(const uint8_t *data, size_t size, narc_path *path, narc_error *error) {
    narc_font *font = NULL;
    narc_status status = narc_open_font(data, size, &font, error);
    uint32_t character = 0;
    for (int k = 0; k < 4 && status == NARC_OK && (k == 0 || character != 0); k++) {
        character = narc_next_character(font, character);
        status = narc_read_glyph(font, character, path, error);
        if (status != NARC_OK && k > 0) { /* those before it are there, as finish_any_bytes() does not expect */
            status = NARC_OK;
            break;
        }
    }
    narc_close_font(font);
    return status;
}

static narc_status read_path(const uint8_t *data, size_t size, narc_path *path, narc_error *error) {
    narc_image_request request = {.silhouette = (narc_silhouette)(size % 3)};
    switch (format) {
    case CSV:
        return narc_read_csv(data, size, path, error);
    case JSON:
        return narc_read_json(data, size, path, error);
    case SVG:
        return narc_read_svg(data, size, &request, path, error);
    case PNG:
        return narc_read_png(data, size, &request, path, error);
    case DXF:
        return narc_read_dxf(data, size, NULL, path, error);
    case FONT:
        return read_font(data, size, path, error);
    default:
        return NARC_ERROR_ARGUMENT;
    }
}

/* Gives the chunks of a PNG file the checksums that they should have, or hardly a change would get beyond these. */
static uint8_t *mend_checksums(const uint8_t *data, size_t size) {
    uint8_t *const png = malloc(size + 1);
    assert_non_null(png);
    memcpy(png, data, size);
    for (size_t at = 8; at + 12 <= size;) {
        const size_t length = read_big_endian(png + at, 4);
        uint32_t crc = UINT32_MAX;
        if (length > size - at - 12)
            break;
        for (size_t k = at + 4; k < at + 8 + length; k++) {
            crc ^= png[k];
            for (int bit = 0; bit < 8; bit++)
                crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
        }
        at += 8 + length;
        for (int k = 0; k < 4; k++)
            png[at++] = (uint8_t)(~crc >> (24 - 8 * k));
    }
    return png;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (format == SHAPES) {
        read_shapes(data, size);
        return 0;
    }
    narc_path *const path = make_occupied_path();
    narc_error error = {.message = ""};
    uint8_t *const png = format == PNG ? mend_checksums(data, size) : NULL;
    const narc_status status = read_path(png ? png : data, size, path, &error);
    free(png);
    finish_any_bytes(status, &error,
                     1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_NOT_FINITE | 1u << NARC_ERROR_SIZE |
                         1u << NARC_ERROR_INDEX | 1u << NARC_ERROR_RADIUS,
                     SIZE_MAX, path);
    return 0;
}
