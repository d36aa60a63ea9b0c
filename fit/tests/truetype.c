/* SPDX-License-Identifier: MIT
 *
 * truetype.c - the tables cmap (format 4), loca, glyf and hmtx as the OpenType specification describes them. The
 * font is taken to be in order.
 */
#include "truetype.h"

#include <stddef.h>
#include <string.h>

#include "fit_support.h"

enum { MOST_POINTS = 4000, ON_CURVE = 1, REPEATED = 8 };

unsigned read_big_endian(const unsigned char *at, int size) {
    unsigned value = 0;
    for (int i = 0; i < size; i++)
        value = value << 8 | at[i];
    return value;
}

static int read_signed(const unsigned char *at) {
    const int bits = (int)read_big_endian(at, 2);
    return bits < 0x8000 ? bits : bits - 0x10000;
}

unsigned char *find_truetype_table(unsigned char *font, const char *tag) {
    for (unsigned k = 0; k < read_big_endian(font + 4, 2); k++) {
        unsigned char *entry = font + 12 + 16 * k;
        if (memcmp(entry, tag, 4) == 0)
            return font + read_big_endian(entry + 8, 4);
    }
    fail_msg("no table %s", tag);
    return NULL;
}

/* The subtable of format 4 for Windows and Unicode's basic plane. */
static const unsigned char *find_map(unsigned char *font) {
    const unsigned char *cmap = find_truetype_table(font, "cmap");
    for (unsigned k = 0; k < read_big_endian(cmap + 2, 2); k++) {
        const unsigned char *entry = cmap + 4 + 8 * k, *map = cmap + read_big_endian(entry + 4, 4);
        if (read_big_endian(entry, 4) == 0x00030001 && read_big_endian(map, 2) == 4)
            return map;
    }
    fail_msg("no character map of format 4");
    return NULL;
}

static unsigned find_glyph(unsigned char *font, uint32_t character) {
    const unsigned char *map = find_map(font);
    const unsigned doubled = read_big_endian(map + 6, 2);
    for (unsigned k = 0; k < doubled && character <= 0xffff; k += 2) {
        const unsigned char *end = map + 14 + k, *start = end + doubled + 2, *delta = start + doubled;
        const unsigned char *offset = delta + doubled;
        if (character > read_big_endian(end, 2) || character < read_big_endian(start, 2))
            continue;
        unsigned glyph = character;
        if (read_big_endian(offset, 2)) {
            glyph =
                read_big_endian(offset + read_big_endian(offset, 2) + 2 * (character - read_big_endian(start, 2)), 2);
            if (glyph == 0)
                return 0;
        }
        return (glyph + read_big_endian(delta, 2)) & 0xffff;
    }
    return 0;
}

/* The glyph's description, or NULL if it is blank. */
static const unsigned char *find_description(unsigned char *font, unsigned glyph) {
    const unsigned char *loca = find_truetype_table(font, "loca"), *glyf = find_truetype_table(font, "glyf");
    unsigned place[2];
    for (unsigned i = 0; i < 2; i++) {
        place[i] = read_big_endian(find_truetype_table(font, "head") + 50, 2)
                       ? read_big_endian(loca + 4 * (glyph + i), 4)
                       : 2 * read_big_endian(loca + 2 * (glyph + i), 2);
    }
    return place[0] < place[1] ? glyf + place[0] : NULL;
}

/* Where the glyph's box begins, seen from the point it is written at. */
static int find_bearing(unsigned char *font, unsigned glyph) {
    const unsigned char *hmtx = find_truetype_table(font, "hmtx");
    const unsigned full = read_big_endian(find_truetype_table(font, "hhea") + 34, 2);
    return read_signed(glyph < full ? hmtx + 4 * glyph + 2 : hmtx + 4 * full + 2 * (glyph - full));
}

typedef struct outline {
    unsigned char flags[MOST_POINTS];
    int x[MOST_POINTS], y[MOST_POINTS];
} outline;

