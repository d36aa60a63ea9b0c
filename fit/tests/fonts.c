/* SPDX-License-Identifier: MIT
 *
 * fonts.c - glyphs: a font whose outlines are known, fonts without outlines, damaged ones, and the glyphs of
 * the fonts whose files are the program's arguments. Skipped without any.
 */
#include <float.h>
#include <ft2build.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include FT_FREETYPE_H

#include "fit_support.h"
#include "type1.h"

/* The fonts that the program was given, read whole. */
typedef struct file {
    const char *name;
    unsigned char *data;
    size_t size;
} file;
static int file_count;
static file files[8];

static narc_font *open_bytes(const void *data, size_t size) {
    narc_font *font = NULL;
    narc_error error;
    expect_ok(narc_open_font(data, size, &font, &error), &error);
    assert_non_null(font);
    return font;
}

/* ---------------------------------------------------------------------------- made by hand */

/* A contour of a line, two curves and the closing line; one that is a point, an anchor; one of two curves. */
static const char operators[] = "mlcczmlzmccz";
static const int steps[] = {100, 200, 400, 0,   0,   150, -50, 300, -200, 300, -150, -20, -50, -130, 0, -500, 20,
                            -30, 0,   0,   300, 500, 0,   100, 100, 0,    50,  -200, -1,  -60, -120, 7, -149, 160};

/* The same with the path's pen. */
static narc_path *draw_type1_glyph(void) {
    narc_path *path = make_path();
    narc_error error;
    const double unit = 1.0 / 1000;
    double x = 0, y = 0;
    const int *step = steps;
    for (const char *letter = operators; *letter; letter++) {
        narc_point p[3];
        const int points = *letter == 'c' ? 3 : *letter == 'z' ? 0 : 1;
        for (int i = 0; i < points; i++) {
            x += *step++;
            y += *step++;
            p[i] = (narc_point){x * unit, y * unit};
        }
        const bool anchor = letter - operators >= 5 && letter - operators < 8;
        narc_status status = NARC_OK;
        if (!anchor && *letter != 'z') {
            status = *letter == 'm'   ? narc_move_to(path, &p[0], &error)
                     : *letter == 'l' ? narc_line_to(path, &p[0], &error)
                                      : narc_cubic_to(path, &p[0], &p[1], &p[2], &error);
        }
        expect_ok(status, &error);
    }
    return path;
}

/* Nothing but the order of two operations may differ: an epsilon, of numbers up to 1. */
static void expect_same_contours(const narc_path *path, const narc_path *expected) {
    AUTO(narc_release_contours) narc_contours a = flatten(path), b = flatten(expected);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.ends, b.ends, a.count * sizeof *a.ends);
    for (size_t i = 0; i < a.point_count; i++)
        assert_true(hypot(a.points[i].x - b.points[i].x, a.points[i].y - b.points[i].y) <= 4 * DBL_EPSILON);
}

TEST(reads_cubic_curves) {
    size_t size;
    AUTO(free_at) char *data = make_type1_font(operators, steps, &size);
    AUTO(narc_close_font_at) narc_font *font = open_bytes(data, size);
    AUTO(narc_destroy_path_at) narc_path *path = make_path(), *expected = draw_type1_glyph();
    narc_error error;
    expect_ok(narc_read_glyph(font, 'A', path, &error), &error);
    expect_same_contours(path, expected);
    assert_int_equal(narc_next_character(font, 0), ' ');
    assert_int_equal(narc_next_character(font, ' '), 'A');
}

