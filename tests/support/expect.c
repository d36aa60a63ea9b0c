/* SPDX-License-Identifier: MIT
 *
 * expect.c - what a function's status and error should be.
 */
#include "expect.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "support.h"

/* Does a message have this word, with neither letters nor digits next to it? */
static bool has_word(const char *message, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = message; (at = strstr(at, word)); at++)
        if ((at == message || !isalnum((unsigned char)at[-1])) && !isalnum((unsigned char)at[length]))
            return true;
    return false;
}

void expect_error(narc_status status, narc_status expected, const narc_error *error, const char *words) {
    if (status != expected)
        fail_msg("got %s, expected %s (%s)", narc_status_name(status), narc_status_name(expected), words);
    if (error->status != expected)
        fail_msg("the error says %s, not %s", narc_status_name(error->status), narc_status_name(expected));
    if (!strstr(error->message, words))
        fail_msg("the message is \"%s\", it should mention \"%s\"", error->message, words);
    const size_t length = strlen(error->message);
    if (length == 0 || strchr(error->message, '\n') || error->message[length - 1] == '.')
        fail_msg("not one line without a full stop: \"%s\"", error->message);
    char number[24];
    snprintf(number, sizeof number, "%zu", error->index);
    /* But for 'names', U+FFFF, and "radius_left is 1". */
    const bool names = strpbrk(error->message, "'+") || strstr(error->message, "radius_left");
    if (error->index != 0 && !names && !has_word(error->message, number))
        fail_msg("\"%s\" does not tell of item %zu", error->message, error->index);
    if (strstr(error->message, "NULL") && !strchr(error->message, '\'') && error->value != 0) /* 'names' may have it */
        fail_msg("\"%s\" has no value, but it is %g", error->message, error->value);
}

void expect_ok(narc_status status, const narc_error *error) {
    if (status != NARC_OK)
        fail_msg("%s: %s", narc_status_name(status), error->message);
}
