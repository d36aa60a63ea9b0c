/* SPDX-License-Identifier: MIT
 *
 * glyph.c - from a character of a font to an n-arc.
 */
#include "glyph.h"

#include <errno.h>
#include <ft2build.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include "fail.h"
#include "output.h"
#include "polygon.h"

/* Curves are flattened so that no chord is further than this from its curve, in em: a tenth of a unit of the usual grid
 * of 1000 or 2048 units, far below what n arcs can follow. */
static const double FLATNESS = 1e-4;

struct font {
    const char *path;
    FT_Library library;
    FT_Face face;
};

font *open_font(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        fail("%s: %s", path, strerror(errno));
    }
    protect_input(file);
    fclose(file);
    font *opened = allocate(1, sizeof *opened);
    opened->path = path;
    if (FT_Init_FreeType(&opened->library) != 0) {
        fail("FreeType does not start");
    }
    if (FT_New_Face(opened->library, path, 0, &opened->face) != 0) {
        fail("%s: not a font that FreeType can read", path);
    }
    if (!FT_IS_SCALABLE(opened->face) || opened->face->units_per_EM == 0) {
        fail("%s: a font of bitmaps, without outlines", path);
    }
    if (FT_Select_Charmap(opened->face, FT_ENCODING_UNICODE) != 0) {
        fail("%s: a font without a Unicode character map", path);
    }
    return opened;
}

void close_font(font *opened) {
    FT_Done_Face(opened->face);
    FT_Done_FreeType(opened->library);
    free(opened);
}

/* ---------------------------------------------------------------------------- flattening */

typedef struct pen {
    glyph *to;
    double unit; /* em per font unit */
} pen;

static narc_point to_em(const pen *with, const FT_Vector *v) {
    return (narc_point){(double)v->x * with->unit, (double)v->y * with->unit};
}

static void add_point(glyph *to, narc_point p) {
    to->outline = grow(to->outline, &to->outline_capacity, to->outline_count + 1, sizeof *to->outline);
    to->outline[to->outline_count++] = p;
}

static void end_contour(glyph *to) {
    if (to->outline_count > (to->end_count ? to->ends[to->end_count - 1] : 0)) {
        to->ends = grow(to->ends, &to->end_capacity, to->end_count + 1, sizeof *to->ends);
        to->ends[to->end_count++] = to->outline_count;
    }
}

static int move_to(const FT_Vector *end, void *context) {
    pen *with = context;
    end_contour(with->to);
    add_point(with->to, to_em(with, end));
    return 0;
}

static int line_to(const FT_Vector *end, void *context) {
    pen *with = context;
    add_point(with->to, to_em(with, end));
    return 0;
}

/* The length of the second difference of three control points: how far they are from a straight, even run. */
static double bend(narc_point a, narc_point b, narc_point c) { return hypot(a.x - 2 * b.x + c.x, a.y - 2 * b.y + c.y); }

/* The chord of a parameter step 1 / k strays from its curve by at most (second derivative) / (8 k^2). The second
 * derivative of a curve of degree d is at most d (d - 1) times the largest second difference of its control points. */
static int count_chords(double degree, double difference) {
    return (int)ceil(sqrt(degree * (degree - 1) * difference / (8 * FLATNESS))) + 1;
}

static int cubic_to(const FT_Vector *v1, const FT_Vector *v2, const FT_Vector *v3, void *context) {
    pen *with = context;
    const narc_point a = with->to->outline[with->to->outline_count - 1];
    const narc_point b = to_em(with, v1), c = to_em(with, v2), d = to_em(with, v3);
    const int chords = count_chords(3, fmax(bend(a, b, c), bend(b, c, d)));
    for (int k = 1; k <= chords; k++) {
        const double t = (double)k / chords, s = 1 - t;
        const double wa = s * s * s, wb = 3 * s * s * t, wc = 3 * s * t * t, wd = t * t * t;
        add_point(with->to,
                  (narc_point){wa * a.x + wb * b.x + wc * c.x + wd * d.x, wa * a.y + wb * b.y + wc * c.y + wd * d.y});
    }
    return 0;
}

