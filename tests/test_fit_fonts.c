/* SPDX-License-Identifier: MIT
 *
 * test_fit_fonts.c - glyphs: a font whose outlines are known, fonts without outlines, damaged ones, and every character
 * of the fonts whose files are the program's arguments. Skipped without any.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_fonts.h"
#include "fit_support.h"
#include "fit_truetype.h"
#include "fit_type1.h"

int file_count;
file files[8];

static void read_file(const char *name) {
    FILE *stream = fopen(name, "rb");
    file *to = &files[file_count++];
    *to = (file){name, NULL, 0};
    for (size_t got = 1; stream && got > 0; to->size += got) {
        to->data = realloc(to->data, to->size + 65536);
        got = to->data ? fread(to->data + to->size, 1, 65536, stream) : 0;
    }
    if (!stream || to->size == 0) {
        printf("%s: cannot be read\n", name);
        exit(EXIT_FAILURE);
    }
    fclose(stream);
}

static narc_font *open_bytes(const void *data, size_t size) {
    narc_font *font = NULL;
    narc_error error;
    expect_ok(narc_open_font(data, size, &font, &error), &error);
    assert_non_null(font);
    return font;
}

/* ---------------------------------------------------------------------------- made by hand */

/* A contour of a line, two curves and the closing line; one that is a point, an anchor; one of two curves. */
const char operators[] = "mlcczmlzmccz";
const int steps[] = {100, 200, 400, 0,   0,   150, -50, 300, -200, 300, -150, -20, -50, -130, 0, -500, 20,
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
            status = *letter == 'm'   ? narc_move_to(path, p[0], &error)
                     : *letter == 'l' ? narc_line_to(path, p[0], &error)
                                      : narc_cubic_to(path, p[0], p[1], p[2], &error);
        }
        expect_ok(status, &error);
    }
    return path;
}

/* Nothing but the order of two operations may differ: an epsilon, of numbers up to 1. */
static void expect_same_contours(const narc_path *path, const narc_path *expected) {
    narc_contours a = flatten(path), b = flatten(expected);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.ends, b.ends, a.count * sizeof *a.ends);
    for (size_t i = 0; i < a.point_count; i++) {
        assert_true(hypot(a.points[i].x - b.points[i].x, a.points[i].y - b.points[i].y) <= 4 * DBL_EPSILON);
    }
    narc_release_contours(&a);
    narc_release_contours(&b);
}

static void reads_cubic_curves(void **state) {
    (void)state;
    size_t size;
    char *data = make_type1_font(operators, steps, &size);
    narc_font *font = open_bytes(data, size);
    narc_path *path = make_path(), *expected = draw_type1_glyph();
    narc_error error;
    expect_ok(narc_read_glyph(font, 'A', path, &error), &error);
    expect_same_contours(path, expected);
    assert_int_equal(narc_next_character(font, 0), ' ');
    assert_int_equal(narc_next_character(font, ' '), 'A');
    narc_destroy_path(path);
    narc_destroy_path(expected);
    narc_close_font(font);
    free(data);
}

