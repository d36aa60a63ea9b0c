/* SPDX-License-Identifier: MIT
 *
 * lines.c - texts and their lines.
 */
#include "lines.h"

#include <string.h>

#include "error.h"
#include "names.h"

narc_excerpt narc_make_excerpt(const char *text) {
    enum { LONGEST = 40 };
    narc_excerpt excerpt;
    size_t shown = strcspn(text, "\n");
    shown -= shown > 0 && text[shown - 1] == '\r';
    const bool is_cut = shown > LONGEST;
    if (is_cut)
        for (shown = LONGEST; shown > 0 && ((unsigned char)text[shown] & 0xc0) == 0x80;)
            shown--;
    memcpy(excerpt.text, text, shown);
    excerpt.text[shown] = 0;
    narc_make_printable(excerpt.text);
    strcpy(excerpt.text + shown, is_cut ? "..." : "");
    return excerpt;
}

size_t narc_find_line(const char *text, const char *place) {
    size_t line = 1;
    while ((text = memchr(text, '\n', (size_t)(place - text)))) {
        line++;
        text++;
    }
    return line;
}

narc_status narc_clean_text(char *text, size_t size, narc_error *error) {
    if (strncmp(text, "\xff\xfe", 2) == 0 || strncmp(text, "\xfe\xff", 2) == 0)
        return narc_fail(error, NARC_ERROR_FORMAT, 1, 0, "line 1: the text is UTF-16: it must be saved as UTF-8");
    const char *nul = text + strlen(text);
    if (nul != text + size) {
        const size_t line = narc_find_line(text, nul);
        return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: a NUL byte", line);
    }
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0)
        memmove(text, text + 3, size - 2);
    if (!text[strspn(text, " \t\r\n")])
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the text is empty");
    return NARC_OK;
}
