/* SPDX-License-Identifier: MIT
 *
 * legend.c - samples of what a picture shows, with a word each.
 */
#include "legend.h"

#include <math.h>

/* Of the text's size: half a sample's width, the gaps behind a sample and behind a word. */
static const double HALF_SAMPLE = 1.25, SAMPLE_GAP = 0.55, WORD_GAP = 1.95;

static double measure_word(canvas *page, const char *word, double size) {
    cairo_text_extents_t extents;
    cairo_set_font_size(page->pen, size);
    cairo_text_extents(page->pen, word, &extents);
    return extents.x_advance;
}

static double measure_line(canvas *page, const char *const *words, const bool *shown, int count, double size) {
    double width = -WORD_GAP * size;
    for (int k = 0; k < count; k++)
        if (shown[k])
            width += measure_word(page, words[k], size) + (2 * HALF_SAMPLE + SAMPLE_GAP + WORD_GAP) * size;
    return width;
}

void draw_legend(canvas *page, const char *const *words, const bool *shown, int count, draw_sample *draw, double middle,
                 double y, double size, double widest) {
    size *= fmin(1, widest / fmax(measure_line(page, words, shown, count, size), 1));
    double x = middle - measure_line(page, words, shown, count, size) / 2;
    for (int k = 0; k < count; k++) {
        if (shown[k]) {
            const double width = measure_word(page, words[k], size);
            draw(page, k, x + HALF_SAMPLE * size, y, HALF_SAMPLE * size);
            x += (2 * HALF_SAMPLE + SAMPLE_GAP) * size;
            draw_text(page, words[k], x + width / 2, y + 0.3 * size, size, width);
            x += width + WORD_GAP * size;
        }
    }
}
