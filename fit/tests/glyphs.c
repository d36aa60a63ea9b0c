/* SPDX-License-Identifier: MIT
 *
 * glyphs.c - glyphs of the fonts whose files are the program's arguments: each is fitted, held, and not much
 * smaller than its shape. Skipped without fonts.
 *
 * The usual run takes some of them, evenly; NARC_TEST_TRIALS=1000 takes all.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "outlines.h"

static const char **files;
static int file_count;

static size_t count_characters(narc_font *font) {
    size_t count = 0;
    for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c))
        count++;
    return count;
}

/* Corners of the flattened contours stand for the glyph: they lie on its curves. */
static bool read_glyph(narc_font *font, uint32_t character, struct outline *out) {
    *out = make_outline("glyph");
    narc_error error;
    const narc_status status = narc_read_glyph(font, character, out->path, &error);
    if (status != NARC_OK) {
        assert_int_equal(status, NARC_ERROR_FORMAT); /* a blank */
        free_outline(out);
        return false;
    }
    AUTO(narc_release_contours) narc_contours contours;
    expect_ok(narc_flatten_path(out->path, 1e-4, &contours, &error), &error);
    out->count = out->capacity = contours.point_count;
    out->points = malloc(out->count * sizeof *out->points);
    assert_non_null(out->points);
    for (size_t k = 0; k < out->count; k++)
        out->points[k] = contours.points[k];
    return true;
}

/* Area by that of the hull, in classes of 2.5 per cent. */
enum { CLASSES = 20 };
static const double CLASS_WIDTH = 0.025;

struct tally {
    size_t count[CLASSES + 1], glyphs;
    double sum, worst;
    uint32_t worst_character;
};

static void fit_glyph(narc_font *font, uint32_t character, size_t arcs, struct tally *tally) {
    struct outline of;
    if (!read_glyph(font, character, &of))
        return;
    char name[40];
    snprintf(name, sizeof name, "character U+%04X", (unsigned)character);
    of.name = name;
    const narc_fit_result fit = fit_outline(&of, (narc_fit_request){.arc_count = arcs, .starts = 2});
    check_contained(&of, &fit, "glyph");
    const double ratio = fit.area / fit.hull_area;
    if (!(ratio <= 1.5))
        fail_msg("%s: %zu arcs have %.3f times the area of the hull", name, arcs, ratio);
    const size_t class = (size_t)((ratio - 1) / CLASS_WIDTH);
    tally->count[class < CLASSES ? class : CLASSES]++;
    tally->glyphs++;
    tally->sum += ratio;
    if (ratio > tally->worst) {
        tally->worst = ratio;
        tally->worst_character = character;
    }
    free_outline(&of);
}

TEST(test_glyphs) {
    enum { ARCS = 8, USUAL = 12 };
    for (int k = 0; k < file_count; k++) {
        size_t size;
        AUTO(free_at) unsigned char *data = read_file(files[k], &size);
        AUTO(narc_close_font_at) narc_font *font = NULL;
        narc_error error;
        expect_ok(narc_open_font(data, size, &font, &error), &error);
        const size_t all = count_characters(font), some = test_trials(USUAL);
        const size_t step = some < all ? all / some : 1;
        struct tally tally = {.glyphs = 0};
        size_t index = 0;
        for (uint32_t c = narc_next_character(font, 0); c; c = narc_next_character(font, c))
            if (index++ % step == step / 2)
                fit_glyph(font, c, ARCS, &tally);
        assert_true(tally.glyphs > 0);
        printf("%s: %zu of %zu, area / hull's area on average %.4f, at most %.4f (U+%04X); glyphs by steps of %g:",
               files[k], tally.glyphs, all, tally.sum / (double)tally.glyphs, tally.worst,
               (unsigned)tally.worst_character, CLASS_WIDTH);
        for (int class = 0; class <= CLASSES; class ++)
            printf(" %zu", tally.count[class]);
        printf("\n");
    }
}

/* Symbola's hot beverage, by its hull: a search that gives chains up too early misses it by 0.5 %. */
TEST(test_hot_beverage) {
    static const double known = 1.02158;
    for (int k = 0; k < file_count; k++) {
        if (!strstr(files[k], "Symbola"))
            continue;
        size_t size;
        AUTO(free_at) unsigned char *data = read_file(files[k], &size);
        AUTO(narc_close_font_at) narc_font *font = NULL;
        narc_error error;
        expect_ok(narc_open_font(data, size, &font, &error), &error);
        struct outline of;
        assert_true(read_glyph(font, 0x2615, &of));
        const narc_fit_result fit = fit_outline(&of, (narc_fit_request){.arc_count = 8});
        assert_true(fit.area <= known * 1.003 * fit.hull_area);
        free_outline(&of);
    }
}

int main(int argc, char **argv) {
    if (!test_begin() || argc < 2)
        return TEST_SKIPPED;
    files = (const char **)argv + 1;
    file_count = argc - 1;
    return test_run("glyphs", NULL, NULL);
}
