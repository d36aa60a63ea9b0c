/* SPDX-License-Identifier: MIT
 *
 * type1.c - a Type 1 font as Adobe's "Adobe Type 1 Font Format" (1990) has it: a header in PostScript, then the
 * glyphs' programs, enciphered twice.
 */
#include "type1.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum { ROOM = 4096 };

typedef struct bytes {
    unsigned char data[ROOM];
    size_t size;
} bytes;

static void add_bytes(bytes *to, const void *data, size_t size) {
    assert_true(to->size + size <= ROOM);
    memcpy(to->data + to->size, data, size);
    to->size += size;
}

static void add_byte(bytes *to, int byte) { add_bytes(to, &(unsigned char){(unsigned char)byte}, 1); }

static void add_text(bytes *to, const char *text) { add_bytes(to, text, strlen(text)); }

/* Chapter 7: four bytes that mean nothing go before. */
static bytes encipher(const bytes *plain, unsigned key) {
    bytes made = {.size = 0}, all = {.size = 0};
    add_text(&all, "abcd");
    add_bytes(&all, plain->data, plain->size);
    for (size_t i = 0; i < all.size; i++) {
        const unsigned cipher = (all.data[i] ^ (key >> 8)) & 0xff;
        add_byte(&made, (int)cipher);
        key = ((cipher + key) * 52845 + 22719) & 0xffff;
    }
    return made;
}

/* Chapter 6.2: numbers up to 1131. */
static void add_number(bytes *to, int value) {
    if (value >= -107 && value <= 107) {
        add_byte(to, value + 139);
    } else {
        const int rest = abs(value) - 108;
        assert_true(rest < 1024);
        add_byte(to, (value > 0 ? 247 : 251) + (rest >> 8));
        add_byte(to, rest & 255);
    }
}

static bytes make_program(const char *operators, const int *steps) {
    bytes made = {.size = 0};
    add_number(&made, 0); /* no side bearing, 500 wide: hsbw */
    add_number(&made, 500);
    add_byte(&made, 13);
    for (; *operators; operators++) {
        const int numbers = *operators == 'c' ? 6 : *operators == 'z' ? 0 : 2;
        for (int i = 0; i < numbers; i++)
            add_number(&made, *steps++);
        add_byte(&made, *operators == 'm' ? 21 : *operators == 'l' ? 5 : *operators == 'c' ? 8 : 9);
    }
    add_byte(&made, 14); /* endchar */
    return made;
}

static void add_glyph(bytes *to, const char *name, const char *operators, const int *steps) {
    const bytes program = make_program(operators, steps), hidden = encipher(&program, 4330);
    char text[64];
    snprintf(text, sizeof text, "/%s %zu RD ", name, hidden.size);
    add_text(to, text);
    add_bytes(to, hidden.data, hidden.size);
    add_text(to, " ND\n");
}

char *make_type1_font(const char *operators, const int *steps, size_t *out_size) {
    bytes font = {.size = 0}, private = {.size = 0};
    add_text(&font, "%!PS-AdobeFont-1.0: Test 001.000\n11 dict begin\n/FontName /Test def\n/PaintType 0 def\n"
                    "/FontType 1 def\n/FontMatrix [0.001 0 0 0.001 0 0] readonly def\n/Encoding StandardEncoding def\n"
                    "/FontBBox {0 0 1000 1000} readonly def\ncurrentdict end\ncurrentfile eexec\n");
    add_text(&private, "dup /Private 8 dict dup begin\n/RD {string currentfile exch readstring pop} executeonly def\n"
                       "/ND {noaccess def} executeonly def\n/NP {noaccess put} executeonly def\n"
                       "/BlueValues [] def\n/password 5839 def\n2 index /CharStrings 3 dict dup begin\n");
    add_glyph(&private, ".notdef", "", NULL);
    add_glyph(&private, "space", "", NULL);
    add_glyph(&private, "A", operators, steps);
    add_text(&private, "end\nend\nreadonly put\nnoaccess put\ndup /FontName get exch definefont pop\n"
                       "mark currentfile closefile\n");
    const bytes hidden = encipher(&private, 55665);
    add_bytes(&font, hidden.data, hidden.size);
    add_text(&font, "\n0000000000000000000000000000000000000000000000000000000000000000\ncleartomark\n");
    char *made = malloc(font.size);
    assert_non_null(made);
    memcpy(made, font.data, font.size);
    *out_size = font.size;
    return made;
}