static void names_what_is_wrong_with_a_glyph(void **state) {
    (void)state;
    size_t size;
    char *data = make_type1_font("mlz", (int[]){10, 10, 0, 0}, &size);
    narc_font *font = open_bytes(data, size);
    narc_path *path = make_occupied_path();
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
    narc_destroy_path(path);
    narc_close_font(font);
    narc_close_font(NULL);
    free(data);
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

static void refuses_what_is_no_font(void **state) {
    (void)state;
    narc_error error;
    expect_no_font("", 0, NARC_ERROR_FORMAT, "not a font that FreeType can read (0 bytes)");
    expect_no_font("glyphs", 6, NARC_ERROR_FORMAT, "not a font");
    expect_no_font("glyphs", SIZE_MAX, NARC_ERROR_FORMAT, "not a font");
    expect_no_font(NULL, 6, NARC_ERROR_ARGUMENT, "data is NULL");
    expect_error(narc_open_font("", 0, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_font is NULL");
    expect_no_font(bitmap_font, sizeof bitmap_font - 1, NARC_ERROR_FORMAT, "a font of bitmaps");
}

/* A font whose character maps all say that they are of a platform that there is not, and whose glyphs have no names,
 * from which FreeType would make a map. */
static void refuses_fonts_without_unicode(void **state) {
    (void)state;
    for (int k = 0; k < file_count; k++) {
        file copy = {files[k].name, malloc(files[k].size), files[k].size};
        assert_non_null(copy.data);
        memcpy(copy.data, files[k].data, copy.size);
        unsigned char *map = find_truetype_table(copy.data, "cmap");
        for (unsigned i = 0; i < read_big_endian(map + 2, 2); i++) {
            map[4 + 8 * i + 1] = 7;
        }
        memcpy(find_truetype_table(copy.data, "post"), (unsigned char[]){0, 3, 0, 0}, 4);
        expect_no_font(copy.data, copy.size, NARC_ERROR_FORMAT, "without a Unicode character map");
        free(copy.data);
    }
}

/* ---------------------------------------------------------------------------- real ones */

/* The box around all glyphs, as the font itself has it. */
static void read_font_box(const file *from, narc_point *out_low, narc_point *out_high) {
    const unsigned char *head = find_truetype_table(from->data, "head");
    double side[4];
    for (int i = 0; i < 4; i++) {
        const unsigned bits = read_big_endian(head + 36 + 2 * i, 2);
        side[i] = (bits < 0x8000 ? (double)bits : (double)bits - 0x10000) / read_big_endian(head + 18, 2);
    }
    *out_low = (narc_point){side[0], side[1]};
    *out_high = (narc_point){side[2], side[3]};
}

/* The glyph's contours are fine, and in the box around all of them. Returns how many of the box's sides it reaches. */
static unsigned check_glyph(const file *from, uint32_t character, const narc_contours *contours) {
    narc_point low, high;
    unsigned reached = 0;
    read_font_box(from, &low, &high);
    assert_true(contours->count > 0 && contours->ends[contours->count - 1] == contours->point_count);
    /* The box is one of whole units. */
    const double slack = 1.0 / read_big_endian(find_truetype_table(from->data, "head") + 18, 2);
    for (size_t i = 0; i < contours->point_count; i++) {
        const narc_point p = contours->points[i];
        if (!(p.x >= low.x - slack && p.x <= high.x + slack && p.y >= low.y - slack && p.y <= high.y + slack)) {
            fail_msg("U+%04X: (%g, %g) is outside the font's box", (unsigned)character, p.x, p.y);
        }
        reached |= (p.x <= low.x + slack ? 1u : 0) | (p.x >= high.x - slack ? 2u : 0) |
                   (p.y <= low.y + slack ? 4u : 0) | (p.y >= high.y - slack ? 8u : 0);
    }
    return reached;
}

/* Against a reader of the format's own: those glyphs that are not composed of others. */
static void agrees_with_the_format(void **state) {
    (void)state;
    for (int k = 0; k < file_count; k++) {
        narc_font *font = open_bytes(files[k].data, files[k].size);
        size_t compared = 0;
        for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c)) {
            narc_path *path = make_path(), *expected = make_path();
            if (draw_truetype_glyph(files[k].data, c, expected)) {
                narc_error error;
                expect_ok(narc_read_glyph(font, c, path, &error), &error);
                expect_same_contours(path, expected);
                compared++;
            }
            narc_destroy_path(path);
            narc_destroy_path(expected);
        }
        printf("%s: %zu glyphs compared\n", files[k].name, compared);
        assert_true(compared > 1000);
        narc_close_font(font);
    }
}

static void reads_every_character(void **state) {
    (void)state;
    for (int k = 0; k < file_count; k++) {
        narc_font *font = open_bytes(files[k].data, files[k].size);
        size_t read = 0, blank = 0, points = 0;
        unsigned reached = 0;
        uint32_t last = 0;
        for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c)) {
            narc_path *path = make_path();
            narc_error error;
            assert_true(c > last);
            last = c;
            const narc_status status = narc_read_glyph(font, c, path, &error);
            narc_contours contours = flatten(path);
            if (status == NARC_OK) {
                reached |= check_glyph(&files[k], c, &contours);
                read++;
            } else {
                expect_error(status, NARC_ERROR_FORMAT, &error, "no outline");
                assert_int_equal(contours.count, 0);
                blank++;
            }
            points += contours.point_count;
            narc_release_contours(&contours);
            narc_destroy_path(path);
        }
        printf("%s: %zu glyphs, %zu points, sides reached %u, %zu blank\n", files[k].name, read, points, reached,
               blank);
        assert_true(read > 1000 && blank > 0 && blank < 100);
        narc_close_font(font);
    }
}

