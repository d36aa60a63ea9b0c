/* SPDX-License-Identifier: MIT
 *
 * read_font.c - stub
 */
#include "narc_fit.h"
#include "error.h"

narc_status narc_open_font(const void *data, size_t size, narc_font **out_font, narc_error *error) { (void)data; (void)size; (void)out_font;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
void narc_close_font(narc_font *font) { (void)font; }
narc_status narc_read_glyph(narc_font *font, uint32_t character, narc_path *path, narc_error *error) { (void)font; (void)character; (void)path;
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "stub");
}
uint32_t narc_next_character(narc_font *font, uint32_t after) { (void)font; (void)after; return 0; }
