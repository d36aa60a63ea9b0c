/* SPDX-License-Identifier: MIT
 *
 * figures.c - draws the figures of docs/algorithm.md into a folder: narc_figures FOLDER
 */
#include "figures.h"

#include <stdio.h>

outline make_pebble(void) {
    static const narc_point points[] = {{-1.35, -0.75}, {0.35, -1.2}, {1.5, -0.2}, {0.75, 1.05}, {-0.95, 0.85}};
    return outline_near(points, sizeof points / sizeof *points);
}

outline make_bean(void) {
    static const narc_point points[] = {{-2.2, 0}, {-1, -0.62}, {1.1, -0.7}, {2.2, 0.1}, {0.2, 0.72}};
    return outline_near(points, sizeof points / sizeof *points);
}

outline make_block(void) {
    static const narc_point points[] = {{-1.2, -0.8}, {1.3, -0.8}, {1, 0.75}, {-0.7, 0.95}};
    return outline_of_polygon(points, sizeof points / sizeof *points, 0.2);
}

void write_index(sheet *page, double x, double y, double right, double down, double size, char letter, size_t k) {
    char text[16];
    snprintf(text, sizeof text, "%c_%d", letter, (int)k + 1);
    write_formula(page, x, y, right, down, 0, size, text);
}

void write_pair(sheet *page, double x, double y, double right, double down, double size, size_t i, size_t j) {
    char text[32];
    snprintf(text, sizeof text, "(%d,%d)", (int)i + 1, (int)j + 1);
    write_words(page, x, y, right, down, 0, size, text);
}

int main(int count, char **words) {
    if (count != 2) {
        fprintf(stderr, "usage: narc_figures FOLDER\n");
        return 2;
    }
    draw_shape(words[1]);
    draw_gap(words[1]);
    draw_directions(words[1]);
    draw_fans(words[1]);
    draw_search(words[1]);
    draw_certificate(words[1]);
    return 0;
}