/* How many answers of find_orientation() rounding may have changed: long double rounds three times at most in what the
 * sum of both products scales. Where both are 0 so are differences, exactly. */
static int doubtful;

static int find_orientation(narc_point a, narc_point b, narc_point c) {
    const long double left = ((long double)b.x - a.x) * ((long double)c.y - a.y);
    const long double right = ((long double)b.y - a.y) * ((long double)c.x - a.x);
    const long double area = left - right, size = fabsl(left) + fabsl(right);
    doubtful += size > 0 && fabsl(area) <= 4 * LDBL_EPSILON * size;
    return (area > 0) - (area < 0);
}

/* Does a contour meet itself? All pairs of its sides; repeated points are there as they were drawn. */
static bool meets_itself(const narc_point *all, size_t all_count) {
    narc_point *p = malloc(all_count * sizeof *p);
    assert_non_null(p);
    size_t count = 0;
    for (size_t i = 0; i < all_count; i++) {
        const narc_point next = all[i + 1 < all_count ? i + 1 : 0];
        if (all[i].x != next.x || all[i].y != next.y) {
            p[count++] = all[i];
        }
    }
    bool meets = count < 3;
    for (size_t i = 0; i < count && !meets; i++) {
        for (size_t k = i + 1; k < count && !meets; k++) {
            const narc_point q = p[i + 1], s = p[(k + 1) % count];
            meets = i == 0 && k + 1 == count ? sides_meet(p[k], s, p[i], q, true, find_orientation)
                                             : sides_meet(p[i], q, p[k], s, i + 1 == k, find_orientation);
        }
    }
    free(p);
    return meets;
}

/* The index of the first contour that meets itself, or their number. */
static size_t find_hit(const narc_contours *contours) {
    size_t start = 0, k = 0;
    while (k < contours->count && !meets_itself(contours->points + start, contours->ends[k] - start)) {
        start = contours->ends[k++];
    }
    return k;
}

/* Every glyph is checked; every 40th against all pairs of its sides. */
static void checks_glyphs_for_crossings(void **state) {
    (void)state;
    for (int k = 0; k < file_count; k++) {
        narc_font *font = open_bytes(files[k].data, files[k].size);
        size_t simple = 0, hits = 0, unsure = 0, number = 0;
        for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c), number++) {
            narc_path *path = make_path();
            narc_error error;
            (void)narc_read_glyph(font, c, path, NULL); /* a blank one is simple */
            const narc_status status = narc_check_simple(path, &error);
            assert_true(status == NARC_OK || status == NARC_ERROR_NOT_SIMPLE);
            simple += status == NARC_OK;
            hits += status != NARC_OK;
            if (number % 40 == 0) {
                narc_contours contours = flatten(path);
                doubtful = 0;
                const size_t hit = find_hit(&contours);
                unsure += doubtful > 0;
                if (!doubtful && hit != (status ? error.index : contours.count)) {
                    fail_msg("U+%04X: contour %zu of %zu: %s", (unsigned)c, hit, contours.count,
                             status ? error.message : "simple");
                }
                narc_release_contours(&contours);
            }
            narc_destroy_path(path);
        }
        printf("%s: %zu glyphs with simple contours, %zu without, %zu unsure\n", files[k].name, simple, hits, unsure);
        assert_true(simple > 1000 && unsure < number / 160); /* of the compared ones a quarter */
        narc_close_font(font);
    }
}

int main(int argument_count, char **arguments) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_cubic_curves),          cmocka_unit_test(names_what_is_wrong_with_a_glyph),
        cmocka_unit_test(refuses_what_is_no_font),     cmocka_unit_test(refuses_fonts_without_unicode),
        cmocka_unit_test(reads_every_character),       cmocka_unit_test(agrees_with_the_format),
        cmocka_unit_test(checks_glyphs_for_crossings), cmocka_unit_test(survives_damage),
        cmocka_unit_test(survives_damaged_type1),
    };
    if (!test_begin()) {
        return TEST_SKIPPED;
    }
    for (int k = 1; k < argument_count && file_count < 8; k++) {
        read_file(arguments[k]);
    }
    const int failures = cmocka_run_group_tests(tests, NULL, NULL);
    for (int k = 0; k < file_count; k++) {
        free(files[k].data);
    }
    if (failures == 0 && file_count == 0) {
        printf("skipped: no font was found\n");
        return TEST_SKIPPED;
    }
    return failures != 0;
}