/* One coordinate of all points: differences, each of one or two bytes, or none. */
static const unsigned char *read_coordinates(const unsigned char *at, const unsigned char *flags, size_t count,
                                             unsigned is_short, unsigned is_same, int *out_values) {
    int value = 0;
    for (size_t i = 0; i < count; i++) {
        if (flags[i] & is_short) {
            value += flags[i] & is_same ? at[0] : -(int)at[0];
            at++;
        } else if (!(flags[i] & is_same)) {
            value += read_signed(at);
            at += 2;
        }
        out_values[i] = value;
    }
    return at;
}

static void read_outline(const unsigned char *at, size_t count, outline *out) {
    for (size_t i = 0; i < count;) {
        const unsigned char flag = *at++;
        unsigned times = 1 + (flag & REPEATED ? *at++ : 0);
        while (times-- > 0) {
            assert_true(i < count);
            out->flags[i++] = flag;
        }
    }
    at = read_coordinates(at, out->flags, count, 2, 16, out->x);
    read_coordinates(at, out->flags, count, 4, 32, out->y);
}

static narc_point middle(narc_point a, narc_point b) { return (narc_point){(a.x + b.x) / 2, (a.y + b.y) / 2}; }

/* Points first .. end - 1 of an outline. It begins with its first point if that is on the curve, else with its last,
 * else midway between them. */
static void draw_contour(const outline *from, size_t first, size_t end, double unit, narc_path *path) {
    narc_point p[MOST_POINTS + 1];
    bool on[MOST_POINTS + 1];
    size_t count = 0;
    for (size_t i = first; i < end; i++, count++) {
        p[count] = (narc_point){from->x[i] * unit, from->y[i] * unit};
        on[count] = from->flags[i] & ON_CURVE;
    }
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
    narc_status status = narc_move_to(path, begin, &error);
    for (size_t k = 0; k < left && !status; k++) {
        const size_t i = start + k;
        if (on[i]) {
            status = narc_line_to(path, p[i], &error);
        } else if (k + 1 == left) {
            status = narc_quadratic_to(path, p[i], begin, &error);
        } else if (on[i + 1]) {
            status = narc_quadratic_to(path, p[i], p[i + 1], &error);
            k++;
        } else {
            status = narc_quadratic_to(path, p[i], middle(p[i], p[i + 1]), &error);
        }
    }
    expect_ok(status, &error);
}

/* Is a contour but one point? */
static bool is_anchor(const outline *from, size_t first, size_t end) {
    for (size_t i = first; i < end; i++)
        if (from->x[i] != from->x[first] || from->y[i] != from->y[first])
            return false;
    return true;
}

bool draw_truetype_glyph(unsigned char *font, uint32_t character, narc_path *path) {
    const unsigned glyph = find_glyph(font, character);
    const unsigned char *at = glyph ? find_description(font, glyph) : NULL;
    const int contours = at ? read_signed(at) : 0;
    if (contours <= 0)
        return false;
    static outline points;
    const unsigned char *ends = at + 10, *instructions = ends + 2 * contours;
    const size_t count = read_big_endian(instructions - 2, 2) + 1;
    assert_true(count <= MOST_POINTS);
    read_outline(instructions + 2 + read_big_endian(instructions, 2), count, &points);
    const int shift = find_bearing(font, glyph) - read_signed(at + 2);
    for (size_t i = 0; i < count; i++)
        points.x[i] += shift;
    const double unit = 1.0 / read_big_endian(find_truetype_table(font, "head") + 18, 2);
    bool drawn = false;
    for (size_t k = 0, first = 0; k < (size_t)contours; k++) {
        const size_t end = read_big_endian(ends + 2 * k, 2) + 1;
        if (!is_anchor(&points, first, end)) {
            draw_contour(&points, first, end, unit, path);
            drawn = true;
        }
        first = end;
    }
    return drawn;
}