TEST(names_what_is_wrong_with_a_glyph) {
    size_t size;
    AUTO(free_at) char *data = make_type1_font("mlz", (int[]){10, 10, 0, 0}, &size);
    AUTO(narc_close_font_at) narc_font *font = open_bytes(data, size);
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_error error;
    expect_error(narc_read_glyph(font, ' ', path, &error), NARC_ERROR_FORMAT, &error, "no outline: U+0020 is blank");
    expect_error(narc_read_glyph(font, 'A', path, &error), NARC_ERROR_FORMAT, &error, "no outline: U+0041 is blank");
    expect_error(narc_read_glyph(font, 0x1f600, path, &error), NARC_ERROR_INDEX, &error, "no glyph for U+1F600");
    expect_error(narc_read_glyph(font, UINT32_MAX, path, &error), NARC_ERROR_INDEX, &error, "U+FFFFFFFF");
    expect_error(narc_read_glyph(NULL, 'A', path, &error), NARC_ERROR_ARGUMENT, &error, "font is NULL");
    expect_error(narc_read_glyph(font, 'A', NULL, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
    expect_unchanged(path);
    assert_int_equal(narc_next_character(NULL, 0), 0);
    assert_int_equal(narc_next_character(font, UINT32_MAX), 0);
    narc_close_font(NULL);
}

/* A glyph bitmap in a font of the Glyph Bitmap Distribution Format. */
static const char bitmap_font[] =
    "STARTFONT 2.1\nFONT -test-test-medium-r-normal--8-80-75-75-c-80-iso10646-1\nSIZE 8 75 75\nFONTBOUNDINGBOX 8 8 0 "
    "0\n"
    "STARTPROPERTIES 2\nCHARSET_REGISTRY \"ISO10646\"\nCHARSET_ENCODING \"1\"\nENDPROPERTIES\nCHARS 1\n"
    "STARTCHAR A\nENCODING 65\nSWIDTH 500 0\nDWIDTH 8 0\nBBX 8 8 0 0\nBITMAP\n"
    "18\n24\n42\n81\nFF\n81\n81\n81\nENDCHAR\nENDFONT\n";

static void expect_no_font(const void *data, size_t size, narc_status expected, const char *words) {
    narc_font *font = (narc_font *)&font, *const untouched = font;
    narc_error error;
    expect_error(narc_open_font(data, size, &font, &error), expected, &error, words);
    assert_ptr_equal(font, untouched);
    assert_int_equal(narc_open_font(data, size, &font, NULL), expected);
}

TEST(refuses_what_is_no_font) {
    narc_error error;
    expect_no_font("", 0, NARC_ERROR_FORMAT, "not a font that FreeType can read (0 bytes)");
    expect_no_font("glyphs", 6, NARC_ERROR_FORMAT, "not a font");
    expect_no_font("glyphs", SIZE_MAX, NARC_ERROR_FORMAT, "not a font");
    expect_no_font(NULL, 6, NARC_ERROR_ARGUMENT, "data is NULL");
    expect_error(narc_open_font("", 0, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_font is NULL");
    expect_no_font(bitmap_font, sizeof bitmap_font - 1, NARC_ERROR_FORMAT, "a font of bitmaps");
}

/* A table by its tag. */
static unsigned char *find_truetype_table(unsigned char *font, const char *tag) {
    for (unsigned k = 0; k < read_big_endian(font + 4, 2); k++) {
        unsigned char *entry = font + 12 + 16 * k;
        if (memcmp(entry, tag, 4) == 0)
            return font + read_big_endian(entry + 8, 4);
    }
    fail_msg("no table %s", tag);
    return NULL;
}

/* A font whose character maps all say that they are of a platform that there is not, and whose glyphs have no names,
 * from which FreeType would make a map. */
TEST(refuses_fonts_without_unicode) {
    for (int k = 0; k < file_count; k++) {
        file copy = {files[k].name, malloc(files[k].size), files[k].size};
        assert_non_null(copy.data);
        memcpy(copy.data, files[k].data, copy.size);
        unsigned char *map = find_truetype_table(copy.data, "cmap");
        for (unsigned i = 0; i < read_big_endian(map + 2, 2); i++)
            map[4 + 8 * i + 1] = 7;
        memcpy(find_truetype_table(copy.data, "post"), (unsigned char[]){0, 3, 0, 0}, 4);
        expect_no_font(copy.data, copy.size, NARC_ERROR_FORMAT, "without a Unicode character map");
        free(copy.data);
    }
}

/* ---------------------------------------------------------------------------- real ones */

static narc_point middle(narc_point a, narc_point b) { return (narc_point){(a.x + b.x) / 2, (a.y + b.y) / 2}; }

/* A contour of `count` points. It begins with its first point if that is on the curve, else with its last, else midway
 * between them. */
static void draw_contour(const narc_point *p, const bool *on, size_t count, narc_path *path) {
    size_t start = 0, left = count;
    narc_point begin = p[0];
    if (!on[0]) {
        begin = on[count - 1] ? p[count - 1] : middle(p[0], p[count - 1]);
        left -= on[count - 1];
    } else {
        start = 1;
        left -= 1;
    }
    narc_error error;
    narc_status status = narc_move_to(path, &begin, &error);
    for (size_t k = 0; k < left && !status; k++) {
        const size_t i = start + k;
        if (on[i]) {
            status = narc_line_to(path, &p[i], &error);
        } else if (k + 1 == left) {
            status = narc_quadratic_to(path, &p[i], &begin, &error);
        } else if (on[i + 1]) {
            status = narc_quadratic_to(path, &p[i], &p[i + 1], &error);
            k++;
        } else {
            const narc_point next = middle(p[i], p[i + 1]);
            status = narc_quadratic_to(path, &p[i], &next, &error);
        }
    }
    expect_ok(status, &error);
}

/* A glyph by its points, as FreeType has them; false if nothing is drawn. Contours that are one point are not. */
static bool draw_points(FT_Face face, uint32_t character, narc_path *path) {
    enum { MOST_POINTS = 4000 };
    const double unit = 1.0 / face->units_per_EM;
    bool drawn = false;
    assert_int_equal(FT_Load_Char(face, character, FT_LOAD_NO_SCALE), 0);
    const FT_Outline *outline = &face->glyph->outline;
    for (int k = 0, first = 0; k < outline->n_contours; first = outline->contours[k++] + 1) {
        narc_point p[MOST_POINTS + 1];
        bool on[MOST_POINTS + 1], is_anchor = true;
        size_t count = 0;
        assert_true(outline->contours[k] - first < MOST_POINTS);
        for (int i = first; i <= outline->contours[k]; i++, count++) {
            p[count] = (narc_point){(double)outline->points[i].x * unit, (double)outline->points[i].y * unit};
            on[count] = outline->tags[i] & FT_CURVE_TAG_ON;
            is_anchor = is_anchor && p[count].x == p[0].x && p[count].y == p[0].y;
        }
        if (!is_anchor)
            draw_contour(p, on, count, path);
        drawn = drawn || !is_anchor;
    }
    return drawn;
}

/* Quadratic curves, many of whose ends are midway between control points, in place of FreeType's own walk. */
TEST(agrees_with_the_points) {
    FT_Library library;
    assert_int_equal(FT_Init_FreeType(&library), 0);
    for (int k = 0; k < file_count; k++) {
        AUTO(narc_close_font_at) narc_font *font = open_bytes(files[k].data, files[k].size);
        FT_Face face;
        assert_int_equal(FT_New_Memory_Face(library, files[k].data, (FT_Long)files[k].size, 0, &face), 0);
        size_t compared = 0;
        for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c)) {
            AUTO(narc_destroy_path_at) narc_path *path = make_path(), *expected = make_path();
            if (draw_points(face, c, expected)) {
                narc_error error;
                expect_ok(narc_read_glyph(font, c, path, &error), &error);
                expect_same_contours(path, expected);
                compared++;
            }
        }
        printf("%s: %zu glyphs compared\n", files[k].name, compared);
        assert_true(compared > 1000);
        assert_int_equal(FT_Done_Face(face), 0);
    }
    assert_int_equal(FT_Done_FreeType(library), 0);
}

/* ---------------------------------------------------------------------------- damaged */

/* Any bytes end in glyphs or errors, and an error leaves the path as it was. */
TEST(survives_damage) {
    struct test_random random = test_random_named("damaged Type 1");
    enum { FEWEST = 40 }; /* of fewer none need open, or all may */
    const size_t asked = test_trials(200), trials = asked < FEWEST ? FEWEST : asked;
    size_t size, opened = 0;
    AUTO(free_at) char *data = make_type1_font(operators, steps, &size);
    for (size_t trial = 0; trial < trials; trial++) {
        const size_t kept = trial % 2 ? size : random_below(&random, size) + 1;
        AUTO(free_at) unsigned char *copy = malloc(kept);
        assert_non_null(copy);
        memcpy(copy, data, kept);
        for (size_t changes = random_below(&random, 4); changes > 0; changes--)
            copy[random_below(&random, kept)] = (unsigned char)random_bits(&random);
        narc_font *font;
        narc_error error = {0};
        const narc_status status = narc_open_font(copy, kept, &font, &error);
        if (status) {
            expect_error(status, NARC_ERROR_FORMAT, &error, "");
        } else {
            narc_path *path = make_occupied_path();
            const narc_status result = narc_read_glyph(font, 'A', path, &error);
            const unsigned allowed = 1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_INDEX | 1u << NARC_ERROR_SIZE;
            opened += finish_any_bytes(result, &error, allowed, SIZE_MAX, path);
            narc_close_font(font);
        }
    }
    assert_true(opened > 0 && opened < trials);
}

int main(int argument_count, char **arguments) {
    if (!test_begin())
        return TEST_SKIPPED;
    for (int k = 1; k < argument_count && file_count < 8; k++)
        files[file_count++] = (file){arguments[k], read_file(arguments[k], &files[k - 1].size), files[k - 1].size};
    const int failures = test_run("fonts", NULL, NULL);
    for (int k = 0; k < file_count; k++)
        free(files[k].data);
    if (failures == 0 && file_count == 0) {
        printf("skipped: no font was found\n");
        return TEST_SKIPPED;
    }
    return failures != 0;
}
