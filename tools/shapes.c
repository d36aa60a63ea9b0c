/* SPDX-License-Identifier: MIT
 *
 * shapes.c - narc shapes: glyphs of a font to n-arcs.
 */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "canvas.h"
#include "commands.h"
#include "fail.h"
#include "options.h"
#include "output.h"
#include "picture_glyphs.h"
#include "progress.h"
#include "shapes_json.h"
#include "text.h"

static const char HELP[] = "usage: narc shapes FONT CHARACTERS --arcs N [--out shapes.json] [--picture FILE]\n"
                           "\n"
                           "Makes an n-arc of each character: the glyph's outline, its convex hull, a polygon with N\n"
                           "sides, and the n-arc that follows the polygon. The polygon stands around the hull if\n"
                           "the hull has at least N corners; of a hull with fewer the sharpest corners are cut off.\n"
                           "\n"
                           "  FONT            a font file that FreeType reads\n"
                           "  CHARACTERS      UTF-8 text; each character is one shape (variation selectors and\n"
                           "                  repeated characters are skipped)\n"
                           "  --arcs N        arcs per shape, 3 to 64\n"
                           "  --out FILE      the shapes file to write; left out or -: standard output\n"
                           "  --picture FILE  a .png or .svg picture of glyphs, polygons and n-arcs\n"
                           "\n"
                           "A shape is named by its character if that is an ASCII letter, and otherwise by its code\n"
                           "point, such as U+1F47B or U+0037 (a name 7 would be taken for an index). Lengths are in\n"
                           "em (font units divided by units per em), and the shape's centroid is its origin.\n";

enum { SMALLEST_ARCS = 3 };

/* Variation selectors choose between glyphs of the character before them; they are none themselves. */
static bool is_selector(uint32_t code) {
    return (code >= 0xfe00 && code <= 0xfe0f) || (code >= 0xe0100 && code <= 0xe01ef);
}

/* The characters to use, each once, in order. */
static uint32_t *list_characters(const char *text, size_t *out_count) {
    uint32_t *codes = allocate(strlen(text), sizeof *codes);
    enum { CODES = 0x110000 };
    unsigned char *seen = allocate(CODES, 1);
    memset(seen, 0, CODES);
    size_t count = 0;
    for (const char *c = text; *c;) {
        uint32_t code;
        if (!next_code_point(&c, &code)) {
            fail("CHARACTERS is not valid UTF-8 at byte %td", c - text);
        }
        if (!is_selector(code) && !seen[code]) {
            seen[code] = 1;
            codes[count++] = code;
        }
    }
    free(seen);
    if (count == 0) {
        fail("CHARACTERS is empty");
    }
    *out_count = count;
    return codes;
}

static void print_row(FILE *file, const glyph *made) {
    double smallest = DBL_MAX, largest = 0;
    for (size_t i = 0; i < made->arc_count; i++) {
        const double radius = made->arcs[i].radius;
        smallest = radius < smallest ? radius : smallest;
        largest = radius > largest ? radius : largest;
    }
    fprintf(file, "%-9s %5zu %10.6f %10.6f %16.6f %15.6f\n", made->name, made->arc_count, made->area, made->hull_area,
            smallest, largest);
}

static void run(int argc, char **argv) {
    enum { ARCS, OUT, PICTURE, OPTIONS };
    option options[OPTIONS] = {{"--arcs", true, NULL}, {"--out", true, NULL}, {"--picture", true, NULL}};
    static const char *const names[] = {"FONT", "CHARACTERS"};
    const char *operands[2];
    parse_options(argc, argv, options, OPTIONS, names, 2, operands);
    const size_t arcs = (size_t)whole_option(&options[ARCS], SMALLEST_ARCS, NARC_MAX_ARCS);
    const char *picture = options[PICTURE].value, *out = options[OUT].value ? options[OUT].value : "-";
    picture_kind_of(picture);
    size_t count;
    uint32_t *codes = list_characters(operands[1], &count);

    font *from = open_font(operands[0]);
    glyph *glyphs = allocate(count, sizeof *glyphs);
    shape_list shapes = {0};
    for (size_t i = 0; i < count; i++) {
        make_glyph(from, codes[i], arcs, &glyphs[i]);
        narc_error error;
        if (add_shape(&shapes, glyphs[i].name, glyphs[i].arcs, glyphs[i].arc_count, &error) != NARC_OK) {
            fail("%s: U+%04X: %s", operands[0], (unsigned)codes[i], error.message);
        }
        show_progress("making shapes", i, count);
    }
    write_shapes(open_output(out), &shapes);
    if (picture) {
        draw_glyphs(picture, open_output(picture), glyphs, count);
    }
    finish_outputs();
    hide_progress();

    FILE *report = is_standard_output(out) ? stderr : stdout;
    fprintf(report, "%-9s %5s %10s %10s %16s %15s\n", "shape", "arcs", "area", "hull area", "smallest radius",
            "largest radius");
    for (size_t i = 0; i < count; i++) {
        print_row(report, &glyphs[i]);
        free_glyph(&glyphs[i]);
    }
    finish_report(report);
    commit_outputs();
    free(glyphs);
    free(codes);
    free_shapes(&shapes);
    close_font(from);
}

const command shapes_command = {"shapes", "glyphs of a font to shapes", HELP, run};
