/* SPDX-License-Identifier: MIT
 *
 * font.c - outlines of glyphs, through FreeType.
 */
#include <errno.h>
#include <ft2build.h>
#include <limits.h>
#include <stdlib.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include "error.h"
#include "outline/path.h"

/* Each font has a FreeType library of its own: fonts of different threads then share nothing. */
struct narc_font {
    FT_Library library;
    FT_Face face;
};

static const uint32_t LAST_CHARACTER = 0x10ffff;

/* Some of FreeType's formats tell another error where there is no memory; malloc() tells in errno, 0 before. */
static bool ran_out_of_memory(FT_Error problem) { return problem == FT_Err_Out_Of_Memory || errno == ENOMEM; }

static narc_status open_face(narc_font *font, const void *data, size_t size, narc_error *error) {
    errno = 0;
    if (FT_Init_FreeType(&font->library) != 0) {
        font->library = NULL;
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory to start FreeType");
    }
    const FT_Error problem = size > LONG_MAX ? FT_Err_Invalid_Argument
                                             : FT_New_Memory_Face(font->library, data, (FT_Long)size, 0, &font->face);
    if (problem) {
        font->face = NULL;
        return ran_out_of_memory(problem)
                   ? narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory to open the font")
                   : narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "not a font that FreeType can read (%zu bytes)", size);
    }
    if (!FT_IS_SCALABLE(font->face) || font->face->units_per_EM == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "a font of bitmaps, without outlines");
    if (FT_Select_Charmap(font->face, FT_ENCODING_UNICODE) != 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "a font without a Unicode character map");
    return NARC_OK;
}

narc_status narc_open_font(const void *data, size_t size, narc_font **out_font, narc_error *error) {
    if (!data || !out_font)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", data ? "out_font" : "data");
    narc_font *font = calloc(1, sizeof *font);
    if (!font)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory to open the font");
    const narc_status status = open_face(font, data, size, error);
    if (status) {
        narc_close_font(font);
        return status;
    }
    *out_font = font;
    return NARC_OK;
}

void narc_close_font(narc_font *font) {
    if (font) {
        if (font->face)
            FT_Done_Face(font->face);
        if (font->library)
            FT_Done_FreeType(font->library);
        free(font);
    }
}

/* ---------------------------------------------------------------------------- glyphs */

/* TrueType leaves out points midway between two control points. FreeType rounds these to whole numbers: with
 * coordinates doubled first, nothing is lost. */
enum { SHIFT = 1 };

struct glyph_pen {
    narc_path *path;
    double unit;            /* em per FreeType's unit */
    narc_path_mark contour; /* where the current one began */
    narc_status status;
    narc_error *error;
};

static narc_point to_em(const struct glyph_pen *pen, const FT_Vector *v) {
    return (narc_point){(double)v->x * pen->unit, (double)v->y * pen->unit};
}

/* Ends a contour. One that is a single point is an anchor for accents or hints, and not drawn. */
static void end_contour(struct glyph_pen *pen) {
    narc_path *path = pen->path;
    for (size_t i = pen->contour.point_count + 1; i < path->point_count; i++) {
        const narc_point p = path->points[i - 1], q = path->points[i];
        if (p.x != q.x || p.y != q.y)
            return;
    }
    narc_rewind_path(path, pen->contour);
}

static int begin_contour(const FT_Vector *point, void *context) {
    struct glyph_pen *pen = context;
    const narc_point to = to_em(pen, point);
    end_contour(pen);
    pen->contour = narc_mark_path(pen->path);
    pen->status = narc_move_to(pen->path, &to, pen->error);
    return pen->status != NARC_OK;
}

static int draw_line(const FT_Vector *point, void *context) {
    struct glyph_pen *pen = context;
    const narc_point to = to_em(pen, point);
    pen->status = narc_line_to(pen->path, &to, pen->error);
    return pen->status != NARC_OK;
}

static int draw_quadratic(const FT_Vector *control, const FT_Vector *point, void *context) {
    struct glyph_pen *pen = context;
    const narc_point by = to_em(pen, control), to = to_em(pen, point);
    pen->status = narc_quadratic_to(pen->path, &by, &to, pen->error);
    return pen->status != NARC_OK;
}

static int draw_cubic(const FT_Vector *control_1, const FT_Vector *control_2, const FT_Vector *point, void *context) {
    struct glyph_pen *pen = context;
    const narc_point by_1 = to_em(pen, control_1), by_2 = to_em(pen, control_2), to = to_em(pen, point);
    pen->status = narc_cubic_to(pen->path, &by_1, &by_2, &to, pen->error);
    return pen->status != NARC_OK;
}

static narc_status load_glyph(narc_font *font, uint32_t character, narc_error *error) {
    const FT_UInt index = FT_Get_Char_Index(font->face, character);
    if (index == 0) {
        return narc_fail(error, NARC_ERROR_INDEX, character, character, "the font has no glyph for U+%04X",
                         (unsigned)character);
    }
    errno = 0;
    const FT_Error problem = FT_Load_Glyph(font->face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP);
    if (problem && ran_out_of_memory(problem)) {
        return narc_fail(error, NARC_ERROR_MEMORY, character, character, "no memory for the glyph of U+%04X",
                         (unsigned)character);
    }
    if (problem || font->face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
        return narc_fail(error, NARC_ERROR_FORMAT, character, character, "the glyph of U+%04X is %s",
                         (unsigned)character, problem ? "damaged" : "not an outline");
    }
    return NARC_OK;
}

static narc_status draw_glyph(narc_font *font, uint32_t character, narc_path *path, narc_error *error) {
    static const FT_Outline_Funcs moves = {begin_contour, draw_line, draw_quadratic, draw_cubic, SHIFT, 0};
    const narc_path_mark mark = narc_mark_path(path);
    struct glyph_pen pen = {path, 1.0 / (font->face->units_per_EM << SHIFT), mark, NARC_OK, error};
    const FT_Error problem = FT_Outline_Decompose(&font->face->glyph->outline, &moves, &pen);
    if (pen.status)
        return pen.status;
    if (problem) {
        return narc_fail(error, NARC_ERROR_FORMAT, character, character, "the outline of U+%04X is damaged",
                         (unsigned)character);
    }
    end_contour(&pen);
    if (!narc_is_drawn_since(path, mark)) {
        return narc_fail(error, NARC_ERROR_FORMAT, character, character, "no outline: U+%04X is blank in this font",
                         (unsigned)character);
    }
    return NARC_OK;
}

narc_status narc_read_glyph(narc_font *font, uint32_t character, narc_path *path, narc_error *error) {
    if (!font || !path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", font ? "path" : "font");
    narc_status status = load_glyph(font, character, error);
    if (!status) {
        const narc_path_mark mark = narc_mark_path(path);
        status = draw_glyph(font, character, path, error);
        if (status)
            narc_rewind_path(path, mark);
    }
    return status;
}

uint32_t narc_next_character(narc_font *font, uint32_t after) {
    if (!font || after >= LAST_CHARACTER)
        return 0;
    FT_UInt index;
    const FT_ULong next = FT_Get_Next_Char(font->face, after, &index);
    /* A damaged map may hold anything: whoever lists the characters comes to an end all the same. */
    return next > after && next <= LAST_CHARACTER ? (uint32_t)next : 0;
}