static int conic_to(const FT_Vector *v1, const FT_Vector *v2, void *context) {
    pen *with = context;
    const narc_point a = with->to->outline[with->to->outline_count - 1], b = to_em(with, v1), c = to_em(with, v2);
    const int chords = count_chords(2, bend(a, b, c));
    for (int k = 1; k <= chords; k++) {
        const double t = (double)k / chords, s = 1 - t;
        add_point(with->to, (narc_point){s * s * a.x + 2 * s * t * b.x + t * t * c.x,
                                         s * s * a.y + 2 * s * t * b.y + t * t * c.y});
    }
    return 0;
}

static void load_outline(font *from, uint32_t character, glyph *to) {
    static const FT_Outline_Funcs pen_moves = {move_to, line_to, conic_to, cubic_to, 0, 0};
    const FT_UInt index = FT_Get_Char_Index(from->face, character);
    if (index == 0) {
        fail("%s: the font has no glyph for U+%04X", from->path, (unsigned)character);
    }
    if (FT_Load_Glyph(from->face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP) != 0 ||
        from->face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
        fail("%s: the glyph for U+%04X is no outline", from->path, (unsigned)character);
    }
    pen with = {to, 1.0 / from->face->units_per_EM};
    if (FT_Outline_Decompose(&from->face->glyph->outline, &pen_moves, &with) != 0) {
        fail("%s: the outline of U+%04X is damaged", from->path, (unsigned)character);
    }
    end_contour(to);
}

/* ---------------------------------------------------------------------------- the n-arc */

/* Moves everything so that the centroid of the n-arc is the origin. */
static void center_glyph(glyph *made) {
    narc_mass mass;
    narc_compute_mass(made->arcs, made->arc_count, &mass);
    made->area = mass.area;
    for (size_t i = 0; i < made->arc_count; i++) {
        made->arcs[i].center_x -= mass.centroid_x;
        made->arcs[i].center_y -= mass.centroid_y;
        made->polygon[i].x -= mass.centroid_x;
        made->polygon[i].y -= mass.centroid_y;
    }
    for (size_t i = 0; i < made->outline_count; i++) {
        made->outline[i].x -= mass.centroid_x;
        made->outline[i].y -= mass.centroid_y;
    }
}

void make_glyph(font *from, uint32_t character, size_t arc_count, glyph *out_glyph) {
    *out_glyph = (glyph){.arc_count = arc_count};
    const bool plain = (character >= 'A' && character <= 'Z') || (character >= 'a' && character <= 'z');
    snprintf(out_glyph->name, sizeof out_glyph->name, plain ? "%c" : "U+%04X", (unsigned)character);
    load_outline(from, character, out_glyph);

    const size_t count = out_glyph->outline_count;
    const size_t room = (count > NARC_MAX_ARCS ? count : NARC_MAX_ARCS) + 1;
    narc_point *cloud = allocate(room, sizeof *cloud);
    narc_point *hull = allocate(room, sizeof *hull);
    if (count) {
        memcpy(cloud, out_glyph->outline, count * sizeof *cloud);
    }
    const size_t corners = compute_hull(cloud, count, hull);
    if (corners < 3) {
        fail("%s: the glyph for U+%04X has no outline", from->path, (unsigned)character);
    }
    out_glyph->hull_area = polygon_area(hull, corners);
    if (!set_side_count(hull, corners, arc_count)) {
        fail("%s: no polygon with %zu sides bounds the glyph for U+%04X", from->path, arc_count, (unsigned)character);
    }
    memcpy(out_glyph->polygon, hull, arc_count * sizeof *hull);
    free(cloud);
    free(hull);

    narc_point junctions[NARC_MAX_ARCS];
    narc_error error;
    if (narc_adjust_polygon(out_glyph->polygon, arc_count, junctions, &error) != NARC_OK ||
        narc_build_points(junctions, arc_count, 0, out_glyph->arcs, &out_glyph->arc_count, &error) != NARC_OK) {
        fail("%s: no n-arc for U+%04X: %s", from->path, (unsigned)character, error.message);
    }
    center_glyph(out_glyph);
}

void free_glyph(glyph *made) {
    free(made->outline);
    free(made->ends);
    *made = (glyph){0};
}
